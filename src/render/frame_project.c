/* Vertices onto the picture, triangles into bands of rows. */
#include "base/memory.h"
#include "geom/vec3.h"
#include "render/frame_internal.h"

#include <float.h>
#include <math.h>

enum { VERTEX_CHUNK = 1 << 13, TRIANGLE_CHUNK = 1 << 14 };

static const double farthest = 0x1p28;                   /* 1/256 pixel: products of two fit 64 bits */
static const double key_light[3] = {-0.42, 0.62, -0.66}; /* eye space, towards the light */
static const float ambient = 0.34f, direct = 0.62f, behind_part = 0.55f;
static const float wrap_light = 0.25f; /* light reaches this far round the terminator */

double sl_frame_key(const sl_frame *f, double z)
{
    return f->key_offset + f->key_scale * (f->camera.perspective ? 1.0 / z : z);
}

void sl_frame_snap(const sl_frame *f, const double eye[3], sl_frame_vertex *v)
{
    double at[2];
    v->x = v->y = SL_FRAME_FAR;
    v->key = v->weight = 1.0f;
    if (!(fabs(eye[0]) + fabs(eye[1]) + fabs(eye[2]) < DBL_MAX) ||
        (f->camera.perspective && !(eye[2] >= f->camera.near_depth))) {
        return;
    }
    sl_camera_project(&f->camera, f->width, f->height, eye, at);
    const double x = SL_SUBPIXELS * (at[0] - 0.5), y = SL_SUBPIXELS * (at[1] - 0.5);
    if (fabs(x) < farthest && fabs(y) < farthest) {
        v->x = (int32_t)lrint(x);
        v->y = (int32_t)lrint(y);
        v->key = (float)sl_frame_key(f, eye[2]);
        v->weight = f->camera.perspective ? (float)(1.0 / eye[2]) : 1.0f;
    }
}

typedef struct project_task {
    sl_frame *frame;
    double *nearest, *farthest; /* a chunk */
} project_task;

/* Depths first: the keys need their range. */
static void find_range(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    const project_task *task = user;
    const sl_camera *c = &task->frame->camera;
    double lo = INFINITY, hi = -INFINITY;
    for (int64_t v = begin; v < end; v++) {
        const double *p = task->frame->xyz + 3 * v;
        const double z = (p[0] - c->eye[0]) * c->forward[0] + (p[1] - c->eye[1]) * c->forward[1] +
                         (p[2] - c->eye[2]) * c->forward[2];
        lo = z < lo ? z : lo; /* false for NaN */
        hi = z > hi && z < DBL_MAX ? z : hi;
    }
    task->nearest[chunk] = lo;
    task->farthest[chunk] = hi;
}

static void set_keys(sl_frame *f, double lo, double hi)
{
    const bool perspective = f->camera.perspective;
    lo = perspective ? fmax(lo, fmax(f->camera.near_depth, DBL_MIN)) : fmax(lo, -DBL_MAX);
    if (!(hi > lo)) {
        hi = perspective ? 2.0 * lo : lo + fmax(1.0, fabs(lo));
    }
    const double a = perspective ? 1.0 / lo : lo, b = perspective ? 1.0 / hi : hi;
    f->key_scale = 1.0 / (b - a);
    f->key_offset = -a * f->key_scale;
}

void sl_frame_light(float cosine, float *front, float *behind)
{
    const float toward = wrap_light + (1.0f - wrap_light) * cosine, away = wrap_light - (1.0f - wrap_light) * cosine;
    *front = ambient + direct * (toward > 0.0f ? toward : 0.0f);
    *behind = behind_part * (ambient + direct * (away > 0.0f ? away : 0.0f));
}

static void project_vertices(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    (void)chunk;
    const project_task *task = user;
    sl_frame *f = task->frame;
    for (int64_t v = begin; v < end; v++) {
        double eye[3];
        sl_camera_to_eye(&f->camera, f->xyz + 3 * v, eye);
        sl_frame_snap(f, eye, &f->vertex[v]);
        const float *n = f->normal + 3 * v;
        const float length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        float cosine = 0.0f;
        if (length > 0.0f && length < FLT_MAX) {
            cosine = (n[0] * (float)f->light[0] + n[1] * (float)f->light[1] + n[2] * (float)f->light[2]) / length;
        }
        sl_frame_light(cosine, &f->vertex[v].front, &f->vertex[v].behind);
    }
}

