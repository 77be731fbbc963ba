/* Conformal layout by normal equations. With U = x + i y the energy is U* H U and
 *
 *     H[j][k] = sum over triangles of conj(W_j) W_k / (2 A):  real part the cotangent Laplacian, imaginary part +1 at
 *     border halfedges j -> k, -1 at k -> j, 0 elsewhere (the two sides of an inner edge cancel).
 *
 * So x and y meet at the border only, and the real matrix [R -S; S R] has half the entries of a general one. Solved by
 * Cholesky and refined with residuals taken triangle by triangle: corrected seminormal equations, as accurate as QR.
 * Source: Levy et al. 2002; Bjorck 1987, "Stability analysis of the method of seminormal equations". */
#include "param/reconstruct.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "geom/predicates.h"
#include "geom/vec3.h"
#include "param/abf.h"
#include "param/reconstruct_internal.h"
#include "param/reconstruct_system_internal.h"
#include "sparse/cholesky.h"

static const double pi = 3.14159265358979323846;
static const double smallest_angle = 1e-6; /* [rad]: 0 would have an infinite cotangent */
static const int max_solves = 8;
static const double refined = 4.0 * 0x1p-52; /* a correction this small, relative to uv, is the last */
static const double worthwhile = 0.5;        /* corrections must shrink by this factor */

/* Angles fit for the cotangents: at least smallest_angle, sum pi. The excess of a clamped triangle is taken from its
 * largest angle where that leaves something, any other deviation is shared in proportion. */
static void fit_angles(const double angle[3], double out[3])
{
    bool clamped = false;
    int largest = 0;
    for (int k = 0; k < 3; k++) {
        const bool large_enough = angle[k] >= smallest_angle; /* false for a NaN */
        clamped = clamped || !large_enough;
        out[k] = large_enough ? fmin(angle[k], pi) : smallest_angle;
        largest = out[k] > out[largest] ? k : largest;
    }
    const double others = out[(largest + 1) % 3] + out[(largest + 2) % 3], sum = others + out[largest];
    if (clamped && pi - others >= smallest_angle) {
        out[largest] = pi - others;
        return;
    }
    for (int k = 0; k < 3; k++) {
        out[k] *= pi / sum;
    }
}

/* Cotangents and the numbers W_k / sqrt(2 A), from the law of sines: edges sin(angle), 2 A = product of the sines. */
static void shape_triangle(const double angle[3], double cot[3], double w[6])
{
    double a[3], s[3];
    fit_angles(angle, a);
    for (int k = 0; k < 3; k++) {
        s[k] = sin(a[k]);
        cot[k] = cos(a[k]) / s[k];
    }
    const double scale = 1.0 / sqrt(s[0] * s[1] * s[2]);
    const double z1 = s[2] * scale, z2[2] = {s[1] * cos(a[0]) * scale, s[1] * s[0] * scale};
    w[0] = z2[0] - z1;
    w[1] = z2[1];
    w[2] = -z2[0];
    w[3] = -z2[1];
    w[4] = z1;
    w[5] = 0.0;
}

/* rhs = - half the gradient of E at uv, for the free vertices. */
static void residual(const sl_layout *layout, const double *uv, double *rhs)
{
    memset(rhs, 0, 2 * (size_t)layout->nfree * sizeof *rhs);
    for (int32_t t = 0; t < layout->patch->nt; t++) {
        const int32_t *v = &layout->patch->tri[3 * (int64_t)t];
        const double *w = &layout->w[6 * (int64_t)t];
        double re = 0.0, im = 0.0;
        for (int k = 1; k < 3; k++) { /* W_0 = - W_1 - W_2: differences lose nothing */
            const double x = uv[2 * (int64_t)v[k]] - uv[2 * (int64_t)v[0]];
            const double y = uv[2 * (int64_t)v[k] + 1] - uv[2 * (int64_t)v[0] + 1];
            re += w[2 * k] * x - w[2 * k + 1] * y;
            im += w[2 * k] * y + w[2 * k + 1] * x;
        }
        for (int k = 0; k < 3; k++) {
            const int64_t f = layout->unknown[v[k]];
            if (f >= 0) {
                rhs[2 * f] -= w[2 * k] * re + w[2 * k + 1] * im;
                rhs[2 * f + 1] -= w[2 * k] * im - w[2 * k + 1] * re;
            }
        }
    }
}

