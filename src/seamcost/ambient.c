#include "seamcost/ambient.h"

#include "base/memory.h"
#include "geom/bvh.h"
#include "geom/vec3.h"
#include "mesh/triangulate.h"

#include <math.h>

enum { CHUNK = 256, MOST_RAYS = 256, FEWEST_RAYS = 1, FACETS_A_STEP = 5 };

static const double turn = 6.283185307179586;
static const double golden = 0.6180339887498949;
static const double lift = 0x1p-22; /* of the ray's start, in units of the normalised mesh */
static const double plenty = 0.75;  /* seen from one side: then the other is not looked from */
static const double alike = 0.5;    /* cosine between facets that are averaged */

typedef struct ambient {
    const sl_mesh *mesh;
    const sl_triangulation *triangulation;
    const sl_bvh *bvh;
    int32_t *tri;   /* 3 nt: vertices */
    double *normal; /* 3 nf, outwards, or 0 */
    uint8_t *two;   /* nf: seen from both sides */
    double direction[MOST_RAYS][3];
    int32_t rays;   /* directions in all */
    int32_t stride; /* every such direction is taken by a facet */
    double *visibility;
    int64_t first; /* facet of the piece in work */
} ambient;

sl_ambient_def sl_ambient_default(void)
{
    return (sl_ambient_def){.rays = 32, .rays_total = 1 << 20};
}

/* Evenly over the hemisphere, as dense as the cosine to its pole: a sunflower on the disk below, lifted. */
static void set_directions(ambient *a)
{
    for (int32_t i = 0; i < a->rays; i++) {
        const double share = (i + 0.5) / a->rays, r = sqrt(share), angle = turn * fmod(i * golden, 1.0);
        a->direction[i][0] = r * cos(angle);
        a->direction[i][1] = r * sin(angle);
        a->direction[i][2] = sqrt(1.0 - share);
    }
}

/* One component, from facet `seed` on: is it open, and which sign has its volume? Facets are queued and labelled. */
static int32_t flood(const sl_mesh *m, int32_t seed, int32_t *queue, uint8_t *seen, bool *open)
{
    int32_t count = 0;
    queue[count++] = seed;
    seen[seed] = 1;
    *open = false;
    for (int32_t at = 0; at < count; at++) {
        for (int32_t h = m->face_first[queue[at]]; h < m->face_first[queue[at] + 1]; h++) {
            const int32_t t = sl_opposite(m, h);
            *open = *open || t < 0;
            if (t >= 0 && !seen[m->face[t]]) {
                seen[m->face[t]] = 1;
                queue[count++] = m->face[t];
            }
        }
    }
    return count;
}

/* Unit normals that point outwards where there is an outside; which facets have two sides. */
static void set_component(ambient *a, const int32_t *face, int32_t count, bool open)
{
    double volume = 0.0;
    for (int32_t i = 0; i < count; i++) {
        double n[3], c[3];
        sl_mesh_face_vector_area(a->mesh, face[i], n);
        sl_mesh_face_centroid(a->mesh, face[i], c);
        volume += sl_vec3_dot(n, c);
    }
    for (int32_t i = 0; i < count; i++) {
        double *n = a->normal + 3 * (int64_t)face[i];
        sl_mesh_face_vector_area(a->mesh, face[i], n);
        const double length = sl_vec3_norm(n), sign = !open && volume < 0.0 ? -1.0 : 1.0;
        for (int k = 0; k < 3; k++) {
            n[k] = length > 0.0 ? sign * n[k] / length : 0.0;
        }
        a->two[face[i]] = open;
    }
}

static sl_status orient(ambient *a)
{
    const int32_t nf = a->mesh->nf;
    int32_t *queue = sl_alloc(nf, sizeof *queue);
    uint8_t *seen = sl_calloc(nf, sizeof *seen);
    const sl_status status = queue != NULL && seen != NULL ? SL_OK : SL_OUT_OF_MEMORY;
    for (int32_t f = 0; f < nf && status == SL_OK; f++) {
        if (!seen[f]) {
            bool open;
            const int32_t count = flood(a->mesh, f, queue, seen, &open);
            set_component(a, queue, count, open);
        }
    }
    sl_free(queue);
    sl_free(seen);
    return status;
}

