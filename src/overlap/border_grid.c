#include "overlap/border_grid_internal.h"

#include "base/memory.h"

#include <math.h>

static const double cells_per_axis = 0x1p20; /* at most: the padding below relies on it */
static const double padding = 0x1p-20;       /* in cells; rounding in cell coordinates stays below 2^-30 */

/* Where the grid lies: cell (floor(x'), floor(y')) of x' = (x - low) * scale. */
typedef struct grid_frame {
    double low[2], scale;
} grid_frame;

static const double *segment_end(const double *point, const int32_t *pair, int32_t s, int k)
{
    return point + 2 * (int64_t)pair[2 * (int64_t)s + k];
}

static grid_frame fit_frame(const double *point, int32_t segments, const int32_t *pair)
{
    grid_frame frame = {{HUGE_VAL, HUGE_VAL}, 0.0};
    double high[2] = {-HUGE_VAL, -HUGE_VAL};
    for (int32_t s = 0; s < segments; s++) {
        for (int k = 0; k < 4; k++) {
            const double x = segment_end(point, pair, s, k / 2)[k % 2];
            frame.low[k % 2] = fmin(frame.low[k % 2], x);
            high[k % 2] = fmax(high[k % 2], x);
        }
    }
    const double extent = fmax(high[0] - frame.low[0], high[1] - frame.low[1]);
    double mean = 0.0; /* of the lengths in parts of the extent: no overflow */
    for (int32_t s = 0; s < segments; s++) {
        const double *a = segment_end(point, pair, s, 0), *b = segment_end(point, pair, s, 1);
        mean += hypot((b[0] - a[0]) / extent, (b[1] - a[1]) / extent) / segments;
    }
    const double scale = fmin(cells_per_axis, 1.0 / mean) / extent;
    frame.scale = extent > 0.0 && isfinite(scale) ? scale : 0.0; /* no extent, or too much: one cell */
    return frame;
}

static double cell_coordinate(const grid_frame *frame, const double *p, int k)
{
    return frame->scale > 0.0 ? (p[k] - frame->low[k]) * frame->scale : 0.0;
}

/* The keys of all passed cells, segment after segment. */
typedef struct key_list {
    uint64_t *key;
    int64_t count, capacity;
} key_list;

static uint64_t cell_key(int64_t x, int64_t y)
{
    return (uint64_t)(x + 1) << 32 | (uint64_t)(y + 1); /* padding may reach column -1 */
}

/* Appends the cells from `begin` to `end` (their padded minor extent) of column `c` along the major axis. */
static sl_status append_column(key_list *list, int major, int64_t c, double begin, double end)
{
    const int64_t first = (int64_t)floor(begin - padding), last = (int64_t)floor(end + padding);
    const sl_status status =
        sl_reserve((void **)&list->key, &list->capacity, list->count + (last - first + 1), sizeof *list->key);
    if (status != SL_OK) {
        return status;
    }
    for (int64_t k = first; k <= last; k++) {
        list->key[list->count++] = major == 0 ? cell_key(c, k) : cell_key(k, c);
    }
    return SL_OK;
}

/* Appends every cell that segment ab passes or comes within the padding of. Along the longer axis the slope is 1 at
 * most, so rounding stays as small as it is in the ends. */
static sl_status append_segment(const grid_frame *frame, const double *a, const double *b, key_list *list)
{
    const double pa[2] = {cell_coordinate(frame, a, 0), cell_coordinate(frame, a, 1)};
    const double pb[2] = {cell_coordinate(frame, b, 0), cell_coordinate(frame, b, 1)};
    const int major = fabs(pb[0] - pa[0]) >= fabs(pb[1] - pa[1]) ? 0 : 1;
    const double *p = pa[major] <= pb[major] ? pa : pb, *q = p == pa ? pb : pa;
    const double x0 = p[major], x1 = q[major], y0 = p[1 - major];
    const double slope = x1 > x0 ? (q[1 - major] - y0) / (x1 - x0) : 0.0;
    const int64_t last = (int64_t)floor(x1 + padding);
    for (int64_t c = (int64_t)floor(x0 - padding); c <= last; c++) {
        const double from = fmin(fmax(x0, (double)c - padding), x1), to = fmax(fmin(x1, (double)c + 1.0 + padding), x0);
        const double y_from = y0 + slope * (from - x0), y_to = y0 + slope * (to - x0);
        const sl_status status = append_column(list, major, c, fmin(y_from, y_to), fmax(y_from, y_to));
        if (status != SL_OK) {
            return status;
        }
    }
    return SL_OK;
}

