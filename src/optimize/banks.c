/* The map that a sewing starts from: the banks of the window are drawn together, and what lies behind them follows,
 * less and less with the distance, so that no triangle need flip. */
#include "optimize/optimize_internal.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

static const double REACH = 5.0; /* of the widest gap: how far behind the banks the surface follows */
enum { FEWEST_RINGS = 2, MOST_RINGS = 30, SWEEPS = 2 };

/* A chart that is sewn. Its vertices on the window have two places, one on each bank: those of their corners. */
typedef struct closing {
    const sl_patch *patch;
    double *corner; /* 3 nt x 2: places as they were, the second chart brought to the first */
    double *shift;  /* nv x 2: how far a vertex behind the banks moves */
    double *sum;    /* nv x 3: work */
    int32_t *ring;  /* nv: 0 = on the window, -1 = out of reach */
    int32_t *near;  /* triangles within reach */
    int32_t nnear;
    uint8_t *listed; /* nt */
    double gap;      /* the widest */
} closing;

static void closing_clear(closing *c)
{
    sl_free(c->corner);
    sl_free(c->shift);
    sl_free(c->sum);
    sl_free(c->ring);
    sl_free(c->near);
    sl_free(c->listed);
}

static sl_status closing_init(const sl_patch *patch, closing *c)
{
    const int64_t nt = patch->nt, nv = patch->nv;
    *c = (closing){.patch = patch,
                   .corner = sl_alloc(6 * nt, sizeof *c->corner),
                   .shift = sl_calloc(2 * nv, sizeof *c->shift),
                   .sum = sl_calloc(3 * nv, sizeof *c->sum),
                   .ring = sl_alloc(nv, sizeof *c->ring),
                   .near = sl_alloc(nt, sizeof *c->near),
                   .listed = sl_calloc(nt, sizeof *c->listed)};
    const bool ok = c->corner != NULL && c->shift != NULL && c->sum != NULL && c->ring != NULL && c->near != NULL &&
                    c->listed != NULL;
    return ok ? SL_OK : SL_OUT_OF_MEMORY;
}

static void gather_corners(const sl_opt_state *state, const sl_opt_trial *trial, const double motion[4], closing *c)
{
    const sl_patch *p = c->patch;
    for (int32_t k = 0; k < 3 * p->nt; k++) {
        const double *uv = state->uv + 2 * (int64_t)p->corner[k];
        const bool moves = trial->old[1] >= 0 && state->chart_of[p->facet[k / 3]] == trial->old[1];
        double *out = c->corner + 2 * (int64_t)k;
        out[0] = moves ? motion[0] * uv[0] - motion[1] * uv[1] + motion[2] : uv[0];
        out[1] = moves ? motion[1] * uv[0] + motion[0] * uv[1] + motion[3] : uv[1];
    }
}

/* Vertices to the mean of their corners' places; those whose corners disagree are the window's, ring 0. */
static void meet(closing *c, double *uv)
{
    const sl_patch *p = c->patch;
    for (int32_t k = 0; k < 3 * p->nt; k++) {
        double *at = c->sum + 3 * (int64_t)p->tri[k];
        at[0] += c->corner[2 * (int64_t)k];
        at[1] += c->corner[2 * (int64_t)k + 1];
        at[2] += 1.0;
    }
    for (int32_t v = 0; v < p->nv; v++) {
        uv[2 * (int64_t)v] = c->sum[3 * (int64_t)v] / c->sum[3 * (int64_t)v + 2];
        uv[2 * (int64_t)v + 1] = c->sum[3 * (int64_t)v + 1] / c->sum[3 * (int64_t)v + 2];
        c->ring[v] = -1;
    }
    for (int32_t k = 0; k < 3 * p->nt; k++) {
        const double *a = c->corner + 2 * (int64_t)k, *b = c->corner + 2 * (int64_t)p->outgoing[p->tri[k]];
        const double gap = hypot(a[0] - b[0], a[1] - b[1]);
        if (gap > 0.0) {
            c->ring[p->tri[k]] = 0;
            c->gap = fmax(c->gap, gap);
        }
    }
}

/* How far corner k moves: the banks' corners each their own way to the common place. */
static void shift_of(const closing *c, const double *uv, int32_t k, double out[2])
{
    const int32_t v = c->patch->tri[k];
    for (int j = 0; j < 2; j++) {
        out[j] =
            c->ring[v] == 0 ? uv[2 * (int64_t)v + j] - c->corner[2 * (int64_t)k + j] : c->shift[2 * (int64_t)v + j];
    }
}

