#define _DEFAULT_SOURCE
#include "base/random.h"

#include <sys/random.h>

sl_status sl_random_bytes(uint8_t *bytes, int32_t count)
{
    return getrandom(bytes, (size_t)count, 0) == (ssize_t)count ? SL_OK : SL_IO;
}
