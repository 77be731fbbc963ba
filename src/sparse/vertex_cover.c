#include "sparse/dissection.h"

#include "base/memory.h"

#include <string.h>

static void match_greedily(sl_bipartite *g)
{
    memset(g->left_mate, -1, (size_t)g->left_count * sizeof *g->left_mate);
    memset(g->right_mate, -1, (size_t)g->right_count * sizeof *g->right_mate);
    for (int32_t l = 0; l < g->left_count; l++) {
        for (int64_t p = g->first[l]; p < g->first[l + 1]; p++) {
            if (g->right_mate[g->adj[p]] == -1) {
                g->right_mate[g->adj[p]] = l;
                g->left_mate[l] = g->adj[p];
                break;
            }
        }
    }
}

/* level[l] = length of the shortest alternating path from a free left node, -1 where there is none. Returns whether a
 * free right node was met; levels beyond the nearest such one are left at -1. */
static bool find_levels(sl_bipartite *g)
{
    int32_t *queue = g->stack;
    int32_t head = 0, tail = 0, last_level = INT32_MAX;
    for (int32_t l = 0; l < g->left_count; l++) {
        g->level[l] = g->left_mate[l] == -1 ? 0 : -1;
        if (g->level[l] == 0) {
            queue[tail++] = l;
        }
    }
    while (head < tail && g->level[queue[head]] < last_level) {
        const int32_t l = queue[head++];
        for (int64_t p = g->first[l]; p < g->first[l + 1]; p++) {
            const int32_t mate = g->right_mate[g->adj[p]];
            if (mate == -1) {
                last_level = g->level[l] + 1;
            } else if (g->level[mate] == -1) {
                g->level[mate] = g->level[l] + 1;
                queue[tail++] = mate;
            }
        }
    }
    return last_level != INT32_MAX;
}

/* Flips the path on the stack: each node takes the right node it points at. */
static void flip_path(sl_bipartite *g, int32_t depth)
{
    for (int32_t k = 0; k < depth; k++) {
        const int32_t l = g->stack[k];
        const int32_t r = g->adj[g->next[l]];
        g->left_mate[l] = r;
        g->right_mate[r] = l;
    }
}

/* Depth-first search along rising levels; each edge is looked at once a phase. */
static bool augment_from(sl_bipartite *g, int32_t root)
{
    int32_t depth = 0;
    g->stack[depth++] = root;
    while (depth > 0) {
        const int32_t l = g->stack[depth - 1];
        if (g->next[l] == g->first[l + 1]) {
            if (--depth > 0) {
                g->next[g->stack[depth - 1]]++;
            }
            continue;
        }
        const int32_t mate = g->right_mate[g->adj[g->next[l]]];
        if (mate == -1) {
            flip_path(g, depth);
            return true;
        }
        if (g->level[mate] == g->level[l] + 1) {
            g->stack[depth++] = mate;
        } else {
            g->next[l]++;
        }
    }
    return false;
}

static void match_fully(sl_bipartite *g)
{
    bool grew = true;
    while (grew && find_levels(g)) {
        grew = false;
        memcpy(g->next, g->first, (size_t)g->left_count * sizeof *g->next);
        for (int32_t l = 0; l < g->left_count; l++) {
            if (g->left_mate[l] == -1 && augment_from(g, l)) {
                grew = true;
            }
        }
    }
}

void sl_minimum_vertex_cover(sl_bipartite *g)
{
    match_greedily(g);
    match_fully(g);
    /* No augmenting path is left, so the levels mark all that alternating paths from free left nodes reach. */
    find_levels(g);
    memset(g->right_in, 0, (size_t)g->right_count * sizeof *g->right_in);
    for (int32_t l = 0; l < g->left_count; l++) {
        g->left_in[l] = g->level[l] == -1;
        for (int64_t p = g->first[l]; p < g->first[l + 1] && g->level[l] != -1; p++) {
            g->right_in[g->adj[p]] = true;
        }
    }
}

sl_status sl_cut_init(sl_cut *cut, const sl_adjacency *graph)
{
    const int64_t n = graph->n, half = n / 2 + 1;
    sl_bipartite *g = &cut->shores;
    *cut = (sl_cut){0};
    cut->left = sl_alloc(half, sizeof *cut->left);
    cut->right = sl_alloc(half, sizeof *cut->right);
    cut->right_id = sl_alloc(n, sizeof *cut->right_id);
    cut->first = sl_alloc(half + 1, sizeof *cut->first);
    cut->adj = sl_alloc(graph->first[n] / 2, sizeof *cut->adj);
    g->left_mate = sl_alloc(half, sizeof *g->left_mate);
    g->right_mate = sl_alloc(half, sizeof *g->right_mate);
    g->level = sl_alloc(half, sizeof *g->level);
    g->stack = sl_alloc(half, sizeof *g->stack);
    g->next = sl_alloc(half, sizeof *g->next);
    g->left_in = sl_alloc(half, sizeof *g->left_in);
    g->right_in = sl_alloc(half, sizeof *g->right_in);
    g->first = cut->first;
    g->adj = cut->adj;
    if (cut->left == NULL || cut->right == NULL || cut->right_id == NULL || cut->first == NULL || cut->adj == NULL ||
        g->left_mate == NULL || g->right_mate == NULL || g->level == NULL || g->stack == NULL || g->next == NULL ||
        g->left_in == NULL || g->right_in == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    memset(cut->right_id, -1, (size_t)n * sizeof *cut->right_id);
    return SL_OK;
}

void sl_cut_clear(sl_cut *cut)
{
    sl_free(cut->left);
    sl_free(cut->right);
    sl_free(cut->right_id);
    sl_free(cut->first);
    sl_free(cut->adj);
    sl_free(cut->shores.left_mate);
    sl_free(cut->shores.right_mate);
    sl_free(cut->shores.level);
    sl_free(cut->shores.stack);
    sl_free(cut->shores.next);
    sl_free(cut->shores.left_in);
    sl_free(cut->shores.right_in);
}

void sl_cut_cover(sl_cut *cut)
{
    cut->first[cut->shores.left_count] = cut->edges;
    for (int32_t r = 0; r < cut->shores.right_count; r++) {
        cut->right_id[cut->right[r]] = -1;
    }
    sl_minimum_vertex_cover(&cut->shores);
}