/* Adds the corrections; returns the largest, and the largest coordinate in *size. */
static double correct(const sl_layout *layout, const double *delta, double *uv, double *size)
{
    double largest = 0.0;
    *size = 0.0;
    for (int32_t v = 0; v < layout->patch->nv; v++) {
        const int64_t f = layout->unknown[v];
        for (int k = 0; k < 2; k++) {
            if (f >= 0) {
                uv[2 * (int64_t)v + k] += delta[2 * f + k];
                largest = fabs(delta[2 * f + k]) <= largest ? largest : fabs(delta[2 * f + k]); /* keeps a NaN */
            }
            *size = fmax(*size, fabs(uv[2 * (int64_t)v + k]));
        }
    }
    return largest;
}

/* Connected and with two pins the matrix is positive definite: a pivot that is not is lost in rounding. */
static sl_status factor_or_singular(sl_cholesky *factor, const sl_csc *A)
{
    const sl_status status = sl_cholesky_factor(factor, A, NULL);
    return status == SL_NOT_POSITIVE_DEFINITE || status == SL_BAD_INPUT ? SL_SINGULAR : status;
}

struct sl_reconstruct {
    sl_layout layout;
    sl_csc *A;
    sl_cholesky *factor;
    double length;      /* between the two pins */
    double *rhs, *work; /* 2 nfree, and of the solve */
    double *uv;         /* 2 nv: so that a failure leaves the caller's alone */
};

static sl_status refine(sl_reconstruct *r)
{
    double last = INFINITY;
    for (int i = 0; i < max_solves; i++) {
        double size;
        residual(&r->layout, r->uv, r->rhs);
        sl_cholesky_solve(r->factor, r->rhs, 1, r->work);
        const double change = correct(&r->layout, r->rhs, r->uv, &size);
        if (!isfinite(change)) {
            return SL_SINGULAR;
        }
        if (change <= refined * size || change > worthwhile * last) {
            break;
        }
        last = change;
    }
    return SL_OK;
}

/* To the 3D area; left as it is where either area vanishes. */
static void scale_to_area(const sl_patch *patch, double *uv)
{
    double area = 0.0, area_uv = 0.0;
    for (int32_t t = 0; t < patch->nt; t++) {
        const int32_t *v = &patch->tri[3 * (int64_t)t];
        const double *a = &uv[2 * (int64_t)v[0]], *b = &uv[2 * (int64_t)v[1]], *c = &uv[2 * (int64_t)v[2]];
        area += sl_patch_triangle_area(patch, t);
        area_uv += fabs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2.0;
    }
    const double scale = sqrt(area / area_uv);
    for (int64_t i = 0; i < 2 * (int64_t)patch->nv && scale > 0.0 && isfinite(scale); i++) {
        uv[i] *= scale;
    }
}

