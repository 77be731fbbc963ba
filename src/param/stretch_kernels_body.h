/* Bodies of the kernels; included by each of stretch_kernels_*.c after its vectors of eight doubles.
 *
 * With J(z) = alpha z + beta conj(z) for complex z: alpha = E + i H is the similarity part of J, beta = F + i G the
 * reflected one; I = s1^2 + s2^2 = 2 |alpha|^2 + 2 |beta|^2 and d = s1 s2 = |alpha|^2 - |beta|^2. The eigenvectors of
 * psi's Hessian are the directions of alpha and beta and the ones across them, so that it is written without a root and
 * without a singular case where s1 = s2:
 *
 *     twist (across alpha)        lambda0 = 2 - 2 (I - d) / d^3
 *     flip (across beta)          lambda1 = 2 - 4 w + 2 (I + d) / d^3
 *     scaling (along alpha, beta) [a c; c b], a = 2 + 3 (I^2 - 2 d^2) / d^4, b = a - 4 w, c = -12 |alpha| |beta| I /
 * d^4
 *
 * Source: Smith, de Goes, Kim 2019, "Analytic eigensystems for isotropic distortion energies", Sec. 4; worked out in
 * these terms. Layer: param; private to it. */
#include "param/stretch_kernels.h"

#include <math.h>

static const double ROUNDING_SHARE = 3.3306690738754716e-16; /* Shewchuk 1997: orient2d's bound, (3 + 16 e) e */
static const double LEAST_PROOF = 1e-290;                    /* far above what underflow can hide */

SL_KERNEL vec doubled(vec a)
{
    return add(a, a);
}

/* a b + c d and a b - c d */
SL_KERNEL vec sum_of_products(vec a, vec b, vec c, vec d)
{
    return add(mul(a, b), mul(c, d));
}

SL_KERNEL vec difference_of_products(vec a, vec b, vec c, vec d)
{
    return sub(mul(a, b), mul(c, d));
}

SL_KERNEL vec negative(vec a)
{
    return sub(vec_of(0.0), a);
}

/* J = [p q] [g1 g2]' of eight lanes from l on, p and q the edges from corner 0. */
SL_KERNEL void jacobian_of(sl_strip_corners corners, double gradient[4][SL_STRIP], int l, vec edge[4], vec J[4])
{
    vec g[4];
    for (int k = 0; k < 4; k++) {
        edge[k] = sub(vec_load(corners[2 + k] + l), vec_load(corners[k % 2] + l));
        g[k] = vec_load(gradient[k] + l);
    }
    J[0] = sum_of_products(edge[0], g[0], edge[2], g[2]);
    J[1] = sum_of_products(edge[0], g[1], edge[2], g[3]);
    J[2] = sum_of_products(edge[1], g[0], edge[3], g[2]);
    J[3] = sum_of_products(edge[1], g[1], edge[3], g[3]);
}

SL_KERNEL_ENTRY void strip_jacobian(sl_strip_corners corners, double gradient[4][SL_STRIP], double J[4][SL_STRIP])
{
    for (int l = 0; l < SL_STRIP; l += SL_STRETCH_LANES) {
        vec edge[4], j[4];
        jacobian_of(corners, gradient, l, edge, j);
        for (int k = 0; k < 4; k++) {
            vec_store(J[k] + l, j[k]);
        }
    }
}

/* d = det J, I = |J|^2 */
SL_KERNEL void invariants_of(const vec J[4], vec *d, vec *I)
{
    *d = difference_of_products(J[0], J[3], J[1], J[2]);
    *I = add(sum_of_products(J[0], J[0], J[1], J[1]), sum_of_products(J[2], J[2], J[3], J[3]));
}

