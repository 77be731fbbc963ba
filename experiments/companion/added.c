#include "companion.h"
#include "support/failures.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

static const char *file_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash != NULL ? slash + 1 : path;
}

bool named_after(const char *path, const char *name)
{
    const char *file = file_of(path);
    const size_t length = strlen(name);
    return strncmp(file, name, length) == 0 && length > 0 && !isalnum((unsigned char)file[length]);
}

static int32_t triangles_of(const sl_polygons *p)
{
    return p->face_first[p->nf] - 2 * p->nf;
}

/* The same mesh, as far as can be told; other tools may have split its polygons. */
static bool same_mesh(const model *m, const char *path, const sl_polygons *polygons)
{
    return named_after(path, m->source.name) && (m->facets == polygons->nf || m->triangles == triangles_of(polygons));
}

/* Of several models the one with the longest name ("body-uneven" before "body"). */
static int32_t model_of(const companion *all, const char *path, const sl_polygons *polygons)
{
    int32_t found = -1;
    for (int32_t k = 0; k < all->count; k++) {
        const char *name = all->model[k].source.name;
        if (same_mesh(&all->model[k], path, polygons) &&
            (found < 0 || strlen(name) > strlen(all->model[found].source.name))) {
            found = k;
        }
    }
    return found;
}

static sl_status measure_file(exp_run *run, const companion *all, added *a)
{
    sl_status status = SL_OK;
    sl_meshfile *file = NULL;
    exp_mesh mesh = {0};
    sl_polygons polygons;
    const char *name = file_of(a->from->path);
    snprintf(a->mesh, sizeof a->mesh, "%.*s", (int)strcspn(name, "."), name);
    SL_TRY(sl_meshfile_read(a->from->path, &file, &run->diag));
    if (file->corner_uv == NULL) {
        sl_diag_reason(&run->diag, "%s has no UVs", a->from->path);
        SL_TRY(SL_BAD_INPUT);
    }
    sl_meshfile_polygons(file, &polygons);
    a->facets = polygons.nf;
    a->model = model_of(all, a->from->path, &polygons);
    if (a->model >= 0) {
        snprintf(a->mesh, sizeof a->mesh, "%s", all->model[a->model].source.name);
        SL_TRY(exp_mesh_load(&all->model[a->model].source, &mesh, &run->diag));
    }
    SL_TRY(exp_measure_uv(run, &polygons, file->corner_uv, mesh.generated, &a->numbers));
    fprintf(stderr, "%s, %s: %.0f charts\n", a->from->name, a->mesh, a->numbers.metric[EXP_CHARTS]);
cleanup:
    exp_mesh_clear(&mesh);
    sl_meshfile_free(file);
    return status == SL_IO ? SL_BAD_INPUT : status; /* the file's fault, not the experiment's */
}

sl_status measure_added(exp_run *run, companion *all)
{
    for (int32_t k = 0; k < run->added; k++) {
        added *a = &all->add[all->added++];
        *a = (added){.from = &run->add[k], .model = -1, .numbers = {.failed = true}};
        sl_status status = measure_file(run, all, a);
        exp_failed(run, a->from->name, &status);
        if (status != SL_OK) {
            return status;
        }
    }
    return SL_OK;
}
