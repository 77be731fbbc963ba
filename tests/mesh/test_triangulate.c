#include "mesh/triangulate.h"

#include "mesh/mesh_fixtures.h"

enum { MOST = 60 };

static soup s;

/* A random rotation and shift of the plane into space. */
typedef struct placement {
    double origin[3], u[3], v[3];
} placement;

static placement random_placement(test_rng *rng)
{
    placement p;
    double n[3], length;
    for (int k = 0; k < 3; k++) {
        p.origin[k] = test_uniform(rng, -5.0, 9.0);
        p.u[k] = test_uniform(rng, -1.0, 1.0);
        n[k] = test_uniform(rng, -1.0, 1.0) + (k == 0 ? 1.5 : 0.0);
    }
    p.u[1] += 2.0;
    for (int k = 0; k < 3; k++) {
        p.v[k] = n[(k + 1) % 3] * p.u[(k + 2) % 3] - n[(k + 2) % 3] * p.u[(k + 1) % 3];
    }
    length = sqrt(p.v[0] * p.v[0] + p.v[1] * p.v[1] + p.v[2] * p.v[2]);
    const double u_length = sqrt(p.u[0] * p.u[0] + p.u[1] * p.u[1] + p.u[2] * p.u[2]);
    for (int k = 0; k < 3; k++) {
        p.v[k] /= length;
        p.u[k] /= u_length;
    }
    return p;
}

static void place_polygon(soup *out, int32_t d, double (*xy)[2], const placement *p)
{
    int32_t corner[MOST];
    for (int32_t k = 0; k < d; k++) {
        double x[3];
        for (int c = 0; c < 3; c++) {
            x[c] = p->origin[c] + xy[k][0] * p->u[c] + xy[k][1] * p->v[c];
        }
        corner[k] = soup_vertex(out, x[0], x[1], x[2]);
    }
    soup_face(out, d, corner);
}

static bool properly_cross(const double *a, const double *b, const double *c, const double *d)
{
    const double abc = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    const double abd = (b[0] - a[0]) * (d[1] - a[1]) - (b[1] - a[1]) * (d[0] - a[0]);
    const double cda = (d[0] - c[0]) * (a[1] - c[1]) - (d[1] - c[1]) * (a[0] - c[0]);
    const double cdb = (d[0] - c[0]) * (b[1] - c[1]) - (d[1] - c[1]) * (b[0] - c[0]);
    return abc * abd < 0.0 && cda * cdb < 0.0;
}

static double doubled_area(int32_t d, double (*xy)[2])
{
    double sum = 0.0;
    for (int32_t k = 0; k < d; k++) {
        const double *a = xy[k], *b = xy[(k + 1) % d];
        sum += a[0] * b[1] - a[1] * b[0];
    }
    return sum;
}

static void reverse_run(double (*xy)[2], int32_t i, int32_t j)
{
    for (; i < j; i++, j--) {
        for (int k = 0; k < 2; k++) {
            const double t = xy[i][k];
            xy[i][k] = xy[j][k];
            xy[j][k] = t;
        }
    }
}

/* Random points, crossings undone by reversing runs: each step shortens the polygon, so it ends, and simple. */
static void simple_polygon(test_rng *rng, int32_t d, double (*xy)[2])
{
    for (int32_t k = 0; k < d; k++) {
        xy[k][0] = test_uniform(rng, -1.0, 1.0);
        xy[k][1] = test_uniform(rng, -1.0, 1.0);
    }
    for (bool crossed = true; crossed;) {
        crossed = false;
        for (int32_t i = 0; i < d; i++) {
            for (int32_t j = i + 2; j < d; j++) {
                if (properly_cross(xy[i], xy[i + 1], xy[j], xy[(j + 1) % d])) {
                    reverse_run(xy, i + 1, j);
                    crossed = true;
                }
            }
        }
    }
    if (doubled_area(d, xy) < 0.0) {
        reverse_run(xy, 0, d - 1);
    }
}

