/* Colours of a band, tile by tile: the triangles seen in a tile are prepared eight at a time, then its pixels are
 * coloured eight at a time. Included by the kernels, in lanes.
 * Layer: render, private. */
#ifndef SL_RENDER_FRAME_KERNEL_SHADE_H
#define SL_RENDER_FRAME_KERNEL_SHADE_H

#include "render/frame_internal.h"
#include "render/frame_kernel_paint.h"

#include <string.h>

/* Number of a triangle by its place in the band's list; new ones are asked for from memory. The frame's slots may hold
 * anything: one counts only when the list agrees. Source: Briggs and Torczon 1993, "An efficient representation for
 * sparse sets". */
static inline int32_t number_of(const sl_frame *f, int64_t band_first, int32_t place, frame_tile *tile)
{
    if (place < 0) {
        return 0;
    }
    int32_t *slot = f->slot + band_first + place, number = *slot;
    if ((uint32_t)number >= (uint32_t)tile->count || tile->listed[number] != place) {
        const int64_t t = f->banded[band_first + place];
        number = tile->count++;
        tile->listed[number] = place;
        *slot = number;
        __builtin_prefetch(f->tri + 3 * t);
        __builtin_prefetch(f->color + t);
        if (f->uv != NULL) {
            __builtin_prefetch(f->uv + 6 * t);
        }
    }
    return number;
}

LANES_CALL void list_triangles(const sl_frame *f, int32_t band, frame_tile *tile)
{
    const int64_t first = f->band_first[band];
    tile->count = 1;
    tile->listed[0] = -1;
    for (int32_t y = tile->y; y < tile->y_end; y++) {
        const int32_t *seen = f->seen + (int64_t)y * f->stride + tile->x;
        int32_t *number = tile->number[y - tile->y];
        for (int32_t x = 0; x < tile->columns; x += 8) {
            if (i8_signs(i8_equal(i8_load(seen + x), i8_all(seen[x]))) == 0xff) {
                i8_store(number + x, i8_all(number_of(f, first, seen[x], tile)));
                continue;
            }
            for (int32_t k = x; k < x + 8; k++) {
                number[k] = number_of(f, first, seen[k], tile);
            }
        }
    }
}

LANES_CALL f8 plane_at(const f8 plane[3], f8 dx, f8 dy)
{
    return f8_add(plane[0], f8_add(f8_mul(plane[1], dx), f8_mul(plane[2], dy)));
}

/* Integral of the square wave that is +1 on [0, 1), -1 on [1, 2): the distance to the nearest even number, found by
 * letting the addition round (|x| below 2^22). */
LANES_CALL f8 wave(f8 x)
{
    const f8 whole = f8_all(check_rounding);
    const f8 nearest = f8_sub(f8_add(f8_mul(f8_all(0.5f), x), whole), whole);
    return f8_abs(f8_sub(x, f8_add(nearest, nearest)));
}

LANES_CALL f8 wave_change(f8 at, f8 half)
{
    return f8_sub(wave(f8_add(at, half)), wave(f8_sub(at, half)));
}

/* The paints of eight pixels, turned into lanes. */
LANES_CALL void load_paints(const frame_tile *tile, const int32_t *number, paint8 *p)
{
    int64_t at[8];
    i8 word[4];
    for (int k = 0; k < 8; k++) {
        at[k] = (int64_t)sizeof tile->paint[0] * number[k];
    }
    for (int i = 0; i < PAINT_WORDS; i += 4) {
        four_words((const char *)tile->paint + sizeof word[0] / 8 * (size_t)i, at, word);
        for (int k = 0; k < 4; k++) {
            p->word[i + k] = i8_bits(word[k]);
        }
    }
}

/* One triangle over all eight. */
LANES_CALL void spread_paint(const frame_tile *tile, int32_t number, paint8 *p)
{
    for (int i = 0; i < PAINT_WORDS; i++) {
        p->word[i] = f8_all(tile->paint[number][i]);
    }
}

