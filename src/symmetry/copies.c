/* Components that are copies of one another. */
#include "symmetry/symmetry_internal.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>

enum {
    ORIGINALS = 32, /* of equal counts, colours and length that a component is compared with, at most */
    PATCH = 64,
    FREE_WORK = 1 << 16,
    FREE_ROUNDS = 16
};

static const double ROUNDING = 4e-7; /* of distances kept as floats, over the diagonal */
static const double TINY = 1e-12;    /* of a sum */

typedef struct part {
    int32_t component, cells, corners;
    uint64_t color;
    double edges;
} part;

static int compare_length(const void *a, const void *b)
{
    const part *p = a, *q = b;
    if (p->corners != q->corners) {
        return p->corners < q->corners ? -1 : 1;
    }
    if (p->cells != q->cells) {
        return p->cells < q->cells ? -1 : 1;
    }
    if (p->color != q->color) {
        return p->color < q->color ? -1 : 1;
    }
    if (p->edges != q->edges) {
        return p->edges < q->edges ? -1 : 1;
    }
    return p->component < q->component ? -1 : 1;
}

static int compare_number(const void *a, const void *b)
{
    const part *p = a, *q = b;
    return p->component < q->component ? -1 : 1;
}

/* Of exact copies every edge agrees within twice the deviation. */
static bool same_length(const sl_symmetry_search *search, const part *a, const part *b)
{
    const double size = search->cells->size[a->component];
    return fabs(a->edges - b->edges) <= 2.0 * search->def->exact * size * a->corners + TINY * a->edges;
}

static bool alike(const sl_symmetry_search *search, const part *a, const part *b)
{
    return a->cells == b->cells && a->corners == b->corners && a->color == b->color && same_length(search, a, b);
}

/* Tries to send `from` to `to`, kept orientations first. */
static sl_status match(sl_symmetry_search *search, int32_t from, int32_t to, bool *found)
{
    sl_status status = SL_OK;
    const sl_cells *c = search->cells;
    const int32_t base = sl_cells_base(c, from), cell = c->component[from];
    const float tolerance = (float)((2.0 * search->def->exact + ROUNDING) * c->size[from]);
    const int64_t allowed = FREE_ROUNDS * (int64_t)sl_cells_corners(c, from) + FREE_WORK;
    int64_t work = 0;
    *found = false;
    for (int32_t reverses = 0; reverses < 2 && !*found; reverses++) {
        for (int32_t h = sl_cells_base(c, to); h < c->first[c->component[to + 1]] && !*found; h++) {
            float worst;
            if (c->color[c->cell[h]] == c->color[cell] && fabsf(c->radius[h] - c->radius[base]) <= tolerance &&
                work <= allowed &&
                sl_symmetry_walk(c, from, h, reverses != 0, PATCH, tolerance, search->image, &worst, &work)) {
                SL_TRY(sl_symmetry_try(search, from, to, h, reverses != 0, tolerance, SL_SYMMETRY_EXACT, &work, found));
            }
        }
    }
cleanup:
    return status;
}

/* Parts that may be copies of one another, by component number. */
static sl_status match_run(sl_symmetry_search *search, part *run, int32_t count)
{
    sl_status status = SL_OK;
    int32_t originals = 0; /* moved to the front */
    qsort(run, (size_t)count, sizeof *run, compare_number);
    for (int32_t i = 0; i < count; i++) {
        bool found = false;
        int32_t compared = 0;
        SL_TRY(sl_report_progress(search->context, "copies", 0.2));
        for (int32_t k = 0; k < originals && !found && compared < ORIGINALS; k++) {
            if (same_length(search, &run[k], &run[i])) {
                compared++;
                SL_TRY(match(search, run[k].component, run[i].component, &found));
                if (found) {
                    search->out->original[run[i].component] = run[k].component;
                }
            }
        }
        if (!found) {
            run[originals++] = run[i];
        }
    }
cleanup:
    return status;
}

sl_status sl_symmetry_copies(sl_symmetry_search *search)
{
    sl_status status = SL_OK;
    const sl_cells *c = search->cells;
    part *parts = sl_alloc(c->components, sizeof *parts);
    if (parts == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t k = 0; k < c->components; k++) {
        parts[k] = (part){k, c->component[k + 1] - c->component[k], sl_cells_corners(c, k), c->sum[k], c->edges[k]};
    }
    qsort(parts, (size_t)c->components, sizeof *parts, compare_length);
    for (int32_t begin = 0, end; begin < c->components; begin = end) {
        for (end = begin + 1; end < c->components && alike(search, &parts[end - 1], &parts[end]);) {
            end++;
        }
        if (end - begin > 1) {
            SL_TRY(match_run(search, parts + begin, end - begin));
        }
    }
cleanup:
    sl_free(parts);
    return status;
}
