/* Figure 12: the atlas without and with symmetry; the four halves of the legs on one place. */
#include "generators.h"
#include "image/png.h"
#include "render/chart_colors.h"
#include "support/csv.h"
#include "support/failures.h"
#include "support/main.h"
#include "support/pictures.h"
#include "walker.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { WIDTH = 2000, HEIGHT = 700, SMALL_WIDTH = 1100, SMALL_HEIGHT = 520, MODELS = 4 };

static const uint8_t orange[3] = {244, 150, 50};
static const double pale = 0.45; /* of the way from a chart's colour to white, where one chart is pointed out */

/* What a model's atlas is like without and with sharing. */
typedef struct result {
    const char *name;
    int32_t facets, charts[2], copies, most_images;
    double saved, scale[2], seam[2], l2[2];
} result;

/* The chart shown in most places; how often. -1: none is copied. */
static int32_t most_shown(const sl_segmentation *seg, int32_t *images)
{
    int32_t best = -1;
    *images = 1;
    for (int32_t c = 0; c < seg->nchart; c++) {
        int32_t n = 1;
        for (int32_t k = 0; k < seg->nchart; k++) {
            n += seg->chart[k].copy_of == c;
        }
        best = n > *images ? c : best;
        *images = n > *images ? n : *images;
    }
    return best;
}

/* Colours of the charts shown, copies as their sources; `chosen` in orange among paler ones, -1 = none. */
static sl_status color_facets(const sl_atlas *atlas, int32_t chosen, uint8_t *rgb)
{
    const sl_segmentation *seg = atlas->segmentation;
    const int32_t nf = atlas->mesh->nf;
    int32_t *shown = sl_alloc(nf, sizeof *shown);
    if (shown == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t f = 0; f < nf; f++) {
        shown[f] = sl_chart_shown(seg, seg->face_chart[f]);
    }
    const sl_status status = sl_chart_colors(atlas->mesh, shown, rgb);
    for (int32_t f = 0; status == SL_OK && chosen >= 0 && f < nf; f++) {
        for (int32_t k = 0; k < 3; k++) {
            uint8_t *c = &rgb[3 * (int64_t)f + k];
            *c = shown[f] == chosen ? orange[k] : (uint8_t)lround(*c + pale * (255.0 - *c));
        }
    }
    sl_free(shown);
    return status;
}

