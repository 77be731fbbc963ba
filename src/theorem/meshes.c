/* The theorem on the facet graphs of meshes. */
#include "theorem/meshes.h"

#include "base/memory.h"
#include "mesh/facet_graph.h"

#include <stdio.h>
#include <string.h>

/* One component on its way. */
typedef struct component_work {
    const sl_mesh *mesh;
    const sl_symmetry *symmetry;
    const sl_theorem_def *def;
    const sl_context *context;
    sl_facet_graph *graph;
    int32_t *place;  /* mesh facets: position in the component */
    int32_t *chosen; /* maps */
    int32_t count;
    int32_t *images;      /* count x nodes: each chosen map on the nodes */
    int32_t *renumbered;  /* the same in a mirror's own numbers */
    const int32_t **maps; /* rows of it that commute with the mirror */
    int32_t *to;          /* nodes: numbers of the theorem's graph */
} component_work;

static void work_clear(component_work *w)
{
    sl_facet_graph_free(w->graph);
    sl_free(w->chosen);
    sl_free(w->images);
    sl_free(w->renumbered);
    sl_free((void *)w->maps);
    sl_free(w->to);
}

static bool is_mirror(const sl_symmetry_map *map)
{
    return map->reverses && map->separates;
}

/* Involutions of a component: mirrors that separate first, `most` at most. Returns how many there are in all. */
static int32_t choose_maps(const sl_symmetry *symmetry, int32_t component, int32_t most, int32_t *chosen,
                           int32_t *count)
{
    int32_t all = 0;
    *count = 0;
    for (int32_t pass = 0; pass < 2; pass++) {
        for (int32_t k = 0; k < symmetry->nmap; k++) {
            const sl_symmetry_map *map = &symmetry->map[k];
            if (map->from != component || map->to != component || map->order != 2 || is_mirror(map) != (pass == 0)) {
                continue;
            }
            all++;
            if (*count < most) {
                chosen[(*count)++] = k;
            }
        }
    }
    return all;
}

