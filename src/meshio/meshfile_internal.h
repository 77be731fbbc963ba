/* What the readers and writers of meshio share. Included by meshio and its tests only. */
#ifndef SL_MESHIO_MESHFILE_INTERNAL_H
#define SL_MESHIO_MESHFILE_INTERNAL_H

#include "base/file.h"
#include "base/memory.h"
#include "meshio/meshfile.h"

struct ply_header;

/* The bytes a file was read from, kept for writing it again. */
struct sl_meshfile_source {
    char *data; /* owned; parsing starts at begin, after a byte order mark */
    int64_t begin, size;
    struct ply_header *ply; /* owned, NULL unless PLY */
};

/* What a reader fills in: a file, the room of its growing arrays, and where complaints go. */
typedef struct mesh_reader {
    sl_meshfile *file;
    const char *begin, *end; /* the bytes; nothing at or after end may be read */
    const char *name;        /* the path as given */
    sl_diag *diag;           /* nullable */
    int64_t vertices, faces, corners;
    int64_t xyz_capacity, face_capacity, index_capacity;
} mesh_reader;

/* Fills diag (nullable) and returns status. line 0 = none, byte -1 = none, hint "" = none. */
sl_status mesh_fail(const mesh_reader *reader, sl_status status, int64_t line, int64_t byte, const char *hint,
                    const char *format, ...) SL_PRINTF(6, 7);

/* Makes *array hold at least `need` elements, as sl_reserve. */
SL_NODISCARD sl_status mesh_grow_double(double **array, int64_t *capacity, int64_t need);
SL_NODISCARD sl_status mesh_grow_int(int32_t **array, int64_t *capacity, int64_t need);

/* Appends a vertex, a corner of the open face, and ends the open face. SL_OUT_OF_MEMORY, with diag filled in when the
 * number no longer fits 32 bits. */
SL_NODISCARD sl_status mesh_add_vertex(mesh_reader *reader, const double xyz[3]);
SL_NODISCARD sl_status mesh_add_corner(mesh_reader *reader, int32_t vertex);
SL_NODISCARD sl_status mesh_end_face(mesh_reader *reader);

/* One reader a format. They own nothing but what hangs on reader->file. */
SL_NODISCARD sl_status obj_read(mesh_reader *reader);
SL_NODISCARD sl_status ply_read(mesh_reader *reader);
SL_NODISCARD sl_status off_read(mesh_reader *reader);

/* Does the content start as an OFF file does? */
bool off_recognise(const char *begin, const char *end);

/* One writer a format. uv: 2 doubles a corner or NULL for none. */
SL_NODISCARD sl_status obj_write(sl_writer *writer, const sl_meshfile *file, const double *uv);
SL_NODISCARD sl_status ply_write(sl_writer *writer, const sl_meshfile *file, const double *uv);

/* Writes the PLY the file came from with these UVs in it, or with its own when uv is NULL. */
SL_NODISCARD sl_status ply_rewrite(sl_writer *writer, const sl_meshfile *file, const double *uv);

void ply_header_free(struct ply_header *header); /* NULL is a no-op */

/* Texture vertices of a file: corners of one vertex and one UV share one. */
typedef struct uv_table {
    int32_t count;
    int32_t *corner_uv; /* texture vertex of each corner, -1 = none */
    int32_t *first;     /* count: the corner where each is first used */
} uv_table;

SL_NODISCARD sl_status uv_table_create(const sl_meshfile *file, const double *uv, uv_table *out);
void uv_table_clear(uv_table *table);

/* Writes u so that it reads back exactly; with at most 12 decimals when it is quantised. */
void uv_write_number(sl_writer *writer, double u);

#endif
