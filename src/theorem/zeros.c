/* How many eigenvectors of an integer matrix do not vanish at a row: by exact arithmetic modulo a prime.
 *
 * a_k = e_f' A^k e_f = sum over distinct eigenvalues mu of mu^k ||E_mu e_f||^2, so the shortest linear recurrence of
 * the sequence has as many terms as there are mu with E_mu e_f != 0 (the weights are positive, the mu distinct).
 * Modulo a prime the recurrence can only be shorter: the rank of the Hankel matrix of the a_k cannot grow. Source:
 * Massey 1969, "Shift-register synthesis and BCH decoding"; Wiedemann 1986, "Solving sparse linear equations over
 * finite fields". */
#include "base/memory.h"
#include "theorem/theorem_internal.h"

#include <math.h>
#include <string.h>

__extension__ typedef unsigned __int128 wide;

/* The Mersenne prime 2^61 - 1: reduction is a shift and an addition. */
static const uint64_t prime = (UINT64_C(1) << 61) - 1;

static uint64_t add_mod(uint64_t a, uint64_t b)
{
    const uint64_t sum = a + b;
    return sum >= prime ? sum - prime : sum;
}

static uint64_t sub_mod(uint64_t a, uint64_t b)
{
    return a >= b ? a - b : a + prime - b;
}

static uint64_t mul_mod(uint64_t a, uint64_t b)
{
    const wide product = (wide)a * b;
    return add_mod((uint64_t)product & prime, (uint64_t)(product >> 61));
}

static uint64_t to_mod(double integer)
{
    const int64_t value = llround(integer);
    return value >= 0 ? (uint64_t)value : prime - (uint64_t)-value;
}

/* y = A x for a symmetric matrix given by its lower triangle. */
static void multiply(const sl_csc *A, const uint64_t *entry, const uint64_t *x, uint64_t *y)
{
    memset(y, 0, (size_t)A->ncols * sizeof *y);
    for (int32_t j = 0; j < A->ncols; j++) {
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            const int32_t i = A->row[p];
            y[i] = add_mod(y[i], mul_mod(entry[p], x[j]));
            if (i != j) {
                y[j] = add_mod(y[j], mul_mod(entry[p], x[i]));
            }
        }
    }
}

/* Degree of the shortest recurrence of a[0 .. count - 1] (Berlekamp, Massey), without divisions: the polynomials are
 * known up to a factor that is not 0. work: 3 (count + 1). */
static int32_t shortest_recurrence(const uint64_t *a, int32_t count, uint64_t *work)
{
    uint64_t *C = work, *B = C + count + 1, *kept = B + count + 1;
    memset(work, 0, 3 * ((size_t)count + 1) * sizeof *work);
    C[0] = B[0] = 1;
    int32_t length = 0, shift = 1, degree = 0, degree_b = 0;
    uint64_t last = 1;
    for (int32_t k = 0; k < count; k++, shift++) {
        uint64_t d = 0;
        for (int32_t i = 0; i <= degree; i++) {
            d = add_mod(d, mul_mod(C[i], a[k - i]));
        }
        if (d == 0) {
            continue;
        }
        const int32_t before = degree;
        memcpy(kept, C, ((size_t)before + 1) * sizeof *C);
        degree = degree_b + shift > degree ? degree_b + shift : degree;
        for (int32_t i = 0; i <= degree; i++) {
            C[i] = sub_mod(mul_mod(last, C[i]), i >= shift ? mul_mod(d, B[i - shift]) : 0);
        }
        if (2 * length <= k) {
            memset(B, 0, ((size_t)degree + 1) * sizeof *B);
            memcpy(B, kept, ((size_t)before + 1) * sizeof *B);
            degree_b = before;
            length = k + 1 - length;
            last = d;
            shift = 0;
        }
    }
    return length;
}

sl_status sl_distinct_at(const sl_csc *A, int32_t f, int32_t *count)
{
    const int32_t n = A->ncols, terms = 2 * n;
    const int64_t entries = A->colptr[n];
    sl_status status = SL_OK;
    uint64_t *entry = sl_alloc(entries, sizeof *entry), *vectors = sl_calloc(2 * (int64_t)n, sizeof *vectors);
    uint64_t *a = sl_alloc(terms, sizeof *a), *work = sl_alloc(3 * ((int64_t)terms + 1), sizeof *work);
    SL_TRY(entry != NULL && vectors != NULL && a != NULL && work != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int64_t p = 0; p < entries; p++) {
        entry[p] = to_mod(A->val[p]);
    }
    uint64_t *x = vectors, *y = vectors + n;
    x[f] = 1;
    for (int32_t k = 0; k < terms; k++) {
        a[k] = x[f];
        multiply(A, entry, x, y);
        uint64_t *const t = x;
        x = y;
        y = t;
    }
    *count = shortest_recurrence(a, terms, work);
cleanup:
    sl_free(entry);
    sl_free(vectors);
    sl_free(a);
    sl_free(work);
    return status;
}
