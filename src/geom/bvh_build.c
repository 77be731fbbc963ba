/* Building the tree: top down, by binned surface area. */
#include "geom/bvh_internal.h"

#include "base/memory.h"

#include <math.h>

enum {
    BINS = 16,
    BALANCED_FROM = 24 /* levels of nodes after which ranges are halved by count: 2^31 triangles need 16 more */
};

/* What the boxes are larger by, in units of the whole tree's box: above the rounding of a traversal in float. */
static const double padding = 0x1p-19;

static const double farthest = SL_BVH_FARTHEST; /* NaN compares false */

typedef struct box {
    double low[3], high[3];
} box;

typedef struct item {
    box box;
    double centre[3];
    int32_t triangle;
} item;

/* Triangles [begin, end) of the list below a node at some level. */
typedef struct range {
    int32_t begin, end;
} range;

typedef struct builder {
    const double *xyz;
    const int32_t *tri;
    item *item;
    sl_bvh *bvh;
    int64_t capacity;
} builder;

static const box empty = {{HUGE_VAL, HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}};

static double lesser(double a, double b)
{
    return a < b ? a : b;
}

static double greater(double a, double b)
{
    return a > b ? a : b;
}

static void box_add_point(box *b, const double p[3])
{
    for (int k = 0; k < 3; k++) {
        b->low[k] = lesser(b->low[k], p[k]);
        b->high[k] = greater(b->high[k], p[k]);
    }
}

static void box_add(box *b, const box *other)
{
    for (int k = 0; k < 3; k++) {
        b->low[k] = lesser(b->low[k], other->low[k]);
        b->high[k] = greater(b->high[k], other->high[k]);
    }
}

/* Half the surface; 0 for an empty box. */
static double half_area(const box *b)
{
    const double x = b->high[0] - b->low[0], y = b->high[1] - b->low[1], z = b->high[2] - b->low[2];
    return x >= 0.0 ? x * y + y * z + z * x : 0.0;
}

static box bound(const item *list, range r)
{
    box b = empty;
    for (int32_t i = r.begin; i < r.end; i++) {
        box_add(&b, &list[i].box);
    }
    return b;
}

/* The axis along which the centres reach farthest. */
static int widest(const item *list, range r, double *low, double *extent)
{
    box b = empty;
    for (int32_t i = r.begin; i < r.end; i++) {
        box_add_point(&b, list[i].centre);
    }
    int axis = 0;
    for (int k = 1; k < 3; k++) {
        axis = b.high[k] - b.low[k] > b.high[axis] - b.low[axis] ? k : axis;
    }
    *low = b.low[axis];
    *extent = b.high[axis] - b.low[axis];
    return axis;
}

static int bin_of(double centre, double low, double scale)
{
    const int bin = (int)((centre - low) * scale);
    return bin < BINS - 1 ? bin : BINS - 1;
}

/* Bins [0, result) go to one side: where areas times triangles are least; 0 = one bin holds all. */
static int choose_bin(const item *list, range r, int axis, double low, double scale)
{
    box bin[BINS], side = empty;
    int32_t count[BINS] = {0}, before = 0, all = r.end - r.begin;
    double above[BINS], best = HUGE_VAL;
    int chosen = 0;
    for (int k = 0; k < BINS; k++) {
        bin[k] = empty;
    }
    for (int32_t i = r.begin; i < r.end; i++) {
        const int k = bin_of(list[i].centre[axis], low, scale);
        box_add(&bin[k], &list[i].box);
        count[k]++;
    }
    for (int k = BINS - 1; k > 0; k--) {
        box_add(&side, &bin[k]);
        above[k] = half_area(&side);
    }
    side = empty;
    for (int k = 1; k < BINS; k++) {
        box_add(&side, &bin[k - 1]);
        before += count[k - 1];
        const double cost = half_area(&side) * before + above[k] * (all - before);
        if (before > 0 && before < all && cost < best) {
            best = cost;
            chosen = k;
        }
    }
    return chosen;
}

