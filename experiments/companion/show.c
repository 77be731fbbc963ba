#include "companion.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static void name_way(exp_page *page, int way)
{
    exp_page_cell(page, "%s, %s", way == EXP_BEST ? "best" : exp_method_title[way % EXP_METHODS],
                  way == EXP_BEST          ? "by search"
                  : way / EXP_METHODS == 0 ? "as cut"
                                           : "fast");
}

/* A row of the medians, or of how many models a way is better and worse on. */
static sl_status summary_row(exp_page *page, const companion *all, int way, int base, bool wins)
{
    sl_status status = SL_OK;
    comparison c[EXP_METRICS];
    int32_t kept, axes;
    for (int metric = 0; metric < EXP_METRICS; metric++) {
        SL_TRY(compare(all, way, base, metric, &c[metric]));
    }
    exp_page_row_begin(page, false);
    name_way(page, way);
    for (int metric = 0; metric < EXP_NUMBERS; metric++) {
        if (wins) {
            exp_page_cell(page, "%d / %d", c[metric].better, c[metric].worse);
        } else {
            exp_page_cell(page, "&times; %.2f", exp2(c[metric].median));
        }
    }
    if (wins) {
        count_axes(all, way, &kept, &axes);
        exp_page_cell(page, "%d of %d", kept, axes);
    }
    exp_page_row_end(page);
cleanup:
    return status;
}

/* Medians, or wins. paper: the recursion and the search over the paper's method; else each over its own setting's. */
static sl_status summary(exp_page *page, const companion *all, bool wins, bool paper)
{
    sl_status status = SL_OK;
    exp_page_table_begin(page, wins ? "method|fewer charts|shorter seam|less stretch|less angle|less area|"
                                      "straighter|axis kept"
                                    : "method|charts|seam|L2|angle|area|turning");
    for (int way = 0; way < EXP_WAYS && status == SL_OK; way++) {
        if (!paper) {
            status = summary_row(page, all, way, exp_way_base(way), wins);
        } else if (way == EXP_FAST * EXP_METHODS + EXP_SPECTRAL || way == EXP_BEST) {
            status = summary_row(page, all, way, EXP_SPECTRAL, wins);
        }
    }
    exp_page_table_end(page);
    return status;
}

sl_status show_summary(exp_page *page, const companion *all)
{
    sl_status status = SL_OK;
    exp_page_html(page,
                  "<p>Medians over %d models of each number over that of the spectral cuts at the same setting "
                  "(the search: over those of <code>--preset fast</code>); then on how many models the method is "
                  "better / worse.</p>\n",
                  all->count);
    SL_TRY(summary(page, all, false, false));
    SL_TRY(summary(page, all, true, false));
    exp_page_html(page, "<p>What was added to the paper's method, over the paper's method as printed:</p>\n");
    SL_TRY(summary(page, all, false, true));
    SL_TRY(summary(page, all, true, true));
cleanup:
    return status;
}

void show_losses(exp_page *page, const companion *all)
{
    int32_t lost = 0;
    for (int32_t k = 0; k < all->count; k++) {
        lost += paper_loses_to(&all->model[k]) >= 0;
    }
    exp_page_html(page,
                  "<h3>Where the paper's method loses</h3>\n<p>On %d of %d models another cut, everything else as the "
                  "paper prints it, needs fewer charts and no longer seams.</p>\n",
                  lost, all->count);
    if (lost == 0) {
        return;
    }
    exp_page_table_begin(page, "mesh|facets|spectral: charts|seam|L2|loses to|charts|seam|L2");
    for (int32_t k = 0; k < all->count; k++) {
        const model *m = &all->model[k];
        const int way = paper_loses_to(m);
        if (way < 0) {
            continue;
        }
        exp_page_row_begin(page, false);
        exp_page_cell(page, "%s", m->source.name);
        exp_page_cell(page, "%d", m->facets);
        for (int side = 0; side < 2; side++) {
            const double *metric = m->way[side == 0 ? EXP_SPECTRAL : way].metric;
            if (side == 1) {
                exp_page_cell(page, "%s", exp_method_title[way]);
            }
            exp_page_cell(page, "%.0f", metric[EXP_CHARTS]);
            exp_page_cell(page, "%.2f", metric[EXP_SEAM]);
            exp_page_cell(page, "%.3f", metric[EXP_STRETCH]);
        }
        exp_page_row_end(page);
    }
    exp_page_table_end(page);
}

