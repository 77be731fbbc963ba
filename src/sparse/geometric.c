/* Geometric nested dissection: points are sorted into a tree of halves once; then each pair of halves loses the
 * smallest set of nodes that touches all edges between them. */
#include "sparse/dissection.h"

#include "base/memory.h"
#include "base/rng.h"

#include <string.h>

/* Pieces this small are left to minimum degree: below, separators cost more fill than they save. */
static const int32_t leaf_size = 64;

/* A separator above this share of its piece separates nothing worth having (dense or expander graphs). */
static const double largest_separator = 0.25;

typedef struct point {
    double x[3];
    int32_t node;
} point;

typedef struct halver {
    int32_t n;
    point *points;      /* in the order of the halves */
    int64_t *first;     /* n + 1: the graph with positions for nodes */
    int32_t *adj;       /* */
    bool *taken;        /* n: is in a separator */
    int32_t *left;      /* n: shores of a cut, later the positions of separators still to be listed */
    int32_t *right;     /* n */
    int32_t *right_id;  /* n: where a position stands in right, -1 elsewhere */
    int64_t *cut_first; /* n + 1 */
    int32_t *cut_adj;
    int32_t *separator; /* n: a stack */
    int32_t separator_top;
    sl_bipartite cut;
    int32_t *piece, *order; /* results */
    int32_t pieces, placed;
} halver;

static int widest_axis(const point *p, int32_t count)
{
    double lo[3], hi[3];
    memcpy(lo, p[0].x, sizeof lo);
    memcpy(hi, p[0].x, sizeof hi);
    for (int32_t k = 1; k < count; k++) {
        for (int axis = 0; axis < 3; axis++) {
            lo[axis] = p[k].x[axis] < lo[axis] ? p[k].x[axis] : lo[axis];
            hi[axis] = p[k].x[axis] > hi[axis] ? p[k].x[axis] : hi[axis];
        }
    }
    int widest = 0;
    for (int axis = 1; axis < 3; axis++) {
        widest = hi[axis] - lo[axis] > hi[widest] - lo[widest] ? axis : widest;
    }
    return widest;
}

static bool before(const point *a, const point *b, int axis)
{
    return a->x[axis] != b->x[axis] ? a->x[axis] < b->x[axis] : a->node < b->node;
}

static void swap_points(point *a, point *b)
{
    const point t = *a;
    *a = *b;
    *b = t;
}

