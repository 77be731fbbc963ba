/* Random sets of facets, and their topology counted by union-find.
 * For meshes of at most CHECK_CORNERS corners, but for grow_set. */
#ifndef SL_TEST_CHART_CHECK_H
#define SL_TEST_CHART_CHECK_H

#include "mesh/mesh_check.h"

/* A connected random set: grown over twins from a random facet, in a random order. Returns its size. */
static inline int32_t grow_set(const sl_mesh *m, test_rng *rng, int32_t want, int32_t *faces)
{
    int32_t n = 0;
    static bool in[SOUP_FACES];
    for (int32_t f = 0; f < m->nf; f++) {
        in[f] = false;
    }
    faces[n++] = test_index(rng, m->nf);
    in[faces[0]] = true;
    for (int32_t tries = 0; tries < 60 * want && n < want; tries++) {
        const int32_t f = faces[test_index(rng, n)], h = m->face_first[f] + test_index(rng, sl_degree(m, f));
        const int32_t g = m->twin[h] >= 0 ? m->face[m->twin[h]] : f;
        if (!in[g]) {
            in[g] = true;
            faces[n++] = g;
        }
    }
    for (int32_t i = n - 1; i > 0; i--) {
        const int32_t j = test_index(rng, i + 1), t = faces[i];
        faces[i] = faces[j];
        faces[j] = t;
    }
    return n;
}

typedef struct counts {
    int32_t vertices, edges, faces, loops, components;
} counts;

static inline bool inside(const int32_t *faces, int32_t nfaces, int32_t f)
{
    for (int32_t i = 0; i < nfaces; i++) {
        if (faces[i] == f) {
            return true;
        }
    }
    return false;
}

/* Vertices are classes of corners glued across twins inside the set; border loops are classes of border halfedges where
 * one's head is the other's tail, as classes of corners. */
static inline counts count_set(const sl_mesh *m, const int32_t *faces, int32_t nfaces)
{
    static dsu corners, sheets, borders;
    static bool used[CHECK_CORNERS], in_set[CHECK_CORNERS], border[CHECK_CORNERS];
    counts c = {.faces = nfaces};
    dsu_init(&corners, m->nh);
    dsu_init(&borders, m->nh);
    dsu_init(&sheets, m->nf);
    for (int32_t f = 0; f < m->nf; f++) {
        in_set[f] = inside(faces, nfaces, f);
    }
    for (int32_t h = 0; h < m->nh; h++) {
        const int32_t t = m->twin[h];
        used[h] = in_set[m->face[h]];
        border[h] = used[h] && (t < 0 || !in_set[m->face[t]]);
        c.edges += border[h] ? 2 : used[h];
        if (used[h] && !border[h]) {
            dsu_join(&corners, h, sl_next(m, t), 0);
            dsu_join(&sheets, m->face[h], m->face[t], 0);
        }
    }
    c.edges /= 2;
    for (int32_t h = 0; h < m->nh; h++) {
        for (int32_t g = 0; g < m->nh && border[h]; g++) {
            if (border[g] && dsu_same(&corners, sl_next(m, h), g)) {
                dsu_join(&borders, h, g, 0);
            }
        }
    }
    c.vertices = dsu_classes(&corners, used);
    c.loops = dsu_classes(&borders, border);
    c.components = dsu_classes(&sheets, in_set);
    return c;
}

#endif
