/* Fitting a mirror plane to a surface. Source: Besl & McKay 1992 (nearest points); Chen & Medioni 1992 (distances along
 * the normals); both with a mirror in the place of a rotation. */
#include "symmetry/near_internal.h"
#include "symmetry/rigid.h"

#include <stdlib.h>
#include <string.h>

enum {
    CHUNK = 128,
    NEWTON_ROUNDS = 30,
    PATIENCE = 4 /* rounds without gain */
};

static const double SETTLED = 1e-13; /* change of a normal that ends the fit */
static const double SLIDES = 1e-9;   /* eigenvalue of the normal equations, over the largest */

typedef struct matching {
    sl_mirror_search *s;
    const sl_mirror_plane *p;
    int32_t stride;
} matching;

static void match_samples(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    (void)chunk;
    const matching *m = user;
    for (int64_t i = begin; i < end; i++) {
        double q[3];
        sl_mirror_point(m->p, &m->s->sample[3 * i * m->stride], q);
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
static double match(sl_mirror_search *s, sl_mirror_plane *p, int32_t count, int32_t stride, double kept)
{
    matching m = {s, p, stride};
    sl_parallel_for(s->context, count, CHUNK, match_samples, &m);
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
static double refit(sl_mirror_search *s, sl_mirror_plane *p, int32_t count, int32_t stride, double kept)
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

void sl_mirror_fit(sl_mirror_search *s, sl_mirror_plane *p, int32_t samples, int32_t rounds, double kept)
{
    const int32_t stride = s->samples > samples ? s->samples / samples : 1, count = (s->samples - 1) / stride + 1;
    double change = HUGE_VAL;
    for (int32_t round = 0; round < rounds && change > SETTLED; round++) {
        change = refit(s, p, count, stride, kept);
    }
}

/* Unit normal of the triangle that sample i was matched to; 0 for none. */
static void surface_normal(const sl_mirror_search *s, int32_t i, double normal[3])
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
static void assemble(const sl_mirror_search *s, const sl_mirror_plane *p, double limit, const double frame[9],
                     double N[9], double g[3])
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
        sl_mirror_point(p, x, gap);
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
static void newton_step(const sl_mirror_search *s, sl_mirror_plane *p, double limit)
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

void sl_mirror_polish(sl_mirror_search *s, sl_mirror_plane *best, double kept)
{
    sl_mirror_plane p = *best;
    int32_t worse = 0;
    best->score = HUGE_VAL;
    for (int32_t round = 0; round < NEWTON_ROUNDS && worse < PATIENCE; round++) {
        const double limit = match(s, &p, s->samples, 1, kept);
        worse = p.score < best->score ? 0 : worse + 1;
        *best = p.score < best->score ? p : *best;
        newton_step(s, &p, limit);
    }
}
