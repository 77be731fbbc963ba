/* Variational shape approximation of whole surfaces, against what is known of them. */
#include "segment/baselines.h"

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
    return test_mesh_of(nv, nf, xyz, first, index);
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
        sl_mesh *mesh = test_body(&rng, trial);
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
        sl_mesh *mesh = test_body(&rng, trial);
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
