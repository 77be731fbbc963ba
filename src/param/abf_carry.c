/* Angles of one patch at the triangles of another. */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "param/abf_chart.h"

/* A triangle by the mesh corners it joins: no other triangle of the mesh has the same. */
typedef struct key {
    int32_t corner[3], triangle;
} key;

static int by_corners(const void *a, const void *b)
{
    const key *x = a, *y = b;
    for (int k = 0; k < 3; k++) {
        if (x->corner[k] != y->corner[k]) {
            return x->corner[k] < y->corner[k] ? -1 : 1;
        }
    }
    return 0;
}

static key key_of(const sl_patch *patch, int32_t t)
{
    const int32_t *c = &patch->corner[3 * (int64_t)t];
    return (key){{c[0], c[1], c[2]}, t};
}

sl_status sl_abf_carry_angles(const sl_patch *from, const double *from_angle, const sl_patch *to, double *to_angle,
                              int32_t *taken)
{
    int32_t count = 0;
    key *keys = sl_alloc(from->nt, sizeof *keys);
    if (keys == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t t = 0; t < from->nt; t++) {
        keys[t] = key_of(from, t);
    }
    qsort(keys, (size_t)from->nt, sizeof *keys, by_corners);
    for (int32_t t = 0; t < to->nt; t++) {
        const key wanted = key_of(to, t);
        const key *found = bsearch(&wanted, keys, (size_t)from->nt, sizeof *keys, by_corners);
        if (found != NULL) {
            memcpy(&to_angle[3 * (int64_t)t], &from_angle[3 * (int64_t)found->triangle], 3 * sizeof *to_angle);
            count++;
        }
    }
    if (taken != NULL) {
        *taken = count;
    }
    sl_free(keys);
    return SL_OK;
}
