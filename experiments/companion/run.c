/* The companion comparison: all models by all methods at all settings, and other tools' atlases. */
#include "companion.h"
#include "support/failures.h"
#include "support/main.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* What --quick runs: some of every kind, small ones. */
static const char *const quick_set[] = {"box", "tube", "sphere", "mug", "bracket"};

static bool wanted(const exp_run *run, const exp_source *source)
{
    bool listed = !run->quick;
    for (size_t k = 0; k < SL_COUNTOF(quick_set); k++) {
        listed = listed || (source->generated && strcmp(quick_set[k], source->name) == 0);
    }
    for (int32_t k = 0; k < run->added; k++) {
        listed = listed || named_after(run->add[k].path, source->name);
    }
    return listed;
}

/* One model by all ways; one that fails is a row that says so. */
static sl_status run_ways(exp_run *run, exp_claims *claims, const exp_mesh *mesh, model *m)
{
    for (int way = 0; way < EXP_WAYS; way++) {
        char name[96];
        sl_status status = exp_unwrap_way(run, &mesh->polygons, mesh->generated, way, &m->way[way], NULL);
        snprintf(name, sizeof name, "%s by %s (%s)", m->source.name, exp_way_method(way), exp_way_setting(way));
        const bool failed = exp_failed(run, name, &status);
        if (status != SL_OK) {
            return status;
        }
        exp_claims_measure(claims, m->source.name, "failed", failed);
        if (!failed) {
            exp_claims_measure(claims, m->source.name, "own check failed", m->way[way].bad);
            exp_claims_measure(claims, m->source.name, "flipped triangles", m->way[way].flipped);
            exp_claims_measure(claims, m->source.name, "overlap", m->way[way].overlap);
        }
    }
    fprintf(stderr, "%s: charts", m->source.name);
    for (int way = 0; way < EXP_WAYS; way++) {
        fprintf(stderr, "%s %.0f", way % EXP_METHODS == 0 ? " |" : "", m->way[way].metric[EXP_CHARTS]);
    }
    fputc('\n', stderr);
    return SL_OK;
}

/* A mesh that cannot be loaded at all is a failure and no row. */
static sl_status run_model(exp_run *run, exp_claims *claims, const exp_source *source, companion *all)
{
    model *m = &all->model[all->count];
    exp_mesh mesh;
    sl_status status = exp_mesh_load(source, &mesh, &run->diag);
    if (!exp_failed(run, source->name, &status) && status == SL_OK) {
        m->source = *source;
        m->facets = mesh.polygons.nf;
        m->triangles = mesh.polygons.face_first[mesh.polygons.nf] - 2 * mesh.polygons.nf;
        all->count++;
        status = run_ways(run, claims, &mesh, m);
    }
    exp_mesh_clear(&mesh);
    return status;
}

static void introduce(exp_page *page)
{
    exp_page_html(
        page,
        "<p>The paper compares segmentations by eye. Here every generated model is unwrapped by spectral cuts and by "
        "seven other ways to cut, <b>as cut</b> (the paper as printed) and by the recursion as it stands now "
        "(<b>fast</b>: <code>--preset fast</code>, cuts smoothed by a band minimum cut, loops joined, neighbours sewn "
        "while they stay valid), and by the search for fewer charts and shorter seams (<b>best</b>: <code>--preset "
        "best</code>, the default). Only the cut differs: recursion "
        "until valid, flattening and its bounds are the same for all; symmetry is not used.</p>\n<ul>\n"
        "<li><b>Fiedler</b>: always the first eigenvector that is not constant.</li>\n"
        "<li><b>PCA</b>: the plane across the shortest principal axis of the surface.</li>\n"
        "<li><b>VSA</b>: regions that fit a plane (Cohen-Steiner et al. 2004), two a cut, or first as many as bring "
        "the L<sup>2,1</sup> error down to 0.05 of the area.</li>\n"
        "<li><b>Iso-charts</b> (Zhou et al. 2004): clusters around the extremes of embedded geodesic distances, "
        "borders by graph cuts.</li>\n"
        "<li><b>GPS</b>: two means of the global point signature (Rustamov 2007; Liu and Zhang 2004).</li>\n"
        "<li><b>random</b>: the surface goes to the nearer of two random facets: a floor.</li>\n</ul>\n"
        "<p>All are measured as <code>seamlab compare</code> measures any tool's atlas: charts, seam length over the "
        "bounding box's diagonal, L<sup>2</sup> stretch, &sigma;<sub>1</sub>/&sigma;<sub>2</sub> and area ratio "
        "after one scale, texels hit twice. Turning is the mean angle between one edge of a seam and the next: "
        "jaggies are large angles. The axis of a planted mirror counts as kept where nine tenths of it are "
        "seam.</p>\n");
}

