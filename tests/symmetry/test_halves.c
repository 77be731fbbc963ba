#include "checks.h"

static int32_t image_of(const sl_mesh *m, const sl_symmetry *s, const sl_symmetry_map *map, int32_t f)
{
    return sl_symmetry_image(m, s, map, f);
}

/* Two halves that the map exchanges, fixed facets on side 1, nothing but axis edges and borders of fixed facets
 * between; the length of the cut between them. */
static void check_sides(const sl_mesh *m, const sl_symmetry *s, const sl_symmetry_map *map)
{
    uint8_t *side = sl_alloc(m->nf, 1);
    assert_non_null(side);
    assert_int_equal(sl_symmetry_sides(m, s, map, side), SL_OK);
    bool first = true;
    int32_t fixed = 0, axis = 0;
    double length = 0.0;
    for (int32_t f = 0; f < m->nf; f++) {
        if (s->component[f] != map->from) {
            assert_int_equal(side[f], 2);
            continue;
        }
        const int32_t g = image_of(m, s, map, f);
        assert_int_equal(image_of(m, s, map, g), f);
        fixed += f == g;
        assert_true(f == g ? side[f] == 1 : side[f] + side[g] == 1);
        if (f != g && first) {
            assert_int_equal(side[f], 1);
            first = false;
        }
        for (int32_t h = m->face_first[f]; h < m->face_first[f + 1]; h++) {
            const int32_t t = m->twin[h];
            if (t > h) {
                const int32_t n = m->face[t];
                const bool on_axis = n != f && n == g;
                axis += on_axis;
                length += side[f] != side[n] ? sl_mesh_edge_length(m, h) : 0.0;
                assert_true(side[f] == side[n] || on_axis || f == g || image_of(m, s, map, n) == n);
                assert_int_equal(sl_symmetry_on_axis(m, s, map, h), on_axis);
            }
        }
    }
    assert_int_equal(map->fixed_facets, fixed);
    assert_int_equal(map->axis_edges, axis);
    assert_true(test_near_rel(map->axis_length, length, 1e-12));
    sl_free(side);
}

/* Independent of the walk over parts: does any path of facets, off the axis and off fixed facets, lead from a facet to
 * its image? */
static bool separates_by_spreading(const sl_mesh *m, const sl_symmetry *s, const sl_symmetry_map *map)
{
    int32_t *mark = sl_alloc(m->nf, sizeof *mark);
    bool changed = true, apart = true, any = false;
    for (int32_t f = 0; f < m->nf; f++) {
        mark[f] = f;
    }
    while (changed) {
        changed = false;
        for (int32_t h = 0; h < m->nh; h++) {
            const int32_t f = m->face[h], g = m->twin[h] >= 0 ? m->face[m->twin[h]] : f;
            const int32_t image = image_of(m, s, map, f);
            if (g != f && image != f && image_of(m, s, map, g) != g && image != g && mark[g] < mark[f]) {
                mark[f] = mark[g];
                changed = true;
            }
        }
    }
    for (int32_t f = 0; f < m->nf; f++) {
        const int32_t g = image_of(m, s, map, f);
        apart = apart && (g == f || mark[f] != mark[g]);
        any = any || g != f;
    }
    sl_free(mark);
    return apart && any;
}

static void check_involutions(const sl_mesh *m, const sl_symmetry *s)
{
    for (int32_t i = 0; i < s->nmap; i++) {
        if (s->map[i].order == 2) {
            assert_int_equal(s->map[i].separates, separates_by_spreading(m, s, &s->map[i]));
            if (s->map[i].separates) {
                check_sides(m, s, &s->map[i]);
            }
        }
    }
}

static void sides_of_planted_mirrors_are_exchanged(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x51de);
    for (int trial = 0; trial < 20 * test_multiplier(); trial++) {
        int32_t mirror[1000];
        model m = model_new();
        model_planted(&m, &rng, 3 + test_index(&rng, 6), 3 + test_index(&rng, 6), trial % 2 == 1, false, mirror);
        model_torus(&m, 3, 4); /* another component */
        model_relabel(&m, &rng, 1, NULL, NULL);
        sl_mesh *mesh = model_build(&m);
        sl_symmetry *s = find_all(mesh, NULL, 4);
        int32_t checked = 0;
        for (int32_t i = 0; i < s->nmap; i++) {
            if (s->map[i].separates) {
                check_sides(mesh, s, &s->map[i]);
                checked++;
            }
        }
        assert_true(checked >= 1);
        sl_symmetry_free(s);
        sl_mesh_free(mesh);
        model_free(&m);
    }
}

