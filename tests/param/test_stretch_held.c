/* The minimiser with vertices and lines held. */
#include "param/stretch_sheets.h"

/* How far the vertices of a line are from the first one along the normal (x, y). */
static double off_line(const sl_stretch_line *line, const double *uv, double x, double y)
{
    double off = 0.0;
    const double *a = &uv[2 * line->vertex[0]];
    for (int32_t i = 0; i < line->count; i++) {
        const double *p = &uv[2 * line->vertex[i]];
        off = fmax(off, fabs(x * (p[0] - a[0]) + y * (p[1] - a[1])));
    }
    return off;
}

/* The whole's minimum is the part's, too, when the rim of the part is held where it is. */
static void a_part_with_its_rim_held_returns_to_the_minimum_of_the_whole(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 4; seed++) {
        sheet s = make_sheet(0x4e1d + seed);
        test_rng rng = test_rng_seed(seed);
        double least[2 * VERTICES];
        uint8_t fixed[VERTICES] = {0};
        sl_stretch_info info;
        sl_stretch_def def = to_the_end();
        assert_int_equal(sl_stretch_minimise(s.patch, &def, NULL, s.uv, NULL), SL_OK);
        memcpy(least, s.uv, sizeof least);
        for (int i = 0; i < VERTICES; i++) {
            const bool inner = i / COLUMNS > 1 && i / COLUMNS < 5 && i % COLUMNS > 2;
            const int32_t v = s.at[i / COLUMNS][i % COLUMNS];
            fixed[v] = !inner;
            for (int k = 0; k < 2 && inner; k++) {
                s.uv[2 * v + k] += test_uniform(&rng, -0.04, 0.04);
            }
        }
        assert_int_equal(chart_flips(s.patch, s.uv), 0);
        def.fixed = fixed;
        assert_int_equal(sl_stretch_minimise(s.patch, &def, NULL, s.uv, &info), SL_OK);
        assert_true(info.converged && info.energy_before > info.energy_after + 1e-3);
        for (int32_t v = 0; v < VERTICES; v++) {
            if (fixed[v] != 0) {
                assert_memory_equal(&s.uv[2 * v], &least[2 * v], 2 * sizeof *least);
            }
        }
        assert_true(test_near(chart_max_diff(s.uv, least, 2 * VERTICES), 0.0, 1e-5));
        sl_patch_free(s.patch);
    }
}

static void when_all_is_held_nothing_moves(void **state)
{
    (void)state;
    sheet s = make_sheet(0xa11);
    double copy[2 * VERTICES];
    uint8_t fixed[VERTICES];
    sl_stretch_def def = sl_stretch_default();
    memset(fixed, 1, sizeof fixed);
    memcpy(copy, s.uv, sizeof copy);
    def.fixed = fixed;
    assert_int_equal(sl_stretch_minimise(s.patch, &def, NULL, s.uv, NULL), SL_OK);
    assert_memory_equal(s.uv, copy, sizeof copy);
    sl_patch_free(s.patch);
}

/* Lines and right angles stay; and no way of moving a line or sliding a vertex that is left lowers the energy. */
static void lines_stay_straight_and_everything_else_finds_its_minimum(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 4; seed++) {
        sheet s = make_sheet(0x11e + seed);
        sheet_lines lines;
        sl_stretch_info info;
        make_lines(&s, &lines);
        sl_stretch_def def = to_the_end();
        def.line = lines.line;
        def.line_count = 6;
        assert_int_equal(sl_stretch_minimise(s.patch, &def, NULL, s.uv, &info), SL_OK);
        assert_true(info.converged && info.energy_after < info.energy_before - 0.01);
        assert_int_equal(chart_flips(s.patch, s.uv), 0);
        const double least = energy_of(s.patch, s.uv), h = 1e-4;
        const double along[2] = {0.6, 0.8}; /* of the rows */
        for (int l = 0; l < 6; l++) {
            const double x = l < 3 ? -along[1] : along[0], y = l < 3 ? along[0] : along[1];
            assert_true(test_near(off_line(&lines.line[l], s.uv, x, y), 0.0, 1e-13));
            for (int side = -1; side <= 1; side += 2) { /* the line along its normal */
                double moved[2 * VERTICES];
                memcpy(moved, s.uv, sizeof moved);
                for (int32_t i = 0; i < lines.line[l].count; i++) {
                    moved[2 * lines.line[l].vertex[i]] += side * h * x;
                    moved[2 * lines.line[l].vertex[i] + 1] += side * h * y;
                }
                assert_true(energy_of(s.patch, moved) > least);
            }
        }
        for (int i = 0; i < VERTICES; i++) { /* a vertex along its row, its column or anywhere */
            const int r = i / COLUMNS, c = i % COLUMNS;
            const bool row = r == 0 || r == ROWS - 1 || r == 3, column = c == 0 || c == COLUMNS - 1 || c == 5;
            for (int side = -1; side <= 1; side += 2) {
                const double a = column ? 0.0 : side * h, b = row ? 0.0 : 0.7 * side * h;
                double *p = &s.uv[2 * s.at[r][c]];
                const double old[2] = {p[0], p[1]};
                p[0] += a * along[0] - b * along[1];
                p[1] += a * along[1] + b * along[0];
                assert_true(energy_of(s.patch, s.uv) > least || (row && column));
                memcpy(p, old, sizeof old);
            }
        }
        sl_patch_free(s.patch);
    }
}

