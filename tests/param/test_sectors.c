#include "param/sectors.h"

#include "param/abf_charts.h"

static void interior_sectors_hold_every_corner_of_every_interior_vertex_once(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 6; seed++) {
        sl_patch *patch = chart_grid(5, 4, 0.2, chart_bumps, 0.7, seed);
        sl_sector_table table;
        assert_int_equal(sl_sectors_interior(patch, &table), SL_OK);
        int32_t s = 0;
        uint8_t *seen = calloc(3 * (size_t)patch->nt, 1);
        for (int32_t v = 0; v < patch->nv; v++) {
            if (patch->border[v] != 0) {
                continue;
            }
            assert_true(table.view.theta[s] == 2.0 * TEST_PI);
            for (int32_t p = table.view.first[s]; p < table.view.first[s + 1]; p++) {
                assert_int_equal(patch->tri[table.view.corner[p]], v);
                assert_int_equal(seen[table.view.corner[p]]++, 0);
            }
            s++;
        }
        assert_int_equal(table.view.count, s);
        for (int32_t c = 0; c < 3 * patch->nt; c++) {
            assert_int_equal(seen[c], patch->border[patch->tri[c]] == 0);
        }
        assert_int_equal(sl_sectors_check(patch, &table.view, NULL), SL_OK);
        free(seen);
        sl_sectors_clear(&table);
        sl_patch_free(patch);
    }
}

static void a_chart_without_interior_vertices_has_no_sectors(void **state)
{
    (void)state;
    sl_patch *patch = chart_grid(7, 1, 0.2, chart_bumps, 0.7, 0x51);
    sl_sector_table table;
    assert_int_equal(sl_sectors_interior(patch, &table), SL_OK);
    assert_int_equal(table.view.count, 0);
    assert_int_equal(table.view.first[0], 0);
    sl_sectors_clear(&table);
    sl_sectors_clear(&table);
    sl_patch_free(patch);
}

static void rotating_walks_the_fan_counter_clockwise(void **state)
{
    (void)state;
    sl_patch *patch = chart_hexagon(2, 0.2, chart_cap, 0.9, 0x52);
    for (int32_t v = 0; v < patch->nv; v++) {
        int32_t count = 0, expected = 0, c = patch->outgoing[v];
        for (int32_t i = 0; i < 3 * patch->nt; i++) {
            expected += patch->tri[i] == v;
        }
        do {
            const int32_t next = sl_corner_rotate(patch, c);
            assert_int_equal(patch->tri[c], v);
            if (next >= 0) {
                assert_int_equal(patch->tri[sl_corner_next(next)], patch->tri[sl_corner_prev(c)]);
            }
            c = next;
            count++;
        } while (c >= 0 && c != patch->outgoing[v] && count <= expected);
        assert_int_equal(count, expected);
        assert_true((c < 0) == (patch->border[v] != 0));
    }
    sl_patch_free(patch);
}

static void unusable_tables_are_refused_by_cause(void **state)
{
    (void)state;
    sl_patch *patch = chart_hexagon(2, 0.1, chart_cap, 0.9, 0x53);
    static const int32_t corner[] = {5, 17, 40, 3}, outside[] = {5, 17, 72, 3}, negative[] = {5, -1, 40, 3};
    static const int32_t first[] = {0, 1, 3, 4}, empty[] = {0, 1, 1, 4}, falling[] = {0, 3, 1, 4};
    static const double theta[] = {1.0, 2.0, 0.7}, infinite[] = {1.0, 2.0, INFINITY};
    const struct {
        sl_sectors sectors;
        sl_status status;
        int32_t bad;
    } cases[] = {
        {{3, first, corner, theta}, SL_OK, -1},         {{3, empty, corner, theta}, SL_INFEASIBLE, 1},
        {{3, falling, corner, theta}, SL_BAD_INPUT, 1}, {{3, first, outside, theta}, SL_BAD_INPUT, 1},
        {{3, first, negative, theta}, SL_BAD_INPUT, 1}, {{3, first, corner, infinite}, SL_BAD_INPUT, 2},
    };
    for (size_t i = 0; i < SL_COUNTOF(cases); i++) {
        int32_t bad = -1;
        assert_int_equal(sl_sectors_check(patch, &cases[i].sectors, &bad), cases[i].status);
        assert_int_equal(bad, cases[i].bad);
        assert_int_equal(sl_sectors_check(patch, &cases[i].sectors, NULL), cases[i].status);
    }
    sl_patch_free(patch);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(interior_sectors_hold_every_corner_of_every_interior_vertex_once),
        cmocka_unit_test(a_chart_without_interior_vertices_has_no_sectors),
        cmocka_unit_test(rotating_walks_the_fan_counter_clockwise),
        cmocka_unit_test(unusable_tables_are_refused_by_cause),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
