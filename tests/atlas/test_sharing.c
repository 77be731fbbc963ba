/* Shared charts in the atlas: one place on the page, a check that still sees everything else, the sidecar read back. */
#include "atlas/atlas_internal.h"
#include "atlas/sidecar.h"
#include "segment/mirrored.h"

#include <stdio.h>

/* A body as polygons, by way of its mesh. */
typedef struct body_polygons {
    sl_mesh *mesh;
    sl_polygons polygons;
} body_polygons;

static body_polygons make_body(const test_mirrored *body, int32_t copies)
{
    body_polygons b = {.mesh = test_mirrored_mesh(body, copies)};
    b.polygons = (sl_polygons){b.mesh->nv, b.mesh->nf, b.mesh->xyz, b.mesh->face_first, b.mesh->origin};
    return b;
}

static sl_atlas_def small_def(void)
{
    sl_atlas_def def = sl_atlas_default();
    def.pack.resolution = 512;
    def.check_resolution = 1024;
    return def;
}

static sl_atlas *unwrap(const sl_polygons *polygons, const sl_atlas_def *def)
{
    sl_atlas *atlas = NULL;
    sl_diag diag = sl_diag_none();
    assert_int_equal(sl_unwrap(polygons, def, NULL, &atlas, &diag), SL_OK);
    return atlas;
}

static const test_mirrored one_mirror = {
    .n = 6, .mirrors = 1, .nspike = 2, .height = 1.1, .facets = TEST_QUADS, .seed = 0xa71a5};

/* Without the sharing the page holds both halves: then the scale must be smaller, by about the square root of 2. */
static void copies_lie_where_their_sources_lie_and_take_no_room(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x91ace);
    for (int trial = 0; trial < 3 * test_multiplier(); trial++) {
        test_mirrored body = one_mirror;
        body.seed = test_bits(&rng);
        body_polygons b = make_body(&body, 1 + trial % 2);
        sl_atlas_def def = small_def();
        sl_atlas *atlas = unwrap(&b.polygons, &def);
        const sl_segmentation *seg = atlas->segmentation;
        assert_true(atlas->check.passed);
        assert_int_equal(atlas->check.unlike, 0);
        assert_true(seg->sharing.copies > 0 && atlas->check.shared_texels > 0);
        assert_true(atlas->check.shared_texels <= atlas->check.covered_texels);
        for (int32_t h = 0; h < atlas->mesh->nh; h++) {
            const int32_t from = seg->source[h];
            assert_true(from < 0 ||
                        memcmp(atlas->corner_uv + 2 * h, atlas->corner_uv + 2 * from, 2 * sizeof(double)) == 0);
        }
        for (int32_t c = 0; c < seg->nchart; c++) {
            assert_memory_equal(&atlas->placement[c], &atlas->placement[sl_chart_shown(seg, c)],
                                sizeof atlas->placement[c]);
        }
        def.segment.unshare = true;
        sl_atlas *apart = unwrap(&b.polygons, &def);
        assert_true(apart->check.passed && apart->check.shared_texels == 0);
        assert_true(apart->pack.scale < 0.95 * atlas->pack.scale);
        sl_atlas_free(apart);
        sl_atlas_free(atlas);
        sl_mesh_free(b.mesh);
    }
}

static void the_check_sees_what_is_not_intended(void **state)
{
    (void)state;
    body_polygons b = make_body(&one_mirror, 1);
    const sl_atlas_def def = small_def();
    sl_atlas *atlas = unwrap(&b.polygons, &def);
    const sl_segmentation *seg = atlas->segmentation;
    double *uv = atlas->corner_uv;
    const int64_t shared = atlas->check.shared_texels;
    int32_t copied = -1, moved = 0;
    for (int32_t h = 0; h < atlas->mesh->nh; h++) {
        copied = seg->source[h] >= 0 ? h : copied;
    }
    const double kept = uv[2 * copied];
    uv[2 * copied] = nextafter(kept, 2.0); /* one corner of a copy, by one bit */
    assert_int_equal(sl_atlas_verify(atlas, &def, NULL), SL_OK);
    assert_true(!atlas->check.passed && atlas->check.unlike == 1);
    uv[2 * copied] = kept;
    seg->chart[seg->face_chart[atlas->mesh->face[copied]]].mirrored ^= true; /* a mirror image the wrong way round */
    assert_int_equal(sl_atlas_verify(atlas, &def, NULL), SL_OK);
    assert_true(!atlas->check.passed && atlas->check.flipped > 10);
    seg->chart[seg->face_chart[atlas->mesh->face[copied]]].mirrored ^= true;
    assert_int_equal(sl_atlas_verify(atlas, &def, NULL), SL_OK);
    assert_true(atlas->check.passed && atlas->check.shared_texels == shared);
    double *good = sl_copy(uv, atlas->mesh->nh, 2 * sizeof *good); /* both charts on one place, though no copies */
    seg->chart[seg->face_chart[atlas->mesh->face[copied]]].copy_of = -1;
    assert_int_equal(sl_atlas_verify(atlas, &def, NULL), SL_OK);
    assert_true(!atlas->check.passed && atlas->check.overlapping_texels > 100);
    for (int32_t h = 0; h < atlas->mesh->nh; h++) {
        moved += uv[2 * h] != good[2 * h];
    }
    assert_int_equal(moved, 0); /* looking changes nothing */
    sl_free(good);
    sl_atlas_free(atlas);
    sl_mesh_free(b.mesh);
}

