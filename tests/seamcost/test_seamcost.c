#include "seamcost/seamcost_internal.h"

#include "mesh/facet_graph.h"
#include "mesh/mesh_fixtures.h"

static soup s;
static int32_t partner[SOUP_FACES];
static double weight[SOUP_CORNERS], other[SOUP_CORNERS], turn[SOUP_VERTICES + 64];

/* Two quads folded by `angle` about a random axis: > 0 a ridge, < 0 a valley. */
static sl_mesh *folded(test_rng *rng, double angle)
{
    const double a = test_uniform(rng, 0.0, 6.0), b = test_uniform(rng, 0.0, 6.0), half = 0.5 * angle;
    const double w = test_uniform(rng, 0.5, 2.0), d = test_uniform(rng, 0.5, 2.0), l = test_uniform(rng, 0.3, 3.0);
    const double flat[6][3] = {{0, 0, 0},
                               {0, l, 0},
                               {w * cos(half), l, -w * sin(half)},
                               {w * cos(half), 0, -w * sin(half)},
                               {-d * cos(half), l, -d * sin(half)},
                               {-d * cos(half), 0, -d * sin(half)}};
    soup_clear(&s);
    for (int i = 0; i < 6; i++) {
        const double *p = flat[i], x = p[0] * cos(a) - p[1] * sin(a), y = p[0] * sin(a) + p[1] * cos(a);
        soup_vertex(&s, x + 3.7, y * cos(b) - p[2] * sin(b) - 1.3, y * sin(b) + p[2] * cos(b));
    }
    soup_face(&s, 4, (int32_t[]){0, 3, 2, 1});
    soup_face(&s, 4, (int32_t[]){0, 1, 4, 5});
    return soup_build(&s, NULL);
}

static void the_dihedral_angle_of_a_fold_is_its_angle(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xd1e);
    for (int trial = 0; trial < 300 * test_multiplier(); trial++) {
        const double angle = test_uniform(&rng, -3.1, 3.1);
        sl_mesh *m = folded(&rng, angle);
        int inner = 0;
        for (int32_t h = 0; h < m->nh; h++) {
            const bool inside = m->twin[h] >= 0;
            inner += inside;
            assert_true(test_near(sl_seam_dihedral(m, h), inside ? angle : 0.0, 1e-13));
        }
        assert_int_equal(inner, 2);
        assert_int_equal(sl_seam_dihedrals(m, weight), SL_OK);
        for (int32_t h = 0; h < m->nh; h++) {
            assert_true(weight[h] == sl_seam_dihedral(m, h));
        }
        sl_mesh_free(m);
    }
}

static double fold_weight(test_rng *rng, const sl_seam_cost_def *def, double angle)
{
    sl_mesh *m = folded(rng, angle);
    assert_int_equal(sl_seam_cost_compute(m, def, NULL, weight), SL_OK);
    const double w = weight[m->twin[0] >= 0 ? 0 : 3];
    sl_mesh_free(m);
    return w;
}

static void creases_cost_less_the_sharper_they_are_and_valleys_less_again(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xd1f);
    sl_seam_cost_def def = sl_seam_cost_none();
    def.crease = 0.7;
    for (int trial = 0; trial < 50 * test_multiplier(); trial++) {
        const double low = test_uniform(&rng, 0.36, 0.8), high = test_uniform(&rng, low + 0.01, 0.87);
        assert_true(fold_weight(&rng, &def, low) > fold_weight(&rng, &def, high));
        assert_true(test_near(fold_weight(&rng, &def, low), fold_weight(&rng, &def, -low), 1e-12));
    }
    assert_true(fold_weight(&rng, &def, 0.34) == 1.0);
    assert_true(test_near(fold_weight(&rng, &def, 1.4), 0.3, 1e-15));
    def.concavity = 0.5;
    def.reach = 1e-9; /* no curvature but the edge's own angle */
    assert_true(test_near(fold_weight(&rng, &def, 1.4), 0.3, 1e-15));
    assert_true(test_near(fold_weight(&rng, &def, -1.4), 0.15, 1e-15));
    def.floor = 0.2;
    assert_true(fold_weight(&rng, &def, -1.4) == 0.2);
}

