/* Nested dissection of a graph without points: halves by breadth-first search. */
#include "sparse/dissection.h"

#include "base/memory.h"
#include "base/rng.h"

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
    int32_t *left, *right; /* nodes of the cut's two shores */
    int32_t *right_id;     /* where a node stands in right */
    int32_t *scratch;      /* n */
    double *key;           /* n, by node: what a bisection splits by */
    int64_t *cut_first;    /* n + 1 */
    int32_t *cut_adj;
    range *todo;
    sl_bipartite cut;
} dissector;

static bool before(const dissector *d, int32_t a, int32_t b)
{
    return d->key[a] != d->key[b] ? d->key[a] < d->key[b] : a < b;
}

/* Reorders nodes so that the `middle` smallest by (key, index) come first. Random pivots: linear on any data. */
static void select_smallest(const dissector *d, int32_t *nodes, int32_t count, int32_t middle)
{
    sl_rng rng = sl_rng_seed((uint64_t)count);
    int32_t lo = 0, hi = count - 1;
    while (lo < hi) {
        const int32_t pivot = nodes[lo + (int32_t)(sl_rng_bits(&rng) % (uint64_t)(hi - lo + 1))];
        int32_t i = lo, j = hi;
        while (i <= j) {
            while (before(d, nodes[i], pivot)) {
                i++;
            }
            while (before(d, pivot, nodes[j])) {
                j--;
            }
            if (i <= j) {
                const int32_t t = nodes[i];
                nodes[i++] = nodes[j];
                nodes[j--] = t;
            }
        }
        if (middle <= j) {
            hi = j;
        } else if (middle >= i) {
            lo = i;
        } else {
            return;
        }
    }
}

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

/* Keys are ranks in a breadth-first search of each component, from a node far away from some other. */
static void key_by_breadth_first(dissector *d, const int32_t *nodes, int32_t count)
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
    for (int32_t k = 0; k < count; k++) {
        d->key[d->scratch[k]] = (double)k;
    }
    d->stamp += 2;
}

/* The edges between the two sides as a bipartite graph over the shores. */
static void collect_cut(dissector *d, const int32_t *nodes, int32_t middle)
{
    const int64_t right_mark = 2 * d->stamp + 1;
    int64_t edges = 0;
    int32_t left_count = 0, right_count = 0;
    for (int32_t k = 0; k < middle; k++) {
        const int32_t v = nodes[k];
        const int64_t edges_before = edges;
        for (int64_t p = d->graph->first[v]; p < d->graph->first[v + 1]; p++) {
            const int32_t w = d->graph->adj[p];
            if (d->mark[w] != right_mark) {
                continue;
            }
            if (d->right_id[w] == -1) {
                d->right_id[w] = right_count;
                d->right[right_count++] = w;
            }
            d->cut_adj[edges++] = d->right_id[w];
        }
        if (edges > edges_before) {
            d->cut_first[left_count] = edges_before;
            d->left[left_count++] = v;
        }
    }
    d->cut_first[left_count] = edges;
    for (int32_t r = 0; r < right_count; r++) {
        d->right_id[d->right[r]] = -1;
    }
    d->cut.left_count = left_count;
    d->cut.right_count = right_count;
}

/* Moves the cover to the end: nodes = left side, right side, separator. Returns the size of the separator. */
static int32_t take_separator(dissector *d, int32_t *nodes, int32_t count)
{
    const int64_t taken = 2 * d->stamp + 2;
    int32_t separator = 0;
    for (int32_t l = 0; l < d->cut.left_count; l++) {
        if (d->cut.left_in[l]) {
            d->mark[d->left[l]] = taken;
        }
    }
    for (int32_t r = 0; r < d->cut.right_count; r++) {
        if (d->cut.right_in[r]) {
            d->mark[d->right[r]] = taken;
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
    key_by_breadth_first(d, nodes, count);
    select_smallest(d, nodes, count, middle);
    for (int32_t k = 0; k < count; k++) {
        d->mark[nodes[k]] = 2 * d->stamp + (k >= middle);
    }
    collect_cut(d, nodes, middle);
    sl_minimum_vertex_cover(&d->cut);
    int32_t from_left = 0;
    for (int32_t l = 0; l < d->cut.left_count; l++) {
        from_left += d->cut.left_in[l];
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
    sl_free(d->left);
    sl_free(d->right);
    sl_free(d->right_id);
    sl_free(d->scratch);
    sl_free(d->key);
    sl_free(d->cut_first);
    sl_free(d->cut_adj);
    sl_free(d->todo);
    sl_free(d->cut.left_mate);
    sl_free(d->cut.right_mate);
    sl_free(d->cut.level);
    sl_free(d->cut.stack);
    sl_free(d->cut.next);
    sl_free(d->cut.left_in);
    sl_free(d->cut.right_in);
}

static sl_status dissector_init(dissector *d, const sl_adjacency *graph)
{
    const int64_t n = graph->n;
    *d = (dissector){.graph = graph, .stamp = 1};
    d->nodes = sl_alloc(n, sizeof *d->nodes);
    d->begins = sl_calloc(n, sizeof *d->begins);
    d->mark = sl_calloc(n, sizeof *d->mark);
    d->left = sl_alloc(n, sizeof *d->left);
    d->right = sl_alloc(n, sizeof *d->right);
    d->right_id = sl_alloc(n, sizeof *d->right_id);
    d->scratch = sl_alloc(n, sizeof *d->scratch);
    d->key = sl_alloc(n, sizeof *d->key);
    d->cut_first = sl_alloc(n + 1, sizeof *d->cut_first);
    d->cut_adj = sl_alloc(graph->first[n] / 2, sizeof *d->cut_adj);
    d->todo = sl_alloc(n + 2, sizeof *d->todo);
    d->cut.left_mate = sl_alloc(n, sizeof *d->cut.left_mate);
    d->cut.right_mate = sl_alloc(n, sizeof *d->cut.right_mate);
    d->cut.level = sl_alloc(n, sizeof *d->cut.level);
    d->cut.stack = sl_alloc(n, sizeof *d->cut.stack);
    d->cut.next = sl_alloc(n, sizeof *d->cut.next);
    d->cut.left_in = sl_alloc(n, sizeof *d->cut.left_in);
    d->cut.right_in = sl_alloc(n, sizeof *d->cut.right_in);
    if (d->nodes == NULL || d->begins == NULL || d->mark == NULL || d->left == NULL || d->right == NULL ||
        d->right_id == NULL || d->scratch == NULL || d->key == NULL || d->cut_first == NULL || d->cut_adj == NULL ||
        d->todo == NULL || d->cut.left_mate == NULL || d->cut.right_mate == NULL || d->cut.level == NULL ||
        d->cut.stack == NULL || d->cut.next == NULL || d->cut.left_in == NULL || d->cut.right_in == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    d->cut.first = d->cut_first;
    d->cut.adj = d->cut_adj;
    for (int32_t i = 0; i < graph->n; i++) {
        d->nodes[i] = i;
        d->right_id[i] = -1;
    }
    return SL_OK;
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
