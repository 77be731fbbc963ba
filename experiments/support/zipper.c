#include "support/zipper.h"

#include <string.h>

/* Of the generated hand, in its own units: fingers up (+y), thumb to the left (-x). */
static const double wrist_y = -5.2; /* the seam is sewn from here */
static const double root_x = -4.4;  /* the thumb lies beyond */

static void place(const sl_mesh *mesh, int32_t h, double p[3])
{
    for (int k = 0; k < 3; k++) {
        p[k] = mesh->xyz[3 * (int64_t)mesh->origin[h] + k] / mesh->scale + mesh->centre[k];
    }
}

/* Two charts: palm and back. */
static sl_status cut_equator(sl_mesh *mesh, const sl_triangulation *t, const sl_context *context, int32_t *inside)
{
    sl_segmentation *seg = NULL;
    sl_segment_def def = sl_segment_paper();
    def.symmetry = SL_SYMMETRY_USE_OFF;
    def.max_charts = 2;
    sl_status status = sl_segment(mesh, t, &def, context, &seg);
    if (status == SL_OK) {
        status = seg->nchart == 2 ? SL_OK : SL_CHECK_FAILED;
        memcpy(inside, seg->face_chart, (size_t)mesh->nf * sizeof *inside);
    }
    sl_segmentation_free(seg);
    return status;
}

/* The seam's halfedges on one side in order, from the thumb's tip on; *count of them. SL_CHECK_FAILED: no loop. */
static sl_status walk_seam(const sl_mesh *mesh, const int32_t *side, int32_t *loop, int32_t *count)
{
    sl_status status = SL_OK;
    int32_t tip = -1, seams = 0, n = 0;
    int32_t *leaving = sl_alloc(mesh->nv, sizeof *leaving);
    if (leaving == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    memset(leaving, -1, (size_t)mesh->nv * sizeof *leaving);
    for (int32_t h = 0; h < mesh->nh; h++) {
        if (mesh->sew[h] >= 0 && side[mesh->face[h]] == 0) {
            double p[3], q[3];
            leaving[mesh->origin[h]] = h;
            place(mesh, h, p);
            place(mesh, tip < 0 ? h : tip, q);
            tip = tip < 0 || p[0] < q[0] ? h : tip;
            seams++;
        }
    }
    for (int32_t h = tip; h >= 0 && n < seams && (n == 0 || h != tip); n++) {
        loop[n] = h;
        h = leaving[sl_target(mesh, h)];
    }
    status = n > 0 && n == seams && sl_target(mesh, loop[n - 1]) == mesh->origin[tip] ? SL_OK : SL_CHECK_FAILED;
    *count = n;
    sl_free(leaving);
    return status;
}

/* Edges from the tip down to the wrist in one of the two directions of the loop. */
static int32_t edges_to_wrist(const sl_mesh *mesh, const int32_t *loop, int32_t count, bool forward)
{
    for (int32_t k = 0; k < count; k++) {
        double p[3];
        place(mesh, loop[forward ? k : count - 1 - k], p);
        if (p[1] < wrist_y) {
            return k;
        }
    }
    return count;
}

static sl_status list_edges(sl_mesh *mesh, const int32_t *loop, int32_t count, zipper *zip)
{
    const int32_t ways[2] = {edges_to_wrist(mesh, loop, count, false), edges_to_wrist(mesh, loop, count, true)};
    const bool forward = ways[1] < ways[0];
    double tip[3];
    zip->count = ways[forward];
    zip->halfedge = sl_alloc(zip->count, sizeof *zip->halfedge);
    zip->height = sl_alloc(zip->count, sizeof *zip->height);
    if (zip->halfedge == NULL || zip->height == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    place(mesh, loop[0], tip);
    for (int32_t k = 0; k < zip->count; k++) {
        const int32_t from_tip = zip->count - 1 - k;
        double p[3];
        zip->halfedge[k] = loop[forward ? from_tip : count - 1 - from_tip];
        place(mesh, zip->halfedge[k], p);
        zip->height[k] = (p[1] - wrist_y) / (tip[1] - wrist_y);
    }
    return zip->count > 0 ? SL_OK : SL_CHECK_FAILED;
}

sl_status zipper_open(sl_mesh *mesh, const sl_triangulation *triangulation, const sl_context *context, zipper *zip)
{
    sl_status status = SL_OK;
    int32_t count = 0;
    int32_t *side = sl_alloc(mesh->nf, sizeof *side), *loop = sl_alloc(mesh->nh, sizeof *loop);
    *zip = (zipper){.mesh = mesh};
    SL_TRY(side != NULL && loop != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(cut_equator(mesh, triangulation, context, side));
    SL_TRY(walk_seam(mesh, side, loop, &count));
    SL_TRY(list_edges(mesh, loop, count, zip));
cleanup:
    sl_free(side);
    sl_free(loop);
    return status;
}

int32_t zipper_close(zipper *zip, double height)
{
    int32_t sewn = 0;
    for (int32_t k = 0; k < zip->count; k++) {
        const bool below = zip->height[k] <= height;
        if (below) {
            sl_mesh_sew_edge(zip->mesh, zip->halfedge[k]);
        }
        sewn += below;
    }
    return sewn;
}

bool zipper_is_on_thumb(const sl_mesh *mesh, int32_t f)
{
    double c[3];
    sl_mesh_face_centroid(mesh, f, c);
    return c[0] / mesh->scale + mesh->centre[0] < root_x;
}

void zipper_clear(zipper *zip)
{
    sl_free(zip->halfedge);
    sl_free(zip->height);
}
