#include "eigen/krylov.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

/* A block that keeps less than this share of its length is orthogonalised again: cancellation has cost it digits. */
static const double kept_share = 1e-2;

/* The basis is looked at again once so much of the way that is left, by the pace so far, lies behind. The pace, the
 * logarithm's fall a block, picks up after a slow start: measured, it is this at least later on. */
static const double look_share = 0.8, least_pace = 0.9;

/* Every second block is looked back at: the three-term recurrence hands what is left in the others on undiminished, but
 * hardly magnified. */
enum { look_back_every = 2 };

int64_t sl_krylov_bytes(int64_t rows, int32_t fixed, int32_t block, int32_t max_basis, sl_precision precision)
{
    const int64_t m = max_basis + block, w = block < SL_PANEL ? block : SL_PANEL;
    const int64_t partial = sl_panels_partial_size(rows, fixed + (int32_t)m);
    const int64_t small = 4 * m * m + 40 * m + 4 * (m + fixed) * SL_PANEL + partial;
    return sl_panels_bytes(rows, fixed + m, precision) + (2 * rows * w + small) * (int64_t)sizeof(double);
}

sl_status sl_krylov_init(int32_t rows, int32_t fixed, int32_t block, int32_t max_basis, sl_precision precision,
                         uint64_t seed, const sl_context *context, sl_krylov *k)
{
    const int64_t m = (int64_t)max_basis + block, columns = fixed + m;
    const int64_t padded = (int64_t)sl_panel_count((int32_t)columns) * SL_PANEL;
    *k = (sl_krylov){.fixed = fixed, .block = block, .max_basis = max_basis, .context = context};
    k->w = block < SL_PANEL ? block : SL_PANEL;
    k->rng = sl_rng_seed(seed);
    const sl_status status = sl_panels_create(rows, (int32_t)columns, precision, &k->Q);
    k->T = sl_calloc(m * m, sizeof *k->T);
    k->W = sl_alloc((int64_t)rows * k->w, sizeof *k->W);
    k->spare = sl_alloc((int64_t)rows * k->w, sizeof *k->spare);
    k->H = sl_calloc(padded * k->w, sizeof *k->H);
    k->again = sl_calloc(padded * k->w, sizeof *k->again);
    k->corrected = sl_calloc(padded * k->w, sizeof *k->corrected);
    k->partial = sl_alloc(sl_panels_partial_size(rows, (int32_t)columns), sizeof *k->partial);
    k->S = sl_alloc((int64_t)max_basis * (max_basis + block), sizeof *k->S);
    k->theta = sl_alloc(max_basis, sizeof *k->theta);
    k->last = sl_alloc(max_basis, sizeof *k->last);
    k->copy = sl_alloc((int64_t)max_basis * (max_basis + block), sizeof *k->copy);
    k->lapack = sl_alloc(26 * (int64_t)max_basis + 1, sizeof *k->lapack);
    k->lapack_int = sl_alloc(12 * (int64_t)max_basis + 1, sizeof *k->lapack_int);
    const bool ok = status == SL_OK && k->T != NULL && k->W != NULL && k->spare != NULL && k->H != NULL &&
                    k->again != NULL && k->corrected != NULL && k->partial != NULL && k->S != NULL &&
                    k->theta != NULL && k->last != NULL && k->copy != NULL && k->lapack != NULL &&
                    k->lapack_int != NULL;
    return ok ? SL_OK : SL_OUT_OF_MEMORY;
}

void sl_krylov_clear(sl_krylov *k)
{
    sl_panels_clear(&k->Q);
    sl_free(k->T);
    sl_free(k->W);
    sl_free(k->spare);
    sl_free(k->H);
    sl_free(k->again);
    sl_free(k->corrected);
    sl_free(k->partial);
    sl_free(k->S);
    sl_free(k->theta);
    sl_free(k->last);
    sl_free(k->copy);
    sl_free(k->lapack);
    sl_free(k->lapack_int);
    *k = (sl_krylov){.fixed = 0};
}

