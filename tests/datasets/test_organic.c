/* The organic models: sound surfaces of known topology, their symmetries where they were planted and nowhere else. */
#include "crossing.h"
#include "generators.h"
#include "mesh/topology.h"
#include "mesh/triangulate.h"
#include "support/test_support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What a model must be. */
typedef struct known {
    const char *name;
    bool mirrored;       /* x -> -x, to the bit */
    int32_t borders;     /* loops */
    int32_t planted;     /* symmetries */
    int32_t least, most; /* facets at scale 1 */
} known;

static const known models[] = {
    {"quadruped", true, 0, 1, 4000, 6600}, {"octopus", true, 0, 1, 4000, 6600},  {"starfish", true, 0, 6, 3000, 6600},
    {"crab", true, 0, 1, 4000, 6600},      {"fish", true, 0, 1, 3000, 6600},     {"bird", true, 0, 1, 4000, 6600},
    {"seahorse", true, 0, 1, 4000, 6600},  {"snake", false, 0, 0, 4000, 6600},   {"turtle", true, 0, 1, 3000, 6600},
    {"airplane", true, 0, 1, 4000, 6600},  {"pullover", true, 4, 1, 3000, 6600}, {"character", true, 0, 1, 300, 900},
};

static sl_generated *make(const char *name, uint64_t seed, int32_t scale)
{
    sl_generated *mesh = NULL;
    const sl_generator *generator = sl_generator_find(name);
    assert_non_null(generator);
    assert_int_equal(generator->make(seed, scale, &mesh), SL_OK);
    return mesh;
}

static void each_is_one_sound_sphere_but_for_the_openings_of_the_pullover(void **state)
{
    (void)state;
    for (size_t k = 0; k < SL_COUNTOF(models); k++) {
        const sl_generator *generator = sl_generator_find(models[k].name);
        assert_true(generator->genus == 0 && generator->components == 1 && generator->borders == models[k].borders);
        for (int32_t scale = 1; scale <= 2; scale++) {
            sl_generated *mesh = make(models[k].name, 1, scale);
            sl_polygons polygons;
            sl_mesh *built = NULL;
            sl_repair_report report;
            sl_generated_polygons(mesh, &polygons);
            assert_int_equal(sl_mesh_build(&polygons, &built, &report, NULL), SL_OK);
            assert_int_equal(report.components, 1);
            assert_int_equal(report.genus, 0);
            assert_int_equal(report.border_loops, models[k].borders);
            assert_int_equal(report.unused_vertices + report.isolated_faces + report.nonmanifold_edges, 0);
            assert_int_equal(report.bowtie_vertices + report.reversed_faces + report.one_sided_components, 0);
            sl_repair_report_clear(&report);
            sl_mesh_free(built);
            sl_generated_free(mesh);
        }
    }
}

/* Euler's number by counting undirected edges in the polygons, without the builder. */
static int compare_keys(const void *a, const void *b)
{
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return x < y ? -1 : x > y;
}

static int32_t euler_of(const sl_generated *mesh)
{
    const int32_t corners = mesh->face_first[mesh->nf];
    uint64_t *key = malloc((size_t)corners * sizeof *key);
    int32_t edges = 0;
    assert_non_null(key);
    for (int32_t f = 0; f < mesh->nf; f++) {
        const int32_t first = mesh->face_first[f], n = mesh->face_first[f + 1] - first;
        for (int32_t k = 0; k < n; k++) {
            const uint64_t a = (uint64_t)mesh->index[first + k], b = (uint64_t)mesh->index[first + (k + 1) % n];
            key[first + k] = a < b ? a << 32 | b : b << 32 | a;
        }
    }
    qsort(key, (size_t)corners, sizeof *key, compare_keys);
    for (int32_t i = 0; i < corners; i++) {
        edges += i == 0 || key[i] != key[i - 1];
    }
    free(key);
    return mesh->nv - edges + mesh->nf;
}

