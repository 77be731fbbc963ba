/* Command line, and the matrices it asks for. */
#include "bench/bench.h"

#include <stdlib.h>
#include <string.h>

static void usage(const char *name)
{
    fprintf(
        stderr,
        "usage: %s [--min-facets N] [--max-facets N] [--mesh FILE]... [--generated] [--runs R] [--pairs K] [--signs]\n"
        "       [--only NAME,NAME] [--all] [--basis N] [--timeout S] [--csv FILE]\n",
        name);
}

static bool read_number(const char *text, int64_t least, int64_t most, int64_t *out)
{
    char *end = NULL;
    const double value = strtod(text, &end);
    if (end == text || *end != '\0' || !(value >= (double)least && value <= (double)most)) {
        return false;
    }
    *out = (int64_t)value;
    return true;
}

static bool set_number(bench_options *o, const char *key, const char *text)
{
    int64_t value = 0;
    if (!read_number(text, 1, INT32_MAX, &value)) {
        return false;
    }
    if (strcmp(key, "--min-facets") == 0) {
        o->min_facets = value;
    } else if (strcmp(key, "--max-facets") == 0) {
        o->max_facets = value;
    } else if (strcmp(key, "--runs") == 0 && value <= BENCH_MAX_RUNS) {
        o->runs = (int32_t)value;
    } else if (strcmp(key, "--pairs") == 0 && value <= BENCH_MAX_PAIRS) {
        o->pairs = (int32_t)value;
    } else if (strcmp(key, "--basis") == 0 && value <= 10 * BENCH_MAX_PAIRS) {
        o->basis = (int32_t)value;
    } else if (strcmp(key, "--timeout") == 0) {
        o->timeout = (int32_t)value;
    } else {
        return false;
    }
    return true;
}

bool bench_parse_options(int argc, char **argv, const char *name, bench_options *options)
{
    *options = (bench_options){.max_facets = 300000, .runs = 3, .pairs = 30, .timeout = 1800};
    for (int i = 1; i < argc; i++) {
        const char *key = argv[i], *value = i + 1 < argc ? argv[i + 1] : "";
        if (strcmp(key, "--signs") == 0) {
            options->signs = true;
        } else if (strcmp(key, "--all") == 0) {
            options->all = true;
        } else if (strcmp(key, "--generated") == 0) {
            options->generated = true;
        } else if (strcmp(key, "--csv") == 0 && i + 1 < argc) {
            options->csv = value;
            i++;
        } else if (strcmp(key, "--only") == 0 && i + 1 < argc) {
            options->only = value;
            i++;
        } else if (strcmp(key, "--mesh") == 0 && i + 1 < argc && options->meshes < BENCH_MAX_MESHES) {
            options->mesh[options->meshes++] = value;
            i++;
        } else if (set_number(options, key, value)) {
            i++;
        } else {
            usage(name);
            return false;
        }
    }
    options->generated = options->generated || options->meshes == 0;
    return true;
}

bool bench_wanted(const bench_options *options, const char *name)
{
    if (options->only == NULL) {
        return true;
    }
    const size_t length = strlen(name);
    for (const char *at = options->only; at != NULL; at = strchr(at, ',')) {
        at += *at == ',' ? 1 : 0;
        if (strncmp(at, name, length) == 0 && (at[length] == ',' || at[length] == '\0')) {
            return true;
        }
    }
    return false;
}

/* The generated series starts at two sizes: 7k, and what subdivides to 70k, 280k, 1.1M and 4.4M. A mesh given is
 * subdivided, whatever the least size, until the builder of the matrix says that it is too large. */
int32_t bench_list_cases(const bench_options *options, bench_case *cases, int32_t capacity)
{
    int32_t count = 0;
    if (options->generated) {
        int64_t size = 4400 * 16;
        if (options->min_facets <= 7000) {
            cases[count++] = (bench_case){"generated", NULL, 7000, 0, options->max_facets};
        }
        for (int32_t level = 2; size <= options->max_facets && count < capacity; level++, size *= 4) {
            if (size >= options->min_facets) {
                cases[count++] = (bench_case){"generated", NULL, 4400, level, INT32_MAX};
            }
        }
    }
    for (int32_t m = 0; m < options->meshes; m++) {
        const char *slash = strrchr(options->mesh[m], '/');
        const char *name = slash != NULL ? slash + 1 : options->mesh[m];
        for (int32_t level = 0; level <= 8 && count < capacity; level++) {
            cases[count++] = (bench_case){name, options->mesh[m], 0, level, options->max_facets};
        }
    }
    return count;
}
