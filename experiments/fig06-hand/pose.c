#include "hand.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

/* An arc about an axis in front of the palm takes the place of the straight part beyond y = from. */
static void roll(const double p[3], double from, double length, double angle, double q[3])
{
    const double along = p[1] - from, radius = length / angle;
    q[0] = p[0];
    q[1] = along > 0.0 ? from + (radius - p[2]) * sin(along / radius) : p[1];
    q[2] = along > 0.0 ? radius - (radius - p[2]) * cos(along / radius) : p[2];
}

void hand_move_into(const sl_polygons *rest, const hand_pose *pose, double *xyz)
{
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (int32_t v = 0; v < rest->nv; v++) {
        low = fmin(low, rest->xyz[3 * (int64_t)v + 1]);
        high = fmax(high, rest->xyz[3 * (int64_t)v + 1]);
    }
    const double angle = pose->degrees * pi / 180.0, from = low + pose->from * (high - low);
    for (int32_t v = 0; v < rest->nv; v++) {
        const double *p = rest->xyz + 3 * (int64_t)v;
        double *q = xyz + 3 * (int64_t)v;
        if (pose->move == HAND_ROLLED) {
            roll(p, from, high - from, angle, q);
        } else {
            const double turn = pose->move == HAND_TWISTED ? angle * (p[1] - low) / (high - low) : 0.0;
            q[0] = cos(turn) * p[0] + sin(turn) * p[2];
            q[1] = p[1];
            q[2] = cos(turn) * p[2] - sin(turn) * p[0];
        }
    }
}

sl_view hand_view(const hand_pose *pose, bool edge)
{
    sl_view view = exp_view_of("hand");
    view.azimuth -= edge ? 62.0 : pose->move == HAND_ROLLED ? 48.0 : 0.0;
    return view;
}
