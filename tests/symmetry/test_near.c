#include "checks.h"

#include "symmetry/nearest.h"
#include "symmetry/rigid.h"

static double determinant(const double T[12])
{
    return T[0] * (T[5] * T[10] - T[6] * T[9]) - T[1] * (T[4] * T[10] - T[6] * T[8]) +
           T[2] * (T[4] * T[9] - T[5] * T[8]);
}

/* Points in space, in a plane, on a line, in one point: the isometry is found again as far as they tell. */
static void an_isometry_is_found_again_from_points(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x4ab5c);
    for (int trial = 0; trial < 400 * test_multiplier(); trial++) {
        const bool reflect = trial % 2 == 1;
        const int dimension = trial / 2 % 4;
        double T[12], U[12], p[20][3], q[20][3], basis[3][3], origin_p[3], origin_q[3];
        model_random_isometry(&rng, reflect, T);
        sl_rigid_sums sums = {0};
        for (int i = 0; i < 3; i++) {
            origin_p[i] = test_uniform(&rng, -1.0, 1.0);
            origin_q[i] = test_uniform(&rng, -1.0, 1.0);
            for (int k = 0; k < 3; k++) {
                basis[i][k] = i < dimension ? test_uniform(&rng, -2.0, 2.0) : 0.0;
            }
        }
        for (int i = 0; i < 20; i++) {
            double a[3], b[3];
            const double w[3] = {test_uniform(&rng, -1, 1), test_uniform(&rng, -1, 1), test_uniform(&rng, -1, 1)};
            for (int k = 0; k < 3; k++) {
                p[i][k] = 0.3 + w[0] * basis[0][k] + w[1] * basis[1][k] + w[2] * basis[2][k];
            }
            sl_rigid_apply(T, p[i], q[i]);
            for (int k = 0; k < 3; k++) {
                a[k] = p[i][k] - origin_p[k];
                b[k] = q[i][k] - origin_q[k];
            }
            sl_rigid_add(&sums, a, b);
        }
        sl_rigid_fit(&sums, origin_p, origin_q, reflect, U);
        assert_true(test_near(determinant(U), reflect ? -1.0 : 1.0, 1e-12));
        for (int i = 0; i < 9; i++) { /* orthogonal */
            double dot = 0.0;
            for (int k = 0; k < 3; k++) {
                dot += U[4 * (i / 3) + k] * U[4 * (i % 3) + k];
            }
            assert_true(test_near(dot, i / 3 == i % 3 ? 1.0 : 0.0, 1e-12));
        }
        for (int i = 0; i < 20; i++) {
            double r[3];
            sl_rigid_apply(U, p[i], r);
            for (int k = 0; k < 3; k++) {
                assert_true(test_near(r[k], q[i][k], 1e-11));
            }
        }
        for (int i = 0; i < 12 && dimension == 3; i++) {
            assert_true(test_near(U[i], T[i], 1e-9));
        }
    }
}

/* No isometry near the one returned is better. */
static void the_fit_is_of_least_squares(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x1ea57);
    for (int trial = 0; trial < 100 * test_multiplier(); trial++) {
        double p[12][3], q[12][3], T[12], zero[3] = {0}, cost[2] = {0};
        sl_rigid_sums sums = {0};
        for (int i = 0; i < 12; i++) {
            for (int k = 0; k < 3; k++) {
                p[i][k] = test_uniform(&rng, -1.0, 1.0);
            }
            for (int k = 0; k < 3; k++) {
                q[i][k] = (trial % 2 == 1 ? -1.0 : 1.0) * p[i][(k + 1) % 3] + test_uniform(&rng, -0.6, 0.6);
            }
            sl_rigid_add(&sums, p[i], q[i]);
        }
        sl_rigid_fit(&sums, zero, zero, false, T);
        for (int other = 0; other < 40; other++) {
            double S[12], R[12], a = test_uniform(&rng, -0.1, 0.1);
            const int axis = other % 3, u = (axis + 1) % 3, v = (axis + 2) % 3;
            memcpy(S, T, sizeof S);
            for (int k = 0; k < 4 && other > 0; k++) { /* turned a little, moved a little */
                R[k] = cos(a) * T[4 * u + k] - sin(a) * T[4 * v + k];
                S[4 * v + k] = sin(a) * T[4 * u + k] + cos(a) * T[4 * v + k];
                S[4 * u + k] = R[k];
            }
            S[4 * axis + 3] += other > 0 ? test_uniform(&rng, -0.1, 0.1) : 0.0;
            for (int k = 0; k < 4 && other % 5 == 4; k++) {
                S[4 * axis + k] = -S[4 * axis + k]; /* the other handedness */
            }
            double sum = 0.0;
            for (int i = 0; i < 12; i++) {
                double r[3];
                sl_rigid_apply(S, p[i], r);
                for (int k = 0; k < 3; k++) {
                    sum += (r[k] - q[i][k]) * (r[k] - q[i][k]);
                }
            }
            cost[other > 0] = sum;
            assert_true(cost[0] <= sum + 1e-12);
        }
    }
}

