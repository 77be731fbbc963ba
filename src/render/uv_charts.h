/* The charts that UVs make.
 * Layer: render. */
#ifndef SL_RENDER_UV_CHARTS_H
#define SL_RENDER_UV_CHARTS_H

#include "mesh/mesh.h"

/* chart[f]: facets joined over edges on both sides of which the UVs are the same, numbered by first facet; -1 where a
 * corner has no finite UV. corner_uv: 2 a halfedge; chart: nf. *count of them. SL_OUT_OF_MEMORY. O(corners). */
SL_NODISCARD sl_status sl_uv_charts(const sl_mesh *mesh, const double *corner_uv, int32_t *chart, int32_t *count);

#endif
