/* Clustering of weighted points by k-means. */
#include "segment/kmeans_internal.h"

#include "base/memory.h"
#include "base/rng.h"

#include <math.h>
#include <string.h>

#define SWEEPS 100 /* of Lloyd's iteration; most inputs settle in 10 to 30 */

sl_kmeans_def sl_kmeans_default(int32_t clusters)
{
    return (sl_kmeans_def){.clusters = clusters, .starts = 8, .seed = 1};
}

/* A clustering on its way. */
typedef struct clustering {
    const sl_kmeans_points *p;
    int32_t count;    /* centres */
    double *centre;   /* count x dims */
    double *mass;     /* count */
    double *distance; /* n: squared, to the nearest centre */
    int32_t *label;   /* n */
    double energy;
} clustering;

static void clustering_clear(clustering *c)
{
    sl_free(c->centre);
    sl_free(c->mass);
    sl_free(c->distance);
    sl_free(c->label);
}

static sl_status clustering_create(const sl_kmeans_points *p, int32_t most, clustering *c)
{
    int64_t size = 0;
    *c = (clustering){.p = p};
    sl_status status = sl_mul_size(most, p->dims, &size);
    if (status != SL_OK) {
        return status;
    }
    c->centre = sl_alloc(size, sizeof *c->centre);
    c->mass = sl_alloc(most, sizeof *c->mass);
    c->distance = sl_alloc(p->n, sizeof *c->distance);
    c->label = sl_alloc(p->n, sizeof *c->label);
    return c->centre != NULL && c->mass != NULL && c->distance != NULL && c->label != NULL ? SL_OK : SL_OUT_OF_MEMORY;
}

static double squared_distance(const clustering *c, int32_t i, int32_t k)
{
    const double *x = c->p->x + (int64_t)i * c->p->dims, *y = c->centre + (int64_t)k * c->p->dims;
    double sum = 0.0;
    for (int32_t d = 0; d < c->p->dims; d++) {
        sum += (x[d] - y[d]) * (x[d] - y[d]);
    }
    return sum;
}

/* Makes point i the next centre. */
static void add_centre(clustering *c, int32_t i)
{
    const int32_t k = c->count++;
    memcpy(c->centre + (int64_t)k * c->p->dims, c->p->x + (int64_t)i * c->p->dims,
           (size_t)c->p->dims * sizeof *c->centre);
    for (int32_t j = 0; j < c->p->n; j++) {
        c->distance[j] = fmin(c->distance[j], squared_distance(c, j, k));
    }
}

/* A point drawn with chances proportional to weight times squared distance; -1 = all are centres already. */
static int32_t draw_point(const clustering *c, sl_rng *rng)
{
    double total = 0.0, sum = 0.0;
    int32_t drawn = -1;
    for (int32_t j = 0; j < c->p->n; j++) {
        total += c->p->weight[j] * c->distance[j];
    }
    const double at = sl_rng_uniform(rng) * total;
    for (int32_t j = 0; j < c->p->n && (drawn < 0 || sum <= at); j++) {
        const double share = c->p->weight[j] * c->distance[j];
        sum += share;
        drawn = share > 0.0 ? j : drawn;
    }
    return drawn;
}

static void seed_centres(clustering *c, int32_t wanted, sl_rng *rng)
{
    c->count = 0;
    for (int32_t j = 0; j < c->p->n; j++) {
        c->distance[j] = 1.0; /* the first by weight alone */
    }
    for (int32_t i = 0; c->count < wanted && (i = draw_point(c, rng)) >= 0;) {
        for (int32_t j = 0; j < c->p->n && c->count == 0; j++) {
            c->distance[j] = HUGE_VAL;
        }
        add_centre(c, i);
    }
}

/* Nearest centres, ties to the smaller number. Did a label change? */
static bool assign(clustering *c)
{
    bool changed = false;
    c->energy = 0.0;
    for (int32_t i = 0; i < c->p->n; i++) {
        int32_t nearest = 0;
        double least = squared_distance(c, i, 0);
        for (int32_t k = 1; k < c->count; k++) {
            const double d = squared_distance(c, i, k);
            nearest = d < least ? k : nearest;
            least = fmin(least, d);
        }
        changed |= c->label[i] != nearest;
        c->label[i] = nearest;
        c->energy += c->p->weight[i] * least;
    }
    return changed;
}

/* Centres to the means; one without weight stays where it is. */
static void move_centres(clustering *c)
{
    const int32_t dims = c->p->dims;
    for (int32_t k = 0; k < c->count; k++) {
        c->mass[k] = 0.0;
    }
    for (int32_t i = 0; i < c->p->n; i++) {
        c->mass[c->label[i]] += c->p->weight[i];
    }
    for (int32_t k = 0; k < c->count; k++) {
        for (int32_t d = 0; d < dims && c->mass[k] > 0.0; d++) {
            c->centre[(int64_t)k * dims + d] = 0.0;
        }
    }
    for (int32_t i = 0; i < c->p->n; i++) {
        const int32_t k = c->label[i];
        for (int32_t d = 0; d < dims && c->mass[k] > 0.0; d++) {
            c->centre[(int64_t)k * dims + d] += c->p->weight[i] / c->mass[k] * c->p->x[(int64_t)i * dims + d];
        }
    }
}

/* Numbers the clusters in use by their first points. */
static int32_t number_clusters(const clustering *c, int32_t *name, int32_t *label)
{
    int32_t count = 0;
    for (int32_t k = 0; k < c->count; k++) {
        name[k] = -1;
    }
    for (int32_t i = 0; i < c->p->n; i++) {
        int32_t *number = &name[c->label[i]];
        *number = *number < 0 ? count++ : *number;
        label[i] = *number;
    }
    return count;
}

/**
 * Clusters points around centres.
 *
 *     minimise sum_i w_i |x_i - c(i)|^2 over the centres
 *
 * Lloyd's iteration from several random seedings; the best result is kept, the first of equals.
 *
 * @param[in]  points
 * @param[in]  def
 * @param[in]  context  nullable
 * @param[out] label    n
 * @param[out] count    clusters
 * @param[out] energy   the sum
 *
 * SL_OUT_OF_MEMORY, SL_CANCELLED. O(starts sweeps n clusters dims). Serial: the same bytes for any number of threads.
 * Source: Lloyd 1982, "Least squares quantization in PCM"; Arthur, Vassilvitskii 2007, "k-means++: the advantages of
 * careful seeding".
 */
sl_status sl_kmeans(const sl_kmeans_points *points, const sl_kmeans_def *def, const sl_context *context, int32_t *label,
                    int32_t *count, double *energy)
{
    sl_status status = SL_OK;
    sl_rng rng = sl_rng_seed(def->seed);
    clustering c = {0};
    int32_t *name = sl_alloc(def->clusters, sizeof *name);
    double best = HUGE_VAL;
    SL_TRY(name != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(clustering_create(points, def->clusters, &c));
    for (int32_t start = 0; start < def->starts; start++) {
        SL_TRY(sl_report_progress(context, "clusters", (double)start / def->starts));
        seed_centres(&c, def->clusters, &rng);
        memset(c.label, -1, (size_t)points->n * sizeof *c.label);
        for (int32_t sweep = 0; sweep < SWEEPS && assign(&c); sweep++) {
            move_centres(&c);
        }
        if (c.energy < best) {
            best = c.energy;
            *count = number_clusters(&c, name, label);
        }
    }
    *energy = best;
cleanup:
    clustering_clear(&c);
    sl_free(name);
    return status;
}
