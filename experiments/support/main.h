/* What all experiments do around their own work.
 * Layer: experiments. */
#ifndef SL_EXPERIMENTS_MAIN_H
#define SL_EXPERIMENTS_MAIN_H

#include "support/claims.h"

/* Measures, draws, and writes into the page. */
typedef sl_status exp_show_fn(exp_run *run, exp_page *page, exp_claims *claims);

/* An experiment's main: command line, claims (expected: their file), a section under the heading with an introduction
 * (HTML of a paragraph; nullable), show, the verdict on every claim, and how to run this alone. folder: the
 * experiment's name. Returns the exit code: 0, 1 on a failure or a violated claim, 2 on wrong usage. */
int exp_main(int argc, char **argv, const char *folder, const char *heading, const char *introduction,
             const char *expected, exp_show_fn *show);

#endif
