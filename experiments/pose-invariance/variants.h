/* One surface in several poses and meshes; its vertices keep their numbers.
 * Layer: experiments. */
#ifndef SL_EXPERIMENTS_VARIANTS_H
#define SL_EXPERIMENTS_VARIANTS_H

#include "generators.h"
#include "support/bend.h"
#include "support/main.h"

enum {
    VARIANT_STRAIGHT,
    VARIANT_BENT,
    VARIANT_CURLED,
    VARIANT_NOISE,
    VARIANT_MORE_NOISE,
    VARIANT_TRIANGLES,
    VARIANT_REMESHED,
    VARIANTS
};

extern const char *const variant_name[VARIANTS];
extern const char *const variant_title[VARIANTS];

typedef struct variant {
    sl_polygons polygons; /* borrows from the model or from `owned` */
    sl_generated *owned;
} variant;

/* Noise is a share of the mean edge: 0.15 and 0.4. Triangles: quads split along diagonals drawn from a seed. Remeshed:
 * and three passes of edge flips, so that no facet is left. SL_OUT_OF_MEMORY. Deterministic. */
SL_NODISCARD sl_status variant_make(bend_model *model, int which, variant *out);
void variant_clear(variant *v);

/* Seams of a segmentation as points on the straight model: midpoints of its edges there, 3 a point; length of each.
 * Owned by the caller. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status variant_seams(const bend_model *model, const sl_mesh *mesh, double **point, double **length,
                                     int32_t *count);

/* Share of the length of a's seams that has a point of b's within reach. */
double variant_covered(const double *a, const double *length, int32_t na, const double *b, int32_t nb, double reach);

#endif
