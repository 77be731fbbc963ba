/* What the pixels of a triangle have in common, as sixteen numbers. Included by the kernels, in lanes.
 * Layer: render, private. */
#ifndef SL_RENDER_FRAME_KERNEL_PAINT_H
#define SL_RENDER_FRAME_KERNEL_PAINT_H

#include "render/frame_kernel_corners.h"
#include "render/frame_light.h"

/* Planes are c + dx (x - middle) + dy (y - middle) over the tile. Numbers over depth are linear on the picture. Source:
 * Heckbert and Moreton 1991, "Interpolation for polygon texture mapping and shading". */
enum {
    TILE = 32, /* columns, and rows of a band */
    TILE_MIDDLE = 16,
    PAINT_WEIGHT = 0, /* planes */
    PAINT_LIGHT = 3,
    PAINT_U = 6,
    PAINT_V = 9,
    PAINT_HALF_U = 12, /* the filter: half its width in squares, */
    PAINT_HALF_V = 13,
    PAINT_SCALE = 14, /* 1 / its area; 0 = the mean */
    PAINT_COLOR = 15, /* bytes */
    PAINT_WORDS = 16,
};

typedef struct frame_tile {
    int32_t x, columns, y, y_end; /* columns: a multiple of 8 */
    int32_t count;                /* of triangles; number 0 is the background */
    int32_t listed[1 + TILE * TILE];
    int32_t number[TILE][TILE];
    float paint[1 + TILE * TILE + 8][PAINT_WORDS];
} frame_tile;

_Static_assert((int)TILE >= (int)SL_FRAME_BAND, "a tile holds a band's rows");

typedef struct paint8 {
    f8 word[PAINT_WORDS];
} paint8;

/* Eight triangles and how sums over their edges become slopes on the picture. */
typedef struct slope8 {
    f8 b[2], c[2]; /* change per pixel across and down = (value1 - value0) b + (value2 - value0) c */
    f8 dx, dy;     /* from corner 0 to the middle of the tile, pixels */
    f8 weight[3];
    f8 cosine[3];
    i8 back, off; /* masks; off: a corner is not on the picture */
} slope8;

LANES_CALL void load_slopes(const sl_frame *f, const frame_tile *tile, const int32_t *index, slope8 *s)
{
    i8 x[3], y[3];
    s->off = i8_all(0);
    for (int k = 0; k < 3; k++) {
        int64_t at[8];
        i8 word[4];
        for (int lane = 0; lane < 8; lane++) {
            at[lane] = (int64_t)sizeof *f->vertex * index[3 * lane + k];
        }
        four_words((const char *)f->vertex + offsetof(sl_frame_vertex, x), at, word);
        x[k] = word[0];
        y[k] = word[1];
        s->off = i8_or(s->off, i8_equal(x[k], i8_all(SL_FRAME_FAR)));
        s->weight[k] = i8_bits(word[2]);
        s->cosine[k] = i8_bits(word[3]);
    }
    const i8 ibx = i8_sub(x[1], x[0]), iby = i8_sub(y[1], y[0]), icx = i8_sub(x[2], x[0]), icy = i8_sub(y[2], y[0]);
    const i8 wide = i8_or(i8_sub(most3(x), least3(x)), i8_sub(most3(y), least3(y)));
    const f8 bx = i8_float(ibx), by = i8_float(iby), cx = i8_float(icx), cy = i8_float(icy);
    const f8 exact = i8_float(i8_sub(i8_mul(ibx, icy), i8_mul(icx, iby)));
    const f8 rounded = f8_sub(f8_mul(bx, cy), f8_mul(cx, by)); /* where 32 bits do not suffice */
    const f8 area = f8_select(i8_less(wide, i8_all(SL_FRAME_SMALL)), exact, rounded);
    const f8 scale = f8_div(f8_all((float)SL_SUBPIXELS), area), zero = f8_all(0.0f),
             pixel = f8_all(1.0f / SL_SUBPIXELS);
    s->b[0] = f8_mul(cy, scale);
    s->b[1] = f8_sub(zero, f8_mul(cx, scale));
    s->c[0] = f8_sub(zero, f8_mul(by, scale));
    s->c[1] = f8_mul(bx, scale);
    s->dx = f8_mul(i8_float(i8_sub(i8_all(SL_SUBPIXELS * (tile->x + TILE_MIDDLE)), x[0])), pixel);
    s->dy = f8_mul(i8_float(i8_sub(i8_all(SL_SUBPIXELS * (tile->y + TILE_MIDDLE)), y[0])), pixel);
    s->back = f8_less(zero, area);
}

