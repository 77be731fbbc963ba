#include "atlas/sidecar.h"

#include "base/file.h"
#include "base/memory.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char suffix[] = ".atlas.json";

void sl_sidecar_path(const char *atlas_path, char *text, size_t size)
{
    const char *slash = strrchr(atlas_path, '/'), *dot = strrchr(atlas_path, '.');
    size_t stem = strlen(atlas_path);
    if (dot != NULL && dot > (slash != NULL ? slash + 1 : atlas_path)) {
        stem = (size_t)(dot - atlas_path);
    }
    snprintf(text, size, "%.*s%s", (int)stem, atlas_path, suffix);
}

/* A number, or null where JSON has none for it. */
static json_t *number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

static json_t *integers(const int32_t *value, int32_t count)
{
    json_t *list = json_array();
    for (int32_t i = 0; i < count; i++) {
        json_array_append_new(list, json_integer(value[i]));
    }
    return list;
}

static json_t *repair_json(const sl_repair_report *r)
{
    json_t *j = json_object();
    json_object_set_new(j, "vertices", json_integer(r->vertices));
    json_object_set_new(j, "faces", json_integer(r->faces));
    json_object_set_new(j, "components", json_integer(r->components));
    json_object_set_new(j, "border_loops", json_integer(r->border_loops));
    json_object_set_new(j, "genus", json_integer(r->genus));
    json_object_set_new(j, "reversed_faces", integers(r->reversed, r->reversed_faces));
    json_object_set_new(j, "duplicate_faces", integers(r->duplicate, r->duplicate_faces));
    json_object_set_new(j, "degenerate_faces", integers(r->degenerate, r->degenerate_faces));
    json_object_set_new(j, "bowtie_vertices", integers(r->bowtie, r->bowtie_vertices));
    json_object_set_new(j, "nonmanifold_edges", integers(r->nonmanifold, 2 * r->nonmanifold_edges));
    json_object_set_new(j, "one_sided_cuts", json_integer(r->one_sided_cuts));
    return j;
}

static const char *rule_name(sl_cut_rule rule)
{
    return rule == SL_RULE_LONGEST ? "longest" : rule == SL_RULE_LENGTH_LAMBDA ? "length-lambda" : "lookahead";
}

static const char *pairing_name(sl_pairing pairing)
{
    return pairing == SL_PAIR_AUTO ? "auto" : pairing == SL_PAIR_ON ? "on" : "off";
}

static const char *source_name(sl_seam_source source)
{
    static const char *const names[] = {
        [SL_SEAMS_AUTOMATIC] = "automatic",
        [SL_SEAMS_EDGES] = "edges",
        [SL_SEAMS_LABELS] = "labels",
        [SL_SEAMS_KEEP_UV] = "kept",
    };
    return names[source];
}

static const char *symmetry_use_name(sl_symmetry_use use)
{
    static const char *const names[] = {
        [SL_SYMMETRY_USE_AUTO] = "auto",
        [SL_SYMMETRY_USE_OFF] = "off",
        [SL_SYMMETRY_USE_EXACT] = "exact",
        [SL_SYMMETRY_USE_NEAR] = "near",
    };
    return names[use];
}

static const char *method_name(sl_cut_method method)
{
    static const char *const names[] = {
        [SL_METHOD_SPECTRAL] = "spectral",   [SL_METHOD_PCA] = "pca",       [SL_METHOD_VSA] = "vsa",
        [SL_METHOD_FIEDLER] = "fiedler",     [SL_METHOD_RANDOM] = "random", [SL_METHOD_ISOCHARTS] = "isocharts",
        [SL_METHOD_EMBEDDING] = "embedding",
    };
    return names[method];
}

static const char *split_symmetry_name(sl_split_symmetry symmetry)
{
    static const char *const names[] = {
        [SL_SPLIT_PLAIN] = "none",
        [SL_SPLIT_MIRROR] = "axis",
        [SL_SPLIT_HALVES] = "halves",
        [SL_SPLIT_PLANE] = "plane",
    };
    return names[symmetry];
}

/* What symmetry saved: copies take no room on the page. */
static json_t *symmetry_json(const sl_atlas *atlas)
{
    const sl_sharing_info *s = &atlas->segmentation->sharing;
    json_t *j = json_object();
    json_object_set_new(j, "axes", json_integer(s->axes));
    json_object_set_new(j, "component_copies", json_integer(s->components));
    json_object_set_new(j, "copied_charts", json_integer(s->copies));
    json_object_set_new(j, "refused_charts", json_integer(s->refused));
    json_object_set_new(j, "texture_memory_saved", number(s->area));
    json_object_set_new(j, "truncated", json_boolean(s->truncated));
    json_object_set_new(j, "near_planes", json_integer(s->planes));
    json_object_set_new(j, "near_plane_misfit", number(s->misfit));
    json_object_set_new(j, "near_axes", json_integer(s->near_axes));
    json_object_set_new(j, "near_axis_deviation", number(s->deviation));
    json_object_set_new(j, "near_tolerance", number(sl_symmetry_default().near));
    return j;
}

