/* How wide, how many, from where: chosen from the size of the problem and what is asked of it. */
#include "eigen/skeleton.h"

#include <math.h>

/* Matrices up to this order are LAPACK's. */
static const int32_t dense_order = 200;

/* From this order on a solve is bound by reading L, which eight sides share; below, the fewer vectors of narrow blocks
 * win. */
static const int32_t wide_block_order = 100000;

/* The skeleton pays from these orders on. */
static const int32_t skeleton_order_signs = 4000;
static const int32_t skeleton_order_tolerance = 30000;

/* The basis of the whole matrix is kept in single precision where no more than this is asked, and a null space is
 * known: inverse eigenvalues then do not differ by so much that the roundings of the largest drown the smallest. */
static const double least_single_tolerance = 1e-10;

/* lambda_k of a surface's facet graph is about this times k / n (Weyl's law; measured on closed surfaces). */
static const double weyl_slope = 6.5;

/* Measured: patches of m unknowns leave an error of about skeleton_error (lambda m / skeleton_reach)^(3/2) in vectors
 * of eigenvalue lambda after one inverse iteration. */
static const double skeleton_error = 7.5e-4, skeleton_reach = 0.38, skeleton_power = 1.5;

/* Of the allowed error that the patches may use up. */
static const double patch_safety = 0.6;

/* What a second iteration takes the error down by; measured: 5 to 7. */
static const double second_gain = 5.0;

enum { LEAST_PATCH = 16, FAIR_PATCH = 48, MOST_PATCH = 4096 };

static int32_t round_up(int32_t value, int32_t step)
{
    return (value + step - 1) / step * step;
}

static int32_t choose_block(const sl_lanczos *s)
{
    if (s->def.block == 0) {
        return s->n < wide_block_order ? 4 : 8;
    }
    return s->def.block <= 4 ? 4 : s->def.block < SL_KRYLOV_MAX_BLOCK ? round_up(s->def.block, 8) : SL_KRYLOV_MAX_BLOCK;
}

/* The largest patch whose error one inverse iteration brings below what is allowed. */
static double patch_for(double allowed, double lambda)
{
    return skeleton_reach / lambda * pow(patch_safety * fmin(allowed, 1e-2) / skeleton_error, 1.0 / skeleton_power);
}

/* The largest patch that one inverse iteration is enough for, or two where that would be a small one. */
static int32_t choose_patch(const sl_lanczos *s)
{
    const double lambda = weyl_slope * s->count / s->n;
    const double allowed =
        s->def.mode == SL_LANCZOS_SIGNS ? s->def.sign_tolerance : s->def.tolerance * s->norm / lambda;
    double patch = patch_for(allowed, lambda);
    if (patch < LEAST_PATCH) {
        patch = fmin(FAIR_PATCH, patch_for(second_gain * allowed, lambda));
    }
    return (int32_t)fmax(LEAST_PATCH, fmin(MOST_PATCH, patch));
}

static bool choose_skeleton(const sl_lanczos *s)
{
    const int32_t least = s->def.mode == SL_LANCZOS_SIGNS ? skeleton_order_signs : skeleton_order_tolerance;
    const bool start = s->def.start == SL_START_SKELETON || (s->def.start == SL_START_AUTO && s->n >= least);
    return start && s->wanted > 0 && s->n > 20 * (int64_t)s->columns;
}

bool sl_lanczos_choose_basis(sl_lanczos *s)
{
    const int32_t least = s->wanted + 4 * s->block;
    int32_t basis = s->def.max_basis > 0 ? s->def.max_basis : 4 * s->wanted + 8 * s->block;
    basis = round_up(basis > least ? basis : least, SL_PANEL);
    const bool fits = (int64_t)s->null_count + basis + 2 * (int64_t)s->block + SL_PANEL <= s->n;
    s->max_basis = fits ? basis : 0;
    s->info.block = fits ? s->block : 0;
    return fits;
}

void sl_lanczos_choose_sizes(sl_lanczos *s, bool *dense)
{
    s->wanted = s->needed = s->count - s->null_count;
    s->block = choose_block(s);
    *dense = s->n <= dense_order || !sl_lanczos_choose_basis(s);
    s->columns = round_up(s->wanted + 3, SL_PANEL);
    const bool skeleton = !*dense && choose_skeleton(s);
    if (skeleton) {
        s->info.patch = s->def.patch > 0 ? s->def.patch : choose_patch(s);
    }
    s->info.block = *dense ? 0 : s->block;
    const bool single = s->def.tolerance >= least_single_tolerance && s->null_count > 0 && s->def.max_basis == 0;
    s->precision = single ? SL_SINGLE : SL_DOUBLE;
    s->stage = s->wanted == 0 ? SL_STAGE_CERTIFY : skeleton ? SL_STAGE_SKELETON : SL_STAGE_KRYLOV;
}

static int64_t larger(int64_t a, int64_t b)
{
    return a > b ? a : b;
}

int64_t sl_lanczos_estimate(const sl_lanczos *s, bool dense)
{
    const int64_t n = s->n, real = sizeof(double), index = sizeof(int32_t), entries = s->A->colptr[s->n];
    if (dense) {
        return real * (2 * n * n + 2 * n * s->count);
    }
    const int64_t ordering = 16 * index * n + 4 * index * entries;
    if (s->factor == NULL) { /* before the analysis: L has at least A's entries */
        return ordering + real * entries + sl_panels_bytes(n, s->columns, SL_DOUBLE) + real * n * s->null_count;
    }
    const int64_t factor = real * sl_cholesky_nnz(s->factor) + 6 * index * n + 3 * index * entries;
    const int64_t held = factor + real * (n * s->null_count + sl_cholesky_block_work_size(s->factor, SL_PANEL));
    const int64_t vectors = sl_panels_bytes(n, s->columns, SL_DOUBLE), panel = real * SL_PANEL * n;
    const int64_t rows = (2 * entries - n) * (real + index) + real * n;
    const int64_t top = n - sl_cholesky_top_first(s->factor);
    const bool skeleton = s->stage == SL_STAGE_SKELETON;
    const int64_t basis = skeleton ? sl_krylov_bytes(top, s->null_count, SL_PANEL, s->max_basis, SL_SINGLE)
                                   : sl_krylov_bytes(n, s->null_count, s->block, s->max_basis, s->precision);
    const int64_t patches =
        skeleton ? vectors + panel + sl_panels_bytes(top, s->columns + SL_MODES_BEYOND, SL_SINGLE) : 0;
    const int64_t ritz = vectors + rows + (skeleton ? panel : 0);
    return held + larger(basis, larger(patches, ritz));
}
