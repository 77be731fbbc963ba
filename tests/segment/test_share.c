/* Symmetric sharing: halves, quarters and copies of components take their UVs from one another. */
#include "segment/mirrored.h"

static sl_segmentation *segment(sl_mesh *mesh, const sl_triangulation *t, const sl_segment_def *def, int32_t threads)
{
    sl_thread_pool *pool = NULL;
    sl_segmentation *s = NULL;
    assert_int_equal(sl_thread_pool_create(threads, &pool), SL_OK);
    const sl_context context = {.executor = sl_thread_pool_executor(pool)};
    assert_int_equal(sl_segment(mesh, t, def, &context, &s), SL_OK);
    sl_thread_pool_free(pool);
    return s;
}

/* Segments a body and checks all that must always hold. mesh: owned by the caller. */
static sl_segmentation *segment_body(const test_mirrored *body, int32_t copies, const sl_segment_def *def,
                                     sl_mesh **mesh, double *shared)
{
    *mesh = test_mirrored_mesh(body, copies);
    sl_triangulation *t = test_triangulate(*mesh);
    sl_segmentation *s = segment(*mesh, t, def, 2);
    assert_int_equal(test_check_segmentation(*mesh, t, s, def->flatten.max_stretch), 0);
    *shared = test_check_sharing(*mesh, s, def->symmetry == SL_SYMMETRY_USE_NEAR ? 0.2 : 1e-5);
    sl_triangulation_free(t);
    return s;
}

static void mirrored_halves_share_their_uvs_bit_for_bit(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x3a1f);
    for (int trial = 0; trial < 4 * test_multiplier(); trial++) {
        const test_mirrored body = {.n = 6,
                                    .mirrors = 1 << trial % 3,
                                    .nspike = 2,
                                    .height = 1.3,
                                    .facets = trial % 2 == 0 ? TEST_QUADS : TEST_TRIANGLES,
                                    .seed = test_bits(&rng)};
        const sl_segment_def def = sl_segment_default();
        sl_mesh *mesh = NULL;
        double shared = 0.0;
        sl_segmentation *s = segment_body(&body, 1, &def, &mesh, &shared);
        assert_true(test_near(shared, 0.5, 1e-9)); /* every chart has its image, even where charts were merged */
        assert_int_equal(2 * s->sharing.copies, s->nchart);
        assert_int_equal(s->sharing.axes, 1);
        assert_int_equal(s->sharing.refused, 0);
        assert_int_equal(s->split[0].symmetry, SL_SPLIT_MIRROR);
        for (int32_t h = 0; h < mesh->nh; h++) { /* the axis is cut, all of it */
            const int32_t k = trial % 3;
            const double a = mesh->xyz[3 * mesh->origin[h] + k], b = mesh->xyz[3 * sl_target(mesh, h) + k];
            assert_true(a != 0.0 || b != 0.0 || mesh->sew[h] >= 0);
        }
        sl_segmentation_free(s);
        sl_mesh_free(mesh);
    }
}

static void facets_that_straddle_the_plane_stay_with_one_half(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xf1c5);
    for (int trial = 0; trial < 3 * test_multiplier(); trial++) {
        const test_mirrored body = {
            .n = 7, .mirrors = 1, .nspike = 3, .height = 1.0, .facets = TEST_QUADS, .seed = test_bits(&rng)};
        const sl_segment_def def = sl_segment_default();
        sl_mesh *mesh = NULL;
        double shared = 0.0, straddling = 0.0, all = 0.0;
        int32_t count = 0;
        sl_segmentation *s = segment_body(&body, 1, &def, &mesh, &shared);
        for (int32_t f = 0; f < mesh->nf; f++) {
            double lo = 1.0, hi = -1.0;
            for (int32_t h = mesh->face_first[f]; h < mesh->face_first[f + 1]; h++) {
                lo = fmin(lo, mesh->xyz[3 * mesh->origin[h]]);
                hi = fmax(hi, mesh->xyz[3 * mesh->origin[h]]);
            }
            if (lo < 0.0 && hi > 0.0) {
                straddling += sl_mesh_face_area(mesh, f);
                count++;
                assert_true(s->chart[s->face_chart[f]].copy_of < 0);
            }
            all += sl_mesh_face_area(mesh, f);
        }
        assert_true(count >= 4 * 7);
        assert_int_equal(s->split[0].fixed, count);
        assert_true(test_near(shared, 0.5 * (1.0 - straddling / all), 1e-9));
        sl_segmentation_free(s);
        sl_mesh_free(mesh);
    }
}