/* The facet's largest triangle, its centre, and the direction of its longest edge. */
static int32_t place_of(const ambient *a, int32_t f, double centre[3], double along[3])
{
    const double *xyz = a->mesh->xyz;
    double most = -1.0, longest = -1.0;
    int32_t chosen = -1;
    for (int32_t t = a->triangulation->first[f]; t < a->triangulation->first[f + 1]; t++) {
        const double *p[3];
        double e[3], g[3], n[3];
        for (int k = 0; k < 3; k++) {
            p[k] = xyz + 3 * (int64_t)a->tri[3 * (int64_t)t + k];
        }
        sl_vec3_sub(p[1], p[0], e);
        sl_vec3_sub(p[2], p[0], g);
        sl_vec3_cross(e, g, n);
        if (sl_vec3_norm(n) > most) {
            most = sl_vec3_norm(n);
            chosen = t;
            for (int k = 0; k < 3; k++) {
                centre[k] = (p[0][k] + p[1][k] + p[2][k]) / 3.0;
            }
        }
    }
    for (int32_t h = a->mesh->face_first[f]; h < a->mesh->face_first[f + 1]; h++) {
        double e[3];
        sl_vec3_sub(xyz + 3 * (int64_t)sl_target(a->mesh, h), xyz + 3 * (int64_t)a->mesh->origin[h], e);
        const double length = sl_vec3_norm(e);
        if (length > longest) {
            longest = length;
            for (int k = 0; k < 3; k++) {
                along[k] = e[k];
            }
        }
    }
    return chosen;
}

/* A frame around the normal: the first axis along a direction as far as it is across. */
static void make_frame(const double n[3], const double along[3], double x[3], double y[3])
{
    const double on = sl_vec3_dot(n, along);
    for (int k = 0; k < 3; k++) {
        x[k] = along[k] - on * n[k];
    }
    const double length = sl_vec3_norm(x);
    for (int k = 0; k < 3; k++) {
        x[k] = length > 0.0 ? x[k] / length : 0.0;
    }
    sl_vec3_cross(n, x, y);
}

/* The share of the rays that leave the mesh, over one side. */
static double look_around(const ambient *a, int32_t f, int32_t skip, const double centre[3], const double along[3],
                          double side)
{
    double n[3], x[3], y[3];
    int32_t seen = 0, count = 0;
    for (int k = 0; k < 3; k++) {
        n[k] = side * a->normal[3 * (int64_t)f + k];
    }
    make_frame(n, along, x, y);
    for (int32_t i = f % a->stride; i < a->rays; i += a->stride) {
        const double *d = a->direction[i];
        sl_ray ray = {.near = lift, .far = HUGE_VAL, .skip = skip};
        for (int k = 0; k < 3; k++) {
            ray.origin[k] = centre[k];
            ray.direction[k] = d[0] * x[k] + d[1] * y[k] + d[2] * n[k];
        }
        seen += !sl_bvh_any(a->bvh, &ray);
        count++;
    }
    return (double)seen / count;
}

static void look(void *user, int64_t begin, int64_t end, int32_t chunk)
{
    (void)chunk;
    const ambient *a = user;
    for (int64_t i = begin; i < end; i++) {
        const int32_t f = (int32_t)(a->first + i);
        double centre[3], along[3];
        const int32_t skip = place_of(a, f, centre, along);
        if (sl_vec3_norm(a->normal + 3 * (int64_t)f) == 0.0) {
            a->visibility[f] = 1.0;
            continue;
        }
        a->visibility[f] = look_around(a, f, skip, centre, along, 1.0);
        if (a->two[f] && a->visibility[f] < plenty) {
            a->visibility[f] = fmax(a->visibility[f], look_around(a, f, skip, centre, along, -1.0));
        }
    }
}

