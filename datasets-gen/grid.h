/* Surfaces put together from grids: sheets of quads over a unit square, welded where their vertices meet.
 * Layer: datasets-gen. */
#ifndef SL_GENERATORS_GRID_H
#define SL_GENERATORS_GRID_H

#include "builder.h"

/* Position of (u, v) in [0, 1]^2. data is borrowed. */
typedef void gen_surface_fn(const void *data, double u, double v, double p[3]);

/* base doubled with each further step of scale: four times the facets. */
int32_t gen_refined(int32_t base, int32_t scale);

/* m x n quads over the unit square, with (m + 1) (n + 1) vertices of their own; dp/du x dp/dv points outward. */
void gen_grid(gen_builder *b, int32_t m, int32_t n, gen_surface_fn *at, const void *data);

/* Makes one vertex of all those at one place (the first), drops vertices without a facet, repeated corners, and facets
 * that have fewer than three corners left. tolerance: a share of the extent. O(nv log nv). */
void gen_weld(gen_builder *b, double tolerance);

/* A copy of all facets of the mesh, moved: x -> M x + t (3 x 4, row-major), turned inside out where det M < 0. */
void gen_append(gen_builder *b, const sl_generated *mesh, const double matrix[12]);

extern const double gen_weld_tolerance;

#endif
