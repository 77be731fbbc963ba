#include "eigen/band.h"

#include "base/memory.h"
#include "eigen/lanczos_internal.h"

#include <math.h>
#include <string.h>

/* The first band ends in a gap of at least this relative width. */
static const double band_gap = 1e-6;

/* A band reaches from its lower end to this share of the same distance above its shift: what lies in it is nearer to
 * the shift than what lies below. */
static const double reach = 0.95;

/* Estimates stop at this share of the tolerance, */
static const double stop_share = 0.3;

/* and at this share of the mean distance between values, which residuals have to tell apart, but not below what
 * roundings leave. */
static const double spacing_share = 1e-3, rounding_share = 1e-13;

/* What is uncertain about the last value of a band and the count at its end, in their distance, at most. */
static const double error_share = 0.25;

/* A matrix of up to SMALL_BANDS bands is solved at once. A band holds MOST_PAIRS times what is meant at most. */
enum { LEAST_BAND = 8, SMALL_BANDS = 8, MOST_PAIRS = 2, MAX_FILLINGS = 12, MAX_TRIES = 12, WIDE_BLOCK = 3 * SL_PANEL };

sl_band_def sl_band_default(void)
{
    return (sl_band_def){.first = sl_lanczos_default(), .count = 200, .band = 50};
}

/* The run: pairs found so far lie in the caller's arrays, `found` of them, all below `edge`; all others are above it.
 */
