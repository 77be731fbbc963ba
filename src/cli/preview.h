/* The pictures of --preview.
 * Layer: cli. */
#ifndef SL_CLI_PREVIEW_H
#define SL_CLI_PREVIEW_H

#include "atlas/atlas.h"
#include "cli/cli.h"
#include "image/image.h"

enum { CLI_PICTURES = 3 };

/* both.png, model.png, atlas.png in memory. */
typedef struct cli_pictures {
    sl_image *image[CLI_PICTURES];
} cli_pictures;

/* Draws them. Returns the exit code; out is cleared by the caller in any case. Done before anything is written: after
 * an interruption the old files stand. */
int cli_pictures_draw(cli_run *run, const sl_atlas *atlas, cli_pictures *out);

/* Writes them into the folder, made if need be. Returns the exit code. */
int cli_pictures_write(cli_run *run, const char *folder, const cli_pictures *pictures);

void cli_pictures_clear(cli_pictures *pictures);

#endif
