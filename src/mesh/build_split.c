#include "base/memory.h"
#include "mesh/build_internal.h"
#include "mesh/corner_table_internal.h"

/* Room for nv vertices in all. */
static sl_status grow_vertices(sl_mesh *m, int64_t nv)
{
    if (nv > INT32_MAX) {
        return SL_OUT_OF_MEMORY;
    }
    double *xyz = sl_realloc(m->xyz, 3 * nv, sizeof *xyz);
    if (xyz == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    m->xyz = xyz;
    int32_t *input_vertex = sl_realloc(m->input_vertex, nv, sizeof *input_vertex);
    if (input_vertex == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    m->input_vertex = input_vertex;
    return SL_OK;
}

static void copy_vertex(sl_mesh *m, int32_t from, int32_t to)
{
    m->input_vertex[to] = from;
    for (int k = 0; k < 3; k++) {
        m->xyz[3 * (int64_t)to + k] = m->xyz[3 * (int64_t)from + k];
    }
}

/* The vertex of each fan: the input's own for its first fan, surface before isolated facets, and a copy for the others.
 */
static void number_fans(sl_builder *b, const int32_t *fan, int32_t *vertex_of_fan, uint8_t *taken)
{
    sl_mesh *m = b->mesh;
    for (int pass = 0; pass < 2; pass++) {
        for (int32_t h = 0; h < m->nh; h++) {
            if (vertex_of_fan[fan[h]] >= 0 || sl_build_isolated(m, m->face[h]) != (pass == 1)) {
                continue;
            }
            const int32_t v = m->origin[h];
            vertex_of_fan[fan[h]] = taken[v] != 0 ? m->nv : v;
            if (taken[v] != 0) {
                copy_vertex(m, v, m->nv++);
            }
            taken[v] = 1;
            b->surface_vertices += pass == 0;
        }
    }
}

static int32_t find_root(int32_t *parent, int32_t v)
{
    while (parent[v] != v) {
        parent[v] = parent[parent[v]];
        v = parent[v];
    }
    return v;
}

static void join_roots(int32_t *parent, int32_t a, int32_t b)
{
    const int32_t x = find_root(parent, a), y = find_root(parent, b);
    parent[x > y ? x : y] = x > y ? y : x;
}

/* A bowtie's fans meet in the point only: not those that the input joined along an edge that the repair has cut. */
static sl_status list_bowties(sl_builder *b)
{
    const sl_mesh *m = b->mesh;
    sl_repair_report *r = b->report;
    const int32_t nv = b->input->nv;
    int32_t *parent = sl_alloc(m->nv, sizeof *parent);
    uint8_t *bowtie = sl_calloc(nv, sizeof *bowtie), *surface = sl_calloc(m->nv, sizeof *surface);
    sl_status status = SL_OK;
    if (parent == NULL || bowtie == NULL || surface == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    for (int32_t v = 0; v < m->nv; v++) {
        parent[v] = v;
    }
    for (int32_t h = 0; h < m->nh; h++) {
        surface[m->origin[h]] = !sl_build_isolated(m, m->face[h]);
    }
    for (int64_t j = 0; j < b->joints; j++) {
        const int32_t x = b->joint[2 * j], y = b->joint[2 * j + 1];
        const bool along = m->input_vertex[m->origin[x]] == m->input_vertex[m->origin[y]];
        join_roots(parent, m->origin[x], along ? m->origin[y] : sl_target(m, y));
        join_roots(parent, sl_target(m, x), along ? sl_target(m, y) : m->origin[y]);
    }
    for (int32_t v = nv; v < m->nv; v++) {
        const int32_t first = m->input_vertex[v];
        if (surface[v] != 0 && bowtie[first] == 0 && find_root(parent, v) != find_root(parent, first)) {
            bowtie[first] = 1;
            r->bowtie_vertices++;
        }
    }
    r->bowtie = sl_alloc(r->bowtie_vertices, sizeof *r->bowtie);
    if (r->bowtie == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    for (int32_t v = 0, n = 0; v < nv; v++) {
        if (bowtie[v] != 0) {
            r->bowtie[n++] = v;
        }
    }
cleanup:
    sl_free(parent);
    sl_free(bowtie);
    sl_free(surface);
    return status;
}

sl_status sl_build_split_vertices(sl_builder *b)
{
    sl_status status = SL_OK;
    sl_mesh *m = b->mesh;
    const sl_corner_table table = {m->nf, m->nh, m->face_first, m->face, m->twin};
    int32_t *vertex = NULL;
    uint8_t *taken = sl_calloc(m->nv, sizeof *taken);
    int32_t *fan = sl_alloc(m->nh, sizeof *fan);
    if (taken == NULL || fan == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    const int32_t fans = sl_table_label_fans(&table, fan);
    vertex = sl_alloc(fans, sizeof *vertex);
    if (vertex == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    for (int32_t i = 0; i < fans; i++) {
        vertex[i] = -1;
    }
    const int32_t used = m->nv - b->report->unused_vertices; /* each of these takes one fan; the others need copies */
    SL_TRY(grow_vertices(m, (int64_t)m->nv + fans - used));
    number_fans(b, fan, vertex, taken);
    for (int32_t h = 0; h < m->nh; h++) {
        m->origin[h] = vertex[fan[h]];
    }
    SL_TRY(list_bowties(b));
cleanup:
    sl_free(taken);
    sl_free(fan);
    sl_free(vertex);
    return status;
}
