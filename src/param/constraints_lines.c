/* The straight lines that constraints ask for: their vertices and edges, and whether lines can lie like that at all. */
#include <string.h>

#include "base/memory.h"
#include "param/constraints_internal.h"

/* Lines while they are collected. */
typedef struct builder {
    const sl_patch *patch;
    const sl_teller *teller;
    sl_line_set *lines;
    int64_t line_room, origin_room, vertex_room;
} builder;

static sl_status open_line(builder *b, int32_t origin)
{
    sl_status status = SL_OK;
    sl_line_set *lines = b->lines;
    SL_TRY(sl_reserve((void **)&lines->first, &b->line_room, (int64_t)lines->count + 2, sizeof *lines->first));
    SL_TRY(sl_reserve((void **)&lines->origin, &b->origin_room, (int64_t)lines->count + 1, sizeof *lines->origin));
    if (lines->count == 0) {
        lines->first[0] = 0;
    }
    lines->origin[lines->count++] = origin;
    lines->first[lines->count] = lines->first[lines->count - 1];
cleanup:
    return status;
}

static sl_status add_vertex(builder *b, int32_t v)
{
    sl_line_set *lines = b->lines;
    int32_t *end = &lines->first[lines->count];
    const sl_status status = *end == INT32_MAX ? SL_OUT_OF_MEMORY
                                               : sl_reserve((void **)&lines->vertex, &b->vertex_room, (int64_t)*end + 1,
                                                            sizeof *lines->vertex);
    if (status == SL_OK) {
        lines->vertex[(*end)++] = v;
    }
    return status;
}

/* The border from a to b, chart on the left; a != b. Ends: a loop comes back to a. */
static sl_status add_border_run(builder *b, int32_t origin, int32_t from, int32_t to)
{
    sl_status status = SL_OK;
    const sl_patch *patch = b->patch;
    int32_t h = patch->outgoing[from], v = from;
    SL_TRY(open_line(b, origin));
    SL_TRY(add_vertex(b, from));
    do {
        v = patch->tri[sl_corner_next(h)];
        SL_TRY(add_vertex(b, v));
        h = patch->outgoing[v];
    } while (v != to && v != from);
    if (v != to) {
        sl_diag_reason(b->teller->diag, "vertices %d and %d are not on one border loop", sl_name_of(b->teller, from),
                       sl_name_of(b->teller, to));
        status = SL_BAD_INPUT;
    }
cleanup:
    return status;
}

/* Are the corners met in the order given when the border is walked from the first with the chart on the left? */
static bool in_border_order(const sl_patch *patch, const sl_constraint *polygon)
{
    int32_t met = 1, h = patch->outgoing[polygon->vertex[0]];
    for (int32_t v = patch->tri[sl_corner_next(h)]; v != polygon->vertex[0]; v = patch->tri[sl_corner_next(h)]) {
        met += met < polygon->count && v == polygon->vertex[met];
        h = sl_border_next(patch, h);
    }
    return met == polygon->count;
}

static sl_status add_polygon(builder *b, int32_t origin, const sl_constraint *polygon)
{
    sl_status status = SL_OK;
    const int32_t n = polygon->count, *v = polygon->vertex;
    bool forwards = in_border_order(b->patch, polygon);
    if (!forwards) { /* the same corners the other way round */
        int32_t *reversed = sl_alloc(n, sizeof *reversed);
        if (reversed == NULL) {
            return SL_OUT_OF_MEMORY;
        }
        for (int32_t i = 0; i < n; i++) {
            reversed[i] = v[n - 1 - i];
        }
        const bool backwards = in_border_order(b->patch, &(sl_constraint){.count = n, .vertex = reversed});
        sl_free(reversed);
        if (!backwards) {
            sl_diag_reason(b->teller->diag,
                           "the %d corners from vertex %d on are not in border order, or not on one border "
                           "loop",
                           n, sl_name_of(b->teller, v[0]));
            return SL_BAD_INPUT;
        }
    }
    for (int32_t i = 0; i < n; i++) {
        const int32_t next = v[(i + 1) % n];
        SL_TRY(add_border_run(b, origin, forwards ? v[i] : next, forwards ? next : v[i]));
    }
cleanup:
    return status;
}

