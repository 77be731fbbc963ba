/* Parting: a chart whose map overlaps itself where it is stretched least is cut between the parts that lie on each
 * other. Darts do not help there: a border kept simple holds the map far from its minimum however much is cut. */
#include "optimize/optimize_internal.h"

#include "base/memory.h"
#include "graph/csr.h"
#include "overlap/certificate.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TEXELS = 192, ROUNDS = 16, SAMPLES = 16 };

static const double WORTH = 0.7; /* of a chart's loss, at most, without its border: else it is not parted */

/* Two triangles that share a texel. */
typedef struct meeting {
    int32_t a, b;
} meeting;

/* Where a chart lies on itself. */
typedef struct overlay {
    const sl_patch *patch;
    const double *uv;
    int32_t *owner;        /* TEXELS^2: the first triangle there, -1 = none */
    int32_t *part;         /* nt: connected part of the triangles that meet another, -1 = meets none */
    int32_t *queue, *ring; /* nt: breadth-first */
    meeting *pair;
    int64_t count, capacity;
    sl_graph dual;
    int8_t *seed; /* nt: +1, -1: to be parted; 0 = free */
    uint8_t *side;
} overlay;

static void overlay_clear(overlay *o)
{
    sl_free(o->owner);
    sl_free(o->part);
    sl_free(o->queue);
    sl_free(o->ring);
    sl_free(o->pair);
    sl_free(o->seed);
    sl_free(o->side);
    sl_graph_clear(&o->dual);
}

static sl_status overlay_init(const sl_opt_surface *surface, const sl_patch *p, const double *uv, overlay *o)
{
    const int64_t nt = p->nt;
    *o = (overlay){.patch = p,
                   .uv = uv,
                   .owner = sl_alloc((int64_t)TEXELS * TEXELS, sizeof *o->owner),
                   .part = sl_alloc(nt, sizeof *o->part),
                   .queue = sl_alloc(nt, sizeof *o->queue),
                   .ring = sl_alloc(nt, sizeof *o->ring),
                   .seed = sl_calloc(nt, sizeof *o->seed),
                   .side = sl_alloc(nt, sizeof *o->side)};
    sl_graph *g = &o->dual;
    g->n = p->nt;
    g->first = sl_calloc(nt + 1, sizeof *g->first);
    g->adj = sl_alloc(3 * nt, sizeof *g->adj);
    g->weight = sl_alloc(3 * nt, sizeof *g->weight);
    if (o->owner == NULL || o->part == NULL || o->queue == NULL || o->ring == NULL || o->seed == NULL ||
        o->side == NULL || g->first == NULL || g->adj == NULL || g->weight == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    int32_t n = 0;
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        g->first[c / 3] = c % 3 == 0 ? n : g->first[c / 3];
        if (p->twin[c] >= 0) {
            g->adj[n] = p->twin[c] / 3;
            g->weight[n++] = surface->cost[p->corner[c]];
        }
    }
    g->first[p->nt] = n;
    memset(o->owner, 0xff, (size_t)TEXELS * TEXELS * sizeof *o->owner);
    memset(o->part, 0xff, (size_t)nt * sizeof *o->part);
    return SL_OK;
}

/* Enters triangle t, of corners x[3], y[3] in texels, at the texels whose centres it holds. */
static sl_status enter(overlay *o, int32_t t, const double x[3], const double y[3])
{
    const int left = (int)fmax(ceil(fmin(x[0], fmin(x[1], x[2])) - 0.5), 0.0);
    const int right = (int)fmin(floor(fmax(x[0], fmax(x[1], x[2])) - 0.5), TEXELS - 1);
    const int low = (int)fmax(ceil(fmin(y[0], fmin(y[1], y[2])) - 0.5), 0.0);
    const int high = (int)fmin(floor(fmax(y[0], fmax(y[1], y[2])) - 0.5), TEXELS - 1);
    for (int j = low; j <= high; j++) {
        for (int i = left; i <= right; i++) {
            bool inside = true;
            for (int k = 0; k < 3; k++) {
                const int n = (k + 1) % 3;
                inside = inside && (x[n] - x[k]) * (j + 0.5 - y[k]) - (y[n] - y[k]) * (i + 0.5 - x[k]) > 0.0;
            }
            int32_t *owner = &o->owner[TEXELS * j + i];
            if (inside && *owner < 0) {
                *owner = t;
            } else if (inside) {
                const sl_status status = sl_reserve((void **)&o->pair, &o->capacity, o->count + 1, sizeof *o->pair);
                if (status != SL_OK) {
                    return status;
                }
                o->pair[o->count++] = (meeting){*owner, t};
            }
        }
    }
    return SL_OK;
}

