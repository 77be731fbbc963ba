/* seamlab edit: a session's script applied to a mesh. */
#include <stdio.h>
#include <string.h>

#include "cli/edit_steps.h"

static const cli_verb verb = {
    .name = "edit",
    .usage = "seamlab edit MESH SCRIPT -o OUT [options]",
    .summary = "Applies a script of editing actions (one JSON object a line: cut, sew, straighten, turn an angle,\n"
               "move, share, pack) to a mesh's atlas and writes the result. A line that is broken or refused ends\n"
               "it with its number, and nothing is written.",
    .examples = "  seamlab edit hand.obj session.jsonl -o hand-uv.obj\n"
                "  seamlab edit hand.obj session.jsonl -o hand-uv.obj --step-pictures steps\n"
                "  seamlab edit hand.obj session.jsonl -o hand-uv.obj --pack --log done.jsonl\n"
                "  printf '{\"seamlab\":\"session\",\"version\":1}\\n{\"do\":\"cut-chart\",\"facet\":0}\\n' |\n"
                "    seamlab edit hand.obj - -o hand-uv.obj --pack\n",
    .min_files = 2,
    .max_files = 2,
};

int cli_edit(int argc, char **argv)
{
    cli_run run = {.verb = verb.name};
    cli_steps steps = {.run = &run, .count = -1};
    const char *output = NULL, *log = NULL, *files[2];
    bool allow_overlap = false, pack = false;
    int32_t file_count = 0;
    cli_option options[CLI_COMMON_OPTIONS + 5] = {
        {"output", 'o', CLI_TEXT, &output, 0, 0, NULL, "OUT", "OBJ or PLY to write"},
        {"step-pictures", 0, CLI_TEXT, &steps.pictures, 0, 0, NULL, "DIR", "a picture after each action"},
        {"log", 0, CLI_TEXT, &log, 0, 0, NULL, "FILE", "the whole session as a script"},
        {"pack", 0, CLI_FLAG, &pack, 0, 0, NULL, NULL, "pack the charts anew at the end"},
        {"allow-overlap", 0, CLI_FLAG, &allow_overlap, 0, 0, NULL, NULL,
         "write an atlas whose charts overlap, marked uncertified"},
    };
    cli_common_options(&run, options + 5);
    int code = cli_parse(&verb, options, CLI_COMMON_OPTIONS + 5, argc, argv, 2, files, &file_count);
    if (code >= 0) {
        return code;
    }
    if ((code = cli_check_output(verb.name, output, true)) >= 0 || (code = cli_begin(&run)) >= 0) {
        return code;
    }
    sl_meshfile *file = NULL;
    sl_session *session = NULL;
    sl_diag diag = sl_diag_none();
    code = cli_steps_run(&steps, files[0], files[1], false, &file, &session);
    if (code == CLI_DONE && pack) {
        sl_action action = sl_action_default(SL_ACTION_PACK);
        code = cli_fail(&run, sl_session_apply(session, &action, &run.context, &diag), &diag);
    }
    if (code == CLI_DONE && log != NULL) {
        code = cli_fail(&run, sl_session_log_to(session, log, files[0], &diag), &diag);
    }
    if (code == CLI_DONE) {
        code = cli_steps_save(&run, session, file, output, allow_overlap);
    }
    sl_session_free(session);
    sl_meshfile_free(file);
    return cli_end(&run, code);
}
