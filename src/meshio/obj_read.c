#include "base/text.h"
#include "meshio/meshfile_internal.h"
#include "meshio/obj_internal.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

enum { MAX_VERTEX_NUMBERS = 7, SHOWN = 24 };

/* The largest number used to refer to something, and where: OBJ may refer forward, so it is checked at the end. */
typedef struct reference {
    int64_t largest, line; /* 0-based; -1 = never */
} reference;

typedef struct obj_reader {
    mesh_reader *out;
    obj_cursor at;
    double *texture; /* textures x 2 */
    int64_t textures, texture_capacity;
    int64_t normals, normal_capacity;
    int32_t *corner_texture; /* filled lazily: up to textured corners, the rest would be -1 */
    int64_t textured, corner_texture_capacity;
    int64_t with_normal, corner_normal_capacity; /* likewise for out->file->corner_normal */
    int64_t colored, rgb_capacity;               /* likewise for out->file->vertex_rgb, in vertices */
    reference vertex_use, texture_use, normal_use;
} obj_reader;

/* A statement that cannot be understood at p: shows the word there. */
static sl_status bad_word(const obj_reader *r, const char *wanted)
{
    const char *p = r->at.p;
    int n = 0;
    while (n < SHOWN && p + n < r->at.end && p[n] > ' ' && p[n] < 127) {
        n++;
    }
    const bool comma = n > 0 && memchr(p, ',', (size_t)n) != NULL;
    if (n == 0) {
        return mesh_fail(r->out, SL_BAD_INPUT, r->at.line, -1, "", "%s is missing", wanted);
    }
    return mesh_fail(r->out, SL_BAD_INPUT, r->at.line, -1, comma ? "write decimals with a point" : "",
                     "'%.*s' is not %s", n, p, wanted);
}

/* Reads the numbers of a statement; at most `room` are kept, *count tells how many there were. */
static sl_status read_numbers(obj_reader *r, double *number, int room, int *count)
{
    for (*count = 0; !obj_at_end(&r->at); (*count)++) {
        double value;
        const char *after = sl_parse_double(r->at.p, r->at.end, &value);
        obj_cursor next = {after, r->at.end, r->at.line};
        if (after == r->at.p || !obj_at_gap(&next)) {
            return bad_word(r, "a number");
        }
        r->at.p = after;
        if (*count < room) {
            number[*count] = value;
        }
        obj_skip_blank(&r->at);
    }
    return SL_OK;
}

static sl_status too_few(const obj_reader *r, const char *what, int wanted, int found)
{
    return mesh_fail(r->out, SL_BAD_INPUT, r->at.line, -1, "", "%s needs %d numbers, this one has %d", what, wanted,
                     found);
}

/* Colours are rare: the array starts with the first vertex that has one. */
static sl_status set_color(obj_reader *r, int64_t vertex, const double *rgb)
{
    sl_meshfile *file = r->out->file;
    const sl_status status = mesh_grow_double(&file->vertex_rgb, &r->rgb_capacity, 3 * vertex + 3);
    if (status != SL_OK) {
        return status;
    }
    for (int64_t k = 3 * r->colored; k < 3 * vertex; k++) {
        file->vertex_rgb[k] = (double)NAN;
    }
    if (rgb != NULL) {
        memcpy(file->vertex_rgb + 3 * vertex, rgb, 3 * sizeof *rgb);
    }
    r->colored = vertex + (rgb != NULL);
    return SL_OK;
}

static sl_status read_vertex(obj_reader *r)
{
    double x[MAX_VERTEX_NUMBERS];
    int n;
    sl_status status = read_numbers(r, x, MAX_VERTEX_NUMBERS, &n);
    if (status != SL_OK) {
        return status;
    }
    if (n < 3) {
        return too_few(r, "a vertex", 3, n);
    }
    if (!(isfinite(x[0]) && isfinite(x[1]) && isfinite(x[2]))) {
        return mesh_fail(r->out, SL_BAD_INPUT, r->at.line, -1, "repair or remove this vertex",
                         "a coordinate of this vertex is not finite");
    }
    status = mesh_add_vertex(r->out, x);
    if (status == SL_OK && n >= 6) { /* x y z r g b; a fourth number alone is a weight, which polygons do not use */
        status = set_color(r, r->out->vertices - 1, x + 3);
    }
    return status;
}

