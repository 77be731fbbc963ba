/* Ruin and recreate: what it keeps costs less, within the targets; what does not pay leaves no trace. */
#include "optimize/checks.h"

static sl_mesh *shape(test_rng *rng, int kind)
{
    return kind % 2 == 0 ? test_spiky_mesh(rng, 6, 5, 1.2, TEST_TRIANGLES)
                         : test_torus_mesh(rng, 18, 10, 0.35, TEST_TRIANGLES);
}

static sl_optimize_def targets(int kind)
{
    sl_optimize_def def = sl_optimize_default();
    if (kind % 3 == 1) {
        def.target_stretch = 1.02;
        def.target_angle = 1.1;
    }
    return def;
}

static sl_opt_state searched(const test_surface *s, const sl_optimize_def *def, sl_opt_total *total)
{
    sl_opt_state opt = test_started(s, def);
    assert_int_equal(sl_opt_search(&opt), SL_OK);
    sl_opt_totals(&opt, total);
    return opt;
}

static bool same_bytes(const sl_opt_state *a, const sl_opt_state *b)
{
    const size_t nt = (size_t)a->surface->patch->nt;
    return a->nchart == b->nchart && a->w == b->w && memcmp(a->cut, b->cut, 3 * nt) == 0 &&
           memcmp(a->uv, b->uv, 6 * nt * sizeof *a->uv) == 0 &&
           memcmp(a->chart_of, b->chart_of, nt * sizeof *a->chart_of) == 0;
}

static void what_is_made_again_costs_less_within_the_targets(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x4ec);
    int cheaper = 0, same = 0;
    for (int trial = 0; trial < 6 * test_multiplier(); trial++) {
        test_surface s = test_surface_of(shape(&rng, trial));
        const sl_optimize_def def = targets(trial);
        sl_opt_total total;
        sl_opt_state before, opt = searched(&s, &def, &total);
        assert_int_equal(sl_opt_state_copy(&opt, &before), SL_OK);
        const bool within = sl_opt_within(&opt, &total);
        assert_int_equal(sl_opt_recreate(&opt), SL_OK);
        test_check_state(&opt);
        sl_opt_totals(&opt, &total);
        assert_true(sl_opt_within(&opt, &total) == within);
        if (sl_opt_price(&opt) == sl_opt_price(&before)) {
            same++;
            assert_true(same_bytes(&opt, &before));
            assert_int_equal(opt.info.cuts, before.info.cuts);
            assert_int_equal(opt.info.sewings, before.info.sewings);
        } else {
            cheaper++;
            assert_true(within && sl_opt_price(&opt) < sl_opt_price(&before));
            assert_true(opt.info.sewings > before.info.sewings && opt.info.trials > before.info.trials);
        }
        assert_true(opt.room > 0.0 && opt.most_price == HUGE_VAL);
        sl_opt_state_clear(&opt);
        sl_opt_state_clear(&before);
        test_surface_clear(&s);
    }
    assert_true(cheaper > 2);
}

/* Bounds that are spent, targets that are missed. */
static void nothing_is_ruined_where_nothing_may_be_repaired(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x4ed);
    test_surface s = test_surface_of(shape(&rng, 0));
    for (int kind = 0; kind < 3; kind++) {
        sl_optimize_def def = targets(1);
        sl_opt_total total;
        sl_opt_state before, opt = searched(&s, &def, &total);
        assert_true(sl_opt_within(&opt, &total));
        def.max_cuts = kind == 0 ? opt.info.cuts : def.max_cuts;
        def.max_sewings = kind == 1 ? opt.info.sewings : def.max_sewings;
        def.target_stretch = kind == 2 ? 1.0 + 0.5 * (total.stretch - 1.0) : def.target_stretch;
        assert_int_equal(sl_opt_state_copy(&opt, &before), SL_OK);
        assert_int_equal(sl_opt_recreate(&opt), SL_OK);
        assert_true(same_bytes(&opt, &before));
        assert_int_equal(opt.info.trials, before.info.trials);
        sl_opt_state_clear(&opt);
        sl_opt_state_clear(&before);
    }
    test_surface_clear(&s);
}

/* A piece is searched, and then made again. */
static void a_piece_is_made_again_after_its_search(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x4ee);
    const sl_segment_def segment = sl_segment_default();
    const sl_optimize_def def = targets(1);
    test_surface s = test_surface_of(shape(&rng, 0));
    sl_opt_total total;
    bool done = false;
    sl_opt_state opt = searched(&s, &def, &total), piece;
    assert_int_equal(sl_opt_recreate(&opt), SL_OK);
    assert_int_equal(sl_opt_state_init(&s.surface, &def, NULL, &piece), SL_OK);
    assert_int_equal(sl_opt_piece(&piece, &segment, s.triangulation, &done), SL_OK);
    assert_true(done && same_bytes(&opt, &piece));
    sl_opt_state_clear(&opt);
    sl_opt_state_clear(&piece);
    test_surface_clear(&s);
}

/* Cutting for a price stops below it. */
static void a_bound_on_the_price_keeps_cuts_below_it(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x4ef);
    const sl_optimize_def def = targets(1);
    for (int trial = 0; trial < 3 * test_multiplier(); trial++) {
        test_surface s = test_surface_of(shape(&rng, trial));
        sl_opt_state opt = test_started(&s, &def), bounded = test_started(&s, &def);
        const double start = sl_opt_price(&opt);
        assert_int_equal(sl_opt_cut(&opt), SL_OK);
        const double whole = sl_opt_price(&opt) - start;
        bounded.most_price = start + 0.6 * whole;
        assert_int_equal(sl_opt_cut(&bounded), SL_OK);
        assert_true(whole > 0.0 && sl_opt_price(&bounded) <= bounded.most_price * (1.0 + 1e-12));
        assert_true(bounded.info.cuts > 0);
        test_check_state(&bounded);
        sl_opt_state_clear(&opt);
        sl_opt_state_clear(&bounded);
        test_surface_clear(&s);
    }
}

static bool refuse(void *user, const char *stage, double fraction)
{
    (void)stage;
    (void)fraction;
    return --*(int *)user >= 0;
}

static void cancelling_ends_it(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x4f0);
    test_surface s = test_surface_of(shape(&rng, 0));
    const sl_optimize_def def = targets(1);
    sl_opt_total total;
    sl_opt_state opt = searched(&s, &def, &total);
    int left = 1;
    const sl_context context = {.progress = refuse, .progress_user = &left};
    opt.context = &context;
    assert_int_equal(sl_opt_recreate(&opt), SL_CANCELLED);
    sl_opt_state_clear(&opt);
    test_surface_clear(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_made_again_costs_less_within_the_targets),
        cmocka_unit_test(nothing_is_ruined_where_nothing_may_be_repaired),
        cmocka_unit_test(a_piece_is_made_again_after_its_search),
        cmocka_unit_test(a_bound_on_the_price_keeps_cuts_below_it),
        cmocka_unit_test(cancelling_ends_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
