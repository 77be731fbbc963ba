#include "render_support.h"

#include "image/color.h"
#include "render/chart_colors.h"
#include "render/stage_internal.h"

/* A scene with everything in it, over the torus. */
typedef struct torus_scene {
    sl_mesh *mesh;
    sl_triangulation *triangulation;
    double *uv, *value;
    int32_t *chart;
    uint8_t *flag;
    int32_t edges[2], dots[2];
    sl_edge_layer edge;
    sl_dot_layer dot;
    sl_scene scene;
} torus_scene;

static void set_torus(torus_scene *t)
{
    *t = (torus_scene){.mesh = torus(24, 15)};
    const sl_mesh *m = t->mesh;
    assert_int_equal(sl_triangulation_create(m, &t->triangulation), SL_OK);
    t->uv = sl_alloc(m->nh, 2 * sizeof *t->uv);
    t->value = sl_alloc(m->nh, sizeof *t->value);
    t->chart = sl_alloc(m->nf, sizeof *t->chart);
    t->flag = sl_calloc(m->nf, 1);
    assert_true(t->uv != NULL && t->value != NULL && t->chart != NULL && t->flag != NULL);
    for (int32_t h = 0; h < m->nh; h++) {
        const double *p = m->xyz + 3 * m->origin[h];
        t->chart[m->face[h]] = m->face[h] % 24 / 6;
        t->uv[2 * h] = 0.25 * (p[0] + 0.5) + 0.25 * (t->chart[m->face[h]] % 4);
        t->uv[2 * h + 1] = p[2] + 0.5;
        t->value[h] = sin(4.0 * p[0]) + p[1];
    }
    t->flag[3] = 1;
    t->edges[0] = 5;
    t->edges[1] = 77;
    t->dots[0] = 3;
    t->dots[1] = 200;
    t->edge = (sl_edge_layer){2, t->edges, {0, 40, 220}, 3.0};
    t->dot = (sl_dot_layer){2, t->dots, {240, 220, 0}, 4.0};
    t->scene = sl_scene_default();
    t->scene.mesh = m;
    t->scene.triangulation = t->triangulation;
    t->scene.corner_uv = t->uv;
    t->scene.chart = t->chart;
    t->scene.facet_flag = t->flag;
    t->scene.wire = 0.2;
    t->scene.edge_layers = 1;
    t->scene.edge_layer = &t->edge;
    t->scene.dot_layers = 1;
    t->scene.dot_layer = &t->dot;
}

static void clear_torus(torus_scene *t)
{
    sl_free(t->uv);
    sl_free(t->value);
    sl_free(t->chart);
    sl_free(t->flag);
    sl_triangulation_free(t->triangulation);
    sl_mesh_free(t->mesh);
}

static sl_picture small_picture(int32_t width, int32_t height)
{
    sl_picture p = sl_picture_default();
    p.width = width;
    p.height = height;
    p.sky_lights = 6;
    p.title = "Title";
    p.uv_title = "UV";
    p.value_name = "phi";
    return p;
}

static void pictures_are_the_same_for_any_number_of_threads(void **state)
{
    (void)state;
    torus_scene t;
    set_torus(&t);
    sl_picture picture = small_picture(151, 90);
    picture.back_view = true;
    sl_image *first = NULL;
    for (int32_t workers = 1; workers <= 5; workers += workers == 1 ? 1 : 3) {
        sl_thread_pool *pool = NULL;
        sl_image *image = NULL;
        assert_int_equal(sl_thread_pool_create(workers, &pool), SL_OK);
        const sl_context context = {.executor = sl_thread_pool_executor(pool)};
        assert_int_equal(sl_render_pair(&t.scene, NULL, &picture, &context, &image, NULL), SL_OK);
        if (first == NULL) {
            first = image;
        } else {
            assert_true(same_picture(first, image));
            sl_image_free(image);
        }
        sl_thread_pool_free(pool);
    }
    sl_image *serial = NULL;
    assert_int_equal(sl_render_pair(&t.scene, NULL, &picture, NULL, &serial, NULL), SL_OK);
    assert_true(same_picture(first, serial));
    sl_image_free(first);
    sl_image_free(serial);
    clear_torus(&t);
}

static void a_pair_is_its_two_views_side_by_side(void **state)
{
    (void)state;
    torus_scene t;
    set_torus(&t);
    sl_picture picture = small_picture(120, 70);
    sl_image *pair = NULL, *left = NULL, *right = NULL, *sheet = NULL;
    assert_int_equal(sl_render_pair(&t.scene, NULL, &picture, NULL, &pair, NULL), SL_OK);
    picture.width = 60;
    assert_int_equal(sl_render_3d(&t.scene, NULL, &picture, NULL, &left, NULL), SL_OK);
    assert_int_equal(sl_render_uv(&t.scene, &picture, NULL, &right, NULL), SL_OK);
    assert_int_equal(sl_image_create(120, 70, 3, &sheet), SL_OK);
    sl_image_paste(sheet, left, 0, 0);
    sl_image_paste(sheet, right, 60, 0);
    assert_true(same_picture(pair, sheet));
    sl_image_free(pair);
    sl_image_free(left);
    sl_image_free(right);
    sl_image_free(sheet);
    clear_torus(&t);
}