static sl_status find_meetings(overlay *o)
{
    const sl_patch *p = o->patch;
    double lo[2] = {HUGE_VAL, HUGE_VAL}, hi[2] = {-HUGE_VAL, -HUGE_VAL};
    for (int32_t k = 0; k < 2 * p->nv; k++) {
        lo[k % 2] = fmin(lo[k % 2], o->uv[k]);
        hi[k % 2] = fmax(hi[k % 2], o->uv[k]);
    }
    const double size = fmax(hi[0] - lo[0], hi[1] - lo[1]);
    if (!(size > 0.0) || !isfinite(size)) {
        return SL_OK;
    }
    for (int32_t t = 0; t < p->nt; t++) {
        double x[3], y[3];
        for (int k = 0; k < 3; k++) {
            const double *at = o->uv + 2 * (int64_t)p->tri[3 * t + k];
            x[k] = TEXELS * (at[0] - lo[0]) / size;
            y[k] = TEXELS * (at[1] - lo[1]) / size;
        }
        const sl_status status = enter(o, t, x, y);
        if (status != SL_OK) {
            return status;
        }
    }
    return SL_OK;
}

/* Breadth-first from t with met_only over those whose part is -2; ring = distance.
 * Returns how many. */
static int32_t flood(overlay *o, int32_t t, bool met_only)
{
    int32_t n = 0;
    memset(o->ring, 0xff, (size_t)o->patch->nt * sizeof *o->ring);
    o->ring[t] = 0;
    o->queue[n++] = t;
    for (int32_t head = 0; head < n; head++) {
        const int32_t at = o->queue[head];
        for (int32_t k = o->dual.first[at]; k < o->dual.first[at + 1]; k++) {
            const int32_t next = o->dual.adj[k];
            if (o->ring[next] < 0 && (!met_only || o->part[next] == -2)) {
                o->ring[next] = o->ring[at] + 1;
                o->queue[n++] = next;
            }
        }
    }
    return n;
}

static void number_parts(overlay *o)
{
    int32_t parts = 0;
    for (int64_t k = 0; k < o->count; k++) {
        o->part[o->pair[k].a] = o->part[o->pair[k].b] = -2;
    }
    for (int32_t t = 0; t < o->patch->nt; t++) {
        if (o->part[t] == -2) {
            const int32_t n = flood(o, t, true);
            for (int32_t k = 0; k < n; k++) {
                o->part[o->queue[k]] = parts;
            }
            parts++;
        }
    }
}

static int by_triangles(const void *x, const void *y)
{
    const meeting *p = x, *q = y;
    return p->a != q->a ? (p->a > q->a) - (p->a < q->a) : (p->b > q->b) - (p->b < q->b);
}

/* The two parts that meet in most texels; false where parts meet themselves alone. */
static sl_status seed_parts(overlay *o, bool *seeded)
{
    meeting best = {-1, -1};
    int64_t most = 0, run = 0, n = 0;
    meeting *between = sl_alloc(o->count, sizeof *between);
    if (between == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int64_t k = 0; k < o->count; k++) {
        const int32_t a = o->part[o->pair[k].a], b = o->part[o->pair[k].b];
        if (a != b) {
            between[n++] = a < b ? (meeting){a, b} : (meeting){b, a};
        }
    }
    if (n > 1) {
        qsort(between, (size_t)n, sizeof *between, by_triangles);
    }
    for (int64_t k = 0; k < n; k++) {
        run = k > 0 && by_triangles(&between[k - 1], &between[k]) == 0 ? run + 1 : 1;
        best = run > most ? between[k] : best;
        most = run > most ? run : most;
    }
    *seeded = n > 0;
    for (int32_t t = 0; t < o->patch->nt && *seeded; t++) {
        o->seed[t] = o->part[t] == best.a ? 1 : o->part[t] == best.b ? -1 : 0;
    }
    sl_free(between);
    return SL_OK;
}

/* A part on itself, as where a fan closes: the two triangles that meet and are farthest apart on the chart, and what is
 * within a third of the way around each. */
static void seed_farthest(overlay *o)
{
    meeting best = o->pair[0];
    int32_t most = -1;
    for (int64_t s = 0; s < SAMPLES; s++) {
        const meeting pair = o->pair[s * o->count / SAMPLES];
        (void)flood(o, pair.a, false);
        if (o->ring[pair.b] > most) {
            most = o->ring[pair.b];
            best = pair;
        }
    }
    const int32_t end[2] = {best.a, best.b};
    for (int side = 0; side < 2; side++) {
        const int32_t n = flood(o, end[side], false);
        for (int32_t k = 0; k < n; k++) {
            if (3 * o->ring[o->queue[k]] <= most) {
                o->seed[o->queue[k]] = side == 0 ? 1 : -1;
            }
        }
    }
}

