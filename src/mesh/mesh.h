/* Polygon halfedge mesh. A halfedge is a corner: halfedge h of facet f starts at corner h's vertex and runs to the next
 * corner's vertex, so the arrays of a facet lie side by side and next/prev need no storage.
 * Layer: mesh (may include geom, graph, base).
 *
 *     facet f owns halfedges face_first[f] .. face_first[f + 1] - 1, in the facet's orientation after repair
 *     twin[h]  the opposite halfedge, -1 at a border (of the surface, or of a chart)
 *     sew[h]   where a seam was cut: the opposite across the seam (the paper's sewing pointer, Sec. 4.2); else -1
 *
 * Invariants: twin is an involution without fixed points between halfedges of opposite direction; at most one of
 * twin[h], sew[h] is >= 0; the facets around a vertex form one fan over twin and sew together (bowties are split). */
#ifndef SL_MESH_MESH_H
#define SL_MESH_MESH_H

#include "base/status.h"

/* What the builder did to a facet: bits of sl_mesh.face_flags. */
enum {
    SL_FACE_REVERSED = 1,   /* its corners run against the input's order */
    SL_FACE_DUPLICATE = 2,  /* same vertices as an earlier facet: isolated (no twins) */
    SL_FACE_DEGENERATE = 4, /* zero area, or a repeated vertex: isolated (no twins) */
};

typedef struct sl_mesh {
    int32_t nv, nf, nh;
    double *xyz;           /* nv x 3, normalised: (input - centre) * scale, largest extent in (1/2, 1] (0: one point) */
    int32_t *face_first;   /* nf + 1 */
    int32_t *origin;       /* nh: vertex a halfedge starts at */
    int32_t *face;         /* nh: facet of a halfedge */
    int32_t *twin;         /* nh */
    int32_t *sew;          /* nh */
    int32_t *input_vertex; /* nv: vertex of the input (several mesh vertices share one where a bowtie was split) */
    uint8_t *face_flags;   /* nf */
    double centre[3];      /* centre of the bounding box of the input's used vertices, in input units */
    double scale;          /* a power of two */
} sl_mesh;

/* Deep copy; for trying cuts. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_mesh_copy(const sl_mesh *mesh, sl_mesh **out);

void sl_mesh_free(sl_mesh *mesh); /* NULL is a no-op */

static inline int32_t sl_next(const sl_mesh *m, int32_t h)
{
    return h + 1 < m->face_first[m->face[h] + 1] ? h + 1 : m->face_first[m->face[h]];
}

static inline int32_t sl_prev(const sl_mesh *m, int32_t h)
{
    return h > m->face_first[m->face[h]] ? h - 1 : m->face_first[m->face[h] + 1] - 1;
}

/* Vertex a halfedge runs to. */
static inline int32_t sl_target(const sl_mesh *m, int32_t h)
{
    return m->origin[sl_next(m, h)];
}

static inline int32_t sl_degree(const sl_mesh *m, int32_t f)
{
    return m->face_first[f + 1] - m->face_first[f];
}

/* The opposite halfedge, seam or not; -1 only at a border of the surface itself. */
static inline int32_t sl_opposite(const sl_mesh *m, int32_t h)
{
    return m->twin[h] >= 0 ? m->twin[h] : m->sew[h];
}

/* Position of halfedge h's corner in the input's corner numbering (corner k of input facet f is face_first[f] + k). */
static inline int32_t sl_input_corner(const sl_mesh *m, int32_t h)
{
    const int32_t f = m->face[h], first = m->face_first[f];
    return (m->face_flags[f] & SL_FACE_REVERSED) != 0 ? first + (sl_degree(m, f) - (h - first)) % sl_degree(m, f) : h;
}

/* Cuts the edge of h: twin pointers become sewing pointers. No-op at a border. O(1). */
void sl_mesh_cut_edge(sl_mesh *mesh, int32_t h);

/* Sews it again. No-op where there is no sewing pointer. O(1). */
void sl_mesh_sew_edge(sl_mesh *mesh, int32_t h);

/* Area of facet f of the normalised mesh (half the norm of its vector area). */
double sl_mesh_face_area(const sl_mesh *mesh, int32_t f);

/* Vector area (unnormalised normal, length = area) of facet f into n[3]. */
void sl_mesh_face_vector_area(const sl_mesh *mesh, int32_t f, double n[3]);

/* Mean of the corners of facet f into c[3]. */
void sl_mesh_face_centroid(const sl_mesh *mesh, int32_t f, double c[3]);

/* Length of halfedge h in the normalised mesh. */
double sl_mesh_edge_length(const sl_mesh *mesh, int32_t h);

/* Diagonal of the bounding box in the normalised mesh. */
double sl_mesh_diagonal(const sl_mesh *mesh);

#endif
