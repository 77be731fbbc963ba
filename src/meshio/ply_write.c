/* New PLY files, binary little endian, for polygons of other formats. */
#include "meshio/ply_internal.h"

#include <inttypes.h>
#include <math.h>

ply_type ply_count_type(int64_t largest)
{
    return largest <= UINT8_MAX ? PLY_UINT8 : PLY_INT32;
}

static const char *count_name(ply_type type)
{
    return type == PLY_UINT8 ? "uchar" : "int";
}

int64_t ply_largest_degree(const sl_polygons *polygons)
{
    int64_t largest = 0;
    for (int32_t f = 0; f < polygons->nf; f++) {
        const int64_t degree = (int64_t)polygons->face_first[f + 1] - polygons->face_first[f];
        largest = degree > largest ? degree : largest;
    }
    return largest;
}

void ply_put_polygon_header(sl_writer *writer, const sl_polygons *polygons, const char *vertex_properties)
{
    sl_writer_format(writer,
                     "ply\nformat binary_little_endian 1.0\nelement vertex %" PRId32
                     "\nproperty double x\nproperty double y\nproperty double z\n%s"
                     "element face %" PRId32 "\nproperty list %s int vertex_indices\n",
                     polygons->nv, vertex_properties, polygons->nf,
                     count_name(ply_count_type(ply_largest_degree(polygons))));
}

void ply_put_vertex(sl_writer *writer, const double *xyz)
{
    for (int k = 0; k < 3; k++) {
        ply_put(writer, PLY_LITTLE, PLY_DOUBLE, xyz[k]);
    }
}

void ply_put_corners(sl_writer *writer, ply_encoding encoding, ply_type count_type, const sl_polygons *polygons,
                     int32_t f)
{
    const int32_t first = polygons->face_first[f], last = polygons->face_first[f + 1];
    ply_put(writer, encoding, count_type, last - first);
    for (int32_t c = first; c < last; c++) {
        ply_put(writer, encoding, PLY_INT32, polygons->index[c]);
    }
}

/* Bytes can hold the colours exactly when each is a whole number of 255ths. Vertices without a colour become white. */
static bool colors_are_bytes(const double *rgb, int64_t count)
{
    for (int64_t k = 0; k < count; k++) {
        const double x = 255.0 * rgb[k];
        if (!isnan(x) && !(fabs(x - rint(x)) < 1e-9 && x > -0.5 && x < 255.5)) {
            return false;
        }
    }
    return true;
}

static void put_color(sl_writer *writer, const double *rgb, bool bytes)
{
    for (int k = 0; k < 3; k++) {
        const double x = isnan(rgb[k]) ? 1.0 : rgb[k];
        ply_put(writer, PLY_LITTLE, bytes ? PLY_UINT8 : PLY_FLOAT, bytes ? rint(255.0 * x) : x);
    }
}

static void put_face(sl_writer *writer, const sl_polygons *polygons, ply_type corner_count, ply_type texcoord_count,
                     const double *uv, int32_t f)
{
    ply_put_corners(writer, PLY_LITTLE, corner_count, polygons, f);
    if (uv == NULL) {
        return;
    }
    const int64_t first = 2 * (int64_t)polygons->face_first[f], last = 2 * (int64_t)polygons->face_first[f + 1];
    ply_put(writer, PLY_LITTLE, texcoord_count, (double)(last - first));
    for (int64_t k = first; k < last; k++) {
        ply_put(writer, PLY_LITTLE, PLY_DOUBLE, uv[k]);
    }
}

sl_status ply_write(sl_writer *writer, const sl_meshfile *file, const double *uv)
{
    sl_polygons polygons;
    sl_meshfile_polygons(file, &polygons);
    const int64_t degree = ply_largest_degree(&polygons);
    const ply_type corner_count = ply_count_type(degree), texcoord_count = ply_count_type(2 * degree);
    const double *rgb = file->vertex_rgb;
    const bool bytes = rgb != NULL && colors_are_bytes(rgb, 3 * (int64_t)file->nv);
    const char *colors = rgb == NULL ? ""
                         : bytes     ? "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                                     : "property float red\nproperty float green\nproperty float blue\n";
    ply_put_polygon_header(writer, &polygons, colors);
    if (uv != NULL) {
        sl_writer_format(writer, "property list %s double texcoord\n", count_name(texcoord_count));
    }
    sl_writer_text(writer, "end_header\n");
    for (int64_t v = 0; v < file->nv; v++) {
        ply_put_vertex(writer, file->xyz + 3 * v);
        if (rgb != NULL) {
            put_color(writer, rgb + 3 * v, bytes);
        }
    }
    for (int32_t f = 0; f < file->nf; f++) {
        put_face(writer, &polygons, corner_count, texcoord_count, uv, f);
    }
    return SL_OK;
}
