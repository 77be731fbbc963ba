/* New seams: along shortest paths, edge loops, edges one by one, the zipper backwards, nodal lines. */
#include "edit/session_internal.h"

#include "base/memory.h"
#include "graph/csr.h"
#include "spectral/spectrum.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { VECTORS = 12, SMOOTH_RINGS = 2 };

static const double scar_price = 0.25; /* of the length, where unsewing follows a seam that was */

/* Vertices joined by edges; halfedge[p]: the edge behind entry p. */
typedef struct edge_graph {
    sl_graph graph;
    int32_t *halfedge;
} edge_graph;

static void edge_graph_clear(edge_graph *g)
{
    sl_graph_clear(&g->graph);
    sl_free(g->halfedge);
}

/* slot >= 0: only edges inside that chart, those that were seams cheaper; -1 = all edges by their lengths. */
static double price(const sl_session *s, int32_t h, int32_t slot)
{
    const double length = sl_mesh_edge_length(s->mesh, h);
    if (slot < 0) {
        return length;
    }
    return s->face_chart[s->mesh->face[h]] == slot && s->mesh->twin[h] >= 0
               ? (s->scar[h] != 0 ? scar_price * length : length)
               : HUGE_VAL;
}

static sl_status edge_graph_init(const sl_session *s, int32_t slot, edge_graph *g)
{
    const sl_mesh *mesh = s->mesh;
    sl_status status = SL_OK;
    sl_graph *graph = &g->graph;
    graph->n = mesh->nv;
    graph->first = sl_calloc((int64_t)mesh->nv + 1, sizeof *graph->first);
    SL_TRY(graph->first != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int pass = 0; pass < 2; pass++) {
        for (int32_t h = 0; h < mesh->nh; h++) {
            if (sl_opposite(mesh, h) > h || sl_opposite(mesh, h) < 0) { /* one halfedge an edge */
                const int32_t end[2] = {mesh->origin[h], sl_target(mesh, h)};
                for (int k = 0; k < 2; k++) {
                    if (pass == 0) {
                        graph->first[end[k] + 1]++;
                    } else {
                        const int32_t at = graph->first[end[k]]++;
                        graph->adj[at] = end[1 - k];
                        graph->weight[at] = price(s, h, slot);
                        g->halfedge[at] = h;
                    }
                }
            }
        }
        if (pass == 0) {
            for (int32_t v = 0; v < mesh->nv; v++) {
                graph->first[v + 1] += graph->first[v];
            }
            const int64_t n = graph->first[mesh->nv];
            graph->adj = sl_alloc(n, sizeof *graph->adj);
            graph->weight = sl_alloc(n, sizeof *graph->weight);
            g->halfedge = sl_alloc(n, sizeof *g->halfedge);
            SL_TRY(graph->adj != NULL && graph->weight != NULL && g->halfedge != NULL ? SL_OK : SL_OUT_OF_MEMORY);
        }
    }
    memmove(graph->first + 1, graph->first, (size_t)mesh->nv * sizeof *graph->first);
    graph->first[0] = 0;
cleanup:
    return status;
}

/* Cuts the shortest path between two input vertices. Where a vertex of the input is several of the mesh, the nearest
 * pair counts. */
static sl_status cut_path(sl_session *s, const edge_graph *g, int32_t from, int32_t to, sl_diag *diag)
{
    const sl_mesh *mesh = s->mesh;
    sl_status status = SL_OK;
    int32_t sources = 0, best = -1;
    int32_t *source = sl_alloc(mesh->nv, sizeof *source), *parent = sl_alloc(mesh->nv, sizeof *parent);
    int32_t *entry = sl_alloc(mesh->nv, sizeof *entry);
    double *distance = sl_alloc(mesh->nv, sizeof *distance);
    SL_TRY(source != NULL && parent != NULL && entry != NULL && distance != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t v = 0; v < mesh->nv; v++) {
        if (mesh->input_vertex[v] == from && g->graph.first[v + 1] > g->graph.first[v]) {
            source[sources++] = v;
        }
    }
    if (sources > 0) {
        SL_TRY(sl_graph_shortest_paths(&g->graph, source, sources, NULL, -1, distance, parent, entry));
    }
    for (int32_t v = 0; v < mesh->nv && sources > 0; v++) {
        if (mesh->input_vertex[v] == to && distance[v] < HUGE_VAL && (best < 0 || distance[v] < distance[best])) {
            best = v;
        }
    }
    if (best < 0 || from == to) {
        sl_diag_reason(diag, "no path of edges leads from vertex %d to vertex %d", from, to);
        SL_TRY(SL_BAD_INPUT);
    }
    for (int32_t v = best; parent[v] >= 0; v = parent[v]) {
        SL_TRY(sl_change_set_edge(s, g->halfedge[entry[v]], true));
    }
cleanup:
    sl_free(source);
    sl_free(parent);
    sl_free(entry);
    sl_free(distance);
    return status;
}