static sl_status read_texture(obj_reader *r)
{
    double uv[3] = {0.0, 0.0, 0.0};
    int n;
    sl_status status = read_numbers(r, uv, 3, &n);
    if (status == SL_OK && n < 1) {
        status = too_few(r, "a texture vertex", 1, n);
    }
    if (status == SL_OK && 2 * r->textures + 2 > r->texture_capacity) {
        status = mesh_grow_double(&r->texture, &r->texture_capacity, 2 * r->textures + 2);
    }
    if (status == SL_OK) {
        const bool usable = isfinite(uv[0]) && isfinite(uv[1]);
        r->texture[2 * r->textures] = usable ? uv[0] : (double)NAN;
        r->texture[2 * r->textures + 1] = usable ? uv[1] : (double)NAN;
        r->textures++;
    }
    return status;
}

static sl_status read_normal(obj_reader *r)
{
    double n[3];
    int count;
    sl_status status = read_numbers(r, n, 3, &count);
    if (status == SL_OK && count < 3) {
        status = too_few(r, "a normal", 3, count);
    }
    if (status == SL_OK) {
        status = mesh_grow_double(&r->out->file->normal, &r->normal_capacity, 3 * r->normals + 3);
    }
    if (status == SL_OK) {
        memcpy(r->out->file->normal + 3 * r->normals, n, sizeof n);
        r->normals++;
    }
    return status;
}

/* Reads one number of a corner, 1-based or counted back from the `count` things so far, as 0-based *index. */
static sl_status read_reference(obj_reader *r, const char *what, int64_t count, reference *use, int32_t *index)
{
    int64_t number;
    const char *after = sl_parse_int(r->at.p, r->at.end, &number);
    if (after == r->at.p) {
        return bad_word(r, "the number of a vertex");
    }
    r->at.p = after;
    if (number == 0) {
        return mesh_fail(r->out, SL_BAD_INPUT, r->at.line, -1, "OBJ counts from 1", "a face uses %s 0", what);
    }
    const int64_t k = number > 0 ? number - 1 : number + count;
    if (k < 0 || k >= INT32_MAX) {
        return mesh_fail(r->out, SL_BAD_INPUT, r->at.line, -1, "",
                         "a face uses %s %" PRId64 " where there are %" PRId64, what, number, count);
    }
    if (k > use->largest) {
        *use = (reference){k, r->at.line};
    }
    *index = (int32_t)k;
    return SL_OK;
}

/* array[corner] = value, with -1 for the corners passed over since `filled`. */
static sl_status set_lazily(int32_t **array, int64_t *capacity, int64_t *filled, int64_t corner, int32_t value)
{
    if (corner >= *capacity) {
        const sl_status status = mesh_grow_int(array, capacity, corner + 1);
        if (status != SL_OK) {
            return status;
        }
    }
    for (int64_t c = *filled; c < corner; c++) {
        (*array)[c] = -1;
    }
    (*array)[corner] = value;
    *filled = corner + 1;
    return SL_OK;
}

/* v, v/vt, v//vn or v/vt/vn. */
static sl_status read_corner(obj_reader *r)
{
    const int64_t corner = r->out->corners;
    int32_t k = -1;
    sl_status status;
    SL_TRY(read_reference(r, "vertex", r->out->vertices, &r->vertex_use, &k));
    SL_TRY(mesh_add_corner(r->out, k));
    if (r->at.p < r->at.end && *r->at.p == '/') {
        r->at.p++;
        if (!obj_at_gap(&r->at) && *r->at.p != '/') {
            SL_TRY(read_reference(r, "texture vertex", r->textures, &r->texture_use, &k));
            SL_TRY(set_lazily(&r->corner_texture, &r->corner_texture_capacity, &r->textured, corner, k));
        }
    }
    if (r->at.p < r->at.end && *r->at.p == '/') {
        r->at.p++;
        if (!obj_at_gap(&r->at)) {
            SL_TRY(read_reference(r, "normal", r->normals, &r->normal_use, &k));
            SL_TRY(set_lazily(&r->out->file->corner_normal, &r->corner_normal_capacity, &r->with_normal, corner, k));
        }
    }
    if (!obj_at_gap(&r->at)) {
        return bad_word(r, "a corner (v, v/vt, v//vn or v/vt/vn)");
    }
    obj_skip_blank(&r->at);
cleanup:
    return status;
}

