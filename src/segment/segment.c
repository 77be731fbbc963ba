/* The recursion: charts are flattened, and those that are not valid split, generation by generation. */
#include "segment/share_internal.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

/* State of a run. */
typedef struct run {
    const sl_mesh *mesh; /* untouched until the end */
    const sl_triangulation *triangulation;
    const sl_segment_def *def;
    const sl_context *context;
    sl_mesh *work;      /* a copy in which the seams are cut */
    uint8_t *first_cut; /* nh: marks of the first cuts and of axes */
    int32_t *partner;   /* nf, NULL = no pairing */
    int32_t *place;     /* nf, see sl_piece */
    double paired_fraction;
    sl_job_list pending, done;
    sl_sharing sharing;
    bool share; /* symmetries are looked for */
    sl_split *split;
    int64_t nsplit, split_capacity;
    int32_t *cut_after; /* nh, see sl_segmentation */
    int64_t facets_done;
    int32_t merges;
} run;

static void run_clear(run *r)
{
    sl_mesh_free(r->work);
    sl_free(r->first_cut);
    sl_free(r->partner);
    sl_free(r->place);
    sl_sharing_clear(&r->sharing);
    sl_free(r->split);
    sl_free(r->cut_after);
    sl_job_list_clear(&r->pending);
    sl_job_list_clear(&r->done);
}

