/* How the ABF++ solver behaves: what it reports, when it stops, what it refuses. */
#include "param/abf.h"
#include "param/abf_sectors.h"

#include "param/abf_charts.h"
#include "param/abf_internal.h"

#define PI TEST_PI

static sl_abf *make_solver(const sl_patch *patch, const sl_abf_def *def)
{
    sl_abf *solver = NULL;
    assert_int_equal(sl_abf_create(patch, def, &solver), SL_OK);
    return solver;
}

static sl_abf *solve(const sl_patch *patch, const sl_abf_def *def)
{
    sl_abf *solver = make_solver(patch, def);
    assert_int_equal(sl_abf_step(solver, def->max_iterations, NULL), SL_OK);
    return solver;
}

static void flat_charts_stay_as_they_are(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 10; seed++) {
        sl_patch *patch = chart_grid(7, 6, 0.3, chart_plane, 0.4, seed);
        const sl_abf_def def = sl_abf_default();
        double *beta = malloc(3 * (size_t)patch->nt * sizeof *beta);
        sl_corner_angles(patch, beta);
        sl_abf *solver = solve(patch, &def);
        const sl_abf_info *info = sl_abf_info_of(solver);
        assert_true(info->converged && !info->stalled && info->iterations == 0 && info->energy < 1e-20);
        assert_true(chart_max_diff(sl_abf_angles(solver), beta, 3 * patch->nt) <= 1e-13);
        sl_abf_free(solver);
        free(beta);
        sl_patch_free(patch);
    }
}

/* A cone is developable but for its apex: everywhere else the optimum is near, at the apex the turn is made up. */
static void info_tells_what_the_angles_say(void **state)
{
    (void)state;
    sl_patch *patch = chart_hexagon(4, 0.2, chart_cone, 0.9, 0x1f0);
    const sl_abf_def def = sl_abf_default();
    sl_abf *solver = make_solver(patch, &def);
    const sl_abf_info *info = sl_abf_info_of(solver);
    assert_int_equal(info->iterations, 0);
    assert_true(!info->converged && info->g1 > 1e-3);
    for (int32_t i = 1; !info->converged && i < 20; i++) {
        const sl_abf_view view = sl_abf_view_of(solver);
        assert_int_equal(sl_abf_step(solver, 1, NULL), SL_OK);
        assert_int_equal(info->iterations, i);
        const double *alpha = sl_abf_angles(solver);
        double energy = 0.0, smallest = 4.0, g1[96], g2[37], g3[37], zero[96] = {0};
        for (int32_t c = 0; c < 3 * patch->nt; c++) {
            energy += view.w[c] * (alpha[c] - view.phi[c]) * (alpha[c] - view.phi[c]);
            smallest = fmin(smallest, alpha[c]);
        }
        sl_abf_eval_g1(patch, alpha, g1);
        sl_abf_eval_g2(view.system->sectors, alpha, g2);
        sl_abf_eval_g3(patch, SL_ABF_LOG, alpha, g3);
        assert_int_equal(view.system->nsectors, 37);
        assert_true(test_near(info->energy, energy, 1e-12 * energy) && info->min_angle == smallest);
        assert_true(info->g1 == chart_max_diff(g1, zero, 96) && info->g2 == chart_max_diff(g2, zero, 37));
        assert_true(info->g3 == chart_max_diff(g3, zero, 37) && info->step == 1.0);
    }
    assert_true(info->converged && info->gradient <= def.gradient_tolerance);
    sl_abf_free(solver);
    sl_patch_free(patch);
}

static void steps_taken_singly_give_the_same_bytes(void **state)
{
    (void)state;
    sl_patch *patch = chart_hexagon(5, 0.2, chart_cap, PI / 2, 0x5b);
    const sl_abf_def def = sl_abf_default();
    sl_abf *at_once = solve(patch, &def), *singly = make_solver(patch, &def);
    for (int i = 0; i < 40; i++) {
        assert_int_equal(sl_abf_step(singly, 1, NULL), SL_OK);
    }
    assert_memory_equal(sl_abf_angles(at_once), sl_abf_angles(singly), 3 * (size_t)patch->nt * sizeof(double));
    assert_int_equal(sl_abf_info_of(at_once)->iterations, sl_abf_info_of(singly)->iterations);
    assert_true(sl_abf_info_of(at_once)->converged);
    sl_abf_free(at_once);
    sl_abf_free(singly);
    sl_patch_free(patch);
}

