/* The mirror plane that carries a surface best onto itself, whatever its connectivity. */
#include "symmetry/near_internal.h"
#include "symmetry/rigid.h"

#include "base/memory.h"

#include <stdlib.h>
#include <string.h>

enum {
    PER_CORNER = 4, /* of a small mesh */
    COARSE = 256,
    MIDDLE = 512,
    COARSE_ROUNDS = 10, /* for each plane; */
    MIDDLE_ROUNDS = 20, /* for the FINALISTS; */
    ROUNDS = 20,        /* for the one chosen */
    PLANES = 16,
    FINALISTS = 3,
    CHUNK = 1024
};

static const double KEPT = 0.8, KEPT_LAST = 0.5; /* share of the samples a plane is fitted to: the nearest */
static const double ALIKE = 0.9;         /* ratio of moments from which two axes have no direction of their own */
static const double SAME_PLANE = 0.9999; /* cosine of normals */
static const double ENOUGH = 0.9;        /* share of the area that has to match */

static sl_status make_tree(sl_mirror_search *s)
{
    sl_status status = sl_triangulation_create(s->mesh, &s->triangulation);
    if (status != SL_OK) {
        return status;
    }
    const int32_t nt = s->triangulation->nt;
    s->vertex = sl_alloc(3 * (int64_t)nt, sizeof *s->vertex);
    s->facet = sl_alloc(nt, sizeof *s->facet);
    s->area = sl_alloc(s->mesh->nf, sizeof *s->area);
    s->sample = sl_alloc(3 * SL_MIRROR_SAMPLES, sizeof *s->sample);
    s->image = sl_alloc(3 * SL_MIRROR_SAMPLES, sizeof *s->image);
    s->triangle = sl_alloc(SL_MIRROR_SAMPLES, sizeof *s->triangle);
    s->distance = sl_alloc(SL_MIRROR_SAMPLES, sizeof *s->distance);
    s->sorted = sl_alloc(SL_MIRROR_SAMPLES, sizeof *s->sorted);
    if (s->vertex == NULL || s->facet == NULL || s->area == NULL || s->sample == NULL || s->image == NULL ||
        s->triangle == NULL || s->distance == NULL || s->sorted == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t t = 0; t < nt; t++) {
        for (int32_t k = 0; k < 3; k++) {
            s->vertex[3 * t + k] = s->mesh->origin[s->triangulation->corner[3 * t + k]];
        }
        s->facet[t] = s->mesh->face[s->triangulation->corner[3 * t]];
    }
    return sl_nearest_create(s->mesh->xyz, s->vertex, nt, &s->tree);
}

/* Centre and principal axes of the area, facets as points. */
static void find_axes(sl_mirror_search *s)
{
    double c[3], moment[9] = {0};
    for (int32_t f = 0; f < s->mesh->nf; f++) {
        s->area[f] = sl_mesh_face_area(s->mesh, f);
        s->total += s->area[f];
        sl_mesh_face_centroid(s->mesh, f, c);
        for (int k = 0; k < 3; k++) {
            s->centre[k] += s->area[f] * c[k];
        }
    }
    for (int k = 0; k < 3; k++) {
        s->centre[k] /= s->total > 0.0 ? s->total : 1.0;
    }
    for (int32_t f = 0; f < s->mesh->nf; f++) {
        sl_mesh_face_centroid(s->mesh, f, c);
        sl_vec3_sub(c, s->centre, c);
        for (int k = 0; k < 9; k++) {
            moment[k] += s->area[f] * c[k / 3] * c[k % 3];
        }
    }
    sl_eigen3(moment, s->moment, s->axis);
}

/* Corners of facets at equal steps of area, of a large facet one after the other: where a polygon is not plane, its
 * mirror image may be cut into other triangles, but the corners lie on both. */
static void take_samples(sl_mirror_search *s)
{
    const sl_mesh *m = s->mesh;
    const int32_t wanted = m->nh < SL_MIRROR_SAMPLES / PER_CORNER ? PER_CORNER * m->nh : SL_MIRROR_SAMPLES;
    double passed = 0.0;
    for (int32_t f = 0; f < m->nf; f++) {
        passed += s->area[f] / s->total;
        while (s->samples < wanted && (s->samples + 0.5) / wanted < passed) {
            const int32_t h = m->face_first[f] + s->samples % sl_degree(m, f);
            memcpy(&s->sample[3 * s->samples++], &m->xyz[3 * (int64_t)m->origin[h]], 3 * sizeof *s->sample);
        }
    }
}

