#include "pack/pack.h"

#include "base/memory.h"
#include "pack/separate.h"

#include <math.h>

enum {
    MAX_EFFORT = 12,
    MAX_PAGES = 1000,
    MAX_STARTS = 4,
    FINE = 1024, /* cells along a page's width, at last */
    FINEST = 2048,
    FINEST_EFFORT = 6, /* ... from this effort on */
    FEWEST_SWEEPS = 15,
    ROAMING_LEVELS = 2,
    ROAMING_CHARTS = 128, /* more find room nearby, and looking far costs more than it gains */
    MOST_CHARTS = 2048    /* that are pushed apart: the work grows by the square of their number */
};

static const double first_step = 1e-2, later_step = 5e-3; /* of the scale, relative */

static const int64_t first_work = 12500000; /* words; doubled by each step of effort */

sl_pack_def sl_pack_default(void)
{
    return (sl_pack_def){.resolution = 2048, .margin = 4.0, .rotations = SL_ROTATE_FREE, .effort = 2, .pages = 1};
}

typedef struct outline_job {
    const sl_pack_chart *chart;
    sl_outline *outline;
    sl_status *status;
} outline_job;

static void make_outlines(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    (void)chunk;
    const outline_job *job = user;
    for (int64_t c = begin; c < end; c++) {
        job->status[c] = sl_outline_init(&job->chart[c], &job->outline[c]);
    }
}