void sl_krylov_seen(const sl_krylov *k, sl_krylov_watch *watch, double worst)
{
    double pace = least_pace;
    if (watch->before > 0 && isfinite(watch->worst) && worst < watch->worst) {
        pace = fmax(pace, log(watch->worst / worst) * k->w / (k->applied - watch->before));
    }
    const double left = isfinite(worst) ? look_share * k->w * log(worst) / pace : 0.0;
    watch->look = k->applied + (int32_t)fmax(0.0, fmin(left, k->max_basis));
    watch->before = k->applied;
    watch->worst = worst;
}

/* P, the block at column `at`, will become P - Q E. H's rows for it are corrected to (P - Q E)'W; `corrected` are the
 * coefficients on Q and the old P that take out of W what lies in Q and the new P. */
static void correct_projection(sl_krylov *k, int32_t at)
{
    const int32_t w = k->w, columns = sl_krylov_columns(k);
    double *H = k->H, *own = H + (int64_t)at * w;
    const double *E = k->again;
    for (int32_t i = 0; i < columns; i++) {
        for (int32_t a = 0; a < w && (i < at || i >= at + w); a++) {
            for (int32_t c = 0; c < w; c++) {
                own[a * w + c] -= E[i * w + a] * H[i * w + c];
            }
        }
    }
    memcpy(k->corrected, H, (size_t)sl_panel_count(columns) * SL_PANEL * (size_t)w * sizeof *H);
    for (int32_t i = 0; i < columns; i++) {
        for (int32_t a = 0; a < w && (i < at || i >= at + w); a++) {
            for (int32_t c = 0; c < w; c++) {
                k->corrected[i * w + c] -= E[i * w + a] * own[a * w + c];
            }
        }
    }
}

/* Projects W = OP P against the basis, P its block that starts at column `at`: H = Q'W. P itself goes through the same
 * sweeps once more and loses what its own single projection had left in it, E = Q'P; without this second look the error
 * doubles with every block. Where W loses digits all the same it is projected again. before: the lanes' lengths as they
 * came. G: what is left, W'W. Source: Hernandez, Roman, Tomas 2007 (delayed reorthogonalisation). */
static void project(sl_krylov *k, int32_t at, double *before, double *G)
{
    const int32_t w = k->w, columns = sl_krylov_columns(k);
    const bool look_back = k->pending > w || k->applied / w % look_back_every == 0; /* wider blocks: always */
    double *P = look_back ? k->spare : NULL;
    const sl_panel_pair looked_at = {w, {k->W, P}, {k->H, k->again}};
    const sl_panel_pair both = {w, {k->W, P}, {look_back ? k->corrected : k->H, k->again}};
    const sl_panel_pair alone = {w, {k->W, NULL}, {k->again, NULL}};
    bool again = false;
    sl_panels_project(&k->Q, columns, &looked_at, k->partial, k->context);
    if (look_back) {
        memset(k->again + (int64_t)at * w, 0, (size_t)(w * w) * sizeof *k->again);
        correct_projection(k, at);
    }
    sl_panels_subtract(&k->Q, columns, &both, k->partial, G, k->context);
    if (look_back) {
        sl_panels_store(&k->Q, at, k->spare, w);
    }
    for (int32_t c = 0; c < w; c++) {
        double squares = G[c * w + c];
        for (int32_t i = 0; i < columns; i++) {
            squares += k->H[i * w + c] * k->H[i * w + c];
        }
        before[c] = sqrt(squares);
        again = again || G[c * w + c] < kept_share * kept_share * squares;
    }
    if (again) {
        sl_panels_project(&k->Q, columns, &alone, k->partial, k->context);
        sl_panels_subtract(&k->Q, columns, &alone, k->partial, G, k->context);
        for (int32_t i = 0; i < columns * w; i++) {
            k->H[i] += k->again[i];
        }
    }
}