/* Cutting what is cut already changes nothing, and that is said. */
static sl_status finish_cut(sl_session *s, const sl_context *context, sl_diag *diag)
{
    if (s->open_change.edges == 0) {
        sl_diag_reason(diag, "all these edges are seams, or the border, already");
        return SL_BAD_INPUT;
    }
    return sl_edit_regroup(s, context, diag);
}

sl_status sl_do_cut_path(sl_session *s, const sl_action *a, const sl_context *context, sl_diag *diag)
{
    sl_status status = SL_OK;
    edge_graph g = {0};
    SL_TRY(edge_graph_init(s, -1, &g));
    for (int32_t i = 0; i + 1 < a->count; i++) {
        SL_TRY(cut_path(s, &g, a->item[i], a->item[i + 1], diag));
    }
    SL_TRY(finish_cut(s, context, diag));
cleanup:
    edge_graph_clear(&g);
    return status;
}

/* An edge asked for, as one number; -1 until it is found. */
typedef struct wanted_edge {
    int64_t key;
    int32_t place, halfedge;
} wanted_edge;

static int64_t edge_key(int32_t v, int32_t w)
{
    return v < w ? ((int64_t)v << 32) + w : ((int64_t)w << 32) + v;
}

static int by_key(const void *a, const void *b)
{
    const wanted_edge *x = a, *y = b;
    return x->key != y->key ? (x->key > y->key) - (x->key < y->key) : x->place - y->place;
}

/* The first halfedge of each edge asked for: one pass over the mesh, whatever their number. */
static void find_edges(const sl_mesh *mesh, int32_t count, wanted_edge *wanted)
{
    qsort(wanted, (size_t)count, sizeof *wanted, by_key);
    for (int32_t h = 0; h < mesh->nh; h++) {
        const int64_t key = edge_key(mesh->input_vertex[mesh->origin[h]], mesh->input_vertex[sl_target(mesh, h)]);
        int32_t low = 0, high = count;
        while (low < high) { /* the first with this key */
            const int32_t middle = low + (high - low) / 2;
            low = wanted[middle].key < key ? middle + 1 : low;
            high = wanted[middle].key < key ? high : middle;
        }
        for (; low < count && wanted[low].key == key && wanted[low].halfedge < 0; low++) {
            wanted[low].halfedge = h;
        }
    }
}

sl_status sl_do_cut_edges(sl_session *s, const sl_action *a, const sl_context *context, sl_diag *diag)
{
    sl_status status = SL_OK;
    const int32_t n = a->count / 2;
    wanted_edge *wanted = sl_alloc(n, sizeof *wanted);
    SL_TRY(wanted != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t i = 0; i < n; i++) {
        wanted[i] = (wanted_edge){edge_key(a->item[2 * i], a->item[2 * i + 1]), i, -1};
    }
    find_edges(s->mesh, n, wanted);
    for (int32_t i = 0; i < n; i++) {
        if (wanted[i].halfedge < 0) {
            sl_diag_reason(diag, "no edge joins the vertices %d and %d", a->item[2 * wanted[i].place],
                           a->item[2 * wanted[i].place + 1]);
            SL_TRY(SL_BAD_INPUT);
        }
        SL_TRY(sl_change_set_edge(s, wanted[i].halfedge, true));
    }
    SL_TRY(finish_cut(s, context, diag));
cleanup:
    sl_free(wanted);
    return status;
}

/* The halfedge straight on at h's target, -1 where the vertex is not regular (four quads, six triangles), on a border
 * or on a seam other than the loop's own. */
