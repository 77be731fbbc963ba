/* The minimiser with vertices and lines held, in a workspace, and the sums of its measures. */
#include "param/stretch.h"

#include "param/distortion.h"
#include "param/stretch_charts.h"
#include "param/stretch_internal.h"
#include "param/tutte.h"

enum { COLUMNS = 9, ROWS = 7, VERTICES = COLUMNS * ROWS };

/* A bumpy rectangle and a flip-free map of it that has straight rows and columns wherever a line is wanted. */
typedef struct sheet {
    sl_patch *patch;
    double uv[2 * VERTICES];
    int32_t at[ROWS][COLUMNS]; /* the patch's vertex */
} sheet;

static sheet make_sheet(uint64_t seed)
{
    sheet s;
    test_rng rng = test_rng_seed(seed);
    double xyz[3 * VERTICES];
    int32_t tri[6 * VERTICES], nt = 0;
    for (int i = 0; i < VERTICES; i++) {
        const double u = (i % COLUMNS) / 4.0 - 1.0 + test_uniform(&rng, -0.05, 0.05);
        const double v = (i / COLUMNS) / 4.0 - 0.7 + test_uniform(&rng, -0.05, 0.05);
        chart_bumps(u, v, 1.7, &xyz[3 * i]);
        const int32_t b = i + 1, c = i + COLUMNS, d = i + COLUMNS + 1;
        if (i % COLUMNS < COLUMNS - 1 && i / COLUMNS < ROWS - 1) {
            const bool one = test_index(&rng, 2) == 1;
            memcpy(&tri[3 * nt++], one ? (int32_t[]){i, b, d} : (int32_t[]){i, b, c}, 3 * sizeof *tri);
            memcpy(&tri[3 * nt++], one ? (int32_t[]){i, d, c} : (int32_t[]){b, d, c}, 3 * sizeof *tri);
        }
    }
    s.patch = chart_make(VERTICES, xyz, nt, tri);
    for (int i = 0; i < VERTICES; i++) { /* turned; the vertices in the middle of cells move, too */
        const int r = i / COLUMNS, c = i % COLUMNS;
        const bool lined = r == 0 || r == ROWS - 1 || c == 0 || c == COLUMNS - 1 || r == 3 || c == 5;
        const double size = lined ? 0.0 : 0.06;
        const double x = 0.31 * c + test_uniform(&rng, -size, size), y = 0.26 * r + test_uniform(&rng, -size, size);
        for (int32_t v = 0; v < VERTICES; v++) {
            if (memcmp(&s.patch->xyz[3 * v], &xyz[3 * i], 3 * sizeof *xyz) == 0) {
                s.at[r][c] = v;
                s.uv[2 * v] = 0.6 * x - 0.8 * y;
                s.uv[2 * v + 1] = 0.8 * x + 0.6 * y;
            }
        }
    }
    assert_int_equal(chart_flips(s.patch, s.uv), 0);
    return s;
}

/* Sides, a row and a column that cross. */
typedef struct sheet_lines {
    int32_t vertex[6][COLUMNS];
    sl_stretch_line line[6];
} sheet_lines;

static void make_lines(const sheet *s, sheet_lines *lines)
{
    static const int rows[] = {0, 3, ROWS - 1}, columns[] = {0, 5, COLUMNS - 1};
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < COLUMNS; i++) {
            lines->vertex[k][i] = s->at[rows[k]][i];
            lines->vertex[3 + k][i] = i < ROWS ? s->at[i][columns[k]] : -1;
        }
        lines->line[k] = (sl_stretch_line){.count = COLUMNS, .vertex = lines->vertex[k]};
        lines->line[3 + k] = (sl_stretch_line){.count = ROWS, .vertex = lines->vertex[3 + k]};
    }
}