static void involutions_of_solids_separate_where_no_path_avoids_the_axis(void **state)
{
    (void)state;
    for (int which = 0; which < 6; which++) {
        model m = model_new();
        switch (which) {
        case 0:
            model_box(&m, 3, 3, 3);
            break;
        case 1:
            model_box(&m, 2, 4, 2);
            break;
        case 2:
            model_icosphere(&m, 1);
            break;
        case 3:
            model_torus(&m, 6, 5);
            break;
        case 4:
            model_torus(&m, 6, 6); /* exchanging both directions has an axis that does not separate */
            break;
        default:
            model_icosphere(&m, 0);
            break;
        }
        sl_mesh *mesh = model_build(&m);
        sl_symmetry *s = find_all(mesh, NULL, 1000);
        assert_false(s->truncated);
        check_involutions(mesh, s);
        int32_t apart = 0, together = 0;
        for (int32_t i = 0; i < s->nmap; i++) {
            apart += s->map[i].order == 2 && s->map[i].separates;
            together += s->map[i].order == 2 && s->map[i].reverses && !s->map[i].separates;
        }
        assert_true(apart > 0 && together > 0);
        sl_symmetry_free(s);
        sl_mesh_free(mesh);
        model_free(&m);
    }
}

/* A comb: a row of quads across the plane at x = 0, and teeth on both sides, each joined to the row alone. */
static void parts_of_one_side_lie_on_one_side(void **state)
{
    (void)state;
    model m = model_new();
    for (int j = 0; j <= 7; j++) {
        for (int i = -3; i <= 3; i += 2) {
            model_vertex(&m, 0.5 * i, j + 0.03 * j * j, 0.1 * j * i * i);
        }
    }
    for (int j = 0; j < 7; j++) {
        model_quad(&m, 4 * j + 1, 4 * j + 2, 4 * j + 6, 4 * j + 5);
        if (j % 2 == 0) {
            const int32_t q[2][4] = {{4 * j, 4 * j + 1, 4 * j + 5, 4 * j + 4},
                                     {4 * j + 2, 4 * j + 3, 4 * j + 7, 4 * j + 6}};
            model_face(&m, 4, q[j % 4 == 0]); /* in an order that numbers do not give away */
            model_face(&m, 4, q[j % 4 != 0]);
        }
    }
    sl_mesh *mesh = model_build(&m);
    sl_symmetry *s = find_all(mesh, NULL, 64);
    uint8_t side[32], seen[2] = {0, 0};
    bool checked = false;
    for (int32_t i = 0; i < s->nmap; i++) {
        if (s->map[i].kind == SL_SYMMETRY_EXACT) {
            assert_int_equal(s->map[i].fixed_facets, 7);
            check_sides(mesh, s, &s->map[i]);
            assert_int_equal(sl_symmetry_sides(mesh, s, &s->map[i], side), SL_OK);
            for (int32_t f = 0; f < mesh->nf; f++) {
                double c[3];
                sl_mesh_face_centroid(mesh, f, c);
                if (fabs(c[0]) > 1e-9) {
                    seen[c[0] > 0.0] |= (uint8_t)(1 << side[f]);
                }
            }
            checked = true;
        }
    }
    assert_true(checked);
    assert_true((seen[0] == 1 && seen[1] == 2) || (seen[0] == 2 && seen[1] == 1));
    sl_symmetry_free(s);
    sl_mesh_free(mesh);
    model_free(&m);
}

static void mirrors_only_lists_involutions_that_separate(void **state)
{
    (void)state;
    sl_symmetry_def def = sl_symmetry_default();
    def.mirrors_only = true;
    model m = model_new();
    model_box(&m, 4, 4, 4);
    sl_mesh *mesh = model_build(&m);
    sl_symmetry *s = NULL, *all = find_all(mesh, NULL, 64);
    assert_int_equal(sl_symmetry_find(mesh, NULL, &def, NULL, &s), SL_OK);
    int32_t expected = 0;
    for (int32_t i = 0; i < all->nmap; i++) {
        expected += all->map[i].order == 2 && all->map[i].separates;
    }
    assert_int_equal(s->nmap, expected);
    for (int32_t i = 0; i < s->nmap; i++) {
        assert_true(s->map[i].order == 2 && s->map[i].separates);
    }
    sl_symmetry_free(s);
    sl_symmetry_free(all);
    sl_mesh_free(mesh);
    model_free(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sides_of_planted_mirrors_are_exchanged),
        cmocka_unit_test(involutions_of_solids_separate_where_no_path_avoids_the_axis),
        cmocka_unit_test(parts_of_one_side_lie_on_one_side),
        cmocka_unit_test(mirrors_only_lists_involutions_that_separate),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
