/* Vertex sectors from the lines that meet at each vertex. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "param/abf_internal.h"
#include "param/constraints_internal.h"

static const double pi = 3.14159265358979323846;
static const double same_angle = 1e-12;     /* [rad]: two prescribed angles that differ by less are one */
static const double right_tolerance = 1e-9; /* of a quarter turn */

/* An edge of a line at the vertex in hand. */
typedef struct ray {
    int32_t at, line;
} ray;

/* The vertex in hand and the table under construction. */
typedef struct division {
    const sl_line_set *lines;
    const sl_patch *patch;
    const sl_vertex_wish *wish;
    const sl_teller *teller;
    sl_sector_table *out;
    double *beta; /* 3 nt: measured angles, NULL when no right angles are asked for */
    int32_t v, size;
    int32_t *fan;       /* the vertex's corners, counter-clockwise */
    ray *through, *end; /* rays of lines that pass, and of lines that end (along the border: left out) */
    int32_t passing, ending;
} division;

static sl_status refuse(const division *d, const char *why)
{
    sl_diag_reason(d->teller->diag, "at vertex %d %s", sl_name_of(d->teller, d->v), why);
    if (d->teller->diag != NULL) {
        d->teller->diag->element = d->v;
    }
    return SL_INFEASIBLE;
}

/* Corners between two rays, counter-clockwise; the whole turn when they are the same ray of an interior vertex. */
static int32_t width(const division *d, int32_t from, int32_t to)
{
    const bool wraps = d->patch->border[d->v] == 0 && to <= from;
    return to - from + (wraps ? d->size : 0);
}

/* Adds the corners between two rays to the sector under construction. */
static void add_corners(division *d, int32_t from, int32_t to)
{
    sl_sector_table *out = d->out;
    for (int32_t i = 0; i < width(d, from, to); i++) {
        out->corner[out->first[out->view.count + 1]++] = d->fan[(from + i) % d->size];
    }
}

static sl_status close_sector(division *d, double theta, int32_t origin)
{
    sl_sector_table *out = d->out;
    const int32_t s = out->view.count;
    if (out->first[s + 1] == out->first[s]) {
        return refuse(d, "a sector has no triangle");
    }
    out->theta[s] = theta;
    out->vertex[s] = d->v;
    out->origin[s] = origin;
    out->view.count++;
    out->first[s + 2] = out->first[s + 1];
    const double quarters = theta / (0.5 * pi);
    if (d->wish->right_origin[d->v] >= 0 && fabs(quarters - round(quarters)) > right_tolerance) {
        return refuse(d, "lines meet that cannot make right angles");
    }
    return SL_OK;
}

/* Ends of lines strictly between two rays divide theta evenly. */
static sl_status divide_wedge(division *d, int32_t from, int32_t to, double theta, int32_t origin)
{
    sl_status status = SL_OK;
    int32_t ends = 0, at = from, before = 0;
    for (int32_t i = 0; i < d->ending; i++) {
        const int32_t w = width(d, from, d->end[i].at);
        ends += w > 0 && w < width(d, from, to);
    }
    for (int32_t part = 0; part < ends; part++) { /* the next end is the nearest beyond the last */
        int32_t next = to, nearest = width(d, from, to);
        for (int32_t i = 0; i < d->ending; i++) {
            const int32_t w = width(d, from, d->end[i].at);
            if (w > before && w < nearest) {
                nearest = w;
                next = d->end[i].at;
            }
        }
        add_corners(d, at, next);
        SL_TRY(close_sector(d, theta / (ends + 1), origin));
        at = next;
        before = nearest;
    }
    add_corners(d, at, to);
    SL_TRY(close_sector(d, theta / (ends + 1), origin));
cleanup:
    return status;
}

/* Every wedge between 0, the ends and the fan's end is pi/2 wide; *sum of what was prescribed. */
static sl_status divide_right(division *d, int32_t from, int32_t to, double *sum)
{
    int32_t ends = 0;
    for (int32_t i = 0; i < d->ending; i++) {
        ends += d->end[i].at > from && d->end[i].at < to;
    }
    if (from == to) {
        return SL_OK;
    }
    *sum += 0.5 * pi * (ends + 1);
    return divide_wedge(d, from, to, 0.5 * pi * (ends + 1), d->wish->right_origin[d->v]);
}

