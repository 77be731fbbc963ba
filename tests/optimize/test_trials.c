/* What comes before a trial is solved: guesses at cuts, charts that lie in each other, banks brought together. */
#include "base/memory.h"
#include "optimize/checks.h"

static const double PI = 3.14159265358979323846;

static sl_opt_state started(const test_surface *s, const sl_optimize_def *def)
{
    sl_opt_state state = test_started(s, def);
    sl_opt_weigh(&state);
    return state;
}

/* A dart whose banks have not moved: sewn again, the map is what it was. */
static void banks_that_lie_together_stay_where_they_are(void **unused)
{
    (void)unused;
    test_rng rng = test_rng_seed(0xba2c5);
    const sl_optimize_def def = sl_optimize_default();
    for (int round = 0; round < 3 * test_multiplier(); round++) {
        test_surface s = test_surface_of(test_spiky_mesh(&rng, 7, 4, 1.0, TEST_MIXED));
        sl_opt_state state = started(&s, &def);
        sl_opt_trial *list = NULL;
        int32_t count = 0;
        assert_int_equal(sl_opt_candidates(&state, 0, &list, &count), SL_OK);
        assert_true(count > 0 && list[0].nedge > 0);
        const int64_t corners = 3 * (int64_t)s.surface.patch->nt;
        double *before = sl_copy(state.uv, 2 * corners, sizeof *before);
        sl_opt_trial sew = {.sew = true, .old = {0, -1}, .nedge = list[0].nedge};
        sew.edge = sl_copy(list[0].edge, list[0].nedge, sizeof *sew.edge);
        assert_int_equal(sl_opt_trial_make(&state, &list[0]), SL_OK);
        assert_true(list[0].valid);
        assert_int_equal(sl_opt_apply(&state, &list[0]), SL_OK);
        assert_int_equal(sl_opt_trial_make(&state, &sew), SL_OK);
        assert_int_equal(sew.nto, 1);
        const sl_patch *p = sew.to[0].patch;
        for (int32_t c = 0; c < 3 * p->nt; c++) {
            for (int k = 0; k < 2; k++) {
                const double had = before[2 * (int64_t)p->corner[c] + k];
                assert_true(test_near(sew.to[0].uv[2 * (int64_t)p->tri[c] + k], had, 16 * 0x1p-52 * (1 + fabs(had))));
            }
        }
        sl_free(before);
        sl_opt_trial_clear(&sew);
        for (int32_t k = 0; k < count; k++) {
            sl_opt_trial_clear(&list[k]);
        }
        sl_free(list);
        sl_opt_state_clear(&state);
        test_surface_clear(&s);
    }
}

/* The map of a sewing with nothing but its banks brought together: each vertex at the mean of its corners' places,
 * those of the second chart moved to the first. Returns the widest gap between two corners of a vertex. */
static double bring_banks_together(const sl_opt_state *state, const sl_opt_trial *sew, double *mean)
{
    const sl_patch *p = sew->to[0].patch;
    double *place = malloc(6 * (size_t)p->nt * sizeof *place), *count = calloc((size_t)p->nv, sizeof *count);
    double m[4], widest = 0.0;
    (void)sl_opt_align(state, sew, m);
    memset(mean, 0, 2 * (size_t)p->nv * sizeof *mean);
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        const double *uv = state->uv + 2 * p->corner[c];
        const bool moves = state->chart_of[p->facet[c / 3]] == sew->old[1];
        place[2 * c] = moves ? m[0] * uv[0] - m[1] * uv[1] + m[2] : uv[0];
        place[2 * c + 1] = moves ? m[1] * uv[0] + m[0] * uv[1] + m[3] : uv[1];
        mean[2 * p->tri[c]] += place[2 * c];
        mean[2 * p->tri[c] + 1] += place[2 * c + 1];
        count[p->tri[c]] += 1.0;
    }
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        const double *first = place + 2 * p->outgoing[p->tri[c]];
        widest = fmax(widest, hypot(place[2 * c] - first[0], place[2 * c + 1] - first[1]));
    }
    for (int32_t v = 0; v < p->nv; v++) {
        mean[2 * v] /= count[v];
        mean[2 * v + 1] /= count[v];
    }
    free(place);
    free(count);
    return widest;
}

