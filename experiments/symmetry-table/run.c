/* The paper's central claim, measured: every planted mirror of every model, what finds it and what cuts it. */
#include "mirror.h"
#include "support/csv.h"
#include "support/failures.h"
#include "support/main.h"

#include <stdio.h>
#include <string.h>

enum { MOST_ROWS = 512, QUICK_FACETS = 4000 };

/* A line of the table. */
typedef struct row {
    const char *model;
    char mirror[32];
    bool exact;
    int32_t facets, components;
    double saved;
    mirror_facts facts;
} row;

typedef struct table {
    int32_t count, skipped;
    row row[MOST_ROWS];
} table;

static const char *yes(bool is)
{
    return is ? "yes" : "no";
}

/* What must hold of a mirror; of the rest only the numbers are shown. */
static void hold_claims(exp_claims *claims, const row *r, bool all_listed)
{
    if (r->exact && all_listed) {
        exp_claims_measure(claims, r->model, "exact mirror found", r->facts.found);
    }
    if (r->facts.index >= 0 && r->facts.fixed == 0) {
        exp_claims_measure(claims, r->model, "seam of the lowest antisymmetric vector is the axis",
                           r->facts.exact_seam);
    }
}

static sl_status measure_model(exp_run *run, const sl_generator *generator, exp_claims *claims, table *t)
{
    sl_status status = SL_OK;
    sl_generated *generated = NULL;
    model m = {0};
    int32_t exact = 0, used = 0;
    SL_TRY(generator->make(1, 1, &generated));
    if (run->quick && generated->nf > QUICK_FACETS) {
        t->skipped++;
        goto cleanup;
    }
    SL_TRY(model_create(generated, &run->context, &m));
    for (int32_t k = 0; k < generated->nplanted && t->count < MOST_ROWS; k++) {
        const sl_planted *planted = &generated->planted[k];
        if (!planted->mirror) {
            continue;
        }
        row *r = &t->row[t->count++];
        *r = (row){.model = generator->name,
                   .exact = planted->exact,
                   .facets = generated->nf,
                   .components = m.components,
                   .saved = m.shared->sharing.area};
        memcpy(r->mirror, planted->name, sizeof r->mirror);
        SL_TRY(mirror_measure(&m, planted, &r->facts));
        hold_claims(claims, r, !m.symmetry->truncated);
        exact += planted->exact;
        used += planted->exact && r->facts.used;
    }
    if (exact > 0) {
        exp_claims_measure(claims, generator->name, "texture memory saved where a mirror is exact",
                           m.shared->sharing.area);
        if (m.components == 1 && !generated->more_mirrors) { /* else another than the planted ones may be */
            exp_claims_measure(claims, generator->name, "a mirror is used where one is exact", used > 0);
        }
    } else {
        exp_claims_measure(claims, generator->name, "mirrors invented", count_exact_mirrors(&m));
    }
    fprintf(stderr, "%s: %d exact mirrors, %d used, %.1f %% saved\n", generator->name, exact, used,
            100.0 * m.shared->sharing.area);
cleanup:
    model_clear(&m);
    sl_generated_free(generated);
    return status;
}

static void show_rows(exp_page *page, const table *t)
{
    exp_page_table_begin(page,
                         "model|facets|mirror|straddling|found|used|memory saved|lowest antisymmetric|among 30|passes|"
                         "seam = axis|longest|length/&radic;&lambda;|lookahead");
    for (int32_t k = 0; k < t->count; k++) {
        const row *r = &t->row[k];
        const bool spectral = r->components == 1;
        exp_page_row_begin(page, r->exact && !r->facts.found);
        exp_page_cell(page, "%s", r->model);
        exp_page_cell(page, "%d", r->facets);
        exp_page_cell(page, "%s%s", r->mirror, r->exact ? "" : " (connectivity only)");
        exp_page_cell(page, "%d", r->facts.fixed);
        exp_page_cell(page, "%s", yes(r->facts.found));
        exp_page_cell(page, "%s", yes(r->facts.used));
        exp_page_cell(page, "%.1f %%", 100.0 * r->saved);
        if (!spectral) {
            exp_page_cell(page, "several components");
        } else if (r->facts.index < 0) {
            exp_page_cell(page, "&gt; %d", VECTORS - 1);
        } else {
            exp_page_cell(page, "%d", r->facts.index);
        }
        exp_page_cell(page, "%s", spectral ? yes(r->facts.among_usual) : "");
        exp_page_cell(page, "%s", spectral && r->facts.index >= 0 ? yes(r->facts.passes) : "");
        if (spectral && r->facts.index >= 0 && r->facts.undecided > 0) {
            exp_page_cell(page, "%s (%d signs undecided)", yes(r->facts.exact_seam), r->facts.undecided);
        } else {
            exp_page_cell(page, "%s", spectral && r->facts.index >= 0 ? yes(r->facts.exact_seam) : "");
        }
        for (int rule = 0; rule < RULES; rule++) {
            exp_page_cell(page, "%s", spectral ? yes(r->facts.chosen[rule]) : "");
        }
        exp_page_row_end(page);
    }
    exp_page_table_end(page);
}

