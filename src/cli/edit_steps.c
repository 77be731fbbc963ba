#include "cli/edit_steps.h"

#include <inttypes.h>
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/text.h"
#include "edit/picture.h"
#include "image/png.h"

static const double beyond = 1e-9; /* outside of the page by rounding only */

/* The atlas in a few numbers. */
typedef struct outline {
    int32_t charts, red, constraints, outside;
    double stretch;
} outline;

static outline outline_of(const sl_session *session)
{
    outline o = {.constraints = sl_session_constraints(session), .stretch = 1.0};
    for (int32_t i = 0; i < sl_session_slots(session); i++) {
        sl_session_chart chart;
        sl_session_chart_info(session, i, &chart);
        if (chart.faces > 0) {
            o.charts++;
            o.red += chart.red;
            o.outside +=
                fmin(chart.low[0], chart.low[1]) < -beyond || fmax(chart.high[0], chart.high[1]) > 1.0 + beyond;
            o.stretch = fmax(o.stretch, chart.distortion.l2);
        }
    }
    return o;
}

static int draw_step(cli_steps *steps, const sl_session *session, int32_t index, const char *line)
{
    char name[32], path[4096], title[96];
    sl_diag diag = sl_diag_none();
    sl_image *image = NULL;
    sl_picture picture = sl_picture_default();
    picture.width = 1600;
    picture.height = 800;
    snprintf(title, sizeof title, "%.90s", line);
    for (char *c = title; *c != '\0'; c++) {
        *c = (unsigned char)*c < 0x80 ? *c : '?';
    }
    picture.title = title;
    snprintf(name, sizeof name, "step-%05d.png", index);
    sl_status status = sl_session_picture(session, NULL, &picture, &steps->run->context, &image, &diag);
    if (status == SL_OK && !cli_join_path(steps->pictures, name, path, sizeof path)) {
        sl_diag_reason(&diag, "the folder's name is too long");
        status = SL_IO;
    }
    if (status == SL_OK) {
        status = sl_png_write(path, image, &diag);
    }
    sl_image_free(image);
    return cli_fail(steps->run, status, &diag);
}

static bool after_step(void *user, const sl_session *session, const sl_script *script, int32_t index)
{
    cli_steps *steps = user;
    const outline o = outline_of(session);
    char *line = sl_action_format(&script->action[index]);
    if (steps->table && line != NULL) {
        printf("%5d %6" PRId64 " %7d %6d %9.3f  %s\n", index, script->line[index], o.charts, o.red, o.stretch, line);
    }
    for (int32_t k = 0; k < sl_session_notes(session); k++) {
        cli_note(steps->run, "line %" PRId64 ": %s", script->line[index], sl_session_note(session, k));
    }
    if (steps->pictures != NULL && line != NULL) {
        steps->code = draw_step(steps, session, index, line);
    }
    sl_free(line);
    return steps->code == CLI_DONE;
}

/* A script that the disk refuses is as bad as one that is broken. */
static int read_script(cli_run *run, const char *path, bool tolerant, sl_script *script)
{
    sl_diag diag = sl_diag_none();
    const sl_status status = sl_script_read(path, tolerant, script, &diag);
    const int code = cli_fail(run, status, &diag);
    return status == SL_IO ? CLI_BAD_INPUT : code;
}

int cli_steps_run(cli_steps *steps, const char *mesh, const char *script_path, bool tolerant, sl_meshfile **file,
                  sl_session **session)
{
    sl_script script = {0};
    sl_diag diag = sl_diag_none();
    sl_polygons polygons;
    *file = NULL;
    *session = NULL;
    int code = cli_read_mesh(steps->run, mesh, file);
    if (code == CLI_DONE) {
        code = read_script(steps->run, script_path, tolerant, &script);
    }
    if (code == CLI_DONE && steps->pictures != NULL && !cli_make_folder(steps->run, steps->pictures)) {
        code = CLI_INTERNAL;
    }
    if (code == CLI_DONE) {
        if (script.cut_off) {
            cli_note(steps->run, "warning: the last line of %s has no end and is left out", script_path);
        }
        if (steps->table) {
            printf("# step   line  charts    red  worst-L2  action\n");
        }
        sl_meshfile_polygons(*file, &polygons);
        snprintf(diag.file, sizeof diag.file, "%s", script_path);
        const sl_status status = sl_script_run(&script, steps->count, &polygons, (*file)->corner_uv, NULL, after_step,
                                               steps, &steps->run->context, session, &diag);
        code = steps->code != CLI_DONE ? steps->code : cli_fail(steps->run, status, &diag);
    }
    sl_script_clear(&script);
    if (code != CLI_DONE) {
        sl_meshfile_free(*file);
        *file = NULL;
    }
    return code;
}

static void print_saved(cli_run *run, const sl_session *session, const sl_atlas_check *check, const char *output)
{
    const outline o = outline_of(session);
    if (o.outside > 0) {
        cli_note(run, "warning: %d chart%s beyond the page [0, 1]", o.outside, o.outside == 1 ? " reaches" : "s reach");
    }
    if (run->json) {
        char hash[20];
        snprintf(hash, sizeof hash, "%016" PRIx64, sl_session_hash(session));
        json_t *j =
            json_pack("{s:i, s:s, s:i, s:i, s:f, s:i, s:b, s:I, s:s}", "schema", 1, "output", output, "charts",
                      o.charts, "red", o.red, "worstL2", o.stretch, "constraints", o.constraints, "certified",
                      check->passed, "overlapping_texels", (json_int_t)check->overlapping_texels, "state", hash);
        FILE *out = strcmp(output, "-") == 0 ? stderr : stdout;
        json_dumpf(j, out, JSON_COMPACT | JSON_REAL_PRECISION(9));
        fputc('\n', out);
        json_decref(j);
        return;
    }
    cli_note(run, "%d chart%s, %d constraint%s, worst stretch L2 %.3f, %s", o.charts, sl_plural(o.charts),
             o.constraints, sl_plural(o.constraints), o.stretch,
             check->passed ? "no flip, no overlap: proven" : "uncertified: charts overlap");
}

int cli_steps_save(cli_run *run, const sl_session *session, const sl_meshfile *file, const char *output,
                   bool allow_overlap)
{
    char losses[256];
    sl_diag diag = sl_diag_none();
    sl_atlas_check check = {0};
    if (sl_meshfile_losses(file, output, losses, sizeof losses)) {
        cli_note(run, "note: the output's format does not hold %s", losses);
    }
    const sl_status status = sl_session_save(session, file, output, allow_overlap, &run->context, &check, &diag);
    const int code = cli_fail(run, status, &diag);
    if (code == CLI_DONE) {
        print_saved(run, session, &check, output);
    }
    return code;
}
