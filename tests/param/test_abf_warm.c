/* Charts that start from the angles of others: cut, sewn and grown ones, and angles that are of no use. */
#include "mesh/mesh_fixtures.h"
#include "param/abf_chart.h"
#include "param/abf_internal.h"
#include "param/abf_sectors.h"
#include "param/constraint_charts.h"

enum { ROWS = 14, COLUMNS = 12 };

typedef struct sheet {
    sl_mesh *mesh;
    sl_triangulation *triangulation;
    int32_t cell_of[SOUP_FACES]; /* the grid cell of a facet */
} sheet;

/* A bumpy sheet of quads and triangles, facets in random order of winding start. */
static sheet make_sheet(uint64_t seed)
{
    static soup s;
    test_rng rng = test_rng_seed(seed);
    sheet out = {0};
    soup_clear(&s);
    for (int32_t i = 0; i < (ROWS + 1) * (COLUMNS + 1); i++) {
        double x[3];
        const double u = (i % (COLUMNS + 1) + test_uniform(&rng, -0.2, 0.2)) / COLUMNS - 0.5;
        const double v = (i / (COLUMNS + 1) + test_uniform(&rng, -0.2, 0.2)) / ROWS - 0.5;
        chart_bumps(u, v, 4.0, x);
        soup_vertex(&s, x[0], x[1], x[2]);
    }
    for (int32_t i = 0; i < ROWS * COLUMNS; i++) {
        const int32_t a = i / COLUMNS * (COLUMNS + 1) + i % COLUMNS;
        const int32_t q[4] = {a, a + 1, a + COLUMNS + 2, a + COLUMNS + 1}, d = test_index(&rng, 4);
        const int32_t f = s.nf;
        if (test_index(&rng, 3) == 0) {
            soup_face(&s, 4, (int32_t[]){q[d], q[(d + 1) % 4], q[(d + 2) % 4], q[(d + 3) % 4]});
        } else {
            soup_face(&s, 3, (int32_t[]){q[d], q[(d + 1) % 4], q[(d + 2) % 4]});
            soup_face(&s, 3, (int32_t[]){q[d], q[(d + 2) % 4], q[(d + 3) % 4]});
        }
        out.cell_of[f] = out.cell_of[s.nf - 1] = i;
    }
    const sl_polygons polygons = soup_polygons(&s);
    assert_int_equal(sl_mesh_build(&polygons, &out.mesh, NULL, NULL), SL_OK);
    assert_int_equal(sl_triangulation_create(out.mesh, &out.triangulation), SL_OK);
    return out;
}

static void clear(sheet *s)
{
    sl_triangulation_free(s->triangulation);
    sl_mesh_free(s->mesh);
}

/* Rows from .. to - 1 of the sheet, its facets listed in a random order. */
static sl_patch *take_rows(const sheet *s, int32_t from, int32_t to, uint64_t seed)
{
    test_rng rng = test_rng_seed(seed);
    int32_t list[SOUP_FACES], n = 0;
    sl_patch *patch = NULL;
    for (int32_t f = 0; f < s->mesh->nf; f++) {
        if (s->cell_of[f] / COLUMNS >= from && s->cell_of[f] / COLUMNS < to) {
            const int32_t j = test_index(&rng, n + 1);
            list[n++] = list[j];
            list[j] = f;
        }
    }
    assert_int_equal(sl_patch_extract(s->mesh, s->triangulation, list, n, &patch), SL_OK);
    assert_true(sl_patch_is_disk(patch));
    return patch;
}

static sl_abf_chart *open_from(const sl_patch *patch, const sl_abf_def *def, const double *angle)
{
    sl_abf_chart *chart = NULL;
    assert_int_equal(sl_abf_chart_create_from(patch, def, angle, NULL, &chart), SL_OK);
    assert_true(sl_abf_chart_info_of(chart)->converged && sl_abf_chart_info_of(chart)->valid);
    return chart;
}

