/* Figure 3: the two thumbs of a hand cross in UV space, red in both views; sewn up to their tip they do not. */
#include "generators.h"
#include "image/png.h"
#include "overlap/exact.h"
#include "support/main.h"
#include "support/pictures.h"
#include "support/zipper.h"

#include <math.h>
#include <stdio.h>

enum { WIDTH = 1400, HEIGHT = 640, TEXELS = 2048, STATES = 3 };

static const double page_margin = 0.04;

/* The same seam, sewn further and further. */
static const struct {
    const char *file, *caption;
    double reach; /* of the way from the wrist to the thumb's tip */
} states[STATES] = {
    {"crossing",
     "<b>Sewn from the wrist to the root of the thumb</b>: one chart, and its two thumbs cross. Red: where "
     "the chart covers a texel twice.",
     0.42},
    {"zipping", "<b>The zipper further up.</b>", 0.60},
    {"glued", "<b>Sewn to the tip</b>: the two thumbs are one, and nothing overlaps.", 1.0},
};

typedef struct result {
    int32_t facets, charts, sewn, red, red_on_thumb, exact_red;
    int64_t overlapping;
    double l2;
} result;

/* The one chart onto the unit square. */
static void fit(const sl_mesh *mesh, double *uv)
{
    double lo[2] = {HUGE_VAL, HUGE_VAL}, hi[2] = {-HUGE_VAL, -HUGE_VAL};
    for (int64_t i = 0; i < 2 * (int64_t)mesh->nh; i++) {
        lo[i % 2] = fmin(lo[i % 2], uv[i]);
        hi[i % 2] = fmax(hi[i % 2], uv[i]);
    }
    const double extent = fmax(hi[0] - lo[0], hi[1] - lo[1]), scale = (1.0 - 2.0 * page_margin) / extent;
    for (int64_t i = 0; i < 2 * (int64_t)mesh->nh; i++) {
        uv[i] = 0.5 + scale * (uv[i] - 0.5 * (lo[i % 2] + hi[i % 2]));
    }
}

