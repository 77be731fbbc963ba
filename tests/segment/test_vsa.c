/* Variational shape approximation: its steps against their definitions, whole partitions against what is known. */
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

static sl_mesh *body(test_rng *rng, int kind)
{
    switch (kind % 4) {
    case 0:
        return test_spiky_mesh(rng, 7, 0, 0.0, TEST_TRIANGLES);
    case 1:
        return test_spiky_mesh(rng, 8, 5, 1.2, TEST_MIXED);
    case 2:
        return test_torus_mesh(rng, 24, 12, 0.4, TEST_QUADS); /* its quads are not plane */
    default:
        return test_tube_mesh(rng, 12, 18, 5.0, TEST_MIXED);
    }
}

static void the_error_of_a_facet_is_the_integral_over_its_triangles(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xe44);
    for (int kind = 0; kind < 4; kind++) {
        sl_mesh *mesh = body(&rng, kind);
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
        sl_mesh *mesh = body(&rng, kind);
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
        sl_mesh *mesh = body(&rng, trial);
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
        sl_mesh *mesh = body(&rng, kind);
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
        sl_mesh *mesh = body(&rng, k);
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

/* Whichever way the box lies and is divided: six regions are its six sides, asked for by number or by error. */
static void six_proxies_of_a_box_are_its_sides(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xb0c6);
    int32_t side[2048], region[2048];
    for (int trial = 0; trial < 30 * test_multiplier(); trial++) {
        const double a[3] = {1.0, trial % 3 == 0 ? 1.0 : test_uniform(&rng, 0.5, 2.0), trial % 3 == 0 ? 1.0 : 1.7};
        const int32_t n[3] = {1 + test_index(&rng, 9), 1 + test_index(&rng, 9), 1 + test_index(&rng, 9)};
        const double shift[3] = {0.3, -0.2, 0.1};
        double R[3][3], error = 0.0;
        sl_mesh *mesh = test_box_mesh(&rng, a, n, (test_facets)(trial % 3), side);
        test_rotation(&rng, R);
        test_move(mesh, R, shift);
        sl_triangulation *t = test_triangulate(mesh);
        test_surface s = test_surface_of(mesh, t);
        for (int by_error = 0; by_error < 2; by_error++) {
            const sl_vsa_def def = {.regions = by_error ? 0 : 6, .error = 0.01, .most = 1000};
            int32_t count = 0, name[6] = {-1, -1, -1, -1, -1, -1};
            assert_int_equal(sl_vsa_partition(&s.vsa, &def, NULL, region, &count, &error), SL_OK);
            assert_int_equal(count, 6);
            assert_true(test_near(error, 0.0, 1e-12));
            for (int32_t f = 0; f < mesh->nf; f++) {
                name[side[f]] = name[side[f]] < 0 ? region[f] : name[side[f]];
                assert_int_equal(region[f], name[side[f]]);
            }
        }
        test_surface_clear(&s);
        sl_triangulation_free(t);
        sl_mesh_free(mesh);
    }
}

/* A prism of many sides with two flat ends, closed by polygons. */
static sl_mesh *drum(test_rng *rng, int32_t around, int32_t along)
{
    const int32_t nv = around * (along + 1), nf = around * along + 2;
    double *xyz = malloc(3 * (size_t)nv * sizeof *xyz);
    int32_t *first = malloc((size_t)(nf + 1) * sizeof *first);
    int32_t *index = malloc((size_t)(4 * around * along + 2 * around) * sizeof *index), n = 0, f = 0;
    for (int32_t i = 0; i <= along; i++) {
        for (int32_t j = 0; j < around; j++) {
            double *p = xyz + 3 * (i * around + j);
            const double jitter = i > 0 && i < along ? test_uniform(rng, -0.2, 0.2) : 0.0;
            p[0] = cos(2.0 * TEST_PI * j / around);
            p[1] = sin(2.0 * TEST_PI * j / around);
            p[2] = 3.0 * (i + jitter) / along;
        }
    }
    first[0] = 0;
    for (int32_t i = 0; i < along; i++) {
        for (int32_t j = 0; j < around; j++) {
            const int32_t k = (j + 1) % around;
            const int32_t quad[4] = {i * around + j, i * around + k, (i + 1) * around + k, (i + 1) * around + j};
            memcpy(index + n, quad, sizeof quad);
            n += 4;
            first[++f] = n;
        }
    }
    for (int32_t end = 0; end < 2; end++) {
        for (int32_t j = 0; j < around; j++) {
            index[n++] = end == 0 ? around - 1 - j : along * around + j;
        }
        first[++f] = n;
    }
    sl_polygons polygons = {nv, nf, xyz, first, index};
    sl_mesh *mesh = NULL;
    sl_diag diag = sl_diag_none();
    assert_int_equal(sl_mesh_build(&polygons, &mesh, NULL, &diag), SL_OK);
    free(xyz);
    free(first);
    free(index);
    return mesh;
}

