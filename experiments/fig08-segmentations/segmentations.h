/* Figure 8: atlases of one mesh by the presets.
 * Layer: experiments. */
#ifndef SL_EXPERIMENTS_SEGMENTATIONS_H
#define SL_EXPERIMENTS_SEGMENTATIONS_H

#include "support/claims.h"
#include "support/methods.h"

enum { FAST, PAPER, BEST, PRESETS };

extern const char *const preset_name[PRESETS];

/* The numbers of one atlas. */
typedef struct atlas_row {
    bool made, passed; /* false: not run, or failed; of the atlas's own check */
    int32_t facets, charts, splits, invalid, copies;
    int64_t overlapping; /* texels, without those shared on purpose */
    double seam, l2_mean, l2_worst, l2_unwarned, angle, area, turning, axis, fill, seconds;
} atlas_row;

/* All meshes. */
typedef struct results {
    int32_t count;
    exp_source *source;
    atlas_row (*row)[PRESETS];
} results;

atlas_row row_of(const sl_atlas *atlas, const sl_polygons *polygons, const sl_generated *made, double seconds);

/* The table of all meshes and presets; segmentations.csv and timings.csv. */
void show_rows(exp_page *page, const results *r);
SL_NODISCARD sl_status write_csvs(exp_run *run, const results *r);

#endif
