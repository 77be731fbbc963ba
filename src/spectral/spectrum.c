/* The lower end of a facet graph's spectrum. */
#include "spectral/spectrum.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

/* Orthonormal indicators of the components: the Laplacian's null space, exactly. *basis: n x *count, column-major. */
static sl_status null_space_create(const sl_graph *graph, double **basis, int32_t *count)
{
    sl_status status = SL_OK;
    int32_t *size = NULL;
    int32_t *label = sl_alloc(graph->n, sizeof *label);
    *basis = NULL;
    *count = 0;
    if (label == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    int32_t parts = 0;
    int64_t entries = 0;
    SL_TRY(sl_graph_components(graph, NULL, label, &parts));
    SL_TRY(sl_mul_size(graph->n, parts, &entries));
    size = sl_calloc(parts, sizeof *size);
    *basis = sl_calloc(entries, sizeof **basis);
    if (size == NULL || *basis == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    for (int32_t i = 0; i < graph->n; i++) {
        size[label[i]]++;
    }
    for (int32_t i = 0; i < graph->n; i++) {
        (*basis)[(int64_t)label[i] * graph->n + i] = 1.0 / sqrt((double)size[label[i]]);
    }
    *count = parts;
cleanup:
    if (status != SL_OK) {
        sl_free(*basis);
        *basis = NULL;
    }
    sl_free(size);
    sl_free(label);
    return status;
}

sl_spectrum_def sl_spectrum_default(void)
{
    const sl_lanczos_def solver = sl_lanczos_default();
    return (sl_spectrum_def){.count = solver.count, .mode = solver.mode, .tolerance = solver.tolerance};
}

static sl_status spectrum_allocate(int32_t n, int32_t count, sl_spectrum **out)
{
    sl_spectrum *s = sl_calloc(1, sizeof *s);
    *out = s;
    int64_t entries = 0;
    if (s == NULL || sl_mul_size(n, count, &entries) != SL_OK) {
        return SL_OUT_OF_MEMORY;
    }
    s->n = n;
    s->count = count;
    s->lambda = sl_calloc(count, sizeof *s->lambda);
    s->residual = sl_calloc(count, sizeof *s->residual);
    s->vectors = sl_calloc(entries, sizeof *s->vectors);
    return s->lambda == NULL || s->residual == NULL || s->vectors == NULL ? SL_OUT_OF_MEMORY : SL_OK;
}

/* Bytes of what stays allocated around the solver. */
static int64_t bytes_around(const sl_csc *A, int32_t null_count, int32_t count)
{
    const int64_t n = A->ncols, entries = A->colptr[n];
    const int64_t matrix = entries * (int64_t)(sizeof *A->val + sizeof *A->row) + n * (int64_t)sizeof *A->colptr;
    return matrix + (n * ((int64_t)count + null_count) + 2 * (int64_t)count) * (int64_t)sizeof(double);
}

/* What is left for the solver of a limit on all. */
static sl_status limit_solver(int64_t limit, int64_t around, int64_t *left)
{
    *left = limit > 0 ? limit - around : 0;
    return limit == 0 || *left > 0 ? SL_OK : SL_LIMIT;
}

/* The order of elimination: inherited, or found here so that parts can inherit it. */
static sl_status find_order(const sl_facet_graph *graph, const sl_csc *A, const int32_t *rank,
                            const sl_context *context, sl_spectrum *s)
{
    s->perm = sl_alloc(s->n, sizeof *s->perm);
    if (s->perm == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    return rank != NULL ? sl_order_by_rank(s->n, rank, s->perm)
                        : sl_order_with(A, SL_ORDER_NESTED_DISSECTION, graph->centroid, context, s->perm);
}

static sl_status solve_bands(const sl_csc *A, const sl_lanczos_def *solver, const sl_context *context, sl_spectrum *s)
{
    sl_band_def def = sl_band_default();
    sl_status status = SL_OK;
    def.first = *solver;
    def.first.mode = SL_LANCZOS_TOLERANCE;
    def.count = solver->count;
    SL_TRY(sl_lanczos_bands(A, &def, context, s->lambda, s->vectors, s->residual, &s->bands));
    s->count = s->bands.found;
    s->info = (sl_lanczos_info){.converged_count = s->bands.found,
                                .converged = s->bands.converged,
                                .certified = s->bands.certified,
                                .counts = s->bands.counts,
                                .solves = (int32_t)(s->bands.solves < INT32_MAX ? s->bands.solves : INT32_MAX),
                                .max_residual = s->bands.max_residual,
                                .memory = s->bands.memory};
cleanup:
    return status;
}

static sl_status solve(const sl_csc *A, const sl_lanczos_def *solver, bool bands, const sl_context *context,
                       sl_spectrum *s)
{
    const sl_status status = bands ? solve_bands(A, solver, context, s)
                                   : sl_lanczos_solve(A, solver, context, s->lambda, s->vectors, s->residual, &s->info);
    return status == SL_NOT_POSITIVE_DEFINITE ? SL_INTERNAL : status;
}

/**
 * The smallest eigenpairs of a facet graph's Laplacian.
 *
 * @param[in]  graph    facet graph; its centroids steer the fill-reducing ordering
 * @param[in]  def      nullable
 * @param[in]  context  nullable
 * @param[out] out      owned by the caller; NULL on failure
 *
 * SL_BAD_INPUT, SL_LIMIT, SL_OUT_OF_MEMORY, SL_CANCELLED, SL_INTERNAL (LAPACKE failed, or the matrix is no Laplacian).
 * Not converging is no error: see info; bands that end early leave `count` smaller. A graph of more components than
 * def->count gives that many null vectors only. Same bytes for any number of threads.
 */
sl_status sl_spectrum_solve(const sl_facet_graph *graph, const sl_spectrum_def *def, const sl_context *context,
                            sl_spectrum **out)
{
    const sl_spectrum_def defaults = sl_spectrum_default();
    const int32_t n = graph->graph.n;
    sl_status status = SL_OK;
    sl_csc *A = NULL;
    sl_spectrum *s = NULL;
    double *null_space = NULL;
    sl_lanczos_def solver = sl_lanczos_default();
    *out = NULL;
    def = def != NULL ? def : &defaults;
    solver.count = def->count < n ? def->count : n;
    solver.mode = def->mode;
    solver.tolerance = def->tolerance;
    SL_TRY(def->count >= 0 && def->memory_limit >= 0 ? SL_OK : SL_BAD_INPUT);
    SL_TRY(sl_laplacian_create(&graph->graph, &A));
    SL_TRY(null_space_create(&graph->graph, &null_space, &solver.null_count));
    const int64_t around = bytes_around(A, solver.null_count, solver.count);
    SL_TRY(limit_solver(def->memory_limit, around, &solver.memory_limit));
    SL_TRY(spectrum_allocate(n, solver.count, &s));
    if (solver.null_count >= solver.count) { /* nothing left to solve for */
        memcpy(s->vectors, null_space, (size_t)n * (size_t)solver.count * sizeof *s->vectors);
        s->info = (sl_lanczos_info){.converged_count = solver.count, .converged = true};
    } else {
        SL_TRY(sl_report_progress(context, "ordering", 0.0));
        SL_TRY(find_order(graph, A, def->rank, context, s));
        solver.null_space = null_space;
        solver.perm = s->perm;
        SL_TRY(solve(A, &solver, def->bands, context, s));
    }
    s->memory = around + s->info.memory;
    *out = s;
    s = NULL;
cleanup:
    sl_spectrum_free(s);
    sl_free(null_space);
    sl_csc_free(A);
    return status;
}

sl_status sl_spectrum_compute(const sl_facet_graph *graph, int32_t count, const sl_context *context, sl_spectrum **out)
{
    sl_spectrum_def def = sl_spectrum_default();
    def.count = count;
    return sl_spectrum_solve(graph, &def, context, out);
}

sl_status sl_spectrum_compute_signs(const sl_facet_graph *graph, int32_t count, const sl_context *context,
                                    sl_spectrum **out)
{
    sl_spectrum_def def = sl_spectrum_default();
    def.count = count;
    def.mode = SL_LANCZOS_SIGNS;
    return sl_spectrum_solve(graph, &def, context, out);
}

void sl_spectrum_free(sl_spectrum *spectrum)
{
    if (spectrum == NULL) {
        return;
    }
    sl_free(spectrum->lambda);
    sl_free(spectrum->vectors);
    sl_free(spectrum->residual);
    sl_free(spectrum->perm);
    sl_free(spectrum);
}