static double *unknown_angles(const sl_patch *patch)
{
    double *angle = malloc(3 * (size_t)patch->nt * sizeof *angle);
    for (int32_t c = 0; c < 3 * patch->nt; c++) {
        angle[c] = NAN;
    }
    return angle;
}

/* Opens the patch from `angle` and cold; both must end in one solution. Returns the steps the first one saved. */
static int32_t compare(const sl_patch *patch, const double *angle, int32_t taken)
{
    sl_abf_def def = sl_abf_default();
    sl_abf_chart *warm = open_from(patch, &def, angle), *cold = open_from(patch, &def, NULL);
    const sl_abf_chart_info *info = sl_abf_chart_info_of(warm);
    assert_int_equal(info->taken_over, taken);
    assert_int_equal(sl_abf_chart_info_of(cold)->taken_over, 0);
    assert_true(info->solves == 1 && info->reached == 1.0);
    assert_true(chart_max_diff(sl_abf_chart_angles(warm), sl_abf_chart_angles(cold), 3 * patch->nt) <= 1e-6);
    const int32_t saved = sl_abf_chart_info_of(cold)->iterations - info->iterations;
    sl_abf_chart_free(warm);
    sl_abf_chart_free(cold);
    return saved;
}

/* Every triangle of `to` by search among all of `from`. */
static int32_t carry_by_search(const sl_patch *from, const double *from_angle, const sl_patch *to, double *to_angle)
{
    int32_t taken = 0;
    for (int32_t t = 0; t < to->nt; t++) {
        for (int32_t u = 0; u < from->nt; u++) {
            if (memcmp(&to->corner[3 * t], &from->corner[3 * u], 3 * sizeof *to->corner) == 0) {
                memcpy(&to_angle[3 * t], &from_angle[3 * u], 3 * sizeof *to_angle);
                taken++;
            }
        }
    }
    return taken;
}

static void angles_are_carried_to_the_same_triangles(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xca);
    sheet s = make_sheet(0xca);
    for (int trial = 0; trial < 6; trial++) {
        const int32_t a = test_index(&rng, 6), b = a + 3 + test_index(&rng, 6);
        const int32_t c = test_index(&rng, 6), d = c + 3 + test_index(&rng, 6);
        sl_patch *from = take_rows(&s, a, b, 2 * (uint64_t)trial), *to = take_rows(&s, c, d, 2 * (uint64_t)trial + 1);
        double *angle = malloc(3 * (size_t)from->nt * sizeof *angle), *got = unknown_angles(to),
               *wanted = unknown_angles(to);
        int32_t taken = -1;
        for (int32_t k = 0; k < 3 * from->nt; k++) {
            angle[k] = test_uniform(&rng, 0.1, 3.0);
        }
        assert_int_equal(sl_abf_carry_angles(from, angle, to, got, &taken), SL_OK);
        assert_int_equal(taken, carry_by_search(from, angle, to, wanted));
        assert_memory_equal(got, wanted, 3 * (size_t)to->nt * sizeof *got);
        assert_true((taken > 0) == (a < d && c < b));
        free(angle);
        free(got);
        free(wanted);
        sl_patch_free(from);
        sl_patch_free(to);
    }
    clear(&s);
}

