#include "generators.h"

#include "base/memory.h"
#include "builder.h"
#include "models.h"
#include "organic.h"

#include <string.h>

static const sl_generator table[] = {
    {"hand", "a left hand, closed at the wrist; quads", gen_hand, 0, 1, 0},
    {"body", "a standing person, mirror symmetric to the bit; quads", gen_body, 0, 1, 0},
    {"spiky", "a ball with fourteen spikes, their places from the seed; quads", gen_spiky, 0, 1, 0},
    {"quadruped", "a dog standing, its tail up; quads, one mirror", gen_quadruped, 0, 1, 0},
    {"octopus", "an octopus with eight curled arms; quads, one mirror", gen_octopus, 0, 1, 0},
    {"starfish", "a starfish, five-fold; quads, five mirrors", gen_starfish, 0, 1, 0},
    {"crab", "a crab with legs, claws, eyes and antennas, one closed surface; quads, one mirror", gen_crab, 0, 1, 0},
    {"fish", "a fish with its fins spread; quads, one mirror", gen_fish, 0, 1, 0},
    {"bird", "a bird gliding, its wings fingered; quads, one mirror", gen_bird, 0, 1, 0},
    {"seahorse", "a seahorse, its tail in a spiral; quads, one mirror", gen_seahorse, 0, 1, 0},
    {"snake", "a snake coiled up, its head raised; quads, no symmetry of the shape", gen_snake, 0, 1, 0},
    {"turtle", "a sea turtle; quads, one mirror", gen_turtle, 0, 1, 0},
    {"airplane", "an airliner with two engines; quads, one mirror", gen_airplane, 0, 1, 0},
    {"pullover", "a pullover, open at waist, cuffs and collar; quads, one mirror", gen_pullover, 0, 1, 4},
    {"character", "a low-polygon girl in a skirt; triangles, quads and hexagons, one mirror", gen_character, 0, 1, 0},
    {"sphere", "a sphere of meridians and parallels, triangles at the poles", gen_sphere, 0, 1, 0},
    {"torus", "a torus of quads, genus 1", gen_torus, 1, 1, 0},
    {"box", "a closed box of quads: sharp edges, flat faces", gen_box, 0, 1, 0},
    {"tube", "an open pipe bent to a U; quads, two mirrors", gen_tube, 0, 1, 2},
    {"spring", "a coil spring, its ends polygons; half a turn, no mirror", gen_spring, 0, 1, 0},
    {"fork", "a tube with two prongs; quads, two mirrors", gen_fork, 0, 1, 0},
    {"tree", "a trunk with boughs and twigs from the seed; quads, no symmetry at all", gen_tree, 0, 1, 0},
    {"plate", "a machine plate with four holes, genus 4; quads, three mirrors", gen_plate, 4, 1, 0},
    {"bracket", "an angle bracket with four holes, genus 4; quads, two mirrors", gen_bracket, 4, 1, 0},
    {"gear", "a gear of sixteen teeth, genus 1; quads, the teeth's sides polygons; turns and mirrors", gen_gear, 1, 1,
     0},
    {"bolt", "a bolt with a hexagonal head; quads, its ends polygons; six mirrors", gen_bolt, 0, 1, 0},
    {"tee", "a pipe joint with three open ends; quads, two mirrors", gen_tee, 0, 1, 3},
    {"mug", "a mug with a handle, genus 1; quads, one mirror", gen_mug, 1, 1, 0},
    {"double-torus", "a smooth surface of genus 2; quads, three mirrors", gen_double_torus, 2, 1, 0},
    {"pretzel", "a pretzel, genus 3; quads, two mirrors", gen_pretzel, 3, 1, 0},
    {"frame", "the rounded edges of a cube, genus 5; quads, all symmetries of the cube", gen_frame, 5, 1, 0},
    {"cube", "a cube of 8 x 8 x 8 squares: a spectrum of repeated eigenvalues", gen_cube, 0, 1, 0},
    {"slab", "a box of 8 x 8 x 4 squares: repeated eigenvalues", gen_slab, 0, 1, 0},
    {"beam", "a box of 4 x 4 x 12 squares: repeated eigenvalues", gen_beam, 0, 1, 0},
    {"icosphere", "a subdivided icosahedron; triangles, fifteen mirrors", gen_icosphere, 0, 1, 0},
    {"football", "twelve pentagons among hexagons, fifteen mirrors", gen_football, 0, 1, 0},
    {"propeller", "a ship's propeller of three twisted blades; quads, turns but no mirror", gen_propeller, 0, 1, 0},
    {"snowflake", "a snowflake of six arms, genus 6; triangles and quads, seven mirrors", gen_snowflake, 6, 1, 0},
    {"rock", "the scan of a rock from the seed: irregular triangles, noise, no symmetry", gen_rock, 0, 1, 0},
    {"bust", "the scan of a bust from the seed: irregular triangles, noise, about symmetric", gen_bust, 0, 1, 0},
    {"body-uneven", "the body with positions moved by the seed: its connectivity is symmetric", gen_body_uneven, 0, 1,
     0},
    {"body-remeshed", "the body with quads split on one side: symmetric as a surface only", gen_body_remeshed, 0, 1, 0},
    {"leaning", "the body bent and twisted: symmetric connectivity, asymmetric shape", gen_leaning, 0, 1, 0},
    {"boat", "a rowing boat; quads, two polygons, a mirror through the middles of facets", gen_boat, 0, 1, 0},
    {"wagon", "a toy car on four equal wheels: five components, one mirror", gen_wagon, 0, 5, 0},
    {"chain", "five equal links, each of genus 1: five components, three mirrors", gen_chain, 5, 5, 0},
};

const sl_generator *sl_generators(int32_t *count)
{
    *count = (int32_t)SL_COUNTOF(table);
    return table;
}

const sl_generator *sl_generator_find(const char *name)
{
    for (size_t k = 0; k < SL_COUNTOF(table); k++) {
        if (strcmp(table[k].name, name) == 0) {
            return &table[k];
        }
    }
    return NULL;
}

void sl_generated_polygons(const sl_generated *mesh, sl_polygons *polygons)
{
    *polygons = (sl_polygons){mesh->nv, mesh->nf, mesh->xyz, mesh->face_first, mesh->index};
}

void sl_generated_free(sl_generated *mesh)
{
    if (mesh == NULL) {
        return;
    }
    sl_free(mesh->xyz);
    sl_free(mesh->face_first);
    sl_free(mesh->index);
    for (int32_t k = 0; k < mesh->nplanted; k++) {
        sl_free(mesh->planted[k].vertex);
        sl_free(mesh->planted[k].face);
    }
    sl_free(mesh->planted);
    sl_free(mesh->near);
    sl_free(mesh);
}
