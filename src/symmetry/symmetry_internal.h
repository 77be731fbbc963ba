/* The stages of the search for automorphisms.
 * Layer: symmetry, private.
 *
 * A cell is a facet, or a pair of triangles taken as a quad. Cells and their corners are numbered anew: component by
 * component, breadth-first from a corner of the rarest colour, each cell's corners from the one it was reached by. A
 * walk from there then meets cells and corners in the order of their numbers. */
#ifndef SL_SYMMETRY_INTERNAL_H
#define SL_SYMMETRY_INTERNAL_H

#include "symmetry/symmetry.h"

/* Cells in the mesh's order, before they are numbered anew. Without pairs the first three are the mesh's own. */
typedef struct sl_raw_cells {
    int32_t ncell, ncorner, npoint;
    const int32_t *first, *cell, *twin; /* ncell + 1; ncorner; ncorner */
    int32_t *corner;                    /* ncorner: mesh halfedge; NULL = itself */
    int32_t *at;                        /* nh: cell corner of each mesh corner; NULL = itself */
    int32_t *diagonal;                  /* nf: halfedge between a facet and its partner, -1 = alone; NULL = all alone */
    int32_t *cell_of;                   /* nf; NULL = itself */
    int32_t *point;                     /* ncorner: corners that hang together around a vertex */
    int32_t *valence;                   /* npoint: corners there, negative at a border */
    int32_t *first_store, *cell_store, *twin_store;
} sl_raw_cells;

SL_NODISCARD sl_status sl_raw_cells_init(const sl_mesh *mesh, const int32_t *partner, sl_raw_cells *out);
void sl_raw_cells_clear(sl_raw_cells *raw);

static inline int32_t sl_raw_next(const sl_raw_cells *raw, int32_t h)
{
    return h + 1 < raw->first[raw->cell[h] + 1] ? h + 1 : raw->first[raw->cell[h]];
}

static inline int32_t sl_raw_prev(const sl_raw_cells *raw, int32_t h)
{
    return h > raw->first[raw->cell[h]] ? h - 1 : raw->first[raw->cell[h] + 1] - 1;
}

static inline int32_t sl_raw_halfedge(const sl_raw_cells *raw, int32_t h)
{
    return raw->corner != NULL ? raw->corner[h] : h;
}

/* Colours of the cells of each component, refined until a colour is rare or nothing changes. A colour depends on the
 * connectivity alone, the same in isomorphic components. start[component] = raw corner of a cell of the rarest colour,
 * and where many have it, one whose distance from the centre is rare. color: ncell; start: components. */
SL_NODISCARD sl_status sl_symmetry_refine(const sl_mesh *mesh, const sl_raw_cells *raw, const sl_symmetry *parts,
                                          uint64_t *color, int32_t *start);

typedef struct sl_cells {
    int32_t ncell, ncorner, npoint, components;
    int32_t *component;        /* components + 1: into the cells */
    int32_t *first, *cell;     /* ncell + 1: into the corners; ncorner */
    int32_t *twin;             /* ncorner */
    int32_t *mirror_twin;      /* ncorner: next of the twin of the corner before: what twin is in a mirror */
    int32_t *point, *halfedge; /* ncorner: into xyz; mesh halfedge */
    int32_t *at;               /* nh: cell corner of each mesh corner */
    const int32_t *diagonal;   /* nf, or NULL; borrowed */
    uint8_t *pair;             /* ncell; NULL = no pairs */
    uint64_t *color, *sum;     /* ncell; components: of all colours */
    double *xyz, *centre;      /* npoint x 3; components x 3: mean of the corners */
    double *size;              /* components: diagonal of the bounding box */
    double *edges, *shortest;  /* components: sum of all edge lengths, and the least */
    float *radius;             /* ncorner: distance from the centre */
} sl_cells;

/* color is taken in raw numbering. */
SL_NODISCARD sl_status sl_cells_create(const sl_mesh *mesh, const sl_raw_cells *raw, const sl_symmetry *parts,
                                       const uint64_t *color, const int32_t *start, sl_cells **out);
void sl_cells_free(sl_cells *cells);

static inline int32_t sl_cells_base(const sl_cells *c, int32_t component)
{
    return c->first[c->component[component]];
}

static inline int32_t sl_cells_corners(const sl_cells *c, int32_t component)
{
    return c->first[c->component[component + 1]] - c->first[c->component[component]];
}

/* Walks component `from` from its first corner, and its image from corner `to`, at most `limit` cells; false at the
 * first difference of degrees, twins, or distances from the centres beyond tolerance. image[h - base]: image corners
 * (of the cells reached). *worst = largest difference of distances met, *work grows by the corners seen. */
bool sl_symmetry_walk(const sl_cells *cells, int32_t from, int32_t to, bool reverses, int32_t limit, float tolerance,
                      int32_t *image, float *worst, int64_t *work);

/* The isometry that fits a walk of the first `limit` cells of `from` best; returns the largest distance of a moved
 * corner to its image. */
double sl_symmetry_fit(const sl_cells *cells, int32_t from, int32_t to, int32_t limit, bool reverses,
                       const int32_t *image, double isometry[12]);

/* Geometry of a whole map: misfit, deviation, isometry, kind; and order. */
void sl_symmetry_measure(const sl_cells *cells, const sl_symmetry_def *def, const int32_t *image, sl_symmetry_map *map);

/* Facets and corners of the mesh from those of cells. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_symmetry_export(const sl_mesh *mesh, const sl_symmetry *parts, const sl_cells *cells,
                                          const int32_t *image, sl_symmetry_map *map);

/* Halves of an involution: fixed_facets, axis_edges, axis_length, separates. side: nullable, map->count, 1 and 0 when
 * it separates. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_symmetry_halve(const sl_mesh *mesh, const sl_symmetry *parts, sl_symmetry_map *map,
                                         uint8_t *side);

/* What the searches share. */
typedef struct sl_symmetry_search {
    const sl_mesh *mesh;
    const sl_symmetry_def *def;
    const sl_context *context;
    const sl_cells *cells;
    int32_t *image; /* corners of the largest component */
    sl_symmetry *out;
    int64_t capacity;                   /* of out->map */
    int64_t searched, searched_corners; /* components whose automorphisms are sought; their corners */
} sl_symmetry_search;

/* Walks the whole component and appends the map when all of it fits (worst kind allowed: `kind`). *added says whether
 * it did. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_symmetry_try(sl_symmetry_search *search, int32_t from, int32_t component, int32_t to,
                                       bool reverses, float tolerance, sl_symmetry_kind kind, int64_t *work,
                                       bool *added);

/* Automorphisms of one component. SL_OUT_OF_MEMORY, SL_CANCELLED. */
SL_NODISCARD sl_status sl_symmetry_automorphisms(sl_symmetry_search *search, int32_t component);

/* Components that are copies of earlier ones: out->original and the maps. SL_OUT_OF_MEMORY, SL_CANCELLED. */
SL_NODISCARD sl_status sl_symmetry_copies(sl_symmetry_search *search);

#endif
