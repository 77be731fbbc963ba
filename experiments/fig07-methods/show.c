#include "methods.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static sl_status open_csv(exp_run *run, const char *name, const char *header, sl_writer **writer)
{
    char path[EXP_PATH];
    sl_status status = exp_path(run, name, path);
    if (status == SL_OK) {
        status = sl_writer_create(path, writer, &run->diag);
    }
    if (status == SL_OK) {
        sl_writer_text(*writer, header);
    }
    return status;
}

/* Ratios of all metrics but time, or of time alone: that file differs from run to run. */
static sl_status write_ratios(exp_run *run, const model *models, int32_t count, bool times)
{
    sl_writer *w = NULL;
    const sl_status status =
        open_csv(run, times ? "timings.csv" : "ratios.csv", "setting,metric,method,mesh,log2_ratio,value\n", &w);
    if (status != SL_OK) {
        return status;
    }
    for (int setting = 0; setting < SETTINGS; setting++) {
        for (int metric = times ? SECONDS : 0; metric < (times ? METRICS : SECONDS); metric++) {
            for (int method = 0; method < METHODS; method++) {
                for (int32_t k = 0; k < count; k++) {
                    sl_writer_format(w, "%s,%s,%d,%s,%.6f,%.6g\n", setting_name[setting], metric_name[metric], method,
                                     models[k].source.name, log_ratio(&models[k], setting, method, metric),
                                     models[k].outcome[setting][method].metric[metric]);
                }
            }
        }
    }
    return sl_writer_commit(w, &run->diag);
}

static sl_status write_numbers(exp_run *run, const model *models, int32_t count)
{
    sl_writer *w = NULL;
    const sl_status status =
        open_csv(run, "methods.csv",
                 "mesh,facets,setting,method,charts,seam,l2,angle,area,turning,axis,splits,invalid,failed\n", &w);
    if (status != SL_OK) {
        return status;
    }
    for (int32_t k = 0; k < count; k++) {
        for (int setting = 0; setting < SETTINGS; setting++) {
            for (int method = 0; method < METHODS; method++) {
                const outcome *o = &models[k].outcome[setting][method];
                sl_writer_format(w, "%s,%d,%s,%s,%.0f,%.6f,%.6f,%.6f,%.6f,%.4f,%.4f,%d,%d,%d\n", models[k].source.name,
                                 models[k].facets, setting_name[setting], method_name[method], o->metric[CHARTS],
                                 o->metric[SEAM], o->metric[STRETCH], o->metric[ANGLE], o->metric[AREA],
                                 o->metric[JAGGED], o->axis, o->splits, o->invalid, o->failed);
            }
        }
    }
    return sl_writer_commit(w, &run->diag);
}

/* Wins and losses; what the methods' medians are. */
static sl_status write_wins(exp_run *run, const model *models, int32_t count)
{
    sl_writer *w = NULL;
    sl_status status = open_csv(run, "wins.csv", "setting,metric,method,better,equal,worse,median_log2\n", &w);
    for (int k = 0; status == SL_OK && k < SETTINGS * SECONDS * METHODS; k++) {
        const int setting = k / (SECONDS * METHODS), metric = k / METHODS % SECONDS, method = k % METHODS;
        comparison c;
        status = compare(models, count, setting, method, metric, &c);
        if (status == SL_OK && method != SPECTRAL) {
            sl_writer_format(w, "%s,%s,%s,%d,%d,%d,%.6f\n", setting_name[setting], metric_name[metric],
                             method_name[method], c.better, c.equal, c.worse, c.median);
        }
    }
    if (status != SL_OK) {
        sl_writer_abandon(w);
        return status;
    }
    return sl_writer_commit(w, &run->diag);
}

sl_status write_csvs(exp_run *run, const model *models, int32_t count)
{
    sl_status status = SL_OK;
    SL_TRY(write_numbers(run, models, count));
    SL_TRY(write_ratios(run, models, count, false));
    SL_TRY(write_ratios(run, models, count, true));
    SL_TRY(write_wins(run, models, count));
cleanup:
    return status;
}

/* A row of the medians, or of how many models a method is better and worse on. */
static sl_status summary_row(exp_page *page, const model *models, int32_t count, int setting, int method, bool wins)
{
    sl_status status = SL_OK;
    comparison c[METRICS];
    int32_t kept, axes;
    for (int metric = 0; metric < METRICS; metric++) {
        SL_TRY(compare(models, count, setting, method, metric, &c[metric]));
    }
    exp_page_row_begin(page, false);
    exp_page_cell(page, "%s, %s", method_title[method], setting == AS_CUT ? "as cut" : "default");
    for (int metric = 0; metric < METRICS; metric++) {
        if (!wins) {
            exp_page_cell(page, "&times; %.2f", exp2(c[metric].median));
        } else if (metric != SECONDS) {
            exp_page_cell(page, "%d / %d", c[metric].better, c[metric].worse);
        }
    }
    if (wins) {
        count_axes(models, count, setting, method, &kept, &axes);
        exp_page_cell(page, "%d of %d", kept, axes);
    }
    exp_page_row_end(page);
cleanup:
    return status;
}

sl_status show_summary(exp_page *page, const model *models, int32_t count)
{
    sl_status status = SL_OK;
    for (int wins = 0; wins < 2; wins++) {
        exp_page_table_begin(page, wins ? "method|fewer charts|shorter seam|less stretch|less angle|less area|"
                                          "straighter|axis kept"
                                        : "method|charts|seam|L2|angle|area|turning|CPU time");
        for (int k = 0; k < SETTINGS * METHODS && status == SL_OK; k++) {
            status = summary_row(page, models, count, k / METHODS, k % METHODS, wins == 1);
        }
        exp_page_table_end(page);
        SL_TRY(status);
    }
cleanup:
    return status;
}

/* One number of every model by every method: ten columns. */
static void show_metric(exp_page *page, const model *models, int32_t count, int setting, int metric)
{
    static const char *const format[METRICS] = {"%.0f", "%.2f", "%.3f", "%.3f", "%.3f", "%.1f", "%.2f"};
    char header[256] = "mesh|facets";
    for (int method = 0; method < METHODS; method++) {
        const size_t used = strlen(header);
        snprintf(header + used, sizeof header - used, "|%s", method_short[method]);
    }
    exp_page_html(page, "<details><summary>%s of every model, %s</summary>\n", metric_title[metric],
                  setting == AS_CUT ? "as cut" : "default settings");
    exp_page_table_begin(page, header);
    for (int32_t k = 0; k < count; k++) {
        const outcome *o = models[k].outcome[setting];
        bool bad = false;
        for (int method = 0; method < METHODS; method++) {
            bad |= o[method].failed || o[method].invalid > 0;
        }
        exp_page_row_begin(page, bad);
        exp_page_cell(page, "%s", models[k].source.name);
        exp_page_cell(page, "%d", models[k].facets);
        for (int method = 0; method < METHODS; method++) {
            if (o[method].failed) {
                exp_page_cell(page, "failed");
            } else {
                exp_page_cell(page, format[metric], o[method].metric[metric]);
            }
        }
        exp_page_row_end(page);
    }
    exp_page_table_end(page);
    exp_page_html(page, "</details>\n");
}

void show_models(exp_page *page, const model *models, int32_t count, int setting)
{
    for (int metric = 0; metric < SECONDS; metric++) { /* times differ from run to run: they stand in timings.csv */
        show_metric(page, models, count, setting, metric);
    }
}