LANES_CALL i8 shade_eight(const paint8 *p, f8 dx, f8 dy)
{
    const f8 one = f8_all(1.0f), depth = f8_div(one, plane_at(p->word + PAINT_WEIGHT, dx, dy));
    const f8 u = f8_mul(depth, plane_at(p->word + PAINT_U, dx, dy));
    const f8 v = f8_mul(depth, plane_at(p->word + PAINT_V, dx, dy));
    const f8 changes = f8_mul(wave_change(u, p->word[PAINT_HALF_U]), wave_change(v, p->word[PAINT_HALF_V]));
    const f8 mean = f8_max(f8_min(f8_mul(changes, p->word[PAINT_SCALE]), one), f8_all(-1.0f));
    const f8 check = f8_add(f8_all(check_middle), f8_mul(f8_all(check_half), mean));
    const f8 light = f8_mul(f8_mul(depth, plane_at(p->word + PAINT_LIGHT, dx, dy)), check);
    const f8 d = f8_sub(f8_root(f8_min(f8_max(light, f8_all(0.0f)), one)), one);
    const f8 cubic = f8_add(f8_all(power_2), f8_mul(d, f8_all(power_3)));
    const f8 power = f8_add(one, f8_mul(d, f8_add(f8_all(power_1), f8_mul(d, cubic))));
    const i8 fixed = i8_min(f8_whole(f8_mul(power, f8_all(65536.0f))), i8_all(65535));
    return i8_tint(f8_bits(p->word[PAINT_COLOR]), fixed);
}

LANES_CALL void put_pixels(i8 color, int32_t count, uint8_t *out)
{
    int32_t pixel[8];
    i8_store(pixel, color);
    if (count >= 8) {
        memcpy(out, pixel, sizeof pixel);
    } else {
        memcpy(out, pixel, (size_t)count * sizeof pixel[0]);
    }
}

LANES_CALL void shade_tile(const sl_frame *f, const frame_tile *tile, uint8_t *rgba)
{
    const i8 sheet = f8_bits(f8_all(tile->paint[0][PAINT_COLOR]));
    const f8 lane = i8_float(i8_load(lane_number));
    for (int32_t y = tile->y; y < tile->y_end; y++) {
        const int32_t *number = tile->number[y - tile->y];
        const f8 dy = f8_all((float)(y - tile->y - TILE_MIDDLE));
        for (int32_t x = 0; x < tile->columns; x += 8) {
            const i8 eight = i8_load(number + x), alike = i8_equal(eight, i8_all(number[x]));
            const bool same = i8_signs(alike) == 0xff;
            i8 color = sheet;
            if (!same || number[x] != 0) {
                paint8 p;
                if (same) {
                    spread_paint(tile, number[x], &p);
                } else {
                    load_paints(tile, number + x, &p);
                }
                color = shade_eight(&p, f8_add(f8_all((float)(x - TILE_MIDDLE)), lane), dy);
            }
            const int32_t left = f->width - tile->x - x;
            put_pixels(color, left, rgba + 4 * ((int64_t)y * f->width + tile->x + x));
        }
    }
}

/* Over them, the pixels of triangles with a corner off the picture. */
static inline void shade_odd(const sl_frame *f, int32_t band, const frame_tile *tile, uint8_t *rgba)
{
    for (int32_t y = tile->y; y < tile->y_end; y++) {
        for (int32_t x = 0; x < tile->columns && tile->x + x < f->width; x++) {
            const int32_t number = tile->number[y - tile->y][x];
            const int32_t t = number > 0 ? f->banded[f->band_first[band] + tile->listed[number]] : -1;
            if (t >= 0 && sl_frame_is_off(f, t)) {
                const uint32_t color = sl_frame_look_odd(f, t, tile->x + x, y);
                memcpy(rgba + 4 * ((int64_t)y * f->width + tile->x + x), &color, sizeof color);
            }
        }
    }
}

LANES_TARGET static void shade(const sl_frame *f, int32_t band, int32_t row, int32_t row_end, uint8_t *rgba)
{
    frame_tile tile;
    tile.y = row;
    tile.y_end = row_end;
    for (int32_t x = 0; x < f->width; x += TILE) {
        tile.x = x;
        tile.columns = f->width - x < TILE ? (f->width - x + 7) & ~7 : TILE;
        list_triangles(f, band, &tile);
        const bool odd = paint_triangles(f, band, &tile);
        shade_tile(f, &tile, rgba);
        if (odd) {
            shade_odd(f, band, &tile, rgba);
        }
    }
}

#endif
