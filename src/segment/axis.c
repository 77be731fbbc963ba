/* Axes of symmetry: which mirror of a piece is taken, and the cut along it. */
#include "segment/share_internal.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

enum { FINALISTS = 6 }; /* mirrors whose halves are flattened for comparison */

static const double SAME_AREA = 1e-9; /* relative: shares that differ less are equal */

/* A mirror that could be used. */
typedef struct axis {
    const sl_symmetry_map *map;
    double shared; /* area of the half that copies */
    int32_t parts; /* connected parts of both sides */
    double score;  /* of its halves, smaller is better */
} axis;

void sl_copy_list_clear(sl_copy_list *list)
{
    sl_free(list->corner);
    sl_free(list->from);
    *list = (sl_copy_list){0};
}

/* image[h] of all corners of the piece, which is one component. */
static void fill_image(const sl_mesh *mesh, const sl_symmetry *symmetry, const sl_symmetry_map *map, int32_t *image)
{
    const int32_t *face = symmetry->face + symmetry->first[map->from];
    for (int32_t i = 0, k = 0; i < map->count; i++) {
        for (int32_t h = mesh->face_first[face[i]]; h < mesh->face_first[face[i] + 1]; h++) {
            image[h] = map->corner[k++];
        }
    }
}

/* Connected parts of the two sides. label: scratch, nf; stack: scratch, nf. */
static int32_t count_parts(const sl_mesh *mesh, const uint8_t *side, uint8_t *seen, int32_t *stack)
{
    int32_t parts = 0;
    memset(seen, 0, (size_t)mesh->nf);
    for (int32_t f = 0; f < mesh->nf; f++) {
        int32_t top = 0;
        if (!seen[f]) {
            parts++;
            seen[f] = 1;
            stack[top++] = f;
        }
        while (top > 0) {
            const int32_t g = stack[--top];
            for (int32_t h = mesh->face_first[g]; h < mesh->face_first[g + 1]; h++) {
                const int32_t n = mesh->twin[h] >= 0 ? mesh->face[mesh->twin[h]] : g;
                if (!seen[n] && side[n] == side[g]) {
                    seen[n] = 1;
                    stack[top++] = n;
                }
            }
        }
    }
    return parts;
}

/* Arrays that judging mirrors needs. */
typedef struct axis_search {
    const sl_piece *piece;
    sl_symmetry *symmetry;
    uint8_t *side, *seen;
    int32_t *stack, *image;
    axis best[FINALISTS];
    int32_t nbest;
} axis_search;

static void axis_search_clear(axis_search *s)
{
    sl_symmetry_free(s->symmetry);
    sl_free(s->side);
    sl_free(s->seen);
    sl_free(s->stack);
    sl_free(s->image);
}

static sl_status axis_search_create(axis_search *s)
{
    const sl_mesh *m = s->piece->mesh;
    s->side = sl_alloc(m->nf, sizeof *s->side);
    s->seen = sl_alloc(m->nf, sizeof *s->seen);
    s->stack = sl_alloc(m->nf, sizeof *s->stack);
    s->image = sl_alloc(m->nh, sizeof *s->image);
    const bool ok = s->side != NULL && s->seen != NULL && s->stack != NULL && s->image != NULL;
    return ok ? SL_OK : SL_OUT_OF_MEMORY;
}

/* Every corner of the second half takes its UV from the first. */
static bool copies_cleanly(const sl_mesh *mesh, const uint8_t *side, const int32_t *image)
{
    for (int32_t h = 0; h < mesh->nh; h++) {
        if (side[mesh->face[h]] == 0 && (image[h] < 0 || side[mesh->face[image[h]]] != 1)) {
            return false;
        }
    }
    return true;
}

static bool is_better(const axis *a, const axis *b)
{
    if (a->parts != b->parts) {
        return a->parts < b->parts;
    }
    if (fabs(a->shared - b->shared) > SAME_AREA * fmax(a->shared, b->shared)) {
        return a->shared > b->shared;
    }
    return a->map->axis_length > b->map->axis_length * (1.0 + SAME_AREA);
}

/* Puts a mirror among the best found so far; earlier ones stay before equals. */
static void enter(axis_search *s, axis candidate)
{
    int32_t at = s->nbest;
    while (at > 0 && is_better(&candidate, &s->best[at - 1])) {
        at--;
    }
    if (at < FINALISTS) {
        const int32_t kept = s->nbest < FINALISTS ? s->nbest++ : FINALISTS - 1;
        memmove(&s->best[at + 1], &s->best[at], (size_t)(kept - at) * sizeof *s->best);
        s->best[at] = candidate;
    }
}

