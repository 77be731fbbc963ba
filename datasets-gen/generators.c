#include "generators.h"

#include "base/memory.h"
#include "builder.h"
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