static void log_and_product_form_find_the_same_angles(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 8; seed++) {
        sl_patch *patch = chart_grid(5, 5, 0.15, chart_bumps, 0.8, seed);
        sl_abf_def def = sl_abf_default();
        sl_abf *log_form = solve(patch, &def);
        def.wheel = SL_ABF_PRODUCT;
        def.constraint_tolerance = 1e-11; /* products of sines are small themselves */
        sl_abf *product = solve(patch, &def);
        assert_true(sl_abf_info_of(log_form)->converged && sl_abf_info_of(product)->converged);
        assert_true(chart_max_diff(sl_abf_angles(log_form), sl_abf_angles(product), 3 * patch->nt) <= 1e-6);
        sl_abf_free(log_form);
        sl_abf_free(product);
        sl_patch_free(patch);
    }
}

static void angles_do_not_change_when_the_chart_is_moved_or_scaled(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 4; seed++) {
        sl_patch *patch = chart_hexagon(4, 0.2, chart_cap, 1.3, seed);
        const sl_abf_def def = sl_abf_default();
        sl_abf *original = solve(patch, &def);
        for (int32_t i = 0; i < 3 * patch->nv; i++) {
            patch->xyz[i] *= 0x1p-37;
        }
        sl_abf *scaled = solve(patch, &def);
        assert_memory_equal(sl_abf_angles(original), sl_abf_angles(scaled), 3 * (size_t)patch->nt * sizeof(double));
        chart_move(patch, 0x1p39, (double[]){0.3, -1.7, 5.1});
        sl_abf *moved = solve(patch, &def);
        assert_true(chart_max_diff(sl_abf_angles(original), sl_abf_angles(moved), 3 * patch->nt) <= 1e-9);
        sl_abf_free(original);
        sl_abf_free(scaled);
        sl_abf_free(moved);
        sl_patch_free(patch);
    }
}

/* Border angles whose sum contradicts Gauss-Bonnet are refused; the right sum with an angle that cannot be is not seen
 * by it: the solver stops with positive angles and says so. */
static void impossible_border_angles_are_refused_or_reported(void **state)
{
    (void)state;
    sl_patch *patch = chart_hexagon(3, 0.1, chart_cap, 0.7, 0x1b);
    sl_sector_table table = make_sectors(patch, false);
    int32_t first[64], corner[3 * 54], n = table.view.count;
    double theta[64];
    memcpy(first, table.first, (size_t)(n + 1) * sizeof *first);
    memcpy(corner, table.corner, (size_t)first[n] * sizeof *corner);
    memcpy(theta, table.theta, (size_t)n * sizeof *theta);
    for (int32_t v = 0; v < patch->nv; v++) {
        if (patch->border[v] != 0) {
            first[n + 1] = first[n];
            for (int32_t c = patch->outgoing[v]; c >= 0; c = sl_corner_rotate(patch, c)) {
                corner[first[n + 1]++] = c;
            }
            theta[n++] = 0.5 * PI; /* 18 right angles */
        }
    }
    const sl_sectors sectors = {n, first, corner, theta};
    sl_abf_def def = sl_abf_default();
    def.sectors = &sectors;
    sl_abf *solver = NULL;
    assert_int_equal(sl_abf_create(patch, &def, &solver), SL_INFEASIBLE);
    assert_null(solver);
    theta[n - 1] += 7.0 * PI;                                     /* 18 right angles turn by 9 pi, a border by 2 pi */
    assert_int_equal(sl_abf_create(patch, &def, &solver), SL_OK); /* the sum is right: what remains is for the solver */
    assert_int_equal(sl_abf_info_of(solver)->dependent, 1);
    assert_int_equal(sl_abf_step(solver, def.max_iterations, NULL), SL_OK);
    assert_false(sl_abf_info_of(solver)->converged); /* no angle is that large */
    for (int32_t c = 0; c < 3 * patch->nt; c++) {
        assert_true(sl_abf_angles(solver)[c] > 0.0 && sl_abf_angles(solver)[c] < PI);
    }
    sl_abf_free(solver);
    sl_sectors_clear(&table);
    sl_patch_free(patch);
}

