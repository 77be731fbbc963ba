/* The generators that are not organic: tubes, parts, solids, scans, variants of others.
 * Layer: datasets-gen. */
#ifndef SL_GENERATORS_MODELS_H
#define SL_GENERATORS_MODELS_H

#include "generators.h"

sl_generate_fn gen_tube, gen_spring, gen_fork, gen_tree;                     /* tubes.c, branches.c */
sl_generate_fn gen_bracket, gen_plate, gen_gear, gen_bolt, gen_tee, gen_mug; /* parts */
sl_generate_fn gen_double_torus, gen_pretzel, gen_frame;                     /* genus.c */
sl_generate_fn gen_cube, gen_slab, gen_beam, gen_icosphere, gen_football;    /* solids */
sl_generate_fn gen_propeller, gen_snowflake;                                 /* turning symmetries */
sl_generate_fn gen_rock, gen_bust;                                           /* scans */
sl_generate_fn gen_body_uneven, gen_body_remeshed, gen_leaning;              /* variants.c */
sl_generate_fn gen_boat, gen_wagon, gen_chain;                               /* straddled planes, copies */

#endif
