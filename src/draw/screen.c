#include "draw/screen.h"
#include "base/memory.h"
#include "draw/screen_internal.h"
#include "geom/vec3.h"

#include <float.h>
#include <string.h>

enum { VERTEX_CHUNK = 1 << 14, TRIANGLE_CHUNK = 1 << 13 };

static const double edge_on = 1e-12; /* of the product of the lengths: a plane seen edge-on has no slope */

typedef struct projection_task {
    sl_screen *screen;
    const double *xyz;
    double *chunk_near, *chunk_far; /* per chunk of vertices */
    int64_t *chunk_pieces;          /* per chunk of triangles, then where they start */
} projection_task;

static void project_vertices(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    const projection_task *task = user;
    const sl_screen *s = task->screen;
    double nearest = DBL_MAX, farthest = -DBL_MAX;
    for (int64_t v = begin; v < end; v++) {
        double *eye = s->eye + 3 * v;
        sl_camera_to_eye(&s->camera, task->xyz + 3 * v, eye);
        if (sl_screen_point_is_usable(eye)) {
            nearest = fmin(nearest, eye[2]);
            farthest = fmax(farthest, eye[2]);
        }
    }
    task->chunk_near[chunk] = nearest;
    task->chunk_far[chunk] = farthest;
}

static void snap_vertices(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    (void)chunk;
    const projection_task *task = user;
    for (int64_t v = begin; v < end; v++) {
        sl_screen_snap(task->screen, task->screen->eye + 3 * v, &task->screen->snapped[v]);
    }
}

static void set_key_range(sl_screen *s, double nearest, double farthest)
{
    double z0 = fmax(nearest, s->camera.near_depth), z1 = farthest;
    if (!s->camera.perspective) {
        z0 = nearest;
    }
    if (!(z1 > z0)) { /* flat, empty, or all behind the near plane */
        z0 = s->camera.perspective ? fmax(s->camera.near_depth, DBL_MIN) : fmin(z0, z1);
        z1 = s->camera.perspective ? 2.0 * z0 : z0 + 1.0;
    }
    if (s->camera.perspective) {
        const double range = 1.0 / z0 - 1.0 / z1;
        s->key_offset = 1.0 / z0 / range;
        s->key_scale = -1.0 / range;
    } else {
        s->key_offset = -z0 / (z1 - z0);
        s->key_scale = 1.0 / (z1 - z0);
    }
}

static void count_pieces(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    const projection_task *task = user;
    int64_t count = 0;
    for (int64_t t = begin; t < end; t++) {
        sl_piece scratch[SL_MAX_PIECES];
        count += sl_screen_cut(task->screen, (int32_t)t, scratch);
    }
    task->chunk_pieces[chunk] = count;
}

static void write_pieces(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    const projection_task *task = user;
    sl_piece *at = task->screen->piece + task->chunk_pieces[chunk];
    for (int64_t t = begin; t < end; t++) {
        sl_piece scratch[SL_MAX_PIECES];
        const int32_t count = sl_screen_cut(task->screen, (int32_t)t, scratch);
        memcpy(at, scratch, (size_t)count * sizeof *at);
        at += count;
    }
}

