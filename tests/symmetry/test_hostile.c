/* Odd meshes, refused allocations, cancelling. Linked with malloc, calloc and realloc wrapped. */
#include "checks.h"

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *memory, size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *memory, size_t size);

static int64_t allocations, failing; /* failing: the allocation to refuse, 0 = none */

static bool refuses(void)
{
    return ++allocations == failing;
}

void *__wrap_malloc(size_t size)
{
    return refuses() ? NULL : __real_malloc(size);
}

void *__wrap_calloc(size_t count, size_t size)
{
    return refuses() ? NULL : __real_calloc(count, size);
}

void *__wrap_realloc(void *memory, size_t size)
{
    return refuses() ? NULL : __real_realloc(memory, size);
}

/* Everything the room offers, once. */
static sl_status run_all(const sl_mesh *mesh, const int32_t *partner, const sl_context *context, int32_t *maps)
{
    const sl_symmetry_def def = sl_symmetry_default();
    sl_symmetry *s = NULL;
    sl_near_mirror near;
    uint8_t side[256];
    int32_t image[512];
    bool found;
    sl_status status = sl_symmetry_find(mesh, partner, &def, context, &s);
    assert_true((s != NULL) == (status == SL_OK));
    if (status == SL_OK) {
        *maps = s->nmap;
        status = sl_symmetry_near(mesh, &def, context, NULL, &near);
    }
    for (int32_t i = 0; status == SL_OK && i < s->nmap && i < 2; i++) {
        status = s->map[i].separates ? sl_symmetry_sides(mesh, s, &s->map[i], side) : SL_OK;
    }
    if (status == SL_OK) {
        status = sl_symmetry_traverse(mesh, 0, 1, true, image, &found);
    }
    sl_symmetry_free(s);
    return status;
}

static void every_refused_allocation_is_survived(void **state)
{
    (void)state;
    test_rng rng = test_rng_seed(0x0a110c);
    int32_t mirror[400], partner[256], first = 0;
    model m = model_new();
    model_planted(&m, &rng, 2, 3, true, false, mirror);
    const double T[12] = {1, 0, 0, 9, 0, 1, 0, 9, 0, 0, 1, 9};
    model_repeat(&m, m.nf, m.nv, T, false);
    sl_mesh *mesh = model_build(&m);
    for (int32_t f = 0; f < m.nf; f++) {
        const bool triangle = m.first[f + 1] - m.first[f] == 3;
        partner[f] = triangle ? (f > 0 && partner[f - 1] == f ? f - 1 : f + 1) : -1;
    }
    for (int with = 0; with < 2; with++) {
        assert_int_equal(run_all(mesh, with ? partner : NULL, NULL, &first), SL_OK);
        sl_status status = SL_OUT_OF_MEMORY;
        int64_t k = 1;
        for (; status != SL_OK; k++) {
            int32_t maps = -1;
            allocations = 0;
            failing = k;
            status = run_all(mesh, with ? partner : NULL, NULL, &maps);
            failing = 0;
            assert_true(status == SL_OUT_OF_MEMORY || (status == SL_OK && maps == first));
            assert_true(k < 1000);
        }
        assert_true(k > 30);
    }
    sl_mesh_free(mesh);
    model_free(&m);
}

typedef struct countdown {
    int32_t left, calls;
} countdown;

static bool count_down(void *user, const char *stage, double fraction)
{
    countdown *c = user;
    assert_true(stage != NULL && fraction >= 0.0 && fraction <= 1.0);
    c->calls++;
    return c->left-- > 0;
}

static void cancelling_stops_at_every_report(void **state)
{
    (void)state;
    int32_t maps = 0;
    model m = model_new();
    model_box(&m, 2, 3, 1);
    sl_mesh *mesh = model_build(&m);
    countdown all = {1000, 0};
    const sl_context context = {.progress = count_down, .progress_user = &all};
    assert_int_equal(run_all(mesh, NULL, &context, &maps), SL_OK);
    assert_true(all.calls > 10);
    for (int32_t k = 0; k < all.calls; k++) {
        countdown c = {k, 0};
        const sl_context stops = {.progress = count_down, .progress_user = &c};
        assert_int_equal(run_all(mesh, NULL, &stops, &maps), SL_CANCELLED);
        assert_int_equal(c.calls, k + 1);
    }
    sl_mesh_free(mesh);
    model_free(&m);
}

