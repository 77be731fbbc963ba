#include "pack/pairs.h"

#include "base/memory.h"

#include <string.h>

enum { FIRST_SLOTS = 256 };

sl_status sl_pack_pairs_init(sl_pack_pairs *out)
{
    *out = (sl_pack_pairs){.slots = FIRST_SLOTS, .slot = sl_calloc(FIRST_SLOTS, sizeof *out->slot)};
    return out->slot != NULL ? SL_OK : SL_OUT_OF_MEMORY;
}

void sl_pack_pairs_clear(sl_pack_pairs *pairs)
{
    sl_free(pairs->pair);
    sl_free(pairs->slot);
    *pairs = (sl_pack_pairs){0};
}

void sl_pack_pairs_wipe(sl_pack_pairs *pairs)
{
    pairs->count = 0;
    memset(pairs->slot, 0, (size_t)pairs->slots * sizeof *pairs->slot);
}

/* Where the pair (a < b) is among the slots, or the empty one where it belongs. */
static int64_t slot_of(const sl_pack_pairs *pairs, int32_t a, int32_t b)
{
    uint64_t key = ((uint64_t)a << 32) | (uint32_t)b;
    key = (key ^ (key >> 31)) * 0x9e3779b97f4a7c15u;
    int64_t at = (int64_t)((key ^ (key >> 29)) & (uint64_t)(pairs->slots - 1));
    while (pairs->slot[at] != 0) {
        const sl_pack_pair *p = &pairs->pair[pairs->slot[at] - 1];
        if (p->chart[0] == a && p->chart[1] == b) {
            break;
        }
        at = (at + 1) & (pairs->slots - 1);
    }
    return at;
}

int32_t sl_pack_pairs_find(const sl_pack_pairs *pairs, int32_t a, int32_t b)
{
    return pairs->slot[a < b ? slot_of(pairs, a, b) : slot_of(pairs, b, a)] - 1;
}

static sl_status grow(sl_pack_pairs *pairs)
{
    int32_t *slot = sl_calloc(2 * pairs->slots, sizeof *slot);
    if (slot == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    sl_free(pairs->slot);
    pairs->slot = slot;
    pairs->slots *= 2;
    for (int32_t k = 0; k < pairs->count; k++) {
        pairs->slot[slot_of(pairs, pairs->pair[k].chart[0], pairs->pair[k].chart[1])] = k + 1;
    }
    return SL_OK;
}

sl_status sl_pack_pairs_get(sl_pack_pairs *pairs, int32_t a, int32_t b, int32_t weight, int32_t *out)
{
    sl_status status = SL_OK;
    *out = sl_pack_pairs_find(pairs, a, b);
    if (*out >= 0) {
        return SL_OK;
    }
    SL_TRY(sl_reserve((void **)&pairs->pair, &pairs->capacity, (int64_t)pairs->count + 1, sizeof *pairs->pair));
    if (2 * ((int64_t)pairs->count + 1) > pairs->slots) {
        SL_TRY(grow(pairs));
    }
    const int32_t low = a < b ? a : b, high = a < b ? b : a;
    *out = pairs->count;
    pairs->pair[pairs->count++] = (sl_pack_pair){{low, high}, weight, 0};
    pairs->slot[slot_of(pairs, low, high)] = pairs->count;
cleanup:
    return status;
}
