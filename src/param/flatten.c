#include "param/flatten.h"

#include "base/memory.h"
#include "param/flatten_internal.h"
#include "param/lscm.h"
#include "param/stretch_internal.h"
#include "param/tutte.h"

#include <math.h>
#include <string.h>

/* The minimiser aims at this share of the stretch allowed over 1, so that rounding and scaling leave the chart within
 * it. */
static const double TARGET_SHARE = 0.96;

/* A conformal map of more stretch than this is given up for one found on coarse meshes, which takes fewer steps. */
static const double NEAR_L2 = 3.0;

/* Energy weights that trade stretch for angles, tried in turn where a chart is within the bound on the one and beyond
 * that on the others; two or three steps each. */
static const double ANGLE_WEIGHTS[] = {-1.0, -2.0, -4.0};

/* When the minimiser gives up (unless the caller says): what is still beyond FAR_L2 after hopeless_after steps, or what
 * gains too little. Over 89 charts of seven meshes it halved the steps spent on charts that stay invalid, and lost one
 * of 53 that full minimisation makes valid (at 1.495 of 1.5). */
static const double FAR_L2 = 10.0, HOPELESS_GAIN = 8.0;

/* One run of the chain: the patch, what it borrows, and the best map so far. */
typedef struct chain {
    const sl_patch *patch;
    const sl_flatten_def *def;
    const sl_context *context;
    double max_stretch, max_angle;
    int32_t nb;
    int32_t *border;           /* nb vertex pairs */
    double *map;               /* nv x 2: the map under trial */
    double *best;              /* nv x 2: borrowed from the caller */
    sl_flatten_result *result; /* of best */
} chain;

sl_flatten_def sl_flatten_default(void)
{
    return (sl_flatten_def){.abf = sl_abf_default(),
                            .minimise_stretch = true,
                            .tutte = true,
                            .max_stretch = 1.5,
                            .max_angle = INFINITY,
                            .stretch = sl_stretch_default()};
}

const char *sl_flatten_method_name(sl_flatten_method method)
{
    static const char *const name[] = {"none", "abf++", "lscm", "tutte", "planar", "optimised"};
    return method >= 0 && (size_t)method < SL_COUNTOF(name) ? name[method] : "unknown";
}

const char *sl_flatten_verdict_name(sl_flatten_verdict verdict)
{
    static const char *const name[] = {"valid",    "not a disk", "not converged", "flipped",
                                       "overlaps", "stretched",  "sheared"};
    return verdict >= 0 && (size_t)verdict < SL_COUNTOF(name) ? name[verdict] : "unknown";
}

/* How much a verdict still says for its map. */
static int rank(sl_flatten_verdict verdict)
{
    switch (verdict) {
    case SL_CHART_VALID:
        return 6;
    case SL_CHART_SHEARED:
        return 5;
    case SL_CHART_STRETCHED:
        return 4;
    case SL_CHART_OVERLAPS:
        return 3;
    case SL_CHART_FLIPPED:
        return 2;
    case SL_CHART_NOT_CONVERGED:
        return 1;
    case SL_CHART_NOT_A_DISK:
        break;
    }
    return 0;
}

/* An embedding that is only too distorted can be refined. */
static bool is_distorted(sl_flatten_verdict verdict)
{
    return verdict == SL_CHART_STRETCHED || verdict == SL_CHART_SHEARED;
}

/* Judges c->map, opened where that makes it an embedding; `converged` is the method's own word. */
static sl_status judge(const chain *c, bool converged, sl_flatten_result *out)
{
    const sl_patch *p = c->patch;
    sl_status status = SL_OK;
    if (!sl_stretch_all_finite(2 * (int64_t)p->nv, c->map)) {
        out->verdict = SL_CHART_NOT_CONVERGED;
        return SL_OK;
    }
    SL_TRY(sl_flatten_certify(p, c->nb, c->border, c->map, &out->certificate));
    SL_TRY(sl_distortion_measure_indexed(p->nt, p->tri, p->xyz, c->map, &out->distortion));
    if (!converged) {
        out->verdict = SL_CHART_NOT_CONVERGED;
    } else if (out->certificate.flipped > 0 || out->certificate.degenerate > 0) {
        out->verdict = SL_CHART_FLIPPED;
    } else if (!out->certificate.embedded) {
        out->verdict = SL_CHART_OVERLAPS;
    } else if (!(out->distortion.l2 <= c->max_stretch)) {
        out->verdict = SL_CHART_STRETCHED;
    } else {
        out->verdict = out->distortion.angle_mean <= c->max_angle ? SL_CHART_VALID : SL_CHART_SHEARED;
    }
cleanup:
    return status;
}

