/* Command-line options from a table, and the help text from the same table.
 * Layer: cli. */
#ifndef SL_CLI_OPTIONS_H
#define SL_CLI_OPTIONS_H

#include "base/status.h"

typedef enum cli_kind {
    CLI_FLAG,   /* bool */
    CLI_ON_OFF, /* bool, from "on" or "off" */
    CLI_INT,    /* int32_t in [lo, hi] */
    CLI_REAL,   /* double in [lo, hi] */
    CLI_SIZE,   /* int64_t bytes, from "800M" or "2.5G" (powers of 1024), at least lo and at most hi */
    CLI_TEXT,   /* const char *, borrowed from argv */
    CLI_LIST,   /* cli_list: an option that may be given again and again */
    CLI_CHOICE  /* int32_t: position in choices */
} cli_kind;

enum { CLI_MAX_ITEMS = 256 };

/* The values of an option in the order given; borrowed from argv. */
typedef struct cli_list {
    int32_t count;
    const char *item[CLI_MAX_ITEMS];
} cli_list;

typedef struct cli_option {
    const char *name; /* without the dashes */
    char letter;      /* 0 = none */
    cli_kind kind;
    void *target;         /* holds the default before parsing */
    double lo, hi;        /* range of a number */
    const char *choices;  /* "longest|length-lambda|lookahead" */
    const char *argument; /* what the help calls the argument; NULL for flags and choices */
    const char *help;
} cli_option;

/* What a verb takes. */
typedef struct cli_verb {
    const char *name;
    const char *usage;    /* "seamlab unwrap IN -o OUT [options]" */
    const char *summary;  /* one line */
    const char *examples; /* lines, each indented by two blanks */
    int32_t min_files, max_files;
} cli_verb;

enum { CLI_MAX_FILES = 64 };

/* Says on stderr what is wrong with a verb's options and where its help is. Returns the exit code, CLI_USAGE. */
int cli_usage(const char *verb, const char *format, ...) SL_PRINTF(2, 3);

/* Fills the targets from argv[first ..]. files: room for verb->max_files borrowed names. Returns -1 to go on, otherwise
 * the exit code to leave with (0 after --help and --help=man|bash|zsh|words, 2 after a usage error, which is explained
 * on stderr). */
int cli_parse(const cli_verb *verb, const cli_option *options, int32_t count, int argc, char **argv, int first,
              const char **files, int32_t *file_count);

#endif
