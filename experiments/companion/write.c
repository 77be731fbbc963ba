#include "companion.h"
#include "support/csv.h"

/* Ratios of all metrics but time, or of time alone: that file differs from run to run. */
static sl_status write_ratios(exp_run *run, const companion *all, bool times)
{
    sl_status status = SL_OK;
    sl_writer *w = NULL;
    SL_TRY(exp_csv_open(run, times ? "timings.csv" : "ratios.csv", "setting,metric,method,mesh,log2_ratio,value", &w));
    for (int way = 0; way < EXP_WAYS; way++) {
        const int method = way == EXP_BEST ? EXP_METHODS : way % EXP_METHODS;
        for (int metric = times ? EXP_SECONDS : 0; metric < (times ? EXP_METRICS : EXP_NUMBERS); metric++) {
            for (int32_t k = 0; k < all->count; k++) {
                const model *m = &all->model[k];
                sl_writer_format(w, "%s,%s,%d,%s,%.6f,%.6g\n", exp_way_setting(way), exp_metric_name[metric], method,
                                 m->source.name, log_ratio(m, way, exp_way_base(way), metric),
                                 m->way[way].metric[metric]);
            }
        }
    }
    SL_TRY(exp_csv_close(run, &w));
cleanup:
    sl_writer_abandon(w);
    return status;
}

/* The columns of write_row. */
#define NUMBERS "charts,seam,l2,angle,area,turning,axis,overlap,fill,flipped,bad,failed"

static void write_row(sl_writer *w, const exp_numbers *o)
{
    sl_writer_format(w, "%.0f", o->metric[EXP_CHARTS]);
    exp_csv_numbers(w, o->metric + 1, EXP_NUMBERS - 1);
    exp_csv_numbers(w, (const double[]){o->axis, o->overlap, o->fill}, 3);
    sl_writer_format(w, ",%d,%d,%d\n", o->flipped, o->bad, o->failed);
}

static sl_status write_numbers(exp_run *run, const companion *all)
{
    sl_status status = SL_OK;
    sl_writer *w = NULL;
    SL_TRY(exp_csv_open(run, "methods.csv", "mesh,facets,setting,method," NUMBERS, &w));
    for (int32_t k = 0; k < all->count; k++) {
        const model *m = &all->model[k];
        for (int way = 0; way < EXP_WAYS; way++) {
            sl_writer_format(w, "%s,%d,%s,%s,", m->source.name, m->facets, exp_way_setting(way), exp_way_method(way));
            write_row(w, &m->way[way]);
        }
    }
    SL_TRY(exp_csv_close(run, &w));
cleanup:
    sl_writer_abandon(w);
    return status;
}

static sl_status write_added(exp_run *run, const companion *all)
{
    sl_status status = SL_OK;
    sl_writer *w = NULL;
    SL_TRY(exp_csv_open(run, "added.csv", "tool,mesh,facets,known," NUMBERS, &w));
    for (int32_t k = 0; k < all->added; k++) {
        const added *a = &all->add[k];
        sl_writer_format(w, "%s,%s,%d,%d,", a->from->name, a->mesh, a->facets, a->model >= 0);
        write_row(w, &a->numbers);
    }
    SL_TRY(exp_csv_close(run, &w));
cleanup:
    sl_writer_abandon(w);
    return status;
}

/* On how many models each method is better, equal and worse, and its median. */
static sl_status write_wins(exp_run *run, const companion *all)
{
    sl_status status = SL_OK;
    sl_writer *w = NULL;
    SL_TRY(exp_csv_open(run, "wins.csv", "setting,metric,method,better,equal,worse,median_log2", &w));
    for (int k = 0; k < EXP_WAYS * EXP_NUMBERS; k++) {
        const int way = k / EXP_NUMBERS, metric = k % EXP_NUMBERS;
        comparison c;
        SL_TRY(compare(all, way, exp_way_base(way), metric, &c));
        if (way != exp_way_base(way)) {
            sl_writer_format(w, "%s,%s,%s,%d,%d,%d,%.6f\n", exp_way_setting(way), exp_metric_name[metric],
                             exp_way_method(way), c.better, c.equal, c.worse, c.median);
        }
    }
    SL_TRY(exp_csv_close(run, &w));
cleanup:
    sl_writer_abandon(w);
    return status;
}

sl_status write_csvs(exp_run *run, const companion *all)
{
    sl_status status = SL_OK;
    SL_TRY(write_numbers(run, all));
    SL_TRY(write_ratios(run, all, false));
    SL_TRY(write_ratios(run, all, true));
    SL_TRY(write_wins(run, all));
    if (all->added > 0) {
        SL_TRY(write_added(run, all));
    }
cleanup:
    return status;
}
