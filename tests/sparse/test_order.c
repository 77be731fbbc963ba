/* Orders of elimination: permutations, fill, inheritance. */
#include "matrices.h"

#include "sparse/cholesky.h"
#include "sparse/order.h"

static const sl_ordering orderings[] = {SL_ORDER_AUTO, SL_ORDER_NATURAL, SL_ORDER_CAMD, SL_ORDER_NESTED_DISSECTION};

static void every_ordering_is_a_permutation(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x0bde);
    const int32_t sizes[] = {0, 1, 2, 5, 161, 700};
    for (int kind = 0; kind < MATRIX_KINDS; kind++) {
        for (size_t z = 0; z < SL_COUNTOF(sizes); z++) {
            sl_csc *A = random_spd((matrix_kind)kind, sizes[z], 0.3, &rng);
            const int32_t n = A->ncols;
            double *xyz = random_doubles(3 * (int64_t)n, &rng);
            int32_t *perm = sl_alloc(n, sizeof *perm), *again = sl_alloc(n, sizeof *again);
            assert_true(perm != NULL && again != NULL);
            for (size_t o = 0; o < 2 * SL_COUNTOF(orderings); o++) {
                const double *points = o % 2 == 0 ? xyz : NULL;
                assert_int_equal(sl_order(A, orderings[o / 2], points, perm), SL_OK);
                assert_permutation(perm, n);
                assert_int_equal(sl_order(A, orderings[o / 2], points, again), SL_OK);
                assert_memory_equal(perm, again, (size_t)n * sizeof *perm);
            }
            sl_free(xyz);
            sl_free(perm);
            sl_free(again);
            sl_csc_free(A);
        }
    }
}

static void dissection_fills_a_grid_little_more_than_minimum_degree(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xf111);
    sl_csc *A = random_spd(MATRIX_GRID, 60 * 60, 0.3, &rng);
    int64_t nnz[SL_COUNTOF(orderings)];
    for (size_t o = 0; o < SL_COUNTOF(orderings); o++) {
        sl_cholesky_def def = sl_cholesky_default();
        sl_cholesky *F = NULL;
        def.ordering = orderings[o];
        assert_int_equal(sl_cholesky_analyze(A, &def, &F), SL_OK);
        nnz[o] = sl_cholesky_nnz(F);
        sl_cholesky_free(F);
    }
    assert_int_equal(nnz[0], nnz[2]);             /* no points: AUTO is CAMD */
    assert_true(2 * nnz[3] < 3 * nnz[2]);         /* dissection by breadth-first search */
    assert_true(8 * nnz[3] < nnz[1]);             /* the shuffled order is hopeless */
    assert_true(nnz[2] < 40 * (int64_t)A->ncols); /* about 31 log2(n) n / 12 for the 5-point grid */
    sl_csc_free(A);
}

static void inherited_orderings_keep_the_order_of_the_whole(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x1e41);
    for (int trial = 0; trial < 100 * test_multiplier(); trial++) {
        const int32_t n = 1 + test_index(&rng, 90);
        int32_t whole[90], subset[90], perm[90], place[90], count = 0;
        for (int32_t i = 0; i < n; i++) { /* two shuffles */
            const int32_t k = test_index(&rng, i + 1);
            whole[i] = whole[k];
            whole[k] = i;
            if (test_index(&rng, 3) > 0) {
                const int32_t at = test_index(&rng, count + 1);
                subset[count++] = subset[at];
                subset[at] = i;
            }
        }
        assert_int_equal(sl_order_inherit(n, whole, count, subset, perm), SL_OK);
        assert_permutation(perm, count);
        for (int32_t k = 0; k < n; k++) {
            place[whole[k]] = k;
        }
        for (int32_t k = 1; k < count; k++) {
            assert_true(place[subset[perm[k - 1]]] < place[subset[perm[k]]]);
        }
    }
    const int32_t whole[] = {2, 0, 1}, twice[] = {2, 0, 2}, beyond[] = {3, 0, 1};
    const int32_t good[] = {1, 2}, repeated[] = {1, 1}, outside[] = {1, 3}, negative[] = {-1, 1};
    int32_t perm[3];
    assert_int_equal(sl_order_inherit(3, whole, 2, repeated, perm), SL_BAD_INPUT);
    assert_int_equal(sl_order_inherit(3, whole, 2, outside, perm), SL_BAD_INPUT);
    assert_int_equal(sl_order_inherit(3, whole, 2, negative, perm), SL_BAD_INPUT);
    assert_int_equal(sl_order_inherit(3, whole, -1, good, perm), SL_BAD_INPUT);
    assert_int_equal(sl_order_inherit(3, twice, 2, good, perm), SL_BAD_INPUT);
    assert_int_equal(sl_order_inherit(3, beyond, 2, good, perm), SL_BAD_INPUT);
    assert_int_equal(sl_order_inherit(1, whole, 2, good, perm), SL_BAD_INPUT);
    assert_int_equal(sl_order_inherit(3, whole, 0, good, perm), SL_OK);
}

