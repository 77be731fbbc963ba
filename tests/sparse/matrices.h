/* Random symmetric positive definite matrices of the structures that break sparse solvers. */
#ifndef SL_TEST_SPARSE_MATRICES_H
#define SL_TEST_SPARSE_MATRICES_H

#include "base/memory.h"
#include "sparse/csc.h"
#include "support/test_support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef enum matrix_kind {
    MATRIX_DIAGONAL,
    MATRIX_PATH,
    MATRIX_TREE,
    MATRIX_GRID, /* n is rounded down to a square */
    MATRIX_RANDOM,
    MATRIX_ARROW, /* three hubs joined to everything */
    MATRIX_DENSE,
    MATRIX_DISCONNECTED, /* cliques, lone nodes and paths */
    MATRIX_KINDS
} matrix_kind;

typedef struct triplets {
    int64_t count;
    int32_t *row, *col;
    double *val;
} triplets;

static inline triplets triplets_create(int64_t room)
{
    triplets t = {0, sl_alloc(room, sizeof *t.row), sl_alloc(room, sizeof *t.col), sl_alloc(room, sizeof *t.val)};
    assert_true(t.row != NULL && t.col != NULL && t.val != NULL);
    return t;
}

static inline void triplets_free(triplets *t)
{
    sl_free(t->row);
    sl_free(t->col);
    sl_free(t->val);
}

static inline void triplets_add(triplets *t, int32_t row, int32_t col, double val)
{
    t->row[t->count] = row;
    t->col[t->count] = col;
    t->val[t->count++] = val;
}

/* An entry of random sign between two different nodes in the lower triangle, and the weight it needs on the diagonal.
 */
static inline void triplets_join(triplets *t, const int32_t *label, int32_t a, int32_t b, test_rng *rng)
{
    const int32_t i = label[a], j = label[b];
    const double value = test_uniform(rng, 0.1, 2.0) * (test_index(rng, 3) == 0 ? 1.0 : -1.0);
    triplets_add(t, i > j ? i : j, i > j ? j : i, value);
    triplets_add(t, i, i, fabs(value));
    triplets_add(t, j, j, fabs(value));
}

static inline void triplets_of_kind(triplets *t, matrix_kind kind, int32_t n, const int32_t *label, test_rng *rng)
{
    const int32_t side = (int32_t)sqrt((double)n);
    for (int32_t i = 1; i < n; i++) {
        switch (kind) {
        case MATRIX_PATH:
            triplets_join(t, label, i - 1, i, rng);
            break;
        case MATRIX_TREE:
            triplets_join(t, label, test_index(rng, i), i, rng);
            break;
        case MATRIX_GRID:
            if (i % side != 0) {
                triplets_join(t, label, i - 1, i, rng);
            }
            if (i >= side) {
                triplets_join(t, label, i - side, i, rng);
            }
            break;
        case MATRIX_RANDOM:
            triplets_join(t, label, test_index(rng, i), i, rng);
            triplets_join(t, label, test_index(rng, i), i, rng);
            break;
        case MATRIX_ARROW:
            for (int32_t hub = 0; hub < 3 && hub < i; hub++) {
                triplets_join(t, label, hub, i, rng);
            }
            break;
        case MATRIX_DENSE:
            for (int32_t j = 0; j < i; j++) {
                triplets_join(t, label, j, i, rng);
            }
            break;
        case MATRIX_DISCONNECTED:
            for (int32_t j = i / 7 * 7; j < i && i % 3 != 0; j++) {
                triplets_join(t, label, j, i, rng);
            }
            break;
        default:
            break;
        }
    }
}

static inline int32_t matrix_order(matrix_kind kind, int32_t n)
{
    const int32_t side = (int32_t)sqrt((double)n);
    return kind == MATRIX_GRID ? side * side : n;
}

/* Lower triangle, rows and columns shuffled; diagonally dominant by `margin` at least. The caller frees it. */
static inline sl_csc *random_spd(matrix_kind kind, int32_t n, double margin, test_rng *rng)
{
    n = matrix_order(kind, n);
    const int64_t edges = kind == MATRIX_DENSE ? (int64_t)n * n / 2 : 7 * (int64_t)n;
    triplets t = triplets_create(3 * edges + n + 1);
    int32_t *label = sl_alloc(n, sizeof *label);
    assert_non_null(label);
    for (int32_t i = 0; i < n; i++) {
        const int32_t k = test_index(rng, i + 1);
        label[i] = label[k];
        label[k] = i;
    }
    triplets_of_kind(&t, kind, n, label, rng);
    for (int32_t i = 0; i < n; i++) {
        triplets_add(&t, i, i, margin * test_uniform(rng, 1.0, 2.0));
    }
    sl_csc *A = NULL;
    assert_int_equal(sl_csc_from_triplets(n, n, t.count, t.row, t.col, t.val, &A), SL_OK);
    triplets_free(&t);
    sl_free(label);
    return A;
}

/* Full column-major copy of a symmetric matrix; entry (i, j) is A(perm[i], perm[j]), perm NULL = as it is. */
static inline double *dense_symmetric(const sl_csc *A, const int32_t *perm)
{
    const int32_t n = A->ncols;
    double *D = sl_calloc((int64_t)n * n, sizeof *D);
    int32_t *place = sl_alloc(n, sizeof *place);
    assert_true(D != NULL && place != NULL);
    for (int32_t k = 0; k < n; k++) {
        place[perm != NULL ? perm[k] : k] = k;
    }
    for (int32_t j = 0; j < n; j++) {
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            const int32_t a = place[A->row[p]], b = place[j];
            D[(int64_t)b * n + a] = D[(int64_t)a * n + b] = A->val[p];
        }
    }
    sl_free(place);
    return D;
}

static inline double *random_doubles(int64_t count, test_rng *rng)
{
    double *x = sl_alloc(count, sizeof *x);
    assert_non_null(x);
    for (int64_t i = 0; i < count; i++) {
        x[i] = test_uniform(rng, -1.0, 1.0);
    }
    return x;
}

static inline double max_abs(const double *x, int64_t count)
{
    double largest = 0.0;
    for (int64_t i = 0; i < count; i++) {
        largest = fmax(largest, fabs(x[i]));
    }
    return largest;
}

static inline void assert_permutation(const int32_t *perm, int32_t n)
{
    bool *seen = sl_calloc(n, sizeof *seen);
    assert_non_null(seen);
    for (int32_t k = 0; k < n; k++) {
        assert_in_range(perm[k], 0, n - 1);
        assert_false(seen[perm[k]]);
        seen[perm[k]] = true;
    }
    sl_free(seen);
}

#endif
