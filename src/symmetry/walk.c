/* The walk over a component and its image at once. Source: paper, Sec. 4.3. */
#include "symmetry/symmetry_internal.h"

#include <math.h>

/* Sends cell j, from its first corner, to the cell of corner `to`; false when they differ. */
static inline bool place(const sl_cells *c, int32_t base, int32_t j, int32_t to, bool reverses, float tolerance,
                         int32_t *image, float *worst)
{
    const int32_t first = c->first[j], n = c->first[j + 1] - first;
    const int32_t cell = c->cell[to], low = c->first[cell], high = c->first[cell + 1];
    if (high - low != n || (c->pair != NULL && c->pair[j] != c->pair[cell])) {
        return false;
    }
    const float difference = fabsf(c->radius[first] - c->radius[to]);
    if (difference > tolerance) {
        return false;
    }
    *worst = difference > *worst ? difference : *worst;
    int32_t *at = image + (first - base);
    if (reverses) {
        for (int32_t k = 0; k < n; k++) {
            at[k] = to;
            to = (to > low ? to : high) - 1;
        }
    } else {
        for (int32_t k = 0; k < n; k++) {
            at[k] = to;
            to = to + 1 < high ? to + 1 : low;
        }
    }
    return true;
}

bool sl_symmetry_walk(const sl_cells *cells, int32_t from, int32_t to, bool reverses, int32_t limit, float tolerance,
                      int32_t *image, float *worst, int64_t *work)
{
    const int32_t begin = cells->component[from], end = cells->component[from + 1], base = cells->first[begin];
    const int32_t stop = end - begin > limit ? cells->first[begin + limit] : cells->first[end];
    const int32_t *twin = cells->twin, *twin_there = reverses ? cells->mirror_twin : cells->twin;
    int32_t reached = begin;
    *worst = 0.0f;
    if (!place(cells, base, reached++, to, reverses, tolerance, image, worst)) {
        *work += 1;
        return false;
    }
    int32_t h = base;
    bool same = true;
    for (; h < stop && same; h++) {
        const int32_t t = twin[h], there = twin_there[image[h - base]];
        if (t < 0 || there < 0) {
            same = t == there;
        } else if (t > h) { /* else compared from the other side */
            if (t == cells->first[reached]) {
                same = place(cells, base, reached++, there, reverses, tolerance, image, worst);
            } else {
                same = image[t - base] == there;
            }
        }
    }
    *work += h - base;
    return same;
}
