/* Charts as patches of their own, taken out of the surface along the edges that are cut. */
#include "optimize/optimize_internal.h"

#include "base/memory.h"

#include <string.h>

/* The halfedge that leaves h's vertex after h, clockwise; -1 when h is a border halfedge. */
static int32_t clockwise(const sl_patch *p, int32_t h)
{
    return p->twin[h] < 0 ? -1 : sl_corner_next(p->twin[h]);
}

/* Numbers the fans by their first corner, and finds a leaving halfedge and the border flag of each. */
static void label_vertices(sl_patch *p, const sl_patch *whole)
{
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        p->tri[c] = -1;
    }
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        if (p->tri[c] >= 0) {
            continue;
        }
        int32_t start = c, next = clockwise(p, c);
        while (next >= 0 && next != c) {
            start = next;
            next = clockwise(p, next);
        }
        const bool border = next < 0;
        start = border ? start : c;
        const int32_t v = p->nv++;
        p->outgoing[v] = start;
        p->border[v] = border;
        memcpy(p->xyz + 3 * (int64_t)v, whole->xyz + 3 * (int64_t)whole->tri[p->corner[c]], 3 * sizeof *p->xyz);
        for (int32_t h = start; h >= 0 && p->tri[h] < 0; h = p->twin[sl_corner_prev(h)]) {
            p->tri[h] = v;
        }
    }
}

/* Border loops and Euler characteristic. seen: 3 nt zero bytes. */
static void count_topology(sl_patch *p, uint8_t *seen)
{
    int32_t halfedges = 0;
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        if (p->twin[c] >= 0) {
            continue;
        }
        halfedges++;
        p->loops += seen[c] == 0;
        for (int32_t h = c; seen[h] == 0;) {
            seen[h] = 1;
            h = p->outgoing[p->tri[sl_corner_next(h)]];
        }
    }
    p->euler = p->nv - (3 * p->nt + halfedges) / 2 + p->nt;
}

static sl_status allocate(int32_t count, sl_patch **out)
{
    sl_patch *p = sl_calloc(1, sizeof *p);
    *out = p;
    if (p == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    const int64_t corners = 3 * (int64_t)count;
    p->nt = count;
    p->xyz = sl_alloc(corners, 3 * sizeof *p->xyz);
    p->tri = sl_alloc(corners, sizeof *p->tri);
    p->twin = sl_alloc(corners, sizeof *p->twin);
    p->corner = sl_alloc(corners, sizeof *p->corner);
    p->facet = sl_alloc(count, sizeof *p->facet);
    p->outgoing = sl_alloc(corners, sizeof *p->outgoing);
    p->border = sl_alloc(corners, sizeof *p->border);
    const bool ok = p->xyz != NULL && p->tri != NULL && p->twin != NULL && p->corner != NULL && p->facet != NULL &&
                    p->outgoing != NULL && p->border != NULL;
    return ok ? SL_OK : SL_OUT_OF_MEMORY;
}

static void glue(const sl_patch *whole, const uint8_t *cut, const int32_t *list, const int32_t *local, sl_patch *p)
{
    for (int32_t i = 0; i < p->nt; i++) {
        p->facet[i] = list[i];
        for (int32_t k = 0; k < 3; k++) {
            const int32_t c = 3 * list[i] + k, t = whole->twin[c];
            p->corner[3 * i + k] = c;
            const int32_t at = t >= 0 && cut[c] == 0 ? local[t / 3] : -1;
            p->twin[3 * i + k] = at < 0 ? -1 : 3 * at + t % 3;
        }
    }
}

sl_status sl_opt_extract(const sl_opt_surface *surface, const uint8_t *cut, const int32_t *list, int32_t count,
                         int32_t *local, sl_patch **out)
{
    sl_patch *p = NULL;
    sl_status status = allocate(count, &p);
    uint8_t *seen = sl_calloc(3 * (int64_t)count, sizeof *seen);
    if (status != SL_OK || seen == NULL) {
        sl_patch_free(p);
        sl_free(seen);
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t i = 0; i < count; i++) {
        local[list[i]] = i;
    }
    glue(surface->patch, cut, list, local, p);
    for (int32_t i = 0; i < count; i++) {
        local[list[i]] = -1;
    }
    label_vertices(p, surface->patch);
    count_topology(p, seen);
    sl_free(seen);
    *out = p;
    return SL_OK;
}

void sl_opt_chart_clear(sl_opt_chart *chart)
{
    sl_patch_free(chart->patch);
    sl_free(chart->uv);
    *chart = (sl_opt_chart){0};
}

static sl_status copy_patch(const sl_patch *patch, sl_patch **out)
{
    const int64_t nv = patch->nv, nc = 3 * (int64_t)patch->nt;
    sl_patch *p = sl_copy(patch, 1, sizeof *p);
    *out = NULL;
    if (p == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    p->xyz = sl_copy(patch->xyz, 3 * nv, sizeof *p->xyz);
    p->tri = sl_copy(patch->tri, nc, sizeof *p->tri);
    p->twin = sl_copy(patch->twin, nc, sizeof *p->twin);
    p->corner = sl_copy(patch->corner, nc, sizeof *p->corner);
    p->facet = sl_copy(patch->facet, patch->nt, sizeof *p->facet);
    p->outgoing = sl_copy(patch->outgoing, nv, sizeof *p->outgoing);
    p->border = sl_copy(patch->border, nv, sizeof *p->border);
    if (p->xyz == NULL || p->tri == NULL || p->twin == NULL || p->corner == NULL || p->facet == NULL ||
        p->outgoing == NULL || p->border == NULL) {
        sl_patch_free(p);
        return SL_OUT_OF_MEMORY;
    }
    *out = p;
    return SL_OK;
}

sl_status sl_opt_chart_copy(const sl_opt_chart *chart, sl_opt_chart *out)
{
    *out = (sl_opt_chart){.sums = chart->sums, .stamp = chart->stamp};
    const sl_status status = copy_patch(chart->patch, &out->patch);
    if (status != SL_OK) {
        return status;
    }
    out->uv = sl_copy(chart->uv, 2 * (int64_t)chart->patch->nv, sizeof *out->uv);
    return out->uv == NULL ? SL_OUT_OF_MEMORY : SL_OK;
}
