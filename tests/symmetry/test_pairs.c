#include "checks.h"

#include "mesh/facet_graph.h"

/* Each quad of the model in two triangles, by random diagonals; facets 2 f and 2 f + 1. */
static model triangulate(const model *quads, test_rng *rng)
{
    model m = model_new();
    memcpy(m.xyz, quads->xyz, 3 * (size_t)quads->nv * sizeof *m.xyz);
    m.nv = quads->nv;
    for (int32_t f = 0; f < quads->nf; f++) {
        const int32_t *q = &quads->index[4 * f], o = test_index(rng, 2);
        model_triangle(&m, q[o], q[o + 1], q[(o + 2) % 4]);
        model_triangle(&m, q[o], q[(o + 2) % 4], q[(o + 3) % 4]);
    }
    return m;
}

static int32_t *neighbours_are_partners(int32_t nf)
{
    int32_t *partner = sl_alloc(nf, sizeof *partner);
    assert_non_null(partner);
    for (int32_t f = 0; f < nf; f++) {
        partner[f] = f ^ 1;
    }
    return partner;
}

/* Corners at image vertices, facets one to one and pairs to pairs, corners in the image facet where it has the vertex;
 * whole triangles where diagonals agree. vertex: image of each input vertex, or NULL = learn it. */
static void check_pair_map(const sl_mesh *m, const sl_symmetry *s, const sl_symmetry_map *map, const int32_t *vertex)
{
    int32_t *image = sl_alloc(m->nv, sizeof *image);
    uint8_t *used = sl_calloc(m->nf, 1);
    for (int32_t v = 0; v < m->nv; v++) {
        image[v] = vertex != NULL ? vertex[m->input_vertex[v]] : -1;
    }
    for (int32_t f = 0; f < m->nf; f++) {
        const int32_t g = sl_symmetry_image(m, s, map, f);
        assert_int_equal(used[g]++, 0);
        assert_int_equal(s->unit[g], s->unit[sl_symmetry_image(m, s, map, s->unit[f])]);
        int32_t inside = 0;
        for (int32_t h = m->face_first[f]; h < m->face_first[f + 1]; h++) {
            const int32_t to = sl_symmetry_image_corner(m, s, map, h), w = m->input_vertex[m->origin[to]];
            bool has = false;
            for (int32_t k = m->face_first[g]; k < m->face_first[g + 1]; k++) {
                has = has || m->input_vertex[m->origin[k]] == w;
            }
            assert_true(image[m->origin[h]] < 0 || image[m->origin[h]] == w);
            image[m->origin[h]] = w;
            assert_int_equal(s->unit[m->face[to]], s->unit[g]);
            assert_true(!has || m->face[to] == g);
            inside += m->face[to] == g;
        }
        assert_true(inside >= 2);
    }
    sl_free(image);
    sl_free(used);
}

