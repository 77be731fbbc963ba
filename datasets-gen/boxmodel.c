#include "boxmodel.h"

#include "base/memory.h"
#include "builder.h"
#include "geom/vec3.h"

#include <string.h>

int32_t gen_cage_vertex(gen_cage *cage, const double p[3])
{
    if (cage->failed || cage->nv >= INT32_MAX / 3 ||
        sl_reserve((void **)&cage->xyz, &cage->xyz_capacity, 3 * (cage->nv + 1), sizeof *cage->xyz) != SL_OK) {
        cage->failed = true;
        return 0;
    }
    memcpy(cage->xyz + 3 * cage->nv, p, 3 * sizeof *p);
    return (int32_t)cage->nv++;
}

void gen_cage_quad(gen_cage *cage, const int32_t corner[4])
{
    if (cage->failed || cage->nq >= INT32_MAX / 4 ||
        sl_reserve((void **)&cage->quad, &cage->quad_capacity, 4 * (cage->nq + 1), sizeof *cage->quad) != SL_OK) {
        cage->failed = true;
        return;
    }
    memcpy(cage->quad + 4 * cage->nq++, corner, 4 * sizeof *corner);
}

static void add_box_side(gen_cage *c, int32_t *made, const int32_t n[3], const double *const at[3], int axis,
                         bool far_end)
{
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (int32_t i = 0; i < n[u]; i++) {
        for (int32_t j = 0; j < n[v]; j++) {
            int32_t corner[4];
            for (int k = 0; k < 4; k++) {
                int32_t p[3];
                p[axis] = far_end ? n[axis] : 0;
                p[u] = i + (k == 1 || k == 2);
                p[v] = j + (k == 2 || k == 3);
                const int64_t slot = p[0] + (int64_t)(n[0] + 1) * (p[1] + (int64_t)(n[1] + 1) * p[2]);
                if (made[slot] < 0) {
                    made[slot] = gen_cage_vertex(c, (double[]){at[0][p[0]], at[1][p[1]], at[2][p[2]]});
                }
                corner[far_end ? k : 3 - k] = made[slot];
            }
            gen_cage_quad(c, corner);
        }
    }
}

void gen_cage_box(gen_cage *cage, const int32_t n[3], const double *const at[3])
{
    const int64_t slots = (int64_t)(n[0] + 1) * (n[1] + 1) * (n[2] + 1);
    int32_t *made = cage->failed ? NULL : sl_alloc(slots, sizeof *made);
    if (made == NULL) {
        cage->failed = true;
        return;
    }
    for (int64_t k = 0; k < slots; k++) {
        made[k] = -1;
    }
    for (int axis = 0; axis < 3; axis++) {
        if (axis != 0 || !cage->mirrored) {
            add_box_side(cage, made, n, at, axis, false);
        }
        add_box_side(cage, made, n, at, axis, true);
    }
    sl_free(made);
}

int32_t gen_cage_nearest(const gen_cage *cage, double x, double y, double z)
{
    const double p[3] = {x, y, z};
    int32_t best = -1;
    double best_distance = 0.0;
    for (int32_t q = 0; q < cage->nq; q++) {
        double centre[3] = {0.0, 0.0, 0.0};
        for (int k = 0; k < 4; k++) {
            sl_vec3_add(centre, cage->xyz + 3 * (int64_t)cage->quad[4 * (int64_t)q + k], centre);
        }
        for (int k = 0; k < 3; k++) {
            centre[k] *= 0.25;
        }
        const double d = sl_vec3_distance(centre, p);
        if (best < 0 || d < best_distance) {
            best = q;
            best_distance = d;
        }
    }
    return best;
}

/* Does the region hold the directed edge a -> b? */
static bool region_has_edge(const gen_cage *c, const int32_t *region, int32_t count, int32_t a, int32_t b)
{
    for (int32_t r = 0; r < count; r++) {
        const int32_t *quad = c->quad + 4 * (int64_t)region[r];
        for (int k = 0; k < 4; k++) {
            if (quad[k] == a && quad[(k + 1) % 4] == b) {
                return true;
            }
        }
    }
    return false;
}

