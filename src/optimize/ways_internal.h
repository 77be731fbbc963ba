/* Cheapest ways along edges that pay for turning.
 * Layer: optimize (private). */
#ifndef SL_OPTIMIZE_WAYS_INTERNAL_H
#define SL_OPTIMIZE_WAYS_INTERNAL_H

#include "optimize/optimize_internal.h"

/* Distances are kept for halfedges, since what going on costs depends on where the way comes from. */
typedef struct sl_opt_ways {
    const sl_opt_state *state; /* borrowed */
    uint8_t *taken;            /* nv: vertices that no way may pass: those of seams and of the border, at first */
    double *angle;             /* 3 nt: of the corners */
    double turn;               /* price of a right angle; 0 where length alone counts */
    double least;              /* cost over length of the cheapest edge */
    double *distance;          /* 3 nt: up to the end of a halfedge */
    int32_t *parent;           /* 3 nt */
    uint8_t *settled;          /* 3 nt */
    int32_t *touched, ntouched;
    struct sl_opt_way_entry *heap;
    int64_t size, capacity;
} sl_opt_ways;

/* SL_OUT_OF_MEMORY: to be cleared all the same. */
SL_NODISCARD sl_status sl_opt_ways_init(const sl_opt_state *state, sl_opt_ways *out);
void sl_opt_ways_clear(sl_opt_ways *ways);

/* Cost of the n halfedges of a way, one after another, its turns included; all inner vertices lie inside the surface.
 */
double sl_opt_way_cost(const sl_opt_ways *ways, const int32_t *way, int32_t n);

/* The cheapest way between the ends of old[0 .. nold - 1], inside the two charts and no farther than `reach` from old's
 * vertices, that costs less than bound; neither end need be free. way: 3 nt at most; *n = 0 where there is none.
 * SL_OUT_OF_MEMORY. O(3 nt log nt), in practice what lies nearer than the bound. */
SL_NODISCARD sl_status sl_opt_way_find(sl_opt_ways *ways, const int32_t *old, int32_t nold, double reach,
                                       const int32_t chart[2], double bound, int32_t *way, int32_t *n);

#endif
