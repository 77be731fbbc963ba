/* The parts of sharing by themselves: halves compared, images judged, what may be a copy. */
#include "segment/mirrored.h"
#include "segment/share_internal.h"

static sl_segmentation *segment(sl_mesh *mesh, const sl_triangulation *t, const sl_segment_def *def, int32_t threads)
{
    sl_thread_pool *pool = NULL;
    sl_segmentation *s = NULL;
    assert_int_equal(sl_thread_pool_create(threads, &pool), SL_OK);
    const sl_context context = {.executor = sl_thread_pool_executor(pool)};
    assert_int_equal(sl_segment(mesh, t, def, &context, &s), SL_OK);
    sl_thread_pool_free(pool);
    return s;
}

/* A piece cut along its plane by hand. */
static void halves_are_shared_only_where_lengths_agree(void **state)
{
    (void)state;
    for (int bent = 0; bent < 2; bent++) {
        const test_mirrored body = {.n = 4, .mirrors = 1, .nspike = 1, .height = 0.5, .facets = TEST_QUADS, .seed = 71};
        sl_mesh *mesh = test_mirrored_mesh(&body, 1);
        for (int32_t v = 0; bent == 1 && v < mesh->nv; v++) {
            mesh->xyz[3 * v + 1] *= mesh->xyz[3 * v] > 0.0 ? 1.0 + 4e-6 : 1.0;
        }
        sl_triangulation *t = test_triangulate(mesh);
        sl_piece *piece = NULL;
        int32_t *all = malloc((size_t)mesh->nf * sizeof *all), *side = malloc((size_t)mesh->nf * sizeof *side);
        for (int32_t f = 0; f < mesh->nf; f++) {
            double c[3];
            sl_mesh_face_centroid(mesh, f, c);
            all[f] = f;
            side[f] = c[0] > 0.0;
        }
        assert_int_equal(sl_piece_create(mesh, t, all, mesh->nf, &piece), SL_OK);
        sl_chart_job job = {.count = mesh->nf};
        assert_int_equal(sl_label_parts(piece, side, &job), SL_OK);
        assert_int_equal(job.nparts, 2);
        assert_int_equal(sl_share_halves(piece, &job), SL_OK);
        assert_int_equal(job.nparts, bent == 1 ? 2 : 1);
        assert_int_equal(job.copies.count, bent == 1 ? 0 : mesh->nh / 2);
        for (int32_t k = 0; k < job.copies.count; k++) { /* each corner copies the one at its mirror image */
            const double *p = piece->mesh->xyz + 3 * piece->mesh->origin[job.copies.corner[k]];
            const double *q = piece->mesh->xyz + 3 * piece->mesh->origin[job.copies.from[k]];
            assert_true(p[0] == -q[0] && p[1] == q[1] && p[2] == q[2]);
        }
        sl_chart_job_clear(&job);
        sl_piece_free(piece);
        sl_triangulation_free(t);
        sl_mesh_free(mesh);
        free(all);
        free(side);
    }
}

/* That one triangle equals another says nothing. */
static void lone_facets_are_no_copies_of_one_another(void **state)
{
    (void)state;
    double xyz[27];
    int32_t first[4], index[9];
    for (int32_t k = 0; k < 9; k++) {
        static const double corner[3][2] = {{0.0, 0.0}, {1.0, 0.2}, {0.3, 0.9}};
        xyz[3 * k] = corner[k % 3][0] + 2.0 * (k / 3);
        xyz[3 * k + 1] = corner[k % 3][1];
        xyz[3 * k + 2] = 0.5;
        index[k] = k;
        first[k / 3] = 3 * (k / 3);
    }
    first[3] = 9;
    const sl_polygons polygons = {9, 3, xyz, first, index};
    const sl_segment_def def = sl_segment_default();
    sl_mesh *mesh = NULL;
    assert_int_equal(sl_mesh_build(&polygons, &mesh, NULL, NULL), SL_OK);
    sl_triangulation *t = test_triangulate(mesh);
    sl_segmentation *s = segment(mesh, t, &def, 1);
    assert_int_equal(s->nchart, 3);
    assert_int_equal(s->sharing.copies, 0);
    sl_segmentation_free(s);
    sl_triangulation_free(t);
    sl_mesh_free(mesh);
}

