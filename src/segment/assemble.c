/* From finished charts to the segmentation that the caller gets. */
#include "segment/segment_internal.h"

#include "base/memory.h"

#include <stdlib.h>
#include <string.h>

static int by_first_facet(const void *a, const void *b)
{
    const int32_t x = ((const sl_chart_job *)a)->face[0], y = ((const sl_chart_job *)b)->face[0];
    return (x > y) - (x < y);
}

static void take_chart(const sl_mesh *mesh, const sl_chart_job *job, int32_t number, int32_t first, sl_segmentation *s)
{
    s->chart[number] = (sl_chart){.first = first,
                                  .count = job->count,
                                  .topology = job->topology,
                                  .flat = job->flat,
                                  .capped = job->capped,
                                  .copy_of = -1,
                                  .mirrored = job->mirrored,
                                  .kind = job->kind};
    const double *uv = job->corner_uv;
    for (int32_t k = 0; k < job->count; k++) {
        const int32_t f = job->face[k], h = mesh->face_first[f];
        s->face[first + k] = f;
        s->face_chart[f] = number;
        memcpy(s->corner_uv + 2 * (int64_t)h, uv, 2 * (size_t)sl_degree(mesh, f) * sizeof *uv);
        uv += 2 * sl_degree(mesh, f);
    }
}

sl_status sl_segmentation_assemble(const sl_mesh *mesh, sl_job_list *charts, sl_segmentation **out)
{
    sl_segmentation *s = sl_calloc(1, sizeof *s);
    *out = NULL;
    if (s == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    s->nchart = (int32_t)charts->count;
    s->chart = sl_calloc(s->nchart, sizeof *s->chart);
    s->face = sl_alloc(mesh->nf, sizeof *s->face);
    s->face_chart = sl_alloc(mesh->nf, sizeof *s->face_chart);
    s->corner_uv = sl_calloc(2 * (int64_t)mesh->nh, sizeof *s->corner_uv);
    if (s->chart == NULL || s->face == NULL || s->face_chart == NULL || s->corner_uv == NULL) {
        sl_segmentation_free(s);
        return SL_OUT_OF_MEMORY;
    }
    if (charts->count > 1) {
        qsort(charts->job, (size_t)charts->count, sizeof *charts->job, by_first_facet);
    }
    int32_t first = 0;
    for (int32_t k = 0; k < s->nchart; k++) {
        take_chart(mesh, &charts->job[k], k, first, s);
        first += charts->job[k].count;
    }
    for (int32_t k = 0; k < s->nchart; k++) {
        if (charts->job[k].copy) {
            s->chart[k].copy_of = s->face_chart[charts->job[k].source_face];
        }
    }
    *out = s;
    return SL_OK;
}

void sl_segmentation_free(sl_segmentation *segmentation)
{
    if (segmentation == NULL) {
        return;
    }
    sl_free(segmentation->chart);
    sl_free(segmentation->face);
    sl_free(segmentation->face_chart);
    sl_free(segmentation->corner_uv);
    sl_free(segmentation->source);
    sl_free(segmentation->split);
    sl_free(segmentation->cut_after);
    sl_free(segmentation);
}
