#include "base/memory.h"
#include "graph/csr.h"

#include <math.h>

/* What rounding may leave in an arc after many augmentations, as a part of its own capacity: less counts as full. */
static const double residual_rtol = 0x1p-40;

/* A flow in an undirected graph: each entry of adj is an arc, its reverse the same edge in the other row. */
typedef struct flow_network {
    const sl_graph *graph;
    const int8_t *seed;
    int32_t *reverse;  /* entry of the same edge in the other row */
    int32_t *tail;     /* node in whose row an entry stands */
    double *residual;  /* capacity left in each arc */
    double *threshold; /* an arc with no more left is full */
    int32_t *level;    /* arcs to the nearest negative seed, -1 = none can be reached */
    int32_t *next;     /* first arc of each row not yet found useless in this phase */
    int32_t *queue;    /* nodes, of a search; arcs, of a path */
    int32_t *active;   /* free nodes, and seeds with an arc to a node that is no seed of the same sign */
    int32_t active_count;
} flow_network;

static bool open_arc(const flow_network *net, int32_t p)
{
    return net->residual[p] > net->threshold[p];
}

static double capacity(const sl_graph *graph, int32_t p)
{
    return graph->weight != NULL ? graph->weight[p] : 1.0;
}

/* Stable counting sort of the entries listed in `order` (NULL = 0, 1, ...) by node key[entry]. */
static void sort_entries(int32_t n, int32_t entries, const int32_t *key, const int32_t *order, int32_t *start,
                         int32_t *sorted)
{
    for (int32_t i = 0; i <= n; i++) {
        start[i] = 0;
    }
    for (int32_t p = 0; p < entries; p++) {
        start[key[p] + 1]++;
    }
    for (int32_t i = 0; i < n; i++) {
        start[i + 1] += start[i];
    }
    for (int32_t k = 0; k < entries; k++) {
        const int32_t p = order != NULL ? order[k] : k;
        sorted[start[key[p]]++] = p;
    }
}

/* Entries by (head, tail) and by (tail, head): the k-th of one list is the reverse of the k-th of the other, and
 * parallel edges are paired in order. */
