/* Surfaces and whole runs for the tests of this room. */
#ifndef SL_TEST_OPTIMIZE_CHECKS_H
#define SL_TEST_OPTIMIZE_CHECKS_H

#include "optimize/decimate_internal.h"
#include "segment/checks.h"

#include <math.h>
#include <string.h>

/* A mesh with all that a surface needs. */
typedef struct test_surface {
    sl_mesh *mesh;
    sl_triangulation *triangulation;
    sl_opt_surface surface;
} test_surface;

static inline test_surface test_surface_of(sl_mesh *mesh)
{
    test_surface s = {.mesh = mesh, .triangulation = test_triangulate(mesh)};
    assert_int_equal(sl_opt_surface_init(mesh, s.triangulation, NULL, &s.surface), SL_OK);
    return s;
}

static inline void test_surface_clear(test_surface *s)
{
    sl_opt_surface_clear(&s->surface);
    sl_triangulation_free(s->triangulation);
    sl_mesh_free(s->mesh);
}

static inline sl_opt_state test_started(const test_surface *s, const sl_optimize_def *def)
{
    sl_opt_state state;
    const sl_segment_def segment = sl_segment_default();
    bool started = false;
    assert_int_equal(sl_opt_state_init(&s->surface, def, NULL, &state), SL_OK);
    assert_int_equal(sl_opt_start(&state, &segment, s->triangulation, &started), SL_OK);
    assert_true(started);
    return state;
}

/* Charts tile the surface, each a disk whose triangles are positive and glued exactly where no edge is cut. */
static inline void test_check_state(const sl_opt_state *state)
{
    const sl_patch *whole = state->surface->patch;
    int32_t triangles = 0;
    for (int32_t c = 0; c < state->nchart; c++) {
        const sl_opt_chart *chart = &state->chart[c];
        const sl_patch *p = chart->patch;
        assert_true(sl_patch_is_disk(p));
        triangles += p->nt;
        for (int32_t t = 0; t < p->nt; t++) {
            assert_int_equal(state->chart_of[p->facet[t]], c);
            assert_true(sl_orient2d(chart->uv + 2 * p->tri[3 * t], chart->uv + 2 * p->tri[3 * t + 1],
                                    chart->uv + 2 * p->tri[3 * t + 2]) > 0);
        }
        for (int32_t h = 0; h < 3 * p->nt; h++) {
            const int32_t corner = p->corner[h];
            assert_true((p->twin[h] >= 0) == (whole->twin[corner] >= 0 && state->cut[corner] == 0));
            assert_true(state->uv[2 * corner] == chart->uv[2 * p->tri[h]]);
        }
    }
    assert_int_equal(triangles, whole->nt);
    for (int32_t h = 0; h < 3 * whole->nt; h++) {
        assert_true(whole->twin[h] < 0 || state->cut[h] == state->cut[whole->twin[h]]);
        assert_true(state->cut[h] == 0 || state->surface->cost[h] < HUGE_VAL);
    }
}

/* The atlas's L2 after one scale and its mean s1/s2, by sl_distortion_measure. */
static inline sl_distortion test_whole_distortion(const sl_mesh *m, const sl_triangulation *t, const sl_segmentation *s)
{
    sl_distortion d;
    double *xyz = malloc(9 * sizeof *xyz * (size_t)t->nt), *uv = malloc(6 * sizeof *uv * (size_t)t->nt);
    for (int32_t c = 0; c < 3 * t->nt; c++) {
        memcpy(xyz + 3 * c, m->xyz + 3 * m->origin[t->corner[c]], 3 * sizeof *xyz);
        memcpy(uv + 2 * c, s->corner_uv + 2 * t->corner[c], 2 * sizeof *uv);
    }
    assert_int_equal(sl_distortion_measure(t->nt, xyz, uv, 1, &d), SL_OK);
    free(xyz);
    free(uv);
    return d;
}

#endif
