/* Figure 7: one mesh cut by four methods, and what comes of it. */
#ifndef SL_EXPERIMENTS_METHODS_H
#define SL_EXPERIMENTS_METHODS_H

#include "support/claims.h"
#include "support/pictures.h"
#include "support/turning.h"

/* Where cuts come from. The first is what the others are compared with. */
enum { SPECTRAL, PCA, VSA_TWO, VSA_ERROR, METHODS };

/* As the paper has it (nothing after the cut), and the default (smoothed, joined, sewn). */
enum { AS_CUT, DEFAULT, SETTINGS };

enum { CHARTS, SEAM, STRETCH, JAGGED, SECONDS, METRICS };

extern const char *const method_name[METHODS];   /* "vsa2" */
extern const char *const method_title[METHODS];  /* "VSA, two proxies a cut" */
extern const char *const setting_name[SETTINGS]; /* "as-cut" */
extern const char *const metric_name[METRICS];   /* "charts" */
extern const char *const metric_title[METRICS];

sl_segment_def method_def(int setting, int method);

/* The numbers of one segmentation. */
typedef struct outcome {
    double metric[METRICS];
    int32_t splits, invalid;
} outcome;

/* One model by all methods and settings. */
typedef struct model {
    exp_source source;
    int32_t facets;
    outcome outcome[SETTINGS][METHODS];
} model;

/* mesh: its seams are cut; charts of the segmentation. */
outcome measure(const sl_mesh *mesh, const sl_segmentation *seg, double seconds);

/* log2 of a metric over that of the spectral cuts. */
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

/* The tables under the plots. */
SL_NODISCARD sl_status show_summary(exp_page *page, const model *models, int32_t count);
void show_models(exp_page *page, const model *models, int32_t count, int setting);

#endif
