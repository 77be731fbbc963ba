#include "atlas/atlas_internal.h"

#include "base/memory.h"
#include "meshio/meshfile.h"
#include "overlap/certificate.h"
#include "param/open.h"

#include <string.h>

/* Texel counts know 8 bits below a texel: what is nearer than a step of the usual 2048 x 2048 page may count as met. */
static const double STEP = 0x1p-19;
static const double OPENING = 0x1p-17; /* how far a border vertex moves inwards then */

typedef struct clearance_job {
    sl_atlas *atlas;
    sl_status *status; /* nchart */
} clearance_job;

/* Page UVs of the patch's vertices. */
static void gather(const sl_atlas *atlas, const sl_patch *patch, double *uv)
{
    for (int32_t k = 0; k < 3 * patch->nt; k++) {
        memcpy(uv + 2 * (int64_t)patch->tri[k], atlas->corner_uv + 2 * (int64_t)patch->corner[k], 2 * sizeof *uv);
    }
}

static void scatter(const sl_patch *patch, const double *uv, sl_atlas *atlas)
{
    for (int32_t k = 0; k < 3 * patch->nt; k++) {
        const int32_t h = patch->corner[k];
        const double *from = uv + 2 * (int64_t)patch->tri[k];
        memcpy(atlas->corner_uv + 2 * (int64_t)h, from, 2 * sizeof *from);
        memcpy(atlas->input_corner_uv + 2 * (int64_t)sl_input_corner(atlas->mesh, h), from, 2 * sizeof *from);
    }
}

/* The border of a patch of one loop as vertex pairs in order; *pair is owned by the caller. */
static sl_status border_in_order(const sl_patch *patch, int32_t **pair, int32_t *count)
{
    int32_t *first = NULL, *halfedge = NULL;
    sl_status status = SL_OK;
    SL_TRY(sl_patch_border(patch, &first, &halfedge));
    *count = first[patch->loops];
    *pair = sl_alloc(*count, 2 * sizeof **pair);
    SL_TRY(*pair != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t b = 0; b < *count; b++) {
        (*pair)[2 * (int64_t)b] = patch->tri[halfedge[b]];
        (*pair)[2 * (int64_t)b + 1] = patch->tri[sl_corner_next(halfedge[b])];
    }
cleanup:
    sl_free(first);
    sl_free(halfedge);
    return status;
}

static sl_status clear_chart(sl_atlas *atlas, int32_t c)
{
    const sl_chart *chart = &atlas->segmentation->chart[c];
    sl_patch *patch = NULL;
    sl_certificate after;
    double *uv = NULL, *opened = NULL, *work = NULL;
    int32_t *border = NULL, nb = 0;
    bool survives;
    sl_status status = SL_OK;
    SL_TRY(sl_patch_extract(atlas->mesh, atlas->triangulation, atlas->segmentation->face + chart->first, chart->count,
                            &patch));
    if (!sl_patch_is_disk(patch)) {
        goto cleanup;
    }
    uv = sl_alloc(patch->nv, 2 * sizeof *uv);
    opened = sl_alloc(patch->nv, 2 * sizeof *opened);
    work = sl_alloc(patch->nv, 2 * sizeof *work);
    if (uv == NULL || opened == NULL || work == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    gather(atlas, patch, uv);
    SL_TRY(border_in_order(patch, &border, &nb));
    SL_TRY(sl_border_survives(patch->nv, nb, border, uv, STEP, work, &survives));
    if (survives) {
        goto cleanup;
    }
    sl_open_border(patch, nb, border, uv, 0.0, OPENING, work, opened);
    for (int64_t i = 0; i < 2 * (int64_t)patch->nv; i++) {
        opened[i] = sl_uv_quantise(opened[i]);
    }
    SL_TRY(sl_certify_embedding(opened, patch->nt, patch->tri, nb, border, &after));
    if (after.embedded) {
        scatter(patch, opened, atlas);
    }
cleanup:
    sl_patch_free(patch);
    sl_free(uv);
    sl_free(opened);
    sl_free(work);
    sl_free(border);
    return status;
}

static void clear_chunk(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    (void)chunk;
    const clearance_job *job = user;
    for (int64_t c = begin; c < end; c++) {
        if (job->atlas->segmentation->chart[c].copy_of < 0) {
            job->status[c] = clear_chart(job->atlas, (int32_t)c);
        }
    }
}

/* Copies go where their sources went. */
static void follow_sources(sl_atlas *atlas)
{
    const int32_t *source = atlas->segmentation->source;
    for (int32_t h = 0; source != NULL && h < atlas->mesh->nh; h++) {
        if (source[h] >= 0) {
            const double *from = atlas->corner_uv + 2 * (int64_t)source[h];
            memcpy(atlas->corner_uv + 2 * (int64_t)h, from, 2 * sizeof *from);
            memcpy(atlas->input_corner_uv + 2 * (int64_t)sl_input_corner(atlas->mesh, h), from, 2 * sizeof *from);
        }
    }
}

sl_status sl_atlas_clear_borders(sl_atlas *atlas, const sl_context *context)
{
    const int32_t n = atlas->segmentation->nchart;
    clearance_job job = {atlas, sl_calloc(n, sizeof *job.status)};
    sl_status status = job.status != NULL ? SL_OK : SL_OUT_OF_MEMORY;
    SL_TRY(status);
    sl_parallel_for(context, n, 1, clear_chunk, &job);
    for (int32_t c = 0; c < n; c++) {
        SL_TRY(job.status[c]);
    }
    follow_sources(atlas);
cleanup:
    sl_free(job.status);
    return status;
}
