/* LSCM against a dense least-squares solve of Levy's equations, in local frames of the 3D triangles. */
#include "param/lscm.h"

#include <lapacke.h>

#include "geom/vec3.h"
#include "param/abf_charts.h"
#include "param/reconstruct_system_internal.h"

/* Corners of triangle t in an orthonormal frame of its plane. */
static void local_frame(const sl_patch *patch, int32_t t, double z[3][2])
{
    const double *p[3];
    double a[3], b[3], x[3], n[3], y[3];
    for (int k = 0; k < 3; k++) {
        p[k] = &patch->xyz[3 * patch->tri[3 * t + k]];
    }
    sl_vec3_sub(p[1], p[0], a);
    sl_vec3_sub(p[2], p[0], b);
    sl_vec3_cross(a, b, n);
    const double length = sl_vec3_norm(a), area = sl_vec3_norm(n);
    for (int k = 0; k < 3; k++) {
        x[k] = a[k] / length;
        n[k] /= area;
    }
    sl_vec3_cross(n, x, y);
    z[0][0] = z[0][1] = z[1][1] = 0.0;
    z[1][0] = length;
    z[2][0] = sl_vec3_dot(b, x);
    z[2][1] = sl_vec3_dot(b, y);
}

/* Two rows a triangle, two columns a vertex: real and imaginary part of sum W_k U_k / sqrt(2 A). Column-major. */
static double *conformal_rows(const sl_patch *patch)
{
    const size_t m = 2 * (size_t)patch->nt;
    double *A = calloc(m * 2 * (size_t)patch->nv, sizeof *A);
    for (int32_t t = 0; t < patch->nt; t++) {
        double z[3][2];
        local_frame(patch, t, z);
        const double root = sqrt(z[1][0] * z[2][1]);
        for (int k = 0; k < 3; k++) {
            const double *from = z[(k + 1) % 3], *to = z[(k + 2) % 3];
            const double re = (to[0] - from[0]) / root, im = (to[1] - from[1]) / root;
            const size_t x = 2 * (size_t)patch->tri[3 * t + k] * m, row = 2 * (size_t)t;
            A[x + row] = re;
            A[x + m + row] = -im;
            A[x + row + 1] = im;
            A[x + m + row + 1] = re;
        }
    }
    return A;
}

static void dense_lscm(const sl_patch *patch, double *uv)
{
    sl_layout layout;
    assert_int_equal(sl_layout_init(&layout, patch), SL_OK);
    const size_t m = 2 * (size_t)patch->nt;
    double *full = conformal_rows(patch), *A = malloc(m * 2 * (size_t)patch->nv * sizeof *A),
           *b = malloc(m * sizeof *b);
    const double length = sl_vec3_distance(&patch->xyz[3 * layout.pin[0]], &patch->xyz[3 * layout.pin[1]]);
    for (size_t r = 0; r < m; r++) {
        b[r] = -length * full[2 * (size_t)layout.pin[1] * m + r];
    }
    for (int32_t v = 0; v < patch->nv; v++) {
        if (layout.unknown[v] >= 0) {
            memcpy(&A[2 * (size_t)layout.unknown[v] * m], &full[2 * (size_t)v * m], 2 * m * sizeof *A);
        }
    }
    const lapack_int rows = (lapack_int)m, cols = 2 * layout.nfree;
    assert_true(rows >= cols);
    assert_int_equal(LAPACKE_dgels(LAPACK_COL_MAJOR, 'N', rows, cols, 1, A, rows, b, rows), 0);
    for (int32_t v = 0; v < patch->nv; v++) {
        for (int k = 0; k < 2; k++) {
            const int32_t f = layout.unknown[v];
            uv[2 * v + k] = f >= 0 ? b[2 * f + k] : v == layout.pin[1] && k == 0 ? length : 0.0;
        }
    }
    const double scale = sqrt(chart_area(patch) / chart_uv_area(patch, uv));
    for (int32_t i = 0; i < 2 * patch->nv; i++) {
        uv[i] *= scale;
    }
    sl_layout_clear(&layout);
    free(full);
    free(A);
    free(b);
}