static void eigenvectors_of_three_by_three_are_orthonormal_and_right(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xe163);
    for (int trial = 0; trial < 200 * test_multiplier(); trial++) {
        double A[9], lambda[3], V[9];
        for (int i = 0; i < 3; i++) {
            for (int j = 0; j <= i; j++) {
                A[3 * i + j] = A[3 * j + i] = trial % 5 == 0 ? (i == j ? 2.5 : 0.0) : test_uniform(&rng, -3.0, 3.0);
            }
        }
        sl_eigen3(A, lambda, V);
        assert_true(lambda[0] <= lambda[1] && lambda[1] <= lambda[2]);
        for (int k = 0; k < 3; k++) {
            for (int i = 0; i < 3; i++) {
                double Av = 0.0, dot = 0.0;
                for (int j = 0; j < 3; j++) {
                    Av += A[3 * i + j] * V[3 * k + j];
                    dot += V[3 * i + j] * V[3 * k + j];
                }
                assert_true(test_near(Av, lambda[k] * V[3 * k + i], 1e-13));
                assert_true(test_near(dot, i == k ? 1.0 : 0.0, 1e-14));
            }
        }
    }
}

/* The point lies on the triangle at the distance said, and no point of any triangle is nearer. */
static void no_point_is_nearer_than_the_nearest(void **state)
{
    (void)state;
    enum { TRIANGLES = 90 };
    test_rng rng = test_rng_seed(0x4ea7);
    for (int trial = 0; trial < 20 * test_multiplier(); trial++) {
        double xyz[9 * TRIANGLES];
        int32_t vertex[3 * TRIANGLES];
        const int32_t nt = 1 + test_index(&rng, TRIANGLES);
        for (int32_t i = 0; i < 3 * nt; i++) {
            vertex[i] = i;
            for (int k = 0; k < 3; k++) {
                xyz[3 * i + k] = test_uniform(&rng, -1.0, 1.0) * (trial % 4 == 3 ? k == 0 : 1.0); /* or on a line */
            }
        }
        sl_nearest *tree = NULL;
        assert_int_equal(sl_nearest_create(xyz, vertex, nt, &tree), SL_OK);
        for (int query = 0; query < 50; query++) {
            double p[3], q[3], distance;
            for (int k = 0; k < 3; k++) {
                p[k] = test_uniform(&rng, -1.5, 1.5);
            }
            const int32_t t = sl_nearest_find(tree, p, q, &distance);
            assert_in_range(t, 0, nt - 1);
            double d2 = 0.0;
            for (int k = 0; k < 3; k++) {
                d2 += (p[k] - q[k]) * (p[k] - q[k]);
            }
            assert_true(test_near(sqrt(d2), distance, 1e-14));
            for (int32_t s = 0; s < nt; s++) {
                double least =
                    HUGE_VAL; /* of triangle s: descent over the weights of its corners from a fine lattice */
                double best[3] = {0};
                for (double step = 0.125; step > 1e-4; step *= 0.25) {
                    const double around[3] = {best[0], best[1], best[2]};
                    const int reach = step == 0.125 ? 8 : 6;
                    for (int i = -reach; i <= reach; i++) {
                        for (int j = -reach; j <= reach; j++) {
                            const double u = around[0] + i * step, v = around[1] + j * step;
                            if (u < 0.0 || v < 0.0 || u + v > 1.0) {
                                continue;
                            }
                            double sum = 0.0;
                            for (int k = 0; k < 3; k++) {
                                const double *x = &xyz[9 * s];
                                const double r = (1.0 - u - v) * x[k] + u * x[3 + k] + v * x[6 + k] - p[k];
                                sum += r * r;
                            }
                            if (sum < least) {
                                least = sum;
                                best[0] = u;
                                best[1] = v;
                            }
                        }
                    }
                }
                assert_true(sqrt(least) >= distance - 1e-12);
                assert_true(s != t || sqrt(least) <= distance + 2e-3);
            }
        }
        sl_nearest_free(tree);
    }
}

