/* Mirrors and dihedral groups by name, and symmetries of the surface only. */
#include "plant.h"

#include "base/memory.h"
#include "geom/vec3.h"

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

/* Source: Rodrigues 1840: R = cos I + (1 - cos) a a' + sin [a]x. */
sl_status gen_plant_rotation(sl_generated *mesh, const char *name, const double axis[3], double angle, bool exact)
{
    const double norm = sl_vec3_norm(axis), c = cos(angle), s = sin(angle);
    const double a[3] = {axis[0] / norm, axis[1] / norm, axis[2] / norm};
    double matrix[12] = {0.0};
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) {
            matrix[4 * i + k] = (i == k ? c : 0.0) + (1.0 - c) * a[i] * a[k];
        }
        matrix[4 * i + (i + 2) % 3] += s * a[(i + 1) % 3];
        matrix[4 * i + (i + 1) % 3] -= s * a[(i + 2) % 3];
    }
    return gen_plant(mesh, name, matrix, exact);
}

sl_status gen_plant_mirrors(sl_generated *mesh, const char *axes, bool exact)
{
    sl_status status = SL_OK;
    for (; *axes != '\0' && status == SL_OK; axes++) {
        const char name[] = {'m', 'i', 'r', 'r', 'o', 'r', ' ', *axes, '\0'};
        status = gen_plant_mirror(mesh, name, *axes == 'x', *axes == 'y', *axes == 'z', exact);
    }
    return status;
}

sl_status gen_plant_dihedral(sl_generated *mesh, int axis, int32_t n, double angle, bool exact)
{
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const int32_t mirrors = n > gen_most_mirrors ? 2 : n;
    const double line[3] = {axis == 0, axis == 1, axis == 2};
    char turn[32];
    snprintf(turn, sizeof turn, "rotation %c 1/%d", "xyz"[axis], n);
    sl_status status = gen_plant_rotation(mesh, turn, line, 2.0 * pi / n, exact);
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

sl_status gen_plant_prism(sl_generated *mesh, bool exact)
{
    const sl_status status = gen_plant_dihedral(mesh, 2, 4, 0.0, exact);
    return status != SL_OK ? status : gen_plant_mirrors(mesh, "z", exact);
}

sl_status gen_plant_cube(sl_generated *mesh, bool exact)
{
    static const double diagonal[4][3] = {{1.0, 0.0, 1.0}, {1.0, 0.0, -1.0}, {0.0, 1.0, 1.0}, {0.0, 1.0, -1.0}};
    static const char *const name[4] = {"mirror x z", "mirror x -z", "mirror y z", "mirror y -z"};
    sl_status status = gen_plant_prism(mesh, exact);
    for (int k = 0; k < 4 && status == SL_OK; k++) {
        status = gen_plant_mirror(mesh, name[k], diagonal[k][0], diagonal[k][1], diagonal[k][2], exact);
    }
    return status != SL_OK
               ? status
               : gen_plant_rotation(mesh, "rotation xyz 1/3", (double[]){1.0, 1.0, 1.0}, 2.0 * pi / 3.0, exact);
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

void gen_forget(sl_generated *mesh)
{
    for (int32_t k = 0; k < mesh->nplanted; k++) {
        sl_free(mesh->planted[k].vertex);
        sl_free(mesh->planted[k].face);
    }
    mesh->nplanted = 0;
    mesh->more_mirrors = false;
}

sl_status gen_planted(sl_status status, sl_generated **out)
{
    if (status != SL_OK) {
        sl_generated_free(*out);
        *out = NULL;
    }
    return status;
}
