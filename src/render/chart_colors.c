#include "render/chart_colors.h"
#include "base/memory.h"
#include "image/color.h"
#include "image/colormap.h"

#include <math.h>
#include <string.h>

enum { COLORS = 12, MAX_CHARTS = 1 << 24 };

static const double far_enough = 0.16;   /* OKLab: more distance than this counts no further */
static const double use_penalty = 0.004; /* per use, so that few charts all differ */
static const uint8_t no_chart[3] = {196, 196, 194};

typedef struct coloring {
    const sl_mesh *mesh;
    const int32_t *chart;
    int32_t charts;
    int64_t *first; /* charts + 2: facets by chart */
    int32_t *facet; /* nf */
    int8_t *color;  /* charts, -1 = not yet */
    double apart[COLORS][COLORS];
    int32_t uses[COLORS];
} coloring;

static sl_status sort_facets(coloring *c)
{
    const int32_t nf = c->mesh->nf;
    for (int32_t f = 0; f < nf; f++) {
        if (c->chart[f] < -1 || c->chart[f] > MAX_CHARTS) {
            return SL_BAD_INPUT;
        }
        c->charts = c->chart[f] >= c->charts ? c->chart[f] + 1 : c->charts;
    }
    c->first = sl_calloc((int64_t)c->charts + 2, sizeof *c->first);
    c->facet = sl_alloc(nf, sizeof *c->facet);
    c->color = sl_alloc(c->charts, sizeof *c->color);
    if (c->first == NULL || c->facet == NULL || c->color == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    memset(c->color, -1, (size_t)c->charts);
    for (int32_t f = 0; f < nf; f++) {
        if (c->chart[f] >= 0) {
            c->first[c->chart[f] + 2]++;
        }
    }
    for (int32_t k = 0; k < c->charts; k++) {
        c->first[k + 2] += c->first[k + 1];
    }
    for (int32_t f = 0; f < nf; f++) {
        if (c->chart[f] >= 0) {
            c->facet[c->first[c->chart[f] + 1]++] = f;
        }
    }
    return SL_OK;
}

/* nearest[k]: distance of colour k to the nearest colour of a neighbour of the chart. */
static void look_around(const coloring *c, int32_t chart, double nearest[COLORS])
{
    const sl_mesh *m = c->mesh;
    for (int64_t i = c->first[chart]; i < c->first[chart + 1]; i++) {
        const int32_t f = c->facet[i];
        for (int32_t h = m->face_first[f]; h < m->face_first[f + 1]; h++) {
            const int32_t other = sl_opposite(m, h);
            const int32_t neighbour = other >= 0 ? c->chart[m->face[other]] : -1;
            if (neighbour >= 0 && neighbour != chart && c->color[neighbour] >= 0) {
                for (int k = 0; k < COLORS; k++) {
                    nearest[k] = fmin(nearest[k], c->apart[k][c->color[neighbour]]);
                }
            }
        }
    }
}

static void pick(coloring *c, int32_t chart)
{
    double nearest[COLORS];
    for (int k = 0; k < COLORS; k++) {
        nearest[k] = far_enough;
    }
    look_around(c, chart, nearest);
    int best = 0;
    for (int k = 1; k < COLORS; k++) {
        if (nearest[k] - use_penalty * c->uses[k] > nearest[best] - use_penalty * c->uses[best]) {
            best = k;
        }
    }
    c->color[chart] = (int8_t)best;
    c->uses[best]++;
}

sl_status sl_chart_colors(const sl_mesh *mesh, const int32_t *chart, uint8_t *facet_rgb)
{
    coloring c = {.mesh = mesh, .chart = chart};
    uint8_t palette[COLORS][3];
    for (int i = 0; i < COLORS; i++) {
        sl_palette_color(i, palette[i]);
    }
    for (int i = 0; i < COLORS; i++) {
        for (int j = 0; j < COLORS; j++) {
            c.apart[i][j] = fmin(sl_color_distance(palette[i], palette[j]), far_enough);
        }
    }
    const sl_status status = sort_facets(&c);
    for (int32_t k = 0; status == SL_OK && k < c.charts; k++) {
        if (c.first[k + 1] > c.first[k]) {
            pick(&c, k);
        }
    }
    for (int32_t f = 0; status == SL_OK && f < mesh->nf; f++) {
        memcpy(facet_rgb + 3 * (int64_t)f, chart[f] >= 0 ? palette[c.color[chart[f]]] : no_chart, 3);
    }
    sl_free(c.first);
    sl_free(c.facet);
    sl_free(c.color);
    return status;
}
