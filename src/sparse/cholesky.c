#include "sparse/cholesky.h"

#include "base/memory.h"
#include "sparse/blocks.h"
#include "sparse/cholesky_internal.h"
#include "sparse/elimination.h"
#include "sparse/entries.h"
#include "sparse/extend_add.h"
#include "sparse/front.h"
#include "sparse/supernode.h"
#include "sparse/tasks.h"

#include <string.h>

sl_cholesky_def sl_cholesky_default(void)
{
    return (sl_cholesky_def){.ordering = SL_ORDER_AUTO, .block = 1};
}

/* What analysis needs and factorisation does not. All is about the graph of A's blocks. */
typedef struct scratch {
    sl_csc blocks;       /* owned, where there are any */
    const sl_csc *graph; /* blocks, or A itself */
    int32_t n;           /* its order */
    int32_t *place;      /* inverse of F->perm */
    sl_half half;
    int64_t *next;
    int32_t *parent, *post, *count;
    int32_t *work; /* 4 n */
    sl_partition partition;
} scratch;

static void scratch_clear(scratch *w)
{
    sl_block_pattern_clear(&w->blocks);
    sl_free(w->place);
    sl_free(w->half.first);
    sl_free(w->half.index);
    sl_free(w->next);
    sl_free(w->parent);
    sl_free(w->post);
    sl_free(w->count);
    sl_free(w->work);
    sl_partition_clear(&w->partition);
}

static sl_status scratch_init(const sl_csc *A, int32_t block, scratch *w)
{
    if (block != 1) {
        const sl_status status = sl_block_pattern(A, block, &w->blocks);
        if (status != SL_OK) {
            return status;
        }
    }
    w->graph = block != 1 ? &w->blocks : A;
    w->n = w->graph->ncols;
    const int64_t n = w->n;
    w->place = sl_alloc(A->ncols, sizeof *w->place);
    w->half.first = sl_alloc(n + 1, sizeof *w->half.first);
    w->half.index = sl_alloc(w->graph->colptr[n] - n, sizeof *w->half.index);
    w->next = sl_alloc(n, sizeof *w->next);
    w->parent = sl_alloc(n, sizeof *w->parent);
    w->post = sl_alloc(n, sizeof *w->post);
    w->count = sl_alloc(n, sizeof *w->count);
    w->work = sl_alloc(4 * n, sizeof *w->work);
    const bool ok = w->place != NULL && w->half.first != NULL && w->half.index != NULL && w->next != NULL &&
                    w->parent != NULL && w->post != NULL && w->count != NULL && w->work != NULL;
    return ok ? SL_OK : SL_OUT_OF_MEMORY;
}

/* place = inverse of perm; false when perm is no permutation. */
static bool invert(int32_t n, const int32_t *perm, int32_t *place)
{
    memset(place, -1, (size_t)n * sizeof *place);
    for (int32_t k = 0; k < n; k++) {
        if (perm[k] < 0 || perm[k] >= n || place[perm[k]] != -1) {
            return false;
        }
        place[perm[k]] = k;
    }
    return true;
}

static sl_status find_permutation(const sl_csc *A, const sl_cholesky_def *def, int32_t *perm)
{
    if (def->perm != NULL) {
        memcpy(perm, def->perm, (size_t)A->ncols * sizeof *perm);
        return SL_OK;
    }
    return sl_order_with(A, def->ordering, def->xyz, def->context, perm);
}

/* perm = perm after order; place follows. spare: n. */
static void compose(sl_cholesky *F, const int32_t *order, scratch *w, int32_t *spare)
{
    memcpy(spare, F->perm, (size_t)w->n * sizeof *spare);
    for (int32_t k = 0; k < w->n; k++) {
        F->perm[k] = spare[order[k]];
        w->place[F->perm[k]] = k;
    }
}

