#include "mesh/mesh.h"

#include <string.h>

#include "mesh/mesh_check.h"

static soup s;

static void a_copy_has_the_same_bytes_and_its_own_arrays(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xc09);
    soup_random(&s, &rng, 15, 40);
    sl_mesh *m = soup_build(&s, NULL), *c = NULL;
    assert_int_equal(sl_mesh_copy(m, &c), SL_OK);
    assert_int_equal(c->nv, m->nv);
    assert_int_equal(c->nf, m->nf);
    assert_int_equal(c->nh, m->nh);
    assert_memory_equal(c->xyz, m->xyz, 3 * (size_t)m->nv * sizeof *m->xyz);
    assert_memory_equal(c->face_first, m->face_first, ((size_t)m->nf + 1) * sizeof *m->face_first);
    assert_memory_equal(c->origin, m->origin, (size_t)m->nh * sizeof *m->origin);
    assert_memory_equal(c->face, m->face, (size_t)m->nh * sizeof *m->face);
    assert_memory_equal(c->twin, m->twin, (size_t)m->nh * sizeof *m->twin);
    assert_memory_equal(c->sew, m->sew, (size_t)m->nh * sizeof *m->sew);
    assert_memory_equal(c->input_vertex, m->input_vertex, (size_t)m->nv * sizeof *m->input_vertex);
    assert_memory_equal(c->face_flags, m->face_flags, (size_t)m->nf);
    assert_memory_equal(c->centre, m->centre, sizeof m->centre);
    assert_true(c->scale == m->scale);
    sl_mesh_free(m);
    for (int32_t h = 0; h < c->nh; h++) {
        sl_mesh_cut_edge(c, h); /* reads and writes what the original no longer holds */
    }
    sl_mesh_free(c);
    sl_mesh_free(NULL);
}

static void cutting_moves_the_twins_to_the_sewing_pointers(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xc07);
    soup_grid(&s, &rng, SOUP_BAND, 7, 4, 0.4);
    sl_mesh *m = soup_build(&s, NULL), *before = NULL;
    assert_int_equal(sl_mesh_copy(m, &before), SL_OK);
    for (int32_t h = 0; h < m->nh; h++) {
        const int32_t t = before->twin[h];
        sl_mesh_cut_edge(m, h);
        assert_int_equal(m->twin[h], -1);
        assert_int_equal(m->sew[h], t);
        assert_int_equal(sl_opposite(m, h), t);
        if (t >= 0) {
            assert_int_equal(m->twin[t], -1);
            assert_int_equal(m->sew[t], h);
        }
        sl_mesh_cut_edge(m, h); /* cut already: nothing happens */
        assert_int_equal(m->sew[h], t);
        sl_mesh_sew_edge(m, t >= 0 ? t : h);
        assert_memory_equal(m->twin, before->twin, (size_t)m->nh * sizeof *m->twin);
        assert_memory_equal(m->sew, before->sew, (size_t)m->nh * sizeof *m->sew);
        sl_mesh_sew_edge(m, h);
        assert_memory_equal(m->twin, before->twin, (size_t)m->nh * sizeof *m->twin);
    }
    sl_mesh_free(m);
    sl_mesh_free(before);
}

static void random_cuts_sewn_in_another_order_give_the_same_bytes(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x5e3);
    for (int trial = 0; trial < 50 * test_multiplier(); trial++) {
        soup_random(&s, &rng, 9, 14);
        sl_mesh *m = soup_build(&s, NULL), *before = NULL;
        assert_int_equal(sl_mesh_copy(m, &before), SL_OK);
        for (int32_t k = 0; k < m->nh; k++) {
            sl_mesh_cut_edge(m, test_index(&rng, m->nh));
        }
        for (int32_t h = 0; h < m->nh; h++) {
            assert_true(m->twin[h] < 0 || m->sew[h] < 0);
            assert_int_equal(sl_opposite(m, h), before->twin[h]);
        }
        for (int32_t h = m->nh - 1; h >= 0; h--) {
            sl_mesh_sew_edge(m, h);
        }
        assert_memory_equal(m->twin, before->twin, (size_t)m->nh * sizeof *m->twin);
        assert_memory_equal(m->sew, before->sew, (size_t)m->nh * sizeof *m->sew);
        sl_mesh_free(m);
        sl_mesh_free(before);
    }
}

