/* Constraints on flat charts: the sectors they make, the layouts they lead to, what cannot be. */
#include "param/constraints.h"

#include "base/memory.h"
#include "param/abf_charts.h"

#define PI TEST_PI

enum { RINGS = 5 };

/* Vertex (q, r) of a hexagonal chart without jitter. */
static int32_t lattice(const sl_patch *patch, chart_map *map, double parameter, int32_t q, int32_t r)
{
    double wanted[3];
    map((q + 0.5 * r) / RINGS, sqrt(0.75) * r / RINGS, parameter, wanted);
    for (int32_t v = 0; v < patch->nv; v++) {
        if (chart_max_diff(&patch->xyz[3 * v], wanted, 3) <= 1e-12) {
            return v;
        }
    }
    fail_msg("no vertex (%d, %d)", q, r);
    return -1;
}

/* n vertices from (q, r) on in steps of (dq, dr). */
static sl_constraint lattice_path(const sl_patch *patch, double height, int32_t start[2], int32_t step[2], int32_t n,
                                  int32_t *vertex)
{
    for (int32_t i = 0; i < n; i++) {
        vertex[i] = lattice(patch, chart_bumps, height, start[0] + i * step[0], start[1] + i * step[1]);
    }
    return (sl_constraint){SL_CONSTRAINT_STRAIGHT, n, vertex, 0.0};
}

static sl_sector_table compile(const sl_patch *patch, int32_t count, const sl_constraint *list)
{
    sl_sector_table table;
    sl_diag diag = sl_diag_none();
    const sl_status status = sl_constraints_compile(patch, count, list, NULL, &table, &diag);
    if (status != SL_OK) {
        fail_msg("%s: %s", sl_status_name(status), diag.reason);
    }
    return table;
}

/* Solves, lays out, and holds the result against what was asked. Returns info. */
static sl_abf_info check_solution(const sl_patch *patch, int32_t count, const sl_constraint *list, double line)
{
    sl_sector_table table = compile(patch, count, list);
    sl_abf_def def = sl_abf_default();
    sl_abf_info info;
    sl_constraint_measure measure[32];
    double *uv = malloc(2 * (size_t)patch->nv * sizeof *uv), *angle = malloc(3 * (size_t)patch->nt * sizeof *angle);
    def.sectors = &table.view;
    assert_int_equal(sl_abf_flatten(patch, &def, NULL, uv, &info), SL_OK);
    assert_true(info.converged && info.gradient <= 1e-6 && fmax(fmax(info.g1, info.g2), info.g3) <= 1e-11);
    chart_uv_angles(patch, uv, angle);
    for (int32_t c = 0; c < 3 * patch->nt; c++) {
        assert_true(angle[c] > 0.0);
    }
    sl_constraints_measure(patch, count, list, &table, uv, measure);
    for (int32_t i = 0; i < count; i++) {
        if (!(measure[i].angle <= 1e-8 && measure[i].line <= line)) {
            fail_msg("constraint %d: angle %g, line %g", i, measure[i].angle, measure[i].line);
        }
    }
    free(uv);
    free(angle);
    sl_sectors_clear(&table);
    return info;
}

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

/* Hexagonal charts have corners of two triangles at r = -5, q = 0 and so on. */
static const int32_t corner_at[6][2] = {{5, 0}, {0, 5}, {-5, 5}, {-5, 0}, {0, -5}, {5, -5}};

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
        cmocka_unit_test(what_cannot_be_is_refused_with_its_vertices_named),
        cmocka_unit_test(a_sector_with_too_few_triangles_is_refused),
        cmocka_unit_test(what_is_left_for_free_angles_must_be_an_angle),
        cmocka_unit_test(one_free_angle_cannot_hold_more_than_a_half_turn),
        cmocka_unit_test(a_line_through_a_border_vertex_leaves_the_rest_of_its_angle),
        cmocka_unit_test(unusable_constraints_are_bad_input),
        cmocka_unit_test(pins_move_a_layout_by_a_similarity),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