/* Each chart's middle in the atlas has its chart's colour, light or dark square; the gaps are white. */
static void the_atlas_shows_each_chart_where_its_uvs_are(void **state)
{
    (void)state;
    sl_mesh *mesh = cube();
    sl_triangulation *triangulation = NULL;
    double uv[48];
    uint8_t rgb[18];
    const int32_t chart[6] = {0, 1, 2, 3, 4, 5};
    assert_int_equal(sl_triangulation_create(mesh, &triangulation), SL_OK);
    cube_uv(mesh, uv);
    assert_int_equal(sl_chart_colors(mesh, chart, rgb), SL_OK);
    sl_scene scene = sl_scene_default();
    scene.mesh = mesh;
    scene.triangulation = triangulation;
    scene.corner_uv = uv;
    scene.chart = chart;
    scene.checker = false;
    sl_picture picture = sl_picture_default();
    picture.width = picture.height = 200;
    sl_image *image = NULL;
    assert_int_equal(sl_render_uv(&scene, &picture, NULL, &image, NULL), SL_OK);
    const double side = 200.0 * 0.92, x0 = 100.0 - 0.5 * side; /* the unit square, less its margin */
    for (int f = 0; f < 6; f++) {
        const double u = 0.05 + 0.3 * (f % 3), v = 0.1 + 0.4 * (f / 3);
        const uint8_t *middle =
            sl_image_pixel(image, (int)(x0 + side * (u + 0.125)), (int)(200 - x0 - side * (v + 0.125)));
        const uint8_t *gap =
            sl_image_pixel(image, (int)(x0 + side * (u + 0.275)), (int)(200 - x0 - side * (v + 0.125)));
        const uint8_t *border = sl_image_pixel(image, (int)(x0 + side * u), (int)(200 - x0 - side * (v + 0.125)));
        for (int k = 0; k < 3; k++) {
            assert_true(abs(middle[k] - rgb[3 * f + k]) <= 1);
            assert_int_equal(gap[k], 255);
            assert_true(border[k] < 200);
        }
    }
    sl_image_free(image);
    sl_triangulation_free(triangulation);
    sl_mesh_free(mesh);
}

static int64_t count_pixels(const sl_image *image, bool (*like)(const uint8_t *rgb))
{
    int64_t count = 0;
    for (int32_t i = 0; i < image->width * image->height; i++) {
        count += like(image->pixels + 3 * (int64_t)i) ? 1 : 0;
    }
    return count;
}

static bool is_red(const uint8_t *p)
{
    return p[0] > 90 && p[1] < p[0] / 3 && p[2] < p[0] / 3;
}

static bool is_dark(const uint8_t *p)
{
    return p[0] < 60 && p[1] < 60 && p[2] < 60;
}

static bool is_blue(const uint8_t *p)
{
    return p[2] > 150 && p[0] < 60 && p[1] < 90;
}

static bool is_yellow(const uint8_t *p)
{
    return p[0] > 215 && p[1] > 200 && p[2] < 60;
}

static void flags_seams_layers_and_dots_show(void **state)
{
    (void)state;
    torus_scene t;
    set_torus(&t);
    sl_picture picture = small_picture(300, 240);
    picture.title = NULL;
    sl_image *with = NULL, *without = NULL;
    for (int32_t f = 0; f < t.mesh->nf; f += 2) {
        t.flag[f] = 1;
    }
    t.scene.wire = 0.0;
    /* Layers where they must be seen: the vertex nearest to the default camera, and an edge at it. */
    int32_t best = 0;
    for (int32_t h = 0; h < t.mesh->nh; h++) {
        const double *p = t.mesh->xyz + 3 * t.mesh->origin[h], *q = t.mesh->xyz + 3 * t.mesh->origin[best];
        best = 0.54 * p[0] + 0.34 * p[1] + 0.77 * p[2] > 0.54 * q[0] + 0.34 * q[1] + 0.77 * q[2] ? h : best;
    }
    t.edges[0] = t.edges[1] = best;
    t.dots[0] = t.dots[1] = sl_target(t.mesh, best);
    assert_int_equal(sl_render_3d(&t.scene, NULL, &picture, NULL, &with, NULL), SL_OK);
    t.scene.seams = false;
    t.scene.facet_flag = NULL;
    t.scene.edge_layers = t.scene.dot_layers = 0;
    assert_int_equal(sl_render_3d(&t.scene, NULL, &picture, NULL, &without, NULL), SL_OK);
    assert_true(count_pixels(with, is_red) > 2000 && count_pixels(without, is_red) == 0);
    assert_true(count_pixels(with, is_dark) > count_pixels(without, is_dark) + 100);
    assert_true(count_pixels(with, is_blue) > 10 && count_pixels(without, is_blue) == 0);
    assert_true(count_pixels(with, is_yellow) > 20 && count_pixels(without, is_yellow) == 0);
    sl_image_free(with);
    sl_image_free(without);
    clear_torus(&t);
}

