/* Pieces cut out of a mesh, against the mesh. */
#include "segment/checks.h"

/* Each facet with probability `share`. */
static int32_t random_facets(test_rng *rng, const sl_mesh *mesh, double share, int32_t *face)
{
    int32_t count = 0;
    for (int32_t f = 0; f < mesh->nf; f++) {
        if (test_uniform(rng, 0.0, 1.0) < share) {
            face[count++] = f;
        }
    }
    if (count == 0) {
        face[count++] = test_index(rng, mesh->nf);
    }
    return count;
}

static void check_piece(const sl_mesh *mesh, const sl_triangulation *t, const sl_piece *piece)
{
    const sl_mesh *m = piece->mesh;
    test_check_pointers(m);
    for (int32_t h = 0; h < m->nh; h++) {
        const int32_t g = sl_piece_halfedge(piece, mesh, h);
        const double *p = m->xyz + 3 * m->origin[h], *q = mesh->xyz + 3 * mesh->origin[g];
        assert_int_equal(piece->face[m->face[h]], mesh->face[g]);
        assert_memory_equal(p, q, 3 * sizeof *p);
        assert_int_equal(m->input_vertex[m->origin[h]], mesh->input_vertex[mesh->origin[g]]);
        const int32_t twin = mesh->twin[g] < 0 ? -1 : sl_find_sorted(piece->face, m->nf, mesh->face[mesh->twin[g]]);
        const int32_t sew = mesh->sew[g] < 0 ? -1 : sl_find_sorted(piece->face, m->nf, mesh->face[mesh->sew[g]]);
        assert_int_equal(m->twin[h] >= 0 ? m->face[m->twin[h]] : -1, twin);
        assert_int_equal(m->sew[h] >= 0 ? m->face[m->sew[h]] : -1, sew);
        if (m->twin[h] >= 0) {
            assert_int_equal(sl_piece_halfedge(piece, mesh, m->twin[h]), mesh->twin[g]);
        }
    }
    for (int32_t f = 0; f < m->nf; f++) {
        const int32_t g = piece->face[f];
        assert_int_equal(piece->triangulation->first[f + 1] - piece->triangulation->first[f],
                         t->first[g + 1] - t->first[g]);
        for (int32_t c = 3 * piece->triangulation->first[f]; c < 3 * piece->triangulation->first[f + 1]; c++) {
            const int32_t from = 3 * t->first[g] + c - 3 * piece->triangulation->first[f];
            assert_int_equal(sl_piece_halfedge(piece, mesh, piece->triangulation->corner[c]), t->corner[from]);
        }
    }
}

static void a_piece_mirrors_its_part_of_the_mesh(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x91ece);
    for (int trial = 0; trial < 30 * test_multiplier(); trial++) {
        sl_mesh *mesh = trial % 2 == 0 ? test_torus_mesh(&rng, 11, 7, 0.3, TEST_MIXED)
                                       : test_spiky_mesh(&rng, 4, 3, 1.0, TEST_MIXED);
        for (int32_t k = 0; k < 30; k++) {
            sl_mesh_cut_edge(mesh, test_index(&rng, mesh->nh));
        }
        sl_triangulation *t = test_triangulate(mesh);
        int32_t *face = malloc((size_t)mesh->nf * sizeof *face);
        const int32_t count = random_facets(&rng, mesh, test_uniform(&rng, 0.1, 1.0), face);
        sl_piece *piece = NULL;
        assert_int_equal(sl_piece_create(mesh, t, face, count, &piece), SL_OK);
        assert_int_equal(piece->mesh->nf, count);
        assert_memory_equal(piece->face, face, (size_t)count * sizeof *face);
        check_piece(mesh, t, piece);
        sl_piece_free(piece);
        free(face);
        sl_triangulation_free(t);
        sl_mesh_free(mesh);
    }
}

/* V from the fans must satisfy Euler's formula as the topology counts it, seams and all. */
static void fans_of_a_connected_piece_are_the_vertices_of_its_topology(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xfa95);
    for (int trial = 0; trial < 20 * test_multiplier(); trial++) {
        sl_mesh *mesh = test_torus_mesh(&rng, 9, 8, 0.3, TEST_MIXED);
        for (int32_t k = 0; k < 25; k++) {
            sl_mesh_cut_edge(mesh, test_index(&rng, mesh->nh));
        }
        int32_t parts = 0, fans = 0, *label = malloc((size_t)mesh->nf * sizeof *label);
        assert_int_equal(sl_mesh_components(mesh, label, &parts), SL_OK);
        sl_triangulation *t = test_triangulate(mesh);
        int32_t *face = malloc((size_t)mesh->nf * sizeof *face), count = 0;
        for (int32_t f = 0; f < mesh->nf; f++) {
            if (label[f] == 0) {
                face[count++] = f;
            }
        }
        sl_piece *piece = NULL;
        sl_topology topology;
        assert_int_equal(sl_piece_create(mesh, t, face, count, &piece), SL_OK);
        assert_int_equal(sl_piece_topology(piece, &topology), SL_OK);
        int32_t *vertex = malloc((size_t)piece->mesh->nh * sizeof *vertex);
        assert_int_equal(sl_corner_fans(piece->mesh, false, vertex, &fans), SL_OK);
        assert_int_equal(fans, topology.vertices);
        free(vertex);
        free(face);
        free(label);
        sl_piece_free(piece);
        sl_triangulation_free(t);
        sl_mesh_free(mesh);
    }
}

static void sorted_lists_are_searched(void **state)
{
    (void)state;
    const int32_t list[] = {-7, 2, 3, 19, 20, 71};
    for (int32_t k = 0; k < 6; k++) {
        assert_int_equal(sl_find_sorted(list, 6, list[k]), k);
    }
    assert_int_equal(sl_find_sorted(list, 6, -8), -1);
    assert_int_equal(sl_find_sorted(list, 6, 18), -1);
    assert_int_equal(sl_find_sorted(list, 6, 72), -1);
    assert_int_equal(sl_find_sorted(list, 0, 2), -1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_piece_mirrors_its_part_of_the_mesh),
        cmocka_unit_test(fans_of_a_connected_piece_are_the_vertices_of_its_topology),
        cmocka_unit_test(sorted_lists_are_searched),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
