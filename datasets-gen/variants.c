/* The body once more: with uneven positions, with uneven connectivity, bent to one side. */
#include "base/rng.h"
#include "builder.h"
#include "grid.h"
#include "models.h"
#include "plant.h"

#include <math.h>

static const double body_height = 18.3;

/* A smooth seeded displacement: long waves, none longer than the body, and a little of short ones. */
static void make_uneven(sl_generated *mesh, uint64_t seed)
{
    enum { UNEVEN_WAVES = 12 };
    sl_rng rng = sl_rng_seed(seed);
    double wave[UNEVEN_WAVES][3], phase[UNEVEN_WAVES], move[UNEVEN_WAVES][3];
    for (int k = 0; k < UNEVEN_WAVES; k++) {
        const double frequency = (4.0 + 3.0 * k) / body_height;
        for (int i = 0; i < 3; i++) {
            wave[k][i] = frequency * (2.0 * sl_rng_uniform(&rng) - 1.0);
            move[k][i] = 0.0012 * body_height * (2.0 * sl_rng_uniform(&rng) - 1.0);
        }
        phase[k] = 6.28318530717958648 * sl_rng_uniform(&rng);
    }
    for (int64_t v = 0; v < mesh->nv; v++) {
        double *p = mesh->xyz + 3 * v, sum[3] = {0.0, 0.0, 0.0};
        for (int k = 0; k < UNEVEN_WAVES; k++) {
            const double s = sin(wave[k][0] * p[0] + wave[k][1] * p[1] + wave[k][2] * p[2] + phase[k]);
            for (int i = 0; i < 3; i++) {
                sum[i] += move[k][i] * s;
            }
        }
        for (int i = 0; i < 3; i++) {
            p[i] += sum[i];
        }
    }
}

sl_status gen_body_uneven(uint64_t seed, int32_t scale, sl_generated **out)
{
    const sl_status status = gen_body(seed, scale, out);
    if (status == SL_OK) {
        make_uneven(*out, seed);
        for (int32_t k = 0; k < (*out)->nplanted; k++) {
            (*out)->planted[k].exact = false;
        }
    }
    return status;
}

enum { SPLIT_QUADS = 24 };

/* Splits quads on the side x > 0, drawn from the seed: the surface is the same but for their diagonals. */
static void split_some(const sl_generated *body, uint64_t seed, gen_builder *b)
{
    static const double here[12] = {1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0};
    sl_rng rng = sl_rng_seed(seed);
    gen_append(b, body, here);
    for (int32_t left = SPLIT_QUADS, tries = 100 * SPLIT_QUADS; left > 0 && tries > 0 && !b->failed; tries--) {
        const int64_t f = (int64_t)(sl_rng_uniform(&rng) * body->nf);
        int32_t *c = b->index + b->first[f];
        bool right = b->first[f + 1] - b->first[f] == 4 && c[2] != c[3];
        for (int k = 0; k < 4 && right; k++) {
            right = b->xyz[3 * (int64_t)c[k]] > 0.0;
        }
        if (right) {
            const int k = (int)(sl_rng_bits(&rng) >> 63);
            const int32_t corner[4] = {c[k], c[k + 1], c[(k + 2) % 4], c[(k + 3) % 4]};
            c[0] = corner[0]; /* the quad becomes a triangle with its last corner twice, which welding takes out */
            c[1] = corner[1];
            c[2] = c[3] = corner[2];
            gen_triangle(b, corner[0], corner[2], corner[3]);
            left--;
        }
    }
    gen_weld(b, gen_weld_tolerance);
}

sl_status gen_body_remeshed(uint64_t seed, int32_t scale, sl_generated **out)
{
    static const double mirror[12] = {-1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0};
    sl_generated *body = NULL;
    gen_builder b = {0};
    *out = NULL;
    sl_status status = gen_body(seed, scale, &body);
    if (status != SL_OK) {
        return status;
    }
    split_some(body, seed, &b);
    sl_generated_free(body);
    status = gen_finish(&b, out);
    return status != SL_OK ? status : gen_planted(gen_plant_near(*out, "mirror x", mirror), out);
}

/* Bent sideways into an arc and twisted about the upright axis, more and more towards the top. */
static void lean(double p[3])
{
    const double bend = 0.055, twist = 0.035;
    const double turn = twist * p[1], c = cos(turn), s = sin(turn);
    const double x = c * p[0] + s * p[2], z = c * p[2] - s * p[0], angle = bend * p[1], r = 1.0 / bend - x;
    p[0] = 1.0 / bend - r * cos(angle);
    p[1] = r * sin(angle);
    p[2] = z;
}

/* Of the body's connectivity, symmetric; the geometry is not, so nothing is planted. */
sl_status gen_leaning(uint64_t seed, int32_t scale, sl_generated **out)
{
    const sl_status status = gen_body(seed, scale, out);
    for (int64_t v = 0; status == SL_OK && v < (*out)->nv; v++) {
        lean((*out)->xyz + 3 * v);
    }
    if (status == SL_OK) {
        gen_forget(*out);
    }
    return status;
}
