/* What the files of the frame share.
 * Layer: render, private. */
#ifndef SL_RENDER_FRAME_INTERNAL_H
#define SL_RENDER_FRAME_INTERNAL_H

#include "draw/visibility.h"
#include "render/frame.h"

enum {
    SL_FRAME_BAND = 32, /* rows */
    SL_FRAME_LAYERS = 8,
    SL_FRAME_FAR = INT32_MIN, /* x of a vertex that is not on the picture's plane */
};

/* A vertex on the picture: 1/256 pixel, relative to pixel centres. */
typedef struct sl_frame_vertex {
    int32_t x, y;
    float key;           /* 0 near to 1 far, linear on the picture */
    float weight;        /* 1 / depth; 1 where sight is parallel */
    float front, behind; /* light on either side */
} sl_frame_vertex;

/* First and last band of a triangle; first > last: not drawn. */
typedef struct sl_frame_span {
    uint16_t first, last;
} sl_frame_span;

typedef struct sl_frame_lines {
    int32_t count, *pair;
    uint8_t rgb[3];
    double width;
} sl_frame_lines;

struct sl_frame {
    int32_t nv, nt;
    double *xyz;
    float *normal; /* 3 nv, not of unit length */
    int32_t *tri;
    float *uv; /* 6 nt or NULL */
    uint8_t *rgb;
    sl_frame_lines lines[SL_FRAME_LAYERS];
    /* of the last drawing */
    sl_camera camera;
    sl_frame_style style;
    int32_t width, height, bands;
    int64_t pixels; /* room in zid */
    uint64_t *zid;
    sl_frame_vertex *vertex; /* nv */
    sl_frame_span *span;     /* nt */
    int64_t *place;          /* bands x chunks: where each chunk's triangles of a band stand */
    int64_t places;          /* room */
    int64_t *band_first;     /* bands + 1 */
    int32_t *banded;
    int64_t banded_room;
    double key_offset, key_scale;
    double light[3]; /* towards the light, scene space */
    float linear[256];
    uint8_t encoded[4096]; /* sRGB of light k / 4095 */
};

/* Projects the vertices and sorts the triangles into bands. */
SL_NODISCARD sl_status sl_frame_project(sl_frame *frame, const sl_context *context);

/* Key of a depth. */
double sl_frame_key(const sl_frame *frame, double z);

/* Light on a surface whose normal has this cosine to the light, on its front and on its back. */
void sl_frame_light(float cosine, float *front, float *behind);

/* On the picture? Otherwise vertex->x = SL_FRAME_FAR. */
void sl_frame_snap(const sl_frame *frame, const double eye[3], sl_frame_vertex *vertex);

/* Fills the visibility buffer of rows [row, row_end) with the triangles of the band. */
void sl_frame_raster(const sl_frame *frame, int32_t band, int32_t row, int32_t row_end);

/* Colours those rows. */
void sl_frame_shade(const sl_frame *frame, int32_t row, int32_t row_end, uint8_t *rgba);

/* Lays the lines over them. All rows must have been filled. */
void sl_frame_draw_lines(const sl_frame *frame, int32_t row, int32_t row_end, uint8_t *rgba);

/* Barycentrics of a pixel's centre, true in space. */
void sl_frame_barycentrics(const sl_frame *frame, int32_t t, double x, double y, double bary[3]);

#endif
