#include "base/memory.h"
#include "eigen/kernel.h"
#include "eigen/panel.h"
#include "pairs.h"

static double *random_numbers(test_rng *rng, int64_t count)
{
    double *x = sl_alloc(count, sizeof *x);
    assert_non_null(x);
    for (int64_t i = 0; i < count; i++) {
        x[i] = test_uniform(rng, -1.0, 1.0);
    }
    return x;
}

/* The chosen instruction set against plain loops: every width, odd and even rows, sums that were not zero before. */
static void kernels_agree_with_plain_loops(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x6e12e1);
    for (int trial = 0; trial < 40 * test_multiplier(); trial++) {
        const int32_t w = trial % 2 == 0 ? 4 : 8;
        const int64_t rows = test_index(&rng, 70);
        double *P = random_numbers(&rng, 8 * rows), *W = random_numbers(&rng, w * rows);
        double *H = random_numbers(&rng, 8 * w), *sum = sl_copy(H, 8 * w, sizeof *H);
        double *G = random_numbers(&rng, w * w), *self = sl_copy(G, w * w, sizeof *G);
        double *after = sl_copy(W, w * rows, sizeof *W), *turned = sl_copy(W, w * rows, sizeof *W);
        assert_true(sum && self && after && turned);
        sl_kernel_gram(P, W, rows, w, sum);
        sl_kernel_self(W, rows, w, self);
        sl_kernel_add(P, H, rows, w, after);
        sl_kernel_triangle(G, rows, w, turned);
        for (int32_t c = 0; c < w; c++) {
            for (int32_t i = 0; i < 8; i++) {
                double expected = H[i * w + c];
                for (int64_t r = 0; r < rows; r++) {
                    expected += P[8 * r + i] * W[r * w + c];
                }
                assert_true(test_near(sum[i * w + c], expected, 1e-14));
            }
            for (int32_t i = 0; i < w; i++) {
                double expected = G[i * w + c];
                for (int64_t r = 0; r < rows; r++) {
                    expected += W[r * w + i] * W[r * w + c];
                }
                assert_true(test_near(self[i * w + c], expected, 1e-14));
            }
            for (int64_t r = 0; r < rows; r++) {
                double added = W[r * w + c], product = 0.0;
                for (int32_t i = 0; i < 8; i++) {
                    added += P[8 * r + i] * H[i * w + c];
                }
                for (int32_t i = 0; i < w; i++) {
                    product += W[r * w + i] * G[i * w + c];
                }
                assert_true(test_near(after[r * w + c], added, 1e-15));
                assert_true(test_near(turned[r * w + c], product, 1e-15));
            }
        }
        double *const all[] = {P, W, H, sum, G, self, after, turned};
        for (size_t k = 0; k < SL_COUNTOF(all); k++) {
            sl_free(all[k]);
        }
    }
}

/* Enough rows for several chunks. */
enum { ROWS = 9001 };

/* Of sums over all rows of products of numbers below 1. */
static const double rounding = ROWS * TEST_EPS;

static sl_panels random_panels(test_rng *rng, int32_t columns, sl_precision precision)
{
    sl_panels M;
    assert_int_equal(sl_panels_create(ROWS, columns, precision, &M), SL_OK);
    double *x = random_numbers(rng, (int64_t)ROWS * columns);
    for (int32_t k = 0; k < columns; k += 3) {
        sl_panels_store(&M, k, x + (int64_t)k * ROWS, columns - k < 3 ? columns - k : 3);
    }
    sl_free(x);
    return M;
}

static double entry(const sl_panels *M, int64_t r, int32_t k)
{
    const int64_t at = ((int64_t)(k / SL_PANEL) * M->rows + r) * SL_PANEL + k % SL_PANEL;
    return M->single != NULL ? (double)M->single[at] : M->data[at];
}

