/* Modelling by places, and the tiling of quads by triangles and hexagons. */
#include "base/memory.h"
#include "plant.h"
#include "retile.h"
#include "sculpt.h"
#include "support/test_support.h"

#include <math.h>
#include <string.h>

static const double at_x[] = {0.0, 0.45, 1.3}, at_y[] = {-0.8, 0.1, 0.9}, at_z[] = {-0.6, 0.2, 0.7};

/* The half x >= 0 of a box. */
static gen_cage half_box(void)
{
    gen_cage cage = {.mirrored = true};
    gen_cage_box(&cage, (const int32_t[]){2, 2, 2}, (const double *const[]){at_x, at_y, at_z});
    assert_false(cage.failed);
    return cage;
}

static void picking_lists_a_quad_once_and_refuses_too_many_points(void **state)
{
    (void)state;
    gen_cage cage = half_box();
    int32_t region[GEN_MAX_REGION];
    const double at[3][3] = {{0.2, 0.95, -0.2}, {1.0, 0.9, 0.5}, {0.25, 0.9, -0.1}};
    assert_int_equal(gen_pick(&cage, at, 3, region), 2);
    assert_int_equal(region[0], gen_cage_nearest(&cage, 0.225, 0.9, -0.2));
    assert_int_equal(region[1], gen_cage_nearest(&cage, 0.875, 0.9, 0.45));
    const double many[GEN_MAX_REGION + 1][3] = {{0.0}};
    assert_int_equal(gen_pick(&cage, many, GEN_MAX_REGION + 1, region), 0);
    assert_true(cage.failed);
    gen_cage_clear(&cage);
}

/* The top's two outer quads: walls all around, corners where the formula puts them. */
static void a_push_scales_about_the_centroid_and_moves(void **state)
{
    (void)state;
    gen_cage cage = half_box();
    const double at[2][3] = {{0.9, 0.9, -0.2}, {0.9, 0.9, 0.5}};
    const double move[3] = {0.11, 0.7, -0.13}, scale[3] = {0.6, 1.0, 0.8};
    const double centre[3] = {0.5 * (0.45 + 1.3), 0.9, (-0.6 + 0.2 + 0.7) / 3.0};
    const int64_t nv = cage.nv, nq = cage.nq;
    gen_push(&cage, at, 2, move, scale);
    assert_int_equal(cage.nv, nv + 6);
    assert_int_equal(cage.nq, nq + 6);
    for (int i = 0; i < 6; i++) {
        const double was[3] = {at_x[1 + i % 2], 0.9, at_z[i / 2]};
        double want[3];
        int32_t met = 0;
        for (int k = 0; k < 3; k++) {
            want[k] = centre[k] + scale[k] * (was[k] - centre[k]) + move[k];
        }
        for (int64_t v = nv; v < cage.nv; v++) {
            const double *p = cage.xyz + 3 * v;
            met += fabs(p[0] - want[0]) + fabs(p[1] - want[1]) + fabs(p[2] - want[2]) < 16 * TEST_EPS;
        }
        assert_int_equal(met, 1);
    }
    gen_cage_clear(&cage);
}

/* All of the top touches the plane: no wall stands in it, and what was in it stays, whatever the scale and the move. */
static void a_push_at_the_mirror_plane_stays_in_it(void **state)
{
    (void)state;
    gen_cage cage = half_box();
    const double at[4][3] = {{0.2, 0.9, -0.2}, {0.2, 0.9, 0.5}, {0.9, 0.9, -0.2}, {0.9, 0.9, 0.5}};
    sl_generated *mesh = NULL;
    gen_push(&cage, at, 4, (const double[]){0.3, 0.5, 0.2}, (const double[]){0.5, 0.5, 0.5});
    int32_t in_plane = 0, moved[2] = {0, 0};
    for (int64_t v = 0; v < cage.nv; v++) {
        const double x = cage.xyz[3 * v];
        in_plane += x == 0.0;
        for (int i = 0; i < 2; i++) { /* scaled about the plane, not about the half's own middle */
            moved[i] += fabs(x - (0.5 * at_x[1 + i] + 0.3)) < 16 * TEST_EPS;
        }
    }
    assert_true(moved[0] == 3 && moved[1] == 3);
    assert_int_equal(in_plane, 8 + 2); /* the outline of two by two quads, and two ends doubled */
    assert_int_equal(gen_finish_mirrored(&cage, 2, &mesh), SL_OK);
    assert_int_equal(mesh->nplanted, 1);
    assert_int_equal(mesh->nv - 2 * mesh->nf + mesh->nf, 2);
    sl_generated_free(mesh);
}

