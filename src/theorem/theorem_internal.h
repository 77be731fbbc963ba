/* What the statements of the theorem share; internal to the room.
 * Layer: theorem. */
#ifndef SL_THEOREM_THEOREM_INTERNAL_H
#define SL_THEOREM_THEOREM_INTERNAL_H

#include "sparse/csc.h"
#include "theorem/theorem.h"

/* Eigenvalues nearer to one another than this times ||A|| are not told apart: they are taken as one cluster. */
static const double SL_CLUSTER_GAP = 1e-8;

/* Eigenpairs of one matrix, ascending, with what is known of their errors. */
typedef struct sl_pairs {
    int32_t n, count;
    bool complete;    /* count = n */
    double *lambda;   /* count */
    double *vector;   /* n x count, column-major */
    double *residual; /* count: ||A v - lambda v||, rounding allowed for */
    double norm;      /* ||A||_1 */
    double error;     /* the k-th eigenvalue is within this of lambda[k] */
    double end;       /* every eigenvalue from number `count` on is above this; HUGE_VAL when complete */
    bool sound;       /* every residual is as small as its solver promises */
    int32_t clusters; /* runs of eigenvalues that are not told apart */
    int32_t *first;   /* clusters + 1 */
    double *bound;    /* per cluster: a unit vector in its computed span is within this of an exact vector of the
                         eigenspaces of that cluster; HUGE_VAL = nothing known */
} sl_pairs;

/* All pairs of a small matrix (count 0), or the `count` lowest of a large one by our own solver. null_space: n x
 * null_count, orthonormal, may be NULL. Pairs whose cluster may be incomplete are dropped. SL_OUT_OF_MEMORY,
 * SL_CANCELLED, SL_INTERNAL. */
SL_NODISCARD sl_status sl_pairs_solve(const sl_csc *A, int32_t count, const double *null_space, int32_t null_count,
                                      double tolerance, const sl_context *context, sl_pairs *out);

/* Residuals, error, clusters and bounds from what stands in lambda and vector. promised: residual a solver of this kind
 * keeps, over the norm. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_pairs_judge(const sl_csc *A, double promised, sl_pairs *pairs);
void sl_pairs_clear(sl_pairs *pairs);

static inline const double *sl_pairs_vector(const sl_pairs *pairs, int32_t k)
{
    return pairs->vector + (int64_t)pairs->n * k;
}

/* The half as a signed graph: an edge of A' joins two pairs with sign +, an edge of A'' off the diagonal with sign -. A
 * component is balanced when its pairs can be given signs (which node of a pair counts as half 1) so that no edge is
 * crossed: then A'' is diagonal on it. Source: Harary 1953, "On the notion of balance of a signed graph". */
typedef struct sl_half {
    int32_t n;
    int32_t *first, *other; /* rows of the signed graph: pairs joined, */
    int8_t *sign;           /* and how */
    int32_t *axis;          /* n: edges {f, image} of a pair */
    int32_t *spokes;        /* n: edges from a node of the pair to fixed nodes */
    int32_t components;
    int32_t *component;  /* n */
    int8_t *turn;        /* n: +1 = the pair's node of half 1 stays, -1 = the two are exchanged */
    bool *balanced;      /* components */
    bool diagonal;       /* A'' is diagonal as given */
    int32_t graph_parts; /* components of the whole graph */
    int32_t *part;       /* 2 n + m: component of a node */
} sl_half;

SL_NODISCARD sl_status sl_half_create(const sl_theorem_graph *graph, sl_half *out);
void sl_half_clear(sl_half *half);

/* Lower triangles: D - A of the graph; the antisymmetric block D' - A' + A''; the symmetric block of order n + m in the
 * orthonormal basis (e_i + e_image) / sqrt 2, e_fixed. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_matrix_whole(const sl_theorem_graph *graph, sl_csc **out);
SL_NODISCARD sl_status sl_matrix_antisymmetric(const sl_theorem_graph *graph, sl_csc **out);
SL_NODISCARD sl_status sl_matrix_symmetric(const sl_theorem_graph *graph, sl_csc **out);

/* The block of one component of the half: pair[] lists its pairs, ascending; place[pair] = its row. */
SL_NODISCARD sl_status sl_matrix_block(const sl_csc *antisymmetric, const int32_t *pair, int32_t count,
                                       const int32_t *place, sl_csc **out);

/* Which matrix. */
typedef enum sl_block_kind { SL_BLOCK_WHOLE, SL_BLOCK_SYMMETRIC, SL_BLOCK_ANTISYMMETRIC } sl_block_kind;

/* Vectors of length 1 that a matrix maps to 0, one each for parts of the graph; all there are of them. */
typedef struct sl_null_space {
    double *basis; /* n x count, owned */
    int32_t count;
} sl_null_space;

SL_NODISCARD sl_status sl_null_space_create(const sl_theorem_graph *graph, const sl_half *half, sl_block_kind kind,
                                            sl_null_space *out);