static sl_status collect(builder *b, int32_t origin, const sl_constraint *constraint)
{
    sl_status status = SL_OK;
    switch (constraint->kind) {
    case SL_CONSTRAINT_STRAIGHT:
        SL_TRY(open_line(b, origin));
        for (int32_t i = 0; i < constraint->count; i++) {
            SL_TRY(add_vertex(b, constraint->vertex[i]));
        }
        break;
    case SL_CONSTRAINT_BORDER:
        SL_TRY(add_border_run(b, origin, constraint->vertex[0], constraint->vertex[1]));
        break;
    case SL_CONSTRAINT_POLYGON:
        SL_TRY(add_polygon(b, origin, constraint));
        break;
    case SL_CONSTRAINT_ANGLE:
    case SL_CONSTRAINT_RIGHT:
        break;
    }
cleanup:
    return status;
}

/* The ray of v that leads to w; *halfedge its halfedge, in either direction. -1 = no edge. */
static int32_t ray_to(const sl_patch *patch, int32_t v, int32_t w, int32_t *halfedge)
{
    int32_t c = patch->outgoing[v], ray = 0;
    do {
        if (patch->tri[sl_corner_next(c)] == w) {
            *halfedge = c;
            return ray;
        }
        ray++;
        *halfedge = sl_corner_prev(c);
        if (patch->twin[*halfedge] < 0) {
            return patch->tri[*halfedge] == w ? ray : -1;
        }
        c = patch->twin[*halfedge];
    } while (c != patch->outgoing[v]);
    return -1;
}

/* Rays of every line at its vertices; no edge may be used twice, and no vertex twice by one line. */
static sl_status find_rays(builder *b, uint8_t *used, int32_t *seen)
{
    const sl_line_set *lines = b->lines;
    sl_diag *diag = b->teller->diag;
    for (int32_t l = 0; l < lines->count; l++) {
        for (int32_t p = lines->first[l]; p < lines->first[l + 1]; p++) {
            const int32_t v = lines->vertex[p];
            int32_t h = -1;
            lines->visit[p] = (sl_visit){l, {-1, -1}};
            if (seen[v] == l + 1) {
                sl_diag_reason(diag, "a straight line cannot come back to vertex %d (constraint %d)",
                               sl_name_of(b->teller, v), lines->origin[l] + 1);
                return SL_INFEASIBLE;
            }
            seen[v] = l + 1;
            if (p == lines->first[l]) {
                continue;
            }
            const int32_t u = lines->vertex[p - 1];
            lines->visit[p].ray[0] = ray_to(b->patch, v, u, &h);
            lines->visit[p - 1].ray[1] = ray_to(b->patch, u, v, &h);
            if (lines->visit[p].ray[0] < 0) {
                sl_diag_reason(diag, "no edge joins vertices %d and %d (constraint %d)", sl_name_of(b->teller, u),
                               sl_name_of(b->teller, v), lines->origin[l] + 1);
                return SL_BAD_INPUT;
            }
            const int32_t twin = b->patch->twin[h];
            if (used[twin > h ? twin : h]++ != 0) {
                sl_diag_reason(diag, "two lines share the edge from vertex %d to %d (constraint %d)",
                               sl_name_of(b->teller, u), sl_name_of(b->teller, v), lines->origin[l] + 1);
                return SL_INFEASIBLE;
            }
        }
    }
    return SL_OK;
}

