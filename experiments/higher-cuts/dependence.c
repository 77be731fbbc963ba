#include "higher.h"

#include <math.h>
#include <stdlib.h>

enum { BINS = 32 };

typedef struct pair {
    double x, y;
} pair;

static int by_x(const void *a, const void *b)
{
    const pair *p = a, *q = b;
    return p->x != q->x ? (p->x > q->x) - (p->x < q->x) : (p->y > q->y) - (p->y < q->y);
}

/* Share of the variance of y that is a function of x: between the means of BINS groups of equal size.
 * Source: Pearson 1905, "On the general theory of skew correlation". */
static double correlation_ratio(int32_t n, const double *x, const double *y, pair *work)
{
    double mean = 0.0, total = 0.0, between = 0.0;
    for (int32_t i = 0; i < n; i++) {
        work[i] = (pair){x[i], y[i]};
        mean += y[i] / n;
    }
    qsort(work, (size_t)n, sizeof *work, by_x);
    for (int b = 0; b < BINS; b++) {
        const int32_t lo = (int32_t)((int64_t)n * b / BINS), hi = (int32_t)((int64_t)n * (b + 1) / BINS);
        double sum = 0.0;
        for (int32_t i = lo; i < hi; i++) {
            sum += work[i].y;
            total += (work[i].y - mean) * (work[i].y - mean);
        }
        if (hi > lo) {
            between += (sum - (hi - lo) * mean) * (sum - (hi - lo) * mean) / (hi - lo);
        }
    }
    return total > 0.0 ? between / total : 0.0;
}

static void compare_with_lower(const exp_spectrum *s, int32_t k, pair *work, higher_vector *out)
{
    const int32_t n = s->spectrum->n;
    const double *y = s->spectrum->vectors + (int64_t)k * n;
    for (int32_t j = 1; j < k; j++) {
        const double *x = s->spectrum->vectors + (int64_t)j * n;
        double dot = 0.0;
        for (int32_t i = 0; i < n; i++) {
            dot += x[i] * y[i];
        }
        const double share = correlation_ratio(n, x, y, work);
        out->cosine = fmax(out->cosine, fabs(dot));
        if (share > out->function) {
            out->function = share;
            out->of = j;
        }
    }
}

/* Marks the facets beside a seam. */
static void mark(const exp_spectrum *s, const uint8_t *side, uint8_t *beside)
{
    const sl_graph *graph = &s->graph->graph;
    for (int32_t i = 0; i < graph->n; i++) {
        for (int32_t p = graph->first[i]; p < graph->first[i + 1]; p++) {
            beside[i] |= side[i] != side[graph->adj[p]];
        }
    }
}

/* Share of the edges' length, of those between the sides (side NULL: of all), that has a marked facet beside it. */
static double marked_share(const exp_spectrum *s, const uint8_t *side, const uint8_t *beside)
{
    const sl_graph *graph = &s->graph->graph;
    double all = 0.0, marked = 0.0;
    for (int32_t i = 0; i < graph->n; i++) {
        for (int32_t p = graph->first[i]; p < graph->first[i + 1]; p++) {
            const int32_t j = graph->adj[p];
            if (j > i && (side == NULL || side[i] != side[j])) {
                const double length = sl_mesh_edge_length(s->mesh, s->graph->halfedge[p]);
                all += length;
                marked += beside[i] != 0 || beside[j] != 0 ? length : 0.0;
            }
        }
    }
    return all > 0.0 ? marked / all : 0.0;
}

sl_status higher_measure(const exp_spectrum *s, higher_vector *vector)
{
    sl_status status = SL_OK;
    const int32_t n = s->spectrum->n;
    uint8_t *side = sl_alloc(n, sizeof *side), *beside = sl_calloc(n, sizeof *beside);
    pair *work = sl_alloc(n, sizeof *work);
    if (side == NULL || beside == NULL || work == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    for (int32_t k = 1; k < s->spectrum->count; k++) {
        higher_vector *v = &vector[k - 1];
        *v = (higher_vector){.passes = s->candidate[k - 1].passes};
        compare_with_lower(s, k, work, v);
        sl_spectrum_side(s->spectrum, k, side);
        v->along = marked_share(s, side, beside);
        v->chance = marked_share(s, NULL, beside);
        if (v->passes) {
            mark(s, side, beside);
        }
    }
cleanup:
    sl_free(side);
    sl_free(beside);
    sl_free(work);
    return status;
}
