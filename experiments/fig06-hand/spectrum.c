#include "hand.h"
#include "support/csv.h"

#include <stdio.h>

sl_status hand_compute(exp_run *run, const exp_source *source, const hand_pose *pose, hand_work *w)
{
    sl_status status = SL_OK;
    *w = (hand_work){.pose = pose};
    SL_TRY(exp_mesh_load(source, &w->input, &run->diag));
    w->xyz = sl_alloc(3 * (int64_t)w->input.polygons.nv, sizeof *w->xyz);
    if (w->xyz == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    hand_move_into(&w->input.polygons, pose, w->xyz);
    sl_polygons posed = w->input.polygons;
    posed.xyz = w->xyz;
    SL_TRY(exp_spectrum_make(run, &posed, HAND_VECTORS, &w->s));
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
    sl_free(w->xyz);
    *w = (hand_work){0};
}

sl_status hand_write_csv(exp_run *run, const hand_work *w)
{
    sl_status status = SL_OK;
    char name[64];
    sl_writer *csv = NULL;
    snprintf(name, sizeof name, "%s.csv", w->pose->tag);
    SL_TRY(exp_csv_open(run, name, "vector,lambda,positive_parts,negative_parts,passes,seam_edges,seam_over_diagonal",
                        &csv));
    for (int32_t k = 0; k < w->s.spectrum->count; k++) {
        const sl_cut_candidate none = {.positive_parts = 1}, *c = k > 0 ? &w->s.candidate[k - 1] : &none;
        const double seam = c->seam_length / sl_mesh_diagonal(w->s.mesh);
        sl_writer_format(csv, "%d", k);
        exp_csv_numbers(csv, &w->s.spectrum->lambda[k], 1);
        sl_writer_format(csv, ",%d,%d,%d,%d", c->positive_parts, c->negative_parts, c->passes, c->seam_edges);
        exp_csv_numbers(csv, &seam, 1);
        sl_writer_text(csv, "\n");
    }
    SL_TRY(exp_csv_close(run, &csv));
cleanup:
    sl_writer_abandon(csv);
    return status;
}
