/* What must not matter: scale, place, direction, and how facets and vertices are numbered. */
#include "atlas/atlas.h"
#include "base/memory.h"
#include "generators.h"
#include "spectral/spectrum.h"
#include "support/test_support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A mesh of one's own that can be moved and renumbered. */
typedef struct soup {
    sl_polygons polygons;
    double *xyz;
    int32_t *first, *index;
    int32_t *face_of; /* nf: the original's facet */
} soup;

static soup copy_of(const sl_polygons *p)
{
    soup s = {.xyz = sl_copy(p->xyz, 3 * (int64_t)p->nv, sizeof(double)),
              .first = sl_copy(p->face_first, p->nf + 1, sizeof(int32_t)),
              .index = sl_copy(p->index, p->face_first[p->nf], sizeof(int32_t)),
              .face_of = malloc((size_t)p->nf * sizeof(int32_t))};
    for (int32_t f = 0; f < p->nf; f++) {
        s.face_of[f] = f;
    }
    s.polygons = (sl_polygons){p->nv, p->nf, s.xyz, s.first, s.index};
    return s;
}

static void discard(soup *s)
{
    sl_free(s->xyz);
    sl_free(s->first);
    sl_free(s->index);
    free(s->face_of);
}

static double diagonal(const sl_polygons *p)
{
    double lo[3], hi[3], sum = 0.0;
    for (int32_t i = 0; i < 3 * p->nv; i++) {
        lo[i % 3] = i < 3 ? p->xyz[i] : fmin(lo[i % 3], p->xyz[i]);
        hi[i % 3] = i < 3 ? p->xyz[i] : fmax(hi[i % 3], p->xyz[i]);
    }
    for (int k = 0; k < 3; k++) {
        sum += (hi[k] - lo[k]) * (hi[k] - lo[k]);
    }
    return sqrt(sum);
}

static void scale(soup *s, double factor)
{
    for (int32_t i = 0; i < 3 * s->polygons.nv; i++) {
        s->xyz[i] *= factor;
    }
}

static void translate(soup *s, test_rng *rng)
{
    const double far = 1e3 * diagonal(&s->polygons), way[3] = {far, -far * test_uniform(rng, 0.3, 0.9), 0.7 * far};
    for (int32_t i = 0; i < 3 * s->polygons.nv; i++) {
        s->xyz[i] += way[i % 3];
    }
}

