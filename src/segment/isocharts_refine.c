/* Iso-charts: borders between clusters moved to minimum cuts. */
#include "segment/isocharts_internal.h"

#include "base/memory.h"
#include "geom/vec3.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define FREE_SHARE 0.3    /* of the area of two clusters: how much of it may change sides (Zhou et al. 2004) */
#define ANGLE_WEIGHT 0.5  /* of the two capacities (Zhou et al. 2004) */
#define LEAST_LANDMARKS 4 /* fewer have no distortion in the plane to speak of */

/* A node by how near it is to being equally far from both representatives. */
typedef struct ranked_node {
    double difference;
    int32_t node;
} ranked_node;

/* Two clusters at a time. */
typedef struct border {
    sl_isocharts *iso;
    int32_t a, b;
    double *normal;        /* n x 3: unit vector areas */
    double *distortion[2]; /* n: of the embedding of each cluster */
    int32_t *count;        /* n, scratch */
    double *d;             /* landmarks^2, scratch */
    ranked_node *rank;     /* n */
    int32_t *local;        /* n: number among the nodes of both clusters, -1 = outside */
    int32_t nodes;
    int8_t *seed;  /* nodes */
    uint8_t *side; /* nodes */
    sl_graph graph;
} border;

static void border_clear(border *w)
{
    sl_free(w->normal);
    sl_free(w->distortion[0]);
    sl_free(w->distortion[1]);
    sl_free(w->count);
    sl_free(w->d);
    sl_free(w->rank);
    sl_free(w->local);
    sl_free(w->seed);
    sl_free(w->side);
    sl_graph_clear(&w->graph);
}

static sl_status border_create(sl_isocharts *iso, border *w)
{
    const int64_t n = iso->graph->graph.n, L = iso->landmarks, entries = iso->graph->graph.first[n];
    *w = (border){.iso = iso,
                  .normal = sl_calloc(3 * n, sizeof *w->normal),
                  .distortion = {sl_alloc(n, sizeof(double)), sl_alloc(n, sizeof(double))},
                  .count = sl_alloc(n, sizeof *w->count),
                  .d = sl_alloc(L * L, sizeof *w->d),
                  .rank = sl_alloc(n, sizeof *w->rank),
                  .local = sl_alloc(n, sizeof *w->local),
                  .seed = sl_alloc(n, sizeof *w->seed),
                  .side = sl_alloc(n, sizeof *w->side),
                  .graph = {0, sl_alloc(n + 1, sizeof(int32_t)), sl_alloc(entries, sizeof(int32_t)),
                            sl_alloc(entries, sizeof(double))}};
    return w->normal != NULL && w->distortion[0] != NULL && w->distortion[1] != NULL && w->count != NULL &&
                   w->d != NULL && w->rank != NULL && w->local != NULL && w->seed != NULL && w->side != NULL &&
                   w->graph.first != NULL && w->graph.adj != NULL && w->graph.weight != NULL
               ? SL_OK
               : SL_OUT_OF_MEMORY;
}

static void find_normals(border *w)
{
    const sl_mesh *m = w->iso->piece->mesh;
    for (int32_t f = 0; f < m->nf; f++) {
        double v[3], *sum = w->normal + 3 * (int64_t)w->iso->graph->node[f];
        sl_mesh_face_vector_area(m, f, v);
        sl_vec3_add(sum, v, sum);
    }
    for (int32_t i = 0; i < w->iso->graph->graph.n; i++) {
        double *v = w->normal + 3 * (int64_t)i, length = sl_vec3_norm(v);
        for (int k = 0; k < 3; k++) {
            v[k] = length > 0.0 ? v[k] / length : 0.0;
        }
    }
}

/* Is a vertex in a cluster: has it a corner in one of its nodes? */
static bool vertex_in(const sl_isocharts *iso, int32_t v, int32_t cluster)
{
    const sl_geodesics *g = &iso->geodesics;
    for (int32_t p = g->first[v]; p < g->first[v + 1]; p++) {
        const int32_t h = iso->piece->triangulation->corner[g->incident[p]];
        if (iso->label[iso->graph->node[iso->piece->mesh->face[h]]] == cluster) {
            return true;
        }
    }
    return false;
}

