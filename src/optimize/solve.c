/* Charts laid flat: warm from the UVs at hand where that can be, else from nothing; proven to be embedded. */
#include "optimize/optimize_internal.h"

#include "base/memory.h"
#include "overlap/certificate.h"
#include "param/open.h"
#include "param/stretch.h"

#include <math.h>
#include <string.h>

static const double SETTLED = 1e-4;       /* relative decrease at which a chart is solved */
static const double SKETCHED = 1e-2;      /* ... well enough to see whether it is worth more */
static const double OPEN_SHARE = 0x1p-10; /* of a border edge: room made between the banks of a fresh cut */
static const double W_HIGH = 1.0;
static const double W_LOW = -5.0; /* at coarse targets lower ones hardly gain angle, and what cuts promise is noise */
static const double FINE_ANGLE = 1.1, MOST_LOWER = 40.0; /* below that target they do gain: so many times W_LOW */
static const int BALANCE_ROUNDS = 6;
static const int32_t MOST_KEPT =
    50000;                           /* triangles of a chart whose factor is kept between rounds: tens of megabytes */
static const double BALANCED = 0.02; /* the two shares of the budgets agree within this ratio */
static const double BALANCED_FAR = 0.15; /* ... while their mean is above FAR_SHARE */
static const double FAR_SHARE = 1.3;
static const double FIRST_STEP = 0.25; /* of the weight; in proportion to it below W_LOW */

static sl_stretch_def stretch_def(const sl_opt_state *state)
{
    sl_stretch_def def = sl_stretch_default();
    def.w = state->w;
    def.relative_decrease = SETTLED;
    return def;
}

/* What a solver says when it has no map to offer is an outcome here. */
static sl_status outcome(sl_status status, bool *solved)
{
    *solved = status == SL_OK;
    const bool none = status == SL_BAD_INPUT || status == SL_SINGULAR || status == SL_NOT_POSITIVE_DEFINITE ||
                      status == SL_INFEASIBLE;
    return none ? SL_OK : status;
}

/* A chart on its way through the attempts. */
typedef struct attempt {
    const sl_patch *patch;
    const sl_context *context;
    sl_stretch_def def;
    int32_t nb, *border;
    double *start, *work; /* 2 nv, nv */
} attempt;

static sl_status certify(const attempt *a, const double *uv, bool *embedded)
{
    sl_certificate certificate = {0};
    const sl_status status = sl_certify_embedding(uv, a->patch->nt, a->patch->tri, a->nb, a->border, &certificate);
    *embedded = status == SL_OK && certificate.embedded;
    return status == SL_BAD_INPUT ? SL_OK : status;
}

static sl_status solve_from_nothing(attempt *a, bool simple_border, double *uv, bool *embedded)
{
    sl_status status = SL_OK;
    bool solved = false;
    *embedded = false;
    a->def.simple_border = simple_border;
    SL_TRY(outcome(sl_stretch_unfold(a->patch, &a->def, a->context, uv, NULL), &solved));
    if (solved) {
        SL_TRY(certify(a, uv, embedded));
    }
cleanup:
    a->def.simple_border = false;
    return status;
}

/* From the map in start, its touching banks opened, with the border kept simple all the way. */
static sl_status solve_opened(attempt *a, double *uv, bool *embedded)
{
    sl_status status = SL_OK;
    bool solved = false;
    sl_open_border(a->patch, a->nb, a->border, a->start, OPEN_SHARE, 0.0, a->work, uv);
    SL_TRY(certify(a, uv, embedded));
    if (*embedded) {
        a->def.simple_border = true;
        SL_TRY(outcome(sl_stretch_minimise(a->patch, &a->def, a->context, uv, NULL), &solved));
        SL_TRY(certify(a, uv, embedded));
    }
cleanup:
    a->def.simple_border = false;
    return status;
}

/* From the map at hand. Where that ends in an overlap: with `anew` from nothing, since that may come to lie otherwise;
 * with `held` from the map at hand with a border that must stay simple, which stops where it touches; with both, last,
 * from nothing with such a border. */
static sl_status solve_warm(attempt *a, bool anew, bool held, double *uv, bool *embedded)
{
    sl_status status = SL_OK;
    bool solved = false;
    *embedded = false;
    SL_TRY(outcome(sl_stretch_minimise(a->patch, &a->def, a->context, uv, NULL), &solved));
    if (solved) {
        SL_TRY(certify(a, uv, embedded));
    }
    if (!*embedded && anew) {
        SL_TRY(solve_from_nothing(a, false, uv, embedded));
    }
    if (!*embedded && held && solved) {
        SL_TRY(solve_opened(a, uv, embedded));
    }
    if (!*embedded && anew && held) {
        SL_TRY(solve_from_nothing(a, true, uv, embedded));
    }
cleanup:
    return status;
}

