/* Distances along a triangulated surface, and landmark multidimensional scaling of them.
 * Layer: segment (private). */
#ifndef SL_SEGMENT_GEODESIC_INTERNAL_H
#define SL_SEGMENT_GEODESIC_INTERNAL_H

#include "mesh/triangulate.h"

/* A surface on which distances are wanted, with the workspace for one source at a time. */
typedef struct sl_geodesics {
    const sl_mesh *mesh; /* borrowed */
    int32_t nt;
    int32_t *tri;      /* 3 nt: vertices */
    int32_t *first;    /* nv + 1: triangles of a vertex in `incident` ... */
    int32_t *incident; /* 3 nt: ... as corners 3 t + k */
    double *length;    /* 3 nt: of the edge across from a corner */
    int32_t *heap, *place, *order;
    int32_t queued, settled;
} sl_geodesics;

/* SL_OUT_OF_MEMORY. The workspace of a failed create is empty. */
SL_NODISCARD sl_status sl_geodesics_create(const sl_mesh *mesh, const sl_triangulation *triangulation,
                                           sl_geodesics *out);
void sl_geodesics_clear(sl_geodesics *g);

/* distance[v] along the surface from vertex source; HUGE_VAL where it cannot be reached. distance: nv. */
void sl_geodesics_from(sl_geodesics *g, int32_t source, double *distance);

enum { SL_MDS_DIMS = 10 }; /* dimensions at most */

/* A Euclidean map of landmarks that keeps their distances as well as it can, and places other points by theirs. */
typedef struct sl_mds {
    int32_t landmarks, dims;        /* dims: those with an eigenvalue above rounding, at most SL_MDS_DIMS */
    double lambda[SL_MDS_DIMS + 1]; /* the largest eigenvalues of the centred Gram matrix, descending; 0 = none */
    double *row;                    /* dims x landmarks */
    double *mean;                   /* landmarks: mean squared distance */
} sl_mds;

/* distance: landmarks x landmarks (its symmetric part counts). SL_OUT_OF_MEMORY, SL_INTERNAL (LAPACK). */
SL_NODISCARD sl_status sl_mds_create(int32_t landmarks, const double *distance, sl_mds *out);
void sl_mds_clear(sl_mds *mds);

/* The first dims (at most mds->dims) coordinates y of a point at distance[k] from landmark k. */
void sl_mds_place(const sl_mds *mds, int32_t dims, const double *distance, double *y);

/* How many dimensions dominate: the i <= SL_MDS_DIMS of the largest gap lambda_i / lambda_(i+1). At least 1. */
int32_t sl_mds_dominant(const sl_mds *mds);

#endif
