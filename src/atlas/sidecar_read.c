/* Reading a sidecar: which charts are shared. */
#include "atlas/sidecar.h"

#include "base/file.h"
#include "base/memory.h"

#include <jansson.h>
#include <stdio.h>

static sl_status not_a_sidecar(sl_diag *diag, const char *path, const char *why)
{
    sl_diag_reason(diag, "%s: %s", path, why);
    sl_diag_hint(diag, "it should be the sidecar that `seamlab unwrap` wrote beside this very file");
    return SL_BAD_INPUT;
}

/* An integer in [lo, hi), or false. */
static bool integer_in(const json_t *j, json_int_t lo, json_int_t hi, int32_t *out)
{
    if (!json_is_integer(j) || json_integer_value(j) < lo || json_integer_value(j) >= hi) {
        return false;
    }
    *out = (int32_t)json_integer_value(j);
    return true;
}

/* The charts' copy_of; NULL or missing = none. A source must be no copy itself. */
static bool read_charts(const json_t *charts, sl_sharing_table *table)
{
    for (int32_t c = 0; c < table->nchart; c++) {
        const json_t *copy_of = json_object_get(json_array_get(charts, (size_t)c), "copy_of");
        table->copy_of[c] = -1;
        if (copy_of != NULL && !json_is_null(copy_of) && !integer_in(copy_of, 0, table->nchart, &table->copy_of[c])) {
            return false;
        }
    }
    for (int32_t c = 0; c < table->nchart; c++) {
        if (table->copy_of[c] >= 0 && table->copy_of[table->copy_of[c]] >= 0) {
            return false;
        }
    }
    return true;
}

static bool read_facets(const json_t *facets, sl_sharing_table *table)
{
    for (int32_t f = 0; f < table->nf; f++) {
        if (!integer_in(json_array_get(facets, (size_t)f), 0, table->nchart, &table->face_chart[f])) {
            return false;
        }
    }
    return true;
}

static sl_status read_table(const json_t *root, int32_t nf, const char *path, sl_sharing_table *table, sl_diag *diag)
{
    const json_t *charts = json_object_get(root, "charts"), *facets = json_object_get(root, "face_chart");
    if (!json_is_array(charts) || !json_is_array(facets)) {
        return not_a_sidecar(diag, path, "it lists no charts");
    }
    if (json_array_size(facets) != (size_t)nf || json_array_size(charts) > (size_t)nf) {
        return not_a_sidecar(diag, path, "it belongs to a mesh with another number of facets");
    }
    table->nf = nf;
    table->nchart = (int32_t)json_array_size(charts);
    table->face_chart = sl_alloc(nf, sizeof *table->face_chart);
    table->copy_of = sl_alloc(table->nchart, sizeof *table->copy_of);
    if (table->face_chart == NULL || table->copy_of == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    if (!read_charts(charts, table) || !read_facets(facets, table)) {
        return not_a_sidecar(diag, path, "a chart number is out of range");
    }
    return SL_OK;
}

sl_status sl_sidecar_read(const char *path, int32_t nf, sl_sharing_table *table, sl_diag *diag)
{
    char *text = NULL;
    int64_t size = 0;
    json_error_t error;
    json_t *root = NULL;
    sl_status status = SL_OK;
    *table = (sl_sharing_table){0};
    SL_TRY(sl_file_read(path, &text, &size, diag));
    root = json_loadb(text, (size_t)size, 0, &error);
    if (root == NULL) {
        SL_TRY(not_a_sidecar(diag, path, error.text));
    }
    SL_TRY(read_table(root, nf, path, table, diag));
cleanup:
    if (status != SL_OK) {
        sl_sharing_table_clear(table);
    }
    json_decref(root);
    sl_free(text);
    return status;
}
