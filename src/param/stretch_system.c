#include "param/stretch_internal.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

/* Shares of its own diagonal added to the Hessian, tried in turn. The first removes the translations (and the rotation
 * at a minimum) from its null space; the others are for lost digits. */
static const double SHIFTS[] = {1e-10, 1e-7, 1e-4, 1e-2};

/* Lists the neighbours above each vertex: edges (lo, hi) of the patch, bucketed by lo, each list ascending.
 * first: nv + 1; hi: 3 nt at most. */
static void neighbours_above(const sl_patch *patch, int64_t *first, int32_t *hi, int64_t *next)
{
    for (int pass = 0; pass < 2; pass++) {
        for (int32_t h = 0; h < 3 * patch->nt; h++) {
            const int32_t v = patch->tri[h], w = patch->tri[sl_corner_next(h)];
            if (patch->twin[h] > h) {
                continue; /* an interior edge is listed by its higher halfedge */
            }
            const int32_t lo = v < w ? v : w;
            if (pass == 0) {
                first[lo + 1]++;
            } else {
                hi[next[lo]++] = v < w ? w : v;
            }
        }
        for (int32_t v = 0; v < patch->nv && pass == 0; v++) {
            first[v + 1] += first[v];
            next[v] = first[v];
        }
    }
    for (int32_t v = 0; v < patch->nv; v++) {
        int64_t end = first[v];
        for (int64_t i = first[v]; i < next[v]; i++) { /* insertion sort: lists are short; equal entries merge */
            const int32_t x = hi[i];
            int64_t k = end;
            while (k > first[v] && hi[k - 1] > x) {
                k--;
            }
            if (k > first[v] && hi[k - 1] == x) {
                continue;
            }
            memmove(&hi[k + 1], &hi[k], (size_t)(end - k) * sizeof *hi);
            hi[k] = x;
            end++;
        }
        next[v] = end;
    }
}

/* The pattern of H: column 2 v has rows 2 v, 2 v + 1 and both rows of every neighbour above, column 2 v + 1 the same
 * without row 2 v. */
static void fill_pattern(const int64_t *first, const int64_t *next, const int32_t *hi, sl_csc *H)
{
    int64_t p = 0;
    for (int32_t v = 0; v < H->ncols / 2; v++) {
        for (int32_t side = 0; side < 2; side++) {
            for (int32_t r = side; r < 2; r++) {
                H->row[p++] = 2 * v + r;
            }
            for (int64_t i = first[v]; i < next[v]; i++) {
                H->row[p++] = 2 * hi[i];
                H->row[p++] = 2 * hi[i] + 1;
            }
            H->colptr[2 * v + side + 1] = p;
        }
    }
}

/* Where the block of each triangle's edges begins in its column 2 lo. */
static void find_slots(const sl_patch *patch, const int64_t *first, const int64_t *next, const int32_t *hi,
                       const sl_csc *H, int64_t *slot)
{
    for (int32_t h = 0; h < 3 * patch->nt; h++) {
        const int32_t v = patch->tri[h], w = patch->tri[sl_corner_next(h)];
        const int32_t lo = v < w ? v : w, up = v < w ? w : v;
        int64_t i = first[lo];
        while (i < next[lo] && hi[i] != up) {
            i++;
        }
        SL_ASSERT(i < next[lo]);
        slot[h] = H->colptr[2 * lo] + 2 + 2 * (i - first[lo]);
    }
}

/* The order of elimination, found on the vertices: both unknowns of one follow each other. perm: 2 nv. */
static sl_status order_unknowns(const sl_patch *patch, const int64_t *first, const int64_t *next, const int32_t *hi,
                                int32_t *perm)
{
    sl_csc *graph = NULL;
    int64_t nnz = patch->nv, p = 0;
    for (int32_t v = 0; v < patch->nv; v++) {
        nnz += next[v] - first[v];
    }
    sl_status status = sl_csc_create(patch->nv, patch->nv, nnz, &graph);
    if (status != SL_OK) {
        return status;
    }
    for (int32_t v = 0; v < patch->nv; v++) {
        graph->row[p++] = v;
        for (int64_t i = first[v]; i < next[v]; i++) {
            graph->row[p++] = hi[i];
        }
        graph->colptr[v + 1] = p;
    }
    memset(graph->val, 0, (size_t)nnz * sizeof *graph->val);
    status = sl_order(graph, SL_ORDER_AUTO, patch->xyz, perm);
    for (int32_t k = patch->nv; k-- > 0 && status == SL_OK;) { /* backwards: perm[k] is read before it is overwritten */
        const int32_t v = perm[k];
        perm[2 * (int64_t)k] = 2 * v;
        perm[2 * (int64_t)k + 1] = 2 * v + 1;
    }
    sl_csc_free(graph);
    return status;
}

