/* Values of the Jacobian and of the Schur complement of ABF++. */
#include <math.h>
#include <string.h>

#include "geom/vec3.h"
#include "param/abf_internal.h"

/* What each side of a wheel's gradient is multiplied by: the gradient of the product form is the log form's with each
 * side times its product of sines, that of the ratio form the log form's times the quotient of the two. */
static void scale_wheels(sl_abf_system *system, sl_abf_wheel wheel)
{
    const sl_patch *patch = system->patch;
    const int32_t base = system->nsectors, wheels = system->nrows - base;
    for (int64_t i = 0; i < 2 * (int64_t)wheels; i++) {
        system->wheel_scale[i] = 1.0;
    }
    if (wheel == SL_ABF_LOG) {
        return;
    }
    for (int32_t c = 0; c < 3 * patch->nt; c++) {
        const int32_t row = system->wheel_row[patch->tri[c]];
        if (row >= 0) {
            double *scale = &system->wheel_scale[2 * ((int64_t)row - base)];
            const double next = system->sine[sl_corner_next(c)], prev = system->sine[sl_corner_prev(c)];
            scale[0] *= wheel == SL_ABF_PRODUCT ? next : next / prev;
            scale[1] *= wheel == SL_ABF_PRODUCT ? prev : next / prev;
        }
    }
}

void sl_abf_system_linearise(sl_abf_system *system, sl_abf_wheel wheel, const double *alpha)
{
    for (int64_t c = 0; c < 3 * (int64_t)system->patch->nt; c++) {
        system->sine[c] = sin(alpha[c]);
        system->cot[c] = cos(alpha[c]) / system->sine[c];
    }
    scale_wheels(system, wheel);
    for (int32_t t = 0; t < system->patch->nt; t++) {
        const double *cot = &system->cot[3 * (int64_t)t];
        const int64_t *entry = &system->wheel_entry[3 * (int64_t)t];
        for (int k = 0; k < 3; k++) {
            for (int j = 0; j < 3 && entry[k] >= 0; j++) {
                system->coeff[3 * entry[k] + j] = 0.0;
            }
        }
        for (int k = 0; k < 3; k++) {
            if (entry[k] >= 0) {
                const int next = (k + 1) % 3, prev = (k + 2) % 3;
                const double *scale = &system->wheel_scale[2 * (int64_t)(system->row[entry[k]] - system->nsectors)];
                system->coeff[3 * entry[k] + next] += cot[next] * scale[0];
                system->coeff[3 * entry[k] + prev] -= cot[prev] * scale[1];
            }
        }
    }
}

void sl_abf_system_assemble(sl_abf_system *system, const double *Lambda)
{
    double *val = system->M->val;
    memset(val, 0, (size_t)system->M->colptr[system->nrows] * sizeof *val);
    for (int32_t i = 0; i < system->ndropped; i++) {
        val[system->M->colptr[system->dropped[i]]] = 1.0;
    }
    for (int32_t t = 0; t < system->patch->nt; t++) {
        const double *Lambda_t = &Lambda[3 * (int64_t)t];
        const double inverse_det = sl_abf_inverse_det(Lambda_t);
        const double *coeff = &system->coeff[3 * system->first[t]];
        const int64_t m = system->first[t + 1] - system->first[t];
        const int64_t *slot = &system->slot[system->slot_first[t]];
        for (int64_t i = 0; i < m; i++) {
            double y[3];
            sl_abf_project(Lambda_t, inverse_det, &coeff[3 * i], y);
            for (int64_t j = 0; j <= i; j++) {
                val[*slot++] += sl_vec3_dot(&coeff[3 * j], y);
            }
        }
    }
}

void sl_abf_system_apply_transposed(const sl_abf_system *system, const double *y, double *out)
{
    for (int32_t t = 0; t < system->patch->nt; t++) {
        double *o = &out[3 * (int64_t)t];
        for (int64_t p = system->first[t]; p < system->first[t + 1]; p++) {
            const double *c = &system->coeff[3 * p], value = y[system->row[p]];
            o[0] += c[0] * value;
            o[1] += c[1] * value;
            o[2] += c[2] * value;
        }
    }
}

void sl_abf_system_subtract(const sl_abf_system *system, const double *x, double *out)
{
    for (int32_t t = 0; t < system->patch->nt; t++) {
        for (int64_t p = system->first[t]; p < system->first[t + 1]; p++) {
            out[system->row[p]] -= sl_vec3_dot(&system->coeff[3 * p], &x[3 * (int64_t)t]);
        }
    }
}

void sl_abf_system_points(const sl_abf_system *system, double *xyz)
{
    const sl_patch *patch = system->patch;
    for (int32_t s = 0; s < system->nsectors; s++) {
        const int32_t v = patch->tri[system->sectors->corner[system->sectors->first[s]]];
        memcpy(&xyz[3 * (int64_t)s], &patch->xyz[3 * (int64_t)v], 3 * sizeof *xyz);
    }
    for (int32_t v = 0; v < patch->nv; v++) {
        if (system->wheel_row[v] >= 0) {
            memcpy(&xyz[3 * (int64_t)system->wheel_row[v]], &patch->xyz[3 * (int64_t)v], 3 * sizeof *xyz);
        }
    }
}
