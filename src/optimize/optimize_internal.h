/* What the optimiser's files share: the surface, its charts, trials.
 * Layer: optimize (private). */
#ifndef SL_OPTIMIZE_INTERNAL_H
#define SL_OPTIMIZE_INTERNAL_H

#include "graph/csr.h"
#include "mesh/patch.h"
#include "optimize/optimize.h"
#include "param/stretch.h"

/* The piece to be cut, as triangles. Halfedges are those of `patch`: corner c = 3 t + k. */
typedef struct sl_opt_surface {
    const sl_mesh *mesh;  /* borrowed: the polygons */
    const double *weight; /* borrowed: mesh->nh, NULL = 1 */
    sl_patch *patch;
    double *length;    /* 3 nt: of a halfedge */
    double *cost;      /* 3 nt: of cutting it, length times weight; HUGE_VAL inside a polygon */
    double *rest;      /* 3 nt: x1, x2, y2 of a triangle laid flat: (0, 0), (x1, 0), (x2, y2) */
    double *area;      /* nt */
    uint8_t *measured; /* nt: 0 where the triangle is degenerate and counts nowhere */
    double total;      /* area measured */
    double unit;       /* sqrt(total): lengths are weighed in this unit */
} sl_opt_surface;

/* mesh and weight must outlive the surface. weight: mesh->nh factors on the lengths, NULL = 1. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_opt_surface_init(const sl_mesh *mesh, const sl_triangulation *triangulation,
                                           const double *weight, sl_opt_surface *out);
void sl_opt_surface_clear(sl_opt_surface *surface);

/* Weights of a whole mesh's edges, their mean but for diagonals 1, owned by the caller; NULL where all strengths are 0
 * and no pairs are wanted. Pairs are those of `pairing`. Statuses of sl_seam_cost_compute. */
SL_NODISCARD sl_status sl_opt_weights(const sl_mesh *mesh, const sl_seam_cost_def *def, sl_pairing pairing,
                                      const sl_context *context, double **weight);

/* Sums over the triangles of a chart. */
typedef struct sl_opt_sums {
    double space, plane; /* areas A, a */
    double inverse;      /* I */
    double shear;        /* integral of s1/s2 - 1 */
} sl_opt_sums;

/* q = sqrt(I a) - A. */
double sl_opt_stretch(const sl_opt_sums *sums);

/* The scale at which a chart adds least to the atlas's L2: I and a agree. */
double sl_opt_best_scale(const sl_opt_sums *sums);

/* A chart: patch->corner and patch->facet are halfedges and triangles of the surface. */
typedef struct sl_opt_chart {
    sl_patch *patch;
    double *uv; /* patch->nv x 2 */
    sl_opt_sums sums;
    int32_t stamp; /* differs whenever the chart does */
} sl_opt_chart;

void sl_opt_chart_clear(sl_opt_chart *chart);
/* SL_OUT_OF_MEMORY: to be cleared all the same. */
SL_NODISCARD sl_status sl_opt_chart_copy(const sl_opt_chart *chart, sl_opt_chart *out);

/* density: nullable, patch->nt x 2: each triangle's share of q, of the shear. */
void sl_opt_measure(const sl_opt_surface *surface, const sl_patch *patch, const double *uv, sl_opt_sums *sums,
                    double *density);

/* The triangles list[0 .. count - 1] of the surface, unglued along cut edges; local: surface nt work, all -1 before and
 * after. One component is the caller's part. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_opt_extract(const sl_opt_surface *surface, const uint8_t *cut, const int32_t *list,
                                      int32_t count, int32_t *local, sl_patch **out);

/* The state: which edges are cut, and the charts that makes. */
typedef struct sl_opt_state {
    const sl_opt_surface *surface;
    const sl_optimize_def *def;
    const sl_context *context;
    sl_context quiet;  /* for what runs side by side */
    uint8_t *cut;      /* 3 nt, the same for both halfedges of an edge */
    uint8_t *keep;     /* 3 nt: never to be sewn */
    double *uv;        /* 3 nt x 2: of a corner, in its chart's frame */
    int32_t *chart_of; /* nt */
    sl_opt_chart *chart;
    int64_t nchart, capacity;
    int32_t next_stamp;
    double most_price; /* cuts that make seams and charts cost more are none; HUGE_VAL unless seams are made again */
    double room;       /* what a cut may cost then, as things stand */
    bool machined;     /* creases part the surface into few, nearly developable parts */
    double w;          /* of the energy */
    double cost[2];    /* what q / A and shear / A weigh: see sl_opt_weigh */
    sl_optimize_info info;
} sl_opt_state;

