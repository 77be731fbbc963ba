#include "base/text.h"
#include "meshio/meshfile_internal.h"

#include <math.h>
#include <string.h>

static const double quantum_inverse = 1e12;
static const int quantum_places = 12;

double sl_uv_quantise(double u)
{
    return rint(u * quantum_inverse) / quantum_inverse;
}

void uv_write_number(sl_writer *writer, double u)
{
    const double scaled = rint(u * quantum_inverse);
    /* m / 10^12 with m < 2^53 is one rounded division, which is what reading the decimal does: the same double */
    if (!(fabs(scaled) < 0x1p53 && scaled / quantum_inverse == u)) {
        sl_writer_double(writer, u);
        return;
    }
    char text[24];
    char *p = text + sizeof text;
    uint64_t m = (uint64_t)fabs(scaled);
    int places = quantum_places;
    while (places > 0 && m % 10 == 0) {
        m /= 10;
        places--;
    }
    for (int k = 0; m > 0 || k <= places; k++) {
        if (k == places && places > 0) {
            *--p = '.';
        }
        *--p = (char)('0' + m % 10);
        m /= 10;
    }
    if (u < 0) {
        *--p = '-';
    }
    sl_writer_bytes(writer, p, text + sizeof text - p);
}

static uint64_t mix(uint64_t h, double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    h = (h ^ bits) * 0x9e3779b97f4a7c15u;
    return h ^ (h >> 29);
}

/* u + 0.0 turns -0 into 0, so that equal numbers have equal bits. */
static uint64_t hash_corner(const sl_meshfile *file, const double *uv, int32_t c)
{
    const uint64_t h = mix(mix((uint64_t)file->index[c] + 1, uv[2 * (int64_t)c] + 0.0), uv[2 * (int64_t)c + 1] + 0.0);
    return h ^ (h >> 32);
}

static bool same_texture_vertex(const sl_meshfile *file, const double *uv, int64_t a, int64_t b)
{
    return file->index[a] == file->index[b] && uv[2 * a] == uv[2 * b] && uv[2 * a + 1] == uv[2 * b + 1];
}

sl_status uv_table_create(const sl_meshfile *file, const double *uv, uv_table *out)
{
    sl_status status = SL_OUT_OF_MEMORY;
    const int32_t corners = file->face_first[file->nf];
    int64_t slots = 16;
    while (slots < 2 * (int64_t)corners) {
        slots *= 2;
    }
    int32_t *slot = sl_alloc(slots, sizeof *slot); /* texture vertex in a slot, -1 = free; linear probing */
    *out = (uv_table){0, sl_alloc(corners, sizeof *out->corner_uv), sl_alloc(corners, sizeof *out->first)};
    if (slot == NULL || out->corner_uv == NULL || out->first == NULL) {
        goto cleanup;
    }
    memset(slot, 0xff, (size_t)slots * sizeof *slot);
    for (int32_t c = 0; c < corners; c++) {
        out->corner_uv[c] = -1;
        if (isnan(uv[2 * (int64_t)c]) || isnan(uv[2 * (int64_t)c + 1])) {
            continue;
        }
        int64_t k = (int64_t)(hash_corner(file, uv, c) & (uint64_t)(slots - 1));
        while (slot[k] >= 0 && !same_texture_vertex(file, uv, out->first[slot[k]], c)) {
            k = (k + 1) & (slots - 1);
        }
        if (slot[k] < 0) {
            slot[k] = out->count;
            out->first[out->count++] = c;
        }
        out->corner_uv[c] = slot[k];
    }
    status = SL_OK;
cleanup:
    sl_free(slot);
    if (status != SL_OK) {
        uv_table_clear(out);
    }
    return status;
}

void uv_table_clear(uv_table *table)
{
    sl_free(table->corner_uv);
    sl_free(table->first);
    *table = (uv_table){0};
}
