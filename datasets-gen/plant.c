#include "plant.h"

#include "base/memory.h"
#include "locate.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

const double gen_plant_tolerance = 1e-9;

typedef struct plant_work {
    const sl_generated *mesh;
    bool reversed; /* det M < 0 */
    gen_locator locator;
    int32_t *first; /* nv + 1: into facet */
    int32_t *facet; /* facets at each vertex, ascending */
    uint8_t *taken; /* larger of nv, nf */
    int32_t *vertex, *face;
} plant_work;

static void list_facets(plant_work *w)
{
    const sl_generated *mesh = w->mesh;
    const int32_t corners = mesh->face_first[mesh->nf];
    for (int32_t c = 0; c < corners; c++) {
        w->first[mesh->index[c] + 1]++;
    }
    for (int32_t v = 0; v < mesh->nv; v++) {
        w->first[v + 1] += w->first[v];
    }
    for (int32_t f = mesh->nf - 1; f >= 0; f--) { /* from behind: first ends up as the start of each list again */
        for (int32_t c = mesh->face_first[f]; c < mesh->face_first[f + 1]; c++) {
            w->facet[--w->first[mesh->index[c] + 1]] = f;
        }
    }
    for (int32_t v = 0; v < mesh->nv; v++) {
        w->first[v] = w->first[v + 1];
    }
    w->first[mesh->nv] = corners;
}

static sl_status map_vertices(plant_work *w, const double m[12])
{
    bool moved = false;
    for (int32_t v = 0; v < w->mesh->nv; v++) {
        const double *p = w->mesh->xyz + 3 * (int64_t)v;
        double image[3];
        for (int k = 0; k < 3; k++) {
            image[k] = m[4 * k] * p[0] + m[4 * k + 1] * p[1] + m[4 * k + 2] * p[2] + m[4 * k + 3];
        }
        w->vertex[v] = gen_locate(&w->locator, image);
        if (w->vertex[v] < 0 || w->taken[w->vertex[v]] != 0) {
            return SL_INTERNAL;
        }
        w->taken[w->vertex[v]] = 1;
        moved |= w->vertex[v] != v;
    }
    return moved ? SL_OK : SL_INTERNAL;
}

/* Does facet g run through the images of f's corners, in f's order or against it? */
static bool is_image(const plant_work *w, int32_t f, int32_t g)
{
    const sl_generated *mesh = w->mesh;
    const int32_t *a = mesh->index + mesh->face_first[f], *b = mesh->index + mesh->face_first[g];
    const int32_t degree = mesh->face_first[f + 1] - mesh->face_first[f];
    int32_t start = 0;
    if (mesh->face_first[g + 1] - mesh->face_first[g] != degree) {
        return false;
    }
    while (start < degree && b[start] != w->vertex[a[0]]) {
        start++;
    }
    for (int32_t k = 0; k < degree && start < degree; k++) {
        if (b[(w->reversed ? start + degree - k : start + k) % degree] != w->vertex[a[k]]) {
            return false;
        }
    }
    return start < degree;
}

static int32_t image_of_facet(const plant_work *w, int32_t f)
{
    int32_t best = -1; /* the image of a corner with the fewest facets around it */
    for (int32_t c = w->mesh->face_first[f]; c < w->mesh->face_first[f + 1]; c++) {
        const int32_t v = w->vertex[w->mesh->index[c]];
        if (best < 0 || w->first[v + 1] - w->first[v] < w->first[best + 1] - w->first[best]) {
            best = v;
        }
    }
    for (int32_t i = w->first[best]; i < w->first[best + 1]; i++) {
        if (is_image(w, f, w->facet[i])) {
            return w->facet[i];
        }
    }
    return -1;
}

static sl_status map_facets(plant_work *w)
{
    memset(w->taken, 0, (size_t)w->mesh->nf);
    for (int32_t f = 0; f < w->mesh->nf; f++) {
        const int32_t g = image_of_facet(w, f);
        if (g < 0 || w->taken[g] != 0) {
            return SL_INTERNAL;
        }
        w->taken[g] = 1;
        w->face[f] = g;
    }
    return SL_OK;
}

double gen_determinant(const double m[12])
{
    return m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) +
           m[2] * (m[4] * m[9] - m[5] * m[8]);
}

/* A reflection in a plane, not an inversion in a point: of a negative determinant, the trace 1, its own inverse. */
static bool is_mirror(const plant_work *w, const double m[12])
{
    for (int32_t v = 0; v < w->mesh->nv; v++) {
        if (w->vertex[w->vertex[v]] != v) {
            return false;
        }
    }
    return w->reversed && fabs(m[0] + m[5] + m[10] - 1.0) < 1e-6;
}

static sl_status append(sl_generated *mesh, const char *name, const double matrix[12], bool exact, plant_work *w)
{
    sl_planted *list = sl_realloc(mesh->planted, (int64_t)mesh->nplanted + 1, sizeof *list);
    if (list == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    mesh->planted = list;
    sl_planted *planted = &list[mesh->nplanted++];
    *planted = (sl_planted){.mirror = is_mirror(w, matrix), .exact = exact, .vertex = w->vertex, .face = w->face};
    snprintf(planted->name, sizeof planted->name, "%s", name);
    memcpy(planted->matrix, matrix, sizeof planted->matrix);
    w->vertex = w->face = NULL;
    return SL_OK;
}

sl_status gen_plant(sl_generated *mesh, const char *name, const double matrix[12], bool exact)
{
    plant_work w = {.mesh = mesh, .reversed = gen_determinant(matrix) < 0.0};
    sl_status status = SL_OK;
    w.first = sl_calloc((int64_t)mesh->nv + 2, sizeof *w.first);
    w.facet = sl_alloc(mesh->face_first[mesh->nf], sizeof *w.facet);
    w.taken = sl_calloc(mesh->nv > mesh->nf ? mesh->nv : mesh->nf, sizeof *w.taken);
    w.vertex = sl_alloc(mesh->nv, sizeof *w.vertex);
    w.face = sl_alloc(mesh->nf, sizeof *w.face);
    if (w.first == NULL || w.facet == NULL || w.taken == NULL || w.vertex == NULL || w.face == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    SL_TRY(gen_locator_init(&w.locator, mesh->xyz, mesh->nv, gen_plant_tolerance));
    list_facets(&w);
    SL_TRY(map_vertices(&w, matrix));
    SL_TRY(map_facets(&w));
    SL_TRY(append(mesh, name, matrix, exact, &w));
cleanup:
    gen_locator_clear(&w.locator);
    sl_free(w.first);
    sl_free(w.facet);
    sl_free(w.taken);
    sl_free(w.vertex);
    sl_free(w.face);
    return status;
}
