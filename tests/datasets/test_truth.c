/* What is planted, checked by its own definition: maps against edges, facets and positions; the size of the group
 * against a count of all automorphisms; controls; the JSON against the mesh in memory. */
#include "automorphisms.h"
#include "truth.h"

#include "base/memory.h"
#include "support/test_support.h"

#include <jansson.h>
#include <math.h>
#include <string.h>

static sl_generated *make(const sl_generator *g, uint64_t seed, int32_t scale)
{
    sl_generated *mesh = NULL;
    assert_non_null(g);
    assert_int_equal(g->make(seed, scale, &mesh), SL_OK);
    return mesh;
}

static bool is_permutation(const int32_t *map, int32_t n)
{
    uint8_t *met = sl_calloc(n, 1);
    bool right = met != NULL;
    for (int32_t i = 0; i < n && right; i++) {
        right = map[i] >= 0 && map[i] < n && met[map[i]] == 0;
        if (right) {
            met[map[i]] = 1;
        }
    }
    sl_free(met);
    return right;
}

/* The corners of f, sent by the map, are those of its image, in the same cyclic order or (turned) against it. */
static bool sends_facet(const sl_generated *m, const sl_planted *p, int32_t f, bool turned)
{
    const int32_t a = m->face_first[f], g = p->face[f], b = m->face_first[g], n = m->face_first[f + 1] - a;
    int32_t at = -1;
    for (int32_t k = 0; k < n && n == m->face_first[g + 1] - b; k++) {
        at = m->index[b + k] == p->vertex[m->index[a]] ? k : at;
    }
    for (int32_t k = 0; k < n && at >= 0; k++) {
        const int32_t i = turned ? (at - k + n) % n : (at + k) % n;
        at = m->index[b + i] == p->vertex[m->index[a + k]] ? at : -1;
    }
    return at >= 0;
}

