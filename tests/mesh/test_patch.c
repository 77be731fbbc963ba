#include "mesh/patch.h"

#include "base/memory.h"
#include "mesh/chart_check.h"
#include "mesh/topology.h"

static soup s;
static int32_t faces[SOUP_FACES];

static void check_vertices(const sl_patch *p)
{
    int32_t next = 0;
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        assert_in_range(p->tri[c], 0, next); /* numbered by first corner */
        next += p->tri[c] == next;
    }
    assert_int_equal(next, p->nv);
    for (int32_t v = 0; v < p->nv; v++) {
        const int32_t out = p->outgoing[v];
        assert_int_equal(p->tri[out], v);
        assert_int_equal(p->border[v], p->twin[out] < 0);
        /* One fan: turning from the outgoing halfedge meets every corner of the vertex once. */
        int32_t corners = 0, met = 0;
        for (int32_t c = 0; c < 3 * p->nt; c++) {
            corners += p->tri[c] == v;
        }
        for (int32_t c = out; c >= 0 && met <= corners;) {
            assert_int_equal(p->tri[c], v);
            met++;
            c = p->twin[sl_corner_prev(c)];
            c = c == out ? -1 : c;
        }
        assert_int_equal(met, corners);
    }
}

/* Euler number, twins and the border by counting. */
static void check_patch(const sl_patch *p)
{
    int32_t borders = 0;
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        const int32_t t = p->twin[c];
        borders += t < 0;
        assert_true(t < 0 || (p->twin[t] == c && t != c && p->tri[t] == p->tri[sl_corner_next(c)] &&
                              p->tri[c] == p->tri[sl_corner_next(t)]));
    }
    assert_int_equal(p->euler, p->nv - (3 * p->nt + borders) / 2 + p->nt);
    check_vertices(p);
    int32_t *first = NULL, *run = NULL, runs = 0;
    assert_int_equal(sl_patch_border(p, &first, &run), SL_OK);
    assert_int_equal(first[0], 0);
    assert_int_equal(first[p->loops], borders);
    for (int32_t l = 0; l < p->loops; l++) {
        assert_true(first[l + 1] > first[l]);
        for (int32_t i = first[l]; i < first[l + 1]; i++, runs++) {
            const int32_t follower = run[i + 1 < first[l + 1] ? i + 1 : first[l]];
            assert_true(p->twin[run[i]] < 0);
            assert_int_equal(p->tri[sl_corner_next(run[i])], p->tri[follower]);
            for (int32_t j = 0; j < i; j++) {
                assert_int_not_equal(run[i], run[j]);
            }
        }
    }
    assert_int_equal(runs, borders);
    int32_t *edge = NULL, edges = -1;
    assert_int_equal(sl_patch_border_edges(p, &edges, &edge), SL_OK);
    assert_int_equal(edges, borders);
    for (int32_t i = 0; i < edges; i++) {
        assert_int_equal(edge[2 * i], p->tri[run[i]]);
        assert_int_equal(edge[2 * i + 1], p->tri[sl_corner_next(run[i])]);
    }
    sl_free(edge);
    sl_free(first);
    sl_free(run);
}

static void check_against_mesh(const sl_mesh *m, const sl_triangulation *t, int32_t n, const sl_patch *p)
{
    int32_t c = 0;
    for (int32_t i = 0; i < n; i++) {
        for (int32_t q = 3 * t->first[faces[i]]; q < 3 * t->first[faces[i] + 1]; q++, c++) {
            assert_int_equal(p->corner[c], t->corner[q]);
            assert_int_equal(p->facet[c / 3], faces[i]);
            for (int k = 0; k < 3; k++) {
                assert_true(p->xyz[3 * p->tri[c] + k] == m->xyz[3 * m->origin[t->corner[q]] + k]);
            }
            /* Glued as the mesh is: over a twin inside the set, or a diagonal. */
            const int32_t h = p->corner[c], g = p->twin[c];
            const bool edge = p->corner[sl_corner_next(c)] == sl_next(m, h);
            if (edge) {
                const bool in = m->twin[h] >= 0 && inside(faces, n, m->face[m->twin[h]]);
                assert_int_equal(g >= 0 ? p->corner[g] : -1, in ? m->twin[h] : -1);
            } else {
                assert_true(g >= 0 && p->facet[g / 3] == p->facet[c / 3]);
                assert_int_equal(p->corner[g], p->corner[sl_corner_next(c)]);
            }
        }
    }
    assert_int_equal(c, 3 * p->nt);
}

