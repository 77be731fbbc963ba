/* What the files of this room share: the state of a session as reference-counted pieces that never change once made, so
 * that a change can be taken back by putting the old pieces in place again.
 * Layer: edit (private). */
#ifndef SL_EDIT_SESSION_INTERNAL_H
#define SL_EDIT_SESSION_INTERNAL_H

#include <stdio.h>

#include "edit/session.h"
#include "mesh/patch.h"
#include "param/sectors.h"

/* A laid-out chart. */
typedef struct sl_edit_chart {
    int32_t refs;
    int32_t nface, ncorner;
    int32_t *face;   /* ascending */
    double *uv;      /* 2 ncorner, facet by facet: its own frame, area = 3D area of the normalised mesh */
    uint8_t *red;    /* nface */
    double *stretch; /* nface */
    int32_t nred;
    int32_t iterations;
    bool kept; /* UVs of the input: uv is the page's then, of any area */
    sl_flatten_result flat;
} sl_edit_chart;

/* Which corner each corner of a copy takes its UVs from. */
typedef struct sl_edit_map {
    int32_t refs;
    int32_t count;
    int32_t *from; /* count: mesh halfedges, in the order of the copy's corners */
} sl_edit_map;

/* A place for a chart; chart NULL = empty. */
typedef struct sl_edit_slot {
    sl_edit_chart *chart;
    sl_edit_map *map; /* of a copy */
    int32_t copy_of;  /* slot, itself no copy; -1 = none */
    bool mirrored;
    sl_symmetry_kind kind;
    double scale, angle, offset[2];
} sl_edit_slot;

/* What the user asked of a chart. Corners are mesh halfedges. */
typedef struct sl_edit_wish {
    int32_t refs;
    int32_t id;
    sl_action_kind kind;
    int32_t count;
    int32_t *corner; /* count */
    int32_t *fan;    /* 2 count: lowest halfedge and number of the facets around each vertex in its chart */
    double degrees, uv[2];
} sl_edit_wish;

typedef struct sl_edit_wishes {
    int32_t refs;
    int32_t count;
    sl_edit_wish **wish;
} sl_edit_wishes;

/* bits of an edge */
enum {
    SL_EDGE_CUT = 1,
    SL_EDGE_SCAR = 2 /* a seam was here: where unsewing goes on */
};

typedef struct sl_edge_change {
    int32_t halfedge;
    uint8_t before, after;
} sl_edge_change;

typedef struct sl_slot_change {
    int32_t slot;
    sl_edit_slot before, after; /* both own what they refer to */
} sl_slot_change;

/* All that one action changed. */
typedef struct sl_change {
    char *line; /* the action; NULL for a drag */
    char checkpoint[SL_ACTION_NAME];
    sl_edge_change *edge;
    int64_t edges, edge_room;
    sl_slot_change *slot;
    int64_t slots, slot_room;
    sl_edit_wishes *wishes_before, *wishes_after;
    int32_t id_before, id_after;
} sl_change;

struct sl_session {
    sl_atlas *base; /* the atlas it began with: owns mesh and triangulation */
    sl_mesh *mesh;  /* base's */
    sl_atlas_def def;
    sl_action open;
    uint8_t *scar; /* nh, both halfedges of an edge alike */
    int32_t slots;
    int64_t slot_room;
    sl_edit_slot *slot;
    sl_edit_wishes *wishes;
    int32_t next_id;
    /* derived from the slots */
    double *corner_uv;
    int32_t *face_chart;
    uint8_t *red;
    double *stretch;
    int64_t revision;
    /* history */
    sl_change *history;
    int64_t history_room;
    int32_t entries, cursor;
    char **line;
    int64_t line_room;
    int32_t lines;
    FILE *log;
    /* the change under way, or a drag's */
    sl_change open_change;
    bool changing, dragging, quick;
    struct sl_edit_grip *grip; /* of a drag */
    /* what the last change did */
    int32_t *changed;
    int64_t changed_room;
    int32_t changes;
    char (*note)[192];
    int64_t note_room;
    int32_t notes;
    /* scratch */
    int32_t *face_mark;   /* nf, -1 between uses */
    int32_t *corner_mark; /* nh, -1 between uses */
};

