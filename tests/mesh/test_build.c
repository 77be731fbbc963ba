#include "mesh/build.h"

#include <float.h>
#include <string.h>

#include "mesh/mesh_check.h"

static soup s;

/* Builds, checks everything by brute force, and frees the mesh; the report's lists are freed too, its numbers stay. */
static sl_repair_report build_and_check(const soup *in)
{
    sl_repair_report r;
    sl_mesh *m = soup_build(in, &r);
    check_mesh(in, m, &r);
    sl_mesh_free(m);
    const sl_repair_report numbers = r;
    sl_repair_report_clear(&r);
    assert_null(r.bowtie);
    return numbers;
}

static void random_soups_keep_every_invariant(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xb111d);
    int64_t nonmanifold = 0, bowties = 0, reversed = 0, one_sided = 0, duplicates = 0, degenerate = 0, genus = 0;
    for (int trial = 0; trial < 1500 * test_multiplier(); trial++) {
        soup_random(&s, &rng, 4 + test_index(&rng, 9), 1 + test_index(&rng, 16));
        const sl_repair_report r = build_and_check(&s);
        nonmanifold += r.nonmanifold_edges;
        bowties += r.bowtie_vertices;
        reversed += r.reversed_faces;
        one_sided += r.one_sided_components;
        duplicates += r.duplicate_faces;
        degenerate += r.degenerate_faces;
        genus += r.genus;
    }
    /* The soups must be dirty enough to mean something. */
    assert_true(nonmanifold > 500 && bowties > 500 && reversed > 500 && one_sided > 20);
    assert_true(duplicates > 200 && degenerate > 200);
    (void)genus;
}

static void scrambled_grids_are_glued_and_oriented(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x6121d);
    static const struct {
        soup_surface kind;
        int32_t loops, genus, one_sided;
    } expect[] = {{SOUP_SHEET, 1, 0, 0},
                  {SOUP_BAND, 2, 0, 0},
                  {SOUP_TORUS, 0, 1, 0},
                  {SOUP_MOEBIUS, -1, -1, 1},
                  {SOUP_KLEIN, -1, -1, 1}};
    for (int trial = 0; trial < 20 * test_multiplier(); trial++) {
        for (size_t k = 0; k < SL_COUNTOF(expect); k++) {
            const int32_t n = 3 + test_index(&rng, 5), m = 3 + test_index(&rng, 4);
            soup_grid(&s, &rng, expect[k].kind, n, m, 0.5);
            soup_scramble(&s, &rng, 0.3);
            const sl_repair_report r = build_and_check(&s);
            assert_int_equal(r.components, 1);
            assert_int_equal(r.one_sided_components, expect[k].one_sided);
            assert_int_equal(r.nonmanifold_edges + r.bowtie_vertices + r.isolated_faces, 0);
            assert_true(r.one_sided_cuts > 0 || expect[k].one_sided == 0);
            assert_true(expect[k].loops < 0 || r.border_loops == expect[k].loops);
            assert_true(expect[k].genus < 0 || r.genus == expect[k].genus);
        }
    }
}

static void a_narrow_moebius_strip_needs_one_cut(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x3eb1);
    soup_grid(&s, &rng, SOUP_MOEBIUS, 7, 1, 0.0);
    const sl_repair_report r = build_and_check(&s);
    assert_int_equal(r.one_sided_cuts, 1);
    assert_int_equal(r.border_loops, 1);
    assert_int_equal(r.bowtie_vertices, 0);
}

static const double cube_xyz[24] = {-1.1, -1, -1, 1, -1,   -1.2, 1, 1.3, -1, -1, 1, -1,
                                    -1,   -1, 1,  1, -1.4, 1,    1, 1,   1,  -1, 1, 1.5};
static const int32_t cube_faces[6][4] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                         {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};

static void make_cube(soup *out)
{
    soup_clear(out);
    memcpy(out->xyz, cube_xyz, sizeof cube_xyz);
    out->nv = 8;
    for (int f = 0; f < 6; f++) {
        soup_face(out, 4, cube_faces[f]);
    }
}

