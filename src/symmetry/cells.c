/* Cells numbered anew along a breadth-first walk. */
#include "symmetry/symmetry_internal.h"

#include "base/memory.h"
#include "geom/vec3.h"

#include <string.h>

static sl_status allocate(const sl_mesh *mesh, const sl_raw_cells *raw, const sl_symmetry *parts, sl_cells *c)
{
    c->components = parts->components;
    c->ncell = raw->ncell;
    c->ncorner = raw->ncorner;
    c->npoint = raw->npoint;
    c->diagonal = raw->diagonal;
    c->component = sl_alloc((int64_t)parts->components + 1, sizeof *c->component);
    c->first = sl_alloc((int64_t)raw->ncell + 1, sizeof *c->first);
    c->cell = sl_alloc(raw->ncorner, sizeof *c->cell);
    c->twin = sl_alloc(raw->ncorner, sizeof *c->twin);
    c->mirror_twin = sl_alloc(raw->ncorner, sizeof *c->mirror_twin);
    c->point = sl_alloc(raw->ncorner, sizeof *c->point);
    c->halfedge = sl_alloc(raw->ncorner, sizeof *c->halfedge);
    c->at = raw->at != NULL ? sl_alloc(mesh->nh, sizeof *c->at) : NULL;
    c->pair = raw->diagonal != NULL ? sl_alloc(raw->ncell, sizeof *c->pair) : NULL;
    c->color = sl_alloc(raw->ncell, sizeof *c->color);
    c->sum = sl_calloc(parts->components, sizeof *c->sum);
    c->xyz = sl_alloc(3 * (int64_t)raw->npoint, sizeof *c->xyz);
    c->centre = sl_calloc(3 * (int64_t)parts->components, sizeof *c->centre);
    c->size = sl_calloc(parts->components, sizeof *c->size);
    c->edges = sl_calloc(parts->components, sizeof *c->edges);
    c->shortest = sl_calloc(parts->components, sizeof *c->shortest);
    c->radius = sl_alloc(raw->ncorner, sizeof *c->radius);
    return c->component == NULL || c->first == NULL || c->cell == NULL || c->twin == NULL || c->mirror_twin == NULL ||
                   c->point == NULL || c->halfedge == NULL || (raw->at != NULL && c->at == NULL) ||
                   (raw->diagonal != NULL && c->pair == NULL) || c->color == NULL || c->sum == NULL || c->xyz == NULL ||
                   c->centre == NULL || c->size == NULL || c->edges == NULL || c->shortest == NULL || c->radius == NULL
               ? SL_OUT_OF_MEMORY
               : SL_OK;
}

/* Numbers the cell of raw corner h next, its corners from h on. renumber: raw corner -> corner, -1 = not yet;
 * c->halfedge holds the raw corner until all are numbered. */
static void reach(const sl_raw_cells *raw, sl_cells *c, int32_t *renumber, int32_t cell, int32_t h)
{
    int32_t k = c->first[cell], at = h;
    do {
        renumber[at] = k;
        c->halfedge[k] = at;
        c->cell[k++] = cell;
        at = sl_raw_next(raw, at);
    } while (at != h);
    c->first[cell + 1] = k;
}

static void number_cells(const sl_raw_cells *raw, const int32_t *start, sl_cells *c, int32_t *renumber)
{
    for (int32_t h = 0; h < c->ncorner; h++) {
        renumber[h] = -1;
    }
    int32_t reached = 0;
    c->first[0] = 0;
    for (int32_t k = 0; k < c->components; k++) {
        int32_t h = c->first[reached];
        c->component[k] = reached;
        reach(raw, c, renumber, reached++, start[k]);
        for (; h < c->first[reached]; h++) {
            const int32_t t = raw->twin[c->halfedge[h]];
            if (t >= 0 && renumber[t] < 0) {
                reach(raw, c, renumber, reached++, t);
            }
        }
    }
    c->component[c->components] = reached;
}

static void translate_corners(const sl_mesh *mesh, const sl_raw_cells *raw, const int32_t *renumber,
                              const uint64_t *color, sl_cells *c)
{
    for (int32_t j = 0; j < c->ncell; j++) {
        const int32_t r = c->halfedge[c->first[j]];
        c->color[j] = color[raw->cell[r]];
        if (c->pair != NULL) {
            c->pair[j] = raw->diagonal[mesh->face[raw->corner[r]]] >= 0;
        }
    }
    for (int32_t h = 0; h < c->ncorner; h++) {
        const int32_t t = raw->twin[c->halfedge[h]];
        c->twin[h] = t >= 0 ? renumber[t] : -1;
    }
    for (int32_t h = 0; h < mesh->nh && raw->at != NULL; h++) {
        c->at[h] = renumber[raw->at[h]];
    }
}

