/* The seam around a hand as a zipper from the wrist to the tip of the thumb.
 * Layer: experiments. */
#ifndef SL_EXPERIMENTS_ZIPPER_H
#define SL_EXPERIMENTS_ZIPPER_H

#include "seamlab.h"

typedef struct zipper {
    sl_mesh *mesh;     /* borrowed */
    int32_t *halfedge; /* count: the seam's edges from the wrist up the outer side to the thumb's tip; owned */
    double *height;    /* count: how far up each is, 0 at the wrist, 1 at the tip; owned */
    int32_t count;
} zipper;

/* Cuts the hand into palm and back and lists the seam's edges on the thumb's side. SL_CHECK_FAILED (the cut is not one
 * loop through the tip of the thumb), those of sl_segment. */
SL_NODISCARD sl_status zipper_open(sl_mesh *mesh, const sl_triangulation *triangulation, const sl_context *context,
                                   zipper *zip);

/* Sews up to a height; how many edges are sewn then. */
int32_t zipper_close(zipper *zip, double height);

/* Is a facet's centre beyond the root of the thumb? */
bool zipper_is_on_thumb(const sl_mesh *mesh, int32_t f);

void zipper_clear(zipper *zip);

#endif