/* The whole sheet sewn from two parts, a part cut from the whole, a part grown by a row. */
static void charts_cut_sewn_and_grown_start_near_their_solution(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 3; seed++) {
        sheet s = make_sheet(seed);
        const int32_t rows[][2] = {{0, 8}, {8, ROWS}, {0, ROWS}, {0, 9}};
        sl_patch *part[4];
        sl_abf_chart *chart[4];
        sl_abf_def def = sl_abf_default();
        for (int k = 0; k < 4; k++) {
            part[k] = take_rows(&s, rows[k][0], rows[k][1], seed + 10 * (uint64_t)k);
            chart[k] = open_from(part[k], &def, NULL);
        }
        double *whole = unknown_angles(part[2]), *grown = unknown_angles(part[3]), *cut = unknown_angles(part[1]);
        int32_t a, b, c, d;
        assert_int_equal(sl_abf_carry_angles(part[0], sl_abf_chart_angles(chart[0]), part[2], whole, &a), SL_OK);
        assert_int_equal(sl_abf_carry_angles(part[1], sl_abf_chart_angles(chart[1]), part[2], whole, &b), SL_OK);
        assert_int_equal(sl_abf_carry_angles(part[0], sl_abf_chart_angles(chart[0]), part[3], grown, &c), SL_OK);
        assert_int_equal(sl_abf_carry_angles(part[2], sl_abf_chart_angles(chart[2]), part[1], cut, &d), SL_OK);
        assert_true(a + b == part[2]->nt && c == part[0]->nt && d == part[1]->nt);
        assert_true(compare(part[2], whole, part[2]->nt) >= 0 && compare(part[3], grown, c) >= 0);
        assert_true(compare(part[1], cut, d) >= 0);
        for (int k = 0; k < 4; k++) {
            sl_abf_chart_free(chart[k]);
            sl_patch_free(part[k]);
        }
        free(whole);
        free(grown);
        free(cut);
        clear(&s);
    }
}

/* Its own solution: the first step finds the multipliers, the second one that there is nothing left to do. */
static void a_solution_is_recognised(void **state)
{
    (void)state;
    sheet s = make_sheet(0xce);
    sl_patch *patch = take_rows(&s, 1, 12, 0xce);
    sl_abf_def def = sl_abf_default();
    def.gradient_tolerance = 1e-10;
    sl_abf_chart *chart = open_from(patch, &def, NULL);
    def.gradient_tolerance = 1e-8;
    sl_abf_chart *again = open_from(patch, &def, sl_abf_chart_angles(chart));
    assert_true(sl_abf_chart_info_of(again)->iterations <= 2 && sl_abf_chart_info_of(chart)->iterations > 5);
    assert_true(chart_max_diff(sl_abf_chart_angles(chart), sl_abf_chart_angles(again), 3 * patch->nt) <= 1e-9);
    sl_abf_chart_free(again);
    sl_abf_chart_free(chart);
    sl_patch_free(patch);
    clear(&s);
}

/* NaN, 0, pi, infinity: the triangle starts from phi, and others from what they are given. */
static void a_triangle_with_an_angle_that_is_none_starts_from_phi(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xcf);
    const double none[] = {NAN, 0.0, TEST_PI, INFINITY, -0.3, -INFINITY, 3.5};
    sheet s = make_sheet(0xcf);
    sl_patch *patch = take_rows(&s, 0, 6, 0xcf);
    const size_t nc = 3 * (size_t)patch->nt;
    const sl_abf_def def = sl_abf_default();
    sl_abf *solver = NULL;
    assert_int_equal(sl_abf_create(patch, &def, &solver), SL_OK);
    double *phi = malloc(nc * sizeof *phi), *given = malloc(nc * sizeof *given);
    memcpy(phi, sl_abf_angles(solver), nc * sizeof *phi);
    for (size_t c = 0; c < nc; c++) {
        given[c] = test_uniform(&rng, 0.05, 3.1);
    }
    int32_t left = patch->nt;
    for (int32_t t = 0; t < patch->nt; t += 1 + test_index(&rng, 3)) {
        given[3 * t + test_index(&rng, 3)] = none[test_index(&rng, SL_COUNTOF(none))];
        left--;
    }
    assert_int_equal(sl_abf_step(solver, 3, NULL), SL_OK); /* multipliers to be forgotten */
    assert_int_equal(sl_abf_start_from(solver, given), left);
    for (int32_t t = 0; t < patch->nt; t++) {
        const double *x = &given[3 * t];
        bool usable = true;
        for (int k = 0; k < 3; k++) {
            usable = usable && x[k] > 0.0 && x[k] < TEST_PI;
        }
        assert_memory_equal(&sl_abf_angles(solver)[3 * t], usable ? x : &phi[3 * t], 3 * sizeof *x);
    }
    const sl_abf_view view = sl_abf_view_of(solver);
    for (int32_t t = 0; t < patch->nt; t++) {
        assert_true(view.lambda1[t] == 0.0);
    }
    for (int32_t r = 0; r < view.system->nrows; r++) {
        assert_true(view.lambda2[r] == 0.0);
    }
    assert_int_equal(sl_abf_info_of(solver)->iterations, 0);
    sl_abf_free(solver);
    free(phi);
    free(given);
    sl_patch_free(patch);
    clear(&s);
}

