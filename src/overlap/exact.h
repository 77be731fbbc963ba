/* Which triangles overlap in the plane, exactly.
 * Layer: overlap (may include geom, base). */
#ifndef SL_OVERLAP_EXACT_H
#define SL_OVERLAP_EXACT_H

#include "base/context.h"

typedef struct sl_exact_overlap {
    int32_t degenerate; /* triangles of exactly zero area: without an interior, they overlap nothing */
    int32_t first[2];   /* two triangles that overlap, -1 = none do */
    int32_t red;        /* triangles that overlap another; 0 or 2 where only the answer was asked for */
} sl_exact_overlap;

/* Triangles overlap where their interiors have a common point; touching in points and edges is allowed, whatever the
 * orientation, in the same chart or another. uv: nv x 2; tri: 3 nt. red: nt, 1 for each triangle that overlaps another;
 * NULL = only the answer, the search ends at the first pair.
 *
 * A sweep along x: the triangles on the sweep line stand in order of height in a balanced tree, each parted from its
 * neighbours by a line (sl_triangles_order). While that holds, no two of them overlap on the sweep line. A triangle
 * that overlaps a neighbour is taken out; what then remains is free of overlaps, and is compared with those taken out
 * by a tree of boxes. Exact for all finite coordinates that sl_orient2d takes; thin, nested, crowded triangles cost no
 * more than others. SL_BAD_INPUT (UV not finite), SL_OUT_OF_MEMORY. O(n log n) without overlaps. The same for any
 * number of threads. Source: Shamos, Hoey 1976, "Geometric intersection problems", for convex pieces in place of
 * segments. */
SL_NODISCARD sl_status sl_overlap_exact(const double *uv, int32_t nt, const int32_t *tri, const sl_context *context,
                                        uint8_t *red, sl_exact_overlap *out);

#endif
