/* What the files of this room share: pieces cut out of the mesh, and the jobs done on them.
 * Layer: segment (private). */
#ifndef SL_SEGMENT_INTERNAL_H
#define SL_SEGMENT_INTERNAL_H

#include "segment/segment.h"

/* Some facets as a mesh and triangulation of their own, so that cuts can be tried without touching anything shared.
 * Vertices are numbered anew, one per fan over twins and seams inside the piece. */
typedef struct sl_piece {
    sl_mesh *mesh;
    sl_triangulation *triangulation;
    int32_t *face;  /* mesh->nf: the parent's facet */
    int32_t *place; /* by the parent's facets: places in an order of elimination that parts inherit, -1 = none yet; each
                       piece touches its own facets only; borrowed, NULL = none is kept */
    double *weight; /* mesh->nh: see sl_segment_def.edge_weight; NULL = 1 */
} sl_piece;

/* The facets face[0 .. count - 1] (ascending) of a mesh; twins and seams inside the set are kept, others become
 * borders. SL_OUT_OF_MEMORY. O(corners log count). */
SL_NODISCARD sl_status sl_piece_create(const sl_mesh *mesh, const sl_triangulation *triangulation, const int32_t *face,
                                       int32_t count, sl_piece **out);
void sl_piece_free(sl_piece *piece); /* NULL is a no-op */

/* The weights (mesh->nh, nullable = 1), edges near the mesh's centre made up to a millionth part dearer: of ways that
 * are equally long one is then shorter than the others, but for those that a symmetry of the mesh takes to one another.
 * *out is owned by the caller. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_lean_weights(const sl_mesh *mesh, const double *weight, double **out);

/* Copies the weights of the parent's edges, where there are some (weight: parent->nh, nullable). SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_piece_weigh(sl_piece *piece, const sl_mesh *parent, const double *weight);

/* The parent's halfedge of halfedge h of the piece. */
static inline int32_t sl_piece_halfedge(const sl_piece *piece, const sl_mesh *parent, int32_t h)
{
    const int32_t f = piece->mesh->face[h];
    return parent->face_first[piece->face[f]] + (h - piece->mesh->face_first[f]);
}

/* vertex[h] = number of the fan of corners that corner h belongs to, fans joined over twins and, with across_seams,
 * over seams too; numbered by first corner. vertex: nh. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_corner_fans(const sl_mesh *mesh, bool across_seams, int32_t *vertex, int32_t *count);

/* The border halfedge after border halfedge h. */
int32_t sl_next_on_border(const sl_mesh *mesh, int32_t h);

/* Topology of the whole piece, which must be connected. */
SL_NODISCARD sl_status sl_piece_topology(const sl_piece *piece, sl_topology *out);

/* Position of value in ascending list[0 .. count - 1], -1 = not there. */
int32_t sl_find_sorted(const int32_t *list, int32_t count, int32_t value);

/* Halfedges cut, one an edge. */
typedef struct sl_cut_list {
    int32_t *halfedge;
    int32_t count;
} sl_cut_list;

void sl_cut_list_clear(sl_cut_list *list);

/* Cuts a connected mesh of several border loops along shortest paths between them, nearest loop first, until one is
 * left: a disk where the genus is 0. weight: nh factors on the lengths, NULL = 1. list (owned by the caller) names the
 * edges. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_join_loops(sl_mesh *mesh, const double *weight, sl_cut_list *list);

/* Sews the edges of a list again. */
void sl_sew_list(sl_mesh *mesh, const sl_cut_list *list);

/* The whole piece as a patch. */
SL_NODISCARD sl_status sl_piece_patch(const sl_piece *piece, sl_patch **out);

/* Border edges of a patch as *count pairs of vertices, in the order of the corners; owned by the caller. */
SL_NODISCARD sl_status sl_patch_border_pairs(const sl_patch *patch, int32_t **vertex, int32_t *count);

/* Flattens the piece as it is. corner_uv: mesh->nh x 2. */
SL_NODISCARD sl_status sl_flatten_piece(const sl_piece *piece, const sl_flatten_def *def, const sl_context *context,
                                        double *corner_uv, sl_flatten_result *flat);

/* A partition of a piece's facets. vector, lambda, candidates: as in sl_split. */
typedef struct sl_choice {
    int32_t *side;  /* owned, one a facet: 0 and 1, or a proxy; connected parts of a side become charts each */
    int32_t vector; /* -1 = no vector passed the filter and this is the Fiedler vector's */
    double lambda;
    int32_t candidates;
    double length; /* of the seam */
    bool smoothed;
    bool found; /* false: nothing could be cut */
} sl_choice;

/* Chooses a cut of a connected piece by def->method (and def->rule). partner: a facet's partner in the piece, NULL = no
 * pairing. SL_OUT_OF_MEMORY, SL_CANCELLED, SL_INTERNAL. */
SL_NODISCARD sl_status sl_choose_cut(const sl_piece *piece, const int32_t *partner, const sl_segment_def *def,
                                     const sl_context *context, sl_choice *choice);
void sl_choice_clear(sl_choice *choice);

/* Fills in length and found from the sides. */
void sl_choice_measure(const sl_mesh *mesh, sl_choice *choice);

/* How well the two sides would flatten, smaller is better: see lookahead.c. */
SL_NODISCARD sl_status sl_lookahead_score(const sl_piece *piece, const uint8_t *side, const sl_context *context,
                                          double *score);