static int32_t least(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

static int32_t most(int32_t a, int32_t b)
{
    return a > b ? a : b;
}

/* Bands whose pixel centres the triangle may cover. */
static sl_frame_span find_span(const sl_frame *f, int32_t t)
{
    static const sl_frame_span none = {1, 0};
    const sl_frame_vertex *a = &f->vertex[f->tri[3 * (int64_t)t]], *b = &f->vertex[f->tri[3 * (int64_t)t + 1]],
                          *c = &f->vertex[f->tri[3 * (int64_t)t + 2]];
    if (a->x == SL_FRAME_FAR || b->x == SL_FRAME_FAR || c->x == SL_FRAME_FAR) {
        return (sl_frame_span){0, (uint16_t)(f->bands - 1)}; /* clipped later, or dropped */
    }
    const int32_t y0 = (least(least(a->y, b->y), c->y) + SL_SUBPIXELS - 1) >> 8;
    const int32_t y1 = most(most(a->y, b->y), c->y) >> 8;
    const int32_t x0 = (least(least(a->x, b->x), c->x) + SL_SUBPIXELS - 1) >> 8;
    const int32_t x1 = most(most(a->x, b->x), c->x) >> 8;
    if (y0 > y1 || x0 > x1 || y1 < 0 || x1 < 0 || y0 >= f->height || x0 >= f->width) {
        return none;
    }
    if (f->style.cull) { /* front: anticlockwise in space, clockwise with y down */
        const int64_t area =
            ((int64_t)b->x - a->x) * ((int64_t)c->y - a->y) - ((int64_t)c->x - a->x) * ((int64_t)b->y - a->y);
        if (area >= 0) {
            return none;
        }
    }
    return (sl_frame_span){(uint16_t)(most(y0, 0) / SL_FRAME_BAND),
                           (uint16_t)(least(y1, f->height - 1) / SL_FRAME_BAND)};
}

static void count_bands(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    sl_frame *f = user;
    int64_t *count = f->place + (int64_t)chunk * f->bands;
    for (int32_t b = 0; b < f->bands; b++) {
        count[b] = 0;
    }
    for (int64_t t = begin; t < end; t++) {
        const sl_frame_span span = find_span(f, (int32_t)t);
        f->span[t] = span;
        for (int32_t b = span.first; b <= span.last; b++) {
            count[b]++;
        }
    }
}

static void fill_bands(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    sl_frame *f = user;
    int64_t *place = f->place + (int64_t)chunk * f->bands;
    for (int64_t t = begin; t < end; t++) {
        for (int32_t b = f->span[t].first; b <= f->span[t].last; b++) {
            f->banded[place[b]++] = (int32_t)t;
        }
    }
}

/* Counts of the chunks become places; stable, so that a band's triangles ascend. */
static int64_t make_places(sl_frame *f, int32_t chunks)
{
    int64_t total = 0;
    for (int32_t b = 0; b < f->bands; b++) {
        f->band_first[b] = total;
        for (int32_t c = 0; c < chunks; c++) {
            int64_t *at = &f->place[(int64_t)c * f->bands + b];
            const int64_t count = *at;
            *at = total;
            total += count;
        }
    }
    f->band_first[f->bands] = total;
    return total;
}

static sl_status sort_bands(sl_frame *f, const sl_context *context)
{
    sl_status status = SL_OK;
    const int32_t chunks = sl_chunk_count(f->nt, TRIANGLE_CHUNK);
    sl_free(f->band_first);
    f->band_first = sl_alloc((int64_t)f->bands + 1, sizeof *f->band_first);
    SL_TRY(f->band_first != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(sl_reserve((void **)&f->place, &f->places, (int64_t)chunks * f->bands + 1, sizeof *f->place));
    sl_parallel_for(context, f->nt, TRIANGLE_CHUNK, count_bands, f);
    const int64_t total = make_places(f, chunks);
    SL_TRY(sl_reserve((void **)&f->banded, &f->banded_room, total + 1, sizeof *f->banded));
    sl_parallel_for(context, f->nt, TRIANGLE_CHUNK, fill_bands, f);
cleanup:
    return status;
}

sl_status sl_frame_project(sl_frame *f, const sl_context *context)
{
    sl_status status = SL_OK;
    const int32_t chunks = sl_chunk_count(f->nv, VERTEX_CHUNK);
    double lo = INFINITY, hi = -INFINITY;
    project_task task = {.frame = f};
    task.nearest = sl_alloc(2 * (int64_t)chunks + 1, sizeof *task.nearest);
    SL_TRY(task.nearest != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    task.farthest = task.nearest + chunks;
    for (int k = 0; k < 3; k++) {
        f->light[k] =
            key_light[0] * f->camera.right[k] + key_light[1] * f->camera.up[k] + key_light[2] * f->camera.forward[k];
    }
    sl_parallel_for(context, f->nv, VERTEX_CHUNK, find_range, &task);
    for (int32_t c = 0; c < chunks; c++) {
        lo = fmin(lo, task.nearest[c]);
        hi = fmax(hi, task.farthest[c]);
    }
    set_keys(f, lo, hi);
    sl_parallel_for(context, f->nv, VERTEX_CHUNK, project_vertices, &task);
    SL_TRY(sort_bands(f, context));
cleanup:
    sl_free(task.nearest);
    return status;
}
