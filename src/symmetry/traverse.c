/* The isomorphism that two corners determine. */
#include "symmetry/symmetry.h"

#include "base/memory.h"

typedef struct traversal {
    const sl_mesh *mesh;
    bool reverses;
    int32_t *image;
    int32_t *queue; /* facets in the order they are reached */
    uint8_t *used;  /* facets that are images */
    int32_t end;
} traversal;

/* Sends the facet of corner a to that of corner b; false when that contradicts degrees or another facet's image. */
static bool place(traversal *t, int32_t a, int32_t b)
{
    const sl_mesh *m = t->mesh;
    const int32_t f = m->face[a], g = m->face[b], degree = sl_degree(m, f);
    if (degree != sl_degree(m, g) || t->used[g]) {
        return false;
    }
    t->used[g] = 1;
    t->queue[t->end++] = f;
    for (int32_t k = 0; k < degree; k++) {
        t->image[a] = b;
        a = sl_next(m, a);
        b = t->reverses ? sl_prev(m, b) : sl_next(m, b);
    }
    return true;
}

/* Corner that the twin of h goes to, -1 where the image edge is a border. */
static int32_t image_of_twin(const traversal *t, int32_t h)
{
    const sl_mesh *m = t->mesh;
    if (!t->reverses) {
        return m->twin[t->image[h]];
    }
    const int32_t there = m->twin[sl_prev(m, t->image[h])];
    return there >= 0 ? sl_next(m, there) : -1;
}

static bool walk(traversal *t, int32_t a, int32_t b)
{
    const sl_mesh *m = t->mesh;
    bool same = place(t, a, b);
    for (int32_t i = 0; i < t->end && same; i++) {
        const int32_t f = t->queue[i];
        for (int32_t h = m->face_first[f]; h < m->face_first[f + 1] && same; h++) {
            const int32_t there = image_of_twin(t, h), twin = m->twin[h];
            if (twin < 0 || there < 0) {
                same = twin == there;
            } else if (t->image[twin] >= 0) {
                same = t->image[twin] == there;
            } else {
                same = place(t, twin, there);
            }
        }
    }
    return same;
}

sl_status sl_symmetry_traverse(const sl_mesh *mesh, int32_t a, int32_t b, bool reverses, int32_t *image, bool *found)
{
    sl_status status = SL_OK;
    traversal t = {.mesh = mesh, .reverses = reverses, .image = image};
    t.queue = sl_alloc(mesh->nf, sizeof *t.queue);
    t.used = sl_calloc(mesh->nf, sizeof *t.used);
    if (t.queue == NULL || t.used == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    for (int32_t h = 0; h < mesh->nh; h++) {
        image[h] = -1;
    }
    *found = walk(&t, a, b);
    for (int32_t h = 0; h < mesh->nh && !*found; h++) {
        image[h] = -1;
    }
cleanup:
    sl_free(t.queue);
    sl_free(t.used);
    return status;
}
