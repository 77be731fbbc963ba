/* Ear clipping of one polygon in the plane.
 * Layer: mesh, private. */
#ifndef SL_MESH_EAR_CLIP_INTERNAL_H
#define SL_MESH_EAR_CLIP_INTERNAL_H

#include "base/status.h"

/* Work space for polygons of up to `capacity` corners. */
typedef struct sl_ear_clipper {
    int32_t capacity;
    double *xy;      /* 2 x capacity: the polygon's corners, to be filled by the caller */
    double *quality; /* capacity: of the ear at a corner, negative = no ear */
    int32_t *link;   /* 2 x capacity: previous and next corner left */
    uint8_t *reflex; /* capacity: angle >= pi */
} sl_ear_clipper;

SL_NODISCARD sl_status sl_ear_clipper_init(int32_t capacity, sl_ear_clipper *out);

void sl_ear_clipper_clear(sl_ear_clipper *clipper);

/* Triangles of the polygon of d corners in clipper->xy, counter-clockwise: 3 (d - 2) corner numbers. Best-shaped ear
 * first. Where the polygon crosses itself and no ear is left, the most convex corner is cut off instead, so there are
 * d - 2 triangles always, and each diagonal occurs once in either direction. All are positive when the polygon is
 * simple. Cannot fail. O(d^2), O(d) orientation tests where few corners are reflex. */
void sl_ear_clip(sl_ear_clipper *clipper, int32_t d, int32_t *triangle);

#endif