/* The atlas as a whole. */
typedef struct sl_opt_total {
    double stretch, angle; /* L2 and mean s1/s2 */
    double length;         /* of the seams over sqrt(area) */
    double worst;          /* L2 of the worst chart */
    bool charts_within;    /* every chart is within what one may be */
} sl_opt_total;

SL_NODISCARD sl_status sl_opt_state_init(const sl_opt_surface *surface, const sl_optimize_def *def,
                                         const sl_context *context, sl_opt_state *out);
void sl_opt_state_clear(sl_opt_state *state);
/* A deep copy, to come back to. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_opt_state_copy(const sl_opt_state *state, sl_opt_state *out);
void sl_opt_totals(const sl_opt_state *state, sl_opt_total *out);
bool sl_opt_within(const sl_opt_state *state, const sl_opt_total *total);
/* Within max_stretch and max_angle? */
bool sl_opt_chart_within(const sl_opt_state *state, const sl_opt_sums *sums);
/* Chooses what stretch and shear weigh from how far each is from its target. */
void sl_opt_weigh(sl_opt_state *state);
double sl_opt_loss(const sl_opt_state *state, const sl_opt_sums *sums);

/* A change of some edges' flags and the charts that come of it. */
typedef struct sl_opt_trial {
    int32_t *edge; /* nedge halfedges, one an edge; owned */
    int32_t nedge;
    bool sew;         /* else they are cut */
    int32_t nback;    /* ... but for the first so many, which are sewn: a seam moves */
    int32_t old[2];   /* charts that it replaces; -1 = only one */
    sl_opt_chart *to; /* nto, owned */
    int32_t nto;
    bool valid;   /* all disks, and without flips */
    bool probed;  /* a cut: its charts are made, and ranked by a few steps; before that it is guessed at */
    bool blocked; /* a cut that overlaps when its border is let go; with `promise`, its score before that was known */
    double promise;
    bool settled;  /* solved to the end, no overlap */
    bool dropped;  /* not solved at all: two charts joined as they lie overlap */
    double length; /* of the edges, over sqrt(area) */
    double cost;   /* with weights */
    double loss;   /* of the charts that come of it */
    double rank;
    sl_status status;
} sl_opt_trial;

void sl_opt_trial_clear(sl_opt_trial *trial);

/* Extracts the charts that come of a trial, with the UVs at hand. trial->valid = false where one is no disk. */
SL_NODISCARD sl_status sl_opt_trial_make(const sl_opt_state *state, sl_opt_trial *trial);

/* Shares of the two budgets that the atlas takes as it is (trial = NULL), or would take with the trial: the larger and
 * the geometric mean; HUGE_VAL where the trial is not valid or a chart of it beyond max_stretch. */
void sl_opt_shares(const sl_opt_state *state, const sl_opt_trial *trial, double *largest, double *mean);

/* A guess at what a cut leaves of its chart's loss, by its surroundings alone: trial->length, cost, loss; valid = it
 * could be solved. The trial need not be made; nto is believed. */
SL_NODISCARD sl_status sl_opt_trial_guess(const sl_opt_state *state, sl_opt_trial *trial);

/* A few Newton steps for ranking a cut. */
SL_NODISCARD sl_status sl_opt_trial_probe(const sl_opt_state *state, int32_t steps, sl_opt_trial *trial);

/* How a chart is solved. */
typedef enum sl_opt_effort {
    SL_OPT_WARM,      /* from the map at hand; from nothing where that overlaps */
    SL_OPT_HELD,      /* the same for a map that is embedded; then with a border that stays simple, from both */
    SL_OPT_WARM_ONLY, /* from the map at hand, with a border that is held if need be, or not at all */
    SL_OPT_SIMPLE,    /* from nothing, with a border that stays simple */
    SL_OPT_COLD,      /* from nothing; once more with a simple border where that overlaps */
    SL_OPT_GUESSED,   /* the same, from about where the vertices will be: the map at hand may have flips */
    SL_OPT_SEWN       /* from the map at hand, once; from nothing, once, where that has flips */
} sl_opt_effort;

