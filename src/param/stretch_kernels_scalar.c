/* The kernels in plain C: what others are compared to, and what machines without their instructions run. */
#include <math.h>

typedef struct vec {
    double x[8];
} vec;

#define SL_KERNEL static inline
#define SL_KERNEL_ENTRY static

SL_KERNEL vec vec_load(const double *p)
{
    vec v;
    for (int i = 0; i < 8; i++) {
        v.x[i] = p[i];
    }
    return v;
}

SL_KERNEL void vec_store(double *p, vec v)
{
    for (int i = 0; i < 8; i++) {
        p[i] = v.x[i];
    }
}

SL_KERNEL vec vec_of(double a)
{
    vec v;
    for (int i = 0; i < 8; i++) {
        v.x[i] = a;
    }
    return v;
}

SL_KERNEL vec add(vec a, vec b)
{
    for (int i = 0; i < 8; i++) {
        a.x[i] += b.x[i];
    }
    return a;
}

SL_KERNEL vec sub(vec a, vec b)
{
    for (int i = 0; i < 8; i++) {
        a.x[i] -= b.x[i];
    }
    return a;
}

SL_KERNEL vec mul(vec a, vec b)
{
    for (int i = 0; i < 8; i++) {
        a.x[i] *= b.x[i];
    }
    return a;
}

SL_KERNEL vec quotient(vec a, vec b)
{
    for (int i = 0; i < 8; i++) {
        a.x[i] /= b.x[i];
    }
    return a;
}

SL_KERNEL vec root_of(vec a)
{
    for (int i = 0; i < 8; i++) {
        a.x[i] = sqrt(a.x[i]);
    }
    return a;
}

/* a > b ? a : b, so b where one is not a number */
SL_KERNEL vec greater(vec a, vec b)
{
    for (int i = 0; i < 8; i++) {
        b.x[i] = a.x[i] > b.x[i] ? a.x[i] : b.x[i];
    }
    return b;
}

/* a < b ? a : b */
SL_KERNEL vec lesser(vec a, vec b)
{
    for (int i = 0; i < 8; i++) {
        b.x[i] = a.x[i] < b.x[i] ? a.x[i] : b.x[i];
    }
    return b;
}

/* x > 0 ? a : b */
SL_KERNEL vec where_positive(vec x, vec a, vec b)
{
    for (int i = 0; i < 8; i++) {
        b.x[i] = x.x[i] > 0.0 ? a.x[i] : b.x[i];
    }
    return b;
}

#define SL_KERNEL_NAME "scalar"
#define SL_KERNEL_SET sl_stretch_kernels_scalar
#include "param/stretch_kernels_body.h"
