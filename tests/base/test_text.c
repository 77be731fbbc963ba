/* Oracle: the C library's strtod and printf, correctly rounded on this platform. */
#include "base/text.h"
#include "support/test_support.h"

#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Parses a copy without a terminator, so that a checker of memory sees a byte read too many. */
static int64_t parse_exact(const char *text, double *value)
{
    const size_t n = strlen(text);
    char *copy = malloc(n + (n == 0));
    assert_non_null(copy);
    memcpy(copy, text, n);
    const int64_t used = sl_parse_double(copy, copy + n, value) - copy;
    free(copy);
    return used;
}

static void assert_reads_as_strtod(const char *text)
{
    double ours = -1.0;
    char *end;
    const double theirs = strtod(text, &end);
    const int64_t used = parse_exact(text, &ours);
    if (used != end - text || memcmp(&ours, &theirs, sizeof ours) != 0) {
        fail_msg("'%s' reads as %a (%d bytes), not %a", text, ours, (int)used, theirs);
    }
}

static double random_double(test_rng *rng)
{
    for (;;) {
        const uint64_t bits = test_bits(rng);
        double x;
        memcpy(&x, &bits, sizeof x);
        if (isfinite(x)) {
            return x;
        }
    }
}

static void parsing_agrees_with_strtod_for_any_number_of_digits(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(100);
    char text[80];
    for (int trial = 0; trial < 100000 * test_multiplier(); trial++) {
        const double x =
            trial % 2 == 0 ? random_double(&rng) : test_uniform(&rng, -1.0, 1.0) * pow(10.0, test_index(&rng, 14) - 7);
        snprintf(text, sizeof text, trial % 3 == 0 ? "%.*e" : "%.*g", test_index(&rng, 30), x);
        assert_reads_as_strtod(text);
    }
}

static void parsing_breaks_ties_to_even_however_long_the_text(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(101);
    static char text[1400];
    for (int trial = 0; trial < 2000 * test_multiplier(); trial++) {
        uint64_t bits = test_bits(&rng) >> 1;
        bits = trial % 4 == 0 ? bits >> (12 + test_index(&rng, 30)) : bits; /* subnormal ones too */
        double below, above;
        memcpy(&below, &bits, sizeof below);
        bits++;
        memcpy(&above, &bits, sizeof above);
        if (!isfinite(above)) {
            continue;
        }
        const long double middle = ((long double)below + (long double)above) / 2.0L; /* 54 bits: exact */
        const int n = snprintf(text, sizeof text - 2, "%.1200Lg", middle);
        assert_true(n > 0 && n < (int)sizeof text - 2);
        assert_reads_as_strtod(text);
        char *mark = strchr(text, 'e');
        if (strchr(text, '.') != NULL) { /* a little more than the middle rounds up */
            mark = mark != NULL ? mark : text + n;
            memmove(mark + 1, mark, strlen(mark) + 1);
            *mark = '1';
            double ours = 0.0;
            parse_exact(text, &ours);
            assert_true(ours == above);
        }
    }
}

static void parsing_knows_the_edges_of_the_range(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "0",
        "-0",
        "0.0e5",
        "1e22",
        "1e23",
        "123456789012345678901234567890",
        "9007199254740993",
        "9007199254740993.00000000000000000000000000000000000000000000000000000000000000001",
        "4.9406564584124654e-324",
        "2.4703282292062327e-324",
        "2.4703282292062328e-324",
        "2.2250738585072011e-308",
        "2.2250738585072014e-308",
        "1.7976931348623157e308",
        "1.7976931348623158e308",
        "1.7976931348623159e308",
        "1e-400",
        "1e400",
        "-1e999999999999999999999",
        "1e-99999999999999999999",
        "0e999999999999",
        "0.000000000000000000000000000000000000001e39",
        "100000000000000000000000e-23",
        "18446744073709551616",
        "18446744073709551615",
        "9999999999999999999",
        "1.e3",
        ".5",
        "+.5e+1",
        "8.5e-320",
        "00000000000000000000001.5",
        "0.00000000000000000000000000012345678901234567890123456789",
        "12345678901234567890e27",
        "7e-27",
        "7e-28",
    };
    for (size_t k = 0; k < SL_COUNTOF(texts); k++) {
        assert_reads_as_strtod(texts[k]);
    }
}

