#include "matrices.h"

#include "sparse/elimination.h"
#include "sparse/supernode.h"

/* Pattern of L by plain elimination of the whole matrix: fill[j * n + i], i >= j. */
static bool *dense_fill(const sl_csc *A, const int32_t *place)
{
    const int32_t n = A->ncols;
    bool *L = sl_calloc((int64_t)n * n, sizeof *L);
    assert_non_null(L);
    for (int32_t j = 0; j < n; j++) {
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            const int32_t a = place[j], b = place[A->row[p]];
            L[(a < b ? a : b) * n + (a < b ? b : a)] = true;
        }
    }
    for (int32_t k = 0; k < n; k++) {
        for (int32_t j = k + 1; j < n; j++) {
            for (int32_t i = j; i < n && L[k * n + j]; i++) {
                L[j * n + i] |= L[k * n + i];
            }
        }
    }
    return L;
}

typedef struct analysis {
    int32_t n;
    int32_t *place, *parent, *post, *count, *work;
    int64_t *next;
    sl_half half;
} analysis;

static analysis analysis_create(const sl_csc *A)
{
    const int64_t n = A->ncols;
    analysis a = {.n = A->ncols};
    a.place = sl_alloc(n, sizeof *a.place);
    a.parent = sl_alloc(n, sizeof *a.parent);
    a.post = sl_alloc(n, sizeof *a.post);
    a.count = sl_alloc(n, sizeof *a.count);
    a.work = sl_alloc(4 * n, sizeof *a.work);
    a.next = sl_alloc(n, sizeof *a.next);
    a.half.first = sl_alloc(n + 1, sizeof *a.half.first);
    a.half.index = sl_alloc(A->colptr[n], sizeof *a.half.index);
    assert_true(a.place && a.parent && a.post && a.count && a.work && a.next && a.half.first && a.half.index);
    for (int32_t k = 0; k < a.n; k++) {
        a.place[k] = k;
    }
    return a;
}

static void analysis_clear(analysis *a)
{
    sl_free(a->place);
    sl_free(a->parent);
    sl_free(a->post);
    sl_free(a->count);
    sl_free(a->work);
    sl_free(a->next);
    sl_free(a->half.first);
    sl_free(a->half.index);
}

static void build_tree(const sl_csc *A, analysis *a)
{
    sl_half_upper(A, a->place, a->next, &a->half);
    sl_elimination_tree(a->n, &a->half, a->parent, a->work);
}

static void check_tree(const analysis *a, const bool *L)
{
    for (int32_t j = 0; j < a->n; j++) {
        int32_t first = -1;
        for (int32_t i = a->n - 1; i > j; i--) {
            first = L[j * a->n + i] ? i : first;
        }
        assert_int_equal(a->parent[j], first);
    }
}

/* Every subtree is a run that ends at its root. */
static void check_postorder(const analysis *a)
{
    int32_t *rank = sl_alloc(a->n, sizeof *rank), *size = sl_calloc(a->n, sizeof *size);
    assert_true(rank && size);
    assert_permutation(a->post, a->n);
    for (int32_t k = 0; k < a->n; k++) {
        rank[a->post[k]] = k;
    }
    for (int32_t k = 0; k < a->n; k++) {
        const int32_t node = a->post[k], up = a->parent[node];
        size[node]++;
        if (up != -1) {
            assert_true(rank[up] > k);
            size[up] += size[node];
        }
    }
    for (int32_t v = 0; v < a->n; v++) {
        const int32_t up = a->parent[v];
        assert_true(up == -1 || rank[v] > rank[up] - size[up]);
    }
    sl_free(rank);
    sl_free(size);
}

static void check_counts(const analysis *a, const bool *L)
{
    for (int32_t j = 0; j < a->n; j++) {
        int32_t count = 0;
        for (int32_t i = j; i < a->n; i++) {
            count += L[j * a->n + i];
        }
        assert_int_equal(a->count[j], count);
    }
}

/* Supernodes in the partition's order: runs of columns whose rows below fit `below`, parents after children. */
static void check_partition(const sl_csc *A, const analysis *a, const sl_partition *part)
{
    int32_t *place = sl_alloc(a->n, sizeof *place);
    assert_non_null(place);
    assert_permutation(part->order, a->n);
    for (int32_t k = 0; k < a->n; k++) {
        place[part->order[k]] = k;
    }
    for (int32_t k = 0; k < a->n; k++) { /* the tree's labels to A's, and on to the partition's */
        a->work[a->post[k]] = place[k];
    }
    bool *L = dense_fill(A, a->work);
    assert_int_equal(part->first[0], 0);
    assert_int_equal(part->first[part->count], a->n);
    for (int32_t s = 0; s < part->count; s++) {
        int32_t below = 0, entries = 0;
        assert_true(part->first[s] < part->first[s + 1]);
        assert_true(part->parent[s] == -1 || part->parent[s] > s);
        for (int32_t i = part->first[s + 1]; i < a->n; i++) {
            bool any = false;
            for (int32_t j = part->first[s]; j < part->first[s + 1]; j++) {
                any |= L[j * a->n + i];
            }
            below += any;
        }
        for (int32_t j = part->first[s]; j < part->first[s + 1]; j++) {
            for (int32_t i = j; i < a->n; i++) {
                entries += L[j * a->n + i];
            }
        }
        const int32_t width = part->first[s + 1] - part->first[s], stored = width * (width + 1) / 2 + width * below;
        assert_true(stored - entries <= (width <= 4    ? 0.5
                                         : width <= 8  ? 0.4
                                         : width <= 16 ? 0.25
                                         : width <= 48 ? 0.1
                                                       : 0.03) *
                                            stored);
        assert_int_equal(below, part->below[s]);
        assert_int_equal(below == 0, part->parent[s] == -1);
    }
    sl_free(L);
    sl_free(place);
}

static void tree_counts_and_supernodes_agree_with_dense_elimination(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xe11a);
    for (int trial = 0; trial < 12 * MATRIX_KINDS * test_multiplier(); trial++) {
        sl_csc *A = random_spd((matrix_kind)(trial % MATRIX_KINDS), 1 + test_index(&rng, 70), 0.3, &rng);
        analysis a = analysis_create(A);
        build_tree(A, &a);
        bool *L = dense_fill(A, a.place);
        check_tree(&a, L);
        sl_free(L);
        sl_postorder(a.n, a.parent, a.post, a.work);
        check_postorder(&a);
        for (int32_t k = 0; k < a.n; k++) {
            a.place[a.post[k]] = k;
        }
        build_tree(A, &a); /* of the postordered matrix */
        sl_half_lower(A, a.place, a.next, &a.half);
        sl_column_counts(a.n, &a.half, a.parent, a.count, a.work);
        L = dense_fill(A, a.place);
        check_tree(&a, L);
        check_counts(&a, L);
        sl_free(L);
        sl_partition part;
        assert_int_equal(sl_partition_create(a.n, 1, a.parent, a.count, &part), SL_OK);
        check_partition(A, &a, &part);
        sl_partition_clear(&part);
        analysis_clear(&a);
        sl_csc_free(A);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tree_counts_and_supernodes_agree_with_dense_elimination),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
