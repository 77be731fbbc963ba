/* The state of a minimiser and the parts it is put together from.
 * Layer: param; private to it. */
#ifndef SL_PARAM_STRETCH_SOLVER_INTERNAL_H
#define SL_PARAM_STRETCH_SOLVER_INTERNAL_H

#include "param/stretch_internal.h"

/* Far from the minimum (4 is isometric) steps are taken from softened rest shapes. */
static const double SL_STRETCH_FAR_ENERGY = 100.0;

struct sl_stretch {
    const sl_patch *patch;
    sl_stretch_def def;
    sl_stretch_info info;
    sl_stretch_store own, *store; /* the workspace's, or its own */
    sl_stretch_freedom freedom;
    double *uv, *trial, *spare, *gradient, *force, *direction; /* 2 nv each, in the store's block */
    int32_t nb;
    int32_t *border; /* nb vertex pairs; NULL unless simple_border */
    double energy;
    bool softened;    /* the next step */
    double soft_gain; /* of the last softened step: share of the energy */
    bool ready;       /* the store's system is this patch's */
    bool done;
};

/* Energy with the springs of the pins, and L2. */
sl_stretch_sums sl_stretch_measure_map(const sl_stretch *s, const double *uv);

/* What is known of the map in s->uv, into s->info. */
void sl_stretch_take_stock(sl_stretch *s, sl_stretch_sums sums);

bool sl_stretch_all_positive(const sl_patch *patch, const double *uv);

/* *simple = the border does not meet itself under uv (or nobody asked). */
SL_NODISCARD sl_status sl_stretch_border_is_simple(const sl_stretch *s, const double *uv, bool *simple);

/* One iteration. Without a step to take s->done is set. */
SL_NODISCARD sl_status sl_stretch_iterate(sl_stretch *s);

static inline void sl_stretch_swap(double **a, double **b)
{
    double *const old = *a;
    *a = *b;
    *b = old;
}

#endif
