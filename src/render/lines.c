#include "base/memory.h"
#include "image/color.h"
#include "render/lines_internal.h"

#include <string.h>

static const uint8_t seam_rgb[3] = {22, 22, 26};
static const uint8_t wire_rgb[3] = {30, 32, 40};
static const double wire_width = 0.8, outline_width = 1.2; /* pixels */

/* What segments are made from. */
typedef struct line_source {
    const sl_scene *scene;
    const sl_screen *screen;
    bool atlas;
} line_source;

void sl_line_set_clear(sl_line_set *set)
{
    for (int32_t i = 0; i < set->layers; i++) {
        sl_free(set->segment[i]);
    }
    sl_free(set->segment);
    sl_free(set->layer);
    *set = (sl_line_set){0};
}

static sl_status begin_set(const sl_scene *scene, sl_line_set *set)
{
    const int64_t most = (int64_t)scene->edge_layers + scene->dot_layers + 2;
    *set =
        (sl_line_set){.layer = sl_calloc(most, sizeof *set->layer), .segment = sl_calloc(most, sizeof *set->segment)};
    return set->layer != NULL && set->segment != NULL ? SL_OK : SL_OUT_OF_MEMORY;
}

/* A new layer with room for `most` segments. */
static sl_status begin_layer(sl_line_set *set, int64_t most, const uint8_t rgb[3], double opacity, double width,
                             sl_line_layer **layer)
{
    double *segment = sl_alloc(most, 6 * sizeof *segment);
    if (segment == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    *layer = &set->layer[set->layers];
    **layer = (sl_line_layer){.segment = segment, .opacity = (float)opacity, .width = width};
    sl_rgb_to_linear(rgb, (*layer)->rgb);
    set->segment[set->layers++] = segment;
    return SL_OK;
}

static const double *point_of(const line_source *from, int32_t h)
{
    return from->screen->eye + 3 * (int64_t)(from->atlas ? h : from->scene->mesh->origin[h]);
}

static void put(sl_line_set *set, sl_line_layer *layer, const double *a, const double *b)
{
    double *s = set->segment[layer - set->layer] + 6 * layer->count++;
    memcpy(s, a, 3 * sizeof *s);
    memcpy(s + 3, b, 3 * sizeof *s);
}

static void put_halfedge(const line_source *from, sl_line_set *set, sl_line_layer *layer, int32_t h)
{
    put(set, layer, point_of(from, h), point_of(from, sl_next(from->scene->mesh, h)));
}

/* All edges that are not drawn as seams or outlines, once each. */
static sl_status add_wire(const line_source *from, sl_line_set *set)
{
    const sl_scene *scene = from->scene;
    if (!(scene->wire > 0.0)) {
        return SL_OK;
    }
    sl_line_layer *layer;
    const sl_status status = begin_layer(set, scene->mesh->nh, wire_rgb, scene->wire, wire_width, &layer);
    for (int32_t h = 0; status == SL_OK && h < scene->mesh->nh; h++) {
        const bool single = h > sl_opposite(scene->mesh, h);
        if (single && (!from->atlas || (sl_opposite(scene->mesh, h) >= 0 && !sl_is_seam(scene, h)))) {
            put_halfedge(from, set, layer, h);
        }
    }
    return status;
}

static sl_status add_edges(const line_source *from, const sl_edge_layer *edges, sl_line_set *set)
{
    sl_line_layer *layer;
    const sl_status status = begin_layer(set, 2 * (int64_t)edges->count, edges->rgb, 1.0, edges->width, &layer);
    for (int32_t i = 0; status == SL_OK && i < edges->count; i++) {
        const int32_t other = sl_opposite(from->scene->mesh, edges->halfedge[i]);
        put_halfedge(from, set, layer, edges->halfedge[i]);
        if (from->atlas && other >= 0) {
            put_halfedge(from, set, layer, other);
        }
    }
    return status;
}

/* Dots are segments without length. In the atlas every corner of a marked vertex is one. */
static sl_status add_dots(const line_source *from, const sl_dot_layer *dots, sl_line_set *set)
{
    const sl_mesh *m = from->scene->mesh;
    sl_line_layer *layer;
    uint8_t *marked = sl_calloc(m->nv, 1);
    if (marked == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t i = 0; i < dots->count; i++) {
        marked[dots->vertex[i]] = 1;
    }
    const sl_status status = begin_layer(set, m->nh, dots->rgb, 1.0, 2.0 * dots->radius, &layer);
    for (int32_t h = 0; status == SL_OK && h < m->nh; h++) {
        if (marked[m->origin[h]] != 0) {
            put(set, layer, point_of(from, h), point_of(from, h));
            marked[m->origin[h]] = from->atlas ? 1 : 0; /* on the model once */
        }
    }
    sl_free(marked);
    return status;
}

static sl_status add_scene_layers(const line_source *from, sl_line_set *set)
{
    sl_status status = SL_OK;
    for (int32_t i = 0; i < from->scene->edge_layers; i++) {
        SL_TRY(add_edges(from, &from->scene->edge_layer[i], set));
    }
    for (int32_t i = 0; i < from->scene->dot_layers; i++) {
        SL_TRY(add_dots(from, &from->scene->dot_layer[i], set));
    }
cleanup:
    return status;
}

sl_status sl_lines_on_model(const sl_scene *scene, const sl_dressing *dressing, const sl_screen *screen,
                            sl_line_set *set)
{
    sl_status status = SL_OK;
    const line_source from = {scene, screen, false};
    sl_line_layer *layer;
    SL_TRY(begin_set(scene, set));
    SL_TRY(add_wire(&from, set));
    SL_TRY(begin_layer(set, dressing->seams, seam_rgb, 1.0, scene->seam_width, &layer));
    for (int64_t i = 0; i < dressing->seams; i++) {
        put_halfedge(&from, set, layer, dressing->seam[i]);
    }
    SL_TRY(add_scene_layers(&from, set));
cleanup:
    return status;
}

sl_status sl_lines_in_atlas(const sl_scene *scene, const sl_screen *screen, sl_line_set *set)
{
    sl_status status = SL_OK;
    const line_source from = {scene, screen, true};
    sl_line_layer *layer;
    SL_TRY(begin_set(scene, set));
    SL_TRY(add_wire(&from, set));
    SL_TRY(begin_layer(set, scene->mesh->nh, seam_rgb, 1.0, outline_width, &layer));
    for (int32_t h = 0; h < scene->mesh->nh; h++) {
        if (sl_opposite(scene->mesh, h) < 0 || sl_is_seam(scene, h)) {
            put_halfedge(&from, set, layer, h);
        }
    }
    SL_TRY(add_scene_layers(&from, set));
cleanup:
    return status;
}
