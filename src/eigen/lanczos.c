#include "eigen/lanczos.h"

#include "base/memory.h"
#include "eigen/lanczos_internal.h"

#include <math.h>
#include <string.h>

/* sigma = -sigma_share ||A||: far enough from a zero eigenvalue to factor, nearer to it than any other that matters. */
static const double sigma_share = 1e-8;

/* A null space may be off by this much: lengths, right angles, ||A N|| / ||A||. */
static const double null_space_error = 1e-8;

static const double least_tolerance = 1e-14;

/* Block iterations are given up for a Krylov space when, at their pace, more than this many would be left. */
static const double patience = 3.0;

/* After a Krylov space they polish, and may take longer. */
static const double polish_patience = 20.0;

sl_lanczos_def sl_lanczos_default(void)
{
    return (sl_lanczos_def){
        .count = 30, .max_restarts = 50, .tolerance = 1e-8, .sign_tolerance = 2e-3, .certify = true, .seed = 1};
}

/* ||A||_1; column_sum: n. */
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
    const bool sizes = def->count >= 0 && def->block >= 0 && def->max_basis >= 0 && def->max_restarts >= 0 &&
                       def->patch >= 0 && def->memory_limit >= 0;
    const bool bounds = def->tolerance >= least_tolerance && def->tolerance < 1.0 && def->sign_tolerance > 0.0 &&
                        def->sign_tolerance < 1.0;
    const bool null_space = def->null_count >= 0 && (def->null_count == 0 || def->null_space != NULL);
    if (status != SL_OK) {
        return status;
    }
    return sizes && bounds && null_space && def->null_count <= A->ncols ? SL_OK : SL_BAD_INPUT;
}

static double dot(int32_t n, const double *x, const double *y)
{
    double sum = 0.0;
    for (int32_t i = 0; i < n; i++) {
        sum += x[i] * y[i];
    }
    return sum;
}

/* Orthonormal columns that A maps to nothing; spare: n. */
static bool is_null_space(const sl_csc *A, const double *N, int32_t count, double norm, double *spare)
{
    const int32_t n = A->ncols;
    for (int32_t k = 0; k < count; k++) {
        const double *v = N + (int64_t)n * k;
        for (int32_t j = 0; j <= k; j++) {
            if (!(fabs(dot(n, v, N + (int64_t)n * j) - (j == k)) <= null_space_error)) {
                return false;
            }
        }
        sl_csc_multiply_symmetric(A, v, 1, spare);
        if (!(sqrt(dot(n, spare, spare)) <= null_space_error * norm)) {
            return false;
        }
    }
    return true;
}

static sl_status check_memory(sl_lanczos *s, bool dense)
{
    s->info.memory = sl_lanczos_estimate(s, dense);
    return s->def.memory_limit == 0 || s->info.memory <= s->def.memory_limit ? SL_OK : SL_LIMIT;
}

static sl_status allocate(sl_lanczos *s)
{
    s->lambda = sl_calloc(s->columns, sizeof *s->lambda);
    s->residual = sl_calloc(s->columns, sizeof *s->residual);
    s->N = sl_alloc((int64_t)s->n * s->null_count, sizeof *s->N);
    s->solve_work = sl_alloc(sl_cholesky_block_work_size(s->factor, SL_PANEL), sizeof *s->solve_work);
    const bool ok = s->lambda != NULL && s->residual != NULL && s->N != NULL && s->solve_work != NULL;
    return ok ? SL_OK : SL_OUT_OF_MEMORY;
}

