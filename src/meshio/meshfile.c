#include "meshio/meshfile_internal.h"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static const char *const formats_hint = "use .obj or .ply, which hold UVs";

sl_status mesh_fail(const mesh_reader *reader, sl_status status, int64_t line, int64_t byte, const char *hint,
                    const char *format, ...)
{
    sl_diag *diag = reader->diag;
    if (diag == NULL) {
        return status;
    }
    *diag = sl_diag_none();
    diag->line = line;
    diag->byte = byte;
    snprintf(diag->file, sizeof diag->file, "%s", reader->name);
    snprintf(diag->hint, sizeof diag->hint, "%s", hint);
    va_list args;
    va_start(args, format);
    vsnprintf(diag->reason, sizeof diag->reason, format, args);
    va_end(args);
    return status;
}

sl_status mesh_grow_double(double **array, int64_t *capacity, int64_t need)
{
    void *memory = *array;
    const sl_status status = sl_reserve(&memory, capacity, need, sizeof **array);
    *array = memory;
    return status;
}

sl_status mesh_grow_int(int32_t **array, int64_t *capacity, int64_t need)
{
    void *memory = *array;
    const sl_status status = sl_reserve(&memory, capacity, need, sizeof **array);
    *array = memory;
    return status;
}

static sl_status too_many(const mesh_reader *reader, const char *what)
{
    return mesh_fail(reader, SL_OUT_OF_MEMORY, 0, -1, "split the mesh", "more than 2147483647 %s", what);
}

sl_status mesh_add_vertex(mesh_reader *reader, const double xyz[3])
{
    if (reader->vertices >= INT32_MAX) {
        return too_many(reader, "vertices");
    }
    if (3 * reader->vertices + 3 > reader->xyz_capacity) {
        const sl_status status = mesh_grow_double(&reader->file->xyz, &reader->xyz_capacity, 3 * reader->vertices + 3);
        if (status != SL_OK) {
            return status;
        }
    }
    memcpy(reader->file->xyz + 3 * reader->vertices, xyz, 3 * sizeof *xyz);
    reader->vertices++;
    return SL_OK;
}

sl_status mesh_add_corner(mesh_reader *reader, int32_t vertex)
{
    if (reader->corners >= INT32_MAX) {
        return too_many(reader, "corners");
    }
    if (reader->corners >= reader->index_capacity) {
        const sl_status status = mesh_grow_int(&reader->file->index, &reader->index_capacity, reader->corners + 1);
        if (status != SL_OK) {
            return status;
        }
    }
    reader->file->index[reader->corners++] = vertex;
    return SL_OK;
}

sl_status mesh_end_face(mesh_reader *reader)
{
    if (reader->faces + 2 > reader->face_capacity) {
        const sl_status status = mesh_grow_int(&reader->file->face_first, &reader->face_capacity, reader->faces + 2);
        if (status != SL_OK) {
            return status;
        }
    }
    reader->file->face_first[0] = 0;
    reader->file->face_first[++reader->faces] = (int32_t)reader->corners; /* faces <= corners, so they fit too */
    return SL_OK;
}

/* True when path ends in the lower-case extension, in any case. */
static bool has_extension(const char *path, const char *extension)
{
    const size_t n = strlen(path), m = strlen(extension);
    if (n < m) {
        return false;
    }
    for (size_t k = 0; k < m; k++) {
        const char c = path[n - m + k];
        if ((c >= 'A' && c <= 'Z' ? c + ('a' - 'A') : c) != extension[k]) {
            return false;
        }
    }
    return true;
}

/* The format a name stands for; false when it is none of ours. */
static bool format_of_name(const char *path, sl_meshformat *format)
{
    static const char *const extensions[] = {
        [SL_FORMAT_OBJ] = ".obj", [SL_FORMAT_PLY] = ".ply", [SL_FORMAT_OFF] = ".off"};
    for (size_t k = 0; k < SL_COUNTOF(extensions); k++) {
        if (has_extension(path, extensions[k])) {
            *format = (sl_meshformat)k;
            return true;
        }
    }
    return false;
}

static bool is_ply(const char *begin, const char *end)
{
    return end - begin > 3 && memcmp(begin, "ply", 3) == 0 && (begin[3] == '\n' || begin[3] == '\r' || begin[3] == ' ');
}

