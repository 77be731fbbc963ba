/* Whole searches: their targets, their charts, threads, scales, options; and the steps of one. */
#include "optimize/checks.h"
#include "optimize/cut_internal.h"

#include <stdatomic.h>

static sl_mesh *shape(test_rng *rng, int kind)
{
    switch (kind % 4) {
    case 0:
        return test_spiky_mesh(rng, 7, 4, 1.2, TEST_MIXED);
    case 1:
        return test_torus_mesh(rng, 18, 10, 0.35, TEST_TRIANGLES);
    case 2:
        return test_spiky_mesh(rng, 7, 0, 0.0, TEST_TRIANGLES);
    default:
        return test_patch_mesh(rng, 12, 11, TEST_QUADS, NULL);
    }
}

static sl_segmentation *search(sl_mesh *mesh, const sl_triangulation *t, const sl_optimize_def *def, int32_t threads,
                               sl_optimize_info *info)
{
    sl_thread_pool *pool = NULL;
    sl_segmentation *s = NULL;
    const sl_segment_def segment = sl_segment_default();
    assert_int_equal(sl_thread_pool_create(threads, &pool), SL_OK);
    const sl_context context = {.executor = sl_thread_pool_executor(pool)};
    assert_int_equal(sl_optimize_segment(mesh, t, &segment, def, &context, &s, info), SL_OK);
    sl_thread_pool_free(pool);
    return s;
}

static double seams_of(const sl_mesh *m)
{
    double sum = 0.0;
    for (int32_t h = 0; h < m->nh; h++) {
        sum += m->sew[h] > h ? sl_mesh_edge_length(m, h) : 0.0;
    }
    return sum;
}

static void every_shape_meets_its_targets_in_valid_charts(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x5ea);
    for (int trial = 0; trial < 4 * test_multiplier(); trial++) {
        sl_mesh *mesh = shape(&rng, trial);
        sl_triangulation *t = test_triangulate(mesh);
        const sl_optimize_def def = sl_optimize_default();
        sl_optimize_info info;
        sl_segmentation *s = search(mesh, t, &def, 1, &info);
        assert_int_equal(info.failed, 0);
        assert_int_equal(info.missed, 0);
        assert_int_equal(info.pieces, 1);
        test_check_pointers(mesh);
        test_check_partition(mesh, s);
        test_check_glued(mesh, s);
        for (int32_t c = 0; c < s->nchart; c++) {
            int32_t flips = 0;
            const double l2 = test_chart_stretch(mesh, t, s, c, &flips);
            assert_int_equal(flips, 0);
            assert_int_equal(s->chart[c].flat.verdict, SL_CHART_VALID);
            assert_true(s->chart[c].flat.certificate.embedded && l2 <= def.max_stretch);
            assert_true(s->chart[c].topology.genus == 0 && s->chart[c].topology.loops == 1);
            const sl_distortion *own = &s->chart[c].flat.distortion; /* at the best scale I = a, so L2 = a / A */
            assert_true(test_near_rel(own->area_uv / own->area_3d, own->l2, 1e-9));
        }
        const sl_distortion d = test_whole_distortion(mesh, t, s);
        assert_true(d.l2 <= def.target_stretch * (1.0 + 1e-9) && d.angle_mean <= def.target_angle * (1.0 + 1e-9));
        sl_segmentation_free(s);
        sl_triangulation_free(t);
        sl_mesh_free(mesh);
    }
}

