#include "overlap/edge_raster_internal.h"

#include "base/memory.h"
#include "overlap/raster_internal.h"

#include <string.h>

enum { SORTED_EVENTS = 48 }; /* rows with more are summed texel by texel */

/* First row whose centre is not below the lattice coordinate y. */
static int32_t row_at(int32_t y)
{
    return (y + SL_RASTER_SUBPIXEL - 1) >> 8; /* floor, also of negative numbers */
}

static int32_t limit(int32_t x, int32_t low, int32_t high)
{
    return x < low ? low : x > high ? high : x;
}

void sl_edge_rows(const sl_lattice_edge *edge, int32_t height, int32_t *begin, int32_t *end)
{
    const int32_t up = edge->y[0] < edge->y[1];
    *begin = limit(row_at(edge->y[1 - up]), 0, height);
    *end = limit(row_at(edge->y[up]), 0, height);
}

static int64_t floor_divide(int64_t a, int64_t b)
{
    const int64_t q = a / b;
    return q - (a % b < 0);
}

/* Appends the edge's event in each of the rows [begin, end), which lie between its ends: the first column whose centre
 * is not left of the edge, ceil(x / 256) for the rational x where the edge is at the height of the row's centres. */
static void walk_edge(const sl_lattice_edge *edge, int32_t begin, int32_t end, int32_t width, uint32_t **slot)
{
    const int up = edge->y[0] < edge->y[1];
    const int64_t x = edge->x[1 - up], y = edge->y[1 - up], dx = edge->x[up] - x, dy = edge->y[up] - y;
    const int64_t divisor = SL_RASTER_SUBPIXEL * dy;
    const int64_t numerator = x * dy + dx * (SL_RASTER_SUBPIXEL * (int64_t)begin - y) + divisor - 1;
    int64_t column = floor_divide(numerator, divisor);
    if (end - begin == 1) {
        const int64_t c = column < 0 ? 0 : column > width ? width : column;
        *(*slot)++ = (uint32_t)(2 * c + !up);
        return;
    }
    int64_t rest = numerator - column * divisor;
    const int64_t step = floor_divide(dx, dy), rest_step = SL_RASTER_SUBPIXEL * (dx - step * dy);
    for (int32_t k = 0; k < end - begin; k++) {
        const int64_t c = column < 0 ? 0 : column > width ? width : column;
        *slot[k]++ = (uint32_t)(2 * c + !up);
        rest += rest_step;
        column += step + (rest >= divisor);
        rest -= rest >= divisor ? divisor : 0;
    }
}

static void sort_events(uint32_t *event, int64_t n)
{
    for (int64_t i = 1; i < n; i++) {
        const uint32_t e = event[i];
        int64_t k = i;
        for (; k > 0 && event[k - 1] > e; k--) {
            event[k] = event[k - 1];
        }
        event[k] = e;
    }
}

static void fill_run(const sl_edge_raster *raster, int32_t row, int32_t begin, int32_t end, int32_t count)
{
    const int64_t first = (int64_t)row * raster->width + begin;
    if (raster->count8 != NULL) {
        memset(raster->count8 + first, count < UINT8_MAX ? count : UINT8_MAX, (size_t)(end - begin));
        return;
    }
    const uint16_t value = (uint16_t)(count < UINT16_MAX ? count : UINT16_MAX);
    for (int32_t x = 0; x < end - begin; x++) {
        raster->count16[first + x] = value;
    }
}

/* A row of few events: sorted, with runs of equal count between them. */
static void fill_sparse_row(const sl_edge_raster *raster, int32_t row, uint32_t *event, int64_t n)
{
    int32_t *sums = raster->row_sums + 2 * (int64_t)row, count = 0, x = 0;
    sort_events(event, n);
    sums[0] = sums[1] = 0;
    for (int64_t k = 0; k <= n && x < raster->width; k++) {
        const int32_t next = k < n ? (int32_t)(event[k] >> 1) : raster->width;
        if (next > x) {
            fill_run(raster, row, x, next, count);
            sums[0] += count > 0 ? next - x : 0;
            sums[1] += count > 1 ? next - x : 0;
            x = next;
        }
        count += k < n ? 1 - 2 * (int32_t)(event[k] & 1) : 0;
    }
}

static void fill_dense_row(const sl_edge_raster *raster, int32_t row, const uint32_t *event, int64_t n)
{
    const int32_t band = row / SL_EDGE_BAND_ROWS, width = raster->width;
    int32_t *difference = raster->difference + band * ((int64_t)width + SL_KERNEL_PAD);
    uint16_t *sum =
        raster->count16 != NULL ? raster->count16 + (int64_t)row * width : raster->scratch + (int64_t)band * width;
    for (int64_t k = 0; k < n; k++) {
        difference[event[k] >> 1] += 1 - 2 * (int32_t)(event[k] & 1);
    }
    raster->kernels.prefix(width, difference, sum, raster->row_sums + 2 * (int64_t)row);
    if (raster->count8 != NULL) {
        uint8_t *count = raster->count8 + (int64_t)row * width;
        for (int32_t x = 0; x < width; x++) {
            count[x] = (uint8_t)(sum[x] < UINT8_MAX ? sum[x] : UINT8_MAX);
        }
    }
}

