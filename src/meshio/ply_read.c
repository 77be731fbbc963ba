#include "meshio/ply_internal.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct ply_reader {
    mesh_reader *out;
    ply_header *header;
    ply_cursor at;
    const ply_element *element; /* the one being read, for messages */
    int64_t row;
    int64_t vertices;  /* as the header says */
    double *vertex_uv; /* vertices x 2 */
    double *texcoord;  /* of the face being read */
    int64_t vertex_uv_capacity, texcoord_capacity, corner_uv_capacity, normal_capacity, rgb_capacity;
} ply_reader;

static const uint32_t normal_roles = 1u << PLY_NX | 1u << PLY_NY | 1u << PLY_NZ;
static const uint32_t color_roles = 1u << PLY_RED | 1u << PLY_GREEN | 1u << PLY_BLUE;
static const uint32_t uv_roles = 1u << PLY_U | 1u << PLY_V;

/* Bad input where the cursor stands. */
static sl_status fail(const ply_reader *r, const char *hint, const char *reason)
{
    static const char *const names[] = {
        [PLY_VERTICES] = "vertex", [PLY_FACES] = "face", [PLY_STRIPS] = "strip", [PLY_ELSE] = "row"};
    const bool text = r->header->encoding == PLY_ASCII;
    const int64_t byte = r->at.p - r->out->file->source->data;
    return mesh_fail(r->out, SL_BAD_INPUT, text ? r->at.line : 0, text ? -1 : byte, hint, "%s %" PRId64 ": %s",
                     names[r->element->kind], r->row, reason);
}

/* A value could not be read: the end of the file, or something that is no such number. */
static sl_status no_value(const ply_reader *r)
{
    return r->header->encoding == PLY_ASCII && r->at.p < r->at.end
               ? fail(r, "", "there is no number of the declared type here")
               : fail(r, "the file may be cut short or a count in it wrong", "the file ends too early");
}

static double color_scale(ply_type type)
{
    return type >= PLY_FLOAT ? 1.0 : type == PLY_UINT16 ? 1.0 / 65535.0 : 1.0 / 255.0;
}

/* Keeps what the row of a vertex holds, by role. */
static sl_status keep_vertex(ply_reader *r, const double row[PLY_ROLES])
{
    sl_meshfile *file = r->out->file;
    const uint32_t roles = r->element->roles;
    const int64_t v = r->out->vertices;
    sl_status status;
    if (!(isfinite(row[PLY_X]) && isfinite(row[PLY_Y]) && isfinite(row[PLY_Z]))) {
        return fail(r, "repair or remove this vertex", "a coordinate is not finite");
    }
    SL_TRY(mesh_add_vertex(r->out, row + PLY_X));
    if ((roles & normal_roles) == normal_roles) {
        SL_TRY(mesh_grow_double(&file->normal, &r->normal_capacity, 3 * v + 3));
        memcpy(file->normal + 3 * v, row + PLY_NX, 3 * sizeof *row);
    }
    if ((roles & color_roles) == color_roles) {
        SL_TRY(mesh_grow_double(&file->vertex_rgb, &r->rgb_capacity, 3 * v + 3));
        memcpy(file->vertex_rgb + 3 * v, row + PLY_RED, 3 * sizeof *row);
    }
    if ((roles & uv_roles) == uv_roles) {
        const bool usable = isfinite(row[PLY_U]) && isfinite(row[PLY_V]);
        SL_TRY(mesh_grow_double(&r->vertex_uv, &r->vertex_uv_capacity, 2 * v + 2));
        r->vertex_uv[2 * v] = usable ? row[PLY_U] : (double)NAN;
        r->vertex_uv[2 * v + 1] = usable ? row[PLY_V] : (double)NAN;
    }
cleanup:
    return status;
}

static sl_status read_vertex(ply_reader *r)
{
    double row[PLY_ROLES] = {0};
    for (int32_t k = r->element->first; k < r->element->last; k++) {
        const ply_property *property = &r->header->property[k];
        int64_t count;
        if (property->role == PLY_OTHER) {
            if (!ply_read_count(&r->at, property, &count) || !ply_skip_values(&r->at, property->type, count)) {
                return no_value(r);
            }
            continue;
        }
        if (!ply_read_value(&r->at, property->type, &row[property->role])) {
            return no_value(r);
        }
        if (property->role >= PLY_RED && property->role <= PLY_BLUE) {
            row[property->role] *= color_scale(property->type);
        }
    }
    return keep_vertex(r, row);
}

