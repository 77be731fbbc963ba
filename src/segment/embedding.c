/* Cuts by clustering an embedding of the facet graph. */
#include "segment/baseline_internal.h"

#include "base/memory.h"
#include "segment/kmeans_internal.h"
#include "spectral/spectrum.h"

#include <math.h>

#define SPECTRUM_TOLERANCE 1e-6 /* clusters need no more */
#define CONSTANT_RTOL 1e-9      /* an eigenvalue of this share of the largest, or less, belongs to a constant vector */

/* x_k(i) = v_k(i) / sqrt(lambda_k), the constant vector left out. Returns the number of dimensions. */
static int32_t place_nodes(const sl_spectrum *s, double *x)
{
    int32_t dims = 0, first = 1;
    while (first < s->count && s->lambda[first] <= CONSTANT_RTOL * s->lambda[s->count - 1]) {
        first++;
    }
    dims = s->count - first;
    for (int32_t k = 0; k < dims; k++) {
        const double scale = 1.0 / sqrt(s->lambda[first + k]), *v = s->vectors + (int64_t)(first + k) * s->n;
        for (int32_t i = 0; i < s->n; i++) {
            x[(int64_t)i * dims + k] = scale * v[i];
        }
    }
    return dims;
}

/**
 * Clusters of the global point signature.
 *
 *     GPS(i) = (v_1(i) / sqrt(lambda_1), v_2(i) / sqrt(lambda_2), ...)
 *
 * @param[in]  piece
 * @param[in]  graph
 * @param[in]  def      vectors, clusters, seed
 * @param[in]  context  nullable
 * @param[out] label    n
 * @param[out] choice   vector = clusters, lambda = the mean squared distance from the centres
 *
 * SL_OUT_OF_MEMORY, SL_CANCELLED, SL_INTERNAL, SL_LIMIT.
 * Source: Rustamov 2007, "Laplace-Beltrami eigenfunctions for deformation invariant shape representation" (the
 * embedding, and k-means in it); Liu, Zhang 2004, "Segmentation of 3D meshes through spectral clustering" (clusters of
 * a spectral embedding of facets).
 * Deviations: the graph Laplacian of the facets, as for every other cut here; nodes count by their area.
 */
sl_status sl_embedding_labels(const sl_piece *piece, const sl_facet_graph *graph, const sl_segment_def *def,
                              const sl_context *context, int32_t *label, sl_choice *choice)
{
    sl_status status = SL_OK;
    sl_spectrum *spectrum = NULL;
    sl_spectrum_def how = sl_spectrum_default();
    const int64_t n = graph->graph.n;
    double *x = NULL, *area = sl_calloc(n, sizeof *area), energy = 0.0, total = 0.0;
    SL_TRY(area != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    how.count = def->vectors < 2 ? 2 : def->vectors;
    how.tolerance = SPECTRUM_TOLERANCE;
    how.memory_limit = def->memory_limit;
    SL_TRY(sl_spectrum_solve(graph, &how, context, &spectrum));
    x = sl_alloc(n * spectrum->count, sizeof *x);
    SL_TRY(x != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    sl_node_areas(piece, graph, area, NULL);
    for (int64_t i = 0; i < n; i++) {
        total += area[i];
    }
    for (int64_t i = 0; i < n && !(total > 0.0); i++) {
        area[i] = 1.0;
    }
    const sl_kmeans_points points = {graph->graph.n, place_nodes(spectrum, x), x, area};
    sl_kmeans_def kmeans = sl_kmeans_default(def->clusters < 2 ? 2 : def->clusters);
    kmeans.clusters = kmeans.clusters < def->max_charts || def->max_charts < 2 ? kmeans.clusters : def->max_charts;
    kmeans.seed = (uint64_t)def->seed;
    SL_TRY(sl_kmeans(&points, &kmeans, context, label, &choice->vector, &energy));
    choice->lambda = total > 0.0 ? energy / total : 0.0;
    choice->candidates = 1;
    choice->found = choice->vector > 1;
cleanup:
    sl_spectrum_free(spectrum);
    sl_free(x);
    sl_free(area);
    return status;
}
