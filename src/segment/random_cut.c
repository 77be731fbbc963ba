/* Cuts at random: what any method must beat. */
#include "segment/baseline_internal.h"

#include "base/memory.h"
#include "base/rng.h"
#include "geom/vec3.h"

/* A node drawn with chances proportional to area. */
static int32_t draw_node(const double *area, int32_t n, double total, sl_rng *rng)
{
    const double at = sl_rng_uniform(rng) * total;
    double sum = 0.0;
    int32_t i = 0;
    while (i < n - 1 && (sum += area[i]) <= at) {
        i++;
    }
    return i;
}

/* Random numbers of a piece: by the seed, and where the piece is, so that parts differ. */
static sl_rng piece_rng(const sl_piece *piece, int32_t seed)
{
    sl_rng rng = sl_rng_seed((uint64_t)seed);
    const uint64_t salt[2] = {sl_rng_bits(&rng), sl_rng_bits(&rng) | 1};
    return sl_rng_seed(salt[0] + salt[1] * (uint64_t)(piece->face[0] + 1) + ((uint64_t)piece->mesh->nf << 32));
}

/* The graph with the distances between the centroids of neighbours as weights; rows and columns borrowed. */
static sl_status weigh(const sl_facet_graph *graph, sl_graph *out)
{
    const sl_graph *g = &graph->graph;
    *out = *g;
    out->weight = sl_alloc(g->first[g->n], sizeof *out->weight);
    for (int32_t i = 0; i < g->n && out->weight != NULL; i++) {
        for (int32_t p = g->first[i]; p < g->first[i + 1]; p++) {
            double d[3];
            sl_vec3_sub(graph->centroid + 3 * (int64_t)i, graph->centroid + 3 * (int64_t)g->adj[p], d);
            out->weight[p] = sl_vec3_norm(d);
        }
    }
    return out->weight != NULL ? SL_OK : SL_OUT_OF_MEMORY;
}

/**
 * A random cut: the surface goes to the nearer of two random facets.
 *
 * The two are drawn with chances proportional to area; distances are those of shortest paths from centroid to centroid,
 * so that both sides hang together. A floor for comparisons: its seams know nothing of the shape.
 *
 * SL_OUT_OF_MEMORY. Deterministic by def->seed.
 * Source: Erwig 2000, "The graph Voronoi diagram with applications" (the cells); the choice of seeds is ours.
 */
sl_status sl_random_labels(const sl_piece *piece, const sl_facet_graph *graph, const sl_segment_def *def,
                           int32_t *label, sl_choice *choice)
{
    sl_status status = SL_OK;
    const int32_t n = graph->graph.n;
    sl_rng rng = piece_rng(piece, def->seed);
    sl_graph weighed = {0};
    double *area = sl_calloc(n, sizeof *area), *distance = sl_alloc(2 * (int64_t)n, sizeof *distance), total = 0.0;
    int32_t *parent = sl_alloc(n, sizeof *parent), source[2];
    SL_TRY(area != NULL && distance != NULL && parent != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(weigh(graph, &weighed));
    sl_node_areas(piece, graph, area, NULL);
    for (int32_t i = 0; i < n; i++) {
        total += area[i];
    }
    source[0] = draw_node(area, n, total, &rng);
    total -= area[source[0]];
    area[source[0]] = 0.0;
    source[1] = draw_node(area, n, total, &rng);
    source[1] = source[1] != source[0] ? source[1] : (source[0] + 1) % n;
    for (int k = 0; k < 2; k++) {
        SL_TRY(sl_graph_shortest_paths(&weighed, &source[k], 1, NULL, -1, distance + k * (int64_t)n, parent, NULL));
    }
    for (int32_t i = 0; i < n; i++) {
        label[i] = i != source[0] && (i == source[1] || distance[n + (int64_t)i] < distance[i]);
    }
    choice->vector = 2;
    choice->lambda = 0.0;
    choice->candidates = 1;
    choice->found = true;
cleanup:
    sl_free(weighed.weight);
    sl_free(area);
    sl_free(distance);
    sl_free(parent);
    return status;
}