/* The figures that the table comes down to, of exact mirrors of models in one piece. */
static void summarise(exp_page *page, const table *t)
{
    int32_t all = 0, usual = 0, passes = 0, seam = 0, seen = 0, chosen[RULES] = {0};
    for (int32_t k = 0; k < t->count; k++) {
        const mirror_facts *f = &t->row[k].facts;
        if (t->row[k].components == 1 && t->row[k].exact) {
            all++;
            seen += f->index >= 0;
            usual += f->among_usual;
            passes += f->passes;
            seam += f->exact_seam;
            for (int rule = 0; rule < RULES; rule++) {
                chosen[rule] += f->chosen[rule];
            }
        }
    }
    exp_page_html(
        page,
        "<p>%d exact mirrors of models in one piece: for %d the lowest antisymmetric vector is among the first "
        "%d, for %d among 30. Of those %d, %d pass the connectivity filter and %d have exactly the axis as "
        "their seam. The first cut is the axis for %d by the paper's rule (longest seam), %d by length over "
        "&radic;&lambda;, %d by looking ahead. A model of several mirrors can have only one of them cut "
        "first.</p>\n",
        all, seen, VECTORS, usual, seen, passes, seam, chosen[0], chosen[1], chosen[2]);
    if (t->skipped > 0) {
        exp_page_html(page, "<p>%d models of more than %d facets are left out here.</p>\n", t->skipped, QUICK_FACETS);
    }
}

static sl_status write_csv(exp_run *run, const table *t)
{
    sl_status status = SL_OK;
    sl_writer *csv = NULL;
    SL_TRY(
        exp_csv_open(run, "mirrors.csv",
                     "model,facets,mirror,exact,straddling,found,used,saved,index,lambda,among_30,passes,seam_is_axis,"
                     "undecided,longest,length_lambda,lookahead",
                     &csv));
    for (int32_t k = 0; k < t->count; k++) {
        const row *r = &t->row[k];
        const mirror_facts *f = &r->facts;
        sl_writer_format(csv, "%s,%d,%s,%d,%d,%d,%d", r->model, r->facets, r->mirror, r->exact, f->fixed, f->found,
                         f->used);
        exp_csv_numbers(csv, &r->saved, 1);
        sl_writer_format(csv, ",%d", f->index);
        exp_csv_numbers(csv, &f->lambda, 1);
        sl_writer_format(csv, ",%d,%d,%d,%d,%d,%d,%d\n", f->among_usual, f->passes, f->exact_seam, f->undecided,
                         f->chosen[0], f->chosen[1], f->chosen[2]);
    }
    SL_TRY(exp_csv_close(run, &csv));
cleanup:
    sl_writer_abandon(csv);
    return status;
}

static void introduce(exp_page *page)
{
    exp_page_html(page,
                  "<p>\"Our set of spectral seams contains all the axes of symmetry of the mesh\" (Section 4.3). Every "
                  "mirror planted in a generated model: is it <em>found</em> by the search for automorphisms, and "
                  "<em>used</em> (its axis cut, one half taking its UVs from the other)? Which vector of the facet "
                  "graph is the lowest antisymmetric one, is it among the 30 that the method computes, does it pass "
                  "the connectivity filter, is its seam the axis edge for edge, and which rule takes that cut "
                  "first (before any smoothing)?</p>\n");
}

static sl_status measure_all(exp_run *run, exp_page *page, exp_claims *claims)
{
    sl_status status = SL_OK;
    int32_t count = 0;
    const sl_generator *generator = sl_generators(&count);
    table *t = sl_calloc(1, sizeof *t);
    SL_TRY(t != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    introduce(page);
    for (int32_t k = 0; k < count; k++) {
        const int32_t before = t->count;
        status = measure_model(run, &generator[k], claims, t);
        t->count = exp_failed(run, generator[k].name, &status) ? before : t->count;
        SL_TRY(status);
    }
    summarise(page, t);
    show_rows(page, t);
    SL_TRY(write_csv(run, t));
cleanup:
    sl_free(t);
    return status;
}

int main(int argc, char **argv)
{
    return exp_main(argc, argv, "symmetry-table", "Every planted mirror", NULL, EXPECTED_CSV, measure_all);
}
