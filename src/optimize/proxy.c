/* Large pieces: the search runs on a coarse mesh, its charts are tried on a finer one, and the piece itself is solved
 * once they are what it wants. */
#include "optimize/decimate_internal.h"

#include "base/memory.h"

#include <math.h>

static const int32_t SEARCHED = 4000;     /* triangles of the mesh that is searched, */
static const int32_t TRIED = 24000;       /* of the one on which its charts are tried, */
static const int32_t TRY_FROM = 48000;    /* of pieces that have the second, */
static const int32_t SEARCH_FROM = 10000, /* and the first: at coarse targets, */
    SEARCH_FINE_FROM = 30000;             /* and at finer ones, for which the coarse mesh lacks detail */
static const int CARRIES = 3;             /* of the searched mesh's seams */
static const int FINISHES = 2;            /* of the tried mesh's */
static const double ENOUGH = 0.9;         /* share of the budget that is well spent */
static const double NEAR_MISS = 1.5;      /* share of a budget that a few cuts on the finer mesh still mend */
static const double BELIEVED = 0.85;      /* ... spent where the coarse mesh shows all that matters */
static const double SAME = 0.005;         /* no more comes of searching on */
static const double MOST_RATIO = 2.0; /* between the losses of one mesh and the next finer, as far as it is believed */

/* A coarse mesh. */
typedef struct level {
    sl_mesh *mesh;
    sl_triangulation *triangulation;
    int32_t *vertex; /* of the next finer surface's patch */
    double *weight;
    sl_opt_surface surface;
    sl_optimize_def def; /* targets as these charts must meet them for the finer ones to do so */
    sl_opt_state state;
} level;

static void level_clear(level *l)
{
    sl_opt_state_clear(&l->state);
    sl_opt_surface_clear(&l->surface);
    sl_triangulation_free(l->triangulation);
    sl_mesh_free(l->mesh);
    sl_free(l->vertex);
    sl_free(l->weight);
}

static sl_status level_init(const sl_opt_state *finer, int32_t triangles, level *l)
{
    sl_status status = SL_OK;
    l->def = *finer->def;
    const double since = sl_opt_clock();
    SL_TRY(sl_report_progress(finer->context, "coarsen", 0.0));
    SL_TRY(sl_opt_decimate(finer->surface->patch, triangles, &l->mesh, &l->vertex));
    l->weight = sl_alloc(l->mesh->nh, sizeof *l->weight);
    SL_TRY(l->weight == NULL ? SL_OUT_OF_MEMORY : SL_OK);
    SL_TRY(sl_opt_coarse_weights(finer->surface, l->mesh, l->vertex, l->weight));
    SL_TRY(sl_triangulation_create(l->mesh, &l->triangulation));
    SL_TRY(sl_opt_surface_init(l->mesh, l->triangulation, l->weight, &l->surface));
    SL_TRY(sl_opt_state_init(&l->surface, &l->def, finer->context, &l->state));
    (void)sl_opt_book(&l->state, SL_OPTIMIZE_COARSEN, since);
cleanup:
    return status;
}

/* The larger share of the two budgets that is spent; above 1 where a chart stretches too much. */
static double share_of(const sl_opt_state *state)
{
    const sl_optimize_def *def = state->def;
    sl_opt_total total;
    sl_opt_totals(state, &total);
    const double share = fmax((total.stretch - 1.0) / fmax(def->target_stretch - 1.0, 1e-9),
                              (total.angle - 1.0) / fmax(def->target_angle - 1.0, 1e-9));
    return share <= 1.0 && !sl_opt_within(state, &total) ? 1.0 + 0x1p-20 : share;
}

/* The targets of a level from what came of its charts on the next: the same share of the budget is left there as
 * here. */
