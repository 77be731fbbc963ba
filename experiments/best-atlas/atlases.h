/* The atlases that are compared, and what is known of each.
 * Layer: experiments. */
#ifndef SL_EXPERIMENTS_ATLASES_H
#define SL_EXPERIMENTS_ATLASES_H

#include "generators.h"
#include "support/main.h"

enum { PAPER, NONE, AXIS, FIRST, VARIANTS, SAME_L2 = VARIANTS, RUNS };
enum { PACK = SL_OPTIMIZE_STAGES, CHECK, REST, STAGES };

extern const char *const variant_key[RUNS], *const variant_name[RUNS], *const stage_name[STAGES];

typedef struct atlas_row {
    bool made;   /* false: nothing came out, the rest is empty */
    bool passed; /* its own check: no flip, no overlap, proven */
    int32_t facets, charts, copies;
    int32_t missed, failed;       /* pieces off their targets; left to the recursion */
    int32_t flipped;              /* triangles */
    double overlap;               /* share of texels hit twice, by the raster test of `measure` */
    double seam, l2, angle, fill; /* over sqrt(area); of the whole atlas after one scale; fill of the bounding square */
    double axis;                  /* share of the planted axis's length that is a seam; NaN = no exact mirror known */
    double seconds, stage[STAGES]; /* CPU */
} atlas_row;

/* The settings of a run; same: the row whose L2 SAME_L2 takes for its target. */
sl_atlas_def variant_def(int variant, const atlas_row *same);

/* Unwraps and measures; *atlas is owned by the caller, NULL where none was made: row->made = false and a
 * failure of that name, which is no error. SL_CANCELLED. */
SL_NODISCARD sl_status make_atlas(exp_run *run, const char *name, const exp_mesh *mesh, const sl_atlas_def *def,
                                  sl_atlas **atlas, atlas_row *row);

/* Cells of a table's row. */
void number_cells(exp_page *page, double seam, double l2, double angle, double fill);

/* The small meshes that tables of other tools are about; others of a corpus take too long for a page. */
bool is_small_mesh(const char *name);

/* What can be had for what: charts and seams against stretch, for some models. Writes front.csv. */
SL_NODISCARD sl_status show_front(exp_run *run, exp_page *page, exp_claims *claims);

/* One search, stopped early again and again. */
SL_NODISCARD sl_status show_steps(exp_run *run, exp_page *page, exp_claims *claims);

/* Ours against what other tools made of the same meshes, where their table is at hand; else what was recorded. */
SL_NODISCARD sl_status show_peers(exp_run *run, exp_page *page, exp_claims *claims);

#endif
