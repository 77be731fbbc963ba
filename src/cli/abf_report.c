/* The page of `seamlab abf --report`. */
#include "cli/abf_svg.h"

#include <math.h>
#include <stdio.h>

static const double degrees = 57.29577951308232;

/* Layouts drawn at most, the first ones and the last; fewer where charts are large: so many triangles in all. */
enum { PICTURES = 60, FEWEST = 3, DRAWN_TRIANGLES = 400000 };

static const char style[] =
    "body{font:15px/1.5 system-ui,sans-serif;color:var(--ink);background:var(--page);max-width:1280px;"
    "margin:2rem auto;padding:0 1rem}h1{font-size:1.7rem}h2{margin-top:2.2rem;border-bottom:1px solid var(--line)}"
    "h3{font-size:1.05rem;margin:.4rem 0}"
    "table{border-collapse:collapse;font-size:13px;font-variant-numeric:tabular-nums}"
    "td,th{padding:.25rem .6rem;border-bottom:1px solid var(--line);text-align:right;white-space:nowrap}"
    "td.l,th.l{text-align:left;white-space:normal}td.n{min-width:11em}"
    "code{font-size:12.5px;background:var(--card);padding:0 .25em;white-space:nowrap}.scroll{overflow-x:auto}"
    ".steps{display:flex;flex-wrap:wrap;gap:1.2rem}"
    "figure{margin:0;border:1px solid var(--line);padding:.6rem;border-radius:6px}"
    "figcaption,.quiet{font-size:13px;color:var(--quiet)}svg{max-width:100%;height:auto}"
    "pre{background:var(--card);padding:.8rem;overflow-x:auto;font-size:12px}"
    ".bar{display:inline-block;width:14px;height:14px;background:var(--q);border:1px solid var(--quiet);"
    "margin:0 .2em 0 .8em;vertical-align:-2px}"
    ".it{display:grid;grid-template-columns:minmax(300px,4fr) minmax(520px,7fr);gap:1.2rem;"
    "align-items:start;margin:1rem 0 2rem}.it>div{min-width:0}@media(max-width:900px){.it{display:block}}"
    "#player{position:sticky;top:0;background:var(--page);padding:.6rem 0;display:none;gap:.8rem;"
    "align-items:center;z-index:1;border-bottom:1px solid var(--line)}#player input{flex:1}"
    "button{font:inherit;padding:.15rem .8rem}.js #player{display:flex}.js .it{display:none}"
    ".js .it.on{display:grid}@media(max-width:900px){.js .it.on{display:block}}@media print{.js .it{display:grid}"
    "#player{display:none!important}figure{break-inside:avoid}}";

/* Shows one iteration at a time; without it all stand one below the other. */
static const char script[] =
    "const its=[...document.querySelectorAll('.it')],bar=document.getElementById('at'),"
    "label=document.getElementById('which');document.body.classList.add('js');"
    "function show(k){k=Math.max(0,Math.min(its.length-1,k));its.forEach((s,i)=>s.classList.toggle('on',i===k));"
    "bar.value=k;label.textContent=its[k].dataset.name}"
    "bar.max=its.length-1;bar.oninput=()=>show(+bar.value);"
    "document.getElementById('back').onclick=()=>show(+bar.value-1);"
    "document.getElementById('on').onclick=()=>show(+bar.value+1);"
    "document.onkeydown=e=>{if(e.target!==bar&&e.key==='ArrowLeft')show(+bar.value-1);"
    "if(e.target!==bar&&e.key==='ArrowRight')show(+bar.value+1)};show(its.length-1);";

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
    const bool again = abf_trace_last(t)->solve > 1;
    sl_writer_text(w, "<div class=\"scroll\"><table><tr>");
    sl_writer_text(w, again ? "<th>solve</th><th>targets off [deg]</th>" : "");
    sl_writer_text(w, "<th>iteration</th><th>energy (1)</th><th>|&nabla;L|</th>"
                      "<th>max |g1| (2)</th><th>max |g2| (3)</th><th>max |g3| (4)</th><th>smallest angle</th>"
                      "<th>step</th><th>flipped</th></tr>\n");
    for (int32_t k = 0; k < t->count; k++) {
        const sl_abf_info *i = &t->frame[k].info;
        sl_writer_text(w, "<tr>");
        if (again) {
            sl_writer_format(w, "<td>%d</td><td>%.4f</td>", t->frame[k].solve, t->frame[k].aside * degrees);
        }
        sl_writer_format(w,
                         "<td>%d</td><td>%.10g</td><td>%.2e</td><td>%.2e</td><td>%.2e</td><td>%.2e</td>"
                         "<td>%.4f&deg;</td>",
                         i->iterations, i->energy, i->gradient, i->g1, i->g2, i->g3, i->min_angle * degrees);
        sl_writer_format(w, i->iterations > 0 ? "<td>%.4f</td>" : "<td>-</td>", i->step);
        sl_writer_format(w, "<td>%d</td></tr>\n", t->frame[k].flipped);
    }
    sl_writer_text(w, "</table></div>\n");
    const sl_abf_info *last = &abf_trace_last(t)->info;
    sl_writer_format(w,
                     "<p>How it ended: %s%s. Layout: stretch L2 %.6f, mean &sigma;<sub>1</sub>/&sigma;<sub>2</sub> "
                     "%.6f, largest %.4f.</p>\n",
                     abf_trace_verdict(t), last->floor ? ", at the rounding floor" : "", t->distortion.l2,
                     t->distortion.angle_mean, t->distortion.angle_max);
    if (t->crossings > 0) {
        sl_writer_format(w, "<p>The chart overlaps itself: its border crosses itself %d times.</p>\n", t->crossings);
    }
}

