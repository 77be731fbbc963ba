/* Facets taken out of a mesh, as a mesh of their own. */
#include "segment/segment_internal.h"

#include "base/memory.h"

#include <string.h>

int32_t sl_find_sorted(const int32_t *list, int32_t count, int32_t value)
{
    int32_t lo = 0, hi = count;
    while (lo < hi) {
        const int32_t mid = lo + (hi - lo) / 2;
        if (list[mid] < value) {
            lo = mid + 1;
        } else {
            hi = mid;
        }
    }
    return lo < count && list[lo] == value ? lo : -1;
}

static int32_t fan_root(int32_t *up, int32_t h)
{
    while (up[h] != h) {
        up[h] = up[up[h]];
        h = up[h];
    }
    return h;
}

/* Union-find over the corners: across an edge, corner h and the corner after its opposite share a vertex. The root is
 * the smallest corner of the fan. */
sl_status sl_corner_fans(const sl_mesh *mesh, bool across_seams, int32_t *vertex, int32_t *count)
{
    int32_t *up = sl_alloc(mesh->nh, sizeof *up);
    if (up == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t h = 0; h < mesh->nh; h++) {
        up[h] = h;
    }
    for (int32_t h = 0; h < mesh->nh; h++) {
        const int32_t opposite = across_seams ? sl_opposite(mesh, h) : mesh->twin[h];
        if (opposite >= 0) {
            const int32_t a = fan_root(up, h), b = fan_root(up, sl_next(mesh, opposite));
            up[a > b ? a : b] = a > b ? b : a;
        }
    }
    int32_t n = 0;
    for (int32_t h = 0; h < mesh->nh; h++) {
        const int32_t root = fan_root(up, h);
        vertex[h] = root == h ? n++ : vertex[root];
    }
    *count = n;
    sl_free(up);
    return SL_OK;
}