/* Corners of the mesh that take their UVs from others, found at one cut. */
typedef struct sl_copy_list {
    int32_t *corner, *from; /* count each, owned */
    int32_t count;
    bool reverses; /* the orientation */
    sl_symmetry_kind kind;
} sl_copy_list;

void sl_copy_list_clear(sl_copy_list *list);

/* A chart on its way: found by the recursion, flattened, then done or split into parts. */
typedef struct sl_chart_job {
    int32_t *face; /* count facets of the mesh, ascending */
    int32_t count, depth;
    bool whole; /* a component, or what an axis left of one: the cutter's, where there is one */
    /* results */
    sl_status status;
    bool done; /* final: corner_uv, flat, topology and joined stand */
    bool capped;
    sl_topology topology; /* after joining where that was kept */
    sl_flatten_result flat;
    double *corner_uv;  /* 2 a corner, facet by facet */
    sl_cut_list joined; /* halfedges of the mesh cut by loop joining */
    int32_t nparts;
    int32_t *part; /* count: part of a facet, numbered by first facet; -1 = it copies and needs no chart of its own */
    sl_cut_list seam; /* halfedges of the mesh between the parts */
    sl_split split;
    sl_copy_list copies; /* of the facets of part -1 */
    bool truncated;      /* not all automorphisms were listed */
    double misfit;       /* of the plane taken, or the deviation of the near axis, see sl_sharing_info */
    /* a chart that is a copy */
    bool copy;
    int32_t source_face; /* first facet of the chart it copies */
    bool mirrored;
    sl_symmetry_kind kind;
    /* a piece that the cutter cut */
    struct sl_chart_job *finished; /* its nfinished charts, all done; owned */
    int32_t nfinished;
    bool settled; /* one of those: neither sewn nor relaxed */
} sl_chart_job;

void sl_chart_job_clear(sl_chart_job *job); /* frees, zeroes */

/* What every job needs. */
typedef struct sl_recursion {
    const sl_mesh *mesh;
    const sl_triangulation *triangulation;
    const sl_segment_def *def;
    const int32_t *partner;    /* nf, NULL = no pairing */
    const sl_context *context; /* without progress where jobs run in parallel */
    bool may_split;            /* false: the cap is reached, flatten only */
    bool share;                /* look for symmetries */
    int32_t *place;            /* nf, see sl_piece; nullable */
} sl_recursion;

/* Has the piece cut by the cutter: job->finished, split and seam; *taken = false, the piece as it was, where the cutter
 * did not do it or not all its charts are valid. SL_OUT_OF_MEMORY, SL_CANCELLED, SL_INTERNAL. */
SL_NODISCARD sl_status sl_cut_piece(const sl_recursion *recursion, sl_piece *piece, sl_chart_job *job, bool *taken);

/* Flattens a chart and, where that is not valid, splits it. The outcome, its status included, is in the job. */
void sl_chart_job_run(const sl_recursion *recursion, sl_chart_job *job);

/* Relaxes a valid chart whose stretch had to be minimised beyond the bound, as far as the minimisation goes;
 * recursion->mesh must have the chart's seams cut. Its status is in the job. */
void sl_chart_job_polish(const sl_recursion *recursion, sl_chart_job *job);

/* Charts that are done. */
typedef struct sl_job_list {
    sl_chart_job *job;
    int64_t count, capacity;
} sl_job_list;

/* Moves *job to the end of the list; *job is zeroed. SL_OUT_OF_MEMORY leaves it with the caller. */
SL_NODISCARD sl_status sl_job_list_push(sl_job_list *list, sl_chart_job *job);
void sl_job_list_clear(sl_job_list *list);

/* One job for each component of the mesh over its twins. */
SL_NODISCARD sl_status sl_component_jobs(const sl_mesh *mesh, sl_job_list *list);

/* One job for each part of a job that is split. */
SL_NODISCARD sl_status sl_part_jobs(const sl_chart_job *job, sl_job_list *list);

/* What is done to every job of a list. */
typedef void sl_job_fn(const sl_recursion *recursion, sl_chart_job *job);

/* Runs fn on every job in parallel; the context's progress is reported when there is one job only. First failure by
 * index. */
SL_NODISCARD sl_status sl_run_jobs(const sl_recursion *recursion, const sl_context *context, sl_job_fn *fn,
                                   sl_job_list *list);

/* Marks of edges: of a first cut, or of an axis whose other side copies (or might have). */
enum { SL_CUT_FIRST = 1, SL_CUT_AXIS = 2 };

/* Merges neighbouring charts while they stay valid and within def->sew_stretch. work: the mesh with all charts' seams
 * cut; original: as the caller gave it (its own seams are never sewn); first_cut[h]: marks; those of axes are never
 * sewn. Facets may belong to no chart.
 * SL_OUT_OF_MEMORY, SL_CANCELLED, SL_INTERNAL. */
SL_NODISCARD sl_status sl_sew_charts(sl_mesh *work, const sl_mesh *original, const sl_triangulation *triangulation,
                                     const uint8_t *first_cut, const sl_segment_def *def, const sl_context *context,
                                     sl_job_list *charts, int32_t *merges);

/* The finished segmentation of charts that are done; takes their data. */
SL_NODISCARD sl_status sl_segmentation_assemble(const sl_mesh *mesh, sl_job_list *charts, sl_segmentation **out);

#endif
