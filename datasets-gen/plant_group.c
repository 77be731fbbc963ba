/* Mirrors and dihedral groups by name, and symmetries of the surface only. */
#include "plant.h"

#include "base/memory.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

sl_status gen_plant_mirror(sl_generated *mesh, const char *name, double a, double b, double c, bool exact)
{
    const double n[3] = {a, b, c}, square = a * a + b * b + c * c;
    double matrix[12] = {0.0};
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) {
            matrix[4 * i + k] = (i == k ? 1.0 : 0.0) - 2.0 * n[i] * n[k] / square;
        }
    }
    return gen_plant(mesh, name, matrix, exact);
}

static sl_status plant_rotation(sl_generated *mesh, int axis, int32_t n, bool exact)
{
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const double c = cos(2.0 * pi / n), s = sin(2.0 * pi / n);
    double matrix[12] = {0.0};
    char name[32];
    snprintf(name, sizeof name, "rotation %c 1/%d", "xyz"[axis], n);
    matrix[5 * axis] = 1.0;
    matrix[5 * u] = matrix[5 * v] = c;
    matrix[4 * u + v] = -s;
    matrix[4 * v + u] = s;
    return gen_plant(mesh, name, matrix, exact);
}

sl_status gen_plant_dihedral(sl_generated *mesh, int axis, int32_t n, double angle, bool exact)
{
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const int32_t mirrors = n > gen_most_mirrors ? 2 : n;
    sl_status status = plant_rotation(mesh, axis, n, exact);
    mesh->more_mirrors |= mirrors < n;
    for (int32_t k = 0; k < mirrors && status == SL_OK; k++) {
        const double here = angle + pi * k / n;
        double normal[3] = {0.0, 0.0, 0.0};
        char name[32];
        normal[u] = -sin(here);
        normal[v] = cos(here);
        snprintf(name, sizeof name, "mirror %c %d of %d", "xyz"[axis], k + 1, n);
        status = gen_plant_mirror(mesh, name, normal[0], normal[1], normal[2], exact);
    }
    return status;
}

sl_status gen_plant_near(sl_generated *mesh, const char *name, const double matrix[12])
{
    sl_near_planted *list = sl_realloc(mesh->near, (int64_t)mesh->nnear + 1, sizeof *list);
    if (list == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    mesh->near = list;
    snprintf(list[mesh->nnear].name, sizeof list->name, "%s", name);
    memcpy(list[mesh->nnear++].matrix, matrix, sizeof list->matrix);
    return SL_OK;
}

sl_status gen_planted(sl_status status, sl_generated **out)
{
    if (status != SL_OK) {
        sl_generated_free(*out);
        *out = NULL;
    }
    return status;
}