static void mirrors_of_quads_are_found_whichever_way_diagonals_run(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xd1a6);
    int32_t crossed = 0;
    for (int trial = 0; trial < 30 * test_multiplier(); trial++) {
        const bool straddle = trial % 2 == 1;
        int32_t mirror[1000], vertex[1000], image[1000];
        model quads = model_new();
        model_planted(&quads, &rng, 3 + test_index(&rng, 5), 9 + test_index(&rng, 5), straddle, true, mirror);
        model m = triangulate(&quads, &rng);
        model_relabel(&m, &rng, 2, NULL, vertex);
        for (int32_t v = 0; v < m.nv; v++) {
            image[vertex[v]] = vertex[mirror[v]];
        }
        sl_mesh *mesh = model_build(&m);
        int32_t *partner = neighbours_are_partners(m.nf), exact = 0;
        sl_symmetry *s = find_all(mesh, partner, 64);
        for (int32_t i = 0; i < s->nmap; i++) {
            check_pair_map(mesh, s, &s->map[i], s->map[i].kind == SL_SYMMETRY_EXACT ? image : NULL);
            if (s->map[i].kind != SL_SYMMETRY_EXACT) {
                continue;
            }
            exact++;
            assert_true(s->map[i].reverses && s->map[i].order == 2 && s->map[i].separates);
            int32_t axis = 0;
            uint8_t *side = sl_alloc(m.nf, 1);
            assert_int_equal(sl_symmetry_sides(mesh, s, &s->map[i], side), SL_OK);
            for (int32_t f = 0; f < m.nf; f++) {
                const int32_t g = sl_symmetry_image(mesh, s, &s->map[i], f);
                assert_int_equal(sl_symmetry_image(mesh, s, &s->map[i], g), f);
                assert_true(f == g ? side[f] == 1 : side[f] + side[g] == 1);
                for (int32_t h = mesh->face_first[f]; h < mesh->face_first[f + 1]; h++) {
                    const int32_t a = mesh->input_vertex[mesh->origin[h]], t = mesh->twin[h];
                    const int32_t b = mesh->input_vertex[mesh->origin[sl_next(mesh, h)]];
                    const bool on_plane = image[a] == a && image[b] == b && t >= 0;
                    assert_int_equal(sl_symmetry_on_axis(mesh, s, &s->map[i], h), on_plane);
                    if (on_plane) { /* facets that meet on the axis are images of each other */
                        assert_int_equal(mesh->face[t], g);
                        axis += h < t;
                    }
                    const int32_t c = sl_symmetry_image_corner(mesh, s, &s->map[i], h);
                    crossed += mesh->face[c] != g;
                }
            }
            assert_int_equal(s->map[i].axis_edges, axis);
            assert_int_equal(s->map[i].fixed_facets > 0, straddle);
            sl_free(side);
        }
        assert_int_equal(exact, 1);
        sl_symmetry_free(s);
        s = find_all(mesh, NULL, 64);
        for (int32_t i = 0; i < s->nmap; i++) {
            assert_true(s->map[i].kind != SL_SYMMETRY_EXACT);
        }
        sl_symmetry_free(s);
        sl_free(partner);
        sl_mesh_free(mesh);
        model_free(&m);
        model_free(&quads);
    }
    assert_true(crossed > 0);
}

/* A kite: the plane along its diagonal, or across it. */
static void a_pair_on_the_plane_is_cut_where_its_diagonal_lies_there(void **state)
{
    (void)state;
    for (int across = 0; across < 2; across++) {
        model m = model_new();
        const int32_t a = model_vertex(&m, 0, 0, 0), b = model_vertex(&m, 1, 1, 0.3), c = model_vertex(&m, 0, 3, 0);
        const int32_t d = model_vertex(&m, -1, 1, 0.3);
        model_triangle(&m, across ? d : a, across ? a : b, across ? b : c);
        model_triangle(&m, across ? d : a, across ? b : c, across ? c : d);
        sl_mesh *mesh = model_build(&m);
        int32_t *partner = neighbours_are_partners(2);
        sl_symmetry *s = find_all(mesh, partner, 64);
        assert_int_equal(s->nmap, 7); /* those of a square */
        const sl_symmetry_map *map = &s->map[0];
        assert_int_equal(map->kind, SL_SYMMETRY_EXACT);
        check_pair_map(mesh, s, map, (const int32_t[4]){a, d, c, b});
        assert_int_equal(map->fixed_facets, across ? 2 : 0);
        assert_int_equal(map->axis_edges, across ? 0 : 1);
        assert_int_equal(map->separates, !across);
        for (int32_t i = 0; i < s->nmap; i++) {
            check_pair_map(mesh, s, &s->map[i], NULL);
        }
        sl_symmetry_free(s);
        sl_free(partner);
        sl_mesh_free(mesh);
        model_free(&m);
    }
}

