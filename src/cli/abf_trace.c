#include "cli/abf_trace.h"

#include "base/file.h"
#include "base/memory.h"
#include "overlap/certificate.h"
#include "param/reconstruct.h"

#include <math.h>
#include <string.h>

static const char *const energy_name[] = {"weighted", "unweighted"};
static const char *const wheel_name[] = {"log", "product", "ratio"};
static const char *const newton_name[] = {"dropped", "exact"};

const char *abf_energy_name(sl_abf_energy energy)
{
    return energy_name[energy];
}

const char *abf_wheel_name(sl_abf_wheel wheel)
{
    return wheel_name[wheel];
}

const char *abf_newton_name(sl_abf_newton newton)
{
    return newton_name[newton];
}

const char *abf_trace_verdict(const abf_trace *trace)
{
    const sl_abf_info *last = &abf_trace_last(trace)->info;
    if (abf_trace_short(trace)) {
        return trace->chart.valid ? "stopped short of the targets" : "no valid chart was found";
    }
    return last->converged ? "converged"
           : last->stalled ? "stalled: no step keeps the angles positive"
                           : "not converged";
}

static void frame_clear(abf_frame *frame)
{
    sl_free(frame->alpha);
    sl_free(frame->residual);
    sl_free(frame->uv);
    frame->alpha = frame->residual = frame->uv = NULL;
}

void abf_trace_clear(abf_trace *trace)
{
    for (int32_t k = 0; k < trace->count; k++) {
        frame_clear(&trace->frame[k]);
    }
    sl_free(trace->frame);
    sl_reconstruct_free(trace->layout);
    sl_free(trace->measure);
    sl_csc_free(trace->J);
    sl_csc_free(trace->M);
    *trace = (abf_trace){0};
}

