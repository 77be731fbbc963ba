#include "base/text.h"
#include "meshio/ply_internal.h"

#include <inttypes.h>
#include <string.h>

enum { SHOWN = 24 };

void ply_header_free(ply_header *header)
{
    if (header == NULL) {
        return;
    }
    sl_free(header->property);
    sl_free(header->element);
    sl_free(header);
}

bool ply_next_line(const char **next, const char *end, ply_line *line)
{
    const char *p = *next;
    if (p == end) {
        return false;
    }
    line->p = p;
    while (p < end && *p != '\n' && *p != '\r') {
        p++;
    }
    line->end = p;
    line->number++;
    if (p < end) {
        p += *p == '\r' && p + 1 < end && p[1] == '\n' ? 2 : 1;
    }
    *next = p;
    return true;
}

static bool is_space(char c)
{
    return c == ' ' || c == '\t';
}

const char *ply_next_word(ply_line *line, int *size)
{
    while (line->p < line->end && is_space(*line->p)) {
        line->p++;
    }
    const char *word = line->p;
    while (line->p < line->end && !is_space(*line->p)) {
        line->p++;
    }
    const int64_t n = line->p - word;
    *size = n < INT32_MAX ? (int)n : INT32_MAX;
    return word;
}

bool ply_word_is(const char *word, int size, const char *text)
{
    return (size_t)size == strlen(text) && memcmp(word, text, (size_t)size) == 0;
}

static sl_status fail(const mesh_reader *reader, const ply_line *line, const char *hint, const char *reason)
{
    return mesh_fail(reader, SL_BAD_INPUT, line->number, -1, hint, "%s", reason);
}

static bool parse_type(const char *word, int size, ply_type *type)
{
    static const struct {
        const char *name;
        ply_type type;
    } names[] = {{"char", PLY_INT8},   {"int8", PLY_INT8},     {"uchar", PLY_UINT8},   {"uint8", PLY_UINT8},
                 {"short", PLY_INT16}, {"int16", PLY_INT16},   {"ushort", PLY_UINT16}, {"uint16", PLY_UINT16},
                 {"int", PLY_INT32},   {"int32", PLY_INT32},   {"uint", PLY_UINT32},   {"uint32", PLY_UINT32},
                 {"float", PLY_FLOAT}, {"float32", PLY_FLOAT}, {"double", PLY_DOUBLE}, {"float64", PLY_DOUBLE}};
    for (size_t k = 0; k < SL_COUNTOF(names); k++) {
        if (ply_word_is(word, size, names[k].name)) {
            *type = names[k].type;
            return true;
        }
    }
    return false;
}

/* What a property of an element means by its name. */
static ply_role role_of(ply_kind kind, const ply_property *property)
{
    static const struct {
        ply_kind kind;
        bool list;
        const char *name;
        ply_role role;
    } roles[] = {
        {PLY_VERTICES, false, "x", PLY_X},
        {PLY_VERTICES, false, "y", PLY_Y},
        {PLY_VERTICES, false, "z", PLY_Z},
        {PLY_VERTICES, false, "nx", PLY_NX},
        {PLY_VERTICES, false, "ny", PLY_NY},
        {PLY_VERTICES, false, "nz", PLY_NZ},
        {PLY_VERTICES, false, "red", PLY_RED},
        {PLY_VERTICES, false, "green", PLY_GREEN},
        {PLY_VERTICES, false, "blue", PLY_BLUE},
        {PLY_VERTICES, false, "s", PLY_U},
        {PLY_VERTICES, false, "t", PLY_V},
        {PLY_VERTICES, false, "u", PLY_U},
        {PLY_VERTICES, false, "v", PLY_V},
        {PLY_VERTICES, false, "texture_u", PLY_U},
        {PLY_VERTICES, false, "texture_v", PLY_V},
        {PLY_VERTICES, false, "texture_s", PLY_U},
        {PLY_VERTICES, false, "texture_t", PLY_V},
        {PLY_FACES, true, "vertex_indices", PLY_CORNERS},
        {PLY_FACES, true, "vertex_index", PLY_CORNERS},
        {PLY_FACES, true, "texcoord", PLY_TEXCOORD},
        {PLY_STRIPS, true, "vertex_indices", PLY_STRIP},
        {PLY_STRIPS, true, "vertex_index", PLY_STRIP},
    };
    for (size_t k = 0; k < SL_COUNTOF(roles); k++) {
        if (roles[k].kind == kind && roles[k].list == (property->count_type != PLY_NONE) &&
            ply_word_is(property->name, property->name_size, roles[k].name)) {
            return roles[k].role;
        }
    }
    return PLY_OTHER;
}

static sl_status read_format(const mesh_reader *reader, ply_header *header, ply_line *line)
{
    static const char *const names[] = {
        [PLY_ASCII] = "ascii", [PLY_LITTLE] = "binary_little_endian", [PLY_BIG] = "binary_big_endian"};
    int size;
    const char *word = ply_next_word(line, &size);
    for (size_t k = 0; k < SL_COUNTOF(names); k++) {
        if (ply_word_is(word, size, names[k])) {
            header->encoding = (ply_encoding)k;
            return SL_OK;
        }
    }
    return fail(reader, line, "", "the format is not ascii, binary_little_endian or binary_big_endian");
}

