#include "mesh/pair_internal.h"

#include "mesh/facet_graph.h"
#include "mesh/mesh_fixtures.h"

static soup s;
static int32_t partner[SOUP_FACES];

/* A matching of glued triangles; no two facets that could be paired both stay alone. */
static double check_pairing(const sl_mesh *m)
{
    double fraction = -1.0;
    assert_int_equal(sl_pair_triangles(m, partner, &fraction), SL_OK);
    assert_true(fraction >= 0.0 && fraction <= 1.0);
    for (int32_t f = 0; f < m->nf; f++) {
        const int32_t g = partner[f];
        bool glued = false;
        for (int32_t h = m->face_first[f]; h < m->face_first[f + 1]; h++) {
            const int32_t o = m->twin[h] >= 0 ? m->face[m->twin[h]] : -1;
            glued = glued || (o >= 0 && o == g);
            assert_true(g >= 0 || o < 0 || partner[o] >= 0 || sl_degree(m, f) != 3 || sl_degree(m, o) != 3 ||
                        sl_pair_score(m, h) < 0.21);
        }
        assert_true(g < 0 || (glued && g != f && partner[g] == f && sl_degree(m, f) == 3));
    }
    return fraction;
}

static void triangulated_quads_are_found_again(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x9a12);
    for (int trial = 0; trial < 10 * test_multiplier(); trial++) {
        soup_grid(&s, &rng, (soup_surface)test_index(&rng, 3), 30 + test_index(&rng, 8), 11 + test_index(&rng, 4), 1.0);
        sl_mesh *m = soup_build(&s, NULL);
        assert_true(check_pairing(m) >= 0.9);
        for (int32_t f = 0; f < m->nf; f++) {
            assert_int_equal(partner[f], f % 2 == 0 ? f + 1 : f - 1);
        }
        sl_mesh_free(m);
    }
}

static void quads_stay_alone_among_triangles(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x9a13);
    soup_grid(&s, &rng, SOUP_TORUS, 30, 11, 0.5);
    sl_mesh *m = soup_build(&s, NULL);
    check_pairing(m);
    for (int32_t f = 0; f < m->nf; f++) {
        assert_true(sl_degree(m, f) == 3 || partner[f] == -1);
    }
    sl_mesh_free(m);
}

static void a_mesh_of_quads_has_nothing_to_pair(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x9a14);
    soup_grid(&s, &rng, SOUP_BAND, 8, 6, 0.0);
    sl_mesh *m = soup_build(&s, NULL);
    assert_true(check_pairing(m) == 0.0);
    sl_mesh_free(m);
}

/* Points put one by one into a random triangle: valences from 3 to many. */
static void random_triangles(test_rng *rng, int32_t points)
{
    soup_clear(&s);
    soup_vertex(&s, -3.0, -3.0, 0.1);
    soup_vertex(&s, 7.0, -3.0, 0.0);
    soup_vertex(&s, -3.0, 7.0, 0.2);
    soup_face(&s, 3, (int32_t[]){0, 1, 2});
    for (int32_t p = 0; p < points; p++) {
        const int32_t f = test_index(rng, s.nf), *c = s.index + 3 * f;
        const int32_t a = c[0], b = c[1], d = c[2];
        double w[3], sum = 0.0, x[3] = {0.0, 0.0, 0.0};
        for (int k = 0; k < 3; k++) {
            w[k] = test_uniform(rng, 0.3, 1.0);
            sum += w[k];
        }
        for (int k = 0; k < 9; k++) {
            x[k % 3] += w[k / 3] / sum * s.xyz[3 * c[k / 3] + k % 3];
        }
        const int32_t v = soup_vertex(&s, x[0], x[1], x[2]);
        s.index[3 * f + 2] = v;
        soup_face(&s, 3, (int32_t[]){b, d, v});
        soup_face(&s, 3, (int32_t[]){d, a, v});
    }
}

static void irregular_triangles_are_not_called_quads(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x9a15);
    for (int trial = 0; trial < 10 * test_multiplier(); trial++) {
        random_triangles(&rng, 200);
        sl_mesh *m = soup_build(&s, NULL);
        assert_true(check_pairing(m) < 0.6);
        sl_mesh_free(m);
    }
}

