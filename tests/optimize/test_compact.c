/* Charts that leave much of a page empty are cut across. */
#include "optimize/checks.h"

/* Seams, charts, and the page: the larger of the least square about a chart and of what all keep others from, by many
 * directions. */
static double price(const sl_opt_state *state)
{
    double area = 0.0, square = 0.0;
    for (int32_t c = 0; c < state->nchart; c++) {
        const sl_opt_chart *chart = &state->chart[c];
        const double scale = pow(chart->sums.inverse / chart->sums.plane, 0.25);
        double least_area = HUGE_VAL, least_square = HUGE_VAL;
        for (int k = 0; k < 16; k++) {
            const double a = 3.14159265358979 * k / 32;
            double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
            for (int32_t v = 0; v < chart->patch->nv; v++) {
                const double *uv = chart->uv + 2 * v;
                const double at[2] = {scale * (cos(a) * uv[0] + sin(a) * uv[1]),
                                      scale * (cos(a) * uv[1] - sin(a) * uv[0])};
                for (int j = 0; j < 2; j++) {
                    low[j] = fmin(low[j], at[j]);
                    high[j] = fmax(high[j], at[j]);
                }
            }
            const double x = high[0] - low[0], y = high[1] - low[1];
            least_area = fmin(least_area, x * y);
            least_square = fmin(least_square, fmax(x, y) * fmax(x, y));
        }
        const double own = scale * scale * chart->sums.plane;
        area += own + 0.7 * (least_area - own);
        square = fmax(square, least_square);
    }
    return sl_opt_price(state) + state->def->empty_cost * fmax(area, square) / state->surface->total;
}

static void long_charts_are_cut_and_lie_as_they_lay(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xc0);
    for (int trial = 0; trial < 4 * test_multiplier(); trial++) {
        const int32_t length = 40 + test_index(&rng, 20);
        test_surface s =
            test_surface_of(test_patch_mesh(&rng, length, 7, trial % 2 ? TEST_MIXED : TEST_TRIANGLES, NULL));
        const sl_optimize_def def = sl_optimize_default();
        sl_opt_state a = test_started(&s, &def);
        sl_opt_total before, after;
        const double was = price(&a);
        const int64_t charts = a.nchart;
        sl_opt_totals(&a, &before);
        assert_int_equal(sl_opt_compact(&a), SL_OK);
        sl_opt_totals(&a, &after);
        assert_true(a.nchart > charts && price(&a) < was);
        test_check_state(&a);
        for (int32_t c = 0; c < a.nchart; c++) {
            sl_certificate certificate;
            assert_int_equal(sl_opt_certify(a.chart[c].patch, a.chart[c].uv, &certificate), SL_OK);
            assert_true(certificate.embedded);
        }
        assert_true(after.stretch <= before.stretch * (1.0 + 1e-12));
        assert_true(test_near_rel(after.angle, before.angle, 1e-12));
        sl_opt_state_clear(&a);
        test_surface_clear(&s);
    }
}

static void square_charts_and_worthless_texels_change_nothing(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x50);
    for (int trial = 0; trial < 2; trial++) {
        test_surface s = test_surface_of(trial == 0 ? test_patch_mesh(&rng, 15, 15, TEST_TRIANGLES, NULL)
                                                    : test_patch_mesh(&rng, 60, 7, TEST_TRIANGLES, NULL));
        sl_optimize_def def = sl_optimize_default();
        def.empty_cost = trial == 0 ? def.empty_cost : 0.0;
        sl_opt_state a = test_started(&s, &def);
        const int64_t charts = a.nchart;
        assert_int_equal(sl_opt_compact(&a), SL_OK);
        assert_int_equal(a.nchart, charts);
        assert_int_equal(a.info.cuts, 0);
        sl_opt_state_clear(&a);
        test_surface_clear(&s);
    }
}

/* One tube alone, and eight of them beside each other. */
static void one_of_many_long_pieces_is_left_alone(void **state)
{
    (void)state;
    enum { N = 40, AROUND = 8 };
    for (int32_t tubes = 1; tubes <= 8; tubes += 7) {
        const int32_t nv = tubes * AROUND * (N + 1), nf = tubes * AROUND * N;
        double *xyz = malloc(3 * sizeof *xyz * (size_t)nv);
        int32_t *first = malloc(sizeof *first * (size_t)(nf + 1)), *index = malloc(4 * sizeof *index * (size_t)nf);
        for (int32_t v = 0; v < nv; v++) {
            xyz[3 * v] = v / AROUND % (N + 1);
            xyz[3 * v + 1] = 10.0 * (v / (AROUND * (N + 1))) + cos(2.0 * TEST_PI * (v % AROUND) / AROUND);
            xyz[3 * v + 2] = sin(2.0 * TEST_PI * (v % AROUND) / AROUND);
        }
        for (int32_t f = 0; f <= nf; f++) {
            const int32_t row = (f / (AROUND * N) * (N + 1) + f / AROUND % N) * AROUND;
            const int32_t a = row + f % AROUND, b = row + (f + 1) % AROUND;
            const int32_t corner[4] = {a, b, b + AROUND, a + AROUND};
            first[f] = 4 * f;
            if (f < nf) {
                memcpy(index + 4 * f, corner, sizeof corner);
            }
        }
        sl_mesh *mesh = test_mesh_of(nv, nf, xyz, first, index);
        sl_triangulation *t = test_triangulate(mesh);
        sl_optimize_def def = sl_optimize_default();
        sl_segment_def segment = sl_segment_default();
        segment.symmetry = SL_SYMMETRY_USE_OFF;
        def.weights = sl_seam_cost_none();
        sl_segmentation *s = NULL;
        sl_optimize_info info;
        assert_int_equal(sl_optimize_segment(mesh, t, &segment, &def, NULL, &s, &info), SL_OK);
        assert_int_equal(info.failed, 0);
        assert_true(tubes == 1 ? s->nchart > 1 : s->nchart == tubes);
        sl_segmentation_free(s);
        sl_triangulation_free(t);
        sl_mesh_free(mesh);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(long_charts_are_cut_and_lie_as_they_lay),
        cmocka_unit_test(square_charts_and_worthless_texels_change_nothing),
        cmocka_unit_test(one_of_many_long_pieces_is_left_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
