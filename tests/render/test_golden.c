/* Pictures compared with those in tests/golden, within a tolerance; and with themselves, exactly, for any number of
 * threads. SEAMLAB_GOLDEN_WRITE=1 writes them anew: look at every one before committing it. */
#include "render/render_support.h"

#include "image/png.h"
#include "render/frame.h"

#include <stdio.h>

enum { WIDTH = 240, HEIGHT = 160 };

static const double most_mean = 0.5; /* of 255: mean difference of all bytes */
static const int32_t far_off = 24;   /* a byte that differs by more ... */
static const double most_far = 2e-3; /* ... may be this share of them: edges that fall on the other side of a sample */

/* The folder beside this file's. */
static void golden_path(const char *name, char path[1024])
{
    static const char here[] = __FILE__, tail[] = "render/test_golden.c";
    const int stem = (int)(sizeof here - sizeof tail);
    snprintf(path, 1024, "%.*sgolden/%s.png", stem, here, name);
}

static void assert_golden(const char *name, const sl_image *image)
{
    char path[1024];
    sl_image *golden = NULL;
    golden_path(name, path);
    if (getenv("SEAMLAB_GOLDEN_WRITE") != NULL) {
        assert_int_equal(sl_png_write(path, image, NULL), SL_OK);
    }
    const sl_status status = sl_png_read(path, &golden, NULL);
    if (status != SL_OK) {
        fail_msg("%s cannot be read: run this from the build folder, as meson test does", path);
    }
    assert_true(golden->width == image->width && golden->height == image->height);
    double sum = 0.0;
    int64_t beyond = 0;
    const int64_t count = 3 * (int64_t)image->width * image->height;
    for (int64_t i = 0; i < count; i++) {
        const int32_t x = (int32_t)(i / 3 % image->width), y = (int32_t)(i / 3 / image->width);
        const int32_t a = sl_image_pixel(image, x, y)[i % 3], b = sl_image_pixel(golden, x, y)[i % 3];
        sum += abs(a - b);
        beyond += abs(a - b) > far_off;
    }
    if (sum / (double)count > most_mean || (double)beyond / (double)count > most_far) {
        fail_msg("%s: mean difference %.3f, %.4f of the bytes far off", name, sum / (double)count,
                 (double)beyond / (double)count);
    }
    sl_image_free(golden);
}

typedef enum view_kind { VIEW_MODEL, VIEW_ATLAS, VIEW_PAIR } view_kind;

static sl_image *draw(const sl_scene *scene, view_kind kind, int32_t workers)
{
    sl_image *image = NULL;
    sl_thread_pool *pool = NULL;
    sl_picture picture = sl_picture_default();
    sl_view view = sl_view_default();
    picture.width = WIDTH;
    picture.height = HEIGHT;
    picture.sky_lights = 24;
    picture.value_name = "value";
    view.elevation = 35.0;
    assert_int_equal(sl_thread_pool_create(workers, &pool), SL_OK);
    const sl_context context = {.executor = sl_thread_pool_executor(pool)};
    const sl_status status = kind == VIEW_MODEL   ? sl_render_3d(scene, &view, &picture, &context, &image, NULL)
                             : kind == VIEW_ATLAS ? sl_render_uv(scene, &picture, &context, &image, NULL)
                                                  : sl_render_pair(scene, &view, &picture, &context, &image, NULL);
    assert_int_equal(status, SL_OK);
    sl_thread_pool_free(pool);
    return image;
}

static void assert_picture(const char *name, const sl_scene *scene, view_kind kind)
{
    static const int32_t workers[] = {2, 5};
    sl_image *image = draw(scene, kind, 1);
    for (size_t k = 0; k < SL_COUNTOF(workers); k++) {
        sl_image *again = draw(scene, kind, workers[k]);
        assert_true(same_picture(image, again));
        sl_image_free(again);
    }
    assert_golden(name, image);
    sl_image_free(image);
}

typedef struct subject {
    sl_mesh *mesh;
    sl_triangulation *triangulation;
    double *uv;
    sl_scene scene;
} subject;

static subject open_subject(sl_mesh *mesh)
{
    subject s = {.mesh = mesh, .scene = sl_scene_default()};
    assert_int_equal(sl_triangulation_create(mesh, &s.triangulation), SL_OK);
    s.uv = sl_alloc(mesh->nh, 2 * sizeof *s.uv);
    assert_non_null(s.uv);
    s.scene.mesh = mesh;
    s.scene.triangulation = s.triangulation;
    s.scene.corner_uv = s.uv;
    return s;
}

