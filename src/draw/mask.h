/* Coverage of lines, dots and text, anti-aliased: strokes are laid into a mask by maximum, so overlapping strokes do
 * not darken one another; the mask is then blended as one colour. Layer: draw. */
#ifndef SL_DRAW_MASK_H
#define SL_DRAW_MASK_H

#include "draw/visibility.h"

/* A window of the picture, as sl_visibility: coverage in [0, 1] of samples [x0, x0 + width) x [y0, y0 + height). */
typedef struct sl_mask {
    int32_t x0, y0, width, height;
    float *coverage; /* width * height, row-major; borrowed */
} sl_mask;

void sl_mask_clear(sl_mask *mask);

/* A segment with round ends from a to b, in samples (the centre of sample (i, j) is at (i + 1/2, j + 1/2)). width in
 * samples; below one sample the line fades instead. Not finite: nothing is drawn. O(samples touched + rows). */
void sl_mask_segment(sl_mask *mask, const double a[2], const double b[2], double width);

/* A filled disc. */
void sl_mask_disc(sl_mask *mask, const double centre[2], double radius);

/* A filled rectangle with exact area coverage. */
void sl_mask_rectangle(sl_mask *mask, double x0, double y0, double x1, double y1);

/* A segment between two points of the scene, in eye space, clipped at the near plane; hidden where a nearer surface of
 * `visible` (same window as the mask) covers it. The surface seen at a sample is followed along its own slope to the
 * middle of the line before depths are compared: a line in the plane of what is seen is shown however slanted that is,
 * any other line may lie deeper than the surface by a line width at most. */
void sl_mask_visible_segment(sl_mask *mask, const sl_screen *screen, const sl_visibility *visible, const double a[3],
                             const double b[3], double width);

/* A disc around a point in eye space, radius in samples; hidden likewise. */
void sl_mask_visible_disc(sl_mask *mask, const sl_screen *screen, const sl_visibility *visible, const double centre[3],
                          double radius);

#endif
