#include "pack/arrange.h"

#include "base/memory.h"
#include "base/rng.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    WALKERS = 8,       /* plans tried at once, whatever the number of threads */
    FIRST_PLANS = 16,  /* at each scale of the first bisection: every pull, by area and by extent */
    SMALL_COUNT = 128, /* charts: above, two plans must do: by area and by extent */
    BISECTIONS = 60,
    FEW = 4, /* charts: so few are tried in more orientations */
    TURNS_OF_FEW = 64,
    TURNS = 16
};

static const double hopeful_fill = 0.97; /* the first scale would fill this much of the page; none will */
static const double first_width = 4e-3;  /* of the first bisection's last interval, relative */
static const double growth = 4e-3;       /* of the scale with each success */
static const double two_pi = 6.283185307179586;

/* One of the plans tried side by side. */
typedef struct walker {
    sl_plan plan;
    sl_desk desk;
    sl_spot *spot;
    int64_t homeless; /* cells */
} walker;

typedef struct search {
    const sl_pack_task *task;
    const sl_search_def *def;
    sl_arrangement *best;
    int32_t *attempts;
    int32_t grid, turns, walkers;
    double *angle; /* count x turns */
    sl_sheet sheet;
    walker walker[WALKERS];
    sl_plan plan;     /* the one to be changed */
    int64_t homeless; /* its cells */
    int32_t *lost;    /* positions in its order of charts without a place */
    int32_t lost_count;
} search;

int32_t sl_search_grid(const sl_pack_task *task)
{
    int32_t grid = 256; /* a chart of mean size is 24 cells wide */
    while (grid < 1024 && grid * (double)grid * task->pages < 576.0 * task->count) {
        grid *= 2;
    }
    return grid;
}

void sl_pose_from_spots(const sl_sheet *sheet, const sl_spot *spot, sl_pose *pose)
{
    for (int32_t c = 0; c < sheet->count; c++) {
        const sl_mask *mask = &sheet->mask[(int64_t)c * sheet->turns + spot[c].turn];
        pose[c] = (sl_pose){
            .angle = mask->angle,
            .at = {sheet->cell * (spot[c].x + mask->origin[0]), sheet->cell * (spot[c].y + mask->origin[1])},
            .page = spot[c].page,
        };
    }
}

static void list_angles(search *s)
{
    for (int32_t c = 0; c < s->task->count; c++) {
        const bool free = s->def->rotations == SL_ROTATE_FREE;
        const double base = free ? s->task->outline[c].angle : s->def->upright[c];
        for (int32_t k = 0; k < s->turns; k++) {
            s->angle[(int64_t)c * s->turns + k] = base + two_pi * k / s->turns;
        }
    }
}

static void search_clear(search *s)
{
    sl_free(s->angle);
    sl_free(s->plan.order);
    sl_free(s->lost);
    sl_sheet_clear(&s->sheet);
    for (int32_t w = 0; w < WALKERS; w++) {
        sl_free(s->walker[w].plan.order);
        sl_free(s->walker[w].spot);
        sl_desk_clear(&s->walker[w].desk);
    }
}

static sl_status search_init(search *s)
{
    const int32_t n = s->task->count;
    const sl_pack_rotations rotations = s->def->rotations;
    sl_status status = SL_OK;
    s->grid = sl_search_grid(s->task);
    s->turns = rotations == SL_ROTATE_NONE ? 1 : rotations == SL_ROTATE_RIGHT ? 4 : n <= FEW ? TURNS_OF_FEW : TURNS;
    s->walkers = s->task->pages >= WALKERS ? 1 : WALKERS / s->task->pages;
    s->angle = sl_alloc((int64_t)n * s->turns, sizeof *s->angle);
    s->plan.order = sl_alloc(n, sizeof *s->plan.order);
    s->lost = sl_alloc(n, sizeof *s->lost);
    SL_TRY(s->angle != NULL && s->plan.order != NULL && s->lost != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t w = 0; w < s->walkers; w++) {
        s->walker[w].plan.order = sl_alloc(n, sizeof *s->plan.order);
        s->walker[w].spot = sl_alloc(n, sizeof *s->walker[w].spot);
        SL_TRY(s->walker[w].plan.order != NULL && s->walker[w].spot != NULL ? SL_OK : SL_OUT_OF_MEMORY);
        SL_TRY(sl_desk_init(s->task, s->grid, &s->walker[w].desk));
    }
    list_angles(s);
cleanup:
    return status;
}

typedef struct sort_key {
    double value;
    int32_t chart;
} sort_key;

