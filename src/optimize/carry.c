/* Seams of a coarse surface carried over to the fine one: shortest paths near the coarse arcs. */
#include "optimize/decimate_internal.h"

#include "base/memory.h"
#include "geom/vec3.h"
#include "optimize/near_path_internal.h"

#include <math.h>
#include <string.h>

/* Parts whose ends are nearer to each other than this share of their length are halved: a path would take the short
 * way between the ends of a bend. */
static const double LEAST_CHORD = 0.6;

/* Weights of the energy beyond these come of borders that held a coarse map back; alone they make no good start. */
static const double LEAST_W = -8.0, MOST_W = 0.5;

typedef struct carrying {
    const sl_opt_state *coarse;
    const int32_t *vertex;
    sl_opt_state *fine;
    sl_near_path path; /* taken: vertices on seams, and ends of arcs */
} carrying;

/* Cuts the shortest path from the first to the last vertex of the line. */
static sl_status cut_path(carrying *c, bool *found)
{
    double cost;
    const sl_status status = sl_near_path_find(&c->path, &cost);
    const sl_patch *p = c->fine->surface->patch;
    *found = status == SL_OK && cost < HUGE_VAL;
    for (int32_t v = c->path.line[c->path.nline - 1]; *found && v != c->path.line[0];) {
        const int32_t h = c->path.parent[v];
        c->fine->cut[h] = c->fine->cut[p->twin[h]] = 1;
        c->path.taken[v] = 1;
        v = p->tri[h];
    }
    return status;
}

int32_t sl_opt_fine_vertex(const sl_opt_surface *coarse, const int32_t *vertex, int32_t corner)
{
    return vertex[coarse->mesh->input_vertex[coarse->mesh->origin[coarse->patch->corner[corner]]]];
}

/* The part of an arc from its halfedge `from` to `to` (not included, to > from) as a line of fine vertices. */
static void load_line(carrying *c, const int32_t *arc, int32_t from, int32_t to)
{
    const sl_opt_surface *s = c->coarse->surface;
    double length = 0.0;
    c->path.nline = 0;
    for (int32_t k = from; k < to; k++) {
        c->path.line[c->path.nline++] = sl_opt_fine_vertex(s, c->vertex, arc[k]);
        length += s->length[arc[k]] / s->unit * c->fine->surface->unit;
    }
    c->path.line[c->path.nline++] = sl_opt_fine_vertex(s, c->vertex, sl_corner_next(arc[to - 1]));
    c->path.width = length > 0.0 ? length / (to - from) : 1.0;
}

/* Does the line double back on itself? */
static bool is_bent(const carrying *c)
{
    const double *xyz = c->fine->surface->patch->xyz;
    const int32_t *line = c->path.line, last = c->path.nline - 1;
    double length = 0.0;
    for (int32_t k = 0; k < last; k++) {
        length += sl_vec3_distance(xyz + 3 * (int64_t)line[k], xyz + 3 * (int64_t)line[k + 1]);
    }
    return sl_vec3_distance(xyz + 3 * (int64_t)line[0], xyz + 3 * (int64_t)line[last]) < LEAST_CHORD * length;
}

/* Carries arc[from .. to - 1] over in parts that are straight enough; with `mark` only their ends are taken, so that no
 * path runs through them. The halves of a part are fewer edges: the recursion ends. */
static sl_status carry_part(carrying *c, const int32_t *arc, int32_t from, int32_t to, bool mark, bool *carried)
{
    sl_status status = SL_OK;
    load_line(c, arc, from, to);
    if (to - from > 1 && is_bent(c)) {
        const int32_t middle = from + (to - from) / 2;
        SL_TRY(carry_part(c, arc, from, middle, mark, carried));
        if (*carried) {
            SL_TRY(carry_part(c, arc, middle, to, mark, carried));
        }
    } else if (mark) {
        c->path.taken[c->path.line[0]] = c->path.taken[c->path.line[c->path.nline - 1]] = 1;
    } else {
        SL_TRY(cut_path(c, carried));
    }
cleanup:
    return status;
}

static sl_status cut_arcs(carrying *c, const sl_opt_arcs *arcs, bool *carried)
{
    sl_status status = SL_OK;
    for (int pass = 0; pass < 2; pass++) {
        for (int32_t k = 0; k < arcs->count && *carried; k++) {
            SL_TRY(carry_part(c, arcs->halfedge + arcs->first[k], 0, arcs->first[k + 1] - arcs->first[k], pass == 0,
                              carried));
        }
    }
cleanup:
    return status;
}

