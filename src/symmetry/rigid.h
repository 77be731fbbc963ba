/* Rigid motions that fit point pairs best, and 3 x 3 eigenvectors.
 * Layer: symmetry, private. */
#ifndef SL_SYMMETRY_RIGID_H
#define SL_SYMMETRY_RIGID_H

#include "base/status.h"

/* Sums over pairs of points p -> q, each relative to a point of reference of its own. */
typedef struct sl_rigid_sums {
    double n, p[3], q[3], pq[9]; /* pq[3 i + j] = sum of q_i p_j */
} sl_rigid_sums;

static inline void sl_rigid_add(sl_rigid_sums *s, const double p[3], const double q[3])
{
    s->n += 1.0;
    for (int i = 0; i < 3; i++) {
        s->p[i] += p[i];
        s->q[i] += q[i];
        for (int j = 0; j < 3; j++) {
            s->pq[3 * i + j] += q[i] * p[j];
        }
    }
}

/* The isometry q ~ M p + t of least squares, reflections allowed; where both signs of det M fit alike (flat points),
 * the one with det < 0 iff `reflect`. origin_p, origin_q: what was subtracted from the points. 3 x 4, row-major.
 * Source: Kabsch 1976; Arun, Huang & Blostein 1987. */
void sl_rigid_fit(const sl_rigid_sums *sums, const double origin_p[3], const double origin_q[3], bool reflect,
                  double isometry[12]);

static inline void sl_rigid_apply(const double T[12], const double p[3], double out[3])
{
    for (int i = 0; i < 3; i++) {
        out[i] = T[4 * i] * p[0] + T[4 * i + 1] * p[1] + T[4 * i + 2] * p[2] + T[4 * i + 3];
    }
}

/* Eigenvalues, ascending, and orthonormal eigenvectors (rows of V) of a symmetric 3 x 3 matrix, by Jacobi rotations. */
void sl_eigen3(const double A[9], double lambda[3], double V[9]);

#endif
