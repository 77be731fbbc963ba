/* A chart in hand: drags, releases, targets that cannot be reached. */
#include "param/abf_chart.h"
#include "param/abf_charts.h"
#include "param/abf_sectors.h"

#define PI TEST_PI

typedef struct fixture {
    sl_patch *patch;
    sl_sector_table table;
    sl_abf_def def;
    double *theta;
    int32_t last; /* the sector of a border vertex's angle */
} fixture;

static fixture make(int32_t rings, uint64_t seed)
{
    fixture f = {.patch = chart_hexagon(rings, 0.15, chart_cap, 0.9, seed), .def = sl_abf_default()};
    f.table = make_sectors(f.patch, true);
    f.last = f.table.view.count - 1;
    f.theta = malloc((size_t)f.table.view.count * sizeof *f.theta);
    memcpy(f.theta, f.table.theta, (size_t)f.table.view.count * sizeof *f.theta);
    return f;
}

static void clear(fixture *f)
{
    sl_sectors_clear(&f->table);
    sl_patch_free(f->patch);
    free(f->theta);
}

static sl_abf_chart *open_chart(const fixture *f)
{
    sl_abf_chart *chart = NULL;
    sl_abf_def def = f->def;
    def.sectors = &f->table.view;
    assert_int_equal(sl_abf_chart_create(f->patch, &def, NULL, &chart), SL_OK);
    return chart;
}

/* What is held must be valid and must be what info says of it. */
static void check_held(const fixture *f, const sl_abf_chart *chart)
{
    const sl_abf_chart_info *info = sl_abf_chart_info_of(chart);
    const size_t nc = 3 * (size_t)f->patch->nt;
    double *angle = malloc(nc * sizeof *angle), worst = 0.0, sum;
    chart_uv_angles(f->patch, sl_abf_chart_uv(chart), angle);
    assert_true(info->valid && info->quality.flipped == 0 && info->quality.area_ratio >= 1.0);
    for (size_t c = 0; c < nc; c++) {
        assert_true(angle[c] > 0.0 && sl_abf_chart_angles(chart)[c] > 0.0);
    }
    assert_true(
        test_near(info->quality.angle_error, chart_max_diff(angle, sl_abf_chart_angles(chart), (int64_t)nc), 1e-12));
    for (int32_t s = 0; s < f->table.view.count; s++) {
        sum = -f->theta[s];
        for (int32_t p = f->table.first[s]; p < f->table.first[s + 1]; p++) {
            sum += sl_abf_chart_angles(chart)[f->table.corner[p]];
        }
        worst = fmax(worst, fabs(sum));
    }
    assert_true(test_near(info->distance, worst, 1e-12));
    free(angle);
}

static void a_chart_opens_with_its_constraints_met(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 4; seed++) {
        fixture f = make(5, seed);
        sl_abf_chart *chart = open_chart(&f);
        const sl_abf_chart_info *info = sl_abf_chart_info_of(chart);
        double *uv = malloc(2 * (size_t)f.patch->nv * sizeof *uv);
        check_held(&f, chart);
        assert_true(info->converged && info->reached == 1.0 && info->solves == 1 && !info->rolled_back);
        assert_true(info->quality.angle_error <= 1e-8 && info->quality.area_ratio < 1e6 && info->distance <= 1e-11);
        f.def.sectors = &f.table.view;
        assert_int_equal(sl_abf_flatten(f.patch, &f.def, NULL, uv, NULL), SL_OK);
        assert_memory_equal(uv, sl_abf_chart_uv(chart), 2 * (size_t)f.patch->nv * sizeof *uv);
        sl_abf_chart_free(chart);
        free(uv);
        clear(&f);
    }
}

static void moves_take_two_steps_and_a_release_converges(void **state)
{
    (void)state;
    fixture f = make(6, 0xd0);
    sl_abf_chart *chart = open_chart(&f);
    const sl_abf_chart_info *info = sl_abf_chart_info_of(chart);
    for (int drag = 0; drag < 14; drag++) {
        f.theta[f.last] -= 5.0 * PI / 180.0;
        assert_int_equal(sl_abf_chart_move(chart, f.theta, NULL), SL_OK);
        assert_true(info->abf.iterations == 2 && !info->rolled_back && info->distance <= 1e-11);
        check_held(&f, chart);
    }
    assert_int_equal(sl_abf_chart_release(chart, f.theta, NULL), SL_OK);
    check_held(&f, chart);
    assert_true(info->converged && info->reached == 1.0 && info->solves == 1);
    f.table.theta[f.last] = f.theta[f.last];
    sl_abf_chart *fresh = open_chart(&f);
    assert_true(chart_max_diff(sl_abf_chart_angles(chart), sl_abf_chart_angles(fresh), 3 * f.patch->nt) <= 1e-6);
    sl_abf_chart_free(fresh);
    sl_abf_chart_free(chart);
    clear(&f);
}

