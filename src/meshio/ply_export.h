/* PLY files of polygons with colours or numbers on their faces, for looking at and for other programs.
 * Layer: meshio. */
#ifndef SL_MESHIO_PLY_EXPORT_H
#define SL_MESHIO_PLY_EXPORT_H

#include "mesh/build.h"

/* Writes the polygons with a colour on each face, binary little endian, atomically ("-" = standard output).
 * face_rgb: nf x 3. SL_IO, SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_ply_write_colored(const char *path, const sl_polygons *polygons, const uint8_t *face_rgb,
                                            sl_diag *diag);

/* Writes the polygons with named doubles on each face. name[k] is one word; value[k] has nf doubles; columns >= 0. */
SL_NODISCARD sl_status sl_ply_write_values(const char *path, const sl_polygons *polygons, int32_t columns,
                                           const char *const *name, const double *const *value, sl_diag *diag);

#endif
