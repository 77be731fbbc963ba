/* The matrix of the Newton system, where each triangle's entries go in it, and its solution. */
#include "param/stretch_internal.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

/* Shares of its own diagonal added to the Hessian, tried in turn. The first removes the translations (and the rotation
 * at a minimum) from its null space; the others are for lost digits. */
static const double SHIFTS[] = {1e-10, 1e-7, 1e-4, 1e-2};

enum { CORNER_UNKNOWNS = 6 };

/* The graph of the blocks of unknowns that triangles couple: those above block i are hi[first[i] .. end[i] - 1],
 * ascending. */
typedef struct block_graph {
    int32_t blocks, size;
    int64_t *first, *end;
    int32_t *hi;
} block_graph;

static int32_t unknown_of(const sl_stretch_freedom *freedom, int32_t v, int32_t side)
{
    return freedom->unknown != NULL ? freedom->unknown[2 * (int64_t)v + side] : 2 * v + side;
}

/* The blocks of triangle t, -1 = none: three of two unknowns, or six of one. */
static inline int32_t blocks_of(const sl_patch *patch, const sl_stretch_freedom *freedom, int32_t t,
                                int32_t block[CORNER_UNKNOWNS])
{
    if (freedom->unknown == NULL) {
        memcpy(block, &patch->tri[3 * (int64_t)t], 3 * sizeof *block);
        return 3;
    }
    const int32_t each = 2 / freedom->block;
    for (int32_t i = 0; i < 3 * each; i++) {
        const int32_t u = unknown_of(freedom, patch->tri[3 * t + i / each], i % each);
        block[i] = u < 0 ? -1 : u / freedom->block;
    }
    return 3 * each;
}

/* Counts (hi == NULL) or lists a pair of blocks by the lower one. */
static inline void list_pair(int32_t a, int32_t b, int64_t *next, int32_t *hi)
{
    const int32_t lo = a < b ? a : b;
    if (lo < 0 || a == b) {
        return;
    }
    if (hi != NULL) {
        hi[next[lo]] = a < b ? b : a;
    }
    next[lo]++;
}

/* The pairs of blocks in triangles, perhaps more than once. */
static void list_pairs(const sl_patch *patch, const sl_stretch_freedom *freedom, int64_t *next, int32_t *hi)
{
    for (int32_t t = 0; t < patch->nt; t++) {
        int32_t block[CORNER_UNKNOWNS];
        const int32_t count = blocks_of(patch, freedom, t, block);
        if (count == 3) { /* blocks are vertices: what lies behind a halfedge with a smaller twin is listed already */
            for (int32_t k = 0; k < 3; k++) {
                if (patch->twin[3 * t + k] < 3 * t + k) {
                    list_pair(block[k], block[k == 2 ? 0 : k + 1], next, hi);
                }
            }
            continue;
        }
        for (int32_t i = 1; i < count; i++) {
            for (int32_t j = 0; j < i; j++) {
                list_pair(block[i], block[j], next, hi);
            }
        }
    }
}

/* Sorts a short list in place and drops repetitions; returns its end. */
static int64_t sort_unique(int32_t *list, int64_t begin, int64_t end)
{
    int64_t kept = begin;
    for (int64_t i = begin; i < end; i++) {
        const int32_t x = list[i];
        int64_t k = kept;
        for (; k > begin && list[k - 1] > x; k--) {
            list[k] = list[k - 1];
        }
        if (k > begin && list[k - 1] == x) { /* back again */
            for (; k < kept; k++) {
                list[k] = list[k + 1];
            }
            continue;
        }
        list[k] = x;
        kept++;
    }
    return kept;
}

