/* Charts of the user's own cuts that overlap when laid flat: solved again, or not certified. */
#include "atlas/atlas.h"
#include "atlas/sidecar.h"
#include "atlas/uv_triangles.h"

#include "base/memory.h"
#include "overlap/exact.h"
#include "support/test_support.h"

#include <math.h>
#include <string.h>

enum { STEPS = 90, LANES = 4, VERTICES = (STEPS + 1) * (LANES + 1), FACETS = STEPS * LANES };

/* A winding ramp of more than one and a half turns: a disk, nearly developable onto a ring that covers itself. */
typedef struct ramp {
    double xyz[3 * VERTICES];
    int32_t first[FACETS + 1], index[4 * FACETS], label[FACETS];
    sl_polygons polygons;
} ramp;

static void make_ramp(test_rng *rng, ramp *r)
{
    for (int32_t v = 0; v < VERTICES; v++) {
        const double turn = 1.6 * 2.0 * TEST_PI * (v / (LANES + 1) + test_uniform(rng, -0.2, 0.2)) / STEPS;
        const double radius = 1.0 + 0.15 * (v % (LANES + 1) + test_uniform(rng, -0.2, 0.2));
        r->xyz[3 * v] = radius * cos(turn);
        r->xyz[3 * v + 1] = radius * sin(turn);
        r->xyz[3 * v + 2] = 0.06 * turn;
    }
    for (int32_t f = 0; f < FACETS; f++) {
        const int32_t a = f / LANES * (LANES + 1) + f % LANES;
        const int32_t corner[4] = {a, a + 1, a + LANES + 2, a + LANES + 1};
        memcpy(r->index + 4 * f, corner, sizeof corner);
        r->first[f] = 4 * f;
        r->label[f] = 7;
    }
    r->first[FACETS] = 4 * FACETS;
    r->polygons = (sl_polygons){VERTICES, FACETS, r->xyz, r->first, r->index};
}

static sl_atlas *unwrap(const ramp *r, bool plain)
{
    sl_atlas_def def = sl_atlas_default();
    sl_atlas *atlas = NULL;
    def.seams = SL_SEAMS_LABELS;
    def.seam_input.label = r->label;
    def.pack.resolution = 512;
    def.check_resolution = 512;
    if (plain) { /* ABF++ alone, whose border may cross itself */
        def.segment.flatten.minimise_stretch = false;
        def.segment.flatten.tutte = false;
    }
    assert_int_equal(sl_unwrap(&r->polygons, &def, NULL, &atlas, NULL), SL_OK);
    assert_int_equal(atlas->segmentation->nchart, 1);
    return atlas;
}

static int32_t overlapping_triangles(const ramp *r, const sl_atlas *atlas)
{
    sl_uv_triangles t;
    sl_exact_overlap found;
    uint8_t red[2 * FACETS];
    assert_int_equal(sl_uv_triangles_init(&r->polygons, atlas->input_corner_uv, NULL, &t, NULL), SL_OK);
    assert_int_equal(t.nt, 2 * FACETS);
    assert_int_equal(sl_overlap_exact(t.uv, t.nt, t.tri, NULL, red, &found), SL_OK);
    sl_uv_triangles_clear(&t);
    return found.red;
}

static void a_chart_that_covers_itself_is_solved_again_with_a_simple_border(void **state)
{
    (void)state;
    static ramp r;
    test_rng rng = test_rng_seed(0x4a3b);
    make_ramp(&rng, &r);
    sl_atlas *atlas = unwrap(&r, false);
    assert_true(atlas->check.passed && atlas->check.proven && atlas->check.uncertified_charts == 0);
    assert_int_equal(overlapping_triangles(&r, atlas), 0);
    sl_atlas_free(atlas);
}

static void an_atlas_that_covers_itself_is_not_certified_and_its_sidecar_says_so(void **state)
{
    (void)state;
    static ramp r;
    test_rng rng = test_rng_seed(0x0ba1);
    make_ramp(&rng, &r);
    sl_atlas *atlas = unwrap(&r, true);
    const sl_atlas_def def = sl_atlas_default();
    char *text = NULL;
    assert_true(!atlas->check.passed && !atlas->check.proven && atlas->check.uncertified_charts == 1);
    assert_true(atlas->check.overlapping_texels > 0);
    assert_true(overlapping_triangles(&r, atlas) > 20);
    assert_int_equal(sl_sidecar_text(atlas, &def, &text), SL_OK);
    assert_non_null(strstr(text, "\"passed\":false"));
    sl_free(text);
    sl_atlas_free(atlas);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_chart_that_covers_itself_is_solved_again_with_a_simple_border),
        cmocka_unit_test(an_atlas_that_covers_itself_is_not_certified_and_its_sidecar_says_so),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