/* The half box lacks its side in the plane; opening the quads around a corner drops that corner alone. */
static void opening_drops_the_quads_and_the_vertices_only_they_had(void **state)
{
    (void)state;
    gen_cage cage = half_box();
    const double corner[3][3] = {{1.3, 0.5, 0.45}, {0.9, 0.9, 0.45}, {0.9, 0.5, 0.7}};
    const int64_t nv = cage.nv, nq = cage.nq;
    gen_open(&cage, corner, 3);
    assert_false(cage.failed);
    assert_int_equal(cage.nq, nq - 3);
    assert_int_equal(cage.nv, nv - 1);
    for (int64_t i = 0; i < 4 * cage.nq; i++) {
        const double *p = cage.xyz + 3 * (int64_t)cage.quad[i];
        assert_in_range(cage.quad[i], 0, cage.nv - 1);
        assert_false(p[0] == 1.3 && p[1] == 0.9 && p[2] == 0.7);
    }
    for (int axis = 0; axis < 3; axis++) { /* what stays is where it was: still on the grid */
        for (int64_t v = 0; v < cage.nv; v++) {
            const double x = cage.xyz[3 * v + axis], *at = axis == 0 ? at_x : axis == 1 ? at_y : at_z;
            assert_true(x == at[0] || x == at[1] || x == at[2]);
        }
    }
    gen_cage_clear(&cage);
}

static void a_bump_grows_from_the_quad_along_its_direction(void **state)
{
    (void)state;
    gen_cage cage = half_box();
    const int64_t nv = cage.nv, nq = cage.nq;
    const double out[3] = {2.0, 0.6, 0.4}, radius = 0.21, norm = sqrt(4.0 + 0.36 + 0.16);
    const double base[3] = {1.3, 0.5, 0.45};
    double furthest = 0.0;
    gen_bump(&cage, (const double[]){1.4, 0.6, 0.5}, out, radius);
    assert_int_equal(cage.nv, nv + 12);
    assert_int_equal(cage.nq, nq + 12);
    for (int64_t v = nv; v < cage.nv; v++) {
        double along = 0.0, square = 0.0;
        for (int k = 0; k < 3; k++) {
            const double d = cage.xyz[3 * v + k] - base[k];
            along += d * out[k] / norm;
            square += d * d;
        }
        furthest = fmax(furthest, along);
        assert_true(along > 0.0 && sqrt(square - along * along) < 1.5 * radius);
    }
    assert_true(test_near(furthest, 1.15 * radius, 1e-12));
    gen_cage_clear(&cage);
}

/* A roof of four columns over x = -2 .. 2 in one row: the inner pair of a half can be flat, the outer quad bent. */
static sl_generated *roof(double bend, double tilt)
{
    gen_cage cage = {.mirrored = true};
    sl_generated *mesh = NULL;
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 2; j++) {
            const double y = -tilt * i * i - (i == 3 && j == 1 ? bend : 0.0);
            gen_cage_vertex(&cage, (double[]){0.9 * i, y, 1.3 * j});
        }
    }
    for (int32_t i = 0; i < 3; i++) {
        gen_cage_quad(&cage, (int32_t[]){2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2});
    }
    assert_int_equal(gen_cage_finish(&cage, 0, &mesh), SL_OK);
    return mesh;
}

static int32_t facets_of(const sl_generated *mesh, int32_t corners)
{
    int32_t count = 0;
    for (int32_t f = 0; f < mesh->nf; f++) {
        count += mesh->face_first[f + 1] - mesh->face_first[f] == corners;
    }
    return count;
}

static void bent_quads_are_split_and_flat_pairs_joined_alike_on_both_halves(void **state)
{
    (void)state;
    static const struct {
        double bend, tilt;
        int32_t triangles, quads, hexagons;
    } want[] = {
        {0.0, 0.0, 0, 2, 2},                       /* all flat: the first two of a half join, the third is left */
        {0.9, 0.0, 4, 0, 2},                       /* the third bent: split */
        {0.0, 0.2, 0, 6, 0},                       /* none with its neighbour in one plane */
        {0.9, 0.2, 4, 4, 0}, {0.05, 0.0, 0, 2, 2}, /* bent a little: neither */
    };
    for (size_t k = 0; k < SL_COUNTOF(want); k++) {
        sl_generated *mesh = NULL;
        assert_int_equal(gen_retile(roof(want[k].bend, want[k].tilt), &mesh), SL_OK);
        assert_int_equal(facets_of(mesh, 3), want[k].triangles);
        assert_int_equal(facets_of(mesh, 4), want[k].quads);
        assert_int_equal(facets_of(mesh, 6), want[k].hexagons);
        assert_int_equal(gen_plant_mirror(mesh, "mirror x", 1.0, 0.0, 0.0, true), SL_OK);
        sl_generated_free(mesh);
    }
}

