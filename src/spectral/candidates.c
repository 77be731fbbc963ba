/* The bipartitions that eigenvectors propose, and the paper's connectivity filter. */
#include "spectral/spectrum.h"

#include "base/memory.h"

#include <math.h>

#define ZERO_RTOL 1e-12 /* |v| below this share of the largest entry is a zero, and zeros belong to F+ */

/**
 * F+ = {v >= 0} of one eigenvector.
 *
 * @param[in]  spectrum
 * @param[in]  vector    0 .. count - 1
 * @param[out] side      n; 1 in F+, 0 in F-
 *
 * Source: Sec. 3.3.  Deviations: |v| <= 1e-12 max|v| counts as 0, which only rounding can produce.
 */
void sl_spectrum_side(const sl_spectrum *spectrum, int32_t vector, uint8_t *side)
{
    SL_ASSERT(vector >= 0 && vector < spectrum->count);
    const double *v = spectrum->vectors + (int64_t)vector * spectrum->n;
    double largest = 0.0;
    for (int32_t i = 0; i < spectrum->n; i++) {
        largest = fmax(largest, fabs(v[i]));
    }
    for (int32_t i = 0; i < spectrum->n; i++) {
        side[i] = v[i] >= -ZERO_RTOL * largest;
    }
}

static void measure_seam(const sl_mesh *mesh, const sl_facet_graph *graph, const int32_t *key, sl_cut_candidate *c)
{
    for (int32_t i = 0; i < graph->graph.n; i++) {
        for (int32_t p = graph->graph.first[i]; key[i] == 1 && p < graph->graph.first[i + 1]; p++) {
            if (key[graph->graph.adj[p]] == 0) {
                c->seam_edges++;
                c->seam_length += sl_mesh_edge_length(mesh, graph->halfedge[p]);
            }
        }
    }
}

/* Nodal domains on each side: components, told apart by the side of their first node. */
static void count_domains(int32_t n, const int32_t *key, const int32_t *label, sl_cut_candidate *c)
{
    int32_t seen = 0;
    for (int32_t i = 0; i < n; i++) {
        if (label[i] == seen) { /* labels are numbered by first node */
            c->positive_parts += key[i] == 1;
            c->negative_parts += key[i] == 0;
            seen++;
        }
    }
}

/**
 * Nodal domains, filter and seam of every eigenvector but the constant one.
 *
 * @param[in]  mesh        for edge lengths
 * @param[in]  graph       the facet graph the spectrum belongs to
 * @param[in]  spectrum
 * @param[out] candidates  count - 1, in the order of the vectors
 *
 * SL_OUT_OF_MEMORY. O(count (n + edges)).
 * Source: Sec. 3.3.  Deviations: the seam lies between F+ and F-, zeros included (errata 3).
 */
sl_status sl_cut_candidates(const sl_mesh *mesh, const sl_facet_graph *graph, const sl_spectrum *spectrum,
                            sl_cut_candidate *candidates)
{
    sl_status status = SL_OK;
    const int32_t n = graph->graph.n;
    uint8_t *side = sl_alloc(n, sizeof *side);
    int32_t *key = sl_alloc(n, sizeof *key), *label = sl_alloc(n, sizeof *label);
    if (side == NULL || key == NULL || label == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    for (int32_t k = 1; k < spectrum->count; k++) {
        sl_cut_candidate *c = &candidates[k - 1];
        *c = (sl_cut_candidate){.vector = k};
        sl_spectrum_side(spectrum, k, side);
        for (int32_t i = 0; i < n; i++) {
            key[i] = side[i];
        }
        int32_t parts = 0;
        SL_TRY(sl_graph_components(&graph->graph, key, label, &parts));
        count_domains(n, key, label, c);
        c->passes = c->positive_parts == 1 && c->negative_parts == 1;
        measure_seam(mesh, graph, key, c);
    }
cleanup:
    sl_free(side);
    sl_free(key);
    sl_free(label);
    return status;
}
