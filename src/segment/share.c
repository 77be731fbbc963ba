/* What copies what: links between corners over a run, and components that are copies of one another. */
#include "segment/share_internal.h"

#include "base/memory.h"

#include <string.h>

enum { LEAST_FACETS = 2 }; /* of a component that may be a copy: that one facet equals another says nothing */

void sl_sharing_clear(sl_sharing *sharing)
{
    sl_free(sharing->from);
    sl_free(sharing->reverses);
    sl_free(sharing->near);
    *sharing = (sl_sharing){0};
}

static sl_status make_room(sl_sharing *sharing, const sl_mesh *mesh)
{
    if (sharing->from != NULL) {
        return SL_OK;
    }
    sharing->from = sl_alloc(mesh->nh, sizeof *sharing->from);
    sharing->reverses = sl_calloc(mesh->nf, sizeof *sharing->reverses);
    sharing->near = sl_calloc(mesh->nf, sizeof *sharing->near);
    if (sharing->from == NULL || sharing->reverses == NULL || sharing->near == NULL) {
        sl_sharing_clear(sharing);
        return SL_OUT_OF_MEMORY;
    }
    memset(sharing->from, 0xff, (size_t)mesh->nh * sizeof *sharing->from);
    return SL_OK;
}

sl_status sl_sharing_add(sl_sharing *sharing, const sl_mesh *mesh, const sl_copy_list *copies)
{
    const sl_sharing_info info = sharing->info;
    const sl_status status = make_room(sharing, mesh);
    sharing->info = info;
    for (int32_t k = 0; status == SL_OK && k < copies->count; k++) {
        const int32_t c = copies->corner[k];
        sharing->from[c] = copies->from[k];
        sharing->reverses[mesh->face[c]] = copies->reverses;
        sharing->near[mesh->face[c]] = copies->kind == SL_SYMMETRY_NEAR;
    }
    return status;
}

/* The corner at the same place as c on the other side of the edge between partners, -1 = c is not on it. */
static int32_t across_the_diagonal(const sl_mesh *mesh, const int32_t *partner, int32_t c)
{
    const int32_t f = mesh->face[c], before = sl_prev(mesh, c);
    if (mesh->twin[c] >= 0 && mesh->face[mesh->twin[c]] == partner[f]) {
        return sl_next(mesh, mesh->twin[c]);
    }
    if (mesh->twin[before] >= 0 && mesh->face[mesh->twin[before]] == partner[f]) {
        return mesh->twin[before];
    }
    return -1;
}

/* Where diagonals of paired triangles run differently, some corners of a copy are no corner's image: they take what the
 * corner at the same place in their quad takes. false: there is one without any. */
static bool fill_gaps(const sl_mesh *mesh, const int32_t *partner, const sl_symmetry *symmetry, int32_t component,
                      int32_t *from)
{
    for (int32_t i = symmetry->first[component]; i < symmetry->first[component + 1]; i++) {
        const int32_t f = symmetry->face[i];
        for (int32_t c = mesh->face_first[f]; c < mesh->face_first[f + 1]; c++) {
            if (from[c] < 0 && partner != NULL && partner[f] >= 0) {
                const int32_t same = across_the_diagonal(mesh, partner, c);
                from[c] = same >= 0 ? from[same] : -1;
            }
            if (from[c] < 0) {
                return false;
            }
        }
    }
    return true;
}

