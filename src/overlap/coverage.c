#include "overlap/coverage.h"

#include "base/memory.h"
#include "overlap/raster_internal.h"

#include <string.h>

enum {
    BAND_ROWS = 64, /* texel rows one worker fills at a time: at 4096 columns 512 KiB, the size of a level-2 cache */
    TRIANGLE_CHUNK = 4096, /* triangles one worker snaps at a time */
};

sl_status sl_coverage_create(int32_t width, int32_t height, sl_coverage **out)
{
    *out = NULL;
    if (width < 1 || height < 1 || width > SL_RASTER_MAX_SIZE || height > SL_RASTER_MAX_SIZE) {
        return SL_BAD_INPUT;
    }
    sl_coverage *coverage = sl_calloc(1, sizeof *coverage);
    if (coverage == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    coverage->width = width;
    coverage->height = height;
    coverage->count = sl_calloc((int64_t)width * height, sizeof *coverage->count);
    if (coverage->count == NULL) {
        sl_coverage_free(coverage);
        return SL_OUT_OF_MEMORY;
    }
    *out = coverage;
    return SL_OK;
}

void sl_coverage_free(sl_coverage *coverage)
{
    if (coverage == NULL) {
        return;
    }
    sl_free(coverage->count);
    sl_free(coverage);
}

/* The bands [first, end) a triangle has rows in; empty when it has none. */
typedef struct band_range {
    int16_t first, end;
} band_range;

typedef struct add_job {
    sl_coverage *coverage;
    const double *uv;
    const int32_t *tri;
    band_range *range; /* of each triangle */
    uint8_t *bad;      /* of each chunk of triangles */
    int64_t *start;    /* triangles of band b: member[start[b] .. start[b + 1] - 1] */
    int32_t *member;
} add_job;

static void find_ranges(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    const add_job *job = user;
    for (int64_t t = begin; t < end; t++) {
        const int32_t *tri = job->tri + 3 * t;
        sl_raster_triangle triangle;
        int32_t first = 0, last = 0;
        if (!sl_raster_in_range(job->uv, tri)) {
            job->bad[chunk] = 1;
        } else if (sl_raster_triangle_set(job->uv, tri, job->coverage->width, job->coverage->height, &triangle)) {
            sl_raster_rows(&triangle, job->coverage->height, &first, &last);
        }
        job->range[t] = (band_range){0, 0};
        if (first < last) {
            job->range[t] = (band_range){(int16_t)(first / BAND_ROWS), (int16_t)((last - 1) / BAND_ROWS + 1)};
        }
    }
}

/* Counting sort of the triangles into bands. */
static sl_status fill_bands(add_job *job, int32_t nt, int32_t bands)
{
    for (int32_t t = 0; t < nt; t++) {
        for (int32_t b = job->range[t].first; b < job->range[t].end; b++) {
            job->start[b + 1]++;
        }
    }
    for (int32_t b = 0; b < bands; b++) {
        job->start[b + 1] += job->start[b];
    }
    job->member = sl_alloc(job->start[bands], sizeof *job->member);
    if (job->member == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t t = 0; t < nt; t++) {
        for (int32_t b = job->range[t].first; b < job->range[t].end; b++) {
            job->member[job->start[b]++] = t;
        }
    }
    for (int32_t b = bands; b > 0; b--) { /* each start has moved on to its end */
        job->start[b] = job->start[b - 1];
    }
    job->start[0] = 0;
    return SL_OK;
}

static void add_span(uint16_t *count, int32_t begin, int32_t end)
{
    for (int32_t x = begin; x < end; x++) {
        count[x] = (uint16_t)(count[x] + (count[x] != UINT16_MAX));
    }
}

/* All triangles of one band. No other worker writes its rows, and saturating counts do not depend on order. */
static void add_band(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    (void)chunk;
    const add_job *job = user;
    sl_coverage *coverage = job->coverage;
    for (int64_t k = job->start[begin]; k < job->start[end]; k++) {
        const int32_t *tri = job->tri + 3 * (int64_t)job->member[k];
        sl_raster_triangle triangle;
        sl_raster_walk walk;
        int32_t row_begin, row_end, row, x_begin, x_end;
        (void)sl_raster_triangle_set(job->uv, tri, coverage->width, coverage->height, &triangle);
        sl_raster_rows(&triangle, coverage->height, &row_begin, &row_end);
        const int32_t low = (int32_t)begin * BAND_ROWS, high = (int32_t)end * BAND_ROWS;
        sl_raster_walk_start(&triangle, coverage->width, row_begin > low ? row_begin : low,
                             row_end < high ? row_end : high, &walk);
        while (sl_raster_walk_next(&walk, &row, &x_begin, &x_end)) {
            add_span(coverage->count + (int64_t)row * coverage->width, x_begin, x_end);
        }
    }
}

sl_status sl_coverage_add(sl_coverage *coverage, const double *uv, int32_t nt, const int32_t *tri,
                          const sl_context *context)
{
    SL_ASSERT(nt >= 0);
    sl_status status = SL_OK;
    const int32_t bands = (coverage->height + BAND_ROWS - 1) / BAND_ROWS;
    const int32_t chunks = sl_chunk_count(nt, TRIANGLE_CHUNK);
    add_job job = {.coverage = coverage,
                   .uv = uv,
                   .tri = tri,
                   .range = sl_alloc(nt, sizeof *job.range),
                   .bad = sl_calloc(chunks, sizeof *job.bad),
                   .start = sl_calloc((int64_t)bands + 1, sizeof *job.start)};
    if (job.range == NULL || job.bad == NULL || job.start == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    sl_parallel_for(context, nt, TRIANGLE_CHUNK, find_ranges, &job);
    for (int32_t c = 0; c < chunks; c++) {
        if (job.bad[c]) {
            SL_TRY(SL_BAD_INPUT);
        }
    }
    SL_TRY(fill_bands(&job, nt, bands));
    sl_parallel_for(context, bands, 1, add_band, &job);
cleanup:
    sl_free(job.member);
    sl_free(job.start);
    sl_free(job.bad);
    sl_free(job.range);
    return status;
}

/* Texels of count `least` and more. */
static int64_t texels_hit(const sl_coverage *coverage, uint16_t least)
{
    int64_t sum = 0;
    const int64_t n = (int64_t)coverage->width * coverage->height;
    for (int64_t k = 0; k < n; k++) {
        sum += coverage->count[k] >= least;
    }
    return sum;
}

int64_t sl_coverage_covered(const sl_coverage *coverage)
{
    return texels_hit(coverage, 1);
}

int64_t sl_coverage_overlapping(const sl_coverage *coverage)
{
    return texels_hit(coverage, 2);
}

static bool covers_overlap(const sl_coverage *coverage, const sl_raster_triangle *triangle)
{
    sl_raster_walk walk;
    int32_t row_begin, row_end, row, begin, end;
    sl_raster_rows(triangle, coverage->height, &row_begin, &row_end);
    sl_raster_walk_start(triangle, coverage->width, row_begin, row_end, &walk);
    while (sl_raster_walk_next(&walk, &row, &begin, &end)) {
        const uint16_t *count = coverage->count + (int64_t)row * coverage->width;
        for (int32_t x = begin; x < end; x++) {
            if (count[x] >= 2) {
                return true;
            }
        }
    }
    return false;
}

sl_status sl_coverage_red_triangles(const sl_coverage *coverage, const double *uv, int32_t nt, const int32_t *tri,
                                    uint8_t *red)
{
    SL_ASSERT(nt >= 0);
    for (int32_t t = 0; t < nt; t++) {
        if (!sl_raster_in_range(uv, tri + 3 * (int64_t)t)) {
            return SL_BAD_INPUT;
        }
    }
    memset(red, 0, (size_t)nt);
    if (sl_coverage_overlapping(coverage) == 0) {
        return SL_OK;
    }
    for (int32_t t = 0; t < nt; t++) {
        sl_raster_triangle triangle;
        red[t] = sl_raster_triangle_set(uv, tri + 3 * (int64_t)t, coverage->width, coverage->height, &triangle) &&
                 covers_overlap(coverage, &triangle);
    }
    return SL_OK;
}
