/* seamlab compare: any atlases, by the same measures. */
#include "cli/compare.h"

#include "cli/measured.h"
#include "cli/render_scene.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const cli_verb verb = {
    .name = "compare",
    .usage = "seamlab compare [NAME=]FILE... [-o PNG|DIR] [--csv] [--json] [options]",
    .summary = "Measures the UVs of several files, whatever tool made them, by the same rules, and tabulates\n"
               "them; the best of each row is starred. With -o it draws them side by side, in space and in\n"
               "UV space, the checkerboard's squares of one size on all surfaces.",
    .examples = "  seamlab compare ours.obj theirs.obj\n"
                "  seamlab compare seamlab=spot-uv.obj xatlas=spot.xatlas.obj -o spot.png\n"
                "  seamlab compare a.obj b.obj c.obj --csv > table.csv\n",
    .min_files = 1,
    .max_files = CLI_MAX_FILES,
};

/* Which values are better. */
typedef enum preference { NEITHER, LESS, MORE } preference;

/* A column: its name in the tables of other tools, and what it is. */
typedef struct column {
    const char *name, *meaning;
    char style; /* 'f' or 'g' of printf, and its precision */
    int digits;
    preference better;
} column;

enum { NUMBERS = 20 };

static const column columns[NUMBERS] = {
    {"tri", "triangles", 'f', 0, NEITHER},
    {"charts", "charts", 'f', 0, LESS},
    {"charts10", "... of at most 10 triangles", 'f', 0, LESS},
    {"seamLen", "seam length / sqrt(area)", 'f', 3, LESS},
    {"flip", "flipped triangles", 'f', 0, LESS},
    {"deg", "degenerate triangles", 'f', 0, LESS},
    {"ovIn", "overlap inside charts", 'f', 5, LESS},
    {"ovX", "overlap across charts", 'f', 5, LESS},
    {"angMean", "angle s1/s2, mean", 'f', 4, LESS},
    {"ang95", "... 95 % below", 'f', 3, LESS},
    {"angMax", "... largest", 'g', 3, LESS},
    {"L2", "stretch L2", 'f', 4, LESS},
    {"Linf", "stretch Linf", 'g', 4, LESS},
    {"areaMean", "area ratio, mean", 'f', 4, LESS},
    {"areaMax", "... largest", 'g', 4, LESS},
    {"pack", "texels covered", 'f', 4, MORE},
    {"copies", "charts that copy others", 'f', 0, NEITHER},
    {"shared", "texels shared by intent", 'f', 5, NEITHER},
    {"dupFacets", "duplicate facets", 'f', 0, NEITHER},
    {"degFacets", "degenerate facets", 'f', 0, NEITHER},
};

static void take_values(const sl_atlas_measure *m, double value[NUMBERS])
{
    const sl_distortion *d = &m->global;
    const double all[NUMBERS] = {m->triangles,  m->charts,     m->charts10,         m->seam_length,
                                 d->flipped,    d->degenerate, m->overlap_inside,   m->overlap_across,
                                 d->angle_mean, d->angle_p95,  d->angle_max,        d->l2,
                                 d->linf,       d->area_mean,  d->area_max,         m->fill,
                                 m->copies,     m->shared,     m->duplicate_facets, m->degenerate_facets};
    memcpy(value, all, sizeof all);
}

static void print_value(const column *c, int width, double value)
{
    if (c->style == 'g') {
        printf("%*.*g", width, c->digits, value);
    } else {
        printf("%*.*f", width, c->digits, value);
    }
}

static void print_csv(const cli_contender *contender, int32_t count)
{
    printf("name");
    for (int k = 0; k < NUMBERS; k++) {
        printf(",%s", columns[k].name);
    }
    for (int32_t i = 0; i < count; i++) {
        double value[NUMBERS];
        take_values(&contender[i].measure, value);
        printf("\n%s", contender[i].name);
        for (int k = 0; k < NUMBERS; k++) {
            putchar(',');
            print_value(&columns[k], 0, value[k]);
        }
    }
    putchar('\n');
}

static void print_json(const cli_contender *contender, int32_t count)
{
    json_t *rows = json_array();
    for (int32_t i = 0; i < count; i++) {
        json_t *row = cli_measure_json(contender[i].path, &contender[i].measure);
        json_object_set_new(row, "name", json_string(contender[i].name));
        json_array_append_new(rows, row);
    }
    json_t *all =
        json_pack("{s:i, s:i, s:o}", "schema", 1, "resolution", contender[0].measure.resolution, "atlases", rows);
    json_dumpf(all, stdout, JSON_COMPACT | JSON_REAL_PRECISION(9));
    putchar('\n');
    json_decref(all);
}

/* Is value[i] the best of the row, and not every one of them? Values that print alike are alike. */
static bool is_best(const column *c, const double *value, int32_t count, int32_t i)
{
    const double sign = c->better == MORE ? -1.0 : 1.0, unit = pow(10.0, c->digits);
    bool beats = false;
    for (int32_t k = 0; k < count && c->better != NEITHER; k++) {
        const double difference = sign * (round(value[i] * unit) - round(value[k] * unit));
        if (difference > 0.0 || (isinf(value[i]) && c->better == LESS)) {
            return false;
        }
        beats |= difference < 0.0;
    }
    return beats;
}

enum { LABEL = 26, WIDTH = 16, TERMINAL = 110 };