static int compare_keys(const void *pa, const void *pb)
{
    const sort_key *a = pa, *b = pb;
    if (a->value != b->value) {
        return a->value > b->value ? -1 : 1;
    }
    return (a->chart > b->chart) - (a->chart < b->chart);
}

/* Charts by falling area, or by falling extent. */
static sl_status sort_charts(const sl_pack_task *task, bool by_extent, int32_t *order)
{
    sort_key *key = sl_alloc(task->count, sizeof *key);
    if (key == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t c = 0; c < task->count; c++) {
        key[c] = (sort_key){by_extent ? task->outline[c].extent : task->outline[c].area, c};
    }
    qsort(key, (size_t)task->count, sizeof *key, compare_keys);
    for (int32_t c = 0; c < task->count; c++) {
        order[c] = key[c].chart;
    }
    sl_free(key);
    return SL_OK;
}

static void copy_plan(const sl_plan *from, int32_t count, sl_plan *to)
{
    memcpy(to->order, from->order, (size_t)count * sizeof *to->order);
    to->pull = from->pull;
    to->subset = from->subset;
}

static void run_walkers(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    (void)chunk;
    search *s = user;
    for (int64_t w = begin; w < end; w++) {
        walker *at = &s->walker[w];
        at->homeless = sl_lay_out(&s->sheet, &at->plan, s->homeless, &at->desk, at->spot);
    }
}

/* Runs the first `count` walkers; the number of the best, the first of equals. */
static int32_t best_walker(search *s, int32_t count)
{
    int32_t best = 0;
    sl_parallel_for(s->task->context, count, 1, run_walkers, s);
    *s->attempts += count;
    for (int32_t w = 1; w < count; w++) {
        best = s->walker[w].homeless < s->walker[best].homeless ? w : best;
    }
    return best;
}

static sl_status new_sheet(search *s, double scale)
{
    sl_sheet_clear(&s->sheet);
    return sl_sheet_init(s->task, scale, s->grid, s->turns, s->angle, &s->sheet);
}

static void keep_arrangement(search *s, const walker *from)
{
    s->best->scale = s->sheet.scale;
    sl_pose_from_spots(&s->sheet, from->spot, s->best->pose);
    copy_plan(&from->plan, s->task->count, &s->plan);
}

/* The fixed plans at one scale, until one of them places everything. */
static sl_status try_first_plans(search *s, double scale, bool *placed)
{
    sl_status status = SL_OK;
    *placed = false;
    SL_TRY(new_sheet(s, scale));
    s->homeless = 0;
    const int32_t plans = s->def->work > 0 && s->task->count <= SMALL_COUNT ? FIRST_PLANS : 2;
    for (int32_t p = 0; p < plans && !*placed; p += s->walkers) {
        const int32_t count = plans - p < s->walkers ? plans - p : s->walkers;
        for (int32_t w = 0; w < count; w++) {
            SL_TRY(sort_charts(s->task, (p + w) % 2 == 1, s->walker[w].plan.order));
            s->walker[w].plan.pull = (p + w) / 2;
            s->walker[w].plan.subset = 0;
        }
        const int32_t best = best_walker(s, count);
        *placed = s->walker[best].homeless == 0;
        if (*placed) {
            keep_arrangement(s, &s->walker[best]);
        }
    }
cleanup:
    return status;
}

/* No scale above this one can fit: all area must, and so must the longest chart along the page's diagonal. */
static double highest_scale(const sl_pack_task *task)
{
    const double diagonal = hypot(task->width, task->height);
    double area = 0.0, high = HUGE_VAL;
    for (int32_t c = 0; c < task->count; c++) {
        const double extent = task->outline[c].extent;
        area += task->outline[c].area;
        high = extent > 0.0 ? fmin(high, diagonal / extent) : high;
    }
    return area > 0.0 ? fmin(high, sqrt(hopeful_fill * task->width * task->height * task->pages / area)) : high;
}

static sl_status bisect(search *s)
{
    double high = highest_scale(s->task), low = 0.0;
    bool placed = false;
    sl_status status = SL_OK;
    if (s->def->scale > 0.0 || !(high < HUGE_VAL)) { /* the scale is given, or there are only points */
        SL_TRY(try_first_plans(s, s->def->scale > 0.0 ? s->def->scale : 0.0, &placed));
        return placed ? SL_OK : SL_INFEASIBLE;
    }
    double scale = 0.85 * high;
    for (int32_t k = 0; k < BISECTIONS && high - low > first_width * high; k++) {
        SL_TRY(sl_report_progress(s->task->context, "packing", 0.3 * k / (k + 8.0)));
        SL_TRY(try_first_plans(s, scale, &placed));
        low = placed ? scale : low;
        high = placed ? high : scale;
        scale = low > 0.0 ? 0.5 * (low + high) : 0.5 * high;
    }
    status = low > 0.0 ? SL_OK : SL_INFEASIBLE;
cleanup:
    return status;
}

