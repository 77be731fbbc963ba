/* The options that decide where a mesh is cut, shared by `unwrap` and `segment`.
 * Layer: cli. */
#ifndef SL_CLI_SEGMENT_OPTIONS_H
#define SL_CLI_SEGMENT_OPTIONS_H

#include "cli/options.h"
#include "optimize/optimize.h"

typedef enum cli_preset { CLI_PRESET_BEST, CLI_PRESET_FAST, CLI_PRESET_PAPER } cli_preset; /* as in the option's text */

typedef struct cli_segment_options {
    sl_segment_def def;
    sl_optimize_def optimize;
    bool weights;
    bool best;                                                        /* --preset best: cut by sl_optimize_segment */
    int32_t method, rule, pairing, energy, preset, symmetry, protect; /* positions in their choices */
} cli_segment_options;

#define CLI_SEGMENT_OPTIONS 38

/* Looks for --preset in argv and sets its values, so that every other option overrides it wherever it stands; usual =
 * the verb's own where there is none. */
void cli_segment_preset(cli_segment_options *o, cli_preset usual, int argc, char **argv);

/* Fills CLI_SEGMENT_OPTIONS entries. */
void cli_segment_table(cli_segment_options *o, cli_option *table);

/* Copies the choices into o->def after parsing. */
void cli_segment_apply(cli_segment_options *o);

#endif
