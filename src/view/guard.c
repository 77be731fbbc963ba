#include "view/guard.h"

#include "base/random.h"

#include <stdio.h>
#include <string.h>

sl_status sl_guard_token(char token[SL_GUARD_TOKEN])
{
    uint8_t bits[(SL_GUARD_TOKEN - 1) / 2];
    const sl_status status = sl_random_bytes(bits, (int32_t)sizeof bits);
    if (status != SL_OK) {
        return status;
    }
    for (size_t k = 0; k < sizeof bits; k++) {
        snprintf(token + 2 * k, 3, "%02x", bits[k]);
    }
    return SL_OK;
}

bool sl_guard_same(const char *a, const char *b)
{
    const size_t n = strlen(a);
    unsigned different = n != strlen(b);
    for (size_t k = 0; k < n && different == 0; k += n) { /* lengths are no secret */
        for (size_t i = 0; i < n; i++) {
            different |= (unsigned)(a[i] ^ b[i]);
        }
    }
    return different == 0;
}

static bool matches(const char *text, const char *prefix, int32_t port)
{
    char wanted[64];
    snprintf(wanted, sizeof wanted, "%s:%d", prefix, (int)port);
    return strcmp(text, wanted) == 0;
}

bool sl_guard_host(const char *host, int32_t port)
{
    return host != NULL && (matches(host, "127.0.0.1", port) || matches(host, "localhost", port));
}

bool sl_guard_origin(const char *origin, int32_t port)
{
    return origin != NULL && (matches(origin, "http://127.0.0.1", port) || matches(origin, "http://localhost", port));
}

sl_guard_bucket sl_guard_bucket_full(double rate, double burst, double now)
{
    return (sl_guard_bucket){burst, rate, burst, now};
}

bool sl_guard_take(sl_guard_bucket *bucket, double now)
{
    const double passed = now > bucket->last ? now - bucket->last : 0.0;
    bucket->level += passed * bucket->rate;
    bucket->level = bucket->level > bucket->burst ? bucket->burst : bucket->level;
    bucket->last = now;
    if (bucket->level < 1.0) {
        return false;
    }
    bucket->level -= 1.0;
    return true;
}
