/* Writes a PLY again with UVs in it: everything else is copied, in the encoding it came in. */
#include "meshio/ply_internal.h"

#include <inttypes.h>
#include <math.h>

typedef struct ply_copier {
    sl_writer *writer;
    const sl_meshfile *file;
    const ply_header *header;
    const double *uv;
    sl_polygons polygons;
    ply_type texcoord_count; /* type of the length of the lists written */
} ply_copier;

static void put_span(sl_writer *writer, const char *begin, const char *end)
{
    sl_writer_bytes(writer, begin, end - begin);
}

static bool is_dropped(const ply_property *property)
{
    return property->role == PLY_U || property->role == PLY_V || property->role == PLY_TEXCOORD;
}

static void put_texcoord_line(const ply_copier *c)
{
    sl_writer_format(c->writer, "property list %s double texcoord\n", c->texcoord_count == PLY_UINT8 ? "uchar" : "int");
}

/* An element's lines as they stand, but triangle strips announce the faces they became. */
static void put_element_line(const ply_copier *c, const ply_element *element, const char *begin, const char *end)
{
    if (element->kind != PLY_STRIPS) {
        put_span(c->writer, begin, end);
        sl_writer_bytes(c->writer, "\n", 1);
        return;
    }
    sl_writer_format(c->writer, "element face %" PRId32 "\nproperty list uchar int vertex_indices\n", c->file->nf);
    put_texcoord_line(c);
}

static void put_property_line(const ply_copier *c, const ply_element *element, int32_t k, const char *begin,
                              const char *end)
{
    if (element->kind != PLY_STRIPS && !is_dropped(&c->header->property[k])) {
        put_span(c->writer, begin, end);
        sl_writer_bytes(c->writer, "\n", 1);
    }
    if (element->kind == PLY_FACES && k == element->last - 1) {
        put_texcoord_line(c);
    }
}

static void put_header(const ply_copier *c)
{
    const struct sl_meshfile_source *source = c->file->source;
    const char *next = source->data + source->begin;
    ply_line line = {0};
    int32_t e = -1, k = 0;
    while (line.number < c->header->lines && ply_next_line(&next, source->data + source->size, &line)) {
        const char *begin = line.p, *end = line.end;
        int size;
        const char *word = ply_next_word(&line, &size);
        if (ply_word_is(word, size, "element")) {
            put_element_line(c, &c->header->element[++e], begin, end);
        } else if (ply_word_is(word, size, "property")) {
            put_property_line(c, &c->header->element[e], k++, begin, end);
        } else {
            put_span(c->writer, begin, end);
            sl_writer_bytes(c->writer, "\n", 1);
        }
    }
}

/* Copies the kept properties of one row. The bytes were read before, so they can be read again. */
static sl_status copy_row(const ply_copier *c, const ply_element *element, ply_cursor *at)
{
    bool first = true;
    for (int32_t k = element->first; k < element->last; k++) {
        const ply_property *property = &c->header->property[k];
        int64_t count;
        ply_skip_space(at);
        const char *begin = at->p;
        if (!ply_read_count(at, property, &count) || !ply_skip_values(at, property->type, count)) {
            return SL_INTERNAL;
        }
        if (is_dropped(property)) {
            continue;
        }
        if (at->encoding == PLY_ASCII && !first) {
            sl_writer_bytes(c->writer, " ", 1);
        }
        put_span(c->writer, begin, at->p);
        first = false;
    }
    return SL_OK;
}

/* The list of a face's UVs: empty when no corner has any. */
static void put_texcoord(const ply_copier *c, int32_t f)
{
    const int64_t first = c->file->face_first[f], last = c->file->face_first[f + 1];
    bool any = false;
    for (int64_t k = 2 * first; k < 2 * last; k++) {
        any = any || !isnan(c->uv[k]);
    }
    ply_put(c->writer, c->header->encoding, c->texcoord_count, any ? (double)(2 * (last - first)) : 0.0);
    for (int64_t k = 2 * first; any && k < 2 * last; k++) {
        if (c->header->encoding == PLY_ASCII) {
            sl_writer_bytes(c->writer, " ", 1);
            uv_write_number(c->writer, c->uv[k]);
        } else {
            ply_put(c->writer, c->header->encoding, PLY_DOUBLE, c->uv[k]);
        }
    }
}

static void end_row(const ply_copier *c)
{
    if (c->header->encoding == PLY_ASCII) {
        sl_writer_bytes(c->writer, "\n", 1);
    }
}

static sl_status copy_rows(const ply_copier *c, const ply_element *element)
{
    ply_cursor at = {element->body, element->after, 0, c->header->encoding};
    for (int64_t row = 0; row < element->count; row++) {
        const sl_status status = copy_row(c, element, &at);
        if (status != SL_OK) {
            return status;
        }
        if (element->kind == PLY_FACES) {
            put_texcoord(c, (int32_t)row);
        }
        end_row(c);
    }
    return SL_OK;
}

static void put_strip_faces(const ply_copier *c)
{
    for (int32_t f = 0; f < c->file->nf; f++) {
        ply_put_corners(c->writer, c->header->encoding, PLY_UINT8, &c->polygons, f);
        put_texcoord(c, f);
        end_row(c);
    }
}

static sl_status put_body(const ply_copier *c)
{
    for (int32_t e = 0; e < c->header->elements; e++) {
        const ply_element *element = &c->header->element[e];
        const bool has_uv = (element->roles & (1u << PLY_U | 1u << PLY_V)) != 0;
        if (element->kind == PLY_STRIPS) {
            put_strip_faces(c);
        } else if (element->kind == PLY_FACES || has_uv) {
            const sl_status status = copy_rows(c, element);
            if (status != SL_OK) {
                return status;
            }
        } else {
            put_span(c->writer, element->body, element->after);
            if (element->after > element->body) {
                end_row(c);
            }
        }
    }
    return SL_OK;
}

sl_status ply_rewrite(sl_writer *writer, const sl_meshfile *file, const double *uv)
{
    const struct sl_meshfile_source *source = file->source;
    if (uv == NULL) {
        sl_writer_bytes(writer, source->data + source->begin, source->size - source->begin);
        return SL_OK;
    }
    ply_copier c = {.writer = writer, .file = file, .header = source->ply, .uv = uv};
    sl_meshfile_polygons(file, &c.polygons);
    c.texcoord_count = ply_count_type(2 * ply_largest_degree(&c.polygons));
    put_header(&c);
    return put_body(&c);
}
