/* One chart laid flat as its wishes ask, from the angles it has on the page. */
#include "edit/session_internal.h"

#include "base/memory.h"
#include "param/abf_chart.h"
#include "param/constraints.h"
#include "param/reconstruct.h"

#include <math.h>
#include <string.h>

static const double flat_share = 1e-12; /* a chart within this share of its extent from a plane is projected */

void sl_edit_page_angles(const sl_session *s, const sl_patch *patch, double *angle)
{
    for (int32_t t = 0; t < patch->nt; t++) {
        const double *p[3];
        for (int k = 0; k < 3; k++) {
            p[k] = s->corner_uv + 2 * (int64_t)patch->corner[3 * t + k];
        }
        for (int k = 0; k < 3; k++) {
            const double *a = p[k], *b = p[(k + 1) % 3], *c = p[(k + 2) % 3];
            const double x[2] = {b[0] - a[0], b[1] - a[1]}, y[2] = {c[0] - a[0], c[1] - a[1]};
            const double value = atan2(fabs(x[0] * y[1] - x[1] * y[0]), x[0] * y[0] + x[1] * y[1]);
            angle[3 * t + k] = value > 0.0 ? value : NAN;
        }
    }
}

/* Do all vertices lie in one plane? */
static bool is_flat(const sl_patch *patch)
{
    double normal[3] = {0}, low[3], high[3], length = 0.0, extent = 0.0;
    const double *x = patch->xyz;
    memcpy(low, x, sizeof low);
    memcpy(high, x, sizeof high);
    for (int32_t t = 0; t < patch->nt; t++) {
        const double *a = x + 3 * (int64_t)patch->tri[3 * t], *b = x + 3 * (int64_t)patch->tri[3 * t + 1];
        const double *c = x + 3 * (int64_t)patch->tri[3 * t + 2];
        for (int k = 0; k < 3; k++) {
            const int i = (k + 1) % 3, j = (k + 2) % 3;
            normal[k] += (b[i] - a[i]) * (c[j] - a[j]) - (b[j] - a[j]) * (c[i] - a[i]);
        }
    }
    for (int32_t v = 0; v < patch->nv; v++) {
        for (int k = 0; k < 3; k++) {
            low[k] = fmin(low[k], x[3 * (int64_t)v + k]);
            high[k] = fmax(high[k], x[3 * (int64_t)v + k]);
        }
    }
    for (int k = 0; k < 3; k++) {
        length += normal[k] * normal[k];
        extent = fmax(extent, high[k] - low[k]);
    }
    if (!(length > 0.0)) {
        return false;
    }
    for (int32_t v = 0; v < patch->nv; v++) {
        double height = 0.0;
        for (int k = 0; k < 3; k++) {
            height += normal[k] * (x[3 * (int64_t)v + k] - x[k]);
        }
        if (fabs(height) > flat_share * extent * sqrt(length)) {
            return false;
        }
    }
    return true;
}

static sl_status require_disk(const sl_patch *patch, sl_diag *diag)
{
    if (sl_patch_is_disk(patch)) {
        return SL_OK;
    }
    const int32_t genus = (2 - patch->loops - patch->euler) / 2;
    if (patch->loops == 0) {
        sl_diag_reason(diag, "a chart of %d triangles would be closed: it needs a border to be laid flat", patch->nt);
    } else {
        sl_diag_reason(diag, "a chart of %d triangles would be no disk: it would have %d borders and genus %d",
                       patch->nt, patch->loops, genus);
    }
    sl_diag_hint(diag, "cut first, or leave a part of the seam");
    return SL_INFEASIBLE;
}

