#include "cli/abf_pick.h"

#include "base/memory.h"
#include "base/text.h"

#include <stdio.h>

void abf_pick_clear(abf_pick *pick)
{
    sl_patch_free(pick->patch);
    sl_free(pick->name);
    sl_mesh_free(pick->mesh);
    sl_atlas_free(pick->atlas);
    sl_meshfile_free(pick->file);
    *pick = (abf_pick){0};
}

static sl_status extract(abf_pick *pick, const sl_mesh *mesh, const sl_triangulation *triangulation,
                         const int32_t *face, int32_t count)
{
    sl_status status = SL_OK;
    SL_TRY(sl_patch_extract(mesh, triangulation, face, count, &pick->patch));
    pick->name = sl_alloc(pick->patch->nv, sizeof *pick->name);
    SL_TRY(pick->name != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t c = 0; c < 3 * pick->patch->nt; c++) {
        pick->name[pick->patch->tri[c]] = mesh->input_vertex[mesh->origin[pick->patch->corner[c]]];
    }
cleanup:
    return status;
}

/* Takes the mesh as the chart if it is one disk. */
static sl_status try_whole(abf_pick *pick, const sl_polygons *polygons, bool *taken, sl_diag *diag)
{
    sl_status status = SL_OK;
    sl_triangulation *triangulation = NULL;
    int32_t *list = NULL, components = 0;
    SL_TRY(sl_mesh_build(polygons, &pick->mesh, NULL, diag));
    pick->facets = pick->mesh->nf;
    list = sl_alloc(pick->mesh->nf, sizeof *list);
    SL_TRY(list != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(sl_mesh_components(pick->mesh, list, &components));
    *taken = false;
    if (components == 1) {
        for (int32_t f = 0; f < pick->mesh->nf; f++) {
            list[f] = f;
        }
        SL_TRY(sl_triangulation_create(pick->mesh, &triangulation));
        SL_TRY(extract(pick, pick->mesh, triangulation, list, pick->mesh->nf));
        *taken = sl_patch_is_disk(pick->patch);
        pick->charts = 1;
    }
    if (!*taken) {
        sl_patch_free(pick->patch);
        sl_free(pick->name);
        sl_mesh_free(pick->mesh);
        *pick = (abf_pick){.facets = pick->facets, .file = pick->file};
    }
cleanup:
    sl_triangulation_free(triangulation);
    sl_free(list);
    return status;
}

static int32_t largest_chart(const sl_segmentation *seg)
{
    int32_t best = 0;
    for (int32_t c = 1; c < seg->nchart; c++) {
        best = seg->chart[c].count > seg->chart[best].count ? c : best;
    }
    return best;
}

static sl_status cut_and_take(cli_run *run, const abf_source *source, const sl_polygons *polygons, abf_pick *pick,
                              sl_diag *diag)
{
    sl_status status = SL_OK;
    sl_atlas_def def = sl_atlas_default();
    int32_t *edge = NULL;
    def.segment.symmetry = SL_SYMMETRY_USE_OFF; /* every chart is laid out itself */
    if (source->seams != NULL) {
        SL_TRY(sl_seams_read_edges(source->seams, &edge, &def.seam_input.edge_count, diag));
        def.seam_input.edge = edge;
        def.seams = SL_SEAMS_EDGES;
    }
    SL_TRY(sl_unwrap(polygons, &def, &run->context, &pick->atlas, diag));
    const sl_segmentation *seg = pick->atlas->segmentation;
    pick->charts = seg->nchart;
    if (source->chart >= seg->nchart) {
        sl_diag_reason(diag, "there is no chart %d: they are numbered from 0 to %d", source->chart, seg->nchart - 1);
        SL_TRY(SL_BAD_INPUT);
    }
    pick->chart = source->chart >= 0 ? source->chart : largest_chart(seg);
    const sl_chart *chart = &seg->chart[pick->chart];
    SL_TRY(extract(pick, pick->atlas->mesh, pick->atlas->triangulation, &seg->face[chart->first], chart->count));
    cli_note(run, "%s into %d chart%s; this is number %d with %d of %d facets%s",
             source->seams != NULL ? "your seams cut the mesh" : "the mesh is no disk: `unwrap` cuts it", pick->charts,
             sl_plural(pick->charts), pick->chart, chart->count, pick->facets,
             source->chart < 0 ? "; choose another one by --chart N" : "");
    if (!sl_patch_is_disk(pick->patch)) {
        sl_diag_reason(diag, "chart %d is no disk: it has %d border loops and Euler characteristic %d", pick->chart,
                       pick->patch->loops, pick->patch->euler);
        SL_TRY(SL_INFEASIBLE);
    }
cleanup:
    sl_free(edge);
    return status;
}

int abf_pick_chart(cli_run *run, const abf_source *source, abf_pick *pick)
{
    sl_diag diag = sl_diag_none();
    sl_polygons polygons;
    bool taken = false;
    sl_status status = SL_OK;
    const int code = cli_read_mesh(run, source->file, &pick->file);
    if (code != CLI_DONE) {
        return code;
    }
    sl_meshfile_polygons(pick->file, &polygons);
    snprintf(diag.file, sizeof diag.file, "%s", source->file);
    if (source->seams == NULL && source->chart <= 0) {
        SL_TRY(try_whole(pick, &polygons, &taken, &diag));
    }
    if (!taken) {
        pick->facets = polygons.nf;
        SL_TRY(cut_and_take(run, source, &polygons, pick, &diag));
    }
cleanup:
    if (status == SL_IO) {
        return cli_fail(run, status, &diag) == CLI_DONE ? CLI_DONE : CLI_BAD_INPUT;
    }
    return cli_fail(run, status, &diag);
}
