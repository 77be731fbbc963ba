/* Shortest paths of a surface that stay near a given line.
 * Layer: optimize (private). */
#ifndef SL_OPTIMIZE_NEAR_PATH_INTERNAL_H
#define SL_OPTIMIZE_NEAR_PATH_INTERNAL_H

#include "optimize/optimize_internal.h"

typedef struct sl_near_heap {
    double distance;
    int32_t vertex;
} sl_near_heap;

/* Work for one search after another. */
typedef struct sl_near_path {
    const sl_opt_surface *surface; /* borrowed */
    uint8_t *taken;                /* nv: no path may run through it; the caller's to set */
    int32_t *line, nline;          /* the line at hand, as vertices of the surface; the caller's to set */
    double width;                  /* of the corridor: at this distance from the line an edge costs twice as much */
    int32_t *parent;               /* nv: halfedge that leads to a vertex of the path found */
    double *distance, *off;        /* nv; squared distance from the line over width^2 */
    uint8_t *settled;              /* nv */
    int32_t *touched, ntouched;
    sl_near_heap *heap;
    int64_t size, capacity;
} sl_near_path;

/* most: points that a line may have. SL_OUT_OF_MEMORY: to be cleared all the same. */
SL_NODISCARD sl_status sl_near_path_init(const sl_opt_surface *surface, int32_t most, sl_near_path *out);
void sl_near_path_clear(sl_near_path *path);

/* The cheapest path from the line's first to its last vertex, neither of them on its way, nor taken vertices, nor the
 * surface's border; an edge costs cost (1 + off). Back from the last vertex: h = parent[v], then v = origin of h.
 * *cost = the path's cost without the corridor's part, HUGE_VAL where there is none. O(k log k) for the k vertices
 * nearer than the end. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_near_path_find(sl_near_path *path, double *cost);

#endif
