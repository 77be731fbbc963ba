#include "eigen/band.h"

#include "base/memory.h"
#include "eigen/lanczos_internal.h"

#include <math.h>
#include <string.h>

/* Bands end in gaps of at least this relative width. */
static const double band_gap = 1e-6;

/* A band reaches from its lower end to this share of the same distance above its shift: what lies in it is nearer to
 * the shift than what lies below. */
static const double reach = 0.95;

/* Estimates stop at this share of the tolerance. */
static const double stop_share = 0.3;

enum { LEAST_BAND = 8, MAX_FILLINGS = 12, MAX_TRIES = 12 };

sl_band_def sl_band_default(void)
{
    return (sl_band_def){.first = sl_lanczos_default(), .count = 200, .band = 50};
}

/* The run: pairs found so far lie in the caller's arrays, `found` of them, all below `edge`. */
typedef struct run {
    const sl_csc *A;
    const sl_band_def *def;
    const sl_context *context;
    int32_t n, count, found;
    double norm, edge;
    sl_cholesky *factor;
    sl_rows rows;
    double *work;
    sl_krylov krylov;
    double *lambda, *vectors, *residual;
    sl_band_info *info;
} run;

static void apply_shifted(void *user, double *W, int32_t w)
{
    run *r = user;
    sl_cholesky_forward_part(r->factor, SL_PART_ALL, W, w, r->work, r->context);
    sl_cholesky_backward_part(r->factor, SL_PART_ALL, W, w, r->work, r->context);
    r->info->solves += w;
}

static sl_status count_below(run *r, double sigma, int32_t *count, double *error)
{
    sl_inertia_info info = {0};
    const sl_status status = sl_inertia(r->factor, r->A, sigma, r->context, &info);
    r->info->counts++;
    *count = info.negative;
    *error = info.zero == 0 ? info.backward_error : INFINITY;
    return status;
}

/* The first band, cut at its last gap. */
static sl_status first_band(run *r)
{
    sl_lanczos_def def = r->def->first;
    sl_lanczos_info info = {0};
    sl_status status = SL_OK;
    def.count = r->count < r->def->band ? r->count : r->def->band;
    SL_TRY(sl_lanczos_solve(r->A, &def, r->context, r->lambda, r->vectors, r->residual, &info));
    r->info->bands = 1;
    r->info->factors = 1;
    r->info->counts = info.counts;
    r->info->solves = info.solves;
    r->info->certified = info.certified;
    r->info->converged = info.converged;
    r->found = def.count;
    if (r->found == r->count || !info.converged) {
        goto cleanup;
    }
    int32_t last = r->found - 1;
    while (last > 1 && !(r->lambda[last] - r->lambda[last - 1] > band_gap * r->lambda[last])) {
        last--;
    }
    r->found = last;
    r->edge = 0.5 * (r->lambda[last - 1] + r->lambda[last]);
cleanup:
    return status;
}

static sl_status prepare(run *r)
{
    sl_cholesky_def options = sl_cholesky_default();
    sl_status status = SL_OK;
    options.kind = SL_FACTOR_LDLT;
    options.xyz = r->def->first.xyz;
    options.perm = r->def->first.perm;
    SL_TRY(sl_cholesky_analyze(r->A, &options, &r->factor));
    SL_TRY(sl_rows_create(r->A, sl_cholesky_permutation(r->factor), &r->rows));
    r->work = sl_alloc(sl_cholesky_block_work_size(r->factor, SL_PANEL), sizeof *r->work);
    SL_TRY(r->work != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t i = 0; i < r->n; i++) {
        double sum = 0.0;
        for (int64_t p = r->rows.first[i]; p < r->rows.first[i + 1]; p++) {
            sum += fabs(r->rows.val[p]);
        }
        r->norm = fmax(r->norm, sum);
    }
cleanup:
    return status;
}

/* Half the width of the next band, by how dense the spectrum was of late. */
static double half_width(const run *r)
{
    const int32_t back = r->found - 1 < r->def->band / 2 ? r->found - 1 : r->def->band / 2;
    const double spread = r->lambda[r->found - 1] - r->lambda[r->found - 1 - back];
    const double each = back > 0 && spread > 0.0 ? spread / back : r->edge;
    return fmax(0.5 * r->def->band * each, 4.0 * band_gap * r->edge);
}

