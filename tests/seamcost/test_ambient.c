#include "seamcost/ambient.h"

#include "base/memory.h"
#include "geom/vec3.h"
#include "mesh/mesh_fixtures.h"
#include "mesh/triangulate.h"

#include <string.h>

enum { SAMPLES = 3000 };

static soup s;
static double visible[SOUP_FACES], other[SOUP_FACES];

static void compute(const sl_mesh *m, int32_t rays, int64_t total, double *out)
{
    sl_ambient_def def = sl_ambient_default();
    def.rays = rays;
    def.rays_total = total;
    assert_int_equal(sl_ambient_compute(m, &def, NULL, out), SL_OK);
}

/* A closed ball of n x 2n facets about a centre, radius r(angles); inwards: wound the other way. */
static void add_ball(soup *to, int32_t n, const double c[3], double r, double bump, bool inwards)
{
    const int32_t base = to->nv;
    for (int32_t i = 1; i < n; i++) {
        for (int32_t k = 0; k < 2 * n; k++) {
            const double a = TEST_PI * i / n, b = TEST_PI * k / n, d = r * (1.0 + bump * cos(3.0 * b) * sin(a));
            soup_vertex(to, c[0] + d * sin(a) * cos(b), c[1] + d * sin(a) * sin(b), c[2] + d * cos(a));
        }
    }
    const int32_t north = soup_vertex(to, c[0], c[1], c[2] + r), south = soup_vertex(to, c[0], c[1], c[2] - r);
    for (int32_t i = 0; i < n; i++) {
        for (int32_t k = 0; k < 2 * n; k++) {
            const int32_t l = (k + 1) % (2 * n), a = base + (i - 1) * 2 * n;
            int32_t q[4] = {i == 0 ? north : a + k, a + 2 * n + k, a + 2 * n + l, a + l}, d = 4;
            if (i == 0 || i == n - 1) {
                d = 3;
                q[1] = i == 0 ? q[1] : south;
                q[2] = i == 0 ? q[2] : a + l;
            }
            const int32_t back[4] = {q[0], q[d - 1], q[d - 2], q[1]};
            soup_face(to, d, inwards ? back : q);
        }
    }
}

static void a_convex_shape_sees_everything_and_what_it_holds_nothing(void **state)
{
    (void)state;
    for (int inwards = 0; inwards < 2; inwards++) {
        soup_clear(&s);
        add_ball(&s, 9, (const double[]){3.0, -1.0, 2.0}, 1.7, 0.0, inwards == 1);
        const int32_t outer = s.nf;
        add_ball(&s, 6, (const double[]){3.1, -1.2, 2.1}, 0.9, 0.2, inwards == 0);
        sl_mesh *m = soup_build(&s, NULL);
        compute(m, 64, 1 << 21, visible);
        for (int32_t f = 0; f < m->nf; f++) {
            assert_true(visible[f] == (f < outer ? 1.0 : 0.0));
        }
        sl_mesh_free(m);
    }
}

/* A plate below a square roof with the middle of the plate under the middle of the roof: the view factor of a rectangle
 * from a parallel element, a catalogue formula. */
static void a_roof_hides_as_much_as_its_view_factor(void **state)
{
    (void)state;
    static const double heights[] = {0.3, 0.8, 2.0};
    for (int k = 0; k < 3; k++) {
        const double h = heights[k], half = 1.0;
        const double tilt = 0.4, c = cos(tilt), w = sin(tilt);
        soup_clear(&s);
        for (int slab = 0; slab < 2; slab++) {
            const double e = slab == 0 ? 0.01 : half, z = slab == 0 ? -0.05 : h, up = slab == 0 ? 0.05 : 0.02;
            const int32_t v = s.nv;
            for (int i = 0; i < 8; i++) {
                const double x = i % 2 != 0 ? e : -e, y = i / 2 % 2 != 0 ? e : -e, t = i / 4 != 0 ? z + up : z;
                soup_vertex(&s, c * x - w * t, y, w * x + c * t);
            }
            soup_face(&s, 4, (int32_t[]){v, v + 2, v + 3, v + 1});
            soup_face(&s, 4, (int32_t[]){v + 4, v + 5, v + 7, v + 6}); /* the top */
            soup_face(&s, 4, (int32_t[]){v, v + 1, v + 5, v + 4});
            soup_face(&s, 4, (int32_t[]){v + 1, v + 3, v + 7, v + 5});
            soup_face(&s, 4, (int32_t[]){v + 3, v + 2, v + 6, v + 7});
            soup_face(&s, 4, (int32_t[]){v + 2, v, v + 4, v + 6});
        }
        sl_mesh *m = soup_build(&s, NULL);
        compute(m, 256, 1 << 21, visible);
        const double a = half / h, root = sqrt(1.0 + a * a);
        const double factor = 4.0 / (2.0 * TEST_PI) * 2.0 * (a / root * atan(a / root));
        assert_true(test_near(visible[1], 1.0 - factor, 0.02));
        sl_mesh_free(m);
    }
}

