/* The normal equations of a conformal layout: pins, numbering, matrix; internal to the room.
 * Layer: param. */
#ifndef SL_PARAM_RECONSTRUCT_SYSTEM_INTERNAL_H
#define SL_PARAM_RECONSTRUCT_SYSTEM_INTERNAL_H

#include "mesh/patch.h"
#include "sparse/csc.h"

/* Unknowns 2 f and 2 f + 1 are x and y of free vertex f. */
typedef struct sl_layout {
    const sl_patch *patch; /* borrowed */
    int32_t pin[2];
    int32_t nfree;
    int32_t *unknown; /* nv: f, -1 for the pins */
    int64_t *fill;    /* 2 nfree: scratch */
    int32_t *last;    /* 2 nfree: scratch */
    double *cot;      /* 3 nt, filled by the caller */
    double *w;        /* 6 nt: W_k / sqrt(2 A) of each triangle, filled by the caller */
} sl_layout;

/* Pins the border vertex farthest from the border's mean and the one farthest from that (ties: the lowest index).
 * SL_SINGULAR (no border, fewer than 3 vertices, a vertex without triangles, several components), SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_layout_init(sl_layout *layout, const sl_patch *patch);
void sl_layout_clear(sl_layout *layout);

/* Lower triangle of [R -S; S R] over the free vertices, filled by the present layout->cot. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_layout_pattern(sl_layout *layout, sl_csc **out);

/* Other values, by the present layout->cot. A: of sl_layout_pattern. Allocates nothing. */
void sl_layout_fill(sl_layout *layout, sl_csc *A);

/* An ordering of the unknowns, perm (2 nfree): that of the free vertices by their places in space, x and y of each one
 * after the other, which takes half the time of ordering both. A: of sl_layout_pattern. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_layout_order(const sl_layout *layout, const sl_csc *A, int32_t *perm);

#endif
