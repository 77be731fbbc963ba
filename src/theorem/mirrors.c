/* Statements 7 and 8: fixed nodes, and two mirrors at once. */
#include "base/memory.h"
#include "theorem/theorem_internal.h"

#include <math.h>

/* A bound above this says nothing useful of an eigenspace. */
static const double useful_bound = 0.02;

sl_status sl_state_fixed(const sl_theorem_graph *graph, const sl_solution *s, sl_theorem_result *result)
{
    sl_theorem_verdict verdict = SL_THEOREM_HOLDS;
    if (graph->fixed == 0 || s->vectors == 0) {
        return SL_OK;
    }
    for (int32_t k = 0; k < s->vectors; k++) {
        const double *v = s->vector + (int64_t)s->whole.n * k, bound = s->whole.bound[s->of_cluster[k]];
        for (int32_t i = 2 * graph->pairs; i < s->whole.n; i++) {
            if (fabs(v[i]) > bound) {
                verdict = SL_THEOREM_VIOLATED;
                sl_theorem_fail(result, SL_THEOREM_FIXED,
                                "an antisymmetric vector is %.3g at fixed node %d, bound %.3g", v[i], i, bound);
            }
        }
        if (!(bound < useful_bound) && verdict == SL_THEOREM_HOLDS) {
            verdict = SL_THEOREM_UNDECIDED;
        }
    }
    sl_theorem_count(result, SL_THEOREM_FIXED, verdict);
    return SL_OK;
}

/* Trace of M1 M2 and the length of M1 M2 - M2 M1, both symmetric of order `size`. */
static void compare_moments(int32_t size, const double *M1, const double *M2, double *trace, double *commutator)
{
    double squares = 0.0, sum = 0.0;
    for (int32_t i = 0; i < size; i++) {
        for (int32_t j = 0; j < size; j++) {
            double product = 0.0, reverse = 0.0;
            for (int32_t k = 0; k < size; k++) {
                product += M1[(int64_t)k * size + i] * M2[(int64_t)j * size + k];
                reverse += M2[(int64_t)k * size + i] * M1[(int64_t)j * size + k];
            }
            squares += (product - reverse) * (product - reverse);
            sum += i == j ? product : 0.0;
        }
    }
    *trace = sum;
    *commutator = sqrt(squares);
}

/* How the two mirrors act on all eigenspaces together. */
typedef struct joint_count {
    double classes[4];  /* dimensions of (+ +), (+ -), (- +), (- -), summed */
    bool whole_numbers; /* each eigenspace's dimensions are */
    int32_t apart;      /* eigenspaces on which they do not commute */
    int32_t unknown;    /* whose bound is too weak to say */
} joint_count;

/* One eigenspace: the dimension of class (a, b) is the trace of (1 + a P)(1 + b Q) / 4 there, if P and Q commute. */
static sl_status judge_cluster(const sl_theorem_graph *graph, const sl_pairs *L, int32_t c, joint_count *joint)
{
    const int32_t size = L->first[c + 1] - L->first[c];
    const double bound = L->bound[c];
    double trace, commutator, p = 0.0, q = 0.0;
    if (!(bound <= useful_bound)) {
        joint->unknown++;
        return SL_OK;
    }
    double *M1 = sl_alloc(2 * (int64_t)size * size, sizeof *M1), *M2 = M1 + (int64_t)size * size;
    if (M1 == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    sl_moments(graph, L, c, NULL, M1);
    sl_moments(graph, L, c, graph->second, M2);
    compare_moments(size, M1, M2, &trace, &commutator);
    for (int32_t k = 0; k < size; k++) {
        p += M1[(int64_t)k * size + k];
        q += M2[(int64_t)k * size + k];
    }
    sl_free(M1);
    if (commutator > 16.0 * sqrt((double)size) * bound + size * 0x1p-40) {
        joint->apart++;
        return SL_OK;
    }
    for (int32_t k = 0; k < 4; k++) {
        const double a = k < 2 ? 1.0 : -1.0, b = k % 2 == 0 ? 1.0 : -1.0;
        const double dimension = 0.25 * (size + a * p + b * q + a * b * trace);
        joint->whole_numbers = joint->whole_numbers && fabs(dimension - round(dimension)) <= 0.25;
        joint->classes[k] += round(dimension);
    }
    return SL_OK;
}

/* Dimensions of the classes in the whole space, from the nodes that each map fixes. */
static void count_classes(const sl_theorem_graph *graph, double classes[4], bool *commute)
{
    const int32_t n = sl_theorem_nodes(graph);
    double p = graph->fixed, q = 0.0, both = 0.0;
    *commute = true;
    for (int32_t i = 0; i < n; i++) {
        q += graph->second[i] == i ? 1.0 : 0.0;
        both += graph->second[sl_theorem_image(graph, i)] == i ? 1.0 : 0.0;
        *commute = *commute && graph->second[sl_theorem_image(graph, i)] == sl_theorem_image(graph, graph->second[i]);
    }
    for (int32_t k = 0; k < 4; k++) {
        const double a = k < 2 ? 1.0 : -1.0, b = k % 2 == 0 ? 1.0 : -1.0;
        classes[k] = 0.25 * (n + a * p + b * q + a * b * both);
    }
}

sl_status sl_state_joint(const sl_theorem_graph *graph, const sl_solution *s, sl_theorem_result *result)
{
    joint_count joint = {.whole_numbers = true};
    double expected[4];
    bool commute, agree = true;
    sl_theorem_verdict verdict = SL_THEOREM_HOLDS;
    if (graph->second == NULL || s->whole.count == 0) {
        return SL_OK;
    }
    count_classes(graph, expected, &commute);
    for (int32_t c = 0; c < s->whole.clusters; c++) {
        const sl_status status = judge_cluster(graph, &s->whole, c, &joint);
        if (status != SL_OK) {
            return status;
        }
    }
    for (int32_t k = 0; k < 4; k++) {
        agree = agree && joint.classes[k] == expected[k];
    }
    if (commute && (joint.apart > 0 || !joint.whole_numbers || (s->whole.complete && joint.unknown == 0 && !agree))) {
        verdict = SL_THEOREM_VIOLATED;
        sl_theorem_fail(result, SL_THEOREM_JOINT, "the mirrors commute, but %d eigenspaces have no common basis%s",
                        joint.apart, agree ? "" : ", or its classes have other dimensions");
    } else if (!commute && joint.apart == 0 && s->whole.complete) {
        verdict = joint.unknown > 0 ? SL_THEOREM_UNDECIDED : SL_THEOREM_VIOLATED;
    } else if (joint.unknown > 0) {
        verdict = SL_THEOREM_UNDECIDED;
    }
    if (verdict == SL_THEOREM_VIOLATED && !commute) {
        sl_theorem_fail(result, SL_THEOREM_JOINT,
                        "the mirrors do not commute, but every eigenspace has a common basis");
    }
    result->no_common_basis += commute ? 0 : joint.apart;
    sl_theorem_count(result, SL_THEOREM_JOINT, verdict);
    return SL_OK;
}
