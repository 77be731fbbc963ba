#include "pack/separate.h"

#include "base/memory.h"
#include "base/rng.h"
#include "pack/field.h"
#include "pack/pairs.h"

#include <math.h>
#include <string.h>

enum {
    COARSE_GRID = 64,   /* cells along a page where charts look for places far away */
    NEAR_TURNS = 5,     /* as it stands, and a little turned */
    FAR_TURNS = 10,     /* ... by right angles, and by chance */
    STRAIGHT_REACH = 8, /* cells: how far around a chart's place it may move as it stands */
    TURNED_REACH = 4,   /* ... turned, and around a place on the coarse grid */
    FIRST_WEIGHT = 16,  /* of a pair's overlap */
    LAST_WEIGHT = 1 << 12,
    MAX_SWEEPS = 2000,
    MAX_SCALES = 200
};

static const double half_pi = 1.5707963267948966;
static const double jitter[NEAR_TURNS] = {0.0, 0.02, -0.02, 0.06, -0.06}; /* [rad] */
static const double least_gain = 1.2, most_gain = 2.0,
                    decay = 0.95; /* of weights, by a sweep; gains by share of the largest overlap */

typedef struct separation {
    const sl_pack_task *task;
    const sl_separate_def *def;
    int32_t turns;
    int32_t factor; /* cells of the grid along one of the coarse grid */
    double *angle;  /* count x turns */
    sl_sheet sheet, coarse;
    sl_spot *spot;
    sl_pack_pairs pairs; /* those that overlapped since the scale was begun; all others have the first weight */
    int32_t *box;      /* 4 count: left, right, bottom, top of each chart, a side after another; empty on other pages */
    int32_t *owner;    /* a page's cells: the first chart there */
    int32_t *order;    /* charts to be moved */
    uint8_t *overlaps; /* count */
    sl_field near, far, far_coarse;
    int32_t *line; /* costs of a row of places */
    sl_rng rng;
} separation;

/* A place that was looked at. */
typedef struct choice {
    int64_t cost;
    int32_t turn, x, y;
} choice;

static const sl_mask *mask_at(const separation *s, int32_t chart, int32_t turn)
{
    return &s->sheet.mask[(int64_t)chart * s->turns + turn];
}

static const sl_mask *mask_of(const separation *s, int32_t chart)
{
    return mask_at(s, chart, s->spot[chart].turn);
}

static int32_t weight_of(const separation *s, int32_t a, int32_t b)
{
    const int32_t k = sl_pack_pairs_find(&s->pairs, a, b);
    return k >= 0 ? s->pairs.pair[k].weight : FIRST_WEIGHT;
}

static void note_box(separation *s, int32_t chart)
{
    const int32_t n = s->task->count;
    const sl_mask *mask = mask_of(s, chart);
    const sl_spot *at = &s->spot[chart];
    s->box[chart] = at->x;
    s->box[(int64_t)n + chart] = at->x + mask->width;
    s->box[2 * (int64_t)n + chart] = at->y;
    s->box[3 * (int64_t)n + chart] = at->y + mask->height;
}

/* The weights of all others in a window. */
static void fill_field(const separation *s, int32_t chart, const int32_t low[2], const int32_t size[2], sl_field *field)
{
    const int32_t n = s->task->count, page = s->spot[chart].page, right = low[0] + size[0], top = low[1] + size[1];
    sl_field_begin(field, low, size);
    for (int32_t c = 0; c < n; c++) { /* most are elsewhere: their boxes tell */
        const bool near = (s->box[c] < right) & (s->box[(int64_t)n + c] > low[0]) & (s->box[2 * (int64_t)n + c] < top) &
                          (s->box[3 * (int64_t)n + c] > low[1]);
        if (near && c != chart && s->spot[c].page == page) {
            sl_field_add(field, mask_of(s, c), s->spot[c].x, s->spot[c].y, weight_of(s, chart, c));
        }
    }
    sl_field_sum(field);
}

