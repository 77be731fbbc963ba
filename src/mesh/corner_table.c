#include "mesh/corner_table_internal.h"

/* Gives the whole fan of corner h the number `label`. */
static void label_fan(const sl_corner_table *t, int32_t h, int32_t label, int32_t *fan)
{
    int32_t c = h;
    do {
        fan[c] = label;
        c = t->twin[sl_table_prev(t, c)];
    } while (c >= 0 && c != h);
    if (c == h) {
        return;
    }
    /* An open fan: what lies on the other side of h. */
    for (c = t->twin[h]; c >= 0; c = t->twin[c]) {
        c = sl_table_next(t, c);
        fan[c] = label;
    }
}

int32_t sl_table_label_fans(const sl_corner_table *table, int32_t *fan)
{
    int32_t count = 0;
    for (int32_t h = 0; h < table->nh; h++) {
        fan[h] = -1;
    }
    for (int32_t h = 0; h < table->nh; h++) {
        if (fan[h] < 0) {
            label_fan(table, h, count++, fan);
        }
    }
    return count;
}

int32_t sl_table_count_loops(const sl_corner_table *table, uint8_t *seen)
{
    int32_t loops = 0;
    for (int32_t h = 0; h < table->nh; h++) {
        if (table->twin[h] >= 0 || seen[h] != 0) {
            continue;
        }
        loops++;
        for (int32_t b = h; seen[b] == 0; b = sl_table_border_next(table, b)) {
            seen[b] = 1;
        }
    }
    return loops;
}
