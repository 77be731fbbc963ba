/* Lists of charts, run in parallel. */
#include "segment/segment_internal.h"

#include "base/memory.h"

sl_status sl_job_list_push(sl_job_list *list, sl_chart_job *job)
{
    const sl_status status = sl_reserve((void **)&list->job, &list->capacity, list->count + 1, sizeof *list->job);
    if (status == SL_OK) {
        list->job[list->count++] = *job;
        *job = (sl_chart_job){0};
    }
    return status;
}

void sl_job_list_clear(sl_job_list *list)
{
    for (int64_t k = 0; k < list->count; k++) {
        sl_chart_job_clear(&list->job[k]);
    }
    sl_free(list->job);
    *list = (sl_job_list){0};
}

/* Distributes facets by label into new jobs of one depth. label: count numbers below nparts; -1 = none. */
static sl_status push_parts(const int32_t *face, const int32_t *label, int32_t count, int32_t nparts, int32_t depth,
                            sl_job_list *list)
{
    sl_status status = SL_OK;
    const int64_t start = list->count;
    int32_t *size = sl_calloc(nparts, sizeof *size);
    if (size == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t k = 0; k < count; k++) {
        if (label[k] >= 0) {
            size[label[k]]++;
        }
    }
    for (int32_t p = 0; p < nparts; p++) {
        sl_chart_job job = {.face = sl_alloc(size[p], sizeof *job.face), .depth = depth};
        status = job.face == NULL ? SL_OUT_OF_MEMORY : sl_job_list_push(list, &job);
        if (status != SL_OK) {
            sl_chart_job_clear(&job);
            goto cleanup;
        }
    }
    for (int32_t k = 0; k < count; k++) {
        if (label[k] >= 0) {
            sl_chart_job *job = &list->job[start + label[k]];
            job->face[job->count++] = face != NULL ? face[k] : k;
        }
    }
cleanup:
    sl_free(size);
    return status;
}

/* Nothing but an axis has cut these. */
static void mark_whole(sl_job_list *list, int64_t start)
{
    for (int64_t k = start; k < list->count; k++) {
        list->job[k].whole = true;
    }
}

sl_status sl_component_jobs(const sl_mesh *mesh, sl_job_list *list)
{
    int32_t parts = 0;
    int32_t *label = sl_alloc(mesh->nf, sizeof *label);
    if (label == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    sl_status status = sl_mesh_components(mesh, label, &parts);
    if (status == SL_OK) {
        const int64_t start = list->count;
        status = push_parts(NULL, label, mesh->nf, parts, 0, list);
        mark_whole(list, start);
    }
    sl_free(label);
    return status;
}

sl_status sl_part_jobs(const sl_chart_job *job, sl_job_list *list)
{
    const int64_t start = list->count;
    const sl_status status = push_parts(job->face, job->part, job->count, job->nparts, job->depth + 1, list);
    if (job->split.symmetry == SL_SPLIT_MIRROR || job->split.symmetry == SL_SPLIT_PLANE) {
        mark_whole(list, start);
    }
    return status;
}

typedef struct job_range {
    const sl_recursion *recursion;
    sl_job_fn *fn;
    sl_chart_job *job;
} job_range;

static void run_range(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    (void)chunk;
    const job_range *range = user;
    for (int64_t k = begin; k < end; k++) {
        range->fn(range->recursion, &range->job[k]);
    }
}

sl_status sl_run_jobs(const sl_recursion *recursion, const sl_context *context, sl_job_fn *fn, sl_job_list *list)
{
    const sl_context quiet = sl_quiet_context(context); /* progress: calling thread only */
    sl_recursion r = *recursion;
    r.context = list->count == 1 ? context : &quiet;
    job_range range = {&r, fn, list->job};
    sl_parallel_for(context, list->count, 1, run_range, &range);
    for (int64_t k = 0; k < list->count; k++) {
        if (list->job[k].status != SL_OK) {
            return list->job[k].status;
        }
    }
    return SL_OK;
}