static void the_euler_number_is_two_less_the_openings(void **state)
{
    (void)state;
    for (size_t k = 0; k < SL_COUNTOF(models); k++) {
        sl_generated *mesh = make(models[k].name, 1, 1);
        assert_int_equal(euler_of(mesh), 2 - models[k].borders);
        sl_generated_free(mesh);
    }
}

static void sizes_are_as_said_and_each_scale_has_about_four_times_the_facets(void **state)
{
    (void)state;
    for (size_t k = 0; k < SL_COUNTOF(models); k++) {
        sl_generated *one = make(models[k].name, 1, 1), *two = make(models[k].name, 1, 2);
        assert_in_range(one->nf, models[k].least, models[k].most);
        assert_true(test_near((double)two->nf / one->nf, 4.0, 0.3));
        sl_generated_free(one);
        sl_generated_free(two);
    }
}

/* Nothing is random in them: the seed changes no byte. */
static void the_same_bytes_come_again_for_any_seed(void **state)
{
    (void)state;
    for (size_t k = 0; k < SL_COUNTOF(models); k++) {
        sl_generated *a = make(models[k].name, 5, 2), *b = make(models[k].name, 0x9e3779b97f4a7c15u, 2);
        assert_true(a->nv == b->nv && a->nf == b->nf && a->nplanted == b->nplanted);
        assert_memory_equal(a->xyz, b->xyz, 3 * (size_t)a->nv * sizeof *a->xyz);
        assert_memory_equal(a->face_first, b->face_first, ((size_t)a->nf + 1) * sizeof *a->face_first);
        assert_memory_equal(a->index, b->index, (size_t)a->face_first[a->nf] * sizeof *a->index);
        sl_generated_free(a);
        sl_generated_free(b);
    }
}

static int compare_points(const void *a, const void *b)
{
    const double *x = a, *y = b;
    for (int k = 0; k < 3; k++) {
        if (x[k] != y[k]) {
            return x[k] < y[k] ? -1 : 1;
        }
    }
    return 0;
}

/* By positions alone; the planted maps are not asked. */
static void vertices_have_their_mirror_image_to_the_bit_or_none_has(void **state)
{
    (void)state;
    for (size_t k = 0; k < SL_COUNTOF(models); k++) {
        for (int32_t scale = 1; scale <= 2; scale++) {
            sl_generated *mesh = make(models[k].name, 1, scale);
            int32_t found = 0, in_plane = 0;
            qsort(mesh->xyz, (size_t)mesh->nv, 3 * sizeof *mesh->xyz, compare_points);
            for (int32_t v = 0; v < mesh->nv; v++) {
                const double *p = mesh->xyz + 3 * (int64_t)v;
                const double image[3] = {0.0 - p[0], p[1], p[2]};
                found += bsearch(image, mesh->xyz, (size_t)mesh->nv, sizeof image, compare_points) != NULL;
                in_plane += p[0] == 0.0;
            }
            assert_int_equal(found, models[k].mirrored ? mesh->nv : 0);
            assert_true(in_plane < mesh->nv / 6 && (in_plane > 20) == models[k].mirrored);
            sl_generated_free(mesh);
        }
    }
}

/* M x + t. */
static void apply(const double m[12], const double *x, double out[3])
{
    for (int k = 0; k < 3; k++) {
        out[k] = m[4 * k] * x[0] + m[4 * k + 1] * x[1] + m[4 * k + 2] * x[2] + m[4 * k + 3];
    }
}

/* The corners of f, mapped, are the corners of its image in the same cycle, reversed by a mirror. */
static bool face_follows(const sl_generated *mesh, const sl_planted *p, int32_t f)
{
    const int32_t *from = mesh->index + mesh->face_first[f], n = mesh->face_first[f + 1] - mesh->face_first[f];
    const int32_t *to = mesh->index + mesh->face_first[p->face[f]];
    int32_t start = 0;
    if (mesh->face_first[p->face[f] + 1] - mesh->face_first[p->face[f]] != n) {
        return false;
    }
    while (start < n && to[start] != p->vertex[from[0]]) {
        start++;
    }
    for (int32_t k = 1; start < n && k < n; k++) {
        if (to[(p->mirror ? start + n - k : start + k) % n] != p->vertex[from[k]]) {
            return false;
        }
    }
    return start < n;
}

