/* seamlab view: the page. */
#include "cli/cli.h"

#include "edit/script.h"
#include "edit/session.h"
#include "view/server.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

static const cli_verb verb = {
    .name = "view",
    .usage = "seamlab view MESH [-o OUT] [--port N] [--script FILE] [--texture FILE]",
    .summary =
        "Serves a page on this machine where the atlas is edited by hand, in space and in UV space: seams are zipped,\n"
        "cut, straightened, angles turned, charts moved; each step is a line of a script that `seamlab edit` repeats.",
    .examples = "  seamlab view model.obj -o model-uv.obj\n"
                "  seamlab view model.obj -o model-uv.obj --script session.jsonl   # goes on where it was left\n"
                "  seamlab view model.obj --texture paint.png   # paint in another program, see it here\n",
    .min_files = 1,
    .max_files = 1,
};

static bool on_stop(void *user)
{
    cli_run *run = user;
    return !run->context.progress(run->context.progress_user, "", 0.0);
}

static void on_log(void *user, const char *line)
{
    (void)user;
    fprintf(stderr, "%s\n", line);
}

/* What the script says was done already, or a new session. */
static int open_session(cli_run *run, const sl_meshfile *file, const char *script_path, sl_session **session)
{
    sl_diag diag = sl_diag_none();
    sl_polygons polygons;
    sl_script script = {0};
    struct stat there;
    sl_status status;
    sl_meshfile_polygons(file, &polygons);
    if (script_path != NULL && stat(script_path, &there) == 0) {
        status = sl_script_read(script_path, true, &script, &diag);
        if (status == SL_OK) {
            status =
                sl_script_run(&script, -1, &polygons, file->corner_uv, NULL, NULL, NULL, &run->context, session, &diag);
        }
        sl_script_clear(&script);
    } else {
        const sl_action open = sl_action_default(SL_ACTION_OPEN);
        status = sl_session_create(&polygons, file->corner_uv, &open, NULL, &run->context, session, &diag);
    }
    return cli_fail(run, status, &diag);
}

static int serve(cli_run *run, sl_session *session, const sl_meshfile *file, const sl_view_def *def)
{
    sl_diag diag = sl_diag_none();
    sl_view_server *server = NULL;
    int code = cli_fail(run, sl_view_open(session, file, def, &run->context, &server, &diag), &diag);
    if (code == CLI_DONE) {
        printf("%s\n", sl_view_url(server));
        fflush(stdout);
        cli_note(run, "open this address in a browser; Ctrl-C ends the session");
        run->bar = false;
        code = cli_fail(run, sl_view_serve(server), &diag);
    }
    sl_view_close(server);
    return code;
}

int cli_view(int argc, char **argv)
{
    cli_run run = {.verb = verb.name};
    sl_view_def def = {0};
    const char *script = NULL, *files[1];
    int32_t file_count = 0;
    cli_option options[CLI_COMMON_OPTIONS + 4] = {
        {"output", 'o', CLI_TEXT, &def.output, 0, 0, NULL, "OUT", "where the page's save writes: OBJ or PLY"},
        {"port", 0, CLI_INT, &def.port, 0, 65535, NULL, "N", "of 127.0.0.1; 0 = any free one (0)"},
        {"texture", 0, CLI_TEXT, &def.texture, 0, 0, NULL, "FILE", "PNG or JPEG to show; read again when it changes"},
        {"script", 0, CLI_TEXT, &script, 0, 0, NULL, "FILE", "the session's log: gone on with, and written to"},
    };
    cli_common_options(&run, options + 4);
    int code = cli_parse(&verb, options, CLI_COMMON_OPTIONS + 4, argc, argv, 2, files, &file_count);
    if (code >= 0) {
        return code;
    }
    if ((code = cli_check_output(verb.name, def.output, false)) >= 0 || (code = cli_begin(&run)) >= 0) {
        return code;
    }
    sl_meshfile *file = NULL;
    sl_session *session = NULL;
    sl_diag diag = sl_diag_none();
    const char *slash = strrchr(files[0], '/');
    def.title = slash != NULL ? slash + 1 : files[0];
    def.stop = on_stop;
    def.stop_user = &run;
    def.log = on_log;
    code = cli_read_mesh(&run, files[0], &file);
    if (code == CLI_DONE) {
        code = open_session(&run, file, script, &session);
    }
    if (code == CLI_DONE && script != NULL) {
        code = cli_fail(&run, sl_session_log_to(session, script, files[0], &diag), &diag);
    }
    if (code == CLI_DONE) {
        code = serve(&run, session, file, &def);
    }
    sl_session_free(session);
    sl_meshfile_free(file);
    return cli_end(&run, code);
}
