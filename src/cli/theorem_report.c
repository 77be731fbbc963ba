#include "cli/theorem_report.h"

#include <inttypes.h>
#include <jansson.h>
#include <stdio.h>

static const char *const verdict_name[] = {"holds", "undecided", "violated"};

void theorem_report_close(theorem_report *report)
{
    int64_t most = 0; /* undecided signs of one built-in graph */
    for (int32_t k = 0; k < report->count; k++) {
        const theorem_row *row = &report->row[k];
        sl_theorem_add(&report->total, &row->result);
        most = row->built_in && row->result.most_undecided > most ? row->result.most_undecided : most;
        for (int32_t s = 0; s < SL_THEOREM_STATEMENTS; s++) {
            report->violated = report->violated || row->result.tally[s].violated > 0;
            report->signs += row->built_in ? row->result.tally[s].signs : 0;
            report->signs_undecided += row->built_in ? row->result.tally[s].signs_undecided : 0;
        }
    }
    report->decided = sl_theorem_signs_suffice(report->signs, report->signs_undecided, most, report->undecided_share);
}

static int64_t asked(const sl_theorem_tally *t)
{
    return t->holds + t->undecided + t->violated;
}

/* "825", "825 ?3" with three undecided, "825 !2" with two violated, "-" where it does not apply. */
static void print_cell(const sl_theorem_tally *t)
{
    char text[48];
    if (asked(t) == 0) {
        snprintf(text, sizeof text, "-");
    } else if (t->violated > 0) {
        snprintf(text, sizeof text, "%" PRId64 " !%" PRId64, asked(t), t->violated);
    } else if (t->undecided > 0) {
        snprintf(text, sizeof text, "%" PRId64 " ?%" PRId64, asked(t), t->undecided);
    } else {
        snprintf(text, sizeof text, "%" PRId64, asked(t));
    }
    printf(" %10s", text);
}

static void print_facts(const theorem_report *report)
{
    const sl_theorem_result *t = &report->total;
    const int64_t zeros = t->tally[SL_THEOREM_AXIS].zeros;
    printf("\nsigns             %" PRId64 " asked of the built-in graphs, %" PRId64 " undecided; %" PRId64
           " values shown to be 0\n",
           report->signs, report->signs_undecided, zeros);
    printf("spectra           largest difference between L and its halves %.2e of ||L||\n", t->largest_difference);
    printf("vectors           largest error bound that signs were read with %.2e\n", t->largest_bound);
    printf("contain the axis  fails for %" PRId64 " of %" PRId64
           " antisymmetric eigenspaces (a value on the axis is 0)\n",
           t->seams_off_axis, t->antisymmetric);
    printf("A'' not diagonal  lowest antisymmetric vector one-signed on the half as given: %" PRId64 " of %" PRId64
           " graphs\n",
           t->crossed_one_sign, t->crossed);
    printf("two mirrors       %" PRId64 " eigenspaces without a basis common to mirrors that do not commute\n",
           t->no_common_basis);
}

void theorem_print_table(const theorem_report *report)
{
    printf("%-24s %7s", "", "graphs");
    for (int32_t s = 0; s < SL_THEOREM_STATEMENTS; s++) {
        printf(" %10s", sl_theorem_statement_name((sl_theorem_statement)s));
    }
    printf("\n");
    for (int32_t k = 0; k < report->count; k++) {
        const theorem_row *row = &report->row[k];
        if (row->skipped != NULL) {
            printf("%-24s %s\n", row->name, row->skipped);
            continue;
        }
        printf("%-24s %7" PRId64, row->name, row->result.graphs);
        for (int32_t s = 0; s < SL_THEOREM_STATEMENTS; s++) {
            print_cell(&row->result.tally[s]);
        }
        if (row->result.lowest_index >= 0) { /* one graph alone */
            printf("  lowest antisymmetric vector: %d", row->result.lowest_index);
        }
        printf("\n");
    }
    print_facts(report);
    printf("\n%s\n", report->violated   ? "VIOLATED: !n counts the graphs for which a statement fails"
                     : !report->decided ? "UNDECIDED: too many signs are within their error bounds"
                                        : "every statement holds");
    for (int32_t k = 0; k < report->count; k++) {
        if (report->row[k].result.reason[0] != '\0') {
            printf("%s: %s\n", report->row[k].name, report->row[k].result.reason);
        }
    }
    if (report->replay[0] != '\0') {
        printf("replay with: seamlab theorem --graph %s\n", report->replay);
    }
}

/* Points of the plan: a skipped row is one, the share of undecided signs another. */
static int32_t count_points(const theorem_report *report)
{
    int32_t points = 1;
    for (int32_t k = 0; k < report->count; k++) {
        points += report->row[k].skipped != NULL ? 1 : 0;
        for (int32_t s = 0; s < SL_THEOREM_STATEMENTS; s++) {
            points += asked(&report->row[k].result.tally[s]) > 0 ? 1 : 0;
        }
    }
    return points;
}

