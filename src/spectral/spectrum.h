/* Eigenvectors of the facet graph and the cuts they propose. Paper, Sec. 3.3.
 * Layer: spectral (may include mesh, eigen, sparse, graph, geom, base). */
#ifndef SL_SPECTRAL_SPECTRUM_H
#define SL_SPECTRAL_SPECTRUM_H

#include "base/context.h"
#include "eigen/band.h"
#include "eigen/lanczos.h"
#include "mesh/facet_graph.h"

/* Lower triangle of D - A of a graph (the paper's L = A - D with its sign turned, errata 2); parallel edges count as
 * often as they occur. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_laplacian_create(const sl_graph *graph, sl_csc **out);

typedef struct sl_spectrum_def {
    int32_t count;        /* pairs wanted, the null space included; clipped to n; default 30 */
    sl_lanczos_mode mode; /* how precise; default SL_LANCZOS_TOLERANCE */
    double tolerance;     /* ||L v - lambda v|| <= tolerance ||L||_1; [1e-14, 1); default 1e-8 */
    bool bands; /* band by band along the spectrum, for hundreds of pairs: to the tolerance, whatever the mode;
                   default false. Source: Vallet, Levy 2008 */
    int64_t memory_limit; /* bytes of Laplacian, results and solver together; 0 = none; default 0 */
    const int32_t *rank;  /* n: places in an order of elimination of a larger graph that this one is a part of, >= 0,
                             inherited instead of ordering anew; borrowed; default NULL */
} sl_spectrum_def;

sl_spectrum_def sl_spectrum_default(void);

typedef struct sl_spectrum {
    int32_t n, count;     /* nodes; pairs */
    double *lambda;       /* count, ascending, the first is 0 */
    double *vectors;      /* n x count, column-major */
    double *residual;     /* count */
    int32_t *perm;        /* n: the order of elimination used, for parts to inherit; NULL where nothing was factored */
    sl_lanczos_info info; /* of bands: what a sl_band_info tells as well, block and patch 0 */
    sl_band_info bands;   /* bands = 0 unless asked for */
    int64_t memory;       /* bytes estimated before allocating: Laplacian, results, solver */
} sl_spectrum;

/* The smallest pairs of a facet graph's Laplacian as def asks for them (NULL = the default). Indicators of components
 * are deflated as known null space. SL_BAD_INPUT (a tolerance or rank out of range), SL_LIMIT (memory_limit),
 * SL_OUT_OF_MEMORY, SL_CANCELLED, SL_INTERNAL. */
SL_NODISCARD sl_status sl_spectrum_solve(const sl_facet_graph *graph, const sl_spectrum_def *def,
                                         const sl_context *context, sl_spectrum **out);

/* The `count` smallest pairs of a facet graph's Laplacian (clipped to n). Indicators of components are deflated as
 * known null space. SL_OUT_OF_MEMORY, SL_CANCELLED, SL_INTERNAL. */
SL_NODISCARD sl_status sl_spectrum_compute(const sl_facet_graph *graph, int32_t count, const sl_context *context,
                                           sl_spectrum **out);

/* The same pairs, only as precise as the signs of their vectors need (SL_LANCZOS_SIGNS): for cuts, at about half the
 * price. The same statuses. */
SL_NODISCARD sl_status sl_spectrum_compute_signs(const sl_facet_graph *graph, int32_t count, const sl_context *context,
                                                 sl_spectrum **out);
void sl_spectrum_free(sl_spectrum *spectrum); /* NULL is a no-op */

/* The bipartition of one eigenvector: F+ = {v >= 0}, F- = {v < 0}. */
typedef struct sl_cut_candidate {
    int32_t vector;                         /* index into the spectrum, 0 = constant vector */
    int32_t positive_parts, negative_parts; /* components of F+ and F- (nodal domains) */
    bool passes;                            /* both 1: the paper's connectivity filter */
    int32_t seam_edges;                     /* edges between F+ and F- (errata 3) */
    double seam_length;                     /* their Euclidean length */
} sl_cut_candidate;

/* side[node] = 1 where vectors[node, vector] >= 0, with |v| <= 1e-12 max|v| counted as 0. */
void sl_spectrum_side(const sl_spectrum *spectrum, int32_t vector, uint8_t *side);

/* One candidate per vector 1 .. count - 1. candidates: count - 1. */
SL_NODISCARD sl_status sl_cut_candidates(const sl_mesh *mesh, const sl_facet_graph *graph, const sl_spectrum *spectrum,
                                         sl_cut_candidate *candidates);

/* Shortens a cut: a minimum cut with edge-length capacities in the band of nodes within `rings` dual rings of it. Kept
 * only if both sides stay connected; *changed says whether it was. weight: mesh->nh factors on the lengths, equal for
 * both halfedges of an edge; NULL = 1. side: n, in and out. rings 0 = no-op. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_smooth_cut(const sl_mesh *mesh, const sl_facet_graph *graph, const double *weight,
                                     int32_t rings, uint8_t *side, bool *changed);

#endif
