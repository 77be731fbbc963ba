#define _POSIX_C_SOURCE 200809L
/* Other tools' atlases beside ours: matching by name and size, measures. */
#include "companion/companion.h"
#include "support/test_support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* A model of ours, unwrapped, in a folder of its own. */
typedef struct bench {
    char folder[64];
    exp_run *run;
    exp_source source;
    exp_mesh mesh;
    sl_atlas *atlas;
} bench;

static void bench_make(bench *b, const char *name)
{
    memset(b, 0, sizeof *b);
    strcpy(b->folder, "/tmp/seamlab-added-XXXXXX");
    assert_non_null(mkdtemp(b->folder));
    b->run = calloc(1, sizeof *b->run);
    b->run->diag = sl_diag_none();
    b->source.generated = true;
    strcpy(b->source.name, name);
    assert_int_equal(exp_mesh_load(&b->source, &b->mesh, NULL), SL_OK);
    sl_atlas_def def = sl_atlas_default();
    def.segment.unshare = true; /* axes are cut, nothing lies on one place */
    assert_int_equal(sl_unwrap(&b->mesh.polygons, &def, &b->run->context, &b->atlas, NULL), SL_OK);
}

static void bench_clear(bench *b)
{
    char command[96];
    snprintf(command, sizeof command, "rm -r %s", b->folder);
    assert_int_equal(system(command), 0);
    sl_atlas_free(b->atlas);
    exp_mesh_clear(&b->mesh);
    free(b->run);
}

/* Adds FOLDER/name of the polygons with the UVs (NULL: none) as a tool's. */
static void add_file(bench *b, const char *name, const sl_polygons *polygons, const double *corner_uv)
{
    exp_added *a = &b->run->add[b->run->added++];
    sl_meshfile *file = NULL;
    strcpy(a->name, "tool");
    snprintf(a->path, sizeof a->path, "%s/%s", b->folder, name);
    assert_int_equal(sl_meshfile_from_polygons(polygons, &file, NULL), SL_OK);
    assert_int_equal(sl_meshfile_write(a->path, file, corner_uv, NULL), SL_OK);
    sl_meshfile_free(file);
}

/* Every polygon split into a fan, each corner a vertex of its own: what other tools make of a mesh. Owned arrays. */
static sl_polygons scattered(const sl_polygons *p, const double *corner_uv, double **uv)
{
    const int32_t nt = p->face_first[p->nf] - 2 * p->nf;
    double *xyz = malloc(9 * (size_t)nt * sizeof *xyz);
    int32_t *first = malloc(((size_t)nt + 1) * sizeof *first), *index = malloc(3 * (size_t)nt * sizeof *index), t = 0;
    *uv = malloc(6 * (size_t)nt * sizeof **uv);
    for (int32_t f = 0; f < p->nf; f++) {
        for (int32_t k = p->face_first[f] + 1; k + 1 < p->face_first[f + 1]; k++) {
            const int32_t corner[3] = {p->face_first[f], k, k + 1};
            for (int c = 0; c < 3; c++) {
                memcpy(xyz + 9 * (size_t)t + 3 * c, p->xyz + 3 * (size_t)p->index[corner[c]], 3 * sizeof *xyz);
                memcpy(*uv + 6 * (size_t)t + 2 * c, corner_uv + 2 * (size_t)corner[c], 2 * sizeof **uv);
                index[3 * t + c] = 3 * t + c;
            }
            first[t] = 3 * t;
            t++;
        }
    }
    first[nt] = 3 * nt;
    return (sl_polygons){3 * nt, nt, xyz, first, index};
}

static void scattered_clear(sl_polygons *p, double *uv)
{
    free((void *)(uintptr_t)p->xyz);
    free((void *)(uintptr_t)p->face_first);
    free((void *)(uintptr_t)p->index);
    free(uv);
}

static void a_file_is_named_after_a_model_up_to_a_word(void **state)
{
    (void)state;
    assert_true(named_after("/a/b/hand.obj", "hand"));
    assert_true(named_after("hand.xatlas.obj", "hand"));
    assert_true(named_after("hand-uv.obj", "hand"));
    assert_true(named_after("body-uneven.obj", "body"));
    assert_false(named_after("hands.obj", "hand"));
    assert_false(named_after("hand/foot.obj", "hand"));
    assert_false(named_after("han.obj", "hand"));
    assert_false(named_after("hand.obj", ""));
}

/* Oracle: what the atlas knows of itself. The same UVs on scattered triangles give the same seams, charts and axis. */
static void uvs_on_scattered_triangles_measure_as_the_atlas_they_come_from(void **state)
{
    (void)state;
    bench b;
    exp_numbers whole, split;
    double *uv = NULL;
    bench_make(&b, "mug");
    const sl_polygons *p = &b.mesh.polygons;
    sl_polygons triangles = scattered(p, b.atlas->input_corner_uv, &uv);
    assert_int_equal(exp_measure_uv(b.run, p, b.atlas->input_corner_uv, b.mesh.generated, &whole), SL_OK);
    assert_int_equal(exp_measure_uv(b.run, &triangles, uv, b.mesh.generated, &split), SL_OK);
    assert_int_equal((int)whole.metric[EXP_CHARTS], b.atlas->segmentation->nchart);
    assert_true(test_near(whole.metric[EXP_SEAM], sl_atlas_seam_diagonals(b.atlas->mesh), 1e-12));
    assert_true(test_near(whole.metric[EXP_JAGGED], split.metric[EXP_JAGGED], 1e-9));
    assert_true(test_near(whole.axis, exp_axis_kept(b.atlas->mesh, p, b.mesh.generated, true), 1e-12));
    assert_true(whole.axis > 0.9);
    for (int metric = 0; metric < EXP_NUMBERS; metric++) {
        assert_true(test_near(whole.metric[metric], split.metric[metric], 1e-9 * fabs(whole.metric[metric])));
    }
    assert_true(test_near(whole.axis, split.axis, 1e-9));
    assert_true(whole.overlap == 0.0 && split.overlap == 0.0 && whole.flipped == 0 && split.flipped == 0);
    scattered_clear(&triangles, uv);
    bench_clear(&b);
}

