/* Layout from angles: drawings whose angles are known. */
#include "param/abf.h"
#include "param/abf_charts.h"
#include "param/reconstruct_internal.h"

/* Angles of a drawing, all its triangles being positive. */
static void angles_of(const sl_patch *patch, const double *drawing, double *alpha)
{
    chart_uv_angles(patch, drawing, alpha);
    for (int32_t c = 0; c < 3 * patch->nt; c++) {
        assert_true(alpha[c] > 0.0);
    }
}

/* Largest distance between a layout and the drawing, after the similarity that takes two vertices onto theirs, relative
 * to the drawing's size. */
static double misfit(const sl_patch *patch, const double *uv, const double *drawing, int32_t a, int32_t b)
{
    const double x = uv[2 * b] - uv[2 * a], y = uv[2 * b + 1] - uv[2 * a + 1];
    const double p = drawing[2 * b] - drawing[2 * a], q = drawing[2 * b + 1] - drawing[2 * a + 1];
    const double n = x * x + y * y, re = (p * x + q * y) / n, im = (q * x - p * y) / n;
    double worst = 0.0, size = 0.0;
    for (int32_t v = 0; v < patch->nv; v++) {
        const double dx = uv[2 * v] - uv[2 * a], dy = uv[2 * v + 1] - uv[2 * a + 1];
        const double ex = re * dx - im * dy - (drawing[2 * v] - drawing[2 * a]);
        const double ey = im * dx + re * dy - (drawing[2 * v + 1] - drawing[2 * a + 1]);
        worst = fmax(worst, hypot(ex, ey));
        size = fmax(size, hypot(drawing[2 * v] - drawing[2 * a], drawing[2 * v + 1] - drawing[2 * a + 1]));
    }
    return worst / size;
}

/* A drawing of a grid whose scale varies by exp(growth) from one end to the other. */
static sl_patch *stretched_drawing(double growth, uint64_t seed, double **drawing)
{
    sl_patch *patch = chart_grid(12, 5, 0.2, chart_bumps, 0.3, seed);
    *drawing = malloc(2 * (size_t)patch->nv * sizeof **drawing);
    for (int32_t v = 0; v < patch->nv; v++) {
        const double x = patch->xyz[3 * v], y = patch->xyz[3 * v + 1] / 1.3, turn = 0.5 * y;
        (*drawing)[2 * v] = exp(growth * x) * cos(turn);
        (*drawing)[2 * v + 1] = exp(growth * x) * sin(turn);
    }
    return patch;
}

static void layouts_of_a_drawings_angles_are_the_drawing(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 10; seed++) {
        double *drawing;
        sl_patch *patch = stretched_drawing(0.4 * (double)seed, seed, &drawing);
        const size_t nc = 3 * (size_t)patch->nt;
        double *alpha = malloc(nc * sizeof *alpha), *found = malloc(nc * sizeof *found);
        double *uv = malloc(2 * (size_t)patch->nv * sizeof *uv);
        angles_of(patch, drawing, alpha);
        assert_int_equal(sl_abf_reconstruct(patch, alpha, NULL, uv), SL_OK);
        chart_uv_angles(patch, uv, found);
        assert_true(test_near(chart_max_diff(alpha, found, (int64_t)nc), 0.0, 1e-10));
        assert_true(test_near(misfit(patch, uv, drawing, 3, patch->nv - 5), 0.0, 1e-10));
        assert_true(test_near_rel(chart_uv_area(patch, uv), chart_area(patch), 1e-13));
        free(alpha);
        free(found);
        free(uv);
        free(drawing);
        sl_patch_free(patch);
    }
}

/* Scales that differ by four to ten orders of magnitude: what limbs do. The angles of the smallest triangles are as
 * good as positions in doubles can tell them: that takes the refinement. */
static void angles_survive_scales_of_many_orders_of_magnitude(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 12; seed++) {
        const double growth = 10.0 + 6.0 * (double)(seed % 3);
        double *drawing;
        sl_patch *patch = stretched_drawing(growth, seed, &drawing);
        const size_t nc = 3 * (size_t)patch->nt;
        double *alpha = malloc(nc * sizeof *alpha), *found = malloc(nc * sizeof *found);
        double *uv = malloc(2 * (size_t)patch->nv * sizeof *uv);
        angles_of(patch, drawing, alpha);
        assert_int_equal(sl_abf_reconstruct(patch, alpha, NULL, uv), SL_OK);
        chart_uv_angles(patch, uv, found);
        assert_true(test_near(chart_max_diff(alpha, found, (int64_t)nc), 0.0, 32.0 * TEST_EPS * exp(growth)));
        free(alpha);
        free(found);
        free(uv);
        free(drawing);
        sl_patch_free(patch);
    }
}

/* Energy of a layout for given angles, from the definition: squared distance of each triangle from the similar one on
 * its first edge, times the weight that makes it independent of the edge chosen. */
static double conformal_energy(const sl_patch *patch, const double *alpha, const double *uv)
{
    double energy = 0.0;
    for (int32_t t = 0; t < patch->nt; t++) {
        const double *a = &alpha[3 * t], *p[3];
        for (int k = 0; k < 3; k++) {
            p[k] = &uv[2 * patch->tri[3 * t + k]];
        }
        const double ratio = sin(a[1]) / sin(a[2]), c = ratio * cos(a[0]), s = ratio * sin(a[0]);
        const double x = p[1][0] - p[0][0], y = p[1][1] - p[0][1];
        const double ex = p[2][0] - p[0][0] - (c * x - s * y), ey = p[2][1] - p[0][1] - (s * x + c * y);
        energy += (ex * ex + ey * ey) * sin(a[2]) / (sin(a[0]) * sin(a[1]));
    }
    return energy;
}