/* On more triangles than are probed whole. */
static void targets_out_of_reach_leave_valid_charts(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x0f1e);
    sl_mesh *mesh = test_spiky_mesh(&rng, 14, 4, 1.6, TEST_TRIANGLES);
    sl_triangulation *t = test_triangulate(mesh);
    sl_optimize_def def = sl_optimize_default();
    sl_optimize_info info;
    def.target_stretch = 1.0005;
    def.target_angle = 1.002;
    def.max_cuts = 60;
    sl_segmentation *s = search(mesh, t, &def, 2, &info);
    assert_int_equal(info.failed, 0);
    assert_int_equal(info.missed, 1);
    test_check_partition(mesh, s);
    for (int32_t c = 0; c < s->nchart; c++) {
        int32_t flips = 0;
        (void)test_chart_stretch(mesh, t, s, c, &flips);
        assert_int_equal(flips, 0);
        assert_int_equal(s->chart[c].flat.verdict, SL_CHART_VALID);
    }
    sl_segmentation_free(s);
    sl_triangulation_free(t);
    sl_mesh_free(mesh);
}

static void tighter_targets_cost_longer_seams(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x7a6);
    sl_mesh *mesh = shape(&rng, 0), *loose = NULL, *tight = NULL;
    sl_triangulation *t = test_triangulate(mesh);
    sl_optimize_def def = sl_optimize_default();
    assert_int_equal(sl_mesh_copy(mesh, &loose), SL_OK);
    assert_int_equal(sl_mesh_copy(mesh, &tight), SL_OK);
    def.target_stretch = 1.2;
    def.target_angle = 1.6;
    sl_segmentation_free(search(loose, t, &def, 1, NULL));
    def.target_stretch = 1.02;
    def.target_angle = 1.1;
    sl_segmentation_free(search(tight, t, &def, 1, NULL));
    assert_true(seams_of(loose) < seams_of(tight));
    sl_mesh_free(loose);
    sl_mesh_free(tight);
    sl_mesh_free(mesh);
    sl_triangulation_free(t);
}

static void the_bytes_do_not_depend_on_the_threads(void **state)
{
    (void)state;
    static const int32_t threads[] = {1, 2, 5};
    test_rng rng = test_rng_seed(0x7e4);
    sl_mesh *mesh = shape(&rng, 0), *copy[3];
    sl_triangulation *t = test_triangulate(mesh);
    sl_segmentation *s[3];
    const sl_optimize_def def = sl_optimize_default();
    for (int k = 0; k < 3; k++) {
        assert_int_equal(sl_mesh_copy(mesh, &copy[k]), SL_OK);
        s[k] = search(copy[k], t, &def, threads[k], NULL);
        assert_int_equal(s[k]->nchart, s[0]->nchart);
        assert_memory_equal(s[k]->corner_uv, s[0]->corner_uv, 2 * sizeof(double) * (size_t)mesh->nh);
        assert_memory_equal(copy[k]->twin, copy[0]->twin, sizeof(int32_t) * (size_t)mesh->nh);
    }
    for (int k = 0; k < 3; k++) {
        sl_segmentation_free(s[k]);
        sl_mesh_free(copy[k]);
    }
    sl_triangulation_free(t);
    sl_mesh_free(mesh);
}

static void a_target_out_of_reach_is_reported(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x0ff);
    sl_mesh *mesh = shape(&rng, 2);
    sl_triangulation *t = test_triangulate(mesh);
    sl_optimize_def def = sl_optimize_default();
    def.target_stretch = 1.0;
    def.target_angle = 1.0;
    def.max_cuts = 3;
    sl_optimize_info info;
    sl_segmentation *s = search(mesh, t, &def, 1, &info);
    assert_int_equal(info.missed + info.failed, 1);
    test_check_partition(mesh, s);
    sl_segmentation_free(s);
    sl_triangulation_free(t);
    sl_mesh_free(mesh);
}

