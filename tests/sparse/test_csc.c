#include "matrices.h"

/* Random general matrix with many duplicate triplets; D: the dense sum. */
static sl_csc *random_general(int32_t rows, int32_t cols, int64_t count, test_rng *rng, double *D)
{
    triplets t = triplets_create(count);
    sl_csc *A = NULL;
    memset(D, 0, (size_t)rows * (size_t)cols * sizeof *D);
    for (int64_t k = 0; k < count; k++) {
        triplets_add(&t, test_index(rng, rows), test_index(rng, cols), test_uniform(rng, -3.0, 3.0));
        D[(int64_t)t.col[k] * rows + t.row[k]] += t.val[k];
    }
    assert_int_equal(sl_csc_from_triplets(rows, cols, count, t.row, t.col, t.val, &A), SL_OK);
    triplets_free(&t);
    return A;
}

static void triplets_are_summed_into_sorted_columns(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xc5c);
    for (int trial = 0; trial < 50 * test_multiplier(); trial++) {
        const int32_t rows = 1 + test_index(&rng, 9), cols = 1 + test_index(&rng, 9);
        double D[81], seen[81] = {0};
        sl_csc *A = random_general(rows, cols, test_index(&rng, 60), &rng, D);
        assert_int_equal(sl_csc_check(A, false), SL_OK);
        for (int32_t j = 0; j < cols; j++) {
            for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
                seen[j * rows + A->row[p]] = A->val[p];
            }
        }
        for (int32_t k = 0; k < rows * cols; k++) {
            assert_true(seen[k] == D[k]); /* same order of summation: same bits */
        }
        sl_csc_free(A);
    }
}

static void triplets_out_of_range_or_not_finite_are_bad_input(void **state)
{
    (void)state;
    const int32_t good[] = {0, 2}, negative[] = {0, -1}, beyond[] = {3, 1};
    const double val[] = {0.7, -1.3}, infinite[] = {0.7, INFINITY}, nan[] = {NAN, 0.2};
    sl_csc *A = (sl_csc *)0x1;
    assert_int_equal(sl_csc_from_triplets(3, 3, 2, negative, good, val, &A), SL_BAD_INPUT);
    assert_null(A);
    assert_int_equal(sl_csc_from_triplets(3, 3, 2, beyond, good, val, &A), SL_BAD_INPUT);
    assert_int_equal(sl_csc_from_triplets(3, 3, 2, good, negative, val, &A), SL_BAD_INPUT);
    assert_int_equal(sl_csc_from_triplets(3, 3, 2, good, beyond, val, &A), SL_BAD_INPUT);
    assert_int_equal(sl_csc_from_triplets(3, 3, 2, good, good, infinite, &A), SL_BAD_INPUT);
    assert_int_equal(sl_csc_from_triplets(3, 3, 2, good, good, nan, &A), SL_BAD_INPUT);
    assert_int_equal(sl_csc_from_triplets(-1, 3, 0, good, good, val, &A), SL_BAD_INPUT);
    assert_int_equal(sl_csc_from_triplets(3, 3, -1, good, good, val, &A), SL_BAD_INPUT);
}

static void empty_matrices_are_sound(void **state)
{
    (void)state;
    sl_csc *A = NULL;
    assert_int_equal(sl_csc_from_triplets(0, 0, 0, NULL, NULL, NULL, &A), SL_OK);
    assert_int_equal(sl_csc_check(A, true), SL_OK);
    sl_csc *N = NULL;
    assert_int_equal(sl_csc_normal_matrix(A, NULL, &N), SL_OK);
    assert_int_equal(N->ncols, 0);
    sl_csc_free(N);
    sl_csc_free(A);
    sl_csc_free(NULL);
}

static void check_finds_each_flaw(void **state)
{
    (void)state;
    int64_t colptr[] = {0, 2, 4, 5};
    int32_t row[] = {0, 2, 1, 2, 2};
    double val[] = {1.5, -0.3, 2.5, 0.4, 3.5};
    sl_csc A = {3, 3, colptr, row, val};
    assert_int_equal(sl_csc_check(&A, true), SL_OK);
    assert_int_equal(sl_csc_check(NULL, false), SL_BAD_INPUT);

    row[3] = 1; /* twice the same row */
    assert_int_equal(sl_csc_check(&A, false), SL_BAD_INPUT);
    row[3] = 3; /* beyond the last row */
    assert_int_equal(sl_csc_check(&A, false), SL_BAD_INPUT);
    row[3] = 2;
    row[2] = -1;
    assert_int_equal(sl_csc_check(&A, false), SL_BAD_INPUT);
    row[2] = 0; /* above the diagonal: sound, but not lower */
    assert_int_equal(sl_csc_check(&A, false), SL_OK);
    assert_int_equal(sl_csc_check(&A, true), SL_BAD_INPUT);
    row[2] = 1;
    colptr[1] = 0; /* the first column loses its diagonal */
    assert_int_equal(sl_csc_check(&A, true), SL_BAD_INPUT);
    colptr[1] = 5; /* descending pointers */
    assert_int_equal(sl_csc_check(&A, false), SL_BAD_INPUT);
    colptr[1] = 2;
    colptr[0] = 1;
    assert_int_equal(sl_csc_check(&A, false), SL_BAD_INPUT);
    colptr[0] = 0;
    A.nrows = 4; /* not square */
    assert_int_equal(sl_csc_check(&A, false), SL_OK);
    assert_int_equal(sl_csc_check(&A, true), SL_BAD_INPUT);
    A.nrows = 3;
    val[4] = NAN;
    assert_int_equal(sl_csc_check(&A, true), SL_BAD_INPUT);
    assert_int_equal(sl_csc_check_pattern(&A, true), SL_OK);
    A.row = NULL;
    assert_int_equal(sl_csc_check_pattern(&A, true), SL_BAD_INPUT);
}

