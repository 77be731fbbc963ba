/* A density that is given, on as few pages as it takes. */
#include "pack/separate.h"

#include "base/memory.h"

#include <string.h>

enum { ROAMING_LEVELS = 2, ROAMING_CHARTS = 128, STARTS = 3 };
static const double hopeful_fill = 0.95; /* of the pages, margins left out: none will be fuller */

typedef struct pages {
    const sl_pack_task *task;
    int32_t count;
    double *load; /* task->pages: area of the charts there */
} pages;

static void sum_loads(pages *p, const sl_pose *pose)
{
    memset(p->load, 0, (size_t)p->task->pages * sizeof *p->load);
    p->count = 0;
    for (int32_t c = 0; c < p->task->count; c++) {
        p->load[pose[c].page] += p->task->outline[c].area;
        p->count = pose[c].page >= p->count ? pose[c].page + 1 : p->count;
    }
}

static int32_t least_loaded(const pages *p, int32_t but)
{
    int32_t least = -1;
    for (int32_t k = 0; k < p->count; k++) {
        least = k != but && (least < 0 || p->load[k] < p->load[least]) ? k : least;
    }
    return least;
}

/* The largest chart that is still on a page; -1 = none. */
static int32_t largest_on(const pages *p, const sl_pose *pose, int32_t page)
{
    int32_t largest = -1;
    for (int32_t c = 0; c < p->task->count; c++) {
        if (pose[c].page == page && (largest < 0 || p->task->outline[c].area > p->task->outline[largest].area)) {
            largest = c;
        }
    }
    return largest;
}

/* Charts of the emptiest page go onto the middle of others, the largest first, each onto the page with most room; the
 * last page takes the number that has become free. */
static void dissolve_page(pages *p, sl_pose *pose)
{
    const int32_t gone = least_loaded(p, -1);
    for (int32_t c = largest_on(p, pose, gone); c >= 0; c = largest_on(p, pose, gone)) {
        const int32_t to = least_loaded(p, gone);
        pose[c].page = to;
        pose[c].at[0] = 0.5 * p->task->width;
        pose[c].at[1] = 0.5 * p->task->height;
        p->load[to] += p->task->outline[c].area;
    }
    for (int32_t c = 0; c < p->task->count; c++) {
        pose[c].page = pose[c].page == p->count - 1 ? gone : pose[c].page;
    }
}

/* Is there room for all on one page less, by area? */
static bool is_hopeful(const pages *p, double scale)
{
    double area = 0.0;
    for (int32_t k = 0; k < p->count; k++) {
        area += p->load[k];
    }
    return p->count > 1 && area * scale * scale <= hopeful_fill * p->task->width * p->task->height * (p->count - 1);
}

/* Pushes the charts apart on one page less, on finer and finer grids; *apart = false: they still overlap. */
static sl_status squeeze(pages *p, const sl_separate_def *with, int32_t finest, sl_arrangement *trial, bool *apart,
                         int32_t *attempts)
{
    sl_status status = SL_OK;
    sl_pack_task smaller = *p->task;
    sl_separate_def def = *with;
    dissolve_page(p, trial->pose);
    smaller.pages = p->count - 1;
    *apart = false;
    for (int32_t level = 0; def.grid <= finest && !*apart; def.grid *= 2, level++) {
        def.far = level < ROAMING_LEVELS && smaller.count <= ROAMING_CHARTS * smaller.pages;
        SL_TRY(sl_report_progress(smaller.context, "packing", 0.9));
        SL_TRY(sl_separate_at(&smaller, &def, trial, apart, attempts));
    }
cleanup:
    return status;
}

sl_status sl_fewer_pages(const sl_pack_task *task, sl_pack_rotations rotations, int32_t sweeps, int32_t finest,
                         sl_arrangement *best, int32_t *attempts)
{
    sl_status status = SL_OK;
    const size_t size = (size_t)task->count * sizeof *best->pose;
    pages p = {.task = task, .load = sl_calloc(task->pages, sizeof *p.load)};
    sl_arrangement trial = {.scale = best->scale, .pose = sl_alloc(task->count, sizeof *trial.pose)};
    bool apart = true;
    SL_TRY(p.load != NULL && trial.pose != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    sum_loads(&p, best->pose);
    while (apart && is_hopeful(&p, best->scale)) {
        apart = false;
        for (uint64_t seed = 0; seed < STARTS && !apart; seed++) {
            const sl_separate_def def = {
                .grid = sl_search_grid(task), .sweeps = sweeps, .rotations = rotations, .seed = seed};
            memcpy(trial.pose, best->pose, size);
            sum_loads(&p, trial.pose);
            SL_TRY(squeeze(&p, &def, finest, &trial, &apart, attempts));
        }
        if (apart) {
            memcpy(best->pose, trial.pose, size);
        }
        sum_loads(&p, best->pose);
    }
cleanup:
    sl_free(p.load);
    sl_free(trial.pose);
    return status;
}
