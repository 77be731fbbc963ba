/* From a mesh to charts that can all be flattened: recursive spectral cuts (paper, Sec. 3.3).
 * Layer: segment (may include spectral, param, draw and all below). */
#ifndef SL_SEGMENT_SEGMENT_H
#define SL_SEGMENT_SEGMENT_H

#include "base/context.h"
#include "mesh/topology.h"
#include "param/flatten.h"
#include "spectral/spectrum.h"
#include "symmetry/symmetry.h"

/* Which of the cuts that pass the connectivity filter is taken. */
typedef enum sl_cut_rule {
    SL_RULE_LONGEST,       /* longest seam: the paper's "equator" */
    SL_RULE_LENGTH_LAMBDA, /* longest seam / sqrt(lambda) */
    SL_RULE_LOOKAHEAD      /* lowest area-weighted log L2 of a quick LSCM of both halves (default) */
} sl_cut_rule;

typedef enum sl_pairing { SL_PAIR_AUTO, SL_PAIR_ON, SL_PAIR_OFF } sl_pairing;

/* Where cuts come from. Recursion until valid and flattening are the same for all. */
typedef enum sl_cut_method {
    SL_METHOD_SPECTRAL, /* eigenvectors of the facet graph (paper) */
    SL_METHOD_PCA,     /* the plane across the shortest principal axis, through the centre: the "equator" of Sec. 3.3 */
    SL_METHOD_VSA,     /* variational shape approximation: proxies of a chart (Cohen-Steiner et al. 2004) */
    SL_METHOD_FIEDLER, /* the first eigenvector that is not constant, always (Fiedler 1975) */
    SL_METHOD_RANDOM,  /* Voronoi cells of two random facets: a floor */
    SL_METHOD_ISOCHARTS, /* clusters around the extremes of embedded geodesic distances (Zhou et al. 2004) */
    SL_METHOD_EMBEDDING  /* k-means of the global point signature (Rustamov 2007; Liu, Zhang 2004) */
} sl_cut_method;

/* Which symmetries are used. */
typedef enum sl_symmetry_use {
    SL_SYMMETRY_USE_AUTO, /* exact where found (default) */
    SL_SYMMETRY_USE_OFF,
    SL_SYMMETRY_USE_EXACT, /* the same; none found is a warning */
    SL_SYMMETRY_USE_NEAR   /* near ones too: labelled approximate */
} sl_symmetry_use;

struct sl_segment_def;

/* Cuts a whole piece at once, in place of the recursion: see sl_segment_def.cutter. piece: connected, a copy, in which
 * the seams are to be cut; def->edge_weight: the piece's own; corner_uv: 2 a corner, each chart in its own frame. All
 * charts must be embedded disks. *done = false leaves the piece to the recursion. */
typedef struct sl_cutter {
    sl_status (*cut)(void *user, sl_mesh *piece, const sl_triangulation *triangulation,
                     const struct sl_segment_def *def, const sl_context *context, double *corner_uv, bool *done);
    void *user;
} sl_cutter;

typedef struct sl_segment_def {
    sl_cut_method method;     /* default spectral */
    int32_t vsa_regions;      /* proxies of a component's first cut, then 2 a cut; 0 = by error (default) */
    double vsa_error;         /* L2,1 error over area where proxies are added no more; default 0.05 */
    int32_t clusters;         /* embedding: of a component's first cut, then 2 a cut; default 2 */
    int32_t seed;             /* of the random numbers of `random` and `embedding`; default 1 */
    sl_symmetry_use symmetry; /* default auto */
    bool test_halves;         /* the paper's way (Sec. 4.3): no search for axes, but after each cut it is tested whether
                                 its halves are isomorphic; default false */
    bool unshare;             /* copies are laid out too, turned the right way round; default false */
    sl_cut_rule rule;
    int32_t vectors;    /* eigenvectors computed a cut; default 30 */
    sl_pairing pairing; /* triangles back into quads in the facet graph; default auto */
    bool filter;        /* only vectors with connected positive and negative facets cut (paper, Sec. 3.3); default true;
                           off, to compare, with the rules by length: looking ahead needs two halves */
    int32_t smooth;     /* dual rings of the band minimum cut, 0 = off; default 2 */
    bool join;          /* genus-0 charts with several borders: loops joined by shortest paths; default true */
    bool sew;           /* merge neighbours while they stay valid; default true */
    double sew_stretch; /* L2 bound of a merged chart; default 1.25 */
    bool protect_first; /* never sew the first cut's seam; default true. An axis of symmetry is never sewn */
    int32_t max_charts; /* cap on charts that are laid flat, copies not counted; reaching it stops splitting and is
                           reported; default 100000 */
    int64_t memory_limit; /* bytes that one eigensolve, its matrix and results may take; 0 = none; default 0 */
    sl_flatten_def flatten;
    const double *edge_weight; /* mesh->nh, positive, equal for both halfedges of an edge: factor on its length where
                                  loops are joined and cuts smoothed; borrowed; NULL = 1 (default) */
    const sl_cutter *cutter;   /* borrowed; for components, and the halves of those cut at their axis; what comes of it
                                  is neither split nor sewn nor relaxed. NULL = the recursion cuts (default) */
} sl_segment_def;

sl_segment_def sl_segment_default(void);

