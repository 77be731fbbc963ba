#include "support/bend.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static double extent_along(const bend_model *m, int axis)
{
    double lo = HUGE_VAL, hi = -HUGE_VAL;
    for (int32_t v = 0; v < m->polygons.nv; v++) {
        lo = fmin(lo, m->rest[3 * (int64_t)v + axis]);
        hi = fmax(hi, m->rest[3 * (int64_t)v + axis]);
    }
    return hi - lo;
}

/* Axes in the order of their extent, by a rotation of the axes: length first, thickness last; centred. */
static void order_axes(bend_model *m)
{
    double extent[3];
    int order[3] = {0, 1, 2};
    for (int k = 0; k < 3; k++) {
        extent[k] = extent_along(m, k);
    }
    for (int pass = 0; pass < 2; pass++) {
        for (int k = 0; k < 2; k++) {
            if (extent[order[k]] < extent[order[k + 1]]) {
                const int other = order[k];
                order[k] = order[k + 1];
                order[k + 1] = other;
            }
        }
    }
    const bool odd = (order[0] == 0 && order[1] == 2) || (order[0] == 1 && order[1] == 0) ||
                     (order[0] == 2 && order[1] == 1); /* a reflection: mend it */
    double lo[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, hi[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (int32_t v = 0; v < m->polygons.nv; v++) {
        double *p = m->rest + 3 * (int64_t)v;
        const double q[3] = {p[order[0]], p[order[1]], odd ? -p[order[2]] : p[order[2]]};
        for (int k = 0; k < 3; k++) {
            p[k] = q[k];
            lo[k] = fmin(lo[k], q[k]);
            hi[k] = fmax(hi[k], q[k]);
        }
    }
    for (int32_t v = 0; v < m->polygons.nv; v++) {
        for (int k = 0; k < 3; k++) {
            m->rest[3 * (int64_t)v + k] -= 0.5 * (lo[k] + hi[k]);
        }
    }
    m->length = hi[0] - lo[0];
}

static sl_status load_generated(exp_run *run, const char *name, bend_model *out)
{
    exp_source source = {.generated = true};
    *out = (bend_model){0};
    snprintf(source.name, sizeof source.name, "%s", name);
    const sl_status status = exp_mesh_load(&source, &out->mesh, &run->diag);
    if (status != SL_OK) {
        return status;
    }
    out->polygons = out->mesh.polygons;
    out->rest = sl_alloc(3 * (int64_t)out->polygons.nv, sizeof *out->rest);
    if (out->rest != NULL) {
        memcpy(out->rest, out->polygons.xyz, 3 * (size_t)out->polygons.nv * sizeof *out->rest);
    }
    return out->rest != NULL ? SL_OK : SL_OUT_OF_MEMORY;
}

sl_status bend_begin(bend_model *model)
{
    model->xyz = sl_alloc(3 * (int64_t)model->polygons.nv, sizeof *model->xyz);
    if (model->xyz == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    model->polygons.xyz = model->xyz;
    order_axes(model);
    bend_by(model, 0.0);
    return SL_OK;
}

sl_status bend_load(exp_run *run, const char *name, bend_model *out)
{
    const sl_status status = load_generated(run, name, out);
    return status == SL_OK ? bend_begin(out) : status;
}

void bend_by(bend_model *model, double degrees)
{
    const double angle = degrees * acos(-1.0) / 180.0, radius = angle > 0.0 ? model->length / angle : 0.0;
    for (int32_t v = 0; v < model->polygons.nv; v++) {
        const double *p = model->rest + 3 * (int64_t)v;
        double *q = model->xyz + 3 * (int64_t)v;
        q[0] = angle > 0.0 ? (radius - p[2]) * sin(p[0] / radius) : p[0];
        q[1] = p[1];
        q[2] = angle > 0.0 ? radius - (radius - p[2]) * cos(p[0] / radius) : p[2];
    }
}

void bend_clear(bend_model *model)
{
    sl_free(model->first);
    sl_free(model->index);
    sl_free(model->rest);
    sl_free(model->xyz);
    exp_mesh_clear(&model->mesh);
    *model = (bend_model){0};
}

double bend_equator(const bend_model *model, const int32_t *side)
{
    const sl_polygons *p = &model->polygons;
    double agree = 0.0, all = 0.0;
    for (int32_t f = 0; f < p->nf; f++) {
        double z = 0.0, area[3] = {0.0, 0.0, 0.0};
        const int32_t first = p->face_first[f], end = p->face_first[f + 1];
        for (int32_t c = first; c < end; c++) {
            const double *a = model->rest + 3 * (int64_t)p->index[c],
                         *b = model->rest + 3 * (int64_t)p->index[c + 1 < end ? c + 1 : first];
            z += a[2];
            for (int k = 0; k < 3; k++) {
                area[k] += 0.5 * (a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3]);
            }
        }
        const double size = sqrt(area[0] * area[0] + area[1] * area[1] + area[2] * area[2]);
        all += size;
        agree += (z > 0.0) == (side[f] != 0) ? size : 0.0;
    }
    return all > 0.0 ? fmax(agree, all - agree) / all : 0.0;
}
