#include "pack/board.h"

#include "base/memory.h"

#include <string.h>

enum {
    BLOCK_WORDS = 64, /* a block of rows is looked at together, until all of it is known to be taken */
    RUNS_BETWEEN = 6  /* looks whether it is */
};

/* to[i] |= bits from[i] and from[i + 1] moved down by shift (0 .. 63), for i < n. Reads n + 1 words. */
static void or_shifted(uint64_t *restrict to, const uint64_t *restrict from, int32_t shift, int32_t n)
{
    for (int32_t i = 0; i < n; i++) {
        to[i] |= (from[i] >> shift) | ((from[i + 1] << 1) << (63 - shift));
    }
}

static bool all_set(const uint64_t *word, int32_t n)
{
    uint64_t all = ~(uint64_t)0;
    for (int32_t i = 0; i < n; i++) {
        all &= word[i];
    }
    return all == ~(uint64_t)0;
}

static int32_t log2_floor(int32_t n)
{
    int32_t k = 0;
    while (n >= 2) {
        n /= 2;
        k++;
    }
    return k;
}

sl_status sl_board_init(int32_t width, int32_t height, sl_board *out)
{
    *out = (sl_board){.width = width, .height = height, .words = (width + 63) / 64};
    out->levels = log2_floor(width) + 1;
    out->plane = (int64_t)out->words * (height + 1) + BLOCK_WORDS + 8;
    out->taken = sl_calloc(out->levels * out->plane, sizeof *out->taken);
    out->bad = sl_alloc(BLOCK_WORDS + 2 * (int64_t)out->words, sizeof *out->bad);
    return out->taken != NULL && out->bad != NULL ? SL_OK : SL_OUT_OF_MEMORY;
}

void sl_board_clear(sl_board *board)
{
    sl_free(board->taken);
    sl_free(board->bad);
    *board = (sl_board){0};
}

void sl_board_wipe(sl_board *board)
{
    memset(board->taken, 0, (size_t)(board->levels * board->plane) * sizeof *board->taken);
}

/* Level k + 1 of a row from its level k. */
static void raise_row(const sl_board *board, int32_t k, int32_t y)
{
    const uint64_t *from = board->taken + k * board->plane + (int64_t)y * board->words;
    uint64_t *to = board->taken + (k + 1) * board->plane + (int64_t)y * board->words;
    const int32_t step = 1 << k, words = step / 64, bits = step % 64;
    for (int32_t i = 0; i < board->words; i++) {
        const uint64_t near = i + words < board->words ? from[i + words] : 0;
        const uint64_t next = i + words + 1 < board->words ? from[i + words + 1] : 0;
        to[i] = from[i] | (near >> bits) | ((next << 1) << (63 - bits));
    }
}

/* Takes or frees the mask's cells. */
static void set_cells(sl_board *board, const sl_mask *mask, int32_t x, int32_t y, bool taken)
{
    for (int32_t r = 0; r < mask->count; r++) {
        uint64_t *row = board->taken + (int64_t)(y + mask->run[r].row) * board->words;
        const int32_t first = x + mask->run[r].left, last = first + mask->run[r].length - 1;
        const uint64_t head = ~(uint64_t)0 << (first % 64), tail = ~(uint64_t)0 >> (63 - last % 64);
        for (int32_t i = first / 64; i <= last / 64; i++) {
            const uint64_t bits = (i == first / 64 ? head : ~(uint64_t)0) & (i == last / 64 ? tail : ~(uint64_t)0);
            row[i] = taken ? row[i] | bits : row[i] & ~bits;
        }
    }
    for (int32_t k = 0; k + 1 < board->levels; k++) {
        for (int32_t row = y; row < y + mask->height; row++) {
            raise_row(board, k, row);
        }
    }
}

void sl_board_put(sl_board *board, const sl_mask *mask, int32_t x, int32_t y)
{
    set_cells(board, mask, x, y, true);
}

void sl_board_take_away(sl_board *board, const sl_mask *mask, int32_t x, int32_t y)
{
    set_cells(board, mask, x, y, false);
}

/* The rows y .. y + rows - 1 of places, words first .. first + words - 1 of each: bits of places where the mask takes
 * a cell that is taken. With all words of a row, rows lie one after another and are done as one. */
