/* More charts for the tests of flattening: random disks, a limb, a ramp that covers itself when unrolled. */
#ifndef SL_TEST_STRETCH_CHARTS_H
#define SL_TEST_STRETCH_CHARTS_H

#include "geom/predicates.h"
#include "overlap/certificate.h"
#include "param/abf_charts.h"

enum { DISK_MAX = 96 };

/* A disk under construction: its border as a cycle, its edges as a matrix. */
typedef struct disk_builder {
    int32_t nv, nt, nb;
    int32_t tri[6 * DISK_MAX], border[DISK_MAX];
    bool edge[DISK_MAX][DISK_MAX];
} disk_builder;

static inline void disk_add_triangle(disk_builder *d, int32_t a, int32_t b, int32_t c)
{
    memcpy(&d->tri[3 * d->nt++], (int32_t[]){a, b, c}, 3 * sizeof *d->tri);
    d->edge[a][b] = d->edge[b][a] = d->edge[b][c] = d->edge[c][b] = d->edge[a][c] = d->edge[c][a] = true;
}

/* A new triangle on border edge i: afterwards that edge may join two border vertices. */
static inline void disk_add_ear(disk_builder *d, int32_t i)
{
    const int32_t a = d->border[i], b = d->border[(i + 1) % d->nb], v = d->nv++;
    disk_add_triangle(d, b, a, v);
    memmove(&d->border[i + 2], &d->border[i + 1], (size_t)(d->nb - i - 1) * sizeof *d->border);
    d->border[i + 1] = v;
    d->nb++;
}

/* Closes the corner at border vertex i, which becomes interior; refused where that edge exists already. */
static inline void disk_close_corner(disk_builder *d, int32_t i)
{
    const int32_t a = d->border[(i + d->nb - 1) % d->nb], v = d->border[i], b = d->border[(i + 1) % d->nb];
    if (d->nb < 4 || d->edge[a][b]) {
        return;
    }
    disk_add_triangle(d, a, b, v);
    d->nb--;
    memmove(&d->border[i], &d->border[i + 1], (size_t)(d->nb - i) * sizeof *d->border);
}

/* A vertex inside triangle t. */
static inline void disk_split(disk_builder *d, int32_t t)
{
    const int32_t a = d->tri[3 * t], b = d->tri[3 * t + 1], c = d->tri[3 * t + 2], v = d->nv++;
    d->tri[3 * t + 2] = v;
    disk_add_triangle(d, b, c, v);
    disk_add_triangle(d, c, a, v);
}

/* A random simplicial disk of up to nv <= DISK_MAX vertices, positions uniform in a cube: no shape at all. */
static inline sl_patch *disk_random(int32_t nv, uint64_t seed)
{
    test_rng rng = test_rng_seed(seed);
    disk_builder d = {.nv = 3, .nb = 3, .border = {0, 1, 2}};
    disk_add_triangle(&d, 0, 1, 2);
    for (int32_t i = 0; d.nv < nv; i++) {
        const int32_t what = test_index(&rng, 5);
        if (what < 2 || i > 20 * nv) {
            disk_add_ear(&d, test_index(&rng, d.nb));
        } else if (what < 4) {
            disk_close_corner(&d, test_index(&rng, d.nb));
        } else {
            disk_split(&d, test_index(&rng, d.nt));
        }
    }
    double xyz[3 * DISK_MAX];
    for (int32_t i = 0; i < 3 * d.nv; i++) {
        xyz[i] = test_uniform(&rng, -1.0, 1.0);
    }
    sl_patch *patch = chart_make(d.nv, xyz, d.nt, d.tri);
    assert_true(sl_patch_is_disk(patch));
    return patch;
}

/* parameter: whole turns of a ramp around the z axis; unrolled it covers itself from one turn on. */
static inline void chart_ramp(double u, double v, double parameter, double xyz[3])
{
    const double angle = 6.28318530717958647692 * parameter * v, radius = 1.0 + 0.5 * (u + 0.5);
    xyz[0] = radius * cos(angle);
    xyz[1] = radius * sin(angle);
    xyz[2] = 0.05 * angle;
}

