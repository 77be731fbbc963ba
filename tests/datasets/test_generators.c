/* Every generated mesh: nothing to repair, known topology, outward, uncrossed, the same bytes for the same seed. */
#include "crossing.h"
#include "generators.h"
#include "mesh/topology.h"
#include "mesh/triangulate.h"
#include "support/test_support.h"

#include <stdlib.h>
#include <string.h>

/* What a generator must make at scale 1. */
typedef struct known {
    const char *name;
    int32_t genus;
    bool mirrored; /* x -> -x maps vertices to vertices, to the bit */
    bool seeded;
} known;

static const known shapes[] = {
    {"hand", 0, false, false},   {"body", 0, true, false},   {"spiky", 0, false, true},
    {"sphere", 0, false, false}, {"torus", 1, false, false}, {"box", 0, false, false},
};

static sl_generated *make(const char *name, uint64_t seed, int32_t scale)
{
    sl_generated *mesh = NULL;
    const sl_generator *generator = sl_generator_find(name);
    assert_non_null(generator);
    assert_int_equal(generator->make(seed, scale, &mesh), SL_OK);
    return mesh;
}

static bool same(const sl_generated *a, const sl_generated *b)
{
    return a->nv == b->nv && a->nf == b->nf && memcmp(a->xyz, b->xyz, 3 * (size_t)a->nv * sizeof *a->xyz) == 0 &&
           memcmp(a->face_first, b->face_first, ((size_t)a->nf + 1) * sizeof *a->face_first) == 0 &&
           memcmp(a->index, b->index, (size_t)a->face_first[a->nf] * sizeof *a->index) == 0;
}

static void the_table_lists_every_shape_known_here(void **state)
{
    (void)state;
    int32_t count = 0;
    const sl_generator *table = sl_generators(&count);
    for (int32_t k = 0; k < count; k++) {
        assert_ptr_equal(sl_generator_find(table[k].name), &table[k]); /* no name twice */
        assert_true(strlen(table[k].what) > 10);
    }
    for (size_t k = 0; k < SL_COUNTOF(shapes); k++) {
        assert_non_null(sl_generator_find(shapes[k].name));
    }
    assert_null(sl_generator_find("handle"));
}

/* Vertices, edges and facets counted on the input alone: the builder is not asked. */
static int32_t euler_of(const sl_generated *mesh)
{
    const int64_t corners = mesh->face_first[mesh->nf];
    assert_int_equal(corners % 2, 0);
    return (int32_t)(mesh->nv - corners / 2 + mesh->nf);
}

static void check_build(const known *shape, const sl_generated *mesh)
{
    sl_polygons polygons;
    sl_mesh *built = NULL;
    sl_repair_report report;
    sl_generated_polygons(mesh, &polygons);
    assert_int_equal(sl_mesh_build(&polygons, &built, &report, NULL), SL_OK);
    assert_int_equal(report.components, 1);
    assert_int_equal(report.border_loops, 0);
    assert_int_equal(report.genus, shape->genus);
    assert_int_equal(report.unused_vertices, 0);
    assert_int_equal(report.isolated_faces, 0);
    assert_int_equal(report.nonmanifold_edges, 0);
    assert_int_equal(report.bowtie_vertices, 0);
    assert_int_equal(report.reversed_faces, 0);
    assert_int_equal(report.one_sided_components, 0);
    sl_repair_report_clear(&report);
    sl_mesh_free(built);
}

static void every_shape_is_one_closed_manifold_of_its_genus(void **state)
{
    (void)state;
    for (size_t k = 0; k < SL_COUNTOF(shapes); k++) {
        for (int32_t scale = 1; scale <= 2; scale++) {
            sl_generated *mesh = make(shapes[k].name, 1, scale);
            assert_int_equal(euler_of(mesh), 2 - 2 * shapes[k].genus);
            check_build(&shapes[k], mesh);
            sl_generated_free(mesh);
        }
    }
}

static void seeded_shapes_are_sound_for_any_seed(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x591c7);
    for (size_t k = 0; k < SL_COUNTOF(shapes); k++) {
        for (int trial = 0; shapes[k].seeded && trial < 12 * test_multiplier(); trial++) {
            sl_generated *mesh = make(shapes[k].name, test_bits(&rng), 1);
            check_build(&shapes[k], mesh);
            sl_generated_free(mesh);
        }
    }
}

