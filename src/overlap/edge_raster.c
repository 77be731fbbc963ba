#include "overlap/edge_raster_internal.h"

#include "base/memory.h"
#include "overlap/coverage.h"
#include "overlap/raster_internal.h"

#include <string.h>

enum { ORIENT_CHUNK = 16384 }; /* triangles one worker orients at a time */

sl_edge_raster_def sl_edge_raster_default(void)
{
    return (sl_edge_raster_def){.width = 1024, .height = 1024, .depth = 16};
}

/* Copies of the triangles and what follows from them. */
static sl_status build_topology(sl_edge_raster *r, const int32_t *tri)
{
    sl_status status = SL_OK;
    const int64_t n = 3 * (int64_t)r->nt;
    r->tri = sl_copy(tri, n, sizeof *tri);
    r->across = sl_alloc(n, sizeof *r->across);
    for (int k = 0; k < 3; k++) {
        r->corner[k] = sl_alloc(r->nt, sizeof *tri);
    }
    if (r->tri == NULL || r->across == NULL || r->corner[0] == NULL || r->corner[1] == NULL || r->corner[2] == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int64_t h = 0; h < n; h++) {
        r->corner[h % 3][h / 3] = tri[h];
    }
    SL_TRY(sl_edge_topology_pair(r->nv, r->nt, tri, r->across));
    SL_TRY(sl_edge_topology_fans(r->nv, r->nt, tri, &r->fan_first, &r->fan));
    for (int64_t h = 0; h < n; h++) {
        r->borders += r->across[h] < 0;
    }
    r->border = sl_alloc(r->borders, sizeof *r->border);
    if (r->border == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int64_t h = 0, b = 0; h < n; h++) {
        if (r->across[h] < 0) {
            r->border[b++] = (int32_t)h;
        }
    }
cleanup:
    return status;
}

static sl_status allocate_texels(sl_edge_raster *r)
{
    const int64_t texels = (int64_t)r->width * r->height;
    if (r->depth == 8) {
        r->count8 = sl_calloc(texels, sizeof *r->count8);
    } else {
        r->count16 = sl_calloc(texels, sizeof *r->count16);
    }
    r->row_sums = sl_calloc(r->height, 2 * sizeof *r->row_sums);
    r->dirty = sl_calloc(r->height, sizeof *r->dirty);
    r->difference = sl_calloc(r->bands * ((int64_t)r->width + SL_KERNEL_PAD), sizeof *r->difference);
    r->scratch = sl_alloc((int64_t)r->bands * r->width, sizeof *r->scratch);
    r->band_first = sl_alloc((int64_t)r->bands + 1, sizeof *r->band_first);
    r->event_first = sl_alloc((int64_t)r->bands + 1, sizeof *r->event_first);
    const bool full = (r->count8 != NULL || r->count16 != NULL) && r->row_sums != NULL && r->dirty != NULL &&
                      r->difference != NULL && r->scratch != NULL && r->band_first != NULL && r->event_first != NULL;
    return full ? SL_OK : SL_OUT_OF_MEMORY;
}

