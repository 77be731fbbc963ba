/* Room at borders that touch: what was an embedding stays one, what only touched becomes one. */
#include "param/open.h"

#include "base/memory.h"
#include "param/flatten_internal.h"
#include "param/stretch_charts.h"
#include "param/stretch_internal.h"

/* A ring of 2 x n triangles, slit open: the two banks of the slit lie on one another when projected. */
static sl_patch *slit_ring(int32_t n, double turn)
{
    sl_patch *patch = NULL;
    double *xyz = malloc(6 * (size_t)(n + 1) * sizeof *xyz);
    int32_t *tri = malloc(6 * (size_t)n * sizeof *tri);
    for (int32_t i = 0; i <= n; i++) {
        for (int32_t j = 0; j < 2; j++) {
            const double a = turn + 2.0 * TEST_PI * (i % n) / n, r = 1.0 + 0.7 * j + 0.1 * sin(3.0 * a) * j;
            const double p[3] = {r * cos(a), r * sin(a), 0.0};
            memcpy(xyz + 3 * (2 * i + j), p, sizeof p);
        }
    }
    for (int32_t i = 0; i < n; i++) {
        const int32_t v = 2 * i, quad[6] = {v, v + 1, v + 3, v, v + 3, v + 2};
        memcpy(tri + 6 * i, quad, sizeof quad);
    }
    assert_int_equal(sl_patch_from_triangles(2 * (n + 1), xyz, 2 * n, tri, &patch), SL_OK);
    free(xyz);
    free(tri);
    return patch;
}

/* The border in loop order. */
static int32_t *border_of(const sl_patch *patch, int32_t *nb)
{
    int32_t *pair = NULL;
    assert_int_equal(sl_patch_border_edges(patch, nb, &pair), SL_OK);
    return pair;
}

static void a_slit_that_touches_itself_is_opened(void **state)
{
    (void)state;
    for (int32_t n = 5; n < 40; n += 7) {
        sl_patch *patch = slit_ring(n, 0.3 * n);
        double *uv = malloc(2 * (size_t)patch->nv * sizeof *uv), *flat = malloc(2 * (size_t)patch->nv * sizeof *flat);
        int32_t nb = 0, *border = border_of(patch, &nb);
        sl_certificate c;
        assert_true(sl_flatten_project(patch, flat));
        memcpy(uv, flat, 2 * (size_t)patch->nv * sizeof *uv);
        assert_false(chart_certify(patch, uv).embedded);
        assert_int_equal(sl_flatten_certify(patch, nb, border, uv, &c), SL_OK);
        assert_true(c.embedded && chart_certify(patch, uv).embedded);
        for (int32_t i = 0; i < 2 * patch->nv; i++) {
            assert_true(fabs(uv[i] - flat[i]) < 1e-3);
        }
        sl_free(border);
        free(uv);
        free(flat);
        sl_patch_free(patch);
    }
}

/* An independent word for "inwards": every border vertex goes into one of its own triangles, or along an edge. */
static void border_vertices_move_into_their_triangles(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x09e4);
    for (int trial = 0; trial < 20; trial++) {
        sl_patch *patch = chart_grid(5, 4, 0.3, chart_bumps, 0.0, (uint64_t)trial);
        int32_t nb = 0, *border = border_of(patch, &nb);
        double uv[200], out[200], angle[100];
        const double share = test_uniform(&rng, 0.001, 0.01);
        assert_true(patch->nv <= 100);
        for (int32_t v = 0; v < patch->nv; v++) {
            uv[2 * v] = patch->xyz[3 * v];
            uv[2 * v + 1] = patch->xyz[3 * v + 1];
        }
        if (chart_certify(patch, uv).flipped > 0) {
            for (int32_t v = 0; v < patch->nv; v++) {
                uv[2 * v] = -uv[2 * v];
            }
        }
        assert_int_equal(chart_certify(patch, uv).flipped, 0);
        sl_open_border(patch, nb, border, uv, share, 0.0, angle, out);
        for (int32_t v = 0; v < patch->nv; v++) {
            bool inside = patch->border[v] == 0 && out[2 * v] == uv[2 * v] && out[2 * v + 1] == uv[2 * v + 1];
            for (int32_t c = 0; c < 3 * patch->nt && !inside; c++) {
                if (patch->tri[c] == v) {
                    const double *a = uv + 2 * v, *p = out + 2 * v;
                    const double *b = uv + 2 * patch->tri[sl_corner_next(c)];
                    const double *d = uv + 2 * patch->tri[sl_corner_prev(c)];
                    inside = sl_orient2d(a, b, p) >= 0 && sl_orient2d(d, a, p) >= 0 && sl_orient2d(b, d, p) > 0 &&
                             (p[0] != a[0] || p[1] != a[1]);
                }
            }
            assert_true(inside);
        }
        sl_free(border);
        sl_patch_free(patch);
    }
}

static void rounding_closes_what_is_nearer_than_the_step(void **state)
{
    (void)state;
    /* a letter C whose ends are 0.013 apart */
    const double uv[] = {0, 0, 3, 0.1, 3.1, 1.5, 1, 1.4, 1.02, 1.513, 3.05, 1.513, 3, 3, 0.1, 2.9};
    const int32_t border[] = {0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6, 7, 7, 0};
    double work[16];
    bool survives;
    assert_int_equal(sl_border_survives(8, 8, border, uv, 1e-4, work, &survives), SL_OK);
    assert_true(survives);
    assert_int_equal(sl_border_survives(8, 8, border, uv, 0.5, work, &survives), SL_OK);
    assert_false(survives);
    const double bad[] = {0, 0, NAN, 1, 1, 2};
    assert_int_equal(sl_border_survives(3, 3, (int32_t[]){0, 1, 1, 2, 2, 0}, bad, 0.1, work, &survives), SL_BAD_INPUT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_slit_that_touches_itself_is_opened),
        cmocka_unit_test(border_vertices_move_into_their_triangles),
        cmocka_unit_test(rounding_closes_what_is_nearer_than_the_step),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
