/* Room for images: a copy has its own triangles, and where a facet of the source is not convex in the plane, another
 * diagonal turns a triangle over. The vertices around are moved a little until both hold. */
#include "segment/share_internal.h"

#include "base/memory.h"
#include "geom/predicates.h"

#include <math.h>
#include <string.h>

enum { ROUNDS = 40, DIRECTIONS = 16, HALVINGS = 6 };

static const double LEAST = 0.3; /* area of the smallest triangle that is aimed at, over the mean around a vertex */
static const double TWO_PI = 6.283185307179586476925;

/* A chart with its own triangles first, then those of its images, all turned the right way round. */
typedef struct unfolding {
    sl_piece *piece;
    sl_patch *patch;
    double *uv;                /* patch->nv x 2 */
    int32_t *vertex;           /* piece nh: patch vertex of a corner */
    int32_t own, all;          /* triangles */
    int32_t *tri;              /* 3 all */
    int32_t *first, *incident; /* nv + 1: triangles around a vertex */
} unfolding;

static void unfolding_clear(unfolding *u)
{
    sl_piece_free(u->piece);
    sl_patch_free(u->patch);
    sl_free(u->uv);
    sl_free(u->vertex);
    sl_free(u->tri);
    sl_free(u->first);
    sl_free(u->incident);
}

static sl_status take_chart(const sl_recursion *r, const sl_chart_job *job, unfolding *u)
{
    sl_status status = SL_OK;
    SL_TRY(sl_piece_create(r->mesh, r->triangulation, job->face, job->count, &u->piece));
    SL_TRY(sl_piece_patch(u->piece, &u->patch));
    u->uv = sl_alloc(u->patch->nv, 2 * sizeof *u->uv);
    u->vertex = sl_alloc(u->piece->mesh->nh, sizeof *u->vertex);
    if (u->uv == NULL || u->vertex == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    for (int32_t c = 0; c < 3 * u->patch->nt; c++) {
        const int32_t v = u->patch->tri[c];
        u->vertex[u->patch->corner[c]] = v;
        memcpy(u->uv + 2 * (int64_t)v, job->corner_uv + 2 * (int64_t)u->patch->corner[c], 2 * sizeof *u->uv);
    }
    u->own = u->all = u->patch->nt;
cleanup:
    return status;
}

/* The triangles of the images' facets by the chart's vertices. */
static sl_status take_images(const sl_recursion *r, const sl_images_of *images, unfolding *u)
{
    const sl_triangulation *t = r->triangulation;
    const sl_mesh *m = r->mesh;
    int64_t more = 0;
    for (int32_t i = 0; i < images->count; i++) {
        more += t->first[images->facet[i] + 1] - t->first[images->facet[i]];
    }
    u->tri = sl_alloc(u->own + more, 3 * sizeof *u->tri);
    if (u->tri == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    memcpy(u->tri, u->patch->tri, 3 * (size_t)u->own * sizeof *u->tri);
    for (int32_t i = 0; i < images->count; i++) {
        const int32_t f = images->facet[i];
        for (int32_t k = t->first[f]; k < t->first[f + 1]; k++) {
            int32_t *tri = u->tri + 3 * (int64_t)u->all++;
            for (int32_t j = 0; j < 3; j++) {
                const int32_t root = images->from[t->corner[3 * k + (images->mirrored[f] != 0 ? 2 - j : j)]];
                const int32_t local = sl_find_sorted(u->piece->face, u->piece->mesh->nf, m->face[root]);
                tri[j] = u->vertex[u->piece->mesh->face_first[local] + (root - m->face_first[m->face[root]])];
            }
        }
    }
    return SL_OK;
}

static sl_status list_incidences(unfolding *u)
{
    const int32_t nv = u->patch->nv;
    u->first = sl_calloc((int64_t)nv + 2, sizeof *u->first);
    u->incident = sl_alloc(3 * (int64_t)u->all, sizeof *u->incident);
    if (u->first == NULL || u->incident == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t c = 0; c < 3 * u->all; c++) {
        u->first[u->tri[c] + 2]++;
    }
    for (int32_t v = 0; v < nv; v++) {
        u->first[v + 2] += u->first[v + 1];
    }
    for (int32_t c = 0; c < 3 * u->all; c++) {
        u->incident[u->first[u->tri[c] + 1]++] = c / 3;
    }
    return SL_OK;
}

static const double *corner_of(const unfolding *u, int32_t t, int32_t k)
{
    return u->uv + 2 * (int64_t)u->tri[3 * (int64_t)t + k];
}

static double area_of(const unfolding *u, int32_t t)
{
    const double *a = corner_of(u, t, 0), *b = corner_of(u, t, 1), *c = corner_of(u, t, 2);
    return 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]));
}

/* Not by rounding: exactly. */
static bool is_turned(const unfolding *u, int32_t t)
{
    return sl_orient2d(corner_of(u, t, 0), corner_of(u, t, 1), corner_of(u, t, 2)) <= 0;
}

static int32_t count_turned(const unfolding *u)
{
    int32_t n = 0;
    for (int32_t t = 0; t < u->all; t++) {
        n += is_turned(u, t);
    }
    return n;
}

static double least_area(const unfolding *u, int32_t v)
{
    double least = HUGE_VAL;
    for (int32_t p = u->first[v]; p < u->first[v + 1]; p++) {
        least = fmin(least, area_of(u, u->incident[p]));
    }
    return least;
}

