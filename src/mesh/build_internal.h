/* The builder's stages, in their order. The mesh starts as the input's polygons with input vertex numbers in `origin`.
 * Layer: mesh, private. */
#ifndef SL_MESH_BUILD_INTERNAL_H
#define SL_MESH_BUILD_INTERNAL_H

#include "mesh/build.h"

typedef struct sl_builder {
    const sl_polygons *input;
    sl_mesh *mesh;
    sl_repair_report *report;
    int64_t nonmanifold_capacity; /* of report->nonmanifold */
    int32_t *joint;               /* 2 x joints: halfedges on one edge of the input that the repair cut apart */
    int64_t joints, joint_capacity;
    int64_t surface_vertices; /* fans of facets that are not isolated */
} sl_builder;

/* Are the polygons usable at all? SL_BAD_INPUT with diag. */
SL_NODISCARD sl_status sl_build_check(const sl_polygons *polygons, sl_diag *diag);

/* Fills xyz (input vertices), centre, scale; counts unused vertices. */
SL_NODISCARD sl_status sl_build_normalise(sl_builder *builder);

/* Flags degenerate and duplicate facets. */
SL_NODISCARD sl_status sl_build_flag_degenerate(sl_builder *builder);
SL_NODISCARD sl_status sl_build_flag_duplicate(sl_builder *builder);

/* twin[h] = the one other halfedge on h's edge, whatever its direction; -1 at borders and non-manifold edges. */
SL_NODISCARD sl_status sl_build_match_edges(sl_builder *builder);

/* Orients each component, cuts one-sided ones, reverses facets; from here on twin is an involution of opposites. */
SL_NODISCARD sl_status sl_build_orient(sl_builder *builder);

/* One vertex per fan; lists the bowties. */
SL_NODISCARD sl_status sl_build_split_vertices(sl_builder *builder);

/* Border loops, genus, counts by degree, the lists of facets. */
SL_NODISCARD sl_status sl_build_summarise(sl_builder *builder);

/* Remembers that the input joined halfedges a and b. */
SL_NODISCARD sl_status sl_build_add_joint(sl_builder *builder, int32_t a, int32_t b);

static inline bool sl_build_isolated(const sl_mesh *mesh, int32_t f)
{
    return (mesh->face_flags[f] & (SL_FACE_DUPLICATE | SL_FACE_DEGENERATE)) != 0;
}

#endif
