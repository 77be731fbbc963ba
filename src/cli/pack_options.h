/* The options that say how charts are packed, shared by `unwrap` and `pack`.
 * Layer: cli. */
#ifndef SL_CLI_PACK_OPTIONS_H
#define SL_CLI_PACK_OPTIONS_H

#include "cli/options.h"
#include "pack/pack.h"

typedef struct cli_pack_options {
    sl_pack_def def;
    int32_t rotations; /* position in its choices */
} cli_pack_options;

#define CLI_PACK_OPTIONS 7

/* Fills CLI_PACK_OPTIONS entries; o->def holds the defaults. */
void cli_pack_table(cli_pack_options *o, cli_option *table);

/* Copies the choices into o->def after parsing. */
void cli_pack_apply(cli_pack_options *o);

#endif
