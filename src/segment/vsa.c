/* Variational shape approximation: how many regions, and where they start. */
#include "segment/vsa_internal.h"

#include "base/memory.h"
#include "geom/vec3.h"

#include <math.h>

#define LEAST_REGIONS 2 /* one region is no cut */
#define BATCH 8         /* regions are added one by one, from here on an eighth of those there are at once */

void sl_vsa_clear(sl_vsa *vsa)
{
    sl_free(vsa->unit);
    sl_free(vsa->weight);
    sl_free(vsa->excess);
    sl_free(vsa->region);
    sl_free(vsa->kept);
    sl_free(vsa->proxy);
    sl_free(vsa->kept_proxy);
    sl_free(vsa->heap.entry);
    *vsa = (sl_vsa){0};
}

static sl_status reserve_proxies(sl_vsa *vsa, int32_t count)
{
    const sl_status status = sl_reserve((void **)&vsa->proxy, &vsa->capacity, count, sizeof *vsa->proxy);
    return status != SL_OK ? status
                           : sl_reserve((void **)&vsa->kept_proxy, &vsa->kept_capacity, count, sizeof *vsa->proxy);
}

static void take_normals(sl_vsa *vsa)
{
    const sl_vsa_surface *s = &vsa->surface;
    for (int32_t i = 0; i < s->graph->n; i++) {
        const double *v = s->vector + 3 * (int64_t)i, length = sl_vec3_norm(v);
        for (int k = 0; k < 3; k++) {
            vsa->unit[3 * (int64_t)i + k] = length > 0.0 ? v[k] / length : 0.0;
        }
        vsa->weight[i] = length;
        vsa->excess[i] = 2.0 * fmax(s->area[i] - length, 0.0);
        vsa->total += s->area[i];
    }
}

/* A region of the facet alone: its own normal is the proxy. */
static void start_region(sl_vsa *vsa, int32_t label, int32_t node)
{
    sl_vsa_proxy *p = &vsa->proxy[label];
    *p = (sl_vsa_proxy){.seed = node, .nodes = 1};
    for (int k = 0; k < 3; k++) {
        p->normal[k] = vsa->unit[3 * (int64_t)node + k];
    }
    vsa->region[node] = label;
}

