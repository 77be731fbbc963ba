/* The theorem on meshes: the mirrors that sl_symmetry_find finds, one at a time, jointly where they commute.
 * Layer: theorem. */
#ifndef SL_THEOREM_MESHES_H
#define SL_THEOREM_MESHES_H

#include "mesh/mesh.h"
#include "symmetry/symmetry.h"
#include "theorem/theorem.h"

/* One involution of one component. */
typedef struct sl_theorem_mirror {
    int32_t map;       /* into sl_symmetry.map */
    int32_t component; /* of the mesh */
    int32_t facets;    /* of the component */
    int32_t partner;   /* map it was checked jointly with, -1 = none */
    bool commute;      /* partner >= 0: whether the two do */
    sl_symmetry_kind kind;
    bool mirror; /* reverses the orientation and separates */
    sl_theorem_result result;
} sl_theorem_mirror;

typedef struct sl_theorem_mesh {
    sl_symmetry *symmetry; /* owned */
    int32_t count;         /* involutions checked; 0: nothing to check */
    sl_theorem_mirror *mirror;
    int32_t left_out; /* involutions beyond the most asked for */
    sl_theorem_result total;
} sl_theorem_mesh;

/* Checks at most `most` involutions a component (mirrors that separate first) on the facet graph. partner (nullable):
 * triangles paired into quads. SL_OUT_OF_MEMORY, SL_CANCELLED, SL_INTERNAL. */
SL_NODISCARD sl_status sl_theorem_check_mesh(const sl_mesh *mesh, const int32_t *partner, int32_t most,
                                             const sl_theorem_def *def, const sl_context *context,
                                             sl_theorem_mesh **out);
void sl_theorem_mesh_free(sl_theorem_mesh *mesh); /* NULL is a no-op */

#endif
