#include "draw_support.h"

#include <string.h>

enum { W = 61, H = 47 };

/* Oracle: Moeller and Trumbore's intersection in eye space, independent of the rasterizer. Depth, or INFINITY. */
static double cast(const sl_camera *camera, const double *eye[3], double sx, double sy)
{
    double o[3], d[3], e1[3], e2[3], s[3], p[3], q[3];
    sl_camera_ray(camera, W, H, sx, sy, o, d);
    for (int k = 0; k < 3; k++) {
        e1[k] = eye[1][k] - eye[0][k];
        e2[k] = eye[2][k] - eye[0][k];
        s[k] = o[k] - eye[0][k];
    }
    p[0] = d[1] * e2[2] - d[2] * e2[1];
    p[1] = d[2] * e2[0] - d[0] * e2[2];
    p[2] = d[0] * e2[1] - d[1] * e2[0];
    q[0] = s[1] * e1[2] - s[2] * e1[1];
    q[1] = s[2] * e1[0] - s[0] * e1[2];
    q[2] = s[0] * e1[1] - s[1] * e1[0];
    const double det = e1[0] * p[0] + e1[1] * p[1] + e1[2] * p[2];
    const double u = (s[0] * p[0] + s[1] * p[1] + s[2] * p[2]) / det;
    const double v = (d[0] * q[0] + d[1] * q[1] + d[2] * q[2]) / det;
    const double z = (e2[0] * q[0] + e2[1] * q[1] + e2[2] * q[2]) / det;
    const double least = fmin(u, fmin(v, 1.0 - u - v));
    return least >= 0.0 && z > camera->near_depth ? z : (double)INFINITY;
}

/* Is some edge of the projected triangle within 2/256 sample of the position? Ends behind the eye count as near. */
static bool near_edge(const sl_camera *camera, const double *eye[3], double sx, double sy)
{
    for (int k = 0; k < 3; k++) {
        const double *a = eye[k], *b = eye[(k + 1) % 3];
        if (a[2] <= camera->near_depth || b[2] <= camera->near_depth) {
            return true;
        }
        double pa[2], pb[2];
        sl_camera_project(camera, W, H, a, pa);
        sl_camera_project(camera, W, H, b, pb);
        const double dx = pb[0] - pa[0], dy = pb[1] - pa[1], length2 = dx * dx + dy * dy;
        double t = length2 > 0.0 ? ((sx - pa[0]) * dx + (sy - pa[1]) * dy) / length2 : 0.0;
        t = fmin(fmax(t, 0.0), 1.0);
        if (hypot(sx - pa[0] - t * dx, sy - pa[1] - t * dy) < 2.0 / SL_SUBPIXELS) {
            return true;
        }
    }
    return false;
}

static void nearest_triangle_agrees_with_ray_casting(void **state)
{
    (void)state;
    enum { NT = 24 };
    test_rng rng = test_rng_seed(0x4a9ca57);
    int64_t compared = 0, hits = 0;
    for (int trial = 0; trial < 12 * test_multiplier(); trial++) {
        double xyz[9 * NT];
        int32_t tri[3 * NT];
        random_soup(&rng, NT, 0.6, xyz, tri);
        const sl_camera camera = random_camera(&rng, 3 * NT, xyz, (double)W / H);
        sl_screen *screen = NULL;
        assert_int_equal(sl_screen_create(&camera, W, H, 3 * NT, xyz, NT, tri, 8, NULL, &screen), SL_OK);
        uint64_t *zid = draw_all(screen);
        for (int32_t i = 0; i < W * H; i++) {
            double best = INFINITY, second = INFINITY;
            int32_t winner = -1;
            bool unsure = false;
            for (int32_t t = 0; t < NT; t++) {
                const double *eye[3] = {screen->eye + 9 * t, screen->eye + 9 * t + 3, screen->eye + 9 * t + 6};
                const double sx = i % W + 0.5, sy = i / W + 0.5;
                const double z = cast(&camera, eye, sx, sy);
                unsure = unsure || near_edge(&camera, eye, sx, sy);
                second = z < best ? best : fmin(second, z);
                winner = z < best ? t : winner;
                best = fmin(best, z);
            }
            if (!unsure && (winner < 0 || second - best > 0.02)) { /* the corners are snapped: depths too */
                assert_int_equal(sl_visible_triangle(zid[i]), winner);
                compared++;
                hits += winner >= 0 ? 1 : 0;
                if (winner >= 0) {
                    const double z = (sl_visible_key(zid[i]) - screen->key_offset) / screen->key_scale;
                    assert_true(test_near(camera.perspective ? 1.0 / z : z, best, 0.05));
                }
            }
        }
        sl_free(zid);
        sl_screen_free(screen);
    }
    assert_true(compared > 10000 && hits > 3000);
}

