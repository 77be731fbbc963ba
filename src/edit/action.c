#include "edit/action.h"

#include <stdio.h>

#include "base/memory.h"
#include "edit/action_internal.h"

#define AT(member) offsetof(sl_action, member)

#define INDEX_MAX 2147483647.0 /* in initialisers */
#define LENGTH_MAX 1e300

const sl_form *sl_action_forms(void)
{
    static const sl_form table[SL_ACTION_KINDS] = {
        [SL_ACTION_OPEN] = {"open",
                            {{"start", FIELD_TEXT, 0, 0, AT(name), 0, 0, true},
                             {"symmetry", FIELD_BOOL, 0, 0, AT(on), 0, 0, true},
                             {"stretch", FIELD_REAL, 0, 0, AT(number), 1.0, 1e9, true},
                             {"resolution", FIELD_INT, 0, 0, AT(resolution), 16, 65536, true},
                             {"margin", FIELD_REAL, 0, 0, AT(margin), 0, 1024, true}}},
        [SL_ACTION_DELETE_SEAM] = {"delete-seam", {{"at", FIELD_NUMBERS, 3, 0, 0, 0, 0, false}}},
        [SL_ACTION_CUT_PATH] = {"cut-path", {{"vertices", FIELD_LIST, 1, 2, 0, 0, 0, false}}},
        [SL_ACTION_CUT_LOOP] = {"cut-loop", {{"at", FIELD_NUMBERS, 3, 0, 0, 0, 0, false}}},
        [SL_ACTION_CUT_EDGES] = {"cut-edges", {{"edges", FIELD_TUPLES, 2, 1, 0, 0, 0, false}}},
        [SL_ACTION_SEW] = {"sew",
                           {{"at", FIELD_NUMBERS, 3, 0, 0, 0, 0, false},
                            {"to", FIELD_INT, 0, 0, AT(to), 0, INDEX_MAX, true},
                            {"length", FIELD_REAL, 0, 0, AT(number), 0, LENGTH_MAX, true}}},
        [SL_ACTION_UNSEW] = {"unsew",
                             {{"at", FIELD_NUMBERS, 3, 0, 0, 0, 0, false},
                              {"to", FIELD_INT, 0, 0, AT(to), 0, INDEX_MAX, true},
                              {"length", FIELD_REAL, 0, 0, AT(number), 0, LENGTH_MAX, true}}},
        [SL_ACTION_CUT_CHART] = {"cut-chart", {{"facet", FIELD_INT, 0, 0, AT(facet), 0, INDEX_MAX, false}}},
        [SL_ACTION_MERGE] = {"merge", {{"facets", FIELD_NUMBERS, 2, 0, 0, 0, 0, false}}},
        [SL_ACTION_ANGLE] = {"angle",
                             {{"corner", FIELD_NUMBERS, 2, 0, 0, 0, 0, false},
                              {"degrees", FIELD_REAL, 0, 0, AT(number), 0, 36000, false}}},
        [SL_ACTION_STRAIGHTEN] = {"straighten", {{"path", FIELD_TUPLES, 2, 2, 0, 0, 0, false}}},
        [SL_ACTION_STRAIGHTEN_BORDER] = {"straighten-border", {{"ends", FIELD_TUPLES, 2, 2, 0, 0, 0, false}}},
        [SL_ACTION_RECTANGLE] = {"rectangle", {{"corners", FIELD_TUPLES, 2, 3, 0, 0, 0, false}}},
        [SL_ACTION_RIGHT] = {"right", {{"corner", FIELD_NUMBERS, 2, 0, 0, 0, 0, false}}},
        [SL_ACTION_DROP] = {"drop", {{"constraint", FIELD_INT, 0, 0, AT(id), 1, INDEX_MAX, false}}},
        [SL_ACTION_PIN] = {"pin",
                           {{"corner", FIELD_NUMBERS, 2, 0, 0, 0, 0, false},
                            {"uv", FIELD_PLACE, 0, 0, AT(uv), -1e4, 1e4, false}}},
        [SL_ACTION_MOVE] = {"move",
                            {{"facet", FIELD_INT, 0, 0, AT(facet), 0, INDEX_MAX, false},
                             {"by", FIELD_PLACE, 0, 0, AT(uv), -1e4, 1e4, false}}},
        [SL_ACTION_ROTATE] = {"rotate",
                              {{"facet", FIELD_INT, 0, 0, AT(facet), 0, INDEX_MAX, false},
                               {"degrees", FIELD_REAL, 0, 0, AT(number), -36000, 36000, false}}},
        [SL_ACTION_SCALE] = {"scale",
                             {{"facet", FIELD_INT, 0, 0, AT(facet), 0, INDEX_MAX, false},
                              {"factor", FIELD_REAL, 0, 0, AT(number), 1e-3, 1e3, false}}},
        [SL_ACTION_SYMMETRY] = {"symmetry",
                                {{"facet", FIELD_INT, 0, 0, AT(facet), 0, INDEX_MAX, false},
                                 {"on", FIELD_BOOL, 0, 0, AT(on), 0, 0, false},
                                 {"corners", FIELD_TUPLES, 2, 2, 0, 0, 0, true},
                                 {"mirrored", FIELD_BOOL, 0, 0, AT(mirrored), 0, 0, true}}},
        [SL_ACTION_PACK] = {"pack",
                            {{"resolution", FIELD_INT, 0, 0, AT(resolution), 16, 65536, true},
                             {"margin", FIELD_REAL, 0, 0, AT(margin), 0, 1024, true}}},
        [SL_ACTION_UNDO] = {"undo",
                            {{"steps", FIELD_INT, 0, 0, AT(steps), 1, INDEX_MAX, true},
                             {"to", FIELD_TEXT, 0, 0, AT(name), 0, 0, true}}},
        [SL_ACTION_REDO] = {"redo", {{"steps", FIELD_INT, 0, 0, AT(steps), 1, INDEX_MAX, true}}},
        [SL_ACTION_CHECKPOINT] = {"checkpoint", {{"name", FIELD_TEXT, 0, 0, AT(name), 0, 0, false}}},
    };
    return table;
}

sl_action sl_action_default(sl_action_kind kind)
{
    sl_action a = {.kind = kind, .facet = -1, .to = -1, .steps = 1, .resolution = 2048, .margin = 4.0};
    a.on = a.mirrored = true;
    if (kind == SL_ACTION_OPEN) {
        a.number = 1.5;
        snprintf(a.name, sizeof a.name, "automatic");
    }
    return a;
}

const char *sl_action_name(sl_action_kind kind)
{
    return (unsigned)kind < SL_ACTION_KINDS ? sl_action_forms()[kind].name : "unknown";
}

sl_status sl_action_set_items(sl_action *action, int32_t count, const int32_t *item)
{
    int32_t *copy = sl_copy(item, count, sizeof *item);
    if (copy == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    sl_free(action->item);
    action->item = copy;
    action->count = count;
    return SL_OK;
}

sl_status sl_action_copy(const sl_action *from, sl_action *out)
{
    *out = *from;
    out->item = NULL;
    out->count = 0;
    return from->item != NULL ? sl_action_set_items(out, from->count, from->item) : SL_OK;
}

void sl_action_clear(sl_action *action)
{
    sl_free(action->item);
    *action = (sl_action){0};
}
