/* The Schur complement of ABF++: pattern and scatter positions once, values at every Newton step. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "param/abf_internal.h"

/* Triangles that take part in a row, by row: the transpose of the system's (first, row). */
typedef struct incidence {
    int64_t *first;    /* nrows + 1 */
    int32_t *triangle; /* first[nrows] */
    int64_t *fill;     /* nrows: scratch */
    int32_t *last;     /* nrows: scratch */
} incidence;

/* Is row s among the dropped ones? *next: how many of these came before it. */
static bool skips_row(const sl_abf_system *system, int32_t s, int32_t *next)
{
    const bool skips = *next < system->ndropped && system->dropped[*next] == s;
    *next += skips;
    return skips;
}

/* Most entries a triangle can have: one per sector corner and one per interior vertex. */
static void count_entries(sl_abf_system *system)
{
    const sl_patch *patch = system->patch;
    int32_t next = 0;
    memset(system->first, 0, ((size_t)patch->nt + 1) * sizeof *system->first);
    for (int32_t s = 0; s < system->nsectors; s++) {
        if (skips_row(system, s, &next)) {
            continue;
        }
        for (int32_t p = system->sectors->first[s]; p < system->sectors->first[s + 1]; p++) {
            system->first[system->sectors->corner[p] / 3 + 1]++;
        }
    }
    for (int32_t t = 0; t < patch->nt; t++) {
        for (int k = 0; k < 3; k++) {
            system->first[t + 1] += system->wheel_row[patch->tri[3 * (int64_t)t + k]] >= 0;
        }
        system->first[t + 1] += system->first[t];
    }
}

/* The entry of a row in triangle t, appended when it is new; *used counts the triangle's entries. */
static int64_t find_or_add(sl_abf_system *system, int32_t t, int32_t row, int64_t *used)
{
    int64_t p = system->first[t];
    const int64_t end = p + *used;
    while (p < end && system->row[p] != row) {
        p++;
    }
    if (p == end) {
        system->row[p] = row;
        (*used)++;
    }
    return p;
}

static void fill_entries(sl_abf_system *system, int64_t *used)
{
    const sl_patch *patch = system->patch;
    int32_t next = 0;
    for (int32_t s = 0; s < system->nsectors; s++) {
        if (skips_row(system, s, &next)) {
            continue;
        }
        for (int32_t p = system->sectors->first[s]; p < system->sectors->first[s + 1]; p++) {
            const int32_t c = system->sectors->corner[p];
            system->coeff[3 * find_or_add(system, c / 3, s, &used[c / 3]) + c % 3] += 1.0;
        }
    }
    for (int32_t t = 0; t < patch->nt; t++) {
        for (int64_t c = 3 * (int64_t)t; c < 3 * (int64_t)t + 3; c++) {
            const int32_t row = system->wheel_row[patch->tri[c]];
            system->wheel_entry[c] = row < 0 ? -1 : find_or_add(system, t, row, &used[t]) - system->first[t];
        }
    }
}

/* Closes the gaps left where two corners of a triangle share a row. */
static void compact_entries(sl_abf_system *system, const int64_t *used)
{
    int64_t to = 0;
    for (int32_t t = 0; t < system->patch->nt; t++) {
        const int64_t from = system->first[t];
        memmove(&system->row[to], &system->row[from], (size_t)used[t] * sizeof *system->row);
        memmove(&system->coeff[3 * to], &system->coeff[3 * from], 3 * (size_t)used[t] * sizeof *system->coeff);
        for (int64_t c = 3 * (int64_t)t; c < 3 * (int64_t)t + 3; c++) {
            system->wheel_entry[c] += system->wheel_entry[c] < 0 ? 0 : to;
        }
        system->first[t] = to;
        system->slot_first[t + 1] = system->slot_first[t] + used[t] * (used[t] + 1) / 2;
        to += used[t];
    }
    system->first[system->patch->nt] = to;
}