/* Two mirrors: the half that must be split is cut along the other one. */
static void four_quarters_end_on_one_place(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x4444);
    int32_t quarters = 0;
    for (int trial = 0; trial < 3 * test_multiplier(); trial++) {
        const test_mirrored body = {
            .n = 6, .mirrors = 3, .nspike = 1, .height = 2.0, .facets = TEST_TRIANGLES, .seed = test_bits(&rng)};
        sl_segment_def def = sl_segment_default();
        def.flatten.max_stretch = 1.05;
        sl_mesh *mesh = NULL;
        double shared = 0.0;
        sl_segmentation *s = segment_body(&body, 1, &def, &mesh, &shared);
        assert_true(shared > 0.5 - 1e-9);
        quarters += test_near(shared, 0.75, 1e-9);
        int32_t *images = calloc((size_t)s->nchart, sizeof *images);
        for (int32_t c = 0; c < s->nchart; c++) {
            images[s->chart[c].copy_of >= 0 ? s->chart[c].copy_of : c]++;
        }
        for (int32_t c = 0; c < s->nchart && shared > 0.6; c++) {
            assert_true(s->chart[c].copy_of >= 0 || images[c] == 4);
        }
        free(images);
        sl_segmentation_free(s);
        sl_mesh_free(mesh);
    }
    assert_true(quarters > 0);
}

static void copies_of_a_component_share_its_charts(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xc0b1e5);
    for (int trial = 0; trial < 3 * test_multiplier(); trial++) {
        const test_mirrored body = {.n = 5,
                                    .mirrors = trial % 2, /* without a mirror of its own, and with one */
                                    .nspike = 2,
                                    .height = 0.8,
                                    .facets = trial == 2 ? TEST_TRIANGLES : TEST_QUADS,
                                    .seed = test_bits(&rng)};
        const sl_segment_def def = sl_segment_default();
        sl_mesh *mesh = NULL;
        double shared = 0.0;
        const int32_t copies = 3 + trial % 2;
        sl_segmentation *s = segment_body(&body, copies, &def, &mesh, &shared);
        assert_int_equal(s->sharing.components, copies - 1);
        assert_true(shared > (copies - 1.0) / copies - 1e-9);
        assert_true(trial % 2 == 0 || shared > (copies - 0.7) / copies);
        int32_t mirrored = 0;
        for (int32_t c = 0; c < s->nchart; c++) {
            mirrored += s->chart[c].mirrored;
        }
        assert_true(mirrored > 0); /* the third is a mirror image */
        sl_segmentation_free(s);
        sl_mesh_free(mesh);
    }
}

static void unsharing_lays_copies_out_the_right_way_round(void **state)
{
    (void)state;
    const test_mirrored body = {
        .n = 6, .mirrors = 1, .nspike = 2, .height = 1.4, .facets = TEST_QUADS, .seed = 0x0b5e55ed};
    sl_segment_def def = sl_segment_default();
    sl_mesh *a = NULL, *b = NULL;
    double shared = 0.0, unshared = 0.0;
    sl_segmentation *s = segment_body(&body, 2, &def, &a, &shared);
    def.unshare = true;
    sl_segmentation *u = segment_body(&body, 2, &def, &b, &unshared);
    assert_true(shared > 0.7 && unshared == 0.0);
    assert_int_equal(s->nchart, u->nchart);
    assert_memory_equal(a->twin, b->twin, (size_t)a->nh * sizeof *a->twin);
    for (int32_t h = 0; h < a->nh; h++) {
        const bool mirrored = s->chart[s->face_chart[a->face[h]]].mirrored;
        assert_true(u->corner_uv[2 * h] == (mirrored ? -s->corner_uv[2 * h] : s->corner_uv[2 * h]));
        assert_true(u->corner_uv[2 * h + 1] == s->corner_uv[2 * h + 1]);
    }
    sl_segmentation_free(s);
    sl_segmentation_free(u);
    sl_mesh_free(a);
    sl_mesh_free(b);
}

