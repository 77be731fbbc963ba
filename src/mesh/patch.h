/* A chart taken out of the mesh for flattening: triangles with vertices of their own, unglued along every seam.
 * Layer: mesh. */
#ifndef SL_MESH_PATCH_H
#define SL_MESH_PATCH_H

#include "mesh/triangulate.h"

/* Corner c = 3 t + k of triangle t; halfedge c runs from corner c to the next corner of t. All arrays are owned.
 * Parameterization sees nothing but this. */
typedef struct sl_patch {
    int32_t nv, nt;
    double *xyz;       /* nv x 3 */
    int32_t *tri;      /* 3 nt: vertex of a corner */
    int32_t *twin;     /* 3 nt: opposite halfedge inside the patch, -1 at its border */
    int32_t *corner;   /* 3 nt: mesh halfedge (polygon corner) of a corner */
    int32_t *facet;    /* nt: mesh facet of a triangle */
    int32_t *outgoing; /* nv: one halfedge leaving each vertex; at a border vertex the border halfedge itself */
    uint8_t *border;   /* nv: 1 on the border */
    int32_t loops;     /* border loops */
    int32_t euler;     /* nv - edges + nt */
} sl_patch;

static inline int32_t sl_corner_next(int32_t c)
{
    return c % 3 == 2 ? c - 2 : c + 1;
}

static inline int32_t sl_corner_prev(int32_t c)
{
    return c % 3 == 0 ? c + 2 : c - 1;
}

/* Is it one disk: connected, Euler characteristic 1, one border loop? (Connected is the caller's part.) */
static inline bool sl_patch_is_disk(const sl_patch *p)
{
    return p->euler == 1 && p->loops == 1;
}

/* The facets faces[0 .. nfaces - 1], glued where twin pointers join two of them, one vertex per fan of triangles.
 * Vertices are numbered by first corner in face order. SL_OUT_OF_MEMORY. O(corners). */
SL_NODISCARD sl_status sl_patch_extract(const sl_mesh *mesh, const sl_triangulation *triangulation,
                                        const int32_t *faces, int32_t nfaces, sl_patch **out);

/* A patch straight from triangles (tests, tools): xyz nv x 3, tri 3 nt, consistently oriented and edge-manifold; a
 * vertex of several fans is split. corner[c] = c, facet[t] = t. SL_BAD_INPUT (an edge used twice in one direction, an
 * index out of range), SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_patch_from_triangles(int32_t nv, const double *xyz, int32_t nt, const int32_t *tri,
                                               sl_patch **out);

void sl_patch_free(sl_patch *patch); /* NULL is a no-op */

/* 3D area of triangle t. */
double sl_patch_triangle_area(const sl_patch *patch, int32_t t);

/* Border loops as runs of halfedges in order (each follows its predecessor along the border): loop l is
 * halfedge[first[l] .. first[l + 1] - 1]. *first (loops + 1) and *halfedge are owned by the caller (sl_free). */
SL_NODISCARD sl_status sl_patch_border(const sl_patch *patch, int32_t **first, int32_t **halfedge);

/* The border's edges, loop by loop, as sl_certify_embedding takes them: *count pairs of vertices, tail and head. *edge
 * is owned by the caller (sl_free). SL_OUT_OF_MEMORY: both are unchanged. */
SL_NODISCARD sl_status sl_patch_border_edges(const sl_patch *patch, int32_t *count, int32_t **edge);

#endif
