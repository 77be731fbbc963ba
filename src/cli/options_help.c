#include "cli/options_help.h"

#include <stdio.h>
#include <string.h>

bool cli_help_named(const char *name, cli_help *out)
{
    static const char *const names[] = {"", "man", "bash", "zsh", "words"};
    for (size_t k = 0; k < SL_COUNTOF(names); k++) {
        if (strcmp(name, names[k]) == 0) {
            *out = (cli_help)k;
            return true;
        }
    }
    return false;
}

/* What the help calls an option's value; "" for a flag. */
static const char *value_name(const cli_option *o)
{
    return o->kind == CLI_CHOICE   ? o->choices
           : o->kind == CLI_ON_OFF ? "on|off"
           : o->argument != NULL   ? o->argument
                                   : "";
}

static void print_text(const cli_verb *verb, const cli_option *options, int32_t count)
{
    printf("%s\n\nExamples:\n%s\nUsage: %s\n", verb->summary, verb->examples, verb->usage);
    if (count > 0) {
        printf("\nOptions:\n");
    }
    for (int32_t k = 0; k < count; k++) {
        const cli_option *o = &options[k];
        const char *value = value_name(o);
        char head[128];
        const int n = snprintf(head, sizeof head, "  %s%s%s",
                               o->letter != 0 ? (char[]){'-', o->letter, ',', ' ', 0} : "", "--", o->name);
        snprintf(head + n, sizeof head - (size_t)n, "%s%s", value[0] != '\0' ? " " : "", value);
        printf(strlen(head) < 30 ? "%-30s %s\n" : "%s\n                               %s\n", head, o->help);
    }
    printf("  %-28s %s\n", "-h, --help[=man]", "this text, or the man page");
}

/* One line of text for troff: no escape, no macro by accident, dashes that can be copied. */
static void man_line(const char *text, size_t length)
{
    if (length > 0 && (text[0] == '.' || text[0] == '\'')) {
        fputs("\\&", stdout);
    }
    for (size_t k = 0; k < length; k++) {
        if (text[k] == '\\') {
            fputs("\\e", stdout);
        } else if (text[k] == '-') {
            fputs("\\-", stdout);
        } else {
            putchar(text[k]);
        }
    }
}

void cli_man_text(const char *text)
{
    while (*text != '\0') {
        const size_t length = strcspn(text, "\n");
        man_line(text, length);
        putchar('\n');
        text += length + (text[length] == '\n');
    }
}

void cli_man_title(const char *name, const char *summary)
{
    char upper[64];
    size_t k = 0;
    for (; name[k] != '\0' && k + 1 < sizeof upper; k++) {
        upper[k] = name[k] >= 'a' && name[k] <= 'z' ? (char)(name[k] - 'a' + 'A') : name[k];
    }
    upper[k] = '\0';
    printf(".TH \"%s\" 1 \"\" \"seamlab %s\" \"seamlab\"\n.SH NAME\n", upper, SEAMLAB_VERSION);
    man_line(name, strlen(name));
    fputs(" \\- ", stdout);
    cli_man_text(summary);
}

void cli_man_exit_codes(void)
{
    static const char *const code[][2] = {
        {"0", "done, with warnings perhaps"},
        {"1", "an internal or system error"},
        {"2", "wrong usage"},
        {"3", "bad input: the message names file and line"},
        {"4", "infeasible, not converged, or a warning under \\-\\-strict"},
        {"5", "the program's own check of its result failed; nothing was written"},
        {"6", "a limit of memory was reached"},
        {"130", "interrupted"},
    };
    printf(".SH EXIT STATUS\n");
    for (size_t k = 0; k < SL_COUNTOF(code); k++) {
        printf(".TP 6\n%s\n%s\n", code[k][0], code[k][1]);
    }
}

static void man_option(const cli_option *o)
{
    const char *value = value_name(o);
    const bool set = o->kind == CLI_CHOICE || o->kind == CLI_ON_OFF;
    printf(".TP\n");
    if (o->letter != 0) {
        printf("\\fB\\-%c\\fR, ", o->letter);
    }
    fputs("\\fB", stdout);
    man_line("--", 2);
    man_line(o->name, strlen(o->name));
    fputs("\\fR", stdout);
    if (value[0] != '\0') {
        fputs(set ? " \\fB" : " \\fI", stdout);
        man_line(value, strlen(value));
        fputs("\\fR", stdout);
    }
    putchar('\n');
    cli_man_text(o->help);
}

