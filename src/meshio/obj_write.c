#include "base/text.h"
#include "meshio/meshfile_internal.h"
#include "meshio/obj_internal.h"

#include <math.h>
#include <string.h>

static void write_texture_vertices(sl_writer *writer, const double *uv, const uv_table *table, const char *newline,
                                   int64_t newline_size)
{
    for (int32_t t = 0; t < table->count; t++) {
        const double *pair = uv + 2 * (int64_t)table->first[t];
        sl_writer_bytes(writer, "vt ", 3);
        uv_write_number(writer, pair[0]);
        sl_writer_bytes(writer, " ", 1);
        uv_write_number(writer, pair[1]);
        sl_writer_bytes(writer, newline, newline_size);
    }
}

/* "f 1/1/1 2/2/1 ..." without its line end. */
static void write_face(sl_writer *writer, const sl_meshfile *file, const uv_table *table, int32_t f)
{
    sl_writer_bytes(writer, "f", 1);
    for (int32_t c = file->face_first[f]; c < file->face_first[f + 1]; c++) {
        const int32_t t = table->corner_uv != NULL ? table->corner_uv[c] : -1;
        const int32_t n = file->corner_normal != NULL ? file->corner_normal[c] : -1;
        sl_writer_bytes(writer, " ", 1);
        sl_writer_int(writer, (int64_t)file->index[c] + 1);
        if (t >= 0 || n >= 0) {
            sl_writer_bytes(writer, "/", 1);
        }
        if (t >= 0) {
            sl_writer_int(writer, (int64_t)t + 1);
        }
        if (n >= 0) {
            sl_writer_bytes(writer, "/", 1);
            sl_writer_int(writer, (int64_t)n + 1);
        }
    }
}

/* Copies a statement without the texture vertices it names ("l 1/4 2/5" becomes "l 1 2"): their numbers are no more. */
static void write_without_textures(sl_writer *writer, const char *begin, const char *end)
{
    const char *kept = begin;
    for (const char *p = begin; p < end && *p != '#'; p++) {
        if (*p != '/') {
            continue;
        }
        sl_writer_bytes(writer, kept, p - kept);
        while (p < end && !obj_is_blank(*p) && !obj_is_newline(*p) && *p != '\\') {
            p++;
        }
        kept = p;
        p -= p == end;
    }
    sl_writer_bytes(writer, kept, end - kept);
}

/* The input word for word, but for its texture vertices and faces. The vertices of all faces stand before the first. */
static void rewrite(sl_writer *writer, const sl_meshfile *file, const double *uv, const uv_table *table)
{
    const struct sl_meshfile_source *source = file->source;
    obj_cursor at = {source->data + source->begin, source->data + source->size, 1};
    for (int32_t f = 0; at.p < at.end;) {
        const char *begin = at.p;
        const obj_word word = obj_read_word(&at);
        obj_skip_statement(&at);
        const char *end = at.p;
        obj_skip_newline(&at);
        if (word == OBJ_FACE) {
            if (f == 0) {
                write_texture_vertices(writer, uv, table, end < at.p ? end : "\n", end < at.p ? at.p - end : 1);
            }
            write_face(writer, file, table, f++);
            sl_writer_bytes(writer, end, at.p - end);
        } else if (word == OBJ_LINE) {
            write_without_textures(writer, begin, end);
            sl_writer_bytes(writer, end, at.p - end);
        } else if (word != OBJ_TEXTURE) {
            sl_writer_bytes(writer, begin, at.p - begin);
        }
    }
}

static void write_triple(sl_writer *writer, const double *x)
{
    for (int k = 0; k < 3; k++) {
        sl_writer_bytes(writer, " ", 1);
        sl_writer_double(writer, x[k]);
    }
}

/* An OBJ for polygons that came from another format. */
static void write_anew(sl_writer *writer, const sl_meshfile *file, const double *uv, const uv_table *table)
{
    for (int64_t v = 0; v < file->nv; v++) {
        const double *rgb = file->vertex_rgb != NULL ? file->vertex_rgb + 3 * v : NULL;
        sl_writer_bytes(writer, "v", 1);
        write_triple(writer, file->xyz + 3 * v);
        if (rgb != NULL && !isnan(rgb[0] + rgb[1] + rgb[2])) {
            write_triple(writer, rgb);
        }
        sl_writer_bytes(writer, "\n", 1);
    }
    for (int64_t n = 0; n < file->normals; n++) {
        sl_writer_bytes(writer, "vn", 2);
        write_triple(writer, file->normal + 3 * n);
        sl_writer_bytes(writer, "\n", 1);
    }
    write_texture_vertices(writer, uv, table, "\n", 1);
    for (int32_t f = 0; f < file->nf; f++) {
        write_face(writer, file, table, f);
        sl_writer_bytes(writer, "\n", 1);
    }
}

sl_status obj_write(sl_writer *writer, const sl_meshfile *file, const double *uv)
{
    const struct sl_meshfile_source *source = file->source;
    const bool own = file->format == SL_FORMAT_OBJ;
    uv_table table = {0};
    if (own && uv == NULL) {
        sl_writer_bytes(writer, source->data + source->begin, source->size - source->begin);
        return SL_OK;
    }
    uv = uv != NULL ? uv : file->corner_uv;
    if (uv != NULL) {
        const sl_status status = uv_table_create(file, uv, &table);
        if (status != SL_OK) {
            return status;
        }
    }
    if (own) {
        rewrite(writer, file, uv, &table);
    } else {
        write_anew(writer, file, uv, &table);
    }
    uv_table_clear(&table);
    return SL_OK;
}
