/* Sec. 3.2: PCA and planes find the equator of straight objects only. Straight objects, bent more and more. */
#include "lens.h"
#include "support/csv.h"
#include "support/failures.h"
#include "support/main.h"
#include "support/pictures.h"
#include "support/turning.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { SPECTRAL, PCA, VSA, METHODS, MODELS = 3, MOST_ANGLES = 12 };

static const char *const method_name[METHODS] = {"spectral", "pca", "vsa"};
static const char *const method_title[METHODS] = {"spectral", "PCA", "VSA, two proxies"};

static const struct {
    const char *name, *title;
} models[MODELS] = {
    {"lens", "lens (an ellipsoid, 3 : 1 : 0.45)"},
    {"hand", "hand"},
    {"body", "body"},
};

/* One model, bent to one angle, cut by one method. */
typedef struct outcome {
    double degrees, equator, seam, turning, l2;
    int32_t charts, invalid;
} outcome;

typedef struct results {
    int32_t angles;
    bool made[MODELS]; /* false: failed */
    outcome outcome[MODELS][MOST_ANGLES][METHODS];
} results;

static sl_segment_def method_def(int method)
{
    sl_segment_def def = sl_segment_paper();
    def.symmetry = SL_SYMMETRY_USE_OFF;
    def.method = method == SPECTRAL ? SL_METHOD_SPECTRAL : method == PCA ? SL_METHOD_PCA : SL_METHOD_VSA;
    def.vsa_regions = method == VSA ? 2 : 0;
    return def;
}

/* The first cut alone: does it divide front and back? */
static sl_status first_cut(exp_run *run, const bend_model *model, int method, outcome *o)
{
    sl_status status = SL_OK;
    sl_mesh *mesh = NULL;
    sl_triangulation *triangulation = NULL;
    sl_segmentation *seg = NULL;
    sl_segment_def def = method_def(method);
    def.max_charts = 2;
    SL_TRY(sl_mesh_build(&model->polygons, &mesh, NULL, &run->diag));
    SL_TRY(sl_triangulation_create(mesh, &triangulation));
    SL_TRY(sl_segment(mesh, triangulation, &def, &run->context, &seg));
    o->equator = bend_equator(model, seg->face_chart);
cleanup:
    sl_segmentation_free(seg);
    sl_triangulation_free(triangulation);
    sl_mesh_free(mesh);
    return status;
}

static void count_charts(const sl_segmentation *seg, outcome *o)
{
    double area = 0.0, square = 0.0;
    o->charts = seg->nchart;
    for (int32_t c = 0; c < seg->nchart; c++) {
        const sl_flatten_result *flat = &seg->chart[c].flat;
        o->invalid += flat->verdict != SL_CHART_VALID;
        if (flat->distortion.measured > 0 && isfinite(flat->distortion.l2)) {
            area += flat->distortion.area_3d;
            square += flat->distortion.area_3d * flat->distortion.l2 * flat->distortion.l2;
        }
    }
    o->l2 = area > 0.0 ? sqrt(square / area) : 0.0;
}

static sl_status draw(exp_run *run, const sl_mesh *mesh, const sl_triangulation *triangulation,
                      const sl_segmentation *seg, const char *file)
{
    sl_view view = sl_view_default();
    view.azimuth = 25.0;
    view.elevation = 30.0;
    const sl_picture picture = exp_picture(run, 420, 320);
    return exp_draw_charts(run, mesh, triangulation, seg->face_chart, &view, &picture, file);
}

/* All cuts, until every chart is valid. */
static sl_status all_cuts(exp_run *run, const bend_model *model, int method, outcome *o, const char *file)
{
    sl_status status = SL_OK;
    sl_mesh *mesh = NULL;
    sl_triangulation *triangulation = NULL;
    sl_segmentation *seg = NULL;
    const sl_segment_def def = method_def(method);
    SL_TRY(sl_mesh_build(&model->polygons, &mesh, NULL, &run->diag));
    SL_TRY(sl_triangulation_create(mesh, &triangulation));
    SL_TRY(sl_segment(mesh, triangulation, &def, &run->context, &seg));
    o->seam = sl_atlas_seam_length(mesh) / (model->length * mesh->scale);
    o->turning = exp_seam_turning(mesh);
    count_charts(seg, o);
    if (file != NULL) {
        SL_TRY(draw(run, mesh, triangulation, seg, file));
    }
cleanup:
    sl_segmentation_free(seg);
    sl_triangulation_free(triangulation);
    sl_mesh_free(mesh);
    return status;
}

static void show_picture(exp_page *page, int model, int method, const outcome *o, const char *file)
{
    char alt[160], caption[240];
    snprintf(alt, sizeof alt, "%s bent by %.0f degrees, cut by %s", models[model].name, o->degrees,
             method_title[method]);
    snprintf(caption, sizeof caption,
             "<b>%s</b>, %.0f&deg;: %d chart%s; the first cut tells front from back for %.0f %% of the surface",
             method_title[method], o->degrees, o->charts, sl_plural(o->charts), 100.0 * o->equator);
    exp_page_figure(page, "", file, alt, caption);
}

static sl_status bend_one(exp_run *run, exp_page *page, int m, bend_model *model, double degrees, bool shown,
                          outcome row[METHODS])
{
    sl_status status = SL_OK;
    bend_by(model, degrees);
    for (int method = 0; method < METHODS; method++) {
        char file[96];
        outcome *o = &row[method];
        snprintf(file, sizeof file, "%s-%03.0f-%s.png", models[m].name, degrees, method_name[method]);
        o->degrees = degrees;
        SL_TRY(first_cut(run, model, method, o));
        SL_TRY(all_cuts(run, model, method, o, shown ? file : NULL));
        if (shown) {
            show_picture(page, m, method, o, file);
        }
    }
    fprintf(stderr, "%s, %.0f degrees: %d, %d, %d charts\n", models[m].name, degrees, row[SPECTRAL].charts,
            row[PCA].charts, row[VSA].charts);
cleanup:
    return status;
}