/* A strip of n quads whose ends are glued with k half twists; repaired by the builder where it is one-sided. */
static void make_band(model *m, int n, int twists)
{
    for (int i = 0; i < n; i++) {
        const double a = 2 * TEST_PI * i / n, t = 0.5 * twists * a;
        for (int side = -1; side <= 1; side += 2) {
            const double r = 2.0 + 0.4 * side * cos(t);
            model_vertex(m, r * cos(a), r * sin(a), 0.4 * side * sin(t));
        }
    }
    for (int i = 0; i < n; i++) {
        const int a = 2 * i, b = 2 * ((i + 1) % n), flip = i + 1 == n && twists % 2 == 1;
        model_quad(m, a, b + flip, b + 1 - flip, a + 1);
    }
}

static void odd_meshes_are_searched_like_others(void **state)
{
    (void)state;
    for (int which = 0; which < 8; which++) {
        model m = model_new();
        int32_t least = 1;
        switch (which) {
        case 0: /* two sheets that meet in a vertex */
            for (int i = 0; i < 7; i++) {
                model_vertex(&m, i % 3, i / 3, 0.1 * i * i);
            }
            model_triangle(&m, 0, 1, 2);
            model_triangle(&m, 0, 3, 4);
            model_triangle(&m, 0, 5, 6);
            break;
        case 1: /* an edge of three facets */
            for (int i = 0; i < 5; i++) {
                model_vertex(&m, i % 2, i / 2, 0.3 * i);
            }
            model_triangle(&m, 0, 1, 2);
            model_triangle(&m, 0, 1, 3);
            model_triangle(&m, 1, 0, 4);
            break;
        case 2: /* a facet of no area, a facet twice */
            for (int i = 0; i < 5; i++) {
                model_vertex(&m, i, i == 4, 0);
            }
            model_triangle(&m, 0, 1, 2);
            model_triangle(&m, 0, 3, 4);
            model_triangle(&m, 3, 4, 0);
            break;
        case 3:
            make_band(&m, 12, 1);
            break;
        case 4:
            make_band(&m, 9, 2);
            break;
        case 5: /* a cone: one vertex of all facets */
            model_vertex(&m, 0, 0, 1);
            for (int i = 0; i < 40; i++) {
                model_vertex(&m, cos(2 * TEST_PI * i / 40), sin(2 * TEST_PI * i / 40), 0);
            }
            for (int i = 0; i < 40; i++) {
                model_triangle(&m, 0, 1 + i, 1 + (i + 1) % 40);
            }
            least = 64;
            break;
        case 6: { /* one facet of many corners */
            int32_t corner[150];
            for (int i = 0; i < 150; i++) {
                corner[i] = model_vertex(&m, cos(2 * TEST_PI * i / 150), sin(2 * TEST_PI * i / 150), 0);
            }
            model_face(&m, 150, corner);
            least = 64;
            break;
        }
        default: /* a tube of one quad around: its facet is glued to itself */
            for (int i = 0; i < 4; i++) {
                model_vertex(&m, i == 1, 0, i / 2);
            }
            model_quad(&m, 0, 1, 3, 2);
            break;
        }
        sl_mesh *mesh = model_build(&m);
        if (which == 7) {
            mesh->twin[1] = 3;
            mesh->twin[3] = 1;
            mesh->origin[1] = mesh->origin[0];
            mesh->origin[2] = mesh->origin[3];
        }
        sl_symmetry *s = find_all(mesh, NULL, SL_SYMMETRY_MOST);
        assert_true(s->nmap >= least && s->nmap <= SL_SYMMETRY_MOST * s->components);
        check_all(mesh, s);
        sl_near_mirror near;
        const sl_symmetry_def def = sl_symmetry_default();
        assert_int_equal(sl_symmetry_near(mesh, &def, NULL, NULL, &near), SL_OK);
        sl_symmetry_free(s);
        sl_mesh_free(mesh);
        model_free(&m);
    }
}

static void a_mesh_of_nothing_has_nothing(void **state)
{
    (void)state;
    model m = model_new();
    model_triangle(&m, model_vertex(&m, 0, 0, 0), model_vertex(&m, 1, 0, 0), model_vertex(&m, 0, 1, 0));
    sl_mesh *mesh = model_build(&m);
    mesh->nv = mesh->nf = mesh->nh = 0;
    const sl_symmetry_def def = sl_symmetry_default();
    sl_symmetry *s = find_all(mesh, NULL, 64);
    sl_near_mirror near = {.found = true};
    assert_int_equal(s->components, 0);
    assert_int_equal(s->nmap, 0);
    assert_int_equal(sl_symmetry_near(mesh, &def, NULL, NULL, &near), SL_OK);
    assert_false(near.found);
    sl_symmetry_free(s);
    sl_symmetry_free(NULL);
    sl_mesh_free(mesh);
    model_free(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_refused_allocation_is_survived),
        cmocka_unit_test(cancelling_stops_at_every_report),
        cmocka_unit_test(odd_meshes_are_searched_like_others),
        cmocka_unit_test(a_mesh_of_nothing_has_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
