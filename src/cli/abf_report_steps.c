/* The computation of one iteration, line by line, each next to its equation, its C function and what came out. */
#include "cli/abf_svg.h"

#include <math.h>
#include <stdio.h>

static const double degrees = 57.29577951308232;

enum { LISTED = 60 }; /* triangles of charts whose angles are all listed */

/* Lines of the computation, in order. */
enum {
    MEASURED,
    OPTIMAL,
    ENERGY,
    TRIANGLES,
    SECTORS,
    WHEELS,
    ASKED,
    JACOBIAN,
    GRADIENT,
    HESSIAN,
    SCHUR,
    FACTOR,
    DIRECTION,
    STEP,
    POSITIONS
};

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

/* The largest |x| of a list and where it is. */
static double worst_of(const double *x, int64_t n, int64_t *at)
{
    double worst = 0.0;
    *at = 0;
    for (int64_t i = 0; i < n; i++) {
        if (!(fabs(x[i]) <= worst)) {
            worst = fabs(x[i]);
            *at = i;
        }
    }
    return worst;
}

static void range_of(const double *x, int64_t n, double *low, double *high)
{
    *low = HUGE_VAL;
    *high = -HUGE_VAL;
    for (int64_t i = 0; i < n; i++) {
        *low = fmin(*low, x[i]);
        *high = fmax(*high, x[i]);
    }
}

/* The input vertex of the k-th wheel: inner vertices in order. */
static int32_t wheel_vertex(const abf_trace *t, int64_t k)
{
    const sl_patch *p = t->pick->patch;
    for (int32_t v = 0; v < p->nv; v++) {
        if (p->border[v] == 0 && k-- == 0) {
            return t->pick->name[v];
        }
    }
    return -1;
}

static void value_of_targets(const abf_trace *t, int line, char *text, size_t size)
{
    double low, high;
    range_of(line == MEASURED ? t->beta : t->phi, 3 * (int64_t)t->pick->patch->nt, &low, &high);
    snprintf(text, size, "%.4f&deg; to %.4f&deg;", low * degrees, high * degrees);
}

static void value_of_residuals(const abf_trace *t, const abf_frame *f, int line, char *text, size_t size)
{
    const int32_t nt = t->pick->patch->nt, sectors = t->sizes.sectors;
    int64_t at;
    if (line == TRIANGLES) {
        const double worst = worst_of(f->residual, nt, &at);
        snprintf(text, size, worst > 0.0 ? "max %.3e, in triangle %lld" : "0 everywhere", worst, (long long)at);
    } else if (line == SECTORS) {
        const double worst = worst_of(f->residual + nt, sectors, &at);
        snprintf(text, size,
                 sectors == 0  ? "no sectors"
                 : worst > 0.0 ? "max %.3e, at vertex %d"
                               : "0 everywhere",
                 worst, sectors > 0 ? t->pick->name[t->table->vertex[at]] : 0);
    } else {
        const double worst = worst_of(f->residual + nt + sectors, t->sizes.wheels, &at);
        const char *said = worst > 0.0 ? "max %.3e, at vertex %d" : "0 everywhere";
        snprintf(text, size, t->sizes.wheels > 0 ? said : "no inner vertex", worst, wheel_vertex(t, at));
    }
}

static void value_of_matrices(const abf_trace *t, const abf_frame *f, int line, char *text, size_t size)
{
    const sl_abf_sizes *s = &t->sizes;
    const int64_t nc = 3 * (int64_t)t->pick->patch->nt;
    double low, high;
    switch (line) {
    case JACOBIAN:
        range_of(f->alpha, nc, &low, &high);
        snprintf(text, size, "%lld &times; %d, %lld nonzeros; cot &alpha; from %.3g to %.3g",
                 (long long)s->triangles + s->sectors + s->wheels, s->angles, (long long)s->jacobian_nonzeros,
                 1.0 / tan(high), 1.0 / tan(low));
        break;
    case HESSIAN:
        range_of(t->weight, nc, &low, &high);
        snprintf(text, size,
                 f->info.fallbacks > 0 ? "2 w from %.4g to %.4g; curvature dropped in %d triangles"
                                       : "2 w from %.4g to %.4g",
                 2.0 * low, 2.0 * high, f->info.fallbacks);
        break;
    case SCHUR:
        snprintf(text, size, "%d &times; %d, %lld nonzeros in the lower triangle", s->schur_rows, s->schur_rows,
                 (long long)s->schur_nonzeros);
        break;
    default:
        snprintf(text, size, "%lld nonzeros", (long long)s->factor_nonzeros);
    }
}

