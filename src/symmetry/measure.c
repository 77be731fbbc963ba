/* What the geometry says of a map. */
#include "symmetry/rigid.h"
#include "symmetry/symmetry_internal.h"

#include "geom/vec3.h"

enum { SAMPLE = 4096 }; /* corners of the first fit, which is the last where it is exact */

static const double BOUND_ENOUGH = 1e-6; /* a misfit bounded by this share of def.lengths is not measured */
static const double SHORTEST = 1e-6;     /* edges below this share of the diagonal count as that long */

static void fit(const sl_cells *cells, int32_t from, int32_t to, int32_t corners, int32_t stride, bool reverses,
                const int32_t *image, double isometry[12])
{
    const int32_t base = sl_cells_base(cells, from);
    const double *origin_p = &cells->centre[3 * (int64_t)from], *origin_q = &cells->centre[3 * (int64_t)to];
    sl_rigid_sums sums = {0};
    for (int32_t i = 0; i < corners; i += stride) {
        double p[3], q[3];
        sl_vec3_sub(&cells->xyz[3 * (int64_t)cells->point[base + i]], origin_p, p);
        sl_vec3_sub(&cells->xyz[3 * (int64_t)cells->point[image[i]]], origin_q, q);
        sl_rigid_add(&sums, p, q);
    }
    sl_rigid_fit(&sums, origin_p, origin_q, reverses, isometry);
}

/* Largest distance of a moved point to its image, of the first `corners` corners. Points are numbered as they are first
 * met: each is looked at once. */
static double largest_distance(const sl_cells *cells, int32_t from, int32_t corners, const int32_t *image,
                               const double isometry[12])
{
    const int32_t base = sl_cells_base(cells, from), end = base + corners;
    int32_t next = cells->point[base];
    double worst = 0.0;
    for (int32_t h = base; h < end; h++) {
        if (cells->point[h] == next) {
            const double *q = &cells->xyz[3 * (int64_t)cells->point[image[h - base]]];
            double moved[3];
            sl_rigid_apply(isometry, &cells->xyz[3 * (int64_t)next++], moved);
            sl_vec3_sub(moved, q, moved);
            const double d = sl_vec3_dot(moved, moved);
            worst = d > worst ? d : worst;
        }
    }
    return sqrt(worst);
}

double sl_symmetry_fit(const sl_cells *cells, int32_t from, int32_t to, int32_t limit, bool reverses,
                       const int32_t *image, double isometry[12])
{
    const int32_t begin = cells->component[from], end = cells->component[from + 1];
    const int32_t last = end - begin > limit ? begin + limit : end;
    const int32_t corners = cells->first[last] - cells->first[begin];
    fit(cells, from, to, corners, 1, reverses, image, isometry);
    return largest_distance(cells, from, corners, image, isometry);
}

/* Largest (long^2 - short^2) / long^2 of corresponding edges, none taken as shorter than `shortest`. Both corners'
 * images give the image edge, whichever way it runs. */
static double largest_ratio(const sl_cells *cells, int32_t from, const int32_t *image, double shortest)
{
    const int32_t base = sl_cells_base(cells, from);
    double most = 0.0;
    for (int32_t j = cells->component[from]; j < cells->component[from + 1]; j++) {
        const int32_t last = cells->first[j + 1] - 1;
        const double *a = &cells->xyz[3 * (int64_t)cells->point[last]];
        const double *b = &cells->xyz[3 * (int64_t)cells->point[image[last - base]]];
        for (int32_t h = cells->first[j]; h <= last; h++) {
            const double *p = &cells->xyz[3 * (int64_t)cells->point[h]];
            const double *q = &cells->xyz[3 * (int64_t)cells->point[image[h - base]]];
            double e[3], f[3];
            sl_vec3_sub(p, a, e);
            sl_vec3_sub(q, b, f);
            const double one = sl_vec3_dot(e, e), other = sl_vec3_dot(f, f);
            double longer = one > other ? one : other;
            longer = longer > shortest * shortest ? longer : shortest * shortest;
            if (fabs(one - other) > most * longer) {
                most = fabs(one - other) / longer;
            }
            a = p;
            b = q;
        }
    }
    return most;
}

/* The map's powers act freely on pairs of a corner and an orientation, so one orbit tells. */
static int32_t find_order(const sl_cells *cells, int32_t from, const int32_t *image, bool reverses)
{
    const int32_t base = sl_cells_base(cells, from);
    int32_t at = base, order = 0;
    do {
        at = image[at - base];
        order++;
    } while (at != base || (reverses && order % 2 == 1));
    return order;
}

void sl_symmetry_measure(const sl_cells *cells, const sl_symmetry_def *def, const int32_t *image, sl_symmetry_map *map)
{
    const int32_t corners = sl_cells_corners(cells, map->from);
    const double size = cells->size[map->from], unit = size > 0.0 ? size : 1.0;
    for (int32_t stride = corners / SAMPLE + 1; stride >= 1; stride = stride > 1 ? 1 : 0) {
        fit(cells, map->from, map->to, corners, stride, map->reverses, image, map->isometry);
        map->deviation = largest_distance(cells, map->from, corners, image, map->isometry) / unit;
        if (map->deviation <= def->exact) {
            break;
        }
    }
    const double shortest = fmax(SHORTEST * unit, fmin(cells->shortest[map->from], cells->shortest[map->to]));
    map->misfit = 2.0 * map->deviation * unit / shortest;
    if (map->misfit > BOUND_ENOUGH * def->lengths) {
        const double ratio = largest_ratio(cells, map->from, image, SHORTEST * unit);
        map->misfit = ratio < 1.0 ? ratio / (1.0 + sqrt(1.0 - ratio)) : 1.0; /* 1 - sqrt(1 - ratio) */
    }
    map->kind = map->deviation <= def->exact && map->misfit <= def->lengths ? SL_SYMMETRY_EXACT
                : map->deviation <= def->near                               ? SL_SYMMETRY_NEAR
                                                                            : SL_SYMMETRY_TOPOLOGICAL;
    map->order = map->from == map->to ? find_order(cells, map->from, image, map->reverses) : 0;
}
