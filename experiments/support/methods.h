/* The ways to cut that are compared, and the numbers of an atlas, whoever made it.
 * Layer: experiments. */
#ifndef SL_EXPERIMENTS_METHODS_H
#define SL_EXPERIMENTS_METHODS_H

#include "generators.h"
#include "support/run.h"

/* Where cuts come from. The first is what the others are compared with. */
enum {
    EXP_SPECTRAL,
    EXP_FIEDLER,
    EXP_PCA,
    EXP_VSA_TWO,
    EXP_VSA_ERROR,
    EXP_ISOCHARTS,
    EXP_EMBEDDING,
    EXP_RANDOM,
    EXP_METHODS
};

/* As the paper has it (nothing after the cut), and as `--preset fast` has it (smoothed, joined, sewn). */
enum { EXP_AS_CUT, EXP_FAST, EXP_SETTINGS };

/* A way: a method at a setting, way = setting * EXP_METHODS + method; and the search (`--preset best`) from spectral
 * cuts. */
enum { EXP_BEST = EXP_SETTINGS * EXP_METHODS, EXP_WAYS };

enum {
    EXP_CHARTS,
    EXP_SEAM,
    EXP_STRETCH,
    EXP_ANGLE,
    EXP_AREA,
    EXP_JAGGED,
    EXP_NUMBERS, /* those above are the same on every run */
    EXP_SECONDS = EXP_NUMBERS,
    EXP_METRICS
};

extern const char *const exp_method_name[EXP_METHODS];  /* "vsa2" */
extern const char *const exp_method_title[EXP_METHODS]; /* "VSA, two proxies a cut" */
extern const char *const exp_method_short[EXP_METHODS]; /* "VSA 2" */
extern const char *const exp_setting_name[EXP_SETTINGS];
extern const char *const exp_metric_name[EXP_METRICS];  /* "charts" */
extern const char *const exp_metric_title[EXP_METRICS]; /* HTML */

/* A way's method ("best" for the search) and setting ("fast" for the search, which starts from its cuts). */
const char *exp_way_method(int way);
const char *exp_way_setting(int way);
/* The spectral cuts at that way's setting. */
int exp_way_base(int way);

/* Without symmetry, all else as the way says. */
sl_atlas_def exp_way_def(int way);

/* The numbers of one atlas. Lengths over the bounding box's diagonal; stretch, angle and area after one scale for the
 * whole atlas; turning in degrees; CPU seconds of the whole unwrap. */
typedef struct exp_numbers {
    double metric[EXP_METRICS];
    double axis;    /* share of the length of the planted mirrors' axes that is seam, the best of them; -1 = has none */
    double overlap; /* share of covered texels hit twice */
    double fill;    /* of the page */
    int32_t flipped; /* triangles */
    bool bad;        /* of ours: its own check did not pass */
    bool failed;     /* no numbers */
} exp_numbers;

/* Unwraps by a way and measures. *atlas (nullable) is the caller's. Statuses as sl_unwrap. made: with the mirrors
 * planted in it; nullable. */
SL_NODISCARD sl_status exp_unwrap_way(exp_run *run, const sl_polygons *polygons, const sl_generated *made, int way,
                                      exp_numbers *out, sl_atlas **atlas);

/* Share of the length of the planted mirrors' axes that is seam, the best of them; -1 = there is none. made: nullable.
 * by_number: input vertices of the mesh are those of `made`; else the mirrors are looked for by position. */
double exp_axis_kept(const sl_mesh *mesh, const sl_polygons *polygons, const sl_generated *made, bool by_number);

/* Measures UVs that lie on a mesh already, by another tool: seams are where the two sides' UVs differ. Vertices at one
 * place are one. The mirrors are looked for by position. SL_BAD_INPUT (a corner without UV), SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status exp_measure_uv(exp_run *run, const sl_polygons *polygons, const double *corner_uv,
                                      const sl_generated *made, exp_numbers *out);

#endif
