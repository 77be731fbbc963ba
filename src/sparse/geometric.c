/* Geometric nested dissection: points are sorted into a tree of halves once; then each pair of halves loses the
 * smallest set of nodes that touches all edges between them. */
#include "sparse/dissection.h"

#include "base/memory.h"
#include "base/rng.h"

#include <math.h>
#include <string.h>

/* Pieces this small are left to minimum degree: below, separators cost more fill than they save. */
static const int32_t leaf_size = 64;

/* A separator above this share of its piece separates nothing worth having (dense or expander graphs). */
static const double largest_separator = 0.25;

typedef struct point {
    double x[3];
    int32_t node;
} point;

typedef struct range {
    int32_t begin, end;
} range;

typedef struct halver {
    int32_t n;
    point *points;      /* in the order of the halves */
    int64_t *first;     /* n + 1: the graph with positions for nodes */
    int32_t *adj;       /* */
    bool *taken;        /* n: is in a separator */
    int32_t *separator; /* n: a stack of positions still to be listed */
    int32_t separator_top;
    sl_cut cut;
    int32_t *piece, *order; /* results */
    int32_t pieces, placed;
} halver;

/* The axis of largest extent, and that. */
static int widest_axis(const point *p, int32_t count, double *least, double *most)
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
    *least = lo[widest];
    *most = hi[widest];
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

/* Slices of the extent that points are counted in: the one where the middle falls is all that is left to select in. */
enum { SLICES = 1024, LEAST_SLICED = 1024 };

static int32_t slice_of(double x, double least, double scale)
{
    const double slice = (x - least) * scale;
    return slice < SLICES - 1 ? (int32_t)slice : SLICES - 1;
}

/* Sorts points by slice: those before `slice` first, those after it last. Returns where it begins; *end: where it ends.
 */
static int32_t sort_by_slice(point *p, int32_t count, int axis, double least, double scale, int32_t slice, int32_t *end)
{
    int32_t lo = 0, k = 0, hi = count;
    while (k < hi) {
        const int32_t s = slice_of(p[k].x[axis], least, scale);
        if (s < slice) {
            swap_points(&p[lo++], &p[k++]);
        } else if (s > slice) {
            swap_points(&p[k], &p[--hi]);
        } else {
            k++;
        }
    }
    *end = hi;
    return lo;
}

/* Puts the `middle` smallest along the widest axis first. */
static void halve(point *p, int32_t count, int32_t middle)
{
    double least, most;
    const int axis = widest_axis(p, count, &least, &most);
    const double scale = SLICES / (most - least);
    int32_t begin = 0, end = count;
    if (count >= LEAST_SLICED && scale > 0.0 && isfinite(scale)) {
        int32_t size[SLICES] = {0}, slice = 0, before_slice = 0;
        for (int32_t k = 0; k < count; k++) {
            size[slice_of(p[k].x[axis], least, scale)]++;
        }
        while (before_slice + size[slice] <= middle) {
            before_slice += size[slice++];
        }
        begin = sort_by_slice(p, count, axis, least, scale, slice, &end);
    }
    select_smallest(p + begin, end - begin, middle - begin, axis);
}

static int32_t half_of_range(int32_t begin, int32_t end)
{
    return begin + (end - begin) / 2;
}

static void sort_into_halves(point *points, int32_t begin, int32_t end)
{
    while (end - begin > leaf_size) {
        const int32_t middle = half_of_range(begin, end);
        halve(points + begin, end - begin, middle - begin);
        sort_into_halves(points, begin, middle);
        begin = middle;
    }
}

/* From this depth on halves are sorted side by side, each as a whole. */
enum { SHARED_LEVELS = 4 };

typedef struct halves_job {
    point *points;
    int32_t n, level;
} halves_job;

/* Range t of those at the job's level. */
static range range_at(const halves_job *job, int32_t t)
{
    range r = {0, job->n};
    for (int32_t bit = job->level - 1; bit >= 0; bit--) {
        const int32_t middle = half_of_range(r.begin, r.end);
        if ((t >> bit & 1) != 0) {
            r.begin = middle;
        } else {
            r.end = middle;
        }
    }
    return r;
}

static void halve_one(void *user, int64_t begin, int64_t end, int32_t t)
{
    (void)begin, (void)end;
    const halves_job *job = user;
    const range r = range_at(job, t);
    if (r.end - r.begin <= leaf_size) {
        return;
    }
    if (job->level == SHARED_LEVELS) {
        sort_into_halves(job->points, r.begin, r.end);
    } else {
        halve(job->points + r.begin, r.end - r.begin, half_of_range(r.begin, r.end) - r.begin);
    }
}

/* sort_into_halves of all points; each level waits for the one above. */
static void sort_all(point *points, int32_t n, const sl_context *context)
{
    for (int32_t level = 0; level <= SHARED_LEVELS; level++) {
        halves_job job = {points, n, level};
        sl_parallel_for(context, (int64_t)1 << level, 1, halve_one, &job);
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

/* Edges from [begin, middle) to [middle, end). */
typedef struct split {
    const bool *taken;
    int32_t middle, end;
} split;

static bool to_the_right(const void *user, int32_t v, int32_t w)
{
    const split *s = user;
    return w >= s->middle && w < s->end && !s->taken[w] && !s->taken[v];
}

/* Pushes the cover of the cut; returns its size. */
static int32_t push_separator(halver *d)
{
    const int32_t bottom = d->separator_top;
    const sl_bipartite *shores = &d->cut.shores;
    for (int32_t l = 0; l < shores->left_count; l++) {
        if (shores->left_in[l]) {
            d->separator[d->separator_top++] = d->cut.left[l];
        }
    }
    for (int32_t r = 0; r < shores->right_count; r++) {
        if (shores->right_in[r]) {
            d->separator[d->separator_top++] = d->cut.right[r];
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
    const split s = {d->taken, middle, end};
    sl_cut_find(&d->cut, d->first, d->adj, NULL, begin, middle - begin, to_the_right, &s);
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
    sl_free(d->separator);
    sl_cut_clear(&d->cut);
}

static sl_status halver_init(halver *d, const sl_adjacency *graph, const double *xyz)
{
    const int64_t n = graph->n;
    d->n = graph->n;
    d->points = sl_alloc(n, sizeof *d->points);
    d->first = sl_alloc(n + 1, sizeof *d->first);
    d->adj = sl_alloc(graph->first[n], sizeof *d->adj);
    d->taken = sl_calloc(n, sizeof *d->taken);
    d->separator = sl_alloc(n, sizeof *d->separator);
    if (d->points == NULL || d->first == NULL || d->adj == NULL || d->taken == NULL || d->separator == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t i = 0; i < d->n; i++) {
        memcpy(d->points[i].x, xyz + 3 * (int64_t)i, sizeof d->points[i].x);
        d->points[i].node = i;
    }
    return sl_cut_init(&d->cut, graph);
}

sl_status sl_dissect_points(const sl_adjacency *graph, const double *xyz, const sl_context *context, int32_t *piece,
                            int32_t *order)
{
    halver d = {.piece = piece, .order = order};
    sl_status status = SL_OK;
    SL_TRY(halver_init(&d, graph, xyz));
    sort_all(d.points, d.n, context);
    renumber_graph(&d, graph, order); /* as room: it is written at the end */
    dissect(&d, 0, d.n);
cleanup:
    halver_clear(&d);
    return status;
}
