/* Scans: dense irregular triangles with noise. A rock without any symmetry; a bust, symmetric but for the noise. */
#include "boxmodel.h"
#include "geom/vec3.h"
#include "grid.h"
#include "icosphere.h"
#include "models.h"
#include "plant.h"
#include "roughen.h"

#include <math.h>

enum { CUTS = 15, WAVES = 20 };

/* A stone: broken along planes, weathered. */
typedef struct stone {
    double plane[CUTS][3], height[CUTS];
    double wave[WAVES][3], phase[WAVES], size[WAVES];
} stone;

static void random_direction(sl_rng *rng, double d[3])
{
    const double z = 2.0 * sl_rng_uniform(rng) - 1.0, phi = 6.28318530717958648 * sl_rng_uniform(rng);
    const double r = sqrt(1.0 - z * z);
    d[0] = r * cos(phi);
    d[1] = r * sin(phi);
    d[2] = z;
}

static void draw_stone(sl_rng *rng, stone *s)
{
    for (int k = 0; k < CUTS; k++) {
        random_direction(rng, s->plane[k]);
        s->height[k] = 0.75 + 0.35 * sl_rng_uniform(rng);
    }
    for (int k = 0; k < WAVES; k++) {
        const double frequency = 2.0 * pow(1.16, k);
        random_direction(rng, s->wave[k]);
        for (int i = 0; i < 3; i++) {
            s->wave[k][i] *= frequency;
        }
        s->phase[k] = 6.28318530717958648 * sl_rng_uniform(rng);
        s->size[k] = 0.055 / frequency;
    }
}

/* How far the surface is in direction d: within all planes, their edges rounded, plus waves. */
static double stone_radius(const stone *s, const double d[3])
{
    double sum = pow(1.35, -14.0), waves = 0.0;
    for (int k = 0; k < CUTS; k++) {
        const double facing = sl_vec3_dot(d, s->plane[k]);
        sum += facing > 0.0 ? pow(s->height[k] / facing, -14.0) : 0.0;
    }
    for (int k = 0; k < WAVES; k++) {
        waves += s->size[k] * sin(sl_vec3_dot(d, s->wave[k]) + s->phase[k]);
    }
    return pow(sum, -1.0 / 14.0) + waves;
}

sl_status gen_rock(uint64_t seed, int32_t scale, sl_generated **out)
{
    sl_rng rng = sl_rng_seed(seed);
    gen_builder b = {0};
    stone s;
    draw_stone(&rng, &s);
    gen_icosphere_into(&b, gen_refined(17, scale));
    for (int64_t v = 0; v < b.nv && !b.failed; v++) {
        double *p = b.xyz + 3 * v;
        const double r = stone_radius(&s, p), stretch[3] = {1.25, 0.85, 1.0};
        for (int k = 0; k < 3; k++) {
            p[k] *= r * stretch[k];
        }
    }
    gen_flip_edges(&b, &rng, 4);
    gen_add_noise(&b, &rng, 0.10);
    return gen_finish(&b, out);
}

/* Levels of the bust's chest: height, half width, half depth, how far forward. */
static const double chest[5][4] = {
    {11.30, 0.80, 0.62, 0.00}, {11.90, 1.40, 0.95, 0.06},  {12.80, 1.86, 1.15, 0.10},
    {13.70, 2.05, 1.10, 0.02}, {14.60, 1.62, 0.72, -0.12},
};

static void add_chest(gen_cage *cage)
{
    static const double x[3] = {0.0, 1.0, 2.0}, y[5] = {0.0, 1.0, 2.0, 3.0, 4.0}, z[3] = {-1.0, 0.0, 1.0};
    gen_cage_box(cage, (const int32_t[]){2, 4, 2}, (const double *const[]){x, y, z});
    for (int64_t v = 0; v < cage->nv && !cage->failed; v++) {
        double *p = cage->xyz + 3 * v;
        const double *level = chest[(int)p[1]];
        const bool edge = p[0] == 2.0, top = p[1] == 4.0;
        p[1] = level[0] - (edge && top ? 0.35 : 0.0);
        p[2] = level[3] + p[2] * level[2] * (edge ? 0.72 : 1.0);
        p[0] = p[0] == 0.0 ? 0.0 : level[1] * (edge ? 1.0 : 0.4);
    }
}

