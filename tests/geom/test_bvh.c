#include "geom/bvh.h"

#include "base/memory.h"
#include "geom/vec3.h"
#include "support/test_support.h"

#include <math.h>

enum { MOST = 3000 };

static double xyz[9 * MOST];
static int32_t tri[3 * MOST];

/* The oracle: every triangle by solving  origin + t d = a + u (b - a) + v (c - a)  by Cramer's rule. margin: how far
 * from an edge the point is, < 0 outside. */
static bool solve(const sl_ray *ray, int32_t t, sl_ray_hit *hit, double *margin)
{
    const double *a = xyz + 3 * tri[3 * t], *b = xyz + 3 * tri[3 * t + 1], *c = xyz + 3 * tri[3 * t + 2];
    double e[3], f[3], p[3], q[3], s[3];
    sl_vec3_sub(b, a, e);
    sl_vec3_sub(c, a, f);
    sl_vec3_sub(ray->origin, a, s);
    sl_vec3_cross(ray->direction, f, p);
    const double det = sl_vec3_dot(e, p);
    if (fabs(det) < 1e-14 * sl_vec3_norm(e) * sl_vec3_norm(f) * sl_vec3_norm(ray->direction)) {
        *margin = 0.0;
        return false;
    }
    sl_vec3_cross(s, e, q);
    *hit = (sl_ray_hit){t, sl_vec3_dot(f, q) / det, sl_vec3_dot(s, p) / det, sl_vec3_dot(ray->direction, q) / det};
    *margin = fmin(fmin(hit->u, hit->v), 1.0 - hit->u - hit->v);
    return *margin >= 0.0 && hit->t > ray->near && hit->t < ray->far;
}

/* Whether the answer hangs on rounding: an edge is as good as met, or an end of the ray. */
static bool is_close_call(const sl_ray *ray, const sl_ray_hit *hit, double margin)
{
    return fabs(margin) < 1e-9 || fabs(hit->t - ray->near) < 1e-9 || fabs(hit->t - ray->far) < 1e-9;
}

static bool brute_force(const sl_ray *ray, int32_t nt, sl_ray_hit *best, bool *close)
{
    best->triangle = -1;
    *close = false;
    for (int32_t t = 0; t < nt; t++) {
        sl_ray_hit hit = {.t = HUGE_VAL};
        double margin;
        const bool met = t != ray->skip && solve(ray, t, &hit, &margin);
        *close = *close || (t != ray->skip && is_close_call(ray, &hit, margin));
        if (met && (best->triangle < 0 || hit.t < best->t)) {
            *best = hit;
        }
    }
    return best->triangle >= 0;
}

static void random_point(test_rng *rng, double size, double p[3])
{
    for (int k = 0; k < 3; k++) {
        p[k] = test_uniform(rng, -size, size);
    }
}

/* Triangles of all sizes and shapes about random places, some long slivers, in a box of side 2. */
static void make_soup(test_rng *rng, int32_t nt)
{
    for (int32_t t = 0; t < nt; t++) {
        double at[3];
        const double size = exp(test_uniform(rng, -6.0, 0.0));
        random_point(rng, 1.0, at);
        for (int k = 0; k < 3; k++) {
            double *p = xyz + 9 * t + 3 * k;
            random_point(rng, k == 2 && t % 5 == 0 ? 0.01 * size : size, p);
            sl_vec3_add(p, k == 2 && t % 5 == 0 ? xyz + 9 * t : at, p);
            tri[3 * t + k] = 3 * t + k;
        }
    }
}

static sl_ray make_ray(test_rng *rng, int32_t nt)
{
    sl_ray ray = {.near = test_index(rng, 2) == 0 ? 0.0 : test_uniform(rng, -1.0, 0.5),
                  .far = test_index(rng, 2) == 0 ? HUGE_VAL : test_uniform(rng, 0.5, 2.0),
                  .skip = nt > 0 && test_index(rng, 2) == 0 ? test_index(rng, nt) : -1};
    const double distance = exp(test_uniform(rng, -2.0, 4.0)), length = exp(test_uniform(rng, -3.0, 3.0));
    random_point(rng, distance, ray.origin);
    double to[3];
    random_point(rng, 1.0, to);
    sl_vec3_sub(to, ray.origin, ray.direction);
    for (int k = 0; k < 3; k++) {
        ray.direction[k] *= length;
        ray.direction[k] = test_index(rng, 12) == 0 ? 0.0 : ray.direction[k];
    }
    return ray;
}

static sl_bvh *build(int32_t nt)
{
    sl_bvh *bvh = NULL;
    assert_int_equal(sl_bvh_create(xyz, nt, tri, &bvh), SL_OK);
    return bvh;
}

