/* seamlab compare: atlases that stand side by side.
 * Layer: cli. */
#ifndef SL_CLI_COMPARE_H
#define SL_CLI_COMPARE_H

#include "atlas/measure.h"
#include "cli/cli.h"
#include "draw/camera.h"

/* One atlas of the comparison. */
typedef struct cli_contender {
    const char *path; /* borrowed */
    char name[64];
    sl_atlas_measure measure;
} cli_contender;

typedef struct cli_compare_pictures {
    const char *output; /* a .png, or a folder */
    int32_t side;       /* pixels of a panel */
    sl_view view;
    bool fast; /* without shadows */
} cli_compare_pictures;

/* Draws every contender in space and in UV space, with a checkerboard whose squares have one size on all surfaces, and
 * writes one picture of them all; into a folder one of each besides. Returns the exit code. */
int cli_compare_draw(cli_run *run, const cli_contender *contender, int32_t count, const cli_compare_pictures *how);

#endif
