/* The model in 3D. */
#include "base/memory.h"
#include "image/color.h"
#include "render/overlay_internal.h"
#include "render/studio_internal.h"
#include "render/view_internal.h"

static const uint8_t seam_rgb[3] = {22, 22, 26};
static const uint8_t wire_rgb[3] = {30, 32, 40};
static const double wire_width = 0.8; /* pixels */

/* Line layers of a scene, in eye space. */
typedef struct line_set {
    int32_t layers;
    sl_line_layer *layer;
    double **segment; /* per layer, owned */
} line_set;

static void free_lines(line_set *set)
{
    for (int32_t i = 0; i < set->layers && set->segment != NULL; i++) {
        sl_free(set->segment[i]);
    }
    sl_free(set->segment);
    sl_free(set->layer);
}

static void put_segment(const sl_scene *scene, const sl_screen *screen, int32_t h, double *segment)
{
    const int32_t end[2] = {scene->mesh->origin[h], sl_target(scene->mesh, h)};
    for (int k = 0; k < 6; k++) {
        segment[k] = screen->eye[3 * (int64_t)end[k / 3] + k % 3];
    }
}

/* Appends a layer of the given halfedges; NULL = every edge of the mesh. */
static sl_status add_layer(const sl_scene *scene, const sl_screen *screen, line_set *set, int64_t count,
                           const int32_t *halfedge, const uint8_t rgb[3], double opacity, double width)
{
    sl_line_layer *layer = &set->layer[set->layers];
    double *segment = sl_alloc(count, 6 * sizeof *segment);
    if (segment == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    *layer = (sl_line_layer){.segment = segment, .opacity = (float)opacity, .width = width};
    sl_rgb_to_linear(rgb, layer->rgb);
    for (int64_t i = 0; i < count; i++) {
        const int32_t h = halfedge != NULL ? halfedge[i] : (int32_t)i;
        if (halfedge != NULL || h > sl_opposite(scene->mesh, h)) {
            put_segment(scene, screen, h, segment + 6 * layer->count++);
        }
    }
    set->segment[set->layers++] = segment;
    return SL_OK;
}

static sl_status make_lines(const sl_scene *scene, const sl_dressing *dressing, const sl_screen *screen, line_set *set)
{
    sl_status status = SL_OK;
    set->layer = sl_calloc((int64_t)scene->edge_layers + 2, sizeof *set->layer);
    set->segment = sl_calloc((int64_t)scene->edge_layers + 2, sizeof *set->segment);
    if (set->layer == NULL || set->segment == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    if (scene->wire > 0.0) {
        SL_TRY(add_layer(scene, screen, set, scene->mesh->nh, NULL, wire_rgb, scene->wire, wire_width));
    }
    SL_TRY(add_layer(scene, screen, set, dressing->seams, dressing->seam, seam_rgb, 1.0, scene->seam_width));
    for (int32_t i = 0; i < scene->edge_layers; i++) {
        const sl_edge_layer *from = &scene->edge_layer[i];
        SL_TRY(add_layer(scene, screen, set, from->count, from->halfedge, from->rgb, 1.0, from->width));
    }
cleanup:
    return status;
}

sl_status sl_view_3d(const sl_scene *scene, const sl_view *view, const sl_picture *picture, const sl_dressing *dressing,
                     const sl_context *context, sl_canvas *canvas)
{
    sl_status status = SL_OK;
    sl_screen *screen = NULL;
    sl_light_rig *rig = NULL;
    sl_ground *ground = NULL;
    line_set lines = {0};
    sl_camera camera;
    const int32_t scale = picture->samples, width = picture->width * scale, height = picture->height * scale;
    const sl_mesh *m = scene->mesh;
    SL_TRY(sl_camera_frame(view, (double)width / height, 3 * (int64_t)dressing->nt, dressing->triangle_vertex, m->xyz,
                           &camera));
    SL_TRY(sl_screen_create(&camera, width, height, m->nv, m->xyz, dressing->nt, dressing->triangle_vertex,
                            SL_BAND_PIXELS * scale, context, &screen));
    SL_TRY(sl_studio_create(&camera, view->up_axis, picture->sky_lights, m->nv, m->xyz, dressing->nt,
                            dressing->triangle_vertex, context, &rig));
    SL_TRY(make_lines(scene, dressing, screen, &lines));
    if (picture->ground && picture->sky_lights > 0) {
        SL_TRY(sl_studio_ground(rig, view->up_axis, m->xyz, dressing->nt, dressing->triangle_vertex, context, &ground));
    }
    const sl_material material = sl_dressed_material(scene, dressing);
    sl_stage stage = {.screen = screen,
                      .material = &material,
                      .rig = rig,
                      .ground = ground,
                      .scale = scale,
                      .layers = lines.layers,
                      .layer = lines.layer};
    sl_rgb_to_linear(picture->background, stage.background);
    SL_TRY(sl_stage_draw(&stage, context, canvas));
    SL_TRY(sl_overlay_title(canvas, picture->title));
    if (picture->legend && dressing->value != NULL) {
        SL_TRY(sl_overlay_legend(canvas, dressing, picture->value_name));
    }
cleanup:
    free_lines(&lines);
    sl_ground_free(ground);
    sl_light_rig_free(rig);
    sl_screen_free(screen);
    return status;
}