/* Oracle: Newell's sum over the edges, in input units. */
static void areas_centroids_and_lengths_agree_with_the_input(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xa6ea);
    soup_clear(&s);
    soup_random_vertices(&s, &rng, 40);
    for (int32_t f = 0; f < 30; f++) {
        const int32_t d = 3 + test_index(&rng, 5), at = test_index(&rng, 40 - d);
        int32_t corner[7];
        for (int32_t k = 0; k < d; k++) {
            corner[k] = at + k;
        }
        soup_face(&s, d, corner);
    }
    sl_mesh *m = soup_build(&s, NULL);
    for (int32_t f = 0; f < m->nf; f++) {
        double newell[3] = {0.0, 0.0, 0.0}, mean[3] = {0.0, 0.0, 0.0}, n[3], c[3], unit = m->scale;
        const int32_t d = sl_degree(m, f);
        for (int32_t h = m->face_first[f]; h < m->face_first[f + 1]; h++) {
            const double *p = s.xyz + 3 * m->input_vertex[m->origin[h]];
            const double *q = s.xyz + 3 * m->input_vertex[sl_target(m, h)];
            double squares = 0.0;
            for (int k = 0; k < 3; k++) {
                const int y = (k + 1) % 3, z = (k + 2) % 3;
                newell[k] += 0.5 * (p[y] - q[y]) * (p[z] + q[z]);
                mean[k] += p[k] / d;
                squares += (p[k] - q[k]) * (p[k] - q[k]);
            }
            assert_true(test_near(sl_mesh_edge_length(m, h), unit * sqrt(squares), 16 * TEST_EPS));
        }
        sl_mesh_face_vector_area(m, f, n);
        sl_mesh_face_centroid(m, f, c);
        double squares = 0.0;
        for (int k = 0; k < 3; k++) {
            /* p x q = ((p_y - q_y)(p_z + q_z) + ...) in cyclic order, up to a closed sum */
            assert_true(test_near(n[k], unit * unit * newell[k], 64 * TEST_EPS));
            assert_true(test_near(c[k], unit * (mean[k] - m->centre[k]), 16 * TEST_EPS));
            squares += n[k] * n[k];
        }
        assert_true(test_near(sl_mesh_face_area(m, f), sqrt(squares), 4 * TEST_EPS));
    }
    sl_mesh_free(m);
}

static void the_diagonal_spans_the_bounding_box(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xd1a6);
    soup_grid(&s, &rng, SOUP_SHEET, 5, 6, 0.5);
    sl_mesh *m = soup_build(&s, NULL);
    double squares = 0.0;
    for (int k = 0; k < 3; k++) {
        double extent = 0.0;
        for (int32_t v = 0; v < s.nv; v++) {
            for (int32_t w = 0; w < s.nv; w++) {
                extent = fmax(extent, s.xyz[3 * v + k] - s.xyz[3 * w + k]);
            }
        }
        squares += extent * extent;
    }
    assert_true(test_near(sl_mesh_diagonal(m), m->scale * sqrt(squares), 8 * TEST_EPS));
    sl_mesh_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_copy_has_the_same_bytes_and_its_own_arrays),
        cmocka_unit_test(cutting_moves_the_twins_to_the_sewing_pointers),
        cmocka_unit_test(random_cuts_sewn_in_another_order_give_the_same_bytes),
        cmocka_unit_test(areas_centroids_and_lengths_agree_with_the_input),
        cmocka_unit_test(the_diagonal_spans_the_bounding_box),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