static void planted_maps_are_the_symmetries_they_say(void **state)
{
    (void)state;
    for (size_t k = 0; k < SL_COUNTOF(models); k++) {
        sl_generated *mesh = make(models[k].name, 1, 1);
        int32_t mirrors_in_x = 0;
        assert_int_equal(mesh->nplanted, models[k].planted);
        for (int32_t i = 0; i < mesh->nplanted; i++) {
            const sl_planted *p = &mesh->planted[i];
            assert_true(p->exact);
            mirrors_in_x += p->mirror && fabs(p->matrix[0] + 1.0) < 1e-12;
            for (int32_t v = 0; v < mesh->nv; v++) {
                double image[3];
                apply(p->matrix, mesh->xyz + 3 * (int64_t)v, image);
                for (int axis = 0; axis < 3; axis++) {
                    assert_true(test_near(image[axis], mesh->xyz[3 * (int64_t)p->vertex[v] + axis], 1e-11));
                }
                assert_true(!p->mirror || p->vertex[p->vertex[v]] == v);
            }
            for (int32_t f = 0; f < mesh->nf; f++) {
                assert_true(face_follows(mesh, p, f));
            }
        }
        assert_int_equal(mirrors_in_x, models[k].mirrored);
        sl_generated_free(mesh);
    }
}

/* A facet and its mirror image start at corners that are images: a fan cuts both along the same diagonals. */
static void facets_and_their_mirror_images_start_at_the_same_corner(void **state)
{
    (void)state;
    for (size_t k = 0; k < SL_COUNTOF(models); k++) {
        sl_generated *mesh = make(models[k].name, 1, 1);
        for (int32_t i = 0; i < mesh->nplanted; i++) {
            const sl_planted *p = &mesh->planted[i];
            for (int32_t f = 0; f < mesh->nf && p->mirror && fabs(p->matrix[0] + 1.0) < 1e-12; f++) {
                assert_int_equal(mesh->index[mesh->face_first[p->face[f]]],
                                 p->vertex[mesh->index[mesh->face_first[f]]]);
            }
        }
        sl_generated_free(mesh);
    }
}

static double area_of(const sl_generated *mesh, int32_t f)
{
    const int32_t first = mesh->face_first[f], n = mesh->face_first[f + 1] - first;
    double sum[3] = {0.0, 0.0, 0.0};
    for (int32_t k = 0; k < n; k++) {
        const double *a = mesh->xyz + 3 * (int64_t)mesh->index[first + k];
        const double *b = mesh->xyz + 3 * (int64_t)mesh->index[first + (k + 1) % n];
        for (int axis = 0; axis < 3; axis++) {
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            sum[axis] += 0.5 * (a[u] * b[v] - a[v] * b[u]);
        }
    }
    return sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
}

static void no_facet_is_degenerate(void **state)
{
    (void)state;
    for (size_t k = 0; k < SL_COUNTOF(models); k++) {
        for (int32_t scale = 1; scale <= 2; scale++) {
            sl_generated *mesh = make(models[k].name, 1, scale);
            double least = HUGE_VAL, mean = 0.0;
            for (int32_t f = 0; f < mesh->nf; f++) {
                const double area = area_of(mesh, f);
                least = fmin(least, area);
                mean += area / mesh->nf;
            }
            assert_true(least > 2e-3 * mean);
            sl_generated_free(mesh);
        }
    }
}

/* Six times the volume of the cone from the origin over the surface. */
static double cone_of(const sl_mesh *m, const sl_triangulation *t)
{
    double sum = 0.0;
    for (int32_t i = 0; i < t->nt; i++) {
        const double *a = m->xyz + 3 * (int64_t)m->origin[t->corner[3 * i]];
        const double *b = m->xyz + 3 * (int64_t)m->origin[t->corner[3 * i + 1]];
        const double *c = m->xyz + 3 * (int64_t)m->origin[t->corner[3 * i + 2]];
        sum += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
               a[2] * (b[0] * c[1] - b[1] * c[0]);
    }
    return sum;
}

