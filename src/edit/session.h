/* An atlas held in hand: charts are cut, sewn, bent and moved by actions, each of which leaves every facet in one disk
 * chart with finite UVs and no flip, or is refused and changes nothing. Paper, Sec. 2.3.
 * Layer: edit. */
#ifndef SL_EDIT_SESSION_H
#define SL_EDIT_SESSION_H

#include "atlas/atlas.h"
#include "edit/action.h"

typedef struct sl_session sl_session; /* opaque */

/* Opens a session on a mesh. open: an action of kind SL_ACTION_OPEN: an automatic atlas (sl_unwrap), or the input's
 * UVs kept as they are (start "uv"; corner_uv 2 per input corner, borrowed for the call; charts of them that are no
 * flip-free disks are laid flat anew, and noted). def: nullable; what the action does not say (sl_atlas_default()).
 * SL_BAD_INPUT, SL_INFEASIBLE, SL_LIMIT, SL_OUT_OF_MEMORY, SL_CANCELLED as sl_unwrap; diag is nullable. */
SL_NODISCARD sl_status sl_session_create(const sl_polygons *polygons, const double *corner_uv, const sl_action *open,
                                         const sl_atlas_def *def, const sl_context *context, sl_session **out,
                                         sl_diag *diag);
void sl_session_free(sl_session *session); /* NULL is a no-op */

/**
 * Applies one action and logs it.
 *
 * After SL_OK: sl_session_changed and sl_session_note tell what became of it, the revision has grown. On any other
 * status the session is as it was, nothing is logged and diag (nullable) says why:
 * SL_BAD_INPUT (an element that is not there, an edge that is no seam where one is asked for), SL_INFEASIBLE (a chart
 * would stop being a disk, or the constraints contradict one another or cannot be reached; nothing to undo or redo),
 * SL_IO (the log could not be written: the action is taken back), SL_OUT_OF_MEMORY, SL_CANCELLED, SL_INTERNAL.
 *
 * Overlap and stretch are never a reason to refuse. Same bytes for any number of threads. Pointers change in O(edges of
 * the action); only the charts touched are solved again, from the angles they had. */
SL_NODISCARD sl_status sl_session_apply(sl_session *session, const sl_action *action, const sl_context *context,
                                        sl_diag *diag);

/* Dragging: each move shows the state that its action gives when applied to the state before the drag, found with two
 * iterations where that gives a valid layout; nothing is logged. Release applies its action in full and logs it:
 * exactly what sl_session_apply would have done without the drag. A move that is refused (statuses as of
 * sl_session_apply) leaves what the last one showed; a release that is refused goes back to before the drag. A drag
 * begins with its first move; sl_session_cancel_drag ends it without a trace, as does any sl_session_apply. */
SL_NODISCARD sl_status sl_session_drag(sl_session *session, const sl_action *action, const sl_context *context,
                                       sl_diag *diag);
SL_NODISCARD sl_status sl_session_release(sl_session *session, const sl_action *action, const sl_context *context,
                                          sl_diag *diag);
void sl_session_cancel_drag(sl_session *session);
bool sl_session_dragging(const sl_session *session);

/* --- what is there: all borrowed, valid until the next change of the session */

int64_t sl_session_revision(const sl_session *session);    /* grows with every change, drags and undo included */
const sl_mesh *sl_session_mesh(const sl_session *session); /* seams are its sew pointers (sl_atlas_seams) */
const sl_triangulation *sl_session_triangulation(const sl_session *session);
const double *sl_session_corner_uv(const sl_session *session);   /* nh x 2, on the page, by mesh halfedge */
const int32_t *sl_session_face_chart(const sl_session *session); /* nf: slot of a facet's chart */
const uint8_t *sl_session_red(const sl_session *session);        /* nf: 1 = overlaps another facet of its chart */
const double *sl_session_stretch(const sl_session *session);     /* nf: L2 stretch of a facet, 1 = none; perhaps inf */

/* red: nf, 1 for facets that overlap any other on the page, charts and copies apart from one another (a copy and what
 * it copies share on purpose). *count of them. Only charts whose boxes meet are looked at. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_session_page_red(const sl_session *session, const sl_context *context, uint8_t *red,
                                           int32_t *count);

/* Charts live in slots 0 .. sl_session_slots - 1; a slot keeps its chart's number while that lives. */
int32_t sl_session_slots(const sl_session *session);

