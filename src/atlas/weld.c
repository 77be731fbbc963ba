#include "atlas/weld.h"

#include "base/memory.h"

#include <string.h>

/* A point as the bits of its coordinates, so that hashing and equality agree. */
typedef struct point_bits {
    uint64_t x[3];
} point_bits;

static point_bits bits_of(const double *point, int32_t dim)
{
    point_bits bits = {{0, 0, 0}};
    for (int32_t k = 0; k < dim; k++) {
        const double x = point[k] + 0.0; /* -0 + 0 = +0 */
        memcpy(&bits.x[k], &x, sizeof x);
    }
    return bits;
}

static bool has_nan(const double *point, int32_t dim)
{
    for (int32_t k = 0; k < dim; k++) {
        if (point[k] != point[k]) {
            return true;
        }
    }
    return false;
}

static uint64_t hash_bits(point_bits p)
{
    uint64_t h = 0x9e3779b97f4a7c15u;
    for (int k = 0; k < 3; k++) {
        h ^= p.x[k];
        h *= 0xff51afd7ed558ccdu;
        h ^= h >> 32;
    }
    return h;
}

sl_status sl_weld_points(int64_t n, int32_t dim, const double *point, int32_t *id, int32_t *count)
{
    int64_t slots = 16;
    while (slots < 2 * n) {
        slots *= 2;
    }
    int32_t *table = sl_alloc(slots, sizeof *table); /* first row of each distinct point, -1 = free */
    if (table == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    memset(table, 0xff, (size_t)slots * sizeof *table);
    int32_t distinct = 0;
    for (int64_t i = 0; i < n; i++) {
        const point_bits p = bits_of(point + i * dim, dim);
        uint64_t s = hash_bits(p) & (uint64_t)(slots - 1);
        id[i] = -1;
        while (table[s] >= 0 && !has_nan(point + i * dim, dim)) {
            const point_bits q = bits_of(point + (int64_t)table[s] * dim, dim);
            if (memcmp(&p, &q, sizeof p) == 0) {
                id[i] = id[table[s]];
                break;
            }
            s = (s + 1) & (uint64_t)(slots - 1);
        }
        if (id[i] < 0) {
            id[i] = distinct++;
            if (!has_nan(point + i * dim, dim)) {
                table[s] = (int32_t)i;
            }
        }
    }
    *count = distinct;
    sl_free(table);
    return SL_OK;
}
