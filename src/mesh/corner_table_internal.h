/* Fans and borders of any set of glued polygons, known by their corners alone.
 * Layer: mesh, private. */
#ifndef SL_MESH_CORNER_TABLE_INTERNAL_H
#define SL_MESH_CORNER_TABLE_INTERNAL_H

#include "mesh/mesh.h"

/* Borrowed arrays. face_first NULL = triangles, corner c = 3 t + k. */
typedef struct sl_corner_table {
    int32_t nf, nh;
    const int32_t *face_first; /* nf + 1 */
    const int32_t *face;       /* nh */
    const int32_t *twin;       /* nh, an involution between opposite directions; -1 at a border */
} sl_corner_table;

static inline int32_t sl_table_next(const sl_corner_table *t, int32_t h)
{
    if (t->face_first == NULL) {
        return h % 3 == 2 ? h - 2 : h + 1;
    }
    return h + 1 < t->face_first[t->face[h] + 1] ? h + 1 : t->face_first[t->face[h]];
}

static inline int32_t sl_table_prev(const sl_corner_table *t, int32_t h)
{
    if (t->face_first == NULL) {
        return h % 3 == 0 ? h + 2 : h - 1;
    }
    return h > t->face_first[t->face[h]] ? h - 1 : t->face_first[t->face[h] + 1] - 1;
}

/* The border halfedge that follows border halfedge h. */
static inline int32_t sl_table_border_next(const sl_corner_table *t, int32_t h)
{
    int32_t n = sl_table_next(t, h);
    while (t->twin[n] >= 0) {
        n = sl_table_next(t, t->twin[n]);
    }
    return n;
}

/* fan[h] = number of the fan of corner h, numbered by first corner; the number of fans is returned. O(nh). */
int32_t sl_table_label_fans(const sl_corner_table *table, int32_t *fan);

/* Number of border loops. seen: nh bytes of work; a border halfedge with seen != 0 on entry is not counted. O(nh). */
int32_t sl_table_count_loops(const sl_corner_table *table, uint8_t *seen);

#endif