/* Reads a vertex number; -1 is allowed where strips are told apart by it. */
static sl_status read_index(ply_reader *r, ply_type type, int32_t lowest, int32_t *index)
{
    double value;
    if (!ply_read_value(&r->at, type, &value)) {
        return no_value(r);
    }
    if (value < lowest || value >= (double)r->vertices || value >= 0x1p31) {
        char reason[96];
        snprintf(reason, sizeof reason, "uses vertex %.0f, but the file has %" PRId64, value, r->vertices);
        return fail(r, "PLY counts from 0", reason);
    }
    *index = (int32_t)value;
    return SL_OK;
}

static sl_status read_corners(ply_reader *r, const ply_property *property)
{
    int64_t count;
    int32_t vertex = -1;
    sl_status status = SL_OK;
    if (!ply_read_count(&r->at, property, &count)) {
        return no_value(r);
    }
    if (count < 3) {
        return fail(r, "remove this face", "has fewer than 3 corners");
    }
    for (int64_t k = 0; k < count; k++) {
        SL_TRY(read_index(r, property->type, 0, &vertex));
        SL_TRY(mesh_add_corner(r->out, vertex));
    }
cleanup:
    return status;
}

static sl_status read_texcoord(ply_reader *r, const ply_property *property, int64_t *count)
{
    sl_status status = SL_OK;
    if (!ply_read_count(&r->at, property, count)) {
        return no_value(r);
    }
    SL_TRY(mesh_grow_double(&r->texcoord, &r->texcoord_capacity, *count + 1)); /* never NULL, however short */
    for (int64_t k = 0; k < *count; k++) {
        if (!ply_read_value(&r->at, property->type, &r->texcoord[k])) {
            return no_value(r);
        }
    }
cleanup:
    return status;
}

/* UVs of the corners from `first` on: `count` numbers were read, none meaning that the face has no UVs. */
static sl_status keep_texcoord(ply_reader *r, int64_t first, int64_t count)
{
    const int64_t corners = r->out->corners;
    if (count != 0 && count != 2 * (corners - first)) {
        return fail(r, "", "texcoord does not hold 2 numbers a corner");
    }
    const sl_status status = mesh_grow_double(&r->out->file->corner_uv, &r->corner_uv_capacity, 2 * corners);
    if (status != SL_OK) {
        return status;
    }
    double *uv = r->out->file->corner_uv;
    for (int64_t c = first; c < corners; c++) {
        const double *pair = r->texcoord + 2 * (c - first);
        const bool usable = count != 0 && isfinite(pair[0]) && isfinite(pair[1]);
        uv[2 * c] = usable ? pair[0] : (double)NAN;
        uv[2 * c + 1] = usable ? pair[1] : (double)NAN;
    }
    return SL_OK;
}

static sl_status read_face(ply_reader *r)
{
    const int64_t first = r->out->corners;
    int64_t count = 0, texcoords = 0;
    sl_status status = SL_OK;
    for (int32_t k = r->element->first; k < r->element->last; k++) {
        const ply_property *property = &r->header->property[k];
        if (property->role == PLY_CORNERS) {
            SL_TRY(read_corners(r, property));
        } else if (property->role == PLY_TEXCOORD) {
            SL_TRY(read_texcoord(r, property, &texcoords));
        } else if (!ply_read_count(&r->at, property, &count) || !ply_skip_values(&r->at, property->type, count)) {
            return no_value(r);
        }
    }
    if ((r->element->roles & 1u << PLY_TEXCOORD) != 0) {
        SL_TRY(keep_texcoord(r, first, texcoords));
    }
    SL_TRY(mesh_end_face(r->out));
cleanup:
    return status;
}

/* The triangle of a strip whose first two vertices are `before`; every other one runs the other way round. Triangles of
 * a repeated vertex only stitch strips together. */
static sl_status add_strip_triangle(ply_reader *r, const int32_t before[2], int32_t vertex, bool odd)
{
    sl_status status = SL_OK;
    if (before[0] == before[1] || before[0] == vertex || before[1] == vertex) {
        return SL_OK;
    }
    SL_TRY(mesh_add_corner(r->out, before[odd ? 1 : 0]));
    SL_TRY(mesh_add_corner(r->out, before[odd ? 0 : 1]));
    SL_TRY(mesh_add_corner(r->out, vertex));
    SL_TRY(mesh_end_face(r->out));
cleanup:
    return status;
}

