/* Distances along a surface against exact ones, bounds, and another algorithm; scaling against the points it came from.
 */
#include "segment/checks.h"
#include "segment/geodesic_internal.h"

typedef struct marched {
    sl_mesh *mesh;
    sl_triangulation *t;
    sl_geodesics g;
    double *d;
} marched;

static marched prepare(sl_mesh *mesh)
{
    marched m = {.mesh = mesh, .t = test_triangulate(mesh), .d = malloc((size_t)mesh->nv * sizeof(double))};
    assert_int_equal(sl_geodesics_create(mesh, m.t, &m.g), SL_OK);
    return m;
}

static void discard(marched *m)
{
    sl_geodesics_clear(&m->g);
    sl_triangulation_free(m->t);
    sl_mesh_free(m->mesh);
    free(m->d);
}

/* A plane patch, rolled up around a cylinder of this radius (0 = left flat), with the coordinates of its plane. */
static sl_mesh *rolled(test_rng *rng, int32_t n, double radius, double *plane)
{
    test_grid g = test_grid_make(n, n, false, false, TEST_TRIANGLES);
    for (int32_t i = 0; i < g.rows; i++) {
        for (int32_t j = 0; j < g.columns; j++) {
            double *p = test_grid_point(&g, i, j), *q = plane + 2 * (i * g.columns + j);
            const double jitter = i > 0 && j > 0 && i < n && j < n ? 0.25 : 0.0;
            q[0] = (i + test_uniform(rng, -jitter, jitter)) / n;
            q[1] = (j + test_uniform(rng, -jitter, jitter)) / n;
            p[0] = radius > 0.0 ? radius * sin(q[0] / radius) : q[0];
            p[1] = q[1];
            p[2] = radius > 0.0 ? radius * cos(q[0] / radius) : 0.3 * q[0] + 0.2 * q[1];
        }
    }
    if (radius <= 0.0) { /* a slanted plane: its own lengths */
        for (int32_t v = 0; v < g.rows * g.columns; v++) {
            const double x = plane[2 * v], y = plane[2 * v + 1], slope = hypot(0.3, 0.2);
            const double along = (0.3 * x + 0.2 * y) / slope, across = (-0.2 * x + 0.3 * y) / slope;
            plane[2 * v] = along * sqrt(1.0 + slope * slope);
            plane[2 * v + 1] = across;
        }
    }
    return test_grid_mesh(&g, rng, NULL);
}

static double apart(const double *plane, int32_t v, int32_t w)
{
    return hypot(plane[2 * v] - plane[2 * w], plane[2 * v + 1] - plane[2 * w + 1]);
}

static void distances_in_a_plane_are_straight(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x9e0);
    enum { N = 21 };
    double plane[2 * (N + 1) * (N + 1)];
    for (int trial = 0; trial < 6 * test_multiplier(); trial++) {
        marched m = prepare(rolled(&rng, N, 0.0, plane));
        const int32_t source = test_index(&rng, m.mesh->nv);
        sl_geodesics_from(&m.g, source, m.d);
        double worst = 0.0, sum = 0.0;
        for (int32_t v = 0; v < m.mesh->nv; v++) {
            const double exact = apart(plane, source, v) * m.mesh->scale;
            const double error = v == source ? 0.0 : fabs(m.d[v] - exact) / exact;
            worst = fmax(worst, error);
            sum += error;
        }
        assert_true(m.d[source] == 0.0);
        assert_true(worst < 0.01);
        assert_true(sum < 1e-4 * m.mesh->nv);
        discard(&m);
    }
}

static void distances_on_a_rolled_up_plane_are_those_of_the_plane(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x9e1);
    enum { N = 24 };
    double plane[2 * (N + 1) * (N + 1)];
    for (int trial = 0; trial < 6 * test_multiplier(); trial++) {
        marched m = prepare(rolled(&rng, N, test_uniform(&rng, 0.25, 0.6), plane));
        const int32_t source = test_index(&rng, m.mesh->nv);
        sl_geodesics_from(&m.g, source, m.d);
        double sum = 0.0;
        for (int32_t v = 0; v < m.mesh->nv; v++) {
            const double exact = apart(plane, source, v) * m.mesh->scale;
            assert_true(test_near(m.d[v], exact, 0.03 * exact)); /* the facets are flat, the cylinder is not */
            sum += v == source ? 0.0 : fabs(m.d[v] - exact) / exact;
        }
        assert_true(sum < 0.004 * m.mesh->nv);
        discard(&m);
    }
}