/* Does anything but the facet itself stand in the way? Every triangle is tried. */
static bool blocked(const sl_mesh *m, const sl_triangulation *t, int32_t facet, const double p[3], const double d[3])
{
    for (int32_t k = 0; k < t->nt; k++) {
        const double *a = m->xyz + 3 * m->origin[t->corner[3 * k]], *b = m->xyz + 3 * m->origin[t->corner[3 * k + 1]];
        const double *c = m->xyz + 3 * m->origin[t->corner[3 * k + 2]];
        double e[3], f[3], x[3], y[3], z[3];
        if (m->face[t->corner[3 * k]] == facet) {
            continue;
        }
        sl_vec3_sub(b, a, e);
        sl_vec3_sub(c, a, f);
        sl_vec3_sub(p, a, z);
        sl_vec3_cross(d, f, x);
        sl_vec3_cross(z, e, y);
        const double det = sl_vec3_dot(e, x), u = sl_vec3_dot(z, x) / det, v = sl_vec3_dot(d, y) / det;
        if (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && sl_vec3_dot(f, y) / det > 1e-6) {
            return true;
        }
    }
    return false;
}

/* A ball with deep folds, all triangles: visibility by many random rays, tried one by one. */
static void visibility_is_what_random_rays_find(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xa3b);
    sl_triangulation *t = NULL;
    soup_clear(&s);
    add_ball(&s, 10, (const double[]){0.0, 0.0, 0.0}, 1.0, 0.6, false);
    sl_mesh *m = soup_build(&s, NULL);
    assert_int_equal(sl_triangulation_create(m, &t), SL_OK);
    compute(m, 256, 1 << 21, visible);
    double least = 1.0, most = 0.0;
    for (int32_t f = 0; f < 20; f++) { /* those at the pole are triangles */
        double n[3], c[3];
        int32_t seen = 0;
        sl_mesh_face_vector_area(m, f, n);
        sl_mesh_face_centroid(m, f, c);
        const double area = sl_vec3_norm(n);
        for (int32_t k = 0; k < SAMPLES; k++) {
            double d[3], length = 0.0;
            while (!(length > 1e-3 && length <= 1.0)) { /* a point on the sphere about the normal: cosine-weighted */
                for (int i = 0; i < 3; i++) {
                    d[i] = test_uniform(&rng, -1.0, 1.0);
                }
                length = sl_vec3_norm(d);
            }
            for (int i = 0; i < 3; i++) {
                d[i] = d[i] / length + n[i] / area;
            }
            seen += !blocked(m, t, f, c, d);
        }
        const double expected = (double)seen / SAMPLES;
        assert_true(test_near(visible[f], expected, 0.04));
        least = fmin(least, expected);
        most = fmax(most, expected);
    }
    assert_true(least < most - 0.1 || least < 0.9);
    sl_triangulation_free(t);
    sl_mesh_free(m);
}

static void few_rays_averaged_come_near_many(void **state)
{
    (void)state;
    soup_clear(&s);
    add_ball(&s, 19, (const double[]){0.0, 0.0, 0.0}, 1.0, 0.6, false);
    sl_mesh *m = soup_build(&s, NULL);
    compute(m, 64, 1 << 21, visible);
    double spread = 0.0, mean = 0.0, off[2] = {0.0, 0.0};
    for (int32_t f = 0; f < m->nf; f++) {
        mean += visible[f] / m->nf;
    }
    for (int k = 0; k < 2; k++) {
        compute(m, 64, k == 0 ? 2 * m->nf : 8 * m->nf, other); /* rays in all */
        for (int32_t f = 0; f < m->nf; f++) {
            off[k] += fabs(visible[f] - other[f]) / m->nf;
            spread += fabs(visible[f] - mean) / m->nf / 2;
        }
    }
    assert_true(spread > 0.1 && off[0] < 0.08 && off[1] < 0.04);
    sl_mesh_free(m);
}