/* How frame k is called: "start", "iteration 3", "solve 2, iteration 1". */
static void name_frame(const abf_trace *t, int32_t k, char name[64])
{
    const abf_frame *f = &t->frame[k];
    const int32_t i = f->info.iterations;
    char solve[32] = "";
    if (abf_trace_last(t)->solve > 1) {
        snprintf(solve, sizeof solve, "solve %d, ", f->solve);
    }
    if (f->held) {
        snprintf(name, 64, "back to the last valid state");
    } else if (i == 0) {
        snprintf(name, 64, f->solve > 1 ? "%sstart" : "%sstart: alpha = phi", solve);
    } else {
        snprintf(name, 64, "%siteration %d", solve, i);
    }
}

static void write_legend(sl_writer *w)
{
    sl_writer_text(w, "<p>Triangles are coloured by |g1|, vertices by the worse of |g2| and |g3|:");
    for (int decade = -12; decade <= 0; decade += 3) {
        sl_writer_format(w, "<span class=\"bar q%d\"></span>1e%d", abf_residual_class(pow(10.0, decade)), decade);
    }
    sl_writer_text(w,
                   ". Blue: lines to be straight; yellow: vertices with a prescribed angle. Numbers in the corners "
                   "are angles in degrees; rest the pointer on anything for its numbers. Equation numbers are those of "
                   "\"What you seam is what you get\"; the files are those of the program's sources.</p>\n");
}

/* Every iteration: the chart, and the computation line by line with what came out. */
static void write_frames(sl_writer *w, const abf_trace *t)
{
    const int32_t nt = t->pick->patch->nt, many = DRAWN_TRIANGLES / (nt > 0 ? nt : 1);
    const int32_t pictures = many < FEWEST ? FEWEST : many < PICTURES ? many : PICTURES;
    char name[64];
    write_legend(w);
    sl_writer_text(w, "<div id=\"player\"><button id=\"back\" type=\"button\">&larr;</button><input id=\"at\" "
                      "type=\"range\" min=\"0\" value=\"0\" aria-label=\"iteration\"><button id=\"on\" "
                      "type=\"button\">&rarr;</button><b id=\"which\"></b></div>\n");
    for (int32_t k = 0; k < t->count; k++) {
        name_frame(t, k, name);
        sl_writer_format(w, "<section class=\"it\" data-name=\"%s\"><div><h3>%s</h3>\n", name, name);
        if (!t->frame[k].dropped && (k < pictures || k + 1 == t->count)) {
            sl_writer_text(w, "<figure>\n");
            abf_svg_chart(w, t, &t->frame[k]);
            sl_writer_text(w, "</figure>\n");
        } else {
            sl_writer_text(w, "<p class=\"quiet\">The first layouts and the last one are drawn.</p>\n");
        }
        sl_writer_text(w, "</div><div>\n");
        abf_report_steps(w, t, k);
        sl_writer_text(w, "</div></section>\n");
    }
}

/* The convergence plot as a script that gnuplot draws. */
static void write_gnuplot(sl_writer *w, const abf_trace *t)
{
    sl_writer_text(w, "<details><summary>The same for gnuplot</summary><pre>set terminal svg\nset output "
                      "'convergence.svg'\nset logscale y\nset format y '1e%T'\nset xlabel 'iteration'\n$it &lt;&lt; "
                      "EOD\n# k energy grad g1 g2 g3 smallest-angle step\n");
    for (int32_t k = 0; k < t->count; k++) {
        const sl_abf_info *i = &t->frame[k].info;
        sl_writer_format(w, "%d %.9g %.3e %.3e %.3e %.3e %.6f %.4f\n", k, i->energy, i->gradient, i->g1, i->g2, i->g3,
                         i->min_angle * degrees, i->step);
    }
    sl_writer_text(w, "EOD\nplot for [c=3:6] $it using 1:c with linespoints title word('|grad| g1 g2 g3', c-2)\n"
                      "</pre></details>\n");
}

sl_status abf_report_write(const abf_trace *t, const char *path, sl_diag *diag)
{
    sl_writer *w = NULL;
    const sl_status status = sl_writer_create(path, &w, diag);
    if (status != SL_OK) {
        return status;
    }
    sl_writer_text(w, "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
                      "content=\"width=device-width\"><meta name=\"color-scheme\" content=\"light dark\"><title>ABF++ "
                      "step by step</title><style>");
    abf_svg_style(w);
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
    write_gnuplot(w, t);
    sl_writer_text(w, "<h2>Iteration by iteration</h2>\n");
    write_frames(w, t);
    if (t->J != NULL) {
        sl_writer_text(w, "<h2>The matrices of the last iteration</h2>\n<div class=\"steps\">\n");
        abf_svg_matrix(w, "J: rows g1, g2, g3; columns angles", t->J, false);
        abf_svg_matrix(w, "Schur complement: rows g2, g3", t->M, true);
        sl_writer_text(w, "</div>\n");
    }
    sl_writer_text(w, "<script>");
    sl_writer_text(w, script);
    sl_writer_text(w, "</script>\n");
    sl_writer_text(w, "</body></html>\n");
    return sl_writer_commit(w, diag);
}
