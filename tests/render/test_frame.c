#include "render/frame_support.h"

/* Nearest triangle by the ray through a pixel's centre; -2 where an edge is so near that rounding decides. */
static int32_t trace(const torus_frame *t, int32_t width, int32_t height, int32_t x, int32_t y, double bary[3])
{
    double origin[3], direction[3], nearest = INFINITY;
    int32_t found = -1;
    bool close = false;
    sl_camera_ray(&t->camera, width, height, x + 0.5, y + 0.5, origin, direction);
    for (int32_t i = 0; i < t->triangulation->nt; i++) {
        double p[3][3], b[3], z = 0.0;
        for (int k = 0; k < 3; k++) {
            sl_camera_to_eye(&t->camera, t->mesh->xyz + 3 * t->tri[3 * i + k], p[k]);
        }
        double sum = 0.0, least = INFINITY, most = -INFINITY; /* on the plane z = 1 of the picture */
        for (int k = 0; k < 3; k++) {
            const double *q = p[(k + 1) % 3], *r = p[(k + 2) % 3];
            b[k] = ((q[0] / q[2] - direction[0]) * (r[1] / r[2] - direction[1]) -
                    (r[0] / r[2] - direction[0]) * (q[1] / q[2] - direction[1])) /
                   p[k][2];
            sum += b[k];
        }
        for (int k = 0; k < 3; k++) {
            b[k] /= sum;
            least = fmin(least, b[k]);
            most = fmax(most, b[k]);
            z += b[k] * p[k][2];
        }
        if (least > -0.04 && most < 1.04 && z < nearest + 1e-3) {
            close = close || least < 0.04;
        }
        if (least >= 0.0 && z < nearest) {
            nearest = z;
            found = i;
            memcpy(bary, b, sizeof b);
        }
    }
    return close ? -2 : found;
}

static void picking_finds_the_triangle_that_a_ray_meets_first(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x91c);
    int32_t compared = 0, empty = 0;
    for (int trial = 0; trial < 3; trial++) {
        torus_frame t = open_torus(test_uniform(&rng, 0.0, 360.0));
        const sl_frame_style style = sl_frame_style_default();
        const int32_t width = 390, height = 300;
        uint8_t *rgba = sl_alloc(width * height, 4);
        assert_int_equal(sl_frame_draw(t.frame, &t.camera, &style, width, height, NULL, rgba), SL_OK);
        for (int i = 0; i < 300 * test_multiplier(); i++) {
            const int32_t x = test_index(&rng, width), y = test_index(&rng, height);
            double bary[3];
            const int32_t expected = trace(&t, width, height, x, y, bary);
            const sl_frame_hit hit = sl_frame_pick(t.frame, x, y);
            if (expected == -2) {
                continue;
            }
            assert_int_equal(hit.triangle, expected);
            compared += expected >= 0;
            empty += expected < 0;
            for (int k = 0; k < 3 && expected >= 0; k++) {
                assert_true(fabs(hit.bary[k] - bary[k]) < 1e-9);
            }
        }
        assert_int_equal(sl_frame_pick(t.frame, -1, 3).triangle, -1);
        assert_int_equal(sl_frame_pick(t.frame, 3, height).triangle, -1);
        sl_free(rgba);
        close_torus(&t);
    }
    assert_true(compared > 100 && empty > 50);
}

static void a_frame_has_the_same_bytes_for_any_number_of_threads(void **state)
{
    (void)state;
    torus_frame t = open_torus(77.0);
    const int32_t lines[] = {3, 4, 4, 5, 5, 45, 200, 201, 201, 202};
    const uint8_t ink[3] = {20, 20, 120};
    assert_int_equal(sl_frame_set_lines(t.frame, 2, 5, lines, ink, 2.3), SL_OK);
    uint8_t *first = sl_alloc(SIDE * SIDE, 4), *again = sl_alloc(SIDE * SIDE, 4);
    for (int flat = 0; flat < 2; flat++) {
        sl_frame_style style = sl_frame_style_default();
        style.flat = flat != 0;
        assert_int_equal(sl_frame_draw(t.frame, &t.camera, &style, SIDE, SIDE, NULL, first), SL_OK);
        for (int32_t workers = 1; workers <= 5; workers++) {
            sl_thread_pool *pool = NULL;
            assert_int_equal(sl_thread_pool_create(workers, &pool), SL_OK);
            const sl_context context = {.executor = sl_thread_pool_executor(pool)};
            memset(again, workers, 4 * SIDE * SIDE);
            assert_int_equal(sl_frame_draw(t.frame, &t.camera, &style, SIDE, SIDE, &context, again), SL_OK);
            assert_memory_equal(first, again, 4 * SIDE * SIDE);
            sl_thread_pool_free(pool);
        }
    }
    sl_free(first);
    sl_free(again);
    close_torus(&t);
}

