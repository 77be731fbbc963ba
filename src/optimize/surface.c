/* The surface that is cut: triangles of the piece's polygons, their shapes and the price of their edges. */
#include "optimize/optimize_internal.h"

#include "base/memory.h"
#include "geom/vec3.h"

#include <math.h>

static const double DEGENERATE = 1e-5; /* 2 area over the longest edge squared, as distortion.h says */

/* Lays triangle t flat from its first corner. */
static void lay_flat(sl_opt_surface *s, int32_t t)
{
    const sl_patch *p = s->patch;
    const double *o = p->xyz + 3 * (int64_t)p->tri[3 * t];
    double e1[3], e2[3], n[3], longest = 0.0;
    sl_vec3_sub(p->xyz + 3 * (int64_t)p->tri[3 * t + 1], o, e1);
    sl_vec3_sub(p->xyz + 3 * (int64_t)p->tri[3 * t + 2], o, e2);
    sl_vec3_cross(e1, e2, n);
    for (int k = 0; k < 3; k++) {
        longest = fmax(longest, s->length[3 * t + k]);
    }
    const double doubled = sl_vec3_norm(n), x1 = s->length[3 * t];
    s->measured[t] = doubled > DEGENERATE * longest * longest;
    s->area[t] = 0.5 * doubled;
    s->rest[3 * (int64_t)t] = x1;
    s->rest[3 * (int64_t)t + 1] = x1 > 0.0 ? sl_vec3_dot(e1, e2) / x1 : 0.0;
    s->rest[3 * (int64_t)t + 2] = x1 > 0.0 ? doubled / x1 : 0.0;
    s->total += s->measured[t] != 0 ? s->area[t] : 0.0;
}

static void price_edges(sl_opt_surface *s, const double *weight)
{
    const sl_patch *p = s->patch;
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        const int32_t h = p->corner[c], to = p->corner[sl_corner_next(c)];
        s->length[c] =
            sl_vec3_distance(p->xyz + 3 * (int64_t)p->tri[c], p->xyz + 3 * (int64_t)p->tri[sl_corner_next(c)]);
        s->cost[c] = to != sl_next(s->mesh, h) ? HUGE_VAL : s->length[c] * (weight != NULL ? weight[h] : 1.0);
    }
    for (int32_t c = 0; c < 3 * p->nt; c++) { /* both halfedges alike, to the bit */
        if (p->twin[c] > c) {
            s->length[p->twin[c]] = s->length[c];
            s->cost[p->twin[c]] = s->cost[c];
        }
    }
}

sl_status sl_opt_surface_init(const sl_mesh *mesh, const sl_triangulation *triangulation, const double *weight,
                              sl_opt_surface *out)
{
    sl_status status = SL_OK;
    *out = (sl_opt_surface){.mesh = mesh, .weight = weight};
    int32_t *face = sl_alloc(mesh->nf, sizeof *face);
    SL_TRY(face == NULL ? SL_OUT_OF_MEMORY : SL_OK);
    for (int32_t f = 0; f < mesh->nf; f++) {
        face[f] = f;
    }
    SL_TRY(sl_patch_extract(mesh, triangulation, face, mesh->nf, &out->patch));
    const int64_t nt = out->patch->nt;
    out->length = sl_alloc(3 * nt, sizeof *out->length);
    out->cost = sl_alloc(3 * nt, sizeof *out->cost);
    out->rest = sl_alloc(3 * nt, sizeof *out->rest);
    out->area = sl_alloc(nt, sizeof *out->area);
    out->measured = sl_alloc(nt, sizeof *out->measured);
    if (out->length == NULL || out->cost == NULL || out->rest == NULL || out->area == NULL || out->measured == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    price_edges(out, weight);
    for (int32_t t = 0; t < out->patch->nt; t++) {
        lay_flat(out, t);
    }
    out->unit = sqrt(out->total);
cleanup:
    sl_free(face);
    if (status != SL_OK) {
        sl_opt_surface_clear(out);
    }
    return status;
}

void sl_opt_surface_clear(sl_opt_surface *surface)
{
    sl_patch_free(surface->patch);
    sl_free(surface->length);
    sl_free(surface->cost);
    sl_free(surface->rest);
    sl_free(surface->area);
    sl_free(surface->measured);
    *surface = (sl_opt_surface){0};
}