static void correct_targets(const sl_opt_state *fine, level *l)
{
    sl_opt_total there, here;
    sl_opt_totals(fine, &here);
    sl_opt_totals(&l->state, &there);
    const double stretch = fmax(here.stretch - 1.0, 1e-6) / fmax(there.stretch - 1.0, 1e-6);
    const double angle = fmax(here.angle - 1.0, 1e-6) / fmax(there.angle - 1.0, 1e-6);
    l->def.target_stretch = 1.0 + (fine->def->target_stretch - 1.0) / fmin(fmax(stretch, 1.0 / MOST_RATIO), MOST_RATIO);
    l->def.target_angle = 1.0 + (fine->def->target_angle - 1.0) / fmin(fmax(angle, 1.0 / MOST_RATIO), MOST_RATIO);
}

static sl_status carry(const level *from, sl_opt_state *to, bool *carried)
{
    sl_status status = SL_OK;
    SL_TRY(sl_report_progress(to->context, "carry", 0.0));
    sl_opt_uncut(to);
    SL_TRY(sl_opt_carry(&from->state, from->vertex, to, carried));
cleanup:
    return status;
}

/* Where borders that touch have held a map back until no weight and no cut helped it, its charts are laid flat anew. */
static sl_status search_again(level *l)
{
    sl_status status = SL_OK;
    bool all;
    SL_TRY(sl_opt_search(&l->state));
    if (share_of(&l->state) > 1.0) {
        l->state.w = 0.0;
        SL_TRY(sl_opt_unfold(&l->state, false, &all));
        SL_TRY(sl_opt_search(&l->state));
    }
cleanup:
    return status;
}

/* Another weight of the energy where that alone may meet both targets. */
static sl_status weigh_anew(sl_opt_state *state)
{
    double largest, mean;
    sl_opt_shares(state, NULL, &largest, &mean);
    return largest > 1.0 && mean < 1.0 ? sl_opt_balance(state) : SL_OK;
}

/* The coarse state whose charts came nearest to the targets on the finer mesh. */
typedef struct nearest {
    sl_opt_state state;
    double share;
} nearest;

static sl_status remember(const level *l, double share, nearest *best)
{
    if (!(share < best->share)) {
        return SL_OK;
    }
    sl_opt_state_clear(&best->state);
    best->share = share;
    return sl_opt_state_copy(&l->state, &best->state);
}

static sl_status try_charts(const level *l, sl_opt_state *finer, double *share, bool *done)
{
    sl_status status = SL_OK;
    const double since = sl_opt_clock();
    SL_TRY(carry(l, finer, done));
    (void)sl_opt_book(finer, SL_OPTIMIZE_CARRY, since);
    if (*done) {
        SL_TRY(weigh_anew(finer));
        *share = share_of(finer);
    }
cleanup:
    return status;
}

/* Back to the nearest charts, and what they lack cut on the finer mesh. */
static sl_status make_good(level *l, nearest *best, sl_opt_state *finer, double *share, bool *done)
{
    sl_status status = SL_OK;
    if (best->share < *share) {
        const sl_opt_state swap = l->state;
        l->state = best->state;
        l->state.info = swap.info;
        best->state = swap;
        SL_TRY(try_charts(l, finer, share, done));
    }
    if (*done && *share > 1.0) {
        SL_TRY(sl_opt_cut(finer));
    }
cleanup:
    return status;
}

static bool is_enough(double share, double last)
{
    return share <= 1.0 && (share >= ENOUGH || fabs(share - last) < SAME);
}

/* Searches the coarse mesh, carries the seams over, and corrects its targets until the finer one's are met and not
 * much is left of them. Where only little is missed, that is cut on the finer one at once. Unless `patient`, charts
 * that come out quite differently there end it. *done = false: that, or the seams could not be carried over. */
