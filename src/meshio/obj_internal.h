/* Statements of an OBJ file, shared by its reader and its writer. Included by meshio only. */
#ifndef SL_MESHIO_OBJ_INTERNAL_H
#define SL_MESHIO_OBJ_INTERNAL_H

#include "base/status.h"

typedef struct obj_cursor {
    const char *p, *end;
    int64_t line; /* 1-based line of p */
} obj_cursor;

typedef enum obj_word {
    OBJ_EMPTY, /* a blank line or a comment */
    OBJ_VERTEX,
    OBJ_TEXTURE,
    OBJ_NORMAL,
    OBJ_FACE,
    OBJ_LINE,
    OBJ_POINT,
    OBJ_NAME, /* o g s usemtl mtllib */
    OBJ_OTHER
} obj_word;

static inline bool obj_is_newline(char c)
{
    return c == '\n' || c == '\r';
}

static inline bool obj_is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

/* Consumes one line end of any kind: LF, CR LF, CR. */
static inline void obj_skip_newline(obj_cursor *at)
{
    if (at->p < at->end && obj_is_newline(*at->p)) {
        at->p += *at->p == '\r' && at->p + 1 < at->end && at->p[1] == '\n' ? 2 : 1;
        at->line++;
    }
}

/* Is p a backslash that joins this line with the next? */
static inline bool obj_at_continuation(const obj_cursor *at)
{
    return *at->p == '\\' && at->p + 1 < at->end && obj_is_newline(at->p[1]);
}

static inline void obj_skip_blank(obj_cursor *at)
{
    while (at->p < at->end) {
        if (obj_is_blank(*at->p)) {
            at->p++;
        } else if (obj_at_continuation(at)) {
            at->p++;
            obj_skip_newline(at);
        } else {
            return;
        }
    }
}

/* Does the statement end at p? */
static inline bool obj_at_end(const obj_cursor *at)
{
    return at->p == at->end || obj_is_newline(*at->p) || *at->p == '#';
}

/* Does a number or word end at p? */
static inline bool obj_at_gap(const obj_cursor *at)
{
    return obj_at_end(at) || obj_is_blank(*at->p) || obj_at_continuation(at);
}

/* Moves p to the end of the statement's last line. A comment is never continued: exporters write paths into comments
 * that end in a backslash. */
void obj_skip_statement(obj_cursor *at);

/* Reads the first word of a statement; p stands after it and the blanks that follow. */
obj_word obj_read_word(obj_cursor *at);

#endif