static int32_t count_hits(const sl_frame *frame, int32_t width, int32_t height)
{
    int32_t hits = 0;
    for (int32_t i = 0; i < width * height; i++) {
        hits += sl_frame_pick(frame, i % width, i / width).triangle >= 0;
    }
    return hits;
}

/* Inside a closed surface there is something wherever one looks, also where triangles reach behind the eye. */
static void from_inside_of_a_cube_every_pixel_shows_a_wall(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xc0be);
    double xyz[24];
    static const int32_t quad[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                       {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    int32_t tri[36];
    for (int i = 0; i < 24; i++) {
        xyz[i] = (i / 3 >> (i % 3) & 1) != 0 ? 1.0 : 0.0;
    }
    for (int f = 0; f < 6; f++) {
        const int32_t two[6] = {quad[f][0], quad[f][1], quad[f][2], quad[f][0], quad[f][2], quad[f][3]};
        memcpy(tri + 6 * f, two, sizeof two);
    }
    const sl_frame_def def = {8, 12, xyz, tri, NULL, NULL};
    sl_frame *frame = NULL;
    assert_int_equal(sl_frame_create(&def, &frame), SL_OK);
    uint8_t rgba[4 * 60 * 40];
    sl_frame_style style = sl_frame_style_default();
    for (int trial = 0; trial < 50 * test_multiplier(); trial++) {
        sl_view view = sl_view_default();
        sl_camera camera;
        view.azimuth = test_uniform(&rng, 0.0, 360.0);
        view.elevation = test_uniform(&rng, -80.0, 80.0);
        view.fov = 70.0;
        assert_int_equal(sl_camera_frame(&view, 1.5, 8, NULL, xyz, &camera), SL_OK);
        for (int k = 0; k < 3; k++) {
            camera.eye[k] = test_uniform(&rng, 0.2, 0.8);
        }
        camera.near_depth = 1e-3;
        style.cull = false;
        assert_int_equal(sl_frame_draw(frame, &camera, &style, 60, 40, NULL, rgba), SL_OK);
        assert_int_equal(count_hits(frame, 60, 40), 60 * 40);
        style.cull = true; /* the walls turn their backs */
        assert_int_equal(sl_frame_draw(frame, &camera, &style, 60, 40, NULL, rgba), SL_OK);
        assert_int_equal(count_hits(frame, 60, 40), 0);
    }
    sl_frame_free(frame);
}

/* Pixel centres on edges and corners: a triangle owns those that a step to the right, and a far smaller one down, takes
 * inside (the top-left rule). Small triangles and large ones, partly beside the picture. */
static void pixels_on_edges_belong_to_the_triangle_below_and_right(void **state)
{
    (void)state;
    enum { WIDE = 128 };
    test_rng rng = test_rng_seed(0x70b);
    const sl_camera camera = sl_camera_plan(0.0, 0.0, 1.0, 1.0);
    const sl_frame_style style = sl_frame_style_default();
    static const int32_t tri[3] = {0, 1, 2};
    uint8_t *rgba = sl_alloc(WIDE * WIDE, 4);
    int32_t large = 0;
    for (int trial = 0; trial < 150 * test_multiplier(); trial++) {
        double xyz[9], p[3][2];
        const int32_t reach = trial % 3 == 0 ? 8 : 100;
        const int32_t base[2] = {test_index(&rng, 60) - 10, test_index(&rng, 60) - 10};
        for (int k = 0; k < 3; k++) {
            p[k][0] = base[0] + test_index(&rng, reach);
            p[k][1] = trial % 4 == 1 && k == 1 ? p[0][1] : base[1] + test_index(&rng, reach);
            xyz[3 * k] = (p[k][0] + 0.5) / WIDE;
            xyz[3 * k + 1] = 1.0 - (p[k][1] + 0.5) / WIDE;
            xyz[3 * k + 2] = 0.1 * k;
        }
        const sl_frame_def def = {3, 1, xyz, tri, NULL, NULL};
        sl_frame *frame = NULL;
        assert_int_equal(sl_frame_create(&def, &frame), SL_OK);
        assert_int_equal(sl_frame_draw(frame, &camera, &style, WIDE, WIDE, NULL, rgba), SL_OK);
        for (int32_t i = 0; i < WIDE * WIDE; i++) {
            const double x = i % WIDE + 1e-2, y = i / WIDE + 1e-5;
            int32_t left = 0, right = 0;
            for (int k = 0; k < 3; k++) {
                const double *a = p[k], *b = p[(k + 1) % 3];
                const double side = (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
                left += side > 0.0;
                right += side < 0.0;
            }
            assert_int_equal(sl_frame_pick(frame, i % WIDE, i / WIDE).triangle, left == 3 || right == 3 ? 0 : -1);
        }
        large += reach == 100;
        sl_frame_free(frame);
    }
    assert_true(large > 50);
    sl_free(rgba);
}

static void culling_changes_no_pixel_of_a_closed_surface(void **state)
{
    (void)state;
    torus_frame t = open_torus(200.0);
    sl_frame_style style = sl_frame_style_default();
    uint8_t *all = sl_alloc(SIDE * SIDE, 4), *front = sl_alloc(SIDE * SIDE, 4);
    assert_int_equal(sl_frame_draw(t.frame, &t.camera, &style, SIDE, SIDE, NULL, all), SL_OK);
    style.cull = true;
    assert_int_equal(sl_frame_draw(t.frame, &t.camera, &style, SIDE, SIDE, NULL, front), SL_OK);
    int32_t different = 0;
    for (int32_t i = 0; i < SIDE * SIDE; i++) {
        different += memcmp(all + 4 * i, front + 4 * i, 4) != 0;
    }
    assert_true(different < 20); /* where a facet is seen edge-on at the outline */
    sl_free(all);
    sl_free(front);
    close_torus(&t);
}

/* Two squares, one before the other; a line between them is hidden by the nearer one only. */
static void lines_are_hidden_by_what_is_nearer(void **state)
{
    (void)state;
    static const double xyz[] = {-1,  -1,   0,  0,   -1,  0,  0,    1,   0,  -1,   1,    0,    -1.2, -1.2, -1,
                                 1.2, -1.2, -1, 1.2, 1.2, -1, -1.2, 1.2, -1, -0.9, 0.05, -0.5, 0.9,  0.05, -0.5};
    static const int32_t tri[] = {0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7};
    const sl_frame_def def = {10, 4, xyz, tri, NULL, NULL};
    const sl_camera camera = {.eye = {0, 0, 5},
                              .right = {1, 0, 0},
                              .up = {0, 1, 0},
                              .forward = {0, 0, -1},
                              .centre = {0.5, 0.5},
                              .focal = 2.0,
                              .near_depth = 0.1,
                              .perspective = true};
    static const int32_t pair[] = {8, 9};
    static const uint8_t red[3] = {255, 0, 0};
    sl_frame *frame = NULL;
    uint8_t bare[4 * 101 * 101], lined[4 * 101 * 101];
    const sl_frame_style style = sl_frame_style_default();
    assert_int_equal(sl_frame_create(&def, &frame), SL_OK);
    assert_int_equal(sl_frame_draw(frame, &camera, &style, 101, 101, NULL, bare), SL_OK);
    assert_int_equal(sl_frame_set_lines(frame, 0, 1, pair, red, 2.0), SL_OK);
    assert_int_equal(sl_frame_draw(frame, &camera, &style, 101, 101, NULL, lined), SL_OK);
    int32_t left = 0, right = 0;
    for (int32_t i = 0; i < 101 * 101; i++) {
        const bool changed = memcmp(bare + 4 * i, lined + 4 * i, 4) != 0;
        left += changed && i % 101 < 48;
        right += changed && i % 101 > 52;
    }
    assert_int_equal(left, 0);
    assert_true(right > 40 && right < 300);
    assert_int_equal(sl_frame_set_lines(frame, 0, 0, NULL, red, 2.0), SL_OK);
    assert_int_equal(sl_frame_draw(frame, &camera, &style, 101, 101, NULL, lined), SL_OK);
    assert_memory_equal(bare, lined, sizeof bare);
    sl_frame_free(frame);
}

/* The picture of a segment in front of the near plane, in pixels relative to pixel centres; the ends in either order.
 */
static bool project_segment(const sl_camera *camera, int32_t side, const double p[3], const double q[3],
                            double end[2][2])
{
    double eye[2][3];
    sl_camera_to_eye(camera, p, eye[0]);
    sl_camera_to_eye(camera, q, eye[1]);
    const int behind = eye[0][2] < eye[1][2] ? 0 : 1, front = 1 - behind;
    if (eye[front][2] < camera->near_depth) {
        return false;
    }
    if (eye[behind][2] < camera->near_depth) {
        const double part = (camera->near_depth - eye[front][2]) / (eye[behind][2] - eye[front][2]);
        for (int k = 0; k < 3; k++) {
            eye[behind][k] = eye[front][k] + part * (eye[behind][k] - eye[front][k]);
        }
    }
    for (int i = 0; i < 2; i++) {
        sl_camera_project(camera, side, side, eye[i], end[i]);
        end[i][0] -= 0.5;
        end[i][1] -= 0.5;
    }
    return true;
}

static double distance_to_segment(double x, double y, double end[2][2])
{
    const double dx = end[1][0] - end[0][0], dy = end[1][1] - end[0][1];
    const double part = ((x - end[0][0]) * dx + (y - end[0][1]) * dy) / (dx * dx + dy * dy);
    const double at = fmin(fmax(part, 0.0), 1.0);
    return hypot(x - end[0][0] - at * dx, y - end[0][1] - at * dy);
}

/* Every pixel of the line and no other is inked, wherever its ends are: behind the eye, beside the picture. */
static void lines_are_clipped_at_the_near_plane(void **state)
{
    (void)state;
    static const int32_t pair[] = {0, 1};
    static const uint8_t ink[3] = {0, 0, 0};
    test_rng rng = test_rng_seed(0x11e5);
    uint8_t *rgba = sl_alloc(SIDE * SIDE, 4);
    int32_t crossing = 0, inked = 0;
    for (int trial = 0; trial < 300 * test_multiplier(); trial++) {
        double xyz[6], end[2][2] = {{0.0}};
        for (int k = 0; k < 6; k++) {
            xyz[k] = test_uniform(&rng, -1.0, 1.0) * (trial % 5 == 0 ? 1e4 : 1.0);
        }
        sl_camera camera = {.eye = {0.1, -0.2, 0.3},
                            .right = {0.6, 0.0, 0.8},
                            .up = {0.0, 1.0, 0.0},
                            .forward = {0.8, 0.0, -0.6},
                            .centre = {test_uniform(&rng, -1.0, 2.0), test_uniform(&rng, -1.0, 2.0)},
                            .focal = 0.9,
                            .near_depth = trial % 2 == 0 ? 0.05 : 1e-9,
                            .perspective = true};
        sl_frame *frame = NULL;
        const sl_frame_def def = {2, 0, xyz, NULL, NULL, NULL};
        const sl_frame_style style = sl_frame_style_default();
        assert_int_equal(sl_frame_create(&def, &frame), SL_OK);
        assert_int_equal(sl_frame_set_lines(frame, 0, 1, pair, ink, 2.0), SL_OK);
        assert_int_equal(sl_frame_draw(frame, &camera, &style, SIDE, SIDE, NULL, rgba), SL_OK);
        const bool shown = project_segment(&camera, SIDE, xyz, xyz + 3, end);
        for (int32_t i = 0; i < SIDE * SIDE; i++) {
            const double distance = shown ? distance_to_segment(i % SIDE, i / SIDE, end) : INFINITY;
            assert_true(distance > 0.55 || rgba[4 * i] < 20);
            assert_true(distance < 1.6 || rgba[4 * i] == 246);
            inked += rgba[4 * i] < 20;
        }
        crossing += shown && fabs(end[0][0]) + fabs(end[0][1]) + fabs(end[1][0]) + fabs(end[1][1]) > 1e6;
        sl_frame_free(frame);
    }
    assert_true(crossing > 10 && inked > 1000);
    sl_free(rgba);
}

static void strange_numbers_and_sizes_behave(void **state)
{
    (void)state;
    static const double odd[] = {NAN, INFINITY, -INFINITY, 1e300, 1e-300, 0.0, -3.7e8, 2.0};
    test_rng rng = test_rng_seed(0x0dd);
    double xyz[90], uv[6 * 40];
    int32_t tri[3 * 40];
    uint8_t *rgba = sl_alloc(16384, 4 * 2);
    for (int trial = 0; trial < 200 * test_multiplier(); trial++) {
        for (int i = 0; i < 90; i++) {
            xyz[i] = test_index(&rng, 6) == 0 ? odd[test_index(&rng, 8)] : test_uniform(&rng, -1.0, 1.0);
        }
        for (int i = 0; i < 240; i++) {
            uv[i] = test_index(&rng, 3) == 0 ? odd[test_index(&rng, 8)] : test_uniform(&rng, -1.0, 1.0);
        }
        for (int i = 0; i < 120; i++) {
            tri[i] = test_index(&rng, 30);
        }
        const sl_frame_def def = {30, 40, xyz, tri, uv, NULL};
        sl_frame *frame = NULL;
        sl_view view = sl_view_default();
        sl_camera camera;
        view.fov = trial % 2 != 0 ? 24.0 : 0.0;
        assert_int_equal(sl_camera_frame(&view, 1.0, 30, NULL, xyz, &camera), SL_OK);
        assert_int_equal(sl_frame_create(&def, &frame), SL_OK);
        const sl_frame_style style = sl_frame_style_default();
        const int32_t width = 1 + test_index(&rng, 40), height = 1 + test_index(&rng, 40);
        assert_int_equal(sl_frame_draw(frame, &camera, &style, width, height, NULL, rgba), SL_OK);
        assert_int_equal(sl_frame_draw(frame, &camera, &style, 16384, 2, NULL, rgba), SL_OK);
        assert_int_equal(sl_frame_draw(frame, &camera, &style, 1, 1, NULL, rgba), SL_OK);
        assert_int_equal(sl_frame_draw(frame, &camera, &style, 0, 5, NULL, rgba), SL_BAD_INPUT);
        assert_int_equal(sl_frame_draw(frame, &camera, &style, 5, 16385, NULL, rgba), SL_BAD_INPUT);
        sl_frame_free(frame);
    }
    sl_frame *none = NULL;
    const sl_frame_def empty = {0, 0, NULL, NULL, NULL, NULL};
    const sl_camera plan = sl_camera_plan(0.0, 0.0, 1.0, 1.0);
    const sl_frame_style style = sl_frame_style_default();
    assert_int_equal(sl_frame_create(&empty, &none), SL_OK);
    assert_int_equal(sl_frame_draw(none, &plan, &style, 3, 3, NULL, rgba), SL_OK);
    assert_true(rgba[0] == 246 && rgba[2] == 244 && rgba[35] == 255);
    sl_frame_free(none);
    sl_free(rgba);
}

static void arguments_out_of_range_are_refused(void **state)
{
    (void)state;
    static const double xyz[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    static const int32_t good[3] = {0, 1, 2}, bad[3] = {0, 1, 3}, negative[3] = {0, -1, 2};
    static const uint8_t ink[3] = {0, 0, 0};
    sl_frame *frame = NULL;
    sl_frame_def def = {3, 1, xyz, bad, NULL, NULL};
    assert_int_equal(sl_frame_create(&def, &frame), SL_BAD_INPUT);
    def.tri = negative;
    assert_int_equal(sl_frame_create(&def, &frame), SL_BAD_INPUT);
    assert_null(frame);
    def.tri = good;
    assert_int_equal(sl_frame_create(&def, &frame), SL_OK);
    assert_int_equal(sl_frame_set_lines(frame, 8, 1, good, ink, 1.0), SL_BAD_INPUT);
    assert_int_equal(sl_frame_set_lines(frame, 0, 1, bad + 1, ink, 1.0), SL_BAD_INPUT);
    assert_int_equal(sl_frame_set_lines(frame, 0, 1, good, ink, 0.0), SL_BAD_INPUT);
    assert_int_equal(sl_frame_set_lines(frame, 0, 1, good, ink, (double)NAN), SL_BAD_INPUT);
    assert_int_equal(sl_frame_pick(frame, 0, 0).triangle, -1);
    sl_frame_free(frame);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(picking_finds_the_triangle_that_a_ray_meets_first),
        cmocka_unit_test(a_frame_has_the_same_bytes_for_any_number_of_threads),
        cmocka_unit_test(from_inside_of_a_cube_every_pixel_shows_a_wall),
        cmocka_unit_test(pixels_on_edges_belong_to_the_triangle_below_and_right),
        cmocka_unit_test(culling_changes_no_pixel_of_a_closed_surface),
        cmocka_unit_test(lines_are_hidden_by_what_is_nearer),
        cmocka_unit_test(lines_are_clipped_at_the_near_plane),
        cmocka_unit_test(strange_numbers_and_sizes_behave),
        cmocka_unit_test(arguments_out_of_range_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
