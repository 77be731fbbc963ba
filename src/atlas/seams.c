#include "atlas/seams.h"

#include "atlas/weld.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* An edge of the mesh by its input vertices, a < b. */
typedef struct named_edge {
    int32_t a, b, halfedge;
} named_edge;

static int compare_named(const void *px, const void *py)
{
    const named_edge *x = px, *y = py;
    if (x->a != y->a) {
        return x->a < y->a ? -1 : 1;
    }
    if (x->b != y->b) {
        return x->b < y->b ? -1 : 1;
    }
    return (x->halfedge > y->halfedge) - (x->halfedge < y->halfedge);
}

static named_edge name_edge(const sl_mesh *mesh, int32_t h)
{
    const int32_t a = mesh->input_vertex[mesh->origin[h]], b = mesh->input_vertex[sl_target(mesh, h)];
    return (named_edge){a < b ? a : b, a < b ? b : a, h};
}

/* First entry not below (a, b). */
static int64_t lower_bound(const named_edge *edge, int64_t count, int32_t a, int32_t b)
{
    int64_t lo = 0, hi = count;
    while (lo < hi) {
        const int64_t mid = lo + (hi - lo) / 2;
        const bool below = edge[mid].a != a ? edge[mid].a < a : edge[mid].b < b;
        lo = below ? mid + 1 : lo;
        hi = below ? hi : mid;
    }
    return lo;
}

static sl_status cut_named_edges(sl_mesh *mesh, const sl_seam_input *input, sl_diag *diag)
{
    named_edge *edge = sl_alloc(mesh->nh, sizeof *edge);
    if (edge == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t h = 0; h < mesh->nh; h++) {
        edge[h] = name_edge(mesh, h);
    }
    qsort(edge, (size_t)mesh->nh, sizeof *edge, compare_named);
    sl_status status = SL_OK;
    for (int32_t e = 0; e < input->edge_count && status == SL_OK; e++) {
        const int32_t v = input->edge[2 * (int64_t)e], w = input->edge[2 * (int64_t)e + 1];
        const int32_t a = v < w ? v : w, b = v < w ? w : v;
        int64_t i = lower_bound(edge, mesh->nh, a, b);
        if (i == mesh->nh || edge[i].a != a || edge[i].b != b) {
            sl_diag_reason(diag, "seam edge %d has vertices %d and %d, which no facet's edge joins", e + 1, v, w);
            sl_diag_hint(diag, "vertex numbers count from 0 in the order of the mesh file");
            if (diag != NULL) {
                diag->element = e;
            }
            status = SL_BAD_INPUT;
        }
        for (; status == SL_OK && i < mesh->nh && edge[i].a == a && edge[i].b == b; i++) {
            sl_mesh_cut_edge(mesh, edge[i].halfedge);
        }
    }
    sl_free(edge);
    return status;
}

static void cut_between_labels(sl_mesh *mesh, const int32_t *label)
{
    for (int32_t h = 0; h < mesh->nh; h++) {
        const int32_t t = mesh->twin[h];
        if (t >= 0 && label[mesh->face[h]] != label[mesh->face[t]]) {
            sl_mesh_cut_edge(mesh, h);
        }
    }
}