static json_t *weights_json(const sl_seam_cost_def *w)
{
    json_t *j = json_object();
    json_object_set_new(j, "crease", number(w->crease));
    json_object_set_new(j, "concave", number(w->concavity));
    json_object_set_new(j, "hidden", number(w->visibility));
    json_object_set_new(j, "loops", number(w->loops));
    return j;
}

static json_t *options_json(const sl_atlas_def *def)
{
    const sl_segment_def *s = &def->segment;
    json_t *j = json_object();
    json_object_set_new(j, "seams", json_string(source_name(def->seams)));
    json_object_set_new(j, "method", json_string(method_name(s->method)));
    json_object_set_new(j, "symmetry", json_string(symmetry_use_name(s->symmetry)));
    json_object_set_new(j, "test_halves", json_boolean(s->test_halves));
    json_object_set_new(j, "unshare", json_boolean(s->unshare));
    json_object_set_new(j, "rule", json_string(rule_name(s->rule)));
    json_object_set_new(j, "vectors", json_integer(s->vectors));
    json_object_set_new(j, "pair", json_string(pairing_name(s->pairing)));
    json_object_set_new(j, "filter", json_boolean(s->filter));
    json_object_set_new(j, "smooth", json_integer(s->smooth));
    json_object_set_new(j, "join", json_boolean(s->join));
    json_object_set_new(j, "sew", json_boolean(s->sew));
    json_object_set_new(j, "sew_stretch", number(s->sew_stretch));
    json_object_set_new(j, "max_stretch", number(s->flatten.max_stretch));
    json_object_set_new(j, "max_angle", number(s->flatten.max_angle));
    json_object_set_new(j, "max_charts", json_integer(s->max_charts));
    json_object_set_new(j, "energy", json_string(s->flatten.abf.energy == SL_ABF_WEIGHTED ? "weighted" : "unweighted"));
    json_object_set_new(j, "tutte", json_boolean(s->flatten.tutte));
    json_object_set_new(j, "minimise_stretch", json_boolean(s->flatten.minimise_stretch));
    json_object_set_new(j, "best", json_boolean(def->best));
    if (def->best) {
        static const char *const protect[] = {"none", "axis", "first"};
        json_object_set_new(j, "target_stretch", number(def->optimize.target_stretch));
        json_object_set_new(j, "target_angle", number(def->optimize.target_angle));
        json_object_set_new(j, "chart_cost", number(def->optimize.chart_cost));
        json_object_set_new(j, "empty_cost", number(def->optimize.empty_cost));
        json_object_set_new(j, "search_effort", number(def->optimize.effort));
        json_object_set_new(j, "seam_cost", number(def->optimize.seam_cost));
        json_object_set_new(j, "protect", json_string(protect[def->optimize.protect]));
        json_object_set_new(j, "weights", weights_json(&def->optimize.weights));
    }
    json_object_set_new(j, "resolution", json_integer(def->pack.resolution));
    json_object_set_new(j, "height", json_integer(def->pack.height > 0 ? def->pack.height : def->pack.resolution));
    json_object_set_new(j, "margin", number(def->pack.margin));
    json_object_set_new(j, "pages", json_integer(def->pack.pages));
    json_object_set_new(j, "density", number(def->pack.density));
    return j;
}

static json_t *chart_json(const sl_atlas *atlas, int32_t c)
{
    const sl_chart *chart = &atlas->segmentation->chart[c];
    const sl_placement *p = &atlas->placement[c];
    const sl_distortion *d = &chart->flat.distortion;
    json_t *j = json_object();
    json_object_set_new(j, "faces", json_integer(chart->count));
    json_object_set_new(j, "first_face", json_integer(atlas->segmentation->face[chart->first]));
    json_object_set_new(j, "verdict", json_string(sl_flatten_verdict_name(chart->flat.verdict)));
    json_object_set_new(j, "method", json_string(sl_flatten_method_name(chart->flat.method)));
    json_object_set_new(j, "stretch_minimised", json_boolean(chart->flat.stretch_minimised));
    json_object_set_new(j, "abf_iterations", json_integer(chart->flat.abf.iterations));
    json_object_set_new(j, "abf_gradient", number(chart->flat.abf.gradient));
    json_object_set_new(j, "l2", number(d->l2));
    json_object_set_new(j, "linf", number(d->linf));
    json_object_set_new(j, "angle_mean", number(d->angle_mean));
    json_object_set_new(j, "angle_max", number(d->angle_max));
    json_object_set_new(j, "genus", json_integer(chart->topology.genus));
    json_object_set_new(j, "loops", json_integer(chart->topology.loops));
    json_object_set_new(j, "capped", json_boolean(chart->capped));
    json_object_set_new(j, "copy_of", chart->copy_of >= 0 ? json_integer(chart->copy_of) : json_null());
    json_object_set_new(j, "mirrored", json_boolean(chart->mirrored));
    json_object_set_new(j, "kind",
                        chart->copy_of < 0                 ? json_null()
                        : chart->kind == SL_SYMMETRY_EXACT ? json_string("exact")
                                                           : json_string("near"));
    json_object_set_new(j, "page", json_integer(p->page));
    json_object_set_new(
        j, "placement",
        json_pack("{s:o, s:[o,o]}", "angle", number(p->angle), "offset", number(p->offset[0]), number(p->offset[1])));
    return j;
}

