/* Figure 6: the eigenvectors of a hand's facet graph, their nodal sets, and the cuts the three rules take from them,
 * for the hand in several poses. */
#include "hand.h"
#include "support/csv.h"
#include "support/failures.h"
#include "support/main.h"

#include <stdio.h>
#include <string.h>

/* The generated hand; knuckles at 0.64 of its length. */
static const hand_pose poses[] = {
    {"hand", "hand", "The generated hand", HAND_AS_IT_IS, 0.0, 0.0, true, true},
    {"hand-bent", "hand bent", "bent by 90&deg;", HAND_ROLLED, 0.0, 90.0, false, true},
    {"hand-curled", "hand curled", "The hand curled by 240&deg;", HAND_ROLLED, 0.0, 240.0, true, false},
    {"hand-fist", "hand fist", "The hand, its fingers clenched", HAND_ROLLED, 0.64, 200.0, true, false},
    {"hand-wrist", "hand wrist", "bent at the wrist", HAND_ROLLED, 0.2, 110.0, false, false},
    {"hand-twisted", "hand twisted", "twisted by 150&deg;", HAND_TWISTED, 0.0, 150.0, false, true},
};

static const hand_pose of_corpus = {
    "corpus-hand", "hand (corpus)", "The hand of the corpus folder", HAND_AS_IT_IS, 0.0, 0.0, true, true};

/* What is kept of a hand for the table. */
typedef struct row {
    const hand_pose *pose;
    int32_t passing;
    hand_choice choice[HAND_RULES];
} row;

static void introduce(exp_page *page)
{
    exp_page_html(
        page,
        "<p>The paper computes 30 eigenvectors of the facet graph's Laplacian and keeps those whose positive and "
        "negative facets are each connected. Its Figure 6 shows a hand on which only eigenvector 13 is the "
        "&ldquo;equator&rdquo; between palm and back. That hand is not public; here is a generated one. Nothing is "
        "asserted about 13. Numbers count from 0, the constant vector; red and blue are the two signs, "
        "the black line is the cut between them; framed in green: both sides connected, the cut is a candidate.</p>\n");
}

/* The vectors are the same in every pose (the graph does not know positions), the seams' lengths are not. */
static void table(exp_page *page, const row *rows, int32_t count)
{
    exp_page_html(page, "<h3>Poses</h3>\n<p>Which vector each rule takes first, how much of palm and back it parts "
                        "(as they are on the straight hand; 1 = the equator), and how many charts it ends with. The "
                        "facet graph does not know the pose, so the vectors are the same; lengths, and what lookahead "
                        "flattens, are not.</p>\n");
    exp_page_table_begin(page, "pose|pass|longest: vector|parts|charts|length / &radic;&lambda;: vector|parts|charts|"
                               "lookahead: vector|parts|charts");
    for (int32_t k = 0; k < count; k++) {
        exp_page_row_begin(page, false);
        exp_page_cell(page, "%s", rows[k].pose->heading);
        exp_page_cell(page, "%d of %d", rows[k].passing, HAND_VECTORS - 1);
        for (int rule = 0; rule < HAND_RULES; rule++) {
            const hand_choice *c = &rows[k].choice[rule];
            exp_page_cell(page, "v<sub>%d</sub>", c->vector);
            exp_page_cell(page, "%.3f", c->share);
            exp_page_cell(page, "%d", c->charts);
        }
        exp_page_row_end(page);
    }
    exp_page_table_end(page);
}

static sl_status write_poses(exp_run *run, const row *rows, int32_t count)
{
    static const char *const name[HAND_RULES] = {"longest", "length-lambda", "lookahead"};
    sl_status status = SL_OK;
    sl_writer *csv = NULL;
    SL_TRY(exp_csv_open(run, "poses.csv", "pose,rule,passing,vector,parts,charts,seam", &csv));
    for (int32_t k = 0; k < count; k++) {
        for (int rule = 0; rule < HAND_RULES; rule++) {
            const hand_choice *c = &rows[k].choice[rule];
            sl_writer_format(csv, "%s,%s,%d,%d", rows[k].pose->title, name[rule], rows[k].passing, c->vector);
            exp_csv_numbers(csv, &c->share, 1);
            sl_writer_format(csv, ",%d", c->charts);
            exp_csv_numbers(csv, &c->seam, 1);
            sl_writer_text(csv, "\n");
        }
    }
    SL_TRY(exp_csv_close(run, &csv));
cleanup:
    sl_writer_abandon(csv);
    return status;
}

/* One hand in one pose; a failure is a row that says so. */
static sl_status one(exp_run *run, exp_page *page, exp_claims *claims, const exp_source *source, const hand_pose *pose,
                     row *rows, int32_t *count)
{
    hand_work w = {0};
    sl_status status = hand_show(run, page, claims, source, pose, &w);
    if (!exp_failed(run, pose->title, &status) && status == SL_OK) {
        row *r = &rows[(*count)++];
        *r = (row){.pose = pose, .passing = w.passing};
        memcpy(r->choice, w.choice, sizeof r->choice);
        if (source->generated) {
            exp_claims_measure(claims, pose->title, "palm and back apart by the longest seam in every pose",
                               r->choice[SL_RULE_LONGEST].share);
            exp_claims_measure(claims, pose->title, "charts by lookahead in every pose",
                               r->choice[SL_RULE_LOOKAHEAD].charts);
        }
        fprintf(stderr, "%s: v%d, v%d, v%d; %d, %d, %d charts\n", pose->title, r->choice[0].vector, r->choice[1].vector,
                r->choice[2].vector, r->choice[0].charts, r->choice[1].charts, r->choice[2].charts);
    }
    hand_clear(&w);
    return status;
}

static sl_status show_hands(exp_run *run, exp_page *page, exp_claims *claims)
{
    sl_status status = SL_OK;
    row rows[HAND_MOST_POSES];
    int32_t rows_count = 0;
    exp_source *source = sl_alloc(EXP_MAX_MESHES, sizeof *source);
    if (source == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    introduce(page);
    const int32_t count = exp_list_sources(run, source);
    for (int32_t k = 0; k < count; k++) {
        if (strcmp(source[k].name, "hand") != 0) {
            continue;
        }
        if (!source[k].generated) {
            SL_TRY(one(run, page, claims, &source[k], &of_corpus, rows, &rows_count));
            continue;
        }
        for (size_t p = 0; p < SL_COUNTOF(poses); p++) {
            if (poses[p].quick || !run->quick) {
                SL_TRY(one(run, page, claims, &source[k], &poses[p], rows, &rows_count));
            }
        }
    }
    table(page, rows, rows_count);
    SL_TRY(write_poses(run, rows, rows_count));
cleanup:
    sl_free(source);
    return status;
}

int main(int argc, char **argv)
{
    return exp_main(argc, argv, "fig06-hand", "Figure 6: eigenvectors of a hand and the cuts they propose", NULL,
                    EXPECTED_CSV, show_hands);
}