/* Triangles of at most half this area; below 0: those turned over for certain. */
static int32_t count_flips(const sl_patch *p, const double *uv, double area)
{
    int32_t flips = 0;
    for (int32_t t = 0; t < p->nt; t++) {
        const int32_t *v = p->tri + 3 * t;
        const double *a = uv + 2 * v[0], *b = uv + 2 * v[1], *c = uv + 2 * v[2];
        flips += !((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > area);
    }
    return flips;
}

/* Sewn anywhere: no vertex goes further than the banks are apart, what is far away stays, and no more triangles flip
 * than where the banks alone are brought together; over all sewings, fewer. */
static void what_lies_behind_the_banks_follows_them(void **unused)
{
    (void)unused;
    test_rng rng = test_rng_seed(0xc105e);
    sl_optimize_def def = sl_optimize_default();
    int32_t flips = 0, alone = 0, still = 0;
    def.start_stretch = 1.1; /* several charts */
    for (int round = 0; round < 2 * test_multiplier(); round++) {
        test_surface s = test_surface_of(test_spiky_mesh(&rng, 8, 4, 1.0, TEST_TRIANGLES));
        sl_opt_state state = started(&s, &def);
        sl_opt_trial *list = NULL;
        int64_t count = 0;
        assert_int_equal(sl_opt_windows(&state, &list, &count), SL_OK);
        for (int64_t k = 0; k < count; k++) {
            assert_int_equal(sl_opt_trial_make(&state, &list[k]), SL_OK);
            assert_int_equal(list[k].nto, 1);
            const sl_patch *p = list[k].to[0].patch;
            double *mean = malloc(2 * (size_t)p->nv * sizeof *mean);
            const double widest = bring_banks_together(&state, &list[k], mean), *uv = list[k].to[0].uv;
            for (int32_t v = 0; v < p->nv; v++) {
                const double moved = hypot(uv[2 * v] - mean[2 * v], uv[2 * v + 1] - mean[2 * v + 1]);
                assert_true(moved <= widest);
                still += moved < 1e-14;
            }
            const double rounding = 1e-12 * s.surface.total; /* triangles on a line may fall either way */
            assert_true(count_flips(p, uv, -rounding) <= count_flips(p, mean, rounding));
            flips += count_flips(p, uv, -rounding);
            alone += count_flips(p, mean, -rounding);
            free(mean);
            sl_opt_trial_clear(&list[k]);
        }
        sl_free(list);
        sl_opt_state_clear(&state);
        test_surface_clear(&s);
    }
    assert_true(flips < alone && still > 0);
}

/* How often the border of a chart winds around x. */
static double winding(const sl_opt_chart *chart, const double x[2])
{
    const sl_patch *p = chart->patch;
    double sum = 0.0;
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        if (p->twin[c] < 0) {
            const double *a = chart->uv + 2 * p->tri[c], *b = chart->uv + 2 * p->tri[sl_corner_next(c)];
            sum += atan2((a[0] - x[0]) * (b[1] - x[1]) - (a[1] - x[1]) * (b[0] - x[0]),
                         (a[0] - x[0]) * (b[0] - x[0]) + (a[1] - x[1]) * (b[1] - x[1]));
        }
    }
    return sum / (2.0 * PI);
}

/* Distance from the border, by points along its edges. */
static double depth_at(const sl_opt_chart *chart, const double x[2])
{
    const sl_patch *p = chart->patch;
    double least = HUGE_VAL;
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        for (int k = 0; k <= 40 && p->twin[c] < 0; k++) {
            const double *a = chart->uv + 2 * p->tri[c], *b = chart->uv + 2 * p->tri[sl_corner_next(c)];
            const double u = a[0] + k / 40.0 * (b[0] - a[0]), v = a[1] + k / 40.0 * (b[1] - a[1]);
            least = fmin(least, hypot(x[0] - u, x[1] - v));
        }
    }
    return least;
}

/* The deepest that a vertex on one chart's border lies in the other; the inverse motion brings old[0] to old[1]. */
static double deepest(const sl_opt_state *state, const sl_opt_trial *t, const double m[4])
{
    double most = 0.0;
    for (int side = 0; side < 2; side++) {
        const sl_opt_chart *a = &state->chart[t->old[side]], *b = &state->chart[t->old[1 - side]];
        for (int32_t v = 0; v < a->patch->nv; v++) {
            const double *uv = a->uv + 2 * v, d[2] = {uv[0] - m[2], uv[1] - m[3]};
            const double x[2] = {side == 1 ? m[0] * uv[0] - m[1] * uv[1] + m[2] : m[0] * d[0] + m[1] * d[1],
                                 side == 1 ? m[1] * uv[0] + m[0] * uv[1] + m[3] : m[0] * d[1] - m[1] * d[0]};
            if (a->patch->border[v] != 0 && fabs(winding(b, x)) > 0.5) {
                most = fmax(most, depth_at(b, x));
            }
        }
    }
    return most;
}

