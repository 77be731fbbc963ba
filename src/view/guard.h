/* Who may talk to the page's server: only the page it served itself.
 * Layer: view. */
#ifndef SL_VIEW_GUARD_H
#define SL_VIEW_GUARD_H

#include "base/status.h"

enum { SL_GUARD_TOKEN = 33 }; /* 128 random bits in hexadecimal, terminated */

/* Random bits of the system. SL_IO: it has none. */
SL_NODISCARD sl_status sl_guard_token(char token[SL_GUARD_TOKEN]);

/* Equal, in time that does not depend on where they differ. */
bool sl_guard_same(const char *a, const char *b);

/* Is this Host header ("127.0.0.1:port" or "localhost:port") ours? A page elsewhere whose name was made to point here
 * (DNS rebinding) sends another. */
bool sl_guard_host(const char *host, int32_t port);

/* Is this Origin header ours? NULL (no browser sends none with a WebSocket) is not. */
bool sl_guard_origin(const char *origin, int32_t port);

/* A bucket that fills with `rate` a second up to `burst`. */
typedef struct sl_guard_bucket {
    double level, rate, burst, last; /* last: seconds on any monotonic clock */
} sl_guard_bucket;

sl_guard_bucket sl_guard_bucket_full(double rate, double burst, double now);

/* Takes one out; false: it is empty. */
bool sl_guard_take(sl_guard_bucket *bucket, double now);

#endif
