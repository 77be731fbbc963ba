/* A proof that a chart does not overlap itself: a disk whose triangles all keep one orientation and whose border is a
 * simple polygon is embedded.
 * Layer: overlap. */
#ifndef SL_OVERLAP_CERTIFICATE_H
#define SL_OVERLAP_CERTIFICATE_H

#include "base/context.h"

enum { SL_CERTIFICATE_MAX_CROSSINGS = 1000 }; /* counting stops here */

typedef struct sl_certificate {
    bool embedded;      /* no triangle flipped or degenerate, and no border crossing */
    int32_t flipped;    /* triangles of negative area, by exact predicate */
    int32_t degenerate; /* triangles of exactly zero area */
    int32_t
        border_crossings; /* pairs of border edges that cross, overlap or touch; at most SL_CERTIFICATE_MAX_CROSSINGS */
    int32_t first_edge[2]; /* border entries of the first such pair in lexicographic order, -1 = none */
} sl_certificate;

/* uv: nv x 2; tri: 3 nt; the border of the chart as nb vertex pairs border[2 b], border[2 b + 1]. The chart must be a
 * disk for `embedded` to be a proof. Edges that share a vertex (by index, not by position) may touch there and must not
 * overlap; all others must have no common point. Hashed uniform grid over the border edges, as wide as their mean
 * length; exact predicates. *out is unchanged on failure. SL_BAD_INPUT (UV not finite), SL_OUT_OF_MEMORY. Near linear
 * unless very many edges crowd one cell. Source: Lipman 2014, "Bijective mappings of meshes with boundary and the
 * degree in mesh processing". */
SL_NODISCARD sl_status sl_certify_embedding(const double *uv, int32_t nt, const int32_t *tri, int32_t nb,
                                            const int32_t *border, sl_certificate *out);

#endif
