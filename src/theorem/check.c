/* The check of one graph: solve, then statement by statement. */
#include "theorem/theorem_internal.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

const char *sl_theorem_statement_name(sl_theorem_statement statement)
{
    static const char *const name[SL_THEOREM_STATEMENTS] = {"mirror", "spectra", "basis", "axis",  "half",
                                                            "whole",  "crossed", "fixed", "joint", "figure-17"};
    return name[statement];
}

sl_theorem_def sl_theorem_default(void)
{
    return (sl_theorem_def){.full_nodes = 192, .lowest = 30, .tolerance = 1e-12};
}

sl_theorem_verdict sl_theorem_verdict_of(const sl_theorem_tally *tally)
{
    return tally->violated > 0 ? SL_THEOREM_VIOLATED : tally->undecided > 0 ? SL_THEOREM_UNDECIDED : SL_THEOREM_HOLDS;
}

void sl_theorem_count(sl_theorem_result *result, sl_theorem_statement statement, sl_theorem_verdict verdict)
{
    sl_theorem_tally *t = &result->tally[statement];
    t->holds += verdict == SL_THEOREM_HOLDS;
    t->undecided += verdict == SL_THEOREM_UNDECIDED;
    t->violated += verdict == SL_THEOREM_VIOLATED;
}

void sl_theorem_fail(sl_theorem_result *result, sl_theorem_statement statement, const char *format, ...)
{
    if (result->failed != SL_THEOREM_STATEMENTS) {
        return;
    }
    va_list args;
    va_start(args, format);
    vsnprintf(result->reason, sizeof result->reason, format, args);
    va_end(args);
    result->failed = statement;
}

void sl_theorem_add(sl_theorem_result *total, const sl_theorem_result *one)
{
    for (int32_t k = 0; k < SL_THEOREM_STATEMENTS; k++) {
        sl_theorem_tally *t = &total->tally[k];
        const sl_theorem_tally *o = &one->tally[k];
        t->holds += o->holds;
        t->violated += o->violated;
        t->undecided += o->undecided;
        t->signs += o->signs;
        t->zeros += o->zeros;
        t->signs_undecided += o->signs_undecided;
    }
    if (total->graphs == 0) {
        total->failed = SL_THEOREM_STATEMENTS;
        total->lowest_index = -1;
    }
    total->graphs += one->graphs;
    total->nodes += one->nodes;
    total->most_undecided = one->most_undecided > total->most_undecided ? one->most_undecided : total->most_undecided;
    total->largest_difference = fmax(total->largest_difference, one->largest_difference);
    total->largest_bound = fmax(total->largest_bound, one->largest_bound);
    total->blocks += one->blocks;
    total->seams_off_axis += one->seams_off_axis;
    total->antisymmetric += one->antisymmetric;
    total->crossed += one->crossed;
    total->crossed_one_sign += one->crossed_one_sign;
    total->no_common_basis += one->no_common_basis;
    if (one->failed != SL_THEOREM_STATEMENTS && total->failed == SL_THEOREM_STATEMENTS) {
        total->failed = one->failed;
        memcpy(total->reason, one->reason, sizeof total->reason);
    }
}

/* The largest bound among the vectors that signs were read from. */
static double largest_bound(const sl_solution *s)
{
    double largest = 0.0;
    for (int32_t k = 0; k < s->vectors; k++) {
        const double b = s->whole.bound[s->of_cluster[k]];
        largest = b < 1.0 ? fmax(largest, b) : largest;
    }
    return largest;
}

static int64_t undecided_signs(const sl_theorem_result *r)
{
    int64_t signs = 0;
    for (int32_t k = 0; k < SL_THEOREM_STATEMENTS; k++) {
        signs += r->tally[k].signs_undecided;
    }
    return signs < r->nodes ? signs : r->nodes;
}

sl_status sl_theorem_check(const sl_theorem_graph *graph, const sl_theorem_def *def, const sl_context *context,
                           sl_theorem_result *out)
{
    sl_half half = {0};
    sl_solution solution = {0};
    sl_status status = SL_OK;
    sl_theorem_result r = {.failed = SL_THEOREM_STATEMENTS, .lowest_index = -1};
    r.graphs = 1;
    r.nodes = sl_theorem_nodes(graph);
    SL_TRY(sl_half_create(graph, &half));
    SL_TRY(sl_solution_create(graph, &half, def, context, &solution));
    SL_TRY(sl_state_mirror(graph, &r));
    SL_TRY(sl_state_spectra(graph, &solution, &r));
    SL_TRY(sl_state_basis(graph, &solution, &r));
    SL_TRY(sl_state_axis(graph, &half, &solution, def, &r));
    SL_TRY(sl_state_blocks(graph, &half, &solution, def, &r));
    SL_TRY(sl_state_fixed(graph, &solution, &r));
    SL_TRY(sl_state_joint(graph, &solution, &r));
    r.lowest_index = solution.lowest_skew;
    r.largest_bound = largest_bound(&solution);
    r.most_undecided = undecided_signs(&r);
    *out = r;
cleanup:
    sl_solution_clear(&solution);
    sl_half_clear(&half);
    return status;
}
