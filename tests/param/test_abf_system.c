/* The Schur complement of ABF++ against dense products. */
#include "param/abf_internal.h"

#include "param/abf_charts.h"
#include "param/abf_sectors.h"

static const int32_t no_rows[1];

/* Dense J2 (nrows x nc), a row at a time through the transposed product. */
static double *dense_jacobian(const sl_abf_system *system, int32_t nc)
{
    double *J = calloc((size_t)system->nrows * (size_t)nc, sizeof *J),
           *unit = calloc((size_t)system->nrows, sizeof *unit);
    for (int32_t r = 0; r < system->nrows; r++) {
        unit[r] = 1.0;
        sl_abf_system_apply_transposed(system, unit, &J[(size_t)r * (size_t)nc]);
        unit[r] = 0.0;
    }
    free(unit);
    return J;
}

/* J2 D J2' - (J2 D J1') inv(J1 D J1') (J1 D J2'), entry by entry. */
static double dense_schur(const double *a, const double *b, const double *d, int32_t nc)
{
    double sum = 0.0;
    for (int32_t t = 0; t < nc / 3; t++) {
        double ad = 0.0, bd = 0.0, dd = 0.0;
        for (int32_t c = 3 * t; c < 3 * t + 3; c++) {
            sum += a[c] * d[c] * b[c];
            ad += a[c] * d[c];
            bd += b[c] * d[c];
            dd += d[c];
        }
        sum -= ad * bd / dd;
    }
    return sum;
}

static void check_schur(const sl_patch *patch, const sl_sectors *sectors, sl_abf_wheel wheel, uint64_t seed)
{
    test_rng rng = test_rng_seed(seed);
    const int32_t nc = 3 * patch->nt;
    sl_abf_system system;
    assert_int_equal(sl_abf_system_init(&system, patch, sectors, 0, no_rows), SL_OK);
    double *alpha = malloc((size_t)nc * sizeof *alpha), *d = malloc((size_t)nc * sizeof *d),
           *Lambda = malloc((size_t)nc * sizeof *Lambda);
    for (int round = 0; round < 2; round++) { /* the second finds nothing left of the first */
        for (int32_t c = 0; c < nc; c++) {
            alpha[c] = test_uniform(&rng, 0.2, 2.4);
            d[c] = test_uniform(&rng, 0.01, 2.0);
            Lambda[c] = 1.0 / d[c];
        }
        sl_abf_system_linearise(&system, wheel, alpha);
        sl_abf_system_assemble(&system, Lambda);
        assert_int_equal(sl_csc_check(system.M, true), SL_OK);
        double *J = dense_jacobian(&system, nc);
        const sl_csc *M = system.M;
        for (int32_t q = 0; q < system.nrows; q++) {
            int64_t p = M->colptr[q];
            for (int32_t r = q; r < system.nrows; r++) {
                const double expected = dense_schur(&J[(size_t)r * (size_t)nc], &J[(size_t)q * (size_t)nc], d, nc);
                const bool stored = p < M->colptr[q + 1] && M->row[p] == r;
                assert_true(test_near(stored ? M->val[p] : 0.0, expected, 1e-12));
                p += stored;
            }
            assert_true(p == M->colptr[q + 1]);
        }
        free(J);
    }
    sl_abf_system_clear(&system);
    free(alpha);
    free(d);
    free(Lambda);
}

static void schur_complement_matches_the_dense_product(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 4; seed++) {
        sl_patch *patch = chart_grid(5, 4, 0.2, chart_bumps, 1.0, seed);
        sl_sector_table table;
        assert_int_equal(sl_sectors_interior(patch, &table), SL_OK);
        check_schur(patch, &table.view, SL_ABF_LOG, seed);
        check_schur(patch, &table.view, SL_ABF_PRODUCT, seed);
        sl_sectors_clear(&table);
        sl_patch_free(patch);
    }
}

