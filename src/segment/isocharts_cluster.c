/* Iso-charts: representatives at the extremes of the embedding, clusters around them. */
#include "segment/isocharts_internal.h"

#include "base/memory.h"
#include "segment/vsa_internal.h"

#include <math.h>

#define CLOSE_EDGES 10.0 /* representatives nearer than so many mean edges are one (Zhou et al. 2004) */

static double mean_edge(const sl_mesh *m)
{
    double sum = 0.0;
    for (int32_t h = 0; h < m->nh; h++) {
        sum += sl_mesh_edge_length(m, h);
    }
    return m->nh > 0 ? sum / m->nh : 0.0;
}

/* Vertices of the least and the largest coordinate in each dominant dimension: extreme[2 k], extreme[2 k + 1]. */
static void find_extremes(const sl_isocharts *iso, int32_t *extreme)
{
    const int32_t nv = iso->piece->mesh->nv;
    double d[SL_ISO_LANDMARKS], y[SL_MDS_DIMS], lo[SL_MDS_DIMS], hi[SL_MDS_DIMS];
    for (int32_t v = 0; v < nv; v++) {
        for (int32_t i = 0; i < iso->landmarks; i++) {
            d[i] = iso->distance[(int64_t)i * nv + v];
        }
        sl_mds_place(&iso->mds, iso->dims, d, y);
        for (int32_t k = 0; k < iso->dims; k++) {
            if (v == 0 || y[k] < lo[k]) {
                lo[k] = y[k];
                extreme[2 * k] = v;
            }
            if (v == 0 || y[k] > hi[k]) {
                hi[k] = y[k];
                extreme[2 * k + 1] = v;
            }
        }
    }
}

/* A node with a corner at each vertex wanted, -1 = none that is not taken already. */
static int32_t node_at(const sl_isocharts *iso, int32_t v)
{
    const sl_mesh *m = iso->piece->mesh;
    const sl_geodesics *g = &iso->geodesics;
    for (int32_t p = g->first[v]; p < g->first[v + 1]; p++) {
        const int32_t h = iso->piece->triangulation->corner[g->incident[p]];
        const int32_t node = iso->graph->node[m->face[h]];
        bool taken = false;
        for (int32_t k = 0; k < iso->clusters; k++) {
            taken |= iso->seed[k] == node;
        }
        if (!taken) {
            return node;
        }
    }
    return -1;
}

/* Takes an extreme as representative unless it is close to one of those taken; the first two may be. */
static void take_representative(sl_isocharts *iso, int32_t v, double close, int32_t *count)
{
    const int32_t k = iso->clusters, node = node_at(iso, v);
    double nearest = HUGE_VAL;
    sl_geodesics_from(&iso->geodesics, v, iso->vertex_work);
    for (int32_t i = 0; i < k; i++) {
        nearest = fmin(nearest, iso->vertex_work[iso->vertex[i]]);
    }
    if (node >= 0 && (k < 2 || nearest >= close)) {
        iso->vertex[k] = v;
        iso->seed[k] = node;
        sl_node_means(iso->piece, iso->graph, iso->vertex_work, iso->node_distance + (int64_t)k * iso->graph->graph.n,
                      count);
        iso->clusters++;
    }
}

/* Of all nodes next to a cluster the one nearest to its representative comes next. */
static sl_status grow(sl_isocharts *iso)
{
    const sl_graph *g = &iso->graph->graph;
    int32_t order = 0;
    sl_vsa_heap heap = {0, sl_alloc((int64_t)g->first[g->n] + SL_ISO_CLUSTERS, sizeof *heap.entry)};
    if (heap.entry == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t i = 0; i < g->n; i++) {
        iso->label[i] = -1;
    }
    for (int32_t k = 0; k < iso->clusters; k++) {
        sl_vsa_heap_push(&heap, (sl_vsa_heap_entry){-1.0, order++, iso->seed[k], k}); /* before all others */
    }
    while (heap.count > 0) {
        const sl_vsa_heap_entry e = sl_vsa_heap_pop(&heap);
        if (iso->label[e.node] >= 0) {
            continue;
        }
        iso->label[e.node] = e.region;
        for (int32_t p = g->first[e.node]; p < g->first[e.node + 1]; p++) {
            const int32_t j = g->adj[p];
            if (iso->label[j] < 0) {
                const double key = iso->node_distance[(int64_t)e.region * g->n + j];
                sl_vsa_heap_push(&heap, (sl_vsa_heap_entry){key, order++, j, e.region});
            }
        }
    }
    sl_free(heap.entry);
    return SL_OK;
}

sl_status sl_iso_cluster(sl_isocharts *iso, int32_t most)
{
    sl_status status = SL_OK;
    const int32_t n = iso->graph->graph.n;
    const double close = CLOSE_EDGES * mean_edge(iso->piece->mesh);
    int32_t extreme[SL_ISO_CLUSTERS], *count = sl_alloc(n, sizeof *count);
    const int32_t room = most < 2 ? 2 : most;
    iso->clusters = 0;
    iso->node_distance = sl_alloc(2 * (int64_t)iso->dims * n, sizeof *iso->node_distance);
    SL_TRY(count != NULL && iso->node_distance != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    find_extremes(iso, extreme);
    for (int32_t k = 0; k < 2 * iso->dims && iso->clusters < room; k++) {
        take_representative(iso, extreme[k], close, count);
    }
    if (iso->clusters > 1) {
        SL_TRY(grow(iso));
    }
cleanup:
    sl_free(count);
    return status;
}