static bool test_block(const sl_board *board, const sl_mask *mask, int32_t y, int32_t rows, int32_t first,
                       int32_t words, int64_t *work)
{
    const bool whole = words == board->words;
    const int32_t strips = whole ? 1 : rows, n = whole ? rows * words : words;
    for (int32_t i = 0; i < rows; i++) {
        memcpy(board->bad + i * words, board->bad + BLOCK_WORDS + board->words, (size_t)words * sizeof *board->bad);
    }
    for (int32_t r = 0; r < mask->count; r++) {
        const sl_mask_run *run = &mask->run[r];
        const int32_t k = log2_floor(run->length);
        const int32_t second = run->left + run->length - (1 << k);
        const uint64_t *level = board->taken + k * board->plane + (int64_t)(y + run->row) * board->words + first;
        for (int32_t s = 0; s < strips; s++) {
            const uint64_t *from = level + (int64_t)s * board->words;
            or_shifted(board->bad + s * words, from + run->left / 64, run->left % 64, n);
            if (second != run->left) {
                or_shifted(board->bad + s * words, from + second / 64, second % 64, n);
            }
        }
        *work += 2 * rows * words;
        if (r % RUNS_BETWEEN == RUNS_BETWEEN - 1 && all_set(board->bad, rows * words)) {
            return false;
        }
    }
    return true;
}

/* A row of places with those outside low .. high marked as taken: what each row of a block begins with. */
static void mark_outside(sl_board *board, int32_t first_word, int32_t words, int32_t low, int32_t high)
{
    uint64_t *row = board->bad + BLOCK_WORDS + board->words;
    for (int32_t i = 0; i < words; i++) {
        row[i] = 0;
        for (int32_t x = 64 * (first_word + i), bit = 0; bit < 64; bit++) {
            row[i] |= (uint64_t)(x + bit < low || x + bit > high) << bit;
        }
    }
}

/* The first free place in a row; -1 = none. */
static int32_t first_free(const uint64_t *bad, int32_t first_word, int32_t words)
{
    for (int32_t i = 0; i < words; i++) {
        if (~bad[i] != 0) {
            return 64 * (first_word + i) + (int32_t)__builtin_ctzll(~bad[i]);
        }
    }
    return -1;
}

/* The last free place in a row; -1 = none. */
static int32_t last_free(const uint64_t *bad, int32_t first_word, int32_t words)
{
    for (int32_t i = words - 1; i >= 0; i--) {
        if (~bad[i] != 0) {
            return 64 * (first_word + i) + 63 - (int32_t)__builtin_clzll(~bad[i]);
        }
    }
    return -1;
}

static int64_t cost_of(const sl_board_query *query, int32_t x, int32_t y)
{
    return query->pull[0] * (2 * (int64_t)x + query->reference[0]) +
           query->pull[1] * (2 * (int64_t)y + query->reference[1]);
}

bool sl_board_find(sl_board *board, const sl_mask *mask, const sl_board_query *query, sl_board_place *out,
                   int64_t *work)
{
    int32_t low[2], high[2];
    const int32_t side[2] = {board->width - mask->width, board->height - mask->height};
    for (int i = 0; i < 2; i++) {
        low[i] = query->low[i] > 0 ? query->low[i] : 0;
        high[i] = query->high[i] < side[i] ? query->high[i] : side[i];
    }
    if (mask->width == 0 || low[0] > high[0] || low[1] > high[1]) {
        return false;
    }
    const int32_t first = low[0] / 64, span = high[0] / 64 - first + 1;
    const bool whole = 2 * span > board->words;
    const int32_t start = whole ? 0 : first, words = whole ? board->words : span;
    const int32_t block = words < BLOCK_WORDS ? BLOCK_WORDS / words : 1;
    const bool leftward = query->pull[0] >= 0, downward = query->pull[1] >= 0;
    const int32_t best_x = leftward ? low[0] : high[0];
    bool found = false;
    mark_outside(board, start, words, low[0], high[0]);
    out->cost = query->limit;
    for (int32_t done = 0; done <= high[1] - low[1]; done += block) {
        const int32_t left = high[1] - low[1] + 1 - done, rows = left < block ? left : block;
        const int32_t y = downward ? low[1] + done : high[1] - done - rows + 1;
        if (cost_of(query, best_x, downward ? y : y + rows - 1) >= out->cost) {
            break;
        }
        if (!test_block(board, mask, y, rows, start, words, work)) {
            continue;
        }
        for (int32_t i = 0; i < rows; i++) {
            const uint64_t *bad = board->bad + i * words;
            const int32_t x = leftward ? first_free(bad, start, words) : last_free(bad, start, words);
            if (x >= 0 && cost_of(query, x, y + i) < out->cost) {
                *out = (sl_board_place){x, y + i, cost_of(query, x, y + i)};
                found = true;
            }
        }
    }
    return found;
}