/* Judges c->map and keeps it if it is better than the best so far. trial may be NULL. */
static sl_status consider(chain *c, sl_flatten_method method, bool minimised, bool converged, sl_flatten_result *trial)
{
    sl_flatten_result judged = *c->result;
    judged.method = method;
    judged.stretch_minimised = minimised;
    const sl_status status = judge(c, converged, &judged);
    if (status != SL_OK) {
        return status;
    }
    const int before = rank(c->result->verdict), now = rank(judged.verdict);
    if (c->result->method == SL_FLATTEN_NONE || now > before ||
        (now == before && judged.distortion.l2 < c->result->distortion.l2)) {
        if (sl_stretch_all_finite(2 * (int64_t)c->patch->nv, c->map)) {
            memcpy(c->best, c->map, 2 * (size_t)c->patch->nv * sizeof *c->best);
            *c->result = judged;
        }
    }
    if (trial != NULL) {
        *trial = judged;
    }
    return SL_OK;
}

/* A method without an answer is no failure of the chain; running out of memory or being cancelled is. */
static bool is_no_answer(sl_status status)
{
    return status == SL_SINGULAR || status == SL_INFEASIBLE || status == SL_BAD_INPUT ||
           status == SL_NOT_POSITIVE_DEFINITE;
}

/* Facets that need no method: flat ones, and those without any area. *done = the map found is final. */
static sl_status try_plane(chain *c, bool one_facet, bool *done)
{
    *done = false;
    double area = 0.0;
    for (int32_t t = 0; t < c->patch->nt; t++) {
        area += sl_patch_triangle_area(c->patch, t);
    }
    sl_status status = SL_OK;
    if (sl_flatten_project(c->patch, c->map)) {
        sl_flatten_result trial;
        SL_TRY(consider(c, SL_FLATTEN_PLANAR, false, true, &trial));
        *done = trial.verdict == SL_CHART_VALID;
    }
    if (!*done && one_facet && (c->patch->nt == 1 || area == 0.0)) { /* a facet without area: one point, and exempt */
        memset(c->best, 0, 2 * (size_t)c->patch->nv * sizeof *c->best);
        c->result->method = SL_FLATTEN_PLANAR;
        c->result->verdict = SL_CHART_VALID;
        *done = true;
    }
    if (!*done) { /* a folded plane is no map to keep */
        memset(c->best, 0, 2 * (size_t)c->patch->nv * sizeof *c->best);
        c->result->method = SL_FLATTEN_NONE;
        c->result->verdict = SL_CHART_NOT_CONVERGED;
    }
cleanup:
    return status;
}

/* ABF++, and LSCM where that fails (unless every fallback is off). trial: the verdict on the last map made. */
static sl_status try_conformal(chain *c, sl_flatten_result *trial)
{
    sl_status status = sl_abf_flatten(c->patch, &c->def->abf, c->context, c->map, &c->result->abf);
    if (status != SL_OK && !is_no_answer(status)) {
        return status;
    }
    trial->verdict = SL_CHART_NOT_CONVERGED;
    if (status == SL_OK) {
        SL_TRY(consider(c, SL_FLATTEN_ABF, false, c->result->abf.converged, trial));
    }
    if (rank(trial->verdict) > rank(SL_CHART_FLIPPED) || (!c->def->tutte && !c->def->minimise_stretch)) {
        return SL_OK;
    }
    status = sl_lscm(c->patch, c->context, c->map);
    if (status == SL_OK) {
        SL_TRY(consider(c, SL_FLATTEN_LSCM, false, true, trial));
    } else if (is_no_answer(status)) {
        status = SL_OK;
    }
cleanup:
    return status;
}

/* Minimises by def, from c->map or without a start, and judges what comes out. *found = there is a map. */
static sl_status minimise(chain *c, const sl_stretch_def *def, bool from_map, sl_flatten_method method,
                          sl_flatten_result *trial, bool *found)
{
    const int32_t before = c->result->stretch.iterations;
    sl_stretch_info info = {0};
    const sl_status status = from_map ? sl_stretch_minimise(c->patch, def, c->context, c->map, &info)
                                      : sl_stretch_unfold(c->patch, def, c->context, c->map, &info);
    *found = status == SL_OK;
    if (status != SL_OK) {
        return is_no_answer(status) ? SL_OK : status;
    }
    info.iterations += before;
    c->result->stretch = info;
    sl_flatten_scale(c->patch, c->map);
    return consider(c, method, true, true, trial);
}

