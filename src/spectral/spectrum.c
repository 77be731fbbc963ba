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

/* The pairs to the precision of `mode`. */
static sl_status compute(const sl_facet_graph *graph, int32_t count, sl_lanczos_mode mode, const sl_context *context,
                         sl_spectrum **out)
{
    sl_status status = SL_OK;
    sl_csc *A = NULL;
    sl_spectrum *s = NULL;
    double *null_space = NULL;
    const int32_t n = graph->graph.n;
    sl_lanczos_def def = sl_lanczos_default();
    *out = NULL;
    def.count = count < n ? count : n;
    def.mode = mode;
    SL_TRY(sl_laplacian_create(&graph->graph, &A));
    SL_TRY(null_space_create(&graph->graph, &null_space, &def.null_count));
    SL_TRY(spectrum_allocate(n, def.count, &s));
    if (def.null_count >= def.count) { /* nothing left to solve for */
        memcpy(s->vectors, null_space, (size_t)n * (size_t)def.count * sizeof *s->vectors);
        s->info = (sl_lanczos_info){.converged_count = def.count, .converged = true};
    } else {
        def.null_space = null_space;
        def.xyz = graph->centroid;
        status = sl_lanczos_solve(A, &def, context, s->lambda, s->vectors, s->residual, &s->info);
        SL_TRY(status == SL_NOT_POSITIVE_DEFINITE || status == SL_BAD_INPUT ? SL_INTERNAL : status);
    }
    *out = s;
    s = NULL;
cleanup:
    sl_spectrum_free(s);
    sl_free(null_space);
    sl_csc_free(A);
    return status;
}

/**
 * The `count` smallest eigenpairs of a facet graph's Laplacian.
 *
 * @param[in]  graph    facet graph; its centroids steer the fill-reducing ordering
 * @param[in]  count    pairs wanted, the null space included; clipped to the number of nodes
 * @param[in]  context  nullable
 * @param[out] out      owned by the caller; NULL on failure
 *
 * SL_OUT_OF_MEMORY; SL_CANCELLED; SL_INTERNAL (LAPACKE failed, or the matrix is no Laplacian). Not converging is no
 * error: see info. A graph of more components than `count` gives that many null vectors only. Same bytes for any number
 * of threads.
 */
sl_status sl_spectrum_compute(const sl_facet_graph *graph, int32_t count, const sl_context *context, sl_spectrum **out)
{
    return compute(graph, count, SL_LANCZOS_TOLERANCE, context, out);
}

sl_status sl_spectrum_compute_signs(const sl_facet_graph *graph, int32_t count, const sl_context *context,
                                    sl_spectrum **out)
{
    return compute(graph, count, SL_LANCZOS_SIGNS, context, out);
}

void sl_spectrum_free(sl_spectrum *spectrum)
{
    if (spectrum == NULL) {
        return;
    }
    sl_free(spectrum->lambda);
    sl_free(spectrum->vectors);
    sl_free(spectrum->residual);
    sl_free(spectrum);
}
