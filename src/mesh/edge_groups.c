#include "mesh/edge_groups_internal.h"

#include <stdlib.h>

#include "base/memory.h"

enum {
    SHORT_BUCKET = 24, /* insertion sort below: a vertex has about 6 edges */
};

static int compare_keys(const void *a, const void *b)
{
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

static void sort_bucket(uint64_t *key, int32_t n)
{
    if (n > SHORT_BUCKET) {
        qsort(key, (size_t)n, sizeof *key, compare_keys);
        return;
    }
    for (int32_t i = 1; i < n; i++) {
        const uint64_t k = key[i];
        int32_t j = i;
        for (; j > 0 && key[j - 1] > k; j--) {
            key[j] = key[j - 1];
        }
        key[j] = k;
    }
}

static int32_t smaller(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

sl_status sl_edge_groups_init(int32_t nv, int32_t nh, const int32_t *from, const int32_t *to, sl_edge_groups *out)
{
    sl_status status = SL_OK;
    sl_edge_groups g = {.nv = nv};
    g.first = sl_calloc((int64_t)nv + 2, sizeof *g.first);
    g.key = sl_alloc(nh, sizeof *g.key);
    if (g.first == NULL || g.key == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    /* Counts go two places up, so that filling moves first[v + 1] from the bucket's begin to its end. */
    for (int32_t h = 0; h < nh; h++) {
        if (from[h] >= 0) {
            g.first[smaller(from[h], to[h]) + 2]++;
        }
    }
    for (int32_t v = 0; v < nv; v++) {
        g.first[v + 2] += g.first[v + 1];
    }
    for (int32_t h = 0; h < nh; h++) {
        if (from[h] >= 0) {
            const int32_t lo = smaller(from[h], to[h]), hi = from[h] + (to[h] - lo);
            g.key[g.first[lo + 1]++] = (uint64_t)hi << 32 | (uint64_t)h;
        }
    }
    for (int32_t v = 0; v < nv; v++) {
        sort_bucket(g.key + g.first[v], g.first[v + 1] - g.first[v]);
    }
    *out = g;
    g = (sl_edge_groups){0};
cleanup:
    sl_edge_groups_clear(&g);
    return status;
}

void sl_edge_groups_clear(sl_edge_groups *groups)
{
    sl_free(groups->first);
    sl_free(groups->key);
    *groups = (sl_edge_groups){0};
}

bool sl_edge_groups_next(const sl_edge_groups *groups, sl_edge_cursor *cursor, sl_edge_group *group)
{
    while (cursor->vertex < groups->nv && cursor->position == groups->first[cursor->vertex + 1]) {
        cursor->vertex++;
    }
    if (cursor->vertex == groups->nv) {
        return false;
    }
    const int32_t begin = cursor->position, end = groups->first[cursor->vertex + 1];
    int32_t p = begin + 1;
    while (p < end && groups->key[p] >> 32 == groups->key[begin] >> 32) {
        p++;
    }
    cursor->position = p;
    *group = (sl_edge_group){groups->key + begin, p - begin};
    return true;
}
