/* Choosing a cut of one chart; for a spectral one the candidates, the connectivity filter, the rules. */
#include "segment/segment_internal.h"

#include "base/memory.h"
#include "segment/baseline_internal.h"

#include <math.h>
#include <string.h>

static const double SAME_SCORE = 1e-9; /* relative: scores that differ less are equal, the lower vector is taken */

void sl_choice_clear(sl_choice *choice)
{
    sl_free(choice->side);
    *choice = (sl_choice){0};
}

/* Everything known about the cuts of one piece. */
typedef struct cut_search {
    const sl_piece *piece;
    const sl_segment_def *def;
    const sl_context *context;
    sl_facet_graph *graph;
    sl_spectrum *spectrum;
    sl_cut_candidate *candidates; /* spectrum->count - 1 */
    int32_t npassing;
    int32_t *passing;    /* indices of candidates in the order of the vectors */
    double *score;       /* npassing, the smallest wins */
    sl_status *status;   /* npassing */
    uint8_t *facet_side; /* npassing x facets, smoothed; lookahead only */
    bool *smoothed;
} cut_search;

static void cut_search_clear(cut_search *s)
{
    sl_facet_graph_free(s->graph);
    sl_spectrum_free(s->spectrum);
    sl_free(s->candidates);
    sl_free(s->passing);
    sl_free(s->score);
    sl_free(s->status);
    sl_free(s->facet_side);
    sl_free(s->smoothed);
}

static sl_status build_graph(cut_search *s, const int32_t *partner)
{
    const int32_t n = s->piece->mesh->nf;
    int32_t *all = sl_alloc(n, sizeof *all);
    if (all == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t f = 0; f < n; f++) {
        all[f] = f;
    }
    sl_status status = sl_facet_graph_create(s->piece->mesh, all, n, partner, &s->graph);
    if (status == SL_OK && s->graph->graph.n < 2 && n > 1 && partner != NULL) { /* one quad: split the pair itself */
        sl_facet_graph_free(s->graph);
        status = sl_facet_graph_create(s->piece->mesh, all, n, NULL, &s->graph);
    }
    sl_free(all);
    return status;
}

static bool has_places(const sl_piece *piece)
{
    bool all = piece->place != NULL;
    for (int32_t f = 0; f < piece->mesh->nf && all; f++) {
        all = piece->place[piece->face[f]] >= 0;
    }
    return all;
}

/* Ranks of the nodes where the piece is a part of one that was ordered; *rank = NULL otherwise. */
static sl_status inherited_ranks(const cut_search *s, int32_t **rank)
{
    const sl_piece *piece = s->piece;
    *rank = NULL;
    if (!has_places(piece)) {
        return SL_OK;
    }
    *rank = sl_alloc(s->graph->graph.n, sizeof **rank);
    for (int32_t f = piece->mesh->nf - 1; f >= 0 && *rank != NULL; f--) {
        (*rank)[s->graph->node[f]] = piece->place[piece->face[f]];
    }
    return *rank != NULL ? SL_OK : SL_OUT_OF_MEMORY;
}

/* Leaves the order of elimination to the parts. */
static sl_status bequeath(const cut_search *s)
{
    const sl_piece *piece = s->piece;
    const int32_t n = s->graph->graph.n;
    if (piece->place == NULL || s->spectrum->perm == NULL) {
        return SL_OK;
    }
    int32_t *rank = sl_alloc(n, sizeof *rank);
    if (rank == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t k = 0; k < n; k++) {
        rank[s->spectrum->perm[k]] = k;
    }
    for (int32_t f = 0; f < piece->mesh->nf; f++) {
        piece->place[piece->face[f]] = rank[s->graph->node[f]];
    }
    sl_free(rank);
    return SL_OK;
}

static sl_status find_spectrum(cut_search *s)
{
    sl_spectrum_def def = sl_spectrum_default();
    int32_t *rank = NULL;
    sl_status status = SL_OK;
    SL_TRY(inherited_ranks(s, &rank));
    def.count = s->def->vectors < 2 ? 2 : s->def->vectors; /* the Fiedler vector at least */
    def.mode = SL_LANCZOS_SIGNS;
    def.memory_limit = s->def->memory_limit;
    def.rank = rank;
    SL_TRY(sl_spectrum_solve(s->graph, &def, s->context, &s->spectrum));
    SL_TRY(rank == NULL ? bequeath(s) : SL_OK);
cleanup:
    sl_free(rank);
    return status;
}

