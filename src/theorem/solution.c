/* Everything solved for one graph: the three spectra, their match, the antisymmetric vectors among L's own. */
#include "base/memory.h"
#include "eigen/lanczos.h"
#include "theorem/theorem_internal.h"

#include <math.h>
#include <string.h>

void sl_solution_clear(sl_solution *s)
{
    sl_csc_free(s->L);
    sl_csc_free(s->S);
    sl_csc_free(s->T);
    sl_pairs_clear(&s->whole);
    sl_pairs_clear(&s->symmetric);
    sl_pairs_clear(&s->antisymmetric);
    sl_free(s->skew);
    sl_free(s->vector);
    sl_free(s->of_cluster);
    sl_free(s->own);
    *s = (sl_solution){0};
}

static sl_status solve(const sl_theorem_graph *graph, const sl_half *half, const sl_csc *A, sl_block_kind kind,
                       const sl_theorem_def *def, const sl_context *context, sl_pairs *out)
{
    const int32_t n = A->ncols;
    sl_null_space null = {0};
    sl_status status = SL_OK;
    if (sl_theorem_nodes(graph) <= def->full_nodes || n <= def->lowest) {
        return sl_pairs_solve(A, 0, NULL, 0, def->tolerance, context, out);
    }
    SL_TRY(sl_null_space_create(graph, half, kind, &null));
    SL_TRY(sl_pairs_solve(A, def->lowest, null.basis, null.count, def->tolerance, context, out));
cleanup:
    sl_free(null.basis);
    return status;
}

/* How many pairs of `pairs` stand below both ends of the half spectra: what can be compared. */
static int32_t comparable(const sl_pairs *pairs, double end)
{
    int32_t k = 0;
    while (k < pairs->count && pairs->lambda[k] < end) {
        k++;
    }
    return k;
}

void sl_solution_match(const sl_theorem_graph *graph, sl_solution *s, double *difference)
{
    const sl_pairs *S = &s->symmetric, *T = &s->antisymmetric, *L = &s->whole;
    const bool all = S->complete && T->complete && L->complete;
    const double end = fmin(S->end, T->end) - 2.0 * (S->error + T->error + L->error);
    const int32_t count = all ? L->count : comparable(L, end);
    int32_t i = 0, j = 0, cluster = 0;
    *difference = all && S->count + T->count != sl_theorem_nodes(graph) ? HUGE_VAL : 0.0;
    s->lowest_skew = -1;
    for (int32_t c = 0; c < L->clusters; c++) {
        s->skew[c] = L->first[c + 1] <= count ? 0 : -1;
    }
    for (int32_t k = 0; k < count; k++) {
        const bool skew = j < T->count && (i >= S->count || T->lambda[j] < S->lambda[i]);
        if (!skew && i >= S->count) {
            *difference = HUGE_VAL;
            return;
        }
        *difference = fmax(*difference, fabs(L->lambda[k] - (skew ? T->lambda[j] : S->lambda[i])));
        while (L->first[cluster + 1] <= k) {
            cluster++;
        }
        if (skew) {
            s->skew[cluster] += s->skew[cluster] >= 0 ? 1 : 0;
        }
        i += skew ? 0 : 1;
        j += skew ? 1 : 0;
    }
    if (T->count > 0 && T->lambda[0] < S->end) { /* known even where it is beyond L's own pairs */
        s->lowest_skew = comparable(S, T->lambda[0] - SL_CLUSTER_GAP * L->norm);
    }
}

void sl_moments(const sl_theorem_graph *graph, const sl_pairs *pairs, int32_t c, const int32_t *image, double *M)
{
    const int32_t a = pairs->first[c], size = pairs->first[c + 1] - a;
    for (int32_t q = 0; q < size; q++) {
        const double *v = sl_pairs_vector(pairs, a + q);
        for (int32_t p = 0; p <= q; p++) {
            const double *u = sl_pairs_vector(pairs, a + p);
            double sum = 0.0;
            for (int32_t i = 0; i < pairs->n; i++) {
                sum += u[i] * v[image != NULL ? image[i] : sl_theorem_image(graph, i)];
            }
            M[(int64_t)q * size + p] = M[(int64_t)p * size + q] = sum;
        }
    }
}

/* v := (v - P v) / 2, scaled to length 1: antisymmetric to the bit. */
static void make_antisymmetric(const sl_theorem_graph *graph, double *v)
{
    const int32_t n = graph->pairs;
    double squares = 0.0;
    for (int32_t i = 0; i < n; i++) {
        v[i] = 0.5 * (v[i] - v[i + n]);
        squares += 2.0 * v[i] * v[i];
    }
    const double scale = squares > 0.0 ? 1.0 / sqrt(squares) : 0.0;
    for (int32_t i = 0; i < n; i++) {
        v[i] *= scale;
        v[i + n] = -v[i];
    }
    for (int32_t i = 2 * n; i < sl_theorem_nodes(graph); i++) {
        v[i] = 0.0;
    }
}

