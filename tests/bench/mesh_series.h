/* Triangle meshes of any size: a bumpy closed surface, and 1-to-4 subdivision of any mesh. */
#ifndef BENCH_MESH_SERIES_H
#define BENCH_MESH_SERIES_H

#include "base/status.h"

typedef struct bench_mesh {
    int32_t nv, nf;
    double *xyz;  /* nv x 3 */
    int32_t *tri; /* nf x 3 */
} bench_mesh;

/* A closed surface of about nf facets with two necks and bumps: rings of differing numbers of vertices, each turned by
 * a random angle, so that nothing is symmetric. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status bench_generate_mesh(int32_t nf, bench_mesh *out);

/* A mesh file, its polygons cut into fans. The errors of sl_meshfile_read. */
SL_NODISCARD sl_status bench_read_mesh(const char *path, bench_mesh *out, sl_diag *diag);

/* Each triangle into 4; the new vertices are moved off the old edges by a smooth displacement of about a tenth of the
 * edge. SL_OUT_OF_MEMORY, SL_BAD_INPUT. */
SL_NODISCARD sl_status bench_subdivide_mesh(const bench_mesh *mesh, bench_mesh *out);

void bench_mesh_clear(bench_mesh *mesh);

#endif
