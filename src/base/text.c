#include "base/text.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

__extension__ typedef unsigned __int128 uint128;

/* ---- decimal -> binary. Three exact ways, from the fast to the general:
 *   1. mantissa and power of ten are both doubles: one rounded operation (Clinger 1990, "How to read floating point
 *      numbers accurately");
 *   2. at most 19 digits and 10^|e|, |e| <= 27: a 128-bit product or quotient, its remainder kept as a sticky bit;
 *   3. otherwise long division of big integers, 64 quotient bits and a sticky bit. */

enum {
    MAX_WORD_DIGITS = 19, /* 10^19 - 1 fits 64 bits */
    MAX_EXACT_POWER = 22, /* 10^22 is a double */
    MAX_WORD_POWER = 27,  /* 5^27 < 2^63 */
    MAX_DIGITS = 768,     /* a decision between two doubles never needs more; the rest is one sticky digit */
    MAX_DECIMAL = 310,    /* 0.d * 10^p is infinite for p > 310, zero for p < -325 */
    MIN_DECIMAL = -325,
    EXPONENT_CLAMP = 100000, /* larger exponents read as this: infinite or zero either way */
    BIG_WORDS = 128          /* 4096 bits: 10^(768 + 325) has 3631, and 64 more for the quotient */
};

static const double exact_power[MAX_EXACT_POWER + 1] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                        1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                        1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

/* Number of significant bits; 0 for 0. */
static int bit_length(uint64_t x)
{
    int n = 0;
    for (int step = 32; step > 0; step /= 2) {
        if (x >> step != 0) {
            x >>= step;
            n += step;
        }
    }
    return n + (x != 0);
}

/* The double nearest to (q + s) * 2^e, ties to even, where q has its top bit set and 0 < s < 1 if sticky, else s = 0.
 */
static double round_word(uint64_t q, int e, bool sticky)
{
    const int top = e + 63; /* exponent of the leading bit */
    const int drop = top >= -1022 ? 11 : 11 + (-1022 - top);
    if (drop > 64) {
        return 0.0;
    }
    const uint64_t kept = drop < 64 ? q >> drop : 0;
    const uint64_t rest = drop < 64 ? q << (64 - drop) : q; /* what was dropped, left aligned */
    const uint64_t half = UINT64_C(1) << 63;
    const bool up = rest > half || (rest == half && (sticky || (kept & 1) != 0));
    return ldexp((double)(kept + up), e + drop); /* at most 54 bits, the 54th only as a power of two: exact */
}

/* (hi, lo, sticky) * 2^e rounded, the 128-bit number not 0. */
static double round_wide(uint128 x, int e, bool sticky)
{
    const uint64_t hi = (uint64_t)(x >> 64);
    const int shift = hi != 0 ? bit_length(hi) : bit_length((uint64_t)x) - 64; /* right shift that leaves 64 bits */
    if (shift <= 0) {
        return round_word((uint64_t)x << -shift, e + shift, sticky);
    }
    const bool lost = (x & (((uint128)1 << shift) - 1)) != 0;
    return round_word((uint64_t)(x >> shift), e + shift, sticky || lost);
}

/* w * 10^e for w != 0 of at most 19 digits and |e| <= 27. */
static double scale_word(uint64_t w, int e)
{
    uint64_t five = 1;
    for (int k = e < 0 ? -e : e; k > 0; k--) {
        five *= 5;
    }
    if (e >= 0) {
        return round_wide((uint128)w * five, e, false);
    }
    const int lead = 64 - bit_length(w);
    const uint128 scaled = (uint128)(w << lead) << 64;
    return round_wide(scaled / five, e - lead - 64, scaled % five != 0);
}

typedef struct big {
    uint32_t word[BIG_WORDS]; /* little end first */
    int count;                /* words used, none of them leading zeros */
} big;

static void big_mul_add(big *x, uint32_t factor, uint32_t term)
{
    uint64_t carry = term;
    for (int k = 0; k < x->count; k++) {
        carry += (uint64_t)x->word[k] * factor;
        x->word[k] = (uint32_t)carry;
        carry >>= 32;
    }
    if (carry != 0) {
        SL_ASSERT(x->count < BIG_WORDS);
        x->word[x->count++] = (uint32_t)carry;
    }
}

static void big_mul_power10(big *x, int64_t power)
{
    for (; power >= 9; power -= 9) {
        big_mul_add(x, 1000000000u, 0);
    }
    for (; power > 0; power--) {
        big_mul_add(x, 10, 0);
    }
}

static int big_bits(const big *x)
{
    return x->count > 0 ? 32 * (x->count - 1) + bit_length(x->word[x->count - 1]) : 0;
}

static void big_shift_left(big *x, int bits)
{
    for (; bits >= 31; bits -= 31) {
        big_mul_add(x, 1u << 31, 0);
    }
    big_mul_add(x, 1u << bits, 0);
}

