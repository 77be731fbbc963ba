#include "draw/visibility.h"
#include "draw/screen_internal.h"

#include <string.h>

/* Widest row that is tested sample by sample; longer ones are solved for their ends. */
enum { SHORT_ROW = 8 };

/* Edge i as a function of the sample: value = c + 256 (dy * px - dx * py) > 0 inside, with the top-left rule in c.
 * Source: Pineda 1988, "A parallel algorithm for polygon rasterization". */
typedef struct edge {
    int64_t value; /* at the first sample of the row */
    int64_t step_x, step_y;
} edge;

static int64_t floor_div(int64_t a, int64_t b)
{
    const int64_t q = a / b;
    return q * b != a && (a < 0) != (b < 0) ? q - 1 : q;
}

static void set_edges(const sl_piece *p, int32_t px, int32_t py, edge e[3])
{
    for (int i = 0; i < 3; i++) {
        const int n = (i + 1) % 3;
        const int64_t dx = (int64_t)p->x[n] - p->x[i], dy = (int64_t)p->y[n] - p->y[i];
        /* dx (y - yi) - dy (x - xi): positive on the inner side of an anticlockwise triangle (array space) */
        const int64_t c = dx * ((int64_t)SL_SUBPIXELS * py - p->y[i]) - dy * ((int64_t)SL_SUBPIXELS * px - p->x[i]);
        const bool top_left = dy < 0 || (dy == 0 && dx > 0);
        e[i] = (edge){c + (top_left ? 1 : 0), -SL_SUBPIXELS * dy, SL_SUBPIXELS * dx};
    }
}

/* Narrows [*begin, *end) to the offsets where the edge is positive. */
static void narrow(const edge *e, int64_t *begin, int64_t *end)
{
    if (e->step_x > 0) { /* value + step * i > 0  <=>  i > -value / step */
        const int64_t first = floor_div(-e->value, e->step_x) + 1;
        *begin = first > *begin ? first : *begin;
    } else if (e->step_x < 0) { /* i < value / -step, rounded up */
        const int64_t last = -floor_div(-e->value, -e->step_x);
        *end = last < *end ? last : *end;
    } else if (e->value <= 0) {
        *end = *begin;
    }
}

static uint64_t quantise(const sl_piece *p, int32_t x, int32_t y)
{
    const double plane = p->key[0] + (p->key[1] * x + p->key[2] * y);
    const double low = (double)p->least_key, high = (double)p->greatest_key;
    const double key = plane > low ? (plane < high ? plane : high) : low; /* slivers must not extrapolate */
    const double clamped = key > 0.0 ? (key < 1.0 ? key : 1.0) : 0.0;
    return (uint64_t)(clamped * 4294967294.0) << 32 | (uint64_t)(uint32_t)p->triangle;
}

static void draw_sample(const sl_piece *p, int32_t x, int32_t y, uint64_t *at)
{
    const uint64_t word = quantise(p, x, y);
    *at = word < *at ? word : *at;
}

static void draw_row(const sl_piece *p, const edge e[3], int32_t x0, int32_t x1, int32_t y, uint64_t *row)
{
    if (x1 - x0 > SHORT_ROW) {
        int64_t begin = 0, end = x1 - x0;
        for (int i = 0; i < 3; i++) {
            narrow(&e[i], &begin, &end);
        }
        for (int64_t i = begin; i < end; i++) {
            draw_sample(p, x0 + (int32_t)i, y, &row[i]);
        }
        return;
    }
    int64_t a = e[0].value, b = e[1].value, c = e[2].value;
    for (int32_t x = x0; x < x1; x++) {
        if (a > 0 && b > 0 && c > 0) {
            draw_sample(p, x, y, &row[x - x0]);
        }
        a += e[0].step_x;
        b += e[1].step_x;
        c += e[2].step_x;
    }
}

static int32_t larger(int32_t a, int32_t b)
{
    return a > b ? a : b;
}

static int32_t smaller(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

static void draw_piece(const sl_screen *s, const sl_piece *p, sl_visibility *w)
{
    int32_t x0, x1, y0, y1;
    sl_piece_columns(p, s->width, &x0, &x1);
    sl_piece_rows(p, s->height, &y0, &y1);
    x0 = larger(x0, w->x0);
    x1 = smaller(x1, w->x0 + w->width);
    y0 = larger(y0, w->y0);
    y1 = smaller(y1, w->y0 + w->height);
    if (x0 >= x1 || y0 >= y1) {
        return;
    }
    edge e[3];
    set_edges(p, x0, y0, e);
    for (int32_t y = y0; y < y1; y++) {
        draw_row(p, e, x0, x1, y, w->zid + (int64_t)(y - w->y0) * w->width + (x0 - w->x0));
        for (int i = 0; i < 3; i++) {
            e[i].value += e[i].step_y;
        }
    }
}

void sl_visibility_draw(const sl_screen *screen, sl_visibility *window)
{
    memset(window->zid, 0xff, (size_t)window->width * (size_t)window->height * sizeof *window->zid);
    const int32_t first = larger(window->y0, 0) / screen->band_rows;
    const int32_t last = smaller(window->y0 + window->height - 1, screen->height - 1) / screen->band_rows;
    for (int32_t b = first; b <= last && b < screen->bands; b++) {
        for (int64_t i = screen->band_first[b]; i < screen->band_first[b + 1]; i++) {
            draw_piece(screen, &screen->piece[screen->band_piece[i]], window);
        }
    }
}