static bool inside(const sl_field *field, const sl_mask *mask, int32_t x, int32_t y)
{
    return x >= field->low[0] && y >= field->low[1] && x + mask->width <= field->low[0] + field->size[0] &&
           y + mask->height <= field->low[1] + field->size[1];
}

/* The places within reach of (x0, y0), ring by ring outwards, until one is free. */
static void look_around(const separation *s, const sl_field *field, int32_t chart, choice from, int32_t reach,
                        choice *best)
{
    const sl_mask *mask = mask_at(s, chart, from.turn);
    for (int32_t d = 0; mask->width > 0 && d <= reach && best->cost > 0; d++) {
        for (int32_t y = from.y - d; y <= from.y + d; y++) {
            const bool edge = y == from.y - d || y == from.y + d;
            for (int32_t x = from.x - d; x <= from.x + d; x += edge || d == 0 ? 1 : 2 * d) {
                if (inside(field, mask, x, y)) {
                    const int64_t cost = sl_field_cost(field, mask, x, y, best->cost);
                    *best = cost < best->cost ? (choice){cost, from.turn, x, y} : *best;
                }
            }
        }
    }
}

/* Where a chart's corner is when it is turned another way around its centre. */
static choice turned(const separation *s, int32_t chart, int32_t turn)
{
    const sl_spot *at = &s->spot[chart];
    const sl_mask *from = mask_of(s, chart), *to = mask_at(s, chart, turn);
    return (choice){0, turn, (int32_t)floor(at->x + from->origin[0] - to->origin[0] + 0.5),
                    (int32_t)floor(at->y + from->origin[1] - to->origin[1] + 0.5)};
}

static void look_near(separation *s, int32_t chart, choice *best)
{
    const int32_t page[2] = {s->sheet.width, s->sheet.height};
    const sl_mask *mask = mask_of(s, chart);
    int32_t low[2] = {s->spot[chart].x, s->spot[chart].y}, high[2] = {low[0] + mask->width, low[1] + mask->height};
    for (int32_t t = 1; t < NEAR_TURNS && t < s->turns; t++) {
        const choice at = turned(s, chart, t);
        const sl_mask *other = mask_at(s, chart, t);
        low[0] = at.x < low[0] ? at.x : low[0];
        low[1] = at.y < low[1] ? at.y : low[1];
        high[0] = at.x + other->width > high[0] ? at.x + other->width : high[0];
        high[1] = at.y + other->height > high[1] ? at.y + other->height : high[1];
    }
    int32_t size[2];
    for (int i = 0; i < 2; i++) {
        low[i] = low[i] > STRAIGHT_REACH ? low[i] - STRAIGHT_REACH : 0;
        high[i] = high[i] + STRAIGHT_REACH < page[i] ? high[i] + STRAIGHT_REACH : page[i];
        size[i] = high[i] - low[i];
    }
    fill_field(s, chart, low, size, &s->near);
    look_around(s, &s->near, chart, turned(s, chart, s->spot[chart].turn), STRAIGHT_REACH, best);
    for (int32_t t = 1; t < NEAR_TURNS && t < s->turns; t++) {
        look_around(s, &s->near, chart, turned(s, chart, t), TURNED_REACH, best);
    }
}

/* The best place on the coarse grid; false: larger than the page. */
static bool coarse_place(separation *s, const sl_mask *mask, int32_t *best_x, int32_t *best_y)
{
    const sl_field *field = &s->far_coarse;
    const int32_t columns = field->size[0] - mask->width + 1, rows = field->size[1] - mask->height + 1;
    int32_t least = INT32_MAX;
    for (int32_t y = 0; mask->width > 0 && columns > 0 && y < rows; y++) {
        memset(s->line, 0, (size_t)columns * sizeof *s->line);
        for (int32_t r = 0; r < mask->count; r++) {
            const int32_t *from = field->sum + (int64_t)(y + mask->run[r].row) * field->stride + mask->run[r].left;
            const int32_t *to = from + mask->run[r].length;
            for (int32_t x = 0; x < columns; x++) {
                s->line[x] += to[x] - from[x];
            }
        }
        for (int32_t x = 0; x < columns; x++) {
            if (s->line[x] < least) {
                least = s->line[x];
                *best_x = x;
                *best_y = y;
            }
        }
    }
    return least < INT32_MAX;
}

