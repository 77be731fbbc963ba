/* Builds a halfedge mesh from any polygon soup and says what had to be repaired.
 * Layer: mesh. */
#ifndef SL_MESH_BUILD_H
#define SL_MESH_BUILD_H

#include "mesh/mesh.h"

/* Polygons as read: the corners of facet f are index[face_first[f] .. face_first[f + 1] - 1], 0-based. Borrowed. */
typedef struct sl_polygons {
    int32_t nv, nf;
    const double *xyz;         /* nv x 3, any magnitude */
    const int32_t *face_first; /* nf + 1, face_first[0] = 0 */
    const int32_t *index;      /* face_first[nf] vertex numbers in [0, nv) */
} sl_polygons;

/* What was found and done. Lists are owned by the report; element numbers are the input's. */
typedef struct sl_repair_report {
    int32_t vertices, faces, unused_vertices;
    int32_t components, border_loops; /* of the repaired surface, isolated facets left out */
    int32_t isolated_faces;           /* duplicate + degenerate */
    int64_t genus;                    /* sum over the components */
    int32_t nonmanifold_edges;        /* edges of three and more facets, cut */
    int32_t bowtie_vertices;          /* input vertices whose facets meet in the point only, split into fans */
    int32_t reversed_faces;           /* reoriented to agree with their component */
    int32_t one_sided_components;     /* not orientable: cut until they are */
    int32_t one_sided_cuts;           /* edges cut for that */
    int32_t duplicate_faces, degenerate_faces;
    int32_t triangles, quads, ngons;
    int32_t *reversed;    /* reversed_faces facet numbers, ascending */
    int32_t *duplicate;   /* duplicate_faces */
    int32_t *degenerate;  /* degenerate_faces */
    int32_t *bowtie;      /* bowtie_vertices input vertex numbers */
    int32_t *nonmanifold; /* 2 x nonmanifold_edges input vertex numbers */
} sl_repair_report;

/* Builds the mesh. Facets keep their order and their corners; vertices keep their order, copies made for bowties and
 * cut non-manifold edges follow after the input's.
 *
 *   non-manifold edge (3+ facets)   all its facets are cut apart along it
 *   bowtie vertex                   one vertex per fan
 *   inconsistent winding            facets reversed so that each component agrees with its largest-area part
 *   one-sided component             cut along the edges where a breadth-first orientation contradicts itself
 *   duplicate, degenerate facet     kept, but without neighbours
 *
 * A vertex at the end of a cut edge is split too, but is no bowtie when its fans hung together along such edges. An
 * isolated facet has vertices of its own wherever the surface uses the input's. Degenerate: a repeated corner, or a
 * vector area within rounding of 0; duplicate: the same set of corners as an earlier facet that is not isolated. Each
 * component keeps the winding that the larger part of its area has.
 *
 * Coordinates are normalised by a translation and a power of two, by the bounding box of the vertices that facets use;
 * unused vertices are moved to that box's surface where they lie outside. *out and *report are owned by the caller;
 * report may be NULL. SL_BAD_INPUT (not finite, an index out of range, a facet of fewer than 3 corners, no facet at
 * all: diag names the element), SL_OUT_OF_MEMORY. Deterministic. O(corners log corners). */
SL_NODISCARD sl_status sl_mesh_build(const sl_polygons *polygons, sl_mesh **out, sl_repair_report *report,
                                     sl_diag *diag);

void sl_repair_report_clear(sl_repair_report *report); /* frees the lists, zeroes the struct */

#endif