/* Distortion at vertex v: the root mean square over the landmarks of | |y_v - y_i| - d(v, i) |. */
static double distortion_at(const sl_mds *mds, const double *y, const double *place, const double *d)
{
    double sum = 0.0;
    for (int32_t i = 0; i < mds->landmarks; i++) {
        const double apart = hypot(place[0] - y[2 * i], place[1] - y[2 * i + 1]) - d[i];
        sum += apart * apart;
    }
    return sqrt(sum / mds->landmarks);
}

/* How far the plane embedding of a cluster is from keeping distances, at every node; 0 with too few landmarks. */
static sl_status find_distortion(border *w, int32_t cluster, double *node)
{
    sl_status status = SL_OK;
    sl_isocharts *iso = w->iso;
    const int32_t nv = iso->piece->mesh->nv;
    int32_t inside[SL_ISO_LANDMARKS], count = 0;
    double d[SL_ISO_LANDMARKS], y[2 * SL_ISO_LANDMARKS], place[2] = {0.0, 0.0};
    sl_mds mds = {0};
    for (int32_t i = 0; i < iso->landmarks; i++) {
        if (vertex_in(iso, iso->landmark[i], cluster)) {
            inside[count++] = i;
        }
    }
    memset(node, 0, (size_t)iso->graph->graph.n * sizeof *node);
    if (count < LEAST_LANDMARKS) {
        return SL_OK;
    }
    for (int32_t i = 0; i < count; i++) {
        for (int32_t j = 0; j < count; j++) {
            w->d[i * count + j] = iso->distance[(int64_t)inside[i] * nv + iso->landmark[inside[j]]];
        }
    }
    SL_TRY(sl_mds_create(count, w->d, &mds));
    const int32_t dims = mds.dims < 2 ? mds.dims : 2;
    for (int32_t i = 0; i < count; i++) {
        y[2 * i] = y[2 * i + 1] = 0.0;
        sl_mds_place(&mds, dims, w->d + (int64_t)i * count, y + 2 * (int64_t)i);
    }
    for (int32_t v = 0; v < nv; v++) {
        for (int32_t i = 0; i < count; i++) {
            d[i] = iso->distance[(int64_t)inside[i] * nv + v];
        }
        sl_mds_place(&mds, dims, d, place);
        iso->vertex_work[v] = distortion_at(&mds, y, place, d);
    }
    sl_node_means(iso->piece, iso->graph, iso->vertex_work, node, w->count);
cleanup:
    sl_mds_clear(&mds);
    return status;
}

static int compare_ranked(const void *pa, const void *pb)
{
    const ranked_node *a = pa, *b = pb;
    if (a->difference != b->difference) {
        return a->difference < b->difference ? -1 : 1;
    }
    return (a->node > b->node) - (a->node < b->node);
}

/* Numbers the nodes of both clusters. Free are those about equally far from both, FREE_SHARE of the area of them. */
static void free_middle(border *w)
{
    const sl_isocharts *iso = w->iso;
    const int64_t n = iso->graph->graph.n;
    double total = 0.0, freed = 0.0;
    w->nodes = 0;
    for (int32_t i = 0; i < n; i++) {
        w->local[i] = -1;
        if (iso->label[i] == w->a || iso->label[i] == w->b) {
            const double d = iso->node_distance[w->a * n + i] - iso->node_distance[w->b * n + i];
            w->rank[w->nodes] = (ranked_node){fabs(d), i};
            w->seed[w->nodes] = iso->label[i] == w->a ? 1 : -1;
            w->local[i] = w->nodes++;
            total += iso->area[i];
        }
    }
    qsort(w->rank, (size_t)w->nodes, sizeof *w->rank, compare_ranked);
    for (int32_t k = 0; k < w->nodes && freed < FREE_SHARE * total; k++) {
        const int32_t i = w->rank[k].node;
        freed += iso->area[i];
        if (i != iso->seed[w->a] && i != iso->seed[w->b]) {
            w->seed[w->local[i]] = 0;
        }
    }
}

