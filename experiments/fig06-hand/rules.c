#include "hand.h"
#include "support/pictures.h"

#include <math.h>
#include <stdio.h>

enum { CUT_WIDTH = 420, CUT_HEIGHT = 460 };

static const char *const rule_name[HAND_RULES] = {"longest", "length / &radic;&lambda;", "lookahead"};
static const char *const rule_file[HAND_RULES] = {"longest", "length-lambda", "lookahead"};

/* The passing candidate with the largest length * lambda^power; -1 = none passes. */
static int32_t best_candidate(const hand_work *w, double power)
{
    int32_t best = -1;
    double best_score = -1.0;
    for (int32_t k = 1; k < w->s.spectrum->count; k++) {
        const sl_cut_candidate *c = &w->s.candidate[k - 1];
        const double score = c->seam_length * pow(w->s.spectrum->lambda[k], power);
        if (c->passes && score > best_score) {
            best = k;
            best_score = score;
        }
    }
    return best;
}

/* Segments a copy of the mesh; max_charts 0 = to the end. */
static sl_status segment_copy(exp_run *run, const hand_work *w, sl_cut_rule rule, int32_t max_charts, sl_mesh **mesh,
                              sl_segmentation **seg)
{
    sl_segment_def def = sl_segment_default();
    def.rule = rule;
    def.pairing = SL_PAIR_OFF;
    def.vectors = HAND_VECTORS;
    def.sew = false;
    if (max_charts > 0) {
        def.max_charts = max_charts;
        def.smooth = 0;
        def.join = false;
    }
    sl_status status = sl_mesh_copy(w->s.mesh, mesh);
    if (status == SL_OK) {
        status = sl_segment(*mesh, w->s.triangulation, &def, &run->context, seg);
    }
    return status;
}

static int32_t invalid_charts(const sl_segmentation *seg)
{
    int32_t invalid = 0;
    for (int32_t c = 0; c < seg->nchart; c++) {
        invalid += seg->chart[c].flat.verdict != SL_CHART_VALID;
    }
    return invalid;
}

/* The vector of the first split of the largest component. */
static int32_t first_vector(const hand_work *w, const sl_segmentation *seg)
{
    for (int32_t k = 0; k < seg->nsplit; k++) {
        if (seg->split[k].facets == w->s.face_count) {
            return seg->split[k].vector;
        }
    }
    return -1;
}

/* The hand from its edge, so that palm and back are both seen. */
static sl_view edge_view(void)
{
    sl_view view = exp_view_of("hand");
    view.azimuth -= 62.0;
    return view;
}

/* Draws a segmentation of the rule: the first cut alone, or all charts. */
static sl_status show_rule(exp_run *run, exp_page *page, exp_claims *claims, hand_work *w, sl_cut_rule rule,
                           bool first_cut)
{
    sl_status status = SL_OK;
    const sl_view view = edge_view();
    const sl_picture picture = exp_picture(run, CUT_WIDTH, CUT_HEIGHT);
    sl_mesh *mesh = NULL;
    sl_segmentation *seg = NULL;
    char file[96], alt[128], caption[256];
    SL_TRY(segment_copy(run, w, rule, first_cut ? 2 : 0, &mesh, &seg));
    snprintf(file, sizeof file, "%s-%s-%s.png", w->tag, first_cut ? "cut" : "charts", rule_file[rule]);
    snprintf(alt, sizeof alt, "%s of the %s by the rule %s", first_cut ? "first cut" : "charts", w->title,
             rule_file[rule]);
    if (first_cut) {
        w->chosen[rule] = first_vector(w, seg);
        snprintf(caption, sizeof caption, "<b>%s</b> takes v<sub>%d</sub>", rule_name[rule], w->chosen[rule]);
    } else {
        snprintf(caption, sizeof caption, "<b>%s</b>: %d charts, seams %.2f diagonals", rule_name[rule], seg->nchart,
                 sl_atlas_seam_length(mesh) / sl_mesh_diagonal(mesh));
        exp_claims_measure(claims, w->title, "invalid charts", invalid_charts(seg));
    }
    SL_TRY(exp_draw_charts(run, mesh, w->s.triangulation, seg->face_chart, &view, &picture, file));
    exp_page_figure(page, "", file, alt, caption);
cleanup:
    sl_segmentation_free(seg);
    sl_mesh_free(mesh);
    return status;
}

static sl_status show_row(exp_run *run, exp_page *page, exp_claims *claims, hand_work *w, bool first_cut)
{
    exp_page_html(page, "<div class=\"grid cuts\">\n");
    for (int rule = 0; rule < HAND_RULES; rule++) {
        const sl_status status = show_rule(run, page, claims, w, (sl_cut_rule)rule, first_cut);
        if (status != SL_OK) {
            return status;
        }
    }
    exp_page_html(page, "</div>\n");
    return SL_OK;
}

/* How well a vector's sides are the front and the back: share of the area seen along z that lies on its own side. */
static double front_and_back(const hand_work *w, int32_t vector)
{
    const double *v = w->s.spectrum->vectors + (int64_t)vector * w->s.spectrum->n;
    double agree = 0.0, all = 0.0;
    for (int32_t i = 0; i < w->s.face_count; i++) {
        double n[3];
        sl_mesh_face_vector_area(w->s.mesh, w->s.faces[i], n);
        agree += v[w->s.graph->node[i]] >= 0.0 ? n[2] : -n[2];
        all += fabs(n[2]);
    }
    return 0.5 + 0.5 * fabs(agree) / all;
}

sl_status hand_rules(exp_run *run, exp_page *page, exp_claims *claims, hand_work *w)
{
    sl_status status = SL_OK;
    const int32_t longest = best_candidate(w, 0.0), scaled = best_candidate(w, -0.5);
    const double share = longest > 0 ? front_and_back(w, longest) : 0.0;
    exp_page_html(
        page,
        "<p>Which candidate is the equator? The paper takes the <b>longest</b> seam: v<sub>%d</sub> here; %.1f %% "
        "of what is seen from the front or from behind lies on its own side of that seam%s. A serpentine high "
        "vector can be longest too, so two other rules stand beside it: seam length over &radic;&lambda;, which "
        "takes v<sub>%d</sub>, and <b>lookahead</b>, which flattens both halves of every candidate quickly and "
        "takes the least stretched. The one cut each of them makes, seen from the edge of the hand:</p>\n",
        longest, 100.0 * share, share > 0.9 ? ", so it is the equator" : "", scaled);
    SL_TRY(show_row(run, page, claims, w, true));
    exp_page_html(page, "<p>And the charts each ends with, cut until every chart is valid, nothing sewn:</p>\n");
    SL_TRY(show_row(run, page, claims, w, false));
    const int32_t ahead = w->chosen[SL_RULE_LOOKAHEAD];
    exp_claims_measure(claims, w->title, "rules that cut where the candidates say",
                       (w->chosen[SL_RULE_LONGEST] == longest) + (w->chosen[SL_RULE_LENGTH_LAMBDA] == scaled));
    exp_claims_measure(claims, w->title, "vector taken by lookahead passes",
                       ahead > 0 && w->s.candidate[ahead - 1].passes);
    exp_claims_measure(claims, w->title, "front and back apart by the longest seam", share);
cleanup:
    return status;
}