static sl_status read_element(const mesh_reader *reader, ply_header *header, ply_line *line)
{
    static const char *const names[] = {[PLY_VERTICES] = "vertex", [PLY_FACES] = "face", [PLY_STRIPS] = "tristrips"};
    int size, count_size;
    const char *name = ply_next_word(line, &size);
    const char *count = ply_next_word(line, &count_size);
    ply_element element = {.kind = PLY_ELSE, .first = header->properties, .last = header->properties};
    if (count_size == 0 || sl_parse_int(count, count + count_size, &element.count) != count + count_size ||
        element.count < 0) {
        return fail(reader, line, "", "an element needs a name and a number of rows");
    }
    for (int k = 0; k < (int)SL_COUNTOF(names); k++) {
        element.kind = ply_word_is(name, size, names[k]) ? (ply_kind)k : element.kind;
    }
    if (element.kind != PLY_ELSE && (header->kinds & 1u << element.kind) != 0) {
        return fail(reader, line, "", "this element is declared twice");
    }
    header->kinds |= 1u << element.kind;
    void *memory = header->element;
    const sl_status status =
        sl_reserve(&memory, &header->element_capacity, (int64_t)header->elements + 1, sizeof element);
    header->element = memory;
    if (status == SL_OK) {
        header->element[header->elements++] = element;
    }
    return status;
}

static sl_status read_property(const mesh_reader *reader, ply_header *header, ply_line *line)
{
    int size;
    ply_property property = {.count_type = PLY_NONE};
    if (header->elements == 0) {
        return fail(reader, line, "", "a property stands before any element");
    }
    const char *word = ply_next_word(line, &size);
    if (ply_word_is(word, size, "list")) {
        word = ply_next_word(line, &size);
        if (!parse_type(word, size, &property.count_type) || property.count_type >= PLY_FLOAT) {
            return fail(reader, line, "", "the length of a list is not of an integer type");
        }
        word = ply_next_word(line, &size);
    }
    if (!parse_type(word, size, &property.type)) {
        return mesh_fail(reader, SL_BAD_INPUT, line->number, -1, "", "'%.*s' is not a type of PLY",
                         size < SHOWN ? size : SHOWN, word);
    }
    property.name = ply_next_word(line, &property.name_size);
    if (property.name_size == 0) {
        return fail(reader, line, "", "a property has no name");
    }
    ply_element *element = &header->element[header->elements - 1];
    property.role = role_of(element->kind, &property);
    if ((element->roles & 1u << property.role) != 0) { /* a second "u" besides "s" is just another property */
        property.role = PLY_OTHER;
    }
    element->roles |= 1u << property.role;
    if ((property.role == PLY_CORNERS || property.role == PLY_STRIP) && property.type >= PLY_FLOAT) {
        return fail(reader, line, "", "vertex numbers are not of an integer type");
    }
    void *memory = header->property;
    const sl_status status =
        sl_reserve(&memory, &header->property_capacity, (int64_t)header->properties + 1, sizeof property);
    header->property = memory;
    if (status == SL_OK) {
        header->property[header->properties++] = property;
        element->last = header->properties;
    }
    return status;
}

/* A header without rows of the right kind is refused here, where the line is known. */
static sl_status check_header(const mesh_reader *reader, const ply_header *header, const ply_line *line)
{
    const uint32_t kinds = header->kinds;
    uint32_t roles = 0;
    for (int32_t e = 0; e < header->elements; e++) {
        roles |= header->element[e].roles;
    }
    const uint32_t xyz = 1u << PLY_X | 1u << PLY_Y | 1u << PLY_Z;
    if ((roles & xyz) != xyz) {
        return fail(reader, line, "", "the vertices have no x, y and z");
    }
    if ((kinds & (1u << PLY_FACES)) != 0 && (kinds & (1u << PLY_STRIPS)) != 0) {
        return mesh_fail(reader, SL_UNSUPPORTED, line->number, -1, "remove one of them",
                         "faces and triangle strips in one file are not read");
    }
    if ((roles & (1u << PLY_CORNERS | 1u << PLY_STRIP)) == 0) {
        return fail(reader, line, "", "there are no faces: no list vertex_indices in an element face or tristrips");
    }
    return SL_OK;
}

sl_status ply_read_header(mesh_reader *reader, ply_header *header)
{
    ply_line line = {0};
    const char *next = reader->begin;
    bool format = false, done = false;
    while (!done) {
        sl_status status = SL_OK;
        int size;
        if (!ply_next_line(&next, reader->end, &line)) {
            return fail(reader, &line, "the file may be cut short", "the header has no end_header");
        }
        const char *word = ply_next_word(&line, &size);
        if (line.number == 1) {
            status = ply_word_is(word, size, "ply")
                         ? SL_OK
                         : fail(reader, &line, "check that this is a PLY file", "the first line is not 'ply'");
        } else if (ply_word_is(word, size, "format")) {
            status = read_format(reader, header, &line);
            format = true;
        } else if (ply_word_is(word, size, "element")) {
            status = read_element(reader, header, &line);
        } else if (ply_word_is(word, size, "property")) {
            status = read_property(reader, header, &line);
        } else if (ply_word_is(word, size, "end_header")) {
            done = true;
        } else if (size > 0 && !ply_word_is(word, size, "comment") && !ply_word_is(word, size, "obj_info")) {
            status = fail(reader, &line, "", "this is not a line of a PLY header");
        }
        if (status != SL_OK) {
            return status;
        }
    }
    if (!format) {
        return fail(reader, &line, "", "the header has no format");
    }
    const bool lone_cr = reader->begin[3] == '\r' && reader->begin[4] != '\n'; /* then an LF belongs to the body */
    header->body = lone_cr && next - line.end == 2 ? next - 1 : next;
    header->lines = line.number;
    return check_header(reader, header, &line);
}
