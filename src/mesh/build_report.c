#include "base/memory.h"
#include "mesh/build_internal.h"
#include "mesh/corner_table_internal.h"

/* The facets with a flag set, ascending. */
static sl_status list_facets(const sl_mesh *m, uint8_t flag, int32_t **list, int32_t *count)
{
    int32_t n = 0;
    for (int32_t f = 0; f < m->nf; f++) {
        n += (m->face_flags[f] & flag) != 0;
    }
    int32_t *facets = sl_alloc(n, sizeof *facets);
    if (facets == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    *count = n;
    *list = facets;
    for (int32_t f = 0; f < m->nf; f++) {
        if ((m->face_flags[f] & flag) != 0) {
            *facets++ = f;
        }
    }
    return SL_OK;
}

/* Border loops and genus of the surface: V - E + F = sum over the components of 2 - 2 genus - loops. */
static sl_status count_topology(sl_builder *b)
{
    const sl_mesh *m = b->mesh;
    sl_repair_report *r = b->report;
    const sl_corner_table table = {m->nf, m->nh, m->face_first, m->face, m->twin};
    uint8_t *seen = sl_calloc(m->nh, sizeof *seen);
    if (seen == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    int64_t glued = 0, border = 0, faces = 0;
    for (int32_t h = 0; h < m->nh; h++) {
        seen[h] = sl_build_isolated(m, m->face[h]);
        glued += seen[h] == 0 && m->twin[h] >= 0;
        border += seen[h] == 0 && m->twin[h] < 0;
    }
    for (int32_t f = 0; f < m->nf; f++) {
        faces += !sl_build_isolated(m, f);
    }
    r->border_loops = sl_table_count_loops(&table, seen);
    const int64_t euler = b->surface_vertices - (glued / 2 + border) + faces;
    r->genus = (2 * (int64_t)r->components - r->border_loops - euler) / 2;
    sl_free(seen);
    return SL_OK;
}

sl_status sl_build_summarise(sl_builder *b)
{
    sl_status status = SL_OK;
    const sl_mesh *m = b->mesh;
    sl_repair_report *r = b->report;
    SL_TRY(count_topology(b));
    SL_TRY(list_facets(m, SL_FACE_REVERSED, &r->reversed, &r->reversed_faces));
    SL_TRY(list_facets(m, SL_FACE_DUPLICATE, &r->duplicate, &r->duplicate_faces));
    SL_TRY(list_facets(m, SL_FACE_DEGENERATE, &r->degenerate, &r->degenerate_faces));
    r->isolated_faces = r->duplicate_faces + r->degenerate_faces;
    for (int32_t f = 0; f < m->nf; f++) {
        r->triangles += sl_degree(m, f) == 3;
        r->quads += sl_degree(m, f) == 4;
        r->ngons += sl_degree(m, f) > 4;
    }
    if (r->nonmanifold == NULL) {
        r->nonmanifold = sl_alloc(0, sizeof *r->nonmanifold);
        status = r->nonmanifold != NULL ? SL_OK : SL_OUT_OF_MEMORY;
    }
cleanup:
    return status;
}