typedef struct sl_session_chart {
    int32_t faces;            /* 0: the slot is empty, the rest has no meaning */
    const int32_t *face;      /* ascending */
    int32_t copy_of;          /* slot whose UVs it shares, -1 = its own */
    bool mirrored;            /* a copy, turned over */
    sl_flatten_method method; /* a fallback where it is neither ABF++ nor planar nor the automatic atlas's own */
    bool minimised;           /* and its stretch was minimised */
    bool embedded;            /* proven not to overlap itself */
    int32_t red;              /* facets of it that overlap others of it */
    sl_distortion distortion;
    int32_t constraints;
    int32_t iterations;             /* of the solver, when it was last solved */
    double scale, angle, offset[2]; /* page uv = scale * R(angle) * own uv + offset */
    double low[2], high[2];         /* its box on the page */
} sl_session_chart;

void sl_session_chart_info(const sl_session *session, int32_t slot, sl_session_chart *out);

typedef struct sl_session_constraint {
    int32_t id;
    sl_action_kind kind; /* SL_ACTION_ANGLE, _STRAIGHTEN, _RECTANGLE, _RIGHT or _PIN */
    int32_t count;
    const int32_t *corner; /* mesh halfedges: one at each vertex, in the constraint's order */
    double degrees;        /* ANGLE */
    double uv[2];          /* PIN */
    int32_t slot;          /* of the chart */
} sl_session_constraint;

int32_t sl_session_constraints(const sl_session *session);
void sl_session_constraint_at(const sl_session *session, int32_t index, sl_session_constraint *out);

/* The edges of a path that is straight: mesh halfedges in order, one an edge; none for other kinds. *halfedge owned by
 * the caller (sl_free). SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_session_constraint_edges(const sl_session *session, int32_t index, int32_t **halfedge,
                                                   int32_t *count);

/* What the last change (action, undo, drag) did: slots that are not what they were, and sentences for the user:
 * constraints that could not survive, charts laid flat by a fallback, copies that share no more. */
const int32_t *sl_session_changed(const sl_session *session, int32_t *count);
int32_t sl_session_notes(const sl_session *session);
const char *sl_session_note(const sl_session *session, int32_t index);

/* Pieces for the page's tools. The planar angle [degrees] of the chart at a corner's vertex; NAN inside. */
double sl_session_planar_angle(const sl_session *session, int32_t halfedge);

/* The arc of seam through a seam edge: its halfedges in walking order, each with its chart on the left; *halfedge owned
 * by the caller (sl_free). SL_BAD_INPUT (no seam), SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_session_arc(const sl_session *session, int32_t halfedge, int32_t **arc, int32_t *count);

/* Mesh halfedge of a corner [vertex, facet], of a side [v, w, facet] (either direction of v, w); -1 = not there. And
 * back. */
int32_t sl_session_find_corner(const sl_session *session, int32_t vertex, int32_t facet);
int32_t sl_session_find_side(const sl_session *session, int32_t v, int32_t w, int32_t facet);
void sl_session_name_corner(const sl_session *session, int32_t halfedge, int32_t name[2]);
void sl_session_name_side(const sl_session *session, int32_t halfedge, int32_t name[3]);

/* --- history: the actions behind the present state and those that redo would bring back */

int32_t sl_session_history(const sl_session *session, int32_t *cursor); /* entries; cursor of them are done */
const char *sl_session_history_line(const sl_session *session, int32_t index);

/* All lines so far, as the log file has them, open first (undo and redo are lines too). */
int32_t sl_session_lines(const sl_session *session);
const char *sl_session_line(const sl_session *session, int32_t index);

/* From now on each line is appended to the file before sl_session_apply returns; the lines so far are written at once.
 * mesh_name goes into the first line. SL_IO, SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_session_log_to(sl_session *session, const char *path, const char *mesh_name, sl_diag *diag);

/* --- out */

/* The atlas as it would be written: UVs quantised, judged (look at check.passed). atlas owned by the caller; its repair
 * report, splits and warnings are those of the session. SL_OUT_OF_MEMORY, SL_BAD_INPUT (a chart was moved so far away
 * that it cannot be judged), SL_CANCELLED. */
SL_NODISCARD sl_status sl_session_export(const sl_session *session, const sl_context *context, sl_atlas **out,
                                         sl_diag *diag);

/* Writes it, and its sidecar beside it (unless path is "-"). SL_CHECK_FAILED: charts overlap and allow_overlap is
 * false; nothing is written. check: nullable. Other statuses as of sl_session_export and sl_meshfile_write. */
struct sl_meshfile;
SL_NODISCARD sl_status sl_session_save(const sl_session *session, const struct sl_meshfile *file, const char *path,
                                       bool allow_overlap, const sl_context *context, sl_atlas_check *check,
                                       sl_diag *diag);

/* A hash (FNV-1a, 64 bits) over page UVs, seams, chart numbers and constraints: two states are the same where it is. */
uint64_t sl_session_hash(const sl_session *session);

#endif
