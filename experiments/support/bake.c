#include "support/bake.h"

#include <math.h>

#include "image/png.h"

static const uint8_t bare[3] = {235, 232, 225};

/* A triangle on the texture: corners in texels, and what lies at them. */
typedef struct patch_of_paint {
    double p[3][2];
    const double *uv[3], *xyz[3];
    int32_t facet;
} patch_of_paint;

static void paint_texel(const patch_of_paint *t, const double w[3], exp_paint_fn *paint, void *user, uint8_t *rgb)
{
    double uv[2] = {0.0, 0.0}, xyz[3] = {0.0, 0.0, 0.0};
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < 2; i++) {
            uv[i] += w[k] * t->uv[k][i];
        }
        for (int i = 0; i < 3; i++) {
            xyz[i] += w[k] * t->xyz[k][i];
        }
    }
    paint(user, t->facet, uv, xyz, rgb);
}

/* Texels within one of the triangle; its neighbours paint over what is theirs, in the order of the facets. */
static void paint_triangle(const patch_of_paint *t, exp_paint_fn *paint, void *user, sl_image *image)
{
    const double(*p)[2] = t->p;
    const double twice = (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]);
    double low[2], high[2], reach[3];
    if (twice == 0.0) {
        return;
    }
    for (int i = 0; i < 2; i++) {
        low[i] = fmax(0.0, floor(fmin(fmin(p[0][i], p[1][i]), p[2][i]) - 1.0));
        high[i] = fmin(image->width - 1.0, ceil(fmax(fmax(p[0][i], p[1][i]), p[2][i]) + 1.0));
    }
    for (int k = 0; k < 3; k++) { /* one texel, in barycentric measure */
        const double *a = p[(k + 1) % 3], *b = p[(k + 2) % 3];
        reach[k] = hypot(b[0] - a[0], b[1] - a[1]) / fabs(twice);
    }
    for (int32_t y = (int32_t)low[1]; y <= (int32_t)high[1]; y++) {
        for (int32_t x = (int32_t)low[0]; x <= (int32_t)high[0]; x++) {
            double w[3];
            bool inside = true;
            for (int k = 0; k < 3; k++) {
                const double *a = p[(k + 1) % 3], *b = p[(k + 2) % 3];
                w[k] = ((b[0] - a[0]) * (y + 0.5 - a[1]) - (b[1] - a[1]) * (x + 0.5 - a[0])) / twice;
                inside = inside && w[k] > -reach[k];
            }
            if (inside) {
                paint_texel(t, w, paint, user, sl_image_pixel(image, x, y));
            }
        }
    }
}

sl_status exp_bake(const sl_session *session, int32_t size, exp_paint_fn *paint, void *user, sl_image **out)
{
    const sl_mesh *mesh = sl_session_mesh(session);
    const sl_triangulation *tri = sl_session_triangulation(session);
    sl_status status = sl_image_create(size, size, 3, out);
    if (status != SL_OK) {
        return status;
    }
    sl_image_fill(*out, bare);
    for (int32_t k = 0; k < tri->nt; k++) {
        sl_session_chart chart;
        patch_of_paint t = {.facet = mesh->face[tri->corner[3 * (int64_t)k]]};
        sl_session_chart_info(session, sl_session_face_chart(session)[t.facet], &chart);
        if (chart.copy_of >= 0) {
            continue;
        }
        for (int i = 0; i < 3; i++) {
            const int64_t h = tri->corner[3 * (int64_t)k + i];
            t.uv[i] = sl_session_corner_uv(session) + 2 * h;
            t.xyz[i] = mesh->xyz + 3 * (int64_t)mesh->origin[h];
            t.p[i][0] = t.uv[i][0] * size;
            t.p[i][1] = (1.0 - t.uv[i][1]) * size;
        }
        paint_triangle(&t, paint, user, *out);
    }
    return SL_OK;
}

sl_status exp_draw_textured(exp_run *run, const sl_session *session, const sl_image *texture, const sl_view *view,
                            const sl_picture *picture, const char *file)
{
    char path[EXP_PATH];
    sl_image *image = NULL;
    sl_status status = SL_OK;
    sl_scene scene = sl_scene_default();
    scene.mesh = sl_session_mesh(session);
    scene.triangulation = sl_session_triangulation(session);
    scene.corner_uv = sl_session_corner_uv(session);
    scene.texture = texture;
    scene.seams = false;
    scene.checker = false;
    SL_TRY(sl_render_pair(&scene, view, picture, &run->context, &image, &run->diag));
    SL_TRY(exp_path(run, file, path));
    SL_TRY(sl_png_write(path, image, &run->diag));
cleanup:
    sl_image_free(image);
    return status;
}