/* The sum of the principal curvatures of a torus with radii 3 and 1: 1 + cos v / (3 + cos v). */
static void turns_on_a_torus_are_those_of_its_curvature(void **state)
{
    (void)state;
    const int32_t n = 60, m = 26;
    soup_clear(&s);
    for (int32_t i = 0; i < n; i++) {
        for (int32_t j = 0; j < m; j++) {
            const double u = 2.0 * TEST_PI * i / n, v = 2.0 * TEST_PI * j / m;
            soup_vertex(&s, (3.0 + cos(v)) * cos(u), (3.0 + cos(v)) * sin(u), sin(v));
        }
    }
    for (int32_t i = 0; i < n; i++) {
        for (int32_t j = 0; j < m; j++) {
            soup_face(&s, 4,
                      (int32_t[]){i * m + j, (i + 1) % n * m + j, (i + 1) % n * m + (j + 1) % m, i * m + (j + 1) % m});
        }
    }
    sl_mesh *mesh = soup_build(&s, NULL);
    const double reach = 0.3 * mesh->scale;
    assert_int_equal(sl_seam_dihedrals(mesh, weight), SL_OK);
    assert_int_equal(sl_seam_turns(mesh, weight, reach, turn), SL_OK);
    double sign = 1.0; /* the builder may have kept the inside out */
    sign = turn[0] < 0.0 ? -1.0 : 1.0;
    for (int32_t v = 0; v < mesh->nv; v++) {
        const double c = cos(2.0 * TEST_PI * (v % m) / m), curvature = (1.0 + c / (3.0 + c)) / mesh->scale;
        assert_true(test_near(sign * turn[v], 2.0 * reach * curvature, 0.03 * 2.0 * reach / mesh->scale));
    }
    sl_mesh_free(mesh);
}

/* One corner of a groove in a plate: the bottom of the groove is a valley although no edge there is sharp. */
static void a_smooth_groove_costs_less_than_the_plain_around_it(void **state)
{
    (void)state;
    const int32_t n = 40;
    soup_clear(&s);
    for (int32_t i = 0; i < n; i++) {
        for (int32_t j = 0; j < n; j++) {
            const double x = (i - 19.5) / 20.0, y = (j - 19.5) / 20.0, groove = -0.05 * exp(-x * x / 0.004);
            soup_vertex(&s, x, y, groove);
        }
    }
    for (int32_t i = 0; i + 1 < n; i++) {
        for (int32_t j = 0; j + 1 < n; j++) {
            soup_face(&s, 4, (int32_t[]){i * n + j, (i + 1) * n + j, (i + 1) * n + j + 1, i * n + j + 1});
        }
    }
    sl_mesh *mesh = soup_build(&s, NULL);
    sl_seam_cost_def def = sl_seam_cost_none();
    def.concavity = 0.8;
    def.angle_low = 0.17;
    assert_int_equal(sl_seam_cost_compute(mesh, &def, NULL, weight), SL_OK);
    int checked = 0;
    for (int32_t h = 0; h < mesh->nh; h++) {
        const int32_t i = mesh->origin[h] / n, j = mesh->origin[h] % n, k = sl_target(mesh, h) / n;
        if (i == k && j > 3 && j < n - 4) { /* along the groove */
            assert_true(i == 19 || i == 20 ? weight[h] < 0.5 : i > 10 && i < 30 ? weight[h] <= 1.0 : weight[h] == 1.0);
            checked++;
        }
    }
    assert_true(checked > 1000);
    sl_mesh_free(mesh);
}

