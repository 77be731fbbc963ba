/* What a layout makes of constraints, and pins. */
#include <math.h>

#include "param/constraints_internal.h"

static double corner_angle(const sl_patch *patch, const double *uv, int32_t c)
{
    const double *p = &uv[2 * (int64_t)patch->tri[c]], *q = &uv[2 * (int64_t)patch->tri[sl_corner_next(c)]];
    const double *r = &uv[2 * (int64_t)patch->tri[sl_corner_prev(c)]];
    const double a[2] = {q[0] - p[0], q[1] - p[1]}, b[2] = {r[0] - p[0], r[1] - p[1]};
    return atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
}

/* Largest deviation of the sectors that constraint `index` made or, if it is about one vertex, that are there. */
static double worst_angle(const sl_patch *patch, const sl_constraint *constraint, int32_t index,
                          const sl_sector_table *table, const double *uv)
{
    const bool at_vertex = constraint->kind == SL_CONSTRAINT_ANGLE || constraint->kind == SL_CONSTRAINT_RIGHT;
    double worst = 0.0;
    for (int32_t s = 0; s < table->view.count; s++) {
        double sum = -table->view.theta[s];
        if (table->origin[s] != index && !(at_vertex && table->vertex[s] == constraint->vertex[0])) {
            continue;
        }
        for (int32_t p = table->view.first[s]; p < table->view.first[s + 1]; p++) {
            sum += corner_angle(patch, uv, table->view.corner[p]);
        }
        worst = fabs(sum) <= worst ? worst : fabs(sum); /* keeps a NaN */
    }
    return worst;
}

/* Distance of p from the chord a b; from a where the chord is a point. */
static double off_chord(const double *a, const double *b, const double *p)
{
    const double d[2] = {b[0] - a[0], b[1] - a[1]}, e[2] = {p[0] - a[0], p[1] - a[1]}, length = hypot(d[0], d[1]);
    return length > 0.0 ? fabs(d[0] * e[1] - d[1] * e[0]) / length : hypot(e[0], e[1]);
}

static double worst_on_path(const sl_constraint *path, const double *uv)
{
    const double *a = &uv[2 * (int64_t)path->vertex[0]], *b = &uv[2 * (int64_t)path->vertex[path->count - 1]];
    double worst = 0.0;
    for (int32_t i = 0; i < path->count; i++) {
        worst = fmax(worst, off_chord(a, b, &uv[2 * (int64_t)path->vertex[i]]));
    }
    return worst;
}

/* Along the border from `from` to the first of the vertices in `stop` (the chart on its left); *end = which it is. */
static double worst_on_border(const sl_patch *patch, const sl_constraint *stop, int32_t from, const double *uv,
                              int32_t *end)
{
    int32_t h = patch->outgoing[from], to = -1;
    double worst = 0.0;
    while (to < 0) {
        const int32_t v = patch->tri[sl_corner_next(h)];
        for (int32_t i = 0; i < stop->count; i++) {
            to = stop->vertex[i] == v ? v : to;
        }
        to = v == from ? v : to; /* a loop comes back */
        h = patch->outgoing[v];
    }
    for (h = patch->outgoing[from]; patch->tri[sl_corner_next(h)] != to; h = sl_border_next(patch, h)) {
        const int32_t v = patch->tri[sl_corner_next(h)];
        worst = fmax(worst, off_chord(&uv[2 * (int64_t)from], &uv[2 * (int64_t)to], &uv[2 * (int64_t)v]));
    }
    *end = to;
    return worst;
}

static double worst_line(const sl_patch *patch, const sl_constraint *constraint, const double *uv)
{
    int32_t end = constraint->vertex[0];
    double worst = 0.0;
    switch (constraint->kind) {
    case SL_CONSTRAINT_STRAIGHT:
        return worst_on_path(constraint, uv);
    case SL_CONSTRAINT_BORDER:
        return worst_on_border(patch, &(sl_constraint){.count = 1, .vertex = &constraint->vertex[1]}, end, uv, &end);
    case SL_CONSTRAINT_POLYGON:
        for (int32_t i = 0; i < constraint->count; i++) {
            worst = fmax(worst, worst_on_border(patch, constraint, end, uv, &end));
        }
        return worst;
    case SL_CONSTRAINT_ANGLE:
    case SL_CONSTRAINT_RIGHT:
        break;
    }
    return 0.0;
}

