/* Bodies with mirror symmetries to the bit, and what must hold of shared charts. */
#ifndef SL_TEST_SEGMENT_MIRRORED_H
#define SL_TEST_SEGMENT_MIRRORED_H

#include "segment/checks.h"

typedef struct test_mirrored {
    int32_t n;       /* cells along a cube's edge: even = axes along edges, odd = facets straddle them */
    int32_t mirrors; /* bits: x, y, z */
    int32_t nspike;  /* in one orthant of the mirrors; the others have their images */
    double height;
    test_facets facets; /* triangles: each quad's diagonal mirrored, too; mixed: diagonals at random */
    uint64_t seed;
} test_mirrored;

/* A number in [-1, 1] that depends on the folded point and nothing else. */
static inline double test_folded_noise(const double p[3], uint64_t seed, uint64_t k)
{
    uint64_t h = seed * 0x9e3779b97f4a7c15u + k;
    for (int32_t i = 0; i < 3; i++) {
        h ^= (uint64_t)llround(p[i] * 1024.0) + 0x7f4a7c15u;
        h *= 0xbf58476d1ce4e5b9u;
        h ^= h >> 29;
    }
    return (double)(h >> 11) * 0x1p-52 - 1.0;
}

static inline void test_fold(const double c[3], int32_t mirrors, double p[3])
{
    for (int32_t k = 0; k < 3; k++) {
        p[k] = (mirrors >> k & 1) != 0 ? fabs(c[k]) : c[k];
    }
}

/* Moves a point of the cube to the body: what is done to its folded image, unfolded again. */
static inline void test_mirrored_point(const test_mirrored *b, double c[3])
{
    double p[3], spike[3], r = 1.0;
    test_fold(c, b->mirrors, p);
    const double length = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    for (int32_t s = 0; s < b->nspike; s++) {
        for (int32_t k = 0; k < 3; k++) {
            const double at[3] = {s, 2.0, k};
            spike[k] = test_folded_noise(at, b->seed, 77);
            spike[k] = (b->mirrors >> k & 1) != 0 ? 0.25 + 0.75 * fabs(spike[k]) : spike[k];
        }
        const double norm = sqrt(spike[0] * spike[0] + spike[1] * spike[1] + spike[2] * spike[2]);
        const double dot = (p[0] * spike[0] + p[1] * spike[1] + p[2] * spike[2]) / (length * norm);
        r += b->height * exp(-14.0 * (1.0 - dot));
    }
    for (int32_t k = 0; k < 3; k++) {
        const bool mirror = (b->mirrors >> k & 1) != 0;
        double q = r * p[k] / length;
        q += mirror && p[k] == 0.0 ? 0.0 : 0.1 / b->n * test_folded_noise(p, b->seed, (uint64_t)k);
        c[k] = mirror && c[k] < 0.0 ? -q : q;
    }
}

/* Which diagonal: the one through the corner whose folded image is first by its noise. */
static inline int32_t test_mirrored_turn(const test_mirrored *b, const double *cube, const int32_t quad[4])
{
    int32_t best = 0;
    double least = 2.0;
    for (int32_t k = 0; k < 4; k++) {
        double p[3];
        test_fold(cube + 3 * quad[k], b->mirrors, p);
        const double noise = test_folded_noise(p, b->seed, 9);
        best = noise < least ? k : best;
        least = noise < least ? noise : least;
    }
    return best % 2;
}