static void without_symmetry_auto_and_off_give_the_same_bytes(void **state)
{
    (void)state;
    test_rng rng[2] = {test_rng_seed(0xa5e), test_rng_seed(0xa5e)};
    sl_mesh *mesh[2];
    sl_segmentation *s[2];
    for (int k = 0; k < 2; k++) {
        mesh[k] = test_spiky_mesh(&rng[k], 7, 5, 1.5, TEST_MIXED);
        sl_triangulation *t = test_triangulate(mesh[k]);
        sl_segment_def def = sl_segment_default();
        def.symmetry = k == 0 ? SL_SYMMETRY_USE_AUTO : SL_SYMMETRY_USE_OFF;
        s[k] = segment(mesh[k], t, &def, 1);
        assert_null(s[k]->source);
        sl_triangulation_free(t);
    }
    assert_memory_equal(mesh[0]->twin, mesh[1]->twin, (size_t)mesh[0]->nh * sizeof *mesh[0]->twin);
    assert_memory_equal(s[0]->corner_uv, s[1]->corner_uv, 2 * (size_t)mesh[0]->nh * sizeof *s[0]->corner_uv);
    for (int k = 0; k < 2; k++) {
        sl_segmentation_free(s[k]);
        sl_mesh_free(mesh[k]);
    }
}

static void off_shares_nothing_where_there_is_a_symmetry(void **state)
{
    (void)state;
    const test_mirrored body = {.n = 6, .mirrors = 3, .nspike = 1, .height = 1.0, .facets = TEST_QUADS, .seed = 0x0ff};
    sl_segment_def def = sl_segment_default();
    sl_mesh *mesh = NULL;
    double shared = 1.0;
    def.symmetry = SL_SYMMETRY_USE_OFF;
    sl_segmentation *s = segment_body(&body, 2, &def, &mesh, &shared);
    assert_true(shared == 0.0);
    assert_int_equal(s->sharing.axes + s->sharing.components, 0);
    sl_segmentation_free(s);
    sl_mesh_free(mesh);
}

static void sharing_gives_the_same_bytes_for_any_number_of_threads(void **state)
{
    (void)state;
    const test_mirrored body = {.n = 6, .mirrors = 3, .nspike = 2, .height = 1.6, .facets = TEST_TRIANGLES, .seed = 31};
    const int32_t threads[3] = {1, 2, 5};
    sl_mesh *mesh[3];
    sl_segmentation *s[3];
    for (int k = 0; k < 3; k++) {
        mesh[k] = test_mirrored_mesh(&body, 2);
        sl_triangulation *t = test_triangulate(mesh[k]);
        const sl_segment_def def = sl_segment_default();
        s[k] = segment(mesh[k], t, &def, threads[k]);
        assert_non_null(s[k]->source);
        sl_triangulation_free(t);
    }
    for (int k = 1; k < 3; k++) {
        const size_t nh = (size_t)mesh[0]->nh;
        assert_memory_equal(s[0]->corner_uv, s[k]->corner_uv, 2 * nh * sizeof *s[0]->corner_uv);
        assert_memory_equal(s[0]->source, s[k]->source, nh * sizeof *s[0]->source);
        assert_memory_equal(mesh[0]->sew, mesh[k]->sew, nh * sizeof *mesh[0]->sew);
    }
    for (int k = 0; k < 3; k++) {
        sl_segmentation_free(s[k]);
        sl_mesh_free(mesh[k]);
    }
}

/* Diagonals at random: the mirror exists for the quads, a copied quad may be cut along its other diagonal. */
static void paired_triangles_share_though_diagonals_differ(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xd1a6);
    for (int trial = 0; trial < 3 * test_multiplier(); trial++) {
        const test_mirrored body = {
            .n = 6, .mirrors = 1, .nspike = 0, .height = 0.0, .facets = TEST_MIXED, .seed = test_bits(&rng)};
        sl_segment_def def = sl_segment_default();
        def.pairing = SL_PAIR_ON;
        def.join = false; /* paths between loops may run along diagonals */
        sl_mesh *mesh = test_mirrored_mesh(&body, 1 + trial % 2);
        sl_triangulation *t = test_triangulate(mesh);
        sl_segmentation *s = segment(mesh, t, &def, 2);
        assert_int_equal(test_check_segmentation(mesh, t, s, def.flatten.max_stretch), 0);
        assert_true(s->sharing.axes + s->sharing.components > 0);
        assert_true(s->sharing.area > 0.35);
        for (int32_t h = 0; h < mesh->nh; h++) {
            const int32_t from = s->source[h];
            assert_true(from < 0 || memcmp(s->corner_uv + 2 * h, s->corner_uv + 2 * from, 16) == 0);
        }
        sl_segmentation_free(s);
        sl_triangulation_free(t);
        sl_mesh_free(mesh);
    }
}