/* Triangles are paired for the facet graph where the options, or the mesh itself, ask for it. */
static sl_status pair_facets(run *r)
{
    sl_status status = SL_OK;
    if (r->def->pairing == SL_PAIR_OFF) {
        return SL_OK;
    }
    r->partner = sl_alloc(r->mesh->nf, sizeof *r->partner);
    if (r->partner == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    SL_TRY(sl_pair_triangles(r->mesh, r->partner, &r->paired_fraction));
    if (r->def->pairing == SL_PAIR_AUTO && r->paired_fraction < SL_PAIR_AUTO_FRACTION) {
        sl_free(r->partner);
        r->partner = NULL;
    }
cleanup:
    return status;
}

/* Cuts an edge after `splits` others were made. */
static void cut_edge(run *r, int32_t h, int64_t splits)
{
    const int32_t t = r->work->twin[h];
    if (t >= 0 && r->cut_after[h] < 0) {
        r->cut_after[h] = r->cut_after[t] = (int32_t)splits;
    }
    sl_mesh_cut_edge(r->work, h);
}

/* A chart that stays: its inner cuts are made, its place in the list of results taken. */
static sl_status finish(run *r, sl_chart_job *job)
{
    for (int32_t k = 0; k < job->joined.count; k++) {
        const int32_t h = job->joined.halfedge[k];
        if (job->settled) {
            r->first_cut[h] = r->first_cut[r->work->twin[h]] = SL_CUT_AXIS;
        }
        cut_edge(r, h, r->nsplit);
    }
    r->facets_done += job->count;
    return sl_job_list_push(&r->done, job);
}

/* What a split has to do with symmetry. */
static sl_status note_symmetry(run *r, const sl_chart_job *job)
{
    sl_sharing_info *info = &r->sharing.info;
    info->axes += job->copies.count > 0;
    info->truncated |= job->truncated;
    if (job->copies.count > 0 && job->copies.kind == SL_SYMMETRY_NEAR) {
        info->near_axes++;
        info->deviation = fmax(info->deviation, job->misfit);
    }
    if (job->split.symmetry == SL_SPLIT_PLANE) {
        info->planes++;
        info->misfit = fmax(info->misfit, job->misfit);
    }
    return job->copies.count > 0 ? sl_sharing_add(&r->sharing, r->mesh, &job->copies) : SL_OK;
}

/* A chart that is split: its seam is cut, its parts wait for the next generation. */
static sl_status descend(run *r, sl_chart_job *job, sl_job_list *next)
{
    const bool stays = job->split.symmetry != SL_SPLIT_PLAIN || job->split.optimised;
    const uint8_t mark = stays ? SL_CUT_AXIS : job->depth == 0 ? SL_CUT_FIRST : 0;
    sl_status status = sl_reserve((void **)&r->split, &r->split_capacity, r->nsplit + 1, sizeof *r->split);
    if (status != SL_OK) {
        return status;
    }
    r->split[r->nsplit++] = job->split;
    status = note_symmetry(r, job);
    if (status != SL_OK) {
        return status;
    }
    for (int32_t k = 0; k < job->seam.count; k++) {
        const int32_t h = job->seam.halfedge[k];
        if (mark != 0) {
            r->first_cut[h] = r->first_cut[r->work->twin[h]] = mark;
        }
        cut_edge(r, h, r->nsplit - 1);
    }
    for (int32_t k = 0; k < job->nfinished; k++) {
        status = finish(r, &job->finished[k]);
        if (status != SL_OK) {
            return status;
        }
    }
    return job->nfinished > 0 ? SL_OK : sl_part_jobs(job, next);
}

/* A chart that may not be split after all. One that was to be cut at its axis has not been flattened yet. */
static sl_status keep_whole(run *r, sl_chart_job *job)
{
    if (job->corner_uv == NULL) {
        sl_chart_job again = {.face = job->face, .count = job->count, .depth = job->depth};
        const sl_recursion flatten = {.mesh = r->mesh, .triangulation = r->triangulation, .def = r->def};
        job->face = NULL;
        sl_chart_job_clear(job);
        *job = again;
        sl_chart_job_run(&flatten, job);
    }
    job->done = job->capped = true;
    return job->status;
}

/* Deals with a generation's outcomes in order. The cap counts charts that are done, and those that are still to come.
 */
static sl_status harvest(run *r)
{
    sl_status status = SL_OK;
    sl_job_list next = {0};
    int64_t charts = r->done.count + r->pending.count;
    for (int64_t k = 0; k < r->pending.count; k++) {
        sl_chart_job *job = &r->pending.job[k];
        if (!job->done && charts + job->nparts - 1 > r->def->max_charts) {
            SL_TRY(keep_whole(r, job));
        }
        if (job->done) {
            SL_TRY(finish(r, job));
        } else {
            charts += job->nparts - 1;
            SL_TRY(descend(r, job, &next));
        }
    }
    sl_job_list_clear(&r->pending);
    r->pending = next;
    next = (sl_job_list){0};
cleanup:
    sl_job_list_clear(&next);
    return status;
}

static sl_status recurse(run *r)
{
    sl_status status = SL_OK;
    while (r->pending.count > 0) {
        const sl_recursion recursion = {.mesh = r->mesh,
                                        .triangulation = r->triangulation,
                                        .def = r->def,
                                        .partner = r->partner,
                                        .share = r->share,
                                        .place = r->place,
                                        .may_split = r->done.count + r->pending.count < r->def->max_charts};
        SL_TRY(sl_report_progress(r->context, "segment", (double)r->facets_done / r->mesh->nf));
        SL_TRY(sl_run_jobs(&recursion, r->context, sl_chart_job_run, &r->pending));
        SL_TRY(harvest(r));
    }
cleanup:
    return status;
}

/* Components that copy others need no charts; the rest is cut, along axes of symmetry where there are some. */
static sl_status segment_components(run *r)
{
    sl_status status = SL_OK;
    r->share = r->def->symmetry != SL_SYMMETRY_USE_OFF;
    SL_TRY(sl_component_jobs(r->mesh, &r->pending));
    if (r->share && !r->def->test_halves) {
        SL_TRY(sl_share_components(r->mesh, r->partner, r->def, r->context, &r->pending, &r->sharing));
    }
    SL_TRY(recurse(r));
cleanup:
    return status;
}

/* The minimisation of stretch stopped at the bound while charts could still be split: now it goes to its end, for the
 * charts from number `first` on. */
static sl_status polish(run *r, int64_t first)
{
    const sl_recursion recursion = {.mesh = r->work, .triangulation = r->triangulation, .def = r->def};
    sl_job_list charts = {.job = r->done.job + first, .count = r->done.count - first};
    sl_status status = sl_report_progress(r->context, "relax", 0.0);
    return status != SL_OK ? status : sl_run_jobs(&recursion, r->context, sl_chart_job_polish, &charts);
}

/* Images of the charts become charts; those that do not hold on their own geometry are laid flat themselves. */
static sl_status resolve_copies(run *r)
{
    sl_status status = SL_OK;
    const sl_recursion recursion = {.mesh = r->work, .triangulation = r->triangulation, .def = r->def};
    SL_TRY(sl_sharing_resolve(&r->sharing, &recursion, r->mesh, r->work, r->context, &r->done, &r->pending));
    if (r->pending.count > 0) {
        const int64_t first = r->done.count;
        r->share = false;
        SL_TRY(recurse(r));
        SL_TRY(polish(r, first));
    }
cleanup:
    return status;
}

static sl_status run_create(sl_mesh *mesh, const sl_triangulation *triangulation, const sl_segment_def *def,
                            const sl_context *context, run *r)
{
    *r = (run){.mesh = mesh, .triangulation = triangulation, .def = def, .context = context};
    r->first_cut = sl_calloc(mesh->nh, sizeof *r->first_cut);
    r->place = sl_alloc(mesh->nf, sizeof *r->place);
    r->cut_after = sl_alloc(mesh->nh, sizeof *r->cut_after);
    if (r->first_cut == NULL || r->place == NULL || r->cut_after == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    memset(r->place, -1, (size_t)mesh->nf * sizeof *r->place);
    memset(r->cut_after, -1, (size_t)mesh->nh * sizeof *r->cut_after);
    return sl_mesh_copy(mesh, &r->work);
}

/* Hands the result over; from here on nothing fails. */
static sl_status deliver(run *r, sl_mesh *mesh, sl_segmentation **out)
{
    const sl_status status = sl_segmentation_assemble(mesh, &r->done, out);
    if (status != SL_OK) {
        return status;
    }
    memcpy(mesh->twin, r->work->twin, (size_t)mesh->nh * sizeof *mesh->twin);
    memcpy(mesh->sew, r->work->sew, (size_t)mesh->nh * sizeof *mesh->sew);
    (*out)->split = r->split;
    (*out)->nsplit = (int32_t)r->nsplit;
    r->split = NULL;
    (*out)->cut_after = r->cut_after;
    r->cut_after = NULL;
    (*out)->merges = r->merges;
    (*out)->sharing = r->sharing.info;
    if (r->sharing.info.copies > 0) {
        (*out)->source = r->sharing.from;
        r->sharing.from = NULL;
    }
    (*out)->paired = r->partner != NULL;
    (*out)->paired_fraction = r->paired_fraction;
    return SL_OK;
}

/**
 * Segments a mesh into charts by recursive spectral cuts, and flattens them.
 *
 * A component that copies another is set aside, one with a mirror symmetry cut along its axis, and one half set aside;
 * their UVs are taken over at the end. Each other component is flattened as a whole; what is not valid is split along a
 * spectral cut, and so on with the connected parts. The charts of one generation run in parallel. Every split makes
 * parts of fewer facets, and a single facet is never split, so the recursion ends.
 *
 * @param[in,out] mesh           its seams are cut where SL_OK is returned; otherwise it is as it was
 * @param[in]     triangulation  of the mesh
 * @param[in]     def
 * @param[in]     context        nullable
 * @param[out]    out            owned by the caller; NULL on failure
 *
 * SL_OUT_OF_MEMORY, SL_CANCELLED, SL_INTERNAL. Same bytes for any number of threads.
 * Source: Sec. 3.3, 4.3.  Deviations: validity bounds the stretch; the rules, smoothing, joining and sewing are
 * options; axes come from a search for automorphisms instead of from the cuts (def->test_halves: from the cuts).
 */
sl_status sl_segment(sl_mesh *mesh, const sl_triangulation *triangulation, const sl_segment_def *def,
                     const sl_context *context, sl_segmentation **out)
{
    sl_status status = SL_OK;
    run r;
    *out = NULL;
    SL_TRY(run_create(mesh, triangulation, def, context, &r));
    SL_TRY(pair_facets(&r));
    SL_TRY(segment_components(&r));
    if (def->sew) {
        SL_TRY(sl_sew_charts(r.work, mesh, triangulation, r.first_cut, def, context, &r.done, &r.merges));
    }
    SL_TRY(polish(&r, 0));
    SL_TRY(resolve_copies(&r));
    SL_TRY(deliver(&r, mesh, out));
cleanup:
    run_clear(&r);
    return status;
}

/**
 * Flattens the charts that the caller's own seams make.
 *
 * @param[in,out] mesh           only loops are cut, where def->join says so; as it was on failure
 * @param[in]     triangulation  of the mesh
 * @param[in]     def            join and flatten are used
 * @param[in]     context        nullable
 * @param[out]    out            owned by the caller; NULL on failure
 *
 * Charts that are no disk or not valid are kept with their verdict, and not marked as capped.
 * SL_OUT_OF_MEMORY, SL_CANCELLED, SL_INTERNAL. Same bytes for any number of threads.
 */
sl_status sl_flatten_charts(sl_mesh *mesh, const sl_triangulation *triangulation, const sl_segment_def *def,
                            const sl_context *context, sl_segmentation **out)
{
    sl_status status = SL_OK;
    run r;
    *out = NULL;
    SL_TRY(run_create(mesh, triangulation, def, context, &r));
    SL_TRY(sl_component_jobs(mesh, &r.pending));
    const sl_recursion recursion = {.mesh = mesh, .triangulation = triangulation, .def = def, .may_split = false};
    SL_TRY(sl_report_progress(context, "flatten", 0.0));
    SL_TRY(sl_run_jobs(&recursion, context, sl_chart_job_run, &r.pending));
    for (int64_t k = 0; k < r.pending.count; k++) {
        r.pending.job[k].capped = false;
        SL_TRY(finish(&r, &r.pending.job[k]));
    }
    SL_TRY(polish(&r, 0));
    SL_TRY(deliver(&r, mesh, out));
cleanup:
    run_clear(&r);
    return status;
}
