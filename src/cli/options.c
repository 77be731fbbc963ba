#include "cli/options.h"

#include "base/text.h"
#include "cli/cli.h"
#include "cli/options_help.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

int cli_usage(const char *verb, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    fprintf(stderr, "seamlab %s: ", verb);
    vfprintf(stderr, format, args);
    fprintf(stderr, "\n  try: seamlab %s --help\n", verb);
    va_end(args);
    return CLI_USAGE;
}

static int usage_error(const cli_verb *verb, const char *what, const char *value)
{
    return cli_usage(verb->name, "%s%s%s", what, value != NULL ? " " : "", value != NULL ? value : "");
}

/* Position of text among "a|b|c", -1 = not there. */
static int32_t choice_index(const char *choices, const char *text)
{
    const size_t length = strlen(text);
    int32_t index = 0;
    for (const char *p = choices;; index++) {
        const char *bar = strchr(p, '|');
        const size_t n = bar != NULL ? (size_t)(bar - p) : strlen(p);
        if (n == length && strncmp(p, text, n) == 0) {
            return index;
        }
        if (bar == NULL) {
            return -1;
        }
        p = bar + 1;
    }
}

static int set_number(const cli_verb *verb, const cli_option *o, const char *text)
{
    char what[160];
    const char *end = text + strlen(text);
    double value = 0.0;
    int64_t whole = 0;
    const char *after = o->kind == CLI_INT ? sl_parse_int(text, end, &whole) : sl_parse_double(text, end, &value);
    value = o->kind == CLI_INT ? (double)whole : value;
    if (after != end || after == text || !(value >= o->lo && value <= o->hi)) {
        snprintf(what, sizeof what, "--%s needs %s in [%g, %g], not", o->name,
                 o->kind == CLI_INT ? "a whole number" : "a number", o->lo, o->hi);
        return usage_error(verb, what, text);
    }
    if (o->kind == CLI_INT) {
        *(int32_t *)o->target = (int32_t)whole;
    } else {
        *(double *)o->target = value;
    }
    return -1;
}

/* A number of bytes, perhaps with a letter of K, M, G or T after it. */
static int set_size(const cli_verb *verb, const cli_option *o, const char *text)
{
    static const char letters[] = "KMGT";
    char what[160];
    const char *end = text + strlen(text);
    const char *letter = end > text ? strchr(letters, end[-1] & ~('a' ^ 'A')) : NULL;
    const bool scaled = letter != NULL && *letter != '\0';
    const double scale = scaled ? (double)((int64_t)1 << 10 * (letter - letters + 1)) : 1.0;
    const char *last = scaled ? end - 1 : end;
    double value = 0.0;
    const char *after = sl_parse_double(text, last, &value);
    if (after != last || after == text || !(value * scale >= o->lo && value * scale <= o->hi)) {
        snprintf(what, sizeof what, "--%s needs a size such as 800M or 2.5G, not", o->name);
        return usage_error(verb, what, text);
    }
    *(int64_t *)o->target = (int64_t)(value * scale);
    return -1;
}

static int add_item(const cli_verb *verb, const cli_option *o, const char *text)
{
    cli_list *list = o->target;
    if (list->count == CLI_MAX_ITEMS) {
        return usage_error(verb, "too often:", o->name);
    }
    list->item[list->count++] = text;
    return -1;
}

static int set_option(const cli_verb *verb, const cli_option *o, const char *text)
{
    char what[160];
    int32_t index;
    switch (o->kind) {
    case CLI_FLAG:
        *(bool *)o->target = true;
        return -1;
    case CLI_TEXT:
        *(const char **)o->target = text;
        return -1;
    case CLI_LIST:
        return add_item(verb, o, text);
    case CLI_INT:
    case CLI_REAL:
        return set_number(verb, o, text);
    case CLI_SIZE:
        return set_size(verb, o, text);
    case CLI_ON_OFF:
    case CLI_CHOICE:
        index = choice_index(o->kind == CLI_CHOICE ? o->choices : "off|on", text);
        if (index < 0) {
            snprintf(what, sizeof what, "--%s needs %s, not", o->name, o->kind == CLI_CHOICE ? o->choices : "on|off");
            return usage_error(verb, what, text);
        }
        if (o->kind == CLI_CHOICE) {
            *(int32_t *)o->target = index;
        } else {
            *(bool *)o->target = index == 1;
        }
        return -1;
    }
    return 1;
}

/* The option an argument names, NULL = none. *value = text after "=", if any. */
static const cli_option *find_option(const cli_option *options, int32_t count, const char *argument, const char **value)
{
    *value = NULL;
    for (int32_t k = 0; k < count; k++) {
        const size_t n = strlen(options[k].name);
        if (argument[1] == '-' && strncmp(argument + 2, options[k].name, n) == 0) {
            if (argument[2 + n] == '=') {
                *value = argument + 3 + n;
            }
            if (argument[2 + n] == '\0' || argument[2 + n] == '=') {
                return &options[k];
            }
        }
        if (argument[1] == options[k].letter && argument[1] != '-' && argument[2] == '\0') {
            return &options[k];
        }
    }
    return NULL;
}

static bool asks_help(const char *argument, cli_help *help)
{
    *help = CLI_HELP_TEXT;
    return strcmp(argument, "-h") == 0 || strcmp(argument, "--help") == 0 ||
           (strncmp(argument, "--help=", 7) == 0 && cli_help_named(argument + 7, help));
}

int cli_parse(const cli_verb *verb, const cli_option *options, int32_t count, int argc, char **argv, int first,
              const char **files, int32_t *file_count)
{
    bool only_files = false;
    cli_help help;
    *file_count = 0;
    for (int a = first; a < argc; a++) {
        const char *argument = argv[a], *value;
        if (!only_files && strcmp(argument, "--") == 0) {
            only_files = true;
            continue;
        }
        if (only_files || argument[0] != '-' || argument[1] == '\0') {
            if (*file_count == verb->max_files) {
                return usage_error(verb, "one file too many:", argument);
            }
            files[(*file_count)++] = argument;
            continue;
        }
        if (asks_help(argument, &help)) {
            cli_help_print(help, verb, options, count);
            return 0;
        }
        const cli_option *option = find_option(options, count, argument, &value);
        if (option == NULL) {
            return usage_error(verb, "unknown option", argument);
        }
        if (option->kind == CLI_FLAG && value != NULL) {
            return usage_error(verb, "takes no value:", argument);
        }
        if (option->kind != CLI_FLAG && value == NULL) {
            if (a + 1 == argc) {
                return usage_error(verb, "a value is missing after", argument);
            }
            value = argv[++a];
        }
        const int code = set_option(verb, option, value);
        if (code >= 0) {
            return code;
        }
    }
    if (*file_count < verb->min_files) {
        return usage_error(verb, "a file name is missing", NULL);
    }
    return -1;
}
