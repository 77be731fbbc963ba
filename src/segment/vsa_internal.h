/* Variational shape approximation: regions of a surface, each with the normal that fits it best.
 *
 *     E(f, N) = integral over f of |n - N|^2 = 2 (A - |V|) + |V| |V / |V| - N|^2
 *
 * A is the area of facet f and V its vector area, so that the metric is exact for polygons that are not plane and for
 * nodes of several facets; a region's best proxy is N = sum V / |sum V|.
 * Source: Cohen-Steiner, Alliez, Desbrun 2004, "Variational shape approximation" (L2,1 metric).
 * Layer: segment (private). */
#ifndef SL_SEGMENT_VSA_INTERNAL_H
#define SL_SEGMENT_VSA_INTERNAL_H

#include "base/context.h"
#include "graph/csr.h"

/* What is to be approximated; borrowed. */
typedef struct sl_vsa_surface {
    const sl_graph *graph; /* n nodes, connected */
    const double *area;    /* n */
    const double *vector;  /* n x 3: vector areas */
} sl_vsa_surface;

typedef struct sl_vsa_heap_entry {
    double key;
    int32_t order; /* of insertion: equal keys come out first in, first out, so that flat regions grow evenly */
    int32_t node, region;
} sl_vsa_heap_entry;

/* A smallest-first queue; key ties by order. */
typedef struct sl_vsa_heap {
    int64_t count;
    sl_vsa_heap_entry *entry; /* room for every entry of the adjacency */
} sl_vsa_heap;

void sl_vsa_heap_push(sl_vsa_heap *heap, sl_vsa_heap_entry entry);
sl_vsa_heap_entry sl_vsa_heap_pop(sl_vsa_heap *heap);

/* One region. */
typedef struct sl_vsa_proxy {
    double normal[3];
    double sum[3]; /* of vector areas */
    double area, error;
    int32_t seed, nodes;
    bool marked;   /* for a moment: its worst fitting node is looked for */
    int32_t worst; /* that node */
} sl_vsa_proxy;

/* A partition on its way. */
typedef struct sl_vsa {
    sl_vsa_surface surface;
    double *unit;    /* n x 3: V / |V|, 0 where there is none */
    double *weight;  /* n: |V| */
    double *excess;  /* n: 2 (A - |V|), what no proxy can fit */
    double total;    /* area */
    int32_t *region; /* n */
    int32_t count;   /* regions */
    int64_t capacity, kept_capacity;
    sl_vsa_proxy *proxy;      /* count */
    double energy;            /* sum of the errors */
    int32_t *kept;            /* n: the best partition while another is tried ... */
    sl_vsa_proxy *kept_proxy; /* ... and its proxies */
    sl_vsa_heap heap;
} sl_vsa;

/* One region, everything in it. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_vsa_create(const sl_vsa_surface *surface, sl_vsa *vsa);
void sl_vsa_clear(sl_vsa *vsa);

/* E(node, proxy). */
double sl_vsa_error(const sl_vsa *vsa, int32_t node, const sl_vsa_proxy *proxy);

/* Best proxies of the regions as they are, their errors, the energy. */
void sl_vsa_fit(sl_vsa *vsa);

/* Regions grown from the seeds: of all nodes next to a region the one that fits it best comes next. Then fits. Every
 * region stays connected and keeps its seed. */
void sl_vsa_grow(sl_vsa *vsa);

/* Seeds of the next growth: in each region the node that fits best. */
void sl_vsa_reseed(sl_vsa *vsa);

/* Reseeds and grows while that lowers the energy; ends with the best partition seen, fitted. SL_CANCELLED. */
SL_NODISCARD sl_status sl_vsa_relax(sl_vsa *vsa, const sl_context *context);

/* Adds up to `wanted` regions, each in another of those with the largest errors and more than one node, at the node
 * that fits worst. *inserted = how many. To be fitted and grown. SL_OUT_OF_MEMORY. O(nodes + wanted * regions). */
SL_NODISCARD sl_status sl_vsa_insert(sl_vsa *vsa, int32_t wanted, int32_t *inserted);

/* Gives region `label` of the worst fitting node of region `worst` (two nodes or more) as its seed and only node. */
void sl_vsa_split_off(sl_vsa *vsa, int32_t worst, int32_t label);

/* The region of the largest error with more than one node, other than a and b; -1 = none. */
int32_t sl_vsa_worst(const sl_vsa *vsa, int32_t a, int32_t b);

/* The two adjacent regions whose union costs least, and by how much the energy rises; a < b, -1 = one region only.
 * SL_OUT_OF_MEMORY. O(nodes + edges + borders log borders). */
SL_NODISCARD sl_status sl_vsa_cheapest_merge(const sl_vsa *vsa, int32_t *a, int32_t *b, double *cost);

/* Merges the cheapest pairs while the energy stays within `bound` and more than `least` regions are left.
 * SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_vsa_merge_within(sl_vsa *vsa, double bound, int32_t least);

/* Moves regions: the two cheapest to merge are merged and the worst is split, while that lowers the energy.
 * SL_OUT_OF_MEMORY, SL_CANCELLED. */
SL_NODISCARD sl_status sl_vsa_teleport(sl_vsa *vsa, const sl_context *context);

/* How many regions. */
typedef struct sl_vsa_def {
    int32_t regions; /* exactly so many (as far as there are nodes); 0 = by error */
    double error;    /* energy over area below which no region is added */
    int32_t most;    /* never more (but two) */
} sl_vsa_def;

/* Partitions into at least two regions; region: n, numbered from 0. *count, *error = energy over area (nullable).
 * SL_OUT_OF_MEMORY, SL_CANCELLED. */
SL_NODISCARD sl_status sl_vsa_partition(const sl_vsa_surface *surface, const sl_vsa_def *def, const sl_context *context,
                                        int32_t *region, int32_t *count, double *error);

#endif