static int32_t add_plane(const sl_mirror_search *s, sl_mirror_plane *list, int32_t count, const double normal[3])
{
    sl_mirror_plane p = {.score = HUGE_VAL};
    const double norm = sl_vec3_norm(normal);
    for (int k = 0; k < 3; k++) {
        p.normal[k] = normal[k] / norm;
    }
    for (int32_t i = 0; i < count; i++) {
        if (fabs(sl_vec3_dot(list[i].normal, p.normal)) > SAME_PLANE) {
            return count;
        }
    }
    p.offset = sl_vec3_dot(p.normal, s->centre);
    list[count++] = p;
    return count;
}

/* Coordinate axes, principal axes, and what lies between those of like moments. */
static int32_t list_planes(const sl_mirror_search *s, sl_mirror_plane *list)
{
    int32_t count = 0;
    for (int k = 0; k < 3; k++) {
        double e[3] = {0.0, 0.0, 0.0};
        e[k] = 1.0;
        count = add_plane(s, list, count, e);
    }
    for (int k = 0; k < 3; k++) {
        count = add_plane(s, list, count, &s->axis[3 * k]);
    }
    for (int k = 0; k < 2; k++) {
        for (int turn = 1; turn < 4 && s->moment[k] >= ALIKE * s->moment[k + 1]; turn++) {
            double between[3];
            for (int i = 0; i < 3; i++) {
                between[i] = cos(turn * 0.785398163397448) * s->axis[3 * k + i] +
                             sin(turn * 0.785398163397448) * s->axis[3 * (k + 1) + i];
            }
            count = add_plane(s, list, count, between);
        }
    }
    return count;
}

static int compare_planes(const void *a, const void *b)
{
    const double x = ((const sl_mirror_plane *)a)->score, y = ((const sl_mirror_plane *)b)->score;
    return (x > y) - (x < y);
}

/* All planes roughly, the best ones better, the best one finely: at last to the half that fits best, so that what the
 * two sides do not share does not move it. */
static sl_status find_plane(sl_mirror_search *s, sl_mirror_plane *best)
{
    sl_status status = SL_OK;
    sl_mirror_plane list[PLANES];
    const int32_t count = list_planes(s, list), finalists = count < FINALISTS ? count : FINALISTS;
    for (int32_t i = 0; i < count; i++) {
        SL_TRY(sl_report_progress(s->context, "near symmetry", 0.5 * i / count));
        sl_mirror_fit(s, &list[i], COARSE, COARSE_ROUNDS, KEPT);
    }
    qsort(list, (size_t)count, sizeof *list, compare_planes);
    for (int32_t i = 0; i < finalists; i++) {
        SL_TRY(sl_report_progress(s->context, "near symmetry", 0.5 + 0.1 * i));
        sl_mirror_fit(s, &list[i], MIDDLE, MIDDLE_ROUNDS, KEPT);
    }
    qsort(list, (size_t)finalists, sizeof *list, compare_planes);
    *best = list[0];
    sl_mirror_fit(s, best, SL_MIRROR_SAMPLES, ROUNDS, KEPT_LAST);
    sl_mirror_polish(s, best, KEPT_LAST);
cleanup:
    return status;
}

/* Sums of one chunk of vertices. */
typedef struct chunk_sums {
    double sum, most, n, within;
} chunk_sums;

typedef struct judgement {
    const sl_mirror_search *s;
    const sl_mirror_plane *p;
    double near;         /* absolute */
    const uint8_t *used; /* nv */
    chunk_sums *sums;
    int32_t *match;       /* nf, nullable */
    double *area_matched; /* per chunk */
} judgement;

static void judge_vertices(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    const judgement *j = user;
    chunk_sums sums = {0};
    for (int64_t v = begin; v < end; v++) {
        if (j->used[v]) {
            double q[3], at[3], d;
            sl_mirror_point(j->p, &j->s->mesh->xyz[3 * v], q);
            sl_nearest_find(j->s->tree, q, at, &d);
            sums.n += 1.0;
            sums.sum += d;
            sums.most = fmax(sums.most, d);
            sums.within += d <= j->near ? 1.0 : 0.0;
        }
    }
    j->sums[chunk] = sums;
}