/* The plane of three values over depth. */
LANES_CALL void set_plane(const slope8 *s, const f8 value[3], f8 plane[3])
{
    const f8 a = f8_mul(value[0], s->weight[0]);
    const f8 p = f8_sub(f8_mul(value[1], s->weight[1]), a), q = f8_sub(f8_mul(value[2], s->weight[2]), a);
    plane[1] = f8_add(f8_mul(p, s->b[0]), f8_mul(q, s->c[0]));
    plane[2] = f8_add(f8_mul(p, s->b[1]), f8_mul(q, s->c[1]));
    plane[0] = f8_add(a, f8_add(f8_mul(plane[1], s->dx), f8_mul(plane[2], s->dy)));
}

/* The filter of one direction: how far its UV runs over a pixel, by the gradient at the middle of the triangle. */
LANES_CALL f8 filter_width(const slope8 *s, const f8 value[3])
{
    const f8 p = f8_sub(value[1], value[0]), q = f8_sub(value[2], value[0]);
    const f8 across = f8_abs(f8_add(f8_mul(p, s->b[0]), f8_mul(q, s->c[0])));
    const f8 down = f8_abs(f8_add(f8_mul(p, s->b[1]), f8_mul(q, s->c[1])));
    return f8_max(f8_max(across, down), f8_all(check_least));
}

LANES_CALL f8 surface_light(const slope8 *s, int k)
{
    const f8 zero = f8_all(0.0f);
    const f8 cosine = f8_select(s->back, f8_sub(zero, s->cosine[k]), s->cosine[k]);
    const f8 toward = f8_add(f8_all(light_wrap), f8_mul(f8_all(1.0f - light_wrap), cosine));
    const f8 light = f8_add(f8_all(light_ambient), f8_mul(f8_all(light_direct), f8_max(toward, zero)));
    return f8_select(s->back, f8_mul(f8_all(light_behind), light), light);
}

/* UVs of the corners in squares. Returns a mask: is there a checkerboard? */
LANES_CALL i8 load_checks(const sl_frame *f, const int32_t *triangle, f8 u[3], f8 v[3])
{
    int64_t at[8];
    i8 ab[4], bc[4];
    const f8 scale = f8_all((float)f->style.checks), farthest = f8_all(check_farthest);
    i8 usable = i8_all(-1);
    for (int lane = 0; lane < 8; lane++) {
        at[lane] = 6 * (int64_t)sizeof *f->uv * triangle[lane];
    }
    four_words((const char *)f->uv, at, ab);
    four_words((const char *)f->uv + 2 * sizeof *f->uv, at, bc);
    const i8 word[6] = {ab[0], ab[1], bc[0], bc[1], bc[2], bc[3]};
    for (int k = 0; k < 3; k++) {
        u[k] = f8_mul(scale, i8_bits(word[2 * k]));
        v[k] = f8_mul(scale, i8_bits(word[2 * k + 1]));
        usable = i8_and(usable, i8_and(f8_less(f8_abs(u[k]), farthest), f8_less(f8_abs(v[k]), farthest)));
    }
    return usable;
}

/* Without a checkerboard its mean stays 0, and light makes up for the middle. */
LANES_CALL void set_checks(const sl_frame *f, const int32_t *triangle, const slope8 *s, paint8 *p)
{
    f8 u[3], v[3];
    const f8 zero = f8_all(0.0f), widest = f8_all(check_widest), half = f8_all(0.5f);
    const i8 usable = load_checks(f, triangle, u, v);
    for (int k = 0; k < 3; k++) {
        u[k] = f8_select(usable, u[k], zero);
        v[k] = f8_select(usable, v[k], zero);
    }
    set_plane(s, u, p->word + PAINT_U);
    set_plane(s, v, p->word + PAINT_V);
    const f8 width = filter_width(s, u), height = filter_width(s, v);
    const i8 filtered = i8_and(usable, i8_and(f8_less(width, widest), f8_less(height, widest)));
    p->word[PAINT_HALF_U] = f8_mul(half, width);
    p->word[PAINT_HALF_V] = f8_mul(half, height);
    p->word[PAINT_SCALE] = f8_select(filtered, f8_div(f8_all(1.0f), f8_mul(width, height)), zero);
    const f8 make_up = f8_select(usable, f8_all(1.0f), f8_all(1.0f / check_middle));
    for (int k = 0; k < 3; k++) {
        p->word[PAINT_LIGHT + k] = f8_mul(p->word[PAINT_LIGHT + k], make_up);
    }
}

