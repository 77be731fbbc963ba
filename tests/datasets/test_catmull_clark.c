/* Subdivision against positions worked out by hand and against the whole model where one half was modelled. */
#include "boxmodel.h"
#include "builder.h"
#include "support/test_support.h"

#include "base/memory.h"

#include <string.h>

static const double unit[] = {-1.0, 1.0};

static bool holds_point(const gen_cage *cage, double x, double y, double z, double tolerance)
{
    for (int64_t v = 0; v < cage->nv; v++) {
        const double *p = cage->xyz + 3 * v;
        const double d[3] = {p[0] - x, p[1] - y, p[2] - z};
        if (d[0] * d[0] + d[1] * d[1] + d[2] * d[2] <= tolerance * tolerance) {
            return true;
        }
    }
    return false;
}

/* Face points are centres; an edge point is 3/4 of the way out, a corner goes to 5/9: by the rules, on paper. */
static void a_cube_becomes_the_26_points_of_the_rules(void **state)
{
    (void)state;
    gen_cage cage = {0};
    gen_cage_box(&cage, (const int32_t[]){1, 1, 1}, (const double *const[]){unit, unit, unit});
    gen_cage_smooth(&cage);
    assert_false(cage.failed);
    assert_int_equal(cage.nv, 26);
    assert_int_equal(cage.nq, 24);
    for (int k = 0; k < 27; k++) {
        static const double reach[4] = {0.0, 1.0, 0.75, 5.0 / 9.0};
        const int d[3] = {k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
        const double r = reach[d[0] * d[0] + d[1] * d[1] + d[2] * d[2]];
        if (r > 0.0) {
            assert_true(holds_point(&cage, r * d[0], r * d[1], r * d[2], 8 * TEST_EPS));
        }
    }
    gen_cage_clear(&cage);
}

/* The border of an open quad: its four corners go to 3/4 of themselves and 1/4 of their neighbours' mean. */
static void a_border_is_subdivided_as_a_cubic_spline(void **state)
{
    (void)state;
    const double corner[12] = {0.1, 0.0, 0.3, 2.2, 0.1, -0.4, 2.5, 1.7, 0.2, -0.2, 1.4, 0.9};
    gen_cage cage = {.nv = 4, .nq = 1, .xyz_capacity = 12, .quad_capacity = 4};
    cage.xyz = sl_copy(corner, 12, sizeof *corner);
    cage.quad = sl_copy((int32_t[]){0, 1, 2, 3}, 4, sizeof(int32_t));
    gen_cage_smooth(&cage);
    assert_int_equal(cage.nv, 9);
    for (int i = 0; i < 4; i++) {
        double p[3], e[3];
        for (int k = 0; k < 3; k++) {
            const double here = corner[3 * i + k], after = corner[3 * ((i + 1) % 4) + k];
            p[k] = 0.75 * here + 0.125 * (after + corner[3 * ((i + 3) % 4) + k]);
            e[k] = 0.5 * (here + after);
        }
        assert_true(holds_point(&cage, p[0], p[1], p[2], 16 * TEST_EPS));
        assert_true(holds_point(&cage, e[0], e[1], e[2], 16 * TEST_EPS));
    }
    gen_cage_clear(&cage);
}

/* A function of |x|, y, z: moves both halves alike, nothing out of the plane x = 0. */
static void dent(double *p)
{
    const double x = p[0] < 0.0 ? -p[0] : p[0], sign = p[0] < 0.0 ? -1.0 : 1.0;
    const double a = p[1], b = p[2];
    p[0] = sign * x * (1.0 + 0.31 * a + 0.17 * b);
    p[1] = a + 0.23 * x * x + 0.11 * b;
    p[2] = b - 0.19 * x * a;
}

static sl_generated *dented_box(bool mirrored, int32_t levels)
{
    static const double whole[] = {-1.3, -0.6, 0.0, 0.6, 1.3}, half[] = {0.0, 0.6, 1.3};
    static const double y[] = {-0.9, 0.2, 1.0}, z[] = {-0.7, 0.1, 0.5, 1.1};
    sl_generated *mesh = NULL;
    gen_cage cage = {.mirrored = mirrored};
    gen_cage_box(&cage, (const int32_t[]){mirrored ? 2 : 4, 2, 3},
                 (const double *const[]){mirrored ? half : whole, y, z});
    for (int64_t v = 0; v < cage.nv; v++) {
        dent(cage.xyz + 3 * v);
    }
    assert_int_equal(gen_cage_finish(&cage, levels, &mesh), SL_OK);
    return mesh;
}

static void a_mirrored_half_becomes_what_the_whole_becomes(void **state)
{
    (void)state;
    for (int32_t levels = 0; levels <= 3; levels++) {
        sl_generated *whole = dented_box(false, levels), *joined = dented_box(true, levels);
        const gen_cage lookup = {.xyz = whole->xyz, .nv = whole->nv};
        assert_int_equal(joined->nv, whole->nv);
        assert_int_equal(joined->nf, whole->nf);
        for (int32_t v = 0; v < joined->nv; v++) {
            const double *p = joined->xyz + 3 * (int64_t)v;
            assert_true(holds_point(&lookup, p[0], p[1], p[2], 64 * TEST_EPS));
        }
        sl_generated_free(whole);
        sl_generated_free(joined);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cube_becomes_the_26_points_of_the_rules),
        cmocka_unit_test(a_border_is_subdivided_as_a_cubic_spline),
        cmocka_unit_test(a_mirrored_half_becomes_what_the_whole_becomes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
