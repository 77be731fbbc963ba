#include "atlases.h"
#include "support/csv.h"

#include <math.h>
#include <stdio.h>

enum { MOST_TARGETS = 6, MODELS = 3, QUICK_MODELS = 2, QUICK_TARGETS = 3 };

static const char *const models[MODELS] = {"mug", "fork", "hand"};
static const double target[MOST_TARGETS] = {1.2, 1.1, 1.05, 1.02, 1.01, 1.005};
static const double quick_target[QUICK_TARGETS] = {1.1, 1.03, 1.01};

static void row(exp_page *page, const char *name, double l2, const atlas_row *r)
{
    exp_page_row_begin(page, !r->made || !r->passed || r->missed > 0);
    exp_page_cell(page, "%s", name);
    exp_page_cell(page, "%.3f", l2);
    exp_page_cell(page, "%d", r->charts);
    number_cells(page, r->seam, r->l2, r->angle, r->fill);
    exp_page_row_end(page);
}

/* Seams along the front of one model. The search is greedy: no claim that each next step down has longer ones. */
static sl_status walk(exp_run *run, exp_page *page, exp_claims *claims, const char *name, sl_writer *csv)
{
    sl_status status = SL_OK;
    exp_source source = {.generated = true};
    exp_mesh mesh = {0};
    sl_atlas *atlas = NULL;
    const int count = run->quick ? QUICK_TARGETS : MOST_TARGETS;
    double first = NAN, last = NAN;
    snprintf(source.name, sizeof source.name, "%s", name);
    SL_TRY(exp_mesh_load(&source, &mesh, &run->diag));
    for (int k = 0; k < count; k++) {
        const double l2 = run->quick ? quick_target[k] : target[k];
        atlas_row r;
        sl_atlas_def def = variant_def(NONE, NULL);
        def.optimize.target_stretch = l2;
        SL_TRY(make_atlas(run, name, &mesh, &def, &atlas, &r));
        sl_atlas_free(atlas);
        atlas = NULL;
        row(page, name, l2, &r);
        if (!r.made) {
            continue;
        }
        first = k == 0 ? r.seam : first;
        last = r.seam;
        if (r.missed + r.failed == 0) { /* one that cannot be reached is a red row */
            exp_claims_measure(claims, name, "front: L2 over its target", r.l2 / l2);
        }
        exp_claims_measure(claims, name, "front: check passed", r.passed);
        sl_writer_text(csv, name);
        exp_csv_numbers(csv, &l2, 1);
        sl_writer_format(csv, ",%d,%d", r.charts, r.missed + r.failed);
        exp_csv_numbers(csv, (const double[]){r.seam, r.l2, r.angle}, 3);
        sl_writer_text(csv, "\n");
    }
    exp_claims_measure(claims, name, "front: seams at its stretched end over those at its other end", first / last);
    fprintf(stderr, "front of %s: seams %.2f to %.2f\n", name, first, last);
cleanup:
    sl_atlas_free(atlas);
    exp_mesh_clear(&mesh);
    return status;
}

sl_status show_front(exp_run *run, exp_page *page, exp_claims *claims)
{
    sl_status status = SL_OK;
    sl_writer *csv = NULL;
    SL_TRY(exp_csv_open(run, "front.csv", "mesh,target,charts,missed,seam,l2,angle", &csv));
    exp_page_html(page,
                  "<h3>What can be had for what</h3>\n<p>Fewer and shorter seams cost stretch. The search run for "
                  "several targets of L2 (mean &sigma;<sub>1</sub>/&sigma;<sub>2</sub> at most 1.2, nothing "
                  "protected), as <code>seamlab front</code> does for any mesh.</p>\n<div class=\"plot\">\n");
    exp_page_figure(page, "", "front.svg", "seam length against stretch", "Points are labelled with charts.");
    exp_page_html(page, "</div>\n");
    exp_page_table_begin(page, "model|target L2|charts|seams|L2|&sigma;<sub>1</sub>/&sigma;<sub>2</sub>|fill");
    for (int m = 0; m < (run->quick ? QUICK_MODELS : MODELS); m++) {
        SL_TRY(walk(run, page, claims, models[m], csv));
    }
    exp_page_table_end(page);
    SL_TRY(exp_csv_close(run, &csv));
cleanup:
    sl_writer_abandon(csv);
    return status;
}
