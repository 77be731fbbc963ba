/* Random bits that nobody can guess: for secrets, never for results.
 * Layer: base. */
#ifndef SL_BASE_RANDOM_H
#define SL_BASE_RANDOM_H

#include "base/status.h"

/* Fills `bytes` with bits of the system's generator. count: at most 256. SL_IO: it has none. */
SL_NODISCARD sl_status sl_random_bytes(uint8_t *bytes, int32_t count);

#endif
