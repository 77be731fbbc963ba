#include "eigen/band.h"
#include "pairs.h"

/* Bands against all known values: none missed, none twice, vectors orthonormal across bands. Frees A and exact. */
static void expect_bands(sl_csc *A, double *exact, int32_t count, int32_t band)
{
    const int32_t n = A->ncols;
    double *ones = constant_vector(n);
    sl_band_def def = sl_band_default();
    def.count = count;
    def.band = band;
    def.first.null_space = ones;
    def.first.null_count = 1;
    pairs p = {.n = n, .count = count < n ? count : n};
    sl_band_info info;
    p.lambda = sl_alloc(p.count, sizeof *p.lambda);
    p.residual = sl_alloc(p.count, sizeof *p.residual);
    p.vectors = sl_alloc((int64_t)n * p.count, sizeof *p.vectors);
    assert_true(p.lambda && p.residual && p.vectors);
    assert_int_equal(sl_lanczos_bands(A, &def, NULL, p.lambda, p.vectors, p.residual, &info), SL_OK);
    assert_true(info.converged && info.certified);
    assert_int_equal(info.found, p.count);
    assert_true(info.bands >= (p.count + 2 * band - 1) / (2 * band));
    p.info.converged = true;
    p.info.converged_count = p.count;
    p.info.max_residual = info.max_residual;
    assert_orthonormal(&p, 1e-6); /* across bands right angles are as good as residual over distance */
    assert_residuals(A, &p, def.first.tolerance);
    for (int32_t k = 0; k < p.count; k++) {
        assert_true(test_near(p.lambda[k], exact[k], 1e-11));
    }
    pairs_clear(&p);
    sl_free(ones);
    sl_free(exact);
    sl_csc_free(A);
}

static void bands_hold_every_value_of_closed_spectra(void **state)
{
    (void)state;
    expect_bands(grid_laplacian(33, 29, false), grid_spectrum(33, 29, false), 150, 30);
    expect_bands(path_laplacian(900, false), path_spectrum(900, false), 120, 25);
    expect_bands(grid_laplacian(41, 40, false), grid_spectrum(41, 40, false), 60, 60); /* one band */
}

static void bands_hold_every_copy_of_multiple_values(void **state)
{
    (void)state;
    expect_bands(grid_laplacian(24, 24, true), grid_spectrum(24, 24, true), 90, 20);
    expect_bands(path_laplacian(600, true), path_spectrum(600, true), 101, 24);
}

/* The facet graph of an icosphere has values of multiplicity 3, 4 and 5 at every turn: 201 pairs of 5,120 against
 * those found at once. */
static void bands_find_what_one_run_finds(void **state)
{
    (void)state;
    sl_csc *A = icosphere_facet_laplacian(4);
    sl_band_def def = sl_band_default();
    double *ones = constant_vector(A->ncols);
    def.count = 201;
    def.first.count = def.count;
    def.first.null_space = ones;
    def.first.null_count = 1;
    pairs whole = pairs_of(A, &def.first), p = {.n = A->ncols, .count = def.count};
    sl_band_info info;
    p.lambda = sl_alloc(p.count, sizeof *p.lambda);
    p.residual = sl_alloc(p.count, sizeof *p.residual);
    p.vectors = sl_alloc((int64_t)p.n * p.count, sizeof *p.vectors);
    assert_true(p.lambda && p.residual && p.vectors && whole.info.certified);
    assert_int_equal(sl_lanczos_bands(A, &def, NULL, p.lambda, p.vectors, p.residual, &info), SL_OK);
    assert_true(info.converged && info.certified && info.found == def.count && info.bands >= 4);
    for (int32_t k = 0; k < p.count; k++) {
        assert_true(test_near(p.lambda[k], whole.lambda[k], 1e-11));
    }
    p.info.converged = true;
    p.info.converged_count = p.count;
    p.info.max_residual = info.max_residual;
    assert_residuals(A, &p, def.first.tolerance);
    assert_orthonormal(&p, 1e-5);
    pairs_clear(&p);
    pairs_clear(&whole);
    sl_free(ones);
    sl_csc_free(A);
}

static bool refuse(void *user, const char *stage, double fraction)
{
    int32_t *calls = user;
    (void)stage;
    (void)fraction;
    return --*calls > 0;
}

static void bands_refuse_and_may_be_cancelled(void **state)
{
    (void)state;
    sl_csc *A = grid_laplacian(30, 31, false);
    sl_band_def def = sl_band_default();
    double lambda[60], *vectors = sl_alloc(60 * (int64_t)A->ncols, sizeof *vectors);
    assert_non_null(vectors);
    def.count = 60;
    def.band = 7;
    assert_int_equal(sl_lanczos_bands(A, &def, NULL, lambda, vectors, NULL, NULL), SL_BAD_INPUT);
    def.band = 20;
    def.count = -1;
    assert_int_equal(sl_lanczos_bands(A, &def, NULL, lambda, vectors, NULL, NULL), SL_BAD_INPUT);
    def.count = 60;
    def.first.memory_limit = 1000;
    assert_int_equal(sl_lanczos_bands(A, &def, NULL, lambda, vectors, NULL, NULL), SL_LIMIT);
    def.first.memory_limit = 0;
    sl_band_info info;
    assert_int_equal(sl_lanczos_bands(A, &def, NULL, lambda, vectors, NULL, &info), SL_OK);
    def.first.memory_limit = info.memory;
    assert_int_equal(sl_lanczos_bands(A, &def, NULL, lambda, vectors, NULL, NULL), SL_OK);
    def.first.memory_limit = info.memory - 1;
    assert_int_equal(sl_lanczos_bands(A, &def, NULL, lambda, vectors, NULL, NULL), SL_LIMIT);
    def.first.memory_limit = 0;
    sl_status status = SL_CANCELLED;
    int32_t limit = 1;
    for (; status == SL_CANCELLED && limit < 2000; limit += 7) {
        int32_t calls = limit;
        const sl_context context = {.progress = refuse, .progress_user = &calls};
        status = sl_lanczos_bands(A, &def, &context, lambda, vectors, NULL, NULL);
    }
    assert_int_equal(status, SL_OK);
    assert_true(limit > 40);
    A->val[A->colptr[77]] -= 0.4;
    assert_int_equal(sl_lanczos_bands(A, &def, NULL, lambda, vectors, NULL, NULL), SL_NOT_POSITIVE_DEFINITE);
    sl_free(vectors);
    sl_csc_free(A);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bands_hold_every_value_of_closed_spectra),
        cmocka_unit_test(bands_hold_every_copy_of_multiple_values),
        cmocka_unit_test(bands_find_what_one_run_finds),
        cmocka_unit_test(bands_refuse_and_may_be_cancelled),
    };
    return cmocka_run_group_tests(tests, one_blas_thread, NULL);
}