static bool on_mirror(const gen_cage *c, int32_t v)
{
    return c->mirrored && c->xyz[3 * (int64_t)v] == 0.0;
}

/* Is side i of the region (quad i / 4, its edge i % 4) on its outline, where a wall must stand? */
static bool on_outline(const gen_cage *c, const int32_t *region, int32_t count, int32_t i)
{
    const int32_t *quad = c->quad + 4 * (int64_t)region[i / 4];
    const int32_t a = quad[i % 4], b = quad[(i + 1) % 4];
    return !(on_mirror(c, a) && on_mirror(c, b)) && !region_has_edge(c, region, count, b, a);
}

static int32_t copy_vertex(gen_cage *c, int32_t v)
{
    double p[3];
    memcpy(p, c->xyz + 3 * (int64_t)v, sizeof p);
    return gen_cage_vertex(c, p);
}

void gen_cage_extrude(gen_cage *cage, const int32_t *region, int32_t count)
{
    const int64_t old_vertices = cage->nv;
    int32_t *twin = cage->failed ? NULL : sl_alloc(old_vertices, sizeof *twin);
    if (twin == NULL) {
        cage->failed = true;
        return;
    }
    for (int32_t v = 0; v < old_vertices; v++) {
        twin[v] = v; /* vertices inside the region just move along */
    }
    for (int32_t i = 0; i < 4 * count && !cage->failed; i++) {
        if (on_outline(cage, region, count, i)) {
            const int32_t *quad = cage->quad + 4 * (int64_t)region[i / 4];
            const int32_t a = quad[i % 4], b = quad[(i + 1) % 4];
            twin[a] = twin[a] == a ? copy_vertex(cage, a) : twin[a];
            twin[b] = twin[b] == b ? copy_vertex(cage, b) : twin[b];
            gen_cage_quad(cage, (int32_t[]){a, b, twin[b], twin[a]});
        }
    }
    for (int32_t i = 0; i < 4 * count; i++) {
        int32_t *corner = cage->quad + 4 * (int64_t)region[i / 4] + i % 4;
        *corner = twin[*corner];
    }
    sl_free(twin);
}

void gen_cage_clear(gen_cage *cage)
{
    sl_free(cage->xyz);
    sl_free(cage->quad);
    *cage = (gen_cage){0};
}

/* The mirrored half: vertices off the plane once more, quads the other way round, each from the image of its first
 * corner on, so that bent quads of both halves are triangulated along images of one diagonal. */
static void join_mirror_image(gen_cage *c)
{
    const int64_t nv = c->nv, nq = c->nq;
    int32_t *image = c->failed ? NULL : sl_alloc(nv, sizeof *image);
    if (image == NULL) {
        c->failed = true;
        return;
    }
    for (int32_t v = 0; v < nv; v++) {
        const double *p = c->xyz + 3 * (int64_t)v;
        image[v] = p[0] == 0.0 ? v : gen_cage_vertex(c, (double[]){-p[0], p[1], p[2]});
    }
    for (int64_t q = 0; q < nq && !c->failed; q++) {
        const int32_t *quad = c->quad + 4 * q;
        gen_cage_quad(c, (int32_t[]){image[quad[0]], image[quad[3]], image[quad[2]], image[quad[1]]});
    }
    sl_free(image);
}

sl_status gen_cage_finish(gen_cage *cage, int32_t levels, sl_generated **out)
{
    gen_builder b = {0};
    *out = NULL;
    for (int32_t k = 0; k < levels; k++) {
        gen_cage_smooth(cage);
    }
    if (cage->mirrored) {
        join_mirror_image(cage);
    }
    b.failed = cage->failed;
    for (int64_t v = 0; v < cage->nv; v++) {
        gen_vertex(&b, cage->xyz[3 * v], cage->xyz[3 * v + 1], cage->xyz[3 * v + 2]);
    }
    for (int64_t q = 0; q < cage->nq; q++) {
        gen_facet(&b, 4, cage->quad + 4 * q);
    }
    gen_cage_clear(cage);
    return gen_finish(&b, out);
}
