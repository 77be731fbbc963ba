/* Every allocation of the room's own fails once; linked with --wrap=malloc and its like. */
#include "matrices.h"

#include "sparse/cholesky.h"

#include <stdatomic.h>

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *memory, size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *memory, size_t size);

static _Atomic int64_t allocated; /* bytes asked for */
static atomic_int countdown = -1; /* allocations left before one fails; negative = never */

static bool fails(void)
{
    return atomic_load(&countdown) >= 0 && atomic_fetch_sub(&countdown, 1) == 0;
}

void *__wrap_malloc(size_t size)
{
    atomic_fetch_add(&allocated, (int64_t)size);
    return fails() ? NULL : __real_malloc(size);
}

void *__wrap_calloc(size_t count, size_t size)
{
    return fails() ? NULL : __real_calloc(count, size);
}

void *__wrap_realloc(void *memory, size_t size)
{
    return fails() ? NULL : __real_realloc(memory, size);
}

typedef struct subject {
    sl_csc *A;
    double *xyz;
    sl_cholesky_def def;
    const sl_context *context;
} subject;

/* Everything that allocates, once; what was made is freed. */
static sl_status use_everything(const subject *s)
{
    sl_cholesky *F = NULL;
    sl_inertia_info info;
    sl_status status = SL_OK;
    SL_TRY(sl_cholesky_analyze(s->A, &s->def, &F));
    SL_TRY(sl_cholesky_factor_shifted(F, s->A, -0.1, s->context, NULL));
    SL_TRY(sl_inertia(F, s->A, 0.3, s->context, &info));
cleanup:
    sl_cholesky_free(F);
    return status;
}

static void check_failures(const subject *s)
{
    sl_status status = SL_OUT_OF_MEMORY;
    int32_t allowed = 0;
    for (; status != SL_OK; allowed++) {
        assert_true(allowed < 2000);
        atomic_store(&countdown, allowed);
        status = use_everything(s);
        const bool failed = atomic_exchange(&countdown, -1) < 0;
        assert_int_equal(status, failed ? SL_OUT_OF_MEMORY : SL_OK);
    }
    assert_true(allowed > 40);
}

static void each_failed_allocation_is_told_and_leaves_nothing_behind(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x3e3);
    const sl_ordering orderings[] = {SL_ORDER_NATURAL, SL_ORDER_NESTED_DISSECTION};
    for (size_t o = 0; o < SL_COUNTOF(orderings); o++) {
        for (int points = 0; points < 3; points++) {
            subject s = {.A = random_spd(MATRIX_GRID, 400, 0.3, &rng), .def = sl_cholesky_default()};
            s.xyz = random_doubles(3 * (int64_t)s.A->ncols, &rng);
            if (points == 2) { /* two at a point */
                memcpy(s.xyz, s.xyz + 3, 3 * sizeof *s.xyz);
            }
            s.def.ordering = orderings[o];
            s.def.xyz = points > 0 ? s.xyz : NULL;
            s.def.kind = SL_FACTOR_LDLT;
            s.def.patch = 20;
            check_failures(&s);
            sl_free(s.xyz);
            sl_csc_free(s.A);
        }
    }
}

static void workers_survive_failed_allocations(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x3e4);
    sl_thread_pool *pool = NULL;
    assert_int_equal(sl_thread_pool_create(2, &pool), SL_OK);
    const sl_context context = {.executor = sl_thread_pool_executor(pool)};
    subject s = {.A = random_spd(MATRIX_GRID, 110 * 110, 0.3, &rng), .def = sl_cholesky_default()};
    int32_t *perm = sl_alloc(s.A->ncols, sizeof *perm);
    assert_non_null(perm);
    assert_int_equal(sl_order(s.A, SL_ORDER_NESTED_DISSECTION, NULL, perm), SL_OK);
    s.def.perm = perm;
    s.context = &context;
    sl_cholesky *F = NULL;
    assert_int_equal(sl_cholesky_analyze(s.A, &s.def, &F), SL_OK);
    sl_status status = SL_OUT_OF_MEMORY;
    for (int32_t allowed = 0; status != SL_OK; allowed += 3) {
        assert_true(allowed < 2000);
        atomic_store(&countdown, allowed);
        status = sl_cholesky_factor_shifted(F, s.A, -0.1, &context, NULL);
        const bool failed = atomic_exchange(&countdown, -1) < 0;
        assert_int_equal(status, failed ? SL_OUT_OF_MEMORY : SL_OK);
    }
    sl_cholesky_free(F);
    sl_free(perm);
    sl_csc_free(s.A);
    sl_thread_pool_free(pool);
}

