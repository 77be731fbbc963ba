/* Variational shape approximation: regions merged, and moved to where they are needed. */
#include "segment/vsa_internal.h"

#include "base/memory.h"
#include "geom/vec3.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define TELEPORTS 8      /* moves tried at most; each is a few sweeps */
#define WORTH_RTOL 1e-3  /* a move must lower the energy by this share */
#define WORTH_TRYING 0.5 /* splitting a region is expected to save this share of its error (their Sec. 3.5) */

typedef struct region_pair {
    int32_t a, b; /* a < b */
} region_pair;

static int compare_pairs(const void *x, const void *y)
{
    const region_pair *p = x, *q = y;
    return p->a != q->a ? (p->a < q->a ? -1 : 1) : p->b != q->b ? (p->b < q->b ? -1 : 1) : 0;
}

/* The pairs of regions that touch, ascending, each once; owned by the caller. */
static sl_status adjacent_pairs(const sl_vsa *vsa, region_pair **pair, int32_t *count)
{
    const sl_graph *g = vsa->surface.graph;
    int32_t n = 0;
    for (int pass = 0; pass < 2; pass++) {
        n = 0;
        for (int32_t i = 0; i < g->n; i++) {
            for (int32_t p = g->first[i]; p < g->first[i + 1]; p++) {
                const int32_t a = vsa->region[i], b = vsa->region[g->adj[p]];
                if (a < b && pass == 1) {
                    (*pair)[n] = (region_pair){a, b};
                }
                n += a < b;
            }
        }
        if (pass == 0) {
            *pair = sl_alloc(n, sizeof **pair);
            if (*pair == NULL) {
                return SL_OUT_OF_MEMORY;
            }
        }
    }
    qsort(*pair, (size_t)n, sizeof **pair, compare_pairs);
    *count = 0;
    for (int32_t k = 0; k < n; k++) {
        if (*count == 0 || compare_pairs(&(*pair)[k], &(*pair)[*count - 1]) != 0) {
            (*pair)[(*count)++] = (*pair)[k];
        }
    }
    return SL_OK;
}

/* E(a u b) - E(a) - E(b) = 2 (|S_a| + |S_b| - |S_a + S_b|), S the sums of vector areas: the areas cancel. */
static double merge_cost(const sl_vsa_proxy *a, const sl_vsa_proxy *b)
{
    double sum[3];
    sl_vec3_add(a->sum, b->sum, sum);
    return fmax(2.0 * (sl_vec3_norm(a->sum) + sl_vec3_norm(b->sum) - sl_vec3_norm(sum)), 0.0);
}

sl_status sl_vsa_cheapest_merge(const sl_vsa *vsa, int32_t *a, int32_t *b, double *cost)
{
    region_pair *pair = NULL;
    int32_t count = 0;
    const sl_status status = adjacent_pairs(vsa, &pair, &count);
    *a = *b = -1;
    *cost = INFINITY;
    for (int32_t k = 0; status == SL_OK && k < count; k++) {
        const double c = merge_cost(&vsa->proxy[pair[k].a], &vsa->proxy[pair[k].b]);
        if (c < *cost) {
            *cost = c;
            *a = pair[k].a;
            *b = pair[k].b;
        }
    }
    sl_free(pair);
    return status;
}

/* Region b becomes part of region a. The number b is free then. */
static void relabel(sl_vsa *vsa, int32_t b, int32_t a)
{
    for (int32_t i = 0; i < vsa->surface.graph->n; i++) {
        vsa->region[i] = vsa->region[i] == b ? a : vsa->region[i];
    }
}

sl_status sl_vsa_merge_within(sl_vsa *vsa, double bound, int32_t least)
{
    while (vsa->count > least) {
        int32_t a = -1, b = -1;
        double cost = 0.0;
        const sl_status status = sl_vsa_cheapest_merge(vsa, &a, &b, &cost);
        if (status != SL_OK || a < 0 || vsa->energy + cost > bound) {
            return status;
        }
        relabel(vsa, b, a);
        const int32_t last = --vsa->count;
        if (b != last) { /* numbers stay without gaps */
            relabel(vsa, last, b);
            vsa->proxy[b] = vsa->proxy[last];
        }
        sl_vsa_fit(vsa);
    }
    return SL_OK;
}

/* One move, if it seems worth trying: *tried. */
static sl_status move_region(sl_vsa *vsa, const sl_context *context, bool *tried)
{
    int32_t a = -1, b = -1;
    double cost = 0.0;
    *tried = false;
    const sl_status status = sl_vsa_cheapest_merge(vsa, &a, &b, &cost);
    const int32_t worst = status == SL_OK && a >= 0 ? sl_vsa_worst(vsa, a, b) : -1;
    if (worst < 0 || cost >= WORTH_TRYING * vsa->proxy[worst].error) {
        return status;
    }
    relabel(vsa, b, a);
    sl_vsa_split_off(vsa, worst, b);
    sl_vsa_fit(vsa);
    *tried = true;
    return sl_vsa_relax(vsa, context);
}

/**
 * Moves regions from where they are not needed to where they are.
 *
 * The two neighbours whose union costs least are merged, the worst region is split, everything is relaxed; kept where
 * the energy is lower by a thousandth. Out of local minima that sweeps cannot leave.
 *
 * SL_OUT_OF_MEMORY, SL_CANCELLED. At most eight moves, each a few sweeps.
 * Source: Cohen-Steiner, Alliez, Desbrun 2004, Sec. 3.5 (region teleportation).
 */
sl_status sl_vsa_teleport(sl_vsa *vsa, const sl_context *context)
{
    sl_status status = SL_OK;
    const int32_t n = vsa->surface.graph->n;
    int32_t *region = sl_alloc(n, sizeof *region);
    sl_vsa_proxy *proxy = sl_alloc(vsa->count, sizeof *proxy);
    bool tried = region != NULL && proxy != NULL;
    status = tried ? SL_OK : SL_OUT_OF_MEMORY;
    for (int32_t move = 0; tried && move < TELEPORTS; move++) {
        const double energy = vsa->energy;
        memcpy(region, vsa->region, (size_t)n * sizeof *region);
        memcpy(proxy, vsa->proxy, (size_t)vsa->count * sizeof *proxy);
        SL_TRY(move_region(vsa, context, &tried));
        if (tried && vsa->energy >= (1.0 - WORTH_RTOL) * energy) {
            memcpy(vsa->region, region, (size_t)n * sizeof *region);
            memcpy(vsa->proxy, proxy, (size_t)vsa->count * sizeof *proxy);
            vsa->energy = energy;
            tried = false;
        }
    }
cleanup:
    sl_free(region);
    sl_free(proxy);
    return status;
}