/* By the definition, edge for edge; the same whether the visibility comes along or is computed. */
static void hidden_edges_cost_less(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x41d);
    static double visible[SOUP_FACES];
    soup_grid(&s, &rng, SOUP_TORUS, 20, 14, 0.3);
    sl_mesh *m = soup_build(&s, NULL);
    sl_seam_cost_def def = sl_seam_cost_none();
    def.visibility = 0.8;
    assert_int_equal(sl_ambient_compute(m, &def.ambient, NULL, visible), SL_OK);
    assert_int_equal(sl_seam_cost_compute(m, &def, NULL, weight), SL_OK);
    double least = 1.0;
    for (int32_t h = 0; h < m->nh; h++) {
        const double seen = 0.5 * (visible[m->face[h]] + visible[m->face[m->twin[h]]]);
        assert_true(test_near(weight[h], 1.0 - 0.8 * (1.0 - seen), 1e-15));
        least = fmin(least, weight[h]);
    }
    assert_true(least < 0.8);
    def.visible = visible;
    assert_int_equal(sl_seam_cost_compute(m, &def, NULL, other), SL_OK);
    assert_memory_equal(weight, other, (size_t)m->nh * sizeof *weight);
    sl_mesh_free(m);
}

static void edge_loops_of_a_torus_close_and_those_of_a_sheet_count_their_edges(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x100b);
    soup_grid(&s, &rng, SOUP_TORUS, 13, 9, 0.0);
    sl_mesh *m = soup_build(&s, NULL);
    assert_int_equal(sl_seam_loops(m, NULL, weight), SL_OK);
    for (int32_t h = 0; h < m->nh; h++) {
        assert_true(weight[h] == 1.0);
    }
    sl_mesh_free(m);
    soup_grid(&s, &rng, SOUP_SHEET, 13, 9, 0.0);
    m = soup_build(&s, NULL);
    assert_int_equal(sl_seam_loops(m, NULL, weight), SL_OK);
    for (int32_t h = 0; h < m->nh; h++) {
        const bool lengthwise = m->origin[h] % 10 == sl_target(m, h) % 10;
        assert_true(m->twin[h] >= 0 ? test_near(weight[h], 1.0 - 1.0 / (lengthwise ? 13 : 9), 1e-15)
                                    : weight[h] == 0.0);
    }
    sl_mesh_free(m);
}

/* Cutting quads into pairs changes no edge's loop: by the vertices' numbers, edges are compared. */
static void loops_of_pairs_are_those_of_the_quads(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x100c);
    for (int trial = 0; trial < 20 * test_multiplier(); trial++) {
        const soup_surface kind = (soup_surface)test_index(&rng, 3);
        const int32_t n = 8 + test_index(&rng, 8), k = 7 + test_index(&rng, 5);
        soup_grid(&s, &rng, kind, n, k, 0.0);
        sl_mesh *whole = soup_build(&s, NULL);
        soup_grid(&s, &rng, kind, n, k, 1.0);
        sl_mesh *cut = soup_build(&s, NULL);
        for (int32_t f = 0; f < cut->nf; f++) {
            partner[f] = f % 2 == 0 ? f + 1 : f - 1;
        }
        assert_int_equal(sl_seam_loops(whole, NULL, weight), SL_OK);
        assert_int_equal(sl_seam_loops(cut, partner, other), SL_OK);
        for (int32_t h = 0; h < whole->nh; h++) {
            const int32_t f = whole->face[h];
            int found = 0;
            for (int32_t g = cut->face_first[2 * f]; g < cut->face_first[2 * f + 2]; g++) {
                if (cut->origin[g] == whole->origin[h] && sl_target(cut, g) == sl_target(whole, h)) {
                    assert_true(other[g] == weight[h]);
                    found++;
                }
            }
            assert_int_equal(found, 1);
        }
        assert_int_equal(sl_seam_loops(cut, NULL, other), SL_OK); /* triangles alone have no loops */
        for (int32_t h = 0; h < cut->nh; h++) {
            assert_true(other[h] == 0.0);
        }
        sl_mesh_free(whole);
        sl_mesh_free(cut);
    }
}

