/* A chart's energy, its Newton system and its step bound: finite differences, LAPACKE, brute force. */
#include "param/stretch_internal.h"

#include <lapacke.h>

#include "param/distortion.h"
#include "param/stretch_charts.h"
#include "param/tutte.h"

static const double weights[] = {0.0, 0.3, 1.0, -2.0, 0.7};

static void gradient_of(const sl_stretch_rest *rest, int32_t t, double g[4])
{
    for (int k = 0; k < 4; k++) {
        g[k] = rest->strip[t / SL_STRIP].gradient[k][t % SL_STRIP];
    }
}

/* J of triangle t under the map uv. */
static void jacobian_of(const sl_stretch_rest *rest, const int32_t *tri, const double *uv, int32_t t, double J[4])
{
    const double *a = &uv[2 * tri[3 * t]], *b = &uv[2 * tri[3 * t + 1]], *c = &uv[2 * tri[3 * t + 2]];
    double g[4];
    gradient_of(rest, t, g);
    for (int r = 0; r < 2; r++) {
        for (int k = 0; k < 2; k++) {
            J[2 * r + k] = (b[r] - a[r]) * g[k] + (c[r] - a[r]) * g[2 + k];
        }
    }
}

/* A chart with a distorted, flip-free map. */
typedef struct fixture {
    sl_patch *patch;
    double *uv, *gradient, *force;
    sl_stretch_rest rest;
    sl_stretch_freedom freedom;
    sl_stretch_system system;
} fixture;

static fixture make_fixture(uint64_t seed)
{
    fixture f = {.patch = chart_hexagon(3, 0.2, chart_bumps, 1.2, seed)};
    const size_t size = 2 * (size_t)f.patch->nv * sizeof *f.uv;
    test_rng rng = test_rng_seed(seed);
    f.uv = malloc(size);
    f.gradient = malloc(size);
    f.force = malloc(size);
    assert_int_equal(sl_tutte(f.patch, SL_TUTTE_UNIFORM, NULL, f.uv), SL_OK);
    chart_jitter_uv(f.patch, 0.05, f.uv, &rng);
    const sl_stretch_def def = sl_stretch_default();
    assert_int_equal(sl_stretch_rest_init(f.patch, &f.rest), SL_OK);
    assert_int_equal(sl_stretch_freedom_init(f.patch, &def, f.uv, &f.freedom), SL_OK);
    assert_int_equal(sl_stretch_system_init(f.patch, &f.freedom, &f.system), SL_OK);
    return f;
}

static void free_fixture(fixture *f)
{
    sl_stretch_rest_clear(&f->rest);
    sl_stretch_freedom_clear(&f->freedom);
    sl_stretch_system_clear(&f->system);
    sl_patch_free(f->patch);
    free(f->uv);
    free(f->gradient);
    free(f->force);
}

static void assembled_gradient_matches_differences_of_the_measured_energy(void **state)
{
    (void)state;
    fixture f = make_fixture(0x6fad);
    for (size_t k = 0; k < SL_COUNTOF(weights); k++) {
        sl_stretch_assemble(f.patch, &f.rest, &f.freedom, weights[k], INFINITY, f.uv, &f.system, f.gradient, f.force);
        assert_memory_equal(f.gradient, f.force, 2 * (size_t)f.patch->nv * sizeof *f.force);
        for (int32_t i = 0; i < 2 * f.patch->nv; i++) {
            const double old = f.uv[i], h = 1e-6;
            f.uv[i] = old + h;
            const double up = sl_stretch_measure(&f.rest, f.patch->tri, weights[k], f.uv).energy;
            f.uv[i] = old - h;
            const double down = sl_stretch_measure(&f.rest, f.patch->tri, weights[k], f.uv).energy;
            f.uv[i] = old;
            assert_true(test_near_rel((up - down) / (2.0 * h), f.gradient[i], 1e-5));
        }
    }
    free_fixture(&f);
}

