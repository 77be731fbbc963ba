#include "param/stretch_levels_internal.h"

#include "base/memory.h"
#include "geom/vec3.h"

#include <math.h>
#include <string.h>

/* What a collapse may do, pass by pass: the share of the ring's area that may go, the least shape of a new triangle
 * (1 = equilateral). The last entry stands for all further passes. */
static const double AREA_LOSS[] = {0.02, 0.05, 0.1, 0.2}, LEAST_SHAPE[] = {0.4, 0.3, 0.2, 0.1};
static const double LOSS_WEIGHT = 5.0; /* of lost area against shape where the best of several collapses is chosen */
static const double SHAPE_UNIT = 6.92820323027550917411; /* 4 sqrt(3): the shape of an equilateral triangle is 1 */
static const double FEWEST = 0.02; /* a pass that removes less than this share of the triangles is the last */
enum { PASSES = 40, MOST_NEIGHBOURS = 14, LEAST_BORDER = 12, NO_PLACE = -1 };

/* The mesh as it shrinks. */
typedef struct shrinking {
    const sl_patch *patch;
    int32_t *tri, *twin, *outgoing; /* triangles that are gone have tri -1 */
    int32_t *touched;               /* nv: the last pass that changed the vertex's triangles; INT32_MAX = removed */
    int32_t *mark;                  /* nv: stamps of the test for common neighbours */
    int32_t stamp, nt, nb;          /* nb: border vertices */
    int32_t removals;
    int64_t ring_size;
} shrinking;

/* One vertex and those around it, counter-clockwise; at the border from the next vertex along it to the last one. */
typedef struct ring {
    int32_t count;
    bool open; /* the vertex is on the border: its first and last neighbour share no triangle with it */
    int32_t halfedge[SL_RING_MAX]; /* leaving the vertex; -1 for the last neighbour of an open ring */
    int32_t vertex[SL_RING_MAX];
    double xyz[SL_RING_MAX][3];
    double area; /* of its triangles */
} ring;

/* Shape and area of a triangle in space. */
static double shape_of(const double a[3], const double b[3], const double c[3], double *area)
{
    double e[3], f[3], g[3], n[3];
    sl_vec3_sub(b, a, e);
    sl_vec3_sub(c, a, f);
    sl_vec3_sub(c, b, g);
    sl_vec3_cross(e, f, n);
    *area = 0.5 * sl_vec3_norm(n);
    const double sum = sl_vec3_dot(e, e) + sl_vec3_dot(f, f) + sl_vec3_dot(g, g);
    return sum > 0.0 ? SHAPE_UNIT * *area / sum : 0.0;
}

/* False when there are too many. */
static bool gather_neighbours(const shrinking *s, int32_t v, ring *r)
{
    int32_t h = s->outgoing[v];
    r->count = 0;
    r->open = s->patch->border[v] != 0;
    do {
        const int32_t before = sl_corner_prev(h);
        if (r->count + 2 > SL_RING_MAX) {
            return false;
        }
        r->halfedge[r->count] = h;
        r->vertex[r->count++] = s->tri[sl_corner_next(h)];
        h = s->twin[before];
        if (h < 0) {
            r->halfedge[r->count] = -1;
            r->vertex[r->count++] = s->tri[before];
        }
    } while (h >= 0 && h != s->outgoing[v]);
    return true;
}

/* False when the vertex has too many neighbours, or is an ear of the border. */
static bool gather_ring(const shrinking *s, int32_t v, ring *r)
{
    if (!gather_neighbours(s, v, r) || r->count < 3) {
        return false;
    }
    const double *x = &s->patch->xyz[3 * (int64_t)v];
    for (int32_t i = 0; i < r->count; i++) {
        memcpy(r->xyz[i], &s->patch->xyz[3 * (int64_t)r->vertex[i]], sizeof r->xyz[i]);
    }
    r->area = 0.0;
    for (int32_t i = 0; i < r->count - (r->open ? 1 : 0); i++) {
        double area;
        shape_of(x, r->xyz[i], r->xyz[(i + 1) % r->count], &area);
        r->area += area;
    }
    return true;
}

/* How good the triangles are when the vertex moves into neighbour j; negative when they are not to be had. */
static double collapse_score(const ring *r, int32_t j, double most_loss, double least_shape)
{
    double total = 0.0, worst = 1.0;
    for (int32_t i = 1; i + 1 < r->count; i++) {
        double area;
        const double shape = shape_of(r->xyz[j], r->xyz[(j + i) % r->count], r->xyz[(j + i + 1) % r->count], &area);
        if (!(shape >= least_shape)) {
            return -1.0;
        }
        worst = shape < worst ? shape : worst;
        total += area;
    }
    const double loss = r->area > 0.0 ? fabs(total - r->area) / r->area : 0.0;
    return loss <= most_loss ? LOSS_WEIGHT + worst - LOSS_WEIGHT * loss : -1.0;
}

