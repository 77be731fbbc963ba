#include "matrices.h"

#include "sparse/cholesky.h"
#include "sparse/cholesky_internal.h"

#include <math.h>

static const int32_t workers[] = {1, 2, 5};

/* A jittered grid with its points: large enough for tasks. */
static sl_csc *grid_with_points(int32_t side, test_rng *rng, double **xyz)
{
    const int32_t n = side * side;
    triplets t = triplets_create(7 * (int64_t)n);
    *xyz = random_doubles(3 * (int64_t)n, rng);
    for (int32_t i = 0; i < n; i++) {
        (*xyz)[3 * (int64_t)i] = i % side + 0.3 * (*xyz)[3 * (int64_t)i];
        (*xyz)[3 * (int64_t)i + 1] = i / side + 0.3 * (*xyz)[3 * (int64_t)i + 1];
        for (int k = 0; k < 2; k++) {
            const int32_t j = k == 0 ? i - 1 : i - side;
            if (k == 0 ? i % side > 0 : i >= side) {
                const double weight = test_uniform(rng, 0.2, 2.0);
                triplets_add(&t, i, j, -weight);
                triplets_add(&t, i, i, weight);
                triplets_add(&t, j, j, weight);
            }
        }
        triplets_add(&t, i, i, 1e-3);
    }
    sl_csc *A = NULL;
    assert_int_equal(sl_csc_from_triplets(n, n, t.count, t.row, t.col, t.val, &A), SL_OK);
    triplets_free(&t);
    return A;
}

static sl_cholesky *analysis_of(const sl_csc *A, const double *xyz, sl_factor_kind kind)
{
    sl_cholesky_def def = sl_cholesky_default();
    sl_cholesky *F = NULL;
    def.xyz = xyz;
    def.kind = kind;
    def.patch = 80;
    assert_int_equal(sl_cholesky_analyze(A, &def, &F), SL_OK);
    assert_true(F->task_count >= 8);
    return F;
}

/* Factor, block solve by parts: X in, X out. */
static void run(sl_cholesky *F, const sl_csc *A, double sigma, const sl_context *context, double *X, int32_t w)
{
    double *work = sl_alloc(sl_cholesky_block_work_size(F, w), sizeof *work);
    assert_non_null(work);
    double *top = X + (int64_t)sl_cholesky_top_first(F) * w;
    assert_int_equal(sl_cholesky_factor_shifted(F, A, sigma, context, NULL), SL_OK);
    sl_cholesky_forward_part(F, SL_PART_BOTTOM, X, w, work, context);
    sl_cholesky_forward_part(F, SL_PART_TOP, top, w, work, context);
    sl_cholesky_backward_part(F, SL_PART_ALL, X, w, work, context);
    sl_cholesky_forward_part(F, SL_PART_ALL, X, w, work, context);
    sl_cholesky_backward_part(F, SL_PART_TOP, top, w, work, context);
    sl_cholesky_backward_part(F, SL_PART_BOTTOM, X, w, work, context);
    sl_free(work);
}

static void any_number_of_workers_orders_alike(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x04de);
    double *xyz;
    sl_csc *A = grid_with_points(120, &rng, &xyz);
    const int32_t n = A->ncols;
    int32_t *alone = sl_alloc(n, sizeof *alone), *shared = sl_alloc(n, sizeof *shared);
    assert_true(alone != NULL && shared != NULL);
    for (int points = 0; points < 2; points++) {
        assert_int_equal(sl_order(A, SL_ORDER_NESTED_DISSECTION, points == 1 ? xyz : NULL, alone), SL_OK);
        for (size_t k = 0; k < SL_COUNTOF(workers); k++) {
            sl_thread_pool *pool = NULL;
            assert_int_equal(sl_thread_pool_create(workers[k], &pool), SL_OK);
            const sl_context context = {.executor = sl_thread_pool_executor(pool)};
            memset(shared, -1, (size_t)n * sizeof *shared);
            assert_int_equal(sl_order_with(A, SL_ORDER_NESTED_DISSECTION, points == 1 ? xyz : NULL, &context, shared),
                             SL_OK);
            assert_memory_equal(shared, alone, (size_t)n * sizeof *shared);
            sl_thread_pool_free(pool);
        }
    }
    sl_free(alone);
    sl_free(shared);
    sl_free(xyz);
    sl_csc_free(A);
}