static void seams_are_where_charts_or_uvs_change_or_an_edge_is_cut(void **state)
{
    (void)state;
    torus_scene t;
    set_torus(&t);
    int32_t cut = 0;
    while (t.chart[t.mesh->face[cut]] != t.chart[t.mesh->face[t.mesh->twin[cut]]]) {
        cut++;
    }
    for (int k = 0; k < 3; k++) {
        sl_scene scene = t.scene;
        scene.chart = k == 0 ? t.chart : NULL;
        scene.corner_uv = k == 1 ? t.uv : NULL;
        sl_mesh_cut_edge(t.mesh, cut);
        for (int32_t h = 0; h < t.mesh->nh; h++) {
            const int32_t other = sl_opposite(t.mesh, h);
            const bool differ = t.chart[t.mesh->face[h]] != t.chart[t.mesh->face[other]];
            assert_int_equal(sl_is_seam(&scene, h), (k < 2 && differ) || h == cut || other == cut);
        }
        sl_mesh_sew_edge(t.mesh, cut);
    }
    /* A chart without UVs has an outline and nothing else. */
    sl_scene scene = t.scene;
    scene.chart = NULL;
    scene.corner_uv = t.uv;
    for (int32_t h = 0; h < t.mesh->nh; h++) {
        t.uv[2 * h] = t.chart[t.mesh->face[h]] == 0 ? (double)NAN : t.uv[2 * h];
    }
    for (int32_t h = 0; h < t.mesh->nh; h++) {
        const int32_t other = sl_opposite(t.mesh, h);
        assert_int_equal(sl_is_seam(&scene, h), t.chart[t.mesh->face[h]] != t.chart[t.mesh->face[other]]);
    }
    clear_torus(&t);
}

static bool is_blueish(const uint8_t *p)
{
    return p[2] > p[0] + 40;
}

static bool is_reddish(const uint8_t *p)
{
    return p[0] > p[2] + 40;
}

static void signed_values_show_blue_and_red_alike_per_facet_and_per_corner(void **state)
{
    (void)state;
    torus_scene t;
    set_torus(&t);
    sl_picture picture = small_picture(200, 160);
    double *facet = sl_alloc(t.mesh->nf, sizeof *facet);
    assert_non_null(facet);
    for (int32_t f = 0; f < t.mesh->nf; f++) {
        facet[f] = t.value[t.mesh->face_first[f]];
    }
    t.scene.map = SL_COLORMAP_DIVERGING;
    t.scene.checker = t.scene.seams = false;
    t.scene.zero_line = true;
    t.scene.facet_flag = NULL;
    t.scene.edge_layers = t.scene.dot_layers = 0;
    for (int k = 0; k < 2; k++) {
        sl_image *image = NULL;
        t.scene.corner_value = k == 0 ? t.value : NULL;
        t.scene.facet_value = k == 0 ? NULL : facet;
        assert_int_equal(sl_render_3d(&t.scene, NULL, &picture, NULL, &image, NULL), SL_OK);
        assert_true(count_pixels(image, is_blueish) > 1000 && count_pixels(image, is_reddish) > 1000);
        sl_image_free(image);
    }
    sl_free(facet);
    clear_torus(&t);
}

/* A mesh without facets, pictures of one pixel, arrays full of NaN: an answer, never a crash. */
static void odd_inputs_give_pictures(void **state)
{
    (void)state;
    torus_scene t;
    set_torus(&t);
    int32_t nothing[1] = {0};
    sl_mesh empty = {.face_first = nothing, .scale = 1.0};
    sl_triangulation none = {.first = nothing};
    for (int i = 0; i < 6; i++) {
        sl_image *image = NULL;
        sl_scene scene = t.scene;
        sl_picture picture = small_picture(i % 2 == 0 ? 1 : 33, i % 2 == 0 ? 1 : 20);
        sl_view view = sl_view_default();
        view.fov = i == 3 ? 0.0 : 24.0;
        if (i >= 4) {
            scene = sl_scene_default();
            scene.mesh = &empty;
            scene.triangulation = &none;
            scene.corner_uv = t.uv;
        }
        for (int32_t h = 0; h < 2 * t.mesh->nh && i == 2; h++) {
            t.uv[h] = (double)NAN;
            t.value[h / 2] = h % 3 == 0 ? (double)NAN : (double)INFINITY;
        }
        scene.corner_value = i == 3 ? t.value : NULL;
        assert_int_equal(sl_render_pair(&scene, &view, &picture, NULL, &image, NULL), SL_OK);
        assert_int_equal(image->width, picture.width);
        assert_int_equal(image->height, picture.height);
        sl_image_free(image);
    }
    clear_torus(&t);
}

