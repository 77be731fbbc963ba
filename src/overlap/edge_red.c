#include "overlap/edge_raster_internal.h"

#include "base/memory.h"
#include "overlap/raster_internal.h"

enum { RED_CHUNK = 4096, TILE = 16 };

typedef struct red_job {
    const sl_edge_raster *raster;
    const double *uv;
    uint8_t *tile; /* tiles a row times tile rows: 1 where a texel is hit twice */
    int32_t tiles;
    uint8_t *red;
    int32_t *found; /* per chunk */
} red_job;

static bool hit_twice(const sl_edge_raster *r, int64_t texel)
{
    return r->count8 != NULL ? r->count8[texel] > 1 : r->count16[texel] > 1;
}

/* Only rows that have such texels are looked through. */
static void mark_tiles(const red_job *job)
{
    const sl_edge_raster *r = job->raster;
    for (int32_t y = 0; y < r->height; y++) {
        uint8_t *tile = job->tile + (int64_t)(y / TILE) * job->tiles;
        for (int32_t k = 0; k < job->tiles && r->row_sums[2 * (int64_t)y + 1] > 0; k++) {
            const int32_t end = (k + 1) * TILE < r->width ? (k + 1) * TILE : r->width;
            uint8_t any = 0;
            for (int32_t x = k * TILE; x < end; x++) {
                any |= hit_twice(r, (int64_t)y * r->width + x);
            }
            tile[k] |= any;
        }
    }
}

static int32_t least(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

static int32_t greatest(int32_t a, int32_t b)
{
    return a > b ? a : b;
}

/* The triangle's box meets a tile with such texels. */
static bool box_is_marked(const red_job *job, const int32_t *tri)
{
    const sl_edge_raster *r = job->raster;
    int32_t low[2] = {INT32_MAX, INT32_MAX}, high[2] = {INT32_MIN, INT32_MIN};
    for (int k = 0; k < 3; k++) {
        for (int a = 0; a < 2; a++) {
            const int32_t texel = r->position[2 * (int64_t)tri[k] + a] >> 8;
            low[a] = least(low[a], texel);
            high[a] = greatest(high[a], texel);
        }
    }
    const int32_t y_end = least(high[1], r->height - 1) / TILE, x_end = least(high[0], r->width - 1) / TILE;
    if (high[0] < 0 || high[1] < 0 || low[0] >= r->width || low[1] >= r->height) {
        return false;
    }
    for (int32_t y = greatest(low[1], 0) / TILE; y <= y_end; y++) {
        for (int32_t x = greatest(low[0], 0) / TILE; x <= x_end; x++) {
            if (job->tile[(int64_t)y * job->tiles + x]) {
                return true;
            }
        }
    }
    return false;
}

static bool covers_overlap(const red_job *job, const int32_t *tri)
{
    const sl_edge_raster *r = job->raster;
    sl_raster_triangle triangle;
    sl_raster_walk walk;
    int32_t row_begin, row_end, row, begin, end;
    if (!sl_raster_triangle_set(job->uv, tri, r->width, r->height, &triangle)) {
        return false;
    }
    sl_raster_rows(&triangle, r->height, &row_begin, &row_end);
    sl_raster_walk_start(&triangle, r->width, row_begin, row_end, &walk);
    while (sl_raster_walk_next(&walk, &row, &begin, &end)) {
        for (int32_t x = begin; x < end && r->row_sums[2 * (int64_t)row + 1] > 0; x++) {
            if (hit_twice(r, (int64_t)row * r->width + x)) {
                return true;
            }
        }
    }
    return false;
}

static void find_red(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    const red_job *job = user;
    const sl_edge_raster *r = job->raster;
    for (int64_t t = begin; t < end; t++) {
        const int32_t *tri = r->tri + 3 * t;
        job->red[t] = (r->far || (r->sign[t] != 0 && box_is_marked(job, tri))) && covers_overlap(job, tri);
        job->found[chunk] += job->red[t];
    }
}

sl_status sl_edge_raster_red_triangles(const sl_edge_raster *raster, const double *uv, const sl_context *context,
                                       uint8_t *red, int32_t *count)
{
    SL_ASSERT(raster->drawn);
    sl_status status = SL_OK;
    const int32_t chunks = sl_chunk_count(raster->nt, RED_CHUNK);
    red_job job = {.raster = raster, .uv = uv, .red = red, .tiles = (raster->width + TILE - 1) / TILE};
    *count = 0;
    if (sl_edge_raster_result(raster).overlapping == 0) {
        for (int32_t t = 0; t < raster->nt; t++) {
            red[t] = 0;
        }
        return SL_OK;
    }
    job.tile = sl_calloc((int64_t)job.tiles * ((raster->height + TILE - 1) / TILE), sizeof *job.tile);
    job.found = sl_calloc(chunks, sizeof *job.found);
    if (job.tile == NULL || job.found == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    mark_tiles(&job);
    sl_parallel_for(context, raster->nt, RED_CHUNK, find_red, &job);
    for (int32_t c = 0; c < chunks; c++) {
        *count += job.found[c];
    }
cleanup:
    sl_free(job.tile);
    sl_free(job.found);
    return status;
}
