/* Charts that are copies: when all others are done, their images become charts, each judged on its own geometry. */
#include "segment/share_internal.h"

#include "base/memory.h"

#include <string.h>

/* What the images are made from. */
typedef struct images {
    sl_sharing *sharing;
    const sl_recursion *recursion;
    const sl_mesh *mesh;
    sl_mesh *work;
    sl_job_list *done;
    int32_t *owner;    /* nf: done chart whose UVs a facet has, -1 = it is an image of several or of none */
    uint8_t *mirrored; /* nf */
    uint8_t *near;     /* nf */
    double *uv;        /* nh x 2 */
    int32_t *label;    /* nf: components of work */
    sl_job_list made;
} images;

static void images_clear(images *s)
{
    sl_free(s->owner);
    sl_free(s->mirrored);
    sl_free(s->near);
    sl_free(s->uv);
    sl_free(s->label);
    sl_job_list_clear(&s->made);
}

static bool is_copy(const images *s, int32_t f)
{
    return s->sharing->from[s->mesh->face_first[f]] >= 0;
}

/* UVs of the facets that have charts. */
static void take_uvs(images *s)
{
    for (int64_t k = 0; k < s->done->count; k++) {
        const sl_chart_job *job = &s->done->job[k];
        const double *uv = job->corner_uv;
        for (int32_t i = 0; i < job->count; i++) {
            const int32_t f = job->face[i], degree = sl_degree(s->mesh, f);
            memcpy(s->uv + 2 * (int64_t)s->mesh->face_first[f], uv, 2 * (size_t)degree * sizeof *uv);
            uv += 2 * degree;
        }
    }
}