/* The ends are plane: regions of their own. The barrel is divided along itself; over an arc of angle w the error is
 * 2 - 2 sin(w / 2) / (w / 2) of its area. */
static void a_cylinder_is_its_ends_and_staves(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xc71);
    for (int trial = 0; trial < 8 * test_multiplier(); trial++) {
        const int32_t around = 36 + 12 * test_index(&rng, 4), along = 5 + test_index(&rng, 6), staves = 3 + trial % 3;
        const double shift[3] = {0.0, 0.1, 0.0};
        double R[3][3], error = 0.0;
        sl_mesh *mesh = drum(&rng, around, along);
        test_rotation(&rng, R);
        test_move(mesh, R, shift);
        sl_triangulation *t = test_triangulate(mesh);
        test_surface s = test_surface_of(mesh, t);
        int32_t *region = malloc((size_t)mesh->nf * sizeof *region), count = 0, alone[2] = {0, 0};
        const sl_vsa_def def = {.regions = staves + 2, .error = 0.0, .most = 1000};
        assert_int_equal(sl_vsa_partition(&s.vsa, &def, NULL, region, &count, &error), SL_OK);
        assert_int_equal(count, staves + 2);
        test_check_regions(mesh, region, count);
        for (int32_t end = 0; end < 2; end++) {
            for (int32_t f = 0; f < mesh->nf; f++) {
                alone[end] += region[f] == region[mesh->nf - 2 + end];
            }
            assert_int_equal(alone[end], 1);
        }
        const double half = TEST_PI / staves, barrel = 6.0 / (6.0 + 2.0);
        assert_true(test_near_rel(error, barrel * (2.0 - 2.0 * sin(half) / half), 0.08));
        free(region);
        test_surface_clear(&s);
        sl_triangulation_free(t);
        sl_mesh_free(mesh);
    }
}

/* On a sphere a region of the share 1/k that is round has the error 2/k: no partition can do better. */
static void regions_of_a_sphere_are_connected_and_nearly_round(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x59e4e);
    for (int32_t k = 2; k <= 24; k += 2) {
        sl_mesh *mesh = test_spiky_mesh(&rng, 14, 0, 0.0, TEST_TRIANGLES);
        for (int32_t v = 0; v < mesh->nv; v++) {
            double *p = mesh->xyz + 3 * v;
            const double length = sl_vec3_norm(p);
            for (int d = 0; d < 3; d++) {
                p[d] /= length;
            }
        }
        sl_triangulation *t = test_triangulate(mesh);
        test_surface s = test_surface_of(mesh, t);
        int32_t *region = malloc((size_t)mesh->nf * sizeof *region), count = 0;
        double error = 0.0;
        const sl_vsa_def def = {.regions = k, .most = 1000};
        assert_int_equal(sl_vsa_partition(&s.vsa, &def, NULL, region, &count, &error), SL_OK);
        assert_int_equal(count, k);
        test_check_regions(mesh, region, count);
        assert_true(error > 0.98 * 2.0 / k && error < 1.3 * 2.0 / k);
        free(region);
        test_surface_clear(&s);
        sl_triangulation_free(t);
        sl_mesh_free(mesh);
    }
}

static void by_error_the_bound_holds_and_no_two_neighbours_could_be_one(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xb7e);
    for (int trial = 0; trial < 8 * test_multiplier(); trial++) {
        sl_mesh *mesh = body(&rng, trial);
        sl_triangulation *t = test_triangulate(mesh);
        test_surface s = test_surface_of(mesh, t);
        int32_t *region = malloc((size_t)mesh->nf * sizeof *region), count = 0;
        double error = 0.0, total = 0.0;
        const sl_vsa_def def = {.error = test_uniform(&rng, 0.1, 0.5), .most = 1000};
        assert_int_equal(sl_vsa_partition(&s.vsa, &def, NULL, region, &count, &error), SL_OK);
        for (int32_t f = 0; f < mesh->nf; f++) {
            total += s.area[f];
        }
        const double energy = test_energy(mesh, t, region, count);
        test_check_regions(mesh, region, count);
        assert_true(count >= 2 && error <= def.error * (1.0 + 1e-12));
        assert_true(test_near(error, energy / total, 1e-12));
        for (int32_t a = 0; count > 2 && a < count; a++) {
            for (int32_t b = a + 1; b < count; b++) {
                if (test_regions_touch(mesh, region, a, b)) {
                    const double apart =
                        test_region_energy(mesh, t, region, a, -1) + test_region_energy(mesh, t, region, b, -1);
                    const double merged = energy - apart + test_region_energy(mesh, t, region, a, b);
                    assert_true(merged > def.error * total);
                }
            }
        }
        free(region);
        test_surface_clear(&s);
        sl_triangulation_free(t);
        sl_mesh_free(mesh);
    }
}

