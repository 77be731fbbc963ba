/* The page of `seamlab abf --report`. */
#include "cli/abf_svg.h"

#include <math.h>
#include <string.h>

static const double degrees = 57.29577951308232;

enum { PICTURES = 60 }; /* layouts drawn at most: the first ones, and the last */

static const char style[] =
    "body{font:15px/1.5 system-ui,sans-serif;color:#1d2126;background:#fff;max-width:1180px;margin:2rem auto;padding:0 "
    "1rem}"
    "h1{font-size:1.7rem}h2{margin-top:2.2rem;border-bottom:1px solid #dfe3e8}"
    "table{border-collapse:collapse;font-size:13px;font-variant-numeric:tabular-nums}"
    "td,th{padding:.25rem .6rem;border-bottom:1px solid #e6e9ed;text-align:right;white-space:nowrap}"
    "td.l,th.l{text-align:left;white-space:normal}code{font-size:12.5px;background:#f2f4f6;padding:0 .25em}"
    ".scroll{overflow-x:auto}.steps{display:flex;flex-wrap:wrap;gap:1.2rem}figure{margin:0;border:1px solid #e6e9ed;"
    "padding:.6rem;border-radius:6px}figcaption{font-size:13px;color:#444a52}"
    "svg text{font:11px system-ui,sans-serif;fill:#333840}svg .a{font-size:9.5px;text-anchor:middle;fill:#14335f}"
    "svg text{paint-order:stroke;stroke:#fff;stroke-width:2.5px;stroke-linejoin:round}svg .v{font-weight:600}svg "
    ".r{font-size:8.5px;fill:#8c2027}.bar{display:inline-block;width:14px;height:14px;"
    "border:1px solid #8a929c;margin:0 .2em 0 .8em;vertical-align:-2px}@media print{figure{break-inside:avoid}}";

/* A line of the computation. */
typedef struct step_line {
    const char *what, *formula, *equation, *function, *file;
} step_line;

static const step_line steps[] = {
    {"angles measured on the surface", "&beta;<sub>c</sub> = atan2(|a &times; b|, a &middot; b), at least 0.1&deg;",
     "Sec. 4.1", "sl_abf_targets", "src/param/abf_targets.c"},
    {"optimal angles", "&phi; = 2&pi; &beta; / &Sigma;<sub>v</sub> &beta; inside, &beta; on the border", "Sec. 4.1",
     "sl_abf_targets", "src/param/abf_targets.c"},
    {"energy", "E = &Sigma; w (&alpha; &minus; &phi;)&sup2;, w = 1/&phi;&sup2; or 1", "(1)", "sl_abf_evaluate",
     "src/param/abf_newton.c"},
    {"triangles close", "g1(t) = &Sigma;<sub>t</sub> &alpha; &minus; &pi;", "(2)", "sl_abf_eval_g1",
     "src/param/abf_constraints.c"},
    {"vertices are flat; border angles and lines as asked",
     "g2(s) = &Sigma;<sub>s</sub> &alpha; &minus; &theta;<sub>s</sub>", "(3), (5), (6)", "sl_abf_eval_g2",
     "src/param/abf_constraints.c"},
    {"wheels close",
     "g3(v) = &Sigma; log sin &alpha;<sup>next</sup> &minus; &Sigma; log sin &alpha;<sup>prev</sup> (or a product "
     "difference, or the ratio &minus; 1)",
     "(4)", "sl_abf_eval_g3", "src/param/abf_constraints.c"},
    {"constraints asked for, as sectors",
     "S<sub>1</sub>, S<sub>2</sub>, ...: runs of corners with &theta; = &pi;, &pi;/2 or the angle given", "(5), (6)",
     "sl_constraints_compile", "src/param/constraints.c"},
    {"Jacobian J of g1, g2, g3", "1 in g1 and g2; &plusmn;cot &alpha; in g3 (times the products in the other forms)",
     "Newton", "sl_abf_system_linearise", "src/param/abf_system.c"},
    {"gradient of the Lagrangian", "&nabla;L = 2 w (&alpha; &minus; &phi;) + J&#8242; &lambda;", "Newton",
     "sl_abf_evaluate", "src/param/abf_newton.c"},
    {"Hessian", "&Lambda; = 2 diag(w); exact Newton adds &lambda;<sub>3</sub> times the curvature of g3", "Newton",
     "set_hessian", "src/param/abf_newton.c"},
    {"Schur complement once g1 is eliminated",
     "M = J<sub>2</sub> P J<sub>2</sub>&#8242;, P = D &minus; D1 1&#8242;D / 1&#8242;D1 per triangle, D = "
     "&Lambda;<sup>&minus;1</sup>",
     "ABF++", "sl_abf_system_assemble", "src/param/abf_assemble.c"},
    {"its Cholesky factor", "M = L L&#8242;, ordered once", "ABF++", "sl_cholesky_factor", "src/sparse/factor.c"},
    {"multipliers, then angles",
     "M &delta;&lambda;<sub>2</sub> = g + ..., &delta;&alpha; = &minus;P (&nabla;L + J<sub>2</sub>&#8242; "
     "&delta;&lambda;<sub>2</sub>) + ...",
     "ABF++", "sl_abf_newton_step", "src/param/abf_newton.c"},
    {"step length", "1, or 0.95 of the way to the first angle that would reach 0 or &pi;", "-", "sl_abf_newton_step",
     "src/param/abf_newton.c"},
    {"positions from angles", "least squares over all triangles, two border vertices held", "Sec. 4.1",
     "sl_reconstruct_solve", "src/param/reconstruct.c"},
};

