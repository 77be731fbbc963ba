#include "truth.h"

#include "base/file.h"

#include <inttypes.h>

/* Everything that a generated mesh must not have. */
static int32_t faults(const sl_repair_report *r)
{
    return r->unused_vertices + r->isolated_faces + r->nonmanifold_edges + r->bowtie_vertices + r->reversed_faces +
           r->one_sided_components;
}

sl_status gen_truth_check(const sl_generator *generator, const sl_generated *mesh, sl_repair_report *report,
                          sl_diag *diag)
{
    sl_polygons polygons;
    sl_mesh *built = NULL;
    sl_repair_report own = {0}, *r = report != NULL ? report : &own;
    sl_generated_polygons(mesh, &polygons);
    sl_status status = sl_mesh_build(&polygons, &built, r, diag);
    if (status == SL_OK && (faults(r) != 0 || r->genus != generator->genus || r->components != generator->components ||
                            r->border_loops != generator->borders)) {
        sl_diag_reason(diag,
                       "%s is not what its author says: genus %" PRId64 " for %d, %d components for %d, %d borders "
                       "for %d, %d things to repair",
                       generator->name, r->genus, generator->genus, r->components, generator->components,
                       r->border_loops, generator->borders, faults(r));
        status = SL_CHECK_FAILED;
    }
    sl_mesh_free(built);
    sl_repair_report_clear(&own);
    return status;
}

static void write_integers(sl_writer *w, const char *name, const int32_t *value, int32_t count)
{
    sl_writer_format(w, "   \"%s\": [", name);
    for (int32_t i = 0; i < count; i++) {
        sl_writer_text(w, i > 0 ? "," : "");
        sl_writer_int(w, value[i]);
    }
    sl_writer_text(w, "]");
}

static void write_matrix(sl_writer *w, const double matrix[12])
{
    sl_writer_text(w, "\"matrix\": [");
    for (int k = 0; k < 12; k++) {
        sl_writer_text(w, k % 4 == 0 ? (k > 0 ? ", [" : "[") : ", ");
        sl_writer_double(w, matrix[k]);
        sl_writer_text(w, k % 4 == 3 ? "]" : "");
    }
    sl_writer_text(w, "]");
}

static void write_fixed(sl_writer *w, const sl_planted *planted, int32_t nf)
{
    bool first = true;
    sl_writer_text(w, "   \"fixed_facets\": [");
    for (int32_t f = 0; f < nf; f++) {
        if (planted->face[f] == f) {
            sl_writer_text(w, first ? "" : ",");
            sl_writer_int(w, f);
            first = false;
        }
    }
    sl_writer_text(w, "]");
}

static void write_symmetries(sl_writer *w, const sl_generated *mesh)
{
    sl_writer_text(w, " \"symmetries\": [");
    for (int32_t k = 0; k < mesh->nplanted; k++) {
        const sl_planted *p = &mesh->planted[k];
        sl_writer_format(w, "%s\n  {\"name\": \"%s\", \"mirror\": %s, \"exact\": %s, ", k > 0 ? "," : "", p->name,
                         p->mirror ? "true" : "false", p->exact ? "true" : "false");
        write_matrix(w, p->matrix);
        sl_writer_text(w, ",\n");
        write_fixed(w, p, mesh->nf);
        sl_writer_text(w, ",\n");
        write_integers(w, "facet", p->face, mesh->nf);
        sl_writer_text(w, ",\n");
        write_integers(w, "vertex", p->vertex, mesh->nv);
        sl_writer_text(w, "}");
    }
    sl_writer_text(w, "],\n \"near\": [");
    for (int32_t k = 0; k < mesh->nnear; k++) {
        sl_writer_format(w, "%s\n  {\"name\": \"%s\", ", k > 0 ? "," : "", mesh->near[k].name);
        write_matrix(w, mesh->near[k].matrix);
        sl_writer_text(w, "}");
    }
    sl_writer_text(w, "]");
}

sl_status gen_truth_write(const char *path, const sl_generator *generator, const sl_generated *mesh,
                          const sl_repair_report *report, uint64_t seed, int32_t scale, sl_diag *diag)
{
    sl_writer *w = NULL;
    const sl_status status = sl_writer_create(path, &w, diag);
    if (status != SL_OK) {
        return status;
    }
    sl_writer_format(
        w, "{\"schema\": %d,\n \"name\": \"%s\",\n \"what\": \"%s\",\n \"seed\": \"%" PRIu64 "\",\n \"scale\": %d,\n",
        GEN_TRUTH_SCHEMA, generator->name, generator->what, seed, scale);
    sl_writer_format(w, " \"vertices\": %d,\n \"facets\": %d,\n", mesh->nv, mesh->nf);
    sl_writer_format(w, " \"triangles\": %d,\n \"quads\": %d,\n \"ngons\": %d,\n", report->triangles, report->quads,
                     report->ngons);
    sl_writer_format(w, " \"genus\": %" PRId64 ",\n \"components\": %d,\n \"borders\": %d,\n", report->genus,
                     report->components, report->border_loops);
    sl_writer_format(w, " \"more_mirrors\": %s,\n", mesh->more_mirrors ? "true" : "false");
    write_symmetries(w, mesh);
    sl_writer_text(w, "}\n");
    return sl_writer_commit(w, diag);
}
