/* One hand of Figure 6: spectrum, pictures, rules.
 * Layer: experiments. */
#ifndef SL_EXPERIMENTS_HAND_H
#define SL_EXPERIMENTS_HAND_H

#include "support/claims.h"
#include "support/spectrum.h"

enum { HAND_VECTORS = 30, HAND_RULES = 3 };

typedef struct hand_work {
    exp_mesh input;
    exp_spectrum s;
    const char *tag;            /* in file names: "hand", "corpus-hand" */
    const char *title;          /* in claims and headings: "hand", "hand (corpus)" */
    int32_t chosen[HAND_RULES]; /* vector by rule, in the order of sl_cut_rule */
} hand_work;

/* spectrum.c: loads the mesh and computes its spectrum. */
SL_NODISCARD sl_status hand_compute(exp_run *run, const exp_source *source, hand_work *w);
void hand_clear(hand_work *w);

/* Writes tag.csv: vector, lambda, parts, passes, seam. */
SL_NODISCARD sl_status hand_write_csv(exp_run *run, const hand_work *w);

/* rules.c: what each rule takes, by the candidates and by running the segmentation; pictures of the cuts. */
SL_NODISCARD sl_status hand_rules(exp_run *run, exp_page *page, exp_claims *claims, hand_work *w);

/* show.c: the whole part of the page. */
SL_NODISCARD sl_status hand_show(exp_run *run, exp_page *page, exp_claims *claims, const exp_source *source);

#endif
