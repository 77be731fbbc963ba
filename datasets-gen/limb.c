/* Limbs: a region of the cage extruded along a path of cross-sections. */
#include "base/memory.h"
#include "boxmodel.h"
#include "geom/vec3.h"

#include <math.h>
#include <string.h>

/* An orthonormal frame: along the path, along the side vector, across both. */
typedef struct limb_frame {
    double along[3], side[3], across[3];
} limb_frame;

/* Place of a region's vertex in the unit disk of a cross-section. */
typedef struct limb_point {
    int32_t vertex; /* as of the last extrusion */
    double s, t;
} limb_point;

static void normalise(double a[3])
{
    const double norm = sl_vec3_norm(a);
    for (int k = 0; k < 3; k++) {
        a[k] = norm > 0.0 ? a[k] / norm : 0.0;
    }
}

static void make_frame(const double along[3], const double side[3], limb_frame *frame)
{
    memcpy(frame->along, along, sizeof frame->along);
    normalise(frame->along);
    const double slant = sl_vec3_dot(side, frame->along);
    for (int k = 0; k < 3; k++) {
        frame->side[k] = side[k] - slant * frame->along[k];
    }
    normalise(frame->side);
    sl_vec3_cross(frame->along, frame->side, frame->across);
}

/* The distinct vertices of the region, in the order met (which extrusion keeps); returns how many. */
static int32_t list_vertices(const gen_cage *c, const int32_t *region, int32_t count, limb_point *point)
{
    int32_t n = 0;
    for (int32_t i = 0; i < 4 * count; i++) {
        const int32_t v = c->quad[4 * (int64_t)region[i / 4] + i % 4];
        int32_t k = 0;
        while (k < n && point[k].vertex != v) {
            k++;
        }
        if (k == n) {
            point[n++].vertex = v;
        }
    }
    return n;
}

/* Disk coordinates from the outline: the bounding square in the frame, mapped to the disk so that its corners do not
 * stick out. A region at the mirror plane is half of its outline, centred on the plane. */
static void place_points(const gen_cage *c, const limb_frame *frame, limb_point *point, int32_t n)
{
    double centre[3] = {0.0, 0.0, 0.0}, width = 0.0, depth = 0.0;
    bool at_mirror = false;
    for (int32_t i = 0; i < n; i++) {
        const double *p = c->xyz + 3 * (int64_t)point[i].vertex;
        at_mirror |= c->mirrored && p[0] == 0.0;
        sl_vec3_add(centre, p, centre);
    }
    for (int k = 0; k < 3; k++) {
        centre[k] = k == 0 && at_mirror ? 0.0 : centre[k] / n;
    }
    for (int32_t i = 0; i < n; i++) {
        double d[3];
        sl_vec3_sub(c->xyz + 3 * (int64_t)point[i].vertex, centre, d);
        point[i].s = sl_vec3_dot(d, frame->side);
        point[i].t = sl_vec3_dot(d, frame->across);
        width = fmax(width, fabs(point[i].s));
        depth = fmax(depth, fabs(point[i].t));
    }
    for (int32_t i = 0; i < n; i++) {
        const double s = width > 0.0 ? point[i].s / width : 0.0, t = depth > 0.0 ? point[i].t / depth : 0.0;
        point[i].s = s * sqrt(1.0 - 0.5 * t * t);
        point[i].t = t * sqrt(1.0 - 0.5 * s * s);
    }
}

static void move_cap(gen_cage *c, const limb_point *point, int32_t n, const limb_frame *frame,
                     const gen_station *station)
{
    for (int32_t i = 0; i < n; i++) {
        double *p = c->xyz + 3 * (int64_t)point[i].vertex;
        const bool stays = c->mirrored && p[0] == 0.0;
        for (int k = 0; k < 3; k++) {
            p[k] = station->centre[k] + point[i].s * station->width * frame->side[k] +
                   point[i].t * station->depth * frame->across[k];
        }
        if (stays) {
            p[0] = 0.0;
        }
    }
}

/* The path's direction at station i: between its neighbours, at the ends towards the one neighbour. */
static void path_direction(const double start[3], const gen_station *station, int32_t stations, int32_t i,
                           double out[3])
{
    const double *before = i > 0 ? station[i - 1].centre : start;
    const double *after = i + 1 < stations ? station[i + 1].centre : station[i].centre;
    double in_step[3], out_step[3];
    sl_vec3_sub(station[i].centre, before, in_step);
    sl_vec3_sub(after, station[i].centre, out_step);
    normalise(in_step);
    normalise(out_step);
    sl_vec3_add(in_step, out_step, out);
}

void gen_cage_limb(gen_cage *cage, const int32_t *region, int32_t count, const double side[3],
                   const gen_station *station, int32_t stations)
{
    limb_point *point = cage->failed ? NULL : sl_alloc(4 * (int64_t)count, sizeof *point);
    double start[3] = {0.0, 0.0, 0.0}, direction[3];
    limb_frame frame;
    if (point == NULL) {
        cage->failed = true;
        return;
    }
    const int32_t n = list_vertices(cage, region, count, point);
    for (int32_t i = 0; i < n; i++) {
        for (int k = 0; k < 3; k++) {
            start[k] += cage->xyz[3 * (int64_t)point[i].vertex + k] / n;
        }
    }
    if (cage->mirrored && station[0].centre[0] == 0.0) {
        start[0] = 0.0;
    }
    sl_vec3_sub(station[0].centre, start, direction);
    make_frame(direction, side, &frame);
    place_points(cage, &frame, point, n);
    for (int32_t i = 0; i < stations && !cage->failed; i++) {
        gen_cage_extrude(cage, region, count);
        list_vertices(cage, region, count, point);
        path_direction(start, station, stations, i, direction);
        make_frame(direction, side, &frame);
        if (!cage->failed) {
            move_cap(cage, point, n, &frame, &station[i]);
        }
    }
    sl_free(point);
}
