/* The triangles of a mesh's UVs, welded, those left out that lie on others by intent.
 * Layer: atlas. */
#ifndef SL_ATLAS_UV_TRIANGLES_H
#define SL_ATLAS_UV_TRIANGLES_H

#include "atlas/measure.h"

/* What overlap tests take. */
typedef struct sl_uv_triangles {
    int32_t nv, nt;
    double *uv;           /* nv x 2, distinct */
    int32_t *tri;         /* 3 nt */
    int32_t *face;        /* nt: the polygon each comes from */
    int32_t shared_faces; /* polygons left out: their corners are, one for one, those of the polygon they copy */
    double low[2], side;  /* the window that overlap is counted in: the unit square, or, where UVs leave it, their
                             bounding square */
} sl_uv_triangles;

/* polygons, corner_uv: as sl_measure_atlas takes them, cut into triangles as there. table: nullable; a polygon of a
 * chart that copies another is left out when it has exactly the corners of one of that chart's polygons; each of those
 * can be copied once by each chart. What differs in a bit takes part, whatever the table says. SL_BAD_INPUT (a corner
 * without a finite UV: diag names the facet), SL_OUT_OF_MEMORY. Freed by sl_uv_triangles_clear, also after failure. */
SL_NODISCARD sl_status sl_uv_triangles_init(const sl_polygons *polygons, const double *corner_uv,
                                            const sl_sharing_table *table, sl_uv_triangles *out, sl_diag *diag);

/* The window mapped to the unit square; window_uv: 2 nv. Never overflows. */
void sl_uv_triangles_window(const sl_uv_triangles *triangles, double *window_uv);

void sl_uv_triangles_clear(sl_uv_triangles *triangles);

#endif