/* A jittered grid of quads, each cut along either diagonal: every sample inside the outline belongs to exactly one
 * triangle. Each triangle is drawn alone; corners on sample centres and on the grid of snapped positions are likely. */
static void edge_sharing_triangles_cover_each_sample_once(void **state)
{
    (void)state;
    enum { N = 7, NV = (N + 1) * (N + 1), NT = 2 * N * N };
    test_rng rng = test_rng_seed(0x3a7e4);
    for (int trial = 0; trial < 20 * test_multiplier(); trial++) {
        double xyz[3 * NV];
        int32_t tri[3 * NT], nt = 0;
        for (int i = 0; i < NV; i++) {
            const bool inner = i % (N + 1) > 0 && i % (N + 1) < N && i / (N + 1) > 0 && i / (N + 1) < N;
            const double jitter = trial % 2 == 0 ? 0.4 : 0.0; /* 0: corners straight on samples */
            xyz[3 * i] = 5.5 + 7.0 * (i % (N + 1)) + (inner ? jitter * test_uniform(&rng, -7.0, 7.0) : 0.0);
            xyz[3 * i + 1] = 3.5 + 6.0 * (i / (N + 1)) + (inner ? jitter * test_uniform(&rng, -6.0, 6.0) : 0.0);
            xyz[3 * i + 2] = 0.0;
        }
        for (int q = 0; q < N * N; q++) {
            const int32_t a = q / N * (N + 1) + q % N, b = a + 1, c = a + N + 2, d = a + N + 1;
            const int32_t one[2][6] = {{a, b, c, a, c, d}, {a, b, d, c, d, b}};
            memcpy(tri + 3 * nt, one[test_index(&rng, 2)], sizeof one[0]);
            nt += 2;
        }
        const sl_camera plan = sl_camera_plan(0.0, 0.0, H, (double)W / H);
        int32_t count[W * H] = {0};
        for (int32_t t = 0; t < nt; t++) {
            sl_screen *screen = NULL;
            assert_int_equal(sl_screen_create(&plan, W, H, NV, xyz, 1, tri + 3 * t, 16, NULL, &screen), SL_OK);
            uint64_t *zid = draw_all(screen);
            for (int i = 0; i < W * H; i++) {
                count[i] += zid[i] != SL_NOTHING ? 1 : 0;
            }
            sl_free(zid);
            sl_screen_free(screen);
        }
        /* Outline: x in [5.5, 54.5], y in [3.5, 45.5] upwards; samples on its top and left belong to it. Folded cells
         * (jitter over half a cell) may cover more often, so they are only asked to leave no hole. */
        for (int i = 0; i < W * H; i++) {
            const double x = i % W + 0.5, y = H - (i / W + 0.5);
            const bool inside = x >= 5.5 && x < 54.5 && y > 3.5 && y <= 45.5;
            if (trial % 2 == 1) {
                assert_int_equal(count[i], inside ? 1 : 0);
            } else {
                assert_true(inside ? count[i] >= 1 : count[i] == 0);
                assert_int_equal(count[i] % 2, inside ? 1 : 0); /* folds cover three times, five times, ... */
            }
        }
    }
}

