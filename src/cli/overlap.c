/* seamlab overlap: do the UVs of a mesh overlap, where, and is there proof? */
#include "atlas/sidecar.h"
#include "atlas/uv_triangles.h"
#include "base/memory.h"
#include "cli/cli.h"
#include "image/png.h"
#include "overlap/edge_raster.h"
#include "overlap/exact.h"

#include <jansson.h>
#include <stdio.h>
#include <string.h>

static const cli_verb verb = {
    .name = "overlap",
    .usage = "seamlab overlap FILE [--resolution N] [--exact] [--png OUT] [--json]",
    .summary = "Counts how often the UVs of any mesh cover each texel, as a stencil buffer would; --exact\n"
               "compares the triangles themselves. Facets that a sidecar beside the file says are copies, and that\n"
               "lie exactly on what they copy, are no overlap. Exit 5 when there is one.",
    .examples = "  seamlab overlap model-uv.obj\n"
                "  seamlab overlap model-uv.obj --exact --json\n"
                "  seamlab overlap model-uv.obj --resolution 4096 --png overlap.png\n",
    .min_files = 1,
    .max_files = 1,
};

typedef struct overlap_options {
    cli_run run;
    int32_t resolution;
    bool exact;
    const char *png;
} overlap_options;

typedef struct overlap_result {
    sl_uv_triangles triangles;
    sl_edge_raster *raster;
    sl_edge_raster_info info;
    int32_t red; /* by texels */
    sl_exact_overlap exact;
} overlap_result;

