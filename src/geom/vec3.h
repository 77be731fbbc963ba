/* Small vectors as arrays of three doubles.
 * Layer: geom. */
#ifndef SL_GEOM_VEC3_H
#define SL_GEOM_VEC3_H

#include <math.h>

static inline void sl_vec3_sub(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; k++) {
        out[k] = a[k] - b[k];
    }
}

static inline void sl_vec3_add(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; k++) {
        out[k] = a[k] + b[k];
    }
}

static inline double sl_vec3_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* out = a x b; out must not alias a or b. */
static inline void sl_vec3_cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static inline double sl_vec3_norm(const double a[3])
{
    return sqrt(sl_vec3_dot(a, a));
}

static inline double sl_vec3_distance(const double a[3], const double b[3])
{
    double d[3];
    sl_vec3_sub(a, b, d);
    return sl_vec3_norm(d);
}

#endif
