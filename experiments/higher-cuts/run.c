/* Higher eigenvectors: redundant, decorrelated, principal directions (Sec. 3.2 and 3.3). */
#include "higher.h"
#include "support/csv.h"
#include "support/failures.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_FACETS = 20000, MOST_FACETS_QUICK = 3000 };

/* Means over the vectors of one model, of those that pass and those that do not. */
typedef struct row {
    char name[64];
    int32_t facets, vectors, passing, disks;
    double function[2], along[2], chance[2]; /* [0] filtered out, [1] passing (without the first) */
    double cosine, disk_median;
} row;

/* Everything about single vectors: a line each, and means by number. */
typedef struct vectors {
    sl_writer *csv;
    double sum[2][HIGHER_VECTORS];
    int32_t count[2][HIGHER_VECTORS];
} vectors;

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *value, int32_t count)
{
    qsort(value, (size_t)count, sizeof *value, ascending);
    return count > 0 ? 0.5 * (value[(count - 1) / 2] + value[count / 2]) : NAN;
}

/* The first vector has none below it and is left out of the means. */
static void summarise(const higher_vector *vector, int32_t count, row *r)
{
    int32_t number[2] = {0, 0};
    r->vectors = count;
    for (int32_t k = 0; k < count; k++) {
        r->passing += vector[k].passes;
        r->cosine = fmax(r->cosine, vector[k].cosine);
        if (k > 0) {
            const int side = vector[k].passes;
            number[side]++;
            r->function[side] += vector[k].function;
            r->along[side] += vector[k].along;
            r->chance[side] += vector[k].chance;
        }
    }
    for (int side = 0; side < 2; side++) {
        r->function[side] /= number[side];
        r->along[side] /= number[side];
        r->chance[side] /= number[side];
    }
}

static void write_vectors(vectors *out, const char *name, const exp_spectrum *s, const higher_vector *vector)
{
    for (int32_t k = 1; k < s->spectrum->count; k++) {
        const higher_vector *v = &vector[k - 1];
        out->sum[v->passes][k] += v->function;
        out->count[v->passes][k]++;
        sl_writer_format(out->csv, "%s,%d,%d", name, k, v->passes);
        exp_csv_numbers(out->csv, &v->function, 1);
        sl_writer_format(out->csv, ",%d", v->of);
        exp_csv_numbers(out->csv, (const double[]){v->along, v->chance}, 2);
        sl_writer_text(out->csv, "\n");
    }
}

static sl_status measure_model(exp_run *run, vectors *out, const exp_source *source, const sl_polygons *polygons,
                               row *r)
{
    sl_status status = SL_OK;
    exp_spectrum s = {0};
    higher_vector vector[HIGHER_VECTORS];
    double share[HIGHER_DISKS];
    snprintf(r->name, sizeof r->name, "%s", source->name);
    SL_TRY(exp_spectrum_make(run, polygons, HIGHER_VECTORS, &s));
    SL_TRY(higher_measure(&s, vector));
    SL_TRY(higher_disks(run, &s, 1, share, &r->disks));
    r->facets = s.face_count;
    r->disk_median = median(share, r->disks);
    summarise(vector, s.spectrum->count - 1, r);
    write_vectors(out, source->name, &s, vector);
cleanup:
    exp_spectrum_clear(&s);
    return status;
}

static void cell(exp_page *page, double value)
{
    if (isnan(value)) {
        exp_page_cell(page, "-");
    } else {
        exp_page_cell(page, "%.2f", value);
    }
}

static void table(exp_page *page, const row *r, int32_t count)
{
    exp_page_table_begin(page,
                         "model|facets|pass|function of a lower one: filtered out|passing|seam along lower seams: "
                         "filtered out|by chance|passing|by chance|flat coordinates explained on disks|disks");
    for (int32_t k = 0; k < count; k++) {
        exp_page_row_begin(page, false);
        exp_page_cell(page, "%s", r[k].name);
        exp_page_cell(page, "%d", r[k].facets);
        exp_page_cell(page, "%d of %d", r[k].passing, r[k].vectors);
        cell(page, r[k].function[0]);
        cell(page, r[k].function[1]);
        cell(page, r[k].along[0]);
        cell(page, r[k].chance[0]);
        cell(page, r[k].along[1]);
        cell(page, r[k].chance[1]);
        cell(page, r[k].disk_median);
        exp_page_cell(page, "%d", r[k].disks);
        exp_page_row_end(page);
    }
    exp_page_table_end(page);
}

static void introduce(exp_page *page)
{
    exp_page_html(page, "<p>The paper says of the eigenvectors that the filter drops: \"They are redundant with "
                        "eigenvectors with lower eigenvalues. More precisely, they correspond to oscillations in a "
                        "direction that was already found. In contrast, if F<sup>+</sup> and F<sup>-</sup> are "
                        "connected, the eigenvector corresponds to a new direction, independent of the previous "
                        "ones.\" Two measures. An oscillation along a direction found already is a function of the "
                        "vector that found it: the share of its variance that is a function of one lower vector "
                        "(correlation ratio over 32 groups). And the share of its seam that lies along seams of lower "
                        "vectors that pass, beside the share of all edges that does.</p>\n");
    exp_page_html(page, "<p>\"Can be seen as curvilinear principal directions\": on geodesic disks, which Jones et al. "
                        "2007 speak of, the first two vectors that pass should be coordinates. Over the inner half "
                        "of each disk: the smaller share of the two flat coordinates' variance that they explain "
                        "linearly, median over disks about facets drawn by a seed.</p>\n");
}

