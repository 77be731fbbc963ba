/* Linked with malloc, calloc and realloc wrapped: steps allocate nothing, and every allocation fails once. */
#include "base/memory.h"
#include "param/abf_chart.h"
#include "param/abf_charts.h"
#include "param/abf_sectors.h"
#include "param/constraints.h"
#include "param/lscm.h"

#include <stdatomic.h>

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *memory, size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *memory, size_t size);

static atomic_int allocations;
static atomic_int countdown = -1; /* allocations left before one fails; negative = never */

static bool fails(void)
{
    atomic_fetch_add(&allocations, 1);
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

/* The hook counts at all: without this the tests below would pass for nothing. */
static void allocations_are_counted(void **state)
{
    (void)state;
    atomic_store(&allocations, 0);
    double *x = sl_alloc(7, sizeof *x);
    assert_non_null(x);
    assert_int_equal(atomic_load(&allocations), 1);
    sl_free(x);
}

static void no_step_allocates(void **state)
{
    (void)state;
    for (int form = 0; form < 12; form++) {
        sl_patch *patch = chart_hexagon(5, 0.15, chart_cap, 0.9, (uint64_t)form);
        sl_sector_table table = make_sectors(patch, form % 2 == 0);
        sl_abf_def def = sl_abf_default();
        sl_abf *solver = NULL;
        def.sectors = &table.view;
        def.wheel = (sl_abf_wheel)(form % 3);
        def.newton = form < 6 ? SL_ABF_DROPPED : SL_ABF_EXACT;
        assert_int_equal(sl_abf_create(patch, &def, &solver), SL_OK);
        atomic_store(&allocations, 0);
        assert_int_equal(sl_abf_step(solver, 40, NULL), SL_OK); /* the first one, too */
        assert_int_equal(sl_abf_set_targets(solver, table.theta), SL_OK);
        assert_int_equal(sl_abf_start_from(solver, NULL), 0);
        assert_int_equal(sl_abf_step(solver, 3, NULL), SL_OK);
        assert_int_equal(atomic_load(&allocations), 0);
        assert_true(sl_abf_info_of(solver)->iterations == 3);
        sl_abf_free(solver);
        sl_sectors_clear(&table);
        sl_patch_free(patch);
    }
}

static void no_move_of_a_chart_allocates(void **state)
{
    (void)state;
    sl_patch *patch = chart_hexagon(5, 0.15, chart_cap, 0.9, 0xa1);
    sl_sector_table table = make_sectors(patch, true);
    sl_abf_def def = sl_abf_default();
    sl_abf_chart *chart = NULL;
    double *theta = sl_copy(table.theta, table.view.count, sizeof *theta);
    def.sectors = &table.view;
    assert_non_null(theta);
    assert_int_equal(sl_abf_chart_create(patch, &def, NULL, &chart), SL_OK);
    atomic_store(&allocations, 0);
    for (int drag = 0; drag < 5; drag++) {
        theta[table.view.count - 1] -= 0.09;
        assert_int_equal(sl_abf_chart_move(chart, theta, NULL), SL_OK);
    }
    assert_int_equal(sl_abf_chart_release(chart, theta, NULL), SL_OK);
    theta[table.view.count - 1] = 50.0; /* a homotopy, and back */
    assert_int_equal(sl_abf_chart_release(chart, theta, NULL), SL_OK);
    assert_true(sl_abf_chart_info_of(chart)->solves > 3);
    assert_int_equal(atomic_load(&allocations), 0);
    sl_abf_chart_free(chart);
    sl_sectors_clear(&table);
    sl_patch_free(patch);
    sl_free(theta);
}

/* Constraints, a chart from known angles, LSCM; angle: 3 nt. */
static sl_status use_everything(const sl_patch *patch, const double *angle, double *uv)
{
    sl_status status = SL_OK;
    int32_t v = 0, taken = 0;
    sl_sector_table table = {0};
    sl_abf_chart *chart = NULL;
    sl_abf_def def = sl_abf_default();
    sl_csc *J = NULL;
    sl_abf *solver = NULL;
    double *carried = sl_copy(angle, 3 * (int64_t)patch->nt, sizeof *angle);
    SL_TRY(carried != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    while (patch->border[v] == 0 || patch->twin[sl_corner_prev(patch->outgoing[v])] < 0) {
        v++;
    }
    const sl_constraint wish = {SL_CONSTRAINT_ANGLE, 1, &v, 2.0};
    SL_TRY(sl_constraints_compile(patch, 1, &wish, NULL, &table, NULL));
    def.sectors = &table.view;
    SL_TRY(sl_abf_carry_angles(patch, angle, patch, carried, &taken));
    SL_TRY(sl_abf_chart_create_from(patch, &def, carried, NULL, &chart));
    SL_TRY(sl_lscm(patch, NULL, uv));
    SL_TRY(sl_abf_create(patch, &def, &solver));
    SL_TRY(sl_abf_jacobian(solver, &J));
    SL_TRY(sl_abf_flatten(patch, &def, NULL, uv, NULL));
cleanup:
    sl_csc_free(J);
    sl_abf_free(solver);
    sl_abf_chart_free(chart);
    sl_sectors_clear(&table);
    sl_free(carried);
    return status;
}

static void each_failed_allocation_is_told(void **state)
{
    (void)state;
    sl_patch *patch = chart_hexagon(4, 0.15, chart_cap, 0.9, 0xa2);
    double *angle = sl_alloc(3 * (int64_t)patch->nt, sizeof *angle), *uv = sl_calloc(2 * patch->nv, sizeof *uv);
    assert_true(angle != NULL && uv != NULL);
    sl_corner_angles(patch, angle);
    sl_status status = SL_OUT_OF_MEMORY;
    int32_t allowed = 0;
    for (; status != SL_OK; allowed++) {
        assert_true(allowed < 2000);
        atomic_store(&countdown, allowed);
        status = use_everything(patch, angle, uv);
        const bool failed = atomic_exchange(&countdown, -1) < 0;
        assert_int_equal(status, failed ? SL_OUT_OF_MEMORY : SL_OK);
    }
    assert_true(allowed > 200);
    sl_patch_free(patch);
    sl_free(angle);
    sl_free(uv);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(allocations_are_counted),
        cmocka_unit_test(no_step_allocates),
        cmocka_unit_test(no_move_of_a_chart_allocates),
        cmocka_unit_test(each_failed_allocation_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
