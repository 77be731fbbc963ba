#include "support/test_support.h"

#include "symmetry/symmetry.h"

static void defaults_ask_for_six_digits(void **state)
{
    (void)state;
    assert_true(sl_symmetry_default().exact == 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(defaults_ask_for_six_digits)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
