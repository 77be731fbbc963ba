#include "matrices.h"

#include "sparse/kernels.h"

/* One front: L is drawn at random, its rows dominated by their diagonals; A = L S L' to start from. */
typedef struct front_case {
    int32_t width, below;
    int64_t panel_size, update_size;
    double *L;    /* (width + below) x width, row by row, upper part zero */
    int8_t *sign; /* width, NULL for LL' */
    double *panel, *U, *spare;
} front_case;

static int64_t place(const front_case *f, int32_t i, int32_t k)
{
    return i < f->width ? sl_own_place(f->width, i, k)
                        : sl_own_size(f->width) + sl_below_place(f->width, f->below, i - f->width, k);
}

static void load_panel(front_case *f)
{
    memset(f->panel, 0, (size_t)f->panel_size * sizeof *f->panel);
    for (int32_t i = 0; i < f->width + f->below; i++) {
        for (int32_t k = 0; k < f->width && k <= i; k++) {
            double a = 0.0;
            for (int32_t j = 0; j <= k; j++) {
                a += f->L[(int64_t)i * f->width + j] * f->L[(int64_t)k * f->width + j] *
                     (f->sign != NULL ? f->sign[j] : 1);
            }
            f->panel[place(f, i, k)] = a;
        }
    }
}

static front_case front_create(int32_t width, int32_t below, bool is_signed, test_rng *rng)
{
    front_case f = {.width = width, .below = below};
    f.panel_size = sl_own_size(width) + (int64_t)width * below;
    f.update_size = sl_packed_size(below);
    f.L = sl_calloc((int64_t)(width + below) * width, sizeof *f.L);
    f.sign = is_signed ? sl_alloc(width, sizeof *f.sign) : NULL;
    f.panel = sl_alloc(f.panel_size, sizeof *f.panel);
    f.U = sl_alloc(f.update_size, sizeof *f.U);
    f.spare = sl_alloc(sl_front_spare(width), sizeof *f.spare);
    assert_true(f.L && f.panel && f.U && f.spare && (f.sign || !is_signed));
    for (int32_t i = 0; i < width + below; i++) {
        for (int32_t k = 0; k < width && k <= i; k++) {
            const double entry = test_uniform(rng, -1.0, 1.0) / sqrt(width);
            f.L[(int64_t)i * width + k] = i == k ? test_uniform(rng, 1.0, 2.0) : entry;
        }
    }
    for (int32_t k = 0; k < width && is_signed; k++) {
        f.sign[k] = test_index(rng, 3) == 0 ? -1 : 1;
    }
    load_panel(&f);
    return f;
}

static void front_free(front_case *f)
{
    sl_free(f->L);
    sl_free(f->sign);
    sl_free(f->panel);
    sl_free(f->U);
    sl_free(f->spare);
}

/* signs go to `sign` (NULL for LL'). Returns the bad column. */
static int32_t factor(const sl_kernels *kernels, front_case *f, sl_pivoting pivoting, int8_t *sign)
{
    int32_t bad = -1;
    memset(f->spare, 0x7f, (size_t)sl_front_spare(f->width) * sizeof *f->spare);
    kernels->open(f->panel, f->width, f->below, f->spare);
    for (int32_t begin = 0; begin < f->width && bad == -1; begin += SL_KERNEL_DEPTH) {
        bad = kernels->columns(f->panel, f->width, f->below, begin, pivoting, sign, f->spare);
        const int32_t pairs = sl_trail_pairs(f->width, f->below, begin);
        if (bad == -1) {
            kernels->trail(f->panel, f->width, f->below, begin, sign, f->spare, pairs / 2, pairs);
            kernels->trail(f->panel, f->width, f->below, begin, sign, f->spare, 0, pairs / 2);
        }
    }
    kernels->close(f->panel, f->width, f->below, f->spare);
    if (bad == -1) {
        const int32_t pairs = sl_slab_pairs(f->below);
        memset(f->U, 0x7f, (size_t)f->update_size * sizeof *f->U); /* has no meaning yet */
        kernels->update(f->panel, f->width, f->below, sign, f->spare, pairs / 3, pairs, f->U);
        kernels->update(f->panel, f->width, f->below, sign, f->spare, 0, pairs / 3, f->U);
    }
    return bad;
}