static void lscm_matches_a_dense_least_squares_solve(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 6; seed++) {
        sl_patch *patches[] = {
            chart_grid(5, 4, 0.2, chart_bumps, 1.5, seed), chart_hexagon(3, 0.2, chart_cap, 1.4, seed),
            chart_hexagon(2, 0.2, chart_cone, 2.0, seed), chart_grid(6, 1, 0.2, chart_bumps, 2.0, seed)};
        for (size_t i = 0; i < SL_COUNTOF(patches); i++) {
            double uv[2 * 64], dense[2 * 64];
            assert_int_equal(sl_lscm(patches[i], NULL, uv), SL_OK);
            dense_lscm(patches[i], dense);
            assert_true(chart_max_diff(uv, dense, 2 * patches[i]->nv) <= 1e-12);
            assert_true(test_near_rel(chart_uv_area(patches[i], uv), chart_area(patches[i]), 1e-13));
            sl_patch_free(patches[i]);
        }
    }
}

/* The matrix is A' A of the same rows, x and y of inner edges apart. */
static void check_matrix(const sl_patch *patch)
{
    sl_layout layout;
    assert_int_equal(sl_layout_init(&layout, patch), SL_OK);
    for (int32_t t = 0; t < patch->nt; t++) {
        double z[3][2];
        local_frame(patch, t, z);
        for (int k = 0; k < 3; k++) {
            layout.cot[3 * t + k] = 1.0 / tan(chart_angle(z[k], z[(k + 1) % 3], z[(k + 2) % 3]));
        }
    }
    sl_csc *N = NULL;
    assert_int_equal(sl_layout_pattern(&layout, &N), SL_OK);
    assert_int_equal(sl_csc_check(N, true), SL_OK);
    const size_t m = 2 * (size_t)patch->nt;
    double *A = conformal_rows(patch);
    int64_t stored = 0;
    for (int32_t v = 0; v < 2 * patch->nv; v++) {
        for (int32_t w = 0; w < 2 * patch->nv; w++) {
            const int32_t i = 2 * layout.unknown[v / 2] + v % 2, j = 2 * layout.unknown[w / 2] + w % 2;
            if (i < j || j < 0) {
                continue;
            }
            double expected = 0.0, found = 0.0;
            for (size_t r = 0; r < m; r++) {
                expected += A[(size_t)v * m + r] * A[(size_t)w * m + r];
            }
            for (int64_t p = N->colptr[j]; p < N->colptr[j + 1]; p++) {
                found += N->row[p] == i ? N->val[p] : 0.0;
                stored += N->row[p] == i;
            }
            assert_true(test_near(found, expected, 1e-12));
        }
    }
    assert_true(stored == N->colptr[N->ncols]);
    sl_csc_free(N);
    sl_layout_clear(&layout);
    free(A);
}

static void matrix_is_the_normal_matrix_of_levys_equations(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 3; seed++) {
        sl_patch *patch = chart_grid(4, 5, 0.25, chart_bumps, 1.2, seed);
        check_matrix(patch);
        sl_patch_free(patch);
    }
}

/* An inner vertex of two triangles, 0 between 1 and 2: two different edges join 1 and 2. Extracted charts have such. */
static void matrix_adds_up_edges_that_join_the_same_vertices(void **state)
{
    (void)state;
    double xyz[] = {0.1, 0.2, 0.7, 1.1, 0.3, 0.2, -0.9, 0.1, 0.4, 0.2, 1.2, 0.3, 0.3, -0.8, 0.9}, uv[10];
    int32_t tri[] = {0, 1, 2, 0, 2, 1, 2, 1, 3, 1, 2, 4};
    int32_t twin[] = {5, 6, 3, 2, 9, 0, 1, -1, -1, 4, -1, -1}, outgoing[] = {0, 7, 10, 8, 11};
    uint8_t border[] = {0, 1, 1, 1, 1};
    const sl_patch patch = {.nv = 5,
                            .nt = 4,
                            .xyz = xyz,
                            .tri = tri,
                            .twin = twin,
                            .outgoing = outgoing,
                            .border = border,
                            .loops = 1,
                            .euler = 1};
    check_matrix(&patch);
    assert_int_equal(sl_lscm(&patch, NULL, uv), SL_OK);
    assert_true(isfinite(uv[0]) && isfinite(uv[1]));
}

static void pins_are_far_apart_on_the_border(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 8; seed++) {
        sl_patch *patch = chart_grid(6, 3, 0.2, chart_bumps, 1.0, seed);
        sl_layout layout;
        assert_int_equal(sl_layout_init(&layout, patch), SL_OK);
        const double *a = &patch->xyz[3 * layout.pin[0]], *b = &patch->xyz[3 * layout.pin[1]];
        double widest = 0.0;
        for (int32_t v = 0; v < patch->nv; v++) {
            for (int32_t w = 0; w < v; w++) {
                widest = fmax(widest, sl_vec3_distance(&patch->xyz[3 * v], &patch->xyz[3 * w]));
            }
            assert_true(patch->border[v] == 0 || sl_vec3_distance(a, &patch->xyz[3 * v]) <= sl_vec3_distance(a, b));
        }
        assert_true(patch->border[layout.pin[0]] == 1 && patch->border[layout.pin[1]] == 1);
        assert_true(sl_vec3_distance(a, b) > 0.8 * widest);
        assert_int_equal(layout.nfree, patch->nv - 2);
        sl_layout_clear(&layout);
        sl_patch_free(patch);
    }
}

