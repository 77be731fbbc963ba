#include "eigen/panel.h"

#include "base/memory.h"

static const size_t cache_line = 64;

int64_t sl_panels_bytes(int64_t rows, int64_t columns, sl_precision precision)
{
    const int64_t entry = precision == SL_SINGLE ? sizeof(float) : sizeof(double);
    return (columns + SL_PANEL - 1) / SL_PANEL * SL_PANEL * rows * entry + (int64_t)cache_line;
}

sl_status sl_panels_create(int32_t rows, int32_t columns, sl_precision precision, sl_panels *out)
{
    *out = (sl_panels){.rows = rows, .columns = columns};
    out->memory = sl_calloc(sl_panels_bytes(rows, columns, precision), 1);
    if (out->memory == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    const uintptr_t skip = (uintptr_t)out->memory % cache_line;
    void *start = (char *)out->memory + (skip == 0 ? 0 : cache_line - skip);
    out->data = precision == SL_DOUBLE ? start : NULL;
    out->single = precision == SL_SINGLE ? start : NULL;
    return SL_OK;
}

void sl_panels_clear(sl_panels *panels)
{
    sl_free(panels->memory);
    *panels = (sl_panels){.rows = 0};
}

sl_status sl_panels_take(sl_panels *from, int32_t columns, sl_panels *to)
{
    const sl_precision precision = from->single != NULL ? SL_SINGLE : SL_DOUBLE;
    char *start = from->single != NULL ? (char *)from->single : (char *)from->data;
    const ptrdiff_t skip = start - (char *)from->memory;
    void *memory = sl_realloc(from->memory, sl_panels_bytes(from->rows, columns, precision), 1);
    *to = (sl_panels){.rows = 0};
    if (memory == NULL) {
        sl_panels_clear(from);
        return SL_OUT_OF_MEMORY;
    }
    *to = (sl_panels){.rows = from->rows, .columns = columns, .memory = memory};
    void *data = (char *)memory + skip;
    to->data = precision == SL_DOUBLE ? data : NULL;
    to->single = precision == SL_SINGLE ? data : NULL;
    *from = (sl_panels){.rows = 0};
    return SL_OK;
}

/* Lanes of a block at column `at` that lie in the first of the two panels it may touch. */
static int32_t first_part(int32_t at, int32_t w)
{
    const int32_t room = SL_PANEL - at % SL_PANEL;
    return room < w ? room : w;
}

/* The lanes from `at` on of one panel, part of which are W's from `from` on. */
static void store_lanes(sl_panels *M, int32_t panel, int32_t at, const double *W, int32_t w, int32_t from, int32_t part)
{
    const int64_t skip = (int64_t)panel * M->rows * SL_PANEL + at;
    for (int64_t r = 0; r < M->rows && M->single == NULL; r++) {
        for (int32_t c = 0; c < part; c++) {
            M->data[skip + r * SL_PANEL + c] = W[r * w + from + c];
        }
    }
    for (int64_t r = 0; r < M->rows && M->single != NULL; r++) {
        for (int32_t c = 0; c < part; c++) {
            M->single[skip + r * SL_PANEL + c] = (float)W[r * w + from + c];
        }
    }
}

static void load_lanes(const sl_panels *M, int32_t panel, int32_t at, double *W, int32_t w, int32_t from, int32_t part)
{
    const int64_t skip = (int64_t)panel * M->rows * SL_PANEL + at;
    for (int64_t r = 0; r < M->rows && M->single == NULL; r++) {
        for (int32_t c = 0; c < part; c++) {
            W[r * w + from + c] = M->data[skip + r * SL_PANEL + c];
        }
    }
    for (int64_t r = 0; r < M->rows && M->single != NULL; r++) {
        for (int32_t c = 0; c < part; c++) {
            W[r * w + from + c] = (double)M->single[skip + r * SL_PANEL + c];
        }
    }
}

void sl_panels_store(sl_panels *M, int32_t at, const double *W, int32_t w)
{
    const int32_t part = first_part(at, w), panel = at / SL_PANEL;
    store_lanes(M, panel, at % SL_PANEL, W, w, 0, part);
    if (part < w) {
        store_lanes(M, panel + 1, 0, W, w, part, w - part);
    }
}

void sl_panels_load(const sl_panels *M, int32_t at, double *W, int32_t w)
{
    const int32_t part = first_part(at, w), panel = at / SL_PANEL;
    load_lanes(M, panel, at % SL_PANEL, W, w, 0, part);
    if (part < w) {
        load_lanes(M, panel + 1, 0, W, w, part, w - part);
    }
}
