/* seamlab-gen: generated meshes as files, each with what is known of it beside it. */
#define _POSIX_C_SOURCE 200809L
#include "base/text.h"
#include "meshio/meshfile.h"
#include "truth.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* Exit codes as the program's own. */
enum { GEN_DONE = 0, GEN_INTERNAL = 1, GEN_USAGE = 2, GEN_CHECK_FAILED = 5, GEN_LIMIT = 6 };

enum { MOST_SCALE = 8 };

static const char help[] =
    "Writes generated meshes with known symmetries: NAME.obj, and NAME.json with the maps of\n"
    "vertices and facets, genus, components and borders. The same bytes for the same seed.\n\n"
    "Examples:\n"
    "  seamlab-gen --list\n"
    "  seamlab-gen crab mug -o meshes\n"
    "  seamlab-gen --all -o meshes --seed 7 --scale 2\n\n"
    "Usage: seamlab-gen NAME...|--all|--list [-o DIR] [--seed S] [--scale N] [--json]\n\n"
    "Options:\n"
    "  -o, --output DIR             folder to write into, made if need be (the current one)\n"
    "  --all                        every model\n"
    "  --list                       name the models, write nothing\n"
    "  --seed S                     of what is random in a model (1)\n"
    "  --scale N                    size, 1 to 8: each step is four times the facets (1)\n"
    "  --json                       what was written, or the list, as JSON on stdout\n"
    "  -q, --quiet                  only errors on stderr\n"
    "  -h, --help                   this text\n\n"
    "Exit codes: 0 done, 1 internal or system error, 2 usage, 5 a model failed its own check, 6 memory.\n";

typedef struct gen_options {
    const char *folder;
    uint64_t seed;
    int32_t scale;
    bool all, list, json, quiet;
    int names; /* argv[0 .. names - 1] after parsing */
} gen_options;

static int usage_error(const char *what, const char *value)
{
    fprintf(stderr, "seamlab-gen: %s %s\n  try: seamlab-gen --help\n", what, value);
    return GEN_USAGE;
}

/* A seed is any 64-bit number without a sign. */
static bool parse_seed(const char *text, uint64_t *seed)
{
    char *end = NULL;
    errno = 0;
    const unsigned long long value = strtoull(text, &end, 10);
    *seed = value;
    return text[0] >= '0' && text[0] <= '9' && *end == '\0' && errno == 0 && value <= UINT64_MAX;
}

/* An option with a value: -1 to go on, else the exit code. */
static int set_value(gen_options *o, const char *name, const char *value)
{
    int64_t whole = 0;
    if (strcmp(name, "-o") == 0 || strcmp(name, "--output") == 0) {
        o->folder = value;
        return -1;
    }
    if (strcmp(name, "--seed") == 0) {
        return parse_seed(value, &o->seed) ? -1 : usage_error("--seed needs a whole number from 0 on, not", value);
    }
    const char *end = value + strlen(value);
    if (sl_parse_int(value, end, &whole) != end || value == end || whole < 1 || whole > MOST_SCALE) {
        return usage_error("--scale needs a whole number from 1 to 8, not", value);
    }
    o->scale = (int32_t)whole;
    return -1;
}

static bool *find_flag(gen_options *o, const char *name)
{
    return strcmp(name, "--all") == 0                                ? &o->all
           : strcmp(name, "--list") == 0                             ? &o->list
           : strcmp(name, "--json") == 0                             ? &o->json
           : strcmp(name, "-q") == 0 || strcmp(name, "--quiet") == 0 ? &o->quiet
                                                                     : NULL;
}

/* -1 to go on, else the exit code. Names are moved to the front of argv. */
static int parse(int argc, char **argv, gen_options *o)
{
    static const char *const valued[] = {"-o", "--output", "--seed", "--scale"};
    for (int a = 1; a < argc; a++) {
        char *argument = argv[a];
        bool *flag = find_flag(o, argument);
        if (argument[0] != '-') {
            argv[o->names++] = argument;
        } else if (strcmp(argument, "-h") == 0 || strcmp(argument, "--help") == 0) {
            fputs(help, stdout);
            return GEN_DONE;
        } else if (flag != NULL) {
            *flag = true;
        } else {
            char *equals = argument[1] == '-' ? strchr(argument, '=') : NULL;
            size_t k = 0;
            if (equals != NULL) {
                *equals = '\0';
            }
            while (k < SL_COUNTOF(valued) && strcmp(valued[k], argument) != 0) {
                k++;
            }
            if (k == SL_COUNTOF(valued)) {
                return usage_error("unknown option", argument);
            }
            if (equals == NULL && a + 1 == argc) {
                return usage_error("a value is missing after", argument);
            }
            const int code = set_value(o, argument, equals != NULL ? equals + 1 : argv[++a]);
            if (code >= 0) {
                return code;
            }
        }
    }
    return o->all == (o->names > 0) && !o->list ? usage_error("give names of models, or --all, or --list", "") : -1;
}

