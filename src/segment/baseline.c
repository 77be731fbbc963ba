/* Cuts that are not spectral, in the same recursion: only where the surface is parted differs. */
#include "segment/baseline_internal.h"

#include "base/memory.h"
#include "geom/vec3.h"
#include "segment/vsa_internal.h"

static sl_status cut_by_axes(const sl_piece *piece, const sl_facet_graph *graph, int32_t *label, sl_choice *choice)
{
    sl_principal_axes axes;
    sl_principal_axes_compute(piece->mesh, piece->triangulation, &axes);
    sl_pca_sides(&axes, graph, label, &choice->vector);
    choice->found = choice->vector >= 0;
    choice->lambda = choice->found ? axes.variance[choice->vector] : 0.0;
    choice->candidates = choice->found;
    return SL_OK;
}

void sl_node_areas(const sl_piece *piece, const sl_facet_graph *graph, double *area, double *vector)
{
    const sl_mesh *m = piece->mesh;
    const sl_triangulation *t = piece->triangulation;
    for (int32_t f = 0; f < m->nf; f++) {
        const int64_t node = graph->node[f];
        for (int32_t i = t->first[f]; i < t->first[f + 1]; i++) {
            const double *p[3];
            double a[3], b[3], n[3];
            for (int k = 0; k < 3; k++) {
                p[k] = m->xyz + 3 * (int64_t)m->origin[t->corner[3 * i + k]];
            }
            sl_vec3_sub(p[1], p[0], a);
            sl_vec3_sub(p[2], p[0], b);
            sl_vec3_cross(a, b, n);
            area[node] += 0.5 * sl_vec3_norm(n);
            for (int k = 0; k < 3 && vector != NULL; k++) {
                vector[3 * node + k] += 0.5 * n[k];
            }
        }
    }
}

static sl_status cut_by_proxies(const sl_piece *piece, const sl_facet_graph *graph, const sl_segment_def *def,
                                const sl_context *context, int32_t *label, sl_choice *choice)
{
    sl_status status = SL_OK;
    const int32_t n = graph->graph.n;
    const sl_vsa_def how = {.regions = def->vsa_regions, .error = def->vsa_error, .most = def->max_charts};
    double *area = sl_calloc(n, sizeof *area), *vector = sl_calloc(3 * (int64_t)n, sizeof *vector);
    if (area == NULL || vector == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    sl_node_areas(piece, graph, area, vector);
    const sl_vsa_surface surface = {.graph = &graph->graph, .area = area, .vector = vector};
    SL_TRY(sl_vsa_partition(&surface, &how, context, label, &choice->vector, &choice->lambda));
    choice->candidates = 1;
    choice->found = choice->vector > 1;
cleanup:
    sl_free(area);
    sl_free(vector);
    return status;
}

/* The band minimum cut, as for a spectral cut; only two sides can be smoothed. */
static sl_status smooth(const sl_piece *piece, const sl_facet_graph *graph, int32_t rings, int32_t *label,
                        bool *smoothed)
{
    sl_status status = SL_OK;
    const int32_t n = graph->graph.n;
    uint8_t *side = sl_alloc(n, sizeof *side);
    if (side == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t i = 0; i < n; i++) {
        side[i] = (uint8_t)label[i];
    }
    SL_TRY(sl_smooth_cut(piece->mesh, graph, piece->weight, rings, side, smoothed));
    for (int32_t i = 0; i < n; i++) {
        label[i] = side[i];
    }
cleanup:
    sl_free(side);
    return status;
}

/* Two sides, and no refinement of the method's own. */
static bool can_be_smoothed(sl_cut_method method, const sl_choice *choice)
{
    const bool halves = method == SL_METHOD_PCA || method == SL_METHOD_FIEDLER || choice->vector == 2;
    return halves && method != SL_METHOD_ISOCHARTS;
}

static sl_status label_nodes(const sl_piece *piece, const sl_facet_graph *graph, const sl_segment_def *def,
                             const sl_context *context, int32_t *label, sl_choice *choice)
{
    switch (def->method) {
    case SL_METHOD_PCA:
        return cut_by_axes(piece, graph, label, choice);
    case SL_METHOD_VSA:
        return cut_by_proxies(piece, graph, def, context, label, choice);
    case SL_METHOD_FIEDLER:
        return sl_fiedler_labels(graph, def, context, label, choice);
    case SL_METHOD_RANDOM:
        return sl_random_labels(piece, graph, def, label, choice);
    case SL_METHOD_ISOCHARTS:
        return sl_isocharts_labels(piece, graph, def, context, label, choice);
    case SL_METHOD_EMBEDDING:
        return sl_embedding_labels(piece, graph, def, context, label, choice);
    case SL_METHOD_SPECTRAL:
        break;
    }
    return SL_INTERNAL;
}

sl_status sl_choose_baseline(const sl_piece *piece, const sl_facet_graph *graph, const sl_segment_def *def,
                             const sl_context *context, sl_choice *choice)
{
    sl_status status = SL_OK;
    const int32_t nf = piece->mesh->nf;
    *choice = (sl_choice){.side = sl_alloc(nf, sizeof *choice->side)};
    int32_t *label = sl_alloc(graph->graph.n, sizeof *label);
    if (choice->side == NULL || label == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    SL_TRY(label_nodes(piece, graph, def, context, label, choice));
    if (choice->found && can_be_smoothed(def->method, choice)) {
        SL_TRY(smooth(piece, graph, def->smooth, label, &choice->smoothed));
    }
    if (choice->found) {
        for (int32_t f = 0; f < nf; f++) {
            choice->side[f] = label[graph->node[f]];
        }
        sl_choice_measure(piece->mesh, choice);
    }
cleanup:
    sl_free(label);
    if (status != SL_OK || !choice->found) {
        sl_choice_clear(choice);
    }
    return status;
}
