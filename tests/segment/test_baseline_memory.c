/* Every allocation of the baselines fails once; linked with --wrap=malloc and its like. */
#include "segment/baselines.h"

#include <stdatomic.h>

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *memory, size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *memory, size_t size);

static atomic_int countdown = -1; /* allocations left before one fails; negative = never */

static bool fails(void)
{
    return atomic_load(&countdown) >= 0 && atomic_fetch_sub(&countdown, 1) == 0;
}

void *__wrap_malloc(size_t size)
{
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

static void each_failed_allocation_is_told_and_leaves_nothing_behind(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x3e3);
    sl_mesh *mesh = test_spiky_mesh(&rng, 6, 4, 1.2, TEST_MIXED);
    sl_triangulation *t = test_triangulate(mesh);
    sl_piece *piece = test_whole_piece(mesh, t);
    static const sl_cut_method methods[] = {SL_METHOD_PCA,       SL_METHOD_VSA,      SL_METHOD_VSA,
                                            SL_METHOD_VSA,       SL_METHOD_FIEDLER,  SL_METHOD_RANDOM,
                                            SL_METHOD_ISOCHARTS, SL_METHOD_EMBEDDING};
    for (size_t which = 0; which < SL_COUNTOF(methods); which++) {
        sl_segment_def def = sl_segment_default();
        def.method = methods[which];
        def.vsa_regions = which == 1 ? 2 : which == 2 ? 12 : 0;
        def.vsa_error = 0.2;
        sl_status status = SL_OUT_OF_MEMORY;
        int32_t allowed = 0;
        for (; status != SL_OK; allowed++) {
            sl_choice choice;
            assert_true(allowed < 2000);
            atomic_store(&countdown, allowed);
            status = sl_choose_cut(piece, NULL, &def, NULL, &choice);
            const bool failed = atomic_exchange(&countdown, -1) < 0;
            assert_int_equal(status, failed ? SL_OUT_OF_MEMORY : SL_OK);
            assert_true(status == SL_OK ? choice.found : choice.side == NULL);
            sl_choice_clear(&choice);
        }
        assert_true(allowed > 20);
    }
    sl_piece_free(piece);
    sl_triangulation_free(t);
    sl_mesh_free(mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_failed_allocation_is_told_and_leaves_nothing_behind),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