/* Orders and factors A - sigma I; A and the null space in the factor's order. */
static sl_status factor_shifted(sl_lanczos *s)
{
    sl_cholesky_def options = sl_cholesky_default();
    sl_status status = SL_OK;
    options.xyz = s->def.xyz;
    options.perm = s->def.perm;
    options.context = s->context;
    options.patch = s->info.patch;
    SL_TRY(sl_report_progress(s->context, "ordering", 0.0));
    SL_TRY(sl_cholesky_analyze(s->A, &options, &s->factor));
    SL_TRY(check_memory(s, false));
    SL_TRY(sl_report_progress(s->context, "factor", 0.0));
    SL_TRY(sl_cholesky_factor_shifted(s->factor, s->A, s->sigma, s->context, NULL));
    s->perm = sl_copy(sl_cholesky_permutation(s->factor), s->n, sizeof *s->perm);
    SL_TRY(s->perm != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(allocate(s));
    for (int32_t k = 0; k < s->null_count; k++) {
        double *to = s->N + (int64_t)s->n * k;
        const double *from = s->def.null_space + (int64_t)s->n * k;
        for (int32_t i = 0; i < s->n; i++) {
            to[i] = from[s->perm[i]];
        }
    }
cleanup:
    return status;
}

/* What does not depend on sizes. spare: n. */
static sl_status describe(sl_lanczos *s, const sl_csc *A, const sl_lanczos_def *def, const sl_context *context)
{
    sl_status status = SL_OK;
    double *spare = sl_alloc(A->ncols, sizeof *spare);
    SL_TRY(spare != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    s->def = *def;
    s->n = A->ncols;
    s->A = A;
    s->context = context;
    s->norm = norm1_symmetric(A, spare);
    s->norm = s->norm > 0.0 ? s->norm : 1.0;
    s->sigma = -sigma_share * s->norm;
    s->count = def->count < s->n ? def->count : s->n;
    s->null_count = def->null_count < s->count ? def->null_count : s->count;
    SL_TRY(is_null_space(A, def->null_space, def->null_count, s->norm, spare) ? SL_OK : SL_BAD_INPUT);
cleanup:
    sl_free(spare);
    return status;
}

sl_status sl_lanczos_create(const sl_csc *A, const sl_lanczos_def *def, const sl_context *context, sl_lanczos **out)
{
    const sl_lanczos_def defaults = sl_lanczos_default();
    sl_lanczos *s = NULL;
    bool dense = false;
    sl_status status = SL_OK;
    *out = NULL;
    def = def != NULL ? def : &defaults;
    SL_TRY(check_arguments(A, def));
    s = sl_calloc(1, sizeof *s);
    SL_TRY(s != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(describe(s, A, def, context));
    sl_lanczos_choose_sizes(s, &dense);
    SL_TRY(check_memory(s, dense));
    if (dense) {
        SL_TRY(sl_lanczos_solve_dense(s));
    } else {
        SL_TRY(factor_shifted(s));
    }
    *out = s;
    s = NULL;
cleanup:
    sl_lanczos_free(s);
    return status;
}

/* After pairs were found: they are done, or need more iterations, or another start. */
static void judge(sl_lanczos *s)
{
    const double worst = sl_lanczos_worst(s), before = s->previous_worst;
    s->previous_worst = worst;
    if (worst <= 1.0) {
        s->stage = SL_STAGE_CERTIFY;
        return;
    }
    s->stage = SL_STAGE_ITERATE;
    if (before <= 0.0) {
        return;
    }
    const bool plain = s->krylov_tried;
    const double left = worst < before ? log(worst) / log(before / worst) : INFINITY;
    if (left <= (plain ? polish_patience : patience)) {
        return;
    }
    s->stage = plain && s->precision == SL_DOUBLE ? SL_STAGE_DONE : SL_STAGE_KRYLOV;
    s->precision = plain ? SL_DOUBLE : s->precision;
    if (s->needed > s->wanted) { /* what holds it up may be the rest of a cluster alone */
        s->needed = s->wanted;
        if (sl_lanczos_worst(s) <= 1.0) {
            s->needed = s->columns;
            s->stage = SL_STAGE_CERTIFY;
        }
    }
}

static sl_status skeleton_step(sl_lanczos *s)
{
    bool usable = false;
    const sl_status status = sl_lanczos_skeleton(s, &usable);
    if (status == SL_OK && !usable) {
        s->info.patch = 0;
        s->stage = SL_STAGE_KRYLOV;
    } else if (status == SL_OK) {
        judge(s);
    }
    return status;
}

static sl_status take_step(sl_lanczos *s)
{
    sl_status status = SL_OK;
    if (s->released && (s->stage == SL_STAGE_KRYLOV || s->stage == SL_STAGE_ITERATE)) {
        status = sl_cholesky_factor_shifted(s->factor, s->A, s->sigma, s->context, NULL);
        s->released = status != SL_OK;
        if (status != SL_OK) {
            return status;
        }
    }
    switch (s->stage) {
    case SL_STAGE_SKELETON:
        return skeleton_step(s);
    case SL_STAGE_KRYLOV:
        s->krylov_tried = true;
        s->previous_worst = 0.0;
        return s->widest ? sl_lanczos_solve_dense(s) : sl_lanczos_fill(s);
    case SL_STAGE_ITERATE:
        status = sl_lanczos_iterate(s);
        if (status == SL_OK) {
            judge(s);
        }
        return status;
    case SL_STAGE_CERTIFY:
        return sl_lanczos_certify(s);
    case SL_STAGE_DONE:
        break;
    }
    return SL_OK;
}

sl_status sl_lanczos_step(sl_lanczos *s, int32_t n)
{
    sl_status status = SL_OK;
    for (int32_t k = 0; k < n && !sl_lanczos_finished(s); k++) {
        SL_TRY(take_step(s));
        sl_lanczos_summarise(s);
    }
cleanup:
    return status;
}

bool sl_lanczos_finished(const sl_lanczos *s)
{
    return s->stage == SL_STAGE_DONE;
}

const sl_lanczos_info *sl_lanczos_info_of(const sl_lanczos *solver)
{
    return &solver->info;
}

/* Frees what results are not made of. */
static void release(sl_lanczos *s)
{
    sl_cholesky_free(s->factor);
    s->factor = NULL;
    sl_rows_clear(&s->rows);
    sl_krylov_clear(&s->krylov);
    sl_free(s->solve_work);
    s->solve_work = NULL;
}

void sl_lanczos_free(sl_lanczos *s)
{
    if (s == NULL) {
        return;
    }
    release(s);
    sl_free(s->perm);
    sl_free(s->N);
    sl_panels_clear(&s->X);
    sl_free(s->lambda);
    sl_free(s->residual);
    sl_free(s->dense_X);
    sl_free(s->dense_lambda);
    sl_free(s->dense_residual);
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
    release(solver);
    sl_lanczos_result(solver, lambda, vectors, residual);
    if (info != NULL) {
        *info = solver->info;
    }
cleanup:
    sl_lanczos_free(solver);
    return status;
}