static sl_status build_rows(sl_abf_system *system)
{
    sl_status status = SL_OUT_OF_MEMORY;
    const int32_t nt = system->patch->nt;
    system->first = sl_alloc((int64_t)nt + 1, sizeof *system->first);
    system->slot_first = sl_calloc((int64_t)nt + 1, sizeof *system->slot_first);
    system->wheel_entry = sl_alloc(3 * (int64_t)nt, sizeof *system->wheel_entry);
    int64_t *used = sl_calloc(nt, sizeof *used);
    if (system->first == NULL || system->slot_first == NULL || system->wheel_entry == NULL || used == NULL) {
        goto cleanup;
    }
    count_entries(system);
    system->row = sl_alloc(system->first[nt], sizeof *system->row);
    system->coeff = sl_calloc(3 * system->first[nt], sizeof *system->coeff);
    if (system->row == NULL || system->coeff == NULL) {
        goto cleanup;
    }
    fill_entries(system, used);
    compact_entries(system, used);
    status = SL_OK;
cleanup:
    sl_free(used);
    return status;
}

static sl_status number_wheels(sl_abf_system *system)
{
    const sl_patch *patch = system->patch;
    system->wheel_row = sl_alloc(patch->nv, sizeof *system->wheel_row);
    if (system->wheel_row == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    int64_t row = system->nsectors;
    for (int32_t v = 0; v < patch->nv; v++) {
        system->wheel_row[v] = patch->border[v] == 0 ? (int32_t)row : -1;
        row += patch->border[v] == 0;
        if (row > INT32_MAX) {
            return SL_OUT_OF_MEMORY;
        }
    }
    system->nrows = (int32_t)row;
    system->wheel_scale = sl_alloc(2 * (row - system->nsectors), sizeof *system->wheel_scale);
    system->sine = sl_calloc(3 * (int64_t)patch->nt, sizeof *system->sine);
    system->cot = sl_calloc(3 * (int64_t)patch->nt, sizeof *system->cot);
    const bool failed = system->wheel_scale == NULL || system->sine == NULL || system->cot == NULL;
    return failed ? SL_OUT_OF_MEMORY : SL_OK;
}

static void incidence_clear(incidence *inc)
{
    sl_free(inc->first);
    sl_free(inc->triangle);
    sl_free(inc->fill);
    sl_free(inc->last);
}

static sl_status incidence_init(incidence *inc, const sl_abf_system *system)
{
    const int32_t nt = system->patch->nt, n = system->nrows;
    inc->first = sl_calloc((int64_t)n + 1, sizeof *inc->first);
    inc->triangle = sl_alloc(system->first[nt], sizeof *inc->triangle);
    inc->fill = sl_calloc(n, sizeof *inc->fill);
    inc->last = sl_alloc(n, sizeof *inc->last);
    if (inc->first == NULL || inc->triangle == NULL || inc->fill == NULL || inc->last == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int64_t p = 0; p < system->first[nt]; p++) {
        inc->first[system->row[p] + 1]++;
    }
    for (int32_t r = 0; r < n; r++) {
        inc->first[r + 1] += inc->first[r];
        inc->fill[r] = inc->first[r];
    }
    for (int32_t t = 0; t < nt; t++) {
        for (int64_t p = system->first[t]; p < system->first[t + 1]; p++) {
            inc->triangle[inc->fill[system->row[p]]++] = t;
        }
    }
    return SL_OK;
}

/* The entry (r, q) of M's pattern, appended to column q when it is new. */
static int64_t visit_entry(incidence *inc, int32_t r, int32_t q, int32_t *row_out)
{
    if (inc->last[q] != r) {
        inc->last[q] = r;
        if (row_out != NULL) {
            row_out[inc->fill[q]] = r;
        }
        inc->fill[q]++;
    }
    return inc->fill[q] - 1;
}

/* Row r of M: the columns q <= r it shares triangle t with. */
static void visit_triangle(sl_abf_system *system, incidence *inc, int32_t t, int32_t r, int32_t *row_out)
{
    const int32_t *row = &system->row[system->first[t]];
    const int64_t m = system->first[t + 1] - system->first[t];
    int64_t i = 0;
    while (row[i] != r) {
        i++;
    }
    for (int64_t j = 0; j < m; j++) {
        if (row[j] > r) {
            continue;
        }
        const int64_t entry = visit_entry(inc, r, row[j], row_out);
        if (row_out != NULL) {
            const int64_t hi = i > j ? i : j, lo = i > j ? j : i;
            system->slot[system->slot_first[t] + hi * (hi + 1) / 2 + lo] = entry;
        }
    }
}

/* Visits the rows r of M in ascending order and the columns q <= r they share a triangle with: so every column of the
 * lower triangle is met with ascending rows and needs no sorting. fill[q] counts column q's entries (from start[q]);
 * with slots wanted, each pair of a triangle is told its position. A dropped row has its diagonal alone. */
static void visit_pattern(sl_abf_system *system, incidence *inc, const int64_t *start, int32_t *row_out)
{
    for (int32_t r = 0; r < system->nrows; r++) {
        inc->fill[r] = start != NULL ? start[r] : 0;
        inc->last[r] = -1;
    }
    for (int32_t r = 0; r < system->nrows; r++) {
        if (inc->first[r] == inc->first[r + 1]) {
            visit_entry(inc, r, r, row_out);
        }
        for (int64_t e = inc->first[r]; e < inc->first[r + 1]; e++) {
            visit_triangle(system, inc, inc->triangle[e], r, row_out);
        }
    }
}

static sl_status build_pattern(sl_abf_system *system)
{
    sl_status status = SL_OK;
    incidence inc = {0};
    const int32_t n = system->nrows;
    SL_TRY(incidence_init(&inc, system));
    system->slot = sl_alloc(system->slot_first[system->patch->nt], sizeof *system->slot);
    if (system->slot == NULL) {
        status = SL_OUT_OF_MEMORY;
        goto cleanup;
    }
    visit_pattern(system, &inc, NULL, NULL);
    int64_t nnz = 0;
    for (int32_t q = 0; q < n; q++) {
        nnz += inc.fill[q];
    }
    SL_TRY(sl_csc_create(n, n, nnz, &system->M));
    system->M->colptr[0] = 0;
    for (int32_t q = 0; q < n; q++) {
        system->M->colptr[q + 1] = system->M->colptr[q] + inc.fill[q];
    }
    visit_pattern(system, &inc, system->M->colptr, system->M->row);
cleanup:
    incidence_clear(&inc);
    return status;
}

sl_status sl_abf_system_init(sl_abf_system *system, const sl_patch *patch, const sl_sectors *sectors, int32_t ndropped,
                             const int32_t *dropped)
{
    sl_status status = SL_OK;
    *system = (sl_abf_system){.patch = patch, .sectors = sectors, .nsectors = sectors->count, .ndropped = ndropped};
    SL_TRY(sl_sectors_check(patch, sectors, NULL));
    system->dropped = sl_copy(dropped, ndropped, sizeof *dropped);
    SL_TRY(system->dropped != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    SL_TRY(number_wheels(system));
    SL_TRY(build_rows(system));
    SL_TRY(build_pattern(system));
cleanup:
    if (status != SL_OK) {
        sl_abf_system_clear(system);
    }
    return status;
}

void sl_abf_system_clear(sl_abf_system *system)
{
    sl_free(system->wheel_row);
    sl_free(system->first);
    sl_free(system->row);
    sl_free(system->coeff);
    sl_free(system->wheel_entry);
    sl_free(system->slot_first);
    sl_free(system->slot);
    sl_free(system->wheel_scale);
    sl_free(system->sine);
    sl_free(system->cot);
    sl_free(system->dropped);
    sl_csc_free(system->M);
    *system = (sl_abf_system){0};
}