static void number_cells(exp_page *page, const exp_numbers *o)
{
    static const char *const format[EXP_NUMBERS] = {"%.0f", "%.2f", "%.3f", "%.3f", "%.3f", "%.1f"};
    for (int metric = 0; metric < EXP_NUMBERS; metric++) {
        if (o->failed) {
            exp_page_cell(page, "failed");
        } else {
            exp_page_cell(page, format[metric], o->metric[metric]);
        }
    }
    if (o->failed) {
        exp_page_html(page, "<td></td><td></td><td></td><td></td>");
        return;
    }
    exp_page_cell(page, "%d", o->flipped);
    exp_page_cell(page, "%.2f %%", 100.0 * o->overlap);
    exp_page_cell(page, "%.2f", o->fill);
    if (o->axis >= 0.0) {
        exp_page_cell(page, "%.0f %%", 100.0 * o->axis);
    } else {
        exp_page_cell(page, "-");
    }
}

static void added_row(exp_page *page, const char *mesh, const char *who, const exp_numbers *o)
{
    exp_page_row_begin(page, o->failed);
    exp_page_cell(page, "%s", mesh);
    exp_page_cell(page, "%s", who);
    number_cells(page, o);
    exp_page_row_end(page);
}

void show_added(exp_page *page, const companion *all)
{
    static const int ours[] = {EXP_SPECTRAL, EXP_FAST * EXP_METHODS + EXP_SPECTRAL, EXP_BEST};
    static const char *const ours_title[] = {"spectral, as cut", "spectral, fast", "best"};
    if (all->added == 0) {
        return;
    }
    exp_page_html(page, "<h3>Atlases of other tools</h3>\n<p>Added by <code>--add NAME=FILE</code>, measured by the "
                        "same rules, beside this program's where the file's name and facets tell which mesh it "
                        "is. Packing was not tried hard here.</p>\n");
    exp_page_table_begin(page, "mesh|by|charts|seam|L2|angle|area|turning|flipped|overlap|fill|axis kept");
    for (int32_t k = 0; k < all->added; k++) {
        const added *a = &all->add[k];
        bool shown = false;
        for (int32_t i = 0; i < k; i++) {
            shown |= a->model >= 0 && all->add[i].model == a->model;
        }
        for (size_t i = 0; a->model >= 0 && !shown && i < SL_COUNTOF(ours); i++) {
            added_row(page, a->mesh, ours_title[i], &all->model[a->model].way[ours[i]]);
        }
        added_row(page, a->mesh, a->from->name, &a->numbers);
    }
    exp_page_table_end(page);
}

/* One number of every model by every method. */
static void show_metric(exp_page *page, const companion *all, int setting, int metric)
{
    static const char *const format[EXP_METRICS] = {"%.0f", "%.2f", "%.3f", "%.3f", "%.3f", "%.1f", "%.2f"};
    char header[256] = "mesh|facets";
    const int ways =
        setting == EXP_FAST ? EXP_METHODS + 1 : EXP_METHODS; /* the search stands beside what it starts from */
    for (int k = 0; k < ways; k++) {
        const size_t used = strlen(header);
        snprintf(header + used, sizeof header - used, "|%s", k == EXP_METHODS ? "best" : exp_method_short[k]);
    }
    exp_page_html(page, "<details><summary>%s of every model, %s</summary>\n", exp_metric_title[metric],
                  setting == EXP_AS_CUT ? "as cut" : "preset fast");
    exp_page_table_begin(page, header);
    for (int32_t i = 0; i < all->count; i++) {
        const exp_numbers *o = &all->model[i].way[setting * EXP_METHODS]; /* best follows the methods of fast */
        bool bad = false;
        for (int k = 0; k < ways; k++) {
            bad |= o[k].failed || o[k].bad;
        }
        exp_page_row_begin(page, bad);
        exp_page_cell(page, "%s", all->model[i].source.name);
        exp_page_cell(page, "%d", all->model[i].facets);
        for (int k = 0; k < ways; k++) {
            if (o[k].failed) {
                exp_page_cell(page, "failed");
            } else {
                exp_page_cell(page, format[metric], o[k].metric[metric]);
            }
        }
        exp_page_row_end(page);
    }
    exp_page_table_end(page);
    exp_page_html(page, "</details>\n");
}

void show_models(exp_page *page, const companion *all, int setting)
{
    for (int metric = 0; metric < EXP_NUMBERS; metric++) { /* times differ from run to run: they stand in timings.csv */
        show_metric(page, all, setting, metric);
    }
}
