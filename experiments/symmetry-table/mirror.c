#include "mirror.h"

#include <math.h>
#include <string.h>

const char *const rule_name[RULES] = {"longest", "length-lambda", "lookahead"};

static const double same_lambda = 1e-6; /* eigenvalues nearer than this share of themselves are taken together */
static const double precision = 1e-10;  /* residual of the pairs over the norm of L */
static const double least_sign = 1e-9;  /* of the largest entry: below this a sign is not decided by such pairs */

void model_clear(model *m)
{
    sl_mesh_free(m->mesh);
    sl_triangulation_free(m->triangulation);
    sl_symmetry_free(m->symmetry);
    sl_facet_graph_free(m->graph);
    sl_spectrum_free(m->spectrum);
    sl_mesh_free(m->shared_mesh);
    sl_segmentation_free(m->shared);
    for (int k = 0; k < RULES; k++) {
        sl_free(m->cut[k]);
    }
}

/* The first cut of a rule, as the eigenvectors make it. */
static sl_status first_cut(const model *m, int rule, const sl_context *context, int32_t **part)
{
    sl_segment_def def = sl_segment_default();
    sl_mesh *mesh = NULL;
    sl_segmentation *seg = NULL;
    int32_t count;
    sl_status status = SL_OK;
    def.rule = (sl_cut_rule)rule;
    def.symmetry = SL_SYMMETRY_USE_OFF;
    def.pairing = SL_PAIR_OFF;
    def.smooth = 0;
    def.join = def.sew = false;
    def.max_charts = 2;
    def.flatten.max_stretch = 1.0; /* even a flat model is to be cut */
    def.flatten.minimise_stretch = def.flatten.tutte = false;
    SL_TRY(sl_mesh_copy(m->mesh, &mesh));
    SL_TRY(sl_segment(mesh, m->triangulation, &def, context, &seg));
    *part = sl_alloc(mesh->nf, sizeof **part);
    SL_TRY(*part != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(sl_mesh_components(mesh, *part, &count));
cleanup:
    sl_segmentation_free(seg);
    sl_mesh_free(mesh);
    return status;
}

static sl_status build_graph(model *m)
{
    int32_t *all = sl_alloc(m->mesh->nf, sizeof *all);
    if (all == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t f = 0; f < m->mesh->nf; f++) {
        all[f] = f;
    }
    const sl_status status = sl_facet_graph_create(m->mesh, all, m->mesh->nf, NULL, &m->graph);
    sl_free(all);
    return status;
}

sl_status model_create(const sl_generated *generated, const sl_context *context, model *out)
{
    sl_status status = SL_OK;
    sl_polygons polygons;
    sl_repair_report report = {0};
    const sl_segment_def def = sl_segment_default();
    const sl_symmetry_def find = sl_symmetry_default();
    sl_spectrum_def spectrum = sl_spectrum_default();
    *out = (model){.generated = generated};
    sl_generated_polygons(generated, &polygons);
    SL_TRY(sl_mesh_build(&polygons, &out->mesh, &report, NULL));
    out->components = report.components;
    SL_TRY(sl_triangulation_create(out->mesh, &out->triangulation));
    SL_TRY(sl_symmetry_find(out->mesh, NULL, &find, context, &out->symmetry));
    SL_TRY(sl_mesh_copy(out->mesh, &out->shared_mesh));
    SL_TRY(sl_segment(out->shared_mesh, out->triangulation, &def, context, &out->shared));
    if (out->components == 1) {
        spectrum.count = VECTORS;
        spectrum.tolerance = precision;
        SL_TRY(build_graph(out));
        SL_TRY(sl_spectrum_solve(out->graph, &spectrum, context, &out->spectrum));
        for (int rule = 0; rule < RULES; rule++) {
            SL_TRY(first_cut(out, rule, context, &out->cut[rule]));
        }
    }
cleanup:
    sl_repair_report_clear(&report);
    return status;
}

/* Is there a map that does to component c's facets what the mirror does? One that goes elsewhere: a copy is enough. */
static bool component_found(const model *m, const sl_planted *planted, int32_t c)
{
    const sl_symmetry *s = m->symmetry;
    const int32_t *face = s->face + s->first[c], count = s->first[c + 1] - s->first[c];
    const int32_t to = s->component[planted->face[face[0]]];
    if (to != c) {
        return s->original[to] == s->original[c];
    }
    if (s->original[c] != c) {
        return true; /* listed for its original */
    }
    for (int32_t k = 0; k < s->nmap; k++) {
        int32_t i = 0;
        while (s->map[k].from == c && s->map[k].to == c && s->map[k].reverses && i < count &&
               sl_symmetry_image(m->mesh, s, &s->map[k], face[i]) == planted->face[face[i]]) {
            i++;
        }
        if (i == count) {
            return true;
        }
    }
    return false;
}

/* Halves of a cut, facet by facet: does the mirror exchange them? */
static bool is_axis_cut(const sl_planted *planted, int32_t nf, const int32_t *part)
{
    for (int32_t f = 0; f < nf; f++) {
        const int32_t g = planted->face[f];
        if (part[f] > 1 || (g != f && part[f] == part[g])) {
            return false;
        }
    }
    return true;
}

/* The settings of `--preset fast` cut its axis everywhere, and copies take their UVs through it. */
static bool is_used(const model *m, const sl_planted *planted)
{
    const sl_mesh *mesh = m->shared_mesh;
    bool copies = false;
    if (m->shared->source == NULL) {
        return false;
    }
    for (int32_t h = 0; h < mesh->nh; h++) {
        const int32_t f = mesh->face[h], g = planted->face[f], from = m->shared->source[h];
        if (mesh->twin[h] >= 0 && g != f && mesh->face[mesh->twin[h]] == g) {
            return false;
        }
        copies |= from >= 0 && g != f && mesh->face[from] == g;
    }
    return copies;
}

/* The share of v that is antisymmetric: |v - P v|^2 / 4 for |v| = 1. Writes (v - P v) / 2. */
static double antisymmetric_part(const sl_planted *planted, int32_t n, const double *v, double *part)
{
    double sum = 0.0;
    for (int32_t f = 0; f < n; f++) {
        part[f] = 0.5 * (v[f] - v[planted->face[f]]);
        sum += part[f] * part[f];
    }
    return sum;
}

/* The lowest antisymmetric vector: the first group of equal eigenvalues whose antisymmetric parts add up to one at
 * least. best: n, that vector. Returns its number, -1 = none. */
static int32_t lowest_antisymmetric(const model *m, const sl_planted *planted, double *part, double *best)
{
    const sl_spectrum *s = m->spectrum;
    int32_t k = 1;
    while (k < s->count) {
        int32_t end = k + 1;
        while (end < s->count && s->lambda[end] - s->lambda[end - 1] <= same_lambda * s->lambda[end]) {
            end++;
        }
        double sum = 0.0, largest = -1.0;
        for (int32_t j = k; j < end; j++) {
            const double share = antisymmetric_part(planted, s->n, s->vectors + (int64_t)j * s->n, part);
            sum += share;
            if (share > largest) {
                largest = share;
                memcpy(best, part, (size_t)s->n * sizeof *best);
            }
        }
        if (sum > 0.5) {
            return k;
        }
        k = end;
    }
    return -1;
}

/* Connected parts of the two sides over twins. */
static sl_status count_sides(const sl_mesh *mesh, const uint8_t *side, int32_t *parts)
{
    sl_status status = SL_OK;
    sl_mesh *cut = NULL;
    int32_t *label = sl_alloc(mesh->nf, sizeof *label);
    SL_TRY(label != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(sl_mesh_copy(mesh, &cut));
    for (int32_t h = 0; h < mesh->nh; h++) {
        if (mesh->twin[h] >= 0 && side[mesh->face[h]] != side[mesh->face[mesh->twin[h]]]) {
            sl_mesh_cut_edge(cut, h);
        }
    }
    SL_TRY(sl_mesh_components(cut, label, parts));
cleanup:
    sl_mesh_free(cut);
    sl_free(label);
    return status;
}

/* Sides of an antisymmetric vector: facets that are their own images, exact zeros, lie in F+. sure[f]: is the sign
 * decided? Returns how many are not. */
static int32_t take_sides(const sl_planted *planted, const double *v, int32_t n, uint8_t *side, uint8_t *sure)
{
    double largest = 0.0;
    int32_t undecided = 0;
    for (int32_t f = 0; f < n; f++) {
        largest = fmax(largest, fabs(v[f]));
    }
    for (int32_t f = 0; f < n; f++) {
        side[f] = v[f] >= 0.0;
        sure[f] = planted->face[f] == f || fabs(v[f]) > least_sign * largest;
        undecided += !sure[f];
    }
    return undecided;
}

/* Is the seam the axis where signs are decided: edges between a facet and its image, and between a facet that is its
 * own image and F-? */
static bool seam_is_axis(const sl_mesh *mesh, const sl_planted *planted, const uint8_t *side, const uint8_t *sure)
{
    for (int32_t h = 0; h < mesh->nh; h++) {
        if (mesh->twin[h] < 0) {
            continue;
        }
        const int32_t f = mesh->face[h], g = mesh->face[mesh->twin[h]];
        if (!sure[f] || !sure[g]) {
            continue;
        }
        const bool fixed = planted->face[f] == f || planted->face[g] == g;
        const bool axis = (planted->face[f] == g && f != g) || (fixed && side[f] != side[g]);
        if (axis != (side[f] != side[g])) {
            return false;
        }
    }
    return true;
}

static sl_status measure_vector(const model *m, const sl_planted *planted, mirror_facts *out)
{
    sl_status status = SL_OK;
    const int32_t n = m->mesh->nf;
    int32_t parts = 0;
    double *part = sl_alloc(n, sizeof *part), *best = sl_alloc(n, sizeof *best);
    uint8_t *side = sl_alloc(n, sizeof *side), *sure = sl_alloc(n, sizeof *sure);
    if (part == NULL || best == NULL || side == NULL || sure == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    out->index = lowest_antisymmetric(m, planted, part, best);
    if (out->index >= 0) {
        out->lambda = m->spectrum->lambda[out->index];
        out->among_usual = out->index < USUAL_VECTORS;
        out->undecided = take_sides(planted, best, n, side, sure);
        SL_TRY(count_sides(m->mesh, side, &parts));
        out->passes = parts == 2;
        out->exact_seam = seam_is_axis(m->mesh, planted, side, sure);
    }
cleanup:
    sl_free(part);
    sl_free(best);
    sl_free(side);
    sl_free(sure);
    return status;
}

sl_status mirror_measure(const model *m, const sl_planted *planted, mirror_facts *out)
{
    *out = (mirror_facts){.found = true, .index = -1};
    for (int32_t c = 0; c < m->symmetry->components; c++) {
        out->found = out->found && component_found(m, planted, c);
    }
    for (int32_t f = 0; f < m->mesh->nf; f++) {
        out->fixed += planted->face[f] == f;
    }
    out->used = is_used(m, planted);
    for (int rule = 0; rule < RULES && m->spectrum != NULL; rule++) {
        out->chosen[rule] = is_axis_cut(planted, m->mesh->nf, m->cut[rule]);
    }
    return m->spectrum != NULL ? measure_vector(m, planted, out) : SL_OK;
}

int32_t count_exact_mirrors(const model *m)
{
    int32_t count = 0;
    for (int32_t k = 0; k < m->symmetry->nmap; k++) {
        const sl_symmetry_map *map = &m->symmetry->map[k];
        count += map->from == map->to && map->order == 2 && map->reverses && map->kind == SL_SYMMETRY_EXACT;
    }
    return count;
}
