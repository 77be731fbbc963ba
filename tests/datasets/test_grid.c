/* The generators' tools: finding, grids, welding, appending, blocks, roughening. */
#include "grid.h"
#include "locate.h"
#include "roughen.h"
#include "support/test_support.h"
#include "voxels.h"

#include "base/memory.h"
#include "mesh/build.h"

#include <math.h>
#include <string.h>

static void a_point_is_found_by_its_place_the_first_of_several(void **state)
{
    (void)state;
    enum { POINTS = 400 };
    double xyz[3 * POINTS];
    gen_locator locator;
    test_rng rng = test_rng_seed(0x10ca7e);
    for (int i = 0; i < 3 * POINTS; i++) { /* a coarse lattice: many points share coordinates, some share all */
        xyz[i] = 0.37 * test_index(&rng, 9) - 1.3;
    }
    assert_int_equal(gen_locator_init(&locator, xyz, POINTS, 1e-3), SL_OK);
    for (int trial = 0; trial < 3000 * test_multiplier(); trial++) {
        const int32_t near = test_index(&rng, POINTS);
        double p[3];
        int32_t expected = -1;
        for (int k = 0; k < 3; k++) {
            p[k] = xyz[3 * near + k] + test_uniform(&rng, -1.3, 1.3) * locator.tolerance;
        }
        for (int32_t v = POINTS - 1; v >= 0; v--) {
            const double *q = xyz + 3 * v;
            const double away = fmax(fmax(fabs(p[0] - q[0]), fabs(p[1] - q[1])), fabs(p[2] - q[2]));
            expected = away <= locator.tolerance ? v : expected;
        }
        assert_int_equal(gen_locate(&locator, p), expected);
    }
    gen_locator_clear(&locator);
}

/* A bent sheet; at u = 0 all of v is one point, at u = 1 its two ends meet. */
static void fan_point(const void *data, double u, double v, double p[3])
{
    const double turn = *(const double *)data * v;
    p[0] = 1.7 * u * cos(turn);
    p[1] = 0.4 * u * u;
    p[2] = -1.7 * u * sin(turn);
}

static sl_repair_report report_of(gen_builder *b, int32_t *nv, int32_t *nf)
{
    sl_generated *mesh = NULL;
    sl_polygons polygons;
    sl_mesh *built = NULL;
    sl_repair_report report;
    assert_int_equal(gen_finish(b, &mesh), SL_OK);
    *nv = mesh->nv;
    *nf = mesh->nf;
    sl_generated_polygons(mesh, &polygons);
    assert_int_equal(sl_mesh_build(&polygons, &built, &report, NULL), SL_OK);
    sl_mesh_free(built);
    sl_generated_free(mesh);
    const sl_repair_report counts = report;
    sl_repair_report_clear(&report);
    return counts;
}

static void welding_closes_a_turn_and_makes_triangles_at_a_point(void **state)
{
    (void)state;
    const double whole = 2.0 * TEST_PI;
    gen_builder b = {0};
    int32_t nv = 0, nf = 0;
    gen_vertex(&b, 9.0, 9.0, 9.0); /* used by no facet */
    gen_grid(&b, 5, 12, fan_point, &whole);
    gen_weld(&b, gen_weld_tolerance);
    const sl_repair_report r = report_of(&b, &nv, &nf);
    assert_int_equal(nv, 1 + 5 * 12);
    assert_int_equal(nf, 5 * 12);
    assert_int_equal(r.triangles, 12);
    assert_int_equal(r.quads, 4 * 12);
    assert_int_equal(r.border_loops, 1);
    assert_int_equal(r.components, 1);
    assert_int_equal(r.genus, 0);
    assert_int_equal(r.unused_vertices + r.isolated_faces + r.nonmanifold_edges + r.reversed_faces, 0);
}

