#include "support/sheet.h"

#include "generators.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

void exp_sheet_close(exp_sheet *sheet)
{
    sl_patch_free(sheet->patch);
    sl_graph_clear(&sheet->graph);
    sl_segmentation_free(sheet->segmentation);
    sl_triangulation_free(sheet->triangulation);
    sl_mesh_free(sheet->mesh);
    *sheet = (exp_sheet){0};
}

bool exp_sheet_is_edge(const exp_sheet *sheet, int32_t c)
{
    const sl_patch *p = sheet->patch;
    return sl_next(sheet->mesh, p->corner[c]) == p->corner[sl_corner_next(c)];
}

static sl_status build_graph(exp_sheet *sheet)
{
    const sl_patch *p = sheet->patch;
    sl_graph *g = &sheet->graph;
    g->n = p->nv;
    g->first = sl_calloc((int64_t)p->nv + 2, sizeof *g->first);
    g->adj = sl_alloc(6 * (int64_t)p->nt, sizeof *g->adj);
    if (g->first == NULL || g->adj == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int pass = 0; pass < 2; pass++) {
        for (int32_t c = 0; c < 3 * p->nt; c++) {
            if (!exp_sheet_is_edge(sheet, c) || (p->twin[c] >= 0 && p->twin[c] < c)) {
                continue;
            }
            const int32_t end[2] = {p->tri[c], p->tri[sl_corner_next(c)]};
            for (int k = 0; k < 2; k++) {
                if (pass == 0) {
                    g->first[end[k] + 2]++;
                } else {
                    const int32_t at = g->first[end[k] + 1]++;
                    g->adj[at] = end[1 - k];
                }
            }
        }
        for (int32_t v = 0; pass == 0 && v < p->nv; v++) {
            g->first[v + 2] += g->first[v + 1];
        }
    }
    return SL_OK;
}

sl_status exp_sheet_open(exp_run *run, const char *model, int32_t charts, int32_t chart, exp_sheet *sheet)
{
    sl_status status = SL_OK;
    sl_generated *made = NULL;
    sl_polygons polygons;
    sl_segment_def def = sl_segment_default();
    *sheet = (exp_sheet){0};
    snprintf(sheet->name, sizeof sheet->name, "%s", model);
    def.symmetry = SL_SYMMETRY_USE_OFF;
    if (charts > 0) {
        def.sew = false;
        def.max_charts = charts;
        def.flatten.minimise_stretch = false;
        def.flatten.tutte = false;
    }
    const sl_generator *generator = sl_generator_find(model);
    SL_TRY(generator != NULL ? SL_OK : SL_BAD_INPUT);
    SL_TRY(generator->make(1, 1, &made));
    sl_generated_polygons(made, &polygons);
    SL_TRY(sl_mesh_build(&polygons, &sheet->mesh, NULL, &run->diag));
    SL_TRY(sl_triangulation_create(sheet->mesh, &sheet->triangulation));
    SL_TRY(sl_segment(sheet->mesh, sheet->triangulation, &def, &run->context, &sheet->segmentation));
    const sl_segmentation *seg = sheet->segmentation;
    sheet->chart = chart;
    for (int32_t c = 0; chart < 0 && c < seg->nchart; c++) {
        sheet->chart = sheet->chart < 0 || seg->chart[c].count > seg->chart[sheet->chart].count ? c : sheet->chart;
    }
    SL_TRY(sheet->chart < seg->nchart ? SL_OK : SL_BAD_INPUT);
    const sl_chart *taken = &seg->chart[sheet->chart];
    SL_TRY(sl_patch_extract(sheet->mesh, sheet->triangulation, &seg->face[taken->first], taken->count, &sheet->patch));
    SL_TRY(build_graph(sheet));
cleanup:
    sl_generated_free(made);
    return status;
}

sl_status exp_sheet_border(const exp_sheet *sheet, int32_t **vertex, int32_t *count)
{
    int32_t *first = NULL, *halfedge = NULL;
    sl_status status = SL_OK;
    SL_TRY(sl_patch_border(sheet->patch, &first, &halfedge));
    *count = first[1];
    for (int32_t k = 0; k < *count; k++) {
        halfedge[k] = sheet->patch->tri[halfedge[k]];
    }
    *vertex = halfedge;
    halfedge = NULL;
cleanup:
    sl_free(first);
    sl_free(halfedge);
    return status;
}

void exp_sheet_window(const exp_sheet *sheet, const double *uv, double window[3])
{
    double lo[2] = {HUGE_VAL, HUGE_VAL}, hi[2] = {-HUGE_VAL, -HUGE_VAL};
    for (int32_t v = 0; v < sheet->patch->nv; v++) {
        for (int k = 0; k < 2; k++) {
            lo[k] = fmin(lo[k], uv[2 * (int64_t)v + k]);
            hi[k] = fmax(hi[k], uv[2 * (int64_t)v + k]);
        }
    }
    const double side = fmax(hi[0] - lo[0], hi[1] - lo[1]);
    window[0] = 0.5 * (lo[0] + hi[0] - side);
    window[1] = 0.5 * (lo[1] + hi[1] - side);
    window[2] = side;
}

int32_t exp_sheet_widest(const exp_sheet *sheet, const double *alpha)
{
    const sl_patch *p = sheet->patch;
    int32_t best = -1;
    double widest = 0.0;
    for (int32_t v = 0; v < p->nv; v++) {
        double sum = 0.0;
        int32_t triangles = 0;
        for (int32_t c = p->border[v] ? p->outgoing[v] : -1; c >= 0; c = sl_corner_rotate(p, c)) {
            sum += alpha[c];
            triangles++;
        }
        if (triangles >= 4 && sum > widest) {
            widest = sum;
            best = v;
        }
    }
    return best;
}