static void fixed_lines_and_those_with_held_vertices_stay_in_place(void **state)
{
    (void)state;
    sheet s = make_sheet(0xf1e);
    sheet_lines lines;
    double start[2 * VERTICES];
    uint8_t fixed[VERTICES] = {0};
    make_lines(&s, &lines);
    memcpy(start, s.uv, sizeof start);
    lines.line[0].fixed = true;
    fixed[s.at[3][2]] = 1; /* on the row in the middle */
    sl_stretch_def def = to_the_end();
    def.line = lines.line;
    def.line_count = 6;
    def.fixed = fixed;
    assert_int_equal(sl_stretch_minimise(s.patch, &def, NULL, s.uv, NULL), SL_OK);
    double slid = 0.0, crossed = 0.0;
    for (int l = 0; l < 2; l++) {
        for (int i = 0; i < COLUMNS; i++) {
            const int32_t v = lines.vertex[l][i];
            const double x = s.uv[2 * v] - start[2 * v], y = s.uv[2 * v + 1] - start[2 * v + 1];
            assert_true(test_near(-0.8 * x + 0.6 * y, 0.0, 1e-14));
            slid = fmax(slid, fabs(0.6 * x + 0.8 * y));
            crossed = i == 5 ? fabs(0.6 * x + 0.8 * y) : crossed;
        }
    }
    assert_true(slid > 0.01 && crossed > 1e-3); /* the others slide, the crossings with the columns' offsets */
    assert_memory_equal(&s.uv[2 * s.at[3][2]], &start[2 * s.at[3][2]], 2 * sizeof *start);
    sl_patch_free(s.patch);
}

static void a_vertex_on_three_lines_stays(void **state)
{
    (void)state;
    sheet s = make_sheet(0x3);
    sheet_lines lines;
    double start[2 * VERTICES];
    make_lines(&s, &lines);
    for (int32_t v = 0; v < VERTICES; v++) { /* every vertex on the lattice, so that diagonals are straight */
        for (int i = 0; i < VERTICES; i++) {
            if (s.at[i / COLUMNS][i % COLUMNS] == v) {
                const double x = 0.31 * (i % COLUMNS), y = 0.26 * (i / COLUMNS);
                s.uv[2 * v] = 0.6 * x - 0.8 * y;
                s.uv[2 * v + 1] = 0.8 * x + 0.6 * y;
            }
        }
    }
    memcpy(start, s.uv, sizeof start);
    const int32_t diagonal[3] = {s.at[2][4], s.at[3][5], s.at[4][6]};
    lines.line[0] = (sl_stretch_line){.count = 3, .vertex = diagonal};
    sl_stretch_def def = sl_stretch_default();
    def.line = lines.line;
    def.line_count = 6;
    assert_int_equal(sl_stretch_minimise(s.patch, &def, NULL, s.uv, NULL), SL_OK);
    assert_memory_equal(&s.uv[2 * diagonal[1]], &start[2 * diagonal[1]], 2 * sizeof *start);
    assert_true(chart_max_diff(&s.uv[2 * diagonal[0]], &start[2 * diagonal[0]], 2) > 1e-4); /* it slides */
    sl_patch_free(s.patch);
}

