#include "param/sectors_flow_internal.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

static const double pi = 3.14159265358979323846;
static const double largest_total = 0x1p60; /* of all angles, in units */

enum { MOST_BITS = 40, SWEEPS = 12 };

/* Nodes: triangles 0 .. nt - 1, then sectors. Arcs: corners, from their triangle to their sector, of any capacity, and
 * back as far as they carry something. */
typedef struct network {
    const sl_patch *patch;
    const sl_sectors *sectors;
    int32_t nt, nodes;
    double unit;        /* [rad] */
    int32_t *of_corner; /* 3 nt: the sector of a corner, -1 = none: a way out */
    int64_t *carried;   /* 3 nt */
    int64_t *left;      /* nodes: what a triangle still has, what a sector still lacks */
    int32_t *level;     /* nodes: arcs to the nearest node that takes more, -1 = there is none */
    int32_t *next;      /* nodes: the first arc not yet found useless in this phase */
    int32_t *queue;     /* nodes of a search; corners of a path */
    bool emptying;      /* second stage: free corners take what is left, sectors are full */
} network;

static void network_clear(network *net)
{
    sl_free(net->of_corner);
    sl_free(net->carried);
    sl_free(net->left);
    sl_free(net->level);
    sl_free(net->next);
    sl_free(net->queue);
}

static sl_status network_init(network *net, const sl_patch *patch, const sl_sectors *sectors)
{
    const int64_t nodes = (int64_t)patch->nt + sectors->count, nc = 3 * (int64_t)patch->nt;
    *net = (network){.patch = patch, .sectors = sectors, .nt = patch->nt};
    if (nodes > INT32_MAX) {
        return SL_OUT_OF_MEMORY;
    }
    net->nodes = (int32_t)nodes;
    net->of_corner = sl_alloc(nc, sizeof *net->of_corner);
    net->carried = sl_calloc(nc, sizeof *net->carried);
    net->left = sl_calloc(nodes, sizeof *net->left);
    net->level = sl_alloc(nodes, sizeof *net->level);
    net->next = sl_alloc(nodes, sizeof *net->next);
    net->queue = sl_alloc(nodes, sizeof *net->queue);
    const bool failed = net->of_corner == NULL || net->carried == NULL || net->left == NULL || net->level == NULL ||
                        net->next == NULL || net->queue == NULL;
    return failed ? SL_OUT_OF_MEMORY : SL_OK;
}

/* False when a corner is in two sectors. */
static bool map_corners(network *net)
{
    memset(net->of_corner, -1, 3 * (size_t)net->nt * sizeof *net->of_corner);
    for (int32_t s = 0; s < net->sectors->count; s++) {
        for (int32_t p = net->sectors->first[s]; p < net->sectors->first[s + 1]; p++) {
            int32_t *of = &net->of_corner[net->sectors->corner[p]];
            if (*of >= 0) {
                return false;
            }
            *of = s;
        }
    }
    return true;
}

/* Supplies rounded up, demands down: rounding alone never starves a sector. */
static void set_amounts(network *net, double room)
{
    const sl_sectors *sectors = net->sectors;
    const double bits = floor(log2(largest_total / (pi * (net->nt + 1.0))));
    net->unit = exp2(-fmin(bits, MOST_BITS));
    for (int32_t t = 0; t < net->nt; t++) {
        double kept = 0.0;
        for (int k = 0; k < 3; k++) {
            const int32_t s = net->of_corner[3 * (int64_t)t + k];
            const double share = s < 0 ? room : sectors->theta[s] / (2.0 * (sectors->first[s + 1] - sectors->first[s]));
            kept += fmin(room, share);
        }
        net->left[t] = (int64_t)ceil((pi - kept) / net->unit);
    }
    for (int32_t s = 0; s < sectors->count; s++) {
        const int32_t size = sectors->first[s + 1] - sectors->first[s];
        const double kept = fmin(room, sectors->theta[s] / (2.0 * size)) * size;
        net->left[net->nt + s] = (int64_t)floor((sectors->theta[s] - kept) / net->unit);
    }
}

/* Angles that nearly do it, so that little is left to push: each triangle's and each sector's scaled in turn. */
static void scale_sweep(const network *net, double *alpha)
{
    const sl_sectors *sectors = net->sectors;
    for (int32_t s = 0; s < sectors->count; s++) {
        double sum = 0.0;
        for (int32_t p = sectors->first[s]; p < sectors->first[s + 1]; p++) {
            sum += alpha[sectors->corner[p]];
        }
        for (int32_t p = sectors->first[s]; p < sectors->first[s + 1]; p++) {
            alpha[sectors->corner[p]] *= (double)net->left[net->nt + s] / sum;
        }
    }
    for (int32_t t = 0; t < net->nt; t++) {
        double *a = &alpha[3 * (int64_t)t];
        const double factor = (double)net->left[t] / (a[0] + a[1] + a[2]);
        for (int k = 0; k < 3; k++) {
            a[k] *= factor;
        }
    }
}