/* An angle of more than its triangles have: each solve fails somewhere on the way, and the way made is told. */
static void targets_out_of_reach_are_approached_as_far_as_it_goes(void **state)
{
    (void)state;
    fixture f = make(4, 0xd1);
    sl_abf_chart *chart = open_chart(&f);
    const sl_abf_chart_info *info = sl_abf_chart_info_of(chart);
    const int32_t triangles = f.table.first[f.last + 1] - f.table.first[f.last];
    const double before = f.theta[f.last];
    f.theta[f.last] = 1.02 * triangles * PI;
    assert_int_equal(sl_abf_chart_release(chart, f.theta, NULL), SL_OK);
    check_held(&f, chart);
    assert_true(info->solves > 3 && info->reached > 0.1 && info->reached < 1.0 && info->converged);
    const double now = f.theta[f.last] - info->distance;
    assert_true(test_near(now, before + info->reached * (f.theta[f.last] - before), 1e-9));
    f.theta[f.last] = before; /* and back again */
    assert_int_equal(sl_abf_chart_release(chart, f.theta, NULL), SL_OK);
    check_held(&f, chart);
    assert_true(info->reached == 1.0 && info->distance <= 1e-11);
    sl_abf_chart_free(chart);
    clear(&f);
}

/* Moves to random turns around interior vertices: those that flip triangles are undone, bytes and all, and whatever
 * comes, what is held is valid. */
static void moves_that_flip_triangles_are_rolled_back(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xd2);
    fixture f = make(4, 0xd2);
    sl_abf_chart *chart = open_chart(&f);
    const sl_abf_chart_info *info = sl_abf_chart_info_of(chart);
    const size_t size = 2 * (size_t)f.patch->nv * sizeof(double);
    double *uv = malloc(size);
    int32_t rolled_back = 0;
    for (int32_t move = 0; move < 60; move++) {
        const double spread = move % 3 == 2 ? 0.0 : 0.2 + 0.2 * (move % 4);
        for (int32_t s = 0; s < f.last; s++) {
            f.theta[s] = f.table.theta[s] * (1.0 + test_uniform(&rng, -spread, spread));
        }
        memcpy(uv, sl_abf_chart_uv(chart), size);
        assert_int_equal(sl_abf_chart_move(chart, f.theta, NULL), SL_OK);
        check_held(&f, chart);
        if (info->rolled_back) {
            assert_memory_equal(uv, sl_abf_chart_uv(chart), size);
            assert_true(info->reached == 0.0);
            rolled_back++;
        }
    }
    assert_true(rolled_back > 0 && rolled_back < 60);
    free(uv);
    sl_abf_chart_free(chart);
    clear(&f);
}

/* From the measured angles there is no way to the targets: the chart without constraints is where the way begins. */
static void hard_targets_are_approached_from_the_free_chart(void **state)
{
    (void)state;
    fixture f = make(4, 0xd3);
    const int32_t triangles = f.table.first[f.last + 1] - f.table.first[f.last];
    f.table.theta[f.last] = f.theta[f.last] = 1.05 * triangles * PI;
    sl_abf_chart *chart = open_chart(&f);
    const sl_abf_chart_info *info = sl_abf_chart_info_of(chart);
    check_held(&f, chart);
    assert_true(info->solves > 3 && info->reached > 0.1 && info->reached < 1.0 && info->converged);
    sl_abf_chart_free(chart);
    clear(&f);
}

static void unusable_targets_change_nothing(void **state)
{
    (void)state;
    fixture f = make(4, 0xd4);
    sl_abf_chart *chart = open_chart(&f);
    const size_t size = 2 * (size_t)f.patch->nv * sizeof(double);
    double *uv = malloc(size);
    memcpy(uv, sl_abf_chart_uv(chart), size);
    f.theta[2] = NAN;
    assert_int_equal(sl_abf_chart_move(chart, f.theta, NULL), SL_BAD_INPUT);
    assert_int_equal(sl_abf_chart_release(chart, f.theta, NULL), SL_BAD_INPUT);
    f.theta[2] = 2.0 * PI;
    f.theta[f.last] += 0.2;
    for (int calls = 0; calls < 3; calls++) {
        int left = calls;
        const sl_context context = {.progress = chart_cancel_after, .progress_user = &left};
        assert_int_equal(sl_abf_chart_move(chart, f.theta, &context), SL_CANCELLED);
        left = calls;
        assert_int_equal(sl_abf_chart_release(chart, f.theta, &context), SL_CANCELLED);
    }
    assert_memory_equal(uv, sl_abf_chart_uv(chart), size);
    f.def.sectors = &(sl_sectors){1, (int32_t[]){0, 0}, (int32_t[]){0}, (double[]){1.0}};
    sl_abf_chart *refused = chart;
    assert_int_equal(sl_abf_chart_create(f.patch, &f.def, NULL, &refused), SL_INFEASIBLE);
    assert_null(refused);
    sl_abf_chart_free(NULL);
    sl_abf_chart_free(chart);
    free(uv);
    clear(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_chart_opens_with_its_constraints_met),
        cmocka_unit_test(moves_take_two_steps_and_a_release_converges),
        cmocka_unit_test(targets_out_of_reach_are_approached_as_far_as_it_goes),
        cmocka_unit_test(moves_that_flip_triangles_are_rolled_back),
        cmocka_unit_test(hard_targets_are_approached_from_the_free_chart),
        cmocka_unit_test(unusable_targets_change_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
