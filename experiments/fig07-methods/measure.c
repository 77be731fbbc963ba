#include "methods.h"

#include <math.h>
#include <stdlib.h>

#define AXIS_KEPT 0.9 /* of its length */

static const double equal_log2 = 0.0143553; /* one hundredth */

const char *const method_name[METHODS] = {"spectral", "fiedler",   "pca",       "vsa2",
                                          "vsa",      "isocharts", "embedding", "random"};
const char *const method_title[METHODS] = {"spectral",      "Fiedler vector", "PCA",           "VSA, two proxies a cut",
                                           "VSA, by error", "Iso-charts",     "GPS embedding", "random"};
const char *const method_short[METHODS] = {"spectral", "Fiedler", "PCA", "VSA 2", "VSA", "Iso-charts", "GPS", "random"};
const char *const setting_name[SETTINGS] = {"as-cut", "default"};
const char *const metric_name[METRICS] = {"charts", "seam", "l2", "angle", "area", "turning", "seconds"};
const char *const metric_title[METRICS] = {
    "charts",          "seam / diagonal", "L2",     "&sigma;<sub>1</sub>/&sigma;<sub>2</sub>",
    "area distortion", "turning [&deg;]", "CPU [s]"};

static const sl_cut_method cut_method[METHODS] = {SL_METHOD_SPECTRAL,  SL_METHOD_FIEDLER, SL_METHOD_PCA,
                                                  SL_METHOD_VSA,       SL_METHOD_VSA,     SL_METHOD_ISOCHARTS,
                                                  SL_METHOD_EMBEDDING, SL_METHOD_RANDOM};

sl_segment_def method_def(int setting, int method)
{
    sl_segment_def def = setting == AS_CUT ? sl_segment_paper() : sl_segment_default();
    def.symmetry = SL_SYMMETRY_USE_OFF;
    def.method = cut_method[method];
    def.vsa_regions = method == VSA_TWO ? 2 : 0;
    def.protect_first = def.protect_first && method != VSA_ERROR && method != ISOCHARTS; /* first cuts in many parts */
    return def;
}

/* Both ends of an axis's edges stay where they are under the mirror. */
static double share_of_axis(const sl_mesh *mesh, const sl_planted *mirror)
{
    double seam = 0.0, all = 0.0;
    for (int32_t h = 0; h < mesh->nh; h++) {
        const int32_t a = mesh->input_vertex[mesh->origin[h]], b = mesh->input_vertex[sl_target(mesh, h)];
        if (mirror->vertex[a] == a && mirror->vertex[b] == b) {
            const double length = sl_mesh_edge_length(mesh, h);
            seam += mesh->sew[h] >= 0 ? length : 0.0;
            all += length;
        }
    }
    return all > 0.0 ? seam / all : -1.0;
}

static double best_axis(const sl_mesh *mesh, const sl_generated *made)
{
    double best = -1.0;
    for (int32_t k = 0; made != NULL && k < made->nplanted; k++) {
        best = made->planted[k].mirror ? fmax(best, share_of_axis(mesh, &made->planted[k])) : best;
    }
    return best;
}

outcome measure(const sl_mesh *mesh, const sl_segmentation *seg, const sl_generated *made, double seconds)
{
    outcome o = {.splits = seg->nsplit, .axis = best_axis(mesh, made)};
    double area = 0.0, square = 0.0, angle = 0.0, spread = 0.0;
    for (int32_t c = 0; c < seg->nchart; c++) {
        const sl_flatten_result *flat = &seg->chart[c].flat;
        o.invalid += flat->verdict != SL_CHART_VALID;
        if (flat->distortion.measured > 0 && isfinite(flat->distortion.l2)) {
            area += flat->distortion.area_3d;
            square += flat->distortion.area_3d * flat->distortion.l2 * flat->distortion.l2;
            angle += flat->distortion.area_3d * flat->distortion.angle_mean;
            spread += flat->distortion.area_3d * flat->distortion.area_mean;
        }
    }
    o.metric[CHARTS] = seg->nchart;
    o.metric[SEAM] = sl_atlas_seam_length(mesh) / sl_mesh_diagonal(mesh);
    o.metric[STRETCH] = area > 0.0 ? sqrt(square / area) : 0.0;
    o.metric[ANGLE] = area > 0.0 ? angle / area : 0.0;
    o.metric[AREA] = area > 0.0 ? spread / area : 0.0;
    o.metric[JAGGED] = exp_seam_turning(mesh);
    o.metric[SECONDS] = seconds;
    return o;
}

/* What is too small to matter counts as no difference: a millisecond, a degree. */
double log_ratio(const model *m, int setting, int method, int metric)
{
    if (m->outcome[setting][SPECTRAL].failed || m->outcome[setting][method].failed) {
        return NAN;
    }
    const double base = m->outcome[setting][SPECTRAL].metric[metric],
                 value = m->outcome[setting][method].metric[metric];
    const double floor = metric == SECONDS ? 1e-3 : metric == JAGGED ? 1.0 : 1e-6;
    return log2(fmax(value, floor) / fmax(base, floor));
}

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

sl_status compare(const model *models, int32_t count, int setting, int method, int metric, comparison *out)
{
    double *ratio = sl_alloc(count, sizeof *ratio);
    int32_t n = 0;
    *out = (comparison){0};
    if (ratio == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t k = 0; k < count; k++) {
        const double r = log_ratio(&models[k], setting, method, metric);
        if (!isnan(r)) {
            ratio[n++] = r;
        }
        out->better += r < -equal_log2;
        out->worse += r > equal_log2;
        out->equal += fabs(r) <= equal_log2;
    }
    qsort(ratio, (size_t)n, sizeof *ratio, compare_doubles);
    out->median = n > 0 ? 0.5 * (ratio[(n - 1) / 2] + ratio[n / 2]) : 0.0;
    sl_free(ratio);
    return SL_OK;
}

void count_axes(const model *models, int32_t count, int setting, int method, int32_t *kept, int32_t *all)
{
    *kept = *all = 0;
    for (int32_t k = 0; k < count; k++) {
        const outcome *o = &models[k].outcome[setting][method];
        *all += !o->failed && o->axis >= 0.0;
        *kept += !o->failed && o->axis >= AXIS_KEPT;
    }
}
