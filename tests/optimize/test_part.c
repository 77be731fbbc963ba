/* Charts that overlap themselves where they are stretched least, and the cuts that part them. */
#include "mesh/build.h"
#include "optimize/checks.h"
#include "optimize/cut_internal.h"

enum { ALONG = 72, ACROSS = 4, VERTICES = (ALONG + 1) * (ACROSS + 1) };

/* A ramp that winds up around the z axis, nearly flat: laid flat it lies on itself after one turn. */
static sl_mesh *ramp(test_rng *rng, double turn, double inner, bool quads)
{
    double xyz[3 * VERTICES];
    int32_t index[6 * ALONG * ACROSS], first[2 * ALONG * ACROSS + 1] = {0}, nf = 0, n = 0;
    for (int32_t v = 0; v < VERTICES; v++) {
        const double a = turn * (v / (ACROSS + 1)) / ALONG;
        const double r = inner + (double)(v % (ACROSS + 1)) / ACROSS + test_uniform(rng, -0.01, 0.01);
        xyz[3 * v] = r * cos(a);
        xyz[3 * v + 1] = r * sin(a);
        xyz[3 * v + 2] = 0.02 * a + test_uniform(rng, -0.003, 0.003);
    }
    for (int32_t i = 0; i < ALONG; i++) {
        for (int32_t j = 0; j < ACROSS; j++) {
            const int32_t v = i * (ACROSS + 1) + j, w = v + ACROSS + 1;
            const int32_t quad[4] = {v, v + 1, w + 1, w}, pair[6] = {v, v + 1, w + 1, v, w + 1, w};
            const bool whole = quads && test_index(rng, 3) > 0;
            memcpy(index + n, whole ? quad : pair, (whole ? 4 : 6) * sizeof *index);
            for (int k = 0; k < (whole ? 1 : 2); k++) {
                n += whole ? 4 : 3;
                first[++nf] = n;
            }
        }
    }
    const sl_polygons polygons = {VERTICES, nf, xyz, first, index};
    sl_mesh *mesh = NULL;
    assert_int_equal(sl_mesh_build(&polygons, &mesh, NULL, NULL), SL_OK);
    return mesh;
}

/* The whole surface as one chart under uv (nv x 2 of the surface's patch). */
static sl_opt_state one_chart(const test_surface *s, const sl_optimize_def *def, const double *uv)
{
    sl_opt_state state;
    const sl_patch *p = s->surface.patch;
    assert_int_equal(sl_opt_state_init(&s->surface, def, NULL, &state), SL_OK);
    int32_t *local = malloc(sizeof *local * (size_t)p->nt), *list = malloc(sizeof *list * (size_t)p->nt);
    for (int32_t t = 0; t < p->nt; t++) {
        local[t] = -1;
        list[t] = t;
        state.chart_of[t] = 0;
    }
    assert_int_equal(sl_reserve((void **)&state.chart, &state.capacity, 1, sizeof *state.chart), SL_OK);
    sl_opt_chart *chart = &state.chart[state.nchart++];
    *chart = (sl_opt_chart){.uv = sl_calloc(2 * (int64_t)p->nv, sizeof(double)), .stamp = state.next_stamp++};
    assert_int_equal(sl_opt_extract(&s->surface, state.cut, list, p->nt, local, &chart->patch), SL_OK);
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        memcpy(state.uv + 2 * c, uv + 2 * p->tri[c], 2 * sizeof *uv);
        memcpy(chart->uv + 2 * chart->patch->tri[c], uv + 2 * p->tri[chart->patch->corner[c]], 2 * sizeof *uv);
    }
    sl_opt_measure(&s->surface, chart->patch, chart->uv, &chart->sums, NULL);
    sl_opt_weigh(&state);
    free(local);
    free(list);
    return state;
}

/* A spiral that moves out by `pitch` a turn and so keeps clear of itself: embedded, but stretched. */
static sl_opt_state wound_up(const test_surface *s, const sl_optimize_def *def, double turn, double inner, double pitch)
{
    const sl_patch *p = s->surface.patch;
    double *uv = malloc(2 * sizeof *uv * (size_t)p->nv);
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        const int32_t v = s->mesh->origin[p->corner[c]]; /* the mesh keeps the order of the vertices */
        const double a = turn * (v / (ACROSS + 1)) / ALONG;
        const double r = inner + (double)(v % (ACROSS + 1)) / ACROSS + pitch * a / (2.0 * acos(-1.0));
        uv[2 * p->tri[c]] = r * cos(a);
        uv[2 * p->tri[c] + 1] = r * sin(a);
    }
    const sl_opt_state state = one_chart(s, def, uv);
    free(uv);
    return state;
}

