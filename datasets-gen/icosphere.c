#include "icosphere.h"

#include "base/memory.h"
#include "geom/vec3.h"
#include "grid.h"
#include "models.h"
#include "plant.h"

#include <stdio.h>
#include <string.h>

static const double pi = 3.14159265358979323846, golden = 1.61803398874989484820;

enum { CORNERS = 12, FACES = 20 };

/* Corners in the order (0, +-1, +-g), (+-1, +-g, 0), (+-g, 0, +-1). */
static void corner_at(int k, double p[3])
{
    const double one = k % 2 == 0 ? 1.0 : -1.0, g = k / 2 % 2 == 0 ? golden : -golden;
    const int first = k / 4 == 0 ? 1 : k / 4 == 1 ? 0 : 2;
    p[0] = p[1] = p[2] = 0.0;
    p[first] = one;
    p[(first + 1) % 3] = g;
}

/* The faces are the triples of corners at distance 2 from one another, turned outward. */
static int list_faces(int face[FACES][3])
{
    double p[CORNERS][3], n[3], a[3], b[3];
    int count = 0;
    for (int i = 0; i < CORNERS; i++) {
        corner_at(i, p[i]);
    }
    for (int i = 0; i < CORNERS; i++) {
        for (int j = i + 1; j < CORNERS; j++) {
            for (int k = j + 1; k < CORNERS; k++) {
                if (sl_vec3_distance(p[i], p[j]) < 2.1 && sl_vec3_distance(p[j], p[k]) < 2.1 &&
                    sl_vec3_distance(p[k], p[i]) < 2.1 && count < FACES) {
                    sl_vec3_sub(p[j], p[i], a);
                    sl_vec3_sub(p[k], p[i], b);
                    sl_vec3_cross(a, b, n);
                    const bool outward = sl_vec3_dot(n, p[i]) > 0.0;
                    memcpy(face[count++], (int[]){i, outward ? j : k, outward ? k : j}, sizeof face[0]);
                }
            }
        }
    }
    return count;
}

/* One face: rows of vertices from corner c[0] towards the side c[1] c[2]. */
static void add_face(gen_builder *b, int32_t n, const int c[3])
{
    double p[3][3];
    const int32_t first = (int32_t)b->nv;
    for (int k = 0; k < 3; k++) {
        corner_at(c[k], p[k]);
    }
    for (int32_t i = 0; i <= n && !b->failed; i++) {
        for (int32_t j = 0; j <= i; j++) {
            double q[3];
            for (int k = 0; k < 3; k++) {
                q[k] = (n - i) * p[0][k] + (i - j) * p[1][k] + j * p[2][k];
            }
            const double norm = sl_vec3_norm(q);
            gen_vertex(b, q[0] / norm, q[1] / norm, q[2] / norm);
        }
    }
    for (int32_t i = 0; i < n && !b->failed; i++) {
        const int32_t here = first + i * (i + 1) / 2, below = here + i + 1;
        for (int32_t j = 0; j <= i; j++) {
            gen_triangle(b, here + j, below + j, below + j + 1);
            if (j < i) {
                gen_triangle(b, here + j, below + j + 1, here + j + 1);
            }
        }
    }
}

void gen_icosphere_into(gen_builder *b, int32_t n)
{
    int face[FACES][3];
    const int faces = list_faces(face);
    for (int f = 0; f < faces; f++) {
        add_face(b, n, face[f]);
    }
    gen_weld(b, gen_weld_tolerance);
}

sl_status gen_plant_icosahedral(sl_generated *mesh, bool exact)
{
    double p[3], q[3], middle[3];
    int count = 0;
    sl_status status = SL_OK;
    for (int i = 0; i < CORNERS; i++) {
        for (int j = i + 1; j < CORNERS && status == SL_OK; j++) {
            corner_at(i, p);
            corner_at(j, q);
            sl_vec3_add(p, q, middle); /* the middle of an edge; its opposite has the same plane */
            const double first = middle[0] != 0.0 ? middle[0] : middle[1] != 0.0 ? middle[1] : middle[2];
            if (sl_vec3_distance(p, q) < 2.1 && first > 0.0) {
                char name[32];
                snprintf(name, sizeof name, "mirror %d of 15", ++count);
                status = gen_plant_mirror(mesh, name, middle[0], middle[1], middle[2], exact);
            }
        }
    }
    corner_at(0, p);
    if (status == SL_OK) {
        status = gen_plant_rotation(mesh, "rotation corner 1/5", p, 2.0 * pi / 5.0, exact);
    }
    return status != SL_OK
               ? status
               : gen_plant_rotation(mesh, "rotation face 1/3", (double[]){1.0, 1.0, 1.0}, 2.0 * pi / 3.0, exact);
}

sl_status gen_icosphere(uint64_t seed, int32_t scale, sl_generated **out)
{
    (void)seed; /* nothing random */
    gen_builder b = {0};
    gen_icosphere_into(&b, gen_refined(12, scale));
    const sl_status status = gen_finish(&b, out);
    return status != SL_OK ? status : gen_planted(gen_plant_icosahedral(*out, true), out);
}