static void write_escaped(sl_writer *w, const char *text)
{
    for (; *text != '\0'; text++) {
        switch (*text) {
        case '<':
            sl_writer_text(w, "&lt;");
            break;
        case '>':
            sl_writer_text(w, "&gt;");
            break;
        case '&':
            sl_writer_text(w, "&amp;");
            break;
        default:
            sl_writer_bytes(w, text, 1);
        }
    }
}

static void write_chart(sl_writer *w, const abf_trace *t)
{
    const sl_patch *p = t->pick->patch;
    const sl_abf_sizes *s = &t->sizes;
    sl_writer_text(w, "<p><b>");
    write_escaped(w, t->file);
    sl_writer_format(w,
                     "</b>, chart %d of %d: %d triangles, %d vertices (%d inside). Energy %s, g3 as %s, curvature of "
                     "the constraints %s.</p>\n",
                     t->pick->chart, t->pick->charts, p->nt, p->nv, s->wheels, abf_energy_name(t->def.energy),
                     abf_wheel_name(t->def.wheel), abf_newton_name(t->def.newton));
    sl_writer_format(w,
                     "<p>J has %lld rows (%d of g1, %d of g2, %d of g3), %d columns and %lld nonzeros; the Schur "
                     "complement %d rows and %lld nonzeros in its lower triangle, its factor %lld",
                     (long long)s->triangles + s->sectors + s->wheels, s->triangles, s->sectors, s->wheels, s->angles,
                     (long long)s->jacobian_nonzeros, s->schur_rows, (long long)s->schur_nonzeros,
                     (long long)s->factor_nonzeros);
    const int32_t dependent = abf_trace_last(t)->info.dependent;
    if (dependent > 0) {
        sl_writer_format(w, "; %d row%s of g2 follow%s from the others and %s left out", dependent,
                         dependent == 1 ? "" : "s", dependent == 1 ? "s" : "", dependent == 1 ? "is" : "are");
    }
    sl_writer_text(w, ".</p>\n");
}

static void write_constraints(sl_writer *w, const abf_trace *t)
{
    if (t->constraints->count == 0) {
        sl_writer_text(w, "<p>No constraint beyond a flat disk.</p>\n");
        return;
    }
    sl_writer_text(w, "<table><tr><th class=\"l\">constraint</th><th>angle off [deg]</th><th>off the line / size</th>"
                      "</tr>\n");
    for (int32_t k = 0; k < t->constraints->count; k++) {
        sl_writer_text(w, "<tr><td class=\"l\"><code>");
        write_escaped(w, t->constraints->text[k]);
        sl_writer_format(w, "</code></td><td>%.2e</td><td>%.2e</td></tr>\n", t->measure[k].angle * degrees,
                         t->measure[k].line);
    }
    sl_writer_text(w, "</table>\n");
}

static void write_iterations(sl_writer *w, const abf_trace *t)
{
    sl_writer_text(w, "<div class=\"scroll\"><table><tr><th>iteration</th><th>energy (1)</th><th>|&nabla;L|</th>"
                      "<th>max |g1| (2)</th><th>max |g2| (3)</th><th>max |g3| (4)</th><th>smallest angle</th>"
                      "<th>step</th><th>flipped</th></tr>\n");
    for (int32_t k = 0; k < t->count; k++) {
        const sl_abf_info *i = &t->frame[k].info;
        sl_writer_format(w,
                         "<tr><td>%d</td><td>%.10g</td><td>%.2e</td><td>%.2e</td><td>%.2e</td><td>%.2e</td>"
                         "<td>%.4f&deg;</td>",
                         i->iterations, i->energy, i->gradient, i->g1, i->g2, i->g3, i->min_angle * degrees);
        sl_writer_format(w, k > 0 ? "<td>%.4f</td>" : "<td>-</td>", i->step);
        sl_writer_format(w, "<td>%d</td></tr>\n", t->frame[k].flipped);
    }
    sl_writer_text(w, "</table></div>\n");
    const sl_abf_info *last = &abf_trace_last(t)->info;
    sl_writer_format(w,
                     "<p>How it ended: %s%s. Layout: stretch L2 %.6f, mean &sigma;<sub>1</sub>/&sigma;<sub>2</sub> "
                     "%.6f, largest %.4f.</p>\n",
                     abf_trace_verdict(t), last->floor ? ", at the rounding floor" : "", t->distortion.l2,
                     t->distortion.angle_mean, t->distortion.angle_max);
}

