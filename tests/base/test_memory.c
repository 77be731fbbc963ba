#include "base/memory.h"
#include "support/test_support.h"

#include <string.h>

static void sizes_that_do_not_exist_give_no_memory(void **state)
{
    (void)state;
    assert_null(sl_alloc(-1, 8));
    assert_null(sl_alloc(INT64_MAX, 8));
    assert_null(sl_alloc(INT64_MAX / 8 + 2, 8));
    assert_null(sl_calloc(INT64_MIN, 1));
    assert_null(sl_calloc(INT64_MAX, 3));
    assert_null(sl_copy(NULL, -7, 4));
    int32_t *kept = sl_alloc(3, sizeof *kept);
    assert_non_null(kept);
    kept[2] = 911;
    assert_null(sl_realloc(kept, INT64_MAX, sizeof *kept));
    assert_int_equal(kept[2], 911);
    sl_free(kept);
}

static void nothing_is_a_pointer_of_its_own(void **state)
{
    (void)state;
    void *a = sl_alloc(0, 8), *b = sl_calloc(0, 8), *c = sl_copy(NULL, 0, 8), *d = sl_alloc(5, 0);
    assert_true(a != NULL && b != NULL && c != NULL && d != NULL && a != b && b != c);
    sl_free(a);
    sl_free(b);
    sl_free(c);
    sl_free(d);
    sl_free(NULL);
}

static void calloc_is_zero_and_copy_is_equal(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(41);
    for (int trial = 0; trial < 200; trial++) {
        const int32_t n = 1 + test_index(&rng, 3000);
        uint64_t *zero = sl_calloc(n, sizeof *zero), *noise = sl_alloc(n, sizeof *noise);
        assert_true(zero != NULL && noise != NULL);
        for (int32_t k = 0; k < n; k++) {
            assert_int_equal(zero[k], 0);
            noise[k] = test_bits(&rng);
        }
        uint64_t *copy = sl_copy(noise, n, sizeof *copy);
        assert_non_null(copy);
        assert_memory_equal(copy, noise, (size_t)n * sizeof *copy);
        memset(noise, 0x5a, (size_t)n * sizeof *noise); /* so that the next calloc meets dirty memory */
        sl_free(copy);
        sl_free(noise);
        sl_free(zero);
    }
}

static void reserve_keeps_what_stands_and_grows_by_half_at_least(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(42);
    uint64_t expected[5000];
    void *memory = NULL;
    int64_t capacity = 0;
    int growths = 0;
    for (int64_t k = 0; k < 5000; k++) {
        const int64_t before = capacity;
        assert_int_equal(sl_reserve(&memory, &capacity, k + 1, sizeof(uint64_t)), SL_OK);
        assert_true(capacity >= k + 1);
        if (capacity != before) {
            assert_true(capacity >= before + before / 2);
            growths++;
        }
        expected[k] = test_bits(&rng);
        ((uint64_t *)memory)[k] = expected[k];
    }
    assert_memory_equal(memory, expected, sizeof expected);
    assert_true(growths <= 20);
    const void *old = memory;
    const int64_t room = capacity;
    assert_int_equal(sl_reserve(&memory, &capacity, INT64_MAX, sizeof(uint64_t)), SL_OUT_OF_MEMORY);
    assert_ptr_equal(memory, old);
    assert_int_equal(capacity, room);
    sl_free(memory);
}

static void sizes_are_added_and_multiplied_only_where_they_fit(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(43);
    int64_t out = -5;
    for (int trial = 0; trial < 20000; trial++) {
        const int64_t a = (int64_t)(test_bits(&rng) >> (1 + test_index(&rng, 63)));
        const int64_t b = (int64_t)(test_bits(&rng) >> (1 + test_index(&rng, 63)));
        int64_t expected;
        const bool sum_fits = !__builtin_add_overflow(a, b, &expected);
        assert_int_equal(sl_add_size(a, b, &out), sum_fits ? SL_OK : SL_OUT_OF_MEMORY);
        assert_true(!sum_fits || out == expected);
        const bool product_fits = !__builtin_mul_overflow(a, b, &expected);
        assert_int_equal(sl_mul_size(a, b, &out), product_fits ? SL_OK : SL_OUT_OF_MEMORY);
        assert_true(!product_fits || out == expected);
    }
    assert_int_equal(sl_mul_size(INT64_MAX, 0, &out), SL_OK);
    assert_int_equal(out, 0);
}

static void arena_blocks_are_aligned_and_never_overlap(void **state)
{
    (void)state;
    enum { BLOCKS = 3000 };
    static unsigned char *block[BLOCKS];
    static int32_t size[BLOCKS];
    test_rng rng = test_rng_seed(44);
    sl_arena *arena;
    assert_int_equal(sl_arena_create(&arena), SL_OK);
    for (int k = 0; k < BLOCKS; k++) {
        size[k] = k % 500 == 250 ? 300000 + test_index(&rng, 100000) : test_index(&rng, 200);
        block[k] = sl_arena_alloc(arena, size[k], 1);
        assert_non_null(block[k]);
        assert_int_equal((uintptr_t)block[k] % 16, 0);
        memset(block[k], k % 251, (size_t)size[k]);
    }
    for (int k = 0; k < BLOCKS; k++) { /* a later block over an earlier one would have changed its bytes */
        for (int32_t b = 0; b < size[k]; b++) {
            assert_int_equal(block[k][b], k % 251);
        }
    }
    assert_null(sl_arena_alloc(arena, -1, 4));
    assert_null(sl_arena_alloc(arena, INT64_MAX, 4));
    assert_null(sl_arena_alloc(arena, INT64_MAX, 1));
    assert_non_null(sl_arena_alloc(arena, 0, 8));
    sl_arena_free(arena);
    sl_arena_free(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sizes_that_do_not_exist_give_no_memory),
        cmocka_unit_test(nothing_is_a_pointer_of_its_own),
        cmocka_unit_test(calloc_is_zero_and_copy_is_equal),
        cmocka_unit_test(reserve_keeps_what_stands_and_grows_by_half_at_least),
        cmocka_unit_test(sizes_are_added_and_multiplied_only_where_they_fit),
        cmocka_unit_test(arena_blocks_are_aligned_and_never_overlap),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
