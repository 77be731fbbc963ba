#include "sparse/supernode.h"

#include "base/memory.h"

#include <string.h>

/* A merger of so many columns may store this share of zeros. */
static const struct {
    int32_t columns;
    double zeros;
} relaxation[] = {{4, 0.5}, {8, 0.4}, {16, 0.25}, {48, 0.1}, {INT32_MAX, 0.03}};

/* Supernodes before and while being merged. */
typedef struct merger {
    int32_t count;
    int32_t block;         /* columns of A that one of the graph stands for */
    int32_t *begin;        /* count + 1: first column */
    int32_t *parent;       /* count */
    int32_t *into;         /* count: the supernode this one went into, itself if none */
    int32_t *width;        /* columns with all merged into it */
    int32_t *below;        /* rows under its columns */
    int64_t *true_entries; /* of A's factor */
    int32_t *child, *sibling;
} merger;

static void merger_clear(merger *m)
{
    sl_free(m->begin);
    sl_free(m->parent);
    sl_free(m->into);
    sl_free(m->width);
    sl_free(m->below);
    sl_free(m->true_entries);
    sl_free(m->child);
    sl_free(m->sibling);
}

/* Column k + 1 continues the supernode of k when it is k's parent and has the same rows. */
static bool continues(const int32_t *parent, const int32_t *count, int32_t k)
{
    return parent[k] == k + 1 && count[k + 1] == count[k] - 1;
}

static sl_status find_maximal(int32_t n, const int32_t *parent, const int32_t *count, merger *m)
{
    int32_t *owner = sl_alloc(n, sizeof *owner);
    sl_status status = owner != NULL ? SL_OK : SL_OUT_OF_MEMORY;
    SL_TRY(status);
    for (int32_t k = 0; k < n; k++) {
        m->count += k == 0 || !continues(parent, count, k - 1);
        owner[k] = m->count - 1;
    }
    m->begin = sl_alloc((int64_t)m->count + 1, sizeof *m->begin);
    m->parent = sl_alloc(m->count, sizeof *m->parent);
    m->into = sl_alloc(m->count, sizeof *m->into);
    m->width = sl_alloc(m->count, sizeof *m->width);
    m->below = sl_alloc(m->count, sizeof *m->below);
    m->true_entries = sl_calloc(m->count, sizeof *m->true_entries);
    m->child = sl_alloc(m->count, sizeof *m->child);
    m->sibling = sl_alloc(m->count, sizeof *m->sibling);
    if (m->begin == NULL || m->parent == NULL || m->into == NULL || m->width == NULL || m->below == NULL ||
        m->true_entries == NULL || m->child == NULL || m->sibling == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    for (int32_t k = n - 1; k >= 0; k--) {
        m->begin[owner[k]] = k;
        m->true_entries[owner[k]] += (int64_t)m->block * m->block * count[k] - m->block * (m->block - 1) / 2;
    }
    m->begin[m->count] = n;
    for (int32_t s = 0; s < m->count; s++) {
        const int32_t last = m->begin[s + 1] - 1;
        m->parent[s] = parent[last] != -1 ? owner[parent[last]] : -1;
        m->into[s] = s;
        m->width[s] = m->begin[s + 1] - m->begin[s];
        m->below[s] = count[last] - 1;
    }
cleanup:
    sl_free(owner);
    return status;
}

static bool worth_merging(const merger *m, int32_t child, int32_t parent)
{
    const int64_t width = ((int64_t)m->width[child] + m->width[parent]) * m->block;
    const int64_t below = (int64_t)m->below[parent] * m->block;
    const double stored = (double)width * (double)(width + 1) / 2.0 + (double)width * (double)below;
    const double zeros = stored - (double)(m->true_entries[child] + m->true_entries[parent]);
    for (size_t k = 0; k < SL_COUNTOF(relaxation); k++) {
        if (width <= relaxation[k].columns) {
            return zeros <= relaxation[k].zeros * stored;
        }
    }
    return false;
}

/* From the leaves up; a parent looks at its children from the last, which continues its columns. */
static void merge_upwards(merger *m)
{
    memset(m->child, -1, (size_t)m->count * sizeof *m->child);
    for (int32_t s = 0; s < m->count; s++) {
        for (int32_t c = m->child[s]; c != -1; c = m->sibling[c]) {
            if (worth_merging(m, c, s)) {
                m->into[c] = s;
                m->width[s] += m->width[c];
                m->true_entries[s] += m->true_entries[c];
            }
        }
        if (m->parent[s] != -1) {
            m->sibling[s] = m->child[m->parent[s]];
            m->child[m->parent[s]] = s;
        }
    }
    for (int32_t s = m->count - 1; s >= 0; s--) {
        m->into[s] = m->into[m->into[s]]; /* parents have larger numbers: theirs is final */
    }
}

/* The survivors, in ascending order, are again in postorder; each takes its columns in ascending order. */
static sl_status number_survivors(int32_t n, const merger *m, sl_partition *out)
{
    int32_t *number = sl_alloc(m->count, sizeof *number);
    int32_t *next = sl_alloc(m->count, sizeof *next);
    sl_status status = number != NULL && next != NULL ? SL_OK : SL_OUT_OF_MEMORY;
    SL_TRY(status);
    for (int32_t s = 0; s < m->count; s++) {
        number[s] = m->into[s] == s ? out->count++ : -1;
    }
    out->first = sl_alloc((int64_t)out->count + 1, sizeof *out->first);
    out->parent = sl_alloc(out->count, sizeof *out->parent);
    out->below = sl_alloc(out->count, sizeof *out->below);
    out->order = sl_alloc(n, sizeof *out->order);
    if (out->first == NULL || out->parent == NULL || out->below == NULL || out->order == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    int32_t column = 0;
    for (int32_t s = 0; s < m->count; s++) {
        const int32_t k = number[s];
        if (k != -1) {
            out->first[k] = next[k] = column;
            out->parent[k] = m->parent[s] != -1 ? number[m->into[m->parent[s]]] : -1;
            out->below[k] = m->below[s];
            column += m->width[s];
        }
    }
    out->first[out->count] = column;
    for (int32_t s = 0; s < m->count; s++) {
        for (int32_t j = m->begin[s]; j < m->begin[s + 1]; j++) {
            out->order[next[number[m->into[s]]]++] = j;
        }
    }
cleanup:
    sl_free(number);
    sl_free(next);
    return status;
}

sl_status sl_partition_create(int32_t n, int32_t block, const int32_t *parent, const int32_t *count, sl_partition *out)
{
    merger m = {.block = block};
    sl_status status = SL_OK;
    *out = (sl_partition){0};
    SL_TRY(find_maximal(n, parent, count, &m));
    merge_upwards(&m);
    SL_TRY(number_survivors(n, &m, out));
cleanup:
    merger_clear(&m);
    if (status != SL_OK) {
        sl_partition_clear(out);
    }
    return status;
}

void sl_partition_clear(sl_partition *partition)
{
    sl_free(partition->first);
    sl_free(partition->parent);
    sl_free(partition->below);
    sl_free(partition->order);
    *partition = (sl_partition){0};
}