static double energy_of(const sl_patch *patch, const double *uv)
{
    sl_stretch_rest rest = {0};
    assert_int_equal(sl_stretch_rest_init(patch, &rest), SL_OK);
    const double energy = sl_stretch_measure(&rest, patch->tri, 0.0, uv).energy;
    sl_stretch_rest_clear(&rest);
    return energy;
}

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

static sl_stretch_def to_the_end(void)
{
    sl_stretch_def def = sl_stretch_default();
    def.relative_decrease = 1e-14;
    def.max_iterations = 200;
    return def;
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

/* Places for pins: where the vertices are, moved by up to `size`. */
static void make_pins(const sheet *s, double size, uint64_t seed, int32_t count, sl_pin *pin)
{
    test_rng rng = test_rng_seed(seed);
    for (int32_t i = 0; i < count; i++) { /* 17 and 63 have no common divisor */
        const int32_t v = (int32_t)((17 * (i + (int32_t)seed) + 5) % VERTICES);
        pin[i] = (sl_pin){
            .vertex = v,
            .uv = {s->uv[2 * v] + test_uniform(&rng, -size, size), s->uv[2 * v + 1] + test_uniform(&rng, -size, size)}};
    }
}

/* Any number of pins reach their places exactly, and the rest is at its minimum then. */
static void pins_are_brought_to_their_places(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 8; seed++) {
        sheet s = make_sheet(0x919 + seed);
        sl_pin pin[5];
        uint8_t fixed[VERTICES] = {0};
        sl_stretch_info info;
        sl_stretch_def def = to_the_end();
        make_pins(&s, 0.3, seed, 5, pin);
        def.pin = pin;
        def.pin_count = 1 + (int32_t)(seed % 5);
        assert_int_equal(sl_stretch_minimise(s.patch, &def, NULL, s.uv, &info), SL_OK);
        assert_true(info.pin_distance == 0.0 && info.converged);
        assert_int_equal(chart_flips(s.patch, s.uv), 0);
        for (int32_t i = 0; i < def.pin_count; i++) {
            assert_memory_equal(&s.uv[2 * pin[i].vertex], pin[i].uv, sizeof pin->uv);
            fixed[pin[i].vertex] = 1;
        }
        assert_true(test_near_rel(info.energy_after, energy_of(s.patch, s.uv), 1e-12));
        const double energy = info.energy_after;
        def.pin_count = 0;
        def.fixed = fixed;
        assert_int_equal(sl_stretch_minimise(s.patch, &def, NULL, s.uv, &info), SL_OK);
        assert_true(test_near_rel(info.energy_after, energy, 1e-5));
        sl_patch_free(s.patch);
    }
}

/* A flat sheet pinned as a turned copy of itself becomes that copy. */
static void pins_of_an_isometry_give_the_isometry(void **state)
{
    (void)state;
    sl_patch *patch = chart_grid(8, 7, 0.25, chart_plane, 0.3, 0x150);
    double *uv = malloc(2 * (size_t)patch->nv * sizeof *uv);
    sl_pin pin[4];
    sl_stretch_info info;
    sl_stretch_def def = to_the_end();
    assert_int_equal(sl_tutte(patch, SL_TUTTE_UNIFORM, NULL, uv), SL_OK);
    for (int32_t i = 0; i < 4; i++) {
        const int32_t v = (i * patch->nv) / 4 + 3;
        const double *x = &patch->xyz[3 * v]; /* the plane's own coordinates: see chart_plane */
        const double p = 0.36 * (x[0] - 0.3) + 0.48 * x[1] + 0.8 * x[2], q = -0.8 * (x[0] - 0.3) + 0.6 * x[1];
        pin[i] = (sl_pin){.vertex = v, .uv = {1.7 + 0.28 * p - 0.96 * q, -0.4 + 0.96 * p + 0.28 * q}};
    }
    def.pin = pin;
    def.pin_count = 4;
    assert_int_equal(sl_stretch_minimise(patch, &def, NULL, uv, &info), SL_OK);
    assert_true(info.pin_distance == 0.0 && test_near(info.energy_after, 4.0, 1e-8));
    free(uv);
    sl_patch_free(patch);
}

