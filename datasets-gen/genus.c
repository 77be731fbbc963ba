/* Smooth surfaces with two, three and five holes, and a pipe joint with three ends: blocks, subdivided. */
#include "models.h"
#include "plant.h"
#include "voxels.h"

#include <math.h>

/* Without the steps of the blocks. */
static sl_status finish_round(gen_cage *cage, int32_t scale, sl_generated **out)
{
    gen_cage_relax_flat(cage, 2);
    gen_cage_smooth(cage);
    gen_cage_relax_flat(cage, 12);
    return gen_cage_finish(cage, scale, out);
}

sl_status gen_double_torus(uint64_t seed, int32_t scale, sl_generated **out)
{
    static const char *const layer[] = {".###.###."
                                        "##.###.##"
                                        "#...#...#"
                                        "##.###.##"
                                        ".###.###."};
    (void)seed; /* nothing random */
    gen_cage cage = {0};
    gen_cage_voxels(&cage, (const int32_t[]){9, 5, 1}, layer);
    const sl_status status = finish_round(&cage, scale, out);
    return status != SL_OK ? status : gen_planted(gen_plant_mirrors(*out, "xyz", true), out);
}

sl_status gen_pretzel(uint64_t seed, int32_t scale, sl_generated **out)
{
    static const char *const layer[] = {"...###..." /* y upwards */
                                        "..##.##.."
                                        ".###.###."
                                        "##.###.##"
                                        "#...#...#"
                                        "##.###.##"
                                        ".###.###."};
    (void)seed;
    gen_cage cage = {0};
    gen_cage_voxels(&cage, (const int32_t[]){9, 7, 1}, layer);
    const sl_status status = finish_round(&cage, scale, out);
    return status != SL_OK ? status : gen_planted(gen_plant_mirrors(*out, "xz", true), out);
}

/* The twelve edges of a cube as beams: 12 - 8 + 1 = 5 holes. All 48 symmetries of the cube. */
sl_status gen_frame(uint64_t seed, int32_t scale, sl_generated **out)
{
    static const char face[] = "#####"
                               "#...#"
                               "#...#"
                               "#...#"
                               "#####";
    static const char posts[] = "#...#"
                                "....."
                                "....."
                                "....."
                                "#...#";
    static const char *const layer[] = {face, posts, posts, posts, face};
    (void)seed;
    gen_cage cage = {0};
    gen_cage_voxels(&cage, (const int32_t[]){5, 5, 5}, layer);
    const sl_status status = gen_cage_finish(&cage, 1 + scale, out);
    return status != SL_OK ? status : gen_planted(gen_plant_cube(*out, true), out);
}

/* Pipes widen towards their ends. */
static void shape_collars(gen_cage *cage)
{
    static const double wide = 1.4, middle = 1.0; /* of the straight run of pipe, above the grid's middle */
    for (int64_t v = 0; v < cage->nv && !cage->failed; v++) {
        double *p = cage->xyz + 3 * v;
        if (fabs(p[0]) > 2.0) {
            p[1] = middle + wide * (p[1] - middle);
            p[2] *= wide;
        } else if (p[1] < -1.0) {
            p[0] *= wide;
            p[2] *= wide;
        }
    }
}

sl_status gen_tee(uint64_t seed, int32_t scale, sl_generated **out)
{
    static const char *const layer[] = {"...o..." /* y upwards */
                                        "...#..."
                                        "...#..."
                                        "o#####o"};
    (void)seed;
    gen_cage cage = {0};
    gen_cage_voxels(&cage, (const int32_t[]){7, 4, 1}, layer);
    for (int64_t v = 0; v < cage.nv && !cage.failed; v++) {
        cage.xyz[3 * v + 1] -= 0.5; /* the run between y = 1/2 and 3/2 */
    }
    shape_collars(&cage);
    const sl_status status = gen_cage_finish(&cage, 2 + scale, out);
    return status != SL_OK ? status : gen_planted(gen_plant_mirrors(*out, "xz", true), out);
}
