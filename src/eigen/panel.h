/* Tall matrices in panels of eight columns and the kernels on them; internal to the room.
 * Layer: eigen. */
#ifndef SL_EIGEN_PANEL_H
#define SL_EIGEN_PANEL_H

#include "base/context.h"
#include "sparse/csc.h"

/* Columns of a panel: a row of it fills a cache line. */
#define SL_PANEL 8

/* rows x columns; column k is lane k % 8 of panel k / 8, a panel is rows x 8 row by row. Lanes beyond `columns` of the
 * last panel exist and are zero until written. */
typedef struct sl_panels {
    int32_t rows, columns;
    void *memory;  /* owned */
    double *data;  /* memory, aligned to a cache line; NULL when entries are kept in single precision */
    float *single; /* the same then; all arithmetic is in double precision nonetheless */
} sl_panels;

typedef enum sl_precision { SL_DOUBLE, SL_SINGLE } sl_precision;

/* Zeroed. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_panels_create(int32_t rows, int32_t columns, sl_precision precision, sl_panels *out);
void sl_panels_clear(sl_panels *panels);

/* *to = the first `columns` columns of *from, whose memory it takes over and shrinks; *from is empty afterwards, also
 * on failure. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_panels_take(sl_panels *from, int32_t columns, sl_panels *to);

/* Bytes sl_panels_create would take. */
int64_t sl_panels_bytes(int64_t rows, int64_t columns, sl_precision precision);

static inline int32_t sl_panel_count(int32_t columns)
{
    return (columns + SL_PANEL - 1) / SL_PANEL;
}

/* Of double precision. */
static inline double *sl_panel_at(const sl_panels *m, int32_t panel)
{
    return m->data + (int64_t)panel * m->rows * SL_PANEL;
}

/* Panels panel .. of M, which keeps the memory, as columns of their own. */
static inline sl_panels sl_panels_from(const sl_panels *M, int32_t panel)
{
    const int64_t skip = (int64_t)panel * M->rows * SL_PANEL;
    return (sl_panels){.rows = M->rows,
                       .columns = M->columns - panel * SL_PANEL,
                       .data = M->data != NULL ? M->data + skip : NULL,
                       .single = M->single != NULL ? M->single + skip : NULL};
}

/* Up to two blocks that go through a sweep over M together; the second costs little where memory sets the pace. W: rows
 * x w row by row, w = 4 or 8. H: room for the columns of M rounded up to a multiple of eight, times w. */
typedef struct sl_panel_pair {
    int32_t w;
    double *W[2]; /* W[1] may be NULL */
    double *H[2];
} sl_panel_pair;

/* H[k] (columns x w, row by row, then zeros) = M' W[k] over the first `columns` columns of M. partial:
 * sl_panels_partial_size(rows, columns) doubles. The bytes do not depend on the context's workers. */
void sl_panels_project(const sl_panels *M, int32_t columns, const sl_panel_pair *pair, double *partial,
                       const sl_context *context);

/* W[k] -= M H[k] over the first `columns` columns, H[k] as sl_panels_project leaves it, then G (w x w) = W[0]' W[0]. H
 * comes back as it was. */
void sl_panels_subtract(const sl_panels *M, int32_t columns, const sl_panel_pair *pair, double *partial, double *G,
                        const sl_context *context);

/* W -= v v'W for one panel W (rows x 8) and a unit vector v. */
void sl_panel_remove(int32_t rows, const double *v, double *W, const sl_context *context);

/* W := W R^-1, R w x w upper triangular (R[i * w + j]), then G = W' W. */
void sl_panels_divide(int32_t rows, double *W, int32_t w, const double *R, double *partial, double *G,
                      const sl_context *context);

/* M := M C, or to = M C when `to` (as many rows, kept columns at least, of any precision) is given. C: columns x kept,
 * column-major. Lanes from kept up to the next multiple of eight become 0. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_panels_rotate(sl_panels *M, int32_t columns, const double *C, int32_t kept, sl_panels *to,
                                        const sl_context *context);

/* Copies W (rows x w), rounded where M is single, to columns at .. at + w - 1 of M, or back. */
void sl_panels_store(sl_panels *M, int32_t at, const double *W, int32_t w);
void sl_panels_load(const sl_panels *M, int32_t at, double *W, int32_t w);

int64_t sl_panels_partial_size(int64_t rows, int32_t columns);

/* A symmetric matrix by rows, both triangles, in another order of its unknowns. */
typedef struct sl_rows {
    int32_t n;
    int64_t *first; /* n + 1 */
    int32_t *col;
    double *val;
} sl_rows;

/* P A P' of A's lower triangle; perm[k] = row of A that comes k-th. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_rows_create(const sl_csc *A, const int32_t *perm, sl_rows *out);
void sl_rows_clear(sl_rows *A);

/* XX = M'M and XAX = M'AM over the first `columns` columns: columns x columns each, leading dimension `columns`.
 * SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_panels_grams(const sl_panels *M, int32_t columns, const sl_rows *A, double *XX, double *XAX,
                                       const sl_context *context);

/* norm[k] = ||A x_k - lambda_k x_k|| for the first `columns` columns. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_panels_residuals(const sl_panels *M, int32_t columns, const sl_rows *A, const double *lambda,
                                           double *norm, const sl_context *context);

/* ritz.c: rotates the first m columns of X to the eigenvectors of A within their span, orthonormal, lambda ascending
 * (values within rounding of norm = ||A|| become 0), and gives their residuals. SL_OUT_OF_MEMORY, SL_INTERNAL. */
SL_NODISCARD sl_status sl_panels_rayleigh_ritz(sl_panels *X, int32_t m, const sl_rows *A, double norm, double *lambda,
                                               double *residual, const sl_context *context);

#endif
