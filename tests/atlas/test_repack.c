/* Existing UVs packed anew: a curved surface cut into patches, some of them lying on others. */
#include "atlas/repack.h"
#include "overlap/exact.h"
#include "support/test_support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { GRID = 5, PATCHES = 6, FACES = PATCHES * GRID * GRID, CORNERS = 4 * FACES };

/* Patches of a wavy sheet, apart from one another; UVs by corner, jittered inside. */
typedef struct sheet {
    double xyz[3 * PATCHES * (GRID + 1) * (GRID + 1)];
    int32_t first[FACES + 1], index[CORNERS];
    double uv[2 * CORNERS];
    sl_polygons polygons;
} sheet;

static void add_patch(test_rng *rng, int32_t patch, sheet *s)
{
    const int32_t base = patch * (GRID + 1) * (GRID + 1);
    const double size = test_uniform(rng, 0.5, 2.0), turn = test_uniform(rng, 0, 7);
    double uv[2 * (GRID + 1) * (GRID + 1)];
    for (int32_t v = 0; v < (GRID + 1) * (GRID + 1); v++) {
        const double x = v % (GRID + 1) + test_uniform(rng, -0.2, 0.2);
        const double y = v / (GRID + 1) + test_uniform(rng, -0.2, 0.2);
        double *p = s->xyz + 3 * (base + v);
        p[0] = size * x + 20.0 * patch;
        p[1] = size * y;
        p[2] = 0.3 * size * sin(x + 0.7 * y);
        uv[2 * v] = size * (cos(turn) * x - sin(turn) * y);
        uv[2 * v + 1] = size * (sin(turn) * x + cos(turn) * y);
    }
    for (int32_t k = 0; k < GRID * GRID; k++) {
        const int32_t f = patch * GRID * GRID + k, v = k / GRID * (GRID + 1) + k % GRID;
        const int32_t corner[4] = {v, v + 1, v + GRID + 2, v + GRID + 1};
        s->first[f + 1] = 4 * (f + 1);
        for (int i = 0; i < 4; i++) {
            s->index[4 * f + i] = base + corner[i];
            memcpy(s->uv + 2 * (4 * f + i), uv + 2 * corner[i], 2 * sizeof *uv);
        }
    }
}

static sheet *make_sheet(uint64_t seed)
{
    test_rng rng = test_rng_seed(seed);
    sheet *s = calloc(1, sizeof *s);
    for (int32_t p = 0; p < PATCHES; p++) {
        add_patch(&rng, p, s);
    }
    s->polygons = (sl_polygons){PATCHES * (GRID + 1) * (GRID + 1), FACES, s->xyz, s->first, s->index};
    return s;
}

/* Patch `to` gets the UVs of patch `from`. */
static void share(sheet *s, int32_t from, int32_t to)
{
    const size_t corners = 4 * GRID * GRID;
    memcpy(s->uv + 2 * corners * (size_t)to, s->uv + 2 * corners * (size_t)from, 2 * corners * sizeof *s->uv);
}

static sl_repack_def small_def(void)
{
    sl_repack_def def = sl_repack_default();
    def.pack.resolution = 256;
    def.pack.margin = 3.0;
    def.pack.effort = 0;
    return def;
}

static double edge(const double *uv, int32_t a, int32_t b)
{
    return hypot(uv[2 * a] - uv[2 * b], uv[2 * a + 1] - uv[2 * b + 1]);
}

/* All six distances in a quad are the input's times one scale: charts keep their form and size. */
static void charts_keep_their_form_and_their_sizes(void **state)
{
    (void)state;
    sheet *s = make_sheet(0x4e9a);
    const sl_repack_def def = small_def();
    sl_repacked r;
    assert_int_equal(sl_repack(&s->polygons, s->uv, NULL, &def, NULL, &r, NULL), SL_OK);
    assert_true(r.passed && r.red == 0 && r.charts == PATCHES && r.copies == 0 && r.pack.pages == 1);
    assert_true(r.clearance >= 3.0 - 1e-6);
    for (int32_t f = 0; f < FACES; f++) {
        for (int32_t i = 0; i < 4; i++) {
            for (int32_t j = 0; j < i; j++) {
                const double before = edge(s->uv, 4 * f + i, 4 * f + j),
                             after = edge(r.corner_uv, 4 * f + i, 4 * f + j);
                assert_true(test_near(after, r.pack.scale * before, 1e-11));
            }
        }
    }
    sl_repacked_clear(&r);
    free(s);
}

