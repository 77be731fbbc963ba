/* The paper's test for symmetry: after a cut, are the two halves isomorphic? */
#include "segment/share_internal.h"

#include "base/memory.h"

#include <math.h>

/* Do corresponding edges agree in length? */
static bool lengths_agree(const sl_mesh *mesh, const int32_t *image, bool reverses)
{
    const double tolerance = sl_symmetry_default().exact;
    for (int32_t h = 0; h < mesh->nh; h++) {
        if (image[h] >= 0) {
            const int32_t g = reverses ? sl_prev(mesh, image[h]) : image[h];
            const double a = sl_mesh_edge_length(mesh, h), b = sl_mesh_edge_length(mesh, g);
            if (fabs(a - b) > tolerance * fmax(a, b)) {
                return false;
            }
        }
    }
    return true;
}

static sl_status take_copies(const sl_mesh *mesh, const int32_t *image, bool reverses, sl_chart_job *job)
{
    sl_copy_list *copies = &job->copies;
    copies->corner = sl_alloc(mesh->nh, sizeof *copies->corner);
    copies->from = sl_alloc(mesh->nh, sizeof *copies->from);
    if (copies->corner == NULL || copies->from == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    copies->reverses = reverses;
    copies->kind = SL_SYMMETRY_EXACT;
    for (int32_t h = 0; h < mesh->nh; h++) {
        if (image[h] >= 0) {
            copies->corner[copies->count] = image[h];
            copies->from[copies->count++] = h;
        }
    }
    for (int32_t f = 0; f < mesh->nf; f++) {
        job->part[f] = job->part[f] == 0 ? 0 : -1;
    }
    job->nparts = 1;
    job->split.symmetry = SL_SPLIT_HALVES;
    return SL_OK;
}

/**
 * Shares the second half of a cut with the first where they are isomorphic.
 *
 * Both halves are walked at once from the two halfedges of a seam edge. First the mirror image is tried: the edge is on
 * the axis, its vertices stay, so corner h goes to the corner of the other facet at the same vertex. Then the half turn
 * about the edge's middle: h goes to its opposite. One edge decides: on an axis every edge has its own image.
 *
 * @param[in]     piece  cut into two connected parts, the seam's twins turned into sewing pointers
 * @param[in,out] job    parts, seam and split of that cut, in numbers of the piece
 *
 * SL_OUT_OF_MEMORY. Linear.
 * Source: Sec. 4.3.  Deviations: edge lengths must agree, too; the half turn.
 */
sl_status sl_share_halves(const sl_piece *piece, sl_chart_job *job)
{
    sl_status status = SL_OK;
    const sl_mesh *m = piece->mesh;
    int32_t *image = sl_alloc(m->nh, sizeof *image);
    if (image == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int turn = 0; turn < 2 && job->nparts == 2 && job->seam.count > 0; turn++) {
        const bool reverses = turn == 0;
        bool found = false;
        int32_t a = job->seam.halfedge[0];
        a = job->part[m->face[a]] == 0 ? a : m->sew[a];
        const int32_t b = reverses ? sl_next(m, m->sew[a]) : m->sew[a];
        SL_TRY(sl_symmetry_traverse(m, a, b, reverses, image, &found));
        if (found && lengths_agree(m, image, reverses)) {
            SL_TRY(take_copies(m, image, reverses, job));
        }
    }
cleanup:
    sl_free(image);
    return status;
}
