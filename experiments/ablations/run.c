/* What each part of the segmentation is worth: one setting changed at a time. */
#include "support/csv.h"
#include "support/failures.h"
#include "support/main.h"
#include "support/turning.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CHARTS, SEAM, STRETCH, JAGGED, SECONDS, METRICS, MOST_FACETS = 8000 };

/* What --quick runs. */
static const char *const quick_set[] = {"bracket", "mug", "fork"};

typedef struct change {
    const char *name, *what;
    sl_segment_def def;
} change;

enum {
    BASE,
    VECTORS_2,
    VECTORS_5,
    VECTORS_10,
    VECTORS_20,
    VECTORS_50,
    VECTORS_100,
    RULE_LONGEST,
    RULE_LAMBDA,
    NO_FILTER_LONGEST,
    PAIRS_OFF,
    PAIRS_ON,
    SMOOTH_0,
    SMOOTH_4,
    NO_SEWING,
    UNWEIGHTED,
    NO_MINIMISING,
    CHANGES
};

static void make_changes(change c[CHANGES])
{
    static const char *const text[CHANGES][2] = {
        {"base", "preset fast, symmetry off"},
        {"vectors-2", "2 eigenvectors (Fiedler alone)"},
        {"vectors-5", "5 eigenvectors"},
        {"vectors-10", "10 eigenvectors"},
        {"vectors-20", "20 eigenvectors"},
        {"vectors-50", "50 eigenvectors"},
        {"vectors-100", "100 eigenvectors"},
        {"rule-longest", "longest seam (paper) for lookahead"},
        {"rule-length-lambda", "longest over sqrt(lambda)"},
        {"no-filter-longest", "filter off; longest seam"},
        {"pairs-off", "no quad pairing"},
        {"pairs-on", "quad pairing everywhere"},
        {"smooth-0", "cuts not smoothed"},
        {"smooth-4", "cuts smoothed in 4 rings"},
        {"no-sewing", "nothing sewn after the cuts"},
        {"unweighted", "ABF++ energy unweighted (paper: Eq. 1)"},
        {"no-minimising", "no stretch minimisation"},
    };
    static const int32_t vectors[] = {2, 5, 10, 20, 50, 100};
    for (int k = 0; k < CHANGES; k++) {
        c[k] = (change){text[k][0], text[k][1], sl_segment_default()};
        c[k].def.symmetry = SL_SYMMETRY_USE_OFF;
    }
    for (int k = VECTORS_2; k <= VECTORS_100; k++) {
        c[k].def.vectors = vectors[k - VECTORS_2];
    }
    c[RULE_LONGEST].def.rule = c[NO_FILTER_LONGEST].def.rule = SL_RULE_LONGEST;
    c[RULE_LAMBDA].def.rule = SL_RULE_LENGTH_LAMBDA;
    c[NO_FILTER_LONGEST].def.filter = false;
    c[PAIRS_OFF].def.pairing = SL_PAIR_OFF;
    c[PAIRS_ON].def.pairing = SL_PAIR_ON;
    c[SMOOTH_0].def.smooth = 0;
    c[SMOOTH_4].def.smooth = 4;
    c[NO_SEWING].def.sew = false;
    c[UNWEIGHTED].def.flatten.abf.energy = SL_ABF_UNWEIGHTED;
    c[NO_MINIMISING].def.flatten.minimise_stretch = false;
}

typedef struct model {
    char name[64];
    int32_t facets;
    double metric[CHANGES][METRICS];
    bool failed[CHANGES];
} model;

static void measure(const sl_mesh *mesh, const sl_segmentation *seg, double metric[METRICS])
{
    double area = 0.0, square = 0.0;
    for (int32_t c = 0; c < seg->nchart; c++) {
        const sl_flatten_result *flat = &seg->chart[c].flat;
        if (flat->distortion.measured > 0 && isfinite(flat->distortion.l2)) {
            area += flat->distortion.area_3d;
            square += flat->distortion.area_3d * flat->distortion.l2 * flat->distortion.l2;
        }
    }
    metric[CHARTS] = seg->nchart;
    metric[SEAM] = sl_atlas_seam_length(mesh) / sl_mesh_diagonal(mesh);
    metric[STRETCH] = area > 0.0 ? sqrt(square / area) : 1.0;
    metric[JAGGED] = exp_seam_turning(mesh);
}