/* One triangle, one of its angles asked to be more than a triangle has: the step shrinks until nothing moves. */
static void an_angle_beyond_pi_stalls_with_positive_angles(void **state)
{
    (void)state;
    static const int32_t first[] = {0, 1}, corner[] = {1};
    static const double theta[] = {3.3}, xyz[] = {0.1, 0.2, 0.3, 1.2, 0.1, 0.4, 0.5, 0.9, 0.2};
    static const int32_t tri[] = {0, 1, 2};
    const sl_sectors sectors = {1, first, corner, theta};
    sl_patch *patch = chart_make(3, xyz, 1, tri);
    sl_abf_def def = sl_abf_default();
    def.sectors = &sectors;
    sl_abf *solver = solve(patch, &def);
    const sl_abf_info *info = sl_abf_info_of(solver);
    assert_true(info->stalled && !info->converged && info->min_angle > 0.0 && info->iterations < def.max_iterations);
    double last[3];
    memcpy(last, sl_abf_angles(solver), sizeof last);
    assert_int_equal(sl_abf_step(solver, 5, NULL), SL_OK); /* a stalled solver stays where it is */
    assert_memory_equal(last, sl_abf_angles(solver), sizeof last);
    sl_abf_free(solver);
    sl_patch_free(patch);
}

/* The same sector twice: no full rank, the factorisation fails or the result is right all the same. */
static void dependent_sectors_stall_or_converge_but_never_lie(void **state)
{
    (void)state;
    sl_patch *patch = chart_hexagon(2, 0.1, chart_cap, 0.7, 0xde);
    static const int32_t first[] = {0, 2, 4}, corner[] = {4, 9, 4, 9};
    for (int contradictory = 0; contradictory < 2; contradictory++) {
        const double theta[] = {2.1, contradictory != 0 ? 2.2 : 2.1};
        const sl_sectors sectors = {2, first, corner, theta};
        sl_abf_def def = sl_abf_default();
        def.sectors = &sectors;
        sl_abf *solver = solve(patch, &def);
        const sl_abf_info *info = sl_abf_info_of(solver);
        const double sum = sl_abf_angles(solver)[4] + sl_abf_angles(solver)[9];
        assert_true(info->converged ? fabs(sum - 2.1) < 1e-9 && contradictory == 0 : info->g2 > 0.0);
        assert_true(info->min_angle > 0.0);
        sl_abf_free(solver);
    }
    sl_patch_free(patch);
}

/* A sector of one whole triangle repeats its g1: its row is left out, and its sum must be pi. */
static void a_row_that_repeats_another_is_left_out_or_refused(void **state)
{
    (void)state;
    sl_patch *patch = chart_grid(3, 3, 0.2, chart_bumps, 0.9, 0xd1);
    static const int32_t first[] = {0, 3, 5}, corner[] = {15, 16, 17, 4, 9};
    for (int contradictory = 0; contradictory < 2; contradictory++) {
        const double theta[] = {contradictory != 0 ? PI + 1e-6 : PI, 2.3};
        const sl_sectors sectors = {2, first, corner, theta};
        sl_abf_def def = sl_abf_default();
        def.sectors = &sectors;
        if (contradictory != 0) {
            sl_abf *solver;
            assert_int_equal(sl_abf_create(patch, &def, &solver), SL_INFEASIBLE);
            continue;
        }
        sl_abf *solver = solve(patch, &def);
        const sl_abf_info *info = sl_abf_info_of(solver);
        assert_true(info->converged && !info->stalled && info->dependent == 1 && info->g2 <= 1e-14);
        assert_true(sl_abf_view_of(solver).lambda2[0] == 0.0 && info->iterations > 2);
        assert_int_equal(sl_abf_set_targets(solver, (double[]){PI + 1e-6, 2.3}), SL_INFEASIBLE);
        assert_int_equal(sl_abf_set_targets(solver, (double[]){NAN, 2.3}), SL_BAD_INPUT);
        assert_true(info->converged); /* unchanged */
        sl_abf_free(solver);
    }
    sl_patch_free(patch);
}