/* A copy is moved with its source where a border needs room. */
static void clearing_borders_moves_copies_with_their_sources(void **state)
{
    (void)state;
    body_polygons b = make_body(&one_mirror, 2);
    const sl_atlas_def def = small_def();
    sl_atlas *atlas = unwrap(&b.polygons, &def);
    const int32_t *source = atlas->segmentation->source;
    for (int32_t h = 0; h < atlas->mesh->nh; h++) {
        if (source[h] >= 0) {
            atlas->corner_uv[2 * h] += 0.125;
        }
    }
    assert_int_equal(sl_atlas_clear_borders(atlas, NULL), SL_OK);
    for (int32_t h = 0; h < atlas->mesh->nh; h++) {
        const int32_t from = source[h];
        assert_true(from < 0 || atlas->corner_uv[2 * h] == atlas->corner_uv[2 * from]);
    }
    sl_atlas_free(atlas);
    sl_mesh_free(b.mesh);
}

static void the_sidecar_comes_back_as_it_was(void **state)
{
    (void)state;
    body_polygons b = make_body(&one_mirror, 2);
    const sl_atlas_def def = small_def();
    sl_atlas *atlas = unwrap(&b.polygons, &def);
    sl_diag diag = sl_diag_none();
    sl_sharing_table table;
    const char *path = test_scratch("body.atlas.json");
    assert_int_equal(sl_sidecar_write(path, atlas, &def, &diag), SL_OK);
    assert_int_equal(sl_sidecar_read(path, b.polygons.nf, &table, &diag), SL_OK);
    assert_int_equal(table.nchart, atlas->segmentation->nchart);
    assert_memory_equal(table.face_chart, atlas->segmentation->face_chart, (size_t)table.nf * sizeof(int32_t));
    for (int32_t c = 0; c < table.nchart; c++) {
        assert_int_equal(table.copy_of[c], atlas->segmentation->chart[c].copy_of);
    }
    sl_sharing_table_clear(&table);
    assert_int_equal(sl_sidecar_read(path, b.polygons.nf + 1, &table, &diag), SL_BAD_INPUT);
    assert_non_null(strstr(diag.reason, "another number of facets"));
    assert_null(table.face_chart);
    assert_int_equal(sl_sidecar_read(test_scratch("missing.json"), 3, &table, &diag), SL_IO);
    sl_atlas_free(atlas);
    sl_mesh_free(b.mesh);
}

static void sidecars_that_cannot_be_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        sl_status status;
    } cases[] = {
        {"{\"charts\":[{\"copy_of\":null},{\"copy_of\":0}],\"face_chart\":[0,1,1]}", SL_OK},
        {"{\"charts\":[{},{\"shares_with\":null}],\"face_chart\":[0,1,1]}", SL_OK}, /* schema 1 */
        {"{\"charts\":[{},{}],\"face_chart\":[0,2,1]}", SL_BAD_INPUT},
        {"{\"charts\":[{},{}],\"face_chart\":[0,-1,1]}", SL_BAD_INPUT},
        {"{\"charts\":[{},{}],\"face_chart\":[0,1e0,1]}", SL_BAD_INPUT},
        {"{\"charts\":[{},{\"copy_of\":2}],\"face_chart\":[0,1,1]}", SL_BAD_INPUT},
        {"{\"charts\":[{},{\"copy_of\":-1}],\"face_chart\":[0,1,1]}", SL_BAD_INPUT},
        {"{\"charts\":[{},{\"copy_of\":1}],\"face_chart\":[0,1,1]}", SL_BAD_INPUT}, /* a copy of a copy, itself */
        {"{\"charts\":[{},{\"copy_of\":99999999999}],\"face_chart\":[0,1,1]}", SL_BAD_INPUT},
        {"{\"charts\":[{},{},{},{}],\"face_chart\":[0,1,1]}", SL_BAD_INPUT},
        {"{\"charts\":7,\"face_chart\":[0,1,1]}", SL_BAD_INPUT},
        {"[]", SL_BAD_INPUT},
        {"{\"charts\":[", SL_BAD_INPUT},
        {"", SL_BAD_INPUT},
    };
    for (size_t k = 0; k < SL_COUNTOF(cases); k++) {
        const char *path = test_scratch("odd.atlas.json");
        sl_sharing_table table;
        FILE *file = fopen(path, "w");
        assert_non_null(file);
        fputs(cases[k].text, file);
        fclose(file);
        assert_int_equal(sl_sidecar_read(path, 3, &table, NULL), cases[k].status);
        assert_true((table.face_chart != NULL) == (cases[k].status == SL_OK));
        sl_sharing_table_clear(&table);
    }
}

