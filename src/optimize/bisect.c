/* Spectral bisections of one chart: the paper's cuts as candidates among the darts. */
#include "optimize/optimize_internal.h"

#include "base/memory.h"
#include "spectral/spectrum.h"

#include <math.h>
#include <string.h>

enum { BISECTIONS = 2, VECTORS = 6, RINGS = 2 };
static const int32_t FEWEST = 8; /* polygons that are worth a bisection */

/* The facet graph of a chart: its polygons over the edges that may be cut. */
typedef struct chart_graph {
    sl_facet_graph graph;
    int32_t *node;    /* nt: of a triangle of the patch */
    int32_t *crossed; /* patch halfedge behind an entry */
} chart_graph;

static void graph_clear(chart_graph *g)
{
    sl_graph_clear(&g->graph.graph);
    sl_free(g->graph.halfedge);
    sl_free(g->graph.centroid);
    sl_free(g->node);
    sl_free(g->crossed);
}

/* Triangles of one polygon are one node; they follow one another nowhere in particular. of_face: scratch, by facet. */
static sl_status number_nodes(const sl_opt_surface *s, const sl_patch *p, chart_graph *g)
{
    int32_t *of_face = sl_alloc(s->mesh->nf, sizeof *of_face);
    if (of_face == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t t = 0; t < p->nt; t++) {
        of_face[s->patch->facet[p->facet[t]]] = -1;
    }
    for (int32_t t = 0; t < p->nt; t++) {
        const int32_t f = s->patch->facet[p->facet[t]];
        if (of_face[f] < 0) {
            of_face[f] = g->graph.graph.n;
            sl_mesh_face_centroid(s->mesh, f, g->graph.centroid + 3 * (int64_t)g->graph.graph.n++);
        }
        g->node[t] = of_face[f];
    }
    sl_free(of_face);
    return SL_OK;
}

static bool crosses(const sl_opt_surface *s, const sl_patch *p, const chart_graph *g, int32_t c)
{
    return p->twin[c] >= 0 && s->cost[p->corner[c]] < HUGE_VAL && g->node[c / 3] != g->node[p->twin[c] / 3];
}

static void fill_rows(const sl_opt_surface *s, const sl_patch *p, chart_graph *g)
{
    sl_graph *graph = &g->graph.graph;
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        graph->first[g->node[c / 3]] += crosses(s, p, g, c);
    }
    int32_t sum = 0;
    for (int32_t v = 0; v < graph->n; v++) {
        sum += graph->first[v];
        graph->first[v] = sum;
    }
    graph->first[graph->n] = sum;
    for (int32_t c = 3 * p->nt; c-- > 0;) {
        if (crosses(s, p, g, c)) {
            const int32_t at = --graph->first[g->node[c / 3]];
            graph->adj[at] = g->node[p->twin[c] / 3];
            g->graph.halfedge[at] = s->patch->corner[p->corner[c]];
            g->crossed[at] = c;
        }
    }
}

static sl_status graph_init(const sl_opt_surface *s, const sl_patch *p, chart_graph *g)
{
    sl_status status = SL_OK;
    const int64_t nt = p->nt;
    g->node = sl_alloc(nt, sizeof *g->node);
    g->graph.centroid = sl_alloc(3 * nt, sizeof *g->graph.centroid);
    g->graph.graph.first = sl_calloc(nt + 1, sizeof *g->graph.graph.first);
    g->graph.graph.adj = sl_alloc(3 * nt, sizeof *g->graph.graph.adj);
    g->graph.halfedge = sl_alloc(3 * nt, sizeof *g->graph.halfedge);
    g->crossed = sl_alloc(3 * nt, sizeof *g->crossed);
    if (g->node == NULL || g->graph.centroid == NULL || g->graph.graph.first == NULL || g->graph.graph.adj == NULL ||
        g->graph.halfedge == NULL || g->crossed == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    SL_TRY(number_nodes(s, p, g));
    g->graph.node = g->node;
    fill_rows(s, p, g);
cleanup:
    return status;
}

static sl_status add_cut(const sl_patch *p, const chart_graph *g, const uint8_t *side, int32_t c, sl_opt_trial *trial)
{
    const sl_graph *graph = &g->graph.graph;
    *trial = (sl_opt_trial){.old = {c, -1}, .nto = 2, .edge = sl_alloc(graph->first[graph->n], sizeof *trial->edge)};
    if (trial->edge == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t v = 0; v < graph->n; v++) {
        for (int32_t k = graph->first[v]; side[v] != 0 && k < graph->first[v + 1]; k++) {
            if (side[graph->adj[k]] == 0) {
                trial->edge[trial->nedge++] = p->corner[g->crossed[k]];
            }
        }
    }
    return SL_OK;
}

sl_status sl_opt_bisections(const sl_opt_state *state, int32_t c, sl_opt_trial *list, int32_t *count)
{
    sl_status status = SL_OK;
    const sl_patch *p = state->chart[c].patch;
    chart_graph g = {0};
    sl_spectrum *spectrum = NULL;
    sl_cut_candidate candidate[VECTORS];
    uint8_t *side = NULL;
    SL_TRY(graph_init(state->surface, p, &g));
    if (g.graph.graph.n < FEWEST) {
        goto cleanup;
    }
    side = sl_alloc(g.graph.graph.n, sizeof *side);
    SL_TRY(side == NULL ? SL_OUT_OF_MEMORY : SL_OK);
    SL_TRY(sl_spectrum_compute_signs(&g.graph, VECTORS, NULL, &spectrum));
    SL_TRY(sl_cut_candidates(state->surface->mesh, &g.graph, spectrum, candidate));
    int taken = 0;
    for (int32_t k = 0; k + 1 < spectrum->count && taken < BISECTIONS; k++) {
        if (candidate[k].passes) {
            bool changed;
            sl_spectrum_side(spectrum, candidate[k].vector, side);
            SL_TRY(sl_smooth_cut(state->surface->mesh, &g.graph, state->surface->weight, RINGS, side, &changed));
            SL_TRY(add_cut(p, &g, side, c, &list[*count]));
            (*count)++;
            taken++;
        }
    }
cleanup:
    sl_free(side);
    sl_spectrum_free(spectrum);
    graph_clear(&g);
    return status;
}
