/* Weights that lean: ways of equal length are told apart by where they run, not by numbers. */
#include "segment/checks.h"
#include "segment/segment_internal.h"

#include <math.h>

static void leaning_weights_stay_within_a_millionth_and_agree_across_edges(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x71e5);
    for (int trial = 0; trial < 4 * test_multiplier(); trial++) {
        sl_mesh *mesh = test_spiky_mesh(&rng, 6, trial, 0.7, trial % 2 ? TEST_MIXED : TEST_TRIANGLES);
        double *own = malloc(sizeof *own * (size_t)mesh->nh), *plain = NULL, *leaning = NULL, least = 2.0, most = 0.0;
        for (int32_t h = 0; h < mesh->nh; h++) {
            own[h] = h < mesh->twin[h] || mesh->twin[h] < 0 ? test_uniform(&rng, 0.2, 3.0) : own[mesh->twin[h]];
        }
        assert_int_equal(sl_lean_weights(mesh, NULL, &plain), SL_OK);
        assert_int_equal(sl_lean_weights(mesh, own, &leaning), SL_OK);
        for (int32_t h = 0; h < mesh->nh; h++) {
            assert_true(plain[h] >= 1.0 && plain[h] <= 1.0 + 0x1p-20);
            assert_true(leaning[h] == own[h] * plain[h]);
            assert_true(mesh->twin[h] < 0 ||
                        (plain[h] == plain[mesh->twin[h]] && leaning[h] == leaning[mesh->twin[h]]));
            least = fmin(least, plain[h]);
            most = fmax(most, plain[h]);
        }
        assert_true(least == 1.0 && most > 1.0 + 1e-8);
        sl_free(plain);
        sl_free(leaning);
        free(own);
        sl_mesh_free(mesh);
    }
}

/* A tube of straight lines: every one of them joins the two loops by the same length. One of them is taken, however the
 * tube stands and is numbered. */
static void of_equal_ways_the_same_one_is_cut_however_it_is_numbered(void **state)
{
    (void)state;
    enum { AROUND = 11, ALONG = 5 };
    test_rng rng = test_rng_seed(0x71e6);
    int32_t first = -1;
    for (int trial = 0; trial < 6; trial++) {
        double xyz[3 * AROUND * (ALONG + 1)];
        int32_t index[4 * AROUND * ALONG], face_first[AROUND * ALONG + 1] = {0}, nf = 0;
        const double tilt = test_uniform(&rng, 0.1, 3.0), shift = test_uniform(&rng, -9.0, 9.0);
        const int32_t turn = test_index(&rng, AROUND); /* where the numbers start */
        for (int32_t v = 0; v < AROUND * (ALONG + 1); v++) {
            const double a = 2.0 * acos(-1.0) * ((v + turn) % AROUND) / AROUND, z = (double)(v / AROUND) / ALONG;
            const double r = 0.3 + 0.12 * cos(a) + 0.05 * sin(2.0 * a); /* no symmetry around the axis */
            const double x = r * cos(a), y = r * sin(a);
            xyz[3 * v] = x * cos(tilt) - z * sin(tilt) + shift;
            xyz[3 * v + 1] = y - 0.3 * shift;
            xyz[3 * v + 2] = x * sin(tilt) + z * cos(tilt);
        }
        for (int32_t i = 0; i < ALONG; i++) {
            for (int32_t j = 0; j < AROUND; j++) {
                const int32_t a = i * AROUND + j, b = i * AROUND + (j + 1) % AROUND;
                const int32_t quad[4] = {a, b, b + AROUND, a + AROUND};
                memcpy(index + 4 * nf, quad, sizeof quad);
                face_first[nf + 1] = 4 * (nf + 1);
                nf++;
            }
        }
        const sl_polygons polygons = {AROUND * (ALONG + 1), nf, xyz, face_first, index};
        sl_mesh *mesh = NULL;
        sl_cut_list list = {0};
        assert_int_equal(sl_mesh_build(&polygons, &mesh, NULL, NULL), SL_OK);
        assert_int_equal(sl_join_loops(mesh, NULL, &list), SL_OK);
        assert_int_equal(list.count, ALONG);
        const int32_t line = (mesh->origin[list.halfedge[0]] + turn) % AROUND; /* in the shape's own count */
        first = trial == 0 ? line : first;
        assert_true(line == first);
        for (int32_t k = 1; k < list.count; k++) {
            assert_int_equal((mesh->origin[list.halfedge[k]] + turn) % AROUND, line);
        }
        sl_cut_list_clear(&list);
        sl_mesh_free(mesh);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(leaning_weights_stay_within_a_millionth_and_agree_across_edges),
        cmocka_unit_test(of_equal_ways_the_same_one_is_cut_however_it_is_numbered),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
