/* What every unit test includes: cmocka with its prerequisites, comparisons of doubles, a seeded generator. */
#ifndef SL_TEST_SUPPORT_H
#define SL_TEST_SUPPORT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define TEST_EPS 0x1p-52
#define TEST_PI 3.14159265358979323846

typedef struct test_rng {
    uint64_t state;
} test_rng;

test_rng test_rng_seed(uint64_t seed);
uint64_t test_bits(test_rng *rng);

/* Uniform in [lo, hi). */
double test_uniform(test_rng *rng, double lo, double hi);

/* Uniform integer in [0, n), n > 0. */
int32_t test_index(test_rng *rng, int32_t n);

/* |a - b| <= tol; prints both values when not. NaN is never near anything. */
bool test_near(double a, double b, double tol);

/* |a - b| <= tol * max(1, |a|, |b|). */
bool test_near_rel(double a, double b, double tol);

/* Number of random trials is multiplied by this: 1, or SEAMLAB_TEST_MULTIPLIER. */
int test_multiplier(void);

/* Full path of a file in a fresh scratch folder of this process; the folder is removed at exit. Borrowed; valid until
 * the next call. */
const char *test_scratch(const char *name);

#endif
