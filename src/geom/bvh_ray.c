/* Rays through the tree: boxes in float, four at a time, triangles in double. */
#include "geom/bvh_internal.h"

#include "geom/vec3.h"

#include <math.h>

enum { STACK = SL_BVH_WIDTH * SL_BVH_DEPTH };

static const double steepest = 1e12; /* inverse of a direction's coordinate at most: less than the padding is passed */
static const double slack = 0x1p-18; /* beyond the ray's ends, in units of the tree's box: what rounding may take */

/* A ray in the tree's coordinates, begun where it enters the tree's box. */
typedef struct node_ray {
    float origin[3], inverse[3];
    int backwards[3]; /* 1 where it runs down an axis */
    double per_t;     /* length there of a step of t = 1 */
    double start;     /* length passed before `origin` */
} node_ray;

/* A ray sheared so that it runs along +z. */
typedef struct shear {
    double origin[3], x, y, z;
    int kx, ky, kz;
} shear;

/* False where the ray misses the box of all, or has no direction. */
static bool start_ray(const sl_bvh *bvh, const sl_ray *ray, node_ray *out)
{
    const double length = sl_vec3_norm(ray->direction);
    if (!(length > 0.0 && length < HUGE_VAL) || bvh->count == 0) {
        return false;
    }
    double origin[3], direction[3];
    out->per_t = length * bvh->scale;
    double enter = ray->near * out->per_t, leave = ray->far * out->per_t;
    for (int k = 0; k < 3; k++) {
        direction[k] = ray->direction[k] / length;
        origin[k] = bvh->scale * (ray->origin[k] - bvh->low[k]);
        const double inverse =
            fabs(direction[k]) * steepest > 1.0 ? 1.0 / direction[k] : copysign(steepest, direction[k]);
        const double high = bvh->scale * (bvh->high[k] - bvh->low[k]);
        /* Beside what the boxes allow for, what the origin's own distance rounds away. */
        const double wide = slack + 0x1p-48 * fabs(origin[k]);
        const double a = (-wide - origin[k]) * inverse, b = (high + wide - origin[k]) * inverse;
        enter = fmax(enter, fmin(a, b));
        leave = fmin(leave, fmax(a, b));
        out->inverse[k] = (float)inverse;
        out->backwards[k] = inverse < 0.0;
    }
    out->start = enter;
    for (int k = 0; k < 3; k++) {
        out->origin[k] = (float)(origin[k] + enter * direction[k]);
    }
    return enter <= leave + slack;
}

static void set_shear(const sl_ray *ray, shear *s)
{
    const double *d = ray->direction;
    s->kz = fabs(d[0]) > fabs(d[1]) ? 0 : 1;
    s->kz = fabs(d[2]) > fabs(d[s->kz]) ? 2 : s->kz;
    s->kx = (s->kz + 1) % 3;
    s->ky = (s->kz + 2) % 3;
    s->x = d[s->kx] / d[s->kz];
    s->y = d[s->ky] / d[s->kz];
    s->z = 1.0 / d[s->kz];
    for (int k = 0; k < 3; k++) {
        s->origin[k] = ray->origin[k];
    }
}

/* The three signed areas seen along the ray decide; the same products come up, negated, in the triangle across an edge.
 */
static bool meet(const shear *s, const sl_ray *ray, const sl_bvh_triangle *triangle, sl_ray_hit *hit)
{
    double x[3], y[3], z[3], area[3];
    for (int c = 0; c < 3; c++) {
        const double *p = triangle->corner[c];
        const double depth = p[s->kz] - s->origin[s->kz];
        x[c] = p[s->kx] - s->origin[s->kx] - s->x * depth;
        y[c] = p[s->ky] - s->origin[s->ky] - s->y * depth;
        z[c] = s->z * depth;
    }
    for (int c = 0; c < 3; c++) {
        const int i = (c + 1) % 3, j = (c + 2) % 3;
        area[c] = x[j] * y[i] - y[j] * x[i];
    }
    if ((area[0] < 0.0 || area[1] < 0.0 || area[2] < 0.0) && (area[0] > 0.0 || area[1] > 0.0 || area[2] > 0.0)) {
        return false;
    }
    const double sum = area[0] + area[1] + area[2];
    const double t = (area[0] * z[0] + area[1] * z[1] + area[2] * z[2]) / sum; /* NaN where the sum is 0 */
    if (!(t > ray->near && t < ray->far)) {
        return false;
    }
    *hit = (sl_ray_hit){triangle->number, t, area[1] / sum, area[2] / sum};
    return true;
}

