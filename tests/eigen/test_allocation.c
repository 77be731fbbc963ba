/* Linked with malloc, calloc and realloc wrapped: the k-th allocation fails, for every k. */
#include "pairs.h"

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *memory, size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *memory, size_t size);

static int64_t allocations, failing; /* failing: the allocation to refuse, 0 = none */

static bool refuses(void)
{
    return ++allocations == failing;
}

void *__wrap_malloc(size_t size)
{
    return refuses() ? NULL : __real_malloc(size);
}

void *__wrap_calloc(size_t count, size_t size)
{
    return refuses() ? NULL : __real_calloc(count, size);
}

void *__wrap_realloc(void *memory, size_t size)
{
    return refuses() ? NULL : __real_realloc(memory, size);
}

/* Refuses one allocation after the other until a solve gets through. */
static void survive_all(const sl_csc *A, const sl_lanczos_def *def)
{
    const int32_t count = def->count < A->ncols ? def->count : A->ncols;
    double *lambda = sl_alloc(count, sizeof *lambda), *first = sl_alloc(count, sizeof *first);
    double *vectors = sl_alloc((int64_t)A->ncols * count, sizeof *vectors);
    assert_true(lambda && first && vectors);
    assert_int_equal(sl_lanczos_solve(A, def, NULL, first, vectors, NULL, NULL), SL_OK);
    sl_status status = SL_OUT_OF_MEMORY;
    int64_t k = 1;
    for (; status != SL_OK; k++) {
        allocations = 0;
        failing = k;
        status = sl_lanczos_solve(A, def, NULL, lambda, vectors, NULL, NULL);
        failing = 0;
        assert_true(status == SL_OK || status == SL_OUT_OF_MEMORY);
        assert_true(k < 2000);
    }
    assert_true(k > 5);
    assert_memory_equal(lambda, first, (size_t)count * sizeof *lambda);
    sl_free(lambda);
    sl_free(first);
    sl_free(vectors);
}

static void every_refused_allocation_is_survived(void **state)
{
    (void)state;
    sl_csc *A = grid_laplacian(23, 19, false), *torus = grid_laplacian(24, 24, true),
           *small = grid_laplacian(9, 7, false);
    double *ones = constant_vector(A->ncols);
    sl_lanczos_def def = sl_lanczos_default();
    def.count = 7;
    survive_all(A, &def);
    survive_all(small, &def); /* dense */
    def.null_space = ones;
    def.null_count = 1;
    def.max_basis = 24; /* restarts */
    survive_all(A, &def);
    def = sl_lanczos_default();
    def.count = 12;
    survive_all(torus, &def); /* larger blocks */
    sl_free(ones);
    ones = constant_vector(torus->ncols);
    def.null_space = ones;
    def.null_count = 1;
    survive_all(torus, &def); /* a basis of single precision, and again in double */
    sl_free(ones);
    sl_csc_free(A);
    sl_csc_free(torus);
    sl_csc_free(small);
}

static void the_skeleton_survives_refused_allocations(void **state)
{
    (void)state;
    sl_csc *A = grid_laplacian(40, 37, false);
    sl_lanczos_def def = sl_lanczos_default();
    def.count = 4;
    def.start = SL_START_SKELETON;
    def.patch = 12;
    survive_all(A, &def);
    sl_csc_free(A);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_refused_allocation_is_survived),
        cmocka_unit_test(the_skeleton_survives_refused_allocations),
    };
    return cmocka_run_group_tests(tests, one_blas_thread, NULL);
}