static void any_number_of_workers_gives_the_same_bytes(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x9a4a);
    double *xyz;
    sl_csc *A = grid_with_points(150, &rng, &xyz);
    for (int kind = 0; kind < 2; kind++) {
        const double sigma = kind == 0 ? -0.01 : 0.4;
        const int32_t w = kind == 0 ? 8 : 5;
        const int64_t size = (int64_t)A->ncols * w;
        sl_cholesky *F = analysis_of(A, xyz, kind == 0 ? SL_FACTOR_LLT : SL_FACTOR_LDLT);
        double *B = random_doubles(size, &rng), *X = sl_copy(B, size, sizeof *X), *Y = sl_alloc(size, sizeof *Y);
        assert_true(X != NULL && Y != NULL);
        run(F, A, sigma, NULL, X, w);
        double *L = sl_copy(F->L, F->panel[F->supernodes], sizeof *L);
        sl_inertia_info alone, shared;
        assert_int_equal(sl_inertia(F, A, 0.4, NULL, &alone), SL_OK);
        assert_true(L != NULL && alone.negative > 100 && alone.backward_error < 1e-3);
        for (size_t k = 0; k < SL_COUNTOF(workers); k++) {
            sl_thread_pool *pool = NULL;
            assert_int_equal(sl_thread_pool_create(workers[k], &pool), SL_OK);
            const sl_context context = {.executor = sl_thread_pool_executor(pool)};
            memcpy(Y, B, (size_t)size * sizeof *Y);
            run(F, A, sigma, &context, Y, w);
            assert_memory_equal(F->L, L, (size_t)F->panel[F->supernodes] * sizeof *L);
            assert_memory_equal(Y, X, (size_t)size * sizeof *X);
            memset(&shared, 0, sizeof shared);
            assert_int_equal(sl_inertia(F, A, 0.4, &context, &shared), SL_OK);
            assert_int_equal(shared.negative, alone.negative);
            assert_int_equal(shared.positive, alone.positive);
            assert_true(shared.backward_error == alone.backward_error && shared.growth == alone.growth);
            assert_true(shared.max_l == alone.max_l && shared.max_d == alone.max_d);
            sl_thread_pool_free(pool);
        }
        sl_free(L);
        sl_free(B);
        sl_free(X);
        sl_free(Y);
        sl_cholesky_free(F);
    }
    sl_free(xyz);
    sl_csc_free(A);
}

/* Tasks take supernodes of both parts; the crown alone must solve as well. */
static void solutions_by_tasks_have_small_residuals(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x4e5);
    double *xyz;
    sl_csc *A = grid_with_points(140, &rng, &xyz);
    const int32_t n = A->ncols;
    sl_cholesky *F = analysis_of(A, xyz, SL_FACTOR_LLT);
    double *B = random_doubles(3 * (int64_t)n, &rng), *X = sl_copy(B, 3 * (int64_t)n, sizeof *X);
    double *R = sl_alloc(3 * (int64_t)n, sizeof *R), *work = sl_alloc(sl_cholesky_work_size(F, 3), sizeof *work);
    assert_true(X != NULL && R != NULL && work != NULL);
    assert_int_equal(sl_cholesky_factor(F, A, NULL), SL_OK);
    sl_cholesky_solve(F, X, 3, work);
    sl_csc_multiply_symmetric(A, X, 3, R);
    const double scale = 1.0 + 8.0 * max_abs(X, 3 * (int64_t)n);
    for (int64_t i = 0; i < 3 * (int64_t)n; i++) {
        assert_true(test_near(R[i], B[i], 100 * TEST_EPS * scale));
    }
    sl_free(B);
    sl_free(X);
    sl_free(R);
    sl_free(work);
    sl_cholesky_free(F);
    sl_free(xyz);
    sl_csc_free(A);
}

typedef struct patience {
    int32_t left, asked;
} patience;

static bool wait_a_while(void *user, const char *stage, double fraction)
{
    patience *p = user;
    assert_true(stage[0] != '\0' && fraction >= 0.0 && fraction <= 1.0);
    p->asked++;
    return p->left-- > 0;
}

/* A dense front of 1,200 columns, which asks once at its end, under a tree; cancelled there, then let through. */
static void a_cancelled_factorisation_may_be_repeated(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xcace1);
    sl_csc *A = random_spd(MATRIX_DENSE, 1200, 0.3, &rng);
    sl_cholesky *F = NULL;
    sl_inertia_info info;
    assert_int_equal(sl_cholesky_analyze(A, NULL, &F), SL_OK);
    for (int32_t left = 0; left < 2; left++) {
        patience p = {left, 0};
        const sl_context context = {.progress = wait_a_while, .progress_user = &p};
        const sl_status want = left == 0 ? SL_CANCELLED : SL_OK;
        assert_int_equal(sl_cholesky_factor_shifted(F, A, 0.0, &context, NULL), want);
        assert_int_equal(p.asked, 1);
        p = (patience){left, 0};
        assert_int_equal(sl_inertia(F, A, 0.0, &context, &info), want);
    }
    assert_int_equal(info.negative, 0);
    sl_cholesky_free(F);
    sl_csc_free(A);
}

static void the_first_bad_pivot_is_told_whatever_the_workers(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xf145);
    double *xyz;
    sl_csc *A = grid_with_points(130, &rng, &xyz);
    sl_cholesky *F = analysis_of(A, xyz, SL_FACTOR_LLT);
    sl_thread_pool *pool = NULL;
    assert_int_equal(sl_thread_pool_create(3, &pool), SL_OK);
    const sl_context context = {.executor = sl_thread_pool_executor(pool)};
    for (int trial = 0; trial < 8; trial++) {
        const double sigma = test_uniform(&rng, 0.01, 0.5);
        int32_t alone = -1, shared = -2;
        assert_int_equal(sl_cholesky_factor_shifted(F, A, sigma, NULL, &alone), SL_NOT_POSITIVE_DEFINITE);
        assert_int_equal(sl_cholesky_factor_shifted(F, A, sigma, &context, &shared), SL_NOT_POSITIVE_DEFINITE);
        assert_int_equal(alone, shared);
    }
    sl_thread_pool_free(pool);
    sl_cholesky_free(F);
    sl_free(xyz);
    sl_csc_free(A);
}

