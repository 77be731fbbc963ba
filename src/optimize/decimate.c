/* A coarse mesh of the surface for the search: halfedge collapses by quadric error, so that its vertices are some of
 * the surface's.
 * Source: Garland, Heckbert 1997, "Surface simplification using quadric error metrics". */
#include "optimize/decimate_internal.h"

#include "base/memory.h"
#include "geom/vec3.h"

#include <math.h>
#include <string.h>

static const double LEAST_COSINE = 0.3;   /* between a triangle's normals before and after a collapse */
static const double SHAPE_WEIGHT = 1e-3;  /* of the squared edge length beside the quadric error, times the area */
static const double BORDER_WEIGHT = 10.0; /* of planes that hold the border */
enum { MOST_NEIGHBOURS = 24 };

/* Symmetric 4 x 4 quadric: sum of n n', n d, d d. */
typedef struct quadric {
    double a[10];
} quadric;

typedef struct decimation {
    const sl_patch *patch;
    int32_t *tri;            /* 3 nt, -1 = gone */
    int32_t *head, *next;    /* nv; 3 nt: corners at a vertex */
    quadric *q;              /* nv */
    uint8_t *border;         /* nv */
    double *cost;            /* nv: of removing it */
    int32_t *target;         /* nv: where to; -1 = it stays */
    int32_t *heap, *place;   /* nv each */
    int32_t size, triangles; /* of the heap; left */
} decimation;

static void clear(decimation *d)
{
    sl_free(d->tri);
    sl_free(d->head);
    sl_free(d->next);
    sl_free(d->q);
    sl_free(d->border);
    sl_free(d->cost);
    sl_free(d->target);
    sl_free(d->heap);
    sl_free(d->place);
}

static const double *point(const decimation *d, int32_t v)
{
    return d->patch->xyz + 3 * (int64_t)v;
}

static void add_plane(quadric *q, const double n[3], const double p[3], double weight)
{
    const double x[4] = {n[0], n[1], n[2], -sl_vec3_dot(n, p)};
    int k = 0;
    for (int i = 0; i < 4; i++) {
        for (int j = i; j < 4; j++) {
            q->a[k++] += weight * x[i] * x[j];
        }
    }
}

static double error_at(const quadric *q, const double p[3])
{
    const double x[4] = {p[0], p[1], p[2], 1.0};
    double sum = 0.0;
    int k = 0;
    for (int i = 0; i < 4; i++) {
        for (int j = i; j < 4; j++) {
            sum += (i == j ? 1.0 : 2.0) * q->a[k++] * x[i] * x[j];
        }
    }
    return sum;
}

/* Twice the vector area of three points. */
static void normal_of(const double *a, const double *b, const double *c, double n[3])
{
    double u[3], v[3];
    sl_vec3_sub(b, a, u);
    sl_vec3_sub(c, a, v);
    sl_vec3_cross(u, v, n);
}

static sl_status init(const sl_patch *p, decimation *d)
{
    *d = (decimation){.patch = p, .triangles = p->nt};
    d->tri = sl_copy(p->tri, 3 * (int64_t)p->nt, sizeof *d->tri);
    d->head = sl_alloc(p->nv, sizeof *d->head);
    d->next = sl_alloc(3 * (int64_t)p->nt, sizeof *d->next);
    d->q = sl_calloc(p->nv, sizeof *d->q);
    d->border = sl_copy(p->border, p->nv, sizeof *d->border);
    d->cost = sl_alloc(p->nv, sizeof *d->cost);
    d->target = sl_alloc(p->nv, sizeof *d->target);
    d->heap = sl_alloc(p->nv, sizeof *d->heap);
    d->place = sl_alloc(p->nv, sizeof *d->place);
    if (d->tri == NULL || d->head == NULL || d->next == NULL || d->q == NULL || d->border == NULL || d->cost == NULL ||
        d->target == NULL || d->heap == NULL || d->place == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    memset(d->head, 0xff, (size_t)p->nv * sizeof *d->head);
    memset(d->place, 0xff, (size_t)p->nv * sizeof *d->place);
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        d->next[c] = d->head[p->tri[c]];
        d->head[p->tri[c]] = c;
    }
    return SL_OK;
}

static void fill_quadrics(decimation *d)
{
    const sl_patch *p = d->patch;
    for (int32_t t = 0; t < p->nt; t++) {
        double n[3];
        normal_of(point(d, p->tri[3 * t]), point(d, p->tri[3 * t + 1]), point(d, p->tri[3 * t + 2]), n);
        const double doubled = sl_vec3_norm(n);
        for (int k = 0; k < 3 && doubled > 0.0; k++) {
            n[k] /= doubled;
        }
        for (int k = 0; k < 3; k++) {
            const int32_t v = p->tri[3 * t + k], w = p->tri[3 * t + (k + 1) % 3];
            add_plane(&d->q[v], n, point(d, v), 0.5 * doubled);
            if (p->twin[3 * t + k] < 0) { /* a plane upright on the border edge */
                double e[3], m[3];
                sl_vec3_sub(point(d, w), point(d, v), e);
                sl_vec3_cross(e, n, m);
                const double length = sl_vec3_norm(m);
                for (int j = 0; j < 3 && length > 0.0; j++) {
                    m[j] /= length;
                }
                add_plane(&d->q[v], m, point(d, v), BORDER_WEIGHT * length * length);
                add_plane(&d->q[w], m, point(d, v), BORDER_WEIGHT * length * length);
            }
        }
    }
}

