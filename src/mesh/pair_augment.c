#include "base/memory.h"
#include "mesh/pair_internal.h"

enum {
    SEARCH_LIMIT = 2000, /* facets looked at from one free facet: holes further apart stay */
};

/* Breadth-first alternating search. Facets reached over a candidate edge are `inner`, their mates `outer`; blossoms are
 * not shrunk, so a path through one may be missed: that costs a pair, never a wrong one. */
typedef struct search {
    sl_matching *m;
    int32_t *stamp; /* nf: last search that reached a facet */
    int32_t *via;   /* nf: inner: halfedge from its outer facet; outer: its inner mate; the root: -1 */
    int32_t *queue; /* SEARCH_LIMIT + 3 outer facets */
} search;

static int32_t facet_across(const sl_matching *m, int32_t h)
{
    return m->mesh->face[m->mesh->twin[h]];
}

/* A free facet at the end of an alternating path from `root`, -1 when the search finds none. */
static int32_t find_free(search *s, int32_t root)
{
    const sl_mesh *mesh = s->m->mesh;
    int32_t begin = 0, end = 0;
    s->queue[end++] = root;
    s->stamp[root] = root;
    s->via[root] = -1;
    while (begin < end && end < SEARCH_LIMIT) {
        const int32_t f = s->queue[begin++];
        for (int32_t h = mesh->face_first[f]; h < mesh->face_first[f + 1]; h++) {
            const int32_t g = s->m->score[h] > 0.0 ? facet_across(s->m, h) : f;
            if (s->stamp[g] == root) {
                continue;
            }
            s->stamp[g] = root;
            s->via[g] = h;
            if (s->m->mate[g] < 0) {
                return g;
            }
            const int32_t outer = facet_across(s->m, s->m->mate[g]);
            if (s->stamp[outer] != root) {
                s->stamp[outer] = root;
                s->via[outer] = g;
                s->queue[end++] = outer;
            }
        }
    }
    return -1;
}

/* Swaps matched and unmatched edges from the free facet back to the root. */
static void flip_path(search *s, int32_t inner)
{
    while (inner >= 0) {
        const int32_t h = s->via[inner], outer = s->m->mesh->face[h];
        s->m->mate[inner] = s->m->mesh->twin[h];
        s->m->mate[outer] = h;
        inner = s->via[outer];
    }
}

sl_status sl_matching_augment(sl_matching *matching)
{
    const int32_t nf = matching->mesh->nf;
    sl_status status = SL_OK;
    search s = {.m = matching};
    s.stamp = sl_alloc(nf, sizeof *s.stamp);
    s.via = sl_alloc(nf, sizeof *s.via);
    s.queue = sl_alloc(SEARCH_LIMIT + 3, sizeof *s.queue);
    SL_TRY(s.stamp != NULL && s.via != NULL && s.queue != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t f = 0; f < nf; f++) {
        s.stamp[f] = -1;
    }
    for (int32_t f = 0; f < nf; f++) {
        const int32_t end = matching->mate[f] < 0 && sl_degree(matching->mesh, f) == 3 ? find_free(&s, f) : -1;
        if (end >= 0) {
            flip_path(&s, end);
        }
    }
cleanup:
    sl_free(s.stamp);
    sl_free(s.via);
    sl_free(s.queue);
    return status;
}