void sl_krylov_expand(sl_krylov *k)
{
    const int32_t w = k->w, total = k->applied + k->pending;
    const int64_t ld = (int64_t)k->max_basis + k->block;
    double before[SL_PANEL], G[SL_PANEL * SL_PANEL], R[SL_PANEL * SL_PANEL];
    sl_panels_load(&k->Q, k->fixed + k->applied, k->W, w);
    memcpy(k->spare, k->W, (size_t)k->Q.rows * (size_t)w * sizeof *k->spare);
    k->apply(k->user, k->W, w);
    k->operations += w;
    project(k, k->fixed + k->applied, before, G);
    sl_krylov_orthonormalise(k, G, before, R);
    for (int32_t c = 0; c < w; c++) {
        double *column = k->T + (k->applied + c) * ld;
        memset(column, 0, (size_t)ld * sizeof *column);
        for (int32_t i = 0; i < total; i++) {
            column[i] = k->H[(int64_t)(k->fixed + i) * w + c];
        }
        for (int32_t i = 0; i < w; i++) {
            column[total + i] = R[i * w + c];
        }
    }
    sl_panels_store(&k->Q, sl_krylov_columns(k), k->W, w);
    k->applied += w;
}

/* last[j] = ||B s_j|| */
static void measure_last(sl_krylov *k)
{
    const int64_t ld = (int64_t)k->max_basis + k->block;
    const int32_t m = k->applied;
    for (int32_t j = 0; j < k->found; j++) {
        double squares = 0.0;
        for (int32_t i = m; i < m + k->pending; i++) {
            double y = 0.0;
            for (int32_t l = 0; l < m; l++) {
                y += k->T[l * ld + i] * k->S[(int64_t)j * m + l];
            }
            squares += y * y;
        }
        k->last[j] = sqrt(squares);
    }
}

/* copy = T, its lower triangle: columns applied later know it best. */
static void copy_matrix(sl_krylov *k)
{
    const int32_t m = k->applied;
    const int64_t ld = (int64_t)k->max_basis + k->block;
    for (int32_t j = 0; j < m; j++) {
        for (int32_t i = j; i < m; i++) {
            k->copy[(int64_t)j * m + i] = k->T[i * ld + j];
        }
    }
}

/* All eigenpairs of T, ascending. Where values coincide LAPACK's fastest method may fail; then the simplest is used. */
static sl_status solve_matrix(sl_krylov *k)
{
    const int32_t m = k->applied;
    lapack_int found = 0, *support = k->lapack_int + 10 * (int64_t)m;
    copy_matrix(k);
    lapack_int info = LAPACKE_dsyevr_work(LAPACK_COL_MAJOR, 'V', 'A', 'L', m, k->copy, m, 0.0, 0.0, 0, 0, 0.0, &found,
                                          k->theta, k->S, m, support, k->lapack, 26 * m, k->lapack_int, 10 * m);
    if (info == 0 && found == m) {
        return SL_OK;
    }
    copy_matrix(k);
    info = LAPACKE_dsyev_work(LAPACK_COL_MAJOR, 'V', 'L', m, k->copy, m, k->theta, k->lapack, 26 * m);
    memcpy(k->S, k->copy, (size_t)m * (size_t)m * sizeof *k->S);
    return info == 0 ? SL_OK : SL_INTERNAL;
}

/* Puts the leading pairs first; they come ascending, so what leads stands at either end. */
static void order_pairs(sl_krylov *k)
{
    const int32_t m = k->applied;
    int32_t low = 0, high = m - 1;
    double *theta = k->lapack; /* done with */
    for (int32_t j = 0; j < m; j++) {
        const bool take_low = k->both_ends && fabs(k->theta[low]) > fabs(k->theta[high]);
        const int32_t from = take_low ? low++ : high--;
        theta[j] = k->theta[from];
        memcpy(k->copy + (int64_t)j * m, k->S + (int64_t)from * m, (size_t)m * sizeof *k->S);
    }
    memcpy(k->theta, theta, (size_t)m * sizeof *theta);
    memcpy(k->S, k->copy, (size_t)m * (size_t)m * sizeof *k->S);
}

sl_status sl_krylov_ritz(sl_krylov *k, int32_t count)
{
    k->found = count < k->applied ? count : k->applied;
    const sl_status status = solve_matrix(k);
    if (status == SL_OK) {
        order_pairs(k);
        measure_last(k);
    }
    return status;
}