static void print_list(bool json)
{
    int32_t count = 0;
    const sl_generator *generator = sl_generators(&count);
    for (int32_t k = 0; k < count; k++) {
        if (json) {
            printf("%s{\"name\": \"%s\", \"what\": \"%s\", \"genus\": %d, \"components\": %d, \"borders\": %d}%s",
                   k == 0 ? "[" : " ", generator[k].name, generator[k].what, generator[k].genus,
                   generator[k].components, generator[k].borders, k + 1 < count ? ",\n" : "]\n");
        } else {
            printf("%-14s %s\n", generator[k].name, generator[k].what);
        }
    }
}

static bool path_of(const gen_options *o, const char *name, const char *extension, char path[4096])
{
    const size_t n = strlen(o->folder);
    const char *slash = n > 0 && o->folder[n - 1] != '/' ? "/" : "";
    const int length = snprintf(path, 4096, "%s%s%s%s", o->folder, slash, name, extension);
    return length > 0 && length < 4096;
}

/* Makes, checks and writes one model. */
static sl_status write_model(const gen_options *o, const sl_generator *generator, bool first, sl_diag *diag)
{
    char obj[4096], json[4096];
    sl_generated *mesh = NULL;
    sl_meshfile *file = NULL;
    sl_polygons polygons;
    sl_repair_report report = {0};
    sl_status status = SL_OK;
    if (!path_of(o, generator->name, ".obj", obj) || !path_of(o, generator->name, ".json", json)) {
        sl_diag_reason(diag, "the folder's name is too long");
        return SL_IO;
    }
    SL_TRY(generator->make(o->seed, o->scale, &mesh));
    SL_TRY(gen_truth_check(generator, mesh, &report, diag));
    sl_generated_polygons(mesh, &polygons);
    SL_TRY(sl_meshfile_from_polygons(&polygons, &file, diag));
    SL_TRY(sl_meshfile_write(obj, file, NULL, diag));
    SL_TRY(gen_truth_write(json, generator, mesh, &report, o->seed, o->scale, diag));
    if (o->json) {
        printf("%s{\"name\": \"%s\", \"vertices\": %d, \"facets\": %d, \"symmetries\": %d}", first ? "[" : ",\n ",
               generator->name, mesh->nv, mesh->nf, mesh->nplanted);
    } else if (!o->quiet) {
        fprintf(stderr, "%-14s %8d facets %8d vertices, genus %" PRId64 ", %d borders, %d components, %d symmetries\n",
                generator->name, mesh->nf, mesh->nv, report.genus, report.border_loops, report.components,
                mesh->nplanted);
    }
cleanup:
    sl_repair_report_clear(&report);
    sl_meshfile_free(file);
    sl_generated_free(mesh);
    return status;
}

static int fail(const char *name, sl_status status, const sl_diag *diag)
{
    char text[1024];
    sl_diag_format(diag, text, sizeof text);
    fprintf(stderr, "seamlab-gen: %s: %s\n", name, diag->reason[0] != '\0' ? text : sl_status_name(status));
    return status == SL_CHECK_FAILED                          ? GEN_CHECK_FAILED
           : status == SL_OUT_OF_MEMORY || status == SL_LIMIT ? GEN_LIMIT
                                                              : GEN_INTERNAL;
}

static int write_models(const gen_options *o, char **names)
{
    int32_t count = 0;
    const sl_generator *table = sl_generators(&count);
    const int32_t wanted = o->all ? count : o->names;
    for (int k = 0; k < o->names; k++) {
        if (sl_generator_find(names[k]) == NULL) {
            return usage_error("there is no model of that name (--list names them):", names[k]);
        }
    }
    if (o->folder[0] != '\0' && mkdir(o->folder, 0777) != 0 && errno != EEXIST) {
        fprintf(stderr, "seamlab-gen: cannot make the folder %s: %s\n", o->folder, strerror(errno));
        return GEN_INTERNAL;
    }
    for (int32_t k = 0; k < wanted; k++) {
        const sl_generator *generator = o->all ? &table[k] : sl_generator_find(names[k]);
        sl_diag diag = sl_diag_none();
        const sl_status status = write_model(o, generator, k == 0, &diag);
        if (status != SL_OK) {
            fputs(o->json && k > 0 ? "]\n" : "", stdout);
            return fail(generator->name, status, &diag);
        }
    }
    fputs(o->json ? "]\n" : "", stdout);
    return GEN_DONE;
}

int main(int argc, char **argv)
{
    gen_options options = {.folder = "", .seed = 1, .scale = 1};
    int code = parse(argc, argv, &options);
    if (code < 0 && options.list) {
        print_list(options.json);
        code = GEN_DONE;
    } else if (code < 0) {
        code = write_models(&options, argv);
    }
    if (fflush(stdout) != 0 || ferror(stdout)) {
        fprintf(stderr, "seamlab-gen: writing to standard output failed\n");
        return code == GEN_DONE ? GEN_INTERNAL : code;
    }
    return code;
}
