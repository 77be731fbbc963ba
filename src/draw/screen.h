/* Triangles on their way to the picture: projected, clipped at the near plane, snapped to 1/256 sample and sorted into
 * bands of rows, ready to be drawn window by window.
 * Layer: draw. */
#ifndef SL_DRAW_SCREEN_H
#define SL_DRAW_SCREEN_H

#include "base/context.h"
#include "draw/camera.h"

enum {
    SL_SCREEN_MAX_SIDE = 1 << 16, /* samples */
    SL_SUBPIXELS = 256,           /* positions per sample and axis */
    SL_UNUSABLE = 0x80,
};

/* A convex piece of a triangle, itself a triangle. Snapped positions are in 1/256 sample, relative to sample centres:
 * sample (i, j) is at (256 i, 256 j). */
typedef struct sl_piece {
    int32_t x[3], y[3];
    int32_t triangle;
    float least_key, greatest_key;
    double key[3]; /* key at (0, 0), and its change per sample in x and y */
} sl_piece;

/* A vertex on the picture. */
typedef struct sl_snapped {
    double key;
    int32_t x, y;
    uint8_t outside; /* bit k: beyond clipping plane k; SL_UNUSABLE: not finite */
} sl_snapped;

/* The key orders samples by depth and is linear on the picture: 0 at the near end of the scene, 1 at the far end.
 *     perspective    key = (1/z_near - 1/z) / (1/z_near - 1/z_far)
 *     orthographic   key = (z - z_near) / (z_far - z_near)                                                          */
typedef struct sl_screen {
    sl_camera camera;
    int32_t width, height; /* samples */
    int32_t nv, nt;
    const int32_t *tri;           /* 3 nt; borrowed */
    double *eye;                  /* nv x 3, eye space; owned */
    sl_snapped *snapped;          /* nv; owned */
    double key_offset, key_scale; /* key = key_offset + key_scale * (perspective ? 1/z : z) */
    int64_t pieces;
    sl_piece *piece; /* owned; in the order of the triangles */
    int32_t band_rows, bands;
    int64_t *band_first; /* bands + 1; owned */
    int32_t *band_piece; /* pieces that touch each band, ascending; owned */
} sl_screen;

/* Projects nt triangles (3 vertex numbers each) over nv points onto a picture of width x height samples. band_rows >=
 * 1: rows of a band. xyz and tri are borrowed; tri until the screen is freed. Triangles with a corner that is not
 * finite, behind the eye altogether, or without area on the picture are dropped; those that cross the near plane are
 * clipped with the same cut on both sides of an edge, so no crack opens. SL_BAD_INPUT (a side out of range, over 2^31 -
 * 1 pieces), SL_OUT_OF_MEMORY. *out is NULL on failure. O(nv + nt). Deterministic for any number of threads. */
SL_NODISCARD sl_status sl_screen_create(const sl_camera *camera, int32_t width, int32_t height, int32_t nv,
                                        const double *xyz, int32_t nt, const int32_t *tri, int32_t band_rows,
                                        const sl_context *context, sl_screen **out);

void sl_screen_free(sl_screen *screen); /* NULL is a no-op */

/* Key of depth z. */
double sl_screen_key(const sl_screen *screen, double z);

/* The key of triangle t's plane as a function of the picture position: key(sx, sy) = plane[0] + plane[1] sx +
 * plane[2] sy, sample positions as in sl_camera. False (plane untouched) when the plane is seen edge-on. */
bool sl_screen_plane(const sl_screen *screen, int32_t t, double plane[3]);

#endif
