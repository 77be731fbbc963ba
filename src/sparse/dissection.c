/* Nested dissection of a graph without points: halves by breadth-first search. */
#include "sparse/dissection.h"

#include "base/memory.h"

#include <string.h>

/* Pieces this small are left to minimum degree: below, separators cost more fill than they save. */
static const int32_t leaf_size = 64;

/* A separator above this share of its piece separates nothing worth having (dense or expander graphs). */
static const double largest_separator = 0.25;

typedef struct range {
    int32_t begin, end;
} range;

typedef struct dissector {
    const sl_adjacency *graph;
    int32_t *nodes; /* the nodes, pieces contiguous, in order of elimination */
    bool *begins;   /* a piece begins at this position */
    int64_t *mark;  /* 2 stamp + side of the nodes in the range at hand */
    int64_t stamp;
    int32_t *scratch; /* n */
    range *todo;
    sl_cut cut;
} dissector;

/* Appends to queue what can be reached from start among nodes marked `from`, and marks it `to`. Returns the new tail.
 */
static int32_t breadth_first(dissector *d, int32_t start, int64_t from, int64_t to, int32_t *queue, int32_t tail)
{
    int32_t head = tail;
    queue[tail++] = start;
    d->mark[start] = to;
    while (head < tail) {
        const int32_t v = queue[head++];
        for (int64_t p = d->graph->first[v]; p < d->graph->first[v + 1]; p++) {
            const int32_t w = d->graph->adj[p];
            if (d->mark[w] == from) {
                d->mark[w] = to;
                queue[tail++] = w;
            }
        }
    }
    return tail;
}

/* Sorts the nodes as a breadth-first search of each component meets them, from a node far away from some other. */
static void sort_breadth_first(dissector *d, int32_t *nodes, int32_t count)
{
    const int64_t fresh = 2 * d->stamp, seen = fresh + 1, ranked = fresh + 2;
    for (int32_t k = 0; k < count; k++) {
        d->mark[nodes[k]] = fresh;
    }
    int32_t tail = 0;
    for (int32_t k = 0; k < count; k++) {
        if (d->mark[nodes[k]] != fresh) {
            continue;
        }
        const int32_t reached = breadth_first(d, nodes[k], fresh, seen, d->scratch, tail);
        tail = breadth_first(d, d->scratch[reached - 1], seen, ranked, d->scratch, tail);
    }
    memcpy(nodes, d->scratch, (size_t)count * sizeof *nodes);
    d->stamp += 2;
}

static bool to_the_right(const void *user, int32_t v, int32_t w)
{
    (void)v;
    const dissector *d = user;
    return d->mark[w] == 2 * d->stamp + 1;
}

/* Moves the cover to the end: nodes = left side, right side, separator. Returns the size of the separator. */
static int32_t take_separator(dissector *d, int32_t *nodes, int32_t count)
{
    const int64_t taken = 2 * d->stamp + 2;
    int32_t separator = 0;
    for (int32_t l = 0; l < d->cut.shores.left_count; l++) {
        if (d->cut.shores.left_in[l]) {
            d->mark[d->cut.left[l]] = taken;
        }
    }
    for (int32_t r = 0; r < d->cut.shores.right_count; r++) {
        if (d->cut.shores.right_in[r]) {
            d->mark[d->cut.right[r]] = taken;
        }
    }
    int32_t kept = 0;
    for (int32_t k = 0; k < count; k++) {
        if (d->mark[nodes[k]] == taken) {
            d->scratch[separator++] = nodes[k];
        } else {
            nodes[kept++] = nodes[k];
        }
    }
    memcpy(nodes + kept, d->scratch, (size_t)separator * sizeof *nodes);
    return separator;
}

/* Splits one range in two and a separator; false when it is to stay a leaf. *left_end: where the left side ends. */
static bool bisect(dissector *d, range r, int32_t *left_end, int32_t *right_end)
{
    int32_t *nodes = d->nodes + r.begin;
    const int32_t count = r.end - r.begin, middle = count / 2;
    sort_breadth_first(d, nodes, count);
    for (int32_t k = 0; k < count; k++) {
        d->mark[nodes[k]] = 2 * d->stamp + (k >= middle);
    }
    sl_cut_find(&d->cut, d->graph->first, d->graph->adj, nodes, 0, middle, to_the_right, d);
    int32_t from_left = 0;
    for (int32_t l = 0; l < d->cut.shores.left_count; l++) {
        from_left += d->cut.shores.left_in[l];
    }
    const int32_t separator = take_separator(d, nodes, count);
    d->stamp += 2;
    *left_end = r.begin + middle - from_left;
    *right_end = r.end - separator;
    return separator <= largest_separator * count;
}

static void dissect_all(dissector *d)
{
    int32_t depth = 0;
    d->todo[depth++] = (range){0, d->graph->n};
    while (depth > 0) {
        const range r = d->todo[--depth];
        int32_t left_end, right_end;
        if (r.begin == r.end) {
            continue;
        }
        d->begins[r.begin] = true;
        if (r.end - r.begin <= leaf_size || !bisect(d, r, &left_end, &right_end)) {
            continue;
        }
        if (right_end < r.end) {
            d->begins[right_end] = true;
        }
        d->todo[depth++] = (range){left_end, right_end};
        d->todo[depth++] = (range){r.begin, left_end};
    }
}

void sl_adjacency_clear(sl_adjacency *graph)
{
    sl_free(graph->first);
    sl_free(graph->adj);
    *graph = (sl_adjacency){0};
}

static void dissector_clear(dissector *d)
{
    sl_free(d->nodes);
    sl_free(d->begins);
    sl_free(d->mark);
    sl_free(d->scratch);
    sl_free(d->todo);
    sl_cut_clear(&d->cut);
}

static sl_status dissector_init(dissector *d, const sl_adjacency *graph)
{
    const int64_t n = graph->n;
    *d = (dissector){.graph = graph, .stamp = 1};
    d->nodes = sl_alloc(n, sizeof *d->nodes);
    d->begins = sl_calloc(n, sizeof *d->begins);
    d->mark = sl_calloc(n, sizeof *d->mark);
    d->scratch = sl_alloc(n, sizeof *d->scratch);
    d->todo = sl_alloc(n + 2, sizeof *d->todo);
    if (d->nodes == NULL || d->begins == NULL || d->mark == NULL || d->scratch == NULL || d->todo == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t i = 0; i < graph->n; i++) {
        d->nodes[i] = i;
    }
    return sl_cut_init(&d->cut, graph);
}

sl_status sl_dissect_graph(const sl_adjacency *graph, int32_t *piece, int32_t *order)
{
    dissector d;
    sl_status status = SL_OK;
    SL_TRY(dissector_init(&d, graph));
    dissect_all(&d);
    int32_t pieces = 0;
    for (int32_t k = 0; k < graph->n; k++) {
        pieces += d.begins[k];
        piece[d.nodes[k]] = pieces - 1;
        order[k] = d.nodes[k];
    }
cleanup:
    dissector_clear(&d);
    return status;
}
