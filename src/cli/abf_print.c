#include "cli/abf_trace.h"

#include <math.h>
#include <stdio.h>

static const double degrees = 57.29577951308232;

void abf_print_head(const abf_trace *t)
{
    const sl_patch *p = t->pick->patch;
    const sl_abf_sizes *s = &t->sizes;
    printf("chart: %d triangles, %d vertices, %d of them inside; energy %s, g3 as %s, curvature %s\n", p->nt, p->nv,
           s->wheels, abf_energy_name(t->def.energy), abf_wheel_name(t->def.wheel), abf_newton_name(t->def.newton));
    printf("J: %lld rows (g1 %d, g2 %d, g3 %d) x %d angles, %lld nonzeros\n",
           (long long)s->triangles + s->sectors + s->wheels, s->triangles, s->sectors, s->wheels, s->angles,
           (long long)s->jacobian_nonzeros);
    printf("Schur complement: %d x %d, %lld nonzeros in its lower triangle", s->schur_rows, s->schur_rows,
           (long long)s->schur_nonzeros);
    const int32_t dependent = abf_trace_last(t)->info.dependent;
    printf(dependent > 0 ? "; %d dependent row%s left out\n" : "\n", dependent, dependent == 1 ? "" : "s");
    for (int32_t k = 0; k < t->constraints->count; k++) {
        printf("constraint %d: %s\n", k + 1, t->constraints->text[k]);
    }
    printf("\n%4s %14s %10s %10s %10s %10s %10s %9s %7s\n", "it", "energy", "|grad|", "max |g1|", "max |g2|",
           "max |g3|", "min angle", "step", "flipped");
}

void abf_print_frame(const abf_trace *t, int32_t index)
{
    const abf_frame *f = &t->frame[index];
    const sl_abf_info *i = &f->info;
    char step[16] = "-", flipped[16] = "-";
    if (f->held) {
        printf("     back to the last valid state:\n");
    } else if (i->iterations == 0 && f->solve > 1) {
        printf("     solve %d, for targets at most %.4f degrees from those asked for:\n", f->solve, f->aside * degrees);
    }
    if (i->iterations > 0) {
        snprintf(step, sizeof step, "%.4f", i->step);
    }
    if (f->uv != NULL) {
        snprintf(flipped, sizeof flipped, "%d", f->flipped);
    }
    printf("%4d %14.8g %10.2e %10.2e %10.2e %10.2e %10.4f %9s %7s", i->iterations, i->energy, i->gradient, i->g1, i->g2,
           i->g3, i->min_angle * degrees, step, flipped);
    printf(i->fallbacks > 0 ? "  curvature dropped in %d triangles\n" : "\n", i->fallbacks);
    fflush(stdout);
}

static double entry(const sl_csc *A, int32_t i, int32_t j, bool symmetric)
{
    const int32_t row = symmetric && i < j ? j : i, column = symmetric && i < j ? i : j;
    for (int64_t p = A->colptr[column]; p < A->colptr[column + 1]; p++) {
        if (A->row[p] == row) {
            return A->val[p];
        }
    }
    return 0.0;
}

void abf_print_matrix(const char *name, const sl_csc *A, bool symmetric)
{
    printf("\n%s =\n", name);
    for (int32_t i = 0; i < A->nrows; i++) {
        for (int32_t j = 0; j < A->ncols; j++) {
            const double x = entry(A, i, j, symmetric);
            if (x == 0.0) {
                printf(" %6s", ".");
            } else {
                printf(fabs(x) < 99.995 ? " %6.3f" : " %6.0f", x);
            }
        }
        putchar('\n');
    }
}

void abf_print_end(const abf_trace *t)
{
    const abf_frame *f = abf_trace_last(t);
    const sl_distortion *d = &t->distortion;
    const int32_t iterations = t->chart.solves > 0 ? t->chart.iterations : f->info.iterations;
    printf("\n%s after %d iteration%s%s\n", abf_trace_verdict(t), iterations, iterations == 1 ? "" : "s",
           f->info.floor ? ", at the rounding floor" : "");
    if (t->chart.solves > 1) {
        printf("%d solves: the targets were approached from the chart without constraints\n", t->chart.solves);
    }
    if (abf_trace_short(t)) {
        printf("reached %.2f %% of the way; %.4f degrees are left at the worst vertex\n", 100.0 * t->chart.reached,
               t->chart.distance * degrees);
    }
    if (f->uv == NULL) {
        printf("these angles cannot be laid out\n");
        return;
    }
    printf("layout: flipped %d, L2 %.6f, mean s1/s2 %.6f, max %.4f\n", f->flipped, d->l2, d->angle_mean, d->angle_max);
    printf("its angles are those of the solver to %.1e rad, at an area ratio of %.3g\n", f->angle_error, f->area_ratio);
    if (t->crossings > 0) {
        printf("the chart overlaps itself: its border crosses itself %d time%s\n", t->crossings,
               t->crossings == 1 ? "" : "s");
    }
    for (int32_t k = 0; k < t->constraints->count; k++) {
        printf("constraint %d: off by %.2e degrees", k + 1, t->measure[k].angle * degrees);
        printf(t->constraints->item[k].kind == SL_CONSTRAINT_STRAIGHT ||
                       t->constraints->item[k].kind == SL_CONSTRAINT_POLYGON
                   ? ", %.2e of the chart's size from straight\n"
                   : "\n",
               t->measure[k].line);
    }
}
