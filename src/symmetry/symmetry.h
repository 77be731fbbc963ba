/* Symmetries of a mesh: automorphisms of its halfedge structure, and what the geometry says of them.
 * Layer: symmetry (may include mesh, geom, graph, base).
 *
 * Only twin pointers count: seams that are cut are borders. A map sends facets to facets, edges to edges and corners to
 * corners: corner h (of facet face[h], at vertex origin[h]) goes to corner image[h] of the image facet, at the image
 * vertex. Where the map keeps the orientation, next goes to next; where it reverses it, next to prev, and the edge of
 * halfedge h goes to that of prev(image[h]).
 */
#ifndef SL_SYMMETRY_SYMMETRY_H
#define SL_SYMMETRY_SYMMETRY_H

#include "base/context.h"
#include "mesh/mesh.h"

/* At most this many automorphisms are listed for one component. */
#define SL_SYMMETRY_MOST 64

/* How far the geometry follows a map of the connectivity. */
typedef enum sl_symmetry_kind {
    SL_SYMMETRY_EXACT,      /* deviation within def.exact, misfit within def.lengths: edge lengths alone would let a
                               surface bend, and relative ones ask for more digits than a text file keeps */
    SL_SYMMETRY_NEAR,       /* an isometry of space carries the corners onto their images within def.near */
    SL_SYMMETRY_TOPOLOGICAL /* neither: reported, never used for sharing */
} sl_symmetry_kind;

/* One component onto itself, or onto another. */
typedef struct sl_symmetry_map {
    int32_t from, to; /* components */
    int32_t count;    /* facets of either */
    int32_t corners;  /* corners of the facets of `from` */
    int32_t *corner;  /* image of each corner of the facets of `from`, facet by facet as in sl_symmetry.face */
    int32_t *facet;   /* image of each facet of `from`, a bijection */
    bool reverses;    /* the orientation: a mirror image */
    int32_t order;    /* smallest k > 0 with map^k = identity (pairs taken as one facet); 0 for a copy (from != to) */
    sl_symmetry_kind kind;
    double misfit; /* largest difference of corresponding edge lengths, over the longer of the two (at least 1e-6 of the
                      diagonal); where the deviation bounds it by 1e-6 of def.lengths, that bound */
    double deviation;    /* largest distance of a moved corner to its image, over the component's diagonal */
    double isometry[12]; /* 3 x 4, row-major: the rigid motion (with a reflection where det < 0) that fits best */
    /* of an involution (order 2) */
    int32_t fixed_facets; /* facets that are their own images */
    int32_t axis_edges;   /* edges between a facet and its image, one an edge */
    double axis_length;   /* of the cut that takes the halves (fixed facets with the first) apart; 0 without halves */
    bool
        separates; /* removing axis edges and fixed facets leaves two sets that the map exchanges: usable for sharing */
} sl_symmetry_map;

typedef struct sl_symmetry {
    int32_t components;
    int32_t *first;        /* components + 1: into face */
    int32_t *face;         /* nf: facets grouped by component, ascending in each */
    int32_t *component;    /* nf */
    int32_t *place;        /* nf: where a facet stands in face; map->facet is indexed by place[f] - first[component] */
    int32_t *corner_first; /* nf: where the corners of a facet begin in map->corner */
    int32_t *unit;         /* nf: the facet itself, or the lower of its pair */
    int32_t *original;     /* components: the first component (by first facet) that this one is a copy of; itself if
                              none. Copies are exact. */
    int32_t nmap;
    sl_symmetry_map *map; /* automorphisms but the identity, by component, mirrors first; then copies original ->
                             component */
    bool truncated;       /* some component may have more automorphisms than are listed */
} sl_symmetry;

typedef struct sl_symmetry_def {
    double exact;      /* deviation over the diagonal; edge lengths then agree within twice that; default 1e-6 */
    double lengths;    /* relative difference of edge lengths; default 1e-3, which no distortion shows. Suzanne, written
                          with six digits, has a deviation of 1.7e-7 and a misfit of 3e-5 */
    double near;       /* deviation over the diagonal; default 1e-2 */
    bool mirrors_only; /* involutions that separate, and copies, only; default false */
    bool of_copies;    /* also the automorphisms of copies: those of the original, moved; default false */
    int32_t most;      /* maps a component; default SL_SYMMETRY_MOST */
    int64_t corners;   /* in all automorphisms together, about, though a component may have four; default 2^23: the 64
                          of one of 43,000 triangles */
} sl_symmetry_def;