static int32_t straight_on(const sl_mesh *mesh, int32_t h)
{
    const int32_t back = sl_opposite(mesh, h), degree = sl_degree(mesh, mesh->face[h]);
    const int32_t valence = degree == 4 ? 4 : degree == 3 ? 6 : 0;
    int32_t g = back, ahead = -1;
    for (int32_t k = 0; k < valence; k++) {
        const int32_t other = sl_opposite(mesh, g);
        if (other < 0 || sl_degree(mesh, mesh->face[g]) != degree || (g != back && mesh->sew[g] >= 0)) {
            return -1;
        }
        ahead = k == valence / 2 ? g : ahead;
        g = sl_next(mesh, other);
    }
    return g == back ? ahead : -1;
}

sl_status sl_do_cut_loop(sl_session *s, const sl_action *a, const sl_context *context, sl_diag *diag)
{
    sl_status status = SL_OK;
    int32_t h = -1;
    SL_TRY(sl_edit_take_side(s, a->item, &h, diag));
    SL_TRY(sl_change_set_edge(s, h, true));
    const int32_t start[2] = {h, sl_opposite(s->mesh, h)};
    for (int way = 0; way < 2; way++) { /* each step cuts an edge that was none, so the walk ends */
        for (int32_t g = straight_on(s->mesh, start[way]); g >= 0 && s->mesh->twin[g] >= 0;
             g = straight_on(s->mesh, g)) {
            SL_TRY(sl_change_set_edge(s, g, true));
        }
    }
    SL_TRY(finish_cut(s, context, diag));
cleanup:
    return status;
}

/* Cosine between the directions of two halfedges. */
static double cosine(const sl_mesh *mesh, int32_t g, int32_t h)
{
    double dot = 0.0, a = 0.0, b = 0.0;
    for (int k = 0; k < 3; k++) {
        const double x = mesh->xyz[3 * (int64_t)sl_target(mesh, g) + k] - mesh->xyz[3 * (int64_t)mesh->origin[g] + k];
        const double y = mesh->xyz[3 * (int64_t)sl_target(mesh, h) + k] - mesh->xyz[3 * (int64_t)mesh->origin[h] + k];
        dot += x * y;
        a += x * x;
        b += y * y;
    }
    return a > 0.0 && b > 0.0 ? dot / sqrt(a * b) : -1.0;
}

/* Where the zipper goes on opening behind the cut edge h: along what was a seam, else straight on; only_scars: not
 * else. -1 = it has reached a border. */
static int32_t open_next(const sl_session *s, int32_t h, bool only_scars)
{
    const sl_mesh *mesh = s->mesh;
    int32_t best = -1;
    double most = -2.0;
    int32_t g = sl_next(mesh, h);
    for (; mesh->twin[g] >= 0; g = sl_next(mesh, mesh->twin[g])) {
        const double along = cosine(mesh, h, g) + (s->scar[g] != 0 ? 4.0 : 0.0);
        if ((s->scar[g] != 0 || !only_scars) && along > most) {
            most = along;
            best = g;
        }
    }
    return g == mesh->sew[h] ? best : -1;
}

sl_status sl_do_unsew(sl_session *s, const sl_action *a, const sl_context *context, sl_diag *diag)
{
    sl_status status = SL_OK;
    edge_graph graph = {0};
    int32_t h = -1;
    SL_TRY(sl_edit_take_side(s, a->item, &h, diag));
    if (s->mesh->sew[h] >= 0) {
        sl_diag_reason(diag, "the edge from vertex %d to vertex %d is a seam already", a->item[0], a->item[1]);
        SL_TRY(SL_BAD_INPUT);
    }
    if (a->to >= 0) {
        SL_TRY(edge_graph_init(s, s->face_chart[s->mesh->face[h]], &graph));
        SL_TRY(sl_change_set_edge(s, h, true));
        if (a->to != a->item[1]) {
            SL_TRY(cut_path(s, &graph, a->item[1], a->to, diag));
        }
    } else {
        const double limit = a->number * s->mesh->scale;
        double length = 0.0;
        while (h >= 0) {
            const double edge = sl_mesh_edge_length(s->mesh, h);
            if (a->number > 0.0 && length > 0.0 && length + 0.5 * edge > limit) {
                break;
            }
            length += edge;
            SL_TRY(sl_change_set_edge(s, h, true));
            h = open_next(s, h, a->number == 0.0);
        }
    }
    SL_TRY(sl_edit_regroup(s, context, diag));
cleanup:
    edge_graph_clear(&graph);
    return status;
}