static void triangle_vector(const sl_mesh *m, const int32_t *corner, double n[3])
{
    double a[3], b[3];
    for (int k = 0; k < 3; k++) {
        a[k] = m->xyz[3 * m->origin[corner[1]] + k] - m->xyz[3 * m->origin[corner[0]] + k];
        b[k] = m->xyz[3 * m->origin[corner[2]] + k] - m->xyz[3 * m->origin[corner[0]] + k];
    }
    for (int k = 0; k < 3; k++) {
        n[k] = 0.5 * (a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3]);
    }
}

/* d - 2 triangles of the facet's own corners; each edge of the polygon in one of them, each diagonal once either way.
 */
static void check_combinatorics(const sl_mesh *m, const sl_triangulation *t)
{
    assert_int_equal(t->nt, m->nh - 2 * m->nf);
    assert_int_equal(t->first[0], 0);
    assert_int_equal(t->first[m->nf], t->nt);
    for (int32_t f = 0; f < m->nf; f++) {
        const int32_t d = sl_degree(m, f);
        static int32_t uses[MOST][MOST];
        assert_int_equal(t->first[f + 1] - t->first[f], d - 2);
        for (int32_t i = 0; i < d * d; i++) {
            uses[i / d][i % d] = 0;
        }
        for (int32_t q = 3 * t->first[f]; q < 3 * t->first[f + 1]; q++) {
            assert_int_equal(m->face[t->corner[q]], f);
            const int32_t to = t->corner[q % 3 == 2 ? q - 2 : q + 1];
            uses[t->corner[q] - m->face_first[f]][to - m->face_first[f]]++;
        }
        for (int32_t i = 0; i < d; i++) {
            for (int32_t j = 0; j < d; j++) {
                assert_true(uses[i][j] <= 1);
                const bool edge = (i + 1) % d == j, back = (j + 1) % d == i;
                assert_true(edge ? uses[i][j] == 1 : back ? uses[i][j] == 0 : uses[i][j] == uses[j][i]);
            }
        }
    }
}

/* Triangles turn with the facet, and fill it: least is the least share of the facet's area a triangle may have. */
static void check_geometry(const sl_mesh *m, const sl_triangulation *t, double least)
{
    for (int32_t f = 0; f < m->nf; f++) {
        double n[3], sum = 0.0;
        sl_mesh_face_vector_area(m, f, n);
        const double area = sl_mesh_face_area(m, f);
        for (int32_t q = t->first[f]; q < t->first[f + 1]; q++) {
            double a[3];
            triangle_vector(m, t->corner + 3 * q, a);
            const double dot = (a[0] * n[0] + a[1] * n[1] + a[2] * n[2]) / area;
            assert_true(dot > least * area);
            sum += sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
        }
        assert_true(test_near(sum, area, 1e-12));
    }
}

static void triangulate_and_check(const soup *in, double least)
{
    sl_mesh *m = soup_build(in, NULL);
    sl_triangulation *t = NULL;
    assert_int_equal(sl_triangulation_create(m, &t), SL_OK);
    check_combinatorics(m, t);
    check_geometry(m, t, least);
    sl_triangulation_free(t);
    sl_mesh_free(m);
}

static void random_simple_polygons_get_positive_triangles(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x7a1a);
    for (int trial = 0; trial < 300 * test_multiplier(); trial++) {
        soup_clear(&s);
        for (int f = 0; f < 4; f++) {
            double xy[MOST][2];
            const int32_t d = 4 + test_index(&rng, f == 0 ? MOST - 4 : 12);
            simple_polygon(&rng, d, xy);
            const placement p = random_placement(&rng);
            place_polygon(&s, d, xy, &p);
        }
        triangulate_and_check(&s, 0.0);
    }
}

