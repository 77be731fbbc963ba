#include "hand.h"

#include <stdio.h>

sl_status hand_compute(exp_run *run, const exp_source *source, hand_work *w)
{
    sl_status status = SL_OK;
    int32_t *label = NULL, *size = NULL, components = 0, largest = 0;
    *w = (hand_work){.tag = source->generated ? "hand" : "corpus-hand",
                     .title = source->generated ? "hand" : "hand (corpus)"};
    SL_TRY(exp_mesh_load(source, &w->input, &run->diag));
    SL_TRY(sl_mesh_build(&w->input.polygons, &w->mesh, NULL, &run->diag));
    SL_TRY(sl_triangulation_create(w->mesh, &w->triangulation));
    label = sl_alloc(w->mesh->nf, sizeof *label);
    size = sl_calloc(w->mesh->nf, sizeof *size);
    w->faces = sl_alloc(w->mesh->nf, sizeof *w->faces);
    if (label == NULL || size == NULL || w->faces == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    SL_TRY(sl_mesh_components(w->mesh, label, &components));
    for (int32_t f = 0; f < w->mesh->nf; f++) {
        size[label[f]]++;
        largest = size[label[f]] > size[largest] ? label[f] : largest;
    }
    for (int32_t f = 0; f < w->mesh->nf; f++) {
        if (label[f] == largest) {
            w->faces[w->face_count++] = f;
        }
    }
    SL_TRY(sl_facet_graph_create(w->mesh, w->faces, w->face_count, NULL, &w->graph));
    SL_TRY(sl_spectrum_compute(w->graph, HAND_VECTORS, &run->context, &w->spectrum));
    if (w->spectrum->count != HAND_VECTORS) {
        sl_diag_reason(&run->diag, "the hand has fewer than %d facets", HAND_VECTORS);
        SL_TRY(SL_BAD_INPUT);
    }
    SL_TRY(sl_cut_candidates(w->mesh, w->graph, w->spectrum, w->candidate));
cleanup:
    sl_free(label);
    sl_free(size);
    return status;
}

void hand_clear(hand_work *w)
{
    sl_spectrum_free(w->spectrum);
    sl_facet_graph_free(w->graph);
    sl_free(w->faces);
    sl_triangulation_free(w->triangulation);
    sl_mesh_free(w->mesh);
    exp_mesh_clear(&w->input);
    *w = (hand_work){0};
}

sl_status hand_write_csv(exp_run *run, const hand_work *w)
{
    char path[EXP_PATH], name[64];
    sl_writer *writer = NULL;
    snprintf(name, sizeof name, "%s.csv", w->tag);
    sl_status status = exp_path(run, name, path);
    if (status != SL_OK || (status = sl_writer_create(path, &writer, &run->diag)) != SL_OK) {
        return status;
    }
    sl_writer_text(writer, "vector,lambda,positive_parts,negative_parts,passes,seam_edges,seam_over_diagonal\n");
    for (int32_t k = 0; k < w->spectrum->count; k++) {
        const sl_cut_candidate none = {.positive_parts = 1}, *c = k > 0 ? &w->candidate[k - 1] : &none;
        sl_writer_format(writer, "%d,", k);
        sl_writer_double(writer, w->spectrum->lambda[k]);
        sl_writer_format(writer, ",%d,%d,%d,%d,", c->positive_parts, c->negative_parts, c->passes, c->seam_edges);
        sl_writer_double(writer, c->seam_length / sl_mesh_diagonal(w->mesh));
        sl_writer_text(writer, "\n");
    }
    return sl_writer_commit(writer, &run->diag);
}
