/* Seams that meet at right angles between charts: two to four charts around one vertex of a bumpy sheet. */
#include "mesh/mesh_fixtures.h"
#include "param/constraint_charts.h"

enum { HALF = 6, SIDE = 2 * HALF };

typedef struct sheet {
    sl_mesh *mesh;
    sl_triangulation *triangulation;
    double middle[3];
} sheet;

static sheet make_sheet(uint64_t seed)
{
    static soup s;
    test_rng rng = test_rng_seed(seed);
    sheet out = {0};
    soup_clear(&s);
    for (int32_t i = 0; i <= SIDE; i++) {
        for (int32_t j = 0; j <= SIDE; j++) {
            double x[3];
            chart_bumps((j + test_uniform(&rng, -0.25, 0.25)) / SIDE - 0.5,
                        (i + test_uniform(&rng, -0.25, 0.25)) / SIDE - 0.5, 1.4, x);
            soup_vertex(&s, x[0], x[1], x[2]);
        }
    }
    for (int32_t i = 0; i < SIDE * SIDE; i++) {
        const int32_t a = i / SIDE * (SIDE + 1) + i % SIDE, q[4] = {a, a + 1, a + SIDE + 2, a + SIDE + 1};
        const int32_t d = test_index(&rng, 2);
        soup_face(&s, 3, (int32_t[]){q[d], q[d + 1], q[d + 2]});
        soup_face(&s, 3, (int32_t[]){q[d], q[d + 2], q[(d + 3) % 4]});
    }
    const sl_polygons polygons = soup_polygons(&s);
    assert_int_equal(sl_mesh_build(&polygons, &out.mesh, NULL, NULL), SL_OK);
    assert_int_equal(sl_triangulation_create(out.mesh, &out.triangulation), SL_OK);
    const int32_t v = HALF * (SIDE + 1) + HALF;
    memcpy(out.middle, &out.mesh->xyz[3 * v], sizeof out.middle);
    return out;
}

static void clear(sheet *s)
{
    sl_triangulation_free(s->triangulation);
    sl_mesh_free(s->mesh);
}

/* The chart of the quarters whose bits are set: 1 and 2 below, 4 and 8 above; *vertex = the middle of the sheet. */
static sl_patch *take(const sheet *s, int32_t quarters, int32_t *vertex)
{
    int32_t list[2 * SIDE * SIDE], n = 0;
    sl_patch *patch = NULL;
    for (int32_t f = 0; f < 2 * SIDE * SIDE; f++) {
        const int32_t cell = f / 2, quarter = (cell / SIDE >= HALF ? 2 : 0) + (cell % SIDE >= HALF ? 1 : 0);
        if ((quarters >> quarter & 1) != 0) {
            list[n++] = f;
        }
    }
    assert_int_equal(sl_patch_extract(s->mesh, s->triangulation, list, n, &patch), SL_OK);
    assert_true(sl_patch_is_disk(patch));
    *vertex = -1;
    for (int32_t v = 0; v < patch->nv; v++) {
        if (memcmp(&patch->xyz[3 * v], s->middle, sizeof s->middle) == 0) {
            *vertex = v;
        }
    }
    assert_true(*vertex >= 0 && patch->border[*vertex] != 0);
    return patch;
}

/* Flattens every chart with its share, and adds up what they have at the point; shares[k]: in quarter turns. */
static void check_meeting(uint64_t seed, int32_t count, const int32_t *quarters, const int32_t *shares)
{
    sheet s = make_sheet(seed);
    sl_patch *patch[4];
    int32_t vertex[4];
    sl_constraint item[4];
    double sum = 0.0;
    for (int32_t k = 0; k < count; k++) {
        patch[k] = take(&s, quarters[k], &vertex[k]);
    }
    assert_int_equal(sl_constraints_cross_seams(count, (const sl_patch *const *)patch, vertex, item, NULL), SL_OK);
    for (int32_t k = 0; k < count; k++) {
        assert_true(item[k].kind == SL_CONSTRAINT_ANGLE && item[k].count == 1 && item[k].vertex == &vertex[k]);
        assert_true(test_near(item[k].angle, 0.5 * PI * shares[k], 1e-15));
        check_solution(patch[k], 1, &item[k], 1e-9);
        sum += item[k].angle;
        sl_patch_free(patch[k]);
    }
    assert_true(test_near(sum, 2.0 * PI, 1e-14)); /* the charts close around the point */
    clear(&s);
}

static void two_seams_cross_between_four_charts(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 3; seed++) {
        check_meeting(seed, 4, (int32_t[]){1, 2, 8, 4}, (int32_t[]){1, 1, 1, 1});
    }
}

/* Wherever the chart that is straight stands in the list. */
static void a_seam_ends_on_another_between_three_charts(void **state)
{
    (void)state;
    check_meeting(4, 3, (int32_t[]){1, 2, 12}, (int32_t[]){1, 1, 2});
    check_meeting(5, 3, (int32_t[]){3, 4, 8}, (int32_t[]){2, 1, 1});
    check_meeting(6, 3, (int32_t[]){2, 5, 8}, (int32_t[]){1, 2, 1});
}

static void a_seam_is_straight_between_two_charts(void **state)
{
    (void)state;
    check_meeting(7, 2, (int32_t[]){3, 12}, (int32_t[]){2, 2});
    check_meeting(8, 2, (int32_t[]){5, 10}, (int32_t[]){2, 2});
}

static void what_cannot_meet_is_refused(void **state)
{
    (void)state;
    sheet s = make_sheet(9);
    int32_t vertex[5] = {0}, inner = 0;
    sl_constraint item[5];
    sl_diag diag = sl_diag_none();
    sl_patch *quarter = take(&s, 1, &vertex[0]), *half = take(&s, 12, &vertex[1]);
    const sl_patch *patch[5] = {quarter, half, quarter, quarter, quarter};
    vertex[2] = vertex[3] = vertex[4] = vertex[0];
    assert_int_equal(sl_constraints_cross_seams(1, patch, vertex, item, &diag), SL_INFEASIBLE);
    assert_int_equal(sl_constraints_cross_seams(5, patch, vertex, item, &diag), SL_INFEASIBLE);
    assert_non_null(strstr(diag.reason, "5 charts"));
    while (half->border[inner] != 0) {
        inner++;
    }
    vertex[1] = inner;
    assert_int_equal(sl_constraints_cross_seams(2, patch, vertex, item, &diag), SL_BAD_INPUT);
    vertex[1] = half->nv;
    assert_int_equal(sl_constraints_cross_seams(2, patch, vertex, item, NULL), SL_BAD_INPUT);
    vertex[1] = -1;
    assert_int_equal(sl_constraints_cross_seams(2, patch, vertex, item, &diag), SL_BAD_INPUT);
    assert_non_null(strstr(diag.reason, "chart 2"));
    for (int32_t v = 0; v < half->nv; v++) { /* a corner of one triangle */
        if (half->border[v] != 0 && half->twin[sl_corner_prev(half->outgoing[v])] < 0) {
            vertex[1] = v;
        }
    }
    assert_true(vertex[1] >= 0);
    assert_int_equal(sl_constraints_cross_seams(2, patch, vertex, item, &diag), SL_INFEASIBLE);
    assert_non_null(strstr(diag.reason, "one triangle"));
    sl_patch_free(quarter);
    sl_patch_free(half);
    clear(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_seams_cross_between_four_charts),
        cmocka_unit_test(a_seam_ends_on_another_between_three_charts),
        cmocka_unit_test(a_seam_is_straight_between_two_charts),
        cmocka_unit_test(what_cannot_meet_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