/* The vertices around v, each once; -1 when there are too many. */
static int32_t neighbours(const decimation *d, int32_t v, int32_t *list)
{
    int32_t n = 0;
    for (int32_t c = d->head[v]; c >= 0; c = d->next[c]) {
        for (int k = 1; k < 3; k++) {
            const int32_t w = d->tri[3 * (c / 3) + (c + k) % 3];
            int32_t i = 0;
            while (i < n && list[i] != w) {
                i++;
            }
            if (i == n) {
                if (n == MOST_NEIGHBOURS) {
                    return -1;
                }
                list[n++] = w;
            }
        }
    }
    return n;
}

/* How many triangles hold both u and v. */
static int32_t shared_triangles(const decimation *d, int32_t u, int32_t v)
{
    int32_t n = 0;
    for (int32_t c = d->head[u]; c >= 0; c = d->next[c]) {
        const int32_t *t = &d->tri[3 * (c / 3)];
        n += t[0] == v || t[1] == v || t[2] == v;
    }
    return n;
}

/* The link condition: u and v have no neighbours in common but those of their edge's triangles. */
static bool keeps_topology(const decimation *d, int32_t u, int32_t v, const int32_t *around, int32_t count)
{
    int32_t other[MOST_NEIGHBOURS], common = 0;
    const int32_t n = neighbours(d, v, other), shared = shared_triangles(d, u, v);
    if (n < 0 || count < 3) {
        return false;
    }
    if (d->border[u] != 0 && (d->border[v] == 0 || shared != 1)) {
        return false;
    }
    for (int32_t i = 0; i < count; i++) {
        for (int32_t j = 0; j < n; j++) {
            common += around[i] == other[j];
        }
    }
    return common == shared && count + n - common - 2 >= 3;
}

static bool keeps_shape(const decimation *d, int32_t u, int32_t v)
{
    for (int32_t c = d->head[u]; c >= 0; c = d->next[c]) {
        const int32_t a = d->tri[3 * (c / 3) + (c + 1) % 3], b = d->tri[3 * (c / 3) + (c + 2) % 3];
        if (a == v || b == v) {
            continue;
        }
        double before[3], after[3];
        normal_of(point(d, u), point(d, a), point(d, b), before);
        normal_of(point(d, v), point(d, a), point(d, b), after);
        const double scale = sl_vec3_norm(before) * sl_vec3_norm(after);
        if (!(sl_vec3_dot(before, after) > LEAST_COSINE * scale) || !(sl_vec3_norm(after) > 0.0)) {
            return false;
        }
    }
    return true;
}

/* The cheapest way to remove u. */
static void price(decimation *d, int32_t u)
{
    int32_t around[MOST_NEIGHBOURS];
    const int32_t n = neighbours(d, u, around);
    double area = 0.0;
    d->target[u] = -1;
    d->cost[u] = HUGE_VAL;
    for (int k = 0; k < 3; k++) {
        area += d->q[u].a[k == 0 ? 0 : k == 1 ? 4 : 7]; /* the trace: areas of the planes */
    }
    for (int32_t i = 0; i < n; i++) {
        const int32_t v = around[i];
        const double length = sl_vec3_distance(point(d, u), point(d, v));
        const double cost = fmax(error_at(&d->q[u], point(d, v)), 0.0) + SHAPE_WEIGHT * area * length * length;
        if (cost < d->cost[u] && keeps_topology(d, u, v, around, n) && keeps_shape(d, u, v)) {
            d->cost[u] = cost;
            d->target[u] = v;
        }
    }
}

static bool before(const decimation *d, int32_t u, int32_t v)
{
    return d->cost[u] < d->cost[v] || (d->cost[u] == d->cost[v] && u < v);
}

static void put(decimation *d, int32_t k, int32_t v)
{
    d->heap[k] = v;
    d->place[v] = k;
}

/* Moves the vertex at place k to where its cost belongs. */
static void sift(decimation *d, int32_t k)
{
    const int32_t v = d->heap[k];
    while (k > 0 && before(d, v, d->heap[(k - 1) / 2])) {
        put(d, k, d->heap[(k - 1) / 2]);
        k = (k - 1) / 2;
    }
    while (2 * k + 1 < d->size) {
        int32_t child = 2 * k + 1;
        child += child + 1 < d->size && before(d, d->heap[child + 1], d->heap[child]);
        if (!before(d, d->heap[child], v)) {
            break;
        }
        put(d, k, d->heap[child]);
        k = child;
    }
    put(d, k, v);
}