static double diagonal(int32_t nv, const double *uv)
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int64_t i = 0; i < 2 * (int64_t)nv; i++) {
        low[i % 2] = fmin(low[i % 2], uv[i]);
        high[i % 2] = fmax(high[i % 2], uv[i]);
    }
    return hypot(high[0] - low[0], high[1] - low[1]);
}

void sl_constraints_measure(const sl_patch *patch, int32_t count, const sl_constraint *list,
                            const sl_sector_table *table, const double *uv, sl_constraint_measure *measure)
{
    const double size = diagonal(patch->nv, uv);
    for (int32_t i = 0; i < count; i++) {
        const double worst = worst_line(patch, &list[i], uv);
        measure[i].angle = worst_angle(patch, &list[i], i, table, uv);
        measure[i].line = size > 0.0 ? worst / size : worst;
    }
}

static sl_status check_pins(const sl_patch *patch, int32_t count, const sl_pin *pin, const double *uv, sl_diag *diag)
{
    if (count > 2) {
        sl_diag_reason(diag, "%d pins: a similarity can hold two", count);
        sl_diag_hint(diag, "more than two take the stretch energy");
        return SL_UNSUPPORTED;
    }
    for (int32_t i = 0; i < count; i++) {
        if (pin[i].vertex < 0 || pin[i].vertex >= patch->nv || !isfinite(pin[i].uv[0]) || !isfinite(pin[i].uv[1])) {
            sl_diag_reason(diag, "pin %d names a vertex that is not in the chart, or no place", i + 1);
            return SL_BAD_INPUT;
        }
    }
    if (count == 2) {
        const double *a = &uv[2 * (int64_t)pin[0].vertex], *b = &uv[2 * (int64_t)pin[1].vertex];
        const double wanted = hypot(pin[1].uv[0] - pin[0].uv[0], pin[1].uv[1] - pin[0].uv[1]);
        const double scale = wanted / hypot(b[0] - a[0], b[1] - a[1]);
        if (!(scale > 0.0) || !isfinite(scale)) {
            sl_diag_reason(diag, "two pins must be two vertices at two places");
            return SL_INFEASIBLE;
        }
    }
    return SL_OK;
}

sl_status sl_pins_apply(const sl_patch *patch, int32_t count, const sl_pin *pin, double *uv, sl_diag *diag)
{
    const sl_status status = check_pins(patch, count, pin, uv, diag);
    if (status != SL_OK || count == 0) {
        return status;
    }
    const double a[2] = {uv[2 * (int64_t)pin[0].vertex], uv[2 * (int64_t)pin[0].vertex + 1]};
    double turn[2] = {1.0, 0.0}; /* a complex factor */
    if (count == 2) {
        const double *b = &uv[2 * (int64_t)pin[1].vertex], d[2] = {b[0] - a[0], b[1] - a[1]};
        const double e[2] = {pin[1].uv[0] - pin[0].uv[0], pin[1].uv[1] - pin[0].uv[1]};
        const double square = d[0] * d[0] + d[1] * d[1];
        turn[0] = (e[0] * d[0] + e[1] * d[1]) / square;
        turn[1] = (e[1] * d[0] - e[0] * d[1]) / square;
    }
    for (int32_t v = 0; v < patch->nv; v++) {
        double *p = &uv[2 * (int64_t)v];
        const double d[2] = {p[0] - a[0], p[1] - a[1]};
        p[0] = pin[0].uv[0] + turn[0] * d[0] - turn[1] * d[1];
        p[1] = pin[0].uv[1] + turn[1] * d[0] + turn[0] * d[1];
    }
    return SL_OK;
}