static int big_compare(const big *a, const big *b)
{
    if (a->count != b->count) {
        return a->count < b->count ? -1 : 1;
    }
    for (int k = a->count - 1; k >= 0; k--) {
        if (a->word[k] != b->word[k]) {
            return a->word[k] < b->word[k] ? -1 : 1;
        }
    }
    return 0;
}

/* a -= b, for a >= b. */
static void big_subtract(big *a, const big *b)
{
    uint64_t borrow = 0;
    for (int k = 0; k < a->count; k++) {
        const uint64_t taken = (k < b->count ? b->word[k] : 0) + borrow;
        borrow = a->word[k] < taken;
        a->word[k] = (uint32_t)(a->word[k] - taken);
    }
    while (a->count > 0 && a->word[a->count - 1] == 0) {
        a->count--;
    }
}

/* num / den for positive big integers, rounded: long division one bit at a time until 64 quotient bits stand. */
static double divide_big(big *num, big *den)
{
    int e = big_bits(num) - big_bits(den); /* 2^(e-1) < num/den < 2^(e+1) */
    if (e > 0) {
        big_shift_left(den, e);
    } else if (e < 0) {
        big_shift_left(num, -e);
    }
    if (big_compare(num, den) < 0) {
        big_mul_add(num, 2, 0);
        e--;
    }
    uint64_t q = 0; /* num/den in [1, 2) now */
    for (int k = 0; k < 64; k++) {
        q *= 2;
        if (big_compare(num, den) >= 0) {
            big_subtract(num, den);
            q++;
        }
        big_mul_add(num, 2, 0);
    }
    return round_word(q, e - 63, num->count > 0);
}

/* Where the digits of a number stand in its text. */
typedef struct decimal {
    const char *digit, *end; /* digits, at most one point among them, leading zeros stripped */
    int64_t digits;          /* how many, without the point */
    int64_t exponent;        /* value = digits * 10^exponent */
} decimal;

static double parse_long(const decimal *d)
{
    const int64_t point = d->digits + d->exponent; /* value = 0.digits * 10^point */
    if (point > MAX_DECIMAL || point < MIN_DECIMAL) {
        return point > 0 ? (double)INFINITY : 0.0;
    }
    big num = {.count = 0}, den = {.word = {1}, .count = 1};
    int64_t taken = 0;
    bool sticky = false;
    for (const char *p = d->digit; p < d->end; p++) {
        if (*p == '.') {
            continue;
        }
        if (taken < MAX_DIGITS) {
            big_mul_add(&num, 10, (uint32_t)(*p - '0'));
            taken++;
        } else {
            sticky = sticky || *p != '0';
        }
    }
    if (sticky) { /* stands for all the digits that were left out: it only has to be more than nothing */
        big_mul_add(&num, 10, 1);
        taken++;
    }
    const int64_t exponent = point - taken;
    big_mul_power10(exponent >= 0 ? &num : &den, exponent >= 0 ? exponent : -exponent);
    return divide_big(&num, &den);
}

/* The value of `word`, the first min(digits, 19) digits, with d for the rest of the story. */
static double decimal_value(uint64_t word, const decimal *d)
{
    if (word == 0) {
        return 0.0; /* leading zeros are stripped, so the first digit would have been one of word's */
    }
    if (d->digits <= MAX_WORD_DIGITS) {
        const int64_t e = d->exponent;
        if (word <= UINT64_C(1) << 53 && e >= -MAX_EXACT_POWER && e <= MAX_EXACT_POWER) {
            return e < 0 ? (double)word / exact_power[-e] : (double)word * exact_power[e];
        }
        if (e >= -MAX_WORD_POWER && e <= MAX_WORD_POWER) {
            return scale_word(word, (int)e);
        }
    }
    return parse_long(d);
}

static bool is_digit(char c)
{
    return (unsigned)(c - '0') < 10u;
}

/* True when [p, end) starts with the lower-case word, in any case. */
static bool starts_with(const char *p, const char *end, const char *word)
{
    const size_t n = strlen(word);
    if ((size_t)(end - p) < n) {
        return false;
    }
    for (size_t k = 0; k < n; k++) {
        if ((p[k] | 0x20) != word[k]) {
            return false;
        }
    }
    return true;
}

/* "nan", "inf" or "infinity" at p; begin when it is none of them. */
static const char *parse_special(const char *begin, const char *p, const char *end, bool negative, double *value)
{
    if (starts_with(p, end, "nan")) {
        *value = (double)NAN;
        return p + 3;
    }
    if (starts_with(p, end, "inf")) {
        *value = negative ? -(double)INFINITY : (double)INFINITY;
        return p + (starts_with(p, end, "infinity") ? 8 : 3);
    }
    return begin;
}

/* Reads "e-12" at p into *exponent; returns p when no exponent stands there. */
static const char *parse_exponent(const char *p, const char *end, int64_t *exponent)
{
    const char *q = p;
    *exponent = 0;
    if (q == end || (*q | 0x20) != 'e') {
        return p;
    }
    q++;
    const bool negative = q < end && *q == '-';
    q += q < end && (*q == '-' || *q == '+');
    if (q == end || !is_digit(*q)) {
        return p;
    }
    int64_t e = 0;
    for (; q < end && is_digit(*q); q++) {
        e = e < EXPONENT_CLAMP ? 10 * e + (*q - '0') : e;
    }
    *exponent = negative ? -e : e;
    return q;
}