static void blocks_are_stored_and_loaded_across_panels(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x570e);
    sl_panels M = random_panels(&rng, 21, SL_DOUBLE);
    double *W = random_numbers(&rng, 8 * ROWS), *V = random_numbers(&rng, 8 * ROWS);
    for (int32_t at = 0; at <= 13; at++) {
        const int32_t w = at % 2 == 0 ? 8 : 4;
        const double before = at > 0 ? entry(&M, 77, at - 1) : 0.0, behind = entry(&M, 77, at + w);
        sl_panels_store(&M, at, W, w);
        sl_panels_load(&M, at, V, w);
        assert_memory_equal(V, W, (size_t)(w * ROWS) * sizeof *V);
        assert_true(entry(&M, 4321, at + 2) == W[4321 * w + 2]);
        assert_true((at == 0 || entry(&M, 77, at - 1) == before) && entry(&M, 77, at + w) == behind);
    }
    sl_panels taken;
    assert_int_equal(sl_panels_take(&M, 9, &taken), SL_OK);
    assert_null(M.data);
    assert_int_equal(taken.columns, 9);
    sl_panels_clear(&taken);
    sl_free(W);
    sl_free(V);
}

/* Stored in single precision entries come back rounded, and stay where they were when a part is taken over. */
static void single_panels_round_what_is_stored(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x51961e);
    sl_panels M, taken;
    double *W = random_numbers(&rng, 8 * ROWS), *V = random_numbers(&rng, 8 * ROWS);
    assert_int_equal(sl_panels_create(ROWS, 21, SL_SINGLE, &M), SL_OK);
    assert_true(2 * sl_panels_bytes(ROWS, 21, SL_SINGLE) < sl_panels_bytes(ROWS, 21, SL_DOUBLE) + 128);
    for (int32_t at = 0; at <= 13; at++) {
        const int32_t w = at % 2 == 0 ? 8 : 4;
        sl_panels_store(&M, at, W, w);
        sl_panels_load(&M, at, V, w);
        for (int64_t i = 0; i < (int64_t)w * ROWS; i++) {
            assert_true(V[i] == (double)(float)W[i]);
        }
    }
    const double kept = entry(&M, 123, 8);
    const sl_panels rest = sl_panels_from(&M, 1);
    assert_true(rest.columns == 13 && entry(&rest, 123, 0) == kept);
    assert_int_equal(sl_panels_take(&M, 9, &taken), SL_OK);
    assert_true(taken.data == NULL && entry(&taken, 123, 8) == kept);
    sl_panels_clear(&taken);
    sl_free(W);
    sl_free(V);
}

static void a_unit_vector_is_removed_from_a_panel(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x2e30e);
    double *v = random_numbers(&rng, ROWS), *W = random_numbers(&rng, 8 * ROWS), *before = NULL;
    double length = 0.0;
    for (int32_t i = 0; i < ROWS; i++) {
        length += v[i] * v[i];
    }
    for (int32_t i = 0; i < ROWS; i++) {
        v[i] /= sqrt(length);
    }
    before = sl_copy(W, 8 * ROWS, sizeof *W);
    assert_non_null(before);
    sl_panel_remove(ROWS, v, W, NULL);
    for (int32_t c = 0; c < 8; c++) {
        double share = 0.0, left = 0.0;
        for (int64_t i = 0; i < ROWS; i++) {
            share += v[i] * before[8 * i + c];
            left += v[i] * W[8 * i + c];
        }
        assert_true(fabs(left) < rounding);
        assert_true(test_near(W[8 * 777 + c], before[8 * 777 + c] - share * v[777], 1e-13));
    }
    sl_free(v);
    sl_free(W);
    sl_free(before);
}

