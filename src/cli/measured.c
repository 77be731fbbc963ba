#include "cli/measured.h"

#include "atlas/sidecar.h"

#include <math.h>
#include <stdio.h>

static json_t *number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

json_t *cli_measure_json(const char *name, const sl_atlas_measure *m)
{
    const sl_distortion *d = &m->global;
    json_t *j = json_pack("{s:i, s:s, s:i, s:i, s:i}", "schema", 1, "file", name, "tri", m->triangles, "charts",
                          m->charts, "charts10", m->charts10);
    json_object_set_new(j, "seamLen", number(m->seam_length));
    json_object_set_new(j, "seamDiag", number(m->seam_diagonal));
    json_object_set_new(j, "flip", json_integer(d->flipped));
    json_object_set_new(j, "deg", json_integer(d->degenerate));
    json_object_set_new(j, "ovIn", number(m->overlap_inside));
    json_object_set_new(j, "ovX", number(m->overlap_across));
    json_object_set_new(j, "copies", json_integer(m->copies));
    json_object_set_new(j, "shared", number(m->shared));
    json_object_set_new(j, "angMean", number(d->angle_mean));
    json_object_set_new(j, "ang95", number(d->angle_p95));
    json_object_set_new(j, "angMax", number(d->angle_max));
    json_object_set_new(j, "L2", number(d->l2));
    json_object_set_new(j, "Linf", number(d->linf));
    json_object_set_new(j, "areaMean", number(d->area_mean));
    json_object_set_new(j, "areaMax", number(d->area_max));
    json_object_set_new(j, "pack", number(m->fill));
    json_object_set_new(j, "dupFacets", json_integer(m->duplicate_facets));
    json_object_set_new(j, "degFacets", json_integer(m->degenerate_facets));
    json_object_set_new(j, "chartL2Mean", number(m->chart_l2_mean));
    json_object_set_new(j, "chartL2Worst", number(m->chart_l2_worst));
    json_object_set_new(j, "worstChart", json_integer(m->worst_chart));
    return j;
}

int cli_measure_path(cli_run *run, const char *path, int32_t resolution, sl_atlas_measure *out)
{
    sl_diag diag = sl_diag_none();
    sl_meshfile *file = NULL;
    sl_polygons polygons;
    sl_sharing_table table = {0};
    int code = cli_read_mesh(run, path, &file);
    if (code != CLI_DONE) {
        return code;
    }
    if (file->corner_uv == NULL) {
        sl_diag_reason(&diag, "%s has no UVs to measure", path);
        sl_diag_hint(&diag, "seamlab unwrap makes some");
        code = cli_fail(run, SL_BAD_INPUT, &diag);
    } else {
        sl_meshfile_polygons(file, &polygons);
        snprintf(diag.file, sizeof diag.file, "%s", path);
        const sl_sharing_table *shared = cli_read_sharing(run, path, polygons.nf, &table);
        code = cli_fail(
            run, sl_measure_shared(&polygons, file->corner_uv, shared, resolution, &run->context, out, &diag), &diag);
    }
    sl_sharing_table_clear(&table);
    sl_meshfile_free(file);
    return code;
}
