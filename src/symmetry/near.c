/* The mirror plane that carries a surface best onto itself, whatever its connectivity. */
#include "symmetry/nearest.h"
#include "symmetry/rigid.h"
#include "symmetry/symmetry.h"

#include "base/memory.h"
#include "geom/vec3.h"
#include "mesh/triangulate.h"

#include <stdlib.h>
#include <string.h>

enum {
    SAMPLES = 2048, /* of the final fit, at most */
    PER_CORNER = 4, /* of a small mesh */
    COARSE = 256,
    MIDDLE = 512,
    COARSE_ROUNDS = 10, /* for each plane; */
    MIDDLE_ROUNDS = 20, /* for the FINALISTS; */
    ROUNDS = 20,        /* for the one chosen, */
    NEWTON_ROUNDS = 30, /* and along the surface's normals, */
    PATIENCE = 4,       /* this many without gain at most */
    PLANES = 16,
    FINALISTS = 3,
    CHUNK = 1024
};

static const double KEPT = 0.8, KEPT_LAST = 0.5; /* share of the samples a plane is fitted to: the nearest */
static const double ALIKE = 0.9;         /* ratio of moments from which two axes have no direction of their own */
static const double SAME_PLANE = 0.9999; /* cosine of normals */
static const double SETTLED = 1e-13;     /* change of a normal that ends the fit */
static const double SLIDES = 1e-9;       /* eigenvalue of the normal equations, over the largest */
static const double ENOUGH = 0.9;        /* share of the area that has to match */

typedef struct plane {
    double normal[3], offset, score;
} plane;

typedef struct mirror_search {
    const sl_mesh *mesh;
    const sl_context *context;
    sl_triangulation *triangulation;
    int32_t *vertex, *facet; /* of the triangles: 3 nt; nt */
    sl_nearest *tree;
    double *area;              /* nf */
    double total, centre[3];   /* of the area */
    double axis[9], moment[3]; /* principal axes, ascending moments */
    double *sample, *image;    /* 3 SAMPLES: corners; nearest to their mirror images */
    int32_t *triangle;         /* SAMPLES: nearest triangle */
    double *distance, *sorted; /* SAMPLES */
    int32_t samples;
} mirror_search;

static void mirror_point(const plane *s, const double p[3], double out[3])
{
    const double d = 2.0 * (sl_vec3_dot(s->normal, p) - s->offset);
    for (int k = 0; k < 3; k++) {
        out[k] = p[k] - d * s->normal[k];
    }
}