/* Corners taken twice are not looked through: a sector of one whole triangle, given twice, is a row of zeros in M,
 * exactly so with w = 1. */
static void a_singular_system_stalls_and_is_judged_by_its_residual(void **state)
{
    (void)state;
    sl_patch *patch = chart_grid(3, 3, 0.2, chart_plane, 0.3, 0xd1);
    static const int32_t first[] = {0, 3, 6}, corner[] = {15, 16, 17, 15, 16, 17};
    for (int contradictory = 0; contradictory < 2; contradictory++) {
        const double theta[] = {PI, contradictory != 0 ? 3.0 : PI};
        const sl_sectors sectors = {2, first, corner, theta};
        sl_abf_def def = sl_abf_default();
        def.sectors = &sectors;
        def.energy = SL_ABF_UNWEIGHTED;
        def.gradient_tolerance = -1.0; /* never met, so that a step is tried */
        sl_abf *solver = make_solver(patch, &def);
        const sl_abf_info *info = sl_abf_info_of(solver);
        assert_false(info->converged || info->stalled);
        assert_int_equal(sl_abf_step(solver, 3, NULL), SL_OK);
        assert_true(info->stalled && info->iterations == 0);
        assert_true(info->converged == (contradictory == 0)); /* acceptable as it stands */
        sl_abf_free(solver);
    }
    sl_patch_free(patch);
}

/* Five-degree drags of two steps each track the angle; sixty degrees at once need more, and no allocation. */
static void drags_start_from_the_present_angles(void **state)
{
    (void)state;
    sl_patch *patch = chart_hexagon(6, 0.15, chart_cap, 0.9, 0xd4);
    sl_sector_table table = make_sectors(patch, true);
    sl_abf_def def = sl_abf_default();
    def.sectors = &table.view;
    sl_abf *solver = solve(patch, &def), *fresh = NULL;
    const int32_t last = table.view.count - 1;
    double *theta = malloc((size_t)table.view.count * sizeof *theta);
    memcpy(theta, table.theta, (size_t)table.view.count * sizeof *theta);
    for (int drag = 0; drag < 12; drag++) {
        theta[last] -= 5.0 * PI / 180.0;
        assert_int_equal(sl_abf_set_targets(solver, theta), SL_OK);
        assert_true(test_near(sl_abf_info_of(solver)->g2, 5.0 * PI / 180.0, 1e-9));
        assert_int_equal(sl_abf_step(solver, 2, NULL), SL_OK);
        assert_true(sl_abf_info_of(solver)->iterations == 2 && sl_abf_info_of(solver)->g2 <= 1e-12);
        assert_true(sl_abf_info_of(solver)->gradient < 5e-3 && sl_abf_info_of(solver)->g3 < 5e-5);
    }
    assert_int_equal(sl_abf_step(solver, 40, NULL), SL_OK); /* the release */
    assert_true(sl_abf_info_of(solver)->converged);
    table.theta[last] = theta[last];
    fresh = solve(patch, &def);
    assert_true(sl_abf_info_of(fresh)->converged);
    assert_true(chart_max_diff(sl_abf_angles(solver), sl_abf_angles(fresh), 3 * patch->nt) <= 1e-6);
    sl_abf_free(solver);
    sl_abf_free(fresh);
    sl_sectors_clear(&table);
    free(theta);
    sl_patch_free(patch);
}

/* A tolerance below what doubles can hold ends at the floor, with a word, and is accepted by the wider one. */
static void the_rounding_floor_ends_the_iteration_with_a_word(void **state)
{
    (void)state;
    sl_patch *patch = chart_hexagon(5, 0.2, chart_cap, 1.2, 0xf1);
    sl_abf_def def = sl_abf_default();
    def.constraint_tolerance = 1e-19;
    def.max_iterations = 100;
    sl_abf *solver = solve(patch, &def);
    const sl_abf_info *info = sl_abf_info_of(solver);
    assert_true(info->converged && info->floor && info->iterations < 60);
    assert_true(info->g1 < 1e-14 && info->g2 < 1e-14 && info->g3 < 1e-13);
    sl_abf_free(solver);
    sl_patch_free(patch);
}

