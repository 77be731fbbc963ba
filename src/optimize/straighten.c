/* Straightening: parts of seams give way to cheaper ways between the same ends, where the targets stay met. */
#include "optimize/ways_internal.h"

#include "base/memory.h"
#include "geom/predicates.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double LEAST_SAVING = 0.01; /* of a part's cost */
static const double WORTH_COLD = 0.02; /* saving over the surface's unit for which a chart is laid flat from nothing */
static const int32_t LEAST_EDGES = 3;  /* of a part */
enum { MOST_TRIALS = 12, SWEEPS = 20, MOST_COLD = 3 }; /* a pass; over facets that change sides */

/* Shares of an arc between which it is laid anew, pass by pass; a closed arc is no part of itself. */
static const double PART[][2] = {{0.0, 1.0}, {0.0, 0.5}, {0.5, 1.0}, {0.25, 0.75}};
static const int32_t FIRST_PART[] = {0, 1, 3, 4};
static const double REACH[] = {0.07, 0.06, 0.03}; /* of a way from the old part, over the surface's unit */
enum { PASSES = 3 };

/* A part of a seam and the way that shall take its place. */
typedef struct detour {
    int32_t *old, *way; /* halfedges, one after another */
    int32_t nold, nway;
    int32_t chart[2]; /* beside it, ascending */
    double saving;
} detour;

typedef struct straightening {
    sl_opt_state *state;
    sl_opt_ways ways;
    detour *list;
    int64_t count, capacity;
    int32_t trials, cold; /* done in this pass; charts that may still be laid flat from nothing */
} straightening;

static void clear_detours(straightening *s)
{
    for (int64_t k = 0; k < s->count; k++) {
        sl_free(s->list[k].old);
        sl_free(s->list[k].way);
    }
    s->count = 0;
}

static void straightening_clear(straightening *s)
{
    clear_detours(s);
    sl_free(s->list);
    sl_opt_ways_clear(&s->ways);
}

/* The vertices between the ends of a way. */
static void mark(straightening *s, const int32_t *way, int32_t n, uint8_t value)
{
    for (int32_t k = 1; k < n; k++) {
        s->ways.taken[s->state->surface->patch->tri[way[k]]] = value;
    }
}

/* Looks for a cheaper way for old[0 .. n - 1]; its vertices are taken from then on, so that no two meet. */
static sl_status add_detour(straightening *s, const int32_t *old, int32_t n, double reach)
{
    sl_status status = SL_OK;
    const sl_patch *p = s->state->surface->patch;
    const int32_t a = s->state->chart_of[old[0] / 3], b = s->state->chart_of[p->twin[old[0]] / 3];
    const int32_t start = p->tri[old[0]], goal = p->tri[sl_corner_next(old[n - 1])];
    if (n < LEAST_EDGES || start == goal) {
        return SL_OK;
    }
    const double cost = sl_opt_way_cost(&s->ways, old, n);
    detour d = {.nold = n, .chart = {a < b ? a : b, a < b ? b : a}};
    SL_TRY(sl_reserve((void **)&s->list, &s->capacity, s->count + 1, sizeof *s->list));
    d.old = sl_copy(old, n, sizeof *old);
    d.way = sl_alloc(3 * (int64_t)p->nt, sizeof *d.way);
    SL_TRY(d.old == NULL || d.way == NULL ? SL_OUT_OF_MEMORY : SL_OK);
    mark(s, old, n, 0);
    SL_TRY(sl_opt_way_find(&s->ways, old, n, reach, d.chart, (1.0 - LEAST_SAVING) * cost, d.way, &d.nway));
    mark(s, old, n, 1);
    if (d.nway > 0) {
        mark(s, d.way, d.nway, 1);
        d.saving = cost - sl_opt_way_cost(&s->ways, d.way, d.nway);
        int32_t *shorter = sl_copy(d.way, d.nway, sizeof *shorter);
        SL_TRY(shorter == NULL ? SL_OUT_OF_MEMORY : SL_OK);
        sl_free(d.way);
        d.way = shorter;
        s->list[s->count++] = d;
        d = (detour){0};
    }
cleanup:
    sl_free(d.old);
    sl_free(d.way);
    return status;
}