static sl_status cut_uv_seams(sl_mesh *mesh, const double *corner_uv, sl_diag *diag)
{
    int32_t *uv = sl_alloc(mesh->nh, sizeof *uv), distinct = 0;
    if (uv == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    sl_status status = SL_OK;
    for (int32_t c = 0; c < mesh->nh; c++) {
        if (isnan(corner_uv[2 * (int64_t)c]) || isnan(corner_uv[2 * (int64_t)c + 1])) {
            sl_diag_reason(diag, "facet %d has a corner without a UV, so there are no seams to keep",
                           mesh->face[c] + 1);
            sl_diag_hint(diag, "leave out --keep-seams, or give seams by --seams or --labels");
            status = SL_BAD_INPUT;
            goto cleanup;
        }
    }
    SL_TRY(sl_weld_points(mesh->nh, 2, corner_uv, uv, &distinct));
    for (int32_t h = 0; h < mesh->nh; h++) {
        const int32_t t = mesh->twin[h];
        if (t < 0) {
            continue;
        }
        const int32_t here = uv[sl_input_corner(mesh, h)], there = uv[sl_input_corner(mesh, sl_next(mesh, t))];
        const int32_t here_end = uv[sl_input_corner(mesh, sl_next(mesh, h))], there_end = uv[sl_input_corner(mesh, t)];
        if (here != there || here_end != there_end) {
            sl_mesh_cut_edge(mesh, h);
        }
    }
cleanup:
    sl_free(uv);
    return status;
}

sl_status sl_seams_cut(sl_mesh *mesh, sl_seam_source source, const sl_seam_input *input, sl_diag *diag)
{
    switch (source) {
    case SL_SEAMS_EDGES:
        return cut_named_edges(mesh, input, diag);
    case SL_SEAMS_LABELS:
        cut_between_labels(mesh, input->label);
        return SL_OK;
    case SL_SEAMS_KEEP_UV:
        return cut_uv_seams(mesh, input->corner_uv, diag);
    case SL_SEAMS_AUTOMATIC:
        break;
    }
    return SL_OK;
}

static const char *skip_blanks(const char *p, const char *end)
{
    while (p < end && (*p == ' ' || *p == '\t' || *p == '\r' || *p == ',' || *p == ';')) {
        p++;
    }
    return p;
}

/* The integers of one line [p, end), at most `most`; -1 when something else stands there. */
static int32_t line_integers(const char *p, const char *end, int32_t most, int64_t *value)
{
    int32_t count = 0;
    for (p = skip_blanks(p, end); p < end && *p != '#'; p = skip_blanks(p, end)) {
        const char *after = count < most ? sl_parse_int(p, end, &value[count]) : p;
        if (after == p) {
            return -1;
        }
        p = after;
        count++;
    }
    return count;
}

/* Is it a header: a first line that starts with a letter? */
static bool is_header(const char *p, const char *end, int64_t line)
{
    p = skip_blanks(p, end);
    return line == 1 && p < end && ((*p >= 'a' && *p <= 'z') || (*p >= 'A' && *p <= 'Z'));
}

/* Calls take(user, values, count) for each line with integers; take returns NULL or what is wrong with them. */
static sl_status read_integer_lines(const char *path, int32_t most,
                                    const char *(*take)(void *user, const int64_t *value, int32_t count), void *user,
                                    sl_diag *diag)
{
    char *text = NULL;
    int64_t size = 0, line = 0, value[4];
    SL_ASSERT(most <= (int32_t)SL_COUNTOF(value));
    sl_status status = sl_file_read(path, &text, &size, diag);
    if (status != SL_OK) {
        return status;
    }
    for (const char *p = text, *end = text + size; p < end && status == SL_OK;) {
        const char *stop = memchr(p, '\n', (size_t)(end - p));
        stop = stop != NULL ? stop : end;
        line++;
        const int32_t count = is_header(p, stop, line) ? 0 : line_integers(p, stop, most, value);
        const char *wrong = count < 0 ? "not a list of integers" : count > 0 ? take(user, value, count) : NULL;
        if (wrong != NULL) {
            sl_diag_reason(diag, "%s", wrong);
            if (diag != NULL) {
                snprintf(diag->file, sizeof diag->file, "%s", path);
                diag->line = line;
            }
            status = SL_BAD_INPUT;
        }
        p = stop < end ? stop + 1 : end;
    }
    sl_free(text);
    return status;
}

/* A growing list of 32-bit numbers. */
typedef struct number_list {
    int32_t *value;
    int64_t count, capacity, limit;
    bool out_of_memory;
} number_list;

static bool push_number(number_list *list, int64_t value)
{
    if (sl_reserve((void **)&list->value, &list->capacity, list->count + 1, sizeof *list->value) != SL_OK) {
        list->out_of_memory = true;
        return false;
    }
    list->value[list->count++] = (int32_t)value;
    return true;
}

static const char *take_edge(void *user, const int64_t *value, int32_t count)
{
    number_list *list = user;
    if (count != 2) {
        return "an edge is two vertex numbers";
    }
    for (int k = 0; k < 2; k++) {
        if (value[k] < 0 || value[k] > INT32_MAX) {
            return "a vertex number is out of range (they count from 0)";
        }
    }
    return push_number(list, value[0]) && push_number(list, value[1]) ? NULL : "out of memory";
}

static const char *take_label(void *user, const int64_t *value, int32_t count)
{
    number_list *list = user;
    const int64_t label = value[count - 1];
    if (count > 2) {
        return "a line holds one label, or a facet number and its label";
    }
    if (count == 2 && value[0] != list->count) {
        return "facet numbers must count 0, 1, 2, ... in the order of the mesh file";
    }
    if (label < INT32_MIN || label > INT32_MAX) {
        return "a label is out of range";
    }
    if (list->count == list->limit) {
        return "more labels than the mesh has facets";
    }
    return push_number(list, label) ? NULL : "out of memory";
}

sl_status sl_seams_read_edges(const char *path, int32_t **edge, int32_t *count, sl_diag *diag)
{
    number_list list = {0};
    const sl_status status = read_integer_lines(path, 3, take_edge, &list, diag);
    if (status != SL_OK || list.count / 2 > INT32_MAX) {
        sl_free(list.value);
        return status == SL_OK || list.out_of_memory ? SL_OUT_OF_MEMORY : status;
    }
    *edge = list.value;
    *count = (int32_t)(list.count / 2);
    return SL_OK;
}

sl_status sl_seams_read_labels(const char *path, int32_t nf, int32_t **label, sl_diag *diag)
{
    number_list list = {.limit = nf};
    sl_status status = read_integer_lines(path, 3, take_label, &list, diag);
    if (status == SL_OK && list.count != nf) {
        sl_diag_reason(diag, "%s has labels for %lld of %d facets", path, (long long)list.count, nf);
        sl_diag_hint(diag, "write one integer a line, one line a facet");
        status = SL_BAD_INPUT;
    }
    if (status != SL_OK) {
        sl_free(list.value);
        return list.out_of_memory ? SL_OUT_OF_MEMORY : status;
    }
    *label = list.value;
    return SL_OK;
}
