#include "eigen/lanczos.h"

#include "base/memory.h"
#include "eigen/lanczos_internal.h"

#include <cblas.h>
#include <math.h>
#include <string.h>

/* Matrices up to this order are LAPACK's. */
static const int32_t dense_order = 200;

/* From this order on a solve is bound by reading L, which eight sides share; below, the fewer vectors of narrow blocks
 * win. */
static const int32_t wide_block_order = 100000;

/* sigma = -sigma_share ||A||: far enough from a zero eigenvalue to factor, nearer to it than any other that matters. */
static const double sigma_share = 1e-8;

/* A null space may be off by this much: lengths, right angles, ||A N|| / ||A||. */
static const double null_space_error = 1e-8;

/* Polishing steps at the end, should recomputed residuals miss the tolerance. */
static const int32_t max_polish = 3;

sl_lanczos_def sl_lanczos_default(void)
{
    return (sl_lanczos_def){.count = 30, .max_restarts = 50, .tolerance = 1e-8, .seed = 1};
}

static double norm1_symmetric(const sl_csc *A, double *column_sum)
{
    double norm = 0.0;
    memset(column_sum, 0, (size_t)A->ncols * sizeof *column_sum);
    for (int32_t j = 0; j < A->ncols; j++) {
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            column_sum[j] += fabs(A->val[p]);
            column_sum[A->row[p]] += A->row[p] != j ? fabs(A->val[p]) : 0.0;
        }
    }
    for (int32_t j = 0; j < A->ncols; j++) {
        norm = fmax(norm, column_sum[j]);
    }
    return norm;
}

static sl_status check_arguments(const sl_csc *A, const sl_lanczos_def *def)
{
    const sl_status status = sl_csc_check(A, true);
    const bool ok = def->count >= 0 && def->block >= 0 && def->max_basis >= 0 && def->max_restarts >= 0 &&
                    def->tolerance > 0.0 && isfinite(def->tolerance) && def->null_count >= 0 &&
                    (def->null_count == 0 || def->null_space != NULL);
    return status != SL_OK ? status : ok && def->null_count <= A->ncols ? SL_OK : SL_BAD_INPUT;
}

/* Orthonormal columns that A maps to nothing; spare: n. */
static bool is_null_space(const sl_csc *A, const double *N, int32_t count, double norm, double *spare)
{
    const int32_t n = A->ncols;
    for (int32_t k = 0; k < count; k++) {
        const double *v = N + (int64_t)n * k;
        for (int32_t j = 0; j <= k; j++) {
            const double dot = cblas_ddot(n, v, 1, N + (int64_t)n * j, 1);
            if (!(fabs(dot - (j == k)) <= null_space_error)) {
                return false;
            }
        }
        sl_csc_multiply_symmetric(A, v, 1, spare);
        if (!(cblas_dnrm2(n, spare, 1) <= null_space_error * norm)) {
            return false;
        }
    }
    return true;
}

/* Sizes from the definition; a basis that would not fit the space means dense. */
static void choose_sizes(sl_lanczos *s, const sl_lanczos_def *def, bool *dense)
{
    s->count = def->count < s->n ? def->count : s->n;
    s->null_count = def->null_count < s->count ? def->null_count : s->count;
    s->wanted = s->count - s->null_count;
    s->block = def->block > 0 ? def->block : s->wanted < 6 ? 2 : s->n < wide_block_order ? 4 : 8;
    s->block = s->block < SL_LANCZOS_MAX_BLOCK ? s->block : SL_LANCZOS_MAX_BLOCK;
    const int64_t least = s->wanted + 3 * (int64_t)s->block;
    int64_t basis = def->max_basis > 0 ? def->max_basis : 4 * (int64_t)s->wanted + 5 * (int64_t)s->block;
    basis = basis > least ? basis : least;
    *dense = s->n <= dense_order || s->null_count + basis + 2 * s->block > s->n;
    s->max_basis = *dense ? 0 : (int32_t)basis;
    s->info.block = *dense ? 0 : s->block;
}

