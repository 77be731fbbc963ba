/* The shading pass: colours of the samples of a visibility window.
 * Layer: draw. */
#ifndef SL_DRAW_SHADE_H
#define SL_DRAW_SHADE_H

#include "draw/ground.h"
#include "draw/light.h"
#include "draw/texture.h"
#include "draw/visibility.h"

/* What the triangles look like. All arrays are borrowed. A corner is an entry of the per-corner arrays; corner[3 t + k]
 * is the corner of triangle t at its vertex k, so triangles of one polygon share corners. Colours are linear light. */
typedef struct sl_material {
    const int32_t *corner;     /* 3 a triangle */
    const int32_t *facet;      /* 1 a triangle: entry of the per-facet arrays */
    const float *normal;       /* 3 a corner, unit; NULL = flat facets */
    float base_rgb[3];         /* where nothing below says otherwise */
    const float *facet_rgb;    /* 3 a facet; NULL = base_rgb */
    const double *value;       /* 1 a corner, mapped to colours; NaN = missing_rgb; NULL = none */
    double value_lo, value_hi; /* ends of the map; hi > lo */
    const float *map_rgb;      /* 3 map_count */
    int32_t map_count;         /* >= 2 where value is given */
    float missing_rgb[3];
    double contour;            /* value of a contour line drawn dark; NaN = none */
    const double *uv;          /* 2 a corner; NULL = no checkerboard and no texture; NaN = none on that triangle */
    double checks;             /* squares of the checkerboard per unit of UV; 0 = no checkerboard */
    float check_shade;         /* colours of dark squares are multiplied by this */
    const sl_texture *texture; /* in place of a facet's colour, where there is no value; borrowed; NULL = none */
    double tiles;              /* how often the texture fits into a unit of UV */
    const uint8_t *flag;       /* 1 a facet: nonzero = flag_rgb; NULL = none */
    float flag_rgb[3];
    float back_rgb[3]; /* mixed half into back sides */
    bool lit;          /* false: colours as they are (UV space) */
} sl_material;

/* A plain grey material without arrays; contour NaN, lit. */
sl_material sl_material_default(void);

/* Colours the samples of the window: lit material where a triangle is, background (dimmed by the ground's shadow)
 * elsewhere. scale = samples per pixel side: light is looked up once a pixel where the surface is smooth there; windows
 * must start at whole pixels. rig may be NULL when the material is not lit, ground where there is none. samples: 3
 * floats each, width * height of the window. Writes no NaN whatever the arrays hold. Allocates nothing. One thread. */
void sl_shade(const sl_screen *screen, const sl_visibility *window, const sl_material *material,
              const sl_light_rig *rig, const sl_ground *ground, const float background[3], int32_t scale,
              float *samples);

/* Mean of a checkerboard of unit squares over the box of sides width[2] around uv: 1 = light, 0 = dark, exactly. */
double sl_checkerboard(const double uv[2], const double width[2]);

#endif
