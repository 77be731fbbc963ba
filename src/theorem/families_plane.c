/* Families that look like facet graphs: cells of a grid, some split into triangles, some missing. */
#include "base/memory.h"
#include "theorem/families_internal.h"

#include <math.h>

/* What became of a cell. */
typedef enum cell_kind { HOLE, QUAD, RISING, FALLING } cell_kind;

/* Sides of a cell. */
typedef enum cell_side { LEFT, RIGHT, BELOW, ABOVE } cell_side;

typedef struct cells {
    int32_t width, height;
    uint8_t *kind;
    int32_t *node; /* first node of each cell */
    int32_t nodes;
} cells;

/* Which of a cell's nodes lies at a side, -1 in a hole: split along the rising diagonal, the first triangle has left
 * and above; along the falling one, left and below. */
static int32_t node_at(const cells *c, int32_t x, int32_t y, cell_side side)
{
    const int32_t at = y * c->width + x;
    switch ((cell_kind)c->kind[at]) {
    case HOLE:
        return -1;
    case RISING:
        return c->node[at] + (side == RIGHT || side == BELOW ? 1 : 0);
    case FALLING:
        return c->node[at] + (side == RIGHT || side == ABOVE ? 1 : 0);
    case QUAD:
        break;
    }
    return c->node[at];
}

/* Random cells within `budget` nodes: quads, triangles with probability split, holes with probability hole. */
static sl_status cells_create(sl_rng *rng, int32_t width, int32_t height, double split, double hole, cells *c)
{
    const int64_t count = (int64_t)width * height;
    *c = (cells){.width = width, .height = height};
    c->kind = sl_alloc(count, sizeof *c->kind);
    c->node = sl_alloc(count, sizeof *c->node);
    if (c->kind == NULL || c->node == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int64_t k = 0; k < count; k++) {
        const double chance = sl_rng_uniform(rng);
        const cell_kind kind = k > 0 && chance < hole        ? HOLE
                               : chance < hole + split       ? RISING
                               : chance < hole + 2.0 * split ? FALLING
                                                             : QUAD;
        c->kind[k] = (uint8_t)kind;
        c->node[k] = c->nodes;
        c->nodes += kind == HOLE ? 0 : kind == QUAD ? 1 : 2;
    }
    return SL_OK;
}

static void cells_clear(cells *c)
{
    sl_free(c->kind);
    sl_free(c->node);
}

static void join(sl_edges *edges, int32_t a, int32_t b)
{
    if (a >= 0 && b >= 0) {
        sl_edges_within(edges, a, b);
    }
}

/* A half of cells, mirrored along its left border: cells there meet their own images but for a share of gaps, or, with
 * straddling cells, a column of fixed nodes. */
static sl_status mirror_cells(sl_rng *rng, const cells *c, double gaps, bool straddle, sl_theorem_graph **out)
{
    sl_edges edges = {.pairs = c->nodes, .fixed = straddle ? c->height : 0};
    for (int32_t y = 0; y < c->height; y++) {
        for (int32_t x = 0; x < c->width; x++) {
            const int32_t at = y * c->width + x;
            if (c->kind[at] >= RISING) {
                sl_edges_within(&edges, c->node[at], c->node[at] + 1);
            }
            if (x + 1 < c->width) {
                join(&edges, node_at(c, x, y, RIGHT), node_at(c, x + 1, y, LEFT));
            }
            if (y + 1 < c->height) {
                join(&edges, node_at(c, x, y, ABOVE), node_at(c, x, y + 1, BELOW));
            }
        }
        const int32_t border = node_at(c, 0, y, LEFT);
        if (straddle && border >= 0) {
            sl_edges_spoke(&edges, border, y);
        } else if (border >= 0 && (y == 0 || sl_rng_uniform(rng) >= gaps)) {
            sl_edges_across(&edges, border, border);
        }
        if (straddle && y > 0) {
            sl_edges_fixed(&edges, y - 1, y);
        }
    }
    return sl_edges_finish(&edges, out);
}

static sl_status make_cells(sl_rng *rng, int32_t width, int32_t height, double split, double hole, bool straddle,
                            sl_theorem_graph **out)
{
    cells c;
    sl_status status = cells_create(rng, width, height, split, hole, &c);
    *out = NULL;
    if (status == SL_OK) {
        status = mirror_cells(rng, &c, hole, straddle, out);
    }
    cells_clear(&c);
    return status;
}

