#include "mesh/topology.h"

#include "mesh/chart_check.h"

static soup s;
static int32_t faces[SOUP_FACES];

static void random_sets_agree_with_union_find(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x7090);
    int32_t disks = 0, holes = 0, handles = 0;
    for (int trial = 0; trial < 60 * test_multiplier(); trial++) {
        soup_grid(&s, &rng, (soup_surface)test_index(&rng, 5), 3 + test_index(&rng, 5), 3 + test_index(&rng, 4), 0.5);
        soup_scramble(&s, &rng, 0.1);
        sl_mesh *m = soup_build(&s, NULL);
        for (int32_t k = 0; k < test_index(&rng, 12); k++) {
            sl_mesh_cut_edge(m, test_index(&rng, m->nh));
        }
        const int32_t n = grow_set(m, &rng, 1 + test_index(&rng, m->nf), faces);
        sl_topology t;
        assert_int_equal(sl_mesh_topology(m, faces, n, &t), SL_OK);
        const counts c = count_set(m, faces, n);
        assert_int_equal(c.components, 1);
        assert_int_equal(t.vertices, c.vertices);
        assert_int_equal(t.edges, c.edges);
        assert_int_equal(t.faces, n);
        assert_int_equal(t.loops, c.loops);
        assert_int_equal(t.euler, c.vertices - c.edges + c.faces);
        assert_int_equal(2 * t.genus, 2 - c.loops - t.euler);
        disks += t.genus == 0 && t.loops == 1;
        holes += t.loops > 1;
        handles += t.genus > 0;
        sl_mesh_free(m);
    }
    assert_true(disks > 3 && holes > 3 && handles > 1);
}

static void a_small_set_of_a_large_mesh_is_looked_up_by_hash(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x4a54);
    soup_grid(&s, &rng, SOUP_TORUS, 30, 30, 0.5);
    sl_mesh *m = soup_build(&s, NULL);
    for (int trial = 0; trial < 200; trial++) {
        const int32_t n = grow_set(m, &rng, 1 + test_index(&rng, 40), faces);
        sl_topology t;
        assert_int_equal(sl_mesh_topology(m, faces, n, &t), SL_OK);
        int32_t border = 0, inner = 0;
        for (int32_t i = 0; i < n; i++) {
            for (int32_t h = m->face_first[faces[i]]; h < m->face_first[faces[i] + 1]; h++) {
                const bool in = m->twin[h] >= 0 && inside(faces, n, m->face[m->twin[h]]);
                inner += in;
                border += !in;
            }
        }
        assert_int_equal(t.edges, border + inner / 2);
        assert_int_equal(t.euler, 2 - 2 * t.genus - t.loops);
    }
    sl_mesh_free(m);
}

static void a_cut_torus_opens_step_by_step(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x70a5);
    const int32_t n = 6, m = 5;
    soup_grid(&s, &rng, SOUP_TORUS, n, m, 0.0);
    sl_mesh *mesh = soup_build(&s, NULL);
    for (int32_t f = 0; f < mesh->nf; f++) {
        faces[f] = f;
    }
    sl_topology t;
    assert_int_equal(sl_mesh_topology(mesh, faces, mesh->nf, &t), SL_OK);
    assert_true(t.euler == 0 && t.loops == 0 && t.genus == 1);
    for (int32_t j = 0; j < m; j++) {
        sl_mesh_cut_edge(mesh, 4 * j + 3); /* the closed curve i = 0 */
    }
    assert_int_equal(sl_mesh_topology(mesh, faces, mesh->nf, &t), SL_OK);
    assert_true(t.euler == 0 && t.loops == 2 && t.genus == 0);
    assert_int_equal(t.vertices, n * m + m);
    for (int32_t i = 0; i < n; i++) {
        sl_mesh_cut_edge(mesh, 4 * i * m); /* the closed curve j = 0 */
    }
    assert_int_equal(sl_mesh_topology(mesh, faces, mesh->nf, &t), SL_OK);
    assert_true(t.euler == 1 && t.loops == 1 && t.genus == 0);
    assert_int_equal(t.vertices, (n + 1) * (m + 1));
    sl_mesh_free(mesh);
}

static void components_agree_with_union_find_and_follow_the_first_facet(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xc049);
    for (int trial = 0; trial < 100 * test_multiplier(); trial++) {
        soup_random(&s, &rng, 6 + test_index(&rng, 30), 1 + test_index(&rng, 30));
        sl_mesh *m = soup_build(&s, NULL);
        for (int32_t k = 0; k < 10; k++) {
            sl_mesh_cut_edge(m, test_index(&rng, m->nh));
        }
        int32_t label[64], count = 0, next = 0;
        assert_int_equal(sl_mesh_components(m, label, &count), SL_OK);
        for (int32_t f = 0; f < m->nf; f++) {
            faces[f] = f;
            assert_in_range(label[f], 0, next);
            next += label[f] == next;
        }
        assert_int_equal(next, count);
        assert_int_equal(count, count_set(m, faces, m->nf).components);
        for (int32_t h = 0; h < m->nh; h++) {
            assert_true(m->twin[h] < 0 || label[m->face[h]] == label[m->face[m->twin[h]]]);
        }
        sl_mesh_free(m);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_sets_agree_with_union_find),
        cmocka_unit_test(a_small_set_of_a_large_mesh_is_looked_up_by_hash),
        cmocka_unit_test(a_cut_torus_opens_step_by_step),
        cmocka_unit_test(components_agree_with_union_find_and_follow_the_first_facet),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
