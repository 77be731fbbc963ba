#include "render/frame.h"
#include "base/memory.h"
#include "geom/vec3.h"
#include "render/frame_internal.h"

#include <math.h>
#include <string.h>

enum { MAX_SIDE = 16384, PLAIN = 208 };

static const double widest_line = 64.0;

sl_frame_style sl_frame_style_default(void)
{
    return (sl_frame_style){.background = {246, 246, 244}, .checks = 48.0, .lit = true};
}

/* Vertex normals, facets weighted by area. */
static void set_normals(sl_frame *f)
{
    memset(f->normal, 0, (size_t)f->nv * 3 * sizeof *f->normal);
    for (int32_t t = 0; t < f->nt; t++) {
        const int32_t *v = f->tri + 3 * (int64_t)t;
        double a[3], b[3], n[3];
        sl_vec3_sub(f->xyz + 3 * (int64_t)v[1], f->xyz + 3 * (int64_t)v[0], a);
        sl_vec3_sub(f->xyz + 3 * (int64_t)v[2], f->xyz + 3 * (int64_t)v[0], b);
        sl_vec3_cross(a, b, n);
        for (int k = 0; k < 9 && isfinite(n[0] + n[1] + n[2]); k++) {
            f->normal[3 * (int64_t)v[k / 3] + k % 3] += (float)n[k % 3];
        }
    }
    for (int32_t v = 0; v < f->nv; v++) {
        float *n = f->normal + 3 * (int64_t)v;
        const float length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        const float scale = length > 0.0f && length < INFINITY ? 1.0f / length : 0.0f;
        for (int k = 0; k < 3; k++) {
            n[k] = scale > 0.0f ? n[k] * scale : 0.0f;
        }
    }
}

/* For the lists of triangles that may show: a chunk's may be one longer than the chunk. */
static sl_status make_room(sl_frame *f)
{
    const int64_t chunks = sl_chunk_count(f->nt, SL_FRAME_CHUNK);
    f->kept = sl_alloc(chunks * (SL_FRAME_CHUNK + 1), sizeof *f->kept);
    f->span = sl_alloc(chunks * (SL_FRAME_CHUNK + 1), sizeof *f->span);
    f->kept_count = sl_alloc(chunks, sizeof *f->kept_count);
    return f->kept != NULL && f->span != NULL && f->kept_count != NULL ? SL_OK : SL_OUT_OF_MEMORY;
}

