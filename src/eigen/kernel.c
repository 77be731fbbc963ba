#include "eigen/kernel.h"

#include <string.h>

#if defined(__x86_64__) && defined(__linux__) && !defined(__SANITIZE_ADDRESS__)
#define MANY_TARGETS __attribute__((target_clones("default", "avx2", "avx512f")))
#else
#define MANY_TARGETS
#endif

typedef double lanes8 __attribute__((vector_size(64), aligned(8), may_alias));
typedef double lanes4 __attribute__((vector_size(32), aligned(8), may_alias));

/* Sums of even and odd rows are kept apart where a row alone has too few sums to hide an addition's latency. */
MANY_TARGETS static void gram4(const double *P, const double *W, int64_t rows, double *H)
{
    lanes8 even[4] = {{0.0}}, odd[4] = {{0.0}};
    const lanes8 *p = (const lanes8 *)P;
    for (int64_t r = 0; r + 1 < rows; r += 2) {
        const lanes8 a = p[r], b = p[r + 1];
        for (int c = 0; c < 4; c++) {
            even[c] += a * W[4 * r + c];
            odd[c] += b * W[4 * r + 4 + c];
        }
    }
    for (int c = 0; c < 4; c++) {
        if (rows % 2 != 0) {
            even[c] += p[rows - 1] * W[4 * (rows - 1) + c];
        }
        even[c] += odd[c];
        for (int i = 0; i < 8; i++) {
            H[4 * i + c] += even[c][i];
        }
    }
}

MANY_TARGETS static void gram8(const double *P, const double *W, int64_t rows, double *H)
{
    lanes8 s0 = {0.0}, s1 = s0, s2 = s0, s3 = s0, s4 = s0, s5 = s0, s6 = s0, s7 = s0;
    for (int64_t r = 0; r < rows; r++) {
        const lanes8 w = ((const lanes8 *)W)[r];
        const double *p = P + 8 * r;
        s0 += p[0] * w;
        s1 += p[1] * w;
        s2 += p[2] * w;
        s3 += p[3] * w;
        s4 += p[4] * w;
        s5 += p[5] * w;
        s6 += p[6] * w;
        s7 += p[7] * w;
    }
    lanes8 *h = (lanes8 *)H;
    h[0] += s0;
    h[1] += s1;
    h[2] += s2;
    h[3] += s3;
    h[4] += s4;
    h[5] += s5;
    h[6] += s6;
    h[7] += s7;
}

MANY_TARGETS static void add8(const double *P, const double *H, int64_t rows, double *W)
{
    const lanes8 *h = (const lanes8 *)H;
    const lanes8 h0 = h[0], h1 = h[1], h2 = h[2], h3 = h[3], h4 = h[4], h5 = h[5], h6 = h[6], h7 = h[7];
    for (int64_t r = 0; r < rows; r++) {
        const double *p = P + 8 * r;
        const lanes8 left = (p[0] * h0 + p[1] * h1) + (p[2] * h2 + p[3] * h3);
        const lanes8 right = (p[4] * h4 + p[5] * h5) + (p[6] * h6 + p[7] * h7);
        ((lanes8 *)W)[r] += left + right;
    }
}

MANY_TARGETS static void add4(const double *P, const double *H, int64_t rows, double *W)
{
    const lanes4 *h = (const lanes4 *)H;
    const lanes4 h0 = h[0], h1 = h[1], h2 = h[2], h3 = h[3], h4 = h[4], h5 = h[5], h6 = h[6], h7 = h[7];
    for (int64_t r = 0; r < rows; r++) {
        const double *p = P + 8 * r;
        const lanes4 left = (p[0] * h0 + p[1] * h1) + (p[2] * h2 + p[3] * h3);
        const lanes4 right = (p[4] * h4 + p[5] * h5) + (p[6] * h6 + p[7] * h7);
        ((lanes4 *)W)[r] += left + right;
    }
}

MANY_TARGETS static void self4(const double *W, int64_t rows, double *G)
{
    lanes4 s0 = {0.0}, s1 = s0, s2 = s0, s3 = s0;
    for (int64_t r = 0; r < rows; r++) {
        const double *x = W + 4 * r;
        const lanes4 w = ((const lanes4 *)W)[r];
        s0 += x[0] * w;
        s1 += x[1] * w;
        s2 += x[2] * w;
        s3 += x[3] * w;
    }
    lanes4 *g = (lanes4 *)G;
    g[0] += s0;
    g[1] += s1;
    g[2] += s2;
    g[3] += s3;
}

