/* The search as a whole. */
#include "symmetry/symmetry_internal.h"

#include "base/memory.h"
#include "mesh/topology.h"

#include <string.h>

sl_status sl_symmetry_try(sl_symmetry_search *search, int32_t from, int32_t component, int32_t to, bool reverses,
                          float tolerance, sl_symmetry_kind kind, int64_t *work, bool *added)
{
    sl_status status = SL_OK;
    sl_symmetry *out = search->out;
    sl_symmetry_map map = {.from = from, .to = component, .reverses = reverses};
    float worst;
    *added = false;
    if (!sl_symmetry_walk(search->cells, from, to, reverses, INT32_MAX, tolerance, search->image, &worst, work)) {
        return SL_OK;
    }
    sl_symmetry_measure(search->cells, search->def, search->image, &map);
    if (map.kind > kind || (search->def->mirrors_only && map.order > 2)) {
        return SL_OK;
    }
    SL_TRY(sl_symmetry_export(search->mesh, out, search->cells, search->image, &map));
    if (map.order == 2) {
        SL_TRY(sl_symmetry_halve(search->mesh, out, &map, NULL));
    }
    if (search->def->mirrors_only && map.order == 2 && !map.separates) {
        goto cleanup;
    }
    SL_TRY(sl_reserve((void **)&out->map, &search->capacity, (int64_t)out->nmap + 1, sizeof *out->map));
    out->map[out->nmap++] = map;
    map.corner = map.facet = NULL;
    *added = true;
cleanup:
    sl_free(map.corner);
    sl_free(map.facet);
    return status;
}

/* Facets by component, units, places. */
static sl_status list_facets(const sl_mesh *mesh, sl_symmetry *s)
{
    s->component = sl_alloc(mesh->nf, sizeof *s->component);
    if (s->component == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    sl_status status = sl_mesh_components(mesh, s->component, &s->components);
    if (status != SL_OK) {
        return status;
    }
    s->first = sl_calloc((int64_t)s->components + 1, sizeof *s->first);
    s->original = sl_alloc(s->components, sizeof *s->original);
    s->face = sl_alloc(mesh->nf, sizeof *s->face);
    s->place = sl_alloc(mesh->nf, sizeof *s->place);
    s->corner_first = sl_alloc(mesh->nf, sizeof *s->corner_first);
    s->unit = sl_alloc(mesh->nf, sizeof *s->unit);
    if (s->first == NULL || s->original == NULL || s->face == NULL || s->place == NULL || s->corner_first == NULL ||
        s->unit == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t f = 0; f < mesh->nf; f++) {
        s->first[s->component[f] + 1]++;
        s->unit[f] = f;
    }
    for (int32_t k = 0; k < s->components; k++) {
        s->first[k + 1] += s->first[k];
        s->original[k] = s->first[k]; /* while facets are sorted: where the next one goes */
    }
    for (int32_t f = 0; f < mesh->nf; f++) {
        const int32_t k = s->component[f], at = s->original[k]++;
        s->face[at] = f;
        s->place[f] = at;
        s->corner_first[f] = 0;
        if (at > s->first[k]) {
            const int32_t last = s->face[at - 1];
            s->corner_first[f] = s->corner_first[last] + sl_degree(mesh, last);
        }
    }
    for (int32_t k = 0; k < s->components; k++) {
        s->original[k] = k;
    }
    return SL_OK;
}

static void mark_pairs(const sl_mesh *mesh, const sl_raw_cells *raw, sl_symmetry *s)
{
    for (int32_t f = 0; raw->diagonal != NULL && f < mesh->nf; f++) {
        if (raw->diagonal[f] >= 0) {
            const int32_t g = mesh->face[mesh->twin[raw->diagonal[f]]];
            s->unit[f] = f < g ? f : g;
        }
    }
}

/* Copies were found first; automorphisms stand first. */
static sl_status move_copies_last(sl_symmetry *s, int32_t copies)
{
    sl_symmetry_map *sorted = sl_alloc(s->nmap, sizeof *sorted);
    if (sorted == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    const int32_t own = s->nmap - copies;
    if (s->nmap > 0) {
        memcpy(sorted, s->map + copies, (size_t)own * sizeof *sorted);
        memcpy(sorted + own, s->map, (size_t)copies * sizeof *sorted);
    }
    sl_free(s->map);
    s->map = sorted;
    return SL_OK;
}

static sl_status search_components(sl_symmetry_search *search)
{
    sl_status status = SL_OK;
    sl_symmetry *s = search->out;
    int32_t most = 0;
    for (int32_t k = 0; k < s->components; k++) {
        const int32_t n = sl_cells_corners(search->cells, k);
        most = n > most ? n : most;
    }
    search->image = sl_alloc(most, sizeof *search->image);
    if (search->image == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    SL_TRY(sl_symmetry_copies(search));
    const int32_t copies = s->nmap;
    for (int32_t k = 0; k < s->components; k++) {
        if (s->original[k] == k || search->def->of_copies) {
            search->searched++;
            search->searched_corners += sl_cells_corners(search->cells, k);
        }
    }
    for (int32_t k = 0; k < s->components; k++) {
        if (s->original[k] == k || search->def->of_copies) {
            SL_TRY(sl_report_progress(search->context, "symmetry", 0.5));
            SL_TRY(sl_symmetry_automorphisms(search, k));
        }
    }
    SL_TRY(move_copies_last(s, copies));
cleanup:
    sl_free(search->image);
    return status;
}

sl_status sl_symmetry_find(const sl_mesh *mesh, const int32_t *partner, const sl_symmetry_def *def,
                           const sl_context *context, sl_symmetry **out)
{
    sl_status status = SL_OK;
    sl_raw_cells raw = {0};
    sl_cells *cells = NULL;
    uint64_t *color = NULL;
    int32_t *start = NULL;
    sl_symmetry *s = sl_calloc(1, sizeof *s);
    if (s == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    SL_TRY(sl_report_progress(context, "symmetry", 0.0));
    SL_TRY(list_facets(mesh, s));
    SL_TRY(sl_raw_cells_init(mesh, partner, &raw));
    mark_pairs(mesh, &raw, s);
    color = sl_alloc(raw.ncell, sizeof *color);
    start = sl_alloc(s->components, sizeof *start);
    if (color == NULL || start == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    SL_TRY(sl_symmetry_refine(mesh, &raw, s, color, start));
    SL_TRY(sl_report_progress(context, "symmetry", 0.1));
    SL_TRY(sl_cells_create(mesh, &raw, s, color, start, &cells));
    sl_symmetry_search search = {.mesh = mesh, .def = def, .context = context, .cells = cells, .out = s};
    SL_TRY(search_components(&search));
    SL_TRY(sl_report_progress(context, "symmetry", 1.0));
    *out = s;
    s = NULL;
cleanup:
    sl_symmetry_free(s);
    sl_cells_free(cells);
    sl_raw_cells_clear(&raw);
    sl_free(color);
    sl_free(start);
    return status;
}