/* Items of the lower bins to the front, each side in its old order or the reverse of it: by swaps from both ends. */
static int32_t part(item *list, range r, int axis, double low, double scale, int bin)
{
    int32_t i = r.begin, k = r.end;
    while (i < k) {
        if (bin_of(list[i].centre[axis], low, scale) < bin) {
            i++;
        } else {
            const item swap = list[--k];
            list[k] = list[i];
            list[i] = swap;
        }
    }
    return i;
}

/* Where to cut a range of two and more triangles in two. */
static int32_t split(item *list, range r, int32_t level)
{
    const int32_t middle = r.begin + (r.end - r.begin) / 2;
    double low, extent;
    if (level >= BALANCED_FROM) {
        return middle;
    }
    const int axis = widest(list, r, &low, &extent);
    const double scale = BINS / extent;
    if (!(extent > 0.0) || !(scale < HUGE_VAL)) {
        return middle;
    }
    const int bin = choose_bin(list, r, axis, low, scale);
    return bin > 0 ? part(list, r, axis, low, scale, bin) : middle;
}

/* Up to four ranges that a node's triangles are cut into; the largest one is cut on. */
static int cut_up(item *list, range whole, int32_t level, range child[SL_BVH_WIDTH])
{
    int count = 1;
    child[0] = whole;
    while (count < SL_BVH_WIDTH) {
        int largest = 0;
        for (int k = 1; k < count; k++) {
            largest = child[k].end - child[k].begin > child[largest].end - child[largest].begin ? k : largest;
        }
        const range r = child[largest];
        if (r.end - r.begin <= SL_BVH_LEAF) {
            break;
        }
        const int32_t at = split(list, r, level);
        child[largest].end = at;
        child[count++] = (range){at, r.end};
    }
    return count;
}

/* A box into the lane of a node, in the tree's coordinates, padded. */
static void set_box(const sl_bvh *bvh, sl_bvh_node *node, int lane, const box *b)
{
    for (int k = 0; k < 3; k++) {
        node->low[k][lane] = (float)(bvh->scale * (b->low[k] - bvh->low[k]) - padding);
        node->high[k][lane] = (float)(bvh->scale * (b->high[k] - bvh->low[k]) + padding);
    }
}

static void close_lane(sl_bvh_node *node, int lane)
{
    for (int k = 0; k < 3; k++) {
        node->low[k][lane] = HUGE_VALF;
        node->high[k][lane] = -HUGE_VALF;
    }
    node->child[lane] = -1;
}

static sl_status add_node(builder *b, int32_t *number)
{
    sl_bvh *bvh = b->bvh;
    const sl_status status = sl_reserve((void **)&bvh->node, &b->capacity, (int64_t)bvh->nodes + 1, sizeof *bvh->node);
    if (status == SL_OK) {
        *number = bvh->nodes++;
    }
    return status;
}

/* Depth first, over a stack of ranges that still need their node. Every level cuts off something, and from
 * BALANCED_FROM on each range in half, so the levels are bounded. */
static sl_status build_nodes(builder *b)
{
    enum { STACK = SL_BVH_WIDTH * SL_BVH_DEPTH };
    struct {
        range range;
        int32_t level, parent, lane;
    } stack[STACK];
    sl_status status = SL_OK;
    int32_t depth = 0, number;
    stack[depth].range = (range){0, b->bvh->count};
    stack[depth].level = 0;
    stack[depth++].parent = -1;
    while (depth > 0 && status == SL_OK) {
        range child[SL_BVH_WIDTH];
        const int32_t level = stack[--depth].level, parent = stack[depth].parent, lane = stack[depth].lane;
        const int count = cut_up(b->item, stack[depth].range, level, child);
        status = add_node(b, &number);
        if (status != SL_OK) {
            break;
        }
        if (parent >= 0) {
            b->bvh->node[parent].child[lane] = number;
        }
        sl_bvh_node *node = &b->bvh->node[number];
        for (int k = 0; k < SL_BVH_WIDTH; k++) {
            close_lane(node, k);
        }
        for (int k = 0; k < count; k++) {
            const int32_t size = child[k].end - child[k].begin;
            const box around = bound(b->item, child[k]);
            set_box(b->bvh, node, k, &around);
            if (size <= SL_BVH_LEAF) {
                node->child[k] = ~(child[k].begin << SL_BVH_LEAF_BITS | size);
                continue;
            }
            SL_ASSERT(depth < STACK);
            stack[depth].range = child[k];
            stack[depth].level = level + 1;
            stack[depth].parent = number;
            stack[depth++].lane = k;
        }
    }
    return status;
}