/* A claimed copy whose geometry is another is laid flat itself. */
static void check_refusal(int turned)
{
    const test_mirrored body = {.n = 4, .mirrors = 1, .nspike = 0, .height = 0.0, .facets = TEST_QUADS, .seed = 11};
    sl_mesh *mesh = test_mirrored_mesh(&body, 2), *work = NULL;
    const int32_t half = mesh->nf / 2, corners = mesh->nh / 2;
    for (int32_t h = corners; turned == 0 && h < mesh->nh;
         h++) { /* the second body drawn out to a needle, once a vertex */
        double *p = mesh->xyz + 3 * mesh->origin[h];
        p[2] = fabs(p[2]) < 2.0 ? p[2] * 8.0 + (p[2] < 0.0 ? -8.0 : 8.0) : p[2];
    }
    sl_triangulation *t = test_triangulate(mesh);
    sl_segment_def def = sl_segment_default();
    def.symmetry = SL_SYMMETRY_USE_OFF;
    sl_job_list jobs = {0}, done = {0}, refused = {0};
    sl_sharing sharing = {0};
    sl_copy_list copies = {malloc((size_t)corners * sizeof(int32_t)), malloc((size_t)corners * sizeof(int32_t)), 0,
                           turned == 1, SL_SYMMETRY_EXACT};
    for (int32_t c = corners; c < mesh->nh; c++) { /* facets correspond by number, corners by vertex */
        int32_t k = mesh->face_first[mesh->face[c] - half];
        while (mesh->origin[k] + mesh->nv / 2 != mesh->origin[c]) {
            k++;
        }
        copies.corner[copies.count] = c;
        copies.from[copies.count++] = k;
    }
    for (int32_t h = 0; h < mesh->nh; h++) { /* both cut open along the same edges, above and below */
        if (mesh->twin[h] >= 0) {
            double c[3], d[3];
            const int32_t g = mesh->face[h] % half, k = mesh->face[mesh->twin[h]] % half;
            sl_mesh_face_centroid(mesh, g, c);
            sl_mesh_face_centroid(mesh, k, d);
            if ((c[1] > 0.0) != (d[1] > 0.0)) {
                sl_mesh_cut_edge(mesh, h);
            }
        }
    }
    assert_int_equal(sl_mesh_copy(mesh, &work), SL_OK);
    assert_int_equal(sl_component_jobs(mesh, &jobs), SL_OK);
    const sl_recursion r = {.mesh = mesh, .triangulation = t, .def = &def};
    for (int64_t k = 0; k < jobs.count; k++) {
        if (jobs.job[k].face[0] < half) {
            sl_chart_job_run(&r, &jobs.job[k]);
            assert_int_equal(jobs.job[k].status, SL_OK);
            assert_true(jobs.job[k].done && !jobs.job[k].capped);
            assert_int_equal(sl_job_list_push(&done, &jobs.job[k]), SL_OK);
        }
    }
    assert_int_equal(done.count, 2);
    assert_int_equal(sl_sharing_add(&sharing, mesh, &copies), SL_OK);
    assert_int_equal(sl_sharing_resolve(&sharing, &r, mesh, work, NULL, &done, &refused), SL_OK);
    assert_int_equal(done.count, 2);
    assert_int_equal(refused.count, 2);
    assert_int_equal(sharing.info.refused, 2);
    assert_true(sharing.info.area == 0.0);
    for (int32_t h = 0; h < mesh->nh; h++) {
        assert_int_equal(sharing.from[h], -1);
        assert_int_equal(work->twin[h], mesh->twin[h]);
    }
    sl_sharing_clear(&sharing);
    free(copies.corner);
    free(copies.from);
    sl_job_list_clear(&jobs);
    sl_job_list_clear(&done);
    sl_job_list_clear(&refused);
    sl_mesh_free(work);
    sl_triangulation_free(t);
    sl_mesh_free(mesh);
}

/* Stretched to a needle; or said to be a mirror image and none: then every triangle is turned over. */
static void a_copy_that_does_not_fit_its_geometry_is_refused(void **state)
{
    (void)state;
    check_refusal(0);
    check_refusal(1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(halves_are_shared_only_where_lengths_agree),
        cmocka_unit_test(lone_facets_are_no_copies_of_one_another),
        cmocka_unit_test(a_copy_that_does_not_fit_its_geometry_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
