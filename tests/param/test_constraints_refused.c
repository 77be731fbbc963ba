/* Constraints that cannot be, are not what they should be, or are anything at all. */
#include "base/memory.h"
#include "param/abf_chart.h"
#include "param/constraint_charts.h"

static void refused(const sl_patch *patch, int32_t count, const sl_constraint *list, sl_status expected,
                    const char *words)
{
    sl_sector_table table;
    sl_diag diag = sl_diag_none();
    int32_t *name = malloc((size_t)patch->nv * sizeof *name);
    for (int32_t v = 0; v < patch->nv; v++) {
        name[v] = 1000 + v;
    }
    const sl_status status = sl_constraints_compile(patch, count, list, name, &table, &diag);
    if (status != expected || strstr(diag.reason, words) == NULL) {
        fail_msg("%s: %s; %s", sl_status_name(status), diag.reason, diag.hint);
    }
    assert_null(table.first);
    assert_int_equal(sl_constraints_compile(patch, count, list, NULL, &table, NULL), expected);
    if (expected == SL_INFEASIBLE && strstr(diag.reason, "vert") != NULL) {
        assert_non_null(strstr(diag.reason, " 10")); /* vertices go by the names given */
    }
    free(name);
}

static void what_cannot_be_is_refused_with_its_vertices_named(void **state)
{
    (void)state;
    sl_patch *patch = chart_hexagon(RINGS, 0.0, chart_bumps, 0.5, 0xc8);
    int32_t a[9], b[9], c[9], ring[6], corner[6];
    static const int32_t around[6][2] = {{1, 0}, {0, 1}, {-1, 1}, {-1, 0}, {0, -1}, {1, -1}};
    for (int k = 0; k < 6; k++) {
        ring[k] = lattice(patch, chart_bumps, 0.5, around[k][0], around[k][1]);
        corner[k] = lattice(patch, chart_bumps, 0.5, corner_at[k][0], corner_at[k][1]);
    }
    const int32_t closed[] = {ring[0], ring[1], ring[2], ring[3], ring[4], ring[5], ring[0]};
    refused(patch, 1, &(sl_constraint){SL_CONSTRAINT_STRAIGHT, 7, closed, 0.0}, SL_INFEASIBLE, "come back to vertex");
    sl_constraint two[3] = {lattice_path(patch, 0.5, (int32_t[]){-4, 0}, (int32_t[]){1, 0}, 9, a),
                            lattice_path(patch, 0.5, (int32_t[]){2, 0}, (int32_t[]){-1, 0}, 3, b)};
    refused(patch, 2, two, SL_INFEASIBLE, "share the edge");
    const int32_t bow[] = {a[2], lattice(patch, chart_bumps, 0.5, -1, -1), ring[4], a[4]};
    two[1] = (sl_constraint){SL_CONSTRAINT_STRAIGHT, 4, bow, 0.0};
    refused(patch, 2, two, SL_INFEASIBLE, "meet twice");
    const int32_t touching[] = {ring[1], a[4], ring[2]}; /* both sides of the row's upper half */
    two[1] = (sl_constraint){SL_CONSTRAINT_STRAIGHT, 3, touching, 0.0};
    refused(patch, 2, two, SL_INFEASIBLE, "touch without crossing");
    two[1] = lattice_path(patch, 0.5, (int32_t[]){0, -4}, (int32_t[]){0, 1}, 9, b);
    two[2] = lattice_path(patch, 0.5, (int32_t[]){-3, 4}, (int32_t[]){1, -1}, 8, c); /* q + r = 1 */
    refused(patch, 3, two, SL_INFEASIBLE, "angles around a region"); /* a triangle of three right angles */
    refused(patch, 1, &(sl_constraint){SL_CONSTRAINT_POLYGON, 4, corner, 1.2}, SL_INFEASIBLE, "degrees too small");
    refused(patch, 1, &(sl_constraint){SL_CONSTRAINT_POLYGON, 3, corner, 1.2}, SL_INFEASIBLE, "degrees too large");
    refused(patch, 1, &(sl_constraint){SL_CONSTRAINT_BORDER, 2, (int32_t[]){corner[0], corner[0]}, 0.0}, SL_INFEASIBLE,
            "closed path");
    refused(patch, 1, &(sl_constraint){SL_CONSTRAINT_ANGLE, 1, corner, 6.2840}, SL_INFEASIBLE, "cannot be");
    refused(patch, 2, (sl_constraint[]){{SL_CONSTRAINT_ANGLE, 1, corner, 1.5}, {SL_CONSTRAINT_ANGLE, 1, corner, 1.6}},
            SL_INFEASIBLE, "asked for two angles");
    refused(patch, 2, (sl_constraint[]){{SL_CONSTRAINT_ANGLE, 1, corner, 1.5}, {SL_CONSTRAINT_RIGHT, 1, corner, 0.0}},
            SL_INFEASIBLE, "two different angles");
    refused(patch, 1, &(sl_constraint){SL_CONSTRAINT_RIGHT, 1, ring, 0.0}, SL_INFEASIBLE, "no two lines");
    refused(patch, 1, &(sl_constraint){SL_CONSTRAINT_ANGLE, 1, corner, -0.5}, SL_INFEASIBLE, "not positive");
    two[2] = (sl_constraint){SL_CONSTRAINT_RIGHT, 1, &a[4], 0.0};
    int32_t third[9];
    sl_constraint three[4] = {two[0], two[1],
                              lattice_path(patch, 0.5, (int32_t[]){-3, 3}, (int32_t[]){1, -1}, 7, third), two[2]};
    refused(patch, 4, three, SL_INFEASIBLE, "cannot make right angles");
    sl_patch_free(patch);
}

