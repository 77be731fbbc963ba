/* What `seamlab theorem` prints: a table, TAP version 13, or JSON.
 * Layer: cli. */
#ifndef SL_CLI_THEOREM_REPORT_H
#define SL_CLI_THEOREM_REPORT_H

#include "theorem/families.h"

/* One line of the report: a family, a mesh, or a graph read from a file. */
typedef struct theorem_row {
    char name[280];
    sl_theorem_result result;
    const char *skipped; /* why nothing was checked; NULL = it was */
    bool built_in;       /* its signs count for the share that may stay undecided */
} theorem_row;

typedef struct theorem_report {
    theorem_row *row;
    int32_t count;
    sl_theorem_result total;
    int64_t signs, signs_undecided; /* of the built-in rows */
    double undecided_share;         /* allowed */
    bool violated, decided;
    uint64_t seed;
    char replay[300]; /* the file a violating graph was written to; "" = none */
} theorem_report;

/* Sums the rows. */
void theorem_report_close(theorem_report *report);

void theorem_print_table(const theorem_report *report);
void theorem_print_tap(const theorem_report *report);
void theorem_print_json(const theorem_report *report);

#endif
