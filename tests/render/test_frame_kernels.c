#include "render/frame_support.h"

#include "geom/vec3.h"
#include "image/color.h"
#include "render/frame_internal.h"

/* Draws with each of this machine's kernels: the same pictures, the same triangles under the same pixels. */
static void assert_alike(sl_frame *frame, const sl_camera *camera, const sl_frame_style *style, int32_t width,
                         int32_t height)
{
    const int32_t pixels = width * height;
    uint8_t *first = sl_alloc(pixels, 4), *other = sl_alloc(pixels, 4);
    int32_t *hit = sl_alloc(pixels, sizeof *hit);
    for (int32_t k = 0; sl_frame_kernels_at(k) != NULL; k++) {
        uint8_t *rgba = k == 0 ? first : other;
        frame->kernels = sl_frame_kernels_at(k);
        memset(rgba, 90 + k, 4 * (size_t)pixels);
        assert_int_equal(sl_frame_draw(frame, camera, style, width, height, NULL, rgba), SL_OK);
        for (int32_t i = 0; i < pixels; i++) {
            const int32_t t = sl_frame_pick(frame, i % width, i / width).triangle;
            hit[i] = k == 0 ? t : hit[i];
            assert_int_equal(t, hit[i]);
        }
        assert_memory_equal(rgba, first, 4 * (size_t)pixels);
    }
    sl_free(first);
    sl_free(other);
    sl_free(hit);
}

static void all_kernels_give_the_same_bytes(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x5a3e);
    for (int trial = 0; trial < 24 * test_multiplier(); trial++) {
        torus_frame t = open_torus(test_uniform(&rng, 0.0, 360.0));
        sl_frame_style style = sl_frame_style_default();
        style.flat = trial % 3 == 1;
        style.lit = trial % 5 != 4;
        style.cull = trial % 4 == 3;
        style.checks = trial % 6 == 5 ? 0.0 : test_uniform(&rng, 1.0, 300.0);
        t.camera.perspective = trial % 7 != 6;
        t.camera.focal *= t.camera.perspective ? 1.0 : 0.2;
        for (int k = 0; k < 3 && trial % 8 >= 5; k++) { /* close, with triangles behind the eye */
            t.camera.eye[k] *= 0.25;
        }
        const int32_t width = 1 + test_index(&rng, 170), height = 1 + test_index(&rng, 130);
        assert_alike(t.frame, &t.camera, &style, width, height);
        close_torus(&t);
    }
}

/* Corners anywhere, not finite, equal, far off; slivers; UVs that are no numbers. */
static void all_kernels_give_the_same_bytes_for_anything(void **state)
{
    (void)state;
    static const double odd[] = {NAN, INFINITY, -INFINITY, 1e300, 1e-300, 0.0, -3.7e8, 2.0};
    test_rng rng = test_rng_seed(0xbad);
    enum { POINTS = 61, TRIANGLES = 300 };
    double xyz[3 * POINTS], uv[6 * TRIANGLES];
    int32_t tri[3 * TRIANGLES];
    for (int trial = 0; trial < 40 * test_multiplier(); trial++) {
        const double spread = trial % 2 == 0 ? 1.0 : 0.03;
        for (int i = 0; i < 3 * POINTS; i++) {
            xyz[i] = test_index(&rng, 40) == 0 ? odd[test_index(&rng, 8)] : test_uniform(&rng, -spread, spread);
        }
        for (int i = 0; i < 6 * TRIANGLES; i++) {
            uv[i] = test_index(&rng, 20) == 0 ? odd[test_index(&rng, 8)] : test_uniform(&rng, -1.0, 1.0);
        }
        for (int i = 0; i < 3 * TRIANGLES; i++) {
            tri[i] = test_index(&rng, POINTS);
        }
        const sl_frame_def def = {POINTS, TRIANGLES, xyz, tri, uv, NULL};
        const sl_camera camera = {.eye = {0.0, 0.0, trial % 3 == 0 ? 0.4 : 3.0},
                                  .right = {1.0, 0.0, 0.0},
                                  .up = {0.0, 1.0, 0.0},
                                  .forward = {0.0, 0.0, -1.0},
                                  .centre = {0.5, 0.5},
                                  .focal = 1.3,
                                  .near_depth = trial % 4 == 0 ? 1e-9 : 0.01,
                                  .perspective = trial % 5 != 0};
        const sl_frame_style style = sl_frame_style_default();
        sl_frame *frame = NULL;
        assert_int_equal(sl_frame_create(&def, &frame), SL_OK);
        assert_alike(frame, &camera, &style, 1 + test_index(&rng, 90), 1 + test_index(&rng, 90));
        sl_frame_free(frame);
    }
}

