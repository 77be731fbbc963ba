/* Hundreds of eigenpairs, band by band: shifts moved along the spectrum, bands joined by inertia counts.
 * Layer: eigen (may include sparse, base). */
#ifndef SL_EIGEN_BAND_H
#define SL_EIGEN_BAND_H

#include "eigen/lanczos.h"

typedef struct sl_band_def {
    sl_lanczos_def first; /* the first band, and what all have in common: tolerance, seed, null space, ordering; its
                             count is not looked at */
    int32_t count;        /* pairs wanted in all; clipped to n; default 200 */
    int32_t band;         /* pairs of a band, about; at least 8; default 50 */
} sl_band_def;

sl_band_def sl_band_default(void);

typedef struct sl_band_info {
    int32_t bands;
    int32_t found;       /* pairs delivered, the smallest of all */
    bool converged;      /* all that were wanted, within the tolerance */
    bool certified;      /* and every band holds as many as the counts at its ends say */
    int32_t factors;     /* factorisations, counts not included */
    int32_t counts;      /* inertia counts */
    int64_t solves;      /* right-hand sides */
    double max_residual; /* largest ||A v - lambda v|| / ||A||_1 */
    int64_t memory;      /* bytes estimated before allocating, those of A and the results not included */
} sl_band_info;

/* The def->count smallest pairs of A as in sl_lanczos_solve: lambda, vectors (n x count) and residual (nullable) are
 * the caller's; only the first info->found are filled. The first band is sl_lanczos_solve's; each later one runs block
 * Lanczos with inv(A - s I), L D L' without pivoting, s moved on by half a band, until it has all pairs that the
 * inertia counts at its ends demand, none nearer to an end than residuals and the counts' errors leave room for. A band
 * that does not come to its end ends the run: see info. SL_BAD_INPUT, SL_OUT_OF_MEMORY, SL_LIMIT, SL_CANCELLED,
 * SL_INTERNAL, SL_NOT_POSITIVE_DEFINITE as there. Same bytes for any number of threads. Source: Vallet, Levy 2008, Sec.
 * 4 (bands). Deviations: inertia counts instead of a search for overlaps.
 */
SL_NODISCARD sl_status sl_lanczos_bands(const sl_csc *A, const sl_band_def *def, const sl_context *context,
                                        double *lambda, double *vectors, double *residual, sl_band_info *info);

#endif