/* Events of the rows [low, high) of one band, row after row: slot[k] is moved to the end of row low + k's. */
static void list_events(const sl_edge_raster *raster, int32_t band, int32_t low, int32_t high, uint32_t **slot)
{
    int64_t count[SL_EDGE_BAND_ROWS + 1] = {0};
    const int64_t first = raster->band_first[band], last = raster->band_first[band + 1];
    for (int64_t k = first; k < last; k++) {
        int32_t begin, end;
        sl_edge_rows(&raster->banded[k], raster->height, &begin, &end);
        count[limit(begin, low, high) - low]++;
        count[limit(end, low, high) - low]--;
    }
    uint32_t *next = raster->event + raster->event_first[band];
    int64_t crossing = 0;
    for (int32_t k = 0; k < high - low; k++) {
        crossing += count[k];
        slot[k] = next;
        next += crossing;
    }
    for (int64_t k = first; k < last; k++) {
        int32_t begin, end;
        sl_edge_rows(&raster->banded[k], raster->height, &begin, &end);
        begin = limit(begin, low, high);
        walk_edge(&raster->banded[k], begin, limit(end, low, high), raster->width, slot + (begin - low));
    }
}

static void fill_band(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    (void)chunk;
    const sl_edge_raster *raster = user;
    for (int32_t band = (int32_t)begin; band < end; band++) {
        uint32_t *slot[SL_EDGE_BAND_ROWS], *event = raster->event + raster->event_first[band];
        const int32_t low = band * SL_EDGE_BAND_ROWS;
        const int32_t high = low + SL_EDGE_BAND_ROWS < raster->height ? low + SL_EDGE_BAND_ROWS : raster->height;
        list_events(raster, band, low, high, slot);
        for (int32_t row = low; row < high; row++) {
            const int64_t n = slot[row - low] - event;
            if (raster->dirty[row] && n <= SORTED_EVENTS) {
                fill_sparse_row(raster, row, event, n);
            } else if (raster->dirty[row]) {
                fill_dense_row(raster, row, event, n);
            }
            event += n;
        }
    }
}

/* Bands of the edge with dirty rows: [*begin, *end), perhaps with clean ones between. */
static void edge_bands(const sl_edge_raster *raster, const sl_lattice_edge *edge, int32_t *begin, int32_t *end)
{
    int32_t first, last;
    sl_edge_rows(edge, raster->height, &first, &last);
    *begin = first / SL_EDGE_BAND_ROWS;
    *end = first < last ? (last - 1) / SL_EDGE_BAND_ROWS + 1 : *begin;
}

static bool band_is_dirty(const sl_edge_raster *raster, int32_t band)
{
    const int32_t low = band * SL_EDGE_BAND_ROWS;
    const int32_t rows = low + SL_EDGE_BAND_ROWS < raster->height ? SL_EDGE_BAND_ROWS : raster->height - low;
    return memchr(raster->dirty + low, 1, (size_t)rows) != NULL;
}

/* Counting sort of the edges into the dirty bands. The others stay empty. */
static sl_status sort_into_bands(sl_edge_raster *raster, const uint8_t *dirty_band)
{
    int64_t *first = raster->band_first, *events = raster->event_first;
    sl_status status = SL_OK;
    memset(first, 0, ((size_t)raster->bands + 1) * sizeof *first);
    memset(events, 0, ((size_t)raster->bands + 1) * sizeof *events);
    for (int64_t e = 0; e < raster->edges; e++) {
        int32_t begin, end, row_begin, row_end;
        edge_bands(raster, &raster->edge[e], &begin, &end);
        sl_edge_rows(&raster->edge[e], raster->height, &row_begin, &row_end);
        for (int32_t b = begin; b < end; b++) {
            const int32_t low = b * SL_EDGE_BAND_ROWS, high = low + SL_EDGE_BAND_ROWS;
            first[b + 1] += dirty_band[b];
            events[b + 1] += dirty_band[b] ? limit(row_end, low, high) - limit(row_begin, low, high) : 0;
        }
    }
    for (int32_t b = 0; b < raster->bands; b++) {
        first[b + 1] += first[b];
        events[b + 1] += events[b];
    }
    SL_TRY(
        sl_reserve((void **)&raster->banded, &raster->banded_capacity, first[raster->bands], sizeof(sl_lattice_edge)));
    SL_TRY(sl_reserve((void **)&raster->event, &raster->event_capacity, events[raster->bands] + 1, sizeof(uint32_t)));
    for (int64_t e = 0; e < raster->edges; e++) {
        int32_t begin, end;
        edge_bands(raster, &raster->edge[e], &begin, &end);
        for (int32_t b = begin; b < end; b++) {
            if (dirty_band[b]) {
                raster->banded[first[b]++] = raster->edge[e];
            }
        }
    }
    for (int32_t b = raster->bands; b > 0; b--) { /* each start has moved on to its end */
        first[b] = first[b - 1];
    }
    first[0] = 0;
cleanup:
    return status;
}

sl_status sl_edge_raster_fill(sl_edge_raster *raster, const sl_context *context)
{
    uint8_t dirty_band[SL_RASTER_MAX_SIZE / SL_EDGE_BAND_ROWS];
    for (int32_t b = 0; b < raster->bands; b++) {
        dirty_band[b] = band_is_dirty(raster, b);
    }
    const sl_status status = sort_into_bands(raster, dirty_band);
    if (status == SL_OK) {
        sl_parallel_for(context, raster->bands, 1, fill_band, raster);
        memset(raster->dirty, 0, (size_t)raster->height);
    }
    return status;
}
