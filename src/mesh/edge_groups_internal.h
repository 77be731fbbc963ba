/* Halfedges grouped by their undirected edge: a bucket per smaller vertex, each bucket sorted.
 * Layer: mesh, private. */
#ifndef SL_MESH_EDGE_GROUPS_INTERNAL_H
#define SL_MESH_EDGE_GROUPS_INTERNAL_H

#include "base/status.h"

typedef struct sl_edge_groups {
    int32_t nv;
    int32_t *first; /* nv + 1: the bucket of smaller vertex v is key[first[v] .. first[v + 1] - 1] */
    uint64_t *key;  /* larger vertex << 32 | halfedge, ascending inside a bucket */
} sl_edge_groups;

/* One edge: count halfedges, ascending; halfedge i is sl_edge_group_halfedge(group, i). */
typedef struct sl_edge_group {
    const uint64_t *key;
    int32_t count;
} sl_edge_group;

/* Where an iteration stands; zero-initialise. */
typedef struct sl_edge_cursor {
    int32_t vertex, position;
} sl_edge_cursor;

/* Groups the halfedges h in [0, nh) with from[h] >= 0 that run from[h] -> to[h]; vertices in [0, nv).
 * SL_OUT_OF_MEMORY. O(nv + nh + sum of k log k over the buckets). */
SL_NODISCARD sl_status sl_edge_groups_init(int32_t nv, int32_t nh, const int32_t *from, const int32_t *to,
                                           sl_edge_groups *out);

void sl_edge_groups_clear(sl_edge_groups *groups);

/* The next edge, ordered by (smaller, larger) vertex; false at the end. */
bool sl_edge_groups_next(const sl_edge_groups *groups, sl_edge_cursor *cursor, sl_edge_group *group);

static inline int32_t sl_edge_group_halfedge(const sl_edge_group *group, int32_t i)
{
    return (int32_t)(group->key[i] & 0xffffffffu);
}

#endif
