#include "figure.h"

#include "sculpt.h"

static const double side_x[3] = {1.0, 0.0, 0.0}, side_y[3] = {0.0, 1.0, 0.0};

/* The half x >= 0 of a turtle, its head to +z: a flat body, head, tail, two flippers. */
static void model_turtle(gen_cage *cage)
{
    static const double x[2] = {0.0, 1.5}, y[2] = {-0.5, 0.8}, z[3] = {-1.5, 0.0, 1.5};
    static const gen_station head[] = {
        {{0.0, 0.15, 2.0}, 0.55, 0.45}, {{0.0, 0.30, 2.8}, 0.62, 0.55}, {{0.0, 0.25, 3.6}, 0.36, 0.32}};
    static const gen_station tail[] = {{{0.0, -0.05, -2.1}, 0.50, 0.30}, {{0.0, -0.15, -2.9}, 0.16, 0.12}};
    static const gen_station arm[] = {
        {{2.2, 0.10, 1.30}, 0.55, 0.20}, {{3.1, 0.15, 1.35}, 0.72, 0.17}, {{4.1, 0.05, 0.75}, 0.45, 0.12}};
    static const gen_station leg[] = {{{2.0, 0.0, -1.40}, 0.45, 0.20}, {{2.7, 0.0, -2.10}, 0.50, 0.15}};
    gen_cage_box(cage, (const int32_t[]){1, 1, 2}, (const double *const[]){x, y, z});
    gen_grow(cage, (const double[][3]){{0.75, 0.15, 1.5}}, 1, side_x, head, (int32_t)SL_COUNTOF(head));
    gen_grow(cage, (const double[][3]){{0.75, 0.15, -1.5}}, 1, side_x, tail, (int32_t)SL_COUNTOF(tail));
    gen_grow(cage, (const double[][3]){{1.5, 0.15, 0.75}}, 1, side_y, arm, (int32_t)SL_COUNTOF(arm));
    gen_grow(cage, (const double[][3]){{1.5, 0.15, -0.75}}, 1, side_y, leg, (int32_t)SL_COUNTOF(leg));
}

sl_status figure_mesh(sl_mesh **mesh, sl_diag *diag)
{
    gen_cage cage = {.mirrored = true};
    sl_generated *generated = NULL;
    sl_polygons polygons;
    model_turtle(&cage);
    sl_status status = gen_finish_mirrored(&cage, 1, &generated);
    if (status == SL_OK) {
        sl_generated_polygons(generated, &polygons);
        status = sl_mesh_build(&polygons, mesh, NULL, diag);
    }
    sl_generated_free(generated);
    return status;
}
