#include "atlas/atlas.h"
#include "atlas/atlas_internal.h"
#include "atlas/sidecar.h"
#include "base/memory.h"
#include "support/test_support.h"

#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { RINGS = 9, SECTORS = 14 };

/* A closed, bumpy potato with poles, and one facet repeated and one without area. */
typedef struct potato {
    double xyz[3 * (2 + RINGS * SECTORS)];
    int32_t first[2 * SECTORS + (RINGS - 1) * SECTORS + 3], index[6 * SECTORS + 4 * RINGS * SECTORS + 8];
    sl_polygons polygons;
} potato;

static void potato_facet(potato *p, int32_t *nf, int32_t n, const int32_t *corner)
{
    const int32_t at = p->first[*nf];
    memcpy(p->index + at, corner, (size_t)n * sizeof *corner);
    p->first[++*nf] = at + n;
}

static potato *potato_make(double size)
{
    potato *p = calloc(1, sizeof *p);
    int32_t nv = 0, nf = 0;
    for (int32_t i = 0; i <= RINGS + 1; i++) {
        const double theta = TEST_PI * i / (RINGS + 1);
        for (int32_t j = 0; j < (i == 0 || i == RINGS + 1 ? 1 : SECTORS); j++) {
            const double phi = 2.0 * TEST_PI * j / SECTORS;
            const double r = size * (1.0 + 0.17 * sin(3.0 * theta + 1.0) * cos(2.0 * phi) + 0.06 * sin(5.0 * phi + i));
            p->xyz[3 * nv] = r * sin(theta) * cos(phi);
            p->xyz[3 * nv + 1] = 1.4 * r * cos(theta);
            p->xyz[3 * nv++ + 2] = -r * sin(theta) * sin(phi);
        }
    }
    for (int32_t j = 0; j < SECTORS; j++) {
        const int32_t k = (j + 1) % SECTORS, last = 1 + (RINGS - 1) * SECTORS;
        potato_facet(p, &nf, 3, (int32_t[]){0, 1 + j, 1 + k});
        for (int32_t i = 0; i + 1 < RINGS; i++) {
            const int32_t a = 1 + i * SECTORS;
            potato_facet(p, &nf, 4, (int32_t[]){a + j, a + SECTORS + j, a + SECTORS + k, a + k});
        }
        potato_facet(p, &nf, 3, (int32_t[]){last + j, nv - 1, last + k});
    }
    potato_facet(p, &nf, 3, (int32_t[]){0, 1, 2}); /* there already */
    potato_facet(p, &nf, 3, (int32_t[]){5, 6, 6}); /* no area */
    p->polygons = (sl_polygons){nv, nf, p->xyz, p->first, p->index};
    return p;
}

static sl_atlas_def small_def(void)
{
    sl_atlas_def def = sl_atlas_default();
    def.pack.resolution = 512;
    def.check_resolution = 1024;
    def.segment.flatten.max_stretch = 1.1;
    return def;
}

static sl_atlas *unwrap(const sl_polygons *polygons, const sl_atlas_def *def)
{
    sl_atlas *atlas = NULL;
    sl_diag diag = sl_diag_none();
    assert_int_equal(sl_unwrap(polygons, def, NULL, &atlas, &diag), SL_OK);
    return atlas;
}

static void every_facet_gets_uvs_inside_the_page_that_pass_the_check(void **state)
{
    (void)state;
    potato *p = potato_make(3.7);
    const sl_atlas_def def = small_def();
    sl_atlas *atlas = unwrap(&p->polygons, &def);
    assert_true(atlas->check.passed);
    assert_true(atlas->segmentation->nchart >= 4); /* the body's halves, the duplicate, the facet without area */
    for (int32_t c = 0; c < 2 * atlas->mesh->nh; c++) {
        assert_true(atlas->input_corner_uv[c] >= 0.0 && atlas->input_corner_uv[c] <= 1.0);
    }
    assert_int_equal(atlas->repair.duplicate_faces, 1);
    assert_int_equal(atlas->repair.degenerate_faces, 1);
    assert_int_equal(atlas->nwarning, 1);
    sl_atlas_free(atlas);
    free(p);
}

