#include <string.h>

#include "base/memory.h"
#include "edit/action.h"
#include "support/test_support.h"

static const char *const lines[] = {
    "{\"do\":\"open\"}",
    "{\"do\":\"open\",\"start\":\"uv\",\"symmetry\":false,\"stretch\":1.25,\"resolution\":1024,\"margin\":2.5}",
    "{\"do\":\"delete-seam\",\"at\":[4,7,12]}",
    "{\"do\":\"cut-path\",\"vertices\":[3,17,5]}",
    "{\"do\":\"cut-loop\",\"at\":[4,7,12]}",
    "{\"do\":\"cut-edges\",\"edges\":[[3,4],[4,9]]}",
    "{\"do\":\"sew\",\"at\":[4,7,12]}",
    "{\"do\":\"sew\",\"at\":[4,7,12],\"to\":0}",
    "{\"do\":\"unsew\",\"at\":[4,7,12],\"length\":0.1}",
    "{\"do\":\"cut-chart\",\"facet\":0}",
    "{\"do\":\"merge\",\"facets\":[8,3]}",
    "{\"do\":\"angle\",\"corner\":[4,12],\"degrees\":91.3}",
    "{\"do\":\"straighten\",\"path\":[[4,12],[5,13],[6,13]]}",
    "{\"do\":\"straighten-border\",\"ends\":[[4,12],[5,13]]}",
    "{\"do\":\"rectangle\",\"corners\":[[4,12],[5,13],[6,14],[7,15]]}",
    "{\"do\":\"right\",\"corner\":[4,12]}",
    "{\"do\":\"drop\",\"constraint\":3}",
    "{\"do\":\"pin\",\"corner\":[4,12],\"uv\":[0.25,1e-17]}",
    "{\"do\":\"move\",\"facet\":5,\"by\":[0.1,-0.30000000000000004]}",
    "{\"do\":\"rotate\",\"facet\":5,\"degrees\":-45}",
    "{\"do\":\"scale\",\"facet\":5,\"factor\":1.1}",
    "{\"do\":\"symmetry\",\"facet\":5,\"on\":false}",
    "{\"do\":\"symmetry\",\"facet\":5,\"on\":true,\"corners\":[[4,12],[5,13]],\"mirrored\":false}",
    "{\"do\":\"pack\"}",
    "{\"do\":\"pack\",\"resolution\":4096,\"margin\":8}",
    "{\"do\":\"undo\"}",
    "{\"do\":\"undo\",\"steps\":4}",
    "{\"do\":\"undo\",\"to\":\"thumbs apart\"}",
    "{\"do\":\"redo\",\"steps\":2}",
    "{\"do\":\"checkpoint\",\"name\":\"thumbs apart\"}",
};

static void every_kind_of_line_survives_parsing_and_formatting(void **state)
{
    (void)state;
    bool seen[SL_ACTION_KINDS] = {false};
    for (size_t i = 0; i < SL_COUNTOF(lines); i++) {
        sl_action action, copy;
        sl_diag diag = sl_diag_none();
        assert_int_equal(sl_action_parse(lines[i], (int64_t)strlen(lines[i]), &action, &diag), SL_OK);
        assert_int_equal(sl_action_copy(&action, &copy), SL_OK);
        sl_action_clear(&action);
        char *text = sl_action_format(&copy);
        assert_string_equal(text, lines[i]);
        seen[copy.kind] = true;
        sl_free(text);
        sl_action_clear(&copy);
    }
    for (int k = 0; k < SL_ACTION_KINDS; k++) {
        assert_true(seen[k]);
        assert_true(strlen(sl_action_name((sl_action_kind)k)) > 2);
    }
    assert_string_equal(sl_action_name(SL_ACTION_KINDS), "unknown");
}

static void random_numbers_come_back_bit_for_bit(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xac71);
    for (int trial = 0; trial < 500 * test_multiplier(); trial++) {
        sl_action a = sl_action_default(SL_ACTION_PIN), b;
        sl_diag diag = sl_diag_none();
        const int32_t item[2] = {test_index(&rng, INT32_MAX), test_index(&rng, INT32_MAX)};
        assert_int_equal(sl_action_set_items(&a, 2, item), SL_OK);
        a.uv[0] = test_uniform(&rng, -1e4, 1e4);
        a.uv[1] = test_uniform(&rng, -1e-9, 1e-9);
        char *text = sl_action_format(&a);
        assert_int_equal(sl_action_parse(text, (int64_t)strlen(text), &b, &diag), SL_OK);
        assert_memory_equal(a.uv, b.uv, sizeof a.uv);
        assert_memory_equal(a.item, b.item, sizeof item);
        sl_free(text);
        sl_action_clear(&a);
        sl_action_clear(&b);
    }
}

