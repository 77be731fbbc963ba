#include "support/claims.h"
#include "support/csv.h"

#include <stdio.h>
#include <string.h>

static bool applies(const exp_claim *claim, const exp_run *run)
{
    return !claim->corpus_only || run->corpus != NULL;
}

/* A field between quotes, quotes doubled. */
static void csv_text(sl_writer *writer, const char *text)
{
    sl_writer_text(writer, "\"");
    for (; *text != '\0'; text++) {
        sl_writer_bytes(writer, *text == '"' ? "\"\"" : text, *text == '"' ? 2 : 1);
    }
    sl_writer_text(writer, "\"");
}

static void csv_row(sl_writer *writer, const exp_claim *c)
{
    sl_writer_format(writer, "%s,%s,%s,", c->mesh, c->quantity, c->relation);
    sl_writer_double(writer, c->bound);
    sl_writer_text(writer, ",");
    if (c->measured > 0) {
        sl_writer_double(writer, c->worst);
    }
    sl_writer_format(writer, ",%s,%d,%s,", c->worst_mesh, c->measured, exp_claim_broken(c) ? "no" : "yes");
    csv_text(writer, c->says);
    sl_writer_text(writer, "\n");
}

static void overview_row(exp_page *page, const exp_claim *c, const char *folder, const char *name)
{
    const bool bad = exp_claim_broken(c);
    exp_page_html(page, "<tr%s><td><a href=\"#%s\">%s</a></td><td class=\"says\">", bad ? " class=\"bad\"" : "", folder,
                  name);
    exp_page_text(page, c->says);
    exp_page_html(page, "</td><td class=\"%s\">", exp_claim_is_time(c) ? "says time" : "says");
    exp_page_text(page, c->quantity);
    if (strcmp(c->mesh, "*") != 0) {
        exp_page_html(page, " of %s", c->mesh);
    }
    exp_page_html(page, c->measured > 0 ? ": %.6g (must be %s %g)" : ": never measured", c->worst,
                  c->relation[0] == '<'   ? "&le;"
                  : c->relation[0] == '>' ? "&ge;"
                                          : "=",
                  c->bound);
    exp_page_html(page, "</td><td>%s</td><td><code>experiments/reproduce %s</code></td></tr>\n",
                  bad ? "<b>does not hold</b>" : "holds", folder);
}

/* One row for the checks that quote nothing. */
static void overview_rest(exp_page *page, const exp_claims *claims, const exp_run *run, const char *folder,
                          const char *name)
{
    int32_t checks = 0, broken = 0;
    for (int32_t k = 0; k < claims->count; k++) {
        const exp_claim *c = &claims->claim[k];
        checks += applies(c, run) && c->says[0] == '\0';
        broken += applies(c, run) && c->says[0] == '\0' && exp_claim_broken(c);
    }
    if (checks > 0) {
        exp_page_html(page,
                      "<tr%s><td><a href=\"#%s\">%s</a></td><td class=\"says quiet\">(checks of our own)</td>"
                      "<td class=\"says\">%d of %d hold</td><td>%s</td>"
                      "<td><code>experiments/reproduce %s</code></td></tr>\n",
                      broken > 0 ? " class=\"bad\"" : "", folder, name, checks - broken, checks,
                      broken > 0 ? "<b>does not hold</b>" : "holds", folder);
    }
}

sl_status exp_claims_write(const exp_claims *claims, exp_run *run, const char *folder, const char *heading)
{
    sl_status status = SL_OK;
    sl_writer *csv = NULL;
    exp_page overview = {.folder = folder};
    char path[EXP_PATH], name[96];
    const char *colon = strchr(heading, ':');
    const size_t length = colon != NULL ? (size_t)(colon - heading) : strlen(heading);
    snprintf(name, sizeof name, "%.*s", (int)length, heading);
    SL_TRY(exp_csv_open(run, "claims.csv", "mesh,quantity,relation,bound,measured,where,meshes,holds,paper", &csv));
    SL_TRY(exp_path(run, "overview.html", path));
    SL_TRY(sl_writer_create(path, &overview.writer, &run->diag));
    for (int32_t k = 0; k < claims->count; k++) {
        const exp_claim *c = &claims->claim[k];
        if (!applies(c, run)) {
            continue;
        }
        csv_row(csv, c);
        if (c->says[0] != '\0') {
            overview_row(&overview, c, folder, name);
        }
    }
    overview_rest(&overview, claims, run, folder, name);
    SL_TRY(exp_csv_close(run, &csv));
    status = sl_writer_commit(overview.writer, &run->diag);
    overview.writer = NULL;
cleanup:
    sl_writer_abandon(csv);
    sl_writer_abandon(overview.writer);
    return status;
}