static void update(decimation *d, int32_t v)
{
    price(d, v);
    if (d->place[v] < 0) {
        put(d, d->size++, v);
    }
    sift(d, d->place[v]);
}

static int32_t pop(decimation *d)
{
    const int32_t v = d->heap[0];
    d->place[v] = -1;
    d->size--;
    if (d->size > 0) {
        put(d, 0, d->heap[d->size]);
        sift(d, 0);
    }
    return v;
}

static void unlink_corner(decimation *d, int32_t c)
{
    int32_t *at = &d->head[d->tri[c]];
    while (*at != c) {
        at = &d->next[*at];
    }
    *at = d->next[c];
}

/* u goes to v. */
static void collapse(decimation *d, int32_t u, int32_t v)
{
    int32_t c = d->head[u];
    d->head[u] = -1;
    while (c >= 0) {
        const int32_t after = d->next[c];
        int32_t *t = &d->tri[3 * (c / 3)];
        if (t[0] == v || t[1] == v || t[2] == v) {
            for (int k = 0; k < 3; k++) {
                if (t[k] != u) {
                    unlink_corner(d, 3 * (c / 3) + k);
                }
            }
            t[0] = t[1] = t[2] = -1;
            d->triangles--;
        } else {
            d->tri[c] = v;
            d->next[c] = d->head[v];
            d->head[v] = c;
        }
        c = after;
    }
    for (int k = 0; k < 10; k++) {
        d->q[v].a[k] += d->q[u].a[k];
    }
}

static void run(decimation *d, int32_t wanted)
{
    int32_t around[MOST_NEIGHBOURS];
    for (int32_t v = 0; v < d->patch->nv; v++) {
        if (d->head[v] >= 0) {
            update(d, v);
        }
    }
    while (d->triangles > wanted && d->size > 0) {
        const int32_t u = pop(d);
        if (d->target[u] < 0) {
            break; /* none can go */
        }
        const int32_t v = d->target[u];
        price(d, u);
        if (d->target[u] != v) { /* a neighbour's neighbour has changed */
            if (d->target[u] >= 0) {
                update(d, u);
            }
            continue;
        }
        collapse(d, u, v);
        const int32_t n = neighbours(d, v, around);
        update(d, v);
        for (int32_t k = 0; k < n; k++) {
            update(d, around[k]);
        }
    }
}

/* What is left, as a mesh of its own. */
static sl_status build(const decimation *d, sl_mesh **mesh, int32_t **vertex)
{
    sl_status status = SL_OK;
    const int32_t nv = d->patch->nv;
    int32_t *number = sl_alloc(nv, sizeof *number), *index = sl_alloc(3 * (int64_t)d->triangles, sizeof *index);
    int32_t *first = sl_alloc((int64_t)d->triangles + 1, sizeof *first), n = 0, t = 0;
    double *xyz = sl_alloc(nv, 3 * sizeof *xyz);
    *vertex = sl_alloc(nv, sizeof **vertex);
    SL_TRY(number == NULL || index == NULL || first == NULL || xyz == NULL || *vertex == NULL ? SL_OUT_OF_MEMORY
                                                                                              : SL_OK);
    for (int32_t v = 0; v < nv; v++) {
        number[v] = d->head[v] >= 0 ? n : -1;
        if (d->head[v] >= 0) {
            (*vertex)[n] = v;
            memcpy(xyz + 3 * (int64_t)n++, point(d, v), 3 * sizeof *xyz);
        }
    }
    first[0] = 0;
    for (int32_t c = 0; c < 3 * d->patch->nt; c += 3) {
        if (d->tri[c] >= 0) {
            for (int k = 0; k < 3; k++) {
                index[3 * t + k] = number[d->tri[c + k]];
            }
            t++;
            first[t] = 3 * t;
        }
    }
    const sl_polygons polygons = {n, t, xyz, first, index};
    SL_TRY(sl_mesh_build(&polygons, mesh, NULL, NULL));
cleanup:
    sl_free(number);
    sl_free(index);
    sl_free(first);
    sl_free(xyz);
    if (status != SL_OK) {
        sl_free(*vertex);
        *vertex = NULL;
    }
    return status;
}

sl_status sl_opt_decimate(const sl_patch *patch, int32_t triangles, sl_mesh **mesh, int32_t **vertex)
{
    sl_status status = SL_OK;
    decimation d = {0};
    *mesh = NULL;
    *vertex = NULL;
    SL_TRY(init(patch, &d));
    fill_quadrics(&d);
    run(&d, triangles);
    SL_TRY(build(&d, mesh, vertex));
cleanup:
    clear(&d);
    return status;
}