static void welding_drops_what_has_no_corners_left_and_keeps_the_rest_in_order(void **state)
{
    (void)state;
    static const double at[7][2] = {{0.0, 0.0}, {1.0, 0.1},  {1.1, 1.2}, {0.0, 0.0},
                                    {1.1, 1.2}, {-0.1, 0.9}, {1.0, 0.1}};
    gen_builder b = {0};
    sl_generated *mesh = NULL;
    for (int k = 0; k < 7; k++) {
        gen_vertex(&b, at[k][0], at[k][1], 0.3);
    }
    gen_triangle(&b, 0, 3, 4);                    /* two places only */
    gen_quad(&b, 0, 1, 6, 2);                     /* a corner twice in a row */
    gen_facet(&b, 5, (int32_t[]){3, 4, 2, 5, 0}); /* first and last the same, and one twice */
    gen_weld(&b, gen_weld_tolerance);
    assert_int_equal(gen_finish(&b, &mesh), SL_OK);
    assert_int_equal(mesh->nf, 2);
    assert_int_equal(mesh->nv, 4);
    assert_int_equal(mesh->face_first[1], 3);
    assert_int_equal(mesh->face_first[2], 6);
    assert_memory_equal(mesh->index, ((int32_t[]){0, 1, 2, 0, 2, 3}), 6 * sizeof(int32_t));
    assert_true(mesh->xyz[9] == -0.1 && mesh->xyz[10] == 0.9);
    sl_generated_free(mesh);
}

/* Six times the volume under a closed mesh, its facets fans of triangles. */
static double volume_of(const gen_builder *b)
{
    double sum = 0.0;
    for (int64_t f = 0; f < b->nf; f++) {
        for (int32_t c = b->first[f] + 1; c + 1 < b->first[f + 1]; c++) {
            const double *p = b->xyz + 3 * (int64_t)b->index[b->first[f]];
            const double *q = b->xyz + 3 * (int64_t)b->index[c], *r = b->xyz + 3 * (int64_t)b->index[c + 1];
            sum += p[0] * (q[1] * r[2] - q[2] * r[1]) + p[1] * (q[2] * r[0] - q[0] * r[2]) +
                   p[2] * (q[0] * r[1] - q[1] * r[0]);
        }
    }
    return sum;
}

static void an_appended_mirror_image_still_faces_outward(void **state)
{
    (void)state;
    const double moved[2][12] = {{0.3, 0.1, -0.2, 4.0, 0.0, 1.1, 0.3, -1.0, 0.2, -0.4, 0.9, 2.0},
                                 {-0.3, 0.1, -0.2, 4.0, 0.0, 1.1, 0.3, -1.0, -0.2, -0.4, 0.9, 2.0}};
    sl_generated *ball = NULL;
    assert_int_equal(gen_sphere(0, 1, &ball), SL_OK);
    for (int k = 0; k < 2; k++) {
        gen_builder whole = {0}, b = {0};
        gen_append(&whole, ball, (const double[]){1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0});
        gen_vertex(&b, 0.0, 0.0, 0.0);
        gen_append(&b, ball, moved[k]);
        const double *m = moved[k];
        const double det = m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) +
                           m[2] * (m[4] * m[9] - m[5] * m[8]);
        assert_true(k == 0 ? det > 0.0 : det < 0.0);
        assert_true(test_near(volume_of(&b), fabs(det) * volume_of(&whole), 1e-10));
        gen_clear(&whole);
        gen_clear(&b);
    }
    sl_generated_free(ball);
}

static void refining_doubles_and_ends(void **state)
{
    (void)state;
    assert_int_equal(gen_refined(7, 1), 7);
    assert_int_equal(gen_refined(7, 2), 14);
    assert_int_equal(gen_refined(7, 5), 112);
    assert_in_range(gen_refined(7, INT32_MAX), 100000, 200000);
}

