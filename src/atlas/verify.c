#include "atlas/atlas_internal.h"

#include "base/memory.h"
#include "overlap/certificate.h"
#include "overlap/coverage.h"
#include "overlap/exact.h"

#include <string.h>

/* One chart's certificate, or why there is none. */
typedef struct chart_verdict {
    sl_status status;
    sl_certificate certificate;
} chart_verdict;

typedef struct verify_job {
    const sl_atlas *atlas;
    chart_verdict *verdict;
} verify_job;

/* A mirrored copy is judged as its mirror image. */
static void turn_triangles(sl_patch *patch, int32_t *tri)
{
    for (int32_t t = 0; t < patch->nt; t++) {
        tri[3 * t] = patch->tri[3 * t];
        tri[3 * t + 1] = patch->tri[3 * t + 2];
        tri[3 * t + 2] = patch->tri[3 * t + 1];
    }
}

/* Border halfedges of the patch as vertex pairs. *pair is owned by the caller. */
static sl_status border_pairs(const sl_patch *patch, int32_t **pair, int32_t *count)
{
    int32_t n = 0;
    for (int32_t c = 0; c < 3 * patch->nt; c++) {
        n += patch->twin[c] < 0;
    }
    *pair = sl_alloc(n, 2 * sizeof **pair);
    if (*pair == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    *count = 0;
    for (int32_t c = 0; c < 3 * patch->nt; c++) {
        if (patch->twin[c] < 0) {
            (*pair)[2 * *count] = patch->tri[c];
            (*pair)[2 * *count + 1] = patch->tri[sl_corner_next(c)];
            (*count)++;
        }
    }
    return SL_OK;
}

static sl_status certify_chart(const sl_atlas *atlas, int32_t c, sl_certificate *out)
{
    const sl_segmentation *seg = atlas->segmentation;
    const sl_chart *chart = &seg->chart[c];
    sl_patch *patch = NULL;
    double *uv = NULL;
    int32_t *border = NULL, border_count = 0, *turned = NULL;
    sl_status status = SL_OK;
    if (chart->count == 1 && (atlas->mesh->face_flags[seg->face[chart->first]] & SL_FACE_DEGENERATE) != 0) {
        *out = (sl_certificate){.embedded = true, .first_edge = {-1, -1}}; /* no area, nothing to overlap */
        return SL_OK;
    }
    SL_TRY(sl_patch_extract(atlas->mesh, atlas->triangulation, seg->face + chart->first, chart->count, &patch));
    uv = sl_alloc(patch->nv, 2 * sizeof *uv);
    turned = sl_alloc(3 * (int64_t)patch->nt, sizeof *turned);
    if (uv == NULL || turned == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    for (int32_t k = 0; k < 3 * patch->nt; k++) {
        uv[2 * (int64_t)patch->tri[k]] = atlas->corner_uv[2 * (int64_t)patch->corner[k]];
        uv[2 * (int64_t)patch->tri[k] + 1] = atlas->corner_uv[2 * (int64_t)patch->corner[k] + 1];
    }
    SL_TRY(border_pairs(patch, &border, &border_count));
    turn_triangles(patch, turned);
    SL_TRY(sl_certify_embedding(uv, patch->nt, chart->mirrored ? turned : patch->tri, border_count, border, out));
    out->embedded = out->embedded && sl_patch_is_disk(patch);
cleanup:
    sl_patch_free(patch);
    sl_free(uv);
    sl_free(turned);
    sl_free(border);
    return status;
}

static void certify_chunk(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    (void)chunk;
    const verify_job *job = user;
    for (int64_t c = begin; c < end; c++) {
        job->verdict[c].status = certify_chart(job->atlas, (int32_t)c, &job->verdict[c].certificate);
    }
}

/* The triangles of one page's charts that are copies (or not), in the triangulation's order; page -1 = of all. Returns
 * how many. */
static int32_t select_triangles(const sl_atlas *atlas, bool copies, int32_t page, int32_t *tri)
{
    const sl_segmentation *seg = atlas->segmentation;
    const sl_triangulation *t = atlas->triangulation;
    int32_t n = 0;
    for (int32_t f = 0; f < atlas->mesh->nf; f++) {
        const int32_t c = seg->face_chart[f];
        if ((seg->chart[c].copy_of >= 0) == copies && (page < 0 || atlas->placement[c].page == page)) {
            const int32_t count = t->first[f + 1] - t->first[f];
            memcpy(tri + 3 * (int64_t)n, t->corner + 3 * (int64_t)t->first[f], 3 * (size_t)count * sizeof *tri);
            n += count;
        }
    }
    return n;
}

/* All UVs as if every chart were on the first page. */
static double *untile(const sl_atlas *atlas)
{
    double *uv = sl_alloc(atlas->mesh->nh, 2 * sizeof *uv);
    for (int32_t h = 0; uv != NULL && h < atlas->mesh->nh; h++) {
        const int32_t page = atlas->placement[atlas->segmentation->face_chart[atlas->mesh->face[h]]].page;
        for (int k = 0; k < 2; k++) {
            uv[2 * (int64_t)h + k] = atlas->corner_uv[2 * (int64_t)h + k] - sl_page_tile(page, k);
        }
    }
    return uv;
}

/* Texels of one page: hit more than once by charts that are no copies, and hit by copies. tri: room for 3 nt. */
static sl_status count_page(sl_atlas *atlas, int32_t page, const double *uv, int32_t *tri, const sl_context *context)
{
    sl_coverage *coverage = NULL;
    sl_status status = SL_OK;
    for (int copies = 0; copies < 2; copies++) {
        const int32_t nt = select_triangles(atlas, copies == 1, page, tri);
        if (copies == 1 && nt == 0) {
            break;
        }
        sl_coverage_free(coverage);
        coverage = NULL;
        SL_TRY(sl_coverage_create(atlas->check.resolution, atlas->check.resolution, &coverage));
        SL_TRY(sl_coverage_add(coverage, uv, nt, tri, context));
        if (copies == 0) {
            atlas->check.covered_texels += sl_coverage_covered(coverage);
            atlas->check.overlapping_texels += sl_coverage_overlapping(coverage);
        } else {
            atlas->check.shared_texels += sl_coverage_covered(coverage);
        }
    }
cleanup:
    sl_coverage_free(coverage);
    return status;
}

/* Texels of all pages; and the proof that no two triangles of charts that are no copies overlap, in one chart or two.
 */
static sl_status count_texels(sl_atlas *atlas, const sl_context *context)
{
    sl_exact_overlap exact;
    sl_status status = SL_OK;
    const int32_t pages = atlas->pack.pages > 1 ? atlas->pack.pages : 1;
    int32_t *tri = sl_alloc(3 * (int64_t)atlas->triangulation->nt, sizeof *tri);
    double *uv = untile(atlas);
    SL_TRY(tri != NULL && uv != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t page = 0; page < pages; page++) {
        SL_TRY(count_page(atlas, page, uv, tri, context));
    }
    const int32_t nt = select_triangles(atlas, false, -1, tri);
    SL_TRY(sl_overlap_exact(atlas->corner_uv, nt, tri, context, NULL, &exact));
    atlas->check.proven = exact.red == 0;
cleanup:
    sl_free(tri);
    sl_free(uv);
    return status;
}

/* Corners of copies that are not where the corners they copy are. */
static int32_t count_unlike(const sl_atlas *atlas)
{
    const sl_segmentation *seg = atlas->segmentation;
    int32_t unlike = 0;
    for (int32_t h = 0; h < atlas->mesh->nh; h++) {
        const int32_t c = seg->face_chart[atlas->mesh->face[h]], shown = sl_chart_shown(seg, c);
        if (shown != c) {
            const int32_t from = seg->source != NULL ? seg->source[h] : -1;
            const double *uv = atlas->corner_uv;
            unlike += from < 0 || seg->face_chart[atlas->mesh->face[from]] != shown ||
                      memcmp(uv + 2 * (int64_t)h, uv + 2 * (int64_t)from, 2 * sizeof *uv) != 0;
        }
    }
    return unlike;
}

sl_status sl_atlas_verify(sl_atlas *atlas, const sl_atlas_def *def, const sl_context *context)
{
    const int32_t n = atlas->segmentation->nchart;
    sl_atlas_check *check = &atlas->check;
    *check = (sl_atlas_check){.resolution = def->check_resolution};
    verify_job job = {atlas, sl_calloc(n, sizeof(chart_verdict))};
    sl_status status = job.verdict != NULL ? SL_OK : SL_OUT_OF_MEMORY;
    SL_TRY(status);
    sl_parallel_for(context, n, 1, certify_chunk, &job);
    for (int32_t c = 0; c < n; c++) {
        SL_TRY(job.verdict[c].status);
        check->flipped += job.verdict[c].certificate.flipped;
        check->degenerate += job.verdict[c].certificate.degenerate;
        check->uncertified_charts += !job.verdict[c].certificate.embedded;
    }
    SL_TRY(count_texels(atlas, context));
    check->unlike = count_unlike(atlas);
    check->passed = check->flipped == 0 && check->degenerate == 0 && check->uncertified_charts == 0 &&
                    check->overlapping_texels == 0 && check->proven && check->unlike == 0;
cleanup:
    sl_free(job.verdict);
    return status;
}
