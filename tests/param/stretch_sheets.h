/* A sheet with lines for the tests of what the minimiser holds. */
#ifndef SL_TESTS_PARAM_STRETCH_SHEETS_H
#define SL_TESTS_PARAM_STRETCH_SHEETS_H

#include "param/stretch_charts.h"
#include "param/stretch_internal.h"

enum { COLUMNS = 9, ROWS = 7, VERTICES = COLUMNS * ROWS };

/* A bumpy rectangle and a flip-free map of it that has straight rows and columns wherever a line is wanted. */
typedef struct sheet {
    sl_patch *patch;
    double uv[2 * VERTICES];
    int32_t at[ROWS][COLUMNS]; /* the patch's vertex */
} sheet;

static inline sheet make_sheet(uint64_t seed)
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

static inline void make_lines(const sheet *s, sheet_lines *lines)
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

static inline double energy_of(const sl_patch *patch, const double *uv)
{
    sl_stretch_rest rest = {0};
    assert_int_equal(sl_stretch_rest_init(patch, &rest), SL_OK);
    const double energy = sl_stretch_measure(&rest, patch->tri, 0.0, uv).energy;
    sl_stretch_rest_clear(&rest);
    return energy;
}

static inline sl_stretch_def to_the_end(void)
{
    sl_stretch_def def = sl_stretch_default();
    def.relative_decrease = 1e-14;
    def.max_iterations = 200;
    return def;
}

#endif
