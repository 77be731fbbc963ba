/* Statements 0, 1 and 2: the mirror, the spectra as multisets, the symmetric and antisymmetric basis. */
#include "base/memory.h"
#include "eigen/lanczos.h"
#include "theorem/theorem_internal.h"

#include <math.h>

/* A bound above this says nothing useful of an eigenspace. */
static const double useful_bound = 0.02;

sl_status sl_state_mirror(const sl_theorem_graph *graph, sl_theorem_result *result)
{
    int32_t at = -1;
    sl_status status = SL_OK;
    SL_TRY(sl_theorem_graph_check(graph, NULL, &at));
    if (at >= 0) {
        sl_theorem_fail(result, SL_THEOREM_MIRROR, "the mirror does not carry the neighbours of node %d to those of %d",
                        at, sl_theorem_image(graph, at));
    } else if (graph->second != NULL) {
        SL_TRY(sl_theorem_graph_check(graph, graph->second, &at));
        if (at >= 0) {
            sl_theorem_fail(result, SL_THEOREM_MIRROR, "the second mirror does not carry the neighbours of node %d",
                            at);
        }
    }
    sl_theorem_count(result, SL_THEOREM_MIRROR, at >= 0 ? SL_THEOREM_VIOLATED : SL_THEOREM_HOLDS);
cleanup:
    return status;
}

sl_status sl_state_spectra(const sl_theorem_graph *graph, sl_solution *s, sl_theorem_result *result)
{
    const double allowed = s->whole.error + s->symmetric.error + s->antisymmetric.error;
    sl_theorem_verdict verdict = SL_THEOREM_HOLDS;
    double difference;
    sl_solution_match(graph, s, &difference);
    result->largest_difference = difference / fmax(s->whole.norm, 1.0);
    if (!s->whole.sound || !s->symmetric.sound || !s->antisymmetric.sound) {
        verdict = SL_THEOREM_VIOLATED;
        sl_theorem_fail(result, SL_THEOREM_SPECTRA, "a pair that the solver delivers is no eigenpair");
    } else if (!(difference <= allowed)) {
        verdict = SL_THEOREM_VIOLATED;
        sl_theorem_fail(result, SL_THEOREM_SPECTRA, "an eigenvalue of L differs from the halves' by %.3g, allowed %.3g",
                        difference, allowed);
    } else if (s->whole.count == 0 || (s->whole.clusters > 0 && s->skew[0] < 0)) {
        verdict = SL_THEOREM_UNDECIDED; /* a solver gave up, or nothing can be compared */
    }
    sl_theorem_count(result, SL_THEOREM_SPECTRA, verdict);
    return SL_OK;
}

/* ||P v - v|| or ||P v + v||, the smaller, for a vector on its own. */
static double parity_defect(const sl_theorem_graph *graph, const double *v)
{
    double plus = 0.0, minus = 0.0;
    for (int32_t i = 0; i < sl_theorem_nodes(graph); i++) {
        const double image = v[sl_theorem_image(graph, i)];
        plus += (image - v[i]) * (image - v[i]);
        minus += (image + v[i]) * (image + v[i]);
    }
    return sqrt(fmin(plus, minus));
}

/* Are the eigenvalues of U' P U all 1 or -1, and -1 as often as the half spectra say? Rounding and the error of U: with
 * ||U - X|| <= sqrt 2 b for a basis X of the exact eigenspaces, U' P U is within 2 sqrt 2 b (1 + b) of X' P X. */
static sl_status judge_cluster(const sl_theorem_graph *graph, const sl_solution *s, int32_t c,
                               sl_theorem_verdict *verdict)
{
    const sl_pairs *L = &s->whole;
    const int32_t size = L->first[c + 1] - L->first[c];
    const double b = L->bound[c];
    *verdict = SL_THEOREM_UNDECIDED;
    if (s->skew[c] < 0 || !(b <= useful_bound)) {
        return SL_OK;
    }
    const int64_t square = (int64_t)size * size;
    double *M = sl_alloc(2 * square + size, sizeof *M);
    if (M == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    double *W = M + square, *mu = W + square;
    sl_moments(graph, L, c, NULL, M);
    const sl_status status = sl_dense_eigen(size, M, mu, W);
    const double allowed = 4.0 * b + size * 0x1p-40;
    int32_t skew = 0;
    bool pure = true;
    for (int32_t k = 0; status == SL_OK && k < size; k++) {
        skew += mu[k] < 0.0 ? 1 : 0;
        pure = pure && fabs(fabs(mu[k]) - 1.0) <= allowed;
    }
    if (size == 1) {
        pure = pure && parity_defect(graph, sl_pairs_vector(L, L->first[c])) <= 2.0 * b + 0x1p-40;
    }
    *verdict = pure && skew == s->skew[c] ? SL_THEOREM_HOLDS : SL_THEOREM_VIOLATED;
    sl_free(M);
    return status;
}

sl_status sl_state_basis(const sl_theorem_graph *graph, sl_solution *s, sl_theorem_result *result)
{
    sl_theorem_verdict worst = SL_THEOREM_HOLDS, verdict;
    sl_status status = SL_OK;
    for (int32_t c = 0; c < s->whole.clusters; c++) {
        if (s->skew[c] < 0 && !s->whole.complete) {
            continue; /* beyond what the halves' lowest pairs can be compared with */
        }
        SL_TRY(judge_cluster(graph, s, c, &verdict));
        if (verdict == SL_THEOREM_VIOLATED) {
            sl_theorem_fail(result, SL_THEOREM_BASIS,
                            "the eigenspace of %.9g has no basis of %d antisymmetric and otherwise symmetric vectors",
                            s->whole.lambda[s->whole.first[c]], s->skew[c]);
        }
        worst = verdict > worst ? verdict : worst;
    }
    sl_theorem_count(result, SL_THEOREM_BASIS, worst);
cleanup:
    return status;
}