static void check_factor(const front_case *f, const int8_t *sign, double tol)
{
    const int32_t width = f->width;
    for (int32_t i = 0; i < width + f->below; i++) {
        for (int32_t k = 0; k < width && k <= i; k++) {
            const double l = f->panel[place(f, i, k)], want = f->L[(int64_t)i * width + k];
            const double flip = sign != NULL && sign[k] != f->sign[k] ? NAN : 1.0;
            assert_true(test_near(i == k ? 1.0 / l : l, want * flip, tol));
        }
    }
    for (int32_t i = 0; i < f->below; i++) {
        for (int32_t j = 0; j <= i; j++) {
            double u = 0.0;
            for (int32_t k = 0; k < width; k++) {
                u -= f->L[(int64_t)(width + i) * width + k] * f->L[(int64_t)(width + j) * width + k] *
                     (sign != NULL ? sign[k] : 1);
            }
            assert_true(test_near(f->U[sl_packed_size(i) + j], u, tol));
        }
    }
}

static int32_t random_size(test_rng *rng, int32_t trial, int32_t largest)
{
    return 1 + test_index(rng, trial % 7 == 0 ? largest : trial % 2 == 0 ? 40 : 9);
}

static void panels_are_factored_back_to_what_they_were_made_of(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xfac7);
    const sl_pivoting strict = {1e-6, 0.0};
    for (int32_t trial = 0; trial < 150 * test_multiplier(); trial++) {
        const int32_t width = random_size(&rng, trial, 300), below = random_size(&rng, trial / 3, 90) - 1;
        front_case f = front_create(width, below, trial % 3 == 0, &rng);
        for (int32_t k = 0; sl_kernels_at(k) != NULL; k++) {
            int8_t *sign = f.sign != NULL ? sl_alloc(width, sizeof *sign) : NULL;
            load_panel(&f);
            assert_int_equal(factor(sl_kernels_at(k), &f, strict, sign), -1);
            check_factor(&f, sign, 1e-9);
            sl_free(sign);
        }
        front_free(&f);
    }
}

static void a_bad_pivot_is_found_or_replaced(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xbad9);
    for (int32_t trial = 0; trial < 60 * test_multiplier(); trial++) {
        const int32_t width = random_size(&rng, trial, 200);
        front_case f = front_create(width, 11, false, &rng);
        const int32_t bad = test_index(&rng, width);
        const double l = f.L[(int64_t)bad * width + bad];
        for (int32_t k = 0; sl_kernels_at(k) != NULL; k++) {
            int8_t sign[200];
            load_panel(&f);
            f.panel[place(&f, bad, bad)] -= 1.5 * l * l; /* its pivot: -l^2 / 2 */
            assert_int_equal(factor(sl_kernels_at(k), &f, (sl_pivoting){0.0, 0.0}, NULL), bad);
            load_panel(&f);
            f.panel[place(&f, bad, bad)] -= 1.5 * l * l;
            assert_int_equal(factor(sl_kernels_at(k), &f, (sl_pivoting){0.0, 0.0}, sign), -1);
            for (int32_t j = 0; j <= bad; j++) {
                assert_int_equal(sign[j], j == bad ? -1 : 1);
            }
            load_panel(&f);
            f.panel[place(&f, bad, bad)] = NAN;
            assert_int_equal(factor(sl_kernels_at(k), &f, (sl_pivoting){0.0, 0.0}, sign), bad);
            load_panel(&f);
            f.panel[place(&f, bad, bad)] -= l * l * (1.0 - 1e-8); /* 1e-8 l^2 is left */
            assert_int_equal(factor(sl_kernels_at(k), &f, (sl_pivoting){1e-3, 0.25}, NULL), -1);
            assert_true(test_near(f.panel[place(&f, bad, bad)], 2.0, 1e-12));
        }
        front_free(&f);
    }
}

