/* The icosahedron subdivided on the sphere.
 * Layer: datasets-gen. */
#ifndef SL_GENERATORS_ICOSPHERE_H
#define SL_GENERATORS_ICOSPHERE_H

#include "builder.h"

/* Each of the 20 triangles split into n x n, vertices on the unit sphere, outward. The builder must be empty. */
void gen_icosphere_into(gen_builder *b, int32_t n);

/* The 15 mirrors of an icosahedron and a turn about a corner and one about a face, which generate all 120. */
SL_NODISCARD sl_status gen_plant_icosahedral(sl_generated *mesh, bool exact);

#endif