/* All outlines; of several failures the first chart's is told. */
static sl_status init_outlines(int32_t count, const sl_pack_chart *charts, const sl_context *context, sl_outline *out)
{
    sl_status status = SL_OK;
    outline_job job = {charts, out, sl_calloc(count, sizeof *job.status)};
    SL_TRY(job.status != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    sl_parallel_for(context, count, 1, make_outlines, &job);
    for (int32_t c = 0; c < count; c++) {
        SL_TRY(job.status[c]);
    }
cleanup:
    sl_free(job.status);
    return status;
}

typedef struct start {
    const sl_pack_task *task;
    sl_separate_def def;
    sl_arrangement arrangement;
    int32_t attempts;
    sl_status status;
} start;

static void run_starts(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    (void)chunk;
    start *starts = user;
    for (int64_t k = begin; k < end; k++) {
        starts[k].status = sl_separate(starts[k].task, &starts[k].def, &starts[k].arrangement, &starts[k].attempts);
    }
}

/* Separates from the same arrangement with several seeds; the best of what they give. */
static sl_status separate_from_starts(const sl_pack_task *task, const sl_separate_def *def, int32_t count,
                                      sl_arrangement *best, int32_t *attempts)
{
    start starts[MAX_STARTS] = {0};
    sl_status status = SL_OK;
    for (int32_t k = 0; k < count; k++) {
        starts[k] = (start){task, *def, {best->scale, sl_copy(best->pose, task->count, sizeof *best->pose)}, 0, SL_OK};
        starts[k].def.seed = (uint64_t)k;
        SL_TRY(starts[k].arrangement.pose != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    }
    sl_parallel_for(count > 1 ? task->context : NULL, count, 1, run_starts, starts);
    for (int32_t k = 0; k < count; k++) {
        SL_TRY(starts[k].status);
        *attempts += starts[k].attempts;
        if (starts[k].arrangement.scale > best->scale) {
            const sl_arrangement kept = *best;
            *best = starts[k].arrangement;
            starts[k].arrangement = kept;
        }
    }
cleanup:
    for (int32_t k = 0; k < count; k++) {
        sl_free(starts[k].arrangement.pose);
    }
    return status;
}

/* Cells along a page's width at last: those of half a texel are fine enough. */
static int32_t finest_grid(const sl_pack_def *def)
{
    const int32_t finest = def->effort >= FINEST_EFFORT ? FINEST : FINE, limit = 2 * def->resolution;
    return limit < finest ? limit : finest;
}

/* Packs the arrangement tighter, on ever finer grids; charts roam the page on the first two. */
static sl_status tighten(const sl_pack_task *task, const sl_pack_def *def, sl_arrangement *best, int32_t *attempts)
{
    sl_status status = SL_OK;
    const int32_t first = sl_search_grid(task), finest = finest_grid(def);
    const int32_t starts = def->effort >= 8 ? 4 : def->effort >= 6 ? 2 : 1;
    int32_t sweeps = FEWEST_SWEEPS << (def->effort / 2);
    for (int32_t grid = first, level = 0; grid <= finest; grid *= 2, level++) {
        const sl_separate_def separate = {
            .grid = grid,
            .far = level < ROAMING_LEVELS && task->count <= ROAMING_CHARTS,
            .sweeps = sweeps,
            .step = level == 0 ? first_step : later_step,
            .halvings = level < ROAMING_LEVELS ? 3 : 2,
            .rotations = def->rotations,
        };
        SL_TRY(sl_report_progress(task->context, "packing", 0.6 + 0.1 * level));
        SL_TRY(separate_from_starts(task, &separate, level == 0 ? starts : 1, best, attempts));
        sweeps = sweeps > 2 ? sweeps / 2 : 1;
    }
cleanup:
    return status;
}

/* From poses of centres in texels to what the caller applies to UVs. */
static void hand_out(const sl_pack_task *task, const sl_arrangement *best, sl_placement *placement, sl_pack_info *info)
{
    double area = 0.0;
    info->scale = best->scale / task->width;
    for (int32_t c = 0; c < task->count; c++) {
        const sl_pose *pose = &best->pose[c];
        const double *centre = task->outline[c].centre;
        const double cosine = cos(pose->angle), sine = sin(pose->angle);
        placement[c] = (sl_placement){
            .angle = pose->angle,
            .offset = {pose->at[0] / task->width - info->scale * (cosine * centre[0] - sine * centre[1]),
                       pose->at[1] / task->width - info->scale * (sine * centre[0] + cosine * centre[1])},
            .page = pose->page,
        };
        info->pages = pose->page >= info->pages ? pose->page + 1 : info->pages;
        area += task->outline[c].area;
    }
    info->fill = info->pages > 0 ? area * best->scale * best->scale / (task->width * task->height * info->pages) : 0.0;
}

sl_status sl_pack(int32_t count, const sl_pack_chart *charts, const sl_pack_def *def, const sl_context *context,
                  sl_placement *placement, sl_pack_info *info)
{
    SL_ASSERT(count >= 0 && def->resolution > 0 && def->height >= 0 && def->margin >= 0.0 && def->density >= 0.0);
    SL_ASSERT(def->effort >= 0 && def->effort <= MAX_EFFORT && def->pages >= 0 && def->pages <= MAX_PAGES);
    sl_status status = SL_OK;
    sl_outline *outline = sl_calloc(count, sizeof *outline);
    double *upright = sl_alloc(count, sizeof *upright);
    sl_arrangement best = {.pose = sl_calloc(count, sizeof *best.pose)};
    *info = (sl_pack_info){0};
    if (outline == NULL || upright == NULL || best.pose == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    SL_TRY(init_outlines(count, charts, context, outline));
    for (int32_t c = 0; c < count; c++) {
        upright[c] = charts[c].upright;
    }
    const sl_pack_task task = {
        .count = count,
        .outline = outline,
        .width = def->resolution,
        .height = def->height > 0 ? def->height : def->resolution,
        .margin = def->margin,
        .pages = def->pages > 0 ? def->pages : 1,
        .context = context,
    };
    const sl_search_def search = {def->rotations, upright, def->density,
                                  def->effort > 0 ? first_work << def->effort : 0};
    if (count > 0) {
        SL_TRY(sl_search(&task, &search, &best, &info->attempts));
        if (best.scale > 0.0 && count <= MOST_CHARTS && def->density <= 0.0) {
            SL_TRY(tighten(&task, def, &best, &info->attempts));
        } else if (best.scale > 0.0 && count <= MOST_CHARTS && def->effort > 0) {
            SL_TRY(sl_fewer_pages(&task, def->rotations, FEWEST_SWEEPS << (def->effort / 2), finest_grid(def), &best,
                                  &info->attempts));
        }
    }
    hand_out(&task, &best, placement, info);
cleanup:
    for (int32_t c = 0; outline != NULL && c < count; c++) {
        sl_outline_clear(&outline[c]);
    }
    sl_free(outline);
    sl_free(upright);
    sl_free(best.pose);
    return status;
}
