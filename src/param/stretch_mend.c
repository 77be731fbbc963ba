/* A map that is right but for a few triangles, made flip-free by smoothing it around them. */
#include "param/stretch_levels_internal.h"

#include "base/memory.h"
#include "overlap/certificate.h"

#include <string.h>

enum {
    TIMES = 12,        /* that the region is marked anew, each time a ring wider every other time */
    SWEEPS_A_TIME = 6, /* of smoothing */
    ROUNDS = 4,        /* of mending flips and parting borders */
    PARTINGS = 400,    /* pairs of border edges that are parted in a round */
};
static const double INWARDS = 0.3; /* of the way to the mean of the inner neighbours; their neighbours half of it */

static double doubled_area(const sl_patch *patch, const double *uv, int32_t t)
{
    const double *a = uv + 2 * (int64_t)patch->tri[3 * t], *b = uv + 2 * (int64_t)patch->tri[3 * t + 1];
    const double *c = uv + 2 * (int64_t)patch->tri[3 * t + 2];
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/* Lists the vertices of flipped triangles. marked: nv zeros. */
static int32_t mark_flipped(const sl_patch *patch, const double *uv, uint8_t *marked, int32_t *list)
{
    int32_t n = 0;
    for (int32_t t = 0; t < patch->nt; t++) {
        for (int32_t c = 3 * t; c < 3 * t + 3 && !(doubled_area(patch, uv, t) > 0.0); c++) {
            const int32_t v = patch->tri[c];
            if (marked[v] == 0) {
                marked[v] = 1;
                list[n++] = v;
            }
        }
    }
    return n;
}

/* A ring more. */
static int32_t widen(const sl_patch *patch, uint8_t *marked, int32_t *list, int32_t n)
{
    const int32_t before = n;
    for (int32_t k = 0; k < before; k++) {
        int32_t h = patch->outgoing[list[k]];
        do {
            const int32_t beside[2] = {patch->tri[sl_corner_next(h)], patch->tri[sl_corner_prev(h)]};
            for (int j = 0; j < 2; j++) {
                if (marked[beside[j]] == 0) {
                    marked[beside[j]] = 1;
                    list[n++] = beside[j];
                }
            }
            h = patch->twin[sl_corner_prev(h)];
        } while (h >= 0 && h != patch->outgoing[list[k]]);
    }
    return n;
}

/* To the mean of the neighbours; a border vertex to that of its neighbours on the border, whose shape it keeps. */
static void move(const sl_patch *patch, int32_t v, double *uv)
{
    const bool border = patch->border[v] != 0;
    double sum[2] = {0.0, 0.0}, count = 0.0;
    int32_t h = patch->outgoing[v];
    do {
        const int32_t last = patch->twin[sl_corner_prev(h)];
        const int32_t beside[2] = {patch->tri[sl_corner_next(h)], patch->tri[sl_corner_prev(h)]};
        const bool take[2] = {!border || h == patch->outgoing[v], border && last < 0};
        for (int j = 0; j < 2; j++) {
            if (take[j]) {
                sum[0] += uv[2 * (int64_t)beside[j]];
                sum[1] += uv[2 * (int64_t)beside[j] + 1];
                count += 1.0;
            }
        }
        h = last;
    } while (h >= 0 && h != patch->outgoing[v]);
    uv[2 * (int64_t)v] = sum[0] / count;
    uv[2 * (int64_t)v + 1] = sum[1] / count;
}

/* Smooths until nothing is flipped. marked: nv zeros; list: nv. */
static bool mend_flips(const sl_patch *patch, uint8_t *marked, int32_t *list, double *uv)
{
    for (int time = 0; time < TIMES; time++) {
        int32_t n = mark_flipped(patch, uv, marked, list);
        if (n == 0) {
            return true;
        }
        for (int ring = 0; ring < time / 2; ring++) {
            n = widen(patch, marked, list, n);
        }
        for (int sweep = 0; sweep < SWEEPS_A_TIME; sweep++) {
            for (int32_t k = 0; k < n; k++) {
                move(patch, list[k], uv);
            }
        }
        for (int32_t k = 0; k < n; k++) {
            marked[list[k]] = 0;
        }
    }
    return false;
}

/* A border vertex some of the way to the mean of its inner neighbours. */
static void pull_in(const sl_patch *patch, int32_t v, double share, double *uv)
{
    double sum[2] = {0.0, 0.0}, count = 0.0;
    for (int32_t h = patch->twin[sl_corner_prev(patch->outgoing[v])]; h >= 0; h = patch->twin[sl_corner_prev(h)]) {
        const int32_t w = patch->tri[sl_corner_next(h)];
        sum[0] += uv[2 * (int64_t)w];
        sum[1] += uv[2 * (int64_t)w + 1];
        count += 1.0;
    }
    for (int k = 0; k < 2 && count > 0.0; k++) {
        uv[2 * (int64_t)v + k] += share * (sum[k] / count - uv[2 * (int64_t)v + k]);
    }
}

/* Pulls border edges that cross inwards, a pair at a time. */
static sl_status part_border(const sl_patch *patch, int32_t nb, const int32_t *border, double *uv, bool *simple)
{
    sl_status status = SL_OK;
    *simple = false;
    for (int k = 0; k < PARTINGS && !*simple && status == SL_OK; k++) {
        sl_certificate c = {0};
        status = sl_certify_embedding(uv, 0, patch->tri, nb, border, &c);
        *simple = status == SL_OK && c.border_crossings == 0;
        for (int j = 0; j < 2 && status == SL_OK && !*simple; j++) {
            const int32_t a = border[2 * c.first_edge[j]], b = border[2 * c.first_edge[j] + 1];
            pull_in(patch, a, INWARDS, uv);
            pull_in(patch, b, INWARDS, uv);
            pull_in(patch, patch->tri[sl_corner_next(patch->outgoing[b])], 0.5 * INWARDS, uv);
        }
    }
    return status;
}

sl_status sl_stretch_mend(const sl_patch *patch, bool simple, double *uv, bool *mended)
{
    sl_status status = SL_OK;
    uint8_t *marked = sl_calloc(patch->nv, sizeof *marked);
    int32_t *list = sl_alloc(patch->nv, sizeof *list), *border = NULL, nb = 0;
    *mended = false;
    SL_TRY(marked == NULL || list == NULL ? SL_OUT_OF_MEMORY : SL_OK);
    SL_TRY(simple ? sl_patch_border_edges(patch, &nb, &border) : SL_OK);
    for (int k = 0; k < ROUNDS && !*mended; k++) {
        bool parted = !simple;
        if (!mend_flips(patch, marked, list, uv)) {
            break;
        }
        if (simple) {
            SL_TRY(part_border(patch, nb, border, uv, &parted));
        }
        *mended = parted && mark_flipped(patch, uv, marked, list) == 0;
        memset(marked, 0, (size_t)patch->nv * sizeof *marked);
    }
cleanup:
    sl_free(marked);
    sl_free(list);
    sl_free(border);
    return status;
}