static void distances_on_a_sphere_are_great_circles(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x9e2);
    sl_mesh *ball = test_spiky_mesh(&rng, 16, 0, 0.0, TEST_MIXED);
    for (int32_t v = 0; v < ball->nv; v++) {
        const double r = sl_vec3_norm(ball->xyz + 3 * v);
        for (int k = 0; k < 3; k++) {
            ball->xyz[3 * v + k] /= r;
        }
    }
    marched m = prepare(ball);
    for (int trial = 0; trial < 8; trial++) {
        const int32_t source = test_index(&rng, ball->nv);
        double mean = 0.0;
        sl_geodesics_from(&m.g, source, m.d);
        for (int32_t v = 0; v < ball->nv; v++) {
            const double dot = sl_vec3_dot(ball->xyz + 3 * source, ball->xyz + 3 * v);
            const double exact = acos(fmin(fmax(dot, -1.0), 1.0));
            assert_true(test_near(m.d[v], exact, 0.03 * exact + 1e-7));
            mean += exact > 1e-7 ? fabs(m.d[v] - exact) / exact / ball->nv : 0.0;
        }
        assert_true(mean < 0.01);
    }
    discard(&m);
}

/* Straight through space is shorter, along the edges longer: Dijkstra by hand over the triangles' edges. */
static void distances_lie_between_chords_and_paths_along_edges(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x9e3);
    for (int trial = 0; trial < 6 * test_multiplier(); trial++) {
        marched m = prepare(trial % 2 == 0 ? test_spiky_mesh(&rng, 7, 5, 1.4, TEST_MIXED)
                                           : test_torus_mesh(&rng, 15, 9, 0.4, TEST_QUADS));
        const int32_t nv = m.mesh->nv, source = test_index(&rng, nv);
        double *edges = malloc((size_t)nv * sizeof *edges);
        sl_geodesics_from(&m.g, source, m.d);
        for (int32_t v = 0; v < nv; v++) {
            edges[v] = v == source ? 0.0 : HUGE_VAL;
        }
        for (bool changed = true; changed;) { /* Bellman and Ford */
            changed = false;
            for (int32_t c = 0; c < 3 * m.t->nt; c++) {
                const int32_t a = m.mesh->origin[m.t->corner[c]];
                const int32_t b = m.mesh->origin[m.t->corner[c % 3 == 2 ? c - 2 : c + 1]];
                double e[3];
                sl_vec3_sub(m.mesh->xyz + 3 * a, m.mesh->xyz + 3 * b, e);
                const double length = sl_vec3_norm(e);
                if (edges[a] + length < edges[b] || edges[b] + length < edges[a]) {
                    edges[a] = fmin(edges[a], edges[b] + length);
                    edges[b] = fmin(edges[b], edges[a] + length);
                    changed = true;
                }
            }
        }
        double ratio = 0.0;
        for (int32_t v = 0; v < nv; v++) {
            double chord[3];
            sl_vec3_sub(m.mesh->xyz + 3 * source, m.mesh->xyz + 3 * v, chord);
            assert_true(m.d[v] >= sl_vec3_norm(chord) * (1.0 - 1e-12));
            assert_true(m.d[v] <= edges[v] * (1.0 + 1e-12));
            ratio += v == source ? 1.0 : m.d[v] / edges[v];
        }
        assert_true(ratio < 0.98 * nv); /* and they do cross triangles */
        free(edges);
        discard(&m);
    }
}

static void what_cannot_be_reached_is_infinitely_far(void **state)
{
    (void)state;
    const double xyz[] = {0, 0, 0, 1, 0.2, 0, 0.3, 1, 0.1, 5, 5, 5, 6, 5.1, 5, 5.2, 6, 5.3};
    const int32_t first[] = {0, 3, 6}, index[] = {0, 1, 2, 3, 4, 5};
    const sl_polygons polygons = {6, 2, xyz, first, index};
    sl_mesh *mesh = NULL;
    assert_int_equal(sl_mesh_build(&polygons, &mesh, NULL, NULL), SL_OK);
    marched m = prepare(mesh);
    sl_geodesics_from(&m.g, 1, m.d);
    for (int32_t v = 0; v < 6; v++) {
        assert_true(v < 3 ? m.d[v] <= 2.0 * mesh->scale : m.d[v] == HUGE_VAL);
    }
    discard(&m);
}

/* n points of dims dimensions, stretched differently along each. */
static double *cloud(test_rng *rng, int32_t n, int32_t dims)
{
    double *x = malloc((size_t)(n * dims) * sizeof *x);
    for (int32_t i = 0; i < n * dims; i++) {
        x[i] = test_uniform(rng, -1.0, 1.0) * (1.0 + 0.3 * (i % dims));
    }
    return x;
}

