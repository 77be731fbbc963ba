/* Planted symmetries are found as what they are: exact, near, or of the connectivity only. */
#include "checks.h"

static int32_t planted_axis(const model *m, const int32_t *vertex, const int32_t *mirror, int32_t nv)
{
    int32_t count = 0; /* edges of two vertices on the plane, met from both sides */
    uint8_t *fixed = sl_calloc(m->nv, 1);
    for (int32_t v = 0; v < nv; v++) {
        fixed[vertex[v]] = mirror[v] == v;
    }
    for (int32_t f = 0; f < m->nf; f++) {
        const int32_t d = m->first[f + 1] - m->first[f];
        for (int32_t k = 0; k < d; k++) {
            count += fixed[m->index[m->first[f] + k]] && fixed[m->index[m->first[f] + (k + 1) % d]];
        }
    }
    sl_free(fixed);
    return count / 2;
}

static void planted_mirrors_are_found_and_nothing_else(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x91a7);
    for (int trial = 0; trial < 40 * test_multiplier(); trial++) {
        const int32_t n = 4 + test_index(&rng, 12), k = 4 + test_index(&rng, 12);
        const bool straddle = trial % 2 == 1;
        int32_t mirror[1000], vertex[1000];
        double T[12];
        model m = model_new();
        model_planted(&m, &rng, n, k, straddle, false, mirror);
        model_random_isometry(&rng, false, T);
        model_move(&m, T);
        model_relabel(&m, &rng, 1, NULL, vertex);
        sl_mesh *mesh = model_build(&m);
        sl_symmetry *s = find_all(mesh, NULL, SL_SYMMETRY_MOST);
        assert_int_equal(s->nmap, 1);
        const sl_symmetry_map *map = &s->map[0];
        check_map(mesh, s, map);
        assert_true(map->reverses && map->separates && map->order == 2);
        assert_int_equal(map->kind, SL_SYMMETRY_EXACT);
        assert_int_equal(map->fixed_facets, straddle ? k : 0);
        assert_int_equal(map->axis_edges, planted_axis(&m, vertex, mirror, m.nv));
        for (int32_t h = 0; h < mesh->nh; h++) {
            const int32_t v = mesh->input_vertex[mesh->origin[h]];
            const int32_t w = mesh->input_vertex[mesh->origin[sl_symmetry_image_corner(mesh, s, map, h)]];
            int32_t old = 0;
            while (vertex[old] != v) {
                old++;
            }
            assert_int_equal(w, vertex[mirror[old]]);
        }
        sl_symmetry_free(s);
        sl_mesh_free(mesh);
        model_free(&m);
    }
}

/* One more triangle on a border edge that is not its own mirror image. */
static void add_ear(model *m, const int32_t *mirror)
{
    const int32_t ear = m->nv, corners = m->first[m->nf];
    model_vertex(m, 0.3, -2.0, 0.4);
    for (int32_t k = 0; k < corners; k++) {
        const int32_t u = m->index[k];
        int32_t corner = 0;
        for (int32_t v = 0; v < ear; v++) {
            if (mirror[u] != u && mirror[v] != u && facet_with_edge(m, u, v, false, &corner) >= 0 &&
                facet_with_edge(m, v, u, false, &corner) < 0) {
                model_triangle(m, v, u, ear);
                return;
            }
        }
    }
}

static void sheets_without_symmetry_have_none(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xa5);
    for (int trial = 0; trial < 30 * test_multiplier(); trial++) {
        int32_t mirror[1000];
        model m = model_new();
        model_planted(&m, &rng, 6, 5 + test_index(&rng, 9), trial % 2 == 1, false, mirror);
        add_ear(&m, mirror);
        model_relabel(&m, &rng, 1, NULL, NULL);
        sl_mesh *mesh = model_build(&m);
        sl_symmetry *s = find_all(mesh, NULL, SL_SYMMETRY_MOST);
        assert_int_equal(s->nmap, 0);
        assert_false(s->truncated);
        sl_symmetry_free(s);
        sl_mesh_free(mesh);
        model_free(&m);
    }
}