static void the_scale_of_the_model_does_not_matter(void **state)
{
    (void)state;
    potato *one = potato_make(0.7), *huge = potato_make(0.7 * 0x1p90), *tiny = potato_make(0.7 * 0x1p-90);
    const sl_atlas_def def = small_def();
    sl_atlas *a = unwrap(&one->polygons, &def), *b = unwrap(&huge->polygons, &def), *c = unwrap(&tiny->polygons, &def);
    assert_memory_equal(a->corner_uv, b->corner_uv, 2 * (size_t)a->mesh->nh * sizeof *a->corner_uv);
    assert_memory_equal(a->corner_uv, c->corner_uv, 2 * (size_t)a->mesh->nh * sizeof *a->corner_uv);
    sl_atlas_free(a);
    sl_atlas_free(b);
    sl_atlas_free(c);
    free(one);
    free(huge);
    free(tiny);
}

static void the_check_sees_a_flip_an_overlap_and_a_crossing_border(void **state)
{
    (void)state;
    potato *p = potato_make(1.9);
    const sl_atlas_def def = small_def();
    sl_atlas *atlas = unwrap(&p->polygons, &def);
    const sl_mesh *mesh = atlas->mesh;
    double *good = sl_copy(atlas->corner_uv, mesh->nh, 2 * sizeof *good);
    for (int32_t h = 0; h < mesh->nh; h++) { /* all charts mirrored: every triangle is flipped */
        atlas->corner_uv[2 * h] = 1.0 - good[2 * h];
    }
    assert_int_equal(sl_atlas_verify(atlas, &def, NULL), SL_OK);
    assert_true(!atlas->check.passed && atlas->check.flipped > 200);
    for (int32_t h = 0; h < mesh->nh; h++) { /* one chart on top of another */
        const bool first = atlas->segmentation->face_chart[mesh->face[h]] == 0;
        atlas->corner_uv[2 * h] = first ? 0.25 + 0.5 * good[2 * h] : good[2 * h];
        atlas->corner_uv[2 * h + 1] = first ? 0.25 + 0.5 * good[2 * h + 1] : good[2 * h + 1];
    }
    assert_int_equal(sl_atlas_verify(atlas, &def, NULL), SL_OK);
    assert_true(!atlas->check.passed && atlas->check.flipped == 0 && atlas->check.overlapping_texels > 100);
    atlas->corner_uv[3] = NAN;
    assert_int_equal(sl_atlas_verify(atlas, &def, NULL), SL_BAD_INPUT);
    sl_free(good);
    sl_atlas_free(atlas);
    free(p);
}

static void seams_of_the_users_that_leave_no_disk_are_infeasible(void **state)
{
    (void)state;
    potato *p = potato_make(1.1);
    sl_atlas_def def = small_def();
    sl_atlas *atlas = NULL;
    sl_diag diag = sl_diag_none();
    int32_t *label = sl_calloc(p->polygons.nf, sizeof *label); /* one chart: a sphere */
    def.seams = SL_SEAMS_LABELS;
    def.seam_input.label = label;
    assert_int_equal(sl_unwrap(&p->polygons, &def, NULL, &atlas, &diag), SL_INFEASIBLE);
    assert_null(atlas);
    assert_non_null(strstr(diag.reason, "0 borders"));
    for (int32_t f = 0; f < p->polygons.nf; f++) {
        label[f] = f / (RINGS + 1) < SECTORS / 2;
    }
    def.segment.flatten.max_stretch = 100.0;
    assert_int_equal(sl_unwrap(&p->polygons, &def, NULL, &atlas, &diag), SL_OK);
    assert_true(atlas->check.passed);
    assert_int_equal(atlas->segmentation->nchart, 4);
    sl_atlas_free(atlas);
    sl_free(label);
    free(p);
}

static void bad_polygons_small_pages_and_too_few_charts_are_refused(void **state)
{
    (void)state;
    potato *p = potato_make(1.1);
    sl_atlas_def def = small_def();
    sl_atlas *atlas = NULL;
    sl_diag diag = sl_diag_none();
    def.pack = (sl_pack_def){.resolution = 16, .margin = 15.0, .rotations = 1};
    assert_int_equal(sl_unwrap(&p->polygons, &def, NULL, &atlas, &diag), SL_INFEASIBLE);
    assert_non_null(strstr(diag.hint, "--resolution"));
    def = small_def();
    def.segment.max_charts = 1;
    assert_int_equal(sl_unwrap(&p->polygons, &def, NULL, &atlas, &diag), SL_LIMIT);
    assert_non_null(strstr(diag.hint, "--max-charts"));
    p->index[7] = 4000;
    assert_int_equal(sl_unwrap(&p->polygons, &def, NULL, &atlas, &diag), SL_BAD_INPUT);
    free(p);
}

