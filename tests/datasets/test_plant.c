/* Planting: the maps found against maps known by index, and what cannot be mapped. */
#include "builder.h"
#include "plant.h"
#include "support/test_support.h"

#include <math.h>

enum { COLUMNS = 5, ROWS = 4 };

/* An open sheet of quads and one triangle pair, symmetric about x = 0 by construction: odd number of columns. */
static sl_generated *sheet(bool spoiled)
{
    gen_builder b = {0};
    sl_generated *mesh = NULL;
    for (int i = 0; i <= COLUMNS; i++) {
        for (int j = 0; j <= ROWS; j++) {
            const double x = i - 0.5 * COLUMNS, wobble = 0.13 * x * x * x;
            gen_vertex(&b, x + wobble, 0.7 * j + 0.11 * x * x, 0.3 * j * j - 0.17 * x * x * j);
        }
    }
    for (int i = 0; i < COLUMNS; i++) {
        for (int j = 0; j < ROWS; j++) {
            const int32_t a = i * (ROWS + 1) + j, c = a + ROWS + 1;
            if (spoiled && i == 0 && j == 1) { /* a quad split on one side only */
                gen_triangle(&b, a, c, c + 1);
                gen_triangle(&b, a, c + 1, a + 1);
            } else {
                gen_quad(&b, a, c, c + 1, a + 1);
            }
        }
    }
    assert_int_equal(gen_finish(&b, &mesh), SL_OK);
    return mesh;
}

static void a_mirror_maps_each_vertex_and_facet_to_its_image_by_index(void **state)
{
    (void)state;
    sl_generated *mesh = sheet(false);
    assert_int_equal(gen_plant_mirror(mesh, "mirror x", -3.0, 0.0, 0.0, true), SL_OK);
    assert_int_equal(mesh->nplanted, 1);
    const sl_planted *p = &mesh->planted[0];
    assert_true(p->mirror && p->exact);
    assert_string_equal(p->name, "mirror x");
    for (int i = 0; i <= COLUMNS; i++) {
        for (int j = 0; j <= ROWS; j++) {
            assert_int_equal(p->vertex[i * (ROWS + 1) + j], (COLUMNS - i) * (ROWS + 1) + j);
        }
    }
    for (int i = 0; i < COLUMNS; i++) {
        for (int j = 0; j < ROWS; j++) {
            assert_int_equal(p->face[i * ROWS + j], (COLUMNS - 1 - i) * ROWS + j);
        }
    }
    sl_generated_free(mesh);
}

static void what_is_no_symmetry_is_refused_and_the_mesh_left_alone(void **state)
{
    (void)state;
    const double identity[12] = {1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0};
    sl_generated *mesh = sheet(false), *spoiled = sheet(true);
    assert_int_equal(gen_plant_mirror(mesh, "mirror y", 0.0, 1.0, 0.0, true), SL_INTERNAL);
    assert_int_equal(gen_plant(mesh, "identity", identity, true), SL_INTERNAL);
    assert_int_equal(gen_plant_dihedral(mesh, 2, 5, 0.0, true), SL_INTERNAL);
    assert_int_equal(mesh->nplanted, 0);
    /* all vertices have images here, two facets have none */
    assert_int_equal(gen_plant_mirror(spoiled, "mirror x", 1.0, 0.0, 0.0, true), SL_INTERNAL);
    assert_int_equal(spoiled->nplanted, 0);
    /* a vertex moved by more than the tolerance, and by less */
    mesh->xyz[4] += 1e-7;
    assert_int_equal(gen_plant_mirror(mesh, "mirror x", 1.0, 0.0, 0.0, true), SL_INTERNAL);
    mesh->xyz[4] += 1e-10 - 1e-7;
    assert_int_equal(gen_plant_mirror(mesh, "mirror x", 1.0, 0.0, 0.0, true), SL_OK);
    sl_generated_free(mesh);
    sl_generated_free(spoiled);
}

/* A pyramid over a regular pentagon, standing on an n-gon. */
static void a_dihedral_group_is_planted_as_a_rotation_and_all_its_mirrors(void **state)
{
    (void)state;
    gen_builder b = {0};
    sl_generated *mesh = NULL;
    int32_t base[5];
    for (int k = 0; k < 5; k++) {
        const double phi = 0.4 + 2.0 * 3.14159265358979323846 * k / 5;
        base[k] = gen_vertex(&b, -0.3, 1.7 * cos(phi), 1.7 * sin(phi));
    }
    const int32_t top = gen_vertex(&b, 1.1, 0.0, 0.0);
    for (int k = 0; k < 5; k++) {
        gen_triangle(&b, base[k], base[(k + 1) % 5], top);
    }
    gen_facet(&b, 5, (int32_t[]){base[4], base[3], base[2], base[1], base[0]});
    assert_int_equal(gen_finish(&b, &mesh), SL_OK);
    assert_int_equal(gen_plant_dihedral(mesh, 0, 5, 0.4, true), SL_OK);
    assert_int_equal(mesh->nplanted, 6);
    assert_false(mesh->more_mirrors);
    assert_false(mesh->planted[0].mirror);
    for (int k = 0; k < 5; k++) {
        assert_int_equal(mesh->planted[0].vertex[base[k]], base[(k + 1) % 5]);
        assert_int_equal(mesh->planted[0].face[k], (k + 1) % 5);
        assert_true(mesh->planted[1 + k].mirror);
        assert_int_equal(mesh->planted[1 + k].vertex[base[0]], base[k]); /* mirror k lies at 0.4 + k pi / 5 */
    }
    assert_int_equal(gen_plant_near(mesh, "about mirror", mesh->planted[1].matrix), SL_OK);
    assert_int_equal(mesh->nnear, 1);
    sl_generated_free(mesh);
}

/* det M < 0 and an involution, but no plane stays: a box's point reflection is no mirror. */
static void an_inversion_is_planted_but_is_no_mirror(void **state)
{
    (void)state;
    const double inversion[12] = {-1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0};
    sl_generated *mesh = NULL;
    assert_int_equal(gen_box(0, 1, &mesh), SL_OK);
    assert_int_equal(mesh->nplanted, 3);
    assert_int_equal(gen_plant(mesh, "inversion", inversion, true), SL_OK);
    assert_false(mesh->planted[3].mirror);
    for (int32_t f = 0; f < mesh->nf; f++) { /* the product of the three mirrors */
        const sl_planted *p = mesh->planted;
        assert_int_equal(p[3].face[f], p[0].face[p[1].face[p[2].face[f]]]);
    }
    sl_generated_free(mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_mirror_maps_each_vertex_and_facet_to_its_image_by_index),
        cmocka_unit_test(what_is_no_symmetry_is_refused_and_the_mesh_left_alone),
        cmocka_unit_test(a_dihedral_group_is_planted_as_a_rotation_and_all_its_mirrors),
        cmocka_unit_test(an_inversion_is_planted_but_is_no_mirror),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