/* Digits that decide only by being there: after more of them than any exact method keeps, and in a remainder. */
static void parsing_heeds_the_last_of_very_many_digits(void **state)
{
    (void)state;
    static char text[3100];
    for (int zeros = 600; zeros < 3000; zeros += 97) { /* half way between two doubles, and a trifle more */
        const int n = snprintf(text, sizeof text, "9007199254740993.%0*d10000", zeros, 0);
        assert_true(n < (int)sizeof text);
        assert_reads_as_strtod(text);
        double value = 0.0;
        parse_exact(text, &value);
        assert_true(value == 9007199254740994.0);
    }
    test_rng rng = test_rng_seed(104);
    for (int trial = 0; trial < 100000 * test_multiplier(); trial++) {
        const uint64_t w = 100000000000000000u + test_bits(&rng) % 9900000000000000000u;
        snprintf(text, sizeof text, "%llue%d", (unsigned long long)w, test_index(&rng, 8) - 30);
        assert_reads_as_strtod(text);
    }
}

static void parsing_stops_where_the_number_ends(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        int64_t used;
        double value;
    } cases[] = {{"", 0, 0},    {"-", 0, 0},     {".", 0, 0},     {"+.", 0, 0},     {"e5", 0, 0},
                 {"abc", 0, 0}, {" 1", 0, 0},    {"1e", 1, 1},    {"1e+", 1, 1},    {"1.5.2", 3, 1.5},
                 {"2,5", 1, 2}, {"12/3", 2, 12}, {"-7 8", 2, -7}, {"3e2x", 3, 300}, {"0x10", 1, 0},
                 {"1_0", 1, 1}, {"--1", 0, 0},   {"5-3", 1, 5},   {"6e1.5", 3, 60}, {"0.25f", 4, 0.25}};
    for (size_t k = 0; k < SL_COUNTOF(cases); k++) {
        double value = 0.0;
        assert_int_equal(parse_exact(cases[k].text, &value), cases[k].used);
        assert_true(value == cases[k].value);
    }
}

static void parsing_accepts_nan_and_infinity_in_any_case(void **state)
{
    (void)state;
    double value = 0.0;
    assert_int_equal(parse_exact("NaN", &value), 3);
    assert_true(isnan(value));
    assert_int_equal(parse_exact("-iNf", &value), 4);
    assert_true(isinf(value) && value < 0);
    assert_int_equal(parse_exact("+Infinity", &value), 9);
    assert_true(isinf(value) && value > 0);
    assert_int_equal(parse_exact("infinit", &value), 3);
    assert_int_equal(parse_exact("in", &value), 0);
    assert_int_equal(parse_exact("na", &value), 0);
}

/* Significant digits of a formatted number. */
static int count_digits(const char *text)
{
    int n = 0, last = 0;
    for (const char *p = text; *p != '\0' && *p != 'e'; p++) {
        if (*p >= '0' && *p <= '9' && (n > 0 || *p != '0')) {
            n++;
            last = *p != '0' ? n : last;
        }
    }
    return last;
}

static void formatting_is_read_back_exactly_and_no_shorter_text_would_be(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(102);
    char text[SL_DOUBLE_TEXT], shorter[400];
    for (int trial = 0; trial < 60000 * test_multiplier(); trial++) {
        double x = random_double(&rng);
        if (trial % 3 == 1) { /* a few decimals, as files have them */
            snprintf(shorter, sizeof shorter, "%.*g", 1 + test_index(&rng, 15), test_uniform(&rng, -3e3, 3e3));
            x = strtod(shorter, NULL);
        } else if (trial % 3 == 2) {
            x = test_uniform(&rng, -1.0, 1.0) * pow(10.0, test_index(&rng, 40) - 20);
        }
        const int32_t length = sl_format_double(x, text);
        assert_int_equal(length, strlen(text));
        assert_true(length < SL_DOUBLE_TEXT);
        const double back = strtod(text, NULL);
        assert_memory_equal(&x, &back, sizeof x);
        const int digits = count_digits(text);
        if (digits > 1) {
            snprintf(shorter, sizeof shorter, "%.*g", digits - 1, x);
            assert_true(strtod(shorter, NULL) != x);
        }
    }
}

