/* Shortening a cut of the facet graph by a minimum cut in a band around it. */
#include "spectral/spectrum.h"

#include "base/memory.h"

#include <string.h>

#define SHORTER_RTOL 1e-12 /* a cut must be shorter by more than rounding, else it stays as it is */

typedef struct band {
    int32_t *ring;  /* n: 1 = touches the cut, 2 = next to those, ...; 0 = farther than the band */
    int32_t *queue; /* n: the band's nodes, ring by ring */
    int32_t *local; /* n: number in the band graph, -1 = outside */
    int32_t count;  /* nodes of the band and the fixed nodes around it */
    int32_t *node;  /* count */
    int8_t *seed;   /* count: +1, -1 fixed; 0 free */
    uint8_t *cut;   /* count: the minimum cut's sides */
    sl_graph graph;
} band;

static void band_clear(band *b)
{
    sl_free(b->ring);
    sl_free(b->queue);
    sl_free(b->local);
    sl_free(b->node);
    sl_free(b->seed);
    sl_free(b->cut);
    sl_graph_clear(&b->graph);
}

/* Breadth first from the cut. Returns the number of nodes in the band. */
static int32_t grow_rings(const sl_graph *g, const uint8_t *side, int32_t rings, int32_t *ring, int32_t *queue)
{
    int32_t count = 0;
    memset(ring, 0, (size_t)g->n * sizeof *ring);
    for (int32_t i = 0; i < g->n; i++) {
        for (int32_t p = g->first[i]; p < g->first[i + 1]; p++) {
            if (ring[i] == 0 && side[g->adj[p]] != side[i]) {
                ring[i] = 1;
                queue[count++] = i;
            }
        }
    }
    for (int32_t head = 0; head < count && ring[queue[head]] < rings; head++) {
        const int32_t i = queue[head];
        for (int32_t p = g->first[i]; p < g->first[i + 1]; p++) {
            const int32_t j = g->adj[p];
            if (ring[j] == 0) {
                ring[j] = ring[i] + 1;
                queue[count++] = j;
            }
        }
    }
    return count;
}

/* Fixes one side's innermost ring where the band has swallowed that side whole: else the minimum cut is empty. */
static void keep_a_core(const sl_graph *g, const uint8_t *side, uint8_t which, int32_t *ring)
{
    int32_t deepest = 0;
    for (int32_t i = 0; i < g->n; i++) {
        if (side[i] == which && ring[i] == 0) {
            return;
        }
        deepest = side[i] == which && ring[i] > deepest ? ring[i] : deepest;
    }
    for (int32_t i = 0; i < g->n; i++) {
        ring[i] = side[i] == which && ring[i] == deepest ? 0 : ring[i];
    }
}

/* Numbers the free nodes and the fixed ones next to them. */
static void number_band(const sl_graph *g, const uint8_t *side, band *b)
{
    b->count = 0;
    for (int32_t i = 0; i < g->n; i++) {
        bool wanted = b->ring[i] > 0;
        for (int32_t p = g->first[i]; !wanted && p < g->first[i + 1]; p++) {
            wanted = b->ring[g->adj[p]] > 0;
        }
        b->local[i] = wanted ? b->count : -1;
        if (wanted) {
            b->node[b->count] = i;
            b->seed[b->count++] = b->ring[i] > 0 ? 0 : side[i] == 1 ? 1 : -1;
        }
    }
}

