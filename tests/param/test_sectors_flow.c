/* Sectors that compete for the angles of the same triangles: the flow against all sets of sectors, one by one. */
#include <stdio.h>

#include "base/memory.h"
#include "param/abf_internal.h"
#include "param/constraint_charts.h"
#include "param/sectors_flow_internal.h"

static const double room = 1e-6;

/* What the sets of sectors say of a table. */
typedef struct verdict {
    bool feasible, clear; /* clear: no set is so near to its limit that the answer is a matter of tolerance */
} verdict;

/* Triangles with a corner in a sector of the set, and those with no corner outside of it. */
static void count_triangles(const sl_patch *patch, const int32_t *of_corner, uint32_t set, int32_t *touched,
                            int32_t *inside, int32_t *outer_corners)
{
    *touched = *inside = *outer_corners = 0;
    for (int32_t t = 0; t < patch->nt; t++) {
        int32_t in = 0;
        for (int k = 0; k < 3; k++) {
            const int32_t s = of_corner[3 * t + k];
            in += s >= 0 && (set >> s & 1) != 0;
        }
        *touched += in > 0;
        *inside += in == 3;
        *outer_corners += in > 0 ? 3 - in : 0;
    }
}

/* Every set X: theta(X) below what the triangles it touches have, and above what those have that lie in it. */
static verdict try_all_sets(const sl_patch *patch, const sl_sectors *sectors)
{
    verdict v = {true, true};
    int32_t of_corner[3 * 64];
    memset(of_corner, -1, sizeof of_corner);
    for (int32_t s = 0; s < sectors->count; s++) {
        for (int32_t p = sectors->first[s]; p < sectors->first[s + 1]; p++) {
            of_corner[sectors->corner[p]] = s;
        }
    }
    for (uint32_t set = 1; set < 1u << sectors->count; set++) {
        int32_t touched, inside, outer;
        double theta = 0.0;
        count_triangles(patch, of_corner, set, &touched, &inside, &outer);
        for (int32_t s = 0; s < sectors->count; s++) {
            theta += (set >> s & 1) != 0 ? sectors->theta[s] : 0.0;
        }
        const double spare = PI * touched - theta, excess = theta - PI * inside;
        if (outer == 0) { /* closed: it must be met exactly */
            v.feasible = v.feasible && fabs(spare) <= 1e-9;
            v.clear = v.clear && (fabs(spare) <= 1e-10 || fabs(spare) > 1e-2);
            continue;
        }
        v.feasible = v.feasible && spare > 0.0 && excess > 0.0;
        v.clear = v.clear && fabs(spare) > 1e-2 && fabs(excess) > 1e-2;
    }
    return v;
}

/* The corners of border vertex v become a sector of the table. */
static void add_border_angle(sl_sector_table *table, const sl_patch *patch, int32_t v, double theta)
{
    const int32_t s = table->view.count++;
    table->first[s + 1] = table->first[s];
    for (int32_t c = patch->outgoing[v]; c >= 0; c = sl_corner_rotate(patch, c)) {
        table->corner[table->first[s + 1]++] = c;
    }
    table->theta[s] = theta;
    table->vertex[s] = v;
    table->origin[s] = s;
}

/* Interior vertices and a random choice of border vertices, at most `most` sectors; their sums drawn around what the
 * surface has, so that about half of all tables can be met. */
