/* Random graphs with a mirror, by family, and the check over thousands of them.
 * Layer: theorem. */
#ifndef SL_THEOREM_FAMILIES_H
#define SL_THEOREM_FAMILIES_H

#include "base/rng.h"
#include "theorem/theorem.h"

/* nodes: about how many (at least 8); the graph has at most that many but never less than 4. SL_OUT_OF_MEMORY. */
typedef sl_status sl_theorem_make(sl_rng *rng, int32_t nodes, sl_theorem_graph **out);

typedef struct sl_theorem_family {
    const char *name; /* "planar" */
    const char *what; /* one line */
    sl_theorem_make *make;
} sl_theorem_family;

/* All families, in a fixed order; borrowed. */
const sl_theorem_family *sl_theorem_families(int32_t *count);

typedef struct sl_theorem_run_def {
    int32_t graphs;         /* default 10,000: one in a hundred is large */
    uint64_t seed;          /* default 1 */
    int32_t least, most;    /* nodes of the small ones, whole spectra; default 8, 192 */
    int32_t large;          /* nodes of the large ones, at most; default 4096 */
    sl_theorem_def check;   /* sabotage: only of graph 0 */
    double undecided_share; /* of signs that may stay undecided, but for one vector; default 1e-3 */
} sl_theorem_run_def;

sl_theorem_run_def sl_theorem_run_default(void);

/* Are few enough signs undecided? At most `share` of them, those of one graph (result.most_undecided) left out: a
 * single localised vector may leave some open, which is nothing among millions but a large share of some thousands. */
bool sl_theorem_signs_suffice(int64_t signs, int64_t undecided, int64_t most_undecided, double share);

/* What the graph of an index is: its family, the size asked for. Deterministic in (seed, index). SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_theorem_graph_of(const sl_theorem_run_def *def, int32_t index, int32_t *family,
                                           sl_theorem_graph **out);

typedef struct sl_theorem_run {
    int32_t families;
    sl_theorem_result *family;  /* one sum a family */
    sl_theorem_result total;    /* and of all */
    int32_t violated;           /* index of the first graph with a violated statement, -1 = none */
    sl_theorem_result evidence; /* its result */
    int64_t signs, signs_undecided;
    bool decided; /* see sl_theorem_signs_suffice */
} sl_theorem_run;

/* All of it, in parallel over graphs; progress is reported. SL_OUT_OF_MEMORY, SL_CANCELLED, SL_INTERNAL. Same bytes for
 * any number of threads. */
SL_NODISCARD sl_status sl_theorem_run_all(const sl_theorem_run_def *def, const sl_context *context,
                                          sl_theorem_run **out);
void sl_theorem_run_free(sl_theorem_run *run); /* NULL is a no-op */

/* The graph of Figure 17 as printed (n = 4, m = 0). SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_theorem_figure17(sl_theorem_graph **out);

/* Statement 9, added to *result: spectrum 0, 3 - sqrt 5, 2, 2, 2, 4, 4, 3 + sqrt 5 of D - A; the printed vector
 * (0 -1 1 0 ...) is none of L = A - D, (0 -1 0 1 0 ...) is one for -2 and neither symmetric nor antisymmetric.
 * SL_OUT_OF_MEMORY, SL_INTERNAL. */
SL_NODISCARD sl_status sl_theorem_check_figure17(sl_theorem_result *result);

#endif
