/* Sweeps over tall matrices: projections, rotations, in tiles that stay in the first cache. */
#include "base/memory.h"
#include "eigen/kernel.h"
#include "eigen/panel.h"

#include <math.h>
#include <string.h>

/* Rows a kernel is called with: eight lanes of them stay in the first cache. */
enum { TILE_ROWS = 256, TILE = TILE_ROWS * SL_PANEL };

/* Rows of a chunk are a multiple of the tile, and there are at most so many chunks: their partial sums are added up in
 * order. */
enum { MAX_CHUNKS = 64 };

static int64_t chunk_rows(int64_t rows)
{
    const int64_t share = (rows + MAX_CHUNKS - 1) / MAX_CHUNKS, least = 16 * TILE_ROWS;
    return share <= least ? least : (share + TILE_ROWS - 1) / TILE_ROWS * TILE_ROWS;
}

static int64_t smaller(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

/* `rows` rows of a panel from `begin` on, by way of wide (TILE) where they are single. */
static const double *tile_of(const sl_panels *M, int32_t panel, int64_t begin, int64_t rows, double *wide)
{
    const int64_t at = (panel * (int64_t)M->rows + begin) * SL_PANEL;
    if (M->single == NULL) {
        return M->data + at;
    }
    sl_kernel_widen(M->single + at, rows * SL_PANEL, wide);
    return wide;
}

int64_t sl_panels_partial_size(int64_t rows, int32_t columns)
{
    const int32_t wide = sl_panel_count(columns) + 1;
    return 2 * sl_chunk_count(rows, chunk_rows(rows)) * (int64_t)wide * SL_PANEL * SL_PANEL;
}

/* What the sweeps over chunks share. */
typedef struct sweep {
    const sl_panels *M;
    int32_t panels, w;
    double *W[2];
    const double *H[2];
    double *partial;
    int64_t stride; /* of partial from chunk to chunk */
} sweep;

/* sum = the chunks' partial sums, `size` of them from `at` on. */
static void add_partials(const sweep *s, int64_t rows, int64_t at, int64_t size, double *sum)
{
    const int32_t chunks = sl_chunk_count(rows, chunk_rows(rows));
    memset(sum, 0, (size_t)size * sizeof *sum);
    for (int32_t c = 0; c < chunks; c++) {
        for (int64_t i = 0; i < size; i++) {
            sum[i] += s->partial[c * s->stride + at + i];
        }
    }
}

static void project_chunk(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    const sweep *s = user;
    const int64_t block = (int64_t)SL_PANEL * s->w, half = s->panels * block;
    double *H = s->partial + chunk * s->stride;
    memset(H, 0, (size_t)s->stride * sizeof *H);
    double wide[TILE];
    for (int64_t r = begin; r < end; r += TILE_ROWS) {
        const int64_t rows = smaller(TILE_ROWS, end - r);
        for (int32_t p = 0; p < s->panels; p++) {
            const double *P = tile_of(s->M, p, r, rows, wide);
            sl_kernel_gram(P, s->W[0] + r * s->w, rows, s->w, H + p * block);
            if (s->W[1] != NULL) {
                sl_kernel_gram(P, s->W[1] + r * s->w, rows, s->w, H + half + p * block);
            }
        }
    }
}

void sl_panels_project(const sl_panels *M, int32_t columns, const sl_panel_pair *pair, double *partial,
                       const sl_context *context)
{
    const int32_t panels = sl_panel_count(columns), blocks = pair->W[1] != NULL ? 2 : 1;
    const int64_t half = (int64_t)panels * SL_PANEL * pair->w, used = (int64_t)columns * pair->w;
    sweep s = {.M = M, .panels = panels, .w = pair->w, .partial = partial, .stride = blocks * half};
    s.W[0] = pair->W[0];
    s.W[1] = pair->W[1];
    sl_parallel_for(context, M->rows, chunk_rows(M->rows), project_chunk, &s);
    for (int32_t k = 0; k < blocks; k++) {
        add_partials(&s, M->rows, k * half, half, pair->H[k]);
        memset(pair->H[k] + used, 0, (size_t)(half - used) * sizeof *pair->H[k]);
    }
}

static void subtract_chunk(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    const sweep *s = user;
    const int64_t block = (int64_t)SL_PANEL * s->w;
    double *G = s->partial + chunk * s->stride;
    memset(G, 0, (size_t)s->stride * sizeof *G);
    double wide[TILE];
    for (int64_t r = begin; r < end; r += TILE_ROWS) {
        const int64_t rows = smaller(TILE_ROWS, end - r);
        for (int32_t p = 0; p < s->panels; p++) {
            const double *P = tile_of(s->M, p, r, rows, wide);
            sl_kernel_add(P, s->H[0] + p * block, rows, s->w, s->W[0] + r * s->w);
            if (s->W[1] != NULL) {
                sl_kernel_add(P, s->H[1] + p * block, rows, s->w, s->W[1] + r * s->w);
            }
        }
        sl_kernel_self(s->W[0] + r * s->w, rows, s->w, G);
    }
}

static void negate(double *x, int64_t count)
{
    for (int64_t i = 0; i < count; i++) {
        x[i] = -x[i];
    }
}

void sl_panels_subtract(const sl_panels *M, int32_t columns, const sl_panel_pair *pair, double *partial, double *G,
                        const sl_context *context)
{
    const int32_t panels = sl_panel_count(columns), blocks = pair->W[1] != NULL ? 2 : 1;
    const int64_t half = (int64_t)panels * SL_PANEL * pair->w;
    sweep s = {.M = M, .panels = panels, .w = pair->w, .partial = partial, .stride = (int64_t)pair->w * pair->w};
    for (int32_t k = 0; k < blocks; k++) {
        s.W[k] = pair->W[k];
        s.H[k] = pair->H[k];
        negate(pair->H[k], half);
    }
    sl_parallel_for(context, M->rows, chunk_rows(M->rows), subtract_chunk, &s);
    add_partials(&s, M->rows, 0, s.stride, G);
    for (int32_t k = 0; k < blocks; k++) {
        negate(pair->H[k], half);
    }
}

static void divide_chunk(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    const sweep *s = user;
    double *G = s->partial + chunk * s->stride;
    memset(G, 0, (size_t)s->stride * sizeof *G);
    for (int64_t r = begin; r < end; r += TILE_ROWS) {
        const int64_t rows = smaller(TILE_ROWS, end - r);
        sl_kernel_triangle(s->H[0], rows, s->w, s->W[0] + r * s->w);
        sl_kernel_self(s->W[0] + r * s->w, rows, s->w, G);
    }
}

/* U = inv(R), w x w upper triangular, row by row. */
static void invert_triangle(const double *R, int32_t w, double *U)
{
    memset(U, 0, (size_t)(w * w) * sizeof *U);
    for (int32_t j = 0; j < w; j++) {
        U[j * w + j] = 1.0 / R[j * w + j];
        for (int32_t i = j - 1; i >= 0; i--) {
            double sum = 0.0;
            for (int32_t k = i + 1; k <= j; k++) {
                sum += R[i * w + k] * U[k * w + j];
            }
            U[i * w + j] = -sum / R[i * w + i];
        }
    }
}

void sl_panels_divide(int32_t rows, double *W, int32_t w, const double *R, double *partial, double *G,
                      const sl_context *context)
{
    double U[SL_PANEL * SL_PANEL];
    invert_triangle(R, w, U);
    sweep s = {.w = w, .partial = partial, .stride = (int64_t)w * w};
    s.W[0] = W;
    s.H[0] = U;
    sl_parallel_for(context, rows, chunk_rows(rows), divide_chunk, &s);
    add_partials(&s, rows, 0, s.stride, G);
}

/* One vector against one panel. */
typedef struct removal {
    const double *v;
    double *W;
    double share[SL_PANEL];
    double sums[MAX_CHUNKS][SL_PANEL];
} removal;

static void share_chunk(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    removal *t = user;
    double sum[SL_PANEL] = {0.0};
    for (int64_t r = begin; r < end; r++) {
        for (int32_t c = 0; c < SL_PANEL; c++) {
            sum[c] += t->v[r] * t->W[r * SL_PANEL + c];
        }
    }
    memcpy(t->sums[chunk], sum, sizeof sum);
}

static void remove_chunk(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    (void)chunk;
    const removal *t = user;
    for (int64_t r = begin; r < end; r++) {
        for (int32_t c = 0; c < SL_PANEL; c++) {
            t->W[r * SL_PANEL + c] -= t->v[r] * t->share[c];
        }
    }
}

void sl_panel_remove(int32_t rows, const double *v, double *W, const sl_context *context)
{
    removal t = {.v = v, .W = W};
    sl_parallel_for(context, rows, chunk_rows(rows), share_chunk, &t);
    for (int32_t k = 0; k < sl_chunk_count(rows, chunk_rows(rows)); k++) {
        for (int32_t c = 0; c < SL_PANEL; c++) {
            t.share[c] += t.sums[k][c];
        }
    }
    sl_parallel_for(context, rows, chunk_rows(rows), remove_chunk, &t);
}

/* Rotation in place: a tile of all panels is set aside and comes back multiplied. */
typedef struct rotation {
    const sl_panels *M;
    sl_panels *to;
    int32_t panels, kept_panels;
    const double *blocks; /* panels x kept_panels blocks of 8 x 8 */
    double *tiles;        /* one for each chunk */
} rotation;

static void rotate_chunk(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    const rotation *t = user;
    const int64_t block = SL_PANEL * SL_PANEL;
    double *copy = t->tiles + chunk * (int64_t)TILE * t->panels, turned[TILE];
    for (int64_t r = begin; r < end; r += TILE_ROWS) {
        const int64_t rows = smaller(TILE_ROWS, end - r), entries = rows * SL_PANEL;
        for (int32_t p = 0; p < t->panels; p++) {
            double *tile = copy + p * TILE;
            const double *from = tile_of(t->M, p, r, rows, tile);
            if (from != tile) {
                memcpy(tile, from, (size_t)entries * sizeof *copy);
            }
        }
        for (int32_t q = 0; q < t->kept_panels; q++) {
            const int64_t at = (q * (int64_t)t->to->rows + r) * SL_PANEL;
            double *out = t->to->single != NULL ? turned : t->to->data + at;
            memset(out, 0, (size_t)entries * sizeof *out);
            for (int32_t p = 0; p < t->panels; p++) {
                sl_kernel_add(copy + p * TILE, t->blocks + ((int64_t)p * t->kept_panels + q) * block, rows, SL_PANEL,
                              out);
            }
            if (t->to->single != NULL) {
                sl_kernel_narrow(turned, entries, t->to->single + at);
            }
        }
    }
}

sl_status sl_panels_rotate(sl_panels *M, int32_t columns, const double *C, int32_t kept, sl_panels *to,
                           const sl_context *context)
{
    const int32_t panels = sl_panel_count(columns), kept_panels = sl_panel_count(kept);
    const int32_t chunks = sl_chunk_count(M->rows, chunk_rows(M->rows));
    double *blocks = sl_calloc((int64_t)panels * kept_panels, SL_PANEL * SL_PANEL * sizeof *blocks);
    double *tiles = sl_alloc((int64_t)chunks * panels * TILE, sizeof *tiles);
    sl_status status = SL_OUT_OF_MEMORY;
    if (blocks != NULL && tiles != NULL) {
        for (int32_t i = 0; i < columns; i++) {
            for (int32_t k = 0; k < kept; k++) {
                blocks[(((int64_t)(i / SL_PANEL) * kept_panels + k / SL_PANEL) * SL_PANEL + i % SL_PANEL) * SL_PANEL +
                       k % SL_PANEL] = C[(int64_t)k * columns + i];
            }
        }
        rotation t = {M, to != NULL ? to : M, panels, kept_panels, blocks, tiles};
        sl_parallel_for(context, M->rows, chunk_rows(M->rows), rotate_chunk, &t);
        status = SL_OK;
    }
    sl_free(blocks);
    sl_free(tiles);
    return status;
}