/* After W -= Q (Q'W) against columns that are orthonormal nothing is left in them, whatever the number of workers. */
static void project_and_subtract(sl_precision precision)
{
    test_rng rng = test_rng_seed(0x9109ec);
    enum { COLUMNS = 13, W8 = 8 };
    sl_panels M = random_panels(&rng, COLUMNS, precision);
    double *W = random_numbers(&rng, W8 * ROWS), *V = random_numbers(&rng, W8 * ROWS);
    double *partial = sl_alloc(sl_panels_partial_size(ROWS, COLUMNS), sizeof *partial);
    assert_non_null(partial);
    double first[2][16 * W8], G0[W8 * W8];
    double *W0 = sl_copy(W, W8 * ROWS, sizeof *W);
    const int32_t workers[] = {1, 2, 5};
    for (size_t k = 0; k < SL_COUNTOF(workers); k++) {
        sl_thread_pool *pool = NULL;
        assert_int_equal(sl_thread_pool_create(workers[k], &pool), SL_OK);
        const sl_context context = {.executor = sl_thread_pool_executor(pool)};
        double H[2][16 * W8], G[W8 * W8];
        double *X = sl_copy(W0, W8 * ROWS, sizeof *X), *Y = sl_copy(V, W8 * ROWS, sizeof *Y);
        assert_true(X && Y);
        const sl_panel_pair pair = {W8, {X, Y}, {H[0], H[1]}};
        sl_panels_project(&M, COLUMNS, &pair, partial, &context);
        for (int32_t i = 0; i < COLUMNS; i++) {
            double dot = 0.0;
            for (int64_t r = 0; r < ROWS; r++) {
                dot += entry(&M, r, i) * V[r * W8 + 5];
            }
            assert_true(test_near(H[1][i * W8 + 5], dot, rounding));
        }
        assert_true(H[0][COLUMNS * W8 + 3] == 0.0);
        sl_panels_subtract(&M, COLUMNS, &pair, partial, G, &context);
        double left = W0[4500 * W8 + 2];
        for (int32_t i = 0; i < COLUMNS; i++) {
            left -= entry(&M, 4500, i) * H[0][i * W8 + 2];
        }
        assert_true(test_near(X[4500 * W8 + 2], left, 1e-13));
        if (k == 0) {
            memcpy(first, H, sizeof H);
            memcpy(G0, G, sizeof G);
            memcpy(W, X, (size_t)(W8 * ROWS) * sizeof *W);
        }
        assert_memory_equal(first, H, sizeof H);
        assert_memory_equal(G0, G, sizeof G);
        assert_memory_equal(W, X, (size_t)(W8 * ROWS) * sizeof *W);
        sl_free(X);
        sl_free(Y);
        sl_thread_pool_free(pool);
    }
    sl_free(W0);
    sl_free(W);
    sl_free(V);
    sl_free(partial);
    sl_panels_clear(&M);
}

static void projection_leaves_nothing_and_never_depends_on_workers(void **state)
{
    (void)state;
    project_and_subtract(SL_DOUBLE);
    project_and_subtract(SL_SINGLE);
}

static void rotate_and_compare(sl_precision precision)
{
    test_rng rng = test_rng_seed(0x207a7e);
    const double error = precision == SL_SINGLE ? 1e-6 : 1e-14;
    sl_panels M = random_panels(&rng, 19, precision), to, wide;
    assert_int_equal(sl_panels_create(ROWS, 11, precision, &to), SL_OK);
    assert_int_equal(sl_panels_create(ROWS, 11, SL_DOUBLE, &wide), SL_OK);
    double *C = random_numbers(&rng, 19 * 11);
    assert_int_equal(sl_panels_rotate(&M, 19, C, 11, &to, NULL), SL_OK);
    assert_int_equal(sl_panels_rotate(&M, 19, C, 11, &wide, NULL), SL_OK);
    for (int64_t r = 0; r < ROWS; r += 500) {
        for (int32_t k = 0; k < 11; k++) {
            double sum = 0.0;
            for (int32_t i = 0; i < 19; i++) {
                sum += entry(&M, r, i) * C[k * 19 + i];
            }
            assert_true(test_near(entry(&to, r, k), sum, error));
            assert_true(test_near(entry(&wide, r, k), sum, 1e-14));
        }
        assert_true(entry(&to, r, 11) == 0.0);
    }
    assert_int_equal(sl_panels_rotate(&M, 19, C, 11, NULL, NULL), SL_OK);
    const void *turned = M.single != NULL ? (const void *)M.single : M.data;
    const void *elsewhere = to.single != NULL ? (const void *)to.single : to.data;
    assert_memory_equal(turned, elsewhere, (precision == SL_SINGLE ? sizeof(float) : sizeof(double)) * 16 * ROWS);
    sl_panels_clear(&M);
    sl_panels_clear(&to);
    sl_panels_clear(&wide);
    sl_free(C);
}

