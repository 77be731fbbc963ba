/* OUT.atlas.json: what stands beside every atlas written.
 * Layer: atlas. */
#ifndef SL_ATLAS_SIDECAR_H
#define SL_ATLAS_SIDECAR_H

#include "atlas/atlas.h"
#include "atlas/measure.h"

#define SL_SIDECAR_SCHEMA 2 /* 2: charts say what they copy; "symmetry" */

/* OUT.obj -> OUT.atlas.json, into text (always terminated). */
void sl_sidecar_path(const char *atlas_path, char *text, size_t size);

/* The sidecar's JSON text, terminated; owned by the caller (sl_free). Charts of the facets, seams by input vertices and
 * facets, splits, repair, options, warnings, fallbacks, the check as certificate. SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_sidecar_text(const sl_atlas *atlas, const sl_atlas_def *def, char **text);

/* Which charts are shared, by the sidecar at path. nf: facets of the mesh that it should belong to. SL_IO (no such
 * file), SL_BAD_INPUT (no sidecar, or of another mesh; diag, nullable, says why), SL_OUT_OF_MEMORY. Schema 1 shares
 * nothing. */
SL_NODISCARD sl_status sl_sidecar_read(const char *path, int32_t nf, sl_sharing_table *table, sl_diag *diag);

/* Writes it, atomically. SL_IO, SL_OUT_OF_MEMORY. */
SL_NODISCARD sl_status sl_sidecar_write(const char *path, const sl_atlas *atlas, const sl_atlas_def *def,
                                        sl_diag *diag);

#endif
