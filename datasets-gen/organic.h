/* Generators of organic shapes, box-modelled and smoothed: animals, an airliner, clothes, a low-polygon figure.
 * Layer: datasets-gen. */
#ifndef SL_GENERATORS_ORGANIC_H
#define SL_GENERATORS_ORGANIC_H

#include "generators.h"

/* One a file; all but the snake are symmetric about x = 0 to the bit. */
sl_generate_fn gen_quadruped, gen_octopus, gen_starfish, gen_crab, gen_fish, gen_bird, gen_seahorse, gen_snake;
sl_generate_fn gen_turtle, gen_airplane, gen_pullover, gen_character;

#endif