static void a_cube_with_two_facets_reversed_gets_them_back(void **state)
{
    (void)state;
    make_cube(&s);
    for (int f = 2; f < 5; f += 2) {
        const int32_t t = s.index[4 * f + 1];
        s.index[4 * f + 1] = s.index[4 * f + 3];
        s.index[4 * f + 3] = t;
    }
    sl_repair_report r;
    sl_mesh *m = soup_build(&s, &r);
    check_mesh(&s, m, &r);
    assert_int_equal(r.reversed_faces, 2);
    assert_int_equal(r.reversed[0], 2);
    assert_int_equal(r.reversed[1], 4);
    assert_int_equal(r.genus, 0);
    for (int32_t h = 0; h < 24; h++) {
        assert_int_equal(m->origin[h], cube_faces[h / 4][h % 4]);
    }
    sl_mesh_free(m);
    sl_repair_report_clear(&r);
}

static void three_sheets_on_an_edge_come_apart(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x3513);
    soup_clear(&s);
    soup_random_vertices(&s, &rng, 5);
    soup_face(&s, 3, (int32_t[]){0, 1, 2});
    soup_face(&s, 3, (int32_t[]){1, 0, 3});
    soup_face(&s, 3, (int32_t[]){0, 1, 4});
    sl_repair_report r;
    sl_mesh *m = soup_build(&s, &r);
    check_mesh(&s, m, &r);
    assert_int_equal(r.nonmanifold_edges, 1);
    assert_int_equal(r.components, 3);
    assert_int_equal(r.bowtie_vertices, 0); /* the sheets hang together along the edge, not in a point */
    assert_int_equal(m->nv, 9);
    sl_mesh_free(m);
    sl_repair_report_clear(&r);
}

static void two_tetrahedra_pinched_in_a_vertex_are_two_spheres(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x7e7a);
    soup_clear(&s);
    soup_random_vertices(&s, &rng, 7);
    for (int32_t k = 0; k < 2; k++) {
        const int32_t a = 3, b = k == 0 ? 0 : 4, c = k == 0 ? 1 : 5, d = k == 0 ? 2 : 6;
        soup_face(&s, 3, (int32_t[]){a, b, c});
        soup_face(&s, 3, (int32_t[]){a, c, d});
        soup_face(&s, 3, (int32_t[]){a, d, b});
        soup_face(&s, 3, (int32_t[]){b, d, c});
    }
    sl_repair_report r;
    sl_mesh *m = soup_build(&s, &r);
    check_mesh(&s, m, &r);
    assert_int_equal(r.bowtie_vertices, 1);
    assert_int_equal(r.bowtie[0], 3);
    assert_int_equal(r.components, 2);
    assert_int_equal(r.genus + r.border_loops, 0);
    assert_int_equal(m->nv, 8);
    assert_int_equal(m->input_vertex[7], 3);
    assert_int_equal(m->origin[0], 3); /* the first fan keeps the input's vertex */
    sl_mesh_free(m);
    sl_repair_report_clear(&r);
}

static void an_isolated_facet_leaves_the_vertex_to_the_surface(void **state)
{
    (void)state;
    make_cube(&s);
    soup dirty = s;
    soup_clear(&dirty);
    dirty.nv = s.nv;
    soup_face(&dirty, 4, (int32_t[]){0, 3, 3, 1}); /* before the facets that need its vertices */
    for (int f = 0; f < 6; f++) {
        soup_face(&dirty, 4, cube_faces[f]);
    }
    sl_repair_report r;
    sl_mesh *m = soup_build(&dirty, &r);
    check_mesh(&dirty, m, &r);
    assert_int_equal(r.degenerate_faces, 1);
    assert_int_equal(r.bowtie_vertices, 0);
    for (int32_t h = 4; h < 28; h++) {
        assert_true(m->origin[h] < 8);
    }
    for (int32_t h = 0; h < 4; h++) {
        assert_true(m->origin[h] >= 8);
    }
    sl_mesh_free(m);
    sl_repair_report_clear(&r);
}