static sl_status read_face(obj_reader *r)
{
    const int64_t first = r->out->corners;
    while (!obj_at_end(&r->at)) {
        const sl_status status = read_corner(r);
        if (status != SL_OK) {
            return status;
        }
    }
    if (r->out->corners - first < 3) {
        return mesh_fail(r->out, SL_BAD_INPUT, r->at.line, -1, "remove it, or write it as l or p",
                         "a face needs 3 corners, this one has %" PRId64, r->out->corners - first);
    }
    return mesh_end_face(r->out);
}

static sl_status read_statement(obj_reader *r)
{
    sl_meshfile_extras *extras = &r->out->file->extras;
    switch (obj_read_word(&r->at)) {
    case OBJ_VERTEX:
        return read_vertex(r);
    case OBJ_TEXTURE:
        return read_texture(r);
    case OBJ_NORMAL:
        return read_normal(r);
    case OBJ_FACE:
        return read_face(r);
    case OBJ_LINE:
        extras->lines++;
        break;
    case OBJ_POINT:
        extras->points++;
        break;
    case OBJ_NAME:
        extras->names++;
        break;
    case OBJ_OTHER:
        extras->others++;
        break;
    case OBJ_EMPTY:
        break;
    }
    return SL_OK;
}

static sl_status check_reference(const obj_reader *r, const char *what, const reference *use, int64_t count)
{
    if (use->largest < count) {
        return SL_OK;
    }
    return mesh_fail(r->out, SL_BAD_INPUT, use->line, -1, "the file may be cut short",
                     "a face uses %s %" PRId64 ", but the file has %" PRId64, what, use->largest + 1, count);
}

/* Texture vertices become UVs of corners. */
static sl_status resolve_textures(obj_reader *r)
{
    sl_meshfile *file = r->out->file;
    file->corner_uv = sl_alloc(r->out->corners, 2 * sizeof *file->corner_uv);
    if (file->corner_uv == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int64_t c = 0; c < r->out->corners; c++) {
        const int32_t t = c < r->textured ? r->corner_texture[c] : -1;
        file->corner_uv[2 * c] = t >= 0 ? r->texture[2 * (int64_t)t] : (double)NAN;
        file->corner_uv[2 * c + 1] = t >= 0 ? r->texture[2 * (int64_t)t + 1] : (double)NAN;
    }
    return SL_OK;
}

/* Checks what could only be known at the end, and completes the arrays that were filled lazily. */
static sl_status finish(obj_reader *r)
{
    sl_status status;
    sl_meshfile *file = r->out->file;
    if (r->out->faces == 0) {
        return mesh_fail(r->out, SL_BAD_INPUT, 0, -1, "", "no face (f) in this file");
    }
    SL_TRY(check_reference(r, "vertex", &r->vertex_use, r->out->vertices));
    SL_TRY(check_reference(r, "texture vertex", &r->texture_use, r->textures));
    SL_TRY(check_reference(r, "normal", &r->normal_use, r->normals));
    if (r->textured > 0) {
        SL_TRY(resolve_textures(r));
    }
    if (r->with_normal > 0) {
        const int64_t last = r->out->corners - 1;
        const int32_t value = r->with_normal > last ? file->corner_normal[last] : -1;
        SL_TRY(set_lazily(&file->corner_normal, &r->corner_normal_capacity, &r->with_normal, last, value));
    }
    if (r->colored > 0 && r->colored < r->out->vertices) {
        SL_TRY(set_color(r, r->out->vertices, NULL));
    }
    file->normals = (int32_t)r->normals;
cleanup:
    return status;
}

sl_status obj_read(mesh_reader *reader)
{
    static const reference never = {-1, 0};
    obj_reader r = {.out = reader,
                    .at = {reader->begin, reader->end, 1},
                    .vertex_use = never,
                    .texture_use = never,
                    .normal_use = never};
    sl_status status = SL_OK;
    while (r.at.p < r.at.end) {
        SL_TRY(read_statement(&r));
        obj_skip_statement(&r.at);
        obj_skip_newline(&r.at);
    }
    SL_TRY(finish(&r));
cleanup:
    sl_free(r.texture);
    sl_free(r.corner_texture);
    return status;
}