/* The part of an arc between two shares of its edges. */
static sl_status add_part(straightening *s, const int32_t *arc, int32_t n, const double share[2], double reach)
{
    const int32_t from = (int32_t)(share[0] * n), to = (int32_t)(share[1] * n);
    return to > from ? add_detour(s, arc + from, to - from, reach) : SL_OK;
}

static sl_status list_detours(straightening *s, int pass)
{
    sl_status status = SL_OK;
    sl_opt_arcs arcs = {0};
    clear_detours(s);
    sl_opt_ways_clear(&s->ways);
    SL_TRY(sl_opt_ways_init(s->state, &s->ways));
    SL_TRY(sl_opt_arcs_init(s->state, &arcs));
    for (int32_t k = 0; k < arcs.count; k++) {
        for (int32_t j = FIRST_PART[pass]; j < FIRST_PART[pass + 1]; j++) {
            const int32_t *arc = arcs.halfedge + arcs.first[k];
            SL_TRY(add_part(s, arc, arcs.first[k + 1] - arcs.first[k], PART[j], REACH[pass] * s->state->surface->unit));
        }
    }
cleanup:
    sl_opt_arcs_clear(&arcs);
    return status;
}

/* Edges of the old part that the way leaves are sewn, those that are new cut. sewn: 3 nt, zero before and after. */
static sl_status make_edges(const sl_opt_state *state, detour *const *list, int32_t n, uint8_t *mark_of,
                            sl_opt_trial *trial)
{
    const int32_t *twin = state->surface->patch->twin;
    int64_t total = 0;
    for (int32_t k = 0; k < n; k++) {
        total += list[k]->nold + list[k]->nway;
    }
    trial->edge = sl_alloc(total, sizeof *trial->edge);
    if (trial->edge == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t k = 0; k < n; k++) {
        for (int32_t j = 0; j < list[k]->nway; j++) {
            mark_of[list[k]->way[j]] = mark_of[twin[list[k]->way[j]]] = 1;
        }
        for (int32_t j = 0; j < list[k]->nold; j++) {
            const int32_t h = list[k]->old[j];
            if (mark_of[h] == 0) {
                trial->edge[trial->nedge++] = h;
            }
        }
    }
    trial->nback = trial->nedge;
    for (int32_t k = 0; k < n; k++) {
        for (int32_t j = 0; j < list[k]->nway; j++) {
            const int32_t h = list[k]->way[j];
            mark_of[h] = mark_of[twin[h]] = 0;
            if (state->cut[h] == 0) {
                trial->edge[trial->nedge++] = h;
            }
        }
    }
    return SL_OK;
}

/* Facets between the old parts and the ways change sides: they are what both enclose. */
typedef struct region {
    uint8_t *moved;   /* nt */
    uint8_t *barrier; /* 3 nt: 1 = a seam that stays, 2 = old or new */
    int32_t *list;    /* nt */
} region;

static void region_clear(region *r)
{
    sl_free(r->moved);
    sl_free(r->barrier);
    sl_free(r->list);
}

/* Grows the part of triangle t, in r->list; returns its size, 0 where a seam that stays bounds it. */
static int32_t grow(const sl_opt_state *state, region *r, int32_t t)
{
    const int32_t *twin = state->surface->patch->twin;
    int32_t n = 0;
    bool enclosed = true;
    r->moved[t] = 2;
    r->list[n++] = t;
    for (int32_t at = 0; at < n; at++) {
        for (int32_t h = 3 * r->list[at]; h < 3 * r->list[at] + 3; h++) {
            const bool open = twin[h] >= 0 && r->barrier[h] == 0;
            enclosed = enclosed && twin[h] >= 0 && r->barrier[h] != 1;
            if (open && r->moved[twin[h] / 3] == 0) {
                r->moved[twin[h] / 3] = 2;
                r->list[n++] = twin[h] / 3;
            }
        }
    }
    return enclosed ? n : 0;
}

/* moved: 1 = changes sides, 2 = stays. Of the parts of a chart the largest stays in any case: where a chart's whole
 * border is laid anew, both it and the strip are enclosed. */