sl_status sl_edge_raster_create(int32_t nv, int32_t nt, const int32_t *tri, const sl_edge_raster_def *def,
                                sl_edge_raster **out)
{
    SL_ASSERT(nv >= 0 && nt >= 0);
    sl_status status = SL_OK;
    *out = NULL;
    if (def->width < 1 || def->height < 1 || def->width > SL_RASTER_MAX_SIZE || def->height > SL_RASTER_MAX_SIZE ||
        (def->depth != 8 && def->depth != 16) || nt > INT32_MAX / 3) {
        return SL_BAD_INPUT;
    }
    sl_edge_raster *r = sl_calloc(1, sizeof *r);
    if (r == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    r->nv = nv;
    r->nt = nt;
    r->width = def->width;
    r->height = def->height;
    r->depth = def->depth;
    r->bands = (def->height + SL_EDGE_BAND_ROWS - 1) / SL_EDGE_BAND_ROWS;
    r->kernels = sl_raster_kernels_portable();
    r->vector = !def->portable && sl_raster_kernels_avx2(&r->kernels);
    r->position = sl_alloc(nv, 2 * sizeof *r->position);
    r->sign = sl_calloc(nt, sizeof *r->sign);
    if (r->position == NULL || r->sign == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    SL_TRY(build_topology(r, tri));
    SL_TRY(allocate_texels(r));
    *out = r;
    r = NULL;
cleanup:
    sl_edge_raster_free(r);
    return status;
}

void sl_edge_raster_free(sl_edge_raster *r)
{
    if (r == NULL) {
        return;
    }
    sl_free(r->tri);
    for (int k = 0; k < 3; k++) {
        sl_free(r->corner[k]);
    }
    sl_free(r->across);
    sl_free(r->border);
    sl_free(r->fan_first);
    sl_free(r->fan);
    sl_free(r->position);
    sl_free(r->sign);
    sl_free(r->odd);
    sl_free(r->odd_place);
    sl_free(r->count8);
    sl_free(r->count16);
    sl_free(r->row_sums);
    sl_free(r->dirty);
    sl_free(r->difference);
    sl_free(r->scratch);
    sl_free(r->edge);
    sl_free(r->band_first);
    sl_free(r->event_first);
    sl_free(r->banded);
    sl_free(r->event);
    sl_free(r);
}

static void orient_chunk(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    (void)chunk;
    const sl_edge_raster *r = user;
    r->kernels.orient(begin, end, r->corner, r->position, r->sign);
}

/* Appends halfedge h as often as its weight says, turned where that is negative. */
static sl_status append_edge(sl_edge_raster *r, int64_t h, int weight)
{
    const int32_t a = r->tri[h], b = r->tri[h % 3 == 2 ? h - 2 : h + 1];
    const int32_t *p = r->position + 2 * (int64_t)(weight > 0 ? a : b);
    const int32_t *q = r->position + 2 * (int64_t)(weight > 0 ? b : a);
    const sl_lattice_edge edge = {{p[0], q[0]}, {p[1], q[1]}};
    int32_t begin, end;
    sl_edge_rows(&edge, r->height, &begin, &end);
    if (weight == 0 || begin >= end) {
        return SL_OK;
    }
    if (r->edges + 2 > r->edge_capacity) {
        const sl_status status =
            sl_reserve((void **)&r->edge, &r->edge_capacity, r->edges + 2, sizeof(sl_lattice_edge));
        if (status != SL_OK) {
            return status;
        }
    }
    for (int k = 0; k < (weight > 0 ? weight : -weight); k++) {
        r->edge[r->edges++] = edge;
    }
    return SL_OK;
}

/* Edges whose two sides do not cancel: borders, and where a triangle's orientation differs from its neighbour's. Every
 * such pair has a side that is not of the most common orientation; it is appended from there, once. */
static sl_status collect_edges(sl_edge_raster *r)
{
    sl_status status = SL_OK;
    r->edges = 0;
    for (int32_t b = 0; b < r->borders; b++) {
        SL_TRY(append_edge(r, r->border[b], r->sign[r->border[b] / 3]));
    }
    for (int64_t k = 0; k < r->odds; k++) {
        const int32_t t = r->odd[k];
        for (int64_t h = 3 * (int64_t)t; h < 3 * (int64_t)t + 3; h++) {
            const int32_t other = r->across[h];
            if (other >= 0 && r->sign[other] != r->sign[t] && (r->sign[other] == r->most || t < other)) {
                SL_TRY(append_edge(r, h, r->sign[t] - r->sign[other]));
            }
        }
    }
cleanup:
    return status;
}

static bool all_in_range(const sl_edge_raster *r, const double *uv)
{
    for (int32_t t = 0; t < r->nt; t++) {
        if (!sl_raster_in_range(uv, r->tri + 3 * (int64_t)t)) {
            return false;
        }
    }
    return true;
}

/* Triangle by triangle: the lattice positions do not fit the edges' integers. */
static sl_status draw_far(sl_edge_raster *r, const double *uv, const sl_context *context)
{
    sl_coverage *coverage = NULL;
    sl_status status = SL_OK;
    SL_TRY(sl_coverage_create(r->width, r->height, &coverage));
    SL_TRY(sl_coverage_add(coverage, uv, r->nt, r->tri, context));
    r->edges = 0;
    for (int32_t row = 0; row < r->height; row++) {
        int32_t *sums = r->row_sums + 2 * (int64_t)row;
        sums[0] = sums[1] = 0;
        for (int64_t i = (int64_t)row * r->width; i < ((int64_t)row + 1) * r->width; i++) {
            const uint16_t count = coverage->count[i];
            sums[0] += count > 0;
            sums[1] += count > 1;
            if (r->count8 != NULL) {
                r->count8[i] = (uint8_t)(count < UINT8_MAX ? count : UINT8_MAX);
            } else {
                r->count16[i] = count;
            }
        }
    }
cleanup:
    sl_coverage_free(coverage);
    return status;
}

sl_status sl_edge_raster_draw(sl_edge_raster *r, const double *uv, const sl_context *context)
{
    sl_status status = SL_OK;
    const bool near = r->kernels.snap(r->nv, uv, r->width, r->height, r->position);
    r->drawn = false;
    if (!near && !all_in_range(r, uv)) {
        return SL_BAD_INPUT;
    }
    r->far = !near;
    if (!near) {
        SL_TRY(draw_far(r, uv, context));
    } else {
        sl_parallel_for(context, r->nt, ORIENT_CHUNK, orient_chunk, r);
        SL_TRY(sl_edge_signs_count(r));
        SL_TRY(collect_edges(r));
        memset(r->dirty, 1, (size_t)r->height);
        SL_TRY(sl_edge_raster_fill(r, context));
    }
    r->drawn = true;
cleanup:
    return status;
}

/* Rows of all triangles around a vertex are to be counted again. */
static void mark_fan(sl_edge_raster *r, int32_t v)
{
    for (int64_t k = r->fan_first[v]; k < r->fan_first[v + 1]; k++) {
        const int32_t *tri = r->tri + 3 * (int64_t)r->fan[k];
        for (int c = 0; c < 3; c++) {
            const int32_t *p = r->position + 2 * (int64_t)tri[c], *q = r->position + 2 * (int64_t)tri[(c + 1) % 3];
            const sl_lattice_edge edge = {{p[0], q[0]}, {p[1], q[1]}};
            int32_t begin, end;
            sl_edge_rows(&edge, r->height, &begin, &end);
            if (begin < end) {
                memset(r->dirty + begin, 1, (size_t)(end - begin));
            }
        }
    }
}

sl_status sl_edge_raster_move(sl_edge_raster *r, const double *uv, int32_t count, const int32_t *moved,
                              const sl_context *context)
{
    sl_status status = SL_OK;
    bool near = r->drawn && !r->far;
    for (int32_t k = 0; k < count && near; k++) {
        int32_t position[2];
        near = r->kernels.snap(1, uv + 2 * (int64_t)moved[k], r->width, r->height, position);
    }
    if (!near) {
        return sl_edge_raster_draw(r, uv, context);
    }
    SL_TRY(sl_edge_signs_prepare(r));
    r->drawn = false;
    for (int32_t k = 0; k < count; k++) {
        mark_fan(r, moved[k]);
    }
    for (int32_t k = 0; k < count; k++) {
        const int64_t v = moved[k];
        (void)r->kernels.snap(1, uv + 2 * v, r->width, r->height, r->position + 2 * v);
    }
    for (int32_t k = 0; k < count; k++) {
        mark_fan(r, moved[k]);
        for (int64_t f = r->fan_first[moved[k]]; f < r->fan_first[moved[k] + 1]; f++) {
            SL_TRY(sl_edge_signs_update(r, r->fan[f]));
        }
    }
    SL_TRY(sl_edge_signs_settle(r));
    SL_TRY(collect_edges(r));
    SL_TRY(sl_edge_raster_fill(r, context));
    r->drawn = true;
cleanup:
    return status;
}

sl_edge_raster_info sl_edge_raster_result(const sl_edge_raster *r)
{
    sl_edge_raster_info info = {.active_edges = (int32_t)(r->edges < INT32_MAX ? r->edges : INT32_MAX),
                                .folded = r->far ? 0 : (int32_t)r->odds,
                                .vector = r->vector,
                                .far = r->far};
    for (int32_t row = 0; row < r->height; row++) {
        info.covered += r->row_sums[2 * (int64_t)row];
        info.overlapping += r->row_sums[2 * (int64_t)row + 1];
    }
    return info;
}

const uint8_t *sl_edge_raster_counts8(const sl_edge_raster *r)
{
    return r->count8;
}

const uint16_t *sl_edge_raster_counts16(const sl_edge_raster *r)
{
    return r->count16;
}