static void products_agree_with_dense_ones(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xab1e);
    for (int trial = 0; trial < 30 * test_multiplier(); trial++) {
        const int32_t rows = 1 + test_index(&rng, 20), cols = 1 + test_index(&rng, 20);
        double D[400], x[20], y[20], z[20], t[20];
        sl_csc *A = random_general(rows, cols, test_index(&rng, 150), &rng, D);
        for (int32_t i = 0; i < 20; i++) {
            x[i] = test_uniform(&rng, -1.0, 1.0);
            z[i] = test_uniform(&rng, -1.0, 1.0);
        }
        sl_csc_multiply(A, x, y);
        sl_csc_multiply_transposed(A, z, t);
        for (int32_t i = 0; i < rows; i++) {
            double sum = 0.0;
            for (int32_t j = 0; j < cols; j++) {
                sum += D[j * rows + i] * x[j];
            }
            assert_true(test_near(y[i], sum, 400 * TEST_EPS));
        }
        for (int32_t j = 0; j < cols; j++) {
            double sum = 0.0;
            for (int32_t i = 0; i < rows; i++) {
                sum += D[j * rows + i] * z[i];
            }
            assert_true(test_near(t[j], sum, 400 * TEST_EPS));
        }
        sl_csc_free(A);
    }
}

static void symmetric_product_agrees_with_a_dense_one(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x5717);
    for (int kind = 0; kind < MATRIX_KINDS; kind++) {
        sl_csc *A = random_spd((matrix_kind)kind, 40, 0.3, &rng);
        const int32_t n = A->ncols, nrhs = 3;
        double *D = dense_symmetric(A, NULL), *X = random_doubles(n * nrhs, &rng), *Y = random_doubles(n * nrhs, &rng);
        sl_csc_multiply_symmetric(A, X, nrhs, Y);
        for (int32_t c = 0; c < nrhs; c++) {
            for (int32_t i = 0; i < n; i++) {
                double sum = 0.0;
                for (int32_t j = 0; j < n; j++) {
                    sum += D[i * n + j] * X[c * n + j];
                }
                assert_true(test_near(Y[c * n + i], sum, 100 * TEST_EPS * max_abs(D, (int64_t)n * n)));
            }
        }
        sl_free(D);
        sl_free(X);
        sl_free(Y);
        sl_csc_free(A);
    }
}

static void normal_matrix_agrees_with_a_dense_triple_product(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x40a1);
    for (int trial = 0; trial < 60 * test_multiplier(); trial++) {
        const int32_t rows = 1 + test_index(&rng, 15), cols = 1 + test_index(&rng, 15);
        double D[225], w[15], seen[225] = {0};
        sl_csc *A = random_general(rows, cols, test_index(&rng, 60), &rng, D), *N = NULL;
        for (int32_t i = 0; i < 15; i++) {
            w[i] = test_uniform(&rng, 0.2, 2.0);
        }
        const bool weighted = trial % 2 == 0;
        assert_int_equal(sl_csc_normal_matrix(A, weighted ? w : NULL, &N), SL_OK);
        assert_int_equal(sl_csc_check(N, true), SL_OK); /* the whole diagonal, even of empty columns */
        for (int32_t j = 0; j < cols; j++) {
            for (int64_t p = N->colptr[j]; p < N->colptr[j + 1]; p++) {
                seen[j * cols + N->row[p]] = N->val[p];
            }
        }
        for (int32_t j = 0; j < cols; j++) {
            for (int32_t i = j; i < cols; i++) {
                double sum = 0.0;
                for (int32_t r = 0; r < rows; r++) {
                    sum += D[i * rows + r] * (weighted ? w[r] : 1.0) * D[j * rows + r];
                }
                assert_true(test_near(seen[j * cols + i], sum, 1000 * TEST_EPS));
            }
        }
        sl_csc_free(A);
        sl_csc_free(N);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(triplets_are_summed_into_sorted_columns),
        cmocka_unit_test(triplets_out_of_range_or_not_finite_are_bad_input),
        cmocka_unit_test(empty_matrices_are_sound),
        cmocka_unit_test(check_finds_each_flaw),
        cmocka_unit_test(products_agree_with_dense_ones),
        cmocka_unit_test(symmetric_product_agrees_with_a_dense_one),
        cmocka_unit_test(normal_matrix_agrees_with_a_dense_triple_product),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