static void the_window_grows_where_uvs_leave_the_unit_square(void **state)
{
    (void)state;
    torus_scene t;
    set_torus(&t);
    sl_picture picture = small_picture(100, 100);
    picture.uv_title = NULL;
    sl_image *inside = NULL, *moved = NULL;
    t.scene.checker = false;
    for (int32_t h = 0; h < 2 * t.mesh->nh; h++) {
        t.uv[h] = 3.0 * t.uv[h] - 1.25;
    }
    assert_int_equal(sl_render_uv(&t.scene, &picture, NULL, &inside, NULL), SL_OK);
    for (int32_t h = 0; h < 2 * t.mesh->nh; h++) {
        t.uv[h] += 16.0; /* exact in binary up to rounding: the same window elsewhere */
    }
    assert_int_equal(sl_render_uv(&t.scene, &picture, NULL, &moved, NULL), SL_OK);
    int64_t different = 0;
    for (int i = 0; i < 30000; i++) {
        different += abs(inside->pixels[i] - moved->pixels[i]) > 24 ? 1 : 0;
    }
    assert_true(different < 60);
    sl_image_free(inside);
    sl_image_free(moved);
    clear_torus(&t);
}

static void options_and_numbers_out_of_range_are_refused_by_name(void **state)
{
    (void)state;
    torus_scene t;
    set_torus(&t);
    for (int i = 0; i < 12; i++) {
        sl_scene scene = t.scene;
        sl_picture picture = small_picture(20, 20);
        sl_view view = sl_view_default();
        sl_edge_layer edge = t.edge;
        sl_dot_layer dot = t.dot;
        int32_t bad = i == 7 ? t.mesh->nv : t.mesh->nh;
        scene.edge_layer = &edge;
        scene.dot_layer = &dot;
        picture.width = i == 0 ? 0 : 20;
        picture.height = i == 1 ? 16385 : 20;
        picture.samples = i == 2 ? 5 : 2;
        picture.sky_lights = i == 3 ? 257 : 2;
        scene.checks = i == 4 ? 0.0 : 64.0;
        scene.wire = i == 5 ? (double)NAN : 0.0;
        edge.halfedge = i == 6 ? &bad : t.edges;
        edge.count = i == 6 ? 1 : 2;
        dot.vertex = i == 7 ? &bad : t.dots;
        dot.count = i == 7 ? 1 : 2;
        edge.width = i == 8 ? -1.0 : 2.0;
        dot.radius = i == 9 ? (double)NAN : 2.0;
        view.elevation = i == 10 ? 100.0 : 20.0;
        scene.corner_uv = i == 11 ? NULL : t.uv;
        sl_image *image = NULL;
        sl_diag diag = sl_diag_none();
        assert_int_equal(sl_render_pair(&scene, &view, &picture, NULL, &image, &diag), SL_BAD_INPUT);
        assert_null(image);
        assert_true(diag.reason[0] != '\0');
    }
    clear_torus(&t);
}

static bool refuse_progress(void *user, const char *stage, double fraction)
{
    (void)user;
    (void)stage;
    return fraction < 0.3;
}

static void a_picture_can_be_cancelled(void **state)
{
    (void)state;
    torus_scene t;
    set_torus(&t);
    const sl_picture picture = small_picture(40, 30);
    const sl_context context = {.progress = refuse_progress};
    sl_image *image = NULL;
    assert_int_equal(sl_render_pair(&t.scene, NULL, &picture, &context, &image, NULL), SL_CANCELLED);
    assert_null(image);
    clear_torus(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pictures_are_the_same_for_any_number_of_threads),
        cmocka_unit_test(a_pair_is_its_two_views_side_by_side),
        cmocka_unit_test(the_atlas_shows_each_chart_where_its_uvs_are),
        cmocka_unit_test(flags_seams_layers_and_dots_show),
        cmocka_unit_test(seams_are_where_charts_or_uvs_change_or_an_edge_is_cut),
        cmocka_unit_test(signed_values_show_blue_and_red_alike_per_facet_and_per_corner),
        cmocka_unit_test(odd_inputs_give_pictures),
        cmocka_unit_test(the_window_grows_where_uvs_leave_the_unit_square),
        cmocka_unit_test(options_and_numbers_out_of_range_are_refused_by_name),
        cmocka_unit_test(a_picture_can_be_cancelled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