static void judge_facets(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    const judgement *j = user;
    double within = 0.0;
    for (int64_t f = begin; f < end; f++) {
        double c[3], q[3], at[3], d;
        sl_mesh_face_centroid(j->s->mesh, (int32_t)f, c);
        sl_mirror_point(j->p, c, q);
        const int32_t t = sl_nearest_find(j->s->tree, q, at, &d);
        within += d <= j->near ? j->s->area[f] : 0.0;
        if (j->match != NULL) {
            j->match[f] = j->s->facet[t];
        }
    }
    j->area_matched[chunk] = within;
}

static sl_status judge(const sl_mirror_search *s, const sl_mirror_plane *p, double near, int32_t *match,
                       sl_near_mirror *out)
{
    sl_status status = SL_OK;
    const sl_mesh *m = s->mesh;
    const double diagonal = sl_mesh_diagonal(m), unit = diagonal > 0.0 ? diagonal : 1.0;
    const int32_t vertex_chunks = sl_chunk_count(m->nv, CHUNK), facet_chunks = sl_chunk_count(m->nf, CHUNK);
    uint8_t *used = sl_calloc(m->nv, sizeof *used);
    chunk_sums *sums = sl_calloc(vertex_chunks, sizeof *sums);
    double *area = sl_calloc(facet_chunks, sizeof *area);
    if (used == NULL || sums == NULL || area == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    for (int32_t h = 0; h < m->nh; h++) {
        used[m->origin[h]] = 1;
    }
    judgement j = {s, p, near * unit, used, sums, match, area};
    SL_TRY(sl_report_progress(s->context, "near symmetry", 0.8));
    sl_parallel_for(s->context, m->nv, CHUNK, judge_vertices, &j);
    SL_TRY(sl_report_progress(s->context, "near symmetry", 0.9));
    sl_parallel_for(s->context, m->nf, CHUNK, judge_facets, &j);
    chunk_sums all = {0};
    for (int32_t k = 0; k < vertex_chunks; k++) {
        all.sum += sums[k].sum;
        all.n += sums[k].n;
        all.within += sums[k].within;
        all.most = fmax(all.most, sums[k].most);
    }
    double matched = 0.0;
    for (int32_t k = 0; k < facet_chunks; k++) {
        matched += area[k];
    }
    out->found = matched >= ENOUGH * s->total;
    memcpy(out->normal, p->normal, sizeof out->normal);
    out->offset = p->offset;
    out->misfit_mean = all.sum / all.n / unit;
    out->misfit_max = all.most / unit;
    out->matched = all.within / all.n;
cleanup:
    sl_free(used);
    sl_free(sums);
    sl_free(area);
    return status;
}

sl_status sl_symmetry_near(const sl_mesh *mesh, const sl_symmetry_def *def, const sl_context *context, int32_t *match,
                           sl_near_mirror *out)
{
    sl_status status = SL_OK;
    sl_mirror_search s = {.mesh = mesh, .context = context};
    sl_near_mirror result = {0};
    for (int32_t f = 0; f < mesh->nf && match != NULL; f++) {
        match[f] = -1;
    }
    if (mesh->nf == 0) {
        goto cleanup;
    }
    SL_TRY(sl_report_progress(context, "near symmetry", 0.0));
    SL_TRY(make_tree(&s));
    find_axes(&s);
    if (s.total > 0.0) {
        sl_mirror_plane best;
        take_samples(&s);
        SL_TRY(find_plane(&s, &best));
        SL_TRY(judge(&s, &best, def->near, match, &result));
    }
cleanup:
    if (status == SL_OK) {
        *out = result;
    }
    sl_triangulation_free(s.triangulation);
    sl_nearest_free(s.tree);
    sl_free(s.vertex);
    sl_free(s.facet);
    sl_free(s.area);
    sl_free(s.sample);
    sl_free(s.image);
    sl_free(s.triangle);
    sl_free(s.distance);
    sl_free(s.sorted);
    return status;
}
