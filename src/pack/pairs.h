/* Pairs of charts that overlap, or did: as few numbers as there are such pairs, however many charts.
 * Layer: pack. */
#ifndef SL_PACK_PAIRS_H
#define SL_PACK_PAIRS_H

#include "base/status.h"

typedef struct sl_pack_pair {
    int32_t chart[2]; /* the smaller number first */
    int32_t weight;
    int32_t overlap; /* cells */
} sl_pack_pair;

typedef struct sl_pack_pairs {
    int32_t count;
    sl_pack_pair *pair; /* count, in the order in which they were first asked for */
    int64_t capacity;
    int32_t *slot; /* slots: 1 + number of a pair, 0 = none; open addressing */
    int64_t slots; /* a power of two, at least twice the count */
} sl_pack_pairs;

/* Empty. SL_OUT_OF_MEMORY. Freed by sl_pack_pairs_clear, also after failure. */
SL_NODISCARD sl_status sl_pack_pairs_init(sl_pack_pairs *out);
void sl_pack_pairs_clear(sl_pack_pairs *pairs);

/* There are no pairs any more. */
void sl_pack_pairs_wipe(sl_pack_pairs *pairs);

/* The pair of two different charts, whatever their order; -1 = none. Amortised O(1). */
int32_t sl_pack_pairs_find(const sl_pack_pairs *pairs, int32_t a, int32_t b);

/* The same; where there is none it becomes one, of that weight and no overlap. SL_OUT_OF_MEMORY: nothing changed. */
SL_NODISCARD sl_status sl_pack_pairs_get(sl_pack_pairs *pairs, int32_t a, int32_t b, int32_t weight, int32_t *out);

#endif