/* The corner after the twin of the corner before. */
static void find_mirror_twins(sl_cells *c)
{
    for (int32_t j = 0; j < c->ncell; j++) {
        int32_t before = c->first[j + 1] - 1;
        for (int32_t h = c->first[j]; h < c->first[j + 1]; h++) {
            int32_t t = c->twin[before];
            if (t >= 0) {
                const int32_t cell = c->cell[t];
                t = t + 1 < c->first[cell + 1] ? t + 1 : c->first[cell];
            }
            c->mirror_twin[h] = t;
            before = h;
        }
    }
}

/* Points in the order they are met, and their positions. renumber: npoint of work. */
static void translate_points(const sl_mesh *mesh, const sl_raw_cells *raw, int32_t *renumber, sl_cells *c)
{
    int32_t points = 0;
    for (int32_t p = 0; p < c->npoint; p++) {
        renumber[p] = -1;
    }
    for (int32_t h = 0; h < c->ncorner; h++) {
        const int32_t p = raw->point[c->halfedge[h]];
        c->halfedge[h] = sl_raw_halfedge(raw, c->halfedge[h]);
        if (renumber[p] < 0) {
            renumber[p] = points;
            memcpy(&c->xyz[3 * (int64_t)points++], &mesh->xyz[3 * (int64_t)mesh->origin[c->halfedge[h]]],
                   3 * sizeof *c->xyz);
        }
        c->point[h] = renumber[p];
    }
}

/* Centre, size, sum of the edges, distances of one component. */
static void measure_component(sl_cells *c, int32_t k)
{
    const int32_t begin = sl_cells_base(c, k), n = sl_cells_corners(c, k);
    const double *base = &c->xyz[3 * (int64_t)c->point[begin]];
    double sum[3] = {0}, low[3], high[3], extent[3];
    memcpy(low, base, sizeof low);
    memcpy(high, base, sizeof high);
    for (int32_t h = begin; h < begin + n; h++) {
        const double *p = &c->xyz[3 * (int64_t)c->point[h]];
        for (int i = 0; i < 3; i++) {
            sum[i] += p[i] - base[i];
            low[i] = p[i] < low[i] ? p[i] : low[i];
            high[i] = p[i] > high[i] ? p[i] : high[i];
        }
    }
    double *centre = &c->centre[3 * (int64_t)k];
    for (int i = 0; i < 3; i++) {
        centre[i] = base[i] + sum[i] / n;
        extent[i] = high[i] - low[i];
    }
    c->size[k] = sl_vec3_norm(extent);
    c->shortest[k] = HUGE_VAL;
    for (int32_t j = c->component[k]; j < c->component[k + 1]; j++) {
        const double *before = &c->xyz[3 * (int64_t)c->point[c->first[j + 1] - 1]];
        c->sum[k] += c->color[j];
        for (int32_t h = c->first[j]; h < c->first[j + 1]; h++) {
            const double *p = &c->xyz[3 * (int64_t)c->point[h]];
            c->radius[h] = (float)sl_vec3_distance(p, centre);
            const double length = sl_vec3_distance(p, before);
            c->edges[k] += length;
            c->shortest[k] = length < c->shortest[k] ? length : c->shortest[k];
            before = p;
        }
    }
}

sl_status sl_cells_create(const sl_mesh *mesh, const sl_raw_cells *raw, const sl_symmetry *parts, const uint64_t *color,
                          const int32_t *start, sl_cells **out)
{
    sl_status status = SL_OK;
    int32_t *renumber = sl_alloc(raw->ncorner, sizeof *renumber);
    sl_cells *c = sl_calloc(1, sizeof *c);
    if (renumber == NULL || c == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    SL_TRY(allocate(mesh, raw, parts, c));
    number_cells(raw, start, c, renumber);
    translate_corners(mesh, raw, renumber, color, c);
    find_mirror_twins(c);
    if (raw->at == NULL) {
        c->at = renumber;
        renumber = sl_alloc(raw->npoint, sizeof *renumber);
    }
    if (renumber == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    translate_points(mesh, raw, renumber, c);
    for (int32_t k = 0; k < c->components; k++) {
        measure_component(c, k);
    }
    *out = c;
    c = NULL;
cleanup:
    sl_cells_free(c);
    sl_free(renumber);
    return status;
}

void sl_cells_free(sl_cells *cells)
{
    if (cells == NULL) {
        return;
    }
    sl_free(cells->component);
    sl_free(cells->first);
    sl_free(cells->cell);
    sl_free(cells->twin);
    sl_free(cells->mirror_twin);
    sl_free(cells->point);
    sl_free(cells->halfedge);
    sl_free(cells->at);
    sl_free(cells->pair);
    sl_free(cells->color);
    sl_free(cells->sum);
    sl_free(cells->xyz);
    sl_free(cells->centre);
    sl_free(cells->size);
    sl_free(cells->edges);
    sl_free(cells->shortest);
    sl_free(cells->radius);
    sl_free(cells);
}