/* Position of the triangle with directed edge a -> b, *k its corner; -1 = none. */
static int32_t triangle_with_edge(int32_t a, int32_t b, int32_t *k)
{
    for (int32_t c = 0; c < 3 * s.nf; c++) {
        if (s.index[c] == a && s.index[c % 3 == 2 ? c - 2 : c + 1] == b) {
            *k = c;
            return c / 3;
        }
    }
    return -1;
}

static double angle_at(int32_t apex, int32_t a, int32_t b)
{
    const double *p = s.xyz + 3 * apex, *q = s.xyz + 3 * a, *r = s.xyz + 3 * b;
    const double u[2] = {q[0] - p[0], q[1] - p[1]}, v[2] = {r[0] - p[0], r[1] - p[1]};
    return atan2(u[0] * v[1] - u[1] * v[0], u[0] * v[0] + u[1] * v[1]);
}

/* A Delaunay triangulation of jittered points, by flips: well-shaped triangles that never were quads. */
static void delaunay_triangles(test_rng *rng, int32_t n)
{
    soup_grid(&s, rng, SOUP_SHEET, n, n, 1.0);
    for (int32_t v = 0; v < s.nv; v++) {
        const int32_t i = v / (n + 1), j = v % (n + 1);
        const double jitter = i > 0 && i < n && j > 0 && j < n ? 0.45 : 0.0;
        s.xyz[3 * v] = i + test_uniform(rng, -jitter, jitter);
        s.xyz[3 * v + 1] = j + test_uniform(rng, -jitter, jitter);
        s.xyz[3 * v + 2] = 0.0;
    }
    bool flipped = true;
    for (int pass = 0; pass < 100 && flipped; pass++) {
        flipped = false;
        for (int32_t c = 0; c < 3 * s.nf; c++) {
            const int32_t next = c % 3 == 2 ? c - 2 : c + 1, prev = c % 3 == 0 ? c + 2 : c - 1;
            const int32_t a = s.index[c], b = s.index[next], x = s.index[prev];
            int32_t d = 0;
            if (triangle_with_edge(b, a, &d) < 0) {
                continue;
            }
            const int32_t d_prev = d % 3 == 0 ? d + 2 : d - 1, y = s.index[d_prev];
            if (fabs(angle_at(x, a, b)) + fabs(angle_at(y, b, a)) > TEST_PI + 1e-9) {
                s.index[next] = y; /* a b x, b a y -> a y x, b x y */
                s.index[d % 3 == 2 ? d - 2 : d + 1] = x;
                flipped = true;
            }
        }
    }
}

static void well_shaped_triangles_of_irregular_valence_are_not_called_quads(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x9a18);
    for (int trial = 0; trial < 3 * test_multiplier(); trial++) {
        delaunay_triangles(&rng, 20);
        sl_mesh *m = soup_build(&s, NULL);
        const double fraction = check_pairing(m);
        double shape = 0.0;
        for (int32_t h = 0; h < m->nh; h++) {
            const bool pair = m->twin[h] >= 0 && partner[m->face[h]] == m->face[m->twin[h]];
            shape += pair && sl_pair_score(m, h) >= 0.5 ? 1.0 / m->nf : 0.0;
        }
        assert_true(fraction < 0.75);
        assert_true(fraction < shape - 0.05);
        sl_mesh_free(m);
    }
}

/* Heaviest matching of the triangles from f on, by trying everything. */
static double heaviest(const sl_mesh *m, int32_t f, bool *taken)
{
    while (f < m->nf && taken[f]) {
        f++;
    }
    if (f >= m->nf) {
        return 0.0;
    }
    taken[f] = true;
    double best = heaviest(m, f + 1, taken);
    for (int32_t h = m->face_first[f]; h < m->face_first[f + 1]; h++) {
        const int32_t g = m->twin[h] >= 0 ? m->face[m->twin[h]] : f;
        const double score = taken[g] ? 0.0 : sl_pair_score(m, h);
        if (score > 0.2) {
            taken[g] = true;
            best = fmax(best, 2.0 - (1.0 - score) * (1.0 - score) + heaviest(m, f + 1, taken));
            taken[g] = false;
        }
    }
    taken[f] = false;
    return best;
}