static void coordinates_of_any_magnitude_are_normalised(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x5ca1e);
    static const double magnitude[] = {1e-30, 1e-300, 1e30, 1e300, 4e307, 1.0, 0x1p-1000, 1e-9};
    for (size_t k = 0; k < SL_COUNTOF(magnitude); k++) {
        soup_grid(&s, &rng, SOUP_TORUS, 6, 5, 0.5);
        for (int32_t i = 0; i < 3 * s.nv; i++) {
            s.xyz[i] *= magnitude[k];
        }
        s.nv++; /* a stray vertex, far away */
        s.xyz[3 * s.nv - 3] = s.xyz[3 * s.nv - 2] = -1e305;
        s.xyz[3 * s.nv - 1] = DBL_MAX;
        sl_repair_report r;
        sl_mesh *m = soup_build(&s, &r);
        check_mesh(&s, m, &r);
        assert_int_equal(r.isolated_faces, 0);
        int e;
        assert_true(frexp(m->scale, &e) == 0.5);
        double extent = 0.0;
        for (int c = 0; c < 3; c++) {
            double lo = 1.0, hi = -1.0;
            for (int32_t v = 0; v < m->nv - 1; v++) {
                lo = fmin(lo, m->xyz[3 * v + c]);
                hi = fmax(hi, m->xyz[3 * v + c]);
            }
            extent = fmax(extent, hi - lo);
            assert_true(test_near(hi + lo, 0.0, 4 * TEST_EPS));
        }
        assert_true(extent > 0.5 && extent <= 1.0);
        sl_mesh_free(m);
        sl_repair_report_clear(&r);
    }
}

static void an_extent_of_a_power_of_two_becomes_one(void **state)
{
    (void)state;
    for (int e = -40; e <= 40; e += 8) {
        make_cube(&s);
        for (int32_t i = 0; i < 24; i++) {
            s.xyz[i] = ldexp(cube_xyz[i] < 0.0 ? -1.0 : 1.0, e);
        }
        sl_mesh *m = soup_build(&s, NULL);
        assert_true(m->scale == ldexp(1.0, -e - 1));
        assert_true(test_near(sl_mesh_diagonal(m), sqrt(3.0), 4 * TEST_EPS));
        sl_mesh_free(m);
    }
}

static void a_mesh_of_one_point_is_all_degenerate(void **state)
{
    (void)state;
    soup_clear(&s);
    for (int32_t v = 0; v < 3; v++) {
        soup_vertex(&s, 7.25, -3.5, 1e20);
    }
    soup_face(&s, 3, (int32_t[]){0, 1, 2});
    const sl_repair_report r = build_and_check(&s);
    assert_int_equal(r.degenerate_faces, 1);
    assert_int_equal(r.components, 0);
}

/* A hub of many facets is where a quadratic matching would show. */
static void a_wheel_of_many_triangles_is_one_disk(void **state)
{
    (void)state;
    enum { SPOKES = 100000 };
    double *xyz = test_malloc((SPOKES + 1) * 3 * sizeof *xyz);
    int32_t *first = test_malloc((SPOKES + 1) * sizeof *first), *index = test_malloc(SPOKES * 3 * sizeof *index);
    xyz[0] = xyz[1] = xyz[2] = 0.25;
    first[0] = 0;
    for (int32_t k = 0; k < SPOKES; k++) {
        const double a = 2.0 * TEST_PI * k / SPOKES;
        xyz[3 * k + 3] = cos(a);
        xyz[3 * k + 4] = sin(a);
        xyz[3 * k + 5] = 0.1 * sin(3 * a);
        const int32_t spin = k % 3, tri[3] = {0, k + 1, (k + 1) % SPOKES + 1};
        for (int32_t c = 0; c < 3; c++) {
            index[3 * k + c] = tri[(c + spin) % 3];
        }
        first[k + 1] = 3 * k + 3;
    }
    const sl_polygons p = {SPOKES + 1, SPOKES, xyz, first, index};
    sl_repair_report r;
    sl_mesh *m;
    assert_int_equal(sl_mesh_build(&p, &m, &r, NULL), SL_OK);
    assert_int_equal(r.components, 1);
    assert_int_equal(r.border_loops, 1);
    assert_int_equal(r.genus, 0);
    assert_int_equal(m->nv, SPOKES + 1);
    sl_mesh_free(m);
    sl_repair_report_clear(&r);
    test_free(xyz);
    test_free(first);
    test_free(index);
}

