/* Minimum degree in the leaves of a dissection: small graphs, so rows are sets of bits and degrees exact. */
#include "sparse/dissection.h"

#include "base/memory.h"

#include <string.h>

/* Nodes of a leaf and of the separators around it that are told apart. */
enum { WORDS = 4, ROOM = 64 * WORDS, LARGEST_LEAF = ROOM / 2 };

typedef struct bits {
    uint64_t word[WORDS];
} bits;

typedef struct leaf {
    const sl_adjacency *graph;
    int32_t *local; /* n: number within the leaf or its halo, -1 elsewhere */
    int32_t members, all;
    int32_t node[ROOM]; /* members, then halo */
    bits row[ROOM];     /* members: neighbours not yet eliminated */
    int32_t degree[ROOM];
} leaf;

static int32_t count_bits(const bits *set)
{
    int32_t count = 0;
    for (int k = 0; k < WORDS; k++) {
        uint64_t x = set->word[k];
        x -= x >> 1 & 0x5555555555555555u;
        x = (x & 0x3333333333333333u) + (x >> 2 & 0x3333333333333333u);
        x = (x + (x >> 4)) & 0x0f0f0f0f0f0f0f0fu;
        count += (int32_t)(x * 0x0101010101010101u >> 56);
    }
    return count;
}

static void set_bit(bits *set, int32_t k)
{
    set->word[k / 64] |= (uint64_t)1 << k % 64;
}

static void clear_bit(bits *set, int32_t k)
{
    set->word[k / 64] &= ~((uint64_t)1 << k % 64);
}

/* Takes the nodes in; neighbours beyond the room are not counted. */
static void load_leaf(leaf *f, const int32_t *node, int32_t count)
{
    f->members = f->all = count;
    for (int32_t k = 0; k < count; k++) {
        f->node[k] = node[k];
        f->local[node[k]] = k;
    }
    memset(f->row, 0, (size_t)count * sizeof *f->row);
    for (int32_t k = 0; k < count; k++) {
        for (int64_t p = f->graph->first[node[k]]; p < f->graph->first[node[k] + 1]; p++) {
            const int32_t other = f->graph->adj[p];
            if (f->local[other] == -1 && f->all < ROOM) {
                f->local[other] = f->all;
                f->node[f->all++] = other;
            }
            if (f->local[other] != -1) {
                set_bit(&f->row[k], f->local[other]);
            }
        }
        f->degree[k] = count_bits(&f->row[k]);
    }
    for (int32_t k = 0; k < f->all; k++) {
        f->local[f->node[k]] = -1;
    }
}

/* The remaining members' degrees stand; the eliminated have ROOM + 1. */
static int32_t least_degree(const leaf *f)
{
    int32_t best = 0;
    for (int32_t k = 1; k < f->members; k++) {
        best = f->degree[k] < f->degree[best] ? k : best;
    }
    return best;
}

/* Joins v's neighbours; those left with no others go at once, for nothing. Returns the new end of order. */
static int32_t eliminate(leaf *f, int32_t v, int32_t *order, int32_t placed)
{
    bits clique = f->row[v];
    const int32_t size = count_bits(&clique);
    int32_t twin[ROOM], twins = 0;
    order[placed++] = f->node[v];
    f->degree[v] = ROOM + 1;
    for (int32_t u = 0; u < f->members; u++) {
        if ((clique.word[u / 64] >> u % 64 & 1) == 0) {
            continue;
        }
        for (int k = 0; k < WORDS; k++) {
            f->row[u].word[k] |= clique.word[k];
        }
        clear_bit(&f->row[u], u);
        clear_bit(&f->row[u], v);
        f->degree[u] = count_bits(&f->row[u]);
        if (f->degree[u] == size - 1) {
            twin[twins++] = u;
        }
    }
    for (int32_t t = 0; t < twins; t++) {
        order[placed++] = f->node[twin[t]];
        f->degree[twin[t]] = ROOM + 1;
        for (int32_t u = 0; u < f->members; u++) {
            if (f->degree[u] <= ROOM && (f->row[u].word[twin[t] / 64] >> twin[t] % 64 & 1) != 0) {
                clear_bit(&f->row[u], twin[t]);
                f->degree[u]--;
            }
        }
    }
    return placed;
}

/* Chunks of the pieces that are worked on side by side: a fixed number, as each needs room for all nodes' numbers. */
enum { CHUNKS = 8 };

typedef struct leaves_job {
    const sl_adjacency *graph;
    const int32_t *piece;
    int32_t *order;
    int32_t pieces;
    int32_t *first; /* pieces + 1: where they begin in order */
    bool complete[CHUNKS];
    sl_status status[CHUNKS];
} leaves_job;

static sl_status find_pieces(leaves_job *job)
{
    const int32_t n = job->graph->n;
    job->pieces = n > 0 ? job->piece[job->order[n - 1]] + 1 : 0;
    job->first = sl_calloc((int64_t)job->pieces + 1, sizeof *job->first);
    if (job->first == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t i = 0; i < n; i++) {
        job->first[job->piece[i] + 1]++;
    }
    for (int32_t k = 0; k < job->pieces; k++) {
        job->first[k + 1] += job->first[k];
    }
    return SL_OK;
}

/* Do some of its neighbours go before it? Then it is no leaf. */
static bool separates(const leaves_job *job, int32_t k)
{
    const sl_adjacency *graph = job->graph;
    for (int32_t at = job->first[k]; at < job->first[k + 1]; at++) {
        const int32_t v = job->order[at];
        for (int64_t p = graph->first[v]; p < graph->first[v + 1]; p++) {
            if (job->piece[graph->adj[p]] < k) {
                return true;
            }
        }
    }
    return false;
}

/* Separators stay as they are. */
static void order_some(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    leaves_job *job = user;
    leaf *f = sl_alloc(1, sizeof *f);
    sl_status status = SL_OK;
    SL_TRY(f != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    f->graph = job->graph;
    f->local = sl_alloc(job->graph->n, sizeof *f->local);
    SL_TRY(f->local != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    memset(f->local, -1, (size_t)job->graph->n * sizeof *f->local);
    for (int32_t k = (int32_t)begin; k < end; k++) {
        int32_t *order = job->order + job->first[k];
        const int32_t size = job->first[k + 1] - job->first[k];
        if (separates(job, k)) {
            continue;
        }
        if (size > LARGEST_LEAF) {
            job->complete[chunk] = false;
            continue;
        }
        load_leaf(f, order, size);
        for (int32_t placed = 0; placed < size;) {
            placed = eliminate(f, least_degree(f), order, placed);
        }
    }
cleanup:
    if (f != NULL) {
        sl_free(f->local);
    }
    sl_free(f);
    job->status[chunk] = status;
}

sl_status sl_order_leaves(const sl_adjacency *graph, const int32_t *piece, const sl_context *context, int32_t *order,
                          bool *complete)
{
    leaves_job job = {.graph = graph, .piece = piece, .order = order};
    sl_status status = SL_OK;
    memset(job.complete, true, sizeof job.complete);
    SL_TRY(find_pieces(&job));
    sl_parallel_for(context, job.pieces, job.pieces / CHUNKS + 1, order_some, &job);
    *complete = true;
    for (int32_t c = 0; c < CHUNKS; c++) {
        SL_TRY(job.status[c]);
        *complete = *complete && job.complete[c];
    }
cleanup:
    sl_free(job.first);
    return status;
}