static void print_man(const cli_verb *verb, const cli_option *options, int32_t count)
{
    char name[64];
    snprintf(name, sizeof name, "seamlab-%s", verb->name);
    cli_man_title(name, verb->summary);
    printf(".SH SYNOPSIS\n.nf\n");
    cli_man_text(verb->usage);
    printf(".fi\n.SH EXAMPLES\n.nf\n");
    cli_man_text(verb->examples);
    printf(".fi\n.SH OPTIONS\n");
    for (int32_t k = 0; k < count; k++) {
        man_option(&options[k]);
    }
    printf(".TP\n\\fB\\-h\\fR, \\fB\\-\\-help\\fR\nthe same on standard output\n");
    cli_man_exit_codes();
    printf(".SH SEE ALSO\n.BR seamlab (1)\n");
}

/* "a|b" as "a b". */
static void print_choices(const char *choices)
{
    for (const char *p = choices; *p != '\0'; p++) {
        putchar(*p == '|' ? ' ' : *p);
    }
}

static bool is_number(const cli_option *o)
{
    return o->kind == CLI_INT || o->kind == CLI_REAL || o->kind == CLI_SIZE;
}

static void print_bash(const cli_verb *verb, const cli_option *options, int32_t count)
{
    printf("    %s)\n        case $previous in\n", verb->name);
    for (int32_t k = 0; k < count; k++) {
        const cli_option *o = &options[k];
        if (o->kind == CLI_FLAG) {
            continue;
        }
        printf("        ");
        if (o->letter != 0) {
            printf("-%c | ", o->letter);
        }
        printf("--%s) ", o->name);
        if (o->kind == CLI_CHOICE || o->kind == CLI_ON_OFF) {
            fputs("words='", stdout);
            print_choices(value_name(o));
            fputs("'", stdout);
        } else {
            fputs(is_number(o) ? "return" : "files=yes", stdout);
        }
        printf(" ;;\n");
    }
    printf("        *) words='");
    for (int32_t k = 0; k < count; k++) {
        printf("--%s ", options[k].name);
    }
    printf("--help' options=yes ;;\n        esac\n        ;;\n");
}

/* Text inside a single-quoted specification of _arguments. */
static void print_zsh_text(const char *text)
{
    for (const char *p = text; *p != '\0'; p++) {
        if (*p == '\'') {
            fputs("'\\''", stdout);
        } else if (*p == '[' || *p == ']' || *p == ':' || *p == '\\') {
            printf("\\%c", *p);
        } else {
            putchar(*p);
        }
    }
}

static void print_zsh(const cli_verb *verb, const cli_option *options, int32_t count)
{
    printf("_seamlab_%s() {\n    _arguments \\\n", verb->name);
    for (int32_t k = 0; k < count; k++) {
        const cli_option *o = &options[k];
        for (int pass = o->letter != 0 ? 0 : 1; pass < 2; pass++) {
            printf("        '%s", o->kind == CLI_LIST ? "*" : "");
            if (pass == 0) {
                printf("-%c[", o->letter);
            } else {
                printf("--%s[", o->name);
            }
            print_zsh_text(o->help);
            putchar(']');
            if (o->kind == CLI_CHOICE || o->kind == CLI_ON_OFF) {
                fputs(":value:(", stdout);
                print_choices(value_name(o));
                putchar(')');
            } else if (o->kind != CLI_FLAG) {
                putchar(':');
                print_zsh_text(value_name(o)[0] != '\0' ? value_name(o) : "value");
                fputs(is_number(o) ? ": " : ":_files", stdout);
            }
            printf("' \\\n");
        }
    }
    printf("        '--help[explain]' \\\n        '*:file:_files'\n}\n");
}

static void print_words(const cli_option *options, int32_t count)
{
    static const char *const kind[] = {"flag", "on-off", "int", "real", "size", "text", "list", "choice"};
    for (int32_t k = 0; k < count; k++) {
        const cli_option *o = &options[k];
        printf("%s %c %s ", o->name, o->letter != 0 ? o->letter : '-', kind[o->kind]);
        if (is_number(o)) {
            printf("%.17g\n", o->lo);
        } else {
            printf("%s\n", value_name(o));
        }
    }
}

void cli_help_print(cli_help help, const cli_verb *verb, const cli_option *options, int32_t count)
{
    switch (help) {
    case CLI_HELP_TEXT:
        print_text(verb, options, count);
        return;
    case CLI_HELP_MAN:
        print_man(verb, options, count);
        return;
    case CLI_HELP_BASH:
        print_bash(verb, options, count);
        return;
    case CLI_HELP_ZSH:
        print_zsh(verb, options, count);
        return;
    case CLI_HELP_WORDS:
        print_words(options, count);
        return;
    }
}