static void write_steps(sl_writer *w)
{
    sl_writer_text(w, "<div class=\"scroll\"><table><tr><th class=\"l\">what</th><th class=\"l\">formula</th>"
                      "<th class=\"l\">equation</th><th class=\"l\">C function</th><th class=\"l\">file</th></tr>\n");
    for (size_t k = 0; k < SL_COUNTOF(steps); k++) {
        sl_writer_format(w,
                         "<tr><td class=\"l\">%s</td><td class=\"l\">%s</td><td class=\"l\">%s</td><td class=\"l\">"
                         "<code>%s</code></td><td class=\"l\"><code>%s</code></td></tr>\n",
                         steps[k].what, steps[k].formula, steps[k].equation, steps[k].function, steps[k].file);
    }
    sl_writer_text(w, "</table></div>\n");
}

static void write_layouts(sl_writer *w, const abf_trace *t)
{
    char color[32];
    sl_writer_text(w, "<p>Triangles are coloured by |g1|, vertices by the worse of |g2| and |g3|:");
    for (int decade = -12; decade <= 0; decade += 3) {
        abf_residual_color(pow(10.0, decade), color);
        sl_writer_format(w, "<span class=\"bar\" style=\"background:%s\"></span>1e%d", color, decade);
    }
    sl_writer_text(w,
                   ". Blue: lines to be straight; yellow: vertices with a prescribed angle. Numbers in the corners "
                   "are angles in degrees; rest the pointer on anything for its numbers.</p>\n<div class=\"steps\">\n");
    for (int32_t k = 0; k < t->count; k++) {
        if (k >= PICTURES && k + 1 < t->count) {
            continue;
        }
        sl_writer_text(w, "<figure>\n");
        abf_svg_chart(w, t, &t->frame[k]);
        if (k == 0) {
            sl_writer_text(w, "<figcaption>start: &alpha; = &phi;</figcaption></figure>\n");
        } else {
            sl_writer_format(w, "<figcaption>after iteration %d: E = %.8g, |&nabla;L| = %.1e</figcaption></figure>\n",
                             t->frame[k].info.iterations, t->frame[k].info.energy, t->frame[k].info.gradient);
        }
    }
    sl_writer_text(w, "</div>\n");
}

sl_status abf_report_write(const abf_trace *t, const char *path, sl_diag *diag)
{
    sl_writer *w = NULL;
    const sl_status status = sl_writer_create(path, &w, diag);
    if (status != SL_OK) {
        return status;
    }
    sl_writer_text(w, "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
                      "content=\"width=device-width\"><title>ABF++ step by step</title><style>");
    sl_writer_text(w, style);
    sl_writer_text(w, "</style></head><body>\n<h1>ABF++ step by step</h1>\n");
    write_chart(w, t);
    write_constraints(w, t);
    sl_writer_text(w, "<h2>Iterations</h2>\n");
    write_iterations(w, t);
    sl_writer_text(w, "<div class=\"steps\">\n");
    abf_svg_convergence(w, t);
    abf_svg_progress(w, t);
    sl_writer_text(w, "</div>\n");
    sl_writer_text(w, "<h2>The chart after every iteration</h2>\n");
    write_layouts(w, t);
    if (t->J != NULL) {
        sl_writer_text(w, "<h2>The matrices of the last iteration</h2>\n<div class=\"steps\">\n");
        abf_svg_matrix(w, "J: rows g1, g2, g3; columns angles", t->J, false);
        abf_svg_matrix(w, "Schur complement: rows g2, g3", t->M, true);
        sl_writer_text(w, "</div>\n");
    }
    sl_writer_text(w, "<h2>What is computed, and where</h2>\n<p>Equation numbers are those of \"What you seam is what "
                      "you get\".</p>\n");
    write_steps(w);
    sl_writer_text(w, "</body></html>\n");
    return sl_writer_commit(w, diag);
}