/* Sum over triangles of the energy of their softened selves, which are held while uv moves. */
static void softened_force_is_the_gradient_of_the_softened_energy(void **state)
{
    (void)state;
    fixture f = make_fixture(0x50fa);
    const double cap = 0.15;
    sl_stretch_assemble(f.patch, &f.rest, &f.freedom, 0.2, cap, f.uv, &f.system, f.gradient, f.force);
    assert_true(chart_max_diff(f.gradient, f.force, 2 * f.patch->nv) > 0.01);
    sl_stretch_rest soft = {0};
    assert_int_equal(sl_stretch_rest_init(f.patch, &soft), SL_OK);
    for (int32_t t = 0; t < f.patch->nt; t++) {
        double J[4], g[4];
        gradient_of(&soft, t, g);
        jacobian_of(&f.rest, f.patch->tri, f.uv, t, J);
        sl_stretch_soften(cap, J, g);
        for (int k = 0; k < 4; k++) {
            soft.strip[t / SL_STRIP].gradient[k][t % SL_STRIP] = g[k];
        }
    }
    double *same = malloc(2 * (size_t)f.patch->nv * sizeof *same);
    sl_stretch_assemble(f.patch, &soft, &f.freedom, 0.2, INFINITY, f.uv, &f.system, f.gradient, same);
    for (int32_t i = 0; i < 2 * f.patch->nv; i++) {
        assert_true(test_near_rel(f.gradient[i], f.force[i], 1e-10));
    }
    free(same);
    sl_stretch_rest_clear(&soft);
    free_fixture(&f);
}

/* Where no eigenvalue is negative (a map enlarged enough: 2 > 2 (I - d) / d^3) the projected Hessian is the Hessian. */
static void assembled_hessian_matches_differences_of_the_gradient(void **state)
{
    (void)state;
    fixture f = make_fixture(0x4e55);
    const int32_t n = 2 * f.patch->nv;
    for (int32_t i = 0; i < n; i++) {
        f.uv[i] *= 3.0;
    }
    double *H = calloc((size_t)n * (size_t)n, sizeof *H), *up = malloc((size_t)n * sizeof *up);
    double *down = malloc((size_t)n * sizeof *down);
    sl_stretch_assemble(f.patch, &f.rest, &f.freedom, 0.3, INFINITY, f.uv, &f.system, f.gradient, f.force);
    for (int32_t j = 0; j < n; j++) {
        for (int64_t p = f.system.H->colptr[j]; p < f.system.H->colptr[j + 1]; p++) {
            H[f.system.H->row[p] * n + j] = H[j * n + f.system.H->row[p]] = f.system.H->val[p];
        }
    }
    for (int32_t j = 0; j < n; j++) {
        const double old = f.uv[j], h = 1e-5;
        f.uv[j] = old + h;
        sl_stretch_assemble(f.patch, &f.rest, &f.freedom, 0.3, INFINITY, f.uv, &f.system, up, f.force);
        f.uv[j] = old - h;
        sl_stretch_assemble(f.patch, &f.rest, &f.freedom, 0.3, INFINITY, f.uv, &f.system, down, f.force);
        f.uv[j] = old;
        for (int32_t i = 0; i < n; i++) {
            assert_true(test_near((up[i] - down[i]) / (2.0 * h), H[i * n + j], 1e-6));
        }
    }
    free(H);
    free(up);
    free(down);
    free_fixture(&f);
}