static double extent_of(const sl_generated *m)
{
    double lo[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, hi[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (int64_t i = 0; i < 3 * (int64_t)m->nv; i++) {
        lo[i % 3] = fmin(lo[i % 3], m->xyz[i]);
        hi[i % 3] = fmax(hi[i % 3], m->xyz[i]);
    }
    return fmax(hi[0] - lo[0], fmax(hi[1] - lo[1], hi[2] - lo[2]));
}

/* Largest distance of a moved vertex to its image, over the extent. */
static double misfit(const sl_generated *m, const sl_planted *p)
{
    double worst = 0.0;
    for (int64_t v = 0; v < m->nv; v++) {
        const double *x = m->xyz + 3 * v, *y = m->xyz + 3 * (int64_t)p->vertex[v];
        double d = 0.0;
        for (int k = 0; k < 3; k++) {
            const double *row = p->matrix + 4 * k;
            const double moved = row[0] * x[0] + row[1] * x[1] + row[2] * x[2] + row[3];
            d += (moved - y[k]) * (moved - y[k]);
        }
        worst = fmax(worst, sqrt(d));
    }
    return worst / extent_of(m);
}

static double determinant(const double m[12])
{
    return m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) +
           m[2] * (m[4] * m[9] - m[5] * m[8]);
}

static void check_planted(const char *name, const sl_generated *m, const sl_planted *p)
{
    const double turn = determinant(p->matrix), away = misfit(m, p);
    bool moved = false, involution = true;
    assert_true(is_permutation(p->vertex, m->nv));
    assert_true(is_permutation(p->face, m->nf));
    for (int32_t f = 0; f < m->nf; f++) {
        assert_true(sends_facet(m, p, f, turn < 0.0));
        involution &= p->face[p->face[f]] == f;
        moved |= p->face[f] != f;
    }
    assert_true(moved);
    assert_true(test_near(fabs(turn), 1.0, 1e-12));
    if (p->exact ? away > 1e-9 : away < 1e-6 || away > 0.03) {
        print_message("%s, %s: misfit %g\n", name, p->name, away);
        fail();
    }
    if (p->mirror) {
        assert_true(turn < 0.0 && involution);
    }
}

static void planted_maps_are_automorphisms_and_exact_ones_fit_the_positions(void **state)
{
    (void)state;
    int32_t count = 0, mirrors = 0, inexact = 0, turns = 0;
    const sl_generator *table = sl_generators(&count);
    for (int32_t k = 0; k < count; k++) {
        for (int32_t scale = 1; scale <= 2; scale++) {
            sl_generated *m = make(&table[k], 5, scale);
            for (int32_t i = 0; i < m->nplanted; i++) {
                check_planted(table[k].name, m, &m->planted[i]);
                mirrors += m->planted[i].mirror;
                turns += !m->planted[i].mirror;
                inexact += !m->planted[i].exact;
                for (int32_t j = 0; j < i; j++) { /* no map twice */
                    assert_memory_not_equal(m->planted[i].face, m->planted[j].face, (size_t)m->nf * sizeof(int32_t));
                }
            }
            sl_generated_free(m);
        }
    }
    assert_true(mirrors > 100 && turns > 20 && inexact >= 2);
}

/* Models whose group is known from what they are: how many automorphisms keep the orientation, how many reverse it. */
typedef struct known_group {
    const char *name;
    int32_t keeping, reversing;
} known_group;

/* Some connectivities have more than the shape: the boat's bow for stern and inside for outside, the propeller's
 * mirrors, which its twist breaks, all turns of the bolt and the spring's wire. */
static const known_group groups[] = {
    {"tree", 1, 0},        {"rock", 1, 0},    {"bust", 1, 0},        {"body-remeshed", 1, 0}, {"body", 1, 1},
    {"body-uneven", 1, 1}, {"leaning", 1, 1}, {"mug", 1, 1},         {"boat", 4, 4},          {"propeller", 3, 3},
    {"bolt", 72, 72},      {"gear", 32, 32},  {"snowflake", 12, 12}, {"icosphere", 60, 60},   {"football", 60, 60},
    {"cube", 24, 24},      {"frame", 24, 24}, {"slab", 8, 8},        {"beam", 8, 8},          {"double-torus", 4, 4},
    {"pretzel", 2, 2},     {"plate", 8, 8},   {"bracket", 2, 2},     {"spring", 32, 32},
};

static void the_connectivity_has_as_many_automorphisms_as_the_shape(void **state)
{
    (void)state;
    int32_t wrong = 0;
    for (size_t k = 0; k < SL_COUNTOF(groups); k++) {
        sl_generated *m = make(sl_generator_find(groups[k].name), 1, 1);
        sl_polygons polygons;
        sl_mesh *mesh = NULL;
        int32_t keeping = 0, reversing = 0;
        sl_generated_polygons(m, &polygons);
        assert_int_equal(sl_mesh_build(&polygons, &mesh, NULL, NULL), SL_OK);
        test_count_automorphisms(mesh, 200, &keeping, &reversing);
        if (keeping != groups[k].keeping || reversing != groups[k].reversing) {
            print_message("%s: %d and %d automorphisms\n", groups[k].name, keeping, reversing);
            wrong++;
        }
        sl_mesh_free(mesh);
        sl_generated_free(m);
    }
    assert_int_equal(wrong, 0);
}

/* Of the surface only: no map of facets. */
static void controls_have_nothing_planted(void **state)
{
    static const char *const controls[] = {"tree",          "rock",  "bust", "leaning",
                                           "body-remeshed", "spiky", "hand", "snake"};
    (void)state;
    for (size_t k = 0; k < SL_COUNTOF(controls); k++) {
        sl_generated *m = make(sl_generator_find(controls[k]), 1, 1);
        assert_int_equal(m->nplanted, 0);
        assert_int_equal(m->nnear, strcmp(controls[k], "body-remeshed") == 0 || strcmp(controls[k], "bust") == 0);
        sl_generated_free(m);
    }
}

/* Largest distance of a mirrored vertex to the nearest vertex, over the extent: the surface is about there. */
static double distance_of_image(const sl_generated *m, const double matrix[12])
{
    double worst = 0.0;
    for (int64_t v = 0; v < m->nv; v += 7) {
        double nearest = HUGE_VAL;
        for (int64_t w = 0; w < m->nv; w++) {
            double d = 0.0;
            for (int k = 0; k < 3; k++) {
                const double *row = matrix + 4 * k, *x = m->xyz + 3 * v;
                const double moved = row[0] * x[0] + row[1] * x[1] + row[2] * x[2] + row[3] - m->xyz[3 * w + k];
                d += moved * moved;
            }
            nearest = fmin(nearest, d);
        }
        worst = fmax(worst, sqrt(nearest));
    }
    return worst / extent_of(m);
}

static void what_is_near_is_near(void **state)
{
    static const char *const name[] = {"body-remeshed", "bust"};
    (void)state;
    for (size_t k = 0; k < SL_COUNTOF(name); k++) {
        for (uint64_t seed = 1; seed <= 3; seed++) {
            sl_generated *m = make(sl_generator_find(name[k]), seed, 1);
            const double away = distance_of_image(m, m->near[0].matrix);
            assert_true(k == 0 ? away < 1e-12 : away > 1e-6 && away < 0.01);
            sl_generated_free(m);
        }
    }
}

/* A mirror's plane cuts through the middles of facets here, along edges there. */
static void some_mirrors_run_through_facets_and_some_along_edges(void **state)
{
    static const char *const name[] = {"boat", "body", "mug", "fork"};
    (void)state;
    for (size_t k = 0; k < SL_COUNTOF(name); k++) {
        sl_generated *m = make(sl_generator_find(name[k]), 1, 1);
        int32_t fixed = 0;
        for (int32_t f = 0; f < m->nf; f++) {
            fixed += m->planted[0].face[f] == f;
        }
        assert_true(k == 0 ? fixed > 100 : fixed == 0);
        sl_generated_free(m);
    }
}

/* The wheels and the links are one mesh, moved: the same distances from a vertex of each to all its others. */
static void copies_are_equal_vertex_by_vertex(void **state)
{
    static const char *const name[] = {"wagon", "chain"};
    static const int32_t copies[] = {4, 5};
    (void)state;
    for (size_t k = 0; k < SL_COUNTOF(name); k++) {
        sl_generated *m = make(sl_generator_find(name[k]), 1, 1);
        /* the copies come last, one after another; a wheel has 24 x 9 vertices */
        const int64_t size = k == 0 ? 216 : m->nv / copies[k], last = m->nv - size;
        for (int32_t c = 1; c < copies[k]; c++) {
            const int64_t other = last - c * size;
            for (int64_t v = 1; v < size; v++) {
                double d[2] = {0.0, 0.0};
                for (int i = 0; i < 3; i++) {
                    d[0] += pow(m->xyz[3 * (last + v) + i] - m->xyz[3 * last + i], 2.0);
                    d[1] += pow(m->xyz[3 * (other + v) + i] - m->xyz[3 * other + i], 2.0);
                }
                assert_true(test_near(sqrt(d[0]), sqrt(d[1]), 64 * TEST_EPS * extent_of(m)));
            }
        }
        sl_generated_free(m);
    }
}

static void same_integers(const json_t *list, const int32_t *value, int32_t count)
{
    assert_int_equal(json_array_size(list), count);
    for (int32_t i = 0; i < count; i++) {
        assert_true(json_is_integer(json_array_get(list, (size_t)i)));
        assert_int_equal(json_integer_value(json_array_get(list, (size_t)i)), value[i]);
    }
}

static void same_matrix(const json_t *rows, const double matrix[12])
{
    assert_int_equal(json_array_size(rows), 3);
    for (size_t k = 0; k < 12; k++) {
        const double read = json_number_value(json_array_get(json_array_get(rows, k / 4), k % 4));
        assert_memory_equal(&read, &matrix[k], sizeof read); /* to the bit */
    }
}

static int32_t integer_of(const json_t *j, const char *name)
{
    assert_true(json_is_integer(json_object_get(j, name)));
    return (int32_t)json_integer_value(json_object_get(j, name));
}

static void compare_symmetry(const json_t *j, const sl_generated *m, const sl_planted *p)
{
    const json_t *fixed = json_object_get(j, "fixed_facets");
    int32_t seen = 0;
    assert_string_equal(json_string_value(json_object_get(j, "name")), p->name);
    assert_int_equal(json_is_true(json_object_get(j, "mirror")), p->mirror);
    assert_int_equal(json_is_true(json_object_get(j, "exact")), p->exact);
    same_matrix(json_object_get(j, "matrix"), p->matrix);
    same_integers(json_object_get(j, "facet"), p->face, m->nf);
    same_integers(json_object_get(j, "vertex"), p->vertex, m->nv);
    for (int32_t f = 0; f < m->nf; f++) {
        if (p->face[f] == f) {
            assert_int_equal(json_integer_value(json_array_get(fixed, (size_t)seen)), f);
            seen++;
        }
    }
    assert_int_equal(json_array_size(fixed), seen);
}

static void the_json_beside_a_model_holds_the_same_maps(void **state)
{
    static const char *const name[] = {"boat", "frame", "body-remeshed", "pullover", "chain", "body-uneven", "gear"};
    const uint64_t seed = UINT64_MAX - 12; /* does not fit a JSON integer of 64 bits with a sign */
    (void)state;
    for (size_t k = 0; k < SL_COUNTOF(name); k++) {
        const sl_generator *g = sl_generator_find(name[k]);
        sl_generated *m = make(g, seed, 1);
        sl_repair_report report;
        assert_int_equal(gen_truth_check(g, m, &report, NULL), SL_OK);
        const char *path = test_scratch("truth.json");
        assert_int_equal(gen_truth_write(path, g, m, &report, seed, 1, NULL), SL_OK);
        json_error_t error;
        json_t *j = json_load_file(path, JSON_REJECT_DUPLICATES, &error);
        assert_non_null(j);
        assert_int_equal(integer_of(j, "schema"), GEN_TRUTH_SCHEMA);
        assert_string_equal(json_string_value(json_object_get(j, "name")), name[k]);
        assert_string_equal(json_string_value(json_object_get(j, "what")), g->what);
        assert_string_equal(json_string_value(json_object_get(j, "seed")), "18446744073709551603");
        assert_int_equal(integer_of(j, "scale"), 1);
        assert_int_equal(integer_of(j, "vertices"), m->nv);
        assert_int_equal(integer_of(j, "facets"), m->nf);
        assert_int_equal(integer_of(j, "triangles") + integer_of(j, "quads") + integer_of(j, "ngons"), m->nf);
        assert_int_equal(integer_of(j, "genus"), g->genus);
        assert_int_equal(integer_of(j, "components"), g->components);
        assert_int_equal(integer_of(j, "borders"), g->borders);
        assert_int_equal(json_is_true(json_object_get(j, "more_mirrors")), m->more_mirrors);
        const json_t *list = json_object_get(j, "symmetries"), *near = json_object_get(j, "near");
        assert_int_equal(json_array_size(list), m->nplanted);
        for (int32_t i = 0; i < m->nplanted; i++) {
            compare_symmetry(json_array_get(list, (size_t)i), m, &m->planted[i]);
        }
        assert_int_equal(json_array_size(near), m->nnear);
        for (int32_t i = 0; i < m->nnear; i++) {
            same_matrix(json_object_get(json_array_get(near, (size_t)i), "matrix"), m->near[i].matrix);
        }
        json_decref(j);
        sl_repair_report_clear(&report);
        sl_generated_free(m);
    }
}

static void a_model_that_is_not_what_its_author_says_is_refused(void **state)
{
    (void)state;
    const sl_generator *g = sl_generator_find("mug");
    sl_generated *m = make(g, 1, 1);
    for (int k = 0; k < 3; k++) {
        sl_generator other = *g;
        sl_diag diag = sl_diag_none();
        other.genus += k == 0;
        other.components += k == 1;
        other.borders += k == 2;
        assert_int_equal(gen_truth_check(&other, m, NULL, &diag), SL_CHECK_FAILED);
        assert_non_null(strstr(diag.reason, "mug"));
    }
    m->index[1] = m->index[0]; /* a facet with one corner twice */
    assert_int_equal(gen_truth_check(g, m, NULL, NULL), SL_CHECK_FAILED);
    sl_generated_free(m);
}

static void truth_for_a_folder_that_is_not_there_is_an_error_of_io(void **state)
{
    (void)state;
    const sl_generator *g = sl_generator_find("cube");
    sl_generated *m = make(g, 1, 1);
    sl_repair_report report;
    assert_int_equal(gen_truth_check(g, m, &report, NULL), SL_OK);
    assert_int_equal(gen_truth_write("/nowhere/at/all/cube.json", g, m, &report, 1, 1, NULL), SL_IO);
    sl_repair_report_clear(&report);
    sl_generated_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(planted_maps_are_automorphisms_and_exact_ones_fit_the_positions),
        cmocka_unit_test(the_connectivity_has_as_many_automorphisms_as_the_shape),
        cmocka_unit_test(controls_have_nothing_planted),
        cmocka_unit_test(what_is_near_is_near),
        cmocka_unit_test(some_mirrors_run_through_facets_and_some_along_edges),
        cmocka_unit_test(copies_are_equal_vertex_by_vertex),
        cmocka_unit_test(the_json_beside_a_model_holds_the_same_maps),
        cmocka_unit_test(a_model_that_is_not_what_its_author_says_is_refused),
        cmocka_unit_test(truth_for_a_folder_that_is_not_there_is_an_error_of_io),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