/* Solves the charts of a cut to the end and proves them embedded; trial->valid = trial->settled = the outcome.
 * SL_OPT_WARM_ONLY starts from the maps of the state's charts again, other efforts from the trial's own. */
SL_NODISCARD sl_status sl_opt_trial_settle(const sl_opt_state *state, sl_opt_effort effort, sl_opt_trial *trial);

/* The same of a sewing: first roughly, and to the end only where that leaves hope for the targets. */
SL_NODISCARD sl_status sl_opt_trial_sew(const sl_opt_state *state, sl_opt_trial *trial);

/* Replaces the charts of the state by the trial's, which is emptied. SL_OUT_OF_MEMORY leaves all as it was. */
SL_NODISCARD sl_status sl_opt_apply(sl_opt_state *state, sl_opt_trial *trial);

/* Solves a chart. uv: in and out; a map at hand must be flip-free. *embedded = proven. */
SL_NODISCARD sl_status sl_opt_solve(const sl_opt_state *state, const sl_patch *patch, sl_opt_effort effort, double *uv,
                                    bool *embedded);

/* Solves a chart roughly, from the map at hand or where that has flips from nothing. workspace: for sl_opt_finish. */
SL_NODISCARD sl_status sl_opt_sketch(const sl_opt_state *state, sl_opt_chart *chart, sl_stretch_workspace *workspace,
                                     bool *embedded);

/* On from there to the end. */
SL_NODISCARD sl_status sl_opt_finish(const sl_opt_state *state, sl_opt_chart *chart, sl_stretch_workspace *workspace,
                                     bool *embedded);

/* sl_certify_embedding of a chart. */
SL_NODISCARD sl_status sl_opt_certify(const sl_patch *patch, const double *uv, sl_certificate *out);

/* Solves every chart again with state->w. */
SL_NODISCARD sl_status sl_opt_resolve(sl_opt_state *state);

/* Lays every chart flat from nothing, or from the maps at hand as guesses, flips or not. *all = false where one has no
 * embedding. */
SL_NODISCARD sl_status sl_opt_unfold(sl_opt_state *state, bool guessed, bool *all);

/* The weight of the energy that meets both targets best; solves every chart with it. */
SL_NODISCARD sl_status sl_opt_balance(sl_opt_state *state);

/* Candidate cuts of chart c: darts, chords, bisections. *list (owned) and *count. */
SL_NODISCARD sl_status sl_opt_candidates(const sl_opt_state *state, int32_t c, sl_opt_trial **list, int32_t *count);

/* A chart's vertices over the edges that may be cut, each weighed by its cost; halfedge (owned): of the patch, behind
 * an entry. SL_OUT_OF_MEMORY: to be cleared all the same. */
SL_NODISCARD sl_status sl_opt_chart_graph(const sl_opt_surface *surface, const sl_patch *patch, sl_graph *graph,
                                          int32_t **halfedge);

/* Two smoothed spectral bisections of chart c, appended. */
SL_NODISCARD sl_status sl_opt_bisections(const sl_opt_state *state, int32_t c, sl_opt_trial *list, int32_t *count);

/* Parts chart c, once its map overlaps when the border is let go, along minimum cuts between what lies on each other;
 * the trial (to be cleared after failure, too) is settled, or not valid. */
SL_NODISCARD sl_status sl_opt_part(const sl_opt_state *state, int32_t c, sl_opt_trial *trial);

/* Cuts greedily until the targets are met. */
SL_NODISCARD sl_status sl_opt_cut(sl_opt_state *state);

/* Seams as arcs between tips, junctions and the surface's border; and closed ones. */
enum { SL_OPT_ARC_CLOSED = 1, SL_OPT_ARC_TIP_FIRST = 2, SL_OPT_ARC_TIP_LAST = 4 };
typedef struct sl_opt_arcs {
    int32_t count;
    int32_t *first;    /* count + 1 */
    int32_t *halfedge; /* of arc k in order: halfedge[first[k] .. first[k + 1] - 1], one halfedge an edge */
    uint8_t *kind;     /* bits as above; a tip: the arc ends inside a chart */
} sl_opt_arcs;

