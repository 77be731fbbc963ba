/* What a picture shows, as plain arrays over a mesh, and how it is made.
 * Layer: render (may include mesh, draw, image, geom, base). */
#ifndef SL_RENDER_SCENE_H
#define SL_RENDER_SCENE_H

#include "draw/camera.h"
#include "image/colormap.h"
#include "image/image.h"
#include "mesh/triangulate.h"

/* Edges drawn as lines: seams, constraints. Borrowed. */
typedef struct sl_edge_layer {
    int32_t count;
    const int32_t *halfedge; /* either halfedge of an edge will do */
    uint8_t rgb[3];
    double width; /* pixels */
} sl_edge_layer;

/* Vertices drawn as dots. Borrowed. */
typedef struct sl_dot_layer {
    int32_t count;
    const int32_t *vertex;
    uint8_t rgb[3];
    double radius; /* pixels */
} sl_dot_layer;

/* All arrays are borrowed and, but for mesh and triangulation, nullable. A facet's colour is, by precedence: flagged
 * (red), corner_value, facet_value, texture, facet_rgb, chart, plain grey. */
typedef struct sl_scene {
    const sl_mesh *mesh;
    const sl_triangulation *triangulation;
    const double *corner_uv;    /* 2 a halfedge (mesh numbering); NaN = none */
    const int32_t *chart;       /* nf: chart number >= 0, -1 = none */
    const uint8_t *facet_rgb;   /* 3 nf, sRGB */
    const double *facet_value;  /* nf; NaN = grey */
    const double *corner_value; /* nh, interpolated; NaN = grey */
    sl_colormap map;            /* default SL_COLORMAP_SEQUENTIAL */
    double value_lo, value_hi;  /* ends of the map; not lo < hi (the default, both 0): from the data, and symmetric
                                   about 0 for SL_COLORMAP_DIVERGING */
    bool zero_line;             /* corner_value: a dark line where it changes sign; default false */
    const uint8_t *facet_flag;  /* nf; nonzero = drawn red (overlap) */
    const sl_image *texture;    /* laid through corner_uv in place of facets' colours; sides at most 8192 */
    double tiles;               /* how often it fits into a unit of UV, (0, 1e6]; default 1 */
    bool checker;               /* checkerboard through corner_uv; default true */
    double checks;              /* its squares per unit of UV, (0, 1e6]; default 64 */
    bool seams;                 /* draw edges where corner_uv or chart change, or that are cut; default true */
    double seam_width;          /* pixels; default 2 */
    double wire;                /* opacity of all polygon edges as hairlines, [0, 1]; default 0 */
    int32_t edge_layers;
    const sl_edge_layer *edge_layer;
    int32_t dot_layers;
    const sl_dot_layer *dot_layer;
} sl_scene;

/* An empty scene with the defaults above; set mesh and triangulation. */
sl_scene sl_scene_default(void);

typedef struct sl_picture {
    int32_t width, height; /* pixels, [1, 16384]; default 1280 x 960 */
    int32_t samples;       /* per pixel and axis, [1, 4]; default 2 (4x supersampling) */
    uint8_t background[3]; /* sRGB; default 246, 246, 244 */
    int32_t sky_lights;    /* lights of the sky, [0, 256]: soft shadows, ambient occlusion and the shadow on the ground;
                              0 = none of these, several times faster; default 80 */
    bool ground;           /* the scene stands on a ground that takes its shadow; default true */
    bool back_view;        /* sl_render_pair: another view from behind, in the middle; default false */
    bool legend;           /* a colour bar where values are shown; default true */
    const char *title;     /* ASCII, top left of the 3D view; borrowed, nullable */
    const char *uv_title;  /* of the UV view */
    const char *value_name; /* under the colour bar */
} sl_picture;

sl_picture sl_picture_default(void);

#endif