static void conclude(exp_page *page, exp_claims *claims, const row *r, int32_t count)
{
    double *difference = sl_alloc(count, sizeof *difference), *disk = sl_alloc(count, sizeof *disk);
    int32_t n = 0, m = 0;
    for (int32_t k = 0; difference != NULL && disk != NULL && k < count; k++) {
        exp_claims_measure(claims, r[k].name, "largest cosine with a lower vector", r[k].cosine);
        if (!isnan(r[k].function[0]) && !isnan(r[k].function[1])) {
            difference[n++] = r[k].function[0] - r[k].function[1];
        }
        if (!isnan(r[k].disk_median)) {
            disk[m++] = r[k].disk_median;
        }
    }
    if (difference != NULL && disk != NULL) {
        int32_t more = 0;
        for (int32_t k = 0; k < n; k++) {
            more += difference[k] > 0.0;
        }
        const double middle = median(difference, n), directions = median(disk, m);
        exp_page_html(page,
                      "<p>Over the models, vectors that are filtered out are a function of a lower one to a share that "
                      "is larger by %.2f (median) than that of those that pass; larger on %d of %d models. On disks "
                      "the two directions explain %.2f of the flat coordinates (median over %d models).</p>\n",
                      middle, more, n, directions, m);
        exp_claims_measure(claims, "median", "filtered out minus passing: function of a lower vector", middle);
        exp_claims_measure(claims, "median", "flat coordinates explained on disks", directions);
    }
    sl_free(difference);
    sl_free(disk);
}

static sl_status measure_all(exp_run *run, vectors *out, const exp_source *source, int32_t sources, row *r,
                             int32_t *count)
{
    sl_status status = SL_OK;
    const int32_t most = run->quick ? MOST_FACETS_QUICK : MOST_FACETS;
    for (int32_t k = 0; k < sources && status == SL_OK; k++) {
        exp_mesh mesh;
        bool measured = false;
        status = exp_mesh_load(&source[k], &mesh, &run->diag);
        if (status == SL_OK && mesh.polygons.nf >= 1000 && mesh.polygons.nf <= most) {
            status = measure_model(run, out, &source[k], &mesh.polygons, &r[*count]);
            measured = status == SL_OK;
        }
        *count += measured;
        exp_failed(run, source[k].name, &status);
        exp_mesh_clear(&mesh);
    }
    return status;
}

static sl_status write_means(exp_run *run, const vectors *v)
{
    sl_status status = SL_OK;
    sl_writer *csv = NULL;
    SL_TRY(exp_csv_open(run, "means.csv", "vector,passes,models,function", &csv));
    for (int side = 0; side < 2; side++) {
        for (int32_t k = 2; k < HIGHER_VECTORS; k++) {
            if (v->count[side][k] > 0) {
                const double mean = v->sum[side][k] / v->count[side][k];
                sl_writer_format(csv, "%d,%d,%d", k, side, v->count[side][k]);
                exp_csv_numbers(csv, &mean, 1);
                sl_writer_text(csv, "\n");
            }
        }
        sl_writer_text(csv, "\n\n");
    }
    SL_TRY(exp_csv_close(run, &csv));
cleanup:
    sl_writer_abandon(csv);
    return status;
}

static sl_status show_all(exp_run *run, exp_page *page, exp_claims *claims)
{
    sl_status status = SL_OK;
    vectors out = {0};
    exp_source *source = sl_alloc(EXP_MAX_MESHES, sizeof *source);
    row *r = sl_calloc(EXP_MAX_MESHES, sizeof *r);
    int32_t count = 0;
    if (source == NULL || r == NULL) {
        SL_TRY(SL_OUT_OF_MEMORY);
    }
    SL_TRY(exp_csv_open(run, "vectors.csv", "mesh,vector,passes,function,of,along,chance", &out.csv));
    SL_TRY(measure_all(run, &out, source, exp_list_sources(run, source), r, &count));
    introduce(page);
    conclude(page, claims, r, count);
    exp_page_html(page, "<div class=\"plot\">\n");
    exp_page_figure(page, "", "vectors.svg", "share of each vector that is a function of a lower one",
                    "Each dot a vector of a model; lines: means of those that pass (green) and those filtered out.");
    exp_page_html(page, "</div>\n");
    table(page, r, count);
    SL_TRY(write_means(run, &out));
    SL_TRY(exp_csv_close(run, &out.csv));
cleanup:
    sl_writer_abandon(out.csv);
    sl_free(source);
    sl_free(r);
    return status;
}

int main(int argc, char **argv)
{
    return exp_main(argc, argv, "higher-cuts", "Higher eigenvectors: redundant, or new directions?", NULL, EXPECTED_CSV,
                    show_all);
}
