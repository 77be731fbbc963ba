/* seamlab abf: angle based flattening of one chart, an iteration at a time, with constraints. */
#define _POSIX_C_SOURCE 200809L
#include "base/memory.h"
#include "cli/abf_trace.h"
#include "cli/render_animate.h"
#include "geom/vec3.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <termios.h>
#include <unistd.h>

static const cli_verb verb = {
    .name = "abf",
    .usage = "seamlab abf MESH [-o OUT] [--step] [--iterations N] [--trace FILE.json] [--report FILE.html]\n"
             "            [--animate FILE.png] [constraints]",
    .summary = "Flattens one chart by ABF++ and shows every Newton iteration: energy, gradient, residuals of the\n"
               "constraints, sizes of the matrices, and the matrices of a small chart (reports/design/abf-by-hand.md\n"
               "follows one with pencil and paper). Constraints (paper, Sec. 4.2) name vertices by input number,\n"
               "counted from 0; V/F is the copy of V at facet F where seams give it several. Targets that are not\n"
               "reached in one go are approached step by step, unless --step or --iterations is given, and what is\n"
               "left is told. Exit 4: they contradict one another or are not reached, or the solver did not converge.",
    .examples = "  seamlab abf chart.obj --step\n"
                "  seamlab abf chart.obj --rectangle 1,3,5,7 --report steps.html\n"
                "  seamlab abf chart.obj --straight 3,9 -o straight.obj\n"
                "  seamlab abf chart.obj --angle 12=90 --straight 3,40,41,9 --trace steps.json\n"
                "  seamlab abf model.obj --chart 2 --wheel ratio --energy unweighted\n"
                "  seamlab abf model.obj --seams edges.csv --chart 0 --pin 4=0,0 --pin 9=1,0\n",
    .min_files = 1,
    .max_files = 1,
};

/* How it ended. */
typedef struct outcome {
    bool converged, quit; /* quit: stopped by hand before */
} outcome;

typedef struct abf_options {
    cli_run run;
    abf_source source;
    abf_asked asked;
    bool step;
    int32_t energy, wheel, newton;
    int32_t iterations; /* -1 = not said */
    const char *trace, *report, *output, *animation;
    sl_abf_def def;
} abf_options;

enum { OWN_OPTIONS = 18, MOST_ITERATIONS = 1000 };

static const char end_of_input[] = {4, 0}; /* Ctrl-D, as it comes raw and as it comes from a line begun before */

static void option_table(abf_options *o, cli_option *table)
{
    const cli_option own[OWN_OPTIONS] = {
        {"step", 0, CLI_FLAG, &o->step, 0, 0, NULL, NULL, "an iteration a key: q quits, r runs to the end"},
        {"iterations", 0, CLI_INT, &o->iterations, 0, MOST_ITERATIONS, NULL, "N", "at most, from the start (40)"},
        {"output", 'o', CLI_TEXT, &o->output, 0, 0, NULL, "OUT", "OBJ or PLY: the mesh with this chart's UVs"},
        {"trace", 0, CLI_TEXT, &o->trace, 0, 0, NULL, "FILE", "JSON of all iterations: angles, residuals, layouts"},
        {"report", 0, CLI_TEXT, &o->report, 0, 0, NULL, "FILE", "HTML: each layout, convergence, the computation"},
        {"animate", 0, CLI_TEXT, &o->animation, 0, 0, NULL, "FILE", "animated PNG: each layout, on the model and flat"},
        {"angle", 0, CLI_LIST, &o->asked.angle, 0, 0, NULL, "V=DEG", "angle of the chart at border vertex V"},
        {"straight", 0, CLI_LIST, &o->asked.straight, 0, 0, NULL, "V1,V2,...",
         "a path of edges becomes straight; two vertices: the shortest path"},
        {"right-angle", 0, CLI_LIST, &o->asked.right, 0, 0, NULL, "V", "lines and border meet at right angles"},
        {"rectangle", 0, CLI_LIST, &o->asked.rectangle, 0, 0, NULL, "A,B,C,D", "the border, by its four corners"},
        {"pin", 0, CLI_LIST, &o->asked.pin, 0, 0, NULL, "V=U,V", "where a vertex lies: once or twice (similarity)"},
        {"energy", 0, CLI_CHOICE, &o->energy, 0, 0, "weighted|unweighted", NULL, "Eq. 1 with 1/phi^2 (default) or 1"},
        {"wheel", 0, CLI_CHOICE, &o->wheel, 0, 0, "log|product|ratio", NULL, "form of g3; ratio is Eq. 4"},
        {"newton", 0, CLI_CHOICE, &o->newton, 0, 0, "dropped|exact", NULL, "curvature of the constraints"},
        {"tolerance", 0, CLI_REAL, &o->def.gradient_tolerance, 1e-15, 1.0, NULL, "G", "on |grad| (1e-6)"},
        {"chart", 0, CLI_INT, &o->source.chart, 0, 2147483647, NULL, "N", "of a mesh that is no disk (the largest)"},
        {"seams", 0, CLI_TEXT, &o->source.seams, 0, 0, NULL, "FILE", "cut here: a line of two vertices an edge"},
        {"strict", 0, CLI_FLAG, &o->run.strict, 0, 0, NULL, NULL, "exit 4 also when stopped by q, not converged"},
    };
    memcpy(table, own, sizeof own);
    cli_common_options(&o->run, table + OWN_OPTIONS);
}