/* A flat chart: all distances are kept, the orientation too, the first pin lies at the origin. */
static void flat_charts_are_mapped_isometrically(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 8; seed++) {
        sl_patch *patch = chart_grid(7, 8, 0.3, chart_plane, 0.7, seed);
        double uv[2 * 72];
        sl_layout layout;
        assert_int_equal(sl_layout_init(&layout, patch), SL_OK);
        assert_int_equal(sl_lscm(patch, NULL, uv), SL_OK);
        assert_true(uv[2 * layout.pin[0]] == 0.0 && uv[2 * layout.pin[0] + 1] == 0.0);
        assert_true(chart_uv_area(patch, uv) > 0.0);
        for (int32_t v = 0; v < patch->nv; v++) {
            for (int32_t w = 0; w < v; w++) {
                const double d = hypot(uv[2 * v] - uv[2 * w], uv[2 * v + 1] - uv[2 * w + 1]);
                assert_true(test_near(d, sl_vec3_distance(&patch->xyz[3 * v], &patch->xyz[3 * w]), 1e-12));
            }
        }
        sl_layout_clear(&layout);
        sl_patch_free(patch);
    }
}

static void powers_of_two_scale_the_map_exactly_and_rigid_motions_leave_it(void **state)
{
    (void)state;
    sl_patch *patch = chart_hexagon(4, 0.2, chart_cap, 1.4, 0x2b);
    double uv[2 * 61], other[2 * 61];
    assert_int_equal(sl_lscm(patch, NULL, uv), SL_OK);
    for (int32_t i = 0; i < 3 * patch->nv; i++) {
        patch->xyz[i] *= 0x1p-40;
    }
    assert_int_equal(sl_lscm(patch, NULL, other), SL_OK);
    for (int32_t i = 0; i < 2 * patch->nv; i++) {
        assert_true(other[i] * 0x1p40 == uv[i]);
    }
    chart_move(patch, 0x1p40, (double[]){-2.2, 0.7, 1.9});
    assert_int_equal(sl_lscm(patch, NULL, other), SL_OK);
    assert_true(chart_max_diff(uv, other, 2 * patch->nv) <= 1e-12);
    sl_patch_free(patch);
}

static void a_single_triangle_keeps_its_shape(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x3);
    for (int trial = 0; trial < 50 * test_multiplier(); trial++) {
        double xyz[9], uv[6], beta[3], alpha[3];
        for (int i = 0; i < 9; i++) {
            xyz[i] = test_uniform(&rng, -1.0, 1.0) * (i % 3 == trial % 4 ? 1e-3 : 1.0);
        }
        sl_patch *patch = chart_make(3, xyz, 1, (const int32_t[]){0, 1, 2});
        assert_int_equal(sl_lscm(patch, NULL, uv), SL_OK);
        double z[3][2];
        local_frame(patch, 0, z);
        for (int k = 0; k < 3; k++) {
            beta[k] = chart_angle(z[k], z[(k + 1) % 3], z[(k + 2) % 3]);
        }
        chart_uv_angles(patch, uv, alpha);
        assert_true(chart_max_diff(alpha, beta, 3) <= 1e-9);
        assert_true(test_near_rel(chart_uv_area(patch, uv), chart_area(patch), 1e-12));
        sl_patch_free(patch);
    }
}

/* Inner edges split at points on them: triangles without any area between sound ones. */
static void degenerate_triangles_leave_the_rest_sound(void **state)
{
    (void)state;
    const double xyz[] = {0, 0, 0.1, 1.1, 0.1, 0.1, 0.9, 1.2, 0.1, -0.2, 0.8, 0.1, 0.45, 0.6, 0.1, 0.45, 0.6, 0.1};
    /* vertices 4 and 5 are one point on the diagonal 0-2 */
    static const int32_t tri[] = {0, 1, 4, 1, 2, 4, 0, 4, 5, 2, 5, 4, 0, 5, 3, 5, 2, 3};
    sl_patch *patch = chart_make(6, xyz, 6, tri);
    double uv[12], beta[18], alpha[18];
    assert_int_equal(sl_lscm(patch, NULL, uv), SL_OK);
    chart_uv_angles(patch, uv, alpha);
    for (int32_t c = 0; c < 18; c++) {
        double z[3][2];
        assert_true(isfinite(uv[c % 12]));
        if (c / 3 != 2 && c / 3 != 3) {
            local_frame(patch, c / 3, z);
            beta[c] = chart_angle(z[c % 3], z[(c + 1) % 3], z[(c + 2) % 3]);
            assert_true(test_near(alpha[c], beta[c], 1e-4));
        }
    }
    sl_patch_free(patch);
}

