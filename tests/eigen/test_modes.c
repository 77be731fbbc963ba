#include "pairs.h"

/* A grid whose unknowns carry their places. */
static double *grid_points(int32_t w, int32_t h)
{
    double *xyz = sl_alloc(3 * (int64_t)w * h, sizeof *xyz);
    assert_non_null(xyz);
    for (int32_t i = 0; i < w * h; i++) {
        xyz[3 * i] = i % w;
        xyz[3 * i + 1] = i / w;
        xyz[3 * i + 2] = 0.01 * (i % 7);
    }
    return xyz;
}

/* Restarted on the separators or not, the same pairs come out; only the first uses the factor's top part. */
static void the_skeleton_finds_what_the_plain_start_finds(void **state)
{
    (void)state;
    enum { W = 97, H = 83, COUNT = 20 };
    sl_csc *A = grid_laplacian(W, H, false);
    double *ones = constant_vector(A->ncols), *xyz = grid_points(W, H), *exact = grid_spectrum(W, H, false);
    for (int start = SL_START_PLAIN; start <= SL_START_SKELETON; start++) {
        for (int32_t deflate = 0; deflate < 2; deflate++) {
            sl_lanczos_def def = sl_lanczos_default();
            def.count = COUNT;
            def.start = (sl_lanczos_start)start;
            def.xyz = xyz;
            def.null_space = ones;
            def.null_count = deflate;
            def.patch = 40;
            pairs p = pairs_of(A, &def);
            assert_sound(A, &p, def.tolerance);
            assert_true(p.info.certified);
            assert_int_equal(p.info.patch, start == SL_START_SKELETON ? 40 : 0);
            assert_true((p.info.skeleton_solves > 0) == (start == SL_START_SKELETON));
            for (int32_t k = 0; k < COUNT; k++) {
                assert_true(test_near(p.lambda[k], exact[k], 1e-12));
            }
            pairs_clear(&p);
        }
    }
    sl_free(exact);
    sl_free(ones);
    sl_free(xyz);
    sl_csc_free(A);
}

/* ||A v - lambda v|| <= sign_tolerance lambda, recomputed here, by either start; and the signs are those of the exact
 * vectors wherever these are not small. */
static void signs_are_right_at_the_price_of_signs(void **state)
{
    (void)state;
    enum { W = 101, H = 73, COUNT = 12 };
    sl_csc *A = grid_laplacian(W, H, false);
    const int32_t n = A->ncols;
    double *ones = constant_vector(n), *xyz = grid_points(W, H), *y = sl_alloc(n, sizeof *y);
    assert_non_null(y);
    sl_lanczos_def def = sl_lanczos_default();
    def.count = COUNT;
    def.xyz = xyz;
    def.null_space = ones;
    def.null_count = 1;
    def.tolerance = 1e-11;
    pairs exact = pairs_of(A, &def);
    def.tolerance = 1e-8;
    def.mode = SL_LANCZOS_SIGNS;
    for (int start = SL_START_PLAIN; start <= SL_START_SKELETON; start++) {
        def.start = (sl_lanczos_start)start;
        pairs p = pairs_of(A, &def);
        assert_true(p.info.converged && p.info.certified);
        assert_true(p.info.solves + p.info.skeleton_solves < exact.info.solves + 80);
        double worst = 0.0;
        for (int32_t k = 1; k < COUNT; k++) {
            const double *v = p.vectors + (int64_t)n * k, *e = exact.vectors + (int64_t)n * k;
            double squares = 0.0, dot = 0.0;
            sl_csc_multiply_symmetric(A, v, 1, y);
            for (int32_t i = 0; i < n; i++) {
                squares += (y[i] - p.lambda[k] * v[i]) * (y[i] - p.lambda[k] * v[i]);
                dot += v[i] * e[i];
            }
            worst = fmax(worst, sqrt(squares) / p.lambda[k]);
            for (int32_t i = 0; i < n; i++) {
                assert_true(fabs(e[i]) < 0.05 / sqrt(n) || (v[i] * dot > 0.0) == (e[i] > 0.0));
            }
        }
        assert_true(worst <= def.sign_tolerance);
        assert_true(test_near(worst, p.info.max_relative, 1e-9));
        pairs_clear(&p);
    }
    pairs_clear(&exact);
    sl_free(y);
    sl_free(ones);
    sl_free(xyz);
    sl_csc_free(A);
}