static void show_plots(exp_page *page)
{
    exp_page_html(page, "<div class=\"plot\">\n");
    exp_page_figure(page, "", "ratios.svg", "every model's charts, seams, turning and time over those of spectral cuts",
                    "Each dot is a model: its number over that of the spectral cuts at the same setting. Above the "
                    "line the spectral cuts are better. Boxes: the middle half of the models, and the median.");
    exp_page_figure(page, "", "distortion.svg", "every model's distortion over that of spectral cuts",
                    "The same for stretch, angles and areas.");
    exp_page_figure(page, "", "timings.svg", "every model's CPU time over that of spectral cuts",
                    "CPU time of the whole unwrap; differs a little from run to run.");
    exp_page_figure(
        page, "", "wins.svg", "on how many models which method is better",
        "Models on which spectral cuts are better (green), equal within a hundredth (grey), worse (orange).");
    exp_page_html(page, "</div>\n");
}

/* Ratios as claims, "turning of vsa2 (as-cut)": of each model, and their median. */
static sl_status hold_claims(const companion *all, exp_claims *claims)
{
    for (int k = 0; k < EXP_WAYS * EXP_NUMBERS; k++) {
        const int way = k / EXP_NUMBERS, metric = k % EXP_NUMBERS, base = exp_way_base(way);
        comparison c;
        char quantity[64];
        const sl_status status = compare(all, way, base, metric, &c);
        if (status != SL_OK) {
            return status;
        }
        snprintf(quantity, sizeof quantity, "%s of %s (%s)", exp_metric_name[metric], exp_way_method(way),
                 exp_way_setting(way));
        exp_claims_measure(claims, "median", quantity, exp2(c.median));
        for (int32_t i = 0; i < all->count; i++) {
            const double ratio = log_ratio(&all->model[i], way, base, metric);
            if (!isnan(ratio)) {
                exp_claims_measure(claims, all->model[i].source.name, quantity, exp2(ratio));
            }
        }
    }
    return SL_OK;
}

static sl_status show_all(exp_run *run, exp_page *page, exp_claims *claims)
{
    sl_status status = SL_OK;
    exp_source *source = sl_alloc(EXP_MAX_MESHES, sizeof *source);
    companion all = {.model = sl_calloc(EXP_MAX_MESHES, sizeof *all.model),
                     .add = sl_calloc(EXP_MAX_ADDED, sizeof *all.add)};
    if (source == NULL || all.model == NULL || all.add == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    const int32_t sources = exp_list_sources(run, source);
    for (int32_t k = 0; k < sources; k++) {
        if (wanted(run, &source[k])) {
            SL_TRY(run_model(run, claims, &source[k], &all));
        }
    }
    SL_TRY(measure_added(run, &all));
    introduce(page);
    show_plots(page);
    SL_TRY(show_summary(page, &all));
    show_losses(page, &all);
    show_added(page, &all);
    for (int setting = 0; setting < EXP_SETTINGS; setting++) {
        show_models(page, &all, setting);
    }
    SL_TRY(hold_claims(&all, claims));
    SL_TRY(write_csvs(run, &all));
cleanup:
    sl_free(source);
    sl_free(all.model);
    sl_free(all.add);
    return status;
}

int main(int argc, char **argv)
{
    return exp_main(argc, argv, "companion", "All models, all methods, all settings", NULL, EXPECTED_CSV, show_all);
}
