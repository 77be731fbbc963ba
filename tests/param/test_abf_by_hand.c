/* The worked example of reports/design/abf-by-hand.md: eight triangles whose solution is known in closed form. */
#include "param/abf_internal.h"
#include "param/constraints.h"
#include "support/test_support.h"

#include <math.h>

#define PI TEST_PI

static const double tent_xyz[] = {0, 0,  1, 2, 0,  0,  1, 1, 0,  0, 2, 0,  -1, 1,
                                  0, -2, 0, 0, -1, -1, 0, 0, -2, 0, 1, -1, 0};
static const int32_t tent_tri[] = {0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5, 0, 5, 6, 0, 6, 7, 0, 7, 8, 0, 8, 1};

enum { TRIANGLES = 8 };

static sl_patch *make_tent(void)
{
    sl_patch *patch = NULL;
    assert_int_equal(sl_patch_from_triangles(9, tent_xyz, TRIANGLES, tent_tri, &patch), SL_OK);
    return patch;
}

/* a, p, q of a corner by its vertex: the top, a corner of the square (odd), the middle of a side. */
static double by_kind(const sl_patch *patch, int32_t c, const double apq[3])
{
    const double *x = &patch->xyz[3 * (int64_t)patch->tri[c]];
    return x[2] > 0.5 ? apq[0] : x[0] * x[1] == 0.0 ? apq[1] : apq[2];
}

static void assert_angles(const sl_patch *patch, const double *angle, const double apq[3])
{
    for (int32_t c = 0; c < 3 * TRIANGLES; c++) {
        assert_true(test_near(angle[c], by_kind(patch, c, apq), 64 * 0x1p-52));
    }
}

static void the_tent_is_solved_in_one_step_as_by_hand(void **state)
{
    (void)state;
    sl_patch *patch = make_tent();
    const sl_abf_def def = sl_abf_default();
    sl_abf *solver = NULL;
    assert_int_equal(sl_abf_create(patch, &def, &solver), SL_OK);
    const double phi[3] = {PI / 4.0, acos(2.0 / sqrt(10.0)), PI / 2.0};
    const double excess = phi[0] + phi[1] + phi[2] - PI, mu = excess / (phi[1] * phi[1] + phi[2] * phi[2]);
    assert_angles(patch, sl_abf_angles(solver), phi);
    assert_true(test_near(sl_abf_info_of(solver)->g1, excess, 64 * 0x1p-52));
    assert_int_equal(sl_abf_step(solver, 1, NULL), SL_OK);
    const double alpha[3] = {phi[0], phi[1] - mu * phi[1] * phi[1], phi[2] - mu * phi[2] * phi[2]};
    assert_angles(patch, sl_abf_angles(solver), alpha);
    const sl_abf_info *info = sl_abf_info_of(solver);
    assert_true(info->converged && info->iterations == 1);
    assert_true(test_near(info->energy, TRIANGLES * excess * mu, 1e-14));
    const sl_abf_view view = sl_abf_view_of(solver);
    assert_true(test_near(view.lambda2[0], -2.0 * mu, 1e-14) && test_near(view.lambda2[1], 0.0, 1e-14));
    assert_true(test_near(view.lambda1[3], 2.0 * mu, 1e-14));
    sl_abf_free(solver);
    sl_patch_free(patch);
}

static void its_schur_complement_is_that_of_the_text(void **state)
{
    (void)state;
    sl_patch *patch = make_tent();
    const sl_abf_def def = sl_abf_default();
    sl_abf *solver = NULL;
    assert_int_equal(sl_abf_create(patch, &def, &solver), SL_OK);
    assert_int_equal(sl_abf_step(solver, 1, NULL), SL_OK);
    const double phi[3] = {PI / 4.0, acos(2.0 / sqrt(10.0)), PI / 2.0};
    const double D[3] = {phi[0] * phi[0] / 2.0, phi[1] * phi[1] / 2.0, phi[2] * phi[2] / 2.0};
    const double S = D[0] + D[1] + D[2], cot = 1.0 / tan(phi[1]);
    const sl_csc *M = sl_abf_schur(solver);
    assert_int_equal(M->nrows, 2);
    assert_true(test_near(M->val[0], TRIANGLES * (D[0] - D[0] * D[0] / S), 1e-14));
    assert_true(test_near(M->val[1], 0.0, 1e-14));
    assert_true(test_near(M->val[2], TRIANGLES * cot * cot * (D[1] - D[1] * D[1] / S), 1e-14));
    assert_true(test_near(M->val[0], 2.074, 5e-4) && test_near(M->val[2], 1.669, 5e-4));
    sl_abf_free(solver);
    sl_patch_free(patch);
}

static void its_rectangle_is_the_flat_square(void **state)
{
    (void)state;
    sl_patch *patch = make_tent();
    int32_t corner[4], count = 0;
    for (int32_t v = 0; v < 9; v++) {
        const double *x = &patch->xyz[3 * (int64_t)v];
        if (x[2] < 0.5 && x[0] * x[1] == 0.0) {
            corner[count++] = v;
        }
    }
    /* in border order: by angle around the top, whatever numbers the patch gave them */
    for (int i = 0; i < 4; i++) {
        for (int j = i + 1; j < 4; j++) {
            const double *a = &patch->xyz[3 * (int64_t)corner[i]], *b = &patch->xyz[3 * (int64_t)corner[j]];
            if (atan2(b[1], b[0]) < atan2(a[1], a[0])) {
                const int32_t other = corner[i];
                corner[i] = corner[j];
                corner[j] = other;
            }
        }
    }
    const sl_constraint rectangle = {SL_CONSTRAINT_POLYGON, 4, corner, 0.0};
    sl_sector_table table = {0};
    assert_int_equal(sl_constraints_compile(patch, 1, &rectangle, NULL, &table, NULL), SL_OK);
    sl_abf_def def = sl_abf_default();
    def.sectors = &table.view;
    sl_abf *solver = NULL;
    assert_int_equal(sl_abf_create(patch, &def, &solver), SL_OK);
    assert_int_equal(sl_abf_step(solver, 5, NULL), SL_OK);
    const double square[3] = {PI / 4.0, PI / 4.0, PI / 2.0}, phi_p = acos(2.0 / sqrt(10.0));
    const double off = (PI / 4.0 - phi_p) / phi_p;
    assert_angles(patch, sl_abf_angles(solver), square);
    assert_int_equal(sl_abf_info_of(solver)->dependent, 1);
    assert_true(test_near(sl_abf_info_of(solver)->energy, TRIANGLES * off * off, 1e-13));
    sl_abf_free(solver);
    sl_sectors_clear(&table);
    sl_patch_free(patch);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_tent_is_solved_in_one_step_as_by_hand),
        cmocka_unit_test(its_schur_complement_is_that_of_the_text),
        cmocka_unit_test(its_rectangle_is_the_flat_square),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
