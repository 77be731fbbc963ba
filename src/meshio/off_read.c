/* OFF and its variants by prefix: ST texture coordinates, C colours, N normals. One vertex or face a line. */
#include "base/text.h"
#include "meshio/meshfile_internal.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

enum { MAX_NUMBERS = 16 };

typedef struct off_header {
    bool texture, color, normal, plain; /* ST, C, N prefixes; plain = no keyword at all */
    bool four, n_dimensional, binary;
} off_header;

typedef struct off_reader {
    mesh_reader *out;
    const char *p, *end, *line_end; /* the rest of the current line is [p, line_end) */
    int64_t line;
    off_header header;
    int64_t vertices; /* as the header says */
    double *vertex_uv;
    int64_t uv_capacity;
    int64_t rgb_capacity, normal_capacity;
} off_reader;

static bool is_space(char c)
{
    return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

static void skip_space(off_reader *r)
{
    while (r->p < r->line_end && is_space(*r->p)) {
        r->p++;
    }
}

/* Moves to the next line that holds something besides blanks and comments; false at the end of the file. */
static bool next_line(off_reader *r)
{
    const char *start = r->line_end;
    while (start < r->end) {
        if (r->line > 0) { /* step over the line end: LF, CR LF or CR */
            start += *start == '\r' && start + 1 < r->end && start[1] == '\n' ? 2 : 1;
        }
        if (start == r->end && r->line > 0) {
            break; /* the last line end starts no line */
        }
        r->line++;
        const char *stop = start;
        while (stop < r->end && *stop != '\n' && *stop != '\r') {
            stop++;
        }
        r->p = start;
        r->line_end = stop;
        const char *comment = memchr(start, '#', (size_t)(stop - start));
        start = stop;
        skip_space(r);
        if (r->p < r->line_end && r->p != comment) {
            return true;
        }
    }
    r->p = r->line_end = r->end;
    return false;
}

/* Is the rest of the line empty or a comment? */
static bool line_done(off_reader *r)
{
    skip_space(r);
    return r->p == r->line_end || *r->p == '#';
}

/* Reads "[ST][C][N][4][n]OFF" at p; returns what follows, or NULL when that does not stand there. */
static const char *match_keyword(const char *p, const char *end, off_header *header)
{
    *header = (off_header){0};
    if (end - p >= 2 && memcmp(p, "ST", 2) == 0) {
        header->texture = true;
        p += 2;
    }
    const char marks[] = {'C', 'N', '4', 'n'};
    bool *const flags[] = {&header->color, &header->normal, &header->four, &header->n_dimensional};
    for (size_t k = 0; k < SL_COUNTOF(marks); k++) {
        if (p < end && *p == marks[k]) {
            *flags[k] = true;
            p++;
        }
    }
    if (end - p < 3 || memcmp(p, "OFF", 3) != 0) {
        return NULL;
    }
    p += 3;
    return p == end || is_space(*p) || *p == '\n' || *p == '\r' || *p == '#' ? p : NULL;
}

bool off_recognise(const char *begin, const char *end)
{
    off_header header;
    off_reader r = {.p = begin, .end = end, .line_end = begin};
    return next_line(&r) && match_keyword(r.p, r.line_end, &header) != NULL;
}

static sl_status fail(const off_reader *r, const char *hint, const char *reason)
{
    return mesh_fail(r->out, SL_BAD_INPUT, r->line, -1, hint, "%s", reason);
}

static sl_status ends_early(const off_reader *r)
{
    return mesh_fail(r->out, SL_BAD_INPUT, r->line, -1, "the file may be cut short or its counts wrong",
                     "the file ends after %" PRId64 " vertices and %" PRId64 " faces", r->out->vertices, r->out->faces);
}

/* A whole number of the current line. */
static sl_status read_count(off_reader *r, const char *what, int64_t *value)
{
    skip_space(r);
    const char *after = sl_parse_int(r->p, r->line_end, value);
    if (after == r->p || (after < r->line_end && !is_space(*after) && *after != '#')) {
        return mesh_fail(r->out, SL_BAD_INPUT, r->line, -1, "", "%s is not a whole number", what);
    }
    r->p = after;
    return SL_OK;
}

static sl_status read_header(off_reader *r, int64_t *faces)
{
    if (!next_line(r)) {
        return fail(r, "", "the file holds nothing but comments");
    }
    const char *after = match_keyword(r->p, r->line_end, &r->header);
    if (after != NULL) {
        r->p = after;
        skip_space(r);
        r->header.binary = r->line_end - r->p >= 6 && memcmp(r->p, "BINARY", 6) == 0;
    }
    if (r->header.four || r->header.n_dimensional || r->header.binary) {
        return mesh_fail(r->out, SL_UNSUPPORTED, r->line, -1, "convert it to plain OFF, OBJ or PLY",
                         "4OFF, nOFF and binary OFF files are not read");
    }
    if (after == NULL && (r->p == r->line_end || *r->p < '0' || *r->p > '9')) {
        return fail(r, "check that this is an OFF file", "the keyword OFF is missing");
    }
    if (line_done(r) && !next_line(r)) {
        return fail(r, "", "the numbers of vertices and faces are missing");
    }
    sl_status status = read_count(r, "the number of vertices", &r->vertices);
    if (status == SL_OK) {
        status = read_count(r, "the number of faces", faces);
    }
    if (status != SL_OK) {
        return status;
    }
    const int64_t bytes = r->end - r->p;
    if (r->vertices < 0 || *faces < 0 || r->vertices > bytes / 6 + 1 || *faces > bytes / 2 + 1) {
        return mesh_fail(r->out, SL_BAD_INPUT, r->line, -1, "correct the counts",
                         "%" PRId64 " vertices and %" PRId64 " faces cannot stand in the %" PRId64 " bytes that follow",
                         r->vertices, *faces, bytes);
    }
    return SL_OK;
}

/* All numbers of the current line, at most MAX_NUMBERS of them kept. */
static sl_status read_numbers(off_reader *r, double *number, int *count)
{
    for (*count = 0; !line_done(r);) {
        double value;
        const char *after = sl_parse_double(r->p, r->line_end, &value);
        if (after == r->p || (after < r->line_end && !is_space(*after) && *after != '#')) {
            return fail(r, "", "there is something here that is not a number");
        }
        r->p = after;
        if (*count < MAX_NUMBERS) {
            number[(*count)++] = value;
        }
    }
    return SL_OK;
}

static sl_status keep_color(off_reader *r, const double *color)
{
    sl_meshfile *file = r->out->file;
    const int64_t v = r->out->vertices - 1;
    const sl_status status = mesh_grow_double(&file->vertex_rgb, &r->rgb_capacity, 3 * v + 3);
    if (status != SL_OK) {
        return status;
    }
    const double top = fmax(color[0], fmax(color[1], color[2]));
    for (int k = 0; k < 3; k++) { /* COFF has either 0..1 or 0..255 and does not say which */
        file->vertex_rgb[3 * v + k] = top > 1.0 ? color[k] / 255.0 : color[k];
    }
    return SL_OK;
}

/* x y z [nx ny nz] [colour] [s t] */
static sl_status read_vertex(off_reader *r)
{
    double x[MAX_NUMBERS];
    int n;
    sl_status status;
    SL_TRY(read_numbers(r, x, &n));
    const int before_color = 3 + (r->header.normal ? 3 : 0), after_color = r->header.texture ? 2 : 0;
    if (n < before_color + after_color) {
        return mesh_fail(r->out, SL_BAD_INPUT, r->line, -1, "", "a vertex needs %d numbers, this one has %d",
                         before_color + after_color, n);
    }
    if (!(isfinite(x[0]) && isfinite(x[1]) && isfinite(x[2]))) {
        return fail(r, "repair or remove this vertex", "a coordinate of this vertex is not finite");
    }
    SL_TRY(mesh_add_vertex(r->out, x));
    const int64_t v = r->out->vertices - 1;
    if (r->header.texture) {
        const double *st = x + n - 2;
        const bool usable = isfinite(st[0]) && isfinite(st[1]);
        SL_TRY(mesh_grow_double(&r->vertex_uv, &r->uv_capacity, 2 * v + 2));
        r->vertex_uv[2 * v] = usable ? st[0] : (double)NAN;
        r->vertex_uv[2 * v + 1] = usable ? st[1] : (double)NAN;
    }
    if (r->header.color) {
        static const double none[3] = {(double)NAN, (double)NAN, (double)NAN};
        SL_TRY(keep_color(r, n - after_color >= before_color + 3 ? x + before_color : none));
    }
    if (r->header.normal) {
        SL_TRY(mesh_grow_double(&r->out->file->normal, &r->normal_capacity, 3 * v + 3));
        memcpy(r->out->file->normal + 3 * v, x + 3, 3 * sizeof *x);
    }
cleanup:
    return status;
}

/* n, then n vertex numbers, then perhaps a colour. */
static sl_status read_face(off_reader *r)
{
    int64_t degree;
    sl_status status;
    SL_TRY(read_count(r, "the number of corners", &degree));
    if (degree < 3) {
        return mesh_fail(r->out, SL_BAD_INPUT, r->line, -1, "remove this face",
                         "a face needs 3 corners, this one has %" PRId64, degree);
    }
    for (int64_t k = 0; k < degree; k++) {
        int64_t vertex;
        if (line_done(r)) {
            return mesh_fail(r->out, SL_BAD_INPUT, r->line, -1, "",
                             "a face of %" PRId64 " corners names only %" PRId64 " vertices", degree, k);
        }
        SL_TRY(read_count(r, "a vertex number", &vertex));
        if (vertex < 0 || vertex >= r->vertices) {
            return mesh_fail(r->out, SL_BAD_INPUT, r->line, -1, "OFF counts from 0",
                             "a face uses vertex %" PRId64 ", but the file has %" PRId64, vertex, r->vertices);
        }
        SL_TRY(mesh_add_corner(r->out, (int32_t)vertex));
    }
    r->out->file->extras.face_colors += !line_done(r);
    SL_TRY(mesh_end_face(r->out));
cleanup:
    return status;
}

/* Per-vertex normals and UVs, seen from the corners. */
static sl_status spread(off_reader *r)
{
    sl_meshfile *file = r->out->file;
    const int64_t corners = r->out->corners;
    if (r->header.normal) {
        file->normals = (int32_t)r->out->vertices;
        file->corner_normal = sl_copy(file->index, corners, sizeof *file->index);
        if (file->corner_normal == NULL) {
            return SL_OUT_OF_MEMORY;
        }
    }
    if (r->header.texture) {
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

sl_status off_read(mesh_reader *reader)
{
    off_reader r = {.out = reader, .p = reader->begin, .end = reader->end, .line_end = reader->begin};
    int64_t faces;
    sl_status status;
    SL_TRY(read_header(&r, &faces));
    for (int64_t v = 0; v < r.vertices; v++) {
        SL_TRY(next_line(&r) ? read_vertex(&r) : ends_early(&r));
    }
    for (int64_t f = 0; f < faces; f++) {
        SL_TRY(next_line(&r) ? read_face(&r) : ends_early(&r));
    }
    if (faces == 0) {
        status = fail(&r, "", "there is no face in this file");
        goto cleanup;
    }
    SL_TRY(spread(&r));
cleanup:
    sl_free(r.vertex_uv);
    return status;
}