/* The layout of the frame's angles, moved to the pins. That angles cannot be laid out is no error: uv is then NULL. */
static sl_status lay_out(abf_trace *trace, abf_frame *frame, const sl_context *context)
{
    const sl_patch *patch = trace->pick->patch;
    sl_status status = SL_OK;
    frame->uv = sl_alloc(2 * (int64_t)patch->nv, sizeof *frame->uv);
    SL_TRY(frame->uv != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    if (trace->layout == NULL) {
        SL_TRY(sl_reconstruct_create(patch, &trace->layout));
    }
    SL_TRY(sl_reconstruct_solve(trace->layout, frame->alpha, context, frame->uv));
    SL_TRY(sl_pins_apply(patch, trace->constraints->pins, trace->constraints->pin, frame->uv, NULL));
    const sl_layout_quality quality = sl_layout_judge(patch, frame->alpha, frame->uv);
    frame->flipped = quality.flipped;
    frame->angle_error = quality.angle_error;
    frame->area_ratio = quality.area_ratio;
cleanup:
    if (status == SL_SINGULAR || status == SL_INFEASIBLE) {
        sl_free(frame->uv);
        frame->uv = NULL;
        status = SL_OK;
    }
    return status;
}

/* How far the angles went from the frame before; which is then dropped unless it is wanted and there is room. */
static void leave_last(abf_trace *trace, abf_frame *frame, int64_t doubles)
{
    const int64_t bytes = doubles * (int64_t)sizeof(double);
    if (trace->count > 0) {
        abf_frame *last = &trace->frame[trace->count - 1];
        for (int64_t c = 0; c < 3 * (int64_t)trace->pick->patch->nt; c++) {
            frame->change = fmax(frame->change, fabs(frame->alpha[c] - last->alpha[c]));
        }
        if (!trace->keep || trace->bytes + bytes > ABF_KEPT_BYTES) {
            frame_clear(last);
            last->dropped = true;
            trace->bytes -= bytes;
        }
    }
    trace->bytes += bytes;
}

sl_status abf_trace_add(abf_trace *trace, const sl_abf *solver, const sl_context *context)
{
    const sl_patch *patch = trace->pick->patch;
    sl_status status =
        sl_reserve((void **)&trace->frame, &trace->capacity, (int64_t)trace->count + 1, sizeof *trace->frame);
    if (status != SL_OK) {
        return status;
    }
    abf_frame *frame = &trace->frame[trace->count];
    *frame = (abf_frame){.info = *sl_abf_info_of(solver), .solve = trace->count > 0 ? abf_trace_last(trace)->solve : 0};
    frame->solve += frame->info.iterations == 0;
    trace->sizes = sl_abf_sizes_of(solver);
    const int64_t rows = (int64_t)patch->nt + trace->sizes.sectors + trace->sizes.wheels;
    frame->alpha = sl_copy(sl_abf_angles(solver), 3 * (int64_t)patch->nt, sizeof *frame->alpha);
    frame->residual = sl_alloc(rows, sizeof *frame->residual);
    SL_TRY(frame->alpha != NULL && frame->residual != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    sl_abf_eval_g1(patch, frame->alpha, frame->residual);
    for (int32_t s = 0; s < trace->sizes.sectors; s++) {
        frame->aside = fmax(frame->aside, fabs(sl_abf_prescribed(solver)[s] - trace->table->theta[s]));
    }
    sl_abf_eval_g2(&trace->table->view, frame->alpha, frame->residual + patch->nt);
    sl_abf_eval_g3(patch, trace->def.wheel, frame->alpha, frame->residual + patch->nt + trace->sizes.sectors);
    SL_TRY(lay_out(trace, frame, context));
    leave_last(trace, frame, 3 * (int64_t)patch->nt + rows + 2 * (int64_t)patch->nv);
    trace->count++;
    return SL_OK;
cleanup:
    frame_clear(frame);
    return status;
}

static sl_status copy_matrix(const sl_csc *A, sl_csc **out)
{
    const int64_t n = A->colptr[A->ncols];
    const sl_status status = sl_csc_create(A->nrows, A->ncols, n, out);
    if (status == SL_OK) {
        memcpy((*out)->colptr, A->colptr, ((size_t)A->ncols + 1) * sizeof *A->colptr);
        memcpy((*out)->row, A->row, (size_t)n * sizeof *A->row);
        memcpy((*out)->val, A->val, (size_t)n * sizeof *A->val);
    }
    return status;
}

/* How often the border of a layout crosses or touches itself. */
static sl_status count_crossings(const sl_patch *patch, const double *uv, int32_t *crossings)
{
    sl_status status = SL_OK;
    sl_certificate certificate;
    int32_t *first = NULL, *border = NULL, *pairs = NULL;
    SL_TRY(sl_patch_border(patch, &first, &border));
    const int32_t n = first[patch->loops];
    pairs = sl_alloc(2 * (int64_t)n, sizeof *pairs);
    SL_TRY(pairs != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    for (int32_t k = 0; k < n; k++) {
        pairs[2 * (int64_t)k] = patch->tri[border[k]];
        pairs[2 * (int64_t)k + 1] = patch->tri[sl_corner_next(border[k])];
    }
    SL_TRY(sl_certify_embedding(uv, patch->nt, patch->tri, n, pairs, &certificate));
    *crossings = certificate.border_crossings;
cleanup:
    sl_free(first);
    sl_free(border);
    sl_free(pairs);
    return status;
}

sl_status abf_trace_close(abf_trace *trace, const sl_abf *solver)
{
    const sl_patch *patch = trace->pick->patch;
    const abf_constraints *c = trace->constraints;
    const double *uv = abf_trace_last(trace)->uv;
    sl_status status = SL_OK;
    trace->measure = sl_calloc(c->count, sizeof *trace->measure);
    SL_TRY(trace->measure != NULL ? SL_OK : SL_OUT_OF_MEMORY);
    if (patch->nt <= ABF_MATRIX_TRIANGLES && trace->count > 1) {
        SL_TRY(sl_abf_jacobian(solver, &trace->J));
        SL_TRY(copy_matrix(sl_abf_schur(solver), &trace->M));
    }
    if (uv != NULL) {
        SL_TRY(sl_distortion_measure_indexed(patch->nt, patch->tri, patch->xyz, uv, &trace->distortion));
        sl_constraints_measure(patch, c->count, c->item, trace->table, uv, trace->measure);
        SL_TRY(count_crossings(patch, uv, &trace->crossings));
    }
cleanup:
    return status;
}

/* --- JSON */

static void write_array(sl_writer *w, const char *name, const double *x, int64_t n)
{
    sl_writer_format(w, "\"%s\":[", name);
    for (int64_t i = 0; i < n; i++) {
        sl_writer_text(w, i > 0 ? "," : "");
        sl_writer_double(w, x[i]);
    }
    sl_writer_text(w, "]");
}

static void write_ints(sl_writer *w, const char *name, const int32_t *x, int64_t n)
{
    sl_writer_format(w, "\"%s\":[", name);
    for (int64_t i = 0; i < n; i++) {
        sl_writer_text(w, i > 0 ? "," : "");
        sl_writer_int(w, x[i]);
    }
    sl_writer_text(w, "]");
}

static void write_number(sl_writer *w, const char *name, double x)
{
    sl_writer_format(w, "\"%s\":", name);
    sl_writer_double(w, x);
    sl_writer_text(w, ",");
}

static void write_text(sl_writer *w, const char *text)
{
    sl_writer_text(w, "\"");
    for (; *text != '\0'; text++) {
        if (*text == '"' || *text == '\\') {
            sl_writer_format(w, "\\%c", *text);
        } else if ((unsigned char)*text < 0x20) {
            sl_writer_format(w, "\\u%04x", (unsigned)(unsigned char)*text);
        } else {
            sl_writer_bytes(w, text, 1);
        }
    }
    sl_writer_text(w, "\"");
}

static void write_frame(sl_writer *w, const abf_trace *t, const abf_frame *f)
{
    const sl_patch *p = t->pick->patch;
    const sl_abf_info *i = &f->info;
    sl_writer_format(w, "{\"iteration\":%d,", i->iterations);
    write_number(w, "energy", i->energy);
    write_number(w, "gradient", i->gradient);
    write_number(w, "g1", i->g1);
    write_number(w, "g2", i->g2);
    write_number(w, "g3", i->g3);
    write_number(w, "minAngle", i->min_angle);
    write_number(w, "step", i->step);
    sl_writer_format(w, "\"solve\":%d,\"held\":%s,", f->solve, f->held ? "true" : "false");
    write_number(w, "targetsAside", f->aside);
    write_number(w, "layoutAngleError", f->angle_error);
    write_number(w, "layoutAreaRatio", f->area_ratio);
    sl_writer_format(w, "\"converged\":%s,\"stalled\":%s,\"floor\":%s,\"fallbacks\":%d,\"flipped\":%d,",
                     i->converged ? "true" : "false", i->stalled ? "true" : "false", i->floor ? "true" : "false",
                     i->fallbacks, f->flipped);
    if (f->dropped) {
        sl_writer_text(w, "\"dropped\":true}");
        return;
    }
    write_array(w, "angles", f->alpha, 3 * (int64_t)p->nt);
    sl_writer_text(w, ",");
    write_array(w, "residualG1", f->residual, p->nt);
    sl_writer_text(w, ",");
    write_array(w, "residualG2", f->residual + p->nt, t->sizes.sectors);
    sl_writer_text(w, ",");
    write_array(w, "residualG3", f->residual + p->nt + t->sizes.sectors, t->sizes.wheels);
    sl_writer_text(w, ",");
    if (f->uv != NULL) {
        write_array(w, "uv", f->uv, 2 * (int64_t)p->nv);
    } else {
        sl_writer_text(w, "\"uv\":null");
    }
    sl_writer_text(w, "}");
}

static void write_head(sl_writer *w, const abf_trace *t)
{
    const sl_patch *p = t->pick->patch;
    const sl_abf_sizes *s = &t->sizes;
    sl_writer_text(w, "{\"schema\":1,\"file\":");
    write_text(w, t->file);
    sl_writer_format(w, ",\"chart\":%d,\"charts\":%d,\"energyForm\":\"%s\",\"wheel\":\"%s\",\"newton\":\"%s\",",
                     t->pick->chart, t->pick->charts, abf_energy_name(t->def.energy), abf_wheel_name(t->def.wheel),
                     abf_newton_name(t->def.newton));
    sl_writer_format(w, "\"triangles\":%d,\"vertices\":%d,\"angles\":%d,\"sectors\":%d,\"wheels\":%d,", p->nt, p->nv,
                     s->angles, s->sectors, s->wheels);
    sl_writer_format(w,
                     "\"jacobianNonzeros\":%lld,\"schurRows\":%d,\"schurNonzeros\":%lld,\"factorNonzeros\":%lld,"
                     "\"dependent\":%d,\"constraints\":[",
                     (long long)s->jacobian_nonzeros, s->schur_rows, (long long)s->schur_nonzeros,
                     (long long)s->factor_nonzeros, abf_trace_last(t)->info.dependent);
    for (int32_t k = 0; k < t->constraints->count; k++) {
        sl_writer_text(w, k > 0 ? ",{\"text\":" : "{\"text\":");
        write_text(w, t->constraints->text[k]);
        sl_writer_text(w, ",");
        write_number(w, "angleError", t->measure[k].angle);
        sl_writer_text(w, "\"lineError\":");
        sl_writer_double(w, t->measure[k].line);
        sl_writer_text(w, "}");
    }
    sl_writer_text(w, "],");
    sl_writer_format(w, "\"borderCrossings\":%d,", t->crossings);
    if (t->chart.solves > 0) {
        sl_writer_format(w, "\"solves\":%d,", t->chart.solves);
        write_number(w, "reached", t->chart.reached);
        write_number(w, "distance", t->chart.distance);
    }
    write_ints(w, "triangleVertices", p->tri, 3 * (int64_t)p->nt);
    sl_writer_text(w, ",");
    write_ints(w, "inputVertex", t->pick->name, p->nv);
    sl_writer_text(w, ",");
    write_ints(w, "sectorVertex", t->table->vertex, s->sectors);
    sl_writer_text(w, ",");
    write_array(w, "theta", t->table->view.theta, s->sectors);
    sl_writer_text(w, ",");
    write_array(w, "phi", t->phi, 3 * (int64_t)p->nt);
    sl_writer_text(w, ",");
}

sl_status abf_trace_write(const abf_trace *trace, const char *path, sl_diag *diag)
{
    sl_writer *w = NULL;
    const sl_status status = sl_writer_create(path, &w, diag);
    if (status != SL_OK) {
        return status;
    }
    write_head(w, trace);
    sl_writer_text(w, "\"iterations\":[");
    for (int32_t k = 0; k < trace->count; k++) {
        sl_writer_text(w, k > 0 ? ",\n" : "\n");
        write_frame(w, trace, &trace->frame[k]);
    }
    sl_writer_text(w, "]}\n");
    return sl_writer_commit(w, diag);
}
