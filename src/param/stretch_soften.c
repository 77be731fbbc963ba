#include "param/stretch_internal.h"

#include <math.h>

/* J = U diag(s1, s2) V'. With t = cap / max |ln s|, the shape B rest, B = V diag(s^(t - 1)) V', is mapped by
 * J B = U diag(s^t) V': the same directions, with singular values within exp(+-cap). */
bool sl_stretch_soften(double cap, double J[4], double g[4])
{
    if (isinf(cap)) {
        return false;
    }
    const double d = J[0] * J[3] - J[1] * J[2], most = exp(cap);
    const double same = hypot(J[0] + J[3], J[2] - J[1]), mirrored = hypot(J[0] - J[3], J[2] + J[1]);
    const double s1 = 0.5 * (same + mirrored), s2 = d / s1;
    if (s1 <= most && s2 * most >= 1.0) { /* s2 <= s1: most triangles, and no logarithm for them */
        return false;
    }
    const double l1 = log(s1), l2 = log(s2), far = fmax(fabs(l1), fabs(l2));
    if (!(far > cap)) {
        return false; /* by rounding alone */
    }
    const double b1 = exp(l1 * (cap / far - 1.0)), b2 = exp(l2 * (cap / far - 1.0));
    /* V from J'J = [a b; b c]: its first column has the angle half of (a - c, 2 b)'s */
    const double a = J[0] * J[0] + J[2] * J[2], b = J[0] * J[1] + J[2] * J[3], c = J[1] * J[1] + J[3] * J[3];
    const double angle = 0.5 * atan2(2.0 * b, a - c), x = cos(angle), y = sin(angle);
    const double b00 = b1 * x * x + b2 * y * y, b01 = (b1 - b2) * x * y, b11 = b1 * y * y + b2 * x * x;
    for (int r = 0; r < 2; r++) { /* J B and B g: B is symmetric, so both are rows times B */
        const double p = J[2 * r], q = J[2 * r + 1], u = g[2 * r], v = g[2 * r + 1];
        J[2 * r] = p * b00 + q * b01;
        J[2 * r + 1] = p * b01 + q * b11;
        g[2 * r] = u * b00 + v * b01;
        g[2 * r + 1] = u * b01 + v * b11;
    }
    return true;
}
