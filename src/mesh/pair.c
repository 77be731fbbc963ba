#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "geom/vec3.h"
#include "mesh/facet_graph.h"
#include "mesh/pair_internal.h"

/* Below this a quad is no candidate: an angle beyond 162 degrees, or as bad a bend. */
static const double least_score = 0.2;

/* A pair counts as a quad of a quad mesh when it is of this quality at least (angles within 45 degrees of right ones),
 * and so many of its four corners are regular. */
static const double good_score = 0.5;
enum {
    REGULAR_CORNERS = 3,
};

static double corner_angle(const sl_mesh *m, int32_t h)
{
    const double *p = m->xyz + 3 * (int64_t)m->origin[h];
    double a[3], b[3], c[3];
    sl_vec3_sub(m->xyz + 3 * (int64_t)sl_target(m, h), p, a);
    sl_vec3_sub(m->xyz + 3 * (int64_t)m->origin[sl_prev(m, h)], p, b);
    sl_vec3_cross(a, b, c);
    return atan2(sl_vec3_norm(c), sl_vec3_dot(a, b));
}

double sl_pair_score(const sl_mesh *m, int32_t h)
{
    const double right = 0.5 * 3.14159265358979323846;
    const int32_t t = m->twin[h], hn = sl_next(m, h), tn = sl_next(m, t);
    const double angle[4] = {corner_angle(m, h) + corner_angle(m, tn), corner_angle(m, hn) + corner_angle(m, t),
                             corner_angle(m, sl_prev(m, h)), corner_angle(m, sl_prev(m, t))};
    double worst = 0.0, n[3], o[3];
    for (int k = 0; k < 4; k++) {
        worst = fmax(worst, fabs(angle[k] - right) / right);
    }
    sl_mesh_face_vector_area(m, m->face[h], n);
    sl_mesh_face_vector_area(m, m->face[t], o);
    const double bend = sl_vec3_dot(n, o) / (sl_vec3_norm(n) * sl_vec3_norm(o));
    return fmax(1.0 - worst, 0.0) * fmax(bend, 0.0);
}

typedef struct candidate {
    double belief;
    int32_t halfedge;
} candidate;

static int compare_candidates(const void *a, const void *b)
{
    const candidate *x = a, *y = b;
    if (x->belief != y->belief) {
        return x->belief > y->belief ? -1 : 1;
    }
    return (x->halfedge > y->halfedge) - (x->halfedge < y->halfedge);
}

/* score[h] of every edge between two triangles, 0 where that is no candidate; returns the number of candidates. */
static int32_t score_edges(const sl_mesh *m, double *score)
{
    int32_t n = 0;
    for (int32_t h = 0; h < m->nh; h++) {
        score[h] = 0.0;
    }
    for (int32_t h = 0; h < m->nh; h++) {
        const int32_t t = m->twin[h];
        if (t < h || sl_degree(m, m->face[h]) != 3 || sl_degree(m, m->face[t]) != 3) {
            continue;
        }
        const double s = sl_pair_score(m, h);
        if (s > least_score) {
            score[h] = score[t] = s;
            n++;
        }
    }
    return n;
}

static void list_candidates(const sl_matching *matching, const double *belief, candidate *list)
{
    const sl_mesh *m = matching->mesh;
    for (int32_t h = 0; h < m->nh; h++) {
        if (matching->score[h] > 0.0 && h < m->twin[h]) {
            *list++ = (candidate){belief[h], h};
        }
    }
}

static void match_greedily(sl_matching *matching, candidate *list, int32_t n)
{
    const sl_mesh *m = matching->mesh;
    qsort(list, (size_t)n, sizeof *list, compare_candidates);
    for (int32_t i = 0; i < n; i++) {
        const int32_t h = list[i].halfedge, t = m->twin[h];
        if (matching->mate[m->face[h]] < 0 && matching->mate[m->face[t]] < 0) {
            matching->mate[m->face[h]] = h;
            matching->mate[m->face[t]] = t;
        }
    }
}

/* Share of the triangles in pairs with REGULAR_CORNERS regular corners: a vertex inside with four edges once the
 * diagonals are gone, or one on the border. That is what tells quads from triangles that happen to fit together. */
static sl_status measure(const sl_matching *matching, double *fraction)
{
    const sl_mesh *m = matching->mesh;
    int32_t *edges = sl_calloc(m->nv, sizeof *edges);
    if (edges == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t h = 0; h < m->nh; h++) {
        edges[m->origin[h]] += matching->mate[m->face[h]] != h;
    }
    for (int32_t h = 0; h < m->nh; h++) {
        if (m->twin[h] < 0) {
            edges[m->origin[h]] = 4;
        }
    }
    int64_t triangles = 0, good = 0;
    for (int32_t f = 0; f < m->nf; f++) {
        const int32_t h = matching->mate[f], t = h >= 0 ? m->twin[h] : -1;
        triangles += sl_degree(m, f) == 3;
        if (h >= 0) {
            const int32_t corner[4] = {h, t, sl_prev(m, h), sl_prev(m, t)};
            int regular = 0;
            for (int k = 0; k < 4; k++) {
                regular += edges[m->origin[corner[k]]] == 4;
            }
            good += regular >= REGULAR_CORNERS && matching->score[h] >= good_score;
        }
    }
    *fraction = triangles > 0 ? (double)good / (double)triangles : 0.0;
    sl_free(edges);
    return SL_OK;
}

sl_status sl_pair_triangles(const sl_mesh *mesh, int32_t *partner, double *paired_fraction)
{
    sl_status status = SL_OK;
    candidate *list = NULL;
    double *score = sl_alloc(mesh->nh, sizeof *score), *belief = sl_alloc(mesh->nh, sizeof *belief);
    sl_matching matching = {mesh, score, sl_alloc(mesh->nf, sizeof *matching.mate)};
    SL_TRY(score != NULL && belief != NULL && matching.mate != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t f = 0; f < mesh->nf; f++) {
        matching.mate[f] = -1;
    }
    const int32_t n = score_edges(mesh, score);
    list = sl_alloc(n, sizeof *list);
    SL_TRY(list != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(sl_pair_beliefs(mesh, score, belief));
    list_candidates(&matching, belief, list);
    match_greedily(&matching, list, n);
    SL_TRY(sl_matching_augment(&matching));
    SL_TRY(measure(&matching, paired_fraction));
    for (int32_t f = 0; f < mesh->nf; f++) {
        partner[f] = matching.mate[f] >= 0 ? mesh->face[mesh->twin[matching.mate[f]]] : -1;
    }
cleanup:
    sl_free(score);
    sl_free(belief);
    sl_free(list);
    sl_free(matching.mate);
    return status;
}
