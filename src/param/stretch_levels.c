/* From coarse to fine: a chart is mapped with few of its vertices first, the others are put back level by level. */
#include "param/stretch_levels_internal.h"

#include "base/memory.h"
#include "geom/predicates.h"
#include "param/stretch_internal.h"
#include "param/tutte.h"

#include <math.h>
#include <string.h>

static const double LEVEL_SHARE = 0.25; /* triangles of a level, of those of the finer one */
static const int32_t LEAST = 200;       /* triangles: no coarser level than this, */
static const int32_t LEAST_OF_SMALL =
    50; /* or of charts of fewer than twice that many than half of theirs, nor than this */
static const double COARSE_DECREASE = 1e-2; /* relative_decrease on the coarse levels */

static const double SINGULAR = 20.0; /* energy a unit of area of the star of a vertex */

/* The last coarse level stretches more than the chart itself, over 400 charts by up to 2.5 times as much where it has
 * TRUSTED triangles; by HOPE times as much the chart is hopeless. */
static const double HOPE = 3.0, FAR_L2 = 10.0;
static const double FAR_ENERGY = 100.0; /* a unit of area; no chart worth having ends there */
static const int32_t TRUSTED = 500;

static sl_patch *level_patch_alloc(int32_t nv, int32_t nt)
{
    sl_patch *p = sl_calloc(1, sizeof *p);
    if (p == NULL) {
        return NULL;
    }
    p->nv = nv;
    p->nt = nt;
    p->loops = 1;
    p->euler = 1;
    p->xyz = sl_alloc(nv, 3 * sizeof *p->xyz);
    p->tri = sl_alloc(nt, 3 * sizeof *p->tri);
    p->twin = sl_alloc(nt, 3 * sizeof *p->twin);
    p->corner = sl_alloc(nt, 3 * sizeof *p->corner);
    p->facet = sl_alloc(nt, sizeof *p->facet);
    p->outgoing = sl_alloc(nv, sizeof *p->outgoing);
    p->border = sl_alloc(nv, sizeof *p->border);
    if (p->xyz == NULL || p->tri == NULL || p->twin == NULL || p->corner == NULL || p->facet == NULL ||
        p->outgoing == NULL || p->border == NULL) {
        sl_patch_free(p);
        return NULL;
    }
    return p;
}