static sl_sector_table random_table(const sl_patch *patch, int32_t most, test_rng *rng)
{
    const size_t nc = 3 * (size_t)patch->nt, ints = nc * sizeof(int32_t);
    sl_sector_table table, inside;
    double *beta = malloc(nc * sizeof *beta);
    const double spread = test_uniform(rng, 0.0, 2.0);
    const int32_t share = 1 + test_index(rng, 4);
    sl_corner_angles(patch, beta);
    assert_int_equal(sl_sectors_interior(patch, &inside), SL_OK);
    const size_t n = (size_t)inside.view.count, corners = (size_t)inside.first[n];
    table = (sl_sector_table){{inside.view.count, NULL, NULL, NULL}, malloc(ints + 4), malloc(ints),
                              malloc(nc * sizeof(double)),           malloc(ints),     malloc(ints)};
    memcpy(table.first, inside.first, (n + 1) * sizeof(int32_t));
    memcpy(table.corner, inside.corner, corners * sizeof(int32_t));
    memcpy(table.theta, inside.theta, n * sizeof(double));
    memcpy(table.vertex, inside.vertex, n * sizeof(int32_t));
    memcpy(table.origin, inside.origin, n * sizeof(int32_t));
    for (int32_t v = 0; v < patch->nv && table.view.count < most; v++) {
        if (patch->border[v] != 0 && (share == 1 || test_index(rng, share) > 0)) {
            double sum = 0.0;
            for (int32_t c = patch->outgoing[v]; c >= 0; c = sl_corner_rotate(patch, c)) {
                sum += beta[c];
            }
            add_border_angle(&table, patch, v, sum * exp(spread * test_uniform(rng, -1.5, 1.0)));
        }
    }
    double *last = &table.theta[table.view.count - 1], sum = 0.0;
    for (int32_t s = 0; s + 1 < table.view.count; s++) {
        sum += table.theta[s];
    }
    if (table.first[table.view.count] == 3 * patch->nt && PI * patch->nt > sum + 0.1) {
        *last = PI * patch->nt - sum; /* all are prescribed, and by Gauss-Bonnet they might do */
    }
    table.view.first = table.first;
    table.view.corner = table.corner;
    table.view.theta = table.theta;
    sl_sectors_clear(&inside);
    free(beta);
    return table;
}

/* The set named must be one that contradicts the table. */
static void check_cut(const sl_patch *patch, const sl_sectors *sectors, const sl_sector_cut *cut)
{
    int32_t of_corner[3 * 64], touched, inside, outer, members = 0;
    uint32_t set = 0;
    double theta = 0.0;
    memset(of_corner, -1, sizeof of_corner);
    for (int32_t s = 0; s < sectors->count; s++) {
        set |= (uint32_t)cut->in_cut[s] << s;
        members += cut->in_cut[s];
        theta += cut->in_cut[s] != 0 ? sectors->theta[s] : 0.0;
        for (int32_t p = sectors->first[s]; p < sectors->first[s + 1]; p++) {
            of_corner[sectors->corner[p]] = s;
        }
    }
    count_triangles(patch, of_corner, set, &touched, &inside, &outer);
    assert_int_equal(members, cut->sectors);
    assert_int_equal(cut->starved ? touched : inside, cut->triangles);
    assert_true(test_near(cut->asked, theta, 1e-12) && test_near(cut->held, PI * cut->triangles, 1e-12));
    assert_true(cut->starved ? theta > PI * touched - 1e-2 : theta < PI * inside + 1e-2);
}

static void the_flow_decides_as_all_sets_of_sectors_do(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xf10);
    int32_t met = 0, starved = 0, overfull = 0, closed = 0;
    for (int trial = 0; trial < 400 * test_multiplier(); trial++) {
        sl_patch *patch = trial % 2 == 0 ? chart_grid(2, 2 + trial % 3, 0.15, chart_bumps, 0.7, test_bits(&rng))
                                         : chart_hexagon(1 + trial % 4 / 2, 0.15, chart_cap, 0.9, test_bits(&rng));
        sl_sector_table table = random_table(patch, 12, &rng);
        const verdict v = try_all_sets(patch, &table.view);
        sl_sector_cut cut;
        sl_diag diag = sl_diag_none();
        assert_int_equal(sl_sectors_cut(patch, &table.view, room, &cut), SL_OK);
        if (v.clear) {
            assert_true(cut.found == !v.feasible);
            assert_int_equal(sl_sectors_feasible(patch, &table, NULL, &diag), v.feasible ? SL_OK : SL_INFEASIBLE);
            met += v.feasible;
            closed += v.feasible && table.first[table.view.count] == 3 * patch->nt;
        }
        if (cut.found) {
            check_cut(patch, &table.view, &cut);
            starved += cut.starved;
            overfull += !cut.starved;
        }
        assert_true((cut.in_cut != NULL) == cut.found);
        sl_free(cut.in_cut);
        sl_sectors_clear(&table);
        sl_patch_free(patch);
    }
    assert_true(met > 100 && starved > 100 && overfull > 5 && closed > 10);
}

/* Two neighbours on the border want nearly all of their triangles' angles each: either may, both cannot, for they have
 * a triangle in common. The region as a whole has room enough. */
