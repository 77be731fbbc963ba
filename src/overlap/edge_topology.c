#include "overlap/edge_raster_internal.h"

#include "base/memory.h"

#include <string.h>

static int32_t start_of(const int32_t *tri, int32_t h)
{
    return tri[h];
}

static int32_t end_of(const int32_t *tri, int32_t h)
{
    return tri[h % 3 == 2 ? h - 2 : h + 1];
}

static int32_t edge_vertex(const int32_t *tri, int32_t h, bool larger)
{
    const int32_t a = start_of(tri, h), b = end_of(tri, h);
    return larger == (a > b) ? a : b;
}

/* order := from, stably sorted by the smaller or the larger vertex of the halfedges. first: nv + 1. */
static void sort_halfedges(int32_t nv, int64_t n, const int32_t *tri, bool larger, int64_t *first, const int32_t *from,
                           int32_t *order)
{
    memset(first, 0, ((size_t)nv + 1) * sizeof *first);
    for (int64_t i = 0; i < n; i++) {
        first[edge_vertex(tri, from[i], larger) + 1]++;
    }
    for (int32_t v = 0; v < nv; v++) {
        first[v + 1] += first[v];
    }
    for (int64_t i = 0; i < n; i++) {
        order[first[edge_vertex(tri, from[i], larger)]++] = from[i];
    }
}

static bool same_edge(const int32_t *tri, int32_t g, int32_t h)
{
    return edge_vertex(tri, g, false) == edge_vertex(tri, h, false) &&
           edge_vertex(tri, g, true) == edge_vertex(tri, h, true);
}

/* Pairs the halfedges order[begin .. end - 1] of one edge, one way with the other as long as there are both. */
static void pair_group(const int32_t *tri, const int32_t *order, int64_t begin, int64_t end, int32_t *across)
{
    int64_t up = begin, down = begin;
    for (;;) {
        while (up < end && start_of(tri, order[up]) > end_of(tri, order[up])) {
            up++;
        }
        while (down < end && start_of(tri, order[down]) < end_of(tri, order[down])) {
            down++;
        }
        if (up >= end || down >= end || up == down) { /* equal only where an edge ends in its own start */
            return;
        }
        across[order[up]] = order[down] / 3;
        across[order[down]] = order[up] / 3;
        up++;
        down++;
    }
}

sl_status sl_edge_topology_pair(int32_t nv, int32_t nt, const int32_t *tri, int32_t *across)
{
    const int64_t n = 3 * (int64_t)nt;
    int64_t *first = sl_alloc((int64_t)nv + 1, sizeof *first);
    int32_t *order = sl_alloc(n, sizeof *order), *sorted = sl_alloc(n, sizeof *sorted);
    sl_status status = SL_OK;
    if (first == NULL || order == NULL || sorted == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    for (int64_t h = 0; h < n; h++) {
        order[h] = (int32_t)h;
        across[h] = -1;
    }
    sort_halfedges(nv, n, tri, true, first, order, sorted);
    sort_halfedges(nv, n, tri, false, first, sorted, order);
    for (int64_t begin = 0, end; begin < n; begin = end) {
        for (end = begin + 1; end < n && same_edge(tri, order[begin], order[end]); end++) {
        }
        pair_group(tri, order, begin, end, across);
    }
cleanup:
    sl_free(first);
    sl_free(order);
    sl_free(sorted);
    return status;
}

sl_status sl_edge_topology_fans(int32_t nv, int32_t nt, const int32_t *tri, int64_t **first, int32_t **triangle)
{
    *first = sl_calloc((int64_t)nv + 2, sizeof **first);
    *triangle = sl_alloc(3 * (int64_t)nt, sizeof **triangle);
    if (*first == NULL || *triangle == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    int64_t *start = *first + 1; /* one behind: filling moves each start on to where it belongs */
    for (int64_t c = 0; c < 3 * (int64_t)nt; c++) {
        start[tri[c] + 1]++;
    }
    for (int32_t v = 0; v < nv; v++) {
        start[v + 1] += start[v];
    }
    for (int64_t c = 0; c < 3 * (int64_t)nt; c++) {
        (*triangle)[start[tri[c]]++] = (int32_t)(c / 3);
    }
    return SL_OK;
}
