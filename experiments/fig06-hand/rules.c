#include "hand.h"
#include "support/pictures.h"

#include <math.h>
#include <stdio.h>

enum { CUT_WIDTH = 420, CUT_HEIGHT = 460 };

const char *const hand_rule_title[HAND_RULES] = {"longest", "length / &radic;&lambda;", "lookahead"};
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

/* How well a vector's sides are the front and the back of the hand as it was before it took its pose: share of the
 * area seen along z that lies on its own side. */
static double front_and_back(const hand_work *w, int32_t vector)
{
    const sl_polygons *rest = &w->input.polygons;
    const double *v = w->s.spectrum->vectors + (int64_t)vector * w->s.spectrum->n;
    double agree = 0.0, all = 0.0;
    for (int32_t i = 0; i < w->s.face_count; i++) {
        const int32_t f = w->s.faces[i], first = rest->face_first[f], end = rest->face_first[f + 1];
        double z = 0.0; /* of the facet's vector area */
        for (int32_t c = first; c < end; c++) {
            const double *p = rest->xyz + 3 * (int64_t)rest->index[c],
                         *q = rest->xyz + 3 * (int64_t)rest->index[c + 1 < end ? c + 1 : first];
            z += 0.5 * (p[0] * q[1] - p[1] * q[0]);
        }
        agree += v[w->s.graph->node[i]] >= 0.0 ? z : -z;
        all += fabs(z);
    }
    return 0.5 + 0.5 * fabs(agree) / all;
}

/* Draws a segmentation of the rule: the first cut alone, or all charts. */
static sl_status draw_rule(exp_run *run, exp_page *page, const hand_work *w, const sl_mesh *mesh,
                           const sl_segmentation *seg, sl_cut_rule rule, bool first_cut)
{
    const sl_view view = hand_view(w->pose, true);
    const sl_picture picture = exp_picture(run, CUT_WIDTH, CUT_HEIGHT);
    const hand_choice *choice = &w->choice[rule];
    char file[96], alt[128], caption[256];
    snprintf(file, sizeof file, "%s-%s-%s.png", w->pose->tag, first_cut ? "cut" : "charts", rule_file[rule]);
    snprintf(alt, sizeof alt, "%s of the %s by the rule %s", first_cut ? "first cut" : "charts", w->pose->title,
             rule_file[rule]);
    if (first_cut) {
        snprintf(caption, sizeof caption, "<b>%s</b> takes v<sub>%d</sub>", hand_rule_title[rule], choice->vector);
    } else {
        snprintf(caption, sizeof caption, "<b>%s</b>: %d chart%s, seams %.2f diagonals", hand_rule_title[rule],
                 choice->charts, sl_plural(choice->charts), choice->seam);
    }
    const sl_status status = exp_draw_charts(run, mesh, w->s.triangulation, seg->face_chart, &view, &picture, file);
    if (status == SL_OK) {
        exp_page_figure(page, "", file, alt, caption);
    }
    return status;
}

/* Cuts by the rule, once or to the end, and keeps what came of it. */
static sl_status run_rule(exp_run *run, exp_page *page, exp_claims *claims, hand_work *w, sl_cut_rule rule,
                          bool first_cut)
{
    sl_status status = SL_OK;
    sl_mesh *mesh = NULL;
    sl_segmentation *seg = NULL;
    hand_choice *choice = &w->choice[rule];
    SL_TRY(segment_copy(run, w, rule, first_cut ? 2 : 0, &mesh, &seg));
    if (first_cut) {
        choice->vector = first_vector(w, seg);
        choice->share = choice->vector > 0 ? front_and_back(w, choice->vector) : 0.5;
    } else {
        choice->charts = seg->nchart;
        choice->seam = sl_atlas_seam_length(mesh) / sl_mesh_diagonal(mesh);
        exp_claims_measure(claims, w->pose->title, "invalid charts", invalid_charts(seg));
    }
    if (w->pose->sheet) {
        SL_TRY(draw_rule(run, page, w, mesh, seg, rule, first_cut));
    }
cleanup:
    sl_segmentation_free(seg);
    sl_mesh_free(mesh);
    return status;
}

static sl_status run_rules(exp_run *run, exp_page *page, exp_claims *claims, hand_work *w, bool first_cut)
{
    sl_status status = SL_OK;
    exp_page_html(page, w->pose->sheet ? "<div class=\"grid cuts\">\n" : "");
    for (int rule = 0; rule < HAND_RULES && status == SL_OK; rule++) {
        status = run_rule(run, page, claims, w, (sl_cut_rule)rule, first_cut);
    }
    exp_page_html(page, w->pose->sheet ? "</div>\n" : "");
    return status;
}

static void introduce_rules(exp_page *page, int32_t longest, int32_t scaled, double share)
{
    exp_page_html(
        page,
        "<p>Which candidate is the equator? The paper takes the <b>longest</b> seam: v<sub>%d</sub> here; %.1f %% "
        "of what is seen from the front or from behind lies on its own side of that seam%s. A serpentine high "
        "vector can be longest too, so two other rules stand beside it: seam length over &radic;&lambda;, which "
        "takes v<sub>%d</sub>, and <b>lookahead</b>, which flattens both halves of every candidate quickly and "
        "takes the least stretched. The one cut each of them makes, seen from the edge of the hand:</p>\n",
        longest, 100.0 * share, share > 0.9 ? ", so it is the equator" : "", scaled);
}

sl_status hand_rules(exp_run *run, exp_page *page, exp_claims *claims, hand_work *w)
{
    sl_status status = SL_OK;
    const int32_t longest = best_candidate(w, 0.0), scaled = best_candidate(w, -0.5);
    const double share = longest > 0 ? front_and_back(w, longest) : 0.0;
    if (w->pose->sheet) {
        introduce_rules(page, longest, scaled, share);
    }
    SL_TRY(run_rules(run, page, claims, w, true));
    if (w->pose->sheet) {
        exp_page_html(page, "<p>And the charts each ends with, cut until every chart is valid, nothing sewn:</p>\n");
    }
    SL_TRY(run_rules(run, page, claims, w, false));
    const int32_t ahead = w->choice[SL_RULE_LOOKAHEAD].vector;
    exp_claims_measure(claims, w->pose->title, "rules that cut where the candidates say",
                       (w->choice[SL_RULE_LONGEST].vector == longest) +
                           (w->choice[SL_RULE_LENGTH_LAMBDA].vector == scaled));
    exp_claims_measure(claims, w->pose->title, "vector taken by lookahead passes",
                       ahead > 0 && w->s.candidate[ahead - 1].passes);
    exp_claims_measure(claims, w->pose->title, "front and back apart by the longest seam", share);
cleanup:
    return status;
}