/* Which triangles are red, by texels and by exact comparison; which of the facets are on the thumb. */
static sl_status find_red(exp_run *run, const sl_mesh *mesh, const sl_triangulation *t, const double *uv, uint8_t *flag,
                          result *r)
{
    sl_status status = SL_OK;
    sl_coverage *coverage = NULL;
    sl_exact_overlap exact;
    uint8_t *red = sl_alloc(t->nt, sizeof *red);
    if (red == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    SL_TRY(sl_overlap_exact(uv, t->nt, t->corner, &run->context, red, &exact));
    r->exact_red = exact.red;
    SL_TRY(sl_coverage_create(TEXELS, TEXELS, &coverage));
    SL_TRY(sl_coverage_add(coverage, uv, t->nt, t->corner, &run->context));
    SL_TRY(sl_coverage_red_triangles(coverage, uv, t->nt, t->corner, red));
    r->overlapping = sl_coverage_overlapping(coverage);
    r->facets = mesh->nf;
    for (int32_t f = 0; f < mesh->nf; f++) {
        flag[f] = 0;
        for (int32_t k = t->first[f]; k < t->first[f + 1]; k++) {
            flag[f] |= red[k];
        }
        r->red += flag[f];
        r->red_on_thumb += flag[f] && zipper_is_on_thumb(mesh, f);
    }
cleanup:
    sl_coverage_free(coverage);
    sl_free(red);
    return status;
}

static sl_status draw(exp_run *run, const sl_mesh *mesh, const sl_triangulation *t, const double *uv,
                      const int32_t *chart, const uint8_t *flag, const char *file)
{
    sl_status status = SL_OK;
    sl_image *image = NULL;
    char path[EXP_PATH];
    sl_scene scene = sl_scene_default();
    const sl_picture picture = exp_picture(run, WIDTH, HEIGHT);
    sl_view view = exp_view_of("hand");
    view.azimuth -= 50.0;
    scene.mesh = mesh;
    scene.triangulation = t;
    scene.corner_uv = uv;
    scene.chart = chart;
    scene.facet_flag = flag;
    scene.checks = 32.0;
    scene.seam_width = 3.0;
    SL_TRY(sl_render_pair(&scene, &view, &picture, &run->context, &image, &run->diag));
    SL_TRY(exp_path(run, file, path));
    status = sl_png_write(path, image, &run->diag);
cleanup:
    sl_image_free(image);
    return status;
}

static void measure(exp_claims *claims, const char *name, const result *r)
{
    exp_claims_measure(claims, name, "charts", r->charts);
    exp_claims_measure(claims, name, "texels covered twice", (double)r->overlapping);
    exp_claims_measure(claims, name, "triangles that overlap exactly", r->exact_red);
    if (r->red > 0) {
        exp_claims_measure(claims, name, "share of red facets on the thumb", (double)r->red_on_thumb / r->red);
    }
}

static sl_status show_state(exp_run *run, exp_page *page, exp_claims *claims, const sl_triangulation *t, zipper *zip,
                            int k, result *r)
{
    sl_status status = SL_OK;
    sl_segmentation *seg = NULL;
    char file[64];
    sl_segment_def def = sl_segment_paper();
    uint8_t *flag = sl_alloc(zip->mesh->nf, sizeof *flag);
    if (flag == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    r->sewn = zipper_close(zip, states[k].reach);
    SL_TRY(sl_flatten_charts(zip->mesh, t, &def, &run->context, &seg));
    r->charts = seg->nchart;
    r->l2 = seg->chart[0].flat.distortion.l2;
    fit(zip->mesh, seg->corner_uv);
    SL_TRY(find_red(run, zip->mesh, t, seg->corner_uv, flag, r));
    snprintf(file, sizeof file, "%s.png", states[k].file);
    SL_TRY(draw(run, zip->mesh, t, seg->corner_uv, seg->face_chart, flag, file));
    exp_page_figure(page, "", file, "the hand and its one chart", states[k].caption);
    measure(claims, states[k].file, r);
    fprintf(stderr, "%s: %d edges sewn, %d of %d facets red, %d of them on the thumb\n", states[k].file, r->sewn,
            r->red, r->facets, r->red_on_thumb);
cleanup:
    sl_segmentation_free(seg);
    sl_free(flag);
    return status;
}

static void table(exp_page *page, const result *r)
{
    exp_page_table_begin(page, "seam|edges sewn|charts|texels covered twice|red facets|of them on the thumb|triangles "
                               "that overlap, exactly|stretch L2");
    for (int k = 0; k < STATES; k++) {
        exp_page_row_begin(page, false);
        exp_page_cell(page, "%s", states[k].file);
        exp_page_cell(page, "%d", r[k].sewn);
        exp_page_cell(page, "%d", r[k].charts);
        exp_page_cell(page, "%lld", (long long)r[k].overlapping);
        exp_page_cell(page, "%d", r[k].red);
        exp_page_cell(page, "%d", r[k].red_on_thumb);
        exp_page_cell(page, "%d", r[k].exact_red);
        exp_page_cell(page, "%.3f", r[k].l2);
        exp_page_row_end(page);
    }
    exp_page_table_end(page);
}

static const char introduction[] =
    "The paper's Figure 3: &ldquo;The user can interactively sew seams. The red zone displays the overlaps (the two "
    "thumbs cross in UV space). With a &lsquo;zipper&rsquo; metaphor, the user can glue the two thumbs and resolve the "
    "overlaps.&rdquo; Here the generated hand: cut by its equator into palm and back (the paper's settings), then sewn "
    "again along the seam, from the wrist up to the root of the thumb, further, and to the thumb's tip. After each "
    "step "
    "ABF++ lays the one chart flat, and what it covers twice, by texels counted as the stencil buffer does, is red on "
    "the model and in UV space.";

static sl_status show_all(exp_run *run, exp_page *page, exp_claims *claims)
{
    sl_status status = SL_OK;
    sl_generated *hand = NULL;
    sl_mesh *mesh = NULL;
    sl_triangulation *t = NULL;
    sl_polygons polygons;
    zipper zip = {0};
    result results[STATES] = {{0}};
    SL_TRY(sl_generator_find("hand")->make(1, 1, &hand));
    sl_generated_polygons(hand, &polygons);
    SL_TRY(sl_mesh_build(&polygons, &mesh, NULL, &run->diag));
    SL_TRY(sl_triangulation_create(mesh, &t));
    SL_TRY(zipper_open(mesh, t, &run->context, &zip));
    for (int k = 0; k < STATES; k++) {
        SL_TRY(show_state(run, page, claims, t, &zip, k, &results[k]));
    }
    table(page, results);
cleanup:
    zipper_clear(&zip);
    sl_triangulation_free(t);
    sl_mesh_free(mesh);
    sl_generated_free(hand);
    return status;
}

int main(int argc, char **argv)
{
    return exp_main(argc, argv, "fig03-overlap", "Figure 3: two thumbs that cross, and a zipper", introduction,
                    EXPECTED_CSV, show_all);
}
