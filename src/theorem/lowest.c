/* Statements 4 and 5: the lowest vector of a balanced block, on the half's matrix and on L's own vectors. */
#include "base/memory.h"
#include "eigen/lanczos.h"
#include "theorem/blocks_internal.h"

#include <math.h>
#include <string.h>

/* Signs of a vector on a block: value(k) of each pair as seen from the node that `turn` names half 1. Counts those
 * within the bound; *mixed when two beyond it differ. The vector's own sign is that of the larger sum. */
sl_sign_count sl_count_signs(const double *value, int32_t count, double bound)
{
    double sum = 0.0;
    sl_sign_count out = {0};
    for (int32_t k = 0; k < count; k++) {
        sum += value[k];
    }
    for (int32_t k = 0; k < count; k++) {
        const double v = sum >= 0.0 ? value[k] : -value[k];
        out.undecided += fabs(v) <= bound ? 1 : 0;
        out.mixed = out.mixed || v < -bound;
    }
    return out;
}

/* The sides of a vector given on the pairs of a block (seen from half 1): all other nodes are in F+. */
static void take_sides(const sl_blocks_work *w, const sl_block *b, const double *first, const double *second)
{
    memset(w->side, 1, (size_t)sl_theorem_nodes(w->graph));
    for (int32_t k = 0; k < b->count; k++) {
        w->side[b->pair[k]] = first[k] >= 0.0;
        w->side[b->pair[k] + w->graph->pairs] = second[k] >= 0.0;
    }
}

/* Is the cut in w->side exactly the axis of the block, and are both sides connected where the graph is? */
static sl_status judge_seam(sl_blocks_work *w, const sl_block *b, sl_theorem_statement statement, bool *exact)
{
    int32_t off, missing;
    bool connected = true;
    sl_status status = SL_OK;
    sl_seam_compare(w->graph, w->half, b->component, w->side, &off, &missing);
    if (w->half->graph_parts == 1) {
        SL_TRY(sl_seam_connected(w->graph, w->side, &connected));
    }
    *exact = off == 0 && missing == 0 && connected;
    if (!*exact) {
        sl_theorem_fail(w->result, statement,
                        "a lowest antisymmetric seam has %d edges off the axis, lacks %d of it, sides %sconnected", off,
                        missing, connected ? "" : "not ");
    }
cleanup:
    return status;
}

/* Verdict from signs and seam. Signs in doubt leave both in doubt; a sign that is wrong beyond its bound does not. */
static sl_status judge(sl_blocks_work *w, const sl_block *b, sl_theorem_statement statement, sl_sign_count signs,
                       sl_theorem_verdict *verdict)
{
    bool exact = true;
    w->result->tally[statement].signs += b->count;
    w->result->tally[statement].signs_undecided += signs.undecided;
    if (signs.mixed) {
        sl_theorem_fail(w->result, statement, "the lowest antisymmetric vector has both signs on a half of %d nodes",
                        b->count);
        *verdict = SL_THEOREM_VIOLATED;
        return SL_OK;
    }
    if (signs.undecided > 0) {
        *verdict = SL_THEOREM_UNDECIDED;
        return SL_OK;
    }
    const sl_status status = judge_seam(w, b, statement, &exact);
    *verdict = exact ? SL_THEOREM_HOLDS : SL_THEOREM_VIOLATED;
    return status;
}

/* Statement 4, on the block's own matrix. */
sl_status sl_state_half(sl_blocks_work *w, const sl_block *b)
{
    const sl_pairs *p = b->pairs;
    double *value = w->vector, *first = value + b->count, *second = first + b->count;
    const bool simple = p->clusters > 0 && p->first[1] == 1 && p->bound[0] < 1.0;
    for (int32_t k = 0; k < b->count; k++) {
        const double v = simple ? p->vector[k] : 0.0, turned = v * w->half->turn[b->pair[k]];
        value[k] = turned;
        first[k] = v;
        second[k] = -v;
    }
    take_sides(w, b, first, second);
    sl_theorem_verdict verdict;
    const sl_status status =
        judge(w, b, SL_THEOREM_HALF, sl_count_signs(value, b->count, simple ? p->bound[0] : HUGE_VAL), &verdict);
    sl_worsen(&w->half_verdict, verdict);
    w->any_half = true;
    return status;
}