static void rotation_is_the_product_in_place_or_elsewhere(void **state)
{
    (void)state;
    rotate_and_compare(SL_DOUBLE);
    rotate_and_compare(SL_SINGLE);
}

static void gram_matrices_and_residuals_agree_with_the_matrix(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x62a3);
    enum { COLUMNS = 10 };
    sl_csc *A = grid_laplacian(1, ROWS, false);
    for (int64_t p = 0; p < A->colptr[ROWS]; p++) {
        A->val[p] = test_uniform(&rng, -1.0, 1.0);
    }
    int32_t *perm = sl_alloc(ROWS, sizeof *perm);
    assert_non_null(perm);
    for (int32_t i = 0; i < ROWS; i++) { /* 2 and 9001 have no common factor */
        perm[i] = (int32_t)(2 * (int64_t)i % ROWS);
    }
    sl_rows rows;
    assert_int_equal(sl_rows_create(A, perm, &rows), SL_OK);
    sl_panels M = random_panels(&rng, COLUMNS, SL_DOUBLE);
    double XX[COLUMNS * COLUMNS], XAX[COLUMNS * COLUMNS], norm[COLUMNS];
    double *lambda = random_numbers(&rng, COLUMNS);
    assert_int_equal(sl_panels_grams(&M, COLUMNS, &rows, XX, XAX, NULL), SL_OK);
    assert_int_equal(sl_panels_residuals(&M, COLUMNS, &rows, lambda, norm, NULL), SL_OK);
    double *x = sl_alloc(ROWS, sizeof *x), *y = sl_alloc(ROWS, sizeof *y);
    assert_true(x && y);
    for (int32_t k = 0; k < COLUMNS; k++) {
        double squares = 0.0;
        for (int32_t i = 0; i < ROWS; i++) {
            x[perm[i]] = entry(&M, i, k);
        }
        sl_csc_multiply_symmetric(A, x, 1, y);
        for (int32_t i = 0; i < ROWS; i++) {
            squares += (y[i] - lambda[k] * x[i]) * (y[i] - lambda[k] * x[i]);
        }
        assert_true(test_near(norm[k], sqrt(squares), 16 * rounding));
        for (int32_t j = 0; j < COLUMNS; j++) {
            double dot = 0.0, energy = 0.0;
            for (int32_t i = 0; i < ROWS; i++) {
                dot += entry(&M, i, j) * x[perm[i]];
                energy += entry(&M, i, j) * y[perm[i]];
            }
            assert_true(test_near(XX[k * COLUMNS + j], dot, 16 * rounding));
            assert_true(test_near(XAX[k * COLUMNS + j], energy, 16 * rounding));
        }
    }
    sl_free(x);
    sl_free(y);
    sl_free(lambda);
    sl_free(perm);
    sl_rows_clear(&rows);
    sl_panels_clear(&M);
    sl_csc_free(A);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(kernels_agree_with_plain_loops),
        cmocka_unit_test(blocks_are_stored_and_loaded_across_panels),
        cmocka_unit_test(single_panels_round_what_is_stored),
        cmocka_unit_test(a_unit_vector_is_removed_from_a_panel),
        cmocka_unit_test(projection_leaves_nothing_and_never_depends_on_workers),
        cmocka_unit_test(rotation_is_the_product_in_place_or_elsewhere),
        cmocka_unit_test(gram_matrices_and_residuals_agree_with_the_matrix),
    };
    return cmocka_run_group_tests(tests, one_blas_thread, NULL);
}
