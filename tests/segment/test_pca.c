/* Cuts across the shortest principal axis. */
#include "segment/baselines.h"

static const double no_shift[3] = {0.0, 0.0, 0.0};

/* x^2 over the surface of a box of half extents a: a^2 on two sides, a^2 / 3 on average on the other four. */
static void variances_of_a_box_are_those_of_its_surface_however_it_is_divided(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xb0c5);
    int32_t side[2048];
    for (int trial = 0; trial < 20 * test_multiplier(); trial++) {
        const double a[3] = {test_uniform(&rng, 0.3, 1.0), test_uniform(&rng, 1.2, 2.0), test_uniform(&rng, 2.3, 4.0)};
        const int32_t n[3] = {2 + test_index(&rng, 5), 1 + test_index(&rng, 7), 3 + test_index(&rng, 9)};
        double R[3][3], shift[3] = {3.0, -2.0, test_uniform(&rng, -1.0, 5.0)};
        sl_mesh *mesh = test_box_mesh(&rng, a, n, TEST_MIXED, side);
        test_rotation(&rng, R);
        test_move(mesh, R, shift);
        sl_triangulation *t = test_triangulate(mesh);
        sl_principal_axes axes;
        sl_principal_axes_compute(mesh, t, &axes);
        const double scale = mesh->scale * mesh->scale, whole = a[0] * a[1] + a[1] * a[2] + a[2] * a[0];
        for (int k = 0; k < 3; k++) {
            const double b = a[(k + 1) % 3], c = a[(k + 2) % 3];
            const double variance = a[k] * a[k] * (b * c + (a[k] * b + a[k] * c) / 3.0) / whole;
            const double column[3] = {R[0][k], R[1][k], R[2][k]};
            assert_true(test_near_rel(axes.variance[k] / scale, variance, 1e-12));
            assert_true(test_near(axes.centre[k], shift[k], 1e-13));
            assert_true(test_near(fabs(sl_vec3_dot(column, axes.axis[k])), 1.0, 1e-12));
        }
        sl_triangulation_free(t);
        sl_mesh_free(mesh);
    }
}

/* The midpoint rule is exact for squares: C u = variance u by other sums. */
static void axes_are_eigenvectors_of_the_covariance_by_the_midpoint_rule(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x3d9);
    for (int trial = 0; trial < 10 * test_multiplier(); trial++) {
        sl_mesh *mesh = test_spiky_mesh(&rng, 5, 5, 1.5, TEST_MIXED);
        sl_triangulation *t = test_triangulate(mesh);
        sl_principal_axes axes;
        sl_principal_axes_compute(mesh, t, &axes);
        double C[3][3] = {{0.0}}, mean[3] = {0.0}, total = 0.0;
        for (int32_t i = 0; i < t->nt; i++) {
            double normal[3], area;
            test_triangle(mesh, t, i, normal, &area);
            total += area;
            for (int e = 0; e < 3; e++) {
                const double *p = mesh->xyz + 3 * mesh->origin[t->corner[3 * i + e]];
                const double *q = mesh->xyz + 3 * mesh->origin[t->corner[3 * i + (e + 1) % 3]];
                double x[3];
                for (int k = 0; k < 3; k++) {
                    x[k] = 0.5 * (p[k] + q[k]) - axes.centre[k];
                    mean[k] += area / 3.0 * x[k];
                }
                for (int k = 0; k < 9; k++) {
                    C[k / 3][k % 3] += area / 3.0 * x[k / 3] * x[k % 3];
                }
            }
        }
        for (int k = 0; k < 3; k++) {
            assert_true(test_near(mean[k], 0.0, 1e-14));
            assert_true(k == 0 || axes.variance[k] >= axes.variance[k - 1]);
            for (int r = 0; r < 3; r++) {
                const double along = sl_vec3_dot(C[r], axes.axis[k]) / total;
                assert_true(test_near(along, axes.variance[k] * axes.axis[k][r], 1e-14));
                assert_true(test_near(sl_vec3_dot(axes.axis[k], axes.axis[r]), k == r ? 1.0 : 0.0, 1e-14));
            }
        }
        sl_triangulation_free(t);
        sl_mesh_free(mesh);
    }
}

