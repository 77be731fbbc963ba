/* Charts laid out one after another at one scale on one grid.
 * Layer: pack. */
#ifndef SL_PACK_LAYOUT_H
#define SL_PACK_LAYOUT_H

#include "pack/board.h"

/* What all layouts of one packing share. */
typedef struct sl_pack_task {
    int32_t count;
    const sl_outline *outline; /* count */
    double width, height;      /* of a page [texels] */
    double margin;             /* [texels] */
    int32_t pages;             /* at most */
    const sl_context *context;
} sl_pack_task;

/* The masks of all charts, in `turns` orientations each, at one scale on one grid. */
typedef struct sl_sheet {
    double scale;          /* [texels a UV unit] */
    double cell;           /* [texels] */
    int32_t width, height; /* of a page [cells] */
    int32_t count, turns;
    sl_mask *mask; /* count x turns */
} sl_sheet;

/* Where a chart stands. */
typedef struct sl_spot {
    int32_t page; /* -1 = nowhere */
    int32_t turn; /* which of its orientations */
    int32_t x, y;
} sl_spot;

/* How charts are laid out. */
typedef struct sl_plan {
    int32_t *order;  /* count: charts in their order; owned */
    int32_t pull;    /* which way they fall, below SL_PULLS */
    uint64_t subset; /* 0 = all orientations are tried; else a seed that leaves out every other one, by chance */
} sl_plan;

enum { SL_PULLS = 8 };

/* Pages and the work done on them. */
typedef struct sl_desk {
    int32_t pages;
    sl_board *board; /* pages */
    int64_t work;    /* words looked at, ever */
} sl_desk;

/* angle: count x turns [rad]. grid: cells along a page's width. SL_OUT_OF_MEMORY. Freed by sl_sheet_clear, also after
 * failure. The same for any number of threads. */
SL_NODISCARD sl_status sl_sheet_init(const sl_pack_task *task, double scale, int32_t grid, int32_t turns,
                                     const double *angle, sl_sheet *out);
void sl_sheet_clear(sl_sheet *sheet);

SL_NODISCARD sl_status sl_desk_init(const sl_pack_task *task, int32_t grid, sl_desk *out);
void sl_desk_clear(sl_desk *desk);

/* Lays all charts out by the plan on empty pages: each on the first page where it fits, there where it is pulled
 * farthest. Returns the cells of those that found no place (of their first orientation, at least 1 each); gives up when
 * that exceeds bound, the rest having page -1. spot: count. */
int64_t sl_lay_out(const sl_sheet *sheet, const sl_plan *plan, int64_t bound, sl_desk *desk, sl_spot *spot);

#endif
