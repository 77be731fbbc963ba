/* Cutting across the shortest principal axis. */
#include "segment/baseline_internal.h"

#include "geom/vec3.h"

#include <string.h>

#define JACOBI_SWEEPS 32      /* convergence is quadratic: four to six are enough */
#define FLAT_RTOL 1e-12       /* an axis of less variance than this share of the longest one's is no extent */
#define ON_PLANE_RTOL 0x1p-40 /* centroids nearer to the plane than this share of the extent are on it */

static void triangle_corners(const sl_mesh *mesh, const sl_triangulation *t, int32_t i, const double *p[3])
{
    for (int k = 0; k < 3; k++) {
        p[k] = mesh->xyz + 3 * (int64_t)mesh->origin[t->corner[3 * i + k]];
    }
}

static double triangle_area(const double *const p[3])
{
    double a[3], b[3], n[3];
    sl_vec3_sub(p[1], p[0], a);
    sl_vec3_sub(p[2], p[0], b);
    sl_vec3_cross(a, b, n);
    return 0.5 * sl_vec3_norm(n);
}

/* centre = integral of x / area. Returns the area. */
static double area_centre(const sl_mesh *mesh, const sl_triangulation *t, double centre[3])
{
    double total = 0.0;
    memset(centre, 0, 3 * sizeof *centre);
    for (int32_t i = 0; i < t->nt; i++) {
        const double *p[3];
        triangle_corners(mesh, t, i, p);
        const double area = triangle_area(p);
        for (int k = 0; k < 3; k++) {
            centre[k] += area / 3.0 * (p[0][k] + p[1][k] + p[2][k]);
        }
        total += area;
    }
    for (int k = 0; k < 3 && total > 0.0; k++) {
        centre[k] /= total;
    }
    return total;
}

/* C = integral of (x - centre)(x - centre)' / total. Over a triangle of corners p, q, r (about the centre) and
 * s = p + q + r it is area / 12 (p p' + q q' + r r' + s s'). */
static void covariance(const sl_mesh *mesh, const sl_triangulation *t, const double centre[3], double total,
                       double C[3][3])
{
    memset(C, 0, 9 * sizeof C[0][0]);
    for (int32_t i = 0; i < t->nt && total > 0.0; i++) {
        const double *p[3];
        double v[4][3];
        triangle_corners(mesh, t, i, p);
        const double weight = triangle_area(p) / (12.0 * total);
        for (int k = 0; k < 3; k++) {
            v[3][k] = 0.0;
            for (int c = 0; c < 3; c++) {
                v[c][k] = p[c][k] - centre[k];
                v[3][k] += v[c][k];
            }
        }
        for (int j = 0; j < 3; j++) {
            for (int k = 0; k < 3; k++) {
                C[j][k] += weight * (v[0][j] * v[0][k] + v[1][j] * v[1][k] + v[2][j] * v[2][k] + v[3][j] * v[3][k]);
            }
        }
    }
}

/* C = J' C J and V = J' V with the rotation J of the plane (p, q) that makes C[p][q] 0. */
static void rotate(double C[3][3], double V[3][3], int p, int q)
{
    if (C[p][q] == 0.0) {
        return;
    }
    const double theta = 0.5 * (C[q][q] - C[p][p]) / C[p][q];
    const double t = copysign(1.0, theta) / (fabs(theta) + hypot(theta, 1.0)), c = 1.0 / hypot(t, 1.0), s = t * c;
    for (int k = 0; k < 3; k++) {
        const double a = C[k][p], b = C[k][q];
        C[k][p] = c * a - s * b;
        C[k][q] = s * a + c * b;
    }
    for (int k = 0; k < 3; k++) {
        const double a = C[p][k], b = C[q][k], v = V[p][k], w = V[q][k];
        C[p][k] = c * a - s * b;
        C[q][k] = s * a + c * b;
        V[p][k] = c * v - s * w;
        V[q][k] = s * v + c * w;
    }
    C[p][q] = C[q][p] = 0.0;
}

