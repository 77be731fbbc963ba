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

SL_KERNEL vec vec_load_part(const double *p, int count)
{
    vec v;
    for (int i = 0; i < 8; i++) {
        v.x[i] = i < count ? p[i] : 0.0;
    }
    return v;
}

SL_KERNEL void vec_store_part(double *p, vec v, int count)
{
    for (int i = 0; i < count; i++) {
        p[i] = v.x[i];
    }
}

SL_KERNEL vec vec_load_half(const double *p)
{
    return vec_load_part(p, 4);
}

SL_KERNEL void vec_store_half(double *p, vec v)
{
    vec_store_part(p, v, 4);
}

SL_KERNEL vec vec_of(double a)
{
    vec v;
    for (int i = 0; i < 8; i++) {
        v.x[i] = a;
    }
    return v;
}

SL_KERNEL vec vec_multiply(vec a, vec b)
{
    for (int i = 0; i < 8; i++) {
        a.x[i] *= b.x[i];
    }
    return a;
}

SL_KERNEL vec vec_subtract(vec a, vec b)
{
    for (int i = 0; i < 8; i++) {
        a.x[i] -= b.x[i];
    }
    return a;
}

SL_KERNEL vec vec_add(vec a, vec b)
{
    for (int i = 0; i < 8; i++) {
        a.x[i] += b.x[i];
    }
    return a;
}

/* c + a b */
SL_KERNEL vec vec_fma(vec a, vec b, vec c)
{
    for (int i = 0; i < 8; i++) {
        c.x[i] = fma(a.x[i], b.x[i], c.x[i]);
    }
    return c;
}

/* c - a b */
SL_KERNEL vec vec_fnma(vec a, vec b, vec c)
{
    for (int i = 0; i < 8; i++) {
        c.x[i] = fma(-a.x[i], b.x[i], c.x[i]);
    }
    return c;
}

SL_KERNEL vec vec_pack(const double x[8])
{
    return vec_load(x);
}

SL_KERNEL vec vec_sums(const vec v[8])
{
    vec sum;
    for (int j = 0; j < 8; j++) {
        const double *x = v[j].x;
        sum.x[j] = ((x[0] + x[1]) + (x[2] + x[3])) + ((x[4] + x[5]) + (x[6] + x[7]));
    }
    return sum;
}

#define SL_KERNEL_GROUP 8
#define SL_KERNEL_NAME "scalar"
#define SL_KERNEL_SET sl_kernels_scalar
#include "sparse/kernels_front.h"
#include "sparse/kernels_solve.h"
#include "sparse/kernels_table.h"
