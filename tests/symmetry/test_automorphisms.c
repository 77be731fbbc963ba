/* Whole groups: against brute force, and of shapes whose groups are known. */
#include "checks.h"

static void compare_with_brute_force(const model *m)
{
    sl_mesh *mesh = model_build(m);
    sl_symmetry *s = find_all(mesh, NULL, 100000);
    assert_int_equal(s->components, 1);
    assert_int_equal(s->nmap, brute_force_count(m));
    assert_false(s->truncated);
    check_all(mesh, s);
    sl_symmetry_free(s);
    sl_mesh_free(mesh);
}

static void regular_meshes_have_as_many_automorphisms_as_brute_force_finds(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xb0b0);
    for (int which = 0; which < 7; which++) {
        model m = model_new();
        switch (which) {
        case 0:
            model_box(&m, 1, 1, 1);
            break;
        case 1:
            model_box(&m, 2, 1, 3);
            break;
        case 2:
            model_icosphere(&m, 0);
            break;
        case 3:
            model_torus(&m, 3, 5);
            break;
        case 4:
            model_torus(&m, 4, 4); /* 16 facets: more symmetric than it looks */
            break;
        case 5:
            model_quad(&m, model_vertex(&m, 0, 0, 0), model_vertex(&m, 1, 0, 0), model_vertex(&m, 1, 1, 0.2),
                       model_vertex(&m, 0, 1, 0));
            break;
        default:
            model_triangle(&m, model_vertex(&m, 0, 0, 0), model_vertex(&m, 1, 0, 0), model_vertex(&m, 0, 1, 0));
            break;
        }
        model_relabel(&m, &rng, 1, NULL, NULL);
        compare_with_brute_force(&m);
        model_free(&m);
    }
}

static void random_meshes_have_as_many_automorphisms_as_brute_force_finds(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x5e7);
    for (int trial = 0; trial < 12 * test_multiplier(); trial++) {
        int32_t mirror[400];
        model m = model_new();
        model_planted(&m, &rng, 1 + test_index(&rng, 3), 1 + test_index(&rng, 3), trial % 2 == 1, trial % 3 == 0,
                      mirror);
        model_relabel(&m, &rng, 1, NULL, NULL);
        compare_with_brute_force(&m);
        model_free(&m);
    }
}

/* A strip with a triangle at one end is not its own image, wherever the walk begins. */
static void strips_with_unlike_ends_are_not_turned_round(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x57);
    for (int n = 2; n < 16; n++) {
        model m = model_new();
        for (int i = 0; i <= n; i++) {
            model_vertex(&m, i, 0, 0.1 * i * i);
            model_vertex(&m, i, 1.3, 0.1 * i * i);
            if (i > 0) {
                model_quad(&m, 2 * i - 2, 2 * i, 2 * i + 1, 2 * i - 1);
            }
        }
        model_triangle(&m, 2 * n, model_vertex(&m, n + 1, 0.6, 0.1 * n * n), 2 * n + 1);
        model_relabel(&m, &rng, 1, NULL, NULL);
        compare_with_brute_force(&m);
        model_free(&m);
    }
}

/* Number of symmetries with the identity. */
static void expect_order(const model *m, int32_t order, int32_t mirrors)
{
    sl_mesh *mesh = model_build(m);
    sl_symmetry *s = find_all(mesh, NULL, 1000);
    int32_t found = 0;
    assert_int_equal(s->nmap + 1, order);
    assert_false(s->truncated);
    for (int32_t i = 0; i < s->nmap; i++) {
        const sl_symmetry_map *map = &s->map[i];
        const double *T = map->isometry;
        const double trace = T[0] + T[5] + T[10];
        assert_int_equal(map->kind, SL_SYMMETRY_EXACT);
        check_map(mesh, s, map);
        const bool mirror = map->reverses && map->order == 2 && fabs(trace - 1.0) < 1e-6;
        assert_true(!mirror || map->separates);
        assert_true(mirror == (i < mirrors)); /* mirrors first */
        found += mirror;
    }
    assert_int_equal(found, mirrors);
    sl_symmetry_free(s);
    sl_mesh_free(mesh);
}