/* Marks the neighbours of u with the stamp; returns how many there are. */
static int32_t mark_neighbours(shrinking *s, int32_t u)
{
    int32_t h = s->outgoing[u], count = 0;
    s->stamp++;
    do {
        s->mark[s->tri[sl_corner_next(h)]] = s->stamp;
        count++;
        const int32_t before = sl_corner_prev(h);
        h = s->twin[before];
        if (h < 0) { /* the last triangle of a border vertex */
            s->mark[s->tri[before]] = s->stamp;
            count++;
        }
    } while (h >= 0 && h != s->outgoing[u]);
    return count;
}

static bool has_three_neighbours(const shrinking *s, int32_t v)
{
    int32_t h = s->outgoing[v];
    for (int32_t i = 0; i < 3; i++) {
        h = s->twin[sl_corner_prev(h)];
    }
    return h == s->outgoing[v];
}

/* Does moving the ring's vertex into neighbour j leave a disk? */
static bool keeps_topology(shrinking *s, const ring *r, int32_t j)
{
    const int32_t u = r->vertex[j];
    const int32_t a = r->vertex[(j + 1) % r->count], b = r->vertex[(j + r->count - 1) % r->count];
    if ((!s->patch->border[a] && has_three_neighbours(s, a)) || (!s->patch->border[b] && has_three_neighbours(s, b)) ||
        mark_neighbours(s, u) + r->count - 4 > MOST_NEIGHBOURS || (r->open && s->nb <= LEAST_BORDER)) {
        return false;
    }
    int32_t common = 0;
    for (int32_t i = 0; i < r->count; i++) {
        common += s->mark[r->vertex[i]] == s->stamp;
    }
    return common == (r->open ? 1 : 2);
}

/* The two halfedges now face each other; the outer one may be none. */
static void glue(shrinking *s, int32_t inner, int32_t outer)
{
    s->twin[inner] = outer;
    if (outer >= 0) {
        s->twin[outer] = inner;
    }
}

static void drop_triangle(shrinking *s, int32_t h)
{
    const int32_t t = h / 3;
    s->tri[3 * t] = s->tri[3 * t + 1] = s->tri[3 * t + 2] = -1;
    s->nt--;
}

/* The triangle (v, u, a) of h = v -> u goes; u -> a, once v -> a, takes its place. */
static void close_left(shrinking *s, int32_t h, int32_t u)
{
    const int32_t to_a = sl_corner_next(h), from_a = sl_corner_prev(h), a = s->tri[from_a], ua = s->twin[from_a];
    glue(s, ua, s->twin[to_a]);
    if (s->outgoing[u] == to_a || s->patch->border[u] == 0) {
        s->outgoing[u] = ua;
    }
    if (s->outgoing[a] == from_a) {
        s->outgoing[a] = sl_corner_next(ua);
    }
    drop_triangle(s, h);
}

/* The triangle (u, v, b) of back = u -> v goes; b -> u, once b -> v, takes its place. */
static void close_right(shrinking *s, int32_t back)
{
    const int32_t to_b = sl_corner_next(back), from_b = sl_corner_prev(back), b = s->tri[from_b], bu = s->twin[to_b];
    glue(s, bu, s->twin[from_b]);
    if (s->outgoing[b] == from_b) {
        s->outgoing[b] = bu;
    }
    drop_triangle(s, back);
}

/* The vertex of the ring moves into u = r->vertex[j]. */
static void collapse(shrinking *s, const ring *r, int32_t j)
{
    const int32_t h = r->halfedge[j], u = r->vertex[j], n = r->count;
    const int32_t back = h >= 0 ? s->twin[h] : sl_corner_prev(r->halfedge[n - 2]);
    for (int32_t i = 0; i < n; i++) {
        if (r->halfedge[i] >= 0) {
            s->tri[r->halfedge[i]] = u;
        }
    }
    if (h < 0) { /* the border goes on from u where it went on from v */
        s->outgoing[u] = r->halfedge[0];
    } else {
        close_left(s, h, u);
    }
    if (back >= 0) {
        close_right(s, back);
    }
    s->nb -= r->open ? 1 : 0;
}

/* Moves v into the neighbour where that does least harm, if it may move at all. */
static void try_vertex(shrinking *s, int32_t v, int32_t pass, sl_levels *levels)
{
    const int32_t rule = pass < (int32_t)SL_COUNTOF(AREA_LOSS) ? pass : (int32_t)SL_COUNTOF(AREA_LOSS) - 1;
    ring r;
    double score[SL_RING_MAX];
    if (!gather_ring(s, v, &r)) {
        return;
    }
    for (int32_t j = 0; j < r.count; j++) { /* a border vertex moves along the border */
        const bool may = !r.open || j == 0 || j == r.count - 1;
        score[j] = may ? collapse_score(&r, j, AREA_LOSS[rule], LEAST_SHAPE[rule]) : -1.0;
    }
    for (int32_t tries = 0; tries < r.count; tries++) {
        int32_t best = 0;
        for (int32_t j = 1; j < r.count; j++) {
            best = score[j] > score[best] ? j : best;
        }
        if (score[best] < 0.0) {
            return;
        }
        if (!keeps_topology(s, &r, best)) {
            score[best] = -1.0;
            continue;
        }
        levels->removal[s->removals++] = (sl_removal){v, r.count, best, r.open, s->ring_size};
        for (int32_t i = 0; i < r.count; i++) {
            levels->ring[s->ring_size++] = r.vertex[i];
            s->touched[r.vertex[i]] = pass;
        }
        s->touched[v] = INT32_MAX;
        collapse(s, &r, best);
        return;
    }
}

