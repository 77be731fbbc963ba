/* Which triangles may show, and in which bands. Included by the kernels, in lanes.
 * Layer: render, private. */
#ifndef SL_RENDER_FRAME_KERNEL_KEEP_H
#define SL_RENDER_FRAME_KERNEL_KEEP_H

#include "render/frame_kernel_corners.h"

#include <string.h>

/* Lanes of plain triangles that may show. A triangle whose box holds one centre is asked for that centre: most
 * triangles of fine meshes end here. */
LANES_CALL i8 may_show(const sl_frame *f, corners8 *c, const box8 *box)
{
    const i8 zero = i8_all(0), empty = i8_or(i8_less(box->x1, box->x0), i8_less(box->y1, box->y0));
    const i8 one = i8_and(i8_equal(box->x0, box->x1), i8_equal(box->y0, box->y1));
    i8 gone = i8_or(empty, i8_equal(c->area, zero)), outside = zero;
    if (f->style.cull) { /* front: anticlockwise in space, clockwise with y down */
        gone = i8_or(gone, i8_less(zero, c->area));
    }
    turn_corners(c);
    for (int k = 0; k < 3; k++) {
        edge8 e;
        find_edge(c, k, box->x0, box->y0, &e);
        outside = i8_or(outside, i8_down(e.value, 31));
    }
    return i8_without(c->plain, i8_or(gone, i8_and(one, outside)));
}

/* The odd ones of eight triangles; returns a bit for each that may show. */
static inline uint32_t keep_odd(const sl_frame *f, int32_t t, uint32_t odd, sl_frame_span bands[8])
{
    uint32_t shown = 0;
    for (int32_t k = 0; k < 8; k++) {
        if ((odd >> k & 1) != 0 && sl_frame_keep_odd(f, t + k, &bands[k])) {
            shown |= 1u << k;
        }
    }
    return shown;
}

/* Of the triangles t .. t + n - 1; index: of eight. */
LANES_CALL int32_t keep_eight(const sl_frame *f, int32_t t, int32_t n, const int32_t *index, int32_t *kept,
                              sl_frame_span *span)
{
    corners8 c;
    box8 box;
    int32_t first[8], last[8], count = 0;
    sl_frame_span bands[8];
    load_corners(f, index, &c);
    find_box(f, &c, 0, f->height, &box);
    uint32_t shown = i8_signs(may_show(f, &c, &box));
    const uint32_t odd = ~i8_signs(c.plain) & ((1u << n) - 1u);
    i8_store(first, i8_down(box.y0, 5));
    i8_store(last, i8_down(box.y1, 5));
    for (int32_t k = 0; k < 8; k++) {
        bands[k] = (sl_frame_span){(uint16_t)first[k], (uint16_t)last[k]};
    }
    if (odd != 0) {
        shown |= keep_odd(f, t, odd, bands);
    }
    for (int32_t k = 0; k < n; k++) {
        kept[count] = t + k;
        span[count] = bands[k];
        count += (int32_t)(shown >> k & 1);
    }
    return count;
}

LANES_TARGET static int32_t keep(const sl_frame *f, int32_t begin, int32_t end, int32_t *kept, sl_frame_span *span)
{
    _Static_assert(SL_FRAME_BAND == 1 << 5, "bands of rows by a shift");
    int32_t count = 0, t = begin;
    for (; t + 8 <= end; t += 8) {
        count += keep_eight(f, t, 8, f->tri + 3 * (int64_t)t, kept + count, span + count);
    }
    if (t < end) {
        int32_t index[24];
        for (int32_t k = 0; k < 24; k++) {
            index[k] = f->tri[3 * (int64_t)(t + k / 3 < end ? t + k / 3 : t) + k % 3];
        }
        count += keep_eight(f, t, end - t, index, kept + count, span + count);
    }
    return count;
}

#endif
