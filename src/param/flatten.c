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

/* On a coarse mesh of the chart: above this a conformal map of the chart itself is not even tried where it would be
 * given up. */
static const double FORESEEN_L2 = 10.0;

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
    sl_abf_def abf;            /* with the sectors of the constraints */
    bool constrained;          /* c->map keeps the constraints */
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
    judged.constrained = c->constrained;
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

static bool is_constrained(const sl_flatten_def *def)
{
    return def->wishes.constraint_count > 0;
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
    sl_status status = sl_abf_flatten(c->patch, &c->abf, c->context, c->map, &c->result->abf);
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
    c->constrained = !is_constrained(c->def);
    status = sl_lscm(c->patch, c->context, c->map);
    if (status == SL_OK) {
        SL_TRY(consider(c, SL_FLATTEN_LSCM, false, true, trial));
    } else if (is_no_answer(status)) {
        status = SL_OK;
    }
cleanup:
    return status;
}

/* From c->map, with the constraints that it keeps. */
static sl_status minimise_map(chain *c, const sl_stretch_def *def, sl_stretch_info *info)
{
    const sl_flatten_wishes wishes = {.constraint_count = c->def->wishes.constraint_count,
                                      .constraint = c->def->wishes.constraint};
    return c->constrained && is_constrained(c->def) ? sl_flatten_relax(c->patch, def, &wishes, c->context, c->map, info)
                                                    : sl_stretch_minimise(c->patch, def, c->context, c->map, info);
}

/* Minimises by def, from c->map or without a start, and judges what comes out. *found = there is a map. */
static sl_status minimise(chain *c, const sl_stretch_def *def, bool from_map, sl_flatten_method method,
                          sl_flatten_result *trial, bool *found)
{
    const int32_t before = c->result->stretch.iterations;
    sl_stretch_info info = {0};
    const sl_status status =
        from_map ? minimise_map(c, def, &info) : sl_stretch_unfold(c->patch, def, c->context, c->map, &info);
    *found = status == SL_OK;
    c->constrained = !is_constrained(c->def) || (from_map && c->constrained);
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
    def.most_l2 = isfinite(c->max_stretch) ? c->max_stretch : 0.0;
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
    c->constrained = !is_constrained(c->def);
    const sl_status status = sl_tutte(c->patch, SL_TUTTE_UNIFORM, c->context, c->map);
    if (status != SL_OK) {
        return is_no_answer(status) ? SL_OK : status;
    }
    return consider(c, SL_FLATTEN_TUTTE, false, true, NULL);
}

/* Would a conformal map be made only to be given up? */
static sl_status foresee(chain *c, bool *hopeless)
{
    const sl_flatten_def *def = c->def;
    *hopeless = false;
    if (!def->tutte || !def->minimise_stretch || !isfinite(c->max_stretch) || is_constrained(def) ||
        c->abf.sectors != NULL || c->max_stretch > NEAR_L2) {
        return SL_OK;
    }
    const sl_status status = sl_flatten_foresee(c->patch, &c->abf, c->context, &c->result->foreseen_l2);
    *hopeless = c->result->foreseen_l2 > FORESEEN_L2;
    return status;
}

