/* Figure 8: segmentations of all meshes at hand, by `--preset fast`, the paper's settings and the search. */
#include "segmentations.h"
#include "support/failures.h"
#include "support/main.h"
#include "support/pictures.h"

#include <stdio.h>
#include <string.h>

enum { LARGE_WIDTH = 900, LARGE_HEIGHT = 420, SMALL_WIDTH = 560, SMALL_HEIGHT = 262, MOST_FACETS_QUICK = 3000 };

/* What --quick runs: some of every kind, and those that expected.csv names. */
static const char *const quick_set[] = {"hand",  "body", "octopus", "airplane", "sphere",
                                        "torus", "box",  "bracket", "mug"};

/* Those that --quick leaves out are taken from the list. */
static int32_t keep_quick_ones(exp_source *source, int32_t count)
{
    int32_t kept = 0;
    for (int32_t k = 0; k < count; k++) {
        bool listed = false;
        for (size_t i = 0; source[k].generated && i < SL_COUNTOF(quick_set); i++) {
            listed = listed || strcmp(quick_set[i], source[k].name) == 0;
        }
        if (listed) {
            source[kept++] = source[k];
        }
    }
    return kept;
}

static sl_atlas_def preset_def(int preset)
{
    sl_atlas_def def = sl_atlas_default();
    def.best = preset == BEST;
    if (preset == PAPER) {
        def.segment = sl_segment_paper();
    }
    return def;
}

static int32_t facets_without_chart(const sl_atlas *atlas)
{
    int32_t lost = 0;
    for (int32_t f = 0; f < atlas->mesh->nf; f++) {
        const int32_t c = atlas->segmentation->face_chart[f];
        lost += c < 0 || c >= atlas->segmentation->nchart;
    }
    return lost;
}

static void hold_claims(exp_claims *claims, const exp_source *source, int preset, const sl_atlas *atlas,
                        const atlas_row *row)
{
    if (preset == PAPER) {
        exp_claims_measure(claims, source->name, "invalid charts (paper preset)", row->invalid);
        return;
    }
    exp_claims_measure(claims, source->name, "check passed", row->passed);
    exp_claims_measure(claims, source->name, "flipped triangles", atlas->check.flipped);
    exp_claims_measure(claims, source->name, "overlapping texels", (double)row->overlapping);
    exp_claims_measure(claims, source->name, "facets without a chart", facets_without_chart(atlas));
    exp_claims_measure(claims, source->name, "fill of the page", row->fill);
    exp_claims_measure(claims, source->name, "worst L2 of charts without a warning", row->l2_unwarned);
    if (preset == FAST && source->generated) {
        exp_claims_measure(claims, source->name, "charts", row->charts);
    }
}

/* Unwraps, draws, measures. */
static sl_status make_atlas(exp_run *run, exp_page *page, const exp_source *source, const exp_mesh *mesh, int preset,
                            exp_claims *claims, atlas_row *row)
{
    sl_status status = SL_OK;
    sl_atlas *atlas = NULL;
    char file[128], alt[160], caption[320];
    const sl_atlas_def def = preset_def(preset);
    const sl_view view = exp_view_of(source->name);
    const sl_picture picture =
        exp_picture(run, preset == FAST ? LARGE_WIDTH : SMALL_WIDTH, preset == FAST ? LARGE_HEIGHT : SMALL_HEIGHT);
    const double start = exp_cpu_seconds();
    SL_TRY(sl_unwrap(&mesh->polygons, &def, &run->context, &atlas, &run->diag));
    *row = row_of(atlas, &mesh->polygons, mesh->generated, exp_cpu_seconds() - start);
    hold_claims(claims, source, preset, atlas, row);
    snprintf(file, sizeof file, "%s%s-%s.png", source->generated ? "" : "corpus-", source->name, preset_name[preset]);
    SL_TRY(exp_draw_atlas(run, atlas, &view, &picture, file));
    snprintf(alt, sizeof alt, "%s cut into %d chart%s, its atlas beside it", source->name, row->charts,
             sl_plural(row->charts));
    snprintf(caption, sizeof caption, "<b>%s</b>%s, %s: %d chart%s, seams %.2f diagonals, L2 %.3f, worst %.3f",
             source->name, source->generated ? "" : " (corpus)", preset_name[preset], row->charts,
             sl_plural(row->charts), row->seam, row->l2_mean, row->l2_worst);
    exp_page_figure(page, row->passed ? "" : "no", file, alt, caption);
cleanup:
    sl_atlas_free(atlas);
    return status;
}