/* P = along J + across cof J, along = 2 (1 - w + 1/d^2), across = 2 (w - I/d^3); corner k gets P g_k. */
SL_KERNEL_ENTRY void strip_force(double w, const double *weight, double gradient[4][SL_STRIP], double J[4][SL_STRIP],
                                 sl_strip_corners force)
{
    for (int l = 0; l < SL_STRIP; l += SL_STRETCH_LANES) {
        vec j[4], g[4], d, I;
        for (int k = 0; k < 4; k++) {
            j[k] = vec_load(J[k] + l);
            g[k] = vec_load(gradient[k] + l);
        }
        invariants_of(j, &d, &I);
        const vec r = quotient(vec_of(1.0), d), r2 = mul(r, r), area = doubled(vec_load(weight + l));
        const vec along = mul(area, add(vec_of(1.0 - w), r2));
        const vec across = mul(area, sub(vec_of(w), mul(I, mul(r2, r))));
        const vec P0 = sum_of_products(along, j[0], across, j[3]),
                  P1 = difference_of_products(along, j[1], across, j[2]);
        const vec P2 = difference_of_products(along, j[2], across, j[1]),
                  P3 = sum_of_products(along, j[3], across, j[0]);
        for (int k = 0; k < 2; k++) {
            const vec u = sum_of_products(P0, g[2 * k], P1, g[2 * k + 1]);
            const vec v = sum_of_products(P2, g[2 * k], P3, g[2 * k + 1]);
            vec_store(force[2 + 2 * k] + l, u);
            vec_store(force[3 + 2 * k] + l, v);
        }
        for (int k = 0; k < 2; k++) {
            vec_store(force[k] + l, negative(add(vec_load(force[2 + k] + l), vec_load(force[4 + k] + l))));
        }
    }
}

/* What multiplies the parts of an element's Hessian. */
typedef struct moduli {
    vec twist, flip; /* lambda0 and lambda1, at least 0 */
    vec pp, pm, mm;  /* of [a c; c b], projected, what twist and flip leave: (a - twist) / 2 |alpha|^2, c / 2 |alpha|
                      * |beta|, (b - flip) / 2 |beta|^2 */
} moduli;

/* The scaling block projected where its lesser eigenvalue `low` is negative: f ([a c; c b] - low), f = high / 2 r. */
SL_KERNEL void project_scaling(double w, vec a, vec aa, vec bb, vec I, vec d, vec r4, vec lambda1, moduli *m)
{
    const vec half = vec_of(2.0 * w), b = sub(sub(a, half), half), mean = sub(a, half);
    const vec cc = mul(mul(vec_of(4.0), mul(m->pm, m->pm)), mul(aa, bb));
    const vec radius = root_of(add(mul(half, half), cc)), high = add(mean, radius);
    const vec low = quotient(sub(mul(a, b), cc), high), f = quotient(high, doubled(radius));
    const vec flat = where_positive(lambda1, mul(doubled(r4), add(mul(vec_of(3.0), I), mul(vec_of(4.0), d))),
                                    quotient(b, doubled(bb)));
    const vec steep = quotient(mul(doubled(f), mul(mul(m->pm, m->pm), aa)), add(radius, half));
    const vec left = where_positive(m->flip, quotient(m->flip, doubled(bb)), vec_of(0.0));
    const vec negative_low = negative(low);
    m->pp = where_positive(negative_low, quotient(sub(mul(f, sub(a, low)), m->twist), doubled(aa)), m->pp);
    m->mm = where_positive(negative_low, sub(steep, left), flat);
    m->pm = where_positive(negative_low, mul(f, m->pm), m->pm);
}

/* For w <= 1/2 only the twist can be negative. */
SL_KERNEL void moduli_of(double w, const vec J[4], vec aa, vec bb, moduli *m)
{
    vec d, I;
    invariants_of(J, &d, &I);
    const vec r = quotient(vec_of(1.0), d), r2 = mul(r, r), r3 = mul(r2, r), r4 = mul(r2, r2), ir = mul(I, r2);
    const vec a = add(vec_of(2.0), mul(vec_of(3.0), sub(mul(ir, ir), doubled(r2))));
    const vec lambda0 = sub(vec_of(2.0), doubled(mul(sub(I, d), r3)));
    const vec lambda1 = add(vec_of(2.0 - 4.0 * w), doubled(mul(add(I, d), r3)));
    m->twist = greater(lambda0, vec_of(0.0));
    m->flip = greater(lambda1, vec_of(0.0));
    m->pp = quotient(sub(a, m->twist), doubled(aa));
    m->pm = mul(vec_of(-6.0), mul(ir, r2));
    m->mm = mul(doubled(r4), add(mul(vec_of(3.0), I), mul(vec_of(4.0), d)));
    if (w > 0.5) {
        project_scaling(w, a, aa, bb, I, d, r4, lambda1, m);
    }
}