/* The plane of an exact mirror, in the normalised mesh, whatever way it stands. */
static void exact_mirrors_are_found_to_the_last_digits(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x3e4);
    for (int trial = 0; trial < 6 * test_multiplier(); trial++) {
        int32_t mirror[1000];
        double T[12];
        model m = model_new();
        model_planted(&m, &rng, 7, 11, trial % 2 == 1, false, mirror);
        model_random_isometry(&rng, false, T);
        model_move(&m, T);
        sl_mesh *mesh = model_build(&m);
        sl_symmetry *s = find_all(mesh, NULL, 64);
        sl_near_mirror near = {0};
        int32_t *match = sl_alloc(mesh->nf, sizeof *match), wrong = 0;
        const sl_symmetry_def def = sl_symmetry_default();
        assert_int_equal(sl_symmetry_near(mesh, &def, NULL, match, &near), SL_OK);
        assert_true(near.found && near.matched == 1.0);
        assert_true(near.misfit_max < 1e-6 && near.misfit_mean <= near.misfit_max);
        double along = 0.0;
        for (int k = 0; k < 3; k++) {
            along += near.normal[k] * T[4 * k];
        }
        assert_true(test_near(fabs(along), 1.0, 1e-9));
        for (int32_t f = 0; f < mesh->nf; f++) {
            wrong += match[f] != sl_symmetry_image(mesh, s, &s->map[0], f);
        }
        assert_true(wrong <= mesh->nf / 10); /* centroids of bent quads lie off their triangles */
        sl_free(match);
        sl_symmetry_free(s);
        sl_mesh_free(mesh);
        model_free(&m);
    }
}

/* A strip more on one side moves the centre of the area, not the plane. */
static void what_one_side_has_alone_does_not_move_the_plane(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x3e8);
    for (int trial = 0; trial < 4 * test_multiplier(); trial++) {
        enum { N = 9, K = 10 };
        int32_t mirror[1000];
        double T[12];
        model m = model_new();
        model_planted(&m, &rng, N, K, false, true, mirror);
        int32_t column[K + 1], count = 0;
        for (int32_t v = 0; v < m.nv; v++) { /* the rim at x = N + 1/2 */
            if (m.xyz[3 * v] > N + 0.2) {
                column[count++] = v;
            }
        }
        assert_int_equal(count, K + 1);
        const int32_t first = m.nv;
        for (int j = 0; j <= K; j++) {
            const double *p = &m.xyz[3 * column[j]];
            model_vertex(&m, p[0] + 0.8, p[1], p[2]);
        }
        for (int j = 0; j < K; j++) {
            model_quad(&m, column[j], first + j, first + j + 1, column[j + 1]);
        }
        model_random_isometry(&rng, false, T);
        model_move(&m, T);
        sl_mesh *mesh = model_build(&m);
        sl_near_mirror near = {0};
        const sl_symmetry_def def = sl_symmetry_default();
        assert_int_equal(sl_symmetry_near(mesh, &def, NULL, NULL, &near), SL_OK);
        assert_true(near.found && near.matched < 1.0);
        for (int32_t v = 0; v < first; v++) {
            if (mirror[v] == v) {
                const double *p = &mesh->xyz[3 * v], *n = near.normal;
                assert_true(test_near(n[0] * p[0] + n[1] * p[1] + n[2] * p[2], near.offset, 1e-9));
            }
        }
        sl_mesh_free(mesh);
        model_free(&m);
    }
}