/* From the map at hand alone; from nothing where that has flips. */
static sl_status solve_sewn(attempt *a, double *uv, bool *embedded)
{
    sl_status status = SL_OK;
    bool solved = false;
    SL_TRY(outcome(sl_stretch_minimise(a->patch, &a->def, a->context, uv, NULL), &solved));
    SL_TRY(solved ? certify(a, uv, embedded) : solve_from_nothing(a, false, uv, embedded));
cleanup:
    return status;
}

static sl_status solve_cold(attempt *a, double *uv, bool *embedded)
{
    const sl_status status = solve_from_nothing(a, false, uv, embedded);
    return status != SL_OK || *embedded ? status : solve_from_nothing(a, true, uv, embedded);
}

sl_status sl_opt_certify(const sl_patch *patch, const double *uv, sl_certificate *out)
{
    int32_t nb = 0, *border = NULL;
    sl_status status = sl_patch_border_edges(patch, &nb, &border);
    if (status == SL_OK) {
        status = sl_certify_embedding(uv, patch->nt, patch->tri, nb, border, out);
    }
    sl_free(border);
    return status;
}

/* The same patch may be solved up to four times, and again by the next call that names the workspace: what its matrix
 * looks like is found once. */
static sl_status solve_with(const sl_opt_state *state, const sl_patch *patch, sl_opt_effort effort,
                            sl_stretch_workspace *workspace, double *uv, bool *embedded)
{
    sl_status status = SL_OK;
    attempt a = {.patch = patch, .context = &state->quiet, .def = stretch_def(state)};
    a.def.workspace = workspace;
    *embedded = false;
    if (!sl_patch_is_disk(patch)) {
        return SL_OK;
    }
    a.start = sl_alloc(2 * (int64_t)patch->nv, sizeof *a.start);
    a.work = sl_alloc(patch->nv, sizeof *a.work);
    SL_TRY(a.start == NULL || a.work == NULL ? SL_OUT_OF_MEMORY : SL_OK);
    SL_TRY(sl_patch_border_edges(patch, &a.nb, &a.border));
    memcpy(a.start, uv, 2 * (size_t)patch->nv * sizeof *uv);
    switch (effort) {
    case SL_OPT_WARM:
        SL_TRY(solve_warm(&a, true, false, uv, embedded));
        break;
    case SL_OPT_HELD:
        SL_TRY(solve_warm(&a, true, true, uv, embedded));
        break;
    case SL_OPT_WARM_ONLY:
        SL_TRY(solve_warm(&a, false, true, uv, embedded));
        break;
    case SL_OPT_GUESSED:
        a.def.guess = a.start;
        SL_TRY(solve_cold(&a, uv, embedded));
        break;
    case SL_OPT_SIMPLE:
        SL_TRY(solve_from_nothing(&a, true, uv, embedded));
        break;
    case SL_OPT_COLD:
        SL_TRY(solve_cold(&a, uv, embedded));
        break;
    case SL_OPT_SEWN:
        SL_TRY(solve_sewn(&a, uv, embedded));
        break;
    }
cleanup:
    sl_free(a.start);
    sl_free(a.work);
    sl_free(a.border);
    return status;
}

sl_status sl_opt_solve(const sl_opt_state *state, const sl_patch *patch, sl_opt_effort effort, double *uv,
                       bool *embedded)
{
    sl_stretch_workspace *workspace = NULL;
    sl_status status = SL_OK;
    SL_TRY(sl_stretch_workspace_create(&workspace));
    SL_TRY(solve_with(state, patch, effort, workspace, uv, embedded));
cleanup:
    sl_stretch_workspace_free(workspace);
    return status;
}

static sl_status is_embedded(const sl_opt_chart *chart, bool *embedded)
{
    sl_certificate certificate = {0};
    const sl_status status = sl_opt_certify(chart->patch, chart->uv, &certificate);
    *embedded = status == SL_OK && certificate.embedded;
    return status == SL_BAD_INPUT ? SL_OK : status;
}

sl_status sl_opt_sketch(const sl_opt_state *state, sl_opt_chart *chart, sl_stretch_workspace *workspace, bool *embedded)
{
    sl_status status = SL_OK;
    sl_stretch_def def = stretch_def(state);
    bool solved;
    *embedded = false;
    def.relative_decrease = SKETCHED;
    def.workspace = workspace;
    SL_TRY(outcome(sl_stretch_minimise(chart->patch, &def, &state->quiet, chart->uv, NULL), &solved));
    if (!solved) {
        SL_TRY(outcome(sl_stretch_unfold(chart->patch, &def, &state->quiet, chart->uv, NULL), &solved));
    }
    if (solved) {
        SL_TRY(is_embedded(chart, embedded));
    }
cleanup:
    return status;
}