static void pins_out_of_reach_are_said_and_bad_ones_refused(void **state)
{
    (void)state;
    sheet s = make_sheet(0x0b);
    sheet_lines lines;
    uint8_t fixed[VERTICES] = {0};
    sl_stretch_info info;
    sl_stretch *solver = NULL;
    make_lines(&s, &lines);
    /* the corners of one triangle, two of them exchanged */
    const int32_t *v = &s.patch->tri[30];
    sl_pin pin[3] = {{v[0], {s.uv[2 * v[0]], s.uv[2 * v[0] + 1]}},
                     {v[1], {s.uv[2 * v[2]], s.uv[2 * v[2] + 1]}},
                     {v[2], {s.uv[2 * v[1]], s.uv[2 * v[1] + 1]}}};
    sl_stretch_def def = sl_stretch_default();
    def.pin = pin;
    def.pin_count = 3;
    double *uv = malloc(sizeof s.uv);
    memcpy(uv, s.uv, sizeof s.uv);
    assert_int_equal(sl_stretch_minimise(s.patch, &def, NULL, uv, &info), SL_OK);
    assert_true(info.pin_distance > 1e-3 && chart_flips(s.patch, uv) == 0);
    free(uv);
    for (int what = 0; what < 6; what++) {
        sl_pin bad[2] = {pin[0], pin[1]};
        bad[1].vertex = what == 0 ? -1 : what == 1 ? VERTICES : what == 2 ? pin[0].vertex : s.at[3][2];
        bad[1].uv[1] = what == 3 ? NAN : 0.1;
        fixed[s.at[3][2]] = what == 4;
        def = sl_stretch_default();
        def.pin = bad;
        def.pin_count = 2;
        def.fixed = what == 4 ? fixed : NULL;
        def.line = lines.line;
        def.line_count = what == 5 ? 2 : 0;
        assert_int_equal(sl_stretch_create(s.patch, s.uv, &def, &solver), SL_BAD_INPUT);
        assert_null(solver);
    }
    sl_patch_free(s.patch);
}

/* One workspace for charts of all sizes, the same ones again, with and without held vertices, two solvers at a time. */
static void results_do_not_depend_on_the_workspace(void **state)
{
    (void)state;
    sl_stretch_workspace *workspace = NULL;
    assert_int_equal(sl_stretch_workspace_create(&workspace), SL_OK);
    for (int trial = 0; trial < 12 * test_multiplier(); trial++) {
        const int kind = trial / 2; /* each twice */
        sl_patch *patch =
            kind % 2 == 0 ? chart_tube(6 + kind, 4, 0.1, 0x3a) : chart_hexagon(3, 0.2, chart_bumps, 1.0, 7);
        const size_t size = 2 * (size_t)patch->nv * sizeof(double);
        double *uv = malloc(size), *alone = malloc(size), *start = malloc(size);
        uint8_t *fixed = calloc((size_t)patch->nv, 1);
        sl_stretch_def def = sl_stretch_default();
        sl_stretch *first = NULL, *second = NULL;
        assert_int_equal(sl_tutte(patch, SL_TUTTE_UNIFORM, NULL, start), SL_OK);
        memcpy(alone, start, size);
        fixed[trial % patch->nv] = 1;
        def.fixed = trial % 3 == 0 ? fixed : NULL;
        assert_int_equal(sl_stretch_minimise(patch, &def, NULL, alone, NULL), SL_OK);
        def.workspace = workspace;
        assert_int_equal(sl_stretch_create(patch, start, &def, &first), SL_OK);
        assert_int_equal(sl_stretch_create(patch, start, &def, &second), SL_OK);
        for (int i = 0; i < def.max_iterations; i++) {
            assert_int_equal(sl_stretch_step(first, 1, NULL), SL_OK);
            assert_int_equal(sl_stretch_step(second, 1, NULL), SL_OK);
        }
        assert_memory_equal(sl_stretch_uv(first), alone, size);
        assert_memory_equal(sl_stretch_uv(second), alone, size);
        sl_stretch_free(first);
        sl_stretch_free(second);
        memcpy(uv, start, size);
        assert_int_equal(sl_stretch_minimise(patch, &def, NULL, uv, NULL), SL_OK);
        assert_memory_equal(uv, alone, size);
        def.fixed = NULL; /* through coarse meshes, after and before the whole */
        assert_int_equal(sl_stretch_unfold(patch, &def, NULL, uv, NULL), SL_OK);
        def.workspace = NULL;
        assert_int_equal(sl_stretch_unfold(patch, &def, NULL, alone, NULL), SL_OK);
        assert_memory_equal(uv, alone, size);
        free(uv);
        free(alone);
        free(start);
        free(fixed);
        sl_patch_free(patch);
    }
    sl_stretch_workspace_free(workspace);
    sl_stretch_workspace_free(NULL);
}

