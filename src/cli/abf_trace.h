/* `seamlab abf`: what the solver was like after every iteration; as JSON, in a terminal, as a page.
 * Layer: cli. */
#ifndef SL_CLI_ABF_TRACE_H
#define SL_CLI_ABF_TRACE_H

#include "cli/abf_pick.h"
#include "param/abf_chart.h"
#include "param/distortion.h"
#include "param/reconstruct.h"

#define ABF_KEPT_BYTES ((int64_t)1 << 29)

enum { ABF_MATRIX_TRIANGLES = 12 }; /* charts up to this many triangles are small: their matrices are shown */

/* The state after an iteration; number 0 is the start. */
typedef struct abf_frame {
    sl_abf_info info;
    double *alpha;      /* 3 nt */
    double *residual;   /* nt of g1, sectors of g2, wheels of g3 */
    double *uv;         /* nv x 2; NULL: the angles could not be laid out */
    int32_t flipped;    /* triangles of uv */
    double angle_error; /* largest |angle in uv - alpha| [rad] */
    double area_ratio;  /* largest over smallest of area in uv / area in space */
    int32_t solve;      /* 1, 2, ...: homotopy solves again and again, for targets nearer and nearer */
    double aside;       /* how far its targets are from those asked for, at most [rad] */
    double change;      /* largest |alpha - alpha of the frame before| [rad] */
    bool dropped;       /* alpha, residual and uv have been freed */
    bool held;          /* no step: what is held in the end, since the last solve came to nothing */
} abf_frame;

/* All of a run; what it points to is borrowed but for the frames and matrices (abf_trace_clear). */
typedef struct abf_trace {
    const char *file;
    const abf_pick *pick;
    const abf_constraints *constraints;
    const sl_sector_table *table;
    sl_abf_def def;
    sl_abf_chart_info chart; /* whether all targets were reached, and what is left; solves = 0: stepped by hand */
    sl_abf_sizes sizes;
    const double *beta;         /* 3 nt: angles measured on the surface */
    const double *phi, *weight; /* 3 nt: targets and weights of the energy */
    bool keep; /* somebody wants all frames whole; else the last one is. Runs beyond ABF_KEPT_BYTES drop some all the
                  same */
    int32_t count;
    abf_frame *frame;
    int64_t capacity, bytes;  /* bytes: of whole frames */
    sl_reconstruct *layout;   /* one analysis for all */
    sl_csc *J, *M;            /* of the last iteration, on charts that show them, else NULL */
    sl_distortion distortion; /* of the last layout */
    int32_t crossings;        /* of its border with itself: where the chart overlaps */
    sl_constraint_measure *measure;
} abf_trace;

/* Has anything been left short of what was asked for? */
static inline bool abf_trace_short(const abf_trace *trace)
{
    return trace->chart.solves > 0 && trace->chart.reached < 1.0;
}

/* How it ended, in a few words. */
const char *abf_trace_verdict(const abf_trace *trace);

/* Appends the solver's present state. */
SL_NODISCARD sl_status abf_trace_add(abf_trace *trace, const sl_abf *solver, const sl_context *context);

/* The last frame is no step: it belongs to the solve before it. */
static inline void abf_trace_hold(abf_trace *trace)
{
    trace->frame[trace->count - 1].held = true;
    trace->frame[trace->count - 1].solve = trace->count > 1 ? trace->frame[trace->count - 2].solve : 1;
}

/* Matrices, distortion and how well the constraints are met, once the last frame stands. */
SL_NODISCARD sl_status abf_trace_close(abf_trace *trace, const sl_abf *solver);

void abf_trace_clear(abf_trace *trace);

static inline const abf_frame *abf_trace_last(const abf_trace *trace)
{
    return &trace->frame[trace->count - 1];
}

/* Names for reports: as the options are called. */
const char *abf_energy_name(sl_abf_energy energy);
const char *abf_wheel_name(sl_abf_wheel wheel);
const char *abf_newton_name(sl_abf_newton newton);

/* Writes the trace as JSON, atomically ("-" = standard output). */
SL_NODISCARD sl_status abf_trace_write(const abf_trace *trace, const char *path, sl_diag *diag);

/* Writes the mesh with the last layout's UVs at the chart's corners, none elsewhere: as pinned, else in the unit
 * square. */
SL_NODISCARD sl_status abf_mesh_write(const abf_trace *trace, const char *path, sl_diag *diag);

/* Writes the page. */
SL_NODISCARD sl_status abf_report_write(const abf_trace *trace, const char *path, sl_diag *diag);

/* Terminal: what is solved, a line an iteration, how it ended, the matrices of a small chart. */
void abf_print_head(const abf_trace *trace);
void abf_print_frame(const abf_trace *trace, int32_t index);
void abf_print_matrix(const char *name, const sl_csc *A, bool symmetric);
void abf_print_end(const abf_trace *trace);

#endif
