/* One step of a session: a typed action, and the line of JSON that says the same.
 * Layer: edit (may include atlas, render and all below). */
#ifndef SL_EDIT_ACTION_H
#define SL_EDIT_ACTION_H

#include "base/status.h"

/* Elements are named by input numbers, counted from 0: a corner by [vertex, facet], the side of an edge by
 * [vertex, vertex, facet], a chart by any of its facets. What a line says, field by field:
 *
 *     {"do":"open","start":"automatic","symmetry":true,"stretch":1.5,"resolution":2048,"margin":4}
 *     {"do":"delete-seam","at":[v,w,f]}           sews the whole arc of seam that the edge is part of
 *     {"do":"cut-path","vertices":[v,w,...]}      cuts the shortest path from each vertex to the next
 *     {"do":"cut-loop","at":[v,w,f]}              cuts the edge loop through an edge
 *     {"do":"cut-edges","edges":[[v,w],...]}
 *     {"do":"sew","at":[v,w,f],"to":x}            zips from v over w on along the seam: to vertex x,
 *     {"do":"sew","at":[v,w,f],"length":l}        by a length in input units, or (neither) to the arc's end
 *     {"do":"unsew","at":[v,w,f],"to":x}          opens from v over w on: along what was seam before, else straight on
 *     {"do":"cut-chart","facet":f}                in two, by a nodal line of the facet graph
 *     {"do":"merge","facets":[f,g]}               sews the longest arc between two charts
 *     {"do":"angle","corner":[v,f],"degrees":d}   of the chart at a border vertex
 *     {"do":"straighten","path":[[v,f],...]}      a path of edges, inside or on the border; where two paths meet in
 *                                                 a vertex they cross evenly
 *     {"do":"straighten-border","ends":[[v,f],[v,f]]}  the border between, walked with the chart on its left
 *     {"do":"rectangle","corners":[[v,f],...]}    a border polygon of equal angles, three corners or more
 *     {"do":"right","corner":[v,f]}               lines and border meet at right angles there
 *     {"do":"drop","constraint":id}               constraints and pins are numbered from 1 as they are made
 *     {"do":"pin","corner":[v,f],"uv":[x,y]}      at most two a chart
 *     {"do":"move","facet":f,"by":[x,y]}          the chart, on the page
 *     {"do":"rotate","facet":f,"degrees":d}       about the centre of its box
 *     {"do":"scale","facet":f,"factor":k}
 *     {"do":"symmetry","facet":f,"on":false}      the chart's copies (or itself, if it is one) get UVs of their own
 *     {"do":"symmetry","facet":f,"on":true,"corners":[[v,f],[w,g]],"mirrored":true}   what corresponds to the chart,
 *                                                 [w,g] to [v,f], is cut like it and shares its UVs
 *     {"do":"pack","resolution":2048,"margin":4}  all charts at one density; pins are given up
 *     {"do":"undo","steps":1}   {"do":"undo","to":"name"}   {"do":"redo","steps":1}   {"do":"checkpoint","name":"..."}
 */
typedef enum sl_action_kind {
    SL_ACTION_OPEN,
    SL_ACTION_DELETE_SEAM,
    SL_ACTION_CUT_PATH,
    SL_ACTION_CUT_LOOP,
    SL_ACTION_CUT_EDGES,
    SL_ACTION_SEW,
    SL_ACTION_UNSEW,
    SL_ACTION_CUT_CHART,
    SL_ACTION_MERGE,
    SL_ACTION_ANGLE,
    SL_ACTION_STRAIGHTEN,
    SL_ACTION_STRAIGHTEN_BORDER,
    SL_ACTION_RECTANGLE,
    SL_ACTION_RIGHT,
    SL_ACTION_DROP,
    SL_ACTION_PIN,
    SL_ACTION_MOVE,
    SL_ACTION_ROTATE,
    SL_ACTION_SCALE,
    SL_ACTION_SYMMETRY,
    SL_ACTION_PACK,
    SL_ACTION_UNDO,
    SL_ACTION_REDO,
    SL_ACTION_CHECKPOINT,
    SL_ACTION_KINDS
} sl_action_kind;

enum { SL_ACTION_NAME = 64 };

/* Which fields count depends on the kind; those a line may leave out hold the value named here then. */
typedef struct sl_action {
    sl_action_kind kind;
    int32_t count;             /* numbers in item */
    int32_t *item;             /* owned: at, vertices, edges, facets, corner(s), path, ends: the numbers in order */
    int32_t facet;             /* cut-chart, move, rotate, scale, symmetry */
    int32_t to;                /* sew, unsew: -1 = by length or to the end */
    int32_t id;                /* drop */
    int32_t steps;             /* undo, redo: 1 */
    int32_t resolution;        /* open, pack: 2048 */
    double margin;             /* open, pack [texels]: 4 */
    double number;             /* degrees, factor, stretch (1.5); length: 0 = to the end */
    double uv[2];              /* pin: place; move: by */
    bool on;                   /* symmetry (of open: true) */
    bool mirrored;             /* symmetry: true */
    char name[SL_ACTION_NAME]; /* checkpoint, undo to (""), open's start: "automatic" or "uv" */
} sl_action;

/* An action of this kind with its defaults and no items. */
sl_action sl_action_default(sl_action_kind kind);

/* The word after "do". */
const char *sl_action_name(sl_action_kind kind);

/* Copies numbers into action->item (in place of what was there). SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_action_set_items(sl_action *action, int32_t count, const int32_t *item);

/* Parses one line (without its end). Nothing unknown is skipped: SL_BAD_INPUT says what is wrong (diag, nullable; line
 * and file are the caller's). SL_OUT_OF_MEMORY. *out is empty on failure. */
SL_NODISCARD sl_status sl_action_parse(const char *text, int64_t size, sl_action *out, sl_diag *diag);

/* The action's line without its end, terminated; owned by the caller (sl_free). Parsing it gives the same action, bit
 * for bit. NULL when memory is out. */
SL_NODISCARD char *sl_action_format(const sl_action *action);

SL_NODISCARD sl_status sl_action_copy(const sl_action *from, sl_action *out);
void sl_action_clear(sl_action *action); /* frees the items, zeroes the struct */

#endif
