/* An experiment's section of the page: section.html, with pictures beside it.
 * Layer: experiments. */
#ifndef SL_EXPERIMENTS_PAGE_H
#define SL_EXPERIMENTS_PAGE_H

#include "support/run.h"

typedef struct exp_page {
    sl_writer *writer;
    const char *folder; /* the experiment's name: pictures are linked as folder/name */
} exp_page;

/* Opens OUT/section.html under a heading. Errors of later calls come out at the end. */
SL_NODISCARD sl_status exp_page_open(exp_run *run, const char *folder, const char *heading, exp_page *page);
SL_NODISCARD sl_status exp_page_close(exp_run *run, exp_page *page);
void exp_page_abandon(exp_page *page);

/* HTML as it is. */
void exp_page_html(exp_page *page, const char *format, ...) SL_PRINTF(2, 3);

/* Text with <, > and & made harmless. */
void exp_page_text(exp_page *page, const char *text);

/* A picture with a caption (HTML); class is "", "yes" (framed as good) or "no". */
void exp_page_figure(exp_page *page, const char *class_name, const char *file, const char *alt, const char *caption);

/* A table: header cells separated by '|', then rows of cells. */
void exp_page_table_begin(exp_page *page, const char *header);
void exp_page_row_begin(exp_page *page, bool bad);
void exp_page_cell(exp_page *page, const char *format, ...) SL_PRINTF(2, 3);

/* A cell with a time or a peak of memory: what differs from run to run stands in such cells (class "time") and, as
 * numbers, in files named timing*; all else is the same bytes (tests/experiments/twice.sh compares). */
void exp_page_time(exp_page *page, const char *format, ...) SL_PRINTF(2, 3);
void exp_page_row_end(exp_page *page);
void exp_page_table_end(exp_page *page);

#endif
