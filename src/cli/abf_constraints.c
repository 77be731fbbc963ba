#include "base/memory.h"
#include "base/text.h"
#include "cli/abf_pick.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double degree = 3.14159265358979323846 / 180.0;

enum { MOST_VERTICES = 65536 }; /* of one option */

/* What is being read, and where. */
typedef struct reader {
    cli_run *run;
    const abf_pick *pick;
    const char *option, *text, *at, *end;
    abf_constraints *out;
    int64_t used, room; /* of out->vertex */
} reader;

static int refuse(const reader *r, const char *what)
{
    return cli_usage("abf", "--%s %s: %s", r->option, r->text, what);
}

/* Vertex v of the input, at facet f (-1 = any), in the chart; `near` >= 0: joined to that patch vertex by an edge.
 * -1 = none, -2 = several. */
static int32_t find_vertex(const abf_pick *pick, int64_t v, int64_t f, int32_t near)
{
    const sl_patch *p = pick->patch;
    int32_t found = -1;
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        const int32_t w = p->tri[c];
        if (pick->name[w] != v || w == found || (f >= 0 && p->facet[c / 3] != f)) {
            continue;
        }
        if (near >= 0 && p->tri[sl_corner_next(c)] != near && p->tri[sl_corner_prev(c)] != near) {
            continue;
        }
        if (found >= 0) {
            return -2;
        }
        found = w;
    }
    return found;
}

/* Reads V or V/F; what cannot be decided yet is left to the neighbour: *vertex = -2. */
static int read_vertex(reader *r, int64_t *number, int32_t *vertex)
{
    char what[160];
    int64_t facet = -1;
    const char *after = sl_parse_int(r->at, r->end, number);
    if (after == r->at) {
        return refuse(r, "a vertex number is missing");
    }
    r->at = after;
    if (r->at < r->end && *r->at == '/') {
        after = sl_parse_int(r->at + 1, r->end, &facet);
        if (after == r->at + 1 || facet < 0) {
            return refuse(r, "a facet number is missing after '/'");
        }
        r->at = after;
    }
    *vertex = find_vertex(r->pick, *number, facet, -1);
    if (*vertex == -1) {
        snprintf(what, sizeof what, "the chart has no vertex %lld%s (vertices count from 0)", (long long)*number,
                 facet >= 0 ? " at that facet" : "");
        refuse(r, what);
        return CLI_BAD_INPUT;
    }
    return -1;
}

static int ambiguous(const reader *r, int64_t number)
{
    char what[160];
    snprintf(what, sizeof what, "vertex %lld lies more than once on the border of this chart; say %lld/FACET",
             (long long)number, (long long)number);
    refuse(r, what);
    return CLI_BAD_INPUT;
}

/* Copies of a vertex on a path: the one joined to a neighbour that is decided. Forth, then back. */
static int settle_path(const reader *r, const int64_t *number, int32_t *vertex, int32_t count)
{
    for (int32_t k = 1; k < count; k++) {
        if (vertex[k] == -2 && vertex[k - 1] >= 0) {
            vertex[k] = find_vertex(r->pick, number[k], -1, vertex[k - 1]);
        }
    }
    for (int32_t k = count - 2; k >= 0; k--) {
        if (vertex[k] < 0 && vertex[k + 1] >= 0) {
            vertex[k] = find_vertex(r->pick, number[k], -1, vertex[k + 1]);
        }
    }
    for (int32_t k = 0; k < count; k++) {
        if (vertex[k] < 0) {
            return ambiguous(r, number[k]);
        }
    }
    return -1;
}

/* Reads a list V1,V2,...; the vertices go to r->out->vertex. */
static int read_list(reader *r, bool path, int32_t *count)
{
    int code = -1;
    int64_t *number = sl_alloc(MOST_VERTICES, sizeof *number);
    int32_t *vertex = &r->out->vertex[r->used];
    *count = 0;
    if (number == NULL) {
        return cli_fail(r->run, SL_OUT_OF_MEMORY, NULL);
    }
    while (code < 0 && *count < r->room - r->used && *count < MOST_VERTICES) {
        code = read_vertex(r, &number[*count], &vertex[*count]);
        (*count)++;
        if (code >= 0 || r->at == r->end || *r->at != ',') {
            break;
        }
        r->at++;
    }
    for (int32_t k = 0; code < 0 && !path && k < *count; k++) {
        code = vertex[k] < 0 ? ambiguous(r, number[k]) : -1;
    }
    if (code < 0 && path) {
        code = settle_path(r, number, vertex, *count);
    }
    sl_free(number);
    return code;
}

/* Reads "=X" or, after a first number, ",X". */
static int read_number(reader *r, char before, double *value)
{
    const char *after = r->at;
    if (r->at < r->end && *r->at == before) {
        after = sl_parse_double(r->at + 1, r->end, value);
    }
    if (after == r->at || after == r->at + 1 || !isfinite(*value)) {
        return refuse(r, before == '=' ? "a number is missing after '='" : "a number is missing after ','");
    }
    r->at = after;
    return -1;
}

static void begin(reader *r, const char *option, const char *text)
{
    r->option = option;
    r->text = r->at = text;
    r->end = text + strlen(text);
}

