/* Cuts by the Fiedler vector alone. */
#include "segment/baseline_internal.h"

#include "base/memory.h"
#include "spectral/spectrum.h"

/**
 * The two sides of the Fiedler vector, the first that is not constant, whether they hang together or not.
 *
 * SL_OUT_OF_MEMORY, SL_CANCELLED, SL_INTERNAL, SL_LIMIT.
 * Source: Fiedler 1975, "A property of eigenvectors of nonnegative symmetric matrices and its application to graph
 * theory"; Simon 1991, "Partitioning of unstructured problems for parallel processing" (bisection by it).
 * Deviations: cut at 0, as the paper cuts, and not at the median.
 */
sl_status sl_fiedler_labels(const sl_facet_graph *graph, const sl_segment_def *def, const sl_context *context,
                            int32_t *label, sl_choice *choice)
{
    sl_status status = SL_OK;
    sl_spectrum *spectrum = NULL;
    sl_spectrum_def how = sl_spectrum_default();
    const int32_t n = graph->graph.n;
    int32_t ones = 0;
    uint8_t *side = sl_alloc(n, sizeof *side);
    SL_TRY(side != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    how.count = 2;
    how.mode = SL_LANCZOS_SIGNS;
    how.memory_limit = def->memory_limit;
    SL_TRY(sl_spectrum_solve(graph, &how, context, &spectrum));
    sl_spectrum_side(spectrum, 1, side);
    for (int32_t i = 0; i < n; i++) {
        label[i] = side[i];
        ones += side[i];
    }
    choice->vector = 1;
    choice->lambda = spectrum->lambda[1];
    choice->candidates = 1;
    choice->found = ones > 0 && ones < n;
cleanup:
    sl_spectrum_free(spectrum);
    sl_free(side);
    return status;
}