static void without_area_all_is_zero(void **state)
{
    (void)state;
    double xyz[9] = {0.1, 0.2, 0.3, 0.1, 0.2, 0.3, 0.1, 0.2, 0.3};
    int32_t origin[3] = {0, 1, 2}, corner[3] = {0, 1, 2};
    const sl_mesh mesh = {.nv = 3, .nf = 1, .nh = 3, .xyz = xyz, .origin = origin};
    const sl_triangulation t = {.nt = 1, .corner = corner};
    sl_principal_axes axes;
    sl_principal_axes_compute(&mesh, &t, &axes);
    for (int k = 0; k < 3; k++) {
        assert_true(axes.centre[k] == 0.0 && axes.variance[k] == 0.0 && axes.axis[k][k] == 1.0);
    }
}

/* An ellipsoid with bumps: the sides are those of the coordinate along the shortest axis, before and after turning it.
 */
static void the_cut_follows_the_body_when_it_is_turned(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x7047);
    for (int trial = 0; trial < 10 * test_multiplier(); trial++) {
        sl_mesh *mesh = test_spiky_mesh(&rng, 7, 0, 0.0, TEST_MIXED);
        const double stretch[3] = {2.1, 0.8, 1.4};
        for (int32_t k = 0; k < 3 * mesh->nv; k++) {
            mesh->xyz[k] *= stretch[k % 3];
        }
        sl_segment_def def = sl_segment_default();
        def.method = SL_METHOD_PCA;
        def.smooth = 0;
        sl_choice choice[2];
        double R[3][3];
        test_rotation(&rng, R);
        for (int turned = 0; turned < 2; turned++) {
            sl_triangulation *t = test_triangulate(mesh);
            sl_piece *piece = test_whole_piece(mesh, t);
            assert_int_equal(sl_choose_cut(piece, NULL, &def, NULL, &choice[turned]), SL_OK);
            assert_true(choice[turned].found && !choice[turned].smoothed);
            assert_int_equal(choice[turned].vector, 0);
            assert_int_equal(choice[turned].candidates, 1);
            sl_piece_free(piece);
            sl_triangulation_free(t);
            if (!turned) {
                int32_t above[2] = {0, 0}, below[2] = {0, 0};
                for (int32_t f = 0; f < mesh->nf; f++) {
                    double c[3];
                    sl_mesh_face_centroid(mesh, f, c);
                    above[choice[0].side[f]] += c[1] > 0.06;
                    below[choice[0].side[f]] += c[1] < -0.06;
                }
                assert_true(above[1] > 40 && below[0] > 40 && above[0] == 0 && below[1] == 0);
                test_move(mesh, R, no_shift);
            }
        }
        const bool swapped = choice[0].side[0] != choice[1].side[0];
        for (int32_t f = 0; f < mesh->nf; f++) {
            assert_true((choice[0].side[f] != choice[1].side[f]) == swapped);
        }
        assert_true(test_near_rel(choice[0].length, choice[1].length, 1e-12));
        assert_true(test_near_rel(choice[0].lambda, choice[1].lambda, 1e-12));
        sl_choice_clear(&choice[0]);
        sl_choice_clear(&choice[1]);
        sl_mesh_free(mesh);
    }
}

static void smoothing_is_that_of_a_spectral_cut(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x5a0);
    int32_t shorter = 0;
    for (int trial = 0; trial < 6; trial++) {
        sl_mesh *mesh = test_spiky_mesh(&rng, 7, 0, 0.0, TEST_TRIANGLES);
        for (int32_t v = 0; v < mesh->nv; v++) {
            mesh->xyz[3 * v] *= 0.6;
        }
        sl_triangulation *t = test_triangulate(mesh);
        sl_piece *piece = test_whole_piece(mesh, t);
        sl_segment_def def = sl_segment_default();
        sl_choice rough, smooth;
        def.method = SL_METHOD_PCA;
        assert_int_equal(sl_choose_cut(piece, NULL, &def, NULL, &smooth), SL_OK);
        def.smooth = 0;
        assert_int_equal(sl_choose_cut(piece, NULL, &def, NULL, &rough), SL_OK);
        assert_true(smooth.length <= rough.length && smooth.smoothed == (smooth.length < rough.length));
        shorter += smooth.smoothed;
        sl_choice_clear(&rough);
        sl_choice_clear(&smooth);
        sl_piece_free(piece);
        sl_triangulation_free(t);
        sl_mesh_free(mesh);
    }
    assert_true(shorter > 3);
}