static void hopeless_polygons_still_get_all_their_triangles(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x40be);
    for (int trial = 0; trial < 300 * test_multiplier(); trial++) {
        soup_clear(&s);
        const int32_t nv = 30;
        for (int32_t v = 0; v < nv; v++) { /* lattice points: equal places and collinear runs are common */
            soup_vertex(&s, test_index(&rng, 4), test_index(&rng, 4), trial % 2 == 0 ? 2.0 : test_index(&rng, 3));
        }
        for (int f = 0; f < 4; f++) {
            int32_t corner[MOST];
            const int32_t d = 3 + test_index(&rng, 20);
            for (int32_t k = 0; k < d; k++) {
                corner[k] = test_index(&rng, nv);
            }
            soup_face(&s, d, corner);
        }
        sl_mesh *m = soup_build(&s, NULL);
        sl_triangulation *t = NULL;
        assert_int_equal(sl_triangulation_create(m, &t), SL_OK);
        check_combinatorics(m, t);
        sl_triangulation_free(t);
        sl_mesh_free(m);
    }
}

static void convex_polygons_are_fans_from_their_first_input_corner(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xfa2);
    for (int trial = 0; trial < 40 * test_multiplier(); trial++) {
        soup_clear(&s);
        double xy[MOST][2];
        const int32_t d = 3 + test_index(&rng, 9);
        for (int32_t k = 0; k < d; k++) {
            const double a = 2.0 * TEST_PI * (k + test_uniform(&rng, 0.1, 0.9)) / d;
            xy[k][0] = 3.0 * cos(a);
            xy[k][1] = 2.0 * sin(a);
        }
        const placement p = random_placement(&rng);
        place_polygon(&s, d, xy, &p);
        /* A larger neighbour the wrong way round makes the polygon the minority: it is reversed. */
        const int32_t apex = soup_vertex(&s, 400.0, 300.0, -200.0);
        soup_face(&s, 3, (int32_t[]){0, 1, apex});
        sl_mesh *m = soup_build(&s, NULL);
        assert_int_equal(m->face_flags[0], SL_FACE_REVERSED);
        sl_triangulation *t = NULL;
        assert_int_equal(sl_triangulation_create(m, &t), SL_OK);
        for (int32_t q = 0; q < d - 2; q++) {
            assert_int_equal(sl_input_corner(m, t->corner[3 * q]), 0);
            assert_int_equal(t->corner[3 * q + 1], q + 1);
            assert_int_equal(t->corner[3 * q + 2], q + 2);
        }
        check_geometry(m, t, 0.0);
        sl_triangulation_free(t);
        sl_mesh_free(m);
    }
}

