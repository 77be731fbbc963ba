/* Time and memory against size, and where the time goes. */
#include "generators.h"
#include "support/csv.h"
#include "support/failures.h"
#include "support/main.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

enum { SPECTRUM, SYMMETRY, FLATTENING, SEWING, PACKING, REST, STAGES, MOST_SIZES = 12 };

/* What the library calls its steps, and where they are counted. */
static const struct {
    const char *name;
    int stage;
} steps[] = {
    {"ordering", SPECTRUM},
    {"patches", SPECTRUM},
    {"separators", SPECTRUM},
    {"factor", SPECTRUM},
    {"eigenvectors", SPECTRUM},
    {"certificate", SPECTRUM},
    {"symmetry", SYMMETRY},
    {"copies", SYMMETRY},
    {"near symmetry", SYMMETRY},
    {"abf", FLATTENING},
    {"flatten", FLATTENING},
    {"layout", FLATTENING},
    {"relax", FLATTENING},
    {"embedding by Tutte", FLATTENING},
    {"minimising stretch", FLATTENING},
    {"sew", SEWING},
    {"optimise", SEWING},
    {"packing", PACKING},
};

static const char *const models[] = {"hand", "body", "tree"};

/* Time since the last report belongs to the step reported last: the library runs on one thread here. */
typedef struct stopwatch {
    double spent[STAGES], last;
    int stage;
} stopwatch;

static bool on_step(void *user, const char *stage, double fraction)
{
    stopwatch *watch = user;
    const double now = exp_cpu_seconds();
    (void)fraction;
    watch->spent[watch->stage] += now - watch->last;
    watch->last = now;
    watch->stage = REST;
    for (size_t k = 0; k < SL_COUNTOF(steps); k++) {
        if (strcmp(steps[k].name, stage) == 0) {
            watch->stage = steps[k].stage;
        }
    }
    return true;
}

typedef struct row {
    const char *model;
    int32_t facets, charts;
    double seconds, megabytes, spent[STAGES];
} row;

static double peak_megabytes(void)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return (double)usage.ru_maxrss / 1024.0;
}

static sl_status time_one(exp_run *run, const sl_generator *generator, int32_t scale, row *r)
{
    sl_status status = SL_OK;
    sl_generated *mesh = NULL;
    sl_atlas *atlas = NULL;
    sl_polygons polygons;
    stopwatch watch = {.stage = REST};
    const sl_context context = {.progress = on_step, .progress_user = &watch};
    const sl_atlas_def def = sl_atlas_default();
    SL_TRY(generator->make(1, scale, &mesh));
    sl_generated_polygons(mesh, &polygons);
    const double start = exp_cpu_seconds();
    watch.last = start;
    SL_TRY(sl_unwrap(&polygons, &def, &context, &atlas, &run->diag));
    on_step(&watch, "", 1.0);
    *r = (row){generator->name,           polygons.nf,      atlas->segmentation->nchart,
               exp_cpu_seconds() - start, peak_megabytes(), {0}};
    memcpy(r->spent, watch.spent, sizeof r->spent);
    fprintf(stderr, "%s, %d facets: %.1f s, %d chart%s\n", r->model, r->facets, r->seconds, r->charts,
            sl_plural(r->charts));
cleanup:
    sl_atlas_free(atlas);
    sl_generated_free(mesh);
    return status;
}

/* Facets of a model at a scale: each is about four times the one before. */
static sl_status facets_of(const sl_generator *generator, int32_t scale, int32_t *facets)
{
    sl_generated *mesh = NULL;
    const sl_status status = generator->make(1, scale, &mesh);
    if (status == SL_OK) {
        *facets = mesh->nf;
    }
    sl_generated_free(mesh);
    return status;
}

static void table(exp_page *page, const row *r, int32_t count)
{
    exp_page_table_begin(page, "model|facets|CPU [s]|peak memory [MB]|charts|eigenvectors|symmetry|flattening|sewing|"
                               "packing|rest");
    for (int32_t k = 0; k < count; k++) {
        exp_page_row_begin(page, false);
        exp_page_cell(page, "%s", r[k].model);
        exp_page_cell(page, "%d", r[k].facets);
        exp_page_time(page, "%.2f", r[k].seconds);
        exp_page_time(page, "%.0f", r[k].megabytes);
        exp_page_cell(page, "%d", r[k].charts);
        for (int s = 0; s < STAGES; s++) {
            exp_page_time(page, "%.0f %%", 100.0 * r[k].spent[s] / fmax(r[k].seconds, 1e-9));
        }
        exp_page_row_end(page);
    }
    exp_page_table_end(page);
}