/* d_ang = 1 - cos of the angle between the normals. */
static double angle_distance(const border *w, int32_t i, int32_t j)
{
    return 1.0 - sl_vec3_dot(w->normal + 3 * (int64_t)i, w->normal + 3 * (int64_t)j);
}

/* d_dist = |D_A(i) - D_B(i)| + |D_A(j) - D_B(j)|. */
static double distortion_distance(const border *w, int32_t i, int32_t j)
{
    return fabs(w->distortion[0][i] - w->distortion[1][i]) + fabs(w->distortion[0][j] - w->distortion[1][j]);
}

/* c = w / (1 + d_ang / mean) + (1 - w) d_dist / mean, between the nodes of both clusters. */
static void fill_capacities(border *w)
{
    const sl_graph *g = &w->iso->graph->graph;
    double angle = 0.0, distortion = 0.0;
    int32_t entries = 0;
    for (int pass = 0; pass < 2; pass++) {
        const double mean_angle = entries > 0 ? angle / entries : 0.0;
        const double mean_distortion = entries > 0 ? distortion / entries : 0.0;
        entries = 0;
        w->graph.n = 0;
        for (int32_t i = 0; i < g->n; i++) {
            if (w->local[i] < 0) {
                continue;
            }
            w->graph.first[w->graph.n++] = entries;
            for (int32_t p = g->first[i]; p < g->first[i + 1]; p++) {
                const int32_t j = g->adj[p];
                if (w->local[j] < 0) {
                    continue;
                }
                const double da = angle_distance(w, i, j), dd = distortion_distance(w, i, j);
                angle += pass == 0 ? da : 0.0;
                distortion += pass == 0 ? dd : 0.0;
                w->graph.adj[entries] = w->local[j];
                w->graph.weight[entries++] =
                    ANGLE_WEIGHT / (1.0 + (mean_angle > 0.0 ? da / mean_angle : 0.0)) +
                    (1.0 - ANGLE_WEIGHT) * (mean_distortion > 0.0 ? dd / mean_distortion : 0.0);
            }
        }
        w->graph.first[w->graph.n] = entries;
    }
}

/* Takes the cut over where both sides hang together. */
static sl_status take_over(border *w)
{
    sl_status status = SL_OK;
    int32_t parts = 0, *key = sl_alloc(w->nodes, sizeof *key), *part = sl_alloc(w->nodes, sizeof *part);
    SL_TRY(key != NULL && part != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t k = 0; k < w->nodes; k++) {
        key[k] = w->side[k];
    }
    SL_TRY(sl_graph_components(&w->graph, key, part, &parts));
    for (int32_t i = 0; i < w->iso->graph->graph.n && parts == 2; i++) {
        if (w->local[i] >= 0) {
            w->iso->label[i] = w->side[w->local[i]] == 1 ? w->a : w->b;
        }
    }
cleanup:
    sl_free(key);
    sl_free(part);
    return status;
}

static bool touch(const sl_isocharts *iso, int32_t a, int32_t b)
{
    const sl_graph *g = &iso->graph->graph;
    for (int32_t i = 0; i < g->n; i++) {
        for (int32_t p = g->first[i]; iso->label[i] == a && p < g->first[i + 1]; p++) {
            if (iso->label[g->adj[p]] == b) {
                return true;
            }
        }
    }
    return false;
}

sl_status sl_iso_refine(sl_isocharts *iso)
{
    sl_status status = SL_OK;
    double value = 0.0;
    border w;
    SL_TRY(border_create(iso, &w));
    find_normals(&w);
    for (w.a = 0; w.a < iso->clusters; w.a++) {
        for (w.b = w.a + 1; w.b < iso->clusters; w.b++) {
            if (!touch(iso, w.a, w.b)) {
                continue;
            }
            SL_TRY(find_distortion(&w, w.a, w.distortion[0]));
            SL_TRY(find_distortion(&w, w.b, w.distortion[1]));
            free_middle(&w);
            fill_capacities(&w);
            SL_TRY(sl_graph_min_cut(&w.graph, w.seed, w.side, &value));
            SL_TRY(take_over(&w));
        }
    }
cleanup:
    border_clear(&w);
    return status;
}
