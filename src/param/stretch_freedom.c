/* What vertices may do: held ones nothing, those of a line slide along it, and lines move along their normals. As the
 * directions of lines never change, all of this is linear, and a step of any length keeps it. */
#include "param/stretch_internal.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

static const double STRAIGHT = 1e-6;   /* distance of a line's vertices from it, per length */
static const double LEAST_SINE = 1e-3; /* of the angle between lines that cross */
enum { NO_LINE = -1, LINES_AT_VERTEX = 2 };

/* The lines while unknowns are handed out. */
typedef struct line_table {
    int32_t count;
    double (*direction)[2]; /* unit vectors */
    bool *fixed;
    int32_t *unknown;               /* of the line's offset */
    int32_t (*at)[LINES_AT_VERTEX]; /* nv: the lines a vertex is on */
    uint8_t *held;                  /* nv */
} line_table;

static sl_status line_table_init(const sl_patch *patch, const sl_stretch_def *def, line_table *t)
{
    t->count = def->line_count;
    t->direction = sl_alloc(t->count, sizeof *t->direction);
    t->fixed = sl_calloc(t->count, sizeof *t->fixed);
    t->unknown = sl_alloc(t->count, sizeof *t->unknown);
    t->at = sl_alloc(patch->nv, sizeof *t->at);
    t->held = sl_calloc(patch->nv, sizeof *t->held);
    if (t->direction == NULL || t->fixed == NULL || t->unknown == NULL || t->at == NULL || t->held == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    memset(t->at, NO_LINE, (size_t)patch->nv * sizeof *t->at);
    if (def->fixed != NULL) {
        memcpy(t->held, def->fixed, (size_t)patch->nv);
    }
    return SL_OK;
}

static void line_table_clear(line_table *t)
{
    sl_free(t->direction);
    sl_free(t->fixed);
    sl_free(t->unknown);
    sl_free(t->at);
    sl_free(t->held);
}

/* The direction of a line from its first vertex to its last; false when it has none or is not straight. */
static bool find_direction(const sl_stretch_line *line, const double *uv, double direction[2])
{
    const double *a = &uv[2 * (int64_t)line->vertex[0]], *b = &uv[2 * (int64_t)line->vertex[line->count - 1]];
    const double x = b[0] - a[0], y = b[1] - a[1], length = sqrt(x * x + y * y);
    if (!(length > 0.0) || !isfinite(length)) {
        return false;
    }
    direction[0] = x / length;
    direction[1] = y / length;
    for (int32_t i = 1; i < line->count; i++) {
        const double *p = &uv[2 * (int64_t)line->vertex[i]];
        const double off = direction[0] * (p[1] - a[1]) - direction[1] * (p[0] - a[0]);
        if (!(fabs(off) <= STRAIGHT * length)) {
            return false;
        }
    }
    return true;
}

/* Enters line l at its vertices. A third line at a vertex holds it. */
static bool enter_line(const sl_stretch_line *line, int32_t l, line_table *t)
{
    for (int32_t i = 0; i < line->count; i++) {
        const int32_t v = line->vertex[i];
        int32_t *at = t->at[v];
        if (at[0] == l || at[1] == l) {
            return false;
        }
        if (at[0] == NO_LINE) {
            at[0] = l;
        } else if (at[1] == NO_LINE) {
            at[1] = l;
        } else {
            t->held[v] = 1;
        }
    }
    return true;
}

/* A line with a held vertex is fixed, a vertex on two fixed lines is held, until nothing changes. */
static void spread_holds(const sl_stretch_def *def, line_table *t)
{
    for (bool changed = true; changed;) {
        changed = false;
        for (int32_t l = 0; l < t->count; l++) {
            for (int32_t i = 0; i < def->line[l].count; i++) {
                const int32_t v = def->line[l].vertex[i], *at = t->at[v];
                const bool both = at[1] != NO_LINE && t->fixed[at[0]] && t->fixed[at[1]];
                if (both && t->held[v] == 0) {
                    t->held[v] = 1;
                    changed = true;
                }
                if (t->held[v] != 0 && !t->fixed[l]) {
                    t->fixed[l] = true;
                    changed = true;
                }
            }
        }
    }
}

static sl_status enter_lines(const sl_patch *patch, const sl_stretch_def *def, const double *uv, line_table *t)
{
    for (int32_t l = 0; l < t->count; l++) {
        const sl_stretch_line *line = &def->line[l];
        for (int32_t i = 0; i < line->count; i++) {
            if (line->vertex[i] < 0 || line->vertex[i] >= patch->nv) {
                return SL_BAD_INPUT;
            }
        }
        if (line->count < 2 || !find_direction(line, uv, t->direction[l]) || !enter_line(line, l, t)) {
            return SL_BAD_INPUT;
        }
        t->fixed[l] = line->fixed;
    }
    spread_holds(def, t);
    return SL_OK;
}

/* On one line: along it, and with it along its normal. */
static void slide(const line_table *t, int32_t l, int32_t own, int32_t *unknown, double *basis)
{
    const double *d = t->direction[l];
    unknown[0] = own;
    unknown[1] = t->unknown[l];
    memcpy(basis, (double[]){d[0], d[1], -d[1], d[0]}, 4 * sizeof *basis);
}

/* Where two lines cross: their normals n and m and the offsets c, d give x n = c, x m = d. */
static bool cross_lines(const line_table *t, const int32_t at[LINES_AT_VERTEX], int32_t *unknown, double *basis)
{
    const double *a = t->direction[at[0]], *b = t->direction[at[1]];
    const double sine = a[0] * b[1] - a[1] * b[0];
    if (!(fabs(sine) >= LEAST_SINE)) {
        return false;
    }
    unknown[0] = t->unknown[at[0]];
    unknown[1] = t->unknown[at[1]];
    memcpy(basis, (double[]){b[0] / sine, b[1] / sine, -a[0] / sine, -a[1] / sine}, 4 * sizeof *basis);
    return true;
}

/* Numbers the unknowns: vertices first, offsets of lines last, so that the long columns of these are eliminated late.
 */
static sl_status number_unknowns(const sl_patch *patch, line_table *t, sl_stretch_freedom *f)
{
    int32_t count = 0;
    for (int32_t v = 0; v < patch->nv; v++) {
        count += t->held[v] != 0 || t->at[v][1] != NO_LINE ? 0 : t->at[v][0] != NO_LINE ? 1 : 2;
    }
    for (int32_t l = 0; l < t->count; l++) {
        t->unknown[l] = t->fixed[l] ? -1 : count++;
    }
    f->unknowns = count;
    count = 0;
    for (int32_t v = 0; v < patch->nv; v++) {
        int32_t *unknown = &f->unknown[2 * (int64_t)v];
        double *basis = f->basis != NULL ? &f->basis[4 * (int64_t)v] : NULL;
        unknown[0] = unknown[1] = -1;
        if (basis != NULL) {
            memcpy(basis, (double[]){1.0, 0.0, 0.0, 1.0}, 4 * sizeof *basis);
        }
        if (t->held[v] != 0) {
            continue;
        }
        if (t->at[v][0] == NO_LINE) {
            unknown[0] = count++;
            unknown[1] = count++;
        } else if (t->at[v][1] == NO_LINE) {
            slide(t, t->at[v][0], count++, unknown, basis);
        } else if (!cross_lines(t, t->at[v], unknown, basis)) {
            return SL_BAD_INPUT;
        }
    }
    return SL_OK;
}

sl_status sl_stretch_freedom_init(const sl_patch *patch, const sl_stretch_def *def, const double *uv,
                                  sl_stretch_freedom *out)
{
    sl_status status = SL_OK;
    line_table t = {0};
    *out = (sl_stretch_freedom){.nv = patch->nv, .unknowns = 2 * patch->nv, .block = 2};
    if (def->fixed == NULL && def->line_count == 0) {
        return SL_OK;
    }
    SL_TRY(line_table_init(patch, def, &t));
    out->unknown = sl_alloc(patch->nv, 2 * sizeof *out->unknown);
    if (def->line_count > 0) {
        out->block = 1;
        out->basis = sl_alloc(patch->nv, 4 * sizeof *out->basis);
    }
    if (out->unknown == NULL || (def->line_count > 0 && out->basis == NULL)) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    SL_TRY(enter_lines(patch, def, uv, &t));
    SL_TRY(number_unknowns(patch, &t, out));
cleanup:
    line_table_clear(&t);
    if (status != SL_OK) {
        sl_stretch_freedom_clear(out);
    }
    return status;
}

void sl_stretch_freedom_clear(sl_stretch_freedom *freedom)
{
    sl_free(freedom->unknown);
    sl_free(freedom->basis);
    *freedom = (sl_stretch_freedom){0};
}

bool sl_stretch_holds_places(const sl_patch *patch, const sl_stretch_def *def)
{
    bool holds = false;
    for (int32_t v = 0; v < patch->nv && def->fixed != NULL; v++) {
        holds = holds || def->fixed[v] != 0;
    }
    for (int32_t l = 0; l < def->line_count; l++) {
        holds = holds || def->line[l].fixed;
    }
    return holds || def->pin_count > 0;
}