/* --- pieces (piece.c) */

/* From the patch of the chart and UVs of its vertices. faces: ascending, copied. mirrored: its triangles are meant to
 * have negative area. flat: method and info of the solver; certificate and distortion are measured here. */
SL_NODISCARD sl_status sl_edit_chart_create(sl_session *s, const sl_patch *patch, const int32_t *faces, int32_t nfaces,
                                            const double *uv, bool mirrored, const sl_flatten_result *flat,
                                            const sl_context *context, sl_edit_chart **out);
void sl_edit_chart_release(sl_edit_chart *chart);
void sl_edit_map_release(sl_edit_map *map);
void sl_edit_slot_clear(sl_edit_slot *slot);
sl_edit_slot sl_edit_slot_share(const sl_edit_slot *slot); /* one more reference to all it has */
void sl_edit_wish_release(sl_edit_wish *wish);
void sl_edit_wishes_release(sl_edit_wishes *wishes);

/* A list that lacks entry `without` (-1 = none) and has `with` (nullable, taken over also on failure) at its end. */
SL_NODISCARD sl_status sl_edit_wishes_edit(const sl_edit_wishes *from, int32_t without, sl_edit_wish *with,
                                           sl_edit_wishes **out);

/* UVs on the page of a slot's corners, in the order of its chart's; uv: 2 ncorner. */
void sl_edit_slot_place(const sl_edit_slot *slot, double *uv);

/* --- the change under way (change.c); everything done through these can be taken back */

SL_NODISCARD sl_status sl_change_set_edge(sl_session *s, int32_t halfedge, bool cut);

/* Takes the slot's contents over, also on failure. index may be s->slots: one more slot. */
SL_NODISCARD sl_status sl_change_set_slot(sl_session *s, int32_t index, sl_edit_slot *slot);

void sl_change_set_wishes(sl_session *s, sl_edit_wishes *wishes); /* takes the list over */

void sl_change_begin(sl_session *s);

/* Derives page UVs and the like for the slots changed. On failure roll back. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_change_show(sl_session *s);

/* To before sl_change_begin; shown: sl_change_show has been called since. SL_OUT_OF_MEMORY: derived arrays are stale.
 */
SL_NODISCARD sl_status sl_change_roll_back(sl_session *s, bool shown);

/* Of history: back, and forth again. SL_OUT_OF_MEMORY: derived arrays are stale. */
SL_NODISCARD sl_status sl_change_undo(sl_session *s, const sl_change *change);
SL_NODISCARD sl_status sl_change_redo(sl_session *s, const sl_change *change);
void sl_change_clear(sl_change *change);

SL_NODISCARD sl_status sl_edit_derive_all(sl_session *s);

/* Fills the slots from s->base (begin.c). corner_uv: the input's, where these are what it begins with. */
SL_NODISCARD sl_status sl_edit_take_charts(sl_session *s, const double *corner_uv, const sl_context *context);

int32_t sl_edit_empty_slot(const sl_session *s); /* the lowest, or s->slots */
void sl_edit_note(sl_session *s, const char *format, ...) SL_PRINTF(2, 3);

/* --- solving (solve.c) */

/* Lays the facets flat as one chart with these wishes (pins are no business of the solver's), starting from the angles
 * that the page's UVs have now. SL_INFEASIBLE with the reason: no disk, wishes that cannot be met, no layout without
 * flips. */
SL_NODISCARD sl_status sl_edit_solve(sl_session *s, const int32_t *faces, int32_t nfaces, int32_t nwish,
                                     sl_edit_wish *const *wish, const sl_context *context, sl_edit_chart **out,
                                     sl_diag *diag);

/* Do the wishes name vertices of the patch as they should, and does the table follow? */
SL_NODISCARD sl_status sl_edit_compile(sl_session *s, const sl_patch *patch, int32_t nwish, sl_edit_wish *const *wish,
                                       sl_sector_table *out, sl_diag *diag);