/* All facets, in pieces between which the caller can cancel. */
static sl_status look_all(ambient *a, const sl_context *context)
{
    sl_status status = SL_OK;
    const int64_t nf = a->mesh->nf, piece = 64 * CHUNK;
    for (a->first = 0; a->first < nf; a->first += piece) {
        SL_TRY(sl_report_progress(context, "visibility", (double)a->first / (double)nf));
        sl_parallel_for(context, nf - a->first < piece ? nf - a->first : piece, CHUNK, look, a);
    }
cleanup:
    return status;
}

/* The mean of each facet and its neighbours that face alike, so many times; each time takes in some FACETS_A_STEP
 * facets more, as a random walk spreads. */
static sl_status average(const ambient *a, int32_t steps)
{
    const sl_mesh *m = a->mesh;
    double *old = sl_alloc(m->nf, sizeof *old);
    if (old == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int32_t step = 0; step < steps; step++) {
        for (int32_t f = 0; f < m->nf; f++) {
            old[f] = a->visibility[f];
        }
        for (int32_t f = 0; f < m->nf; f++) {
            double sum = old[f];
            int32_t count = 1;
            for (int32_t h = m->face_first[f]; h < m->face_first[f + 1]; h++) {
                const int32_t t = sl_opposite(m, h), g = t >= 0 ? m->face[t] : f;
                if (g != f && sl_vec3_dot(a->normal + 3 * (int64_t)f, a->normal + 3 * (int64_t)g) > alike) {
                    sum += old[g];
                    count++;
                }
            }
            a->visibility[f] = sum / count;
        }
    }
    sl_free(old);
    return SL_OK;
}

/* Every how many-th direction a facet takes. */
static int32_t choose_stride(const sl_ambient_def *def, int32_t nf)
{
    const int64_t wanted = (int64_t)def->rays * nf, most = def->rays / FEWEST_RAYS;
    const int64_t stride = (wanted + def->rays_total - 1) / def->rays_total;
    return (int32_t)(stride < 1 ? 1 : stride > most ? most : stride);
}

static sl_status prepare(ambient *a)
{
    const int64_t corners = 3 * (int64_t)a->triangulation->nt;
    a->tri = sl_alloc(corners, sizeof *a->tri);
    a->normal = sl_alloc(3 * (int64_t)a->mesh->nf, sizeof *a->normal);
    a->two = sl_alloc(a->mesh->nf, sizeof *a->two);
    if (a->tri == NULL || a->normal == NULL || a->two == NULL) {
        return SL_OUT_OF_MEMORY;
    }
    for (int64_t c = 0; c < corners; c++) {
        a->tri[c] = a->mesh->origin[a->triangulation->corner[c]];
    }
    set_directions(a);
    return orient(a);
}

sl_status sl_ambient_compute(const sl_mesh *mesh, const sl_ambient_def *def, const sl_context *context,
                             double *visibility)
{
    sl_status status = SL_OK;
    sl_triangulation *triangulation = NULL;
    sl_bvh *bvh = NULL;
    ambient a = {.mesh = mesh, .rays = def->rays, .visibility = visibility};
    SL_TRY(def->rays >= 4 && def->rays <= MOST_RAYS && def->rays_total >= 1 ? SL_OK : SL_BAD_INPUT);
    a.stride = choose_stride(def, mesh->nf);
    SL_TRY(sl_report_progress(context, "visibility", 0.0));
    SL_TRY(sl_triangulation_create(mesh, &triangulation));
    a.triangulation = triangulation;
    SL_TRY(prepare(&a));
    SL_TRY(sl_bvh_create(mesh->xyz, triangulation->nt, a.tri, &bvh));
    a.bvh = bvh;
    SL_TRY(look_all(&a, context));
    if (a.stride > 1) {
        SL_TRY(average(&a, 1 + a.stride / FACETS_A_STEP));
    }
cleanup:
    sl_free(a.tri);
    sl_free(a.normal);
    sl_free(a.two);
    sl_bvh_free(bvh);
    sl_triangulation_free(triangulation);
    return status;
}
