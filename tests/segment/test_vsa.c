/* Variational shape approximation: its steps against their definitions. */
#include "segment/baselines.h"

static void the_queue_gives_the_smallest_first_and_equals_in_order(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x4ea9);
    enum { N = 300 };
    sl_vsa_heap_entry room[N];
    sl_vsa_heap heap = {0, room};
    for (int trial = 0; trial < 20 * test_multiplier(); trial++) {
        int32_t order = 0, inside = 0;
        bool in[N] = {false};
        double key[N];
        while (order < N || inside > 0) {
            if (order < N && (inside == 0 || test_index(&rng, 3) > 0)) {
                key[order] = test_index(&rng, 12) * 0.37;
                in[order] = true;
                sl_vsa_heap_push(&heap, (sl_vsa_heap_entry){key[order], order, 7 * order, order % 5});
                order++;
                inside++;
            } else {
                int32_t best = -1;
                for (int32_t k = 0; k < order; k++) {
                    best = in[k] && (best < 0 || key[k] < key[best]) ? k : best;
                }
                const sl_vsa_heap_entry top = sl_vsa_heap_pop(&heap);
                assert_int_equal(top.order, best);
                assert_true(top.key == key[best] && top.node == 7 * best && top.region == best % 5);
                in[best] = false;
                inside--;
            }
        }
        assert_int_equal(heap.count, 0);
    }
}

static void the_error_of_a_facet_is_the_integral_over_its_triangles(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xe44);
    for (int kind = 0; kind < 4; kind++) {
        sl_mesh *mesh = test_body(&rng, kind);
        sl_triangulation *t = test_triangulate(mesh);
        test_surface s = test_surface_of(mesh, t);
        sl_vsa vsa;
        assert_int_equal(sl_vsa_create(&s.vsa, &vsa), SL_OK);
        for (int trial = 0; trial < 100; trial++) {
            double R[3][3], sum = 0.0;
            const int32_t f = test_index(&rng, mesh->nf);
            test_rotation(&rng, R);
            sl_vsa_proxy proxy = {.normal = {R[0][0], R[0][1], R[0][2]}};
            for (int32_t i = t->first[f]; i < t->first[f + 1]; i++) {
                double normal[3], d[3], area;
                test_triangle(mesh, t, i, normal, &area);
                sl_vec3_sub(normal, proxy.normal, d);
                sum += area * sl_vec3_dot(d, d);
            }
            assert_true(test_near(sl_vsa_error(&vsa, f, &proxy), sum, 1e-14));
        }
        sl_vsa_clear(&vsa);
        test_surface_clear(&s);
        sl_triangulation_free(t);
        sl_mesh_free(mesh);
    }
}

/* No other normal does better than the fitted one, and the energy is that of the definition. */
static void fitted_proxies_are_the_best_there_are(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xf17);
    for (int kind = 0; kind < 4; kind++) {
        sl_mesh *mesh = test_body(&rng, kind);
        sl_triangulation *t = test_triangulate(mesh);
        test_surface s = test_surface_of(mesh, t);
        sl_vsa vsa;
        int32_t inserted = 0;
        assert_int_equal(sl_vsa_create(&s.vsa, &vsa), SL_OK);
        assert_int_equal(sl_vsa_insert(&vsa, 1, &inserted), SL_OK);
        sl_vsa_grow(&vsa);
        assert_int_equal(sl_vsa_insert(&vsa, 2, &inserted), SL_OK);
        assert_int_equal(inserted, 2);
        sl_vsa_grow(&vsa);
        assert_int_equal(vsa.count, 4);
        test_check_regions(mesh, vsa.region, 4);
        assert_true(test_near_rel(vsa.energy, test_energy(mesh, t, vsa.region, 4), 1e-12));
        for (int trial = 0; trial < 60; trial++) {
            const int32_t r = test_index(&rng, 4);
            sl_vsa_proxy other = vsa.proxy[r];
            double R[3][3], error = 0.0;
            test_rotation(&rng, R);
            for (int k = 0; k < 3; k++) {
                other.normal[k] += 0.1 * R[0][k];
            }
            const double length = sl_vec3_norm(other.normal);
            for (int k = 0; k < 3; k++) {
                other.normal[k] /= length;
            }
            for (int32_t f = 0; f < mesh->nf; f++) {
                error += vsa.region[f] == r ? sl_vsa_error(&vsa, f, &other) : 0.0;
            }
            assert_true(error > vsa.proxy[r].error);
        }
        sl_vsa_clear(&vsa);
        test_surface_clear(&s);
        sl_triangulation_free(t);
        sl_mesh_free(mesh);
    }
}

