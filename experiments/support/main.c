#include "support/main.h"

#include "support/failures.h"

int exp_main(int argc, char **argv, const char *folder, const char *heading, const char *introduction,
             const char *expected, exp_show_fn *show)
{
    exp_run run;
    exp_page page = {0};
    exp_claims claims = {0};
    int32_t broken = 0;
    sl_status status = SL_OK;
    if (!exp_begin(&run, argc, argv)) {
        return 2;
    }
    SL_TRY(exp_claims_read(expected, &claims, &run.diag));
    SL_TRY(exp_page_open(&run, folder, heading, &page));
    if (introduction != NULL) {
        exp_page_html(&page, "<p>%s</p>\n", introduction);
    }
    SL_TRY(show(&run, &page, &claims));
    broken = exp_failures_show(&run, &page);
    broken += exp_claims_report(&claims, &run, &page);
    exp_page_html(&page, "<p class=\"quiet\">This alone: <code>experiments/reproduce %s</code></p>\n", folder);
    SL_TRY(exp_page_close(&run, &page));
    SL_TRY(exp_claims_write(&claims, &run, folder, heading));
cleanup:
    exp_page_abandon(&page);
    exp_claims_clear(&claims);
    return exp_end(&run, status, broken);
}
