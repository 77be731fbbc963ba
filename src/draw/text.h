/* Captions in a stroked alphabet of our own (printable ASCII).
 * Layer: draw. */
#ifndef SL_DRAW_TEXT_H
#define SL_DRAW_TEXT_H

#include "draw/mask.h"

/* Writes text with its baseline starting at `at` (samples of the mask's picture); height = of a capital letter.
 * Characters outside printable ASCII show as a box. */
void sl_mask_text(sl_mask *mask, const double at[2], double height, const char *text);

/* Width of the text, in samples, from the start of the first to the end of the last character. */
double sl_text_width(double height, const char *text);

#endif
