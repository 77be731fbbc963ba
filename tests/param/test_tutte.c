/* Tutte's embedding: the exact certificate, the equations it solves, its border, its errors. */
#include "param/tutte.h"

#include "geom/vec3.h"
#include "param/stretch_charts.h"

static const sl_tutte_weights both[] = {SL_TUTTE_UNIFORM, SL_TUTTE_COTANGENT};

static double *embed(const sl_patch *patch, sl_tutte_weights weights)
{
    double *uv = malloc(2 * (size_t)patch->nv * sizeof *uv);
    assert_int_equal(sl_tutte(patch, weights, NULL, uv), SL_OK);
    return uv;
}

/* Interior edges between two border vertices: what an embedding with a border of three straight sides would fold. */
static int32_t count_chords(const sl_patch *patch)
{
    int32_t chords = 0;
    for (int32_t h = 0; h < 3 * patch->nt; h++) {
        chords += patch->twin[h] > h && patch->border[patch->tri[h]] && patch->border[patch->tri[sl_corner_next(h)]];
    }
    return chords;
}

static void random_disks_with_chords_are_embedded(void **state)
{
    (void)state;
    int32_t chords = 0, interior = 0;
    for (int trial = 0; trial < 150 * test_multiplier(); trial++) {
        sl_patch *patch = disk_random(5 + trial % 60, 0x7077e + (uint64_t)trial);
        for (int w = 0; w < 2; w++) {
            double *uv = embed(patch, both[w]);
            const sl_certificate c = chart_certify(patch, uv);
            assert_true(c.embedded && c.flipped == 0 && c.degenerate == 0);
            free(uv);
        }
        chords += count_chords(patch);
        interior += chart_interior(patch);
        sl_patch_free(patch);
    }
    assert_true(chords > 300 && interior > 300);
}

/* Without weights in the test: a vertex of uniform weights is the mean of its neighbours. */
static void interior_vertices_are_means_of_their_neighbours(void **state)
{
    (void)state;
    sl_patch *patch = chart_grid(9, 6, 0.3, chart_bumps, 1.1, 0x3a);
    double *uv = embed(patch, SL_TUTTE_UNIFORM), *sum = calloc(2 * (size_t)patch->nv, sizeof *sum);
    int32_t *degree = calloc((size_t)patch->nv, sizeof *degree);
    for (int32_t h = 0; h < 3 * patch->nt; h++) { /* each neighbour of an interior vertex once */
        const int32_t v = patch->tri[h], w = patch->tri[sl_corner_next(h)];
        sum[2 * v] += uv[2 * w];
        sum[2 * v + 1] += uv[2 * w + 1];
        degree[v]++;
    }
    for (int32_t v = 0; v < patch->nv; v++) {
        for (int k = 0; k < 2 && patch->border[v] == 0; k++) {
            assert_true(test_near(sum[2 * v + k] / degree[v], uv[2 * v + k], 64 * TEST_EPS));
        }
    }
    free(uv);
    free(sum);
    free(degree);
    sl_patch_free(patch);
}

/* Triangle by triangle, with cotangents from the law of cosines; none of them is in reach of the clamps. */
static void cotangent_weights_solve_the_laplace_equation_of_the_surface(void **state)
{
    (void)state;
    sl_patch *patch = chart_hexagon(5, 0.08, chart_bumps, 0.4, 0xc07);
    double *uv = embed(patch, SL_TUTTE_COTANGENT), *force = calloc(2 * (size_t)patch->nv, sizeof *force);
    for (int32_t c = 0; c < 3 * patch->nt; c++) {
        const int32_t o = patch->tri[c], v = patch->tri[sl_corner_next(c)], w = patch->tri[sl_corner_prev(c)];
        const double b = sl_vec3_distance(&patch->xyz[3 * o], &patch->xyz[3 * v]);
        const double a = sl_vec3_distance(&patch->xyz[3 * v], &patch->xyz[3 * w]);
        const double d = sl_vec3_distance(&patch->xyz[3 * o], &patch->xyz[3 * w]);
        const double angle = acos((b * b + d * d - a * a) / (2.0 * b * d)), cot = cos(angle) / sin(angle);
        assert_true(cot > 0.06 && cot < 19.0);
        for (int k = 0; k < 2; k++) {
            force[2 * v + k] += cot * (uv[2 * w + k] - uv[2 * v + k]);
            force[2 * w + k] += cot * (uv[2 * v + k] - uv[2 * w + k]);
        }
    }
    for (int32_t v = 0; v < patch->nv; v++) {
        for (int k = 0; k < 2 && patch->border[v] == 0; k++) {
            assert_true(test_near(force[2 * v + k], 0.0, 1e-13));
        }
    }
    free(uv);
    free(force);
    sl_patch_free(patch);
}

