/* What any map has to satisfy, and a slow way to count automorphisms. */
#ifndef SL_TEST_SYMMETRY_CHECKS_H
#define SL_TEST_SYMMETRY_CHECKS_H

#include "models.h"

#include "symmetry/symmetry.h"

static inline sl_symmetry *find_all(const sl_mesh *mesh, const int32_t *partner, int32_t most)
{
    sl_symmetry_def def = sl_symmetry_default();
    def.most = most;
    sl_symmetry *s = NULL;
    assert_int_equal(sl_symmetry_find(mesh, partner, &def, NULL, &s), SL_OK);
    return s;
}

static inline double corner_distance(const sl_mesh *m, int32_t g, int32_t h)
{
    double sum = 0.0;
    for (int k = 0; k < 3; k++) {
        const double d = m->xyz[3 * m->origin[g] + k] - m->xyz[3 * m->origin[h] + k];
        sum += d * d;
    }
    return sqrt(sum);
}

/* Misfit and deviation by their definitions. */
static inline void check_geometry(const sl_mesh *m, const sl_symmetry *s, const sl_symmetry_map *map)
{
    double misfit = 0.0, deviation = 0.0, low[3], high[3], extent = 0.0;
    for (int k = 0; k < 3; k++) {
        low[k] = HUGE_VAL;
        high[k] = -HUGE_VAL;
    }
    for (int32_t h = 0; h < m->nh; h++) {
        for (int k = 0; k < 3 && s->component[m->face[h]] == map->from; k++) {
            low[k] = fmin(low[k], m->xyz[3 * m->origin[h] + k]);
            high[k] = fmax(high[k], m->xyz[3 * m->origin[h] + k]);
        }
    }
    for (int k = 0; k < 3; k++) {
        extent += (high[k] - low[k]) * (high[k] - low[k]);
    }
    extent = sqrt(extent);
    for (int32_t h = 0; h < m->nh; h++) {
        if (s->component[m->face[h]] == map->from) {
            const int32_t next = sl_next(m, h), to = sl_symmetry_image_corner(m, s, map, h);
            const double a = corner_distance(m, h, next);
            const double b = corner_distance(m, to, sl_symmetry_image_corner(m, s, map, next));
            const double *T = map->isometry, *p = &m->xyz[3 * m->origin[h]], *q = &m->xyz[3 * m->origin[to]];
            double sum = 0.0;
            for (int k = 0; k < 3; k++) {
                const double d = T[4 * k] * p[0] + T[4 * k + 1] * p[1] + T[4 * k + 2] * p[2] + T[4 * k + 3] - q[k];
                sum += d * d;
            }
            misfit = fmax(misfit, fabs(a - b) / fmax(fmax(a, b), 1e-6 * extent));
            deviation = fmax(deviation, sqrt(sum) / extent);
        }
    }
    if (extent > 0.0) {
        assert_true(test_near(map->deviation, deviation, 1e-14));
        assert_true(map->misfit >= misfit - 1e-13 && map->misfit <= fmax(misfit + 1e-13, 1e-9));
    }
}

/* Corners to corners, next to next (or prev), twins to twins, one to one; order as said. Without pairs. */
static inline void check_map(const sl_mesh *m, const sl_symmetry *s, const sl_symmetry_map *map)
{
    uint8_t *used = sl_calloc(m->nh, sizeof *used);
    int32_t *power = sl_alloc(m->nh, sizeof *power);
    assert_true(used != NULL && power != NULL);
    int32_t corners = 0;
    for (int32_t h = 0; h < m->nh; h++) {
        if (s->component[m->face[h]] != map->from) {
            continue;
        }
        const int32_t g = sl_symmetry_image_corner(m, s, map, h), f = m->face[h];
        corners++;
        power[h] = g;
        assert_int_equal(s->component[m->face[g]], map->to);
        assert_int_equal(used[g]++, 0);
        assert_int_equal(m->face[g], sl_symmetry_image(m, s, map, f));
        assert_int_equal(sl_degree(m, f), sl_degree(m, m->face[g]));
        const int32_t next = sl_symmetry_image_corner(m, s, map, sl_next(m, h));
        assert_int_equal(next, map->reverses ? sl_prev(m, g) : sl_next(m, g));
        const int32_t edge = map->reverses ? sl_prev(m, g) : g, t = m->twin[h];
        if (t < 0) {
            assert_int_equal(m->twin[edge], -1);
        } else {
            const int32_t there = sl_symmetry_image_corner(m, s, map, t);
            assert_int_equal(m->twin[edge], map->reverses ? sl_prev(m, there) : there);
        }
    }
    assert_int_equal(corners, map->corners);
    check_geometry(m, s, map);
    for (int32_t k = 1; k <= map->order && map->from == map->to; k++) {
        bool identity = true;
        for (int32_t h = 0; h < m->nh; h++) {
            if (s->component[m->face[h]] == map->from) {
                identity = identity && power[h] == h;
                power[h] = sl_symmetry_image_corner(m, s, map, power[h]);
            }
        }
        assert_int_equal(identity, k == map->order);
    }
    sl_free(used);
    sl_free(power);
}

