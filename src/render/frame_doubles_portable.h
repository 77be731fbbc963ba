/* Eight doubles as an array; see frame_lanes.h.
 * Layer: render, private. */
#ifndef SL_RENDER_FRAME_DOUBLES_PORTABLE_H
#define SL_RENDER_FRAME_DOUBLES_PORTABLE_H

#include "render/frame_lanes_portable.h"

#include <float.h>

typedef struct d8 {
    double v[8];
} d8;

LANES_CALL d8 d8_all(double a)
{
    d8 r;
    for (int k = 0; k < 8; k++) {
        r.v[k] = a;
    }
    return r;
}

LANES_CALL d8 d8_add(d8 a, d8 b)
{
    for (int k = 0; k < 8; k++) {
        a.v[k] += b.v[k];
    }
    return a;
}

LANES_CALL d8 d8_sub(d8 a, d8 b)
{
    for (int k = 0; k < 8; k++) {
        a.v[k] -= b.v[k];
    }
    return a;
}

LANES_CALL d8 d8_mul(d8 a, d8 b)
{
    for (int k = 0; k < 8; k++) {
        a.v[k] *= b.v[k];
    }
    return a;
}

LANES_CALL d8 d8_div(d8 a, d8 b)
{
    for (int k = 0; k < 8; k++) {
        a.v[k] /= b.v[k];
    }
    return a;
}

LANES_CALL d8 d8_min(d8 a, d8 b)
{
    for (int k = 0; k < 8; k++) {
        a.v[k] = a.v[k] < b.v[k] ? a.v[k] : b.v[k];
    }
    return a;
}

LANES_CALL d8 d8_max(d8 a, d8 b)
{
    for (int k = 0; k < 8; k++) {
        a.v[k] = a.v[k] > b.v[k] ? a.v[k] : b.v[k];
    }
    return a;
}

LANES_CALL d8 d8_abs(d8 a)
{
    for (int k = 0; k < 8; k++) {
        a.v[k] = fabs(a.v[k]);
    }
    return a;
}

LANES_CALL d8 d8_finite_or(d8 a, d8 other)
{
    for (int k = 0; k < 8; k++) {
        a.v[k] = fabs(a.v[k]) <= DBL_MAX ? a.v[k] : other.v[k];
    }
    return a;
}

LANES_CALL void d8_store(double *p, d8 a)
{
    memcpy(p, a.v, sizeof a.v);
}

LANES_CALL i8 d8_less(d8 a, d8 b)
{
    i8 r;
    for (int k = 0; k < 8; k++) {
        r.v[k] = -(a.v[k] < b.v[k]);
    }
    return r;
}

LANES_CALL i8 d8_round(d8 a)
{
    i8 r;
    for (int k = 0; k < 8; k++) {
        r.v[k] = (int32_t)lrint(a.v[k]);
    }
    return r;
}

LANES_CALL f8 d8_float(d8 a)
{
    f8 r;
    for (int k = 0; k < 8; k++) {
        r.v[k] = (float)a.v[k];
    }
    return r;
}

LANES_CALL void d8_points(const double *p, d8 xyz[3])
{
    for (int k = 0; k < 24; k++) {
        xyz[k % 3].v[k / 3] = p[k];
    }
}

#endif
