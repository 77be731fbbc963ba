#include "lens.h"

#include <math.h>

/* Cells along length, width and thickness: squares, so that the facet graph has the proportions of the shape. */
static const int32_t cells[3] = {66, 22, 10};
static const double half[3] = {3.0, 1.0, 0.45};

/* The grid of a box's surface. number: of a lattice point, 0 = not met yet. */
typedef struct box_grid {
    bend_model *model;
    int32_t *number, vertices, facets;
    int32_t *first, *index;
} box_grid;

/* The point of the box that the lattice names, blown up to the ellipsoid. */
static void place(const int32_t at[3], double xyz[3])
{
    double p[3], norm = 0.0;
    for (int k = 0; k < 3; k++) {
        p[k] = tan(0.25 * acos(-1.0) * (2.0 * at[k] / cells[k] - 1.0)); /* equal angles on the cube's faces */
        norm += p[k] * p[k];
    }
    for (int k = 0; k < 3; k++) {
        xyz[k] = half[k] * p[k] / sqrt(norm);
    }
}

static int32_t vertex_at(box_grid *g, const int32_t at[3])
{
    int32_t *number = &g->number[(at[0] * (cells[1] + 1) + at[1]) * (cells[2] + 1) + at[2]];
    if (*number == 0) {
        place(at, g->model->rest + 3 * (int64_t)g->vertices);
        *number = ++g->vertices;
    }
    return *number - 1;
}

/* One side of the box: axis fixed at its low or high end. */
static void add_side(box_grid *g, int axis, bool high)
{
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (int32_t i = 0; i < cells[u]; i++) {
        for (int32_t j = 0; j < cells[v]; j++) {
            static const int32_t step[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
            for (int c = 0; c < 4; c++) {
                const int corner = high ? c : 3 - c;
                int32_t at[3];
                at[axis] = high ? cells[axis] : 0;
                at[u] = i + step[corner][0];
                at[v] = j + step[corner][1];
                g->index[4 * (int64_t)g->facets + c] = vertex_at(g, at);
            }
            g->facets++;
            g->first[g->facets] = 4 * g->facets;
        }
    }
}

sl_status lens_make(bend_model *out)
{
    sl_status status = SL_OK;
    const int32_t lattice = (cells[0] + 1) * (cells[1] + 1) * (cells[2] + 1);
    const int32_t facets = 2 * (cells[0] * cells[1] + cells[1] * cells[2] + cells[2] * cells[0]);
    box_grid g = {.model = out, .number = sl_calloc(lattice, sizeof *g.number)};
    *out = (bend_model){.rest = sl_alloc(3 * (int64_t)(facets + 2), sizeof *out->rest),
                        .first = sl_calloc(facets + 1, sizeof *out->first),
                        .index = sl_alloc(4 * (int64_t)facets, sizeof *out->index)};
    if (g.number == NULL || out->rest == NULL || out->first == NULL || out->index == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    g.first = out->first;
    g.index = out->index;
    for (int axis = 0; axis < 3; axis++) {
        add_side(&g, axis, false);
        add_side(&g, axis, true);
    }
    out->polygons = (sl_polygons){g.vertices, g.facets, NULL, out->first, out->index};
    SL_TRY(bend_begin(out));
cleanup:
    sl_free(g.number);
    return status;
}