static void look_far(separation *s, int32_t chart, choice *best)
{
    const int32_t low[2] = {0, 0}, size[2] = {s->sheet.width, s->sheet.height};
    fill_field(s, chart, low, size, &s->far);
    sl_field_coarsen(&s->far, s->factor, &s->far_coarse);
    for (int32_t t = 0; t < s->turns && best->cost > 0; t++) {
        const sl_mask *mask = &s->coarse.mask[(int64_t)chart * s->turns + t], *fine = mask_at(s, chart, t);
        int32_t x = 0, y = 0;
        if (coarse_place(s, mask, &x, &y)) {
            const choice from = {0, t, (int32_t)floor((x + mask->origin[0]) * s->factor - fine->origin[0] + 0.5),
                                 (int32_t)floor((y + mask->origin[1]) * s->factor - fine->origin[1] + 0.5)};
            look_around(s, &s->far, chart, from, TURNED_REACH, best);
        }
    }
}

static void move_chart(separation *s, int32_t chart)
{
    choice best = {INT64_MAX, s->spot[chart].turn, s->spot[chart].x, s->spot[chart].y};
    look_near(s, chart, &best);
    if (best.cost > 0 && s->def->far) {
        look_far(s, chart, &best);
    }
    s->spot[chart].turn = best.turn;
    s->spot[chart].x = best.x;
    s->spot[chart].y = best.y;
    note_box(s, chart);
}

/* Adds the cells of one page that charts share with the first one there. */
static sl_status count_page(separation *s, int32_t page, int64_t *total)
{
    sl_status status = SL_OK;
    const int32_t n = s->task->count, width = s->sheet.width;
    memset(s->owner, 0xff, (size_t)((int64_t)width * s->sheet.height) * sizeof *s->owner);
    for (int32_t c = 0; c < n; c++) {
        const sl_mask *mask = mask_of(s, c);
        int32_t other = -1, pair = -1; /* the last one met */
        for (int32_t r = 0; s->spot[c].page == page && r < mask->count; r++) {
            int32_t *owner =
                s->owner + (int64_t)(s->spot[c].y + mask->run[r].row) * width + s->spot[c].x + mask->run[r].left;
            for (int32_t x = 0; x < mask->run[r].length; x++) {
                if (owner[x] < 0) {
                    owner[x] = c;
                    continue;
                }
                if (owner[x] != other) {
                    other = owner[x];
                    SL_TRY(sl_pack_pairs_get(&s->pairs, c, other, FIRST_WEIGHT, &pair));
                }
                s->pairs.pair[pair].overlap++;
                ++*total;
            }
        }
    }
cleanup:
    return status;
}

static sl_status count_overlaps(separation *s, int64_t *total)
{
    sl_status status = SL_OK;
    *total = 0;
    for (int32_t k = 0; k < s->pairs.count; k++) {
        s->pairs.pair[k].overlap = 0;
    }
    for (int32_t p = 0; p < s->task->pages; p++) {
        SL_TRY(count_page(s, p, total));
    }
cleanup:
    return status;
}

/* Pairs that overlap weigh more from now on, those that do not weigh less. */
static void change_weights(separation *s)
{
    int32_t most = 1;
    for (int32_t k = 0; k < s->pairs.count; k++) {
        most = s->pairs.pair[k].overlap > most ? s->pairs.pair[k].overlap : most;
    }
    for (int32_t k = 0; k < s->pairs.count; k++) {
        sl_pack_pair *p = &s->pairs.pair[k];
        const double gain = p->overlap > 0 ? least_gain + (most_gain - least_gain) * p->overlap / most : decay;
        p->weight =
            (int32_t)fmax(FIRST_WEIGHT, fmin(LAST_WEIGHT, gain > 1.0 ? ceil(gain * p->weight) : gain * p->weight));
    }
}