/* Two vertices of a path: the shortest way between them. */
static int complete_path(reader *r, int32_t *count)
{
    int32_t *vertex = &r->out->vertex[r->used];
    char list[160] = "";
    size_t at = 0;
    const sl_status status = abf_shortest_path(r->pick->patch, vertex[0], vertex[1], vertex, count);
    for (int32_t k = 0; status == SL_OK && k < *count && at + 16 < sizeof list; k++) {
        at += (size_t)snprintf(&list[at], sizeof list - at, k > 0 ? ",%d" : "%d", r->pick->name[vertex[k]]);
    }
    if (status == SL_OK && *count > 2) {
        cli_note(r->run, "--%s %s: the shortest way has %d vertices, %s%s", r->option, r->text, *count, list,
                 at + 16 < sizeof list ? "" : "...");
    }
    return status == SL_OK ? -1 : cli_fail(r->run, status, NULL);
}

static int read_item(reader *r, sl_constraint_kind kind, const char *option, const char *text)
{
    sl_constraint *item = &r->out->item[r->out->count];
    double angle = 0.0;
    int32_t count = 0;
    begin(r, option, text);
    int code = read_list(r, kind == SL_CONSTRAINT_STRAIGHT, &count);
    if (code < 0 && kind == SL_CONSTRAINT_ANGLE) {
        code = read_number(r, '=', &angle);
    }
    if (code < 0 && r->at != r->end) {
        code = refuse(r, "cannot be read to its end");
    }
    if (code < 0 && kind == SL_CONSTRAINT_POLYGON && count != 4) {
        code = refuse(r, "a rectangle has four corners");
    }
    if (code < 0 && (kind == SL_CONSTRAINT_ANGLE || kind == SL_CONSTRAINT_RIGHT) && count != 1) {
        code = refuse(r, "one vertex is expected");
    }
    if (code < 0 && kind == SL_CONSTRAINT_STRAIGHT && count == 2) {
        code = complete_path(r, &count);
    }
    if (code < 0 && kind == SL_CONSTRAINT_STRAIGHT && count < 3) {
        code = refuse(r, "a path that can be bent has at least three vertices");
    }
    *item = (sl_constraint){kind, count, &r->out->vertex[r->used], angle * degree};
    snprintf(r->out->text[r->out->count], sizeof r->out->text[0], "--%s %.60s", option, text);
    r->used += count;
    r->out->count++;
    return code;
}

static int read_pin(reader *r, const char *text)
{
    sl_pin *pin = &r->out->pin[r->out->pins++];
    int64_t number;
    begin(r, "pin", text);
    int code = read_vertex(r, &number, &pin->vertex);
    if (code < 0 && pin->vertex < 0) {
        code = ambiguous(r, number);
    }
    code = code < 0 ? read_number(r, '=', &pin->uv[0]) : code;
    code = code < 0 ? read_number(r, ',', &pin->uv[1]) : code;
    return code < 0 && r->at != r->end ? refuse(r, "cannot be read to its end") : code;
}

/* Room for the vertices of all items; two can become a path across the chart. */
static int64_t vertices_in(const cli_list *list, int32_t nv)
{
    int64_t n = 0;
    for (int32_t k = 0; k < list->count; k++) {
        int32_t commas = 0;
        for (const char *c = list->item[k]; *c != '\0'; c++) {
            commas += *c == ',';
        }
        n += commas == 1 ? 2 + (int64_t)nv : 1 + (int64_t)commas;
    }
    return n;
}

int abf_constraints_read(cli_run *run, const abf_pick *pick, const abf_asked *asked, abf_constraints *out)
{
    const struct {
        const cli_list *list;
        sl_constraint_kind kind;
        const char *option;
    } group[] = {{&asked->angle, SL_CONSTRAINT_ANGLE, "angle"},
                 {&asked->straight, SL_CONSTRAINT_STRAIGHT, "straight"},
                 {&asked->right, SL_CONSTRAINT_RIGHT, "right-angle"},
                 {&asked->rectangle, SL_CONSTRAINT_POLYGON, "rectangle"}};
    reader r = {.run = run, .pick = pick, .out = out};
    int32_t items = 0;
    int code = -1;
    *out = (abf_constraints){0};
    for (size_t g = 0; g < SL_COUNTOF(group); g++) {
        items += group[g].list->count;
        r.room += vertices_in(group[g].list, pick->patch->nv);
    }
    out->item = sl_calloc(items, sizeof *out->item);
    out->text = sl_calloc(items, sizeof *out->text);
    out->vertex = sl_calloc(r.room, sizeof *out->vertex);
    out->pin = sl_calloc(asked->pin.count, sizeof *out->pin);
    if (out->item == NULL || out->text == NULL || out->vertex == NULL || out->pin == NULL) {
        return cli_fail(run, SL_OUT_OF_MEMORY, NULL);
    }
    for (size_t g = 0; g < SL_COUNTOF(group); g++) {
        for (int32_t k = 0; code < 0 && k < group[g].list->count; k++) {
            code = read_item(&r, group[g].kind, group[g].option, group[g].list->item[k]);
        }
    }
    for (int32_t k = 0; code < 0 && k < asked->pin.count; k++) {
        code = read_pin(&r, asked->pin.item[k]);
    }
    return code < 0 ? CLI_DONE : code;
}

void abf_constraints_clear(abf_constraints *constraints)
{
    sl_free(constraints->item);
    sl_free(constraints->text);
    sl_free(constraints->vertex);
    sl_free(constraints->pin);
    *constraints = (abf_constraints){0};
}