static void charts_interlock_where_one_reaches_deep_into_the_other(void **unused)
{
    (void)unused;
    test_rng rng = test_rng_seed(0xdee9);
    sl_optimize_def def = sl_optimize_default();
    int32_t seen[2] = {0, 0};
    def.start_stretch = 1.1; /* several charts */
    for (int round = 0; round < 2 * test_multiplier(); round++) {
        test_surface s = test_surface_of(test_spiky_mesh(&rng, 6, 4, 1.2, TEST_TRIANGLES));
        sl_opt_state state = started(&s, &def);
        sl_opt_trial *list = NULL;
        int64_t count = 0;
        assert_int_equal(sl_opt_windows(&state, &list, &count), SL_OK);
        for (int64_t k = 0; k < count; k++) {
            double m[4];
            bool interlocks = true;
            const double gap = sl_opt_align(&state, &list[k], m), unit = s.surface.unit;
            assert_int_equal(sl_opt_interlocks(&state, &list[k], &interlocks), SL_OK);
            if (list[k].old[1] < 0) {
                assert_false(interlocks);
            } else {
                const double depth = deepest(&state, &list[k], m);
                if (depth > 1.1 * (1.6 * gap + 1e-3 * unit)) {
                    assert_true(interlocks);
                } else if (depth < 0.9 * (1.6 * gap + 1e-3 * unit)) {
                    assert_false(interlocks);
                }
                seen[interlocks]++;
            }
            sl_opt_trial_clear(&list[k]);
        }
        sl_free(list);
        sl_opt_state_clear(&state);
        test_surface_clear(&s);
    }
    assert_true(seen[0] > 5 && seen[1] > 5);
}

/* The surroundings alone see a good part of what the whole chart gains, and never much that is not there. */
static void guesses_agree_with_probes_of_the_whole_chart(void **unused)
{
    (void)unused;
    test_rng rng = test_rng_seed(0x90e55);
    const sl_optimize_def def = sl_optimize_default();
    int32_t compared = 0, agreed = 0;
    for (int round = 0; round < 3 * test_multiplier(); round++) {
        test_surface s = test_surface_of(test_spiky_mesh(&rng, 12, 4, 1.0, TEST_TRIANGLES));
        sl_opt_state state = started(&s, &def);
        for (int32_t c = 0; c < state.nchart; c++) {
            sl_opt_trial *list = NULL;
            int32_t count = 0;
            const double loss = sl_opt_loss(&state, &state.chart[c].sums);
            assert_int_equal(sl_opt_candidates(&state, c, &list, &count), SL_OK);
            for (int32_t k = 0; k < count; k++) {
                if (list[k].nedge > 0) {
                    assert_int_equal(sl_opt_trial_guess(&state, &list[k]), SL_OK);
                    const double guessed = loss - list[k].loss, length = list[k].length;
                    const bool valid = list[k].valid;
                    assert_int_equal(sl_opt_trial_make(&state, &list[k]), SL_OK);
                    assert_true(test_near(list[k].length, length, 64 * 0x1p-52 * length));
                    assert_int_equal(sl_opt_trial_probe(&state, 4, &list[k]), SL_OK);
                    const double probed = loss - list[k].loss;
                    if (valid && list[k].valid && probed > 0.05) {
                        compared++;
                        agreed += guessed > 0.3 * probed && guessed < 2.0 * probed;
                    }
                }
                sl_opt_trial_clear(&list[k]);
            }
            sl_free(list);
        }
        test_check_state(&state);
        sl_opt_state_clear(&state);
        test_surface_clear(&s);
    }
    assert_true(compared > 20 && agreed >= 0.8 * compared);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(banks_that_lie_together_stay_where_they_are),
        cmocka_unit_test(what_lies_behind_the_banks_follows_them),
        cmocka_unit_test(charts_interlock_where_one_reaches_deep_into_the_other),
        cmocka_unit_test(guesses_agree_with_probes_of_the_whole_chart),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
