#include "seamcost/seamcost_internal.h"

#include "base/memory.h"

#include <math.h>

static const double degree = 0.017453292519943295;

sl_seam_cost_def sl_seam_cost_default(void)
{
    return (sl_seam_cost_def){.crease = 0.6,
                              .concavity = 0.4,
                              .visibility = 0.5,
                              .loops = 0.3,
                              .floor = 0.1,
                              .diagonal = 8.0,
                              .angle_low = 20.0 * degree,
                              .angle_high = 50.0 * degree,
                              .reach = 0.02,
                              .ambient = sl_ambient_default()};
}

sl_seam_cost_def sl_seam_cost_none(void)
{
    sl_seam_cost_def def = sl_seam_cost_default();
    def.crease = def.concavity = def.visibility = def.loops = 0.0;
    return def;
}

static bool is_share(double x)
{
    return x >= 0.0 && x <= 1.0;
}

static bool is_valid(const sl_seam_cost_def *d)
{
    return is_share(d->crease) && is_share(d->concavity) && is_share(d->visibility) && is_share(d->loops) &&
           d->floor > 0.0 && d->floor <= 1.0 && d->diagonal >= 1.0 && d->diagonal < HUGE_VAL && d->angle_low >= 0.0 &&
           d->angle_high > d->angle_low && d->angle_high <= HUGE_VAL && d->reach > 0.0 && d->reach < HUGE_VAL;
}

/* 0 up to angle_low, 1 from angle_high on, with a smooth step between. */
static double ramp(const sl_seam_cost_def *def, double angle)
{
    const double t = fmin(fmax((angle - def->angle_low) / (def->angle_high - def->angle_low), 0.0), 1.0);
    return t * t * (3.0 - 2.0 * t);
}

static double surface_area(const sl_mesh *mesh)
{
    double area = 0.0;
    for (int32_t f = 0; f < mesh->nf; f++) {
        area += sl_mesh_face_area(mesh, f);
    }
    return area;
}

/* Multiplies by the parts that come from how the surface bends. */
static sl_status apply_bend(const sl_mesh *mesh, const sl_seam_cost_def *def, double *weight)
{
    sl_status status = SL_OK;
    double *angle = sl_alloc(mesh->nh, sizeof *angle), *turn = sl_calloc(mesh->nv, sizeof *turn);
    SL_TRY(angle != NULL && turn != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(sl_seam_dihedrals(mesh, angle));
    if (def->concavity > 0.0) {
        SL_TRY(sl_seam_turns(mesh, angle, def->reach * sqrt(surface_area(mesh)), turn));
    }
    for (int32_t h = 0; h < mesh->nh; h++) {
        const int32_t t = sl_opposite(mesh, h);
        if (h < t) {
            const double valley = fmin(angle[h], 0.5 * (turn[mesh->origin[h]] + turn[mesh->origin[t]]));
            weight[h] *= (1.0 - def->crease * ramp(def, fabs(angle[h]))) * (1.0 - def->concavity * ramp(def, -valley));
        }
    }
cleanup:
    sl_free(angle);
    sl_free(turn);
    return status;
}

static sl_status apply_visibility(const sl_mesh *mesh, const sl_seam_cost_def *def, const sl_context *context,
                                  double *weight)
{
    sl_status status = SL_OK;
    const double *visible = def->visible;
    double *computed = NULL;
    if (visible == NULL) {
        computed = sl_alloc(mesh->nf, sizeof *computed);
        SL_TRY(computed != NULL ? SL_OK : SL_OUT_OF_MEMORY);
        SL_TRY(sl_ambient_compute(mesh, &def->ambient, context, computed));
        visible = computed;
    }
    for (int32_t h = 0; h < mesh->nh; h++) {
        const int32_t t = sl_opposite(mesh, h);
        if (h < t) {
            const double hidden = 1.0 - 0.5 * (visible[mesh->face[h]] + visible[mesh->face[t]]);
            weight[h] *= 1.0 - def->visibility * hidden;
        }
    }
cleanup:
    sl_free(computed);
    return status;
}

static sl_status apply_loops(const sl_mesh *mesh, const sl_seam_cost_def *def, double *weight)
{
    double *feature = sl_alloc(mesh->nh, sizeof *feature);
    if (feature == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    const sl_status status = sl_seam_loops(mesh, def->partner, feature);
    for (int32_t h = 0; h < mesh->nh && status == SL_OK; h++) {
        weight[h] *= 1.0 - def->loops * feature[h];
    }
    sl_free(feature);
    return status;
}

/* Only the lower halfedge of an edge has been worked on. */
static void finish(const sl_mesh *mesh, const sl_seam_cost_def *def, double *weight)
{
    for (int32_t h = 0; h < mesh->nh; h++) {
        const int32_t t = sl_opposite(mesh, h);
        if (t < 0) {
            weight[h] = 1.0;
        } else if (h < t) {
            const bool diagonal = def->partner != NULL && def->partner[mesh->face[h]] == mesh->face[t];
            weight[h] = weight[t] = fmax(weight[h], def->floor) * (diagonal ? def->diagonal : 1.0);
        }
    }
}

sl_status sl_seam_cost_compute(const sl_mesh *mesh, const sl_seam_cost_def *def, const sl_context *context,
                               double *weight)
{
    sl_status status = SL_OK;
    SL_TRY(is_valid(def) ? SL_OK : SL_BAD_INPUT);
    SL_TRY(sl_report_progress(context, "seam costs", 0.0));
    for (int32_t h = 0; h < mesh->nh; h++) {
        weight[h] = 1.0;
    }
    if (def->crease > 0.0 || def->concavity > 0.0) {
        SL_TRY(apply_bend(mesh, def, weight));
    }
    if (def->visibility > 0.0) {
        SL_TRY(apply_visibility(mesh, def, context, weight));
    }
    if (def->loops > 0.0) {
        SL_TRY(apply_loops(mesh, def, weight));
    }
    finish(mesh, def, weight);
cleanup:
    return status;
}