/* A plane with a hole has no extent across itself: what is left is the axis in the plane. */
static void a_flat_ring_is_cut_across_the_next_axis(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xf1a7);
    uint8_t drop[9 * 7] = {0};
    double R[3][3];
    for (int32_t i = 3; i < 6; i++) {
        drop[i * 7 + 3] = 1;
    }
    sl_mesh *mesh = test_patch_mesh(&rng, 9, 7, TEST_MIXED, drop);
    for (int32_t v = 0; v < mesh->nv; v++) {
        mesh->xyz[3 * v + 2] = 0.25 + test_uniform(&rng, -1e-7, 1e-7); /* as read from a file of single precision */
    }
    test_rotation(&rng, R);
    test_move(mesh, R, no_shift);
    sl_triangulation *t = test_triangulate(mesh);
    sl_segment_def def = sl_segment_paper();
    def.method = SL_METHOD_PCA;
    sl_segmentation *s = NULL;
    assert_int_equal(sl_segment(mesh, t, &def, NULL, &s), SL_OK);
    assert_int_equal(test_check_segmentation(mesh, t, s, def.flatten.max_stretch), 0);
    assert_int_equal(s->nsplit, 1);
    assert_int_equal(s->split[0].vector, 1);
    assert_int_equal(s->nchart, 2);
    sl_segmentation_free(s);
    sl_triangulation_free(t);
    sl_mesh_free(mesh);
}

/* A sheet in waves: the plane through the middle cuts off every crest and every trough. */
static void sides_that_are_not_connected_become_charts_of_their_own(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x3a7e);
    sl_mesh *mesh = test_patch_mesh(&rng, 40, 20, TEST_QUADS, NULL);
    for (int32_t v = 0; v < mesh->nv; v++) {
        double *p = mesh->xyz + 3 * v;
        p[2] = 0.05 * sin(p[0] * 22.0) + 0.01 * cos(9.0 * p[1]);
    }
    sl_triangulation *t = test_triangulate(mesh);
    sl_segment_def def = sl_segment_paper();
    def.method = SL_METHOD_PCA;
    def.flatten.max_stretch = 1.0 + 1e-9;
    def.max_charts = 12;
    sl_segmentation *s = NULL;
    assert_int_equal(sl_segment(mesh, t, &def, NULL, &s), SL_OK);
    test_check_segmentation(mesh, t, s, def.flatten.max_stretch);
    assert_int_equal(s->split[0].vector, 0);
    assert_true(s->split[0].parts >= 5);
    sl_segmentation_free(s);
    sl_triangulation_free(t);
    sl_mesh_free(mesh);
}

/* Two triangles folded onto one another have one centroid: no plane parts them, the graph does. */
static void facets_that_no_plane_parts_are_left_to_the_graph(void **state)
{
    (void)state;
    double xyz[12] = {0.1, 0.0, 0.3, 1.2, 0.4, 0.2, 0.3, 1.1, 0.7, 0.3, 1.1, 0.7};
    int32_t first[3] = {0, 3, 6}, index[6] = {0, 1, 2, 1, 0, 3};
    sl_polygons polygons = {4, 2, xyz, first, index};
    sl_mesh *mesh = NULL;
    sl_diag diag = sl_diag_none();
    assert_int_equal(sl_mesh_build(&polygons, &mesh, NULL, &diag), SL_OK);
    sl_triangulation *t = test_triangulate(mesh);
    sl_piece *piece = test_whole_piece(mesh, t);
    sl_facet_graph *graph = test_whole_graph(mesh, NULL);
    sl_segment_def def = sl_segment_default();
    def.method = SL_METHOD_PCA;
    sl_choice choice;
    assert_int_equal(sl_choose_baseline(piece, graph, &def, NULL, &choice), SL_OK);
    assert_true(!choice.found && choice.side == NULL);
    assert_int_equal(sl_choose_cut(piece, NULL, &def, NULL, &choice), SL_OK);
    assert_true(choice.found && choice.side[0] != choice.side[1]);
    assert_int_equal(choice.vector, -1);
    assert_int_equal(choice.candidates, 0);
    sl_choice_clear(&choice);
    sl_facet_graph_free(graph);
    sl_piece_free(piece);
    sl_triangulation_free(t);
    sl_mesh_free(mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(variances_of_a_box_are_those_of_its_surface_however_it_is_divided),
        cmocka_unit_test(axes_are_eigenvectors_of_the_covariance_by_the_midpoint_rule),
        cmocka_unit_test(without_area_all_is_zero),
        cmocka_unit_test(the_cut_follows_the_body_when_it_is_turned),
        cmocka_unit_test(smoothing_is_that_of_a_spectral_cut),
        cmocka_unit_test(a_flat_ring_is_cut_across_the_next_axis),
        cmocka_unit_test(sides_that_are_not_connected_become_charts_of_their_own),
        cmocka_unit_test(facets_that_no_plane_parts_are_left_to_the_graph),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
