/* Charts whose vertices are known by lattice coordinates, and what every constrained solution is held against. */
#ifndef TEST_PARAM_CONSTRAINT_CHARTS_H
#define TEST_PARAM_CONSTRAINT_CHARTS_H

#include "param/constraints.h"

#include "param/abf_charts.h"

#define PI TEST_PI

enum { RINGS = 5 };

/* Vertex (q, r) of a hexagonal chart without jitter. */
static inline int32_t lattice(const sl_patch *patch, chart_map *map, double parameter, int32_t q, int32_t r)
{
    double wanted[3];
    map((q + 0.5 * r) / RINGS, sqrt(0.75) * r / RINGS, parameter, wanted);
    for (int32_t v = 0; v < patch->nv; v++) {
        if (chart_max_diff(&patch->xyz[3 * v], wanted, 3) <= 1e-12) {
            return v;
        }
    }
    fail_msg("no vertex (%d, %d)", q, r);
    return -1;
}

/* n vertices from (q, r) on in steps of (dq, dr). */
static inline sl_constraint lattice_path(const sl_patch *patch, double height, int32_t start[2], int32_t step[2],
                                         int32_t n, int32_t *vertex)
{
    for (int32_t i = 0; i < n; i++) {
        vertex[i] = lattice(patch, chart_bumps, height, start[0] + i * step[0], start[1] + i * step[1]);
    }
    return (sl_constraint){SL_CONSTRAINT_STRAIGHT, n, vertex, 0.0};
}

static inline sl_sector_table compile(const sl_patch *patch, int32_t count, const sl_constraint *list)
{
    sl_sector_table table;
    sl_diag diag = sl_diag_none();
    const sl_status status = sl_constraints_compile(patch, count, list, NULL, &table, &diag);
    if (status != SL_OK) {
        fail_msg("%s: %s", sl_status_name(status), diag.reason);
    }
    return table;
}

/* Solves, lays out, and holds the result against what was asked. Returns info. */
static inline sl_abf_info check_solution(const sl_patch *patch, int32_t count, const sl_constraint *list, double line)
{
    sl_sector_table table = compile(patch, count, list);
    sl_abf_def def = sl_abf_default();
    sl_abf_info info;
    sl_constraint_measure measure[32];
    double *uv = malloc(2 * (size_t)patch->nv * sizeof *uv), *angle = malloc(3 * (size_t)patch->nt * sizeof *angle);
    def.sectors = &table.view;
    def.max_iterations = 200; /* the gradient falls linearly, slowly where much is forced */
    assert_int_equal(sl_abf_flatten(patch, &def, NULL, uv, &info), SL_OK);
    assert_true(info.converged && info.gradient <= 1e-6 && fmax(fmax(info.g1, info.g2), info.g3) <= 1e-11);
    chart_uv_angles(patch, uv, angle);
    for (int32_t c = 0; c < 3 * patch->nt; c++) {
        assert_true(angle[c] > 0.0);
    }
    sl_constraints_measure(patch, count, list, &table, uv, measure);
    for (int32_t i = 0; i < count; i++) {
        if (!(measure[i].angle <= 1e-8 && measure[i].line <= line)) {
            fail_msg("constraint %d: angle %g, line %g", i, measure[i].angle, measure[i].line);
        }
    }
    free(uv);
    free(angle);
    sl_sectors_clear(&table);
    return info;
}

/* Hexagonal charts have corners of two triangles at r = -5, q = 0 and so on. */
static const int32_t corner_at[6][2] = {{5, 0}, {0, 5}, {-5, 5}, {-5, 0}, {0, -5}, {5, -5}};

#endif
