/* Multifrontal factorisation. Source: Duff, Reid 1983; Liu 1992. A supernode's panel takes A's entries and its
 * children's update matrices, is factored, and leaves its own update matrix on a stack for its parent. */
#include "sparse/cholesky.h"

#include "sparse/cholesky_internal.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <string.h>

/* Below this many multiplications a call of BLAS costs more than plain loops. */
static const int64_t plain_work = 2048;

/* L = A's lower triangle scattered into the panels; largest = max|a_ii|. False when a value is not finite. */
static bool scatter_values(sl_cholesky *F, const sl_csc *A, double *largest)
{
    memset(F->L, 0, (size_t)F->panel[F->supernodes] * sizeof *F->L);
    *largest = 0.0;
    for (int32_t j = 0; j < F->n; j++) {
        *largest = fmax(*largest, fabs(A->val[A->colptr[j]]));
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            if (!isfinite(A->val[p])) {
                return false;
            }
            F->L[F->target[p]] = A->val[p];
        }
    }
    return true;
}

/* Adds child c's update matrix U to the panel of s and, where both row and column are below it, to own. */
static void extend_add(sl_cholesky *F, int32_t c, const double *U, int32_t s, double *own)
{
    const int32_t width = sl_supernode_width(F, s), below = sl_supernode_below(F, s);
    const int32_t rows = sl_supernode_below(F, c);
    const int32_t *row = F->below + F->below_first[c];
    double *panel = F->L + F->panel[s];
    for (int32_t i = 0; i < rows; i++) {
        F->relative[i] = F->local[row[i]];
    }
    const int32_t *rel = F->relative;
    for (int32_t k = 0; k < rows; k++) {
        const double *from = U + (int64_t)k * rows;
        const bool in_panel = rel[k] < width;
        double *to = in_panel ? panel + (int64_t)rel[k] * (width + below) : own + (int64_t)(rel[k] - width) * below;
        const int32_t shift = in_panel ? 0 : width;
        for (int32_t i = k; i < rows; i++) {
            to[rel[i] - shift] += from[i];
        }
    }
}

/* panel (height x width, its top square symmetric by the lower triangle) = columns of L, by plain loops. */
static void factor_plain(double *panel, int32_t width, int32_t height)
{
    for (int32_t k = 0; k < width; k++) {
        double *column = panel + (int64_t)k * height;
        for (int32_t j = 0; j < k; j++) {
            const double *left = panel + (int64_t)j * height;
            const double factor = left[k];
            for (int32_t i = k; i < height; i++) {
                column[i] -= factor * left[i];
            }
        }
        column[k] = sqrt(column[k]);
        const double scale = 1.0 / column[k];
        for (int32_t i = k + 1; i < height; i++) {
            column[i] *= scale;
        }
    }
}

/* The same by BLAS. A bad pivot leaves what it met on the diagonal. */
static void factor_blocked(double *panel, int32_t width, int32_t height)
{
    const int info = LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', width, panel, height);
    if (info > 0) {
        panel[(info - 1) * (int64_t)(height + 1)] = NAN;
    } else if (height > width) {
        cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, height - width, width, 1.0, panel,
                    height, panel + width, height);
    }
}

/* own -= L21 L21', lower triangle. */
static void update_own(const double *panel, int32_t width, int32_t below, double *own)
{
    const int32_t height = width + below;
    if ((int64_t)width * below * below > plain_work) {
        cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, below, width, -1.0, panel + width, height, 1.0, own,
                    below);
        return;
    }
    for (int32_t k = 0; k < below; k++) {
        double *column = own + (int64_t)k * below;
        for (int32_t j = 0; j < width; j++) {
            const double *left = panel + (int64_t)j * height + width;
            const double factor = left[k];
            for (int32_t i = k; i < below; i++) {
                column[i] -= factor * left[i];
            }
        }
    }
}

/* Index of the first column whose pivot is not above the least one allowed, -1 when all are. */
static int32_t find_bad_pivot(const double *panel, int32_t width, int32_t height, double least)
{
    for (int32_t k = 0; k < width; k++) {
        const double root = panel[k * (int64_t)(height + 1)];
        if (!(root > 0.0 && root * root > least && isfinite(root))) {
            return k;
        }
    }
    return -1;
}

/* Factors supernode s; *top is the height of the stack before and after. Returns the bad column or -1. */
static int32_t factor_supernode(sl_cholesky *F, int32_t s, double least, int64_t *top)
{
    const int32_t width = sl_supernode_width(F, s), below = sl_supernode_below(F, s), height = width + below;
    double *panel = F->L + F->panel[s], *own = F->updates + *top;
    const int64_t own_size = (int64_t)below * below;
    for (int32_t k = 0; k < width; k++) {
        F->local[F->first[s] + k] = k;
    }
    for (int32_t k = 0; k < below; k++) {
        F->local[F->below[F->below_first[s] + k]] = width + k;
    }
    memset(own, 0, (size_t)own_size * sizeof *own);
    int64_t base = *top;
    for (int32_t c = F->child[s]; c != -1; c = F->sibling[c]) { /* last child first: it is on top */
        base -= (int64_t)sl_supernode_below(F, c) * sl_supernode_below(F, c);
        extend_add(F, c, F->updates + base, s, own);
    }
    if ((int64_t)width * width * height > plain_work) {
        factor_blocked(panel, width, height);
    } else {
        factor_plain(panel, width, height);
    }
    const int32_t bad = find_bad_pivot(panel, width, height, least);
    if (bad != -1) {
        return F->first[s] + bad;
    }
    update_own(panel, width, below, own);
    memmove(F->updates + base, own, (size_t)own_size * sizeof *own);
    *top = base + own_size;
    return -1;
}

sl_status sl_cholesky_factor(sl_cholesky *F, const sl_csc *A, int32_t *bad_column)
{
    double largest;
    const bool same_pattern = A->ncols == F->n && A->nrows == F->n && A->colptr[F->n] == F->pattern_nnz &&
                              sl_pattern_hash(A) == F->pattern_hash;
    if (!same_pattern || !scatter_values(F, A, &largest)) {
        return SL_BAD_INPUT;
    }
    int64_t top = 0;
    for (int32_t s = 0; s < F->supernodes; s++) {
        const int32_t bad = factor_supernode(F, s, F->pivot_rtol * largest, &top);
        if (bad != -1) {
            if (bad_column != NULL) {
                *bad_column = F->perm[bad];
            }
            return SL_NOT_POSITIVE_DEFINITE;
        }
    }
    return SL_OK;
}