static sl_status mesh_allocate(int32_t nf, int32_t nh, sl_mesh **out)
{
    sl_mesh *m = sl_calloc(1, sizeof *m);
    *out = m;
    if (m == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    m->nf = nf;
    m->nh = nh;
    m->face_first = sl_alloc((int64_t)nf + 1, sizeof *m->face_first);
    m->face_flags = sl_alloc(nf, sizeof *m->face_flags);
    m->origin = sl_alloc(nh, sizeof *m->origin);
    m->face = sl_alloc(nh, sizeof *m->face);
    m->twin = sl_alloc(nh, sizeof *m->twin);
    m->sew = sl_alloc(nh, sizeof *m->sew);
    const bool ok = m->face_first != NULL && m->face_flags != NULL && m->origin != NULL && m->face != NULL &&
                    m->twin != NULL && m->sew != NULL;
    return ok ? SL_OK : SL_OUT_OF_MEMORY;
}

/* The piece's halfedge for the parent's halfedge h, -1 where that is none or outside. */
static int32_t to_piece(const sl_mesh *parent, const sl_piece *piece, int32_t h)
{
    if (h < 0) {
        return -1;
    }
    const int32_t f = parent->face[h];
    const int32_t local = sl_find_sorted(piece->face, piece->mesh->nf, f);
    return local < 0 ? -1 : piece->mesh->face_first[local] + (h - parent->face_first[f]);
}

static void copy_connectivity(const sl_mesh *parent, sl_piece *piece)
{
    sl_mesh *m = piece->mesh;
    int32_t h = 0;
    for (int32_t f = 0; f < m->nf; f++) {
        m->face_first[f] = h;
        m->face_flags[f] = parent->face_flags[piece->face[f]];
        h += sl_degree(parent, piece->face[f]);
    }
    m->face_first[m->nf] = h;
    for (int32_t f = 0; f < m->nf; f++) {
        const int32_t first = parent->face_first[piece->face[f]];
        for (int32_t k = m->face_first[f]; k < m->face_first[f + 1]; k++) {
            const int32_t from = first + (k - m->face_first[f]);
            m->face[k] = f;
            m->twin[k] = to_piece(parent, piece, parent->twin[from]);
            m->sew[k] = to_piece(parent, piece, parent->sew[from]);
        }
    }
}

static sl_status number_vertices(const sl_mesh *parent, sl_piece *piece)
{
    sl_mesh *m = piece->mesh;
    const sl_status status = sl_corner_fans(m, true, m->origin, &m->nv);
    if (status != SL_OK) {
        return status;
    }
    m->xyz = sl_alloc(3 * (int64_t)m->nv, sizeof *m->xyz);
    m->input_vertex = sl_alloc(m->nv, sizeof *m->input_vertex);
    if (m->xyz == NULL || m->input_vertex == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t h = 0; h < m->nh; h++) {
        const int32_t from = parent->origin[sl_piece_halfedge(piece, parent, h)], v = m->origin[h];
        memcpy(m->xyz + 3 * (int64_t)v, parent->xyz + 3 * (int64_t)from, 3 * sizeof *m->xyz);
        m->input_vertex[v] = parent->input_vertex[from];
    }
    memcpy(m->centre, parent->centre, sizeof m->centre);
    m->scale = parent->scale;
    return SL_OK;
}

static sl_status copy_triangles(const sl_mesh *parent, const sl_triangulation *from, sl_piece *piece)
{
    const sl_mesh *m = piece->mesh;
    sl_triangulation *t = sl_calloc(1, sizeof *t);
    piece->triangulation = t;
    if (t == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t f = 0; f < m->nf; f++) {
        t->nt += from->first[piece->face[f] + 1] - from->first[piece->face[f]];
    }
    t->first = sl_alloc((int64_t)m->nf + 1, sizeof *t->first);
    t->corner = sl_alloc(3 * (int64_t)t->nt, sizeof *t->corner);
    if (t->first == NULL || t->corner == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    int32_t n = 0;
    for (int32_t f = 0; f < m->nf; f++) {
        const int32_t g = piece->face[f], shift = m->face_first[f] - parent->face_first[g];
        t->first[f] = n;
        for (int32_t k = from->first[g]; k < from->first[g + 1]; k++, n++) {
            for (int32_t c = 0; c < 3; c++) {
                t->corner[3 * n + c] = from->corner[3 * k + c] + shift;
            }
        }
    }
    t->first[m->nf] = n;
    return SL_OK;
}

sl_status sl_piece_create(const sl_mesh *mesh, const sl_triangulation *triangulation, const int32_t *face,
                          int32_t count, sl_piece **out)
{
    sl_status status = SL_OK;
    int32_t corners = 0;
    *out = NULL;
    sl_piece *piece = sl_calloc(1, sizeof *piece);
    if (piece == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t k = 0; k < count; k++) {
        corners += sl_degree(mesh, face[k]);
    }
    piece->face = sl_copy(face, count, sizeof *face);
    if (piece->face == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    SL_TRY(mesh_allocate(count, corners, &piece->mesh));
    copy_connectivity(mesh, piece);
    SL_TRY(number_vertices(mesh, piece));
    SL_TRY(copy_triangles(mesh, triangulation, piece));
    *out = piece;
    piece = NULL;
cleanup:
    sl_piece_free(piece);
    return status;
}

void sl_piece_free(sl_piece *piece)
{
    if (piece == NULL) {
        return;
    }
    sl_mesh_free(piece->mesh);
    sl_triangulation_free(piece->triangulation);
    sl_free(piece->face);
    sl_free(piece->weight);
    sl_free(piece);
}

sl_status sl_piece_weigh(sl_piece *piece, const sl_mesh *parent, const double *weight)
{
    if (weight == NULL) {
        return SL_OK;
    }
    piece->weight = sl_alloc(piece->mesh->nh, sizeof *piece->weight);
    for (int32_t h = 0; h < piece->mesh->nh && piece->weight != NULL; h++) {
        piece->weight[h] = weight[sl_piece_halfedge(piece, parent, h)];
    }
    return piece->weight == NULL ? SL_OUT_OF_MEMORY : SL_OK;
}

sl_status sl_piece_topology(const sl_piece *piece, sl_topology *out)
{
    const int32_t n = piece->mesh->nf;
    int32_t *all = sl_alloc(n, sizeof *all);
    if (all == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t f = 0; f < n; f++) {
        all[f] = f;
    }
    const sl_status status = sl_mesh_topology(piece->mesh, all, n, out);
    sl_free(all);
    return status;
}

sl_status sl_piece_patch(const sl_piece *piece, sl_patch **out)
{
    const int32_t n = piece->mesh->nf;
    int32_t *all = sl_alloc(n, sizeof *all);
    *out = NULL;
    if (all == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t f = 0; f < n; f++) {
        all[f] = f;
    }
    const sl_status status = sl_patch_extract(piece->mesh, piece->triangulation, all, n, out);
    sl_free(all);
    return status;
}

sl_status sl_patch_border_pairs(const sl_patch *patch, int32_t **vertex, int32_t *count)
{
    *count = 0;
    *vertex = sl_alloc(6 * (int64_t)patch->nt, sizeof **vertex);
    if (*vertex == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t c = 0; c < 3 * patch->nt; c++) {
        if (patch->twin[c] < 0) {
            (*vertex)[2 * *count] = patch->tri[c];
            (*vertex)[2 * *count + 1] = patch->tri[sl_corner_next(c)];
            (*count)++;
        }
    }
    return SL_OK;
}

sl_status sl_flatten_piece(const sl_piece *piece, const sl_flatten_def *def, const sl_context *context,
                           double *corner_uv, sl_flatten_result *flat)
{
    sl_status status = SL_OK;
    sl_patch *patch = NULL;
    double *uv = NULL;
    SL_TRY(sl_piece_patch(piece, &patch));
    uv = sl_alloc(2 * (int64_t)patch->nv, sizeof *uv);
    if (uv == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    SL_TRY(sl_flatten(patch, def, context, uv, flat));
    for (int32_t c = 0; c < 3 * patch->nt; c++) {
        memcpy(corner_uv + 2 * (int64_t)patch->corner[c], uv + 2 * (int64_t)patch->tri[c], 2 * sizeof *uv);
    }
cleanup:
    sl_free(uv);
    sl_patch_free(patch);
    return status;
}
