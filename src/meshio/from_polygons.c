#include "base/memory.h"
#include "base/text.h"
#include "meshio/meshfile.h"

#include <stdio.h>
#include <string.h>

/* Longest line of a vertex, and of one corner of a face, in bytes. */
enum { VERTEX_TEXT = 3 * SL_DOUBLE_TEXT + 8, CORNER_TEXT = 16 };

static char *put_text(char *at, const char *text)
{
    const size_t n = strlen(text);
    memcpy(at, text, n);
    return at + n;
}

static char *put_vertex(char *at, const double x[3])
{
    char number[SL_DOUBLE_TEXT];
    at = put_text(at, "v");
    for (int k = 0; k < 3; k++) {
        sl_format_double(x[k], number);
        at = put_text(put_text(at, " "), number);
    }
    return put_text(at, "\n");
}

static char *put_face(char *at, const int32_t *index, int32_t n)
{
    char number[CORNER_TEXT];
    at = put_text(at, "f");
    for (int32_t k = 0; k < n; k++) {
        snprintf(number, sizeof number, " %lld", (long long)index[k] + 1);
        at = put_text(at, number);
    }
    return put_text(at, "\n");
}

/* A file read keeps its source so that writing it loses nothing: polygons get the source they would have had. */
sl_status sl_meshfile_from_polygons(const sl_polygons *polygons, sl_meshfile **out, sl_diag *diag)
{
    *out = NULL;
    int64_t room = 0, part = 0;
    const int32_t corners = polygons->face_first[polygons->nf];
    if (sl_mul_size(polygons->nv, VERTEX_TEXT, &room) != SL_OK || sl_mul_size(corners, CORNER_TEXT, &part) != SL_OK ||
        sl_add_size(room, part, &room) != SL_OK || sl_add_size(room, 2 * (int64_t)polygons->nf + 1, &room) != SL_OK) {
        return SL_OUT_OF_MEMORY;
    }
    char *text = sl_alloc(room, 1);
    if (text == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    char *at = text;
    for (int32_t v = 0; v < polygons->nv; v++) {
        at = put_vertex(at, polygons->xyz + 3 * (int64_t)v);
    }
    for (int32_t f = 0; f < polygons->nf; f++) {
        at = put_face(at, polygons->index + polygons->face_first[f],
                      polygons->face_first[f + 1] - polygons->face_first[f]);
    }
    const sl_status status = sl_meshfile_parse("polygons.obj", text, at - text, out, diag);
    sl_free(text);
    return status;
}