static sl_status analyze(sl_reconstruct *r)
{
    sl_status status = SL_OK;
    int32_t *perm = sl_alloc(2 * (int64_t)r->layout.nfree, sizeof *perm);
    if (perm == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    SL_TRY(sl_layout_pattern(&r->layout, &r->A));
    SL_TRY(sl_layout_order(&r->layout, r->A, perm));
    sl_cholesky_def def = sl_cholesky_default();
    def.perm = perm;
    SL_TRY(sl_cholesky_analyze(r->A, &def, &r->factor));
    SL_TRY(sl_cholesky_reserve(r->factor)); /* sl_reconstruct_solve allocates nothing */
    r->rhs = sl_alloc(2 * (int64_t)r->layout.nfree, sizeof *r->rhs);
    r->work = sl_alloc(sl_cholesky_work_size(r->factor, 1), sizeof *r->work);
    r->uv = sl_alloc(2 * (int64_t)r->layout.patch->nv, sizeof *r->uv);
    status = r->rhs == NULL || r->work == NULL || r->uv == NULL ? SL_OUT_OF_MEMORY : SL_OK;
cleanup:
    sl_free(perm);
    return status;
}

sl_status sl_reconstruct_create(const sl_patch *patch, sl_reconstruct **out)
{
    sl_status status = SL_OK;
    *out = NULL;
    sl_reconstruct *r = sl_calloc(1, sizeof *r);
    if (r == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    SL_TRY(sl_layout_init(&r->layout, patch));
    SL_TRY(analyze(r));
    const int32_t *pin = r->layout.pin;
    r->length = sl_vec3_distance(&patch->xyz[3 * (int64_t)pin[0]], &patch->xyz[3 * (int64_t)pin[1]]);
    r->length = r->length > 0.0 ? r->length : 1.0;
    *out = r;
    r = NULL;
cleanup:
    sl_reconstruct_free(r);
    return status;
}

sl_status sl_reconstruct_solve(sl_reconstruct *r, const double *angle, const sl_context *context, double *uv)
{
    sl_status status = SL_OK;
    const sl_patch *patch = r->layout.patch;
    const size_t size = 2 * (size_t)patch->nv * sizeof *uv;
    for (int32_t t = 0; t < patch->nt; t++) {
        shape_triangle(&angle[3 * (int64_t)t], &r->layout.cot[3 * (int64_t)t], &r->layout.w[6 * (int64_t)t]);
    }
    memset(r->uv, 0, size);
    r->uv[2 * (int64_t)r->layout.pin[1]] = r->length;
    sl_layout_fill(&r->layout, r->A);
    SL_TRY(sl_report_progress(context, "layout", 0.5));
    SL_TRY(factor_or_singular(r->factor, r->A));
    SL_TRY(refine(r));
    scale_to_area(patch, r->uv);
    memcpy(uv, r->uv, size);
cleanup:
    return status;
}

void sl_reconstruct_free(sl_reconstruct *r)
{
    if (r == NULL) {
        return;
    }
    sl_layout_clear(&r->layout);
    sl_csc_free(r->A);
    sl_cholesky_free(r->factor);
    sl_free(r->rhs);
    sl_free(r->work);
    sl_free(r->uv);
    sl_free(r);
}

static double corner_angle(const double *p, const double *q, const double *r)
{
    const double a[2] = {q[0] - p[0], q[1] - p[1]}, b[2] = {r[0] - p[0], r[1] - p[1]};
    return atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
}

sl_layout_quality sl_layout_judge(const sl_patch *patch, const double *angle, const double *uv)
{
    sl_layout_quality quality = {0};
    double least = INFINITY, most = 0.0;
    for (int32_t t = 0; t < patch->nt; t++) {
        const double *p[3];
        for (int k = 0; k < 3; k++) {
            p[k] = &uv[2 * (int64_t)patch->tri[3 * (int64_t)t + k]];
        }
        quality.flipped += sl_orient2d(p[0], p[1], p[2]) <= 0;
        for (int k = 0; k < 3; k++) {
            const double error = corner_angle(p[k], p[(k + 1) % 3], p[(k + 2) % 3]) - angle[3 * (int64_t)t + k];
            quality.angle_error = fabs(error) <= quality.angle_error ? quality.angle_error : fabs(error);
        }
        const double flat = fabs((p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]));
        const double ratio = flat / (2.0 * sl_patch_triangle_area(patch, t));
        if (ratio > 0.0 && isfinite(ratio)) {
            least = fmin(least, ratio);
            most = fmax(most, ratio);
        }
    }
    quality.area_ratio = most > 0.0 ? most / least : 1.0;
    return quality;
}

sl_status sl_conformal_layout(const sl_patch *patch, const double *angle, const sl_context *context, double *uv)
{
    sl_status status = SL_OK;
    sl_reconstruct *r = NULL;
    SL_TRY(sl_report_progress(context, "layout", 0.0));
    SL_TRY(sl_reconstruct_create(patch, &r));
    SL_TRY(sl_reconstruct_solve(r, angle, context, uv));
cleanup:
    sl_reconstruct_free(r);
    return status;
}

sl_status sl_abf_reconstruct(const sl_patch *patch, const double *alpha, const sl_context *context, double *uv)
{
    return sl_conformal_layout(patch, alpha, context, uv);
}
