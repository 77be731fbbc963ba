/* Matrices of square blocks: analysed on the graph of the blocks, they are factored as if each unknown stood alone. */
#include "matrices.h"

#include "sparse/blocks.h"
#include "sparse/cholesky.h"

/* Each entry of G becomes a full block of random numbers, the diagonal dominant. */
static sl_csc *random_blocks(const sl_csc *G, int32_t block, test_rng *rng)
{
    const int32_t b = block;
    const int64_t nnz = G->colptr[G->ncols];
    triplets t = triplets_create(3 * b * b * nnz);
    for (int32_t J = 0; J < G->ncols; J++) {
        for (int64_t p = G->colptr[J]; p < G->colptr[J + 1]; p++) {
            for (int32_t e = 0; e < b * b; e++) {
                const int32_t i = b * G->row[p] + e / b, j = b * J + e % b;
                const double x = test_uniform(rng, -2.0, 2.0);
                if (i >= j) {
                    triplets_add(&t, i, j, i == j ? 0.3 : x);
                }
                if (i > j) {
                    triplets_add(&t, i, i, fabs(x));
                    triplets_add(&t, j, j, fabs(x));
                }
            }
        }
    }
    sl_csc *A = NULL;
    assert_int_equal(sl_csc_from_triplets(b * G->ncols, b * G->ncols, t.count, t.row, t.col, t.val, &A), SL_OK);
    triplets_free(&t);
    return A;
}

static double *solution_of(const sl_csc *A, sl_cholesky *F, test_rng rng)
{
    double *X = random_doubles(3 * (int64_t)A->ncols, &rng),
           *work = sl_alloc(sl_cholesky_work_size(F, 3), sizeof *work);
    assert_non_null(work);
    assert_int_equal(sl_cholesky_factor_shifted(F, A, -0.125, NULL, NULL), SL_OK);
    sl_cholesky_solve(F, X, 3, work);
    sl_free(work);
    return X;
}

static void blocks_are_factored_to_the_bytes_of_their_unknowns(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xb10c);
    for (int trial = 0; trial < 6 * MATRIX_KINDS * test_multiplier(); trial++) {
        const int32_t block = 1 + trial % 4;
        sl_csc *G = random_spd((matrix_kind)(trial % MATRIX_KINDS), 1 + test_index(&rng, 180), 0.3, &rng);
        sl_csc *A = random_blocks(G, block, &rng);
        const int32_t n = A->ncols;
        int32_t *perm = sl_alloc(n, sizeof *perm);
        assert_non_null(perm);
        assert_int_equal(sl_order(G, SL_ORDER_NESTED_DISSECTION, NULL, perm), SL_OK);
        sl_cholesky_def def = sl_cholesky_default();
        sl_cholesky *F = NULL, *one = NULL;
        def.patch = trial % 3 == 0 ? 1 + test_index(&rng, 40) : 0;
        def.ordering = SL_ORDER_NESTED_DISSECTION;
        def.block = block;
        assert_int_equal(sl_cholesky_analyze(A, &def, &F), SL_OK);
        sl_block_expand(G->ncols, block, perm);
        def.block = 1;
        def.perm = perm;
        assert_int_equal(sl_cholesky_analyze(A, &def, &one), SL_OK);
        assert_permutation(sl_cholesky_permutation(F), n);
        assert_memory_equal(sl_cholesky_permutation(F), sl_cholesky_permutation(one), (size_t)n * sizeof *perm);
        assert_int_equal(sl_cholesky_nnz(F), sl_cholesky_nnz(one));
        assert_int_equal(sl_cholesky_top_first(F), sl_cholesky_top_first(one));
        double *X = solution_of(A, F, rng), *Y = solution_of(A, one, rng);
        assert_memory_equal(X, Y, 3 * (size_t)n * sizeof *X);
        sl_free(X);
        sl_free(Y);
        sl_free(perm);
        sl_cholesky_free(F);
        sl_cholesky_free(one);
        sl_csc_free(A);
        sl_csc_free(G);
    }
}

static void the_pattern_of_blocks_is_found_again(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x9a7);
    for (int kind = 0; kind < MATRIX_KINDS; kind++) {
        sl_csc *G = random_spd((matrix_kind)kind, 60, 0.3, &rng), *A = random_blocks(G, 3, &rng);
        sl_csc found;
        assert_int_equal(sl_block_pattern(A, 3, &found), SL_OK);
        assert_int_equal(found.ncols, G->ncols);
        assert_int_equal(found.nrows, G->nrows);
        assert_memory_equal(found.colptr, G->colptr, ((size_t)G->ncols + 1) * sizeof *G->colptr);
        assert_memory_equal(found.row, G->row, (size_t)G->colptr[G->ncols] * sizeof *G->row);
        sl_block_pattern_clear(&found);
        sl_csc_free(A);
        sl_csc_free(G);
    }
}

/* A without the entry at p. */
static sl_csc *without(const sl_csc *A, int64_t p)
{
    const int64_t nnz = A->colptr[A->ncols];
    triplets t = triplets_create(nnz);
    for (int32_t j = 0; j < A->ncols; j++) {
        for (int64_t q = A->colptr[j]; q < A->colptr[j + 1]; q++) {
            if (q != p) {
                triplets_add(&t, A->row[q], j, A->val[q]);
            }
        }
    }
    sl_csc *B = NULL;
    assert_int_equal(sl_csc_from_triplets(A->nrows, A->ncols, t.count, t.row, t.col, t.val, &B), SL_OK);
    triplets_free(&t);
    return B;
}

static void a_block_with_a_hole_is_bad_input(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x401e);
    sl_csc *G = random_spd(MATRIX_GRID, 25, 0.3, &rng), *A = random_blocks(G, 2, &rng);
    sl_cholesky_def def = sl_cholesky_default();
    sl_cholesky *F = NULL;
    for (int64_t p = 0; p < A->colptr[A->ncols]; p++) {
        sl_csc *B = without(A, p);
        def.block = 2;
        assert_int_equal(sl_cholesky_analyze(B, &def, &F), SL_BAD_INPUT);
        assert_null(F);
        sl_csc_free(B);
    }
    const int32_t bad[] = {-2, 0, 3, 4}; /* 50 is no multiple of these; none of the patterns has blocks of 5 */
    for (size_t k = 0; k < SL_COUNTOF(bad); k++) {
        def.block = bad[k];
        assert_int_equal(sl_cholesky_analyze(A, &def, &F), SL_BAD_INPUT);
        assert_null(F);
    }
    def.block = 5;
    assert_int_equal(sl_cholesky_analyze(A, &def, &F), SL_BAD_INPUT);
    assert_null(F);
    sl_csc_free(A);
    sl_csc_free(G);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blocks_are_factored_to_the_bytes_of_their_unknowns),
        cmocka_unit_test(the_pattern_of_blocks_is_found_again),
        cmocka_unit_test(a_block_with_a_hole_is_bad_input),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