/* One half's vertices moved a little: the connectivity still has its mirror. */
static void only_near_shares_what_is_not_exact(void **state)
{
    (void)state;
    const test_mirrored body = {.n = 6, .mirrors = 1, .nspike = 2, .height = 1.0, .facets = TEST_QUADS, .seed = 0x4ea2};
    for (int near = 0; near < 2; near++) {
        sl_mesh *mesh = test_mirrored_mesh(&body, 1);
        for (int32_t v = 0; v < mesh->nv; v++) {
            mesh->xyz[3 * v + 1] += mesh->xyz[3 * v] > 0.0 ? 2e-3 * sin(9.0 * v) : 0.0;
        }
        sl_triangulation *t = test_triangulate(mesh);
        sl_segment_def def = sl_segment_default();
        def.symmetry = near == 1 ? SL_SYMMETRY_USE_NEAR : SL_SYMMETRY_USE_EXACT;
        sl_segmentation *s = segment(mesh, t, &def, 2);
        assert_int_equal(test_check_segmentation(mesh, t, s, def.flatten.max_stretch), 0);
        const double shared = test_check_sharing(mesh, s, 0.1);
        assert_true(near == 1 ? shared > 0.4 : shared == 0.0);
        for (int32_t c = 0; c < s->nchart; c++) {
            assert_true(s->chart[c].copy_of < 0 || s->chart[c].kind == SL_SYMMETRY_NEAR);
        }
        assert_true((s->sharing.near_axes > 0) == (near == 1));
        assert_true(near == 1 ? s->sharing.deviation > 1e-6 && s->sharing.deviation <= 1e-2
                              : s->sharing.deviation == 0.0);
        sl_segmentation_free(s);
        sl_triangulation_free(t);
        sl_mesh_free(mesh);
    }
}

/* Diagonals at random and no pairing: no map, but a plane. */
static void the_plane_of_a_near_symmetry_is_the_first_cut_and_shares_nothing(void **state)
{
    (void)state;
    for (int near = 0; near < 2; near++) {
        const test_mirrored body = {
            .n = 8, .mirrors = 1, .nspike = 3, .height = 0.9, .facets = TEST_MIXED, .seed = 0x91a4e};
        sl_segment_def def = sl_segment_default();
        sl_mesh *mesh = NULL;
        double shared = 1.0;
        def.pairing = SL_PAIR_OFF;
        def.protect_first = false; /* the plane is an axis, and never sewn */
        def.sew_stretch = 1.5;
        def.symmetry = near == 1 ? SL_SYMMETRY_USE_NEAR : SL_SYMMETRY_USE_AUTO;
        sl_segmentation *s = segment_body(&body, 1, &def, &mesh, &shared);
        assert_true(shared == 0.0);
        assert_int_equal(s->sharing.planes, near);
        assert_int_equal(s->split[0].symmetry, near == 1 ? SL_SPLIT_PLANE : SL_SPLIT_PLAIN);
        double across = 0.0; /* seams that follow the plane */
        for (int32_t h = 0; h < mesh->nh; h++) {
            const double x = mesh->xyz[3 * mesh->origin[h]], y = mesh->xyz[3 * sl_target(mesh, h)];
            across += mesh->sew[h] > h && x == 0.0 && y == 0.0 ? 1.0 : 0.0;
        }
        assert_true(near == 1 ? across >= 24.0 : across < 24.0);
        sl_segmentation_free(s);
        sl_mesh_free(mesh);
    }
}

/* Quads so bent that their other diagonals turn over in the plane: sources give way, no copy is refused. */
static void charts_make_room_for_the_other_diagonals_of_their_copies(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xd1a60);
    int32_t refused = 0, copies = 0;
    for (int trial = 0; trial < 6 * test_multiplier(); trial++) {
        const test_mirrored body = {
            .n = 6, .mirrors = 1, .nspike = 3, .height = 2.2, .facets = TEST_QUADS, .seed = test_bits(&rng)};
        const sl_segment_def def = sl_segment_default();
        sl_mesh *mesh = test_mirrored_mesh(&body, 1);
        for (int32_t v = 0; v < mesh->nv; v++) { /* far off their places, mirrored */
            double *p = mesh->xyz + 3 * v;
            const double at[3] = {fabs(p[0]), p[1], p[2]}, side = p[0] < 0.0 ? -1.0 : p[0] > 0.0 ? 1.0 : 0.0;
            p[0] += side * 0.3 * at[0] * test_folded_noise(at, body.seed, 3);
            p[1] += 0.03 * test_folded_noise(at, body.seed, 4);
            p[2] += 0.03 * test_folded_noise(at, body.seed, 5);
        }
        sl_triangulation *t = test_triangulate(mesh);
        sl_segmentation *s = segment(mesh, t, &def, 2);
        assert_int_equal(test_check_segmentation(mesh, t, s, def.flatten.max_stretch), 0);
        (void)test_check_sharing(mesh, s, 1e-5);
        refused += s->sharing.refused;
        copies += s->sharing.copies;
        sl_triangulation_free(t);
        sl_segmentation_free(s);
        sl_mesh_free(mesh);
    }
    assert_true(10 * refused <= copies);
}

