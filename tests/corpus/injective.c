/* Every chart of every generated model, by other code than the pipeline's: no flip, no angle that is not positive, one
 * turn around every inner vertex, less than one at the border. And ABF++ by itself on each of them: no negative angle,
 * ever, and no flip in what it holds as valid. */
#include "base/memory.h"
#include "generators.h"
#include "geom/predicates.h"
#include "param/abf_chart.h"
#include "segment/segment.h"
#include "support/test_support.h"

#include <cblas.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const double turn_tolerance = 1e-9; /* [rad] sums of a few dozen angles */

/* What was looked at, so that a test that looks at nothing fails. */
typedef struct tally {
    int64_t charts, triangles, inner, border;
    int32_t by_method[SL_FLATTEN_OPTIMISED + 1];
    int32_t held, not_held; /* of ABF++ by itself */
} tally;

static double angle_at(const double *uv, const int32_t *tri, int32_t c)
{
    const double *p = &uv[2 * (int64_t)tri[c]], *q = &uv[2 * (int64_t)tri[sl_corner_next(c)]],
                 *r = &uv[2 * (int64_t)tri[sl_corner_prev(c)]];
    const double a[2] = {q[0] - p[0], q[1] - p[1]}, b[2] = {r[0] - p[0], r[1] - p[1]};
    return atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
}

/* Is the map locally injective at every point, at those of the border, too (which ABF++ does not promise: a chart that
 * overlaps there is cut further)? turn: nv, scratch. */
static void check_layout(const char *model, const sl_patch *p, const double *uv, bool at_border, double *turn, tally *t)
{
    memset(turn, 0, (size_t)p->nv * sizeof *turn);
    for (int32_t f = 0; f < p->nt; f++) {
        const int32_t *v = &p->tri[3 * f];
        if (sl_orient2d(&uv[2 * v[0]], &uv[2 * v[1]], &uv[2 * v[2]]) <= 0) {
            fail_msg("%s: triangle %d is not counter-clockwise", model, f);
        }
        for (int32_t c = 3 * f; c < 3 * f + 3; c++) {
            const double angle = angle_at(uv, p->tri, c);
            if (!(angle > 0.0 && angle < TEST_PI)) {
                fail_msg("%s: angle %g in triangle %d", model, angle, f);
            }
            turn[p->tri[c]] += angle;
        }
    }
    for (int32_t v = 0; v < p->nv; v++) {
        const bool inner = p->border[v] == 0;
        const double excess = turn[v] - 2.0 * TEST_PI;
        if (inner ? !(fabs(excess) <= turn_tolerance) : at_border && !(excess < 0.0)) {
            fail_msg("%s: %g around %s vertex %d", model, turn[v], inner ? "inner" : "border", v);
        }
        t->inner += inner;
        t->border += !inner;
    }
    t->triangles += p->nt;
}

/* ABF++ alone, without the other methods behind it. */
static void check_abf(const char *model, const sl_patch *p, double *turn, tally *t)
{
    const sl_abf_def def = sl_abf_default();
    tally ignored = {0};
    sl_abf_chart *chart = NULL;
    const sl_status status = sl_abf_chart_create(p, &def, NULL, &chart);
    if (status != SL_OK) { /* charts that no angles can flatten are refused, by name */
        assert_true(status == SL_SINGULAR || status == SL_INFEASIBLE);
        return;
    }
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        assert_true(sl_abf_chart_angles(chart)[c] > 0.0 && sl_abf_chart_angles(chart)[c] < TEST_PI);
    }
    if (sl_abf_chart_info_of(chart)->valid) {
        check_layout(model, p, sl_abf_chart_uv(chart), false, turn, &ignored);
        t->held++;
    } else {
        t->not_held++;
    }
    sl_abf_chart_free(chart);
}

static void check_chart(const char *model, const sl_mesh *mesh, const sl_triangulation *triangulation,
                        const sl_segmentation *seg, int32_t c, tally *t)
{
    const sl_chart *chart = &seg->chart[c];
    sl_patch *p = NULL;
    assert_int_equal(sl_patch_extract(mesh, triangulation, &seg->face[chart->first], chart->count, &p), SL_OK);
    double *uv = sl_alloc(2 * (int64_t)p->nv, sizeof *uv), *turn = sl_alloc(p->nv, sizeof *turn);
    assert_true(uv != NULL && turn != NULL);
    if (chart->flat.verdict != SL_CHART_VALID) {
        fail_msg("%s: chart %d is %s", model, c, sl_flatten_verdict_name(chart->flat.verdict));
    }
    for (int32_t k = 0; k < 3 * p->nt; k++) {
        memcpy(&uv[2 * p->tri[k]], &seg->corner_uv[2 * (int64_t)p->corner[k]], 2 * sizeof *uv);
    }
    for (int32_t k = 0; k < 3 * p->nt; k++) { /* one vertex, one place */
        assert_memory_equal(&uv[2 * p->tri[k]], &seg->corner_uv[2 * (int64_t)p->corner[k]], 2 * sizeof *uv);
    }
    check_layout(model, p, uv, true, turn, t);
    check_abf(model, p, turn, t);
    t->by_method[chart->flat.method]++;
    t->charts++;
    sl_free(uv);
    sl_free(turn);
    sl_patch_free(p);
}

static void check_model(const sl_generator *generator, bool sew, tally *t)
{
    sl_generated *generated = NULL;
    sl_polygons polygons;
    sl_mesh *mesh = NULL;
    sl_triangulation *triangulation = NULL;
    sl_segmentation *seg = NULL;
    sl_segment_def def = sl_segment_default();
    def.symmetry = SL_SYMMETRY_USE_OFF; /* copies take what is looked at already */
    def.vectors = 10;                   /* quicker, and more charts of other kinds */
    def.sew = sew;                      /* every other model: what comes of merging, and what is left without */
    assert_int_equal(generator->make(1, 1, &generated), SL_OK);
    sl_generated_polygons(generated, &polygons);
    assert_int_equal(sl_mesh_build(&polygons, &mesh, NULL, NULL), SL_OK);
    assert_int_equal(sl_triangulation_create(mesh, &triangulation), SL_OK);
    assert_int_equal(sl_segment(mesh, triangulation, &def, NULL, &seg), SL_OK);
    for (int32_t c = 0; c < seg->nchart; c++) {
        check_chart(generator->name, mesh, triangulation, seg, c, t);
    }
    sl_segmentation_free(seg);
    sl_triangulation_free(triangulation);
    sl_mesh_free(mesh);
    sl_generated_free(generated);
}

static void every_chart_of_every_model_is_locally_injective(void **state)
{
    (void)state;
    int32_t count = 0;
    const sl_generator *generator = sl_generators(&count);
    tally t = {0};
    for (int32_t k = 0; k < count; k++) {
        check_model(&generator[k], k % 2 == 0, &t);
    }
    print_message("%d models, %lld charts, %lld triangles, %lld inner and %lld border vertices\n", count,
                  (long long)t.charts, (long long)t.triangles, (long long)t.inner, (long long)t.border);
    for (int m = 0; m <= SL_FLATTEN_OPTIMISED; m++) {
        print_message("  %-10s %d\n", sl_flatten_method_name((sl_flatten_method)m), t.by_method[m]);
    }
    print_message("  ABF++ alone: %d valid, %d not\n", t.held, t.not_held);
    assert_true(count >= 46 && t.charts > 100 && t.inner > 50000 && t.held > t.not_held);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_chart_of_every_model_is_locally_injective)};
    openblas_set_num_threads(1);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
