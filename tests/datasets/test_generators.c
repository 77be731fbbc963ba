/* Every generated mesh: nothing to repair, the topology its author declared, outward, uncrossed, the same bytes for the
 * same seed, four times the facets for each step of scale. */
#include "crossing.h"
#include "generators.h"
#include "mesh/topology.h"
#include "mesh/triangulate.h"
#include "support/test_support.h"

#include "base/memory.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

/* Those with something random in them. */
static const char *const seeded[] = {"spiky", "tree", "rock", "bust", "body-uneven", "body-remeshed"};

/* Those made of so few facets on purpose: the named boxes of 8 x 8 x 8, 8 x 8 x 4 and 4 x 4 x 12, the low-polygon
 * figure. */
static const char *const small[] = {"cube", "slab", "beam", "character"};

static bool among(const char *name, const char *const *list, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        if (strcmp(list[k], name) == 0) {
            return true;
        }
    }
    return false;
}

static bool is_seeded(const sl_generator *g)
{
    return among(g->name, seeded, SL_COUNTOF(seeded));
}

static sl_generated *make(const sl_generator *g, uint64_t seed, int32_t scale)
{
    sl_generated *mesh = NULL;
    const sl_status status = g->make(seed, scale, &mesh);
    if (status != SL_OK) {
        print_message("%s: %s\n", g->name, sl_status_name(status));
    }
    assert_int_equal(status, SL_OK);
    return mesh;
}

static bool same(const sl_generated *a, const sl_generated *b)
{
    return a->nv == b->nv && a->nf == b->nf && memcmp(a->xyz, b->xyz, 3 * (size_t)a->nv * sizeof *a->xyz) == 0 &&
           memcmp(a->face_first, b->face_first, ((size_t)a->nf + 1) * sizeof *a->face_first) == 0 &&
           memcmp(a->index, b->index, (size_t)a->face_first[a->nf] * sizeof *a->index) == 0;
}

static void the_table_lists_each_model_once_by_a_plain_name(void **state)
{
    (void)state;
    int32_t count = 0;
    const sl_generator *table = sl_generators(&count);
    assert_in_range(count, 36, 60);
    for (int32_t k = 0; k < count; k++) {
        assert_ptr_equal(sl_generator_find(table[k].name), &table[k]); /* no name twice */
        assert_in_range(strlen(table[k].what), 15, 110);
        assert_null(strpbrk(table[k].what, "\"\\\n")); /* goes into JSON as it is */
        for (const char *p = table[k].name; *p != '\0'; p++) {
            assert_true(islower((unsigned char)*p) || *p == '-');
        }
    }
    assert_null(sl_generator_find("handle"));
    for (size_t k = 0; k < SL_COUNTOF(seeded); k++) {
        assert_non_null(sl_generator_find(seeded[k]));
    }
}

static int compare_pairs(const void *a, const void *b)
{
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return x < y ? -1 : x > y;
}

/* V - E + F with each edge counted once, on the input alone: the builder is not asked. */
static int32_t euler_of(const sl_generated *mesh)
{
    const int64_t corners = mesh->face_first[mesh->nf];
    uint64_t *edge = sl_alloc(corners, sizeof *edge);
    int32_t edges = 0;
    assert_non_null(edge);
    for (int32_t f = 0; f < mesh->nf; f++) {
        for (int32_t c = mesh->face_first[f]; c < mesh->face_first[f + 1]; c++) {
            const int32_t next = c + 1 < mesh->face_first[f + 1] ? c + 1 : mesh->face_first[f];
            const uint64_t a = (uint64_t)mesh->index[c], b = (uint64_t)mesh->index[next];
            edge[c] = a < b ? a << 32 | b : b << 32 | a;
        }
    }
    qsort(edge, (size_t)corners, sizeof *edge, compare_pairs);
    for (int64_t c = 0; c < corners; c++) {
        edges += c == 0 || edge[c] != edge[c - 1];
    }
    sl_free(edge);
    return mesh->nv - edges + mesh->nf;
}

static void check_build(const sl_generator *g, const sl_generated *mesh)
{
    sl_polygons polygons;
    sl_mesh *built = NULL;
    sl_repair_report report;
    sl_generated_polygons(mesh, &polygons);
    assert_int_equal(sl_mesh_build(&polygons, &built, &report, NULL), SL_OK);
    const int32_t faults = report.unused_vertices + report.isolated_faces + report.nonmanifold_edges +
                           report.bowtie_vertices + report.reversed_faces + report.one_sided_components;
    if (report.components != g->components || report.border_loops != g->borders || report.genus != g->genus ||
        faults != 0) {
        print_message("%s: %d faults, genus %d\n", g->name, faults, (int)report.genus);
    }
    assert_int_equal(faults, 0);
    assert_int_equal(report.components, g->components);
    assert_int_equal(report.border_loops, g->borders);
    assert_int_equal(report.genus, g->genus);
    assert_int_equal(euler_of(mesh), 2 * g->components - 2 * g->genus - g->borders);
    sl_repair_report_clear(&report);
    sl_mesh_free(built);
}

static void every_model_is_the_manifold_its_author_declared(void **state)
{
    (void)state;
    int32_t count = 0;
    const sl_generator *table = sl_generators(&count);
    for (int32_t k = 0; k < count; k++) {
        for (int32_t scale = 1; scale <= 2; scale++) {
            sl_generated *mesh = make(&table[k], 1, scale);
            check_build(&table[k], mesh);
            sl_generated_free(mesh);
        }
    }
}

