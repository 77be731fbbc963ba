#include "meshio/ply_export.h"
#include "meshio/ply_internal.h"

#include <string.h>

static void put_vertices(sl_writer *writer, const sl_polygons *polygons)
{
    for (int64_t v = 0; v < polygons->nv; v++) {
        ply_put_vertex(writer, polygons->xyz + 3 * v);
    }
}

sl_status sl_ply_write_colored(const char *path, const sl_polygons *polygons, const uint8_t *face_rgb, sl_diag *diag)
{
    sl_writer *writer;
    const sl_status status = sl_writer_create(path, &writer, diag);
    if (status != SL_OK) {
        return status;
    }
    const ply_type count_type = ply_count_type(ply_largest_degree(polygons));
    ply_put_polygon_header(writer, polygons, "");
    sl_writer_text(writer, "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n");
    put_vertices(writer, polygons);
    for (int32_t f = 0; f < polygons->nf; f++) {
        ply_put_corners(writer, PLY_LITTLE, count_type, polygons, f);
        sl_writer_bytes(writer, face_rgb + 3 * (int64_t)f, 3);
    }
    return sl_writer_commit(writer, diag);
}

sl_status sl_ply_write_values(const char *path, const sl_polygons *polygons, int32_t columns, const char *const *name,
                              const double *const *value, sl_diag *diag)
{
    sl_writer *writer;
    const sl_status status = sl_writer_create(path, &writer, diag);
    if (status != SL_OK) {
        return status;
    }
    const ply_type count_type = ply_count_type(ply_largest_degree(polygons));
    ply_put_polygon_header(writer, polygons, "");
    for (int32_t k = 0; k < columns; k++) {
        SL_ASSERT(name[k][0] != '\0' && strpbrk(name[k], " \t\r\n") == NULL);
        sl_writer_format(writer, "property double %s\n", name[k]);
    }
    sl_writer_text(writer, "end_header\n");
    put_vertices(writer, polygons);
    for (int32_t f = 0; f < polygons->nf; f++) {
        ply_put_corners(writer, PLY_LITTLE, count_type, polygons, f);
        for (int32_t k = 0; k < columns; k++) {
            ply_put(writer, PLY_LITTLE, PLY_DOUBLE, value[k][f]);
        }
    }
    return sl_writer_commit(writer, diag);
}
