/* A ball with spikes: where they stand, how long and how they lean is drawn from the seed. */
#include "base/rng.h"
#include "boxmodel.h"
#include "builder.h"
#include "geom/vec3.h"

#include <math.h>

enum { SPIKES = 14, BALL_BLOCKS = 4, TRIES = 60, SPIKE_STATIONS = 4 };

/* A random direction, uniform on the sphere. */
static void random_direction(sl_rng *rng, double d[3])
{
    const double z = 2.0 * sl_rng_uniform(rng) - 1.0, phi = 6.28318530717958648 * sl_rng_uniform(rng);
    const double r = sqrt(1.0 - z * z);
    d[0] = r * cos(phi);
    d[1] = r * sin(phi);
    d[2] = z;
}

static void quad_centre(const gen_cage *cage, int32_t q, double centre[3])
{
    for (int k = 0; k < 3; k++) {
        centre[k] = 0.0;
        for (int i = 0; i < 4; i++) {
            centre[k] += 0.25 * cage->xyz[3 * (int64_t)cage->quad[4 * (int64_t)q + i] + k];
        }
    }
}

/* The quads the spikes grow from, far from one another: of some random ones each time the one farthest from those
 * taken. Source: Mitchell 1991, "Spectrally optimal sampling for distribution ray tracing" (best candidate). */
static void choose_quads(const gen_cage *cage, sl_rng *rng, int32_t chosen[SPIKES])
{
    for (int32_t s = 0; s < SPIKES; s++) {
        double best = -1.0;
        for (int t = 0; t < TRIES; t++) {
            double d[3], centre[3], other[3], nearest = 4.0;
            random_direction(rng, d);
            const int32_t q = gen_cage_nearest(cage, d[0], d[1], d[2]);
            quad_centre(cage, q, centre);
            for (int32_t k = 0; k < s; k++) {
                quad_centre(cage, chosen[k], other);
                nearest = fmin(nearest, sl_vec3_distance(centre, other));
            }
            if (nearest > best) {
                best = nearest;
                chosen[s] = q;
            }
        }
    }
}

static void add_spike(gen_cage *cage, sl_rng *rng, int32_t quad)
{
    static const double at[SPIKE_STATIONS] = {0.12, 0.42, 0.75, 1.0}, radius[SPIKE_STATIONS] = {0.80, 0.50, 0.26, 0.07};
    gen_station station[SPIKE_STATIONS];
    double base[3], lean[3];
    const double length = 0.9 + 0.7 * sl_rng_uniform(rng);
    quad_centre(cage, quad, base);
    random_direction(rng, lean);
    const double norm = sl_vec3_norm(base);
    for (int s = 0; s < SPIKE_STATIONS; s++) {
        for (int k = 0; k < 3; k++) {
            station[s].centre[k] = base[k] + length * (at[s] * base[k] / norm + 0.12 * at[s] * at[s] * lean[k]);
        }
        station[s].width = station[s].depth = 0.34 * radius[s];
    }
    /* any side that is not along the spike */
    const double side[3] = {fabs(base[0]) < 0.6 ? 1.0 : 0.0, fabs(base[0]) < 0.6 ? 0.0 : 1.0, 0.0};
    gen_cage_limb(cage, &quad, 1, side, station, SPIKE_STATIONS);
}

sl_status gen_spiky(uint64_t seed, int32_t scale, sl_generated **out)
{
    static const double at[BALL_BLOCKS + 1] = {-1.0, -0.46, 0.0, 0.46, 1.0};
    gen_cage cage = {0};
    sl_rng rng = sl_rng_seed(seed);
    int32_t chosen[SPIKES];
    gen_cage_box(&cage, (const int32_t[]){BALL_BLOCKS, BALL_BLOCKS, BALL_BLOCKS}, (const double *const[]){at, at, at});
    for (int64_t v = 0; v < cage.nv && !cage.failed; v++) {
        double *p = cage.xyz + 3 * v;
        const double norm = sl_vec3_norm(p);
        for (int k = 0; k < 3; k++) {
            p[k] /= norm;
        }
    }
    if (!cage.failed) {
        choose_quads(&cage, &rng, chosen);
    }
    for (int32_t s = 0; s < SPIKES && !cage.failed; s++) {
        add_spike(&cage, &rng, chosen[s]);
    }
    return gen_cage_finish(&cage, 1 + scale, out);
}
