/* Maps with a few flipped triangles made flip-free, and unfolding from a guess. */
#include "param/stretch_levels_internal.h"

#include "base/memory.h"
#include "geom/predicates.h"
#include "overlap/certificate.h"
#include "param/stretch.h"
#include "param/stretch_charts.h"

#include <math.h>
#include <string.h>

static int32_t count_flipped(const sl_patch *p, const double *uv)
{
    int32_t n = 0;
    for (int32_t t = 0; t < p->nt; t++) {
        n += sl_orient2d(uv + 2 * p->tri[3 * t], uv + 2 * p->tri[3 * t + 1], uv + 2 * p->tri[3 * t + 2]) <= 0;
    }
    return n;
}

static int32_t count_crossings(const sl_patch *p, const double *uv)
{
    sl_certificate c;
    int32_t *border = malloc(2 * sizeof *border * (size_t)p->nv), nb = 0;
    for (int32_t h = 0; h < 3 * p->nt; h++) {
        if (p->twin[h] < 0) {
            border[2 * nb] = p->tri[h];
            border[2 * nb++ + 1] = p->tri[sl_corner_next(h)];
        }
    }
    assert_int_equal(sl_certify_embedding(uv, 0, p->tri, nb, border, &c), SL_OK);
    free(border);
    return c.border_crossings;
}

/* A bumpy chart and its minimum. */
static sl_patch *chart_and_map(int trial, double **uv, sl_stretch_info *info)
{
    sl_patch *p = chart_hexagon(9 + trial % 4, 0.2, chart_bumps, 0.8, 0x3e9d + (uint64_t)trial);
    const sl_stretch_def def = sl_stretch_default();
    *uv = malloc(2 * sizeof **uv * (size_t)p->nv);
    assert_int_equal(sl_stretch_unfold(p, &def, NULL, *uv, info), SL_OK);
    return p;
}

/* Moves a few vertices by about two edges. */
static void disturb(const sl_patch *p, test_rng *rng, bool inner, int count, double *uv)
{
    for (int k = 0; k < count;) {
        const int32_t v = (int32_t)test_uniform(rng, 0.0, p->nv);
        if ((p->border[v] == 0) == inner) {
            const int32_t w = p->tri[sl_corner_next(p->outgoing[v])];
            for (int j = 0; j < 2; j++) {
                uv[2 * v + j] += test_uniform(rng, 1.2, 2.0) * (uv[2 * w + j] - uv[2 * v + j]);
            }
            k++;
        }
    }
}

static void flips_are_mended_and_a_map_without_stays(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x3e9d);
    for (int trial = 0; trial < 20 * test_multiplier(); trial++) {
        double *uv;
        bool mended = false;
        sl_patch *p = chart_and_map(trial, &uv, NULL);
        double *copy = malloc(2 * sizeof *copy * (size_t)p->nv);
        memcpy(copy, uv, 2 * sizeof *uv * (size_t)p->nv);
        assert_int_equal(sl_stretch_mend(p, true, uv, &mended), SL_OK);
        assert_true(mended && memcmp(copy, uv, 2 * sizeof *uv * (size_t)p->nv) == 0);
        disturb(p, &rng, true, 4, uv);
        assert_true(count_flipped(p, uv) > 0);
        assert_int_equal(sl_stretch_mend(p, true, uv, &mended), SL_OK);
        assert_true(mended && count_flipped(p, uv) == 0 && count_crossings(p, uv) == 0);
        free(copy);
        free(uv);
        sl_patch_free(p);
    }
}

static void borders_that_cross_are_parted(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xb04d);
    int32_t crossed = 0, parted = 0;
    for (int trial = 0; trial < 30 * test_multiplier(); trial++) {
        double *uv;
        bool mended = false;
        sl_patch *p = chart_and_map(trial, &uv, NULL);
        disturb(p, &rng, false, 2, uv);
        const bool crosses = count_crossings(p, uv) > 0;
        assert_int_equal(sl_stretch_mend(p, true, uv, &mended), SL_OK);
        assert_true(!mended || (count_flipped(p, uv) == 0 && count_crossings(p, uv) == 0));
        crossed += crosses;
        parted += crosses && mended;
        free(uv);
        sl_patch_free(p);
    }
    assert_true(crossed > 0 && 2 * parted > crossed);
}

enum { ALONG = 60, ACROSS = 5 };

/* A strip whose ends meet in the plane: bent a little beyond a whole turn, no triangle flipped. */
static void ends_that_meet_are_parted(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xe9d5);
    for (int trial = 0; trial < 20 * test_multiplier(); trial++) {
        double xyz[3 * ALONG * ACROSS], uv[2 * ALONG * ACROSS];
        int32_t tri[6 * (ALONG - 1) * (ACROSS - 1)], nt = 0;
        const double turn = 2.0 * acos(-1.0) + test_uniform(&rng, 0.002, 0.02);
        for (int32_t i = 0; i < ALONG; i++) {
            for (int32_t j = 0; j < ACROSS; j++) {
                const int32_t v = i * ACROSS + j;
                const double r = 1.5 - 0.1 * j + test_uniform(&rng, 0.0, 0.02), a = turn * i / (ALONG - 1);
                xyz[3 * v] = uv[2 * v] = r * cos(a);
                xyz[3 * v + 1] = uv[2 * v + 1] = r * sin(a);
                xyz[3 * v + 2] = 0.3 * a;
                if (i > 0 && j > 0) {
                    const int32_t quad[6] = {v - ACROSS, v, v - 1, v - ACROSS, v - 1, v - ACROSS - 1};
                    memcpy(tri + 3 * nt, quad, sizeof quad);
                    nt += 2;
                }
            }
        }
        for (int32_t c = 0; c < 3 * nt; c += 3) { /* counter-clockwise */
            if (sl_orient2d(uv + 2 * tri[c], uv + 2 * tri[c + 1], uv + 2 * tri[c + 2]) < 0) {
                const int32_t swap = tri[c + 1];
                tri[c + 1] = tri[c + 2];
                tri[c + 2] = swap;
            }
        }
        sl_patch *p = chart_make(ALONG * ACROSS, xyz, nt, tri);
        double place[2 * ALONG * ACROSS];
        for (int32_t c = 0; c < 3 * nt; c++) {
            memcpy(place + 2 * p->tri[c], uv + 2 * tri[c], 2 * sizeof *uv);
        }
        bool mended = false;
        assert_true(count_flipped(p, place) == 0 && count_crossings(p, place) > 0);
        assert_int_equal(sl_stretch_mend(p, true, place, &mended), SL_OK);
        assert_true(mended && count_flipped(p, place) == 0 && count_crossings(p, place) == 0);
        sl_patch_free(p);
    }
}