static sl_status allocate(sl_lanczos *s, bool dense)
{
    const int64_t n = s->n, b = s->block, m = s->max_basis, w = s->wanted, columns = s->null_count + m + b;
    const int64_t gram = w * w > b * b ? w * w : b * b;
    s->X = sl_calloc(n * s->count, sizeof *s->X);
    s->lambda = sl_calloc(s->count, sizeof *s->lambda);
    s->residual = sl_calloc(s->count, sizeof *s->residual);
    s->Z = sl_alloc(n * b, sizeof *s->Z);
    s->Q = sl_alloc(n * (dense ? s->null_count : columns), sizeof *s->Q);
    if (s->X == NULL || s->lambda == NULL || s->residual == NULL || s->Z == NULL || s->Q == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    if (dense) {
        return SL_OK;
    }
    s->T = sl_calloc(m * m, sizeof *s->T);
    s->R = sl_alloc(b * b, sizeof *s->R);
    s->S = sl_alloc(m * m, sizeof *s->S);
    s->theta = sl_alloc(m, sizeof *s->theta);
    s->H = sl_alloc(2 * columns * b, sizeof *s->H);
    s->chunk = sl_alloc(sl_lanczos_rotation_work(s), sizeof *s->chunk);
    s->G = sl_alloc(gram, sizeof *s->G);
    s->lapack = sl_alloc(1 + 6 * m + 2 * m * m, sizeof *s->lapack);
    s->lapack_int = sl_alloc(3 + 5 * m, sizeof *s->lapack_int);
    s->verify_lambda = sl_alloc(w, sizeof *s->verify_lambda);
    const bool ok = s->T != NULL && s->R != NULL && s->S != NULL && s->theta != NULL && s->H != NULL &&
                    s->chunk != NULL && s->G != NULL && s->lapack != NULL && s->lapack_int != NULL &&
                    s->verify_lambda != NULL;
    return ok ? SL_OK : SL_OUT_OF_MEMORY;
}

/* Factors A - sigma I. */
static sl_status factor_shifted(sl_lanczos *s, const sl_lanczos_def *def)
{
    sl_cholesky_def options = sl_cholesky_default();
    options.xyz = def->xyz;
    options.perm = def->perm;
    sl_csc M = *s->A;
    sl_status status = SL_OK;
    M.val = sl_copy(s->A->val, s->A->colptr[s->n], sizeof *M.val);
    SL_TRY(M.val != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t j = 0; j < s->n; j++) {
        M.val[M.colptr[j]] -= s->sigma;
    }
    SL_TRY(sl_cholesky_analyze(&M, &options, &s->factor));
    SL_TRY(sl_cholesky_factor(s->factor, &M, NULL));
    const int32_t sides = s->wanted > s->block ? s->wanted : s->block;
    s->solve_work = sl_alloc(sl_cholesky_work_size(s->factor, sides), sizeof *s->solve_work);
    SL_TRY(s->solve_work != NULL ? SL_OK : SL_OUT_OF_MEMORY);
cleanup:
    sl_free(M.val);
    return status;
}

sl_status sl_lanczos_create(const sl_csc *A, const sl_lanczos_def *def, const sl_context *context, sl_lanczos **out)
{
    const sl_lanczos_def defaults = sl_lanczos_default();
    double *spare = NULL;
    sl_lanczos *s = NULL;
    bool dense = false;
    sl_status status = SL_OK;
    *out = NULL;
    def = def != NULL ? def : &defaults;
    SL_TRY(check_arguments(A, def));
    s = sl_calloc(1, sizeof *s);
    spare = sl_alloc(A->ncols, sizeof *spare);
    SL_TRY(s != NULL && spare != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    s->n = A->ncols;
    s->A = A;
    s->context = context;
    s->rng = sl_rng_seed(def->seed);
    s->tolerance = def->tolerance;
    s->norm = norm1_symmetric(A, spare);
    s->norm = s->norm > 0.0 ? s->norm : 1.0;
    s->sigma = -sigma_share * s->norm;
    SL_TRY(is_null_space(A, def->null_space, def->null_count, s->norm, spare) ? SL_OK : SL_BAD_INPUT);
    choose_sizes(s, def, &dense);
    SL_TRY(allocate(s, dense));
    if (s->null_count > 0) {
        memcpy(s->Q, def->null_space, (size_t)s->n * (size_t)s->null_count * sizeof *s->Q);
    }
    if (dense) {
        SL_TRY(sl_lanczos_solve_dense(s));
    } else {
        SL_TRY(sl_report_progress(context, "factor", 0.0));
        SL_TRY(factor_shifted(s, def));
        sl_lanczos_random_block(s);
    }
    *out = s;
cleanup:
    sl_free(spare);
    if (status != SL_OK) {
        sl_lanczos_free(s);
    }
    return status;
}

/* Block steps after which a random start in the complement of the pairs found shows a missed one: Chebyshev growth over
 * the gap of one block, which Weyl's law puts at about block / wanted, must lift it out of all n. */
static int32_t verification_steps(const sl_lanczos *s)
{
    const double gap = (double)s->block / s->wanted;
    const double steps = ceil(log(20.0 * sqrt(s->n)) / (2.0 * sqrt(gap)));
    const int32_t room = (s->max_basis - s->wanted) / s->block;
    return steps < room ? (int32_t)steps : room;
}

/* Keeps the converged pairs alone and starts anew beside them. */
static void begin_verification(sl_lanczos *s)
{
    for (int32_t k = 0; k < s->wanted; k++) {
        s->verify_lambda[k] = sl_lanczos_lambda(s, s->theta[k]);
    }
    sl_lanczos_restart(s, s->wanted);
    sl_lanczos_random_block(s);
    s->verifying = true;
    s->verify_left = verification_steps(s);
}

/* Whether a value fell by more than the tolerance lets it: then another pair has pushed in. */
static bool found_missed_pair(const sl_lanczos *s)
{
    for (int32_t k = 0; k < s->wanted; k++) {
        if (sl_lanczos_lambda(s, s->theta[k]) < s->verify_lambda[k] - 2.0 * s->tolerance * s->norm) {
            return true;
        }
    }
    return false;
}

/* One filling of the basis, or less when the end is reached. Leaves Ritz vectors in V. */
static sl_status fill_basis(sl_lanczos *s)
{
    sl_status status = SL_OK;
    bool more = false;
    int32_t converged = 0;
    while (!s->finished && !more && s->size + s->block <= s->max_basis) {
        SL_TRY(sl_report_progress(s->context, "eigenvectors", (double)converged / s->wanted));
        sl_lanczos_expand(s);
        if (s->verifying && --s->verify_left > 0) {
            continue;
        }
        if (s->size < s->wanted) {
            continue;
        }
        SL_TRY(sl_lanczos_ritz(s));
        converged = sl_lanczos_count_converged(s);
        if (s->verifying) {
            /* A copy of the last value may have mixed in before it converged: that takes another filling, too. */
            s->verifying = false;
            s->finished = converged == s->wanted && !found_missed_pair(s);
            more = !s->finished;
        } else if (converged == s->wanted) {
            begin_verification(s);
        }
    }
    const int32_t beyond = s->wanted / 2 > s->block ? s->wanted / 2 : s->block;
    int32_t kept = s->wanted + (s->finished ? 0 : beyond);
    kept = kept < s->max_basis - 2 * s->block ? kept : s->max_basis - 2 * s->block;
    sl_lanczos_restart(s, kept < s->size ? kept : s->size);
    s->info.restarts += !s->finished;
cleanup:
    return status;
}

sl_status sl_lanczos_step(sl_lanczos *s, int32_t n)
{
    sl_status status = SL_OK;
    if (s->info.dense || s->finished) {
        return SL_OK;
    }
    s->finished = s->wanted == 0;
    for (int32_t k = 0; k < n && !s->finished; k++) {
        SL_TRY(fill_basis(s));
    }
    SL_TRY(sl_lanczos_extract(s));
    for (int32_t k = 0; k < max_polish && s->finished && !s->info.converged; k++) {
        SL_TRY(sl_lanczos_polish(s));
    }
cleanup:
    return status;
}

const sl_lanczos_info *sl_lanczos_info_of(const sl_lanczos *solver)
{
    return &solver->info;
}

void sl_lanczos_result(const sl_lanczos *s, double *lambda, double *vectors, double *residual)
{
    memcpy(lambda, s->lambda, (size_t)s->count * sizeof *lambda);
    memcpy(vectors, s->X, (size_t)s->n * (size_t)s->count * sizeof *vectors);
    if (residual != NULL) {
        memcpy(residual, s->residual, (size_t)s->count * sizeof *residual);
    }
}

void sl_lanczos_free(sl_lanczos *s)
{
    if (s == NULL) {
        return;
    }
    sl_cholesky_free(s->factor);
    sl_free(s->solve_work);
    sl_free(s->Q);
    sl_free(s->T);
    sl_free(s->R);
    sl_free(s->S);
    sl_free(s->theta);
    sl_free(s->H);
    sl_free(s->Z);
    sl_free(s->chunk);
    sl_free(s->G);
    sl_free(s->lapack);
    sl_free(s->lapack_int);
    sl_free(s->verify_lambda);
    sl_free(s->X);
    sl_free(s->lambda);
    sl_free(s->residual);
    sl_free(s);
}

sl_status sl_lanczos_solve(const sl_csc *A, const sl_lanczos_def *def, const sl_context *context, double *lambda,
                           double *vectors, double *residual, sl_lanczos_info *info)
{
    const sl_lanczos_def defaults = sl_lanczos_default();
    sl_lanczos *solver = NULL;
    sl_status status = SL_OK;
    def = def != NULL ? def : &defaults;
    SL_TRY(sl_lanczos_create(A, def, context, &solver));
    SL_TRY(sl_lanczos_step(solver, def->max_restarts + 1));
    sl_lanczos_result(solver, lambda, vectors, residual);
    if (info != NULL) {
        *info = solver->info;
    }
cleanup:
    sl_lanczos_free(solver);
    return status;
}
