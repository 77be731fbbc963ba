/* From constraints to lines, from lines to sectors; internal to the room.
 * Layer: param. */
#ifndef SL_PARAM_CONSTRAINTS_INTERNAL_H
#define SL_PARAM_CONSTRAINTS_INTERNAL_H

#include "param/constraints.h"

/* A line passes or ends at a vertex. Rays are edges that leave the vertex, counted counter-clockwise from its outgoing
 * halfedge: ray i is the first edge of the fan's i-th triangle; at a border vertex of m triangles ray m is the last
 * edge. -1 = the line ends here. */
typedef struct sl_visit {
    int32_t line;
    int32_t ray[2];
} sl_visit;

/* All straight lines of a list of constraints. Line l joins vertex[first[l]] .. vertex[first[l + 1] - 1]; visit[p] is
 * its visit at vertex[p]. The visits at v are at_vertex[vertex_first[v] .. vertex_first[v + 1] - 1], by line. */
typedef struct sl_line_set {
    int32_t count;
    int32_t *first;        /* count + 1 */
    int32_t *origin;       /* count: the constraint a line comes from */
    int32_t *vertex;       /* first[count] */
    sl_visit *visit;       /* first[count] */
    int32_t *vertex_first; /* nv + 1 */
    int32_t *at_vertex;    /* first[count] */
} sl_line_set;

/* What is asked of single vertices. */
typedef struct sl_vertex_wish {
    double *angle;         /* nv: of the chart at a border vertex, NaN = nothing asked */
    int32_t *angle_origin; /* nv */
    int32_t *right_origin; /* nv: the constraint that wants right angles, -1 = none */
} sl_vertex_wish;

/* Messages: the vertices' names, and where they go. */
typedef struct sl_teller {
    const int32_t *name; /* nullable */
    sl_diag *diag;       /* nullable */
} sl_teller;

static inline int32_t sl_name_of(const sl_teller *teller, int32_t vertex)
{
    return teller->name != NULL ? teller->name[vertex] : vertex;
}

/* The statuses are those of sl_constraints_compile. On failure the set is cleared. */
SL_NODISCARD sl_status sl_lines_init(sl_line_set *lines, const sl_patch *patch, int32_t count,
                                     const sl_constraint *list, const sl_teller *teller);
void sl_lines_clear(sl_line_set *lines);

/* Appends the sectors of all vertices. SL_INFEASIBLE, SL_BAD_INPUT, SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_lines_divide(const sl_line_set *lines, const sl_patch *patch, const sl_vertex_wish *wish,
                                       const sl_teller *teller, sl_sector_table *out);

/* The planar angle of each corner of a POLYGON, before anything else of it is looked at. */
static inline double sl_polygon_angle(const sl_constraint *constraint)
{
    const double pi = 3.14159265358979323846;
    return constraint->angle != 0.0 ? constraint->angle : pi * (constraint->count - 2) / constraint->count;
}

/* Border halfedge after h, walked with the chart on the left. */
static inline int32_t sl_border_next(const sl_patch *patch, int32_t h)
{
    return patch->outgoing[patch->tri[sl_corner_next(h)]];
}

#endif
