/* libFuzzer target: bytes make triangles with UVs of every kind; the counts from edges are those from triangles, after
 * moves too; the exact test finds what comparing all pairs does; the certificate ends. Anything else is a finding. See
 * meson.build. */
#include "base/memory.h"
#include "geom/predicates.h"
#include "overlap/certificate.h"
#include "overlap/coverage.h"
#include "overlap/edge_raster.h"
#include "overlap/exact.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { VERTICES = 24, MOST_TRIANGLES = 40, SIDE = 37 };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void demand(bool good)
{
    if (!good) {
        abort();
    }
}

typedef struct input {
    const uint8_t *data;
    size_t size, at;
} input;

static uint8_t next(input *in)
{
    return in->at < in->size ? in->data[in->at++] : 0;
}

/* A number that is often a tie: on a texel's centre, edge or corner, or any bits at all. */
static double number(input *in)
{
    const uint8_t kind = next(in);
    double value;
    uint8_t bits[8];
    switch (kind % 4) {
    case 0:
        return (double)next(in) / (2.0 * SIDE);
    case 1:
        return (double)(next(in) << 8 | next(in)) / 32768.0 - 0.5;
    case 2:
        return ldexp((double)next(in) - 128.0, (int)(next(in) % 32) - 16);
    default:
        for (int k = 0; k < 8; k++) {
            bits[k] = next(in);
        }
        memcpy(&value, bits, sizeof value);
        /* The predicates are exact for spans of 2^900; what is not finite is to be refused. */
        return isfinite(value) && value != 0.0 && (fabs(value) < 1e-100 || fabs(value) > 1e100) ? 1e100 : value;
    }
}

static void compare(const sl_edge_raster *raster, const double *uv, int32_t nt, const int32_t *tri)
{
    sl_coverage *coverage = NULL;
    const uint16_t *count = sl_edge_raster_counts16(raster);
    demand(sl_coverage_create(SIDE, SIDE, &coverage) == SL_OK);
    demand(sl_coverage_add(coverage, uv, nt, tri, NULL) == SL_OK);
    demand(memcmp(count, coverage->count, sizeof *count * SIDE * SIDE) == 0);
    const sl_edge_raster_info info = sl_edge_raster_result(raster);
    demand(info.covered == sl_coverage_covered(coverage));
    demand(info.overlapping == sl_coverage_overlapping(coverage));
    sl_coverage_free(coverage);
}

static void draw(input *in, double *uv, int32_t nt, const int32_t *tri)
{
    const sl_edge_raster_def def = {.width = SIDE, .height = SIDE, .depth = 16, .portable = (nt & 1) != 0};
    sl_edge_raster *raster = NULL;
    demand(sl_edge_raster_create(VERTICES, nt, tri, &def, &raster) == SL_OK);
    bool good = sl_edge_raster_draw(raster, uv, NULL) == SL_OK;
    for (int step = 0; step < 4; step++) {
        if (good) {
            compare(raster, uv, nt, tri);
        }
        int32_t moved[3];
        for (int k = 0; k < 3; k++) {
            moved[k] = next(in) % VERTICES;
            uv[2 * moved[k]] = number(in);
            uv[2 * moved[k] + 1] = number(in);
        }
        good = sl_edge_raster_move(raster, uv, 3, moved, NULL) == SL_OK;
    }
    sl_edge_raster_free(raster);
}

/* The corners counter-clockwise; false without area. */
static bool turn(const double *uv, const int32_t *tri, double p[6])
{
    const int way = sl_orient2d(uv + 2 * tri[0], uv + 2 * tri[1], uv + 2 * tri[2]);
    for (int k = 0; k < 3; k++) {
        const int from = way < 0 ? 2 - k : k;
        p[2 * k] = uv[2 * tri[from]];
        p[2 * k + 1] = uv[2 * tri[from] + 1];
    }
    return way != 0;
}

static void compare_exact(const double *uv, int32_t nt, const int32_t *tri)
{
    uint8_t red[MOST_TRIANGLES], expected[MOST_TRIANGLES] = {0};
    sl_exact_overlap exact;
    if (sl_overlap_exact(uv, nt, tri, NULL, red, &exact) != SL_OK) {
        return;
    }
    for (int32_t a = 0; a < nt; a++) {
        for (int32_t b = 0; b < a; b++) {
            double p[6], q[6];
            if (turn(uv, tri + 3 * a, p) && turn(uv, tri + 3 * b, q) &&
                sl_triangles_order(p, q) == SL_TRIANGLES_OVERLAP) {
                expected[a] = expected[b] = 1;
            }
        }
    }
    demand(memcmp(red, expected, (size_t)nt) == 0);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    input in = {data, size, 0};
    double uv[2 * VERTICES];
    int32_t tri[3 * MOST_TRIANGLES];
    sl_certificate certificate;
    const int32_t nt = next(&in) % (MOST_TRIANGLES + 1);
    for (int32_t c = 0; c < 3 * nt; c++) {
        tri[c] = next(&in) % VERTICES;
    }
    for (int32_t i = 0; i < 2 * VERTICES; i++) {
        uv[i] = number(&in);
    }
    compare_exact(uv, nt, tri);
    const sl_status status = sl_certify_embedding(uv, nt, tri, 3 * nt / 2, tri, &certificate);
    demand(status == SL_OK || status == SL_BAD_INPUT);
    draw(&in, uv, nt, tri);
    return 0;
}