static sl_status start_flow(network *net)
{
    const int64_t nc = 3 * (int64_t)net->nt;
    double *alpha = sl_alloc(nc, sizeof *alpha);
    if (alpha == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int64_t c = 0; c < nc; c++) {
        alpha[c] = 1.0;
    }
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        scale_sweep(net, alpha);
    }
    for (int64_t c = 0; c < nc; c++) {
        const int32_t s = net->of_corner[c];
        int64_t *has = &net->left[c / 3], *lacks = s >= 0 ? &net->left[net->nt + s] : NULL;
        if (lacks != NULL && alpha[c] > 0.0) { /* false for a NaN */
            int64_t amount = alpha[c] < (double)*has ? (int64_t)alpha[c] : *has;
            amount = amount < *lacks ? amount : *lacks;
            net->carried[c] = amount;
            *has -= amount;
            *lacks -= amount;
        }
    }
    sl_free(alpha);
    return SL_OK;
}

/* Does the way end at this node in the present stage? */
static bool is_end(const network *net, int32_t node)
{
    if (!net->emptying || node >= net->nt) {
        return !net->emptying && node >= net->nt && net->left[node] > 0;
    }
    const int32_t *of = &net->of_corner[3 * (int64_t)node];
    return of[0] < 0 || of[1] < 0 || of[2] < 0;
}

/* Levels of all nodes from which an end can be reached; true if a triangle that has something left is among them. */
static bool search(network *net)
{
    const sl_sectors *sectors = net->sectors;
    int32_t count = 0;
    bool reached = false;
    for (int32_t i = 0; i < net->nodes; i++) {
        net->level[i] = is_end(net, i) ? 0 : -1;
        if (net->level[i] == 0) {
            net->queue[count++] = i;
        }
    }
    for (int32_t q = 0; q < count; q++) {
        const int32_t node = net->queue[q];
        if (node < net->nt) { /* from its sectors, as far as they can give back */
            reached = reached || net->left[node] > 0;
            for (int k = 0; k < 3; k++) {
                const int64_t c = 3 * (int64_t)node + k;
                const int32_t s = net->of_corner[c];
                if (s >= 0 && net->carried[c] > 0 && net->level[net->nt + s] < 0) {
                    net->level[net->nt + s] = net->level[node] + 1;
                    net->queue[count++] = net->nt + s;
                }
            }
            continue;
        }
        const int32_t s = node - net->nt;
        for (int32_t p = sectors->first[s]; p < sectors->first[s + 1]; p++) {
            const int32_t t = sectors->corner[p] / 3;
            if (net->level[t] < 0) {
                net->level[t] = net->level[node] + 1;
                net->queue[count++] = t;
            }
        }
    }
    return reached;
}

/* The corner that leads on from a node, one level down; -1 = none is left. */
static int32_t way_on(network *net, int32_t node)
{
    const sl_sectors *sectors = net->sectors;
    const bool triangle = node < net->nt;
    const int32_t begin = triangle ? 3 * node : sectors->first[node - net->nt];
    const int32_t count = triangle ? 3 : sectors->first[node - net->nt + 1] - begin;
    for (; net->next[node] < count; net->next[node]++) {
        const int32_t c = triangle ? begin + net->next[node] : sectors->corner[begin + net->next[node]];
        const int32_t to = triangle ? net->nt + net->of_corner[c] : c / 3;
        const bool open = triangle ? net->of_corner[c] >= 0 : net->carried[c] > 0;
        if (open && net->level[to] >= 0 && net->level[to] == net->level[node] - 1) {
            return c;
        }
    }
    return -1;
}

/* Pushes along the path queue[0 .. length - 1] of corners, forth and back in turn, from triangle `start` to `end`. */
static void push(network *net, int32_t start, int32_t end, int32_t length)
{
    int64_t amount = net->left[start];
    if (!net->emptying && net->left[end] < amount) {
        amount = net->left[end];
    }
    for (int32_t i = 1; i < length; i += 2) {
        const int64_t back = net->carried[net->queue[i]];
        amount = back < amount ? back : amount;
    }
    for (int32_t i = 0; i < length; i++) {
        net->carried[net->queue[i]] += i % 2 == 0 ? amount : -amount;
    }
    net->left[start] -= amount;
    if (!net->emptying) {
        net->left[end] -= amount;
    }
}

