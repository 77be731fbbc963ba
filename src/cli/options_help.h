/* What the table of a verb's options tells: help in the terminal, a man page, completion for shells.
 * Layer: cli. */
#ifndef SL_CLI_OPTIONS_HELP_H
#define SL_CLI_OPTIONS_HELP_H

#include "cli/options.h"

typedef enum cli_help {
    CLI_HELP_TEXT, /* --help */
    CLI_HELP_MAN,  /* --help=man: a page in man(7) macros */
    CLI_HELP_BASH, /* --help=bash: the verb's arm of the completion function */
    CLI_HELP_ZSH,  /* --help=zsh: the verb's completion function */
    CLI_HELP_WORDS /* --help=words: an option a line, "name letter kind value" (a number: its least), for tests */
} cli_help;

/* "", "man", "bash", "zsh", "words"; false: none of these. */
bool cli_help_named(const char *name, cli_help *out);

/* On standard output. */
void cli_help_print(cli_help help, const cli_verb *verb, const cli_option *options, int32_t count);

/* The parts of a page that the program's own page shares with those of its verbs. */
void cli_man_title(const char *name, const char *summary);
void cli_man_text(const char *text); /* escaped for troff, a line each */
void cli_man_exit_codes(void);

#endif