/* One key from the terminal, without waiting for Enter; 'q' when there is no more. */
static char read_key(void)
{
    struct termios cooked, raw;
    char key = 'q';
    if (tcgetattr(STDIN_FILENO, &cooked) != 0) {
        return 'r';
    }
    raw = cooked;
    raw.c_lflag &= ~(tcflag_t)(ICANON | ECHO);
    raw.c_cc[VMIN] = 1;
    raw.c_cc[VTIME] = 0;
    tcsetattr(STDIN_FILENO, TCSANOW, &raw);
    if (read(STDIN_FILENO, &key, 1) != 1) {
        key = 'q';
    }
    tcsetattr(STDIN_FILENO, TCSANOW, &cooked);
    return key == end_of_input[0] || key == end_of_input[1] ? 'q' : key;
}

static void show_matrices(const sl_abf *solver, bool schur)
{
    sl_csc *J = NULL;
    if (sl_abf_jacobian(solver, &J) == SL_OK) {
        abf_print_matrix("J (rows g1, g2, g3; columns angles)", J, false);
    }
    sl_csc_free(J);
    if (schur) {
        abf_print_matrix("Schur complement (rows g2, g3)", sl_abf_schur(solver), true);
    }
    putchar('\n');
}

/* An iteration a key; *quit = stopped by hand. */
static sl_status iterate(abf_options *o, abf_trace *trace, sl_abf *solver, bool *quit)
{
    const bool talk = !o->run.json && !o->run.quiet;
    const bool small = talk && trace->pick->patch->nt <= ABF_MATRIX_TRIANGLES;
    bool wait = o->step && talk && isatty(STDIN_FILENO) && isatty(STDOUT_FILENO);
    const sl_abf_info *info = sl_abf_info_of(solver);
    o->run.bar = false; /* the lines below say how it goes */
    sl_status status = abf_trace_add(trace, solver, &o->run.context);
    if (status == SL_OK && talk) {
        abf_print_head(trace);
        abf_print_frame(trace, 0);
    }
    if (status == SL_OK && wait) {
        cli_note(&o->run, "any key: an iteration; r: run to the end; q: quit");
    }
    while (status == SL_OK && info->iterations < o->def.max_iterations && !info->converged && !info->stalled) {
        const char key = wait ? read_key() : 'r';
        if (key == 'q') {
            *quit = true;
            break;
        }
        wait = wait && key != 'r';
        const int32_t before = info->iterations;
        status = sl_abf_step(solver, 1, &o->run.context);
        if (status == SL_OK) {
            status = abf_trace_add(trace, solver, &o->run.context);
        }
        if (status == SL_OK && talk) {
            abf_print_frame(trace, trace->count - 1);
        }
        if (status == SL_OK && wait && small) {
            show_matrices(solver, true);
        }
        if (info->iterations == before) {
            break;
        }
    }
    return status;
}

