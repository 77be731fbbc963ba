#include "symmetry/nearest.h"

#include "base/memory.h"
#include "base/rng.h"
#include "geom/vec3.h"

#include <string.h>

enum { LEAF = 6, STACK = 80 };

typedef struct box {
    double low[3], high[3];
} box;

/* A range of `list`, halved at its middle down to LEAF triangles; children follow in preorder, the second at `second`.
 */
typedef struct node {
    box bounds;
    int32_t begin, end, second; /* second: -1 = leaf */
} node;

struct sl_nearest {
    const double *xyz;
    const int32_t *vertex;
    int32_t *list; /* triangles */
    node *nodes;
    int32_t count;
};

typedef struct builder {
    sl_nearest *tree;
    double *centroid; /* 3 nt */
    sl_rng rng;
} builder;

static const double *corner(const sl_nearest *tree, int32_t t, int k)
{
    return &tree->xyz[3 * (int64_t)tree->vertex[3 * (int64_t)t + k]];
}

static bool before(const builder *b, int axis, int32_t s, int32_t t)
{
    const double x = b->centroid[3 * (int64_t)s + axis], y = b->centroid[3 * (int64_t)t + axis];
    return x < y || (x == y && s < t);
}

/* Orders list[begin .. end) so that the one at `middle` stands where sorting puts it. Source: Hoare 1961, "Find". */
static void select_middle(builder *b, int axis, int32_t begin, int32_t end, int32_t middle)
{
    int32_t *list = b->tree->list;
    while (end - begin > 1) {
        const int32_t pivot = list[begin + (int32_t)(sl_rng_bits(&b->rng) % (uint64_t)(end - begin))];
        int32_t i = begin, j = end - 1;
        while (i <= j) {
            while (before(b, axis, list[i], pivot)) {
                i++;
            }
            while (before(b, axis, pivot, list[j])) {
                j--;
            }
            if (i <= j) {
                const int32_t swap = list[i];
                list[i++] = list[j];
                list[j--] = swap;
            }
        }
        if (middle <= j) {
            end = j + 1;
        } else if (middle >= i) {
            begin = i;
        } else {
            return;
        }
    }
}

static void grow(box *b, const double p[3])
{
    for (int k = 0; k < 3; k++) {
        b->low[k] = p[k] < b->low[k] ? p[k] : b->low[k];
        b->high[k] = p[k] > b->high[k] ? p[k] : b->high[k];
    }
}

static int32_t build(builder *b, int32_t begin, int32_t end)
{
    static const box empty = {{HUGE_VAL, HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}};
    sl_nearest *tree = b->tree;
    const int32_t me = tree->count++;
    box bounds = empty, centroids = empty;
    for (int32_t i = begin; i < end; i++) {
        for (int k = 0; k < 3; k++) {
            grow(&bounds, corner(tree, tree->list[i], k));
        }
        grow(&centroids, &b->centroid[3 * (int64_t)tree->list[i]]);
    }
    tree->nodes[me] = (node){bounds, begin, end, -1};
    if (end - begin > LEAF) {
        int axis = 0;
        for (int k = 1; k < 3; k++) {
            axis = centroids.high[k] - centroids.low[k] > centroids.high[axis] - centroids.low[axis] ? k : axis;
        }
        const int32_t middle = begin + (end - begin) / 2;
        select_middle(b, axis, begin, end, middle);
        build(b, begin, middle);
        const int32_t second = build(b, middle, end);
        tree->nodes[me].second = second;
    }
    return me;
}