/* By all presets; one that fails is a row that says so. The search takes its time: --quick has it on small meshes. */
static sl_status show_presets(exp_run *run, exp_page *page, exp_claims *claims, const exp_source *source,
                              const exp_mesh *mesh, atlas_row row[PRESETS])
{
    sl_status status = SL_OK;
    const int presets = run->quick && mesh->polygons.nf > MOST_FACETS_QUICK ? BEST : PRESETS;
    exp_page_html(page, "<div class=\"duo\">\n");
    for (int k = 0; k < presets && status == SL_OK; k++) {
        char name[96];
        exp_page_html(page, k == PAPER ? "<div style=\"display:grid;gap:.75rem\">\n" : "");
        status = make_atlas(run, page, source, mesh, k, claims, &row[k]);
        snprintf(name, sizeof name, "%s by preset %s", source->name, preset_name[k]);
        exp_failed(run, name, &status);
    }
    exp_page_html(page, "</div>\n</div>\n");
    fprintf(stderr, "%s: %d chart%s, %.1f s; as the paper: %d, %.1f s; best: %d, %.1f s\n", source->name,
            row[FAST].charts, sl_plural(row[FAST].charts), row[FAST].seconds, row[PAPER].charts, row[PAPER].seconds,
            row[BEST].charts, row[BEST].seconds);
    return status;
}

static sl_status show_mesh(exp_run *run, exp_page *page, exp_claims *claims, const exp_source *source,
                           atlas_row row[PRESETS])
{
    exp_mesh mesh;
    sl_status status = exp_mesh_load(source, &mesh, &run->diag);
    if (!exp_failed(run, source->name, &status) && status == SL_OK) {
        status = show_presets(run, page, claims, source, &mesh, row);
    }
    exp_mesh_clear(&mesh);
    return status;
}

static void introduce(exp_page *page)
{
    exp_page_html(
        page,
        "<p>The paper's Figure 8 shows segmentations of some of 36 models, not public either. Here: every "
        "generated mesh, and every mesh of the corpus folder where one is given (a few with <code>--quick</code>). "
        "The large picture is <code>--preset fast</code> (lookahead, loops joined, cuts smoothed, neighbours sewn "
        "while they stay "
        "valid, symmetry used); beside it the paper as printed (longest seam, nothing after it), and the search for "
        "fewer charts and shorter seams (<code>--preset best</code>). Charts have one colour on the model and in the "
        "atlas; the checkerboard is the same on all. L2 is Sander's stretch per chart, 1 = isometric; "
        "&sigma;<sub>1</sub>/&sigma;<sub>2</sub> the mean angular distortion; seams are divided by the bounding "
        "box's diagonal; axis kept: how much of a planted mirror's axis is seam; copies share their texels on purpose. "
        "Where each loses to other ways to cut: the companion comparison.</p>\n");
}

static sl_status show_all(exp_run *run, exp_page *page, exp_claims *claims)
{
    sl_status status = SL_OK;
    results r = {.source = sl_alloc(EXP_MAX_MESHES, sizeof *r.source), .row = sl_calloc(EXP_MAX_MESHES, sizeof *r.row)};
    if (r.source == NULL || r.row == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    r.count = exp_list_sources(run, r.source);
    r.count = run->quick ? keep_quick_ones(r.source, r.count) : r.count;
    introduce(page);
    for (int32_t k = 0; k < r.count; k++) {
        SL_TRY(show_mesh(run, page, claims, &r.source[k], r.row[k]));
    }
    exp_page_html(page, "<div class=\"plot\">\n");
    exp_page_figure(page, "", "charts.svg", "charts and seam length by mesh and preset",
                    "Charts a mesh is cut into, and the length of its seams.");
    exp_page_html(page, "</div>\n");
    show_rows(page, &r);
    SL_TRY(write_csvs(run, &r));
cleanup:
    sl_free(r.source);
    sl_free(r.row);
    return status;
}

int main(int argc, char **argv)
{
    return exp_main(argc, argv, "fig08-segmentations", "Figure 8: segmentations", NULL, EXPECTED_CSV, show_all);
}