/* Where the ray enters each child's box; larger than it leaves it where it misses. */
static void enter_boxes(const sl_bvh_node *node, const node_ray *ray, float limit, float enter[SL_BVH_WIDTH],
                        float leave[SL_BVH_WIDTH])
{
    for (int lane = 0; lane < SL_BVH_WIDTH; lane++) {
        enter[lane] = -(float)slack;
        leave[lane] = limit;
    }
    for (int k = 0; k < 3; k++) {
        const float *first = ray->backwards[k] ? node->high[k] : node->low[k];
        const float *last = ray->backwards[k] ? node->low[k] : node->high[k];
        const float origin = ray->origin[k], inverse = ray->inverse[k];
        for (int lane = 0; lane < SL_BVH_WIDTH; lane++) {
            const float a = (first[lane] - origin) * inverse, b = (last[lane] - origin) * inverse;
            enter[lane] = a > enter[lane] ? a : enter[lane];
            leave[lane] = b < leave[lane] ? b : leave[lane];
        }
    }
}

/* Length of the ray that is still of interest, in the tree's coordinates, with room for rounding. */
static float limit_of(const node_ray *ray, double far)
{
    const double length = far * ray->per_t - ray->start;
    return (float)(length + slack + 0x1p-20 * fabs(length));
}

/* Children that are hit, pushed so that the nearest is taken first. */
static int push_children(const sl_bvh_node *node, const float *enter, const float *leave, int32_t *stack, float *from,
                         int depth)
{
    const int first = depth;
    for (int lane = 0; lane < SL_BVH_WIDTH; lane++) {
        if (!(enter[lane] <= leave[lane])) {
            continue;
        }
        int place = depth++;
        for (; place > first && from[place - 1] < enter[lane]; place--) {
            stack[place] = stack[place - 1];
            from[place] = from[place - 1];
        }
        stack[place] = node->child[lane];
        from[place] = enter[lane];
    }
    return depth;
}

/* The nearest triangle of a leaf, or any where `any`; true if it is nearer than *best. */
static bool meet_leaf(const sl_bvh *bvh, int32_t leaf, const shear *s, const sl_ray *ray, bool any, sl_ray_hit *best)
{
    const int32_t code = ~leaf, first = code >> SL_BVH_LEAF_BITS, count = code & ((1 << SL_BVH_LEAF_BITS) - 1);
    bool found = false;
    for (int32_t i = first; i < first + count; i++) {
        const sl_bvh_triangle *triangle = &bvh->triangle[i];
        sl_ray_hit hit;
        if (triangle->number == ray->skip || !meet(s, ray, triangle, &hit)) {
            continue;
        }
        if (best->triangle < 0 || hit.t < best->t || (hit.t == best->t && hit.triangle < best->triangle)) {
            *best = hit;
            found = true;
        }
        if (any) {
            return true;
        }
    }
    return found;
}

static bool traverse(const sl_bvh *bvh, const sl_ray *ray, bool any, sl_ray_hit *best)
{
    node_ray in_tree;
    shear s;
    int32_t stack[STACK];
    float from[STACK], enter[SL_BVH_WIDTH], leave[SL_BVH_WIDTH];
    int depth = 1;
    best->triangle = -1;
    if (!start_ray(bvh, ray, &in_tree)) {
        return false;
    }
    set_shear(ray, &s);
    float limit = limit_of(&in_tree, ray->far);
    stack[0] = 0;
    from[0] = 0.0f;
    while (depth > 0) {
        const int32_t at = stack[--depth];
        if (from[depth] > limit) {
            continue;
        }
        if (at >= 0) {
            enter_boxes(&bvh->node[at], &in_tree, limit, enter, leave);
            depth = push_children(&bvh->node[at], enter, leave, stack, from, depth);
        } else if (meet_leaf(bvh, at, &s, ray, any, best)) {
            if (any) {
                return true;
            }
            limit = limit_of(&in_tree, best->t);
        }
    }
    return best->triangle >= 0;
}

bool sl_bvh_any(const sl_bvh *bvh, const sl_ray *ray)
{
    sl_ray_hit hit;
    return traverse(bvh, ray, true, &hit);
}

bool sl_bvh_first(const sl_bvh *bvh, const sl_ray *ray, sl_ray_hit *hit)
{
    sl_ray_hit best;
    const bool found = traverse(bvh, ray, false, &best);
    if (found) {
        *hit = best;
    }
    return found;
}
