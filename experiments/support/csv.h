/* Comma-separated numbers beside the page. What differs from run to run, times and peaks of memory, goes to files whose
 * names begin with "timing" and nowhere else: all other files are the same bytes on every run.
 * Layer: experiments. */
#ifndef SL_EXPERIMENTS_CSV_H
#define SL_EXPERIMENTS_CSV_H

#include "support/run.h"

/* Opens OUT/name and writes the header as its first line. SL_IO. */
SL_NODISCARD sl_status exp_csv_open(exp_run *run, const char *name, const char *header, sl_writer **csv);

/* A comma and a number, count times, exact to the last bit. */
void exp_csv_numbers(sl_writer *csv, const double *value, int32_t count);

/* Ends the file and sets *csv to NULL, whether it succeeds or not; what is not closed is given up by
 * sl_writer_abandon. SL_IO. */
SL_NODISCARD sl_status exp_csv_close(exp_run *run, sl_writer **csv);

#endif