const char *sl_parse_double(const char *begin, const char *end, double *value)
{
    const char *p = begin;
    const bool negative = p < end && *p == '-';
    p += p < end && (*p == '-' || *p == '+');
    const char *first = p;
    while (p < end && *p == '0') {
        p++;
    }
    decimal d = {.digit = p};
    uint64_t word = 0;
    for (; p < end && is_digit(*p); p++, d.digits++) {
        word = d.digits < MAX_WORD_DIGITS ? 10 * word + (uint64_t)(*p - '0') : word;
    }
    bool any = p > first;
    if (p < end && *p == '.') {
        const char *fraction = ++p;
        if (d.digits == 0) { /* zeros after the point are leading zeros still */
            while (p < end && *p == '0') {
                p++;
            }
            d.digit = p;
        }
        for (; p < end && is_digit(*p); p++, d.digits++) {
            word = d.digits < MAX_WORD_DIGITS ? 10 * word + (uint64_t)(*p - '0') : word;
        }
        any = any || p > fraction;
        d.exponent = fraction - p;
    }
    if (!any) {
        return parse_special(begin, first, end, negative, value);
    }
    d.end = p;
    int64_t exponent;
    p = parse_exponent(p, end, &exponent);
    d.exponent += exponent;
    const double magnitude = decimal_value(word, &d);
    *value = negative ? -magnitude : magnitude;
    return p;
}

const char *sl_parse_int(const char *begin, const char *end, int64_t *value)
{
    const char *p = begin;
    const bool negative = p < end && *p == '-';
    p += p < end && (*p == '-' || *p == '+');
    if (p == end || !is_digit(*p)) {
        return begin;
    }
    int64_t n = 0; /* counted downwards, so that INT64_MIN fits */
    for (; p < end && is_digit(*p); p++) {
        const int digit = *p - '0';
        if (n < (INT64_MIN + digit) / 10) {
            return begin;
        }
        n = 10 * n - digit;
    }
    if (!negative && n == INT64_MIN) {
        return begin;
    }
    *value = negative ? n : -n;
    return p;
}

/* ---- binary -> decimal */

static const double max_plain = 1e15; /* below, and not under min_plain, numbers are written without an exponent */
static const double min_plain = 1e-4;
static const int max_plain_places = 15;

/* Writes value = m / 10^places with m < 10^15 when such a form exists; at most one does, so it is the shortest.
 * Returns its length or 0. */
static int32_t format_plain(double value, char text[SL_DOUBLE_TEXT])
{
    const double a = fabs(value);
    if (!(a >= min_plain && a < max_plain)) {
        return 0;
    }
    int places = 0;
    double m = rint(a);
    while (m / exact_power[places] != a) { /* both are exact doubles: the quotient is what the text reads back as */
        if (++places > max_plain_places || a * exact_power[places] >= max_plain) {
            return 0;
        }
        m = rint(a * exact_power[places]);
    }
    char *p = text + SL_DOUBLE_TEXT;
    uint64_t left = (uint64_t)m;
    for (int k = 0; left > 0 || k <= places; k++) {
        if (k == places && places > 0) {
            *--p = '.';
        }
        *--p = (char)('0' + left % 10);
        left /= 10;
    }
    if (value < 0) {
        *--p = '-';
    }
    const int32_t length = (int32_t)(text + SL_DOUBLE_TEXT - p);
    memmove(text, p, (size_t)length);
    text[length] = '\0';
    return length;
}

/* Replaces whatever the locale puts between the digits (one or more bytes) by a point. */
static int32_t fix_point(char *text)
{
    char *out = text;
    bool point = false;
    for (const char *p = text; *p != '\0'; p++) {
        if (is_digit(*p) || *p == '-' || *p == '+' || *p == 'e') {
            *out++ = *p;
            continue;
        }
        if (!point) {
            *out++ = '.';
            point = true;
        }
    }
    *out = '\0';
    return (int32_t)(out - text);
}

int32_t sl_format_double(double value, char text[SL_DOUBLE_TEXT])
{
    if (!isfinite(value)) {
        const char *name = isnan(value) ? "nan" : value > 0 ? "inf" : "-inf";
        memcpy(text, name, strlen(name) + 1);
        return (int32_t)strlen(name);
    }
    int32_t length = format_plain(value, text);
    /* a normal double keeps any 15 digits, a subnormal one perhaps a single one */
    for (int precision = fabs(value) < DBL_MIN ? 1 : 15; length == 0 && precision <= 17; precision++) {
        double back = 0.0;
        snprintf(text, SL_DOUBLE_TEXT, "%.*g", precision, value);
        const int32_t n = fix_point(text);
        sl_parse_double(text, text + n, &back);
        length = back == value ? n : 0;
    }
    return length;
}

const char *sl_plural(int64_t count)
{
    return count == 1 ? "" : "s";
}
