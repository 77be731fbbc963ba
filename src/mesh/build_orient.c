#include "base/memory.h"
#include "mesh/build_internal.h"
#include "mesh/edge_groups_internal.h"

sl_status sl_build_add_joint(sl_builder *b, int32_t x, int32_t y)
{
    sl_status status = SL_OK;
    SL_TRY(sl_reserve((void **)&b->joint, &b->joint_capacity, 2 * b->joints + 2, sizeof *b->joint));
    b->joint[2 * b->joints] = x;
    b->joint[2 * b->joints + 1] = y;
    b->joints++;
cleanup:
    return status;
}

/* An edge of three and more facets: nothing is glued, all is remembered. */
static sl_status add_nonmanifold(sl_builder *b, const sl_edge_group *group)
{
    sl_status status = SL_OK;
    sl_repair_report *r = b->report;
    const int64_t n = r->nonmanifold_edges;
    const int32_t h = sl_edge_group_halfedge(group, 0);
    SL_TRY(sl_reserve((void **)&r->nonmanifold, &b->nonmanifold_capacity, 2 * n + 2, sizeof *r->nonmanifold));
    r->nonmanifold[2 * n] = b->mesh->origin[h];
    r->nonmanifold[2 * n + 1] = sl_target(b->mesh, h);
    r->nonmanifold_edges++;
    for (int32_t i = 1; i < group->count; i++) {
        SL_TRY(sl_build_add_joint(b, h, sl_edge_group_halfedge(group, i)));
    }
cleanup:
    return status;
}

sl_status sl_build_match_edges(sl_builder *b)
{
    sl_status status = SL_OK;
    sl_mesh *m = b->mesh;
    sl_edge_groups groups = {0};
    int32_t *from = m->twin, *to = m->sew; /* work space until the groups stand */
    for (int32_t h = 0; h < m->nh; h++) {
        from[h] = sl_build_isolated(m, m->face[h]) ? -1 : m->origin[h];
        to[h] = sl_target(m, h);
    }
    SL_TRY(sl_edge_groups_init(m->nv, m->nh, from, to, &groups));
    for (int32_t h = 0; h < m->nh; h++) {
        m->twin[h] = m->sew[h] = -1;
    }
    sl_edge_cursor cursor = {0};
    sl_edge_group group;
    while (sl_edge_groups_next(&groups, &cursor, &group)) {
        if (group.count == 2) {
            const int32_t x = sl_edge_group_halfedge(&group, 0), y = sl_edge_group_halfedge(&group, 1);
            m->twin[x] = y;
            m->twin[y] = x;
        } else if (group.count > 2) {
            SL_TRY(add_nonmanifold(b, &group));
        }
    }
cleanup:
    sl_edge_groups_clear(&groups);
    return status;
}

typedef struct orientation {
    int8_t *flip;   /* nf: 1 = against the component's first facet, -1 = not reached */
    int32_t *queue; /* nf */
    double area[2]; /* of the component's facets by flip */
    int32_t cuts;   /* contradictions cut in the component */
} orientation;

/* Passes f's orientation on to its neighbours. */
static sl_status orient_neighbours(sl_builder *b, orientation *o, int32_t f, int32_t *end)
{
    sl_status status = SL_OK;
    sl_mesh *m = b->mesh;
    for (int32_t h = m->face_first[f]; h < m->face_first[f + 1]; h++) {
        const int32_t t = m->twin[h];
        if (t < 0) {
            continue;
        }
        const int32_t g = m->face[t];
        const int8_t flip = m->origin[h] == m->origin[t] ? !o->flip[f] : o->flip[f];
        if (o->flip[g] < 0) {
            o->flip[g] = flip;
            o->queue[(*end)++] = g;
        } else if (o->flip[g] != flip) {
            SL_TRY(sl_build_add_joint(b, h, t));
            m->twin[h] = m->twin[t] = -1;
            o->cuts++;
        }
    }
cleanup:
    return status;
}

/* Orients the component of `seed` by breadth-first search and marks what has to be reversed. */
static sl_status orient_component(sl_builder *b, orientation *o, int32_t seed)
{
    sl_status status = SL_OK;
    int32_t begin = 0, end = 0;
    o->area[0] = o->area[1] = 0.0;
    o->cuts = 0;
    o->flip[seed] = 0;
    o->queue[end++] = seed;
    while (begin < end) {
        const int32_t f = o->queue[begin++];
        o->area[o->flip[f]] += sl_mesh_face_area(b->mesh, f);
        SL_TRY(orient_neighbours(b, o, f, &end));
    }
    const int8_t wrong = o->area[1] > o->area[0] ? 0 : 1;
    for (int32_t i = 0; i < end; i++) {
        if (o->flip[o->queue[i]] == wrong) {
            b->mesh->face_flags[o->queue[i]] |= SL_FACE_REVERSED;
        }
    }
    b->report->components++;
    b->report->one_sided_components += o->cuts > 0;
    b->report->one_sided_cuts += o->cuts;
cleanup:
    return status;
}

/* Where halfedge h goes when its facet is reversed: the same edge, run the other way. */
static int32_t reversed_halfedge(const sl_mesh *m, int32_t h)
{
    const int32_t f = m->face[h];
    const bool reversed = (m->face_flags[f] & SL_FACE_REVERSED) != 0;
    return reversed ? m->face_first[f] + (m->face_first[f + 1] - 1 - h) : h;
}

static void reverse_range(int32_t *a, int32_t n)
{
    for (int32_t i = 0, j = n - 1; i < j; i++, j--) {
        const int32_t t = a[i];
        a[i] = a[j];
        a[j] = t;
    }
}

static void reverse_facets(sl_builder *b)
{
    sl_mesh *m = b->mesh;
    for (int32_t h = 0; h < m->nh; h++) {
        m->twin[h] = m->twin[h] >= 0 ? reversed_halfedge(m, m->twin[h]) : -1;
    }
    for (int64_t i = 0; i < 2 * b->joints; i++) {
        b->joint[i] = reversed_halfedge(m, b->joint[i]);
    }
    for (int32_t f = 0; f < m->nf; f++) {
        if ((m->face_flags[f] & SL_FACE_REVERSED) != 0) {
            const int32_t first = m->face_first[f], d = sl_degree(m, f);
            reverse_range(m->origin + first + 1, d - 1); /* the first corner stays the first */
            reverse_range(m->twin + first, d);
        }
    }
}

sl_status sl_build_orient(sl_builder *b)
{
    sl_status status = SL_OK;
    const sl_mesh *m = b->mesh;
    orientation o = {.flip = sl_alloc(m->nf, sizeof *o.flip), .queue = sl_alloc(m->nf, sizeof *o.queue)};
    if (o.flip == NULL || o.queue == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    for (int32_t f = 0; f < m->nf; f++) {
        o.flip[f] = -1;
    }
    for (int32_t f = 0; f < m->nf; f++) {
        if (o.flip[f] < 0 && !sl_build_isolated(m, f)) {
            SL_TRY(orient_component(b, &o, f));
        }
    }
    reverse_facets(b);
cleanup:
    sl_free(o.flip);
    sl_free(o.queue);
    return status;
}