/* Corrected pairs need one inverse iteration for residuals of a thousandth of lambda; without the correction it would
 * leave twice as much. For 1e-8 a few steps more do, and no other start. */
static void corrected_pairs_need_one_inverse_iteration(void **state)
{
    (void)state;
    enum { W = 163, H = 157, COUNT = 16 };
    sl_csc *A = grid_laplacian(W, H, false);
    double *ones = constant_vector(A->ncols), *xyz = grid_points(W, H), *exact = grid_spectrum(W, H, false);
    sl_lanczos_def def = sl_lanczos_default();
    def.count = COUNT;
    def.xyz = xyz;
    def.null_space = ones;
    def.null_count = 1;
    def.start = SL_START_SKELETON;
    def.mode = SL_LANCZOS_SIGNS;
    def.patch = 80;
    def.sign_tolerance = 8e-4;
    pairs p = pairs_of(A, &def);
    assert_true(p.info.converged && p.info.certified);
    assert_int_equal(p.info.iterations, 1);
    pairs_clear(&p);
    def.mode = SL_LANCZOS_TOLERANCE;
    p = pairs_of(A, &def);
    assert_sound(A, &p, def.tolerance);
    assert_true(p.info.iterations > 1 && p.info.iterations < 8 && p.info.restarts == 0);
    assert_true(p.info.solves < 8 * 24); /* and not those of a plain start besides */
    for (int32_t k = 0; k < COUNT; k++) {
        assert_true(test_near(p.lambda[k], exact[k], 1e-12));
    }
    pairs_clear(&p);
    sl_free(exact);
    sl_free(ones);
    sl_free(xyz);
    sl_csc_free(A);
}

static void tolerances_down_to_rounding_are_met(void **state)
{
    (void)state;
    sl_csc *A = grid_laplacian(47, 38, false), *cube = cube_facet_laplacian(8);
    double *exact = grid_spectrum(47, 38, false);
    for (int exponent = 4; exponent <= 14; exponent += 2) {
        sl_lanczos_def def = sl_lanczos_default();
        double *ones = constant_vector(A->ncols), *cube_ones = constant_vector(cube->ncols);
        def.tolerance = pow(10.0, -exponent);
        def.count = 16;
        def.null_count = 1;
        def.null_space = ones;
        pairs p = pairs_of(A, &def);
        assert_sound(A, &p, def.tolerance);
        for (int32_t k = 0; k < p.count; k++) {
            assert_true(test_near(p.lambda[k], exact[k], 8.0 * fmax(def.tolerance, 1e-14)));
        }
        pairs_clear(&p);
        def.null_space = cube_ones;
        p = pairs_of(cube, &def);
        assert_sound(cube, &p, def.tolerance);
        pairs_clear(&p);
        sl_free(ones);
        sl_free(cube_ones);
    }
    sl_free(exact);
    sl_csc_free(cube);
    sl_csc_free(A);
}

/* The limit is refused below the estimate and kept to above it; dense problems have an estimate, too. */
static void a_memory_limit_is_kept(void **state)
{
    (void)state;
    for (int32_t side = 10; side <= 60; side += 50) {
        sl_csc *A = grid_laplacian(side, side + 3, false);
        sl_lanczos_def def = sl_lanczos_default();
        def.count = 10;
        pairs p = pairs_of(A, &def);
        assert_true(p.info.memory > 8 * 10 * (int64_t)A->ncols);
        sl_lanczos *solver = NULL;
        const int64_t limits[] = {1, p.info.memory / 3, p.info.memory - 1};
        for (size_t k = 0; k < SL_COUNTOF(limits); k++) {
            def.memory_limit = limits[k];
            assert_int_equal(sl_lanczos_create(A, &def, NULL, &solver), SL_LIMIT);
            assert_null(solver);
        }
        def.memory_limit = p.info.memory;
        assert_int_equal(sl_lanczos_create(A, &def, NULL, &solver), SL_OK);
        sl_lanczos_free(solver);
        pairs_clear(&p);
        sl_csc_free(A);
    }
}

