/* Positions from angles, again and again for one chart: what a drag does.
 * Layer: param. */
#ifndef SL_PARAM_RECONSTRUCT_H
#define SL_PARAM_RECONSTRUCT_H

#include "base/context.h"
#include "mesh/patch.h"

typedef struct sl_reconstruct sl_reconstruct; /* opaque: owns matrix, analysis, factor; borrows the patch */

/* Two far border vertices are held, the first at the origin. SL_SINGULAR (no border, fewer than 3 vertices, a vertex
 * without triangles, several components), SL_OUT_OF_MEMORY. On failure *out is NULL. */
SL_NODISCARD sl_status sl_reconstruct_create(const sl_patch *patch, sl_reconstruct **out);

/**
 * Positions that minimise the conformal energy of the patch with triangle t of the angles angle[3 t + k].
 *
 *     E = sum over t of |W_0 U_0 + W_1 U_1 + W_2 U_2|^2 / (2 A_t),   W_k = edge opposite to corner k, a complex number
 *
 * The result is scaled to the patch's 3D area. It depends on the angles alone, not on earlier calls.
 *
 * @param[in]  angle 3 nt, > 0 and with sum pi in each triangle; corrected here where they are not
 * @param[out] uv    nv x 2; unchanged on failure
 *
 * SL_SINGULAR (a pivot lost in rounding), SL_CANCELLED. One Cholesky factor of 2 nv - 4 unknowns, a few solves.
 * Allocates nothing. Deterministic.
 * Source: Levy, Petitjean, Ray, Maillot 2002, "Least squares conformal maps for automatic texture atlas generation". */
SL_NODISCARD sl_status sl_reconstruct_solve(sl_reconstruct *layout, const double *angle, const sl_context *context,
                                            double *uv);

void sl_reconstruct_free(sl_reconstruct *layout); /* NULL is a no-op */

/* What became of the angles in a layout. */
typedef struct sl_layout_quality {
    int32_t flipped;    /* triangles that are not counter-clockwise, by exact orientation */
    double angle_error; /* largest |angle in uv - angle| [rad]; within 1e-8 while area_ratio is below 1e6 */
    double area_ratio;  /* largest over smallest of (area in uv / area in 3D), over triangles with both; 1 = equal */
} sl_layout_quality;

/* uv: nv x 2, finite. Allocates nothing, cannot fail. O(nt). */
sl_layout_quality sl_layout_judge(const sl_patch *patch, const double *angle, const double *uv);

#endif