static sl_status run_change(exp_run *run, const sl_polygons *polygons, const change *c, double metric[METRICS])
{
    sl_status status = SL_OK;
    sl_mesh *mesh = NULL;
    sl_triangulation *triangulation = NULL;
    sl_segmentation *seg = NULL;
    SL_TRY(sl_mesh_build(polygons, &mesh, NULL, &run->diag));
    SL_TRY(sl_triangulation_create(mesh, &triangulation));
    const double start = exp_cpu_seconds();
    SL_TRY(sl_segment(mesh, triangulation, &c->def, &run->context, &seg));
    metric[SECONDS] = exp_cpu_seconds() - start;
    measure(mesh, seg, metric);
cleanup:
    sl_segmentation_free(seg);
    sl_triangulation_free(triangulation);
    sl_mesh_free(mesh);
    return status;
}

/* A change that fails on a model is left out of the medians and counted. */
static sl_status run_model(exp_run *run, const exp_source *source, const sl_polygons *polygons,
                           const change changes[CHANGES], model *m)
{
    snprintf(m->name, sizeof m->name, "%s", source->name);
    m->facets = polygons->nf;
    for (int k = 0; k < CHANGES; k++) {
        char name[160];
        sl_status status = run_change(run, polygons, &changes[k], m->metric[k]);
        snprintf(name, sizeof name, "%s by %s", m->name, changes[k].name);
        m->failed[k] = exp_failed(run, name, &status);
        if (status != SL_OK) {
            return status;
        }
    }
    fprintf(stderr, "%s: %.0f charts\n", m->name, m->metric[BASE][CHARTS]);
    return SL_OK;
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Median over the models of a metric over the base's; what is too small to matter counts as no difference. */
static double median_ratio(const model *m, int32_t count, int change_index, int metric)
{
    static const double least[METRICS] = {1.0, 1e-3, 1e-3, 1.0, 1e-3};
    double ratio[EXP_MAX_MESHES];
    int32_t n = 0;
    for (int32_t k = 0; k < count; k++) {
        if (!m[k].failed[change_index] && !m[k].failed[BASE]) {
            ratio[n++] =
                fmax(m[k].metric[change_index][metric], least[metric]) / fmax(m[k].metric[BASE][metric], least[metric]);
        }
    }
    qsort(ratio, (size_t)n, sizeof *ratio, ascending);
    return n > 0 ? 0.5 * (ratio[(n - 1) / 2] + ratio[n / 2]) : NAN;
}

static double mean_charts(const model *m, int32_t count, int change_index)
{
    double sum = 0.0;
    int32_t n = 0;
    for (int32_t k = 0; k < count; k++) {
        if (!m[k].failed[change_index]) {
            sum += m[k].metric[change_index][CHARTS];
            n++;
        }
    }
    return n > 0 ? sum / n : NAN;
}

static void table(exp_page *page, exp_claims *claims, const change *c, const model *m, int32_t count)
{
    exp_page_html(
        page,
        "<p>Medians over %d models of each number over that of <code>--preset fast</code>; charts in the mean.</p>\n",
        count);
    exp_page_table_begin(page, "what is changed|charts, mean|charts|seam|L2|turning|CPU|failed");
    for (int k = 0; k < CHANGES; k++) {
        int32_t failed = 0;
        for (int32_t i = 0; i < count; i++) {
            failed += m[i].failed[k];
        }
        exp_page_row_begin(page, failed > 0);
        exp_page_cell(page, "%s", c[k].what);
        exp_page_cell(page, "%.1f", mean_charts(m, count, k));
        for (int metric = 0; metric < SECONDS; metric++) {
            exp_page_cell(page, "%.2f", median_ratio(m, count, k, metric));
        }
        exp_page_time(page, "%.2f", median_ratio(m, count, k, SECONDS));
        exp_page_cell(page, "%d", failed);
        exp_page_row_end(page);
        exp_claims_measure(claims, c[k].name, "failed models", failed);
        exp_claims_measure(claims, c[k].name, "mean charts over those of the base",
                           mean_charts(m, count, k) / mean_charts(m, count, BASE));
    }
    exp_page_table_end(page);
}

static sl_status write_csv(exp_run *run, const change *c, const model *m, int32_t count)
{
    sl_status status = SL_OK;
    sl_writer *numbers = NULL, *timings = NULL;
    SL_TRY(exp_csv_open(run, "ablations.csv", "change,mesh,facets,charts,seam,l2,turning,failed", &numbers));
    SL_TRY(exp_csv_open(run, "timings.csv", "change,mesh,seconds", &timings));
    for (int k = 0; k < CHANGES; k++) {
        for (int32_t i = 0; i < count; i++) {
            sl_writer_format(numbers, "%s,%s,%d", c[k].name, m[i].name, m[i].facets);
            exp_csv_numbers(numbers, m[i].metric[k], SECONDS);
            sl_writer_format(numbers, ",%d\n", m[i].failed[k]);
            sl_writer_format(timings, "%s,%s,%.3f\n", c[k].name, m[i].name, m[i].metric[k][SECONDS]);
        }
    }
    SL_TRY(exp_csv_close(run, &numbers));
    SL_TRY(exp_csv_close(run, &timings));
cleanup:
    sl_writer_abandon(numbers);
    sl_writer_abandon(timings);
    return status;
}

/* ratios.csv: what plot.gp draws. */
static sl_status write_ratios(exp_run *run, const change *c, const model *m, int32_t count)
{
    sl_status status = SL_OK;
    sl_writer *csv = NULL;
    SL_TRY(exp_csv_open(run, "ratios.csv", "row,change,charts,seam,l2,turning", &csv));
    for (int k = 1; k < CHANGES; k++) {
        sl_writer_format(csv, "%d,%s", k, c[k].what);
        for (int metric = 0; metric < SECONDS; metric++) {
            sl_writer_format(csv, ",%.4f",
                             metric == CHARTS ? mean_charts(m, count, k) / mean_charts(m, count, BASE)
                                              : median_ratio(m, count, k, metric));
        }
        sl_writer_text(csv, "\n");
    }
    SL_TRY(exp_csv_close(run, &csv));
cleanup:
    sl_writer_abandon(csv);
    return status;
}

static bool wanted(const exp_run *run, const exp_source *source)
{
    bool listed = !run->quick;
    for (size_t k = 0; k < SL_COUNTOF(quick_set); k++) {
        listed = listed || strcmp(source->name, quick_set[k]) == 0;
    }
    return listed && source->generated;
}

static sl_status show_all(exp_run *run, exp_page *page, exp_claims *claims)
{
    sl_status status = SL_OK;
    change changes[CHANGES];
    exp_source *source = sl_alloc(EXP_MAX_MESHES, sizeof *source);
    model *m = sl_calloc(EXP_MAX_MESHES, sizeof *m);
    int32_t count = 0;
    if (source == NULL || m == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    make_changes(changes);
    const int32_t sources = exp_list_sources(run, source);
    for (int32_t k = 0; k < sources && status == SL_OK; k++) {
        exp_mesh mesh;
        if (!wanted(run, &source[k])) {
            continue;
        }
        status = exp_mesh_load(&source[k], &mesh, &run->diag);
        if (!exp_failed(run, source[k].name, &status) && status == SL_OK && mesh.polygons.nf <= MOST_FACETS) {
            status = run_model(run, &source[k], &mesh.polygons, changes, &m[count++]);
        }
        exp_mesh_clear(&mesh);
    }
    SL_TRY(status);
    exp_page_html(page, "<div class=\"plot\">\n");
    exp_page_figure(page, "", "ablations.svg", "charts and seams over those of preset fast",
                    "Over the numbers of <code>--preset fast</code>: charts (mean) and seam length (median).");
    exp_page_html(page, "</div>\n");
    table(page, claims, changes, m, count);
    SL_TRY(write_csv(run, changes, m, count));
    SL_TRY(write_ratios(run, changes, m, count));
cleanup:
    sl_free(source);
    sl_free(m);
    return status;
}

int main(int argc, char **argv)
{
    return exp_main(
        argc, argv, "ablations", "What each part is worth",
        "One setting of the segmentation changed at a time, all else as <code>--preset fast</code> has it (without "
        "symmetry), on "
        "the generated models of at most 8000 facets. The paper computes 30 eigenvectors, drops those whose "
        "nodal domains are not connected, and takes the longest seam.",
        EXPECTED_CSV, show_all);
}