/* The bound from a stored factor, row by row: gamma |L| |L'| e. */
static double bound_from_factor(const sl_cholesky *F)
{
    double *sum = sl_calloc(F->n, sizeof *sum), largest = 0.0;
    int32_t *length = sl_calloc(F->n, sizeof *length);
    assert_true(sum != NULL && length != NULL);
    for (int32_t s = 0; s < F->supernodes; s++) {
        const int32_t width = sl_supernode_width(F, s), below = sl_supernode_below(F, s);
        for (int32_t k = 0; k < width; k++) {
            double column = 0.0;
            for (int pass = 0; pass < 2; pass++) { /* the column's sum, then what it adds to the rows */
                for (int32_t i = k; i < width + below; i++) {
                    const int32_t r = i >= width ? F->below[F->below_first[s] + i - width] : F->first[s] + i;
                    const int32_t row = r >= 0 ? r : F->outside[F->outside_first[F->task[s]] - 1 - r];
                    const int64_t at = i < width ? sl_own_place(width, i, k)
                                                 : sl_own_size(width) + sl_below_place(width, below, i - width, k);
                    const double stored = fabs(F->L[F->panel[s] + at]), l = i == k ? 1.0 / stored : stored;
                    column += pass == 0 ? l : 0.0;
                    sum[row] += pass == 1 ? l * column : 0.0;
                    length[row] += pass;
                }
            }
        }
    }
    for (int32_t i = 0; i < F->n; i++) {
        largest = fmax(largest, (length[i] + 4.0) * 0.5 * TEST_EPS * sum[i]);
    }
    sl_free(sum);
    sl_free(length);
    return largest;
}

static void error_bounds_are_those_of_the_stored_factor(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xe44);
    double *xyz;
    sl_csc *A = grid_with_points(125, &rng, &xyz);
    sl_cholesky *F = analysis_of(A, xyz, SL_FACTOR_LDLT);
    for (int trial = 0; trial < 4; trial++) {
        const double sigma = test_uniform(&rng, -0.1, 0.2);
        sl_inertia_info info;
        assert_int_equal(sl_inertia(F, A, sigma, NULL, &info), SL_OK);
        assert_int_equal(sl_cholesky_factor_shifted(F, A, sigma, NULL, NULL), SL_OK);
        const double bound = bound_from_factor(F) + 0.5 * TEST_EPS * info.max_a;
        assert_true(fabs(info.backward_error / bound - 1.0) < 1e-9);
    }
    sl_cholesky_free(F);
    sl_free(xyz);
    sl_csc_free(A);
}

/* Each row below a supernode of a task is in the task or in its list of rows outside; the tasks are apart. */
static void tasks_are_whole_subtrees(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x7a5c);
    double *xyz;
    sl_csc *A = grid_with_points(120, &rng, &xyz);
    sl_cholesky *F = analysis_of(A, xyz, SL_FACTOR_LLT);
    int32_t *owner = sl_alloc(F->n, sizeof *owner);
    assert_non_null(owner);
    for (int32_t s = 0; s < F->supernodes; s++) {
        for (int32_t k = F->first[s]; k < F->first[s + 1]; k++) {
            owner[k] = s;
        }
        const int32_t t = F->task[s], parent = F->parent[s];
        assert_true(parent == -1 || parent > s);
        if (t != -1 && F->walk[F->task_end[t] - 1] != s) {
            assert_int_equal(F->task[parent], t);
        } else if (parent != -1) {
            assert_int_equal(F->task[parent], -1);
        }
    }
    for (int32_t s = 0; s < F->supernodes; s++) {
        const int32_t t = F->task[s];
        for (int64_t p = F->below_first[s]; p < F->below_first[s + 1]; p++) {
            const int32_t row = F->below[p];
            if (row >= 0) {
                assert_true(row >= F->first[s + 1] && F->task[owner[row]] == t);
            } else {
                const int64_t at = F->outside_first[t] - 1 - row;
                assert_true(at < F->outside_first[t + 1] && F->task[owner[F->outside[at]]] == -1);
            }
        }
    }
    sl_free(owner);
    sl_cholesky_free(F);
    sl_free(xyz);
    sl_csc_free(A);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_number_of_workers_orders_alike),
        cmocka_unit_test(any_number_of_workers_gives_the_same_bytes),
        cmocka_unit_test(solutions_by_tasks_have_small_residuals),
        cmocka_unit_test(a_cancelled_factorisation_may_be_repeated),
        cmocka_unit_test(the_first_bad_pivot_is_told_whatever_the_workers),
        cmocka_unit_test(error_bounds_are_those_of_the_stored_factor),
        cmocka_unit_test(tasks_are_whole_subtrees),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