static void groups_of_solids_have_their_orders_and_mirrors(void **state)
{
    (void)state;
    static const struct {
        int32_t size[3], order, mirrors;
    } boxes[] = {{{8, 8, 8}, 48, 9}, {{8, 8, 4}, 16, 5}, {{4, 4, 12}, 16, 5}, {{3, 4, 5}, 8, 3}, {{7, 7, 7}, 48, 9}};
    test_rng rng = test_rng_seed(48);
    for (size_t i = 0; i < SL_COUNTOF(boxes); i++) {
        model m = model_new();
        model_box(&m, boxes[i].size[0], boxes[i].size[1], boxes[i].size[2]);
        model_relabel(&m, &rng, 1, NULL, NULL);
        expect_order(&m, boxes[i].order, boxes[i].mirrors);
        model_free(&m);
    }
    for (int32_t level = 0; level < 4; level++) {
        double T[12];
        model m = model_new();
        model_icosphere(&m, level);
        model_random_isometry(&rng, false, T);
        model_move(&m, T);
        expect_order(&m, 120, 15);
        model_free(&m);
    }
}

/* Of a torus of n x k quads 4 n automorphisms are isometries, the others turn it inside out or around its core. */
static void exact_maps_of_a_torus_come_before_the_others(void **state)
{
    (void)state;
    static const int32_t size[3][2] = {{5, 6}, {20, 12}, {40, 26}};
    for (int i = 0; i < 3; i++) {
        const int32_t n = size[i][0], k = size[i][1];
        model m = model_new();
        model_torus(&m, n, k);
        sl_mesh *mesh = model_build(&m);
        sl_symmetry *s = find_all(mesh, NULL, 10000);
        const int32_t all = 4 * n * k - 1;
        assert_true(s->truncated ? s->nmap < all : s->nmap == all);
        assert_true(s->nmap >= 4 * n);
        for (int32_t j = 0; j < s->nmap; j++) {
            assert_int_equal(s->map[j].kind == SL_SYMMETRY_EXACT, j < 4 * n - 1);
        }
        for (int32_t j = 0; j < n + 1; j++) { /* n planes through the axis, one across */
            assert_true(s->map[j].separates && s->map[j].reverses && s->map[j].order == 2);
        }
        for (int32_t j = 0; j < s->nmap; j += 7) {
            check_map(mesh, s, &s->map[j]);
        }
        sl_symmetry_free(s);
        s = find_all(mesh, NULL, SL_SYMMETRY_MOST);
        assert_true(s->truncated);
        assert_int_equal(s->nmap, SL_SYMMETRY_MOST);
        /* three mirrors at right angles (where there are such) and the smallest turn generate them all */
        bool turn = false;
        for (int32_t j = 0; j < s->nmap; j++) {
            turn = turn || (!s->map[j].reverses && s->map[j].kind == SL_SYMMETRY_EXACT && s->map[j].order == n);
        }
        assert_true(turn);
        double most = -HUGE_VAL;
        for (int32_t a = 0; a < 2; a++) {
            const double *T = s->map[a].isometry, *U = s->map[a + 1].isometry;
            double sum = 0.0; /* trace of T U = 1 + 2 cos(2 angle) with the angle of the planes */
            for (int r = 0; r < 3; r++) {
                for (int c = 0; c < 3; c++) {
                    sum += T[4 * r + c] * U[4 * c + r];
                }
            }
            most = fmax(most, sum);
        }
        assert_true(most < -0.9 || n % 2 == 1);
        sl_symmetry_free(s);
        sl_mesh_free(mesh);
        model_free(&m);
    }
}