static sl_status bend_model_all(exp_run *run, exp_page *page, int m, results *r)
{
    sl_status status = SL_OK;
    bend_model model = {0};
    const double step = run->quick ? 90.0 : 30.0;
    exp_page_html(page, "<h3>%s</h3>\n<div class=\"grid thirds\">\n", models[m].title);
    SL_TRY(m == 0 ? lens_make(&model) : bend_load(run, models[m].name, &model));
    for (int32_t a = 0; a < r->angles; a++) {
        const bool shown = a == 0 || fabs(step * a - 270.0) < 1.0;
        SL_TRY(bend_one(run, page, m, &model, step * a, shown, r->outcome[m][a]));
    }
    r->made[m] = true;
cleanup:
    exp_page_html(page, "</div>\n");
    bend_clear(&model);
    return status;
}

static sl_status write_csv(exp_run *run, const results *r)
{
    sl_status status = SL_OK;
    sl_writer *csv = NULL;
    SL_TRY(exp_csv_open(run, "bending.csv", "model,method,degrees,charts,equator,seam_over_length,turning,l2,invalid",
                        &csv));
    for (int m = 0; m < MODELS; m++) {
        for (int k = 0; k < METHODS; k++) {
            for (int32_t a = 0; r->made[m] && a < r->angles; a++) {
                const outcome *o = &r->outcome[m][a][k];
                const double number[] = {o->equator, o->seam, o->turning, o->l2};
                sl_writer_format(csv, "%s,%s,%.0f,%d", models[m].name, method_name[k], o->degrees, o->charts);
                exp_csv_numbers(csv, number, SL_COUNTOF(number));
                sl_writer_format(csv, ",%d\n", o->invalid);
            }
        }
    }
    SL_TRY(exp_csv_close(run, &csv));
cleanup:
    sl_writer_abandon(csv);
    return status;
}

static void table(exp_page *page, const results *r)
{
    exp_page_table_begin(page, "model|method|bent [&deg;]|charts|front from back|seam / length|turning [&deg;]|L2");
    for (int m = 0; m < MODELS; m++) {
        for (int k = 0; k < METHODS; k++) {
            for (int32_t a = 0; r->made[m] && a < r->angles; a++) {
                const outcome *o = &r->outcome[m][a][k];
                exp_page_row_begin(page, o->invalid > 0);
                exp_page_cell(page, "%s", models[m].name);
                exp_page_cell(page, "%s", method_title[k]);
                exp_page_cell(page, "%.0f", o->degrees);
                exp_page_cell(page, "%d", o->charts);
                exp_page_cell(page, "%.2f", o->equator);
                exp_page_cell(page, "%.2f", o->seam);
                exp_page_cell(page, "%.1f", o->turning);
                exp_page_cell(page, "%.3f", o->l2);
                exp_page_row_end(page);
            }
        }
    }
    exp_page_table_end(page);
}

/* What happens to the lens between straight and bent by 270 degrees. */
static void measure_claims(exp_claims *claims, const results *r, const exp_run *run)
{
    const int32_t bent = run->quick ? 3 : 9;
    for (int m = 0; m < MODELS; m++) {
        for (int k = 0; r->made[m] && k < METHODS; k++) {
            char name[64];
            snprintf(name, sizeof name, "%s by %s", models[m].name, method_name[k]);
            exp_claims_measure(claims, name, "front from back straight", r->outcome[m][0][k].equator);
            exp_claims_measure(claims, name, "front from back bent by 270 degrees", r->outcome[m][bent][k].equator);
            exp_claims_measure(claims, name, "charts straight", r->outcome[m][0][k].charts);
            exp_claims_measure(claims, name, "charts bent by 270 degrees", r->outcome[m][bent][k].charts);
        }
    }
}

static sl_status show_all(exp_run *run, exp_page *page, exp_claims *claims)
{
    sl_status status = SL_OK;
    results r = {.angles = run->quick ? 4 : MOST_ANGLES};
    for (int m = 0; m < MODELS; m++) {
        SL_TRY(exp_row(run, models[m].name, bend_model_all(run, page, m, &r)));
    }
    exp_page_html(page, "<div class=\"plot\">\n");
    exp_page_figure(page, "", "bending.svg", "charts and equator over the angle",
                    "Above: how much of the surface the first cut divides into front and back (1 = the equator). "
                    "Below: charts until all are valid.");
    exp_page_html(page, "</div>\n");
    table(page, &r);
    measure_claims(claims, &r, run);
    SL_TRY(write_csv(run, &r));
cleanup:
    return status;
}

int main(int argc, char **argv)
{
    return exp_main(
        argc, argv, "bending", "Straight and curved shapes",
        "The paper (Sec. 3.2): the shortest principal axis \"corresponds to the 'equator'. Unfortunately, this only "
        "works "
        "for straight objects. Methods based on fitting planes [...] suffer from the same limitation [...] we need a "
        "definition of the 'equator' that also works for curved geometry.\" Three straight models are rolled up, from "
        "0 "
        "to 330 degrees; front and back of the straight model tell where the equator is. Cuts as the paper prints "
        "them: "
        "nothing is smoothed, joined or sewn.",
        EXPECTED_CSV, show_all);
}