static void groups_of_paired_boxes_are_those_of_boxes(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xb0c5);
    model quads = model_new();
    model_box(&quads, 3, 3, 3);
    model m = triangulate(&quads, &rng);
    model_relabel(&m, &rng, 2, NULL, NULL);
    sl_mesh *mesh = model_build(&m);
    int32_t *partner = neighbours_are_partners(m.nf);
    sl_symmetry *s = find_all(mesh, partner, 64);
    assert_int_equal(s->nmap, 47);
    for (int32_t i = 0; i < s->nmap; i++) {
        assert_int_equal(s->map[i].kind, SL_SYMMETRY_EXACT);
        check_pair_map(mesh, s, &s->map[i], NULL);
    }
    sl_symmetry_free(s);
    sl_free(partner);
    sl_mesh_free(mesh);
    model_free(&m);
    model_free(&quads);
}

/* A quad is no pair: strips with a pair at one end and quads elsewhere. */
static void pairs_do_not_go_to_quads(void **state)
{
    (void)state;
    for (int n = 2; n < 14; n++) {
        int32_t partner[20];
        model m = model_new();
        for (int i = 0; i <= n; i++) {
            model_vertex(&m, i, 0, 0.1 * i * (n - i));
            model_vertex(&m, i, 1.5, 0.1 * i * (n - i));
        }
        model_triangle(&m, 0, 2, 3);
        model_triangle(&m, 0, 3, 1);
        for (int i = 1; i < n; i++) {
            model_quad(&m, 2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1);
        }
        for (int f = 0; f < n + 1; f++) {
            partner[f] = f < 2 ? 1 - f : f % 3 == 0 ? -1 : f % 3 == 1 ? f : 99;
        }
        sl_mesh *mesh = model_build(&m);
        sl_symmetry *s = find_all(mesh, partner, 64);
        assert_int_equal(s->nmap, 1); /* across, not along */
        assert_int_equal(s->map[0].fixed_facets, n + 1);
        sl_symmetry_free(s);
        sl_mesh_free(mesh);
        model_free(&m);
    }
}

/* A triangle with three arms: a quad, a pair, two quads. */
static void arms_of_a_pair_and_of_a_quad_are_not_exchanged(void **state)
{
    (void)state;
    for (int paired = 0; paired < 3; paired++) { /* none, one, both of the short arms */
        int32_t partner[8];
        model m = model_new();
        for (int k = 0; k < 3; k++) {
            model_vertex(&m, cos(2.0 * k * TEST_PI / 3.0), sin(2.0 * k * TEST_PI / 3.0), 0.1 * k);
        }
        model_triangle(&m, 0, 1, 2);
        partner[0] = -1;
        for (int k = 0; k < 3; k++) {
            const int32_t a = k, b = (k + 1) % 3, c = model_vertex(&m, k, 5.0, 0), d = model_vertex(&m, k, 6.0, 0.2);
            if (k < paired) {
                partner[m.nf] = m.nf + 1;
                partner[m.nf + 1] = m.nf;
                model_triangle(&m, b, a, c);
                model_triangle(&m, b, c, d);
            } else {
                partner[m.nf] = -1;
                model_quad(&m, b, a, c, d);
            }
            if (k == 2) {
                partner[m.nf] = -1;
                model_quad(&m, d, c, model_vertex(&m, 2, 8, 0), model_vertex(&m, 3, 8, 0));
            }
        }
        sl_mesh *mesh = model_build(&m);
        sl_symmetry *s = find_all(mesh, partner, 64);
        assert_int_equal(s->nmap, paired == 1 ? 0 : 1);
        sl_symmetry_free(s);
        sl_mesh_free(mesh);
        model_free(&m);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mirrors_of_quads_are_found_whichever_way_diagonals_run),
        cmocka_unit_test(a_pair_on_the_plane_is_cut_where_its_diagonal_lies_there),
        cmocka_unit_test(groups_of_paired_boxes_are_those_of_boxes),
        cmocka_unit_test(pairs_do_not_go_to_quads),
        cmocka_unit_test(arms_of_a_pair_and_of_a_quad_are_not_exchanged),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
