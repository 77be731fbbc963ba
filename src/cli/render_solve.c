/* The layouts of a solve as an animation: on the model and in the plane. */
#include "cli/render_animate.h"

#include "base/memory.h"
#include "image/apng.h"
#include "render/render.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum {
    SIDE = 480,        /* pixels of a view */
    MOST_FRAMES = 120, /* of more iterations several are passed at a time */
    FRAME_MS = 400,
    END_MS = 2000
};

static const double page_margin = 0.03; /* of the unit square that all layouts lie in */
static const double checks = 32.0;

typedef struct animation {
    const abf_trace *trace;
    const sl_mesh *mesh;
    const sl_patch *patch;
    sl_triangulation *triangulation;
    double *uv;        /* 2 nv: the layout in work, laid onto the last */
    double *corner_uv; /* 2 nh, NaN outside of the chart */
    int32_t *chart;    /* nf: 0 in the chart, -1 elsewhere */
    uint8_t *flag;     /* nf: red where a triangle is flipped */
    double low[2], scale;
} animation;

/* The similarity that carries a layout onto the last one, by least squares over the vertices:
 *
 *     w ~ a (z - mean z) + mean w,   a = sum conj(z) w / sum |z|^2  of what is left without the means
 */
static void lay_onto(const double *from, const double *to, int32_t nv, double *out)
{
    double z[2] = {0.0, 0.0}, w[2] = {0.0, 0.0}, a[2] = {0.0, 0.0}, square = 0.0;
    for (int32_t i = 0; i < 2 * nv; i++) {
        z[i % 2] += from[i] / nv;
        w[i % 2] += to[i] / nv;
    }
    for (int32_t v = 0; v < nv; v++) {
        const double x = from[2 * v] - z[0], y = from[2 * v + 1] - z[1];
        const double p = to[2 * v] - w[0], q = to[2 * v + 1] - w[1];
        a[0] += x * p + y * q;
        a[1] += x * q - y * p;
        square += x * x + y * y;
    }
    for (int32_t v = 0; v < nv; v++) {
        const double x = from[2 * v] - z[0], y = from[2 * v + 1] - z[1];
        out[2 * v] = w[0] + (square > 0.0 ? (a[0] * x - a[1] * y) / square : 0.0);
        out[2 * v + 1] = w[1] + (square > 0.0 ? (a[1] * x + a[0] * y) / square : 0.0);
    }
}

/* Which iterations are shown: those that were laid out, the last of them always. */
static const double *last_layout(const abf_trace *t)
{
    const double *uv = NULL;
    for (int32_t k = 0; k < t->count; k++) {
        uv = t->frame[k].uv != NULL ? t->frame[k].uv : uv;
    }
    return uv;
}

/* One window around all layouts. */
static void find_window(animation *a, const double *last)
{
    double high[2] = {-HUGE_VAL, -HUGE_VAL};
    a->low[0] = a->low[1] = HUGE_VAL;
    for (int32_t k = 0; k < a->trace->count; k++) {
        if (a->trace->frame[k].uv == NULL) {
            continue;
        }
        lay_onto(a->trace->frame[k].uv, last, a->patch->nv, a->uv);
        for (int32_t i = 0; i < 2 * a->patch->nv; i++) {
            a->low[i % 2] = fmin(a->low[i % 2], a->uv[i]);
            high[i % 2] = fmax(high[i % 2], a->uv[i]);
        }
    }
    const double extent = fmax(high[0] - a->low[0], high[1] - a->low[1]);
    a->scale = extent > 0.0 ? (1.0 - 2.0 * page_margin) / extent : 1.0;
    for (int k = 0; k < 2; k++) {
        a->low[k] -= 0.5 * (1.0 / a->scale - (high[k] - a->low[k]));
    }
}