static double weight(const sl_mesh *m)
{
    double sum = 0.0;
    for (int32_t h = 0; h < m->nh; h++) {
        if (m->twin[h] > h && partner[m->face[h]] == m->face[m->twin[h]]) {
            sum += 2.0 - pow(1.0 - sl_pair_score(m, h), 2);
        }
    }
    return sum;
}

static void small_pairings_are_the_heaviest(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x9a16);
    const int trials = 200 * test_multiplier();
    int optimal = 0;
    for (int trial = 0; trial < trials; trial++) {
        bool taken[64] = {false};
        if (trial % 2 == 0) {
            soup_grid(&s, &rng, SOUP_SHEET, 2 + test_index(&rng, 2), 3, 1.0);
            for (int32_t i = 0; i < 3 * s.nv; i++) {
                s.xyz[i] += test_uniform(&rng, -0.3, 0.3);
            }
        } else {
            random_triangles(&rng, 3 + test_index(&rng, 7));
        }
        sl_mesh *m = soup_build(&s, NULL);
        check_pairing(m);
        const double best = heaviest(m, 0, taken), found = weight(m);
        assert_true(found <= best + 1e-9 && found >= 0.7 * best);
        optimal += found >= best - 1e-9;
        sl_mesh_free(m);
    }
    assert_true(optimal >= trials * 9 / 10);
}

static double path_best(const double *weight, int32_t n, int32_t forced, int32_t barred)
{
    double with = -HUGE_VAL, without = 0.0; /* best over the edges so far, the last one used or not */
    for (int32_t e = 0; e < n; e++) {
        const double use = e == barred ? -HUGE_VAL : without + weight[e];
        const double skip = e == forced ? -HUGE_VAL : fmax(with, without);
        with = use;
        without = skip;
    }
    return fmax(with, without);
}

/* On a strip, whose dual graph is a path, the belief in an edge is what the best matching with it has over the best
 * without it; both by dynamic programming. */
static void beliefs_on_strips_are_exact(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x9a19);
    for (int trial = 0; trial < 100 * test_multiplier(); trial++) {
        const int32_t nt = 2 + test_index(&rng, 14);
        soup_clear(&s);
        for (int32_t k = 0; k < nt + 2; k++) {
            soup_vertex(&s, 0.9 * k, k % 2 == 0 ? 0.0 : 1.1, test_uniform(&rng, 0.0, 0.1));
        }
        for (int32_t k = 0; k < nt; k++) {
            soup_face(&s, 3, (int32_t[]){k, k % 2 == 0 ? k + 2 : k + 1, k % 2 == 0 ? k + 1 : k + 2});
        }
        sl_mesh *m = soup_build(&s, NULL);
        double score[3 * 16], belief[3 * 16], weight[16];
        for (int32_t h = 0; h < m->nh; h++) {
            score[h] = 0.0;
        }
        for (int32_t h = 0; h < m->nh; h++) {
            if (m->twin[h] >= 0 && m->face[m->twin[h]] == m->face[h] + 1) {
                score[h] = score[m->twin[h]] = test_uniform(&rng, 0.2, 1.0);
                weight[m->face[h]] = 2.0 - (1.0 - score[h]) * (1.0 - score[h]);
            }
        }
        assert_int_equal(sl_pair_beliefs(m, score, belief), SL_OK);
        for (int32_t h = 0; h < m->nh; h++) {
            if (score[h] == 0.0) {
                assert_true(belief[h] == -HUGE_VAL);
                continue;
            }
            const int32_t f = m->face[h], g = m->face[m->twin[h]], e = f < g ? f : g;
            const double expect = path_best(weight, nt - 1, e, -1) - path_best(weight, nt - 1, -1, e);
            assert_true(test_near(belief[h], expect, 64 * 0x1p-20));
        }
        sl_mesh_free(m);
    }
}

