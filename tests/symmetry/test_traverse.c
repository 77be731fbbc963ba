#include "checks.h"

static void a_walk_from_any_corner_agrees_with_brute_force(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x3a1c);
    for (int trial = 0; trial < 9 * test_multiplier(); trial++) {
        int32_t mirror[400], image[1000], vertex[400], found_count = 0;
        model m = model_new();
        if (trial % 3 == 0) {
            model_box(&m, 2, 2, 1);
        } else {
            model_planted(&m, &rng, 2, 3, trial % 3 == 1, false, mirror);
        }
        sl_mesh *mesh = model_build(&m);
        for (int32_t h = 0; h < mesh->nh; h++) {
            for (int reverses = 0; reverses < 2; reverses++) {
                bool found = true;
                assert_int_equal(sl_symmetry_traverse(mesh, 0, h, reverses == 1, image, &found), SL_OK);
                const int32_t g = mesh->face[h];
                assert_int_equal(found, brute_force_map(&m, g, h - mesh->face_first[g], reverses == 1, vertex));
                for (int32_t k = 0; k < mesh->nh; k++) {
                    assert_int_equal(image[k] >= 0, found);
                    if (found) {
                        assert_int_equal(mesh->origin[image[k]], vertex[mesh->origin[k]]);
                    }
                }
                found_count += found;
            }
        }
        assert_true(found_count >= (trial % 3 == 0 ? 16 : 2));
        sl_mesh_free(mesh);
        model_free(&m);
    }
}

/* The larger torus covers the smaller: locally all is the same. */
static void a_covering_is_no_isomorphism(void **state)
{
    (void)state;
    model m = model_new();
    model_torus(&m, 4, 5);
    model_torus(&m, 8, 5);
    sl_mesh *mesh = model_build(&m);
    int32_t *image = sl_alloc(mesh->nh, sizeof *image);
    for (int swap = 0; swap < 2; swap++) {
        bool found = true;
        assert_int_equal(sl_symmetry_traverse(mesh, swap ? 80 : 0, swap ? 0 : 80, false, image, &found), SL_OK);
        assert_false(found);
        for (int32_t h = 0; h < mesh->nh; h++) {
            assert_int_equal(image[h], -1);
        }
    }
    sl_free(image);
    sl_mesh_free(mesh);
    model_free(&m);
}

/* Cutting a torus open along a circle leaves two borders; the cut edges' facets are where a walk may start. */
static void cut_edges_are_borders(void **state)
{
    (void)state;
    model m = model_new();
    model_torus(&m, 6, 5);
    sl_mesh *mesh = model_build(&m);
    int32_t *image = sl_alloc(mesh->nh, sizeof *image), cut[2][2] = {{-1, -1}, {-1, -1}};
    for (int32_t i = 0; i < 6; i += 3) { /* edges between rows i - 1 and i: two tubes of three rows */
        for (int32_t j = 0; j < 5; j++) {
            const int32_t h = 4 * (5 * i + j) + 3; /* (i, j + 1) -> (i, j) */
            if (j == 0) {
                cut[i / 3][0] = h;
                cut[i / 3][1] = mesh->twin[h];
            }
            sl_mesh_cut_edge(mesh, h);
        }
    }
    bool found = false;
    assert_int_equal(sl_symmetry_traverse(mesh, cut[0][0], cut[0][1], false, image, &found), SL_OK);
    assert_true(found); /* a half turn takes one tube to the other */
    assert_int_equal(image[cut[0][0]], cut[0][1]);
    for (int32_t h = 0; h < mesh->nh; h++) {
        assert_int_equal(image[h] >= 0, h / 4 < 15);
        assert_true(image[h] < 0 || image[h] / 4 >= 15);
    }
    sl_symmetry *s = find_all(mesh, NULL, 64);
    assert_int_equal(s->components, 2);
    assert_int_equal(s->original[1], 0);
    assert_int_equal(s->nmap, 19 + 1);
    check_all(mesh, s);
    /* cutting the whole torus along one circle only keeps the symmetries of a tube: 20 of 120 */
    for (int32_t j = 0; j < 5; j++) {
        sl_mesh_sew_edge(mesh, 4 * (15 + j) + 3);
    }
    sl_symmetry *t = find_all(mesh, NULL, 64);
    assert_int_equal(t->components, 1);
    assert_int_equal(t->nmap, 19);
    check_all(mesh, t);
    sl_symmetry_free(s);
    sl_symmetry_free(t);
    sl_free(image);
    sl_mesh_free(mesh);
    model_free(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_walk_from_any_corner_agrees_with_brute_force),
        cmocka_unit_test(a_covering_is_no_isomorphism),
        cmocka_unit_test(cut_edges_are_borders),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