static sl_status find_candidates(cut_search *s)
{
    sl_status status = SL_OK;
    SL_TRY(find_spectrum(s));
    s->candidates = sl_alloc(s->spectrum->count, sizeof *s->candidates);
    s->passing = sl_alloc(s->spectrum->count, sizeof *s->passing);
    if (s->candidates == NULL || s->passing == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    SL_TRY(sl_cut_candidates(s->piece->mesh, s->graph, s->spectrum, s->candidates));
    const bool all = !s->def->filter && s->def->rule != SL_RULE_LOOKAHEAD;
    for (int32_t k = 0; k < s->spectrum->count - 1; k++) {
        if (s->candidates[k].passes || all) {
            s->passing[s->npassing++] = k;
        }
    }
cleanup:
    return status;
}

/* side of every facet from one vector, smoothed as the options say. side: facets; node_side: scratch, nodes. */
static sl_status facet_sides(const cut_search *s, int32_t vector, bool smooth, uint8_t *node_side, uint8_t *side,
                             bool *smoothed)
{
    sl_status status = SL_OK;
    *smoothed = false;
    sl_spectrum_side(s->spectrum, vector, node_side);
    if (smooth) {
        SL_TRY(sl_smooth_cut(s->piece->mesh, s->graph, s->piece->weight, s->def->smooth, node_side, smoothed));
    }
    for (int32_t f = 0; f < s->piece->mesh->nf; f++) {
        side[f] = node_side[s->graph->node[f]];
    }
cleanup:
    return status;
}

static void look_ahead(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    (void)chunk;
    cut_search *s = user;
    for (int64_t k = begin; k < end; k++) {
        uint8_t *side = s->facet_side + k * s->piece->mesh->nf;
        uint8_t *node_side = sl_alloc(s->graph->graph.n, sizeof *node_side);
        s->status[k] = SL_OUT_OF_MEMORY;
        if (node_side != NULL) {
            const int32_t vector = s->candidates[s->passing[k]].vector;
            s->status[k] = facet_sides(s, vector, true, node_side, side, &s->smoothed[k]);
        }
        sl_free(node_side);
        if (s->status[k] == SL_OK) {
            s->status[k] = sl_lookahead_score(s->piece, side, NULL, &s->score[k]);
        }
    }
}

/* Scores of the passing candidates by the simple rules: the longest seam, as it is or over sqrt(lambda). */
static void score_by_length(const cut_search *s, sl_cut_rule rule)
{
    for (int32_t k = 0; k < s->npassing; k++) {
        const sl_cut_candidate *c = &s->candidates[s->passing[k]];
        const double lambda = s->spectrum->lambda[c->vector];
        s->score[k] = rule == SL_RULE_LONGEST ? -c->seam_length : -c->seam_length / sqrt(fmax(lambda, 1e-300));
    }
}

static sl_status score_candidates(cut_search *s)
{
    sl_status status = SL_OK;
    const int32_t n = s->piece->mesh->nf;
    s->score = sl_calloc(s->npassing, sizeof *s->score);
    s->status = sl_calloc(s->npassing, sizeof *s->status);
    s->smoothed = sl_calloc(s->npassing, sizeof *s->smoothed);
    if (s->score == NULL || s->status == NULL || s->smoothed == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    if (s->def->rule != SL_RULE_LOOKAHEAD) {
        score_by_length(s, s->def->rule);
        return SL_OK;
    }
    int64_t bytes = 0;
    SL_TRY(sl_mul_size(s->npassing, n, &bytes));
    s->facet_side = sl_alloc(bytes, sizeof *s->facet_side);
    if (s->facet_side == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    sl_parallel_for(s->context, s->npassing, 1, look_ahead, s);
    for (int32_t k = 0; k < s->npassing; k++) {
        SL_TRY(s->status[k]);
    }
cleanup:
    return status;
}

void sl_choice_measure(const sl_mesh *mesh, sl_choice *choice)
{
    choice->length = 0.0;
    choice->found = false;
    for (int32_t h = 0; h < mesh->nh; h++) {
        if (h < mesh->twin[h] && choice->side[mesh->face[h]] != choice->side[mesh->face[mesh->twin[h]]]) {
            choice->length += sl_mesh_edge_length(mesh, h);
            choice->found = true;
        }
    }
}

/* Fills in the winner, or the Fiedler vector's sides where nothing passed the filter. */
static sl_status take_cut(const cut_search *s, sl_choice *choice)
{
    sl_status status = SL_OK;
    const int32_t n = s->piece->mesh->nf;
    int32_t best = 0;
    for (int32_t k = 1; k < s->npassing; k++) {
        best = s->score[k] < s->score[best] - SAME_SCORE * fabs(s->score[best]) ? k : best;
    }
    uint8_t *side = sl_alloc(n, sizeof *side), *node_side = sl_alloc(s->graph->graph.n, sizeof *node_side);
    choice->side = sl_alloc(n, sizeof *choice->side);
    if (choice->side == NULL || side == NULL || node_side == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    const bool passed = s->npassing > 0;
    const int32_t vector = passed ? s->candidates[s->passing[best]].vector : 1;
    if (s->facet_side != NULL && passed) {
        memcpy(side, s->facet_side + (int64_t)best * n, (size_t)n);
        choice->smoothed = s->smoothed[best];
    } else {
        SL_TRY(facet_sides(s, vector, passed, node_side, side, &choice->smoothed));
    }
    for (int32_t f = 0; f < n; f++) {
        choice->side[f] = side[f];
    }
    choice->vector = passed ? vector : -1;
    choice->lambda = s->spectrum->lambda[vector];
    choice->candidates = s->npassing;
    sl_choice_measure(s->piece->mesh, choice);
cleanup:
    sl_free(side);
    sl_free(node_side);
    return status;
}

sl_status sl_choose_cut(const sl_piece *piece, const int32_t *partner, const sl_segment_def *def,
                        const sl_context *context, sl_choice *choice)
{
    sl_status status = SL_OK;
    cut_search s = {.piece = piece, .def = def, .context = context};
    *choice = (sl_choice){0};
    SL_TRY(build_graph(&s, partner));
    if (s.graph->graph.n >= 2 && def->method != SL_METHOD_SPECTRAL) {
        SL_TRY(sl_choose_baseline(piece, s.graph, def, context, choice));
    }
    if (s.graph->graph.n >= 2 && !choice->found) {
        SL_TRY(find_candidates(&s));
        SL_TRY(score_candidates(&s));
        SL_TRY(take_cut(&s, choice));
        if (def->method != SL_METHOD_SPECTRAL) { /* the last resort of any method */
            choice->vector = -1;
            choice->candidates = 0;
        }
    }
cleanup:
    if (status != SL_OK) {
        sl_choice_clear(choice);
    }
    cut_search_clear(&s);
    return status;
}