/* An ear: its tip has one triangle, which a straight border would have to flatten. */
static void a_sector_with_too_few_triangles_is_refused(void **state)
{
    (void)state;
    static const double xyz[] = {0.1, 0.2, 0.3, 1.3, 0.1, 0.2, 0.6, 0.9, 0.4, 1.7, 1.1, 0.1};
    static const int32_t tri[] = {0, 1, 2, 2, 1, 3};
    sl_patch *patch = chart_make(4, xyz, 2, tri);
    int32_t tip = -1, ends[2] = {-1, -1};
    for (int32_t v = 0; v < 4; v++) {
        if (chart_max_diff(&patch->xyz[3 * v], &xyz[9], 3) == 0.0) {
            tip = v;
        }
    }
    for (int32_t h = 0; h < 6; h++) {
        ends[1] = patch->twin[h] < 0 && patch->tri[h] == tip ? patch->tri[sl_corner_next(h)] : ends[1];
        ends[0] = patch->twin[h] < 0 && patch->tri[sl_corner_next(h)] == tip ? patch->tri[h] : ends[0];
    }
    refused(patch, 1, &(sl_constraint){SL_CONSTRAINT_BORDER, 2, ends, 0.0}, SL_INFEASIBLE, "sector of 1 triangle at");
    const double theta[] = {2.9, 0.1}; /* two angles of one triangle and a third that is free */
    for (int32_t k = 0; k < 2; k++) {
        sl_constraint list[2] = {{SL_CONSTRAINT_ANGLE, 1, &tip, theta[0]},
                                 {SL_CONSTRAINT_ANGLE, 1, &ends[0], theta[k]}};
        sl_sector_table table;
        assert_int_equal(sl_constraints_compile(patch, 2, list, NULL, &table, NULL), SL_OK);
        sl_sectors_clear(&table);
    }
    sl_patch_free(patch);
}

/* All of a triangle fan's corners but one are prescribed: what is left for it must be an angle. */
static void what_is_left_for_free_angles_must_be_an_angle(void **state)
{
    (void)state;
    static const double xyz[] = {0.1, 0.2, 0.3, 1.3, 0.1, 0.2, 0.6, 0.9, 0.4};
    static const int32_t tri[] = {0, 1, 2};
    sl_patch *patch = chart_make(3, xyz, 1, tri);
    static const int32_t v[] = {0, 1};
    sl_constraint list[2] = {{SL_CONSTRAINT_ANGLE, 1, &v[0], 1.9}, {SL_CONSTRAINT_ANGLE, 1, &v[1], 1.3}};
    refused(patch, 2, list, SL_INFEASIBLE, "leave -");
    list[1].angle = 1.2;
    check_solution(patch, 2, list, 1e-9);
    sl_patch_free(patch);
}

/* Two triangles, five of six corners prescribed: the sixth, a whole angle of a triangle, would have to be too large. */
static void one_free_angle_cannot_hold_more_than_a_half_turn(void **state)
{
    (void)state;
    static const double xyz[] = {0.1, 0.2, 0.3, 1.3, 0.1, 0.2, 0.6, 0.9, 0.4, 1.7, 1.1, 0.1};
    static const int32_t tri[] = {0, 1, 2, 2, 1, 3};
    sl_patch *patch = chart_make(4, xyz, 2, tri);
    int32_t v[4], n = 0;
    for (int32_t i = 0; i < 4; i++) { /* the tip at last */
        const bool tip = chart_max_diff(&patch->xyz[3 * i], &xyz[9], 3) == 0.0;
        v[tip ? 3 : n++] = i;
    }
    sl_constraint list[3];
    for (int32_t i = 0; i < 3; i++) {
        list[i] = (sl_constraint){SL_CONSTRAINT_ANGLE, 1, &v[i], 0.9 + 0.1 * i};
    }
    refused(patch, 3, list, SL_INFEASIBLE, "leave 188.");
    list[0].angle = 1.5;
    check_solution(patch, 3, list, 1e-9);
    sl_patch_free(patch);
}