/* Angles from which Newton's method gets nowhere, and none at all: the chart is that of sl_abf_chart_create, bytes and
 * all, and info does not claim that they were used. */
static void useless_angles_are_forgotten(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xd0);
    sheet s = make_sheet(0xd0);
    sl_patch *patch = take_rows(&s, 2, 10, 0xd0);
    const sl_abf_def def = sl_abf_default();
    sl_abf_chart *plain = NULL;
    double *angle = unknown_angles(patch);
    assert_int_equal(sl_abf_chart_create(patch, &def, NULL, &plain), SL_OK);
    for (int kind = 0; kind < 2; kind++) {
        sl_abf_chart *chart = open_from(patch, &def, angle);
        const sl_abf_chart_info *info = sl_abf_chart_info_of(chart);
        assert_true(info->taken_over == 0 && info->solves == 1 + kind);
        assert_memory_equal(sl_abf_chart_uv(chart), sl_abf_chart_uv(plain), 2 * (size_t)patch->nv * sizeof(double));
        sl_abf_chart_free(chart);
        for (int32_t c = 0; c < 3 * patch->nt; c++) {
            angle[c] = test_index(&rng, 2) == 0 ? 1e-13 : TEST_PI - 1e-13;
        }
    }
    sl_abf_chart_free(plain);
    free(angle);
    sl_patch_free(patch);
    clear(&s);
}

/* Lines across a steep chart take tens of steps, an angle near its limit a homotopy; known angles one solve. */
static void hard_targets_are_met_at_once_from_known_angles(void **state)
{
    (void)state;
    for (int kind = 0; kind < 2; kind++) {
        sl_patch *patch =
            kind == 0 ? chart_hexagon(RINGS, 0.0, chart_bumps, 4.5, 1) : chart_hexagon(5, 0.15, chart_cap, 0.9, 1);
        int32_t a[9], b[9];
        sl_sector_table table;
        sl_abf_def def = sl_abf_default();
        if (kind == 0) {
            const sl_constraint lines[2] = {lattice_path(patch, 4.5, (int32_t[]){-4, 0}, (int32_t[]){1, 0}, 9, a),
                                            lattice_path(patch, 4.5, (int32_t[]){0, -4}, (int32_t[]){0, 1}, 9, b)};
            table = compile(patch, 2, lines);
        } else {
            table = make_sectors(patch, true);
            const int32_t last = table.view.count - 1;
            table.theta[last] = 0.82 * (table.first[last + 1] - table.first[last]) * PI;
        }
        def.sectors = &table.view;
        sl_abf_chart *cold = open_from(patch, &def, NULL), *warm = open_from(patch, &def, sl_abf_chart_angles(cold));
        const sl_abf_chart_info *before = sl_abf_chart_info_of(cold), *info = sl_abf_chart_info_of(warm);
        assert_true(before->reached == 1.0 && before->iterations > 40 && (before->solves > 3) == (kind == 1));
        assert_true(info->reached == 1.0 && info->solves == 1 && info->taken_over == patch->nt);
        assert_true(info->iterations < before->iterations / 2);
        sl_abf_chart_free(warm);
        sl_abf_chart_free(cold);
        sl_sectors_clear(&table);
        sl_patch_free(patch);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(angles_are_carried_to_the_same_triangles),
        cmocka_unit_test(charts_cut_sewn_and_grown_start_near_their_solution),
        cmocka_unit_test(a_solution_is_recognised),
        cmocka_unit_test(hard_targets_are_met_at_once_from_known_angles),
        cmocka_unit_test(a_triangle_with_an_angle_that_is_none_starts_from_phi),
        cmocka_unit_test(useless_angles_are_forgotten),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
