/* Clipping and snapping of one triangle.
 * Layer: draw, private. */
#ifndef SL_DRAW_SCREEN_INTERNAL_H
#define SL_DRAW_SCREEN_INTERNAL_H

#include "draw/screen.h"

/* A triangle cut by the near plane and four guard planes has at most 8 corners, so 6 pieces. */
enum { SL_MAX_PIECES = 6 };

/* Finite and of a magnitude whose products cannot overflow. */
bool sl_screen_point_is_usable(const double eye[3]);

/* Where a vertex stands to the clipping planes, and on the picture if inside of all. Reads the key range. */
void sl_screen_snap(const sl_screen *screen, const double eye[3], sl_snapped *snapped);

/* The pieces of triangle t that may touch the picture; returns how many. Reads screen->eye, screen->snapped and the key
 * range. */
int32_t sl_screen_cut(const sl_screen *screen, int32_t t, sl_piece *pieces);

/* Rows [*lo, *hi) of a picture of `rows` rows whose sample centres the piece's box holds; empty when *hi <= *lo. */
void sl_piece_rows(const sl_piece *piece, int32_t rows, int32_t *lo, int32_t *hi);

/* Columns, likewise. */
void sl_piece_columns(const sl_piece *piece, int32_t columns, int32_t *lo, int32_t *hi);

#endif
