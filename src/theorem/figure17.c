/* The graph of Figure 17. */
#include "base/memory.h"
#include "eigen/lanczos.h"
#include "theorem/families_internal.h"

#include <math.h>

enum { PAIRS = 4, NODES = 8 };

/* A' is a cycle of four, A'' = diag(1, 0, 1, 0). */
sl_status sl_theorem_figure17(sl_theorem_graph **out)
{
    sl_edges edges = {.pairs = PAIRS};
    for (int32_t i = 0; i < PAIRS; i++) {
        sl_edges_within(&edges, i, (i + 1) % PAIRS);
    }
    sl_edges_across(&edges, 0, 0);
    sl_edges_across(&edges, 2, 2);
    return sl_edges_finish(&edges, out);
}

/* y = (A - D) x, the paper's sign. */
static void apply(const sl_csc *L, const double *x, double *y)
{
    sl_csc_multiply_symmetric(L, x, 1, y);
    for (int32_t i = 0; i < NODES; i++) {
        y[i] = -y[i];
    }
}

/* Small integers: exact in floating point. */
static bool vectors_agree(const sl_csc *L)
{
    const double printed[NODES] = {0, -1, 1, 0}, gives[NODES] = {-1, 3, -4, 1, 0, 0, 1, 0};
    const double corrected[NODES] = {0, -1, 0, 1};
    double y[NODES], z[NODES];
    bool agree = true;
    apply(L, printed, y);
    apply(L, corrected, z);
    for (int32_t i = 0; i < NODES; i++) {
        agree = agree && y[i] == gives[i] && z[i] == -2.0 * corrected[i];
    }
    return agree;
}

sl_status sl_theorem_check_figure17(sl_theorem_result *result)
{
    const double root = sqrt(5.0), expected[NODES] = {0, 3.0 - root, 2, 2, 2, 4, 4, 3.0 + root};
    sl_theorem_graph *graph = NULL;
    sl_csc *L = NULL;
    sl_pairs pairs = {0};
    sl_status status = SL_OK;
    SL_TRY(sl_theorem_figure17(&graph));
    SL_TRY(sl_matrix_whole(graph, &L));
    SL_TRY(sl_pairs_solve(L, 0, NULL, 0, 0.0, NULL, &pairs));
    bool agree = vectors_agree(L);
    for (int32_t k = 0; k < NODES; k++) {
        agree = agree && fabs(pairs.lambda[k] - expected[k]) <= pairs.error + 0x1p-50;
    }
    if (!agree) {
        sl_theorem_fail(result, SL_THEOREM_FIGURE17, "the graph of Figure 17 has another spectrum or other vectors");
    }
    sl_theorem_count(result, SL_THEOREM_FIGURE17, agree ? SL_THEOREM_HOLDS : SL_THEOREM_VIOLATED);
cleanup:
    sl_pairs_clear(&pairs);
    sl_csc_free(L);
    sl_theorem_graph_free(graph);
    return status;
}
