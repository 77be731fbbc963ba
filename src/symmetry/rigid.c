#include "symmetry/rigid.h"

#include "geom/vec3.h"

#include <string.h>

enum { SWEEPS = 30 };

static const double FLAT = 1e-8;        /* smallest over largest singular value of points in one plane */
static const double NOISE = 1e-14;      /* of the sums of products */
static const double ORTHOGONAL = 1e-16; /* cosine of columns that need no rotation */

/* Rotates columns i and j of the 3 x 3 matrices A and V. */
static void rotate(double A[9], double V[9], int i, int j, double c, double s)
{
    for (int k = 0; k < 3; k++) {
        const double a = A[3 * k + i], b = A[3 * k + j], v = V[3 * k + i], w = V[3 * k + j];
        A[3 * k + i] = c * a - s * b;
        A[3 * k + j] = s * a + c * b;
        V[3 * k + i] = c * v - s * w;
        V[3 * k + j] = s * v + c * w;
    }
}

static double column_dot(const double A[9], int i, int j)
{
    return A[i] * A[j] + A[3 + i] * A[3 + j] + A[6 + i] * A[6 + j];
}

/* Cosine and sine of the Jacobi rotation that makes [a c; c b] diagonal. */
static void jacobi(double a, double b, double c, double *cosine, double *sine)
{
    const double zeta = (b - a) / (2.0 * c);
    const double t = (zeta >= 0.0 ? 1.0 : -1.0) / (fabs(zeta) + sqrt(1.0 + zeta * zeta));
    *cosine = 1.0 / sqrt(1.0 + t * t);
    *sine = t * *cosine;
}

/* One-sided Jacobi: A V with orthogonal columns. Source: Hestenes 1958. */
static void orthogonalise(double A[9], double V[9])
{
    static const int pair[3][2] = {{0, 1}, {0, 2}, {1, 2}};
    bool changed = true;
    for (int sweep = 0; sweep < SWEEPS && changed; sweep++) {
        changed = false;
        for (int p = 0; p < 3; p++) {
            const int i = pair[p][0], j = pair[p][1];
            const double a = column_dot(A, i, i), b = column_dot(A, j, j), c = column_dot(A, i, j);
            if (fabs(c) > ORTHOGONAL * sqrt(a * b) && fabs(c) > 0.0) {
                double cosine, sine;
                jacobi(a, b, c, &cosine, &sine);
                rotate(A, V, i, j, cosine, sine);
                changed = true;
            }
        }
    }
}

/* A unit vector at right angles to a. */
static void any_normal(const double a[3], double out[3])
{
    const int k = fabs(a[0]) <= fabs(a[1]) ? (fabs(a[0]) <= fabs(a[2]) ? 0 : 2) : (fabs(a[1]) <= fabs(a[2]) ? 1 : 2);
    double e[3] = {0.0, 0.0, 0.0};
    e[k] = 1.0;
    sl_vec3_cross(a, e, out);
    const double norm = sl_vec3_norm(out);
    for (int i = 0; i < 3; i++) {
        out[i] /= norm;
    }
}

static void scale_into(const double a[3], double factor, double out[3])
{
    for (int i = 0; i < 3; i++) {
        out[i] = factor * a[i];
    }
}

/* Right-handed orthonormal frame whose first vectors are as the two given, of lengths s0 >= s1; those of length 0 are
 * made up. */
static void complete_frame(double s0, double s1, double frame[3][3])
{
    if (s0 > 0.0) {
        scale_into(frame[0], 1.0 / s0, frame[0]);
    } else {
        memcpy(frame[0], (double[3]){1.0, 0.0, 0.0}, sizeof frame[0]);
    }
    if (s1 > FLAT * s0 && s1 > 0.0) {
        const double c = sl_vec3_dot(frame[0], frame[1]) / s1;
        for (int i = 0; i < 3; i++) {
            frame[1][i] = frame[1][i] / s1 - c * frame[0][i];
        }
        scale_into(frame[1], 1.0 / sl_vec3_norm(frame[1]), frame[1]);
    } else {
        any_normal(frame[0], frame[1]);
    }
    sl_vec3_cross(frame[0], frame[1], frame[2]);
}