/* Keeps the mesh as it is now as one more level. */
static sl_status keep_level(const shrinking *s, sl_levels *levels)
{
    sl_level *level = &levels->level[levels->count];
    int32_t *place = sl_alloc(s->patch->nt, sizeof *place);
    *level = (sl_level){.removals = s->removals, .nt = s->nt};
    level->tri = sl_alloc(3 * (int64_t)s->nt, sizeof *level->tri);
    level->twin = sl_alloc(3 * (int64_t)s->nt, sizeof *level->twin);
    levels->count++;
    if (place == NULL || level->tri == NULL || level->twin == NULL) {
        sl_free(place);
        return SL_OUT_OF_MEMORY;
    }
    int32_t n = 0;
    for (int32_t t = 0; t < s->patch->nt; t++) {
        place[t] = s->tri[3 * t] >= 0 ? n++ : NO_PLACE;
    }
    for (int32_t h = 0; h < 3 * s->patch->nt; h++) {
        if (place[h / 3] >= 0) {
            const int32_t to = 3 * place[h / 3] + h % 3, other = s->twin[h];
            level->tri[to] = s->tri[h];
            level->twin[to] = other >= 0 ? 3 * place[other / 3] + other % 3 : -1;
        }
    }
    sl_free(place);
    for (int32_t t = 0; t < level->nt; t++) {
        const int32_t *v = &level->tri[3 * (int64_t)t];
        double area;
        shape_of(&s->patch->xyz[3 * (int64_t)v[0]], &s->patch->xyz[3 * (int64_t)v[1]],
                 &s->patch->xyz[3 * (int64_t)v[2]], &area);
        level->area += area;
    }
    return SL_OK;
}

static sl_status shrink(shrinking *s, double share, int32_t least, sl_levels *levels)
{
    sl_status status = SL_OK;
    int32_t last = s->nt;
    for (int32_t pass = 0; pass < PASSES && levels->count < SL_LEVELS_MAX && s->nt >= least; pass++) {
        const int32_t before = s->nt;
        for (int32_t v = 0; v < s->patch->nv; v++) {
            if (s->touched[v] < pass) {
                try_vertex(s, v, pass, levels);
            }
        }
        const bool stuck = before - s->nt < FEWEST * before && pass >= (int32_t)SL_COUNTOF(AREA_LOSS) - 1;
        if (s->nt <= share * last || ((stuck || s->nt < least) && s->nt < sqrt(share) * last)) {
            SL_TRY(keep_level(s, levels));
            last = s->nt;
        }
        if (stuck) {
            break;
        }
    }
cleanup:
    return status;
}

sl_status sl_levels_create(const sl_patch *patch, double share, int32_t least, sl_levels *levels)
{
    sl_status status = SL_OK;
    shrinking s = {.patch = patch, .nt = patch->nt};
    *levels = (sl_levels){0};
    const size_t size = 3 * (size_t)patch->nt * sizeof(int32_t);
    s.tri = sl_alloc(3 * (int64_t)patch->nt, sizeof *s.tri);
    s.twin = sl_alloc(3 * (int64_t)patch->nt, sizeof *s.twin);
    s.outgoing = sl_alloc(patch->nv, sizeof *s.outgoing);
    s.touched = sl_alloc(patch->nv, sizeof *s.touched);
    s.mark = sl_calloc(patch->nv, sizeof *s.mark);
    levels->removal = sl_alloc(patch->nv, sizeof *levels->removal);
    levels->ring = sl_alloc(patch->nv, SL_RING_MAX * sizeof *levels->ring);
    if (s.tri == NULL || s.twin == NULL || s.outgoing == NULL || s.touched == NULL || s.mark == NULL ||
        levels->removal == NULL || levels->ring == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    memcpy(s.tri, patch->tri, size);
    memcpy(s.twin, patch->twin, size);
    memcpy(s.outgoing, patch->outgoing, (size_t)patch->nv * sizeof *s.outgoing);
    for (int32_t v = 0; v < patch->nv; v++) {
        s.nb += patch->border[v] != 0;
    }
    memset(s.touched, -1, (size_t)patch->nv * sizeof *s.touched);
    status = shrink(&s, share, least, levels);
cleanup:
    sl_free(s.tri);
    sl_free(s.twin);
    sl_free(s.outgoing);
    sl_free(s.touched);
    sl_free(s.mark);
    if (status != SL_OK) {
        sl_levels_clear(levels);
    }
    return status;
}

void sl_levels_clear(sl_levels *levels)
{
    for (int32_t l = 0; l < levels->count; l++) {
        sl_free(levels->level[l].tri);
        sl_free(levels->level[l].twin);
    }
    sl_free(levels->removal);
    sl_free(levels->ring);
    *levels = (sl_levels){0};
}