static double measured(const division *d, int32_t from, int32_t to)
{
    double sum = 0.0;
    for (int32_t i = 0; i < width(d, from, to); i++) {
        sum += d->beta[d->fan[(from + i) % d->size]];
    }
    return sum;
}

/* Two, three or four lines end at an interior vertex and are to make right angles: what is left over goes to the wedge
 * that is the widest on the surface. */
static sl_status divide_right_inside(division *d)
{
    sl_status status = SL_OK;
    int32_t widest = 0;
    if (d->ending < 2 || d->ending > 4) {
        return refuse(d, d->ending < 2 ? "there are no two lines to make a right angle"
                                       : "more than four lines end and cannot make right angles");
    }
    for (int32_t i = 1; i < d->ending; i++) {
        const int32_t next = d->end[(i + 1) % d->ending].at;
        if (measured(d, d->end[i].at, next) > measured(d, d->end[widest].at, d->end[widest + 1].at)) {
            widest = i;
        }
    }
    for (int32_t i = 0; i < d->ending; i++) {
        add_corners(d, d->end[i].at, d->end[(i + 1) % d->ending].at);
        const double theta = i == widest ? pi * (5 - d->ending) / 2.0 : 0.5 * pi;
        SL_TRY(close_sector(d, theta, d->wish->right_origin[d->v]));
    }
cleanup:
    return status;
}

/* What lies between the border and the outermost of the lines that pass (the whole fan where none does). */
static sl_status divide_outside(division *d, int32_t low, int32_t high, double inner)
{
    sl_status status = SL_OK;
    const double angle = d->wish->angle[d->v];
    const bool right = d->wish->right_origin[d->v] >= 0;
    double sum = inner;
    if (right) {
        SL_TRY(divide_right(d, 0, low, &sum));
        SL_TRY(divide_right(d, high, d->size, &sum));
    }
    if (isnan(angle)) {
        goto cleanup;
    }
    if (right || (low == 0 && high == d->size)) {
        status = fabs(sum - angle) <= same_angle ? SL_OK : refuse(d, "two different angles are asked for");
        goto cleanup;
    }
    if (angle <= inner) {
        status = refuse(d, "the angle asked for leaves no room beside the line that passes");
        goto cleanup;
    }
    add_corners(d, 0, low);
    add_corners(d, high, d->size);
    SL_TRY(close_sector(d, angle - inner, d->wish->angle_origin[d->v]));
cleanup:
    return status;
}

/* Lines that pass: 2 n rays, opposite ones of one line, n sectors to a straight angle. */
static sl_status divide_crossing(division *d)
{
    sl_status status = SL_OK;
    const int32_t n = d->passing / 2;
    const bool border = d->patch->border[d->v] != 0;
    int32_t last = -1;
    for (int32_t i = 0; i < n; i++) {
        last = d->through[i].line > last ? d->through[i].line : last;
        if (d->through[i].line != d->through[i + n].line) {
            return refuse(d, "two straight lines touch without crossing");
        }
    }
    for (int32_t i = 0; i < d->passing - (border ? 1 : 0); i++) {
        SL_TRY(divide_wedge(d, d->through[i].at, d->through[(i + 1) % d->passing].at, pi / n, d->lines->origin[last]));
    }
    if (border) {
        SL_TRY(divide_outside(d, d->through[0].at, d->through[d->passing - 1].at, pi * (d->passing - 1) / n));
    }
cleanup:
    return status;
}

static sl_status divide_vertex(division *d)
{
    if (d->passing > 0) {
        return divide_crossing(d);
    }
    if (d->patch->border[d->v] == 0) {
        if (d->wish->right_origin[d->v] >= 0) {
            return divide_right_inside(d);
        }
        add_corners(d, 0, d->size);
        return close_sector(d, 2.0 * pi, -1);
    }
    if (d->wish->right_origin[d->v] >= 0) { /* all of the fan lies on one side of the first edge */
        return divide_outside(d, d->size, d->size, 0.0);
    }
    return divide_outside(d, 0, 0, 0.0);
}