/* The paper as printed: longest seam, no pairing, smoothing, joining or sewing, unweighted energy, no Tutte and no
 * stretch minimisation; the stretch bound is the one addition. */
sl_segment_def sl_segment_paper(void);

typedef struct sl_chart {
    int32_t first, count; /* its facets: sl_segmentation.face[first .. first + count - 1], ascending */
    sl_topology topology;
    sl_flatten_result flat;
    bool capped;           /* left as it is because max_charts was reached or it cannot be split */
    int32_t copy_of;       /* chart whose UVs this one takes bit for bit, itself no copy; -1 = its own */
    bool mirrored;         /* a copy: its triangles have negative area in UV space */
    sl_symmetry_kind kind; /* a copy: how far the geometry follows, exact or near */
} sl_chart;

/* What a symmetry had to do with a split. */
typedef enum sl_split_symmetry {
    SL_SPLIT_PLAIN,  /* nothing */
    SL_SPLIT_MIRROR, /* cut along the axis; the other half copies */
    SL_SPLIT_HALVES, /* an ordinary cut whose halves turned out to be isomorphic; the other half copies */
    SL_SPLIT_PLANE   /* cut near the plane of a near symmetry; nothing is shared */
} sl_split_symmetry;

/* One split of the recursion, in the order taken. */
typedef struct sl_split {
    int32_t depth;
    int32_t facets; /* size of the chart split */
    int32_t vector; /* eigenvector taken; -1 = none passed and the Fiedler vector's components were used.
                     * PCA: axis the plane lies across, 0 = shortest; Fiedler: 1; others: clusters. -1 = a spectral cut
                     * had to do */
    double lambda;  /* eigenvalue; PCA: variance along the axis; VSA: L2,1 error over area; Iso-charts: the largest of
                     * the scaling; embedding:  mean squared distance from the centres; random: 0 */
    int32_t candidates; /* vectors that passed the filter; other methods: 1, 0 = none */
    int32_t parts;      /* charts made */
    double length;      /* seam length, normalised mesh */
    bool smoothed;
    sl_split_symmetry symmetry;
    int32_t fixed;              /* facets that straddle the axis: they stay with the first half and are not shared */
    bool optimised;             /* by the cutter: all its charts at once, `length` with the seams inside them */
    sl_flatten_verdict because; /* why the chart had to be split (nothing is wrong with a component cut at its axis) */
} sl_split;

/* What symmetry saved. */
typedef struct sl_sharing_info {
    int32_t axes;       /* cuts whose other half copies */
    int32_t components; /* components that copy another */
    int32_t copies;     /* charts that copy another */
    int32_t refused;    /* copies that were not valid on their own geometry and were laid flat themselves */
    double area;        /* of the copies over all: the texture memory saved, densities being equal */
    bool truncated;     /* the list of automorphisms was cut short somewhere */
    int32_t planes;     /* first cuts taken at the plane of a near symmetry */
    double misfit;      /* the worst misfit of those, over the diagonal */
    int32_t near_axes;  /* of the axes, those of near symmetries: their copies are approximate */
    double deviation;   /* the largest distance of a corner there from where its image belongs, over the diagonal */
} sl_sharing_info;

typedef struct sl_segmentation {
    int32_t nchart;
    sl_chart *chart;     /* nchart, numbered by first facet */
    int32_t *face;       /* nf: facets grouped by chart */
    int32_t *face_chart; /* nf: chart of a facet */
    double *corner_uv;   /* nh x 2: each chart in its own frame, area = 3D area of the normalised mesh; a copy in its
                            source's */
    int32_t *source;     /* nh: the corner whose UV a copy's corner takes, -1 = its own; NULL where nothing is shared */
    sl_sharing_info sharing;
    int32_t nsplit;
    sl_split *split;
    int32_t *cut_after; /* nh: how many splits were made before this edge was cut, 0 .. nsplit; -1 = never, or only as
                           the copy of another */
    int32_t merges;     /* charts sewn together */
    bool paired;        /* triangles were paired */
    double paired_fraction;
} sl_segmentation;

/* Segments and flattens. The mesh's seams are cut in place (twin to sew pointers); on failure it is as it was.
 * A component with an exact mirror symmetry is cut along its axis first, and one half takes its UVs from the other; so
 * is every part that must be split anyway. Copies of a component take theirs from the first. Components and isolated
 * facets become charts of their own; seams already cut stand as borders. Charts whose stretch had to be minimised to
 * meet the bound are relaxed to the end once they are final. SL_OUT_OF_MEMORY, SL_CANCELLED, SL_INTERNAL. Same bytes
 * for any number of threads. */
SL_NODISCARD sl_status sl_segment(sl_mesh *mesh, const sl_triangulation *triangulation, const sl_segment_def *def,
                                  const sl_context *context, sl_segmentation **out);

/* No cutting: charts are the components over uncut edges (the caller's seams); loops are joined when def->join says so;
 * each is flattened. A chart that is not a disk or not valid stays as it is, with its verdict. */
SL_NODISCARD sl_status sl_flatten_charts(sl_mesh *mesh, const sl_triangulation *triangulation,
                                         const sl_segment_def *def, const sl_context *context, sl_segmentation **out);

void sl_segmentation_free(sl_segmentation *segmentation); /* NULL is a no-op */

#endif
