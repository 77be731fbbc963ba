/* One chart into the plane, by the first method that gives a valid result.
 * Layer: param. */
#ifndef SL_PARAM_FLATTEN_H
#define SL_PARAM_FLATTEN_H

#include "overlap/certificate.h"
#include "param/abf.h"
#include "param/constraints.h"
#include "param/distortion.h"
#include "param/stretch.h"

typedef enum sl_flatten_method {
    SL_FLATTEN_NONE,     /* not a disk, or nothing worked */
    SL_FLATTEN_ABF,      /* ABF++ */
    SL_FLATTEN_LSCM,     /* least squares conformal */
    SL_FLATTEN_TUTTE,    /* Tutte's embedding: reported as a fallback */
    SL_FLATTEN_PLANAR,   /* one facet, or coplanar: projected */
    SL_FLATTEN_OPTIMISED /* by the caller: a flip-free map that came with the cuts */
} sl_flatten_method;

/* Why a chart is not valid. */
typedef enum sl_flatten_verdict {
    SL_CHART_VALID,
    SL_CHART_NOT_A_DISK,
    SL_CHART_NOT_CONVERGED,
    SL_CHART_FLIPPED,
    SL_CHART_OVERLAPS,
    SL_CHART_STRETCHED, /* L2 above the bound */
    SL_CHART_SHEARED    /* the mean of s1/s2 above the bound */
} sl_flatten_verdict;

/* What a user asks of a chart; arrays borrowed; all zero = nothing. */
typedef struct sl_flatten_wishes {
    int32_t constraint_count;
    const sl_constraint *constraint;
    int32_t pin_count;
    const sl_pin *pin;
} sl_flatten_wishes;

typedef struct sl_flatten_def {
    sl_abf_def abf;
    bool minimise_stretch; /* after ABF++ (or Tutte), while L2 exceeds max_stretch: flip-free minimisation; default true
                            */
    bool tutte;            /* Tutte as last resort where ABF++ fails; default true */
    double max_stretch;    /* tau, the bound on L2; default 1.5; infinite = none */
    double max_angle;      /* bound on the area-weighted mean of s1/s2, above 1; default infinite = none */
    bool polish; /* minimise a chart that ABF++ made valid, too: less stretch for some shear within max_angle; default
                    false */
    sl_stretch_def stretch;
    sl_flatten_wishes wishes; /* default none */
} sl_flatten_def;

sl_flatten_def sl_flatten_default(void);

typedef struct sl_flatten_result {
    sl_flatten_verdict verdict;
    sl_flatten_method method; /* where the map came from */
    bool stretch_minimised;   /* and was it refined afterwards */
    sl_distortion distortion; /* of the map given back */
    sl_certificate certificate;
    bool constrained;    /* the map keeps the constraints asked for (true when none were) */
    double pin_distance; /* of the pin furthest from its place [uv units]; 0 = all are there */
    sl_abf_info abf;
    double foreseen_l2; /* of ABF++'s map of a coarse mesh of a large chart, 0 or 1 = not known: where it is above 10,
                         * ABF++ and LSCM were not tried on the chart itself, and abf says nothing */
    sl_stretch_info stretch;
} sl_flatten_result;

/* A short fixed name for reports. */
const char *sl_flatten_method_name(sl_flatten_method method);
const char *sl_flatten_verdict_name(sl_flatten_verdict verdict);

/* uv: nv x 2, scaled to the patch's 3D area, holds the best map found whatever the verdict (all zero when none), and
 * the verdict is that map's: an embedding that is too stretched goes before one that overlaps, that before one with
 * flips. An invalid chart is an outcome, not an error. SL_BAD_INPUT, SL_INFEASIBLE (constraints or pins, as
 * sl_constraints_compile says; uv is then zero), SL_OUT_OF_MEMORY, SL_CANCELLED, SL_INTERNAL. Deterministic.
 *
 * def->wishes: ABF++ and what is minimised from its map keep the constraints, the other methods do not
 * (result->constrained). Pins are served last, two by a similarity, more by the minimiser, and the scale is then
 * theirs.
 *
 * Charts of 8000 triangles and more whose coarse mesh shows that a conformal map would stretch too much to be refined
 * (result->foreseen_l2) go straight to the minimisation. Tried in turn until one is valid: projection (vertices within
 * 1e-12 of the extent from one plane); ABF++; LSCM where that did not converge or flipped; flip-free minimisation with
 * a simple border, from that map if it is an embedding of L2 at most 3, else from coarse meshes (sl_stretch_unfold;
 * reported as Tutte's, whose embedding it begins with). The minimiser stops 4 % of the way from max_stretch to 1, or
 * when it is hopeless (stretch.hopeless_*; where those are 0, values of the chain's own). A chart within the first
 * bound but not the second is minimised on with weights below 0. With polish a conformal map that is valid is minimised
 * to the end and replaced by what comes out if that is valid and stretches less. With minimise_stretch and tutte both
 * off: the plain ABF++ verdict.
 *
 * Valid: a disk, the map converged, every triangle positive by exact predicate, border simple, L2 <= max_stretch,
 * mean s1/s2 <= max_angle.
 * A single-facet patch is exempt from the stretch bound; without area it is valid as one point (method PLANAR). Charts
 * with 3D-degenerate triangles are judged without them for stretch. */
SL_NODISCARD sl_status sl_flatten(const sl_patch *patch, const sl_flatten_def *def, const sl_context *context,
                                  double *uv, sl_flatten_result *result);

/* Minimises the stretch of a flip-free map that keeps constraints, and keeps them: lines stay straight and do not turn,
 * so that the angles between them stay, too; a prescribed angle of the border stays by the directions of its edges.
 * Pins, any number, are brought to their places: first by the similarity that fits best, then by the minimiser.
 * def->line and def->pin are not looked at. uv: in and out; unchanged on failure. SL_BAD_INPUT (flips, lines that are
 * not straight in uv or run on into each other, pins on lines, other constraints that cannot be), SL_INFEASIBLE (as
 * sl_constraints_compile), SL_OUT_OF_MEMORY, SL_CANCELLED. info may be NULL. */
SL_NODISCARD sl_status sl_flatten_relax(const sl_patch *patch, const sl_stretch_def *def,
                                        const sl_flatten_wishes *wishes, const sl_context *context, double *uv,
                                        sl_stretch_info *info);

#endif
