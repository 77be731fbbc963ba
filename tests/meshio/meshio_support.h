/* Helpers of the tests of meshio: parse a text, expect a failure, compare two files. */
#ifndef SL_TESTS_MESHIO_SUPPORT_H
#define SL_TESTS_MESHIO_SUPPORT_H

#include "base/file.h"
#include "base/memory.h"
#include "meshio/meshfile.h"
#include "support/test_support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A growing text or byte string. */
typedef struct test_bytes {
    char *data;
    int64_t size, capacity;
} test_bytes;

static inline void put_bytes(test_bytes *to, const void *data, int64_t size)
{
    void *memory = to->data;
    assert_int_equal(sl_reserve(&memory, &to->capacity, to->size + size + 1, 1), SL_OK);
    to->data = memory;
    memcpy(to->data + to->size, data, (size_t)size);
    to->size += size;
    to->data[to->size] = '\0';
}

static inline void put_text(test_bytes *to, const char *format, ...) SL_PRINTF(2, 3);

static inline void put_text(test_bytes *to, const char *format, ...)
{
    char text[512];
    va_list args;
    va_start(args, format);
    const int n = vsnprintf(text, sizeof text, format, args);
    va_end(args);
    assert_true(n >= 0 && n < (int)sizeof text);
    put_bytes(to, text, n);
}

static inline sl_meshfile *parse_bytes(const char *name, const void *data, int64_t size)
{
    sl_meshfile *file = NULL;
    sl_diag diag = sl_diag_none();
    if (sl_meshfile_parse(name, data, size, &file, &diag) != SL_OK) {
        char text[800];
        sl_diag_format(&diag, text, sizeof text);
        fail_msg("%s", text);
    }
    return file;
}

static inline sl_meshfile *parse_text(const char *name, const char *text)
{
    return parse_bytes(name, text, (int64_t)strlen(text));
}

/* The text must be refused with this status, at this line (0 = none), with these words in the reason. */
static inline sl_diag expect_failure(const char *name, const void *data, int64_t size, sl_status status, int64_t line,
                                     const char *words)
{
    sl_meshfile *file = (sl_meshfile *)1;
    sl_diag diag;
    memset(&diag, 0x55, sizeof diag); /* what stood in it before must not matter */
    const sl_status got = sl_meshfile_parse(name, data, size, &file, &diag);
    if (got != status || diag.line != line || strstr(diag.reason, words) == NULL || file != NULL) {
        fail_msg("'%.60s...': %s, line %d: '%s' instead of %s, line %d: '%s'", (const char *)data, sl_status_name(got),
                 (int)diag.line, got != SL_OK ? diag.reason : "", sl_status_name(status), (int)line, words);
    }
    assert_string_equal(diag.file, name);
    assert_int_equal(sl_meshfile_parse(name, data, size, &file, NULL), status); /* without a diagnostic, too */
    return diag;
}

static inline void assert_same_polygons(const sl_meshfile *a, const sl_meshfile *b)
{
    assert_int_equal(a->nv, b->nv);
    assert_int_equal(a->nf, b->nf);
    assert_memory_equal(a->face_first, b->face_first, ((size_t)a->nf + 1) * sizeof *a->face_first);
    assert_memory_equal(a->index, b->index, (size_t)a->face_first[a->nf] * sizeof *a->index);
    assert_memory_equal(a->xyz, b->xyz, 3 * (size_t)a->nv * sizeof *a->xyz);
}

/* Equal numbers, or both NaN. */
static inline void assert_same_doubles(const double *a, const double *b, int64_t count)
{
    for (int64_t k = 0; k < count; k++) {
        if (!(a[k] == b[k] || (isnan(a[k]) && isnan(b[k])))) {
            fail_msg("number %d is %.17g, not %.17g", (int)k, a[k], b[k]);
        }
    }
}

/* Writes to a scratch file of this name, and gives back the bytes (sl_free). */
static inline char *write_and_load(const char *name, const sl_meshfile *file, const double *uv, int64_t *size)
{
    char path[512];
    char *data;
    sl_diag diag = sl_diag_none();
    snprintf(path, sizeof path, "%s", test_scratch(name));
    if (sl_meshfile_write(path, file, uv, &diag) != SL_OK) {
        fail_msg("%s", diag.reason);
    }
    assert_int_equal(sl_file_read(path, &data, size, NULL), SL_OK);
    assert_int_equal(remove(path), 0);
    return data;
}

/* UVs for all corners: some missing, many equal (at one vertex, and at different ones), some not quantised. */
static inline double *random_uv(test_rng *rng, const sl_meshfile *file)
{
    const int32_t corners = file->face_first[file->nf];
    double *uv = sl_alloc(2 * (int64_t)corners, sizeof *uv);
    assert_non_null(uv);
    for (int32_t c = 0; c < corners; c++) {
        const int kind = test_index(rng, 8);
        for (int k = 0; k < 2; k++) {
            uv[2 * c + k] = kind == 0   ? (double)NAN
                            : kind <= 3 ? sl_uv_quantise(0.001 * (file->index[c] / 4) + 0.37 * k)
                            : kind <= 6 ? sl_uv_quantise(test_uniform(rng, -0.5, 1.5))
                                        : test_uniform(rng, -1, 1) * pow(10.0, test_index(rng, 50) - 30);
        }
    }
    return uv;
}

#endif
