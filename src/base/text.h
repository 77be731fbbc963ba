/* Numbers as text, whatever the locale.
 * Layer: base. */
#ifndef SL_BASE_TEXT_H
#define SL_BASE_TEXT_H

#include "base/status.h"

/* Longest text sl_format_double writes, with its terminator. */
#define SL_DOUBLE_TEXT 32

/* Shortest decimal that reads back as exactly this double ("0.1", "1e-30", "nan", "inf"); at a power of two
 * perhaps one digit more. Locale-free. Returns its length. */
int32_t sl_format_double(double value, char text[SL_DOUBLE_TEXT]);

/* Parses a decimal number at [begin, end); correctly rounded. Returns the first unread character, or begin when there
 * is no number. Accepts an optional sign, digits, a point, an exponent; nan and inf (any case) read as such.
 * Locale-free. */
const char *sl_parse_double(const char *begin, const char *end, double *value);

/* What makes a word of a message plural: "s", or "" for one: "%d chart%s". */
const char *sl_plural(int64_t count);

/* Parses an optional sign and digits. Returns begin when there is no number or it does not fit. */
const char *sl_parse_int(const char *begin, const char *end, int64_t *value);

#endif
