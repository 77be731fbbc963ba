#include "atlas/weld.h"
#include "support/test_support.h"

#include <math.h>
#include <stdlib.h>

/* Oracle: all pairs. */
static void check_against_pairs(int32_t n, int32_t dim, const double *point)
{
    int32_t *id = calloc((size_t)n + 1, sizeof *id), count = -1, next = 0;
    assert_int_equal(sl_weld_points(n, dim, point, id, &count), SL_OK);
    for (int32_t i = 0; i < n; i++) {
        int32_t expected = -1;
        for (int32_t j = 0; j < i && expected < 0; j++) {
            bool same = true;
            for (int32_t k = 0; k < dim; k++) {
                same = same && point[dim * i + k] == point[dim * j + k];
            }
            expected = same ? id[j] : -1;
        }
        assert_int_equal(id[i], expected >= 0 ? expected : next);
        next += expected < 0;
    }
    assert_int_equal(count, next);
    free(id);
}

static void equal_points_and_only_they_share_a_number(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x3e1d);
    for (int trial = 0; trial < 60 * test_multiplier(); trial++) {
        const int32_t n = test_index(&rng, 90), dim = 2 + test_index(&rng, 2);
        const double pool[] = {-0.0, 0.0, 0.37, 0.37 + 0x1p-54, -1.9e300, 4e-310};
        double point[3 * 90];
        for (int32_t i = 0; i < dim * n; i++) {
            point[i] = pool[test_index(&rng, (int32_t)SL_COUNTOF(pool))];
        }
        check_against_pairs(n, dim, point);
    }
}

static void points_that_are_no_numbers_stay_apart(void **state)
{
    (void)state;
    const double point[] = {NAN, 0.5, NAN, 0.5, 0.25, 0.5};
    check_against_pairs(3, 2, point);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equal_points_and_only_they_share_a_number),
        cmocka_unit_test(points_that_are_no_numbers_stay_apart),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
