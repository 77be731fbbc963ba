/* Triangles of UVs for overlap tests: what is left out as shared, and the window. */
#include "atlas/uv_triangles.h"

#include "base/memory.h"
#include "overlap/exact.h"
#include "support/test_support.h"

#include <math.h>
#include <string.h>

enum { SIDE = 6, QUADS = SIDE * SIDE, CORNERS = 4 * QUADS, CHARTS = 3 };

/* Curved patches of quads side by side in space, a chart each. */
typedef struct patches {
    double xyz[3 * CHARTS * (SIDE + 1) * (SIDE + 1)];
    int32_t first[CHARTS * QUADS + 1], index[CHARTS * CORNERS], face_chart[CHARTS * QUADS], copy_of[CHARTS];
    double uv[2 * CHARTS * CORNERS];
    sl_polygons polygons;
    sl_sharing_table table;
} patches;

/* Chart 1 copies chart 0 mirrored in space; chart 2 has UVs of its own. */
static void make_patches(test_rng *rng, patches *p)
{
    const int32_t row = SIDE + 1;
    int32_t f = 0;
    double page[2 * (SIDE + 1) * (SIDE + 1)];
    for (int32_t v = 0; v < row * row; v++) {
        page[2 * v] = (v % row + test_uniform(rng, -0.3, 0.3)) * 0.06 + 0.03;
        page[2 * v + 1] = ((double)(v / row) + test_uniform(rng, -0.3, 0.3)) * 0.06 + 0.03;
    }
    for (int32_t c = 0; c < CHARTS; c++) {
        const double sign = c == 1 ? -1.0 : 1.0;
        for (int32_t v = 0; v < row * row; v++) {
            double *x = p->xyz + 3 * (c * row * row + v);
            x[0] = sign * (1.0 + v % row) + 20.0 * (c == 2);
            x[1] = (double)(v / row);
            x[2] = 0.1 * x[0] * x[0] - 0.07 * x[1] * x[1];
        }
        for (int32_t q = 0; q < QUADS; q++, f++) {
            const int32_t a = q / SIDE * row + q % SIDE, ring[4] = {a, a + 1, a + row + 1, a + row};
            p->first[f] = 4 * f;
            p->face_chart[f] = c;
            for (int k = 0; k < 4; k++) { /* the mirror image runs the other way, from another corner */
                const int32_t v = ring[c == 1 ? (6 - k) % 4 : k];
                p->index[4 * f + k] = c * row * row + v;
                p->uv[2 * (4 * f + k)] = page[2 * v] + 0.5 * (c == 2);
                p->uv[2 * (4 * f + k) + 1] = page[2 * v + 1];
            }
        }
    }
    p->first[f] = 4 * f;
    p->copy_of[0] = p->copy_of[2] = -1;
    p->copy_of[1] = 0;
    p->polygons = (sl_polygons){CHARTS * row * row, f, p->xyz, p->first, p->index};
    p->table = (sl_sharing_table){f, CHARTS, p->face_chart, p->copy_of};
}

static sl_exact_overlap judge(const sl_uv_triangles *t)
{
    sl_exact_overlap found;
    uint8_t *red = sl_alloc(t->nt, 1);
    assert_non_null(red);
    assert_int_equal(sl_overlap_exact(t->uv, t->nt, t->tri, NULL, red, &found), SL_OK);
    sl_free(red);
    return found;
}

static void copies_that_lie_on_their_source_are_left_out_and_others_stay(void **state)
{
    (void)state;
    static patches p;
    test_rng rng = test_rng_seed(0x54a2e);
    for (int trial = 0; trial < 20 * test_multiplier(); trial++) {
        sl_uv_triangles t;
        make_patches(&rng, &p);
        assert_int_equal(sl_uv_triangles_init(&p.polygons, p.uv, NULL, &t, NULL), SL_OK);
        assert_int_equal(t.nt, 2 * CHARTS * QUADS);
        assert_int_equal(t.shared_faces, 0);
        assert_int_equal(t.nv, 2 * (SIDE + 1) * (SIDE + 1)); /* equal UVs are one point */
        assert_true(judge(&t).red >= 4 * QUADS);
        sl_uv_triangles_clear(&t);
        assert_int_equal(sl_uv_triangles_init(&p.polygons, p.uv, &p.table, &t, NULL), SL_OK);
        assert_int_equal(t.shared_faces, QUADS);
        assert_int_equal(t.nt, 2 * (CHARTS - 1) * QUADS);
        assert_int_equal(judge(&t).red, 0);
        for (int32_t i = 0; i < t.nt; i++) {
            assert_int_not_equal(p.face_chart[t.face[i]], 1);
        }
        sl_uv_triangles_clear(&t);
        const int32_t f = QUADS + test_index(&rng, QUADS); /* a corner of the copy is an ulp off */
        p.uv[8 * f + 2] = nextafter(p.uv[8 * f + 2], 2.0);
        assert_int_equal(sl_uv_triangles_init(&p.polygons, p.uv, &p.table, &t, NULL), SL_OK);
        assert_int_equal(t.shared_faces, QUADS - 1);
        assert_true(judge(&t).red > 0);
        sl_uv_triangles_clear(&t);
    }
}