static void the_two_halves_of_a_random_quad_never_share_or_miss_a_sample(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x9ad);
    const sl_camera plan = sl_camera_plan(0.0, 0.0, H, (double)W / H);
    for (int trial = 0; trial < 300 * test_multiplier(); trial++) {
        /* A convex quad: corners in order on an ellipse; its two triangulations cover the same samples. */
        double xyz[12], angle[4];
        for (int k = 0; k < 4; k++) {
            angle[k] = 0.5 * TEST_PI * (k + test_uniform(&rng, 0.05, 0.95));
            const bool whole = trial % 3 == 0; /* corners on sample centres: ties everywhere */
            const double x = W / 2 + 25.0 * cos(angle[k]), y = H / 2 + 20.0 * sin(angle[k]);
            xyz[3 * k] = whole ? rint(x) + 0.5 : x;
            xyz[3 * k + 1] = whole ? rint(y) + 0.5 : y;
            xyz[3 * k + 2] = 0.0;
        }
        static const int32_t tri[4][3] = {{0, 1, 2}, {0, 2, 3}, {1, 2, 3}, {1, 3, 0}};
        int32_t count[2][W * H] = {{0}};
        for (int t = 0; t < 4; t++) {
            sl_screen *screen = NULL;
            assert_int_equal(sl_screen_create(&plan, W, H, 4, xyz, 1, tri[t], 16, NULL, &screen), SL_OK);
            uint64_t *zid = draw_all(screen);
            for (int i = 0; i < W * H; i++) {
                count[t / 2][i] += zid[i] != SL_NOTHING ? 1 : 0;
            }
            sl_free(zid);
            sl_screen_free(screen);
        }
        for (int i = 0; i < W * H; i++) {
            assert_true(count[0][i] <= 1);
            assert_int_equal(count[0][i], count[1][i]);
        }
    }
}

static void a_window_holds_the_same_words_as_the_whole_picture(void **state)
{
    (void)state;
    enum { NT = 40 };
    test_rng rng = test_rng_seed(0x817d0);
    double xyz[9 * NT];
    int32_t tri[3 * NT];
    random_soup(&rng, NT, 0.5, xyz, tri);
    for (int trial = 0; trial < 20; trial++) {
        const sl_camera camera = random_camera(&rng, 3 * NT, xyz, (double)W / H);
        sl_screen *screen = NULL, *other = NULL;
        assert_int_equal(sl_screen_create(&camera, W, H, 3 * NT, xyz, NT, tri, 5, NULL, &screen), SL_OK);
        assert_int_equal(sl_screen_create(&camera, W, H, 3 * NT, xyz, NT, tri, 64, NULL, &other), SL_OK);
        uint64_t *zid = draw_all(screen), part[W * H];
        const int32_t x0 = test_index(&rng, W), y0 = test_index(&rng, H);
        sl_visibility window = {x0, y0, 1 + test_index(&rng, W - x0), 1 + test_index(&rng, H - y0), part};
        sl_visibility_draw(other, &window);
        for (int32_t i = 0; i < window.width * window.height; i++) {
            assert_true(part[i] == zid[(y0 + i / window.width) * W + x0 + i % window.width]);
        }
        sl_free(zid);
        sl_screen_free(screen);
        sl_screen_free(other);
    }
}

static void equally_near_triangles_show_the_lower_number(void **state)
{
    (void)state;
    const double xyz[9] = {2.3, 3.1, 0, 50.2, 6.6, 0, 20.9, 44.4, 0};
    const int32_t tri[9] = {0, 1, 2, 1, 2, 0, 2, 1, 0};
    const sl_camera plan = sl_camera_plan(0.0, 0.0, H, (double)W / H);
    sl_screen *screen = NULL;
    assert_int_equal(sl_screen_create(&plan, W, H, 3, xyz, 3, tri, 16, NULL, &screen), SL_OK);
    uint64_t *zid = draw_all(screen);
    for (int i = 0; i < W * H; i++) {
        assert_true(sl_visible_triangle(zid[i]) <= 0);
    }
    sl_free(zid);
    sl_screen_free(screen);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nearest_triangle_agrees_with_ray_casting),
        cmocka_unit_test(edge_sharing_triangles_cover_each_sample_once),
        cmocka_unit_test(the_two_halves_of_a_random_quad_never_share_or_miss_a_sample),
        cmocka_unit_test(a_window_holds_the_same_words_as_the_whole_picture),
        cmocka_unit_test(equally_near_triangles_show_the_lower_number),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