static void formatting_writes_what_a_person_would(void **state)
{
    (void)state;
    static const struct {
        double value;
        const char *text;
    } cases[] = {{0.0, "0"},
                 {-0.0, "-0"},
                 {0.1, "0.1"},
                 {-2.5, "-2.5"},
                 {1e15, "1e+15"},
                 {1e14, "100000000000000"},
                 {123456, "123456"},
                 {1e-4, "0.0001"},
                 {1e-5, "1e-05"},
                 {5e-324, "5e-324"},
                 {3e-320, "3e-320"},
                 {1.0 / 3.0, "0.3333333333333333"},
                 {0.1 + 0.2, "0.30000000000000004"},
                 {1e300, "1e+300"},
                 {-1234.0625, "-1234.0625"},
                 {(double)NAN, "nan"},
                 {(double)INFINITY, "inf"},
                 {-(double)INFINITY, "-inf"}};
    char text[SL_DOUBLE_TEXT];
    for (size_t k = 0; k < SL_COUNTOF(cases); k++) {
        sl_format_double(cases[k].value, text);
        assert_string_equal(text, cases[k].text);
    }
}

static void a_locale_with_a_decimal_comma_changes_nothing(void **state)
{
    (void)state;
    static const char *const locales[] = {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "ps_AF.UTF-8", "de_DE", "fr_FR"};
    bool found = false;
    for (size_t k = 0; k < SL_COUNTOF(locales) && !found; k++) {
        found = setlocale(LC_ALL, locales[k]) != NULL;
    }
    if (!found) {
        skip(); /* no such locale is installed here */
    }
    char text[SL_DOUBLE_TEXT];
    double value = 0.0;
    sl_format_double(0.1 + 0.2, text);
    const int64_t used = parse_exact("0.30000000000000004", &value);
    setlocale(LC_ALL, "C");
    assert_string_equal(text, "0.30000000000000004");
    assert_int_equal(used, 19);
    assert_true(value == 0.1 + 0.2);
}

static void integers_are_parsed_when_they_fit(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        int64_t used, value;
    } cases[] = {{"0", 1, 0},
                 {"-17", 3, -17},
                 {"+42x", 3, 42},
                 {"007", 3, 7},
                 {"9223372036854775807", 19, INT64_MAX},
                 {"-9223372036854775808", 20, INT64_MIN},
                 {"9223372036854775808", 0, -1},
                 {"-9223372036854775809", 0, -1},
                 {"99999999999999999999999", 0, -1},
                 {"", 0, -1},
                 {"-", 0, -1},
                 {"+", 0, -1},
                 {" 1", 0, -1},
                 {"x1", 0, -1}};
    for (size_t k = 0; k < SL_COUNTOF(cases); k++) {
        int64_t value = -1;
        const char *end = cases[k].text + strlen(cases[k].text);
        assert_int_equal(sl_parse_int(cases[k].text, end, &value) - cases[k].text, cases[k].used);
        assert_true(value == cases[k].value);
    }
    test_rng rng = test_rng_seed(103);
    for (int trial = 0; trial < 20000; trial++) {
        char text[32];
        const int64_t expected = (int64_t)test_bits(&rng) >> test_index(&rng, 64);
        int64_t value = 0;
        const int n = snprintf(text, sizeof text, "%lld", (long long)expected);
        assert_ptr_equal(sl_parse_int(text, text + n, &value), text + n);
        assert_true(value == expected);
    }
}

static void one_is_singular_and_all_else_plural(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x91a1);
    assert_string_equal(sl_plural(1), "");
    assert_string_equal(sl_plural(0), "s");
    assert_string_equal(sl_plural(-1), "s");
    assert_string_equal(sl_plural(INT64_C(0x100000001)), "s"); /* one in its lower half */
    for (int k = 0; k < 100; k++) {
        assert_string_equal(sl_plural(2 + test_index(&rng, 1 << 30)), "s");
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parsing_agrees_with_strtod_for_any_number_of_digits),
        cmocka_unit_test(parsing_breaks_ties_to_even_however_long_the_text),
        cmocka_unit_test(parsing_knows_the_edges_of_the_range),
        cmocka_unit_test(parsing_heeds_the_last_of_very_many_digits),
        cmocka_unit_test(parsing_stops_where_the_number_ends),
        cmocka_unit_test(parsing_accepts_nan_and_infinity_in_any_case),
        cmocka_unit_test(formatting_is_read_back_exactly_and_no_shorter_text_would_be),
        cmocka_unit_test(formatting_writes_what_a_person_would),
        cmocka_unit_test(a_locale_with_a_decimal_comma_changes_nothing),
        cmocka_unit_test(integers_are_parsed_when_they_fit),
        cmocka_unit_test(one_is_singular_and_all_else_plural),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