/* The antisymmetric vectors of a cluster of several: eigenvectors of U' P U below 0, carried over by U. */
static sl_status resolve(const sl_theorem_graph *graph, sl_solution *s, int32_t c)
{
    const sl_pairs *L = &s->whole;
    const int32_t a = L->first[c], size = L->first[c + 1] - a, n = L->n;
    const int64_t square = (int64_t)size * size;
    double *M = sl_alloc(2 * square + size, sizeof *M);
    if (M == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    double *W = M + square, *mu = W + square;
    sl_moments(graph, L, c, NULL, M);
    const sl_status status = sl_dense_eigen(size, M, mu, W);
    for (int32_t k = 0; status == SL_OK && k < size && mu[k] < 0.0 && s->vectors < graph->pairs; k++) {
        double *v = s->vector + (int64_t)n * s->vectors;
        memset(v, 0, (size_t)n * sizeof *v);
        for (int32_t q = 0; q < size; q++) {
            const double *u = sl_pairs_vector(L, a + q), w = W[(int64_t)k * size + q];
            for (int32_t i = 0; i < n; i++) {
                v[i] += w * u[i];
            }
        }
        make_antisymmetric(graph, v);
        s->of_cluster[s->vectors++] = c;
    }
    sl_free(M);
    return status;
}

static sl_status collect_antisymmetric(const sl_theorem_graph *graph, sl_solution *s)
{
    const sl_pairs *L = &s->whole;
    const int32_t room = graph->pairs < L->count ? graph->pairs : L->count;
    sl_status status = SL_OK;
    s->vector = sl_alloc((int64_t)room * L->n, sizeof *s->vector);
    s->of_cluster = sl_alloc(room, sizeof *s->of_cluster);
    s->own = sl_calloc(room, sizeof *s->own);
    SL_TRY(s->vector != NULL && s->of_cluster != NULL && s->own != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t c = 0; c < L->clusters && s->vectors < room; c++) {
        if (L->first[c + 1] - L->first[c] > 1) {
            SL_TRY(resolve(graph, s, c));
            continue;
        }
        double mu = 0.0;
        sl_moments(graph, L, c, NULL, &mu);
        if (mu < 0.0) {
            memcpy(s->vector + (int64_t)L->n * s->vectors, sl_pairs_vector(L, L->first[c]),
                   (size_t)L->n * sizeof *s->vector);
            s->own[s->vectors] = true;
            s->of_cluster[s->vectors++] = c;
        }
    }
cleanup:
    return status;
}

/* Moves the solver's first vector that is not constant, as a faulty solver might. */
static sl_status break_vector(sl_solution *s)
{
    const int32_t k = s->whole.count > 1 ? 1 : 0;
    if (s->whole.count == 0) {
        return SL_OK;
    }
    s->whole.vector[(int64_t)s->whole.n * k] += 1e-3;
    return sl_pairs_judge(s->L, 1e-12, &s->whole);
}

/* Changes the sign of the largest entry of the lowest antisymmetric vector in half 1. */
static void break_sign(const sl_theorem_graph *graph, sl_solution *s)
{
    int32_t largest = 0;
    for (int32_t i = 1; s->vectors > 0 && i < graph->pairs; i++) {
        largest = fabs(s->vector[i]) > fabs(s->vector[largest]) ? i : largest;
    }
    if (s->vectors > 0) {
        s->vector[largest] = -s->vector[largest];
    }
}

sl_status sl_solution_create(const sl_theorem_graph *graph, const sl_half *half, const sl_theorem_def *def,
                             const sl_context *context, sl_solution *s)
{
    double difference;
    sl_status status = SL_OK;
    *s = (sl_solution){.lowest_skew = -1};
    SL_TRY(sl_matrix_whole(graph, &s->L));
    SL_TRY(sl_matrix_symmetric(graph, &s->S));
    SL_TRY(sl_matrix_antisymmetric(graph, &s->T));
    SL_TRY(solve(graph, half, s->L, SL_BLOCK_WHOLE, def, context, &s->whole));
    SL_TRY(solve(graph, half, s->S, SL_BLOCK_SYMMETRIC, def, context, &s->symmetric));
    SL_TRY(solve(graph, half, s->T, SL_BLOCK_ANTISYMMETRIC, def, context, &s->antisymmetric));
    if (def->sabotage == SL_THEOREM_BREAK_VECTOR) {
        SL_TRY(break_vector(s));
    }
    s->skew = sl_calloc(s->whole.clusters, sizeof *s->skew);
    SL_TRY(s->skew != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    sl_solution_match(graph, s, &difference);
    SL_TRY(collect_antisymmetric(graph, s));
    if (def->sabotage == SL_THEOREM_BREAK_SIGN) {
        break_sign(graph, s);
    }
cleanup:
    if (status != SL_OK) {
        sl_solution_clear(s);
    }
    return status;
}
