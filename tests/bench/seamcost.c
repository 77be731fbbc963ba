/* Where the seams of finished atlases run.
 *
 *     seamcost_bench FILE...
 *
 * FILE: a mesh with UVs. A line each: length of the seams over the root of the area; share of it on creases (dihedral
 * angle above 30 degrees); mean ambient visibility of the seams and of all edges; mean weight (all parts) of both; mean
 * turn at the seams' inner vertices, pi minus the smaller angle in space. Means are by length. */
#include "seamcost/seamcost.h"
#include "atlas/seams.h"
#include "base/memory.h"
#include "geom/vec3.h"
#include "mesh/build.h"
#include "mesh/facet_graph.h"
#include "meshio/meshfile.h"

#include <math.h>
#include <stdio.h>

static const double CREASE = 30.0 * 0.017453292519943295;
static const double PAIRED = 0.9; /* share of triangles in pairs from which a mesh counts as quads */

typedef struct sums {
    double length, crease, visible, weight;
} sums;

static void add(sums *s, double length, bool crease, double visible, double weight)
{
    s->length += length;
    s->crease += crease ? length : 0.0;
    s->visible += length * visible;
    s->weight += length * weight;
}

/* Mean angle by which seams turn where two seam edges meet. */
static sl_status mean_turn(const sl_mesh *m, double *turn)
{
    int32_t *count = sl_calloc(m->nv, sizeof *count);
    double(*side)[3] = sl_calloc(m->nv, sizeof *side), sum = 0.0;
    int32_t n = 0;
    *turn = 0.0;
    if (count == NULL || side == NULL) {
        sl_free(count);
        sl_free(side);
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t h = 0; h < m->nh; h++) {
        if (m->sew[h] > h) {
            const int32_t v[2] = {m->origin[h], sl_target(m, h)};
            for (int k = 0; k < 2; k++) {
                double d[3];
                sl_vec3_sub(m->xyz + 3 * (int64_t)v[1 - k], m->xyz + 3 * (int64_t)v[k], d);
                const double length = sl_vec3_norm(d);
                for (int j = 0; j < 3 && length > 0.0; j++) {
                    side[v[k]][j] += d[j] / length;
                }
                count[v[k]]++;
            }
        }
    }
    for (int32_t v = 0; v < m->nv; v++) {
        if (count[v] == 2) { /* |a + b| = 2 sin(turn / 2) */
            sum += 2.0 * asin(fmin(0.5 * sl_vec3_norm(side[v]), 1.0));
            n++;
        }
    }
    *turn = n > 0 ? sum / n : 0.0;
    sl_free(count);
    sl_free(side);
    return SL_OK;
}

static sl_status look(sl_mesh *m, const char *name)
{
    sl_status status = SL_OK;
    sums seam = {0}, all = {0};
    double area = 0.0, turn = 0.0, fraction = 0.0;
    sl_seam_cost_def def = sl_seam_cost_default();
    double *visible = sl_alloc(m->nf, sizeof *visible), *weight = sl_alloc(m->nh, sizeof *weight);
    int32_t *partner = sl_alloc(m->nf, sizeof *partner);
    SL_TRY(visible == NULL || weight == NULL || partner == NULL ? SL_OUT_OF_MEMORY : SL_OK);
    SL_TRY(sl_ambient_compute(m, &def.ambient, NULL, visible));
    SL_TRY(sl_pair_triangles(m, partner, &fraction));
    def.visible = visible;
    def.partner = fraction >= PAIRED ? partner : NULL;
    SL_TRY(sl_seam_cost_compute(m, &def, NULL, weight));
    SL_TRY(mean_turn(m, &turn));
    for (int32_t h = 0; h < m->nh; h++) {
        const int32_t t = sl_opposite(m, h);
        if (h < t) {
            const double length = sl_mesh_edge_length(m, h);
            const bool crease = fabs(sl_seam_dihedral(m, h)) > CREASE;
            const double seen = 0.5 * (visible[m->face[h]] + visible[m->face[t]]);
            add(&all, length, crease, seen, weight[h]);
            if (m->twin[h] < 0) {
                add(&seam, length, crease, seen, weight[h]);
            }
        }
    }
    for (int32_t f = 0; f < m->nf; f++) {
        area += sl_mesh_face_area(m, f);
    }
    printf(
        "%-28s length %6.3f  on creases %.3f (all edges %.3f)  visible %.3f (%.3f)  weight %.3f (%.3f)  turn %4.1f\n",
        name, seam.length / sqrt(area), seam.crease / seam.length, all.crease / all.length, seam.visible / seam.length,
        all.visible / all.length, seam.weight / seam.length, all.weight / all.length, turn / 0.017453292519943295);
cleanup:
    sl_free(visible);
    sl_free(weight);
    sl_free(partner);
    return status;
}

static sl_status look_at_file(const char *path)
{
    sl_status status = SL_OK;
    sl_diag diag = sl_diag_none();
    sl_meshfile *file = NULL;
    sl_polygons polygons;
    sl_repair_report report = {0};
    sl_mesh *mesh = NULL;
    SL_TRY(sl_meshfile_read(path, &file, &diag));
    sl_meshfile_polygons(file, &polygons);
    SL_TRY(sl_mesh_build(&polygons, &mesh, &report, &diag));
    const sl_seam_input input = {.corner_uv = file->corner_uv};
    SL_TRY(sl_seams_cut(mesh, SL_SEAMS_KEEP_UV, &input, &diag));
    SL_TRY(look(mesh, path));
cleanup:
    sl_mesh_free(mesh);
    sl_repair_report_clear(&report);
    sl_meshfile_free(file);
    return status;
}

int main(int argc, char **argv)
{
    int code = 0;
    for (int a = 1; a < argc; a++) {
        const sl_status status = look_at_file(argv[a]);
        if (status != SL_OK) {
            fprintf(stderr, "%s: %s\n", argv[a], sl_status_name(status));
            code = 1;
        }
    }
    return code;
}