static void add_foot_and_head(gen_cage *cage)
{
    static const double side[3] = {1.0, 0.0, 0.0};
    static const gen_station foot[] = {{{0.0, 10.95, 0.0}, 0.55, 0.55},
                                       {{0.0, 10.45, 0.0}, 0.55, 0.55},
                                       {{0.0, 10.15, 0.0}, 1.25, 1.25},
                                       {{0.0, 9.75, 0.0}, 1.30, 1.30},
                                       {{0.0, 9.65, 0.0}, 1.22, 1.22}};
    static const gen_station head[] = {{{0.0, 15.10, -0.05}, 0.62, 0.62}, {{0.0, 15.60, 0.06}, 0.64, 0.70},
                                       {{0.0, 15.95, 0.22}, 0.88, 1.06},  {{0.0, 16.55, 0.20}, 1.04, 1.22},
                                       {{0.0, 17.25, 0.10}, 1.10, 1.30},  {{0.0, 17.95, 0.02}, 0.96, 1.12},
                                       {{0.0, 18.30, 0.00}, 0.52, 0.62}};
    static const gen_station nose[] = {{{0.0, 16.92, 1.36}, 0.17, 0.34}, {{0.0, 16.74, 1.54}, 0.20, 0.17}};
    static const gen_station ear[] = {{{1.20, 16.85, -0.02}, 0.26, 0.34}, {{1.34, 16.90, -0.12}, 0.22, 0.34}};
    const int32_t below[4] = {gen_cage_nearest(cage, 0.2, 11.3, -0.4), gen_cage_nearest(cage, 0.2, 11.3, 0.4),
                              gen_cage_nearest(cage, 0.6, 11.3, -0.4), gen_cage_nearest(cage, 0.6, 11.3, 0.4)};
    gen_cage_limb(cage, below, 4, side, foot, (int32_t)SL_COUNTOF(foot));
    const int32_t neck[2] = {gen_cage_nearest(cage, 0.3, 14.6, -0.45), gen_cage_nearest(cage, 0.3, 14.6, 0.3)};
    gen_cage_limb(cage, neck, 2, side, head, (int32_t)SL_COUNTOF(head));
    const int32_t face = gen_cage_nearest(cage, 0.35, 16.9, 1.25), temple = gen_cage_nearest(cage, 1.1, 16.9, -0.3);
    gen_cage_limb(cage, &face, 1, side, nose, (int32_t)SL_COUNTOF(nose));
    gen_cage_limb(cage, &temple, 1, (const double[]){0.0, 0.0, 1.0}, ear, (int32_t)SL_COUNTOF(ear));
}

/* A dent or bump of the face, on both sides: middle, reach across and upright, how far forward. */
typedef struct feature {
    double x, y, wide, high, forward;
} feature;

static void shape_face(gen_builder *b)
{
    static const feature face[] = {
        {0.42, 17.02, 0.26, 0.17, -0.26},                                  /* sockets */
        {0.43, 17.03, 0.15, 0.10, 0.16},                                   /* eyes */
        {0.42, 17.32, 0.34, 0.12, 0.09},                                   /* brows */
        {0.00, 16.22, 0.34, 0.06, -0.13},                                  /* mouth */
        {0.00, 16.36, 0.22, 0.07, 0.08},                                   /* lips */
        {0.00, 16.08, 0.22, 0.07, 0.09},  {0.00, 15.74, 0.28, 0.16, 0.16}, /* chin */
        {0.62, 16.55, 0.24, 0.22, 0.07},                                   /* cheeks */
    };
    for (int64_t v = 0; v < b->nv && !b->failed; v++) {
        double *p = b->xyz + 3 * v, move = 0.0;
        for (size_t k = 0; k < SL_COUNTOF(face) && p[2] > 0.3 && p[1] > 15.0; k++) {
            const double s = (fabs(p[0]) - face[k].x) / face[k].wide, t = (p[1] - face[k].y) / face[k].high;
            move += face[k].forward * exp(-s * s - t * t);
        }
        p[2] += move * fmin(1.0, fmax(0.0, 2.0 * (p[2] - 0.3)));
    }
}

sl_status gen_bust(uint64_t seed, int32_t scale, sl_generated **out)
{
    static const double here[12] = {1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0};
    static const double mirror[12] = {-1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0};
    gen_cage cage = {.mirrored = true};
    gen_builder b = {0};
    sl_rng rng = sl_rng_seed(seed);
    sl_generated *smooth = NULL;
    add_chest(&cage);
    if (!cage.failed) {
        add_foot_and_head(&cage);
    }
    const sl_status status = gen_cage_finish(&cage, 1 + scale, &smooth);
    if (status != SL_OK) {
        *out = NULL;
        return status;
    }
    gen_append(&b, smooth, here);
    sl_generated_free(smooth);
    shape_face(&b);
    gen_split_quads(&b, &rng);
    gen_flip_edges(&b, &rng, 3);
    gen_add_noise(&b, &rng, 0.09);
    const sl_status finished = gen_finish(&b, out);
    return finished != SL_OK ? finished : gen_planted(gen_plant_near(*out, "mirror x", mirror), out);
}