sl_status sl_level_patch(const sl_patch *whole, const sl_level *level, sl_patch **out, int32_t **vertex)
{
    int32_t nv = 0;
    int32_t *local = sl_alloc(whole->nv, sizeof *local);
    *out = NULL;
    *vertex = NULL;
    if (local == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    memset(local, -1, (size_t)whole->nv * sizeof *local);
    for (int32_t c = 0; c < 3 * level->nt; c++) {
        local[level->tri[c]] = 0;
    }
    for (int32_t v = 0; v < whole->nv; v++) {
        local[v] = local[v] == 0 ? nv++ : -1;
    }
    sl_patch *p = level_patch_alloc(nv, level->nt);
    *vertex = sl_alloc(nv, sizeof **vertex);
    if (p == NULL || *vertex == NULL) {
        sl_patch_free(p);
        sl_free(*vertex);
        sl_free(local);
        *vertex = NULL;
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t v = 0; v < whole->nv; v++) {
        if (local[v] >= 0) {
            (*vertex)[local[v]] = v;
            memcpy(&p->xyz[3 * (int64_t)local[v]], &whole->xyz[3 * (int64_t)v], 3 * sizeof *p->xyz);
            p->border[local[v]] = whole->border[v];
        }
    }
    for (int32_t c = 0; c < 3 * level->nt; c++) {
        const int32_t v = local[level->tri[c]];
        p->tri[c] = v;
        p->twin[c] = level->twin[c];
        p->corner[c] = c;
        p->facet[c / 3] = c / 3;
        if (p->border[v] == 0 || level->twin[c] < 0) {
            p->outgoing[v] = c;
        }
    }
    sl_free(local);
    *out = p;
    return SL_OK;
}

/* One run down the levels. */
typedef struct descent {
    const sl_patch *patch;
    const sl_stretch_def *def;
    const sl_context *context;
    sl_levels levels;
    double *uv;    /* of all the patch's vertices */
    int32_t *next; /* along the border as it is at this level */
    int32_t loop;  /* a vertex that is always on it */
    bool hopeless;
} descent;

/* Would the border's edge a - b meet another one? */
static bool edge_is_free(const descent *d, int32_t a, int32_t b)
{
    const double *p = &d->uv[2 * (int64_t)a], *q = &d->uv[2 * (int64_t)b];
    const double x0 = fmin(p[0], q[0]), x1 = fmax(p[0], q[0]), y0 = fmin(p[1], q[1]), y1 = fmax(p[1], q[1]);
    int32_t v = d->loop;
    do {
        const int32_t w = d->next[v];
        const double *r = &d->uv[2 * (int64_t)v], *s = &d->uv[2 * (int64_t)w];
        if (v != a && v != b && w != a && w != b && fmin(r[0], s[0]) <= x1 && fmax(r[0], s[0]) >= x0 &&
            fmin(r[1], s[1]) <= y1 && fmax(r[1], s[1]) >= y0 && sl_segments_cross(p, q, r, s) != SL_CROSS_NONE) {
            return false;
        }
        v = w;
    } while (v != d->loop);
    return true;
}

/* A border vertex goes where its triangles want it, and where that would make the border cross itself, to the inner
 * side of the edge that stood for it. */
static bool insert(descent *d, const sl_removal *removal)
{
    const int32_t *ring = &d->levels.ring[removal->first], v = removal->vertex;
    const int32_t next = ring[0], last = ring[removal->count - 1];
    if (!sl_stretch_insert(d->patch->xyz, removal, ring, d->def->w, false, d->uv)) {
        return false;
    }
    if (!removal->open) {
        return true;
    }
    if (d->def->simple_border && !(edge_is_free(d, last, v) && edge_is_free(d, v, next)) &&
        !sl_stretch_insert(d->patch->xyz, removal, ring, d->def->w, true, d->uv)) {
        return false;
    }
    d->next[last] = v;
    d->next[v] = next;
    return true;
}

/* Puts the vertices back that level l lacks and the next finer one has. */
static bool refine_level(descent *d, int32_t l)
{
    const int32_t first = l > 0 ? d->levels.level[l - 1].removals : 0;
    for (int32_t r = d->levels.level[l].removals; r-- > first;) {
        if (!insert(d, &d->levels.removal[r])) {
            return false;
        }
    }
    return true;
}

static void start_border(descent *d, const sl_level *level)
{
    for (int32_t c = 0; c < 3 * level->nt; c++) {
        if (level->twin[c] < 0) {
            d->next[level->tri[c]] = level->tri[sl_corner_next(c)];
            d->loop = level->tri[c];
        }
    }
}

/* What the minimum on a coarse level says about that of the chart. */
static bool is_hopeless(const sl_stretch_def *def, const sl_patch *patch, const sl_stretch_info *info)
{
    return def->hopeless_gain > 0.0 && def->target_l2 > 0.0 && patch->nt >= TRUSTED && info->l2 <= FAR_L2 &&
           info->l2 - 1.0 > HOPE * (def->target_l2 - 1.0);
}

/* Where level l begins: the coarsest from Tutte's embedding. */
static sl_status start_level(descent *d, int32_t l, const sl_patch *patch, const int32_t *vertex, double *uv)
{
    if (l == d->levels.count - 1) {
        start_border(d, &d->levels.level[l]);
        return sl_tutte(patch, SL_TUTTE_UNIFORM, d->context, uv);
    }
    for (int32_t v = 0; v < patch->nv; v++) {
        memcpy(&uv[2 * (int64_t)v], &d->uv[2 * (int64_t)vertex[v]], 2 * sizeof *uv);
    }
    return sl_stretch_settle_all(patch, d->def->w, SINGULAR, uv);
}

/* Minimises on level l. SL_BAD_INPUT when doubles have no embedding without flips. */
static sl_status solve_level(descent *d, int32_t l)
{
    sl_status status = SL_OK;
    sl_patch *patch = NULL;
    int32_t *vertex = NULL;
    double *uv = NULL;
    sl_stretch_info info;
    sl_stretch_def def = *d->def;
    def.relative_decrease = COARSE_DECREASE;
    def.target_l2 = 0.0;
    def.pin_count = 0;
    def.workspace = NULL; /* that is for the whole patch, which comes last and perhaps again */
    SL_TRY(sl_level_patch(d->patch, &d->levels.level[l], &patch, &vertex));
    uv = sl_alloc(patch->nv, 2 * sizeof *uv);
    if (uv == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    SL_TRY(start_level(d, l, patch, vertex, uv));
    SL_TRY(sl_stretch_minimise(patch, &def, d->context, uv, &info));
    for (int32_t v = 0; v < patch->nv; v++) {
        memcpy(&d->uv[2 * (int64_t)vertex[v]], &uv[2 * (int64_t)v], 2 * sizeof *uv);
    }
    d->hopeless = d->hopeless || is_hopeless(d->def, patch, &info);
cleanup:
    sl_free(uv);
    sl_free(vertex);
    sl_patch_free(patch);
    return status;
}

/* Down to the coarsest level and back up; then d->uv is a map of the whole. */
static sl_status climb(descent *d)
{
    sl_status status = d->levels.count > 0 ? SL_OK : SL_BAD_INPUT;
    for (int32_t l = d->levels.count - 1; l >= 0 && status == SL_OK; l--) {
        status = d->hopeless ? SL_OK : solve_level(d, l);
        if (status == SL_OK && !refine_level(d, l)) {
            status = SL_BAD_INPUT;
        }
    }
    return status == SL_OK ? sl_stretch_settle_all(d->patch, d->def->w, SINGULAR, d->uv) : status;
}

/* Minimises the map of the whole, unless that is in vain. */
static sl_status finish(const descent *d, sl_stretch_info *info)
{
    sl_stretch_def def = *d->def;
    def.max_iterations = d->hopeless ? 0 : def.max_iterations;
    const sl_status status = sl_stretch_minimise(d->patch, &def, d->context, d->uv, info);
    info->hopeless = info->hopeless || (d->hopeless && !info->converged);
    info->levels = d->levels.count;
    return status;
}

static bool is_no_map(sl_status status)
{
    return status == SL_BAD_INPUT || status == SL_SINGULAR || status == SL_INFEASIBLE;
}

/* Minimises from the caller's guess; *solved = false where that is no start. */
static sl_status try_guess(descent *d, sl_stretch_info *info, bool *solved)
{
    memcpy(d->uv, d->def->guess, 2 * (size_t)d->patch->nv * sizeof *d->uv);
    sl_status status = sl_stretch_mend(d->patch, d->def->simple_border, d->uv, solved);
    if (status != SL_OK || !*solved) {
        return is_no_map(status) ? SL_OK : status;
    }
    status = sl_stretch_settle_all(d->patch, d->def->w, SINGULAR, d->uv);
    status = status == SL_OK ? finish(d, info) : status;
    *solved = status == SL_OK && info->energy_after <= FAR_ENERGY;
    return is_no_map(status) ? SL_OK : status;
}

/* The whole from its own Tutte embedding, into uv. */
static sl_status start_over(descent *d, double *uv, sl_stretch_info *info)
{
    double *const levels_uv = d->uv;
    sl_status status = sl_tutte(d->patch, SL_TUTTE_UNIFORM, d->context, uv);
    d->hopeless = false;
    d->uv = uv;
    status = status == SL_OK ? finish(d, info) : status;
    d->uv = levels_uv;
    info->levels = 0;
    return status;
}

/* Through the levels, and where these give no map, or one whose border is caught in itself far from any minimum,
 * without them; *best = the better map. */
static sl_status unfold(descent *d, double *other, const double **best, sl_stretch_info *info)
{
    sl_stretch_info again = {0};
    sl_status status = climb(d);
    status = status == SL_OK ? finish(d, info) : status;
    *best = d->uv;
    if (status != SL_OK && is_no_map(status)) {
        *best = other;
        return start_over(d, other, info);
    }
    if (status != SL_OK || d->hopeless || info->energy_after <= FAR_ENERGY) {
        return status;
    }
    status = start_over(d, other, &again);
    if (status == SL_OK && again.energy_after < info->energy_after) {
        *best = other;
        *info = again;
    }
    return is_no_map(status) ? SL_OK : status;
}

/* Even small charts need a coarse level where they have limbs: of 100 with seven limbs each, 9 end far from their
 * minimum when they start from Tutte's embedding. */
static int32_t least_of(int32_t nt)
{
    const int32_t half = nt / 2 > LEAST_OF_SMALL ? nt / 2 : LEAST_OF_SMALL;
    return half < LEAST ? half : LEAST;
}

sl_status sl_stretch_unfold(const sl_patch *patch, const sl_stretch_def *def, const sl_context *context, double *uv,
                            sl_stretch_info *info)
{
    sl_status status = SL_OK;
    sl_stretch_info result = {0};
    sl_stretch_def free_def = *def;
    descent d = {.patch = patch, .def = &free_def, .context = context};
    free_def.fixed = NULL;
    free_def.line_count = 0;
    const double *best;
    double *other = NULL;
    bool guessed = false;
    if (!sl_patch_is_disk(patch)) {
        return SL_INFEASIBLE;
    }
    d.uv = sl_alloc(patch->nv, 2 * sizeof *d.uv);
    d.next = sl_alloc(patch->nv, sizeof *d.next);
    other = sl_alloc(patch->nv, 2 * sizeof *other);
    if (d.uv == NULL || d.next == NULL || other == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    best = d.uv;
    if (def->guess != NULL) {
        SL_TRY(try_guess(&d, &result, &guessed));
    }
    if (!guessed) {
        SL_TRY(sl_levels_create(patch, LEVEL_SHARE, least_of(patch->nt), &d.levels));
        SL_TRY(unfold(&d, other, &best, &result));
    }
    memcpy(uv, best, 2 * (size_t)patch->nv * sizeof *uv);
    if (info != NULL) {
        *info = result;
    }
cleanup:
    sl_levels_clear(&d.levels);
    sl_free(d.uv);
    sl_free(d.next);
    sl_free(other);
    return status;
}
