/* What the stretch minimiser can keep of a user's constraints: lines as they lie, and with their directions the angles
 * between them; a prescribed angle of the border by the directions of its two edges. */
#include "base/memory.h"
#include "param/constraints_internal.h"
#include "param/flatten.h"
#include "param/flatten_internal.h"

#include <math.h>
#include <string.h>

static const double FLAT_SINE = 1e-3; /* edges that meet at less than this make one line */

/* The border edges at v: where they lead, counter-clockwise first and last. */
static void border_neighbours(const sl_patch *patch, int32_t v, int32_t neighbour[2])
{
    int32_t h = patch->outgoing[v];
    neighbour[0] = patch->tri[sl_corner_next(h)];
    for (int32_t next = sl_corner_rotate(patch, h); next >= 0; next = sl_corner_rotate(patch, h)) {
        h = next;
    }
    neighbour[1] = patch->tri[sl_corner_prev(h)];
}

/* Does a straight line run along the edge v - w? */
static bool is_on_line(const sl_line_set *set, int32_t v, int32_t w)
{
    for (int32_t i = set->vertex_first[v]; i < set->vertex_first[v + 1]; i++) {
        const int32_t p = set->at_vertex[i], l = set->visit[p].line;
        if ((p > set->first[l] && set->vertex[p - 1] == w) || (p + 1 < set->first[l + 1] && set->vertex[p + 1] == w)) {
            return true;
        }
    }
    return false;
}

static bool is_listed(const sl_flatten_lines *lines, int32_t v, int32_t w)
{
    for (int32_t l = lines->set.count; l < lines->count; l++) {
        const int32_t *e = lines->line[l].vertex;
        for (int32_t i = 0; i + 1 < lines->line[l].count; i++) {
            if ((e[i] == v && e[i + 1] == w) || (e[i] == w && e[i + 1] == v)) {
                return true;
            }
        }
    }
    return false;
}

static void add_line(sl_flatten_lines *lines, int32_t count, const int32_t *vertex)
{
    int32_t *kept = &lines->edge[3 * (lines->count - lines->set.count)];
    memcpy(kept, vertex, (size_t)count * sizeof *kept);
    lines->line[lines->count++] = (sl_stretch_line){.count = count, .vertex = kept};
}

/* The edges of the border at v that are on no line yet. */
static void keep_border_angle(const sl_patch *patch, int32_t v, const double *uv, sl_flatten_lines *lines)
{
    int32_t n[2];
    border_neighbours(patch, v, n);
    const double *o = &uv[2 * (int64_t)v], *a = &uv[2 * (int64_t)n[0]], *b = &uv[2 * (int64_t)n[1]];
    const double ax = a[0] - o[0], ay = a[1] - o[1], bx = b[0] - o[0], by = b[1] - o[1];
    const double sine = (ax * by - ay * bx) / sqrt((ax * ax + ay * ay) * (bx * bx + by * by));
    bool wanted[2];
    for (int k = 0; k < 2; k++) {
        wanted[k] = !is_on_line(&lines->set, v, n[k]) && !is_listed(lines, v, n[k]);
    }
    if (wanted[0] && wanted[1] && fabs(sine) < FLAT_SINE) {
        add_line(lines, 3, (int32_t[]){n[0], v, n[1]});
        return;
    }
    for (int k = 0; k < 2; k++) {
        if (wanted[k]) {
            add_line(lines, 2, (int32_t[]){v, n[k]});
        }
    }
}

sl_status sl_flatten_lines_init(const sl_patch *patch, int32_t count, const sl_constraint *list, const double *uv,
                                sl_flatten_lines *out)
{
    sl_status status = SL_OK;
    const sl_teller nobody = {0};
    *out = (sl_flatten_lines){0};
    SL_TRY(sl_lines_init(&out->set, patch, count, list, &nobody));
    out->line = sl_alloc((int64_t)out->set.count + 2 * (int64_t)count, sizeof *out->line);
    out->edge = sl_alloc(2 * (int64_t)count, 3 * sizeof *out->edge);
    if (out->line == NULL || out->edge == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    for (; out->count < out->set.count; out->count++) {
        const int32_t first = out->set.first[out->count], end = out->set.first[out->count + 1];
        out->line[out->count] = (sl_stretch_line){.count = end - first, .vertex = &out->set.vertex[first]};
    }
    for (int32_t i = 0; i < count; i++) {
        const bool angle = list[i].kind == SL_CONSTRAINT_ANGLE || list[i].kind == SL_CONSTRAINT_RIGHT;
        if (angle && patch->border[list[i].vertex[0]] != 0) {
            keep_border_angle(patch, list[i].vertex[0], uv, out);
        }
    }
cleanup:
    if (status != SL_OK) {
        sl_flatten_lines_clear(out);
    }
    return status;
}

void sl_flatten_lines_clear(sl_flatten_lines *lines)
{
    sl_lines_clear(&lines->set);
    sl_free(lines->line);
    sl_free(lines->edge);
    *lines = (sl_flatten_lines){0};
}

/* The similarity that brings the pins nearest to their places in the sense of least squares; with fewer than two pins a
 * translation. */
static void approach_pins(const sl_patch *patch, int32_t count, const sl_pin *pin, double *uv)
{
    double from[2] = {0.0, 0.0}, to[2] = {0.0, 0.0}, along = 0.0, across = 0.0, size = 0.0;
    for (int32_t i = 0; i < count; i++) {
        for (int k = 0; k < 2; k++) {
            from[k] += uv[2 * (int64_t)pin[i].vertex + k] / count;
            to[k] += pin[i].uv[k] / count;
        }
    }
    for (int32_t i = 0; i < count; i++) {
        const double *p = &uv[2 * (int64_t)pin[i].vertex], x = p[0] - from[0], y = p[1] - from[1];
        const double s = pin[i].uv[0] - to[0], t = pin[i].uv[1] - to[1];
        along += x * s + y * t;
        across += x * t - y * s;
        size += x * x + y * y;
    }
    const bool turns = size > 0.0 && along * along + across * across > 0.0;
    const double c = turns ? along / size : 1.0, s = turns ? across / size : 0.0;
    for (int32_t v = 0; v < patch->nv && count > 0; v++) {
        double *p = &uv[2 * (int64_t)v];
        const double x = p[0] - from[0], y = p[1] - from[1];
        p[0] = to[0] + c * x - s * y;
        p[1] = to[1] + s * x + c * y;
    }
}

sl_status sl_flatten_relax(const sl_patch *patch, const sl_stretch_def *def, const sl_flatten_wishes *wishes,
                           const sl_context *context, double *uv, sl_stretch_info *info)
{
    sl_status status = SL_OK;
    sl_flatten_lines lines = {0};
    sl_stretch_def bound = *def;
    double *map = sl_copy(uv, 2 * (int64_t)patch->nv, sizeof *uv);
    if (map == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    approach_pins(patch, wishes->pin_count, wishes->pin, map);
    SL_TRY(sl_flatten_lines_init(patch, wishes->constraint_count, wishes->constraint, map, &lines));
    bound.line = lines.line;
    bound.line_count = lines.count;
    bound.pin = wishes->pin;
    bound.pin_count = wishes->pin_count;
    SL_TRY(sl_stretch_minimise(patch, &bound, context, map, info));
    memcpy(uv, map, 2 * (size_t)patch->nv * sizeof *uv);
cleanup:
    sl_flatten_lines_clear(&lines);
    sl_free(map);
    return status;
}
