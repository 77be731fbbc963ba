/* One triangle's energy and the Newton system: finite differences, LAPACKE, brute force. */
#include "param/stretch_internal.h"

#include <lapacke.h>

#include "param/stretch_charts.h"

static const double weights[] = {0.0, 0.3, 1.0, -2.0, 0.7};

/* A random matrix of positive determinant, singular values from 0.05 to 20. */
static void random_jacobian(test_rng *rng, double J[4])
{
    const double a = test_uniform(rng, 0.0, 7.0), b = test_uniform(rng, 0.0, 7.0);
    const double s1 = exp(test_uniform(rng, -3.0, 3.0)), s2 = exp(test_uniform(rng, -3.0, 3.0));
    const double ca = cos(a), sa = sin(a), cb = cos(b), sb = sin(b);
    J[0] = ca * s1 * cb - sa * s2 * sb;
    J[1] = -ca * s1 * sb - sa * s2 * cb;
    J[2] = sa * s1 * cb + ca * s2 * sb;
    J[3] = -sa * s1 * sb + ca * s2 * cb;
}

/* Singular values by LAPACKE, ascending. */
static void singular_values(const double J[4], double s[2])
{
    double copy[4], u[4], vt[4], both[2], super[2];
    memcpy(copy, J, sizeof copy);
    assert_int_equal(LAPACKE_dgesvd(LAPACK_ROW_MAJOR, 'A', 'A', 2, 2, copy, 2, both, u, 2, vt, 2, super), 0);
    s[0] = both[1];
    s[1] = both[0];
}

/* The 4 x 4 Hessian from psi(trace of J'J, det J) by the chain rule: no eigenvalue, no rotation. */
static void hessian_by_chain_rule(double w, const double J[4], double H[16])
{
    const double cof[4] = {J[3], -J[2], -J[1], J[0]};
    const double d = chart_determinant(J), trace = J[0] * J[0] + J[1] * J[1] + J[2] * J[2] + J[3] * J[3];
    const double psi_t = 1.0 - w + 1.0 / (d * d), psi_d = 2.0 * w - 2.0 * trace / (d * d * d);
    const double psi_td = -2.0 / (d * d * d), psi_dd = 6.0 * trace / (d * d * d * d);
    static const double second[16] = {0, 0, 0, 1, 0, 0, -1, 0, 0, -1, 0, 0, 1, 0, 0, 0}; /* of d */
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 4; j++) {
            H[4 * i + j] = 2.0 * psi_t * (i == j) + psi_d * second[4 * i + j] + psi_dd * cof[i] * cof[j] +
                           2.0 * psi_td * (J[i] * cof[j] + cof[i] * J[j]);
        }
    }
}

/* Random strips: any shape, any place, weights with zeros at the end. */
static void random_strip(test_rng *rng, sl_strip_rest *rest, sl_strip_corners corners, double J[4][SL_STRIP])
{
    for (int l = 0; l < SL_STRIP; l++) {
        double j[4];
        random_jacobian(rng, j);
        if (l % 11 == 3) { /* a similarity */
            j[2] = -j[1];
            j[3] = j[0];
        }
        for (int k = 0; k < 4; k++) {
            J[k][l] = j[k];
            rest->gradient[k][l] = test_uniform(rng, -2.0, 2.0);
        }
        for (int k = 0; k < 6; k++) {
            corners[k][l] = test_uniform(rng, -1.0, 1.0);
        }
        rest->weight[l] = l < 27 ? test_uniform(rng, 0.1, 1.0) : 0.0;
        rest->counted[l] = l % 5 == 1 ? 0.0 : rest->weight[l];
    }
}

/* K = G P G' with P the projection, by LAPACKE, of the Hessian in J and G the hat functions' gradients. */
static void projected_by_lapacke(double w, const double J[4], double gradient[4][SL_STRIP], int l, double K[6][6])
{
    double H[16], values[4], G[6][4] = {{0.0}};
    hessian_by_chain_rule(w, J, H);
    assert_int_equal(LAPACKE_dsyev(LAPACK_ROW_MAJOR, 'V', 'U', 4, H, 4, values), 0);
    for (int r = 0; r < 2; r++) {
        for (int c = 0; c < 2; c++) { /* u (r = 0) or v of corner k changes J[2 r + c] by its gradient's c */
            G[2 + r][2 * r + c] = gradient[c][l];
            G[4 + r][2 * r + c] = gradient[2 + c][l];
            G[r][2 * r + c] = -gradient[c][l] - gradient[2 + c][l];
        }
    }
    memset(K, 0, 36 * sizeof K[0][0]);
    for (int m = 0; m < 4; m++) {
        double q[6] = {0.0};
        for (int i = 0; i < 6; i++) {
            for (int e = 0; e < 4; e++) {
                q[i] += G[i][e] * H[4 * e + m];
            }
        }
        for (int i = 0; i < 36; i++) {
            K[i / 6][i % 6] += fmax(values[m], 0.0) * q[i / 6] * q[i % 6];
        }
    }
}

