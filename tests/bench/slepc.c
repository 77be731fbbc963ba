/* SLEPc's Krylov-Schur solver, shift-invert through PETSc's interfaces to sparse Cholesky factorisations. */
#include "base/memory.h"
#include "bench/solvers.h"

#include <slepceps.h>
#include <string.h>

typedef struct slepc {
    const char *package;
    Mat A;
    Vec x;
    EPS eps;
    const double *borrowed;
    double *copy;
    int32_t n, pairs;
} slepc;

/* Both triangles, which PETSc's AIJ format holds. The arrays belong to the matrix until the process ends. */
static Mat full_matrix(const sl_csc *L)
{
    Mat A = NULL;
    const int32_t n = L->ncols;
    const int64_t nnz = 2 * L->colptr[n] - n;
    PetscInt *first = sl_calloc((int64_t)n + 2, sizeof *first), *col = sl_alloc(nnz, sizeof *col);
    PetscScalar *val = sl_alloc(nnz, sizeof *val);
    if (first == NULL || col == NULL || val == NULL) {
        return NULL;
    }
    for (int32_t j = 0; j < n; j++) {
        for (int64_t p = L->colptr[j]; p < L->colptr[j + 1]; p++) {
            first[L->row[p] + 2]++;
            first[j + 2] += L->row[p] != j ? 1 : 0;
        }
    }
    for (int32_t i = 0; i < n; i++) {
        first[i + 2] += first[i + 1];
    }
    /* Columns in order: row i first receives its columns below i, then, from column i, those above. */
    for (int32_t j = 0; j < n; j++) {
        for (int64_t p = L->colptr[j]; p < L->colptr[j + 1]; p++) {
            const PetscInt at = first[L->row[p] + 1]++;
            col[at] = j;
            val[at] = L->val[p];
            if (L->row[p] != j) {
                const PetscInt other = first[j + 1]++;
                col[other] = L->row[p];
                val[other] = L->val[p];
            }
        }
    }
    MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, n, n, first, col, val, &A);
    return A;
}

static void *prepare(const bench_matrix *m, const char *name)
{
    slepc *s = sl_calloc(1, sizeof *s);
    if (s == NULL || SlepcInitialize(NULL, NULL, NULL, NULL) != 0) {
        return NULL;
    }
    PetscPushErrorHandler(PetscReturnErrorHandler, NULL);
    s->n = m->A.ncols;
    s->package = strchr(name, '-') + 1;
    s->A = full_matrix(&m->A);
    if (s->A == NULL || MatSetOption(s->A, MAT_SYMMETRIC, PETSC_TRUE) != 0 || MatCreateVecs(s->A, &s->x, NULL) != 0) {
        return NULL;
    }
    return s;
}

static PetscErrorCode set_up(slepc *s, const bench_eigen_run *run)
{
    ST st = NULL;
    KSP ksp = NULL;
    PC pc = NULL;
    PetscFunctionBeginUser;
    PetscCall(EPSCreate(PETSC_COMM_SELF, &s->eps));
    PetscCall(EPSSetOperators(s->eps, s->A, NULL));
    PetscCall(EPSSetProblemType(s->eps, EPS_HEP));
    PetscCall(EPSSetType(s->eps, EPSKRYLOVSCHUR));
    PetscCall(EPSSetDimensions(s->eps, run->pairs, bench_basis_size(run, 2 * run->pairs + 2, s->n), PETSC_DEFAULT));
    PetscCall(EPSSetTolerances(s->eps, run->tolerance, 1000));
    PetscCall(EPSSetWhichEigenpairs(s->eps, EPS_TARGET_MAGNITUDE));
    PetscCall(EPSSetTarget(s->eps, run->sigma));
    PetscCall(EPSGetST(s->eps, &st));
    PetscCall(STSetType(st, STSINVERT));
    PetscCall(STSetShift(st, run->sigma));
    PetscCall(STGetKSP(st, &ksp));
    PetscCall(KSPSetType(ksp, KSPPREONLY));
    PetscCall(KSPGetPC(ksp, &pc));
    PetscCall(PCSetType(pc, PCCHOLESKY));
    PetscCall(PCFactorSetMatSolverType(pc, s->package));
    PetscFunctionReturn(0);
}

static PetscErrorCode run_solver(slepc *s, bench_eigen_run *run, PetscInt *found)
{
    PetscScalar imaginary = 0.0;
    PetscInt solves = 0;
    ST st = NULL;
    KSP ksp = NULL;
    PetscFunctionBeginUser;
    PetscCall(set_up(s, run));
    PetscCall(EPSSolve(s->eps));
    PetscCall(EPSGetConverged(s->eps, found));
    for (int32_t k = 0; k < run->pairs && k < *found; k++) {
        PetscCall(EPSGetEigenvalue(s->eps, k, run->lambda + k, &imaginary));
    }
    PetscCall(EPSGetEigenvector(s->eps, 0, s->x, NULL));
    PetscCall(EPSGetST(s->eps, &st));
    PetscCall(STGetKSP(st, &ksp));
    PetscCall(KSPGetTotalIterations(ksp, &solves));
    run->solves = (int32_t)solves;
    PetscFunctionReturn(0);
}

/* Ordered by distance from the target, which lies below the spectrum: ascending. */
static bool solve(void *state, bench_eigen_run *run)
{
    slepc *s = state;
    PetscInt found = 0;
    s->pairs = run->pairs;
    run->error = "SLEPc failed";
    return run_solver(s, run, &found) == 0 && found >= run->pairs;
}

static const double *vector(void *state, int32_t k)
{
    slepc *s = state;
    if (s->copy == NULL) {
        s->copy = sl_alloc((int64_t)s->n * s->pairs, sizeof *s->copy);
    }
    double *copy = s->copy != NULL ? s->copy + (int64_t)k * s->n : NULL;
    if (copy == NULL || EPSGetEigenvector(s->eps, k, s->x, NULL) != 0 || VecGetArrayRead(s->x, &s->borrowed) != 0) {
        return NULL;
    }
    memcpy(copy, s->borrowed, (size_t)s->n * sizeof *copy);
    return VecRestoreArrayRead(s->x, &s->borrowed) == 0 ? copy : NULL;
}

const bench_eigen_solver bench_slepc[] = {
    {"slepc-cholmod", false, false, prepare, solve, vector},
    {"slepc-mumps", false, false, prepare, solve, vector},
    {"slepc-petsc", false, false, prepare, solve, vector},
    {0},
};
