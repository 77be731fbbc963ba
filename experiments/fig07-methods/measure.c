#include "methods.h"

#include <math.h>
#include <stdlib.h>

static const double equal_log2 = 0.0143553; /* one hundredth */

const char *const method_name[METHODS] = {"spectral", "pca", "vsa2", "vsa"};
const char *const method_title[METHODS] = {"spectral", "PCA", "VSA, two proxies a cut", "VSA, by error"};
const char *const setting_name[SETTINGS] = {"as-cut", "default"};
const char *const metric_name[METRICS] = {"charts", "seam", "l2", "turning", "seconds"};
const char *const metric_title[METRICS] = {"charts", "seam / diagonal", "L2", "turning [&deg;]", "CPU [s]"};

sl_segment_def method_def(int setting, int method)
{
    sl_segment_def def = setting == AS_CUT ? sl_segment_paper() : sl_segment_default();
    def.symmetry = SL_SYMMETRY_USE_OFF;
    def.method = method == SPECTRAL ? SL_METHOD_SPECTRAL : method == PCA ? SL_METHOD_PCA : SL_METHOD_VSA;
    def.vsa_regions = method == VSA_TWO ? 2 : 0;
    def.protect_first = def.protect_first && method != VSA_ERROR; /* its first cut is the whole segmentation */
    return def;
}

outcome measure(const sl_mesh *mesh, const sl_segmentation *seg, double seconds)
{
    outcome o = {.splits = seg->nsplit};
    double area = 0.0, square = 0.0;
    for (int32_t c = 0; c < seg->nchart; c++) {
        const sl_flatten_result *flat = &seg->chart[c].flat;
        o.invalid += flat->verdict != SL_CHART_VALID;
        if (flat->distortion.measured > 0 && isfinite(flat->distortion.l2)) {
            area += flat->distortion.area_3d;
            square += flat->distortion.area_3d * flat->distortion.l2 * flat->distortion.l2;
        }
    }
    o.metric[CHARTS] = seg->nchart;
    o.metric[SEAM] = sl_atlas_seam_length(mesh) / sl_mesh_diagonal(mesh);
    o.metric[STRETCH] = area > 0.0 ? sqrt(square / area) : 0.0;
    o.metric[JAGGED] = exp_seam_turning(mesh);
    o.metric[SECONDS] = seconds;
    return o;
}

/* What is too small to matter counts as no difference: a millisecond, a degree. */
double log_ratio(const model *m, int setting, int method, int metric)
{
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
    *out = (comparison){0};
    if (ratio == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t k = 0; k < count; k++) {
        ratio[k] = log_ratio(&models[k], setting, method, metric);
        out->better += ratio[k] < -equal_log2;
        out->worse += ratio[k] > equal_log2;
        out->equal += fabs(ratio[k]) <= equal_log2;
    }
    qsort(ratio, (size_t)count, sizeof *ratio, compare_doubles);
    out->median = count > 0 ? 0.5 * (ratio[(count - 1) / 2] + ratio[count / 2]) : 0.0;
    sl_free(ratio);
    return SL_OK;
}
