/* Are seams the same over poses, noise and other meshes of one surface? */
#include "support/csv.h"
#include "support/failures.h"
#include "support/pictures.h"
#include "variants.h"

#include <math.h>
#include <stdio.h>

enum { SPECTRAL, PAPER, PCA, VSA, METHODS, MODELS = 4 };

static const char *const method_name[METHODS] = {"spectral", "spectral-as-printed", "pca", "vsa"};
static const char *const method_title[METHODS] = {"spectral", "spectral, as printed", "PCA", "VSA, two proxies"};
static const char *const models[MODELS] = {"hand", "octopus", "body", "fish"};
static const double reach_share = 0.02; /* of the model's length */

typedef struct seams {
    double *point, *length;
    int32_t count, charts;
} seams;

static sl_segment_def method_def(int method)
{
    sl_segment_def def = method == PAPER ? sl_segment_paper() : sl_segment_default();
    def.symmetry = SL_SYMMETRY_USE_OFF;
    def.method = method == PCA ? SL_METHOD_PCA : method == VSA ? SL_METHOD_VSA : SL_METHOD_SPECTRAL;
    def.vsa_regions = method == VSA ? 2 : 0;
    return def;
}

static void seams_clear(seams *s)
{
    sl_free(s->point);
    sl_free(s->length);
    *s = (seams){0};
}

static sl_status cut(exp_run *run, bend_model *model, int which, int method, const char *file, seams *out)
{
    sl_status status = SL_OK;
    variant v = {0};
    sl_mesh *mesh = NULL;
    sl_triangulation *triangulation = NULL;
    sl_segmentation *seg = NULL;
    const sl_segment_def def = method_def(method);
    *out = (seams){0};
    SL_TRY(variant_make(model, which, &v));
    SL_TRY(sl_mesh_build(&v.polygons, &mesh, NULL, &run->diag));
    SL_TRY(sl_triangulation_create(mesh, &triangulation));
    SL_TRY(sl_segment(mesh, triangulation, &def, &run->context, &seg));
    out->charts = seg->nchart;
    SL_TRY(variant_seams(model, mesh, &out->point, &out->length, &out->count));
    if (file != NULL) {
        sl_view view = sl_view_default();
        view.elevation = 35.0;
        const sl_picture picture = exp_picture(run, 360, 280);
        SL_TRY(exp_draw_charts(run, mesh, triangulation, seg->face_chart, &view, &picture, file));
    }
cleanup:
    sl_segmentation_free(seg);
    sl_triangulation_free(triangulation);
    sl_mesh_free(mesh);
    variant_clear(&v);
    return status;
}

/* One line of the table: how much of the seams stays where it is, both ways the smaller. */
static void report(exp_page *page, exp_claims *claims, sl_writer *csv, const char *model, int method, int which,
                   const seams *base, const seams *now, double reach)
{
    char name[96];
    const double kept = variant_covered(base->point, base->length, base->count, now->point, now->count, reach),
                 new = variant_covered(now->point, now->length, now->count, base->point, base->count, reach);
    snprintf(name, sizeof name, "%s by %s %s", model, method_name[method], variant_name[which]);
    exp_claims_measure(claims, name, "seams that stay", fmin(kept, new));
    exp_page_row_begin(page, false);
    exp_page_cell(page, "%s", model);
    exp_page_cell(page, "%s", method_title[method]);
    exp_page_cell(page, "%s", variant_title[which]);
    exp_page_cell(page, "%d", now->charts);
    exp_page_cell(page, "%.0f %%", 100.0 * kept);
    exp_page_cell(page, "%.0f %%", 100.0 * (1.0 - new));
    exp_page_row_end(page);
    sl_writer_format(csv, "%s,%s,%s,%d", model, method_name[method], variant_name[which], now->charts);
    exp_csv_numbers(csv, (const double[]){kept, new}, 2);
    sl_writer_text(csv, "\n");
}

static sl_status compare_variants(exp_run *run, exp_page *page, exp_claims *claims, sl_writer *csv, const char *name)
{
    sl_status status = SL_OK;
    bend_model model = {0};
    seams base = {0}, now = {0};
    SL_TRY(bend_load(run, name, &model));
    for (int method = 0; method < METHODS; method++) {
        for (int which = 0; which < VARIANTS; which++) {
            char file[96];
            snprintf(file, sizeof file, "%s-%s.png", name, variant_name[which]);
            SL_TRY(cut(run, &model, which, method, method == SPECTRAL ? file : NULL, which == 0 ? &base : &now));
            if (which > 0) {
                report(page, claims, csv, name, method, which, &base, &now, reach_share * model.length);
            }
            seams_clear(&now);
        }
        seams_clear(&base);
    }
    fprintf(stderr, "%s: done\n", name);
cleanup:
    seams_clear(&base);
    seams_clear(&now);
    bend_clear(&model);
    return status;
}

static void show_pictures(exp_page *page, int count)
{
    for (int m = 0; m < count; m++) {
        exp_page_html(page, "<div class=\"grid\">\n");
        for (int which = 0; which < VARIANTS; which++) {
            char file[96], caption[160], alt[160];
            snprintf(file, sizeof file, "%s-%s.png", models[m], variant_name[which]);
            snprintf(alt, sizeof alt, "%s, %s, cut by spectral cuts", models[m], variant_name[which]);
            snprintf(caption, sizeof caption, "<b>%s</b>, %s", models[m], variant_title[which]);
            exp_page_figure(page, "", file, alt, caption);
        }
        exp_page_html(page, "</div>\n");
    }
}

static sl_status show_all(exp_run *run, exp_page *page, exp_claims *claims)
{
    sl_status status = SL_OK;
    sl_writer *csv = NULL;
    const int count = run->quick ? 1 : MODELS;
    SL_TRY(exp_csv_open(run, "seams.csv", "model,method,variant,charts,kept,of_new", &csv));
    exp_page_table_begin(page, "model|method|variant|charts|seams kept|seams new");
    for (int m = 0; m < count; m++) {
        SL_TRY(exp_row(run, models[m], compare_variants(run, page, claims, csv, models[m])));
    }
    exp_page_table_end(page);
    show_pictures(page, count);
    SL_TRY(exp_csv_close(run, &csv));
cleanup:
    sl_writer_abandon(csv);
    return status;
}

int main(int argc, char **argv)
{
    return exp_main(argc, argv, "pose-invariance", "Poses, noise and remeshing: how far do seams move?",
                    "Rustamov's embedding by eigenfunctions is \"pose-invariant\" (Sec. 3.1); cuts along eigenvectors "
                    "of the facet graph "
                    "should be, too, since the graph does not know positions at all. The same surface bent, curled, "
                    "with noise, with "
                    "other diagonals and with flipped edges; seams are compared on the straight model: a piece of seam "
                    "is kept when "
                    "there is one within 2 % of the model's length.",
                    EXPECTED_CSV, show_all);
}
