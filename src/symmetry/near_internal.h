/* Fitting the mirror plane of a surface.
 * Layer: symmetry, private. */
#ifndef SL_SYMMETRY_NEAR_INTERNAL_H
#define SL_SYMMETRY_NEAR_INTERNAL_H

#include "geom/vec3.h"
#include "mesh/triangulate.h"
#include "symmetry/nearest.h"
#include "symmetry/symmetry.h"

enum { SL_MIRROR_SAMPLES = 2048 }; /* at most */

/* normal . x = offset; score: mean distance of the samples that fit best. */
typedef struct sl_mirror_plane {
    double normal[3], offset, score;
} sl_mirror_plane;

typedef struct sl_mirror_search {
    const sl_mesh *mesh;
    const sl_context *context;
    sl_triangulation *triangulation;
    int32_t *vertex, *facet; /* of the triangles: 3 nt; nt */
    sl_nearest *tree;
    double *area;              /* nf */
    double total, centre[3];   /* of the area */
    double axis[9], moment[3]; /* principal axes, ascending moments */
    double *sample, *image;    /* 3 SL_MIRROR_SAMPLES: corners; nearest to their mirror images */
    int32_t *triangle;         /* SL_MIRROR_SAMPLES: nearest triangle */
    double *distance, *sorted; /* SL_MIRROR_SAMPLES */
    int32_t samples;
} sl_mirror_search;

static inline void sl_mirror_point(const sl_mirror_plane *s, const double p[3], double out[3])
{
    const double d = 2.0 * (sl_vec3_dot(s->normal, p) - s->offset);
    for (int k = 0; k < 3; k++) {
        out[k] = p[k] - d * s->normal[k];
    }
}

/* Fits the plane to the share `kept` of about `samples` samples that lie nearest to the surface once mirrored, in
 * `rounds` rounds at most. */
void sl_mirror_fit(sl_mirror_search *s, sl_mirror_plane *p, int32_t samples, int32_t rounds, double kept);

/* Distances along the normals converge where nearest points creep along the surface. The best plane met is kept. */
void sl_mirror_polish(sl_mirror_search *s, sl_mirror_plane *best, double kept);

#endif