/* Charts of the fine surface between its seams, not laid flat yet. */
static sl_status make_charts(sl_opt_state *fine, bool *disks)
{
    sl_status status = SL_OK;
    const sl_patch *p = fine->surface->patch;
    int32_t *local = sl_alloc(p->nt, sizeof *local), *list = sl_alloc(p->nt, sizeof *list), n = 0;
    SL_TRY(local == NULL || list == NULL ? SL_OUT_OF_MEMORY : SL_OK);
    memset(local, 0xff, (size_t)p->nt * sizeof *local);
    memset(fine->chart_of, 0xff, (size_t)p->nt * sizeof *fine->chart_of);
    for (int32_t t = 0; t < p->nt; t++) {
        if (fine->chart_of[t] >= 0) {
            continue;
        }
        const int32_t start = n;
        fine->chart_of[t] = (int32_t)fine->nchart;
        list[n++] = t;
        for (int32_t at = start; at < n; at++) {
            for (int32_t h = 3 * list[at]; h < 3 * list[at] + 3; h++) {
                const int32_t g = p->twin[h] >= 0 && fine->cut[h] == 0 ? p->twin[h] / 3 : -1;
                if (g >= 0 && fine->chart_of[g] < 0) {
                    fine->chart_of[g] = (int32_t)fine->nchart;
                    list[n++] = g;
                }
            }
        }
        SL_TRY(sl_reserve((void **)&fine->chart, &fine->capacity, fine->nchart + 1, sizeof *fine->chart));
        sl_opt_chart *chart = &fine->chart[fine->nchart++];
        *chart = (sl_opt_chart){.stamp = fine->next_stamp++};
        SL_TRY(sl_opt_extract(fine->surface, fine->cut, list + start, n - start, local, &chart->patch));
        chart->uv = sl_calloc(2 * (int64_t)chart->patch->nv, sizeof *chart->uv);
        SL_TRY(chart->uv == NULL ? SL_OUT_OF_MEMORY : SL_OK);
        *disks = *disks && sl_patch_is_disk(chart->patch);
    }
cleanup:
    sl_free(local);
    sl_free(list);
    return status;
}

void sl_opt_uncut(sl_opt_state *fine)
{
    const sl_patch *p = fine->surface->patch;
    for (int64_t k = 0; k < fine->nchart; k++) {
        sl_opt_chart_clear(&fine->chart[k]);
    }
    fine->nchart = 0;
    memset(fine->cut, 0, 3 * (size_t)p->nt * sizeof *fine->cut);
    memset(fine->chart_of, 0xff, (size_t)p->nt * sizeof *fine->chart_of);
}

sl_status sl_opt_carry(const sl_opt_state *coarse, const int32_t *vertex, sl_opt_state *fine, bool *carried)
{
    sl_status status = SL_OK;
    sl_opt_arcs arcs = {0};
    carrying c = {.coarse = coarse, .vertex = vertex, .fine = fine};
    *carried = true;
    SL_TRY(sl_near_path_init(fine->surface, 3 * coarse->surface->patch->nt + 2, &c.path));
    SL_TRY(sl_opt_arcs_init(coarse, &arcs));
    SL_TRY(cut_arcs(&c, &arcs, carried));
    if (*carried) {
        SL_TRY(make_charts(fine, carried));
        *carried = *carried && fine->nchart == coarse->nchart;
    }
    sl_near_path_clear(&c.path); /* not kept beside the solver's memory */
    if (*carried) {
        fine->w = fmin(fmax(coarse->w, LEAST_W), MOST_W);
        SL_TRY(sl_opt_guess(coarse, vertex, fine));
        SL_TRY(sl_opt_unfold(fine, true, carried));
    }
cleanup:
    if (status != SL_OK || !*carried) {
        sl_opt_uncut(fine);
    }
    sl_near_path_clear(&c.path);
    sl_opt_arcs_clear(&arcs);
    return status;
}

sl_status sl_opt_coarse_weights(const sl_opt_surface *fine, const sl_mesh *mesh, const int32_t *vertex, double *weight)
{
    sl_status status = SL_OK;
    sl_near_path path = {0};
    double cost;
    SL_TRY(sl_near_path_init(fine, 2, &path));
    path.nline = 2;
    for (int32_t h = 0; h < mesh->nh; h++) {
        weight[h] = 1.0;
    }
    for (int32_t h = 0; h < mesh->nh; h++) {
        if (mesh->twin[h] < h) {
            continue; /* borders, which are never cut, and edges that had their turn */
        }
        for (int k = 0; k < 2; k++) {
            path.line[k] = vertex[mesh->input_vertex[mesh->origin[k == 0 ? h : mesh->twin[h]]]];
        }
        path.width = sl_vec3_distance(fine->patch->xyz + 3 * (int64_t)path.line[0],
                                      fine->patch->xyz + 3 * (int64_t)path.line[1]);
        SL_TRY(sl_near_path_find(&path, &cost));
        if (cost < HUGE_VAL && cost > 0.0 && path.width > 0.0) {
            weight[h] = weight[mesh->twin[h]] = cost / path.width;
        }
    }
cleanup:
    sl_near_path_clear(&path);
    return status;
}