static double mean_area(const unfolding *u, int32_t v)
{
    double sum = 0.0;
    for (int32_t p = u->first[v]; p < u->first[v + 1]; p++) {
        sum += fabs(area_of(u, u->incident[p]));
    }
    return sum / (u->first[v + 1] - u->first[v]);
}

/* Moves v to where the smallest triangle around it is largest, among points on circles that shrink; stops when it is
 * large enough. */
static void move_vertex(unfolding *u, int32_t v)
{
    double *p = u->uv + 2 * (int64_t)v;
    const double enough = LEAST * mean_area(u, v);
    double best = least_area(u, v), radius = sqrt(mean_area(u, v));
    for (int32_t h = 0; h < HALVINGS && best < enough; h++, radius *= 0.5) {
        const double centre[2] = {p[0], p[1]};
        double better[2] = {p[0], p[1]};
        for (int32_t d = 0; d < DIRECTIONS; d++) {
            p[0] = centre[0] + radius * cos(TWO_PI * d / DIRECTIONS);
            p[1] = centre[1] + radius * sin(TWO_PI * d / DIRECTIONS);
            const double least = least_area(u, v);
            if (least > best) {
                best = least;
                better[0] = p[0];
                better[1] = p[1];
            }
        }
        p[0] = better[0];
        p[1] = better[1];
    }
}

/* The moves leave slivers: the stretch of both sets of triangles together is minimised, none of them turning over. For
 * the minimiser the images' triangles are more of the patch, whose border stays that of the chart (a twin of 0 says
 * that an edge is none). */
static sl_status relax(const sl_recursion *r, unfolding *u)
{
    sl_status status = SL_OK;
    sl_patch both = *u->patch;
    sl_stretch_def def = r->def->flatten.stretch;
    def.simple_border = true;
    both.nt = u->all;
    both.tri = u->tri;
    both.twin = sl_calloc(3 * (int64_t)u->all, sizeof *both.twin);
    if (both.twin == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    memcpy(both.twin, u->patch->twin, 3 * (size_t)u->own * sizeof *both.twin);
    status = sl_stretch_minimise(&both, &def, r->context, u->uv, NULL);
    if (status == SL_BAD_INPUT || status == SL_SINGULAR || status == SL_NOT_POSITIVE_DEFINITE) {
        status = SL_OK; /* the map stays as it is */
    }
    sl_free(both.twin);
    return status;
}

/* Takes the map where it is an embedding still, and within the bound where it was. */
static sl_status accept(const sl_recursion *r, const unfolding *u, sl_chart_job *job)
{
    sl_status status = SL_OK;
    int32_t *border = NULL, nb = 0;
    const sl_patch *patch = u->patch;
    sl_certificate certificate;
    sl_distortion distortion;
    SL_TRY(sl_patch_border_pairs(patch, &border, &nb));
    SL_TRY(sl_certify_embedding(u->uv, patch->nt, patch->tri, nb, border, &certificate));
    SL_TRY(sl_distortion_measure_indexed(patch->nt, patch->tri, patch->xyz, u->uv, &distortion));
    if (certificate.embedded &&
        distortion.l2 <= fmax(job->flat.distortion.l2, job->count == 1 ? HUGE_VAL : r->def->flatten.max_stretch)) {
        for (int32_t c = 0; c < 3 * patch->nt; c++) {
            memcpy(job->corner_uv + 2 * (int64_t)patch->corner[c], u->uv + 2 * (int64_t)patch->tri[c],
                   2 * sizeof *u->uv);
        }
        job->flat.certificate = certificate;
        job->flat.distortion = distortion;
    }
cleanup:
    sl_free(border);
    return status;
}

/**
 * Moves vertices of a finished chart so that the triangles of its images are not turned over either.
 *
 * @param[in]     recursion  its mesh has the chart's seams cut
 * @param[in]     images     facets that copy the chart's
 * @param[in,out] job        a valid chart; unchanged where nothing had to be done or could be
 *
 * Every vertex of a turned triangle is tried in turn, a bounded number of rounds; what cannot be mended stays, and the
 * image will be refused. SL_OUT_OF_MEMORY. Linear but for the moves.
 */
sl_status sl_unfold_images(const sl_recursion *recursion, const sl_images_of *images, sl_chart_job *job)
{
    sl_status status = SL_OK;
    unfolding u = {0};
    if (images->count == 0 || job->flat.verdict != SL_CHART_VALID) {
        return SL_OK;
    }
    SL_TRY(take_chart(recursion, job, &u));
    SL_TRY(take_images(recursion, images, &u));
    const int32_t before = count_turned(&u);
    if (before == 0) {
        goto cleanup;
    }
    SL_TRY(list_incidences(&u));
    for (int32_t round = 0; round < ROUNDS && count_turned(&u) > 0; round++) {
        for (int32_t t = 0; t < u.all; t++) {
            for (int32_t k = 0; k < 3 && is_turned(&u, t); k++) {
                move_vertex(&u, u.tri[3 * (int64_t)t + k]);
            }
        }
    }
    const int32_t after = count_turned(&u);
    if (after == 0) {
        SL_TRY(relax(recursion, &u));
    }
    if (after < before) {
        SL_TRY(accept(recursion, &u, job));
    }
cleanup:
    unfolding_clear(&u);
    return status;
}
