/* Who is let in. */
#include "support/test_support.h"
#include "view/guard.h"

#include <string.h>

static void tokens_are_hexadecimal_and_never_the_same(void **state)
{
    char a[SL_GUARD_TOKEN], b[SL_GUARD_TOKEN];
    (void)state;
    assert_int_equal(sl_guard_token(a), SL_OK);
    assert_int_equal(sl_guard_token(b), SL_OK);
    assert_int_equal(strlen(a), SL_GUARD_TOKEN - 1);
    assert_int_equal(strspn(a, "0123456789abcdef"), SL_GUARD_TOKEN - 1);
    assert_string_not_equal(a, b);
    assert_true(sl_guard_same(a, a));
    assert_false(sl_guard_same(a, b));
    assert_false(sl_guard_same(a, ""));
    assert_false(sl_guard_same("", a));
    for (int k = 0; k < SL_GUARD_TOKEN - 1; k++) { /* any one character makes it another */
        memcpy(b, a, sizeof b);
        b[k] = b[k] == '0' ? '1' : '0';
        assert_false(sl_guard_same(a, b));
    }
}

static void only_this_machine_and_port_are_hosts(void **state)
{
    (void)state;
    assert_true(sl_guard_host("127.0.0.1:8080", 8080));
    assert_true(sl_guard_host("localhost:8080", 8080));
    static const char *const others[] = {
        "127.0.0.1:8081", "127.0.0.1", "evil.example:8080", "127.0.0.1:8080.evil.example", "", "0.0.0.0:8080"};
    for (size_t k = 0; k < sizeof others / sizeof *others; k++) {
        assert_false(sl_guard_host(others[k], 8080));
    }
    assert_false(sl_guard_host(NULL, 8080));
}

static void only_the_own_page_is_an_origin(void **state)
{
    (void)state;
    assert_true(sl_guard_origin("http://127.0.0.1:9", 9));
    assert_true(sl_guard_origin("http://localhost:9", 9));
    assert_false(sl_guard_origin("https://127.0.0.1:9", 9));
    assert_false(sl_guard_origin("http://127.0.0.1:90", 9));
    assert_false(sl_guard_origin("null", 9));
    assert_false(sl_guard_origin(NULL, 9));
}

static void a_bucket_lets_through_its_rate_and_its_burst(void **state)
{
    (void)state;
    sl_guard_bucket bucket = sl_guard_bucket_full(10.0, 5.0, 0.0);
    int passed = 0;
    for (int k = 0; k < 100; k++) { /* all at once: the burst */
        passed += sl_guard_take(&bucket, 0.0);
    }
    assert_int_equal(passed, 5);
    for (int k = 1; k <= 1000; k++) { /* 100 a second over ten seconds: the rate */
        passed += sl_guard_take(&bucket, 0.01 * k);
    }
    assert_in_range(passed, 103, 106);
    assert_true(sl_guard_take(&bucket, 1e9)); /* a long rest fills it, no further than the burst */
    assert_true(bucket.level <= 5.0);
    assert_true(sl_guard_take(&bucket, 0.0)); /* a clock that goes back takes nothing away */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tokens_are_hexadecimal_and_never_the_same),
        cmocka_unit_test(only_this_machine_and_port_are_hosts),
        cmocka_unit_test(only_the_own_page_is_an_origin),
        cmocka_unit_test(a_bucket_lets_through_its_rate_and_its_burst),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