/* Eigenvalues of C on its diagonal, eigenvectors in the rows of V, by cyclic Jacobi rotations. */
static void diagonalise(double C[3][3], double V[3][3])
{
    memset(V, 0, 9 * sizeof V[0][0]);
    V[0][0] = V[1][1] = V[2][2] = 1.0;
    for (int sweep = 0; sweep < JACOBI_SWEEPS && (C[0][1] != 0.0 || C[0][2] != 0.0 || C[1][2] != 0.0); sweep++) {
        rotate(C, V, 0, 1);
        rotate(C, V, 0, 2);
        rotate(C, V, 1, 2);
    }
}

static void point_along_largest(double axis[3])
{
    int largest = 0;
    for (int k = 1; k < 3; k++) {
        largest = fabs(axis[k]) > fabs(axis[largest]) ? k : largest;
    }
    for (int k = 0; k < 3 && axis[largest] < 0.0; k++) {
        axis[k] = k == largest ? axis[k] : -axis[k];
    }
    axis[largest] = fabs(axis[largest]);
}

/**
 * Principal axes of a surface.
 *
 *     c = integral of x dA / A,   C = integral of (x - c)(x - c)' dA / A,   C u = variance u
 *
 * @param[in]  mesh
 * @param[in]  triangulation  of the mesh
 * @param[out] axes           variances ascending; exact integrals, so that tessellation does not count
 *
 * Allocates nothing, cannot fail. Fixed summation order. O(triangles).
 * Source: Sec. 3.3 of the paper names principal component analysis; the integrals are elementary.
 */
void sl_principal_axes_compute(const sl_mesh *mesh, const sl_triangulation *triangulation, sl_principal_axes *axes)
{
    double C[3][3], V[3][3];
    int order[3] = {0, 1, 2};
    const double total = area_centre(mesh, triangulation, axes->centre);
    covariance(mesh, triangulation, axes->centre, total, C);
    diagonalise(C, V);
    for (int pass = 0; pass < 2; pass++) {
        for (int k = 0; k < 2; k++) {
            if (C[order[k + 1]][order[k + 1]] < C[order[k]][order[k]]) {
                const int swapped = order[k];
                order[k] = order[k + 1];
                order[k + 1] = swapped;
            }
        }
    }
    for (int k = 0; k < 3; k++) {
        axes->variance[k] = fmax(C[order[k]][order[k]], 0.0);
        memcpy(axes->axis[k], V[order[k]], sizeof axes->axis[k]);
        point_along_largest(axes->axis[k]);
    }
}

/* Are there nodes on both sides of the plane? */
static bool part_nodes(const sl_principal_axes *axes, int32_t axis, const sl_facet_graph *graph, int32_t *side)
{
    const int32_t n = graph->graph.n;
    const double on_plane = ON_PLANE_RTOL * sqrt(axes->variance[2]);
    int32_t above = 0;
    for (int32_t i = 0; i < n; i++) {
        double d[3];
        sl_vec3_sub(graph->centroid + 3 * (int64_t)i, axes->centre, d);
        side[i] = sl_vec3_dot(d, axes->axis[axis]) >= -on_plane;
        above += side[i];
    }
    return above > 0 && above < n;
}

/**
 * Sides of the plane across the shortest principal axis.
 *
 *     side(f) = 1 where (centroid(f) - c) . u >= 0,   u the axis of least variance
 *
 * The plane holds the two longer axes, so its seam is the long way round: the "equator" of Sec. 3.3. Where the surface
 * is flat along u (a plane with holes), or all centroids lie on one side, the next longer axis is taken.
 *
 * @param[in]  axes
 * @param[in]  graph  its centroids
 * @param[out] side   n
 * @param[out] axis   0, 1, 2 from the shortest; -1 = no axis parts the nodes
 *
 * Allocates nothing, cannot fail.
 */
void sl_pca_sides(const sl_principal_axes *axes, const sl_facet_graph *graph, int32_t *side, int32_t *axis)
{
    for (*axis = 0; *axis < 3; (*axis)++) {
        if (axes->variance[*axis] > FLAT_RTOL * axes->variance[2] && part_nodes(axes, *axis, graph, side)) {
            return;
        }
    }
    *axis = -1;
}
