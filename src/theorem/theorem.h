/* The symmetric-graph theorem (paper, Appendix A) as a check: what holds of it, statement by statement, decided with
 * error bounds. reports/design/symmetry-theorem.md has the statements with their proofs.
 * Layer: theorem.
 *
 * A floating-point vector says nothing of a sign by itself: |v(f)| is compared with a bound on its error, residual over
 * gap (Davis and Kahan 1970); a sign below its bound is undecided, unless exact arithmetic or another symmetry shows
 * that the value is 0. */
#ifndef SL_THEOREM_THEOREM_H
#define SL_THEOREM_THEOREM_H

#include "base/context.h"
#include "theorem/graph.h"

/* Numbered as in reports/design/symmetry-theorem.md. */
typedef enum sl_theorem_statement {
    SL_THEOREM_MIRROR,  /* 0: the mirror is an automorphism (what all others suppose) */
    SL_THEOREM_SPECTRA, /* 1: spec(L) is the union of the half spectra, as multisets */
    SL_THEOREM_BASIS,   /* 2: every eigenspace has a basis of symmetric and antisymmetric vectors, counted by 1 */
    SL_THEOREM_AXIS,    /* 3: an antisymmetric seam has an axis edge {f, image} iff v(f) is not 0 */
    SL_THEOREM_HALF,    /* 4: lowest vector of a half's block: one sign, its seam exactly the axis; on the half */
    SL_THEOREM_WHOLE,   /* 5: the same on L's own vectors, where it is the lowest antisymmetric one */
    SL_THEOREM_CROSSED, /* 6: where no choice of halves makes A'' diagonal, no antisymmetric seam is exactly the axis */
    SL_THEOREM_FIXED,   /* 7: antisymmetric vectors vanish on fixed nodes */
    SL_THEOREM_JOINT,   /* 8: two mirrors have a common basis iff they commute */
    SL_THEOREM_FIGURE17, /* 9: the corrected graph of Figure 17 and its whole spectrum */
    SL_THEOREM_STATEMENTS
} sl_theorem_statement;

/* "spectra", "basis", ... ; borrowed. */
const char *sl_theorem_statement_name(sl_theorem_statement statement);

typedef enum sl_theorem_verdict { SL_THEOREM_HOLDS, SL_THEOREM_UNDECIDED, SL_THEOREM_VIOLATED } sl_theorem_verdict;

/* One statement over the graphs it was asked of. */
typedef struct sl_theorem_tally {
    int64_t holds, violated, undecided; /* graphs; those it does not apply to are in none */
    int64_t signs;                      /* signs (or zeros) asked for */
    int64_t zeros;                      /* of these, shown to be 0 */
    int64_t signs_undecided;
} sl_theorem_tally;

/* Everything about one graph, or the sum over many. */
typedef struct sl_theorem_result {
    sl_theorem_tally tally[SL_THEOREM_STATEMENTS];
    int64_t graphs, nodes;
    int64_t most_undecided;    /* signs of one graph, but no more than one vector of it has */
    double largest_difference; /* of corresponding eigenvalues, over ||L||_1 */
    double largest_bound;      /* on a vector that was used */
    int64_t blocks;            /* components of the half, those that no choice of halves sets right left out */
    int64_t antisymmetric;     /* eigenspaces with antisymmetric vectors, of graphs with axis edges; of these, */
    int64_t seams_off_axis;    /* those that vanish somewhere on the axis: "contain the axis" fails */
    int64_t crossed;           /* graphs with edges between the halves off the axis */
    int64_t crossed_one_sign;  /* of these, the lowest antisymmetric vector has one sign on the half as given */
    int64_t no_common_basis;   /* eigenspaces without a basis common to two mirrors that do not commute */
    /* of one graph alone; -1 = not known */
    int32_t lowest_index; /* of the lowest antisymmetric eigenvalue in L's spectrum, 0 = the constant vector; the first
                             of those equal to it */
    sl_theorem_statement failed; /* the first statement violated; SL_THEOREM_STATEMENTS = none */
    char reason[160];            /* why */
} sl_theorem_result;

/* Ways to break what is checked, so that it can be seen to fail. */
typedef enum sl_theorem_break {
    SL_THEOREM_BREAK_NONE,
    SL_THEOREM_BREAK_GRAPH,  /* an edge is taken away, its mirror image is not */
    SL_THEOREM_BREAK_VECTOR, /* a solver's vector is moved by 1e-3 */
    SL_THEOREM_BREAK_SIGN    /* after the residuals were taken, one entry of a vector changes its sign */
} sl_theorem_break;

typedef struct sl_theorem_def {
    int32_t full_nodes;         /* whole spectra by LAPACK up to so many nodes; default 192 */
    int32_t lowest;             /* beyond: so many lowest pairs of L and of each half; default 30 */
    double tolerance;           /* of our solver; default 1e-12 */
    sl_theorem_break sabotage;  /* default NONE */
    const int32_t *const *maps; /* further involutions of the nodes that commute with the mirror, borrowed: they show
                                   that some values are 0; default NULL */
    int32_t map_count;
} sl_theorem_def;

sl_theorem_def sl_theorem_default(void);

/* Checks every statement that applies. SL_OUT_OF_MEMORY, SL_CANCELLED, SL_INTERNAL (LAPACK failed). Violated is no
 * error: see the result. Same bytes for any number of threads. */
SL_NODISCARD sl_status sl_theorem_check(const sl_theorem_graph *graph, const sl_theorem_def *def,
                                        const sl_context *context, sl_theorem_result *out);

/* total += one. */
void sl_theorem_add(sl_theorem_result *total, const sl_theorem_result *one);

/* Verdict of a statement over everything in the tally. */
sl_theorem_verdict sl_theorem_verdict_of(const sl_theorem_tally *tally);

#endif