/* The places of ring r get the mean of what their neighbours on the ring before it move. */
static void spread(closing *c, const double *uv, int32_t r)
{
    const sl_patch *p = c->patch;
    for (int32_t t = 0; t < p->nt; t++) {
        const int32_t *v = p->tri + 3 * t;
        if (c->ring[v[0]] != r - 1 && c->ring[v[1]] != r - 1 && c->ring[v[2]] != r - 1) {
            continue;
        }
        if (c->listed[t] == 0) {
            c->listed[t] = 1;
            c->near[c->nnear++] = t;
        }
        for (int k = 0; k < 9; k++) {
            const int32_t from = v[k / 3], to = v[k % 3];
            double x[2];
            if (c->ring[from] != r - 1 || (c->ring[to] >= 0 && c->ring[to] < r)) {
                continue;
            }
            if (c->ring[to] < 0) {
                c->ring[to] = r;
                memset(c->sum + 3 * (int64_t)to, 0, 3 * sizeof *c->sum);
            }
            shift_of(c, uv, 3 * t + k / 3, x);
            c->sum[3 * (int64_t)to] += x[0];
            c->sum[3 * (int64_t)to + 1] += x[1];
            c->sum[3 * (int64_t)to + 2] += 1.0;
        }
    }
    for (int32_t v = 0; v < p->nv; v++) {
        if (c->ring[v] == r) {
            const double *sum = c->sum + 3 * (int64_t)v;
            c->shift[2 * (int64_t)v] = sum[0] / sum[2];
            c->shift[2 * (int64_t)v + 1] = sum[1] / sum[2];
        }
    }
}

/* What moves less than its neighbours and what moves more grow alike; beyond the last ring nothing moves. */
static void smooth(closing *c, const double *uv)
{
    const sl_patch *p = c->patch;
    for (int32_t v = 0; v < p->nv; v++) {
        memset(c->sum + 3 * (int64_t)v, 0, 3 * sizeof *c->sum);
    }
    for (int32_t n = 0; n < c->nnear; n++) {
        for (int k = 0; k < 9; k++) {
            const int32_t from = 3 * c->near[n] + k / 3, to = p->tri[3 * c->near[n] + k % 3];
            double x[2], *sum = c->sum + 3 * (int64_t)to;
            if (c->ring[to] > 0) {
                shift_of(c, uv, from, x);
                sum[0] += x[0];
                sum[1] += x[1];
                sum[2] += 1.0;
            }
        }
    }
    for (int32_t v = 0; v < p->nv; v++) {
        const double *sum = c->sum + 3 * (int64_t)v;
        if (c->ring[v] > 0 && sum[2] > 0.0) {
            c->shift[2 * (int64_t)v] = sum[0] / sum[2];
            c->shift[2 * (int64_t)v + 1] = sum[1] / sum[2];
        }
    }
}

/* As many rings as the widest gap asks for, by the size of the triangles at the window. */
static int32_t count_rings(const closing *c)
{
    double area = 0.0;
    int32_t count = 0;
    for (int32_t t = 0; t < c->patch->nt; t++) {
        const int32_t *v = c->patch->tri + 3 * t;
        const double *a = c->corner + 6 * (int64_t)t;
        if (c->ring[v[0]] == 0 || c->ring[v[1]] == 0 || c->ring[v[2]] == 0) {
            area += 0.5 * fabs((a[2] - a[0]) * (a[5] - a[1]) - (a[3] - a[1]) * (a[4] - a[0]));
            count++;
        }
    }
    const double edge = count > 0 ? sqrt(2.0 * area / count) : 0.0;
    const double rings = edge > 0.0 ? REACH * c->gap / edge : 0.0;
    return (int32_t)fmin(fmax(ceil(rings), FEWEST_RINGS), MOST_RINGS);
}

/* Triangles that are not positive, with the shifts behind the banks or without. */
static int32_t count_flips(const closing *c, const double *uv, bool shifted)
{
    int32_t flips = 0;
    for (int32_t t = 0; t < c->patch->nt; t++) {
        double x[3][2];
        for (int k = 0; k < 3; k++) {
            const int32_t v = c->patch->tri[3 * t + k];
            const double share = shifted && c->ring[v] > 0 ? 1.0 : 0.0;
            for (int j = 0; j < 2; j++) {
                x[k][j] = uv[2 * (int64_t)v + j] + share * c->shift[2 * (int64_t)v + j];
            }
        }
        flips += !((x[1][0] - x[0][0]) * (x[2][1] - x[0][1]) - (x[1][1] - x[0][1]) * (x[2][0] - x[0][0]) > 0.0);
    }
    return flips;
}

sl_status sl_opt_close_banks(const sl_opt_state *state, const sl_opt_trial *trial, const sl_patch *patch, double *uv)
{
    closing c = {0};
    double motion[4];
    sl_status status = closing_init(patch, &c);
    if (status == SL_OK) {
        (void)sl_opt_align(state, trial, motion);
        gather_corners(state, trial, motion, &c);
        meet(&c, uv);
        const int32_t rings = count_rings(&c);
        for (int32_t r = 1; r <= rings; r++) {
            spread(&c, uv, r);
        }
        for (int32_t v = 0; v < patch->nv; v++) {
            const double share = c.ring[v] > 0 ? 1.0 - (double)c.ring[v] / (rings + 1) : 0.0;
            c.shift[2 * (int64_t)v] *= share;
            c.shift[2 * (int64_t)v + 1] *= share;
        }
        for (int k = 0; k < SWEEPS; k++) {
            smooth(&c, uv);
        }
        const bool follows = count_flips(&c, uv, true) < count_flips(&c, uv, false);
        for (int32_t v = 0; v < patch->nv && follows; v++) {
            if (c.ring[v] > 0) {
                uv[2 * (int64_t)v] += c.shift[2 * (int64_t)v];
                uv[2 * (int64_t)v + 1] += c.shift[2 * (int64_t)v + 1];
            }
        }
    }
    closing_clear(&c);
    return status;
}
