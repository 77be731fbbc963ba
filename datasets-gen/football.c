/* The dual of the icosphere: twelve pentagons among hexagons. */
#include "base/memory.h"
#include "grid.h"
#include "icosphere.h"
#include "models.h"
#include "plant.h"

#include "geom/vec3.h"

enum { MOST_SIDES = 6 };

typedef struct dual_work {
    int32_t *count; /* triangles met at each vertex so far */
    int32_t *side;  /* MOST_SIDES a vertex: corner of each of them, in the order met */
} dual_work;

static void gather(const gen_builder *b, dual_work *w)
{
    for (int32_t c = 0; c < b->nc; c++) {
        const int64_t v = b->index[c];
        if (w->count[v] < MOST_SIDES) {
            w->side[MOST_SIDES * v + w->count[v]++] = c;
        }
    }
}

static int32_t next_corner(int32_t c)
{
    return c % 3 == 2 ? c - 2 : c + 1;
}

/* The facet of vertex v: its triangles counterclockwise, each followed by that beyond its last side. */
static void add_polygon(const gen_builder *from, const dual_work *w, int32_t v, gen_builder *b)
{
    const int32_t *side = w->side + MOST_SIDES * (int64_t)v, count = w->count[v];
    int32_t corner[MOST_SIDES], here = side[0], n = 0;
    while (n < count) {
        corner[n++] = here / 3;
        const int32_t last = from->index[next_corner(next_corner(here))];
        for (int32_t k = 0; k < count; k++) {
            if (from->index[next_corner(side[k])] == last) {
                here = side[k];
                break;
            }
        }
    }
    gen_facet(b, n, corner);
}

static void add_centres(const gen_builder *from, gen_builder *b)
{
    for (int64_t t = 0; t < from->nf; t++) {
        double p[3] = {0.0, 0.0, 0.0};
        for (int k = 0; k < 3; k++) {
            sl_vec3_add(p, from->xyz + 3 * (int64_t)from->index[3 * t + k], p);
        }
        const double norm = sl_vec3_norm(p);
        gen_vertex(b, p[0] / norm, p[1] / norm, p[2] / norm);
    }
}

sl_status gen_football(uint64_t seed, int32_t scale, sl_generated **out)
{
    (void)seed; /* nothing random */
    gen_builder sphere = {0}, b = {0};
    gen_icosphere_into(&sphere, gen_refined(12, scale));
    dual_work w = {sl_calloc(sphere.nv, sizeof *w.count), sl_alloc(MOST_SIDES * sphere.nv, sizeof *w.side)};
    b.failed = sphere.failed || w.count == NULL || w.side == NULL;
    if (!b.failed) {
        gather(&sphere, &w);
        add_centres(&sphere, &b);
        for (int32_t v = 0; v < sphere.nv; v++) {
            add_polygon(&sphere, &w, v, &b);
        }
    }
    sl_free(w.count);
    sl_free(w.side);
    gen_clear(&sphere);
    const sl_status status = gen_finish(&b, out);
    return status != SL_OK ? status : gen_planted(gen_plant_icosahedral(*out, true), out);
}
