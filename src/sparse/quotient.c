/* Nodes at one point (the u and v of a vertex) are dissected as one: their graph is taken modulo "same point". */
#include "sparse/dissection.h"

#include "base/memory.h"

#include <stdlib.h>
#include <string.h>

typedef struct placed {
    double x[3];
    int32_t node;
} placed;

static int compare_points(const placed *a, const placed *b)
{
    for (int k = 0; k < 3; k++) {
        if (a->x[k] != b->x[k]) {
            return a->x[k] < b->x[k] ? -1 : 1;
        }
    }
    return 0;
}

static int compare_placed(const void *va, const void *vb)
{
    const placed *a = va, *b = vb;
    const int by_point = compare_points(a, b);
    return by_point != 0 ? by_point : (a->node > b->node) - (a->node < b->node);
}

/* group[i] = which point node i is at, numbered by first node. Returns the number of points. SL_OUT_OF_MEMORY. */
static sl_status group_by_point(int32_t n, const double *xyz, int32_t *group, int32_t *group_count)
{
    placed *sorted = sl_alloc(n, sizeof *sorted);
    if (sorted == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t i = 0; i < n; i++) {
        sorted[i] = (placed){{xyz[3 * (int64_t)i], xyz[3 * (int64_t)i + 1], xyz[3 * (int64_t)i + 2]}, i};
    }
    qsort(sorted, (size_t)n, sizeof *sorted, compare_placed);
    /* First pass: every node points at the first node of its point; second: those first nodes are numbered. */
    for (int32_t k = 0; k < n; k++) {
        const bool same = k > 0 && compare_points(&sorted[k - 1], &sorted[k]) == 0;
        group[sorted[k].node] = same ? group[sorted[k - 1].node] : sorted[k].node;
    }
    int32_t count = 0;
    for (int32_t i = 0; i < n; i++) {
        group[i] = group[i] == i ? count++ : group[group[i]];
    }
    *group_count = count;
    sl_free(sorted);
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
                                int32_t *piece)
{
    sl_adjacency Q = {.n = groups};
    const int64_t n = graph->n;
    int32_t *first = sl_calloc((int64_t)groups + 1, sizeof *first);
    int32_t *member = sl_alloc(n, sizeof *member);
    int32_t *mark = sl_alloc(groups, sizeof *mark);
    double *points = sl_alloc(3 * (int64_t)groups, sizeof *points);
    sl_status status = SL_OK;
    Q.first = sl_alloc((int64_t)groups + 1, sizeof *Q.first);
    Q.adj = sl_alloc(graph->first[n], sizeof *Q.adj);
    if (first == NULL || member == NULL || mark == NULL || points == NULL || Q.first == NULL || Q.adj == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    list_members(graph->n, group, groups, first, member);
    fill_quotient(graph, group, first, member, mark, &Q);
    place_groups(graph->n, xyz, group, points);
    int32_t *group_piece = mark; /* done with as a marker */
    SL_TRY(sl_dissect_distinct(&Q, points, group_piece));
    for (int32_t i = 0; i < graph->n; i++) {
        piece[i] = group_piece[group[i]];
    }
cleanup:
    sl_free(first);
    sl_free(member);
    sl_free(mark);
    sl_free(points);
    sl_adjacency_clear(&Q);
    return status;
}

sl_status sl_dissect(const sl_adjacency *graph, const double *xyz, int32_t *piece)
{
    if (xyz == NULL) {
        return sl_dissect_distinct(graph, NULL, piece);
    }
    int32_t groups = 0;
    int32_t *group = sl_alloc(graph->n, sizeof *group);
    sl_status status = group != NULL ? SL_OK : SL_OUT_OF_MEMORY;
    SL_TRY(status);
    SL_TRY(group_by_point(graph->n, xyz, group, &groups));
    if (groups == graph->n) {
        SL_TRY(sl_dissect_distinct(graph, xyz, piece));
    } else {
        SL_TRY(dissect_groups(graph, xyz, group, groups, piece));
    }
cleanup:
    sl_free(group);
    return status;
}
