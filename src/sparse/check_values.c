/* Are values those of the analysed pattern, and finite? Every factorisation asks, so both sweeps keep several chains
 * of dependent operations going: the compiler then makes vectors of them. */
#include "sparse/front.h"

#include <math.h>
#include <string.h>

enum { LANES = 8 };

static const uint64_t hash_factor = 0x9e3779b97f4a7c15u;

/* Folds an array into four chains of multiplications; a remainder of less than a word counts as if padded by zeros. */
static void hash_bytes(const void *data, size_t bytes, uint64_t chain[4])
{
    const char *at = data;
    uint64_t word[4];
    for (; bytes >= sizeof word; bytes -= sizeof word, at += sizeof word) {
        memcpy(word, at, sizeof word);
        for (int k = 0; k < 4; k++) {
            chain[k] = (chain[k] ^ word[k]) * hash_factor;
        }
    }
    memset(word, 0, sizeof word);
    if (bytes > 0) { /* an array of nothing may be absent */
        memcpy(word, at, bytes);
    }
    for (int k = 0; k < 4; k++) {
        chain[k] = (chain[k] ^ word[k]) * hash_factor;
    }
}

uint64_t sl_pattern_hash(const sl_csc *A)
{
    uint64_t chain[4] = {0xcbf29ce484222325u, 1, 2, 3};
    hash_bytes(A->colptr, ((size_t)A->ncols + 1) * sizeof *A->colptr, chain);
    hash_bytes(A->row, (size_t)A->colptr[A->ncols] * sizeof *A->row, chain);
    uint64_t hash = chain[0];
    for (int k = 1; k < 4; k++) {
        hash = (hash ^ hash >> 29 ^ chain[k]) * hash_factor;
    }
    return hash;
}

/* x * 0 is 0, or NaN where x is not finite; so is the sum. */
static bool all_finite(const double *x, int64_t count)
{
    double sum[LANES] = {0.0};
    int64_t i = 0;
    for (; i + LANES <= count; i += LANES) {
        for (int k = 0; k < LANES; k++) {
            sum[k] += x[i + k] * 0.0;
        }
    }
    for (; i < count; i++) {
        sum[0] += x[i] * 0.0;
    }
    double all = 0.0;
    for (int k = 0; k < LANES; k++) {
        all += sum[k];
    }
    return all == 0.0;
}

/* max |a_ij|, i != j, of finite values. */
static double largest_off_diagonal(const sl_csc *A)
{
    double largest = 0.0;
    for (int32_t j = 0; j < A->ncols; j++) {
        for (int64_t p = A->colptr[j] + 1; p < A->colptr[j + 1]; p++) {
            largest = fabs(A->val[p]) > largest ? fabs(A->val[p]) : largest;
        }
    }
    return largest;
}

sl_status sl_check_values(const sl_cholesky *F, const sl_csc *A, double sigma, double *largest,
                          double *largest_diagonal)
{
    double diagonal = 0.0;
    const bool same_pattern = A->ncols == F->n && A->nrows == F->n && A->colptr[F->n] == F->pattern_nnz &&
                              sl_pattern_hash(A) == F->pattern_hash;
    if (!same_pattern || !isfinite(sigma) || !all_finite(A->val, F->pattern_nnz)) {
        return SL_BAD_INPUT;
    }
    for (int32_t j = 0; j < F->n; j++) {
        const double d = fabs(A->val[A->colptr[j]] - sigma);
        diagonal = d > diagonal ? d : diagonal;
    }
    if (!isfinite(diagonal)) { /* the difference overflows */
        return SL_BAD_INPUT;
    }
    *largest_diagonal = diagonal;
    if (largest != NULL) {
        *largest = fmax(largest_off_diagonal(A), diagonal);
    }
    return SL_OK;
}