sl_symmetry_def sl_symmetry_default(void);

/* All of it. partner (nullable): facets paired as sl_pair_triangles does; a pair is then one quad, whichever way its
 * diagonal runs: its corners go to corners of the image pair at the image vertices (of the image facet if that has
 * the vertex, else of its partner). Where the diagonal goes to the diagonal, triangles go to triangles at the same
 * vertices; where the two cross, to those that share an axis edge, else the lower number to the lower.
 *
 * Facets are coloured by refinement first; from a halfedge of the rarest colour all of that colour are tried in both
 * orientations, the ones whose geometry fits on the first facets before the others, and every walk ends at the first
 * mismatch. Near linear: where regularity would cost more than a fixed multiple of the corners, the search stops:
 * truncated. Of a component of more exact maps than may be listed, three mirrors are taken first, at angles
 * as large as can be, the rotation of the smallest angle, which together generate the rest in a solid of revolution,
 * then the other mirrors; what is not listed is found by sl_symmetry_traverse. Exact maps stand before others, mirrors
 * before rotations. SL_OUT_OF_MEMORY, SL_CANCELLED. Deterministic.
 * Source: paper, Sec. 4.3 (the walk); Weisfeiler & Leman 1968 (refinement). */
SL_NODISCARD sl_status sl_symmetry_find(const sl_mesh *mesh, const int32_t *partner, const sl_symmetry_def *def,
                                        const sl_context *context, sl_symmetry **out);
void sl_symmetry_free(sl_symmetry *symmetry); /* NULL is a no-op */

/* The isomorphism of the component of corner a onto that of b that sends a to b, if there is one; image: nh corners, -1
 * outside the component of a (and everywhere when *found is false). Linear in the mesh: both are walked at once
 * (paper, Sec. 4.3). SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_symmetry_traverse(const sl_mesh *mesh, int32_t a, int32_t b, bool reverses, int32_t *image,
                                            bool *found);

/* The two sides of an involution that separates: side[f] = 1 for one half and the fixed facets (with the facet of
 * lowest number that is not fixed), 0 for the other, 2 for other components. side: nf. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_symmetry_sides(const sl_mesh *mesh, const sl_symmetry *symmetry, const sl_symmetry_map *map,
                                         uint8_t *side);

/* Image facet of facet f of component map->from. */
int32_t sl_symmetry_image(const sl_mesh *mesh, const sl_symmetry *symmetry, const sl_symmetry_map *map, int32_t f);

/* Image corner of corner h of a facet of component map->from. */
int32_t sl_symmetry_image_corner(const sl_mesh *mesh, const sl_symmetry *symmetry, const sl_symmetry_map *map,
                                 int32_t h);

/* Does an involution exchange the facets (pairs taken as one) on both sides of the edge of halfedge h? */
bool sl_symmetry_on_axis(const sl_mesh *mesh, const sl_symmetry *symmetry, const sl_symmetry_map *map, int32_t h);

/* Near symmetry where the connectivity has none: the mirror plane that carries the surface best onto itself
 * (candidates: the principal axes of area, then refined), by matching vertices to the nearest point of the mirrored
 * surface. */
typedef struct sl_near_mirror {
    bool found;
    double normal[3], offset;       /* plane: normal . x = offset, in the normalised mesh */
    double misfit_mean, misfit_max; /* distances of mirrored vertices to the surface, over the diagonal */
    double matched;                 /* share of the vertices within def.near */
} sl_near_mirror;

/* found: at least 90 % of the area is within def->near. match (nullable, nf): the facet nearest to the mirrored
 * centroid of each facet. SL_OUT_OF_MEMORY. O(n log n). */
SL_NODISCARD sl_status sl_symmetry_near(const sl_mesh *mesh, const sl_symmetry_def *def, const sl_context *context,
                                        int32_t *match, sl_near_mirror *out);

#endif
