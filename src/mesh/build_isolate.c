#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "geom/vec3.h"
#include "mesh/build_internal.h"

/* A facet is degenerate when its area is at most this many units of rounding of its corners' coordinates. */
static const double area_rounding = 4 * 0x1p-52;

static bool has_zero_area(const sl_mesh *m, int32_t f)
{
    double perimeter = 0.0, reach = 0.0;
    for (int32_t h = m->face_first[f]; h < m->face_first[f + 1]; h++) {
        perimeter += sl_mesh_edge_length(m, h);
        for (int k = 0; k < 3; k++) {
            reach = fmax(reach, fabs(m->xyz[3 * (int64_t)m->origin[h] + k]));
        }
    }
    return sl_mesh_face_area(m, f) <= area_rounding * perimeter * (perimeter + reach);
}

sl_status sl_build_flag_degenerate(sl_builder *b)
{
    sl_mesh *m = b->mesh;
    int32_t *last = sl_alloc(m->nv, sizeof *last); /* the last facet that used a vertex */
    if (last == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t v = 0; v < m->nv; v++) {
        last[v] = -1;
    }
    for (int32_t f = 0; f < m->nf; f++) {
        bool repeats = false;
        for (int32_t h = m->face_first[f]; h < m->face_first[f + 1]; h++) {
            repeats = repeats || last[m->origin[h]] == f;
            last[m->origin[h]] = f;
        }
        if (repeats || has_zero_area(m, f)) {
            m->face_flags[f] |= SL_FACE_DEGENERATE;
        }
    }
    sl_free(last);
    return SL_OK;
}

/* Hash of the set of corners, whatever their order: a sum of mixed vertex numbers. */
static uint64_t hash_corners(const sl_mesh *m, int32_t f)
{
    uint64_t sum = 0;
    for (int32_t h = m->face_first[f]; h < m->face_first[f + 1]; h++) {
        uint64_t z = ((uint64_t)m->origin[h] + 1) * 0x9e3779b97f4a7c15u;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        sum += z ^ (z >> 31);
    }
    return sum;
}

static int compare_ints(const void *a, const void *b)
{
    const int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return (x > y) - (x < y);
}

static const int32_t *sorted_corners(const sl_mesh *m, int32_t f, int32_t *work)
{
    const int32_t first = m->face_first[f], d = sl_degree(m, f);
    for (int32_t k = 0; k < d; k++) {
        work[k] = m->origin[first + k];
    }
    qsort(work, (size_t)d, sizeof *work, compare_ints);
    return work;
}

/* work: twice the largest degree. */
static bool same_corners(const sl_mesh *m, int32_t f, int32_t g, int32_t *work)
{
    const int32_t d = sl_degree(m, f);
    if (sl_degree(m, g) != d) {
        return false;
    }
    const int32_t *a = sorted_corners(m, f, work), *b = sorted_corners(m, g, work + d);
    for (int32_t k = 0; k < d; k++) {
        if (a[k] != b[k]) {
            return false;
        }
    }
    return true;
}

typedef struct face_slot {
    uint64_t hash;
    int32_t face; /* -1 = free */
} face_slot;

/* Puts f into the table; false when a facet of the same corners stands there. */
static bool insert_face(const sl_mesh *m, face_slot *table, uint64_t mask, int32_t f, int32_t *work)
{
    const uint64_t hash = hash_corners(m, f);
    uint64_t at = hash & mask;
    for (; table[at].face >= 0; at = (at + 1) & mask) {
        if (table[at].hash == hash && same_corners(m, f, table[at].face, work)) {
            return false;
        }
    }
    table[at] = (face_slot){hash, f};
    return true;
}

sl_status sl_build_flag_duplicate(sl_builder *b)
{
    sl_mesh *m = b->mesh;
    int64_t size = 16;
    int32_t degree = 0;
    for (int32_t f = 0; f < m->nf; f++) {
        degree = sl_degree(m, f) > degree ? sl_degree(m, f) : degree;
    }
    while (size < 2 * (int64_t)m->nf) {
        size *= 2;
    }
    sl_status status = SL_OK;
    face_slot *table = sl_alloc(size, sizeof *table);
    int32_t *work = sl_alloc(2 * (int64_t)degree, sizeof *work);
    if (table == NULL || work == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    for (int64_t i = 0; i < size; i++) {
        table[i].face = -1;
    }
    for (int32_t f = 0; f < m->nf; f++) {
        if (!sl_build_isolated(m, f) && !insert_face(m, table, (uint64_t)size - 1, f, work)) {
            m->face_flags[f] |= SL_FACE_DUPLICATE;
        }
    }
cleanup:
    sl_free(table);
    sl_free(work);
    return status;
}