/* Light at a pixel in doubles, from the normals of the mesh alone: facets weighted by area, wrapped diffuse light. */
static double expected_light(const torus_frame *t, const float *normal, const sl_frame_hit *hit, double *margin)
{
    static const double eye_light[3] = {-0.42, 0.62, -0.66};
    double light[3], sum = 0.0, facet[3], a[3], b[3], to[3];
    const int32_t *tri = t->tri + 3 * hit->triangle;
    const double *xyz = t->mesh->xyz;
    for (int k = 0; k < 3; k++) {
        light[k] =
            eye_light[0] * t->camera.right[k] + eye_light[1] * t->camera.up[k] + eye_light[2] * t->camera.forward[k];
    }
    sl_vec3_sub(xyz + 3 * tri[1], xyz + 3 * tri[0], a);
    sl_vec3_sub(xyz + 3 * tri[2], xyz + 3 * tri[0], b);
    sl_vec3_cross(a, b, facet);
    sl_vec3_sub(t->camera.eye, xyz + 3 * tri[0], to);
    const bool back = sl_vec3_dot(facet, to) < 0.0;
    *margin = fabs(sl_vec3_dot(facet, to)) / (sl_vec3_norm(facet) * sl_vec3_norm(to));
    for (int k = 0; k < 3; k++) {
        const float *n = normal + 3 * tri[k];
        const double length =
            sqrt((double)n[0] * (double)n[0] + (double)n[1] * (double)n[1] + (double)n[2] * (double)n[2]);
        const double cosine = ((double)n[0] * light[0] + (double)n[1] * light[1] + (double)n[2] * light[2]) / length *
                              (back ? -1.0 : 1.0);
        sum += hit->bary[k] * (0.34 + 0.62 * fmax(0.25 + 0.75 * cosine, 0.0)) * (back ? 0.55 : 1.0);
    }
    return sum;
}