/* The antisymmetric vectors of L's cluster that holds lambda: [*begin, *end). *cluster -1: not among those computed. */
static void find_vectors(const sl_solution *s, double lambda, double error, int32_t *cluster, int32_t *begin,
                         int32_t *end)
{
    const sl_pairs *L = &s->whole;
    const double slack = error + L->error;
    *cluster = -1;
    for (int32_t c = 0; c < L->clusters; c++) {
        if (lambda >= L->lambda[L->first[c]] - slack && lambda <= L->lambda[L->first[c + 1] - 1] + slack) {
            *cluster = c;
        }
    }
    *begin = 0;
    while (*begin < s->vectors && s->of_cluster[*begin] < *cluster) {
        (*begin)++;
    }
    *end = *begin;
    while (*end < s->vectors && s->of_cluster[*end] == *cluster) {
        (*end)++;
    }
}

/* The vector of the cluster's antisymmetric space that lives on the block: L leaves that space and "restricted to the
 * block" apart, so V' 1_C V has eigenvalues 0 and 1; there must be one 1. u: nodes. */
static sl_status restrict_to_block(const sl_blocks_work *w, const sl_block *b, int32_t begin, int32_t end, double *u,
                                   bool *found)
{
    const int32_t size = end - begin, n = w->graph->pairs;
    const int64_t nodes = w->solution->whole.n, square = (int64_t)size * size;
    const double *V = w->solution->vector + nodes * begin;
    double *G = sl_calloc(2 * square + size, sizeof *G);
    if (G == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    double *W = G + square, *mu = W + square;
    for (int32_t q = 0; q < size; q++) {
        for (int32_t p = 0; p < size; p++) {
            for (int32_t k = 0; k < b->count; k++) {
                const int32_t i = b->pair[k];
                G[square / size * q + p] +=
                    V[nodes * p + i] * V[nodes * q + i] + V[nodes * p + i + n] * V[nodes * q + i + n];
            }
        }
    }
    const sl_status status = sl_dense_eigen(size, G, mu, W);
    *found = status == SL_OK && mu[size - 1] > 0.75 && (size == 1 || mu[size - 2] < 0.25);
    memset(u, 0, (size_t)nodes * sizeof *u);
    for (int32_t q = 0; *found && q < size; q++) {
        for (int64_t i = 0; i < nodes; i++) {
            u[i] += W[square - size + q] * V[nodes * q + i];
        }
    }
    sl_free(G);
    return status;
}

/* Statement 5, on L's own vectors. */
sl_status sl_state_whole(sl_blocks_work *w, const sl_block *b)
{
    const sl_solution *s = w->solution;
    const sl_pairs *p = b->pairs;
    const int32_t n = w->graph->pairs;
    int32_t cluster, begin, end;
    bool found = false;
    sl_status status = SL_OK;
    if (p->count == 0) {
        return SL_OK;
    }
    find_vectors(s, p->lambda[0], p->error, &cluster, &begin, &end);
    if (cluster < 0 || begin == end) {
        if (s->whole.complete) {
            sl_theorem_fail(w->result, SL_THEOREM_WHOLE, "L has no antisymmetric vector for the block's lowest %.9g",
                            p->lambda[0]);
            w->any_whole = true;
            sl_worsen(&w->whole_verdict, SL_THEOREM_VIOLATED);
        }
        return SL_OK; /* beyond the lowest pairs of L */
    }
    w->any_whole = true;
    if (w->half->components == 1 && begin > 0) {
        sl_theorem_fail(w->result, SL_THEOREM_WHOLE, "the half's lowest vector is not L's lowest antisymmetric one");
        sl_worsen(&w->whole_verdict, SL_THEOREM_VIOLATED);
    }
    double *u = sl_alloc(s->whole.n, sizeof *u);
    SL_TRY(u != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(restrict_to_block(w, b, begin, end, u, &found));
    double *value = w->vector, *first = value + 2 * b->count, *second = first + b->count;
    for (int32_t k = 0; k < b->count; k++) {
        const int32_t i = b->pair[k];
        first[k] = found ? u[i] : 0.0;
        second[k] = found ? u[i + n] : 0.0;
        value[k] = first[k] * w->half->turn[i];
        value[b->count + k] = -second[k] * w->half->turn[i];
    }
    take_sides(w, b, first, second);
    const double bound = found ? s->whole.bound[cluster] * (end - begin == 1 && s->own[begin] ? 1.0 : 4.0) : HUGE_VAL;
    sl_theorem_verdict verdict;
    SL_TRY(judge(w, b, SL_THEOREM_WHOLE, sl_count_signs(value, 2 * b->count, bound), &verdict));
    w->result->tally[SL_THEOREM_WHOLE].signs += b->count; /* both nodes of each pair */
    sl_worsen(&w->whole_verdict, verdict);
cleanup:
    sl_free(u);
    return status;
}