static sl_status find_moved(const sl_opt_state *state, const sl_opt_trial *trial, region *r)
{
    const sl_patch *p = state->surface->patch;
    r->moved = sl_calloc(p->nt, sizeof *r->moved);
    r->barrier = sl_copy(state->cut, 3 * (int64_t)p->nt, sizeof *r->barrier);
    r->list = sl_alloc(p->nt, sizeof *r->list);
    if (r->moved == NULL || r->barrier == NULL || r->list == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t k = 0; k < trial->nedge; k++) {
        r->barrier[trial->edge[k]] = r->barrier[p->twin[trial->edge[k]]] = 2;
    }
    for (int32_t j = 0; j < 2; j++) {
        const sl_patch *chart = trial->old[j] >= 0 ? state->chart[trial->old[j]].patch : NULL;
        for (int32_t i = 0; chart != NULL && i < chart->nt; i++) {
            if (r->moved[chart->facet[i]] == 0) {
                const int32_t n = grow(state, r, chart->facet[i]);
                for (int32_t k = 0; k < n && 2 * n < chart->nt; k++) {
                    r->moved[r->list[k]] = 1;
                }
            }
        }
    }
    return SL_OK;
}

/* Where corner k of triangle i of the chart belongs beside its other two, similar to its shape in space. */
static void lay_corner(const sl_opt_surface *s, const sl_opt_chart *chart, int32_t i, int32_t k, double out[2])
{
    const double *r = s->rest + 3 * (int64_t)chart->patch->facet[i];
    const double rest[3][2] = {{0.0, 0.0}, {r[0], 0.0}, {r[1], r[2]}};
    const int32_t a = (k + 1) % 3, b = (k + 2) % 3, *tri = chart->patch->tri + 3 * (int64_t)i;
    const double *p = chart->uv + 2 * (int64_t)tri[a], *q = chart->uv + 2 * (int64_t)tri[b];
    const double e[2] = {rest[b][0] - rest[a][0], rest[b][1] - rest[a][1]};
    const double f[2] = {rest[k][0] - rest[a][0], rest[k][1] - rest[a][1]};
    const double u[2] = {q[0] - p[0], q[1] - p[1]}, square = fmax(e[0] * e[0] + e[1] * e[1], 1e-300);
    const double dot = (f[0] * e[0] + f[1] * e[1]) / square, cross = (f[1] * e[0] - f[0] * e[1]) / square;
    out[0] = p[0] + dot * u[0] - cross * u[1];
    out[1] = p[1] + dot * u[1] + cross * u[0];
}

/* Moves the vertices that were laid (known = 2) to where their triangles want them in the mean,
 * again and again: what was unrolled from both ends of a strip meets. */
static sl_status settle_moved(const sl_opt_surface *s, const sl_opt_chart *chart, const uint8_t *known)
{
    const sl_patch *p = chart->patch;
    double *sum = sl_alloc(3 * (int64_t)p->nv, sizeof *sum);
    if (sum == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        memset(sum, 0, 3 * (size_t)p->nv * sizeof *sum);
        for (int32_t c = 0; c < 3 * p->nt; c++) {
            if (known[p->tri[c]] == 2) {
                double place[2], *mean = sum + 3 * (int64_t)p->tri[c];
                lay_corner(s, chart, c / 3, c % 3, place);
                mean[0] += place[0];
                mean[1] += place[1];
                mean[2] += 1.0;
            }
        }
        for (int32_t v = 0; v < p->nv; v++) {
            if (known[v] == 2) {
                chart->uv[2 * (int64_t)v] = sum[3 * (int64_t)v] / sum[3 * (int64_t)v + 2];
                chart->uv[2 * (int64_t)v + 1] = sum[3 * (int64_t)v + 1] / sum[3 * (int64_t)v + 2];
            }
        }
    }
    sl_free(sum);
    return SL_OK;
}

static bool has_flips(const sl_opt_chart *chart)
{
    const int32_t *tri = chart->patch->tri;
    for (int32_t t = 0; t < chart->patch->nt; t++) {
        const double *a = chart->uv + 2 * (int64_t)tri[3 * t], *b = chart->uv + 2 * (int64_t)tri[3 * t + 1];
        if (sl_orient2d(a, b, chart->uv + 2 * (int64_t)tri[3 * t + 2]) <= 0) {
            return true;
        }
    }
    return false;
}

/* UVs of a chart that comes of the trial: facets that stay keep theirs, the others are unrolled from them, one after
 * another. *laid = false where they cannot be reached, or lie turned over. */
