/* Nodes at one point (the u and v of a vertex) are dissected as one: their graph is taken modulo "same point". */
#include "sparse/dissection.h"

#include "base/memory.h"

#include <string.h>

static bool same_point(const double *xyz, int32_t a, int32_t b)
{
    const double *p = xyz + 3 * (int64_t)a, *q = xyz + 3 * (int64_t)b;
    return p[0] == q[0] && p[1] == q[1] && p[2] == q[2];
}

static uint64_t hash_point(const double *p)
{
    uint64_t hash = 0;
    for (int k = 0; k < 3; k++) {
        const double x = p[k] + 0.0; /* both zeros are one */
        uint64_t bits;
        memcpy(&bits, &x, sizeof bits);
        hash = (hash ^ bits) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 29;
    }
    return hash * 0xbf58476d1ce4e5b9u >> 20;
}

/* group[i] = which point node i is at, numbered by first node. SL_OUT_OF_MEMORY. */
static sl_status group_by_point(int32_t n, const double *xyz, int32_t *group, int32_t *group_count)
{
    uint64_t slots = 4;
    while (slots < 2 * (uint64_t)n) {
        slots *= 2;
    }
    int32_t *first = sl_alloc((int64_t)slots, sizeof *first); /* hash table of the first node at each point */
    if (first == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    memset(first, -1, (size_t)slots * sizeof *first);
    int32_t count = 0;
    for (int32_t i = 0; i < n; i++) {
        uint64_t k = hash_point(xyz + 3 * (int64_t)i) & (slots - 1);
        while (first[k] != -1 && !same_point(xyz, first[k], i)) { /* half the slots are free */
            k = (k + 1) & (slots - 1);
        }
        group[i] = first[k] != -1 ? group[first[k]] : count++;
        first[k] = first[k] != -1 ? first[k] : i;
    }
    *group_count = count;
    sl_free(first);
    return SL_OK;
}

/* members of group g: member[first[g]] .. member[first[g + 1] - 1]; first: groups + 1, zeroed. */
static void list_members(int32_t n, const int32_t *group, int32_t groups, int32_t *first, int32_t *member)
{
    for (int32_t i = 0; i < n; i++) {
        first[group[i] + 1]++;
    }
    for (int32_t g = 0; g < groups; g++) {
        first[g + 1] += first[g];
    }
    for (int32_t i = 0; i < n; i++) {
        member[first[group[i]]++] = i;
    }
    memmove(first + 1, first, (size_t)groups * sizeof *first);
    first[0] = 0;
}

/* Q = graph modulo group, without loops and duplicates; Q->adj has room for all of graph's. mark: groups. */
static void fill_quotient(const sl_adjacency *graph, const int32_t *group, const int32_t *first, const int32_t *member,
                          int32_t *mark, sl_adjacency *Q)
{
    int64_t filled = 0;
    memset(mark, -1, (size_t)Q->n * sizeof *mark);
    Q->first[0] = 0;
    for (int32_t g = 0; g < Q->n; g++) {
        mark[g] = g;
        for (int32_t k = first[g]; k < first[g + 1]; k++) {
            const int32_t v = member[k];
            for (int64_t p = graph->first[v]; p < graph->first[v + 1]; p++) {
                const int32_t h = group[graph->adj[p]];
                if (mark[h] != g) {
                    mark[h] = g;
                    Q->adj[filled++] = h;
                }
            }
        }
        Q->first[g + 1] = filled;
    }
}

/* points: groups x 3. */
static void place_groups(int32_t n, const double *xyz, const int32_t *group, double *points)
{
    for (int32_t i = 0; i < n; i++) {
        memcpy(points + 3 * (int64_t)group[i], xyz + 3 * (int64_t)i, 3 * sizeof *points);
    }
}

static sl_status dissect_groups(const sl_adjacency *graph, const double *xyz, const int32_t *group, int32_t groups,
                                const sl_context *context, int32_t *piece, int32_t *order)
{
    sl_adjacency Q = {.n = groups};
    const int64_t n = graph->n;
    int32_t *first = sl_calloc((int64_t)groups + 1, sizeof *first);
    int32_t *member = sl_alloc(n, sizeof *member);
    int32_t *mark = sl_alloc(groups, sizeof *mark);
    int32_t *group_order = sl_alloc(groups, sizeof *group_order);
    double *points = sl_alloc(3 * (int64_t)groups, sizeof *points);
    sl_status status = SL_OK;
    Q.first = sl_alloc((int64_t)groups + 1, sizeof *Q.first);
    Q.adj = sl_alloc(graph->first[n], sizeof *Q.adj);
    if (first == NULL || member == NULL || mark == NULL || group_order == NULL || points == NULL || Q.first == NULL ||
        Q.adj == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    list_members(graph->n, group, groups, first, member);
    fill_quotient(graph, group, first, member, mark, &Q);
    place_groups(graph->n, xyz, group, points);
    int32_t *group_piece = mark; /* done with as a marker */
    SL_TRY(sl_dissect_points(&Q, points, context, group_piece, group_order));
    int32_t placed = 0;
    for (int32_t g = 0; g < groups; g++) {
        for (int32_t k = first[group_order[g]]; k < first[group_order[g] + 1]; k++) {
            piece[member[k]] = group_piece[group_order[g]];
            order[placed++] = member[k];
        }
    }
cleanup:
    sl_free(first);
    sl_free(member);
    sl_free(mark);
    sl_free(group_order);
    sl_free(points);
    sl_adjacency_clear(&Q);
    return status;
}

sl_status sl_dissect(const sl_adjacency *graph, const double *xyz, const sl_context *context, int32_t *piece,
                     int32_t *order)
{
    if (xyz == NULL) {
        return sl_dissect_graph(graph, piece, order);
    }
    int32_t groups = 0;
    int32_t *group = sl_alloc(graph->n, sizeof *group);
    sl_status status = group != NULL ? SL_OK : SL_OUT_OF_MEMORY;
    SL_TRY(status);
    SL_TRY(group_by_point(graph->n, xyz, group, &groups));
    if (groups == graph->n) {
        SL_TRY(sl_dissect_points(graph, xyz, context, piece, order));
    } else {
        SL_TRY(dissect_groups(graph, xyz, group, groups, context, piece, order));
    }
cleanup:
    sl_free(group);
    return status;
}
