#include "overlap/exact_internal.h"

#include "base/memory.h"
#include "geom/predicates.h"

#include <math.h>
#include <stdlib.h>

enum {
    LEAF = 4,          /* triangles in a leaf */
    QUERY_CHUNK = 512, /* triangles one worker compares at a time */
    DEPTH = 64,        /* of the tree: halves of less than 2^31 */
};

typedef struct box {
    double low[2], high[2];
} box;

/* Triangles and their boxes' trees in one array: the node of [begin, end) is split at its middle; its box is stored at
 * the middle's number, which no other node has. */
typedef struct box_tree {
    const double *triangle;
    int32_t count;
    int32_t *member;
    box *node;
} box_tree;

static box box_of(const double *p)
{
    return (box){{fmin(p[0], fmin(p[2], p[4])), fmin(p[1], fmin(p[3], p[5]))},
                 {fmax(p[0], fmax(p[2], p[4])), fmax(p[1], fmax(p[3], p[5]))}};
}

static box join(box a, box b)
{
    return (box){{fmin(a.low[0], b.low[0]), fmin(a.low[1], b.low[1])},
                 {fmax(a.high[0], b.high[0]), fmax(a.high[1], b.high[1])}};
}

/* Boxes whose interiors are apart hold triangles whose interiors are. */
static bool apart(const box *a, const box *b)
{
    return a->low[0] >= b->high[0] || b->low[0] >= a->high[0] || a->low[1] >= b->high[1] || b->low[1] >= a->high[1];
}

/* Twice the middle of a triangle's box; halved first, so that huge coordinates do not overflow. */
static double middle(const box_tree *tree, int32_t t, int axis)
{
    const box b = box_of(tree->triangle + 6 * (int64_t)t);
    return 0.5 * b.low[axis] + 0.5 * b.high[axis];
}

static bool before(const box_tree *tree, int32_t a, int32_t b, int axis)
{
    const double x = middle(tree, a, axis), y = middle(tree, b, axis);
    return x < y || (x == y && a < b);
}

/* Quickselect: member[k] as if member[begin .. end - 1] were sorted along the axis. No two members are equal. */
static void select_middle(box_tree *tree, int32_t begin, int32_t end, int32_t k, int axis)
{
    int32_t *m = tree->member;
    while (end - begin > 1) {
        const int32_t pivot = m[begin + (end - begin) / 2];
        int32_t i = begin, j = end - 1;
        while (i <= j) {
            while (before(tree, m[i], pivot, axis)) {
                i++;
            }
            while (before(tree, pivot, m[j], axis)) {
                j--;
            }
            if (i <= j) {
                const int32_t held = m[i];
                m[i++] = m[j];
                m[j--] = held;
            }
        }
        if (k <= j) {
            end = j + 1;
        } else if (k >= i) {
            begin = i;
        } else {
            return;
        }
    }
}

/* Recursion halves the range: at most 31 deep. */
static void build(box_tree *tree, int32_t begin, int32_t end)
{
    box bound = box_of(tree->triangle + 6 * (int64_t)tree->member[begin]);
    for (int32_t i = begin + 1; i < end; i++) {
        bound = join(bound, box_of(tree->triangle + 6 * (int64_t)tree->member[i]));
    }
    const int32_t half = begin + (end - begin) / 2;
    tree->node[half] = bound;
    if (end - begin <= LEAF) {
        return;
    }
    const int axis = bound.high[0] - bound.low[0] >= bound.high[1] - bound.low[1] ? 0 : 1;
    select_middle(tree, begin, end, half, axis);
    build(tree, begin, half);
    build(tree, half, end);
}

static bool meets_any(const box_tree *tree, const double *p)
{
    int32_t stack[2 * DEPTH], top = 0;
    const box own = box_of(p);
    stack[top++] = 0;
    stack[top++] = tree->count;
    while (top > 0) {
        const int32_t end = stack[--top], begin = stack[--top], half = begin + (end - begin) / 2;
        if (apart(&own, &tree->node[half])) {
            continue;
        }
        if (end - begin > LEAF) {
            stack[top++] = begin;
            stack[top++] = half;
            stack[top++] = half;
            stack[top++] = end;
            continue;
        }
        for (int32_t i = begin; i < end; i++) {
            const double *q = tree->triangle + 6 * (int64_t)tree->member[i];
            const box other = box_of(q);
            if (!apart(&own, &other) && sl_triangles_order(p, q) == SL_TRIANGLES_OVERLAP) {
                return true;
            }
        }
    }
    return false;
}

typedef struct mark_job {
    const box_tree *tree;
    const uint8_t *taken;
    uint8_t *red;
} mark_job;

static void mark_chunk(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    (void)chunk;
    const mark_job *job = user;
    for (int64_t t = begin; t < end; t++) {
        job->red[t] = job->taken[t] || meets_any(job->tree, job->tree->triangle + 6 * t);
    }
}

sl_status sl_exact_mark(int32_t n, const double *triangle, const uint8_t *taken, const sl_context *context,
                        uint8_t *red)
{
    sl_status status = SL_OK;
    box_tree tree = {.triangle = triangle};
    for (int32_t t = 0; t < n; t++) {
        red[t] = 0;
        tree.count += taken[t];
    }
    if (tree.count == 0) {
        return SL_OK;
    }
    tree.member = sl_alloc(tree.count, sizeof *tree.member);
    tree.node = sl_alloc(tree.count, sizeof *tree.node);
    if (tree.member == NULL || tree.node == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    for (int32_t t = 0, k = 0; t < n; t++) {
        if (taken[t]) {
            tree.member[k++] = t;
        }
    }
    build(&tree, 0, tree.count);
    mark_job job = {&tree, taken, red};
    sl_parallel_for(context, n, QUERY_CHUNK, mark_chunk, &job);
cleanup:
    sl_free(tree.member);
    sl_free(tree.node);
    return status;
}