static void dress(animation *a, const double *layout, const double *last)
{
    lay_onto(layout, last, a->patch->nv, a->uv);
    memset(a->flag, 0, (size_t)a->mesh->nf);
    for (int32_t c = 0; c < 3 * a->patch->nt; c++) {
        double *to = a->corner_uv + 2 * (int64_t)a->patch->corner[c];
        const double *from = a->uv + 2 * (int64_t)a->patch->tri[c];
        for (int k = 0; k < 2; k++) {
            to[k] = a->scale * (from[k] - a->low[k]);
        }
    }
    for (int32_t t = 0; t < a->patch->nt; t++) {
        const double *p = a->uv + 2 * (int64_t)a->patch->tri[3 * t], *q = a->uv + 2 * (int64_t)a->patch->tri[3 * t + 1];
        const double *r = a->uv + 2 * (int64_t)a->patch->tri[3 * t + 2];
        const double area = (q[0] - p[0]) * (r[1] - p[1]) - (r[0] - p[0]) * (q[1] - p[1]);
        a->flag[a->patch->facet[t]] |= area < 0.0;
    }
}

static sl_status draw(animation *a, int32_t index, const sl_context *context, sl_apng *apng, sl_diag *diag)
{
    const abf_trace *t = a->trace;
    sl_scene scene = sl_scene_default();
    sl_picture picture = sl_picture_default();
    sl_image *image = NULL;
    char title[96];
    snprintf(title, sizeof title, index == t->count - 1 ? "iteration %d, %s" : "iteration %d", index,
             abf_trace_verdict(t));
    scene.mesh = a->mesh;
    scene.triangulation = a->triangulation;
    scene.corner_uv = a->corner_uv;
    scene.chart = a->chart;
    scene.facet_flag = a->flag;
    scene.checks = checks;
    picture.width = 2 * SIDE;
    picture.height = SIDE;
    picture.sky_lights = 0;
    picture.title = title;
    sl_status status = sl_render_pair(&scene, NULL, &picture, context, &image, diag);
    if (status == SL_OK) {
        status = sl_apng_add(apng, image, index == t->count - 1 ? END_MS : FRAME_MS);
    }
    sl_image_free(image);
    return status;
}

static sl_status draw_all(animation *a, const double *last, const sl_context *context, sl_apng *apng, sl_diag *diag)
{
    sl_status status = SL_OK;
    const int32_t count = a->trace->count, stride = (count + MOST_FRAMES - 1) / MOST_FRAMES;
    for (int32_t k = 0; k < count; k++) {
        const double *layout = a->trace->frame[k].uv;
        if ((k % stride == 0 || k == count - 1) && layout != NULL) {
            SL_TRY(sl_report_progress(context, "animate", (double)k / count));
            dress(a, layout, last);
            SL_TRY(draw(a, k, context, apng, diag));
        }
    }
cleanup:
    return status;
}

sl_status cli_animate_solve(const abf_trace *trace, const char *path, const sl_context *context, sl_diag *diag)
{
    sl_status status = SL_OK;
    const abf_pick *pick = trace->pick;
    const double *last = last_layout(trace);
    animation a = {.trace = trace, .mesh = pick->atlas != NULL ? pick->atlas->mesh : pick->mesh, .patch = pick->patch};
    sl_apng *apng = NULL;
    if (last == NULL) {
        sl_diag_reason(diag, "no iteration can be laid out: there is nothing to animate");
        return SL_CHECK_FAILED;
    }
    a.uv = sl_alloc(a.patch->nv, 2 * sizeof *a.uv);
    a.corner_uv = sl_alloc(a.mesh->nh, 2 * sizeof *a.corner_uv);
    a.flag = sl_alloc(a.mesh->nf, sizeof *a.flag);
    a.chart = sl_alloc(a.mesh->nf, sizeof *a.chart);
    SL_TRY(a.uv != NULL && a.corner_uv != NULL && a.chart != NULL && a.flag != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int64_t i = 0; i < 2 * (int64_t)a.mesh->nh; i++) {
        a.corner_uv[i] = NAN;
    }
    memset(a.chart, -1, (size_t)a.mesh->nf * sizeof *a.chart);
    for (int32_t t = 0; t < a.patch->nt; t++) {
        a.chart[a.patch->facet[t]] = 0;
    }
    SL_TRY(sl_triangulation_create(a.mesh, &a.triangulation));
    SL_TRY(sl_apng_create(0, &apng));
    find_window(&a, last);
    SL_TRY(draw_all(&a, last, context, apng, diag));
    SL_TRY(sl_apng_write(path, apng, diag));
cleanup:
    sl_apng_free(apng);
    sl_triangulation_free(a.triangulation);
    sl_free(a.uv);
    sl_free(a.corner_uv);
    sl_free(a.chart);
    sl_free(a.flag);
    return status;
}