/* A block of columns [first, end) of the text table: atlases across, numbers down. */
static void print_block(const cli_contender *contender, int32_t count, int32_t first, int32_t end)
{
    printf("%-10s%-*s", "", LABEL, "");
    for (int32_t i = first; i < end; i++) {
        printf(" %*.*s", WIDTH, WIDTH, contender[i].name);
    }
    putchar('\n');
    for (int k = 0; k < NUMBERS; k++) {
        double row[CLI_MAX_FILES];
        bool any = columns[k].better != NEITHER || k == 0;
        for (int32_t i = 0; i < count; i++) {
            double value[NUMBERS];
            take_values(&contender[i].measure, value);
            row[i] = value[k];
            any |= row[i] != 0.0;
        }
        if (!any) { /* nobody shares, no facet stands apart */
            continue;
        }
        printf("%-10s%-*s", columns[k].name, LABEL, columns[k].meaning);
        for (int32_t i = first; i < end; i++) {
            print_value(&columns[k], WIDTH, row[i]);
            putchar(is_best(&columns[k], row, count, i) ? '*' : ' ');
        }
        putchar('\n');
    }
}

static void print_table(const cli_contender *contender, int32_t count)
{
    const int32_t across = (TERMINAL - LABEL - 10) / (WIDTH + 1);
    for (int32_t first = 0; first < count; first += across) {
        if (first > 0) {
            putchar('\n');
        }
        print_block(contender, count, first, first + across < count ? first + across : count);
    }
}

/* Splits "NAME=FILE"; without a name it is the file's, without folder and extension. */
static void name_contender(const char *argument, cli_contender *c)
{
    const char *equals = strchr(argument, '='), *slash = strrchr(argument, '/');
    if (equals != NULL && equals != argument && memchr(argument, '/', (size_t)(equals - argument)) == NULL) {
        c->path = equals + 1;
        snprintf(c->name, sizeof c->name, "%.*s", (int)(equals - argument), argument);
        return;
    }
    c->path = argument;
    snprintf(c->name, sizeof c->name, "%s", slash != NULL ? slash + 1 : argument);
    char *dot = strrchr(c->name, '.');
    if (dot != NULL && dot != c->name) {
        *dot = '\0';
    }
}

/* Names must be fit for a table and for files, and differ. */
static int check_names(cli_contender *contender, int32_t count)
{
    for (int32_t i = 0; i < count; i++) {
        for (char *p = contender[i].name; *p != '\0'; p++) {
            if (*p < ' ' || *p > '~' || strchr(",\"/", *p) != NULL) {
                *p = '_';
            }
        }
        for (int32_t k = 0; k < i; k++) {
            if (strcmp(contender[i].name, contender[k].name) == 0) {
                return cli_usage(verb.name, "two atlases are called %s; name them: NAME=FILE", contender[i].name);
            }
        }
    }
    return -1;
}

int cli_compare(int argc, char **argv)
{
    enum { OWN = 6, ALL = OWN + CLI_COMMON_OPTIONS };
    cli_run run = {.verb = verb.name};
    cli_contender contender[CLI_MAX_FILES];
    cli_compare_pictures pictures = {.side = 560, .view = sl_view_default()};
    const char *files[CLI_MAX_FILES], *camera = NULL;
    int32_t resolution = 2048, count = 0;
    bool csv = false;
    const cli_option own[OWN] = {
        {"output", 'o', CLI_TEXT, &pictures.output, 0, 0, NULL, "OUT",
         "OUT.png: all side by side; else a folder: compare.png, and a picture of each"},
        {"csv", 0, CLI_FLAG, &csv, 0, 0, NULL, NULL, "a line an atlas"},
        {"resolution", 0, CLI_INT, &resolution, 1, 16384, NULL, "N", "texels a side for overlap and fill (2048)"},
        {"camera", 0, CLI_TEXT, &camera, 0, 0, NULL, "VIEW",
         "as of render: front, back, ... or AZIMUTH,ELEVATION[,FOV]"},
        {"panel", 0, CLI_INT, &pictures.side, 64, 4096, NULL, "N", "pixels a panel (560)"},
        {"no-shadows", 0, CLI_FLAG, &pictures.fast, 0, 0, NULL, NULL, "plain light: several times faster"},
    };
    cli_option options[ALL];
    memcpy(options, own, sizeof own);
    cli_common_options(&run, options + OWN);
    int code = cli_parse(&verb, options, ALL, argc, argv, 2, files, &count);
    if (code >= 0) {
        return code;
    }
    if (camera != NULL && !cli_camera_parse(camera, &pictures.view)) {
        return cli_usage(verb.name, "--camera is no view: '%s'", camera);
    }
    for (int32_t i = 0; i < count; i++) {
        name_contender(files[i], &contender[i]);
    }
    if ((code = check_names(contender, count)) >= 0 || (code = cli_begin(&run)) >= 0) {
        return code;
    }
    code = CLI_DONE;
    for (int32_t i = 0; i < count && code == CLI_DONE; i++) {
        code = cli_measure_path(&run, contender[i].path, resolution, &contender[i].measure);
    }
    if (code == CLI_DONE && pictures.output != NULL) {
        code = cli_compare_draw(&run, contender, count, &pictures);
    }
    if (code == CLI_DONE) {
        (run.json ? print_json : csv ? print_csv : print_table)(contender, count);
    }
    return cli_end(&run, code);
}
