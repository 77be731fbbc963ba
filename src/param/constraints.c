#include "param/constraints.h"

#include <math.h>

#include "base/memory.h"
#include "param/constraints_internal.h"

static const double same_angle = 1e-12; /* [rad]: two prescribed angles that differ by less are one */

static int32_t least_count(sl_constraint_kind kind)
{
    switch (kind) {
    case SL_CONSTRAINT_STRAIGHT:
    case SL_CONSTRAINT_BORDER:
        return 2;
    case SL_CONSTRAINT_POLYGON:
        return 3;
    case SL_CONSTRAINT_ANGLE:
    case SL_CONSTRAINT_RIGHT:
        break;
    }
    return 1;
}

static sl_status check_angle(const sl_constraint *constraint, int32_t index, sl_diag *diag)
{
    const bool polygon = constraint->kind == SL_CONSTRAINT_POLYGON;
    if (constraint->kind != SL_CONSTRAINT_ANGLE && !polygon) {
        return SL_OK;
    }
    if (!isfinite(constraint->angle)) {
        sl_diag_reason(diag, "constraint %d asks for an angle that is not a number", index + 1);
        return SL_BAD_INPUT;
    }
    if (constraint->angle < 0.0 || (constraint->angle == 0.0 && !polygon)) {
        sl_diag_reason(diag, "constraint %d asks for an angle that is not positive", index + 1);
        return SL_INFEASIBLE;
    }
    return SL_OK;
}

/* Counts, vertices, angles: what can be said of one constraint alone. */
static sl_status check_one(const sl_patch *patch, const sl_constraint *constraint, int32_t index,
                           const sl_teller *teller)
{
    sl_diag *diag = teller->diag;
    const bool on_border = constraint->kind == SL_CONSTRAINT_ANGLE || constraint->kind == SL_CONSTRAINT_BORDER ||
                           constraint->kind == SL_CONSTRAINT_POLYGON;
    if (constraint->count < least_count(constraint->kind)) {
        sl_diag_reason(diag, "constraint %d needs at least %d vertices", index + 1, least_count(constraint->kind));
        return SL_BAD_INPUT;
    }
    for (int32_t i = 0; i < constraint->count; i++) {
        const int32_t v = constraint->vertex[i];
        if (v < 0 || v >= patch->nv) {
            sl_diag_reason(diag, "constraint %d names a vertex that is not in the chart", index + 1);
            return SL_BAD_INPUT;
        }
        if (on_border && patch->border[v] == 0) {
            sl_diag_reason(diag, "vertex %d is not on the chart's border (constraint %d)", sl_name_of(teller, v),
                           index + 1);
            return SL_BAD_INPUT;
        }
    }
    if (constraint->kind == SL_CONSTRAINT_BORDER && constraint->vertex[0] == constraint->vertex[1]) {
        sl_diag_reason(diag, "a closed path cannot be straight (vertex %d, constraint %d)",
                       sl_name_of(teller, constraint->vertex[0]), index + 1);
        return SL_INFEASIBLE;
    }
    return check_angle(constraint, index, diag);
}

static sl_status wish_angle(sl_vertex_wish *wish, int32_t v, double angle, int32_t origin, const sl_teller *teller)
{
    if (!isnan(wish->angle[v]) && fabs(wish->angle[v] - angle) > same_angle) {
        sl_diag_reason(teller->diag, "vertex %d is asked for two angles (constraints %d and %d)", sl_name_of(teller, v),
                       wish->angle_origin[v] + 1, origin + 1);
        return SL_INFEASIBLE;
    }
    wish->angle[v] = angle;
    wish->angle_origin[v] = origin;
    return SL_OK;
}

static sl_status collect_wishes(const sl_patch *patch, int32_t count, const sl_constraint *list,
                                const sl_teller *teller, sl_vertex_wish *wish)
{
    sl_status status = SL_OK;
    for (int32_t v = 0; v < patch->nv; v++) {
        wish->angle[v] = NAN;
        wish->angle_origin[v] = wish->right_origin[v] = -1;
    }
    for (int32_t i = 0; i < count; i++) {
        const sl_constraint *constraint = &list[i];
        if (constraint->kind == SL_CONSTRAINT_ANGLE) {
            SL_TRY(wish_angle(wish, constraint->vertex[0], constraint->angle, i, teller));
        } else if (constraint->kind == SL_CONSTRAINT_RIGHT) {
            wish->right_origin[constraint->vertex[0]] = i;
        }
        for (int32_t k = 0; k < constraint->count && constraint->kind == SL_CONSTRAINT_POLYGON; k++) {
            SL_TRY(wish_angle(wish, constraint->vertex[k], sl_polygon_angle(constraint), i, teller));
        }
    }
cleanup:
    return status;
}

sl_status sl_constraints_compile(const sl_patch *patch, int32_t count, const sl_constraint *list, const int32_t *name,
                                 sl_sector_table *out, sl_diag *diag)
{
    sl_status status = SL_OK;
    const sl_teller teller = {name, diag};
    sl_line_set lines = {0};
    sl_vertex_wish wish = {sl_alloc(patch->nv, sizeof *wish.angle), sl_alloc(patch->nv, sizeof *wish.angle_origin),
                           sl_alloc(patch->nv, sizeof *wish.right_origin)};
    *out = (sl_sector_table){0};
    if (wish.angle == NULL || wish.angle_origin == NULL || wish.right_origin == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    for (int32_t i = 0; i < count; i++) {
        SL_TRY(check_one(patch, &list[i], i, &teller));
    }
    SL_TRY(collect_wishes(patch, count, list, &teller, &wish));
    SL_TRY(sl_lines_init(&lines, patch, count, list, &teller));
    SL_TRY(sl_lines_divide(&lines, patch, &wish, &teller, out));
    SL_TRY(sl_sectors_feasible(patch, out, name, diag));
cleanup:
    if (status != SL_OK) {
        sl_sectors_clear(out);
    }
    sl_lines_clear(&lines);
    sl_free(wish.angle);
    sl_free(wish.angle_origin);
    sl_free(wish.right_origin);
    return status;
}