/* A border vertex of four triangles; a line comes in along its second edge and leaves along its fourth. What is asked
 * of the whole angle is left to the two outer triangles. */
static void a_line_through_a_border_vertex_leaves_the_rest_of_its_angle(void **state)
{
    (void)state;
    int32_t found = 0;
    for (uint64_t seed = 1; seed <= 12; seed++) {
        sl_patch *patch = chart_grid(6, 5, 0.1, chart_bumps, 0.4, seed);
        for (int32_t v = 0; v < patch->nv && found < 6; v++) {
            int32_t fan[8], size = 0;
            for (int32_t c = patch->outgoing[v]; patch->border[v] != 0 && c >= 0 && size < 8;
                 c = sl_corner_rotate(patch, c)) {
                fan[size++] = c;
            }
            if (size != 4) {
                continue;
            }
            const int32_t path[] = {patch->tri[sl_corner_next(fan[1])], v, patch->tri[sl_corner_next(fan[3])]};
            const sl_constraint list[] = {{SL_CONSTRAINT_STRAIGHT, 3, path, 0.0}, {SL_CONSTRAINT_ANGLE, 1, &v, 4.4}};
            sl_sector_table table = compile(patch, 2, list);
            int32_t at = 0;
            for (int32_t s = 0; s < table.view.count; s++) {
                if (table.vertex[s] == v) {
                    const int32_t *corner = &table.corner[table.first[s]];
                    const bool line = table.origin[s] == 0;
                    assert_int_equal(table.first[s + 1] - table.first[s], 2);
                    assert_true(corner[0] == fan[line ? 1 : 0] && corner[1] == fan[line ? 2 : 3]);
                    assert_true(test_near(table.theta[s], line ? PI : 4.4 - PI, 1e-15));
                    at++;
                }
            }
            assert_int_equal(at, 2);
            sl_sectors_clear(&table);
            check_solution(patch, 2, list, 1e-9);
            const sl_constraint narrow[] = {list[0], {SL_CONSTRAINT_ANGLE, 1, &v, 3.0}};
            refused(patch, 2, narrow, SL_INFEASIBLE, "no room");
            found++;
        }
        sl_patch_free(patch);
    }
    assert_int_equal(found, 6);
}

static void unusable_constraints_are_bad_input(void **state)
{
    (void)state;
    sl_patch *patch = chart_hexagon(RINGS, 0.0, chart_bumps, 0.5, 0xc9);
    const int32_t inside = lattice(patch, chart_bumps, 0.5, 1, 1), far = lattice(patch, chart_bumps, 0.5, 3, 1);
    int32_t corner[6];
    for (int k = 0; k < 6; k++) {
        corner[k] = lattice(patch, chart_bumps, 0.5, corner_at[k][0], corner_at[k][1]);
    }
    const int32_t crossed[] = {corner[0], corner[2], corner[1], corner[3]};
    refused(patch, 1, &(sl_constraint){SL_CONSTRAINT_ANGLE, 1, &inside, 1.0}, SL_BAD_INPUT,
            "not on the chart's border");
    refused(patch, 1, &(sl_constraint){SL_CONSTRAINT_ANGLE, 1, corner, NAN}, SL_BAD_INPUT, "not a number");
    refused(patch, 1, &(sl_constraint){SL_CONSTRAINT_ANGLE, 0, corner, 1.0}, SL_BAD_INPUT, "at least 1");
    refused(patch, 1, &(sl_constraint){SL_CONSTRAINT_STRAIGHT, 1, corner, 0.0}, SL_BAD_INPUT, "at least 2");
    refused(patch, 1, &(sl_constraint){SL_CONSTRAINT_POLYGON, 2, corner, 0.0}, SL_BAD_INPUT, "at least 3");
    refused(patch, 1, &(sl_constraint){SL_CONSTRAINT_STRAIGHT, 2, (int32_t[]){inside, far}, 0.0}, SL_BAD_INPUT,
            "no edge joins");
    refused(patch, 1, &(sl_constraint){SL_CONSTRAINT_RIGHT, 1, (int32_t[]){patch->nv}, 0.0}, SL_BAD_INPUT,
            "not in the chart");
    refused(patch, 1, &(sl_constraint){SL_CONSTRAINT_POLYGON, 4, crossed, 0.0}, SL_BAD_INPUT, "not in border order");
    sl_patch_free(patch);
}

