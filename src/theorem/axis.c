/* Statement 3: an antisymmetric seam has an axis edge {f, image} iff the vector is not 0 at f. */
#include "base/memory.h"
#include "theorem/theorem_internal.h"

#include <math.h>

/* A bound above this says nothing useful of an eigenspace. */
static const double useful_bound = 0.02;

/* What is known of a value. */
typedef enum value_state { NOT_ZERO, UNKNOWN, ZERO } value_state;

/* A run of antisymmetric vectors of one cluster. */
typedef struct skew_space {
    int32_t begin, end; /* vectors of the solution */
    double bound;
} skew_space;

/* Does one vector separate f from its image as statement 3 says? v(f) + v(image) is 0 for the exact vector, so at most
 * twice the bound here; where both are beyond the bound their signs must differ. */
static bool separates(const double *v, int32_t f, int32_t image, double bound)
{
    if (fabs(v[f] + v[image]) > 2.0 * bound + 0x1p-40) {
        return false;
    }
    return !(fabs(v[f]) > bound && fabs(v[image]) > bound && (v[f] > 0.0) == (v[image] > 0.0));
}

/* Length of the part of e_f in the space: 0 iff every vector of it vanishes at f, whatever its basis. */
static double length_at(const sl_solution *s, const skew_space *space, int32_t f)
{
    double squares = 0.0;
    for (int32_t k = space->begin; k < space->end; k++) {
        const double value = s->vector[(int64_t)s->whole.n * k + f];
        squares += value * value;
    }
    return sqrt(squares);
}

/* +1 or -1 when the map acts as that on the whole space, else 0: the trace of V' Q V is a sum of signs. */
static int32_t parity(const sl_solution *s, const skew_space *space, const int32_t *map)
{
    const int64_t n = s->whole.n;
    const double size = space->end - space->begin;
    double trace = 0.0;
    for (int32_t k = space->begin; k < space->end; k++) {
        const double *v = s->vector + n * k;
        for (int64_t i = 0; i < n; i++) {
            trace += v[i] * v[map[i]];
        }
    }
    if (!(space->bound < useful_bound)) {
        return 0;
    }
    return trace > size - 0.5 ? 1 : trace < 0.5 - size ? -1 : 0;
}

/* Another involution tau that commutes with the mirror shows v(f) = 0 where tau f = f and tau acts as -1, or tau f =
 * image of f and tau acts as +1. */
static bool zero_by_map(const sl_theorem_graph *graph, const sl_solution *s, const skew_space *space,
                        const int32_t *map, int32_t f)
{
    const bool fixes = map[f] == f, mirrors = map[f] == sl_theorem_image(graph, f);
    return (fixes || mirrors) && parity(s, space, map) == (fixes ? -1 : 1);
}

/* Do the map and the mirror commute? */
static bool commutes(const sl_theorem_graph *graph, const int32_t *map)
{
    for (int32_t i = 0; i < sl_theorem_nodes(graph); i++) {
        if (map[sl_theorem_image(graph, i)] != sl_theorem_image(graph, map[i])) {
            return false;
        }
    }
    return true;
}

/* Runs of vectors by cluster. */
static int32_t list_spaces(const sl_solution *s, skew_space *space)
{
    int32_t count = 0;
    for (int32_t k = 0; k < s->vectors; k++) {
        if (k == 0 || s->of_cluster[k] != s->of_cluster[k - 1]) {
            const double b = s->whole.bound[s->of_cluster[k]];
            space[count++] = (skew_space){k, k + 1, s->own[k] ? b : 2.0 * b};
        } else {
            space[count - 1].end = k + 1;
        }
    }
    return count;
}

/* The share of a space on one component of the half: the trace of V' 1_C V. "Restricted to C" commutes with L on
 * antisymmetric vectors (nothing joins two components but fixed nodes, where they vanish), so it is a whole number. */
static double share_on(const sl_theorem_graph *graph, const sl_half *half, const sl_solution *s,
                       const skew_space *space, int32_t component)
{
    const int32_t n = graph->pairs;
    double sum = 0.0;
    for (int32_t k = space->begin; k < space->end; k++) {
        const double *v = s->vector + (int64_t)s->whole.n * k;
        for (int32_t i = 0; i < n; i++) {
            sum += half->component[i] == component ? v[i] * v[i] + v[i + n] * v[i + n] : 0.0;
        }
    }
    return sum;
}

