/* The forms of ABF++ compared on charts of generated models, by a list of seeds. */
#include "generators.h"
#include "support/failures.h"
#include "support/main.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MOST_CHARTS = 6, LEAST_TRIANGLES = 30, FORMS = 7, QUICK_SEEDS = 6 };

/* What is compared, and what came of it. */
typedef struct form {
    const char *name, *what;
    sl_abf_energy energy;
    sl_abf_wheel wheel;
    sl_abf_newton newton;
    int32_t charts, converged, stalled, flipped, thin, fallbacks;
    int64_t iterations, most;
    double cpu, distortion;
} form;

static const double thinnest = 1e-3 / 57.29577951308232; /* an angle below a thousandth of a degree is no solution */

static sl_status try_form(exp_run *run, const sl_patch *patch, form *f)
{
    sl_status status = SL_OK;
    sl_abf_def def = sl_abf_default();
    sl_abf_info info;
    sl_distortion distortion;
    double *uv = sl_alloc(2 * (int64_t)patch->nv, sizeof *uv);
    SL_TRY(uv != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    def.energy = f->energy;
    def.wheel = f->wheel;
    def.newton = f->newton;
    const double before = exp_cpu_seconds();
    SL_TRY(sl_abf_flatten(patch, &def, &run->context, uv, &info));
    f->cpu += exp_cpu_seconds() - before;
    f->charts++;
    f->stalled += info.stalled;
    f->fallbacks += info.fallbacks > 0;
    if (info.converged) {
        SL_TRY(sl_distortion_measure_indexed(patch->nt, patch->tri, patch->xyz, uv, &distortion));
        f->converged++;
        f->iterations += info.iterations;
        f->most = info.iterations > f->most ? info.iterations : f->most;
        f->flipped += distortion.flipped > 0;
        f->thin += info.min_angle < thinnest;
        f->distortion += distortion.angle_mean;
    }
cleanup:
    sl_free(uv);
    return status == SL_SINGULAR ? SL_OK : status;
}

/* The disks that a few spectral cuts of the model leave, whatever their stretch. */
static sl_status try_model(exp_run *run, const char *model, int32_t seed, form *forms)
{
    sl_status status = SL_OK;
    sl_generated *made = NULL;
    sl_mesh *mesh = NULL;
    sl_triangulation *triangulation = NULL;
    sl_segmentation *seg = NULL;
    sl_patch *patch = NULL;
    sl_polygons polygons;
    sl_segment_def def = sl_segment_default();
    def.symmetry = SL_SYMMETRY_USE_OFF;
    def.sew = false;
    def.max_charts = MOST_CHARTS;
    def.flatten.minimise_stretch = false;
    def.flatten.tutte = false;
    const sl_generator *generator = sl_generator_find(model);
    SL_TRY(generator != NULL ? SL_OK : SL_BAD_INPUT);
    SL_TRY(generator->make((uint64_t)seed, 1, &made));
    sl_generated_polygons(made, &polygons);
    SL_TRY(sl_mesh_build(&polygons, &mesh, NULL, &run->diag));
    SL_TRY(sl_triangulation_create(mesh, &triangulation));
    SL_TRY(sl_segment(mesh, triangulation, &def, &run->context, &seg));
    for (int32_t c = 0; c < seg->nchart; c++) {
        SL_TRY(sl_patch_extract(mesh, triangulation, &seg->face[seg->chart[c].first], seg->chart[c].count, &patch));
        for (int k = 0; k < FORMS && patch->nt >= LEAST_TRIANGLES && sl_patch_is_disk(patch); k++) {
            SL_TRY(try_form(run, patch, &forms[k]));
        }
        sl_patch_free(patch);
        patch = NULL;
    }
cleanup:
    sl_patch_free(patch);
    sl_segmentation_free(seg);
    sl_triangulation_free(triangulation);
    sl_mesh_free(mesh);
    sl_generated_free(made);
    return status;
}

static sl_status try_list(exp_run *run, form *forms)
{
    char *data = NULL, model[64];
    int64_t size = 0;
    int32_t seed, lines = 0;
    sl_status status = SL_OK;
    SL_TRY(sl_file_read(SEEDS_CSV, &data, &size, &run->diag));
    for (char *line = data; line != NULL && *line != '\0' && !(run->quick && lines >= QUICK_SEEDS);) {
        char *end = strchr(line, '\n');
        if (line[0] != '#' && sscanf(line, "%63[^,],%d", model, &seed) == 2) {
            SL_TRY(exp_row(run, model, try_model(run, model, seed, forms)));
            lines++;
        }
        line = end != NULL ? end + 1 : NULL;
    }
cleanup:
    sl_free(data);
    return status;
}

static void show(exp_page *page, exp_claims *claims, const form *forms)
{
    exp_page_table_begin(page,
                         "g3|energy|curvature|charts|converged|mean iterations|most|stalled|flipped though "
                         "converged|an angle below 0.001&deg;|curvature dropped somewhere|mean &sigma;1/&sigma;2|CPU "
                         "[s]");
    for (int k = 0; k < FORMS; k++) {
        const form *f = &forms[k];
        const double n = f->converged > 0 ? f->converged : 1;
        exp_page_row_begin(page, false);
        exp_page_cell(page, "%s", f->what);
        exp_page_cell(page, f->energy == SL_ABF_WEIGHTED ? "1/&phi;&sup2;" : "1 (paper)");
        exp_page_cell(page, f->newton == SL_ABF_DROPPED ? "dropped" : "exact");
        exp_page_cell(page, "%d", f->charts);
        exp_page_cell(page, "%d", f->converged);
        exp_page_cell(page, "%.1f", (double)f->iterations / n);
        exp_page_cell(page, "%lld", (long long)f->most);
        exp_page_cell(page, "%d", f->stalled);
        exp_page_cell(page, "%d", f->flipped);
        exp_page_cell(page, "%d", f->thin);
        exp_page_cell(page, "%d", f->fallbacks);
        exp_page_cell(page, "%.3f", f->distortion / n);
        exp_page_time(page, "%.2f", f->cpu);
        exp_page_row_end(page);
        exp_claims_measure(claims, f->name, "charts", f->charts);
        exp_claims_measure(claims, f->name, "share converged", (double)f->converged / (f->charts > 0 ? f->charts : 1));
        exp_claims_measure(claims, f->name, "flipped though converged", f->flipped);
        exp_claims_measure(claims, f->name, "iterations", (double)f->iterations / n);
        fprintf(stderr, "%-16s converged %d of %d, mean %.1f, most %lld, stalled %d, flipped %d, thin %d\n", f->name,
                f->converged, f->charts, (double)f->iterations / n, (long long)f->most, f->stalled, f->flipped,
                f->thin);
    }
    exp_page_table_end(page);
}

static sl_status show_all(exp_run *run, exp_page *page, exp_claims *claims)
{
    form forms[FORMS] = {
        {.name = "log", .what = "log (default)"},
        {.name = "product", .what = "product (ABF++)", .wheel = SL_ABF_PRODUCT},
        {.name = "ratio", .what = "ratio (paper)", .wheel = SL_ABF_RATIO},
        {.name = "log-plain", .what = "log", .energy = SL_ABF_UNWEIGHTED},
        {.name = "product-plain", .what = "product", .wheel = SL_ABF_PRODUCT, .energy = SL_ABF_UNWEIGHTED},
        {.name = "ratio-plain", .what = "ratio (paper)", .wheel = SL_ABF_RATIO, .energy = SL_ABF_UNWEIGHTED},
        {.name = "log-exact", .what = "log", .newton = SL_ABF_EXACT},
    };
    const sl_status status = try_list(run, forms);
    if (status == SL_OK) {
        show(page, claims, forms);
    }
    return status;
}

int main(int argc, char **argv)
{
    return exp_main(argc, argv, "abf-forms", "Forms of ABF++ compared",
                    "Every disk that five spectral cuts leave of each model in <code>seeds.csv</code> (model and "
                    "seed), flattened by each form from the same start, at most 40 iterations, |&nabla;L| &le; "
                    "1e-6 asked for.",
                    EXPECTED_CSV, show_all);
}
