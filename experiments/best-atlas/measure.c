#include "atlases.h"

#include "atlas/measure.h"
#include "support/failures.h"

#include <math.h>
#include <string.h>

enum { RESOLUTION = 1024 };

const char *const variant_key[RUNS] = {"paper", "none", "axis", "first", "same"};
const char *const variant_name[RUNS] = {"paper", "best, nothing protected", "best, axis protected",
                                        "best, axis and first cut protected", "best, at the paper's L2"};
const char *const stage_name[STAGES] = {"coarsen",    "start", "guesses", "cuts",  "balance", "sewing",
                                        "straighten", "carry", "packing", "check", "rest"};

void number_cells(exp_page *page, double seam, double l2, double angle, double fill)
{
    exp_page_cell(page, "%.3f", seam);
    exp_page_cell(page, "%.4f", l2);
    exp_page_cell(page, "%.3f", angle);
    exp_page_cell(page, "%.3f", fill);
}

/* When the packing began. */
typedef struct stopwatch {
    double packing;
} stopwatch;

static bool on_step(void *user, const char *stage, double fraction)
{
    stopwatch *watch = user;
    (void)fraction;
    if (watch->packing <= 0.0 && strcmp(stage, "packing") == 0) {
        watch->packing = exp_cpu_seconds();
    }
    return true;
}

sl_atlas_def variant_def(int variant, const atlas_row *same)
{
    sl_atlas_def def = sl_atlas_default();
    if (variant == PAPER) {
        def.segment = sl_segment_paper();
        return def;
    }
    def.best = true;
    def.optimize.protect = variant == FIRST ? SL_PROTECT_FIRST : variant == AXIS ? SL_PROTECT_AXIS : SL_PROTECT_NONE;
    if (def.optimize.protect == SL_PROTECT_NONE) { /* a half that is copied cannot be sewn to its copy */
        def.segment.symmetry = SL_SYMMETRY_USE_OFF;
    }
    if (variant == SAME_L2) {
        def.optimize.empty_cost = 0.0;
        def.optimize.effort = 0.0;
        def.optimize.target_stretch = fmax(same->l2, 1.0 + 1e-6);
        def.optimize.target_angle = fmax(same->angle, def.optimize.target_angle);
        def.optimize.max_stretch = fmax(def.optimize.max_stretch, same->l2);
    }
    return def;
}

/* Share of the length of a mirror's axis that is a seam; NaN where no edge lies on it. */
static double axis_share(const sl_mesh *mesh, const sl_planted *planted)
{
    double all = 0.0, cut = 0.0;
    for (int32_t h = 0; h < mesh->nh; h++) {
        const int32_t other = mesh->twin[h] >= 0 ? mesh->twin[h] : mesh->sew[h];
        if (other > h && planted->face[mesh->face[h]] == mesh->face[other] && mesh->face[h] != mesh->face[other]) {
            const double length = sl_mesh_edge_length(mesh, h);
            all += length;
            cut += mesh->twin[h] < 0 ? length : 0.0;
        }
    }
    return all > 0.0 ? cut / all : NAN;
}

/* Of the planted mirrors the one that the seams follow most. */
static double best_axis(const sl_atlas *atlas, const sl_generated *generated)
{
    double best = NAN;
    for (int32_t k = 0; generated != NULL && k < generated->nplanted; k++) {
        const sl_planted *planted = &generated->planted[k];
        if (planted->mirror && planted->exact) {
            best = fmax(best, axis_share(atlas->mesh, planted)); /* fmax leaves NaN out */
        }
    }
    return best;
}

static sl_status measure_atlas(exp_run *run, const exp_mesh *mesh, sl_atlas *atlas, atlas_row *row)
{
    const sl_segmentation *seg = atlas->segmentation;
    sl_atlas_measure m;
    sl_status status = SL_OK;
    sl_sharing_table table = {.nf = mesh->polygons.nf, .nchart = seg->nchart, .face_chart = seg->face_chart};
    table.copy_of = sl_alloc(seg->nchart, sizeof *table.copy_of);
    SL_TRY(table.copy_of != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t c = 0; c < seg->nchart; c++) {
        table.copy_of[c] = seg->chart[c].copy_of;
    }
    SL_TRY(sl_measure_shared(&mesh->polygons, atlas->input_corner_uv, &table, RESOLUTION, &run->context, &m, NULL));
    row->charts = m.charts;
    row->copies = m.copies;
    row->missed = atlas->optimized.missed;
    row->failed = atlas->optimized.failed;
    row->passed = atlas->check.passed;
    row->flipped = atlas->check.flipped;
    row->overlap = m.overlap_inside + m.overlap_across;
    row->seam = m.seam_length;
    row->l2 = m.global.l2;
    row->angle = m.global.angle_mean;
    row->fill = m.fill;
    row->axis = best_axis(atlas, mesh->generated);
cleanup:
    sl_free(table.copy_of);
    return status;
}

/* The search tells its own stages; the rest is building the mesh, symmetry, and the paper's cuts where there is no
 * search. */
static void take_stages(const sl_optimize_info *info, atlas_row *row)
{
    row->stage[REST] = row->seconds - row->stage[PACK] - row->stage[CHECK];
    for (int s = 0; s < SL_OPTIMIZE_STAGES; s++) {
        row->stage[s] = info->seconds[s];
        row->stage[REST] -= info->seconds[s];
    }
    row->stage[REST] = fmax(row->stage[REST], 0.0);
}

sl_status make_atlas(exp_run *run, const char *name, const exp_mesh *mesh, const sl_atlas_def *def, sl_atlas **atlas,
                     atlas_row *row)
{
    stopwatch watch = {0};
    const double start = exp_cpu_seconds();
    sl_context context = run->context;
    context.progress = on_step;
    context.progress_user = &watch;
    *row = (atlas_row){.facets = mesh->polygons.nf, .axis = NAN};
    *atlas = NULL;
    sl_status status = sl_unwrap(&mesh->polygons, def, &context, atlas, &run->diag);
    const double end = exp_cpu_seconds();
    if (exp_failed(run, name, &status) || status != SL_OK) {
        return status;
    }
    SL_TRY(sl_atlas_settle(*atlas, def, &run->context)); /* once more, to see what of the packing's time it takes */
    row->seconds = end - start;
    row->stage[CHECK] = exp_cpu_seconds() - end;
    row->stage[PACK] = watch.packing > 0.0 ? fmax(end - watch.packing - row->stage[CHECK], 0.0) : 0.0;
    take_stages(&(*atlas)->optimized, row);
    SL_TRY(measure_atlas(run, mesh, *atlas, row));
    row->made = true;
cleanup:
    return status;
}