/* Pushes what triangle t has left along shortest ways, as long as there are any in this phase. */
static void empty_triangle(network *net, int32_t t)
{
    int32_t node = t, length = 0;
    while (net->left[t] > 0 && net->level[t] >= 0) {
        if (net->level[node] == 0) {
            if (is_end(net, node)) {
                push(net, t, node, length);
                node = t;
                length = 0;
                continue;
            }
        }
        const int32_t c = net->level[node] > 0 ? way_on(net, node) : -1;
        if (c >= 0) {
            net->queue[length++] = c;
            node = node < net->nt ? net->nt + net->of_corner[c] : c / 3;
            continue;
        }
        if (length == 0) {
            break;
        }
        const int32_t back = net->queue[--length]; /* a dead end: the arc that led here is done with */
        node = length % 2 == 0 ? back / 3 : net->nt + net->of_corner[back];
        net->next[node]++;
    }
}

/* Dinic's phases: each makes the shortest way longer, so there are at most as many as nodes. */
static void maximise(network *net)
{
    for (int32_t phase = 0; phase < net->nodes && search(net); phase++) {
        memset(net->next, 0, (size_t)net->nodes * sizeof *net->next);
        for (int32_t t = 0; t < net->nt; t++) {
            if (net->left[t] > 0 && net->level[t] >= 0) {
                empty_triangle(net, t);
            }
        }
    }
}

/* The sectors and triangles that a node in want depends on. Starved sector: those from which it could get something
 * more, along their triangles' arcs backwards. Overfull triangle: where it could put something. */
static void close_set(network *net, int32_t from, bool starved)
{
    const sl_sectors *sectors = net->sectors;
    int32_t count = 1;
    memset(net->level, -1, (size_t)net->nodes * sizeof *net->level);
    net->queue[0] = from;
    net->level[from] = 0;
    for (int32_t q = 0; q < count; q++) {
        const int32_t node = net->queue[q], s = node - net->nt;
        const bool triangle = node < net->nt;
        const int32_t begin = triangle ? 3 * node : sectors->first[s];
        const int32_t end = triangle ? begin + 3 : sectors->first[s + 1];
        for (int32_t p = begin; p < end; p++) {
            const int32_t c = triangle ? p : sectors->corner[p];
            const int32_t to = triangle ? net->nt + net->of_corner[c] : c / 3;
            const bool open = (triangle == starved ? net->carried[c] > 0 : true) && net->of_corner[c] >= 0;
            if (open && net->level[to] < 0) {
                net->level[to] = 0;
                net->queue[count++] = to;
            }
        }
    }
}

static sl_status report(network *net, int32_t from, bool starved, sl_sector_cut *out)
{
    const int32_t count = net->sectors->count;
    uint8_t *in_cut = sl_calloc(count, sizeof *in_cut);
    if (in_cut == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    close_set(net, from, starved);
    *out = (sl_sector_cut){.found = true, .starved = starved, .in_cut = in_cut};
    for (int32_t t = 0; t < net->nt; t++) {
        out->triangles += net->level[t] == 0;
    }
    for (int32_t s = 0; s < count; s++) {
        if (net->level[net->nt + s] == 0) {
            in_cut[s] = 1;
            out->sectors++;
            out->asked += net->sectors->theta[s];
        }
    }
    out->held = pi * out->triangles;
    return SL_OK;
}

/* The sector that lacks most, or the triangle that keeps most; -1 when rounding explains all that is left. */
static int32_t find_want(const network *net, bool starved)
{
    int64_t most = 0, sum = 0;
    int32_t worst = -1;
    for (int32_t i = starved ? net->nt : 0; i < (starved ? net->nodes : net->nt); i++) {
        sum += net->left[i];
        if (net->left[i] > most) {
            most = net->left[i];
            worst = i;
        }
    }
    return sum > (starved ? 0 : net->nodes) ? worst : -1;
}

sl_status sl_sectors_cut(const sl_patch *patch, const sl_sectors *sectors, double room, sl_sector_cut *out)
{
    sl_status status = SL_OK;
    network net;
    *out = (sl_sector_cut){.found = false};
    SL_TRY(network_init(&net, patch, sectors));
    if (!map_corners(&net)) {
        goto cleanup;
    }
    set_amounts(&net, room);
    SL_TRY(start_flow(&net));
    for (int stage = 0; stage < 2 && !out->found; stage++) {
        net.emptying = stage == 1;
        maximise(&net);
        const int32_t want = find_want(&net, stage == 0);
        if (want >= 0) {
            SL_TRY(report(&net, want, stage == 0, out));
        }
    }
cleanup:
    network_clear(&net);
    return status;
}
