/* Facets, or pairs of triangles taken as quads, with the corners around each vertex. */
#include "symmetry/symmetry_internal.h"

#include "base/memory.h"

/* Halfedge of triangle f on the diagonal that it shares with its partner, -1 when f is alone. */
static int32_t find_diagonal(const sl_mesh *mesh, const int32_t *partner, int32_t f)
{
    const int32_t g = partner[f];
    if (g < 0 || g >= mesh->nf || g == f || partner[g] != f || sl_degree(mesh, f) != 3 || sl_degree(mesh, g) != 3) {
        return -1;
    }
    const int32_t lower = f < g ? f : g, other = f < g ? g : f;
    for (int32_t h = mesh->face_first[lower]; h < mesh->face_first[lower + 1]; h++) {
        if (mesh->twin[h] >= 0 && mesh->face[mesh->twin[h]] == other) {
            return f == lower ? h : mesh->twin[h];
        }
    }
    return -1;
}

/* Appends the corners of facet f but that at the diagonal. */
static void append_facet(sl_raw_cells *raw, const sl_mesh *mesh, int32_t f, int32_t cell)
{
    const int32_t d = sl_degree(mesh, f), alone = raw->diagonal[f] < 0;
    int32_t h = alone ? mesh->face_first[f] : sl_next(mesh, raw->diagonal[f]);
    for (int32_t k = 0; k < (alone ? d : 2); k++) {
        raw->corner[raw->ncorner] = h;
        raw->at[h] = raw->ncorner;
        raw->cell_store[raw->ncorner++] = cell;
        h = sl_next(mesh, h);
    }
    raw->cell_of[f] = cell;
}

static sl_status pair_up(const sl_mesh *mesh, const int32_t *partner, sl_raw_cells *raw)
{
    raw->first_store = sl_alloc((int64_t)mesh->nf + 1, sizeof *raw->first_store);
    raw->cell_store = sl_alloc(mesh->nh, sizeof *raw->cell_store);
    raw->twin_store = sl_alloc(mesh->nh, sizeof *raw->twin_store);
    raw->corner = sl_alloc(mesh->nh, sizeof *raw->corner);
    raw->at = sl_alloc(mesh->nh, sizeof *raw->at);
    raw->diagonal = sl_alloc(mesh->nf, sizeof *raw->diagonal);
    raw->cell_of = sl_alloc(mesh->nf, sizeof *raw->cell_of);
    if (raw->first_store == NULL || raw->cell_store == NULL || raw->twin_store == NULL || raw->corner == NULL ||
        raw->at == NULL || raw->diagonal == NULL || raw->cell_of == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t f = 0; f < mesh->nf; f++) {
        raw->diagonal[f] = find_diagonal(mesh, partner, f);
    }
    raw->first_store[0] = 0;
    for (int32_t f = 0; f < mesh->nf; f++) {
        if (raw->diagonal[f] >= 0 && partner[f] < f) {
            continue;
        }
        append_facet(raw, mesh, f, raw->ncell);
        if (raw->diagonal[f] >= 0) {
            append_facet(raw, mesh, partner[f], raw->ncell);
        }
        raw->first_store[++raw->ncell] = raw->ncorner;
    }
    for (int32_t f = 0; f < mesh->nf; f++) {
        if (raw->diagonal[f] >= 0) { /* the corner there is the first that the other triangle has on the border */
            raw->at[raw->diagonal[f]] = raw->at[sl_next(mesh, mesh->twin[raw->diagonal[f]])];
        }
    }
    for (int32_t h = 0; h < raw->ncorner; h++) {
        const int32_t t = mesh->twin[raw->corner[h]];
        raw->twin_store[h] = t >= 0 ? raw->at[t] : -1;
    }
    raw->first = raw->first_store;
    raw->cell = raw->cell_store;
    raw->twin = raw->twin_store;
    return SL_OK;
}

/* Gives every fan of corners a point and counts them. */
static void find_points(sl_raw_cells *raw)
{
    for (int32_t h = 0; h < raw->ncorner; h++) {
        raw->point[h] = -1;
    }
    for (int32_t h = 0; h < raw->ncorner; h++) {
        if (raw->point[h] >= 0) {
            continue;
        }
        int32_t count = 0, at = h;
        do {
            raw->point[at] = raw->npoint;
            count++;
            at = raw->twin[sl_raw_prev(raw, at)];
        } while (at >= 0 && at != h);
        if (at < 0) { /* a border: the other way round, too */
            for (at = raw->twin[h]; at >= 0; at = raw->twin[at]) {
                at = sl_raw_next(raw, at);
                raw->point[at] = raw->npoint;
                count++;
            }
            count = -count;
        }
        raw->valence[raw->npoint++] = count;
    }
}

sl_status sl_raw_cells_init(const sl_mesh *mesh, const int32_t *partner, sl_raw_cells *out)
{
    sl_status status = SL_OK;
    sl_raw_cells raw = {0};
    if (partner != NULL) {
        SL_TRY(pair_up(mesh, partner, &raw));
    } else {
        raw.ncell = mesh->nf;
        raw.ncorner = mesh->nh;
        raw.first = mesh->face_first;
        raw.cell = mesh->face;
        raw.twin = mesh->twin;
    }
    raw.point = sl_alloc(raw.ncorner, sizeof *raw.point);
    raw.valence = sl_alloc(raw.ncorner, sizeof *raw.valence);
    if (raw.point == NULL || raw.valence == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    find_points(&raw);
    *out = raw;
    return SL_OK;
cleanup:
    sl_raw_cells_clear(&raw);
    return status;
}

void sl_raw_cells_clear(sl_raw_cells *raw)
{
    sl_free(raw->corner);
    sl_free(raw->at);
    sl_free(raw->diagonal);
    sl_free(raw->cell_of);
    sl_free(raw->point);
    sl_free(raw->valence);
    sl_free(raw->first_store);
    sl_free(raw->cell_store);
    sl_free(raw->twin_store);
    *raw = (sl_raw_cells){0};
}