static sl_status make_tree(mirror_search *s)
{
    sl_status status = sl_triangulation_create(s->mesh, &s->triangulation);
    if (status != SL_OK) {
        return status;
    }
    const int32_t nt = s->triangulation->nt;
    s->vertex = sl_alloc(3 * (int64_t)nt, sizeof *s->vertex);
    s->facet = sl_alloc(nt, sizeof *s->facet);
    s->area = sl_alloc(s->mesh->nf, sizeof *s->area);
    s->sample = sl_alloc(3 * SAMPLES, sizeof *s->sample);
    s->image = sl_alloc(3 * SAMPLES, sizeof *s->image);
    s->triangle = sl_alloc(SAMPLES, sizeof *s->triangle);
    s->distance = sl_alloc(SAMPLES, sizeof *s->distance);
    s->sorted = sl_alloc(SAMPLES, sizeof *s->sorted);
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
static void find_axes(mirror_search *s)
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
static void take_samples(mirror_search *s)
{
    const sl_mesh *m = s->mesh;
    const int32_t wanted = m->nh < SAMPLES / PER_CORNER ? PER_CORNER * m->nh : SAMPLES;
    double passed = 0.0;
    for (int32_t f = 0; f < m->nf; f++) {
        passed += s->area[f] / s->total;
        while (s->samples < wanted && (s->samples + 0.5) / wanted < passed) {
            const int32_t h = m->face_first[f] + s->samples % sl_degree(m, f);
            memcpy(&s->sample[3 * s->samples++], &m->xyz[3 * (int64_t)m->origin[h]], 3 * sizeof *s->sample);
        }
    }
}

static int32_t add_plane(const mirror_search *s, plane *list, int32_t count, const double normal[3])
{
    plane p = {.score = HUGE_VAL};
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
static int32_t list_planes(const mirror_search *s, plane *list)
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

typedef struct matching {
    mirror_search *s;
    const plane *p;
    int32_t stride;
} matching;

static void match_samples(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    (void)chunk;
    const matching *m = user;
    for (int64_t i = begin; i < end; i++) {
        double q[3];
        mirror_point(m->p, &m->s->sample[3 * i * m->stride], q);
        m->s->triangle[i] = sl_nearest_find(m->s->tree, q, &m->s->image[3 * i], &m->s->distance[i]);
    }
}

static int compare_double(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Matches samples to the surface; returns the distance within which the share `kept` of them lies. p->score = mean
 * distance of those. */
static double match(mirror_search *s, plane *p, int32_t count, int32_t stride, double kept)
{
    matching m = {s, p, stride};
    sl_parallel_for(s->context, count, CHUNK / 8, match_samples, &m);
    memcpy(s->sorted, s->distance, (size_t)count * sizeof *s->sorted);
    qsort(s->sorted, (size_t)count, sizeof *s->sorted, compare_double);
    const int32_t keep = (int32_t)(kept * (count - 1)) + 1;
    p->score = 0.0;
    for (int32_t i = 0; i < keep; i++) {
        p->score += s->sorted[i] / keep;
    }
    return s->sorted[keep - 1];
}

/* The plane of least squares between samples and the points nearest to their mirror images: with m the mean of both,
 * sum |q - S p|^2 = const + 4 n' (sum (p - m)(q - m)') n. Fitted to the share `kept` that lies nearest. Returns the
 * change of the normal and the offset. */
static double refit(mirror_search *s, plane *p, int32_t count, int32_t stride, double kept)
{
    const double limit = match(s, p, count, stride, kept);
    double mean[3] = {0}, product[9] = {0}, lambda[3], V[9], n = 0.0;
    for (int32_t i = 0; i < count; i++) {
        if (s->distance[i] <= limit) {
            n += 1.0;
            for (int k = 0; k < 3; k++) {
                mean[k] += 0.5 * (s->sample[3 * i * stride + k] + s->image[3 * i + k]);
            }
        }
    }
    for (int32_t i = 0; i < count; i++) {
        for (int k = 0; k < 9 && s->distance[i] <= limit; k++) {
            const double *a = &s->sample[3 * i * stride], *b = &s->image[3 * i];
            const int r = k / 3, c = k % 3;
            product[k] +=
                0.5 * ((a[r] - mean[r] / n) * (b[c] - mean[c] / n) + (b[r] - mean[r] / n) * (a[c] - mean[c] / n));
        }
    }
    sl_eigen3(product, lambda, V);
    const double sign = sl_vec3_dot(V, p->normal) < 0.0 ? -1.0 : 1.0;
    double change = 0.0;
    for (int k = 0; k < 3; k++) {
        change = fmax(change, fabs(sign * V[k] - p->normal[k]));
        p->normal[k] = sign * V[k];
    }
    const double offset = sl_vec3_dot(p->normal, mean) / n;
    change = fmax(change, fabs(offset - p->offset));
    p->offset = offset;
    return change;
}

static int compare_planes(const void *a, const void *b)
{
    return compare_double(&((const plane *)a)->score, &((const plane *)b)->score);
}

static void fit_plane(mirror_search *s, plane *p, int32_t samples, int32_t rounds, double kept)
{
    const int32_t stride = s->samples > samples ? s->samples / samples : 1, count = (s->samples - 1) / stride + 1;
    double change = HUGE_VAL;
    for (int32_t round = 0; round < rounds && change > SETTLED; round++) {
        change = refit(s, p, count, stride, kept);
    }
}

/* Unit normal of the triangle that sample i was matched to; 0 for none. */
static void surface_normal(const mirror_search *s, int32_t i, double normal[3])
{
    const int32_t *v = &s->vertex[3 * (int64_t)s->triangle[i]];
    const double *a = &s->mesh->xyz[3 * (int64_t)v[0]];
    double e[3], f[3];
    sl_vec3_sub(&s->mesh->xyz[3 * (int64_t)v[1]], a, e);
    sl_vec3_sub(&s->mesh->xyz[3 * (int64_t)v[2]], a, f);
    sl_vec3_cross(e, f, normal);
    const double norm = sl_vec3_norm(normal);
    for (int k = 0; k < 3; k++) {
        normal[k] = norm > 0.0 ? normal[k] / norm : 0.0;
    }
}

/* Normal equations of the distances along the surface's normals nu, r = nu . (q - S p), in the turns x0, x1 of the
 * mirror's normal n towards e and f and the change x2 of its offset d:
 *     dr = 2 ((x0 e + x1 f) . p - x2) (nu . n) + 2 (n . p - d) nu . (x0 e + x1 f). */
static void assemble(const mirror_search *s, const plane *p, double limit, const double frame[9], double N[9],
                     double g[3])
{
    memset(N, 0, 9 * sizeof *N);
    memset(g, 0, 3 * sizeof *g);
    for (int32_t i = 0; i < s->samples; i++) {
        const double *x = &s->sample[3 * i];
        double nu[3], gap[3], J[3];
        if (s->distance[i] > limit) {
            continue;
        }
        surface_normal(s, i, nu);
        mirror_point(p, x, gap);
        sl_vec3_sub(&s->image[3 * i], gap, gap);
        const double r = sl_vec3_dot(nu, gap), along = sl_vec3_dot(nu, p->normal);
        const double height = sl_vec3_dot(p->normal, x) - p->offset;
        for (int k = 0; k < 2; k++) {
            J[k] = 2.0 * (sl_vec3_dot(&frame[3 * k], x) * along + height * sl_vec3_dot(nu, &frame[3 * k]));
        }
        J[2] = -2.0 * along;
        for (int k = 0; k < 9; k++) {
            N[k] += J[k / 3] * J[k % 3];
        }
        for (int k = 0; k < 3; k++) {
            g[k] += J[k] * r;
        }
    }
}

/* One Gauss-Newton step; directions in which the surface slides along itself are left alone. */
static void newton_step(const mirror_search *s, plane *p, double limit)
{
    double frame[9], product[9], unused[3], N[9], g[3], lambda[3], V[9], x[3] = {0};
    for (int k = 0; k < 9; k++) { /* the eigenvectors of I + n n' are a frame, n the last */
        product[k] = (k % 4 == 0) + p->normal[k / 3] * p->normal[k % 3];
    }
    sl_eigen3(product, unused, frame);
    assemble(s, p, limit, frame, N, g);
    sl_eigen3(N, lambda, V);
    for (int k = 0; k < 3; k++) {
        const double c = lambda[k] > SLIDES * lambda[2] ? -sl_vec3_dot(&V[3 * k], g) / lambda[k] : 0.0;
        for (int i = 0; i < 3; i++) {
            x[i] += c * V[3 * k + i];
        }
    }
    for (int i = 0; i < 3; i++) {
        p->normal[i] += x[0] * frame[i] + x[1] * frame[3 + i];
    }
    const double norm = sl_vec3_norm(p->normal);
    for (int i = 0; i < 3; i++) {
        p->normal[i] /= norm;
    }
    p->offset = (p->offset + x[2]) / norm;
}

/* Distances along the normals converge where nearest points creep along the surface. The best plane met is kept. */
static void polish_plane(mirror_search *s, plane *best)
{
    plane p = *best;
    int32_t worse = 0;
    best->score = HUGE_VAL;
    for (int32_t round = 0; round < NEWTON_ROUNDS && worse < PATIENCE; round++) {
        const double limit = match(s, &p, s->samples, 1, KEPT_LAST);
        worse = p.score < best->score ? 0 : worse + 1;
        *best = p.score < best->score ? p : *best;
        newton_step(s, &p, limit);
    }
}

/* All planes roughly, the best ones better, the best one finely: at last to the half that fits best, so that what the
 * two sides do not share does not move it. */
static sl_status find_plane(mirror_search *s, plane *best)
{
    sl_status status = SL_OK;
    plane list[PLANES];
    const int32_t count = list_planes(s, list), finalists = count < FINALISTS ? count : FINALISTS;
    for (int32_t i = 0; i < count; i++) {
        SL_TRY(sl_report_progress(s->context, "near symmetry", 0.5 * i / count));
        fit_plane(s, &list[i], COARSE, COARSE_ROUNDS, KEPT);
    }
    qsort(list, (size_t)count, sizeof *list, compare_planes);
    for (int32_t i = 0; i < finalists; i++) {
        SL_TRY(sl_report_progress(s->context, "near symmetry", 0.5 + 0.1 * i));
        fit_plane(s, &list[i], MIDDLE, MIDDLE_ROUNDS, KEPT);
    }
    qsort(list, (size_t)finalists, sizeof *list, compare_planes);
    *best = list[0];
    fit_plane(s, best, SAMPLES, ROUNDS, KEPT_LAST);
    polish_plane(s, best);
cleanup:
    return status;
}

/* Sums of one chunk of vertices. */
typedef struct chunk_sums {
    double sum, most, n, within;
} chunk_sums;

typedef struct judgement {
    const mirror_search *s;
    const plane *p;
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
            mirror_point(j->p, &j->s->mesh->xyz[3 * v], q);
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
        mirror_point(j->p, c, q);
        const int32_t t = sl_nearest_find(j->s->tree, q, at, &d);
        within += d <= j->near ? j->s->area[f] : 0.0;
        if (j->match != NULL) {
            j->match[f] = j->s->facet[t];
        }
    }
    j->area_matched[chunk] = within;
}

static sl_status judge(const mirror_search *s, const plane *p, double near, int32_t *match, sl_near_mirror *out)
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
    mirror_search s = {.mesh = mesh, .context = context};
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
        plane best;
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
