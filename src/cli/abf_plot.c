/* Curves over the iterations. */
#include "cli/abf_svg.h"

#include <math.h>

static const double degrees = 57.29577951308232;
static const double width = 540.0, height = 270.0, left = 64.0, right = 130.0, top = 16.0, bottom = 40.0;
static const double lowest_decade = -18.0;

/* One curve: value(frame) by name and colour. */
typedef struct curve {
    const char *name, *color;
    double (*value)(const abf_frame *frame);
} curve;

static double gradient_of(const abf_frame *f)
{
    return f->info.gradient;
}

static double g1_of(const abf_frame *f)
{
    return f->info.g1;
}

static double g2_of(const abf_frame *f)
{
    return f->info.g2;
}

static double g3_of(const abf_frame *f)
{
    return f->info.g3;
}

static double energy_of(const abf_frame *f)
{
    return f->info.energy;
}

static double angle_of(const abf_frame *f)
{
    return f->info.min_angle * degrees;
}

/* Axes of a plot: iterations to the right, y up. */
typedef struct axes {
    int32_t count;
    double lo, hi;
    bool decades;
} axes;

static double at_x(const axes *a, int32_t k)
{
    return left + (width - left - right) * k / (a->count > 1 ? a->count - 1 : 1);
}

static double at_y(const axes *a, double value)
{
    double y = value;
    if (a->decades) {
        y = value > 0.0 ? log10(value) : lowest_decade;
    }
    y = fmin(fmax(y, a->lo), a->hi);
    return top + (height - top - bottom) * (a->hi - y) / (a->hi - a->lo);
}

static void begin_plot(sl_writer *w, const axes *a, const char *label)
{
    const int32_t stride = a->count > 24 ? (a->count + 11) / 12 : a->count > 12 ? 2 : 1;
    sl_writer_format(w, "<svg class=\"plot\" viewBox=\"0 0 %.0f %.0f\" width=\"%.0f\" height=\"%.0f\" role=\"img\">\n",
                     width, height, width, height);
    const double span = a->hi - a->lo, tick = a->decades ? ceil(span / 6.0) : span / 4.0;
    for (double y = a->lo; y <= a->hi + 1e-9 * span; y += tick) {
        const double yy = top + (height - top - bottom) * (a->hi - y) / span;
        sl_writer_format(w, "<path d=\"M%.1f %.1fH%.1f\" class=\"grid\"/>", left, yy, width - right);
        sl_writer_format(w,
                         a->decades ? "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">1e%.0f</text>\n"
                                    : "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">%.4g</text>\n",
                         left - 8.0, yy + 4.0, y);
    }
    for (int32_t k = 0; k < a->count; k += stride) {
        sl_writer_format(w, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">%d</text>\n", at_x(a, k),
                         height - bottom + 18.0, k);
    }
    sl_writer_format(w, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">iteration</text>\n",
                     0.5 * (left + width - right), height - 4.0);
    sl_writer_format(w, "<text x=\"4\" y=\"12\">%s</text>\n", label);
    sl_writer_format(w, "<path d=\"M%.1f %.1fV%.1fH%.1f\" class=\"axis\"/>\n", left, top, height - bottom,
                     width - right);
}

static void draw_curve(sl_writer *w, const abf_trace *t, const axes *a, const curve *c, int32_t number)
{
    sl_writer_format(w, "<polyline class=\"curve %s\" points=\"", c->color);
    for (int32_t k = 0; k < t->count; k++) {
        sl_writer_format(w, "%.1f,%.1f ", at_x(a, k), at_y(a, c->value(&t->frame[k])));
    }
    sl_writer_text(w, "\"/>\n");
    for (int32_t k = 0; k < t->count; k++) {
        const double v = c->value(&t->frame[k]);
        sl_writer_format(w,
                         "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3.2\" class=\"point %s\"><title>%s, iteration %d: %.6g"
                         "</title></circle>\n",
                         at_x(a, k), at_y(a, v), c->color, c->name, k, v);
    }
    const double y = top + 16.0 + 20.0 * number;
    sl_writer_format(w,
                     "<path d=\"M%.1f %.1fh18\" class=\"curve %s\"/><text x=\"%.1f\" y=\"%.1f\">%s"
                     "</text>\n",
                     width - right + 14.0, y, c->color, width - right + 38.0, y + 4.0, c->name);
}

void abf_svg_convergence(sl_writer *w, const abf_trace *t)
{
    static const curve curves[] = {{"|grad L|", "ink", gradient_of},
                                   {"max |g1|", "blue", g1_of},
                                   {"max |g2|", "green", g2_of},
                                   {"max |g3|", "red", g3_of}};
    axes a = {t->count, 0.0, lowest_decade, true};
    for (size_t c = 0; c < SL_COUNTOF(curves); c++) {
        for (int32_t k = 0; k < t->count; k++) {
            const double v = curves[c].value(&t->frame[k]);
            if (v > 0.0) {
                a.hi = fmax(a.hi, ceil(log10(v)));
                a.lo = fmax(fmin(a.lo, floor(log10(v))), lowest_decade);
            }
        }
    }
    a.hi = fmax(a.hi, a.lo + 1.0);
    begin_plot(w, &a, "");
    for (size_t c = 0; c < SL_COUNTOF(curves); c++) {
        draw_curve(w, t, &a, &curves[c], (int32_t)c);
    }
    sl_writer_text(w, "</svg>\n");
}

static void plain_plot(sl_writer *w, const abf_trace *t, const curve *c)
{
    axes a = {t->count, HUGE_VAL, -HUGE_VAL, false};
    for (int32_t k = 0; k < t->count; k++) {
        a.lo = fmin(a.lo, c->value(&t->frame[k]));
        a.hi = fmax(a.hi, c->value(&t->frame[k]));
    }
    const double room = fmax(0.05 * (a.hi - a.lo), 1e-3 * fabs(a.hi) + 1e-12);
    a.lo -= a.lo >= 0.0 && a.lo < room ? a.lo : room;
    a.hi += room;
    begin_plot(w, &a, "");
    draw_curve(w, t, &a, c, 0);
    sl_writer_text(w, "</svg>\n");
}

void abf_svg_progress(sl_writer *w, const abf_trace *t)
{
    static const curve energy = {"energy E", "violet", energy_of}, angle = {"smallest angle", "brown", angle_of};
    plain_plot(w, t, &energy);
    plain_plot(w, t, &angle);
}