static void corners_on_straight_sides_make_no_flat_triangle(void **state)
{
    (void)state;
    static double xy[][2] = {{0, 0}, {1, 0}, {2, 0}, {5, 0}, {5, 1}, {5, 4}, {3, 4}, {2, 4}, {0, 4}, {0, 3}, {0, 1}};
    const placement flat = {{0.0, 0.0, 7.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
    for (int32_t shift = 0; shift < 11; shift++) {
        double turned[11][2];
        for (int32_t k = 0; k < 11; k++) {
            turned[k][0] = xy[(k + shift) % 11][0];
            turned[k][1] = xy[(k + shift) % 11][1];
        }
        soup_clear(&s);
        place_polygon(&s, 11, turned, &flat);
        triangulate_and_check(&s, 1e-3);
    }
}

static void a_spiral_and_a_comb_are_filled(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x5b1);
    double xy[MOST][2];
    for (int32_t k = 0; k < 30; k++) {
        const double a = 0.4 * k, r = 1.0 + 0.35 * a;
        xy[k][0] = r * cos(a);
        xy[k][1] = r * sin(a);
        xy[59 - k][0] = (r - 0.7) * cos(a);
        xy[59 - k][1] = (r - 0.7) * sin(a);
    }
    const placement p = random_placement(&rng), q = random_placement(&rng);
    soup_clear(&s);
    place_polygon(&s, 60, xy, &p);
    for (int32_t k = 0; k < 20; k++) {
        xy[k][0] = 20 - k;
        xy[k][1] = k % 2 == 0 ? 9.0 : 0.1 + 0.01 * k;
    }
    xy[20][0] = 0.5;
    xy[20][1] = -1.0;
    xy[21][0] = 20.5;
    xy[21][1] = -1.0;
    place_polygon(&s, 22, xy, &q);
    triangulate_and_check(&s, 0.0);
}

/* A triangle with a large triangular hole, joined by a bridge that is run twice: no ear but at the bridge. */
static void a_bridge_to_a_hole_is_not_an_obstacle(void **state)
{
    (void)state;
    static const double xy[][2] = {{0, 0}, {10, 0}, {0, 10}, {0, 0}, {1, 1}, {1, 8}, {8, 1}, {1, 1}};
    const placement flat = {{0.0, 0.0, 7.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
    for (int32_t shift = 0; shift < 16; shift++) {
        double turned[8][2];
        for (int32_t k = 0; k < 8; k++) { /* and mirrored, run backwards */
            const int32_t from = shift < 8 ? (k + shift) % 8 : (shift - k) % 8;
            turned[k][0] = xy[from][shift < 8 ? 0 : 1];
            turned[k][1] = xy[from][shift < 8 ? 1 : 0];
        }
        soup_clear(&s);
        place_polygon(&s, 8, turned, &flat);
        triangulate_and_check(&s, 0.0);
    }
}

/* Outline, bridge, hole, bridge; false when the bridge crosses something. */
static bool keyhole(test_rng *rng, int32_t outer, int32_t hole, double (*xy)[2])
{
    const double turn = test_uniform(rng, -1.2, 1.2);
    for (int32_t k = 0; k <= outer; k++) {
        const double a = 2.0 * TEST_PI * (k % outer) / outer, r = test_uniform(rng, 2.5, 5.0);
        xy[k][0] = k < outer ? r * cos(a) : xy[0][0];
        xy[k][1] = k < outer ? r * sin(a) : xy[0][1];
    }
    for (int32_t k = 0; k <= hole; k++) {
        const double a = turn - 2.0 * TEST_PI * (k % hole) / hole, r = test_uniform(rng, 0.3, 1.2);
        double *p = xy[outer + 1 + k];
        p[0] = k < hole ? r * cos(a) : xy[outer + 1][0];
        p[1] = k < hole ? r * sin(a) : xy[outer + 1][1];
    }
    for (int32_t k = 0; k < outer + hole + 1; k++) {
        if (properly_cross(xy[outer], xy[outer + 1], xy[k], xy[k + 1])) {
            return false;
        }
    }
    return true;
}

static void random_polygons_with_a_hole_get_positive_triangles(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x6e7);
    int bridged = 0;
    for (int trial = 0; trial < 2000 * test_multiplier(); trial++) {
        double xy[MOST][2], turned[MOST][2];
        const int32_t outer = 7 + test_index(&rng, 6), hole = 3 + test_index(&rng, 6), d = outer + hole + 2;
        if (!keyhole(&rng, outer, hole, xy)) {
            continue;
        }
        const bool mirror = test_index(&rng, 2) == 1;
        const int32_t shift = test_index(&rng, d);
        for (int32_t k = 0; k < d; k++) {
            const int32_t from = (mirror ? shift + d - k : shift + k) % d;
            turned[k][0] = xy[from][mirror ? 1 : 0];
            turned[k][1] = xy[from][mirror ? 0 : 1];
        }
        const placement p = random_placement(&rng);
        soup_clear(&s);
        place_polygon(&s, d, turned, &p);
        triangulate_and_check(&s, 0.0);
        bridged++;
    }
    assert_true(bridged > 500);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_simple_polygons_get_positive_triangles),
        cmocka_unit_test(hopeless_polygons_still_get_all_their_triangles),
        cmocka_unit_test(convex_polygons_are_fans_from_their_first_input_corner),
        cmocka_unit_test(corners_on_straight_sides_make_no_flat_triangle),
        cmocka_unit_test(a_spiral_and_a_comb_are_filled),
        cmocka_unit_test(a_bridge_to_a_hole_is_not_an_obstacle),
        cmocka_unit_test(random_polygons_with_a_hole_get_positive_triangles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