void sl_rigid_fit(const sl_rigid_sums *sums, const double origin_p[3], const double origin_q[3], bool reflect,
                  double isometry[12])
{
    double A[9], V[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, s[3];
    const double n = sums->n > 0.0 ? sums->n : 1.0;
    double largest = 0.0; /* of what is subtracted: its rounding is no direction */
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            A[3 * i + j] = sums->pq[3 * i + j] - sums->q[i] * sums->p[j] / n;
            largest = fmax(largest, fabs(sums->pq[3 * i + j]));
        }
    }
    orthogonalise(A, V);
    int order[3] = {0, 1, 2};
    for (int k = 0; k < 3; k++) {
        s[k] = sqrt(column_dot(A, k, k));
        s[k] = s[k] > NOISE * largest ? s[k] : 0.0;
    }
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2 - i; j++) {
            if (s[order[j]] < s[order[j + 1]]) {
                const int swap = order[j];
                order[j] = order[j + 1];
                order[j + 1] = swap;
            }
        }
    }
    double U[3][3], W[3][3]; /* images and preimages of the principal directions */
    for (int k = 0; k < 2; k++) {
        for (int i = 0; i < 3; i++) {
            U[k][i] = A[3 * i + order[k]];
            W[k][i] = V[3 * i + order[k]];
        }
    }
    complete_frame(s[order[0]], s[order[1]], U);
    complete_frame(1.0, 1.0, W);
    double sign = reflect ? -1.0 : 1.0;
    if (s[order[2]] > FLAT * s[order[0]]) {
        double along = 0.0; /* A w2 against u2: same side or not */
        for (int i = 0; i < 3; i++) {
            along += U[2][i] * A[3 * i + order[2]];
        }
        double w[3];
        for (int i = 0; i < 3; i++) {
            w[i] = V[3 * i + order[2]];
        }
        sign = along * sl_vec3_dot(w, W[2]) < 0.0 ? -1.0 : 1.0;
    }
    for (int i = 0; i < 3; i++) {
        isometry[4 * i + 3] = origin_q[i] + sums->q[i] / n;
        for (int j = 0; j < 3; j++) {
            isometry[4 * i + j] = U[0][i] * W[0][j] + U[1][i] * W[1][j] + sign * U[2][i] * W[2][j];
            isometry[4 * i + 3] -= isometry[4 * i + j] * (origin_p[j] + sums->p[j] / n);
        }
    }
}

void sl_eigen3(const double A[9], double lambda[3], double V[9])
{
    static const int pair[3][2] = {{0, 1}, {0, 2}, {1, 2}};
    double B[9], E[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    memcpy(B, A, sizeof B);
    bool changed = true;
    for (int sweep = 0; sweep < SWEEPS && changed; sweep++) {
        changed = false;
        for (int p = 0; p < 3; p++) {
            const int i = pair[p][0], j = pair[p][1];
            const double scale = fabs(B[4 * i]) + fabs(B[4 * j]);
            if (fabs(B[3 * i + j]) > ORTHOGONAL * scale && fabs(B[3 * i + j]) > 0.0) {
                double c, s, T[9], unused[9] = {0};
                jacobi(B[4 * i], B[4 * j], B[3 * i + j], &c, &s);
                rotate(B, E, i, j, c, s);
                for (int k = 0; k < 9; k++) {
                    T[k] = B[3 * (k % 3) + k / 3];
                }
                rotate(T, unused, i, j, c, s);
                for (int k = 0; k < 9; k++) {
                    B[k] = T[3 * (k % 3) + k / 3];
                }
                changed = true;
            }
        }
    }
    int order[3] = {0, 1, 2};
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2 - i; j++) {
            if (B[4 * order[j]] > B[4 * order[j + 1]]) {
                const int swap = order[j];
                order[j] = order[j + 1];
                order[j + 1] = swap;
            }
        }
    }
    for (int k = 0; k < 3; k++) {
        lambda[k] = B[4 * order[k]];
        for (int i = 0; i < 3; i++) {
            V[3 * k + i] = E[3 * i + order[k]];
        }
    }
}