/* By a random unit quaternion. */
static void rotate(soup *s, test_rng *rng)
{
    double q[4], length = 0.0;
    for (int k = 0; k < 4; k++) {
        q[k] = test_uniform(rng, -1.0, 1.0) + (k == 0 ? 0.2 : 0.0);
        length += q[k] * q[k];
    }
    for (int k = 0; k < 4; k++) {
        q[k] /= sqrt(length);
    }
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    const double R[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                            {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                            {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
    for (int32_t v = 0; v < s->polygons.nv; v++) {
        double *p = s->xyz + 3 * v, moved[3];
        for (int k = 0; k < 3; k++) {
            moved[k] = R[k][0] * p[0] + R[k][1] * p[1] + R[k][2] * p[2];
        }
        memcpy(p, moved, sizeof moved);
    }
}

static int32_t *permutation(test_rng *rng, int32_t n)
{
    int32_t *order = malloc((size_t)n * sizeof *order);
    for (int32_t i = 0; i < n; i++) {
        const int32_t j = test_index(rng, i + 1);
        order[i] = i;
        order[i] = order[j];
        order[j] = i;
    }
    return order;
}

static void renumber(soup *s, const sl_polygons *p, test_rng *rng)
{
    int32_t *vertex = permutation(rng, p->nv), *face = permutation(rng, p->nf), corners = 0;
    for (int32_t v = 0; v < p->nv; v++) {
        memcpy(s->xyz + 3 * vertex[v], p->xyz + 3 * v, 3 * sizeof *s->xyz);
    }
    for (int32_t f = 0; f < p->nf; f++) {
        const int32_t from = face[f];
        s->face_of[f] = from;
        s->first[f] = corners;
        for (int32_t c = p->face_first[from]; c < p->face_first[from + 1]; c++) {
            s->index[corners++] = vertex[p->index[c]];
        }
    }
    s->first[p->nf] = corners;
    free(vertex);
    free(face);
}

/* What comes out, in the original's numbering. */
typedef struct outcome {
    sl_atlas *atlas;
    int32_t *chart; /* nf: numbered by the original's first facets */
    int32_t charts;
    double seam; /* over the root of the area */
} outcome;

static outcome unwrap(const soup *s, const sl_atlas_def *def)
{
    outcome o = {.chart = malloc((size_t)s->polygons.nf * sizeof *o.chart)};
    assert_int_equal(sl_unwrap(&s->polygons, def, NULL, &o.atlas, NULL), SL_OK);
    assert_true(o.atlas->check.passed);
    int32_t *name = malloc((size_t)o.atlas->segmentation->nchart * sizeof *name);
    memset(name, -1, (size_t)o.atlas->segmentation->nchart * sizeof *name);
    for (int32_t f = 0; f < s->polygons.nf; f++) {
        o.chart[s->face_of[f]] = o.atlas->segmentation->face_chart[f];
    }
    for (int32_t f = 0; f < s->polygons.nf; f++) {
        int32_t *n = &name[o.chart[f]];
        *n = *n < 0 ? o.charts++ : *n;
        o.chart[f] = *n;
    }
    double area = 0.0;
    for (int32_t f = 0; f < o.atlas->mesh->nf; f++) {
        area += sl_mesh_face_area(o.atlas->mesh, f);
    }
    o.seam = sl_atlas_seam_length(o.atlas->mesh) / sqrt(area);
    free(name);
    return o;
}

/* The mesh as it was before split k; *seed = a facet of the chart that was split. Freed by the caller. */
static sl_mesh *before_split(const sl_atlas *atlas, int32_t k, int32_t *seed)
{
    const int32_t *cut_after = atlas->segmentation->cut_after;
    sl_mesh *mesh = NULL;
    assert_int_equal(sl_mesh_copy(atlas->mesh, &mesh), SL_OK);
    *seed = -1;
    for (int32_t h = 0; h < mesh->nh; h++) {
        if (mesh->sew[h] >= 0 && (cut_after[h] >= k || cut_after[h] < 0)) {
            sl_mesh_sew_edge(mesh, h);
        } else if (mesh->twin[h] >= 0 && cut_after[h] >= 0 && cut_after[h] < k) { /* sewn later */
            sl_mesh_cut_edge(mesh, h);
        }
        *seed = cut_after[h] == k ? mesh->face[h] : *seed;
    }
    assert_true(*seed >= 0);
    return mesh;
}

/* The smallest relative gap between neighbours of the eigenvalues of the chart that facet seed is in, of this many
 * facets. */
static double chart_gap(const sl_mesh *mesh, int32_t seed, int32_t facets)
{
    int32_t *label = malloc((size_t)mesh->nf * sizeof *label), *face = malloc((size_t)mesh->nf * sizeof *face);
    int32_t parts = 0, count = 0;
    double gap = HUGE_VAL;
    sl_facet_graph *graph = NULL;
    sl_spectrum *spectrum = NULL;
    assert_int_equal(sl_mesh_components(mesh, label, &parts), SL_OK);
    for (int32_t f = 0; f < mesh->nf; f++) {
        if (label[f] == label[seed]) {
            face[count++] = f;
        }
    }
    assert_int_equal(count, facets);
    assert_int_equal(sl_facet_graph_create(mesh, face, count, NULL, &graph), SL_OK);
    assert_int_equal(sl_spectrum_compute(graph, 30, NULL, &spectrum), SL_OK);
    for (int32_t i = 2; i < spectrum->count; i++) {
        gap = fmin(gap, (spectrum->lambda[i] - spectrum->lambda[i - 1]) / spectrum->lambda[i]);
    }
    sl_spectrum_free(spectrum);
    sl_facet_graph_free(graph);
    free(label);
    free(face);
    return gap;
}

/* The smallest of all splits; 0 where one was not chosen from eigenvalues alone. */
static double smallest_gap(const sl_atlas *atlas)
{
    double gap = atlas->segmentation->paired ? 0.0 : HUGE_VAL;
    for (int32_t k = 0; k < atlas->segmentation->nsplit; k++) {
        const sl_split *split = &atlas->segmentation->split[k];
        int32_t seed;
        sl_mesh *mesh = before_split(atlas, k, &seed);
        gap = split->symmetry != SL_SPLIT_PLAIN ? 0.0 : fmin(gap, chart_gap(mesh, seed, split->facets));
        sl_mesh_free(mesh);
    }
    return gap;
}

static void outcome_clear(outcome *o)
{
    sl_atlas_free(o->atlas);
    free(o->chart);
}

enum { TINY, HUGE_ONE, FAR, TURNED, RENUMBERED, VARIANTS };

static soup variant(const sl_polygons *p, int which, test_rng *rng)
{
    soup s = copy_of(p);
    switch (which) {
    case TINY:
    case HUGE_ONE:
        scale(&s, which == TINY ? 1e-6 : 1e6);
        break;
    case FAR:
        translate(&s, rng);
        break;
    case TURNED:
        rotate(&s, rng);
        break;
    default:
        renumber(&s, p, rng);
        break;
    }
    return s;
}

static sl_generated *generate(const char *name, sl_polygons *p)
{
    sl_generated *made = NULL;
    const sl_generator *g = sl_generator_find(name);
    assert_non_null(g);
    assert_int_equal(g->make(1, 1, &made), SL_OK);
    sl_generated_polygons(made, p);
    return made;
}

static sl_atlas_def small_pages(void)
{
    sl_atlas_def def = sl_atlas_default();
    def.pack.resolution = 512;
    def.check_resolution = 512;
    return def;
}

/* Powers of two change no digit: the same UVs, bit for bit, with symmetry and without. */
static void a_scale_that_is_a_power_of_two_gives_the_same_bytes(void **state)
{
    (void)state;
    static const char *const names[] = {"bracket", "slab", "character"};
    for (size_t k = 0; k < SL_COUNTOF(names); k++) {
        sl_polygons p;
        sl_generated *made = generate(names[k], &p);
        sl_atlas_def def = small_pages();
        def.segment.symmetry = k % 2 == 0 ? def.segment.symmetry : SL_SYMMETRY_USE_OFF;
        soup s = copy_of(&p), t = copy_of(&p);
        scale(&t, k % 2 == 0 ? 0x1p37 : 0x1p-61);
        outcome a = unwrap(&s, &def), b = unwrap(&t, &def);
        const size_t corners = (size_t)p.face_first[p.nf];
        assert_memory_equal(a.atlas->input_corner_uv, b.atlas->input_corner_uv, 2 * corners * sizeof(double));
        assert_memory_equal(a.atlas->segmentation->face_chart, b.atlas->segmentation->face_chart,
                            (size_t)p.nf * sizeof(int32_t));
        outcome_clear(&a);
        outcome_clear(&b);
        discard(&s);
        discard(&t);
        sl_generated_free(made);
    }
}

/* Eigenvalues well apart: the very same charts. */
static void charts_are_the_same_where_eigenvalues_are_apart(void **state)
{
    (void)state;
    static const char *const names[] = {"bracket", "mug"};
    test_rng rng = test_rng_seed(0x1a7);
    for (size_t k = 0; k < SL_COUNTOF(names); k++) {
        sl_polygons p;
        sl_generated *made = generate(names[k], &p);
        sl_atlas_def def = small_pages();
        def.segment.symmetry = SL_SYMMETRY_USE_OFF;
        soup s = copy_of(&p);
        outcome a = unwrap(&s, &def);
        assert_true(a.charts > 1 && smallest_gap(a.atlas) > 1e-6);
        for (int v = 0; v < VARIANTS; v++) {
            soup t = variant(&p, v, &rng);
            outcome b = unwrap(&t, &def);
            assert_int_equal(a.charts, b.charts);
            assert_memory_equal(a.chart, b.chart, (size_t)p.nf * sizeof(int32_t));
            assert_true(test_near(a.seam, b.seam, 1e-6 * a.seam));
            outcome_clear(&b);
            discard(&t);
        }
        outcome_clear(&a);
        discard(&s);
        sl_generated_free(made);
    }
}

/* The atlas of every variant has as many charts and as long seams, within a tenth. */
static void check_as_good(const char *const *names, size_t count, const sl_atlas_def *def, uint64_t seed)
{
    test_rng rng = test_rng_seed(seed);
    for (size_t k = 0; k < count; k++) {
        sl_polygons p;
        sl_generated *made = generate(names[k], &p);
        soup s = copy_of(&p);
        outcome a = unwrap(&s, def);
        for (int v = 0; v < VARIANTS; v++) {
            soup t = variant(&p, v, &rng);
            outcome b = unwrap(&t, def);
            assert_true(abs(a.charts - b.charts) <= 0.1 * a.charts);
            assert_true(test_near(a.seam, b.seam, 0.1 * a.seam));
            outcome_clear(&b);
            discard(&t);
        }
        outcome_clear(&a);
        discard(&s);
        sl_generated_free(made);
    }
}

/* Symmetric models: eigenvalues coincide and axes abound; another one may be taken, but none that is much worse. */
static void atlases_are_as_good_where_eigenvalues_coincide(void **state)
{
    (void)state;
    static const char *const names[] = {"slab", "beam", "plate", "chain"};
    const sl_atlas_def def = small_pages();
    check_as_good(names, SL_COUNTOF(names), &def, 0x1a8);
}

static void atlases_by_search_are_as_good(void **state)
{
    (void)state;
    static const char *const names[] = {"slab", "cube", "chain"};
    sl_atlas_def def = small_pages();
    def.best = true;
    check_as_good(names, SL_COUNTOF(names), &def, 0x1a9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_scale_that_is_a_power_of_two_gives_the_same_bytes),
        cmocka_unit_test(charts_are_the_same_where_eigenvalues_are_apart),
        cmocka_unit_test(atlases_are_as_good_where_eigenvalues_coincide),
        cmocka_unit_test(atlases_by_search_are_as_good),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
