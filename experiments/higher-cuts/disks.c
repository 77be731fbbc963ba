#include "higher.h"

#include "param/lscm.h"

#include <math.h>
#include <stdlib.h>

enum { DISK_VECTORS = 12, LEAST_FACETS = 150, MOST_FACETS = 1500 };

/* A disk, flat, and its own spectrum. */
typedef struct disk {
    int32_t count, *face; /* facets of the mesh, nearest first */
    double *distance;     /* count: from the centre */
    sl_patch *patch;
    sl_facet_graph *graph;
    sl_spectrum *spectrum;
    double *flat; /* count x 2: centroids in the plane */
    int32_t vector[2];
} disk;

static void disk_clear(disk *d)
{
    sl_free(d->face);
    sl_free(d->distance);
    sl_free(d->flat);
    sl_patch_free(d->patch);
    sl_facet_graph_free(d->graph);
    sl_spectrum_free(d->spectrum);
    *d = (disk){0};
}

typedef struct near_facet {
    double distance;
    int32_t face;
} near_facet;

static int by_distance(const void *a, const void *b)
{
    const near_facet *p = a, *q = b;
    return p->distance != q->distance ? (p->distance > q->distance) - (p->distance < q->distance)
                                      : (p->face > q->face) - (p->face < q->face);
}

/* Facet graph of the component with distances between centroids as weights. weight: as long as adj. */
static void weigh(const exp_spectrum *s, double *weight)
{
    const sl_graph *g = &s->graph->graph;
    for (int32_t i = 0; i < g->n; i++) {
        for (int32_t p = g->first[i]; p < g->first[i + 1]; p++) {
            const double *a = s->graph->centroid + 3 * (int64_t)i, *b = s->graph->centroid + 3 * (int64_t)g->adj[p];
            weight[p] =
                sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
        }
    }
}

