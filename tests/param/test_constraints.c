/* Constraints on flat charts: the sectors they make, the layouts they lead to, pins. */
#include "base/memory.h"
#include "param/constraint_charts.h"

static void no_constraints_leave_the_turns_of_interior_vertices(void **state)
{
    (void)state;
    sl_patch *patch = chart_hexagon(4, 0.2, chart_bumps, 0.7, 0xc0);
    sl_sector_table table = compile(patch, 0, NULL), plain;
    assert_int_equal(sl_sectors_interior(patch, &plain), SL_OK);
    assert_int_equal(table.view.count, plain.view.count);
    const size_t n = (size_t)plain.view.count;
    assert_memory_equal(table.first, plain.first, (n + 1) * sizeof *plain.first);
    assert_memory_equal(table.corner, plain.corner, (size_t)plain.first[n] * sizeof *plain.corner);
    assert_memory_equal(table.theta, plain.theta, n * sizeof *plain.theta);
    assert_memory_equal(table.vertex, plain.vertex, n * sizeof *plain.vertex);
    assert_memory_equal(table.origin, plain.origin, n * sizeof *plain.origin);
    sl_sectors_clear(&table);
    sl_sectors_clear(&plain);
    sl_patch_free(patch);
}

/* Which of the wedges between the six lattice directions a triangle at vertex v lies in, from the chart's own x and y;
 * the hexagon's map is the identity in x and 1.3 in y. */
static int32_t wedge_of(const sl_patch *patch, int32_t c)
{
    const double *p = &patch->xyz[3 * patch->tri[c]];
    double x = 0.0, y = 0.0;
    for (int k = 1; k < 3; k++) {
        const double *q = &patch->xyz[3 * patch->tri[c / 3 * 3 + (c + k) % 3]];
        x += q[0] - p[0];
        y += (q[1] - p[1]) / 1.3;
    }
    const double turn = atan2(y, x) / (PI / 3.0);
    return (int32_t)floor(turn < 0.0 ? turn + 6.0 : turn);
}

/* The sectors at v: theta by wedge; each corner's wedge must lie in one sector, and all corners in one each. */
static void check_sectors_at(const sl_patch *patch, const sl_sector_table *table, int32_t v, const double expected[6])
{
    int32_t corners = 0;
    for (int32_t s = 0; s < table->view.count; s++) {
        double sum = 0.0;
        for (int32_t p = table->first[s]; p < table->first[s + 1] && table->vertex[s] == v; p++) {
            assert_int_equal(patch->tri[table->corner[p]], v);
            sum += expected[wedge_of(patch, table->corner[p])];
            corners++;
        }
        if (table->vertex[s] == v) {
            assert_true(test_near(table->theta[s], sum, 1e-14));
        }
    }
    assert_int_equal(corners, 6);
}

/* Lattice vertices have six wedges, one triangle each. */
static void lines_divide_the_turn_where_they_meet(void **state)
{
    (void)state;
    sl_patch *patch = chart_hexagon(RINGS, 0.0, chart_bumps, 0.5, 0xc1);
    int32_t row[9], column[9], third[7];
    sl_constraint list[3] = {
        lattice_path(patch, 0.5, (int32_t[]){-4, 0}, (int32_t[]){1, 0}, 9, row),    /* wedge 0 begins at +x */
        lattice_path(patch, 0.5, (int32_t[]){1, -4}, (int32_t[]){0, 1}, 8, column), /* direction 60 degrees */
        lattice_path(patch, 0.5, (int32_t[]){-2, 0}, (int32_t[]){0, 1}, 4, third)}; /* ends on the first: a T */
    sl_sector_table table = compile(patch, 3, list);
    const double q = PI / 4.0;
    check_sectors_at(patch, &table, row[1], (double[]){PI / 3, PI / 3, PI / 3, PI / 3, PI / 3, PI / 3});
    check_sectors_at(patch, &table, row[5], (double[]){PI / 2, q, q, PI / 2, q, q}); /* the crossing */
    check_sectors_at(patch, &table, row[2], (double[]){PI / 2, q, q, PI / 3, PI / 3, PI / 3});
    check_sectors_at(patch, &table, column[1], (double[]){PI / 3, PI / 3, PI / 3, PI / 3, PI / 3, PI / 3});
    check_sectors_at(patch, &table, third[3], (double[]){PI / 3, PI / 3, PI / 3, PI / 3, PI / 3, PI / 3});
    int32_t counts[4] = {0, 0, 0, 0};
    for (int32_t s = 0; s < table.view.count; s++) {
        const int32_t v = table.vertex[s];
        counts[0] += v == row[1];
        counts[1] += v == row[5];
        counts[2] += v == row[2];
        counts[3] += v == third[3];
        assert_true(table.origin[s] >= -1 && table.origin[s] < 3);
    }
    assert_true(counts[0] == 2 && counts[1] == 4 && counts[2] == 3 && counts[3] == 1);
    sl_sectors_clear(&table);
    assert_int_equal(check_solution(patch, 3, list, 1e-9).dependent, 0);
    sl_patch_free(patch);
}