static void rays_meet_what_trying_every_triangle_finds(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xb44);
    static const int32_t size[] = {0, 1, 2, 5, 17, 300, 2500};
    int32_t met = 0, missed = 0, unclear = 0;
    for (int trial = 0; trial < 14 * test_multiplier(); trial++) {
        const int32_t nt = size[trial % 7];
        make_soup(&rng, nt);
        sl_bvh *bvh = build(nt);
        for (int k = 0; k < 300; k++) {
            const sl_ray ray = make_ray(&rng, nt);
            sl_ray_hit expected = {0}, hit = {.triangle = -7};
            bool close;
            const bool found = brute_force(&ray, nt, &expected, &close);
            const bool first = sl_bvh_first(bvh, &ray, &hit);
            assert_true(sl_bvh_any(bvh, &ray) == first);
            if (close) {
                unclear++;
                continue;
            }
            assert_true(first == found);
            assert_true(found || hit.triangle == -7);
            if (found) {
                const double tol = 1e-9 * (1.0 + fabs(expected.t));
                assert_int_equal(hit.triangle, expected.triangle);
                assert_true(test_near(hit.t, expected.t, tol) && test_near(hit.u, expected.u, 1e-6) &&
                            test_near(hit.v, expected.v, 1e-6));
            }
            met += found;
            missed += !found;
        }
        sl_bvh_free(bvh);
    }
    assert_true(met > 500 && missed > 300 && unclear < met / 20);
}

/* A closed bumpy ball of n x 2n quads, cut in triangles; from inside there is no way out. */
static int32_t make_ball(test_rng *rng, int32_t n)
{
    int32_t nv = 0, nt = 0;
    for (int32_t i = 0; i <= n; i++) {
        for (int32_t k = 0; k < 2 * n; k++) {
            const double a = TEST_PI * i / n, b = TEST_PI * k / n, r = 1.0 + test_uniform(rng, 0.0, 0.3);
            const bool pole = i == 0 || i == n;
            xyz[3 * nv] = pole ? 0.0 : r * sin(a) * cos(b);
            xyz[3 * nv + 1] = pole ? 0.0 : r * sin(a) * sin(b);
            xyz[3 * nv + 2] = pole ? cos(a) : r * cos(a);
            nv++;
        }
    }
    for (int32_t i = 0; i < n; i++) {
        for (int32_t k = 0; k < 2 * n; k++) {
            const int32_t a = 2 * n * i + k, b = 2 * n * i + (k + 1) % (2 * n);
            const int32_t corner[6] = {a, a + 2 * n, b + 2 * n, a, b + 2 * n, b};
            for (int c = 0; c < 6; c++) {
                tri[3 * nt + c] = corner[c];
            }
            nt += 2;
        }
    }
    return nt;
}

/* Rays straight at vertices and points of edges: the hard case. */
static void no_ray_slips_out_between_triangles(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xba11);
    const int32_t nt = make_ball(&rng, 16);
    sl_bvh *bvh = build(nt);
    for (int trial = 0; trial < 20000 * test_multiplier(); trial++) {
        sl_ray ray = {.far = HUGE_VAL, .skip = -1};
        const int32_t t = test_index(&rng, nt);
        const double *a = xyz + 3 * tri[3 * t], *b = xyz + 3 * tri[3 * t + 1];
        const double along = trial % 3 == 0 ? 0.0 : test_uniform(&rng, 0.0, 1.0);
        random_point(&rng, 0.3, ray.origin);
        for (int k = 0; k < 3; k++) {
            ray.direction[k] = a[k] + along * (b[k] - a[k]) - ray.origin[k];
        }
        sl_ray_hit hit;
        assert_true(sl_bvh_first(bvh, &ray, &hit));
        assert_true(hit.t > 0.5 && hit.t < 2.5); /* a bump may be in front, or behind the edge of a neighbour */
        assert_true(sl_bvh_any(bvh, &ray));
    }
    sl_bvh_free(bvh);
}

/* The same picture from far away and in other units: rounding of the boxes' coordinates must not lose anything. */
static void far_origins_and_odd_units_lose_nothing(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xfa2);
    static const double unit[] = {1.0, 1e-30, 1e30, 1e-140, 1e140};
    for (int u = 0; u < 5; u++) {
        const int32_t nt = make_ball(&rng, 9);
        for (int32_t i = 0; i < 3 * 18 * 10; i++) {
            xyz[i] = (xyz[i] + (i % 3 == 0 ? 1000.0 : 0.0)) * unit[u];
        }
        sl_bvh *bvh = build(nt);
        for (int trial = 0; trial < 500 * test_multiplier(); trial++) {
            sl_ray ray = {.far = HUGE_VAL, .skip = -1};
            double target[3];
            const double away = exp(test_uniform(&rng, 1.0, 9.0));
            random_point(&rng, 0.4, target);
            random_point(&rng, 1.0, ray.direction);
            target[0] += 1000.0;
            const double length = sl_vec3_norm(ray.direction);
            for (int k = 0; k < 3; k++) {
                ray.direction[k] *= unit[u] / length;
                ray.origin[k] = target[k] * unit[u] - away * ray.direction[k];
            }
            sl_ray_hit hit;
            assert_true(sl_bvh_first(bvh, &ray, &hit));
            assert_true(hit.t > away - 2.1 && hit.t < away);
            ray.far = away - 2.1;
            assert_false(sl_bvh_any(bvh, &ray));
            ray.far = HUGE_VAL;
            ray.near = away + 2.1;
            assert_false(sl_bvh_any(bvh, &ray));
        }
        sl_bvh_free(bvh);
    }
}