/* Row by row from the last lane to the first: lane j needs the lanes before it as they were. */
MANY_TARGETS static void triangle8(const double *U, int64_t rows, double *W)
{
    const lanes8 *u = (const lanes8 *)U;
    for (int64_t r = 0; r < rows; r++) {
        const double *x = W + 8 * r;
        const lanes8 left = (x[0] * u[0] + x[1] * u[1]) + (x[2] * u[2] + x[3] * u[3]);
        const lanes8 right = (x[4] * u[4] + x[5] * u[5]) + (x[6] * u[6] + x[7] * u[7]);
        ((lanes8 *)W)[r] = left + right;
    }
}

MANY_TARGETS static void triangle4(const double *U, int64_t rows, double *W)
{
    const lanes4 *u = (const lanes4 *)U;
    for (int64_t r = 0; r < rows; r++) {
        const double *x = W + 4 * r;
        ((lanes4 *)W)[r] = (x[0] * u[0] + x[1] * u[1]) + (x[2] * u[2] + x[3] * u[3]);
    }
}

MANY_TARGETS static void multiply8(const int64_t *first, const int32_t *col, const double *val, double shift,
                                   const double *X, int64_t begin, int64_t rows, double *Y)
{
    const lanes8 *x = (const lanes8 *)X;
    for (int64_t r = 0; r < rows; r++) {
        lanes8 sum = -shift * x[begin + r];
        for (int64_t p = first[begin + r]; p < first[begin + r + 1]; p++) {
            sum += val[p] * x[col[p]];
        }
        ((lanes8 *)Y)[r] = sum;
    }
}

MANY_TARGETS static void multiply4(const int64_t *first, const int32_t *col, const double *val, double shift,
                                   const double *X, int64_t begin, int64_t rows, double *Y)
{
    const lanes4 *x = (const lanes4 *)X;
    for (int64_t r = 0; r < rows; r++) {
        lanes4 sum = -shift * x[begin + r];
        for (int64_t p = first[begin + r]; p < first[begin + r + 1]; p++) {
            sum += val[p] * x[col[p]];
        }
        ((lanes4 *)Y)[r] = sum;
    }
}

MANY_TARGETS static void widen(const float *restrict X, int64_t count, double *restrict Y)
{
    for (int64_t i = 0; i < count; i++) {
        Y[i] = (double)X[i];
    }
}

MANY_TARGETS static void narrow(const double *restrict X, int64_t count, float *restrict Y)
{
    for (int64_t i = 0; i < count; i++) {
        Y[i] = (float)X[i];
    }
}

void sl_kernel_widen(const float *X, int64_t count, double *Y)
{
    widen(X, count, Y);
}

void sl_kernel_narrow(const double *X, int64_t count, float *Y)
{
    narrow(X, count, Y);
}

void sl_kernel_gram(const double *P, const double *W, int64_t rows, int32_t w, double *H)
{
    if (w == 8) {
        gram8(P, W, rows, H);
    } else {
        gram4(P, W, rows, H);
    }
}

void sl_kernel_add(const double *P, const double *H, int64_t rows, int32_t w, double *W)
{
    if (w == 8) {
        add8(P, H, rows, W);
    } else {
        add4(P, H, rows, W);
    }
}

void sl_kernel_self(const double *W, int64_t rows, int32_t w, double *G)
{
    if (w == 8) {
        gram8(W, W, rows, G);
    } else {
        self4(W, rows, G);
    }
}

void sl_kernel_triangle(const double *U, int64_t rows, int32_t w, double *W)
{
    if (w == 8) {
        triangle8(U, rows, W);
    } else {
        triangle4(U, rows, W);
    }
}

void sl_kernel_multiply(const int64_t *first, const int32_t *col, const double *val, double shift, const double *X,
                        int32_t w, int64_t begin, int64_t rows, double *Y)
{
    if (w == 8) {
        multiply8(first, col, val, shift, X, begin, rows, Y);
    } else {
        multiply4(first, col, val, shift, X, begin, rows, Y);
    }
}