static sl_status pair_arcs(flow_network *net)
{
    sl_status status = SL_OK;
    const sl_graph *graph = net->graph;
    const int32_t entries = graph->first[graph->n];
    int32_t *start = sl_alloc((int64_t)graph->n + 1, sizeof *start);
    int32_t *by_head = sl_alloc(entries, sizeof *by_head), *by_tail = sl_alloc(entries, sizeof *by_tail);
    if (start == NULL || by_head == NULL || by_tail == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    for (int32_t i = 0; i < graph->n; i++) {
        for (int32_t p = graph->first[i]; p < graph->first[i + 1]; p++) {
            net->tail[p] = i;
        }
    }
    sort_entries(graph->n, entries, graph->adj, NULL, start, by_head);
    sort_entries(graph->n, entries, net->tail, by_head, start, by_tail);
    for (int32_t k = 0; k < entries; k++) {
        SL_ASSERT(net->tail[by_tail[k]] == graph->adj[by_head[k]] && net->tail[by_head[k]] == graph->adj[by_tail[k]]);
        net->reverse[by_tail[k]] = by_head[k];
    }
cleanup:
    sl_free(by_tail);
    sl_free(by_head);
    sl_free(start);
    return status;
}

/* Infinite capacities become more than all finite ones together, so that the arithmetic stays finite. */
static void fill_residuals(flow_network *net)
{
    const int32_t entries = net->graph->first[net->graph->n];
    double finite = 1.0;
    for (int32_t p = 0; p < entries; p++) {
        const double c = capacity(net->graph, p);
        SL_ASSERT(c >= 0.0);
        finite += c < HUGE_VAL ? c : 0.0;
    }
    for (int32_t p = 0; p < entries; p++) {
        const double c = capacity(net->graph, p);
        net->residual[p] = c < HUGE_VAL ? c : finite;
        net->threshold[p] = residual_rtol * net->residual[p];
    }
}

/* Whether flow can enter or leave node i other than among seeds of one sign. */
static bool is_active(const flow_network *net, int32_t i)
{
    bool active = net->seed[i] == 0;
    for (int32_t p = net->graph->first[i]; p < net->graph->first[i + 1] && !active; p++) {
        const int8_t other = net->seed[net->graph->adj[p]];
        active = other == 0 || (other > 0) != (net->seed[i] > 0);
    }
    return active;
}

/* Lists the active nodes: phases then cost what the band between the seeds costs, not the whole graph. */
static void find_active(flow_network *net)
{
    net->active_count = 0;
    for (int32_t i = 0; i < net->graph->n; i++) {
        net->level[i] = net->seed[i] < 0 ? 0 : -1;
        if (is_active(net, i)) {
            net->active[net->active_count++] = i;
        }
    }
}

/* Levels of the active nodes by a search from the negative seeds against the arcs, not through positive seeds: what
 * comes to one starts there as well. True if a positive seed was reached. */
static bool find_levels(flow_network *net)
{
    const sl_graph *graph = net->graph;
    int32_t tail = 0;
    bool reached = false;
    for (int32_t k = 0; k < net->active_count; k++) {
        const int32_t i = net->active[k];
        net->next[i] = graph->first[i];
        net->level[i] = net->seed[i] < 0 ? 0 : -1;
        if (net->seed[i] < 0) {
            net->queue[tail++] = i;
        }
    }
    for (int32_t head = 0; head < tail; head++) {
        const int32_t i = net->queue[head];
        for (int32_t p = graph->first[i]; p < graph->first[i + 1]; p++) {
            const int32_t j = graph->adj[p];
            if (net->level[j] < 0 && open_arc(net, net->reverse[p])) {
                net->level[j] = net->level[i] + 1;
                if (net->seed[j] > 0) {
                    reached = true;
                } else {
                    net->queue[tail++] = j;
                }
            }
        }
    }
    return reached;
}

/* The next open arc from node i one level down, -1 if there is none left in this phase. */
static int32_t useful_arc(flow_network *net, int32_t i)
{
    for (; net->next[i] < net->graph->first[i + 1]; net->next[i]++) {
        const int32_t p = net->next[i];
        if (net->level[net->graph->adj[p]] == net->level[i] - 1 && open_arc(net, p)) {
            return p;
        }
    }
    return -1;
}

/* Pushes the smallest residual along the path; returns the position of the first arc that became full. */
static int32_t augment(flow_network *net, const int32_t *path, int32_t length)
{
    double flow = HUGE_VAL;
    int32_t narrow = 0;
    for (int32_t k = 0; k < length; k++) {
        if (net->residual[path[k]] < flow) {
            flow = net->residual[path[k]];
            narrow = k;
        }
    }
    for (int32_t k = 0; k < length; k++) {
        net->residual[path[k]] -= flow;
        net->residual[net->reverse[path[k]]] += flow;
    }
    return narrow;
}

/* All augmenting paths from one positive seed along falling levels. Every round fills an arc or uses one up (next[] or
 * a level), so it ends in exact and in rounded arithmetic alike. */
static void block_from(flow_network *net, int32_t source)
{
    int32_t *path = net->queue, length = 0, i = source;
    for (;;) {
        if (net->level[i] == 0) {
            length = augment(net, path, length);
            i = net->tail[path[length]];
            continue;
        }
        const int32_t p = useful_arc(net, i);
        if (p >= 0) {
            path[length++] = p;
            i = net->graph->adj[p];
        } else if (length > 0) {
            i = net->tail[path[--length]];
            net->next[i]++; /* leads nowhere in this phase */
        } else {
            return;
        }
    }
}

/* The smallest positive side: what the positive seeds still reach. */
static void reachable_side(flow_network *net, uint8_t *side)
{
    const sl_graph *graph = net->graph;
    int32_t tail = 0;
    for (int32_t i = 0; i < graph->n; i++) {
        side[i] = net->seed[i] > 0;
        if (side[i]) {
            net->queue[tail++] = i;
        }
    }
    for (int32_t head = 0; head < tail; head++) {
        const int32_t i = net->queue[head];
        for (int32_t p = graph->first[i]; p < graph->first[i + 1]; p++) {
            if (!side[graph->adj[p]] && open_arc(net, p)) {
                side[graph->adj[p]] = 1;
                net->queue[tail++] = graph->adj[p];
            }
        }
    }
}

static double cut_capacity(const flow_network *net, const uint8_t *side)
{
    double sum = 0.0;
    for (int32_t p = 0; p < net->graph->first[net->graph->n]; p++) {
        if (side[net->tail[p]] && !side[net->graph->adj[p]]) {
            sum += capacity(net->graph, p);
        }
    }
    return sum;
}

static sl_status network_create(const sl_graph *graph, const int8_t *seed, flow_network *net)
{
    const int64_t n = graph->n, entries = graph->first[graph->n];
    *net = (flow_network){.graph = graph,
                          .seed = seed,
                          .reverse = sl_alloc(entries, sizeof *net->reverse),
                          .tail = sl_alloc(entries, sizeof *net->tail),
                          .residual = sl_alloc(entries, sizeof *net->residual),
                          .threshold = sl_alloc(entries, sizeof *net->threshold),
                          .level = sl_alloc(n, sizeof *net->level),
                          .next = sl_alloc(n, sizeof *net->next),
                          .queue = sl_alloc(n, sizeof *net->queue),
                          .active = sl_alloc(n, sizeof *net->active)};
    if (net->reverse == NULL || net->tail == NULL || net->residual == NULL || net->threshold == NULL ||
        net->level == NULL || net->next == NULL || net->queue == NULL || net->active == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    fill_residuals(net);
    find_active(net);
    return pair_arcs(net);
}

static void network_clear(flow_network *net)
{
    sl_free(net->reverse);
    sl_free(net->tail);
    sl_free(net->residual);
    sl_free(net->threshold);
    sl_free(net->level);
    sl_free(net->next);
    sl_free(net->queue);
    sl_free(net->active);
}

sl_status sl_graph_min_cut(const sl_graph *graph, const int8_t *seed, uint8_t *side, double *value)
{
    sl_status status = SL_OK;
    flow_network net = {0};
    SL_TRY(network_create(graph, seed, &net));
    /* Each phase raises the lowest level of a positive seed: at most n phases. */
    for (int32_t phase = 0; phase < graph->n && find_levels(&net); phase++) {
        for (int32_t k = 0; k < net.active_count; k++) {
            if (seed[net.active[k]] > 0 && net.level[net.active[k]] > 0) {
                block_from(&net, net.active[k]);
            }
        }
    }
    reachable_side(&net, side);
    *value = cut_capacity(&net, side);
cleanup:
    network_clear(&net);
    return status;
}