/* n = width + below rows of X in a random order, some of those below outside. */
typedef struct solve_case {
    int32_t n, w, own, outside_count;
    int32_t *row;
    double *X, *outside;
} solve_case;

static solve_case solve_create(const front_case *f, int32_t w, test_rng *rng)
{
    solve_case c = {.n = f->width + f->below + 5, .w = w, .own = test_index(rng, 5)};
    c.row = sl_alloc(f->below, sizeof *c.row);
    c.X = random_doubles((int64_t)c.n * w, rng);
    c.outside = random_doubles((int64_t)(f->below + 1) * w, rng);
    assert_non_null(c.row);
    for (int32_t i = 0; i < f->below; i++) {
        const int32_t first_after = c.own + f->width;
        const int32_t inside = i < 5 - c.own ? first_after + i : i - (5 - c.own) < c.own ? i - (5 - c.own) : -1;
        c.row[i] = inside >= 0 && test_index(rng, 2) == 0 ? inside : -1 - c.outside_count++;
    }
    return c;
}

static void solve_free(solve_case *c)
{
    sl_free(c->row);
    sl_free(c->X);
    sl_free(c->outside);
}

static double *row_of(const solve_case *c, double *X, double *outside, int32_t r)
{
    return r >= 0 ? X + (int64_t)r * c->w : outside + (int64_t)(-1 - r) * c->w;
}

/* The definition, from the dense L. */
static void solve_plainly(const front_case *f, const solve_case *c, bool is_forward, double *X, double *outside)
{
    const int32_t width = f->width, w = c->w;
    for (int32_t s = 0; s < w; s++) {
        for (int32_t t = 0; t < width; t++) {
            const int32_t k = is_forward ? t : width - 1 - t;
            double *x = X + (int64_t)(c->own + k) * w + s;
            for (int32_t i = 0; i < f->below && !is_forward; i++) {
                *x -= f->L[(int64_t)(width + i) * width + k] * row_of(c, X, outside, c->row[i])[s];
            }
            for (int32_t j = is_forward ? 0 : k + 1; j < (is_forward ? k : width); j++) {
                const double l = is_forward ? f->L[(int64_t)k * width + j] : f->L[(int64_t)j * width + k];
                *x -= l * X[(int64_t)(c->own + j) * w + s];
            }
            *x /= f->L[(int64_t)k * width + k];
        }
        for (int32_t i = 0; i < f->below && is_forward; i++) {
            for (int32_t k = 0; k < width; k++) {
                row_of(c, X, outside, c->row[i])[s] -=
                    f->L[(int64_t)(width + i) * width + k] * X[(int64_t)(c->own + k) * w + s];
            }
        }
    }
}

static void check_solve(const front_case *f, const solve_case *c, bool is_forward)
{
    const int64_t size = (int64_t)c->n * c->w, outside_size = (int64_t)(f->below + 1) * c->w;
    enum { ORIGIN = 3 };
    double *want = sl_copy(c->X, size, sizeof *want), *want_outside = sl_copy(c->outside, outside_size, sizeof *want);
    int32_t *row = sl_copy(c->row, f->below, sizeof *row);
    double *first = NULL, *first_outside = NULL;
    assert_true(want && want_outside && row);
    solve_plainly(f, c, is_forward, want, want_outside);
    const double scale = 1.0 + max_abs(want, size) + max_abs(want_outside, outside_size);
    for (int32_t i = 0; i < f->below; i++) {
        row[i] += row[i] >= 0 ? ORIGIN : 0;
    }
    for (int32_t k = 0; sl_kernels_at(k) != NULL; k++) {
        double *X = sl_copy(c->X, size, sizeof *X), *outside = sl_copy(c->outside, outside_size, sizeof *outside);
        assert_true(X && outside);
        const sl_rows rows = {X, outside, c->w, ORIGIN};
        (is_forward ? sl_kernels_at(k)->forward : sl_kernels_at(k)->backward)(f->panel, f->width, f->below, row,
                                                                              X + (int64_t)c->own * c->w, rows);
        for (int64_t i = 0; i < size; i++) {
            assert_true(test_near(X[i], want[i], 1e-9 * scale));
        }
        for (int64_t i = 0; i < outside_size; i++) {
            assert_true(test_near(outside[i], want_outside[i], 1e-9 * scale));
        }
        if (k == 0) {
            first = X;
            first_outside = outside;
            continue;
        }
        assert_memory_equal(X, first, (size_t)size * sizeof *X);
        assert_memory_equal(outside, first_outside, (size_t)outside_size * sizeof *X);
        sl_free(X);
        sl_free(outside);
    }
    sl_free(want);
    sl_free(want_outside);
    sl_free(row);
    sl_free(first);
    sl_free(first_outside);
}