static void surfaces_face_outward_and_do_not_cross_themselves(void **state)
{
    (void)state;
    for (size_t k = 0; k < SL_COUNTOF(models); k++) {
        for (int32_t scale = 1; scale <= 2; scale++) {
            sl_generated *mesh = make(models[k].name, 1, scale);
            sl_polygons polygons;
            sl_mesh *built = NULL;
            sl_triangulation *triangulation = NULL;
            sl_generated_polygons(mesh, &polygons);
            assert_int_equal(sl_mesh_build(&polygons, &built, NULL, NULL), SL_OK);
            assert_int_equal(sl_triangulation_create(built, &triangulation), SL_OK);
            assert_true(cone_of(built, triangulation) > 1e-3);
            assert_int_equal(test_count_crossings(built, triangulation), 0);
            sl_triangulation_free(triangulation);
            sl_mesh_free(built);
            sl_generated_free(mesh);
        }
    }
}

/* Edges in the mirror plane make one path down the front and one down the back, each from border to border. */
static void a_line_of_edges_runs_down_the_front_of_the_pullover(void **state)
{
    (void)state;
    sl_generated *mesh = make("pullover", 1, 1);
    int32_t *degree = calloc((size_t)mesh->nv, sizeof *degree);
    int32_t ends[2] = {0, 0}, inner[2] = {0, 0};
    assert_non_null(degree);
    for (int32_t f = 0; f < mesh->nf; f++) {
        for (int32_t k = 0; k < 4; k++) {
            const int32_t a = mesh->index[4 * f + k], b = mesh->index[4 * f + (k + 1) % 4];
            if (mesh->xyz[3 * (int64_t)a] == 0.0 && mesh->xyz[3 * (int64_t)b] == 0.0) {
                degree[a]++; /* seen from both sides: every edge twice */
                degree[b]++;
            }
        }
    }
    for (int32_t v = 0; v < mesh->nv; v++) {
        const double *p = mesh->xyz + 3 * (int64_t)v;
        if (p[0] == 0.0) {
            assert_true(degree[v] == 2 || degree[v] == 4);
            *(degree[v] == 2 ? &ends[p[2] > 0.0] : &inner[p[2] > 0.0]) += 1;
        }
    }
    assert_true(ends[0] == 2 && ends[1] == 2);
    assert_true(inner[0] > 20 && inner[1] == inner[0]);
    free(degree);
    sl_generated_free(mesh);
}

static void the_character_is_of_triangles_quads_and_hexagons(void **state)
{
    (void)state;
    for (int32_t scale = 1; scale <= 2; scale++) {
        sl_generated *mesh = make("character", 1, scale);
        int32_t corners[8] = {0};
        for (int32_t f = 0; f < mesh->nf; f++) {
            const int32_t n = mesh->face_first[f + 1] - mesh->face_first[f];
            assert_true(n < 8);
            corners[n]++;
        }
        assert_true(corners[3] > 40 && corners[4] > 200 && corners[6] > 10);
        assert_int_equal(corners[3] + corners[4] + corners[6], mesh->nf);
        sl_generated_free(mesh);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_is_one_sound_sphere_but_for_the_openings_of_the_pullover),
        cmocka_unit_test(the_euler_number_is_two_less_the_openings),
        cmocka_unit_test(sizes_are_as_said_and_each_scale_has_about_four_times_the_facets),
        cmocka_unit_test(the_same_bytes_come_again_for_any_seed),
        cmocka_unit_test(vertices_have_their_mirror_image_to_the_bit_or_none_has),
        cmocka_unit_test(planted_maps_are_the_symmetries_they_say),
        cmocka_unit_test(facets_and_their_mirror_images_start_at_the_same_corner),
        cmocka_unit_test(no_facet_is_degenerate),
        cmocka_unit_test(surfaces_face_outward_and_do_not_cross_themselves),
        cmocka_unit_test(a_line_of_edges_runs_down_the_front_of_the_pullover),
        cmocka_unit_test(the_character_is_of_triangles_quads_and_hexagons),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