static double width(const sl_mesh *mesh)
{
    double sum = 0.0;
    for (int k = 0; k < 3; k++) {
        const double gap = mesh->xyz[3 * ACROSS + k] - mesh->xyz[k];
        sum += gap * gap;
    }
    return sqrt(sum);
}

static void a_ramp_is_parted_into_turns_that_lie_nearly_flat(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x9a27);
    const double pi = acos(-1.0), turn[] = {2.0 * pi + 0.004, 2.6 * pi, 3.3 * pi, 4.7 * pi}; /* sub-texel, twice, all */
    for (int trial = 0; trial < 8 * test_multiplier(); trial++) {
        const sl_optimize_def def = sl_optimize_default();
        const double inner = test_uniform(&rng, 0.2, 0.9);
        test_surface s = test_surface_of(ramp(&rng, turn[trial % 4], inner, trial % 3 == 1));
        sl_opt_state opt = wound_up(&s, &def, turn[trial % 4], inner, 1.6);
        test_check_state(&opt);
        sl_certificate before, free_map;
        assert_int_equal(sl_opt_certify(opt.chart[0].patch, opt.chart[0].uv, &before), SL_OK);
        assert_true(before.embedded);
        double *uv = sl_copy(opt.chart[0].uv, 2 * (int64_t)opt.chart[0].patch->nv, sizeof *uv);
        bool embedded;
        assert_int_equal(sl_opt_solve(&opt, opt.chart[0].patch, SL_OPT_SEWN, uv, &embedded), SL_OK);
        assert_int_equal(sl_opt_certify(opt.chart[0].patch, uv, &free_map), SL_OK);
        assert_true(!embedded && free_map.border_crossings > 0); /* what is to be shown at all */
        sl_free(uv);

        const double loss = sl_opt_loss(&opt, &opt.chart[0].sums);
        sl_opt_trial parting;
        assert_int_equal(sl_opt_part(&opt, 0, &parting), SL_OK);
        assert_true(parting.valid && parting.settled && parting.nto >= 2);
        assert_true(parting.loss < 0.05 * loss);
        /* as many cuts straight across as turns begun, and some slack */
        assert_true(parting.length * s.surface.unit < 1.5 * width(s.mesh) * ceil(turn[trial % 4] / (2.0 * pi)));
        assert_int_equal(sl_opt_apply(&opt, &parting), SL_OK);
        test_check_state(&opt);
        for (int32_t c = 0; c < opt.nchart; c++) {
            assert_int_equal(sl_opt_certify(opt.chart[c].patch, opt.chart[c].uv, &before), SL_OK);
            assert_true(before.embedded);
        }
        sl_opt_state_clear(&opt);
        test_surface_clear(&s);
    }
}

static void a_chart_that_does_not_overlap_is_not_parted(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x9a28);
    const sl_optimize_def def = sl_optimize_default();
    test_surface s = test_surface_of(ramp(&rng, 5.0, 0.5, false));
    sl_opt_state opt = wound_up(&s, &def, 5.0, 0.5, 1.6);
    sl_opt_trial parting;
    assert_int_equal(sl_opt_part(&opt, 0, &parting), SL_OK);
    assert_true(!parting.valid && parting.nedge == 0);
    sl_opt_trial_clear(&parting);
    sl_opt_state_clear(&opt);
    test_surface_clear(&s);
}

/* Through the whole search: found as a candidate, within the bounds of single charts. */
static void a_ramp_of_three_turns_meets_its_targets(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x9a29);
    for (int trial = 0; trial < 2 * test_multiplier(); trial++) {
        sl_mesh *mesh = ramp(&rng, 18.0, 0.4, trial % 2 == 1);
        sl_triangulation *t = test_triangulate(mesh);
        sl_optimize_def def = sl_optimize_default();
        const sl_segment_def segment = sl_segment_default();
        sl_segmentation *seg = NULL;
        sl_optimize_info info;
        def.max_angle = 1.3;
        assert_int_equal(sl_optimize_segment(mesh, t, &segment, &def, NULL, &seg, &info), SL_OK);
        assert_true(info.failed == 0 && info.missed == 0);
        assert_true(seg->nchart <= 6);
        for (int32_t c = 0; c < seg->nchart; c++) {
            assert_true(seg->chart[c].flat.distortion.angle_mean <= def.max_angle);
        }
        sl_segmentation_free(seg);
        sl_triangulation_free(t);
        sl_mesh_free(mesh);
    }
}

static bool is_embedded(const sl_opt_trial *trial)
{
    bool embedded = trial->nto > 0;
    for (int32_t k = 0; k < trial->nto; k++) {
        sl_certificate certificate;
        assert_int_equal(sl_opt_certify(trial->to[k].patch, trial->to[k].uv, &certificate), SL_OK);
        embedded = embedded && certificate.embedded;
    }
    return embedded;
}