static sl_status make_pieces(projection_task *task, const sl_context *context)
{
    sl_screen *s = task->screen;
    sl_parallel_for(context, s->nt, TRIANGLE_CHUNK, count_pieces, task);
    int64_t total = 0;
    for (int32_t c = 0; c < sl_chunk_count(s->nt, TRIANGLE_CHUNK); c++) {
        const int64_t count = task->chunk_pieces[c];
        task->chunk_pieces[c] = total;
        total += count;
    }
    if (total > INT32_MAX) {
        return SL_BAD_INPUT;
    }
    s->pieces = total;
    s->piece = sl_alloc(total, sizeof *s->piece);
    if (s->piece == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    sl_parallel_for(context, s->nt, TRIANGLE_CHUNK, write_pieces, task);
    return SL_OK;
}

/* First and last band that a piece can touch. */
static void band_range(const sl_screen *s, const sl_piece *p, int32_t *first, int32_t *last)
{
    int32_t lo, hi;
    sl_piece_rows(p, s->height, &lo, &hi);
    *first = lo / s->band_rows;
    *last = hi > lo ? (hi - 1) / s->band_rows : *first - 1;
}

/* Counting sort of the pieces by band, stable. */
static sl_status sort_bands(sl_screen *s)
{
    s->bands = (s->height + s->band_rows - 1) / s->band_rows;
    s->band_first = sl_calloc((int64_t)s->bands + 2, sizeof *s->band_first);
    if (s->band_first == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    int64_t *start = s->band_first; /* counts two places ahead, so that filling leaves the starts in place */
    int32_t first, last;
    for (int64_t p = 0; p < s->pieces; p++) {
        band_range(s, &s->piece[p], &first, &last);
        for (int32_t b = first; b <= last; b++) {
            start[b + 2]++;
        }
    }
    for (int32_t b = 0; b < s->bands; b++) {
        start[b + 2] += start[b + 1];
    }
    s->band_piece = sl_alloc(start[s->bands + 1], sizeof *s->band_piece);
    if (s->band_piece == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int64_t p = 0; p < s->pieces; p++) {
        band_range(s, &s->piece[p], &first, &last);
        for (int32_t b = first; b <= last; b++) {
            s->band_piece[start[b + 1]++] = (int32_t)p;
        }
    }
    return SL_OK;
}

static sl_status project(projection_task *task, const sl_context *context)
{
    sl_screen *s = task->screen;
    double nearest = DBL_MAX, farthest = -DBL_MAX;
    sl_parallel_for(context, s->nv, VERTEX_CHUNK, project_vertices, task);
    for (int32_t c = 0; c < sl_chunk_count(s->nv, VERTEX_CHUNK); c++) {
        nearest = fmin(nearest, task->chunk_near[c]);
        farthest = fmax(farthest, task->chunk_far[c]);
    }
    set_key_range(s, nearest, farthest);
    sl_parallel_for(context, s->nv, VERTEX_CHUNK, snap_vertices, task);
    const sl_status status = make_pieces(task, context);
    return status == SL_OK ? sort_bands(s) : status;
}

sl_status sl_screen_create(const sl_camera *camera, int32_t width, int32_t height, int32_t nv, const double *xyz,
                           int32_t nt, const int32_t *tri, int32_t band_rows, const sl_context *context,
                           sl_screen **out)
{
    sl_status status = SL_OK;
    *out = NULL;
    if (width < 1 || height < 1 || width > SL_SCREEN_MAX_SIDE || height > SL_SCREEN_MAX_SIDE || band_rows < 1) {
        return SL_BAD_INPUT;
    }
    sl_screen *s = sl_calloc(1, sizeof *s);
    projection_task task = {.screen = s, .xyz = xyz};
    task.chunk_near = sl_alloc(sl_chunk_count(nv, VERTEX_CHUNK), sizeof *task.chunk_near);
    task.chunk_far = sl_alloc(sl_chunk_count(nv, VERTEX_CHUNK), sizeof *task.chunk_far);
    task.chunk_pieces = sl_alloc(sl_chunk_count(nt, TRIANGLE_CHUNK), sizeof *task.chunk_pieces);
    if (s == NULL || task.chunk_near == NULL || task.chunk_far == NULL || task.chunk_pieces == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    *s = (sl_screen){
        .camera = *camera, .width = width, .height = height, .nv = nv, .nt = nt, .tri = tri, .band_rows = band_rows};
    s->eye = sl_alloc(nv, 3 * sizeof *s->eye);
    s->snapped = sl_alloc(nv, sizeof *s->snapped);
    if (s->eye == NULL || s->snapped == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    SL_TRY(project(&task, context));
    *out = s;
    s = NULL;
cleanup:
    sl_free(task.chunk_near);
    sl_free(task.chunk_far);
    sl_free(task.chunk_pieces);
    sl_screen_free(s);
    return status;
}

void sl_screen_free(sl_screen *screen)
{
    if (screen != NULL) {
        sl_free(screen->eye);
        sl_free(screen->snapped);
        sl_free(screen->piece);
        sl_free(screen->band_first);
        sl_free(screen->band_piece);
        sl_free(screen);
    }
}

double sl_screen_key(const sl_screen *screen, double z)
{
    return screen->key_offset + screen->key_scale * (screen->camera.perspective ? 1.0 / z : z);
}

/* With n . P = c on the plane and the ray P = o + z d: perspective 1/z = n . d / c, orthographic
 * z = (c - n . o) / n[2]; both are linear in the picture position. */
bool sl_screen_plane(const sl_screen *s, int32_t t, double plane[3])
{
    const double *p[3];
    for (int k = 0; k < 3; k++) {
        p[k] = s->eye + 3 * (int64_t)s->tri[3 * (int64_t)t + k];
    }
    double e1[3], e2[3], n[3];
    sl_vec3_sub(p[1], p[0], e1);
    sl_vec3_sub(p[2], p[0], e2);
    sl_vec3_cross(e1, e2, n);
    const double c = sl_vec3_dot(n, p[0]);
    const double unit = 1.0 / (s->height * s->camera.focal);
    const double divisor = s->camera.perspective ? c : n[2];
    const double scale = sl_vec3_norm(n) * (s->camera.perspective ? sl_vec3_norm(p[0]) : 1.0);
    if (!(fabs(divisor) > edge_on * scale)) {
        return false;
    }
    /* value(x, y) = v0 + vx x + vy y with x = (sx - W cx) unit, y = (H cy - sy) unit */
    const bool persp = s->camera.perspective;
    const double v0 = persp ? n[2] / c : c / n[2];
    const double vx = persp ? n[0] / c : -n[0] / n[2], vy = persp ? n[1] / c : -n[1] / n[2];
    plane[1] = s->key_scale * vx * unit;
    plane[2] = -s->key_scale * vy * unit;
    const double cx = s->camera.centre[0] * s->width, cy = s->camera.centre[1] * s->height;
    plane[0] = s->key_offset + s->key_scale * v0 - cx * plane[1] - cy * plane[2];
    return true;
}
