/* Wool and a zipper, painted along straight lines of the atlas.
 * Layer: experiments. */
#ifndef SL_EXPERIMENTS_KNIT_H
#define SL_EXPERIMENTS_KNIT_H

#include "support/bake.h"

/* Where a chart's pattern is hung up: rows of stitches at right angles to `along`, counted from `origin`. */
typedef struct knit_frame {
    double origin[2], along[2]; /* page; unit vector */
    double length;              /* of the zipper from the origin on, 0 = none */
} knit_frame;

typedef struct knit {
    const int32_t *face_chart;
    const knit_frame *frame; /* one a slot */
    double stitch;           /* height of a row on the page */
} knit;

/* An exp_paint_fn; user: a knit. */
void knit_paint(void *user, int32_t facet, const double uv[2], const double xyz[3], uint8_t rgb[3]);

#endif