/* Against sl_order_inherit, which has no sort in it; then ranks that are not those of a permutation. */
static void ranks_order_a_part_as_the_whole_does(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x4a4c);
    for (int trial = 0; trial < 60 * test_multiplier(); trial++) {
        enum { MOST = 5000 };
        const int32_t n = 1 + test_index(&rng, trial % 2 == 0 ? 90 : MOST);
        int32_t *whole = malloc(MOST * sizeof *whole), *subset = malloc(MOST * sizeof *whole), count = 0;
        int32_t *rank = malloc(MOST * sizeof *whole), *place = malloc(MOST * sizeof *whole);
        int32_t *perm = malloc(MOST * sizeof *whole), *want = malloc(MOST * sizeof *whole);
        for (int32_t i = 0; i < n; i++) {
            const int32_t k = test_index(&rng, i + 1);
            whole[i] = whole[k];
            whole[k] = i;
            subset[count] = i;
            count += test_index(&rng, 3) > 0;
        }
        for (int32_t k = 0; k < n; k++) {
            place[whole[k]] = k;
        }
        for (int32_t i = 0; i < count; i++) {
            rank[i] = place[subset[i]];
        }
        assert_int_equal(sl_order_inherit(n, whole, count, subset, want), SL_OK);
        assert_int_equal(sl_order_by_rank(count, rank, perm), SL_OK);
        assert_memory_equal(perm, want, (size_t)count * sizeof *perm);
        for (int32_t i = 0; i < count; i++) {
            rank[i] = test_index(&rng, 3) == 0 ? 7 : test_index(&rng, INT32_MAX);
        }
        assert_int_equal(sl_order_by_rank(count, rank, perm), SL_OK);
        assert_permutation(perm, count);
        for (int32_t k = 1; k < count; k++) {
            const int32_t a = perm[k - 1], b = perm[k];
            assert_true(rank[a] < rank[b] || (rank[a] == rank[b] && a < b));
        }
        free(whole);
        free(subset);
        free(rank);
        free(place);
        free(perm);
        free(want);
    }
    int32_t perm[2];
    assert_int_equal(sl_order_by_rank(2, (const int32_t[]){3, -1}, perm), SL_BAD_INPUT);
    assert_int_equal(sl_order_by_rank(0, perm, perm), SL_OK);
}

static void bad_patterns_and_points_are_bad_input(void **state)
{
    (void)state;
    int64_t colptr[] = {0, 2, 3, 4};
    int32_t row[] = {0, 2, 1, 2}, perm[3];
    sl_csc A = {3, 3, colptr, row, NULL};
    double xyz[9] = {0.3, 0.1, 0.7, 0.9, 0.2, 0.8, 0.5, 0.6, 0.4};
    assert_int_equal(sl_order(&A, SL_ORDER_CAMD, NULL, perm), SL_OK);
    xyz[4] = NAN;
    assert_int_equal(sl_order(&A, SL_ORDER_NESTED_DISSECTION, xyz, perm), SL_BAD_INPUT);
    row[2] = 2; /* no diagonal */
    assert_int_equal(sl_order(&A, SL_ORDER_CAMD, NULL, perm), SL_BAD_INPUT);
    row[2] = 1;
    A.nrows = 4;
    assert_int_equal(sl_order(&A, SL_ORDER_NATURAL, NULL, perm), SL_BAD_INPUT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_ordering_is_a_permutation),
        cmocka_unit_test(dissection_fills_a_grid_little_more_than_minimum_degree),
        cmocka_unit_test(inherited_orderings_keep_the_order_of_the_whole),
        cmocka_unit_test(ranks_order_a_part_as_the_whole_does),
        cmocka_unit_test(bad_patterns_and_points_are_bad_input),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
