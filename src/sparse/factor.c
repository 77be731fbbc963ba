/* Multifrontal factorisation. Source: Duff, Reid 1983; Liu 1992. A supernode's panel takes A's entries and its
 * children's update matrices, is factored, and leaves its own update matrix on a stack for its parent. */
#include "base/memory.h"
#include "sparse/front.h"

#include <math.h>
#include <string.h>

/* The walk's own memory. */
typedef struct walker {
    const sl_front_job *job;
    double *updates;   /* the stack */
    double *spare;     /* of the kernels */
    double *panel;     /* where panels are made when they are not kept */
    int32_t *relative; /* max_below: a child's rows in its parent's numbering */
    int64_t top;       /* height of the stack */
} walker;

/* A's entries into the panel of s. */
static void scatter_entries(const sl_front_job *job, int32_t s, double *panel)
{
    const sl_cholesky *F = job->F;
    const int64_t begin = F->entry_first[s], end = F->entry_first[s + 1];
    const int32_t width = sl_supernode_width(F, s);
    for (int64_t e = begin; e < end; e++) {
        panel[F->entry_to[e]] = job->A->val[F->entry_from[e]];
    }
    for (int64_t e = begin; e < begin + width; e++) {
        panel[F->entry_to[e]] -= job->sigma;
    }
}

/* relative[i] = number of child c's i-th row within the panel of its parent s. Both lists ascend. */
static void match_rows(const sl_cholesky *F, int32_t c, int32_t s, int32_t *relative)
{
    const int32_t rows = sl_supernode_below(F, c), width = sl_supernode_width(F, s);
    const int32_t *row = F->below + F->below_first[c], *to = F->below + F->below_first[s];
    int32_t k = 0;
    for (int32_t i = 0; i < rows; i++) {
        if (row[i] < F->first[s + 1]) {
            relative[i] = row[i] - F->first[s];
            continue;
        }
        while (to[k] != row[i]) {
            k++;
        }
        relative[i] = width + k;
    }
}

/* Row i of a child's update matrix into a row of the panel: to is its first column, stride the way to the next. */
static void add_to_panel(const double *from, const int32_t *relative, int32_t count, double *to, int32_t stride)
{
    for (int32_t k = 0; k < count; k++) {
        to[(int64_t)relative[k] * stride] += from[k];
    }
}

static void add_to_update(const double *from, const int32_t *relative, int32_t count, double *to)
{
    for (int32_t k = 0; k < count; k++) {
        to[relative[k]] += from[k];
    }
}

/* Adds child c's update matrix U to the panel of s and, where both row and column are below it, to own. */
static void extend_add(const walker *w, int32_t c, const double *U, int32_t s, double *panel, double *own)
{
    const sl_cholesky *F = w->job->F;
    const int32_t width = sl_supernode_width(F, s), below = sl_supernode_below(F, s);
    const int32_t rows = sl_supernode_below(F, c), *rel = w->relative;
    double *lower = panel + sl_own_size(width);
    int32_t in_panel = 0; /* columns of U that go to the panel */
    match_rows(F, c, s, w->relative);
    while (in_panel < rows && rel[in_panel] < width) {
        in_panel++;
    }
    for (int32_t i = 0; i < in_panel; i++) {
        const int32_t left = width - rel[i] / SL_SLAB * SL_SLAB;
        add_to_panel(U, rel, i + 1, panel + sl_own_place(width, rel[i], 0), left < SL_SLAB ? left : SL_SLAB);
        U += i + 1;
    }
    for (int32_t i = in_panel; i < rows; i++) {
        const int32_t row = rel[i] - width, left = below - row / SL_SLAB * SL_SLAB;
        add_to_panel(U, rel, in_panel, lower + sl_below_place(width, below, row, 0), left < SL_SLAB ? left : SL_SLAB);
        add_to_update(U + in_panel, rel + in_panel, i + 1 - in_panel, own + sl_packed_size(row) - width);
        U += i + 1;
    }
}

