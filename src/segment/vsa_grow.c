/* Variational shape approximation: proxies fitted to regions, regions grown around proxies. */
#include "segment/vsa_internal.h"

#include "base/memory.h"
#include "geom/vec3.h"

#include <string.h>

#define SWEEPS 40            /* Lloyd sweeps at most; most surfaces settle in 5 to 15 */
#define SETTLED_RTOL 1e-6    /* a sweep that lowers the energy by less is the last */
#define NO_NORMAL_RTOL 1e-12 /* vector areas that cancel to this share of the area have no mean normal */

static bool before(const sl_vsa_heap_entry *a, const sl_vsa_heap_entry *b)
{
    return a->key < b->key || (a->key == b->key && a->order < b->order);
}

void sl_vsa_heap_push(sl_vsa_heap *heap, sl_vsa_heap_entry entry)
{
    int64_t at = heap->count++;
    while (at > 0 && before(&entry, &heap->entry[(at - 1) / 2])) {
        heap->entry[at] = heap->entry[(at - 1) / 2];
        at = (at - 1) / 2;
    }
    heap->entry[at] = entry;
}

sl_vsa_heap_entry sl_vsa_heap_pop(sl_vsa_heap *heap)
{
    const sl_vsa_heap_entry top = heap->entry[0], last = heap->entry[--heap->count];
    int64_t at = 0;
    for (int64_t child = 1; child < heap->count; child = 2 * at + 1) {
        child += child + 1 < heap->count && before(&heap->entry[child + 1], &heap->entry[child]);
        if (!before(&heap->entry[child], &last)) {
            break;
        }
        heap->entry[at] = heap->entry[child];
        at = child;
    }
    heap->entry[at] = last;
    return top;
}

/* |n - N|^2 */
static double mismatch(const sl_vsa *vsa, int32_t node, const double normal[3])
{
    const double *unit = vsa->unit + 3 * (int64_t)node;
    double d[3];
    sl_vec3_sub(unit, normal, d);
    return sl_vec3_dot(d, d);
}

double sl_vsa_error(const sl_vsa *vsa, int32_t node, const sl_vsa_proxy *proxy)
{
    return vsa->excess[node] + vsa->weight[node] * mismatch(vsa, node, proxy->normal);
}

/**
 * The best proxy of each region, and the energy.
 *
 *     N = sum V / |sum V|,   E = sum of E(f, N)
 *
 * Where the vector areas cancel, as over a closed surface, every normal is as good: the old one stays.
 *
 * No allocation, cannot fail, fixed summation order. O(nodes).
 */
void sl_vsa_fit(sl_vsa *vsa)
{
    const int32_t n = vsa->surface.graph->n;
    for (int32_t r = 0; r < vsa->count; r++) {
        sl_vsa_proxy *p = &vsa->proxy[r];
        p->area = p->error = p->sum[0] = p->sum[1] = p->sum[2] = 0.0;
        p->nodes = 0;
    }
    for (int32_t i = 0; i < n; i++) {
        sl_vsa_proxy *p = &vsa->proxy[vsa->region[i]];
        sl_vec3_add(p->sum, vsa->surface.vector + 3 * (int64_t)i, p->sum);
        p->area += vsa->surface.area[i];
        p->nodes++;
    }
    for (int32_t r = 0; r < vsa->count; r++) {
        sl_vsa_proxy *p = &vsa->proxy[r];
        const double length = sl_vec3_norm(p->sum);
        for (int k = 0; k < 3 && length > NO_NORMAL_RTOL * p->area; k++) {
            p->normal[k] = p->sum[k] / length;
        }
    }
    vsa->energy = 0.0;
    for (int32_t i = 0; i < n; i++) {
        sl_vsa_proxy *p = &vsa->proxy[vsa->region[i]];
        const double error = sl_vsa_error(vsa, i, p);
        p->error += error;
        vsa->energy += error;
    }
}

void sl_vsa_reseed(sl_vsa *vsa)
{
    const int32_t n = vsa->surface.graph->n;
    for (int32_t r = 0; r < vsa->count; r++) {
        vsa->proxy[r].seed = -1;
    }
    for (int32_t i = 0; i < n; i++) {
        sl_vsa_proxy *p = &vsa->proxy[vsa->region[i]];
        if (p->seed < 0 || mismatch(vsa, i, p->normal) < mismatch(vsa, p->seed, p->normal)) {
            p->seed = i;
        }
    }
}

/* Offers the free neighbours of a node to its region. */
static void offer_neighbours(sl_vsa *vsa, int32_t node, int32_t *order)
{
    const sl_graph *g = vsa->surface.graph;
    const int32_t region = vsa->region[node];
    for (int32_t p = g->first[node]; p < g->first[node + 1]; p++) {
        const int32_t other = g->adj[p];
        if (vsa->region[other] < 0) {
            const double key = sl_vsa_error(vsa, other, &vsa->proxy[region]);
            sl_vsa_heap_push(&vsa->heap, (sl_vsa_heap_entry){key, (*order)++, other, region});
        }
    }
}

/* Every node offers its neighbours once, so the queue never holds more than the adjacency does. */
void sl_vsa_grow(sl_vsa *vsa)
{
    const int32_t n = vsa->surface.graph->n;
    int32_t order = 0;
    for (int32_t i = 0; i < n; i++) {
        vsa->region[i] = -1;
    }
    for (int32_t r = 0; r < vsa->count; r++) {
        vsa->region[vsa->proxy[r].seed] = r;
    }
    vsa->heap.count = 0;
    for (int32_t r = 0; r < vsa->count; r++) {
        offer_neighbours(vsa, vsa->proxy[r].seed, &order);
    }
    while (vsa->heap.count > 0) {
        const sl_vsa_heap_entry next = sl_vsa_heap_pop(&vsa->heap);
        if (vsa->region[next.node] < 0) {
            vsa->region[next.node] = next.region;
            offer_neighbours(vsa, next.node, &order);
        }
    }
    sl_vsa_fit(vsa);
}

sl_status sl_vsa_relax(sl_vsa *vsa, const sl_context *context)
{
    const size_t regions = (size_t)vsa->surface.graph->n * sizeof *vsa->region;
    const size_t proxies = (size_t)vsa->count * sizeof *vsa->proxy;
    sl_status status = SL_OK;
    for (int32_t sweep = 0; sweep < SWEEPS && status == SL_OK; sweep++) {
        const double energy = vsa->energy;
        memcpy(vsa->kept, vsa->region, regions);
        memcpy(vsa->kept_proxy, vsa->proxy, proxies);
        sl_vsa_reseed(vsa);
        sl_vsa_grow(vsa);
        if (vsa->energy >= energy) {
            memcpy(vsa->region, vsa->kept, regions);
            memcpy(vsa->proxy, vsa->kept_proxy, proxies);
            vsa->energy = energy;
        }
        if (vsa->energy >= (1.0 - SETTLED_RTOL) * energy) {
            break;
        }
        status = sl_report_progress(context, "proxies", 1.0);
    }
    return status;
}
