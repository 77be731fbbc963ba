/* Solving and measuring a chart with constraints. */
#include "support/sheet.h"

#include <math.h>
#include <stdio.h>

static const double degrees = 57.29577951308232;

/* How often the border of a layout crosses itself. */
static sl_status count_crossings(const exp_sheet *sheet, const double *uv, int32_t *crossings)
{
    const sl_patch *p = sheet->patch;
    sl_status status = SL_OK;
    sl_certificate certificate;
    int32_t *border = NULL, count = 0;
    SL_TRY(sl_patch_border_edges(p, &count, &border));
    SL_TRY(sl_certify_embedding(uv, p->nt, p->tri, count, border, &certificate));
    *crossings = certificate.border_crossings;
cleanup:
    sl_free(border);
    return status;
}

sl_status exp_wish_good(exp_run *run, const exp_sheet *sheet, const exp_wish *wish, bool *good)
{
    const sl_patch *p = sheet->patch;
    sl_sector_table table = {0};
    sl_abf_def def = sl_abf_default();
    sl_abf_info info;
    int32_t crossings = 0;
    double *uv = sl_alloc(2 * (int64_t)p->nv, sizeof *uv);
    sl_status status = SL_OK;
    *good = false;
    SL_TRY(uv != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(sl_constraints_compile(p, wish->count, wish->item, NULL, &table, NULL));
    def.sectors = &table.view;
    SL_TRY(sl_abf_flatten(p, &def, &run->context, uv, &info));
    SL_TRY(count_crossings(sheet, uv, &crossings));
    *good = info.converged && crossings == 0;
cleanup:
    sl_sectors_clear(&table);
    sl_free(uv);
    return status == SL_INFEASIBLE || status == SL_SINGULAR ? SL_OK : status;
}

sl_status exp_sheet_measure(const exp_sheet *sheet, const exp_wish *wish, const sl_sector_table *table,
                            const sl_abf_chart *chart, exp_solution *s)
{
    const sl_patch *p = sheet->patch;
    const double *uv = sl_abf_chart_uv(chart);
    sl_constraint_measure measure[SL_COUNTOF(wish->item)];
    s->info = *sl_abf_chart_info_of(chart);
    s->line = s->angle = 0.0;
    sl_constraints_measure(p, wish->count, wish->item, table, uv, measure);
    for (int32_t k = 0; k < wish->count; k++) {
        s->line = fmax(s->line, measure[k].line);
        s->angle = fmax(s->angle, measure[k].angle);
    }
    const sl_status status = sl_distortion_measure_indexed(p->nt, p->tri, p->xyz, uv, &s->distortion);
    return status == SL_OK ? count_crossings(sheet, uv, &s->crossings) : status;
}

sl_status exp_sheet_solve(exp_run *run, const exp_sheet *sheet, const exp_wish *wish, sl_sector_table *table,
                          sl_abf_chart **out, exp_solution *solution)
{
    sl_status status = SL_OK;
    sl_abf_def def = sl_abf_default();
    *out = NULL;
    *solution = (exp_solution){0};
    SL_TRY(sl_constraints_compile(sheet->patch, wish->count, wish->item, NULL, table, &run->diag));
    def.sectors = &table->view;
    solution->cpu = exp_cpu_seconds();
    SL_TRY(sl_abf_chart_create(sheet->patch, &def, &run->context, out));
    solution->cpu = exp_cpu_seconds() - solution->cpu;
    SL_TRY(exp_sheet_measure(sheet, wish, table, *out, solution));
cleanup:
    return status;
}

void exp_solution_header(exp_page *page, const char *first)
{
    char text[400];
    snprintf(text, sizeof text,
             "%s|triangles|lines|angles|iterations|solves|reached|&#124;&nabla;L&#124;|max &#124;g1&#124;|max "
             "&#124;g2&#124;|max &#124;g3&#124;|off the lines / size|off the angles [deg]|flipped|mean "
             "&sigma;1/&sigma;2|L2|CPU [ms]",
             first);
    exp_page_table_begin(page, text);
}

static bool hold(exp_claims *claims, const char *name, const exp_solution *s)
{
    const sl_abf_info *abf = &s->info.abf;
    const double residual = fmax(fmax(abf->g1, abf->g2), abf->g3);
    const struct {
        const char *quantity;
        double value;
    } measured[] = {{"converged", s->info.converged},
                    {"reached", s->info.reached},
                    {"iterations", s->info.iterations},
                    {"gradient", abf->gradient},
                    {"residuals", residual},
                    {"off the lines", s->line},
                    {"off the angles", s->angle},
                    {"flipped", s->info.quality.flipped},
                    {"mean s1/s2", s->distortion.angle_mean}};
    bool good = true;
    for (size_t k = 0; k < SL_COUNTOF(measured); k++) {
        good = exp_claims_measure(claims, name, measured[k].quantity, measured[k].value) && good;
    }
    return good;
}

void exp_solution_row(exp_page *page, exp_claims *claims, const char *name, const char *what, const exp_wish *wish,
                      const exp_solution *s)
{
    const sl_abf_info *abf = &s->info.abf;
    int32_t lines = 0;
    for (int32_t k = 0; k < wish->count; k++) {
        lines += wish->item[k].kind == SL_CONSTRAINT_STRAIGHT || wish->item[k].kind == SL_CONSTRAINT_BORDER;
    }
    exp_page_row_begin(page, !hold(claims, name, s));
    exp_page_cell(page, "%s", what);
    exp_page_cell(page, "%d", s->distortion.measured);
    exp_page_cell(page, "%d", lines);
    exp_page_cell(page, "%d", wish->count - lines);
    exp_page_cell(page, "%d", s->info.iterations);
    exp_page_cell(page, "%d", s->info.solves);
    exp_page_cell(page, "%.0f %%", 100.0 * s->info.reached);
    exp_page_cell(page, "%.1e", abf->gradient);
    exp_page_cell(page, "%.1e", abf->g1);
    exp_page_cell(page, "%.1e", abf->g2);
    exp_page_cell(page, "%.1e", abf->g3);
    exp_page_cell(page, "%.1e", s->line);
    exp_page_cell(page, "%.1e", s->angle * degrees);
    exp_page_cell(page, "%d", s->info.quality.flipped);
    exp_page_cell(page, "%.3f", s->distortion.angle_mean);
    exp_page_cell(page, "%.3f", s->distortion.l2);
    exp_page_time(page, "%.0f", 1e3 * s->cpu);
    exp_page_row_end(page);
    fprintf(stderr, "%s %s: %d iterations, %d solves, reached %.2f, |g| %.1e, line %.1e, angle %.1e, s1/s2 %.3f\n",
            name, what, s->info.iterations, s->info.solves, s->info.reached, abf->gradient, s->line, s->angle,
            s->distortion.angle_mean);
}