sl_status sl_edit_compile(sl_session *s, const sl_patch *patch, int32_t nwish, sl_edit_wish *const *wish,
                          sl_sector_table *out, sl_diag *diag)
{
    sl_status status = SL_OK;
    int64_t vertices = 0, at = 0;
    int32_t *vertex = NULL, *name = NULL;
    sl_constraint *list = sl_alloc(nwish, sizeof *list);
    *out = (sl_sector_table){0};
    for (int32_t i = 0; i < nwish; i++) {
        vertices += wish[i]->count;
    }
    vertex = sl_alloc(vertices, sizeof *vertex);
    name = sl_alloc(patch->nv, sizeof *name);
    SL_TRY(list != NULL && vertex != NULL && name != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t c = 0; c < 3 * patch->nt; c++) {
        s->corner_mark[patch->corner[c]] = patch->tri[c];
        name[patch->tri[c]] = s->mesh->input_vertex[s->mesh->origin[patch->corner[c]]];
    }
    for (int32_t i = 0; i < nwish; i++) {
        static const sl_constraint_kind kind[SL_ACTION_KINDS] = {
            [SL_ACTION_ANGLE] = SL_CONSTRAINT_ANGLE,
            [SL_ACTION_STRAIGHTEN] = SL_CONSTRAINT_STRAIGHT,
            [SL_ACTION_STRAIGHTEN_BORDER] = SL_CONSTRAINT_BORDER,
            [SL_ACTION_RECTANGLE] = SL_CONSTRAINT_POLYGON,
            [SL_ACTION_RIGHT] = SL_CONSTRAINT_RIGHT,
        };
        list[i] = (sl_constraint){.kind = kind[wish[i]->kind], .count = wish[i]->count, .vertex = vertex + at};
        list[i].angle = wish[i]->kind == SL_ACTION_ANGLE ? wish[i]->degrees * (acos(-1.0) / 180.0) : 0.0;
        for (int32_t k = 0; k < wish[i]->count; k++) {
            vertex[at++] = s->corner_mark[wish[i]->corner[k]]; /* -1 of another chart: not in the patch */
        }
    }
    for (int32_t c = 0; c < 3 * patch->nt; c++) {
        s->corner_mark[patch->corner[c]] = -1;
    }
    SL_TRY(sl_constraints_compile(patch, nwish, list, name, out, diag));
cleanup:
    sl_free(list);
    sl_free(vertex);
    sl_free(name);
    return status;
}

/* Two Newton steps from the page's angles: what a drag shows. *found = the layout has no flip. */
static sl_status solve_quickly(const sl_patch *patch, const sl_abf_def *def, const double *angle,
                               const sl_context *context, double *uv, sl_flatten_result *flat, bool *found)
{
    sl_status status = SL_OK;
    sl_abf *solver = NULL;
    sl_reconstruct *layout = NULL;
    *found = false;
    SL_TRY(sl_abf_create(patch, def, &solver));
    sl_abf_start_from(solver, angle);
    SL_TRY(sl_abf_step(solver, SL_EDIT_QUICK_STEPS, context));
    flat->abf = *sl_abf_info_of(solver);
    flat->method = SL_FLATTEN_ABF;
    if (flat->abf.min_angle > 0.0) {
        SL_TRY(sl_reconstruct_create(patch, &layout));
        SL_TRY(sl_reconstruct_solve(layout, sl_abf_angles(solver), context, uv));
        *found = sl_layout_judge(patch, sl_abf_angles(solver), uv).flipped == 0;
    }
cleanup:
    sl_abf_free(solver);
    sl_reconstruct_free(layout);
    return status;
}

static bool is_no_answer(sl_status status)
{
    return status == SL_SINGULAR || status == SL_INFEASIBLE || status == SL_BAD_INPUT ||
           status == SL_NOT_POSITIVE_DEFINITE;
}

/* To the end. *found = the targets are reached by a layout without flips; *reached = how far it got, else. */
static sl_status solve_fully(const sl_patch *patch, const sl_abf_def *def, const double *angle,
                             const sl_context *context, double *uv, sl_flatten_result *flat, bool *found,
                             double *reached)
{
    sl_abf_chart *chart = NULL;
    *found = false;
    *reached = 0.0;
    const sl_status status = sl_abf_chart_create_from(patch, def, angle, context, &chart);
    if (status != SL_OK) {
        return is_no_answer(status) ? SL_OK : status;
    }
    const sl_abf_chart_info *info = sl_abf_chart_info_of(chart);
    *reached = info->valid ? info->reached : 0.0;
    *found = info->valid && info->converged && info->reached == 1.0;
    memcpy(uv, sl_abf_chart_uv(chart), 2 * (size_t)patch->nv * sizeof *uv);
    flat->abf = info->abf;
    flat->abf.iterations = info->iterations;
    flat->method = SL_FLATTEN_ABF;
    sl_abf_chart_free(chart);
    return SL_OK;
}

