#include "overlap/exact.h"

#include "base/memory.h"
#include "geom/predicates.h"
#include "overlap/exact_internal.h"

#include <math.h>
#include <string.h>

/* Triangles with area, counter-clockwise. */
typedef struct piece_list {
    int32_t count;
    int32_t *number;  /* of the triangle in the caller's list */
    double *triangle; /* 6 each */
} piece_list;

/* False if a coordinate is not finite. */
static bool list_pieces(const double *uv, int32_t nt, const int32_t *tri, piece_list *pieces)
{
    for (int32_t t = 0; t < nt; t++) {
        double *p = pieces->triangle + 6 * (int64_t)pieces->count;
        for (int k = 0; k < 3; k++) {
            memcpy(p + 2 * k, uv + 2 * (int64_t)tri[3 * (int64_t)t + k], 2 * sizeof *p);
            if (!isfinite(p[2 * k]) || !isfinite(p[2 * k + 1])) {
                return false;
            }
        }
        const int sign = sl_orient2d_quick(p, p + 2, p + 4);
        if (sign < 0) {
            double held[2];
            memcpy(held, p + 2, sizeof held);
            memcpy(p + 2, p + 4, sizeof held);
            memcpy(p + 4, held, sizeof held);
        }
        if (sign != 0) {
            pieces->number[pieces->count++] = t;
        }
    }
    return true;
}

/* From the pieces back to the caller's triangles. */
static void spread_marks(const piece_list *pieces, const uint8_t *mark, int32_t nt, uint8_t *red,
                         sl_exact_overlap *found)
{
    memset(red, 0, (size_t)nt);
    found->red = 0;
    for (int32_t i = 0; i < pieces->count; i++) {
        red[pieces->number[i]] = mark[i];
        found->red += mark[i];
    }
}

sl_status sl_overlap_exact(const double *uv, int32_t nt, const int32_t *tri, const sl_context *context, uint8_t *red,
                           sl_exact_overlap *out)
{
    SL_ASSERT(nt >= 0);
    sl_status status = SL_OK;
    int32_t pair[2] = {-1, -1};
    piece_list pieces = {0, sl_alloc(nt, sizeof *pieces.number), sl_alloc(nt, 6 * sizeof *pieces.triangle)};
    uint8_t *taken = sl_calloc(nt, 1), *mark = sl_alloc(nt, 1);
    if (pieces.number == NULL || pieces.triangle == NULL || taken == NULL || mark == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    if (!list_pieces(uv, nt, tri, &pieces)) {
        SL_TRY(SL_BAD_INPUT);
    }
    SL_TRY(sl_exact_sweep(pieces.count, pieces.triangle, red == NULL, taken, pair));
    sl_exact_overlap found = {.degenerate = nt - pieces.count, .first = {-1, -1}, .red = pair[0] >= 0 ? 2 : 0};
    for (int k = 0; k < 2 && pair[0] >= 0; k++) {
        found.first[k] = pieces.number[pair[k]];
    }
    if (red != NULL) {
        SL_TRY(sl_exact_mark(pieces.count, pieces.triangle, taken, context, mark));
        spread_marks(&pieces, mark, nt, red, &found);
    }
    *out = found;
cleanup:
    sl_free(pieces.number);
    sl_free(pieces.triangle);
    sl_free(taken);
    sl_free(mark);
    return status;
}