/* Rows: how the parts along alpha and beta change with u and v of corners 1 and 2. */
SL_KERNEL void along_parts(const vec J[4], const vec g[4], vec p[4], vec m[4], vec *aa, vec *bb)
{
    const vec half = vec_of(0.5);
    const vec E = mul(half, add(J[0], J[3])), F = mul(half, sub(J[0], J[3]));
    const vec G = mul(half, add(J[2], J[1])), H = mul(half, sub(J[2], J[1]));
    *aa = sum_of_products(E, E, H, H);
    *bb = sum_of_products(F, F, G, G);
    for (int k = 0; k < 4; k += 2) {
        p[k] = difference_of_products(E, g[k], H, g[k + 1]);
        p[k + 1] = sum_of_products(E, g[k + 1], H, g[k]);
        m[k] = sum_of_products(F, g[k], G, g[k + 1]);
        m[k + 1] = difference_of_products(G, g[k], F, g[k + 1]);
    }
}

/* Corner 0's entries from those of 1 and 2, for the rows of the Hessian add up to zero. */
SL_KERNEL void close_element(double element[SL_ELEMENT][SL_STRIP], int l, const vec first[3], const vec mixed[4],
                             const vec last[3])
{
    const vec a[4] = {negative(add(first[0], mixed[0])), negative(add(first[1], mixed[2])),
                      negative(add(first[1], mixed[1])), negative(add(first[2], mixed[3]))};
    const vec b[4] = {negative(add(last[0], mixed[0])), negative(add(last[1], mixed[2])),
                      negative(add(last[1], mixed[1])), negative(add(last[2], mixed[3]))};
    /* a: (0, 1) = uu, uv, vu, vv; b: (2, 0) with the letters of 2 first */
    const vec own[3] = {negative(add(a[0], b[0])), negative(add(a[1], b[2])), negative(add(a[3], b[3]))};
    for (int k = 0; k < 3; k++) {
        vec_store(element[k] + l, own[k]);
        vec_store(element[3 + k] + l, first[k]);
        vec_store(element[6 + k] + l, last[k]);
    }
    for (int k = 0; k < 4; k++) {
        vec_store(element[9 + k] + l, a[k]);
        vec_store(element[13 + k] + l, mixed[k]);
        vec_store(element[17 + k] + l, b[k]);
    }
}

/* K = S (dot products) + D (cross products) + pp p p' + pm (p m' + m p') + mm m m' with S, D = (twist +- flip) / 2. */
SL_KERNEL void fill_element(const vec g[4], const vec p[4], const vec m[4], const moduli *k, vec first[3], vec mixed[4],
                            vec last[3])
{
    const vec half = vec_of(0.5), S = mul(half, add(k->twist, k->flip)), D = mul(half, sub(k->twist, k->flip));
    vec q[4], r[4];
    for (int i = 0; i < 4; i++) {
        q[i] = sum_of_products(k->pp, p[i], k->pm, m[i]);
        r[i] = sum_of_products(k->pm, p[i], k->mm, m[i]);
    }
    const vec g11 = mul(S, sum_of_products(g[0], g[0], g[1], g[1]));
    const vec g12 = mul(S, sum_of_products(g[0], g[2], g[1], g[3]));
    const vec g22 = mul(S, sum_of_products(g[2], g[2], g[3], g[3]));
    const vec cross = mul(D, difference_of_products(g[0], g[3], g[1], g[2]));
    first[0] = add(g11, sum_of_products(p[0], q[0], m[0], r[0]));
    first[1] = sum_of_products(p[0], q[1], m[0], r[1]);
    first[2] = add(g11, sum_of_products(p[1], q[1], m[1], r[1]));
    mixed[0] = add(g12, sum_of_products(p[0], q[2], m[0], r[2]));
    mixed[1] = add(sum_of_products(p[0], q[3], m[0], r[3]), cross);
    mixed[2] = sub(sum_of_products(p[1], q[2], m[1], r[2]), cross);
    mixed[3] = add(g12, sum_of_products(p[1], q[3], m[1], r[3]));
    last[0] = add(g22, sum_of_products(p[2], q[2], m[2], r[2]));
    last[1] = sum_of_products(p[2], q[3], m[2], r[3]);
    last[2] = add(g22, sum_of_products(p[3], q[3], m[3], r[3]));
}