/* Random runs of corners: across vertices, overlapping, two corners of one triangle, a corner twice, border corners. */
static void schur_complement_takes_any_sectors(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xa5);
    for (uint64_t seed = 1; seed <= 4; seed++) {
        sl_patch *patch = chart_hexagon(3, 0.2, chart_cap, 1.0, seed);
        int32_t first[13] = {0}, corner[12 * 5];
        double theta[12];
        for (int32_t s = 0; s < 12; s++) {
            first[s + 1] = first[s] + 1 + test_index(&rng, 5);
            theta[s] = test_uniform(&rng, 0.4, 6.0);
        }
        for (int32_t p = 0; p < first[12]; p++) {
            corner[p] = p % 4 == 3 ? corner[p - 1] / 3 * 3 + test_index(&rng, 3) : test_index(&rng, 3 * patch->nt);
        }
        const sl_sectors sectors = {12, first, corner, theta};
        check_schur(patch, &sectors, SL_ABF_LOG, seed);
        sl_patch_free(patch);
    }
}

/* <J' y, x> = <y, J x>, and the g2 part of J' counts how often a corner stands in a sector. */
static void products_with_the_jacobian_are_adjoint(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xad);
    sl_patch *patch = chart_grid(6, 4, 0.2, chart_bumps, 1.0, 0xad);
    const int32_t nc = 3 * patch->nt;
    static const int32_t first[] = {0, 4, 6}, corner[] = {10, 11, 40, 10, 40, 7};
    static const double theta[] = {3.0, 1.0};
    const sl_sectors sectors = {2, first, corner, theta};
    sl_abf_system system;
    assert_int_equal(sl_abf_system_init(&system, patch, &sectors, 0, no_rows), SL_OK);
    double *x = malloc((size_t)nc * sizeof *x), *y = malloc((size_t)system.nrows * sizeof *y);
    double *Jx = calloc((size_t)system.nrows, sizeof *Jx), *Jty = calloc((size_t)nc, sizeof *Jty);
    for (int32_t c = 0; c < nc; c++) {
        x[c] = test_uniform(&rng, 0.3, 1.5);
    }
    sl_abf_system_linearise(&system, SL_ABF_LOG, x);
    double left = 0.0, right = 0.0;
    for (int32_t r = 0; r < system.nrows; r++) {
        y[r] = test_uniform(&rng, -1.0, 1.0);
    }
    sl_abf_system_apply_transposed(&system, y, Jty);
    sl_abf_system_subtract(&system, x, Jx);
    for (int32_t c = 0; c < nc; c++) {
        left += Jty[c] * x[c];
    }
    for (int32_t r = 0; r < system.nrows; r++) {
        right -= y[r] * Jx[r];
    }
    assert_true(test_near(left, right, 1e-12));
    assert_true(test_near(-Jx[0], 2.0 * x[10] + x[11] + x[40], 1e-15));
    assert_true(test_near(-Jx[1], x[40] + x[7], 1e-15));
    sl_abf_system_clear(&system);
    free(x);
    free(y);
    free(Jx);
    free(Jty);
    sl_patch_free(patch);
}

static void rows_stand_where_their_vertex_stands(void **state)
{
    (void)state;
    sl_patch *patch = chart_grid(4, 4, 0.2, chart_bumps, 1.0, 0x99);
    sl_sector_table table;
    sl_abf_system system;
    assert_int_equal(sl_sectors_interior(patch, &table), SL_OK);
    assert_int_equal(sl_abf_system_init(&system, patch, &table.view, 0, no_rows), SL_OK);
    double xyz[3 * 18];
    assert_int_equal(system.nrows, 18);
    sl_abf_system_points(&system, xyz);
    int32_t i = 0;
    for (int32_t v = 0; v < patch->nv; v++) {
        if (patch->border[v] == 0) {
            assert_memory_equal(&xyz[3 * i], &patch->xyz[3 * v], 3 * sizeof *xyz);
            assert_memory_equal(&xyz[3 * (i + 9)], &patch->xyz[3 * v], 3 * sizeof *xyz);
            i++;
        }
    }
    sl_abf_system_clear(&system);
    sl_sectors_clear(&table);
    sl_patch_free(patch);
}

