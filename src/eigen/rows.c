/* A matrix by rows against panels: products, Gram matrices, residuals. */
#include "base/memory.h"
#include "eigen/kernel.h"
#include "eigen/panel.h"

#include <math.h>
#include <string.h>

/* Rows multiplied at once: the product of a tile stays in the first cache. */
enum { TILE_ROWS = 256, MAX_CHUNKS = 64 };

sl_status sl_rows_create(const sl_csc *A, const int32_t *perm, sl_rows *out)
{
    const int32_t n = A->ncols;
    const int64_t entries = 2 * A->colptr[n] - n;
    int32_t *place = sl_alloc(n, sizeof *place);
    *out = (sl_rows){.n = n};
    out->first = sl_calloc((int64_t)n + 2, sizeof *out->first);
    out->col = sl_alloc(entries, sizeof *out->col);
    out->val = sl_alloc(entries, sizeof *out->val);
    if (place == NULL || out->first == NULL || out->col == NULL || out->val == NULL) {
        sl_free(place);
        sl_rows_clear(out);
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t k = 0; k < n; k++) {
        place[perm[k]] = k;
    }
    int64_t *next = out->first + 1; /* next[k]: where row k's next entry goes; ends as the start of row k + 1 */
    for (int32_t j = 0; j < n; j++) {
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            next[place[j] + 1]++;
            next[place[A->row[p]] + 1] += A->row[p] != j;
        }
    }
    for (int32_t k = 0; k < n; k++) {
        next[k + 1] += next[k];
    }
    for (int32_t j = 0; j < n; j++) {
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            const int32_t i = place[A->row[p]], k = place[j];
            out->col[next[k]] = i;
            out->val[next[k]++] = A->val[p];
            if (i != k) {
                out->col[next[i]] = k;
                out->val[next[i]++] = A->val[p];
            }
        }
    }
    sl_free(place);
    return SL_OK;
}

void sl_rows_clear(sl_rows *A)
{
    sl_free(A->first);
    sl_free(A->col);
    sl_free(A->val);
    *A = (sl_rows){.n = 0};
}

static int64_t chunk_rows(int64_t rows)
{
    const int64_t share = (rows + MAX_CHUNKS - 1) / MAX_CHUNKS, least = 16 * TILE_ROWS;
    return share <= least ? least : (share + TILE_ROWS - 1) / TILE_ROWS * TILE_ROWS;
}

/* What the sweeps over chunks of rows share. Blocks of 8 x 8 for panels i <= j stand one after the other. */
typedef struct sweep {
    const sl_panels *M;
    const sl_rows *A;
    int32_t panels;
    const double *lambda; /* panels x 8 */
    double *partial;      /* stride for each chunk */
    int64_t stride;
} sweep;

static void grams_chunk(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    const sweep *s = user;
    const int64_t block = SL_PANEL * SL_PANEL, half = s->stride / 2;
    double *XX = s->partial + chunk * s->stride, *XAX = XX + half, AX[TILE_ROWS * SL_PANEL];
    memset(XX, 0, (size_t)s->stride * sizeof *XX);
    for (int64_t r = begin; r < end; r += TILE_ROWS) {
        const int64_t rows = end - r < TILE_ROWS ? end - r : TILE_ROWS;
        int64_t at = 0;
        for (int32_t j = 0; j < s->panels; j++) {
            const double *X = sl_panel_at(s->M, j);
            sl_kernel_multiply(s->A->first, s->A->col, s->A->val, 0.0, X, SL_PANEL, r, rows, AX);
            for (int32_t i = 0; i <= j; i++, at += block) {
                const double *P = sl_panel_at(s->M, i) + r * SL_PANEL;
                sl_kernel_gram(P, X + r * SL_PANEL, rows, SL_PANEL, XX + at);
                sl_kernel_gram(P, AX, rows, SL_PANEL, XAX + at);
            }
        }
    }
}

/* Spreads blocks i <= j into a full symmetric matrix. */
static void spread_blocks(const double *blocks, int32_t columns, double *full)
{
    for (int32_t b = 0; b < columns; b++) {
        for (int32_t a = 0; a <= b; a++) {
            const int64_t i = a / SL_PANEL, j = b / SL_PANEL;
            const double *block = blocks + (j * (j + 1) / 2 + i) * SL_PANEL * SL_PANEL;
            const double value = block[a % SL_PANEL * SL_PANEL + b % SL_PANEL];
            full[(int64_t)b * columns + a] = full[(int64_t)a * columns + b] = value;
        }
    }
}

/* Runs fn over chunks and adds what they leave to the first chunk's partial sums. */
static sl_status run_sweep(sweep *s, sl_chunk_fn *fn, const sl_context *context)
{
    const int32_t chunks = sl_chunk_count(s->M->rows, chunk_rows(s->M->rows));
    s->partial = sl_calloc((chunks > 0 ? chunks : 1) * s->stride, sizeof *s->partial);
    if (s->partial == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    sl_parallel_for(context, s->M->rows, chunk_rows(s->M->rows), fn, s);
    for (int32_t c = 1; c < chunks; c++) {
        for (int64_t i = 0; i < s->stride; i++) {
            s->partial[i] += s->partial[c * s->stride + i];
        }
    }
    return SL_OK;
}

sl_status sl_panels_grams(const sl_panels *M, int32_t columns, const sl_rows *A, double *XX, double *XAX,
                          const sl_context *context)
{
    const int64_t panels = sl_panel_count(columns), half = panels * (panels + 1) / 2 * SL_PANEL * SL_PANEL;
    sweep s = {.M = M, .A = A, .panels = (int32_t)panels, .stride = 2 * half};
    const sl_status status = run_sweep(&s, grams_chunk, context);
    if (status == SL_OK) {
        spread_blocks(s.partial, columns, XX);
        spread_blocks(s.partial + half, columns, XAX);
    }
    sl_free(s.partial);
    return status;
}

static void residuals_chunk(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    const sweep *s = user;
    double *sum = s->partial + chunk * s->stride, AX[TILE_ROWS * SL_PANEL];
    for (int64_t r = begin; r < end; r += TILE_ROWS) {
        const int64_t rows = end - r < TILE_ROWS ? end - r : TILE_ROWS;
        for (int32_t j = 0; j < s->panels; j++) {
            const double *X = sl_panel_at(s->M, j);
            sl_kernel_multiply(s->A->first, s->A->col, s->A->val, 0.0, X, SL_PANEL, r, rows, AX);
            for (int64_t i = 0; i < rows; i++) {
                for (int32_t c = 0; c < SL_PANEL; c++) {
                    const double d = AX[i * SL_PANEL + c] - s->lambda[j * SL_PANEL + c] * X[(r + i) * SL_PANEL + c];
                    sum[j * SL_PANEL + c] += d * d;
                }
            }
        }
    }
}

sl_status sl_panels_residuals(const sl_panels *M, int32_t columns, const sl_rows *A, const double *lambda, double *norm,
                              const sl_context *context)
{
    const int32_t panels = sl_panel_count(columns);
    double *padded = sl_calloc((int64_t)panels * SL_PANEL, sizeof *padded);
    if (padded == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    memcpy(padded, lambda, (size_t)columns * sizeof *padded);
    sweep s = {.M = M, .A = A, .panels = panels, .lambda = padded, .stride = (int64_t)panels * SL_PANEL};
    const sl_status status = run_sweep(&s, residuals_chunk, context);
    for (int32_t k = 0; k < columns && status == SL_OK; k++) {
        norm[k] = sqrt(s.partial[k]);
    }
    sl_free(s.partial);
    sl_free(padded);
    return status;
}