static sl_status lay_chart(const sl_opt_state *state, const region *r, sl_opt_chart *chart, bool *laid)
{
    const sl_patch *p = chart->patch;
    uint8_t *known = sl_calloc(p->nv, sizeof *known);
    int32_t unknown = p->nv;
    if (known == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        if (r->moved[p->facet[c / 3]] != 1) {
            memcpy(chart->uv + 2 * (int64_t)p->tri[c], state->uv + 2 * (int64_t)p->corner[c], 2 * sizeof *chart->uv);
            unknown -= known[p->tri[c]] == 0;
            known[p->tri[c]] = 1;
        }
    }
    for (int32_t before = unknown + 1; unknown > 0 && unknown < before;) {
        before = unknown;
        for (int32_t c = 0; c < 3 * p->nt && unknown > 0; c++) {
            const int32_t a = p->tri[sl_corner_next(c)], b = p->tri[sl_corner_prev(c)];
            if (known[p->tri[c]] == 0 && known[a] != 0 && known[b] != 0) {
                lay_corner(state->surface, chart, c / 3, c % 3, chart->uv + 2 * (int64_t)p->tri[c]);
                known[p->tri[c]] = 2;
                unknown--;
            }
        }
    }
    *laid = unknown == 0;
    sl_status status = SL_OK;
    if (*laid && has_flips(chart)) {
        status = settle_moved(state->surface, chart, known);
    }
    *laid = *laid && !has_flips(chart);
    sl_free(known);
    return status;
}

/* From the UVs laid; where that cannot be and *cold is left, from nothing. */
static sl_status solve_chart(const sl_opt_state *state, const region *r, int32_t *cold, sl_opt_chart *chart,
                             bool *embedded)
{
    sl_status status = SL_OK;
    bool laid = false;
    *embedded = false;
    SL_TRY(lay_chart(state, r, chart, &laid));
    if (laid) {
        SL_TRY(sl_opt_solve(state, chart->patch, SL_OPT_WARM_ONLY, chart->uv, embedded));
    } else if (*cold > 0) {
        (*cold)--;
        SL_TRY(sl_opt_solve(state, chart->patch, SL_OPT_COLD, chart->uv, embedded));
    }
    sl_opt_measure(state->surface, chart->patch, chart->uv, &chart->sums, NULL);
cleanup:
    return status;
}

/* Are all edges beside the charts that are made anew? An earlier success may have put a detour's into another. */
static bool is_beside(const sl_opt_state *state, const sl_opt_trial *trial)
{
    for (int32_t k = 0; k < trial->nedge; k++) {
        const int32_t side[2] = {trial->edge[k], state->surface->patch->twin[trial->edge[k]]};
        for (int j = 0; j < 2; j++) {
            const int32_t c = state->chart_of[side[j] / 3];
            if (c != trial->old[0] && c != trial->old[1]) {
                return false;
            }
        }
    }
    return true;
}

/* Solves the trial of some detours beside the same two charts; trial->valid = embedded. */
static sl_status make_trial(const sl_opt_state *state, detour *const *list, int32_t n, int32_t *cold,
                            sl_opt_trial *trial)
{
    sl_status status = SL_OK;
    region r = {0};
    const int32_t *chart = list[0]->chart;
    uint8_t *mark_of = sl_calloc(3 * (int64_t)state->surface->patch->nt, sizeof *mark_of);
    SL_TRY(mark_of == NULL ? SL_OUT_OF_MEMORY : SL_OK);
    trial->old[0] = chart[0];
    trial->old[1] = chart[1] != chart[0] ? chart[1] : -1;
    SL_TRY(make_edges(state, list, n, mark_of, trial));
    if (!is_beside(state, trial)) {
        goto cleanup;
    }
    SL_TRY(sl_opt_trial_make(state, trial));
    SL_TRY(find_moved(state, trial, &r));
    trial->valid = trial->valid && trial->nto == (trial->old[1] >= 0 ? 2 : 1);
    for (int32_t k = 0; k < trial->nto && trial->valid; k++) {
        SL_TRY(solve_chart(state, &r, cold, &trial->to[k], &trial->valid));
    }
cleanup:
    region_clear(&r);
    sl_free(mark_of);
    return status;
}

