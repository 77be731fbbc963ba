/* seamlab: the program. One verb a file. */
#include "cli/cli.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

typedef struct verb_entry {
    const char *name;
    int (*run)(int argc, char **argv);
    const char *summary;
} verb_entry;

static const verb_entry verbs[] = {
    {"unwrap", cli_unwrap, "cut, flatten and pack a mesh: UVs, a sidecar, pictures"},
    {"measure", cli_measure, "charts, seams, distortion, overlap and fill of any mesh with UVs"},
    {"overlap", cli_overlap, "do the UVs of a mesh overlap, and where: by texels, or exactly"},
    {"check", cli_check, "what is wrong with a mesh and how it would be repaired"},
    {"segment", cli_segment, "the charts only: labels, seam edges, a coloured PLY"},
    {"spectrum", cli_spectrum, "eigenvectors of the facet graph and the cuts they propose"},
    {"abf", cli_abf, "one chart flattened an iteration at a time, with angles and lines as you ask"},
    {"theorem", cli_theorem, "the symmetric-graph theorem, checked on random graphs and meshes; TAP for CI"},
    {"render", cli_render, "pictures: in space and in UV space, seams, charts, overlap, stretch, eigenvectors"},
    {"demo", cli_demo, "the whole way on a generated mesh, with pictures"},
};

static void print_usage(FILE *out)
{
    fprintf(out, "seamlab: automatic and scriptable UV unwrapping\n\n"
                 "Examples:\n"
                 "  seamlab demo\n"
                 "  seamlab unwrap model.obj -o model-uv.obj --preview pictures\n"
                 "  seamlab measure model-uv.obj\n\n"
                 "Usage: seamlab VERB [options] files\n\nVerbs:\n");
    for (size_t k = 0; k < SL_COUNTOF(verbs); k++) {
        fprintf(out, "  %-10s %s\n", verbs[k].name, verbs[k].summary);
    }
    fprintf(out,
            "\n`seamlab VERB --help` explains one. Exit codes: 0 done, 1 internal or system error, 2 usage,\n"
            "3 bad input, 4 infeasible or a warning under --strict, 5 own check failed, 6 limit, 130 interrupted.\n");
}

/* Text that did not reach standard output (a full disk) is no success. */
static int flushed(int code)
{
    if (fflush(stdout) == 0 && !ferror(stdout)) {
        return code;
    }
    if (code == CLI_DONE) {
        fprintf(stderr, "seamlab: writing to standard output failed: %s\n", strerror(errno));
    }
    return code == CLI_DONE ? CLI_INTERNAL : code;
}

int main(int argc, char **argv)
{
    if (argc >= 2 && strcmp(argv[1], "--version") == 0) {
        printf("seamlab %s\n", SEAMLAB_VERSION);
        return flushed(CLI_DONE);
    }
    if (argc < 2 || strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0 || strcmp(argv[1], "help") == 0) {
        print_usage(argc < 2 ? stderr : stdout);
        return flushed(argc < 2 ? CLI_USAGE : CLI_DONE);
    }
    for (size_t k = 0; k < SL_COUNTOF(verbs); k++) {
        if (strcmp(argv[1], verbs[k].name) == 0) {
            return flushed(verbs[k].run(argc, argv));
        }
    }
    fprintf(stderr, "seamlab: there is no verb '%s'\n", argv[1]);
    print_usage(stderr);
    return CLI_USAGE;
}