/* turned: all triangles show their backs. */
static void compare_colours(bool turned, bool lit)
{
    torus_frame t = open_torus(31.0);
    const int32_t nt = t.triangulation->nt;
    for (int32_t i = 0; i < nt && turned; i++) {
        const int32_t second = t.tri[3 * i + 1];
        t.tri[3 * i + 1] = t.tri[3 * i + 2];
        t.tri[3 * i + 2] = second;
    }
    const sl_frame_def def = {t.mesh->nv, nt, t.mesh->xyz, t.tri, NULL, t.rgb};
    sl_frame_free(t.frame);
    assert_int_equal(sl_frame_create(&def, &t.frame), SL_OK);
    float *normal = sl_calloc(t.mesh->nv, 3 * sizeof *normal);
    uint8_t *rgba = sl_alloc(SIDE * SIDE, 4);
    int32_t compared = 0;
    for (int32_t i = 0; i < 3 * nt; i++) {
        const int32_t *tri = t.tri + i / 3 * 3;
        double a[3], b[3], n[3];
        sl_vec3_sub(t.mesh->xyz + 3 * tri[1], t.mesh->xyz + 3 * tri[0], a);
        sl_vec3_sub(t.mesh->xyz + 3 * tri[2], t.mesh->xyz + 3 * tri[0], b);
        sl_vec3_cross(a, b, n);
        for (int k = 0; k < 3; k++) {
            normal[3 * t.tri[i] + k] += (float)n[k];
        }
    }
    sl_frame_style style = sl_frame_style_default();
    style.lit = lit;
    assert_int_equal(sl_frame_draw(t.frame, &t.camera, &style, SIDE, SIDE, NULL, rgba), SL_OK);
    for (int32_t i = 0; i < SIDE * SIDE; i++) {
        const sl_frame_hit hit = sl_frame_pick(t.frame, i % SIDE, i / SIDE);
        double margin = 1.0;
        if (hit.triangle < 0) {
            assert_true(rgba[4 * i] == 246 && rgba[4 * i + 1] == 246 && rgba[4 * i + 2] == 244);
            continue;
        }
        const double light = lit ? expected_light(&t, normal, &hit, &margin) : 1.0;
        for (int k = 0; k < 3 && margin > 0.05; k++) {
            const double color = sl_srgb_to_linear(t.rgb[3 * hit.triangle + k] / 255.0);
            const double expected = 255.0 * sl_srgb_from_linear(color * light);
            assert_true(fabs(rgba[4 * i + k] - expected) < (lit ? 1.5 : 0.5));
            compared++;
        }
        assert_int_equal(rgba[4 * i + 3], 255);
    }
    assert_true(compared > 5000);
    sl_free(rgba);
    sl_free(normal);
    close_torus(&t);
}

static void colours_are_those_of_light_and_material(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        compare_colours((k & 1) != 0, k >= 2);
    }
}

/* One square of paper, seen from straight above: a pixel of the checkerboard is the mean of light and dark over it. */
static void a_checkerboard_is_filtered_by_its_area(void **state)
{
    (void)state;
    static const double xyz[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    static const int32_t tri[] = {0, 1, 2, 0, 2, 3};
    static const double uv[] = {0, 0, 1, 0, 1, 1, 0, 0, 1, 1, 0, 1};
    test_rng rng = test_rng_seed(0xc4ec);
    const sl_frame_def def = {4, 2, xyz, tri, uv, NULL};
    sl_frame *frame = NULL;
    uint8_t rgba[4 * 64 * 64];
    assert_int_equal(sl_frame_create(&def, &frame), SL_OK);
    for (int trial = 0; trial < 20 * test_multiplier(); trial++) {
        const sl_camera camera = sl_camera_plan(0.0, 0.0, 1.0, 1.0);
        sl_frame_style style = sl_frame_style_default();
        style.lit = false;
        style.checks = test_uniform(&rng, 1.0, 60.0);
        assert_int_equal(sl_frame_draw(frame, &camera, &style, 64, 64, NULL, rgba), SL_OK);
        for (int32_t i = 0; i < 64 * 64; i++) {
            const int32_t fine = 24;
            double sum = 0.0;
            for (int32_t k = 0; k < fine * fine; k++) {
                const double u = (i % 64 + (k % fine + 0.5) / fine) / 64.0 * style.checks;
                const double v = (63 - i / 64 + (k / fine + 0.5) / fine) / 64.0 * style.checks;
                sum += ((int)floor(u) + (int)floor(v)) % 2 == 0 ? 1.0 : 0.68;
            }
            const double expected = 255.0 * sl_srgb_from_linear(sl_srgb_to_linear(208 / 255.0) * sum / (fine * fine));
            assert_true(fabs(rgba[4 * i] - expected) < 3.0);
        }
    }
    sl_frame_free(frame);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_kernels_give_the_same_bytes),
        cmocka_unit_test(all_kernels_give_the_same_bytes_for_anything),
        cmocka_unit_test(colours_are_those_of_light_and_material),
        cmocka_unit_test(a_checkerboard_is_filtered_by_its_area),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
