#include "render/scene.h"
#include "render/stage_internal.h"

#include <math.h>

enum { MAX_SIDE = 16384, MAX_SAMPLES = 4, MAX_SKY_LIGHTS = 256 };

static const double max_checks = 1e6;
static const double max_pixels_wide = 1e4;

sl_scene sl_scene_default(void)
{
    return (sl_scene){
        .map = SL_COLORMAP_SEQUENTIAL, .tiles = 1.0, .checker = true, .checks = 64.0, .seams = true, .seam_width = 2.0};
}

sl_picture sl_picture_default(void)
{
    return (sl_picture){.width = 1280,
                        .height = 960,
                        .samples = 2,
                        .background = {246, 246, 244},
                        .sky_lights = 80,
                        .ground = true,
                        .legend = true};
}

static sl_status refuse(sl_diag *diag, int64_t element, const char *reason)
{
    if (diag != NULL) {
        *diag = sl_diag_none();
        diag->element = element;
        sl_diag_reason(diag, "%s", reason);
    }
    return SL_BAD_INPUT;
}

static bool in_range(double value, double lo, double hi)
{
    return value >= lo && value <= hi;
}

static sl_status check_picture(const sl_picture *p, sl_diag *diag)
{
    if (!in_range(p->width, 1, MAX_SIDE) || !in_range(p->height, 1, MAX_SIDE)) {
        return refuse(diag, -1, "a picture's side must be 1 to 16384 pixels");
    }
    if (!in_range(p->samples, 1, MAX_SAMPLES)) {
        return refuse(diag, -1, "samples per pixel side must be 1 to 4");
    }
    if (!in_range(p->sky_lights, 0, MAX_SKY_LIGHTS)) {
        return refuse(diag, -1, "lights of the sky must be 0 to 256");
    }
    return SL_OK;
}

static sl_status check_layers(const sl_scene *s, sl_diag *diag)
{
    for (int32_t i = 0; i < s->edge_layers; i++) {
        const sl_edge_layer *layer = &s->edge_layer[i];
        if (!in_range(layer->width, 0.0, max_pixels_wide)) {
            return refuse(diag, i, "a line's width is out of range");
        }
        for (int32_t k = 0; k < layer->count; k++) {
            if (layer->halfedge[k] < 0 || layer->halfedge[k] >= s->mesh->nh) {
                return refuse(diag, layer->halfedge[k], "a halfedge number is out of range");
            }
        }
    }
    for (int32_t i = 0; i < s->dot_layers; i++) {
        const sl_dot_layer *layer = &s->dot_layer[i];
        if (!in_range(layer->radius, 0.0, max_pixels_wide)) {
            return refuse(diag, i, "a dot's radius is out of range");
        }
        for (int32_t k = 0; k < layer->count; k++) {
            if (layer->vertex[k] < 0 || layer->vertex[k] >= s->mesh->nv) {
                return refuse(diag, layer->vertex[k], "a vertex number is out of range");
            }
        }
    }
    return SL_OK;
}

sl_status sl_scene_check(const sl_scene *s, const sl_picture *picture, sl_diag *diag)
{
    const sl_status status = check_picture(picture, diag);
    if (status != SL_OK) {
        return status;
    }
    if (!in_range(s->tiles, 0x1p-20, max_checks)) {
        return refuse(diag, -1, "tiles is out of range");
    }
    if (s->texture != NULL && (s->texture->width > SL_TEXTURE_MAX_SIDE || s->texture->height > SL_TEXTURE_MAX_SIDE)) {
        return refuse(diag, -1, "a texture's side must be at most 8192 texels");
    }
    if (!in_range(s->checks, 0x1p-20, max_checks) || !in_range(s->seam_width, 0.0, max_pixels_wide) ||
        !in_range(s->wire, 0.0, 1.0)) {
        return refuse(diag, -1, "checks, seam_width or wire is out of range");
    }
    return check_layers(s, diag);
}