/* Guesses at cuts of large charts are worth nothing there, but for the rough one. */
static void a_nearly_flat_mesh_ends_where_no_cut_is_worth_anything(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xf1a7);
    for (int trial = 0; trial < 3; trial++) {
        sl_mesh *mesh = test_patch_mesh(&rng, 26, 25, TEST_TRIANGLES, NULL);
        for (int32_t v = 0; v < mesh->nv; v++) { /* flat, nearly flat, rough */
            mesh->xyz[3 * v + 2] = (trial == 0 ? 0.0 : trial == 1 ? 1e-6 : 1e-2) * test_uniform(&rng, -1.0, 1.0);
        }
        sl_triangulation *t = test_triangulate(mesh);
        assert_true(t->nt > 1000);
        sl_optimize_def def = sl_optimize_default();
        def.target_stretch = def.target_angle = 1.0;
        def.max_cuts = 8;
        sl_optimize_info info;
        sl_segmentation *s = search(mesh, t, &def, 1, &info);
        assert_int_equal(info.failed, 0);
        assert_int_equal(info.missed, 1); /* if by rounding */
        assert_true(trial == 2 ? info.cuts > 0 : s->nchart == 1);
        test_check_partition(mesh, s);
        sl_segmentation_free(s);
        sl_triangulation_free(t);
        sl_mesh_free(mesh);
    }
}

/* Cuts of large charts are only guessed at before one is chosen: their charts are made when they are needed. */
static void the_worst_chart_is_bisected_before_its_cuts_were_probed(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xb15e);
    const sl_optimize_def def = sl_optimize_default();
    test_surface s = test_surface_of(test_spiky_mesh(&rng, 17, 0, 0.0, TEST_TRIANGLES));
    sl_opt_state opt = test_started(&s, &def);
    sl_opt_weigh(&opt);
    sl_opt_pool pool = {0};
    int64_t taken = -1;
    for (int32_t c = 0; c < opt.nchart; c++) {
        opt.chart[c].sums.shear *= c == 0 ? 8.0 : 0.0; /* most of the loss in one chart */
        assert_true(c > 0 || opt.chart[c].patch->nt > 1000);
    }
    const double loss = sl_opt_loss(&opt, &opt.chart[0].sums);
    assert_int_equal(sl_opt_pool_refresh(&opt, &pool), SL_OK);
    for (int64_t k = 0; k < pool.count; k++) {
        assert_true(pool.trial[k].old[0] > 0 || (!pool.trial[k].probed && pool.trial[k].to == NULL));
    }
    assert_int_equal(sl_opt_bisect_worst(&opt, &pool, &taken), SL_OK);
    assert_true(taken >= 0 && pool.trial[taken].probed && pool.trial[taken].settled);
    assert_true(pool.trial[taken].old[0] == 0 && pool.trial[taken].nto > 1 && pool.trial[taken].loss < loss);
    assert_int_equal(sl_opt_apply(&opt, &pool.trial[taken]), SL_OK);
    test_check_state(&opt);
    sl_opt_pool_clear(&pool);
    sl_opt_state_clear(&opt);
    test_surface_clear(&s);
}

/* Bounds end the same search earlier: what is sewn only becomes more. */
static void a_bound_on_sewings_ends_the_same_search_earlier(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x5eb);
    sl_mesh *mesh = shape(&rng, 0);
    sl_triangulation *t = test_triangulate(mesh);
    sl_optimize_def def = sl_optimize_default();
    sl_optimize_info whole;
    double before = HUGE_VAL;
    sl_mesh *copy = NULL;
    assert_int_equal(sl_mesh_copy(mesh, &copy), SL_OK);
    sl_segmentation_free(search(copy, t, &def, 1, &whole));
    sl_mesh_free(copy);
    assert_true(whole.sewings > 1);
    for (def.max_sewings = 0; def.max_sewings <= whole.sewings && def.max_sewings < 4; def.max_sewings++) {
        sl_optimize_info info;
        assert_int_equal(sl_mesh_copy(mesh, &copy), SL_OK);
        sl_segmentation_free(search(copy, t, &def, 1, &info));
        assert_int_equal(info.sewings, def.max_sewings);
        assert_true(seams_of(copy) < before);
        before = seams_of(copy);
        sl_mesh_free(copy);
    }
    sl_triangulation_free(t);
    sl_mesh_free(mesh);
}