/* How many of the leading Ritz pairs lie between the band's ends and have converged; sets *inside to how many lie there
 * at all. Their places are written to index. */
static int32_t count_converged(const run *r, double shift, double end, int32_t *index, int32_t *inside)
{
    const sl_krylov *k = &r->krylov;
    const double allowed = stop_share * r->def->first.tolerance * r->norm;
    int32_t converged = 0;
    *inside = 0;
    for (int32_t j = 0; j < k->found; j++) {
        const double theta = k->theta[j], lambda = theta != 0.0 ? shift + 1.0 / theta : INFINITY;
        if (lambda > r->edge && lambda < end) {
            index[(*inside)++] = j;
            converged += k->last[j] / (theta * theta) <= allowed;
        }
    }
    return converged;
}

/* Runs the Krylov space until it holds all `expected` pairs of the band. *complete: whether it does. */
static sl_status run_krylov(run *r, double shift, double end, int32_t expected, int32_t *index, bool *complete)
{
    sl_krylov *k = &r->krylov;
    sl_status status = SL_OK;
    int32_t inside = 0;
    *complete = false;
    sl_krylov_random(k);
    for (int32_t filling = 0; filling < MAX_FILLINGS && !*complete; filling++) {
        while (!*complete && k->applied + k->w <= k->max_basis) {
            SL_TRY(sl_report_progress(r->context, "bands", (double)r->found / r->count));
            sl_krylov_expand(k);
            if (k->applied >= expected + 4 * k->block &&
                (k->applied / k->w % 2 == 0 || k->applied + k->w > k->max_basis)) {
                SL_TRY(sl_krylov_ritz(k, k->applied));
                *complete = count_converged(r, shift, end, index, &inside) == expected && inside == expected;
            }
        }
        if (!*complete) {
            const int32_t kept = expected + 3 * k->block;
            SL_TRY(sl_krylov_ritz(k, kept < k->max_basis - 2 * k->block ? kept : k->max_basis - 2 * k->block));
            SL_TRY(sl_krylov_restart(k, k->found));
        }
    }
cleanup:
    return status;
}

/* X's columns to the caller, as many as are still wanted. */
static void deliver(run *r, const sl_panels *X, int32_t columns, const double *lambda, const double *residual)
{
    const int32_t *perm = sl_cholesky_permutation(r->factor);
    for (int32_t k = 0; k < columns && r->found < r->count; k++, r->found++) {
        const double *lane = sl_panel_at(X, k / SL_PANEL) + k % SL_PANEL;
        double *to = r->vectors + (int64_t)r->n * r->found;
        for (int64_t i = 0; i < r->n; i++) {
            to[perm[i]] = lane[i * SL_PANEL];
        }
        sl_lanczos_sign_rule(r->n, to);
        r->lambda[r->found] = lambda[k];
        r->residual[r->found] = residual[k] / r->norm;
    }
}