/* The chain for a disk that is not flat. */
static sl_status flatten_disk(chain *c)
{
    sl_status status = SL_OK;
    bool hopeless, found = false;
    sl_flatten_result trial = {.verdict = SL_CHART_NOT_CONVERGED};
    SL_TRY(foresee(c, &hopeless));
    if (!hopeless) {
        SL_TRY(try_conformal(c, &trial));
    }
    if (trial.verdict == SL_CHART_VALID && c->def->polish) {
        SL_TRY(polish(c, trial.method));
    }
    if (trial.verdict == SL_CHART_VALID || (!c->def->tutte && !c->def->minimise_stretch)) {
        goto cleanup;
    }
    const sl_flatten_method conformal = trial.method;
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

static double pin_distance(const sl_flatten_wishes *wishes, const double *uv)
{
    double most = 0.0;
    for (int32_t i = 0; i < wishes->pin_count; i++) {
        const double *p = &uv[2 * (int64_t)wishes->pin[i].vertex];
        most = fmax(most, hypot(p[0] - wishes->pin[i].uv[0], p[1] - wishes->pin[i].uv[1]));
    }
    return most;
}

/* Brings the best map to its pins: two by a similarity, more by the minimiser, to its end. What comes out stays, and is
 * judged. */
static sl_status bring_to_pins(chain *c)
{
    sl_flatten_wishes wishes = c->def->wishes;
    sl_stretch_def def = c->def->stretch;
    sl_stretch_info info = {0};
    sl_status status;
    memcpy(c->map, c->best, 2 * (size_t)c->patch->nv * sizeof *c->map);
    def.simple_border = c->result->verdict == SL_CHART_VALID;
    wishes.constraint_count = c->result->constrained ? wishes.constraint_count : 0;
    status = wishes.pin_count <= 2 ? sl_pins_apply(c->patch, wishes.pin_count, wishes.pin, c->map, NULL)
                                   : sl_flatten_relax(c->patch, &def, &wishes, c->context, c->map, &info);
    if (status == SL_OK) {
        c->result->stretch_minimised = c->result->stretch_minimised || wishes.pin_count > 2;
        SL_TRY(judge(c, true, c->result));
        memcpy(c->best, c->map, 2 * (size_t)c->patch->nv * sizeof *c->map);
    } else if (is_no_answer(status)) {
        status = SL_OK;
    }
    c->result->pin_distance = pin_distance(&wishes, c->best);
cleanup:
    return status;
}

static sl_status flatten_chart(chain *c, bool one_facet)
{
    sl_status status = SL_OK;
    bool done = false;
    c->constrained = !is_constrained(c->def);
    c->result->constrained = c->constrained;
    if (c->constrained) { /* a projection asks nobody */
        SL_TRY(try_plane(c, one_facet, &done));
    }
    c->constrained = true; /* as long as it is ABF++'s map */
    if (!done) {
        SL_TRY(flatten_disk(c));
    }
    if (c->def->wishes.pin_count > 0 && c->result->method != SL_FLATTEN_NONE) {
        SL_TRY(bring_to_pins(c));
    }
cleanup:
    return status;
}

static bool pins_are_valid(const sl_patch *patch, const sl_flatten_wishes *wishes)
{
    for (int32_t i = 0; i < wishes->pin_count; i++) {
        const sl_pin *pin = &wishes->pin[i];
        if (pin->vertex < 0 || pin->vertex >= patch->nv || !isfinite(pin->uv[0]) || !isfinite(pin->uv[1])) {
            return false;
        }
    }
    return true;
}

sl_status sl_flatten(const sl_patch *patch, const sl_flatten_def *def, const sl_context *context, double *uv,
                     sl_flatten_result *result)
{
    sl_status status = SL_OK;
    sl_sector_table table = {0};
    const bool one_facet = sl_flatten_is_one_facet(patch);
    memset(uv, 0, 2 * (size_t)patch->nv * sizeof *uv);
    *result = (sl_flatten_result){.verdict = SL_CHART_NOT_A_DISK, .certificate.first_edge = {-1, -1}};
    if (!pins_are_valid(patch, &def->wishes)) {
        return SL_BAD_INPUT;
    }
    if (!sl_patch_is_disk(patch)) {
        return SL_OK;
    }
    chain c = {.patch = patch,
               .def = def,
               .context = context,
               .max_stretch = one_facet ? INFINITY : def->max_stretch,
               .max_angle = one_facet ? INFINITY : def->max_angle,
               .best = uv,
               .result = result,
               .abf = def->abf};
    c.map = sl_calloc(2 * (int64_t)patch->nv, sizeof *c.map);
    if (c.map == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    if (is_constrained(def)) {
        SL_TRY(sl_constraints_compile(patch, def->wishes.constraint_count, def->wishes.constraint, NULL, &table, NULL));
        c.abf.sectors = &table.view;
    }
    SL_TRY(sl_patch_border_edges(patch, &c.nb, &c.border));
    SL_TRY(flatten_chart(&c, one_facet));
cleanup:
    sl_sectors_clear(&table);
    sl_free(c.map);
    sl_free(c.border);
    return status;
}