static void seeded_models_are_sound_for_any_seed(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x591c7);
    for (size_t k = 0; k < SL_COUNTOF(seeded); k++) {
        const sl_generator *g = sl_generator_find(seeded[k]);
        for (int trial = 0; trial < 8 * test_multiplier(); trial++) {
            sl_generated *mesh = make(g, test_bits(&rng), 1);
            check_build(g, mesh);
            sl_generated_free(mesh);
        }
    }
}

static void usual_size_is_some_thousands_and_each_scale_four_times_that(void **state)
{
    (void)state;
    int32_t count = 0;
    const sl_generator *table = sl_generators(&count);
    for (int32_t k = 0; k < count; k++) {
        sl_generated *one = make(&table[k], 3, 1), *two = make(&table[k], 3, 2);
        if (!among(table[k].name, small, SL_COUNTOF(small))) {
            assert_in_range(one->nf, 1000, 10000);
        }
        if (!test_near((double)two->nf / one->nf, 4.0, 0.25)) {
            print_message("%s: %d, then %d facets\n", table[k].name, one->nf, two->nf);
            fail();
        }
        sl_generated_free(one);
        sl_generated_free(two);
    }
}

static void a_seed_gives_the_same_bytes_again_and_another_seed_others(void **state)
{
    (void)state;
    int32_t count = 0;
    const sl_generator *table = sl_generators(&count);
    for (int32_t k = 0; k < count; k++) {
        sl_generated *a = make(&table[k], 77, 1), *again = make(&table[k], 77, 1);
        sl_generated *other = make(&table[k], 78, 1);
        assert_true(same(a, again));
        assert_int_equal(same(a, other), !is_seeded(&table[k]));
        sl_generated_free(a);
        sl_generated_free(again);
        sl_generated_free(other);
    }
}

/* Six times the signed volume of each component; closed components turned outward have it positive. */
static void check_outward(const sl_generator *g, const sl_mesh *m, const sl_triangulation *t)
{
    double *volume = sl_calloc(g->components, sizeof *volume);
    int32_t *label = sl_alloc(m->nf, sizeof *label), components = 0;
    assert_non_null(volume);
    assert_non_null(label);
    assert_int_equal(sl_mesh_components(m, label, &components), SL_OK);
    assert_int_equal(components, g->components);
    for (int32_t i = 0; i < t->nt; i++) {
        const double *a = m->xyz + 3 * (int64_t)m->origin[t->corner[3 * i]];
        const double *b = m->xyz + 3 * (int64_t)m->origin[t->corner[3 * i + 1]];
        const double *c = m->xyz + 3 * (int64_t)m->origin[t->corner[3 * i + 2]];
        volume[label[m->face[t->corner[3 * i]]]] += a[0] * (b[1] * c[2] - b[2] * c[1]) +
                                                    a[1] * (b[2] * c[0] - b[0] * c[2]) +
                                                    a[2] * (b[0] * c[1] - b[1] * c[0]);
    }
    for (int32_t k = 0; k < components; k++) {
        if (volume[k] < 1e-4) {
            print_message("%s: component %d has the volume %g\n", g->name, k, volume[k] / 6.0);
        }
        assert_true(volume[k] > 1e-4);
    }
    sl_free(volume);
    sl_free(label);
}

static void models_face_outward_and_do_not_cross_themselves(void **state)
{
    (void)state;
    int32_t count = 0;
    const sl_generator *table = sl_generators(&count);
    for (int32_t k = 0; k < count; k++) {
        for (uint64_t seed = 1; seed <= (is_seeded(&table[k]) ? 4u : 1u); seed++) {
            sl_generated *mesh = make(&table[k], seed, 1);
            sl_polygons polygons;
            sl_mesh *built = NULL;
            sl_triangulation *triangulation = NULL;
            sl_generated_polygons(mesh, &polygons);
            assert_int_equal(sl_mesh_build(&polygons, &built, NULL, NULL), SL_OK);
            assert_int_equal(sl_triangulation_create(built, &triangulation), SL_OK);
            if (table[k].borders == 0) {
                check_outward(&table[k], built, triangulation);
            }
            const int64_t crossings = test_count_crossings(built, triangulation);
            if (crossings != 0) {
                print_message("%s, seed %d: %d crossings\n", table[k].name, (int)seed, (int)crossings);
            }
            assert_int_equal(crossings, 0);
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

/* Where one half was modelled and joined to its image, the other holds the same bits but for the sign. */
static void a_modelled_half_and_its_image_agree_to_the_bit(void **state)
{
    static const char *const halves[] = {"body", "quadruped", "octopus", "crab", "fish", "bird", "airplane", "fork"};
    (void)state;
    for (size_t k = 0; k < SL_COUNTOF(halves); k++) {
        sl_generated *mesh = make(sl_generator_find(halves[k]), 1, 2);
        int32_t in_plane = 0;
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
        cmocka_unit_test(the_table_lists_each_model_once_by_a_plain_name),
        cmocka_unit_test(every_model_is_the_manifold_its_author_declared),
        cmocka_unit_test(seeded_models_are_sound_for_any_seed),
        cmocka_unit_test(usual_size_is_some_thousands_and_each_scale_four_times_that),
        cmocka_unit_test(a_seed_gives_the_same_bytes_again_and_another_seed_others),
        cmocka_unit_test(models_face_outward_and_do_not_cross_themselves),
        cmocka_unit_test(a_modelled_half_and_its_image_agree_to_the_bit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
