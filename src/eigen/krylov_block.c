/* Blocks made orthonormal, and random ones. */
#include "eigen/krylov.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* A vector that keeps less than this share of its length under orthogonalisation lies in the span already: what is left
 * is rounding. */
static const double dependent_share = 1e-11;

/* Least pivot, relative to its column, of a Gram matrix that Cholesky may take: below, columns go one by one. */
static const double gram_pivot = 1e-8;

static double lane_dot(const double *X, int32_t a, const double *Y, int32_t b, int32_t w, int64_t rows)
{
    double sum = 0.0;
    for (int64_t i = 0; i < rows; i++) {
        sum += X[i * w + a] * Y[i * w + b];
    }
    return sum;
}

/* Lane 0 of spare: projected against the basis; its own lanes 1 .. w - 1 are zero. */
static void project_single(sl_krylov *k)
{
    double G[SL_PANEL * SL_PANEL];
    const sl_panel_pair single = {k->w, {k->spare, NULL}, {k->again, NULL}};
    sl_panels_project(&k->Q, sl_krylov_columns(k), &single, k->partial, k->context);
    sl_panels_subtract(&k->Q, sl_krylov_columns(k), &single, k->partial, G, k->context);
}

/* Lane 0 of spare against lanes 0 .. c - 1 of W; the shares are added to r (nullable, stride w). Returns its length. */
static double project_within(sl_krylov *k, int32_t c, double *r)
{
    const int64_t rows = k->Q.rows;
    for (int32_t i = 0; i < c; i++) {
        const double share = lane_dot(k->W, i, k->spare, 0, k->w, rows);
        for (int64_t j = 0; j < rows; j++) {
            k->spare[j * k->w] -= share * k->W[j * k->w + i];
        }
        if (r != NULL) {
            r[i * k->w] += share;
        }
    }
    return sqrt(lane_dot(k->spare, 0, k->spare, 0, k->w, rows));
}

/* Lane c of W := spare's lane 0 / length. */
static void put_lane(sl_krylov *k, int32_t c, double length)
{
    for (int64_t j = 0; j < k->Q.rows; j++) {
        k->W[j * k->w + c] = k->spare[j * k->w] / length;
    }
}

/* Lane c of W := a random unit vector orthogonal to the basis and to the lanes before it. Three passes: each wins the
 * digits the one before lost. */
static void random_lane(sl_krylov *k, int32_t c)
{
    memset(k->spare, 0, (size_t)k->Q.rows * (size_t)k->w * sizeof *k->spare);
    for (int64_t j = 0; j < k->Q.rows; j++) {
        k->spare[j * k->w] = 2.0 * sl_rng_uniform(&k->rng) - 1.0;
    }
    for (int pass = 0; pass < 3; pass++) {
        project_single(k);
        const double length = project_within(k, c, NULL);
        for (int64_t j = 0; j < k->Q.rows && length > 0.0; j++) {
            k->spare[j * k->w] /= length;
        }
    }
    put_lane(k, c, 1.0);
}

/* Column by column, as W = W_new R; lanes that depend on the basis or on one another are replaced by random ones, with
 * zeros in R. before: their lengths before they were projected. */
static void orthonormalise_slowly(sl_krylov *k, const double *before, double *R)
{
    const int32_t w = k->w;
    memset(R, 0, (size_t)(w * w) * sizeof *R);
    for (int32_t c = 0; c < w; c++) {
        memset(k->spare, 0, (size_t)k->Q.rows * (size_t)w * sizeof *k->spare);
        for (int64_t j = 0; j < k->Q.rows; j++) {
            k->spare[j * w] = k->W[j * w + c];
        }
        double length = 0.0;
        for (int pass = 0; pass < 2; pass++) {
            project_single(k);
            length = project_within(k, c, R + c);
        }
        if (length > dependent_share * before[c]) {
            R[c * w + c] = length;
            put_lane(k, c, length);
        } else {
            random_lane(k, c);
        }
    }
}

/* R'R = G, w x w, R upper triangular; false when a pivot is too small for its digits. */
static bool gram_cholesky(const double *G, int32_t w, double *R)
{
    memset(R, 0, (size_t)(w * w) * sizeof *R);
    for (int32_t i = 0; i < w; i++) {
        for (int32_t j = i; j < w; j++) {
            double sum = G[i * w + j];
            for (int32_t l = 0; l < i; l++) {
                sum -= R[l * w + i] * R[l * w + j];
            }
            if (i == j) {
                if (!(sum > gram_pivot * G[i * w + i]) || !isfinite(sum) || sum < DBL_MIN) {
                    return false;
                }
                R[i * w + i] = sqrt(sum);
            } else {
                R[i * w + j] = sum / R[i * w + i];
            }
        }
    }
    return true;
}

/* R := R2 R1 for upper triangles. */
static void multiply_triangles(const double *second, double *R, int32_t w)
{
    double product[SL_PANEL * SL_PANEL] = {0.0};
    for (int32_t i = 0; i < w; i++) {
        for (int32_t j = i; j < w; j++) {
            for (int32_t l = i; l <= j; l++) {
                product[i * w + j] += second[i * w + l] * R[l * w + j];
            }
        }
    }
    memcpy(R, product, (size_t)(w * w) * sizeof *R);
}

/* W = W_new R with orthonormal W_new, by Cholesky of its Gram matrix twice, or column by column. */
void sl_krylov_orthonormalise(sl_krylov *k, double *G, const double *before, double *R)
{
    const int32_t w = k->w;
    double second[SL_PANEL * SL_PANEL];
    bool healthy = true;
    for (int32_t c = 0; c < w; c++) {
        healthy = healthy && sqrt(G[c * w + c]) > 1e3 * dependent_share * before[c];
    }
    if (!healthy || !gram_cholesky(G, w, R)) {
        orthonormalise_slowly(k, before, R);
        return;
    }
    sl_panels_divide(k->Q.rows, k->W, w, R, k->partial, G, k->context);
    if (gram_cholesky(G, w, second)) {
        sl_panels_divide(k->Q.rows, k->W, w, second, k->partial, G, k->context);
        multiply_triangles(second, R, w);
    }
}

/* W := random vectors, orthonormal and orthogonal to the basis: projected twice, for each pass wins the digits the one
 * before lost. */
static void random_block(sl_krylov *k)
{
    const int32_t w = k->w, columns = sl_krylov_columns(k);
    const sl_panel_pair alone = {w, {k->W, NULL}, {k->again, NULL}};
    double before[SL_PANEL], G[SL_PANEL * SL_PANEL], R[SL_PANEL * SL_PANEL];
    for (int64_t i = 0; i < (int64_t)k->Q.rows * w; i++) {
        k->W[i] = 2.0 * sl_rng_uniform(&k->rng) - 1.0;
    }
    for (int pass = 0; pass < 2; pass++) {
        sl_panels_project(&k->Q, columns, &alone, k->partial, k->context);
        sl_panels_subtract(&k->Q, columns, &alone, k->partial, G, k->context);
    }
    for (int32_t c = 0; c < w; c++) {
        before[c] = sqrt((double)k->Q.rows);
    }
    sl_krylov_orthonormalise(k, G, before, R);
}

void sl_krylov_random(sl_krylov *k)
{
    while (k->pending < k->block) {
        random_block(k);
        sl_panels_store(&k->Q, sl_krylov_columns(k), k->W, k->w);
        k->pending += k->w;
    }
}
