#include "mesh/build.h"

#include "base/memory.h"
#include "mesh/build_internal.h"

/* A mesh of the input's polygons: corners and facets in place, nothing glued, no coordinates yet. */
static sl_status start_mesh(const sl_polygons *in, sl_mesh *m)
{
    const int32_t nh = in->face_first[in->nf];
    m->nv = in->nv;
    m->nf = in->nf;
    m->nh = nh;
    m->xyz = sl_alloc(3 * (int64_t)in->nv, sizeof *m->xyz);
    m->face_first = sl_copy(in->face_first, (int64_t)in->nf + 1, sizeof *m->face_first);
    m->origin = sl_copy(in->index, nh, sizeof *m->origin);
    m->face = sl_alloc(nh, sizeof *m->face);
    m->twin = sl_alloc(nh, sizeof *m->twin);
    m->sew = sl_alloc(nh, sizeof *m->sew);
    m->input_vertex = sl_alloc(in->nv, sizeof *m->input_vertex);
    m->face_flags = sl_calloc(in->nf, sizeof *m->face_flags);
    if (m->xyz == NULL || m->face_first == NULL || m->origin == NULL || m->face == NULL || m->twin == NULL ||
        m->sew == NULL || m->input_vertex == NULL || m->face_flags == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t f = 0; f < m->nf; f++) {
        for (int32_t h = m->face_first[f]; h < m->face_first[f + 1]; h++) {
            m->face[h] = f;
        }
    }
    for (int32_t v = 0; v < m->nv; v++) {
        m->input_vertex[v] = v;
    }
    return SL_OK;
}

sl_status sl_mesh_build(const sl_polygons *polygons, sl_mesh **out, sl_repair_report *report, sl_diag *diag)
{
    sl_status status = SL_OK;
    sl_repair_report found = {0};
    sl_builder builder = {.input = polygons, .report = &found};
    SL_TRY(sl_build_check(polygons, diag));
    builder.mesh = sl_calloc(1, sizeof *builder.mesh);
    if (builder.mesh == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    SL_TRY(start_mesh(polygons, builder.mesh));
    SL_TRY(sl_build_normalise(&builder));
    SL_TRY(sl_build_flag_degenerate(&builder));
    SL_TRY(sl_build_flag_duplicate(&builder));
    SL_TRY(sl_build_match_edges(&builder));
    SL_TRY(sl_build_orient(&builder));
    SL_TRY(sl_build_split_vertices(&builder));
    SL_TRY(sl_build_summarise(&builder));
    *out = builder.mesh;
    builder.mesh = NULL;
    if (report != NULL) {
        *report = found;
        found = (sl_repair_report){0};
    }
cleanup:
    sl_free(builder.joint);
    sl_mesh_free(builder.mesh);
    sl_repair_report_clear(&found);
    return status;
}

void sl_repair_report_clear(sl_repair_report *report)
{
    sl_free(report->reversed);
    sl_free(report->duplicate);
    sl_free(report->degenerate);
    sl_free(report->bowtie);
    sl_free(report->nonmanifold);
    *report = (sl_repair_report){0};
}