/* One sweep at a time, as relaxing does it: while sweeps are accepted, each is lower than the one before. */
static void every_accepted_sweep_lowers_the_energy(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x5eeb);
    int32_t sweeps = 0;
    for (int trial = 0; trial < 12 * test_multiplier(); trial++) {
        sl_mesh *mesh = test_body(&rng, trial);
        sl_triangulation *t = test_triangulate(mesh);
        test_surface s = test_surface_of(mesh, t);
        sl_vsa vsa;
        assert_int_equal(sl_vsa_create(&s.vsa, &vsa), SL_OK);
        for (int32_t inserted = 0; vsa.count < 3 + trial; sl_vsa_grow(&vsa)) {
            assert_int_equal(sl_vsa_insert(&vsa, 1, &inserted), SL_OK);
            sl_vsa_fit(&vsa);
        }
        const double start = vsa.energy;
        assert_int_equal(sl_vsa_relax(&vsa, NULL), SL_OK);
        assert_true(vsa.energy <= start);
        test_check_regions(mesh, vsa.region, vsa.count);
        assert_true(test_near_rel(vsa.energy, test_energy(mesh, t, vsa.region, vsa.count), 1e-10));
        for (double before = INFINITY; sweeps < 1000;
             sweeps++) { /* from what it ended with nothing more is to be had */
            before = vsa.energy;
            assert_int_equal(sl_vsa_relax(&vsa, NULL), SL_OK);
            assert_true(vsa.energy <= before);
            if (vsa.energy >= before * (1.0 - 1e-6)) {
                break;
            }
        }
        sl_vsa_clear(&vsa);
        test_surface_clear(&s);
        sl_triangulation_free(t);
        sl_mesh_free(mesh);
    }
    assert_true(sweeps < 1000);
}

static void the_cheapest_merge_is_the_one_that_brute_force_finds(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x3e46e);
    for (int kind = 0; kind < 4; kind++) {
        sl_mesh *mesh = test_body(&rng, kind);
        sl_triangulation *t = test_triangulate(mesh);
        test_surface s = test_surface_of(mesh, t);
        sl_vsa vsa;
        assert_int_equal(sl_vsa_create(&s.vsa, &vsa), SL_OK);
        for (int32_t inserted = 0; vsa.count < 9; sl_vsa_grow(&vsa)) {
            assert_int_equal(sl_vsa_insert(&vsa, 1, &inserted), SL_OK);
        }
        double best = INFINITY, cost = 0.0;
        int32_t best_a = -1, best_b = -1, a = -1, b = -1;
        for (int32_t i = 0; i < 9; i++) {
            for (int32_t j = i + 1; j < 9; j++) {
                const double c =
                    test_regions_touch(mesh, vsa.region, i, j)
                        ? test_region_energy(mesh, t, vsa.region, i, j) - vsa.proxy[i].error - vsa.proxy[j].error
                        : INFINITY;
                if (c < best) {
                    best = c;
                    best_a = i;
                    best_b = j;
                }
            }
        }
        assert_int_equal(sl_vsa_cheapest_merge(&vsa, &a, &b, &cost), SL_OK);
        assert_true(a == best_a && b == best_b);
        assert_true(test_near(cost, best, 1e-12));
        const double energy = vsa.energy; /* merging within a bound that allows just this one */
        assert_int_equal(sl_vsa_merge_within(&vsa, energy + cost * (1.0 + 1e-9), 2), SL_OK);
        assert_int_equal(vsa.count, 8);
        assert_true(test_near(vsa.energy, energy + cost, 1e-12));
        assert_int_equal(sl_vsa_merge_within(&vsa, 1e9, 2), SL_OK);
        assert_int_equal(vsa.count, 2);
        test_check_regions(mesh, vsa.region, 2);
        sl_vsa_clear(&vsa);
        test_surface_clear(&s);
        sl_triangulation_free(t);
        sl_mesh_free(mesh);
    }
}