static void uvs_that_lie_twice_on_one_place_overlap(void **state)
{
    (void)state;
    bench b;
    exp_numbers numbers;
    bench_make(&b, "mug");
    const sl_polygons *p = &b.mesh.polygons;
    double *uv = b.atlas->input_corner_uv;
    for (int64_t c = 0; c < p->face_first[p->nf]; c++) {
        uv[2 * c] = 0.25 + 0.25 * fabs(2.0 * uv[2 * c] - 1.0); /* folded in the middle */
    }
    assert_int_equal(exp_measure_uv(b.run, p, uv, NULL, &numbers), SL_OK);
    assert_true(numbers.overlap > 0.05 && numbers.flipped > 0 && numbers.axis == -1.0);
    uv[34] = (double)NAN;
    assert_int_equal(exp_measure_uv(b.run, p, uv, NULL, &numbers), SL_BAD_INPUT);
    assert_true(numbers.failed);
    bench_clear(&b);
}

static void added_files_find_their_models(void **state)
{
    (void)state;
    bench b;
    double *uv = NULL;
    model models[3] = {0};
    added rows[EXP_MAX_ADDED];
    bench_make(&b, "mug");
    const sl_polygons *p = &b.mesh.polygons;
    sl_polygons triangles = scattered(p, b.atlas->input_corner_uv, &uv);
    strcpy(models[0].source.name, "mu");
    models[1] = (model){.source = b.source, .facets = p->nf, .triangles = triangles.nf};
    strcpy(models[2].source.name, "mug-small");
    models[2].facets = p->nf - 1;
    companion all = {.count = 3, .model = models, .add = rows};
    add_file(&b, "mug.obj", p, b.atlas->input_corner_uv);
    add_file(&b, "mug.tool.obj", &triangles, uv);
    add_file(&b, "mug-small.obj", p, b.atlas->input_corner_uv); /* another name's facets: the shorter name's mesh */
    add_file(&b, "cup.obj", p, b.atlas->input_corner_uv);
    assert_int_equal(measure_added(b.run, &all), SL_OK);
    assert_int_equal(all.added, 4);
    static const int32_t expected[] = {1, 1, 1, -1};
    for (int k = 0; k < 4; k++) {
        assert_int_equal(rows[k].model, expected[k]);
        assert_string_equal(rows[k].mesh, k == 3 ? "cup" : "mug");
        assert_int_equal((int)rows[k].numbers.metric[EXP_CHARTS], b.atlas->segmentation->nchart);
    }
    assert_true(rows[1].numbers.axis > 0.9 && rows[3].numbers.axis == -1.0);
    assert_int_equal(b.run->failed, 0);
    scattered_clear(&triangles, uv);
    bench_clear(&b);
}

static void added_files_that_cannot_be_measured_are_rows(void **state)
{
    (void)state;
    bench b;
    added rows[EXP_MAX_ADDED];
    companion all = {.add = rows};
    bench_make(&b, "mug");
    add_file(&b, "bare.obj", &b.mesh.polygons, NULL);
    exp_added *a = &b.run->add[b.run->added++];
    strcpy(a->name, "gone");
    snprintf(a->path, sizeof a->path, "%s/gone.obj", b.folder);
    a = &b.run->add[b.run->added++];
    strcpy(a->name, "garbage");
    snprintf(a->path, sizeof a->path, "%s/garbage.obj", b.folder);
    FILE *file = fopen(a->path, "w");
    fputs("v 0 0\nf 1 2 900\n", file);
    fclose(file);
    add_file(&b, "mug.obj", &b.mesh.polygons, b.atlas->input_corner_uv);
    assert_int_equal(measure_added(b.run, &all), SL_OK);
    assert_int_equal(all.added, 4);
    assert_int_equal(b.run->failed, 3);
    assert_non_null(strstr(b.run->failure[0].reason, "no UVs"));
    assert_string_equal(rows[0].mesh, "bare");
    assert_true(rows[0].numbers.failed && rows[1].numbers.failed && rows[2].numbers.failed && !rows[3].numbers.failed);
    bench_clear(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_file_is_named_after_a_model_up_to_a_word),
        cmocka_unit_test(uvs_on_scattered_triangles_measure_as_the_atlas_they_come_from),
        cmocka_unit_test(uvs_that_lie_twice_on_one_place_overlap),
        cmocka_unit_test(added_files_find_their_models),
        cmocka_unit_test(added_files_that_cannot_be_measured_are_rows),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
