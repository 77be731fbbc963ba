/* Edge loops of quads: runs of edges straight on through regular vertices. */
#include "seamcost/seamcost_internal.h"

#include "base/memory.h"

typedef struct quads {
    const sl_mesh *mesh;
    const int32_t *partner; /* nullable */
} quads;

/* Is facet f a quad, or one half of a pair? */
static bool is_quad(const quads *q, int32_t f)
{
    return sl_degree(q->mesh, f) == 4 || (sl_degree(q->mesh, f) == 3 && q->partner != NULL && q->partner[f] >= 0);
}

static bool is_diagonal(const quads *q, int32_t h)
{
    const int32_t t = sl_opposite(q->mesh, h);
    if (t < 0 || q->partner == NULL) {
        return false;
    }
    const int32_t f = q->mesh->face[h], g = q->mesh->face[t];
    return q->partner[f] == g && q->partner[g] == f;
}

/* Corners around a regular vertex: at most 8, when every quad there is cut through the vertex. */
#define MAX_TURN 8

/* The halfedge that leaves where h arrives and runs straight on; -1 when that vertex is not regular. */
static int32_t straight_on(const quads *q, int32_t h)
{
    int32_t ahead = -1, edges = 0, k = h;
    for (int32_t n = 0; n < MAX_TURN; n++) {
        /* k arrives at the vertex, the facet beside it is the next around. */
        const int32_t out = sl_next(q->mesh, k);
        if (!is_quad(q, q->mesh->face[k]) || sl_opposite(q->mesh, out) < 0) {
            return -1;
        }
        edges += is_diagonal(q, out) ? 0 : 1;
        ahead = edges == 2 && ahead < 0 ? out : ahead;
        k = sl_opposite(q->mesh, out);
        if (k == h) {
            return edges == 4 ? ahead : -1;
        }
    }
    return -1;
}

/* Walks the run of h to its end, or round; returns its edges and whether it closes. */
static int32_t run_length(const int32_t *ahead, int32_t h, bool *closed)
{
    int32_t n = 1, k = h;
    while (ahead[k] >= 0 && ahead[k] != h) {
        k = ahead[k];
        n++;
    }
    *closed = ahead[k] == h;
    return n;
}

static void mark_run(const int32_t *ahead, int32_t h, double *feature)
{
    bool closed = false;
    const int32_t n = run_length(ahead, h, &closed);
    const double value = closed ? 1.0 : 1.0 - 1.0 / n;
    for (int32_t i = 0, k = h; i < n; i++) {
        feature[k] = value;
        k = ahead[k];
    }
}

/* Does h lie on an edge between logical faces of which one is a quad? */
static bool on_quad(const quads *q, int32_t h)
{
    const int32_t t = sl_opposite(q->mesh, h);
    return t >= 0 && !is_diagonal(q, h) && (is_quad(q, q->mesh->face[h]) || is_quad(q, q->mesh->face[t]));
}

sl_status sl_seam_loops(const sl_mesh *mesh, const int32_t *partner, double *feature)
{
    const quads q = {mesh, partner};
    int32_t *ahead = sl_alloc(mesh->nh, sizeof *ahead);
    if (ahead == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t h = 0; h < mesh->nh; h++) {
        feature[h] = -1.0;
        ahead[h] = on_quad(&q, h) ? straight_on(&q, h) : -1;
    }
    /* First the runs that have a start: straight on is a one-to-one map, and backwards it is straight on of the
     * opposite. What is left closes. */
    for (int pass = 0; pass < 2; pass++) {
        for (int32_t h = 0; h < mesh->nh; h++) {
            const int32_t t = sl_opposite(mesh, h);
            if (feature[h] < 0.0 && on_quad(&q, h) && (pass == 1 || ahead[t] < 0)) {
                mark_run(ahead, h, feature);
            }
        }
    }
    for (int32_t h = 0; h < mesh->nh; h++) {
        feature[h] = feature[h] > 0.0 ? feature[h] : 0.0;
    }
    sl_free(ahead);
    return SL_OK;
}