/* Needles and caps with aspect ratios up to 1e7, flat, so that the result is known. */
static void slivers_keep_their_lengths(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x511);
    for (int trial = 0; trial < 10; trial++) {
        sl_patch *patch = chart_grid(6, 6, 0.2, chart_plane, 0.3, 0x511 + (uint64_t)trial);
        double worst = 0.0, uv[2 * 49];
        const double squeeze = pow(10.0, -test_uniform(&rng, 2.0, 5.0));
        for (int32_t v = 0; v < patch->nv; v++) { /* along the plane's first axis only */
            double *x = &patch->xyz[3 * v];
            const double u = 0.36 * (x[0] - 0.3) + 0.48 * x[1] + 0.8 * x[2];
            const double move[3] = {0.36 * u * (squeeze - 1.0), 0.48 * u * (squeeze - 1.0), 0.8 * u * (squeeze - 1.0)};
            sl_vec3_add(x, move, x);
        }
        assert_int_equal(sl_lscm(patch, NULL, uv), SL_OK);
        for (int32_t c = 0; c < 3 * patch->nt; c++) {
            const int32_t v = patch->tri[c], w = patch->tri[sl_corner_next(c)];
            const double d = hypot(uv[2 * v] - uv[2 * w], uv[2 * v + 1] - uv[2 * w + 1]);
            worst = fmax(worst, fabs(d - sl_vec3_distance(&patch->xyz[3 * v], &patch->xyz[3 * w])));
        }
        assert_true(test_near(worst, 0.0, 1e-9));
        sl_patch_free(patch);
    }
}

static void charts_without_a_unique_map_are_refused(void **state)
{
    (void)state;
    static const double xyz[] = {0.1, 0.2, 0.3, 1.2, 0.1, 0.4, 0.5, 0.9, 0.2, 0.4, 0.3, 1.1, 2, 2, 2, 3, 2, 2, 2, 3, 2};
    static const int32_t closed[] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3}, two[] = {0, 1, 2, 4, 5, 6};
    double uv[14];
    sl_patch *patch = chart_make(4, xyz, 4, closed);
    assert_int_equal(sl_lscm(patch, NULL, uv), SL_SINGULAR);
    sl_patch_free(patch);
    patch = chart_make(7, xyz, 2, two);
    assert_int_equal(sl_lscm(patch, NULL, uv), SL_SINGULAR);
    sl_patch_free(patch);
    patch = chart_make(0, xyz, 0, closed);
    assert_int_equal(sl_lscm(patch, NULL, uv), SL_SINGULAR);
    sl_patch_free(patch);
}

static void lscm_can_be_cancelled(void **state)
{
    (void)state;
    sl_patch *patch = chart_hexagon(3, 0.2, chart_cap, 1.0, 0xcc);
    double uv[2 * 37];
    for (int calls = 0; calls < 2; calls++) {
        int left = calls;
        const sl_context context = {.progress = chart_cancel_after, .progress_user = &left};
        assert_int_equal(sl_lscm(patch, &context, uv), SL_CANCELLED);
    }
    sl_patch_free(patch);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lscm_matches_a_dense_least_squares_solve),
        cmocka_unit_test(matrix_is_the_normal_matrix_of_levys_equations),
        cmocka_unit_test(matrix_adds_up_edges_that_join_the_same_vertices),
        cmocka_unit_test(pins_are_far_apart_on_the_border),
        cmocka_unit_test(flat_charts_are_mapped_isometrically),
        cmocka_unit_test(powers_of_two_scale_the_map_exactly_and_rigid_motions_leave_it),
        cmocka_unit_test(a_single_triangle_keeps_its_shape),
        cmocka_unit_test(degenerate_triangles_leave_the_rest_sound),
        cmocka_unit_test(slivers_keep_their_lengths),
        cmocka_unit_test(charts_without_a_unique_map_are_refused),
        cmocka_unit_test(lscm_can_be_cancelled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