static void close_subject(subject *s)
{
    sl_free(s->uv);
    sl_triangulation_free(s->triangulation);
    sl_mesh_free(s->mesh);
}

static void charts_checkerboard_and_seams(void **state)
{
    (void)state;
    subject s = open_subject(torus(48, 24));
    int32_t *chart = sl_alloc(s.mesh->nf, sizeof *chart);
    for (int32_t f = 0; f < s.mesh->nf; f++) {
        chart[f] = f % 48 / 17 + 3 * (f / 48 / 12);
    }
    for (int32_t h = 0; h < s.mesh->nh; h++) {
        const int32_t f = s.mesh->face[h], k = h - s.mesh->face_first[f];
        s.uv[2 * h] = (f % 48 + (k == 2 || k == 3)) / 48.0;
        s.uv[2 * h + 1] = 0.5 * (f / 48 + (k == 1 || k == 2)) / 24.0;
    }
    s.scene.chart = chart;
    assert_picture("charts", &s.scene, VIEW_PAIR);
    sl_free(chart);
    close_subject(&s);
}

static void signed_values_with_their_scale(void **state)
{
    (void)state;
    subject s = open_subject(torus(48, 24));
    double *value = sl_alloc(s.mesh->nh, sizeof *value);
    for (int32_t h = 0; h < s.mesh->nh; h++) {
        const double *p = s.mesh->xyz + 3 * s.mesh->origin[h];
        value[h] = sin(9.0 * p[0]) - p[2];
    }
    s.scene.corner_uv = NULL;
    s.scene.corner_value = value;
    s.scene.map = SL_COLORMAP_DIVERGING;
    s.scene.zero_line = true;
    assert_picture("values", &s.scene, VIEW_MODEL);
    sl_free(value);
    close_subject(&s);
}

static void a_texture_on_the_model_and_in_the_atlas(void **state)
{
    (void)state;
    subject s = open_subject(cube());
    sl_image *image = NULL;
    assert_int_equal(sl_image_create(64, 64, 3, &image), SL_OK);
    for (int32_t i = 0; i < 64 * 64; i++) {
        const int32_t x = i % 64, y = i / 64, ring = (int32_t)hypot(x - 31.5, y - 31.5) / 5 % 2;
        image->pixels[3 * i] = (uint8_t)(x * 4);
        image->pixels[3 * i + 1] = ring != 0 ? 200 : 90;
        image->pixels[3 * i + 2] = (uint8_t)(255 - y * 4);
    }
    cube_uv(s.mesh, s.uv);
    s.scene.texture = image;
    s.scene.tiles = 2.0;
    s.scene.checker = false;
    assert_picture("texture", &s.scene, VIEW_PAIR);
    sl_image_free(image);
    close_subject(&s);
}

/* A strip whose ends cross in UV space, as the thumbs of Figure 3: red in both views; a constraint in blue between
 * yellow dots. */
