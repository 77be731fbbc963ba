/* Graphs as text, to be replayed. */
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "theorem/theorem_internal.h"

#include <ctype.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* Sizes beyond this are refused: the check is for graphs, not for whole scans. */
enum { MOST_NODES = 50 * 1000 * 1000 };

typedef struct reader {
    const char *at, *end;
    int64_t line;
    sl_diag *diag;
} reader;

static sl_status refuse(reader *r, const char *reason)
{
    if (r->diag != NULL) {
        r->diag->line = r->line;
    }
    sl_diag_reason(r->diag, "%s", reason);
    sl_diag_hint(r->diag, "`seamlab theorem --help` shows the format");
    return SL_BAD_INPUT;
}

/* The next line that says something, without its line end; false at the end of the file. */
static bool next_line(reader *r, const char **begin, const char **end)
{
    while (r->at < r->end) {
        const char *newline = memchr(r->at, '\n', (size_t)(r->end - r->at));
        const char *b = r->at, *e = newline != NULL ? newline : r->end;
        r->at = newline != NULL ? newline + 1 : r->end;
        r->line++;
        while (b < e && isspace((unsigned char)*b)) {
            b++;
        }
        while (e > b && isspace((unsigned char)e[-1])) {
            e--;
        }
        if (b < e && *b != '#') {
            *begin = b;
            *end = e;
            return true;
        }
    }
    return false;
}

/* `count` whole numbers in [0, most] and nothing else between b and e. */
static bool read_numbers(const char *b, const char *e, int32_t count, int64_t most, int64_t *value)
{
    for (int32_t k = 0; k < count; k++) {
        while (b < e && (*b == ' ' || *b == '\t')) {
            b++;
        }
        const char *after = sl_parse_int(b, e, &value[k]);
        if (after == b || value[k] < 0 || value[k] > most || (after < e && *after != ' ' && *after != '\t')) {
            return false;
        }
        b = after;
    }
    return b == e;
}

/* A line "word number". */
static sl_status read_field(reader *r, const char *word, int64_t most, int64_t *value)
{
    const char *b, *e;
    char reason[96];
    const size_t length = strlen(word);
    if (next_line(r, &b, &e) && (size_t)(e - b) > length && memcmp(b, word, length) == 0 &&
        isspace((unsigned char)b[length]) && read_numbers(b + length, e, 1, most, value)) {
        return SL_OK;
    }
    snprintf(reason, sizeof reason, "expected '%s' and a whole number of at most %" PRId64, word, most);
    return refuse(r, reason);
}

static sl_status read_edges(reader *r, int64_t nodes, int64_t count, int32_t **edge)
{
    int64_t capacity = 0, value[2];
    const char *b, *e;
    for (int64_t k = 0; k < count; k++) { /* room grows with what was read, not on the header's word */
        void *array = *edge;
        const sl_status status = sl_reserve(&array, &capacity, 2 * k + 2, sizeof **edge);
        *edge = array;
        if (status != SL_OK) {
            return status;
        }
        if (!next_line(r, &b, &e)) {
            return refuse(r, "the file ends before its last edge");
        }
        if (!read_numbers(b, e, 2, nodes - 1, value)) {
            return refuse(r, "expected an edge: two node numbers");
        }
        if (value[0] == value[1]) {
            return refuse(r, "an edge joins a node to itself");
        }
        (*edge)[2 * k] = (int32_t)value[0];
        (*edge)[2 * k + 1] = (int32_t)value[1];
    }
    return SL_OK;
}

static sl_status read_images(reader *r, sl_theorem_graph *graph)
{
    const int32_t n = sl_theorem_nodes(graph);
    const char *b, *e;
    int64_t value;
    graph->second = sl_alloc(n, sizeof *graph->second);
    if (graph->second == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t i = 0; i < n; i++) {
        if (!next_line(r, &b, &e) || !read_numbers(b, e, 1, n - 1, &value)) {
            return refuse(r, "expected the image of a node");
        }
        graph->second[i] = (int32_t)value;
        if (value < i && graph->second[value] != i) {
            return refuse(r, "the second mirror is no involution");
        }
    }
    for (int32_t i = 0; i < n; i++) {
        if (graph->second[graph->second[i]] != i) {
            return refuse(r, "the second mirror is no involution");
        }
    }
    return SL_OK;
}

