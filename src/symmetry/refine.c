/* Colours of cells by refinement, and the corner each component is walked from. */
#include "symmetry/symmetry_internal.h"

#include "base/memory.h"
#include "geom/vec3.h"

#include <string.h>

enum {
    MOST_ROUNDS = 6,
    RARE_ENOUGH = 64, /* corners of a colour that may be tried without refining further */
    DISTANCE_BINS = 4096
};

/* One slot of an open-addressing table of colours. */
typedef struct color_count {
    uint64_t color;
    int32_t cells, degree; /* degree is the same for all of a colour */
} color_count;

typedef struct refiner {
    const sl_mesh *mesh;
    const sl_raw_cells *raw;
    uint64_t *color, *next; /* ncell */
    double *distance;       /* of the largest component: from the centre */
    int32_t *list;          /* cells of the component */
    int32_t count;
    color_count *table;
    int64_t mask;
    int32_t bin[DISTANCE_BINS + 1];
} refiner;

static uint64_t mix(uint64_t x)
{
    x ^= x >> 32;
    x *= 0xd6e8feb86659fd93u;
    x ^= x >> 32;
    x *= 0xd6e8feb86659fd93u;
    return x ^ (x >> 32);
}

/* Degree, what it is made of, and the valences around. */
static uint64_t first_color(const refiner *r, int32_t c)
{
    const sl_raw_cells *raw = r->raw;
    const int32_t degree = raw->first[c + 1] - raw->first[c];
    const bool pair = raw->diagonal != NULL && raw->diagonal[r->mesh->face[raw->corner[raw->first[c]]]] >= 0;
    uint64_t sum = 0;
    for (int32_t h = raw->first[c]; h < raw->first[c + 1]; h++) {
        sum += mix(2u * (uint64_t)(uint32_t)raw->valence[raw->point[h]]);
        sum += raw->twin[h] < 0 ? mix(1u) : 0u; /* apart: in a mirror another corner's halfedge is the border */
    }
    return mix(sum + 2u * (uint64_t)degree + (pair ? 1u : 0u));
}

static uint64_t refined_color(const refiner *r, int32_t c)
{
    const sl_raw_cells *raw = r->raw;
    uint64_t sum = 0;
    for (int32_t h = raw->first[c]; h < raw->first[c + 1]; h++) {
        sum += raw->twin[h] >= 0 ? mix(r->color[raw->cell[raw->twin[h]]]) : 1u;
    }
    return mix(sum + 0x9e3779b97f4a7c15u * r->color[c]);
}

/* Counts the cells of each colour; returns the number of colours and the one of fewest corners in *rarest. */
static int32_t count_colors(const refiner *r, color_count *rarest)
{
    const int64_t size = r->mask + 1;
    memset(r->table, 0, (size_t)size * sizeof *r->table);
    int32_t colors = 0;
    for (int32_t i = 0; i < r->count; i++) {
        const int32_t c = r->list[i];
        int64_t at = (int64_t)(r->color[c] & (uint64_t)r->mask);
        while (r->table[at].cells > 0 && r->table[at].color != r->color[c]) {
            at = (at + 1) & r->mask;
        }
        if (r->table[at].cells == 0) {
            r->table[at] = (color_count){r->color[c], 0, r->raw->first[c + 1] - r->raw->first[c]};
            colors++;
        }
        r->table[at].cells++;
    }
    int64_t best = INT64_MAX;
    for (int64_t at = 0; at < size; at++) {
        const int64_t corners = (int64_t)r->table[at].cells * r->table[at].degree;
        if (corners > 0 && (corners < best || (corners == best && r->table[at].color < rarest->color))) {
            best = corners;
            *rarest = r->table[at];
        }
    }
    return colors;
}

static color_count refine_component(refiner *r)
{
    for (int32_t i = 0; i < r->count; i++) {
        r->color[r->list[i]] = first_color(r, r->list[i]);
    }
    int64_t size = 4;
    while (size < 2 * (int64_t)r->count) {
        size *= 2;
    }
    r->mask = size - 1;
    color_count rarest = {0};
    int32_t colors = count_colors(r, &rarest), before = 0;
    for (int32_t round = 0; round < MOST_ROUNDS && colors > before; round++) {
        if ((int64_t)rarest.cells * rarest.degree <= RARE_ENOUGH) {
            break;
        }
        for (int32_t i = 0; i < r->count; i++) {
            r->next[i] = refined_color(r, r->list[i]);
        }
        for (int32_t i = 0; i < r->count; i++) {
            r->color[r->list[i]] = r->next[i];
        }
        before = colors;
        colors = count_colors(r, &rarest);
    }
    return rarest;
}

