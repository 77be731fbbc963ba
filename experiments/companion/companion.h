/* The companion comparison: every model by every way to cut, and other tools' atlases beside them. */
#ifndef SL_EXPERIMENTS_COMPANION_H
#define SL_EXPERIMENTS_COMPANION_H

#include "support/claims.h"
#include "support/methods.h"

/* One model by all ways. */
typedef struct model {
    exp_source source;
    int32_t facets, triangles;
    exp_numbers way[EXP_WAYS];
} model;

/* An atlas of another tool. */
typedef struct added {
    const exp_added *from;
    char mesh[64]; /* what the file is called after */
    int32_t model; /* the same mesh, -1 = none */
    int32_t facets;
    exp_numbers numbers;
} added;

typedef struct companion {
    int32_t count, added;
    model *model;
    added *add;
} companion;

/* log2 of a metric by one way over that by another; NaN where one of the two failed. */
double log_ratio(const model *m, int way, int base, int metric);

/* All models' log ratios: median, and on how many the way is better (lower), equal within a hundredth, worse. */
typedef struct comparison {
    double median;
    int32_t better, equal, worse;
} comparison;

SL_NODISCARD sl_status compare(const companion *all, int way, int base, int metric, comparison *out);

/* How many models have an axis, and on how many of them a way's seams hold nine tenths of one. */
void count_axes(const companion *all, int way, int32_t *kept, int32_t *of);

/* The way of the same setting that needs fewer charts than the paper's method and no longer seams: of several the one
 * with the fewest charts, then the shortest seams. -1 = none, the paper's method stands. */
int paper_loses_to(const model *m);

/* added.c: does the name of a file ("hand.xatlas.obj", "hand-uv.obj") begin with a model's? */
bool named_after(const char *path, const char *name);

/* added.c: measures the files that were added, against the models where facets or triangles agree. A file that cannot
 * be measured is a failure. */
SL_NODISCARD sl_status measure_added(exp_run *run, companion *all);

/* methods.csv, ratios.csv, wins.csv, added.csv and timings.csv. */
SL_NODISCARD sl_status write_csvs(exp_run *run, const companion *all);

/* show.c: the tables. */
SL_NODISCARD sl_status show_summary(exp_page *page, const companion *all);
void show_losses(exp_page *page, const companion *all);
void show_added(exp_page *page, const companion *all);
void show_models(exp_page *page, const companion *all, int setting);

#endif