/* Leave to sew moves with the seam. */
static void move_keep(sl_opt_state *state, detour *const *list, int32_t n)
{
    const int32_t *twin = state->surface->patch->twin;
    for (int32_t k = 0; k < n; k++) {
        const uint8_t keep = state->keep[list[k]->old[0]];
        for (int32_t j = 0; j < list[k]->nold; j++) {
            state->keep[list[k]->old[j]] = state->keep[twin[list[k]->old[j]]] = 0;
        }
        for (int32_t j = 0; j < list[k]->nway; j++) {
            state->keep[list[k]->way[j]] = state->keep[twin[list[k]->way[j]]] = keep;
        }
    }
}

/* Tries the detours together, and where that does not hold, each half of them. Numbers of charts may change, so what
 * comes after a success is found again by the edges. */
static sl_status try_group(straightening *s, detour **list, int32_t n, bool *progress)
{
    sl_status status = SL_OK;
    sl_opt_trial trial = {0};
    double now, then, mean;
    if (n == 0 || s->trials >= MOST_TRIALS) {
        return SL_OK;
    }
    s->trials++;
    for (int32_t k = 0; k < n; k++) {
        const int32_t h = list[k]->old[0], g = s->state->surface->patch->twin[h];
        const int32_t a = s->state->chart_of[h / 3], b = s->state->chart_of[g / 3];
        list[k]->chart[0] = a < b ? a : b;
        list[k]->chart[1] = a < b ? b : a;
    }
    double saving = 0.0;
    for (int32_t k = 0; k < n; k++) {
        saving += list[k]->saving;
    }
    int32_t none = 0;
    const bool worth = saving > WORTH_COLD * s->state->surface->unit;
    SL_TRY(make_trial(s->state, list, n, worth ? &s->cold : &none, &trial));
    sl_opt_shares(s->state, NULL, &now, &mean);
    sl_opt_shares(s->state, &trial, &then, &mean);
    s->state->info.trials++;
    if (then <= fmax(now, 1.0)) {
        move_keep(s->state, list, n);
        SL_TRY(sl_opt_apply(s->state, &trial));
        s->state->info.straightened += n;
        *progress = true;
    } else if (n > 1) {
        SL_TRY(try_group(s, list, n / 2, progress));
        SL_TRY(try_group(s, list + n / 2, n - n / 2, progress));
    }
cleanup:
    sl_opt_trial_clear(&trial);
    return status;
}

/* Detours beside the same charts, the most saving first. */
static int by_charts(const void *x, const void *y)
{
    const detour *a = *(detour *const *)x, *b = *(detour *const *)y;
    for (int j = 0; j < 2; j++) {
        if (a->chart[j] != b->chart[j]) {
            return a->chart[j] < b->chart[j] ? -1 : 1;
        }
    }
    if (a->saving != b->saving) {
        return a->saving > b->saving ? -1 : 1;
    }
    return (a->old[0] > b->old[0]) - (a->old[0] < b->old[0]);
}

static sl_status try_all(straightening *s, bool *progress)
{
    sl_status status = SL_OK;
    const int32_t n = (int32_t)s->count;
    detour **order = sl_alloc(n, sizeof(detour *));
    SL_TRY(order == NULL ? SL_OUT_OF_MEMORY : SL_OK);
    for (int32_t k = 0; k < n; k++) {
        order[k] = &s->list[k];
    }
    if (n > 1) {
        qsort(order, (size_t)n, sizeof(detour *), by_charts);
    }
    for (int32_t first = 0, end; first < n; first = end) {
        const int32_t chart[2] = {order[first]->chart[0], order[first]->chart[1]};
        for (end = first; end < n && order[end]->chart[0] == chart[0] && order[end]->chart[1] == chart[1]; end++) {
        }
        SL_TRY(try_group(s, order + first, end - first, progress));
    }
cleanup:
    sl_free(order);
    return status;
}

sl_status sl_opt_straighten(sl_opt_state *state)
{
    sl_status status = SL_OK;
    straightening s = {.state = state, .cold = MOST_COLD};
    for (int pass = 0; pass < PASSES; pass++) {
        bool progress = false;
        s.trials = 0;
        SL_TRY(list_detours(&s, pass));
        SL_TRY(try_all(&s, &progress));
    }
cleanup:
    straightening_clear(&s);
    return status;
}
