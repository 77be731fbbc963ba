/* Statements 4, 5 and 6, block by block of the half. */
#include "base/memory.h"
#include "theorem/blocks_internal.h"

#include <math.h>
#include <string.h>

/* A block of a large graph that is no whole half: so many lowest pairs, for a gap above the first. */
enum { BLOCK_PAIRS = 6 };

static sl_status solve_block(sl_blocks_work *w, sl_block *b)
{
    const sl_theorem_graph *g = w->graph;
    sl_csc *A = NULL;
    double *null = NULL, squares = 0.0;
    sl_status status = SL_OK;
    bool touches = false;
    if (w->half->components == 1) {
        b->pairs = &w->solution->antisymmetric;
        return SL_OK;
    }
    for (int32_t k = 0; k < b->count; k++) {
        touches = touches || w->half->axis[b->pair[k]] > 0 || w->half->spokes[b->pair[k]] > 0;
        squares += 1.0;
    }
    SL_TRY(sl_matrix_block(w->solution->T, b->pair, b->count, w->place, &A));
    const bool small = sl_theorem_nodes(g) <= w->def->full_nodes || b->count <= w->def->full_nodes;
    if (!touches && !small) { /* the block of a component of the graph: singular */
        null = sl_alloc(b->count, sizeof *null);
        SL_TRY(null != NULL ? SL_OK : SL_OUT_OF_MEMORY);
        for (int32_t k = 0; k < b->count; k++) {
            null[k] = w->half->turn[b->pair[k]] / sqrt(squares);
        }
    }
    SL_TRY(sl_pairs_solve(A, small ? 0 : BLOCK_PAIRS, null, null != NULL ? 1 : 0, w->def->tolerance, NULL, &b->own));
    b->pairs = &b->own;
cleanup:
    sl_free(null);
    sl_csc_free(A);
    return status;
}

/* Statement 6: no antisymmetric vector that lives on an unbalanced component has its axis for a seam. */
static void state_crossed(sl_blocks_work *w, const sl_block *b)
{
    const sl_solution *s = w->solution;
    const int32_t n = w->graph->pairs;
    for (int32_t k = 0; k < s->vectors; k++) {
        const double *v = s->vector + (int64_t)s->whole.n * k;
        const double bound = 2.0 * s->whole.bound[s->of_cluster[k]];
        double largest = 0.0;
        memset(w->side, 1, (size_t)s->whole.n);
        for (int32_t i = 0; i < b->count; i++) {
            const int32_t f = b->pair[i];
            largest = fmax(largest, fmin(fabs(v[f]), fabs(v[f + n])));
            w->side[f] = v[f] >= 0.0;
            w->side[f + n] = v[f + n] >= 0.0;
        }
        if (!(largest > bound)) {
            continue; /* 0 on this component */
        }
        int32_t off, missing;
        sl_seam_compare(w->graph, w->half, b->component, w->side, &off, &missing);
        w->any_crossed = true;
        if (off == 0 && missing == 0) {
            sl_theorem_fail(w->result, SL_THEOREM_CROSSED, "an antisymmetric seam is exactly the axis of %.9g",
                            s->whole.lambda[s->whole.first[s->of_cluster[k]]]);
            sl_worsen(&w->crossed_verdict, SL_THEOREM_VIOLATED);
        }
    }
}

/* For the record, with edges between the halves off the axis: has the lowest antisymmetric vector one sign on the half
 * as it was given? */
static void record_crossed(sl_blocks_work *w)
{
    const sl_pairs *T = &w->solution->antisymmetric;
    if (w->half->diagonal || T->count == 0) {
        return;
    }
    w->result->crossed++;
    const sl_sign_count signs = sl_count_signs(T->vector, T->n, T->bound[0]);
    w->result->crossed_one_sign += !signs.mixed && signs.undecided == 0 && T->first[1] == 1 ? 1 : 0;
}

/* Pairs grouped by component. begin: components + 1. */
static void group_pairs(const sl_half *half, int32_t *begin, int32_t *pair, int32_t *place)
{
    for (int32_t i = 0; i < half->n; i++) {
        begin[half->component[i] + 1]++;
    }
    for (int32_t c = 0; c < half->components; c++) {
        begin[c + 1] += begin[c];
    }
    for (int32_t i = 0; i < half->n; i++) {
        place[i] = begin[half->component[i]]++;
        pair[place[i]] = i;
    }
    for (int32_t c = half->components; c > 0; c--) { /* they ran up to the ends */
        begin[c] = begin[c - 1];
    }
    begin[0] = 0;
    for (int32_t i = 0; i < half->n; i++) {
        place[i] -= begin[half->component[i]];
    }
}

static sl_status judge_block(sl_blocks_work *w, int32_t component, int32_t *pair, int32_t count)
{
    sl_block b = {.component = component, .pair = pair, .count = count};
    sl_status status = SL_OK;
    if (!w->half->balanced[component]) {
        state_crossed(w, &b);
        return SL_OK;
    }
    w->result->blocks++;
    SL_TRY(solve_block(w, &b));
    SL_TRY(sl_state_half(w, &b));
    SL_TRY(sl_state_whole(w, &b));
cleanup:
    sl_pairs_clear(&b.own);
    return status;
}

sl_status sl_state_blocks(const sl_theorem_graph *graph, const sl_half *half, const sl_solution *solution,
                          const sl_theorem_def *def, sl_theorem_result *result)
{
    sl_blocks_work w = {.graph = graph, .half = half, .solution = solution, .def = def, .result = result};
    sl_status status = SL_OK;
    int32_t *begin = sl_calloc((int64_t)half->components + 1, sizeof *begin);
    w.pair = sl_alloc(graph->pairs, sizeof *w.pair);
    w.place = sl_alloc(graph->pairs, sizeof *w.place);
    w.side = sl_alloc(sl_theorem_nodes(graph), sizeof *w.side);
    w.vector = sl_alloc(4 * (int64_t)graph->pairs, sizeof *w.vector);
    const bool ok = begin != NULL && w.pair != NULL && w.place != NULL && w.side != NULL && w.vector != NULL;
    SL_TRY(ok ? SL_OK : SL_OUT_OF_MEMORY);
    group_pairs(half, begin, w.pair, w.place);
    for (int32_t c = 0; c < half->components; c++) {
        SL_TRY(judge_block(&w, c, w.pair + begin[c], begin[c + 1] - begin[c]));
    }
    record_crossed(&w);
    if (w.any_half) {
        sl_theorem_count(result, SL_THEOREM_HALF, w.half_verdict);
    }
    if (w.any_whole) {
        sl_theorem_count(result, SL_THEOREM_WHOLE, w.whole_verdict);
    }
    if (w.any_crossed) {
        sl_theorem_count(result, SL_THEOREM_CROSSED, w.crossed_verdict);
    }
cleanup:
    sl_free(begin);
    sl_free(w.pair);
    sl_free(w.place);
    sl_free(w.side);
    sl_free(w.vector);
    return status;
}