static void three_lines_through_a_vertex_make_six_equal_sectors(void **state)
{
    (void)state;
    sl_patch *patch = chart_hexagon(RINGS, 0.0, chart_bumps, 0.6, 0xc2);
    int32_t a[7], b[7], c[7];
    const sl_constraint list[3] = {lattice_path(patch, 0.6, (int32_t[]){-3, 0}, (int32_t[]){1, 0}, 7, a),
                                   lattice_path(patch, 0.6, (int32_t[]){0, -3}, (int32_t[]){0, 1}, 7, b),
                                   lattice_path(patch, 0.6, (int32_t[]){-3, 3}, (int32_t[]){1, -1}, 7, c)};
    sl_sector_table table = compile(patch, 3, list);
    int32_t count = 0;
    for (int32_t s = 0; s < table.view.count; s++) {
        if (table.vertex[s] == a[3]) {
            assert_true(test_near(table.theta[s], PI / 3, 1e-15) && table.first[s + 1] - table.first[s] == 1);
            count++;
        }
    }
    assert_int_equal(count, 6);
    sl_sectors_clear(&table);
    check_solution(patch, 3, list, 1e-9);
    sl_patch_free(patch);
}

static void four_corners_make_a_rectangle_either_way_round(void **state)
{
    (void)state;
    for (int way = 0; way < 2; way++) {
        sl_patch *patch = chart_hexagon(RINGS, 0.0, chart_bumps, 0.5, 0xc3 + (uint64_t)way);
        int32_t corner[4];
        for (int k = 0; k < 4; k++) {
            const int32_t *at = corner_at[way == 0 ? k : 3 - k];
            corner[k] = lattice(patch, chart_bumps, 0.5, at[0], at[1]);
        }
        const sl_constraint list[] = {{SL_CONSTRAINT_POLYGON, 4, corner, 0.0}};
        const sl_abf_info info = check_solution(patch, 1, list, 1e-9);
        assert_int_equal(info.dependent, 1);
        sl_patch_free(patch);
    }
}

/* A rectangle divided by lines from side to side: as many closed regions as parts. */
static void every_closed_region_gives_up_one_row(void **state)
{
    (void)state;
    sl_patch *patch = chart_hexagon(RINGS, 0.0, chart_bumps, 0.4, 0xc4);
    int32_t corner[4], row[11], column[9];
    for (int k = 0; k < 4; k++) {
        corner[k] = lattice(patch, chart_bumps, 0.4, corner_at[k][0], corner_at[k][1]);
    }
    const sl_constraint list[3] = {
        {SL_CONSTRAINT_POLYGON, 4, corner, 0.0},
        lattice_path(patch, 0.4, (int32_t[]){-5, 2}, (int32_t[]){1, 0}, 9, row),
        lattice_path(patch, 0.4, (int32_t[]){-3, 5}, (int32_t[]){0, -1}, 8, column)}; /* crosses the row at (-3, 2) */
    assert_int_equal(check_solution(patch, 1, list, 1e-9).dependent, 1);
    assert_int_equal(check_solution(patch, 2, list, 1e-9).dependent, 2);
    assert_int_equal(check_solution(patch, 3, list, 1e-9).dependent, 4);
    sl_patch_free(patch);
}

static void angles_and_right_angles_on_the_border_are_met(void **state)
{
    (void)state;
    sl_patch *patch = chart_hexagon(RINGS, 0.0, chart_bumps, 0.8, 0xc5);
    int32_t v[4], path[6];
    for (int k = 0; k < 4; k++) {
        v[k] = lattice(patch, chart_bumps, 0.8, corner_at[k][0], corner_at[k][1]);
    }
    const int32_t side = lattice(patch, chart_bumps, 0.8, 2, -5); /* a line ends there: two sectors of pi/2 */
    const sl_constraint line = lattice_path(patch, 0.8, (int32_t[]){2, -5}, (int32_t[]){0, 1}, 6, path);
    const sl_constraint list[] = {{SL_CONSTRAINT_ANGLE, 1, &v[0], 1.9},
                                  {SL_CONSTRAINT_RIGHT, 1, &v[1], 0.0},
                                  {SL_CONSTRAINT_BORDER, 2, (int32_t[]){v[2], v[3]}, 0.0},
                                  {SL_CONSTRAINT_RIGHT, 1, &side, 0.0},
                                  line};
    sl_sector_table table = compile(patch, 5, list);
    int32_t right = 0;
    for (int32_t s = 0; s < table.view.count; s++) {
        if (table.origin[s] == 3) {
            assert_true(table.vertex[s] == side && table.theta[s] == PI / 2);
            right++;
        }
        if (table.vertex[s] == v[0]) {
            assert_true(table.theta[s] == 1.9 && table.origin[s] == 0);
        }
    }
    assert_int_equal(right, 2);
    sl_sectors_clear(&table);
    check_solution(patch, 5, list, 1e-9);
    sl_patch_free(patch);
}