static void insert(ray *rays, int32_t *count, ray r)
{
    int32_t i = (*count)++;
    for (; i > 0 && rays[i - 1].at > r.at; i--) {
        rays[i] = rays[i - 1];
    }
    rays[i] = r;
}

static void list_rays(division *d)
{
    const sl_line_set *lines = d->lines;
    d->passing = d->ending = 0;
    for (int32_t i = lines->vertex_first[d->v]; i < lines->vertex_first[d->v + 1]; i++) {
        const sl_visit *visit = &lines->visit[lines->at_vertex[i]];
        const bool passes = visit->ray[0] >= 0 && visit->ray[1] >= 0;
        for (int k = 0; k < 2; k++) {
            const int32_t at = visit->ray[k];
            const bool along_border = d->patch->border[d->v] != 0 && (at == 0 || at == d->size);
            if (passes) {
                insert(d->through, &d->passing, (ray){at, visit->line});
            } else if (at >= 0 && !along_border) {
                insert(d->end, &d->ending, (ray){at, visit->line});
            }
        }
    }
}

static void list_fan(division *d)
{
    const int32_t start = d->patch->outgoing[d->v];
    int32_t c = start;
    d->size = 0;
    do {
        d->fan[d->size++] = c;
        c = sl_corner_rotate(d->patch, c);
    } while (c >= 0 && c != start);
}

static int32_t largest_valence(const sl_patch *patch, int32_t *count)
{
    int32_t largest = 0;
    for (int64_t c = 0; c < 3 * (int64_t)patch->nt; c++) {
        const int32_t n = ++count[patch->tri[c]];
        largest = n > largest ? n : largest;
    }
    return largest;
}

static sl_status allocate(division *d, bool right)
{
    const int64_t nc = 3 * (int64_t)d->patch->nt;
    sl_sector_table *out = d->out;
    int32_t *count = sl_calloc(d->patch->nv, sizeof *count);
    if (count == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    const int64_t valence = largest_valence(d->patch, count);
    sl_free(count);
    d->fan = sl_alloc(valence, sizeof *d->fan);
    d->through = sl_alloc(valence + 1, sizeof *d->through);
    d->end = sl_alloc(valence + 1, sizeof *d->end);
    d->beta = right ? sl_alloc(nc, sizeof *d->beta) : NULL;
    out->first = sl_alloc(nc + 2, sizeof *out->first);
    out->corner = sl_alloc(nc, sizeof *out->corner);
    out->theta = sl_alloc(nc, sizeof *out->theta);
    out->vertex = sl_alloc(nc, sizeof *out->vertex);
    out->origin = sl_alloc(nc, sizeof *out->origin);
    const bool failed = d->fan == NULL || d->through == NULL || d->end == NULL || (right && d->beta == NULL) ||
                        out->first == NULL || out->corner == NULL || out->theta == NULL || out->vertex == NULL ||
                        out->origin == NULL;
    return failed ? SL_OUT_OF_MEMORY : SL_OK;
}

sl_status sl_lines_divide(const sl_line_set *lines, const sl_patch *patch, const sl_vertex_wish *wish,
                          const sl_teller *teller, sl_sector_table *out)
{
    sl_status status = SL_OK;
    division d = {.lines = lines, .patch = patch, .wish = wish, .teller = teller, .out = out};
    bool right = false;
    for (int32_t v = 0; v < patch->nv; v++) {
        right = right || wish->right_origin[v] >= 0;
    }
    *out = (sl_sector_table){0};
    SL_TRY(allocate(&d, right));
    out->first[0] = out->first[1] = 0;
    if (right) {
        sl_corner_angles(patch, d.beta);
    }
    for (d.v = 0; d.v < patch->nv; d.v++) {
        list_fan(&d);
        list_rays(&d);
        SL_TRY(divide_vertex(&d));
    }
    out->view.first = out->first;
    out->view.corner = out->corner;
    out->view.theta = out->theta;
cleanup:
    sl_free(d.fan);
    sl_free(d.through);
    sl_free(d.end);
    sl_free(d.beta);
    if (status != SL_OK) {
        sl_sectors_clear(out);
    }
    return status;
}