static void patches_of_random_sets_have_the_topology_of_the_set(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x9a7c);
    int32_t disks = 0;
    for (int trial = 0; trial < 60 * test_multiplier(); trial++) {
        soup_grid(&s, &rng, (soup_surface)test_index(&rng, 5), 3 + test_index(&rng, 5), 3 + test_index(&rng, 4), 0.4);
        soup_scramble(&s, &rng, 0.2);
        sl_mesh *m = soup_build(&s, NULL);
        for (int32_t k = 0; k < test_index(&rng, 30); k++) {
            sl_mesh_cut_edge(m, test_index(&rng, m->nh));
        }
        sl_triangulation *t = NULL;
        assert_int_equal(sl_triangulation_create(m, &t), SL_OK);
        const int32_t n = grow_set(m, &rng, 1 + test_index(&rng, m->nf), faces);
        sl_patch *p = NULL;
        assert_int_equal(sl_patch_extract(m, t, faces, n, &p), SL_OK);
        check_patch(p);
        check_against_mesh(m, t, n, p);
        sl_topology topology;
        assert_int_equal(sl_mesh_topology(m, faces, n, &topology), SL_OK);
        assert_int_equal(p->euler, topology.euler);
        assert_int_equal(p->loops, topology.loops);
        assert_int_equal(p->nv, topology.vertices);
        assert_int_equal(sl_patch_is_disk(p), topology.genus == 0 && topology.loops == 1);
        disks += sl_patch_is_disk(p);
        sl_patch_free(p);
        sl_triangulation_free(t);
        sl_mesh_free(m);
    }
    assert_true(disks > 5);
}

static void patches_of_dirt_are_consistent(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xd127);
    for (int trial = 0; trial < 150 * test_multiplier(); trial++) {
        soup_random(&s, &rng, 6 + test_index(&rng, 8), 1 + test_index(&rng, 25));
        sl_mesh *m = soup_build(&s, NULL);
        sl_triangulation *t = NULL;
        assert_int_equal(sl_triangulation_create(m, &t), SL_OK);
        for (int32_t f = 0; f < m->nf; f++) {
            faces[f] = f;
        }
        sl_patch *p = NULL;
        assert_int_equal(sl_patch_extract(m, t, faces, m->nf, &p), SL_OK);
        check_patch(p);
        check_against_mesh(m, t, m->nf, p);
        const counts c = count_set(m, faces, m->nf);
        assert_int_equal(p->nv, c.vertices);
        assert_int_equal(p->loops, c.loops);
        assert_int_equal(p->euler, c.vertices - c.edges + c.faces);
        sl_patch_free(p);
        sl_triangulation_free(t);
        sl_mesh_free(m);
    }
}