/* Returns the bad column or -1. */
static int32_t factor_supernode(walker *w, int32_t s)
{
    const sl_front_job *job = w->job;
    const sl_cholesky *F = job->F;
    const int32_t width = sl_supernode_width(F, s), below = sl_supernode_below(F, s);
    const int64_t own_size = sl_packed_size(below);
    double *panel = job->L != NULL ? job->L + F->panel[s] : w->panel, *own = w->updates + w->top;
    int8_t *sign = job->sign != NULL ? job->sign + F->first[s] : NULL;
    memset(panel, 0, (size_t)(F->panel[s + 1] - F->panel[s]) * sizeof *panel);
    memset(own, 0, (size_t)own_size * sizeof *own);
    scatter_entries(job, s, panel);
    int64_t base = w->top;
    for (int32_t c = F->child[s]; c != -1; c = F->sibling[c]) { /* last child first: it is on top */
        base -= sl_packed_size(sl_supernode_below(F, c));
        extend_add(w, c, w->updates + base, s, panel, own);
    }
    const int32_t bad = F->kernels->factor(panel, width, below, job->pivoting, sign, w->spare);
    if (bad != -1) {
        return F->first[s] + bad;
    }
    F->kernels->update(panel, width, below, sign, w->spare, 0, sl_slab_pairs(below), own);
    memmove(w->updates + base, own, (size_t)own_size * sizeof *own);
    w->top = base + own_size;
    if (job->panel_done != NULL) {
        job->panel_done(job->user, s, panel, sign);
    }
    return -1;
}

sl_status sl_factor_fronts(sl_front_job *job)
{
    const sl_cholesky *F = job->F;
    walker w = {.job = job};
    sl_status status = SL_OK;
    job->bad = -1;
    w.updates = sl_alloc(F->max_update, sizeof *w.updates);
    w.relative = sl_alloc(F->max_below, sizeof *w.relative);
    w.spare = sl_alloc(sl_front_spare(F->max_width), sizeof *w.spare);
    w.panel = sl_alloc(job->L == NULL ? F->max_panel : 0, sizeof *w.panel);
    if (w.updates == NULL || w.relative == NULL || w.spare == NULL || w.panel == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    for (int32_t k = 0; k < F->supernodes && job->bad == -1; k++) {
        job->bad = factor_supernode(&w, F->walk[k]);
    }
cleanup:
    sl_free(w.updates);
    sl_free(w.relative);
    sl_free(w.spare);
    sl_free(w.panel);
    return status;
}

sl_status sl_check_values(const sl_cholesky *F, const sl_csc *A, double sigma, double *largest,
                          double *largest_diagonal)
{
    *largest = *largest_diagonal = 0.0;
    const bool same_pattern = A->ncols == F->n && A->nrows == F->n && A->colptr[F->n] == F->pattern_nnz &&
                              sl_pattern_hash(A) == F->pattern_hash;
    if (!same_pattern || !isfinite(sigma)) {
        return SL_BAD_INPUT;
    }
    for (int32_t j = 0; j < F->n; j++) {
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            const double a = p == A->colptr[j] ? A->val[p] - sigma : A->val[p];
            if (!isfinite(a)) {
                return SL_BAD_INPUT;
            }
            *largest = fmax(*largest, fabs(a));
        }
        *largest_diagonal = fmax(*largest_diagonal, fabs(A->val[A->colptr[j]] - sigma));
    }
    return SL_OK;
}

/* L and the signs, when this is the first factorisation. */
static sl_status make_room(sl_cholesky *F)
{
    if (F->L == NULL) {
        F->L = sl_alloc(F->panel[F->supernodes], sizeof *F->L);
    }
    if (F->sign == NULL && F->kind == SL_FACTOR_LDLT) {
        F->sign = sl_alloc(F->n, sizeof *F->sign);
    }
    return F->L != NULL && (F->sign != NULL || F->kind != SL_FACTOR_LDLT) ? SL_OK : SL_OUT_OF_MEMORY;
}

sl_status sl_cholesky_factor_shifted(sl_cholesky *F, const sl_csc *A, double sigma, const sl_context *context,
                                     int32_t *bad_column)
{
    (void)context;
    double largest, diagonal;
    sl_status status = SL_OK;
    SL_TRY(sl_check_values(F, A, sigma, &largest, &diagonal));
    SL_TRY(make_room(F));
    sl_front_job job = {.F = F,
                        .A = A,
                        .sigma = sigma,
                        .pivoting = {F->pivot_rtol * diagonal, 0.0},
                        .L = F->L,
                        .sign = F->sign,
                        .bad = -1};
    SL_TRY(sl_factor_fronts(&job));
    if (job.bad != -1) {
        if (bad_column != NULL) {
            *bad_column = F->perm[job.bad];
        }
        status = F->kind == SL_FACTOR_LDLT ? SL_SINGULAR : SL_NOT_POSITIVE_DEFINITE;
    }
cleanup:
    return status;
}

sl_status sl_cholesky_factor(sl_cholesky *F, const sl_csc *A, int32_t *bad_column)
{
    return sl_cholesky_factor_shifted(F, A, 0.0, NULL, bad_column);
}
