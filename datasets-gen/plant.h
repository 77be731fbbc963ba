/* Planting ground truth: the maps of a symmetry that the generator knows its mesh to have.
 * Layer: datasets-gen. */
#ifndef SL_GENERATORS_PLANT_H
#define SL_GENERATORS_PLANT_H

#include "generators.h"

/* A vertex lies at its image when it is nearer than this share of the mesh's extent. */
extern const double gen_plant_tolerance;

/* Of the 3 x 3 part of a 3 x 4 matrix. */
double gen_determinant(const double matrix[12]);

/* Appends the symmetry x -> M x + t (matrix: 3 x 4, row-major, M | t) to mesh->planted, with the image of each vertex
 * and facet; facets go to facets of the same cyclic order, reversed where det M < 0. SL_OUT_OF_MEMORY; SL_INTERNAL when
 * some vertex or facet has no image, two have the same, or the map is the identity: a bug of the generator (the mesh is
 * then as before). O(n log n).
 *
 * exact says of the mesh handed over in the end whether its positions have the symmetry. For perturbed positions plant
 * before they are moved, with exact = false. */
SL_NODISCARD sl_status gen_plant(sl_generated *mesh, const char *name, const double matrix[12], bool exact);

/* The mirror in the plane through the origin square to (a, b, c), which need not have length 1. */
SL_NODISCARD sl_status gen_plant_mirror(sl_generated *mesh, const char *name, double a, double b, double c, bool exact);

/* The dihedral group of order 2 n that turns about axis (0 = x, 1 = y, 2 = z) through the origin: the rotation by
 * 2 pi / n, then mirrors in planes through the axis, the first at `angle` to the next axis in cyclic order (x: y, y: z,
 * z: x), the others each by pi / n on. At most gen_most_mirrors of them; past that only the first two, which with the
 * rotation generate the others, and mesh->more_mirrors is set. n >= 2. As gen_plant. */
SL_NODISCARD sl_status gen_plant_dihedral(sl_generated *mesh, int axis, int32_t n, double angle, bool exact);

enum { gen_most_mirrors = 12 };

/* The rotation by `angle` about the line through the origin along `axis` (any length but 0). */
SL_NODISCARD sl_status gen_plant_rotation(sl_generated *mesh, const char *name, const double axis[3], double angle,
                                          bool exact);

/* Mirrors in the planes x = 0, y = 0, z = 0, those whose letter stands in `axes` ("xz"). */
SL_NODISCARD sl_status gen_plant_mirrors(sl_generated *mesh, const char *axes, bool exact);

/* The symmetries of a square prism about z (5 mirrors, a quarter turn), and of a cube (9 mirrors, a quarter turn, a
 * third of a turn about a diagonal), their middle at the origin. */
SL_NODISCARD sl_status gen_plant_prism(sl_generated *mesh, bool exact);
SL_NODISCARD sl_status gen_plant_cube(sl_generated *mesh, bool exact);

/* Says that the mirrored surface lies close to the surface, though no map of vertices and facets does it. */
SL_NODISCARD sl_status gen_plant_near(sl_generated *mesh, const char *name, const double matrix[12]);

/* Takes all planted symmetries out again: positions have been moved. */
void gen_forget(sl_generated *mesh);

/* A generator's end: frees *out and makes it NULL when planting failed. */
SL_NODISCARD sl_status gen_planted(sl_status status, sl_generated **out);

#endif
