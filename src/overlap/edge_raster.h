/* How often each texel is covered, from the few edges at which the count changes.
 * Layer: overlap (may include geom, base). */
#ifndef SL_OVERLAP_EDGE_RASTER_H
#define SL_OVERLAP_EDGE_RASTER_H

#include "base/context.h"

/* The counts of sl_coverage_add, bit for bit, for a mesh whose UVs change: made once for the triangles, drawn again for
 * every new set of UVs. The count of a texel is a sum over directed edges, each adding +1 or -1 to everything on its
 * right; the two sides of an edge between triangles of one orientation cancel exactly, because the fill rule gives a
 * texel on the edge to one of them alone. What is left are borders and folds, found on the snapped positions. */
typedef struct sl_edge_raster sl_edge_raster; /* opaque: owns a copy of the triangles, their topology and the counts */

typedef struct sl_edge_raster_def {
    int32_t width, height; /* texels, 1 to 2^15; default 1024 */
    int32_t depth;         /* 8: bytes that saturate at 255, as a stencil buffer; 16: at 65535; default 16 */
    bool portable;         /* no vector kernels, wherever it runs: slower, same counts; default false */
} sl_edge_raster_def;

/* What the last drawing gave. Sums are exact, whatever the depth. */
typedef struct sl_edge_raster_info {
    int64_t covered, overlapping; /* texels hit at least once, at least twice */
    int32_t active_edges;         /* drawn */
    int32_t folded;               /* triangles against the orientation of most, or without area, once snapped */
    bool vector;                  /* vector kernels were used */
    bool far;                     /* UVs reached so far out that triangles were filled one by one */
} sl_edge_raster_info;

sl_edge_raster_def sl_edge_raster_default(void);

/* tri: 3 nt indices below nv, copied. Triangles share an edge where they share its two vertices by index. SL_BAD_INPUT
 * (a size or the depth out of range), SL_OUT_OF_MEMORY. *out is NULL on failure. O(nv + nt). */
SL_NODISCARD sl_status sl_edge_raster_create(int32_t nv, int32_t nt, const int32_t *tri, const sl_edge_raster_def *def,
                                             sl_edge_raster **out);

/* Counts for these UVs. uv: nv x 2, borrowed for the call. SL_BAD_INPUT (a vertex of a triangle not finite or beyond
 * |u| > 2^14; the counts stand), SL_OUT_OF_MEMORY (the counts have no meaning). The same bytes for any number of
 * threads and any processor. O(nv + nt + texels + texel rows that active edges cross). */
SL_NODISCARD sl_status sl_edge_raster_draw(sl_edge_raster *raster, const double *uv, const sl_context *context);

/* As sl_edge_raster_draw, when since the last drawing only the vertices moved[0 .. count - 1] have new UVs: only the
 * rows of their triangles are counted again. O(triangles around them + borders + folds + texels of those rows). */
SL_NODISCARD sl_status sl_edge_raster_move(sl_edge_raster *raster, const double *uv, int32_t count,
                                           const int32_t *moved, const sl_context *context);

sl_edge_raster_info sl_edge_raster_result(const sl_edge_raster *raster);

/* The counts, width * height, row-major, row 0 at v = 0; borrowed. NULL if the raster has the other depth. */
const uint8_t *sl_edge_raster_counts8(const sl_edge_raster *raster);
const uint16_t *sl_edge_raster_counts16(const sl_edge_raster *raster);

/* red[t] = 1 for each triangle that covers a texel hit at least twice, and how many. uv: those drawn last; red: nt.
 * Free when nothing overlaps. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_edge_raster_red_triangles(const sl_edge_raster *raster, const double *uv,
                                                    const sl_context *context, uint8_t *red, int32_t *count);

void sl_edge_raster_free(sl_edge_raster *raster); /* NULL is a no-op */

#endif
