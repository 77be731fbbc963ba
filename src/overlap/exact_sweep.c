#include "overlap/exact_internal.h"

#include "base/memory.h"
#include "geom/predicates.h"

#include <math.h>
#include <stdlib.h>

/* A triangle's first or last abscissa. */
typedef struct sweep_event {
    double x;
    int32_t triangle;
} sweep_event;

/* A treap node: a search tree by height, a heap by a fixed hash of the triangle's number. -1 = none. */
typedef struct sweep_node {
    int32_t left, right, parent;
    int32_t below, above; /* neighbours on the sweep line */
    uint32_t rank;
} sweep_node;

typedef struct sweep {
    const double *triangle;
    sweep_node *node;
    uint8_t *taken;
    int32_t root;
    int32_t *pair;
    bool found;
} sweep;

static int compare_events(const void *a, const void *b)
{
    const sweep_event *e = a, *f = b;
    if (e->x != f->x) {
        return e->x < f->x ? -1 : 1;
    }
    return (e->triangle > f->triangle) - (e->triangle < f->triangle);
}

static sl_triangle_order order(const sweep *s, int32_t a, int32_t b)
{
    return sl_triangles_order(s->triangle + 6 * (int64_t)a, s->triangle + 6 * (int64_t)b);
}

/* Notes that b overlaps a, which stays. */
static void take_out(sweep *s, int32_t a, int32_t b)
{
    s->taken[b] = 1;
    if (!s->found) {
        s->pair[0] = a < b ? a : b;
        s->pair[1] = a < b ? b : a;
        s->found = true;
    }
}

/* Puts `fresh` (perhaps -1) where `old` hangs. */
static void replace_child(sweep *s, int32_t parent, int32_t old, int32_t fresh)
{
    if (parent < 0) {
        s->root = fresh;
    } else if (s->node[parent].left == old) {
        s->node[parent].left = fresh;
    } else {
        s->node[parent].right = fresh;
    }
    if (fresh >= 0) {
        s->node[fresh].parent = parent;
    }
}

/* Turns node t with its parent, which becomes its child. */
static void rotate_up(sweep *s, int32_t t)
{
    sweep_node *node = s->node;
    const int32_t p = node[t].parent;
    const bool is_left = node[p].left == t;
    const int32_t inner = is_left ? node[t].right : node[t].left;
    replace_child(s, node[p].parent, p, t);
    if (is_left) {
        node[p].left = inner;
        node[t].right = p;
    } else {
        node[p].right = inner;
        node[t].left = p;
    }
    node[p].parent = t;
    if (inner >= 0) {
        node[inner].parent = p;
    }
}

static void link_neighbours(sweep *s, int32_t below, int32_t above)
{
    if (below >= 0) {
        s->node[below].above = above;
    }
    if (above >= 0) {
        s->node[above].below = below;
    }
}

/* The neighbours of a new leaf are on the path to it, so it is compared with both. */
static void insert(sweep *s, int32_t t)
{
    sweep_node *node = s->node;
    int32_t at = s->root, parent = -1, below = -1, above = -1;
    while (at >= 0) {
        const sl_triangle_order side = order(s, t, at);
        if (side == SL_TRIANGLES_OVERLAP) {
            take_out(s, at, t);
            return;
        }
        parent = at;
        if (side == SL_TRIANGLE_BELOW) {
            above = at;
            at = node[at].left;
        } else {
            below = at;
            at = node[at].right;
        }
    }
    const uint32_t rank = (uint32_t)((((uint64_t)t + 1) * 0x9e3779b97f4a7c15u) >> 32);
    node[t] = (sweep_node){-1, -1, parent, below, above, rank};
    if (parent < 0) {
        s->root = t;
    } else if (above == parent) {
        node[parent].left = t;
    } else {
        node[parent].right = t;
    }
    link_neighbours(s, below, t);
    link_neighbours(s, t, above);
    while (node[t].parent >= 0 && node[node[t].parent].rank < node[t].rank) {
        rotate_up(s, t);
    }
}

static void unhang(sweep *s, int32_t t)
{
    sweep_node *node = s->node;
    while (node[t].left >= 0 && node[t].right >= 0) {
        const int32_t l = node[t].left, r = node[t].right;
        rotate_up(s, node[l].rank > node[r].rank ? l : r);
    }
    replace_child(s, node[t].parent, t, node[t].left >= 0 ? node[t].left : node[t].right);
    link_neighbours(s, node[t].below, node[t].above);
}

/* Whoever become neighbours are compared. */
static void leave(sweep *s, int32_t t)
{
    const int32_t below = s->node[t].below;
    int32_t above = s->node[t].above;
    unhang(s, t);
    while (below >= 0 && above >= 0 && order(s, below, above) == SL_TRIANGLES_OVERLAP) {
        const int32_t next = s->node[above].above;
        take_out(s, below, above);
        unhang(s, above);
        above = next;
    }
}

static void list_events(int32_t n, const double *triangle, sweep_event *begin, sweep_event *end)
{
    for (int32_t t = 0; t < n; t++) {
        const double *p = triangle + 6 * (int64_t)t;
        begin[t] = (sweep_event){fmin(p[0], fmin(p[2], p[4])), t};
        end[t] = (sweep_event){fmax(p[0], fmax(p[2], p[4])), t};
    }
    qsort(begin, (size_t)n, sizeof *begin, compare_events);
    qsort(end, (size_t)n, sizeof *end, compare_events);
}

sl_status sl_exact_sweep(int32_t n, const double *triangle, bool first_only, uint8_t *taken, int32_t pair[2])
{
    sl_status status = SL_OK;
    sweep s = {.triangle = triangle, .taken = taken, .root = -1, .pair = pair};
    sweep_event *begin = sl_alloc(n, sizeof *begin), *end = sl_alloc(n, sizeof *end);
    s.node = sl_alloc(n, sizeof *s.node);
    if (begin == NULL || end == NULL || s.node == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    list_events(n, triangle, begin, end);
    for (int32_t i = 0, j = 0; i < n && !(first_only && s.found);) {
        if (end[j].x <= begin[i].x) { /* who ends here makes room first: the ranges of all on the line overlap */
            const int32_t t = end[j++].triangle;
            if (!taken[t]) {
                leave(&s, t);
            }
        } else {
            insert(&s, begin[i++].triangle);
        }
    }
    for (int32_t j = 0; j < n && !(first_only && s.found); j++) { /* nothing starts any more; the rest leave in order */
        const int32_t t = end[j].triangle;
        if (!taken[t] && end[j].x > begin[n - 1].x) {
            leave(&s, t);
        }
    }
cleanup:
    sl_free(begin);
    sl_free(end);
    sl_free(s.node);
    return status;
}
