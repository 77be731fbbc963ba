#include "generators.h"

#include "base/memory.h"
#include "builder.h"

#include <string.h>

static const sl_generator table[] = {
    {"hand", "a left hand, closed at the wrist; quads", gen_hand, 0, 1, 0},
    {"body", "a standing person, mirror symmetric to the bit; quads", gen_body, 0, 1, 0},
    {"spiky", "a ball with fourteen spikes, their places from the seed; quads", gen_spiky, 0, 1, 0},
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
