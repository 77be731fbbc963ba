#include "variants.h"

#include "roughen.h"

#include <math.h>
#include <string.h>

const char *const variant_name[VARIANTS] = {"straight",   "bent",      "curled",  "noise",
                                            "more-noise", "triangles", "remeshed"};
const char *const variant_title[VARIANTS] = {"as it is",
                                             "bent by 90&deg;",
                                             "curled by 240&deg;",
                                             "noise, 0.15 of an edge",
                                             "noise, 0.4 of an edge",
                                             "quads split at random",
                                             "edges flipped"};

static sl_status build(const bend_model *model, int which, sl_generated **out)
{
    gen_builder b = {0};
    sl_rng rng = sl_rng_seed(7);
    for (int32_t v = 0; v < model->polygons.nv; v++) {
        const double *p = model->xyz + 3 * (int64_t)v;
        gen_vertex(&b, p[0], p[1], p[2]);
    }
    for (int32_t f = 0; f < model->polygons.nf; f++) {
        const int32_t first = model->polygons.face_first[f], end = model->polygons.face_first[f + 1];
        gen_facet(&b, end - first, model->polygons.index + first);
    }
    if (which == VARIANT_TRIANGLES || which == VARIANT_REMESHED) {
        gen_split_quads(&b, &rng);
    }
    if (which == VARIANT_REMESHED) {
        gen_flip_edges(&b, &rng, 3);
    }
    if (which == VARIANT_NOISE || which == VARIANT_MORE_NOISE) {
        gen_add_noise(&b, &rng, which == VARIANT_NOISE ? 0.15 : 0.4);
    }
    return gen_finish(&b, out);
}

sl_status variant_make(bend_model *model, int which, variant *out)
{
    sl_status status = SL_OK;
    *out = (variant){0};
    bend_by(model, which == VARIANT_BENT ? 90.0 : which == VARIANT_CURLED ? 240.0 : 0.0);
    out->polygons = model->polygons;
    if (which >= VARIANT_NOISE) {
        status = build(model, which, &out->owned);
        if (status == SL_OK) {
            sl_generated_polygons(out->owned, &out->polygons);
        }
    }
    return status;
}

void variant_clear(variant *v)
{
    sl_generated_free(v->owned);
    *v = (variant){0};
}

sl_status variant_seams(const bend_model *model, const sl_mesh *mesh, double **point, double **length, int32_t *count)
{
    int32_t *halfedge = NULL;
    sl_status status = SL_OK;
    *point = NULL;
    *length = NULL;
    SL_TRY(sl_atlas_seams(mesh, &halfedge, count));
    *point = sl_alloc(3 * (int64_t)*count + 1, sizeof **point);
    *length = sl_alloc((int64_t)*count + 1, sizeof **length);
    if (*point == NULL || *length == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    for (int32_t k = 0; k < *count; k++) {
        const double *a = model->rest + 3 * (int64_t)mesh->input_vertex[mesh->origin[halfedge[k]]],
                     *b = model->rest + 3 * (int64_t)mesh->input_vertex[sl_target(mesh, halfedge[k])];
        double square = 0.0;
        for (int i = 0; i < 3; i++) {
            (*point)[3 * (int64_t)k + i] = 0.5 * (a[i] + b[i]);
            square += (a[i] - b[i]) * (a[i] - b[i]);
        }
        (*length)[k] = sqrt(square);
    }
cleanup:
    sl_free(halfedge);
    return status;
}

double variant_covered(const double *a, const double *length, int32_t na, const double *b, int32_t nb, double reach)
{
    double covered = 0.0, all = 0.0;
    for (int32_t i = 0; i < na; i++) {
        double nearest = HUGE_VAL;
        for (int32_t j = 0; j < nb; j++) {
            double square = 0.0;
            for (int k = 0; k < 3; k++) {
                const double d = a[3 * (int64_t)i + k] - b[3 * (int64_t)j + k];
                square += d * d;
            }
            nearest = fmin(nearest, square);
        }
        all += length[i];
        covered += nearest <= reach * reach ? length[i] : 0.0;
    }
    return all > 0.0 ? covered / all : nb == 0 ? 1.0 : 0.0;
}
