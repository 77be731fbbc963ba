/* One model that fails is a row of its experiment, not the experiment's end.
 * Layer: experiments. */
#ifndef SL_EXPERIMENTS_FAILURES_H
#define SL_EXPERIMENTS_FAILURES_H

#include "support/page.h"

/* Did this model (or "model by method") fail? Then the failure is kept with its reason, *status becomes SL_OK and the
 * loop goes on; what is left of the model is the caller's to clear. What ends a run (SL_CANCELLED, SL_IO: the results
 * cannot be written) is no model's fault: false, *status as it was. */
bool exp_failed(exp_run *run, const char *name, sl_status *status);

/* The same around a call: SL_TRY(exp_row(run, name, call)) goes on where only a model failed. */
SL_NODISCARD sl_status exp_row(exp_run *run, const char *name, sl_status status);

/* A table of what failed, where anything did. Returns how many. */
int32_t exp_failures_show(const exp_run *run, exp_page *page);

#endif
