/* Inertia counts: by Sylvester's law A - sigma I = L D L' has as many negative pivots as A has eigenvalues below sigma.
 * With m pairs found below sigma and a count of m none is missing (Cauchy: m Ritz values below sigma are m eigenvalues
 * below sigma at least). */
#include "eigen/lanczos_internal.h"

#include <math.h>

/* Values whose relative distance is at most this belong to one cluster. */
static const double cluster_gap = 1e-6;

/* Eigenvalues below this many roundings of ||A|| are zero. */
static const double zero_roundings = 64.0;

/* How far above a cluster, relative to it, the count is made that bounds its size. */
static const double reaches[] = {4e-6, 1e-4, 1e-2};

/* A count above a cluster at zero looks this share of ||A|| up. */
static const double zero_reach = 1e-10;

/* Shares of the gap at which sigma is tried. Beyond the first by the golden section: where eigenvalues are whole
 * numbers (a complete graph) a rational sigma meets one of a leading block exactly, and elimination without pivoting
 * grows. */
static const double shares[] = {0.5, 0.3090169943749474, 0.7236067977499790, 0.9045084971874737};

/* The value from which gaps are measured: no smaller than rounding leaves a zero. */
static double gap_scale(const sl_lanczos *s, double lambda)
{
    return fmax(fabs(lambda), zero_roundings * 0x1p-52 * s->norm / cluster_gap);
}

static bool is_gap(const sl_lanczos *s, double below, double above)
{
    return above - below > cluster_gap * gap_scale(s, below);
}

/* Counts below sigma. *sound: the factorisation's error is less than sigma's distance to `below`, the largest
 * eigenvalue that is to be counted (with its own error). */
static sl_status count_below(sl_lanczos *s, double sigma, double below, int32_t *count, bool *sound)
{
    sl_inertia_info info = {0};
    sl_status status = SL_OK;
    SL_TRY(sl_report_progress(s->context, "certificate", 0.0));
    sl_cholesky_release(s->factor); /* counts need the analysis alone */
    s->released = true;
    SL_TRY(sl_inertia(s->factor, s->A, sigma, s->context, &info));
    s->info.counts++;
    *count = info.negative;
    *sound = info.zero == 0 && info.backward_error < sigma - below;
cleanup:
    return status;
}

/* Other pairs than those found lie below sigma: the solver starts again with a larger block. */
static void restart_wider(sl_lanczos *s)
{
    if (s->block >= SL_KRYLOV_MAX_BLOCK) {
        s->stage = SL_STAGE_DONE;
        return;
    }
    s->block = s->block < SL_PANEL ? SL_PANEL : 2 * s->block;
    s->widest = !sl_lanczos_choose_basis(s);
    s->needed = s->wanted;
    s->info.restarts++;
    s->krylov_live = false;
    s->stage = SL_STAGE_KRYLOV;
}

/* First pair of the cluster that holds pair k. */
static int32_t cluster_first(const sl_lanczos *s, int32_t k)
{
    while (k > 0 && !is_gap(s, s->lambda[k - 1], s->lambda[k])) {
        k--;
    }
    return k;
}

/* The count below the cluster whose lowest pair is `first`: all there must have been found. */
static sl_status count_under_cluster(sl_lanczos *s, int32_t first, bool *sound)
{
    sl_status status = SL_OK;
    const double value = s->lambda[first], below = first > 0 ? s->lambda[first - 1] : 0.0;
    const double error = first > 0 ? s->residual[first - 1] : 0.0;
    *sound = false;
    for (size_t k = 0; k < SL_COUNTOF(shares) && !*sound; k++) {
        s->info.sigma_below = below + shares[k] * (value - below);
        SL_TRY(count_below(s, s->info.sigma_below, below + error, &s->info.count_below, sound));
    }
cleanup:
    return status;
}

/* Two counts for a cluster that X does not hold whole: one just below it, where all must have been found, and one just
 * above, which bounds its size. */
static sl_status certify_cut(sl_lanczos *s)
{
    sl_status status = SL_OK;
    const int32_t first = s->wanted > 0 ? cluster_first(s, s->wanted - 1) : 0;
    const double value = s->wanted > 0 ? s->lambda[s->wanted - 1] : 0.0;
    const bool zeros = first == 0 && (s->wanted == 0 || !is_gap(s, 0.0, s->lambda[0])); /* the cluster is 0's own */
    bool sound = true, sound_above = false;
    s->info.cluster_cut = true;
    s->info.count_below = 0;
    s->info.sigma_below = s->sigma; /* nothing is below: A - sigma I was factored as a positive definite matrix */
    if (!zeros && s->null_count + first > 0) {
        SL_TRY(count_under_cluster(s, first, &sound));
        if (sound && s->info.count_below > s->null_count + first) {
            restart_wider(s);
            return SL_OK;
        }
        sound = sound && s->info.count_below == s->null_count + first;
    }
    for (size_t k = 0; k < SL_COUNTOF(reaches) && !sound_above; k++) {
        s->info.sigma = value + fmax(reaches[k] * fabs(value), zero_reach * s->norm);
        SL_TRY(count_below(s, s->info.sigma, value, &s->info.count, &sound_above));
    }
    s->info.certified = sound && sound_above && s->info.count >= s->count;
    s->stage = SL_STAGE_DONE;
cleanup:
    return status;
}

/* One count in the gap above the pairs needed. *settled: the next stage is decided. */
static sl_status try_gap(sl_lanczos *s, double share, bool *settled)
{
    sl_status status = SL_OK;
    const int32_t m = s->needed;
    const double below = s->lambda[m - 1] + s->residual[m - 1];
    const double guard = s->lambda[m] - s->residual[m];
    const double above = guard > below ? guard : s->lambda[m];
    const double sigma = s->lambda[m - 1] + share * (above - s->lambda[m - 1]);
    const int32_t expected = s->null_count + m;
    int32_t count = 0;
    bool sound = false;
    SL_TRY(count_below(s, sigma, below, &count, &sound));
    *settled = sound && count >= expected;
    if (!*settled) {
        return SL_OK;
    }
    s->info.sigma = sigma;
    s->info.count = count;
    s->info.certified = count == expected;
    s->stage = SL_STAGE_DONE;
    if (count > expected) {
        const bool guard_may_fall = s->lambda[m] - s->residual[m] <= sigma && count - s->null_count < s->columns;
        if (guard_may_fall && !s->extended) { /* guards not yet converged belong below sigma: let them */
            s->extended = true;
            s->needed = count - s->null_count;
            s->stage = SL_STAGE_ITERATE;
        } else {
            restart_wider(s);
        }
    }
cleanup:
    return status;
}

sl_status sl_lanczos_certify(sl_lanczos *s)
{
    sl_status status = SL_OK;
    bool settled = false;
    s->stage = SL_STAGE_DONE;
    if (!s->def.certify) {
        return SL_OK;
    }
    while (s->wanted > 0 && s->needed < s->columns && !is_gap(s, s->lambda[s->needed - 1], s->lambda[s->needed])) {
        s->needed++;
        if (sl_lanczos_worst(s) > 1.0) { /* the rest of the cluster has to converge as well */
            s->stage = SL_STAGE_ITERATE;
            return SL_OK;
        }
    }
    if (s->needed >= s->columns || s->wanted == 0) {
        return certify_cut(s);
    }
    for (size_t k = 0; k < SL_COUNTOF(shares) && !settled; k++) {
        SL_TRY(try_gap(s, shares[k], &settled));
    }
cleanup:
    return status;
}