/* Charts that overlap, in a random order. Returns how many. */
static int32_t list_movers(separation *s)
{
    const int32_t n = s->task->count;
    int32_t count = 0;
    memset(s->overlaps, 0, (size_t)n);
    for (int32_t k = 0; k < s->pairs.count; k++) {
        const sl_pack_pair *p = &s->pairs.pair[k];
        s->overlaps[p->chart[0]] |= p->overlap > 0;
        s->overlaps[p->chart[1]] |= p->overlap > 0;
    }
    for (int32_t c = 0; c < n; c++) {
        if (s->overlaps[c] != 0) {
            s->order[count++] = c;
        }
    }
    for (int32_t i = count - 1; i > 0; i--) {
        const int32_t j = (int32_t)(sl_rng_uniform(&s->rng) * (i + 1)), kept = s->order[i];
        s->order[i] = s->order[j];
        s->order[j] = kept;
    }
    return count;
}

/* Moves charts until none overlaps another. *apart = false: given up. */
static sl_status push_apart(separation *s, bool *apart)
{
    sl_status status = SL_OK;
    int64_t least = INT64_MAX;
    *apart = false;
    sl_pack_pairs_wipe(&s->pairs);
    for (int32_t sweep = 0, since = 0; since <= s->def->sweeps && sweep < MAX_SWEEPS; sweep++, since++) {
        int64_t total;
        SL_TRY(count_overlaps(s, &total));
        *apart = total == 0;
        if (*apart) {
            break;
        }
        if (total < least) {
            least = total;
            since = 0;
        }
        if (sweep > 0) {
            change_weights(s);
        }
        const int32_t movers = list_movers(s);
        for (int32_t i = 0; i < movers; i++) {
            move_chart(s, s->order[i]);
        }
    }
cleanup:
    return status;
}

/* Every chart where it stood, as far as the page allows. false: one is larger than the page. */
static bool take_places(separation *s, const sl_pose *pose)
{
    const int32_t page[2] = {s->sheet.width, s->sheet.height};
    for (int32_t c = 0; c < s->task->count; c++) {
        const sl_mask *mask = mask_at(s, c, 0);
        const int32_t size[2] = {mask->width, mask->height};
        int32_t at[2];
        if (mask->width == 0) {
            return false;
        }
        for (int i = 0; i < 2; i++) {
            at[i] = (int32_t)floor(pose[c].at[i] / s->sheet.cell - mask->origin[i] + 0.5);
            at[i] = at[i] < 0 ? 0 : at[i] + size[i] > page[i] ? page[i] - size[i] : at[i];
        }
        s->spot[c] = (sl_spot){pose[c].page, 0, at[0], at[1]};
        note_box(s, c);
    }
    return true;
}

static void choose_angles(separation *s, const sl_pose *pose)
{
    for (int32_t c = 0; c < s->task->count; c++) {
        double *angle = s->angle + (int64_t)c * s->turns;
        for (int32_t t = 0; t < s->turns; t++) {
            const bool free = s->def->rotations == SL_ROTATE_FREE;
            angle[t] = pose[c].angle;
            if (free && t < NEAR_TURNS) {
                angle[t] += jitter[t];
            } else if (!free || t < NEAR_TURNS + 3) {
                angle[t] += half_pi * (free ? t - NEAR_TURNS + 1 : t);
            } else {
                angle[t] = 4.0 * half_pi * sl_rng_uniform(&s->rng);
            }
        }
    }
}

