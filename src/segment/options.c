/* Settings of the segmentation. */
#include "segment/segment.h"

#include <math.h>

/* A chart may be within the bound on stretch and still be sheared: above this mean s1/s2 the squares of a checkerboard
 * no longer look like squares. */
static const double DEFAULT_MAX_ANGLE = 1.75;

sl_segment_def sl_segment_default(void)
{
    sl_segment_def def = {.method = SL_METHOD_SPECTRAL,
                          .vsa_error = 0.05,
                          .clusters = 2,
                          .seed = 1,
                          .rule = SL_RULE_LOOKAHEAD,
                          .vectors = 30,
                          .pairing = SL_PAIR_AUTO,
                          .filter = true,
                          .smooth = 2,
                          .join = true,
                          .sew = true,
                          .sew_stretch = 1.25,
                          .protect_first = true,
                          .max_charts = 100000,
                          .flatten = sl_flatten_default()};
    def.flatten.max_angle = DEFAULT_MAX_ANGLE;
    return def;
}

sl_segment_def sl_segment_paper(void)
{
    sl_segment_def def = sl_segment_default();
    def.rule = SL_RULE_LONGEST;
    def.pairing = SL_PAIR_OFF;
    def.smooth = 0;
    def.join = false;
    def.sew = false;
    def.flatten.abf.energy = SL_ABF_UNWEIGHTED;
    def.flatten.minimise_stretch = false;
    def.flatten.tutte = false;
    def.flatten.max_angle = INFINITY;
    def.test_halves = true;
    return def;
}
