/* A chart held in hand while the mouse moves: its solver stays warm from one move to the next. */
#include "edit/session_internal.h"

#include "base/memory.h"
#include "param/reconstruct.h"

#include <string.h>

struct sl_edit_grip {
    sl_patch *patch;
    int32_t *face, nface;
    int32_t lines;         /* of the session when it was taken: another state, another grip */
    sl_sector_table table; /* what the solver was made for */
    sl_abf *solver;
    sl_reconstruct *layout;
};

static void let_solver_go(struct sl_edit_grip *g)
{
    sl_abf_free(g->solver);
    g->solver = NULL;
    sl_sectors_clear(&g->table);
}

void sl_edit_grip_release(sl_session *s)
{
    struct sl_edit_grip *g = s->grip;
    if (g != NULL) {
        let_solver_go(g);
        sl_reconstruct_free(g->layout);
        sl_patch_free(g->patch);
        sl_free(g->face);
        sl_free(g);
        s->grip = NULL;
    }
}

/* Takes hold of the chart with these facets, unless it is held already. */
static sl_status take_hold(sl_session *s, const int32_t *faces, int32_t nfaces)
{
    sl_status status = SL_OK;
    if (s->grip != NULL && s->grip->lines == s->lines && s->grip->nface == nfaces &&
        memcmp(s->grip->face, faces, (size_t)nfaces * sizeof *faces) == 0) {
        return SL_OK;
    }
    sl_edit_grip_release(s);
    struct sl_edit_grip *g = sl_calloc(1, sizeof *g);
    SL_TRY(g != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    s->grip = g;
    g->lines = s->lines;
    g->nface = nfaces;
    g->face = sl_copy(faces, nfaces, sizeof *faces);
    SL_TRY(g->face != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(sl_patch_extract(s->mesh, s->base->triangulation, faces, nfaces, &g->patch));
    SL_TRY(sl_reconstruct_create(g->patch, &g->layout));
cleanup:
    if (status != SL_OK) {
        sl_edit_grip_release(s);
    }
    return status;
}

static bool same_sectors(const sl_sectors *a, const sl_sectors *b)
{
    return a->count == b->count && memcmp(a->first, b->first, ((size_t)a->count + 1) * sizeof *a->first) == 0 &&
           memcmp(a->corner, b->corner, (size_t)a->first[a->count] * sizeof *a->corner) == 0;
}

/* New targets for the solver at hand, or a solver for other sectors. Takes the table over. */
static sl_status aim(sl_session *s, sl_sector_table *table)
{
    struct sl_edit_grip *g = s->grip;
    sl_status status = SL_OK;
    if (g->solver != NULL && same_sectors(&g->table.view, &table->view)) {
        status = sl_abf_set_targets(g->solver, table->view.theta);
        sl_sectors_clear(table);
        return status;
    }
    sl_abf_def def = s->def.segment.flatten.abf;
    double *angle = sl_alloc(3 * (int64_t)g->patch->nt, sizeof *angle);
    let_solver_go(g);
    g->table = *table;
    *table = (sl_sector_table){0};
    def.sectors = &g->table.view;
    SL_TRY(angle != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    sl_edit_page_angles(s, g->patch, angle);
    SL_TRY(sl_abf_create(g->patch, &def, &g->solver));
    sl_abf_start_from(g->solver, angle);
cleanup:
    sl_free(angle);
    return status;
}

sl_status sl_edit_grip_solve(sl_session *s, const int32_t *faces, int32_t nfaces, int32_t nwish,
                             sl_edit_wish *const *wish, const sl_context *context, sl_edit_chart **out, sl_diag *diag)
{
    sl_status status = SL_OK;
    sl_sector_table table = {0};
    double *uv = NULL;
    *out = NULL;
    SL_TRY(take_hold(s, faces, nfaces));
    struct sl_edit_grip *g = s->grip;
    SL_TRY(sl_edit_compile(s, g->patch, nwish, wish, &table, diag));
    SL_TRY(aim(s, &table));
    SL_TRY(sl_abf_step(g->solver, SL_EDIT_QUICK_STEPS, context));
    const sl_abf_info *info = sl_abf_info_of(g->solver);
    uv = sl_alloc(g->patch->nv, 2 * sizeof *uv);
    SL_TRY(uv != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    bool good = info->min_angle > 0.0;
    if (good) {
        SL_TRY(sl_reconstruct_solve(g->layout, sl_abf_angles(g->solver), context, uv));
        good = sl_layout_judge(g->patch, sl_abf_angles(g->solver), uv).flipped == 0;
    }
    if (good) {
        const sl_flatten_result flat = {.verdict = SL_CHART_VALID, .method = SL_FLATTEN_ABF, .abf = *info};
        SL_TRY(sl_edit_chart_create(s, g->patch, faces, nfaces, uv, false, &flat, context, out));
        (*out)->iterations = info->iterations;
    } else {
        let_solver_go(g); /* the next move starts from the page's angles again */
    }
cleanup:
    sl_sectors_clear(&table);
    sl_free(uv);
    return status;
}
