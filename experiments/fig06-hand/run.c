/* Figure 6: the eigenvectors of a hand's facet graph, their nodal sets, and the cuts the three rules take from them. */
#include "hand.h"
#include "support/claims.h"

#include <stdio.h>
#include <string.h>

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

int main(int argc, char **argv)
{
    exp_run run;
    exp_page page = {0};
    exp_claims claims = {0};
    exp_source *source = sl_alloc(EXP_MAX_MESHES, sizeof *source);
    int32_t broken = 0;
    sl_status status = SL_OK;
    if (!exp_begin(&run, argc, argv)) {
        sl_free(source);
        return 2;
    }
    if (source == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    SL_TRY(exp_claims_read(EXPECTED_CSV, &claims, &run.diag));
    SL_TRY(exp_page_open(&run, "fig06-hand", "Figure 6: eigenvectors of a hand and the cuts they propose", &page));
    introduce(&page);
    const int32_t count = exp_list_sources(&run, source);
    for (int32_t k = 0; k < count; k++) {
        if (strcmp(source[k].name, "hand") == 0) {
            SL_TRY(hand_show(&run, &page, &claims, &source[k]));
        }
    }
    broken = exp_claims_report(&claims, &run, &page);
    SL_TRY(exp_page_close(&run, &page));
cleanup:
    exp_page_abandon(&page);
    exp_claims_clear(&claims);
    sl_free(source);
    return exp_end(&run, status, broken);
}