static void measure_tells_sharing_from_overlap(void **state)
{
    (void)state;
    body_polygons b = make_body(&one_mirror, 2);
    const sl_atlas_def def = small_def();
    sl_atlas *atlas = unwrap(&b.polygons, &def);
    const sl_segmentation *seg = atlas->segmentation;
    int32_t *copy_of = malloc(((size_t)seg->nchart + 1) * sizeof *copy_of), copies = 0;
    for (int32_t c = 0; c < seg->nchart; c++) {
        copy_of[c] = seg->chart[c].copy_of;
        copies += copy_of[c] >= 0;
    }
    const sl_sharing_table table = {b.polygons.nf, seg->nchart + 1, seg->face_chart, copy_of};
    sl_atlas_measure with, without, partly;
    const double *uv = atlas->input_corner_uv;
    assert_int_equal(sl_measure_shared(&b.polygons, uv, &table, 512, NULL, &with, NULL), SL_OK);
    assert_int_equal(with.charts, seg->nchart);
    assert_int_equal(with.copies, copies);
    assert_true(with.overlap_inside == 0.0 && with.overlap_across == 0.0 && with.shared > 0.9);
    assert_int_equal(with.global.flipped, 0);
    assert_int_equal(sl_measure_atlas(&b.polygons, uv, 512, NULL, &without, NULL), SL_OK);
    assert_true(without.overlap_inside + without.overlap_across > 0.5 && without.copies == 0 && without.shared == 0.0);
    assert_true(without.fill == with.fill);
    int32_t last = -1, kept = -1;
    for (int32_t c = 0; c < seg->nchart; c++) {
        last = copy_of[c] >= 0 ? c : last;
    }
    kept = copy_of[last];
    copy_of[seg->nchart] = -1;
    copy_of[last] = seg->nchart; /* a copy said to be of another chart (without facets) than it is: overlap */
    assert_int_equal(sl_measure_shared(&b.polygons, uv, &table, 512, NULL, &partly, NULL), SL_OK);
    assert_true(partly.overlap_across > 0.0);
    copy_of[last] = kept;
    for (int32_t c = seg->nchart - 1; c >= 0; c--) { /* one copy not declared: its texels are overlap */
        if (copy_of[c] >= 0) {
            copy_of[c] = -1;
            break;
        }
    }
    assert_int_equal(sl_measure_shared(&b.polygons, uv, &table, 512, NULL, &partly, NULL), SL_OK);
    assert_true(partly.overlap_across > 0.0 && partly.copies == copies - 1);
    free(copy_of);
    sl_atlas_free(atlas);
    sl_mesh_free(b.mesh);
}

static void exact_without_a_symmetry_is_a_warning(void **state)
{
    (void)state;
    test_mirrored lopsided = one_mirror;
    lopsided.mirrors = 0;
    body_polygons b = make_body(&lopsided, 1);
    sl_atlas_def def = small_def();
    for (int exact = 0; exact < 2; exact++) {
        def.segment.symmetry = exact == 1 ? SL_SYMMETRY_USE_EXACT : SL_SYMMETRY_USE_AUTO;
        sl_atlas *atlas = unwrap(&b.polygons, &def);
        bool said = false;
        for (int32_t k = 0; k < atlas->nwarning; k++) {
            said |= strstr(atlas->warning[k].text, "no exact symmetry") != NULL;
        }
        assert_true(said == (exact == 1));
        sl_atlas_free(atlas);
    }
    sl_mesh_free(b.mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(copies_lie_where_their_sources_lie_and_take_no_room),
        cmocka_unit_test(the_check_sees_what_is_not_intended),
        cmocka_unit_test(clearing_borders_moves_copies_with_their_sources),
        cmocka_unit_test(the_sidecar_comes_back_as_it_was),
        cmocka_unit_test(sidecars_that_cannot_be_are_refused),
        cmocka_unit_test(measure_tells_sharing_from_overlap),
        cmocka_unit_test(exact_without_a_symmetry_is_a_warning),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
