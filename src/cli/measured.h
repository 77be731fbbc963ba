/* An atlas measured from a file, and its columns.
 * Layer: cli. */
#ifndef SL_CLI_MEASURED_H
#define SL_CLI_MEASURED_H

#include "atlas/measure.h"
#include "cli/cli.h"

#include <jansson.h>

/* Reads a mesh with UVs, and the sidecar beside it where one stands, and measures. Returns the exit code; what went
 * wrong has been said. */
int cli_measure_path(cli_run *run, const char *path, int32_t resolution, sl_atlas_measure *out);

/* The columns as an object, "file": name; infinite values are null. Column names are those of the comparison tables of
 * other tools. Owned by the caller. */
json_t *cli_measure_json(const char *name, const sl_atlas_measure *m);

#endif
