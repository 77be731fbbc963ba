#include "support/spectrum.h"

#include <math.h>

static sl_status largest_component(exp_spectrum *s)
{
    sl_status status = SL_OK;
    int32_t *label = sl_alloc(s->mesh->nf, sizeof *label), *size = sl_calloc(s->mesh->nf, sizeof *size);
    int32_t components = 0, largest = 0;
    s->faces = sl_alloc(s->mesh->nf, sizeof *s->faces);
    if (label == NULL || size == NULL || s->faces == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    SL_TRY(sl_mesh_components(s->mesh, label, &components));
    for (int32_t f = 0; f < s->mesh->nf; f++) {
        size[label[f]]++;
        largest = size[label[f]] > size[largest] ? label[f] : largest;
    }
    for (int32_t f = 0; f < s->mesh->nf; f++) {
        if (label[f] == largest) {
            s->faces[s->face_count++] = f;
        }
    }
cleanup:
    sl_free(label);
    sl_free(size);
    return status;
}

sl_status exp_spectrum_make(exp_run *run, const sl_polygons *polygons, int32_t vectors, exp_spectrum *out)
{
    sl_status status = SL_OK;
    *out = (exp_spectrum){0};
    SL_TRY(sl_mesh_build(polygons, &out->mesh, NULL, &run->diag));
    SL_TRY(sl_triangulation_create(out->mesh, &out->triangulation));
    SL_TRY(largest_component(out));
    SL_TRY(sl_facet_graph_create(out->mesh, out->faces, out->face_count, NULL, &out->graph));
    SL_TRY(sl_spectrum_compute(out->graph, vectors, &run->context, &out->spectrum));
    out->candidate = sl_alloc(vectors, sizeof *out->candidate);
    if (out->candidate == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    SL_TRY(sl_cut_candidates(out->mesh, out->graph, out->spectrum, out->candidate));
cleanup:
    return status;
}

void exp_spectrum_clear(exp_spectrum *s)
{
    sl_free(s->candidate);
    sl_spectrum_free(s->spectrum);
    sl_facet_graph_free(s->graph);
    sl_free(s->faces);
    sl_triangulation_free(s->triangulation);
    sl_mesh_free(s->mesh);
    *s = (exp_spectrum){0};
}

void exp_spectrum_values(const exp_spectrum *s, int32_t k, double *value)
{
    const double *v = s->spectrum->vectors + (int64_t)k * s->spectrum->n;
    for (int32_t f = 0; f < s->mesh->nf; f++) {
        value[f] = NAN;
    }
    for (int32_t i = 0; i < s->face_count; i++) {
        value[s->faces[i]] = v[s->graph->node[i]];
    }
}

int32_t exp_spectrum_seam(const exp_spectrum *s, int32_t k, uint8_t *side, int32_t *edge)
{
    const sl_graph *graph = &s->graph->graph;
    int32_t edges = 0;
    sl_spectrum_side(s->spectrum, k, side);
    for (int32_t i = 0; i < graph->n; i++) {
        for (int32_t p = graph->first[i]; p < graph->first[i + 1]; p++) {
            if (side[i] == 1 && side[graph->adj[p]] == 0) {
                edge[edges++] = s->graph->halfedge[p];
            }
        }
    }
    return edges;
}
