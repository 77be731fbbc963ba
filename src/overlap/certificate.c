#include "overlap/certificate.h"

#include "base/memory.h"
#include "geom/predicates.h"
#include "overlap/border_grid_internal.h"

#include <math.h>

enum { AHEAD = 64 }; /* triangles whose corners are asked for before they are needed: halves the time of a million */

static bool finite_uv(const double *uv, int64_t n, const int32_t *vertex)
{
    for (int64_t k = 0; k < n; k++) {
        if (!isfinite(uv[2 * (int64_t)vertex[k]]) || !isfinite(uv[2 * (int64_t)vertex[k] + 1])) {
            return false;
        }
    }
    return true;
}

/* False if a corner is not finite: the filter is never sure of those, so nearly all corners are read once. */
static bool count_orientations(const double *uv, int32_t nt, const int32_t *tri, sl_certificate *out)
{
    int32_t positive = 0, negative = 0;
    for (int32_t t = 0; t < nt; t++) {
        const int32_t *corner = tri + 3 * (int64_t)t;
        const double *a = uv + 2 * (int64_t)corner[0], *b = uv + 2 * (int64_t)corner[1];
        const double *c = uv + 2 * (int64_t)corner[2];
        if (t < nt - 2 * AHEAD) {
            __builtin_prefetch(corner + 3 * 2 * AHEAD);
            __builtin_prefetch(uv + 2 * (int64_t)corner[3 * AHEAD]);
            __builtin_prefetch(uv + 2 * (int64_t)corner[3 * AHEAD + 2]);
        }
        int sign = sl_orient2d_sure(a, b, c);
        if (sign == 0) {
            if (!finite_uv(uv, 3, corner)) {
                return false;
            }
            sign = sl_orient2d(a, b, c);
        }
        positive += sign > 0;
        negative += sign < 0;
    }
    out->flipped = negative;
    out->degenerate = nt - positive - negative;
    return true;
}

/* Border edges i and j have a common point they must not have. Two that share a vertex meet there rightly; having more
 * in common, two straight segments lie on one line and overlap. */
static bool edges_clash(const double *uv, const int32_t *border, int32_t i, int32_t j)
{
    const int32_t a = border[2 * (int64_t)i], b = border[2 * (int64_t)i + 1];
    const int32_t c = border[2 * (int64_t)j], d = border[2 * (int64_t)j + 1];
    const double *pa = uv + 2 * (int64_t)a, *pb = uv + 2 * (int64_t)b;
    const double *pc = uv + 2 * (int64_t)c, *pd = uv + 2 * (int64_t)d;
    for (int k = 0; k < 2; k++) { /* boxes apart: most pairs end here */
        if (fmax(pa[k], pb[k]) < fmin(pc[k], pd[k]) || fmax(pc[k], pd[k]) < fmin(pa[k], pb[k])) {
            return false;
        }
    }
    const bool adjacent = a == c || a == d || b == c || b == d;
    if (adjacent) { /* only edges on one line can have more in common than their vertex: nearly none are */
        const double *own = a == c || a == d ? pb : pa, *other = c == a || c == b ? pd : pc;
        if (sl_orient2d_sure(a == c || a == d ? pa : pb, own, other) != 0) {
            return false;
        }
    }
    const sl_crossing crossing = sl_segments_cross(pa, pb, pc, pd);
    return adjacent ? crossing == SL_CROSS_OVERLAP : crossing != SL_CROSS_NONE;
}

/* Tests edge i against the edges after it in its cells; stamp[j] = i once j was tested. */
static void count_clashes(const double *uv, const int32_t *border, const sl_border_grid *grid, int32_t i,
                          int32_t *stamp, sl_certificate *out)
{
    int32_t nearest = -1; /* smallest j that clashes */
    for (int64_t k = grid->cell_first[i]; k < grid->cell_first[i + 1]; k++) {
        const int32_t c = grid->cell[k];
        for (int64_t m = grid->member_first[c + 1]; m-- > grid->member_first[c] && grid->member[m] > i;) {
            const int32_t j = grid->member[m];
            if (stamp[j] == i) {
                continue;
            }
            stamp[j] = i;
            if (edges_clash(uv, border, i, j)) {
                nearest = nearest < 0 || j < nearest ? j : nearest;
                out->border_crossings += out->border_crossings < SL_CERTIFICATE_MAX_CROSSINGS;
            }
        }
    }
    if (out->first_edge[0] < 0 && nearest >= 0) {
        out->first_edge[0] = i;
        out->first_edge[1] = nearest;
    }
}

static sl_status check_border(const double *uv, int32_t nb, const int32_t *border, sl_certificate *out)
{
    sl_status status = SL_OK;
    sl_border_grid grid = {0};
    int32_t *stamp = sl_alloc(nb, sizeof *stamp);
    if (stamp == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    SL_TRY(sl_border_grid_build(uv, nb, border, &grid));
    for (int32_t i = 0; i < nb; i++) {
        stamp[i] = -1;
    }
    for (int32_t i = 0; i < nb && out->border_crossings < SL_CERTIFICATE_MAX_CROSSINGS; i++) {
        count_clashes(uv, border, &grid, i, stamp, out);
    }
cleanup:
    sl_border_grid_clear(&grid);
    sl_free(stamp);
    return status;
}

sl_status sl_certify_embedding(const double *uv, int32_t nt, const int32_t *tri, int32_t nb, const int32_t *border,
                               sl_certificate *out)
{
    SL_ASSERT(nt >= 0 && nb >= 0);
    sl_certificate found = {.first_edge = {-1, -1}};
    if (!count_orientations(uv, nt, tri, &found) || !finite_uv(uv, 2 * (int64_t)nb, border)) {
        return SL_BAD_INPUT;
    }
    const sl_status status = check_border(uv, nb, border, &found);
    if (status != SL_OK) {
        return status;
    }
    found.embedded = found.flipped == 0 && found.degenerate == 0 && found.border_crossings == 0;
    *out = found;
    return SL_OK;
}
