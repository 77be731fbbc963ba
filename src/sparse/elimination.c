#include "sparse/elimination.h"

#include <string.h>

/* One entry (owner, other) of the half: the larger of the two owns the list in the upper, the smaller in the lower.
 * Which one that is cannot be foreseen: it is computed, not branched on. */
static inline void half_of(const sl_csc *A, const int32_t *place, bool upper, int64_t *next, sl_half *half)
{
    const int32_t n = A->ncols;
    memset(half->first, 0, ((size_t)n + 1) * sizeof *half->first);
    for (int32_t j = 0; j < n; j++) {
        for (int64_t p = A->colptr[j] + 1; p < A->colptr[j + 1]; p++) {
            const int32_t a = place[j], b = place[A->row[p]];
            const int32_t swap = (a ^ b) & -(int32_t)((a < b) == upper);
            half->first[(a ^ swap) + 1]++;
        }
    }
    for (int32_t k = 0; k < n; k++) {
        half->first[k + 1] += half->first[k];
    }
    memcpy(next, half->first, (size_t)n * sizeof *next);
    for (int32_t j = 0; j < n; j++) {
        for (int64_t p = A->colptr[j] + 1; p < A->colptr[j + 1]; p++) {
            const int32_t a = place[j], b = place[A->row[p]];
            const int32_t swap = (a ^ b) & -(int32_t)((a < b) == upper);
            half->index[next[a ^ swap]++] = b ^ swap;
        }
    }
}

void sl_half_upper(const sl_csc *A, const int32_t *place, int64_t *next, sl_half *half)
{
    half_of(A, place, true, next, half);
}

void sl_half_lower(const sl_csc *A, const int32_t *place, int64_t *next, sl_half *half)
{
    half_of(A, place, false, next, half);
}

void sl_elimination_tree(int32_t n, const sl_half *upper, int32_t *parent, int32_t *ancestor)
{
    for (int32_t k = 0; k < n; k++) {
        parent[k] = -1;
        ancestor[k] = -1;
        for (int64_t p = upper->first[k]; p < upper->first[k + 1]; p++) {
            /* Climb to the root of i's tree, pointing all on the way at k: the next climb is short. */
            int32_t i = upper->index[p];
            while (i != -1 && i < k) {
                const int32_t up = ancestor[i];
                ancestor[i] = k;
                if (up == -1) {
                    parent[i] = k;
                }
                i = up;
            }
        }
    }
}

void sl_postorder(int32_t n, const int32_t *parent, int32_t *post, int32_t *work)
{
    int32_t *child = work, *sibling = work + n, *stack = work + 2 * (int64_t)n;
    memset(child, -1, (size_t)n * sizeof *child);
    for (int32_t k = n - 1; k >= 0; k--) {
        if (parent[k] != -1) {
            sibling[k] = child[parent[k]];
            child[parent[k]] = k;
        }
    }
    int32_t placed = 0;
    for (int32_t root = 0; root < n; root++) {
        if (parent[root] != -1) {
            continue;
        }
        int32_t depth = 0;
        stack[depth++] = root;
        while (depth > 0) {
            const int32_t k = stack[depth - 1];
            const int32_t c = child[k];
            if (c != -1) {
                child[k] = sibling[c];
                stack[depth++] = c;
            } else {
                post[placed++] = k;
                depth--;
            }
        }
    }
}

static int32_t find_set(int32_t *set, int32_t k)
{
    int32_t root = k;
    while (set[root] != root) {
        root = set[root];
    }
    while (set[k] != root) {
        const int32_t up = set[k];
        set[k] = root;
        k = up;
    }
    return root;
}

void sl_column_counts(int32_t n, const sl_half *lower, const int32_t *parent, int32_t *count, int32_t *work)
{
    int32_t *first_descendant = work, *last_neighbour = work + n;
    int32_t *last_leaf = work + 2 * (int64_t)n, *set = work + 3 * (int64_t)n;
    for (int32_t j = 0; j < n; j++) {
        first_descendant[j] = j;
        last_neighbour[j] = -1;
        last_leaf[j] = -1;
        set[j] = j;
        count[j] = 1;
    }
    for (int32_t j = 0; j < n; j++) {
        if (parent[j] != -1) {
            count[parent[j]] = 0; /* only leaves start at 1 */
            if (first_descendant[j] < first_descendant[parent[j]]) {
                first_descendant[parent[j]] = first_descendant[j];
            }
        }
    }
    /* count becomes the weight whose sum over the subtree of j is the count of j. */
    for (int32_t j = 0; j < n; j++) {
        if (parent[j] != -1) {
            count[parent[j]]--;
        }
        for (int64_t p = lower->first[j]; p < lower->first[j + 1]; p++) {
            const int32_t i = lower->index[p];
            if (first_descendant[j] > last_neighbour[i]) { /* j is a leaf of the subtree of row i */
                count[j]++;
                if (last_leaf[i] != -1) {
                    count[find_set(set, last_leaf[i])]--;
                }
                last_leaf[i] = j;
            }
            last_neighbour[i] = j;
        }
        if (parent[j] != -1) {
            set[j] = parent[j];
        }
    }
    for (int32_t j = 0; j < n; j++) {
        if (parent[j] != -1) {
            count[parent[j]] += count[j];
        }
    }
}
