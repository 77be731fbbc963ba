/* The matrices of ABF++ to look at. */
#include "base/memory.h"
#include "param/abf_solver_internal.h"

sl_abf_sizes sl_abf_sizes_of(const sl_abf *solver)
{
    const sl_abf_system *system = &solver->system;
    const int32_t nt = solver->patch->nt;
    sl_abf_sizes sizes = {.angles = 3 * nt,
                          .triangles = nt,
                          .sectors = system->nsectors,
                          .wheels = system->nrows - system->nsectors,
                          .jacobian_nonzeros = 3 * (int64_t)nt + solver->sectors.first[system->nsectors],
                          .schur_nonzeros = system->M->colptr[system->nrows],
                          .factor_nonzeros = sl_cholesky_nnz(solver->factor),
                          .schur_rows = system->nrows};
    for (int64_t c = 0; c < 3 * (int64_t)nt; c++) { /* each corner of a wheel has two entries in its row */
        sizes.jacobian_nonzeros += system->wheel_row[solver->patch->tri[c]] >= 0 ? 2 : 0;
    }
    return sizes;
}

const sl_csc *sl_abf_schur(const sl_abf *solver)
{
    return solver->system.M;
}

/* Rows of J that angle c is in: one of g1, its sectors, the wheels of the two other vertices. */
static void fill_triplets(const sl_abf *solver, int32_t *row, int32_t *col, double *val)
{
    const sl_abf_system *system = &solver->system;
    const sl_patch *patch = solver->patch;
    int64_t at = 0;
    for (int32_t c = 0; c < 3 * patch->nt; c++, at++) {
        row[at] = c / 3;
        col[at] = c;
        val[at] = 1.0;
    }
    for (int32_t s = 0; s < system->nsectors; s++) {
        for (int32_t p = solver->sectors.first[s]; p < solver->sectors.first[s + 1]; p++, at++) {
            row[at] = patch->nt + s;
            col[at] = solver->sectors.corner[p];
            val[at] = 1.0;
        }
    }
    for (int32_t c = 0; c < 3 * patch->nt; c++) {
        const int64_t p = system->wheel_entry[c];
        for (int k = 1; k < 3 && p >= 0; k++, at++) {
            const int other = (c + k) % 3;
            row[at] = patch->nt + system->row[p];
            col[at] = c / 3 * 3 + other;
            val[at] = system->coeff[3 * p + other];
        }
    }
}

sl_status sl_abf_jacobian(const sl_abf *solver, sl_csc **out)
{
    sl_status status = SL_OUT_OF_MEMORY;
    const int64_t count = sl_abf_sizes_of(solver).jacobian_nonzeros;
    int32_t *row = sl_alloc(count, sizeof *row), *col = sl_alloc(count, sizeof *col);
    double *val = sl_alloc(count, sizeof *val);
    *out = NULL;
    if (row == NULL || col == NULL || val == NULL) {
        goto cleanup;
    }
    fill_triplets(solver, row, col, val);
    status = sl_csc_from_triplets(solver->patch->nt + solver->system.nrows, 3 * solver->patch->nt, count, row, col, val,
                                  out);
cleanup:
    sl_free(row);
    sl_free(col);
    sl_free(val);
    return status;
}

sl_abf_view sl_abf_view_of(const sl_abf *solver)
{
    return (sl_abf_view){solver->lambda1, solver->lambda2, solver->gradient, solver->phi,
                         solver->w,       solver->hessian, &solver->system};
}
