#include "checks.h"

static void copies_moved_turned_and_mirrored_are_found(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xc09);
    for (int trial = 0; trial < 10 * test_multiplier(); trial++) {
        int32_t mirror[1000], begin[6];
        double T[12];
        model m = model_new();
        model_planted(&m, &rng, 4, 5, false, false, mirror);
        model_perturb(&m, &rng, 0.2); /* no mirror left: a mirrored copy is one of its own */
        const int32_t nf = m.nf, nv = m.nv;
        for (int k = 1; k <= 4; k++) {
            begin[k] = m.nf;
            model_random_isometry(&rng, k == 2, T);
            if (k == 4) {
                for (int i = 0; i < 3; i++) {
                    T[i] *= 1.001; /* no isometry */
                }
            }
            for (int i = 0; i < 3 && k == 3; i++) {
                T[i] *= trial % 2 == 0 ? 1.0 + 4e-7 : 1.0 - 4e-7; /* nearly one */
            }
            model_repeat(&m, nf, nv, T, k == 2);
        }
        int32_t *facet = sl_alloc(m.nf, sizeof *facet), component[5];
        model_relabel(&m, &rng, 1, facet, NULL);
        sl_mesh *mesh = model_build(&m);
        sl_symmetry *s = find_all(mesh, NULL, 64);
        assert_int_equal(s->components, 5);
        for (int k = 0; k < 5; k++) {
            component[k] = s->component[facet[k == 0 ? 0 : begin[k]]];
        }
        int32_t lowest = component[0], copies = 0;
        for (int k = 1; k < 4; k++) {
            lowest = component[k] < lowest ? component[k] : lowest;
        }
        for (int k = 0; k < 4; k++) {
            assert_int_equal(s->original[component[k]], lowest);
        }
        assert_int_equal(s->original[component[4]], component[4]);
        for (int32_t i = 0; i < s->nmap; i++) {
            const sl_symmetry_map *map = &s->map[i];
            check_map(mesh, s, map);
            if (map->from != map->to) {
                assert_int_equal(map->from, lowest);
                assert_int_equal(map->order, 0);
                assert_int_equal(map->kind, SL_SYMMETRY_EXACT);
                assert_int_equal(map->reverses, (map->to == component[2]) != (lowest == component[2]));
                assert_true(map->deviation < (map->to == component[3] || lowest == component[3] ? 1e-6 : 1e-12));
                copies++;
            } else {
                assert_int_equal(copies, 0); /* copies stand last */
                assert_true(map->from == lowest || map->from == component[4]);
            }
        }
        assert_int_equal(copies, 3);
        sl_free(facet);
        sl_symmetry_free(s);
        sl_mesh_free(mesh);
        model_free(&m);
    }
}

static void automorphisms_of_copies_are_listed_when_asked_for(void **state)
{
    (void)state;
    model m = model_new();
    for (int k = 0; k < 3; k++) {
        const int32_t v = m.nv;
        model_box(&m, 2, 3, 4);
        for (int32_t i = v; i < m.nv; i++) {
            m.xyz[3 * i] += 10.0 * k;
        }
    }
    sl_mesh *mesh = model_build(&m);
    sl_symmetry_def def = sl_symmetry_default();
    for (int of_copies = 0; of_copies < 2; of_copies++) {
        sl_symmetry *s = NULL;
        def.of_copies = of_copies == 1;
        assert_int_equal(sl_symmetry_find(mesh, NULL, &def, NULL, &s), SL_OK);
        assert_int_equal(s->nmap, of_copies ? 3 * 7 + 2 : 7 + 2);
        check_all(mesh, s);
        sl_symmetry_free(s);
    }
    sl_mesh_free(mesh);
    model_free(&m);
}

static void a_budget_of_corners_leaves_four_maps_to_each(void **state)
{
    (void)state;
    model m = model_new();
    for (int k = 0; k < 3; k++) {
        const int32_t v = m.nv;
        model_box(&m, 2, 3, 4 + k);
        for (int32_t i = v; i < m.nv; i++) {
            m.xyz[3 * i] += 10.0 * k;
        }
    }
    sl_mesh *mesh = model_build(&m);
    sl_symmetry_def def = sl_symmetry_default();
    def.corners = 1;
    sl_symmetry *s = NULL;
    assert_int_equal(sl_symmetry_find(mesh, NULL, &def, NULL, &s), SL_OK);
    assert_int_equal(s->nmap, 12);
    assert_true(s->truncated);
    for (int32_t i = 0; i < 12; i++) {
        assert_int_equal(s->map[i].from, i / 4);
        assert_true(i % 4 == 3 || s->map[i].separates); /* three mirrors, a half turn */
    }
    check_all(mesh, s);
    sl_symmetry_free(s);
    sl_mesh_free(mesh);
    model_free(&m);
}