/* Notes which charts of the walker's layout have no place. */
static void note_lost(search *s, const walker *from)
{
    s->lost_count = 0;
    s->homeless = from->homeless;
    for (int32_t i = 0; i < s->task->count; i++) {
        if (from->spot[from->plan.order[i]].page < 0) {
            s->lost[s->lost_count++] = i;
        }
    }
}

static void move_in_order(int32_t *order, int32_t from, int32_t to)
{
    const int32_t chart = order[from];
    if (to < from) {
        memmove(order + to + 1, order + to, (size_t)(from - to) * sizeof *order);
    } else {
        memmove(order + from, order + from + 1, (size_t)(to - from) * sizeof *order);
    }
    order[to] = chart;
}

static int32_t index_below(sl_rng *rng, int32_t n)
{
    return (int32_t)(sl_rng_uniform(rng) * n);
}

/* Another pull, other orientations, or a few charts earlier or later; those without a place earlier. */
static void change_plan(const search *s, sl_rng *rng, sl_plan *plan)
{
    const int32_t n = s->task->count;
    const double kind = sl_rng_uniform(rng);
    if (kind < 0.15) {
        plan->pull = index_below(rng, SL_PULLS);
        return;
    }
    if (kind < 0.4) {
        plan->subset = sl_rng_bits(rng) | 1;
    }
    for (int32_t moves = 1 + index_below(rng, 3); moves > 0; moves--) {
        if (s->lost_count > 0 && sl_rng_uniform(rng) < 0.5) {
            const int32_t from = s->lost[index_below(rng, s->lost_count)];
            move_in_order(plan->order, from, index_below(rng, from + 1));
        } else {
            const int32_t from = index_below(rng, n);
            const int32_t to = from + (int32_t)((sl_rng_uniform(rng) - 0.5) * 0.4 * n);
            move_in_order(plan->order, from, to < 0 ? 0 : to >= n ? n - 1 : to);
        }
    }
}

/* Takes over the plan that walker 0 has just laid out at the next scale, for as long as everything has a place there.
 */
static sl_status climb(search *s)
{
    sl_status status = SL_OK;
    do {
        SL_TRY(new_sheet(s, s->best->scale * (1.0 + growth)));
        s->homeless = INT64_MAX;
        copy_plan(&s->plan, s->task->count, &s->walker[0].plan);
        best_walker(s, 1);
        if (s->walker[0].homeless == 0) {
            keep_arrangement(s, &s->walker[0]);
        }
    } while (s->walker[0].homeless == 0);
    note_lost(s, &s->walker[0]);
cleanup:
    return status;
}

static int64_t work_done(const search *s)
{
    int64_t work = 0;
    for (int32_t w = 0; w < s->walkers; w++) {
        work += s->walker[w].desk.work;
    }
    return work;
}

static sl_status improve(search *s)
{
    sl_status status = SL_OK;
    const int64_t start = work_done(s);
    SL_TRY(climb(s));
    for (uint64_t round = 0; work_done(s) - start < s->def->work; round++) {
        SL_TRY(sl_report_progress(s->task->context, "packing",
                                  0.3 + 0.4 * (double)(work_done(s) - start) / (double)s->def->work));
        for (int32_t w = 0; w < s->walkers; w++) {
            sl_rng rng = sl_rng_seed(round * WALKERS + (uint64_t)w);
            copy_plan(&s->plan, s->task->count, &s->walker[w].plan);
            change_plan(s, &rng, &s->walker[w].plan);
            s->walker[w].desk.work += s->task->count; /* so that the work always grows */
        }
        const walker *best = &s->walker[best_walker(s, s->walkers)];
        if (best->homeless == 0) {
            keep_arrangement(s, best);
            SL_TRY(climb(s));
        } else if (best->homeless <= s->homeless) {
            copy_plan(&best->plan, s->task->count, &s->plan);
            note_lost(s, best);
        }
    }
cleanup:
    return status;
}

sl_status sl_search(const sl_pack_task *task, const sl_search_def *def, sl_arrangement *best, int32_t *attempts)
{
    search s = {.task = task, .def = def, .best = best, .attempts = attempts};
    sl_status status = SL_OK;
    SL_TRY(search_init(&s));
    SL_TRY(bisect(&s));
    if (def->work > 0 && def->scale <= 0.0 && best->scale > 0.0 && task->count > 1) {
        SL_TRY(improve(&s));
    }
cleanup:
    search_clear(&s);
    return status;
}
