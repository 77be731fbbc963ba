#include "automorphisms.h"

#include "base/memory.h"

/* Halfedge a is sent to b. Kept orientation: next to next. Reversed: the edge of a, run backwards in the image facet:
 * next to prev. Either way twin to twin. */
typedef struct walk {
    const sl_mesh *mesh;
    bool reverses;
    int32_t *image; /* nh, -1 = not sent yet */
    int32_t *stack, *trail;
    int32_t pending, sent;
} walk;

static bool send(walk *w, int32_t a, int32_t b)
{
    if (a < 0 || b < 0) {
        return a == b;
    }
    if (w->image[a] >= 0) {
        return w->image[a] == b;
    }
    if (sl_degree(w->mesh, w->mesh->face[a]) != sl_degree(w->mesh, w->mesh->face[b])) {
        return false;
    }
    w->image[a] = b;
    w->trail[w->sent++] = a;
    w->stack[w->pending++] = a;
    return true;
}

static bool walk_from(walk *w, int32_t a, int32_t b)
{
    const sl_mesh *m = w->mesh;
    bool right = send(w, a, b);
    while (right && w->pending > 0) {
        const int32_t h = w->stack[--w->pending], i = w->image[h];
        right = send(w, sl_next(m, h), w->reverses ? sl_prev(m, i) : sl_next(m, i)) && send(w, m->twin[h], m->twin[i]);
    }
    const bool whole = right && w->sent == m->nh;
    while (w->sent > 0) {
        w->image[w->trail[--w->sent]] = -1;
    }
    w->pending = 0;
    return whole;
}

void test_count_automorphisms(const sl_mesh *mesh, int32_t most, int32_t *keeping, int32_t *reversing)
{
    walk w = {.mesh = mesh, .image = sl_alloc(mesh->nh, sizeof(int32_t))};
    w.stack = sl_alloc(mesh->nh, sizeof(int32_t));
    w.trail = sl_alloc(mesh->nh, sizeof(int32_t));
    *keeping = *reversing = -1;
    if (w.image != NULL && w.stack != NULL && w.trail != NULL) {
        *keeping = *reversing = 0;
        for (int32_t h = 0; h < mesh->nh; h++) {
            w.image[h] = -1;
        }
        for (int32_t h = 0; h < mesh->nh; h++) {
            w.reverses = false;
            *keeping += *keeping < most && walk_from(&w, 0, h);
            w.reverses = true;
            *reversing += *reversing < most && walk_from(&w, 0, h);
        }
    }
    sl_free(w.image);
    sl_free(w.stack);
    sl_free(w.trail);
}
