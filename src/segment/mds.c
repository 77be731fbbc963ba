/* Landmark multidimensional scaling. */
#include "segment/geodesic_internal.h"

#include "base/memory.h"
#include "eigen/lanczos.h"

#include <math.h>
#include <string.h>

#define ZERO_RTOL 1e-10 /* an eigenvalue of this share of the largest, or less, spans no dimension */
#define NOISE_RTOL 1e-4 /* eigenvalues below this share of the largest are noise of the distances */

void sl_mds_clear(sl_mds *mds)
{
    sl_free(mds->row);
    sl_free(mds->mean);
    *mds = (sl_mds){0};
}

/* Squared distances to their centred Gram matrix: G = -1/2 J D J, J = I - 1 1' / n. mean: of the columns of D. */
static void centre(int32_t n, double *D, double *mean)
{
    double all = 0.0;
    for (int32_t j = 0; j < n; j++) {
        mean[j] = 0.0;
        for (int32_t i = 0; i < n; i++) {
            mean[j] += D[(int64_t)j * n + i] / n;
        }
        all += mean[j] / n;
    }
    for (int32_t j = 0; j < n; j++) {
        for (int32_t i = 0; i < n; i++) {
            double *d = &D[(int64_t)j * n + i];
            *d = -0.5 * (*d - mean[i] - mean[j] + all);
        }
    }
}

/* Keeps the largest pairs. row k: u_k / (2 sqrt(lambda_k)); the largest component of u_k is positive. */
static sl_status keep_largest(const double *lambda, const double *V, sl_mds *mds)
{
    const int32_t n = mds->landmarks;
    for (int32_t k = 0; k <= SL_MDS_DIMS && k < n; k++) {
        mds->lambda[k] = fmax(lambda[n - 1 - k], 0.0);
        const bool counts = k < SL_MDS_DIMS && mds->lambda[k] > ZERO_RTOL * mds->lambda[0];
        mds->dims += counts && mds->dims == k;
    }
    mds->row = sl_alloc((int64_t)mds->dims * n, sizeof *mds->row);
    if (mds->row == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t k = 0; k < mds->dims; k++) {
        const double *u = V + (int64_t)(n - 1 - k) * n;
        int32_t largest = 0;
        for (int32_t i = 1; i < n; i++) {
            largest = fabs(u[i]) > fabs(u[largest]) * (1.0 + 1e-9) ? i : largest;
        }
        const double factor = copysign(0.5 / sqrt(mds->lambda[k]), u[largest]);
        for (int32_t i = 0; i < n; i++) {
            mds->row[(int64_t)k * n + i] = factor * u[i];
        }
    }
    return SL_OK;
}

/**
 * Coordinates of landmarks from their distances.
 *
 *     G = -1/2 J D J = U Lambda U',   y_k(landmark i) = sqrt(lambda_k) U_ik
 *
 * @param[in]  landmarks  n >= 1
 * @param[in]  distance   n x n
 * @param[out] out        owned by the caller; empty on failure
 *
 * SL_OUT_OF_MEMORY, SL_INTERNAL (LAPACK). O(n^3). Deterministic.
 * Source: Torgerson 1952, "Multidimensional scaling: I. Theory and method"; de Silva, Tenenbaum 2003, "Global versus
 * local methods in nonlinear dimensionality reduction" (landmarks).
 */
sl_status sl_mds_create(int32_t landmarks, const double *distance, sl_mds *out)
{
    sl_status status = SL_OK;
    const int64_t n = landmarks;
    sl_mds mds = {.landmarks = landmarks, .mean = sl_alloc(n, sizeof *mds.mean)};
    double *D = sl_alloc(n * n, sizeof *D), *lambda = sl_alloc(n, sizeof *lambda), *V = sl_alloc(n * n, sizeof *V);
    *out = (sl_mds){0};
    if (mds.mean == NULL || D == NULL || lambda == NULL || V == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    for (int64_t i = 0; i < n; i++) {
        for (int64_t j = 0; j < n; j++) {
            const double d = 0.5 * (distance[i * n + j] + distance[j * n + i]);
            D[i * n + j] = d * d;
        }
    }
    centre(landmarks, D, mds.mean);
    SL_TRY(sl_dense_eigen(landmarks, D, lambda, V));
    SL_TRY(keep_largest(lambda, V, &mds));
    *out = mds;
    mds = (sl_mds){0};
cleanup:
    sl_mds_clear(&mds);
    sl_free(D);
    sl_free(lambda);
    sl_free(V);
    return status;
}

/* y_k = 1/2 lambda_k^(-1/2) u_k . (mean - d^2): the point is triangulated (de Silva, Tenenbaum 2003). */
void sl_mds_place(const sl_mds *mds, int32_t dims, const double *distance, double *y)
{
    for (int32_t k = 0; k < dims; k++) {
        const double *row = mds->row + (int64_t)k * mds->landmarks;
        y[k] = 0.0;
        for (int32_t i = 0; i < mds->landmarks; i++) {
            y[k] += row[i] * (mds->mean[i] - distance[i] * distance[i]);
        }
    }
}

int32_t sl_mds_dominant(const sl_mds *mds)
{
    int32_t best = 1;
    double widest = 0.0;
    const double least = NOISE_RTOL * mds->lambda[0];
    for (int32_t i = 1; i <= mds->dims; i++) {
        const double gap = mds->lambda[i - 1] / fmax(mds->lambda[i], least);
        if (gap > widest) {
            widest = gap;
            best = i;
        }
    }
    return best;
}
