#include "cli/abf_svg.h"

#include "base/memory.h"

#include <math.h>
#include <stdio.h>

static const double degrees = 57.29577951308232;
static const double side = 460.0, frame_margin = 30.0;

/* Charts up to so many triangles carry numbers, tooltips and dots, triangles at all. */
enum { LABELLED = 60, DOTTED = 3000, DRAWN = 20000 };

static const double label_inset = 0.44; /* of the way from a corner to the middle of its triangle */

int32_t abf_residual_class(double residual)
{
    const int32_t last = ABF_RESIDUAL_CLASSES - 1;
    const double decade = residual > 0.0 ? round(log10(residual)) : -last;
    return isnan(residual) ? last : last + (int32_t)fmin(fmax(decade, -last), 0.0);
}

/* From uv to the drawing. */
typedef struct window {
    double x0, y0, scale, width, height;
} window;

static window window_of(int32_t nv, const double *uv)
{
    double lo[2] = {HUGE_VAL, HUGE_VAL}, hi[2] = {-HUGE_VAL, -HUGE_VAL};
    for (int32_t v = 0; v < nv; v++) {
        for (int k = 0; k < 2; k++) {
            lo[k] = fmin(lo[k], uv[2 * (int64_t)v + k]);
            hi[k] = fmax(hi[k], uv[2 * (int64_t)v + k]);
        }
    }
    const double scale = side / fmax(fmax(hi[0] - lo[0], hi[1] - lo[1]), 1e-300);
    return (window){lo[0] - frame_margin / scale, hi[1] + frame_margin / scale, scale,
                    (hi[0] - lo[0]) * scale + 2.0 * frame_margin, (hi[1] - lo[1]) * scale + 2.0 * frame_margin};
}

static double px(const window *f, const double *uv)
{
    return (uv[0] - f->x0) * f->scale;
}

static double py(const window *f, const double *uv)
{
    return (f->y0 - uv[1]) * f->scale;
}

static void draw_triangles(sl_writer *w, const abf_trace *t, const abf_frame *frame, const window *f)
{
    const sl_patch *p = t->pick->patch;
    for (int32_t k = 0; k < p->nt; k++) {
        const double *a = &frame->uv[2 * (int64_t)p->tri[3 * k]], *b = &frame->uv[2 * (int64_t)p->tri[3 * k + 1]],
                     *c = &frame->uv[2 * (int64_t)p->tri[3 * k + 2]];
        sl_writer_format(w, "<path d=\"M%.2f %.2fL%.2f %.2fL%.2f %.2fz\" class=\"q%d\"", px(f, a), py(f, a), px(f, b),
                         py(f, b), px(f, c), py(f, c), abf_residual_class(fabs(frame->residual[k])));
        if (p->nt > DOTTED) {
            sl_writer_text(w, "/>\n");
            continue;
        }
        const double *x = &frame->alpha[3 * (int64_t)k];
        sl_writer_format(w, "><title>triangle %d: %.4f, %.4f, %.4f degrees; g1 = %.2e</title></path>\n", k,
                         x[0] * degrees, x[1] * degrees, x[2] * degrees, frame->residual[k]);
    }
}

/* The border as one path of strokes. */
static void draw_border(sl_writer *w, const abf_trace *t, const abf_frame *frame, const window *f)
{
    const sl_patch *p = t->pick->patch;
    sl_writer_text(w, "<path class=\"border\" d=\"");
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        if (p->twin[c] < 0) {
            const double *a = &frame->uv[2 * (int64_t)p->tri[c]],
                         *b = &frame->uv[2 * (int64_t)p->tri[sl_corner_next(c)]];
            sl_writer_format(w, "M%.2f %.2fL%.2f %.2f", px(f, a), py(f, a), px(f, b), py(f, b));
        }
    }
    sl_writer_text(w, "\"/>\n");
}

static void draw_constraints(sl_writer *w, const abf_trace *t, const abf_frame *frame, const window *f)
{
    const abf_constraints *list = t->constraints;
    for (int32_t k = 0; k < list->count; k++) {
        const sl_constraint *c = &list->item[k];
        if (c->kind == SL_CONSTRAINT_STRAIGHT) {
            sl_writer_text(w, "<polyline class=\"line\" points=\"");
            for (int32_t v = 0; v < c->count; v++) {
                const double *a = &frame->uv[2 * (int64_t)c->vertex[v]];
                sl_writer_format(w, "%.2f,%.2f ", px(f, a), py(f, a));
            }
            sl_writer_text(w, "\"/>\n");
        }
        for (int32_t v = 0; c->kind != SL_CONSTRAINT_STRAIGHT && v < c->count; v++) {
            const double *a = &frame->uv[2 * (int64_t)c->vertex[v]];
            sl_writer_format(w,
                             "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"7\" fill=\"#f4c20d\" stroke=\"#6b5400\"><title>%s"
                             "</title></circle>\n",
                             px(f, a), py(f, a), list->text[k]);
        }
    }
}

