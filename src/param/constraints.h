/* What a user asks of a flat chart, and the vertex sectors that make ABF++ do it: angles, straight lines, right angles,
 * pins (paper, Sec. 4.2).
 * Layer: param. */
#ifndef SL_PARAM_CONSTRAINTS_H
#define SL_PARAM_CONSTRAINTS_H

#include "param/sectors.h"

typedef enum sl_constraint_kind {
    SL_CONSTRAINT_ANGLE,    /* the planar angle of the chart at border vertex vertex[0] is `angle` */
    SL_CONSTRAINT_STRAIGHT, /* the open path of edges vertex[0], ..., vertex[count - 1] is straight; inside, on the
                               border or both */
    SL_CONSTRAINT_BORDER,   /* the border from vertex[0] to vertex[1] is straight, walked with the chart on its left */
    SL_CONSTRAINT_POLYGON,  /* the border is a polygon with corners at the border vertices vertex[], count >= 3, in
                               border  order, either way; each corner's angle is `angle`, 0 = (count - 2) pi / count:
                               four  corners  make a rectangle */
    SL_CONSTRAINT_RIGHT /* lines (and the border) meet at right angles at vertex[0]. At a border vertex without lines
                           its angle is pi/2: seams that cross between charts */
} sl_constraint_kind;

/* Where a line passes through a vertex, others meet it evenly without being asked: two lines cross in four sectors of
 * pi/2, three in six of pi/3; the end of a line on another one makes sectors of pi, pi/2, pi/2 (a T). Lines that only
 * end at a common vertex make any angles there unless a SL_CONSTRAINT_RIGHT says otherwise. */
typedef struct sl_constraint {
    sl_constraint_kind kind;
    int32_t count;         /* vertices listed */
    const int32_t *vertex; /* patch vertices; borrowed */
    double angle;          /* [rad]; of ANGLE and POLYGON, else unused */
} sl_constraint;

/**
 * The sector table of a list of constraints.
 *
 * Every interior vertex has its turn of 2 pi, divided where lines meet; border vertices have sectors where something is
 * prescribed. No corner is in two sectors. table.origin[s] is the constraint that made sector s (the last one where
 * several did), -1 for the plain turn of an interior vertex; table.vertex[s] its vertex.
 *
 * @param[in]  list count constraints; none gives the table of sl_sectors_interior
 * @param[in]  name nv: what messages call a patch vertex; nullable = its number in the patch
 * @param[out] out  owned by the caller (sl_sectors_clear); empty on failure
 * @param[out] diag names the constraint and the vertices; element = a patch vertex; nullable
 *
 * SL_BAD_INPUT: a vertex out of range, two of a path not joined by an edge, an angle that is not a number, a border
 * vertex asked for where none is. SL_INFEASIBLE: a closed path, a vertex twice on a path, two paths that share an edge,
 * touch without crossing or meet twice, two angles for one sector, and whatever sl_sectors_feasible finds.
 * SL_OUT_OF_MEMORY. O(corners + vertices listed).
 * Source: What you seam is what you get, Sec. 4.2, Eqs. 5 and 6. */
SL_NODISCARD sl_status sl_constraints_compile(const sl_patch *patch, int32_t count, const sl_constraint *list,
                                              const int32_t *name, sl_sector_table *out, sl_diag *diag);

/**
 * Seams that meet at a point of the surface at right angles: what each chart around it takes its share as.
 *
 * Two lines of seams cross where four charts meet: pi/2 in each. Where one ends on the other, three meet: pi/2 in two
 * and pi in the chart that is the widest there on the surface; along a seam two meet: pi in each, which keeps it
 * straight. A chart that comes to the point twice is listed twice, at its two border vertices.
 *
 * @param[in]  count  charts around the point, 2 to 4
 * @param[in]  patch  count of them; borrowed
 * @param[in]  vertex count: the point in patch[k], on its border; borrowed by the constraints
 * @param[out] item   count: item[k] is for patch[k], SL_CONSTRAINT_ANGLE at vertex[k]
 *
 * The charts are then solved one by one. SL_BAD_INPUT: a vertex out of range or not on the border. SL_INFEASIBLE: fewer
 * than two or more than four charts; a chart with fewer triangles there than its share takes (one of pi needs two).
 * diag (nullable): which. Allocates nothing. Source: What you seam is what you get, Sec. 4.2. */
SL_NODISCARD sl_status sl_constraints_cross_seams(int32_t count, const sl_patch *const *patch, const int32_t *vertex,
                                                  sl_constraint *item, sl_diag *diag);

/* How well a layout does what one constraint asks. */
typedef struct sl_constraint_measure {
    double angle; /* largest |planar angle - prescribed| over the sectors it made and, of ANGLE and RIGHT, over those
                     at its vertex [rad] */
    double line;  /* STRAIGHT, BORDER, POLYGON: largest distance of a vertex of a line from the chord between the line's
                     ends, over the diagonal of the chart's box; else 0 */
} sl_constraint_measure;

/* measure: count of them. table: as compiled from the same list. uv: nv x 2. Allocates nothing, cannot fail. */
void sl_constraints_measure(const sl_patch *patch, int32_t count, const sl_constraint *list,
                            const sl_sector_table *table, const double *uv, sl_constraint_measure *measure);

/* A vertex held at a place. */
typedef struct sl_pin {
    int32_t vertex;
    double uv[2];
} sl_pin;

/* Moves a layout to its pins, keeping all angles: none: nothing; one: a translation; two: a similarity (which scales
 * the chart). SL_UNSUPPORTED: more than two, which takes the stretch energy. SL_BAD_INPUT: a vertex out of range, a
 * place that is not finite. SL_INFEASIBLE: one vertex or one place twice, or the two vertices coincide in uv. uv is
 * unchanged on failure. */
SL_NODISCARD sl_status sl_pins_apply(const sl_patch *patch, int32_t count, const sl_pin *pin, double *uv,
                                     sl_diag *diag);

#endif
