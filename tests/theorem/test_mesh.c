#include "support/test_support.h"

#include "base/memory.h"
#include "mesh/build.h"
#include "theorem/meshes.h"

#include <math.h>
#include <string.h>

/* A bent sheet of width x height quads over [-1, 1] x [0, 1]; bumps that are even in x, or not. */
static sl_mesh *sheet(int32_t width, int32_t height, double odd, bool missing_corner)
{
    double *xyz = sl_alloc(3 * (int64_t)(width + 1) * (height + 1), sizeof *xyz);
    int32_t *first = sl_alloc((int64_t)width * height + 1, sizeof *first);
    int32_t *index = sl_alloc(4 * (int64_t)width * height, sizeof *index);
    int32_t nv = 0, nf = 0;
    for (int32_t y = 0; y <= height; y++) {
        for (int32_t x = 0; x <= width; x++) {
            const double u = 2.0 * x / width - 1.0, v = (double)y / height;
            xyz[3 * nv] = u;
            xyz[3 * nv + 1] = v + 0.3 * v * v;
            xyz[3 * nv++ + 2] = 0.4 * cos(2.0 * u) * (1.0 + v) + odd * sin(3.0 * u + v);
        }
    }
    first[0] = 0;
    for (int32_t y = 0; y < height; y++) {
        for (int32_t x = 0; x < width; x++) {
            if (missing_corner && x == 0 && y == 0) {
                continue;
            }
            const int32_t at = y * (width + 1) + x;
            const int32_t corner[] = {at, at + 1, at + width + 2, at + width + 1};
            memcpy(index + first[nf], corner, sizeof corner);
            first[nf + 1] = first[nf] + 4;
            nf++;
        }
    }
    const sl_polygons polygons = {nv, nf, xyz, first, index};
    sl_mesh *mesh;
    sl_diag diag = sl_diag_none();
    assert_int_equal(sl_mesh_build(&polygons, &mesh, NULL, &diag), SL_OK);
    sl_free(xyz);
    sl_free(first);
    sl_free(index);
    return mesh;
}

static sl_theorem_mesh *check(const sl_mesh *mesh)
{
    const sl_theorem_def def = sl_theorem_default();
    sl_theorem_mesh *out;
    assert_int_equal(sl_theorem_check_mesh(mesh, NULL, 4, &def, NULL, &out), SL_OK);
    for (int32_t s = 0; s < SL_THEOREM_STATEMENTS; s++) {
        assert_int_equal(out->total.tally[s].violated, 0);
    }
    return out;
}

static const sl_theorem_mirror *exact_mirror(const sl_theorem_mesh *checked)
{
    for (int32_t k = 0; k < checked->count; k++) {
        if (checked->mirror[k].mirror && checked->mirror[k].kind == SL_SYMMETRY_EXACT) {
            return &checked->mirror[k];
        }
    }
    return NULL;
}

/* Mirror x -> -x through edges (even width) and through facets (odd width); whole spectra, and lowest pairs only. */
static void the_mirror_of_a_sheet_is_found_and_its_statements_hold(void **state)
{
    (void)state;
    const int32_t size[][2] = {{8, 5}, {9, 5}, {26, 21}, {27, 21}};
    for (size_t k = 0; k < SL_COUNTOF(size); k++) {
        sl_mesh *mesh = sheet(size[k][0], size[k][1], 0.0, false);
        sl_theorem_mesh *checked = check(mesh);
        assert_true(checked->count >= 1);
        const sl_theorem_mirror *mirror = exact_mirror(checked);
        assert_non_null(mirror);
        const sl_theorem_tally *t = mirror->result.tally;
        assert_int_equal(mirror->facets, mesh->nf);
        assert_int_equal(t[SL_THEOREM_SPECTRA].holds, 1);
        assert_int_equal(t[SL_THEOREM_BASIS].holds, 1);
        assert_int_equal(t[SL_THEOREM_HALF].holds, 1);
        assert_int_equal(t[SL_THEOREM_WHOLE].holds, 1);
        assert_int_equal(t[SL_THEOREM_FIXED].holds, size[k][0] % 2); /* facets straddle an odd one */
        assert_int_equal(t[SL_THEOREM_AXIS].holds + t[SL_THEOREM_AXIS].undecided, 1 - size[k][0] % 2);
        assert_true(mirror->result.lowest_index == 1);
        assert_true(mirror->partner >= 0 && mirror->commute); /* the sheet's connectivity has a second mirror */
        sl_theorem_mesh_free(checked);
        sl_mesh_free(mesh);
    }
}

static void a_mesh_without_a_mirror_has_nothing_to_check(void **state)
{
    (void)state;
    sl_mesh *mesh = sheet(7, 5, 0.2, true);
    sl_theorem_mesh *checked = check(mesh);
    assert_int_equal(checked->count, 0);
    assert_int_equal(checked->total.graphs, 0);
    sl_theorem_mesh_free(checked);
    sl_mesh_free(mesh);
    sl_theorem_mesh_free(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_mirror_of_a_sheet_is_found_and_its_statements_hold),
        cmocka_unit_test(a_mesh_without_a_mirror_has_nothing_to_check),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