/* Halves of more than a turn each overlap when let go, whatever they start from. */
static void halves_that_overlap_when_let_go_keep_the_map_of_their_chart(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x9a2a);
    const double pi = acos(-1.0);
    int32_t overlapped = 0;
    for (int trial = 0; trial < 4 * test_multiplier(); trial++) {
        const sl_optimize_def def = sl_optimize_default();
        const double inner = test_uniform(&rng, 0.3, 0.9), turn = test_uniform(&rng, 4.9, 6.5) * pi;
        test_surface s = test_surface_of(ramp(&rng, turn, inner, trial % 2 == 1));
        sl_opt_state opt = wound_up(&s, &def, turn, inner, 1.1);
        const double loss = sl_opt_loss(&opt, &opt.chart[0].sums);
        sl_opt_trial halves[2] = {{0}, {0}};
        int32_t count = 0;
        assert_int_equal(sl_opt_bisections(&opt, 0, halves, &count), SL_OK);
        assert_true(count > 0);
        for (int32_t k = 0; k < count; k++) {
            assert_int_equal(sl_opt_trial_make(&opt, &halves[k]), SL_OK);
            assert_int_equal(sl_opt_trial_probe(&opt, 4, &halves[k]), SL_OK);
            assert_int_equal(sl_opt_trial_settle(&opt, SL_OPT_WARM, &halves[k]), SL_OK);
            overlapped += !halves[k].valid;
            assert_int_equal(sl_opt_trial_settle(&opt, SL_OPT_WARM_ONLY, &halves[k]), SL_OK);
            assert_true(halves[k].valid && halves[k].settled && is_embedded(&halves[k]));
            assert_true(halves[k].loss < loss);
            sl_opt_trial_clear(&halves[k]);
        }
        sl_opt_state_clear(&opt);
        test_surface_clear(&s);
    }
    assert_true(overlapped > 0); /* what is to be shown at all */
}

static sl_opt_trial first_halves(const sl_opt_state *state)
{
    sl_opt_trial halves[2] = {{0}, {0}};
    int32_t count = 0;
    assert_int_equal(sl_opt_bisections(state, 0, halves, &count), SL_OK);
    assert_true(count > 0);
    sl_opt_trial_clear(&halves[1]);
    assert_int_equal(sl_opt_trial_make(state, &halves[0]), SL_OK);
    assert_int_equal(sl_opt_trial_probe(state, 4, &halves[0]), SL_OK);
    halves[0].probed = true;
    return halves[0];
}

/* Not laid flat from nothing, as darts are. */
static void halves_that_overlap_are_chosen_as_their_chart_lies(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x9a2b);
    for (int trial = 0; trial < 2 * test_multiplier(); trial++) {
        sl_optimize_def def = sl_optimize_default();
        const double inner = test_uniform(&rng, 0.3, 0.9), turn = test_uniform(&rng, 15.5, 20.0);
        test_surface s = test_surface_of(ramp(&rng, turn, inner, trial % 2 == 1));
        sl_opt_state opt = wound_up(&s, &def, turn, inner, 1.1);
        sl_opt_trial held = first_halves(&opt);
        assert_int_equal(sl_opt_trial_settle(&opt, SL_OPT_WARM_ONLY, &held), SL_OK);
        sl_opt_pool pool = {0};
        int64_t taken = -1;
        assert_int_equal(sl_opt_pool_refresh(&opt, &pool), SL_OK);
        while (pool.count > 0) {
            sl_opt_pool_drop(&pool, pool.count - 1);
        }
        assert_int_equal(sl_reserve((void **)&pool.parted, &pool.parted_capacity, 1, sizeof *pool.parted), SL_OK);
        pool.parted[pool.nparted++] = pool.stamp[0] = opt.chart[0].stamp; /* or parting would be chosen */
        pool.trial[pool.count++] = first_halves(&opt);
        assert_int_equal(sl_opt_choose(&opt, &pool, &taken), SL_OK);
        assert_int_equal(taken, 0);
        assert_true(pool.trial[0].promise > 0.0 && pool.trial[0].settled);
        assert_true(pool.trial[0].loss == held.loss);
        sl_opt_trial_clear(&held);
        sl_opt_pool_clear(&pool);
        sl_opt_state_clear(&opt);
        test_surface_clear(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ramp_is_parted_into_turns_that_lie_nearly_flat),
        cmocka_unit_test(a_chart_that_does_not_overlap_is_not_parted),
        cmocka_unit_test(a_ramp_of_three_turns_meets_its_targets),
        cmocka_unit_test(halves_that_overlap_when_let_go_keep_the_map_of_their_chart),
        cmocka_unit_test(halves_that_overlap_are_chosen_as_their_chart_lies),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
