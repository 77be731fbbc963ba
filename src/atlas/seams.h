/* The user's own seams: edges from a file, a chart number a facet, or the UV seams of the input.
 * Layer: atlas. */
#ifndef SL_ATLAS_SEAMS_H
#define SL_ATLAS_SEAMS_H

#include "mesh/mesh.h"

typedef enum sl_seam_source {
    SL_SEAMS_AUTOMATIC, /* spectral cuts */
    SL_SEAMS_EDGES,     /* seam_input.edge */
    SL_SEAMS_LABELS,    /* seam_input.label: cut where two facets' labels differ */
    SL_SEAMS_KEEP_UV    /* seam_input.corner_uv: cut where the two sides' UVs differ */
} sl_seam_source;

typedef struct sl_seam_input {
    int32_t edge_count;
    const int32_t *edge;     /* edge_count x 2 input vertex numbers, 0-based */
    const int32_t *label;    /* one a facet */
    const double *corner_uv; /* 2 per input corner, NaN = none */
} sl_seam_input;

/* Cuts the mesh's edges as the source says; nothing for SL_SEAMS_AUTOMATIC. SL_BAD_INPUT: an edge that the mesh does
 * not have, a corner without UV (diag names it). O(nh log nh). SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_seams_cut(sl_mesh *mesh, sl_seam_source source, const sl_seam_input *input, sl_diag *diag);

/* Reads seam edges: a line "v w" an edge, 0-based input vertex numbers separated by blanks or a comma; # comments and
 * an optional header line of words. *edge (owned) count x 2. SL_IO, SL_BAD_INPUT with the line, SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_seams_read_edges(const char *path, int32_t **edge, int32_t *count, sl_diag *diag);

/* Reads labels: one integer a line (or "facet,label" as `segment` writes it), one for every facet in order. *label
 * (owned) has nf entries. SL_IO, SL_BAD_INPUT with the line, SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_seams_read_labels(const char *path, int32_t nf, int32_t **label, sl_diag *diag);

#endif
