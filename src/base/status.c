#include "base/status.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>

const char *sl_status_name(sl_status status)
{
    static const char *const names[] = {
        [SL_OK] = "ok",
        [SL_OUT_OF_MEMORY] = "out of memory",
        [SL_BAD_INPUT] = "bad input",
        [SL_IO] = "input/output error",
        [SL_UNSUPPORTED] = "unsupported",
        [SL_NOT_POSITIVE_DEFINITE] = "not positive definite",
        [SL_SINGULAR] = "singular",
        [SL_INFEASIBLE] = "infeasible",
        [SL_CANCELLED] = "cancelled",
        [SL_LIMIT] = "limit reached",
        [SL_CHECK_FAILED] = "own check failed",
        [SL_INTERNAL] = "internal error",
    };
    const size_t k = (size_t)status;
    return k < SL_COUNTOF(names) ? names[k] : "unknown status";
}

sl_diag sl_diag_none(void)
{
    return (sl_diag){.byte = -1, .element = -1};
}

void sl_diag_reason(sl_diag *diag, const char *format, ...)
{
    if (diag == NULL) {
        return;
    }
    va_list args;
    va_start(args, format);
    vsnprintf(diag->reason, sizeof diag->reason, format, args);
    va_end(args);
}

void sl_diag_hint(sl_diag *diag, const char *format, ...)
{
    if (diag == NULL) {
        return;
    }
    va_list args;
    va_start(args, format);
    vsnprintf(diag->hint, sizeof diag->hint, format, args);
    va_end(args);
}

/* Appends by printf rules at *used, never past size. */
static void append(char *text, size_t size, size_t *used, const char *format, ...) SL_PRINTF(4, 5);

static void append(char *text, size_t size, size_t *used, const char *format, ...)
{
    if (*used >= size) {
        return;
    }
    va_list args;
    va_start(args, format);
    const int n = vsnprintf(text + *used, size - *used, format, args);
    va_end(args);
    *used += n > 0 ? (size_t)n : 0;
}

void sl_diag_format(const sl_diag *diag, char *text, size_t size)
{
    size_t used = 0;
    if (size == 0) {
        return;
    }
    text[0] = '\0';
    if (diag->file[0] != '\0') {
        append(text, size, &used, "%s:", diag->file);
        if (diag->line > 0) {
            append(text, size, &used, "%" PRId64 ":", diag->line);
        } else if (diag->byte >= 0) {
            append(text, size, &used, " byte %" PRId64 ":", diag->byte);
        }
        append(text, size, &used, " ");
    }
    append(text, size, &used, "%s", diag->reason);
    if (diag->element >= 0) {
        append(text, size, &used, " (element %" PRId64 ")", diag->element);
    }
    if (diag->hint[0] != '\0') {
        append(text, size, &used, "; %s", diag->hint);
    }
}