static json_t *charts_json(const sl_atlas *atlas)
{
    json_t *list = json_array();
    for (int32_t c = 0; c < atlas->segmentation->nchart; c++) {
        json_array_append_new(list, chart_json(atlas, c));
    }
    return list;
}

/* [v, w, f, g]: input vertices of a seam edge and the facets on its two sides, f traversing it from v to w. */
static json_t *seams_json(const sl_mesh *mesh)
{
    json_t *list = json_array();
    for (int32_t h = 0; h < mesh->nh; h++) {
        if (mesh->sew[h] > h) {
            json_array_append_new(list, json_pack("[i,i,i,i]", mesh->input_vertex[mesh->origin[h]],
                                                  mesh->input_vertex[sl_target(mesh, h)], mesh->face[h],
                                                  mesh->face[mesh->sew[h]]));
        }
    }
    return list;
}

static json_t *splits_json(const sl_segmentation *seg)
{
    json_t *list = json_array();
    for (int32_t k = 0; k < seg->nsplit; k++) {
        const sl_split *s = &seg->split[k];
        json_t *j = json_object();
        json_object_set_new(j, "depth", json_integer(s->depth));
        json_object_set_new(j, "facets", json_integer(s->facets));
        json_object_set_new(j, "vector", json_integer(s->vector));
        json_object_set_new(j, "lambda", number(s->lambda));
        json_object_set_new(j, "candidates", json_integer(s->candidates));
        json_object_set_new(j, "parts", json_integer(s->parts));
        json_object_set_new(j, "length", number(s->length));
        json_object_set_new(j, "smoothed", json_boolean(s->smoothed));
        json_object_set_new(j, "symmetry", json_string(split_symmetry_name(s->symmetry)));
        json_object_set_new(j, "straddling_facets", json_integer(s->fixed));
        json_object_set_new(j, "optimised", json_boolean(s->optimised));
        json_object_set_new(j, "because", json_string(sl_flatten_verdict_name(s->because)));
        json_array_append_new(list, j);
    }
    return list;
}

static json_t *certificate_json(const sl_atlas *atlas)
{
    const sl_atlas_check *c = &atlas->check;
    json_t *j = json_object();
    json_object_set_new(j, "passed", json_boolean(c->passed));
    json_object_set_new(j, "flipped", json_integer(c->flipped));
    json_object_set_new(j, "degenerate", json_integer(c->degenerate));
    json_object_set_new(j, "uncertified_charts", json_integer(c->uncertified_charts));
    json_object_set_new(j, "proven", json_boolean(c->proven));
    json_object_set_new(j, "resolution", json_integer(c->resolution));
    json_object_set_new(j, "covered_texels", json_integer(c->covered_texels));
    json_object_set_new(j, "overlapping_texels", json_integer(c->overlapping_texels));
    json_object_set_new(j, "shared_texels", json_integer(c->shared_texels));
    json_object_set_new(j, "unlike_corners", json_integer(c->unlike));
    return j;
}

static json_t *warnings_json(const sl_atlas *atlas)
{
    json_t *list = json_array();
    for (int32_t k = 0; k < atlas->nwarning; k++) {
        json_array_append_new(list, json_string(atlas->warning[k].text));
    }
    return list;
}

/* Charts that ABF++ alone did not flatten, and splits that no eigenvector passed. */
static json_t *fallbacks_json(const sl_segmentation *seg)
{
    int32_t tutte = 0, lscm = 0, minimised = 0, fiedler = 0;
    for (int32_t c = 0; c < seg->nchart; c++) {
        tutte += seg->chart[c].flat.method == SL_FLATTEN_TUTTE;
        lscm += seg->chart[c].flat.method == SL_FLATTEN_LSCM;
        minimised += seg->chart[c].flat.stretch_minimised;
    }
    for (int32_t k = 0; k < seg->nsplit; k++) {
        const sl_split_symmetry symmetry = seg->split[k].symmetry;
        fiedler += seg->split[k].vector < 0 && symmetry != SL_SPLIT_MIRROR && symmetry != SL_SPLIT_PLANE &&
                   !seg->split[k].optimised;
    }
    return json_pack("{s:i, s:i, s:i, s:i}", "tutte_charts", tutte, "lscm_charts", lscm, "stretch_minimised_charts",
                     minimised, "fiedler_splits", fiedler);
}