/* `copies` bodies in a row: odd ones turned by a quarter, every third one mirrored. */
static inline sl_mesh *test_mirrored_mesh(const test_mirrored *b, int32_t copies)
{
    const int32_t n = b->n, side = n + 1, total = 6 * side * side;
    test_rng rng = test_rng_seed(b->seed + 5);
    double *cube = malloc(3 * (size_t)total * sizeof *cube);
    int32_t *name = malloc((size_t)total * sizeof *name), nv = 0, nf = 0, corners = 0;
    for (int32_t p = 0; p < total; p++) {
        const int32_t face = p / (side * side), i = p / side % side, j = p % side;
        double c[3];
        c[face / 2] = face % 2 == 0 ? -1.0 : 1.0;
        c[(face / 2 + 1) % 3] = 2.0 * i / n - 1.0;
        c[(face / 2 + 2) % 3] = 2.0 * j / n - 1.0;
        name[p] = -1;
        for (int32_t q = 0; (i == 0 || i == n || j == 0 || j == n) && q < nv && name[p] < 0; q++) {
            const double d = fabs(cube[3 * q] - c[0]) + fabs(cube[3 * q + 1] - c[1]) + fabs(cube[3 * q + 2] - c[2]);
            name[p] = d < 1e-9 ? q : -1;
        }
        if (name[p] < 0) {
            memcpy(cube + 3 * nv, c, sizeof c);
            name[p] = nv++;
        }
    }
    double *xyz = malloc(3 * (size_t)(nv * copies) * sizeof *xyz);
    int32_t *first = malloc((size_t)(12 * n * n * copies + 1) * sizeof *first);
    int32_t *index = malloc((size_t)(36 * n * n * copies) * sizeof *index);
    first[0] = 0;
    for (int32_t copy = 0; copy < copies; copy++) {
        const bool flip = copy % 3 == 2;
        for (int32_t v = 0; v < nv; v++) {
            double c[3];
            memcpy(c, cube + 3 * v, sizeof c);
            test_mirrored_point(b, c);
            double *to = xyz + 3 * (copy * nv + v);
            to[0] = (copy % 2 == 1 ? -c[1] : c[0]) + 9.0 * copy;
            to[1] = copy % 2 == 1 ? c[0] : c[1];
            to[2] = flip ? -c[2] : c[2];
        }
        for (int32_t cell = 0; cell < 6 * n * n; cell++) {
            const int32_t face = cell / (n * n), base = face * side * side + cell / n % n * side + cell % n;
            const int32_t quad[4] = {name[base], name[base + side], name[base + side + 1], name[base + 1]};
            const bool split = b->facets != TEST_QUADS;
            const int32_t turn = b->facets == TEST_TRIANGLES ? test_mirrored_turn(b, cube, quad) : test_index(&rng, 2);
            int32_t ring[4];
            for (int32_t k = 0; k < 4; k++) {
                const int32_t at = (turn + k) % 4;
                ring[(face % 2 == 1) != flip ? k : (4 - k) % 4] = copy * nv + quad[at];
            }
            for (int32_t k = 0; k < 4; k++) {
                index[corners++] = ring[k];
                if (split && k == 2) {
                    first[++nf] = corners;
                    index[corners++] = ring[0];
                    index[corners++] = ring[2];
                }
            }
            first[++nf] = corners;
        }
    }
    sl_polygons polygons = {nv * copies, nf, xyz, first, index};
    sl_mesh *mesh = NULL;
    sl_repair_report report = {0};
    sl_diag diag = sl_diag_none();
    assert_int_equal(sl_mesh_build(&polygons, &mesh, &report, &diag), SL_OK);
    assert_int_equal(report.border_loops, 0);
    assert_int_equal(report.reversed_faces, 0);
    sl_repair_report_clear(&report);
    free(cube);
    free(name);
    free(xyz);
    free(first);
    free(index);
    return mesh;
}

static inline double test_edge(const sl_mesh *m, int32_t a, int32_t b)
{
    double d = 0.0;
    for (int32_t k = 0; k < 3; k++) {
        const double x = m->xyz[3 * m->origin[a] + k] - m->xyz[3 * m->origin[b] + k];
        d += x * x;
    }
    return sqrt(d);
}

/* Copies take their UVs bit for bit from charts that are none, corner by corner of facets of one shape (within `like`,
 * relative), and what the summary says is true. Returns the share of the area that is copied. */
static inline double test_check_sharing(const sl_mesh *m, const sl_segmentation *s, double like)
{
    int32_t copies = 0;
    double copied = 0.0, all = 0.0;
    for (int32_t c = 0; c < s->nchart; c++) {
        const int32_t from = s->chart[c].copy_of;
        assert_true(from >= -1 && from < s->nchart && from != c);
        assert_true(from < 0 || s->chart[from].copy_of < 0);
        assert_true(from >= 0 || !s->chart[c].mirrored);
        copies += from >= 0;
    }
    assert_int_equal(copies, s->sharing.copies);
    assert_true((s->source != NULL) == (copies > 0));
    for (int32_t h = 0; h < m->nh; h++) {
        const int32_t c = s->face_chart[m->face[h]], from = s->source != NULL ? s->source[h] : -1;
        assert_true((from >= 0) == (s->chart[c].copy_of >= 0));
        if (from >= 0) {
            assert_int_equal(s->face_chart[m->face[from]], s->chart[c].copy_of);
            assert_memory_equal(s->corner_uv + 2 * h, s->corner_uv + 2 * from, 2 * sizeof *s->corner_uv);
            const double a = test_edge(m, h, sl_next(m, h)), b = test_edge(m, from, s->source[sl_next(m, h)]);
            assert_true(fabs(a - b) <= like * a);
        }
    }
    for (int32_t f = 0; f < m->nf; f++) {
        all += sl_mesh_face_area(m, f);
        copied += s->chart[s->face_chart[f]].copy_of >= 0 ? sl_mesh_face_area(m, f) : 0.0;
    }
    assert_true(test_near(copied / all, s->sharing.area, 1e-12));
    return copied / all;
}

#endif