/* A potato cut into its sectors: many charts. */
static sl_atlas *unwrap_sectors(const potato *p, sl_atlas_def *def, int32_t *label)
{
    for (int32_t f = 0; f < p->polygons.nf; f++) {
        label[f] = f / (RINGS + 1);
    }
    def->seams = SL_SEAMS_LABELS;
    def->seam_input.label = label;
    def->segment.flatten.max_stretch = 100.0;
    return unwrap(&p->polygons, def);
}

/* The density as the written UVs have it: texels^2 over area, by the shoelace formula. */
static double density_of(const sl_atlas *atlas, const sl_polygons *polygons, double width, double height)
{
    const sl_triangulation *t = atlas->triangulation;
    double flat = 0.0, space = 0.0;
    for (int32_t k = 0; k < t->nt; k++) {
        double uv[3][2], x[3][3], n[3];
        for (int i = 0; i < 3; i++) {
            const int32_t h = t->corner[3 * k + i];
            memcpy(uv[i], atlas->corner_uv + 2 * h, sizeof uv[i]);
            memcpy(x[i], polygons->xyz + 3 * polygons->index[sl_input_corner(atlas->mesh, h)], sizeof x[i]);
        }
        for (int i = 0; i < 3; i++) {
            const int j = (i + 1) % 3, l = (i + 2) % 3;
            n[i] = (x[1][j] - x[0][j]) * (x[2][l] - x[0][l]) - (x[1][l] - x[0][l]) * (x[2][j] - x[0][j]);
        }
        space += 0.5 * sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        for (int i = 0; i < 3; i++) {
            const int j = (i + 1) % 3;
            flat += 0.5 * width * height * (uv[i][0] * uv[j][1] - uv[j][0] * uv[i][1]);
        }
    }
    return sqrt(flat / space);
}

static void check_tiles(const sl_atlas *atlas)
{
    for (int32_t h = 0; h < atlas->mesh->nh; h++) {
        const int32_t page = atlas->placement[atlas->segmentation->face_chart[atlas->mesh->face[h]]].page;
        const double u = atlas->corner_uv[2 * h] - page % 10, v = atlas->corner_uv[2 * h + 1] - page / 10;
        assert_true(page >= 0 && page < atlas->pack.pages);
        assert_true(u >= 0.0 && u <= 1.0 && v >= 0.0 && v <= 1.0);
    }
}

static void pages_become_tiles_of_the_density_asked_for(void **state)
{
    (void)state;
    potato *p = potato_make(1.3);
    int32_t *label = sl_calloc(p->polygons.nf, sizeof *label);
    sl_atlas_def def = small_def();
    def.pack.height = 300;
    sl_atlas *atlas = unwrap_sectors(p, &def, label);
    assert_true(atlas->check.passed && atlas->pack.pages == 1);
    assert_true(test_near_rel(atlas->texels_a_unit, density_of(atlas, &p->polygons, 512, 300), 1e-6));
    check_tiles(atlas);
    def.pack.density = 1.9 * atlas->texels_a_unit;
    def.pack.pages = 40;
    sl_atlas_free(atlas);
    atlas = unwrap_sectors(p, &def, label);
    assert_true(atlas->check.passed && atlas->pack.pages > 2);
    assert_true(test_near_rel(atlas->texels_a_unit, def.pack.density, 1e-9));
    assert_true(test_near_rel(density_of(atlas, &p->polygons, 512, 300), def.pack.density, 1e-6));
    check_tiles(atlas);
    sl_atlas_free(atlas);
    def.pack.pages = 2;
    sl_diag diag = sl_diag_none();
    assert_int_equal(sl_unwrap(&p->polygons, &def, NULL, &atlas, &diag), SL_INFEASIBLE);
    assert_non_null(strstr(diag.reason, "2 pages of 512 x 300 texels at that density"));
    sl_free(label);
    free(p);
}