static sl_status build_band_graph(const sl_mesh *mesh, const sl_facet_graph *graph, const double *weight, band *b)
{
    const sl_graph *g = &graph->graph;
    int32_t entries = 0;
    for (int32_t k = 0; k < b->count; k++) {
        entries += g->first[b->node[k] + 1] - g->first[b->node[k]];
    }
    b->graph = (sl_graph){b->count, sl_alloc((int64_t)b->count + 1, sizeof(int32_t)),
                          sl_alloc(entries, sizeof(int32_t)), sl_alloc(entries, sizeof(double))};
    if (b->graph.first == NULL || b->graph.adj == NULL || b->graph.weight == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    int32_t n = 0;
    for (int32_t k = 0; k < b->count; k++) {
        const int32_t i = b->node[k];
        b->graph.first[k] = n;
        for (int32_t p = g->first[i]; p < g->first[i + 1]; p++) {
            const int32_t j = b->local[g->adj[p]];
            if (j >= 0 && (b->seed[k] == 0 || b->seed[j] == 0)) { /* edges between fixed nodes decide nothing */
                b->graph.adj[n] = j;
                const int32_t h = graph->halfedge[p];
                b->graph.weight[n++] = sl_mesh_edge_length(mesh, h) * (weight != NULL ? weight[h] : 1.0);
            }
        }
    }
    b->graph.first[b->count] = n;
    return SL_OK;
}

/* Weighted length of the cut inside the band. */
static double band_length(const band *b, const uint8_t *side)
{
    double length = 0.0;
    for (int32_t k = 0; k < b->count; k++) {
        for (int32_t p = b->graph.first[k]; side[b->node[k]] == 1 && p < b->graph.first[k + 1]; p++) {
            length += side[b->node[b->graph.adj[p]]] == 0 ? b->graph.weight[p] : 0.0;
        }
    }
    return length;
}

static sl_status sides_connected(const sl_graph *g, const uint8_t *side, bool *connected)
{
    int32_t *key = sl_alloc(g->n, sizeof *key), *label = sl_alloc(g->n, sizeof *label);
    int32_t parts = 0;
    sl_status status = SL_OUT_OF_MEMORY;
    if (key != NULL && label != NULL) {
        bool positive = false, negative = false;
        for (int32_t i = 0; i < g->n; i++) {
            key[i] = side[i];
            positive = positive || side[i] == 1;
            negative = negative || side[i] == 0;
        }
        status = sl_graph_components(g, key, label, &parts);
        *connected = parts == 2 && positive && negative;
    }
    sl_free(key);
    sl_free(label);
    return status;
}

static sl_status band_create(const sl_mesh *mesh, const sl_facet_graph *graph, const double *weight, int32_t rings,
                             const uint8_t *side, band *b)
{
    const sl_graph *g = &graph->graph;
    *b = (band){.ring = sl_alloc(g->n, sizeof *b->ring),
                .queue = sl_alloc(g->n, sizeof *b->queue),
                .local = sl_alloc(g->n, sizeof *b->local),
                .node = sl_alloc(g->n, sizeof *b->node),
                .seed = sl_alloc(g->n, sizeof *b->seed),
                .cut = sl_alloc(g->n, sizeof *b->cut)};
    if (b->ring == NULL || b->queue == NULL || b->local == NULL || b->node == NULL || b->seed == NULL ||
        b->cut == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    grow_rings(g, side, rings, b->ring, b->queue);
    keep_a_core(g, side, 1, b->ring);
    keep_a_core(g, side, 0, b->ring);
    number_band(g, side, b);
    return build_band_graph(mesh, graph, weight, b);
}

/**
 * Shortens a cut within a band around it.
 *
 *     minimise the sum of weight times length of the edges between F+ and F-, nodes outside the band keeping their side
 *
 * @param[in]     mesh     for edge lengths
 * @param[in]     graph
 * @param[in]     weight   nh, positive, the same for both halfedges of an edge; NULL = 1
 * @param[in]     rings    width of the band on each side, in dual rings; 0 = no-op
 * @param[in,out] side     n; replaced only where *changed
 * @param[out]    changed  false where no shorter cut exists or a side would fall apart
 *
 * A side that lies wholly within the band keeps its innermost ring. SL_OUT_OF_MEMORY. One minimum cut of the band.
 */
sl_status sl_smooth_cut(const sl_mesh *mesh, const sl_facet_graph *graph, const double *weight, int32_t rings,
                        uint8_t *side, bool *changed)
{
    sl_status status = SL_OK;
    band b = {0};
    uint8_t *smoothed = NULL;
    *changed = false;
    if (rings <= 0) {
        return SL_OK;
    }
    SL_TRY(band_create(mesh, graph, weight, rings, side, &b));
    smoothed = sl_copy(side, graph->graph.n, sizeof *side);
    if (smoothed == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    double length = 0.0;
    SL_TRY(sl_graph_min_cut(&b.graph, b.seed, b.cut, &length));
    bool connected = false;
    for (int32_t k = 0; k < b.count; k++) {
        if (b.seed[k] == 0) {
            smoothed[b.node[k]] = b.cut[k];
        }
    }
    if (band_length(&b, smoothed) < (1.0 - SHORTER_RTOL) * band_length(&b, side)) {
        SL_TRY(sides_connected(&graph->graph, smoothed, &connected));
    }
    if (connected) {
        memcpy(side, smoothed, (size_t)graph->graph.n * sizeof *side);
        *changed = true;
    }
cleanup:
    sl_free(smoothed);
    band_clear(&b);
    return status;
}