/* Everything that is wanted of the finished trace. */
static sl_status deliver(abf_options *o, const abf_trace *trace, sl_diag *diag)
{
    sl_status status = SL_OK;
    if (o->run.json) {
        SL_TRY(abf_trace_write(trace, "-", diag));
    } else if (!o->run.quiet) {
        if (trace->J != NULL && !o->step) {
            abf_print_matrix("J (rows g1, g2, g3; columns angles)", trace->J, false);
            abf_print_matrix("Schur complement of the last iteration (rows g2, g3)", trace->M, true);
        }
        abf_print_end(trace);
    }
    if (o->trace != NULL) {
        SL_TRY(abf_trace_write(trace, o->trace, diag));
    }
    if (o->report != NULL) {
        SL_TRY(abf_report_write(trace, o->report, diag));
    }
    if (o->animation != NULL) {
        SL_TRY(cli_animate_solve(trace, o->animation, &o->run.context, diag));
    }
    if (o->output != NULL) {
        SL_TRY(abf_mesh_write(trace, o->output, diag));
    }
cleanup:
    return status;
}

/* The solver by itself, which takes the targets as they are. */
static sl_status step_by_step(abf_options *o, abf_trace *trace, outcome *out)
{
    sl_status status = SL_OK;
    sl_abf *solver = NULL;
    SL_TRY(sl_abf_create(trace->pick->patch, &o->def, &solver));
    SL_TRY(iterate(o, trace, solver, &out->quit));
    SL_TRY(abf_trace_close(trace, solver));
    out->converged = sl_abf_info_of(solver)->converged;
cleanup:
    sl_abf_free(solver);
    return status;
}

/* What looks on while a chart is solved for. */
typedef struct watcher {
    abf_options *o;
    abf_trace *trace;
    bool held; /* what comes now is no step, but what is held after all */
    sl_status status;
} watcher;

static bool note_frame(void *user, const sl_abf *solver)
{
    watcher *w = user;
    const bool talk = !w->o->run.json && !w->o->run.quiet;
    w->status = abf_trace_add(w->trace, solver, &w->o->run.context);
    if (w->status == SL_OK && w->held) {
        abf_trace_hold(w->trace);
    }
    if (w->status == SL_OK && talk) {
        if (w->trace->count == 1) {
            abf_print_head(w->trace);
        }
        abf_print_frame(w->trace, w->trace->count - 1);
    }
    return w->status == SL_OK;
}

/* The chart in hand: homotopy where the targets are hard, and a valid state held. */
static sl_status solve_chart(abf_options *o, abf_trace *trace, outcome *out)
{
    sl_abf_chart *chart = NULL;
    watcher w = {o, trace, false, SL_OK};
    sl_abf_def def = o->def;
    def.watch = note_frame;
    def.watch_user = &w;
    o->run.bar = false; /* the lines say how it goes */
    sl_status status = sl_abf_chart_create(trace->pick->patch, &def, &o->run.context, &chart);
    status = status == SL_CANCELLED && w.status != SL_OK ? w.status : status;
    SL_TRY(status);
    trace->chart = *sl_abf_chart_info_of(chart);
    const size_t size = 3 * (size_t)trace->pick->patch->nt * sizeof(double);
    if (trace->count == 0 || memcmp(abf_trace_last(trace)->alpha, sl_abf_chart_angles(chart), size) != 0) {
        w.held = trace->count > 0; /* the last try came to nothing */
        SL_TRY(note_frame(&w, sl_abf_chart_solver(chart)) ? SL_OK : w.status);
    }
    SL_TRY(abf_trace_close(trace, sl_abf_chart_solver(chart)));
    out->converged = trace->chart.converged && trace->chart.reached == 1.0;
cleanup:
    sl_abf_chart_free(chart);
    return status;
}

/* Pins that cannot be, before anything is solved: on a layout where no two vertices are in one place. */
static sl_status check_pins(const sl_patch *patch, const abf_constraints *constraints, sl_diag *diag)
{
    double *probe = sl_calloc(2 * (int64_t)patch->nv, sizeof *probe);
    if (probe == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t v = 0; v < patch->nv; v++) {
        probe[2 * (int64_t)v] = v;
    }
    const sl_status status = sl_pins_apply(patch, constraints->pins, constraints->pin, probe, diag);
    sl_free(probe);
    return status;
}