/* Do the sides of a cut each make one disk? */
static sl_status halves_are_disks(const sl_session *s, const sl_edit_chart *chart, const uint8_t *side, bool *good)
{
    sl_status status = SL_OK;
    int32_t *face = sl_alloc(chart->nface, sizeof *face);
    SL_TRY(face != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    *good = true;
    for (uint8_t k = 0; k < 2 && *good; k++) {
        sl_topology topology = {0};
        int32_t n = 0;
        for (int32_t i = 0; i < chart->nface; i++) {
            face[n] = chart->face[i];
            n += side[i] == k;
        }
        if (n > 0) {
            SL_TRY(sl_mesh_topology(s->mesh, face, n, &topology));
        }
        *good = n > 0 && topology.euler == 1 && topology.loops == 1;
    }
cleanup:
    sl_free(face);
    return status;
}

/* The longest of the cuts that make two disks (paper, Sec. 3.3), smoothed where that keeps them so. side: a facet. */
static sl_status choose_side(const sl_session *s, const sl_edit_chart *chart, const sl_context *context, uint8_t *side,
                             bool *found)
{
    sl_status status = SL_OK;
    sl_facet_graph *graph = NULL;
    sl_spectrum *spectrum = NULL;
    sl_cut_candidate *candidate = NULL;
    uint8_t *trial = sl_alloc(chart->nface, 1);
    double longest = -1.0;
    *found = false;
    SL_TRY(trial != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(sl_facet_graph_create(s->mesh, chart->face, chart->nface, NULL, &graph));
    SL_TRY(sl_spectrum_compute_signs(graph, VECTORS, context, &spectrum));
    candidate = sl_calloc(spectrum->count, sizeof *candidate);
    SL_TRY(candidate != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(sl_cut_candidates(s->mesh, graph, spectrum, candidate));
    for (int32_t k = 0; k + 1 < spectrum->count; k++) {
        bool good = false, changed = false;
        if (!candidate[k].passes || !(candidate[k].seam_length > longest)) {
            continue;
        }
        sl_spectrum_side(spectrum, candidate[k].vector, trial);
        SL_TRY(halves_are_disks(s, chart, trial, &good));
        if (good) {
            longest = candidate[k].seam_length;
            *found = true;
            memcpy(side, trial, (size_t)chart->nface);
            SL_TRY(sl_smooth_cut(s->mesh, graph, NULL, SMOOTH_RINGS, trial, &changed));
            SL_TRY(halves_are_disks(s, chart, trial, &good));
            memcpy(side, good ? trial : side, (size_t)chart->nface);
        }
    }
cleanup:
    sl_facet_graph_free(graph);
    sl_spectrum_free(spectrum);
    sl_free(candidate);
    sl_free(trial);
    return status;
}

sl_status sl_do_cut_chart(sl_session *s, const sl_action *a, const sl_context *context, sl_diag *diag)
{
    const sl_mesh *mesh = s->mesh;
    sl_status status = SL_OK;
    uint8_t *side = NULL;
    bool found = false;
    if (a->facet < 0 || a->facet >= mesh->nf) {
        sl_diag_reason(diag, "there is no facet %d", a->facet);
        return SL_BAD_INPUT;
    }
    const sl_edit_chart *chart = s->slot[s->face_chart[a->facet]].chart;
    side = sl_calloc(chart->nface, 1);
    SL_TRY(side != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    if (chart->nface > 1) {
        SL_TRY(choose_side(s, chart, context, side, &found));
    }
    if (!found) {
        sl_diag_reason(diag, "no nodal line cuts this chart of %d facets into two disks", chart->nface);
        SL_TRY(SL_INFEASIBLE);
    }
    for (int32_t i = 0; i < chart->nface; i++) {
        s->face_mark[chart->face[i]] = side[i];
    }
    for (int32_t i = 0; i < chart->nface && status == SL_OK; i++) {
        for (int32_t h = mesh->face_first[chart->face[i]]; h < mesh->face_first[chart->face[i] + 1]; h++) {
            const int32_t g = mesh->twin[h];
            if (g >= 0 && s->face_mark[mesh->face[g]] != side[i] && status == SL_OK) {
                status = sl_change_set_edge(s, h, true);
            }
        }
    }
    for (int32_t i = 0; i < chart->nface; i++) {
        s->face_mark[chart->face[i]] = -1;
    }
    SL_TRY(status);
    SL_TRY(sl_edit_regroup(s, context, diag));
cleanup:
    sl_free(side);
    return status;
}
