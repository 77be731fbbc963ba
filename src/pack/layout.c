#include "pack/layout.h"

#include "base/memory.h"
#include "base/rng.h"

#include <math.h>

/* Pulls along x and y, and whether they act on the centre of gravity or on the top right corner. */
static const struct {
    int32_t x, y;
    bool corner;
} pull_table[SL_PULLS] = {
    {0, 1, false}, {0, 1, true}, {1, 8, false}, {1, 8, true}, {1, 4, false}, {1, 2, false}, {1, 1, false}, {1, 1, true},
};

typedef struct sheet_job {
    const sl_pack_task *task;
    const double *angle;
    double grow; /* [cells] */
    sl_sheet *sheet;
    sl_status *status; /* count */
} sheet_job;

static void make_masks(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    (void)chunk;
    const sheet_job *job = user;
    const sl_sheet *sheet = job->sheet;
    for (int64_t c = begin; c < end; c++) {
        const sl_outline *outline = &job->task->outline[c];
        /* a chart without extent gets one texel */
        const double grow = job->grow + (outline->radius > 0.0 ? 0.0 : 0.5 / sheet->cell);
        for (int64_t k = c * sheet->turns; k < (c + 1) * sheet->turns && job->status[c] == SL_OK; k++) {
            job->status[c] = sl_mask_init(outline, job->angle[k], sheet->scale / sheet->cell, grow, sheet->width,
                                          sheet->height, &sheet->mask[k]);
        }
    }
}

sl_status sl_sheet_init(const sl_pack_task *task, double scale, int32_t grid, int32_t turns, const double *angle,
                        sl_sheet *out)
{
    *out = (sl_sheet){.scale = scale, .cell = task->width / grid, .width = grid, .count = task->count, .turns = turns};
    out->height = (int32_t)fmax(1.0, floor(task->height / out->cell * (1.0 + 1e-12)));
    sheet_job job = {task, angle, 0.5 * task->margin / out->cell, out, sl_calloc(task->count, sizeof *job.status)};
    sl_status status = SL_OK;
    out->mask = sl_calloc((int64_t)task->count * turns, sizeof *out->mask);
    SL_TRY(job.status != NULL && out->mask != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    sl_parallel_for(task->context, task->count, 1, make_masks, &job);
    for (int32_t c = 0; c < task->count; c++) {
        SL_TRY(job.status[c]);
    }
cleanup:
    sl_free(job.status);
    return status;
}

void sl_sheet_clear(sl_sheet *sheet)
{
    for (int64_t k = 0; sheet->mask != NULL && k < (int64_t)sheet->count * sheet->turns; k++) {
        sl_pack_mask_clear(&sheet->mask[k]);
    }
    sl_free(sheet->mask);
    *sheet = (sl_sheet){0};
}

sl_status sl_desk_init(const sl_pack_task *task, int32_t grid, sl_desk *out)
{
    sl_status status = SL_OK;
    const double cell = task->width / grid;
    *out = (sl_desk){.board = sl_calloc((int64_t)task->pages + 1, sizeof *out->board)};
    SL_TRY(out->board != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (; out->pages < task->pages; out->pages++) {
        SL_TRY(sl_board_init(grid, (int32_t)fmax(1.0, floor(task->height / cell * (1.0 + 1e-12))),
                             &out->board[out->pages]));
    }
cleanup:
    return status;
}

void sl_desk_clear(sl_desk *desk)
{
    for (int32_t p = 0; desk->board != NULL && p <= desk->pages; p++) {
        sl_board_clear(&desk->board[p]);
    }
    sl_free(desk->board);
    *desk = (sl_desk){0};
}

static bool left_out(uint64_t subset, int32_t chart, int32_t turn)
{
    sl_rng rng = sl_rng_seed(subset + 0x10001u * (uint64_t)chart + (uint64_t)turn);
    return subset != 0 && (sl_rng_bits(&rng) & 1) != 0;
}

/* Puts one chart where it is pulled farthest on the first page that has room for it. */
static bool put_chart(const sl_sheet *sheet, const sl_plan *plan, int32_t chart, sl_desk *desk, sl_spot *spot)
{
    const sl_mask *masks = sheet->mask + (int64_t)chart * sheet->turns;
    for (spot->page = 0; spot->page < desk->pages; spot->page++) {
        sl_board_place best = {0, 0, INT64_MAX}, place;
        spot->turn = -1;
        for (int32_t k = 0; k < sheet->turns; k++) {
            const sl_mask *mask = &masks[k];
            const bool corner = pull_table[plan->pull].corner;
            const sl_board_query query = {
                .high = {sheet->width, sheet->height},
                .pull = {pull_table[plan->pull].x, pull_table[plan->pull].y},
                .reference = {corner ? 2 * mask->width : mask->centre[0], corner ? 2 * mask->height : mask->centre[1]},
                .limit = best.cost,
            };
            if (!left_out(plan->subset, chart, k) &&
                sl_board_find(&desk->board[spot->page], mask, &query, &place, &desk->work)) {
                best = place;
                spot->turn = k;
            }
        }
        if (spot->turn >= 0) {
            spot->x = best.x;
            spot->y = best.y;
            sl_board_put(&desk->board[spot->page], &masks[spot->turn], best.x, best.y);
            return true;
        }
    }
    spot->page = -1;
    return false;
}

int64_t sl_lay_out(const sl_sheet *sheet, const sl_plan *plan, int64_t bound, sl_desk *desk, sl_spot *spot)
{
    int64_t homeless = 0;
    for (int32_t p = 0; p < desk->pages; p++) {
        sl_board_wipe(&desk->board[p]);
    }
    for (int32_t i = 0; i < sheet->count; i++) {
        const int32_t c = plan->order[i];
        spot[c] = (sl_spot){-1, -1, 0, 0};
        if (homeless <= bound && !put_chart(sheet, plan, c, desk, &spot[c])) {
            const int64_t cells = sheet->mask[(int64_t)c * sheet->turns].cells;
            homeless += cells > 0 ? cells : (int64_t)sheet->width * sheet->height; /* larger than the page */
        }
    }
    return homeless;
}