static sl_status block_graph_init(const sl_patch *patch, const sl_stretch_freedom *freedom, block_graph *g)
{
    g->size = freedom->block;
    g->blocks = freedom->unknowns / freedom->block;
    g->first = sl_calloc((int64_t)g->blocks + 1, sizeof *g->first);
    g->end = sl_calloc((int64_t)g->blocks + 1, sizeof *g->end);
    if (g->first == NULL || g->end == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    list_pairs(patch, freedom, g->end, NULL);
    for (int32_t i = 0; i < g->blocks; i++) {
        g->first[i + 1] = g->first[i] + g->end[i];
        g->end[i] = g->first[i];
    }
    g->hi = sl_alloc(g->first[g->blocks], sizeof *g->hi);
    if (g->hi == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    list_pairs(patch, freedom, g->end, g->hi);
    for (int32_t i = 0; i < g->blocks; i++) {
        g->end[i] = sort_unique(g->hi, g->first[i], g->end[i]);
    }
    return SL_OK;
}

static void block_graph_clear(block_graph *g)
{
    sl_free(g->first);
    sl_free(g->end);
    sl_free(g->hi);
}

/* The pattern of H: column (i, c) has the rows (i, c) .. (i, size - 1) and all those of the blocks above i. */
static sl_status create_matrix(const block_graph *g, sl_csc **out)
{
    int64_t nnz = 0, p = 0;
    for (int32_t i = 0; i < g->blocks; i++) {
        nnz += g->size * (g->size + 1) / 2 + (g->end[i] - g->first[i]) * g->size * g->size;
    }
    if (nnz >= INT32_MAX) {
        return SL_OUT_OF_MEMORY;
    }
    const int32_t n = g->blocks * g->size;
    const sl_status status = sl_csc_create(n, n, nnz + 1, out); /* one more: where what is held goes */
    if (status != SL_OK) {
        return status;
    }
    sl_csc *H = *out;
    for (int32_t i = 0; i < g->blocks; i++) {
        for (int32_t c = 0; c < g->size; c++) {
            for (int32_t r = c; r < g->size; r++) {
                H->row[p++] = g->size * i + r;
            }
            for (int64_t k = g->first[i]; k < g->end[i]; k++) {
                for (int32_t r = 0; r < g->size; r++) {
                    H->row[p++] = g->size * g->hi[k] + r;
                }
            }
            H->colptr[g->size * i + c + 1] = p;
        }
    }
    return SL_OK;
}

/* The entries that blocks a and b share, which are the triangle's unknowns from i and from j on. size: g->size, known
 * to the compiler. */
static inline void place_pair(const block_graph *g, const sl_csc *H, int size, int32_t a, int32_t b, int i, int j,
                              int32_t *place)
{
    const int32_t lo = a < b ? a : b, hi = a < b ? b : a;
    int64_t k = g->first[lo];
    while (k < g->end[lo] && g->hi[k] != hi) {
        k++;
    }
    SL_ASSERT(k < g->end[lo]);
    const int64_t below = size * (k - g->first[lo] + 1);
    for (int r = 0; r < size; r++) {
        for (int c = 0; c < size; c++) { /* a column of a block has the rows of its own from the diagonal on */
            const int32_t col = a < b ? r : c, row = a < b ? c : r;
            place[sl_stretch_entry(i + r, j + c)] = (int32_t)(H->colptr[size * lo + col] - col + below + row);
        }
    }
}

static inline void place_own(const sl_csc *H, int size, int32_t a, int i, int j, int32_t *place)
{
    for (int r = 0; r < size; r++) {
        for (int c = 0; c <= r; c++) {
            place[sl_stretch_entry(i + r, j + c)] = (int32_t)(H->colptr[size * a + c] + r - c);
        }
    }
}

/* The entries of one triangle, whose unknowns make 6 / size blocks. */
static inline void place_triangle(const block_graph *g, const sl_csc *H, int size, const int32_t *block, int32_t *place)
{
    for (int i = 0; i < CORNER_UNKNOWNS / size; i++) {
        for (int j = 0; j <= i && block[i] >= 0; j++) {
            if (block[j] == block[i]) {
                place_own(H, size, block[i], size * i, size * j, place);
            } else if (block[j] >= 0) {
                place_pair(g, H, size, block[i], block[j], size * i, size * j, place);
            }
        }
    }
}

static void find_places(const sl_patch *patch, const sl_stretch_freedom *freedom, const block_graph *g,
                        sl_stretch_system *system)
{
    const int32_t nowhere = (int32_t)system->H->colptr[system->H->ncols];
    for (int32_t t = 0; t < patch->nt; t++) {
        int32_t *place = &system->place[SL_ELEMENT * (int64_t)t], block[CORNER_UNKNOWNS];
        for (int e = 0; e < SL_ELEMENT && freedom->unknown != NULL; e++) {
            place[e] = nowhere;
        }
        if (blocks_of(patch, freedom, t, block) == 3) {
            place_triangle(g, system->H, 2, block, place);
        } else {
            place_triangle(g, system->H, 1, block, place);
        }
    }
}

/* A point in space a block, for geometric dissection; NULL where lines have none. */
static const double *points_of(const sl_patch *patch, const sl_stretch_freedom *freedom, double *points)
{
    if (freedom->unknown == NULL || points == NULL) {
        return freedom->unknown == NULL ? patch->xyz : NULL;
    }
    for (int32_t v = 0; v < patch->nv; v++) {
        const int32_t u = freedom->unknown[2 * (int64_t)v];
        if (u >= 0) {
            memcpy(&points[3 * (int64_t)(u / 2)], &patch->xyz[3 * (int64_t)v], 3 * sizeof *points);
        }
    }
    return points;
}

static sl_status analyze(const sl_patch *patch, const sl_stretch_freedom *freedom, sl_stretch_system *system)
{
    sl_status status = SL_OK;
    double *points = NULL;
    sl_cholesky_def def = sl_cholesky_default();
    def.block = freedom->block;
    if (freedom->unknown != NULL && freedom->block == 2) {
        points = sl_alloc(freedom->unknowns / 2, 3 * sizeof *points);
        SL_TRY(points != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    }
    def.xyz = points_of(patch, freedom, points);
    SL_TRY(sl_cholesky_analyze(system->H, &def, &system->factor));
cleanup:
    sl_free(points);
    return status;
}

sl_status sl_stretch_system_init(const sl_patch *patch, const sl_stretch_freedom *freedom, sl_stretch_system *system)
{
    sl_status status = SL_OK;
    block_graph g = {0};
    *system = (sl_stretch_system){0};
    SL_TRY(block_graph_init(patch, freedom, &g));
    SL_TRY(create_matrix(&g, &system->H));
    SL_TRY(analyze(patch, freedom, system));
    system->place = sl_alloc(patch->nt, SL_ELEMENT * sizeof *system->place);
    system->reduced = sl_alloc(freedom->unknowns, sizeof *system->reduced);
    system->work = sl_alloc(sl_cholesky_work_size(system->factor, 1), sizeof *system->work);
    if (system->place == NULL || system->reduced == NULL || system->work == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    find_places(patch, freedom, &g, system);
cleanup:
    block_graph_clear(&g);
    if (status != SL_OK) {
        sl_stretch_system_clear(system);
    }
    return status;
}

void sl_stretch_system_clear(sl_stretch_system *system)
{
    sl_csc_free(system->H);
    sl_cholesky_free(system->factor);
    sl_free(system->place);
    sl_free(system->reduced);
    sl_free(system->work);
    *system = (sl_stretch_system){0};
}

/* y = minus the part of the force that the unknowns feel. */
static void reduce_force(const sl_stretch_freedom *freedom, const double *force, double *y)
{
    if (freedom->unknown == NULL) {
        for (int32_t i = 0; i < freedom->unknowns; i++) {
            y[i] = -force[i];
        }
        return;
    }
    memset(y, 0, (size_t)freedom->unknowns * sizeof *y);
    for (int64_t i = 0; i < 2 * (int64_t)freedom->nv; i++) {
        const int32_t u = freedom->unknown[i];
        const double *f = &force[i - i % 2];
        if (u >= 0 && freedom->basis == NULL) {
            y[u] -= force[i];
        } else if (u >= 0) {
            const double *b = &freedom->basis[2 * i];
            y[u] -= b[0] * f[0] + b[1] * f[1];
        }
    }
}

static void expand(const sl_stretch_freedom *freedom, const double *y, double *direction)
{
    for (int32_t v = 0; v < freedom->nv; v++) {
        const double a = unknown_of(freedom, v, 0) >= 0 ? y[unknown_of(freedom, v, 0)] : 0.0;
        const double b = unknown_of(freedom, v, 1) >= 0 ? y[unknown_of(freedom, v, 1)] : 0.0;
        const double *e = freedom->basis != NULL ? &freedom->basis[4 * (int64_t)v] : NULL;
        direction[2 * (int64_t)v] = e != NULL ? a * e[0] + b * e[2] : a;
        direction[2 * (int64_t)v + 1] = e != NULL ? a * e[1] + b * e[3] : b;
    }
}

sl_status sl_stretch_direction(const sl_stretch_freedom *freedom, sl_stretch_system *system, const double *force,
                               double *direction)
{
    sl_csc *H = system->H;
    sl_status status = SL_NOT_POSITIVE_DEFINITE;
    double before = 0.0;
    for (size_t s = 0; s < SL_COUNTOF(SHIFTS) && status == SL_NOT_POSITIVE_DEFINITE; s++) {
        for (int32_t j = 0; j < H->ncols; j++) {
            H->val[H->colptr[j]] *= (1.0 + SHIFTS[s]) / (1.0 + before);
        }
        before = SHIFTS[s];
        status = sl_cholesky_factor(system->factor, H, NULL);
    }
    if (status != SL_OK) {
        return status == SL_BAD_INPUT ? SL_NOT_POSITIVE_DEFINITE : status; /* overflow: no step from here either */
    }
    reduce_force(freedom, force, system->reduced);
    sl_cholesky_solve(system->factor, system->reduced, 1, system->work);
    expand(freedom, system->reduced, direction);
    return SL_OK;
}