static void unfolding_from_a_guess_ends_in_the_same_minimum(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x60e5);
    for (int trial = 0; trial < 10 * test_multiplier(); trial++) {
        double *uv;
        sl_stretch_info from_nothing, guessed, senseless;
        sl_stretch_def def = sl_stretch_default();
        sl_patch *p = chart_and_map(trial, &uv, &from_nothing);
        double *guess = malloc(2 * sizeof *guess * (size_t)p->nv);
        memcpy(guess, uv, 2 * sizeof *uv * (size_t)p->nv);
        disturb(p, &rng, true, 3, guess);
        def.guess = guess;
        assert_int_equal(sl_stretch_unfold(p, &def, NULL, uv, &guessed), SL_OK);
        assert_true(guessed.levels == 0 && count_flipped(p, uv) == 0);
        assert_true(test_near(guessed.energy_after, from_nothing.energy_after, 2e-3));
        for (int32_t i = 0; i < 2 * p->nv; i++) {
            guess[i] = test_uniform(&rng, -1.0, 1.0);
        }
        assert_int_equal(sl_stretch_unfold(p, &def, NULL, uv, &senseless), SL_OK);
        assert_true(count_flipped(p, uv) == 0 && test_near(senseless.energy_after, from_nothing.energy_after, 2e-3));
        free(guess);
        free(uv);
        sl_patch_free(p);
    }
}

/* What sl_stretch_settle_all does, with every interior vertex looked at in each sweep. */
static int32_t settle_plainly(const sl_patch *p, double w, double limit, double *uv)
{
    int32_t ring[SL_RING_MAX], moved = 1, all = 0;
    for (int sweep = 0; sweep < 4 && moved > 0; sweep++) {
        moved = 0;
        for (int32_t v = 0; v < p->nv; v++) {
            int32_t h = p->outgoing[v], count = 0;
            while (p->border[v] == 0 && count <= SL_RING_MAX && (count == 0 || h != p->outgoing[v])) {
                if (count < SL_RING_MAX) {
                    ring[count] = p->tri[sl_corner_next(h)];
                }
                count++;
                h = p->twin[sl_corner_prev(h)];
            }
            const sl_removal star = {.vertex = v, .count = count};
            moved += p->border[v] == 0 && count <= SL_RING_MAX && sl_stretch_settle(p->xyz, &star, ring, w, limit, uv);
        }
        all += moved;
    }
    return all;
}

/* The bound by which vertices are passed over passes over none that would move, for weights of either sign, limits from
 * what every star has to what none has, slivers and flips. */
static void settling_passes_over_no_vertex_that_would_move(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x5e77);
    int32_t moved = 0, resting = 0;
    for (int trial = 0; trial < 60 * test_multiplier(); trial++) {
        sl_patch *p =
            trial % 2 == 0 ? chart_tube(8 + trial % 5, 6, 0.2, (uint64_t)trial) : chart_limbs(4, 3, 5, (uint64_t)trial);
        const size_t size = 2 * (size_t)p->nv * sizeof(double);
        double *uv = malloc(size), *plain = malloc(size);
        const double w = test_uniform(&rng, -4.0, 1.0), limit = exp(test_uniform(&rng, 1.0, 6.0));
        sl_stretch_def def = sl_stretch_default();
        def.relative_decrease = 1e-2;
        assert_int_equal(sl_stretch_unfold(p, &def, NULL, uv, NULL), SL_OK);
        for (int32_t v = 0; v < p->nv; v++) {
            for (int k = 0; k < 2 && test_index(&rng, 4) == 0; k++) {
                uv[2 * v + k] += test_uniform(&rng, -0.1, 0.1);
            }
            p->xyz[3 * v + 1] *= trial % 5 == 0 ? 1e-3 : 1.0; /* slivers */
        }
        memcpy(plain, uv, size);
        const int32_t steps = settle_plainly(p, w, limit, plain);
        assert_int_equal(sl_stretch_settle_all(p, w, limit, uv), SL_OK);
        assert_memory_equal(uv, plain, size);
        moved += steps > 0;
        resting += steps < p->nv / 4;
        free(uv);
        free(plain);
        sl_patch_free(p);
    }
    assert_true(moved > 20 && resting > 20);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(flips_are_mended_and_a_map_without_stays),
        cmocka_unit_test(borders_that_cross_are_parted),
        cmocka_unit_test(ends_that_meet_are_parted),
        cmocka_unit_test(unfolding_from_a_guess_ends_in_the_same_minimum),
        cmocka_unit_test(settling_passes_over_no_vertex_that_would_move),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