/* Puts the `middle` smallest along the axis first. Random pivots: linear on any data. */
static void select_smallest(point *p, int32_t count, int32_t middle, int axis)
{
    sl_rng rng = sl_rng_seed((uint64_t)count);
    int32_t lo = 0, hi = count - 1;
    while (lo < hi) {
        const point pivot = p[lo + (int32_t)(sl_rng_bits(&rng) % (uint64_t)(hi - lo + 1))];
        int32_t i = lo, j = hi;
        while (i <= j) {
            while (before(&p[i], &pivot, axis)) {
                i++;
            }
            while (before(&pivot, &p[j], axis)) {
                j--;
            }
            if (i <= j) {
                swap_points(&p[i++], &p[j--]);
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

static int32_t half_of_range(int32_t begin, int32_t end)
{
    return begin + (end - begin) / 2;
}

static void sort_into_halves(point *points, int32_t begin, int32_t end)
{
    while (end - begin > leaf_size) {
        const int32_t middle = half_of_range(begin, end), count = end - begin;
        select_smallest(points + begin, count, middle - begin, widest_axis(points + begin, count));
        sort_into_halves(points, begin, middle);
        begin = middle;
    }
}

/* The graph by positions; place: n, the position of each node. */
static void renumber_graph(halver *d, const sl_adjacency *graph, int32_t *place)
{
    for (int32_t k = 0; k < d->n; k++) {
        place[d->points[k].node] = k;
    }
    int64_t filled = 0;
    for (int32_t k = 0; k < d->n; k++) {
        const int32_t v = d->points[k].node;
        d->first[k] = filled;
        for (int64_t p = graph->first[v]; p < graph->first[v + 1]; p++) {
            d->adj[filled++] = place[graph->adj[p]];
        }
    }
    d->first[d->n] = filled;
}

/* Edges from [begin, middle) to [middle, end) as a bipartite graph over its shores. */
static void collect_cut(halver *d, int32_t begin, int32_t middle, int32_t end)
{
    int64_t edges = 0;
    int32_t left_count = 0, right_count = 0;
    for (int32_t k = begin; k < middle; k++) {
        const int64_t edges_before = edges;
        for (int64_t p = d->first[k]; p < d->first[k + 1] && !d->taken[k]; p++) {
            const int32_t q = d->adj[p];
            if (q < middle || q >= end || d->taken[q]) {
                continue;
            }
            if (d->right_id[q] == -1) {
                d->right_id[q] = right_count;
                d->right[right_count++] = q;
            }
            d->cut_adj[edges++] = d->right_id[q];
        }
        if (edges > edges_before) {
            d->cut_first[left_count] = edges_before;
            d->left[left_count++] = k;
        }
    }
    d->cut_first[left_count] = edges;
    for (int32_t r = 0; r < right_count; r++) {
        d->right_id[d->right[r]] = -1;
    }
    d->cut.left_count = left_count;
    d->cut.right_count = right_count;
}

/* Pushes the cover of the cut; returns its size. */
static int32_t push_separator(halver *d)
{
    const int32_t bottom = d->separator_top;
    for (int32_t l = 0; l < d->cut.left_count; l++) {
        if (d->cut.left_in[l]) {
            d->separator[d->separator_top++] = d->left[l];
        }
    }
    for (int32_t r = 0; r < d->cut.right_count; r++) {
        if (d->cut.right_in[r]) {
            d->separator[d->separator_top++] = d->right[r];
        }
    }
    return d->separator_top - bottom;
}

static void list_node(halver *d, int32_t position)
{
    const int32_t node = d->points[position].node;
    d->piece[node] = d->pieces;
    d->order[d->placed++] = node;
}

static void list_leaf(halver *d, int32_t begin, int32_t end)
{
    for (int32_t k = begin; k < end; k++) {
        if (!d->taken[k]) {
            list_node(d, k);
        }
    }
    d->pieces++;
}

/* Lists the pieces of [begin, end). As deep as the tree of halves. */
static void dissect(halver *d, int32_t begin, int32_t end)
{
    const int32_t middle = half_of_range(begin, end), bottom = d->separator_top;
    if (end - begin <= leaf_size) {
        list_leaf(d, begin, end);
        return;
    }
    collect_cut(d, begin, middle, end);
    sl_minimum_vertex_cover(&d->cut);
    if (push_separator(d) > largest_separator * (end - begin)) {
        d->separator_top = bottom;
        list_leaf(d, begin, end);
        return;
    }
    const int32_t top = d->separator_top;
    for (int32_t k = bottom; k < top; k++) {
        d->taken[d->separator[k]] = true;
    }
    dissect(d, begin, middle);
    dissect(d, middle, end);
    for (int32_t k = bottom; k < top; k++) {
        list_node(d, d->separator[k]);
    }
    d->pieces += top > bottom;
    d->separator_top = bottom;
}

static void halver_clear(halver *d)
{
    sl_free(d->points);
    sl_free(d->first);
    sl_free(d->adj);
    sl_free(d->taken);
    sl_free(d->left);
    sl_free(d->right);
    sl_free(d->right_id);
    sl_free(d->cut_first);
    sl_free(d->cut_adj);
    sl_free(d->separator);
    sl_free(d->cut.left_mate);
    sl_free(d->cut.right_mate);
    sl_free(d->cut.level);
    sl_free(d->cut.stack);
    sl_free(d->cut.next);
    sl_free(d->cut.left_in);
    sl_free(d->cut.right_in);
}

/* A shore of the first cut may be half of all nodes. */
static sl_status halver_init(halver *d, const sl_adjacency *graph, const double *xyz)
{
    const int64_t n = graph->n, half = n / 2 + 1, edges = graph->first[n];
    d->n = graph->n;
    d->points = sl_alloc(n, sizeof *d->points);
    d->first = sl_alloc(n + 1, sizeof *d->first);
    d->adj = sl_alloc(edges, sizeof *d->adj);
    d->taken = sl_calloc(n, sizeof *d->taken);
    d->left = sl_alloc(half, sizeof *d->left);
    d->right = sl_alloc(half, sizeof *d->right);
    d->right_id = sl_alloc(n, sizeof *d->right_id);
    d->cut_first = sl_alloc(half + 1, sizeof *d->cut_first);
    d->cut_adj = sl_alloc(edges / 2, sizeof *d->cut_adj);
    d->separator = sl_alloc(n, sizeof *d->separator);
    d->cut.left_mate = sl_alloc(half, sizeof *d->cut.left_mate);
    d->cut.right_mate = sl_alloc(half, sizeof *d->cut.right_mate);
    d->cut.level = sl_alloc(half, sizeof *d->cut.level);
    d->cut.stack = sl_alloc(half, sizeof *d->cut.stack);
    d->cut.next = sl_alloc(half, sizeof *d->cut.next);
    d->cut.left_in = sl_alloc(half, sizeof *d->cut.left_in);
    d->cut.right_in = sl_alloc(half, sizeof *d->cut.right_in);
    if (d->points == NULL || d->first == NULL || d->adj == NULL || d->taken == NULL || d->left == NULL ||
        d->right == NULL || d->right_id == NULL || d->cut_first == NULL || d->cut_adj == NULL || d->separator == NULL ||
        d->cut.left_mate == NULL || d->cut.right_mate == NULL || d->cut.level == NULL || d->cut.stack == NULL ||
        d->cut.next == NULL || d->cut.left_in == NULL || d->cut.right_in == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    d->cut.first = d->cut_first;
    d->cut.adj = d->cut_adj;
    for (int32_t i = 0; i < d->n; i++) {
        memcpy(d->points[i].x, xyz + 3 * (int64_t)i, sizeof d->points[i].x);
        d->points[i].node = i;
    }
    return SL_OK;
}

sl_status sl_dissect_points(const sl_adjacency *graph, const double *xyz, int32_t *piece, int32_t *order)
{
    halver d = {.piece = piece, .order = order};
    sl_status status = SL_OK;
    SL_TRY(halver_init(&d, graph, xyz));
    sort_into_halves(d.points, 0, d.n);
    renumber_graph(&d, graph, order); /* as room: it is written at the end */
    memset(d.right_id, -1, (size_t)d.n * sizeof *d.right_id);
    dissect(&d, 0, d.n);
cleanup:
    halver_clear(&d);
    return status;
}
