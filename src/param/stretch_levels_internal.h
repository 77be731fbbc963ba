/* Coarser and coarser meshes of a chart: where the minimiser starts when there is no map yet.
 * Layer: param; private to it and to its tests. */
#ifndef SL_PARAM_STRETCH_LEVELS_INTERNAL_H
#define SL_PARAM_STRETCH_LEVELS_INTERNAL_H

#include "base/status.h"
#include "mesh/patch.h"

enum {
    SL_LEVELS_MAX = 24,
    SL_RING_MAX = 12 /* neighbours of a vertex that is removed */
};

/* One vertex taken out, and its neighbours counter-clockwise. */
typedef struct sl_removal {
    int32_t vertex;
    int32_t count; /* of neighbours */
    int32_t into;  /* which of them it was moved into */
    bool open;     /* it is on the border: no triangle between the last neighbour and the first */
    int64_t first; /* in sl_levels.ring */
} sl_removal;

/* The mesh after so many removals; vertices keep the patch's numbers. */
typedef struct sl_level {
    int32_t removals;
    int32_t nt;
    int32_t *tri, *twin; /* 3 nt, owned */
    double area;
} sl_level;

/* Owned arrays; level[0] is the finest one below the patch itself. */
typedef struct sl_levels {
    int32_t count;
    sl_level level[SL_LEVELS_MAX];
    sl_removal *removal;
    int32_t *ring;
} sl_levels;

/* Half-edge collapses in passes over the mesh, no two neighbours in one pass, the shape and the area of the surface
 * kept as well as may be; a level each time the triangles are down to `share` of the last level's, until fewer than
 * `least` are left or no more vertices can go. Border vertices move along the border. No level is an outcome: count =
 * 0. SL_OUT_OF_MEMORY. Deterministic. About linear. Source: Hoppe 1996, "Progressive meshes"; Dey et al. 1999,
 * "Topology preserving edge contraction" (when a collapse keeps the topology). */
SL_NODISCARD sl_status sl_levels_create(const sl_patch *patch, double share, int32_t least, sl_levels *levels);
void sl_levels_clear(sl_levels *levels);

/* A level as a patch of its own, its vertices numbered in the order of the whole's; vertex[i] (owned by the caller) =
 * the whole's number. corner and facet are the level's own. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_level_patch(const sl_patch *whole, const sl_level *level, sl_patch **out, int32_t **vertex);

/* Puts a vertex back where the stretch energy of its triangles is least, so that none flips: uv[2 vertex] is written.
 * xyz, uv: of all vertices; ring: levels.ring + removal->first. inside: a border vertex stays on the inner side of the
 * edge that stands for it, which keeps a simple border simple. False when doubles have no such place. */
bool sl_stretch_insert(const double *xyz, const sl_removal *removal, const int32_t *ring, double w, bool inside,
                       double *uv);

/* Moves a vertex (its star given like a removal's; not on the border) to where the energy of its star is least, if that
 * is above `limit` a unit of area. Says whether it was. */
bool sl_stretch_settle(const double *xyz, const sl_removal *star_at, const int32_t *ring, double w, double limit,
                       double *uv);

/* sl_stretch_settle of the interior vertices in turn, in a few sweeps. Those whose triangles all have less by a bound
 * are passed over, which changes nothing. uv: finite. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_stretch_settle_all(const sl_patch *patch, double w, double limit, double *uv);

/* Moves the vertices of flipped triangles, and more around them each time, to the mean of their neighbours until none
 * is flipped; with `simple`, border edges that cross are pulled inwards, too. *mended = false where that does not come
 * to an end soon. SL_BAD_INPUT (not finite), SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_stretch_mend(const sl_patch *patch, bool simple, double *uv, bool *mended);

#endif