/* Octagons in one circle, sides in another order: all distances from the centre and the sum of the sides agree. */
static void equal_distances_from_the_centre_make_no_copies(void **state)
{
    (void)state;
    static const double arc[3][4] = {{0.5, 0.7, 0.9, 1.04159265358979312},
                                     {0.5, 0.9, 0.7, 1.04159265358979312},
                                     {1.04159265358979312, 0.9, 0.7, 0.5}};
    model m = model_new();
    for (int k = 0; k < 3; k++) {
        int32_t corner[8];
        double a = 0.3 * k;
        for (int i = 0; i < 8; i++) {
            corner[i] = model_vertex(&m, 3.0 * k + cos(a), sin(a), 0);
            a += arc[k][i % 4];
        }
        model_face(&m, 8, corner);
    }
    sl_mesh *mesh = model_build(&m);
    sl_symmetry *s = find_all(mesh, NULL, 64);
    assert_int_equal(s->original[0], 0);
    assert_int_equal(s->original[1], 1);
    assert_int_equal(s->original[2], 0); /* the first, backwards */
    check_all(mesh, s);
    sl_symmetry_free(s);
    sl_mesh_free(mesh);
    model_free(&m);
}

/* Thousands of components of a few facets: as many originals as there are shapes. */
static void thousands_of_small_components_are_sorted_out(void **state)
{
    (void)state;
    enum { PIECES = 4000, SHAPES = 17 };
    test_rng rng = test_rng_seed(0x10000);
    double shape[SHAPES][12];
    int32_t kind[PIECES], first_of[SHAPES];
    for (int k = 0; k < SHAPES; k++) {
        first_of[k] = -1;
        for (int i = 0; i < 12; i++) {
            shape[k][i] = test_uniform(&rng, -1.0, 1.0);
        }
    }
    model m = model_new();
    for (int32_t p = 0; p < PIECES; p++) {
        double T[12];
        kind[p] = test_index(&rng, SHAPES);
        first_of[kind[p]] = first_of[kind[p]] < 0 ? p : first_of[kind[p]];
        model_random_isometry(&rng, false, T);
        int32_t v[4];
        for (int i = 0; i < 4; i++) {
            const double *x = &shape[kind[p]][3 * i];
            double q[3];
            for (int r = 0; r < 3; r++) {
                q[r] = T[4 * r] * x[0] + T[4 * r + 1] * x[1] + T[4 * r + 2] * x[2] + T[4 * r + 3];
            }
            v[i] = model_vertex(&m, q[0] + 9.0 * (p % 50), q[1], q[2] + 9.0 * (p / 50));
        }
        model_triangle(&m, v[0], v[1], v[2]);
        model_triangle(&m, v[0], v[2], v[3]);
    }
    sl_mesh *mesh = model_build(&m);
    sl_symmetry *s = find_all(mesh, NULL, 64);
    assert_int_equal(s->components, PIECES);
    for (int32_t p = 0; p < PIECES; p++) {
        assert_int_equal(s->original[p], first_of[kind[p]]);
    }
    assert_int_equal(s->nmap, PIECES - SHAPES + 3 * SHAPES); /* two triangles have four automorphisms */
    sl_symmetry_free(s);
    sl_mesh_free(mesh);
    model_free(&m);
}

/* Thousands of quads, no two alike, though many have nearly the same length around. */
static void thousands_of_single_facets_without_copies_have_none(void **state)
{
    (void)state;
    enum { PIECES = 4000 };
    test_rng rng = test_rng_seed(0x9a);
    model m = model_new();
    for (int32_t p = 0; p < PIECES; p++) {
        const double a = test_uniform(&rng, 0.2, 0.8), x = 3.0 * (p % 60), y = 3.0 * (p / 60);
        model_quad(&m, model_vertex(&m, x, y, 0), model_vertex(&m, x + a, y, 0),
                   model_vertex(&m, x + a, y + 1.0 - a, 0), model_vertex(&m, x, y + 1.0 - a, 0));
    }
    sl_mesh *mesh = model_build(&m);
    sl_symmetry *s = find_all(mesh, NULL, 64);
    int32_t copies = 0;
    for (int32_t p = 0; p < PIECES; p++) {
        copies += s->original[p] != p;
    }
    assert_true(copies < 100); /* by chance within 1e-6 */
    for (int32_t i = 0; i < s->nmap; i += 97) {
        check_map(mesh, s, &s->map[i]);
    }
    sl_symmetry_free(s);
    sl_mesh_free(mesh);
    model_free(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(copies_moved_turned_and_mirrored_are_found),
        cmocka_unit_test(equal_distances_from_the_centre_make_no_copies),
        cmocka_unit_test(a_budget_of_corners_leaves_four_maps_to_each),
        cmocka_unit_test(automorphisms_of_copies_are_listed_when_asked_for),
        cmocka_unit_test(thousands_of_small_components_are_sorted_out),
        cmocka_unit_test(thousands_of_single_facets_without_copies_have_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