static void perturbed_mirrors_are_found_with_their_misfit(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x3e5);
    double before = 0.0;
    for (int i = 0; i < 4; i++) {
        static const double size[4] = {1e-4, 1e-3, 1e-2, 5e-2};
        int32_t mirror[1000];
        double T[12];
        model m = model_new();
        model_planted(&m, &rng, 8, 9, false, false, mirror);
        model_perturb(&m, &rng, size[i]);
        model_random_isometry(&rng, false, T);
        model_move(&m, T);
        sl_mesh *mesh = model_build(&m);
        sl_near_mirror near = {0};
        const sl_symmetry_def def = sl_symmetry_default();
        assert_int_equal(sl_symmetry_near(mesh, &def, NULL, NULL, &near), SL_OK);
        const double extent = sl_mesh_diagonal(mesh) / mesh->scale;
        assert_true(near.found);
        assert_true(near.misfit_mean > before && near.misfit_max < 4.0 * size[i] / extent);
        before = near.misfit_mean;
        double along = 0.0;
        for (int k = 0; k < 3; k++) {
            along += near.normal[k] * T[4 * k];
        }
        assert_true(test_near(fabs(along), 1.0, size[i]));
        sl_mesh_free(mesh);
        model_free(&m);
    }
}

static void a_sheet_unlike_its_mirror_images_has_no_near_mirror(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x3e6);
    model m = model_new();
    double height[9][9];
    for (int i = 0; i < 9; i++) {
        for (int j = 0; j < 9; j++) {
            height[i][j] = test_uniform(&rng, -1.0, 1.0);
            model_vertex(&m, i + 0.2 * j, j, height[i][j] + 0.02 * i * i * j);
        }
    }
    for (int i = 0; i < 8; i++) {
        for (int j = 0; j < 8; j++) {
            model_quad(&m, 9 * i + j, 9 * i + 9 + j, 9 * i + 10 + j, 9 * i + 1 + j);
        }
    }
    sl_mesh *mesh = model_build(&m);
    sl_near_mirror near = {0};
    const sl_symmetry_def def = sl_symmetry_default();
    assert_int_equal(sl_symmetry_near(mesh, &def, NULL, NULL, &near), SL_OK);
    assert_false(near.found);
    assert_true(near.matched < 0.6);
    sl_mesh_free(mesh);
    model_free(&m);
}

/* The same bytes with and without workers. */
static void near_mirrors_do_not_depend_on_the_number_of_workers(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x3e7);
    int32_t mirror[4000];
    model m = model_new();
    model_planted(&m, &rng, 30, 40, true, false, mirror);
    model_perturb(&m, &rng, 1e-2);
    sl_mesh *mesh = model_build(&m);
    const sl_symmetry_def def = sl_symmetry_default();
    sl_near_mirror one, other;
    int32_t *match[2] = {sl_alloc(mesh->nf, sizeof *match[0]), sl_alloc(mesh->nf, sizeof *match[1])};
    memset(&one, 0, sizeof one);
    memset(&other, 0, sizeof other);
    sl_thread_pool *pool = NULL;
    assert_int_equal(sl_thread_pool_create(3, &pool), SL_OK);
    const sl_context context = {.executor = sl_thread_pool_executor(pool)};
    assert_int_equal(sl_symmetry_near(mesh, &def, NULL, match[0], &one), SL_OK);
    assert_int_equal(sl_symmetry_near(mesh, &def, &context, match[1], &other), SL_OK);
    assert_memory_equal(&one, &other, sizeof one);
    assert_memory_equal(match[0], match[1], (size_t)mesh->nf * sizeof *match[0]);
    sl_thread_pool_free(pool);
    sl_free(match[0]);
    sl_free(match[1]);
    sl_mesh_free(mesh);
    model_free(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_isometry_is_found_again_from_points),
        cmocka_unit_test(the_fit_is_of_least_squares),
        cmocka_unit_test(eigenvectors_of_three_by_three_are_orthonormal_and_right),
        cmocka_unit_test(no_point_is_nearer_than_the_nearest),
        cmocka_unit_test(exact_mirrors_are_found_to_the_last_digits),
        cmocka_unit_test(what_one_side_has_alone_does_not_move_the_plane),
        cmocka_unit_test(perturbed_mirrors_are_found_with_their_misfit),
        cmocka_unit_test(a_sheet_unlike_its_mirror_images_has_no_near_mirror),
        cmocka_unit_test(near_mirrors_do_not_depend_on_the_number_of_workers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