/* Ends of lines meet freely; asked for right angles, the rest of the turn goes to the widest wedge. */
static void right_angles_can_be_asked_for_where_lines_end(void **state)
{
    (void)state;
    sl_patch *patch = chart_hexagon(RINGS, 0.0, chart_bumps, 0.5, 0xc6);
    int32_t a[4], b[4], c[4], d[4];
    const sl_constraint paths[4] = {lattice_path(patch, 0.5, (int32_t[]){0, 0}, (int32_t[]){1, 0}, 4, a),
                                    lattice_path(patch, 0.5, (int32_t[]){0, 0}, (int32_t[]){0, 1}, 4, b),
                                    lattice_path(patch, 0.5, (int32_t[]){0, 0}, (int32_t[]){-1, 0}, 4, c),
                                    lattice_path(patch, 0.5, (int32_t[]){0, 0}, (int32_t[]){0, -1}, 4, d)};
    for (int32_t lines = 2; lines <= 4; lines++) {
        sl_constraint list[5];
        memcpy(list, paths, sizeof paths);
        sl_sector_table table = compile(patch, lines, list);
        int32_t sectors = 0, quarters = 0;
        for (int32_t s = 0; s < table.view.count; s++) {
            sectors += table.vertex[s] == a[0];
        }
        assert_int_equal(sectors, 1); /* free */
        sl_sectors_clear(&table);
        list[lines] = (sl_constraint){SL_CONSTRAINT_RIGHT, 1, &a[0], 0.0};
        table = compile(patch, lines + 1, list);
        sectors = 0;
        for (int32_t s = 0; s < table.view.count; s++) {
            if (table.vertex[s] == a[0]) {
                sectors++;
                quarters += fabs(table.theta[s] - PI / 2) <= 1e-15;
            }
        }
        assert_true(sectors == lines && quarters == (lines < 4 ? lines - 1 : 4));
        sl_sectors_clear(&table);
        check_solution(patch, lines + 1, list, 1e-9);
    }
    sl_patch_free(patch);
}

/* Shortest path inside the chart between two of its vertices, breadth first; its length. */
static int32_t shortest_path(const sl_patch *patch, int32_t from, int32_t to, int32_t *path)
{
    int32_t queue[400], parent[400], n = 0, head = 0, tail = 0;
    assert_true(patch->nv <= 400);
    memset(parent, -1, sizeof parent);
    queue[tail++] = from;
    parent[from] = from;
    while (head < tail) {
        const int32_t v = queue[head++];
        int32_t c = patch->outgoing[v];
        do {
            const int32_t near[2] = {patch->tri[sl_corner_next(c)], patch->tri[sl_corner_prev(c)]};
            for (int k = 0; k < 2; k++) {
                if (parent[near[k]] < 0 && (patch->border[near[k]] == 0 || near[k] == to)) {
                    parent[near[k]] = v;
                    queue[tail++] = near[k];
                }
            }
            c = sl_corner_rotate(patch, c);
        } while (c >= 0 && c != patch->outgoing[v]);
    }
    for (int32_t v = to; n == 0 || path[n - 1] != from; v = parent[v]) {
        path[n++] = v;
    }
    return n;
}

/* Bumps so steep that undamped steps, at this seed, run in circles among small angles. */
static void crossing_lines_on_a_steep_chart_take_the_line_search(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(44);
    sl_patch *patch = chart_hexagon(9, 0.45, chart_bumps, 3.0, 44);
    int32_t *first, *halfedge, path[2][100], n[2];
    assert_int_equal(sl_patch_border(patch, &first, &halfedge), SL_OK);
    const int32_t nb = first[1], at = test_index(&rng, nb);
    for (int k = 0; k < 2; k++) {
        const int32_t from = halfedge[(at + k * (nb / 4)) % nb], to = halfedge[(at + k * (nb / 4) + nb / 2) % nb];
        n[k] = shortest_path(patch, patch->tri[from], patch->tri[to], path[k]);
    }
    const sl_constraint list[] = {{SL_CONSTRAINT_STRAIGHT, n[0], path[0], 0.0},
                                  {SL_CONSTRAINT_STRAIGHT, n[1], path[1], 0.0}};
    sl_sector_table table = compile(patch, 2, list);
    sl_abf_def def = sl_abf_default();
    def.sectors = &table.view;
    def.max_iterations = 80;
    sl_abf *solver;
    assert_int_equal(sl_abf_create(patch, &def, &solver), SL_OK);
    int32_t damped = 0;
    while (!sl_abf_info_of(solver)->converged && sl_abf_info_of(solver)->iterations < 80) {
        assert_int_equal(sl_abf_step(solver, 1, NULL), SL_OK);
        damped += sl_abf_info_of(solver)->step < 1.0;
    }
    assert_true(sl_abf_info_of(solver)->converged && sl_abf_info_of(solver)->gradient <= 1e-6 && damped > 0);
    sl_abf_free(solver);
    sl_sectors_clear(&table);
    sl_free(first);
    sl_free(halfedge);
    sl_patch_free(patch);
}

