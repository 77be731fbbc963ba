/* Families with two mirrors: random graphs on which a dihedral group acts. For D2 they commute, for D3, D4 and D5 not.
 *
 * D_k = <r, s>: r^k = s^2 = (s r)^2 = 1. Nodes come in orbits: the group itself (2 k nodes, r^a s^b is number 2 a + b),
 * corners of a k-gon (k nodes, r: a -> a + 1, s: a -> -a), its sides (the same with s: a -> 1 - a), and centres. */
#include "base/memory.h"
#include "theorem/families_internal.h"

static const int32_t dense_nodes = 512;

typedef enum orbit_kind { GROUP, CORNERS, SIDES, CENTRE } orbit_kind;

typedef struct orbits {
    int32_t k, nodes;
    int32_t *rotated;   /* r x */
    int32_t *reflected; /* s x */
    int32_t *first;     /* of the orbit of x */
} orbits;

static int32_t orbit_size(orbit_kind kind, int32_t k)
{
    return kind == GROUP ? 2 * k : kind == CENTRE ? 1 : k;
}

static void add_orbit(orbits *o, orbit_kind kind)
{
    const int32_t first = o->nodes, k = o->k;
    for (int32_t i = 0; i < orbit_size(kind, k); i++) {
        const int32_t a = kind == GROUP ? i / 2 : i, b = kind == GROUP ? i % 2 : 0;
        const int32_t offset = kind == SIDES ? 1 : 0;
        o->first[first + i] = first;
        if (kind == GROUP) { /* r r^a s^b; s r^a s^b = r^-a s^(1 + b) */
            o->rotated[first + i] = first + 2 * ((a + 1) % k) + b;
            o->reflected[first + i] = first + 2 * ((k - a) % k) + 1 - b;
        } else if (kind == CENTRE) {
            o->rotated[first] = o->reflected[first] = first;
        } else {
            o->rotated[first + i] = first + (a + 1) % k;
            o->reflected[first + i] = first + (offset + k - a) % k;
        }
    }
    o->nodes += orbit_size(kind, k);
}

/* An edge and all its images; images that fall on one another count once. */
static void add_edge_orbit(const orbits *o, sl_edges *edges, int32_t x, int32_t y)
{
    const int64_t before = edges->count;
    for (int32_t turn = 0; turn < 2 * o->k; turn++) {
        bool known = x == y;
        for (int64_t e = before; e < edges->count && !known; e++) {
            const int32_t a = edges->end[2 * e], b = edges->end[2 * e + 1];
            known = (a == x && b == y) || (a == y && b == x);
        }
        if (!known) {
            sl_edges_add(edges, x, y);
        }
        x = o->rotated[x];
        y = o->rotated[y];
        if (turn == o->k - 1) { /* back at the start: now the reflected ones */
            x = o->reflected[x];
            y = o->reflected[y];
        }
    }
}

static sl_status make_orbits(sl_rng *rng, int32_t nodes, int32_t k, orbits *o)
{
    *o = (orbits){.k = k};
    o->rotated = sl_alloc((int64_t)nodes + 2 * k, sizeof *o->rotated);
    o->reflected = sl_alloc((int64_t)nodes + 2 * k, sizeof *o->reflected);
    o->first = sl_alloc((int64_t)nodes + 2 * k, sizeof *o->first);
    if (o->rotated == NULL || o->reflected == NULL || o->first == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    add_orbit(o, k <= nodes / 2 ? GROUP : CORNERS);
    while (o->nodes + 2 * k <= nodes) {
        const double chance = sl_rng_uniform(rng);
        add_orbit(o, chance < 0.7 ? GROUP : chance < 0.82 ? CORNERS : chance < 0.94 ? SIDES : CENTRE);
    }
    return SL_OK;
}

/* Mirrors s and s r of a random graph under D_k. */
static sl_status make_group(sl_rng *rng, int32_t nodes, int32_t k, sl_theorem_graph **out)
{
    orbits o = {0};
    sl_edges edges = {0};
    sl_theorem_graph *plain = NULL;
    sl_status status = SL_OK;
    int32_t *second = NULL;
    *out = NULL;
    SL_TRY(make_orbits(rng, nodes, k, &o));
    edges.fixed = o.nodes;
    for (int32_t x = 1; x < o.nodes; x++) { /* every orbit is joined to an earlier one */
        if (o.first[x] == x) {
            add_edge_orbit(&o, &edges, x, sl_rng_index(rng, x));
        }
    }
    /* and some at random, fewer where the graph is large: those fill up when factored */
    const double more = o.nodes < dense_nodes ? 0.8 * sl_rng_uniform(rng) : 0.1;
    const int64_t wanted = edges.count + 1 + (int64_t)(more * o.nodes);
    for (int64_t tries = 0; edges.count < wanted && tries < 4 * wanted; tries++) {
        const int32_t x = sl_rng_index(rng, o.nodes), y = sl_rng_index(rng, o.nodes);
        add_edge_orbit(&o, &edges, x, y);
    }
    SL_TRY(sl_edges_finish(&edges, &plain));
    second = sl_alloc(o.nodes, sizeof *second);
    SL_TRY(second != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t i = 0; i < o.nodes; i++) {
        second[i] = o.reflected[o.rotated[i]];
    }
    SL_TRY(sl_theorem_graph_from_mirror(&plain->graph, o.reflected, second, out));
cleanup:
    sl_free(edges.end);
    sl_free(second);
    sl_free(o.rotated);
    sl_free(o.reflected);
    sl_free(o.first);
    sl_theorem_graph_free(plain);
    return status;
}

sl_status sl_make_commuting(sl_rng *rng, int32_t nodes, sl_theorem_graph **out)
{
    return make_group(rng, nodes, 2, out);
}

sl_status sl_make_dihedral(sl_rng *rng, int32_t nodes, sl_theorem_graph **out)
{
    return make_group(rng, nodes, nodes >= 10 ? 3 + sl_rng_index(rng, 3) : 3, out);
}