/* Angles no drawing has: the layout is a minimum over all vertices but the two pins. */
static void layouts_of_contradictory_angles_minimise_the_energy(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xc0);
    for (uint64_t seed = 1; seed <= 6; seed++) {
        sl_patch *patch = chart_hexagon(3, 0.2, chart_cap, 1.2, seed);
        double alpha[3 * 54], uv[2 * 37];
        for (int32_t t = 0; t < patch->nt; t++) {
            alpha[3 * t] = test_uniform(&rng, 0.6, 1.4);
            alpha[3 * t + 1] = test_uniform(&rng, 0.6, 1.4);
            alpha[3 * t + 2] = TEST_PI - alpha[3 * t] - alpha[3 * t + 1];
        }
        assert_int_equal(sl_abf_reconstruct(patch, alpha, NULL, uv), SL_OK);
        const double least = conformal_energy(patch, alpha, uv), h = 1e-4;
        int32_t free_coordinates = 0;
        assert_true(least > 1e-3);
        for (int32_t i = 0; i < 2 * patch->nv; i++) {
            const double x = uv[i];
            uv[i] = x + h;
            const double above = conformal_energy(patch, alpha, uv);
            uv[i] = x - h;
            const double below = conformal_energy(patch, alpha, uv);
            uv[i] = x;
            free_coordinates += fabs(above - below) <= 1e-11 && above > least && below > least;
        }
        assert_true(free_coordinates >= 2 * patch->nv - 4); /* the pins' forces balance, but not to zero */
        sl_patch_free(patch);
    }
}

/* Angles off by a factor, zero or not finite are made fit before use. */
static void unfit_angles_are_corrected(void **state)
{
    (void)state;
    double *drawing;
    sl_patch *patch = stretched_drawing(0.7, 0x0f, &drawing);
    const size_t nc = 3 * (size_t)patch->nt;
    double *alpha = malloc(nc * sizeof *alpha), uv[2 * 78], other[2 * 78];
    angles_of(patch, drawing, alpha);
    assert_int_equal(sl_abf_reconstruct(patch, alpha, NULL, uv), SL_OK);
    for (size_t c = 0; c < nc; c++) {
        alpha[c] *= 1.25; /* sums of 225 degrees */
    }
    assert_int_equal(sl_abf_reconstruct(patch, alpha, NULL, other), SL_OK);
    assert_true(chart_max_diff(uv, other, 2 * patch->nv) <= 1e-11);
    alpha[3] = 0.0;
    alpha[4] = NAN;
    alpha[31] = -0.3;
    alpha[40] = INFINITY;
    alpha[48] = alpha[49] = 4.0; /* nothing left for the third */
    alpha[50] = 1e-9;
    assert_int_equal(sl_abf_reconstruct(patch, alpha, NULL, other), SL_OK);
    for (int32_t i = 0; i < 2 * patch->nv; i++) {
        assert_true(isfinite(other[i]));
    }
    free(alpha);
    free(drawing);
    sl_patch_free(patch);
}

static void charts_without_area_are_left_unscaled(void **state)
{
    (void)state;
    const double xyz[] = {0.0, 0.25, 0.0, 1.5, 0.25, 0.0, 0.5, 0.25, 0.0};
    const double alpha[] = {0.7, 0.9, TEST_PI - 1.6};
    double uv[6], found[3];
    sl_patch *patch = chart_make(3, xyz, 1, (const int32_t[]){0, 1, 2});
    assert_int_equal(sl_abf_reconstruct(patch, alpha, NULL, uv), SL_OK);
    chart_uv_angles(patch, uv, found);
    assert_true(chart_max_diff(alpha, found, 3) <= 1e-14);
    assert_true(test_near(hypot(uv[2] - uv[0], uv[3] - uv[1]), 1.5, 1e-15));
    sl_patch_free(patch);
}

static void layouts_are_refused_or_cancelled_with_a_status(void **state)
{
    (void)state;
    static const double xyz[] = {0.1, 0.2, 0.3, 1.2, 0.1, 0.4, 0.5, 0.9, 0.2, 0.4, 0.3, 1.1};
    static const int32_t closed[] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
    double alpha[12], uv[8];
    for (int c = 0; c < 12; c++) {
        alpha[c] = TEST_PI / 3;
    }
    sl_patch *patch = chart_make(4, xyz, 4, closed);
    assert_int_equal(sl_abf_reconstruct(patch, alpha, NULL, uv), SL_SINGULAR);
    sl_patch_free(patch);
    patch = chart_make(3, xyz, 1, closed);
    for (int calls = 0; calls < 2; calls++) {
        int left = calls;
        const sl_context context = {.progress = chart_cancel_after, .progress_user = &left};
        assert_int_equal(sl_abf_reconstruct(patch, alpha, &context, uv), SL_CANCELLED);
    }
    sl_patch_free(patch);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(layouts_of_a_drawings_angles_are_the_drawing),
        cmocka_unit_test(angles_survive_scales_of_many_orders_of_magnitude),
        cmocka_unit_test(layouts_of_contradictory_angles_minimise_the_energy),
        cmocka_unit_test(unfit_angles_are_corrected),
        cmocka_unit_test(charts_without_area_are_left_unscaled),
        cmocka_unit_test(layouts_are_refused_or_cancelled_with_a_status),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
