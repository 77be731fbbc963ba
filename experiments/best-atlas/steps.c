#include "atlases.h"

#include "support/pictures.h"

#include <stdio.h>

enum { WIDTH = 640, HEIGHT = 300 };
enum { START, ALL_CUTS, SOME_SEWN, HALF_SEWN, END, STEPS };

/* A bound on cuts and sewings, and what the picture is called. */
typedef struct step {
    const char *key, *caption;
    int32_t cuts, sewings;
} step;

static sl_status show_step(exp_run *run, exp_page *page, const exp_mesh *mesh, const char *name, const step *s,
                           atlas_row *row, sl_optimize_info *info)
{
    sl_status status = SL_OK;
    sl_atlas *atlas = NULL;
    sl_atlas_def def = variant_def(NONE, NULL);
    const sl_view view = exp_view_of(name);
    const sl_picture picture = exp_picture(run, WIDTH, HEIGHT);
    char file[96], alt[160], caption[320];
    def.optimize.empty_cost = 0.0; /* its cuts come last, and are none of these steps */
    def.optimize.max_cuts = s->cuts;
    def.optimize.max_sewings = s->sewings;
    SL_TRY(make_atlas(run, name, mesh, &def, &atlas, row));
    if (!row->made) {
        goto cleanup;
    }
    *info = atlas->optimized;
    snprintf(file, sizeof file, "steps-%s-%s.png", name, s->key);
    snprintf(alt, sizeof alt, "%s, %s", name, s->caption);
    snprintf(
        caption, sizeof caption,
        "<b>%s</b>: %d cut%s, %d sewing%s; %d chart%s, seams %.2f, L2 %.3f, &sigma;<sub>1</sub>/&sigma;<sub>2</sub> "
        "%.3f",
        s->caption, info->cuts, sl_plural(info->cuts), info->sewings, sl_plural(info->sewings), row->charts,
        sl_plural(row->charts), row->seam, row->l2, row->angle);
    SL_TRY(exp_draw_atlas(run, atlas, &view, &picture, file));
    exp_page_figure(page, "", file, alt, caption);
cleanup:
    sl_atlas_free(atlas);
    return status;
}

/* Start, cuts to their end, a quarter of the sewings, half of them, and all. A bound ends the same search earlier. */
static sl_status show_search(exp_run *run, exp_page *page, exp_claims *claims, const char *name)
{
    sl_status status = SL_OK;
    exp_source source = {.generated = true};
    exp_mesh mesh = {0};
    atlas_row row[STEPS];
    sl_optimize_info info[STEPS] = {0};
    const sl_optimize_def whole = sl_optimize_default();
    step s[STEPS] = {
        [START] = {"start", "first spectral cuts", 0, 0},
        [ALL_CUTS] = {"all-cuts", "cut until the targets are met", whole.max_cuts, 0},
        [SOME_SEWN] = {"some-sewn", "a quarter sewn", 0, 0},
        [HALF_SEWN] = {"half-sewn", "half sewn", 0, 0},
        [END] = {"end", "to the end", whole.max_cuts, whole.max_sewings},
    };
    sl_atlas *atlas = NULL;
    sl_atlas_def def = variant_def(NONE, NULL);
    snprintf(source.name, sizeof source.name, "%s", name);
    SL_TRY(exp_mesh_load(&source, &mesh, &run->diag));
    SL_TRY(make_atlas(run, name, &mesh, &def, &atlas, &row[END]));  /* how many steps there are */
    for (int k = SOME_SEWN; k <= HALF_SEWN && atlas != NULL; k++) { /* a quarter, two quarters */
        s[k].cuts = whole.max_cuts;
        s[k].sewings = (k - ALL_CUTS) * atlas->optimized.sewings / 4;
    }
    exp_page_html(page, "<div class=\"grid wide\">\n");
    for (int k = 0; k < STEPS; k++) {
        SL_TRY(show_step(run, page, &mesh, name, &s[k], &row[k], &info[k]));
    }
    exp_page_html(page, "</div>\n");
    exp_claims_measure(claims, name, "steps: seams at the end over those before sewing",
                       row[END].seam / row[ALL_CUTS].seam);
    exp_claims_measure(claims, name, "steps: L2 after the cuts", row[ALL_CUTS].l2);
cleanup:
    sl_atlas_free(atlas);
    exp_mesh_clear(&mesh);
    return status;
}

sl_status show_steps(exp_run *run, exp_page *page, exp_claims *claims)
{
    exp_page_html(page, "<h3>A search, step by step</h3>\n<p>Spectral cuts as few as will do; darts and bisections "
                        "where the stretch is, until the targets are met; then what can be sewn within them, seams of "
                        "the first cut, too.</p>\n");
    return show_search(run, page, claims, run->quick ? "mug" : "hand");
}