sl_status sl_opt_finish(const sl_opt_state *state, sl_opt_chart *chart, sl_stretch_workspace *workspace, bool *embedded)
{
    sl_status status = SL_OK;
    sl_stretch_def def = stretch_def(state);
    bool solved;
    *embedded = false;
    def.workspace = workspace;
    SL_TRY(outcome(sl_stretch_minimise(chart->patch, &def, &state->quiet, chart->uv, NULL), &solved));
    if (solved) {
        SL_TRY(is_embedded(chart, embedded));
    }
cleanup:
    return status;
}

/* All charts with another weight, beside those of the state. */
typedef struct resolution {
    sl_opt_state *state;
    double **uv;
    sl_opt_sums *sums;
    sl_status *status;
    bool *embedded;
    sl_opt_effort effort;
    sl_stretch_workspace **workspace; /* by chart; NULL = each has its own for a while */
} resolution;

static sl_status resolve_chart(const resolution *r, int64_t c)
{
    const sl_patch *patch = r->state->chart[c].patch;
    if (r->workspace == NULL || patch->nt > MOST_KEPT) {
        return sl_opt_solve(r->state, patch, r->effort, r->uv[c], &r->embedded[c]);
    }
    sl_status status = r->workspace[c] == NULL ? sl_stretch_workspace_create(&r->workspace[c]) : SL_OK;
    if (status == SL_OK) {
        status = solve_with(r->state, patch, r->effort, r->workspace[c], r->uv[c], &r->embedded[c]);
    }
    return status;
}

static void resolve_range(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    (void)chunk;
    const resolution *r = user;
    for (int64_t c = begin; c < end; c++) {
        const sl_opt_chart *chart = &r->state->chart[c];
        r->uv[c] = sl_copy(chart->uv, 2 * (int64_t)chart->patch->nv, sizeof **r->uv);
        r->status[c] = r->uv[c] == NULL ? SL_OUT_OF_MEMORY : resolve_chart(r, c);
        if (r->status[c] == SL_OK && r->embedded[c]) {
            sl_opt_measure(r->state->surface, chart->patch, r->uv[c], &r->sums[c], NULL);
        }
    }
}

static void take(sl_opt_state *state, int64_t c, double *uv, const sl_opt_sums *sums)
{
    sl_opt_chart *chart = &state->chart[c];
    sl_free(chart->uv);
    chart->uv = uv;
    chart->sums = *sums;
    chart->stamp = state->next_stamp++;
    for (int32_t k = 0; k < 3 * chart->patch->nt; k++) {
        memcpy(state->uv + 2 * (int64_t)chart->patch->corner[k], uv + 2 * (int64_t)chart->patch->tri[k],
               2 * sizeof *uv);
    }
}

/* Every chart once more, side by side; *all = every one has an embedding. Charts without keep the map they have; or
 * all do where one has none, if `together`. workspace: by chart, nullable. */