/* Bent at any of its four corners, the quad is split along the diagonal that is then the shorter one. */
static void a_bent_quad_is_split_along_its_shorter_diagonal(void **state)
{
    (void)state;
    for (int bent = 0; bent < 4; bent++) {
        static const double square[4][2] = {{0.3, -0.5}, {0.3, 0.6}, {1.5, 0.7}, {1.4, -0.6}};
        gen_cage cage = {.mirrored = true};
        sl_generated *quads = NULL, *mesh = NULL;
        for (int k = 0; k < 4; k++) {
            gen_cage_vertex(&cage, (double[]){square[k][0], k == bent ? 0.8 : 0.0, square[k][1]});
        }
        gen_cage_quad(&cage, (int32_t[]){0, 1, 2, 3});
        assert_int_equal(gen_cage_finish(&cage, 0, &quads), SL_OK);
        assert_int_equal(gen_retile(quads, &mesh), SL_OK);
        assert_int_equal(mesh->nf, 4);
        for (int32_t half = 0; half < 2; half++) {
            const int32_t *a = mesh->index + 6 * half, *b = a + 3; /* two triangles */
            int32_t uses[4] = {0, 0, 0, 0};
            for (int k = 0; k < 3; k++) {
                uses[a[k] - 4 * half]++;
                uses[b[k] - 4 * half]++;
            }
            const int other = (bent + 1) % 4; /* the bent corner's own diagonal has grown */
            assert_true(uses[other] == 2 && uses[(other + 2) % 4] == 2);
        }
        sl_generated_free(mesh);
    }
}

/* Sum over the facets of half the cross products of their sides: a facet's own, its halves' or its parts' alike. */
static void vector_area(const sl_generated *mesh, double half_sign, double sum[3])
{
    memset(sum, 0, 3 * sizeof *sum);
    for (int32_t f = 0; f < mesh->nf; f++) {
        const int32_t first = mesh->face_first[f], n = mesh->face_first[f + 1] - first;
        double middle = 0.0;
        for (int32_t k = 0; k < n; k++) {
            middle += mesh->xyz[3 * (int64_t)mesh->index[first + k]];
        }
        for (int32_t k = 0; k < n && middle * half_sign > 0.0; k++) {
            const double *a = mesh->xyz + 3 * (int64_t)mesh->index[first + k];
            const double *b = mesh->xyz + 3 * (int64_t)mesh->index[first + (k + 1) % n];
            for (int axis = 0; axis < 3; axis++) {
                const int u = (axis + 1) % 3, v = (axis + 2) % 3;
                sum[axis] += 0.5 * (a[u] * b[v] - a[v] * b[u]);
            }
        }
    }
}

static void tiling_anew_keeps_vertices_orientation_and_area(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x7111e5);
    for (int trial = 0; trial < 40 * test_multiplier(); trial++) {
        const double bend = test_uniform(&rng, -1.1, 1.1), tilt = trial % 2 == 0 ? 0.0 : test_uniform(&rng, -0.4, 0.4);
        sl_generated *quads = roof(bend, tilt), *tiled = NULL;
        const int32_t nv = quads->nv;
        double *xyz = sl_copy(quads->xyz, 3 * (int64_t)nv, sizeof *xyz), before[2][3], after[2][3];
        vector_area(quads, 1.0, before[0]);
        vector_area(quads, -1.0, before[1]);
        assert_int_equal(gen_retile(quads, &tiled), SL_OK);
        assert_int_equal(tiled->nv, nv);
        assert_memory_equal(tiled->xyz, xyz, 3 * (size_t)nv * sizeof *xyz);
        vector_area(tiled, 1.0, after[0]);
        vector_area(tiled, -1.0, after[1]);
        for (int k = 0; k < 6; k++) {
            assert_true(test_near(after[k / 3][k % 3], before[k / 3][k % 3], 64 * TEST_EPS));
        }
        sl_free(xyz);
        sl_generated_free(tiled);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(picking_lists_a_quad_once_and_refuses_too_many_points),
        cmocka_unit_test(a_push_scales_about_the_centroid_and_moves),
        cmocka_unit_test(a_push_at_the_mirror_plane_stays_in_it),
        cmocka_unit_test(opening_drops_the_quads_and_the_vertices_only_they_had),
        cmocka_unit_test(a_bump_grows_from_the_quad_along_its_direction),
        cmocka_unit_test(bent_quads_are_split_and_flat_pairs_joined_alike_on_both_halves),
        cmocka_unit_test(a_bent_quad_is_split_along_its_shorter_diagonal),
        cmocka_unit_test(tiling_anew_keeps_vertices_orientation_and_area),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