/* The facets nearest to the centre, by length of path over the surface. */
static sl_status grow(const exp_spectrum *s, const sl_graph *weighted, int32_t centre, disk *d)
{
    sl_status status = SL_OK;
    const int32_t n = weighted->n, tenth = n / 10;
    const int32_t wanted = tenth < LEAST_FACETS ? LEAST_FACETS : tenth > MOST_FACETS ? MOST_FACETS : tenth;
    double *distance = sl_alloc(n, sizeof *distance);
    int32_t *parent = sl_alloc(n, sizeof *parent);
    near_facet *order = sl_alloc(n, sizeof *order);
    if (distance == NULL || parent == NULL || order == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    SL_TRY(sl_graph_shortest_paths(weighted, &centre, 1, NULL, -1, distance, parent, NULL));
    for (int32_t i = 0; i < n; i++) {
        order[i] = (near_facet){distance[i], s->faces[i]}; /* nodes are facets: nothing is paired */
    }
    qsort(order, (size_t)n, sizeof *order, by_distance);
    d->count = wanted < n ? wanted : n;
    d->face = sl_alloc(d->count, sizeof *d->face);
    d->distance = sl_alloc(d->count, sizeof *d->distance);
    d->flat = sl_calloc(2 * (int64_t)d->count, sizeof *d->flat);
    if (d->face == NULL || d->distance == NULL || d->flat == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    for (int32_t i = 0; i < d->count; i++) {
        d->face[i] = order[i].face;
        d->distance[i] = order[i].distance;
    }
cleanup:
    sl_free(distance);
    sl_free(parent);
    sl_free(order);
    return status;
}

/* Centroids of the facets in a least squares conformal map. */
static sl_status flatten(exp_run *run, const exp_spectrum *s, disk *d)
{
    sl_status status = SL_OK;
    double *uv = sl_alloc(2 * (int64_t)d->patch->nv, sizeof *uv);
    int32_t *corners = sl_calloc(s->mesh->nf, sizeof *corners), *place = sl_alloc(s->mesh->nf, sizeof *place);
    if (uv == NULL || corners == NULL || place == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    SL_TRY(sl_lscm(d->patch, &run->context, uv));
    for (int32_t i = 0; i < d->count; i++) {
        place[d->face[i]] = i;
    }
    for (int32_t c = 0; c < 3 * d->patch->nt; c++) {
        const int32_t f = d->patch->facet[c / 3];
        for (int k = 0; k < 2; k++) {
            d->flat[2 * (int64_t)place[f] + k] += uv[2 * (int64_t)d->patch->tri[c] + k];
        }
        corners[f]++;
    }
    for (int32_t i = 0; i < d->count; i++) {
        d->flat[2 * (int64_t)i] /= corners[d->face[i]];
        d->flat[2 * (int64_t)i + 1] /= corners[d->face[i]];
    }
cleanup:
    sl_free(uv);
    sl_free(corners);
    sl_free(place);
    return status;
}

/* The first two vectors of the disk's own graph that pass; false: there are not two. */
static sl_status find_directions(exp_run *run, const exp_spectrum *s, disk *d, bool *found)
{
    sl_status status = SL_OK;
    sl_cut_candidate candidate[DISK_VECTORS];
    int passing = 0;
    SL_TRY(sl_facet_graph_create(s->mesh, d->face, d->count, NULL, &d->graph));
    SL_TRY(sl_spectrum_compute(d->graph, DISK_VECTORS, &run->context, &d->spectrum));
    SL_TRY(sl_cut_candidates(s->mesh, d->graph, d->spectrum, candidate));
    for (int32_t k = 0; k < d->spectrum->count - 1 && passing < 2; k++) {
        if (candidate[k].passes) {
            d->vector[passing++] = candidate[k].vector;
        }
    }
    *found = passing == 2;
cleanup:
    return status;
}

/* Share of the variance of y that a + b p + c q explains, over the rows i < n. */
static double explained(int32_t n, const double *p, const double *q, const double *y, int32_t stride)
{
    double m[3] = {0}, pp = 0.0, pq = 0.0, qq = 0.0, py = 0.0, qy = 0.0, yy = 0.0;
    for (int32_t i = 0; i < n; i++) {
        m[0] += p[i] / n;
        m[1] += q[i] / n;
        m[2] += y[(int64_t)stride * i] / n;
    }
    for (int32_t i = 0; i < n; i++) {
        const double a = p[i] - m[0], b = q[i] - m[1], c = y[(int64_t)stride * i] - m[2];
        pp += a * a;
        pq += a * b;
        qq += b * b;
        py += a * c;
        qy += b * c;
        yy += c * c;
    }
    const double determinant = pp * qq - pq * pq;
    if (!(determinant > 1e-12 * pp * qq) || !(yy > 0.0)) {
        return 0.0;
    }
    const double b = (py * qq - qy * pq) / determinant, c = (qy * pp - py * pq) / determinant;
    return (b * py + c * qy) / yy;
}

static double inner_half_share(const disk *d)
{
    const double radius = d->distance[d->count - 1];
    const double *p = d->spectrum->vectors + (int64_t)d->vector[0] * d->spectrum->n,
                 *q = d->spectrum->vectors + (int64_t)d->vector[1] * d->spectrum->n;
    int32_t inner = 0;
    while (inner < d->count && d->distance[inner] <= 0.5 * radius) {
        inner++;
    }
    return fmin(explained(inner, p, q, d->flat, 2), explained(inner, p, q, d->flat + 1, 2));
}

sl_status higher_disks(exp_run *run, const exp_spectrum *s, uint64_t seed, double *share, int32_t *count)
{
    sl_status status = SL_OK;
    disk d = {0};
    sl_rng rng = sl_rng_seed(seed);
    sl_graph weighted = s->graph->graph;
    double *weight = sl_alloc(weighted.first[weighted.n], sizeof *weight);
    *count = 0;
    if (weight == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    weigh(s, weight);
    weighted.weight = weight;
    for (int k = 0; k < HIGHER_DISKS; k++) {
        bool found = false;
        SL_TRY(grow(s, &weighted, (int32_t)(sl_rng_uniform(&rng) * weighted.n), &d));
        SL_TRY(sl_patch_extract(s->mesh, s->triangulation, d.face, d.count, &d.patch));
        if (sl_patch_is_disk(d.patch)) {
            SL_TRY(flatten(run, s, &d));
            SL_TRY(find_directions(run, s, &d, &found));
        }
        if (found) {
            share[(*count)++] = inner_half_share(&d);
        }
        disk_clear(&d);
    }
cleanup:
    disk_clear(&d);
    sl_free(weight);
    return status;
}
