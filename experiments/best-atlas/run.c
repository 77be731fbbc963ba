/* The best atlases: fewer charts and shorter seams by search, beside the paper's own cuts. */
#include "atlases.h"
#include "support/csv.h"
#include "support/pictures.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { WIDTH = 900, HEIGHT = 320, MOST_MODELS = 64 };

static const char *const quick_set[] = {"bracket", "tee", "fork", "mug"};
static const char *const full_set[] = {"character", "bracket",  "tee",  "fork",      "hand", "body",
                                       "quadruped", "airplane", "mug",  "propeller", "fish", "bolt",
                                       "football",  "boat",     "bust", "gear"};

static const char *const small_meshes[] = {"cow",         "spot",    "suzanne",    "homer",
                                           "cheburashka", "fandisk", "rocker-arm", "hand"};

/* Every model with its atlases, for the tables after the pictures. */
typedef struct results {
    int32_t count;
    exp_source source[MOST_MODELS];
    atlas_row row[MOST_MODELS][RUNS];
} results;

static bool is_one_of(const char *name, const char *const *list, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        if (strcmp(name, list[k]) == 0) {
            return true;
        }
    }
    return false;
}

bool is_small_mesh(const char *name)
{
    return is_one_of(name, small_meshes, SL_COUNTOF(small_meshes));
}