static sl_status draw(exp_run *run, const sl_atlas *atlas, int32_t chosen, const sl_view *view,
                      const sl_picture *picture, const char *file)
{
    sl_image *image = NULL;
    char path[EXP_PATH];
    sl_status status = SL_OK;
    sl_scene scene = sl_scene_default();
    uint8_t *rgb = sl_alloc(atlas->mesh->nf, 3 * sizeof *rgb);
    if (rgb == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    SL_TRY(color_facets(atlas, chosen, rgb));
    scene.mesh = atlas->mesh;
    scene.triangulation = atlas->triangulation;
    scene.corner_uv = atlas->corner_uv;
    scene.facet_rgb = rgb;
    SL_TRY(sl_render_pair(&scene, view, picture, &run->context, &image, &run->diag));
    SL_TRY(exp_path(run, file, path));
    status = sl_png_write(path, image, &run->diag);
cleanup:
    sl_image_free(image);
    sl_free(rgb);
    return status;
}

static void measure(const sl_atlas *atlas, int k, exp_claims *claims, result *r)
{
    const sl_segmentation *seg = atlas->segmentation;
    r->facets = atlas->mesh->nf;
    r->charts[k] = seg->nchart;
    r->scale[k] = atlas->pack.scale;
    r->seam[k] = sl_atlas_seam_diagonals(atlas->mesh);
    for (int32_t c = 0; c < seg->nchart; c++) {
        r->l2[k] = fmax(r->l2[k], seg->chart[c].flat.distortion.l2);
    }
    exp_claims_measure(claims, r->name, "own check passed", atlas->check.passed);
    exp_claims_measure(claims, r->name, "texels that overlap without intent", (double)atlas->check.overlapping_texels);
    if (k == 1) {
        most_shown(seg, &r->most_images);
        r->copies = seg->sharing.copies;
        r->saved = seg->sharing.area;
        exp_claims_measure(claims, r->name, "texture memory saved", r->saved);
        exp_claims_measure(claims, r->name, "most images of a chart", r->most_images);
        exp_claims_measure(claims, r->name, "corners of copies that differ", atlas->check.unlike);
    } else {
        exp_claims_measure(claims, r->name, "copies without symmetry", seg->sharing.copies);
    }
}

static sl_status show_model(exp_run *run, exp_page *page, exp_claims *claims, const sl_polygons *polygons, bool large,
                            result *r)
{
    sl_status status = SL_OK;
    const sl_view view = exp_view_of(large ? "body" : r->name);
    sl_picture picture = exp_picture(run, large ? WIDTH : SMALL_WIDTH, large ? HEIGHT : SMALL_HEIGHT);
    picture.back_view = large;
    sl_atlas *atlas = NULL;
    char file[96], alt[160], caption[400];
    exp_page_html(page, "<div class=\"duo\" style=\"grid-template-columns:1fr 1fr\">\n");
    for (int k = 0; k < 2; k++) {
        sl_atlas_def def = sl_atlas_default();
        int32_t images = 1;
        def.segment.sew = !large; /* the paper's charts are not merged again */
        def.segment.symmetry = k == 0 ? SL_SYMMETRY_USE_OFF : SL_SYMMETRY_USE_AUTO;
        SL_TRY(sl_unwrap(polygons, &def, &run->context, &atlas, &run->diag));
        measure(atlas, k, claims, r);
        const int32_t chosen = k == 1 && large ? most_shown(atlas->segmentation, &images) : -1;
        snprintf(file, sizeof file, "%s-%s.png", r->name, k == 0 ? "without" : "with");
        SL_TRY(draw(run, atlas, chosen, &view, &picture, file));
        snprintf(alt, sizeof alt, "%s and its atlas %s symmetry", r->name, k == 0 ? "without" : "with");
        snprintf(caption, sizeof caption, "<b>%s</b> %s symmetry: %d chart%s%s", r->name, k == 0 ? "without" : "with",
                 r->charts[k], sl_plural(r->charts[k]),
                 k == 0  ? "."
                 : large ? ", the four halves of the legs on one place (orange)."
                         : ".");
        exp_page_figure(page, "", file, alt, caption);
        sl_atlas_free(atlas);
        atlas = NULL;
    }
    fprintf(stderr, "%s: %.1f %% saved, %d chart%s, %d cop%s\n", r->name, 100.0 * r->saved, r->charts[1],
            sl_plural(r->charts[1]), r->copies, r->copies == 1 ? "y" : "ies");
cleanup:
    exp_page_html(page, "</div>\n");
    sl_atlas_free(atlas);
    return status;
}

static sl_status show_generated(exp_run *run, exp_page *page, exp_claims *claims, result *r)
{
    sl_status status = SL_OK;
    sl_generated *mesh = NULL;
    sl_polygons polygons;
    const sl_generator *generator = sl_generator_find(r->name);
    if (generator == NULL) {
        SL_TRY(walker_make(&mesh));
    } else {
        SL_TRY(generator->make(1, 1, &mesh));
    }
    sl_generated_polygons(mesh, &polygons);
    SL_TRY(show_model(run, page, claims, &polygons, generator == NULL, r));
cleanup:
    sl_generated_free(mesh);
    return status;
}

static void introduce(exp_page *page)
{
    exp_page_html(page,
                  "<p>The paper's Figure 12 shows the map of a character without (left) and with (right) symmetry: "
                  "\"the four halves of the legs are mapped onto a single location in U,V space (in orange)\". Here: a "
                  "model with one mirror whose legs are symmetric in themselves. The axis of the whole is cut first; "
                  "one half is segmented by spectral cuts; the leg, which no single chart holds without too much "
                  "stretch, has an axis of its own; three halves copy the fourth. On the right, colours are those of "
                  "the texture: "
                  "two places of one colour share it.</p>\n");
}

static void table(exp_page *page, const result *r)
{
    exp_page_table_begin(page, "model|facets|charts without|with|of them copies|images of one chart|memory saved|"
                               "scale on a square page|seam without|with|worst L2 without|with");
    for (int k = 0; k < MODELS; k++) {
        if (r[k].charts[1] == 0) {
            continue; /* failed */
        }
        exp_page_row_begin(page, false);
        exp_page_cell(page, "%s", r[k].name);
        exp_page_cell(page, "%d", r[k].facets);
        exp_page_cell(page, "%d", r[k].charts[0]);
        exp_page_cell(page, "%d", r[k].charts[1]);
        exp_page_cell(page, "%d", r[k].copies);
        exp_page_cell(page, "%d", r[k].most_images);
        exp_page_cell(page, "%.1f %%", 100.0 * r[k].saved);
        exp_page_cell(page, "&times; %.2f", r[k].scale[1] / r[k].scale[0]);
        exp_page_cell(page, "%.2f", r[k].seam[0]);
        exp_page_cell(page, "%.2f", r[k].seam[1]);
        exp_page_cell(page, "%.3f", r[k].l2[0]);
        exp_page_cell(page, "%.3f", r[k].l2[1]);
        exp_page_row_end(page);
    }
    exp_page_table_end(page);
    exp_page_html(page,
                  "<p>Memory saved: area of the copies over that of all, all at one density. A square page does not "
                  "always profit as much, since fewer and longer charts pack worse: what the same page gains in "
                  "resolution stands beside it.</p>\n");
}

static sl_status write_csv(exp_run *run, const result *r)
{
    sl_status status = SL_OK;
    sl_writer *csv = NULL;
    SL_TRY(exp_csv_open(run, "sharing.csv",
                        "model,facets,charts_without,charts_with,copies,most_images,saved,scale_gain", &csv));
    for (int k = 0; k < MODELS; k++) {
        sl_writer_format(csv, "%s,%d,%d,%d,%d,%d", r[k].name, r[k].facets, r[k].charts[0], r[k].charts[1], r[k].copies,
                         r[k].most_images);
        exp_csv_numbers(csv, (const double[]){r[k].saved, r[k].scale[1] / r[k].scale[0]}, 2);
        sl_writer_text(csv, "\n");
    }
    SL_TRY(exp_csv_close(run, &csv));
cleanup:
    sl_writer_abandon(csv);
    return status;
}

static sl_status show_all(exp_run *run, exp_page *page, exp_claims *claims)
{
    sl_status status = SL_OK;
    result results[MODELS] = {{.name = "walker"}, {.name = "body"}, {.name = "quadruped"}, {.name = "octopus"}};
    introduce(page);
    for (int k = 0; k < MODELS; k++) {
        SL_TRY(exp_row(run, results[k].name, show_generated(run, page, claims, &results[k])));
    }
    table(page, results);
    SL_TRY(write_csv(run, results));
cleanup:
    return status;
}

int main(int argc, char **argv)
{
    return exp_main(argc, argv, "fig12-symmetry", "Figure 12: symmetry-aware unwrapping", NULL, EXPECTED_CSV, show_all);
}