static void weights_agree_across_edges_and_seams_and_stay_in_range(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x5ea);
    for (int trial = 0; trial < 60 * test_multiplier(); trial++) {
        if (trial % 2 == 0) {
            soup_random(&s, &rng, 12 + test_index(&rng, 40), 5 + test_index(&rng, 80));
        } else {
            soup_grid(&s, &rng, (soup_surface)test_index(&rng, 5), 12, 9, 0.3);
        }
        sl_mesh *m = soup_build(&s, NULL);
        const sl_seam_cost_def def = sl_seam_cost_default();
        assert_int_equal(sl_seam_cost_compute(m, &def, NULL, weight), SL_OK);
        for (int32_t h = 0; h < m->nh; h++) {
            const int32_t t = sl_opposite(m, h);
            assert_true(weight[h] >= def.floor && weight[h] <= 1.0);
            assert_true(t < 0 ? weight[h] == 1.0 : weight[h] == weight[t]);
            if (test_index(&rng, 3) == 0) {
                sl_mesh_cut_edge(m, h);
            }
        }
        assert_int_equal(sl_seam_cost_compute(m, &def, NULL, other), SL_OK);
        for (int32_t h = 0; h < m->nh; h++) {
            assert_true(other[h] == weight[h]);
        }
        sl_mesh_free(m);
    }
}

static void scale_and_place_do_not_matter(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x5eb);
    soup_grid(&s, &rng, SOUP_TORUS, 14, 9, 0.4);
    sl_mesh *m = soup_build(&s, NULL);
    const sl_seam_cost_def def = sl_seam_cost_default();
    assert_int_equal(sl_seam_cost_compute(m, &def, NULL, weight), SL_OK);
    for (int32_t i = 0; i < 3 * s.nv; i++) {
        s.xyz[i] = 1e-6 * (s.xyz[i] * 1.37 + 5.0 * (i % 3));
    }
    sl_mesh *moved = soup_build(&s, NULL);
    assert_int_equal(sl_seam_cost_compute(moved, &def, NULL, other), SL_OK);
    for (int32_t h = 0; h < m->nh; h++) {
        assert_true(test_near(weight[h], other[h], 1e-9));
    }
    sl_mesh_free(m);
    sl_mesh_free(moved);
}

static bool refuse(void *user, const char *stage, double fraction)
{
    (void)user;
    (void)stage;
    (void)fraction;
    return false;
}

static void bad_strengths_are_refused_and_a_caller_can_cancel(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x5ec);
    sl_mesh *m = folded(&rng, 0.9);
    sl_seam_cost_def bad[8];
    for (size_t i = 0; i < SL_COUNTOF(bad); i++) {
        bad[i] = sl_seam_cost_default();
    }
    bad[0].crease = 1.2;
    bad[1].concavity = NAN;
    bad[2].loops = -0.1;
    bad[3].floor = 0.0;
    bad[4].angle_high = bad[4].angle_low;
    bad[5].reach = 0.0;
    bad[6].visibility = -1e-9;
    bad[7].ambient.rays = 0;
    for (size_t i = 0; i < SL_COUNTOF(bad); i++) {
        assert_int_equal(sl_seam_cost_compute(m, &bad[i], NULL, weight), SL_BAD_INPUT);
    }
    const sl_context context = {.progress = refuse};
    const sl_seam_cost_def none = sl_seam_cost_none();
    assert_int_equal(sl_seam_cost_compute(m, &none, &context, weight), SL_CANCELLED);
    assert_int_equal(sl_seam_cost_compute(m, &none, NULL, weight), SL_OK);
    for (int32_t h = 0; h < m->nh; h++) {
        assert_true(weight[h] == 1.0);
    }
    sl_mesh_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_dihedral_angle_of_a_fold_is_its_angle),
        cmocka_unit_test(creases_cost_less_the_sharper_they_are_and_valleys_less_again),
        cmocka_unit_test(turns_on_a_torus_are_those_of_its_curvature),
        cmocka_unit_test(a_smooth_groove_costs_less_than_the_plain_around_it),
        cmocka_unit_test(hidden_edges_cost_less),
        cmocka_unit_test(edge_loops_of_a_torus_close_and_those_of_a_sheet_count_their_edges),
        cmocka_unit_test(loops_of_pairs_are_those_of_the_quads),
        cmocka_unit_test(weights_agree_across_edges_and_seams_and_stay_in_range),
        cmocka_unit_test(scale_and_place_do_not_matter),
        cmocka_unit_test(bad_strengths_are_refused_and_a_caller_can_cancel),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
