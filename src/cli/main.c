/* seamlab: the program. One verb a file. */
#include "cli/cli.h"
#include "cli/options_help.h"

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
    {"edit", cli_edit, "an atlas edited by a script: cut, sew, straighten, angles, symmetry, packing"},
    {"front", cli_front, "what is reachable: charts and seams by search against stretch, with a plot"},
    {"view", cli_view, "the atlas edited by hand on a page, in space and in UV space"},
    {"replay", cli_replay, "an editing session's log again, step by step: the same bytes"},
    {"measure", cli_measure, "charts, seams, distortion, overlap and fill of any mesh with UVs"},
    {"compare", cli_compare, "several atlases, whatever tool made them, by the same measures, with pictures"},
    {"overlap", cli_overlap, "do the UVs of a mesh overlap, and where: by texels, or exactly"},
    {"pack", cli_pack, "the charts of any mesh with UVs packed anew: nested, turned, on one page or several"},
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

static void print_man(void)
{
    cli_man_title("seamlab", "automatic and scriptable UV unwrapping");
    printf(".SH SYNOPSIS\n.B seamlab\n.I verb\n.RI [ options ]\n.I files\n.SH DESCRIPTION\n"
           "Cuts a mesh along seams that the eigenvectors of its facet graph propose, lays the charts flat by ABF++, "
           "proves\nthat none overlaps, and packs them. Each verb has a page of its own.\n.SH VERBS\n");
    for (size_t k = 0; k < SL_COUNTOF(verbs); k++) {
        printf(".TP\n.BR seamlab\\-%s (1)\n", verbs[k].name);
        cli_man_text(verbs[k].summary);
    }
    printf(".SH EXAMPLES\n.nf\nseamlab demo\nseamlab unwrap model.obj \\-o model\\-uv.obj \\-\\-preview pictures\n"
           "seamlab measure model\\-uv.obj\n.fi\n");
    cli_man_exit_codes();
}

/* Each verb prints its own part, from the table it parses by. */
static void print_parts(const char *argument)
{
    for (size_t k = 0; k < SL_COUNTOF(verbs); k++) {
        char program[] = "seamlab", name[64], help[16];
        snprintf(name, sizeof name, "%s", verbs[k].name);
        snprintf(help, sizeof help, "%s", argument);
        char *argv[] = {program, name, help, NULL};
        verbs[k].run(3, argv);
    }
}

static void print_names(const char *separator)
{
    for (size_t k = 0; k < SL_COUNTOF(verbs); k++) {
        printf("%s%s", verbs[k].name, separator);
    }
}

static void print_bash(void)
{
    printf("# bash completion for seamlab\n_seamlab() {\n"
           "    local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}\n"
           "    local words= files=no options=no\n    COMPREPLY=()\n"
           "    if [ \"$COMP_CWORD\" = 1 ]; then\n        mapfile -t COMPREPLY < <(compgen -W '");
    print_names(" ");
    printf("--help --version' -- \"$current\")\n        return\n    fi\n    case ${COMP_WORDS[1]} in\n");
    print_parts("--help=bash");
    printf("    esac\n    if [ $options = yes ] && [ \"${current:0:1}\" != - ]; then\n        files=yes\n    fi\n"
           "    if [ $files = yes ]; then\n        compopt -o filenames 2>/dev/null\n"
           "        mapfile -t COMPREPLY < <(compgen -f -- \"$current\")\n    else\n"
           "        mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$current\")\n    fi\n}\n"
           "complete -F _seamlab seamlab\n");
}

static void print_zsh(void)
{
    printf("#compdef seamlab\n");
    print_parts("--help=zsh");
    printf("_seamlab() {\n    if ((CURRENT == 2)); then\n        compadd -- ");
    print_names(" ");
    printf("--help --version\n        return\n    fi\n    local verb=$words[2]\n    shift words\n    ((CURRENT--))\n"
           "    (($+functions[_seamlab_$verb])) && _seamlab_$verb\n}\n_seamlab \"$@\"\n");
}

/* seamlab --help=man|bash|zsh|words; false: none of these. */
static bool print_special(const char *argument)
{
    cli_help help;
    if (strncmp(argument, "--help=", 7) != 0 || !cli_help_named(argument + 7, &help)) {
        return false;
    }
    switch (help) {
    case CLI_HELP_TEXT:
        print_usage(stdout);
        break;
    case CLI_HELP_MAN:
        print_man();
        break;
    case CLI_HELP_BASH:
        print_bash();
        break;
    case CLI_HELP_ZSH:
        print_zsh();
        break;
    case CLI_HELP_WORDS:
        print_names("\n");
        break;
    }
    return true;
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
    if (print_special(argv[1])) {
        return flushed(CLI_DONE);
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