/* With the gradient left out of account, g3 alone decides: it is the last to vanish. */
static void convergence_waits_for_every_constraint(void **state)
{
    (void)state;
    sl_patch *patch = chart_hexagon(4, 0.2, chart_cap, 1.4, 0xec);
    sl_abf_def def = sl_abf_default();
    def.gradient_tolerance = def.accept_gradient = 1e9;
    sl_abf *solver = make_solver(patch, &def);
    const sl_abf_info *info = sl_abf_info_of(solver);
    assert_int_equal(sl_abf_step(solver, 1, NULL), SL_OK);
    assert_true(info->g1 < 1e-12 && info->g2 < 1e-12 && info->g3 > 1e-6);
    assert_false(info->converged);
    assert_int_equal(sl_abf_step(solver, 20, NULL), SL_OK);
    assert_true(info->converged && info->g3 <= def.constraint_tolerance);
    sl_abf_free(solver);
    sl_patch_free(patch);
}

static void a_prescribed_border_angle_is_met(void **state)
{
    (void)state;
    sl_patch *patch = chart_hexagon(4, 0.1, chart_cap, 0.9, 0xb0);
    sl_sector_table table = make_sectors(patch, true);
    sl_abf_def def = sl_abf_default();
    def.sectors = &table.view;
    sl_abf *solver = solve(patch, &def);
    assert_true(sl_abf_info_of(solver)->converged);
    const int32_t s = table.view.count - 1;
    double sum = 0.0;
    for (int32_t p = table.first[s]; p < table.first[s + 1]; p++) {
        sum += sl_abf_angles(solver)[table.corner[p]];
    }
    assert_true(test_near(sum, 0.83 * PI, 1e-12));
    sl_abf_free(solver);
    sl_sectors_clear(&table);
    sl_patch_free(patch);
}

static void an_iteration_limit_accepts_only_small_gradients(void **state)
{
    (void)state;
    sl_patch *patch = chart_hexagon(4, 0.2, chart_cap, 1.2, 0x11);
    sl_abf_def def = sl_abf_default();
    def.max_iterations = 1;
    sl_abf *solver = solve(patch, &def);
    assert_false(sl_abf_info_of(solver)->converged);
    assert_int_equal(sl_abf_info_of(solver)->iterations, 1);
    sl_abf_free(solver);
    def.max_iterations = 4;
    def.gradient_tolerance = 0.0; /* never met: the bound ends it, and it is good enough */
    def.accept_gradient = 1e-2;
    def.constraint_tolerance = 1e-4;
    solver = solve(patch, &def);
    assert_true(sl_abf_info_of(solver)->converged);
    assert_int_equal(sl_abf_info_of(solver)->iterations, 4);
    sl_abf_free(solver);
    sl_patch_free(patch);
}

static void create_refuses_unusable_sectors(void **state)
{
    (void)state;
    sl_patch *patch = chart_hexagon(2, 0.1, chart_cap, 0.7, 0xce);
    static const int32_t empty[] = {0, 0}, first[] = {0, 1}, corner[] = {72};
    static const double theta[] = {1.0};
    sl_abf_def def = sl_abf_default();
    sl_abf *solver = (sl_abf *)&def;
    def.sectors = &(sl_sectors){1, empty, corner, theta};
    assert_int_equal(sl_abf_create(patch, &def, &solver), SL_INFEASIBLE);
    assert_null(solver);
    def.sectors = &(sl_sectors){1, first, corner, theta};
    assert_int_equal(sl_abf_create(patch, &def, &solver), SL_BAD_INPUT);
    sl_abf_free(NULL);
    sl_patch_free(patch);
}

