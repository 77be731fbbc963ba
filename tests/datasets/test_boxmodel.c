/* The modelling steps: boxes, picking, extrusion, limbs. */
#include "boxmodel.h"
#include "builder.h"
#include "mesh/build.h"
#include "support/test_support.h"

static const double at_x[] = {-1.1, -0.2, 0.4, 1.3}, at_y[] = {-0.8, 0.1, 0.9}, at_z[] = {-0.6, 0.7};

static gen_cage box_cage(void)
{
    gen_cage cage = {0};
    gen_cage_box(&cage, (const int32_t[]){3, 2, 1}, (const double *const[]){at_x, at_y, at_z});
    assert_false(cage.failed);
    return cage;
}

/* Finishes the cage unsmoothed and says what the builder found. */
static sl_repair_report report_of(gen_cage *cage)
{
    sl_generated *mesh = NULL;
    sl_polygons polygons;
    sl_mesh *built = NULL;
    sl_repair_report report;
    assert_int_equal(gen_cage_finish(cage, 0, &mesh), SL_OK);
    sl_generated_polygons(mesh, &polygons);
    assert_int_equal(sl_mesh_build(&polygons, &built, &report, NULL), SL_OK);
    sl_mesh_free(built);
    sl_generated_free(mesh);
    const sl_repair_report counts = report; /* its lists are gone, its numbers stay */
    sl_repair_report_clear(&report);
    return counts;
}

static void assert_sound(const sl_repair_report *r)
{
    assert_int_equal(r->components, 1);
    assert_int_equal(r->genus, 0);
    assert_int_equal(r->unused_vertices + r->nonmanifold_edges + r->bowtie_vertices + r->reversed_faces, 0);
}

static void a_box_has_the_quads_of_its_six_sides(void **state)
{
    (void)state;
    gen_cage cage = box_cage();
    assert_int_equal(cage.nq, 2 * (3 * 2 + 2 * 1 + 3 * 1));
    const sl_repair_report r = report_of(&cage);
    assert_sound(&r);
    assert_int_equal(r.border_loops, 0);
}

static void nearest_finds_the_quad_by_its_centre(void **state)
{
    (void)state;
    gen_cage cage = box_cage();
    const int32_t q = gen_cage_nearest(&cage, 0.1, 0.5, 9.0);
    for (int k = 0; k < 4; k++) {
        const double *p = cage.xyz + 3 * (int64_t)cage.quad[4 * q + k];
        assert_true(p[2] == 0.7 && p[0] >= -0.2 && p[0] <= 0.4 && p[1] >= 0.1);
    }
    gen_cage_clear(&cage);
    assert_int_equal(gen_cage_nearest(&cage, 0.0, 0.0, 0.0), -1);
}

/* The region's inside moves along: no vertex is left behind, a wall stands on each outline edge and nowhere else. */
static void extrusion_walls_the_outline_and_leaves_no_vertex_unused(void **state)
{
    (void)state;
    gen_cage cage = box_cage();
    int32_t region[6];
    for (int k = 0; k < 6; k++) { /* the whole side z = 0.7: 12 vertices, 2 of them inside */
        region[k] = gen_cage_nearest(&cage, (double[]){-0.65, 0.1, 0.85}[k % 3], k < 3 ? -0.35 : 0.5, 0.7);
    }
    const int64_t nv = cage.nv, nq = cage.nq;
    gen_cage_extrude(&cage, region, 6);
    assert_int_equal(cage.nq, nq + 10);
    assert_int_equal(cage.nv, nv + 10);
    for (int i = 0; i < 24; i++) {
        double *p = cage.xyz + 3 * (int64_t)cage.quad[4 * region[i / 4] + i % 4];
        p[2] = 1.9;
    }
    const sl_repair_report r = report_of(&cage);
    assert_sound(&r);
    assert_int_equal(r.border_loops, 0);
}

/* In a half model there is no wall in the mirror plane, so that the halves join without one inside. */
static void extrusion_at_the_mirror_plane_builds_no_wall_in_it(void **state)
{
    (void)state;
    static const double half[] = {0.0, 0.5, 1.2};
    static const gen_station neck[] = {{{0.0, 1.6, 0.05}, 0.3, 0.4}, {{0.0, 2.1, 0.2}, 0.5, 0.6}};
    gen_cage cage = {.mirrored = true};
    gen_cage_box(&cage, (const int32_t[]){2, 2, 1}, (const double *const[]){half, at_y, at_z});
    const int32_t top = gen_cage_nearest(&cage, 0.25, 0.9, 0.05);
    const int64_t nq = cage.nq;
    gen_cage_limb(&cage, &top, 1, (const double[]){1.0, 0.0, 0.0}, neck, 2);
    assert_int_equal(cage.nq, nq + 2 * 3);
    const sl_repair_report r = report_of(&cage);
    assert_sound(&r);
    assert_int_equal(r.border_loops, 0);
}

/* A square quad's corners land on an ellipse of 1/sqrt(2) of the station's axes, around its centre. */
static void a_limb_ends_in_the_shape_of_its_last_station(void **state)
{
    (void)state;
    static const double at[] = {-1.0, 1.0};
    static const gen_station path[] = {{{0.1, 0.0, 2.0}, 0.7, 0.5}, {{0.1, 0.0, 4.0}, 0.6, 0.3}};
    gen_cage cage = {0};
    gen_cage_box(&cage, (const int32_t[]){1, 1, 1}, (const double *const[]){at, at, at});
    const int32_t end = gen_cage_nearest(&cage, 0.0, 0.0, 1.0);
    gen_cage_limb(&cage, &end, 1, (const double[]){1.0, 0.0, 0.2}, path, 2);
    for (int k = 0; k < 4; k++) {
        const double *p = cage.xyz + 3 * (int64_t)cage.quad[4 * end + k];
        const double x = (p[0] - 0.1) / 0.6, y = p[1] / 0.3;
        assert_true(test_near(p[2], 4.0, 1e-12));
        assert_true(test_near(x * x + y * y, 1.0, 0.02)); /* the first step's slant tilts the outline a little */
        assert_true(x * x > 0.4 && y * y > 0.4);
    }
    const sl_repair_report r = report_of(&cage);
    assert_sound(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_box_has_the_quads_of_its_six_sides),
        cmocka_unit_test(nearest_finds_the_quad_by_its_centre),
        cmocka_unit_test(extrusion_walls_the_outline_and_leaves_no_vertex_unused),
        cmocka_unit_test(extrusion_at_the_mirror_plane_builds_no_wall_in_it),
        cmocka_unit_test(a_limb_ends_in_the_shape_of_its_last_station),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