static double between(const double *x, int32_t dims, int32_t i, int32_t j)
{
    double sum = 0.0;
    for (int32_t k = 0; k < dims; k++) {
        sum += (x[i * dims + k] - x[j * dims + k]) * (x[i * dims + k] - x[j * dims + k]);
    }
    return sqrt(sum);
}

static void scaling_gives_points_back_up_to_a_motion(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x3d5);
    for (int trial = 0; trial < 20 * test_multiplier(); trial++) {
        const int32_t dims = 1 + test_index(&rng, 5), landmarks = dims + 12 + test_index(&rng, 20), n = landmarks + 30;
        double *x = cloud(&rng, n, dims), *d = malloc((size_t)(landmarks * landmarks) * sizeof *d);
        double *y = malloc((size_t)(n * dims) * sizeof *y), row[64];
        sl_mds mds;
        for (int32_t i = 0; i < landmarks * landmarks; i++) {
            d[i] = between(x, dims, i / landmarks, i % landmarks);
        }
        assert_int_equal(sl_mds_create(landmarks, d, &mds), SL_OK);
        assert_int_equal(mds.dims, dims);
        assert_int_equal(sl_mds_dominant(&mds), dims); /* after them nothing but rounding */
        for (int32_t k = 0; k < dims; k++) {
            assert_true(mds.lambda[k] > 0.0 && (k == 0 || mds.lambda[k] <= mds.lambda[k - 1]));
        }
        for (int32_t i = 0; i < n; i++) { /* landmarks and others alike */
            for (int32_t k = 0; k < landmarks; k++) {
                row[k] = between(x, dims, i, k);
            }
            sl_mds_place(&mds, dims, row, y + i * dims);
        }
        for (int32_t i = 0; i < n; i++) {
            for (int32_t j = 0; j < n; j++) {
                assert_true(test_near(between(y, dims, i, j), between(x, dims, i, j), 1e-8));
            }
        }
        sl_mds_clear(&mds);
        free(x);
        free(y);
        free(d);
    }
}

/* Landmarks on a rolled-up plane: the plane comes back, two dimensions dominate. */
static void landmarks_unroll_a_developable_surface(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x3d6);
    enum { N = 20, LANDMARKS = 24, NV = (N + 1) * (N + 1) };
    double plane[2 * NV], between_landmarks[LANDMARKS * LANDMARKS];
    marched m = prepare(rolled(&rng, N, 0.3, plane));
    double *d = malloc(LANDMARKS * NV * sizeof *d), *y = malloc(2 * NV * sizeof *y), row[LANDMARKS];
    int32_t landmark[LANDMARKS];
    sl_mds mds;
    for (int32_t k = 0; k < LANDMARKS; k++) {
        landmark[k] = (k * 37 + 5) % NV;
        sl_geodesics_from(&m.g, landmark[k], d + k * NV);
    }
    for (int32_t k = 0; k < LANDMARKS * LANDMARKS; k++) {
        between_landmarks[k] = d[k / LANDMARKS * NV + landmark[k % LANDMARKS]];
    }
    assert_int_equal(sl_mds_create(LANDMARKS, between_landmarks, &mds), SL_OK);
    assert_int_equal(sl_mds_dominant(&mds), 2);
    for (int32_t v = 0; v < NV; v++) {
        for (int32_t k = 0; k < LANDMARKS; k++) {
            row[k] = d[k * NV + v];
        }
        sl_mds_place(&mds, 2, row, y + 2 * v);
    }
    for (int trial = 0; trial < 2000; trial++) {
        const int32_t v = test_index(&rng, NV), w = test_index(&rng, NV);
        assert_true(test_near(between(y, 2, v, w), apart(plane, v, w) * m.mesh->scale, 0.015 * m.mesh->scale));
    }
    sl_mds_clear(&mds);
    free(d);
    free(y);
    discard(&m);
}

static void landmarks_in_one_point_have_one_empty_dimension(void **state)
{
    (void)state;
    const double d[9] = {0.0};
    sl_mds mds;
    assert_int_equal(sl_mds_create(3, d, &mds), SL_OK);
    assert_int_equal(mds.dims, 0);
    assert_int_equal(sl_mds_dominant(&mds), 1);
    sl_mds_clear(&mds);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(distances_in_a_plane_are_straight),
        cmocka_unit_test(distances_on_a_rolled_up_plane_are_those_of_the_plane),
        cmocka_unit_test(distances_on_a_sphere_are_great_circles),
        cmocka_unit_test(distances_lie_between_chords_and_paths_along_edges),
        cmocka_unit_test(what_cannot_be_reached_is_infinitely_far),
        cmocka_unit_test(scaling_gives_points_back_up_to_a_motion),
        cmocka_unit_test(landmarks_unroll_a_developable_surface),
        cmocka_unit_test(landmarks_in_one_point_have_one_empty_dimension),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
