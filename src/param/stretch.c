#include "param/stretch_solver_internal.h"

#include "base/memory.h"
#include "geom/predicates.h"
#include "overlap/certificate.h"

#include <math.h>
#include <string.h>

static const double LARGE_SCALE = 0x1p40; /* what is left of the energy at this scale is its quadratic part */
static const double PIN_GROWTH = 1.01;    /* of the energy, when pins go the last bit of their way */

enum { VERTEX_ARRAYS = 6 };

sl_stretch_def sl_stretch_default(void)
{
    return (sl_stretch_def){.w = 0.0, .max_iterations = 60, .relative_decrease = 1e-4, .hopeless_after = 15};
}

sl_stretch_sums sl_stretch_measure_map(const sl_stretch *s, const double *uv)
{
    const sl_stretch_rest *rest = &s->store->rest;
    sl_stretch_sums sums = sl_stretch_measure(rest, s->patch->tri, s->def.w, uv);
    sums.energy += sl_stretch_pull_energy(&s->def, rest->total, uv);
    return sums;
}

bool sl_stretch_all_positive(const sl_patch *patch, const double *uv)
{
    for (int32_t t = 0; t < patch->nt; t++) {
        const int32_t *v = &patch->tri[3 * t];
        if (sl_orient2d(&uv[2 * (int64_t)v[0]], &uv[2 * (int64_t)v[1]], &uv[2 * (int64_t)v[2]]) <= 0) {
            return false;
        }
    }
    return true;
}

bool sl_stretch_all_finite(int64_t count, const double *x)
{
    for (int64_t i = 0; i < count; i++) {
        if (!isfinite(x[i])) {
            return false;
        }
    }
    return true;
}

sl_status sl_stretch_border_is_simple(const sl_stretch *s, const double *uv, bool *simple)
{
    sl_certificate certificate = {0};
    *simple = true;
    if (s->border == NULL) {
        return SL_OK;
    }
    const sl_status status = sl_certify_embedding(uv, 0, s->patch->tri, s->nb, s->border, &certificate);
    *simple = certificate.border_crossings == 0;
    return status;
}

/* The power of two nearest to the scale of least energy: multiplying by it is exact, so no triangle can flip. The
 * energy of c uv is c^2 quadratic + c^-2 inverse. */
static double best_scale(const sl_stretch *s, double energy)
{
    for (int64_t i = 0; i < 2 * (int64_t)s->patch->nv; i++) {
        s->trial[i] = LARGE_SCALE * s->uv[i];
    }
    const double large = sl_stretch_measure(&s->store->rest, s->patch->tri, s->def.w, s->trial).energy;
    const double quadratic = large / (LARGE_SCALE * LARGE_SCALE), inverse = energy - quadratic;
    if (!(inverse > 0.0) || !(quadratic > 0.0) || !isfinite(inverse / quadratic)) {
        return 1.0;
    }
    return exp2(round(0.25 * log2(inverse / quadratic)));
}

/* The energy without the springs. */
static double stretch_of(const sl_stretch *s, const double *uv, sl_stretch_sums sums)
{
    return sums.energy - sl_stretch_pull_energy(&s->def, s->store->rest.total, uv);
}

void sl_stretch_take_stock(sl_stretch *s, sl_stretch_sums sums)
{
    s->info.energy_after = stretch_of(s, s->uv, sums);
    s->info.l2 = sums.l2;
    s->info.pin_distance = sl_stretch_pull_distance(&s->def, s->uv);
}

static sl_status start(sl_stretch *s, const double *uv)
{
    const int64_t count = 2 * (int64_t)s->patch->nv;
    if (!sl_stretch_all_finite(count, uv) || !sl_stretch_all_positive(s->patch, uv)) {
        return SL_BAD_INPUT;
    }
    memcpy(s->uv, uv, (size_t)count * sizeof *uv);
    sl_stretch_sums sums = sl_stretch_measure_map(s, s->uv);
    if (!isfinite(sums.energy)) {
        return SL_BAD_INPUT;
    }
    bool simple;
    const sl_status status = sl_stretch_border_is_simple(s, s->uv, &simple);
    if (status != SL_OK || !simple) {
        return status != SL_OK ? status : SL_BAD_INPUT;
    }
    s->info.energy_before = stretch_of(s, s->uv, sums);
    s->done = s->def.target_l2 > 0.0 && sums.l2 <= s->def.target_l2 && s->def.pin_count == 0;
    s->info.converged = s->done;
    const bool scales = !s->done && !sl_stretch_holds_places(s->patch, &s->def);
    const double scale = scales ? best_scale(s, sums.energy) : 1.0;
    if (scale != 1.0) {
        for (int64_t i = 0; i < count; i++) {
            s->uv[i] *= scale;
        }
        sums = sl_stretch_measure_map(s, s->uv);
    }
    s->energy = sums.energy;
    sl_stretch_take_stock(s, sums);
    s->softened = s->info.energy_after > SL_STRETCH_FAR_ENERGY;
    s->soft_gain = 1.0;
    return SL_OK;
}

