/* What pages say is understood whole, or refused. */
#include "support/test_support.h"
#include "view/message.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static sl_status parse(const char *text, sl_message *out)
{
    sl_diag diag = sl_diag_none();
    const sl_status status = sl_message_parse(text, (int64_t)strlen(text), out, &diag);
    if (status == SL_BAD_INPUT) {
        assert_true(diag.reason[0] != '\0');
    }
    return status;
}

static const char *const good[] = {
    ("{\"t\":\"look\",\"pane\":\"3d\",\"w\":640,\"h\":480,\"azimuth\":35,\"elevation\":20,\"zoom\":1,\"x\":0,\"y\":0,"
     "\"still\":true}"),
    "{\"t\":\"look\",\"pane\":\"uv\",\"w\":16,\"h\":4096,\"zoom\":2.5,\"x\":0.5,\"y\":0.25}",
    "{\"t\":\"seen\",\"pane\":\"uv\"}",
    "{\"t\":\"at\",\"pane\":\"3d\",\"x\":10,\"y\":-1}",
    "{\"t\":\"arc\",\"at\":[1,2,3]}",
    "{\"t\":\"do\",\"line\":{\"do\":\"angle\",\"corner\":[4,7],\"degrees\":90.5}}",
    "{\"t\":\"drag\",\"line\":{\"do\":\"move\",\"facet\":3,\"by\":[0.25,-1e-3]}}",
    "{\"t\":\"release\",\"line\":{\"do\":\"undo\"}}",
    "{\"t\":\"let-go\"}",
    "{\"t\":\"goto\",\"step\":3}",
    "{\"t\":\"show\",\"what\":\"stretch\"}",
    "{\"t\":\"save\",\"overlap\":true}",
    "{\"t\":\"stop\"}",
};

static void every_kind_is_understood(void **state)
{
    sl_message m;
    (void)state;
    for (size_t k = 0; k < sizeof good / sizeof *good; k++) {
        assert_int_equal(parse(good[k], &m), SL_OK);
        sl_message_clear(&m);
    }
    assert_int_equal(parse(good[0], &m), SL_OK);
    assert_true(m.kind == SL_MESSAGE_LOOK && m.pane == SL_PANE_3D && m.look.width == 640 && m.look.azimuth == 35.0 &&
                m.look.still);
    assert_int_equal(parse(good[5], &m), SL_OK);
    assert_true(m.kind == SL_MESSAGE_DO && m.action.kind == SL_ACTION_ANGLE && m.action.number == 90.5);
    sl_message_clear(&m);
    assert_int_equal(parse(good[4], &m), SL_OK);
    assert_true(m.kind == SL_MESSAGE_ARC && m.side[0] == 1 && m.side[2] == 3);
    assert_int_equal(parse(good[10], &m), SL_OK);
    assert_true(m.shown == SL_SHOW_STRETCH);
}

static void what_is_broken_is_refused(void **state)
{
    static const char *const bad[] = {
        "",
        "[]",
        "{}",
        "{\"t\":7}",
        "{\"t\":\"format-disk\"}",
        "{\"t\":\"look\",\"pane\":\"3d\"}",
        "{\"t\":\"look\",\"pane\":\"5d\",\"w\":640,\"h\":480,\"zoom\":1,\"x\":0,\"y\":0}",
        "{\"t\":\"look\",\"pane\":\"uv\",\"w\":640.5,\"h\":480,\"zoom\":1,\"x\":0,\"y\":0}",
        "{\"t\":\"look\",\"pane\":\"uv\",\"w\":100000,\"h\":480,\"zoom\":1,\"x\":0,\"y\":0}",
        "{\"t\":\"look\",\"pane\":\"uv\",\"w\":640,\"h\":480,\"zoom\":0,\"x\":0,\"y\":0}",
        "{\"t\":\"look\",\"pane\":\"uv\",\"w\":640,\"h\":480,\"zoom\":1e999,\"x\":0,\"y\":0}",
        ("{\"t\":\"look\",\"pane\":\"3d\",\"w\":640,\"h\":480,\"zoom\":1,\"x\":0,\"y\":0,\"azimuth\":0,\"elevation\":"
         "100}"),
        "{\"t\":\"at\",\"pane\":\"uv\",\"x\":\"1\",\"y\":2}",
        "{\"t\":\"at\",\"pane\":\"uv\",\"x\":99999999999999999999,\"y\":2}",
        "{\"t\":\"arc\",\"at\":[1,2]}",
        "{\"t\":\"arc\",\"at\":[1,2,-3]}",
        "{\"t\":\"do\"}",
        "{\"t\":\"do\",\"line\":\"rm\"}",
        "{\"t\":\"do\",\"line\":{\"do\":\"nothing-known\"}}",
        "{\"t\":\"do\",\"line\":{\"do\":\"move\",\"facet\":3,\"by\":[0.25]}}",
        "{\"t\":\"goto\",\"step\":-1}",
        "{\"t\":\"show\",\"what\":\"secrets\"}",
        "{\"t\":\"stop\",\"t\":\"stop\"}",
        "{\"t\":\"stop\"} {\"t\":\"stop\"}",
    };
    sl_message m;
    (void)state;
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        assert_int_equal(parse(bad[k], &m), SL_BAD_INPUT);
    }
}

static void no_message_is_too_long_to_be_refused(void **state)
{
    sl_message m;
    sl_diag diag = sl_diag_none();
    (void)state;
    char *text = malloc(SL_MESSAGE_LONGEST + 1);
    assert_non_null(text);
    memset(text, ' ', SL_MESSAGE_LONGEST + 1);
    memcpy(text, "{\"t\":\"stop\"}", 12);
    assert_int_equal(sl_message_parse(text, SL_MESSAGE_LONGEST, &m, &diag), SL_OK);
    assert_int_equal(sl_message_parse(text, SL_MESSAGE_LONGEST + 1, &m, &diag), SL_BAD_INPUT);
    memset(text, '[', SL_MESSAGE_LONGEST); /* nested deeply */
    assert_int_equal(sl_message_parse(text, SL_MESSAGE_LONGEST, &m, &diag), SL_BAD_INPUT);
    free(text);
}

/* Bytes changed, left out and doubled at random: understood or refused, and never anything else. */
static void mangled_messages_do_no_harm(void **state)
{
    test_rng rng = test_rng_seed(11);
    (void)state;
    for (int k = 0; k < 20000 * test_multiplier(); k++) {
        char text[256];
        sl_message m;
        sl_diag diag = sl_diag_none();
        snprintf(text, sizeof text, "%s", good[test_index(&rng, sizeof good / sizeof *good)]);
        const int32_t length = (int32_t)strlen(text);
        for (int32_t i = test_index(&rng, 4); i >= 0; i--) {
            text[test_index(&rng, length)] = (char)(1 + test_index(&rng, 255));
        }
        const sl_status status = sl_message_parse(text, test_index(&rng, length + 1), &m, &diag);
        assert_true(status == SL_OK || status == SL_BAD_INPUT);
        sl_message_clear(&m);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_kind_is_understood),
        cmocka_unit_test(what_is_broken_is_refused),
        cmocka_unit_test(no_message_is_too_long_to_be_refused),
        cmocka_unit_test(mangled_messages_do_no_harm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