/* always: the poses become those that the charts came to even where they still overlap. */
static sl_status try_scale(separation *s, double scale, bool always, sl_arrangement *best, bool *fits)
{
    sl_status status = SL_OK;
    choose_angles(s, best->pose);
    SL_TRY(sl_sheet_init(s->task, scale, s->def->grid, s->turns, s->angle, &s->sheet));
    if (s->def->far) {
        SL_TRY(sl_sheet_init(s->task, scale, s->def->grid / s->factor, s->turns, s->angle, &s->coarse));
    }
    const bool on_pages = take_places(s, best->pose);
    *fits = false;
    if (on_pages) {
        SL_TRY(push_apart(s, fits));
    }
    if (*fits || (always && on_pages)) {
        best->scale = scale;
        sl_pose_from_spots(&s->sheet, s->spot, best->pose);
    }
cleanup:
    sl_sheet_clear(&s->sheet);
    sl_sheet_clear(&s->coarse);
    return status;
}

static void separation_clear(separation *s)
{
    sl_free(s->angle);
    sl_free(s->spot);
    sl_pack_pairs_clear(&s->pairs);
    sl_free(s->box);
    sl_free(s->overlaps);
    sl_free(s->owner);
    sl_free(s->order);
    sl_free(s->line);
    sl_field_clear(&s->near);
    sl_field_clear(&s->far);
    sl_field_clear(&s->far_coarse);
}

static sl_status separation_init(separation *s)
{
    const int32_t n = s->task->count, grid = s->def->grid;
    const int32_t rows = (int32_t)ceil(s->task->height / s->task->width * grid) + 1;
    sl_status status = SL_OK;
    if (s->def->rotations == SL_ROTATE_FREE) {
        s->turns = s->def->far ? FAR_TURNS : NEAR_TURNS;
    } else {
        s->turns = s->def->far && s->def->rotations == SL_ROTATE_RIGHT ? 4 : 1;
    }
    s->factor = grid > COARSE_GRID ? grid / COARSE_GRID : 1;
    s->rng = sl_rng_seed(s->def->seed);
    s->angle = sl_alloc((int64_t)n * s->turns, sizeof *s->angle);
    s->spot = sl_alloc(n, sizeof *s->spot);
    s->box = sl_alloc(4 * (int64_t)n, sizeof *s->box);
    s->overlaps = sl_alloc(n, sizeof *s->overlaps);
    s->owner = sl_alloc((int64_t)grid * rows, sizeof *s->owner);
    s->order = sl_alloc(n, sizeof *s->order);
    s->line = sl_alloc(grid + 1, sizeof *s->line);
    if (s->angle == NULL || s->spot == NULL || s->box == NULL || s->overlaps == NULL || s->owner == NULL ||
        s->order == NULL || s->line == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    SL_TRY(sl_pack_pairs_init(&s->pairs));
    SL_TRY(sl_field_init(grid, rows, &s->near));
    SL_TRY(sl_field_init(s->def->far ? grid : 1, s->def->far ? rows : 1, &s->far));
    SL_TRY(sl_field_init(grid / s->factor, rows / s->factor + 1, &s->far_coarse));
cleanup:
    return status;
}

sl_status sl_separate(const sl_pack_task *task, const sl_separate_def *def, sl_arrangement *best, int32_t *attempts)
{
    separation s = {.task = task, .def = def};
    sl_status status = SL_OK;
    double step = def->step;
    SL_TRY(separation_init(&s));
    for (int32_t given_up = 0, k = 0; given_up <= def->halvings && k < MAX_SCALES; k++) {
        bool fits = false;
        SL_TRY(try_scale(&s, best->scale * (1.0 + step), false, best, &fits));
        ++*attempts;
        if (!fits) {
            step *= 0.5;
            given_up++;
        }
    }
cleanup:
    separation_clear(&s);
    return status;
}

sl_status sl_separate_at(const sl_pack_task *task, const sl_separate_def *def, sl_arrangement *arrangement, bool *apart,
                         int32_t *attempts)
{
    separation s = {.task = task, .def = def};
    sl_status status = SL_OK;
    *apart = false;
    SL_TRY(separation_init(&s));
    SL_TRY(try_scale(&s, arrangement->scale, true, arrangement, apart));
    ++*attempts;
cleanup:
    separation_clear(&s);
    return status;
}
