#include "hand.h"

#include <stdio.h>

sl_status hand_compute(exp_run *run, const exp_source *source, hand_work *w)
{
    sl_status status = SL_OK;
    *w = (hand_work){.tag = source->generated ? "hand" : "corpus-hand",
                     .title = source->generated ? "hand" : "hand (corpus)"};
    SL_TRY(exp_mesh_load(source, &w->input, &run->diag));
    SL_TRY(exp_spectrum_make(run, &w->input.polygons, HAND_VECTORS, &w->s));
    if (w->s.spectrum->count != HAND_VECTORS) {
        sl_diag_reason(&run->diag, "the hand has fewer than %d facets", HAND_VECTORS);
        SL_TRY(SL_BAD_INPUT);
    }
cleanup:
    return status;
}

void hand_clear(hand_work *w)
{
    exp_spectrum_clear(&w->s);
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
    for (int32_t k = 0; k < w->s.spectrum->count; k++) {
        const sl_cut_candidate none = {.positive_parts = 1}, *c = k > 0 ? &w->s.candidate[k - 1] : &none;
        sl_writer_format(writer, "%d,", k);
        sl_writer_double(writer, w->s.spectrum->lambda[k]);
        sl_writer_format(writer, ",%d,%d,%d,%d,", c->positive_parts, c->negative_parts, c->passes, c->seam_edges);
        sl_writer_double(writer, c->seam_length / sl_mesh_diagonal(w->s.mesh));
        sl_writer_text(writer, "\n");
    }
    return sl_writer_commit(writer, &run->diag);
}