SL_KERNEL_ENTRY void strip_element(double w, const double *weight, double gradient[4][SL_STRIP], double J[4][SL_STRIP],
                                   double element[SL_ELEMENT][SL_STRIP])
{
    for (int l = 0; l < SL_STRIP; l += SL_STRETCH_LANES) {
        vec j[4], g[4], p[4], m[4], first[3], mixed[4], last[3], aa, bb;
        moduli k;
        for (int i = 0; i < 4; i++) {
            j[i] = vec_load(J[i] + l);
            g[i] = vec_load(gradient[i] + l);
        }
        along_parts(j, g, p, m, &aa, &bb);
        moduli_of(w, j, aa, bb, &k);
        const vec area = vec_load(weight + l);
        k.twist = mul(area, k.twist);
        k.flip = mul(area, k.flip);
        k.pp = mul(area, k.pp);
        k.pm = mul(area, k.pm);
        k.mm = mul(area, k.mm);
        fill_element(g, p, m, &k, first, mixed, last);
        close_element(element, l, first, mixed, last);
    }
}

SL_KERNEL void accumulate(double *sum, vec x)
{
    vec_store(sum, add(vec_load(sum), x));
}

/* psi = (1 - w) I + 2 w d + I / d^2. Lanes of no weight add nothing, whatever their triangle. */
SL_KERNEL_ENTRY void strip_measure(double w, const sl_strip_rest *rest, sl_strip_corners corners,
                                   sl_stretch_lanes *lanes)
{
    const vec none = vec_of(0.0);
    for (int l = 0; l < SL_STRIP; l += SL_STRETCH_LANES) {
        vec edge[4], J[4], d, I;
        jacobian_of(corners, ((sl_strip_rest *)rest)->gradient, l, edge, J);
        invariants_of(J, &d, &I);
        const vec left = mul(edge[0], edge[3]), right = mul(edge[1], edge[2]);
        const vec size = add(greater(left, negative(left)), greater(right, negative(right)));
        const vec sure = sub(sub(sub(left, right), mul(vec_of(ROUNDING_SHARE), size)), vec_of(LEAST_PROOF));
        vec_store(lanes->least, lesser(vec_load(lanes->least), d)); /* the last one if that is not a number */
        vec_store(lanes->sure, lesser(vec_load(lanes->sure), sure));
        const vec weight = vec_load(rest->weight + l), counted = vec_load(rest->counted + l);
        const vec r = quotient(vec_of(1.0), d), inverse = mul(mul(I, r), r);
        const vec psi = add(add(mul(vec_of(1.0 - w), I), mul(vec_of(2.0 * w), d)), inverse);
        accumulate(lanes->energy, where_positive(weight, mul(weight, psi), none));
        accumulate(lanes->inverse, where_positive(counted, mul(counted, inverse), none));
        accumulate(lanes->area, where_positive(counted, mul(counted, d), none));
    }
}

/* The smallest positive root of a t^2 + b t + c, c > 0: the area of a triangle on its way. Without cancellation: for
 * b <= 0 it is 2 c / (root - b), else -(b + root) / 2 a where a < 0. */
SL_KERNEL vec first_root(vec a, vec b, vec c)
{
    const vec never = vec_of(INFINITY);
    const vec discriminant = sub(mul(b, b), mul(vec_of(4.0), mul(a, c)));
    const vec root = root_of(greater(discriminant, vec_of(0.0)));
    const vec falling = sub(root, b), rising = negative(add(root, b));
    const vec soon = where_positive(falling, quotient(doubled(c), falling), never);
    const vec late = where_positive(negative(a), quotient(rising, doubled(a)), never);
    return where_positive(negative(discriminant), never, where_positive(b, late, soon));
}

SL_KERNEL_ENTRY void strip_bound(sl_strip_corners corners, sl_strip_corners direction, double bound[SL_STRETCH_LANES])
{
    for (int l = 0; l < SL_STRIP; l += SL_STRETCH_LANES) {
        vec e[4], p[4];
        for (int k = 0; k < 4; k++) {
            e[k] = sub(vec_load(corners[2 + k] + l), vec_load(corners[k % 2] + l));
            p[k] = sub(vec_load(direction[2 + k] + l), vec_load(direction[k % 2] + l));
        }
        const vec a = difference_of_products(p[0], p[3], p[1], p[2]);
        const vec b =
            add(difference_of_products(e[0], p[3], e[1], p[2]), difference_of_products(p[0], e[3], p[1], e[2]));
        const vec c = difference_of_products(e[0], e[3], e[1], e[2]);
        vec_store(bound, lesser(first_root(a, b, c), vec_load(bound)));
    }
}

const sl_stretch_kernels SL_KERNEL_SET = {.name = SL_KERNEL_NAME,
                                          .jacobian = strip_jacobian,
                                          .force = strip_force,
                                          .element = strip_element,
                                          .measure = strip_measure,
                                          .bound = strip_bound};