static void solves_are_those_of_the_dense_factor_in_every_set_to_the_byte(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x501e);
    const sl_pivoting strict = {1e-6, 0.0};
    for (int32_t trial = 0; trial < 200 * test_multiplier(); trial++) {
        const int32_t width = random_size(&rng, trial, 60), below = random_size(&rng, trial / 3, 60) - 1;
        front_case f = front_create(width, below, false, &rng);
        assert_int_equal(factor(sl_kernels_at(0), &f, strict, NULL), -1);
        const int32_t special[] = {8, 1, 4, 12}; /* widths with a form of their own */
        const bool usual = trial % 8 < (int32_t)SL_COUNTOF(special);
        solve_case c = solve_create(&f, usual ? special[trial % 8] : 1 + test_index(&rng, 32), &rng);
        check_solve(&f, &c, true);
        check_solve(&f, &c, false);
        solve_free(&c);
        front_free(&f);
    }
}

static void every_set_factors_to_the_same_bytes(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0xb17e);
    const sl_pivoting strict = {1e-6, 0.0};
    for (int32_t trial = 0; trial < 200 * test_multiplier(); trial++) {
        const int32_t width = random_size(&rng, trial, 300), below = random_size(&rng, trial / 3, 120) - 1;
        front_case f = front_create(width, below, trial % 3 == 0, &rng);
        int8_t *sign = f.sign != NULL ? sl_alloc(width, sizeof *sign) : NULL;
        assert_int_equal(factor(sl_kernels_at(0), &f, strict, sign), -1);
        double *panel = sl_copy(f.panel, f.panel_size, sizeof *panel), *U = sl_copy(f.U, f.update_size, sizeof *U);
        assert_true(panel != NULL && U != NULL);
        for (int32_t k = 1; sl_kernels_at(k) != NULL; k++) {
            load_panel(&f);
            assert_int_equal(factor(sl_kernels_at(k), &f, strict, sign), -1);
            assert_memory_equal(f.panel, panel, (size_t)f.panel_size * sizeof *panel);
            assert_memory_equal(f.U, U, (size_t)f.update_size * sizeof *U);
        }
        sl_free(panel);
        sl_free(U);
        sl_free(sign);
        front_free(&f);
    }
}

static void the_best_set_is_the_last_that_runs(void **state)
{
    (void)state;
    int32_t k = 0;
    while (sl_kernels_at(k + 1) != NULL) {
        k++;
    }
    assert_ptr_equal(sl_kernels_best(), sl_kernels_at(k));
    assert_string_equal(sl_kernels_at(0)->name, "scalar");
    assert_null(sl_kernels_at(k + 2));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(panels_are_factored_back_to_what_they_were_made_of),
        cmocka_unit_test(a_bad_pivot_is_found_or_replaced),
        cmocka_unit_test(solves_are_those_of_the_dense_factor_in_every_set_to_the_byte),
        cmocka_unit_test(every_set_factors_to_the_same_bytes),
        cmocka_unit_test(the_best_set_is_the_last_that_runs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