void sl_krylov_select(sl_krylov *k, const int32_t *index, int32_t count)
{
    const int64_t m = k->applied;
    for (int32_t j = 0; j < count; j++) {
        k->theta[j] = k->theta[index[j]];
        k->last[j] = k->last[index[j]];
        memmove(k->S + j * m, k->S + index[j] * m, (size_t)m * sizeof *k->S);
    }
    k->found = count;
}

/* copy (rows x count, column-major) = S, with B s / theta under the first `extended` columns. */
static int32_t coefficients(sl_krylov *k, int32_t count, int32_t extended)
{
    const int32_t m = k->applied, rows = m + (extended > 0 ? k->pending : 0);
    const int64_t ld = (int64_t)k->max_basis + k->block;
    for (int32_t j = 0; j < count; j++) {
        double *c = k->copy + (int64_t)j * rows;
        memcpy(c, k->S + (int64_t)j * m, (size_t)m * sizeof *c);
        for (int32_t i = m; i < rows; i++) {
            c[i] = 0.0;
            for (int32_t l = 0; l < m && j < extended; l++) {
                c[i] += k->T[l * ld + i] * c[l] / k->theta[j];
            }
        }
    }
    return rows;
}

/* The same with rows of zeros for the fixed columns, which share panels with the others. */
static sl_status rotate(sl_krylov *k, int32_t rows, int32_t count, sl_panels *X)
{
    const int32_t all = k->fixed + rows;
    double *C = sl_calloc((int64_t)all * count, sizeof *C);
    if (C == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t j = 0; j < count; j++) {
        memcpy(C + (int64_t)j * all + k->fixed, k->copy + (int64_t)j * rows, (size_t)rows * sizeof *C);
    }
    const sl_status status = sl_panels_rotate(&k->Q, all, C, count, X, k->context);
    sl_free(C);
    return status;
}

sl_status sl_krylov_vectors(sl_krylov *k, int32_t count, int32_t extended, sl_panels *X)
{
    const int32_t rows = coefficients(k, count, extended);
    return rotate(k, rows, count, X);
}

/* T of the Ritz vectors kept: their values, and B S to the pending columns. */
static void restart_matrix(sl_krylov *k, int32_t kept)
{
    const int64_t ld = (int64_t)k->max_basis + k->block;
    const int32_t m = k->applied, p = k->pending;
    for (int32_t j = 0; j < kept; j++) {
        for (int32_t i = 0; i < p; i++) {
            double sum = 0.0;
            for (int32_t l = 0; l < m; l++) {
                sum += k->T[l * ld + m + i] * k->S[(int64_t)j * m + l];
            }
            k->copy[(int64_t)j * p + i] = sum;
        }
    }
    memset(k->T, 0, (size_t)(ld * ld) * sizeof *k->T);
    for (int32_t j = 0; j < kept; j++) {
        k->T[j * ld + j] = k->theta[j];
        memcpy(k->T + j * ld + kept, k->copy + (int64_t)j * p, (size_t)p * sizeof *k->T);
    }
}

/* C := [I, 0; 0, S; 0, I]: the fixed columns and the pending block stay. */
sl_status sl_krylov_restart(sl_krylov *k, int32_t kept)
{
    const int32_t m = k->applied, all = sl_krylov_columns(k), left = k->fixed + kept + k->pending;
    double *C = sl_calloc((int64_t)all * left, sizeof *C);
    if (C == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t j = 0; j < k->fixed; j++) {
        C[(int64_t)j * all + j] = 1.0;
    }
    for (int32_t j = 0; j < kept; j++) {
        memcpy(C + (int64_t)(k->fixed + j) * all + k->fixed, k->S + (int64_t)j * m, (size_t)m * sizeof *C);
    }
    for (int32_t j = 0; j < k->pending; j++) {
        C[(int64_t)(k->fixed + kept + j) * all + k->fixed + m + j] = 1.0;
    }
    const sl_status status = sl_panels_rotate(&k->Q, all, C, left, NULL, k->context);
    sl_free(C);
    if (status == SL_OK) {
        restart_matrix(k, kept);
        k->applied = kept;
    }
    return status;
}
