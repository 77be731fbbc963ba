/* libFuzzer target: bytes are parsed as a session's script; what is accepted is formatted and parsed again, and its
 * first actions are applied to a small mesh. Anything but a status is a finding. See meson.build for how to run it. */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "edit/script.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { SIDE = 4, MOST_ACTIONS = 6 };

/* A bent sheet of SIDE x SIDE quads. */
static void apply(const sl_script *script)
{
    double xyz[3 * (SIDE + 1) * (SIDE + 1)];
    int32_t first[SIDE * SIDE + 1] = {0}, index[4 * SIDE * SIDE];
    for (int32_t v = 0; v < (SIDE + 1) * (SIDE + 1); v++) {
        const double x = v % (SIDE + 1), y = v / (SIDE + 1);
        xyz[3 * v] = x;
        xyz[3 * v + 1] = 1.1 * y;
        xyz[3 * v + 2] = 0.2 * x * x - 0.13 * y * y + 0.1 * x * y;
    }
    for (int32_t f = 0; f < SIDE * SIDE; f++) {
        const int32_t v = f % SIDE + f / SIDE * (SIDE + 1);
        const int32_t corner[4] = {v, v + 1, v + SIDE + 2, v + SIDE + 1};
        memcpy(index + 4 * f, corner, sizeof corner);
        first[f + 1] = 4 * (f + 1);
    }
    const sl_polygons polygons = {(SIDE + 1) * (SIDE + 1), SIDE * SIDE, xyz, first, index};
    sl_atlas_def def = sl_atlas_default();
    def.check_resolution = 64;
    sl_session *session = NULL;
    sl_action open = sl_action_default(SL_ACTION_OPEN);
    if (sl_session_create(&polygons, NULL, &open, &def, NULL, &session, NULL) != SL_OK) {
        abort();
    }
    for (int32_t i = 1; i < script->count && i <= MOST_ACTIONS; i++) {
        const uint64_t before = sl_session_hash(session);
        sl_diag diag = sl_diag_none();
        if (sl_session_apply(session, &script->action[i], NULL, &diag) != SL_OK &&
            (sl_session_hash(session) != before || diag.reason[0] == '\0')) {
            abort();
        }
    }
    sl_session_free(session);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    sl_script script;
    if (sl_script_parse("fuzz.jsonl", (const char *)data, (int64_t)size, size % 2 == 0, &script, NULL) != SL_OK) {
        return 0;
    }
    for (int32_t i = 0; i < script.count; i++) {
        sl_action again;
        char *line = sl_action_format(&script.action[i]);
        if (line == NULL || sl_action_parse(line, (int64_t)strlen(line), &again, NULL) != SL_OK) {
            abort(); /* what was read can be written */
        }
        sl_free(line);
        sl_action_clear(&again);
    }
    apply(&script);
    sl_script_clear(&script);
    return 0;
}