static json_t *atlas_json(const sl_atlas *atlas, const sl_atlas_def *def)
{
    const sl_segmentation *seg = atlas->segmentation;
    json_t *j = json_object();
    json_object_set_new(j, "format", json_string("seamlab atlas"));
    json_object_set_new(j, "schema", json_integer(SL_SIDECAR_SCHEMA));
    json_object_set_new(j, "options", options_json(def));
    json_object_set_new(j, "repair", repair_json(&atlas->repair));
    json_object_set_new(j, "paired", json_boolean(seg->paired));
    json_object_set_new(j, "paired_fraction", number(seg->paired_fraction));
    json_object_set_new(j, "certificate", certificate_json(atlas));
    json_object_set_new(j, "scale", number(atlas->pack.scale));
    json_object_set_new(j, "fill", number(atlas->pack.fill));
    json_object_set_new(j, "pages", json_integer(atlas->pack.pages));
    json_object_set_new(j, "texels_a_unit", number(atlas->texels_a_unit));
    json_object_set_new(j, "seam_length_over_diagonal", number(sl_atlas_seam_diagonals(atlas->mesh)));
    json_object_set_new(j, "merges", json_integer(seg->merges));
    json_object_set_new(j, "warnings", warnings_json(atlas));
    json_object_set_new(j, "fallbacks", fallbacks_json(seg));
    if (def->best) {
        const sl_optimize_info *info = &atlas->optimized;
        json_object_set_new(j, "search",
                            json_pack("{s:i, s:i, s:i, s:i, s:i, s:i, s:i}", "pieces", info->pieces, "failed",
                                      info->failed, "missed", info->missed, "direct", info->direct, "cuts", info->cuts,
                                      "sewings", info->sewings, "trials", info->trials));
    }
    json_object_set_new(j, "symmetry", symmetry_json(atlas));
    json_object_set_new(j, "charts", charts_json(atlas));
    json_object_set_new(j, "splits", splits_json(seg));
    json_object_set_new(j, "seams", seams_json(atlas->mesh));
    json_object_set_new(j, "face_chart", integers(seg->face_chart, atlas->mesh->nf));
    return j;
}

/* Text that grows; jansson's callback. */
typedef struct text_buffer {
    char *text;
    int64_t size, capacity;
} text_buffer;

static int append_text(const char *data, size_t size, void *user)
{
    text_buffer *b = user;
    if (sl_reserve((void **)&b->text, &b->capacity, b->size + (int64_t)size + 2, 1) != SL_OK) {
        return -1;
    }
    memcpy(b->text + b->size, data, size);
    b->size += (int64_t)size;
    return 0;
}

/* jansson's indentation would give every number its own line: members of the top object get one line each instead. */
static int dump_members(const json_t *object, text_buffer *buffer)
{
    const size_t flags = JSON_COMPACT | JSON_ENCODE_ANY | JSON_REAL_PRECISION(15);
    const char *key, *separator = "{\n";
    json_t *value;
    int failed = 0;
    json_object_foreach((json_t *)(uintptr_t)object, key, value)
    {
        failed |= append_text(separator, 2, buffer) | append_text("\"", 1, buffer);
        failed |= append_text(key, strlen(key), buffer) | append_text("\": ", 3, buffer);
        failed |= json_dump_callback(value, append_text, buffer, flags);
        separator = ",\n";
    }
    return failed | append_text("\n}\n", 3, buffer);
}

sl_status sl_sidecar_text(const sl_atlas *atlas, const sl_atlas_def *def, char **text)
{
    text_buffer buffer = {0};
    json_t *json = atlas_json(atlas, def);
    *text = NULL;
    const bool failed = json == NULL || dump_members(json, &buffer) != 0;
    json_decref(json);
    if (failed) {
        sl_free(buffer.text);
        return SL_OUT_OF_MEMORY;
    }
    buffer.text[buffer.size] = '\0';
    *text = buffer.text;
    return SL_OK;
}

sl_status sl_sidecar_write(const char *path, const sl_atlas *atlas, const sl_atlas_def *def, sl_diag *diag)
{
    char *text = NULL;
    sl_writer *writer = NULL;
    sl_status status = SL_OK;
    SL_TRY(sl_sidecar_text(atlas, def, &text));
    SL_TRY(sl_writer_create(path, &writer, diag));
    sl_writer_text(writer, text);
    status = sl_writer_commit(writer, diag);
cleanup:
    sl_free(text);
    return status;
}