/* The status, and the element named. */
static void expect_bad(const sl_polygons *p, int64_t element)
{
    sl_mesh *m = NULL;
    sl_repair_report r = {.faces = 77};
    sl_diag diag = sl_diag_none();
    assert_int_equal(sl_mesh_build(p, &m, &r, &diag), SL_BAD_INPUT);
    assert_null(m);
    assert_int_equal(r.faces, 77);
    assert_int_equal(diag.element, element);
    assert_true(diag.reason[0] != '\0');
    assert_int_equal(sl_mesh_build(p, &m, NULL, NULL), SL_BAD_INPUT);
}

static void bad_input_is_refused_by_name(void **state)
{
    (void)state;
    make_cube(&s);
    sl_polygons p = soup_polygons(&s);
    p.nf = 0;
    expect_bad(&p, -1);
    p = soup_polygons(&s);
    s.index[13] = 8;
    expect_bad(&p, 3);
    s.index[13] = -1;
    expect_bad(&p, 3);
    s.index[13] = 2;
    s.xyz[3 * 5 + 1] = NAN;
    expect_bad(&p, 5);
    s.xyz[3 * 5 + 1] = -HUGE_VAL;
    expect_bad(&p, 5);
    s.xyz[3 * 5 + 1] = 1.0;
    s.first[4] = 14; /* facet 3 of two corners */
    expect_bad(&p, 3);
    s.first[4] = 11; /* running backwards */
    expect_bad(&p, 3);
    make_cube(&s);
    s.first[0] = 1;
    expect_bad(&p, 0);
}

static void the_same_input_gives_the_same_bytes(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xb17e5);
    soup_random(&s, &rng, 20, 60);
    sl_mesh *a = soup_build(&s, NULL), *b = soup_build(&s, NULL);
    assert_int_equal(a->nv, b->nv);
    assert_memory_equal(a->origin, b->origin, (size_t)a->nh * sizeof *a->origin);
    assert_memory_equal(a->twin, b->twin, (size_t)a->nh * sizeof *a->twin);
    assert_memory_equal(a->xyz, b->xyz, 3 * (size_t)a->nv * sizeof *a->xyz);
    assert_memory_equal(a->face_flags, b->face_flags, (size_t)a->nf);
    sl_mesh_free(a);
    sl_mesh_free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_soups_keep_every_invariant),
        cmocka_unit_test(scrambled_grids_are_glued_and_oriented),
        cmocka_unit_test(a_narrow_moebius_strip_needs_one_cut),
        cmocka_unit_test(a_cube_with_two_facets_reversed_gets_them_back),
        cmocka_unit_test(three_sheets_on_an_edge_come_apart),
        cmocka_unit_test(two_tetrahedra_pinched_in_a_vertex_are_two_spheres),
        cmocka_unit_test(an_isolated_facet_leaves_the_vertex_to_the_surface),
        cmocka_unit_test(coordinates_of_any_magnitude_are_normalised),
        cmocka_unit_test(an_extent_of_a_power_of_two_becomes_one),
        cmocka_unit_test(a_mesh_of_one_point_is_all_degenerate),
        cmocka_unit_test(a_wheel_of_many_triangles_is_one_disk),
        cmocka_unit_test(bad_input_is_refused_by_name),
        cmocka_unit_test(the_same_input_gives_the_same_bytes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