static void bad_sectors_leave_nothing_behind(void **state)
{
    (void)state;
    sl_patch *patch = chart_grid(3, 3, 0.2, chart_bumps, 1.0, 0xb5);
    static const int32_t empty[] = {0, 2, 2}, first[] = {0, 1, 2}, corner[] = {3, 5}, outside[] = {3, 54};
    static const double theta[] = {3.0, 1.0};
    sl_abf_system system;
    assert_int_equal(sl_abf_system_init(&system, patch, &(sl_sectors){2, empty, corner, theta}, 0, no_rows),
                     SL_INFEASIBLE);
    assert_null(system.M);
    assert_int_equal(sl_abf_system_init(&system, patch, &(sl_sectors){2, first, outside, theta}, 0, no_rows),
                     SL_BAD_INPUT);
    assert_null(system.wheel_row);
    sl_patch_free(patch);
}

/* J by its product with a random vector against the residuals' differences, and M against what was promised of it. */
static void the_matrices_shown_are_those_of_the_system(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x3a);
    sl_patch *patch = chart_grid(5, 4, 0.2, chart_bumps, 1.0, 0x3a);
    const int32_t nc = 3 * patch->nt;
    for (int form = 0; form < 3; form++) {
        sl_sector_table table = make_sectors(patch, true);
        sl_abf_def def = sl_abf_default();
        def.sectors = &table.view;
        def.wheel = (sl_abf_wheel)form;
        sl_abf *solver;
        assert_int_equal(sl_abf_create(patch, &def, &solver), SL_OK);
        assert_int_equal(sl_abf_step(solver, 1, NULL), SL_OK);
        const sl_abf_sizes sizes = sl_abf_sizes_of(solver);
        const int32_t n = sizes.triangles + sizes.sectors + sizes.wheels;
        sl_csc *J;
        assert_int_equal(sl_abf_jacobian(solver, &J), SL_OK);
        assert_int_equal(sl_csc_check(J, false), SL_OK);
        assert_true(J->nrows == n && J->ncols == nc && sizes.angles == nc && J->colptr[nc] == sizes.jacobian_nonzeros);
        assert_true(sl_abf_schur(solver)->nrows == sizes.schur_rows && sizes.schur_rows == n - patch->nt);
        assert_true(sl_abf_schur(solver)->colptr[sizes.schur_rows] == sizes.schur_nonzeros);
        assert_true(sizes.factor_nonzeros >= sizes.schur_nonzeros);
        double *x = malloc((size_t)nc * sizeof *x), *y = malloc((size_t)n * sizeof *y), *g[2];
        for (int32_t c = 0; c < nc; c++) {
            x[c] = test_uniform(&rng, -1.0, 1.0);
        }
        sl_csc_multiply(J, x, y);
        for (int side = 0; side < 2; side++) {
            double *at = malloc((size_t)nc * sizeof *at);
            for (int32_t c = 0; c < nc; c++) {
                at[c] = sl_abf_angles(solver)[c] + (side == 0 ? -1e-5 : 1e-5) * x[c];
            }
            g[side] = malloc((size_t)n * sizeof(double));
            sl_abf_eval_g1(patch, at, g[side]);
            sl_abf_eval_g2(&table.view, at, &g[side][patch->nt]);
            sl_abf_eval_g3(patch, def.wheel, at, &g[side][patch->nt + sizes.sectors]);
            free(at);
        }
        for (int32_t r = 0; r < n; r++) {
            assert_true(test_near(y[r], (g[1][r] - g[0][r]) / 2e-5, 1e-7));
        }
        free(x);
        free(y);
        free(g[0]);
        free(g[1]);
        sl_csc_free(J);
        sl_abf_free(solver);
        sl_sectors_clear(&table);
    }
    sl_patch_free(patch);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(schur_complement_matches_the_dense_product),
        cmocka_unit_test(schur_complement_takes_any_sectors),
        cmocka_unit_test(products_with_the_jacobian_are_adjoint),
        cmocka_unit_test(rows_stand_where_their_vertex_stands),
        cmocka_unit_test(bad_sectors_leave_nothing_behind),
        cmocka_unit_test(the_matrices_shown_are_those_of_the_system),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