/* The certificate with the patch's whole border. */
static inline sl_certificate chart_certify(const sl_patch *patch, const double *uv)
{
    int32_t *first = NULL, *halfedge = NULL;
    sl_certificate certificate = {0};
    assert_int_equal(sl_patch_border(patch, &first, &halfedge), SL_OK);
    const int32_t nb = first[patch->loops];
    int32_t *border = malloc(2 * (size_t)nb * sizeof *border);
    for (int32_t b = 0; b < nb; b++) {
        border[2 * b] = patch->tri[halfedge[b]];
        border[2 * b + 1] = patch->tri[sl_corner_next(halfedge[b])];
    }
    assert_int_equal(sl_certify_embedding(uv, patch->nt, patch->tri, nb, border, &certificate), SL_OK);
    free(first);
    free(halfedge);
    free(border);
    return certificate;
}

static inline int32_t chart_flips(const sl_patch *patch, const double *uv)
{
    int32_t flips = 0;
    for (int32_t t = 0; t < patch->nt; t++) {
        const int32_t *v = &patch->tri[3 * t];
        flips += sl_orient2d(&uv[2 * v[0]], &uv[2 * v[1]], &uv[2 * v[2]]) <= 0;
    }
    return flips;
}

/* Moves the vertices of a flip-free map one by one, at random, as far as it stays flip-free. */
static inline void chart_jitter_uv(const sl_patch *patch, double size, double *uv, test_rng *rng)
{
    for (int32_t i = 0; i < patch->nv; i++) {
        const double old[2] = {uv[2 * i], uv[2 * i + 1]};
        uv[2 * i] += test_uniform(rng, -size, size);
        uv[2 * i + 1] += test_uniform(rng, -size, size);
        if (chart_flips(patch, uv) > 0) {
            memcpy(&uv[2 * i], old, sizeof old);
        }
    }
}

/* A limb: a tip vertex, `rings` rings of m vertices around an axis, their radii and places jittered; open at its end.
 * Flattened by convexity or by angles it shrinks towards the tip by a factor a ring. */
static inline sl_patch *chart_tube(int32_t m, int32_t rings, double jitter, uint64_t seed)
{
    test_rng rng = test_rng_seed(seed);
    const int32_t nv = 1 + m * rings;
    double *xyz = malloc(3 * (size_t)nv * sizeof *xyz);
    int32_t nt = 0, *tri = malloc(3 * (size_t)(m * (2 * rings - 1)) * sizeof *tri);
    memcpy(xyz, (double[]){0.02, -0.03, 0.3}, 3 * sizeof *xyz);
    for (int32_t i = 0; i < m * rings; i++) {
        const double angle = (i % m + 0.5 * (i / m) + test_uniform(&rng, -jitter, jitter)) * 6.28318530717958647692 / m;
        const double radius = 1.0 + test_uniform(&rng, -jitter, jitter);
        double *x = &xyz[3 * (i + 1)];
        x[0] = radius * cos(angle);
        x[1] = radius * sin(angle);
        x[2] = -0.7 * (i / m + test_uniform(&rng, -jitter, jitter));
    }
    for (int32_t i = 0; i < m * rings; i++) {
        const int32_t next = i % m == m - 1 ? i - m + 1 : i + 1;
        if (i < m) {
            memcpy(&tri[3 * nt++], (int32_t[]){0, 1 + i, 1 + next}, 3 * sizeof *tri);
        }
        if (i + m < m * rings) {
            memcpy(&tri[3 * nt++], (int32_t[]){1 + i, 1 + i + m, 1 + next}, 3 * sizeof *tri);
            memcpy(&tri[3 * nt++], (int32_t[]){1 + next, 1 + i + m, 1 + next + m}, 3 * sizeof *tri);
        }
    }
    chart_shuffle(nv, xyz, nt, tri, &rng);
    sl_patch *patch = chart_make(nv, xyz, nt, tri);
    assert_true(sl_patch_is_disk(patch));
    free(xyz);
    free(tri);
    return patch;
}