/* The worst |g2| and |g3| of each vertex; -1 = it has none. */
static void vertex_residuals(const abf_trace *t, const abf_frame *frame, double *worst)
{
    const sl_patch *p = t->pick->patch;
    const double *g2 = frame->residual + p->nt, *g3 = g2 + t->sizes.sectors;
    for (int32_t v = 0; v < p->nv; v++) {
        worst[2 * (int64_t)v] = -1.0;
        worst[2 * (int64_t)v + 1] = p->border[v] ? -1.0 : fabs(*g3++);
    }
    for (int32_t s = 0; s < t->sizes.sectors; s++) {
        double *x = &worst[2 * (int64_t)t->table->vertex[s]];
        *x = fmax(*x, fabs(g2[s]));
    }
}

static void draw_vertices(sl_writer *w, const abf_trace *t, const abf_frame *frame, const window *f)
{
    const sl_patch *p = t->pick->patch;
    double *worst = sl_alloc(2 * (int64_t)p->nv, sizeof *worst);
    if (worst == NULL) {
        return; /* the writer goes on without the dots */
    }
    vertex_residuals(t, frame, worst);
    for (int32_t v = 0; v < p->nv; v++) {
        const double *r = &worst[2 * (int64_t)v], *a = &frame->uv[2 * (int64_t)v];
        if (r[0] < 0.0 && r[1] < 0.0 && p->nt > LABELLED) {
            continue;
        }
        sl_writer_format(w, "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"%.1f\" class=\"dot q%d\"><title>vertex %d", px(f, a),
                         py(f, a), p->nt <= LABELLED ? 4.0 : 2.2, abf_residual_class(fmax(r[0], r[1])),
                         t->pick->name[v]);
        if (r[0] >= 0.0) {
            sl_writer_format(w, "; |g2| = %.2e", r[0]);
        }
        if (r[1] >= 0.0) {
            sl_writer_format(w, "; |g3| = %.2e", r[1]);
        }
        sl_writer_text(w, "</title></circle>\n");
        if (p->nt <= LABELLED) {
            sl_writer_format(w, "<text x=\"%.2f\" y=\"%.2f\" class=\"v\">%d</text>\n", px(f, a) + 6.0, py(f, a) - 6.0,
                             t->pick->name[v]);
        }
        if (p->nt <= LABELLED && fmax(r[0], r[1]) >= 0.0) {
            sl_writer_format(w, "<text x=\"%.2f\" y=\"%.2f\" class=\"r\">", px(f, a) + 6.0, py(f, a) + 14.0);
            if (r[0] >= 0.0) {
                sl_writer_format(w, r[0] > 0.0 ? "g2 %.0e " : "g2 0 ", r[0]);
            }
            if (r[1] >= 0.0) {
                sl_writer_format(w, r[1] > 0.0 ? "g3 %.0e" : "g3 0", r[1]);
            }
            sl_writer_text(w, "</text>\n");
        }
    }
    sl_free(worst);
}

static void draw_angles(sl_writer *w, const abf_trace *t, const abf_frame *frame, const window *f)
{
    const sl_patch *p = t->pick->patch;
    for (int32_t c = 0; c < 3 * p->nt; c++) {
        const int32_t k = c / 3;
        const double *a = &frame->uv[2 * (int64_t)p->tri[c]];
        double m[2] = {0.0, 0.0};
        for (int32_t j = 0; j < 3; j++) {
            m[0] += frame->uv[2 * (int64_t)p->tri[3 * k + j]] / 3.0;
            m[1] += frame->uv[2 * (int64_t)p->tri[3 * k + j] + 1] / 3.0;
        }
        const double q[2] = {a[0] + label_inset * (m[0] - a[0]), a[1] + label_inset * (m[1] - a[1])};
        sl_writer_format(w, "<text x=\"%.2f\" y=\"%.2f\" class=\"a\">%.1f</text>\n", px(f, q), py(f, q) + 3.0,
                         frame->alpha[c] * degrees);
    }
}

void abf_svg_chart(sl_writer *w, const abf_trace *t, const abf_frame *frame)
{
    const sl_patch *p = t->pick->patch;
    if (frame->uv == NULL) {
        sl_writer_text(w, "<p>These angles cannot be laid out.</p>\n");
        return;
    }
    const window f = window_of(p->nv, frame->uv);
    sl_writer_format(w, "<svg class=\"chart\" viewBox=\"0 0 %.0f %.0f\" width=\"%.0f\" height=\"%.0f\" role=\"img\">\n",
                     f.width, f.height, f.width, f.height);
    sl_writer_format(w, "<g class=\"mesh\" stroke-width=\"%.2f\">\n", p->nt <= LABELLED ? 0.9 : 0.35);
    if (p->nt <= DRAWN) {
        draw_triangles(w, t, frame, &f);
    }
    sl_writer_text(w, "</g>\n");
    draw_border(w, t, frame, &f);
    draw_constraints(w, t, frame, &f);
    if (p->nt <= DOTTED) {
        draw_vertices(w, t, frame, &f);
    }
    if (p->nt <= LABELLED) {
        draw_angles(w, t, frame, &f);
    }
    sl_writer_text(w, "</svg>\n");
}

