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

/* The computation of a frame line by line: equation, C function, value. */
void abf_report_steps(sl_writer *w, const abf_trace *trace, int32_t frame);

/* The class of a residual, "q0" to "q12": 1e-12 and less to 1. */
enum { ABF_RESIDUAL_CLASSES = 13 };
int32_t abf_residual_class(double residual);

/* The style sheet of all these, for light and dark pages. */
void abf_svg_style(sl_writer *w);

#endif
