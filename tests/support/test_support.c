#define _POSIX_C_SOURCE 200809L
#define _XOPEN_SOURCE 700
#include "support/test_support.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char scratch_dir[256];
static char scratch_path[512];

test_rng test_rng_seed(uint64_t seed)
{
    return (test_rng){seed};
}

uint64_t test_bits(test_rng *rng)
{
    uint64_t z = (rng->state += 0x9e3779b97f4a7c15u); /* splitmix64 */
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

double test_uniform(test_rng *rng, double lo, double hi)
{
    return lo + (hi - lo) * (double)(test_bits(rng) >> 11) * 0x1p-53;
}

int32_t test_index(test_rng *rng, int32_t n)
{
    return (int32_t)(test_bits(rng) % (uint64_t)n);
}

bool test_near(double a, double b, double tol)
{
    if (fabs(a - b) <= tol) {
        return true;
    }
    print_error("%.17g and %.17g differ by %.3g, more than %.3g\n", a, b, fabs(a - b), tol);
    return false;
}

bool test_near_rel(double a, double b, double tol)
{
    return test_near(a, b, tol * fmax(1.0, fmax(fabs(a), fabs(b))));
}

int test_multiplier(void)
{
    const char *text = getenv("SEAMLAB_TEST_MULTIPLIER");
    const int n = text != NULL ? atoi(text) : 1;
    return n > 0 ? n : 1;
}

static void remove_scratch(void)
{
    DIR *dir = opendir(scratch_dir);
    if (dir == NULL) {
        return;
    }
    for (struct dirent *e = readdir(dir); e != NULL; e = readdir(dir)) {
        if (strcmp(e->d_name, ".") != 0 && strcmp(e->d_name, "..") != 0) {
            snprintf(scratch_path, sizeof scratch_path, "%s/%.200s", scratch_dir, e->d_name);
            unlink(scratch_path);
        }
    }
    closedir(dir);
    rmdir(scratch_dir);
}

const char *test_scratch(const char *name)
{
    if (scratch_dir[0] == '\0') {
        const char *base = getenv("TMPDIR");
        snprintf(scratch_dir, sizeof scratch_dir, "%.200s/seamlab-test-XXXXXX", base != NULL ? base : "/tmp");
        if (mkdtemp(scratch_dir) == NULL) {
            fail_msg("no scratch folder under %s", scratch_dir);
        }
        atexit(remove_scratch);
    }
    snprintf(scratch_path, sizeof scratch_path, "%s/%.200s", scratch_dir, name);
    return scratch_path;
}