/* Boxes and centres of the triangles that can be hit at all. */
static void list_items(builder *b, int32_t nt)
{
    box all = empty;
    b->bvh->count = 0;
    for (int32_t t = 0; t < nt; t++) {
        item *it = &b->item[b->bvh->count];
        bool finite = true;
        it->box = empty;
        it->triangle = t;
        for (int k = 0; k < 3; k++) {
            const double *p = b->xyz + 3 * (int64_t)b->tri[3 * (int64_t)t + k];
            finite = finite && fabs(p[0]) <= farthest && fabs(p[1]) <= farthest && fabs(p[2]) <= farthest;
            box_add_point(&it->box, p);
        }
        for (int k = 0; k < 3; k++) {
            it->centre[k] = 0.5 * it->box.low[k] + 0.5 * it->box.high[k];
        }
        if (finite) {
            box_add(&all, &it->box);
            b->bvh->count++;
        }
    }
    double extent = 0.0;
    for (int k = 0; k < 3; k++) {
        b->bvh->low[k] = b->bvh->count > 0 ? all.low[k] : 0.0;
        b->bvh->high[k] = b->bvh->count > 0 ? all.high[k] : 0.0;
        extent = greater(extent, b->bvh->high[k] - b->bvh->low[k]);
    }
    b->bvh->scale = extent > 0.0 && 1.0 / extent < HUGE_VAL ? 1.0 / extent : 1.0;
}

static void take_triangles(const builder *b)
{
    for (int32_t i = 0; i < b->bvh->count; i++) {
        sl_bvh_triangle *t = &b->bvh->triangle[i];
        t->number = b->item[i].triangle;
        for (int k = 0; k < 3; k++) {
            const double *p = b->xyz + 3 * (int64_t)b->tri[3 * (int64_t)t->number + k];
            for (int a = 0; a < 3; a++) {
                t->corner[k][a] = p[a];
            }
        }
    }
}

sl_status sl_bvh_create(const double *xyz, int32_t nt, const int32_t *tri, sl_bvh **out)
{
    SL_ASSERT(nt >= 0);
    sl_status status = SL_OK;
    builder b = {.xyz = xyz, .tri = tri};
    *out = NULL;
    if (nt >= 1 << (31 - SL_BVH_LEAF_BITS)) {
        return SL_OUT_OF_MEMORY;
    }
    b.bvh = sl_calloc(1, sizeof *b.bvh);
    b.item = sl_alloc(nt, sizeof *b.item);
    SL_TRY(b.bvh != NULL && b.item != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    list_items(&b, nt);
    SL_TRY(build_nodes(&b));
    b.bvh->triangle = sl_alloc(b.bvh->count, sizeof *b.bvh->triangle);
    SL_TRY(b.bvh->triangle != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    take_triangles(&b);
    *out = b.bvh;
    b.bvh = NULL;
cleanup:
    sl_bvh_free(b.bvh);
    sl_free(b.item);
    return status;
}

void sl_bvh_free(sl_bvh *bvh)
{
    if (bvh == NULL) {
        return;
    }
    sl_free(bvh->node);
    sl_free(bvh->triangle);
    sl_free(bvh);
}
