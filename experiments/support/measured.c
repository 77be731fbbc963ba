#include "atlas/weld.h"
#include "support/methods.h"
#include "support/turning.h"

#include <math.h>
#include <string.h>

enum { TEXELS = 1024 };

static const double axis_reach = 1e-5; /* of the diagonal: files of other tools have six digits */

/* Does the mirror leave the vertex where it is? By number where the mesh is the one generated, else by position. */
static bool stays(const sl_planted *mirror, const sl_polygons *polygons, int32_t v, bool by_number, double reach)
{
    if (by_number) {
        return mirror->vertex[v] == v;
    }
    const double *p = polygons->xyz + 3 * (int64_t)v, *m = mirror->matrix;
    double square = 0.0;
    for (int k = 0; k < 3; k++) {
        const double d = m[4 * k] * p[0] + m[4 * k + 1] * p[1] + m[4 * k + 2] * p[2] + m[4 * k + 3] - p[k];
        square += d * d;
    }
    return square <= reach * reach;
}

static double share_of_axis(const sl_mesh *mesh, const sl_polygons *polygons, const sl_planted *mirror, bool by_number)
{
    const double reach = axis_reach * sl_mesh_diagonal(mesh) / mesh->scale;
    double seam = 0.0, all = 0.0;
    for (int32_t h = 0; h < mesh->nh; h++) {
        const int32_t a = mesh->input_vertex[mesh->origin[h]], b = mesh->input_vertex[sl_target(mesh, h)];
        if (stays(mirror, polygons, a, by_number, reach) && stays(mirror, polygons, b, by_number, reach)) {
            const double length = sl_mesh_edge_length(mesh, h);
            seam += mesh->sew[h] >= 0 ? length : 0.0;
            all += length;
        }
    }
    return all > 0.0 ? seam / all : -1.0;
}

double exp_axis_kept(const sl_mesh *mesh, const sl_polygons *polygons, const sl_generated *made, bool by_number)
{
    double best = -1.0;
    for (int32_t k = 0; made != NULL && k < made->nplanted; k++) {
        if (made->planted[k].mirror) {
            best = fmax(best, share_of_axis(mesh, polygons, &made->planted[k], by_number));
        }
    }
    return best;
}

/* mesh: cut along the seams of the UVs. by_number: its input vertices are those of `made`. */
static sl_status take_numbers(exp_run *run, const sl_polygons *polygons, const double *corner_uv, const sl_mesh *mesh,
                              const sl_generated *made, bool by_number, exp_numbers *out)
{
    sl_atlas_measure m;
    const sl_status status = sl_measure_atlas(polygons, corner_uv, TEXELS, &run->context, &m, &run->diag);
    if (status != SL_OK) {
        return status;
    }
    *out = (exp_numbers){.axis = exp_axis_kept(mesh, polygons, made, by_number),
                         .overlap = m.overlap_inside + m.overlap_across,
                         .fill = m.fill,
                         .flipped = m.global.flipped};
    out->metric[EXP_CHARTS] = m.charts;
    out->metric[EXP_SEAM] = m.seam_diagonal;
    out->metric[EXP_STRETCH] = m.global.l2;
    out->metric[EXP_ANGLE] = m.global.angle_mean;
    out->metric[EXP_AREA] = m.global.area_mean;
    out->metric[EXP_JAGGED] = exp_seam_turning(mesh);
    return SL_OK;
}

sl_status exp_unwrap_way(exp_run *run, const sl_polygons *polygons, const sl_generated *made, int way, exp_numbers *out,
                         sl_atlas **atlas)
{
    sl_status status = SL_OK;
    sl_atlas *made_atlas = NULL;
    const sl_atlas_def def = exp_way_def(way);
    *out = (exp_numbers){.failed = true};
    const double start = exp_cpu_seconds();
    SL_TRY(sl_unwrap(polygons, &def, &run->context, &made_atlas, &run->diag));
    const double seconds = exp_cpu_seconds() - start;
    SL_TRY(take_numbers(run, polygons, made_atlas->input_corner_uv, made_atlas->mesh, made, true, out));
    out->metric[EXP_SECONDS] = seconds;
    out->bad = !made_atlas->check.passed;
    if (atlas != NULL) {
        *atlas = made_atlas;
        made_atlas = NULL;
    }
cleanup:
    sl_atlas_free(made_atlas);
    return status;
}

/* The same facets between vertices that are one where they lie at one place. *index is the caller's. */
static sl_status weld(const sl_polygons *polygons, sl_polygons *welded, int32_t **index, double **xyz)
{
    sl_status status = SL_OK;
    const int32_t corners = polygons->face_first[polygons->nf];
    int32_t count = 0, *id = sl_alloc(polygons->nv, sizeof *id);
    *index = sl_alloc(corners, sizeof **index);
    *xyz = sl_alloc(3 * (int64_t)polygons->nv, sizeof **xyz);
    if (id == NULL || *index == NULL || *xyz == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    SL_TRY(sl_weld_points(polygons->nv, 3, polygons->xyz, id, &count));
    for (int32_t v = 0; v < polygons->nv; v++) {
        memcpy(*xyz + 3 * (int64_t)id[v], polygons->xyz + 3 * (int64_t)v, 3 * sizeof **xyz);
    }
    for (int32_t c = 0; c < corners; c++) {
        (*index)[c] = id[polygons->index[c]];
    }
    *welded = (sl_polygons){count, polygons->nf, *xyz, polygons->face_first, *index};
cleanup:
    sl_free(id);
    return status;
}

sl_status exp_measure_uv(exp_run *run, const sl_polygons *polygons, const double *corner_uv, const sl_generated *made,
                         exp_numbers *out)
{
    sl_status status = SL_OK;
    sl_polygons welded;
    sl_mesh *mesh = NULL;
    int32_t *index = NULL;
    double *xyz = NULL;
    const sl_seam_input seams = {.corner_uv = corner_uv};
    *out = (exp_numbers){.failed = true};
    SL_TRY(weld(polygons, &welded, &index, &xyz));
    SL_TRY(sl_mesh_build(&welded, &mesh, NULL, &run->diag));
    SL_TRY(sl_seams_cut(mesh, SL_SEAMS_KEEP_UV, &seams, &run->diag));
    SL_TRY(take_numbers(run, &welded, corner_uv, mesh, made, false, out));
cleanup:
    sl_mesh_free(mesh);
    sl_free(index);
    sl_free(xyz);
    return status;
}