sl_status sl_nearest_create(const double *xyz, const int32_t *vertex, int32_t nt, sl_nearest **out)
{
    sl_status status = SL_OK;
    sl_nearest *tree = sl_calloc(1, sizeof *tree);
    builder b = {tree, sl_alloc(3 * (int64_t)nt, sizeof *b.centroid), sl_rng_seed(0x6e656172)};
    if (tree == NULL || b.centroid == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    tree->xyz = xyz;
    tree->vertex = vertex;
    tree->list = sl_alloc(nt, sizeof *tree->list);
    tree->nodes = sl_alloc((int64_t)nt, sizeof *tree->nodes); /* leaves hold more than LEAF / 2 */
    if (tree->list == NULL || tree->nodes == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    for (int32_t t = 0; t < nt; t++) {
        tree->list[t] = t;
        for (int k = 0; k < 3; k++) {
            b.centroid[3 * (int64_t)t + k] =
                (corner(tree, t, 0)[k] + corner(tree, t, 1)[k] + corner(tree, t, 2)[k]) / 3;
        }
    }
    build(&b, 0, nt);
    *out = tree;
    tree = NULL;
cleanup:
    sl_nearest_free(tree);
    sl_free(b.centroid);
    return status;
}

void sl_nearest_free(sl_nearest *tree)
{
    if (tree != NULL) {
        sl_free(tree->list);
        sl_free(tree->nodes);
        sl_free(tree);
    }
}

static inline double box_distance2(const box *b, const double p[3])
{
    double sum = 0.0;
    for (int k = 0; k < 3; k++) {
        const double below = b->low[k] - p[k], above = p[k] - b->high[k];
        const double d = below > above ? below : above;
        sum += d > 0.0 ? d * d : 0.0;
    }
    return sum;
}

static double distance2(const double a[3], const double b[3])
{
    double d[3];
    sl_vec3_sub(a, b, d);
    return sl_vec3_dot(d, d);
}

/* Point of segment ab nearest to p. */
static void nearest_on_segment(const double a[3], const double b[3], const double p[3], double out[3])
{
    double e[3], d[3];
    sl_vec3_sub(b, a, e);
    sl_vec3_sub(p, a, d);
    const double length2 = sl_vec3_dot(e, e);
    double t = length2 > 0.0 ? sl_vec3_dot(e, d) / length2 : 0.0;
    t = t < 0.0 ? 0.0 : t > 1.0 ? 1.0 : t;
    for (int k = 0; k < 3; k++) {
        out[k] = a[k] + t * e[k];
    }
}

/* Foot of p on the plane of triangle abc, if it lies inside. */
static bool foot_inside(const double a[3], const double b[3], const double c[3], const double p[3], double out[3])
{
    double e[3], f[3], d[3], n[3], m[3];
    sl_vec3_sub(b, a, e);
    sl_vec3_sub(c, a, f);
    sl_vec3_sub(p, a, d);
    sl_vec3_cross(e, f, n);
    const double area2 = sl_vec3_dot(n, n);
    if (!(area2 > 0.0)) {
        return false;
    }
    sl_vec3_cross(d, f, m);
    const double u = sl_vec3_dot(m, n) / area2;
    sl_vec3_cross(e, d, m);
    const double v = sl_vec3_dot(m, n) / area2;
    for (int k = 0; k < 3; k++) {
        out[k] = a[k] + u * e[k] + v * f[k];
    }
    return u >= 0.0 && v >= 0.0 && u + v <= 1.0;
}

static double nearest_on_triangle(const sl_nearest *tree, int32_t t, const double p[3], double out[3])
{
    if (foot_inside(corner(tree, t, 0), corner(tree, t, 1), corner(tree, t, 2), p, out)) {
        return distance2(out, p);
    }
    double best = HUGE_VAL;
    for (int k = 0; k < 3; k++) {
        double q[3];
        nearest_on_segment(corner(tree, t, k), corner(tree, t, (k + 1) % 3), p, q);
        if (distance2(q, p) < best) {
            best = distance2(q, p);
            memcpy(out, q, sizeof q);
        }
    }
    return best;
}

int32_t sl_nearest_find(const sl_nearest *tree, const double p[3], double point[3], double *distance)
{
    int32_t stack[STACK], top = 0, found = -1; /* depth <= 32 levels, one waiting node each */
    double best = HUGE_VAL;
    stack[top++] = 0;
    while (top > 0) {
        const node *n = &tree->nodes[stack[--top]];
        if (box_distance2(&n->bounds, p) >= best) {
            continue;
        }
        if (n->second >= 0) {
            const int32_t first = (int32_t)(n - tree->nodes) + 1;
            const bool swap =
                box_distance2(&tree->nodes[n->second].bounds, p) < box_distance2(&tree->nodes[first].bounds, p);
            stack[top++] = swap ? first : n->second;
            stack[top++] = swap ? n->second : first;
            continue;
        }
        for (int32_t i = n->begin; i < n->end; i++) {
            double q[3];
            const double d = nearest_on_triangle(tree, tree->list[i], p, q);
            if (d < best) {
                best = d;
                found = tree->list[i];
                memcpy(point, q, sizeof q);
            }
        }
    }
    *distance = sqrt(best);
    return found;
}