static void the_factor_takes_the_bytes_foretold(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x3e5);
    for (int kind = 0; kind < MATRIX_KINDS; kind++) {
        sl_csc *A = random_spd((matrix_kind)kind, 300, 0.3, &rng);
        sl_cholesky_def def = sl_cholesky_default();
        sl_cholesky *F = NULL;
        int64_t kept;
        def.kind = kind % 2 == 0 ? SL_FACTOR_LLT : SL_FACTOR_LDLT;
        assert_int_equal(sl_cholesky_analyze(A, &def, &F), SL_OK);
        const int64_t foretold = sl_cholesky_factor_bytes(F, &kept);
        atomic_store(&allocated, 0);
        assert_int_equal(sl_cholesky_factor(F, A, NULL), SL_OK);
        assert_true(kept >= 8 * sl_cholesky_nnz(F) && kept < foretold);
        assert_in_range(atomic_load(&allocated), foretold, foretold + 16); /* empty arrays take a byte */
        atomic_store(&allocated, 0);
        assert_int_equal(sl_cholesky_factor(F, A, NULL), SL_OK);
        assert_in_range(atomic_load(&allocated), foretold - kept, foretold - kept + 16);
        sl_cholesky_release(F);
        sl_inertia_info info;
        assert_int_equal(sl_inertia(F, A, -0.01, NULL, &info), SL_OK);
        atomic_store(&allocated, 0);
        assert_int_equal(sl_cholesky_factor(F, A, NULL), SL_OK); /* all of it anew */
        assert_in_range(atomic_load(&allocated), foretold, foretold + 16);
        sl_cholesky_free(F);
        sl_csc_free(A);
    }
}

/* Both kinds, several matrices, a failure on the way: bytes as without. */
static void a_reserved_factor_allocates_nothing(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x3e6);
    for (int kind = 0; kind < MATRIX_KINDS; kind++) {
        sl_csc *A = random_spd((matrix_kind)kind, 300, 0.3, &rng);
        sl_cholesky_def def = sl_cholesky_default();
        sl_cholesky *F = NULL, *plain = NULL;
        int64_t kept;
        def.kind = kind % 2 == 0 ? SL_FACTOR_LLT : SL_FACTOR_LDLT;
        assert_int_equal(sl_cholesky_analyze(A, &def, &F), SL_OK);
        assert_int_equal(sl_cholesky_analyze(A, &def, &plain), SL_OK);
        const int64_t foretold = sl_cholesky_factor_bytes(F, &kept);
        sl_status status = SL_OUT_OF_MEMORY;
        for (int allowed = 0; status != SL_OK && allowed < 20; allowed++) {
            atomic_store(&allocated, 0);
            atomic_store(&countdown, allowed);
            status = sl_cholesky_reserve(F);
            assert_int_equal(status, atomic_exchange(&countdown, -1) < 0 ? SL_OUT_OF_MEMORY : SL_OK);
            if (status != SL_OK) {
                sl_cholesky_release(F);
            }
        }
        assert_int_equal(status, SL_OK);
        assert_in_range(atomic_load(&allocated), foretold, foretold + 16);
        double *x = random_doubles(A->ncols, &rng), *work = sl_alloc(sl_cholesky_work_size(F, 1), sizeof *work);
        double *y = sl_copy(x, A->ncols, sizeof *x);
        for (int round = 0; round < 3; round++) {
            assert_int_equal(sl_cholesky_factor(plain, A, NULL), SL_OK);
            atomic_store(&countdown, 0); /* the next one would fail */
            assert_int_equal(sl_cholesky_reserve(F), SL_OK);
            assert_int_equal(sl_cholesky_factor(F, A, NULL), SL_OK);
            assert_int_equal(atomic_exchange(&countdown, -1), 0);
            sl_cholesky_solve(plain, x, 1, work);
            sl_cholesky_solve(F, y, 1, work);
            assert_memory_equal(x, y, (size_t)A->ncols * sizeof *x);
        }
        sl_cholesky_release(F);
        atomic_store(&allocated, 0);
        assert_int_equal(sl_cholesky_factor(F, A, NULL), SL_OK); /* all of it anew */
        assert_in_range(atomic_load(&allocated), foretold, foretold + 16);
        sl_free(x);
        sl_free(y);
        sl_free(work);
        sl_cholesky_free(F);
        sl_cholesky_free(plain);
        sl_csc_free(A);
    }
}

static void inherited_orderings_report_memory_too(void **state)
{
    (void)state;
    const int32_t parent[] = {2, 0, 3, 1}, subset[] = {3, 2};
    int32_t perm[2] = {-1, -1};
    atomic_store(&countdown, 0);
    assert_int_equal(sl_order_inherit(4, parent, 2, subset, perm), SL_OUT_OF_MEMORY);
    atomic_store(&countdown, 0);
    assert_int_equal(sl_order_by_rank(2, subset, perm), SL_OUT_OF_MEMORY);
    atomic_store(&countdown, -1);
    assert_int_equal(sl_order_inherit(4, parent, 2, subset, perm), SL_OK);
    assert_int_equal(perm[0], 1);
    assert_int_equal(perm[1], 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_failed_allocation_is_told_and_leaves_nothing_behind),
        cmocka_unit_test(workers_survive_failed_allocations),
        cmocka_unit_test(the_factor_takes_the_bytes_foretold),
        cmocka_unit_test(a_reserved_factor_allocates_nothing),
        cmocka_unit_test(inherited_orderings_report_memory_too),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