static inline void check_all(const sl_mesh *m, const sl_symmetry *s)
{
    for (int32_t i = 0; i < s->nmap; i++) {
        check_map(m, s, &s->map[i]);
        for (int32_t k = 0; k < i; k++) {
            assert_true(s->map[k].from != s->map[i].from || s->map[k].to != s->map[i].to ||
                        s->map[k].reverses != s->map[i].reverses ||
                        memcmp(s->map[k].corner, s->map[i].corner, (size_t)s->map[i].corners * sizeof(int32_t)) != 0);
        }
    }
}

/* Facet with the directed edge a b (b a where backwards), by looking at all of them; its corner at a in *corner. */
static inline int32_t facet_with_edge(const model *m, int32_t a, int32_t b, bool backwards, int32_t *corner)
{
    for (int32_t f = 0; f < m->nf; f++) {
        const int32_t d = m->first[f + 1] - m->first[f];
        for (int32_t k = 0; k < d; k++) {
            const int32_t u = m->index[m->first[f] + k], v = m->index[m->first[f] + (k + 1) % d];
            if (backwards ? (u == b && v == a) : (u == a && v == b)) {
                *corner = backwards ? (k + 1) % d : k;
                return f;
            }
        }
    }
    return -1;
}

/* Sends the corners of facet f, from position k on, to those of g from position l on; false at a contradiction. */
static inline bool send_facet(const model *m, int32_t f, int32_t k, int32_t g, int32_t l, bool backwards,
                              int32_t *image, bool *changed)
{
    const int32_t d = m->first[f + 1] - m->first[f];
    if (g < 0 || m->first[g + 1] - m->first[g] != d) {
        return false;
    }
    for (int32_t i = 0; i < d; i++) {
        const int32_t from = m->index[m->first[f] + (k + i) % d];
        const int32_t to = m->index[m->first[g] + (backwards ? l - i + d : l + i) % d];
        if (image[from] >= 0 && image[from] != to) {
            return false;
        }
        *changed = *changed || image[from] < 0;
        image[from] = to;
    }
    return true;
}

/* Is there a map of vertices that sends facet 0 to facet g from corner l on, and every facet to a facet? Known from the
 * vertices of the facets alone. The model is connected, its facets share edges. image: nv. */
static inline bool brute_force_map(const model *m, int32_t g, int32_t l, bool backwards, int32_t *image)
{
    for (int32_t v = 0; v < m->nv; v++) {
        image[v] = -1;
    }
    bool changed = false;
    if (!send_facet(m, 0, 0, g, l, backwards, image, &changed)) {
        return false;
    }
    while (changed) {
        changed = false;
        for (int32_t f = 0; f < m->nf; f++) {
            const int32_t d = m->first[f + 1] - m->first[f];
            for (int32_t k = 0; k < d; k++) {
                const int32_t a = image[m->index[m->first[f] + k]], b = image[m->index[m->first[f] + (k + 1) % d]];
                if (a < 0 || b < 0) {
                    continue;
                }
                int32_t corner = 0;
                const int32_t there = facet_with_edge(m, a, b, backwards, &corner);
                if (!send_facet(m, f, k, there, corner, backwards, image, &changed)) {
                    return false;
                }
            }
        }
    }
    uint8_t used[MODEL_VERTICES] = {0};
    for (int32_t v = 0; v < m->nv; v++) {
        if (image[v] < 0 || used[image[v]]++ > 0) {
            return false;
        }
    }
    return true;
}

/* All automorphisms but the identity. */
static inline int32_t brute_force_count(const model *m)
{
    int32_t count = -1, *image = sl_alloc(m->nv, sizeof *image);
    assert_non_null(image);
    for (int32_t g = 0; g < m->nf; g++) {
        for (int32_t l = 0; l < m->first[g + 1] - m->first[g]; l++) {
            count += brute_force_map(m, g, l, false, image);
            count += brute_force_map(m, g, l, true, image);
        }
    }
    sl_free(image);
    return count;
}

#endif
