/* Mesh files: OBJ and PLY in and out, OFF in. A file read is polygons and everything else the input held, so that
 * writing it again adds UVs and loses nothing.
 * Layer: meshio (may include mesh, graph, geom, base). */
#ifndef SL_MESHIO_MESHFILE_H
#define SL_MESHIO_MESHFILE_H

#include "mesh/build.h"

typedef enum sl_meshformat { SL_FORMAT_OBJ, SL_FORMAT_PLY, SL_FORMAT_OFF } sl_meshformat;

/* Parts of an input that are not polygons, counted. OBJ to OBJ and PLY to PLY keep them all, word for word; the other
 * ways lose them (sl_meshfile_losses says so). */
typedef struct sl_meshfile_extras {
    int64_t names;       /* OBJ: o, g, s, usemtl, mtllib */
    int64_t lines;       /* OBJ: l */
    int64_t points;      /* OBJ: p */
    int64_t others;      /* OBJ: every other statement; PLY: rows of elements that are neither vertices nor faces */
    int64_t properties;  /* PLY: properties without a meaning of ours */
    int64_t face_colors; /* OFF: faces with a colour */
} sl_meshfile_extras;

/* A mesh file in memory; all arrays are owned by it. Corner c of the file is corner c - face_first[f] of face f. */
typedef struct sl_meshfile {
    sl_meshformat format;
    int32_t nv, nf;
    double *xyz;            /* nv x 3, finite */
    int32_t *face_first;    /* nf + 1; every face has at least 3 corners */
    int32_t *index;         /* face_first[nf] vertex numbers in [0, nv) */
    double *corner_uv;      /* 2 a corner, NaN where missing; NULL when the file has none */
    int32_t normals;        /* number of normals, 0 = none */
    double *normal;         /* normals x 3, as written in the file; NULL when there are none */
    int32_t *corner_normal; /* normal of each corner, -1 = none; NULL when there are none */
    double *vertex_rgb;     /* nv x 3 in [0, 1], NaN where a vertex has none; NULL when no vertex has */
    sl_meshfile_extras extras;
    struct sl_meshfile_source *source; /* private: the bytes read, for what is copied word for word */
} sl_meshfile;

/* Reads a mesh file ("-" = standard input). The extension decides the format; where it is none of ours, the content.
 * SL_IO, SL_OUT_OF_MEMORY (also: over 2^31 - 1 vertices or corners), SL_BAD_INPUT (diag: line or byte, what is wrong,
 * what to do), SL_UNSUPPORTED (a format or variant not read). *out is NULL on failure. diag is nullable.
 * Memory: the bytes of the file and a small multiple of what they hold, whatever a header claims. O(bytes). */
SL_NODISCARD sl_status sl_meshfile_read(const char *path, sl_meshfile **out, sl_diag *diag);

/* As sl_meshfile_read, from memory; name stands for the path in messages and for the extension. data is copied. */
SL_NODISCARD sl_status sl_meshfile_parse(const char *name, const char *data, int64_t size, sl_meshfile **out,
                                         sl_diag *diag);

/* Polygons that came from no file, as an OBJ file that could have been read: what a generator makes can then be written
 * like any other mesh. polygons: borrowed. SL_BAD_INPUT (a coordinate not finite, an index out of range, a face of
 * fewer than 3 corners), SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_meshfile_from_polygons(const sl_polygons *polygons, sl_meshfile **out, sl_diag *diag);

/* Writes the file with other UVs, atomically. The extension of path decides the format ("-": standard output, in the
 * input's own format, OBJ for OFF).
 *
 *   corner_uv   2 doubles a corner, borrowed; both NaN = this corner has none. NULL = the input's own.
 *
 * Every number reads back as exactly the same double. Own format: names, materials, normals, colours, extra properties
 * and elements stay as they are, in their order, in the input's encoding; OBJ texture vertices are shared by corners of
 * equal vertex and UV and numbered in the order of first use; PLY faces get a list `texcoord` of doubles, in the place
 * of any UVs the input had, and triangle strips become faces.
 * SL_UNSUPPORTED (OFF, or an extension that is none of ours: the hint names formats that do), SL_IO, SL_OUT_OF_MEMORY,
 * SL_BAD_INPUT (a UV is infinite: diag names the corner). */
SL_NODISCARD sl_status sl_meshfile_write(const char *path, const sl_meshfile *file, const double *corner_uv,
                                         sl_diag *diag);

/* Says in words what writing to path would lose ("3 line elements, 2 extra properties"); "" and false when nothing.
 * text is always terminated. */
bool sl_meshfile_losses(const sl_meshfile *file, const char *path, char *text, size_t size);

/* The polygons, borrowed from the file. */
void sl_meshfile_polygons(const sl_meshfile *file, sl_polygons *polygons);

/* True when sl_meshfile_write can put UVs into a file of this name. */
bool sl_meshfile_can_hold_uv(const char *path);

void sl_meshfile_free(sl_meshfile *file); /* NULL is a no-op */

/* The nearest multiple of 1e-12: what survives being written with 12 decimals. Quantise before the last check of an
 * atlas. |u| < 9007; larger numbers come back unchanged but for rounding. NaN stays NaN. */
double sl_uv_quantise(double u);

#endif