/* The map original -> copy as a list of what the copy's corners take. from: scratch, nh, all -1 before and after. */
static sl_status list_component(const sl_mesh *mesh, const int32_t *partner, const sl_symmetry *symmetry,
                                const sl_symmetry_map *map, int32_t *from, sl_copy_list *copies, bool *complete)
{
    const int32_t *face = symmetry->face + symmetry->first[map->from];
    for (int32_t i = 0, k = 0; i < map->count; i++) {
        for (int32_t h = mesh->face_first[face[i]]; h < mesh->face_first[face[i] + 1]; h++) {
            from[map->corner[k++]] = h;
        }
    }
    *complete = fill_gaps(mesh, partner, symmetry, map->to, from);
    int32_t corners = 0;
    for (int32_t i = symmetry->first[map->to]; i < symmetry->first[map->to + 1]; i++) {
        corners += sl_degree(mesh, symmetry->face[i]);
    }
    *copies = (sl_copy_list){.corner = sl_alloc(corners, sizeof *copies->corner),
                             .from = sl_alloc(corners, sizeof *copies->from),
                             .reverses = map->reverses,
                             .kind = map->kind};
    for (int32_t i = symmetry->first[map->to]; i < symmetry->first[map->to + 1]; i++) {
        const int32_t f = symmetry->face[i];
        for (int32_t c = mesh->face_first[f]; c < mesh->face_first[f + 1]; c++) {
            if (copies->corner != NULL && copies->from != NULL) {
                copies->corner[copies->count] = c;
                copies->from[copies->count++] = from[c];
            }
            from[c] = -1;
        }
    }
    return copies->corner != NULL && copies->from != NULL ? SL_OK : SL_OUT_OF_MEMORY;
}

static bool may_copy(const sl_mesh *mesh, const sl_symmetry *symmetry, const sl_symmetry_map *map)
{
    const int32_t first = symmetry->face[symmetry->first[map->to]];
    return map->from != map->to && map->kind == SL_SYMMETRY_EXACT && map->count >= LEAST_FACETS &&
           (mesh->face_flags[first] & SL_FACE_DEGENERATE) == 0;
}

/* Takes the jobs of components that copy out of the list. */
static void drop_jobs(const sl_symmetry *symmetry, const uint8_t *copies, sl_job_list *jobs)
{
    int64_t kept = 0;
    for (int64_t k = 0; k < jobs->count; k++) {
        sl_chart_job job = jobs->job[k];
        jobs->job[k] = (sl_chart_job){0};
        if (copies[symmetry->component[job.face[0]]]) {
            sl_chart_job_clear(&job);
        } else {
            jobs->job[kept++] = job;
        }
    }
    jobs->count = kept;
}

sl_status sl_share_components(const sl_mesh *mesh, const int32_t *partner, const sl_segment_def *def,
                              const sl_context *context, sl_job_list *jobs, sl_sharing *sharing)
{
    sl_status status = SL_OK;
    sl_symmetry *symmetry = NULL;
    uint8_t *copied = NULL;
    int32_t *from = NULL;
    sl_copy_list copies = {0};
    sl_symmetry_def find = sl_symmetry_default();
    find.mirrors_only = true;
    if (def->symmetry == SL_SYMMETRY_USE_OFF || jobs->count < 2) {
        return SL_OK;
    }
    SL_TRY(sl_symmetry_find(mesh, partner, &find, context, &symmetry));
    copied = sl_calloc(symmetry->components, sizeof *copied);
    from = sl_alloc(mesh->nh, sizeof *from);
    if (copied == NULL || from == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    memset(from, 0xff, (size_t)mesh->nh * sizeof *from);
    for (int32_t k = 0; k < symmetry->nmap; k++) {
        const sl_symmetry_map *map = &symmetry->map[k];
        bool complete = false;
        if (!may_copy(mesh, symmetry, map) || copied[map->to] || copied[map->from]) {
            continue;
        }
        sl_copy_list_clear(&copies);
        SL_TRY(list_component(mesh, partner, symmetry, map, from, &copies, &complete));
        if (complete) {
            SL_TRY(sl_sharing_add(sharing, mesh, &copies));
            copied[map->to] = 1;
            sharing->info.components++;
        }
    }
    drop_jobs(symmetry, copied, jobs);
cleanup:
    sl_copy_list_clear(&copies);
    sl_symmetry_free(symmetry);
    sl_free(copied);
    sl_free(from);
    return status;
}
