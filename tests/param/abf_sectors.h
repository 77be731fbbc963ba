/* Sector tables that the tests of ABF++ solve with. */
#ifndef TEST_PARAM_ABF_SECTORS_H
#define TEST_PARAM_ABF_SECTORS_H

#include "param/abf.h"
#include "param/abf_charts.h"
#include "param/abf_internal.h"

/* Default sectors, or: an interior vertex's turn split into two unequal halves, and a border vertex's angle set. */
static inline sl_sector_table make_sectors(const sl_patch *patch, bool constrained)
{
    sl_sector_table table;
    assert_int_equal(sl_sectors_interior(patch, &table), SL_OK);
    if (!constrained) {
        return table;
    }
    const int32_t n = table.view.count, corners = table.first[n];
    int32_t valence = 0, c, border = 0;
    sl_sector_table out = {.first = malloc((size_t)(n + 3) * sizeof *out.first),
                           .corner = malloc((size_t)(corners + 9) * sizeof *out.corner),
                           .theta = malloc((size_t)(n + 2) * sizeof *out.theta)};
    memcpy(out.corner, table.corner, (size_t)corners * sizeof *out.corner);
    out.first[0] = 0;
    out.first[1] = 2; /* the first vertex: two corners share pi, the others pi */
    out.theta[0] = out.theta[1] = TEST_PI;
    for (int32_t s = 1; s < n; s++) {
        out.first[s + 1] = table.first[s];
        out.theta[s + 1] = 2.0 * TEST_PI;
    }
    out.first[n + 1] = corners;
    while (patch->border[border] == 0 || valence < 2 || valence > 8) { /* a border vertex of several triangles */
        border++;
        valence = 0;
        for (c = patch->outgoing[border]; c >= 0 && valence < 9 && patch->border[border] != 0;
             c = sl_corner_rotate(patch, c)) {
            out.corner[corners + valence++] = c;
        }
    }
    out.first[n + 2] = corners + valence;
    out.theta[n + 1] = 0.83 * TEST_PI;
    out.view = (sl_sectors){n + 2, out.first, out.corner, out.theta};
    assert_int_equal(sl_sectors_check(patch, &out.view, NULL), SL_OK);
    sl_sectors_clear(&table);
    return out;
}

#endif