/* A poor start: all seeds but one on one side of the box. Sweeps alone cannot move them; teleporting does. */
static void teleporting_lowers_the_energy_and_keeps_the_number(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x7e1e);
    int32_t side[2048], moved = 0;
    for (int trial = 0; trial < 5 * test_multiplier(); trial++) {
        const double a[3] = {1.0, 1.3, 0.8};
        const int32_t n[3] = {6, 7, 5};
        sl_mesh *mesh = test_box_mesh(&rng, a, n, TEST_MIXED, side);
        sl_triangulation *t = test_triangulate(mesh);
        test_surface s = test_surface_of(mesh, t);
        sl_vsa vsa;
        int32_t inserted = 0, used = 0;
        assert_int_equal(sl_vsa_create(&s.vsa, &vsa), SL_OK);
        while (vsa.count < 6) {
            assert_int_equal(sl_vsa_insert(&vsa, 1, &inserted), SL_OK);
            sl_vsa_fit(&vsa);
        }
        for (int32_t f = 0; f < mesh->nf && used < 5; f += 1 + test_index(&rng, 4)) {
            if (side[f] == 0) {
                vsa.proxy[used].seed = f;
                memcpy(vsa.proxy[used++].normal, vsa.unit + 3 * f, 3 * sizeof(double));
            }
        }
        for (int32_t f = 0; f < mesh->nf; f++) {
            vsa.proxy[5].seed = side[f] == 5 ? f : vsa.proxy[5].seed;
        }
        memcpy(vsa.proxy[5].normal, vsa.unit + 3 * vsa.proxy[5].seed, 3 * sizeof(double));
        assert_int_equal(used, 5);
        sl_vsa_grow(&vsa);
        assert_int_equal(sl_vsa_relax(&vsa, NULL), SL_OK);
        const double start = vsa.energy;
        assert_int_equal(sl_vsa_teleport(&vsa, NULL), SL_OK);
        assert_int_equal(vsa.count, 6);
        assert_true(vsa.energy <= start);
        moved += vsa.energy < 0.9 * start;
        test_check_regions(mesh, vsa.region, 6);
        assert_true(test_near(vsa.energy, test_energy(mesh, t, vsa.region, 6), 1e-12));
        sl_vsa_clear(&vsa);
        test_surface_clear(&s);
        sl_triangulation_free(t);
        sl_mesh_free(mesh);
    }
    assert_true(moved >= 4);
}

static void a_move_that_does_not_help_is_taken_back(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x7e1f);
    int32_t kept = 0, trials = 0;
    for (int32_t k = 3; k < 15; k++) {
        sl_mesh *mesh = test_body(&rng, k);
        sl_triangulation *t = test_triangulate(mesh);
        test_surface s = test_surface_of(mesh, t);
        sl_vsa vsa;
        assert_int_equal(sl_vsa_create(&s.vsa, &vsa), SL_OK);
        for (int32_t inserted = 0; vsa.count < k; sl_vsa_grow(&vsa)) {
            assert_int_equal(sl_vsa_insert(&vsa, 1, &inserted), SL_OK);
            sl_vsa_fit(&vsa);
        }
        assert_int_equal(sl_vsa_relax(&vsa, NULL), SL_OK);
        const double start = vsa.energy;
        int32_t *before = malloc((size_t)mesh->nf * sizeof *before);
        memcpy(before, vsa.region, (size_t)mesh->nf * sizeof *before);
        assert_int_equal(sl_vsa_teleport(&vsa, NULL), SL_OK);
        const bool same = memcmp(before, vsa.region, (size_t)mesh->nf * sizeof *before) == 0;
        assert_true(same ? vsa.energy == start : vsa.energy < start);
        assert_true(test_near_rel(vsa.energy, test_energy(mesh, t, vsa.region, k), 1e-10));
        kept += same;
        trials++;
        free(before);
        sl_vsa_clear(&vsa);
        test_surface_clear(&s);
        sl_triangulation_free(t);
        sl_mesh_free(mesh);
    }
    assert_true(kept > 0 && kept < trials);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_queue_gives_the_smallest_first_and_equals_in_order),
        cmocka_unit_test(the_error_of_a_facet_is_the_integral_over_its_triangles),
        cmocka_unit_test(fitted_proxies_are_the_best_there_are),
        cmocka_unit_test(every_accepted_sweep_lowers_the_energy),
        cmocka_unit_test(the_cheapest_merge_is_the_one_that_brute_force_finds),
        cmocka_unit_test(teleporting_lowers_the_energy_and_keeps_the_number),
        cmocka_unit_test(a_move_that_does_not_help_is_taken_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
