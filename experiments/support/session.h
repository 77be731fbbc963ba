/* Editing sessions in experiments: what a user would do by hand, done by rules, logged, drawn and replayed.
 * Layer: experiments. */
#ifndef SL_EXPERIMENTS_SESSION_H
#define SL_EXPERIMENTS_SESSION_H

#include "support/claims.h"

/* Charts as the spectral cuts leave them, not sewn together again, each with UVs of its own: more seams than necessary,
 * for the user to remove. */
sl_atlas_def exp_session_def(void);

/* The atlas in numbers. */
typedef struct exp_state {
    int32_t charts, red, constraints; /* red: facets that overlap others of their chart */
    double seam, stretch;             /* seam length over the diagonal; worst L2 */
} exp_state;

exp_state exp_session_state(const sl_session *session);

/* Applies it; false where it was refused. */
bool exp_session_try(exp_run *run, sl_session *session, const sl_action *action);

/* Glues neighbours along their longest common seam, the longest first, as long as nothing overlaps and no chart
 * stretches more than `stretch` (L2): at most `count` times. Returns how many. SL_OUT_OF_MEMORY gives fewer. */
int32_t exp_session_glue(exp_run *run, sl_session *session, int32_t count, double stretch);

/* The same among facets that `of` says yes to, on both sides of the seam. */
typedef bool exp_facet_fn(const sl_mesh *mesh, int32_t facet);
int32_t exp_session_glue_where(exp_run *run, sl_session *session, int32_t count, double stretch, exp_facet_fn *of);

/* Model and atlas as the session shows them. */
SL_NODISCARD sl_status exp_session_draw(exp_run *run, const sl_session *session, const sl_view *view,
                                        const sl_picture *picture, const char *file);

/* Writes OUT/session.jsonl, replays it, and measures "replayed" (1 = the same state) and "certified" (1 = the atlas
 * passes its own check). */
SL_NODISCARD sl_status exp_session_finish(exp_run *run, sl_session *session, const sl_polygons *polygons,
                                          const char *name, const sl_atlas_def *def, exp_claims *claims);

/* Two states side by side as rows of a table. */
void exp_session_table(exp_page *page, int32_t count, const char *const *name, const exp_state *state);

#endif
