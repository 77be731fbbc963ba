#include "cli/pack_options.h"

#include <string.h>

void cli_pack_table(cli_pack_options *o, cli_option *table)
{
    sl_pack_def *def = &o->def;
    const cli_option entries[CLI_PACK_OPTIONS] = {
        {"resolution", 0, CLI_INT, &def->resolution, 16, 65536, NULL, "N", "texels along a page's width (2048)"},
        {"height", 0, CLI_INT, &def->height, 16, 65536, NULL, "N", "texels along its height (as the width)"},
        {"margin", 0, CLI_REAL, &def->margin, 0, 1024, NULL, "T", "texels between charts (4)"},
        {"rotations", 0, CLI_CHOICE, &o->rotations, 0, 0, "free|right|none", NULL,
         "charts are packed turned by any angle, right ones, none"},
        {"pages", 0, CLI_INT, &def->pages, 1, 1000, NULL, "N", "at most so many pages (1)"},
        {"density", 0, CLI_REAL, &def->density, 0, 1e12, NULL, "D",
         "texels a unit of length in space; 0 = the most that fit (default)"},
        {"effort", 0, CLI_INT, &def->effort, 0, 12, NULL, "E",
         "work spent on packing, doubled by each step (unwrap 2, pack 6)"},
    };
    memcpy(table, entries, sizeof entries);
}

void cli_pack_apply(cli_pack_options *o)
{
    o->def.rotations = (sl_pack_rotations)o->rotations;
}