/* Three mirrors at right angles and the smallest turn: of four maps that is what a torus shows. */
static void four_maps_of_a_torus_generate_the_others(void **state)
{
    (void)state;
    static const int32_t size[3][2] = {{8, 6}, {40, 26}, {60, 33}};
    for (int i = 0; i < 3; i++) {
        test_rng rng = test_rng_seed(4);
        model m = model_new();
        model_torus(&m, size[i][0], size[i][1]);
        model_relabel(&m, &rng, 1, NULL, NULL);
        sl_mesh *mesh = model_build(&m);
        sl_symmetry *s = find_all(mesh, NULL, 4);
        bool axis[3] = {false, false, false};
        assert_int_equal(s->nmap, 4);
        assert_true(s->truncated);
        for (int32_t k = 0; k < 3; k++) { /* the coordinate planes before others */
            const double *T = s->map[k].isometry;
            assert_true(test_near(fabs(T[0]) + fabs(T[5]) + fabs(T[10]), 3.0, 1e-9));
            for (int a = 0; a < 3; a++) {
                axis[a] = axis[a] || T[5 * a] < 0.0;
            }
        }
        assert_true(axis[0] && axis[1] && axis[2]);
        assert_false(s->map[3].reverses);
        assert_int_equal(s->map[3].order, size[i][0]);
        const double *T = s->map[3].isometry;
        assert_true(test_near(T[0] + T[5] + T[10], 1.0 + 2.0 * cos(2 * TEST_PI / size[i][0]), 1e-9));
        sl_symmetry_free(s);
        sl_mesh_free(mesh);
        model_free(&m);
    }
}

/* A mirror with a small turn after it is no mirror. */
static void of_many_maps_mirrors_and_one_turn_are_listed(void **state)
{
    (void)state;
    model m = model_new();
    model_torus(&m, 100, 9);
    sl_mesh *mesh = model_build(&m);
    sl_symmetry *s = find_all(mesh, NULL, SL_SYMMETRY_MOST);
    assert_int_equal(s->nmap, SL_SYMMETRY_MOST);
    for (int32_t i = 0; i < s->nmap; i++) {
        assert_int_equal(s->map[i].kind, SL_SYMMETRY_EXACT);
        assert_int_equal(s->map[i].reverses && s->map[i].separates, i + 1 < s->nmap);
    }
    assert_int_equal(s->map[s->nmap - 1].order, 100);
    sl_symmetry_free(s);
    sl_mesh_free(mesh);
    model_free(&m);
}

/* A disc of 600 sectors whose rim alone is six-fold: around the middle every turn looks exact. */
static void a_round_middle_does_not_hide_a_six_fold_rim(void **state)
{
    (void)state;
    enum { SECTORS = 600, RINGS = 40 };
    model m = model_new();
    model_vertex(&m, 0, 0, 0.5);
    for (int ring = 1; ring <= RINGS; ring++) {
        for (int i = 0; i < SECTORS; i++) {
            const double a = 2 * TEST_PI * i / SECTORS;
            const double r = ring * (1.0 + (ring > RINGS - 3 ? 0.05 * cos(6 * a) : 0.0));
            model_vertex(&m, r * cos(a), r * sin(a), 0.5 - 0.001 * ring * ring);
        }
    }
    for (int i = 0; i < SECTORS; i++) {
        const int j = (i + 1) % SECTORS;
        model_triangle(&m, 0, 1 + i, 1 + j);
        for (int ring = 0; ring < RINGS - 1; ring++) {
            const int a = 1 + ring * SECTORS;
            model_quad(&m, a + i, a + SECTORS + i, a + SECTORS + j, a + j);
        }
    }
    sl_mesh *mesh = model_build(&m);
    sl_symmetry *s = find_all(mesh, NULL, SL_SYMMETRY_MOST);
    assert_true(s->truncated);
    for (int32_t i = 0; i < s->nmap; i++) {
        assert_int_equal(s->map[i].kind == SL_SYMMETRY_EXACT, i < 11);
        assert_int_equal(s->map[i].reverses && s->map[i].separates, i < 6 || s->map[i].reverses);
    }
    sl_symmetry_free(s);
    sl_mesh_free(mesh);
    model_free(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(regular_meshes_have_as_many_automorphisms_as_brute_force_finds),
        cmocka_unit_test(random_meshes_have_as_many_automorphisms_as_brute_force_finds),
        cmocka_unit_test(strips_with_unlike_ends_are_not_turned_round),
        cmocka_unit_test(groups_of_solids_have_their_orders_and_mirrors),
        cmocka_unit_test(exact_maps_of_a_torus_come_before_the_others),
        cmocka_unit_test(four_maps_of_a_torus_generate_the_others),
        cmocka_unit_test(of_many_maps_mirrors_and_one_turn_are_listed),
        cmocka_unit_test(a_round_middle_does_not_hide_a_six_fold_rim),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