static sl_status write_csv(exp_run *run, const row *r, int32_t count)
{
    sl_status status = SL_OK;
    sl_writer *csv = NULL;
    SL_TRY(exp_csv_open(run, "timings.csv",
                        "model,facets,charts,seconds,megabytes,eigenvectors,symmetry,flattening,sewing,packing,rest",
                        &csv));
    for (int32_t k = 0; k < count; k++) {
        sl_writer_format(csv, "%s,%d,%d,%.3f,%.0f", r[k].model, r[k].facets, r[k].charts, r[k].seconds, r[k].megabytes);
        for (int s = 0; s < STAGES; s++) {
            sl_writer_format(csv, ",%.3f", r[k].spent[s]);
        }
        sl_writer_text(csv, "\n");
    }
    SL_TRY(exp_csv_close(run, &csv));
cleanup:
    sl_writer_abandon(csv);
    return status;
}

/* Where each stage begins and ends among all the time of a model. */
static sl_status write_shares(exp_run *run, const row *r, int32_t count)
{
    sl_status status = SL_OK;
    sl_writer *csv = NULL;
    SL_TRY(exp_csv_open(run, "timing-shares.csv", "model,low and high of each stage", &csv));
    for (size_t m = 0; m < SL_COUNTOF(models); m++) {
        double spent[STAGES] = {0}, all = 1e-9, done = 0.0;
        for (int32_t k = 0; k < count; k++) {
            for (int s = 0; s < STAGES && strcmp(r[k].model, models[m]) == 0; s++) {
                spent[s] += r[k].spent[s];
                all += r[k].spent[s];
            }
        }
        sl_writer_format(csv, "%zu", m);
        for (int s = 0; s < STAGES; s++) {
            sl_writer_format(csv, ",%.4f,%.4f", done / all, (done + spent[s]) / all);
            done += spent[s];
        }
        sl_writer_text(csv, "\n");
    }
    SL_TRY(exp_csv_close(run, &csv));
cleanup:
    sl_writer_abandon(csv);
    return status;
}

static int by_model(const void *a, const void *b)
{
    const row *p = a, *q = b;
    const int order = strcmp(p->model, q->model);
    return order != 0 ? order : (p->facets > q->facets) - (p->facets < q->facets);
}

/* Sizes in ascending order over all models, so that the peak of the process is that of the run that just ended. */
static sl_status time_all(exp_run *run, row *r, int32_t *count)
{
    const int32_t most = run->quick ? 30000 : 1600000;
    bool larger[SL_COUNTOF(models)] = {false};
    for (int32_t scale = 1; scale <= MOST_SIZES; scale++) {
        for (size_t m = 0; m < SL_COUNTOF(models); m++) {
            if (larger[m]) {
                continue;
            }
            const sl_generator *generator = sl_generator_find(models[m]);
            int32_t facets = 0;
            sl_status status = generator != NULL ? facets_of(generator, scale, &facets) : SL_BAD_INPUT;
            larger[m] = facets > most;
            if (status == SL_OK && !larger[m]) {
                status = time_one(run, generator, scale, &r[*count]);
                *count += status == SL_OK;
            }
            larger[m] = exp_failed(run, models[m], &status) || larger[m];
            if (status != SL_OK) {
                return status;
            }
        }
    }
    return SL_OK;
}

static sl_status show_all(exp_run *run, exp_page *page, exp_claims *claims)
{
    sl_status status = SL_OK;
    row *r = sl_calloc(MOST_SIZES * (int64_t)SL_COUNTOF(models), sizeof *r);
    int32_t count = 0;
    if (r == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    SL_TRY(time_all(run, r, &count));
    qsort(r, (size_t)count, sizeof *r, by_model);
    for (int32_t k = 0; k < count; k++) {
        exp_claims_measure(claims, r[k].model, r[k].facets <= 100000 ? "seconds up to 100000 facets" : "seconds beyond",
                           r[k].seconds);
        exp_claims_measure(claims, r[k].model, "microseconds a facet", 1e6 * r[k].seconds / r[k].facets);
    }
    exp_page_html(page, "<div class=\"plot\">\n");
    exp_page_figure(
        page, "", "timing.svg", "CPU time and memory over facets, and the share of each stage",
        "Left: CPU seconds on one thread, and the line of the paper's 4 min 30. Middle: peak memory. "
        "Right: shares of the stages, all sizes of a model together; the rest is what lies between two reports "
        "of progress that name none of them: building the mesh, tracing and smoothing cuts, checking.");
    exp_page_html(page, "</div>\n");
    table(page, r, count);
    SL_TRY(write_csv(run, r, count));
    SL_TRY(write_shares(run, r, count));
cleanup:
    sl_free(r);
    return status;
}

int main(int argc, char **argv)
{
    return exp_main(
        argc, argv, "timing", "Time and memory",
        "The paper: \"our method never took more than 4 min. 30 to segment a model (Pentium M, 2 GHz)\", of "
        "sizes that it does not give. Here whole unwraps by <code>--preset fast</code>, on one thread: cuts, "
        "flattening, "
        "packing, proof. Memory is the peak of the process. Times differ from run to run.",
        EXPECTED_CSV, show_all);
}