/* The arrays of vertices, in the store's block. */
static sl_status lay_out(sl_stretch *s)
{
    const int64_t count = 2 * (int64_t)s->patch->nv;
    sl_stretch_store *store = s->store;
    if (VERTEX_ARRAYS * count > store->capacity) {
        sl_free(store->block);
        store->capacity = 0;
        store->block = sl_alloc(count, VERTEX_ARRAYS * sizeof *store->block);
        if (store->block == NULL) {
            return SL_OUT_OF_MEMORY;
        }
        store->capacity = VERTEX_ARRAYS * count;
    }
    double **const array[VERTEX_ARRAYS] = {&s->uv, &s->trial, &s->spare, &s->gradient, &s->force, &s->direction};
    for (int k = 0; k < VERTEX_ARRAYS; k++) {
        *array[k] = store->block + k * count;
    }
    return SL_OK;
}

sl_status sl_stretch_create(const sl_patch *patch, const double *uv, const sl_stretch_def *def, sl_stretch **out)
{
    sl_status status = SL_OK;
    *out = NULL;
    sl_stretch *s = sl_calloc(1, sizeof *s);
    if (s == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    s->patch = patch;
    s->def = *def;
    s->store = sl_stretch_store_borrow(def->workspace, &s->own);
    SL_TRY(sl_stretch_pull_is_valid(def, patch->nv) ? SL_OK : SL_BAD_INPUT);
    SL_TRY(lay_out(s));
    if (def->simple_border) {
        SL_TRY(sl_patch_border_edges(patch, &s->nb, &s->border));
    }
    SL_TRY(sl_stretch_rest_init(patch, &s->store->rest));
    SL_TRY(start(s, uv));
    SL_TRY(sl_stretch_freedom_init(patch, def, uv, &s->freedom));
    *out = s;
    s = NULL;
cleanup:
    sl_stretch_free(s);
    return status;
}

/* Pins that the springs have brought next to their places go there, if nothing flips. */
static sl_status set_pins(sl_stretch *s)
{
    bool simple = false;
    memcpy(s->trial, s->uv, 2 * (size_t)s->patch->nv * sizeof *s->trial);
    for (int32_t i = 0; i < s->def.pin_count; i++) {
        memcpy(&s->trial[2 * (int64_t)s->def.pin[i].vertex], s->def.pin[i].uv, 2 * sizeof *s->trial);
    }
    const sl_stretch_sums sums = sl_stretch_measure_map(s, s->trial);
    if (!isfinite(sums.energy) || sums.energy > PIN_GROWTH * s->energy ||
        !sl_stretch_all_positive(s->patch, s->trial)) {
        return SL_OK;
    }
    const sl_status status = sl_stretch_border_is_simple(s, s->trial, &simple);
    if (status == SL_OK && simple) {
        sl_stretch_swap(&s->uv, &s->trial);
        s->energy = sums.energy;
        sl_stretch_take_stock(s, sums);
    }
    return status;
}

sl_status sl_stretch_step(sl_stretch *s, int32_t n, const sl_context *context)
{
    for (int32_t i = 0; i < n && !s->done && s->info.iterations < s->def.max_iterations; i++) {
        sl_status status =
            sl_report_progress(context, "minimising stretch", (double)s->info.iterations / s->def.max_iterations);
        if (status == SL_OK && !s->ready) {
            status = sl_stretch_store_system(s->store, s->patch, &s->freedom);
            s->ready = status == SL_OK;
        }
        if (status == SL_OK) {
            status = sl_stretch_iterate(s);
        }
        if (status == SL_OK && s->def.pin_count > 0 && (s->done || s->info.iterations == s->def.max_iterations)) {
            status = set_pins(s);
        }
        if (status != SL_OK) {
            return status;
        }
    }
    return SL_OK;
}

const sl_stretch_info *sl_stretch_info_of(const sl_stretch *s)
{
    return &s->info;
}

const double *sl_stretch_uv(const sl_stretch *s)
{
    return s->uv;
}

void sl_stretch_free(sl_stretch *s)
{
    if (s == NULL) {
        return;
    }
    sl_stretch_freedom_clear(&s->freedom);
    sl_stretch_store_return(s->def.workspace, s->store);
    sl_free(s->border);
    sl_free(s);
}

sl_status sl_stretch_minimise(const sl_patch *patch, const sl_stretch_def *def, const sl_context *context, double *uv,
                              sl_stretch_info *info)
{
    sl_status status = SL_OK;
    sl_stretch *s = NULL;
    SL_TRY(sl_stretch_create(patch, uv, def, &s));
    SL_TRY(sl_stretch_step(s, def->max_iterations, context));
    memcpy(uv, s->uv, 2 * (size_t)patch->nv * sizeof *uv);
    if (info != NULL) {
        *info = s->info;
    }
cleanup:
    sl_stretch_free(s);
    return status;
}