static void triangles_make_the_patch_that_the_mesh_makes(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x3a7);
    for (int trial = 0; trial < 20 * test_multiplier(); trial++) {
        soup_grid(&s, &rng, (soup_surface)test_index(&rng, 3), 3 + test_index(&rng, 6), 3 + test_index(&rng, 4), 1.0);
        sl_patch *p = NULL, *q = NULL;
        assert_int_equal(sl_patch_from_triangles(s.nv, s.xyz, s.nf, s.index, &p), SL_OK);
        check_patch(p);
        sl_mesh *m = soup_build(&s, NULL);
        sl_triangulation *t = NULL;
        assert_int_equal(sl_triangulation_create(m, &t), SL_OK);
        for (int32_t f = 0; f < m->nf; f++) {
            faces[f] = f;
        }
        assert_int_equal(sl_patch_extract(m, t, faces, m->nf, &q), SL_OK);
        assert_int_equal(p->nv, q->nv);
        assert_int_equal(p->euler, q->euler);
        assert_int_equal(p->loops, q->loops);
        assert_memory_equal(p->tri, q->tri, 3 * (size_t)p->nt * sizeof *p->tri);
        assert_memory_equal(p->twin, q->twin, 3 * (size_t)p->nt * sizeof *p->twin);
        for (int32_t c = 0; c < 3 * p->nt; c++) {
            assert_int_equal(p->corner[c], c);
            assert_int_equal(p->facet[c / 3], c / 3);
            for (int k = 0; k < 3; k++) {
                assert_true(p->xyz[3 * p->tri[c] + k] == s.xyz[3 * s.index[c] + k]);
            }
        }
        sl_patch_free(p);
        sl_patch_free(q);
        sl_triangulation_free(t);
        sl_mesh_free(m);
    }
}

static void a_bowtie_of_triangles_is_split(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xb0);
    soup_clear(&s);
    soup_random_vertices(&s, &rng, 6);
    const int32_t tri[6] = {4, 1, 2, 3, 4, 0};
    sl_patch *p = NULL;
    assert_int_equal(sl_patch_from_triangles(s.nv, s.xyz, 2, tri, &p), SL_OK);
    check_patch(p);
    assert_int_equal(p->nv, 6);
    assert_int_equal(p->loops, 2);
    assert_int_equal(p->euler, 2);
    assert_false(sl_patch_is_disk(p));
    sl_patch_free(p);
    sl_patch_free(NULL);
}

static void wrong_triangles_are_refused(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xbad);
    soup_clear(&s);
    soup_random_vertices(&s, &rng, 6);
    static const int32_t wrong[][9] = {
        {0, 1, 2, 0, 1, 3, 3, 4, 5},                               /* an edge twice in one direction */
        {0, 1, 2, 1, 0, 3, 1, 0, 4},                               /* three triangles on an edge */
        {0, 1, 2, 3, 4, 6, 2, 1, 5},                               /* out of range */
        {0, 1, 2, 3, 4, -1, 2, 1, 5}, {0, 1, 2, 3, 3, 4, 2, 1, 5}, /* a corner repeated */
    };
    for (size_t k = 0; k < SL_COUNTOF(wrong); k++) {
        sl_patch *p = NULL;
        assert_int_equal(sl_patch_from_triangles(6, s.xyz, 3, wrong[k], &p), SL_BAD_INPUT);
        assert_null(p);
    }
}

/* Oracle: Heron. */
static void triangle_areas_agree_with_heron(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x4e60);
    soup_grid(&s, &rng, SOUP_SHEET, 4, 5, 1.0);
    sl_patch *p = NULL;
    assert_int_equal(sl_patch_from_triangles(s.nv, s.xyz, s.nf, s.index, &p), SL_OK);
    for (int32_t t = 0; t < p->nt; t++) {
        double side[3], half = 0.0;
        for (int k = 0; k < 3; k++) {
            const double *a = s.xyz + 3 * s.index[3 * t + k], *b = s.xyz + 3 * s.index[3 * t + (k + 1) % 3];
            side[k] = sqrt(pow(a[0] - b[0], 2) + pow(a[1] - b[1], 2) + pow(a[2] - b[2], 2));
            half += 0.5 * side[k];
        }
        const double heron = sqrt(half * (half - side[0]) * (half - side[1]) * (half - side[2]));
        assert_true(test_near(sl_patch_triangle_area(p, t), heron, 1e-12));
    }
    sl_patch_free(p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(patches_of_random_sets_have_the_topology_of_the_set),
        cmocka_unit_test(patches_of_dirt_are_consistent),
        cmocka_unit_test(triangles_make_the_patch_that_the_mesh_makes),
        cmocka_unit_test(a_bowtie_of_triangles_is_split),
        cmocka_unit_test(wrong_triangles_are_refused),
        cmocka_unit_test(triangle_areas_agree_with_heron),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
