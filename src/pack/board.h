/* A page as grid cells, and where masks fit on it. All lengths in cells.
 * Layer: pack. */
#ifndef SL_PACK_BOARD_H
#define SL_PACK_BOARD_H

#include "pack/mask.h"

/* Level k has bit x of row y set when any of the cells x .. x + 2^k - 1 of that row is taken: a run of any length then
 * is tested by two bits. */
typedef struct sl_board {
    int32_t width, height, words; /* 64-bit words a row */
    int32_t levels;
    int64_t plane;   /* words a level, with what reading ahead needs */
    uint64_t *taken; /* levels x plane */
    uint64_t *bad;   /* work: rows of a block */
} sl_board;

/* What is sought: the place of least pull[0] (2 x + reference[0]) + pull[1] (2 y + reference[1]) in a window of places.
 */
typedef struct sl_board_query {
    int32_t low[2], high[2]; /* places allowed, both ends included; clipped to the page */
    int32_t pull[2];         /* negative: to the right, upwards */
    int32_t reference[2];    /* twice the place of what is pulled, from the mask's corner */
    int64_t limit;           /* only places of a smaller sum */
} sl_board_query;

typedef struct sl_board_place {
    int32_t x, y;
    int64_t cost;
} sl_board_place;

/* SL_OUT_OF_MEMORY. Freed by sl_board_clear, also after failure. */
SL_NODISCARD sl_status sl_board_init(int32_t width, int32_t height, sl_board *out);
void sl_board_clear(sl_board *board);

/* Nothing is taken any more. */
void sl_board_wipe(sl_board *board);

/* Takes the mask's cells when its lower left corner stands at (x, y). */
void sl_board_put(sl_board *board, const sl_mask *mask, int32_t x, int32_t y);

/* Frees the cells of a mask that was put there. */
void sl_board_take_away(sl_board *board, const sl_mask *mask, int32_t x, int32_t y);

/* The best place where the mask takes no cell that is taken; of equal ones the lowest. *work grows by the words
 * looked at. false: there is none within the limit. */
bool sl_board_find(sl_board *board, const sl_mask *mask, const sl_board_query *query, sl_board_place *out,
                   int64_t *work);

#endif
