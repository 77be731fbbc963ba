/* k-means against all partitions there are. */
#include "segment/kmeans_internal.h"
#include "support/test_support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 9, DIMS = 3 };

/* Sum of weight |x - mean|^2 by pairs: sum over pairs of w_i w_j |x_i - x_j|^2 / W, no means. */
static double energy_of(const sl_kmeans_points *p, const int32_t *label, int32_t count)
{
    double energy = 0.0;
    for (int32_t k = 0; k < count; k++) {
        double mass = 0.0, sum = 0.0;
        for (int32_t i = 0; i < p->n; i++) {
            mass += label[i] == k ? p->weight[i] : 0.0;
            for (int32_t j = 0; j < i; j++) {
                for (int32_t d = 0; d < p->dims && label[i] == k && label[j] == k; d++) {
                    const double apart = p->x[i * p->dims + d] - p->x[j * p->dims + d];
                    sum += p->weight[i] * p->weight[j] * apart * apart;
                }
            }
        }
        energy += mass > 0.0 ? sum / mass : 0.0;
    }
    return energy;
}

static double best_of_all(const sl_kmeans_points *p, int32_t clusters)
{
    int32_t label[MOST] = {0};
    double best = HUGE_VAL;
    for (;;) {
        best = fmin(best, energy_of(p, label, clusters));
        int32_t i = 0;
        while (i < p->n && ++label[i] == clusters) {
            label[i++] = 0;
        }
        if (i == p->n) {
            return best;
        }
    }
}

static void no_partition_of_few_points_is_better(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x4ea5);
    int32_t exact = 0, trials = 60 * test_multiplier();
    for (int trial = 0; trial < trials; trial++) {
        double x[MOST * DIMS], weight[MOST], energy = -1.0;
        const int32_t n = 4 + test_index(&rng, MOST - 3), dims = 1 + test_index(&rng, DIMS);
        const int32_t clusters = 2 + test_index(&rng, 2);
        int32_t label[MOST], count = 0;
        for (int32_t i = 0; i < n * dims; i++) {
            x[i] = test_uniform(&rng, -1.0, 1.0);
        }
        for (int32_t i = 0; i < n; i++) {
            weight[i] = test_uniform(&rng, 0.1, 2.0);
        }
        const sl_kmeans_points points = {n, dims, x, weight};
        const sl_kmeans_def def = sl_kmeans_default(clusters);
        assert_int_equal(sl_kmeans(&points, &def, NULL, label, &count, &energy), SL_OK);
        const double best = best_of_all(&points, clusters);
        assert_int_equal(count, clusters);
        assert_true(test_near_rel(energy, energy_of(&points, label, count), 1e-12));
        assert_true(energy >= best * (1.0 - 1e-12));
        exact += energy <= best * (1.0 + 1e-12);
    }
    assert_true(exact >= trials * 9 / 10); /* eight starts find the best of all but for a few */
}

static void every_point_is_nearest_to_the_mean_of_its_own(void **state)
{
    (void)state;
    enum { N = 400, K = 7 };
    test_rng rng = test_rng_seed(0x4ea6);
    double x[N * DIMS], weight[N], mean[K * DIMS] = {0.0}, mass[K] = {0.0}, energy = 0.0;
    int32_t label[N], again[N], count = 0, next = 0;
    for (int32_t i = 0; i < N * DIMS; i++) {
        x[i] = test_uniform(&rng, -1.0, 1.0) + 0.8 * (double)(i / DIMS % K);
    }
    for (int32_t i = 0; i < N; i++) {
        weight[i] = i % 11 == 0 ? 0.0 : test_uniform(&rng, 0.1, 2.0);
    }
    const sl_kmeans_points points = {N, DIMS, x, weight};
    const sl_kmeans_def def = sl_kmeans_default(K);
    assert_int_equal(sl_kmeans(&points, &def, NULL, label, &count, &energy), SL_OK);
    assert_int_equal(count, K);
    for (int32_t i = 0; i < N; i++) {
        assert_true(label[i] <= next);
        next += label[i] == next;
        mass[label[i]] += weight[i];
        for (int32_t d = 0; d < DIMS; d++) {
            mean[label[i] * DIMS + d] += weight[i] * x[i * DIMS + d];
        }
    }
    for (int32_t i = 0; i < N; i++) {
        double own = 0.0, least = HUGE_VAL;
        for (int32_t k = 0; k < K; k++) {
            double sum = 0.0;
            for (int32_t d = 0; d < DIMS; d++) {
                const double apart = x[i * DIMS + d] - mean[k * DIMS + d] / mass[k];
                sum += apart * apart;
            }
            own = k == label[i] ? sum : own;
            least = fmin(least, sum);
        }
        assert_true(own <= least * (1.0 + 1e-9));
    }
    assert_int_equal(sl_kmeans(&points, &def, NULL, again, &count, &energy), SL_OK);
    assert_memory_equal(label, again, sizeof label);
}

static void points_that_coincide_are_one_cluster(void **state)
{
    (void)state;
    const double x[] = {0.3, -1.7, 0.3, 0.3, -1.7, 0.3}, weight[] = {1.0, 0.5, 2.0, 0.25, 1.5, 0.75};
    const sl_kmeans_points points = {6, 1, x, weight};
    const sl_kmeans_def def = sl_kmeans_default(4);
    int32_t label[6], count = 0;
    double energy = -1.0;
    assert_int_equal(sl_kmeans(&points, &def, NULL, label, &count, &energy), SL_OK);
    assert_int_equal(count, 2);
    assert_true(energy < 1e-25);
    for (int32_t i = 0; i < 6; i++) {
        assert_int_equal(label[i], x[i] < 0.0);
    }
}

static bool refuse(void *user, const char *stage, double fraction)
{
    assert_string_equal(stage, "clusters");
    assert_true(fraction >= 0.0 && fraction <= 1.0);
    return (*(int *)user)-- > 0;
}

static void clustering_can_be_cancelled(void **state)
{
    (void)state;
    const double x[] = {0.3, -1.7, 0.9, 2.3}, weight[] = {1.0, 0.5, 2.0, 0.25};
    const sl_kmeans_points points = {4, 1, x, weight};
    const sl_kmeans_def def = sl_kmeans_default(2);
    for (int allowed = 0; allowed < 8; allowed++) {
        int left = allowed;
        int32_t label[4], count = 0;
        double energy = -1.0;
        const sl_context context = {.progress = refuse, .progress_user = &left};
        assert_int_equal(sl_kmeans(&points, &def, &context, label, &count, &energy), SL_CANCELLED);
        assert_true(energy == -1.0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_partition_of_few_points_is_better),
        cmocka_unit_test(every_point_is_nearest_to_the_mean_of_its_own),
        cmocka_unit_test(points_that_coincide_are_one_cluster),
        cmocka_unit_test(clustering_can_be_cancelled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