/* OBJ has no mark of its own: text without zero bytes and with a line that starts with "v ". */
static bool is_obj(const char *begin, const char *end)
{
    if (memchr(begin, '\0', (size_t)(end - begin)) != NULL) {
        return false;
    }
    bool line_start = true;
    for (const char *p = begin; p + 1 < end; p++) {
        if (line_start && *p == 'v' && (p[1] == ' ' || p[1] == '\t')) {
            return true;
        }
        line_start = *p == '\n' || *p == '\r' || (line_start && (*p == ' ' || *p == '\t'));
    }
    return false;
}

/* The format of the content; false when it looks like none of ours. */
static bool format_of_content(const char *begin, const char *end, sl_meshformat *format)
{
    if (is_ply(begin, end)) {
        *format = SL_FORMAT_PLY;
    } else if (off_recognise(begin, end)) {
        *format = SL_FORMAT_OFF;
    } else if (is_obj(begin, end)) {
        *format = SL_FORMAT_OBJ;
    } else {
        return false;
    }
    return true;
}

static sl_status read_format(mesh_reader *reader)
{
    sl_status (*const readers[])(mesh_reader *) = {
        [SL_FORMAT_OBJ] = obj_read, [SL_FORMAT_PLY] = ply_read, [SL_FORMAT_OFF] = off_read};
    if (reader->begin == reader->end) {
        return mesh_fail(reader, SL_BAD_INPUT, 0, 0, "", "the file is empty");
    }
    if (!format_of_name(reader->name, &reader->file->format) &&
        !format_of_content(reader->begin, reader->end, &reader->file->format)) {
        return mesh_fail(reader, SL_UNSUPPORTED, 0, -1, "convert it to .obj, .ply or .off",
                         "neither the name nor the content is of a mesh format read here");
    }
    const sl_status status = readers[reader->file->format](reader);
    if (status != SL_OK) {
        return status;
    }
    reader->file->nv = (int32_t)reader->vertices;
    reader->file->nf = (int32_t)reader->faces;
    return SL_OK;
}

