/* OUT.atlas.json: what stands beside every atlas written.
 * Layer: atlas. */
#ifndef SL_ATLAS_SIDECAR_H
#define SL_ATLAS_SIDECAR_H

#include "atlas/atlas.h"

#define SL_SIDECAR_SCHEMA 1

/* OUT.obj -> OUT.atlas.json, into text (always terminated). */
void sl_sidecar_path(const char *atlas_path, char *text, size_t size);

/* The sidecar's JSON text, terminated; owned by the caller (sl_free). Charts of the facets, seams by input vertices and
 * facets, splits, repair, options, warnings, fallbacks, the check as certificate. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_sidecar_text(const sl_atlas *atlas, const sl_atlas_def *def, char **text);

/* Writes it, atomically. SL_IO, SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_sidecar_write(const char *path, const sl_atlas *atlas, const sl_atlas_def *def,
                                        sl_diag *diag);

#endif