sl_status sl_frame_create(const sl_frame_def *def, sl_frame **out)
{
    sl_status status = SL_OK;
    *out = NULL;
    for (int64_t i = 0; i < 3 * (int64_t)def->nt; i++) {
        if (def->tri[i] < 0 || def->tri[i] >= def->nv) {
            return SL_BAD_INPUT;
        }
    }
    sl_frame *f = sl_calloc(1, sizeof *f);
    SL_TRY(f != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    f->nv = def->nv;
    f->nt = def->nt;
    f->xyz = sl_alloc(def->nv, 3 * sizeof *f->xyz);
    f->normal = sl_alloc(def->nv, 3 * sizeof *f->normal);
    f->tri = sl_alloc(def->nt, 3 * sizeof *f->tri);
    f->color = sl_alloc(def->nt, sizeof *f->color);
    f->vertex = sl_calloc(def->nv, sizeof *f->vertex);
    SL_TRY(make_room(f));
    if (f->xyz == NULL || f->normal == NULL || f->tri == NULL || f->color == NULL || f->vertex == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    if (def->nt > 0) {
        memcpy(f->tri, def->tri, 3 * (size_t)def->nt * sizeof *f->tri);
    }
    sl_frame_set_colors(f, def->rgb);
    if (def->nv > 0) {
        sl_frame_set_positions(f, def->xyz);
    }
    SL_TRY(def->corner_uv != NULL ? sl_frame_set_uv(f, def->corner_uv) : SL_OK);
    f->kernels = sl_frame_kernels_best();
    *out = f;
    f = NULL;
cleanup:
    sl_frame_free(f);
    return status;
}

void sl_frame_free(sl_frame *f)
{
    if (f == NULL) {
        return;
    }
    for (int k = 0; k < SL_FRAME_LAYERS; k++) {
        sl_free(f->lines[k].pair);
        sl_free(f->lines[k].span);
    }
    sl_free(f->xyz);
    sl_free(f->normal);
    sl_free(f->tri);
    sl_free(f->uv);
    sl_free(f->color);
    sl_free(f->buffers);
    sl_free(f->vertex);
    sl_free(f->kept);
    sl_free(f->span);
    sl_free(f->kept_count);
    sl_free(f->place);
    sl_free(f->band_first);
    sl_free(f->banded);
    sl_free(f->slot);
    sl_free(f);
}

void sl_frame_set_colors(sl_frame *frame, const uint8_t *rgb)
{
    for (int64_t t = 0; t < frame->nt; t++) {
        uint8_t byte[4] = {PLAIN, PLAIN, PLAIN, 255};
        if (rgb != NULL) {
            memcpy(byte, rgb + 3 * t, 3);
        }
        memcpy(&frame->color[t], byte, sizeof byte);
    }
}

sl_status sl_frame_set_uv(sl_frame *frame, const double *corner_uv)
{
    if (frame->uv == NULL) {
        frame->uv = sl_alloc(frame->nt, 6 * sizeof *frame->uv);
    }
    if (frame->uv == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int64_t i = 0; i < 6 * (int64_t)frame->nt; i++) {
        frame->uv[i] = (float)corner_uv[i];
    }
    return SL_OK;
}

void sl_frame_set_positions(sl_frame *frame, const double *xyz)
{
    memcpy(frame->xyz, xyz, 3 * (size_t)frame->nv * sizeof *frame->xyz);
    set_normals(frame);
}

sl_status sl_frame_set_lines(sl_frame *frame, int32_t layer, int32_t count, const int32_t *vertex_pairs,
                             const uint8_t rgb[3], double width)
{
    if (layer < 0 || layer >= SL_FRAME_LAYERS || count < 0 || !(width > 0.0 && width <= widest_line)) {
        return SL_BAD_INPUT;
    }
    for (int64_t i = 0; i < 2 * (int64_t)count; i++) {
        if (vertex_pairs[i] < 0 || vertex_pairs[i] >= frame->nv) {
            return SL_BAD_INPUT;
        }
    }
    int32_t *pair = count > 0 ? sl_copy(vertex_pairs, count, 2 * sizeof *pair) : NULL;
    sl_frame_span *span = count > 0 ? sl_alloc(count, sizeof *span) : NULL;
    if (count > 0 && (pair == NULL || span == NULL)) {
        sl_free(pair);
        sl_free(span);
        return SL_OUT_OF_MEMORY;
    }
    sl_free(frame->lines[layer].pair);
    sl_free(frame->lines[layer].span);
    frame->lines[layer] = (sl_frame_lines){count, pair, span, {rgb[0], rgb[1], rgb[2]}, width};
    return SL_OK;
}

typedef struct draw_task {
    const sl_frame *frame;
    uint8_t *rgba;
} draw_task;

static void draw_surface(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    const draw_task *task = user;
    const sl_frame *f = task->frame;
    f->kernels->raster(f, chunk, (int32_t)begin, (int32_t)end);
    f->kernels->shade(f, chunk, (int32_t)begin, (int32_t)end, task->rgba);
}

static void draw_lines(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    const draw_task *task = user;
    sl_frame_draw_lines(task->frame, chunk, (int32_t)begin, (int32_t)end, task->rgba);
}

/* Rows of the visibility buffer begin on cache lines. */
static bool make_buffers(sl_frame *f, int64_t words)
{
    const size_t line = SL_FRAME_LINE * sizeof(float);
    if (words > f->words) {
        sl_free(f->buffers);
        f->words = 0;
        f->buffers = sl_alloc(2 * words + SL_FRAME_LINE, sizeof(float));
        if (f->buffers == NULL) {
            return false;
        }
        f->depth = (float *)(void *)((char *)f->buffers + (line - (uintptr_t)f->buffers % line) % line);
        f->seen = (int32_t *)(void *)(f->depth + words);
        f->words = words;
    }
    return true;
}

sl_status sl_frame_draw(sl_frame *f, const sl_camera *camera, const sl_frame_style *style, int32_t width,
                        int32_t height, const sl_context *context, uint8_t *rgba)
{
    if (width < 1 || height < 1 || width > MAX_SIDE || height > MAX_SIDE) {
        return SL_BAD_INPUT;
    }
    f->width = f->height = 0; /* nothing to pick unless all goes well */
    const int32_t stride = (width + SL_FRAME_PAD + SL_FRAME_LINE - 1) / SL_FRAME_LINE * SL_FRAME_LINE;
    if (!make_buffers(f, (int64_t)stride * height)) {
        return SL_OUT_OF_MEMORY;
    }
    f->camera = *camera;
    f->style = *style;
    f->width = width;
    f->height = height;
    f->stride = stride;
    f->bands = sl_chunk_count(height, SL_FRAME_BAND);
    const sl_status status = sl_frame_project(f, context);
    if (status != SL_OK) {
        f->width = f->height = 0;
        return status;
    }
    draw_task task = {f, rgba};
    sl_parallel_for(context, height, SL_FRAME_BAND, draw_surface, &task);
    sl_frame_span_lines(f, context);
    sl_parallel_for(context, height, SL_FRAME_BAND, draw_lines, &task);
    return SL_OK;
}

sl_frame_hit sl_frame_pick(const sl_frame *f, int32_t x, int32_t y)
{
    sl_frame_hit hit = {.triangle = -1};
    if (x >= 0 && y >= 0 && x < f->width && y < f->height) {
        hit.triangle = sl_frame_triangle(f, x, y);
    }
    if (hit.triangle >= 0) {
        sl_frame_barycentrics(f, hit.triangle, x, y, hit.bary);
    }
    return hit;
}
