/* Scan conversion of one triangle under the fill rule of coverage.h, in integers.
 * Layer: overlap. Private. */
#ifndef SL_OVERLAP_RASTER_INTERNAL_H
#define SL_OVERLAP_RASTER_INTERNAL_H

#include "base/status.h"

enum {
    SL_RASTER_SUBPIXEL = 256,     /* positions are multiples of 1/256 texel */
    SL_RASTER_MAX_SIZE = 1 << 15, /* texels a side: positions stay below 2^38 */
    SL_RASTER_MAX_COORDINATE = 1 << 14,
};

/* Corners on the sub-pixel lattice, counter-clockwise in array space after sl_raster_snap. */
typedef struct sl_raster_triangle {
    int64_t x[3], y[3];
} sl_raster_triangle;

/* One slanted edge: the span limit floor(numerator / divisor) of the current row, and its step. */
typedef struct sl_raster_edge {
    int64_t limit, rest;           /* numerator = limit * divisor + rest, 0 <= rest < divisor */
    int64_t limit_step, rest_step; /* likewise for one row */
    int64_t divisor;
} sl_raster_edge;

/* The spans of a triangle in a window, row by row. */
typedef struct sl_raster_walk {
    sl_raster_edge right[2], left[2]; /* texels are inside up to right.limit and from left.limit + 1 on */
    int32_t right_count, left_count;
    int32_t row, row_end; /* rows still to come */
    int32_t width;
} sl_raster_walk;

/* Lattice position of the coordinate u in a window `size` texels wide. |u| <= SL_RASTER_MAX_COORDINATE. */
int64_t sl_raster_snap(double u, int32_t size);

/* True if all corners are finite and in range: only then the other functions may be called. */
bool sl_raster_in_range(const double *uv, const int32_t tri[3]);

/* Snaps and orients a triangle. False if it has no area left. */
bool sl_raster_triangle_set(const double *uv, const int32_t tri[3], int32_t width, int32_t height,
                            sl_raster_triangle *out);

/* Rows [*begin, *end) of the window in which the triangle may have texels. */
void sl_raster_rows(const sl_raster_triangle *triangle, int32_t height, int32_t *begin, int32_t *end);

/* Starts a walk over the rows [row_begin, row_end) of a window `width` texels wide, in which the triangle has area. */
void sl_raster_walk_start(const sl_raster_triangle *triangle, int32_t width, int32_t row_begin, int32_t row_end,
                          sl_raster_walk *walk);

/* The span [*begin, *end) of the next row, perhaps empty (*begin >= *end), and the row. False after the last. */
bool sl_raster_walk_next(sl_raster_walk *walk, int32_t *row, int32_t *begin, int32_t *end);

#endif
