#include "support/test_support.h"

#include "draw/text.h"

#include <math.h>
#include <string.h>

enum { W = 40, H = 40 };

static const double height = 20.0; /* of capitals */
static const double baseline = 30.0;

static double draw_character(char c, float *coverage)
{
    sl_mask mask = {0, 0, W, H, coverage};
    const double at[2] = {6.0, baseline};
    const char text[2] = {c, '\0'};
    double sum = 0.0;
    sl_mask_clear(&mask);
    sl_mask_text(&mask, at, height, text);
    for (int i = 0; i < W * H; i++) {
        sum += (double)coverage[i];
    }
    return sum;
}

static void every_printable_character_has_its_own_shape(void **state)
{
    (void)state;
    static float shape[95][W * H];
    for (int a = 0; a < 95; a++) {
        const double ink = draw_character((char)(32 + a), shape[a]);
        assert_true(a == 0 ? ink == 0.0 : ink > 3.0);
        for (int b = 0; b < a; b++) {
            double different = 0.0;
            for (int i = 0; i < W * H; i++) {
                different += fabs((double)shape[a][i] - (double)shape[b][i]);
            }
            assert_true(different > 3.0);
        }
    }
}

static void characters_stay_between_their_lines_and_within_their_width(void **state)
{
    (void)state;
    float coverage[W * H];
    for (int c = 33; c < 127; c++) {
        draw_character((char)c, coverage);
        const char text[2] = {(char)c, '\0'};
        const double right = 6.0 + sl_text_width(height, text), stroke = 0.15 * height;
        for (int i = 0; i < W * H; i++) {
            const double x = i % W + 0.5, y = i / W + 0.5;
            if (x < 6.0 - stroke || x > right + stroke || y < baseline - 1.1 * height - stroke ||
                y > baseline + 0.3 * height + stroke) {
                assert_true(coverage[i] == 0.0f);
            }
        }
    }
}

static void widths_add_up_with_one_gap_between(void **state)
{
    (void)state;
    const double one = sl_text_width(height, "A"), two = sl_text_width(height, "AA"),
                 three = sl_text_width(height, "AAA");
    assert_true(one > 0.0 && two > 2.0 * one);
    assert_true(test_near(three - two, two - one, 1e-9));
    assert_true(test_near(sl_text_width(2.0 * height, "AbC 12"), 2.0 * sl_text_width(height, "AbC 12"), 1e-9));
    assert_true(test_near(sl_text_width(height, ""), 0.0, 0.0));
}

static void other_bytes_show_as_a_box(void **state)
{
    (void)state;
    float a[W * H], b[W * H];
    assert_true(draw_character('\x7f', a) > 10.0);
    draw_character('\xe4', b);
    assert_memory_equal(a, b, sizeof a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_printable_character_has_its_own_shape),
        cmocka_unit_test(characters_stay_between_their_lines_and_within_their_width),
        cmocka_unit_test(widths_add_up_with_one_gap_between),
        cmocka_unit_test(other_bytes_show_as_a_box),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