/* state[i]: what is known of the space i at f. */
static sl_status judge_node(const sl_theorem_graph *graph, const sl_half *half, const sl_solution *s,
                            const sl_theorem_def *def, const skew_space *space, int32_t spaces, int32_t f,
                            bool use_second, value_state *state)
{
    int32_t nonzero = 0, unknown = 0, distinct = 0;
    for (int32_t k = 0; k < spaces; k++) {
        state[k] = length_at(s, &space[k], f) > space[k].bound ? NOT_ZERO : UNKNOWN;
        if (state[k] == UNKNOWN && half->components > 1 && space[k].bound < useful_bound &&
            share_on(graph, half, s, &space[k], half->component[f]) < 0.5) {
            state[k] = ZERO;
        }
        nonzero += state[k] == NOT_ZERO ? 1 : 0;
        unknown += state[k] == UNKNOWN ? 1 : 0;
    }
    if (unknown > 0 && s->whole.complete) {
        const sl_status status = sl_distinct_at(s->T, f, &distinct);
        if (status != SL_OK) {
            return status;
        }
    }
    for (int32_t k = 0; k < spaces && unknown > 0; k++) {
        bool zero = distinct > 0 && distinct == nonzero; /* all that are not 0 have been seen */
        for (int32_t m = 0; m < def->map_count && state[k] == UNKNOWN && !zero; m++) {
            zero = zero_by_map(graph, s, &space[k], def->maps[m], f);
        }
        if (state[k] == UNKNOWN && !zero && use_second) {
            zero = zero_by_map(graph, s, &space[k], graph->second, f);
        }
        state[k] = state[k] == UNKNOWN && zero ? ZERO : state[k];
    }
    return SL_OK;
}

/* Every vector of one space at one node. */
static bool holds_at(const sl_theorem_graph *graph, const sl_solution *s, const skew_space *space, int32_t f)
{
    bool ok = true;
    for (int32_t k = space->begin; k < space->end; k++) {
        ok = ok && separates(s->vector + (int64_t)s->whole.n * k, f, sl_theorem_image(graph, f), space->bound);
    }
    return ok;
}

sl_status sl_state_axis(const sl_theorem_graph *graph, const sl_half *half, const sl_solution *s,
                        const sl_theorem_def *def, sl_theorem_result *result)
{
    sl_theorem_tally *tally = &result->tally[SL_THEOREM_AXIS];
    sl_theorem_verdict worst = SL_THEOREM_HOLDS;
    sl_status status = SL_OK;
    const bool use_second = graph->second != NULL && commutes(graph, graph->second);
    skew_space *space = sl_alloc(s->vectors, sizeof *space);
    value_state *state = sl_alloc(s->vectors, sizeof *state);
    bool *misses = sl_calloc(s->vectors, sizeof *misses);
    SL_TRY(space != NULL && state != NULL && misses != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    const int32_t spaces = list_spaces(s, space);
    bool any = false;
    for (int32_t f = 0; f < graph->pairs; f++) {
        if (half->axis[f] == 0 || spaces == 0) {
            continue;
        }
        any = true;
        SL_TRY(judge_node(graph, half, s, def, space, spaces, f, use_second, state));
        for (int32_t k = 0; k < spaces; k++) {
            tally->signs++;
            tally->zeros += state[k] == ZERO ? 1 : 0;
            tally->signs_undecided += state[k] == UNKNOWN ? 1 : 0;
            misses[k] = misses[k] || state[k] == ZERO;
            worst = state[k] == UNKNOWN && worst == SL_THEOREM_HOLDS ? SL_THEOREM_UNDECIDED : worst;
            if (!holds_at(graph, s, &space[k], f)) {
                worst = SL_THEOREM_VIOLATED;
                sl_theorem_fail(result, SL_THEOREM_AXIS, "an antisymmetric vector of %.9g has one sign at %d and %d",
                                s->whole.lambda[s->whole.first[s->of_cluster[space[k].begin]]], f, f + graph->pairs);
            }
        }
    }
    for (int32_t k = 0; k < spaces; k++) {
        result->seams_off_axis += misses[k] ? 1 : 0;
    }
    if (any) {
        result->antisymmetric += spaces;
        sl_theorem_count(result, SL_THEOREM_AXIS, worst);
    }
cleanup:
    sl_free(space);
    sl_free(state);
    sl_free(misses);
    return status;
}
