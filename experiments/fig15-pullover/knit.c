#include "knit.h"

#include <math.h>

static const double zipper_width = 1.6, teeth = 0.5; /* in stitches */
static const double pi = 3.14159265358979323846;

static double fraction(double x)
{
    return x - floor(x);
}

/* A stitch is a V: light in the middle of its two limbs. */
static double stitch_light(double x, double y)
{
    const double limb = fabs(fraction(x) - 0.5), rise = fraction(y + 1.2 * limb);
    const double thread = sin(pi * rise), side = sin(pi * fmin(1.0, 2.0 * limb + 0.15));
    return 0.55 + 0.45 * thread * (0.35 + 0.65 * side);
}

/* Bands of colour by rows, so that one sees whether they line up. */
static void yarn(double row, double rgb[3])
{
    static const double wool[3] = {196, 186, 164}, red[3] = {168, 44, 46}, blue[3] = {38, 70, 118};
    const double band = fraction(row / 24.0) * 24.0;
    const double *c = band < 4.0 ? red : band >= 8.0 && band < 10.0 ? blue : wool;
    for (int k = 0; k < 3; k++) {
        rgb[k] = c[k];
    }
}

void knit_paint(void *user, int32_t facet, const double uv[2], const double xyz[3], uint8_t rgb[3])
{
    const knit *k = user;
    const knit_frame *f = &k->frame[k->face_chart[facet]];
    (void)xyz;
    const double d[2] = {(uv[0] - f->origin[0]) / k->stitch, (uv[1] - f->origin[1]) / k->stitch};
    const double along = d[0] * f->along[0] + d[1] * f->along[1], across = d[1] * f->along[0] - d[0] * f->along[1];
    if (f->length > 0.0 && fabs(across) < zipper_width && along > 0.0 && along < f->length / k->stitch) {
        const bool tooth = fabs(across) < zipper_width * 0.45 && fraction(along / (2.0 * teeth)) < 0.5;
        rgb[0] = tooth ? 226 : 52;
        rgb[1] = tooth ? 220 : 54;
        rgb[2] = tooth ? 190 : 60;
        return;
    }
    double color[3];
    yarn(floor(along), color);
    const double light = stitch_light(across, along);
    for (int i = 0; i < 3; i++) {
        rgb[i] = (uint8_t)fmin(255.0, color[i] * light * 1.15);
    }
}