/* A ring of eight cells with one more on top, and an opening. */
static void blocks_become_their_surface(void **state)
{
    (void)state;
    static const char *const closed[] = {"####.####", ".#......."}, *const open[] = {"####.####", ".o......."};
    for (int k = 0; k < 2; k++) {
        gen_cage cage = {0};
        gen_builder b = {0};
        int32_t nv = 0, nf = 0;
        gen_cage_voxels(&cage, (const int32_t[]){3, 3, 2}, k == 0 ? closed : open);
        assert_false(cage.failed);
        assert_int_equal(cage.nq, k == 0 ? 8 + 8 + 12 + 4 + 4 : 8 + 7 + 12 + 4);
        for (int64_t v = 0; v < cage.nv; v++) {
            gen_vertex(&b, cage.xyz[3 * v], cage.xyz[3 * v + 1], cage.xyz[3 * v + 2]);
        }
        for (int64_t q = 0; q < cage.nq; q++) {
            gen_facet(&b, 4, cage.quad + 4 * q);
        }
        if (k == 0) {
            assert_true(test_near(volume_of(&b), 6.0 * 9.0, 1e-12)); /* nine unit cells */
        }
        const sl_repair_report r = report_of(&b, &nv, &nf);
        assert_int_equal(r.genus, 1);
        assert_int_equal(r.border_loops, k);
        assert_int_equal(r.reversed_faces + r.nonmanifold_edges + r.bowtie_vertices + r.unused_vertices, 0);
        gen_cage_clear(&cage);
    }
}

static void relaxing_takes_steps_out_and_leaves_heights_alone(void **state)
{
    (void)state;
    static const char *const layer[] = {"##..###.####"}; /* a staircase */
    gen_cage cage = {0};
    gen_cage_voxels(&cage, (const int32_t[]){4, 3, 1}, layer);
    double before = 0.0, after = 0.0;
    for (int64_t v = 0; v < cage.nv; v++) {
        before += cage.xyz[3 * v] * cage.xyz[3 * v] + cage.xyz[3 * v + 1] * cage.xyz[3 * v + 1];
    }
    gen_cage_relax_flat(&cage, 4);
    for (int64_t v = 0; v < cage.nv; v++) {
        after += cage.xyz[3 * v] * cage.xyz[3 * v] + cage.xyz[3 * v + 1] * cage.xyz[3 * v + 1];
        assert_true(fabs(cage.xyz[3 * v + 2]) == 0.5);
    }
    assert_true(after < 0.9 * before && after > 0.2 * before);
    gen_cage_clear(&cage);
}

/* An ellipsoid of quads. */
static gen_builder ball(void)
{
    sl_generated *sphere = NULL;
    gen_builder b = {0};
    assert_int_equal(gen_sphere(0, 1, &sphere), SL_OK);
    gen_append(&b, sphere, (const double[]){1.0, 0.0, 0.0, 0.0, 0.0, 1.3, 0.0, 0.0, 0.0, 0.0, 0.8, 0.0});
    sl_generated_free(sphere);
    return b;
}

static gen_builder rough_ball(sl_rng *rng, int32_t passes, double noise)
{
    gen_builder b = ball();
    gen_split_quads(&b, rng);
    gen_flip_edges(&b, rng, passes);
    gen_add_noise(&b, rng, noise);
    assert_false(b.failed);
    return b;
}

static void roughening_keeps_the_surface_and_changes_its_triangles(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 5; seed++) {
        sl_rng rng = sl_rng_seed(seed), again = sl_rng_seed(seed);
        gen_builder split = rough_ball(&rng, 0, 0.0), b = rough_ball(&again, 4, 0.1);
        int64_t changed = 0;
        double farthest = 0.0;
        assert_int_equal(b.nf, split.nf);
        assert_int_equal(b.nv, split.nv);
        for (int64_t c = 0; c < b.nc; c++) {
            changed += b.index[c] != split.index[c];
        }
        for (int64_t i = 0; i < 3 * b.nv; i++) {
            farthest = fmax(farthest, fabs(b.xyz[i] - split.xyz[i]));
        }
        assert_true(changed > b.nc / 4);
        assert_true(farthest > 0.002 && farthest < 0.02); /* a tenth of edges of 0.02 to 0.15, and half as much */
        assert_true(test_near(volume_of(&b), volume_of(&split), 0.01 * volume_of(&split)));
        int32_t nv = 0, nf = 0;
        const sl_repair_report r = report_of(&b, &nv, &nf);
        assert_int_equal(r.triangles, nf);
        assert_int_equal(r.border_loops + r.genus + r.nonmanifold_edges + r.reversed_faces + r.isolated_faces, 0);
        gen_clear(&split);
    }
}

