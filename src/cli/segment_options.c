#include "cli/segment_options.h"

#include <math.h>
#include <string.h>

static void load_def(cli_segment_options *o, sl_segment_def def)
{
    o->def = def;
    o->method = (int32_t)def.method;
    o->symmetry = (int32_t)def.symmetry;
    o->rule = (int32_t)def.rule;
    o->pairing = (int32_t)def.pairing;
    o->energy = (int32_t)def.flatten.abf.energy;
}

void cli_segment_preset(cli_segment_options *o, cli_preset usual, int argc, char **argv)
{
    load_def(o, sl_segment_default());
    o->optimize = sl_optimize_default();
    o->weights = true;
    o->protect = (int32_t)o->optimize.protect;
    o->preset = (int32_t)usual;
    for (int a = 2; a < argc; a++) {
        const bool next = strcmp(argv[a], "--preset") == 0 && a + 1 < argc && strcmp(argv[a + 1], "paper") == 0;
        if (next || strcmp(argv[a], "--preset=paper") == 0) {
            load_def(o, sl_segment_paper());
            o->preset = CLI_PRESET_PAPER;
        }
    }
}

void cli_segment_table(cli_segment_options *o, cli_option *table)
{
    const cli_option entries[CLI_SEGMENT_OPTIONS] = {
        {"preset", 0, CLI_CHOICE, &o->preset, 0, 0, "best|fast|paper", NULL,
         "best = fewest charts and shortest seams by search (unwrap), fast = the recursion alone (segment), paper = as "
         "printed; other options override"},
        {"target-stretch", 0, CLI_REAL, &o->optimize.target_stretch, 1.0, 1e6, NULL, "L2",
         "best: of the whole atlas (1.05)"},
        {"target-angle", 0, CLI_REAL, &o->optimize.target_angle, 1.0, 1e6, NULL, "R",
         "best: the atlas's mean s1/s2 (1.2)"},
        {"chart-cost", 0, CLI_REAL, &o->optimize.chart_cost, 0.0, 1e6, NULL, "C",
         "best: a chart weighs as much as so long a seam, over sqrt(area) (0.3)"},
        {"empty-cost", 0, CLI_REAL, &o->optimize.empty_cost, 0.0, 1e6, NULL, "C",
         "best: what empty texture is worth, as much as the surface's area (1)"},
        {"seam-cost", 0, CLI_REAL, &o->optimize.seam_cost, 0.0, 1e6, NULL, "C",
         "best: weight of the seams' length (1)"},
        {"search-effort", 0, CLI_REAL, &o->optimize.effort, 0.0, 1e6, NULL, "E",
         "best: work on making seams again once the search has ended (1)"},
        {"protect", 0, CLI_CHOICE, &o->protect, 0, 0, "none|axis|first", NULL,
         "best: seams that are never sewn: axes, or the first spectral cuts, too (axis)"},
        {"weights", 0, CLI_ON_OFF, &o->weights, 0, 0, NULL, NULL,
         "best: seams cost less where they are less seen; off = length alone (on)"},
        {"weight-crease", 0, CLI_REAL, &o->optimize.weights.crease, 0.0, 1.0, NULL, "S",
         "best: how much less along creases, 0 to 1 (0.6)"},
        {"weight-concave", 0, CLI_REAL, &o->optimize.weights.concavity, 0.0, 1.0, NULL, "S",
         "best: ... in concave places (0.4)"},
        {"weight-hidden", 0, CLI_REAL, &o->optimize.weights.visibility, 0.0, 1.0, NULL, "S",
         "best: ... where little of the outside sees them (0.5)"},
        {"weight-loops", 0, CLI_REAL, &o->optimize.weights.loops, 0.0, 1.0, NULL, "S",
         "best: ... along edge loops of quads (0.3)"},
        {"method", 0, CLI_CHOICE, &o->method, 0, 0, "spectral|pca|vsa|fiedler|random|isocharts|embedding", NULL,
         "how a chart is cut in parts: the others are there to compare with"},
        {"clusters", 0, CLI_INT, &o->def.clusters, 2, 1000000, NULL, "N", "embedding: parts of the first cut (2)"},
        {"seed", 0, CLI_INT, &o->def.seed, 0, INT32_MAX, NULL, "N", "random numbers of random and embedding (1)"},
        {"vsa-regions", 0, CLI_INT, &o->def.vsa_regions, 0, 1000000, NULL, "N",
         "proxies of the first vsa cut, 0 = by error (0)"},
        {"vsa-error", 0, CLI_REAL, &o->def.vsa_error, 0.0, 4.0, NULL, "E",
         "mean |n - N|^2 at which proxies are enough (0.05)"},
        {"symmetry", 0, CLI_CHOICE, &o->symmetry, 0, 0, "auto|off|exact|near", NULL,
         "mirror images and copies share texture: where exact, never, or warn if there are none, or near ones too"},
        {"test-halves", 0, CLI_ON_OFF, &o->def.test_halves, 0, 0, NULL, NULL,
         "the paper's way: no search for axes, but after each cut compare its halves (off)"},
        {"unshare", 0, CLI_FLAG, &o->def.unshare, 0, 0, NULL, NULL, "lay mirror images and copies out, too"},
        {"rule", 0, CLI_CHOICE, &o->rule, 0, 0, "longest|length-lambda|lookahead", NULL, "which passing cut is taken"},
        {"vectors", 0, CLI_INT, &o->def.vectors, 2, 1000, NULL, "N", "eigenvectors a cut (30)"},
        {"pair", 0, CLI_CHOICE, &o->pairing, 0, 0, "auto|on|off", NULL, "triangles back into quads for the graph"},
        {"filter", 0, CLI_ON_OFF, &o->def.filter, 0, 0, NULL, NULL,
         "only vectors with connected halves cut; off, by length, to compare (on)"},
        {"smooth", 0, CLI_INT, &o->def.smooth, 0, 100, NULL, "K", "band of the minimum cut in rings, 0 = off (2)"},
        {"join", 0, CLI_ON_OFF, &o->def.join, 0, 0, NULL, NULL, "join border loops by shortest paths (on)"},
        {"sew", 0, CLI_ON_OFF, &o->def.sew, 0, 0, NULL, NULL, "merge charts while they stay valid (on)"},
        {"sew-stretch", 0, CLI_REAL, &o->def.sew_stretch, 1.0, 1e6, NULL, "L2", "bound on a merged chart (1.25)"},
        {"protect-first", 0, CLI_ON_OFF, &o->def.protect_first, 0, 0, NULL, NULL, "never sew the first cut (on)"},
        {"max-stretch", 0, CLI_REAL, &o->def.flatten.max_stretch, 1.0, 1e300, NULL, "L2", "bound on a chart (1.5)"},
        {"max-angle", 0, CLI_REAL, &o->def.flatten.max_angle, 1.0, 1e300, NULL, "R",
         "bound on a chart's mean s1/s2 (1.75)"},
        {"max-charts", 0, CLI_INT, &o->def.max_charts, 1, INT32_MAX, NULL, "N", "stop splitting there (100000)"},
        {"memory-limit", 0, CLI_SIZE, &o->def.memory_limit, 1, 0x1p60, NULL, "SIZE",
         "refuse (exit 6) eigenvectors that would need more, such as 2G"},
        {"energy", 0, CLI_CHOICE, &o->energy, 0, 0, "weighted|unweighted", NULL,
         "ABF++: 1/phi^2, or the paper's Eq. 1"},
        {"tutte", 0, CLI_ON_OFF, &o->def.flatten.tutte, 0, 0, NULL, NULL, "Tutte's embedding as last resort (on)"},
        {"minimise", 0, CLI_ON_OFF, &o->def.flatten.minimise_stretch, 0, 0, NULL, NULL,
         "lower the stretch before splitting a chart for it (on)"},
        {"polish", 0, CLI_ON_OFF, &o->def.flatten.polish, 0, 0, NULL, NULL,
         "lower the stretch of charts that are valid without, too (off)"},
    };
    memcpy(table, entries, sizeof entries);
}

void cli_segment_apply(cli_segment_options *o)
{
    o->def.method = (sl_cut_method)o->method;
    o->def.symmetry = (sl_symmetry_use)o->symmetry;
    o->def.rule = (sl_cut_rule)o->rule;
    o->def.pairing = (sl_pairing)o->pairing;
    o->def.flatten.abf.energy = (sl_abf_energy)o->energy;
    o->best = o->preset == CLI_PRESET_BEST;
    o->optimize.protect = (sl_protect)o->protect;
    o->optimize.weights = o->weights ? o->optimize.weights : sl_seam_cost_none();
    o->optimize.max_stretch = o->def.flatten.max_stretch;
    o->optimize.max_angle = o->def.flatten.max_angle;
}