/* The optional second mirror, and the end. */
static sl_status read_rest(reader *r, sl_theorem_graph *graph)
{
    const char *b = r->end, *e = r->end;
    if (next_line(r, &b, &e) && e - b == 6 && memcmp(b, "second", 6) == 0) {
        const sl_status status = read_images(r, graph);
        if (status != SL_OK) {
            return status;
        }
        b = e = r->end;
        (void)next_line(r, &b, &e);
    }
    if (e - b != 3 || memcmp(b, "end", 3) != 0) {
        return refuse(r, "expected 'end' (or 'second')");
    }
    return next_line(r, &b, &e) ? refuse(r, "something stands after 'end'") : SL_OK;
}

sl_status sl_theorem_graph_read(const char *path, sl_theorem_graph **out, sl_diag *diag)
{
    char *data = NULL;
    int32_t *edge = NULL;
    int64_t size = 0, version, pairs, fixed, edges;
    sl_theorem_graph *graph = NULL;
    sl_status status = SL_OK;
    *out = NULL;
    if (diag != NULL) {
        snprintf(diag->file, sizeof diag->file, "%s", path);
    }
    SL_TRY(sl_file_read(path, &data, &size, diag));
    reader r = {data, data + size, 0, diag};
    SL_TRY(read_field(&r, "seamlab-theorem-graph", 1, &version));
    SL_TRY(version == 1 ? SL_OK : refuse(&r, "this version of the format is not known"));
    SL_TRY(read_field(&r, "pairs", MOST_NODES, &pairs));
    SL_TRY(read_field(&r, "fixed", MOST_NODES, &fixed));
    SL_TRY(read_field(&r, "edges", 4 * (int64_t)MOST_NODES, &edges));
    SL_TRY(2 * pairs + fixed >= 1 ? SL_OK : refuse(&r, "a graph needs a node"));
    SL_TRY(2 * pairs + fixed <= size * 4 + 64 ? SL_OK : refuse(&r, "far more nodes than the file has edges for"));
    SL_TRY(read_edges(&r, 2 * pairs + fixed, edges, &edge));
    SL_TRY(sl_theorem_graph_create((int32_t)pairs, (int32_t)fixed, edge, edges, &graph));
    SL_TRY(read_rest(&r, graph));
    *out = graph;
    graph = NULL;
cleanup:
    sl_theorem_graph_free(graph);
    sl_free(edge);
    sl_free(data);
    return status;
}

sl_status sl_theorem_graph_write(const char *path, const sl_theorem_graph *graph, const char *comment, sl_diag *diag)
{
    const sl_graph *g = &graph->graph;
    sl_writer *w = NULL;
    const sl_status status = sl_writer_create(path, &w, diag);
    if (status != SL_OK) {
        return status;
    }
    sl_writer_text(w, "seamlab-theorem-graph 1\n");
    if (comment != NULL) {
        sl_writer_format(w, "# %s\n", comment);
    }
    sl_writer_format(w, "pairs %d\nfixed %d\nedges %d\n", graph->pairs, graph->fixed, g->first[g->n] / 2);
    for (int32_t i = 0; i < g->n; i++) {
        for (int32_t p = g->first[i]; p < g->first[i + 1]; p++) {
            if (g->adj[p] > i) {
                sl_writer_format(w, "%d %d\n", i, g->adj[p]);
            }
        }
    }
    if (graph->second != NULL) {
        sl_writer_text(w, "second\n");
        for (int32_t i = 0; i < g->n; i++) {
            sl_writer_format(w, "%d\n", graph->second[i]);
        }
    }
    sl_writer_text(w, "end\n");
    return sl_writer_commit(w, diag);
}