/* Cells by key: open addressing with linear probing; slot -1 = free, else the number of the cell. */
typedef struct cell_table {
    int32_t *slot;
    uint64_t *key; /* of each cell */
    uint64_t mask;
    int32_t cells;
} cell_table;

/* The number of the cell with this key, a new one if need be. The table is never more than half full. */
static int32_t cell_number(cell_table *table, uint64_t key)
{
    uint64_t k = (key * 0x9e3779b97f4a7c15u) >> 20;
    for (k &= table->mask; table->slot[k] >= 0; k = (k + 1) & table->mask) {
        if (table->key[table->slot[k]] == key) {
            return table->slot[k];
        }
    }
    table->slot[k] = table->cells;
    table->key[table->cells] = key;
    return table->cells++;
}

static sl_status number_cells(const key_list *list, sl_border_grid *grid)
{
    sl_status status = SL_OK;
    uint64_t slots = 16;
    while (slots < 2 * (uint64_t)list->count) {
        slots *= 2;
    }
    cell_table table = {sl_alloc((int64_t)slots, sizeof(int32_t)), sl_alloc(list->count, sizeof(uint64_t)), slots - 1,
                        0};
    grid->cell = sl_alloc(list->count, sizeof *grid->cell);
    if (table.slot == NULL || table.key == NULL || grid->cell == NULL || list->count > INT32_MAX) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    for (uint64_t k = 0; k < slots; k++) {
        table.slot[k] = -1;
    }
    for (int64_t k = 0; k < list->count; k++) {
        grid->cell[k] = cell_number(&table, list->key[k]);
    }
    grid->cells = table.cells;
cleanup:
    sl_free(table.key);
    sl_free(table.slot);
    return status;
}

/* The transpose: segments of each cell. */
static sl_status fill_members(sl_border_grid *grid)
{
    const int64_t entries = grid->cell_first[grid->segments];
    grid->member_first = sl_calloc((int64_t)grid->cells + 2, sizeof *grid->member_first);
    grid->member = sl_alloc(entries, sizeof *grid->member);
    if (grid->member_first == NULL || grid->member == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    int64_t *start = grid->member_first + 1; /* one behind: filling moves each start on to where it belongs */
    for (int64_t k = 0; k < entries; k++) {
        start[grid->cell[k] + 1]++;
    }
    for (int32_t c = 0; c < grid->cells; c++) {
        start[c + 1] += start[c];
    }
    for (int32_t s = 0; s < grid->segments; s++) {
        for (int64_t k = grid->cell_first[s]; k < grid->cell_first[s + 1]; k++) {
            grid->member[start[grid->cell[k]]++] = s;
        }
    }
    return SL_OK;
}

sl_status sl_border_grid_build(const double *point, int32_t segments, const int32_t *pair, sl_border_grid *grid)
{
    sl_status status = SL_OK;
    key_list list = {0};
    *grid = (sl_border_grid){.segments = segments};
    const grid_frame frame = fit_frame(point, segments, pair);
    grid->cell_first = sl_alloc((int64_t)segments + 1, sizeof *grid->cell_first);
    if (grid->cell_first == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    grid->cell_first[0] = 0;
    for (int32_t s = 0; s < segments; s++) {
        SL_TRY(append_segment(&frame, segment_end(point, pair, s, 0), segment_end(point, pair, s, 1), &list));
        grid->cell_first[s + 1] = list.count;
    }
    SL_TRY(number_cells(&list, grid));
    SL_TRY(fill_members(grid));
cleanup:
    sl_free(list.key);
    return status;
}

void sl_border_grid_clear(sl_border_grid *grid)
{
    sl_free(grid->cell_first);
    sl_free(grid->cell);
    sl_free(grid->member_first);
    sl_free(grid->member);
    *grid = (sl_border_grid){0};
}