/* All in one place, in one plane, in one line, and spaced so unevenly that bins are of no use. */
static void odd_sets_of_triangles_build_and_answer(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x0dd);
    for (int kind = 0; kind < 4; kind++) {
        make_soup(&rng, MOST);
        for (int32_t v = 0; v < 3 * MOST; v++) {
            double *p = xyz + 3 * v;
            const double place = ldexp(1.0, -(v / 3) / 40);
            p[0] = kind == 0 ? xyz[3 * (v % 3)] : kind == 3 ? place * (2.0 + 0.1 * p[0]) : p[0];
            p[1] = kind == 0 ? xyz[3 * (v % 3) + 1] : kind == 2 ? 0.25 : kind == 3 ? 0.01 * place * p[1] : p[1];
            p[2] = kind == 0 ? xyz[3 * (v % 3) + 2] : kind == 3 ? 0.01 * place * p[2] : 0.5;
        }
        sl_bvh *bvh = build(MOST);
        for (int32_t t = 0; t < MOST; t += 7) { /* straight at the triangle's middle, from in front of it */
            sl_ray ray = {.far = HUGE_VAL, .skip = -1};
            double e[3], f[3], n[3], c[3] = {0};
            for (int k = 0; k < 9; k++) {
                c[k % 3] += xyz[9 * t + k] / 3.0;
            }
            sl_vec3_sub(xyz + 9 * t + 3, xyz + 9 * t, e);
            sl_vec3_sub(xyz + 9 * t + 6, xyz + 9 * t, f);
            sl_vec3_cross(e, f, n);
            const double area = sl_vec3_norm(n), size = sl_vec3_norm(e);
            sl_ray_hit hit = {.t = -1.0};
            for (int k = 0; k < 3; k++) {
                ray.direction[k] = area > 0.0 ? -size * n[k] / area : k == 1;
                ray.origin[k] = c[k] - ray.direction[k];
            }
            const bool found = sl_bvh_first(bvh, &ray, &hit);
            if (kind == 2) {
                assert_false(found); /* no area */
            } else {
                assert_true(found && hit.t <= 1.0 + 1e-9);
                assert_true(kind != 0 || hit.triangle == 0); /* of equal ones the first */
            }
        }
        sl_bvh_free(bvh);
    }
}

static void what_is_not_finite_is_left_out_and_rays_without_direction_meet_nothing(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xfab);
    static const double odd[] = {NAN, INFINITY, -INFINITY, 1e200};
    const int32_t nt = make_ball(&rng, 8);
    for (int32_t t = 0; t < 4; t++) { /* of their own points */
        for (int k = 0; k < 9; k++) {
            xyz[3 * (9 * 16) + 9 * t + k] = test_uniform(&rng, -0.1, 0.1);
        }
        xyz[3 * (9 * 16) + 9 * t + test_index(&rng, 9)] = odd[t];
        for (int k = 0; k < 3; k++) {
            tri[3 * (nt + t) + k] = 9 * 16 + 3 * t + k;
        }
    }
    sl_bvh *bvh = build(nt + 4);
    for (int trial = 0; trial < 300; trial++) {
        sl_ray ray = {.far = HUGE_VAL, .skip = -1};
        sl_ray_hit hit;
        random_point(&rng, 1.0, ray.direction);
        assert_true(sl_bvh_first(bvh, &ray, &hit) && hit.triangle < nt);
        ray.direction[0] = ray.direction[1] = ray.direction[2] = 0.0;
        assert_false(sl_bvh_any(bvh, &ray));
    }
    sl_bvh_free(bvh);
    sl_bvh_free(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rays_meet_what_trying_every_triangle_finds),
        cmocka_unit_test(no_ray_slips_out_between_triangles),
        cmocka_unit_test(far_origins_and_odd_units_lose_nothing),
        cmocka_unit_test(odd_sets_of_triangles_build_and_answer),
        cmocka_unit_test(what_is_not_finite_is_left_out_and_rays_without_direction_meet_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
