/* Vertices onto the picture, triangles into bands of rows. */
#include "base/memory.h"
#include "geom/vec3.h"
#include "render/frame_internal.h"

#include <float.h>
#include <math.h>

enum { VERTEX_CHUNK = 1 << 13 };

static const double key_light[3] = {-0.42, 0.62, -0.66}; /* eye space, towards the light */

void sl_frame_snap(const sl_frame *f, const double eye[3], sl_frame_vertex *v)
{
    const sl_camera *camera = &f->camera;
    v->x = SL_FRAME_FAR;
    v->y = SL_FRAME_UNUSABLE;
    v->key = v->weight = 1.0f;
    if (!(fabs(eye[0]) + fabs(eye[1]) + fabs(eye[2]) < DBL_MAX)) {
        return;
    }
    if (camera->perspective && eye[2] < camera->near_depth) {
        v->y = SL_FRAME_BEHIND;
        return;
    }
    const double inverse = camera->perspective ? 1.0 / eye[2] : 1.0, scale = f->height * camera->focal * inverse;
    const double x = SL_SUBPIXELS * (camera->centre[0] * f->width + scale * eye[0] - 0.5);
    const double y = SL_SUBPIXELS * (camera->centre[1] * f->height - scale * eye[1] - 0.5);
    if (fabs(x) < SL_FRAME_FARTHEST && fabs(y) < SL_FRAME_FARTHEST) {
        const double key = f->key_offset + f->key_scale * (camera->perspective ? inverse : eye[2]);
        v->x = (int32_t)lrint(x);
        v->y = (int32_t)lrint(y);
        v->key = (float)fmin(fmax(key, 0.0), 1.0);
        v->weight = (float)inverse;
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
    task->frame->kernels->range(task->frame, begin, end, &task->nearest[chunk], &task->farthest[chunk]);
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

static void project_vertices(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    (void)chunk;
    const project_task *task = user;
    task->frame->kernels->project(task->frame, begin, end);
}

static void count_bands(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    sl_frame *f = user;
    int64_t *count = f->place + (int64_t)chunk * f->bands;
    const int64_t at = (int64_t)chunk * (SL_FRAME_CHUNK + 1);
    const sl_frame_span *span = f->span + at;
    const int32_t kept = f->kernels->keep(f, (int32_t)begin, (int32_t)end, f->kept + at, f->span + at);
    for (int32_t b = 0; b < f->bands; b++) {
        count[b] = 0;
    }
    for (int32_t i = 0; i < kept; i++) {
        for (int32_t b = span[i].first; b <= span[i].last; b++) {
            count[b]++;
        }
    }
    f->kept_count[chunk] = kept;
}

static void fill_bands(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    (void)begin;
    (void)end;
    sl_frame *f = user;
    int64_t *place = f->place + (int64_t)chunk * f->bands;
    const int64_t at = (int64_t)chunk * (SL_FRAME_CHUNK + 1);
    for (int64_t i = at; i < at + f->kept_count[chunk]; i++) {
        for (int32_t b = f->span[i].first; b <= f->span[i].last; b++) {
            f->banded[place[b]++] = f->kept[i];
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

static sl_status make_lists(sl_frame *f, int64_t total)
{
    if (total <= f->banded_room) {
        return SL_OK;
    }
    sl_free(f->banded);
    sl_free(f->slot);
    f->banded_room = 0;
    f->banded = sl_alloc(total, sizeof *f->banded);
    f->slot = sl_calloc(total, sizeof *f->slot);
    if (f->banded == NULL || f->slot == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    f->banded_room = total;
    return SL_OK;
}

static sl_status sort_bands(sl_frame *f, const sl_context *context)
{
    sl_status status = SL_OK;
    const int32_t chunks = sl_chunk_count(f->nt, SL_FRAME_CHUNK);
    SL_TRY(sl_reserve((void **)&f->band_first, &f->band_room, (int64_t)f->bands + 1, sizeof *f->band_first));
    SL_TRY(sl_reserve((void **)&f->place, &f->places, (int64_t)chunks * f->bands + 1, sizeof *f->place));
    sl_parallel_for(context, f->nt, SL_FRAME_CHUNK, count_bands, f);
    const int64_t total = make_places(f, chunks);
    SL_TRY(make_lists(f, total));
    sl_parallel_for(context, f->nt, SL_FRAME_CHUNK, fill_bands, f);
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