/* A strip of four triangles whose middle pair is matched: the two at its ends are freed by flipping the path. */
static void an_augmenting_path_pairs_the_ends_of_a_strip(void **state)
{
    (void)state;
    soup_clear(&s);
    for (int k = 0; k < 6; k++) {
        soup_vertex(&s, 0.9 * k, k % 2 == 0 ? 0.0 : 1.1, 0.1 * k * k);
    }
    for (int32_t k = 0; k < 4; k++) {
        soup_face(&s, 3, (int32_t[]){k, k % 2 == 0 ? k + 2 : k + 1, k % 2 == 0 ? k + 1 : k + 2});
    }
    sl_mesh *m = soup_build(&s, NULL);
    double score[12];
    int32_t mate[4] = {-1, -1, -1, -1};
    for (int32_t h = 0; h < 12; h++) {
        score[h] = m->twin[h] >= 0 ? 0.5 : 0.0;
        if (m->twin[h] >= 0 && m->face[h] + m->face[m->twin[h]] == 3) {
            mate[m->face[h]] = h;
        }
    }
    assert_true(mate[1] >= 0 && mate[2] >= 0);
    sl_matching matching = {m, score, mate};
    assert_int_equal(sl_matching_augment(&matching), SL_OK);
    for (int32_t f = 0; f < 4; f++) {
        assert_true(mate[f] >= 0);
        assert_int_equal(m->face[mate[f]], f);
        assert_int_equal(m->face[m->twin[mate[f]]], f ^ 1);
    }
    sl_mesh_free(m);
}

static int32_t inner_halfedge(const sl_mesh *m)
{
    int32_t h = 0;
    while (m->twin[h] < 0) {
        h++;
    }
    return h;
}

static void the_score_measures_angles_and_the_fold(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x9a17);
    for (int trial = 0; trial < 50; trial++) {
        /* A square folded along its diagonal keeps its angles. */
        const double fold = test_uniform(&rng, -1.4, 1.4), a = sqrt(0.5);
        soup_clear(&s);
        soup_vertex(&s, -a, 0.0, 0.0);
        soup_vertex(&s, 0.0, -a, 0.0);
        soup_vertex(&s, a, 0.0, 0.0);
        soup_vertex(&s, 0.0, a * cos(fold), a * sin(fold));
        soup_face(&s, 3, (int32_t[]){0, 1, 2});
        soup_face(&s, 3, (int32_t[]){0, 2, 3});
        sl_mesh *m = soup_build(&s, NULL);
        assert_true(test_near(sl_pair_score(m, inner_halfedge(m)), cos(fold), 64 * TEST_EPS));
        sl_mesh_free(m);
        /* A flat rhombus of angles 2 b and pi - 2 b. */
        const double b = test_uniform(&rng, 0.1, 1.4);
        s.xyz[0] = -cos(b);
        s.xyz[6] = cos(b);
        s.xyz[4] = -sin(b);
        s.xyz[10] = sin(b);
        s.xyz[11] = 0.0;
        m = soup_build(&s, NULL);
        const double expect = 1.0 - fabs(2.0 * b - 0.5 * TEST_PI) / (0.5 * TEST_PI);
        assert_true(test_near(sl_pair_score(m, inner_halfedge(m)), expect, 256 * TEST_EPS));
        sl_mesh_free(m);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(triangulated_quads_are_found_again),
        cmocka_unit_test(quads_stay_alone_among_triangles),
        cmocka_unit_test(a_mesh_of_quads_has_nothing_to_pair),
        cmocka_unit_test(irregular_triangles_are_not_called_quads),
        cmocka_unit_test(well_shaped_triangles_of_irregular_valence_are_not_called_quads),
        cmocka_unit_test(small_pairings_are_the_heaviest),
        cmocka_unit_test(beliefs_on_strips_are_exact),
        cmocka_unit_test(an_augmenting_path_pairs_the_ends_of_a_strip),
        cmocka_unit_test(the_score_measures_angles_and_the_fold),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
