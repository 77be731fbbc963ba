#include "support/claims.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* One line into a claim; false when it does not read as one. */
static bool parse_claim(const char *line, exp_claim *claim)
{
    char bound[64], when[16];
    *claim = (exp_claim){0};
    if (sscanf(line, "%63[^,],%63[^,],%3[^,],%63[^,],%15[^,],%239[^\n]", claim->mesh, claim->quantity, claim->relation,
               bound, when, claim->says) < 5) {
        return false;
    }
    const char *end = bound + strlen(bound);
    claim->corpus_only = strcmp(when, "corpus") == 0;
    return sl_parse_double(bound, end, &claim->bound) == end && (claim->corpus_only || strcmp(when, "always") == 0) &&
           (strcmp(claim->relation, "<=") == 0 || strcmp(claim->relation, ">=") == 0 ||
            strcmp(claim->relation, "=") == 0);
}

sl_status exp_claims_read(const char *path, exp_claims *claims, sl_diag *diag)
{
    char *data = NULL;
    int64_t size = 0, capacity = 0, number = 0;
    *claims = (exp_claims){0};
    sl_status status = sl_file_read(path, &data, &size, diag);
    for (char *line = data; status == SL_OK && line != NULL && *line != '\0';) {
        char *end = strchr(line, '\n');
        char *next = end != NULL ? end + 1 : line + strlen(line);
        if (end != NULL) {
            *end = '\0';
        }
        number++;
        if (line[0] != '#' && line[0] != '\0') {
            status = sl_reserve((void **)&claims->claim, &capacity, claims->count + 1, sizeof *claims->claim);
            if (status == SL_OK && !parse_claim(line, &claims->claim[claims->count++])) {
                sl_diag_reason(diag, "%s, line %lld is no claim", path, (long long)number);
                status = SL_BAD_INPUT;
            }
        }
        line = next;
    }
    sl_free(data);
    return status;
}

void exp_claims_clear(exp_claims *claims)
{
    sl_free(claims->claim);
    *claims = (exp_claims){0};
}

/* How far beyond the bound; <= 0 keeps the claim, NaN breaks it. */
static double excess(const exp_claim *claim, double value)
{
    if (isnan(value)) {
        return HUGE_VAL;
    }
    switch (claim->relation[0]) {
    case '<':
        return value - claim->bound;
    case '>':
        return claim->bound - value;
    default:
        return fabs(value - claim->bound);
    }
}

bool exp_claims_measure(exp_claims *claims, const char *mesh, const char *quantity, double value)
{
    bool kept = true;
    for (int32_t k = 0; k < claims->count; k++) {
        exp_claim *claim = &claims->claim[k];
        if (strcmp(claim->quantity, quantity) != 0 ||
            (strcmp(claim->mesh, "*") != 0 && strcmp(claim->mesh, mesh) != 0)) {
            continue;
        }
        if (claim->measured == 0 || excess(claim, value) > excess(claim, claim->worst)) {
            claim->worst = value;
            snprintf(claim->worst_mesh, sizeof claim->worst_mesh, "%s", mesh);
        }
        claim->measured++;
        if (excess(claim, value) > 0.0) {
            claim->violated++;
            kept = false;
        }
    }
    return kept;
}

bool exp_claim_is_time(const exp_claim *claim)
{
    return strstr(claim->quantity, "seconds") != NULL;
}

bool exp_claim_broken(const exp_claim *claim)
{
    return claim->violated > 0 || claim->measured == 0;
}

int32_t exp_claims_report(const exp_claims *claims, const exp_run *run, exp_page *page)
{
    int32_t broken = 0;
    exp_page_html(page, "<h3>Claims checked on every run</h3>\n");
    exp_page_table_begin(page, "quantity|mesh|must be|measured|meshes|");
    for (int32_t k = 0; k < claims->count; k++) {
        const exp_claim *c = &claims->claim[k];
        if (c->corpus_only && run->corpus == NULL) {
            continue;
        }
        const bool bad = exp_claim_broken(c);
        broken += bad;
        exp_page_row_begin(page, bad);
        exp_page_cell(page, "%s", c->quantity);
        exp_page_cell(page, "%s", strcmp(c->mesh, "*") == 0 ? "all" : c->mesh);
        exp_page_cell(page, "%s %g", c->relation[0] == '<' ? "&le;" : c->relation[0] == '>' ? "&ge;" : "=", c->bound);
        if (c->measured == 0) {
            exp_page_cell(page, "never");
        } else if (exp_claim_is_time(c)) {
            exp_page_time(page, "%.6g (%s)", c->worst, c->worst_mesh);
        } else {
            exp_page_cell(page, "%.6g (%s)", c->worst, c->worst_mesh);
        }
        exp_page_cell(page, "%d", c->measured);
        exp_page_cell(page, bad ? "<b>violated</b>" : "holds");
        exp_page_row_end(page);
        if (bad) {
            fprintf(stderr, "violated: %s of %s %s %g, measured %g (%s)\n", c->quantity, c->mesh, c->relation, c->bound,
                    c->worst, c->measured > 0 ? c->worst_mesh : "never");
        }
    }
    exp_page_table_end(page);
    return broken;
}
