/* Frames for the eye, not for print: a mesh held in hand, drawn again whenever the camera or a colour changes, and
 * asked what is under the pointer. Layer: render. */
#ifndef SL_RENDER_FRAME_H
#define SL_RENDER_FRAME_H

#include "base/context.h"
#include "draw/camera.h"

typedef struct sl_frame sl_frame; /* opaque: owns copies of the arrays and the last visibility buffer */

typedef struct sl_frame_def {
    int32_t nv, nt;
    const double *xyz;       /* nv x 3; not finite: its triangles are not drawn */
    const int32_t *tri;      /* 3 nt, below nv */
    const double *corner_uv; /* 6 nt: u, v of each corner of each triangle; NULL = no checkerboard; NaN: none there */
    const uint8_t *rgb;      /* 3 nt, sRGB; NULL = light grey */
} sl_frame_def;

/* How a frame looks. */
typedef struct sl_frame_style {
    uint8_t background[3]; /* sRGB; default 246, 246, 244 */
    double checks;         /* checkerboard squares a unit of UV; 0 = none; default 48 */
    bool flat;             /* one light a facet instead of one a vertex (Gouraud); default false */
    bool lit;              /* false: colours as they are; default true */
    bool cull;             /* leave out triangles seen from behind; default false */
} sl_frame_style;

sl_frame_style sl_frame_style_default(void);

/* What is under a pixel. */
typedef struct sl_frame_hit {
    int32_t triangle; /* -1 = nothing */
    double bary[3];   /* of the pixel's centre in the triangle */
} sl_frame_hit;

/* Copies the arrays. SL_BAD_INPUT (an index out of range), SL_OUT_OF_MEMORY. *out is NULL on failure. */
SL_NODISCARD sl_status sl_frame_create(const sl_frame_def *def, sl_frame **out);
void sl_frame_free(sl_frame *frame); /* NULL is a no-op */

/* New colours (3 nt), UVs (6 nt) or positions (3 nv; vertex normals follow) in place of the old; copied. */
void sl_frame_set_colors(sl_frame *frame, const uint8_t *rgb);
SL_NODISCARD sl_status sl_frame_set_uv(sl_frame *frame, const double *corner_uv);
void sl_frame_set_positions(sl_frame *frame, const double *xyz);

/* Lines along pairs of vertices, drawn antialiased over the surface where it does not hide them; copied. layer: 0 to 7,
 * higher ones over lower. width in pixels, (0, 64]. count 0 removes the layer. Lines are clipped
 * at the near plane; one with an end that is not finite is left out. SL_BAD_INPUT, SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_frame_set_lines(sl_frame *frame, int32_t layer, int32_t count, const int32_t *vertex_pairs,
                                          const uint8_t rgb[3], double width);

/* Draws into rgba (4 width height bytes, top row first, opaque). width, height: 1 to 16384. Triangles that reach behind
 * the near plane are clipped; those over 2^20 pixels away from the picture are left out. SL_BAD_INPUT (a side),
 * SL_OUT_OF_MEMORY. The same bytes for any number of threads. Allocates when the size grew. O(nv + nt + pixels). */
SL_NODISCARD sl_status sl_frame_draw(sl_frame *frame, const sl_camera *camera, const sl_frame_style *style,
                                     int32_t width, int32_t height, const sl_context *context, uint8_t *rgba);

/* What the frame drawn last shows at a pixel; nothing outside of it or before the first. O(1). */
sl_frame_hit sl_frame_pick(const sl_frame *frame, int32_t x, int32_t y);

#endif
