#include "hand.h"
#include "support/pictures.h"

#include <math.h>
#include <stdio.h>

enum { VECTOR_WIDTH = 300, VECTOR_HEIGHT = 330 };

static void caption_vector(const hand_work *w, int32_t k, char *text, size_t size)
{
    if (k == 0) {
        snprintf(text, size, "v<sub>0</sub>: constant, no cut");
        return;
    }
    const sl_cut_candidate *c = &w->s.candidate[k - 1];
    char why[96] = "passes";
    if (!c->passes) {
        snprintf(why, sizeof why, "filtered out: %s%s in pieces", c->positive_parts > 1 ? "red" : "",
                 c->positive_parts > 1 && c->negative_parts > 1 ? " and blue"
                 : c->negative_parts > 1                        ? "blue"
                                                                : "");
    }
    snprintf(text, size, "v<sub>%d</sub>, &lambda; = %.3e<br>%d + %d parts, seam %.2f<br><b>%s</b>", k,
             w->s.spectrum->lambda[k], c->positive_parts, c->negative_parts,
             c->seam_length / sl_mesh_diagonal(w->s.mesh), why);
}

static sl_status show_vectors(exp_run *run, exp_page *page, const hand_work *w)
{
    sl_status status = SL_OK;
    const sl_view view = hand_view(w->pose, false);
    const sl_picture picture = exp_picture(run, VECTOR_WIDTH, VECTOR_HEIGHT);
    uint8_t *side = sl_alloc(w->s.graph->graph.n, sizeof *side);
    double *value = sl_alloc(w->s.mesh->nf, sizeof *value);
    int32_t *edge = sl_alloc(w->s.mesh->nh, sizeof *edge), edges = 0;
    if (side == NULL || value == NULL || edge == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    exp_page_html(page, "<div class=\"grid\">\n");
    for (int32_t k = 0; k < w->s.spectrum->count; k++) {
        char file[64], alt[64], caption[256];
        snprintf(file, sizeof file, "%s-v%02d.png", w->pose->tag, k);
        snprintf(alt, sizeof alt, "eigenvector %d of the %s", k, w->pose->title);
        caption_vector(w, k, caption, sizeof caption);
        exp_spectrum_values(&w->s, k, value);
        edges = exp_spectrum_seam(&w->s, k, side, edge);
        SL_TRY(exp_draw_values(run, w->s.mesh, w->s.triangulation, value, edge, edges, &view, &picture, file));
        exp_page_figure(page, k > 0 && w->s.candidate[k - 1].passes ? "yes" : "", file, alt, caption);
    }
    exp_page_html(page, "</div>\n");
cleanup:
    sl_free(side);
    sl_free(value);
    sl_free(edge);
    return status;
}

static void show_findings(exp_page *page, const hand_work *w)
{
    char list[256] = "";
    size_t at = 0;
    for (int32_t k = 1; k < w->s.spectrum->count; k++) {
        if (w->s.candidate[k - 1].passes && at + 8 < sizeof list) {
            at += (size_t)snprintf(list + at, sizeof list - at, "%s%d", at > 0 ? ", " : "", k);
        }
    }
    exp_page_html(
        page,
        "<p>%d facets, %d eigenvectors, largest residual %.1e. The connectivity filter keeps %d of %d: %s. The "
        "others oscillate along directions already found: more than two nodal parts.</p>\n",
        w->s.face_count, w->s.spectrum->count, w->s.spectrum->info.max_residual, w->passing, w->s.spectrum->count - 1,
        list);
}

static void measure_spectrum(exp_claims *claims, hand_work *w)
{
    double beyond = -HUGE_VAL;
    w->passing = 0;
    for (int32_t k = 1; k < w->s.spectrum->count; k++) {
        const sl_cut_candidate *c = &w->s.candidate[k - 1];
        w->passing += c->passes;
        beyond = fmax(beyond, c->positive_parts + c->negative_parts - (k + 1));
    }
    exp_claims_measure(claims, w->pose->title, "converged", w->s.spectrum->info.converged);
    exp_claims_measure(claims, w->pose->title, "largest residual", w->s.spectrum->info.max_residual);
    exp_claims_measure(claims, w->pose->title, "fiedler passes", w->s.candidate[0].passes);
    exp_claims_measure(claims, w->pose->title, "nodal parts of the Fiedler vector",
                       w->s.candidate[0].positive_parts + w->s.candidate[0].negative_parts);
    exp_claims_measure(claims, w->pose->title, "Courant: most nodal parts beyond k + 1", beyond);
    exp_claims_measure(claims, w->pose->title, "vectors that pass", w->passing);
}

static sl_status show_sheet(exp_run *run, exp_page *page, const hand_work *w)
{
    char file[64];
    exp_page_html(page, "<h3>%s</h3>\n", w->pose->heading);
    show_findings(page, w);
    const sl_status status = show_vectors(run, page, w);
    snprintf(file, sizeof file, "%s.svg", w->pose->tag);
    exp_page_html(page, "<div class=\"plot\">\n");
    exp_page_figure(page, "", file, "eigenvalues by number, those that pass marked",
                    "Eigenvalues; a dot in green is a cut that passes the filter.");
    exp_page_html(page, "</div>\n");
    return status;
}

sl_status hand_show(exp_run *run, exp_page *page, exp_claims *claims, const exp_source *source, const hand_pose *pose,
                    hand_work *w)
{
    sl_status status = SL_OK;
    SL_TRY(hand_compute(run, source, pose, w));
    SL_TRY(hand_write_csv(run, w));
    measure_spectrum(claims, w);
    if (pose->sheet) {
        SL_TRY(show_sheet(run, page, w));
    }
    SL_TRY(hand_rules(run, page, claims, w));
cleanup:
    return status;
}