LANES_CALL void set_no_checks(paint8 *p)
{
    for (int k = PAINT_U; k <= PAINT_SCALE; k++) {
        p->word[k] = f8_all(0.0f);
    }
    for (int k = 0; k < 3; k++) {
        p->word[PAINT_LIGHT + k] = f8_mul(p->word[PAINT_LIGHT + k], f8_all(1.0f / check_middle));
    }
}

LANES_CALL void set_lights(const sl_frame *f, const int32_t *triangle, slope8 *s, paint8 *p)
{
    f8 light[3];
    if (f->style.flat) {
        float cosine[8];
        for (int lane = 0; lane < 8; lane++) {
            cosine[lane] = sl_frame_facet_cosine(f, triangle[lane]);
        }
        s->cosine[0] = s->cosine[1] = s->cosine[2] = f8_load(cosine);
    }
    for (int k = 0; k < 3; k++) {
        light[k] = f->style.lit ? surface_light(s, k) : f8_all(1.0f);
    }
    set_plane(s, light, p->word + PAINT_LIGHT);
}

/* Returns a mask of those with a corner off the picture. */
LANES_CALL i8 paint_eight(const sl_frame *f, const frame_tile *tile, const int32_t triangle[8],
                          float (*out)[PAINT_WORDS])
{
    int32_t index[24], color[8];
    slope8 s;
    paint8 p;
    const f8 one[3] = {f8_all(1.0f), f8_all(1.0f), f8_all(1.0f)};
    for (int k = 0; k < 8; k++) {
        const int32_t *tri = f->tri + 3 * (int64_t)triangle[k];
        index[3 * k] = tri[0];
        index[3 * k + 1] = tri[1];
        index[3 * k + 2] = tri[2];
        color[k] = (int32_t)f->color[triangle[k]];
    }
    load_slopes(f, tile, index, &s);
    set_plane(&s, one, p.word + PAINT_WEIGHT);
    set_lights(f, triangle, &s, &p);
    if (f->uv != NULL && f->style.checks > 0.0) {
        set_checks(f, triangle, &s, &p);
    } else {
        set_no_checks(&p);
    }
    p.word[PAINT_COLOR] = i8_bits(i8_load(color));
    for (int i = 0; i < PAINT_WORDS; i += 4) {
        put_four_words((char *)out + sizeof(float) * (size_t)i, sizeof out[0], p.word + i);
    }
    return s.off;
}

/* Prepares the tile's triangles. True: one of them has a corner off the picture. */
LANES_CALL bool paint_triangles(const sl_frame *f, int32_t band, frame_tile *tile)
{
    const int32_t *banded = f->banded != NULL ? f->banded + f->band_first[band] : NULL;
    const uint8_t sheet[4] = {f->style.background[0], f->style.background[1], f->style.background[2], 255};
    uint32_t odd = 0;
    for (int32_t i = 1; i < tile->count; i += 8) {
        int32_t triangle[8];
        for (int32_t k = 0; k < 8; k++) {
            triangle[k] = banded[tile->listed[i + k < tile->count ? i + k : i]];
        }
        odd |= i8_signs(paint_eight(f, tile, triangle, tile->paint + i));
    }
    float *background = tile->paint[0];
    memset(background, 0, sizeof tile->paint[0]);
    background[PAINT_WEIGHT] = 1.0f;
    background[PAINT_LIGHT] = 1.0f / check_middle;
    memcpy(&background[PAINT_COLOR], sheet, sizeof sheet);
    return odd != 0;
}

#endif