static void cancelling_keeps_the_angles_of_the_last_step(void **state)
{
    (void)state;
    sl_patch *patch = chart_hexagon(4, 0.2, chart_cap, 1.2, 0xca);
    const sl_abf_def def = sl_abf_default();
    int left = 2;
    const sl_context context = {.progress = chart_cancel_after, .progress_user = &left};
    sl_abf *solver = make_solver(patch, &def), *two = make_solver(patch, &def);
    assert_int_equal(sl_abf_step(solver, 40, &context), SL_CANCELLED);
    assert_int_equal(sl_abf_step(two, 2, NULL), SL_OK);
    assert_int_equal(sl_abf_info_of(solver)->iterations, 2);
    assert_memory_equal(sl_abf_angles(solver), sl_abf_angles(two), 3 * (size_t)patch->nt * sizeof(double));
    sl_abf_free(solver);
    sl_abf_free(two);
    sl_patch_free(patch);
}

/* Charts without interior vertices have only g1. */
static void strips_converge_at_once(void **state)
{
    (void)state;
    sl_patch *patch = chart_grid(9, 1, 0.2, chart_bumps, 2.0, 0x57);
    const sl_abf_def def = sl_abf_default();
    sl_abf_info info;
    double uv[40];
    assert_int_equal(sl_abf_flatten(patch, &def, NULL, uv, &info), SL_OK);
    assert_true(info.converged && info.energy < 1e-20);
    double beta[54], alpha[54];
    sl_corner_angles(patch, beta);
    chart_uv_angles(patch, uv, alpha);
    assert_true(chart_max_diff(alpha, beta, 3 * patch->nt) <= 1e-12);
    sl_patch_free(patch);
}

static void flatten_lays_out_the_solved_angles(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 5; seed++) {
        sl_patch *patch = chart_hexagon(6, 0.2, chart_cap, PI / 2, seed);
        const size_t nc = 3 * (size_t)patch->nt;
        const sl_abf_def def = sl_abf_default();
        sl_abf *solver = solve(patch, &def);
        double *uv = malloc(2 * (size_t)patch->nv * sizeof *uv), *alpha = malloc(nc * sizeof *alpha);
        sl_abf_info info;
        assert_int_equal(sl_abf_flatten(patch, &def, NULL, uv, &info), SL_OK);
        assert_memory_equal(&info.energy, &sl_abf_info_of(solver)->energy, sizeof info.energy);
        assert_true(info.converged);
        chart_uv_angles(patch, uv, alpha);
        assert_true(chart_max_diff(alpha, sl_abf_angles(solver), (int64_t)nc) <= 1e-9);
        assert_true(test_near_rel(chart_uv_area(patch, uv), chart_area(patch), 1e-13));
        int left = 1;
        const sl_context context = {.progress = chart_cancel_after, .progress_user = &left};
        assert_int_equal(sl_abf_flatten(patch, &def, &context, uv, NULL), SL_CANCELLED);
        sl_abf_free(solver);
        free(uv);
        free(alpha);
        sl_patch_free(patch);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(flat_charts_stay_as_they_are),
        cmocka_unit_test(info_tells_what_the_angles_say),
        cmocka_unit_test(steps_taken_singly_give_the_same_bytes),
        cmocka_unit_test(log_and_product_form_find_the_same_angles),
        cmocka_unit_test(angles_do_not_change_when_the_chart_is_moved_or_scaled),
        cmocka_unit_test(impossible_border_angles_are_refused_or_reported),
        cmocka_unit_test(an_angle_beyond_pi_stalls_with_positive_angles),
        cmocka_unit_test(dependent_sectors_stall_or_converge_but_never_lie),
        cmocka_unit_test(a_row_that_repeats_another_is_left_out_or_refused),
        cmocka_unit_test(a_singular_system_stalls_and_is_judged_by_its_residual),
        cmocka_unit_test(drags_start_from_the_present_angles),
        cmocka_unit_test(the_rounding_floor_ends_the_iteration_with_a_word),
        cmocka_unit_test(convergence_waits_for_every_constraint),
        cmocka_unit_test(a_prescribed_border_angle_is_met),
        cmocka_unit_test(an_iteration_limit_accepts_only_small_gradients),
        cmocka_unit_test(create_refuses_unusable_sectors),
        cmocka_unit_test(cancelling_keeps_the_angles_of_the_last_step),
        cmocka_unit_test(strips_converge_at_once),
        cmocka_unit_test(flatten_lays_out_the_solved_angles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
