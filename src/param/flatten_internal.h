/* Flat patches: the shortest way into the plane.
 * Layer: param; private to it and to its tests. */
#ifndef SL_PARAM_FLATTEN_INTERNAL_H
#define SL_PARAM_FLATTEN_INTERNAL_H

#include "mesh/patch.h"
#include "overlap/certificate.h"
#include "param/abf.h"
#include "param/constraints_internal.h"
#include "param/stretch.h"

/* True when every vertex is within a rounding-sized share (1e-12) of the patch's extent from one plane; uv (nv x 2) is
 * then the orthogonal projection along the patch's vector area, counter-clockwise where the patch is. False when the
 * vector area vanishes. */
bool sl_flatten_project(const sl_patch *patch, double *uv);

/* True when all triangles come from one facet of the mesh. */
bool sl_flatten_is_one_facet(const sl_patch *patch);

/* Scales uv about the origin to the patch's 3D area; nothing is done where either area vanishes or the scale is 1 to
 * rounding. */
void sl_flatten_scale(const sl_patch *patch, double *uv);

/* sl_certify_embedding, and for a chart of one loop that meets itself along its border without turning over anywhere
 * (the two banks of a cut through a flat ring, the faces of an unfolded box: rounding decides whether they touch or
 * cross) a second try with its border moved inwards by 2^-13 of the shorter edge at each vertex. uv becomes the opened
 * map where that one is embedded, and stays so when rounded to 2^-34 of its extent, and uv was not. */
SL_NODISCARD sl_status sl_flatten_certify(const sl_patch *patch, int32_t nb, const int32_t *border, double *uv,
                                          sl_certificate *out);

/* *l2 = the stretch of ABF++'s map of a coarse mesh of the chart; 1 where there is nothing to say: small charts, those
 * that cannot be made coarser, no convergence, flips. SL_OUT_OF_MEMORY, SL_CANCELLED. */
SL_NODISCARD sl_status sl_flatten_foresee(const sl_patch *patch, const sl_abf_def *def, const sl_context *context,
                                          double *l2);

/* The lines of a list of constraints for the stretch minimiser, and the two border edges at a prescribed angle as lines
 * of their own where they are on none. Zero-initialised = empty. */
typedef struct sl_flatten_lines {
    sl_line_set set;
    int32_t count;
    sl_stretch_line *line;
    int32_t *edge; /* vertices of the lines that are not of the set, three each */
} sl_flatten_lines;

/* uv tells which edges run straight on. Statuses as of sl_constraints_compile. */
SL_NODISCARD sl_status sl_flatten_lines_init(const sl_patch *patch, int32_t count, const sl_constraint *list,
                                             const double *uv, sl_flatten_lines *out);
void sl_flatten_lines_clear(sl_flatten_lines *lines);

#endif
