/* The visibility buffer of a band. Included by the kernels, in lanes.
 * Layer: render, private. */
#ifndef SL_RENDER_FRAME_KERNEL_RASTER_H
#define SL_RENDER_FRAME_KERNEL_RASTER_H

#include "render/frame_kernel_corners.h"

/* Eight triangles set up, ready to be filled one after the other. */
typedef struct batch {
    int32_t value[3][8], step_x[3][8], step_y[3][8]; /* edges, at the box's first pixel */
    int32_t x0[8], x1[8], y0[8], y1[8];
    float depth[8], depth_x[8], depth_y[8], nearest[8], farthest[8];
    uint32_t plain;
} batch;

/* Depth over the picture, from the box's first pixel. */
LANES_CALL void set_depth(const corners8 *c, const box8 *box, batch *b)
{
    const f8 scale = f8_div(f8_all((float)SL_SUBPIXELS), i8_float(c->area)), pixel = f8_all(1.0f / SL_SUBPIXELS);
    const f8 bx = i8_float(i8_sub(c->x[1], c->x[0])), by = i8_float(i8_sub(c->y[1], c->y[0]));
    const f8 cx = i8_float(i8_sub(c->x[2], c->x[0])), cy = i8_float(i8_sub(c->y[2], c->y[0]));
    const f8 bk = f8_sub(c->key[1], c->key[0]), ck = f8_sub(c->key[2], c->key[0]);
    const f8 dx = f8_mul(f8_sub(f8_mul(bk, cy), f8_mul(ck, by)), scale);
    const f8 dy = f8_mul(f8_sub(f8_mul(ck, bx), f8_mul(bk, cx)), scale);
    const f8 x = f8_mul(i8_float(i8_sub(i8_up(box->x0, 8), c->x[0])), pixel);
    const f8 y = f8_mul(i8_float(i8_sub(i8_up(box->y0, 8), c->y[0])), pixel);
    f8_store(b->depth, f8_add(c->key[0], f8_add(f8_mul(dx, x), f8_mul(dy, y))));
    f8_store(b->depth_x, dx);
    f8_store(b->depth_y, dy);
    f8_store(b->nearest, f8_min(f8_min(c->key[0], c->key[1]), c->key[2]));
    f8_store(b->farthest, f8_max(f8_max(c->key[0], c->key[1]), c->key[2]));
}

LANES_CALL void set_batch(const sl_frame *f, const int32_t *index, int32_t row, int32_t row_end, batch *b)
{
    corners8 c;
    box8 box;
    load_corners(f, index, &c);
    find_box(f, &c, row, row_end, &box);
    turn_corners(&c);
    for (int k = 0; k < 3; k++) {
        edge8 e;
        find_edge(&c, k, box.x0, box.y0, &e);
        i8_store(b->value[k], e.value);
        i8_store(b->step_x[k], e.step_x);
        i8_store(b->step_y[k], e.step_y);
    }
    i8_store(b->x0, box.x0);
    i8_store(b->x1, box.x1);
    i8_store(b->y0, box.y0);
    i8_store(b->y1, box.y1);
    set_depth(&c, &box, b);
    b->plain = i8_signs(c.plain);
}

/* Eight columns from x on. Groups start at multiples of eight, so that what one triangle stored the next one loads
 * whole, straight from the store buffer. */
LANES_CALL void fill_columns(const sl_frame *f, const batch *b, int k, int32_t x, int32_t place)
{
    const i8 lane = i8_add(i8_load(lane_number), i8_all(x - b->x0[k])), number = i8_all(place);
    const f8 nearest = f8_all(b->nearest[k]), farthest = f8_all(b->farthest[k]);
    const f8 across = f8_mul(f8_all(b->depth_x[k]), i8_float(lane));
    i8 value[3], step[3];
    for (int e = 0; e < 3; e++) {
        value[e] = i8_add(i8_all(b->value[e][k]), i8_mul(i8_all(b->step_x[e][k]), lane));
        step[e] = i8_all(b->step_y[e][k]);
    }
    const int64_t stride = f->stride, first = b->y0[k] * stride + x;
    const f8 top = f8_all(b->depth[k]), down = f8_all(b->depth_y[k]), one = f8_all(1.0f);
    float *depth = f->depth + first;
    int32_t *seen = f->seen + first;
    f8 r = f8_all(0.0f);
    for (int32_t rows = b->y1[k] - b->y0[k]; rows >= 0; rows--) {
        const f8 plane = f8_add(f8_add(top, f8_mul(down, r)), across);
        const f8 key = f8_min(f8_max(plane, nearest), farthest), old = f8_load(depth);
        const i8 outside = i8_down(i8_or(i8_or(value[0], value[1]), value[2]), 31);
        const f8 inside = i8_bits(i8_or(f8_bits(key), outside)); /* outside: NaN */
        f8_store(depth, f8_min(inside, old));
        i8_store(seen, i8_select(f8_less(inside, old), number, i8_load(seen)));
        depth += stride;
        seen += stride;
        r = f8_add(r, one);
        for (int e = 0; e < 3; e++) {
            value[e] = i8_add(value[e], step[e]);
        }
    }
}

static inline void clear_rows(const sl_frame *f, int32_t row, int32_t row_end)
{
    const int64_t begin = (int64_t)row * f->stride, end = (int64_t)row_end * f->stride;
    for (int64_t i = begin; i < end; i++) {
        f->depth[i] = 2.0f;
        f->seen[i] = -1;
    }
}

/* Vertices of the triangles [i, i + 8) of a list, the last one again where it ends; they are asked for from memory. */
static inline void load_index(const sl_frame *f, const int32_t *banded, int32_t i, int32_t count, int32_t index[24])
{
    for (int32_t k = 0; k < 8; k++) {
        const int32_t *tri = f->tri + 3 * (int64_t)banded[i + k < count ? i + k : count - 1];
        for (int c = 0; c < 3; c++) {
            index[3 * k + c] = tri[c];
            __builtin_prefetch(f->vertex + tri[c]);
        }
    }
}

LANES_TARGET static void raster(const sl_frame *f, int32_t band, int32_t row, int32_t row_end)
{
    const int32_t count = (int32_t)(f->band_first[band + 1] - f->band_first[band]);
    int32_t index[2][24];
    clear_rows(f, row, row_end);
    if (count == 0) { /* where there is nothing at all, nothing was allocated */
        return;
    }
    const int32_t *banded = f->banded + f->band_first[band];
    load_index(f, banded, 0, count, index[0]);
    for (int32_t i = 0; i < count; i += 8) {
        const int32_t n = count - i < 8 ? count - i : 8;
        batch b;
        load_index(f, banded, i + 8, count, index[1 - i / 8 % 2]);
        set_batch(f, index[i / 8 % 2], row, row_end, &b);
        for (int32_t k = 0; k < n; k++) {
            if ((b.plain >> k & 1) == 0) {
                sl_frame_raster_odd(f, banded[i + k], i + k, row, row_end);
                continue;
            }
            for (int32_t x = b.x0[k] & ~7; x <= b.x1[k]; x += 8) {
                fill_columns(f, &b, k, x, i + k);
            }
        }
    }
}

#endif
