/* libFuzzer target: bytes are parsed as one format (FUZZ_NAME), built into a mesh, and written again. Anything but a
 * status is a finding. See meson.build for how to run it. */
#include "mesh/build.h"
#include "meshio/meshfile_internal.h"

#include <math.h>
#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Both writers, into nothing. */
static void write_again(const sl_meshfile *file)
{
    const int64_t numbers = 2 * (int64_t)file->face_first[file->nf];
    double *uv = sl_alloc(numbers, sizeof *uv);
    sl_writer *writer = NULL;
    for (int64_t k = 0; uv != NULL && k < numbers; k++) {
        uv[k] = k % 7 == 0 ? (double)NAN : sl_uv_quantise((double)(k % 11) / 13.0);
    }
    if (uv != NULL && sl_writer_create("/dev/null", &writer, NULL) == SL_OK) {
        sl_status status = obj_write(writer, file, uv);
        if (status == SL_OK) {
            status = file->format == SL_FORMAT_PLY ? ply_rewrite(writer, file, uv) : ply_write(writer, file, uv);
        }
        if (sl_writer_commit(writer, NULL) != SL_OK || status != SL_OK) {
            abort(); /* what was read can be written */
        }
    }
    sl_free(uv);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    sl_meshfile *file;
    sl_mesh *mesh;
    sl_polygons polygons;
    sl_repair_report report = {0};
    sl_diag diag = sl_diag_none();
    if (sl_meshfile_parse(FUZZ_NAME, (const char *)data, (int64_t)size, &file, &diag) != SL_OK) {
        return 0;
    }
    sl_meshfile_polygons(file, &polygons);
    if (sl_mesh_build(&polygons, &mesh, &report, &diag) == SL_OK) {
        sl_mesh_free(mesh);
    }
    sl_repair_report_clear(&report);
    write_again(file);
    sl_meshfile_free(file);
    return 0;
}
