/* Drawings of `seamlab abf --report`, as SVG inside the page.
 * Layer: cli. */
#ifndef SL_CLI_ABF_SVG_H
#define SL_CLI_ABF_SVG_H

#include "base/file.h"
#include "cli/abf_trace.h"

/* The layout of a frame: triangles coloured by |g1|, vertices by their worst |g2| or |g3|, constrained lines blue,
 * prescribed vertices yellow; with the angles in degrees written into the corners of small charts, in tooltips of
 * others. */
void abf_svg_chart(sl_writer *w, const abf_trace *trace, const abf_frame *frame);

/* |grad| and the residuals over the iterations, by decades. */
void abf_svg_convergence(sl_writer *w, const abf_trace *trace);

/* Energy and smallest angle over the iterations. */
void abf_svg_progress(sl_writer *w, const abf_trace *trace);

/* Where a matrix has entries: blue positive, red negative. */
void abf_svg_matrix(sl_writer *w, const char *name, const sl_csc *A, bool symmetric);

/* The colour of a residual, as in abf_svg_chart: "rgb(r,g,b)". */
void abf_residual_color(double residual, char text[32]);

#endif