static void usual_size_is_some_thousands_and_each_scale_four_times_that(void **state)
{
    (void)state;
    for (size_t k = 0; k < SL_COUNTOF(shapes); k++) {
        sl_generated *one = make(shapes[k].name, 3, 1), *two = make(shapes[k].name, 3, 2);
        assert_in_range(one->nf, 2000, 6500);
        assert_true(test_near((double)two->nf / one->nf, 4.0, 0.1));
        sl_generated_free(one);
        sl_generated_free(two);
    }
}

static void a_seed_gives_the_same_bytes_again_and_another_seed_others(void **state)
{
    (void)state;
    for (size_t k = 0; k < SL_COUNTOF(shapes); k++) {
        sl_generated *a = make(shapes[k].name, 77, 1), *again = make(shapes[k].name, 77, 1);
        sl_generated *other = make(shapes[k].name, 78, 1);
        assert_true(same(a, again));
        assert_int_equal(same(a, other), !shapes[k].seeded);
        sl_generated_free(a);
        sl_generated_free(again);
        sl_generated_free(other);
    }
}

static double signed_volume(const sl_mesh *m, const sl_triangulation *t)
{
    double sum = 0.0;
    for (int32_t i = 0; i < t->nt; i++) {
        const double *a = m->xyz + 3 * (int64_t)m->origin[t->corner[3 * i]];
        const double *b = m->xyz + 3 * (int64_t)m->origin[t->corner[3 * i + 1]];
        const double *c = m->xyz + 3 * (int64_t)m->origin[t->corner[3 * i + 2]];
        sum += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
               a[2] * (b[0] * c[1] - b[1] * c[0]);
    }
    return sum / 6.0;
}

static void shapes_face_outward_and_do_not_cross_themselves(void **state)
{
    (void)state;
    for (size_t k = 0; k < SL_COUNTOF(shapes); k++) {
        for (uint64_t seed = 1; seed <= (shapes[k].seeded ? 4u : 1u); seed++) {
            sl_generated *mesh = make(shapes[k].name, seed, 1);
            sl_polygons polygons;
            sl_mesh *built = NULL;
            sl_triangulation *triangulation = NULL;
            sl_generated_polygons(mesh, &polygons);
            assert_int_equal(sl_mesh_build(&polygons, &built, NULL, NULL), SL_OK);
            assert_int_equal(sl_triangulation_create(built, &triangulation), SL_OK);
            assert_true(signed_volume(built, triangulation) > 1e-3);
            assert_int_equal(test_count_crossings(built, triangulation), 0);
            sl_triangulation_free(triangulation);
            sl_mesh_free(built);
            sl_generated_free(mesh);
        }
    }
}

static int compare_points(const void *a, const void *b)
{
    const double *x = a, *y = b;
    for (int k = 0; k < 3; k++) {
        if (x[k] != y[k]) {
            return x[k] < y[k] ? -1 : 1;
        }
    }
    return 0;
}

static void mirrored_shapes_hold_the_image_of_each_vertex_exactly(void **state)
{
    (void)state;
    for (size_t k = 0; k < SL_COUNTOF(shapes); k++) {
        sl_generated *mesh = shapes[k].mirrored ? make(shapes[k].name, 1, 2) : NULL;
        int32_t in_plane = 0;
        if (mesh == NULL) {
            continue;
        }
        qsort(mesh->xyz, (size_t)mesh->nv, 3 * sizeof *mesh->xyz, compare_points);
        for (int32_t v = 0; v < mesh->nv; v++) {
            const double *p = mesh->xyz + 3 * (int64_t)v;
            const double image[3] = {0.0 - p[0], p[1], p[2]};
            assert_non_null(bsearch(image, mesh->xyz, (size_t)mesh->nv, 3 * sizeof *mesh->xyz, compare_points));
            in_plane += p[0] == 0.0;
        }
        assert_true(in_plane > 50 && in_plane < mesh->nv / 10);
        sl_generated_free(mesh);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_table_lists_every_shape_known_here),
        cmocka_unit_test(every_shape_is_one_closed_manifold_of_its_genus),
        cmocka_unit_test(seeded_shapes_are_sound_for_any_seed),
        cmocka_unit_test(usual_size_is_some_thousands_and_each_scale_four_times_that),
        cmocka_unit_test(a_seed_gives_the_same_bytes_again_and_another_seed_others),
        cmocka_unit_test(shapes_face_outward_and_do_not_cross_themselves),
        cmocka_unit_test(mirrored_shapes_hold_the_image_of_each_vertex_exactly),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
