/* Eight triangles on the picture: corners, boxes, edges. Included by the kernels, in lanes.
 * Layer: render, private. */
#ifndef SL_RENDER_FRAME_KERNEL_CORNERS_H
#define SL_RENDER_FRAME_KERNEL_CORNERS_H

#include "draw/screen.h"
#include "render/frame_internal.h"
#include "render/frame_lanes.h"

static const int32_t lane_number[8] = {0, 1, 2, 3, 4, 5, 6, 7};

typedef struct corners8 {
    i8 x[3], y[3];
    f8 key[3];
    i8 plain; /* mask: all corners on the picture, sides below SL_FRAME_SMALL */
    i8 area;  /* of plain ones, twice, in 1/65536 pixel; negative seen from the front */
} corners8;

/* Pixels whose centres the box of a triangle holds. */
typedef struct box8 {
    i8 x0, x1, y0, y1;
} box8;

LANES_CALL i8 least3(const i8 v[3])
{
    return i8_min(i8_min(v[0], v[1]), v[2]);
}

LANES_CALL i8 most3(const i8 v[3])
{
    return i8_max(i8_max(v[0], v[1]), v[2]);
}

/* index: three vertices a triangle. */
LANES_CALL void load_corners(const sl_frame *f, const int32_t *index, corners8 *c)
{
    i8 off = i8_all(0);
    for (int k = 0; k < 3; k++) {
        int64_t at[8];
        i8 word[4];
        for (int lane = 0; lane < 8; lane++) {
            at[lane] = (int64_t)sizeof *f->vertex * index[3 * lane + k];
        }
        four_words((const char *)f->vertex, at, word);
        c->key[k] = i8_bits(word[0]);
        c->x[k] = word[1];
        c->y[k] = word[2];
        off = i8_or(off, i8_equal(word[1], i8_all(SL_FRAME_FAR)));
    }
    const i8 wide = i8_or(i8_sub(most3(c->x), least3(c->x)), i8_sub(most3(c->y), least3(c->y)));
    c->plain = i8_without(i8_less(wide, i8_all(SL_FRAME_SMALL)), off);
    c->area = i8_sub(i8_mul(i8_sub(c->x[1], c->x[0]), i8_sub(c->y[2], c->y[0])),
                     i8_mul(i8_sub(c->x[2], c->x[0]), i8_sub(c->y[1], c->y[0])));
}

/* Within rows [row, row_end). */
LANES_CALL void find_box(const sl_frame *f, const corners8 *c, int32_t row, int32_t row_end, box8 *box)
{
    const i8 up = i8_all(SL_SUBPIXELS - 1);
    box->x0 = i8_max(i8_down(i8_add(least3(c->x), up), 8), i8_all(0));
    box->x1 = i8_min(i8_down(most3(c->x), 8), i8_all(f->width - 1));
    box->y0 = i8_max(i8_down(i8_add(least3(c->y), up), 8), i8_all(row));
    box->y1 = i8_min(i8_down(most3(c->y), 8), i8_all(row_end - 1));
}

/* Makes areas positive: swaps two corners where they are not. */
LANES_CALL void turn_corners(corners8 *c)
{
    const i8 turn = i8_down(c->area, 31);
    const i8 x = c->x[1], y = c->y[1];
    const f8 key = c->key[1];
    c->x[1] = i8_select(turn, c->x[2], x);
    c->y[1] = i8_select(turn, c->y[2], y);
    c->key[1] = f8_select(turn, c->key[2], key);
    c->x[2] = i8_select(turn, x, c->x[2]);
    c->y[2] = i8_select(turn, y, c->y[2]);
    c->key[2] = f8_select(turn, key, c->key[2]);
    c->area = i8_select(turn, i8_sub(i8_all(0), c->area), c->area);
}

/* An edge's function: not negative inside, with the top-left rule in its value. Source: Pineda 1988, "A parallel
 * algorithm for polygon rasterization". */
typedef struct edge8 {
    i8 value, step_x, step_y;
} edge8;

/* Of the edge from corner k, at pixel (px, py). */
LANES_CALL void find_edge(const corners8 *c, int k, i8 px, i8 py, edge8 *e)
{
    const int next = (k + 1) % 3;
    const i8 dx = i8_sub(c->x[next], c->x[k]), dy = i8_sub(c->y[next], c->y[k]), zero = i8_all(0);
    const i8 owned = i8_or(i8_less(dy, zero), i8_and(i8_equal(dy, zero), i8_less(zero, dx)));
    const i8 value = i8_sub(i8_mul(dx, i8_sub(i8_up(py, 8), c->y[k])), i8_mul(dy, i8_sub(i8_up(px, 8), c->x[k])));
    e->value = i8_add(value, i8_without(i8_all(-1), owned));
    e->step_x = i8_sub(zero, i8_up(dy, 8));
    e->step_y = i8_up(dx, 8);
}

#endif