static void results_do_not_depend_on_workers(void **state)
{
    (void)state;
    enum { W = 110, H = 90, COUNT = 10 };
    sl_csc *A = grid_laplacian(W, H, false);
    double *xyz = grid_points(W, H);
    sl_lanczos_def def = sl_lanczos_default();
    def.count = COUNT;
    def.xyz = xyz;
    for (int start = SL_START_PLAIN; start <= SL_START_SKELETON; start++) {
        def.start = (sl_lanczos_start)start;
        pairs p = pairs_of(A, &def);
        for (int32_t workers = 2; workers <= 5; workers += 3) {
            double lambda[COUNT], *vectors = sl_alloc(COUNT * (int64_t)A->ncols, sizeof *vectors);
            sl_thread_pool *pool = NULL;
            assert_non_null(vectors);
            assert_int_equal(sl_thread_pool_create(workers, &pool), SL_OK);
            const sl_context context = {.executor = sl_thread_pool_executor(pool)};
            assert_int_equal(sl_lanczos_solve(A, &def, &context, lambda, vectors, NULL, NULL), SL_OK);
            assert_memory_equal(lambda, p.lambda, sizeof lambda);
            assert_memory_equal(vectors, p.vectors, COUNT * (size_t)A->ncols * sizeof *vectors);
            sl_thread_pool_free(pool);
            sl_free(vectors);
        }
        pairs_clear(&p);
    }
    sl_free(xyz);
    sl_csc_free(A);
}

/* Empty, one unknown, and everything the definition may get wrong. */
static void edges_of_the_input_have_their_answers(void **state)
{
    (void)state;
    graph none = graph_create(0, 1), one = graph_create(1, 1);
    sl_csc *empty = graph_laplacian(&none, NULL), *single = graph_laplacian(&one, NULL);
    sl_csc *A = grid_laplacian(20, 21, false);
    sl_lanczos_def def = sl_lanczos_default();
    pairs p = pairs_of(empty, &def);
    assert_true(p.info.converged);
    pairs_clear(&p);
    single->val[0] = 2.5;
    p = pairs_of(single, &def);
    assert_true(p.lambda[0] == 2.5 && p.vectors[0] == 1.0 && p.info.certified);
    pairs_clear(&p);
    sl_lanczos *solver = NULL;
    sl_lanczos_def bad[6] = {def, def, def, def, def, def};
    bad[0].tolerance = 1e-15;
    bad[1].tolerance = 1.0;
    bad[2].sign_tolerance = 0.0;
    bad[3].sign_tolerance = NAN;
    bad[4].memory_limit = -1;
    bad[5].patch = -1;
    for (size_t k = 0; k < SL_COUNTOF(bad); k++) {
        assert_int_equal(sl_lanczos_create(A, &bad[k], NULL, &solver), SL_BAD_INPUT);
        assert_null(solver);
    }
    A->val[11] = INFINITY;
    assert_int_equal(sl_lanczos_create(A, &def, NULL, &solver), SL_BAD_INPUT);
    A->val[11] = -1.0;
    const int32_t row = A->row[1];
    A->row[1] = A->row[2];
    A->row[2] = row;
    assert_int_equal(sl_lanczos_create(A, &def, NULL, &solver), SL_BAD_INPUT);
    assert_null(solver);
    sl_csc_free(empty);
    sl_csc_free(single);
    sl_csc_free(A);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_skeleton_finds_what_the_plain_start_finds),
        cmocka_unit_test(signs_are_right_at_the_price_of_signs),
        cmocka_unit_test(corrected_pairs_need_one_inverse_iteration),
        cmocka_unit_test(tolerances_down_to_rounding_are_met),
        cmocka_unit_test(a_memory_limit_is_kept),
        cmocka_unit_test(results_do_not_depend_on_workers),
        cmocka_unit_test(edges_of_the_input_have_their_answers),
    };
    return cmocka_run_group_tests(tests, one_blas_thread, NULL);
}