/* Splits the first quad by a diagonal. */
static void one_edge_more_ends_a_symmetry(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xf11b);
    int32_t mirror[1000];
    model m = model_new(), cut = model_new();
    model_planted(&m, &rng, 9, 8, false, true, mirror);
    memcpy(cut.xyz, m.xyz, 3 * (size_t)m.nv * sizeof *m.xyz);
    cut.nv = m.nv;
    for (int32_t f = 0; f < m.nf; f++) {
        const int32_t *q = &m.index[4 * f];
        if (f == 37) {
            model_triangle(&cut, q[0], q[1], q[2]);
            model_triangle(&cut, q[0], q[2], q[3]);
        } else {
            model_face(&cut, 4, q);
        }
    }
    sl_mesh *whole = model_build(&m), *broken = model_build(&cut);
    sl_symmetry *s = find_all(whole, NULL, 64), *t = find_all(broken, NULL, 64);
    assert_true(s->nmap >= 1 && s->map[0].kind == SL_SYMMETRY_EXACT);
    for (int32_t i = 0; i < t->nmap; i++) {
        assert_int_equal(t->map[i].kind, SL_SYMMETRY_TOPOLOGICAL);
    }
    sl_symmetry_free(s);
    sl_symmetry_free(t);
    sl_mesh_free(whole);
    sl_mesh_free(broken);
    model_free(&m);
    model_free(&cut);
}

static void a_perturbed_symmetry_is_near_then_topological(void **state)
{
    (void)state;
    static const double size[4] = {0.0, 1e-12, 3e-3, 1.0};
    static const sl_symmetry_kind kind[4] = {SL_SYMMETRY_EXACT, SL_SYMMETRY_EXACT, SL_SYMMETRY_NEAR,
                                             SL_SYMMETRY_TOPOLOGICAL};
    for (int i = 0; i < 4; i++) {
        test_rng rng = test_rng_seed(0x77);
        int32_t mirror[1000];
        model m = model_new();
        model_planted(&m, &rng, 6, 7, false, false, mirror);
        model_perturb(&m, &rng, size[i]);
        sl_mesh *mesh = model_build(&m);
        sl_symmetry *s = find_all(mesh, NULL, 64);
        assert_int_equal(s->nmap, 1);
        assert_int_equal(s->map[0].kind, kind[i]);
        const double extent = sl_mesh_diagonal(mesh) / mesh->scale; /* in the model's units */
        assert_true(s->map[0].deviation <= 4.0 * size[i] / extent + 1e-14);
        assert_true(s->map[0].misfit >= 0.1 * size[i] / extent);
        sl_symmetry_free(s);
        sl_mesh_free(mesh);
        model_free(&m);
    }
}

/* As a text file keeps them: relative lengths differ by 1e-6 and more, positions by 1e-7 of the diagonal. */
static void coordinates_of_six_digits_are_exact(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x6d);
    for (int trial = 0; trial < 10 * test_multiplier(); trial++) {
        int32_t mirror[1000];
        double T[12];
        model m = model_new();
        model_planted(&m, &rng, 6, 7, trial % 2 == 0, false, mirror);
        model_random_isometry(&rng, false, T);
        for (int k = 0; k < 12; k++) {
            T[k] *= 0.2;
        }
        model_move(&m, T);
        for (int32_t i = 0; i < 3 * m.nv; i++) {
            m.xyz[i] = round(m.xyz[i] * 1e6) * 1e-6;
        }
        sl_mesh *mesh = model_build(&m);
        sl_symmetry *s = find_all(mesh, NULL, 64);
        assert_int_equal(s->nmap, 1);
        assert_int_equal(s->map[0].kind, SL_SYMMETRY_EXACT);
        assert_true(s->map[0].misfit > 1e-6 && s->map[0].deviation > 1e-8);
        sl_symmetry_free(s);
        sl_mesh_free(mesh);
        model_free(&m);
    }
}