/* The elimination tree, its postorder put into perm, and the column counts. */
static void analyze_columns(sl_cholesky *F, scratch *w)
{
    const int32_t n = w->n;
    sl_half_upper(w->graph, w->place, w->next, &w->half);
    sl_elimination_tree(n, &w->half, w->parent, w->work);
    sl_postorder(n, w->parent, w->post, w->work);
    int32_t *rank = w->work, *tree = w->count;
    memcpy(tree, w->parent, (size_t)n * sizeof *tree);
    for (int32_t k = 0; k < n; k++) {
        rank[w->post[k]] = k;
    }
    for (int32_t k = 0; k < n; k++) {
        const int32_t up = tree[w->post[k]];
        w->parent[k] = up != -1 ? rank[up] : -1;
    }
    compose(F, w->post, w, w->work);
    sl_half_lower(w->graph, w->place, w->next, &w->half);
    sl_column_counts(n, &w->half, w->parent, w->count, w->work);
}

/* Marks the supernodes whose subtree has at most `patch` blocks of columns; returns how many. weight: supernodes. */
static int32_t find_bottom(const sl_partition *part, int32_t patch, int32_t *weight, bool *is_bottom)
{
    int32_t bottom = 0;
    memset(weight, 0, (size_t)part->count * sizeof *weight);
    for (int32_t s = 0; s < part->count; s++) {
        weight[s] += part->first[s + 1] - part->first[s];
        is_bottom[s] = weight[s] <= patch;
        bottom += is_bottom[s];
        if (part->parent[s] != -1) {
            weight[part->parent[s]] += weight[s];
        }
    }
    return bottom;
}

/* Numbers the partition's supernodes anew, bottom ones first, and takes them over: F's first, parent and walk; below =
 * rows under each; order = the partition's, rearranged. number: supernodes. */
static void renumber(sl_cholesky *F, const sl_partition *part, const bool *is_bottom, int32_t *number, int32_t *below,
                     int32_t *order)
{
    const int32_t b = F->block;
    int32_t next[2] = {F->bottom, 0};
    for (int32_t s = 0; s < part->count; s++) {
        number[s] = next[is_bottom[s]]++;
        F->walk[s] = number[s];
        F->first[number[s] + 1] = b * (part->first[s + 1] - part->first[s]);
        below[number[s]] = b * part->below[s];
    }
    F->first[0] = 0;
    for (int32_t s = 0; s < part->count; s++) {
        F->first[s + 1] += F->first[s];
        F->parent[number[s]] = part->parent[s] != -1 ? number[part->parent[s]] : -1;
    }
    for (int32_t s = 0; s < part->count; s++) {
        const size_t width = (size_t)(part->first[s + 1] - part->first[s]);
        memcpy(order + F->first[number[s]] / b, part->order + part->first[s], width * sizeof *order);
    }
}

static void link_tree(sl_cholesky *F, const int32_t *below)
{
    F->below_first[0] = F->panel[0] = 0;
    memset(F->child, -1, (size_t)F->supernodes * sizeof *F->child);
    for (int32_t s = 0; s < F->supernodes; s++) {
        const int32_t width = sl_supernode_width(F, s);
        const int64_t size = sl_own_size(width) + (int64_t)width * below[s];
        F->below_first[s + 1] = F->below_first[s] + below[s];
        F->panel[s + 1] = F->panel[s] + size;
        F->max_below = below[s] > F->max_below ? below[s] : F->max_below;
        F->max_width = width > F->max_width ? width : F->max_width;
        F->max_panel = size > F->max_panel ? size : F->max_panel;
    }
    for (int32_t s = F->supernodes - 1; s >= 0; s--) {
        F->odd[s] = F->parent[s] != -1 && !F->odd[F->parent[s]];
    }
    for (int32_t k = 0; k < F->supernodes; k++) {
        const int32_t s = F->walk[k];
        F->sibling[s] = -1;
        if (F->parent[s] != -1) {
            F->sibling[s] = F->child[F->parent[s]];
            F->child[F->parent[s]] = s;
        }
    }
}

