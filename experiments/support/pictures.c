#include "support/pictures.h"

#include "image/png.h"

#include <math.h>

/* The ends of the diverging map as a share of the largest value: vectors are peaked, their middle must show. */
static const double value_share = 0.6;

sl_picture exp_picture(const exp_run *run, int32_t width, int32_t height)
{
    sl_picture picture = sl_picture_default();
    picture.width = width;
    picture.height = height;
    picture.sky_lights = run->quick ? 12 : 48;
    picture.legend = false;
    return picture;
}

static sl_status write_image(exp_run *run, const char *file, sl_image *image)
{
    char path[EXP_PATH];
    sl_status status = exp_path(run, file, path);
    if (status == SL_OK) {
        status = sl_png_write(path, image, &run->diag);
    }
    sl_image_free(image);
    return status;
}

sl_status exp_draw_charts(exp_run *run, const sl_mesh *mesh, const sl_triangulation *triangulation,
                          const int32_t *face_chart, const sl_view *view, const sl_picture *picture, const char *file)
{
    sl_image *image = NULL;
    sl_scene scene = sl_scene_default();
    scene.mesh = mesh;
    scene.triangulation = triangulation;
    scene.chart = face_chart;
    const sl_status status = sl_render_3d(&scene, view, picture, &run->context, &image, &run->diag);
    return status != SL_OK ? status : write_image(run, file, image);
}

sl_status exp_draw_atlas(exp_run *run, const sl_atlas *atlas, const sl_view *view, const sl_picture *picture,
                         const char *file)
{
    sl_image *image = NULL;
    sl_scene scene = sl_scene_default();
    scene.mesh = atlas->mesh;
    scene.triangulation = atlas->triangulation;
    scene.corner_uv = atlas->corner_uv;
    int32_t *shown = sl_alloc(atlas->mesh->nf, sizeof *shown); /* copies have the colours of their sources */
    if (shown == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t f = 0; f < atlas->mesh->nf; f++) {
        shown[f] = sl_chart_shown(atlas->segmentation, atlas->segmentation->face_chart[f]);
    }
    scene.chart = shown;
    const sl_status status = sl_render_pair(&scene, view, picture, &run->context, &image, &run->diag);
    sl_free(shown);
    return status != SL_OK ? status : write_image(run, file, image);
}

/* Mean over the facets around each vertex, at its corners; NaN facets stay NaN. *largest = largest |value|. */
static double *corner_values(const sl_mesh *mesh, const double *facet_value, double *largest)
{
    double *sum = sl_calloc(2 * (int64_t)mesh->nv, sizeof *sum), *value = sl_alloc(mesh->nh, sizeof *value);
    *largest = 0.0;
    if (sum == NULL || value == NULL) {
        sl_free(sum);
        sl_free(value);
        return NULL;
    }
    for (int32_t h = 0; h < mesh->nh; h++) {
        const double x = facet_value[mesh->face[h]];
        if (!isnan(x)) {
            sum[2 * (int64_t)mesh->origin[h]] += x;
            sum[2 * (int64_t)mesh->origin[h] + 1] += 1.0;
            *largest = fmax(*largest, fabs(x));
        }
    }
    for (int32_t h = 0; h < mesh->nh; h++) {
        const double *s = sum + 2 * (int64_t)mesh->origin[h];
        value[h] = isnan(facet_value[mesh->face[h]]) ? facet_value[mesh->face[h]] : s[0] / s[1];
    }
    sl_free(sum);
    return value;
}

sl_status exp_draw_values(exp_run *run, const sl_mesh *mesh, const sl_triangulation *triangulation,
                          const double *facet_value, const int32_t *edge, int32_t edges, const sl_view *view,
                          const sl_picture *picture, const char *file)
{
    sl_image *image = NULL;
    sl_status status = SL_OK;
    double largest = 0.0, *value = corner_values(mesh, facet_value, &largest);
    const sl_edge_layer layer = {edges, edge, {0, 0, 0}, 2.0};
    sl_scene scene = sl_scene_default();
    if (value == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    scene.mesh = mesh;
    scene.triangulation = triangulation;
    scene.corner_value = value;
    scene.map = SL_COLORMAP_DIVERGING;
    scene.value_hi = (edges > 0 ? value_share : 1.0 / value_share) * largest; /* one sign: pale */
    scene.value_lo = -scene.value_hi;
    scene.edge_layers = edges > 0;
    scene.edge_layer = &layer;
    scene.seams = false;
    SL_TRY(sl_render_3d(&scene, view, picture, &run->context, &image, &run->diag));
    SL_TRY(write_image(run, file, image));
cleanup:
    sl_free(value);
    return status;
}
