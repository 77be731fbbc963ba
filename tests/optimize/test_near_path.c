/* Paths near a line, what coarse edges cost, and maps guessed from coarse ones. */
#include "optimize/checks.h"
#include "optimize/near_path_internal.h"

/* Squared distance of vertex v from the line, point by point of a fine division. */
static double off_line(const sl_near_path *path, int32_t v)
{
    const double *xyz = path->surface->patch->xyz;
    double least = HUGE_VAL;
    for (int32_t k = 0; k + 1 < path->nline; k++) {
        for (int i = 0; i <= 2000; i++) {
            double sum = 0.0;
            for (int j = 0; j < 3; j++) {
                const double a = xyz[3 * path->line[k] + j], b = xyz[3 * path->line[k + 1] + j];
                const double x = xyz[3 * v + j] - a - i / 2000.0 * (b - a);
                sum += x * x;
            }
            least = fmin(least, sum);
        }
    }
    return least / (path->width * path->width);
}

/* Cost with the corridor's part, by Bellman and Ford. */
static double least_cost(const sl_near_path *path, double *off)
{
    const sl_opt_surface *s = path->surface;
    const sl_patch *p = s->patch;
    double *cost = malloc(sizeof *cost * (size_t)p->nv);
    bool changed = true;
    for (int32_t v = 0; v < p->nv; v++) {
        cost[v] = v == path->line[0] ? 0.0 : HUGE_VAL;
        off[v] = off_line(path, v);
    }
    const int32_t goal = path->line[path->nline - 1];
    while (changed) {
        changed = false;
        for (int32_t h = 0; h < 3 * p->nt; h++) {
            const int32_t v = p->tri[h], w = p->tri[sl_corner_next(h)];
            const bool open = w == goal || (path->taken[w] == 0 && p->border[w] == 0);
            if (p->twin[h] >= 0 && v != goal && open && cost[v] + s->cost[h] * (1.0 + off[w]) < cost[w]) {
                cost[w] = cost[v] + s->cost[h] * (1.0 + off[w]);
                changed = true;
            }
        }
    }
    const double found = cost[goal];
    free(cost);
    return found;
}

static void paths_are_the_cheapest_in_their_corridor(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x9a78);
    for (int trial = 0; trial < 6 * test_multiplier(); trial++) {
        test_surface s = test_surface_of(trial % 2 == 0 ? test_spiky_mesh(&rng, 7, 3, 0.7, TEST_TRIANGLES)
                                                        : test_patch_mesh(&rng, 11, 9, TEST_TRIANGLES, NULL));
        const sl_patch *p = s.surface.patch;
        double *off = malloc(sizeof *off * (size_t)p->nv), cost;
        sl_near_path path;
        assert_int_equal(sl_near_path_init(&s.surface, 3, &path), SL_OK);
        for (int k = 0; k < 8; k++) {
            path.nline = 3;
            for (int i = 0; i < 3; i++) {
                path.line[i] = (int32_t)test_uniform(&rng, 0.0, p->nv);
            }
            for (int32_t v = 0; v < p->nv; v++) {
                path.taken[v] = test_uniform(&rng, 0.0, 1.0) < 0.2;
            }
            path.width = test_uniform(&rng, 0.1, 0.5) * s.surface.unit;
            const int32_t goal = path.line[2];
            const double least = least_cost(&path, off);
            assert_int_equal(sl_near_path_find(&path, &cost), SL_OK);
            assert_true((cost < HUGE_VAL) == (least < HUGE_VAL));
            double sum = 0.0, plain = 0.0;
            for (int32_t v = goal; cost < HUGE_VAL && v != path.line[0]; v = p->tri[path.parent[v]]) {
                assert_true(v == goal || (path.taken[v] == 0 && p->border[v] == 0));
                sum += s.surface.cost[path.parent[v]] * (1.0 + off[v]);
                plain += s.surface.cost[path.parent[v]];
            }
            assert_true(cost == HUGE_VAL || (test_near(sum, least, 1e-3 * least) && test_near(plain, cost, 1e-12)));
        }
        sl_near_path_clear(&path);
        free(off);
        test_surface_clear(&s);
    }
}