static sl_status search_level(level *l, bool patient, sl_opt_state *finer, bool *done)
{
    sl_status status = SL_OK;
    nearest best = {.share = HUGE_VAL};
    double share = HUGE_VAL;
    for (int k = 0; k < CARRIES; k++) {
        const double last = share;
        SL_TRY(search_again(l));
        SL_TRY(try_charts(l, finer, &share, done));
        if (!*done || is_enough(share, last) || (share > 1.0 && (best.share <= 1.0 || share < NEAR_MISS))) {
            break;
        }
        SL_TRY(remember(l, share, &best));
        if (share > 1.0 && !patient) {
            break;
        }
        correct_targets(finer, l);
    }
    if (*done && share > 1.0 && (patient || share < NEAR_MISS || best.share <= 1.0)) {
        SL_TRY(make_good(l, &best, finer, &share, done));
        share = share_of(finer);
    }
    *done = *done && (patient || (share >= BELIEVED && share <= 1.0));
    sl_opt_add_info(&l->state.info, &finer->info);
cleanup:
    sl_opt_state_clear(&best.state);
    return status;
}

/* The tried mesh's seams on the piece; where that misses the targets, once more with what the difference teaches. */
static sl_status finish(level *tried, sl_opt_state *fine, bool *done)
{
    sl_status status = SL_OK;
    double share = HUGE_VAL;
    for (int k = 0; k < FINISHES; k++) {
        if (k > 0) {
            correct_targets(fine, tried);
            SL_TRY(sl_opt_cut(&tried->state));
        }
        SL_TRY(try_charts(tried, fine, &share, done));
        if (!*done || share <= 1.0) {
            break;
        }
    }
    sl_opt_add_info(&tried->state.info, &fine->info);
cleanup:
    return status;
}

/* Seams that follow a coarse mesh's edges cost more than they need on the piece. */
static sl_status straighten(sl_opt_state *state)
{
    const double since = sl_opt_clock();
    const sl_status status = sl_opt_straighten(state);
    (void)sl_opt_book(state, SL_OPTIMIZE_STRAIGHTEN, since);
    return status;
}

static sl_status through_levels(sl_opt_state *state, const sl_segment_def *segment, bool *done)
{
    sl_status status = SL_OK;
    level tried = {0}, searched = {0};
    sl_segment_def with = *segment;
    const int32_t nt = state->surface->patch->nt;
    const bool two = nt > TRY_FROM;
    if (two) {
        SL_TRY(level_init(state, TRIED, &tried));
    }
    sl_opt_state *finer = two ? &tried.state : state;
    SL_TRY(level_init(finer, SEARCHED, &searched));
    with.edge_weight = searched.weight;
    SL_TRY(sl_opt_start(&searched.state, &with, searched.triangulation, done));
    if (*done) {
        SL_TRY(search_level(&searched, nt > SEARCH_FINE_FROM, finer, done));
    }
    if (*done && two) {
        SL_TRY(finish(&tried, state, done));
    } else if (*done) {
        SL_TRY(straighten(state));
    }
cleanup:
    level_clear(&searched);
    level_clear(&tried);
    return status;
}

/* Are the targets so coarse that a coarse mesh shows all that matters? */
static int32_t search_from(const sl_optimize_def *def)
{
    return sl_opt_coarseness(def) < 1.0 ? SEARCH_FINE_FROM : SEARCH_FROM;
}

sl_status sl_opt_piece(sl_opt_state *state, const sl_segment_def *segment, const sl_triangulation *triangulation,
                       bool *done)
{
    sl_status status = SL_OK;
    const int32_t nt = state->surface->patch->nt;
    *done = false;
    if (nt > search_from(state->def)) {
        SL_TRY(through_levels(state, segment, done));
        state->info.direct += !*done;
    }
    if (!*done) {
        sl_opt_uncut(state);
        state->w = 0.0;
        SL_TRY(sl_opt_start(state, segment, triangulation, done));
        if (*done) {
            SL_TRY(sl_opt_search(state));
            SL_TRY(sl_opt_recreate(state));
        }
    }
    if (*done && nt <= SEARCH_FINE_FROM) {
        SL_TRY(sl_opt_search_creases(state, segment, triangulation));
    }
cleanup:
    return status;
}