static void border_lies_on_a_circle_at_its_arc_length(void **state)
{
    (void)state;
    sl_patch *patch = chart_grid(6, 8, 0.25, chart_bumps, 0.9, 0xa7c);
    double *uv = embed(patch, SL_TUTTE_UNIFORM), length = 0.0;
    int32_t *first = NULL, *halfedge = NULL;
    assert_int_equal(sl_patch_border(patch, &first, &halfedge), SL_OK);
    for (int32_t b = 0; b < first[1]; b++) {
        const int32_t v = patch->tri[halfedge[b]], w = patch->tri[sl_corner_next(halfedge[b])];
        length += sl_vec3_distance(&patch->xyz[3 * v], &patch->xyz[3 * w]);
    }
    const double radius = hypot(uv[2 * patch->tri[halfedge[0]]], uv[2 * patch->tri[halfedge[0]] + 1]);
    for (int32_t b = 0; b < first[1]; b++) {
        const int32_t v = patch->tri[halfedge[b]], w = patch->tri[sl_corner_next(halfedge[b])];
        const double share = sl_vec3_distance(&patch->xyz[3 * v], &patch->xyz[3 * w]) / length;
        const double chord = hypot(uv[2 * v] - uv[2 * w], uv[2 * v + 1] - uv[2 * w + 1]);
        assert_true(test_near(hypot(uv[2 * v], uv[2 * v + 1]), radius, 1e-14));
        assert_true(test_near(chord, 2.0 * radius * sin(TEST_PI * share), 1e-13));
    }
    assert_true(test_near_rel(chart_uv_area(patch, uv), chart_area(patch), 1e-13));
    free(uv);
    free(first);
    free(halfedge);
    sl_patch_free(patch);
}

/* Border vertices on one point of space must not fall on one point of the plane. */
static void border_edges_of_no_length_keep_their_ends_apart(void **state)
{
    (void)state;
    sl_patch *patch = chart_grid(6, 6, 0.2, chart_bumps, 0.5, 0x0e);
    int32_t *first = NULL, *halfedge = NULL;
    assert_int_equal(sl_patch_border(patch, &first, &halfedge), SL_OK);
    for (int32_t b = 3; b < 11; b++) { /* eight border vertices gathered in one point */
        memcpy(&patch->xyz[3 * patch->tri[halfedge[b]]], &patch->xyz[3 * patch->tri[halfedge[2]]], 3 * sizeof(double));
    }
    for (int w = 0; w < 2; w++) {
        double *uv = embed(patch, both[w]);
        assert_true(chart_certify(patch, uv).embedded);
        free(uv);
    }
    memset(patch->xyz, 0, 3 * (size_t)patch->nv * sizeof *patch->xyz); /* no shape at all: still an embedding */
    double *uv = embed(patch, SL_TUTTE_COTANGENT);
    assert_true(chart_certify(patch, uv).embedded);
    free(uv);
    free(first);
    free(halfedge);
    sl_patch_free(patch);
}

static bool patch_edge_is(const sl_patch *patch, int32_t h, int32_t a, int32_t b)
{
    const int32_t v = patch->tri[h], w = patch->tri[sl_corner_next(h)];
    return (v == a && w == b) || (v == b && w == a);
}

static void what_is_not_a_disk_is_infeasible(void **state)
{
    (void)state;
    sl_patch *ring = chart_ring(7);
    double uv[2 * 14];
    for (int i = 0; i < 28; i++) {
        uv[i] = 0.25 * i;
    }
    assert_false(sl_patch_is_disk(ring));
    assert_int_equal(sl_tutte(ring, SL_TUTTE_UNIFORM, NULL, uv), SL_INFEASIBLE);
    assert_true(uv[0] == 0.0 && uv[27] == 6.75);
    sl_patch_free(ring);
    /* Two triangles glued along two edges, opened at the third: a disk with a border of two edges. */
    const double xyz[9] = {0, 0, 0, 1, 0.1, 0, 0.3, 0.8, 0.2};
    sl_patch *pillow = chart_make(3, xyz, 2, (int32_t[]){0, 1, 2, 1, 0, 2});
    for (int32_t h = 0; h < 6; h++) {
        if (patch_edge_is(pillow, h, 0, 1)) {
            pillow->twin[h] = -1;
            pillow->outgoing[pillow->tri[h]] = h;
            pillow->border[pillow->tri[h]] = 1;
        }
    }
    pillow->loops = 1;
    pillow->euler = 1;
    assert_int_equal(sl_tutte(pillow, SL_TUTTE_UNIFORM, NULL, uv), SL_INFEASIBLE);
    sl_patch_free(pillow);
}

static void tutte_can_be_cancelled(void **state)
{
    (void)state;
    sl_patch *patch = chart_grid(4, 4, 0.2, chart_bumps, 0.5, 0xca);
    double *uv = calloc(2 * (size_t)patch->nv, sizeof *uv);
    for (int calls = 0; calls < 2; calls++) {
        int left = calls;
        const sl_context context = {.progress = chart_cancel_after, .progress_user = &left};
        assert_int_equal(sl_tutte(patch, SL_TUTTE_UNIFORM, &context, uv), SL_CANCELLED);
        for (int32_t i = 0; i < 2 * patch->nv; i++) {
            assert_true(uv[i] == 0.0);
        }
    }
    free(uv);
    sl_patch_free(patch);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_disks_with_chords_are_embedded),
        cmocka_unit_test(interior_vertices_are_means_of_their_neighbours),
        cmocka_unit_test(cotangent_weights_solve_the_laplace_equation_of_the_surface),
        cmocka_unit_test(border_lies_on_a_circle_at_its_arc_length),
        cmocka_unit_test(border_edges_of_no_length_keep_their_ends_apart),
        cmocka_unit_test(what_is_not_a_disk_is_infeasible),
        cmocka_unit_test(tutte_can_be_cancelled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
