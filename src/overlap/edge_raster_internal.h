/* What the files of the edge raster share.
 * Layer: overlap. Private. */
#ifndef SL_OVERLAP_EDGE_RASTER_INTERNAL_H
#define SL_OVERLAP_EDGE_RASTER_INTERNAL_H

#include "overlap/edge_raster.h"
#include "overlap/kernels_internal.h"

enum { SL_EDGE_BAND_ROWS = 64 }; /* texel rows one worker fills at a time */

/* A directed edge on the lattice: adds 1 to everything on its right where it climbs, takes 1 where it falls. */
typedef struct sl_lattice_edge {
    int32_t x[2], y[2];
} sl_lattice_edge;

struct sl_edge_raster {
    int32_t nv, nt, width, height, bands, depth;
    sl_raster_kernels kernels;
    int32_t *tri;       /* 3 nt */
    int32_t *corner[3]; /* nt each: the same, corner by corner */
    int32_t *across;    /* 3 nt: triangle on the other side of halfedge 3 t + k; -1 = border */
    int32_t *border;    /* borders: the halfedges with none */
    int32_t borders;
    int64_t *fan_first;         /* nv + 2: triangles of vertex v are fan[fan_first[v] .. fan_first[v + 1] - 1] */
    int32_t *fan;               /* 3 nt */
    int32_t *position;          /* 2 nv: lattice x, y */
    int8_t *sign;               /* nt: orientation on the lattice */
    int32_t positive, negative; /* triangles of each sign */
    int8_t most;                /* the sign of most */
    int32_t *odd;               /* triangles of another sign or none, in any order */
    int64_t odds, odd_capacity;
    int32_t *odd_place; /* nt: place of a triangle in that list, -1 = not in it; NULL until vertices are moved */
    uint8_t *count8;    /* width * height; one of the two */
    uint16_t *count16;
    int32_t *row_sums;   /* 2 height: texels hit once and more, twice and more */
    uint8_t *dirty;      /* height: rows to count again */
    int32_t *difference; /* bands rows of width + SL_KERNEL_PAD, all zero between drawings */
    uint16_t *scratch;   /* bands rows of width */
    sl_lattice_edge *edge;
    int64_t edges, edge_capacity;
    int64_t *band_first;  /* bands + 1: edges of band b are banded[band_first[b] .. band_first[b + 1] - 1] */
    int64_t *event_first; /* bands + 1: room for the band's events */
    sl_lattice_edge *banded;
    int64_t banded_capacity;
    uint32_t *event; /* 2 * column, + 1 where the count falls */
    int64_t event_capacity;
    bool drawn, far;
    bool vector;
};

/* across[h]: see the struct. Where more than two triangles meet in an edge, as many pairs as its two directions allow.
 */
SL_NODISCARD sl_status sl_edge_topology_pair(int32_t nv, int32_t nt, const int32_t *tri, int32_t *across);

/* Triangles of each vertex. Both arrays are owned by the caller, also after failure. */
SL_NODISCARD sl_status sl_edge_topology_fans(int32_t nv, int32_t nt, const int32_t *tri, int64_t **first,
                                             int32_t **triangle);

/* Counts the signs of all triangles and lists the odd ones. SL_OUT_OF_MEMORY. O(nt). */
SL_NODISCARD sl_status sl_edge_signs_count(sl_edge_raster *raster);

/* From now on sl_edge_signs_update can be used, until the next count fails. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_edge_signs_prepare(sl_edge_raster *raster);

/* Computes the sign of one triangle anew. SL_OUT_OF_MEMORY. O(1). */
SL_NODISCARD sl_status sl_edge_signs_update(sl_edge_raster *raster, int32_t triangle);

/* After updates: lists anew where another sign has become that of most. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_edge_signs_settle(sl_edge_raster *raster);

/* Rows of the window that the edge crosses: [*begin, *end), perhaps empty. */
void sl_edge_rows(const sl_lattice_edge *edge, int32_t height, int32_t *begin, int32_t *end);

/* Sorts the edges into bands and counts the dirty rows again. */
SL_NODISCARD sl_status sl_edge_raster_fill(sl_edge_raster *raster, const sl_context *context);

#endif