/* Exact also where a rigid motion carries every corner onto its image as nearly as the edge lengths of large facets
 * must agree: coordinates written with six decimals leave short edges no more than that. */
static bool is_exact(const sl_symmetry_map *map)
{
    return map->kind == SL_SYMMETRY_EXACT ||
           (map->kind == SL_SYMMETRY_NEAR && map->deviation <= sl_symmetry_default().exact);
}

static bool is_usable(const sl_symmetry_map *map, sl_symmetry_use use)
{
    const bool close = is_exact(map) || (map->kind == SL_SYMMETRY_NEAR && use == SL_SYMMETRY_USE_NEAR);
    return map->from == map->to && map->order == 2 && map->separates && close;
}

/* The usable mirrors, best first; exact ones leave no room for near ones. */
static sl_status list_axes(axis_search *s, sl_symmetry_use use)
{
    sl_status status = SL_OK;
    const sl_mesh *m = s->piece->mesh;
    bool exact = false;
    for (int32_t k = 0; k < s->symmetry->nmap; k++) {
        exact |= is_usable(&s->symmetry->map[k], SL_SYMMETRY_USE_EXACT);
    }
    for (int32_t k = 0; k < s->symmetry->nmap; k++) {
        const sl_symmetry_map *map = &s->symmetry->map[k];
        if (!is_usable(map, exact ? SL_SYMMETRY_USE_EXACT : use)) {
            continue;
        }
        axis a = {.map = map};
        SL_TRY(sl_symmetry_sides(m, s->symmetry, map, s->side));
        fill_image(m, s->symmetry, map, s->image);
        for (int32_t f = 0; f < m->nf; f++) {
            a.shared += s->side[f] == 0 ? sl_mesh_face_area(m, f) : 0.0;
        }
        if (a.shared > 0.0 && copies_cleanly(m, s->side, s->image)) {
            a.parts = count_parts(m, s->side, s->seen, s->stack);
            enter(s, a);
        }
    }
cleanup:
    return status;
}

/* Of mirrors that share the same area in the same number of parts, the one whose halves flatten best. */
static sl_status choose_axis(axis_search *s, const sl_context *context, int32_t *best)
{
    sl_status status = SL_OK;
    int32_t rivals = 1;
    *best = 0;
    while (rivals < s->nbest && s->best[rivals].parts == s->best[0].parts &&
           fabs(s->best[rivals].shared - s->best[0].shared) <= SAME_AREA * s->best[0].shared) {
        rivals++;
    }
    for (int32_t k = 0; rivals > 1 && k < rivals; k++) {
        SL_TRY(sl_symmetry_sides(s->piece->mesh, s->symmetry, s->best[k].map, s->side));
        SL_TRY(sl_lookahead_score(s->piece, s->side, context, &s->best[k].score));
        if (s->best[k].score < s->best[*best].score - SAME_AREA * fabs(s->best[*best].score)) {
            *best = k;
        }
    }
cleanup:
    return status;
}

/* What the second half takes from the first. */
static sl_status list_copies(const sl_mesh *mesh, const uint8_t *side, const int32_t *image, sl_copy_list *copies)
{
    copies->corner = sl_alloc(mesh->nh, sizeof *copies->corner);
    copies->from = sl_alloc(mesh->nh, sizeof *copies->from);
    if (copies->corner == NULL || copies->from == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t h = 0; h < mesh->nh; h++) {
        if (side[mesh->face[h]] == 0) {
            copies->corner[copies->count] = h;
            copies->from[copies->count++] = image[h];
        }
    }
    return SL_OK;
}

/* Takes the parts of the second half out of the list of parts. number: scratch, job->nparts. */
static void drop_second_half(const uint8_t *side, int32_t nf, int32_t *number, sl_chart_job *job)
{
    int32_t kept = 0;
    memset(number, 0xff, (size_t)job->nparts * sizeof *number);
    for (int32_t f = 0; f < nf; f++) {
        if (side[f] == 1 && number[job->part[f]] < 0) {
            number[job->part[f]] = kept++;
        }
    }
    for (int32_t f = 0; f < nf; f++) {
        job->part[f] = side[f] == 1 ? number[job->part[f]] : -1;
    }
    job->nparts = kept;
}

static sl_split split_of(const sl_mesh *mesh, const sl_chart_job *job, sl_split_symmetry symmetry)
{
    sl_split split = {.depth = job->depth,
                      .facets = job->count,
                      .vector = -1,
                      .parts = job->nparts,
                      .symmetry = symmetry,
                      .because = job->flat.verdict};
    for (int32_t k = 0; k < job->seam.count; k++) {
        split.length += sl_mesh_edge_length(mesh, job->seam.halfedge[k]);
    }
    return split;
}

