/* What the 3D and the UV view share: arrays made from a scene, the loop over bands, the last steps to a picture.
 * Layer: render, private. */
#ifndef SL_RENDER_STAGE_INTERNAL_H
#define SL_RENDER_STAGE_INTERNAL_H

#include "base/context.h"
#include "draw/canvas.h"
#include "draw/shade.h"
#include "render/scene.h"

enum {
    SL_BAND_PIXELS = 32, /* rows of a band */
    SL_MAP_COLORS = 257, /* of a colour map's table; odd: the middle of a diverging map is exact */
};

/* The arrays a scene is drawn from; all owned. */
typedef struct sl_dressing {
    int32_t nt;
    int32_t *triangle_vertex; /* 3 nt */
    int32_t *triangle_facet;  /* nt */
    float *normal;            /* 3 nh, or NULL */
    float *facet_rgb;         /* 3 nf, or NULL */
    sl_texture *texture;      /* or NULL */
    double *value;            /* nh, or NULL */
    double value_lo, value_hi;
    float map_rgb[3 * SL_MAP_COLORS];
    int64_t seams;
    int32_t *seam; /* halfedges where the scene has seams, one an edge */
} sl_dressing;

/* A layer of lines on the samples: segments in the screen's eye space. */
typedef struct sl_line_layer {
    int64_t count;
    const double *segment; /* 6 each; borrowed */
    float rgb[3];
    float opacity;
    double width; /* pixels */
} sl_line_layer;

/* One view, ready to be drawn. */
typedef struct sl_stage {
    const sl_screen *screen;
    const sl_material *material;
    const sl_light_rig *rig;
    const sl_ground *ground;
    float background[3];
    int32_t scale; /* samples per pixel and axis */
    int32_t layers;
    const sl_line_layer *layer;
} sl_stage;

/* SL_BAD_INPUT with the reason when an option or an index of a layer is out of range. */
SL_NODISCARD sl_status sl_scene_check(const sl_scene *scene, const sl_picture *picture, sl_diag *diag);

SL_NODISCARD sl_status sl_dress(const sl_scene *scene, bool smooth, sl_dressing *dressing);
void sl_undress(sl_dressing *dressing);

/* The material of a dressed scene; borrows from both. */
sl_material sl_dressed_material(const sl_scene *scene, const sl_dressing *dressing);

/* Is the edge of h a seam: cut, or between different charts or UVs? Borders are none. */
bool sl_is_seam(const sl_scene *scene, int32_t h);

/* Draws all bands into the canvas (screen size = scale times canvas size). */
SL_NODISCARD sl_status sl_stage_draw(const sl_stage *stage, const sl_context *context, sl_canvas *canvas);

/* The canvas as a picture. */
SL_NODISCARD sl_status sl_canvas_develop(const sl_canvas *canvas, sl_image **out);

#endif