/* Angles that the triangles of the patch have on the page now (3 nt); NaN where a triangle has none. */
void sl_edit_page_angles(const sl_session *s, const sl_patch *patch, double *angle);

enum { SL_EDIT_QUICK_STEPS = 2 }; /* paper, Sec. 4.2: iterations while the mouse moves */

/* One move of a drag of wishes (grip.c): two Newton steps of the solver kept from the move before. *out = NULL where
 * they lead to no valid layout. Statuses as of sl_edit_solve. */
SL_NODISCARD sl_status sl_edit_grip_solve(sl_session *s, const int32_t *faces, int32_t nfaces, int32_t nwish,
                                          sl_edit_wish *const *wish, const sl_context *context, sl_edit_chart **out,
                                          sl_diag *diag);
void sl_edit_grip_release(sl_session *s);

/* --- regrouping (regroup.c) */

/* After edges changed in the charts of the slots listed: the facets of these are charts anew, wishes are kept where
 * they can be, placements follow the larger part. */
SL_NODISCARD sl_status sl_edit_regroup(sl_session *s, const sl_context *context, sl_diag *diag);

/* Solves the chart in a slot again, with the wishes that the session has now. Copies follow. */
SL_NODISCARD sl_status sl_edit_resolve(sl_session *s, int32_t slot, const sl_context *context, sl_diag *diag);

/* Rotation and offset of `slot` that carry its chart nearest to where its corners are on the page now; only corners of
 * facets of slot `reference` count (-1 = all). */
void sl_edit_align(const sl_session *s, sl_edit_slot *slot, int32_t reference);

/* Puts the chart's pins in their places: translation, or similarity. SL_INFEASIBLE. */
SL_NODISCARD sl_status sl_edit_apply_pins(const sl_session *s, sl_edit_slot *slot, sl_diag *diag);

/* What slot->scale would be for the same density on the page if the chart's own area were its 3D area. */
double sl_edit_density(const sl_edit_slot *slot);

/* Where a mesh corner's UVs stand in chart->uv, -1 = in another chart. O(facets). */
int32_t sl_edit_corner_place(const sl_session *s, const sl_edit_chart *chart, int32_t h);

/* The slot's chart and its copies get another place (scale, angle, offset); they themselves are the same. */
SL_NODISCARD sl_status sl_edit_move_slot(sl_session *s, int32_t index, const sl_edit_slot *place);

/* Gathers the chart of a copy from the one it shows. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_edit_follow(sl_session *s, const sl_edit_slot *shown, sl_edit_slot *copy,
                                      const sl_context *context);

/* Copies of the slot, or the slot if it is one, stand alone from now on. */
SL_NODISCARD sl_status sl_edit_unshare(sl_session *s, int32_t slot);

/* --- walking (walk.c) */

int32_t sl_edit_border_next(const sl_mesh *mesh, int32_t h); /* border or seam halfedge after one, in its chart */
int32_t sl_edit_border_previous(const sl_mesh *mesh, int32_t h);
int32_t sl_edit_arc_next(const sl_mesh *mesh, int32_t h); /* along the arc of seam, -1 = the arc ends at h's target */
/* Lowest halfedge and number of facets of the fan of h's origin in its chart. */
void sl_edit_fan(const sl_mesh *mesh, int32_t h, int32_t fan[2]);
/* Halfedge of a side [v, w, facet] as an action names it, leaving v; SL_BAD_INPUT. */
SL_NODISCARD sl_status sl_edit_take_side(const sl_session *s, const int32_t *name, int32_t *h, sl_diag *diag);

/* --- the actions, a function each; the change is begun, and rolled back by the caller on failure */

typedef sl_status sl_edit_do(sl_session *s, const sl_action *a, const sl_context *context, sl_diag *diag);
sl_edit_do sl_do_delete_seam, sl_do_cut_path, sl_do_cut_loop, sl_do_cut_edges, sl_do_sew, sl_do_unsew, sl_do_cut_chart,
    sl_do_merge, sl_do_wish, sl_do_drop, sl_do_move, sl_do_rotate, sl_do_scale, sl_do_symmetry, sl_do_pack;

#endif
