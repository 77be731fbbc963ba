#include "base/memory.h"
#include "image/color.h"
#include "render/stage_internal.h"

typedef struct band_task {
    const sl_stage *stage;
    sl_canvas *canvas;
    sl_status *status; /* per band */
} band_task;

static void draw_lines(const sl_stage *stage, const sl_visibility *window, sl_mask *mask, float *samples)
{
    for (int32_t i = 0; i < stage->layers; i++) {
        const sl_line_layer *layer = &stage->layer[i];
        if (layer->count == 0) {
            continue;
        }
        sl_mask_clear(mask);
        for (int64_t k = 0; k < layer->count; k++) {
            const double *p = layer->segment + 6 * k;
            sl_mask_visible_segment(mask, stage->screen, window, p, p + 3, layer->width * stage->scale);
        }
        sl_blend_samples(samples, mask, layer->rgb, layer->opacity);
    }
}

static sl_status draw_band(const sl_stage *stage, sl_canvas *canvas, int32_t row, int32_t rows)
{
    sl_status status = SL_OK;
    const int32_t width = canvas->width * stage->scale, height = rows * stage->scale;
    const int64_t count = (int64_t)width * height;
    sl_visibility window = {0, row * stage->scale, width, height, sl_alloc(count, sizeof *window.zid)};
    sl_mask mask = {0, row * stage->scale, width, height, sl_alloc(count, sizeof *mask.coverage)};
    float *samples = sl_alloc(count, 3 * sizeof *samples);
    if (window.zid == NULL || mask.coverage == NULL || samples == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    sl_visibility_draw(stage->screen, &window);
    sl_shade(stage->screen, &window, stage->material, stage->rig, stage->ground, stage->background, stage->scale,
             samples);
    draw_lines(stage, &window, &mask, samples);
    sl_canvas_reduce(canvas, row, rows, stage->scale, samples);
cleanup:
    sl_free(window.zid);
    sl_free(mask.coverage);
    sl_free(samples);
    return status;
}

static void draw_bands(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    const band_task *task = user;
    task->status[chunk] = draw_band(task->stage, task->canvas, (int32_t)begin, (int32_t)(end - begin));
}

sl_status sl_stage_draw(const sl_stage *stage, const sl_context *context, sl_canvas *canvas)
{
    sl_status status = SL_OK;
    const int32_t bands = sl_chunk_count(canvas->height, SL_BAND_PIXELS);
    band_task task = {stage, canvas, sl_calloc(bands, sizeof *task.status)};
    if (task.status == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    sl_parallel_for(context, canvas->height, SL_BAND_PIXELS, draw_bands, &task);
    for (int32_t b = 0; b < bands; b++) {
        SL_TRY(task.status[b]);
    }
cleanup:
    sl_free(task.status);
    return status;
}

sl_status sl_canvas_develop(const sl_canvas *canvas, sl_image **out)
{
    sl_image *image = NULL;
    const sl_status status = sl_image_create(canvas->width, canvas->height, 3, &image);
    if (status == SL_OK) {
        sl_pixels_from_linear((int64_t)canvas->width * canvas->height, canvas->rgb, image->pixels);
    }
    *out = image;
    return status;
}