/* Projection where the chart is flat, and what sl_flatten finds where ABF++ has no answer. */
static sl_status solve_otherwise(sl_session *s, const sl_patch *patch, bool fallback, const sl_context *context,
                                 double *uv, sl_flatten_result *flat, sl_diag *diag)
{
    const sl_status status = sl_flatten(patch, &s->def.segment.flatten, context, uv, flat);
    if (status != SL_OK) {
        return status;
    }
    if (flat->verdict == SL_CHART_NOT_A_DISK || flat->verdict == SL_CHART_NOT_CONVERGED ||
        flat->verdict == SL_CHART_FLIPPED) {
        sl_diag_reason(diag, "a chart of %d triangles cannot be laid flat without flips", patch->nt);
        return SL_INFEASIBLE;
    }
    if (fallback) {
        sl_edit_note(s, "a chart of %d triangles: ABF++ found no answer, laid flat by %s%s", patch->nt,
                     sl_flatten_method_name(flat->method), flat->stretch_minimised ? " and stretch minimised" : "");
    }
    return SL_OK;
}

/* uv: nv x 2 of the patch, a disk. */
static sl_status solve_patch(sl_session *s, const sl_patch *patch, int32_t nwish, sl_edit_wish *const *wish,
                             const sl_context *context, double *uv, sl_flatten_result *flat, sl_diag *diag)
{
    sl_status status = SL_OK;
    sl_sector_table table = {0};
    sl_abf_def def = s->def.segment.flatten.abf;
    double *angle = sl_alloc(3 * (int64_t)patch->nt, sizeof *angle), reached = 0.0;
    bool found = false;
    SL_TRY(angle != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    if (nwish > 0) {
        SL_TRY(sl_edit_compile(s, patch, nwish, wish, &table, diag));
        def.sectors = &table.view;
    }
    sl_edit_page_angles(s, patch, angle);
    if (s->quick) {
        status = solve_quickly(patch, &def, angle, context, uv, flat, &found);
        SL_TRY(is_no_answer(status) ? SL_OK : status);
    }
    if (!found) {
        SL_TRY(solve_fully(patch, &def, angle, context, uv, flat, &found, &reached));
    }
    if (!found && nwish > 0) {
        sl_diag_reason(diag, "the constraints of a chart cannot be met together: only %.0f %% of the way is valid",
                       100.0 * reached);
        sl_diag_hint(diag, "ask for less, or drop one of them");
        SL_TRY(SL_INFEASIBLE);
    }
    if (!found) {
        SL_TRY(solve_otherwise(s, patch, true, context, uv, flat, diag));
    }
cleanup:
    sl_free(angle);
    sl_sectors_clear(&table);
    return status;
}

sl_status sl_edit_solve(sl_session *s, const int32_t *faces, int32_t nfaces, int32_t nwish, sl_edit_wish *const *wish,
                        const sl_context *context, sl_edit_chart **out, sl_diag *diag)
{
    sl_status status = SL_OK;
    sl_patch *patch = NULL;
    double *uv = NULL;
    sl_flatten_result flat = {.verdict = SL_CHART_VALID, .certificate.first_edge = {-1, -1}};
    *out = NULL;
    if (s->quick && nwish > 0 && s->open_change.edges == 0) {
        status = sl_edit_grip_solve(s, faces, nfaces, nwish, wish, context, out, diag);
        if (*out != NULL || !is_no_answer(status)) {
            SL_TRY(status);
        }
        if (*out != NULL) {
            goto cleanup;
        }
    }
    SL_TRY(sl_patch_extract(s->mesh, s->base->triangulation, faces, nfaces, &patch));
    SL_TRY(require_disk(patch, diag));
    uv = sl_calloc(patch->nv, 2 * sizeof *uv);
    SL_TRY(uv != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    if (nwish == 0 && (nfaces == 1 || is_flat(patch))) {
        SL_TRY(solve_otherwise(s, patch, false, context, uv, &flat, diag));
    } else {
        SL_TRY(solve_patch(s, patch, nwish, wish, context, uv, &flat, diag));
    }
    SL_TRY(sl_edit_chart_create(s, patch, faces, nfaces, uv, false, &flat, context, out));
    (*out)->iterations = flat.abf.iterations;
cleanup:
    sl_patch_free(patch);
    sl_free(uv);
    return status;
}