/* Takes the supernodes over from the partition, and its column order into perm. */
static sl_status adopt_partition(sl_cholesky *F, int32_t patch, scratch *w)
{
    const sl_partition *part = &w->partition;
    const int64_t count = part->count;
    bool *is_bottom = sl_alloc(count, sizeof *is_bottom);
    sl_status status = SL_OK;
    F->supernodes = part->count;
    F->first = sl_alloc(count + 1, sizeof *F->first);
    F->parent = sl_alloc(count, sizeof *F->parent);
    F->walk = sl_alloc(count, sizeof *F->walk);
    F->below_first = sl_alloc(count + 1, sizeof *F->below_first);
    F->panel = sl_alloc(count + 1, sizeof *F->panel);
    F->odd = sl_alloc(count, sizeof *F->odd);
    F->child = sl_alloc(count, sizeof *F->child);
    F->sibling = sl_alloc(count, sizeof *F->sibling);
    if (is_bottom == NULL || F->first == NULL || F->parent == NULL || F->walk == NULL || F->below_first == NULL ||
        F->panel == NULL || F->odd == NULL || F->child == NULL || F->sibling == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    int32_t *number = w->work, *below = w->work + w->n, *order = w->work + 2 * (int64_t)w->n;
    F->bottom = find_bottom(part, patch / F->block, number, is_bottom);
    renumber(F, part, is_bottom, number, below, order);
    link_tree(F, below);
    compose(F, order, w, w->count);
cleanup:
    sl_free(is_bottom);
    return status;
}

/* Row i stands below every supernode on the way from its entries in A up to its own: each list comes out sorted. mark:
 * supernodes; next: the same. */
static void list_rows_below(sl_cholesky *F, const scratch *w, int32_t *mark, int32_t *owner)
{
    const int32_t b = F->block;
    for (int32_t s = 0; s < F->supernodes; s++) {
        w->next[s] = F->below_first[s];
        mark[s] = -1;
        for (int32_t k = F->first[s] / b; k < F->first[s + 1] / b; k++) {
            owner[k] = s;
        }
    }
    for (int32_t i = 0; i < w->n; i++) {
        for (int64_t p = w->half.first[i]; p < w->half.first[i + 1]; p++) {
            for (int32_t s = owner[w->half.index[p]]; s != owner[i] && mark[s] != i; s = F->parent[s]) {
                for (int32_t r = 0; r < b; r++) {
                    F->below[w->next[s]++] = b * i + r;
                }
                mark[s] = i;
            }
        }
    }
}

/* Doubles on the stacks of update matrices at their highest. */
static void find_largest(sl_cholesky *F)
{
    int64_t top = 0, deepest = 0;
    for (int32_t k = 0; k < F->supernodes; k++) {
        const int32_t s = F->walk[k];
        const int64_t own = sl_packed_size(sl_supernode_below(F, s));
        deepest = top + own > deepest ? top + own : deepest;
        for (int32_t c = F->child[s]; c != -1; c = F->sibling[c]) {
            top -= sl_packed_size(sl_supernode_below(F, c));
        }
        top += own;
    }
    F->max_update = deepest;
}

static sl_status analyze_rows(sl_cholesky *F, const sl_csc *A, scratch *w)
{
    if (F->pattern_nnz > INT32_MAX || F->max_panel > INT32_MAX) {
        return SL_OUT_OF_MEMORY; /* entry_from and entry_to */
    }
    F->below = sl_alloc(F->below_first[F->supernodes], sizeof *F->below);
    F->relative = sl_alloc(F->below_first[F->supernodes], sizeof *F->relative);
    F->entry_first = sl_alloc((int64_t)F->supernodes + 1, sizeof *F->entry_first);
    F->entry_from = sl_alloc(F->pattern_nnz, sizeof *F->entry_from);
    F->entry_to = sl_alloc(F->pattern_nnz, sizeof *F->entry_to);
    if (F->below == NULL || F->relative == NULL || F->entry_first == NULL || F->entry_from == NULL ||
        F->entry_to == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    int32_t *owner = w->count, *mark = w->work;
    sl_half_upper(w->graph, w->place, w->next, &w->half);
    list_rows_below(F, w, mark, owner);
    sl_match_rows(F);
    sl_map_entries(F, A, w->graph, w->place, owner, w->next);
    sl_block_expand(w->n, F->block, F->perm);
    sl_block_expand(w->n, F->block, w->place);
    find_largest(F);
    return sl_tasks_create(F);
}

sl_status sl_cholesky_analyze(const sl_csc *A, const sl_cholesky_def *def, sl_cholesky **out)
{
    const sl_cholesky_def defaults = sl_cholesky_default();
    scratch w = {0};
    sl_cholesky *F = NULL;
    sl_status status = SL_OK;
    *out = NULL;
    def = def != NULL ? def : &defaults;
    SL_TRY(sl_csc_check_pattern(A, true));
    SL_TRY(def->patch >= 0 ? SL_OK : SL_BAD_INPUT);
    F = sl_calloc(1, sizeof *F);
    if (F == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    F->n = A->ncols;
    F->block = def->block;
    F->pattern_nnz = A->colptr[A->ncols];
    F->pattern_hash = sl_pattern_hash(A);
    F->pivot_rtol = def->pivot_rtol;
    F->kind = def->kind;
    F->kernels = sl_kernels_best();
    F->perm = sl_alloc(F->n, sizeof *F->perm);
    SL_TRY(F->perm != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(scratch_init(A, def->block, &w));
    SL_TRY(find_permutation(w.graph, def, F->perm));
    SL_TRY(invert(w.n, F->perm, w.place) ? SL_OK : SL_BAD_INPUT);
    analyze_columns(F, &w);
    SL_TRY(sl_partition_create(w.n, F->block, w.parent, w.count, &w.partition));
    SL_TRY(adopt_partition(F, def->patch, &w));
    SL_TRY(analyze_rows(F, A, &w));
    F->place = w.place;
    w.place = NULL;
    *out = F;
cleanup:
    scratch_clear(&w);
    if (status != SL_OK) {
        sl_cholesky_free(F);
    }
    return status;
}

int64_t sl_cholesky_nnz(const sl_cholesky *F)
{
    int64_t sum = 0;
    for (int32_t s = 0; s < F->supernodes; s++) {
        const int64_t width = sl_supernode_width(F, s);
        sum += width * (width + 1) / 2 + width * sl_supernode_below(F, s);
    }
    return sum;
}

int64_t sl_cholesky_factor_bytes(const sl_cholesky *F, int64_t *kept)
{
    const int64_t signs = F->kind == SL_FACTOR_LDLT ? F->n : 0;
    const int64_t stays = F->panel[F->supernodes] * (int64_t)sizeof *F->L + signs;
    const int64_t doubles = F->max_update + sl_front_spare(F->max_width);
    *kept = stays;
    return stays + doubles * (int64_t)sizeof(double);
}

int32_t sl_cholesky_top_first(const sl_cholesky *F)
{
    return F->first[F->bottom];
}

const int32_t *sl_cholesky_permutation(const sl_cholesky *F)
{
    return F->perm;
}

void sl_cholesky_release(sl_cholesky *F)
{
    sl_free(F->L);
    sl_free(F->sign);
    sl_front_space_clear(&F->space);
    F->L = NULL;
    F->sign = NULL;
}

void sl_cholesky_free(sl_cholesky *F)
{
    if (F == NULL) {
        return;
    }
    sl_cholesky_release(F);
    sl_free(F->perm);
    sl_free(F->place);
    sl_free(F->first);
    sl_free(F->parent);
    sl_free(F->below_first);
    sl_free(F->below);
    sl_free(F->relative);
    sl_free(F->panel);
    sl_free(F->walk);
    sl_free(F->entry_first);
    sl_free(F->entry_from);
    sl_free(F->entry_to);
    sl_free(F->child);
    sl_free(F->sibling);
    sl_free(F->odd);
    sl_tasks_clear(F);
    sl_free(F);
}
