/* Figure 2: a low-polygon character whose important parts are kept in the atlas, symmetric ones on one image. */
#include "generators.h"
#include "image/png.h"
#include "support/main.h"
#include "support/pictures.h"

#include <math.h>
#include <stdio.h>

enum { WIDTH = 2000, HEIGHT = 700, PARTS = 8 };

/* What an artist would want in one piece, in the colours of the pictures. */
static const struct {
    const char *name;
    uint8_t rgb[3];
} part_list[PARTS] = {
    {"face", {250, 205, 170}}, {"hair", {196, 120, 60}},   {"pigtails", {226, 160, 70}}, {"hands", {240, 140, 130}},
    {"arms", {150, 190, 235}}, {"torso", {110, 150, 215}}, {"skirt", {150, 205, 140}},   {"legs", {205, 165, 225}},
};
enum part { FACE, HAIR, PIGTAILS, HANDS, ARMS, TORSO, SKIRT, LEGS };

/* The part that a point of the model belongs to: y up, z forward, in the model's own units (0 to 10 high). */
static enum part part_at(const double p[3])
{
    const double x = fabs(p[0]), from_leg = hypot(x - 0.54, p[2]);
    if ((p[1] > 7.3 && x > 1.2) || (p[1] > 6.85 && x > 1.45 && p[2] < -0.2)) {
        return PIGTAILS;
    }
    if (p[1] > 7.75) {
        return p[1] < 9.0 && p[2] > 0.3 ? FACE : HAIR;
    }
    if (x > 2.3 && p[1] < 5.0) {
        return HANDS;
    }
    if (x > 1.0 && p[1] > 4.9) {
        return ARMS;
    }
    if (p[1] < 2.9 || (p[1] < 3.8 && from_leg < 0.5)) {
        return LEGS;
    }
    return p[1] < 5.2 ? SKIRT : TORSO;
}

typedef struct part_facts {
    int32_t facets, charts; /* charts of the texture: copies count with their sources */
    double area, largest, copied;
    double l2; /* the worst of its charts */
} part_facts;

/* The part of each facet. */
static int32_t *label_parts(const sl_mesh *mesh)
{
    int32_t *part = sl_alloc(mesh->nf, sizeof *part);
    for (int32_t f = 0; part != NULL && f < mesh->nf; f++) {
        double c[3];
        sl_mesh_face_centroid(mesh, f, c);
        for (int k = 0; k < 3; k++) {
            c[k] = c[k] / mesh->scale + mesh->centre[k];
        }
        part[f] = (int32_t)part_at(c);
    }
    return part;
}

static sl_status measure_parts(const sl_atlas *atlas, const int32_t *part, part_facts facts[PARTS])
{
    const sl_segmentation *seg = atlas->segmentation;
    double *in_chart = sl_calloc((int64_t)PARTS * seg->nchart, sizeof *in_chart);
    if (in_chart == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t f = 0; f < atlas->mesh->nf; f++) {
        const int32_t chart = seg->face_chart[f];
        const double area = sl_mesh_face_area(atlas->mesh, f);
        part_facts *p = &facts[part[f]];
        p->facets++;
        p->area += area;
        p->copied += seg->chart[chart].copy_of >= 0 ? area : 0.0;
        p->l2 = fmax(p->l2, seg->chart[chart].flat.distortion.l2);
        in_chart[(int64_t)part[f] * seg->nchart + sl_chart_shown(seg, chart)] += area;
    }
    for (int64_t k = 0; k < (int64_t)PARTS * seg->nchart; k++) {
        facts[k / seg->nchart].charts += in_chart[k] > 0.0;
        facts[k / seg->nchart].largest = fmax(facts[k / seg->nchart].largest, in_chart[k]);
    }
    sl_free(in_chart);
    return SL_OK;
}