/* An overlap of less than a texel: the triangles at the first two border edges that cross. */
static sl_status seed_crossing(overlay *o, bool *seeded)
{
    sl_certificate certificate = {0};
    int32_t *first = NULL, *halfedge = NULL;
    sl_status status = sl_opt_certify(o->patch, o->uv, &certificate);
    *seeded = false;
    if (status == SL_OK && certificate.border_crossings > 0) {
        SL_TRY(sl_patch_border(o->patch, &first, &halfedge));
        const int32_t a = halfedge[certificate.first_edge[0]] / 3, b = halfedge[certificate.first_edge[1]] / 3;
        *seeded = a != b;
        o->seed[a] = 1;
        o->seed[b] = -1;
    }
cleanup:
    sl_free(first);
    sl_free(halfedge);
    return status == SL_BAD_INPUT ? SL_OK : status;
}

static sl_status seed(overlay *o, bool *seeded)
{
    sl_status status = SL_OK;
    SL_TRY(find_meetings(o));
    if (o->count == 0) {
        return seed_crossing(o, seeded);
    }
    number_parts(o);
    SL_TRY(seed_parts(o, seeded));
    if (!*seeded) {
        seed_farthest(o);
        *seeded = true;
    }
cleanup:
    return status;
}

/* Appends the edges of the shortest cut between parts of the chart that lie on each other; none where only a polygon
 * could be cut through. */
static sl_status part_chart(const sl_opt_surface *surface, const sl_opt_chart *chart, sl_opt_trial *trial)
{
    sl_status status = SL_OK;
    const sl_patch *p = chart->patch;
    overlay o = {0};
    bool seeded;
    double value;
    SL_TRY(overlay_init(surface, p, chart->uv, &o));
    SL_TRY(seed(&o, &seeded));
    if (!seeded) {
        goto cleanup;
    }
    SL_TRY(sl_graph_min_cut(&o.dual, o.seed, o.side, &value));
    for (int32_t c = 0; c < 3 * p->nt && value < HUGE_VAL; c++) {
        if (p->twin[c] > c && o.side[c / 3] != o.side[p->twin[c] / 3]) {
            trial->edge[trial->nedge++] = p->corner[c];
        }
    }
cleanup:
    overlay_clear(&o);
    return status;
}

static void forget_charts(sl_opt_trial *trial)
{
    for (int32_t k = 0; trial->to != NULL && k < trial->nto; k++) {
        sl_opt_chart_clear(&trial->to[k]);
    }
    sl_free(trial->to);
    trial->to = NULL;
    trial->nto = 0;
}

/* Lays the trial's charts flat and cuts those that overlap; *again = edges were added. */
static sl_status part_round(const sl_opt_state *state, sl_opt_trial *trial, bool *again)
{
    sl_status status = SL_OK;
    const int32_t before = trial->nedge;
    SL_TRY(sl_opt_trial_make(state, trial));
    trial->settled = trial->valid;
    trial->loss = 0.0;
    for (int32_t k = 0; k < trial->nto && trial->valid; k++) {
        sl_opt_chart *chart = &trial->to[k];
        bool embedded;
        SL_TRY(sl_opt_solve(state, chart->patch, SL_OPT_SEWN, chart->uv, &embedded));
        if (!embedded) {
            trial->settled = false;
            SL_TRY(part_chart(state->surface, chart, trial));
        }
        sl_opt_measure(state->surface, chart->patch, chart->uv, &chart->sums, NULL);
        trial->loss += sl_opt_loss(state, &chart->sums);
    }
    *again = trial->nedge > before;
    trial->valid = trial->settled;
cleanup:
    return status;
}

sl_status sl_opt_part(const sl_opt_state *state, int32_t c, sl_opt_trial *trial)
{
    sl_status status = SL_OK;
    const int64_t edges = 3 * (int64_t)state->chart[c].patch->nt / 2 + 1;
    const double before = sl_opt_loss(state, &state->chart[c].sums);
    bool again = true;
    *trial = (sl_opt_trial){.old = {c, -1}, .edge = sl_alloc(edges, sizeof *trial->edge)};
    SL_TRY(trial->edge == NULL ? SL_OUT_OF_MEMORY : SL_OK);
    for (int k = 0; k < ROUNDS && again; k++) {
        forget_charts(trial);
        SL_TRY(part_round(state, trial, &again));
        if (k == 0 && trial->loss > WORTH * before) {
            break; /* it is not the border that holds this one back */
        }
    }
    trial->valid = trial->valid && !again && trial->nedge > 0;
    if (!trial->valid) {
        forget_charts(trial); /* they may lack the last cuts */
    }
cleanup:
    return status;
}
