/* The pictures of --preview.
 * Layer: cli. */
#ifndef SL_CLI_PREVIEW_H
#define SL_CLI_PREVIEW_H

#include "atlas/atlas.h"
#include "cli/cli.h"

/* Writes model.png, atlas.png and both.png into the folder, made if need be. Returns the exit code. */
int cli_preview(cli_run *run, const char *folder, const sl_atlas *atlas);

#endif