/* The generated ones that are listed, and the corpus's small ones. */
static sl_status list_models(const exp_run *run, results *r)
{
    exp_source *all = sl_alloc(EXP_MAX_MESHES, sizeof *all);
    if (all == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    const int32_t count = exp_list_sources(run, all);
    for (int32_t k = 0; k < count && r->count < MOST_MODELS; k++) {
        if (all[k].generated ? is_one_of(all[k].name, run->quick ? quick_set : full_set,
                                         run->quick ? SL_COUNTOF(quick_set) : SL_COUNTOF(full_set))
                             : !run->quick && is_small_mesh(all[k].name)) {
            r->source[r->count++] = all[k];
        }
    }
    sl_free(all);
    return SL_OK;
}

static void figure(exp_page *page, const char *name, int variant, const atlas_row *row, const char *file)
{
    char alt[160], caption[400];
    snprintf(alt, sizeof alt, "%s in %d chart%s, its atlas beside it", name, row->charts, sl_plural(row->charts));
    snprintf(
        caption, sizeof caption,
        "<b>%s</b>, %s: %d chart%s, seams %.2f, L2 %.3f, &sigma;<sub>1</sub>/&sigma;<sub>2</sub> %.3f, fill %.2f%s",
        name, variant_name[variant], row->charts, sl_plural(row->charts), row->seam, row->l2, row->angle, row->fill,
        row->missed > 0 ? ", <b>off its targets</b>" : "");
    exp_page_figure(page, row->passed ? "" : "no", file, alt, caption);
}

/* What holds of every atlas, and of those of the search beside the paper's. */
static void hold_claims(exp_claims *claims, const char *name, const atlas_row row[RUNS])
{
    for (int v = 0; v < RUNS; v++) {
        exp_claims_measure(claims, name, "atlas made", row[v].made);
        if (!row[v].made || v == PAPER) {
            continue;
        }
        exp_claims_measure(claims, name, "check passed", row[v].passed);
        exp_claims_measure(claims, name, "flipped triangles", row[v].flipped);
        exp_claims_measure(claims, name, "share of texels that overlap", row[v].overlap);
        exp_claims_measure(claims, name, "pieces off their targets", row[v].missed + row[v].failed);
    }
    if (row[AXIS].made && !isnan(row[AXIS].axis)) {
        exp_claims_measure(claims, name, "share of the planted axis in the seams (axis)", row[AXIS].axis);
        exp_claims_measure(claims, name, "share of the planted axis in the seams (first)", row[FIRST].axis);
    }
    if (row[PAPER].made && row[SAME_L2].made) {
        exp_claims_measure(claims, name, "charts over the paper's", (double)row[SAME_L2].charts / row[PAPER].charts);
        exp_claims_measure(claims, name, "seams over the paper's", row[SAME_L2].seam / fmax(row[PAPER].seam, 1e-9));
    }
}

/* A row of pictures; the run at the paper's L2 is only a number. A model that fails is a row of the table. */
static sl_status show_model(exp_run *run, exp_page *page, exp_claims *claims, const exp_source *source,
                            atlas_row row[RUNS])
{
    sl_status status = SL_OK;
    exp_mesh mesh = {0};
    sl_atlas *atlas = NULL;
    const sl_view view = exp_view_of(source->name);
    sl_picture picture = exp_picture(run, WIDTH, HEIGHT);
    picture.back_view = true;
    SL_TRY(exp_mesh_load(source, &mesh, &run->diag));
    exp_page_html(page, "<div class=\"grid wide\">\n");
    for (int v = 0; v < RUNS; v++) {
        const sl_atlas_def def = variant_def(v, &row[PAPER]);
        SL_TRY(make_atlas(run, source->name, &mesh, &def, &atlas, &row[v]));
        if (row[v].made && v != SAME_L2) {
            char file[128];
            snprintf(file, sizeof file, "%s%s-%s.png", source->generated ? "" : "corpus-", source->name,
                     variant_key[v]);
            SL_TRY(exp_draw_atlas(run, atlas, &view, &picture, file));
            figure(page, source->name, v, &row[v], file);
        }
        sl_atlas_free(atlas);
        atlas = NULL;
    }
    exp_page_html(page, "</div>\n");
    hold_claims(claims, source->name, row);
    fprintf(stderr, "%s:", source->name);
    for (int v = 0; v < RUNS; v++) {
        fprintf(stderr, " %s %d/%.2f/%.3f/%.2f %.1fs%s%s", variant_key[v], row[v].charts, row[v].seam, row[v].l2,
                row[v].angle, row[v].seconds, row[v].missed + row[v].failed > 0 ? " missed" : "",
                row[v].passed ? "" : " not passed");
    }
    fprintf(stderr, "\n");
cleanup:
    sl_atlas_free(atlas);
    exp_mesh_clear(&mesh);
    return status;
}

static void table_row(exp_page *page, const char *name, int variant, const atlas_row *row)
{
    exp_page_row_begin(page, !row->made || (variant != PAPER && (!row->passed || row->missed + row->failed > 0)));
    exp_page_cell(page, "%s", name);
    exp_page_cell(page, "%s", variant_name[variant]);
    if (!row->made) {
        exp_page_cell(page, "failed");
        exp_page_row_end(page);
        return;
    }
    exp_page_cell(page, "%d", row->facets);
    exp_page_cell(page, "%d", row->charts);
    exp_page_cell(page, "%d", row->copies);
    number_cells(page, row->seam, row->l2, row->angle, row->fill);
    exp_page_cell(page, isnan(row->axis) ? "&ndash;" : "%.0f %%", 100.0 * row->axis);
    exp_page_cell(page, row->passed ? "proven" : "<b>not valid</b>");
    exp_page_row_end(page);
}

static void tables(exp_page *page, const results *r)
{
    exp_page_html(page, "<h3>All of them in numbers</h3>\n");
    exp_page_table_begin(page, "model|settings|facets|charts|of them copies|seams|L2|&sigma;<sub>1</sub>/&sigma;"
                               "<sub>2</sub>|fill|axis in the seams|check");
    for (int32_t k = 0; k < r->count; k++) {
        for (int v = 0; v < RUNS && r->row[k][AXIS].facets > 0; v++) {
            table_row(page, r->source[k].name, v, &r->row[k][v]);
        }
    }
    exp_page_table_end(page);
    exp_page_html(
        page,
        "<h3>Cost by stage</h3>\n<p>CPU seconds: coarse meshes, the first spectral cuts (start), guesses at candidate "
        "cuts, those tried in full, the balance of stretch and angle, sewing, straightening, the coarse meshes' "
        "charts made on the finer ones (carry), packing, the check; "
        "the rest is reading, symmetry and edge weights.</p>\n<div class=\"plot\">\n");
    exp_page_figure(page, "", "timings.svg", "CPU seconds by stage and model", "Axis protected: where the time goes.");
    exp_page_html(page, "</div>\n");
}

static sl_status write_csvs(exp_run *run, const results *r)
{
    sl_status status = SL_OK;
    sl_writer *numbers = NULL, *timings = NULL;
    char header[256] = "mesh,settings,seconds";
    for (int s = 0; s < STAGES; s++) {
        const size_t used = strlen(header);
        snprintf(header + used, sizeof header - used, ",%s", stage_name[s]);
    }
    SL_TRY(exp_csv_open(run, "atlases.csv", "mesh,settings,facets,charts,copies,passed,missed,seam,l2,angle,fill,axis",
                        &numbers));
    SL_TRY(exp_csv_open(run, "timings.csv", header, &timings));
    for (int32_t k = 0; k < r->count; k++) {
        for (int v = 0; v < RUNS; v++) {
            const atlas_row *row = &r->row[k][v];
            const double number[] = {row->seam, row->l2, row->angle, row->fill};
            if (!row->made) {
                continue;
            }
            sl_writer_format(numbers, "%s,%s,%d,%d,%d,%d,%d", r->source[k].name, variant_key[v], row->facets,
                             row->charts, row->copies, row->passed, row->missed + row->failed);
            exp_csv_numbers(numbers, number, SL_COUNTOF(number));
            sl_writer_text(numbers, ",");
            if (!isnan(row->axis)) {
                sl_writer_double(numbers, row->axis);
            }
            sl_writer_text(numbers, "\n");
            sl_writer_format(timings, "%s,%s,%.3f", r->source[k].name, variant_key[v], row->seconds);
            for (int s = 0; s < STAGES; s++) {
                sl_writer_format(timings, ",%.3f", row->stage[s]);
            }
            sl_writer_text(timings, "\n");
        }
    }
    SL_TRY(exp_csv_close(run, &numbers));
    SL_TRY(exp_csv_close(run, &timings));
cleanup:
    sl_writer_abandon(numbers);
    sl_writer_abandon(timings);
    return status;
}

static void introduce(exp_page *page)
{
    exp_page_html(
        page,
        "<p>Beyond the paper: <code>--preset best</code> starts from the spectral cuts and searches for few charts and "
        "short seams, by darts, bisections and sewing, within two targets of the whole atlas (L2 1.05, mean "
        "&sigma;<sub>1</sub>/&sigma;<sub>2</sub> 1.2). The paper wants a 2D space that its user recognises, and the "
        "fewest charts are not always that: <code>--protect</code> keeps the axis of symmetry, or the axis and the "
        "first spectral cut, from being sewn. Each row: the paper's own atlas, then nothing protected (as other tools "
        "are compared with: symmetry off), the axis (default), the axis and the first cut. Model from before and "
        "behind, atlas beside it. Seams are divided by the root of the surface's area.</p>\n");
}

static sl_status show_all(exp_run *run, exp_page *page, exp_claims *claims)
{
    sl_status status = SL_OK;
    results *r = sl_calloc(1, sizeof *r);
    SL_TRY(r != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(list_models(run, r));
    introduce(page);
    for (int32_t k = 0; k < r->count; k++) {
        SL_TRY(show_model(run, page, claims, &r->source[k], r->row[k]));
    }
    SL_TRY(show_steps(run, page, claims));
    SL_TRY(show_front(run, page, claims));
    SL_TRY(show_peers(run, page, claims));
    tables(page, r);
    SL_TRY(write_csvs(run, r));
cleanup:
    sl_free(r);
    return status;
}

int main(int argc, char **argv)
{
    return exp_main(argc, argv, "best-atlas", "Best atlases: fewer charts, shorter seams", NULL, EXPECTED_CSV,
                    show_all);
}