typedef struct run {
    const sl_csc *A;
    const sl_band_def *def;
    const sl_context *context;
    int32_t n, count, found;
    int32_t band, empty; /* pairs of a band, about; bands without any since the last that had some */
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

static int64_t analysis_bytes(const run *r)
{
    return (int64_t)sizeof(int32_t) * (6 * (int64_t)r->n + 3 * r->A->colptr[r->n]);
}

/* Columns of the basis for so many pairs. */
static int32_t basis_for(int32_t expected, int32_t block)
{
    return sl_panel_count(2 * expected + 6 * block + 4 * SL_PANEL) * SL_PANEL;
}

/* Bytes that later bands hold at their peak. */
static int64_t later_bytes(const run *r)
{
    const int64_t n = r->n, real = sizeof(double), entries = r->A->colptr[n];
    const int32_t most = MOST_PAIRS * r->band, columns = basis_for(most, SL_PANEL);
    int64_t kept = 0;
    const int64_t factoring = sl_cholesky_factor_bytes(r->factor, &kept);
    const int64_t rows = (2 * entries - n) * (real + (int64_t)sizeof(int32_t)) + 2 * real * n;
    const int64_t held = analysis_bytes(r) + rows + real * sl_cholesky_block_work_size(r->factor, SL_PANEL);
    const int64_t small = 2 * real * columns * columns;
    const int64_t basis = sl_krylov_bytes(n, 0, WIDE_BLOCK, columns, SL_DOUBLE) + small;
    const int64_t solving = kept + basis + sl_panels_bytes(n, most, SL_DOUBLE);
    return held + (factoring > solving ? factoring : solving);
}

/* What later bands factor is ordered and analysed, and their memory estimated, before the first begins. */
static sl_status analyse(run *r)
{
    sl_cholesky_def options = sl_cholesky_default();
    const int64_t limit = r->def->first.memory_limit;
    sl_status status = SL_OK;
    options.kind = SL_FACTOR_LDLT;
    options.xyz = r->def->first.xyz;
    options.perm = r->def->first.perm;
    options.context = r->context;
    SL_TRY(sl_cholesky_analyze(r->A, &options, &r->factor));
    r->info->memory = later_bytes(r);
    SL_TRY(limit == 0 || r->info->memory <= limit ? SL_OK : SL_LIMIT);
cleanup:
    return status;
}

static sl_status prepare(run *r)
{
    sl_status status = SL_OK;
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

/* Where the first band ends: in the widest gap before a value of its last quarter, or in the last gap at all. */
static int32_t last_gap(const run *r)
{
    int32_t best = r->found - 1;
    for (int32_t k = best; k > 0; k--) {
        const double gap = r->lambda[k] - r->lambda[k - 1], widest = r->lambda[best] - r->lambda[best - 1];
        if (k < r->found - r->band / 4 && widest > band_gap * r->lambda[best]) {
            break;
        }
        best = gap > widest ? k : best;
    }
    return best;
}

/* The first band, cut at a gap unless it is the only one. */
static sl_status first_band(run *r)
{
    sl_lanczos_def def = r->def->first;
    sl_lanczos_info info = {0};
    sl_status status = SL_OK;
    const int64_t held = r->factor != NULL ? analysis_bytes(r) : 0;
    def.count = r->band;
    def.perm = def.perm == NULL && r->factor != NULL ? sl_cholesky_permutation(r->factor) : def.perm;
    def.memory_limit -= def.memory_limit > 0 ? held : 0;
    SL_TRY(sl_lanczos_solve(r->A, &def, r->context, r->lambda, r->vectors, r->residual, &info));
    r->info->bands = 1;
    r->info->factors = 1;
    r->info->counts = info.counts;
    r->info->solves = info.solves;
    r->info->certified = info.certified;
    r->info->converged = info.converged;
    r->info->memory = info.memory + held > r->info->memory ? info.memory + held : r->info->memory;
    r->found = r->band;
    if (r->found < r->count && info.converged) {
        r->found = last_gap(r);
        r->edge = 0.5 * (r->lambda[r->found - 1] + r->lambda[r->found]);
    }
cleanup:
    return status;
}

/* Half the width of the next band, by how dense the spectrum was of late; wider after bands that held nothing. */
static double half_width(const run *r)
{
    const int32_t back = r->found - 1 < r->band / 2 ? r->found - 1 : r->band / 2;
    const double spread = r->lambda[r->found - 1] - r->lambda[r->found - 1 - back];
    const double each = back > 0 && spread > 0.0 ? spread / back : r->edge;
    return ldexp(fmax(0.5 * r->band * each, 4.0 * band_gap * r->edge), r->empty);
}

/* How many of the leading Ritz pairs lie between the band's ends and have converged; sets *inside to how many lie there
 * at all. Their places are written to index. */
static int32_t count_converged(const run *r, double shift, double end, int32_t *index, int32_t *inside)
{
    const sl_krylov *k = &r->krylov;
    const double apart = fmax(spacing_share * (shift - r->edge) / r->band, rounding_share * r->norm);
    const double allowed = fmin(stop_share * r->def->first.tolerance * r->norm, apart);
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

/* Whether the pairs of a band are as many eigenvalues between its ends, beyond what residuals and the count at the
 * upper end leave open. Ritz values pair off with eigenvalues, none further than the residuals' Frobenius norm (Kahan;
 * Parlett 1998, Sec. 11.5). */
static bool stands_apart(const run *r, double end, double error, int32_t count, const double *lambda,
                         const double *residual)
{
    double squares = 0.0;
    for (int32_t k = 0; k < count; k++) {
        squares += residual[k] * residual[k];
    }
    const double moved = sqrt(squares), margin = end - lambda[count - 1];
    return lambda[0] - moved > r->edge && moved + error < error_share * margin;
}

/* The pairs of a complete band, by a Rayleigh-Ritz step. They are delivered, and the edge put halfway between the last
 * and the end, unless they come too near to the ends: no pair is then found twice, and none lost between bands. */
static sl_status take_band(run *r, const int32_t *index, int32_t expected, double end, double error, bool *taken)
{
    sl_panels X = {.rows = 0};
    double *values = sl_alloc(2 * ((int64_t)expected + 1), sizeof *values);
    sl_status status = SL_OK;
    SL_TRY(values != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(sl_panels_create(r->n, expected, SL_DOUBLE, &X));
    sl_krylov_select(&r->krylov, index, expected);
    SL_TRY(sl_krylov_vectors(&r->krylov, expected, expected, &X));
    SL_TRY(sl_panels_rayleigh_ritz(&X, expected, &r->rows, r->norm, values, values + expected, r->context));
    *taken = stands_apart(r, end, error, expected, values, values + expected);
    if (*taken) {
        deliver(r, &X, expected, values, values + expected);
        r->edge = 0.5 * (values[expected - 1] + end);
        r->info->bands++;
        r->empty = 0;
    }
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

/* The pairs between the edge and `end`, `expected` of them. */
static sl_status solve_band(run *r, double shift, double end, double error, int32_t expected, int32_t block,
                            bool *taken)
{
    const int32_t basis = basis_for(expected, block);
    int32_t *index = sl_alloc(basis, sizeof *index);
    bool complete = false;
    sl_status status = SL_OK;
    SL_TRY(index != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(factor_at(r, &shift));
    SL_TRY(sl_krylov_init(r->n, 0, block, basis, SL_DOUBLE, r->def->first.seed, r->context, &r->krylov));
    r->krylov.both_ends = true;
    r->krylov.apply = apply_shifted;
    r->krylov.user = r;
    SL_TRY(run_krylov(r, shift, end, expected, index, &complete));
    if (complete) {
        SL_TRY(take_band(r, index, expected, end, error, taken));
    }
cleanup:
    sl_krylov_clear(&r->krylov);
    sl_free(index);
    return status;
}

/* One band above the edge of half width *half. *done: its pairs are delivered and the edge has moved; otherwise *half
 * is what to try next. */
static sl_status try_band(run *r, double *half, int32_t block, bool *done)
{
    const double shift = r->edge + *half, end = shift + reach * *half;
    const int32_t most = MOST_PAIRS * r->band - 3 * (block - SL_PANEL);
    double error = 0.0;
    int32_t below = 0;
    sl_status status = SL_OK;
    *done = false;
    SL_TRY(count_below(r, end, &below, &error));
    const int32_t expected = below - r->found;
    const bool exact = error < error_share * (end - r->edge);
    if (exact && expected == 0) {
        r->edge = 0.5 * (r->edge + end);
        r->empty++;
        *done = true;
    } else if (exact && expected > 0 && expected <= most && basis_for(expected, block) + 2 * block + SL_PANEL <= r->n) {
        SL_TRY(solve_band(r, shift, end, error, expected, block, done));
    }
    *half *= expected > 2 * most ? fmax(0.05, (double)most / expected) : 0.7;
cleanup:
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
    r->info->certified =
        r->info->certified && below == r->found && error < error_share * (r->edge - r->lambda[r->found - 1]);
    while (r->found < r->count) {
        bool done = false;
        double half = half_width(r);
        for (int32_t k = 0; k < MAX_TRIES && !done; k++) {
            SL_TRY(try_band(r, &half, k < MAX_TRIES / 2 ? SL_PANEL : WIDE_BLOCK, &done));
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
    r.band = r.n <= SMALL_BANDS * (int64_t)def->band || r.count < def->band ? r.count : def->band;
    r.residual = sl_calloc(r.count, sizeof *r.residual);
    SL_TRY(r.residual != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    if (r.band < r.count) {
        SL_TRY(analyse(&r));
    }
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