static sl_status read_strip_vertices(ply_reader *r, const ply_property *property)
{
    int64_t count;
    int64_t length = 0; /* vertices of the current strip so far */
    int32_t before[2] = {-1, -1};
    sl_status status = SL_OK;
    if (!ply_read_count(&r->at, property, &count)) {
        return no_value(r);
    }
    for (int64_t k = 0; k < count; k++) {
        int32_t vertex = -1;
        SL_TRY(read_index(r, property->type, -1, &vertex));
        if (vertex < 0) {
            length = 0;
            continue;
        }
        if (length >= 2) {
            SL_TRY(add_strip_triangle(r, before, vertex, length % 2 != 0));
        }
        before[0] = before[1];
        before[1] = vertex;
        length++;
    }
cleanup:
    return status;
}

/* A row of triangle strips, or of an element that means nothing to us. */
static sl_status read_other(ply_reader *r)
{
    for (int32_t k = r->element->first; k < r->element->last; k++) {
        const ply_property *property = &r->header->property[k];
        int64_t count;
        if (property->role == PLY_STRIP) {
            const sl_status status = read_strip_vertices(r, property);
            if (status != SL_OK) {
                return status;
            }
        } else if (!ply_read_count(&r->at, property, &count) || !ply_skip_values(&r->at, property->type, count)) {
            return no_value(r);
        }
    }
    return SL_OK;
}

static sl_status read_element(ply_reader *r, ply_element *element)
{
    sl_status (*const rows[])(ply_reader *) = {
        [PLY_VERTICES] = read_vertex, [PLY_FACES] = read_face, [PLY_STRIPS] = read_other, [PLY_ELSE] = read_other};
    const bool empty = element->first == element->last; /* such rows have no bytes, however many there are */
    r->element = element;
    r->row = 0;
    ply_skip_space(&r->at);
    element->body = r->at.p;
    if (!empty && element->count > r->at.end - r->at.p) {
        return fail(r, "the file may be cut short or a count in it wrong",
                    "the header promises more than the file holds");
    }
    for (; !empty && r->row < element->count; r->row++) {
        const sl_status status = rows[element->kind](r);
        if (status != SL_OK) {
            return status;
        }
    }
    element->after = r->at.p;
    if (element->kind == PLY_ELSE) {
        r->out->file->extras.others += !empty ? element->count : 0;
    } else {
        for (int32_t k = element->first; k < element->last; k++) {
            r->out->file->extras.properties += r->header->property[k].role == PLY_OTHER;
        }
    }
    return SL_OK;
}

/* What stands on vertices in PLY, seen from the corners. UVs of faces go before UVs of vertices. */
static sl_status spread(ply_reader *r)
{
    sl_meshfile *file = r->out->file;
    const int64_t corners = r->out->corners;
    if (file->normal != NULL) {
        file->normals = (int32_t)r->out->vertices;
        file->corner_normal = sl_copy(file->index, corners, sizeof *file->index);
        if (file->corner_normal == NULL) {
            return SL_OUT_OF_MEMORY;
        }
    }
    if (r->vertex_uv != NULL && file->corner_uv == NULL) {
        file->corner_uv = sl_alloc(corners, 2 * sizeof *file->corner_uv);
        if (file->corner_uv == NULL) {
            return SL_OUT_OF_MEMORY;
        }
        for (int64_t c = 0; c < corners; c++) {
            memcpy(file->corner_uv + 2 * c, r->vertex_uv + 2 * (int64_t)file->index[c], 2 * sizeof(double));
        }
    }
    return SL_OK;
}

sl_status ply_read(mesh_reader *reader)
{
    ply_reader r = {.out = reader};
    sl_status status;
    ply_header *header = reader->file->source->ply = sl_calloc(1, sizeof *header);
    if (header == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    SL_TRY(ply_read_header(reader, header));
    r.header = header;
    r.at = (ply_cursor){header->body, reader->end, header->lines + 1, header->encoding};
    for (int32_t e = 0; e < header->elements; e++) {
        r.vertices = header->element[e].kind == PLY_VERTICES ? header->element[e].count : r.vertices;
    }
    for (int32_t e = 0; e < header->elements; e++) {
        SL_TRY(read_element(&r, &header->element[e]));
    }
    if (reader->faces == 0) {
        status = mesh_fail(reader, SL_BAD_INPUT, header->lines, -1, "", "there is no face in this file");
        goto cleanup;
    }
    SL_TRY(spread(&r));
cleanup:
    sl_free(r.vertex_uv);
    sl_free(r.texcoord);
    return status;
}
