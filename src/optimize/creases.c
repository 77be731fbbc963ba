/* Machined parts: the search starts at their creases, too, and the cheaper of both ends stands. */
#include "optimize/optimize_internal.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

static const double CREASE = 30.0 * 0.017453292519943295; /* dihedral angle at which smooth parts meet */
static const double DEVELOPABLE = 1.001;                  /* L2 of a part that needs no cut of its own */
static const int32_t MOST_PARTS = 24, LEAST_FACETS = 12;  /* of a mesh; of a part in the mean */

/* Labels parts of facets joined over edges that are no crease, in the order of their first facets. */
static sl_status label_smooth_parts(const sl_mesh *mesh, int32_t *label, int32_t *count)
{
    int32_t *stack = sl_alloc(mesh->nf, sizeof *stack);
    if (stack == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    memset(label, 0xff, (size_t)mesh->nf * sizeof *label);
    *count = 0;
    for (int32_t f = 0; f < mesh->nf; f++) {
        int32_t top = 0;
        if (label[f] < 0) {
            label[f] = (*count)++;
            stack[top++] = f;
        }
        while (top > 0) {
            const int32_t at = stack[--top];
            for (int32_t h = mesh->face_first[at]; h < mesh->face_first[at + 1]; h++) {
                const int32_t g = mesh->twin[h] >= 0 ? mesh->face[mesh->twin[h]] : -1;
                if (g >= 0 && label[g] < 0 && fabs(sl_seam_dihedral(mesh, h)) < CREASE) {
                    label[g] = label[at];
                    stack[top++] = g;
                }
            }
        }
    }
    sl_free(stack);
    return SL_OK;
}

/* Cuts the mesh where its smooth parts meet; *worth = they are few and large, as on machined parts. */
static sl_status cut_creases(sl_mesh *mesh, bool *worth)
{
    sl_status status = SL_OK;
    int32_t count = 0, *label = sl_alloc(mesh->nf, sizeof *label);
    SL_TRY(label == NULL ? SL_OUT_OF_MEMORY : SL_OK);
    SL_TRY(label_smooth_parts(mesh, label, &count));
    *worth = count >= 2 && count <= MOST_PARTS && mesh->nf >= LEAST_FACETS * count;
    for (int32_t h = 0; h < mesh->nh && *worth; h++) {
        if (mesh->twin[h] >= 0 && label[mesh->face[h]] != label[mesh->face[mesh->twin[h]]]) {
            sl_mesh_cut_edge(mesh, h);
        }
    }
cleanup:
    sl_free(label);
    return status;
}

/* The smooth parts between creases as charts, where each of them is nearly flat or a developable; sewing makes few of
 * them. *started = false otherwise. */
static sl_status start_at_creases(sl_opt_state *state, const sl_segment_def *segment,
                                  const sl_triangulation *triangulation, bool *started)
{
    sl_status status = SL_OK;
    sl_mesh *mesh = NULL;
    sl_segmentation *seg = NULL;
    sl_segment_def def = *segment;
    def.cutter = NULL;
    def.join = true;
    *started = false;
    SL_TRY(sl_mesh_copy(state->surface->mesh, &mesh));
    SL_TRY(cut_creases(mesh, started));
    if (!*started) {
        goto cleanup;
    }
    SL_TRY(sl_flatten_charts(mesh, triangulation, &def, state->context, &seg));
    for (int32_t c = 0; c < seg->nchart; c++) {
        const sl_flatten_result *flat = &seg->chart[c].flat;
        *started = *started && flat->verdict == SL_CHART_VALID && flat->distortion.l2 <= DEVELOPABLE;
    }
    if (*started) {
        SL_TRY(sl_opt_take(state, mesh, seg, started));
    }
cleanup:
    sl_mesh_free(mesh);
    sl_segmentation_free(seg);
    return status;
}

/* Both meet the targets or neither, or only one does: that one; then the price. */
static bool is_better(const sl_opt_state *a, const sl_opt_state *b)
{
    sl_opt_total of_a, of_b;
    sl_opt_totals(a, &of_a);
    sl_opt_totals(b, &of_b);
    const bool within_a = sl_opt_within(a, &of_a), within_b = sl_opt_within(b, &of_b);
    return within_a != within_b ? within_a : sl_opt_price(a) < sl_opt_price(b);
}

sl_status sl_opt_search_creases(sl_opt_state *state, const sl_segment_def *segment,
                                const sl_triangulation *triangulation)
{
    sl_status status = SL_OK;
    bool started = false;
    sl_opt_state other = {0};
    if (state->surface->weight == NULL || state->def->protect == SL_PROTECT_FIRST) {
        return SL_OK;
    }
    SL_TRY(sl_opt_state_init(state->surface, state->def, state->context, &other));
    SL_TRY(start_at_creases(&other, segment, triangulation, &started));
    if (started) {
        SL_TRY(sl_opt_search(&other));
        if (is_better(&other, state)) {
            const sl_opt_state swap = *state;
            *state = other;
            other = swap;
        }
        sl_opt_add_info(&other.info, &state->info);
        state->machined = true;
    }
cleanup:
    sl_opt_state_clear(&other);
    return status;
}