/* A patch about as wide as high; a third of the cells are split. */
sl_status sl_make_planar(sl_rng *rng, int32_t nodes, sl_theorem_graph **out)
{
    const double cell_count = nodes / (2.0 * 1.3);
    const double aspect = 0.5 + sl_rng_uniform(rng);
    const int32_t height = (int32_t)fmax(1.0, sqrt(cell_count * aspect));
    const int32_t width = (int32_t)fmax(1.0, cell_count / height - 1.0);
    return make_cells(rng, width, height, 0.15, sl_rng_uniform(rng) < 0.5 ? 0.08 : 0.0, sl_rng_uniform(rng) < 0.3, out);
}

/* One to four cells high, mirrored at its short side or along its length. A long one mirrored along its length has an
 * axis without gaps and no split cells: in one dimension disorder makes vectors fall off exponentially, and signs of
 * values like 1e-20 cannot be read from doubles. */
sl_status sl_make_strip(sl_rng *rng, int32_t nodes, sl_theorem_graph **out)
{
    const int32_t long_strip = 20;
    const int32_t thin = 1 + sl_rng_index(rng, 4);
    const int32_t length = nodes / 2 / (thin + 1) > 2 ? nodes / 2 / (thin + 1) : 2;
    const bool along = sl_rng_uniform(rng) < 0.5;
    const double split = along && length > long_strip ? 0.0 : 0.1;
    return make_cells(rng, along ? thin : length, along ? length : thin, split, 0.0, sl_rng_uniform(rng) < 0.3, out);
}

/* Edges of a width x height grid of quads, closed in x and y or not, and an involution of its cells. */
static sl_status grid_edges(int32_t width, int32_t height, bool around, bool over, sl_edges *edges)
{
    for (int32_t y = 0; y < height; y++) {
        for (int32_t x = 0; x < width; x++) {
            const int32_t at = y * width + x;
            if (x + 1 < width || (around && width > 2)) {
                sl_edges_add(edges, at, y * width + (x + 1) % width);
            }
            if (y + 1 < height || (over && height > 2)) {
                sl_edges_add(edges, at, (y + 1) % height * width + x);
            }
        }
    }
    return edges->status;
}

/* The grid renumbered by a mirror and a second involution. kind 0: left and right, below and above; 1: half a turn, and
 * left and right; 2: the coordinates exchanged (width = height), and half a turn. */
static sl_status grid_of(int32_t width, int32_t height, bool around, bool over, int32_t kind, sl_theorem_graph **out)
{
    const int32_t n = width * height;
    sl_edges edges = {.pairs = 0, .fixed = n};
    sl_theorem_graph *plain = NULL;
    sl_status status = SL_OK;
    *out = NULL;
    int32_t *mirror = sl_alloc(2 * (int64_t)n, sizeof *mirror), *second = mirror + n;
    SL_TRY(mirror != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(grid_edges(width, height, around, over, &edges));
    SL_TRY(sl_edges_finish(&edges, &plain));
    for (int32_t i = 0; i < n; i++) {
        const int32_t x = i % width, y = i / width;
        const int32_t aside = y * width + width - 1 - x, turned = n - 1 - i;
        mirror[i] = kind == 0 ? aside : kind == 1 ? turned : x * width + y;
        second[i] = kind == 0 ? (height - 1 - y) * width + x : kind == 1 ? aside : turned;
    }
    SL_TRY(sl_theorem_graph_from_mirror(&plain->graph, mirror, second, out));
cleanup:
    sl_free(edges.end);
    sl_free(mirror);
    sl_theorem_graph_free(plain);
    return status;
}

/* Grids, cylinders and tori of quads with a mirror: degenerate spectra, a second mirror. */
sl_status sl_make_grid(sl_rng *rng, int32_t nodes, sl_theorem_graph **out)
{
    const double most = sqrt((double)nodes);
    const int32_t width = 2 + sl_rng_index(rng, (int32_t)(1.5 * most) - 2);
    const int32_t height = nodes / width > 2 ? nodes / width : 2;
    return grid_of(width, height, sl_rng_uniform(rng) < 0.5, sl_rng_uniform(rng) < 0.5, 0, out);
}

/* Involutions that leave no half: half a turn, coordinates of a square exchanged. A'' is not diagonal. */
sl_status sl_make_turned(sl_rng *rng, int32_t nodes, sl_theorem_graph **out)
{
    const int32_t side = (int32_t)sqrt((double)nodes);
    if (sl_rng_uniform(rng) < 0.5) {
        const bool around = sl_rng_uniform(rng) < 0.5;
        return grid_of(side, side, around, around, 2, out);
    }
    const int32_t width = 2 + sl_rng_index(rng, side), height = nodes / width > 2 ? nodes / width : 2;
    return grid_of(width, height, sl_rng_uniform(rng) < 0.5, sl_rng_uniform(rng) < 0.5, 1, out);
}
