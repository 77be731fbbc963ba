#include "support/methods.h"

enum { PAGE = 512 }; /* texels a side */

const char *const exp_method_name[EXP_METHODS] = {"spectral", "fiedler",   "pca",       "vsa2",
                                                  "vsa",      "isocharts", "embedding", "random"};
const char *const exp_method_title[EXP_METHODS] = {
    "spectral",      "Fiedler vector", "PCA",           "VSA, two proxies a cut",
    "VSA, by error", "Iso-charts",     "GPS embedding", "random"};
const char *const exp_method_short[EXP_METHODS] = {"spectral", "Fiedler",    "PCA", "VSA 2",
                                                   "VSA",      "Iso-charts", "GPS", "random"};
const char *const exp_setting_name[EXP_SETTINGS] = {"as-cut", "fast"};
const char *const exp_metric_name[EXP_METRICS] = {"charts", "seam", "l2", "angle", "area", "turning", "seconds"};
const char *const exp_metric_title[EXP_METRICS] = {
    "charts",          "seam / diagonal", "L2",     "&sigma;<sub>1</sub>/&sigma;<sub>2</sub>",
    "area distortion", "turning [&deg;]", "CPU [s]"};

static const sl_cut_method cut_method[EXP_METHODS] = {SL_METHOD_SPECTRAL,  SL_METHOD_FIEDLER, SL_METHOD_PCA,
                                                      SL_METHOD_VSA,       SL_METHOD_VSA,     SL_METHOD_ISOCHARTS,
                                                      SL_METHOD_EMBEDDING, SL_METHOD_RANDOM};

const char *exp_way_method(int way)
{
    return way == EXP_BEST ? "best" : exp_method_name[way % EXP_METHODS];
}

const char *exp_way_setting(int way)
{
    return exp_setting_name[way == EXP_BEST ? EXP_FAST : way / EXP_METHODS];
}

int exp_way_base(int way)
{
    return (way == EXP_BEST ? EXP_FAST : way / EXP_METHODS) * EXP_METHODS + EXP_SPECTRAL;
}

sl_atlas_def exp_way_def(int way)
{
    sl_atlas_def def = sl_atlas_default();
    const int method = way == EXP_BEST ? EXP_SPECTRAL : way % EXP_METHODS;
    if (way / EXP_METHODS == EXP_AS_CUT) {
        def.segment = sl_segment_paper();
    }
    def.best = way == EXP_BEST;
    def.segment.symmetry = SL_SYMMETRY_USE_OFF;
    def.segment.method = cut_method[method];
    def.segment.vsa_regions = method == EXP_VSA_TWO ? 2 : 0;
    if (method == EXP_VSA_ERROR || method == EXP_ISOCHARTS) {
        def.segment.protect_first = false; /* first cuts in many parts are no equator */
    }
    def.pack.effort = 0; /* packing is not what is compared */
    def.pack.resolution = PAGE;
    def.pack.margin = 1.0;
    def.check_resolution = PAGE;
    return def;
}