static void projected_hessian_is_positive_and_gives_a_descent_direction(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 8; seed++) {
        fixture f = make_fixture(0xd15c + seed);
        const int32_t n = 2 * f.patch->nv;
        double *direction = malloc((size_t)n * sizeof *direction), slope = 0.0;
        for (int32_t i = 0; i < n; i++) {
            f.uv[i] *= 0.4; /* shrunk: many eigenvalues are negative before projection */
        }
        sl_stretch_assemble(f.patch, &f.rest, &f.freedom, 0.0, INFINITY, f.uv, &f.system, f.gradient, f.force);
        double *dense = calloc((size_t)n * (size_t)n, sizeof *dense), *values = malloc((size_t)n * sizeof *values);
        for (int32_t j = 0; j < n; j++) {
            for (int64_t p = f.system.H->colptr[j]; p < f.system.H->colptr[j + 1]; p++) {
                dense[f.system.H->row[p] + j * n] = f.system.H->val[p];
            }
        }
        double *residual = calloc((size_t)n, sizeof *residual);
        assert_int_equal(sl_stretch_direction(&f.freedom, &f.system, f.force, direction), SL_OK);
        for (int32_t i = 0; i < n; i++) {
            slope += direction[i] * f.gradient[i];
            residual[i] = f.gradient[i];
            for (int32_t j = 0; j < n; j++) {
                residual[i] += (i >= j ? dense[i + j * n] : dense[j + i * n]) * direction[j];
            }
        }
        assert_true(slope < 0.0);
        for (int32_t i = 0; i < n; i++) { /* the shift is 1e-10 of the diagonal */
            assert_true(test_near(residual[i], 0.0, 1e-6 * fabs(slope)));
        }
        assert_int_equal(LAPACKE_dsyev(LAPACK_COL_MAJOR, 'N', 'L', n, dense, n, values), 0);
        assert_true(values[0] > -1e-12 * values[n - 1]);
        free(direction);
        free(dense);
        free(values);
        free(residual);
        free_fixture(&f);
    }
}

static void measured_l2_is_that_of_the_distortion_measures(void **state)
{
    (void)state;
    fixture f = make_fixture(0x12);
    double energy = 0.0, area = 0.0;
    for (int32_t t = 0; t < f.patch->nt;
         t++) { /* from the edges' inner products: |J|^2 and det J without coordinates */
        const double *p[3], *u[3];
        double e[2][3], G[4], K[4], A;
        for (int k = 0; k < 3; k++) {
            p[k] = &f.patch->xyz[3 * f.patch->tri[3 * t + k]];
            u[k] = &f.uv[2 * f.patch->tri[3 * t + k]];
        }
        for (int k = 0; k < 3; k++) {
            e[0][k] = p[1][k] - p[0][k];
            e[1][k] = p[2][k] - p[0][k];
        }
        for (int i = 0; i < 2; i++) {
            for (int j = 0; j < 2; j++) {
                G[2 * i + j] = e[i][0] * e[j][0] + e[i][1] * e[j][1] + e[i][2] * e[j][2];
                K[2 * i + j] = (u[i + 1][0] - u[0][0]) * (u[j + 1][0] - u[0][0]) +
                               (u[i + 1][1] - u[0][1]) * (u[j + 1][1] - u[0][1]);
            }
        }
        A = sqrt(chart_determinant(G)) / 2.0;
        const double trace = (K[0] * G[3] + K[3] * G[0] - 2.0 * K[1] * G[1]) / chart_determinant(G); /* tr(inv(G) K) */
        energy += A * (trace + trace * chart_determinant(G) / chart_determinant(K));
        area += A;
    }
    const sl_stretch_sums sums = sl_stretch_measure(&f.rest, f.patch->tri, 0.0, f.uv);
    sl_distortion d;
    assert_int_equal(sl_distortion_measure_indexed(f.patch->nt, f.patch->tri, f.patch->xyz, f.uv, &d), SL_OK);
    assert_true(test_near_rel(sums.energy, energy / area, 1e-11));
    assert_true(test_near_rel(sums.l2, d.l2, 1e-11) && d.l2 > 1.05);
    free_fixture(&f);
}