static void broken_lines_are_refused_with_a_reason(void **state)
{
    (void)state;
    static const char *const broken[] = {
        "",
        "{",
        "[]",
        "7",
        "{\"do\":7}",
        "{}",
        "{\"do\":\"dance\"}",
        "{\"do\":\"pack\"} x",
        "{\"do\":\"pack\",\"do\":\"pack\"}",
        "{\"do\":\"pack\",\"colour\":1}",
        "{\"do\":\"pack\",\"resolution\":15}",
        "{\"do\":\"pack\",\"resolution\":1e3}",
        "{\"do\":\"cut-chart\"}",
        "{\"do\":\"cut-chart\",\"facet\":-1}",
        "{\"do\":\"cut-chart\",\"facet\":2147483648}",
        "{\"do\":\"cut-chart\",\"facet\":\"3\"}",
        "{\"do\":\"merge\",\"facets\":[1]}",
        "{\"do\":\"merge\",\"facets\":[1,2,3]}",
        "{\"do\":\"merge\",\"facets\":[1,2.5]}",
        "{\"do\":\"cut-path\",\"vertices\":[1]}",
        "{\"do\":\"cut-edges\",\"edges\":[]}",
        "{\"do\":\"cut-edges\",\"edges\":[[1,2,3]]}",
        "{\"do\":\"cut-edges\",\"edges\":[1,2]}",
        "{\"do\":\"angle\",\"corner\":[1,2]}",
        "{\"do\":\"angle\",\"corner\":[1,2],\"degrees\":1e999}",
        "{\"do\":\"angle\",\"corner\":[1,2],\"degrees\":NaN}",
        "{\"do\":\"pin\",\"corner\":[1,2],\"uv\":[1]}",
        "{\"do\":\"pin\",\"corner\":[1,2],\"uv\":[1,1e5]}",
        "{\"do\":\"symmetry\",\"facet\":1,\"on\":1}",
        "{\"do\":\"symmetry\",\"facet\":1,\"on\":true}",
        "{\"do\":\"symmetry\",\"facet\":1,\"on\":false,\"corners\":[[1,2],[3,4]]}",
        "{\"do\":\"sew\",\"at\":[1,2,3],\"to\":4,\"length\":1}",
        "{\"do\":\"straighten-border\",\"ends\":[[1,2],[3,4],[5,6]]}",
        "{\"do\":\"undo\",\"to\":\"a\",\"steps\":2}",
        "{\"do\":\"checkpoint\",\"name\":\"\"}",
        "{\"do\":\"checkpoint\",\"name\":\"a\\\"b\"}",
        "{\"do\":\"checkpoint\",\"name\":\"a\\u0000b\"}",
        "{\"do\":\"checkpoint\",\"name\":\"0123456789012345678901234567890123456789012345678901234567890123\"}",
        "{\"do\":\"open\",\"start\":\"zero\"}",
    };
    for (size_t i = 0; i < SL_COUNTOF(broken); i++) {
        sl_action action;
        sl_diag diag = sl_diag_none();
        const sl_status status = sl_action_parse(broken[i], (int64_t)strlen(broken[i]), &action, &diag);
        if (status != SL_BAD_INPUT) {
            print_message("taken: %s\n", broken[i]);
        }
        assert_int_equal(status, SL_BAD_INPUT);
        assert_true(diag.reason[0] != '\0' && action.item == NULL);
        assert_int_equal(sl_action_parse(broken[i], (int64_t)strlen(broken[i]), &action, NULL), SL_BAD_INPUT);
    }
}

/* Lines cut and changed at random: refused, or taken as something that formats and parses to itself. */
static void mutated_lines_never_crash(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xf022);
    for (int trial = 0; trial < 20000 * test_multiplier(); trial++) {
        char text[160];
        const char *from = lines[test_index(&rng, (int32_t)SL_COUNTOF(lines))];
        int32_t n = (int32_t)strlen(from);
        memcpy(text, from, (size_t)n);
        for (int k = test_index(&rng, 4); k >= 0; k--) {
            static const char spice[] = "{}[]\",:0123456789-+.eE\\tfn \x01\xff";
            text[test_index(&rng, n)] = spice[test_index(&rng, (int32_t)sizeof spice)];
        }
        n = test_index(&rng, 5) == 0 ? test_index(&rng, n) : n;
        sl_action a, b;
        if (sl_action_parse(text, n, &a, NULL) == SL_OK) {
            char *once = sl_action_format(&a);
            assert_int_equal(sl_action_parse(once, (int64_t)strlen(once), &b, NULL), SL_OK);
            char *twice = sl_action_format(&b);
            assert_string_equal(once, twice);
            sl_free(once);
            sl_free(twice);
            sl_action_clear(&a);
            sl_action_clear(&b);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_kind_of_line_survives_parsing_and_formatting),
        cmocka_unit_test(random_numbers_come_back_bit_for_bit),
        cmocka_unit_test(broken_lines_are_refused_with_a_reason),
        cmocka_unit_test(mutated_lines_never_crash),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