/* Share of the squared offsets that lies along the normal. */
static double share_along_normal(const gen_builder *plain, const gen_builder *b)
{
    double along = 0.0, all = 0.0;
    for (int64_t v = 0; v < b->nv; v++) {
        const double *p = plain->xyz + 3 * v, *q = b->xyz + 3 * v;
        const double n[3] = {p[0], p[1] / (1.3 * 1.3), p[2] / (0.8 * 0.8)}; /* of the ellipsoid */
        double dot = 0.0, norm = 0.0;
        for (int k = 0; k < 3; k++) {
            dot += (q[k] - p[k]) * n[k];
            norm += n[k] * n[k];
            all += (q[k] - p[k]) * (q[k] - p[k]);
        }
        along += dot * dot / norm;
    }
    return along / all;
}

/* As much along the normal as announced: a third of reach^2 there, a sixth across it. */
static void noise_is_larger_along_the_normal_than_across(void **state)
{
    (void)state;
    sl_rng rng = sl_rng_seed(11), again = sl_rng_seed(11);
    gen_builder plain = rough_ball(&rng, 2, 0.0), b = rough_ball(&again, 2, 0.1);
    assert_true(test_near(share_along_normal(&plain, &b), 2.0 / 3.0, 0.05));
    gen_clear(&plain);
    gen_clear(&b);
}

/* Facets of four corners and of three at the poles: the number of all corners need not be a multiple of three. */
static void noise_of_quads_is_as_that_of_triangles(void **state)
{
    (void)state;
    sl_rng rng = sl_rng_seed(13);
    gen_builder plain = ball(), b = ball();
    double farthest = 0.0;
    gen_add_noise(&b, &rng, 0.1);
    assert_false(b.failed);
    for (int64_t i = 0; i < 3 * b.nv; i++) {
        assert_true(isfinite(b.xyz[i]));
        farthest = fmax(farthest, fabs(b.xyz[i] - plain.xyz[i]));
    }
    assert_true(farthest > 0.002 && farthest < 0.02);
    assert_true(test_near(share_along_normal(&plain, &b), 2.0 / 3.0, 0.05));
    gen_clear(&plain);
    gen_clear(&b);
}

static void a_builder_that_failed_stays_failed_and_is_refused(void **state)
{
    (void)state;
    gen_builder b = {.failed = true};
    gen_cage cage = {.failed = true};
    sl_generated *mesh = NULL;
    sl_rng rng = sl_rng_seed(3);
    const double whole = 1.0;
    static const char *const layer[] = {"#"};
    gen_grid(&b, 3, 3, fan_point, &whole);
    gen_weld(&b, gen_weld_tolerance);
    gen_split_quads(&b, &rng);
    gen_flip_edges(&b, &rng, 2);
    gen_add_noise(&b, &rng, 0.1);
    assert_int_equal(gen_finish(&b, &mesh), SL_OUT_OF_MEMORY);
    assert_null(mesh);
    gen_cage_voxels(&cage, (const int32_t[]){1, 1, 1}, layer);
    gen_cage_relax_flat(&cage, 2);
    assert_int_equal(gen_cage_finish(&cage, 1, &mesh), SL_OUT_OF_MEMORY);
    assert_null(mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_point_is_found_by_its_place_the_first_of_several),
        cmocka_unit_test(welding_closes_a_turn_and_makes_triangles_at_a_point),
        cmocka_unit_test(welding_drops_what_has_no_corners_left_and_keeps_the_rest_in_order),
        cmocka_unit_test(an_appended_mirror_image_still_faces_outward),
        cmocka_unit_test(refining_doubles_and_ends),
        cmocka_unit_test(blocks_become_their_surface),
        cmocka_unit_test(relaxing_takes_steps_out_and_leaves_heights_alone),
        cmocka_unit_test(roughening_keeps_the_surface_and_changes_its_triangles),
        cmocka_unit_test(noise_is_larger_along_the_normal_than_across),
        cmocka_unit_test(noise_of_quads_is_as_that_of_triangles),
        cmocka_unit_test(a_builder_that_failed_stays_failed_and_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