/* Refines c->map, an embedding of method `method`, or makes one itself: until its stretch is within the bound, and
 * where the angles are not yet, to the end. Its border stays simple: what comes out is an embedding. */
static sl_status refine(chain *c, bool from_map, sl_flatten_method method, bool *found)
{
    sl_stretch_def def = c->def->stretch;
    sl_flatten_result trial = {.verdict = SL_CHART_NOT_CONVERGED};
    def.simple_border = true;
    if (isfinite(c->max_stretch)) {
        def.target_l2 = 1.0 + TARGET_SHARE * (c->max_stretch - 1.0);
        def.hopeless_l2 = def.hopeless_l2 > 0.0 ? def.hopeless_l2 : FAR_L2;
        def.hopeless_gain = def.hopeless_gain > 0.0 ? def.hopeless_gain : HOPELESS_GAIN;
    }
    sl_status status = minimise(c, &def, from_map, method, &trial, found);
    def.target_l2 = 0.0;
    for (size_t k = 0; k < SL_COUNTOF(ANGLE_WEIGHTS) && status == SL_OK && trial.verdict == SL_CHART_SHEARED; k++) {
        bool again;
        def.w = fmin(c->def->stretch.w, ANGLE_WEIGHTS[k]);
        status = minimise(c, &def, true, method, &trial, &again);
    }
    return status;
}

/* Minimises c->map, which is valid, to the end; what comes out counts if it is valid and stretches less. */
static sl_status polish(chain *c, sl_flatten_method method)
{
    sl_stretch_def def = c->def->stretch;
    bool found;
    def.simple_border = true;
    def.target_l2 = 0.0;
    return minimise(c, &def, true, method, NULL, &found);
}

/* Tutte's embedding, with uniform weights: cotangents shrink long limbs by up to 1e4 more. */
static sl_status try_tutte(chain *c)
{
    const sl_status status = sl_tutte(c->patch, SL_TUTTE_UNIFORM, c->context, c->map);
    if (status != SL_OK) {
        return is_no_answer(status) ? SL_OK : status;
    }
    return consider(c, SL_FLATTEN_TUTTE, false, true, NULL);
}

/* The chain for a disk that is not flat. */
static sl_status flatten_disk(chain *c)
{
    sl_status status = SL_OK;
    sl_flatten_result trial;
    SL_TRY(try_conformal(c, &trial));
    if (trial.verdict == SL_CHART_VALID && c->def->polish) {
        SL_TRY(polish(c, trial.method));
    }
    if (trial.verdict == SL_CHART_VALID || (!c->def->tutte && !c->def->minimise_stretch)) {
        goto cleanup;
    }
    const sl_flatten_method conformal = trial.method;
    bool found = false;
    if (c->def->minimise_stretch && is_distorted(trial.verdict) && (trial.distortion.l2 <= NEAR_L2 || !c->def->tutte)) {
        SL_TRY(refine(c, true, conformal, &found));
        goto cleanup;
    }
    if (c->def->tutte && c->def->minimise_stretch) {
        SL_TRY(refine(c, false, SL_FLATTEN_TUTTE, &found));
    }
    if (c->def->tutte && !found) {
        SL_TRY(try_tutte(c));
    }
cleanup:
    return status;
}

sl_status sl_flatten(const sl_patch *patch, const sl_flatten_def *def, const sl_context *context, double *uv,
                     sl_flatten_result *result)
{
    sl_status status = SL_OK;
    const bool one_facet = sl_flatten_is_one_facet(patch);
    memset(uv, 0, 2 * (size_t)patch->nv * sizeof *uv);
    *result = (sl_flatten_result){.verdict = SL_CHART_NOT_A_DISK, .certificate.first_edge = {-1, -1}};
    if (!sl_patch_is_disk(patch)) {
        return SL_OK;
    }
    chain c = {.patch = patch,
               .def = def,
               .context = context,
               .max_stretch = one_facet ? INFINITY : def->max_stretch,
               .max_angle = one_facet ? INFINITY : def->max_angle,
               .best = uv,
               .result = result};
    bool done;
    c.map = sl_calloc(2 * (int64_t)patch->nv, sizeof *c.map);
    if (c.map == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    SL_TRY(sl_stretch_list_border(patch, &c.nb, &c.border));
    SL_TRY(try_plane(&c, one_facet, &done));
    if (!done) {
        SL_TRY(flatten_disk(&c));
    }
cleanup:
    sl_free(c.map);
    sl_free(c.border);
    return status;
}