/* Nothing removed: an edge is its own cheapest path, and the guess is the map itself. */
static void on_the_same_mesh_edges_cost_their_length_and_guesses_are_exact(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x6e55);
    const sl_optimize_def def = sl_optimize_default();
    test_surface fine = test_surface_of(test_spiky_mesh(&rng, 9, 3, 0.5, TEST_TRIANGLES));
    sl_mesh *mesh = NULL;
    int32_t *vertex = NULL;
    assert_int_equal(sl_opt_decimate(fine.surface.patch, fine.surface.patch->nt, &mesh, &vertex), SL_OK);
    assert_int_equal(mesh->nf, fine.surface.patch->nt);
    double *weight = malloc(sizeof *weight * (size_t)mesh->nh);
    assert_int_equal(sl_opt_coarse_weights(&fine.surface, mesh, vertex, weight), SL_OK);
    for (int32_t h = 0; h < mesh->nh; h++) {
        assert_true(test_near(weight[h], 1.0, 1e-12));
    }
    test_surface coarse = test_surface_of(mesh);
    sl_opt_state there = test_started(&coarse, &def), here;
    bool carried = false;
    assert_int_equal(sl_opt_state_init(&fine.surface, &def, NULL, &here), SL_OK);
    assert_int_equal(sl_opt_carry(&there, vertex, &here, &carried), SL_OK);
    assert_true(carried && here.nchart == there.nchart);
    assert_int_equal(sl_opt_guess(&there, vertex, &here), SL_OK);
    const double scale = fine.surface.unit / coarse.surface.unit;
    int32_t exact = 0, inner = 0;
    for (int32_t h = 0; h < 3 * coarse.surface.patch->nt; h++) { /* by position: the charts' numbers may differ */
        const int32_t v = sl_opt_fine_vertex(&coarse.surface, vertex, h);
        for (int64_t c = 0; c < here.nchart; c++) {
            const sl_patch *p = here.chart[c].patch;
            for (int32_t i = 0; i < p->nv; i++) {
                if (p->border[i] == 0 && fine.surface.patch->tri[p->corner[p->outgoing[i]]] == v) {
                    const double *uv = here.chart[c].uv + 2 * (int64_t)i, *was = there.uv + 2 * (int64_t)h;
                    inner++;
                    exact += hypot(uv[0] - scale * was[0], uv[1] - scale * was[1]) < 1e-9;
                }
            }
        }
    }
    assert_true(inner > 0 && exact > 0.9 * inner); /* but where a path took another way than the arc */
    sl_opt_state_clear(&here);
    sl_opt_state_clear(&there);
    free(weight);
    sl_free(vertex);
    test_surface_clear(&coarse);
    test_surface_clear(&fine);
}

/* A piece above both bounds: searched, tried, solved; its targets met, its charts proven. */
static void a_large_piece_meets_its_targets(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x1a96e);
    sl_optimize_def def = sl_optimize_default();
    def.weights = sl_seam_cost_none();
    test_surface s = test_surface_of(test_spiky_mesh(&rng, 64, 3, 0.5, TEST_TRIANGLES));
    assert_true(s.surface.patch->nt > 48000);
    const sl_segment_def segment = sl_segment_default();
    sl_opt_state large;
    bool done = false;
    assert_int_equal(sl_opt_state_init(&s.surface, &def, NULL, &large), SL_OK);
    assert_int_equal(sl_opt_piece(&large, &segment, s.triangulation, &done), SL_OK);
    assert_true(done);
    test_check_state(&large);
    sl_opt_total total;
    sl_opt_totals(&large, &total);
    assert_true(sl_opt_within(&large, &total));
    for (int64_t c = 0; c < large.nchart; c++) {
        sl_certificate certificate;
        assert_int_equal(sl_opt_certify(large.chart[c].patch, large.chart[c].uv, &certificate), SL_OK);
        assert_true(certificate.embedded);
    }
    sl_opt_state_clear(&large);
    test_surface_clear(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(paths_are_the_cheapest_in_their_corridor),
        cmocka_unit_test(on_the_same_mesh_edges_cost_their_length_and_guesses_are_exact),
        cmocka_unit_test(a_large_piece_meets_its_targets),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