static void turning_the_surface_changes_nothing(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x70e5);
    for (int trial = 0; trial < 8 * test_multiplier(); trial++) {
        sl_mesh *mesh = body(&rng, trial);
        sl_triangulation *t = test_triangulate(mesh);
        int32_t *region[2], count[2];
        double R[3][3], error[2];
        const double shift[3] = {-0.4, 0.2, 0.3};
        const sl_vsa_def def = {.regions = trial % 2 == 0 ? 2 + trial : 0, .error = 0.2, .most = 1000};
        test_rotation(&rng, R);
        for (int turned = 0; turned < 2; turned++) {
            test_surface s = test_surface_of(mesh, t);
            region[turned] = malloc((size_t)mesh->nf * sizeof *region[turned]);
            assert_int_equal(sl_vsa_partition(&s.vsa, &def, NULL, region[turned], &count[turned], &error[turned]),
                             SL_OK);
            test_surface_clear(&s);
            test_move(mesh, R, shift);
        }
        assert_int_equal(count[0], count[1]);
        assert_memory_equal(region[0], region[1], (size_t)mesh->nf * sizeof **region);
        assert_true(test_near_rel(error[0], error[1], 1e-12));
        free(region[0]);
        free(region[1]);
        sl_triangulation_free(t);
        sl_mesh_free(mesh);
    }
}

static void the_number_of_regions_is_what_was_asked_for(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xc047);
    sl_mesh *mesh = test_torus_mesh(&rng, 7, 5, 0.3, TEST_QUADS);
    sl_triangulation *t = test_triangulate(mesh);
    test_surface s = test_surface_of(mesh, t);
    int32_t region[64], count = 0;
    for (int32_t k = 1; k <= 40; k++) {
        const sl_vsa_def def = {.regions = k, .most = 1000};
        assert_int_equal(sl_vsa_partition(&s.vsa, &def, NULL, region, &count, NULL), SL_OK);
        assert_int_equal(count, k < 2 ? 2 : k < mesh->nf ? k : mesh->nf);
        test_check_regions(mesh, region, count);
    }
    const sl_vsa_def fine = {.error = 0.0, .most = 9}, few = {.regions = 30, .most = 4};
    assert_int_equal(sl_vsa_partition(&s.vsa, &fine, NULL, region, &count, NULL), SL_OK);
    assert_int_equal(count, 9);
    assert_int_equal(sl_vsa_partition(&s.vsa, &few, NULL, region, &count, NULL), SL_OK);
    assert_int_equal(count, 4);

    const int32_t none[2] = {0, 0};
    const sl_graph lone = {.n = 1, .first = (int32_t *)none};
    const double area = 0.7, vector[3] = {0.1, 0.2, 0.6};
    const sl_vsa_surface one = {&lone, &area, vector};
    assert_int_equal(sl_vsa_partition(&one, &few, NULL, region, &count, NULL), SL_OK);
    assert_true(count == 1 && region[0] == 0);
    test_surface_clear(&s);
    sl_triangulation_free(t);
    sl_mesh_free(mesh);
}

/* Facets without area have no normal and no error: they go along, and nothing becomes NaN. */
static void nodes_without_area_go_along(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x0a4ea);
    sl_mesh *mesh = test_spiky_mesh(&rng, 6, 3, 1.0, TEST_TRIANGLES);
    sl_triangulation *t = test_triangulate(mesh);
    test_surface s = test_surface_of(mesh, t);
    int32_t *region = malloc((size_t)mesh->nf * sizeof *region), count = 0;
    double error = 0.0;
    for (int32_t k = 0; k < mesh->nf / 6; k++) {
        const int32_t f = test_index(&rng, mesh->nf);
        s.area[f] = s.vector[3 * f] = s.vector[3 * f + 1] = s.vector[3 * f + 2] = 0.0;
    }
    s.area[0] = s.vector[0] = s.vector[1] = s.vector[2] = 0.0; /* the first seed too */
    const sl_vsa_def def = {.regions = 7, .most = 1000};
    assert_int_equal(sl_vsa_partition(&s.vsa, &def, NULL, region, &count, &error), SL_OK);
    assert_int_equal(count, 7);
    assert_true(isfinite(error) && error < 1.0);
    test_check_regions(mesh, region, count);
    memset(s.area, 0, (size_t)mesh->nf * sizeof *s.area);
    memset(s.vector, 0, 3 * (size_t)mesh->nf * sizeof *s.vector);
    assert_int_equal(sl_vsa_partition(&s.vsa, &def, NULL, region, &count, &error), SL_OK);
    assert_true(count == 7 && error == 0.0);
    free(region);
    test_surface_clear(&s);
    sl_triangulation_free(t);
    sl_mesh_free(mesh);
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
        cmocka_unit_test(six_proxies_of_a_box_are_its_sides),
        cmocka_unit_test(a_cylinder_is_its_ends_and_staves),
        cmocka_unit_test(regions_of_a_sphere_are_connected_and_nearly_round),
        cmocka_unit_test(by_error_the_bound_holds_and_no_two_neighbours_could_be_one),
        cmocka_unit_test(turning_the_surface_changes_nothing),
        cmocka_unit_test(the_number_of_regions_is_what_was_asked_for),
        cmocka_unit_test(nodes_without_area_go_along),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
