/* The halves of an involution. */
#include "symmetry/symmetry_internal.h"

#include "base/memory.h"
#include "geom/vec3.h"

enum { FIXED = -1, NEW = -2 };

/* Parts of the component without axis edges and fixed facets. */
typedef struct halver {
    const sl_mesh *mesh;
    const sl_symmetry *parts;
    const sl_symmetry_map *map;
    const int32_t *face;   /* map->count: facets of the component */
    int32_t *label, *list; /* map->count: part of a facet, or FIXED; facets part by part */
    int32_t *begin;        /* labels + 1: into list */
    int32_t labels;
} halver;

static inline int32_t place_of(const halver *v, int32_t f)
{
    return v->parts->place[f] - v->parts->first[v->map->from];
}

/* Do f, with image `image`, and its neighbour g meet on the axis? */
static inline bool meet_on_axis(const halver *v, int32_t f, int32_t image, int32_t g)
{
    const int32_t *unit = v->parts->unit;
    return unit[image] == unit[g] && f != g && (unit[f] != unit[g] || image == g);
}

static void find_parts(halver *v)
{
    const sl_mesh *m = v->mesh;
    int32_t end = 0;
    for (int32_t i = 0; i < v->map->count; i++) {
        v->label[i] = v->map->facet[i] == v->face[i] ? FIXED : NEW;
    }
    for (int32_t i = 0; i < v->map->count; i++) {
        if (v->label[i] != NEW) {
            continue;
        }
        int32_t next = end;
        v->begin[v->labels] = end;
        v->label[i] = v->labels;
        v->list[end++] = v->face[i];
        for (; next < end; next++) {
            const int32_t f = v->list[next], image = v->map->facet[place_of(v, f)];
            for (int32_t h = m->face_first[f]; h < m->face_first[f + 1]; h++) {
                const int32_t g = m->twin[h] >= 0 ? m->face[m->twin[h]] : f, at = place_of(v, g);
                if (v->label[at] == NEW && !meet_on_axis(v, f, image, g)) {
                    v->label[at] = v->labels;
                    v->list[end++] = g;
                }
            }
        }
        v->labels++;
    }
    v->begin[v->labels] = end;
}

static int32_t mirrored_part(const halver *v, int32_t label)
{
    return v->label[place_of(v, v->map->facet[place_of(v, v->list[v->begin[label]])])];
}

static void part_centroid(const halver *v, int32_t label, double c[3])
{
    double sum[3] = {0};
    for (int32_t i = v->begin[label]; i < v->begin[label + 1]; i++) {
        sl_mesh_face_centroid(v->mesh, v->list[i], c);
        sl_vec3_add(sum, c, sum);
    }
    for (int k = 0; k < 3; k++) {
        c[k] = sum[k] / (v->begin[label + 1] - v->begin[label]);
    }
}

/* Part 0, that of the lowest facet, is on side 1; of the other pairs of parts the one that lies as part 0 does. side is
 * per facet of the component; fixed facets on side 1. */
static void choose_sides(const halver *v, uint8_t *side)
{
    double a[3] = {0}, b[3] = {0}, towards[3];
    if (v->labels > 2) {
        part_centroid(v, 0, a);
        part_centroid(v, mirrored_part(v, 0), b);
    }
    sl_vec3_sub(a, b, towards);
    for (int32_t i = 0; i < v->map->count; i++) {
        side[i] = 1;
    }
    for (int32_t l = 0; l < v->labels; l++) {
        const int32_t m = mirrored_part(v, l);
        bool far = l != 0;
        if (l < m && l != 0) {
            part_centroid(v, l, a);
            part_centroid(v, m, b);
            sl_vec3_sub(a, b, a);
            far = sl_vec3_dot(a, towards) < 0.0;
        }
        if (l < m) {
            const int32_t zero = far ? l : m;
            for (int32_t i = v->begin[zero]; i < v->begin[zero + 1]; i++) {
                side[place_of(v, v->list[i])] = 0;
            }
        }
    }
}

static void measure_axis(const halver *v, const uint8_t *side, sl_symmetry_map *map)
{
    const sl_mesh *m = v->mesh;
    map->fixed_facets = map->axis_edges = 0;
    map->axis_length = 0.0;
    for (int32_t i = 0; i < map->count; i++) {
        const int32_t f = v->face[i], image = map->facet[i];
        map->fixed_facets += image == f;
        for (int32_t h = m->face_first[f]; h < m->face_first[f + 1]; h++) {
            const int32_t t = m->twin[h];
            if (t > h) {
                const int32_t g = m->face[t];
                map->axis_edges += meet_on_axis(v, f, image, g);
                if (map->separates && side[i] != side[place_of(v, g)]) {
                    map->axis_length += sl_mesh_edge_length(m, h);
                }
            }
        }
    }
}

sl_status sl_symmetry_halve(const sl_mesh *mesh, const sl_symmetry *parts, sl_symmetry_map *map, uint8_t *side)
{
    sl_status status = SL_OK;
    halver v = {.mesh = mesh, .parts = parts, .map = map, .face = parts->face + parts->first[map->from]};
    uint8_t *own = NULL;
    v.label = sl_alloc(map->count, sizeof *v.label);
    v.list = sl_alloc(map->count, sizeof *v.list);
    v.begin = sl_alloc((int64_t)map->count + 1, sizeof *v.begin);
    if (side == NULL) {
        side = own = sl_alloc(map->count, sizeof *own);
    }
    if (v.label == NULL || v.list == NULL || v.begin == NULL || side == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    find_parts(&v);
    map->separates = v.labels > 0;
    for (int32_t l = 0; l < v.labels && map->separates; l++) {
        map->separates = mirrored_part(&v, l) != l;
    }
    if (map->separates) {
        choose_sides(&v, side);
    }
    measure_axis(&v, side, map);
cleanup:
    sl_free(own);
    sl_free(v.label);
    sl_free(v.list);
    sl_free(v.begin);
    return status;
}

sl_status sl_symmetry_sides(const sl_mesh *mesh, const sl_symmetry *symmetry, const sl_symmetry_map *map, uint8_t *side)
{
    SL_ASSERT(map->separates);
    sl_symmetry_map copy = *map; /* its arrays are only read */
    uint8_t *half = sl_alloc(map->count, sizeof *half);
    sl_status status = half != NULL ? sl_symmetry_halve(mesh, symmetry, &copy, half) : SL_OUT_OF_MEMORY;
    if (status == SL_OK) {
        for (int32_t f = 0; f < mesh->nf; f++) {
            side[f] = 2;
        }
        for (int32_t i = 0; i < map->count; i++) {
            side[symmetry->face[symmetry->first[map->from] + i]] = half[i];
        }
    }
    sl_free(half);
    return status;
}