/* Of the step that led to frame k. */
static void value_of_step(const abf_trace *t, int32_t k, int line, char *text, size_t size)
{
    const abf_frame *f = &t->frame[k];
    if (f->info.iterations == 0 || k == 0) {
        snprintf(text, size, "no step yet");
        return;
    }
    if (line == STEP) {
        snprintf(text, size, "%.6g", f->info.step);
    } else {
        snprintf(text, size, "largest change of an angle %.4g&deg;", f->change * degrees);
    }
}

static void value_of(const abf_trace *t, int32_t k, int line, char *text, size_t size)
{
    const abf_frame *f = &t->frame[k];
    switch (line) {
    case MEASURED:
    case OPTIMAL:
        value_of_targets(t, line, text, size);
        break;
    case ENERGY:
        snprintf(text, size, "%.10g", f->info.energy);
        break;
    case TRIANGLES:
    case SECTORS:
    case WHEELS:
        value_of_residuals(t, f, line, text, size);
        break;
    case ASKED:
        snprintf(text, size, f->aside > 0.0 ? "%d sectors; targets %.4f&deg; from those asked for" : "%d sectors",
                 t->sizes.sectors, f->aside * degrees);
        break;
    case GRADIENT:
        snprintf(text, size, "max %.3e", f->info.gradient);
        break;
    case DIRECTION:
    case STEP:
        value_of_step(t, k, line, text, size);
        break;
    case POSITIONS:
        if (f->uv == NULL) {
            snprintf(text, size, "cannot be laid out");
        } else {
            snprintf(text, size, "%d flipped; angles differ by %.2e rad at most; area ratio %.3g", f->flipped,
                     f->angle_error, f->area_ratio);
        }
        break;
    default:
        value_of_matrices(t, f, line, text, size);
    }
}

/* Every angle of a small chart. */
static void list_angles(sl_writer *w, const abf_trace *t, const abf_frame *f)
{
    const sl_patch *p = t->pick->patch;
    if (p->nt > LISTED) {
        return;
    }
    sl_writer_text(w, "<details><summary>all angles</summary><div class=\"scroll\"><table><tr><th>triangle</th>"
                      "<th>vertices</th><th>&alpha; [deg]</th><th>&phi; [deg]</th><th>g1</th></tr>\n");
    for (int32_t k = 0; k < p->nt; k++) {
        const double *a = &f->alpha[3 * (int64_t)k], *phi = &t->phi[3 * (int64_t)k];
        const int32_t *v = &p->tri[3 * (int64_t)k];
        sl_writer_format(w, "<tr><td>%d</td><td>%d, %d, %d</td><td>%.6f, %.6f, %.6f</td>", k, t->pick->name[v[0]],
                         t->pick->name[v[1]], t->pick->name[v[2]], a[0] * degrees, a[1] * degrees, a[2] * degrees);
        sl_writer_format(w, "<td>%.6f, %.6f, %.6f</td><td>%.2e</td></tr>\n", phi[0] * degrees, phi[1] * degrees,
                         phi[2] * degrees, f->residual[k]);
    }
    sl_writer_text(w, "</table></div></details>\n");
}

void abf_report_steps(sl_writer *w, const abf_trace *t, int32_t k)
{
    char value[160];
    if (t->frame[k].dropped) {
        sl_writer_text(w, "<p class=\"quiet\">A long run on a large chart: this one was not kept.</p>\n");
        return;
    }
    sl_writer_text(w, "<div class=\"scroll\"><table><tr><th class=\"l\">what</th><th class=\"l\">value</th>"
                      "<th class=\"l\">formula</th><th class=\"l\">equation</th><th class=\"l\">C function</th>"
                      "</tr>\n");
    for (int line = 0; line < (int)SL_COUNTOF(steps); line++) {
        value_of(t, k, line, value, sizeof value);
        sl_writer_format(w,
                         "<tr><td class=\"l\">%s</td><td class=\"l n\">%s</td><td class=\"l\">%s</td>"
                         "<td class=\"l\">%s</td><td class=\"l\"><code title=\"%s\">%s</code></td></tr>\n",
                         steps[line].what, value, steps[line].formula, steps[line].equation, steps[line].file,
                         steps[line].function);
    }
    sl_writer_text(w, "</table></div>\n");
    list_angles(w, t, &t->frame[k]);
}