/* Sec. 4.3: no search, but the halves of a cut are compared. A narrow curved patch, mirrored in x alone: the first
 * eigenvector changes sign on its axis, the longest seam. */
static void the_paper_s_test_finds_halves_that_are_isomorphic(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x43);
    for (int trial = 0; trial < 4 * test_multiplier(); trial++) {
        test_grid g = test_grid_make(12, 9, false, false, TEST_QUADS);
        const uint64_t seed = test_bits(&rng);
        for (int32_t i = 0; i < g.rows; i++) {
            for (int32_t j = 0; j < g.columns; j++) {
                const double at[3] = {fabs(i - 6.0), j, 0.0}, side = i < 6 ? -1.0 : i > 6 ? 1.0 : 0.0;
                double *p = test_grid_point(&g, i, j);
                p[0] = side * (0.3 * at[0] + 0.05 * test_folded_noise(at, seed, 1));
                p[1] = j + 0.2 * test_folded_noise(at, seed, 2);
                p[2] = 0.7 * sin(0.6 * j) * cos(0.5 * at[0]) + 0.1 * test_folded_noise(at, seed, 3);
            }
        }
        sl_mesh *mesh = test_grid_mesh(&g, &rng, NULL);
        sl_triangulation *t = test_triangulate(mesh);
        sl_segment_def def = sl_segment_paper();
        def.flatten.max_stretch = 1.01;
        def.symmetry = trial == 3 ? SL_SYMMETRY_USE_OFF : SL_SYMMETRY_USE_AUTO;
        sl_segmentation *s = segment(mesh, t, &def, 2);
        test_check_segmentation(mesh, t, s, def.flatten.max_stretch);
        const double shared = test_check_sharing(mesh, s, 1e-5);
        assert_int_equal(s->split[0].symmetry, trial == 3 ? SL_SPLIT_PLAIN : SL_SPLIT_HALVES);
        assert_int_equal(s->split[0].vector >= 1, 1);
        assert_true(trial == 3 ? shared == 0.0 : shared > 0.3);
        sl_segmentation_free(s);
        sl_triangulation_free(t);
        sl_mesh_free(mesh);
    }
}

static void the_cap_holds_for_bodies_with_a_mirror(void **state)
{
    (void)state;
    for (int32_t cap = 1; cap <= 4; cap++) {
        const test_mirrored body = {
            .n = 6, .mirrors = 1, .nspike = 3, .height = 2.0, .facets = TEST_TRIANGLES, .seed = 5};
        sl_mesh *mesh = test_mirrored_mesh(&body, 1);
        sl_triangulation *t = test_triangulate(mesh);
        sl_segment_def def = sl_segment_default();
        def.max_charts = cap;
        def.flatten.max_stretch = 1.05;
        sl_segmentation *s = segment(mesh, t, &def, 2);
        test_check_segmentation(mesh, t, s, def.flatten.max_stretch);
        int32_t own = 0;
        for (int32_t c = 0; c < s->nchart; c++) {
            own += s->chart[c].copy_of < 0;
        }
        assert_true(own <= cap);
        sl_segmentation_free(s);
        sl_triangulation_free(t);
        sl_mesh_free(mesh);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mirrored_halves_share_their_uvs_bit_for_bit),
        cmocka_unit_test(facets_that_straddle_the_plane_stay_with_one_half),
        cmocka_unit_test(four_quarters_end_on_one_place),
        cmocka_unit_test(copies_of_a_component_share_its_charts),
        cmocka_unit_test(unsharing_lays_copies_out_the_right_way_round),
        cmocka_unit_test(without_symmetry_auto_and_off_give_the_same_bytes),
        cmocka_unit_test(off_shares_nothing_where_there_is_a_symmetry),
        cmocka_unit_test(sharing_gives_the_same_bytes_for_any_number_of_threads),
        cmocka_unit_test(paired_triangles_share_though_diagonals_differ),
        cmocka_unit_test(only_near_shares_what_is_not_exact),
        cmocka_unit_test(the_plane_of_a_near_symmetry_is_the_first_cut_and_shares_nothing),
        cmocka_unit_test(charts_make_room_for_the_other_diagonals_of_their_copies),
        cmocka_unit_test(the_paper_s_test_finds_halves_that_are_isomorphic),
        cmocka_unit_test(the_cap_holds_for_bodies_with_a_mirror),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