void abf_svg_matrix(sl_writer *w, const char *name, const sl_csc *A, bool symmetric)
{
    const double cell = 11.0;
    sl_writer_format(w,
                     "<figure><svg viewBox=\"-1 -1 %.0f %.0f\" width=\"%.0f\" height=\"%.0f\"><rect width=\"%.0f\" "
                     "height=\"%.0f\" class=\"sheet\"/>\n",
                     A->ncols * cell + 2, A->nrows * cell + 2, A->ncols * cell + 2, A->nrows * cell + 2,
                     A->ncols * cell, A->nrows * cell);
    for (int32_t j = 0; j < A->ncols; j++) {
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            for (int side_of = 0; side_of < (symmetric && A->row[p] != j ? 2 : 1); side_of++) {
                const int32_t x = side_of == 0 ? j : A->row[p], y = side_of == 0 ? A->row[p] : j;
                sl_writer_format(w,
                                 "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" class=\"%s\"><title>(%d, "
                                 "%d) = %.6g</title></rect>\n",
                                 x * cell + 1, y * cell + 1, cell - 2, cell - 2,
                                 A->val[p] == 0.0  ? "none"
                                 : A->val[p] > 0.0 ? "more"
                                                   : "less",
                                 y, x, A->val[p]);
            }
        }
    }
    sl_writer_format(w, "</svg><figcaption>%s: %d x %d, %lld entries stored</figcaption></figure>\n", name, A->nrows,
                     A->ncols, (long long)A->colptr[A->ncols]);
}

/* Classes q0 .. q12, from good to bad. */
static void write_ramp(sl_writer *w, const int good[3], const int bad[3])
{
    for (int32_t q = 0; q < ABF_RESIDUAL_CLASSES; q++) {
        int c[3];
        for (int k = 0; k < 3; k++) {
            c[k] = good[k] + (bad[k] - good[k]) * q / (ABF_RESIDUAL_CLASSES - 1);
        }
        sl_writer_format(w, ".q%d{--q:rgb(%d,%d,%d)}", q, c[0], c[1], c[2]);
    }
}

void abf_svg_style(sl_writer *w)
{
    static const int good[3] = {232, 240, 234}, bad[3] = {240, 128, 118};
    static const int good_dark[3] = {36, 56, 46}, bad_dark[3] = {166, 58, 50};
    sl_writer_text(w, ":root{--page:#fff;--card:#f2f4f6;--ink:#1d2126;--quiet:#545b64;--line:#dfe3e8;--blue:#2456c8;"
                      "--green:#1a7f4b;--red:#c62830;--violet:#7a3db8;--brown:#b86a00}\n");
    write_ramp(w, good, bad);
    sl_writer_text(w, "\n@media(prefers-color-scheme:dark){:root{--page:#14171a;--card:#1f2429;--ink:#e6e8eb;"
                      "--quiet:#a2abb5;--line:#363b42;--blue:#7aa5ff;--green:#5fd39b;--red:#ff8a80;--violet:#c79bff;"
                      "--brown:#f0b352}");
    write_ramp(w, good_dark, bad_dark);
    sl_writer_text(w, "}\nsvg text{font:11px system-ui,sans-serif;fill:var(--ink)}"
                      ".chart text{paint-order:stroke;stroke:var(--page);stroke-width:2.5px;stroke-linejoin:round}"
                      "svg .a{font-size:9.5px;text-anchor:middle}svg .v{font-weight:600}svg .r{font-size:8.5px;"
                      "fill:var(--red)}.mesh{stroke:#7d858f;stroke-linejoin:round}.mesh path,.dot{fill:var(--q)}"
                      ".dot{stroke:var(--quiet);stroke-width:.6}.border{fill:none;stroke:var(--ink);stroke-width:1.6;"
                      "stroke-linecap:round}.line{fill:none;stroke:var(--blue);stroke-width:3}"
                      ".sheet{fill:var(--page);stroke:var(--quiet)}.none{fill:var(--line)}.more{fill:var(--blue)}"
                      ".less{fill:var(--red)}.grid{stroke:var(--line)}.axis{fill:none;stroke:var(--quiet)}"
                      ".curve{fill:none;stroke:var(--c);stroke-width:2}.point{fill:var(--c)}"
                      ".ink{--c:var(--ink)}.blue{--c:var(--blue)}.green{--c:var(--green)}.red{--c:var(--red)}"
                      ".violet{--c:var(--violet)}.brown{--c:var(--brown)}\n");
}
