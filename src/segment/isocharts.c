/* Iso-charts: landmarks and their embedding; the method as a whole. */
#include "segment/isocharts_internal.h"

#include "base/memory.h"

#include <math.h>

#define LEAST_LANDMARKS 16       /* however large the surface ... */
#define MOST_DISTANCES (1 << 25) /* ... and distances kept otherwise: 128 MB */

void sl_node_means(const sl_piece *piece, const sl_facet_graph *graph, const double *vertex, double *node,
                   int32_t *count)
{
    const sl_mesh *m = piece->mesh;
    for (int32_t i = 0; i < graph->graph.n; i++) {
        node[i] = 0.0;
        count[i] = 0;
    }
    for (int32_t h = 0; h < m->nh; h++) {
        node[graph->node[m->face[h]]] += vertex[m->origin[h]];
        count[graph->node[m->face[h]]]++;
    }
    for (int32_t i = 0; i < graph->graph.n; i++) {
        node[i] /= count[i];
    }
}

static int32_t landmark_count(int32_t nv)
{
    const int32_t room = MOST_DISTANCES / nv, wanted = room < SL_ISO_LANDMARKS ? room : SL_ISO_LANDMARKS;
    const int32_t count = wanted > LEAST_LANDMARKS ? wanted : LEAST_LANDMARKS;
    return count < nv ? count : nv;
}

static int32_t farthest(const double *distance, int32_t n)
{
    int32_t far = 0;
    for (int32_t i = 1; i < n; i++) {
        far = distance[i] > distance[far] ? i : far;
    }
    return far;
}

/* Each landmark is the vertex farthest from those before it. */
static sl_status place_landmarks(sl_isocharts *iso, const sl_context *context)
{
    sl_status status = SL_OK;
    const int32_t nv = iso->piece->mesh->nv;
    double *nearest = sl_alloc(nv, sizeof *nearest);
    SL_TRY(nearest != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    sl_geodesics_from(&iso->geodesics, 0, iso->vertex_work);
    int32_t next = farthest(iso->vertex_work, nv);
    for (int32_t v = 0; v < nv; v++) {
        nearest[v] = HUGE_VAL;
    }
    for (int32_t k = 0; k < iso->landmarks; k++) {
        SL_TRY(sl_report_progress(context, "geodesics", (double)k / iso->landmarks));
        iso->landmark[k] = next;
        sl_geodesics_from(&iso->geodesics, next, iso->vertex_work);
        for (int32_t v = 0; v < nv; v++) {
            iso->distance[(int64_t)k * nv + v] = (float)iso->vertex_work[v];
            nearest[v] = fmin(nearest[v], iso->vertex_work[v]);
        }
        next = farthest(nearest, nv);
    }
cleanup:
    sl_free(nearest);
    return status;
}

sl_status sl_iso_embed(sl_isocharts *iso, const sl_context *context)
{
    sl_status status = SL_OK;
    const int64_t nv = iso->piece->mesh->nv;
    double *between = NULL;
    iso->landmarks = landmark_count((int32_t)nv);
    const int64_t n = iso->landmarks;
    iso->landmark = sl_alloc(n, sizeof *iso->landmark);
    iso->distance = sl_alloc(n * nv, sizeof *iso->distance);
    between = sl_alloc(n * n, sizeof *between);
    if (iso->landmark == NULL || iso->distance == NULL || between == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    SL_TRY(place_landmarks(iso, context));
    for (int64_t i = 0; i < n; i++) {
        for (int64_t j = 0; j < n; j++) {
            between[i * n + j] = iso->distance[i * nv + iso->landmark[j]];
        }
    }
    SL_TRY(sl_mds_create(iso->landmarks, between, &iso->mds));
    const int32_t dominant = sl_mds_dominant(&iso->mds);
    iso->dims = dominant < iso->mds.dims ? dominant : iso->mds.dims;
cleanup:
    sl_free(between);
    return status;
}

static void iso_clear(sl_isocharts *iso)
{
    sl_geodesics_clear(&iso->geodesics);
    sl_mds_clear(&iso->mds);
    sl_free(iso->landmark);
    sl_free(iso->distance);
    sl_free(iso->node_distance);
    sl_free(iso->area);
    sl_free(iso->vertex_work);
}

/**
 * Clusters of Iso-charts.
 *
 * Distances along the surface from landmarks, classical scaling of them, as many dimensions as dominate; clusters grow
 * around the two extremes of each, and minimum cuts by angle and distortion move their borders.
 *
 * @param[in]  piece
 * @param[in]  graph
 * @param[in]  def      max_charts bounds the clusters
 * @param[in]  context  nullable
 * @param[out] label    n
 * @param[out] choice   vector = clusters, lambda = the largest eigenvalue; not found where no two extremes differ
 *
 * SL_OUT_OF_MEMORY, SL_CANCELLED, SL_INTERNAL. O(landmarks nv log nv). Serial: the same bytes for any number of
 * threads.
 * Source: Zhou, Snyder, Guo, Shum 2004, "Iso-charts: stretch-driven mesh parameterization using spectral analysis".
 * Deviations: landmarks are farthest points, not those of a simplification; charts are judged and laid flat as those of
 * every other method here, not by the embedding; no special treatment of tabular shapes, no signals.
 */
sl_status sl_isocharts_labels(const sl_piece *piece, const sl_facet_graph *graph, const sl_segment_def *def,
                              const sl_context *context, int32_t *label, sl_choice *choice)
{
    sl_status status = SL_OK;
    sl_isocharts iso = {.piece = piece, .graph = graph, .label = label};
    iso.area = sl_calloc(graph->graph.n, sizeof *iso.area);
    iso.vertex_work = sl_alloc(piece->mesh->nv, sizeof *iso.vertex_work);
    SL_TRY(iso.area != NULL && iso.vertex_work != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    sl_node_areas(piece, graph, iso.area, NULL);
    SL_TRY(sl_geodesics_create(piece->mesh, piece->triangulation, &iso.geodesics));
    SL_TRY(sl_iso_embed(&iso, context));
    SL_TRY(sl_iso_cluster(&iso, def->max_charts));
    choice->found = iso.clusters > 1;
    choice->vector = iso.clusters;
    choice->lambda = iso.mds.lambda[0];
    choice->candidates = choice->found;
    if (choice->found) {
        SL_TRY(sl_report_progress(context, "geodesics", 1.0));
        SL_TRY(sl_iso_refine(&iso));
    }
cleanup:
    iso_clear(&iso);
    return status;
}
