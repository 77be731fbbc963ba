/* The rules, the fallback and lookahead, against the candidates themselves. */
#include "segment/checks.h"

static sl_piece *whole_piece(const sl_mesh *mesh, const sl_triangulation *t)
{
    int32_t *all = malloc((size_t)mesh->nf * sizeof *all);
    sl_piece *piece = NULL;
    for (int32_t f = 0; f < mesh->nf; f++) {
        all[f] = f;
    }
    assert_int_equal(sl_piece_create(mesh, t, all, mesh->nf, &piece), SL_OK);
    free(all);
    return piece;
}

static double side_length(const sl_mesh *m, const int32_t *side)
{
    double length = 0.0;
    for (int32_t h = 0; h < m->nh; h++) {
        length += h < m->twin[h] && side[m->face[h]] != side[m->face[m->twin[h]]] ? sl_mesh_edge_length(m, h) : 0.0;
    }
    return length;
}

static void check_simple_rule(const sl_piece *piece, const sl_segment_def *def)
{
    sl_facet_graph *g = test_whole_graph(piece->mesh, NULL);
    sl_spectrum *s = NULL;
    assert_int_equal(sl_spectrum_compute_signs(g, def->vectors, NULL, &s), SL_OK);
    sl_cut_candidate *c = malloc((size_t)s->count * sizeof *c);
    assert_int_equal(sl_cut_candidates(piece->mesh, g, s, c), SL_OK);
    sl_choice choice;
    assert_int_equal(sl_choose_cut(piece, NULL, def, NULL, &choice), SL_OK);
    double best = -1.0;
    int32_t winner = -1, passing = 0;
    for (int32_t k = 0; k < s->count - 1; k++) {
        const double score =
            def->rule == SL_RULE_LONGEST ? c[k].seam_length : c[k].seam_length / sqrt(s->lambda[c[k].vector]);
        passing += c[k].passes;
        if (c[k].passes && score > best) {
            best = score;
            winner = c[k].vector;
        }
    }
    assert_true(choice.found && passing > 1);
    assert_int_equal(choice.vector, winner);
    assert_int_equal(choice.candidates, passing);
    assert_true(choice.lambda == s->lambda[winner]);
    assert_true(test_near_rel(choice.length, c[winner - 1].seam_length, 1e-12));
    assert_true(test_near_rel(choice.length, side_length(piece->mesh, choice.side), 1e-12));
    sl_choice_clear(&choice);
    free(c);
    sl_spectrum_free(s);
    sl_facet_graph_free(g);
}

static void simple_rules_take_the_candidate_of_the_best_length(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x1e57);
    for (int trial = 0; trial < 16 * test_multiplier(); trial++) {
        sl_mesh *mesh = trial % 2 == 0 ? test_patch_mesh(&rng, 12, 5 + trial, TEST_TRIANGLES, NULL)
                                       : test_spiky_mesh(&rng, 5, 1 + trial / 2, 1.0, TEST_MIXED);
        sl_triangulation *t = test_triangulate(mesh);
        sl_piece *piece = whole_piece(mesh, t);
        sl_segment_def def = sl_segment_default();
        def.smooth = 0;
        def.rule = SL_RULE_LONGEST;
        check_simple_rule(piece, &def);
        def.rule = SL_RULE_LENGTH_LAMBDA;
        def.vectors = 17;
        check_simple_rule(piece, &def);
        sl_piece_free(piece);
        sl_triangulation_free(t);
        sl_mesh_free(mesh);
    }
}

static void a_smoothed_choice_is_no_longer_than_its_vector_s_seam(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x5307);
    int32_t shorter = 0;
    for (int trial = 0; trial < 6 * test_multiplier(); trial++) {
        sl_mesh *mesh = test_spiky_mesh(&rng, 5, 3, 1.0, TEST_TRIANGLES);
        sl_triangulation *t = test_triangulate(mesh);
        sl_piece *piece = whole_piece(mesh, t);
        sl_segment_def def = sl_segment_default();
        sl_choice rough, smooth;
        def.rule = SL_RULE_LONGEST;
        assert_int_equal(sl_choose_cut(piece, NULL, &def, NULL, &smooth), SL_OK);
        def.smooth = 0;
        assert_int_equal(sl_choose_cut(piece, NULL, &def, NULL, &rough), SL_OK);
        assert_int_equal(rough.vector, smooth.vector);
        assert_true(!rough.smoothed && smooth.length <= rough.length);
        assert_true(smooth.smoothed == (smooth.length < rough.length));
        shorter += smooth.smoothed;
        sl_choice_clear(&rough);
        sl_choice_clear(&smooth);
        sl_piece_free(piece);
        sl_triangulation_free(t);
        sl_mesh_free(mesh);
    }
    assert_true(shorter > 0);
}

