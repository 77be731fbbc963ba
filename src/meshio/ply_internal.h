/* The header of a PLY file and its values, shared by reader and writer. Included by meshio only. */
#ifndef SL_MESHIO_PLY_INTERNAL_H
#define SL_MESHIO_PLY_INTERNAL_H

#include "meshio/meshfile_internal.h"

typedef enum ply_encoding { PLY_ASCII, PLY_LITTLE, PLY_BIG } ply_encoding;

typedef enum ply_type {
    PLY_NONE, /* as a count type: no list */
    PLY_INT8,
    PLY_UINT8,
    PLY_INT16,
    PLY_UINT16,
    PLY_INT32,
    PLY_UINT32,
    PLY_FLOAT,
    PLY_DOUBLE
} ply_type;

/* What a property means to us. */
typedef enum ply_role {
    PLY_OTHER,
    PLY_X,
    PLY_Y,
    PLY_Z,
    PLY_NX,
    PLY_NY,
    PLY_NZ,
    PLY_RED,
    PLY_GREEN,
    PLY_BLUE,
    PLY_U,
    PLY_V,
    PLY_CORNERS,  /* list of vertex numbers of a face */
    PLY_TEXCOORD, /* list of 2 numbers a corner */
    PLY_STRIP,    /* list of vertex numbers of triangle strips, -1 starts another */
    PLY_ROLES
} ply_role;

typedef enum ply_kind { PLY_VERTICES, PLY_FACES, PLY_STRIPS, PLY_ELSE } ply_kind;

typedef struct ply_property {
    const char *name; /* in the source's bytes, name_size long */
    int name_size;
    ply_type count_type, type; /* count_type PLY_NONE: a single value */
    ply_role role;
} ply_property;

typedef struct ply_element {
    ply_kind kind;
    int64_t count;
    int32_t first, last;      /* properties [first, last) of the header */
    uint32_t roles;           /* bit r: some property has role r */
    const char *body, *after; /* its rows in the source's bytes */
} ply_element;

typedef struct ply_header {
    ply_encoding encoding;
    ply_property *property;
    ply_element *element;
    int32_t properties, elements;
    int64_t property_capacity, element_capacity;
    uint32_t kinds;   /* bit k: there is an element of kind k */
    const char *body; /* the first byte after the header */
    int64_t lines;    /* of the header */
} ply_header;

/* A place in the body. */
typedef struct ply_cursor {
    const char *p, *end;
    int64_t line; /* of ascii */
    ply_encoding encoding;
} ply_cursor;

/* The rest of a line of the header. */
typedef struct ply_line {
    const char *p, *end;
    int64_t number;
} ply_line;

/* Parses the header; *header is owned by the source in every case. */
SL_NODISCARD sl_status ply_read_header(mesh_reader *reader, ply_header *header);

/* Moves to the next line of the header, which ends at LF, CR LF or CR; false at the end of the bytes. *next is where
 * the line after it starts, on entry and on return. */
bool ply_next_line(const char **next, const char *end, ply_line *line);

/* The next word of a line: its start, *size 0 when there is none. */
const char *ply_next_word(ply_line *line, int *size);

/* Is this word that text? */
bool ply_word_is(const char *word, int size, const char *text);

/* Reads one value as a double. False when the bytes end or hold no such number; the cursor then stands at the trouble.
 * Numbers out of an integer type's range are no numbers of that type. */
bool ply_read_value(ply_cursor *at, ply_type type, double *value);

/* Reads how many values a property has in this row (1 when it is no list). False as above, or for a negative count or
 * more than the rest of the bytes can hold. */
bool ply_read_count(ply_cursor *at, const ply_property *property, int64_t *count);

/* Skips `count` values. */
bool ply_skip_values(ply_cursor *at, ply_type type, int64_t count);

/* Moves past the blanks and line ends before the next value of an ascii body; nothing in a binary one. */
void ply_skip_space(ply_cursor *at);

/* Bytes of a binary value. */
int ply_type_size(ply_type type);

/* Appends a value in an encoding; doubles exactly, integers as such. In ascii a blank is put before it. */
void ply_put(sl_writer *writer, ply_encoding encoding, ply_type type, double value);

/* What writers of new files share: header lines of polygons, a vertex, the corners of a face. */
ply_type ply_count_type(int64_t largest);
int64_t ply_largest_degree(const sl_polygons *polygons);
void ply_put_polygon_header(sl_writer *writer, const sl_polygons *polygons, const char *vertex_properties);
void ply_put_vertex(sl_writer *writer, const double *xyz);
void ply_put_corners(sl_writer *writer, ply_encoding encoding, ply_type count_type, const sl_polygons *polygons,
                     int32_t f);

#endif