static void charts_that_lie_on_one_another_stay_together(void **state)
{
    (void)state;
    sheet *s = make_sheet(0x4e9b);
    const sl_repack_def def = small_def();
    sl_repacked plain, shared;
    assert_int_equal(sl_repack(&s->polygons, s->uv, NULL, &def, NULL, &plain, NULL), SL_OK);
    share(s, 1, 4);
    share(s, 1, 5);
    assert_int_equal(sl_repack(&s->polygons, s->uv, NULL, &def, NULL, &shared, NULL), SL_OK);
    assert_true(shared.passed && shared.charts == PATCHES && shared.copies == 2);
    assert_true(shared.table.copy_of[4] == 1 && shared.table.copy_of[5] == 1 && shared.table.copy_of[1] == -1);
    for (int32_t i = 0; i < 8 * GRID * GRID; i++) {
        assert_true(shared.corner_uv[8 * GRID * GRID * 4 + i] == shared.corner_uv[8 * GRID * GRID + i]);
        assert_true(shared.corner_uv[8 * GRID * GRID * 5 + i] == shared.corner_uv[8 * GRID * GRID + i]);
    }
    s->uv[2 * (4 * GRID * GRID * 4 + 3)] += 1e-9; /* no longer exactly */
    sl_repacked_clear(&shared);
    assert_int_equal(sl_repack(&s->polygons, s->uv, NULL, &def, NULL, &shared, NULL), SL_OK);
    assert_true(shared.passed && shared.copies == 1);
    sl_repacked_clear(&plain);
    sl_repacked_clear(&shared);
    free(s);
}

/* Mean direction of growing y in a patch's UVs, by its left and right ends. */
static void charts_stand_upright_where_they_may_not_turn(void **state)
{
    (void)state;
    sheet *s = make_sheet(0x4e9c);
    sl_repack_def def = small_def();
    sl_repacked r;
    def.pack.rotations = SL_ROTATE_NONE;
    def.up = SL_UP_Y;
    assert_int_equal(sl_repack(&s->polygons, s->uv, NULL, &def, NULL, &r, NULL), SL_OK);
    for (int32_t p = 0; p < PATCHES; p++) {
        const int32_t bottom = 4 * (p * GRID * GRID + GRID / 2), top = bottom + 4 * GRID * (GRID - 1) + 3;
        const double dx = r.corner_uv[2 * top] - r.corner_uv[2 * bottom];
        const double dy = r.corner_uv[2 * top + 1] - r.corner_uv[2 * bottom + 1];
        assert_true(dy > 0.0 && fabs(dx) < 0.2 * dy);
    }
    sl_repacked_clear(&r);
    free(s);
}

static void pages_become_tiles_of_the_density_asked_for(void **state)
{
    (void)state;
    sheet *s = make_sheet(0x4e9d);
    sl_repack_def def = small_def();
    sl_repacked r;
    sl_diag diag = sl_diag_none();
    assert_int_equal(sl_repack(&s->polygons, s->uv, NULL, &def, NULL, &r, NULL), SL_OK);
    def.pack.density = 1.3 * r.texels_a_unit;
    def.pack.pages = 20;
    def.pack.height = 200;
    sl_repacked_clear(&r);
    assert_int_equal(sl_repack(&s->polygons, s->uv, NULL, &def, NULL, &r, NULL), SL_OK);
    assert_true(r.passed && r.pack.pages > 1 && test_near(r.texels_a_unit, def.pack.density, 1e-9 * r.texels_a_unit));
    for (int32_t c = 0; c < CORNERS; c++) {
        const int32_t page = r.page[c / (4 * GRID * GRID)];
        const double u = r.corner_uv[2 * c] - page % 10, v = r.corner_uv[2 * c + 1] - page / 10;
        assert_true(u > 1.0 / 256 && u < 1.0 - 1.0 / 256 && v > 1.0 / 200 && v < 1.0 - 1.0 / 200);
    }
    sl_repacked_clear(&r);
    def.pack.pages = 1;
    assert_int_equal(sl_repack(&s->polygons, s->uv, NULL, &def, NULL, &r, &diag), SL_INFEASIBLE);
    assert_non_null(strstr(diag.hint, "--density"));
    sl_repacked_clear(&r);
    free(s);
}

static void overlaps_inside_a_chart_are_the_inputs_own(void **state)
{
    (void)state;
    sheet *s = make_sheet(0x4e9e);
    const sl_repack_def def = small_def();
    sl_repacked r;
    sl_diag diag = sl_diag_none();
    for (int32_t c = 0; c < CORNERS; c++) { /* an inner vertex of the first patch flies across it */
        if (s->index[c] == 2 * (GRID + 1) + 2) {
            s->uv[2 * c] += 3.0 * (s->uv[2] - s->uv[0]);
            s->uv[2 * c + 1] += 3.0 * (s->uv[3] - s->uv[1]);
        }
    }
    assert_int_equal(sl_repack(&s->polygons, s->uv, NULL, &def, NULL, &r, NULL), SL_OK);
    assert_true(r.passed && r.red > 0 && r.red == r.red_inside && r.charts == PATCHES);
    sl_repacked_clear(&r);
    s->uv[77] = NAN;
    assert_int_equal(sl_repack(&s->polygons, s->uv, NULL, &def, NULL, &r, &diag), SL_BAD_INPUT);
    assert_true(diag.element == 77 / 8);
    sl_repacked_clear(&r);
    free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(charts_keep_their_form_and_their_sizes),
        cmocka_unit_test(charts_that_lie_on_one_another_stay_together),
        cmocka_unit_test(charts_stand_upright_where_they_may_not_turn),
        cmocka_unit_test(pages_become_tiles_of_the_density_asked_for),
        cmocka_unit_test(overlaps_inside_a_chart_are_the_inputs_own),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
