#include "grid.h"

#include "base/memory.h"
#include "locate.h"
#include "plant.h"

#include <string.h>

const double gen_weld_tolerance = 1e-9;

int32_t gen_refined(int32_t base, int32_t scale)
{
    int64_t n = base;
    for (int32_t k = 1; k < scale && n < 100000; k++) {
        n *= 2;
    }
    return (int32_t)n;
}

void gen_grid(gen_builder *b, int32_t m, int32_t n, gen_surface_fn *at, const void *data)
{
    const int32_t first = (int32_t)b->nv;
    for (int32_t i = 0; i <= m && !b->failed; i++) {
        for (int32_t j = 0; j <= n; j++) {
            double p[3];
            at(data, (double)i / m, (double)j / n, p);
            gen_vertex(b, p[0], p[1], p[2]);
        }
    }
    for (int32_t i = 0; i < m && !b->failed; i++) {
        for (int32_t j = 0; j < n; j++) {
            const int32_t a = first + i * (n + 1) + j, c = a + n + 1;
            gen_quad(b, a, c, c + 1, a + 1);
        }
    }
}

/* Facets again, over the vertices' new numbers. Returns the facets left. */
static int64_t renumber(gen_builder *b, const int32_t *number)
{
    int64_t facets = 0, corners = 0;
    for (int64_t f = 0; f < b->nf; f++) {
        const int32_t begin = b->first[f], end = b->first[f + 1];
        const int64_t start = corners;
        for (int32_t c = begin; c < end; c++) {
            const int32_t v = number[b->index[c]];
            if (corners == start || b->index[corners - 1] != v) {
                b->index[corners++] = v;
            }
        }
        while (corners > start + 1 && b->index[corners - 1] == b->index[start]) {
            corners--;
        }
        if (corners - start < 3) {
            corners = start;
        } else {
            b->first[facets++] = (int32_t)start; /* never past first[f], whose value is read already */
        }
    }
    b->first[facets] = (int32_t)corners;
    b->nc = corners;
    return facets;
}

/* Keeps the vertices that facets use. */
static sl_status drop_unused(gen_builder *b)
{
    int32_t *number = sl_calloc(b->nv, sizeof *number);
    int32_t kept = 0;
    if (number == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int64_t c = 0; c < b->nc; c++) {
        number[b->index[c]] = 1;
    }
    for (int32_t v = 0; v < b->nv; v++) {
        if (number[v] != 0) {
            memmove(b->xyz + 3 * (int64_t)kept, b->xyz + 3 * (int64_t)v, 3 * sizeof *b->xyz);
            number[v] = kept++;
        }
    }
    for (int64_t c = 0; c < b->nc; c++) {
        b->index[c] = number[b->index[c]];
    }
    b->nv = kept;
    sl_free(number);
    return SL_OK;
}

void gen_weld(gen_builder *b, double tolerance)
{
    gen_locator locator = {0};
    int32_t *number = NULL;
    sl_status status = SL_OK;
    if (b->failed || b->nf == 0) {
        return;
    }
    number = sl_alloc(b->nv, sizeof *number);
    SL_TRY(number == NULL ? SL_OUT_OF_MEMORY : SL_OK);
    SL_TRY(gen_locator_init(&locator, b->xyz, (int32_t)b->nv, tolerance));
    for (int32_t v = 0; v < b->nv; v++) {
        number[v] = gen_locate(&locator, b->xyz + 3 * (int64_t)v);
    }
    b->nf = renumber(b, number);
    SL_TRY(drop_unused(b));
cleanup:
    b->failed |= status != SL_OK;
    gen_locator_clear(&locator);
    sl_free(number);
}

void gen_append(gen_builder *b, const sl_generated *mesh, const double matrix[12])
{
    const int32_t first = (int32_t)b->nv;
    const bool reversed = gen_determinant(matrix) < 0.0;
    for (int64_t v = 0; v < mesh->nv && !b->failed; v++) {
        const double *p = mesh->xyz + 3 * v;
        double q[3];
        for (int k = 0; k < 3; k++) {
            const double *row = matrix + 4 * k;
            q[k] = row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3];
        }
        gen_vertex(b, q[0], q[1], q[2]);
    }
    for (int32_t f = 0; f < mesh->nf && !b->failed; f++) {
        const int32_t begin = mesh->face_first[f], degree = mesh->face_first[f + 1] - begin;
        const int64_t corner = b->nc;
        gen_facet(b, degree, mesh->index + begin);
        for (int32_t k = 0; k < degree && !b->failed; k++) {
            b->index[corner + k] = first + mesh->index[begin + (reversed ? degree - 1 - k : k)];
        }
    }
}