static sl_status find_overlap(const overlap_options *o, overlap_result *r)
{
    sl_status status = SL_OK;
    const sl_uv_triangles *t = &r->triangles;
    const sl_edge_raster_def def = {.width = o->resolution, .height = o->resolution, .depth = 16};
    double *window = sl_alloc(t->nv, 2 * sizeof *window);
    uint8_t *red = sl_alloc(t->nt, sizeof *red);
    if (window == NULL || red == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    sl_uv_triangles_window(t, window);
    SL_TRY(sl_edge_raster_create(t->nv, t->nt, t->tri, &def, &r->raster));
    SL_TRY(sl_edge_raster_draw(r->raster, window, &o->run.context));
    r->info = sl_edge_raster_result(r->raster);
    SL_TRY(sl_edge_raster_red_triangles(r->raster, window, &o->run.context, red, &r->red));
    if (o->exact) {
        SL_TRY(sl_overlap_exact(t->uv, t->nt, t->tri, &o->run.context, red, &r->exact));
    }
cleanup:
    sl_free(window);
    sl_free(red);
    return status;
}

/* Covered once blue-grey, twice red, more often darker. Row 0 of the counts is the picture's last. */
static int draw_counts(overlap_options *o, const overlap_result *r)
{
    static const uint8_t colour[5][3] = {{255, 255, 255}, {158, 178, 200}, {222, 45, 38}, {165, 15, 21}, {103, 0, 13}};
    sl_image *image = NULL;
    sl_diag diag = sl_diag_none();
    const uint16_t *count = sl_edge_raster_counts16(r->raster);
    sl_status status = sl_image_create(o->resolution, o->resolution, 3, &image);
    for (int32_t y = 0; y < o->resolution && status == SL_OK; y++) {
        for (int32_t x = 0; x < o->resolution; x++) {
            const uint16_t c = count[(int64_t)(o->resolution - 1 - y) * o->resolution + x];
            memcpy(sl_image_pixel(image, x, y), colour[c < 4 ? c : 4], 3);
        }
    }
    if (status == SL_OK) {
        status = sl_png_write(o->png, image, &diag);
    }
    sl_image_free(image);
    return cli_fail(&o->run, status, &diag);
}

static void print_text(const overlap_options *o, const char *name, const overlap_result *r)
{
    const sl_uv_triangles *t = &r->triangles;
    printf("%s\n  triangles %d", name, t->nt);
    if (t->shared_faces > 0) {
        printf("   (%d facets are copies and lie on what they copy, by intent)", t->shared_faces);
    }
    printf("\n  texels    %lld covered, %lld covered twice or more, by %d triangles, at %d^2",
           (long long)r->info.covered, (long long)r->info.overlapping, r->red, o->resolution);
    printf(t->side == 1.0 ? "\n" : " of the UVs' bounding square\n");
    if (o->exact && r->exact.red == 0) {
        printf("  exact     no two triangles overlap; %d have no area\n", r->exact.degenerate);
    } else if (o->exact) {
        printf("  exact     %d triangles overlap, among them facets %d and %d; %d have no area\n", r->exact.red,
               t->face[r->exact.first[0]] + 1, t->face[r->exact.first[1]] + 1, r->exact.degenerate);
    }
}

static void print_json(const overlap_options *o, const char *name, const overlap_result *r, bool overlap)
{
    const sl_uv_triangles *t = &r->triangles;
    json_t *j =
        json_pack("{s:i, s:s, s:b, s:i, s:i, s:i, s:I, s:I, s:i}", "schema", 1, "file", name, "overlap", overlap,
                  "triangles", t->nt, "sharedFacets", t->shared_faces, "resolution", o->resolution, "covered",
                  (json_int_t)r->info.covered, "overlapping", (json_int_t)r->info.overlapping, "red", r->red);
    json_object_set_new(j, "window", json_pack("[f, f, f]", t->low[0], t->low[1], t->side));
    if (o->exact) {
        json_t *exact = json_pack("{s:i, s:i}", "red", r->exact.red, "degenerate", r->exact.degenerate);
        if (r->exact.red > 0) { /* facets numbered from 0, as in the sidecar */
            json_object_set_new(exact, "facets",
                                json_pack("[i, i]", t->face[r->exact.first[0]], t->face[r->exact.first[1]]));
        }
        json_object_set_new(j, "exact", exact);
    }
    json_dumpf(j, stdout, JSON_COMPACT | JSON_REAL_PRECISION(17));
    putchar('\n');
    json_decref(j);
}

static int report(const overlap_options *o, const char *name, const overlap_result *r)
{
    const bool overlap = r->info.overlapping > 0 || (o->exact && r->exact.red > 0);
    if (o->run.json) {
        print_json(o, name, r, overlap);
    } else {
        print_text(o, name, r);
    }
    return overlap ? CLI_CHECK_FAILED : CLI_DONE;
}

static int check_file(overlap_options *o, const char *path)
{
    sl_diag diag = sl_diag_none();
    sl_meshfile *file = NULL;
    sl_polygons polygons;
    sl_sharing_table table = {0};
    overlap_result r = {0};
    int code = cli_read_mesh(&o->run, path, &file);
    if (code != CLI_DONE) {
        return code;
    }
    if (file->corner_uv == NULL) {
        sl_diag_reason(&diag, "%s has no UVs that could overlap", path);
        sl_diag_hint(&diag, "seamlab unwrap makes some");
        code = cli_fail(&o->run, SL_BAD_INPUT, &diag);
    } else {
        sl_meshfile_polygons(file, &polygons);
        snprintf(diag.file, sizeof diag.file, "%s", path);
        const sl_sharing_table *shared = cli_read_sharing(&o->run, path, polygons.nf, &table);
        code = cli_fail(&o->run, sl_uv_triangles_init(&polygons, file->corner_uv, shared, &r.triangles, &diag), &diag);
    }
    if (code == CLI_DONE) {
        code = cli_fail(&o->run, find_overlap(o, &r), NULL);
    }
    if (code == CLI_DONE && o->png != NULL) {
        code = draw_counts(o, &r);
    }
    if (code == CLI_DONE) {
        code = report(o, path, &r);
    }
    sl_edge_raster_free(r.raster);
    sl_uv_triangles_clear(&r.triangles);
    sl_sharing_table_clear(&table);
    sl_meshfile_free(file);
    return code;
}

int cli_overlap(int argc, char **argv)
{
    overlap_options o = {.run = {.verb = verb.name}, .resolution = 2048};
    int32_t file_count = 0;
    const char *files[1];
    cli_option options[CLI_COMMON_OPTIONS + 3];
    const cli_option own[3] = {
        {"resolution", 0, CLI_INT, &o.resolution, 1, 16384, NULL, "N", "texels a side (2048)"},
        {"exact", 0, CLI_FLAG, &o.exact, 0, 0, NULL, NULL, "compare the triangles, not texels: finds all, or proves"},
        {"png", 0, CLI_TEXT, &o.png, 0, 0, NULL, "OUT", "picture of the counts, overlaps red"},
    };
    memcpy(options, own, sizeof own);
    cli_common_options(&o.run, options + 3);
    int code = cli_parse(&verb, options, (int32_t)SL_COUNTOF(options), argc, argv, 2, files, &file_count);
    if (code >= 0 || (code = cli_begin(&o.run)) >= 0) {
        return code;
    }
    code = check_file(&o, files[0]);
    return cli_end(&o.run, code);
}