static void measure_angles(const sl_patch *patch, double *beta)
{
    for (int32_t c = 0; c < 3 * patch->nt; c++) {
        const double *p = &patch->xyz[3 * (int64_t)patch->tri[c]];
        double a[3], b[3], normal[3];
        sl_vec3_sub(&patch->xyz[3 * (int64_t)patch->tri[sl_corner_next(c)]], p, a);
        sl_vec3_sub(&patch->xyz[3 * (int64_t)patch->tri[sl_corner_prev(c)]], p, b);
        sl_vec3_cross(a, b, normal);
        beta[c] = atan2(sl_vec3_norm(normal), sl_vec3_dot(a, b));
    }
}

static sl_status solve(abf_options *o, const abf_pick *pick, const abf_constraints *constraints, outcome *out,
                       sl_diag *diag)
{
    const sl_patch *patch = pick->patch;
    sl_status status = SL_OK;
    sl_sector_table table = {0};
    double *angles = sl_alloc(9 * (int64_t)patch->nt, sizeof *angles), *phi = angles;
    abf_trace trace = {.file = o->source.file, .pick = pick, .constraints = constraints, .table = &table};
    SL_TRY(angles != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    phi += 3 * (int64_t)patch->nt;
    SL_TRY(sl_constraints_compile(patch, constraints->count, constraints->item, pick->name, &table, diag));
    SL_TRY(check_pins(patch, constraints, diag));
    o->def.sectors = &table.view;
    trace.keep = o->run.json || o->trace != NULL || o->report != NULL || o->animation != NULL;
    trace.def = o->def;
    trace.phi = phi;
    trace.weight = phi + 3 * (int64_t)patch->nt;
    trace.beta = angles;
    measure_angles(patch, angles);
    sl_abf_targets(patch, &o->def, phi, phi + 3 * (int64_t)patch->nt);
    SL_TRY(o->step || o->iterations >= 0 ? step_by_step(o, &trace, out) : solve_chart(o, &trace, out));
    SL_TRY(deliver(o, &trace, diag));
cleanup:
    abf_trace_clear(&trace);
    sl_sectors_clear(&table);
    sl_free(angles);
    return status;
}

static int run(abf_options *o)
{
    abf_pick pick = {0};
    abf_constraints constraints = {0};
    sl_diag diag = sl_diag_none();
    outcome out = {0};
    int code = abf_pick_chart(&o->run, &o->source, &pick);
    if (code == CLI_DONE) {
        code = abf_constraints_read(&o->run, &pick, &o->asked, &constraints);
    }
    if (code == CLI_DONE) {
        code = cli_fail(&o->run, solve(o, &pick, &constraints, &out, &diag), &diag);
        const bool fine = out.converged || (out.quit && !o->run.strict);
        code = code == CLI_DONE && !fine ? CLI_INFEASIBLE : code;
    }
    abf_constraints_clear(&constraints);
    abf_pick_clear(&pick);
    return code;
}

int cli_abf(int argc, char **argv)
{
    abf_options o = {.run = {.verb = verb.name}, .source = {.chart = -1}, .iterations = -1, .def = sl_abf_default()};
    cli_option options[OWN_OPTIONS + CLI_COMMON_OPTIONS];
    int32_t files = 0;
    option_table(&o, options);
    int code = cli_parse(&verb, options, (int32_t)SL_COUNTOF(options), argc, argv, 2, &o.source.file, &files);
    if (code >= 0) {
        return code;
    }
    if ((code = cli_check_output(verb.name, o.output, false)) >= 0) {
        return code;
    }
    if (o.animation != NULL && strcmp(o.animation, "-") != 0 && !cli_has_extension(o.animation, ".png")) {
        return cli_usage(verb.name, "--animate writes an animated .png, not %s", o.animation);
    }
    o.def.max_iterations = o.iterations >= 0 ? o.iterations : o.def.max_iterations;
    o.def.energy = (sl_abf_energy)o.energy;
    o.def.wheel = (sl_abf_wheel)o.wheel;
    o.def.newton = (sl_abf_newton)o.newton;
    code = cli_begin(&o.run);
    return code >= 0 ? code : cli_end(&o.run, run(&o));
}
