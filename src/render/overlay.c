#include "base/memory.h"
#include "draw/text.h"
#include "image/color.h"
#include "render/overlay_internal.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const uint8_t ink_rgb[3] = {45, 46, 52};
static const double title_height = 0.026; /* of capitals, fraction of the picture's shorter side */
static const double label_height = 0.019;
static const double most_room = 0.15;                         /* of the picture's height, for a title or a colour bar */
static const double least_height = 7.0;                       /* pixels */
static const double bar_length = 0.30, bar_thickness = 0.022; /* fraction of the shorter side */

sl_status sl_overlay_create(sl_canvas *canvas, sl_overlay **out)
{
    *out = NULL;
    sl_overlay *overlay = sl_alloc(1, sizeof *overlay);
    float *coverage = sl_alloc((int64_t)canvas->width * canvas->height, sizeof *coverage);
    if (overlay == NULL || coverage == NULL) {
        sl_free(overlay);
        sl_free(coverage);
        return SL_OUT_OF_MEMORY;
    }
    *overlay = (sl_overlay){canvas, {0, 0, canvas->width, canvas->height, coverage}};
    sl_mask_clear(&overlay->mask);
    *out = overlay;
    return SL_OK;
}

void sl_overlay_free(sl_overlay *overlay)
{
    if (overlay != NULL) {
        sl_free(overlay->mask.coverage);
        sl_free(overlay);
    }
}

void sl_overlay_blend(sl_overlay *overlay, const uint8_t rgb[3], float opacity)
{
    float linear[3];
    sl_rgb_to_linear(rgb, linear);
    sl_canvas_blend(overlay->canvas, &overlay->mask, linear, opacity);
    sl_mask_clear(&overlay->mask);
}

static double shorter_side(const sl_canvas *canvas)
{
    return canvas->width < canvas->height ? canvas->width : canvas->height;
}

static double letters(const sl_canvas *canvas, double fraction)
{
    return fmax(fraction * shorter_side(canvas), least_height);
}

double sl_title_room(const sl_canvas *canvas, const char *title)
{
    const bool none = title == NULL || title[0] == '\0';
    return none ? 0.0 : fmin(1.8 * letters(canvas, title_height) / canvas->height, most_room);
}

double sl_legend_room(const sl_canvas *canvas)
{
    return fmin((bar_thickness * shorter_side(canvas) + 4.2 * letters(canvas, label_height)) / canvas->height,
                most_room);
}

sl_status sl_overlay_title(sl_canvas *canvas, const char *title)
{
    if (title == NULL || title[0] == '\0') {
        return SL_OK;
    }
    sl_overlay *overlay = NULL;
    const sl_status status = sl_overlay_create(canvas, &overlay);
    if (status == SL_OK) {
        const double height = letters(canvas, title_height);
        const double at[2] = {1.2 * height, 2.2 * height};
        sl_mask_text(&overlay->mask, at, height, title);
        sl_overlay_blend(overlay, ink_rgb, 1.0f);
    }
    sl_overlay_free(overlay);
    return status;
}

/* Colours of the bar, column by column, straight onto the canvas. */
static void paint_bar(sl_canvas *canvas, const sl_dressing *d, int32_t x0, int32_t x1, int32_t y0, int32_t y1)
{
    for (int32_t x = x0 > 0 ? x0 : 0; x < x1 && x < canvas->width; x++) {
        const int32_t i = (int32_t)((x - x0 + 0.5) / (x1 - x0) * (SL_MAP_COLORS - 1) + 0.5);
        for (int32_t y = y0 > 0 ? y0 : 0; y < y1 && y < canvas->height; y++) {
            memcpy(canvas->rgb + 3 * ((int64_t)y * canvas->width + x), d->map_rgb + 3 * (int64_t)i,
                   3 * sizeof *canvas->rgb);
        }
    }
}

/* A number in few digits; locale-free because a locale's comma is put right. */
static void short_number(double value, char text[32])
{
    snprintf(text, 32, "%.3g", value);
    for (char *c = text; *c != '\0'; c++) {
        *c = *c == ',' ? '.' : *c;
    }
}

sl_status sl_overlay_legend(sl_canvas *canvas, const sl_dressing *dressing, const char *name)
{
    sl_overlay *overlay = NULL;
    const sl_status status = sl_overlay_create(canvas, &overlay);
    if (status != SL_OK) {
        return status;
    }
    const double side = shorter_side(canvas), height = letters(canvas, label_height);
    const int32_t length = (int32_t)(bar_length * side), thick = (int32_t)fmax(bar_thickness * side, 3.0);
    const int32_t x1 = canvas->width - (int32_t)(3.0 * height), x0 = x1 - length;
    const int32_t y1 = canvas->height - (int32_t)(3.2 * height), y0 = y1 - thick;
    char lo[32], hi[32];
    short_number(dressing->value_lo, lo);
    short_number(dressing->value_hi, hi);
    const double base = y1 + 1.7 * height;
    const double at_lo[2] = {x0, base}, at_hi[2] = {x1 - sl_text_width(height, hi), base};
    paint_bar(canvas, dressing, x0, x1, y0, y1);
    sl_mask_text(&overlay->mask, at_lo, height, lo);
    sl_mask_text(&overlay->mask, at_hi, height, hi);
    if (name != NULL) {
        const double wide = sl_text_width(height, name), last = canvas->width - height - wide;
        const double at_name[2] = {fmax(fmin(0.5 * (x0 + x1 - wide), last), height), y0 - 0.8 * height};
        sl_mask_text(&overlay->mask, at_name, height, name);
    }
    sl_overlay_blend(overlay, ink_rgb, 1.0f);
    sl_overlay_free(overlay);
    return SL_OK;
}