static sl_status draw(exp_run *run, const sl_atlas *atlas, const int32_t *part)
{
    sl_image *image = NULL;
    char path[EXP_PATH];
    sl_status status = SL_OK;
    sl_scene scene = sl_scene_default();
    sl_picture picture = exp_picture(run, WIDTH, HEIGHT);
    const sl_view view = exp_view_of("character");
    uint8_t *rgb = sl_alloc(atlas->mesh->nf, 3 * sizeof *rgb);
    if (rgb == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t f = 0; f < atlas->mesh->nf; f++) {
        for (int32_t k = 0; k < 3; k++) {
            rgb[3 * (int64_t)f + k] = part_list[part[f]].rgb[k];
        }
    }
    scene.mesh = atlas->mesh;
    scene.triangulation = atlas->triangulation;
    scene.corner_uv = atlas->corner_uv;
    scene.facet_rgb = rgb;
    scene.checks = 40.0;
    scene.wire = 0.25;
    picture.back_view = true;
    SL_TRY(sl_render_pair(&scene, &view, &picture, &run->context, &image, &run->diag));
    SL_TRY(exp_path(run, "character.png", path));
    status = sl_png_write(path, image, &run->diag);
cleanup:
    sl_image_free(image);
    sl_free(rgb);
    return status;
}

static void table(exp_page *page, const part_facts facts[PARTS], exp_claims *claims)
{
    exp_page_table_begin(page, "part|facets|charts of the texture|share in the largest|shared by symmetry|worst L2");
    for (int k = 0; k < PARTS; k++) {
        const part_facts *p = &facts[k];
        exp_page_row_begin(page, false);
        exp_page_cell(page, "%s", part_list[k].name);
        exp_page_cell(page, "%d", p->facets);
        exp_page_cell(page, "%d", p->charts);
        exp_page_cell(page, "%.1f %%", 100.0 * p->largest / p->area);
        exp_page_cell(page, "%.1f %%", 100.0 * p->copied / p->area);
        exp_page_cell(page, "%.3f", p->l2);
        exp_page_row_end(page);
        exp_claims_measure(claims, part_list[k].name, "share in one chart", p->largest / p->area);
        exp_claims_measure(claims, part_list[k].name, "shared by symmetry", p->copied / p->area);
    }
    exp_page_table_end(page);
}

static sl_status show(exp_run *run, exp_page *page, exp_claims *claims)
{
    sl_status status = SL_OK;
    const sl_atlas_def def = sl_atlas_default();
    const sl_generator *generator = sl_generator_find("character");
    part_facts facts[PARTS] = {0};
    sl_generated *generated = NULL;
    sl_polygons polygons;
    sl_atlas *atlas = NULL;
    int32_t *part = NULL;
    SL_TRY(generator != NULL ? SL_OK : SL_INTERNAL);
    SL_TRY(generator->make(1, 1, &generated));
    sl_generated_polygons(generated, &polygons);
    SL_TRY(sl_unwrap(&polygons, &def, &run->context, &atlas, &run->diag));
    part = label_parts(atlas->mesh);
    SL_TRY(part != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(measure_parts(atlas, part, facts));
    SL_TRY(draw(run, atlas, part));
    exp_page_html(
        page,
        "<p>The paper's Figure 2 shows a low-polygon mesh with the texture that an artist designed: important "
        "parts (legs, hands, face) are kept, the legs, the arms and the halves of the skirt lie on a single "
        "image each. Here: a generated character of %d polygons, unwrapped without a hand on it. Colours are "
        "those of the parts, on the model and in its atlas.</p>\n",
        generated->nf);
    exp_page_figure(page, "", "character.png", "a girl in a skirt from both sides, and her atlas",
                    "A character from both sides, and her atlas: half of her, since the other half shares it.");
    table(page, facts, claims);
    exp_claims_measure(claims, "character", "own check passed", atlas->check.passed);
    exp_claims_measure(claims, "character", "texture memory saved", atlas->segmentation->sharing.area);
cleanup:
    sl_free(part);
    sl_atlas_free(atlas);
    sl_generated_free(generated);
    return status;
}

int main(int argc, char **argv)
{
    return exp_main(argc, argv, "fig02-character", "Figure 2: a low-polygon character", NULL, EXPECTED_CSV, show);
}