/* A random constraint on random vertices; paths are walks along edges, which may cross themselves. */
static sl_constraint random_constraint(const sl_patch *patch, const int32_t *border, int32_t nb, test_rng *rng,
                                       int32_t *vertex)
{
    static const int32_t counts[] = {1, 0, 2, 4, 1};
    sl_constraint constraint = {(sl_constraint_kind)test_index(rng, 5), 0, vertex, 0.0};
    constraint.count = counts[constraint.kind];
    constraint.angle = constraint.kind == SL_CONSTRAINT_ANGLE ? test_uniform(rng, 0.3, 5.0) : 0.0;
    const int32_t at = test_index(rng, nb);
    for (int32_t i = 0; i < constraint.count; i++) { /* border vertices in border order */
        vertex[i] = patch->tri[border[(at + i * nb / 4 + test_index(rng, 3)) % nb]];
    }
    if (constraint.kind == SL_CONSTRAINT_RIGHT) {
        vertex[0] = test_index(rng, patch->nv);
    }
    if (constraint.kind == SL_CONSTRAINT_STRAIGHT) {
        vertex[constraint.count++] = test_index(rng, patch->nv);
        for (int32_t steps = 1 + test_index(rng, 6); steps > 0; steps--) {
            int32_t c = patch->outgoing[vertex[constraint.count - 1]];
            for (int32_t turn = test_index(rng, 6); turn > 0; turn--) {
                const int32_t next = sl_corner_rotate(patch, c);
                c = next >= 0 ? next : c;
            }
            vertex[constraint.count++] = patch->tri[sl_corner_next(c)];
        }
    }
    return constraint;
}

/* No corner twice; the sectors of an interior vertex make its whole turn. */
static void check_table(const sl_patch *patch, const sl_sector_table *table)
{
    double *turn = calloc((size_t)patch->nv, sizeof *turn);
    int32_t *taken = calloc(3 * (size_t)patch->nt, sizeof *taken);
    for (int32_t s = 0; s < table->view.count; s++) {
        turn[table->vertex[s]] += table->theta[s];
        for (int32_t p = table->first[s]; p < table->first[s + 1]; p++) {
            assert_int_equal(taken[table->corner[p]]++, 0);
            assert_int_equal(patch->tri[table->corner[p]], table->vertex[s]);
        }
    }
    for (int32_t c = 0; c < 3 * patch->nt; c++) {
        if (patch->border[patch->tri[c]] == 0) {
            assert_true(taken[c] == 1 && test_near(turn[patch->tri[c]], 2.0 * PI, 1e-14));
        }
    }
    free(turn);
    free(taken);
}

/* Whatever is asked: a clear refusal, or a table that is one, and a chart without a flip. */
static void random_constraints_are_refused_or_lead_to_a_valid_chart(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xcb);
    int32_t solved = 0, refusals = 0;
    for (int32_t trial = 0; trial < 300 * test_multiplier(); trial++) {
        sl_patch *patch = chart_hexagon(4, 0.15, chart_bumps, 0.6, (uint64_t)trial);
        int32_t *first, *border, vertex[4][8], count = 1 + test_index(&rng, 4);
        sl_constraint list[4];
        sl_sector_table table;
        sl_diag diag = sl_diag_none();
        assert_int_equal(sl_patch_border(patch, &first, &border), SL_OK);
        for (int32_t i = 0; i < count; i++) {
            list[i] = random_constraint(patch, border, first[1], &rng, vertex[i]);
        }
        const sl_status status = sl_constraints_compile(patch, count, list, NULL, &table, &diag);
        if (status == SL_OK) {
            sl_abf_def def = sl_abf_default();
            sl_abf_chart *chart;
            check_table(patch, &table);
            def.sectors = &table.view;
            assert_int_equal(sl_abf_chart_create(patch, &def, NULL, &chart), SL_OK);
            const sl_abf_chart_info *info = sl_abf_chart_info_of(chart);
            assert_true(info->valid && info->converged && info->quality.flipped == 0);
            assert_true(info->reached < 1.0 || info->distance <= 1e-11);
            solved += info->reached == 1.0;
            sl_abf_chart_free(chart);
            sl_sectors_clear(&table);
        } else {
            assert_true(status == SL_INFEASIBLE || status == SL_BAD_INPUT);
            assert_true(strlen(diag.reason) > 10);
            refusals++;
        }
        sl_free(first);
        sl_free(border);
        sl_patch_free(patch);
    }
    assert_true(solved > 60 && refusals > 60);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_cannot_be_is_refused_with_its_vertices_named),
        cmocka_unit_test(a_sector_with_too_few_triangles_is_refused),
        cmocka_unit_test(what_is_left_for_free_angles_must_be_an_angle),
        cmocka_unit_test(one_free_angle_cannot_hold_more_than_a_half_turn),
        cmocka_unit_test(a_line_through_a_border_vertex_leaves_the_rest_of_its_angle),
        cmocka_unit_test(unusable_constraints_are_bad_input),
        cmocka_unit_test(random_constraints_are_refused_or_lead_to_a_valid_chart),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
