/* Walking along seams and borders, and what elements are called. */
#include "edit/session_internal.h"

#include "base/memory.h"

int32_t sl_edit_border_next(const sl_mesh *mesh, int32_t h)
{
    int32_t g = sl_next(mesh, h);
    while (mesh->twin[g] >= 0) {
        g = sl_next(mesh, mesh->twin[g]);
    }
    return g;
}

int32_t sl_edit_border_previous(const sl_mesh *mesh, int32_t h)
{
    int32_t g = sl_prev(mesh, h);
    while (mesh->twin[g] >= 0) {
        g = sl_prev(mesh, mesh->twin[g]);
    }
    return g;
}

/* The arc goes on where only two seam edges meet in a vertex: on either side of it one fan of facets. At the tip of a
 * slit the border turns back along the other side. */
int32_t sl_edit_arc_next(const sl_mesh *mesh, int32_t h)
{
    if (mesh->sew[h] < 0) {
        return -1;
    }
    const int32_t next = sl_edit_border_next(mesh, h);
    if (mesh->sew[next] < 0 || next == mesh->sew[h]) {
        return -1;
    }
    return sl_edit_border_previous(mesh, mesh->sew[h]) == mesh->sew[next] ? next : -1;
}

void sl_edit_fan(const sl_mesh *mesh, int32_t h, int32_t fan[2])
{
    int32_t g = h;
    fan[0] = h;
    fan[1] = 0;
    do { /* clockwise to the border, or round to h */
        const int32_t before = mesh->twin[g];
        if (before < 0) {
            break;
        }
        g = sl_next(mesh, before);
    } while (g != h);
    const int32_t start = g;
    do {
        fan[0] = g < fan[0] ? g : fan[0];
        fan[1]++;
        const int32_t after = mesh->twin[sl_prev(mesh, g)];
        g = after;
    } while (g >= 0 && g != start);
}

int32_t sl_session_find_corner(const sl_session *session, int32_t vertex, int32_t facet)
{
    const sl_mesh *mesh = session->mesh;
    if (facet < 0 || facet >= mesh->nf) {
        return -1;
    }
    for (int32_t h = mesh->face_first[facet]; h < mesh->face_first[facet + 1]; h++) {
        if (mesh->input_vertex[mesh->origin[h]] == vertex) {
            return h;
        }
    }
    return -1;
}

int32_t sl_session_find_side(const sl_session *session, int32_t v, int32_t w, int32_t facet)
{
    const sl_mesh *mesh = session->mesh;
    if (facet < 0 || facet >= mesh->nf) {
        return -1;
    }
    for (int32_t h = mesh->face_first[facet]; h < mesh->face_first[facet + 1]; h++) {
        const int32_t a = mesh->input_vertex[mesh->origin[h]], b = mesh->input_vertex[sl_target(mesh, h)];
        if ((a == v && b == w) || (a == w && b == v)) {
            return h;
        }
    }
    return -1;
}

void sl_session_name_corner(const sl_session *session, int32_t halfedge, int32_t name[2])
{
    name[0] = session->mesh->input_vertex[session->mesh->origin[halfedge]];
    name[1] = session->mesh->face[halfedge];
}

void sl_session_name_side(const sl_session *session, int32_t halfedge, int32_t name[3])
{
    sl_session_name_corner(session, halfedge, name);
    name[2] = name[1];
    name[1] = session->mesh->input_vertex[sl_target(session->mesh, halfedge)];
}

sl_status sl_session_arc(const sl_session *session, int32_t halfedge, int32_t **arc, int32_t *count)
{
    const sl_mesh *mesh = session->mesh;
    *arc = NULL;
    *count = 0;
    if (halfedge < 0 || halfedge >= mesh->nh || mesh->sew[halfedge] < 0) {
        return SL_BAD_INPUT;
    }
    int32_t start = halfedge, back, n = 1; /* backwards is forwards along the other side */
    for (back = sl_edit_arc_next(mesh, mesh->sew[start]); back >= 0 && mesh->sew[back] != halfedge;
         back = sl_edit_arc_next(mesh, back)) {
        start = mesh->sew[back];
    }
    for (int32_t h = sl_edit_arc_next(mesh, start); h >= 0 && h != start; h = sl_edit_arc_next(mesh, h)) {
        n++;
    }
    int32_t *list = sl_alloc(n, sizeof *list);
    if (list == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t h = start; *count < n; h = sl_edit_arc_next(mesh, h)) {
        list[(*count)++] = h;
    }
    *arc = list;
    return SL_OK;
}