static void overlaps_are_seen_on_every_page(void **state)
{
    (void)state;
    potato *p = potato_make(1.6);
    int32_t *label = sl_calloc(p->polygons.nf, sizeof *label), moved = -1, onto = -1;
    sl_atlas_def def = small_def();
    def.pack.pages = 3;
    sl_atlas *atlas = unwrap_sectors(p, &def, label);
    const sl_segmentation *seg = atlas->segmentation;
    assert_true(atlas->check.passed && atlas->pack.pages == 3);
    for (int32_t c = 0; c < seg->nchart; c++) {
        if (atlas->placement[c].page == 2 && seg->chart[c].count > 2) {
            onto = moved;
            moved = c;
        }
    }
    assert_true(onto >= 0);
    double shift[2];
    const sl_mesh *m = atlas->mesh;
    const int32_t from = m->face_first[seg->face[seg->chart[moved].first]],
                  to = m->face_first[seg->face[seg->chart[onto].first + 1]];
    shift[0] = atlas->corner_uv[2 * to] - atlas->corner_uv[2 * from];
    shift[1] = atlas->corner_uv[2 * to + 1] - atlas->corner_uv[2 * from + 1];
    for (int32_t h = 0; h < m->nh; h++) {
        for (int k = 0; k < 2 && seg->face_chart[m->face[h]] == moved; k++) {
            atlas->corner_uv[2 * h + k] += shift[k];
        }
    }
    assert_int_equal(sl_atlas_verify(atlas, &def, NULL), SL_OK);
    assert_true(!atlas->check.passed && !atlas->check.proven && atlas->check.overlapping_texels > 20);
    sl_atlas_free(atlas);
    sl_free(label);
    free(p);
}

static bool refuse(void *user, const char *stage, double fraction)
{
    (void)stage, (void)fraction;
    return ++*(int *)user < 3;
}

static void unwrapping_can_be_cancelled(void **state)
{
    (void)state;
    potato *p = potato_make(1.1);
    const sl_atlas_def def = small_def();
    int calls = 0;
    const sl_context context = {.progress = refuse, .progress_user = &calls};
    sl_atlas *atlas = NULL;
    assert_int_equal(sl_unwrap(&p->polygons, &def, &context, &atlas, NULL), SL_CANCELLED);
    assert_null(atlas);
    free(p);
}

static void the_sidecar_says_what_the_atlas_is(void **state)
{
    (void)state;
    potato *p = potato_make(2.3);
    const sl_atlas_def def = small_def();
    sl_atlas *atlas = unwrap(&p->polygons, &def);
    char *text = NULL;
    json_error_t error;
    assert_int_equal(sl_sidecar_text(atlas, &def, &text), SL_OK);
    json_t *j = json_loads(text, 0, &error);
    assert_non_null(j);
    assert_int_equal(json_array_size(json_object_get(j, "face_chart")), p->polygons.nf);
    assert_int_equal(json_array_size(json_object_get(j, "charts")), atlas->segmentation->nchart);
    assert_true(json_is_true(json_object_get(json_object_get(j, "certificate"), "passed")));
    int32_t seams = 0, *halfedge = NULL;
    double length = 0.0;
    assert_int_equal(sl_atlas_seams(atlas->mesh, &halfedge, &seams), SL_OK);
    for (int32_t k = 0; k < seams; k++) {
        length += sl_mesh_edge_length(atlas->mesh, halfedge[k]);
    }
    assert_int_equal(json_array_size(json_object_get(j, "seams")), seams);
    assert_true(test_near_rel(length, sl_atlas_seam_length(atlas->mesh), 1e-12));
    assert_true(test_near_rel(json_number_value(json_object_get(j, "seam_length_over_diagonal")),
                              length / sl_mesh_diagonal(atlas->mesh), 1e-12));
    json_decref(j);
    sl_free(text);
    sl_free(halfedge);
    sl_atlas_free(atlas);
    free(p);
}

static void the_sidecar_stands_beside_its_atlas(void **state)
{
    (void)state;
    static const char *const names[][2] = {{"a/b.obj", "a/b.atlas.json"},
                                           {"b.tar.ply", "b.tar.atlas.json"},
                                           {"x.y/plain", "x.y/plain.atlas.json"},
                                           {"d/.obj", "d/.obj.atlas.json"}};
    for (size_t k = 0; k < SL_COUNTOF(names); k++) {
        char path[64];
        sl_sidecar_path(names[k][0], path, sizeof path);
        assert_string_equal(path, names[k][1]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_facet_gets_uvs_inside_the_page_that_pass_the_check),
        cmocka_unit_test(the_scale_of_the_model_does_not_matter),
        cmocka_unit_test(the_check_sees_a_flip_an_overlap_and_a_crossing_border),
        cmocka_unit_test(seams_of_the_users_that_leave_no_disk_are_infeasible),
        cmocka_unit_test(bad_polygons_small_pages_and_too_few_charts_are_refused),
        cmocka_unit_test(pages_become_tiles_of_the_density_asked_for),
        cmocka_unit_test(overlaps_are_seen_on_every_page),
        cmocka_unit_test(unwrapping_can_be_cancelled),
        cmocka_unit_test(the_sidecar_says_what_the_atlas_is),
        cmocka_unit_test(the_sidecar_stands_beside_its_atlas),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