/* In a plane a turn over does as well as a mirror: the isometry reflects where the map does. */
static void isometries_of_flat_sheets_reflect_where_their_maps_do(void **state)
{
    (void)state;
    model m = model_new();
    for (int i = 0; i < 5; i++) {
        for (int j = 0; j < 4; j++) {
            model_vertex(&m, i - 2.0, 0.3 * i + j * (1.0 + 0.1 * j), 0.7);
            m.xyz[3 * m.nv - 2] -= 0.3 * i;
        }
    }
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 3; j++) {
            model_quad(&m, 4 * i + j, 4 * i + 4 + j, 4 * i + 5 + j, 4 * i + 1 + j);
        }
    }
    sl_mesh *mesh = model_build(&m);
    sl_symmetry *s = find_all(mesh, NULL, 64);
    assert_int_equal(s->nmap, 3);
    assert_int_equal(s->map[0].kind, SL_SYMMETRY_EXACT);
    for (int32_t i = 0; i < s->nmap; i++) {
        const double *T = s->map[i].isometry;
        const double det = T[0] * (T[5] * T[10] - T[6] * T[9]) - T[1] * (T[4] * T[10] - T[6] * T[8]) +
                           T[2] * (T[4] * T[9] - T[5] * T[8]);
        assert_true(test_near(det, s->map[i].reverses ? -1.0 : 1.0, 1e-12));
    }
    sl_symmetry_free(s);
    sl_mesh_free(mesh);
    model_free(&m);
}

/* One vertex near another moves by less than def.exact, and its shortest edge changes by a tenth. */
static void short_edges_of_unlike_lengths_are_not_exact(void **state)
{
    (void)state;
    for (int apart = 0; apart < 2; apart++) {
        const double e = 1e-5;
        model m = model_new();
        const int32_t a = model_vertex(&m, 0, 0, 0), b = model_vertex(&m, 0, 2, 0.1), c = model_vertex(&m, 1, 0, 0.3);
        const int32_t d = model_vertex(&m, -1, 0, 0.3), f = model_vertex(&m, 1, e, 0.3);
        const int32_t g = model_vertex(&m, -1, e * (1.0 + 0.1 * apart), 0.3);
        model_face(&m, 4, (const int32_t[4]){a, c, f, b});
        model_face(&m, 4, (const int32_t[4]){a, b, g, d});
        sl_mesh *mesh = model_build(&m);
        sl_symmetry *s = find_all(mesh, NULL, 64);
        int32_t exact = 0, near = 0;
        for (int32_t i = 0; i < s->nmap; i++) {
            check_map(mesh, s, &s->map[i]);
            exact += s->map[i].kind == SL_SYMMETRY_EXACT;
            near += s->map[i].kind == SL_SYMMETRY_NEAR && s->map[i].deviation < 1e-6;
        }
        assert_int_equal(exact, 1 - apart);
        assert_int_equal(near, apart);
        sl_symmetry_free(s);
        sl_mesh_free(mesh);
        model_free(&m);
    }
}

/* A sheet bent along a line keeps its edge lengths and is no longer symmetric. */
static void equal_edge_lengths_do_not_make_a_bent_sheet_symmetric(void **state)
{
    (void)state;
    model m = model_new();
    for (int i = -2; i <= 2; i++) {
        for (int j = 0; j < 4; j++) { /* lines i = 1 and i = -1 are folded by different angles */
            const double fold = i == 2 ? 0.7 : i == -2 ? 0.2 : 0.0;
            const double x = i == 2 || i == -2 ? (i > 0 ? 1.0 : -1.0) * (1.0 + cos(fold)) : i;
            model_vertex(&m, x, j * (1.0 + 0.1 * j), sin(fold));
        }
    }
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 3; j++) {
            model_quad(&m, 4 * i + j, 4 * i + 4 + j, 4 * i + 5 + j, 4 * i + 1 + j);
        }
    }
    sl_mesh *mesh = model_build(&m);
    sl_symmetry *s = find_all(mesh, NULL, 64);
    int32_t isometric = 0;
    for (int32_t i = 0; i < s->nmap; i++) {
        assert_true(s->map[i].kind != SL_SYMMETRY_EXACT);
        isometric += s->map[i].misfit < 1e-12;
    }
    assert_int_equal(isometric, 1);
    sl_symmetry_free(s);
    sl_mesh_free(mesh);
    model_free(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(planted_mirrors_are_found_and_nothing_else),
        cmocka_unit_test(sheets_without_symmetry_have_none),
        cmocka_unit_test(one_edge_more_ends_a_symmetry),
        cmocka_unit_test(a_perturbed_symmetry_is_near_then_topological),
        cmocka_unit_test(coordinates_of_six_digits_are_exact),
        cmocka_unit_test(isometries_of_flat_sheets_reflect_where_their_maps_do),
        cmocka_unit_test(short_edges_of_unlike_lengths_are_not_exact),
        cmocka_unit_test(equal_edge_lengths_do_not_make_a_bent_sheet_symmetric),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