static void neighbours_that_want_too_much_together_are_named(void **state)
{
    (void)state;
    int32_t tried = 0;
    for (uint64_t seed = 1; seed <= 6; seed++) {
        sl_patch *patch = chart_grid(6, 5, 0.12, chart_bumps, 0.5, seed);
        for (int32_t h = 0; h < 3 * patch->nt; h++) {
            const int32_t end[2] = {patch->tri[h], patch->tri[sl_corner_next(h)]};
            int32_t fan[2] = {0, 0};
            for (int k = 0; k < 2 && patch->twin[h] < 0; k++) {
                for (int32_t c = patch->outgoing[end[k]]; c >= 0; c = sl_corner_rotate(patch, c)) {
                    fan[k]++;
                }
            }
            if (fan[0] < 2 || fan[1] < 2) {
                continue;
            }
            const sl_constraint wish[2] = {{SL_CONSTRAINT_ANGLE, 1, &end[0], fan[0] * PI - 0.3},
                                           {SL_CONSTRAINT_ANGLE, 1, &end[1], fan[1] * PI - 0.4}};
            for (int k = 0; k < 2; k++) {
                sl_sector_table table = compile(patch, 1, &wish[k]);
                sl_sectors_clear(&table);
            }
            int32_t *name = malloc((size_t)patch->nv * sizeof *name);
            char words[2][32];
            for (int32_t v = 0; v < patch->nv; v++) {
                name[v] = 5000 + v;
            }
            snprintf(words[0], sizeof words[0], " %d", name[end[0]]);
            snprintf(words[1], sizeof words[1], " %d", name[end[1]]);
            sl_sector_table table;
            sl_diag diag = sl_diag_none();
            assert_int_equal(sl_constraints_compile(patch, 2, wish, name, &table, &diag), SL_INFEASIBLE);
            assert_non_null(strstr(diag.reason, "together"));
            assert_non_null(strstr(diag.reason, words[0]));
            assert_non_null(strstr(diag.reason, words[1]));
            assert_true(strstr(diag.hint, "1, 2 compete") != NULL || strstr(diag.hint, "2, 1 compete") != NULL);
            assert_true(diag.element == end[0] || diag.element == end[1]);
            assert_int_equal(sl_constraints_compile(patch, 2, wish, NULL, &table, NULL), SL_INFEASIBLE);
            free(name);
            tried++;
        }
        sl_patch_free(patch);
    }
    assert_true(tried > 60);
}

/* Everything prescribed, at a size where roundings add up: what a flat sheet has can be had. */
static void what_a_flat_sheet_has_can_be_had(void **state)
{
    (void)state;
    sl_patch *patch = chart_grid(60, 50, 0.2, chart_plane, 0.7, 0xf11);
    double *beta = malloc(3 * (size_t)patch->nt * sizeof *beta);
    sl_constraint *wish = malloc((size_t)patch->nv * sizeof *wish);
    int32_t *vertex = malloc((size_t)patch->nv * sizeof *vertex), count = 0;
    sl_corner_angles(patch, beta);
    for (int32_t v = 0; v < patch->nv; v++) {
        double sum = 0.0;
        for (int32_t c = patch->outgoing[v]; c >= 0 && patch->border[v] != 0; c = sl_corner_rotate(patch, c)) {
            sum += beta[c];
        }
        if (patch->border[v] != 0) {
            vertex[count] = v;
            wish[count] = (sl_constraint){SL_CONSTRAINT_ANGLE, 1, &vertex[count], sum};
            count++;
        }
    }
    sl_sector_table table = compile(patch, count, wish);
    table.theta[table.view.count - 1] += 1e-4; /* and no more */
    assert_int_equal(sl_sectors_feasible(patch, &table, NULL, NULL), SL_INFEASIBLE);
    sl_sectors_clear(&table);
    free(beta);
    free(wish);
    free(vertex);
    sl_patch_free(patch);
}

/* Tables with a corner in two sectors are not decided. */
static void a_corner_in_two_sectors_is_left_undecided(void **state)
{
    (void)state;
    sl_patch *patch = chart_hexagon(2, 0.1, chart_cap, 0.9, 0xf12);
    const int32_t first[] = {0, 2, 4}, corner[] = {3, 7, 7, 11};
    const double theta[] = {7.0, 9.0};
    sl_sector_cut cut;
    assert_int_equal(sl_sectors_cut(patch, &(sl_sectors){2, first, corner, theta}, room, &cut), SL_OK);
    assert_false(cut.found);
    assert_null(cut.in_cut);
    sl_patch_free(patch);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_flow_decides_as_all_sets_of_sectors_do),
        cmocka_unit_test(neighbours_that_want_too_much_together_are_named),
        cmocka_unit_test(what_a_flat_sheet_has_can_be_had),
        cmocka_unit_test(a_corner_in_two_sectors_is_left_undecided),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