static void terms_add_up_to_the_distortion_measures(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 10; seed++) {
        sl_patch *patch = seed % 2 == 0 ? chart_hexagon(4, 0.25, chart_bumps, 1.4, seed) : chart_tube(7, 3, 0.2, seed);
        double *uv = malloc(2 * (size_t)patch->nv * sizeof *uv);
        sl_stretch_terms *term = malloc((size_t)patch->nt * sizeof *term), half[2] = {{0}};
        sl_distortion d;
        assert_int_equal(sl_tutte(patch, SL_TUTTE_UNIFORM, NULL, uv), SL_OK);
        assert_int_equal(sl_distortion_measure_indexed(patch->nt, patch->tri, patch->xyz, uv, &d), SL_OK);
        const sl_stretch_terms sum = sl_stretch_terms_of(patch, uv, term);
        assert_true(test_near_rel(sum.area, d.area_3d, 1e-12) && test_near_rel(sum.uv, d.area_uv, 1e-12));
        assert_true(test_near_rel(sqrt(sum.inverse * sum.uv) / sum.area, d.l2, 1e-11));
        assert_true(test_near_rel(sum.angle / sum.area, d.angle_mean, 1e-9));
        for (int32_t t = 0; t < patch->nt; t++) {
            half[t % 2].inverse += term[t].inverse;
            half[t % 2].angle += term[t].angle;
        }
        assert_true(test_near_rel(half[0].inverse + half[1].inverse, sum.inverse, 1e-12));
        assert_true(test_near_rel(half[0].angle + half[1].angle, sum.angle, 1e-12));
        for (int32_t i = 0; i < patch->nv; i++) { /* mirrored */
            uv[2 * i] = -uv[2 * i];
        }
        assert_true(isinf(sl_stretch_terms_of(patch, uv, NULL).inverse));
        free(uv);
        free(term);
        sl_patch_free(patch);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_part_with_its_rim_held_returns_to_the_minimum_of_the_whole),
        cmocka_unit_test(when_all_is_held_nothing_moves),
        cmocka_unit_test(lines_stay_straight_and_everything_else_finds_its_minimum),
        cmocka_unit_test(the_matrix_of_what_is_left_is_the_projected_one),
        cmocka_unit_test(fixed_lines_and_those_with_held_vertices_stay_in_place),
        cmocka_unit_test(a_vertex_on_three_lines_stays),
        cmocka_unit_test(lines_that_cannot_be_kept_are_refused),
        cmocka_unit_test(pins_are_brought_to_their_places),
        cmocka_unit_test(pins_of_an_isometry_give_the_isometry),
        cmocka_unit_test(pins_out_of_reach_are_said_and_bad_ones_refused),
        cmocka_unit_test(results_do_not_depend_on_the_workspace),
        cmocka_unit_test(terms_add_up_to_the_distortion_measures),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