/* An open sheet is seen from the better side; cutting seams into a mesh opens nothing. */
static void borders_open_a_surface_and_seams_do_not(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x5ea);
    soup_grid(&s, &rng, SOUP_SHEET, 9, 7, 0.3);
    for (int32_t v = 0; v < s.nv; v++) { /* a dome: from below it hides itself, from above nothing does */
        const double x = v / 8 / 4.5 - 1.0, y = v % 8 / 3.5 - 1.0;
        s.xyz[3 * v] = x;
        s.xyz[3 * v + 1] = y;
        s.xyz[3 * v + 2] = -x * x - y * y;
    }
    for (int side = 0; side < 2; side++) {
        sl_mesh *sheet = soup_build(&s, NULL);
        compute(sheet, 32, 1 << 21, visible);
        for (int32_t f = 0; f < sheet->nf; f++) {
            assert_true(visible[f] >= 0.75);
        }
        sl_mesh_free(sheet);
        soup_scramble(&s, &rng, 1.0);
    }
    soup_clear(&s);
    add_ball(&s, 9, (const double[]){0.0, 0.0, 0.0}, 1.0, 0.5, false);
    sl_mesh *m = soup_build(&s, NULL);
    compute(m, 32, 1 << 21, visible);
    for (int32_t h = 0; h < m->nh; h += 3) {
        sl_mesh_cut_edge(m, h);
    }
    compute(m, 32, 1 << 21, other);
    assert_memory_equal(visible, other, (size_t)m->nf * sizeof *other);
    sl_mesh_free(m);
}

static void any_number_of_threads_gives_the_same_bytes(void **state)
{
    (void)state;
    soup_clear(&s);
    add_ball(&s, 19, (const double[]){0.0, 0.0, 0.0}, 1.0, 0.5, false);
    sl_mesh *m = soup_build(&s, NULL);
    compute(m, 24, 5000, visible);
    for (int32_t threads = 2; threads <= 5; threads += 3) {
        sl_thread_pool *pool = NULL;
        assert_int_equal(sl_thread_pool_create(threads, &pool), SL_OK);
        const sl_context context = {.executor = sl_thread_pool_executor(pool)};
        const sl_ambient_def def = {.rays = 24, .rays_total = 5000};
        assert_int_equal(sl_ambient_compute(m, &def, &context, other), SL_OK);
        assert_memory_equal(visible, other, (size_t)m->nf * sizeof *other);
        sl_thread_pool_free(pool);
    }
    sl_mesh_free(m);
}

static void dirty_meshes_have_values_in_range(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xd17);
    for (int trial = 0; trial < 40 * test_multiplier(); trial++) {
        soup_random(&s, &rng, 12 + test_index(&rng, 40), 5 + test_index(&rng, 80));
        sl_mesh *m = soup_build(&s, NULL);
        compute(m, 16, trial % 2 == 0 ? 1 : 1 << 20, visible);
        for (int32_t f = 0; f < m->nf; f++) {
            assert_true(visible[f] >= 0.0 && visible[f] <= 1.0);
        }
        sl_mesh_free(m);
    }
}

static bool refuse(void *user, const char *stage, double fraction)
{
    (void)stage;
    (void)fraction;
    return --*(int *)user > 0;
}

static void options_out_of_range_are_refused_and_a_caller_can_cancel(void **state)
{
    (void)state;
    soup_clear(&s);
    add_ball(&s, 9, (const double[]){0.0, 0.0, 0.0}, 1.0, 0.5, false);
    sl_mesh *m = soup_build(&s, NULL);
    const sl_ambient_def bad[] = {{3, 1000}, {257, 1000}, {64, 0}};
    for (size_t k = 0; k < SL_COUNTOF(bad); k++) {
        assert_int_equal(sl_ambient_compute(m, &bad[k], NULL, visible), SL_BAD_INPUT);
    }
    const sl_ambient_def def = sl_ambient_default();
    for (int after = 1; after <= 2; after++) {
        int left = after;
        const sl_context context = {.progress = refuse, .progress_user = &left};
        assert_int_equal(sl_ambient_compute(m, &def, &context, visible), SL_CANCELLED);
    }
    sl_mesh_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_convex_shape_sees_everything_and_what_it_holds_nothing),
        cmocka_unit_test(a_roof_hides_as_much_as_its_view_factor),
        cmocka_unit_test(visibility_is_what_random_rays_find),
        cmocka_unit_test(few_rays_averaged_come_near_many),
        cmocka_unit_test(borders_open_a_surface_and_seams_do_not),
        cmocka_unit_test(any_number_of_threads_gives_the_same_bytes),
        cmocka_unit_test(dirty_meshes_have_values_in_range),
        cmocka_unit_test(options_out_of_range_are_refused_and_a_caller_can_cancel),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
