/* Figure 7: one mesh cut by every method there is, and what comes of it. */
#ifndef SL_EXPERIMENTS_METHODS_H
#define SL_EXPERIMENTS_METHODS_H

#include "generators.h"
#include "support/claims.h"
#include "support/pictures.h"
#include "support/turning.h"

/* Where cuts come from. The first is what the others are compared with. */
enum { SPECTRAL, FIEDLER, PCA, VSA_TWO, VSA_ERROR, ISOCHARTS, EMBEDDING, RANDOM, METHODS };

/* As the paper has it (nothing after the cut), and the default (smoothed, joined, sewn). */
enum { AS_CUT, DEFAULT, SETTINGS };

enum { CHARTS, SEAM, STRETCH, ANGLE, AREA, JAGGED, SECONDS, METRICS };

extern const char *const method_name[METHODS];   /* "vsa2" */
extern const char *const method_title[METHODS];  /* "VSA, two proxies a cut" */
extern const char *const method_short[METHODS];  /* "VSA 2" */
extern const char *const setting_name[SETTINGS]; /* "as-cut" */
extern const char *const metric_name[METRICS];   /* "charts" */
extern const char *const metric_title[METRICS];

sl_segment_def method_def(int setting, int method);

/* The numbers of one segmentation. */
typedef struct outcome {
    double metric[METRICS];
    double axis; /* share of the length of the planted mirrors' axes that is seam, the best of them; -1 = has none */
    int32_t splits, invalid;
    bool failed; /* no numbers */
} outcome;

/* One model by all methods and settings. */
typedef struct model {
    exp_source source;
    int32_t facets;
    outcome outcome[SETTINGS][METHODS];
} model;

/* mesh: its seams are cut; charts of the segmentation. made: with the mirrors planted in it; nullable. */
outcome measure(const sl_mesh *mesh, const sl_segmentation *seg, const sl_generated *made, double seconds);

/* log2 of a metric over that of the spectral cuts; NaN where one of the two failed. */
double log_ratio(const model *m, int setting, int method, int metric);

/* All models' log ratios: median, and on how many the method is better (lower), equal within a hundredth, worse. */
typedef struct comparison {
    double median;
    int32_t better, equal, worse;
} comparison;

SL_NODISCARD sl_status compare(const model *models, int32_t count, int setting, int method, int metric,
                               comparison *out);

/* methods.csv, ratios.csv, wins.csv and timings.csv. */
SL_NODISCARD sl_status write_csvs(exp_run *run, const model *models, int32_t count);

/* How many models have an axis, and on how many of them a method's seams hold nine tenths of one. */
void count_axes(const model *models, int32_t count, int setting, int method, int32_t *kept, int32_t *all);

/* The tables under the plots: medians and wins; then a table a number, folded up. */
SL_NODISCARD sl_status show_summary(exp_page *page, const model *models, int32_t count);
void show_models(exp_page *page, const model *models, int32_t count, int setting);

#endif