static sl_status take_axis(axis_search *s, sl_piece *piece, const axis *chosen, sl_chart_job *job)
{
    sl_status status = SL_OK;
    const int32_t n = piece->mesh->nf;
    int32_t *side = sl_alloc(n, sizeof *side);
    if (side == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    SL_TRY(sl_symmetry_sides(piece->mesh, s->symmetry, chosen->map, s->side));
    fill_image(piece->mesh, s->symmetry, chosen->map, s->image);
    SL_TRY(list_copies(piece->mesh, s->side, s->image, &job->copies));
    job->copies.reverses = chosen->map->reverses;
    job->copies.kind = is_exact(chosen->map) ? SL_SYMMETRY_EXACT : SL_SYMMETRY_NEAR;
    job->misfit = chosen->map->deviation;
    for (int32_t f = 0; f < n; f++) {
        side[f] = s->side[f];
    }
    SL_TRY(sl_label_parts(piece, side, job));
    job->split = split_of(piece->mesh, job, SL_SPLIT_MIRROR);
    job->split.fixed = chosen->map->fixed_facets;
    drop_second_half(s->side, n, s->stack, job);
cleanup:
    sl_free(side);
    return status;
}

sl_status sl_cut_axis(const sl_recursion *recursion, sl_piece *piece, const int32_t *partner, sl_chart_job *job,
                      bool *taken)
{
    sl_status status = SL_OK;
    axis_search s = {.piece = piece};
    int32_t best = 0;
    sl_symmetry_def def = sl_symmetry_default();
    def.mirrors_only = true;
    *taken = false;
    if (piece->mesh->nf < 2) {
        return SL_OK;
    }
    SL_TRY(sl_symmetry_find(piece->mesh, partner, &def, recursion->context, &s.symmetry));
    job->truncated = s.symmetry->truncated;
    SL_TRY(axis_search_create(&s));
    SL_TRY(list_axes(&s, recursion->def->symmetry));
    if (s.nbest > 0) {
        SL_TRY(choose_axis(&s, recursion->context, &best));
        SL_TRY(take_axis(&s, piece, &s.best[best], job));
        *taken = true;
    }
cleanup:
    axis_search_clear(&s);
    return status;
}

/* side of every node by the plane, 1 above it; smoothed as the options say. */
static sl_status plane_sides(const sl_piece *piece, const sl_facet_graph *graph, const sl_near_mirror *mirror,
                             int32_t rings, uint8_t *side, bool *smoothed)
{
    for (int32_t v = 0; v < graph->graph.n; v++) {
        const double *c = graph->centroid + 3 * (int64_t)v;
        side[v] = c[0] * mirror->normal[0] + c[1] * mirror->normal[1] + c[2] * mirror->normal[2] >= mirror->offset;
    }
    return rings > 0 ? sl_smooth_cut(piece->mesh, graph, piece->weight, rings, side, smoothed) : SL_OK;
}

sl_status sl_cut_near_plane(const sl_recursion *recursion, sl_piece *piece, const int32_t *partner, sl_chart_job *job,
                            bool *taken)
{
    sl_status status = SL_OK;
    const int32_t n = piece->mesh->nf;
    const sl_symmetry_def def = sl_symmetry_default();
    sl_facet_graph *graph = NULL;
    sl_near_mirror mirror;
    bool smoothed = false;
    uint8_t *node_side = NULL;
    int32_t *side = sl_alloc(n, sizeof *side);
    *taken = false;
    if (side == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    SL_TRY(sl_symmetry_near(piece->mesh, &def, recursion->context, NULL, &mirror));
    if (!mirror.found) {
        goto cleanup;
    }
    for (int32_t f = 0; f < n; f++) {
        side[f] = f;
    }
    SL_TRY(sl_facet_graph_create(piece->mesh, side, n, partner, &graph));
    node_side = sl_alloc(graph->graph.n, sizeof *node_side);
    if (node_side == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    SL_TRY(plane_sides(piece, graph, &mirror, recursion->def->smooth, node_side, &smoothed));
    int32_t above = 0;
    for (int32_t f = 0; f < n; f++) {
        side[f] = node_side[graph->node[f]];
        above += side[f];
    }
    if (above > 0 && above < n) {
        SL_TRY(sl_label_parts(piece, side, job));
        job->split = split_of(piece->mesh, job, SL_SPLIT_PLANE);
        job->split.smoothed = smoothed;
        job->misfit = mirror.misfit_mean;
        *taken = true;
    }
cleanup:
    sl_free(side);
    sl_free(node_side);
    sl_facet_graph_free(graph);
    return status;
}
