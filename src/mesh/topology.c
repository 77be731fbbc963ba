#include "mesh/topology.h"

#include "base/memory.h"
#include "mesh/corner_table_internal.h"
#include "mesh/face_map_internal.h"

sl_status sl_mesh_components(const sl_mesh *mesh, int32_t *label, int32_t *count)
{
    int32_t *queue = sl_alloc(mesh->nf, sizeof *queue), n = 0;
    if (queue == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t f = 0; f < mesh->nf; f++) {
        label[f] = -1;
    }
    for (int32_t seed = 0; seed < mesh->nf; seed++) {
        if (label[seed] >= 0) {
            continue;
        }
        int32_t begin = 0, end = 0;
        queue[end++] = seed;
        label[seed] = n++;
        while (begin < end) {
            const int32_t f = queue[begin++];
            for (int32_t h = mesh->face_first[f]; h < mesh->face_first[f + 1]; h++) {
                const int32_t g = mesh->twin[h] >= 0 ? mesh->face[mesh->twin[h]] : f;
                if (label[g] < 0) {
                    label[g] = label[f];
                    queue[end++] = g;
                }
            }
        }
    }
    *count = n;
    sl_free(queue);
    return SL_OK;
}

/* A set of facets cut out of its mesh: corners and facets numbered anew in the set's order. Owned arrays. */
typedef struct cutout {
    int32_t nf, nh;
    int32_t *first, *face, *twin;
} cutout;

static void clear_cutout(cutout *c)
{
    sl_free(c->first);
    sl_free(c->face);
    sl_free(c->twin);
}

/* New number of mesh halfedge t, -1 for none or one outside the set. */
static int32_t local_halfedge(const sl_mesh *mesh, const sl_face_map *map, const int32_t *first, int32_t t)
{
    if (t < 0) {
        return -1;
    }
    const int32_t f = mesh->face[t], i = sl_face_map_find(map, f);
    return i >= 0 ? first[i] + (t - mesh->face_first[f]) : -1;
}

static sl_status cut_out(const sl_mesh *mesh, const int32_t *faces, int32_t nfaces, cutout *c)
{
    sl_status status = SL_OK;
    sl_face_map map = {0};
    c->nf = nfaces;
    c->first = sl_alloc((int64_t)nfaces + 1, sizeof *c->first);
    SL_TRY(c->first != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    c->first[0] = 0;
    for (int32_t i = 0; i < nfaces; i++) {
        c->first[i + 1] = c->first[i] + sl_degree(mesh, faces[i]);
    }
    c->nh = c->first[nfaces];
    c->face = sl_alloc(c->nh, sizeof *c->face);
    c->twin = sl_alloc(c->nh, sizeof *c->twin);
    SL_TRY(c->face != NULL && c->twin != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(sl_face_map_init(mesh->nf, faces, nfaces, &map));
    for (int32_t i = 0; i < nfaces; i++) {
        for (int32_t h = c->first[i]; h < c->first[i + 1]; h++) {
            c->face[h] = i;
            c->twin[h] = local_halfedge(mesh, &map, c->first, mesh->twin[mesh->face_first[faces[i]] + h - c->first[i]]);
        }
    }
cleanup:
    sl_face_map_clear(&map);
    return status;
}

sl_status sl_mesh_topology(const sl_mesh *mesh, const int32_t *faces, int32_t nfaces, sl_topology *out)
{
    sl_status status = SL_OK;
    int32_t *fan = NULL;
    uint8_t *seen = NULL;
    cutout c = {0};
    SL_TRY(cut_out(mesh, faces, nfaces, &c));
    fan = sl_alloc(c.nh, sizeof *fan);
    seen = sl_calloc(c.nh, sizeof *seen);
    SL_TRY(fan != NULL && seen != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    const sl_corner_table table = {c.nf, c.nh, c.first, c.face, c.twin};
    sl_topology t = {.faces = nfaces, .vertices = sl_table_label_fans(&table, fan)};
    for (int32_t h = 0; h < c.nh; h++) {
        t.edges += c.twin[h] < h; /* borders, and each inner edge once */
    }
    t.loops = sl_table_count_loops(&table, seen);
    t.euler = t.vertices - t.edges + t.faces;
    t.genus = (2 - t.loops - t.euler) / 2;
    *out = t;
cleanup:
    clear_cutout(&c);
    sl_free(fan);
    sl_free(seen);
    return status;
}