sl_status sl_vsa_create(const sl_vsa_surface *surface, sl_vsa *vsa)
{
    sl_status status = SL_OK;
    const int32_t n = surface->graph->n;
    *vsa = (sl_vsa){.surface = *surface,
                    .unit = sl_alloc(3 * (int64_t)n, sizeof *vsa->unit),
                    .weight = sl_alloc(n, sizeof *vsa->weight),
                    .excess = sl_alloc(n, sizeof *vsa->excess),
                    .region = sl_calloc(n, sizeof *vsa->region),
                    .kept = sl_alloc(n, sizeof *vsa->kept),
                    .heap = {0, sl_alloc(surface->graph->first[n], sizeof *vsa->heap.entry)}};
    if (vsa->unit == NULL || vsa->weight == NULL || vsa->excess == NULL || vsa->region == NULL || vsa->kept == NULL ||
        vsa->heap.entry == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    SL_TRY(reserve_proxies(vsa, LEAST_REGIONS));
    take_normals(vsa);
    start_region(vsa, 0, 0);
    vsa->count = 1;
    sl_vsa_fit(vsa);
cleanup:
    if (status != SL_OK) {
        sl_vsa_clear(vsa);
    }
    return status;
}

int32_t sl_vsa_worst(const sl_vsa *vsa, int32_t a, int32_t b)
{
    int32_t worst = -1;
    for (int32_t r = 0; r < vsa->count; r++) {
        if (r != a && r != b && vsa->proxy[r].nodes > 1 && !vsa->proxy[r].marked &&
            (worst < 0 || vsa->proxy[r].error > vsa->proxy[worst].error)) {
            worst = r;
        }
    }
    return worst;
}

/* The worst fitting nodes of all marked regions, in one pass. */
static void find_worst_nodes(sl_vsa *vsa)
{
    for (int32_t i = 0; i < vsa->surface.graph->n; i++) {
        sl_vsa_proxy *p = &vsa->proxy[vsa->region[i]];
        if (p->marked && i != p->seed && (p->worst < 0 || sl_vsa_error(vsa, i, p) > sl_vsa_error(vsa, p->worst, p))) {
            p->worst = i;
        }
    }
}

/* Marks a region whose worst fitting node is wanted. */
static void mark(sl_vsa_proxy *p)
{
    p->marked = true;
    p->worst = -1;
}

void sl_vsa_split_off(sl_vsa *vsa, int32_t worst, int32_t label)
{
    mark(&vsa->proxy[worst]);
    find_worst_nodes(vsa);
    vsa->proxy[worst].marked = false;
    start_region(vsa, label, vsa->proxy[worst].worst);
}

sl_status sl_vsa_insert(sl_vsa *vsa, int32_t wanted, int32_t *inserted)
{
    const int32_t before = vsa->count;
    const sl_status status = reserve_proxies(vsa, before + wanted);
    *inserted = 0;
    if (status != SL_OK) {
        return status;
    }
    for (int32_t k = 0, worst = 0; k < wanted && (worst = sl_vsa_worst(vsa, -1, -1)) >= 0; k++) {
        mark(&vsa->proxy[worst]);
    }
    find_worst_nodes(vsa);
    for (int32_t r = 0; r < before; r++) {
        if (vsa->proxy[r].marked) {
            vsa->proxy[r].marked = false;
            start_region(vsa, vsa->count++, vsa->proxy[r].worst);
        }
    }
    *inserted = vsa->count - before;
    return SL_OK;
}

/* No more regions than this. */
static int32_t most_regions(const sl_vsa_def *def)
{
    const int32_t most = def->regions > 0 && def->regions < def->most ? def->regions : def->most;
    return most < LEAST_REGIONS ? LEAST_REGIONS : most;
}

/* Regions to be added next, 0 = there are enough. */
static int32_t missing(const sl_vsa *vsa, const sl_vsa_def *def)
{
    const int32_t room = most_regions(def) - vsa->count, batch = vsa->count < BATCH ? 1 : vsa->count / BATCH;
    const bool fits = def->regions <= 0 && vsa->energy <= def->error * vsa->total;
    return fits && vsa->count >= LEAST_REGIONS ? 0 : batch < room ? batch : room;
}

/* Adds regions batch by batch, each followed by one sweep, until there are enough. */
static sl_status add_regions(sl_vsa *vsa, const sl_vsa_def *def, const sl_context *context)
{
    sl_status status = SL_OK;
    int32_t inserted = 1;
    while (inserted > 0 && missing(vsa, def) > 0) {
        SL_TRY(sl_vsa_insert(vsa, missing(vsa, def), &inserted));
        sl_vsa_fit(vsa);
        sl_vsa_reseed(vsa);
        sl_vsa_grow(vsa);
        SL_TRY(sl_report_progress(context, "proxies", (double)vsa->count / most_regions(def)));
    }
cleanup:
    return status;
}

/**
 * Partitions a surface into regions that are nearly plane.
 *
 *     minimise the sum over regions of E(f, N of the region)
 *
 * Regions are added where the error is largest, grown from their seeds, fitted, and moved while that helps; by error,
 * neighbours are merged as long as the bound holds.
 *
 * @param[in]  surface  connected, at least one node
 * @param[in]  def
 * @param[in]  context  nullable
 * @param[out] region   n: connected regions, numbered from 0
 * @param[out] count    at least 2 where there are two nodes
 * @param[out] error    energy over area; at most def->error by error, unless def->most stopped it or the facets
 *                      themselves are not plane
 *
 * SL_OUT_OF_MEMORY, SL_CANCELLED. O((n + edges) log n) a sweep. Serial: the same bytes for any number of threads.
 * Source: Cohen-Steiner, Alliez, Desbrun 2004, "Variational shape approximation".
 * Deviations: the start is incremental rather than random; the metric is exact for facets that are not plane; sweeps
 * that do not lower the energy are taken back.
 */
sl_status sl_vsa_partition(const sl_vsa_surface *surface, const sl_vsa_def *def, const sl_context *context,
                           int32_t *region, int32_t *count, double *error)
{
    sl_status status = SL_OK;
    sl_vsa vsa = {0};
    SL_TRY(sl_vsa_create(surface, &vsa));
    SL_TRY(add_regions(&vsa, def, context));
    SL_TRY(sl_vsa_relax(&vsa, context));
    SL_TRY(sl_report_progress(context, "proxies", 1.0));
    SL_TRY(sl_vsa_teleport(&vsa, context));
    if (def->regions <= 0) {
        SL_TRY(sl_vsa_merge_within(&vsa, def->error * vsa.total, LEAST_REGIONS));
    }
    for (int32_t i = 0; i < surface->graph->n; i++) {
        region[i] = vsa.region[i];
    }
    *count = vsa.count;
    if (error != NULL) {
        *error = vsa.total > 0.0 ? vsa.energy / vsa.total : 0.0;
    }
cleanup:
    sl_vsa_clear(&vsa);
    return status;
}
