/* Where the vertices of a fine chart will come to lie, from the map of the coarse chart that it was carried over from.
 */
#include "optimize/decimate_internal.h"

#include "base/memory.h"
#include "geom/vec3.h"

#include <math.h>
#include <string.h>

typedef struct guessing {
    const sl_opt_state *coarse;
    const int32_t *vertex;
    sl_opt_state *fine;
    int32_t *home_chart, *home_vertex; /* fine nv: the coarse chart with this vertex inside, its number there; -1 */
    int32_t *votes;                    /* of the coarse charts */
    int32_t *near, *queue;             /* of a fine chart's vertices: the coarse chart's vertex nearest to them */
} guessing;

static void clear(guessing *g)
{
    sl_free(g->home_chart);
    sl_free(g->home_vertex);
    sl_free(g->votes);
    sl_free(g->near);
    sl_free(g->queue);
}

static sl_status init(guessing *g)
{
    const int32_t nv = g->fine->surface->patch->nv;
    int32_t most = 0;
    for (int64_t c = 0; c < g->fine->nchart; c++) {
        most = g->fine->chart[c].patch->nv > most ? g->fine->chart[c].patch->nv : most;
    }
    g->home_chart = sl_alloc(nv, sizeof *g->home_chart);
    g->home_vertex = sl_alloc(nv, sizeof *g->home_vertex);
    g->votes = sl_alloc(g->coarse->nchart, sizeof *g->votes);
    g->near = sl_alloc(most, sizeof *g->near);
    g->queue = sl_alloc(most, sizeof *g->queue);
    if (g->home_chart == NULL || g->home_vertex == NULL || g->votes == NULL || g->near == NULL || g->queue == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    memset(g->home_chart, 0xff, (size_t)nv * sizeof *g->home_chart);
    for (int32_t c = 0; c < g->coarse->nchart; c++) {
        const sl_patch *p = g->coarse->chart[c].patch;
        for (int32_t i = 0; i < p->nv; i++) {
            if (p->border[i] == 0) {
                const int32_t v = sl_opt_fine_vertex(g->coarse->surface, g->vertex, p->corner[p->outgoing[i]]);
                g->home_chart[v] = c;
                g->home_vertex[v] = i;
            }
        }
    }
    return SL_OK;
}

/* The surface's vertex that vertex i of a fine chart is. */
static int32_t whole_vertex(const guessing *g, const sl_patch *p, int32_t i)
{
    return g->fine->surface->patch->tri[p->corner[p->outgoing[i]]];
}

/* The coarse chart that most inner vertices are inside of, too; -1 = none. */
static int32_t match(const guessing *g, const sl_patch *p)
{
    int32_t best = 0;
    memset(g->votes, 0, (size_t)g->coarse->nchart * sizeof *g->votes);
    for (int32_t i = 0; i < p->nv; i++) {
        const int32_t c = p->border[i] == 0 ? g->home_chart[whole_vertex(g, p, i)] : -1;
        if (c >= 0) {
            g->votes[c]++;
            best = g->votes[c] > g->votes[best] ? c : best;
        }
    }
    return g->votes[best] > 0 ? best : -1;
}

static int32_t visit(const guessing *g, int32_t v, int32_t from, int32_t n)
{
    if (g->near[v] < 0) {
        g->near[v] = g->near[from];
        g->queue[n++] = v;
    }
    return n;
}

/* Breadth-first within the fine chart, so that no seam is crossed. */
static void find_nearest(const guessing *g, const sl_patch *p, int32_t chart)
{
    int32_t n = 0;
    for (int32_t i = 0; i < p->nv; i++) {
        const int32_t v = whole_vertex(g, p, i);
        g->near[i] = p->border[i] == 0 && g->home_chart[v] == chart ? g->home_vertex[v] : -1;
        if (g->near[i] >= 0) {
            g->queue[n++] = i;
        }
    }
    for (int32_t at = 0; at < n; at++) {
        const int32_t i = g->queue[at];
        int32_t h = p->outgoing[i];
        do {
            n = visit(g, p->tri[sl_corner_next(h)], i, n);
            n = visit(g, p->tri[sl_corner_prev(h)], i, n);
            h = p->twin[sl_corner_prev(h)];
        } while (h >= 0 && h != p->outgoing[i]);
    }
}

/* Where triangle t of the coarse chart, carried on beyond its edges, puts point x; how far that is from it. */
static double place(const guessing *g, const sl_opt_chart *chart, int32_t t, const double *x, double *uv)
{
    const double *xyz = g->fine->surface->patch->xyz, *q[3], *map[3];
    double e[3], f[3], r[3];
    for (int k = 0; k < 3; k++) {
        const int32_t c = 3 * t + k;
        q[k] = xyz + 3 * (int64_t)sl_opt_fine_vertex(g->coarse->surface, g->vertex, chart->patch->corner[c]);
        map[k] = chart->uv + 2 * (int64_t)chart->patch->tri[c];
    }
    sl_vec3_sub(q[1], q[0], e);
    sl_vec3_sub(q[2], q[0], f);
    sl_vec3_sub(x, q[0], r);
    const double ee = sl_vec3_dot(e, e), ef = sl_vec3_dot(e, f), ff = sl_vec3_dot(f, f);
    const double re = sl_vec3_dot(r, e), rf = sl_vec3_dot(r, f), det = ee * ff - ef * ef;
    if (!(det > 0.0)) {
        return HUGE_VAL;
    }
    const double s = (re * ff - rf * ef) / det, u = (rf * ee - re * ef) / det;
    double off = 0.0;
    for (int k = 0; k < 3; k++) {
        const double y = r[k] - s * e[k] - u * f[k];
        off += y * y;
    }
    const double out[3] = {fmin(s, 0.0), fmin(u, 0.0), fmin(1.0 - s - u, 0.0)};
    off += sl_vec3_dot(out, out) * fmax(ee, ff);
    for (int k = 0; k < 2; k++) {
        uv[k] = map[0][k] + s * (map[1][k] - map[0][k]) + u * (map[2][k] - map[0][k]);
    }
    return off;
}

/* From the best of the triangles around the nearest coarse vertex and of those beyond them. */
static void guess_vertex(const guessing *g, const sl_opt_chart *chart, int32_t nearest, const double *x, double *uv)
{
    const sl_patch *p = chart->patch;
    const double scale = g->fine->surface->unit / g->coarse->surface->unit;
    double least = HUGE_VAL, at[2] = {0.0, 0.0};
    int32_t h = p->outgoing[nearest];
    do {
        const int32_t beyond = p->twin[sl_corner_next(h)], t[2] = {h / 3, beyond >= 0 ? beyond / 3 : h / 3};
        for (int k = 0; k < 2; k++) {
            const double off = place(g, chart, t[k], x, at);
            if (off < least) {
                least = off;
                uv[0] = scale * at[0];
                uv[1] = scale * at[1];
            }
        }
        h = p->twin[sl_corner_prev(h)];
    } while (h >= 0 && h != p->outgoing[nearest]);
}

sl_status sl_opt_guess(const sl_opt_state *coarse, const int32_t *vertex, sl_opt_state *fine)
{
    guessing g = {.coarse = coarse, .vertex = vertex, .fine = fine};
    const sl_status status = init(&g);
    for (int64_t c = 0; c < fine->nchart && status == SL_OK; c++) {
        sl_opt_chart *chart = &fine->chart[c];
        const int32_t from = match(&g, chart->patch);
        if (from < 0) {
            continue;
        }
        find_nearest(&g, chart->patch, from);
        for (int32_t i = 0; i < chart->patch->nv; i++) {
            guess_vertex(&g, &coarse->chart[from], g.near[i], chart->patch->xyz + 3 * (int64_t)i,
                         chart->uv + 2 * (int64_t)i);
        }
    }
    clear(&g);
    return status;
}
