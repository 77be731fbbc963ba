#include "mesh/facet_graph.h"

#include "base/memory.h"
#include "geom/vec3.h"
#include "mesh/face_map_internal.h"

typedef struct graph_builder {
    const sl_mesh *mesh;
    const int32_t *faces, *partner;
    int32_t nfaces;
    sl_face_map map;
    int32_t *head; /* n: position in faces of a node's first facet */
    int32_t *mate; /* nfaces: position of the facet in the same node, -1 = none */
    sl_facet_graph *out;
} graph_builder;

/* Position of f's partner when the pair counts: in the set, mutual, and glued; else -1. */
static int32_t mate_position(const graph_builder *b, int32_t f)
{
    const int32_t g = b->partner != NULL ? b->partner[f] : -1;
    if (g < 0 || g == f || b->partner[g] != f) {
        return -1;
    }
    for (int32_t h = b->mesh->face_first[f]; h < b->mesh->face_first[f + 1]; h++) {
        if (b->mesh->twin[h] >= 0 && b->mesh->face[b->mesh->twin[h]] == g) {
            return sl_face_map_find(&b->map, g);
        }
    }
    return -1;
}

static void number_nodes(graph_builder *b)
{
    sl_facet_graph *g = b->out;
    for (int32_t i = 0; i < b->nfaces; i++) {
        b->mate[i] = mate_position(b, b->faces[i]);
        if (b->mate[i] >= 0 && b->mate[i] < i) {
            g->node[i] = g->node[b->mate[i]];
        } else {
            b->head[g->graph.n] = i;
            g->node[i] = g->graph.n++;
        }
    }
}

/* Node across halfedge h of the facet at position i; -1 for borders of the set and loops. */
static int32_t node_across(const graph_builder *b, int32_t i, int32_t h)
{
    const int32_t t = b->mesh->twin[h];
    const int32_t j = t >= 0 ? sl_face_map_find(&b->map, b->mesh->face[t]) : -1;
    return j >= 0 && b->out->node[j] != b->out->node[i] ? b->out->node[j] : -1;
}

/* Writes the entries of the facet at position i from p on (count only when adj is NULL); returns the end. */
static int32_t write_facet(const graph_builder *b, int32_t i, int32_t p)
{
    const sl_mesh *m = b->mesh;
    for (int32_t h = m->face_first[b->faces[i]]; h < m->face_first[b->faces[i] + 1]; h++) {
        const int32_t node = node_across(b, i, h);
        if (node >= 0) {
            if (b->out->graph.adj != NULL) {
                b->out->graph.adj[p] = node;
                b->out->halfedge[p] = h;
            }
            p++;
        }
    }
    return p;
}

static void write_rows(const graph_builder *b)
{
    sl_graph *g = &b->out->graph;
    int32_t p = 0;
    for (int32_t n = 0; n < g->n; n++) {
        const int32_t i = b->head[n];
        g->first[n] = p;
        p = write_facet(b, i, p);
        p = b->mate[i] >= 0 ? write_facet(b, b->mate[i], p) : p;
    }
    g->first[g->n] = p;
}

/* Mean of the different corners of the node: a pair's diagonal counts once. */
static void node_centroid(const graph_builder *b, int32_t n, double c[3])
{
    const sl_mesh *m = b->mesh;
    const int32_t i = b->head[n], f = b->faces[i];
    sl_mesh_face_centroid(m, f, c);
    if (b->mate[i] < 0) {
        return;
    }
    const int32_t g = b->faces[b->mate[i]];
    int32_t shared = m->face_first[g];
    while (m->twin[shared] < 0 || m->face[m->twin[shared]] != f) {
        shared++;
    }
    const int32_t df = sl_degree(m, f), dg = sl_degree(m, g);
    for (int k = 0; k < 3; k++) {
        c[k] *= df;
    }
    int32_t h = sl_next(m, shared);
    for (int32_t k = 0; k < dg - 2; k++) {
        h = sl_next(m, h);
        sl_vec3_add(c, m->xyz + 3 * (int64_t)m->origin[h], c);
    }
    for (int k = 0; k < 3; k++) {
        c[k] /= df + dg - 2;
    }
}

static sl_status fill(graph_builder *b)
{
    sl_status status = SL_OK;
    sl_facet_graph *g = b->out;
    SL_TRY(sl_face_map_init(b->mesh->nf, b->faces, b->nfaces, &b->map));
    number_nodes(b);
    g->graph.first = sl_alloc((int64_t)g->graph.n + 1, sizeof *g->graph.first);
    g->centroid = sl_alloc(3 * (int64_t)g->graph.n, sizeof *g->centroid);
    SL_TRY(g->graph.first != NULL && g->centroid != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    write_rows(b);
    g->graph.adj = sl_alloc(g->graph.first[g->graph.n], sizeof *g->graph.adj);
    g->halfedge = sl_alloc(g->graph.first[g->graph.n], sizeof *g->halfedge);
    SL_TRY(g->graph.adj != NULL && g->halfedge != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    write_rows(b);
    for (int32_t n = 0; n < g->graph.n; n++) {
        node_centroid(b, n, g->centroid + 3 * (int64_t)n);
    }
cleanup:
    return status;
}

sl_status sl_facet_graph_create(const sl_mesh *mesh, const int32_t *faces, int32_t nfaces, const int32_t *partner,
                                sl_facet_graph **out)
{
    sl_status status = SL_OK;
    graph_builder b = {.mesh = mesh, .faces = faces, .partner = partner, .nfaces = nfaces};
    b.head = sl_alloc(nfaces, sizeof *b.head);
    b.mate = sl_alloc(nfaces, sizeof *b.mate);
    b.out = sl_calloc(1, sizeof *b.out);
    SL_TRY(b.head != NULL && b.mate != NULL && b.out != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    b.out->node = sl_alloc(nfaces, sizeof *b.out->node);
    SL_TRY(b.out->node != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(fill(&b));
    *out = b.out;
    b.out = NULL;
cleanup:
    sl_face_map_clear(&b.map);
    sl_free(b.head);
    sl_free(b.mate);
    sl_facet_graph_free(b.out);
    return status;
}

void sl_facet_graph_free(sl_facet_graph *graph)
{
    if (graph == NULL) {
        return;
    }
    sl_graph_clear(&graph->graph);
    sl_free(graph->halfedge);
    sl_free(graph->node);
    sl_free(graph->centroid);
    sl_free(graph);
}