/* at_vertex by counting, lines in ascending order at each vertex. */
static void index_by_vertex(const sl_patch *patch, sl_line_set *lines)
{
    const int32_t total = lines->first[lines->count];
    memset(lines->vertex_first, 0, ((size_t)patch->nv + 1) * sizeof *lines->vertex_first);
    for (int32_t p = 0; p < total; p++) {
        lines->vertex_first[lines->vertex[p]]++;
    }
    for (int32_t v = 1; v <= patch->nv; v++) {
        lines->vertex_first[v] += lines->vertex_first[v - 1];
    }
    for (int32_t p = total - 1; p >= 0; p--) {
        lines->at_vertex[--lines->vertex_first[lines->vertex[p]]] = p;
    }
}

/* Two straight lines have one point in common at most. met: a stamp per line, its vertex. */
static sl_status check_meetings(const sl_line_set *lines, const sl_teller *teller, int32_t *stamp, int32_t *met)
{
    memset(stamp, 0, (size_t)lines->count * sizeof *stamp);
    for (int32_t l = 0; l < lines->count; l++) {
        for (int32_t p = lines->first[l]; p < lines->first[l + 1]; p++) {
            const int32_t v = lines->vertex[p];
            for (int32_t i = lines->vertex_first[v]; i < lines->vertex_first[v + 1]; i++) {
                const int32_t other = lines->visit[lines->at_vertex[i]].line;
                if (other == l) {
                    continue;
                }
                if (stamp[other] == l + 1) {
                    sl_diag_reason(
                        teller->diag,
                        "two straight lines cannot meet twice: at vertices %d and %d (constraints %d and %d)",
                        sl_name_of(teller, met[other]), sl_name_of(teller, v), lines->origin[other] + 1,
                        lines->origin[l] + 1);
                    return SL_INFEASIBLE;
                }
                stamp[other] = l + 1;
                met[other] = v;
            }
        }
    }
    return SL_OK;
}

static sl_status connect_lines(builder *b)
{
    sl_status status = SL_OUT_OF_MEMORY;
    sl_line_set *lines = b->lines;
    const int32_t total = lines->count > 0 ? lines->first[lines->count] : 0;
    uint8_t *used = sl_calloc(3 * (int64_t)b->patch->nt, sizeof *used);
    int32_t *seen = sl_calloc(b->patch->nv, sizeof *seen);
    int32_t *stamp = sl_calloc(lines->count, sizeof *stamp), *met = sl_calloc(lines->count, sizeof *met);
    lines->visit = sl_alloc(total, sizeof *lines->visit);
    lines->vertex_first = sl_calloc((int64_t)b->patch->nv + 1, sizeof *lines->vertex_first);
    lines->at_vertex = sl_alloc(total, sizeof *lines->at_vertex);
    if (used == NULL || seen == NULL || stamp == NULL || met == NULL || lines->visit == NULL ||
        lines->vertex_first == NULL || lines->at_vertex == NULL) {
        goto cleanup;
    }
    status = SL_OK;
    if (lines->count > 0) {
        SL_TRY(find_rays(b, used, seen));
        index_by_vertex(b->patch, lines);
        SL_TRY(check_meetings(lines, b->teller, stamp, met));
    }
cleanup:
    sl_free(used);
    sl_free(seen);
    sl_free(stamp);
    sl_free(met);
    return status;
}

sl_status sl_lines_init(sl_line_set *lines, const sl_patch *patch, int32_t count, const sl_constraint *list,
                        const sl_teller *teller)
{
    sl_status status = SL_OK;
    builder b = {.patch = patch, .teller = teller, .lines = lines};
    *lines = (sl_line_set){0};
    for (int32_t i = 0; i < count; i++) {
        SL_TRY(collect(&b, i, &list[i]));
    }
    SL_TRY(connect_lines(&b));
cleanup:
    if (status != SL_OK) {
        sl_lines_clear(lines);
    }
    return status;
}

void sl_lines_clear(sl_line_set *lines)
{
    sl_free(lines->first);
    sl_free(lines->origin);
    sl_free(lines->vertex);
    sl_free(lines->visit);
    sl_free(lines->vertex_first);
    sl_free(lines->at_vertex);
    *lines = (sl_line_set){0};
}
