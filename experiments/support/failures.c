#include "support/failures.h"

#include <stdio.h>
#include <string.h>

bool exp_failed(exp_run *run, const char *name, sl_status *status)
{
    if (*status == SL_OK || *status == SL_CANCELLED || *status == SL_IO) {
        return false;
    }
    exp_failure spare, *f = run->failed < EXP_MAX_FAILURES ? &run->failure[run->failed] : &spare;
    const char *what = sl_status_name(*status);
    snprintf(f->name, sizeof f->name, "%s", name);
    snprintf(f->reason, sizeof f->reason, "%s: ", what);
    sl_diag_format(&run->diag, f->reason + strlen(f->reason), sizeof f->reason - strlen(f->reason));
    if (strlen(f->reason) == strlen(what) + 2) { /* nobody said why */
        f->reason[strlen(what)] = '\0';
    }
    fprintf(stderr, "failed: %s: %s\n", f->name, f->reason);
    run->failed++;
    run->diag = sl_diag_none();
    *status = SL_OK;
    return true;
}

sl_status exp_row(exp_run *run, const char *name, sl_status status)
{
    exp_failed(run, name, &status);
    return status;
}

int32_t exp_failures_show(const exp_run *run, exp_page *page)
{
    if (run->failed == 0) {
        return 0;
    }
    exp_page_html(page, "<h3>What failed</h3>\n<p>%d failed; the numbers above are without them.</p>\n", run->failed);
    exp_page_table_begin(page, "what|why");
    for (int32_t k = 0; k < run->failed && k < EXP_MAX_FAILURES; k++) {
        exp_page_html(page, "<tr class=\"bad\"><td>");
        exp_page_text(page, run->failure[k].name);
        exp_page_html(page, "</td><td class=\"says\">");
        exp_page_text(page, run->failure[k].reason);
        exp_page_html(page, "</td></tr>\n");
    }
    exp_page_table_end(page);
    return run->failed;
}