/* Owners of the facets that have charts. */
static sl_status images_create(images *s)
{
    const sl_mesh *m = s->mesh;
    s->owner = sl_alloc(m->nf, sizeof *s->owner);
    s->mirrored = sl_calloc(m->nf, sizeof *s->mirrored);
    s->near = sl_calloc(m->nf, sizeof *s->near);
    s->uv = sl_calloc(m->nh, 2 * sizeof *s->uv);
    s->label = sl_alloc(m->nf, sizeof *s->label);
    if (s->owner == NULL || s->mirrored == NULL || s->near == NULL || s->uv == NULL || s->label == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    memset(s->owner, 0xff, (size_t)m->nf * sizeof *s->owner);
    for (int64_t k = 0; k < s->done->count; k++) {
        for (int32_t i = 0; i < s->done->job[k].count; i++) {
            s->owner[s->done->job[k].face[i]] = (int32_t)k;
        }
    }
    return SL_OK;
}

/* Follows the links of facet f's corners to the end: from[] then names corners of charts. */
static void follow_links(images *s, int32_t f)
{
    const sl_mesh *m = s->mesh;
    int32_t *from = s->sharing->from;
    for (int32_t c = m->face_first[f]; c < m->face_first[f + 1]; c++) {
        int32_t root = c;
        uint8_t mirrored = 0, near = 0;
        while (from[root] >= 0) {
            mirrored ^= s->sharing->reverses[m->face[root]];
            near |= s->sharing->near[m->face[root]];
            root = from[root];
        }
        const int32_t owner = s->owner[m->face[root]];
        if (c == m->face_first[f]) {
            s->owner[f] = owner;
            s->mirrored[f] = mirrored;
        }
        s->near[f] |= near;
        s->owner[f] = s->owner[f] == owner && s->mirrored[f] == mirrored ? owner : -1;
    }
}

/* Every done chart makes room for its images. */
typedef struct room_job {
    images *s;
    int32_t *first, *facet; /* done->count + 1; facets that copy, by owner */
    sl_status *status;      /* done->count */
} room_job;

static void make_room(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    (void)chunk;
    const room_job *job = user;
    sl_recursion r = *job->s->recursion;
    r.mesh = job->s->work;
    for (int64_t k = begin; k < end; k++) {
        const sl_images_of of = {.facet = job->facet + job->first[k],
                                 .count = job->first[k + 1] - job->first[k],
                                 .from = job->s->sharing->from,
                                 .mirrored = job->s->mirrored};
        job->status[k] = sl_unfold_images(&r, &of, &job->s->done->job[k]);
    }
}

/* Facets that copy by the chart they copy. */
static void sort_by_owner(const images *s, room_job *job)
{
    for (int32_t f = 0; f < s->mesh->nf; f++) {
        if (is_copy(s, f) && s->owner[f] >= 0) {
            job->first[s->owner[f] + 2]++;
        }
    }
    for (int64_t k = 0; k < s->done->count; k++) {
        job->first[k + 2] += job->first[k + 1];
    }
    for (int32_t f = 0; f < s->mesh->nf; f++) {
        if (is_copy(s, f) && s->owner[f] >= 0) {
            job->facet[job->first[s->owner[f] + 1]++] = f;
        }
    }
}

static sl_status unfold_all(images *s, const sl_context *context)
{
    sl_status status = SL_OK;
    const int64_t n = s->done->count;
    room_job job = {.s = s,
                    .first = sl_calloc(n + 2, sizeof *job.first),
                    .facet = sl_alloc(s->mesh->nf, sizeof *job.facet),
                    .status = sl_calloc(n, sizeof *job.status)};
    if (job.first == NULL || job.facet == NULL || job.status == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    sort_by_owner(s, &job);
    sl_parallel_for(context, n, 1, make_room, &job);
    for (int64_t k = 0; k < n; k++) {
        SL_TRY(job.status[k]);
    }
cleanup:
    sl_free(job.first);
    sl_free(job.facet);
    sl_free(job.status);
    return status;
}

/* The copies' UVs, when those of the charts are final. */
static void copy_uvs(images *s)
{
    const int32_t *from = s->sharing->from;
    take_uvs(s);
    for (int32_t c = 0; c < s->mesh->nh; c++) {
        if (from[c] >= 0) {
            memcpy(s->uv + 2 * (int64_t)c, s->uv + 2 * (int64_t)from[c], 2 * sizeof *s->uv);
        }
    }
}

/* Links to roots only, in a second pass: a chain may run through corners of higher number. */
static void shorten_links(images *s)
{
    int32_t *from = s->sharing->from;
    for (int32_t c = 0; c < s->mesh->nh; c++) {
        while (from[c] >= 0 && from[from[c]] >= 0) {
            from[c] = from[from[c]];
        }
    }
}

static bool same_uv(const images *s, int32_t a, int32_t b)
{
    return memcmp(s->uv + 2 * (int64_t)a, s->uv + 2 * (int64_t)b, 2 * sizeof *s->uv) == 0;
}

/* Does the edge of h join two facets whose images lie side by side in one chart? (Folded at an axis they would be
 * mirrored differently.) */
static bool is_glued(const images *s, int32_t h)
{
    const sl_mesh *m = s->mesh;
    const int32_t t = s->work->twin[h], f = m->face[h], g = m->face[t];
    return s->owner[f] >= 0 && s->owner[f] == s->owner[g] && s->mirrored[f] == s->mirrored[g] &&
           same_uv(s, h, sl_next(m, t)) && same_uv(s, sl_next(m, h), t);
}

static void cut_images(images *s)
{
    for (int32_t h = 0; h < s->mesh->nh; h++) {
        const int32_t t = s->work->twin[h];
        if (t < 0 || (!is_copy(s, s->mesh->face[h]) && !is_copy(s, s->mesh->face[t]))) {
            continue;
        }
        if (is_copy(s, s->mesh->face[h]) != is_copy(s, s->mesh->face[t]) || !is_glued(s, h)) {
            sl_mesh_cut_edge(s->work, h);
        }
    }
}

/* A job for every component of facets that copy. slot: scratch, components, all -1. */
static sl_status gather_jobs(images *s, int32_t components)
{
    sl_status status = SL_OK;
    const sl_mesh *m = s->mesh;
    int32_t *slot = sl_alloc(components, sizeof *slot), *size = sl_calloc(components, sizeof *size);
    int64_t *corners = sl_calloc(components, sizeof *corners);
    if (slot == NULL || size == NULL || corners == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    memset(slot, 0xff, (size_t)components * sizeof *slot);
    for (int32_t f = 0; f < m->nf; f++) {
        size[s->label[f]] += is_copy(s, f);
        corners[s->label[f]] += is_copy(s, f) ? sl_degree(m, f) : 0;
    }
    for (int32_t f = 0; f < m->nf; f++) {
        const int32_t l = s->label[f];
        if (!is_copy(s, f)) {
            continue;
        }
        if (slot[l] < 0) {
            sl_chart_job job = {.face = sl_alloc(size[l], sizeof *job.face),
                                .corner_uv = sl_alloc(corners[l], 2 * sizeof *job.corner_uv)};
            slot[l] = (int32_t)s->made.count;
            status = job.face == NULL || job.corner_uv == NULL ? SL_OUT_OF_MEMORY : sl_job_list_push(&s->made, &job);
            if (status != SL_OK) {
                sl_chart_job_clear(&job);
                goto cleanup;
            }
            corners[l] = 0;
        }
        sl_chart_job *job = &s->made.job[slot[l]];
        job->face[job->count++] = f;
        memcpy(job->corner_uv + 2 * corners[l], s->uv + 2 * (int64_t)m->face_first[f],
               2 * (size_t)sl_degree(m, f) * sizeof *s->uv);
        corners[l] += sl_degree(m, f);
        job->kind = s->near[f] ? SL_SYMMETRY_NEAR : job->kind;
    }
cleanup:
    sl_free(slot);
    sl_free(size);
    sl_free(corners);
    return status;
}

/* Gives the jobs what they have from their sources. */
static void inherit(images *s)
{
    for (int64_t k = 0; k < s->made.count; k++) {
        sl_chart_job *job = &s->made.job[k];
        const int32_t owner = s->owner[job->face[0]];
        job->copy = owner >= 0;
        job->mirrored = s->mirrored[job->face[0]] != 0;
        if (owner >= 0) {
            const sl_chart_job *source = &s->done->job[owner];
            job->flat = source->flat;
            job->capped = source->capped;
            job->depth = source->depth;
            job->source_face = source->face[0];
        }
    }
}

/* The certificate and the distortion of a copy, mirrored back, by its own triangles. */
static sl_status measure_copy(const sl_patch *patch, sl_chart_job *job)
{
    sl_status status = SL_OK;
    int32_t *border = NULL, nb = 0;
    double *uv = sl_alloc(patch->nv, 2 * sizeof *uv);
    if (uv == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    for (int32_t c = 0; c < 3 * patch->nt; c++) {
        const double *from = job->corner_uv + 2 * (int64_t)patch->corner[c];
        double *to = uv + 2 * (int64_t)patch->tri[c];
        to[0] = job->mirrored ? -from[0] : from[0];
        to[1] = from[1];
    }
    SL_TRY(sl_patch_border_pairs(patch, &border, &nb));
    SL_TRY(sl_certify_embedding(uv, patch->nt, patch->tri, nb, border, &job->flat.certificate));
    SL_TRY(sl_distortion_measure_indexed(patch->nt, patch->tri, patch->xyz, uv, &job->flat.distortion));
cleanup:
    sl_free(border);
    sl_free(uv);
    return status;
}

/* Is the copy an embedding within the bound on stretch? done = yes. Its map is the source's: only where facets that are
 * not plane have other diagonals can it differ, and the bound on shear is not applied to that. A source that was left
 * above its bound may be copied, too. */
static void judge_copy(const sl_recursion *r, sl_chart_job *job)
{
    sl_status status = SL_OK;
    sl_piece *piece = NULL;
    sl_patch *patch = NULL;
    if (!job->copy) {
        return;
    }
    SL_TRY(sl_piece_create(r->mesh, r->triangulation, job->face, job->count, &piece));
    SL_TRY(sl_piece_topology(piece, &job->topology));
    if (job->topology.genus != 0 || job->topology.loops != 1) {
        goto cleanup;
    }
    SL_TRY(sl_piece_patch(piece, &patch));
    SL_TRY(measure_copy(patch, job));
    const bool within = job->count == 1 || job->flat.distortion.l2 <= r->def->flatten.max_stretch;
    job->done = job->flat.certificate.embedded && (within || job->flat.verdict != SL_CHART_VALID);
cleanup:
    sl_patch_free(patch);
    sl_piece_free(piece);
    job->status = status;
}

/* A chart that cannot copy is whole again inside, and its facets copy nothing. */
static sl_status refuse(images *s, sl_chart_job *job, sl_job_list *refused)
{
    const sl_mesh *m = s->mesh;
    const int32_t label = s->label[job->face[0]];
    for (int32_t i = 0; i < job->count; i++) {
        const int32_t f = job->face[i];
        for (int32_t h = m->face_first[f]; h < m->face_first[f + 1]; h++) {
            const int32_t other = s->work->sew[h];
            s->sharing->from[h] = -1;
            if (other >= 0 && m->twin[h] >= 0 && s->label[m->face[other]] == label) {
                sl_mesh_sew_edge(s->work, h);
            }
        }
    }
    sl_chart_job fresh = {.face = job->face, .count = job->count, .depth = job->depth + 1};
    job->face = NULL;
    sl_chart_job_clear(job);
    s->sharing->info.refused++;
    const sl_status status = sl_job_list_push(refused, &fresh);
    sl_chart_job_clear(&fresh);
    return status;
}

/* With --unshare a copy is an ordinary chart, turned the right way round. */
static void make_independent(images *s, sl_chart_job *job)
{
    const sl_mesh *m = s->mesh;
    int64_t corners = 0;
    for (int32_t i = 0; i < job->count; i++) {
        for (int32_t h = m->face_first[job->face[i]]; h < m->face_first[job->face[i] + 1]; h++, corners++) {
            s->sharing->from[h] = -1;
            job->corner_uv[2 * corners] *= job->mirrored ? -1.0 : 1.0;
        }
    }
    job->copy = job->mirrored = false;
}

static sl_status harvest(images *s, bool unshare, sl_job_list *refused)
{
    sl_status status = SL_OK;
    double copied = 0.0, all = 0.0;
    for (int64_t k = 0; k < s->made.count; k++) {
        sl_chart_job *job = &s->made.job[k];
        SL_TRY(job->status);
        if (!job->done) {
            SL_TRY(refuse(s, job, refused));
            continue;
        }
        if (unshare) {
            make_independent(s, job);
        }
        for (int32_t i = 0; job->copy && i < job->count; i++) {
            copied += sl_mesh_face_area(s->mesh, job->face[i]);
        }
        s->sharing->info.copies += job->copy;
        SL_TRY(sl_job_list_push(s->done, job));
    }
    for (int32_t f = 0; f < s->mesh->nf; f++) {
        all += sl_mesh_face_area(s->mesh, f);
    }
    s->sharing->info.area = all > 0.0 ? copied / all : 0.0;
cleanup:
    return status;
}

sl_status sl_sharing_resolve(sl_sharing *sharing, const sl_recursion *recursion, const sl_mesh *mesh, sl_mesh *work,
                             const sl_context *context, sl_job_list *done, sl_job_list *refused)
{
    sl_status status = SL_OK;
    int32_t components = 0;
    images s = {.sharing = sharing, .recursion = recursion, .mesh = mesh, .work = work, .done = done};
    if (sharing->from == NULL) {
        return SL_OK;
    }
    SL_TRY(images_create(&s));
    for (int32_t f = 0; f < mesh->nf; f++) {
        if (is_copy(&s, f)) {
            follow_links(&s, f);
        }
    }
    shorten_links(&s);
    SL_TRY(unfold_all(&s, context));
    copy_uvs(&s);
    cut_images(&s);
    SL_TRY(sl_mesh_components(work, s.label, &components));
    SL_TRY(gather_jobs(&s, components));
    inherit(&s);
    sl_recursion judge = *recursion;
    judge.mesh = work;
    SL_TRY(sl_run_jobs(&judge, context, judge_copy, &s.made));
    SL_TRY(harvest(&s, recursion->def->unshare, refused));
cleanup:
    images_clear(&s);
    return status;
}