/* '#' opens a directive in TAP: a name must not. */
static void print_name(const char *name)
{
    for (const char *p = name; *p != '\0'; p++) {
        putchar(*p == '#' || (unsigned char)*p < ' ' ? '_' : *p);
    }
}

static void print_tap_row(const theorem_row *row, int32_t *number)
{
    for (int32_t s = 0; s < SL_THEOREM_STATEMENTS; s++) {
        const sl_theorem_tally *t = &row->result.tally[s];
        if (asked(t) == 0) {
            continue;
        }
        printf("%s %d - ", t->violated > 0 ? "not ok" : "ok", ++*number);
        print_name(row->name);
        printf(": %d %s: %" PRId64 " of %" PRId64 " hold", s, sl_theorem_statement_name((sl_theorem_statement)s),
               t->holds, asked(t));
        if (t->undecided > 0) {
            printf(", %" PRId64 " undecided", t->undecided);
        }
        printf("\n");
        if (t->violated > 0) {
            printf("  ---\n  violated: %" PRId64 "\n  reason: \"%s\"\n  ...\n", t->violated,
                   row->result.failed == (sl_theorem_statement)s ? row->result.reason : "see the first failure");
        }
    }
}

void theorem_print_tap(const theorem_report *report)
{
    int32_t number = 0;
    printf("TAP version 13\n1..%d\n", count_points(report));
    for (int32_t k = 0; k < report->count; k++) {
        const theorem_row *row = &report->row[k];
        if (row->skipped != NULL) {
            printf("ok %d - ", ++number);
            print_name(row->name);
            printf(" # SKIP %s\n", row->skipped);
        } else {
            print_tap_row(row, &number);
        }
    }
    printf("%s %d - signs: %" PRId64 " of %" PRId64 " undecided, at most %g allowed\n",
           report->decided ? "ok" : "not ok", ++number, report->signs_undecided, report->signs,
           report->undecided_share);
    if (report->replay[0] != '\0') {
        printf("# replay with: seamlab theorem --graph %s\n", report->replay);
    }
}

static json_t *tally_json(const sl_theorem_tally *t, sl_theorem_statement statement)
{
    return json_pack("{s:i, s:s, s:s, s:I, s:I, s:I, s:I, s:I, s:I}", "statement", (int)statement, "name",
                     sl_theorem_statement_name(statement), "verdict", verdict_name[sl_theorem_verdict_of(t)], "holds",
                     (json_int_t)t->holds, "undecided", (json_int_t)t->undecided, "violated", (json_int_t)t->violated,
                     "signs", (json_int_t)t->signs, "zeros", (json_int_t)t->zeros, "signs_undecided",
                     (json_int_t)t->signs_undecided);
}

static json_t *row_json(const theorem_row *row)
{
    const sl_theorem_result *r = &row->result;
    json_t *list = json_array();
    for (int32_t s = 0; s < SL_THEOREM_STATEMENTS; s++) {
        if (asked(&r->tally[s]) > 0) {
            json_array_append_new(list, tally_json(&r->tally[s], (sl_theorem_statement)s));
        }
    }
    json_t *j = json_pack("{s:s, s:b, s:I, s:I, s:f, s:f, s:I, s:I, s:I, s:o}", "name", row->name, "built_in",
                          row->built_in, "graphs", (json_int_t)r->graphs, "nodes", (json_int_t)r->nodes,
                          "largest_difference", r->largest_difference, "largest_bound", r->largest_bound, "blocks",
                          (json_int_t)r->blocks, "seams_off_axis", (json_int_t)r->seams_off_axis, "antisymmetric",
                          (json_int_t)r->antisymmetric, "statements", list);
    if (row->skipped != NULL) {
        json_object_set_new(j, "skipped", json_string(row->skipped));
    }
    if (r->graphs == 1 && r->lowest_index >= 0) {
        json_object_set_new(j, "lowest_antisymmetric", json_integer(r->lowest_index));
    }
    if (r->reason[0] != '\0') {
        json_object_set_new(j, "reason", json_string(r->reason));
    }
    return j;
}

void theorem_print_json(const theorem_report *report)
{
    json_t *rows = json_array();
    for (int32_t k = 0; k < report->count; k++) {
        json_array_append_new(rows, row_json(&report->row[k]));
    }
    json_t *j = json_pack("{s:i, s:I, s:b, s:b, s:I, s:I, s:f, s:I, s:I, s:I, s:o}", "schema", 1, "seed",
                          (json_int_t)report->seed, "violated", report->violated, "decided", report->decided, "signs",
                          (json_int_t)report->signs, "signs_undecided", (json_int_t)report->signs_undecided,
                          "undecided_share", report->undecided_share, "crossed", (json_int_t)report->total.crossed,
                          "crossed_one_sign", (json_int_t)report->total.crossed_one_sign, "no_common_basis",
                          (json_int_t)report->total.no_common_basis, "rows", rows);
    if (report->replay[0] != '\0') {
        json_object_set_new(j, "replay", json_string(report->replay));
    }
    json_dumpf(j, stdout, JSON_COMPACT | JSON_REAL_PRECISION(15));
    putchar('\n');
    json_decref(j);
}