static void lines_that_cannot_be_kept_are_refused(void **state)
{
    (void)state;
    sheet s = make_sheet(0xbad);
    sheet_lines lines;
    make_lines(&s, &lines);
    const int32_t one[1] = {s.at[0][0]}, beyond[2] = {0, VERTICES}, below[2] = {0, -1};
    const int32_t twice[3] = {s.at[0][0], s.at[0][1], s.at[0][0]}, back[4] = {s.at[0][0], s.at[0][2], s.at[0][1], 0};
    const int32_t bent[3] = {s.at[0][0], s.at[1][1], s.at[2][4]};
    const sl_stretch_line bad[] = {{1, one, false},   {2, beyond, false}, {2, below, false},
                                   {3, twice, false}, {4, back, false},   {3, bent, false}};
    sl_stretch_def def = sl_stretch_default();
    sl_stretch *solver = NULL;
    def.line_count = 1;
    for (size_t k = 0; k < SL_COUNTOF(bad); k++) {
        def.line = &bad[k];
        assert_int_equal(sl_stretch_create(s.patch, s.uv, &def, &solver), SL_BAD_INPUT);
        assert_null(solver);
    }
    const sl_stretch_line same[2] = {lines.line[0], {4, lines.vertex[0] + 2, false}}; /* one on the other */
    def.line = same;
    def.line_count = 2;
    assert_int_equal(sl_stretch_create(s.patch, s.uv, &def, &solver), SL_BAD_INPUT);
    assert_null(solver);
    sl_patch_free(s.patch);
}

/* The matrix over all coordinates or over unknowns, dense and symmetric; its size. */
static int32_t dense_matrix(const sheet *s, const sl_stretch_def *def, double **out, sl_stretch_freedom *freedom)
{
    sl_stretch_rest rest = {0};
    sl_stretch_system system;
    double *gradient = malloc(sizeof s->uv), *force = malloc(sizeof s->uv);
    assert_int_equal(sl_stretch_rest_init(s->patch, &rest), SL_OK);
    assert_int_equal(sl_stretch_freedom_init(s->patch, def, s->uv, freedom), SL_OK);
    assert_int_equal(sl_stretch_system_init(s->patch, freedom, &system), SL_OK);
    sl_stretch_assemble(s->patch, &rest, freedom, 0.2, INFINITY, s->uv, &system, gradient, force);
    const int32_t n = system.H->ncols;
    *out = calloc((size_t)n * (size_t)n, sizeof **out);
    for (int32_t j = 0; j < n; j++) {
        for (int64_t p = system.H->colptr[j]; p < system.H->colptr[j + 1]; p++) {
            (*out)[system.H->row[p] * n + j] = (*out)[j * n + system.H->row[p]] = system.H->val[p];
        }
    }
    sl_stretch_system_clear(&system);
    sl_stretch_rest_clear(&rest);
    free(gradient);
    free(force);
    return n;
}

/* With B the way unknowns move vertices: B' H B, entry by entry. */
static void the_matrix_of_what_is_left_is_the_projected_one(void **state)
{
    (void)state;
    sheet s = make_sheet(0xb4b);
    sheet_lines lines;
    uint8_t fixed[VERTICES] = {0};
    double *whole, *reduced, *B;
    sl_stretch_freedom all, freedom;
    sl_stretch_def def = sl_stretch_default();
    const int32_t n = dense_matrix(&s, &def, &whole, &all);
    make_lines(&s, &lines);
    fixed[s.at[1][1]] = 1;
    def.fixed = fixed;
    def.line = lines.line;
    def.line_count = 6;
    const int32_t m = dense_matrix(&s, &def, &reduced, &freedom);
    assert_true(n == 2 * VERTICES && m == freedom.unknowns && m < n - 30);
    B = calloc((size_t)n * (size_t)m, sizeof *B);
    for (int32_t i = 0; i < n; i++) {
        const int32_t u = freedom.unknown[i];
        for (int k = 0; k < 2 && u >= 0; k++) {
            B[(i - i % 2 + k) * m + u] += freedom.basis[2 * i + k];
        }
    }
    for (int32_t a = 0; a < m; a++) {
        for (int32_t b = 0; b < m; b++) {
            double sum = 0.0;
            for (int32_t i = 0; i < n; i++) {
                for (int32_t j = 0; j < n && B[i * m + a] != 0.0; j++) {
                    sum += B[i * m + a] * whole[i * n + j] * B[j * m + b];
                }
            }
            assert_true(test_near(reduced[a * m + b], sum, 1e-10));
        }
    }
    free(whole);
    free(reduced);
    free(B);
    sl_stretch_freedom_clear(&all);
    sl_stretch_freedom_clear(&freedom);
    sl_patch_free(s.patch);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_part_with_its_rim_held_returns_to_the_minimum_of_the_whole),
        cmocka_unit_test(when_all_is_held_nothing_moves),
        cmocka_unit_test(lines_stay_straight_and_everything_else_finds_its_minimum),
        cmocka_unit_test(fixed_lines_and_those_with_held_vertices_stay_in_place),
        cmocka_unit_test(a_vertex_on_three_lines_stays),
        cmocka_unit_test(lines_that_cannot_be_kept_are_refused),
        cmocka_unit_test(the_matrix_of_what_is_left_is_the_projected_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