static void step_bound_is_where_the_first_triangle_vanishes(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xb0d);
    int finite = 0;
    for (int trial = 0; trial < 60 * test_multiplier(); trial++) {
        fixture f = make_fixture(0xb0d + (uint64_t)trial);
        const int32_t n = 2 * f.patch->nv;
        double *direction = malloc((size_t)n * sizeof *direction), *moved = malloc((size_t)n * sizeof *moved);
        const double size = test_uniform(&rng, 0.001, 2.0);
        for (int32_t i = 0; i < n; i++) {
            direction[i] = test_uniform(&rng, -size, size);
        }
        const double bound = sl_stretch_step_bound(&f.rest, f.patch->tri, f.uv, direction);
        for (int k = 1; k <= 101 && isfinite(bound); k++) {
            const double length = k <= 100 ? 0.9999 * bound * k / 100.0 : 1.0001 * bound;
            for (int32_t i = 0; i < n; i++) {
                moved[i] = f.uv[i] + length * direction[i];
            }
            assert_int_equal(chart_flips(f.patch, moved) > 0, k > 100);
            finite++;
        }
        assert_true(isinf(sl_stretch_step_bound(&f.rest, f.patch->tri, f.uv, f.uv))); /* growing: never */
        for (int32_t i = 0; i < n; i++) {
            direction[i] = -0.25 * f.uv[i]; /* shrinking to a point: everything at once */
        }
        assert_true(test_near(sl_stretch_step_bound(&f.rest, f.patch->tri, f.uv, direction), 4.0, 1e-5));
        memset(direction, 0, (size_t)n * sizeof *direction);
        assert_true(isinf(sl_stretch_step_bound(&f.rest, f.patch->tri, f.uv, direction)));
        free(direction);
        free(moved);
        free_fixture(&f);
    }
    assert_true(finite > 1000);
}

/* A triangle on a line has no shape: it gets its longest edge and a hundredth of it as height. */
static void degenerate_triangles_get_a_raised_rest_shape(void **state)
{
    (void)state;
    const double xyz[15] = {0, 0, 0, 1, 0, 0, 0.4, 0, 0, 0.5, -1, 0.2, 0.5, -1, 0.2};
    const int32_t tri[9] = {0, 1, 2, 0, 3, 1, 3, 4, 1};
    sl_patch *patch = chart_make(5, xyz, 3, tri);
    sl_stretch_rest rest = {0};
    assert_int_equal(sl_stretch_rest_init(patch, &rest), SL_OK);
    const double *weight = rest.strip[0].weight, *counted = rest.strip[0].counted;
    const double area = sqrt(1.04) / 2.0, total = area + 0.005 + weight[2] * (area + 0.005) / (1.0 - weight[2]);
    assert_true(counted[0] == 0.0 && counted[1] == weight[1] && counted[2] == 0.0);
    assert_true(test_near(weight[0] * total, 0.005, 1e-14) && test_near(rest.total, total, 1e-14));
    assert_true(test_near(rest.measured_weight, weight[1], 1e-15));
    assert_true(test_near(weight[0] + weight[1] + weight[2], 1.0, 1e-15));
    double J[4];
    int32_t base = 0;
    while (patch->xyz[3 * patch->tri[base]] != 0.0) { /* the corner at the origin */
        base++;
    }
    double uv[10];
    for (int v = 0; v < 5; v++) { /* as it lies, raised by the same height: an isometry */
        const double *x = &patch->xyz[3 * v];
        uv[2 * v] = x[0];
        uv[2 * v + 1] = x[0] == 0.4 ? 0.01 : x[1];
    }
    jacobian_of(&rest, patch->tri, uv, base / 3, J);
    assert_true(test_near(chart_determinant(J), 1.0, 1e-13) && test_near(J[0] * J[0] + J[2] * J[2], 1.0, 1e-13));
    sl_stretch_rest_clear(&rest);
    sl_patch_free(patch);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(assembled_gradient_matches_differences_of_the_measured_energy),
        cmocka_unit_test(softened_force_is_the_gradient_of_the_softened_energy),
        cmocka_unit_test(assembled_hessian_matches_differences_of_the_gradient),
        cmocka_unit_test(projected_hessian_is_positive_and_gives_a_descent_direction),
        cmocka_unit_test(measured_l2_is_that_of_the_distortion_measures),
        cmocka_unit_test(step_bound_is_where_the_first_triangle_vanishes),
        cmocka_unit_test(degenerate_triangles_get_a_raised_rest_shape),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
