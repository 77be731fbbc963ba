/* seamlab replay: a session's log again, step by step. */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "cli/edit_steps.h"

static const cli_verb verb = {
    .name = "replay",
    .usage = "seamlab replay MESH LOG [options]",
    .summary = "Runs a session's log again, cut off anywhere: the same bytes as when it was made. Says what each step\n"
               "gave; with -o the atlas is written, with --to only the first steps are taken.",
    .examples = "  seamlab replay hand.obj session.jsonl\n"
                "  seamlab replay hand.obj session.jsonl --to 12 -o hand-12.obj\n"
                "  seamlab replay hand.obj session.jsonl --step-pictures steps\n",
    .min_files = 2,
    .max_files = 2,
};

int cli_replay(int argc, char **argv)
{
    cli_run run = {.verb = verb.name};
    cli_steps steps = {.run = &run, .count = -1};
    const char *output = NULL, *files[2];
    bool allow_overlap = false;
    int32_t file_count = 0, to = -1;
    cli_option options[CLI_COMMON_OPTIONS + 4] = {
        {"output", 'o', CLI_TEXT, &output, 0, 0, NULL, "OUT", "OBJ or PLY to write"},
        {"to", 0, CLI_INT, &to, 0, 2147483646.0, NULL, "N", "take the first N steps after opening only"},
        {"step-pictures", 0, CLI_TEXT, &steps.pictures, 0, 0, NULL, "DIR", "a picture after each action"},
        {"allow-overlap", 0, CLI_FLAG, &allow_overlap, 0, 0, NULL, NULL,
         "write an atlas whose charts overlap, marked uncertified"},
    };
    cli_common_options(&run, options + 4);
    int code = cli_parse(&verb, options, CLI_COMMON_OPTIONS + 4, argc, argv, 2, files, &file_count);
    if (code >= 0) {
        return code;
    }
    if ((code = cli_check_output(verb.name, output, false)) >= 0 || (code = cli_begin(&run)) >= 0) {
        return code;
    }
    sl_meshfile *file = NULL;
    sl_session *session = NULL;
    steps.count = to >= 0 ? to + 1 : -1;
    steps.table = !run.json && (output == NULL || strcmp(output, "-") != 0);
    code = cli_steps_run(&steps, files[0], files[1], true, &file, &session);
    if (code == CLI_DONE && output != NULL) {
        code = cli_steps_save(&run, session, file, output, allow_overlap);
    }
    if (code == CLI_DONE && steps.table) {
        printf("# state %016" PRIx64 "\n", sl_session_hash(session));
    }
    sl_session_free(session);
    sl_meshfile_free(file);
    return cli_end(&run, code);
}