static sl_status resolve(sl_opt_state *state, sl_opt_effort effort, bool together, sl_stretch_workspace **workspace,
                         bool *all)
{
    sl_status status = SL_OK;
    const int64_t n = state->nchart;
    *all = true;
    resolution r = {.state = state,
                    .effort = effort,
                    .workspace = workspace,
                    .uv = sl_calloc(n, sizeof *r.uv),
                    .sums = sl_calloc(n, sizeof *r.sums),
                    .status = sl_calloc(n, sizeof *r.status),
                    .embedded = sl_calloc(n, sizeof *r.embedded)};
    if (r.uv == NULL || r.sums == NULL || r.status == NULL || r.embedded == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    sl_parallel_for(state->context, n, 1, resolve_range, &r);
    for (int64_t c = 0; c < n; c++) {
        SL_TRY(r.status[c]);
    }
    for (int64_t c = 0; c < n; c++) {
        *all = *all && r.embedded[c];
    }
    for (int64_t c = 0; c < n; c++) {
        if (r.embedded[c] && (*all || !together)) {
            take(state, c, r.uv[c], &r.sums[c]);
            r.uv[c] = NULL;
        }
    }
cleanup:
    for (int64_t c = 0; c < n && r.uv != NULL; c++) {
        sl_free(r.uv[c]);
    }
    sl_free(r.uv);
    sl_free(r.sums);
    sl_free(r.status);
    sl_free(r.embedded);
    return status;
}

sl_status sl_opt_resolve(sl_opt_state *state)
{
    bool all;
    return resolve(state, SL_OPT_HELD, false, NULL, &all);
}

sl_status sl_opt_unfold(sl_opt_state *state, bool guessed, bool *all)
{
    return resolve(state, guessed ? SL_OPT_GUESSED : SL_OPT_COLD, false, NULL, all);
}

/* ln of the share of the stretch budget used over that of the angle budget: falls as w rises. */
static double imbalance(const sl_opt_state *state)
{
    sl_opt_total total;
    sl_opt_totals(state, &total);
    const double least = 1e-9;
    return log(fmax(total.stretch - 1.0, least) / fmax(state->def->target_stretch - 1.0, least)) -
           log(fmax(total.angle - 1.0, least) / fmax(state->def->target_angle - 1.0, least));
}

/* How far the shares may be from each other: where neither target is near, roughly will do. */
static double tolerance(const sl_opt_state *state)
{
    sl_opt_total total;
    sl_opt_totals(state, &total);
    const double q = (total.stretch - 1.0) / fmax(state->def->target_stretch - 1.0, 1e-9);
    const double r = (total.angle - 1.0) / fmax(state->def->target_angle - 1.0, 1e-9);
    return q * r > FAR_SHARE * FAR_SHARE ? BALANCED_FAR : BALANCED;
}

/* The squares of the singular values' differences, which the mean of s1/s2 - 1 goes with, weigh 1 - w/2 times what
 * those of the areas do. */
static double lowest_weight(const sl_optimize_def *def)
{
    const double finer = (FINE_ANGLE - 1.0) / fmax(def->target_angle - 1.0, 1e-9);
    return W_LOW * fmin(fmax(finer * finer, 1.0), MOST_LOWER);
}

/* The next weight: where the secant through the last two points vanishes, if that is between the bounds; not more than
 * twice as far as the last step. */
static double next_weight(double w, double f, double w0, double f0, double low, double high)
{
    const double step = 2.0 * fabs(w - w0), slope = (f - f0) / (w - w0); /* 0 where a bound was all that came of it */
    double next = slope < 0.0 ? w - f / slope : (f > 0.0 ? high : low);
    next = fmin(fmax(next, w - step), w + step);
    if (!(next > low) || !(next < high)) {
        next = f > 0.0 ? w + 0.5 * fmin(high - w, 2.0 * step) : w - 0.5 * fmin(w - low, 2.0 * step);
    }
    return next;
}

/* Secants until there is a bound on each side and within them, bisection where they lead out. A weight with which a
 * chart has no embedding is such a bound: taking the other charts alone with it, the weight would run away from the
 * maps. A piece that is flat anyway has nothing to balance. */
sl_status sl_opt_balance(sl_opt_state *state)
{
    sl_status status = SL_OK;
    const double since = sl_opt_clock();
    const double lowest = lowest_weight(state->def);
    double low = lowest, high = W_HIGH, w0 = NAN, f0 = NAN;
    sl_stretch_workspace **workspace = sl_calloc(state->nchart, sizeof *workspace); /* charts stay as they are here */
    SL_TRY(workspace != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int k = 0; k < BALANCE_ROUNDS; k++) {
        const double f = imbalance(state), w = state->w;
        bool all;
        if (fabs(f) < tolerance(state) || (f > 0.0 && w >= W_HIGH) || (f < 0.0 && w <= lowest)) {
            break;
        }
        low = f > 0.0 ? w : low; /* too much stretch: w rises */
        high = f > 0.0 ? high : w;
        if (isnan(w0)) {
            const double step = FIRST_STEP * fmax(w / W_LOW, 1.0);
            state->w = f > 0.0 ? fmin(high, w + step) : fmax(low, w - step);
        } else {
            state->w = next_weight(w, f, w0, f0, low, high);
        }
        SL_TRY(resolve(state, SL_OPT_HELD, true, workspace, &all));
        if (all) {
            w0 = w;
            f0 = f;
        } else {
            low = f > 0.0 ? low : state->w;
            high = f > 0.0 ? state->w : high;
            state->w = w;
            w0 = f > 0.0 ? high : low; /* the next step: half as far */
            f0 = f;
        }
    }
cleanup:
    for (int64_t c = 0; c < state->nchart && workspace != NULL; c++) {
        sl_stretch_workspace_free(workspace[c]);
    }
    sl_free(workspace);
    (void)sl_opt_book(state, SL_OPTIMIZE_BALANCE, since);
    return status;
}
