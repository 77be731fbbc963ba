/* A bumpy sheet of quads that is one chart, and small helpers.
 * Vertex (i, j) is number i + j * (SHEET_X + 1); facet (i, j) is number i + j * SHEET_X, counter-clockwise from (i, j).
 */
#ifndef SL_TESTS_EDIT_SHEET_H
#define SL_TESTS_EDIT_SHEET_H

#include <math.h>
#include <string.h>

#include "edit/session.h"
#include "support/test_support.h"

enum { SHEET_X = 9, SHEET_Y = 7, SHEET_V = (SHEET_X + 1) * (SHEET_Y + 1), SHEET_F = SHEET_X * SHEET_Y };

typedef struct sheet {
    double xyz[3 * SHEET_V], uv[8 * SHEET_F];
    int32_t first[SHEET_F + 1], index[4 * SHEET_F];
    sl_polygons polygons;
} sheet;

static inline int32_t sheet_v(int32_t i, int32_t j)
{
    return i + j * (SHEET_X + 1);
}

static inline int32_t sheet_f(int32_t i, int32_t j)
{
    return i + j * SHEET_X;
}

static inline void sheet_make(sheet *s)
{
    for (int32_t j = 0; j <= SHEET_Y; j++) {
        for (int32_t i = 0; i <= SHEET_X; i++) {
            double *x = s->xyz + 3 * sheet_v(i, j);
            x[0] = 1.3 * i + 0.11 * sin(2.1 * j + i);
            x[1] = 1.1 * j + 0.13 * cos(1.7 * i - j);
            x[2] = 0.6 * sin(0.8 * i + 0.3) * cos(0.9 * j + 0.7) + 0.05 * sin(5.0 * i * j + 1.0);
        }
    }
    for (int32_t j = 0; j < SHEET_Y; j++) {
        for (int32_t i = 0; i < SHEET_X; i++) {
            const int32_t f = sheet_f(i, j),
                          corner[4] = {sheet_v(i, j), sheet_v(i + 1, j), sheet_v(i + 1, j + 1), sheet_v(i, j + 1)};
            s->first[f] = 4 * f;
            for (int32_t k = 0; k < 4; k++) {
                s->index[4 * f + k] = corner[k];
                s->uv[8 * f + 2 * k] = 0.05 + 0.09 * (corner[k] % (SHEET_X + 1)) + 0.003 * sin(corner[k]);
                s->uv[8 * f + 2 * k + 1] = 0.07 + 0.08 * (corner[k] / (SHEET_X + 1)) + 0.004 * cos(3.0 * corner[k]);
            }
        }
    }
    s->first[SHEET_F] = 4 * SHEET_F;
    s->polygons = (sl_polygons){SHEET_V, SHEET_F, s->xyz, s->first, s->index};
}

static inline sl_atlas_def small_def(void)
{
    sl_atlas_def def = sl_atlas_default();
    def.check_resolution = 512;
    return def;
}

static inline sl_session *open_polygons(const sl_polygons *polygons, const char *line, const double *uv)
{
    sl_session *session = NULL;
    sl_action open;
    sl_diag diag = sl_diag_none();
    const sl_atlas_def def = small_def();
    assert_int_equal(sl_action_parse(line, (int64_t)strlen(line), &open, &diag), SL_OK);
    const sl_status status = sl_session_create(polygons, uv, &open, &def, NULL, &session, &diag);
    if (status != SL_OK) {
        print_message("%s\n", diag.reason);
    }
    assert_int_equal(status, SL_OK);
    sl_action_clear(&open);
    return session;
}

/* Applies a line; the status. */
static inline sl_status try_line(sl_session *session, const char *line, sl_diag *diag)
{
    sl_action action;
    sl_status status = sl_action_parse(line, (int64_t)strlen(line), &action, diag);
    assert_int_equal(status, SL_OK);
    status = sl_session_apply(session, &action, NULL, diag);
    sl_action_clear(&action);
    return status;
}

static inline void do_line(sl_session *session, const char *line)
{
    sl_diag diag = sl_diag_none();
    const sl_status status = try_line(session, line, &diag);
    if (status != SL_OK) {
        print_message("%s: %s\n", line, diag.reason);
    }
    assert_int_equal(status, SL_OK);
}

/* Refused with this status, a reason, and without a trace. */
static inline void refuse_line(sl_session *session, const char *line, sl_status expected)
{
    sl_diag diag = sl_diag_none();
    const uint64_t before = sl_session_hash(session);
    const int32_t lines = sl_session_lines(session);
    const sl_status status = try_line(session, line, &diag);
    if (status != expected) {
        print_message("%s: %s (%s)\n", line, sl_status_name(status), diag.reason);
    }
    assert_int_equal(status, expected);
    assert_true(diag.reason[0] != '\0');
    assert_true(sl_session_hash(session) == before);
    assert_int_equal(sl_session_lines(session), lines);
}

/* Where a facet's corner at a vertex lies. */
static inline const double *uv_at(const sl_session *s, int32_t vertex, int32_t facet)
{
    const int32_t h = sl_session_find_corner(s, vertex, facet);
    assert_true(h >= 0);
    return sl_session_corner_uv(s) + 2 * (int64_t)h;
}

#endif