static void a_first_cut_that_is_protected_stays(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xf15);
    sl_optimize_def def = sl_optimize_default();
    def.protect = SL_PROTECT_FIRST;
    test_surface s = test_surface_of(shape(&rng, 0));
    sl_opt_state opt = test_started(&s, &def);
    const size_t size = 3 * (size_t)s.surface.patch->nt;
    uint8_t *kept = malloc(size);
    int32_t protected = 0;
    memcpy(kept, opt.keep, size);
    assert_int_equal(sl_opt_cut(&opt), SL_OK);
    assert_int_equal(sl_opt_sew(&opt), SL_OK);
    test_check_state(&opt);
    for (size_t h = 0; h < size; h++) {
        assert_true(kept[h] == 0 || opt.cut[h] != 0);
        protected += kept[h];
    }
    assert_true(protected > 0);
    free(kept);
    sl_opt_state_clear(&opt);
    test_surface_clear(&s);
}

/* Stretch to spare, angles short: coarse targets keep the weight where angles are still cheap, fine ones do not. */
static void fine_angles_take_weights_that_coarse_ones_never_do(void **state)
{
    (void)state;
    static const double angle[] = {1.2, 1.01};
    test_rng rng = test_rng_seed(0xba1);
    test_surface s = test_surface_of(shape(&rng, 0));
    double lowest[2], mean[2];
    for (int k = 0; k < 2; k++) {
        sl_optimize_def def = sl_optimize_default();
        def.target_stretch = 1e6;
        def.target_angle = angle[k];
        sl_opt_state opt = test_started(&s, &def);
        sl_opt_total total;
        for (int round = 0; round < 4; round++) {
            assert_int_equal(sl_opt_balance(&opt), SL_OK);
        }
        test_check_state(&opt);
        sl_opt_totals(&opt, &total);
        lowest[k] = opt.w;
        mean[k] = total.angle;
        sl_opt_state_clear(&opt);
    }
    assert_true(lowest[0] >= -5.0 && lowest[1] < -20.0 && lowest[1] >= -200.0);
    assert_true(mean[1] < mean[0]);
    test_surface_clear(&s);
}

static void sewing_keeps_the_targets_and_shortens_the_seams(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x5e3);
    const sl_optimize_def def = sl_optimize_default();
    for (int trial = 0; trial < 3 * test_multiplier(); trial++) {
        test_surface s = test_surface_of(shape(&rng, trial));
        sl_opt_state opt = test_started(&s, &def);
        sl_opt_total cut, sewn;
        assert_int_equal(sl_opt_cut(&opt), SL_OK);
        test_check_state(&opt);
        sl_opt_totals(&opt, &cut);
        assert_true(sl_opt_within(&opt, &cut));
        assert_int_equal(sl_opt_sew(&opt), SL_OK);
        test_check_state(&opt);
        sl_opt_totals(&opt, &sewn);
        assert_true(sl_opt_within(&opt, &sewn));
        assert_true(sewn.length <= cut.length);
        sl_opt_state_clear(&opt);
        test_surface_clear(&s);
    }
}

static void scaling_by_a_power_of_two_changes_no_byte(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x2ca);
    sl_mesh *mesh = shape(&rng, 1), *large = NULL;
    sl_triangulation *t = test_triangulate(mesh);
    const sl_optimize_def def = sl_optimize_default();
    assert_int_equal(sl_mesh_copy(mesh, &large), SL_OK);
    for (int32_t k = 0; k < 3 * mesh->nv; k++) {
        large->xyz[k] *= 0x1p7;
    }
    sl_segmentation *a = search(mesh, t, &def, 1, NULL), *b = search(large, t, &def, 1, NULL);
    assert_int_equal(a->nchart, b->nchart);
    assert_memory_equal(mesh->twin, large->twin, sizeof *mesh->twin * (size_t)mesh->nh);
    sl_segmentation_free(a);
    sl_segmentation_free(b);
    sl_mesh_free(mesh);
    sl_mesh_free(large);
    sl_triangulation_free(t);
}