/* Random shortest paths from border vertices, one at a time, on jittered charts. */
static void random_paths_become_straight(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xc7);
    for (int trial = 0; trial < 12 * test_multiplier(); trial++) {
        sl_patch *patch = chart_hexagon(6, 0.15, chart_bumps, 0.6, 0xc70 + (uint64_t)trial);
        int32_t from, to, path[200];
        do {
            from = test_index(&rng, patch->nv);
            to = test_index(&rng, patch->nv);
        } while (patch->border[from] == 0 || from == to);
        const int32_t n = shortest_path(patch, from, to, path);
        if (n > 2) {
            const sl_constraint list[] = {{SL_CONSTRAINT_STRAIGHT, n, path, 0.0}};
            check_solution(patch, 1, list, 1e-9);
        }
        sl_patch_free(patch);
    }
}

static void pins_move_a_layout_by_a_similarity(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xca);
    sl_patch *patch = chart_hexagon(3, 0.2, chart_plane, 0.5, 0xca);
    double before[74], uv[74], angle[2][162];
    for (int32_t i = 0; i < 2 * patch->nv; i++) {
        before[i] = test_uniform(&rng, -1.0, 1.0);
    }
    for (int32_t count = 0; count <= 2; count++) {
        const sl_pin pin[] = {{7, {0.31, -1.7}}, {20, {-2.3, 0.9}}};
        memcpy(uv, before, sizeof uv);
        assert_int_equal(sl_pins_apply(patch, count, pin, uv, NULL), SL_OK);
        for (int32_t k = 0; k < count; k++) {
            assert_true(chart_max_diff(&uv[2 * pin[k].vertex], pin[k].uv, 2) <= 1e-15 * 8);
        }
        chart_uv_angles(patch, before, angle[0]);
        chart_uv_angles(patch, uv, angle[1]);
        assert_true(chart_max_diff(angle[0], angle[1], 3 * patch->nt) <= 1e-11);
        if (count < 2) { /* a translation at most */
            for (int32_t v = 0; v < patch->nv; v++) {
                assert_true(test_near(uv[2 * v] - before[2 * v], uv[0] - before[0], 1e-14));
            }
        }
    }
    sl_pin bad[3] = {{7, {0.0, 1.0}}, {7, {1.0, 1.0}}, {9, {2.0, 2.0}}};
    memcpy(uv, before, sizeof uv);
    sl_diag diag = sl_diag_none();
    assert_int_equal(sl_pins_apply(patch, 2, bad, uv, &diag), SL_INFEASIBLE);
    assert_int_equal(sl_pins_apply(patch, 3, bad, uv, &diag), SL_UNSUPPORTED);
    bad[1] = (sl_pin){8, {0.0, 1.0}};
    assert_int_equal(sl_pins_apply(patch, 2, bad, uv, &diag), SL_INFEASIBLE);
    bad[1].uv[0] = INFINITY;
    assert_int_equal(sl_pins_apply(patch, 2, bad, uv, &diag), SL_BAD_INPUT);
    bad[0].vertex = -1;
    assert_int_equal(sl_pins_apply(patch, 1, bad, uv, NULL), SL_BAD_INPUT);
    assert_memory_equal(uv, before, sizeof uv);
    sl_patch_free(patch);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_constraints_leave_the_turns_of_interior_vertices),
        cmocka_unit_test(lines_divide_the_turn_where_they_meet),
        cmocka_unit_test(three_lines_through_a_vertex_make_six_equal_sectors),
        cmocka_unit_test(four_corners_make_a_rectangle_either_way_round),
        cmocka_unit_test(every_closed_region_gives_up_one_row),
        cmocka_unit_test(angles_and_right_angles_on_the_border_are_met),
        cmocka_unit_test(right_angles_can_be_asked_for_where_lines_end),
        cmocka_unit_test(random_paths_become_straight),
        cmocka_unit_test(crossing_lines_on_a_steep_chart_take_the_line_search),
        cmocka_unit_test(pins_move_a_layout_by_a_similarity),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