static sl_status work_create(component_work *w, int32_t component, int32_t most, const int32_t *partner, int32_t *all)
{
    const sl_symmetry *s = w->symmetry;
    const int32_t first = s->first[component], facets = s->first[component + 1] - first;
    sl_status status = SL_OK;
    w->chosen = sl_alloc(most, sizeof *w->chosen);
    SL_TRY(w->chosen != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    *all = choose_maps(s, component, most, w->chosen, &w->count);
    if (w->count == 0) {
        return SL_OK;
    }
    SL_TRY(sl_facet_graph_create(w->mesh, s->face + first, facets, partner, &w->graph));
    const int64_t n = w->graph->graph.n;
    w->images = sl_alloc(n * w->count, sizeof *w->images);
    w->renumbered = sl_alloc(n * w->count, sizeof *w->renumbered);
    w->maps = sl_alloc(w->count, sizeof *w->maps);
    w->to = sl_alloc(n, sizeof *w->to);
    SL_TRY(w->images != NULL && w->renumbered != NULL && w->maps != NULL && w->to != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t i = 0; i < facets; i++) {
        w->place[s->face[first + i]] = i;
    }
    for (int32_t k = 0; k < w->count; k++) {
        for (int32_t i = 0; i < facets; i++) {
            const int32_t image = sl_symmetry_image(w->mesh, s, &s->map[w->chosen[k]], s->face[first + i]);
            w->images[n * k + w->graph->node[i]] = w->graph->node[w->place[image]];
        }
    }
cleanup:
    return status;
}

static bool commute(int32_t n, const int32_t *a, const int32_t *b)
{
    for (int32_t i = 0; i < n; i++) {
        if (a[b[i]] != b[a[i]]) {
            return false;
        }
    }
    return true;
}

/* The map to check jointly with map k: the first other that commutes with it, else the first other, else -1. */
static int32_t choose_partner(const component_work *w, int32_t k, bool *commutes)
{
    const int64_t n = w->graph->graph.n;
    for (int32_t other = 0; other < w->count; other++) {
        if (other != k && commute((int32_t)n, w->images + n * k, w->images + n * other)) {
            *commutes = true;
            return other;
        }
    }
    *commutes = false;
    return w->count > 1 ? (k == 0 ? 1 : 0) : -1;
}

/* The chosen maps that commute with map k, in the graph's own numbers. Returns how many. */
static int32_t renumber_maps(component_work *w, int32_t k, const sl_theorem_graph *graph)
{
    const int64_t n = w->graph->graph.n;
    int32_t count = 0;
    for (int32_t i = 0; i < n; i++) {
        w->to[graph->label[i]] = i;
    }
    for (int32_t other = 0; other < w->count; other++) {
        const int32_t *from = w->images + n * other;
        int32_t *row = w->renumbered + n * count;
        if (other == k || !commute((int32_t)n, w->images + n * k, from)) {
            continue;
        }
        for (int32_t i = 0; i < n; i++) {
            row[w->to[i]] = w->to[from[i]];
        }
        w->maps[count++] = row;
    }
    return count;
}

static sl_status check_map(component_work *w, int32_t k, sl_theorem_mirror *out)
{
    const int64_t n = w->graph->graph.n;
    const sl_symmetry_map *map = &w->symmetry->map[w->chosen[k]];
    sl_theorem_graph *graph = NULL;
    sl_theorem_def def = *w->def;
    bool commutes = false;
    const int32_t other = choose_partner(w, k, &commutes);
    sl_status status = SL_OK;
    *out = (sl_theorem_mirror){.map = w->chosen[k],
                               .component = map->from,
                               .facets = map->count,
                               .partner = other >= 0 ? w->chosen[other] : -1,
                               .commute = commutes,
                               .kind = map->kind,
                               .mirror = is_mirror(map)};
    status = sl_theorem_graph_from_mirror(&w->graph->graph, w->images + n * k,
                                          other >= 0 ? w->images + n * other : NULL, &graph);
    if (status == SL_BAD_INPUT) { /* what was found is no involution of the facets */
        sl_theorem_result *r = &out->result;
        *r = (sl_theorem_result){.graphs = 1, .nodes = n, .lowest_index = -1, .failed = SL_THEOREM_MIRROR};
        r->tally[SL_THEOREM_MIRROR].violated = 1;
        snprintf(r->reason, sizeof r->reason, "the symmetry found is no involution of the facets");
        return SL_OK;
    }
    SL_TRY(status);
    def.map_count = renumber_maps(w, k, graph);
    def.maps = w->maps;
    SL_TRY(sl_theorem_check(graph, &def, w->context, &out->result));
cleanup:
    sl_theorem_graph_free(graph);
    return status;
}

static sl_status check_component(component_work *w, int32_t component, int32_t most, const int32_t *partner,
                                 sl_theorem_mesh *out)
{
    int32_t all = 0;
    sl_status status = SL_OK;
    SL_TRY(work_create(w, component, most, partner, &all));
    out->left_out += all - w->count;
    if (w->count > 0) {
        void *grown = sl_realloc(out->mirror, (int64_t)out->count + w->count, sizeof *out->mirror);
        SL_TRY(grown != NULL ? SL_OK : SL_OUT_OF_MEMORY);
        out->mirror = grown;
    }
    for (int32_t k = 0; k < w->count; k++) {
        SL_TRY(sl_report_progress(w->context, "mirrors", (double)k / w->count));
        SL_TRY(check_map(w, k, &out->mirror[out->count]));
        sl_theorem_add(&out->total, &out->mirror[out->count].result);
        out->count++;
    }
cleanup:
    work_clear(w);
    return status;
}

sl_status sl_theorem_check_mesh(const sl_mesh *mesh, const int32_t *partner, int32_t most, const sl_theorem_def *def,
                                const sl_context *context, sl_theorem_mesh **out)
{
    const sl_symmetry_def symmetry_def = sl_symmetry_default();
    sl_status status = SL_OK;
    int32_t *place = sl_alloc(mesh->nf, sizeof *place);
    sl_theorem_mesh *result = sl_calloc(1, sizeof *result);
    *out = NULL;
    SL_TRY(place != NULL && result != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    result->mirror = sl_alloc(1, sizeof *result->mirror);
    SL_TRY(result->mirror != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    result->total.failed = SL_THEOREM_STATEMENTS;
    SL_TRY(sl_symmetry_find(mesh, partner, &symmetry_def, context, &result->symmetry));
    for (int32_t c = 0; c < result->symmetry->components; c++) {
        component_work w = {.mesh = mesh, .symmetry = result->symmetry, .def = def, .context = context, .place = place};
        SL_TRY(check_component(&w, c, most, partner, result));
    }
    *out = result;
    result = NULL;
cleanup:
    sl_theorem_mesh_free(result);
    sl_free(place);
    return status;
}

void sl_theorem_mesh_free(sl_theorem_mesh *mesh)
{
    if (mesh == NULL) {
        return;
    }
    sl_symmetry_free(mesh->symmetry);
    sl_free(mesh->mirror);
    sl_free(mesh);
}