/* Draws triangle t of an indexed mesh out into a limb of `layers` three-sided prisms along its normal, tapering. */
static inline void extrude_triangle(int32_t t, int32_t layers, double length, int32_t *nv, double *xyz, int32_t *nt,
                                    int32_t *tri)
{
    for (int32_t layer = 0; layer < layers; layer++) {
        int32_t old[3], now[3];
        double n[3], e[2][3];
        memcpy(old, &tri[3 * t], sizeof old);
        for (int k = 0; k < 3; k++) {
            e[0][k] = xyz[3 * old[1] + k] - xyz[3 * old[0] + k];
            e[1][k] = xyz[3 * old[2] + k] - xyz[3 * old[0] + k];
        }
        for (int k = 0; k < 3; k++) {
            n[k] = e[0][(k + 1) % 3] * e[1][(k + 2) % 3] - e[0][(k + 2) % 3] * e[1][(k + 1) % 3];
        }
        const double norm = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        for (int i = 0; i < 3; i++) {
            now[i] = (*nv)++;
            for (int k = 0; k < 3; k++) { /* towards the middle by a tenth, and up */
                const double middle = xyz[3 * old[0] + k] + (e[0][k] + e[1][k]) / 3.0;
                xyz[3 * now[i] + k] = 0.9 * xyz[3 * old[i] + k] + 0.1 * middle + length * n[k] / norm;
            }
        }
        for (int i = 0; i < 3; i++) {
            const int j = (i + 1) % 3;
            memcpy(&tri[3 * (*nt)++], (int32_t[]){old[i], old[j], now[j]}, 3 * sizeof *tri);
            memcpy(&tri[3 * (*nt)++], (int32_t[]){old[i], now[j], now[i]}, 3 * sizeof *tri);
        }
        memcpy(&tri[3 * t], now, sizeof now);
    }
}

/* A bumpy hexagon with `limbs` slender limbs of 1 .. layers prisms on triangles at random. */
static inline sl_patch *chart_limbs(int32_t rings, int32_t limbs, int32_t layers, uint64_t seed)
{
    test_rng rng = test_rng_seed(seed);
    sl_patch *base = chart_hexagon(rings, 0.2, chart_bumps, 0.6, seed);
    int32_t nv = base->nv, nt = base->nt;
    const int32_t more = limbs * layers;
    double *xyz = malloc(3 * (size_t)(nv + 3 * more) * sizeof *xyz);
    int32_t *tri = malloc(3 * (size_t)(nt + 6 * more) * sizeof *tri);
    memcpy(xyz, base->xyz, 3 * (size_t)nv * sizeof *xyz);
    memcpy(tri, base->tri, 3 * (size_t)nt * sizeof *tri);
    for (int32_t i = 0; i < limbs; i++) {
        const int32_t length = 1 + test_index(&rng, layers), t = test_index(&rng, base->nt);
        extrude_triangle(t, length, 0.5 / rings, &nv, xyz, &nt, tri);
    }
    sl_patch *patch = chart_make(nv, xyz, nt, tri);
    assert_true(sl_patch_is_disk(patch));
    sl_patch_free(base);
    free(xyz);
    free(tri);
    return patch;
}

/* A ring: an m-gon tube of one row, two borders. */
static inline sl_patch *chart_ring(int32_t m)
{
    double xyz[6 * DISK_MAX];
    int32_t tri[6 * DISK_MAX], nt = 0;
    for (int32_t i = 0; i < m; i++) {
        const double angle = 6.28318530717958647692 * i / m;
        const int32_t a = 2 * i, b = 2 * ((i + 1) % m);
        memcpy(&xyz[6 * i], (double[]){cos(angle), sin(angle), 0.1, 1.7 * cos(angle), 1.9 * sin(angle), 0.8},
               6 * sizeof *xyz);
        memcpy(&tri[3 * nt++], (int32_t[]){a, a + 1, b + 1}, 3 * sizeof *tri);
        memcpy(&tri[3 * nt++], (int32_t[]){a, b + 1, b}, 3 * sizeof *tri);
    }
    return chart_make(2 * m, xyz, nt, tri);
}

/* Of a 2 x 2 matrix. */
static inline double chart_determinant(const double J[4])
{
    return J[0] * J[3] - J[1] * J[2];
}

#endif
