/* Claims that an experiment's numbers must keep: expected.csv beside its run.c, a line
 *
 *     mesh,quantity,relation,bound,when[,what the paper says]
 *
 * mesh: a name, or * for every mesh measured; relation: <= >= = ; when: always, or corpus (only where a folder of
 * meshes was given). What the paper says runs to the end of the line; claims that have it stand in the overview at the
 * head of the page. Lines that start with # are comments.
 * Layer: experiments. */
#ifndef SL_EXPERIMENTS_CLAIMS_H
#define SL_EXPERIMENTS_CLAIMS_H

#include "support/page.h"

typedef struct exp_claim {
    char mesh[64], quantity[64], relation[4];
    char says[240]; /* the paper's words, "" = none: a check of our own */
    double bound;
    bool corpus_only;
    int32_t measured, violated; /* measurements it was applied to, and that broke it */
    double worst;               /* the measurement that breaks it most, or comes nearest to */
    char worst_mesh[64];
} exp_claim;

typedef struct exp_claims {
    int32_t count;
    exp_claim *claim;
} exp_claims;

/* Reads the claims. SL_IO, SL_BAD_INPUT with the line, SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status exp_claims_read(const char *path, exp_claims *claims, sl_diag *diag);
void exp_claims_clear(exp_claims *claims);

/* Holds a measurement against every claim about it; false when it breaks one. */
bool exp_claims_measure(exp_claims *claims, const char *mesh, const char *quantity, double value);

/* Whether it is about a time, a quantity of seconds: what was measured differs from run to run. */
bool exp_claim_is_time(const exp_claim *claim);

/* Whether it is broken: applied and violated, or never measured although it applies. */
bool exp_claim_broken(const exp_claim *claim);

/* A table of the claims, broken ones red, also on stderr; returns how many are broken. A claim that applies but was
 * never measured is broken. */
int32_t exp_claims_report(const exp_claims *claims, const exp_run *run, exp_page *page);

/* OUT/claims.csv, and OUT/overview.html: the experiment's rows of the overview. After the report. SL_IO. */
SL_NODISCARD sl_status exp_claims_write(const exp_claims *claims, exp_run *run, const char *folder,
                                        const char *heading);

#endif
