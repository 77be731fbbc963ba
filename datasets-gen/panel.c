#include "panel.h"

#include "geom/vec3.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

typedef struct panel_part {
    const gen_panel *panel;
    bool far_face;
} panel_part;

/* Around the square from its corner (-1, -1), counterclockwise, t in [0, 1]. */
static void square_point(double t, double q[2])
{
    static const double corner[5][2] = {{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}, {-1.0, -1.0}};
    const double s = 4.0 * t;
    const int k = s >= 4.0 ? 3 : (int)s;
    for (int i = 0; i < 2; i++) {
        q[i] = corner[k][i] + (s - k) * (corner[k + 1][i] - corner[k][i]);
    }
}

static void place(const gen_panel *panel, double s, double t, double depth, double p[3])
{
    for (int k = 0; k < 3; k++) {
        p[k] = panel->middle[k] + s * panel->half[0][k] + t * panel->half[1][k] + depth * panel->depth[k];
    }
}

static void hole_point(const gen_panel *panel, double t, double q[2])
{
    const double angle = 2.0 * pi * t - 0.75 * pi;
    q[0] = panel->hole / sl_vec3_norm(panel->half[0]) * cos(angle);
    q[1] = panel->hole / sl_vec3_norm(panel->half[1]) * sin(angle);
}

/* u around, v from the hole to the square (far face) or the other way (near face): outward both times. */
static void face_point(const void *data, double u, double v, double p[3])
{
    const panel_part *part = data;
    const double out = part->far_face ? 1.0 - v : v;
    double inner[2], outer[2];
    hole_point(part->panel, u, inner);
    square_point(u, outer);
    place(part->panel, inner[0] + out * (outer[0] - inner[0]), inner[1] + out * (outer[1] - inner[1]),
          part->far_face ? 1.0 : 0.0, p);
}

static void wall_point(const void *data, double u, double v, double p[3])
{
    const panel_part *part = data;
    double q[2];
    hole_point(part->panel, u, q);
    place(part->panel, q[0], q[1], 1.0 - v, p);
}

void gen_panel_into(gen_builder *b, const gen_panel *panel)
{
    const panel_part near_face = {panel, false}, far_face = {panel, true};
    const int32_t around = 4 * panel->side;
    gen_grid(b, around, panel->rings, face_point, &near_face);
    gen_grid(b, around, panel->rings, face_point, &far_face);
    gen_grid(b, around, panel->wall, wall_point, &near_face);
}