SL_NODISCARD sl_status sl_opt_arcs_init(const sl_opt_state *state, sl_opt_arcs *out);
void sl_opt_arcs_clear(sl_opt_arcs *arcs);

/* Parts of seams that may be sewn, as trials not yet made; *list (owned), also after failure. */
SL_NODISCARD sl_status sl_opt_windows(const sl_opt_state *state, sl_opt_trial **list, int64_t *count);

/* The rigid motion (cos, sin, shift) of chart trial->old[1] that brings the window's banks together best; returns the
 * root mean square of what is left between them. Within one chart the motion is none. */
double sl_opt_align(const sl_opt_state *state, const sl_opt_trial *trial, double motion[4]);

/* The map that sewing starts from: the sewn chart with the banks of the window brought together and the surface behind
 * them following. uv: patch->nv x 2, out. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_opt_close_banks(const sl_opt_state *state, const sl_opt_trial *trial, const sl_patch *patch,
                                          double *uv);

/* Do the two charts of a window, brought together by sl_opt_align, lie in each other by more than what the window's
 * gap explains? SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_opt_interlocks(const sl_opt_state *state, const sl_opt_trial *trial, bool *interlocks);

/* Sews greedily while the targets stay met. */
SL_NODISCARD sl_status sl_opt_sew(sl_opt_state *state);

/* Lays parts of seams anew where a way that is cheaper and turns less leads between the same ends and the targets stay
 * met. */
SL_NODISCARD sl_status sl_opt_straighten(sl_opt_state *state);

/* Cuts charts across that leave much of a square page empty, while that costs less than def->empty_cost. They stay as
 * they lie: a part of a map is no worse than the whole. */
SL_NODISCARD sl_status sl_opt_compact(sl_opt_state *state);

/* Cuts and sews in turn while that lowers the price. */
SL_NODISCARD sl_status sl_opt_search(sl_opt_state *state);

/* Sews one part of a seam after another though the targets are then missed, cuts, sews and straightens, and keeps what
 * costs less: a number of times that depends on the piece's size and on how fine the targets are. Does nothing where
 * the targets are not met. */
SL_NODISCARD sl_status sl_opt_recreate(sl_opt_state *state);

/* Starts and searches: on the piece itself, or for a large one on coarse meshes of it first. *done = false where no
 * valid charts were found. */
SL_NODISCARD sl_status sl_opt_piece(sl_opt_state *state, const sl_segment_def *segment,
                                    const sl_triangulation *triangulation, bool *done);

/* CPU seconds now; and books those since then. Returns the time now. */
double sl_opt_clock(void);
double sl_opt_book(sl_opt_state *state, sl_optimize_stage stage, double since);

/* Adds counts and times. */
void sl_opt_add_info(const sl_optimize_info *from, sl_optimize_info *to);

/* How coarse the targets are: 1 = L2 of 1.05 and angle of 1.2, or coarser; nearly 0 = no distortion at all. */
double sl_opt_coarseness(const sl_optimize_def *def);

/* What seams and charts cost. */
double sl_opt_price(const sl_opt_state *state);

/* Where weights count and creases part the surface into few, nearly developable parts, searches once more from those,
 * and puts the outcome in the state's place if it costs less. */
SL_NODISCARD sl_status sl_opt_search_creases(sl_opt_state *state, const sl_segment_def *segment,
                                             const sl_triangulation *triangulation);

/* The charts of a segmentation of the surface's mesh, `mesh` with its seams cut, laid flat. state: fresh. *started =
 * false where one is no disk or has no map. */
SL_NODISCARD sl_status sl_opt_take(sl_opt_state *state, const sl_mesh *mesh, const sl_segmentation *seg, bool *started);

/* The first charts: spectral cuts of the surface's mesh, recursing where one fails or exceeds def->start_stretch.
 * *started = false where none was found. */
SL_NODISCARD sl_status sl_opt_start(sl_opt_state *state, const sl_segment_def *segment,
                                    const sl_triangulation *triangulation, bool *started);

#endif