/* Facets of a closed tube of two caps: cutting it across gives cups, cutting it along gives two long halves. */
static void lookahead_prefers_sides_that_flatten_with_less_stretch(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x100c);
    sl_mesh *mesh = test_patch_mesh(&rng, 12, 12, TEST_TRIANGLES, NULL);
    for (int32_t v = 0; v < mesh->nv; v++) { /* bend the patch into most of a sphere: deep cups stretch */
        double *p = mesh->xyz + 3 * v;
        const double r = 5.6 * sqrt(p[0] * p[0] + p[1] * p[1]), a = atan2(p[1], p[0]), polar = fmin(r, 2.9);
        p[0] = sin(polar) * cos(a);
        p[1] = sin(polar) * sin(a);
        p[2] = cos(polar);
    }
    sl_triangulation *t = test_triangulate(mesh);
    sl_piece *piece = whole_piece(mesh, t);
    uint8_t *half = malloc((size_t)mesh->nf), *tip = malloc((size_t)mesh->nf);
    for (int32_t f = 0; f < mesh->nf; f++) {
        double c[3];
        sl_mesh_face_centroid(mesh, f, c);
        half[f] = c[0] > 0.0;
        tip[f] = c[2] > 0.93;
    }
    double good = 0.0, bad = 0.0;
    assert_int_equal(sl_lookahead_score(piece, half, NULL, &good), SL_OK);
    assert_int_equal(sl_lookahead_score(piece, tip, NULL, &bad), SL_OK);
    assert_true(good > 0.0 && good < bad);
    free(half);
    free(tip);
    sl_piece_free(piece);
    sl_triangulation_free(t);
    sl_mesh_free(mesh);
}

static void a_side_with_a_handle_is_penalised(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x4a9d1e);
    sl_mesh *mesh = test_torus_mesh(&rng, 16, 9, 0.4, TEST_TRIANGLES);
    sl_triangulation *t = test_triangulate(mesh);
    sl_piece *piece = whole_piece(mesh, t);
    uint8_t *halves = malloc((size_t)mesh->nf), *spot = calloc((size_t)mesh->nf, 1);
    for (int32_t f = 0; f < mesh->nf; f++) {
        double c[3];
        sl_mesh_face_centroid(mesh, f, c);
        halves[f] = c[0] > 0.0;
    }
    spot[test_index(&rng, mesh->nf)] = 1;
    double tubes = 0.0, handle = 0.0;
    assert_int_equal(sl_lookahead_score(piece, halves, NULL, &tubes), SL_OK);
    assert_int_equal(sl_lookahead_score(piece, spot, NULL, &handle), SL_OK);
    assert_true(handle > tubes + 1.0);
    free(halves);
    free(spot);
    sl_piece_free(piece);
    sl_triangulation_free(t);
    sl_mesh_free(mesh);
}

/* A polygon with a strip of quads on each side: lambda_2 has multiplicity arms - 1, and every vector leaves several
 * arms on one side of the hub. */
static sl_mesh *star_mesh(test_rng *rng, int32_t arms, int32_t length)
{
    const int32_t nv = arms * (1 + 2 * length), nf = 1 + arms * length;
    double *xyz = malloc(3 * (size_t)nv * sizeof *xyz);
    int32_t *first = malloc((size_t)(nf + 1) * sizeof *first), *index = malloc((size_t)(arms + 4 * nf) * sizeof *index);
    int32_t n = 0, f = 0, next = arms;
    for (int32_t k = 0; k < nv; k++) {
        const int32_t arm = k < arms ? k : (k - arms) / (2 * length),
                      step = k < arms ? 0 : 1 + (k - arms) % (2 * length) / 2;
        const int32_t at = k < arms ? arm : arm + (k - arms) % 2;
        const double angle = 2.0 * TEST_PI * at / arms;
        xyz[3 * k] = (2.0 + step) * cos(angle) + test_uniform(rng, -0.1, 0.1);
        xyz[3 * k + 1] = (2.0 + step) * sin(angle) + test_uniform(rng, -0.1, 0.1);
        xyz[3 * k + 2] = 0.2 * step * step + test_uniform(rng, -0.1, 0.1);
    }
    first[0] = 0;
    for (int32_t k = 0; k < arms; k++) {
        index[n++] = k;
    }
    first[++f] = n;
    for (int32_t arm = 0; arm < arms; arm++) {
        int32_t a = arm, b = (arm + 1) % arms;
        for (int32_t step = 0; step < length; step++, next += 2) {
            const int32_t quad[4] = {b, a, next, next + 1};
            memcpy(index + n, quad, sizeof quad);
            n += 4;
            first[++f] = n;
            a = next;
            b = next + 1;
        }
    }
    return test_mesh_of(nv, nf, xyz, first, index);
}