static void elements_are_the_projected_hessians_lapacke_finds(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xe16e);
    for (int trial = 0; trial < 100 * test_multiplier(); trial++) {
        sl_strip_rest rest;
        sl_strip_corners corners;
        double J[4][SL_STRIP], element[SL_ELEMENT][SL_STRIP];
        const double w = weights[trial % 5];
        random_strip(&rng, &rest, corners, J);
        sl_stretch_kernels_best()->element(w, rest.weight, rest.gradient, J, element);
        for (int l = 0; l < SL_STRIP; l++) {
            const double j[4] = {J[0][l], J[1][l], J[2][l], J[3][l]};
            double K[6][6], largest = 0.0;
            projected_by_lapacke(w, j, rest.gradient, l, K);
            for (int i = 0; i < 36; i++) {
                largest = fmax(largest, fabs(K[i / 6][i % 6]));
            }
            for (int i = 0; i < 36; i++) {
                const double have = element[sl_stretch_entry(i / 6, i % 6)][l];
                assert_true(test_near(have / largest, rest.weight[l] * K[i / 6][i % 6] / largest, 1e-10));
            }
        }
    }
}

static void every_set_of_kernels_gives_the_same_bytes(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x5a3e);
    for (int trial = 0; trial < 40 * test_multiplier(); trial++) {
        sl_strip_rest rest;
        sl_strip_corners corners, along, force[2];
        double J[4][SL_STRIP], element[2][SL_ELEMENT][SL_STRIP], other[2][4][SL_STRIP], bound[2][SL_STRETCH_LANES];
        sl_stretch_lanes lanes[2];
        const double w = weights[trial % 5];
        random_strip(&rng, &rest, along, J);
        random_strip(&rng, &rest, corners, J);
        for (int32_t k = 0; sl_stretch_kernels_at(k) != NULL; k++) {
            const sl_stretch_kernels *kernels = sl_stretch_kernels_at(k);
            const int to = k > 0;
            memset(&lanes[to], 0, sizeof *lanes);
            for (int l = 0; l < SL_STRETCH_LANES; l++) {
                bound[to][l] = lanes[to].least[l] = lanes[to].sure[l] = INFINITY;
            }
            kernels->jacobian(corners, rest.gradient, other[to]);
            kernels->force(w, rest.weight, rest.gradient, J, force[to]);
            kernels->element(w, rest.weight, rest.gradient, J, element[to]);
            kernels->measure(w, &rest, corners, &lanes[to]);
            kernels->bound(corners, along, bound[to]);
            if (k > 0) {
                assert_memory_equal(other[0], other[1], sizeof other[0]);
                assert_memory_equal(force[0], force[1], sizeof force[0]);
                assert_memory_equal(element[0], element[1], sizeof element[0]);
                assert_memory_equal(&lanes[0], &lanes[1], sizeof lanes[0]);
                assert_memory_equal(bound[0], bound[1], sizeof bound[0]);
            }
        }
    }
}

static void softening_bounds_singular_values_and_keeps_directions(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x50f7);
    int softened = 0;
    for (int trial = 0; trial < 300 * test_multiplier(); trial++) {
        double J[4], F[4], g[4] = {1.3, -0.2, 0.4, 0.9}, s[2], f[2], uv[4];
        random_jacobian(&rng, J);
        memcpy(F, J, sizeof F);
        /* J = u g' for two edge vectors u, so that u g'_soft must be F. */
        const double dg = chart_determinant(g);
        for (int r = 0; r < 2; r++) {
            uv[r] = (J[2 * r] * g[3] - J[2 * r + 1] * g[2]) / dg;
            uv[2 + r] = (J[2 * r + 1] * g[0] - J[2 * r] * g[1]) / dg;
        }
        const double cap = test_uniform(&rng, 0.2, 2.5);
        singular_values(J, s);
        const double far = fmax(fabs(log(s[0])), fabs(log(s[1])));
        assert_int_equal(sl_stretch_soften(cap, F, g), far > cap);
        softened += far > cap;
        singular_values(F, f);
        const double t = far > cap ? cap / far : 1.0;
        assert_true(test_near_rel(f[0], pow(s[0], t), 1e-9) && test_near_rel(f[1], pow(s[1], t), 1e-9));
        for (int r = 0; r < 2; r++) {
            assert_true(test_near_rel(F[2 * r], uv[r] * g[0] + uv[2 + r] * g[2], 1e-9));
            assert_true(test_near_rel(F[2 * r + 1], uv[r] * g[1] + uv[2 + r] * g[3], 1e-9));
        }
        /* F = J B with B symmetric positive definite commuting with J'J: same directions. */
        const double a = J[0] * J[0] + J[2] * J[2], b = J[0] * J[1] + J[2] * J[3], c = J[1] * J[1] + J[3] * J[3];
        const double p = F[0] * F[0] + F[2] * F[2], q = F[0] * F[1] + F[2] * F[3], r = F[1] * F[1] + F[3] * F[3];
        assert_true(test_near((b * (p - r) - q * (a - c)) / ((a + c) * (p + r)), 0.0, 1e-9));
        assert_true(chart_determinant(F) > 0.0);
    }
    assert_true(softened > 50 && softened < 300 * test_multiplier());
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(elements_are_the_projected_hessians_lapacke_finds),
        cmocka_unit_test(every_set_of_kernels_gives_the_same_bytes),
        cmocka_unit_test(softening_bounds_singular_values_and_keeps_directions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
