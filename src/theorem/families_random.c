/* Families without a plane: trees, sparse random graphs, fixed nodes, lobes, edges across. */
#include "base/memory.h"
#include "theorem/families_internal.h"

#include <math.h>

/* A random tree on the pairs [first, first + count): each joins an earlier one, a near one where `thin` is set. */
static void add_tree(sl_rng *rng, sl_edges *edges, int32_t first, int32_t count, bool thin)
{
    for (int32_t i = 1; i < count; i++) {
        const int32_t near = 8 + count / 32, reach = thin && i > near ? near : i;
        sl_edges_within(edges, first + i, first + i - 1 - sl_rng_index(rng, reach));
    }
}

/* So many random edges within the pairs [first, first + count); parallel ones may come about. */
static void add_random(sl_rng *rng, sl_edges *edges, int32_t first, int32_t count, int32_t more)
{
    for (int32_t k = 0; k < more && count > 1; k++) {
        const int32_t a = sl_rng_index(rng, count), b = sl_rng_index(rng, count);
        if (a != b) {
            sl_edges_within(edges, first + a, first + b);
        }
    }
}

/* Axis edges at a share of the pairs, at one of them at least. */
static void add_axis(sl_rng *rng, sl_edges *edges, int32_t first, int32_t count, double share)
{
    const int32_t always = sl_rng_index(rng, count);
    for (int32_t i = 0; i < count; i++) {
        if (i == always || sl_rng_uniform(rng) < share) {
            sl_edges_across(edges, first + i, first + i);
        }
    }
}

/* Two copies of a random tree, joined at a few places, however large: between many, vectors fall off exponentially, and
 * signs of values like 1e-20 cannot be read from doubles. */
sl_status sl_make_tree(sl_rng *rng, int32_t nodes, sl_theorem_graph **out)
{
    const double few = 16.0;
    sl_edges edges = {.pairs = nodes / 2};
    add_tree(rng, &edges, 0, edges.pairs, true);
    add_axis(rng, &edges, 0, edges.pairs, sl_rng_uniform(rng) * fmin(0.4, few / nodes));
    return sl_edges_finish(&edges, out);
}

/* Two copies of G(n, p), connected or not. */
sl_status sl_make_sparse(sl_rng *rng, int32_t nodes, sl_theorem_graph **out)
{
    sl_edges edges = {.pairs = nodes / 2};
    const double degree = 2.0 + 3.0 * sl_rng_uniform(rng);
    add_random(rng, &edges, 0, edges.pairs, (int32_t)(0.5 * degree * edges.pairs));
    add_axis(rng, &edges, 0, edges.pairs, 0.3);
    return sl_edges_finish(&edges, out);
}

/* A connected half, nodes fixed by the mirror between the halves, axis edges or none. */
sl_status sl_make_fixed(sl_rng *rng, int32_t nodes, sl_theorem_graph **out)
{
    sl_edges edges = {.fixed = 1 + sl_rng_index(rng, nodes / 4)};
    edges.pairs = (nodes - edges.fixed) / 2;
    add_tree(rng, &edges, 0, edges.pairs, true);
    add_random(rng, &edges, 0, edges.pairs, sl_rng_index(rng, edges.pairs));
    for (int32_t k = 0; k < edges.fixed; k++) {
        for (int32_t spokes = 1 + sl_rng_index(rng, 2); spokes > 0; spokes--) {
            sl_edges_spoke(&edges, sl_rng_index(rng, edges.pairs), k);
        }
        if (k > 0 && sl_rng_uniform(rng) < 0.5) {
            sl_edges_fixed(&edges, k, sl_rng_index(rng, k));
        }
    }
    if (sl_rng_uniform(rng) < 0.5) {
        add_axis(rng, &edges, 0, edges.pairs, 0.2);
    }
    return sl_edges_finish(&edges, out);
}

/* Lobes that hang together through fixed nodes only: A' falls apart. Some lobes are copies of their neighbour. */
sl_status sl_make_lobes(sl_rng *rng, int32_t nodes, sl_theorem_graph **out)
{
    const int32_t lobes = 2 + sl_rng_index(rng, 3);
    sl_edges edges = {.fixed = lobes};
    const int32_t each = (nodes - lobes) / 2 / lobes > 1 ? (nodes - lobes) / 2 / lobes : 1;
    edges.pairs = lobes * each;
    uint64_t seed = 0;
    for (int32_t k = 0; k < lobes; k++) {
        seed = k == 0 || sl_rng_uniform(rng) < 0.6 ? sl_rng_bits(rng) : seed; /* or the same lobe again */
        sl_rng lobe = sl_rng_seed(seed);
        const int32_t first = k * each;
        add_tree(&lobe, &edges, first, each, true);
        add_random(&lobe, &edges, first, each, each / 3);
        if (sl_rng_uniform(&lobe) < 0.5) {
            add_axis(&lobe, &edges, first, each, 0.2);
        }
        const int32_t at = first + sl_rng_index(&lobe, each);
        sl_edges_spoke(&edges, at, k);
        sl_edges_spoke(&edges, k > 0 ? first - 1 : at, k);
    }
    return sl_edges_finish(&edges, out);
}

/* Random edges within and across: A'' is any symmetric matrix. */
sl_status sl_make_crossed(sl_rng *rng, int32_t nodes, sl_theorem_graph **out)
{
    sl_edges edges = {.fixed = sl_rng_uniform(rng) < 0.3 ? 1 + sl_rng_index(rng, 2) : 0};
    edges.pairs = (nodes - edges.fixed) / 2;
    add_tree(rng, &edges, 0, edges.pairs, false);
    add_random(rng, &edges, 0, edges.pairs, sl_rng_index(rng, edges.pairs));
    for (int32_t k = 1 + sl_rng_index(rng, 1 + edges.pairs / 4); k > 0; k--) {
        const int32_t a = sl_rng_index(rng, edges.pairs), b = sl_rng_index(rng, edges.pairs);
        sl_edges_across(&edges, a, b);
    }
    for (int32_t k = 0; k < edges.fixed; k++) {
        sl_edges_spoke(&edges, sl_rng_index(rng, edges.pairs), k);
    }
    add_axis(rng, &edges, 0, edges.pairs, 0.2);
    return sl_edges_finish(&edges, out);
}

/* A graph with a diagonal A'', the halves of random pairs then exchanged: A'' is not diagonal as given, but there are
 * halves for which it is. */
sl_status sl_make_switched(sl_rng *rng, int32_t nodes, sl_theorem_graph **out)
{
    sl_edges edges = {.pairs = nodes / 2};
    const int32_t n = edges.pairs;
    add_tree(rng, &edges, 0, n, true);
    add_random(rng, &edges, 0, n, n / 3);
    add_axis(rng, &edges, 0, n, 0.25);
    bool *turn = sl_alloc(n, sizeof *turn);
    if (turn == NULL) {
        edges.status = SL_OUT_OF_MEMORY;
    }
    for (int32_t i = 0; turn != NULL && i < n; i++) {
        turn[i] = sl_rng_uniform(rng) < 0.3;
    }
    for (int64_t k = 0; turn != NULL && k < 2 * edges.count; k++) {
        const int32_t node = edges.end[k], pair = node < n ? node : node - n;
        edges.end[k] = turn[pair] ? (node < n ? node + n : pair) : node;
    }
    sl_free(turn);
    return sl_edges_finish(&edges, out);
}