static void where_nothing_passes_the_fiedler_vector_s_sides_are_taken(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x57a4);
    for (int32_t arms = 9; arms <= 12; arms += 3) {
        sl_mesh *mesh = star_mesh(&rng, arms, 5);
        sl_triangulation *t = test_triangulate(mesh);
        sl_piece *piece = whole_piece(mesh, t);
        sl_segment_def def = sl_segment_default();
        def.vectors = 8;
        sl_choice choice;
        assert_int_equal(sl_choose_cut(piece, NULL, &def, NULL, &choice), SL_OK);
        assert_true(choice.found);
        assert_int_equal(choice.vector, -1);
        assert_int_equal(choice.candidates, 0);
        sl_choice_clear(&choice);

        def.flatten.max_stretch = 1.0 + 1e-9; /* the hub and the quads are not planar: everything is split */
        def.sew = false;
        sl_segmentation *s = NULL;
        assert_int_equal(sl_segment(mesh, t, &def, NULL, &s), SL_OK);
        assert_int_equal(s->split[0].vector, -1);
        assert_true(s->split[0].parts > 2);
        assert_true(test_check_segmentation(mesh, t, s, def.flatten.max_stretch) <= mesh->nf);
        sl_segmentation_free(s);
        sl_piece_free(piece);
        sl_triangulation_free(t);
        sl_mesh_free(mesh);
    }
}

static void a_lone_pair_of_triangles_is_split_between_them(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x9a12);
    sl_mesh *mesh = test_patch_mesh(&rng, 1, 1, TEST_TRIANGLES, NULL);
    sl_triangulation *t = test_triangulate(mesh);
    sl_piece *piece = whole_piece(mesh, t);
    const int32_t partner[2] = {1, 0};
    const sl_segment_def def = sl_segment_default();
    sl_choice choice;
    assert_int_equal(sl_choose_cut(piece, partner, &def, NULL, &choice), SL_OK);
    assert_true(choice.found && choice.side[0] != choice.side[1]);
    sl_choice_clear(&choice);
    sl_piece_free(piece);
    sl_triangulation_free(t);
    sl_mesh_free(mesh);
}

static void pairs_are_never_cut_apart(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x9a13);
    sl_mesh *mesh = test_spiky_mesh(&rng, 5, 3, 1.0, TEST_TRIANGLES);
    sl_triangulation *t = test_triangulate(mesh);
    sl_piece *piece = whole_piece(mesh, t);
    int32_t *partner = malloc((size_t)mesh->nf * sizeof *partner);
    double fraction = 0.0;
    assert_int_equal(sl_pair_triangles(mesh, partner, &fraction), SL_OK);
    sl_segment_def def = sl_segment_default();
    sl_choice choice;
    assert_int_equal(sl_choose_cut(piece, partner, &def, NULL, &choice), SL_OK);
    int32_t pairs = 0;
    for (int32_t f = 0; f < mesh->nf; f++) {
        pairs += partner[f] >= 0;
        assert_true(partner[f] < 0 || choice.side[f] == choice.side[partner[f]]);
    }
    assert_true(pairs > mesh->nf / 2);
    sl_choice_clear(&choice);
    free(partner);
    sl_piece_free(piece);
    sl_triangulation_free(t);
    sl_mesh_free(mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(simple_rules_take_the_candidate_of_the_best_length),
        cmocka_unit_test(a_smoothed_choice_is_no_longer_than_its_vector_s_seam),
        cmocka_unit_test(lookahead_prefers_sides_that_flatten_with_less_stretch),
        cmocka_unit_test(a_side_with_a_handle_is_penalised),
        cmocka_unit_test(where_nothing_passes_the_fiedler_vector_s_sides_are_taken),
        cmocka_unit_test(a_lone_pair_of_triangles_is_split_between_them),
        cmocka_unit_test(pairs_are_never_cut_apart),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