/* Everything solved for one graph. */
typedef struct sl_solution {
    sl_csc *L, *S, *T; /* whole, symmetric, antisymmetric */
    sl_pairs whole, symmetric, antisymmetric;
    int32_t *skew; /* per cluster of `whole`: antisymmetric eigenvalues in it, by the half spectra; -1 = unknown */
    int32_t lowest_skew; /* symmetric eigenvalues below the lowest antisymmetric one, -1 = unknown */
    /* antisymmetric vectors of L, orthonormal in each cluster, resolved from L's own by U' P U: */
    int32_t vectors;
    double *vector;      /* nodes x vectors */
    int32_t *of_cluster; /* vectors: cluster of `whole` */
    bool *own;           /* vectors: the solver's own vector, untouched (a simple eigenvalue) */
} sl_solution;

SL_NODISCARD sl_status sl_solution_create(const sl_theorem_graph *graph, const sl_half *half, const sl_theorem_def *def,
                                          const sl_context *context, sl_solution *out);
void sl_solution_clear(sl_solution *solution);

/* Matches the spectra: fills skew, lowest_skew. *difference: largest of corresponding eigenvalues; HUGE_VAL where the
 * numbers of them differ. */
void sl_solution_match(const sl_theorem_graph *graph, sl_solution *solution, double *difference);

/* M = U' P U of cluster c of L's pairs, size x size; image: the permutation P, NULL = the mirror. */
void sl_moments(const sl_theorem_graph *graph, const sl_pairs *pairs, int32_t c, const int32_t *image, double *M);

/* One line on why a statement fails, kept if it is the first; counts a verdict. */
void sl_theorem_count(sl_theorem_result *result, sl_theorem_statement statement, sl_theorem_verdict verdict);
void sl_theorem_fail(sl_theorem_result *result, sl_theorem_statement statement, const char *format, ...)
    SL_PRINTF(3, 4);

/* The statements, one each; each counts itself in *result. */
SL_NODISCARD sl_status sl_state_mirror(const sl_theorem_graph *graph, sl_theorem_result *result);
SL_NODISCARD sl_status sl_state_spectra(const sl_theorem_graph *graph, sl_solution *solution,
                                        sl_theorem_result *result);
SL_NODISCARD sl_status sl_state_basis(const sl_theorem_graph *graph, sl_solution *solution, sl_theorem_result *result);
SL_NODISCARD sl_status sl_state_axis(const sl_theorem_graph *graph, const sl_half *half, const sl_solution *solution,
                                     const sl_theorem_def *def, sl_theorem_result *result);
SL_NODISCARD sl_status sl_state_blocks(const sl_theorem_graph *graph, const sl_half *half, const sl_solution *solution,
                                       const sl_theorem_def *def, sl_theorem_result *result);
SL_NODISCARD sl_status sl_state_fixed(const sl_theorem_graph *graph, const sl_solution *solution,
                                      sl_theorem_result *result);
SL_NODISCARD sl_status sl_state_joint(const sl_theorem_graph *graph, const sl_solution *solution,
                                      sl_theorem_result *result);

/* The cut of a graph's nodes into side 1 (F+) and side 0 (F-), against the axis of one component of the half: *off =
 * edges of the cut that are no axis edges of it, *missing = axis edges that are not cut. The axis: edges {f, image} of
 * the component's pairs, and edges from fixed nodes to F-. */
void sl_seam_compare(const sl_theorem_graph *graph, const sl_half *half, int32_t component, const uint8_t *side,
                     int32_t *off, int32_t *missing);

/* Do both sides hang together? SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_seam_connected(const sl_theorem_graph *graph, const uint8_t *side, bool *connected);

/* How many distinct eigenvalues of the integer matrix A (lower triangle) have an eigenvector that is not 0 at row f:
 * the linear complexity of e_f' A^k e_f modulo a prime near 2^61. Never more than the truth; less only if the prime
 * divides a determinant that is not 0 (see the design record). SL_OUT_OF_MEMORY. O(n (n + entries)). */
SL_NODISCARD sl_status sl_distinct_at(const sl_csc *A, int32_t f, int32_t *count);

/* Unordered list of edges under construction; a failed allocation is remembered and reported once. */
typedef struct sl_edges {
    int32_t *end; /* 2 each */
    int64_t count, capacity;
    int32_t pairs, fixed;
    sl_status status;
} sl_edges;

void sl_edges_add(sl_edges *edges, int32_t a, int32_t b);

/* With their mirror images: within the halves; across (i = j: one axis edge); to fixed node k; between fixed nodes. */
void sl_edges_within(sl_edges *edges, int32_t i, int32_t j);
void sl_edges_across(sl_edges *edges, int32_t i, int32_t j);
void sl_edges_spoke(sl_edges *edges, int32_t i, int32_t k);
void sl_edges_fixed(sl_edges *edges, int32_t k, int32_t l);

/* The graph; frees the list in every case. */
SL_NODISCARD sl_status sl_edges_finish(sl_edges *edges, sl_theorem_graph **out);

#endif