/* The pattern of H, empty, and its factor's analysis. */
static sl_status analyze(const sl_patch *patch, const int64_t *first, const int64_t *next, const int32_t *hi,
                         sl_stretch_system *system)
{
    sl_status status = SL_OK;
    int64_t nnz = 3 * (int64_t)patch->nv;
    int32_t *perm = sl_alloc(patch->nv, 2 * sizeof *perm);
    if (perm == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t v = 0; v < patch->nv; v++) {
        nnz += 4 * (next[v] - first[v]);
    }
    SL_TRY(sl_csc_create(2 * patch->nv, 2 * patch->nv, nnz, &system->H));
    fill_pattern(first, next, hi, system->H);
    memset(system->H->val, 0, (size_t)nnz * sizeof *system->H->val);
    SL_TRY(order_unknowns(patch, first, next, hi, perm));
    sl_cholesky_def def = sl_cholesky_default();
    def.perm = perm;
    SL_TRY(sl_cholesky_analyze(system->H, &def, &system->factor));
cleanup:
    sl_free(perm);
    return status;
}

sl_status sl_stretch_system_init(const sl_patch *patch, sl_stretch_system *system)
{
    sl_status status = SL_OK;
    *system = (sl_stretch_system){0};
    int64_t *first = sl_calloc((int64_t)patch->nv + 1, sizeof *first);
    int64_t *next = sl_calloc((int64_t)patch->nv + 1, sizeof *next);
    int32_t *hi = sl_alloc(3 * (int64_t)patch->nt, sizeof *hi);
    system->slot = sl_alloc(3 * (int64_t)patch->nt, sizeof *system->slot);
    if (first == NULL || next == NULL || hi == NULL || system->slot == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    neighbours_above(patch, first, hi, next);
    SL_TRY(analyze(patch, first, next, hi, system));
    find_slots(patch, first, next, hi, system->H, system->slot);
    system->work = sl_alloc(sl_cholesky_work_size(system->factor, 1), sizeof *system->work);
    status = system->work == NULL ? SL_OUT_OF_MEMORY : SL_OK;
cleanup:
    sl_free(first);
    sl_free(next);
    sl_free(hi);
    if (status != SL_OK) {
        sl_stretch_system_clear(system);
    }
    return status;
}

void sl_stretch_system_clear(sl_stretch_system *system)
{
    sl_csc_free(system->H);
    sl_cholesky_free(system->factor);
    sl_free(system->slot);
    sl_free(system->work);
    *system = (sl_stretch_system){0};
}

/* q = Q g, the pull-back of mode Q to the three corners; the same map turns dpsi/dJ into forces. */
static void pull_back(const double Q[4], const double g[4], double q[6])
{
    for (int r = 0; r < 2; r++) {
        q[2 + r] = Q[2 * r] * g[0] + Q[2 * r + 1] * g[1];
        q[4 + r] = Q[2 * r] * g[2] + Q[2 * r + 1] * g[3];
        q[r] = -(q[2 + r] + q[4 + r]);
    }
}

/* The projected 4 x 4 Hessian of a triangle's energy in J, times its weight. */
static void density_hessian(double w, double weight, const double J[4], double H[4][4])
{
    double lambda[4], Q[16];
    sl_stretch_density_modes(w, J, lambda, Q);
    memset(H, 0, 16 * sizeof H[0][0]);
    for (int m = 0; m < 4; m++) {
        const double positive = lambda[m] > 0.0 ? weight * lambda[m] : 0.0;
        for (int i = 0; i < 4; i++) {
            const double scaled = positive * Q[4 * m + i];
            for (int j = 0; j < 4; j++) {
                H[i][j] += scaled * Q[4 * m + j];
            }
        }
    }
}

/* The projected 6 x 6 Hessian of one triangle in its corners' places: of corners 1 and 2 by the chain rule through
 * J = ... + p_1 g_1' + p_2 g_2', of corner 0 from its rows adding up to zero. */
static void element_hessian(double w, double weight, const double J[4], const double g[4], double K[6][6])
{
    double H[4][4], half[4][4]; /* half: rows of corners 1 and 2, columns of J */
    density_hessian(w, weight, J, H);
    for (int i = 0; i < 4; i++) {
        const int row = 2 * (i % 2), k = i - i % 2;
        for (int j = 0; j < 4; j++) {
            half[i][j] = g[k] * H[row][j] + g[k + 1] * H[row + 1][j];
        }
    }
    for (int i = 0; i < 4; i++) {
        for (int s = 0; s < 2; s++) {
            K[2 + i][2 + s] = half[i][2 * s] * g[0] + half[i][2 * s + 1] * g[1];
            K[2 + i][4 + s] = half[i][2 * s] * g[2] + half[i][2 * s + 1] * g[3];
        }
    }
    for (int i = 2; i < 6; i++) {
        for (int s = 0; s < 2; s++) {
            K[i][s] = K[s][i] = -(K[i][2 + s] + K[i][4 + s]);
        }
    }
    for (int r = 0; r < 2; r++) {
        for (int s = 0; s < 2; s++) {
            K[r][s] = -(K[r][2 + s] + K[r][4 + s]);
        }
    }
}

static void scatter(const int32_t v[3], const int64_t slot[3], double K[6][6], sl_csc *H)
{
    for (int k = 0; k < 3; k++) {
        const int64_t p = H->colptr[2 * v[k]], q = H->colptr[2 * v[k] + 1];
        H->val[p] += K[2 * k][2 * k];
        H->val[p + 1] += K[2 * k + 1][2 * k];
        H->val[q] += K[2 * k + 1][2 * k + 1];
    }
    for (int k = 0; k < 3; k++) {
        const int next = (k + 1) % 3, lo = v[k] < v[next] ? k : next, hi = lo == k ? next : k;
        /* Column 2 lo + 1 lacks the row 2 lo of the column before it: its block stands one entry nearer its top. */
        const int64_t p = slot[k], q = H->colptr[2 * v[lo] + 1] + (p - H->colptr[2 * v[lo]]) - 1;
        H->val[p] += K[2 * hi][2 * lo];
        H->val[p + 1] += K[2 * hi + 1][2 * lo];
        H->val[q] += K[2 * hi][2 * lo + 1];
        H->val[q + 1] += K[2 * hi + 1][2 * lo + 1];
    }
}

/* Adds weight P g, the force of one triangle, to the vertices' sums. */
static void add_force(const int32_t v[3], double weight, const double P[4], const double g[4], double *sum)
{
    double q[6];
    pull_back(P, g, q);
    for (int k = 0; k < 3; k++) {
        sum[2 * (int64_t)v[k]] += weight * q[2 * k];
        sum[2 * (int64_t)v[k] + 1] += weight * q[2 * k + 1];
    }
}

void sl_stretch_assemble(const sl_patch *patch, const sl_stretch_rest *rest, double w, double cap, const double *uv,
                         sl_stretch_system *system, double *gradient, double *force)
{
    sl_csc *H = system->H;
    memset(H->val, 0, (size_t)H->colptr[H->ncols] * sizeof *H->val);
    memset(gradient, 0, 2 * (size_t)patch->nv * sizeof *gradient);
    memset(force, 0, 2 * (size_t)patch->nv * sizeof *force);
    for (int32_t t = 0; t < patch->nt; t++) {
        const int32_t *v = &patch->tri[3 * (int64_t)t];
        double g[4], J[4], P[4], K[6][6];
        memcpy(g, &rest->gradient[4 * (int64_t)t], sizeof g);
        sl_stretch_jacobian(rest, patch->tri, uv, t, J);
        sl_stretch_density_gradient(w, J, P);
        add_force(v, rest->weight[t], P, g, gradient);
        if (sl_stretch_soften(cap, J, g)) {
            sl_stretch_density_gradient(w, J, P);
        }
        add_force(v, rest->weight[t], P, g, force);
        element_hessian(w, rest->weight[t], J, g, K);
        scatter(v, &system->slot[3 * (int64_t)t], K, H);
    }
}

sl_status sl_stretch_direction(sl_stretch_system *system, const double *force, double *direction)
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
    for (int32_t i = 0; i < H->ncols; i++) {
        direction[i] = -force[i];
    }
    sl_cholesky_solve(system->factor, direction, 1, system->work);
    return SL_OK;
}