static const double *corner_point(const refiner *r, int32_t h)
{
    return &r->mesh->xyz[3 * (int64_t)r->mesh->origin[sl_raw_halfedge(r->raw, h)]];
}

static void find_centre(const refiner *r, double centre[3])
{
    double sum[3] = {0}, n = 0.0;
    const double *base = corner_point(r, r->raw->first[r->list[0]]);
    for (int32_t i = 0; i < r->count; i++) {
        for (int32_t h = r->raw->first[r->list[i]]; h < r->raw->first[r->list[i] + 1]; h++) {
            const double *p = corner_point(r, h);
            n += 1.0;
            for (int k = 0; k < 3; k++) {
                sum[k] += p[k] - base[k];
            }
        }
    }
    for (int k = 0; k < 3; k++) {
        centre[k] = base[k] + sum[k] / n;
    }
}

static double cell_distance(const refiner *r, const double centre[3], int32_t c)
{
    double d = 0.0;
    for (int32_t h = r->raw->first[c]; h < r->raw->first[c + 1]; h++) {
        d += sl_vec3_distance(corner_point(r, h), centre);
    }
    return d / (r->raw->first[c + 1] - r->raw->first[c]);
}

/* Of the many cells of a colour, one at a distance from the centre that few others have: bins are looked at with both
 * neighbours, so that rounding parts no equal ones. */
static int32_t rare_distance(refiner *r, uint64_t color)
{
    double centre[3], low = HUGE_VAL, high = 0.0;
    double *distance = r->distance;
    find_centre(r, centre);
    for (int32_t i = 0; i < r->count; i++) {
        if (r->color[r->list[i]] == color) {
            const double d = distance[i] = cell_distance(r, centre, r->list[i]);
            low = fmin(low, d);
            high = fmax(high, d);
        }
    }
    memset(r->bin, 0, sizeof r->bin);
    const double scale = high > low ? DISTANCE_BINS / (high - low) : 0.0;
    for (int32_t i = 0; i < r->count; i++) {
        if (r->color[r->list[i]] == color) {
            r->bin[(int32_t)((distance[i] - low) * scale)]++;
        }
    }
    int32_t best = r->list[0], fewest = INT32_MAX;
    for (int32_t i = 0; i < r->count; i++) {
        if (r->color[r->list[i]] == color) {
            const int32_t b = (int32_t)((distance[i] - low) * scale);
            const int32_t n = r->bin[b] + (b > 0 ? r->bin[b - 1] : 0) + (b < DISTANCE_BINS ? r->bin[b + 1] : 0);
            if (n < fewest) {
                fewest = n;
                best = r->list[i];
            }
        }
    }
    return best;
}

static int32_t pick_start(refiner *r, const color_count *rarest)
{
    int32_t c = -1;
    if ((int64_t)rarest->cells * rarest->degree > RARE_ENOUGH) {
        c = rare_distance(r, rarest->color);
    }
    for (int32_t i = 0; i < r->count && c < 0; i++) {
        c = r->color[r->list[i]] == rarest->color ? r->list[i] : -1;
    }
    return r->raw->first[c];
}

sl_status sl_symmetry_refine(const sl_mesh *mesh, const sl_raw_cells *raw, const sl_symmetry *parts, uint64_t *color,
                             int32_t *start)
{
    sl_status status = SL_OK;
    int32_t most = 0;
    for (int32_t k = 0; k < parts->components; k++) {
        const int32_t n = parts->first[k + 1] - parts->first[k];
        most = n > most ? n : most;
    }
    int64_t size = 4;
    while (size < 2 * (int64_t)most) {
        size *= 2;
    }
    refiner r = {.mesh = mesh, .raw = raw, .color = color};
    r.next = sl_alloc(most, sizeof *r.next);
    r.distance = sl_alloc(most, sizeof *r.distance);
    r.list = sl_alloc(most, sizeof *r.list);
    r.table = sl_alloc(size, sizeof *r.table);
    if (r.next == NULL || r.distance == NULL || r.list == NULL || r.table == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    for (int32_t k = 0; k < parts->components; k++) {
        r.count = 0;
        for (int32_t i = parts->first[k]; i < parts->first[k + 1]; i++) {
            const int32_t f = parts->face[i];
            if (parts->unit[f] == f) {
                r.list[r.count++] = raw->cell_of != NULL ? raw->cell_of[f] : f;
            }
        }
        const color_count rarest = refine_component(&r);
        start[k] = pick_start(&r, &rarest);
    }
cleanup:
    sl_free(r.next);
    sl_free(r.distance);
    sl_free(r.list);
    sl_free(r.table);
    return status;
}
