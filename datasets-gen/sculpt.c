#include "sculpt.h"

#include "base/memory.h"
#include "geom/vec3.h"
#include "plant.h"

#include <math.h>
#include <string.h>

int32_t gen_pick(gen_cage *cage, const double (*at)[3], int32_t count, int32_t *region)
{
    int32_t found = 0;
    if (count > GEN_MAX_REGION || cage->nq == 0) {
        cage->failed = true;
    }
    for (int32_t i = 0; i < count && !cage->failed; i++) {
        const int32_t q = gen_cage_nearest(cage, at[i][0], at[i][1], at[i][2]);
        int32_t k = 0;
        while (k < found && region[k] != q) {
            k++;
        }
        region[k] = q;
        found += k == found;
    }
    return found;
}

void gen_grow(gen_cage *cage, const double (*at)[3], int32_t count, const double side[3], const gen_station *station,
              int32_t stations)
{
    int32_t region[GEN_MAX_REGION];
    const int32_t found = gen_pick(cage, at, count, region);
    if (found > 0 && !cage->failed) {
        gen_cage_limb(cage, region, found, side, station, stations);
    }
}

/* Is corner i of the region the first that names its vertex? */
static bool first_mention(const gen_cage *c, const int32_t *region, int32_t i)
{
    const int32_t v = c->quad[4 * (int64_t)region[i / 4] + i % 4];
    for (int32_t k = 0; k < i; k++) {
        if (c->quad[4 * (int64_t)region[k / 4] + k % 4] == v) {
            return false;
        }
    }
    return true;
}

static void move_region(gen_cage *c, const int32_t *region, int32_t count, const double move[3], const double scale[3])
{
    double centre[3] = {0.0, 0.0, 0.0};
    int32_t n = 0;
    bool at_mirror = false;
    for (int32_t i = 0; i < 4 * count; i++) {
        const double *p = c->xyz + 3 * (int64_t)c->quad[4 * (int64_t)region[i / 4] + i % 4];
        if (first_mention(c, region, i)) {
            for (int k = 0; k < 3; k++) {
                centre[k] += p[k];
            }
            at_mirror |= c->mirrored && p[0] == 0.0;
            n++;
        }
    }
    for (int k = 0; k < 3; k++) {
        centre[k] = k == 0 && at_mirror ? 0.0 : centre[k] / n;
    }
    for (int32_t i = 0; i < 4 * count; i++) {
        double *p = c->xyz + 3 * (int64_t)c->quad[4 * (int64_t)region[i / 4] + i % 4];
        const bool stays = c->mirrored && p[0] == 0.0;
        for (int k = 0; k < 3 && first_mention(c, region, i); k++) {
            p[k] = k == 0 && stays ? 0.0 : centre[k] + scale[k] * (p[k] - centre[k]) + move[k];
        }
    }
}

void gen_push(gen_cage *cage, const double (*at)[3], int32_t count, const double move[3], const double scale[3])
{
    int32_t region[GEN_MAX_REGION];
    const int32_t found = gen_pick(cage, at, count, region);
    if (found > 0 && !cage->failed) {
        gen_cage_extrude(cage, region, found);
    }
    if (found > 0 && !cage->failed) {
        move_region(cage, region, found, move, scale);
    }
}

void gen_bump(gen_cage *cage, const double at[3], const double out[3], double radius)
{
    static const double reach[3] = {0.15, 0.75, 1.15}, girth[3] = {1.25, 1.45, 0.80};
    static const double side_y[3] = {0.0, 1.0, 0.0}, side_x[3] = {1.0, 0.0, 0.0};
    const double norm = sl_vec3_norm(out);
    const int32_t q = cage->failed ? -1 : gen_cage_nearest(cage, at[0], at[1], at[2]);
    gen_station station[3];
    if (q < 0) {
        return;
    }
    for (int i = 0; i < 3; i++) {
        station[i] = (gen_station){{0.0, 0.0, 0.0}, girth[i] * radius, girth[i] * radius};
        for (int k = 0; k < 3; k++) {
            for (int corner = 0; corner < 4; corner++) {
                station[i].centre[k] += 0.25 * cage->xyz[3 * (int64_t)cage->quad[4 * (int64_t)q + corner] + k];
            }
            station[i].centre[k] += reach[i] * radius * out[k] / norm;
        }
    }
    gen_cage_limb(cage, &q, 1, fabs(out[1]) < 0.8 * norm ? side_y : side_x, station, 3);
}

/* Drops vertices without a quad; the others keep their order. */
static void drop_unused(gen_cage *c)
{
    int32_t *place = sl_alloc(c->nv, sizeof *place);
    int32_t kept = 0;
    if (place == NULL) {
        c->failed = true;
        return;
    }
    for (int64_t v = 0; v < c->nv; v++) {
        place[v] = -1;
    }
    for (int64_t i = 0; i < 4 * c->nq; i++) {
        place[c->quad[i]] = 0;
    }
    for (int64_t v = 0; v < c->nv; v++) {
        if (place[v] == 0) {
            memmove(c->xyz + 3 * (int64_t)kept, c->xyz + 3 * v, 3 * sizeof *c->xyz);
            place[v] = kept++;
        }
    }
    for (int64_t i = 0; i < 4 * c->nq; i++) {
        c->quad[i] = place[c->quad[i]];
    }
    c->nv = kept;
    sl_free(place);
}

void gen_open(gen_cage *cage, const double (*at)[3], int32_t count)
{
    int32_t region[GEN_MAX_REGION];
    const int32_t found = gen_pick(cage, at, count, region);
    for (int32_t k = 0; k < found && !cage->failed; k++) {
        memset(cage->quad + 4 * (int64_t)region[k], 0xff, 4 * sizeof *cage->quad); /* marked by -1 */
    }
    int64_t kept = 0;
    for (int64_t q = 0; q < cage->nq && !cage->failed; q++) {
        if (cage->quad[4 * q] >= 0) {
            memmove(cage->quad + 4 * kept++, cage->quad + 4 * q, 4 * sizeof *cage->quad);
        }
    }
    if (!cage->failed) {
        cage->nq = kept;
        drop_unused(cage);
    }
}

sl_status gen_finish_mirrored(gen_cage *cage, int32_t levels, sl_generated **out)
{
    const sl_status status = gen_cage_finish(cage, levels, out);
    return status != SL_OK ? status : gen_planted(gen_plant_mirror(*out, "mirror x", 1.0, 0.0, 0.0, true), out);
}