/* Smallest positive root of a t^2 + b t + c with c > 0; infinite when there is none. */
static double first_root(double a, double b, double c)
{
    const double discriminant = b * b - 4.0 * a * c;
    if (!(discriminant >= 0.0)) {
        return INFINITY;
    }
    const double root = sqrt(discriminant);
    if (b <= 0.0) { /* no cancellation in -b + root; with a < 0 the other root is negative and this one positive too */
        return root - b > 0.0 ? 2.0 * c / (root - b) : INFINITY;
    }
    return a < 0.0 ? (-b - root) / (2.0 * a) : INFINITY;
}

double sl_stretch_step_bound(const sl_patch *patch, const double *uv, const double *direction)
{
    double bound = INFINITY;
    for (int32_t t = 0; t < patch->nt; t++) {
        const int64_t i = 2 * (int64_t)patch->tri[3 * t], j = 2 * (int64_t)patch->tri[3 * t + 1];
        const int64_t k = 2 * (int64_t)patch->tri[3 * t + 2];
        const double ex = uv[j] - uv[i], ey = uv[j + 1] - uv[i + 1];
        const double fx = uv[k] - uv[i], fy = uv[k + 1] - uv[i + 1];
        const double px = direction[j] - direction[i], py = direction[j + 1] - direction[i + 1];
        const double qx = direction[k] - direction[i], qy = direction[k + 1] - direction[i + 1];
        const double root = first_root(px * qy - py * qx, ex * qy - ey * qx + px * fy - py * fx, ex * fy - ey * fx);
        bound = root < bound ? root : bound;
    }
    return bound;
}