static bool refuse(void *user, const char *stage, double fraction)
{
    (void)stage;
    (void)fraction;
    return --*(int *)user >= 0;
}

static void cancelling_leaves_the_mesh_as_it_was(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xca9);
    sl_mesh *mesh = shape(&rng, 0), *before = NULL;
    sl_triangulation *t = test_triangulate(mesh);
    const sl_optimize_def def = sl_optimize_default();
    const sl_segment_def segment = sl_segment_default();
    assert_int_equal(sl_mesh_copy(mesh, &before), SL_OK);
    for (int after = 0; after < 3; after++) {
        int left = after;
        const sl_context context = {.progress = refuse, .progress_user = &left};
        sl_segmentation *s = (sl_segmentation *)&rng;
        assert_int_equal(sl_optimize_segment(mesh, t, &segment, &def, &context, &s, NULL), SL_CANCELLED);
        assert_null(s);
        assert_memory_equal(mesh->twin, before->twin, sizeof *mesh->twin * (size_t)mesh->nh);
    }
    sl_mesh_free(mesh);
    sl_mesh_free(before);
    sl_triangulation_free(t);
}

typedef struct deadline {
    atomic_int left;     /* looks at the flag before it is set */
    atomic_bool is_over; /* it was set */
    atomic_int late;     /* looks at it after that */
} deadline;

static bool is_over(void *user)
{
    deadline *d = user;
    d->late += d->is_over;
    d->is_over = d->is_over || --d->left < 0;
    return d->is_over;
}

/* Each solve looks; those that run beside the one that hears it first hear it, too. */
static void solves_that_run_side_by_side_hear_that_all_is_over(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xca11);
    sl_mesh *mesh = shape(&rng, 0);
    sl_triangulation *t = test_triangulate(mesh);
    const sl_optimize_def def = sl_optimize_default();
    const sl_segment_def segment = sl_segment_default();
    for (int32_t threads = 1; threads <= 3; threads += 2) {
        sl_thread_pool *pool = NULL;
        assert_int_equal(sl_thread_pool_create(threads, &pool), SL_OK);
        for (int after = 0; after < 500; after += after / 2 + 1) {
            deadline d = {.left = after};
            const sl_context context = {
                .executor = sl_thread_pool_executor(pool), .cancelled = is_over, .cancelled_user = &d};
            sl_segmentation *s = (sl_segmentation *)&rng;
            assert_int_equal(sl_optimize_segment(mesh, t, &segment, &def, &context, &s, NULL), SL_CANCELLED);
            assert_null(s);
            assert_true(d.late <= 80); /* at most one for each of the trials that run side by side */
        }
        sl_thread_pool_free(pool);
    }
    sl_mesh_free(mesh);
    sl_triangulation_free(t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_shape_meets_its_targets_in_valid_charts),
        cmocka_unit_test(targets_out_of_reach_leave_valid_charts),
        cmocka_unit_test(tighter_targets_cost_longer_seams),
        cmocka_unit_test(the_bytes_do_not_depend_on_the_threads),
        cmocka_unit_test(a_target_out_of_reach_is_reported),
        cmocka_unit_test(a_nearly_flat_mesh_ends_where_no_cut_is_worth_anything),
        cmocka_unit_test(the_worst_chart_is_bisected_before_its_cuts_were_probed),
        cmocka_unit_test(a_bound_on_sewings_ends_the_same_search_earlier),
        cmocka_unit_test(a_first_cut_that_is_protected_stays),
        cmocka_unit_test(fine_angles_take_weights_that_coarse_ones_never_do),
        cmocka_unit_test(sewing_keeps_the_targets_and_shortens_the_seams),
        cmocka_unit_test(scaling_by_a_power_of_two_changes_no_byte),
        cmocka_unit_test(cancelling_leaves_the_mesh_as_it_was),
        cmocka_unit_test(solves_that_run_side_by_side_hear_that_all_is_over),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
