/* The tree's nodes.
 * Layer: geom (private). */
#ifndef SL_GEOM_BVH_INTERNAL_H
#define SL_GEOM_BVH_INTERNAL_H

#include "geom/bvh.h"

enum {
    SL_BVH_WIDTH = 4,     /* children of a node */
    SL_BVH_LEAF = 4,      /* triangles of a leaf at most */
    SL_BVH_LEAF_BITS = 3, /* a child < 0 is ~(first << bits | triangles) */
    SL_BVH_DEPTH = 96     /* levels of nodes at most */
};

/* Boxes of four children, in coordinates of the whole tree's box, each a little larger than it needs to be; an empty
 * child's box is inside out. */
typedef struct sl_bvh_node {
    float low[3][SL_BVH_WIDTH], high[3][SL_BVH_WIDTH];
    int32_t child[SL_BVH_WIDTH];
} sl_bvh_node;

typedef struct sl_bvh_triangle {
    double corner[3][3];
    int32_t number;
} sl_bvh_triangle;

struct sl_bvh {
    int32_t nodes, count;
    sl_bvh_node *node;         /* the first is the root */
    sl_bvh_triangle *triangle; /* count, leaf by leaf */
    double low[3], high[3];    /* of all */
    double scale;              /* node coordinate = scale * (coordinate - low) */
};

#endif