/* Takes the bytes, which must come from sl_alloc, in every case. */
static sl_status parse_owned(const char *name, char *data, int64_t size, sl_meshfile **out, sl_diag *diag)
{
    sl_status status = SL_OUT_OF_MEMORY;
    sl_meshfile *file = sl_calloc(1, sizeof *file);
    struct sl_meshfile_source *source = sl_calloc(1, sizeof *source);
    if (diag != NULL) {
        *diag = sl_diag_none();
    }
    if (file == NULL || source == NULL) {
        sl_free(source);
        sl_free(data);
        goto cleanup;
    }
    file->source = source;
    *source = (struct sl_meshfile_source){data, 0, size, NULL};
    source->begin = size >= 3 && memcmp(data, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
    mesh_reader reader = {.file = file, .begin = data + source->begin, .end = data + size, .name = name, .diag = diag};
    SL_TRY(read_format(&reader));
    *out = file;
    return SL_OK;
cleanup:
    if (status == SL_OUT_OF_MEMORY && diag != NULL && diag->reason[0] == '\0') {
        const mesh_reader nowhere = {.name = name, .diag = diag};
        (void)mesh_fail(&nowhere, status, 0, -1, "", "not enough memory to read this file");
    }
    sl_meshfile_free(file);
    return status;
}

sl_status sl_meshfile_parse(const char *name, const char *data, int64_t size, sl_meshfile **out, sl_diag *diag)
{
    *out = NULL;
    char *copy = sl_copy(data, size, 1);
    return copy != NULL ? parse_owned(name, copy, size, out, diag) : SL_OUT_OF_MEMORY;
}

sl_status sl_meshfile_read(const char *path, sl_meshfile **out, sl_diag *diag)
{
    char *data;
    int64_t size;
    *out = NULL;
    const sl_status status = sl_file_read(path, &data, &size, diag);
    return status == SL_OK ? parse_owned(path, data, size, out, diag) : status;
}

void sl_meshfile_free(sl_meshfile *file)
{
    if (file == NULL) {
        return;
    }
    if (file->source != NULL) {
        ply_header_free(file->source->ply);
        sl_free(file->source->data);
        sl_free(file->source);
    }
    sl_free(file->xyz);
    sl_free(file->face_first);
    sl_free(file->index);
    sl_free(file->corner_uv);
    sl_free(file->normal);
    sl_free(file->corner_normal);
    sl_free(file->vertex_rgb);
    sl_free(file);
}

void sl_meshfile_polygons(const sl_meshfile *file, sl_polygons *polygons)
{
    *polygons = (sl_polygons){file->nv, file->nf, file->xyz, file->face_first, file->index};
}

/* The format written to path; false when it cannot be written. */
static bool output_format(const char *path, sl_meshformat own, sl_meshformat *format)
{
    if (strcmp(path, "-") == 0) {
        *format = own == SL_FORMAT_PLY ? SL_FORMAT_PLY : SL_FORMAT_OBJ;
        return true;
    }
    return format_of_name(path, format) && *format != SL_FORMAT_OFF;
}

bool sl_meshfile_can_hold_uv(const char *path)
{
    sl_meshformat format;
    return output_format(path, SL_FORMAT_OBJ, &format);
}

/* Infinite numbers cannot be read back by most programs: refused before anything is written. */
static sl_status check_uv(const mesh_reader *where, const double *uv, int64_t corners)
{
    for (int64_t c = 0; uv != NULL && c < corners; c++) {
        if (isinf(uv[2 * c]) || isinf(uv[2 * c + 1])) {
            const sl_status status = mesh_fail(where, SL_BAD_INPUT, 0, -1, "", "the UV of a corner is infinite");
            if (where->diag != NULL) {
                where->diag->element = c;
            }
            return status;
        }
    }
    return SL_OK;
}

sl_status sl_meshfile_write(const char *path, const sl_meshfile *file, const double *corner_uv, sl_diag *diag)
{
    sl_status status = SL_OK;
    sl_writer *writer = NULL;
    sl_meshformat format;
    const mesh_reader where = {.name = path, .diag = diag};
    if (!output_format(path, file->format, &format)) {
        return mesh_fail(&where, SL_UNSUPPORTED, 0, -1, formats_hint,
                         has_extension(path, ".off") ? "OFF files cannot hold UVs per corner"
                                                     : "meshes are not written to files of this extension");
    }
    SL_TRY(check_uv(&where, corner_uv, file->face_first[file->nf]));
    SL_TRY(sl_writer_create(path, &writer, diag));
    if (format == SL_FORMAT_OBJ) {
        SL_TRY(obj_write(writer, file, corner_uv));
    } else if (file->format == SL_FORMAT_PLY) {
        SL_TRY(ply_rewrite(writer, file, corner_uv));
    } else {
        SL_TRY(ply_write(writer, file, corner_uv != NULL ? corner_uv : file->corner_uv));
    }
    return sl_writer_commit(writer, diag);
cleanup:
    sl_writer_abandon(writer);
    return status;
}

/* Appends "3 things" to the list in text when count > 0. */
static void add_loss(char *text, size_t size, int64_t count, const char *one, const char *many)
{
    const size_t used = strlen(text);
    if (count > 0) {
        snprintf(text + used, size - used, "%s%" PRId64 " %s", used > 0 ? ", " : "", count, count == 1 ? one : many);
    }
}

bool sl_meshfile_losses(const sl_meshfile *file, const char *path, char *text, size_t size)
{
    SL_ASSERT(size > 0);
    text[0] = '\0';
    sl_meshformat format;
    const sl_meshfile_extras *extras = &file->extras;
    if (!output_format(path, file->format, &format)) {
        return false;
    }
    add_loss(text, size, extras->face_colors, "face colour", "face colours");
    if (format != file->format) {
        add_loss(text, size, extras->names, "name or material", "names and materials");
        add_loss(text, size, extras->lines, "line element", "line elements");
        add_loss(text, size, extras->points, "point element", "point elements");
        add_loss(text, size, extras->others, "other statement or row", "other statements or rows");
        add_loss(text, size, extras->properties, "extra property", "extra properties");
        add_loss(text, size, format == SL_FORMAT_PLY ? file->normals : 0, "normal", "normals");
    }
    return text[0] != '\0';
}
