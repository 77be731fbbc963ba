/* Where seams run: weights of the whole mesh's edges, so that a half is seen as a part of it. */
#include "optimize/optimize_internal.h"

#include "base/memory.h"
#include "mesh/facet_graph.h"

/* Facets in pairs where the options, or the mesh itself, ask for it; *partner = NULL otherwise. */
static sl_status pair_facets(const sl_mesh *mesh, sl_pairing pairing, int32_t **partner)
{
    double fraction = 0.0;
    *partner = NULL;
    if (pairing == SL_PAIR_OFF) {
        return SL_OK;
    }
    *partner = sl_alloc(mesh->nf, sizeof **partner);
    if (*partner == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    const sl_status status = sl_pair_triangles(mesh, *partner, &fraction);
    if (status != SL_OK || (pairing == SL_PAIR_AUTO && fraction < SL_PAIR_AUTO_FRACTION)) {
        sl_free(*partner);
        *partner = NULL;
    }
    return status;
}

static bool is_plain(const sl_seam_cost_def *d)
{
    return d->crease == 0.0 && d->concavity == 0.0 && d->visibility == 0.0 && d->loops == 0.0;
}

/* Makes the mean over all edges but diagonals 1, by length: what a chart costs keeps its meaning beside the seams. */
static void normalise(const sl_mesh *mesh, const int32_t *partner, double *weight)
{
    double length = 0.0, sum = 0.0;
    for (int32_t h = 0; h < mesh->nh; h++) {
        const int32_t t = sl_opposite(mesh, h);
        const bool diagonal = t >= 0 && partner != NULL && partner[mesh->face[h]] == mesh->face[t];
        if (h < t && !diagonal) {
            const double edge = sl_mesh_edge_length(mesh, h);
            length += edge;
            sum += edge * weight[h];
        }
    }
    for (int32_t h = 0; h < mesh->nh && sum > 0.0; h++) {
        weight[h] *= length / sum;
    }
}

sl_status sl_opt_weights(const sl_mesh *mesh, const sl_seam_cost_def *def, sl_pairing pairing,
                         const sl_context *context, double **weight)
{
    sl_status status = SL_OK;
    sl_seam_cost_def with = *def;
    int32_t *partner = NULL;
    *weight = NULL;
    if (is_plain(def) && pairing != SL_PAIR_ON) {
        return SL_OK;
    }
    SL_TRY(pair_facets(mesh, pairing, &partner));
    with.partner = partner;
    *weight = sl_alloc(mesh->nh, sizeof **weight);
    SL_TRY(*weight == NULL ? SL_OUT_OF_MEMORY : SL_OK);
    SL_TRY(sl_seam_cost_compute(mesh, &with, context, *weight));
    normalise(mesh, partner, *weight);
cleanup:
    sl_free(partner);
    if (status != SL_OK) {
        sl_free(*weight);
        *weight = NULL;
    }
    return status;
}