/* The pairs of a complete band, by a Rayleigh-Ritz step. */
static sl_status take_band(run *r, const int32_t *index, int32_t expected)
{
    sl_panels X = {.rows = 0};
    double *values = sl_alloc(2 * ((int64_t)expected + 1), sizeof *values);
    sl_status status = SL_OK;
    SL_TRY(values != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(sl_panels_create(r->n, expected, SL_DOUBLE, &X));
    sl_krylov_select(&r->krylov, index, expected);
    SL_TRY(sl_krylov_vectors(&r->krylov, expected, expected, &X));
    SL_TRY(sl_panels_rayleigh_ritz(&X, expected, &r->rows, r->norm, values, values + expected, r->context));
    deliver(r, &X, expected, values, values + expected);
cleanup:
    sl_panels_clear(&X);
    sl_free(values);
    return status;
}

/* Factors A - shift I, the shift moved a little where it meets an eigenvalue. */
static sl_status factor_at(run *r, double *shift)
{
    sl_status status = SL_SINGULAR;
    for (int32_t k = 0; k < MAX_TRIES && status == SL_SINGULAR; k++) {
        status = sl_cholesky_factor_shifted(r->factor, r->A, *shift, r->context, NULL);
        r->info->factors++;
        *shift *= status == SL_SINGULAR ? 1.0 + 1e-9 : 1.0;
    }
    return status;
}

/* One band above the edge of half width `half`. *done: its pairs are delivered and the edge has moved. */
static sl_status try_band(run *r, double half, int32_t block, bool *done)
{
    double shift = r->edge + half, end = shift + reach * half, error = 0.0;
    int32_t below = 0, *index = NULL;
    sl_status status = SL_OK;
    bool complete = false;
    *done = false;
    SL_TRY(count_below(r, end, &below, &error));
    const int32_t expected = below - r->found, basis = (2 * expected + 10 * block + 7) / 8 * 8;
    if (!(error < 0.5 * band_gap * half) || expected < 0 || expected > 3 * r->def->band ||
        basis + 2 * block + SL_PANEL > r->n) {
        goto cleanup;
    }
    if (expected > 0) {
        SL_TRY(factor_at(r, &shift));
        SL_TRY(sl_krylov_init(r->n, 0, block, basis, SL_DOUBLE, r->def->first.seed, r->context, &r->krylov));
        index = sl_alloc(basis, sizeof *index);
        SL_TRY(index != NULL ? SL_OK : SL_OUT_OF_MEMORY);
        r->krylov.both_ends = true;
        r->krylov.apply = apply_shifted;
        r->krylov.user = r;
        SL_TRY(run_krylov(r, shift, end, expected, index, &complete));
        if (!complete) {
            goto cleanup;
        }
        SL_TRY(take_band(r, index, expected));
    }
    r->info->bands += expected > 0;
    r->edge = end;
    *done = true;
cleanup:
    sl_krylov_clear(&r->krylov);
    sl_free(index);
    return status;
}

/* Band after band; one that fails is tried with other widths, then with a wider block. */
static sl_status later_bands(run *r)
{
    sl_status status = SL_OK;
    int32_t below = 0;
    double error = 0.0;
    SL_TRY(prepare(r));
    SL_TRY(count_below(r, r->edge, &below, &error));
    r->info->certified = r->info->certified && below == r->found && error < 0.5 * band_gap * r->edge;
    while (r->found < r->count) {
        bool done = false;
        double half = half_width(r);
        for (int32_t k = 0; k < MAX_TRIES && !done; k++) {
            SL_TRY(try_band(r, half, k < 4 ? SL_PANEL : 3 * SL_PANEL, &done));
            half *= done || k % 4 == 3 ? 1.0 : 0.7;
        }
        if (!done) {
            r->info->converged = r->info->certified = false;
            break;
        }
    }
cleanup:
    return status;
}

sl_status sl_lanczos_bands(const sl_csc *A, const sl_band_def *def, const sl_context *context, double *lambda,
                           double *vectors, double *residual, sl_band_info *info)
{
    const sl_band_def defaults = sl_band_default();
    sl_band_info spare = {0};
    sl_status status = SL_OK;
    def = def != NULL ? def : &defaults;
    run r = {.A = A, .def = def, .context = context, .n = A->ncols, .lambda = lambda, .vectors = vectors};
    r.info = info != NULL ? info : &spare;
    *r.info = spare;
    SL_TRY(def->count >= 0 && def->band >= LEAST_BAND ? SL_OK : SL_BAD_INPUT);
    r.count = def->count < r.n ? def->count : r.n;
    r.residual = sl_calloc(r.count, sizeof *r.residual);
    SL_TRY(r.residual != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(first_band(&r));
    if (r.found < r.count && r.info->converged) {
        SL_TRY(later_bands(&r));
    }
    r.info->found = r.found;
    for (int32_t k = 0; k < r.found; k++) {
        r.info->max_residual = fmax(r.info->max_residual, r.residual[k]);
    }
    r.info->converged = r.info->converged && r.found == r.count && r.info->max_residual <= def->first.tolerance;
    if (residual != NULL) {
        memcpy(residual, r.residual, (size_t)r.found * sizeof *residual);
    }
cleanup:
    sl_cholesky_free(r.factor);
    sl_rows_clear(&r.rows);
    sl_free(r.work);
    sl_free(r.residual);
    return status;
}