/* A copy that lies on one polygon of its source twice has folded: the second one is an overlap. */
static void a_polygon_is_copied_once_by_each_chart(void **state)
{
    (void)state;
    static patches p;
    test_rng rng = test_rng_seed(0x2face);
    sl_uv_triangles t;
    make_patches(&rng, &p);
    memcpy(p.uv + 8 * (QUADS + 3), p.uv + 8 * (QUADS + 20), 8 * sizeof *p.uv);
    assert_int_equal(sl_uv_triangles_init(&p.polygons, p.uv, &p.table, &t, NULL), SL_OK);
    assert_int_equal(t.shared_faces, QUADS - 1);
    assert_true(judge(&t).red >= 2);
    sl_uv_triangles_clear(&t);
    make_patches(&rng, &p);
    for (int32_t f = 2 * QUADS; f < 3 * QUADS; f++) { /* the third chart lies there too; with leave, both do */
        memcpy(p.uv + 8 * f, p.uv + 8 * (f - QUADS), 8 * sizeof *p.uv);
    }
    assert_int_equal(sl_uv_triangles_init(&p.polygons, p.uv, &p.table, &t, NULL), SL_OK);
    assert_int_equal(t.shared_faces, QUADS);
    sl_uv_triangles_clear(&t);
    p.copy_of[2] = 0;
    assert_int_equal(sl_uv_triangles_init(&p.polygons, p.uv, &p.table, &t, NULL), SL_OK);
    assert_int_equal(t.shared_faces, 2 * QUADS);
    assert_int_equal(judge(&t).red, 0);
    sl_uv_triangles_clear(&t);
}

static void the_window_is_the_unit_square_or_holds_all_uvs(void **state)
{
    (void)state;
    static patches p;
    static double window[4 * CHARTS * CORNERS];
    test_rng rng = test_rng_seed(0x317d);
    static const double scale[] = {1.0, 3.7, 1e-200, 1e200, 1.7e308};
    for (int k = 0; k < 5; k++) {
        sl_uv_triangles t;
        double high = 0.0, low = 1.0;
        make_patches(&rng, &p);
        for (int32_t i = 0; i < 2 * CHARTS * CORNERS && k > 0; i++) {
            p.uv[i] = scale[k] * (p.uv[i] - 0.4);
        }
        assert_int_equal(sl_uv_triangles_init(&p.polygons, p.uv, NULL, &t, NULL), SL_OK);
        sl_uv_triangles_window(&t, window);
        for (int32_t i = 0; i < 2 * t.nv; i++) {
            low = fmin(low, window[i]);
            high = fmax(high, window[i]);
            assert_true(k > 0 || window[i] == t.uv[i]);
        }
        assert_true(low >= 0.0 && high <= 1.0);
        assert_true(k == 0 || (low == 0.0 && high == 1.0));
        sl_uv_triangles_clear(&t);
    }
}

static void a_corner_without_a_uv_is_named(void **state)
{
    (void)state;
    static patches p;
    static const double bad[] = {NAN, INFINITY, -INFINITY};
    test_rng rng = test_rng_seed(0xbad0);
    for (int k = 0; k < 3; k++) {
        sl_uv_triangles t;
        sl_diag diag = sl_diag_none();
        make_patches(&rng, &p);
        p.uv[8 * 17 + k] = bad[k];
        assert_int_equal(sl_uv_triangles_init(&p.polygons, p.uv, &p.table, &t, &diag), SL_BAD_INPUT);
        assert_int_equal(diag.element, 17);
        sl_uv_triangles_clear(&t);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(copies_that_lie_on_their_source_are_left_out_and_others_stay),
        cmocka_unit_test(a_polygon_is_copied_once_by_each_chart),
        cmocka_unit_test(the_window_is_the_unit_square_or_holds_all_uvs),
        cmocka_unit_test(a_corner_without_a_uv_is_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
