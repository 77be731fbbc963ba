/* Figure 6: the eigenvectors of a hand's facet graph, their nodal sets, and the cuts the three rules take from them. */
#include "hand.h"
#include "support/claims.h"
#include "support/main.h"

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

static sl_status show_hands(exp_run *run, exp_page *page, exp_claims *claims)
{
    sl_status status = SL_OK;
    exp_source *source = sl_alloc(EXP_MAX_MESHES, sizeof *source);
    if (source == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    introduce(page);
    const int32_t count = exp_list_sources(run, source);
    for (int32_t k = 0; k < count; k++) {
        if (strcmp(source[k].name, "hand") == 0) {
            SL_TRY(hand_show(run, page, claims, &source[k]));
        }
    }
cleanup:
    sl_free(source);
    return status;
}

int main(int argc, char **argv)
{
    return exp_main(argc, argv, "fig06-hand", "Figure 6: eigenvectors of a hand and the cuts they propose", NULL,
                    EXPECTED_CSV, show_hands);
}