static void overlap_and_constraints_in_both_views(void **state)
{
    (void)state;
    enum { LENGTH = 40, WIDE = 4, ROW = LENGTH + 1 };
    double xyz[3 * ROW * (WIDE + 1)], flat[2 * ROW * (WIDE + 1)];
    int32_t index[4 * LENGTH * WIDE], first[LENGTH * WIDE + 1], line[LENGTH], lines = 0;
    uint8_t flag[LENGTH * WIDE];
    for (int32_t v = 0; v < ROW * (WIDE + 1); v++) {
        const double s = (double)(v % ROW) / LENGTH, t = (double)(v / ROW) / WIDE;
        const double turn = (-105.0 + 385.0 * s) * TEST_PI / 180.0, open = (-70.0 + 300.0 * s) * TEST_PI / 180.0;
        xyz[3 * v] = (1.0 - 0.3 * t) * cos(open);
        xyz[3 * v + 1] = 0.2 * sin(5.0 * s) + 0.15 * t * t;
        xyz[3 * v + 2] = -(1.0 - 0.3 * t) * sin(open);
        flat[2 * v] = 0.5 + (0.42 - 0.13 * t - 0.05 * s) * cos(turn);
        flat[2 * v + 1] = 0.5 + (0.42 - 0.13 * t - 0.05 * s) * sin(turn);
    }
    for (int32_t f = 0; f < LENGTH * WIDE; f++) {
        const int32_t a = f / LENGTH * ROW + f % LENGTH;
        const int32_t quad[4] = {a, a + 1, a + ROW + 1, a + ROW};
        memcpy(index + 4 * f, quad, sizeof quad);
        first[f] = 4 * f;
        flag[f] = f % LENGTH < 3 || f % LENGTH > LENGTH - 4;
    }
    first[LENGTH * WIDE] = 4 * LENGTH * WIDE;
    const sl_polygons polygons = {ROW * (WIDE + 1), LENGTH * WIDE, xyz, first, index};
    sl_mesh *mesh = NULL;
    assert_int_equal(sl_mesh_build(&polygons, &mesh, NULL, NULL), SL_OK);
    subject s = open_subject(mesh);
    for (int32_t h = 0; h < mesh->nh; h++) {
        memcpy(s.uv + 2 * h, flat + 2 * mesh->input_vertex[mesh->origin[h]], 2 * sizeof *flat);
        const int32_t a = mesh->input_vertex[mesh->origin[h]], b = mesh->input_vertex[sl_target(mesh, h)];
        if (a / ROW == 2 && b == a + 1 && a % ROW >= 12 && a % ROW < 28) {
            line[lines++] = h;
        }
    }
    const int32_t dot[2] = {2 * ROW + 12, 2 * ROW + 28};
    const sl_edge_layer edges = {lines, line, {38, 96, 214}, 3.0};
    const sl_dot_layer dots = {2, dot, {250, 204, 32}, 4.0};
    s.scene.facet_flag = flag;
    s.scene.edge_layers = s.scene.dot_layers = 1;
    s.scene.edge_layer = &edges;
    s.scene.dot_layer = &dots;
    s.scene.checks = 24.0;
    assert_picture("overlap", &s.scene, VIEW_PAIR);
    close_subject(&s);
}

static void a_frame_as_the_page_shows_it(void **state)
{
    (void)state;
    sl_mesh *mesh = torus(60, 30);
    sl_triangulation *triangulation = NULL;
    sl_image *image = NULL;
    sl_frame *frame = NULL;
    sl_camera camera;
    assert_int_equal(sl_triangulation_create(mesh, &triangulation), SL_OK);
    const int32_t nt = triangulation->nt;
    int32_t *tri = sl_alloc(nt, 3 * sizeof *tri), pair[2 * 60];
    double *uv = sl_alloc(nt, 6 * sizeof *uv);
    for (int32_t i = 0; i < 3 * nt; i++) {
        const double *p = mesh->xyz + 3 * mesh->origin[triangulation->corner[i]];
        tri[i] = mesh->origin[triangulation->corner[i]];
        uv[2 * i] = 0.3 * p[0];
        uv[2 * i + 1] = 0.3 * p[2];
    }
    for (int32_t i = 0; i < 60; i++) {
        pair[2 * i] = 8 * 60 + i;
        pair[2 * i + 1] = 8 * 60 + (i + 1) % 60;
    }
    const sl_frame_def def = {mesh->nv, nt, mesh->xyz, tri, uv, NULL};
    const uint8_t ink[3] = {22, 22, 26};
    const sl_frame_style style = sl_frame_style_default();
    assert_int_equal(sl_frame_create(&def, &frame), SL_OK);
    assert_int_equal(sl_frame_set_lines(frame, 0, 60, pair, ink, 2.0), SL_OK);
    sl_view view = sl_view_default();
    view.elevation = 40.0;
    assert_int_equal(sl_camera_frame(&view, (double)WIDTH / HEIGHT, mesh->nv, NULL, mesh->xyz, &camera), SL_OK);
    assert_int_equal(sl_image_create(WIDTH, HEIGHT, 4, &image), SL_OK);
    assert_int_equal(sl_frame_draw(frame, &camera, &style, WIDTH, HEIGHT, NULL, image->pixels), SL_OK);
    assert_golden("frame", image);
    sl_image_free(image);
    sl_frame_free(frame);
    sl_free(tri);
    sl_free(uv);
    sl_triangulation_free(triangulation);
    sl_mesh_free(mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(charts_checkerboard_and_seams),
        cmocka_unit_test(signed_values_with_their_scale),
        cmocka_unit_test(a_texture_on_the_model_and_in_the_atlas),
        cmocka_unit_test(overlap_and_constraints_in_both_views),
        cmocka_unit_test(a_frame_as_the_page_shows_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
